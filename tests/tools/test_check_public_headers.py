# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import contextlib
import io
import subprocess
import unittest

from support import PROJECT, Tree, load_tool

public_headers = load_tool("check_public_headers")

RIGHT = {
    ".gitignore": "include/\n",
    "src/kinemark/core/result.h": "#include <vector>\n#include <fmt/format.h>\n",
    "src/kinemark/core/version.h.in": "#define VERSION @VERSION@\n",
    "src/kinemark/data/table.h": '#include "kinemark/core/result.h"\n// see internal::Cells\n/* internal::X */\nint internal_rows;\n',
    "src/kinemark/data/table.cc": '#include "kinemark/data/internal/cells.h"\n',
    "src/kinemark/data/internal/cells.h": "namespace kinemark::data::internal {}\n",
    "src/kinemark/data/testing/tables.h": "",
    "src/kinemark/data/test_table.h": "",
    "src/kinemark/data/small_table_for_test.h": "",
    "src/kinemark/stages/skeleton/articulated/chain/chain.h": "namespace kinemark::skeleton::internal {}\n",
    "cli/console.h": "",
}
PUBLIC = ["kinemark/core/result.h", "kinemark/core/version.h", "kinemark/data/table.h"]


@contextlib.contextmanager
def checkout(changes=None):
    with Tree({**RIGHT, **(changes or {})}) as root:
        subprocess.run(["git", "init", "-q", str(root)], check=True)
        yield root


class CheckPublicHeaders(unittest.TestCase):
    def problems(self, text):
        with checkout({"src/kinemark/data/table.h": text}) as root:
            return public_headers.check(root)[0]

    def test_lists_what_is_installed_and_passes_it(self):
        with checkout() as root:
            self.assertEqual(public_headers.public_headers(root), PUBLIC)
            self.assertEqual(public_headers.check(root), ([], 3))

    def test_catches_an_include_of_what_is_not_installed(self):
        for name in ("internal/cells.h", "testing/tables.h", "test_table.h", "small_table_for_test.h", "gone.h"):
            with self.subTest(name=name):
                self.assertEqual(
                    self.problems(f'#pragma once\n#include "kinemark/data/{name}"\n'),
                    [f"src/kinemark/data/table.h:2: includes kinemark/data/{name}, which is not installed"],
                )

    def test_catches_a_library_that_consumers_do_not_get(self):
        self.assertEqual(
            self.problems("#include <tbb/parallel_for.h>\n"),
            ["src/kinemark/data/table.h:1: includes tbb/parallel_for.h, which find_package(kinemark) does not bring"],
        )

    def test_catches_internal_names(self):
        for text in (
            "namespace internal {\nstruct Cells;\n}\n",
            "namespace kinemark::data::internal {}\n",
            "void read(const internal::Cells& cells);\n",
            "using kinemark::data::internal::Cells;\n",
        ):
            with self.subTest(text=text):
                problems = self.problems(text)
                self.assertEqual(len(problems), 1)
                self.assertIn("table.h:1: names an internal namespace", problems[0])

    def test_compares_an_installed_folder(self):
        installed = {f"include/{name}": "" for name in (*PUBLIC[:2], "kinemark/data/internal/cells.h")}
        with checkout(installed) as root:
            folder = root / "include"
            self.assertEqual(
                public_headers.check_installed(root, folder),
                [
                    f"{folder}: kinemark/data/table.h is not installed",
                    f"{folder}: kinemark/data/internal/cells.h is installed and not public",
                ],
            )

    def test_program_exits_with_1_on_a_problem_or_on_nothing(self):
        bad = {"src/kinemark/core/result.h": "struct internal::Cells;\n"}
        for changes, options, status in (
            ({}, [], 0),
            (bad, [], 1),
            ({}, ["--list"], 0),
            ({}, ["--installed", "nowhere"], 1),
        ):
            with checkout(changes) as root, contextlib.redirect_stdout(io.StringIO()):
                self.assertEqual(public_headers.main([str(root), *options]), status)
        with Tree({"words.md": ""}) as root, contextlib.redirect_stdout(io.StringIO()):
            subprocess.run(["git", "init", "-q", str(root)], check=True)
            self.assertEqual(public_headers.main([str(root)]), 1)

    def test_this_checkout_is_clean(self):
        self.assertEqual(public_headers.check(PROJECT)[0], [])


if __name__ == "__main__":
    unittest.main()
