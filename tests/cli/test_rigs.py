# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""From counts to points: `simulate rig`, `calibrate` and `reconstruct`, what they print and how they refuse."""

import csv
import json
import math
import re
import unittest

from support import CommandTest, report_data, run

LED_KEYS = ["name", "frames", "located", "occluded", "saturated", "inconsistent", "near_edge", "light", "light_sd", "light_source", "strength_counts"]
FIT_KEYS = ["order", "cutoff_hz", "chi2_per_dof", "rejected", "held_down", "flicker_counts"]
BUNDLE_KEYS = "method chi2_per_dof warp_degree crosstalk iterations poses sightings outliers side_rms_mm alignment written warnings".split()
QUICK = ("--warp-degree", 6, "--no-crosstalk")


class Rigs(CommandTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.lab = cls.recorded.parent / "lab"
        ran = run("simulate", "rig", "sign", "-o", cls.lab, "--duration", 0.5, "--grid", "--tree-poses", "--occlude", "hand:B:10-14", cwd=cls.shared.name)
        assert ran.status == 0, ran.err

    def calibrate(self, *arguments, **options):
        shown = [self.lab / name for name in ("tree_poses.mcap", "grid_A.mcap", "grid_B.mcap")]
        return self.good("calibrate", *shown, "--nominal", self.lab / "rig_nominal.toml", *arguments, **options)

    def reconstruct(self, output, *arguments, rig=None):
        return ["reconstruct", self.lab / "recording.mcap", "--rig", rig or self.lab / "rig_true.toml", "-o", output, *arguments]

    def test_the_bundle_finds_the_rig_and_says_how_well(self):
        ran = self.calibrate("-o", "rig.toml", "--json", *QUICK)
        report = json.loads(ran.out)
        self.assertEqual(list(report), BUNDLE_KEYS)
        self.assertEqual((report["method"], report["poses"], report["written"]), ("bundle", 300, "rig.toml"))
        self.assertLess(report["chi2_per_dof"], 1.2)
        self.assertEqual([camera["camera"] for camera in report["alignment"]["cameras"]], ["A", "B"])
        self.assertRegex(ran.err, r"(?m)^300 poses, chi2/dof \d\.\d\d, warp of degree \d+; tree sides right to \d\.\d\d mm RMS$")
        self.assertRegex(ran.err, r"(?m)^camera A: -?\d+\.\d mm right, ")
        self.assertRegex(ran.err, r"(?m)^next: \S")
        self.assertIn("wrote rig.toml", ran.err)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["rig.toml"])
        points = json.loads(self.good(*self.reconstruct("p.csv", "--method", "frames", "--json", rig="rig.toml")).out)
        self.assertGreater(sum(led["located"] for led in points["leds"]), 180)

    def test_pages_show_cameras_points_and_what_to_turn(self):
        self.calibrate("-o", "rig.toml", "--report", "rig.html", *QUICK)
        data = json.loads(report_data((self.folder / "rig.html").read_text()))
        self.assertEqual([camera["name"] for camera in data["scene"]["cameras"]], ["A", "B"] * 2)
        self.assertEqual([camera["nominal"] for camera in data["scene"]["cameras"]], [False, False, True, True])
        self.assertEqual(data["result"]["poses"], 300)
        self.good(*self.reconstruct("p.c3d", "--method", "frames", "--report", "points.html"))
        data = json.loads(report_data((self.folder / "points.html").read_text()))
        self.assertEqual(data["summary"]["kind"], "reconstruct")
        self.assertEqual(data["scene"]["names"], [led["name"] for led in data["result"]["leds"]])
        self.assertEqual(sum(data["result"]["precision"][0]["samples"]), sum(led["located"] for led in data["result"]["leds"]))
        self.refused(4, "points.html", *self.reconstruct("q.c3d", "--report", "points.html"))
        self.assertFalse((self.folder / "q.c3d").exists())

    def test_alignment_alone_writes_nothing(self):
        ran = self.calibrate("--align", "--json")
        self.assertEqual(list(json.loads(ran.out)), ["method", "alignment", "warnings"])
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_model_that_is_too_poor_is_a_missed_gate(self):
        ran = self.calibrate("-o", "rig.toml", "--warp-degree", 2, "--no-crosstalk", "--no-escalate", status=1)
        self.assertRegex(ran.err, r"(?m)^kinemark: calibration refused: chi2 per degree of freedom is \d+")
        self.assertEqual(sum(line.startswith("kinemark: ") for line in ran.err.splitlines()), 1)
        self.assertEqual(list(self.folder.iterdir()), [], "nothing is written")

    def test_calibrate_refuses_in_one_sentence(self):
        nominal = ("--nominal", self.lab / "rig_nominal.toml")
        tree, grid = self.lab / "tree_poses.mcap", self.lab / "grid_A.mcap"
        self.refused(2, "--output or --align", "calibrate", tree, *nominal)
        self.refused(2, "a grid for 1 of 2 cameras", "calibrate", tree, grid, *nominal, "-o", "rig.toml")
        self.refused(2, "needs a recording of the tree", "calibrate", grid, self.lab / "grid_B.mcap", *nominal, "-o", "rig.toml")
        self.refused(2, "needs a recording of the grid", "calibrate", tree, *nominal, "-o", "rig.toml", "--method", "grid-lut")
        self.refused(3, "a tree, a grid or a scan was expected", "calibrate", self.lab / "recording.mcap", *nominal, "-o", "rig.toml")
        self.refused(4, "none.toml", "calibrate", tree, "--nominal", "none.toml", "-o", "rig.toml")
        for name in ("guess", "0", ""):
            said = self.refused(2, f"'{name}' is not bundle, grid-lut or scan", "calibrate", tree, *nominal, "-o", "r.toml", "--method", name)
            self.assertTrue(said.isprintable())

    def test_reconstruct_tells_every_led_and_by_the_smoother_its_fit(self):
        ran = self.good(*self.reconstruct("frames.csv", "--method", "frames", "--json"))
        report = json.loads(ran.out)
        self.assertEqual(list(report), ["method", "frames", "written", "warnings", "leds"])
        self.assertEqual((report["method"], report["frames"], report["written"]), ("frames", 50, "frames.csv"))
        self.assertTrue(all(list(led) == LED_KEYS for led in report["leds"]))
        hand = next(led for led in report["leds"] if led["name"] == "hand")
        self.assertEqual((hand["located"], hand["occluded"]), (45, 5))
        self.assertIn("hand: 45 of 50 frames located, 5 occluded, ", ran.err)
        smooth = json.loads(self.good(*self.reconstruct("smooth.csv", "--json")).out)
        self.assertEqual(smooth["method"], "smoother")
        self.assertTrue(all(list(led) == LED_KEYS + FIT_KEYS for led in smooth["leds"]))
        facts = json.loads(self.good("info", "smooth.csv", "--json").out)
        self.assertEqual((facts["points"], facts["frames"], facts["missing"]), (4, 50, 0))

    def test_reconstruct_is_quiet_when_asked_and_replaces_nothing(self):
        ran = self.good(*self.reconstruct("a.trc", "--method", "frames", "--quiet"))
        self.assertEqual((ran.out, ran.err), ("", ""))
        self.refused(4, ["a.trc", "use --force"], *self.reconstruct("a.trc", "--method", "frames"))
        self.good(*self.reconstruct("a.trc", "--method", "frames", "--force"))
        one, two = (self.good(*self.reconstruct(name, "--threads", n)) for name, n in (("one.csv", 1), ("two.csv", 2)))
        self.assertEqual(one.out, two.out)
        self.assertEqual((self.folder / "one.csv").read_bytes(), (self.folder / "two.csv").read_bytes())

    def test_reconstruct_lists_what_an_option_may_be(self):
        start = ("reconstruct", self.lab / "recording.mcap", "--rig", self.lab / "rig_true.toml", "-o", "x.csv")
        self.refused(2, "'guess' is not smoother, frames or classic", *start, "--method", "guess")
        self.refused(2, "'1' is not regress, dark-slot or ignore", *start, "--flicker", 1)

    def test_reconstruct_refuses_in_one_sentence(self):
        self.refused(4, "none.mcap", "reconstruct", "none.mcap", "--rig", self.lab / "rig_true.toml", "-o", "p.csv")
        self.refused(4, "none.toml", *self.reconstruct("p.csv", rig="none.toml"))
        self.refused(2, ".xyz", *self.reconstruct("p.xyz", "--method", "frames"))
        self.refused(2, "--flicker", *self.reconstruct("p.csv", "--flicker", "much"))
        self.refused(3, "no look-up table", *self.reconstruct("p.csv", "--method", "classic"))


