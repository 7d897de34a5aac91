# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""What is typed wrong, or as in another program, is answered with what was meant."""

import unittest

from support import CommandTest

# What is typed, and the words that the answer must have.
SLIPS = (
    # Letters wrong.
    (("jonits", "x.c3d"), "did you mean joints?"),
    (("IK", "-m", "m.osim"), "did you mean ik?"),
    (("calib", "x.mcap"), "did you mean calibrate?"),
    (("cnvert", "a.c3d", "b.trc"), "did you mean convert?"),
    (("Clean", "a.c3d", "b.trc"), "did you mean clean?"),
    (("tracking",), "did you mean track?"),
    (("simulate", "subjet", "-o", "s"), ("'simulate' has no 'subjet'", "did you mean subject?")),
    (("study", "poisner"), ("'study' has no 'poisner'", "did you mean poizner?")),
    (("ik", "--modell", "m.osim"), ("unknown option '--modell'", "did you mean --model?")),
    (("ik", "--max_rms", "3"), "did you mean --max-rms?"),
    (("ik", "--marker=t.trc"), "did you mean --markers?"),
    (("clean", "a.c3d", "b.c3d", "--derivates"), "did you mean --derivatives?"),
    (("clean", "a.c3d", "b.c3d", "--cut-off", "6"), "did you mean --cutoff"),
    (("info", "--jsno", "a.c3d"), "did you mean --json?"),
    (("scale", "--symetric"), "did you mean --symmetric?"),
    # Habits from OpenSim.
    (("run-tool", "setup.xml"), "'kinemark ik --setup' does that"),
    (("InverseKinematics", "setup.xml"), "'kinemark ik' does that"),
    (("inverse_dynamics", "setup.xml"), "'kinemark dynamics --torques' does that"),
    (("ScaleTool", "setup.xml"), "'kinemark scale' does that"),
    (("ik", "-setup", "s.xml"), "write '--setup'"),
    (("ik", "-model", "m.osim", "-markers", "t.trc"), "write '--model'"),
    # Habits from Nexus, QTM and Visual3D.
    (("fill", "a.c3d"), "'kinemark clean' does that"),
    (("filter", "a.c3d"), "'kinemark clean' does that"),
    (("export", "a.c3d"), "'kinemark convert' does that"),
    (("score", "a.c3d"), "'kinemark joints --method score' does that"),
    (("plot", "q.mot"), "'kinemark report' does that"),
    # Habits from the shell.
    (("ls",), "'kinemark info' does that"),
    (("completion", "bash", "zsh"), "'zsh' is one argument too many"),
    (("convert", "a.c3d", "b.trc", "--overwrite"), "unknown option '--overwrite'"),
    (("ik", "--verbos"), "unknown option '--verbos'"),
    (("simulate",), "'simulate' of what?"),
    ((), "no command"),
    (("banana",), "there is no command 'banana'"),
    (("",), "there is no command ''"),
)


class Hints(CommandTest):
    def test_each_slip_is_answered(self):
        self.assertGreaterEqual(len(SLIPS), 30)
        for typed, words in SLIPS:
            with self.subTest(typed=typed):
                self.assertIn("--help'", self.refused(2, words, *typed))

    def test_what_is_far_from_everything_is_not_guessed(self):
        for typed in (("banana",), ("zzzzzz",), ("ik", "--banana")):
            self.assertNotIn("did you mean", self.refused(2, typed[-1], *typed))

    def test_a_file_in_place_of_a_command(self):
        said = self.refused(2, "there is no command", self.c3d)
        self.assertIn("kinemark info", said)

    def test_help_is_a_command_too(self):
        self.assertEqual(self.good("help", "ik").out, self.good("ik", "--help").out)
        self.assertEqual(self.good("help", "simulate", "rig").out, self.good("simulate", "rig", "--help").out)
        self.assertEqual(self.good("help").out, self.good("--help").out)
        self.refused(2, ["there is no command 'jonits'", "did you mean joints?"], "help", "jonits")
        self.refused(2, ["'simulate' has no 'subjet'", "did you mean subject?"], "help", "simulate", "subjet")

    def test_what_is_sound_is_not_taken_for_a_slip(self):
        self.good("info", self.c3d)
        self.good("simulate", "arm", "-o", "a", "--frames", 2, "--noise", "-0")


if __name__ == "__main__":
    unittest.main()
