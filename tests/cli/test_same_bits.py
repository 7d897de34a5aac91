# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""The same bits for any number of threads."""

import unittest

from support import CommandTest, listing


class SameBits(CommandTest):
    def test_one_and_two_threads(self):
        for threads in (1, 2):
            folder = self.folder / str(threads)
            options = ["--duration", 2, "--soft-tissue", 1, "--dropout-random", 0.1, "--threads", threads]
            self.good("simulate", "subject", "-o", folder, *options)
            self.good(*self.ik(output=folder / "q.mot", threads=threads))
        one, two = (listing(self.folder / name) for name in "12")
        self.assertEqual(one.keys(), two.keys())
        for name in one:
            if not name.endswith("_report.json"):  # tells the time that it took
                self.assertEqual(one[name], two[name], name)


if __name__ == "__main__":
    unittest.main()
