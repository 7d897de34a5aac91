#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""How the house is kept: what is public, where recordings are prepared, an example for each verb, no file too long.

    tests/acceptance/house.py
"""

import re
import subprocess
import sys
from pathlib import Path

from rows import row

ROOT = Path(__file__).resolve().parent.parent.parent
MOST_HEADERS = 150
MOST_LINES = 500
MOST_PREPARERS = 3
PREPARING = ("kinemark/workflow/prepare/prepare.h", "kinemark/workflow/prepare/selection.h")  # what edits, selects, cuts and turns
ANY_OF_THEM = tuple(f"kinemark/workflow/prepare/{path.name}" for path in (ROOT / "src/kinemark/workflow/prepare").glob("*.h"))
FRONT = Path("src/kinemark/kinemark.h")  # hands verbs on and prepares nothing
VERBS = {
    "clean": "clean", "joints": "joints", "scale": "scale", "ik": "ik", "track": "track", "measure": "measure", "gait": "gait",
    "segments": "segments", "dynamics": "dynamics", "emg": "emg", "calibrate": "rig", "reconstruct": "rig", "live": "live",
}


def sources():
    """Sources of library and program, without tests, relative to the project."""
    found = [path for folder in ("src", "cli") for end in ("*.h", "*.cc") for path in (ROOT / folder).rglob(end)]
    return [path for path in sorted(found) if not path.stem.endswith("_test") and "testing" not in path.parts]


def public_headers():
    tool = subprocess.run([sys.executable, ROOT / "tools" / "check_public_headers.py", "--list"], capture_output=True, text=True, check=True)
    return tool.stdout.split()


def users(paths, headers):
    """Files outside of workflow/prepare that include one of these headers."""
    include = re.compile(r'^#include "(' + "|".join(map(re.escape, headers)) + ')"', re.MULTILINE)
    inside = ROOT / "src" / "kinemark" / "workflow" / "prepare"
    others = [path for path in paths if inside not in path.parents and path != ROOT / FRONT]
    return [path.relative_to(ROOT).as_posix() for path in others if include.search(path.read_text(encoding="utf-8"))]


def main():
    paths = sources()
    headers = public_headers()
    row(0 < len(headers) <= MOST_HEADERS, "public headers", f"at most {MOST_HEADERS}", len(headers))
    found = users(paths, PREPARING)
    row(0 < len(found) <= MOST_PREPARERS, "headers that edit, select, cut and turn, included from", f"at most {MOST_PREPARERS} files", ", ".join(found))
    print(f"NOTE | any header of workflow/prepare (verticals, screening, axes, forces too), included from | - | {len(users(paths, ANY_OF_THEM))} files")
    lacking = [verb for verb, name in VERBS.items() if not (ROOT / "examples" / f"{name}.cc").is_file()]
    row(not lacking, "examples", "one for each verb", f"{len(VERBS) - len(lacking)} of {len(VERBS)}" + "".join(f"; none of {verb}" for verb in lacking))
    lines = {path: len(path.read_text(encoding="utf-8").splitlines()) for path in paths}
    longest = max(lines, key=lines.get)
    row(lines[longest] <= MOST_LINES, "the longest source file", f"at most {MOST_LINES} lines", f"{longest.relative_to(ROOT).as_posix()}, {lines[longest]}")
    print(f"NOTE | source files | - | {len(paths)}, {sum(lines.values())} lines")


if __name__ == "__main__":
    main()
