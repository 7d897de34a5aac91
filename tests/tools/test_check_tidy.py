# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import contextlib
import io
import json
import subprocess
import unittest
from pathlib import Path
from unittest import mock

from support import Tree, load_tool

check_tidy = load_tool("check_tidy")

FILES = {
    ".clang-tidy": "Checks: x\n",
    ".gitignore": "build/\n",
    "src/kinemark/core/a.h": "",
    "src/kinemark/core/b.h": '#include "kinemark/core/a.h"\n',
    "src/kinemark/core/b.cc": '#include "kinemark/core/b.h"\n',
    "src/kinemark/core/c.cc": "",
    "src/kinemark/core/b_test.cc": '#include "support/scratch.h"\n',
    "tests/support/scratch.h": "",
    "tests/support/scratch.cc": "",
    "build/made.cc": "",
}
ALL = ["b.cc", "b_test.cc", "c.cc", "scratch.cc"]


class CheckTidy(unittest.TestCase):
    def setUp(self):
        tree = Tree(FILES)
        self.root = tree.__enter__()
        self.addCleanup(tree.__exit__)
        self.build = self.root / "build"
        self.compile_with("-O2")

    def compile_with(self, flag):
        database = [
            {"file": str(self.root / name), "command": f"c++ {flag} -o {name}.o -c {name}"}
            for name in FILES
            if name.endswith(".cc")
        ]
        (self.build / "compile_commands.json").write_text(json.dumps(database))

    def git(self, *arguments):
        subprocess.run(
            ["git", "-c", "user.name=x", "-c", "user.email=x@x", *arguments],
            cwd=self.root,
            check=True,
            capture_output=True,
        )

    def commit(self):
        self.git("add", "-A")
        self.git("commit", "-m", "x")

    def run_tool(self, *arguments, bad=()):
        """(exit status, files that clang-tidy saw); files in `bad` fail. `self.together`: how many it saw at once."""
        looked_at, self.together = [], []

        def tidy_together(root, build, paths, command):
            self.together.append(len(paths))
            if set(paths) & set(bad):
                return False
            looked_at.extend(Path(path).name for path in paths)
            return True

        def tidy(root, build, path):
            looked_at.append(Path(path).name)
            return path not in bad, "what it said"

        run = subprocess.run

        def run_or_pretend(command, **options):
            if command[0] == check_tidy.TIDY:
                return mock.Mock(stdout="clang-tidy 19\n")
            return run(command, **options)

        with (
            mock.patch.object(check_tidy, "ROOT", self.root),
            mock.patch.object(check_tidy, "tidy", tidy),
            mock.patch.object(check_tidy, "tidy_together", tidy_together),
            mock.patch.object(check_tidy.subprocess, "run", run_or_pretend),
            contextlib.redirect_stdout(io.StringIO()) as out,
        ):
            status = check_tidy.main(["--build", str(self.build), "--jobs", "1", *arguments])
        self.said = out.getvalue()
        return status, looked_at if "--since" in arguments else sorted(looked_at)

    def test_checks_our_sources_and_tests_but_no_made_ones(self):
        self.assertEqual(self.run_tool("--all"), (0, ALL))

    def test_checks_again_only_what_changed_or_failed(self):
        self.run_tool("--all")
        self.assertEqual(self.run_tool("--all"), (0, []))
        (self.root / "src/kinemark/core/a.h").write_text("int changed;\n")
        self.assertEqual(self.run_tool("--all", bad=["src/kinemark/core/b.cc"]), (1, ["b.cc"]))
        self.assertIn("src/kinemark/core/b.cc:\nwhat it said\n", self.said)
        self.assertIn("tidy: 4 of 4 files, 3 unchanged, 1 failed\n", self.said)
        self.assertEqual(self.run_tool("--all"), (0, ["b.cc"]))
        (self.root / "tests/support/scratch.h").write_text("int changed;\n")
        self.assertEqual(self.run_tool("--all"), (0, ["b_test.cc"]))

    def test_new_rules_and_new_flags_ask_for_another_check(self):
        self.run_tool("--all")
        (self.root / ".clang-tidy").write_text("Checks: y\n")
        self.assertEqual(self.run_tool("--all"), (0, ALL))
        self.compile_with("-O3")
        self.assertEqual(self.run_tool("--all"), (0, ALL))

    def test_checks_what_differs_from_a_commit_the_newest_first(self):
        self.git("init")
        self.commit()
        self.assertEqual(self.run_tool("--since", "HEAD"), (0, []))
        (self.root / "src/kinemark/core/c.cc").write_text("int committed;\n")
        self.commit()
        (self.root / "tests/support/scratch.cc").write_text("int not_committed;\n")
        self.assertEqual(self.run_tool("--since", "HEAD~1"), (0, ["scratch.cc", "c.cc"]))
        self.assertIn("tidy: 2 of 4 files", self.said)

    def test_what_changed_is_looked_at_together_and_one_by_one_where_that_fails(self):
        self.git("init")
        self.commit()
        for name in ("b.cc", "c.cc", "b_test.cc"):
            (self.root / "src/kinemark/core" / name).write_text("int changed;\n")
        status, seen = self.run_tool("--since", "HEAD", bad=["src/kinemark/core/c.cc"])
        self.assertEqual((status, sorted(seen), self.together), (1, ["b.cc", "b_test.cc", "c.cc"], [3]))
        self.assertIn("src/kinemark/core/c.cc:\nwhat it said\n", self.said)
        self.assertEqual(self.run_tool("--since", "HEAD"), (0, ["c.cc"]))
        self.assertEqual(self.run_tool("--since", "HEAD"), (0, []))
        # What passed among others is looked at by itself once all are.
        self.assertEqual(self.run_tool("--all"), (0, ALL))
        self.assertEqual(self.together, [])

    def test_flags_are_what_two_files_have_in_common(self):
        command = "/usr/bin/clang++-19 -DA -I/x -isystem /y -O1 -o made/a.cc.o -c /z/a.cc"
        self.assertEqual(check_tidy.flags_of(command), ["-DA", "-I/x", "-isystem", "/y", "-O1"])
        commands = {f"{i}.cc": f"c++ -O{i % 2} -o {i}.o -c {i}.cc" for i in range(30)}
        self.assertEqual([len(batch) for batch in check_tidy.batches(commands)], [12, 3, 12, 3])

    def test_a_header_is_seen_through_the_source_beside_it_or_through_one_that_includes_it(self):
        self.git("init")
        self.commit()
        (self.root / "src/kinemark/core/a.h").write_text("int changed;\n")
        self.assertEqual(self.run_tool("--since", "HEAD"), (0, ["b.cc"]))
        (self.root / "tests/support/scratch.h").write_text("int changed;\n")
        self.assertEqual(self.run_tool("--since", "HEAD"), (0, ["scratch.cc"]))

    def test_checks_everything_where_git_does_not_know_the_commit(self):
        self.git("init")
        self.commit()
        self.assertEqual(sorted(self.run_tool("--since", "HEAD~20")[1]), ALL)
        self.assertIn("git knows no HEAD~20; all files are looked at\n", self.said)

    def test_begins_nothing_when_its_time_is_over_and_says_so(self):
        self.assertEqual(self.run_tool("--all", "--seconds", "-1"), (0, []))
        self.assertIn("tidy: 4 of 4 files, 0 unchanged, 0 failed, 4 not begun after -1 s\n", self.said)
        self.assertEqual(self.run_tool("--all"), (0, ALL))


if __name__ == "__main__":
    unittest.main()
