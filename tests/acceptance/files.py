#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Every C3D, TRC and model of the real recordings, read by the program, against the facts of their README.

The README of the recordings was parsed by an independent reader; its tables are taken as they stand. A file that it
calls unreadable must give one sentence and exit status 3.
"""

import csv as csv_files
import json
import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("KINEMARK_PROGRAM", str(ROOT / "build" / "release" / "bin" / "kinemark"))
DATA = Path(os.environ.get("KINEMARK_TEST_DATA") or ROOT.parent / "shared" / "data")

# Files of which the table says something else than their text: the reason stands beside.
MISSING_NOT_COMPARED = {
    "subject02_running.trc": "its table leaves out the all-zero L.Bicep that its text calls missing",
}
RATE_NOT_COMPARED = {
    "std_walking2_markers.trc": "every 10th frame was kept: rows are 0.04 s apart under a header of 250 Hz",
}


def described_files():
    """(path, facts, first value) of every table row that names a file."""
    folder = None
    for line in (DATA / "README.md").read_text(encoding="utf-8").splitlines():
        heading = re.match(r"## ([\w.-]+)/$", line)
        if heading:
            folder = DATA / heading[1]
        row = re.match(r"\| `([^`]+)` \| `[^`]*` \| [\d,]+ \| (.*) \| (.*) \|$", line)
        if row and folder:
            yield folder / row[1], row[2], row[3]


def info(path):
    done = subprocess.run([PROGRAM, "info", "--json", path], capture_output=True, text=True, check=False)
    return (json.loads(done.stdout) if done.returncode == 0 else None), done


def number(pattern, text):
    found = re.search(pattern, text)
    return float(found[1].replace(",", "")) if found else None


def differences(pairs):
    return [f"{name} {got}, README {wanted}" for name, got, wanted in pairs
            if wanted is not None and abs(float(got) - wanted) > 1e-5 * max(1.0, abs(wanted))]


def c3d_differences(facts, text):
    cut = number(r"file holds only (\d+)", text)
    missing = [int(n.replace(",", "")) for n in re.findall(r"([\d,]+) (?:residual|NaN)", text.split("missing:")[-1])]
    frames = cut or number(r"pt x (\d+) fr", text)
    wrong = differences([
        ("points", facts["points"] + len(facts["channels"]), number(r"(\d+) pt x", text)),
        ("frames", facts["frames"], frames),
        ("rate", facts["rate_hz"], number(r"@ ([\d.]+) Hz", text)),
        ("first frame", facts["first_frame"], number(r"frames (\d+)-", text)),
        ("analog channels", facts["analog_channels"], number(r"analog (\d+) ch", text) or 0.0),
        ("force plates", facts["force_plates"], number(r"(\d+) FP", text) or 0.0),
        ("missing", facts["missing"] + sum(c["missing"] for c in facts["channels"]), float(sum(missing))),
    ])
    units = re.search(r"units (\w+)", text)
    if units and facts["units"] != units[1]:
        wrong.append(f"units {facts['units']!r}, README {units[1]!r}")
    return wrong


def trc_differences(facts, text, name):
    names = number(r"names (\d+)", text)
    wrong = differences([("points", facts["points"], names), ("frames", facts["frames"], number(r"rows (\d+)", text))])
    if name not in MISSING_NOT_COMPARED:
        wrong += differences([("missing", facts["missing"], number(r"missing\(marker-frames\) (\d+)", text))])
    if name not in RATE_NOT_COMPARED:
        wrong += differences([("rate", facts["rate_hz"], number(r"TRC rate ([\d.]+)", text))])
    return wrong


def model_differences(facts, text):
    # Old formats list the ground among the bodies.
    bodies = number(r"bodies (\d+)", text) - (1 if re.search(r"v[23]\d{4}", text) else 0)
    couplers = number(r"'CoordinateCouplerConstraint': (\d+)", text) or 0.0
    return differences([
        ("bodies", sum(not b.endswith("_intermediate") for b in facts["body_names"]), bodies),
        ("coordinates", facts["coordinates"], number(r"coords (\d+)", text)),
        ("markers", facts["markers"], number(r"markers (\d+)", text)),
        ("couplers", facts["couplings"], couplers),
    ])


def first_value_differences(path, text, scratch):
    """The first value of a C3D row, `NAME` frame N = (x, y, z) in the file's units, against our CSV."""
    found = re.match(r"`(.+)` frame (\d+) = \(([-\d.]+), ([-\d.]+), ([-\d.]+)\)", text)
    if not found or found[1].startswith("("):
        return []
    csv = scratch / "first.csv"
    subprocess.run([PROGRAM, "convert", "--quiet", "--force", path, csv], check=True)
    scale = 1.0 if "units m;" in text else None
    named = False
    with csv.open(encoding="utf-8", newline="") as file:
        for row in csv_files.DictReader(file):
            if row["marker"] != found[1] and not row["marker"].startswith(found[1] + "."):
                continue
            named = True
            if row["frame"] == found[2]:
                got = [float(row[axis]) for axis in ("x_m", "y_m", "z_m")]
                wanted = [float(found[i]) for i in (3, 4, 5)]
                for factor in ((scale,) if scale else (1.0, 1e-3)):
                    if all(abs(g - w * factor) <= 0.00051 * factor + 1e-9 for g, w in zip(got, wanted)):
                        return []
                return [f"{found[1]} frame {found[2]} is {got} m, README {wanted}"]
    return [f"no frame {found[2]}" if named else f"no marker {found[1]!r}"]


