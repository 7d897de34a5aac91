# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""kinemark track: options, files, sentences and exit statuses."""

import json
import shlex
import unittest

from support import CommandTest, report_data, run, table


class Track(CommandTest):
    def track(self, **options):
        words = ["track", "-m", self.model, "-t", self.c3d, "-o", "q.mot"]
        for name, value in options.items():
            words += [f"--{name.replace('_', '-')}", value]
        return words

    def test_it_writes_its_files_and_says_so(self):
        ran = self.good(*self.track(), "--json")
        for name in (
            "q.mot",
            "q_sd.sto",
            "q_bound.sto",
            "q_tau.sto",
            "q_tau_sd.sto",
            "q_rank.sto",
            "q_marker_errors.sto",
            "q_report.json",
        ):
            self.assertTrue((self.folder / name).is_file(), name)
        self.assertIn("rank", ran.err)
        self.assertIn("direct marker control", json.dumps(json.loads(ran.out)))
        self.refused(4, ["q.mot", "use --force"], *self.track())
        self.good(*self.track(), "--force", "--no-error-bars")

    def test_the_rank_of_every_frame_and_the_deviations_of_torques_are_tables(self):
        self.good(*self.track(level="LASI,RASI,LPSI,RPSI"))
        names, rows = table(self.folder / "q_rank.sto")
        self.assertEqual(names, ["time", "rank", "smallest_singular_value"])
        self.assertEqual(len(rows), 100)
        self.assertTrue(all(row[1] == 6 for row in rows), "four markers of one body fix its six directions")
        self.assertEqual(table(self.folder / "q_tau_sd.sto")[0], table(self.folder / "q_tau.sto")[0])

    def test_the_page_shows_torques_and_bodies_and_is_that_of_report(self):
        self.good(*self.track(report="page.html"))
        data = json.loads(report_data((self.folder / "page.html").read_text()))
        self.assertEqual(data["summary"]["method"], "direct marker control")
        self.assertGreater(data["summary"]["mass_kg"], 10)
        self.assertEqual(len(data["series"]["torques"]), len(data["summary"]["coordinates"]))
        self.assertIn("pelvis", data["scene"]["bodies"]["names"])
        self.good("report", "q.mot", "-o", "again.html")
        again = json.loads(report_data((self.folder / "again.html").read_text()))
        self.assertEqual(again["scene"]["bodies"]["names"], data["scene"]["bodies"]["names"])
        self.assertEqual([t is None for t in again["series"]["torques"]], [t is None for t in data["series"]["torques"]])

    def test_levels_of_priority(self):
        ran = self.good(*self.track(), "--level", "LASI,RASI,LPSI,RPSI", "--level", "*")
        self.assertIn("rank", ran.err)
        report = json.loads((self.folder / "q_report.json").read_text())
        self.assertIn("LASI, RASI, LPSI, RPSI", json.dumps(report))
        self.assertIn(" mm RMS from its goals, ", json.dumps(report))
        self.assertNotIn(", lost movement ", json.dumps(report))
        self.assertIn("Level 2: weight", ran.err)
        names, rows = table(self.folder / "q_levels.sto")
        self.assertEqual(names, ["time", "level_1_mm", "level_2_mm", "relaxed"])
        self.assertEqual(len(rows), 100)
        ran = self.good(*self.track(), "--force", "--level", "LASI,RASI,LPSI,RPSI", "--level", "*", "--strict", "--level-bound", 500)
        self.assertIn("Level 1: strict, bound 500.0 mm", ran.err)
        self.assertNotIn("frames a strict level is beyond its bound.", ran.err + ran.out)

    def test_a_strict_level_beyond_its_bound_fails_a_gate(self):
        ran = self.good(*self.track(), "--level", "LASI,RASI,LPSI,RPSI", "--level", "*", "--strict", "--level-bound", 0.01, status=1)
        self.assertIn("frames a strict level is beyond its bound.", ran.err)
        self.assertIn("was farther from its goals than its bound of 0.0 mm", ran.err)
        self.assertTrue(any(row[-1] == 1 for row in table(self.folder / "q_levels.sto")[1]))

    def test_the_body_is_adapted_to_the_recording(self):
        ran = self.good(*self.track(), "--adapt")
        self.assertRegex(ran.err, r"Sizes from \d+ frames: marker error [\d.]+ mm RMS")
        self.assertRegex(ran.err, r"femur_r: hip_r to knee_r: [\d.]+ \+- [\d.]+ mm, [\d.]+ before")
        self.assertRegex(ran.err, r"thigh_r +x [\d.]+ \+- [\d.]+")
        self.assertTrue((self.folder / "q_model.osim").is_file())
        lengths = json.loads((self.folder / "q_report.json").read_text())["adapted"]["lengths"]
        self.assertIn("femur_r: hip_r to knee_r", [one["name"] for one in lengths])
        self.good("ik", "-m", "q_model.osim", "-t", self.c3d, "-o", "i.mot")
        (self.folder / "r_model.osim").write_text("mine")
        self.refused(4, ["r_model.osim", "use --force"], "track", "-m", self.model, "-t", self.c3d, "-o", "r.mot", "--adapt")

    def test_tasks_that_levels_name_are_followed_and_accounted_for(self):
        ran = self.good(*self.track(), "--level", "coordinate:knee_angle_r=20deg,coordinate:mtp_angle_r=rest", "--level", "orientation:pelvis,distance:LASI-RTOE", "--level", "*")
        self.assertIn("Task coordinate:knee_angle_r=20deg: ", ran.err)
        self.assertIn(" deg RMS from its goal, ", ran.err)
        self.assertIn("Task distance:LASI-RTOE: ", ran.err)
        self.assertIn("; 2 rows for ", ran.err)
        self.assertIn(" directions that are left (a compromise).", ran.err)
        options = dict(json.loads((self.folder / "q_report.json").read_text())["options"])
        self.assertEqual(options["level 2"], "orientation:pelvis, distance:LASI-RTOE")
        self.assertIn(" mm RMS from its goal, ", options["task distance:LASI-RTOE"])

    def test_a_held_coordinate_is_where_it_was_asked_to_be(self):
        words = ["--level", "coordinate:knee_angle_r=20deg", "--level", "*", "--strict", "--level-bound", 500]
        self.good(*self.track(), *words)
        names, rows = table(self.folder / "q.mot")
        knee = names.index("knee_angle_r")
        self.assertTrue(all(abs(row[knee] - 20) < 0.1 for row in rows), [row[knee] for row in rows][:5])

    def test_tasks_that_are_none_are_refused_with_the_nearest_name(self):
        every = ["--level", "*"]
        self.refused(2, ["coordinate 'knee_angel_r'", "did you mean 'knee_angle_r'?"], *self.track(), "--level", "coordinate:knee_angel_r=1deg", *every)
        self.refused(2, ["body 'pelvsi'", "did you mean 'pelvis'?"], *self.track(), "--level", "orientation:pelvsi", *every)
        self.refused(2, ["'coordinate:knee_angle_r'", "holds nothing at a value"], *self.track(), "--level", "coordinate:knee_angle_r", *every)
        asked = ["--level", "coordinate:knee_angle_r=1deg", "--level", "coordinate:knee_angle_r=2deg,*"]
        self.refused(2, ["coordinate 'knee_angle_r' is asked for in level 1 and again in level 2; once is enough"], *self.track(), *asked)
        self.assertFalse((self.folder / "q.mot").exists())

    def test_levels_are_proposed_as_options_that_give_them_again(self):
        ran = self.good(*self.track(), "--propose-levels")
        line = next(line for line in ran.err.splitlines() if line.startswith("Levels proposed: "))
        words = shlex.split(line.removeprefix("Levels proposed: "))
        self.assertEqual(words[0], "--level")
        self.assertEqual(words[-2:], ["--level", "*"])
        first = table(self.folder / "q.mot")
        report = dict(json.loads((self.folder / "q_report.json").read_text())["options"])
        self.assertIn("smallest singular values in ", report["level 1 was proposed"])
        self.good(*self.track(), "--force", *words)
        self.assertEqual(table(self.folder / "q.mot"), first)
        again = dict(json.loads((self.folder / "q_report.json").read_text())["options"])
        self.assertNotIn("level 1 was proposed", again)
        self.assertNotIn("smallest singular values in ", json.dumps(again))
        self.refused(2, ["--propose-levels", "--level"], *self.track(), "--force", "--propose-levels", "--level", "*")

    def test_an_accuracy_is_met_or_refused_before_anything_is_written(self):
        self.refused(3, ["an accuracy of 0.001 deg cannot be had", "would do"], *self.track(accuracy="0.001deg"))
        self.assertFalse((self.folder / "q.mot").exists())
        self.refused(2, "is no angle above 0, as 0.5deg", *self.track(accuracy="fine"))
        self.refused(2, "--accuracy", *self.track(accuracy="5deg"), "--cutoff", 6)
        ran = self.good(*self.track(accuracy="20deg"))
        self.assertIn("Expected error of the angles for this model", ran.err)
        report = (self.folder / "q_report.json").read_text()
        self.assertIn(", lost movement ", report)
        self.assertNotIn(" mm RMS from its goals, ", report)

    def test_what_cannot_be_is_refused_in_a_sentence(self):
        self.refused(2, "no model", "track", "-t", self.c3d, "-o", "q.mot")
        self.refused(2, "unstable for the step", *self.track(step=16.7))
        self.refused(2, "is not KP,KD", *self.track(posture="fast"))
        self.refused(2, "is not NAME=WEIGHT", *self.track(weight="LASI"))
        self.refused(2, "empty name", *self.track(level="LASI,,RASI"))
        self.refused(3, "level 1 names marker 'NOSE'", *self.track(level="NOSE"))
        self.refused(3, "named in level 1 and again", *self.track(level="LASI"), "--level", "LASI")
        self.refused(2, "omega", *self.track(omega=-3))

    def test_a_missed_gate_is_status_1(self):
        self.good(*self.track(max_rms=0.0001), status=1)
        self.assertTrue((self.folder / "q.mot").is_file())

    def test_help_names_what_it_writes(self):
        ran = run("track", "--help", cwd=self.folder)
        self.assertEqual(ran.status, 0)
        for word in ("--level", "--omega", "--step", "--posture", "Q_bound.sto", "Q_rank.sto", "Q_tau_sd.sto"):
            self.assertIn(word, ran.out)


if __name__ == "__main__":
    unittest.main()
