#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""The same numbers whatever the number of threads (bit for bit) and the build (dev against release, 1e-12)."""

import math
import os
import subprocess
import sys
from pathlib import Path

from rows import PROGRAM, row

ROOT = Path(__file__).resolve().parent.parent.parent
SCRATCH = Path(os.environ.get("KINEMARK_SCRATCH", "/tmp")) / "same-bits"
RESULTS = ("Q.mot", "Q_sd.sto", "Q_marker_errors.sto")


def run(program, folder, *arguments):
    subprocess.run([program, *map(str, arguments)], check=True, cwd=folder)


def solve(program, name, threads):
    """Simulate and solve; the folder of the results."""
    folder = SCRATCH / name
    folder.mkdir(parents=True)
    run(program, folder, "simulate", "subject", "--out", ".", "--seed", 7, "--duration", 5, "--soft-tissue", 0.5,
        "--dropout-random", 0.1, "--dropout-sight", 0.1, "--quiet")
    run(program, folder, "ik", "--model", "model.osim", "--markers", "markers.c3d", "--output", "Q.mot",
        "--threads", threads, "--quiet")
    return folder


def numbers(path):
    text = path.read_text(encoding="utf-8").split("endheader", 1)[1]
    return [float(cell) for line in text.splitlines()[2:] for cell in line.split()]


def largest_difference(one, other):
    worst = 0.0
    for name in RESULTS:
        a, b = numbers(one / name), numbers(other / name)
        if len(a) != len(b):
            return math.inf
        for x, y in zip(a, b):
            if math.isnan(x) != math.isnan(y):
                return math.inf
            if not math.isnan(x):
                worst = max(worst, abs(x - y) / max(1.0, abs(x)))
    return worst


def main():
    subprocess.run(["rm", "-rf", str(SCRATCH)], check=True)
    one, two = solve(PROGRAM, "one", 1), solve(PROGRAM, "two", 2)
    same = [name for name in RESULTS if (one / name).read_bytes() == (two / name).read_bytes()]
    good = row(len(same) == len(RESULTS), "1 and 2 threads", "same bits", f"{len(same)} of {len(RESULTS)} files equal byte for byte")
    subprocess.run(["cmake", "--preset", "dev"], check=True, cwd=ROOT, stdout=subprocess.DEVNULL)
    subprocess.run(["cmake", "--build", "--preset", "dev", "--target", "kinemark", "--parallel", "2"], check=True, cwd=ROOT,
                   stdout=subprocess.DEVNULL)
    worst = largest_difference(one, solve(str(ROOT / "build" / "dev" / "bin" / "kinemark"), "dev", 1))
    good = row(worst <= 1e-12, "dev and release builds", "within 1e-12", f"largest relative difference {worst:.2g}") and good
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
