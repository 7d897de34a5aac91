#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""An hour of 16 markers smoothed, beside SciPy's filtfilt and numpy's gradient on as much data: time in ratio.

Needs Python with numpy and scipy. The bound is the hour's own (60 s, `accept_trajectory smoothing_speed`); the ratio informs: filtfilt
chooses nothing, takes no gaps and gives no standard deviations.
"""

import os
import re
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
from scipy.signal import butter, filtfilt

BINARIES = Path(os.environ.get("KINEMARK_PROGRAM", "build/release/bin/kinemark")).parent
FRAMES, MARKERS, RATE_HZ = 864000, 16, 240.0


def scipy_seconds():
    """Processor time of filtfilt and two gradients, marker by marker."""
    rng = np.random.default_rng(1)
    t = np.arange(FRAMES) / RATE_HZ
    b, a = butter(2, 12.0 / (RATE_HZ / 2))
    total = 0.0
    for marker in range(MARKERS):
        x = 0.3 * np.sin(2 * np.pi * (0.7 + 0.05 * marker) * t[:, None] + np.arange(3)) + 5e-4 * rng.standard_normal((FRAMES, 3))
        start = time.process_time()
        smooth = filtfilt(b, a, x, axis=0)
        velocity = np.gradient(smooth, 1 / RATE_HZ, axis=0)
        np.gradient(velocity, 1 / RATE_HZ, axis=0)
        total += time.process_time() - start
    return total


def main():
    done = subprocess.run([BINARIES / "accept_trajectory", "smoothing_speed"], capture_output=True, text=True, check=False)
    found = re.search(r"^seconds ([0-9.]+)$", done.stdout, re.MULTILINE)
    if found is None:
        print("FAIL | smoothing beside scipy | a time | accept_trajectory smoothing_speed printed none")
        return 1
    ours, theirs = float(found[1]), scipy_seconds()
    good = ours <= 60.0
    print(f"{'PASS' if good else 'FAIL'} | an hour of 16 markers beside scipy's filtfilt and gradient | <= 60 s | "
          f"{ours:.1f} s and {theirs:.1f} s: {ours / theirs:.1f} times as long, gaps, choice of filter and error bars included")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
