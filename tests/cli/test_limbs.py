# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark simulate arm`, `simulate macaque` and `study macaque` from outside."""

import csv
import json
import math
import statistics
import unittest
from pathlib import Path

from support import CommandTest, table

MODEL = Path(__file__).resolve().parents[2] / "models" / "macaque_arm.osim"


def truth(path):
    """{name: [(x, y, z), ...]} of a CSV recording without gaps."""
    out = {}
    with open(path, newline="") as file:
        for row in csv.DictReader(file):
            out.setdefault(row["marker"], []).append(tuple(float(row[f"{axis}_m"]) for axis in "xyz"))
    return out


class LimbsTest(CommandTest):
    def test_an_arm_of_the_lengths_asked_for(self):
        self.good("simulate", "arm", "-o", "arm", "--frames", 30, "--segments", "100,120,60", "--markers", 4, "--stagger", 15)
        names = truth(self.folder / "arm/truth.csv")
        self.assertEqual(len(names), 2 + 12)
        for first, second in zip(names["j0"], names["j1"], strict=True):
            self.assertAlmostEqual(math.dist(first, (0, 0, 0)), 0.100, places=9)
            self.assertAlmostEqual(math.dist(first, second), 0.120, places=9)
        self.assertIn('markers = ["s2m0", "s2m1", "s2m2", "s2m3"]', (self.folder / "arm/segments.toml").read_text())

    def test_the_recorder_hands_on_four_times_the_frames(self):
        ran = self.good("simulate", "macaque", "-o", "m", "--duration", 2, "--upsample", 4, "--interpolation", "cubic")
        self.assertIn("477 frames at 240 Hz", ran.out + ran.err)
        self.assertIn("240", self.good("info", "m/markers.c3d").out)

    def test_the_model_wears_the_sleeve(self):
        self.good("simulate", "macaque", "-o", "m", "--duration", 5, "--noise", 0.5)
        self.good("validate", MODEL)
        self.good("ik", "--model", MODEL, "--markers", "m/markers.c3d", "--output", "q.mot")
        names, rows = table(self.folder / "q.mot")
        elbow = names.index("elbow_flexion")
        real = truth(self.folder / "m/truth.csv")
        off = []
        for row, e, f0, f4 in zip(rows, *(real[n] for n in ("elbow", "f0", "f4")), strict=True):
            # LEDs 0 and 4 lie on opposite sides of the forearm (4 x 135 degrees), so that their mean lies on the bone.
            middle = [(a + b) / 2 for a, b in zip(f0, f4)]
            forearm = [m - x for m, x in zip(middle, e)]
            cosine = sum(a * b for a, b in zip(forearm, e)) / math.hypot(*forearm) / 0.150
            off.append(abs(row[elbow] - math.degrees(math.acos(cosine))))
        self.assertLess(statistics.median(off), 1.0)  # degrees
        self.assertLess(max(off), 8.0)

    def test_refusals(self):
        self.refused(2, "missing", "simulate", "arm", "-o", "a", "--missing", 2)
        self.refused(2, "frames", "simulate", "arm", "-o", "a", "--frames", 0)
        self.refused(2, "segments", "simulate", "arm", "-o", "a", "--segments", 100)
        self.refused(2, "duration", "simulate", "macaque", "-o", "a", "--duration", -1)
        self.refused(2, "factor", "simulate", "macaque", "-o", "a", "--duration", 1, "--upsample", 0)
        self.refused(2, "--interpolation", "simulate", "macaque", "-o", "a", "--interpolation", "wavy")
        self.refused(2, "--seeds", "study", "macaque", "--seeds", "4-2")

    def test_files_are_not_replaced_unasked(self):
        self.good("simulate", "arm", "-o", "a", "--frames", 3)
        self.refused(4, "a/markers.c3d", "simulate", "arm", "-o", "a", "--frames", 3)
        self.good("--force", "simulate", "arm", "-o", "a", "--frames", 3)
        # Refused before minutes are spent on the study.
        self.refused(4, "a/markers.c3d", "study", "macaque", "--figures", "a/markers.c3d")

    def test_json_names_the_files(self):
        ran = self.good("--json", "simulate", "arm", "-o", "a", "--frames", 3)
        self.assertIn("segments.toml", json.dumps(json.loads(ran.out)))


if __name__ == "__main__":
    unittest.main()
