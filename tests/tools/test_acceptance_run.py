# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import contextlib
import io
import os
import unittest
from unittest import mock

from support import PROJECT, Tree, load_script

acceptance = load_script(PROJECT / "tests" / "acceptance" / "run.py")

GOOD = 'print("a remark")\nprint("NOTE | cost | - | 5 s")\nprint("PASS | angles | <= 1 deg | 0.5 deg")\nprint("SKIP|oracle|same|absent")\n'
BAD = 'print("the reason")\nprint("FAIL | speed | >= 10 | 3")\nraise SystemExit(1)\n'


class RunAcceptance(unittest.TestCase):
    def run_with(self, checks, scripts, arguments=(), programs=(), allow_missing="1"):
        """(exit status, what was printed) of the runner on a scratch folder of checks."""
        with Tree({"checks.toml": checks, "build/bin/.keep": "", **scripts}) as root:
            for name in programs:
                program = root / "build" / "bin" / name
                program.write_text("#!/bin/sh\n[ $1 = --list ] && echo check && exit\necho 'PASS | it runs | yes | '$1\n")
                program.chmod(0o755)
            out = io.StringIO()
            allowed = mock.patch.dict(os.environ, KINEMARK_ALLOW_MISSING_DATA=allow_missing)
            with allowed, contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
                status = acceptance.main(["--build", str(root / "build"), *arguments], here=root)
            return status, out.getvalue()

    def test_collects_rows_of_scripts_and_programs(self):
        status, said = self.run_with(
            '[one]\nscript = "one.py"\n[two]\nprogram = "accept_two"\narguments = ["check"]\n', {"one.py": GOOD}, programs=["accept_two"]
        )
        self.assertEqual(status, 0, said)
        self.assertIn("PASS | angles  | <= 1 deg | 0.5 deg\n", said)
        self.assertIn("SKIP | oracle  | same     | absent\n", said)
        self.assertIn("PASS | it runs | yes      | check\n", said)
        self.assertTrue(said.endswith("acceptance: 2 passed, 0 failed, 1 skipped, 0 known\n"), said)
        self.assertIn("NOTE | cost    | -        | 5 s\n", said)
        self.assertNotIn("a remark", said)

    def test_a_failed_row_fails_the_run_and_shows_the_notes(self):
        status, said = self.run_with('[bad]\nscript = "bad.py"\n', {"bad.py": BAD})
        self.assertEqual(status, 1)
        self.assertIn("    the reason\n", said)
        self.assertIn("FAIL | speed | >= 10 | 3\n", said)
        self.assertTrue(said.endswith("0 passed, 1 failed, 0 skipped, 0 known\n"), said)

    def test_nothing_passes_by_silence_by_crashing_or_by_running_on(self):
        for text, expected in [
            ("pass\n", "printed none, exit status 0"),
            ('print("NOTE | cost | - | 5 s")\n', "printed none, exit status 0"),
            (GOOD + "raise SystemExit(1)\n", "exit status 0 | 1"),
            (BAD.replace("Exit(1)", "Exit(3)"), "exit status 0 | 3"),
            ("import time\ntime.sleep(60)\n", "still running"),
        ]:
            with self.subTest(text=text):
                status, said = self.run_with('[x]\nscript = "x.py"\nseconds = 1\n', {"x.py": text})
                self.assertEqual(status, 1, said)
                self.assertIn(expected, said)

    def test_a_check_without_its_recordings_fails_unless_allowed(self):
        status, said = self.run_with('[one]\nscript = "one.py"\n', {"one.py": GOOD}, allow_missing="")
        self.assertEqual(status, 1)
        self.assertIn("FAIL | oracle | same     | absent, or KINEMARK_ALLOW_MISSING_DATA=1\n", said)

    def known(self, measured, row="speed", better="higher", figure="([0-9.]+)", script=BAD):
        """The runner on a check whose row `speed` measures 3, a shortfall that was `measured` before."""
        checks = (
            '[x]\nscript = "x.py"\n[[expected_failures]]\ncheck = "x"\n'
            f'row = "{row}"\nreason = "slow disks"\nmeasured = {measured}\nbetter = "{better}"\nfigure = "{figure}"\n'
        )
        return self.run_with(checks, {"x.py": script})

    def test_a_known_shortfall_is_listed_apart_and_fails_nothing(self):
        for measured, better in [(3.0, "higher"), (3.3, "higher"), (0.1, "higher"), (2.8, "lower"), (99, "lower")]:
            status, said = self.known(measured, better=better)
            self.assertEqual(status, 0, said)
            self.assertIn("\nKnown shortfalls:\n", said)
            self.assertIn("KNOWN | speed | >= 10 | 3 (slow disks)\n", said)
            self.assertTrue(said.endswith("acceptance: 0 passed, 0 failed, 0 skipped, 1 known\n"), said)

    def test_a_known_shortfall_that_got_worse_passes_or_is_gone_fails(self):
        passes = BAD.replace("FAIL", "PASS").replace("raise SystemExit(1)", "")
        for settings, expected in [
            ({"measured": 3.4}, "3 (worse than the known 3.4 by more than a tenth)"),
            ({"measured": 2.7, "better": "lower"}, "3 (worse than the known 2.7 by more than a tenth)"),
            ({"measured": 3, "script": passes}, "passes now; take it out of expected_failures"),
            ({"measured": 3, "row": "spee"}, "prints no such row"),
            ({"measured": 3, "figure": "([0-9]+) m/s"}, "no figure"),
            ({"measured": 3, "better": "lower", "script": BAD.replace("10 | 3", "10 | 3 and 4")}, "3 and 4 (worse than"),
        ]:
            with self.subTest(**settings):
                status, said = self.known(**settings)
                self.assertEqual(status, 1, said)
                self.assertIn(expected, said)

    def test_a_program_that_is_absent_or_not_listed_fails(self):
        status, said = self.run_with('[x]\nprogram = "accept_x"\n', {})
        self.assertEqual(status, 1)
        self.assertIn("is not there; build it first", said)
        status, said = self.run_with("", {}, programs=["accept_forgotten"])
        self.assertEqual(status, 1)
        self.assertIn("accept_forgotten check | is listed in checks.toml", said)

    def test_quick_and_names_choose(self):
        checks = '[slow]\nscript = "bad.py"\n[fast]\nscript = "one.py"\nquick = true\n'
        scripts = {"one.py": GOOD, "bad.py": BAD}
        self.assertEqual(self.run_with(checks, scripts, ["--quick"])[0], 0)
        self.assertEqual(self.run_with(checks, scripts, ["fast"])[0], 0)
        self.assertEqual(self.run_with(checks, scripts)[0], 1)
        status, said = self.run_with(checks, scripts, ["fsat"])
        self.assertEqual(status, 2)
        self.assertIn("no check fsat; there are: slow, fast", said)

    def test_refuses_a_list_that_it_does_not_understand(self):
        for checks, expected in [
            ('[x]\nscript = "x.py"\nquikc = true\n', "unknown key 'quikc'"),
            ("[x]\nquick = true\n", "needs either a program or a script"),
            ('[x]\nscript = "x.py"\nprogram = "x"\n', "needs either a program or a script"),
            ('[[expected_failures]]\ncheck = "x"\n', "an expected failure has better, check, figure"),
            (
                "[[expected_failures]]\n" + "".join(f'{key} = "(1)"\n' for key in sorted(acceptance.EXPECTED_KEYS)),
                "an expected failure names no check: '(1)'",
            ),
        ]:
            status, said = self.run_with(checks, {})
            self.assertEqual(status, 2)
            self.assertIn(expected, said)


class Listed(unittest.TestCase):
    def test_the_projects_own_list_can_be_read(self):
        acceptance.read_checks(PROJECT / "tests" / "acceptance" / "checks.toml")


if __name__ == "__main__":
    unittest.main()
