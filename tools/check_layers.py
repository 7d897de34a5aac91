#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Check the layer rule over the #include lines of src/kinemark, the studies and the front ends.

    tools/check_layers.py [ROOT]

A folder may include itself and the folders that ALLOWED lists for it, nothing else. So a stage never includes
another stage, folders of layer 3 do not know each other, and only workflow/, pipeline/ and the studies join stages. A study
includes no other study but `common`, and the library includes none. Besides:

- where a folder is itself in steps (STEPS), each includes only those before it, and only that folder includes them;
- a header in `internal/` is included only from the folder that owns it, or from below it;
- tests of layer 3 may also read their models and recordings through io/, those of workflow/ through pipeline/ too;
- test helpers (tests/support, headers in `testing/`) are included only by tests, benchmarks and fuzzers, and stand
  nowhere else;
- a file of the project is included by its full path ("kinemark/core/result.h", "cli/console.h"), and it exists;
- headers do not include each other in a circle.

Prints one line for every wrong edge; exit status 1 when there is one.
"""

import posixpath
import re
import sys
from pathlib import Path, PurePosixPath

LAYER_3 = ("camera", "model", "io", "stream")

# Folder -> the folders below it that it may include. `stages` stands for each folder in stages/ alone.
ALLOWED = {
    "core": (),
    "math": ("core",),
    "data": ("core", "math"),
    **{folder: ("core", "math", "data") for folder in LAYER_3},
    "stages": ("core", "math", "data", *LAYER_3),
    # From memory to memory: no file is known there.
    "workflow": ("core", "math", "data", "camera", "model", "stream", "stages"),
    "pipeline": ("core", "math", "data", *LAYER_3, "stages", "workflow"),
    "front header": ("core", "math", "data", *LAYER_3, "stages", "workflow", "pipeline"),
    # The founding papers beside ours: they stand beside the library and join stages as they need.
    "studies": ("core", "math", "data", *LAYER_3, "stages", "workflow", "pipeline"),
    # Front ends: no algorithm lives there, so they reach stages through workflow/ and pipeline/ only.
    "front end": ("core", "math", "data", *LAYER_3, "workflow", "pipeline", "studies", "server"),
    "server": ("core", "math", "data", *LAYER_3, "workflow", "pipeline"),
}
# Folders in steps: their subfolders, lowest first. Files beside the subfolders may include all of them.
STEPS = {"src/kinemark/stages/skeleton/articulated": ("chain", "frame", "geometry", "recording")}
FRONT_HEADER = "src/kinemark/kinemark.h"  # for those who use the library; nothing of ours includes it
FRONT_ENDS = ("cli", "python")
SUFFIXES = {".h", ".cc"}

INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*(["<])([^">]+)[">]', re.MULTILINE)
COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)


def folder_of(path):
    """'core', 'io', 'stages/motion', 'front end', ... of a path relative to the root; None: not ours."""
    parts = PurePosixPath(path).parts
    if path == FRONT_HEADER:
        return "front header"
    if parts[0] in FRONT_ENDS:
        return "front end"
    if parts[0] == "server":
        return "server"
    if parts[0] == "studies":
        return f"studies/{parts[1]}" if len(parts) > 2 else None
    if parts[:2] != ("src", "kinemark") or len(parts) < 4:
        return None
    if parts[2] == "stages":
        return f"stages/{parts[3]}" if len(parts) > 4 else None
    return parts[2]


def is_test(path):
    """Tests, benchmarks and fuzzers, and the helpers that only they use."""
    path = PurePosixPath(path)
    return path.stem.endswith(("_test", "_benchmark", "_fuzz")) or "testing" in path.parts


def may_include(source, target, from_test=False):
    """Whether a file of the folder `source` may include one of the folder `target`."""
    if source == target or (from_test and source in LAYER_3 and target == "io"):
        return True
    if from_test and source == "workflow" and target in ("io", "pipeline"):
        return True
    if source.startswith("studies/") and target == "studies/common":
        return True
    return target.split("/")[0] in ALLOWED[source.split("/")[0]]


def owner_of_internal(path):
    """Folder that holds the innermost internal/ of a path, or None."""
    parts = PurePosixPath(path).parts
    if "internal" not in parts[:-1]:
        return None
    last = max(i for i, part in enumerate(parts[:-1]) if part == "internal")
    return PurePosixPath(*parts[:last])


def step_of(path):
    """(folder in steps, step) of a path; the step is one beyond the last for files beside the subfolders."""
    for folder, steps in STEPS.items():
        if path.startswith(f"{folder}/"):
            name = path.removeprefix(f"{folder}/").split("/")[0]
            return folder, steps.index(name) if name in steps else len(steps)
    return None, 0


def breaks_steps(source, target):
    """Whether `source` includes a later step than its own, or a step of a folder that it does not lie in."""
    folder, step = step_of(target)
    if folder is None or step == len(STEPS[folder]):
        return False
    source_folder, source_step = step_of(source)
    return source_folder != folder or source_step < step


def includes_of(text):
    """(line number, quoted?, path) of every #include that is not inside a block comment."""
    blank = COMMENT.sub(lambda comment: "\n" * comment.group().count("\n"), text)
    for match in INCLUDE.finditer(blank):
        line = blank.count("\n", 0, match.start()) + 1
        yield line, match.group(1) == '"', match.group(2)


