# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""kinemark groups: curves and measures of many trials, from outside."""

import csv
import json
import math
import unittest

from support import CommandTest


def wobble(i):
    """Deterministic, between -0.5 and 0.5."""
    x = math.sin(12.9898 * i) * 43758.5453
    return x - math.floor(x) - 0.5


def curves(first, bump):
    """Eight curves of 51 points, higher by `bump` around the middle."""
    return [[wobble(first + i) * math.cos(0.1 * p) + 0.2 * wobble(1000 * (first + i) + p) + bump * math.exp(-((p - 25) ** 2) / 50)
             for p in range(51)] for i in range(8)]


class Groups(CommandTest):
    def write(self, name, rows):
        path = self.folder / name
        path.write_text("\n".join(",".join(f"{v:.6f}" if isinstance(v, float) else str(v) for v in row) for row in rows) + "\n")
        return path

    def test_two_tables_of_numbers_as_savetxt_writes_them(self):
        old, young = self.write("old.csv", curves(1, 2.0)), self.write("young.csv", curves(20, 0.0))
        result = self.run_in("groups", "spm", old, young)
        self.assertEqual(result.status, 0, result.err)
        self.assertIn("Two samples: old (8 curves), young (8 curves); 51 points", result.out)
        self.assertRegex(result.out, r"point (1\d|2[0-3])[.\d]* to (2[7-9]|3\d)")
        again = self.run_in("groups", "spm", old, young, "--json")
        self.assertEqual(len(json.loads(again.out)["spans"]), 1)
        self.assertEqual(again.out, self.run_in("groups", "spm", old, young, "--json", "--threads", "2").out)

    def test_a_tidy_table_of_pairs_is_written_and_banded(self):
        rows = [("subject", "when", "percent", "value", "unit")]
        for when, bump in (("before", 0.0), ("after", 1.5)):
            for i, curve in enumerate(curves(1 if when == "before" else 40, bump)):
                rows += [(f"S{i}", when, 2 * p, value, "deg") for p, value in enumerate(curve)]
        table, out = self.write("walks.csv", rows), self.folder / "spm.csv"
        result = self.run_in("groups", "spm", table, "--group", "when", "--subject", "subject", "--paired", "-o", out)
        self.assertEqual(result.status, 0, result.err)
        self.assertIn("Paired: before (8 curves), after (8 curves)", result.out)
        with out.open(newline="", encoding="utf-8") as file:
            written = list(csv.DictReader(file))
        self.assertEqual(len(written), 51)
        self.assertEqual({row["beyond"] for row in written}, {"yes", "no"})
        self.assertEqual(self.run_in("groups", "spm", table, "--group", "when", "-o", out).status, 4)
        band = self.folder / "band.csv"
        result = self.run_in("groups", "band", table, "--where", "when=before", "--subject", "subject", "-o", band)
        self.assertEqual(result.status, 0, result.err)
        self.assertIn("a further curve within", result.out)
        result = self.run_in("groups", "norm", band, table, "--subject", "subject", "--group", "when")
        self.assertEqual(result.status, 0, result.err)
        self.assertIn("before S0: within at all of 51 points", result.out)
        self.assertRegex(result.out, r"after S\d: outside at \d+ of 51 points \(.*\), at most [\d.]+ deg above at \d+")

    def test_measures_taken_again(self):
        rows = [("measure", "participant", "session", "value", "unit")]
        for i, line in enumerate([(9, 2, 5, 8), (6, 1, 3, 2), (8, 4, 6, 8), (7, 1, 2, 6), (10, 5, 6, 9), (6, 2, 4, 7)]):
            rows += [("reach", f"S{i}", j, value, "mm") for j, value in enumerate(line)]
        result = self.run_in("groups", "retest", self.write("t.csv", rows))
        self.assertEqual(result.status, 0, result.err)
        self.assertRegex(result.out, r"reach: 6 subjects; intervals of 95 %\n  ICC\(2,1\) 0\.29 \[0\.0\d+ to 0\.7\d+\], ICC\(3,1\) 0\.71")

    def test_what_is_wrong_is_one_sentence(self):
        good = self.write("good.csv", curves(1, 0.0))
        for arguments, status, sentence in (
                (["spm", self.folder / "none.csv"], 4, "none.csv"),
                (["spm", good, "--group", "x"], 2, "no column can be named"),
                (["spm", good, "--alpha", "2"], 2, "alpha"),
                (["spm", self.write("few.csv", [[1.0, 2.0]])], 3, "curve"),
                (["band", self.write("words.csv", [["a", "b"], ["x", "y"]])], 3, "no column 'percent' (--at)"),
                (["norm", good, good], 3, "the first line holds numbers"),
                (["retest", good], 3, "the first line holds numbers"),
                (["spm", good, "-o", self.folder / "o.xlsx"], 2, ".csv or .json"),
                (["smp", good], 2, "spm")):
            result = self.run_in("groups", *arguments)
            self.assertEqual(result.status, status, (arguments, result.err))
            self.assertIn(sentence, result.err)
            self.assertEqual(len(result.err.strip().splitlines()), 1, result.err)
        self.assertFalse((self.folder / "o.xlsx").exists())


if __name__ == "__main__":
    unittest.main()
