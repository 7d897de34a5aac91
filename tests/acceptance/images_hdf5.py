#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Points in images as HDF5: DeepLabCut's tables, written by pandas, and analysis files of SLEAP, written by h5py in the layout
of its export. The same points give the same motion as from CSV.

Needs Python with pandas and h5py, and with PyTables for the tables of pandas (NOTE without it). Finds the program in
KINEMARK_PROGRAM; prints rows "PASS|FAIL|NOTE | check | asked | measured"; exit status 1 when one fails.
"""

import importlib.util
import sys
import tempfile
from pathlib import Path

import h5py
import numpy
import pandas
from images_json import ARM, DARK, FRAMES, Motions, Subject, compare, row, run


def seen(values):
    """Values without those of frames that show nobody."""
    values = values.copy()
    values[DARK] = numpy.nan
    return values


def frames_of(values):
    return ARM, [None if f in DARK else values[f].copy() for f in range(FRAMES)]


def write_sleap(tracks, file):
    """Tracks x F x M x 3 in the order of axes of SLEAP's export: track, xy, node, frame."""
    with h5py.File(file, "w") as out:
        out.create_dataset("tracks", data=tracks[..., :2].transpose(0, 3, 2, 1), compression="gzip")
        out.create_dataset("point_scores", data=numpy.nan_to_num(tracks[..., 2].transpose(0, 2, 1)), compression="gzip")
        out.create_dataset("node_names", data=numpy.array(ARM, dtype="S"))
        out.create_dataset("track_names", data=numpy.array([f"track_{t}" for t in range(len(tracks))], dtype="S"))


def write_pandas(people, file, how):
    """People x F x M x 3 as DeepLabCut keeps them."""
    individuals = [["animal1", "animal2"][: len(people)]] if len(people) > 1 else []
    names = ["scorer", *(["individuals"] if individuals else []), "bodyparts", "coords"]
    columns = pandas.MultiIndex.from_product([["net"], *individuals, ARM, ["x", "y", "likelihood"]], names=names)
    table = pandas.DataFrame(people.transpose(1, 0, 2, 3).reshape(FRAMES, -1), columns=columns)
    table.to_hdf(file, key="df_with_missing", format=how, mode="w")


def main():
    good = True
    with tempfile.TemporaryDirectory(prefix="kinemark-images-") as scratch:
        folder = Path(scratch)
        subject, motions = Subject(folder), Motions(folder)
        mine, other = seen(subject.values), seen(numpy.array([subject.other(f) for f in range(FRAMES)]))
        write_sleap(mine[None], folder / "one.h5")
        write_sleap(numpy.stack([other, mine]), folder / "two.h5")
        good &= compare("SLEAP, one track", motions, "one.h5", frames_of(subject.values))
        good &= compare("SLEAP, second of two tracks", motions, "two.h5", frames_of(subject.values), "--person", 2)
        refused = motions.refusal("two.h5")
        said = refused.stderr.strip()
        good &= row(refused.returncode == 3 and "1 ('track_0'), 2 ('track_1')" in said and said.count("\n") == 0,
                    "two tracks, none chosen", "exit 3, one sentence with their names", f"exit {refused.returncode}: {said[-60:]}")
        if importlib.util.find_spec("tables") is None:
            print("NOTE | DeepLabCut, tables of pandas | as from CSV | not judged: PyTables is absent (pip install tables)", flush=True)
            tables = []
        else:
            for how in ("table", "fixed"):
                write_pandas(mine[None], folder / f"{how}.h5", how)
                good &= compare(f"DeepLabCut, pandas format '{how}'", motions, f"{how}.h5", frames_of(subject.values))
            write_pandas(numpy.stack([mine, other]), folder / "animals.h5", "table")
            good &= compare("DeepLabCut, first of two individuals", motions, "animals.h5", frames_of(subject.values), "--person", 1)
            tables = ["table.h5"]
        for name in ["one.h5", *tables]:
            refused = run("info", name, folder=folder, good=False)
            good &= row(refused.returncode == 3 and "in pixels" in refused.stderr, f"info {name}", "exit 3: pixels are no markers",
                        f"exit {refused.returncode}")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
