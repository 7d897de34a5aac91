# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import contextlib
import io
import os
import sys
import unittest
from unittest import mock

from support import Tree, load_tool

tests = load_tool("run_tests")
Counts = tests.Counts


class RunStages(unittest.TestCase):
    def run_stages(self, stages, **options):
        stages = {name: stage if isinstance(stage, tuple) else (stage, 1) for name, stage in stages.items()}
        with Tree({}) as logs, contextlib.redirect_stdout(io.StringIO()) as out:
            status = tests.run_stages(stages, list(stages), logs, **options)
        return status, out.getvalue()

    def test_counts_all_stages_in_a_plain_closing_line(self):
        status, said = self.run_stages({"a": lambda _: Counts(3), "b": lambda _: Counts(4, 0, 2)})
        self.assertEqual(status, 0)
        self.assertTrue(said.endswith("\n7 passed, 0 failed, 2 skipped\n"), said)
        self.assertRegex(said, r"\[ 1/2\] a: good, \d+\.\d s, 0\.0 of 1 processor minutes \(3 passed, 0 failed\)")

    def test_stops_at_the_first_failing_stage_names_it_and_shows_its_log(self):
        def bad(log):
            log.must(sys.executable, "-c", "print('the reason'); raise SystemExit(3)")

        status, said = self.run_stages({"good": lambda _: Counts(1), "bad": bad, "later": lambda _: Counts(1)})
        self.assertEqual(status, 1)
        self.assertIn("\nthe reason\n", said)
        self.assertRegex(said, r"\[ 2/3\] bad: FAILED after \d+\.\d s")
        self.assertIn("; failed: bad\n", said)
        self.assertNotIn("later", said)
        self.assertTrue(said.endswith("\n1 passed, 1 failed\n"), said)

    def test_goes_on_when_asked_to(self):
        def bad(_):
            raise tests.Failed("no", Counts(5, 2))

        status, said = self.run_stages({"bad": bad, "later": lambda _: Counts(1)}, keep_going=True)
        self.assertEqual(status, 1)
        self.assertTrue(said.endswith("\n6 passed, 2 failed\n"), said)

    def test_a_missing_program_fails_its_stage_only(self):
        status, said = self.run_stages({"a": tests.script("/nonexistent/program")})
        self.assertEqual(status, 1)
        self.assertTrue(said.endswith("\n0 passed, 1 failed\n"), said)

    def test_a_stage_over_its_budget_is_reported_and_the_sum_fails_where_asked(self):
        def busy(log):
            log.must(sys.executable, "-c", "import time\nwhile time.process_time() < 0.2: pass")
            return Counts(1)

        stages = {"busy": (busy, 0.001), "idle": (lambda _: Counts(1), 0.001)}
        status, said = self.run_stages(stages)
        self.assertEqual(status, 0)
        self.assertRegex(said, r"busy: good, .* of 0.001 processor minutes, OVER ITS BUDGET \(")
        self.assertRegex(said, r"idle: good, .* of 0.001 processor minutes \(")
        status, said = self.run_stages(stages, budget_minutes=0.002)
        self.assertEqual(status, 0)
        self.assertIn("processor minutes, more than the 0.002 of a whole run\n", said)
        status, said = self.run_stages(stages, budget_minutes=0.002, check_budget=True)
        self.assertEqual(status, 1)
        self.assertIn("; failed: the budget\n2 passed, 1 failed\n", said)
        self.assertEqual(self.run_stages(stages, check_budget=True)[0], 0)

    def test_the_budgets_of_all_stages_fit_into_that_of_a_run(self):
        self.assertLessEqual(sum(budget for _, budget in tests.STAGES.values()), tests.BUDGET_MINUTES)


