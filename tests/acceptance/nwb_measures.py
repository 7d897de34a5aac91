#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Measures as tables of NWB, judged by pynwb and nwbinspector, beside the CSV of the same run.

Needs Python with pynwb and nwbinspector. Finds the program in KINEMARK_PROGRAM and the recordings in KINEMARK_TEST_DATA; prints
rows "PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import csv
import math
import os
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

import pynwb
from nwbinspector import inspect_nwbfile

from rows import PROGRAM, exit_status, row

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared" / "data"))
RECORDING = DATA / "kineticstoolkit" / "sample_propulsion.c3d"


def same(text, value):
    """A cell of the CSV, nine digits, and a number of the table."""
    return math.isnan(value) if text == "" else math.isclose(float(text), value, rel_tol=1e-8, abs_tol=1e-300)


def main():
    if not RECORDING.exists():
        print(f"SKIP | measures as NWB | {RECORDING.name} | not there", flush=True)
        return 0
    with tempfile.TemporaryDirectory(prefix="kinemark-nwb-") as scratch:
        folder = Path(scratch)
        for name in ("m.csv", "m.nwb"):
            subprocess.run([PROGRAM, "analyze", RECORDING, "--select", "Glove*", "--refits", "39", "--events", "movement", "-o", folder / name],
                           check=True, capture_output=True)
        with (folder / "m.csv").open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        with pynwb.NWBHDF5IO(str(folder / "m.nwb"), "r") as io:
            behavior = io.read().processing["behavior"]
            tidy, wide = behavior["measures_tidy"], behavior["measures"]
            texts = sum(tidy[name][i] == r[name] for i, r in enumerate(rows) for name in ("file", "trial", "subject", "measure", "unit", "interval", "method", "remark"))
            numbers = sum(same(r[name], float(tidy[name][i])) for i, r in enumerate(rows) for name in ("value", "low", "high", "sd", "uncorrected", "share_not_measured"))
            row(len(tidy) == len(rows) and texts == 8 * len(rows), "measures_tidy: texts as in the CSV", f"{8 * len(rows)}", f"{texts}")
            row(numbers == 6 * len(rows), "measures_tidy: numbers as in the CSV, to its nine digits", f"{6 * len(rows)}", f"{numbers}")
            good = 0
            for r in rows:
                cycle = float(r["cycle"]) if r["cycle"] else math.nan
                at = next(i for i in range(len(wide)) if wide["subject"][i] == r["subject"] and wide["context"][i] == r["context"]
                          and (float(wide["cycle"][i]) == cycle or (math.isnan(cycle) and math.isnan(float(wide["cycle"][i])))))
                good += same(r["value"], float(wide[r["measure"]][at]))
            row(good == len(rows), "measures: each value under its measure's name", f"{len(rows)}", f"{good}")
            row("mm/s" in wide["peak_speed"].description, "measures: a column's description names its unit", "mm/s", wide["peak_speed"].description)
        problems = pynwb.validate(path=str(folder / "m.nwb"))
        row(not problems, "pynwb.validate", "0 problems", f"{len(problems)} {problems[:1] if problems else ''}")
        severe = [m for m in inspect_nwbfile(nwbfile_path=str(folder / "m.nwb")) if m.importance.name in ("CRITICAL", "ERROR", "PYNWB_VALIDATION")]
        row(not severe, "nwbinspector: critical findings and errors", "0", f"{len(severe)} {severe[:1] if severe else ''}")
    return exit_status()


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    sys.exit(main())
