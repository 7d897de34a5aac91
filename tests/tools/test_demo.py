# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import contextlib
import io
import math
import unittest
from unittest import mock

from support import Tree, load_tool

demo = load_tool("demo")

TRUTH = """truth
nRows=3
inDegrees=yes
endheader
time\tknee\troot_tx
0.0\t179\t1.0
0.01\t10\t1.0
0.02\t20\t1.0
"""
SOLVED = TRUTH.replace("179", "-178").replace("\t20\t", "\t23\t").replace("0.01\t10\t1.0", "0.0100000001\t11.5\t1.001")
DEVIATIONS = """sd
endheader
time\tknee\troot_tx
0.0\t2\t0.01
0.01\t1\tnan
0.02\t1\t0
"""


class Demo(unittest.TestCase):
    def compare(self):
        with Tree({"truth.mot": TRUTH, "q.mot": SOLVED, "q_sd.sto": DEVIATIONS}) as root:
            return demo.compare(*(demo.read_table(root / name) for name in ("truth.mot", "q.mot", "q_sd.sto")))

    def test_compares_the_short_way_round_and_leaves_out_what_is_not_determined_or_locked(self):
        compared, undetermined = self.compare()
        self.assertEqual(undetermined, 1)
        self.assertEqual([(name, deviation) for name, _, deviation in compared],
                         [("knee", 2.0), ("root_tx", 0.01), ("knee", 1.0), ("knee", 1.0)])
        for (_, error, _), expected in zip(compared, [3.0, 0.0, 1.5, 3.0]):
            self.assertAlmostEqual(error, expected)

    def test_shares_within_one_and_two_standard_deviations(self):
        compared, _ = self.compare()
        self.assertEqual(demo.share_within(compared, 1), 0.25)
        self.assertEqual(demo.share_within(compared, 2), 0.75)
        self.assertEqual(demo.share_within(compared, 3), 1.0)

    def run_demo(self, truth):
        """Exit status and words of the demo with commands that do nothing."""
        files = {"truth.mot": truth, "angles.mot": SOLVED, "angles_sd.sto": DEVIATIONS}
        with Tree(files) as root, mock.patch.object(demo, "run") as run, mock.patch.object(demo, "study") as study:
            with contextlib.redirect_stdout(io.StringIO()) as out, contextlib.redirect_stderr(out):
                status = demo.main(["--out", str(root)])
            self.assertEqual([call.args[1] for call in run.call_args_list], ["simulate", "ik", "report"])
            self.assertEqual(study.call_count, 1 if "lie within" in out.getvalue() else 0)
        return status, out.getvalue()

    def test_says_how_honest_the_bars_are_and_fails_when_they_are_not(self):
        status, said = self.run_demo(TRUTH)
        self.assertEqual(status, 1)
        self.assertIn("25 % lie within one standard deviation", said)
        self.assertIn("75 % within two", said.replace("\n", " "))
        self.assertIn("not honest", said)
        status, said = self.run_demo(TRUTH.replace("179", "-179"))
        self.assertEqual(status, 1)
        status, said = self.run_demo(TRUTH.replace("179", "-179").replace("0.02\t20", "0.02\t22.1"))
        self.assertEqual(status, 0, said)
        self.assertIn("75 % lie within one", said)
        self.assertIn("report.html in a browser", said)

    def test_times_that_do_not_meet_compare_nothing(self):
        status, said = self.run_demo(TRUTH.replace("\n0.", "\n7."))
        self.assertEqual(status, 1)
        self.assertIn("nothing to compare", said)

    def test_reads_nan(self):
        with Tree({"t.sto": DEVIATIONS}) as root:
            self.assertTrue(math.isnan(demo.read_table(root / "t.sto")[1][1][2]))


if __name__ == "__main__":
    unittest.main()
