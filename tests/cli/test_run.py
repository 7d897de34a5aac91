# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Whole studies: `kinemark run`."""

import json
import os
import shutil
import signal
import subprocess
import time

from support import PROGRAM, SECONDS, CommandTest, listing

STUDY = """
steps = ["scale", "clean", "ik", "report"]

[scale]
model = "model.osim"
max-frames = 40

[clean]
gaps = "cubic"
filter = "none"

[[subject]]
name = "S01"
functional = "S01/move.c3d"
trials = ["S01/walk*.c3d"]

[[subject]]
name = "S 02"
functional = "S02/move.c3d"
mass = 80
trials = ["S02/walk 1.c3d"]
"""


class RunTest(CommandTest):
    def setUp(self):
        super().setUp()
        shutil.copy(self.model, self.folder / "model.osim")
        for place in ("S01/move.c3d", "S01/walk1.c3d", "S01/walk2.c3d", "S02/move.c3d", "S02/walk 1.c3d"):
            (self.folder / place).parent.mkdir(exist_ok=True)
            shutil.copy(self.c3d, self.folder / place)
        self.write("study.toml", STUDY)

    def steps(self, *arguments, status=0):
        """{(subject, trial, step): (status, what was said)} of a run, and its exit status."""
        ran = self.good("run", "study.toml", "--json", *arguments, status=status)
        steps = json.loads(ran.out)["steps"]
        return {(step["subject"], step["trial"], step["step"]): (step["status"], step["said"]) for step in steps}

    def states(self, *arguments, status=0):
        return sorted(state for state, _ in self.steps(*arguments, status=status).values())

    def test_a_study_is_done_once(self):
        self.assertEqual(self.states("--jobs", "2"), ["good"] * 11)
        for name in ("S01/model.osim", "S01/walk1/clean.c3d", "S01/walk2/ik.mot", "S 02/walk 1/ik.html"):
            self.assertTrue((self.folder / "results" / name).is_file(), name)
        before = listing(self.folder)
        self.assertEqual(self.states(), ["there already"] * 11)
        self.assertEqual(listing(self.folder), before)

    def test_from_another_folder_it_is_the_same(self):
        self.states()
        before = listing(self.folder / "results")
        (self.folder / "elsewhere").mkdir()
        done = subprocess.run([PROGRAM, "run", "../study.toml", "--force", "--quiet"], cwd=self.folder / "elsewhere",
                              capture_output=True, timeout=SECONDS, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        after = listing(self.folder / "results")
        self.assertEqual(after.keys(), before.keys())
        for name in before:
            if name.endswith((".mot", ".osim", "clean.c3d")):
                self.assertEqual(after[name], before[name], name)

    def test_the_commands_are_those_that_are_shown(self):
        shown = self.good("run", "study.toml", "--dry-run").out.splitlines()
        self.assertEqual(len(shown), 11)
        self.assertFalse((self.folder / "results").exists())
        self.states("--subject", "S 02")
        made = (self.folder / "results/S 02/walk 1/ik.mot").read_bytes()
        shutil.rmtree(self.folder / "results/S 02/walk 1")
        (self.folder / "results/S 02/walk 1").mkdir()
        for line in shown:
            if "walk 1" in line and "report" not in line:
                done = subprocess.run(["sh", "-c", line.replace("kinemark", f'"{PROGRAM}"', 1)], cwd=self.folder, capture_output=True,
                                      timeout=SECONDS, check=False)
                self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual((self.folder / "results/S 02/walk 1/ik.mot").read_bytes(), made)

    def test_what_changes_is_done_again(self):
        self.states()
        shutil.copy(self.folder / "S01/walk1.c3d", self.folder / "S01/walk3.c3d")
        self.assertEqual(self.states(), ["good"] * 3 + ["there already"] * 11)
        self.write("study.toml", STUDY + "[subject.ik]\nmax-rms = 0.1\n")
        steps = self.steps(status=1)
        self.assertEqual(steps["S 02", "walk 1", "ik"][0], "missed a gate")
        self.assertIn("0.1 mm", steps["S 02", "walk 1", "ik"][1])
        self.assertEqual(sorted(state for state, _ in steps.values()).count("there already"), 12)
        self.assertIn("0.1 mm", self.steps(status=1)["S 02", "walk 1", "ik"][1], "a missed gate is not forgotten")

    def one_trial(self, options=""):
        self.write("study.toml", f"""steps = ["ik", "report"]
[ik]
model = "model.osim"
{options}
[[subject]]
name = "S01"
trials = ["S01/walk1.c3d"]
""")
        return self.folder / "results/S01/walk1"

    def test_results_that_options_leave_out_go(self):
        folder = self.one_trial()
        self.assertEqual(self.states(), ["good", "good"])
        self.assertTrue((folder / "ik_sd.sto").exists())
        self.one_trial("no-error-bars = true")
        self.assertEqual(self.states(), ["good", "good"])
        self.assertFalse((folder / "ik_sd.sto").exists())
        self.one_trial()
        self.assertEqual(self.states(), ["good", "good"])
        self.assertTrue((folder / "ik_sd.sto").exists())

    def test_the_motion_of_a_step_is_analysed(self):
        folder = self.one_trial()
        study = (self.folder / "study.toml").read_text()
        self.write("study.toml", study.replace('"report"]', '"analyze"]') + '\n[analyze]\npoint = "knee=tibia_r:0,0,0"\n')
        self.assertEqual(self.states(), ["good", "good"])
        self.assertTrue((folder / "analysis/ik_PointKinematics_knee_acc_sd.sto").exists())
        self.assertEqual(self.states(), ["there already", "there already"])
        (folder / "analysis/ik_PointKinematics_knee_acc_sd.sto").unlink()
        self.assertEqual(self.states(), ["good", "there already"])

    def test_every_file_of_a_step_counts(self):
        folder = self.one_trial()
        self.states()
        (folder / "ik_marker_errors.sto").unlink()
        self.assertIn("good", self.states())
        self.assertTrue((folder / "ik_marker_errors.sto").exists())
        (folder / "ik_sd.sto").write_text("mine\n")
        failed = self.steps(status=4)[("S01", "walk1", "ik")]
        self.assertEqual(failed[0], "failed")
        self.assertIn("ik_sd.sto: was changed since the run made it", failed[1])

    def test_files_that_a_setup_names_count(self):
        names = [name for name in json.loads(self.good("info", "--json", "S01/walk1.c3d").out)["labels"]][:6]
        tasks = "".join(f'<IKMarkerTask name="{n}"><apply>true</apply><weight>%s</weight></IKMarkerTask>' for n in names)
        write = lambda weight: self.write("tasks.xml", '<OpenSimDocument Version="40000"><IKTaskSet><objects>' +
                                          tasks % ((weight,) * len(names)) + "</objects></IKTaskSet></OpenSimDocument>")
        write(1)
        self.write("setup.xml", '<OpenSimDocument Version="40000"><InverseKinematicsTool><IKTaskSet file="tasks.xml"/>'
                                "</InverseKinematicsTool></OpenSimDocument>")
        self.one_trial('setup = "setup.xml"')
        ik = ("S01", "walk1", "ik")
        self.assertEqual(self.steps()[ik][0], "good")
        self.assertEqual(self.steps()[ik][0], "there already")
        write(2)
        self.assertEqual(self.steps()[ik][0], "good")

    def test_a_broken_recording_stops_the_run_or_costs_its_own_steps(self):
        self.write("S01/walk1.c3d", b"not a C3D file at all" * 100)
        steps = self.steps(status=3)
        self.assertEqual(steps["S01", "walk1", "clean"][0], "failed")
        self.assertIn("walk1.c3d", steps["S01", "walk1", "clean"][1])
        self.assertEqual(sorted(state for state, _ in steps.values()).count("not begun"), 9)
        self.assertEqual(self.states("--keep-going", status=3), ["failed"] + ["good"] * 7 + ["not begun"] * 2 + ["there already"])

    def test_a_file_of_somebody_is_not_replaced(self):
        mine = self.folder / "results/S01/model.osim"
        mine.parent.mkdir(parents=True)
        mine.write_text("mine")
        self.assertIn("no run made it", self.steps(status=4)["S01", None, "scale"][1])
        self.assertEqual(mine.read_text(), "mine")
        self.assertEqual(self.states("--force"), ["good"] * 11)

    def test_a_killed_run_goes_on(self):
        whole = self.folder / "whole"
        self.states("--jobs", "2")
        shutil.move(self.folder / "results", whole)
        for wanted in ("S01/scale.step.json", "S01/walk1/clean.c3d", "S01/walk2/ik.step.json"):
            shutil.rmtree(self.folder / "results", ignore_errors=True)
            running = subprocess.Popen([PROGRAM, "run", "study.toml", "--quiet"], cwd=self.folder, start_new_session=True)
            deadline = time.monotonic() + SECONDS
            while not (self.folder / "results" / wanted).exists() and time.monotonic() < deadline and running.poll() is None:
                time.sleep(0.001)
            running.send_signal(signal.SIGKILL)
            running.wait(SECONDS)
            self.assertIn("good", self.states("--jobs", "2"), wanted)
            after = listing(self.folder / "results")
            self.assertEqual(after.keys(), listing(whole).keys(), "nothing half-written, nothing left over")
            for name, content in listing(whole).items():
                if name.endswith((".mot", ".osim", ".c3d")):
                    self.assertEqual(after[name], content, name)

    def test_two_runs_at_a_time_are_refused(self):
        running = subprocess.Popen([PROGRAM, "run", "study.toml", "--quiet"], cwd=self.folder)
        try:
            deadline = time.monotonic() + SECONDS
            while not (self.folder / "results/S01/scale.step.json").exists() and time.monotonic() < deadline:
                time.sleep(0.001)
            os.kill(running.pid, signal.SIGSTOP)
            ran = self.run_in("run", "study.toml")
            self.assertEqual(ran.status, 4, ran.err)
            self.assertIn("results: another run is at work in it", ran.err)
        finally:
            os.kill(running.pid, signal.SIGCONT)
            self.assertEqual(running.wait(SECONDS), 0)

    def test_what_is_wrong_in_the_file_is_said_before_anything_runs(self):
        for text, words in ((STUDY.replace("gaps", "gasp"), ["study.toml: line 9: clean of subject 'S01'", "--gasp", "did you mean --gaps"]),
                            (STUDY.replace('"ik"', '"iik"'), ["'iik' is none", "did you mean"]),
                            (STUDY.replace("walk*", "jump*"), ["no file fits 'S01/jump*.c3d'"]),
                            (STUDY.replace("mass", "weight"), ["weight"]),
                            (STUDY + '[[subject]]\nname = "../x"\n', ["name must be"]),
                            ("steps = [", ["study.toml"])):
            self.write("study.toml", text)
            self.refused(3, words, "run", "study.toml")
        self.refused(4, "absent.toml", "run", "absent.toml")
        self.write("study.toml", STUDY.replace('"cubic"', '"cubical"'))
        self.assertIn("cubical", self.steps(status=3)["S01", "walk1", "clean"][1])
        self.refused(2, "STUDY is required", "run")

    def test_a_missing_recording_is_the_failure_of_its_step(self):
        self.write("study.toml", STUDY.replace("S02/walk 1.c3d", "S02/none.c3d"))
        steps = self.steps("--keep-going", status=4)
        self.assertEqual(steps["S 02", "none", "clean"][0], "failed")
        self.assertIn("none.c3d", steps["S 02", "none", "clean"][1])
        self.assertEqual(steps["S01", "walk2", "report"][0], "good")
