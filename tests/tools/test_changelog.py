# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import re
import unittest

from support import PROJECT

LINES = (PROJECT / "CHANGELOG.md").read_text(encoding="utf-8").splitlines()
RELEASES = [match for match in (re.fullmatch(r"## \[(\d+)\.(\d+)\.(\d+)\] - (\d{4}-\d\d-\d\d)", line) for line in LINES) if match]
LONGEST_ENTRY = 180  # characters


class Changelog(unittest.TestCase):
    def test_the_newest_release_is_the_version_of_the_program(self):
        declared = re.search(r"project\(kinemark VERSION (\S+)", (PROJECT / "CMakeLists.txt").read_text(encoding="utf-8"))
        self.assertEqual(".".join(RELEASES[0].groups()[:3]), declared[1])

    def test_releases_go_back_in_time_from_what_is_not_released(self):
        headings = [line for line in LINES if line.startswith("## ")]
        self.assertEqual(headings, ["## [Unreleased]"] + [release[0] for release in RELEASES])
        self.assertGreater(len(RELEASES), 5)
        versions = [tuple(int(part) for part in release.groups()[:3]) for release in RELEASES]
        self.assertEqual(versions, sorted(set(versions), reverse=True))
        dates = [release[4] for release in RELEASES]
        self.assertEqual(dates, sorted(dates, reverse=True))

    def test_an_entry_is_one_line_under_what_kind_of_change_it_is(self):
        kinds = {line for line in LINES if line.startswith("### ")}
        self.assertLessEqual(kinds, {f"### {kind}" for kind in ("Added", "Changed", "Deprecated", "Removed", "Fixed", "Security")})
        entries = [line for line in LINES if line.startswith("- ")]
        self.assertGreater(len(entries), 150)
        self.assertEqual([line for line in entries if len(line) > LONGEST_ENTRY or not line.endswith(".")], [])
        self.assertEqual(len(entries), len(set(entries)))
        self.assertEqual([line for line in LINES if line.startswith(" ")], [])

    def test_pages_that_are_named_are_there(self):
        pages = re.findall(r"docs/[\w/-]+(?:\.md)?", "\n".join(LINES))
        self.assertGreater(len(pages), 40)
        self.assertEqual([page for page in pages if not list(PROJECT.glob(page if page.endswith(".md") else f"{page}-*.md"))], [])


if __name__ == "__main__":
    unittest.main()
