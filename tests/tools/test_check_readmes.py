# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import contextlib
import io
import subprocess
import unittest

from support import Tree, load_tool

readmes = load_tool("check_readmes")

GOOD = "# core\nResults and errors.\n"
RIGHT = {
    "README.md": GOOD,
    ".gitignore": "build/\n",
    "src/core/result.h": "",
    "src/core/README.md": GOOD,
    "src/core/internal/decode.cc": "",
    "src/core/internal/README.md": "<!-- licence -->\n# internal\n\nIncluded by core only.\n",
    "build/made/a.cc": "",
    "viewer/dist/page.js": "",
    "corpus/odd.trc": "",
}


class CheckReadmes(unittest.TestCase):
    def problems(self, changes=None, without=()):
        files = {name: text for name, text in {**RIGHT, **(changes or {})}.items() if name not in without}
        with Tree(files) as root:
            subprocess.run(["git", "init", "-q", str(root)], check=True)
            return readmes.check(root)

    def test_passes_a_right_tree_and_counts_folders_of_sources_only(self):
        self.assertEqual(self.problems(), ([], 2))

    def test_catches_a_folder_without_one_and_names_it(self):
        self.assertEqual(
            self.problems(without=["src/core/internal/README.md"])[0], ["src/core/internal/README.md: is missing"]
        )

    def test_a_readme_above_does_not_count(self):
        found, folders = self.problems({"tools/deep/check.py": "", "tools/README.md": GOOD})
        self.assertEqual((found, folders), (["tools/deep/README.md: is missing"], 3))

    def test_catches_one_that_says_nothing(self):
        for text, problem in [
            ("", "has no heading"),
            ("Just words.\n", "has no heading"),
            ("#io / core\nWords.\n", "has no heading"),
            ("# core\n\n", "has no sentence below its heading"),
            ("# core\n## inside\n", "has no sentence below its heading"),
        ]:
            with self.subTest(text=text):
                self.assertEqual(self.problems({"src/core/README.md": text})[0], [f"src/core/README.md: {problem}"])

    def test_program_exits_with_1_on_a_problem_or_on_nothing(self):
        for changes, status in [({}, 0), ({"cli/main.cc": ""}, 1)]:
            with Tree({**RIGHT, **changes}) as root, contextlib.redirect_stdout(io.StringIO()) as out:
                subprocess.run(["git", "init", "-q", str(root)], check=True)
                self.assertEqual(readmes.main([str(root)]), status)
            self.assertIn(f"{status} problems", out.getvalue())
        with Tree({"words.md": ""}) as root, contextlib.redirect_stdout(io.StringIO()):
            subprocess.run(["git", "init", "-q", str(root)], check=True)
            self.assertEqual(readmes.main([str(root)]), 1)


if __name__ == "__main__":
    unittest.main()
