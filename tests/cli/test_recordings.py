# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings: info, validate and recover on a whole one, one that was never closed, a cut one and a damaged one."""

import json
import tempfile
import unittest
from pathlib import Path

from support import PROJECT, listing, run

RECORDINGS = PROJECT / "tests" / "fuzz" / "corpus" / "recording"


class Recordings(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        for path in RECORDINGS.glob("*.mcap"):
            (self.folder / path.name).write_bytes(path.read_bytes())

    def kinemark(self, *arguments):
        return run(*arguments, cwd=self.folder)

    def test_info_tells_how_each_ends_and_what_is_odd(self):
        for name, end, frames, warnings in (("closed", "closed", 4, 0), ("open", "open", 4, 1), ("cut", "cut", 3, 1)):
            ran = self.kinemark("info", f"{name}.mcap", "--json")
            self.assertEqual(ran.status, 0, ran.err)
            facts = json.loads(ran.out)
            self.assertEqual(facts["kind"], "recording")
            self.assertEqual((facts["end"], facts["frames"], len(facts["warnings"])), (end, frames, warnings), name)
            self.assertEqual(facts["cameras"], ["A", "B"])
        self.assertIn("was not closed", self.kinemark("info", "open.mcap").out)

    def test_validate_is_1_for_a_recording_that_is_odd(self):
        self.assertEqual(self.kinemark("validate", "closed.mcap").status, 0)
        for name in ("open", "cut", "damaged"):
            self.assertEqual(self.kinemark("validate", f"{name}.mcap").status, 1, name)

    def test_recover_keeps_what_is_whole_and_leaves_the_original(self):
        for name, status in (("closed", 0), ("open", 0), ("cut", 1), ("damaged", 1)):
            before = (self.folder / f"{name}.mcap").read_bytes()
            ran = self.kinemark("recover", f"{name}.mcap", f"{name}_whole.mcap", "--json")
            self.assertEqual(ran.status, status, ran.err)
            self.assertEqual((self.folder / f"{name}.mcap").read_bytes(), before)
            done = json.loads(ran.out)
            self.assertEqual(done["bytes_left_out"] > 0, status == 1)
            facts = json.loads(self.kinemark("info", f"{name}_whole.mcap", "--json").out)
            self.assertEqual((facts["end"], facts["messages"]), ("closed", done["messages"]), name)
        self.assertEqual(
            (self.folder / "closed.mcap").read_bytes(), (self.folder / "closed_whole.mcap").read_bytes()
        )

    def test_recover_refuses_in_one_sentence_and_writes_nothing(self):
        (self.folder / "notes.mcap").write_text("these are notes, not a recording\n")
        before = listing(self.folder)
        for arguments, status, sentence in (
            (("closed.mcap", "cut.mcap"), 4, "cut.mcap: exists already; use --force to replace it"),
            (("closed.mcap", "closed.mcap", "--force"), 2, "need another name"),
            (("notes.mcap", "out.mcap"), 3, "does not begin as a recording does"),
            (("absent.mcap", "out.mcap"), 4, "absent.mcap: cannot be opened"),
            (("closed.mcap", "no/folder/out.mcap"), 4, "out.mcap: cannot be written"),
        ):
            ran = self.kinemark("recover", *arguments)
            self.assertEqual(ran.status, status, ran.err)
            self.assertIn(sentence, ran.err)
            self.assertEqual(len(ran.err.strip().splitlines()), 1, ran.err)
        self.assertEqual(listing(self.folder), before)


if __name__ == "__main__":
    unittest.main()