def trc_first_differences(path, text, scratch):
    """The first row of a TRC row, first[NAME]=['x', 'y', 'z'] in the file's units, against our CSV."""
    found = re.search(r"first\[(.+?)\]=\[([^\]]*)\]", text)
    cells = [cell.strip(" '") for cell in found[2].split(",")] if found else []
    if len(cells) != 3 or any(not cell or cell.lower() == "nan" for cell in cells):
        return []
    csv = scratch / "first.csv"
    subprocess.run([PROGRAM, "convert", "--quiet", "--force", path, csv], check=True)
    factor = 1.0 if "units m " in text else 1e-3
    with csv.open(encoding="utf-8", newline="") as file:
        row = next(row for row in csv_files.DictReader(file) if row["marker"] == found[1])
    got = [float(row[axis]) for axis in ("x_m", "y_m", "z_m")]
    wanted = [float(cell) * factor for cell in cells]
    return [] if all(abs(g - w) < 1e-9 for g, w in zip(got, wanted)) else [f"{found[1]} starts at {got} m, README {wanted}"]


def main():
    if not (DATA / "README.md").is_file():
        print("SKIP | every file of the real recordings | - | NOT TESTED: set KINEMARK_TEST_DATA")
        return 0
    scratch = Path(os.environ.get("KINEMARK_SCRATCH", "/tmp"))
    counts = {".c3d": 0, ".trc": 0, ".osim": 0}
    wrong = {kind: [] for kind in counts}
    refused = []
    for path, text, first in described_files():
        kind = path.suffix.lower()
        if kind not in counts:
            continue
        facts, done = info(path)
        unreadable = "not a readable" in text or "rows 0" in text
        if unreadable:
            one_sentence = done.returncode == 3 and done.stderr.count("\n") == 1 and path.name in done.stderr
            refused.append((path.name, one_sentence))
            continue
        counts[kind] += 1
        if facts is None:
            wrong[kind].append(f"{path.name}: {done.stderr.strip()}")
            continue
        found = {".c3d": lambda: c3d_differences(facts, text) + first_value_differences(path, first, scratch),
                 ".trc": lambda: trc_differences(facts, text, path.name) + trc_first_differences(path, text, scratch),
                 ".osim": lambda: model_differences(facts, text)}[kind]()
        wrong[kind] += [f"{path.name}: {difference}" for difference in found]
    failed = False
    for kind, asked in ((".c3d", "points, frames, rate, first value, missing, analog, force plates, units as its README says"),
                        (".trc", "names, rows, rate, first value, missing as its README says"),
                        (".osim", "loads; bodies, coordinates, markers, couplers as its README says")):
        good = counts[kind] > 0 and not wrong[kind]
        failed = failed or not good
        measured = f"{counts[kind]} files agree" if good else "; ".join(wrong[kind])
        print(f"{'PASS' if good else 'FAIL'} | every {kind} of the real recordings | {asked} | {measured}")
    good = refused and all(ok for _, ok in refused)
    failed = failed or not good
    print(f"{'PASS' if good else 'FAIL'} | broken files | one clear sentence, exit status 3 | "
          f"{', '.join(name + ('' if ok else ' (not so)') for name, ok in refused)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
