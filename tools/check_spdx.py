#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Check that every file of the project says whose it is and under which licence.

    tools/check_spdx.py [ROOT]

Source files (by ending or by name) carry two SPDX lines among their first five. All other files are covered by
REUSE.toml, and each licence named anywhere has its text in LICENSES/. Files that git ignores are not looked at.
Prints one line per file that fails; exit status 1 when there is one.
"""

import re
import subprocess
import sys
import tomllib
from pathlib import Path, PurePosixPath

SOURCE_ENDINGS = {".h", ".m", ".c", ".cc", ".in", ".py", ".ts", ".js", ".css", ".sh", ".cmake", ".map", ".dox"}
SOURCE_NAMES = {"CMakeLists.txt", "Makefile", ".clang-tidy"}
COPYRIGHT = "SPDX-FileCopyrightText: 2026 The kinemark authors"
LICENCE = re.compile(r"SPDX-License-Identifier: (\S.*?)(?: \*/| -->)?$")
OWN_LICENCE = "Apache-2.0"
HEADER_LINES = 5


def files_of(root):
    """Files that git keeps or would keep, relative to the root; those deleted but not yet committed left out."""
    listed = subprocess.run(
        ["git", "-C", str(root), "ls-files", "-z", "--cached", "--others", "--exclude-standard"],
        check=True,
        capture_output=True,
        text=True,
    ).stdout
    return sorted(name for name in set(listed.split("\0")) if name and (root / name).is_file())


def glob_to_regex(pattern):
    """REUSE's globs: `*` stays within a folder, `**` does not."""
    parts = re.split(r"(\*\*|\*)", pattern)
    return re.compile("".join({"**": ".*", "*": "[^/]*"}.get(part, re.escape(part)) for part in parts))


def read_annotations(root):
    """[(regular expressions, licence expression)] of REUSE.toml; the last that matches a file counts."""
    path = root / "REUSE.toml"
    if not path.is_file():
        return []
    annotations = []
    for entry in tomllib.loads(path.read_text(encoding="utf-8")).get("annotations", []):
        patterns = entry["path"] if isinstance(entry["path"], list) else [entry["path"]]
        annotations.append(([glob_to_regex(pattern) for pattern in patterns], entry["SPDX-License-Identifier"]))
    return annotations


def needs_header(root, name):
    path = PurePosixPath(name)
    if path.suffix in SOURCE_ENDINGS or path.name in SOURCE_NAMES:
        return True
    with (root / name).open("rb") as file:
        return file.read(2) == b"#!"


def header_licence(root, name):
    """(licence or None, whether the copyright line is there) of a file's first lines."""
    with (root / name).open(encoding="utf-8", errors="replace") as file:
        lines = [line.rstrip() for _, line in zip(range(HEADER_LINES), file)]
    licences = [match.group(1) for line in lines if (match := LICENCE.search(line))]
    return (licences[0] if licences else None), any(COPYRIGHT in line for line in lines)


def check(root):
    """All problems of the git checkout `root`, and the number of files looked at."""
    problems, licences = [], {OWN_LICENCE}
    annotations = read_annotations(root)
    names = files_of(root)
    for name in names:
        if name.startswith("LICENSES/"):
            continue
        covered = [licence for patterns, licence in annotations if any(p.fullmatch(name) for p in patterns)]
        if needs_header(root, name) and not covered:
            licence, has_copyright = header_licence(root, name)
            if licence is None or not has_copyright:
                problems.append(f"{name}: the two SPDX lines are not among its first {HEADER_LINES} lines")
            elif licence != OWN_LICENCE:
                problems.append(f"{name}: is under {licence}; our own sources are under {OWN_LICENCE}")
        elif covered:
            licences.update(re.split(r" (?:AND|OR) ", covered[-1]))
        else:
            problems.append(f"{name}: has no SPDX lines and REUSE.toml does not cover it")
    problems += [
        f"LICENSES/{licence}.txt: is missing, and files are under {licence}"
        for licence in sorted(licences)
        if not (root / "LICENSES" / f"{licence}.txt").is_file()
    ]
    return problems, len(names)


def main(arguments):
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    problems, files = check(root)
    for problem in problems:
        print(problem)
    print(f"spdx: {files} files, {len(problems)} problems")
    return 1 if problems or files == 0 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
