# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""kinemark scale as a user meets it: files, words, exit statuses."""

import json

from support import CommandTest, real_file


class Scale(CommandTest):
    def setUp(self):
        super().setUp()
        self.markers = self.c3d

    def scale(self, *arguments):
        return self.run_in("scale", *arguments)

    def test_motion_gives_model_and_report(self):
        ran = self.scale("--model", self.model, "--markers", self.markers, "--mass", 70, "-o", "M.osim")
        self.assertEqual(ran.status, 0, ran.err)
        self.assertEqual({p.name for p in self.folder.iterdir()}, {"M.osim", "M_report.json"})
        report = json.loads((self.folder / "M_report.json").read_text())
        self.assertEqual(report["format"], "kinemark-scale")
        self.assertAlmostEqual(report["mass_kg"], 70, 6)
        self.assertIn("head", report["motion"]["not_determined"])
        self.assertTrue(all(p["sd"] > 0 for p in report["motion"]["parameters"]))
        self.assertIn("Not determined by these data", ran.out + ran.err)

    def test_the_model_is_of_use_at_once(self):
        self.scale("--model", self.model, "--static", self.markers, "-o", "M.osim")
        self.good("ik", "-m", "M.osim", "-t", self.markers, "-o", "Q.mot")

    def test_json_is_the_report(self):
        ran = self.scale("-m", self.model, "-t", self.markers, "-o", "M.osim", "--json")
        self.assertEqual(json.loads(ran.out), json.loads((self.folder / "M_report.json").read_text()))

    def test_opensim_setup(self):
        setup = real_file("opensim-gait2354/subject01_Setup_Scale.xml")
        ran = self.scale("--setup", setup, "-o", "S.osim")
        self.assertEqual(ran.status, 0, ran.err)
        report = json.loads((self.folder / "S_report.json").read_text())
        self.assertAlmostEqual(report["factors"]["pelvis"][0], 1.02458, 4)
        self.assertAlmostEqual(report["factors"]["femur_r"][1], 1.14724, 5)
        self.assertEqual(len(report["placed"]["markers"]), 39)

    def test_poor_fit_is_status_1_with_files(self):
        ran = self.scale("-m", self.model, "-t", self.markers, "-o", "M.osim", "--max-rms", 0.001)
        self.assertEqual(ran.status, 1)
        self.assertTrue((self.folder / "M.osim").is_file())

    def test_wrong_calls_are_status_2_and_leave_nothing(self):
        for arguments, words in (
            ((), "no model"),
            (("-m", self.model, "-o", "M.osim"), "nothing to scale by"),
            (("-m", self.model, "-t", self.markers), "no output"),
            (("-m", self.model, "-t", self.markers, "-o", "M.osim", "--dempster"), "give --mass"),
            (("-m", self.model, "-t", self.markers, "-o", "M.osim", "--mass", -5), "mass of -5"),
            (("-m", self.model, "-t", self.markers, "-o", "M.osim", "--frames", 1), "need 2 or more"),
        ):
            with self.subTest(words):
                self.refused(2, words, "scale", *arguments)

    def test_bad_files_are_status_3_with_one_sentence(self):
        (self.folder / "bad.xml").write_text("<OpenSimDocument Version='40000'><ScaleTool><mass>x</mass></ScaleTool>")
        (self.folder / "other.xml").write_text("<OpenSimDocument Version='40000'><Model/></OpenSimDocument>")
        for setup in ("bad.xml", "other.xml"):
            self.refused(3, setup, "scale", "-m", self.model, "--setup", setup, "-o", "M.osim")

    def test_existing_files_stay_without_force(self):
        (self.folder / "M.osim").write_text("mine")
        ran = self.scale("-m", self.model, "-t", self.markers, "-o", "M.osim")
        self.assertNotEqual(ran.status, 0)
        self.assertEqual((self.folder / "M.osim").read_text(), "mine")
        ran = self.scale("-m", self.model, "-t", self.markers, "-o", "M.osim", "--force")
        self.assertEqual(ran.status, 0, ran.err)
