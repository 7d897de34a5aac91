# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import contextlib
import io
import json
import unittest
from pathlib import Path
from unittest import mock

from support import Tree, load_tool

check_tidy = load_tool("check_tidy")

FILES = {
    ".clang-tidy": "Checks: x\n",
    "src/kinemark/core/a.h": "",
    "src/kinemark/core/b.h": '#include "kinemark/core/a.h"\n',
    "src/kinemark/core/b.cc": '#include "kinemark/core/b.h"\n',
    "src/kinemark/core/c.cc": "",
    "src/kinemark/core/b_test.cc": "",
    "tests/support/scratch.cc": "",
}


class CheckTidy(unittest.TestCase):
    def setUp(self):
        tree = Tree(FILES)
        self.root = tree.__enter__()
        self.addCleanup(tree.__exit__)
        self.build = self.root / "build"
        self.build.mkdir()
        self.compile_with("-O2")

    def compile_with(self, flag):
        database = [
            {"file": str(self.root / name), "command": f"c++ {flag} {name}"} for name in FILES if name.endswith(".cc")
        ]
        (self.build / "compile_commands.json").write_text(json.dumps(database))

    def run_tool(self, bad=()):
        """(exit status, files that clang-tidy saw); files in `bad` fail."""
        looked_at = []

        def tidy(root, build, path):
            looked_at.append(Path(path).name)
            return path not in bad, "what it said"

        version = mock.Mock(stdout="clang-tidy 19\n")
        with (
            mock.patch.object(check_tidy, "ROOT", self.root),
            mock.patch.object(check_tidy, "tidy", tidy),
            mock.patch.object(check_tidy.subprocess, "run", return_value=version),
            contextlib.redirect_stdout(io.StringIO()) as out,
        ):
            status = check_tidy.main(["--build", str(self.build), "--jobs", "1"])
        self.said = out.getvalue()
        return status, sorted(looked_at)

    def test_looks_at_our_sources_but_not_at_tests(self):
        self.assertEqual(self.run_tool(), (0, ["b.cc", "c.cc"]))

    def test_looks_again_only_at_what_changed_or_failed(self):
        self.run_tool()
        self.assertEqual(self.run_tool(), (0, []))
        (self.root / "src/kinemark/core/a.h").write_text("int changed;\n")
        self.assertEqual(self.run_tool(bad=["src/kinemark/core/b.cc"]), (1, ["b.cc"]))
        self.assertIn("src/kinemark/core/b.cc:\nwhat it said\n", self.said)
        self.assertIn("tidy: 2 files, 1 unchanged, 1 failed\n", self.said)
        self.assertEqual(self.run_tool(), (0, ["b.cc"]))

    def test_passes_over_what_is_owed_and_says_how_much(self):
        debt = self.root / "debt.txt"
        debt.write_text("# why\nsrc/kinemark/core/b.cc\nsrc/gone.cc\n")
        with mock.patch.object(check_tidy, "DEBT", debt):
            self.assertEqual(self.run_tool(bad=["src/kinemark/core/b.cc"]), (0, ["c.cc"]))
        self.assertIn("tidy: 1 files, 0 unchanged, 0 failed, 1 passed over (debt.txt)\n", self.said)

    def test_new_rules_and_new_flags_ask_for_another_look(self):
        self.run_tool()
        (self.root / ".clang-tidy").write_text("Checks: y\n")
        self.assertEqual(self.run_tool(), (0, ["b.cc", "c.cc"]))
        self.compile_with("-O3")
        self.assertEqual(self.run_tool(), (0, ["b.cc", "c.cc"]))


if __name__ == "__main__":
    unittest.main()
