# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import os
import random
import stat
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

from support import PROJECT

ATTACK = PROJECT / "tests" / "attack"
sys.path.insert(0, str(ATTACK))
import damage  # noqa: E402
import judge  # noqa: E402
from campaign import chosen_kinds, printable  # noqa: E402


def ran(status, err=b"", out=b"", before=None, after=None):
    return judge.Ran(status, out, err, before or {}, after if after is not None else before or {})


class Judge(unittest.TestCase):
    def test_what_is_as_it_should_be(self):
        self.assertEqual(judge.findings(ran(0, b"wrote x.trc\n", after={"x.trc": b"1"})), [])
        self.assertEqual(judge.findings(ran(0, out=b'{"a": 1}'), as_json=True), [])
        self.assertEqual(judge.findings(ran(3, b"note: one\nkinemark: a.trc: line 3: bad\n"), named="a.trc"), [])

    def test_each_fault_is_found(self):
        for words, found in {
            "does not end": judge.findings(ran(None)),
            "ended by signal 11": judge.findings(ran(-11)),
            "exit status 134": judge.findings(ran(134)),
            "does not name a.trc": judge.findings(ran(3, b"kinemark: b.trc: bad\n"), named="a.trc"),
            "0 sentences": judge.findings(ran(3, b"[json.exception.type_error.316]\n")),
            "2 sentences": judge.findings(ran(4, b"kinemark: a\nkinemark: b\n")),
            "no UTF-8": judge.findings(ran(0, b"caf\xe9\n")),
            "U+001B": judge.findings(ran(0, b"\x1b[2J\n")),
            "U+202E": judge.findings(ran(0, out="\u202egpj".encode())),
            "more than 2000": judge.findings(ran(0, b"a" * 2001)),
            "no JSON": judge.findings(ran(0, out=b'{"a": nan'), as_json=True),
            "although it failed": judge.findings(ran(4, b"kinemark: x\n", after={"x": b""})),
            "left over": judge.findings(ran(0, after={".kinemark-1": b""})),
            "on standard output": judge.findings(ran(3, b"kinemark: a: bad\n", out=b"{}")),
            "runtime error": judge.findings(ran(1, b"x.cc:1: runtime error: shift\n")),
        }.items():
            with self.subTest(words):
                self.assertTrue(any(words in problem for problem in found), found)


class Damage(unittest.TestCase):
    def test_every_way_changes_something_and_stands_empty_files(self):
        content = bytes(range(1, 256)) * 20
        for way in damage.WAYS:
            with self.subTest(way.__name__):
                self.assertTrue(any(way(content, random.Random(seed)) != content for seed in range(20)))
                self.assertIsInstance(way(b"", random.Random(1)), bytes)

    def test_a_seed_gives_the_same_damage(self):
        content = b"1.0\t2.0\n" * 50
        self.assertEqual(damage.damaged(content, random.Random(7)), damage.damaged(content, random.Random(7)))

    def test_names_can_be_names_of_files(self):
        self.assertTrue(all(name and b"\0" not in name and b"/" not in name and len(name) < 250 for name in damage.NAMES))


BAD_PROGRAM = """#!/usr/bin/env python3
import pathlib, sys
words = [w for w in sys.argv[1:] if w != "--quiet"]
outs = [words[i + 1] for i, w in enumerate(words) if w == "-o"] or (words[2:3] if words[0] == "convert" else [])
made = {"subject": ("markers.c3d", "markers.trc", "model.osim"), "arm": ("markers.c3d",),
        "rig": ("recording.mcap", "tree_poses.mcap", "grid_A.mcap", "grid_B.mcap", "rig_nominal.toml", "rig_true.toml")}
for out in outs:
    path = pathlib.Path(out)
    if out in made:
        path.mkdir(exist_ok=True)
        for name in made[out]:
            (path / name).write_bytes(b"sound" * 40)
    else:
        path.write_bytes(b"sound" * 40)
if words[0] == "info" and b"sound" * 40 != pathlib.Path(words[1]).read_bytes():
    sys.exit(77)
"""


class Campaign(unittest.TestCase):
    def test_kinds_are_chosen_by_name(self):
        self.assertEqual([kind.__name__ for kind in chosen_kinds(["killed"])], ["killed"])
        with self.assertRaisesRegex(ValueError, "no kind of attack 'fire'.*broken_file"):
            chosen_kinds(["fire"])

    def test_what_is_printed_is_printable(self):
        self.assertTrue(printable(os.fsdecode(b"a\xff\x1b\n")).isprintable())

    def test_a_program_that_ends_with_a_status_of_its_own_is_found_out(self):
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder) / "bad"
            program.write_text(BAD_PROGRAM)
            program.chmod(program.stat().st_mode | stat.S_IXUSR)
            done = subprocess.run(
                [PROJECT / "tools" / "attack", "--program", program, "--trials", "60", "--only", "broken_file", "--keep", Path(folder) / "kept"],
                capture_output=True, text=True, check=False,
            )  # fmt: skip
            self.assertEqual(done.returncode, 1, done.stderr)
            self.assertIn("exit status 77", done.stdout)
            self.assertTrue(any((Path(folder) / "kept").iterdir()))


if __name__ == "__main__":
    unittest.main()
