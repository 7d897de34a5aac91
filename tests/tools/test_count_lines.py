# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import contextlib
import io
import subprocess
import unittest

from support import Tree, load_tool

count_lines = load_tool("count_lines")


def lines(written, blank=0):
    return "x\n" * written + " \n" * blank


class CountLines(unittest.TestCase):
    def test_knows_each_kind_of_file(self):
        kinds = {
            "source": [
                "src/kinemark/core/result.h",
                "src/kinemark/io/trc_reader.cc",
                "src/kinemark/io/text_benchmark.cc",
                "src/kinemark/testing.cc",
                "cli/main.cc",
                "studies/common/table.cc",
                "viewer/src/main.ts",
            ],
            "test": [
                "src/kinemark/io/trc_test.cc",
                "src/kinemark/io/trc_fuzz.cc",
                "src/kinemark/io/testing/sample.h",
                "studies/common/table_test.cc",
                "tests/tools/support.py",
                "tests/support/scratch.cc",
                "viewer/tests/unit/band.test.ts",
            ],
            None: [
                "tools/check_layers.py",
                "viewer/one_file.ts",
                "viewer/dist/page.js",
                "examples/ik.cc",
                "tests/fuzz/corpus/trc/odd.trc",
                "src/kinemark/io/README.md",
                "src/kinemark/io/CMakeLists.txt",
                "build/made/a_test.cc",
            ],
        }
        for kind, names in kinds.items():
            for name in names:
                self.assertEqual(count_lines.kind_of(name), kind, name)

    def run_on(self, files):
        with Tree(files) as root:
            subprocess.run(["git", "init", "-q", str(root)], check=True)
            out = io.StringIO()
            with contextlib.redirect_stdout(out):
                status = count_lines.main([str(root)])
            return status, out.getvalue()

    def test_counts_lines_and_those_that_are_not_blank(self):
        files = {"src/a.cc": lines(10, 5), "src/a_test.cc": lines(8, 4), "tools/a.py": lines(99)}
        status, text = self.run_on(files)
        self.assertEqual(status, 0)
        self.assertIn("all lines: 15 of source, 12 of test, 0.800", text)
        self.assertIn("not blank: 10 of source, 8 of test, 0.800", text)

    def test_blank_lines_do_not_make_up_for_missing_ones(self):
        status, text = self.run_on({"src/a.cc": lines(10), "src/a_test.cc": lines(7, 50)})
        self.assertEqual(status, 1)
        self.assertIn("fewer than 0.8", text)

    def test_files_that_git_ignores_do_not_count(self):
        files = {"src/a.cc": lines(10), "src/a_test.cc": lines(9), "src/made_test.cc": lines(99)}
        files[".gitignore"] = "made*\n"
        self.assertIn("10 of source, 9 of test", self.run_on(files)[1])

    def test_a_tree_without_sources_fails(self):
        self.assertEqual(self.run_on({"README.md": "nothing\n"})[0], 1)


if __name__ == "__main__":
    unittest.main()
