#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""MAT files by Octave's load, which shares no code with scipy: a simulated trial and its joint angles as kinemark convert writes
them, every number, name and state against the CSV and MOT of the same, as text with 17 digits.

Needs Octave and numpy (tools/setup --oracles; NOTE without Octave). Finds the program in KINEMARK_PROGRAM; prints rows
"PASS|FAIL|NOTE | check | asked | measured"; exit status 1 when one fails.
"""

import csv
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

from rows import row, run

OCTAVE = shutil.which("octave-cli") or shutil.which("octave")
# Prints a name and its numbers, or texts, a line each.
SCRIPT = """
load trial.mat; load table.mat;
printf('labels %s\\n', strjoin(trial.labels, ' '));
printf('status_names %s\\n', strjoin(trial.status_names, ' '));
printf('sizes %d %d %d\\n', size(trial.data));
printf('classes %s %s %s\\n', class(trial.data), class(trial.status), class(trial.labels));
printf('data'); printf(' %.17g', permute(trial.data, [3 2 1])); printf('\\n');
printf('status'); printf(' %d', trial.status'); printf('\\n');
printf('time'); printf(' %.17g', trial.time); printf('\\n');
printf('columns %s\\n', strjoin(table.labels, ' '));
printf('table_time'); printf(' %.17g', table.time); printf('\\n');
printf('table'); printf(' %.17g', table.data'); printf('\\n');
printf('degrees %d\\n', table.in_degrees);
"""


def octave(folder):
    (folder / "read.m").write_text(SCRIPT)
    words = [OCTAVE, "--no-gui", "--norc", "--quiet", "read.m"]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=True, env={**os.environ, "DISPLAY": ""})
    return dict((line.split(" ", 1) + [""])[:2] for line in done.stdout.splitlines())


def same(text, want):
    got = numpy.array(text.split(), dtype=float)
    want = numpy.asarray(want, dtype=float).ravel()
    return got.size, int(numpy.sum((got == want) | (numpy.isnan(got) & numpy.isnan(want)))) if got.size == want.size else -1


def read_mot(path):
    lines = path.read_text().splitlines()
    end = lines.index("endheader")
    return lines[end + 1].split(), numpy.array([line.split() for line in lines[end + 2 :] if line.strip()], dtype=float)


def main():
    if OCTAVE is None:
        print("NOTE | MAT files by Octave's load | every number | not judged: Octave is absent (tools/setup --oracles)", flush=True)
        return 0
    with tempfile.TemporaryDirectory(prefix="kinemark-octave-") as scratch:
        folder = Path(scratch)
        run("simulate", "subject", "-o", "made", "--duration", 2, "--dropout-random", 0.03, folder=folder, good=(0,))
        markers = next((folder / "made").glob("markers.*"))
        run("convert", markers, "trial.csv", folder=folder, good=(0,))
        run("convert", markers, "trial.mat", folder=folder, good=(0,))
        run("convert", "made/truth.mot", "table.mat", folder=folder, good=(0,))
        read = octave(folder)
        with (folder / "trial.csv").open() as file:
            rows = list(csv.DictReader(file))
        names = list(dict.fromkeys(r["marker"] for r in rows))
        states = read["status_names"].split()
        shape = [len(rows) // len(names), len(names), 3]
        good = row(read["labels"].split() == names and read["sizes"].split() == [str(n) for n in shape], "trial: names and sizes",
                   f"{shape}, {len(names)} names", read["sizes"])
        good &= row(read["classes"] == "double uint8 cell", "trial: classes", "double uint8 cell", read["classes"])
        data = [[float(r[axis] or "nan") for axis in ("x_m", "y_m", "z_m")] for r in rows]
        many, equal = same(read["data"], data)
        good &= row(many == equal, "trial: positions", "every number as in the CSV, to the last bit", f"{equal} of {many}")
        missing = int(numpy.isnan(numpy.array(data)).any(axis=1).sum())
        codes = [int(s) for s in read["status"].split()]
        known = sum((states[c] == "missing") == bool(numpy.isnan(data[i]).any()) for i, c in enumerate(codes))
        good &= row(known == len(rows) and missing > 0, "trial: states", f"{missing} missing", f"{known} of {len(rows)} agree")
        labels, table = read_mot(folder / "made/truth.mot")
        good &= row(read["columns"].split() == labels[1:], "table: names", f"{len(labels) - 1}", f"{len(read['columns'].split())}")
        for name, want in (("table_time", table[:, 0]), ("table", table[:, 1:])):
            many, equal = same(read[name], want)
            good &= row(many == equal, f"{name}", "every number as in the MOT, to the last bit", f"{equal} of {many}")
        good &= row(read["degrees"] == "1", "table: in degrees", "1", read["degrees"])
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
