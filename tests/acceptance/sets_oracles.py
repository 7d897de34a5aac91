#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Files that name their set, read by OpenSim, ezc3d, pynwb and nwbinspector as if they named none.

A simulated subject, its joint angles and its cleaned markers carry the mark in a header line, a cell, a comment, a
parameter or an attribute. Each program has to find what the file holds and nothing more. Prints rows
"PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import re
import subprocess
import sys
import tempfile
from pathlib import Path

import ezc3d
import h5py
import numpy as np
import opensim
import pynwb
from nwbinspector import inspect_nwbfile

from rows import PROGRAM, exit_status, row

FRAMES = 50


def run(folder, *arguments):
    subprocess.run([PROGRAM, *map(str, arguments), "--quiet"], cwd=folder, check=True, timeout=300)


def set_in_text(path):
    """The set that a text file names: 16 digits."""
    found = re.findall(rb"kinemark_set=([0-9a-f]{16})", path.read_bytes())
    return found[0].decode() if len(found) == 1 else f"{len(found)} marks"


def numbers_below(path, line_with_names):
    """Rows of numbers of a text file below a line that begins with a word."""
    lines = path.read_text().splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith(line_with_names)) + 1
    return np.array([[float(cell) for cell in line.split("\t")] for line in lines[first:] if line.strip()])


def tables(folder):
    for name in ("truth.mot", "q.mot", "q_sd.sto", "q_marker_errors.sto"):
        path = folder / name
        ours = numbers_below(path, "time")
        table = opensim.TimeSeriesTable(str(path))
        theirs = table.getMatrix().to_numpy()
        same = theirs.shape == (FRAMES, ours.shape[1] - 1) and np.array_equal(theirs, ours[:, 1:], equal_nan=True)
        row(same, f"OpenSim TimeSeriesTable: {name}", f"{FRAMES} rows, each cell to the bit", f"{theirs.shape}, same: {same}")
        storage = opensim.Storage(str(path))
        row(storage.getSize() == FRAMES, f"OpenSim Storage: {name}", f"{FRAMES} rows", f"{storage.getSize()}")


def markers(folder):
    path = folder / "markers.trc"
    data = opensim.MarkerData(str(path))
    row(data.getNumFrames() == FRAMES, "OpenSim MarkerData: markers.trc", f"{FRAMES} frames", f"{data.getNumFrames()}")
    table = opensim.TimeSeriesTableVec3(str(path))
    theirs = np.array([[list(map(float, (v[0], v[1], v[2]))) for v in (line[m] for m in range(line.size()))]
                       for line in (table.getRowAtIndex(i) for i in range(table.getNumRows()))])
    ours = numbers_below(path, "\t\tX1")[:, 2:].reshape(FRAMES, -1, 3)
    same = theirs.shape == ours.shape and np.allclose(theirs, ours, rtol=0, atol=1e-9, equal_nan=True)
    row(same, "OpenSim TimeSeriesTableVec3: markers.trc", f"{ours.shape}, positions within 1e-9 mm", f"{theirs.shape}, same: {same}")
    c3d = ezc3d.c3d(str(folder / "markers.c3d"))
    points = c3d["data"]["points"][:3].transpose(2, 1, 0)
    away = np.nanmax(np.abs(points - ours)) if points.shape == ours.shape else np.inf
    row(away < 1e-3, "ezc3d: markers.c3d beside markers.trc", "within 0.001 mm", f"{points.shape}, {away:.2g} mm")
    return c3d["parameters"]["KINEMARK"]["SET"]["value"][0]


def model(folder):
    path = folder / "model.osim"
    read = opensim.Model(str(path))
    bodies = path.read_text().count("<Body ")
    row(read.getBodySet().getSize() == bodies > 1, "OpenSim Model: model.osim", f"{bodies} bodies", f"{read.getBodySet().getSize()}")
    read.initSystem()


def recording(folder):
    path = folder / "clean.nwb"
    with pynwb.NWBHDF5IO(str(path), "r") as io:
        series = [found for found in io.read().objects.values() if isinstance(found, pynwb.behavior.SpatialSeries)]
        frames = {one.data.shape[0] for one in series}
    row(frames == {FRAMES}, "pynwb: clean.nwb", f"{FRAMES} samples in each series", f"{len(series)} series of {frames}")
    problems = pynwb.validate(path=str(path))
    row(not problems, "pynwb.validate: clean.nwb", "0 problems", f"{len(problems)} {problems[:1] if problems else ''}")
    severe = [m.message for m in inspect_nwbfile(nwbfile_path=str(path)) if m.importance.name in ("CRITICAL", "ERROR", "PYNWB_VALIDATION")]
    row(not severe, "nwbinspector: clean.nwb", "0 critical findings and errors", f"{len(severe)} {severe[:1] if severe else ''}")
    with h5py.File(path) as file:
        mark = file.attrs["kinemark_set"]
    return (mark.decode() if isinstance(mark, bytes) else str(mark)).removeprefix("kinemark_set=")


def main():
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        run(folder, "simulate", "subject", "--duration", FRAMES / 100, "-o", folder)
        run(folder, "ik", "-m", "model.osim", "-t", "markers.c3d", "-o", "q.mot")
        run(folder, "clean", "markers.c3d", "clean.nwb")
        tables(folder)
        model(folder)
        simulated = {name: set_in_text(folder / name) for name in ("markers.trc", "truth.mot", "truth.trc", "model.osim")}
        simulated["markers.c3d"] = markers(folder).removeprefix("kinemark_set=")
        row(len(set(simulated.values())) == 1 and all(re.fullmatch("[0-9a-f]{16}", one) for one in simulated.values()),
            "set of simulate, as text and by ezc3d", "one of 16 digits in 5 files", f"{sorted(set(simulated.values()))}")
        cleaned = recording(folder)
        row(cleaned == set_in_text(folder / "clean.nwb") and re.fullmatch("[0-9a-f]{16}", cleaned) is not None,
            "set of clean, by h5py", "16 digits", cleaned)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
