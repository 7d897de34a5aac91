# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""kinemark segments, from outside, by its door analyze."""

import csv
import json
import math
import unittest

from support import CommandTest, real_file
from test_measures import write_trc

DEFINITION = """
title = "An elbow"
[[segment]]
name = "arm"
origin = "A1"
first = ["z", "A2 - A1"]
second = ["x", "A3 - A1"]
[[segment]]
name = "forearm"
origin = "F1"
first = ["z", "F2 - F1"]
second = ["x", "F3 - F1"]
[[angle]]
name = "elbow"
parent = "arm"
child = "forearm"
sequence = "yxz"
components = [["flexion", "y"], ["carrying", "x"], ["pronation", "z"]]
[[value]]
name = "reach"
quantity = "length"
formula = "distance(A1, F1)"
"""
NAMES = ("A1", "A2", "A3", "F1", "F2", "F3")


def flexed(i):
    """A forearm that is flexed by i degrees."""
    c, s = math.cos(math.radians(i)), math.sin(math.radians(i))
    return [(0, 0, 900), (0, 0, 1200), (100, 0, 900), (0, 0, 600), (300 * s, 0, 600 + 300 * c), (100 * c, 0, 600 - 100 * s)]


class Segments(CommandTest):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "elbow.trc"
        self.definition = self.folder / "elbow.toml"
        self.definition.write_text(DEFINITION, encoding="utf-8")
        write_trc(self.file, [flexed(i) for i in range(100)], names=NAMES)

    def analyze(self, *more, status=0):
        result = self.run_in("analyze", self.file, "--segments", self.definition, *more)
        self.assertEqual(result.status, status, result.err)
        return result

    def test_angles_are_those_of_the_movement(self):
        out = self.folder / "out"
        result = self.analyze("--noise", "1", "-o", out, "--json")
        with (out / "angles.csv").open(newline="", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file) if row["component"] == "flexion"]
        self.assertEqual(len(rows), 100)
        for i, row in enumerate(rows):
            self.assertAlmostEqual(float(row["value"]), i, places=3)
            self.assertGreater(float(row["sd"]), 0.1)
            self.assertEqual((row["state"], row["unit"]), ("measured", "deg"))
        reported = json.loads(result.out)
        self.assertEqual([a["name"] for a in reported["angles"]], ["elbow", "reach"])
        self.assertEqual(reported["angles"][0]["measured"], 100)
        self.assertEqual(len(reported["written"]), 6)
        self.assertEqual(self.run_in("info", out / "segments.c3d").status, 0)
        self.analyze("-o", out, status=4)

    def test_what_the_recording_lacks_is_one_sentence(self):
        result = self.analyze("--drop", "F3")
        self.assertIn("Not computed: elbow; there is no marker 'F3'", result.err)
        self.assertIn("An elbow: 0 angles, 1 value and 0 points in 100 frames.", result.err)
        missing = self.analyze("--drop", "A1,F1", status=3)
        self.assertIn("nothing can be computed", missing.err)

    def test_gimbal_lock_is_said(self):
        turned = self.folder / "turned.toml"
        turned.write_text(DEFINITION.replace("yxz", "xyz"), encoding="utf-8")
        result = self.run_in("analyze", self.file, "--segments", turned)
        self.assertIn("flexion is within 5 deg of gimbal lock in", result.err)
        self.assertNotIn("gimbal", self.analyze().err)
        self.assertIn("frames: the other two angles say little there.", result.err)
        self.assertNotIn("the other two angles say little there.", self.analyze().err)

    def test_bad_input_is_a_sentence(self):
        for arguments, status, words in (
            (("--segments", "pigg"), 2, "'pigg' is no definition of segments; expected pig, isb-shoulder or a .toml file"),
            (("--segments", "pig", "--subject", "LegLength"), 2, "is not NAME=VALUE"),
            (("--segments", "pig", "--subject", "LLegLenght=3"), 2, "it has LLegLength"),
            (("--segments", "pig", "--up", "w"), 2, "is not x, y, z"),
            (("--static", self.file), 2, "--static"),
            (("--segments", "pig", "--measures", "path_length"), 2, "--measures"),
            (("--segments", self.folder / "none.toml"), 4, "none.toml"),
            (("--segments", self.file), 3, "elbow.trc"),
            (("--segments", "pig"), 3, "nothing can be computed"),
        ):
            result = self.run_in("analyze", self.file, *arguments)
            self.assertEqual(result.status, status, result.err)
            self.assertIn(words, result.err)
            self.assertEqual(result.out, "")

    def test_a_real_walk(self):
        walk, still = (real_file(f"btk-others/PiG_{name}_FF.c3d") for name in ("Motion3", "Calibration3"))
        result = self.run_in("analyze", walk, "--segments", "pig", "--static", still, "--json")
        self.assertEqual(result.status, 0, result.err)
        reported = json.loads(result.out)
        offsets = {p["name"]: (p["value"], p["from"]) for p in reported["parameters"]}
        self.assertAlmostEqual(offsets["LStaticPlantFlex"][0], math.degrees(0.15718976), places=3)
        self.assertEqual(offsets["LStaticPlantFlex"][1], "the static trial")
        self.assertIn("Motion3", offsets["LLegLength"][1])
        self.assertEqual([c["name"] for c in reported["cross_talk"]], ["LKneeAngles", "RKneeAngles"])
        self.assertIn("no marker 'C7'", result.err)


    def test_an_exchange_in_the_walk_is_named_there_and_blames_nothing_else(self):
        walk, still = (real_file(f"btk-others/PiG_{name}_FF.c3d") for name in ("Motion3", "Calibration3"))
        swap = ("--rename=LHEE=LTOE", "--rename=LTOE=LHEE")
        said = "are exchanged in PiG_Motion3_FF.c3d; all is computed with them exchanged back"
        result = self.run_in("segments", walk, "--definition", "pig", "--static", still, *swap)
        self.assertEqual(result.status, 1, result.err)
        self.assertIn(said, result.err)
        self.assertNotIn("The static trial cannot be built on", result.err)
        self.assertNotIn("LStaticPlantFlex", result.err)
        self.assertIn("It agrees with the file's own 10 angles", result.out + result.err)
        result = self.run_in("segments", walk, "--definition", "pig", "--doubtful", "keep", *swap)
        self.assertEqual(result.status, 1, result.err)
        self.assertIn("what is computed from them is not so", result.err)
        self.assertNotIn("is explained by", result.err)
        result = self.run_in("segments", walk, "--definition", "pig", "--static", still)
        self.assertEqual(result.status, 0, result.err)
        self.assertNotIn("are exchanged", result.err)


