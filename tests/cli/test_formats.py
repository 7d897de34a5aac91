# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""A recording keeps what a format can hold, whichever formats it goes through."""

import csv
import itertools
import json
import math
import unittest

from support import PROJECT, CommandTest, table

MARKER_FORMATS = ("c3d", "trc", "nwb", "mat", "csv")


class Markers(CommandTest):
    def facts(self, name):
        """What `info` says of a file, without what belongs to the format."""
        facts = json.loads(self.good("info", name, "--json").out)
        return {key: value for key, value in facts.items() if key not in ("file", "format", "units", "software")}

    def samples(self, name):
        """{(frame, marker): (state, method, position in metres)} of a CSV file."""
        with (self.folder / name).open(newline="") as file:
            return {
                (row["frame"], row["marker"]): (row["state"], row["method"], [float(row[axis] or "nan") for axis in ("x_m", "y_m", "z_m")])
                for row in csv.DictReader(file)
            }

    def assert_same_samples(self, first, second, tolerance_m):
        before, after = self.samples(first), self.samples(second)
        self.assertEqual(before.keys(), after.keys())
        for key, (state, _, position) in before.items():
            self.assertEqual(after[key][0] == "missing", state == "missing", key)
            if state != "missing":
                for a, b in zip(position, after[key][2], strict=True):
                    self.assertAlmostEqual(a, b, delta=tolerance_m)

    def test_the_table_of_formats_in_the_documentation_is_the_programs_own(self):
        printed = self.good("help", "--formats").out
        self.assertIn(printed.strip(), (PROJECT / "docs" / "formats" / "README.md").read_text())
        for ending in MARKER_FORMATS:
            self.assertIn(f"`.{ending}`", printed)

    def test_a_group_that_is_not_read_stays_in_c3d_and_is_said_to_be_lost_elsewhere(self):
        raw = self.c3d.read_bytes()
        self.assertEqual(raw.count(b"KINEMARK"), 1)
        (self.folder / "other.c3d").write_bytes(raw.replace(b"KINEMARK", b"SUBJECTS"))
        self.good("convert", "other.c3d", "copy.c3d")
        self.assertIn(b"SUBJECTS", (self.folder / "copy.c3d").read_bytes())
        self.assertIn("1 group of parameters cannot be stored", self.good("convert", "other.c3d", "copy.trc").err)
        self.assertNotIn("groups of parameters", self.good("convert", self.c3d, "own.trc").err)

    def test_motion_bids_is_a_set_with_a_name_of_its_own(self):
        name = "study/sub-01/motion/sub-01_task-walk_tracksys-omc_motion.tsv"
        stem = name.removesuffix("motion.tsv")
        ran = self.good("convert", self.c3d, name, "--json")
        written = json.loads(ran.out)["written"]
        self.assertEqual(len(written), 6)
        self.assertEqual(self.facts(name), self.facts(self.c3d))
        self.refused(4, "_motion.tsv", "convert", self.c3d, name)
        self.good("convert", self.c3d, name, "--force")
        for wrong in ("study/sub-01/motion/walk.tsv", "walk_motion.tsv", "study/sub-02/motion/sub-01_task-walk_tracksys-omc_motion.tsv"):
            self.refused(2, "sub-LABEL[/ses-LABEL]/motion/sub-LABEL", "convert", self.c3d, wrong)
        self.refused(2, "kinemark convert writes", "clean", self.c3d, name.replace("walk", "clean"))
        (self.folder / f"{stem}channels.tsv").unlink()
        self.refused(3, ["has no channels.tsv", "_motion.tsv"], "info", name)

    def test_every_format_becomes_every_other_with_the_same_facts(self):
        expected = self.facts(self.c3d)
        self.assertGreater(expected["missing"], 0)
        for ending in MARKER_FORMATS:
            self.good("convert", self.c3d, f"from_c3d.{ending}")
        for before, after in itertools.product(MARKER_FORMATS, repeat=2):
            with self.subTest(before=before, after=after):
                self.good("convert", f"from_c3d.{before}", f"{before}_to.{after}")
                self.assertEqual(self.facts(f"{before}_to.{after}"), expected)

    def test_the_longest_way_round_ends_within_a_micrometre(self):
        self.good("convert", self.c3d, "direct.csv")
        way = ["a.trc", "b.nwb", "c.csv", "d.c3d", "e.nwb", "m.mat", "f.trc", "g.csv"]
        for source, target in itertools.pairwise([self.c3d, *way]):
            self.good("convert", source, target)
        self.assert_same_samples("direct.csv", "g.csv", 1e-6)

    def test_csv_and_nwb_hold_states_methods_and_deviations_to_the_bit(self):
        self.good("clean", self.c3d, "clean.csv", "--gaps", "auto", "--quiet")
        states = {state for state, _, _ in self.samples("clean.csv").values()}
        self.assertTrue({"measured", "missing"} < states, "something was filled")
        self.assertIn("auto", {method for _, method, _ in self.samples("clean.csv").values()})
        self.good("convert", "clean.csv", "clean.nwb")
        self.good("convert", "clean.nwb", "again.csv")
        self.assertEqual((self.folder / "again.csv").read_bytes(), (self.folder / "clean.csv").read_bytes())

    def test_a_cleaned_recording_may_go_on_in_every_format(self):
        self.good("clean", self.c3d, "clean.csv", "--gaps", "auto", "--quiet")
        for ending in MARKER_FORMATS:
            with self.subTest(format=ending):
                self.good("clean", self.c3d, f"direct_{ending}.{ending}", "--gaps", "auto", "--quiet")
                self.good("convert", f"direct_{ending}.{ending}", f"{ending}.csv")
                self.assert_same_samples("clean.csv", f"{ending}.csv", 2e-6)

    def test_angles_are_the_same_whichever_format_the_markers_come_in(self):
        wanted = None
        for ending in MARKER_FORMATS:
            self.good("convert", self.c3d, f"in.{ending}")
            self.good(*self.ik(markers=f"in.{ending}", output=f"{ending}.mot"), "--no-error-bars", "--quiet")
            names, rows = table(self.folder / f"{ending}.mot")
            wanted = wanted or (names, rows)
            self.assertEqual(names, wanted[0])
            for one, other in zip(rows, wanted[1], strict=True):
                for a, b in zip(one, other, strict=True):
                    self.assertAlmostEqual(a, b, delta=0.01)

    def test_the_ending_may_be_in_capitals(self):
        for ending in MARKER_FORMATS:
            self.good("convert", self.c3d, f"X.{ending.upper()}")
            self.assertEqual(self.facts(f"X.{ending.upper()}"), self.facts(self.c3d))

    def test_a_file_does_not_become_itself(self):
        self.write("a.trc", self.trc.read_bytes())
        for force in ([], ["--force"]):
            self.refused(2, ["a.trc", "is the file that is read", "another output"], "convert", "a.trc", "a.trc", *force)

    def test_validate_calls_what_we_write_good(self):
        for ending in MARKER_FORMATS:
            self.good("convert", self.c3d, f"a.{ending}")
        ran = self.good("validate", *(f"a.{ending}" for ending in MARKER_FORMATS), self.model, self.truth)
        self.assertEqual(ran.err.count(": good"), 7)

    def test_json_names_what_was_written(self):
        ran = self.good("convert", self.c3d, "a.csv", "--json")
        self.assertEqual(json.loads(ran.out), {"written": ["a.csv"], "warnings": ["reconstruction residuals cannot be stored in a .csv file"]})


