# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import contextlib
import io
import unittest

from support import PROJECT, Tree, load_script

acceptance = load_script(PROJECT / "tests" / "acceptance" / "run.py")

GOOD = 'print("a note")\nprint("PASS | angles | <= 1 deg | 0.5 deg")\nprint("SKIP|oracle|same|absent")\n'
BAD = 'print("the reason")\nprint("FAIL | speed | >= 10 | 3")\nraise SystemExit(1)\n'


class RunAcceptance(unittest.TestCase):
    def run_with(self, checks, scripts, arguments=(), programs=()):
        """(exit status, what was printed) of the runner on a scratch folder of checks."""
        with Tree({"checks.toml": checks, "build/bin/.keep": "", **scripts}) as root:
            for name in programs:
                program = root / "build" / "bin" / name
                program.write_text("#!/bin/sh\necho 'PASS | it runs | yes | yes'\n")
                program.chmod(0o755)
            out = io.StringIO()
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(out):
                status = acceptance.main(["--build", str(root / "build"), *arguments], here=root)
            return status, out.getvalue()

    def test_collects_rows_of_scripts_and_programs(self):
        status, said = self.run_with(
            '[one]\nscript = "one.py"\n[two]\nprogram = "accept_two"\n', {"one.py": GOOD}, programs=["accept_two"]
        )
        self.assertEqual(status, 0, said)
        self.assertIn("PASS | angles  | <= 1 deg | 0.5 deg\n", said)
        self.assertIn("SKIP | oracle  | same     | absent\n", said)
        self.assertIn("PASS | it runs | yes      | yes\n", said)
        self.assertTrue(said.endswith("acceptance: 2 passed, 0 failed, 1 skipped\n"), said)
        self.assertNotIn("a note", said)

    def test_a_failed_row_fails_the_run_and_shows_the_notes(self):
        status, said = self.run_with('[bad]\nscript = "bad.py"\n', {"bad.py": BAD})
        self.assertEqual(status, 1)
        self.assertIn("    the reason\n", said)
        self.assertIn("FAIL | speed | >= 10 | 3\n", said)
        self.assertTrue(said.endswith("0 passed, 1 failed, 0 skipped\n"), said)

    def test_nothing_passes_by_silence_by_crashing_or_by_running_on(self):
        for text, expected in [
            ("pass\n", "printed none, exit status 0"),
            (GOOD + "raise SystemExit(3)\n", "exit status 0 | 3"),
            ("import time\ntime.sleep(60)\n", "still running"),
        ]:
            with self.subTest(text=text):
                status, said = self.run_with('[x]\nscript = "x.py"\nseconds = 1\n', {"x.py": text})
                self.assertEqual(status, 1, said)
                self.assertIn(expected, said)

    def test_a_program_that_is_absent_or_not_listed_fails(self):
        status, said = self.run_with('[x]\nprogram = "accept_x"\n', {})
        self.assertEqual(status, 1)
        self.assertIn("is not there; build it first", said)
        status, said = self.run_with("", {}, programs=["accept_forgotten"])
        self.assertEqual(status, 1)
        self.assertIn("accept_forgotten | is listed in checks.toml", said)

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
        ]:
            status, said = self.run_with(checks, {})
            self.assertEqual(status, 2)
            self.assertIn(expected, said)


class Listed(unittest.TestCase):
    def test_the_projects_own_list_can_be_read(self):
        acceptance.read_checks(PROJECT / "tests" / "acceptance" / "checks.toml")


if __name__ == "__main__":
    unittest.main()
