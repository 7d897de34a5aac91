# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of the files that commands write, held against the truth that `simulate` wrote beside the recording: errors are
as large as the standard deviations say, in the units of the files."""

import json
import math
import unittest

from support import CommandTest, read_csv, run, table


def finite(rows):
    return [value for row in rows for value in row if math.isfinite(value)]


class WithTruth(CommandTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.lab = cls.recorded.parent / "lab"
        made = run("simulate", "subject", "-o", cls.lab, "--duration", 1.5, "--noise", 1, cwd=cls.recorded)
        assert made.status == 0, made.err
        cls.names, cls.truth = table(cls.lab / "truth.mot")

    def solve(self, command, *options):
        self.good(command, "-m", self.lab / "model.osim", "-t", self.lab / "markers.c3d", "-o", f"{command}.mot", "--quiet", *options)
        names, rows = table(self.folder / f"{command}.mot")
        self.assertEqual(names, self.names)
        self.assertEqual(len(rows), len(self.truth))
        return rows

    def assert_covered(self, rows, deviations):
        """Two thirds of the errors lie within one deviation, 95 % within two; every error counts."""
        ratios = [
            abs(ours - true) / sd
            for row, true_row, sd_row in zip(rows, self.truth, deviations, strict=True)
            for ours, true, sd in zip(row[1:], true_row[1:], sd_row[1:], strict=True)
            if math.isfinite(sd)
        ]
        self.assertGreater(len(ratios), 0.9 * len(rows) * (len(self.names) - 1), "hardly a coordinate is not determined")
        self.assertAlmostEqual(sum(r <= 1 for r in ratios) / len(ratios), 0.683, delta=0.07)
        self.assertAlmostEqual(sum(r <= 2 for r in ratios) / len(ratios), 0.954, delta=0.035)

    def test_angles_of_least_squares(self):
        rows = self.solve("ik")
        self.assert_covered(rows, table(self.folder / "ik_sd.sto")[1])

    def test_angles_of_the_smoother_are_better_and_know_it(self):
        frame_by_frame = self.solve("ik")
        sd_alone = table(self.folder / "ik_sd.sto")[1]
        smooth = self.solve("ik", "--estimator", "smoother", "--force")
        sd_smooth = table(self.folder / "ik_sd.sto")[1]
        self.assert_covered(smooth, sd_smooth)

        def squares(rows):
            return sum((a - b) ** 2 for row, true in zip(rows, self.truth, strict=True) for a, b in zip(row[1:], true[1:], strict=True))

        self.assertLess(squares(smooth), 0.5 * squares(frame_by_frame))
        self.assertLess(sum(finite(sd_smooth)), sum(finite(sd_alone)))

    def test_angles_and_bounds_of_direct_control(self):
        rows = self.solve("track")
        self.assert_covered(rows, table(self.folder / "track_sd.sto")[1])
        names, bounds = table(self.folder / "track_bound.sto")
        self.assertEqual(names, self.names)
        within = [
            abs(ours - true) <= bound
            for row, true_row, bound_row in zip(rows, self.truth, bounds, strict=True)
            for ours, true, bound in zip(row[1:], true_row[1:], bound_row[1:], strict=True)
            if math.isfinite(bound)
        ]
        self.assertGreater(len(within), 5000)
        self.assertGreater(sum(within) / len(within), 0.99)

    def test_noise_that_is_given_scales_the_deviations(self):
        self.solve("ik", "--noise", 1)
        one = finite(table(self.folder / "ik_sd.sto")[1])
        self.solve("ik", "--noise", 3, "--force")
        three = finite(table(self.folder / "ik_sd.sto")[1])
        time = sum(row[0] for row in self.truth)
        self.assertAlmostEqual((sum(three) - time) / (sum(one) - time), 3.0, delta=0.02)

    def test_distances_of_markers_are_metres_and_agree_with_their_summary(self):
        self.solve("ik")
        names, rows = table(self.folder / "ik_marker_errors.sto")
        self.assertEqual((names[:3], len(names)), (["time", "rms", "max"], 3 + 40))
        for _, rms, largest, *distances in rows:
            seen = [distance for distance in distances if math.isfinite(distance)]
            self.assertAlmostEqual(rms, math.sqrt(sum(d * d for d in seen) / len(seen)), places=9)
            self.assertEqual(largest, max(seen))
        everything = finite(row[3:] for row in rows)
        rms_mm = 1e3 * math.sqrt(sum(d * d for d in everything) / len(everything))
        summary = json.loads((self.folder / "ik_report.json").read_text())
        self.assertAlmostEqual(rms_mm, summary["rms_error_mm"], delta=0.001)
        self.assertTrue(1.2 < rms_mm < 1.74, "1 mm of noise per axis less what the angles take up")


class CleanedTruth(CommandTest):
    def rows(self, path):
        return {(row["frame"], row["marker"]): row for row in read_csv(path)}

    def cleaned(self, *options):
        """Pairs of cleaned and true rows, by frame and marker."""
        self.good("convert", self.recorded / "truth.trc", "truth.csv", "--force", "--quiet")
        self.good("clean", self.c3d, "clean.csv", "--force", "--quiet", *options)
        truth = self.rows(self.folder / "truth.csv")
        return [(row, truth[key]) for key, row in self.rows(self.folder / "clean.csv").items()]

    def test_smoothed_positions_are_better_than_measured_and_know_how_good(self):
        ratios, squares = [], []
        for row, true in self.cleaned():
            if row["state"] != "measured":
                continue
            for axis in "xyz":
                error = float(row[f"{axis}_m"]) - float(true[f"{axis}_m"])
                squares.append(error * error)
                ratios.append(abs(error) / float(row[f"sd_{axis}_m"]))
        self.assertGreater(len(ratios), 10000)
        self.assertLess(1e3 * math.sqrt(sum(squares) / len(squares)), 0.75, "1 mm before")
        self.assertAlmostEqual(sum(r <= 1 for r in ratios) / len(ratios), 0.683, delta=0.08)
        self.assertGreater(sum(r <= 2 for r in ratios) / len(ratios), 0.90)

    def test_without_a_filter_measured_samples_stay_as_they_are(self):
        self.good("convert", self.c3d, "raw.csv", "--quiet")
        raw = self.rows(self.folder / "raw.csv")
        self.good("clean", self.c3d, "same.csv", "--filter", "none", "--quiet")
        for key, row in self.rows(self.folder / "same.csv").items():
            self.assertEqual([row[k] for k in ("x_m", "y_m", "z_m", "state")], [raw[key][k] for k in ("x_m", "y_m", "z_m", "state")])

    def test_errors_of_short_fills_are_as_large_as_their_deviations(self):
        made = run("simulate", "subject", "-o", "lab", "--duration", 4, "--dropout-random", 0.08, cwd=self.folder)
        self.assertEqual(made.status, 0, made.err)
        self.good("convert", "lab/truth.trc", "truth.csv", "--quiet")
        self.good("clean", "lab/markers.c3d", "filled.csv", "--gaps", "auto", "--filter", "none", "--quiet")
        truth, filled = self.rows(self.folder / "truth.csv"), self.rows(self.folder / "filled.csv")
        ratios = []
        for gap in json.loads((self.folder / "filled_report.json").read_text())["gaps"]:
            frames = range(gap["first_frame"], gap["last_frame"] + 1)
            if not gap["filled"] or gap["at_edge"] or len(frames) > 10:
                continue
            for frame in frames:
                row, true = filled[str(frame), gap["marker"]], truth[str(frame), gap["marker"]]
                self.assertIn(row["state"], ("interpolated", "model_filled"))
                self.assertEqual(row["method"], "auto")
                ratios += [abs(float(row[f"{a}_m"]) - float(true[f"{a}_m"])) / float(row[f"sd_{a}_m"]) for a in "xyz"]
        self.assertGreater(len(ratios), 500)
        self.assertGreater(sum(r <= 1 for r in ratios) / len(ratios), 0.65)
        self.assertGreater(sum(r <= 2 for r in ratios) / len(ratios), 0.93)

    def test_derivatives_are_those_of_the_true_path(self):
        self.good("clean", self.c3d, "d.csv", "--derivatives", "--quiet")
        names, rows = table(self.folder / "d_derivatives.sto")
        self.good("convert", self.recorded / "truth.trc", "truth.csv", "--quiet")
        truth = self.rows(self.folder / "truth.csv")
        self.assertEqual(len(names), 1 + 40 * 3 * 3 * 2, "velocity, acceleration and jerk of three axes, each with its deviation")
        ratios = []
        for marker in ("LFHD", "RELB", "LWRA", "RKNE", "LTOE"):
            for axis in "xyz":
                x = [float(truth[str(frame), marker][f"{axis}_m"]) for frame in range(1, 101)]
                value, sd = names.index(f"{marker}_v{axis}"), names.index(f"{marker}_v{axis}_sd")
                for f in range(1, 99):
                    if math.isfinite(rows[f][value]):
                        ratios.append(abs(rows[f][value] - (x[f + 1] - x[f - 1]) / 0.02) / rows[f][sd])
        self.assertGreater(len(ratios), 1000)
        self.assertGreater(sum(r <= 1 for r in ratios) / len(ratios), 0.55)
        self.assertGreater(sum(r <= 2 for r in ratios) / len(ratios), 0.85)


if __name__ == "__main__":
    unittest.main()