class MissingData(unittest.TestCase):
    def demand(self, missing, **environment):
        with mock.patch.dict(os.environ, environment):
            if "KINEMARK_ALLOW_MISSING_DATA" not in environment:
                os.environ.pop("KINEMARK_ALLOW_MISSING_DATA", None)
            return tests.demand_data(Counts(5, 0, missing), missing)

    def test_tests_without_data_fail_unless_allowed(self):
        self.assertEqual(self.demand(0), Counts(5))
        with self.assertRaisesRegex(tests.Failed, "^2 tests lack the real recordings; set KINEMARK_TEST_DATA"):
            self.demand(2)
        with self.assertRaises(tests.Failed):
            self.demand(2, KINEMARK_ALLOW_MISSING_DATA="0")
        self.assertEqual(self.demand(2, KINEMARK_ALLOW_MISSING_DATA="1"), Counts(5, 0, 2))

    def test_the_first_stage_says_whether_the_data_are_there(self):
        with Tree({"data/README.md": ""}) as root:
            log = tests.Log(root / "log")
            with mock.patch.dict(os.environ, KINEMARK_TEST_DATA=str(root / "data"), KINEMARK_ALLOW_MISSING_DATA=""):
                self.assertEqual(tests.data(log), Counts(1))
            with mock.patch.dict(os.environ, KINEMARK_TEST_DATA=str(root / "gone"), KINEMARK_ALLOW_MISSING_DATA=""):
                with self.assertRaises(tests.Failed):
                    tests.data(log)
            with mock.patch.dict(os.environ, KINEMARK_TEST_DATA=str(root / "gone"), KINEMARK_ALLOW_MISSING_DATA="1"):
                self.assertEqual(tests.data(log), Counts(0, 0, 1))
            self.assertIn("gone is not there", log.text())

    def test_counts_cases_that_were_skipped_for_want_of_data_only(self):
        cases = """<testsuites><testsuite>
          <testcase name="a" result="completed"/>
          <testcase name="b" result="skipped"><skipped message="x.cc:5&#x0A;SKIPPED: the real recordings are absent"/></testcase>
          <testcase name="c" result="skipped"><skipped message="the sanitizer owns the allocator"/></testcase>
        </testsuite></testsuites>"""
        with Tree({"test_a.xml": cases}) as root:
            self.assertEqual(tests.cases_without_data(root), 1)


class SearchPath(unittest.TestCase):
    def test_a_node_in_the_venv_wins_and_only_then_the_venv_is_searched(self):
        with Tree({".venv/bin/python": ""}) as root:
            self.assertEqual(tests.search_path(root, "/bin"), "/bin")
        with Tree({".venv/bin/node": ""}) as root:
            self.assertEqual(tests.search_path(root, "/bin"), f"{root}/.venv/bin:/bin")


class Choose(unittest.TestCase):
    def test_chooses_in_the_order_of_the_stages(self):
        stages = dict.fromkeys("abcd")
        self.assertEqual(tests.choose(stages, None, None), ["a", "b", "c", "d"])
        self.assertEqual(tests.choose(stages, "c,a", None), ["a", "c"])
        self.assertEqual(tests.choose(stages, None, "c"), ["c", "d"])
        for only, first in [("a,x", None), (None, "x")]:
            with self.assertRaisesRegex(ValueError, "no stage 'x'; there are: a, b, c, d"):
                tests.choose(stages, only, first)


class CountTests(unittest.TestCase):
    def test_counts_unittest(self):
        self.assertEqual(tests.count_unittest("..\nRan 12 tests in 0.1s\n\nOK\n"), Counts(12))
        text = "Ran 12 tests in 0.1s\n\nFAILED (failures=1, errors=2, skipped=3)\n"
        self.assertEqual(tests.count_unittest(text), Counts(6, 3, 3))
        self.assertEqual(tests.count_unittest("Traceback"), Counts(0, 1))

    def test_counts_acceptance_rows(self):
        self.assertEqual(tests.count_acceptance("x\nacceptance: 5 passed, 1 failed, 2 skipped, 3 known\n"), Counts(5, 1, 2))
        self.assertEqual(tests.count_acceptance("Traceback"), Counts(0, 1))

    def test_counts_cases_of_googletest_and_other_programs(self):
        junit = """<testsuite>
          <testcase name="core" status="run"/>
          <testcase name="io" status="fail"/>
          <testcase name="died" status="fail"/>
          <testcase name="command line" status="run"/>
          <testcase name="died late" status="fail"/>
        </testsuite>"""
        core = """<testsuites><testsuite>
          <testcase name="a" result="completed"/><testcase name="b" result="completed"/>
          <testcase name="c" result="skipped"><skipped message=""/></testcase>
        </testsuite></testsuites>"""
        io_cases = """<testsuites><testsuite>
          <testcase name="a" result="completed"/>
          <testcase name="b" result="completed"><failure message=""/></testcase>
        </testsuite></testsuites>"""
        late = '<testsuites><testsuite><testcase name="a" result="completed"/></testsuite></testsuites>'
        with Tree(
            {"ctest.xml": junit, "cases/test_core.xml": core, "cases/test_io.xml": io_cases, "cases/test_died late.xml": late}
        ) as root:
            counts = tests.count_ctest(root / "ctest.xml", root / "cases")
        # core 2 + 1 skipped, io 1 and 1 failed, died 1 failed, command line 1, died late 1 and 1 failed.
        self.assertEqual(counts, Counts(5, 3, 1))


if __name__ == "__main__":
    unittest.main()
