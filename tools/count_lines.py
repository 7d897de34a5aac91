#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Count lines of source and of test, and how many of test there are for one of source.

    tools/count_lines.py [ROOT]

Counted are files in C++, Python, TypeScript and JavaScript that git keeps or would keep. Test: *_test.cc, *_fuzz.cc,
folders named testing, tests/ and viewer/tests/. Source: everything else of src/, cli/, server/, studies/ and viewer/src/.
Other folders, and data in any form, count for neither. Prints one row for all lines and one for those that are not
blank; exit status 1 when, of these, there are fewer than 0.8 of test for one of source.
"""

import sys
from pathlib import Path, PurePosixPath

from check_spdx import files_of

CODE_ENDINGS = {".h", ".cc", ".py", ".ts", ".js"}
SOURCE_FOLDERS = ("src/", "cli/", "server/", "studies/", "viewer/src/")
TEST_FOLDERS = ("tests/", "viewer/tests/")
TEST_ENDINGS = ("_test.cc", "_fuzz.cc")
LEAST_RATIO = 0.8


def kind_of(name):
    """'test', 'source', or None for a file that does not count."""
    if PurePosixPath(name).suffix not in CODE_ENDINGS:
        return None
    if name.startswith(TEST_FOLDERS):
        return "test"
    if not name.startswith(SOURCE_FOLDERS):
        return None
    in_testing = "testing" in PurePosixPath(name).parts[:-1]
    return "test" if in_testing or name.endswith(TEST_ENDINGS) else "source"


def count(root):
    """{kind: (lines, lines that are not blank)} of the git checkout `root`."""
    totals = {"source": (0, 0), "test": (0, 0)}
    for name in files_of(root):
        kind = kind_of(name)
        if kind is None:
            continue
        lines = (root / name).read_text(encoding="utf-8", errors="replace").splitlines()
        everything, written = totals[kind]
        totals[kind] = (everything + len(lines), written + sum(1 for line in lines if line.strip()))
    return totals


def main(arguments):
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    totals = count(root)
    ratio = 0.0
    for which, label in enumerate(("all lines", "not blank")):
        source, test = totals["source"][which], totals["test"][which]
        ratio = test / source if source else 0.0
        print(f"{label}: {source} of source, {test} of test, {ratio:.3f} of test for one of source")
    if ratio < LEAST_RATIO:
        print(f"fewer than {LEAST_RATIO} lines of test for one of source")
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
