# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark acquire`: trials from a simulated and a replayed device, and how it ends."""

import json
import os
import resource
import signal
import subprocess
import unittest

from support import PROGRAM, SECONDS, CommandTest, run

FAST = "sim:rig?leds=4&fast"
PROGRESS = ["frames", "acknowledged", "dropped_by_device", "dropped_here"]


class Acquire(CommandTest):
    def acquire(self, *words, **options):
        return run("acquire", *words, cwd=self.folder, **options)

    def trial(self, source=FAST, *words, name="trial.mcap"):
        """What a good trial prints as JSON at its end."""
        ran = self.acquire(source, "-o", name, "--json", *words)
        self.assertEqual(ran.status, 0, ran.err)
        return json.loads(ran.out.splitlines()[-1])

    def frames(self, name="trial.mcap"):
        return json.loads(self.good("info", name, "--json").out)

    def test_a_trial_is_recorded_and_checked(self):
        said = self.trial(FAST, "--frames", 700, "--subject", "S1", "--trial", "reach")
        self.assertEqual([said[key] for key in PROGRESS], [700, 700, 0, 0])
        self.assertEqual(said["written"], ["trial.mcap"])
        self.assertEqual(said["ended"], "complete")
        self.assertIn("all 700 frames came and are kept", said["notes"])
        self.assertEqual(len(said["leds"]), 8)
        self.assertIn("700", json.dumps(self.frames()))
        ran = self.acquire(FAST, "-o", "trial.mcap", "--frames", 10)
        self.assertEqual(ran.status, 4, ran.err)
        self.assertIn("--force", ran.err)
        self.assertEqual(self.acquire(FAST, "-o", "trial.mcap", "--frames", 10, "--force", "--quiet").err, "")

    def test_what_was_acquired_is_reconstructed(self):
        self.good("simulate", "rig", "sign", "-o", "lab", "--seed", 3, "--rate", 200, "--duration", 1)
        self.trial("sim:rig?scene=sign&seed=3&seconds=1&fast", "--rate", 200)
        for recording, output in (("trial.mcap", "a.csv"), ("lab/recording.mcap", "b.csv")):
            self.good("reconstruct", recording, "--rig", "lab/rig_true.toml", "-o", output)
        self.assertEqual((self.folder / "a.csv").read_bytes(), (self.folder / "b.csv").read_bytes())

    def test_trials_of_a_session_are_counted_on(self):
        words = (FAST, "--session", "day 1", "--frames", 50, "--trial", "walk")
        self.assertEqual(self.acquire(*words, "--subject", "S1").status, 0)
        ran = self.acquire(*words, "--json")
        self.assertEqual(json.loads(ran.out.splitlines()[-1])["written"], ["day 1/raw/walk_02.mcap"])
        listed = [line for line in (self.folder / "day 1" / "session.toml").read_text().splitlines() if "raw/" in line]
        self.assertEqual(len(listed), 2)
        ran = run("validate", "day 1", cwd=self.folder)
        self.assertEqual(ran.status, 0, ran.err)
        self.assertIn("the checksums of 2 recordings are those of MANIFEST", ran.err)
        ran = self.acquire(*words, "--subject", "S2")
        self.assertEqual(ran.status, 2)
        self.assertIn("of subject 'S1', not 'S2'", ran.err)
        recordings = sorted((self.folder / "day 1" / "raw").iterdir())
        self.assertEqual(len(recordings), 2)
        recordings[0].chmod(0o644)
        recordings[0].write_bytes(recordings[0].read_bytes() + b"x")
        ran = run("validate", "day 1", cwd=self.folder)
        self.assertEqual(ran.status, 3)
        self.assertIn("was changed since it was recorded", ran.err)
        self.assertNotIn("recordings are those of MANIFEST", ran.err)

    def test_a_trial_of_a_session_is_replayed_into_it(self):
        self.assertEqual(self.acquire(FAST, "--session", "day1", "--frames", 50, "--trial", "a").status, 0)
        before = (self.folder / "day1" / "raw" / "a.mcap").read_bytes()
        self.assertEqual(self.acquire("replay:day1/raw/a.mcap?fast", "--session", "day1", "--trial", "a", "--force").status, 0)
        self.assertEqual((self.folder / "day1" / "raw" / "a.mcap").read_bytes(), before)
        self.assertEqual(run("validate", "day1", cwd=self.folder).status, 0)

    def test_a_session_is_refused_where_it_makes_no_sense(self):
        (self.folder / "photos").mkdir()
        (self.folder / "photos" / "a.jpg").write_text("x")
        for words, part in (
            (("--session", "photos", "--trial", "a"), "photos: is no session"),
            (("--session", "new", "--trial", "../a"), "cannot name a file"),
            (("--session", "new", "--trial", "a", "-o", "b.mcap"), "--session names the recording by itself"),
            (("--session", "new", "--trial", "a", "--check"), "--session names the recording by itself"),
            (("--session", "new", "--trial", "a", "--rig", "none.toml"), "none.toml"),
        ):
            ran = self.acquire(FAST, "--frames", 10, *words)
            self.assertIn(ran.status, (2, 4), words)
            self.assertIn(part, ran.err)
        self.assertEqual([path.name for path in (self.folder / "photos").iterdir()], ["a.jpg"])

    def test_a_plan_is_drawn_and_nothing_recorded(self):
        ran = self.acquire("sim:rig?leds=4", "--rate", 100, "--intensity", 0.5, "--plan", "plan.svg", "--json")
        self.assertEqual(ran.status, 0, ran.err)
        said = json.loads(ran.out)
        self.assertEqual((said["written"], said["rate_hz"], said["intensity"]), (["plan.svg"], 100.0, [0.5] * 4))
        self.assertIn("4 LEDs at 2 cameras, 100 frames per second", ran.err)
        self.assertTrue((self.folder / "plan.svg").read_text().lstrip().startswith("<"))
        self.assertEqual(self.acquire("sim:rig?leds=4", "--plan", "plan.svg").status, 4)
        for words, status in ((("sim:rig", "--rate", 9999), 2), (("sim:rig", "-o", "a.mcap"), 2), ((), 2), (("serial:/nowhere",), 5)):
            self.assertEqual(self.acquire(*words, "--plan", "other.svg").status, status, words)
        self.assertEqual([path.name for path in self.folder.iterdir()], ["plan.svg"])

    def test_a_recording_is_replayed(self):
        first = self.trial(FAST, "--frames", 300)
        again = self.trial("replay:trial.mcap?fast", name="again.mcap")
        self.assertEqual(again["leds"], first["leds"])
        self.assertEqual(again["frames"], 300)
        ran = self.acquire("replay:trial.mcap", "-o", "trial.mcap", "--force")
        self.assertEqual(ran.status, 2)

    def test_ctrl_c_keeps_the_trial(self):
        for number, status in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            words = [PROGRAM, "acquire", "sim:rig?leds=2", "-o", f"{status}.mcap", "--json", "--quiet"]
            with subprocess.Popen(words, cwd=self.folder, stdout=subprocess.PIPE, text=True) as ran:
                line = json.loads(ran.stdout.readline())
                self.assertEqual(list(line), PROGRESS)
                os.kill(ran.pid, number)
                said = json.loads(ran.stdout.read().splitlines()[-1])
                self.assertEqual(ran.wait(SECONDS), status)
            self.assertEqual(said["ended"], "stopped")
            self.assertEqual(said["frames"], said["acknowledged"])
            self.assertGreaterEqual(said["acknowledged"], line["acknowledged"])
            self.assertNotIn("not closed", self.good("info", f"{status}.mcap").err)

    def test_a_full_disk_ends_it_and_keeps_what_was_acknowledged(self):
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (200_000, 200_000))  # noqa: E731
        ran = self.acquire(FAST, "-o", "trial.mcap", "--json", preexec_fn=limit)
        self.assertEqual(ran.status, 4, ran.err)
        said = json.loads(ran.out.splitlines()[-1])
        self.assertIn("cannot be written", said["error"])
        self.assertGreater(said["acknowledged"], 500)
        self.assertIn(str(said["acknowledged"]), json.dumps(self.frames()))

    def test_a_plug_that_was_pulled_is_counted(self):
        ran = self.acquire(FAST + "&unplug_at=1&unplug_for=1", "-o", "trial.mcap", "--json", "--rate", 100, "--frames", 500)
        self.assertEqual(ran.status, 1, ran.err)
        said = json.loads(ran.out.splitlines()[-1])
        self.assertEqual(said["reopened"], 1)
        self.assertEqual(said["acknowledged"] + said["dropped_by_device"], 500)
        self.assertIn("the device lost", ran.err)

    def test_devices_are_listed(self):
        self.assertIn("sim:rig", self.good("acquire", "--list").out)
        self.assertEqual(json.loads(self.good("acquire", "--list", "--json").out)[-1]["uri"], "sim:rig")

    def test_what_cannot_be_is_refused_with_what_can(self):
        for words, said in (
            ((FAST, "-o", "t.mcap", "--rate", 300), "276.5 frames per second at most"),
            ((FAST, "-o", "t.mcap", "--leds", 5), "5 were asked for; the device has 4"),
            ((FAST, "-o", "t.mcap", "--leds", "a,,b"), "a name is missing"),
            ((FAST, "-o", "t.mcap", "--leds", "0"), "no whole number from 1 to 64"),
            ((FAST, "-o", "t.mcap", "--trigger", "digital"), "no digital line"),
            ((FAST, "-o", "t.mcap", "--trigger", "now"), "none of key"),
            ((FAST, "-o", "t.mcap", "--intensity", "hand"), "neither a number"),
            ((FAST, "-o", "t.mcap", "--intensity", "nose=1"), "no LED 'nose'"),
            ((FAST, "-o", "t.mcap", "--intensity", "2"), "intensity 2"),
            ((FAST, "-o", "t.mcap", "--sync", "often"), "never, background"),
            ((FAST, "-o", "t.csv"), ".mcap"),
            ((FAST,), "--output"),
            (("-o", "t.mcap"), "--list"),
            ((FAST, "-o", "t.mcap", "--rig", "rig.toml"), "--rig is for the menus"),
            ((FAST, "-o", "t.mcap", "--leds", "1e300"), "no whole number from 1 to 64"),
            ((FAST, "-o", "t.mcap", "--leds", "1.5"), "no whole number from 1 to 64"),
            ((FAST, "-o", "t.mcap", "--leds", "hand,hand"), "named twice"),
            (("--trigger", "key"), "--trigger is for a recording"),
            (("--force",), "--force is for a recording"),
            ((FAST, "-o", "t.mcap", "--check"), "a check-up keeps nothing"),
            (("usb:1", "-o", "t.mcap"), "address of no device"),
            (("sim:rig?leds=12", "-o", "t.mcap"), "from 1 to 8"),
        ):
            with self.subTest(words=words):
                ran = self.acquire(*words)
                self.assertEqual(ran.status, 2, ran.err)
                self.assertIn(said, ran.err)
                self.assertEqual(list(self.folder.iterdir()), [])
        self.assertEqual(self.acquire(FAST, "-o", "absent/t.mcap", "--frames", 5).status, 4)

    def test_a_device_is_looked_at_and_nothing_kept(self):
        ran = self.acquire("sim:rig?scene=tree&dark&fast", "--check", "--frames", 300)
        self.assertEqual(ran.status, 0, ran.err)
        self.assertIn("none of 300 frames is missing", ran.err)
        self.assertNotIn("! ", ran.err)
        ran = self.acquire("sim:rig?scene=tree&dark&fast&dark_led=2", "--check", "--frames", 300, "--json")
        self.assertEqual(ran.status, 1, ran.err)
        said = json.loads(ran.out.splitlines()[-1])
        self.assertEqual(len(said["wrong"]), 1)
        self.assertIn("dark in camera A", said["wrong"][0])
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_a_trigger_that_never_comes_leaves_no_file(self):
        ran = self.acquire("sim:rig?seconds=1&fast", "-o", "t.mcap", "--trigger", "threshold=1e6")
        self.assertEqual(ran.status, 1, ran.err)
        self.assertIn("the trial did not begin", ran.err)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_without_a_recording_to_write_it_asks_in_lines(self):
        lines = ["o", "sim:rig?leds=3", "", "", "0.2", "S1", "reach", "k", "q"]
        ran = subprocess.run([PROGRAM, "acquire"], cwd=self.folder, input="\n".join(lines) + "\n", capture_output=True, text=True, timeout=SECONDS, check=False)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("is the address of no device", ran.stdout)
        self.assertIn("3 LEDs, 2 cameras", ran.stdout)
        self.assertIn("Kept: reach.mcap", ran.stdout)
        self.assertEqual([p.name for p in self.folder.iterdir()], ["reach.mcap"])
        ran = subprocess.run([PROGRAM, "acquire"], cwd=self.folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=SECONDS, check=False)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("sim:rig", ran.stdout)
        ran = self.acquire("--rig", "absent.toml")
        self.assertEqual(ran.status, 4, ran.err)

    def test_it_begins_with_enter(self):
        words = [PROGRAM, "acquire", FAST, "-o", "trial.mcap", "--frames", "50", "--trigger", "key"]
        ran = subprocess.run(words, cwd=self.folder, input="\n", capture_output=True, text=True, timeout=SECONDS, check=False)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("press Enter to begin", ran.stderr)
        ran = self.acquire(FAST, "-o", "none.mcap", "--trigger", "key")
        self.assertEqual(ran.status, 130)
        self.assertFalse((self.folder / "none.mcap").exists())


if __name__ == "__main__":
    unittest.main()
