# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""kinemark scale as a user meets it: files, words, exit statuses."""

import json

from support import POSITION, CommandTest, converted, real_file, report_data, run, write_csv


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

    def test_a_static_trial_is_judged_before_it_is_built_on(self):
        self.good("convert", self.markers, "standing.trc")
        text = (self.folder / "standing.trc").read_text()
        ran = self.scale("--model", self.model, "--static", "standing.trc", "-o", "M.osim")
        self.assertEqual(ran.status, 0, ran.err)
        self.assertNotIn("slide on the body", ran.out + ran.err)  # one posture cannot tell
        head = text.splitlines()[3]
        turned = head.replace("LTOE", "*").replace("LHEE", "LTOE").replace("*", "LHEE")
        (self.folder / "wrong.trc").write_text(text.replace(head, turned))
        ran = self.scale("--model", self.model, "--static", "wrong.trc", "-o", "N.osim")
        self.assertEqual(ran.status, 1, ran.err)
        self.assertRegex(ran.out + ran.err, "(LHEE and LTOE|LTOE and LHEE) are exchanged in wrong.trc")
        report = json.loads((self.folder / "N_report.json").read_text())
        self.assertEqual(report["exit_status"], 1)
        self.assertEqual({report["static_trials"][0]["findings"][0][k] for k in ("marker", "partner")}, {"LTOE", "LHEE"})

    def test_functional_joints_go_into_the_model(self):
        thigh = '[[segment]]\nname = "thigh {0}"\nmarkers = ["{0}THI", "{0}THAP", "{0}KNE"]\n'
        hip = '[[joint]]\nname = "hip {0}"\nparent = "pelvis"\nchild = "thigh {0}"\n'
        pelvis = '[[segment]]\nname = "pelvis"\nmarkers = ["LASI", "RASI", "LPSI", "RPSI"]\n'
        (self.folder / "legs.toml").write_text(pelvis + thigh.format("L") + thigh.format("R") + hip.format("L") + hip.format("R"))
        self.good("joints", self.markers, "--segments", "legs.toml", "-o", "found")
        ran = self.scale("--model", self.model, "--markers", self.markers, "--joints", "found", "-o", "M.osim")
        self.assertEqual(ran.status, 0, ran.err)
        report = json.loads((self.folder / "M_report.json").read_text())
        self.assertEqual(sorted(report["joints"]), ["hip_l", "hip_r"])
        free = {p["name"] for p in report["motion"]["parameters"] if p["kind"] == "joint place"}
        self.assertEqual(free, {f"hip_{side}.{axis}" for side in "lr" for axis in "xyz"})
        ran = self.scale("--model", self.model, "--markers", self.markers, "--joints", "legs.toml", "-o", "N.osim")
        self.assertEqual(ran.status, 3)
        self.assertIn("legs.toml: not JSON; need a skeleton.json", ran.err)
        ran = self.scale("--model", self.model, "--setup", "none.xml", "--joints", "found", "-o", "N.osim")
        self.assertNotEqual(ran.status, 0)
        self.assertFalse((self.folder / "N.osim").exists())

    def test_the_page_holds_the_report(self):
        self.good("scale", "--model", self.model, "--markers", self.markers, "-o", "M.osim", "--report", "page.html")
        data = json.loads(report_data((self.folder / "page.html").read_text()))
        self.assertEqual(data["summary"]["kind"], "scale")
        written = json.loads((self.folder / "M_report.json").read_text())
        self.assertEqual(data["result"]["motion"], written["motion"])

    def test_json_is_the_report(self):
        ran = self.scale("-m", self.model, "-t", self.markers, "-o", "M.osim", "--json")
        written = json.loads((self.folder / "M_report.json").read_text())
        for key in ("kinemark_set", "kinemark_sum"):
            self.assertRegex(written.pop(key), r"^[0-9a-f]{16}$")
        self.assertEqual(json.loads(ran.out), written)

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
            (("-m", self.model, "-t", self.markers, "-o", "M.osim", "--max-frames", 1), "need 2 or more"),
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
class KnownSubject(CommandTest):
    """The subject of the recording is the model itself, or one that is larger or smaller by a known factor."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.subject = cls.recorded.parent / "subject"
        made = run("simulate", "subject", "-o", cls.subject, "--duration", 3, "--rate", 60, cwd=cls.recorded)
        assert made.status == 0, made.err
        cls.reports = {factor: cls.scaled(factor) for factor in (0.9, 1.0, 1.1)}

    @classmethod
    def scaled(cls, factor):
        """The report of the model that is adapted to the recording enlarged by a factor."""
        folder = cls.recorded.parent
        rows = converted(cls.subject / "markers.c3d", folder / f"{factor}.csv")
        larger = [row | {axis: repr(factor * float(row[axis])) for axis in POSITION if row[axis]} for row in rows]
        write_csv(folder / f"{factor}.csv", larger)
        ran = run("scale", "-m", cls.model, "-t", folder / f"{factor}.csv", "-o", folder / f"{factor}.osim", "--json", "--quiet", cwd=folder)
        assert ran.status == 0, ran.err
        return json.loads(ran.out)

    @staticmethod
    def lengths(report):
        return {each["name"]: each for each in report["motion"]["lengths"]}

    def test_the_model_of_the_subject_is_found_again(self):
        motion = self.reports[1.0]["motion"]
        self.assertTrue(motion["converged"])
        self.assertAlmostEqual(1e3 * motion["noise_sd_m"], 1.0, delta=0.03)
        found = [each for each in motion["lengths"] if each["determined"]]
        self.assertGreater(len(found), 15)
        for each in found:
            self.assertLess(abs(each["length_m"] - each["initial_m"]), 4 * each["sd_m"], each["name"])

    def test_lengths_grow_with_the_subject(self):
        usual = self.lengths(self.reports[1.0])
        for factor in (0.9, 1.1):
            found = self.lengths(self.reports[factor])
            self.assertEqual(found.keys(), usual.keys())
            for name, each in found.items():
                self.assertEqual(each["determined"], usual[name]["determined"], name)
                if each["determined"]:
                    self.assertAlmostEqual(each["length_m"] / usual[name]["length_m"] / factor, 1.0, delta=0.005, msg=name)

    def test_the_larger_model_solves_the_larger_recording(self):
        folder = self.recorded.parent
        rms = {}
        for model in (self.model, folder / "1.1.osim"):
            self.good("ik", "-m", model, "-t", folder / "1.1.csv", "-o", "q.mot", "--force", "--quiet", "--max-rms", 1000)
            rms[model.name] = json.loads((self.folder / "q_report.json").read_text())["rms_error_mm"]
        self.assertLess(rms["1.1.osim"], 2.0)
        self.assertGreater(rms["model.osim"], 10.0)

    def test_sizes_that_the_markers_leave_open_have_wide_deviations(self):
        motion = self.reports[1.0]["motion"]
        sizes = [each for each in motion["parameters"] if each["kind"] == "size"]
        open_sizes = {each["name"] for each in sizes if not each["determined"]}
        self.assertEqual(open_sizes, {"head", "hand_r", "hand_l", "foot_r"})
        self.assertLessEqual(open_sizes, set(motion["not_determined"]))
        for each in sizes:
            self.assertLessEqual(each["sd"], each["prior_sd"], each["name"])
            self.assertEqual(each["sd"] > 0.03, each["name"] in open_sizes, each["name"])
        for each in motion["parameters"]:
            if each["kind"] == "marker place" and not each["determined"]:
                self.assertGreater(each["sd"], 0.5 * each["prior_sd"], each["name"])

    def test_symmetric_bodies_have_one_size_for_both_sides(self):
        options = ("-m", self.model, "-t", self.subject / "markers.c3d", "-o", "s.osim", "--json", "--quiet")
        report = json.loads(self.good("scale", *options, "--symmetric").out)
        pairs = [(name, name[:-2] + "_l") for name in report["factors"] if name.endswith("_r")]
        self.assertGreater(len(pairs), 8)
        for right, left in pairs:
            self.assertEqual(report["factors"][right], report["factors"][left], right)
        uneven = self.reports[1.0]["factors"]
        self.assertTrue(any(uneven[right] != uneven[left] for right, left in pairs))

    def test_the_mass_is_that_of_the_subject_however_it_is_shared(self):
        for options in ((), ("--dempster",)):
            self.good("scale", "-m", self.model, "-t", self.c3d, "-o", "m.osim", "--mass", 60, "--force", "--quiet", *options)
            self.assertAlmostEqual(json.loads(self.good("info", "m.osim", "--json").out)["mass_kg"], 60.0, places=6)
