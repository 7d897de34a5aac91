# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import contextlib
import io
import subprocess
import unittest

from support import Tree, load_tool

spdx = load_tool("check_spdx")

COPYRIGHT = "SPDX-FileCopyrightText: 2026 The kinemark " + "authors"
LICENCE = "SPDX-License-" + "Identifier: Apache-2.0"
HEADER = f"// {COPYRIGHT}\n// {LICENCE}\n"
REUSE = """version = 1
[[annotations]]
path = ["**/*.md", "*.md", "REUSE.toml", ".gitignore", "data/*.bin"]
SPDX-FileCopyrightText = "2026 The kinemark authors"
SPDX-License-Identifier = "Apache-2.0"
[[annotations]]
path = "dist/**"
SPDX-FileCopyrightText = "others too"
SPDX-License-Identifier = "Apache-2.0 AND MIT"
"""
RIGHT = {
    "a.h": HEADER,
    "run": f"#!/bin/sh\n# {COPYRIGHT}\n# {LICENCE}\n",
    "style.css": f"/* {COPYRIGHT} */\n/* {LICENCE} */\n",
    "README.md": "",
    "docs/README.md": "",
    ".gitignore": "build/\n",
    "build/junk.cc": "",
    "data/x.bin": "",
    "dist/page.js": "",
    "REUSE.toml": REUSE,
    "LICENSES/Apache-2.0.txt": "",
    "LICENSES/MIT.txt": "",
}


class CheckSpdx(unittest.TestCase):
    def problems(self, changes=None, without=()):
        files = {name: text for name, text in {**RIGHT, **(changes or {})}.items() if name not in without}
        with Tree(files) as root:
            subprocess.run(["git", "init", "-q", str(root)], check=True)
            return spdx.check(root)[0]

    def test_passes_a_right_tree_and_leaves_ignored_files_alone(self):
        self.assertEqual(self.problems(), [])

    def test_catches_a_source_without_its_lines(self):
        for text in ["int x;\n", f"// {COPYRIGHT}\n", f"// {LICENCE}\n", "\n" * 5 + HEADER]:
            with self.subTest(text=text):
                found = self.problems({"b.cc": text})
                self.assertEqual(len(found), 1, found)
                self.assertTrue(found[0].startswith("b.cc: the two SPDX lines"), found)

    def test_catches_a_script_known_only_by_its_first_two_bytes(self):
        self.assertEqual(len(self.problems({"tools/go": "#!/bin/sh\n"})), 1)

    def test_catches_another_licence_in_our_own_source(self):
        found = self.problems({"b.cc": HEADER.replace("Apache-2.0", "GPL-3.0-only")})
        self.assertEqual(found, ["b.cc: is under GPL-3.0-only; our own sources are under Apache-2.0"])

    def test_catches_a_file_that_nothing_covers(self):
        self.assertEqual(
            self.problems({"data/deep/x.bin": ""}),
            ["data/deep/x.bin: has no SPDX lines and REUSE.toml does not cover it"],
        )

    def test_catches_a_licence_without_its_text(self):
        self.assertEqual(
            self.problems(without=["LICENSES/MIT.txt"]), ["LICENSES/MIT.txt: is missing, and files are under MIT"]
        )

    def test_program_exits_with_1_on_a_problem(self):
        for changes, status in [({}, 0), ({"b.cc": ""}, 1)]:
            with Tree({**RIGHT, **changes}) as root, contextlib.redirect_stdout(io.StringIO()) as out:
                subprocess.run(["git", "init", "-q", str(root)], check=True)
                self.assertEqual(spdx.main([str(root)]), status)
            self.assertIn(f"{status} problems", out.getvalue())


if __name__ == "__main__":
    unittest.main()
