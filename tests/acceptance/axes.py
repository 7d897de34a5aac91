#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""The same trial with another axis up: scale, ik, track, torques and forces give the same numbers.

The copies are made here, by exchanging cells of the .trc and of the table of forces, not by kinemark. Forces are an
ExternalLoads file that pushes both feet; the recordings are a simulated subject and the walk of gait2354.

Finds the program in KINEMARK_PROGRAM and the recordings in KINEMARK_TEST_DATA; prints rows
"PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("KINEMARK_PROGRAM", str(ROOT / "build/release/bin/kinemark"))
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared/data")) / "opensim-gait2354"
MOST = 1e-9
NUMBER = re.compile(r"[+-]?\d+(\.\d*)?([eE][+-]?\d+)?")
FEET = ("calcn_r", "calcn_l")

LOADS = """<?xml version="1.0" encoding="UTF-8"?>
<OpenSimDocument Version="40000"><ExternalLoads name="feet"><objects>{}</objects><groups/>
<datafile>grf.mot</datafile></ExternalLoads></OpenSimDocument>
"""
FORCE = """<ExternalForce name="{0}"><applied_to_body>{0}</applied_to_body>
<force_expressed_in_body>ground</force_expressed_in_body><point_expressed_in_body>ground</point_expressed_in_body>
<force_identifier>{0}_v</force_identifier><point_identifier>{0}_p</point_identifier>
<torque_identifier>{0}_t</torque_identifier></ExternalForce>
"""


def kinemark(*arguments, cwd):
    done = subprocess.run([PROGRAM, *map(str, arguments)], cwd=cwd, capture_output=True, text=True, timeout=600, check=False)
    return done.returncode, done.stderr


def negated(cell):
    return cell[1:] if cell.startswith("-") else "-" + cell if cell.strip() else cell


def exchanged(cells):
    """x y z, with y up, in a laboratory with z up; no digit changed."""
    x, y, z = cells
    return [x, negated(z), y]


def turn_trc(source, target):
    lines = source.read_text().splitlines()
    for i, line in enumerate(lines[5:], 5):
        cells = line.split("\t")
        if len(cells) < 5:
            continue
        for k in range(2, len(cells) - 2, 3):
            cells[k : k + 3] = exchanged(cells[k : k + 3])
        lines[i] = "\t".join(cells)
    target.write_text("\n".join(lines) + "\n")


def write_forces(folder, z_up):
    """A steady push on each foot, upwards and a little forwards."""
    columns, row = ["time"], []
    for foot in FEET:
        for letter, values in (("v", ["30", "350", "10"]), ("p", ["0.1", "0.02", "0.05"]), ("t", ["1", "2", "3"])):
            columns += [f"{foot}_{letter}{axis}" for axis in "xyz"]
            row += exchanged(values) if z_up else values
    rows = [[str(time), *row] for time in (0, 100)]
    head = ["forces", "version=1", f"nRows={len(rows)}", f"nColumns={len(columns)}", "inDegrees=no", "endheader"]
    (folder / "grf.mot").write_text("\n".join([*head, "\t".join(columns), *("\t".join(r) for r in rows)]) + "\n")
    (folder / "loads.xml").write_text(LOADS.format("".join(FORCE.format(foot) for foot in FEET)))


def numbers(path):
    text = path.read_text()
    body = text.partition("endheader\n")[2] if path.suffix in (".mot", ".sto") else text.partition("<Model")[2]
    cells = body.replace("<", " ").replace(">", " ").split()
    return [float(cell) for cell in cells if NUMBER.fullmatch(cell)]


def worst_of(one, other, names):
    """Largest difference of any number in the files of both folders."""
    worst, count = 0.0, 0
    for name in names:
        a, b = numbers(one / name), numbers(other / name)
        if len(a) != len(b) or not a:
            raise ValueError(f"{name}: {len(a)} and {len(b)} numbers")
        count += len(a)
        worst = max(worst, *(abs(x - y) for x, y in zip(a, b)))
    return worst, count


def jobs(model):
    """(name, arguments, files that are compared)"""
    tau = [f"q_{name}.sto" for name in ("sd", "tau", "tau_sd")]
    return (
        ("scale", ["scale", "-m", model, "--static", "m.trc", "-o", "m.osim", "--max-rms", 500], ["m.osim"]),
        ("ik", ["ik", "-m", model, "-t", "m.trc", "-o", "q.mot"], ["q.mot", "q_sd.sto"]),
        ("ik --torques", ["ik", "-m", model, "-t", "m.trc", "-o", "q.mot", "--torques"], ["q.mot", *tau]),
        ("ik --forces", ["ik", "-m", model, "-t", "m.trc", "-o", "q.mot", "--forces", "loads.xml"], ["q.mot", *tau]),
        ("track", ["track", "-m", model, "-t", "m.trc", "-o", "q.mot"], ["q.mot", "q_tau.sto"]),
    )


def check(what, model, trc, scratch):
    """Rows of one recording with y up, as its model has."""
    failed = False
    for name, arguments, files in jobs(model):
        with tempfile.TemporaryDirectory(dir=scratch) as folder:
            own, turned, bare = (Path(folder) / part for part in ("own", "turned", "bare"))
            for place in (own, turned, bare):
                place.mkdir()
                write_forces(place, z_up=place is not own)
            (own / "m.trc").write_text(trc.read_text())
            for place in (turned, bare):
                turn_trc(trc, place / "m.trc")
            status, said = kinemark(*arguments, cwd=own)
            status_turned, said_turned = kinemark(*arguments, "--up", "z", cwd=turned)
            refused, sentence = kinemark(*arguments, cwd=bare)
            if status > 1 or status_turned > 1:
                good, measured = False, (said + said_turned).strip().splitlines()[-1]
            else:
                worst, count = worst_of(own, turned, files)
                good, measured = worst <= MOST and status == status_turned, f"{worst:.3g}, {count} numbers"
            failed |= not good
            print(f"{'PASS' if good else 'FAIL'} | {what}: {name}, z up, --up z | <= 1e-9 | {measured}")
            named = "--up z" in sentence
            good = refused == 3 and named and not (bare / files[0]).exists()
            failed |= not good
            measured = f"exit {refused}, {'names' if named else 'does not name'} --up z"
            print(f"{'PASS' if good else 'FAIL'} | {what}: {name}, z up | exit 3, names the option | {measured}", flush=True)
    return failed


def main():
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        simulated = Path(scratch) / "subject"
        status, said = kinemark("simulate", "subject", "-o", simulated, "--duration", 1, cwd=scratch)
        if status != 0:
            sys.exit(said)
        failed = check("simulated subject", simulated / "model.osim", simulated / "markers.trc", scratch)
        model, walk = DATA / "subject01_simbody.osim", DATA / "subject01_walk1.trc"
        if model.is_file() and walk.is_file():
            failed |= check("gait2354 walk", model, walk, scratch)
        else:
            print("SKIP | gait2354 walk, z up | <= 1e-9 | no real recordings")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
