# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""What must hold of results whatever the numbers: units, orders, weights, outliers, joints that move with the room, and
samples that a recorder made."""

import json
import math
import random
import unittest

from support import CommandTest, converted, read_csv, run, table, write_csv


class LeastSquares(CommandTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.rows = converted(cls.c3d, cls.recorded / "all.csv")
        cls.names, cls.truth = table(cls.recorded / "truth.mot")
        cls.well_seen = [c for c, name in enumerate(cls.names) if c > 0 and not name.startswith(("mtp", "wrist", "pro_sup"))]

    def solve(self, markers, *options):
        self.good(*self.ik(markers=markers, output="q.mot"), "--force", "--quiet", "--max-rms", 1000, "--max-offset", 1000, *options)
        return table(self.folder / "q.mot")[1]

    def assert_same(self, rows, others, delta):
        for row, other in zip(rows, others, strict=True):
            for c in self.well_seen:
                self.assertAlmostEqual(row[c], other[c], delta=delta, msg=f"{self.names[c]} at {row[0]} s")

    def error(self, rows, frames=range(100)):
        """RMS error of the angles in degrees."""
        squares = [
            (rows[f][c] - self.truth[f][c]) ** 2 for f in frames for c in self.well_seen if not self.names[c].startswith("pelvis_t")
        ]
        return math.sqrt(sum(squares) / len(squares))

    def test_the_order_of_the_markers_is_no_matter(self):
        shuffled = sorted(self.rows, key=lambda row: (int(row["frame"]), random.Random(row["marker"]).random()))
        self.assertNotEqual([row["marker"] for row in shuffled[:40]], [row["marker"] for row in self.rows[:40]])
        write_csv(self.folder / "shuffled.csv", shuffled)
        self.assert_same(self.solve("shuffled.csv"), self.solve(self.c3d), 0.01)

    def test_weights_are_relative(self):
        names = {row["marker"] for row in self.rows}
        tenfold = [part for name in sorted(names) for part in ("--weight", f"{name}=10")]
        self.assert_same(self.solve(self.c3d, *tenfold), self.solve(self.c3d), 0.01)

    def test_a_heavier_marker_is_met_more_closely(self):
        def distance(*options):
            self.solve(self.c3d, *options)
            names, rows = table(self.folder / "q_marker_errors.sto")
            seen = [row[names.index("RELB")] for row in rows if math.isfinite(row[names.index("RELB")])]
            return sum(seen) / len(seen)

        light, usual, heavy = distance("--weight", "RELB=0.01"), distance(), distance("--weight", "RELB=100")
        self.assertLess(usual, light)
        self.assertLess(heavy, 0.5 * usual)

    def test_an_outlier_spoils_squares_and_not_robust_losses(self):
        rows = [dict(row) for row in self.rows]
        spoilt = range(30, 40)
        for row in rows:
            if row["marker"] == "RKNE" and int(row["frame"]) - 1 in spoilt and row["y_m"]:
                row["y_m"] = repr(float(row["y_m"]) + 0.3)
        write_csv(self.folder / "out.csv", rows)
        clean = self.error(self.solve(self.c3d), spoilt)
        square = self.error(self.solve("out.csv", "--doubtful", "keep"), spoilt)
        self.assertGreater(square, 3 * clean)
        for loss in ("huber", "cauchy"):
            robust = self.error(self.solve("out.csv", "--doubtful", "keep", "--loss", loss), spoilt)
            self.assertLess(robust, 0.5 * square, loss)
        self.assertLess(self.error(self.solve("out.csv", "--doubtful", "keep", "--loss", "cauchy"), spoilt), 1.5 * clean)
        self.assertLess(self.error(self.solve("out.csv"), spoilt), 1.5 * clean, "judged samples, the default")

    def test_frames_before_and_after_do_not_matter(self):
        whole = self.solve(self.c3d)
        part = self.solve(self.c3d, "--start", 0.4, "--end", 0.6)
        self.assert_same(part, whole[40:61], 0.05)

    def test_a_coordinate_task_draws_towards_zero(self):
        column = self.names.index("lumbar_extension")
        free = [abs(row[column]) for row in self.solve(self.c3d)]
        drawn = [abs(row[column]) for row in self.solve(self.c3d, "--coordinate-weight", "lumbar_extension=1000")]
        self.assertLess(sum(drawn), 0.2 * sum(free))

    def setup_file(self, name, tasks):
        self.write(
            name,
            '<OpenSimDocument Version="40000"><InverseKinematicsTool name="s">'
            f"<model_file>{self.model}</model_file><marker_file>{self.trc}</marker_file>"
            f"<IKTaskSet><objects>{tasks}</objects></IKTaskSet>"
            "<time_range>0.2 0.5</time_range><output_motion_file>from_setup.mot</output_motion_file>"
            "</InverseKinematicsTool></OpenSimDocument>",
        )

    def test_whoever_reads_the_setup_gets_what_the_options_say(self):
        names = sorted({row["marker"] for row in self.rows})
        task = '<IKMarkerTask name="{}"><apply>true</apply><weight>{}</weight></IKMarkerTask>'
        self.setup_file("setup.xml", "".join(task.format(name, 5 if name == "LASI" else 1) for name in names))
        self.good("ik", "--setup", "setup.xml", "--quiet")
        self.good("ik", "-m", self.model, "-t", self.trc, "--start", 0.2, "--end", 0.5, "--weight", "LASI=5", "-o", "from_options.mot", "--quiet")
        self.assertEqual(table(self.folder / "from_setup.mot"), table(self.folder / "from_options.mot"))

    def test_markers_without_a_task_have_no_weight_as_in_opensim(self):
        self.setup_file("none.xml", "")
        self.refused(3, ["has the weight 0 or is never seen", "LFHD"], "ik", "--setup", "none.xml")


class JointCentres(CommandTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.arm = cls.recorded.parent / "arm"
        made = run("simulate", "arm", "-o", cls.arm, "--frames", 200, "--stagger", 25, "--markers", 4, "--noise", 0.5, cwd=cls.recorded)
        assert made.status == 0, made.err
        cls.rows = converted(cls.arm / "markers.c3d", cls.arm / "markers.csv")
        cls.joints = [row for row in read_csv(cls.arm / "truth.csv") if row["marker"].startswith("j")]

    def centres(self, markers, *options):
        """{frame: (position, deviations)} of the second joint, about which both segments turn."""
        self.good("joints", markers, "--segments", self.arm / "segments.toml", "-o", "c.csv", "--force", "--quiet", *options)
        rows = [row for row in read_csv(self.folder / "c.csv") if row["x_m"]]
        name = rows[-1]["marker"]
        return {int(row["frame"]): ([float(row[f"{a}_m"]) for a in "xyz"], [float(row[f"sd_{a}_m"] or "nan") for a in "xyz"]) for row in rows if row["marker"] == name}

    def truth_of(self, centres):
        """The joint of the truth that these centres are nearest to, by frame."""
        by_name = {}
        for row in self.joints:
            by_name.setdefault(row["marker"], {})[int(row["frame"])] = [float(row[f"{a}_m"]) for a in "xyz"]
        return min(by_name.values(), key=lambda path: sum(math.dist(path[f], x) for f, (x, _) in centres.items()))

    def test_centres_are_as_good_as_they_say(self):
        for method in ("articulated", "score"):
            centres = self.centres(self.arm / "markers.csv", "--method", method)
            truth = self.truth_of(centres)
            self.assertGreater(len(centres), 190)
            ratios = [abs(a - b) / sd for f, (x, sds) in centres.items() for a, b, sd in zip(x, truth[f], sds, strict=True) if math.isfinite(sd)]
            self.assertGreater(len(ratios), 500)
            self.assertGreater(sum(r <= 1 for r in ratios) / len(ratios), 0.55, method)
            self.assertGreater(sum(r <= 2 for r in ratios) / len(ratios), 0.88, method)

    def test_centres_move_with_the_room(self):
        turn = ((0.36, 0.48, -0.8), (-0.8, 0.6, 0.0), (0.48, 0.64, 0.6))
        shift = (2.0, -1.0, 0.5)

        def moved(x):
            return [sum(r * c for r, c in zip(row, x)) + s for row, s in zip(turn, shift)]

        rows = [dict(row) for row in self.rows]
        for row in rows:
            if row["x_m"]:
                for axis, value in zip("xyz", moved([float(row[f"{a}_m"]) for a in "xyz"]), strict=True):
                    row[f"{axis}_m"] = repr(value)
        write_csv(self.folder / "moved.csv", rows)
        here, there = self.centres(self.arm / "markers.csv", "--method", "score"), self.centres("moved.csv", "--method", "score")
        self.assertEqual(here.keys(), there.keys())
        for f, (x, _) in here.items():
            self.assertLess(math.dist(moved(x), there[f][0]), 1e-6)

    def test_centres_of_a_recording_twice_as_large_lie_twice_as_far(self):
        rows = [{**row, **{f"{a}_m": repr(2 * float(row[f"{a}_m"])) for a in "xyz" if row["x_m"]}} for row in self.rows]
        write_csv(self.folder / "twice.csv", rows)
        once, twice = self.centres(self.arm / "markers.csv", "--method", "score"), self.centres("twice.csv", "--method", "score")
        for f, (x, _) in once.items():
            self.assertLess(math.dist([2 * c for c in x], twice[f][0]), 1e-5)


class Recorders(CommandTest):
    """240 frames a second of which the cameras took 60."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.limb = cls.recorded.parent / "limb"
        made = run("simulate", "macaque", "-o", cls.limb, "--upsample", 4, "--duration", 20, "--all-seen", cwd=cls.recorded)
        assert made.status == 0, made.err

    def cleaned(self, choice):
        self.good("clean", self.limb / "markers.c3d", f"{choice}.csv", "--upsampled", choice, "--filter", "none", "--quiet")
        return read_csv(self.folder / f"{choice}.csv")

    def test_what_was_made_is_kept_marked_left_out_or_taken_out_with_its_frames(self):
        keep, mark, missing, decimate = (self.cleaned(choice) for choice in ("keep", "mark", "missing", "decimate"))
        self.assertEqual({row["state"] for row in keep}, {"measured"})
        made = [i for i, row in enumerate(mark) if row["state"] == "upsampled"]
        self.assertAlmostEqual(len(made) / len(mark), 0.75, delta=0.01)
        self.assertEqual([row["x_m"] for row in mark], [row["x_m"] for row in keep], "only told")
        self.assertEqual([i for i, row in enumerate(missing) if row["state"] == "missing"], made)
        self.assertEqual(
            [(row["marker"], row["x_m"]) for row in decimate],
            [(row["marker"], row["x_m"]) for row in mark if row["state"] == "measured"],
            "the real samples, in order",
        )
        facts = json.loads(self.good("info", "decimate.csv", "--json").out)
        self.assertEqual(facts["rate_hz"], 60.0)

    def test_an_honest_recording_is_left_alone(self):
        self.good("simulate", "macaque", "-o", "honest", "--duration", 20, "--all-seen", "--quiet")
        self.good("clean", "honest/markers.c3d", "c.csv", "--upsampled", "decimate", "--filter", "none", "--quiet")
        facts = json.loads(self.good("info", "c.csv", "--json").out)
        self.assertEqual((facts["rate_hz"], facts["missing"]), (60.0, 0))
        report = json.loads((self.folder / "c_report.json").read_text())
        self.assertTrue(report["upsampling"]["looked"])
        self.assertEqual(report["upsampling"]["factor"], 1)


if __name__ == "__main__":
    unittest.main()