class Tables(CommandTest):
    def test_mot_and_sto_are_the_same_table(self):
        self.good("convert", self.truth, "a.sto")
        self.good("convert", "a.sto", "b.mot")
        lines = self.truth.read_bytes().splitlines(keepends=True)
        alone = b"".join(line for line in lines if not line.startswith((b"kinemark_set=", b"kinemark_sum=")))
        self.assertEqual((self.folder / "b.mot").read_bytes(), alone, "a copy is no member of the set")

    def test_a_table_of_one_row_and_of_none(self):
        head = "t\nversion=1\nnRows={}\nnColumns=2\ninDegrees=no\nendheader\ntime\tq\n"
        self.write("one.sto", head.format(1) + "0.5\t0.25\n")
        self.good("convert", "one.sto", "one.mot")
        self.assertEqual(table(self.folder / "one.mot"), (["time", "q"], [[0.5, 0.25]]))
        self.write("none.sto", head.format(0))
        facts = json.loads(self.good("info", "none.sto", "--json").out)
        self.assertEqual((facts["rows"], facts["first_time_s"], facts["last_time_s"]), (0, None, None))

    def test_time_that_does_not_increase_is_refused_with_its_row(self):
        self.write("back.sto", "t\nversion=1\nnRows=3\nnColumns=2\ninDegrees=no\nendheader\ntime\tq\n0\t1\n0.2\t1\n0.1\t1\n")
        self.refused(3, ["back.sto", "0.1"], "convert", "back.sto", "x.mot")


    def sto(self, columns, *rows, degrees="no"):
        head = f"t\nversion=1\nnRows={len(rows)}\nnColumns={1 + len(columns)}\ninDegrees={degrees}\nendheader\n"
        lines = ["\t".join(map(str, row)) for row in (("time", *columns), *rows)]
        return self.write("t.sto", head + "\n".join(lines) + "\n").name

    def test_cells_that_are_no_numbers(self):
        for rows, words in (
            ([(0, 1), (1, "x")], "'x'"),
            ([(0, 1), ("x", 2)], "'x'"),
            ([(0, 1), (1, 2, 3)], "holds 3 cells where 2 columns are labelled"),
            ([(0, 1), (1,)], "holds 1 cells where 2 columns are labelled"),
        ):
            self.refused(3, ["t.sto", "line 9", words], "info", self.sto(["q"], *rows))

    def test_a_column_twice_is_refused_and_a_missing_number_is_kept(self):
        self.refused(3, "line 7: label 'q' occurs twice (columns 2 and 3)", "info", self.sto(["q", "q"], (0, 1, 2)))
        self.good("convert", self.sto(["q", "r"], (0, "nan", 1), (1, 2, "NaN")), "t.mot", "--quiet")
        rows = table(self.folder / "t.mot")[1]
        self.assertTrue(math.isnan(rows[0][1]) and math.isnan(rows[1][2]))
        self.assertEqual((rows[0][2], rows[1][1]), (1.0, 2.0))

    def test_degrees_stay_degrees(self):
        for word, flag in (("yes", True), ("no", False)):
            self.good("convert", self.sto(["q"], (0, 90.5), degrees=word), "t.mot", "--force", "--quiet")
            self.assertEqual(json.loads(self.good("info", "t.mot", "--json").out)["in_degrees"], flag)
            self.assertEqual(table(self.folder / "t.mot")[1], [[0.0, 90.5]], "numbers are as they were written")


class Models(CommandTest):
    def test_a_model_that_was_written_is_read_as_the_same(self):
        first = json.loads(self.good("info", self.model, "--json").out)
        self.good("convert", self.model, "a.osim")
        again = json.loads(self.good("info", "a.osim", "--json").out)
        for facts in (first, again):
            facts.pop("file")
        self.assertEqual(again, first)
        self.good(*self.ik(output="q.mot"), "--no-error-bars", "--quiet")
        self.good(*self.ik(model="a.osim", output="r.mot"), "--no-error-bars", "--quiet")
        for one, other in zip(table(self.folder / "q.mot")[1], table(self.folder / "r.mot")[1], strict=True):
            for a, b in zip(one, other, strict=True):
                self.assertAlmostEqual(a, b, delta=1e-6)

    def test_a_model_is_no_recording(self):
        for wrong in (["clean", self.model, "x.csv"], ["joints", self.model], self.ik(markers=self.model)):
            self.refused(3, "model.osim", *wrong)


if __name__ == "__main__":
    unittest.main()
