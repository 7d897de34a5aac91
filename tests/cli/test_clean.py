# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark clean` from outside: formats, provenance, options, bad input."""

import csv
import json
import unittest

from support import CommandTest, real_file, report_data, table


class Clean(CommandTest):
    def info(self, name):
        return json.loads(self.good("info", name, "--json").out)

    def test_smooths_and_fills_nothing_unless_asked(self):
        self.good("clean", self.c3d, "out.c3d")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["out.c3d", "out_report.json"])
        self.assertEqual(self.info("out.c3d")["missing"], self.info(self.c3d)["missing"])

    def test_fills_short_gaps_and_says_so_in_every_format(self):
        missing = self.info(self.c3d)["missing"]
        for ending in ("c3d", "nwb", "csv"):
            with self.subTest(ending=ending):
                self.good("clean", self.c3d, f"{ending}.{ending}", "--gaps", "auto", "--quiet")
                left = self.info(f"{ending}.{ending}")["missing"]
                self.assertLess(left, 0.7 * missing)
                self.good("convert", f"{ending}.{ending}", f"from_{ending}_.csv", "--quiet")
                with open(self.folder / f"from_{ending}_.csv", encoding="utf-8", newline="") as file:
                    lines = (line for line in file if not line.startswith("#"))
                    states = [row["state"] for row in csv.DictReader(lines)]
                made = sum(state in ("interpolated", "model_filled") for state in states)
                self.assertEqual(made, missing - left)

    def test_derivatives_beside_or_inside(self):
        self.good("clean", self.c3d, "out.trc", "--derivatives")
        names, rows = table(self.folder / "out_derivatives.sto")
        self.assertEqual(len(names), 1 + 18 * 40)
        self.assertEqual(len(rows), 100)
        self.good("clean", self.c3d, "inside.nwb", "--derivatives")
        self.assertFalse((self.folder / "inside_derivatives.sto").exists())

    def test_account_and_page_tell_the_same(self):
        self.good("clean", self.c3d, "out.c3d", "--gaps", "auto", "--report", "page.html")
        account = json.loads((self.folder / "out_report.json").read_text(encoding="utf-8"))
        page = json.loads(report_data((self.folder / "page.html").read_text(encoding="utf-8")))
        self.assertEqual(account["schema"], "kinemark.clean_report")
        self.assertEqual(len(account["markers"]), 40)
        self.assertEqual(page["summary"]["markers"], account["markers"])
        printed = self.good("clean", self.c3d, "again.c3d", "--gaps", "auto", "--json").out
        self.assertEqual(json.loads(printed)["markers"], account["markers"])

    def test_every_filter_runs(self):
        for name in ("none", "kalman", "butterworth", "gcv", "savgol", "classic"):
            with self.subTest(filter=name):
                self.good("clean", self.c3d, f"{name}.csv", "--filter", name, "--quiet")

    def test_wrong_words_and_numbers(self):
        self.refused(2, ["best", "auto"], "clean", self.c3d, "x.c3d", "--gaps", "best")
        self.refused(2, ["best", "kalman"], "clean", self.c3d, "x.c3d", "--filter", "best")
        self.refused(2, ["drop", "decimate"], "clean", self.c3d, "x.c3d", "--upsampled", "drop")
        self.refused(2, "60", "clean", self.c3d, "x.c3d", "--filter", "butterworth", "--cutoff", 60)
        self.refused(2, ".xyz", "clean", self.c3d, "x.xyz")
        for option in ("--max-gap", "--max-gap-sd"):
            for value in (-1, "nan", 0):
                self.refused(2, "need more than 0", "clean", self.c3d, "x.c3d", "--gaps", "auto", option, value)
        self.refused(4, "none.c3d", "clean", "none.c3d", "x.c3d")
        self.write("bad.c3d", "not a C3D file")
        self.refused(3, "bad.c3d", "clean", "bad.c3d", "x.c3d")
        self.write("x.c3d", "mine")
        self.refused(4, "--force", "clean", self.c3d, "x.c3d")

    def test_a_real_walk(self):
        walk = real_file("kineticstoolkit/walkingOptiTrack.c3d")
        self.good("clean", walk, "walk.nwb", "--gaps", "auto", "--derivatives", "--quiet")
        self.assertLess(self.info("walk.nwb")["missing"], self.info(walk)["missing"])

    def test_a_trial_with_model_outputs_among_its_points(self):
        """Angles, forces, moments and powers stored as points are carried, never cleaned and never mentioned."""
        trial = real_file("btk-others/PiG_Motion3_FF.c3d")
        said = self.good("clean", trial, "trial.c3d", "--gaps", "auto")
        before, after = self.info(trial), self.info("trial.c3d")
        self.assertEqual(after["frames"], before["frames"])
        self.assertEqual(after["channels"], before["channels"])
        self.assertEqual(len(before["channels"]), 36)
        for channel in before["channels"]:
            self.assertNotIn(channel["name"], said.out + said.err)


if __name__ == "__main__":
    unittest.main()
