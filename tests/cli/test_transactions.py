# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""All that a command writes appears together: results, figures, page, companions. docs/formats/results.md"""

import tempfile
import unittest

from support import CommandTest
from transactions import Transactions, can_trace, files_below, parts

# With folder, page and companions; tests/acceptance/transactions.py takes all commands.
ON_FULL_DISKS = ("joints", "gait", "segments of walking", "measure", "calibrate", "reconstruct", "manual pages")
KILLED = ("joints", "gait", "ik", "convert to BIDS")


class TestTransactions(CommandTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.place = tempfile.TemporaryDirectory(prefix="kinemark-cli-")
        cls.addClassCleanup(cls.place.cleanup)
        cls.transactions = Transactions(cls.place.name)

    def test_a_full_disk_at_any_file_leaves_what_was_there(self):
        for name in ON_FULL_DISKS:
            with self.subTest(command=name):
                wrong, runs = self.transactions.on_full_disks(name)
                self.assertEqual(wrong, [])
                self.assertGreater(runs, 3)

    def test_a_kill_between_two_names_is_taken_back_by_the_next_run(self):
        if not can_trace():
            raise unittest.SkipTest("strace may not watch programs here")
        for name in KILLED:
            with self.subTest(command=name):
                wrong, kills = self.transactions.killed(name, 4)
                self.assertEqual(wrong, [])
                self.assertGreater(kills, 5)

    def test_the_same_command_again_after_a_kill_needs_no_force(self):
        if not can_trace():
            raise unittest.SkipTest("strace may not watch programs here")
        bench = self.transactions
        made = bench.results("joints")
        last = bench.moments("joints")[-1]
        bench.begin(made, False)
        bench.kill_at(last, bench.words("joints"))
        self.assertEqual(set(made) - {path.name for path in bench.outputs.iterdir()}, {"centres.csv"}, "the first result comes last")
        ran = bench.again(*bench.words("joints"))
        self.assertEqual(ran.status, 0, ran.err)
        self.assertEqual(parts(files_below(bench.outputs), {}, made)[1], set(made))

    def test_a_page_that_is_there_keeps_the_folder_from_it(self):
        bench = self.transactions
        bench.begin({}, False)
        (bench.outputs / "x.html").write_text("mine")
        ran = bench.again(*bench.words("joints"))
        self.assertEqual(ran.status, 4, ran.err)
        self.assertIn("x.html: exists already", ran.err)
        self.assertEqual([path.name for path in bench.outputs.iterdir()], ["x.html"])

    def test_a_figure_that_is_there_keeps_table_and_page_from_it(self):
        bench = self.transactions
        made = bench.results("gait")
        figure = next(name for name in made if name.endswith(".svg"))
        bench.begin({}, False)
        (bench.outputs / "figures").mkdir()
        (bench.outputs / figure).write_text("mine")
        ran = bench.again(*bench.words("gait"))
        self.assertEqual(ran.status, 4, ran.err)
        self.assertEqual([path.name for path in bench.outputs.rglob("*") if path.is_file()], [(bench.outputs / figure).name])


if __name__ == "__main__":
    unittest.main()
