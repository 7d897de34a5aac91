#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Check that the headers which `cmake --install` hands out stand without those which it does not.

    tools/check_public_headers.py [ROOT] [--list] [--installed FOLDER]

cmake/public_headers.txt lists them: doors, each with a word on what it is for, and what doors include. A public header

- includes of ours only public headers, and of others only OUTSIDE, which kinemarkConfig.cmake finds;
- names no `internal` namespace, neither opens one nor takes something from one;
- is a door or is included by a public header, and there are MOST of them at most.

--list prints the public headers, relative to src/. --installed compares an installed include folder with them. Prints one
line for every problem; exit status 1 when there is one.
"""

import argparse
import re
import sys
from pathlib import Path

# First parts of the includes that consumers get with find_package(kinemark); what has no folder is of the standard.
OUTSIDE = {"Eigen", "fmt", "nlohmann", "toml++"}

LIST = Path("cmake/public_headers.txt")
MOST = 150

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*["<]([^">]+)[">]', re.MULTILINE)
INTERNAL = re.compile(r"\binternal\s*::|\bnamespace\s+[\w:]*\binternal\b")
COMMENT = re.compile(r"/\*.*?\*/|//[^\n]*", re.DOTALL)


def read_list(root):
    """{public header, relative to src/: what it is a door to, or None}, in the order of the list."""
    lines = (root / LIST).read_text(encoding="utf-8").splitlines() if (root / LIST).is_file() else []
    parts = [line.partition("#") for line in lines if line.startswith("kinemark/")]
    return {name.strip(): why.strip() or None for name, _, why in parts}


def source_of(root, name):
    """The file of a header, which may be one that CMake makes from `.h.in`; None where there is none."""
    path = root / "src" / name
    return next((one for one in (path, path.with_name(f"{path.name}.in")) if one.is_file()), None)


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


def check_list(listed, included):
    """Problems of the list itself; `included` are the headers that public ones include."""
    rest = [name for name, why in listed.items() if why is None]
    problems = [f"{LIST}: {name} is no door and included by none" for name in rest if name not in included]
    if rest != sorted(rest):
        problems.append(f"{LIST}: what doors include is not sorted")
    if len(listed) > MOST:
        problems.append(f"{LIST}: {len(listed)} public headers; at most {MOST}")
    return problems


def check(root):
    """All problems of the git checkout `root`, and the number of public headers."""
    listed = read_list(root)
    included, problems = set(), []
    for name in listed:
        source = source_of(root, name)
        if source is None:
            problems.append(f"{LIST}: {name} does not exist")
            continue
        text = source.read_text(encoding="utf-8")
        included |= {other for other in INCLUDE.findall(without_comments(text)) if other != name}
        problems += check_header(name, text, set(listed))
    return problems + check_list(listed, included), len(listed)


def check_installed(root, folder):
    """How an installed include folder differs from the public headers."""
    there = {path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()}
    public = set(read_list(root))
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
        print("\n".join(sorted(read_list(options.root))))
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
