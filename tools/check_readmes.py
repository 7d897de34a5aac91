#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Check that every folder of source files says what it is.

    tools/check_readmes.py [ROOT]

A folder in which git keeps a source file has a README.md with a heading and a sentence: what enters, what leaves, what
it knows nothing of. Folders that a program wrote (BUILT) are left out. Prints one line for every folder that fails;
exit status 1 when there is one.
"""

import sys
from pathlib import Path, PurePosixPath

from check_spdx import files_of

SOURCE_ENDINGS = {".h", ".cc", ".in", ".py", ".ts", ".js", ".cmake"}
BUILT = ("viewer/dist",)


def folders_of(root):
    """Folders of source files that git keeps or would keep, relative to the root; the root itself is '.'."""
    names = [PurePosixPath(name) for name in files_of(root)]
    folders = {name.parent.as_posix() for name in names if name.suffix in SOURCE_ENDINGS}
    return sorted(folder for folder in folders if not folder.startswith(BUILT))


def problem_of(readme):
    """What is wrong with a README.md, or None."""
    if not readme.is_file():
        return "is missing"
    lines = [line.strip() for line in readme.read_text(encoding="utf-8").splitlines()]
    lines = [line for line in lines if line and not line.startswith("<!--")]
    if not any(line.startswith("# ") for line in lines):
        return "has no heading"
    if all(line.startswith("#") for line in lines):
        return "has no sentence below its heading"
    return None


def check(root):
    """All problems of the git checkout `root`, and the number of folders looked at."""
    folders = folders_of(root)
    found = [(folder, problem_of(root / folder / "README.md")) for folder in folders]
    return [f"{folder}/README.md: {problem}" for folder, problem in found if problem], len(folders)


def main(arguments):
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    problems, folders = check(root)
    for problem in problems:
        print(problem)
    print(f"readmes: {folders} folders, {len(problems)} problems")
    return 1 if problems or folders == 0 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
