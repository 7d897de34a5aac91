# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import contextlib
import io
import unittest

from support import PROJECT, Tree, load_tool

public_headers = load_tool("check_public_headers")

LIST = "kinemark/data/table.h  # tables\nkinemark/core/version.h  # which\n\nkinemark/core/result.h\n"
RIGHT = {
    "cmake/public_headers.txt": f"# words\n{LIST}",
    "src/kinemark/core/result.h": "#include <vector>\n#include <fmt/format.h>\n",
    "src/kinemark/core/version.h.in": "#define VERSION @VERSION@\n",
    "src/kinemark/data/table.h": '#include "kinemark/core/result.h"\n// see internal::Cells\n/* internal::X */\nint internal_rows;\n',
    "src/kinemark/data/internal/cells.h": "namespace kinemark::data::internal {}\n",
    "src/kinemark/data/other.h": '#include "kinemark/data/internal/cells.h"\n',
}
PUBLIC = ["kinemark/core/result.h", "kinemark/core/version.h", "kinemark/data/table.h"]


@contextlib.contextmanager
def checkout(changes=None):
    with Tree({**RIGHT, **(changes or {})}) as root:
        yield root


class CheckPublicHeaders(unittest.TestCase):
    def problems(self, text):
        result = '#include "kinemark/core/result.h"\n'
        with checkout({"src/kinemark/data/table.h": text + result}) as root:
            return public_headers.check(root)[0]

    def problems_of_list(self, text):
        with checkout({"cmake/public_headers.txt": text}) as root:
            return public_headers.check(root)[0]

    def test_lists_what_is_installed_and_passes_it(self):
        with checkout() as root:
            self.assertEqual(sorted(public_headers.read_list(root)), PUBLIC)
            self.assertEqual(public_headers.check(root), ([], 3))

    def test_catches_an_include_of_what_is_not_installed(self):
        for name in ("internal/cells.h", "other.h", "gone.h"):
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

    def test_catches_a_list_that_is_not_so(self):
        name = "cmake/public_headers.txt"
        for text, problem in (
            (LIST + "kinemark/data/other.h\n", f"{name}: kinemark/data/other.h is no door and included by none"),
            (LIST + "kinemark/data/gone.h  # a door\n", f"{name}: kinemark/data/gone.h does not exist"),
            (LIST.replace("kinemark/core/result.h\n", ""), "src/kinemark/data/table.h:1: includes kinemark/core/result.h, which is not installed"),
        ):
            with self.subTest(problem=problem):
                self.assertIn(problem, self.problems_of_list(text))
        unsorted = LIST + "kinemark/core/check.h\n"
        self.assertIn(f"{name}: what doors include is not sorted", self.problems_of_list(unsorted))

    def test_counts_them(self):
        listed = {f"kinemark/data/n{number:03}.h": "a door" for number in range(public_headers.MOST + 1)}
        self.assertEqual(public_headers.check_list(listed, set()), ["cmake/public_headers.txt: 151 public headers; at most 150"])
        listed.popitem()
        self.assertEqual(public_headers.check_list(listed, set()), [])

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
            self.assertEqual(public_headers.main([str(root)]), 1)

    def test_this_checkout_is_clean(self):
        self.assertEqual(public_headers.check(PROJECT)[0], [])


if __name__ == "__main__":
    unittest.main()
