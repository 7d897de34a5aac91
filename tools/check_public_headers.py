#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Check that the headers which `cmake --install` hands out stand without those which it does not.

    tools/check_public_headers.py [ROOT] [--list] [--installed FOLDER]

Public are the headers of src/kinemark, except those in `internal/` and `testing/`, `test_*.h`, `*_for_test.h` and those of
the folders in INNER (cmake/install.cmake holds the same rule). A public header

- includes of ours only public headers, and of others only OUTSIDE, which kinemarkConfig.cmake finds;
- names no `internal` namespace, neither opens one nor takes something from one.

--list prints the public headers, relative to src/. --installed compares an installed include folder with them. Prints one
line for every problem; exit status 1 when there is one.
"""

import argparse
import re
import sys
from pathlib import Path, PurePosixPath

from check_spdx import files_of

# First parts of the includes that consumers get with find_package(kinemark); what has no folder is of the standard.
OUTSIDE = {"Eigen", "fmt", "nlohmann", "toml++"}

# Folders whose subfolders are parts of one stage.
INNER = ("kinemark/stages/skeleton/articulated",)

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*["<]([^">]+)[">]', re.MULTILINE)
INTERNAL = re.compile(r"\binternal\s*::|\bnamespace\s+[\w:]*\binternal\b")
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)


def is_public(path):
    """Whether a header, named relative to src/, is installed."""
    path = PurePosixPath(path)
    return not (
        {"internal", "testing"} & set(path.parts[:-1])
        or path.name.startswith("test_")
        or path.stem.endswith("_for_test")
        or any(folder.as_posix() in INNER for folder in path.parent.parents)
    )


def public_headers(root):
    """Public headers relative to src/, those that CMake makes from `.h.in` among them."""
    names = [PurePosixPath(name) for name in files_of(root)]
    ours = [name.relative_to("src") for name in names if name.parts[:2] == ("src", "kinemark")]
    headers = [name.as_posix().removesuffix(".in") for name in ours if name.name.endswith((".h", ".h.in"))]
    return sorted(name for name in headers if is_public(name))


def without_comments(text):
    return COMMENT.sub(lambda comment: "\n" * comment.group().count("\n"), text)


def check_header(name, text, public):
    """Problems of one public header."""
    problems = []
    text = without_comments(text)
    for match in INCLUDE.finditer(text):
        included, line = match.group(1), text.count("\n", 0, match.start()) + 1
        top = included.split("/")[0]
        if top == "kinemark":
            if included not in public:
                problems.append(f"src/{name}:{line}: includes {included}, which is not installed")
        elif "/" in included and top not in OUTSIDE:
            problems.append(f"src/{name}:{line}: includes {included}, which find_package(kinemark) does not bring")
    for match in INTERNAL.finditer(text):
        line = text.count("\n", 0, match.start()) + 1
        problems.append(f"src/{name}:{line}: names an internal namespace; move what it needs, or the header, into internal/")
    return problems


def check(root):
    """All problems of the git checkout `root`, and the number of public headers."""
    headers = public_headers(root)
    public, problems = set(headers), []
    for name in headers:
        path = root / "src" / name
        source = path if path.is_file() else path.with_name(f"{path.name}.in")
        problems += check_header(name, source.read_text(encoding="utf-8"), public)
    return problems, len(headers)


def check_installed(root, folder):
    """How an installed include folder differs from the public headers."""
    there = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    public = set(public_headers(root))
    return [f"{folder}: {name} is not installed" for name in sorted(public - there)] + [
        f"{folder}: {name} is installed and not public" for name in sorted(there - public)
    ]


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("root", nargs="?", type=Path, default=Path(__file__).resolve().parent.parent)
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--installed", metavar="FOLDER", type=Path)
    options = parser.parse_args(arguments)
    if options.list:
        print("\n".join(public_headers(options.root)))
        return 0
    problems, headers = check(options.root)
    if options.installed:
        problems += check_installed(options.root, options.installed)
    for problem in problems:
        print(problem)
    print(f"public headers: {headers} headers, {len(problems)} problems")
    return 1 if problems or headers == 0 else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
