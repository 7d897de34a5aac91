# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Completion in the shells themselves, and manual pages as groff sets them."""

import re
import subprocess
import unittest
from pathlib import Path

from support import CommandTest, run

COMMANDS = {"simulate", "calibrate", "reconstruct", "clean", "joints", "scale", "ik", "track", "analyze", "report", "serve", "study", "info", "convert"}

# Sets the words as the shell does when a person presses the tabulator after them, and prints what is offered.
BASH = """source "$1"; shift
COMP_WORDS=(kinemark "$@"); COMP_CWORD=$#
_kinemark; printf '%s\\n' "${COMPREPLY[@]}"
"""
ZSH = """compdef() { :; }
_files() { print -- FILES }
_describe() { local name=${@[-1]}; local each; for each in ${(P)name}; do print -- ${each%%:*}; done; }
source "$1"; shift
words=(kinemark "$@"); CURRENT=$#words
_kinemark
"""
FISH = """source $argv[1]
complete -C "$argv[2]" | string replace -r '\\t.*' ''
"""


class Completion(CommandTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.scripts = Path(cls.shared.name)
        for shell in ("bash", "zsh", "fish"):
            ran = run("completion", shell, cwd=cls.scripts)
            assert ran.status == 0 and ran.err == "", ran.err
            (cls.scripts / shell).write_text(ran.out)

    def asked(self, shell, program, *words):
        done = subprocess.run([shell, "-c", program, *(["_"] if shell != "fish" else []), self.scripts / shell, *words],
                              capture_output=True, text=True, timeout=60, check=False)  # fmt: skip
        self.assertEqual((done.returncode, done.stderr), (0, ""), done.stderr)
        return set(done.stdout.split())

    def check(self, complete):
        """`complete` gives what is offered after the words; the last one is what is being typed."""
        self.assertLessEqual(COMMANDS, complete(""))
        self.assertLessEqual({"subject", "arm", "macaque", "rig"}, complete("simulate", ""))
        self.assertLessEqual({"--model", "--markers", "--torques", "--threads"}, complete("ik", "--"))
        self.assertLessEqual({"--leds", "--duration"}, complete("simulate", "rig", "--"))
        self.assertNotIn("--leds", complete("ik", "--"))
        self.assertNotIn("--model", complete("info", "--"))

    def test_bash(self):
        self.check(lambda *words: self.asked("bash", BASH, *words))
        self.assertEqual(self.asked("bash", BASH, "jo"), {"joints"})
        self.assertEqual(self.asked("bash", BASH, "ik", "--torq"), {"--torques"})
        self.assertEqual(self.asked("bash", BASH, "info", "x"), set(), "files are the shell's")

    def test_zsh(self):
        self.check(lambda *words: self.asked("zsh", ZSH, *words))
        self.assertEqual(self.asked("zsh", ZSH, "info", "x"), {"FILES"})

    def test_fish(self):
        self.check(lambda *words: self.asked("fish", FISH, " ".join(["kinemark", *words])))
        self.assertEqual(self.asked("fish", FISH, "kinemark jo"), {"joints"})

    def test_a_shell_that_is_not_known(self):
        self.refused(2, ["tcsh", "bash"], "completion", "tcsh")


class Manual(CommandTest):
    def set_page(self, page):
        """A page as groff sets it on a terminal; it may not complain."""
        done = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-P-c"], input=page.encode(), capture_output=True, timeout=60, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, b""))
        return re.sub(r".\x08", "", done.stdout.decode())

    def test_every_command_has_a_page_that_says_what_the_help_says(self):
        self.good("help", "--man-pages", ".")
        names = {path.stem for path in self.folder.glob("*.1")}
        self.assertLessEqual({f"kinemark-{name}" for name in COMMANDS} | {"kinemark", "kinemark-simulate-rig"}, names)
        for path in sorted(self.folder.glob("*.1")):
            with self.subTest(path.name):
                shown = self.set_page(path.read_text())
                words = path.stem.split("-")[1:]
                options = set(re.findall(r"(?<=[ ,])--[a-z][a-z-]+", self.good(*words, "--help").out))
                listed = set(re.findall(r"--[a-z][a-z-]+", shown.replace("\u2010\n", "").replace("\u2212", "-").replace("‐", "-")))
                self.assertLessEqual({name for name in options if not name.startswith("--no-")}, listed)
                self.assertIn("EXIT STATUS", shown)

    def test_one_page_on_standard_output(self):
        shown = self.set_page(self.good("help", "ik", "--man").out)
        for words in ("KINEMARK-IK(1)", "NAME", "SYNOPSIS", "OPTIONS", "Joint angles from markers"):
            self.assertIn(words, shown.replace("‐", "-").replace("\u2212", "-"))

    def test_pages_do_not_replace_others(self):
        self.write("kinemark.1", "mine")
        self.refused(4, "kinemark.1", "help", "--man-pages", ".")


if __name__ == "__main__":
    unittest.main()