class SimulatedRigs(CommandTest):
    def test_the_seed_draws_rig_and_noise_and_threads_change_nothing(self):
        for name, options in (("a", []), ("b", ["--threads", 2]), ("c", ["--seed", 2])):
            self.good("simulate", "rig", "tree", "-o", name, "--duration", 0.2, *options)

        def read(name, file):
            return (self.folder / name / file).read_bytes()

        for file in ("rig_true.toml", "recording.mcap", "truth.trc"):
            self.assertEqual(read("a", file), read("b", file), file)
        self.assertNotEqual(read("a", "rig_true.toml"), read("c", "rig_true.toml"))

    def test_a_folder_that_cannot_be_made_or_filled_stays_as_it_is(self):
        self.write("taken", "mine")
        self.refused(4, "cannot be", "simulate", "rig", "tree", "-o", "taken/deeper", "--duration", 0.1)
        self.refused(4, "taken", "simulate", "subject", "-o", "taken", "--duration", 0.1)
        (self.folder / "full").mkdir()
        self.write("full/truth.trc", "mine")
        self.refused(4, ["truth.trc", "use --force"], "simulate", "rig", "tree", "-o", "full", "--duration", 0.1)


class RigsAndTruth(CommandTest):
    """Points of a calibrated rig against the arm that was before it: segments of 310, 280 and 80 mm."""

    SEGMENTS = {("shoulder", "elbow"): 310, ("elbow", "wrist"): 280, ("wrist", "hand"): 80}

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.lab = cls.recorded.parent / "lab"
        ran = run("simulate", "rig", "sign", "-o", cls.lab, "--duration", 1, "--grid", "--tree-poses", "--seed", 5, cwd=cls.shared.name)
        assert ran.status == 0, ran.err
        shown = [cls.lab / name for name in ("tree_poses.mcap", "grid_A.mcap", "grid_B.mcap")]
        ran = run("calibrate", *shown, "--nominal", cls.lab / "rig_nominal.toml", "-o", cls.lab / "rig.toml", cwd=cls.shared.name)
        assert ran.status == 0, ran.err

    def points(self, *arguments, rig=None, recording=None):
        """{(frame, LED): position in metres} of what `reconstruct` writes."""
        recording = recording or self.lab / "recording.mcap"
        self.good("reconstruct", recording, "--rig", rig or self.lab / "rig.toml", "-o", "p.csv", "--force", "--quiet", *arguments)
        with (self.folder / "p.csv").open(newline="") as file:
            return {(int(row["frame"]), row["marker"]): [float(row[f"{a}_m"]) for a in "xyz"] for row in csv.DictReader(file) if row["x_m"]}

    def lengths_mm(self, points):
        """{segment: its lengths in the frames that show both ends}."""
        return {
            (one, other): [1e3 * math.dist(x, points[frame, other]) for (frame, led), x in points.items() if led == one and (frame, other) in points]
            for one, other in self.SEGMENTS
        }

    def test_a_calibrated_rig_measures_lengths_to_a_third_of_a_millimetre(self):
        for method in ("frames", "smoother"):
            for segment, lengths in self.lengths_mm(self.points("--method", method)).items():
                self.assertGreater(len(lengths), 90)
                self.assertAlmostEqual(sum(lengths) / len(lengths), self.SEGMENTS[segment], delta=0.35, msg=f"{segment} by {method}")

    def test_the_smoother_scatters_less_than_frames_alone(self):
        def scatter(method):
            lengths = self.lengths_mm(self.points("--method", method))
            return sum((x - self.SEGMENTS[segment]) ** 2 for segment, all_of_it in lengths.items() for x in all_of_it)

        self.assertLess(scatter("smoother"), 0.5 * scatter("frames"))

    def test_a_rig_set_up_by_hand_finds_few_points_that_agree(self):
        by_hand = self.points("--method", "frames", rig=self.lab / "rig_nominal.toml")
        self.assertLess(len(by_hand), 0.8 * len(self.points("--method", "frames")))

    def test_deviations_are_those_of_the_scatter_about_the_smooth_path(self):
        self.good("reconstruct", self.lab / "recording.mcap", "--rig", self.lab / "rig.toml", "-o", "f.csv", "--method", "frames", "--quiet")
        with (self.folder / "f.csv").open(newline="") as file:
            rows = {(int(row["frame"]), row["marker"]): row for row in csv.DictReader(file) if row["x_m"]}
        ratios = []
        for (frame, led), row in rows.items():
            if led != "shoulder" or any((frame + k, led) not in rows for k in (-1, 1)):
                continue  # it moves slowly: a straight line through its neighbours predicts it
            for a in "xyz":
                x, before, after = (float(rows[frame + k, led][f"{a}_m"]) for k in (0, -1, 1))
                ratios.append((x - 0.5 * (before + after)) / (math.sqrt(1.5) * float(row[f"sd_{a}_m"])))
        self.assertGreater(len(ratios), 270)
        self.assertAlmostEqual(math.sqrt(sum(r * r for r in ratios) / len(ratios)), 1.0, delta=0.2)

    def test_what_is_hidden_is_missing_and_what_is_seen_by_one_camera_too(self):
        lab = self.folder / "hidden"
        self.good("simulate", "rig", "sign", "-o", lab, "--duration", 0.3, "--occlude", "hand:all:5-9", "--occlude", "wrist:A:20-24", "--quiet")
        points = self.points("--method", "frames", rig=lab / "rig_true.toml", recording=lab / "recording.mcap")
        missing = {led: {f for f in range(30) if (f + 1, led) not in points} for led in ("hand", "wrist", "elbow")}
        self.assertEqual(missing, {"hand": set(range(5, 10)), "wrist": set(range(20, 25)), "elbow": set()})

    def test_a_rig_file_takes_no_number_that_is_none(self):
        text = (self.lab / "rig_true.toml").read_text()
        for value in ("nan", "inf"):
            spoilt = re.sub(r"(?m)^focal = .*$", f"focal = {value}", text, count=1)
            self.assertNotEqual(spoilt, text)
            self.write("spoilt.toml", spoilt)
            self.refused(3, ["spoilt.toml", "focal must be a finite number"], "reconstruct", self.lab / "recording.mcap", "--rig", "spoilt.toml", "-o", "p.csv")


if __name__ == "__main__":
    unittest.main()
