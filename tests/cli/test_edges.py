# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings at the edge of what a command can use: no frame, one, few, one marker, nothing seen, blank frames."""

import json
import math
import unittest

from support import POSITION, CommandTest, converted, table, write_csv


class Edges(CommandTest):
    """`rows` are those of the simulated second as CSV; `cut()` writes some of them."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.rows = converted(cls.c3d, cls.recorded / "all.csv")

    def cut(self, name, keep=lambda frame, marker: True, hide=lambda frame, marker: False):
        hidden = {"state": "missing", **dict.fromkeys(POSITION, "")}
        rows = [
            row | hidden if hide(int(row["frame"]), row["marker"]) else row
            for row in self.rows
            if keep(int(row["frame"]), row["marker"])
        ]
        write_csv(self.folder / name, rows, self.rows[0].keys())
        return name

    def first(self, frames):
        return self.cut(f"first{frames}.csv", keep=lambda frame, _: frame <= frames)

    def solved(self, markers, *options):
        """(names, rows) of the angles of `ik`, and its summary."""
        self.good(*self.ik(markers=markers, output="q.mot"), *options, "--force", "--quiet")
        return (*table(self.folder / "q.mot"), json.loads((self.folder / "q_report.json").read_text()))


class FewFrames(Edges):
    def test_no_frame_is_refused_by_every_command(self):
        name = self.first(0)
        for command in (
            ["info", name],
            ["convert", name, "x.c3d"],
            ["clean", name, "x.csv"],
            ["joints", name, "-o", "out"],
            ["scale", "-m", self.model, "-t", name, "-o", "x.osim"],
            ["track", "-m", self.model, "-t", name, "-o", "x.mot"],
            self.ik(markers=name),
        ):
            self.refused(3, [name, "no samples"], *command)

    def test_one_frame_has_angles_but_no_rates(self):
        name = self.first(1)
        names, rows, _ = self.solved(name)
        whole_names, whole_rows, _ = self.solved(self.c3d)
        self.assertEqual(names, whole_names)
        self.assertEqual(len(rows), 1)
        determined = [c for c, column in enumerate(names) if not column.startswith("mtp")]
        for c in determined:
            self.assertAlmostEqual(rows[0][c], whole_rows[0][c], delta=0.05, msg=names[c])
        self.refused(3, [name, "holds one frame", "two at least"], "track", "-m", self.model, "-t", name, "-o", "t.mot")
        self.refused(3, [name, "1 frames", "8 or more"], *self.ik(markers=name, estimator="smoother", output="s.mot"))
        self.refused(3, [name, "20 frames or more"], "joints", name, "-o", "out")

    def test_a_rate_is_not_known_of_one_frame_and_that_is_said(self):
        self.assertIn("does not determine a rate; 1 Hz is assumed", self.good("convert", self.first(1), "x.trc").err)
        self.assertNotIn("rate", self.good("convert", self.first(2), "y.trc").err)

    def test_one_two_and_three_frames_are_cleaned_and_converted(self):
        for frames in (1, 2, 3):
            name = self.first(frames)
            self.good("clean", name, f"c{frames}.csv", "--gaps", "auto", "--derivatives", "--quiet")
            for ending in ("c3d", "trc", "nwb"):
                self.good("convert", f"c{frames}.csv", f"c{frames}.{ending}")
                facts = json.loads(self.good("info", f"c{frames}.{ending}", "--json").out)
                self.assertEqual((facts["frames"], facts["points"]), (frames, 40))

    def test_two_frames_are_tracked_without_deviations_of_torques(self):
        ran = self.good("track", "-m", self.model, "-t", self.first(2), "-o", "t.mot")
        self.assertIn("standard deviations of torques are not known", ran.err)
        self.assertFalse((self.folder / "t_tau_sd.sto").exists())
        self.assertEqual(len(table(self.folder / "t.mot")[1]), 2)
        longer = self.good("track", "-m", self.model, "-t", self.first(30), "-o", "longer.mot")
        self.assertNotIn("standard deviations of torques are not known", longer.err)

    def test_a_time_range_is_those_frames_of_the_whole(self):
        _, whole, _ = self.solved(self.c3d)
        _, part, _ = self.solved(self.c3d, "--start", 0.2, "--end", 0.31)
        self.assertEqual([round(row[0], 9) for row in part], [row[0] for row in whole if 0.2 <= row[0] <= 0.31])
        _, one, _ = self.solved(self.c3d, "--start", 0.5, "--end", 0.5)
        self.assertEqual([row[0] for row in one], [0.5])
        for column, (a, b) in enumerate(zip(one[0], whole[50], strict=True)):
            if column < 30:  # the toes are hardly determined
                self.assertAlmostEqual(a, b, delta=0.05)


class LittleSeen(Edges):
    def test_nothing_seen_is_cleaned_to_nothing_and_solved_by_nobody(self):
        name = self.cut("dark.csv", keep=lambda frame, _: frame <= 30, hide=lambda *_: True)
        self.assertEqual(json.loads(self.good("info", name, "--json").out)["missing"], 30 * 40)
        ran = self.good("clean", name, "x.csv", "--gaps", "auto", "--derivatives")
        self.assertIn("of 1200 samples 0 measured, 0 made, 1200 missing", ran.err)
        self.assertIn("never seen", ran.err)
        for command in (
            self.ik(markers=name),
            self.ik(markers=name, estimator="smoother"),
            ["track", "-m", self.model, "-t", name, "-o", "t.mot"],
            ["scale", "-m", self.model, "-t", name, "-o", "x2.osim"],
        ):
            self.refused(3, [name, "never seen", "LFHD"], *command)
        self.refused(3, [name, "0 of 40 markers were seen"], "joints", name, "-o", "out")

    def test_blank_frames_hold_the_pose_and_say_so(self):
        name = self.cut("blank.csv", hide=lambda frame, _: 40 <= frame <= 44)
        self.assertIn("5 of 100 frames (5 %) had no marker", self.good(*self.ik(markers=name, output="said.mot")).err)
        names, rows, summary = self.solved(name)
        for row in rows[39:44]:
            self.assertEqual(row[1:], rows[38][1:], "held from the frame before")
        sd = table(self.folder / "q_sd.sto")[1]
        for row in sd[39:44]:
            self.assertTrue(all(math.isnan(value) for value in row[1:]), "a held pose is no measurement")
        self.assertEqual(summary["frames"], 100)

    def test_blank_frames_at_the_beginning_are_no_obstacle(self):
        name = self.cut("late.csv", hide=lambda frame, _: frame <= 10)
        _, rows, _ = self.solved(name)
        _, whole, _ = self.solved(self.c3d)
        for column, (a, b) in enumerate(zip(rows[50], whole[50], strict=True)):
            if column < 30:
                self.assertAlmostEqual(a, b, delta=0.05)

    def test_a_marker_without_weight_is_a_marker_that_is_not_there(self):
        _, without, _ = self.solved(self.cut("no_lasi.csv", keep=lambda _, marker: marker != "LASI"))
        names, weightless, _ = self.solved(self.c3d, "--weight", "LASI=0")
        for a, b in zip(without, weightless, strict=True):
            for column, (x, y) in enumerate(zip(a, b, strict=True)):
                if not names[column].startswith("mtp"):
                    self.assertAlmostEqual(x, y, delta=0.02, msg=names[column])

    def test_one_marker_determines_nothing_and_that_is_said(self):
        name = self.cut("one.csv", keep=lambda _, marker: marker == "LFHD")
        names, rows, summary = self.solved(name)
        self.assertEqual(len(rows), 100)
        self.assertTrue(all(math.isnan(value) for row in table(self.folder / "q_sd.sto")[1] for value in row[1:]))
        ran = self.good(*self.ik(markers=name, output="said.mot"))
        self.assertIn("0.0 % of the coordinates determined", ran.err)
        self.assertRegex(ran.err, r"attention: [0-9]+ coordinates are never determined by the visible markers: pelvis_tilt, .* more")
        self.assertEqual(ran.err.count("never determined"), 1, "one line for all")
        self.refused(3, [name, "a joint needs 4 at least"], "joints", name, "-o", "out")

    def test_shares_are_written_without_exponents(self):
        name = self.cut("one.csv", keep=lambda _, marker: marker == "LFHD")
        ran = self.run_in(*self.ik(markers=name, estimator="smoother"))
        self.assertIn(ran.status, (0, 1))
        self.assertNotRegex(ran.err, r"\de[+-]\d\d %")


class TheLaboratory(Edges):
    def test_angles_do_not_depend_on_the_unit_of_the_file(self):
        text = self.trc.read_text().split("\n")
        metres = [line.replace("\tmm\t", "\tm\t") if i == 2 else line for i, line in enumerate(text)]
        for i in range(5, len(metres)):
            cells = metres[i].split("\t")
            metres[i] = "\t".join(cells[:2] + [f"{float(cell) / 1000:.9f}" if cell else "" for cell in cells[2:]])
        self.write("metres.trc", "\n".join(metres))
        names, ours, _ = self.solved("metres.trc")
        _, theirs, _ = self.solved(self.trc)
        for a, b in zip(ours, theirs, strict=True):
            for column, (x, y) in enumerate(zip(a, b, strict=True)):
                self.assertAlmostEqual(x, y, delta=0.02, msg=names[column])

    def test_a_step_to_the_side_moves_the_root_and_nothing_else(self):
        shift = 1.25
        rows = [row | {"z_m": repr(float(row["z_m"]) + shift)} if row["z_m"] else row for row in self.rows]
        write_csv(self.folder / "aside.csv", rows)
        names, moved, _ = self.solved("aside.csv")
        _, whole, _ = self.solved(self.c3d)
        for a, b in zip(moved, whole, strict=True):
            for column, (x, y) in enumerate(zip(a, b, strict=True)):
                if names[column].startswith("mtp"):
                    continue
                self.assertAlmostEqual(x - y, shift if names[column] == "pelvis_tz" else 0.0, delta=0.02, msg=names[column])


class Streams(CommandTest):
    """What goes to standard output and what to standard error, of commands that write files."""

    def commands(self):
        return {
            "convert": ["convert", self.c3d, "a.csv"],
            "clean": ["clean", self.c3d, "b.csv", "--filter", "none"],
            "ik": self.ik(output="c.mot"),
            "track": ["track", "-m", self.model, "-t", self.c3d, "-o", "d.mot", "--end", "0.1"],
            "simulate": ["simulate", "arm", "-o", "e", "--frames", "30"],
            "report": ["report", "c.mot", "-o", "c.html"],
            "validate": ["validate", self.c3d],
        }

    def test_quiet_is_silent(self):
        for name, command in self.commands().items():
            with self.subTest(command=name):
                ran = self.good(*command, "--quiet")
                self.assertEqual((ran.out, ran.err), ("", ""))

    def test_json_is_all_of_standard_output(self):
        for name, command in self.commands().items():
            with self.subTest(command=name):
                self.assertIsNotNone(json.loads(self.good(*command, "--json").out))

    def test_without_json_standard_output_stays_free(self):
        for name, command in self.commands().items():
            with self.subTest(command=name):
                ran = self.good(*command)
                self.assertEqual(ran.out, "")
                self.assertNotEqual(ran.err, "")


if __name__ == "__main__":
    unittest.main()
