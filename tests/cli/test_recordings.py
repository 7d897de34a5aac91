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

    def test_info_has_the_same_facts_for_programs_and_for_people(self):
        facts = json.loads(self.kinemark("info", "closed.mcap", "--json").out)
        expected = "file kind end bytes messages channels metadata frames rate_hz first_time_s rig dark_slot saturated occluded lost"
        self.assertEqual(list(facts), [*expected.split(), "cameras", "labels", "warnings", "contradicted"])
        lines = dict(line.split(maxsplit=1) for line in self.kinemark("info", "closed.mcap").out.splitlines() if len(line.split(maxsplit=1)) == 2)
        for key, value in facts.items():
            if key == "warnings" or value in ("", []):
                continue
            written = " ".join(value) if isinstance(value, list) else value if isinstance(value, str) else json.dumps(value)
            self.assertEqual(lines[key], written, key)

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

    def test_wherever_a_recording_is_cut_what_came_before_is_kept(self):
        whole = (self.folder / "closed.mcap").read_bytes()
        facts = json.loads(self.kinemark("info", "closed.mcap", "--json").out)
        messages = []
        for size in range(len(whole) // 20, len(whole), len(whole) // 20):
            (self.folder / "part.mcap").write_bytes(whole[:size])
            ran = self.kinemark("recover", "part.mcap", "kept.mcap", "--json", "--force")
            if ran.status == 3:  # not even the beginning is there
                self.assertEqual(messages, [], size)
                self.assertEqual(len(ran.err.strip().splitlines()), 1, ran.err)
                continue
            self.assertIn(ran.status, (0, 1), ran.err)
            messages.append(json.loads(ran.out)["messages"])
            kept = json.loads(self.kinemark("info", "kept.mcap", "--json").out)
            self.assertEqual((kept["end"], kept["messages"], kept["warnings"]), ("closed", messages[-1], []), size)
            self.assertEqual(self.kinemark("validate", "kept.mcap").status, 0, size)
        self.assertGreater(len(messages), 5)
        self.assertEqual(messages, sorted(messages), "a longer part keeps no less")
        self.assertEqual(messages[-1], facts["messages"], "the end of the file is no message")

    def test_recovered_once_is_recovered_for_good(self):
        for name in ("open", "cut", "damaged"):
            self.kinemark("recover", f"{name}.mcap", "once.mcap", "--force")
            again = self.kinemark("recover", "once.mcap", "twice.mcap", "--json", "--force")
            self.assertEqual(again.status, 0, again.err)
            self.assertEqual(json.loads(again.out)["bytes_left_out"], 0, name)
            self.assertEqual((self.folder / "twice.mcap").read_bytes(), (self.folder / "once.mcap").read_bytes(), name)

    def test_a_flipped_byte_is_reported_or_does_no_harm(self):
        whole = (self.folder / "closed.mcap").read_bytes()
        odd = 0
        for at in range(8, len(whole), max(1, len(whole) // 60)):
            spoilt = bytearray(whole)
            spoilt[at] ^= 0x55
            (self.folder / "spoilt.mcap").write_bytes(spoilt)
            ran = self.kinemark("validate", "spoilt.mcap")
            self.assertIn(ran.status, (0, 1, 3), f"byte {at}: {ran.err}")
            odd += ran.status != 0
            if ran.status == 3:
                self.assertEqual(len(ran.err.strip().splitlines()), 1, ran.err)
        self.assertGreater(odd, 40, "checksums see nearly every byte")

    def test_recover_refuses_in_one_sentence_and_writes_nothing(self):
        (self.folder / "notes.mcap").write_text("these are notes, not a recording\n")
        before = listing(self.folder)
        for arguments, status, sentence in (
            (("closed.mcap", "cut.mcap"), 4, "cut.mcap: exists already; use --force to replace it"),
            (("closed.mcap", "closed.mcap", "--force"), 2, "name another output"),
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
