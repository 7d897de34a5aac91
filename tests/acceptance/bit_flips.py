#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Single flipped bits in marker files and tables: none may leave a value that nothing measured can be and be called good.

    bit_flips.py [flips=N]

Every flip is one file, judged by `kinemark validate`. What it calls good is read back by `kinemark convert`: no marker may be
further than 1 km from the origin, no value of the table beyond a million, no rate beyond what cameras run at.
"""

import csv
import json
import math
import os
import random
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("KINEMARK_PROGRAM", str(ROOT / "build" / "release" / "bin" / "kinemark"))
SCRATCH = Path(os.environ.get("KINEMARK_SCRATCH", tempfile.gettempdir()))
FORMATS = ("c3d", "trc", "csv", "mot")
BATCH = 50
FARTHEST_M, LARGEST_VALUE, RATES_HZ = 1000.0, 1e6, (0.001, 1e6)


def run(*arguments):
    return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, timeout=300, check=False)


def originals(folder):
    """A short simulated recording in every format."""
    made = run("simulate", "subject", "-o", folder / "s", "--duration", 0.2, "--seed", 3)
    assert made.returncode == 0, made.stderr
    assert run("convert", folder / "s" / "markers.c3d", folder / "markers.csv").returncode == 0
    return {
        "c3d": (folder / "s" / "markers.c3d").read_bytes(),
        "trc": (folder / "s" / "markers.trc").read_bytes(),
        "csv": (folder / "markers.csv").read_bytes(),
        "mot": (folder / "s" / "truth.mot").read_bytes(),
    }


def absurd_markers(path, folder):
    """What is absurd in a marker file that was called good, or None."""
    facts = json.loads(run("info", "--json", path).stdout)
    if not RATES_HZ[0] <= facts["rate_hz"] <= RATES_HZ[1]:
        return f"{facts['rate_hz']} Hz"
    out = folder / "read.csv"
    done = run("convert", path, out, "--force")
    if done.returncode != 0:
        return f"convert ends with {done.returncode}"
    with out.open(newline="", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            for axis in ("x_m", "y_m", "z_m"):
                if row[axis] and not abs(float(row[axis])) <= FARTHEST_M:
                    return f"{axis} of {row['marker']} is {row[axis]}"
    return None


def absurd_table(path):
    """The same of a table."""
    for line in path.read_text(encoding="utf-8", errors="replace").split("endheader\n")[-1].splitlines()[1:]:
        for cell in line.split():
            if not abs(float(cell)) <= LARGEST_VALUE and not math.isnan(float(cell)):
                return f"a value is {cell}"
    return None


def judged(paths):
    """Exit status of each, or None of what ended the program."""
    done = run("validate", "--json", "--quiet", *paths)
    if done.returncode in (0, 1, 3):
        return [one["exit_status"] for one in json.loads(done.stdout)]
    if len(paths) == 1:
        return [None]
    return [judged([path])[0] for path in paths]


def main(arguments):
    flips = int(dict(argument.split("=") for argument in arguments).get("flips", 5000))
    draw = random.Random(20)
    counts = {0: 0, 1: 0, 3: 0}
    absurd, ended = [], []
    with tempfile.TemporaryDirectory(dir=SCRATCH) as name:
        folder = Path(name)
        whole = originals(folder)
        for begin in range(0, flips, BATCH):
            paths = []
            for k in range(begin, min(begin + BATCH, flips)):
                ending = FORMATS[k % len(FORMATS)]
                data = bytearray(whole[ending])
                bit = draw.randrange(8 * len(data))
                data[bit // 8] ^= 1 << bit % 8
                paths.append(folder / f"{bit}.{ending}")
                paths[-1].write_bytes(data)
            for path, status in zip(paths, judged(paths)):
                if status is None:
                    ended.append(path.name)
                else:
                    counts[status] += 1
                found = None if status != 0 else absurd_table(path) if path.suffix == ".mot" else absurd_markers(path, folder)
                if found:
                    absurd.append(f"{path.name}: {found}")
            for path in paths:
                path.unlink(missing_ok=True)
    for line in absurd[:20]:
        print(line)
    summary = f"{len(absurd)}; {counts[0]} good, {counts[1]} odd, {counts[3]} refused"
    for bad, check, measured in (
        (absurd, f"{flips} single-bit flips in C3D, TRC, CSV, MOT: absurd values called good", summary),
        (ended, f"{flips} single-bit flips: ended otherwise than by 0, 1 or 3", f"{len(ended)} {' '.join(ended[:5])}"),
    ):
        print(f"{'FAIL' if bad else 'PASS'} | {check} | 0 | {measured}", flush=True)
    return 1 if absurd or ended else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
