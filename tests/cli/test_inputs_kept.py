# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""No command replaces a file that it reads, whichever of its outputs leads there. tests/acceptance/inputs_kept.py tries all pairs."""

import os
import shutil
import tempfile
import unittest

from pairs_kept import Bench, options_with_files
from support import REAL_DATA, CommandTest, listing

# Options with a file or folder that no command of the bench names, and why.
ELSEWHERE = {
    "--geometry": "meshes, in formats that are not written",
    "--certificate": "not of a live source that is recorded",
    "--key": "as --certificate",
    "--coordinates": "of a setup",
    "--rig": "tried with reconstruct and track",
    "--images": "tried with track",
    "--vsk": "a subject, which cannot be simulated; joints takes one",
    "--edits": "one for all commands that read a recording; tried with convert, joints and edit",
    "--session": "names what it writes by itself; tried in test_acquire",
    "--plan": "a figure, in formats that are not read",
    "--config": "of every command",
    "--save-config": "of every command",
    "--tasks": "with serve not of a live source, which alone writes; tried with ik",
    "--figures": "of a study, which takes minutes; test_a_study below",
    "--data": "as --figures",
}
# The same of one command.
ELSEWHERE_OF = {
    "dynamics": {"--norm", "--report", "--write-cycles", "--write-events"},  # need a recording with feet; made by what makes those of segments
    "simulate": {"--markers"},  # a number, of an arm
}
MUSCLES = REAL_DATA / "btk-others" / "PiG_Motion3_FF.c3d"  # electromyograms cannot be simulated


class EveryPair(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        scratch = tempfile.TemporaryDirectory(prefix="kinemark-cli-")
        cls.addClassCleanup(scratch.cleanup)
        cls.bench = Bench(scratch.name, MUSCLES if MUSCLES.is_file() else None)

    def test_each_output_against_inputs_in_turn(self):
        """Every file that is written meets one input as a link and as a second name; the first output meets all by name."""
        tried = 0
        for name in self.bench.commands:
            with self.subTest(command=name):
                read, written, wrong = self.bench.learn(name)
                self.assertGreater(len(written), 1 if name != "serve" else 0, "the options, and a result")
                for i, path in enumerate(written[:6]):
                    kind = ("symlink", "hard link")[i % 2]
                    wrong += self.bench.try_link(name, path, read[i % len(read)], kind)
                    tried += 1
                for word in self.bench.named_outputs(name)[:1]:
                    wrong += self.bench.try_name(name, word, read[0])
                    tried += 1
                self.assertEqual(wrong, [])
        self.assertGreater(tried, 200)

    def test_every_option_with_a_file_is_among_them(self):
        used = {}
        for words in (self.bench.words(name) for name in self.bench.commands):
            for command in (tuple(words[:1]), tuple(words[:2])):
                used.setdefault(command, set()).update(word for word in words if word.startswith("-"))
        short = {"-o": "--output", "-m": "--model", "-t": "--markers"}
        missing = []
        for command, options in options_with_files().items():
            if command[0] in ("info", "validate", "completion", "run") or (command[0] == "emg" and not MUSCLES.is_file()):
                continue  # they write nothing, or are tried below
            have = {short.get(word, word) for word in used.get(command, set())}
            have |= {"--out"} if command[0] == "simulate" else set()
            missing += [(*command, option) for option in options - have - set(ELSEWHERE) - ELSEWHERE_OF.get(command[0], set())]
        self.assertEqual(sorted(missing), [], "commands of pairs_kept.py are to name them")


class OtherInputs(CommandTest):
    """Files that need more than the bench has."""

    def kept(self, output, read, *command):
        target = self.folder / output
        target.parent.mkdir(exist_ok=True)
        target.symlink_to(self.folder / read)
        self.refused(2, ["is the file that is read as", "name another output"], *command, "--force")
        target.unlink()

    def test_a_study(self):
        shutil.copy(self.trc, self.folder / "walk.trc")
        self.kept("page.html", "walk.trc", "study", "taichi", "--data", "walk.trc", "--figures", "page.html")

    def test_a_run_and_its_records(self):
        for name in ("model.osim", "markers.c3d"):
            shutil.copy(self.recorded / name, self.folder)
        self.write("study.toml", 'steps = ["clean"]\n[[subject]]\nname = "S"\ntrials = ["markers.c3d"]\n')
        self.good("run", "study.toml", "--quiet")
        written = [path for path in (self.folder / "results").rglob("*") if path.is_file()]
        self.assertTrue(any(path.name.endswith(".step.json") for path in written))
        for path in written:
            for read in ("markers.c3d", "study.toml"):
                content = path.read_bytes()
                path.unlink()
                path.symlink_to(self.folder / read)
                before = listing(self.folder)
                ran = self.run_in("run", "study.toml", "--force", "--quiet")
                self.assertNotEqual(ran.status, 0, (path, read))
                self.assertEqual((self.folder / read).read_bytes(), before[read], (path, read))
                path.unlink()
                path.write_bytes(content)

    def test_options_follow_links_to_options_alone(self):
        shutil.copy(self.model, self.folder / "model.osim")
        command = ["convert", self.c3d, "x.trc", "--quiet"]
        self.good(*command, "--save-config", "a.toml")
        self.refused(4, "exists already", *command, "--save-config", "a.toml")
        self.good(*command, "--save-config", "a.toml", "--force")
        (self.folder / "model.toml").symlink_to("model.osim")
        os.link(self.folder / "model.osim", self.folder / "second.toml")
        for name in ("model.toml", "second.toml"):
            self.refused(2, [name, "holds no options of a command"], *command, "--save-config", name, "--force")
        (self.folder / "link.toml").symlink_to("a.toml")
        self.good(*command, "--save-config", "link.toml", "--force")
        self.refused(2, "is the file that is read as", *command, "--config", "a.toml", "--save-config", "a.toml", "--force")
        self.refused(2, "would be written twice", "simulate", "rig", "-o", "a.toml", "--save-config", "a.toml", "--force")


if __name__ == "__main__":
    unittest.main()