class Loads(CommandTest):
    """Forces, moments and powers of a real walk over three plates."""

    def analyze(self, *more):
        walk, still = real_file("btk-others/PiG_Motion3_FF.c3d"), real_file("btk-others/PiG_Calibration3_FF.c3d")
        out = self.folder / "out"
        result = self.run_in("analyze", walk, "--segments", "pig", "--static", still, "-o", out, "--force", "--json", *more)
        self.assertEqual(result.status, 0, result.err)
        return result, out, json.loads(result.out)

    @staticmethod
    def series(out, name, component=""):
        with (out / "loads.csv").open(newline="", encoding="utf-8") as file:
            return [row for row in csv.DictReader(file) if row["name"] == name and row["component"] == component]

    def test_moments_have_deviations_and_say_where_nobody_measured(self):
        result, out, found = self.analyze()
        self.assertEqual([(s["body"], s["plate"]) for s in found["steps"]],
                         [("LFoot", "plate 1"), ("LFoot", "plate 3"), ("RFoot", "plate 2")])
        names = [load["name"] for load in found["loads"]]
        for side in "LR":
            for joint in ("Ankle", "Knee", "Hip"):
                for kind in ("Force", "Moment", "Power"):
                    self.assertIn(f"{side}{joint}{kind}", names)
        rows = self.series(out, "RAnkleMoment", "plantarflexion")
        self.assertEqual(len(rows), 293)
        known = [row for row in rows if row["value"]]
        self.assertTrue(all(float(row["sd"]) > 0 for row in known))
        self.assertTrue(all(row["state"] == "missing" for row in rows if not row["value"]))
        self.assertEqual({row["unit"] for row in rows}, {"N m/kg"})
        # Pushing off with 1.2 to 1.9 N m/kg is what people do.
        self.assertTrue(1.2 < max(float(row["value"]) for row in known) < 1.9)
        self.assertIn("RFoot: on the floor without a plate that measures it in ", result.err)
        self.assertTrue((out / "loads.sto").read_text().count("\t") > 1000)
        self.assertTrue((out / "loads_sd.sto").exists())

    def test_body_mass_of_the_command_line_counts(self):
        _, out, _ = self.analyze("--refits", "0")
        light = [float(row["value"]) for row in self.series(out, "LGroundReactionForce", "z") if row["value"]]
        _, out, _ = self.analyze("--refits", "0", "--subject", "Bodymass=148")
        heavy = [float(row["value"]) for row in self.series(out, "LGroundReactionForce", "z") if row["value"]]
        self.assertEqual(len(light), len(heavy))
        for a, b in zip(light, heavy, strict=True):
            self.assertAlmostEqual(a, 2 * b, places=9)
        self.assertTrue(all(not row["sd"] for row in self.series(out, "LGroundReactionForce", "z")))

    def test_a_part_of_a_walk_keeps_its_plates(self):
        _, out, _ = self.analyze("--refits", "0")
        whole = {round(float(row["time_s"]), 3): row["value"] for row in self.series(out, "LAnkleMoment", "plantarflexion")}
        _, out, found = self.analyze("--refits", "0", "--start", "7.7", "--end", "8.6")
        part = [row for row in self.series(out, "LAnkleMoment", "plantarflexion") if row["value"]]
        self.assertGreater(len(part), 70)
        self.assertEqual([step["plate"] for step in found["steps"] if step["body"] == "LFoot"], ["plate 1"])
        # The foot's length is the mean over the frames that are read.
        for row in part[10:-10]:
            self.assertAlmostEqual(float(row["value"]), float(whole[round(float(row["time_s"]), 3)]), delta=0.02)

    def test_gait_page_draws_the_moments_that_were_computed(self):
        page = self.folder / "gait.html"
        _, out, _ = self.analyze("--refits", "0", "--report", page, "--write-cycles", self.folder / "cycles.csv")
        text = page.read_text(encoding="utf-8")
        for title in ("Hip moment, sagittal", "Knee moment, frontal", "Ankle power", "Knee flexion", "Vertical ground reaction"):
            self.assertIn(title, text)
        self.assertIn("N m/kg", text)
        self.assertIn("plantar", text)
        # The cycle's curve is the table's column between its strikes.
        with (self.folder / "cycles.csv").open(newline="", encoding="utf-8") as file:
            cycle = [row for row in csv.DictReader(file) if row["curve"] == "LAnkleMoment_plantarflexion" and row["cycle"] == "1"]
        self.assertGreater(len(cycle), 90)
        peak = max(float(row["value"]) for row in cycle if row["value"])
        column = [float(row["value"]) for row in self.series(out, "LAnkleMoment", "plantarflexion") if row["value"]]
        self.assertTrue(any(abs(peak - value) < 0.02 for value in column))

    def test_a_static_trial_has_none(self):
        still = real_file("btk-others/PiG_Calibration3_FF.c3d")
        out = self.folder / "still"
        result = self.run_in("analyze", still, "--segments", "pig", "--static", still, "-o", out, "--json")
        self.assertEqual(result.status, 0, result.err)
        self.assertEqual(json.loads(result.out)["loads"], [])
        self.assertFalse((out / "loads.csv").exists())

    def test_a_wrong_number_of_refits_is_refused(self):
        walk = real_file("btk-others/PiG_Motion3_FF.c3d")
        result = self.run_in("analyze", walk, "--segments", "pig", "--refits", "3", "--json")
        self.assertEqual(result.status, 2)
        self.assertIn("3 refits: expected 0 or at least ", result.err)


if __name__ == "__main__":
    unittest.main()
