# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Attack every command with damaged files, full disks, kills, second writers and hostile names.

    tools/attack [--trials N | --seconds N] [--seed N] [--only KIND[,KIND...]] [--jobs N] [--program P] [--keep FOLDER]

Every trial is a function of --seed and its number, as far as moments in time allow. A trial that finds something leaves
its folder in --keep (build/attack) and prints what was done and what is wrong; --trial N repeats one. At the end one line
for each kind of attack: trials, findings. Exit status 1 when something was found.
"""

import argparse
import collections
import concurrent.futures
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from commands import make_sound_files
from trials import KINDS, Scene

ROOT = Path(__file__).resolve().parent.parent.parent
MEMORY_BYTES = 2 << 30


def can_trace():
    """Whether strace is there and may watch a child."""
    if shutil.which("strace") is None:
        return False
    return subprocess.run(["strace", "-o", "/dev/null", "true"], capture_output=True, check=False).returncode == 0


def chosen_kinds(names):
    """{kind: share} of the kinds named, all when none is; ValueError for a name that is none."""
    by_name = {kind.__name__: kind for kind in KINDS}
    unknown = [name for name in names if name not in by_name]
    if unknown:
        raise ValueError(f"no kind of attack '{unknown[0]}'; there are: {', '.join(by_name)}")
    return {by_name[name]: KINDS[by_name[name]] for name in names} if names else dict(KINDS)


def attack(number, options, sound, kinds):
    """One trial: (number, name of its kind, what was done, what is wrong, what it came upon)."""
    dice = random.Random(f"{options.seed}/{number}")
    kind = dice.choices(list(kinds), weights=list(kinds.values()))[0]
    with tempfile.TemporaryDirectory(prefix="kinemark-attack-") as scratch:
        folder = Path(scratch) / "trial"
        scene = Scene(options.program, sound, folder, options.wait, None if options.sanitized else MEMORY_BYTES)
        try:
            done, problems = kind(scene, dice)
        except Exception as error:  # noqa: BLE001 -- a fault of the campaign is a finding too, and must not hide
            done, problems = "the trial itself", [f"{type(error).__name__}: {error}"]
        if problems:
            kept = options.keep / f"{kind.__name__}-{options.seed}-{number}"
            shutil.rmtree(kept, ignore_errors=True)
            shutil.copytree(folder, kept, symlinks=True)
    return number, kind.__name__, done, problems, scene.seen


def numbers(options):
    """Numbers of the trials, as long as there is time."""
    if options.trial is not None:
        yield options.trial
        return
    began, number = time.monotonic(), 0
    while number < options.trials if options.seconds is None else time.monotonic() - began < options.seconds:
        yield number
        number += 1


def run_trials(options, sound, kinds):
    """Results of all trials, in the order in which they end; at most two of each worker wait."""
    with concurrent.futures.ProcessPoolExecutor(options.jobs) as pool:
        waiting = set()
        for number in numbers(options):
            waiting.add(pool.submit(attack, number, options, sound, kinds))
            if len(waiting) >= 2 * options.jobs:
                done, waiting = concurrent.futures.wait(waiting, return_when=concurrent.futures.FIRST_COMPLETED)
                yield from (future.result() for future in done)
        yield from (future.result() for future in concurrent.futures.as_completed(waiting))


def printable(text):
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text).encode(errors="backslashreplace").decode()


def main(arguments):
    parser = argparse.ArgumentParser(prog="tools/attack", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--trials", type=int, default=300)
    parser.add_argument("--seconds", type=float)
    parser.add_argument("--trial", type=int, help="only the trial of this number")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", default="")
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 2)
    parser.add_argument("--program", type=Path, default=ROOT / "build" / "release" / "bin" / "kinemark")
    parser.add_argument("--sanitized", action="store_true", help="the program reserves address space: no limit of memory")
    parser.add_argument("--wait", type=float, default=60, help="seconds after which a run counts as one that does not end")
    parser.add_argument("--keep", type=Path, default=ROOT / "build" / "attack")
    options = parser.parse_args(arguments)
    options.program = options.program.resolve()
    try:
        kinds = chosen_kinds([name for name in options.only.split(",") if name])
    except ValueError as error:
        print(f"attack: {error}", file=sys.stderr)
        return 2
    if not can_trace():
        kinds = {kind: share for kind, share in kinds.items() if kind.__name__ != "killed_between_renames"}
        print("attack: strace may not watch programs here: nothing is killed between two renames", file=sys.stderr)
    tried, found, seen = collections.Counter(), collections.Counter(), collections.defaultdict(collections.Counter)
    with tempfile.TemporaryDirectory(prefix="kinemark-attack-") as scratch:
        sound = Path(scratch)
        make_sound_files(options.program, sound)
        for number, kind, done, problems, came_upon in run_trials(options, sound, kinds):
            tried[kind] += 1
            found[kind] += bool(problems)
            seen[kind] += came_upon
            for problem in problems:
                print(f"attack: FOUND {kind}, trial {number}: {printable(done)}: {printable(problem)}", flush=True)
    for kind in kinds:
        more = "".join(f", {count} {what}" for what, count in seen[kind.__name__].items())
        print(f"attack: {kind.__name__}: {tried[kind.__name__]} trials, {found[kind.__name__]} findings{more}")
    print(f"attack: {tried.total()} trials, {found.total()} findings" + (f"; their folders: {options.keep}" if found.total() else ""))
    return 1 if found.total() or not tried.total() else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
