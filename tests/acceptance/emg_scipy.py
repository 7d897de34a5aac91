#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""EMG envelopes of `kinemark analyze --write-emg` against SciPy's filters on the channels that ezc3d reads: band-pass,
rectify, low-pass, Butterworth of fourth order, each run both ways with the same continuation of the ends.

Needs Python with scipy and ezc3d. Finds the program in KINEMARK_PROGRAM and the recordings in KINEMARK_TEST_DATA; prints
rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import ezc3d
import numpy
from scipy import signal

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("KINEMARK_PROGRAM", str(ROOT / "build/release/bin/kinemark"))
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared/data"))
VOLTS = {"V": 1.0, "mV": 1e-3}


def both_ways(x, cut_off, rate, kind):
    padding = max(15, math.ceil(rate / cut_off))
    return signal.sosfiltfilt(signal.butter(4, cut_off, kind, fs=rate, output="sos"), x, padtype="odd",
                              padlen=min(padding, len(x) - 1))


def envelope(x, rate):
    x = both_ways(x - x.mean(), 20.0, rate, "highpass")
    if 450.0 < 0.45 * rate:
        x = both_ways(x, 450.0, rate, "lowpass")
    return numpy.maximum(0.0, both_ways(abs(x), 6.0, rate, "lowpass"))


def check(name):
    recording = ezc3d.c3d(str(DATA / name))
    analog = recording["parameters"]["ANALOG"]
    rate, frame_rate = recording["header"]["analogs"]["frame_rate"], recording["header"]["points"]["frame_rate"]
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "emg.csv"
        subprocess.run([PROGRAM, "analyze", str(DATA / name), "--measures", "emg", "--refits", "0", "--write-emg", str(out),
                        "--quiet"], check=True, stdout=subprocess.DEVNULL)
        lines = out.read_text().splitlines()
    names = lines[0].split(",")[1:]
    ours = numpy.array([[float(cell) for cell in line.split(",")[1:]] for line in lines[1:]])
    worst = 0.0
    for column, channel in enumerate(names):
        k = analog["LABELS"]["value"].index(channel)
        x = recording["data"]["analogs"][0, k, :] * VOLTS[analog["UNITS"]["value"][k]]
        theirs = envelope(x, rate)[numpy.round(numpy.arange(len(ours)) * rate / frame_rate).astype(int)]
        worst = max(worst, abs(ours[:, column] - theirs).max() / theirs.max())
    good = worst < 1e-6 and len(names) > 3
    print(f"{'PASS' if good else 'FAIL'} | EMG envelopes beside SciPy: {name} | 1e-6 of the largest | {len(names)} channels, "
          f"{worst:.1e}", flush=True)
    return good


if __name__ == "__main__":
    results = [check(name) for name in ("btk-others/Gait.c3d", "btk-others/PiG_Motion3_FF.c3d", "pycgm-rom/Sample_Static.c3d")]
    sys.exit(0 if all(results) else 1)
