#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""C3D files against ezc3d, an unrelated reader: values, meaning, speed and memory in one run.

    c3d_ezc3d.py [FOLDER_OF_PROGRAMS]

Needs Python with numpy and ezc3d, and the program c3d_acceptance_tool (beside KINEMARK_PROGRAM when no folder is
given). Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import ezc3d
import numpy as np

from rows import exit_status, row

MISSING, MEASURED = 0, 1  # SampleState; what is above was made


def read_by_ezc3d(path):
    """In a process of its own: seconds, memory and the values, as ezc3d's user sees them."""
    code = """
import ezc3d, json, sys, time

def peak():
    lines = open("/proc/self/status").read().splitlines()
    return 1024 * next(int(line.split()[1]) for line in lines if line.startswith("VmHWM:"))

before = peak()
start = time.perf_counter()
c = ezc3d.c3d(sys.argv[1])
print(json.dumps({"seconds": time.perf_counter() - start, "peak_bytes": peak() - before}))
"""
    return json.loads(subprocess.run([sys.executable, "-c", code, str(path)], capture_output=True, check=True).stdout)


class Tool:
    def __init__(self, folder):
        self.path = Path(folder) / "c3d_acceptance_tool"

    def write(self, path, markers, frames, channels, *more):
        subprocess.run([self.path, "write", path, str(markers), str(frames), str(channels), *more], check=True)

    def read(self, path, repeats=5, threads=1):
        out = subprocess.run([self.path, "read", path, str(repeats), str(threads)], capture_output=True, check=True)
        return json.loads(out.stdout)


def fourth_words(path, markers, frames):
    """Of an Intel float file, converted to integers as c3d.org says."""
    raw = path.read_bytes()
    data_start = 512 * (int.from_bytes(raw[16:18], "little") - 1)
    values = 4 * markers + int.from_bytes(raw[4:6], "little")
    floats = np.frombuffer(raw, "<f4", frames * values, data_start).reshape(frames, values)
    return floats[:, 3 : 4 * markers : 4].astype(int)


def compare_values(tool, folder, name, markers, frames, channels):
    path = folder / f"{name}.c3d"
    tool.write(path, markers, frames, channels)
    x_m = np.fromfile(f"{path}.x").reshape(frames, markers, 3)
    state = np.fromfile(f"{path}.state", np.uint8).reshape(frames, markers)
    residual_m = np.fromfile(f"{path}.residual", np.float32).reshape(frames, markers)
    c = ezc3d.c3d(str(path))
    points = c["data"]["points"]
    parameters = c["parameters"]

    row(points.shape == (4, markers, frames), f"{name}: shape", f"{markers} points x {frames} frames",
        f"{points.shape[1]} x {points.shape[2]}")
    if points.shape != (4, markers, frames):
        return
    x_mm = np.moveaxis(points[:3], 0, 2).swapaxes(0, 1)
    there = state != MISSING
    worst_mm = np.abs(x_mm - 1e3 * x_m)[there].max()
    row(worst_mm <= 2.5e-4, f"{name}: coordinates", "single precision: 0.00025 mm", f"{worst_mm:.2e} mm")
    lost = np.isnan(x_mm).all(axis=2)
    row(bool((lost == ~there).all()), f"{name}: missing samples", f"{(~there).sum()}", f"{lost.sum()}, same places")

    residual = c["data"]["meta_points"]["residuals"][0].T
    row(bool((residual[there & (state != MEASURED)] == 0).all()), f"{name}: residual of what was not measured", "0",
        f"{np.abs(residual[there & (state != MEASURED)]).max():g}")
    row(bool((residual[~there] < 0).all()), f"{name}: residual of what is missing", "< 0", f"{residual[~there].max():g}")
    measured = state == MEASURED
    row(bool((residual[measured] > 0).all()), f"{name}: residual of what was measured", "> 0",
        f"min {residual[measured].min():g}")
    # ezc3d takes the bits of the fourth float for two integers; c3d.org says to convert the number to an integer.
    words = fourth_words(path, markers, frames)
    step_mm = abs(parameters["POINT"]["SCALE"]["value"][0])
    off = np.abs((words[measured] & 0xFF) * step_mm - 1e3 * residual_m[measured]).max()
    row(off <= 0.51 * step_mm, f"{name}: residual by c3d.org's rule", f"half a step of {step_mm:.3f} mm", f"{off:.3f} mm")

    labels = [label for key in ("LABELS", "LABELS2", "LABELS3") for label in parameters["POINT"].get(key, {}).get("value", [])]
    row(labels[:markers] == [f"M{i + 1:03}" for i in range(markers)], f"{name}: labels", f"{markers}, M001 on", f"{len(labels)}")
    if channels:
        analog = np.fromfile(f"{path}.analog").reshape(-1, channels)
        worst = np.abs(c["data"]["analogs"][0].T - analog).max()
        row(worst <= 5e-5, f"{name}: analog values", "0.00005", f"{worst:.1e}")
        times = parameters["EVENT"]["TIMES"]["value"]
        row(np.allclose(60 * times[0] + times[1], [0.05, 65.5], atol=1e-5), f"{name}: events", "0.05 s, 65.5 s",
            f"{60 * times[0] + times[1]}")
    if channels >= 6:
        corners = parameters["FORCE_PLATFORM"]["CORNERS"]["value"]
        row(np.allclose(corners[:, 0, 0], [600, 400, 0]), f"{name}: force plate corner", "600, 400, 0 mm", f"{corners[:, 0, 0]}")


def compare_speed(tool, folder):
    path = folder / "large.c3d"
    markers, frames = 60, 200_000
    tool.write(path, markers, frames, 0)
    ours = tool.read(path, 7, 1)
    two = tool.read(path, 7, 2)
    theirs = read_by_ezc3d(path)
    ours_again = tool.read(path, 7, 1)
    best = min(ours["best_s"], ours_again["best_s"])
    rate = ours["file_bytes"] / best / 1e9
    x_m = np.fromfile(f"{path}.x")
    error_m = abs(ours["sum_m"] - np.nansum(x_m)) / np.count_nonzero(~np.isnan(x_m))
    row(error_m < 1e-9, "large: mean error of what was read", "< 1e-9 m", f"{error_m:.1e} m")
    row(rate >= 1.0, "read from the page cache, one thread", ">= 1 GB/s",
        f"{rate:.2f} GB/s ({ours['file_bytes'] / two['best_s'] / 1e9:.2f} with two threads)")
    ratio = theirs["seconds"] / best
    row(ratio >= 20.0, "speed against ezc3d", ">= 20 x", f"{ratio:.0f} x ({theirs['seconds']:.2f} s, {best:.3f} s)")
    memory = ours["peak_bytes"] / ours["decoded_bytes"]
    row(memory <= 1.5, "memory / decoded arrays", "<= 1.5",
        f"{memory:.2f} (ezc3d {theirs['peak_bytes'] / ours['decoded_bytes']:.2f})")


def main():
    program = os.environ.get("KINEMARK_PROGRAM", "build/release/bin/kinemark")
    tool = Tool(sys.argv[1] if len(sys.argv) > 1 else Path(program).parent)
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        folder = Path(scratch)
        compare_values(tool, folder, "gait", 40, 500, 12)
        compare_values(tool, folder, "wide", 600, 20, 0)
        compare_values(tool, folder, "long", 3, 70_000, 1)
        compare_speed(tool, folder)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