def sources(root):
    for top in ("src/kinemark", "studies", "server", *FRONT_ENDS):
        for path in sorted((root / top).rglob("*")):
            if path.suffix in SUFFIXES and path.is_file():
                yield path.relative_to(root).as_posix()


def find_target(root, path, included):
    """The project's file that an #include line names, relative to the root; None when it is not ours."""
    if included.startswith("kinemark/"):
        return f"src/{included}"
    if included.split("/")[0] in ("studies", "server", *FRONT_ENDS):
        return included
    beside = posixpath.normpath(PurePosixPath(path).parent / included)
    return beside if (root / beside).is_file() else None


def check_file(root, path):
    """(problems, edges): edges are the project files that `path` includes."""
    problems, edges = [], []
    source = folder_of(path)
    if source is None:
        return [f"{path}: lies in no layer; move it into a folder of src/kinemark"], edges
    if source.split("/")[0] not in ALLOWED:
        return [f"{path}: folder '{source}' has no layer; give it one in tools/check_layers.py"], edges
    if PurePosixPath(path).suffix == ".h" and re.search(r"^test_|_test$", PurePosixPath(path).stem) and "testing" not in path:
        problems.append(f"{path}: a helper of tests belongs into a folder testing/, under a name that says what it is")
    for line, quoted, included in includes_of((root / path).read_text(encoding="utf-8")):
        where = f"{path}:{line}"
        if included.startswith(("support/", "tests/")):
            if not is_test(path):
                problems.append(f"{where}: includes {included}; only tests may include helpers of tests/")
            continue
        target = find_target(root, path, included)
        if target is None:
            if quoted and "/" not in included:
                problems.append(f'{where}: "{included}" is not found; write the full path')
            continue
        if included != target.removeprefix("src/"):
            problems.append(f'{where}: write "{target.removeprefix("src/")}", the full path, not "{included}"')
        if (root / f"{target}.in").is_file():
            target += ".in"  # CMake makes the header from it
        if not (root / target).is_file():
            problems.append(f"{where}: {included} does not exist")
            continue
        edges.append(target)
        target_folder = folder_of(target)
        if target_folder is None or not may_include(source, target_folder, is_test(path)):
            problems.append(f"{where}: {source} may not include {target_folder or target} ({included})")
        if breaks_steps(path, target) and not is_test(path):
            problems.append(f"{where}: {included} belongs to a later step, or to steps of another folder")
        owner = owner_of_internal(target)
        if owner is not None and owner not in PurePosixPath(path).parents:
            problems.append(f"{where}: {included} is internal to {owner}")
        if is_test(target) and not is_test(path):
            problems.append(f"{where}: {included} is for tests only")
    return problems, edges


def find_cycles(edges):
    """One line for each circle of #include lines, found by depth-first search."""
    problems, done = [], set()
    for start in sorted(edges):
        stack, on_path = [(start, iter(edges[start]))], [start]
        if start in done:
            continue
        while stack:
            node, children = stack[-1]
            for child in children:
                if child in on_path:
                    circle = on_path[on_path.index(child):] + [child]
                    problems.append("circle: " + " -> ".join(circle))
                elif child not in done:
                    stack.append((child, iter(edges.get(child, ()))))
                    on_path.append(child)
                    break
            else:
                done.add(node)
                stack.pop()
                on_path.pop()
    return problems


def check(root):
    """All problems of the tree below `root`, and the number of files looked at."""
    problems, edges = [], {}
    for path in sources(root):
        found, edges[path] = check_file(root, path)
        problems += found
    return problems + find_cycles(edges), len(edges)


def main(arguments):
    root = Path(arguments[0]) if arguments else Path(__file__).resolve().parent.parent
    problems, files = check(root)
    for problem in problems:
        print(problem)
    if files == 0:
        print(f"{root}: no source files found")
        return 1
    print(f"layers: {files} files, {len(problems)} wrong edges")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
