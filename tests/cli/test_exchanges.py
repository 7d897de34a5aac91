# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Markers that carry each other's labels: said by validate, exchanged back by clean, ik and edit, or kept when asked."""

import json
import math
import unittest

from support import CommandTest, table


class ExchangesTest(CommandTest):
    """Two markers of the simulated recording are exchanged in every third frame."""

    def setUp(self):
        super().setUp()
        lines = self.trc.read_text().splitlines()
        names = [name for name in lines[3].split("\t")[2:] if name.strip()]
        first = next(i for i, line in enumerate(lines) if line.split("\t")[0].strip() == "1")
        rows = [line.split("\t") for line in lines[first:] if line.strip()]

        def sample(row, marker):
            cells = row[2 + 3 * marker : 5 + 3 * marker]
            return [float(cell) for cell in cells] if len(cells) == 3 and all(cell.strip() for cell in cells) else None

        def distance(one, other):
            a, b = sample(rows[0], one), sample(rows[0], other)
            return math.dist(a, b) if a and b else 0.0

        one = next(m for m in range(len(names)) if sample(rows[0], m))
        other = next(m for m in range(one + 1, len(names)) if distance(one, m) > 200.0)
        self.frames = []
        for frame, row in enumerate(rows):
            if frame % 3 != 1 or not sample(row, one) or not sample(row, other):
                continue
            a, b = slice(2 + 3 * one, 5 + 3 * one), slice(2 + 3 * other, 5 + 3 * other)
            row[a], row[b] = row[b], row[a]
            self.frames.append(frame)
        lines[first : first + len(rows)] = ["\t".join(row) for row in rows]
        self.names = names[one], names[other]
        self.write("walk.trc", "\n".join(lines) + "\n")
        self.write("whole.trc", self.trc.read_text())

    def assert_said(self, text):
        said = [line for line in text.splitlines() if all(f"'{name}'" in line for name in self.names)]
        self.assertEqual(len(said), 1, text)
        self.assertRegex(said[0], rf"are exchanged in {len(self.frames)} frames: (?:nearly )?every third frame")

    def test_validate_names_both_and_the_pattern_and_nothing_of_a_clean_recording(self):
        self.assert_said(self.good("validate", "walk.trc", status=1).err)
        self.assertNotIn("are exchanged in", self.good("validate", "whole.trc").err)

    def test_ik_of_the_exchanged_recording_is_that_of_the_clean_one(self):
        ran = self.good(*self.ik(markers="walk.trc", output="walk.mot"))
        self.assert_said(ran.err)
        self.assertIn("exchanged back", ran.err)
        clean = self.good(*self.ik(markers="whole.trc", output="whole.mot"))
        self.assertNotIn("are exchanged in", clean.err)
        self.assertEqual(table(self.folder / "walk.mot"), table(self.folder / "whole.mot"))
        reports = [json.loads((self.folder / name).read_text()) for name in ("walk_report.json", "whole_report.json")]
        self.assertEqual([len(report["exchanged"]) for report in reports], [1, 0])
        self.assertEqual(reports[0]["exchanged"][0]["count"], len(self.frames))
        self.assertEqual(reports[0]["rejected_samples"], reports[1]["rejected_samples"], "no right sample is left out")
        kept = self.good(*self.ik(markers="walk.trc", output="kept.mot", doubtful="keep"), status=1)
        self.assertNotIn("exchanged back", kept.err)

    def test_an_edit_of_listed_frames_keeps_it_and_can_be_refused(self):
        ran = self.good("edit", "walk.trc", "--exchanges", "--author", "me")
        self.assertIn("1 edit in force", ran.err)
        self.assertIn(f"swap of '{self.names[0]}' and '{self.names[1]}'", ran.err)
        again = self.good("edit", "walk.trc", "--exchanges")
        self.assertIn("no two markers surely carry each other's label: nothing was appended", again.err)
        with_edits = self.good(*self.ik(markers="walk.trc", output="edited.mot", edits="walk_edits.jsonl"))
        self.assertNotIn("are exchanged in", with_edits.err, "done already")
        self.good("edit", "walk.trc", "--undo", 1)
        self.assert_said(self.good(*self.ik(markers="walk.trc", output="undone.mot", edits="walk_edits.jsonl")).err)
        nothing = self.good("edit", "whole.trc", "--exchanges")
        self.assertIn("nothing was appended", nothing.err)
        self.assertFalse((self.folder / "whole_edits.jsonl").exists())

    def test_clean_exchanges_back_unless_asked_to_keep(self):
        self.assert_said(self.good("clean", "walk.trc", "cleaned.csv").err)
        self.good("clean", "walk.trc", "kept.csv", "--keep-exchanges")
        self.assertIn("exchanged with", (self.folder / "cleaned.csv").read_text())
        self.assertNotIn("exchanged with", (self.folder / "kept.csv").read_text())


if __name__ == "__main__":
    unittest.main()
