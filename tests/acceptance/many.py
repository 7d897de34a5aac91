#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""A folder of recordings, two at a time, killed in the middle and run again: all done once, none half-written, one table.

    many.py [COUNT]

COUNT (default 200) short recordings of a simulated subject go through clean and ik. A run is killed (SIGKILL) when about half
of the outputs are there; what is there then must be whole, and must not be written again. Needs KINEMARK_PROGRAM. Prints rows
"PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from rows import PROGRAM, exit_status, row, run

COUNT = int(sys.argv[1]) if len(sys.argv) > 1 else 200
FRAMES = 25


def make_recordings(folder):
    """COUNT parts of a simulated recording, and its model."""
    seconds = COUNT * FRAMES / 100
    made = run("simulate", "subject", "-o", folder / "subject", "--duration", seconds, "--dropout-random", "0.02")
    if made.returncode != 0:
        sys.exit(made.stderr)
    (folder / "in").mkdir()
    for n in range(COUNT):
        part = run("convert", folder / "subject/markers.c3d", folder / f"in/trial{n:03}.c3d", "--frames",
                   f"{1 + n * FRAMES}-{(n + 1) * FRAMES}")
        if part.returncode != 0:
            sys.exit(part.stderr)


def kill_half_way(arguments, out, pattern):
    """Files of `pattern` in `out` after a run that was killed when half of them were there."""
    process = subprocess.Popen([PROGRAM, *map(str, arguments)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    while process.poll() is None and len(list(out.glob(pattern))) < COUNT // 2:
        time.sleep(0.001)
    process.kill()
    process.wait()
    return sorted(out.glob(pattern))


def check(name, arguments, out, pattern):
    there = kill_half_way(arguments, out, pattern)
    before = {path: (path.stat().st_mtime_ns, path.stat().st_ino) for path in there}
    wrong = [path.name for path in there if run("validate", path).returncode not in (0, 1)]
    row(0 < len(there) < COUNT and not wrong, f"{name}: killed in the middle", "some outputs, each whole",
        f"{len(there)} of {COUNT}, {len(wrong)} not readable")
    again = run(*arguments, "--json")
    statuses = [trial["status"] for trial in json.loads(again.stdout)["trials"]] if again.stdout else []
    done_before, failures = statuses.count("there already"), statuses.count("failed") + statuses.count("not begun")
    row(again.returncode in (0, 1) and len(statuses) == COUNT and failures == 0 and len(list(out.glob(pattern))) == COUNT,
        f"{name}: run again", f"{COUNT} outputs, none failed", f"{len(list(out.glob(pattern)))} outputs, {failures} failed")
    same = sum((path.stat().st_mtime_ns, path.stat().st_ino) == stamp for path, stamp in before.items())
    # A set of which the kill left a part (its report is missing) is made anew, one a worker at most.
    row(done_before >= len(there) - 2 and same >= len(there) - 2, f"{name}: what was there is not done again",
        f"{len(there)} of {len(there)}, or two fewer", f"{done_before} said, {same} untouched")
    hidden = [path.name for path in out.iterdir() if path.name.startswith(".")]
    row(not hidden, f"{name}: hidden files left", "none", ", ".join(hidden) or "none")
    table = run(*arguments)
    lines = table.stdout.splitlines()
    row(len(lines) == COUNT + 2 and f"{COUNT} recordings: {COUNT} there already" in lines[-1], f"{name}: one table",
        f"{COUNT} lines and the totals", lines[-1] if lines else "no line")


def main():
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        folder = Path(scratch)
        make_recordings(folder)
        check("clean", ["clean", folder / "in", f"{folder}/clean/", "--gaps", "auto", "--jobs", 2], folder / "clean",
              "trial???.c3d")
        check("ik", ["ik", "-m", folder / "subject/model.osim", "-t", folder / "in", "-o", f"{folder}/ik/", "--jobs", 2],
              folder / "ik", "trial???.mot")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
