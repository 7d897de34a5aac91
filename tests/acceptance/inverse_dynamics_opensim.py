#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Torques of gait2354 with forces under both feet: kinemark ik --torques --forces beside OpenSim's InverseDynamicsTool.

The motion is made of sine waves about the mean of the stored walk, with its amplitudes, so that both programs can
differentiate it; OpenSim places the model's markers for it, and kinemark finds coordinates, rates and torques from those
markers. Forces, points and torques under the feet are waves too, in an ExternalLoads file that both read.

Needs Python with opensim. Finds the program in KINEMARK_PROGRAM and the recordings in KINEMARK_TEST_DATA; prints rows
"PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("KINEMARK_PROGRAM", str(ROOT / "build/release/bin/kinemark"))
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared/data")) / "opensim-gait2354"
RATE_HZ, FRAMES, RIM = 100.0, 151, 20  # the rim is not compared: both programs lack a neighbour there
MOST = 1e-5
CHECK = "gait2354 with forces under both feet: torques beside OpenSim's InverseDynamicsTool"

LOADS = """<?xml version="1.0" encoding="UTF-8"?>
<OpenSimDocument Version="40000"><ExternalLoads name="feet"><objects>{}</objects><groups/>
<datafile>grf.mot</datafile></ExternalLoads></OpenSimDocument>
"""
FORCE = """<ExternalForce name="{0}"><applied_to_body>calcn_{0}</applied_to_body>
<force_expressed_in_body>ground</force_expressed_in_body><point_expressed_in_body>ground</point_expressed_in_body>
<force_identifier>{0}_v</force_identifier><point_identifier>{0}_p</point_identifier>
<torque_identifier>{0}_t</torque_identifier></ExternalForce>
"""
SETUP = """<?xml version="1.0" encoding="UTF-8"?>
<OpenSimDocument Version="40000"><InverseDynamicsTool name="judge"><results_directory>.</results_directory>
<model_file>{model}</model_file><time_range>0 {end}</time_range><forces_to_exclude>Muscles</forces_to_exclude>
<external_loads_file>loads.xml</external_loads_file><coordinates_file>motion.mot</coordinates_file>
<lowpass_cutoff_frequency_for_coordinates>-1</lowpass_cutoff_frequency_for_coordinates>
<output_gen_force_file>judge.sto</output_gen_force_file></InverseDynamicsTool></OpenSimDocument>
"""


def read_table(path):
    """({column: [value of each row]}) of a MOT or STO file."""
    lines = path.read_text().split("endheader\n")[1].splitlines()
    names = lines[0].split()
    rows = [[float(v) for v in line.split()] for line in lines[1:] if line.strip()]
    return {name: [row[i] for row in rows] for i, name in enumerate(names)}


def write_table(path, columns, in_degrees):
    """Columns over time, as OpenSim reads them."""
    names, rows = list(columns), len(next(iter(columns.values())))
    head = [path.name, "version=1", f"nRows={rows}", f"nColumns={len(names)}", f"inDegrees={in_degrees}", "endheader"]
    body = ["\t".join(repr(columns[name][i]) for name in names) for i in range(rows)]
    path.write_text("\n".join([*head, "\t".join(names), *body]) + "\n")


def make_motion(walk):
    """Waves of 0.7 to 1.1 Hz with mean and half the range of each column; degrees and metres."""
    motion = {"time": [i / RATE_HZ for i in range(FRAMES)]}
    for k, name in enumerate(n for n in walk if n != "time"):
        low, high = min(walk[name]), max(walk[name])
        size = 0.05 if name in ("pelvis_tx", "pelvis_tz") else 0.5 * (high - low)
        omega = 2.0 * math.pi * (0.7 + 0.1 * (k % 5))
        motion[name] = [0.5 * (low + high) + size * math.sin(omega * t + 0.8 * k) for t in motion["time"]]
    return motion


def make_forces(times):
    """Force, point and torque under two feet, one of them never quite off the ground."""
    columns = {"time": times}
    for k, (foot, side) in enumerate((("r", 0.1), ("l", -0.1))):
        wave = [math.sin(2.0 * math.pi * 0.9 * t + 2.5 * k) for t in times]
        cosine = [math.cos(2.0 * math.pi * 0.6 * t + k) for t in times]
        triples = {"v": (lambda w, c: (60.0 * c, 400.0 + 350.0 * w, 30.0 * w)),
                   "p": (lambda w, c, z=side: (0.1 * c, 0.0, z + 0.02 * w)), "t": (lambda w, c: (0.0, 8.0 * c * w, 0.0))}
        for kind, f in triples.items():
            for axis, name in enumerate("xyz"):
                columns[f"{foot}_{kind}{name}"] = [f(w, c)[axis] for w, c in zip(wave, cosine)]
    return columns


def write_markers(opensim, model_file, motion, path):
    """The model's markers along the motion, as a TRC file in metres."""
    model = opensim.Model(str(model_file))
    state = model.initSystem()
    coordinates = [model.getCoordinateSet().get(name) for name in motion if name != "time"]
    are_rotations = [c.getMotionType() == opensim.Coordinate.Rotational for c in coordinates]
    markers = [model.getMarkerSet().get(i) for i in range(model.getMarkerSet().getSize())]
    names = [m.getName() for m in markers]
    lines = [f"PathFileType\t4\t(X/Y/Z)\t{path.name}",
             "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
             f"{RATE_HZ}\t{RATE_HZ}\t{FRAMES}\t{len(names)}\tm\t{RATE_HZ}\t1\t{FRAMES}",
             "Frame#\tTime\t" + "\t\t\t".join(names),
             "\t\t" + "\t".join(f"X{i}\tY{i}\tZ{i}" for i in range(1, len(names) + 1)), ""]
    for f, time in enumerate(motion["time"]):
        for coordinate, is_rotation in zip(coordinates, are_rotations):
            value = motion[coordinate.getName()][f]
            coordinate.setValue(state, math.radians(value) if is_rotation else value, False)
        model.realizePosition(state)
        cells = []
        for marker in markers:
            position = marker.getLocationInGround(state)
            cells += [repr(position.get(axis)) for axis in range(3)]
        lines.append("\t".join([str(f + 1), repr(time), *cells]))
    path.write_text("\n".join(lines) + "\n")


def differences(judge, ours):
    """{column: (RMS difference, largest of the judge's)} away from the rim."""
    found = {}
    for name in judge:
        if name == "time" or name not in ours:
            continue
        pairs = list(zip(judge[name], ours[name]))[RIM:FRAMES - RIM]
        rms = math.sqrt(sum((a - b) ** 2 for a, b in pairs) / len(pairs))
        found[name] = (rms, max(abs(a) for a, _ in pairs))
    return found


def run(folder):
    """Both programs on the same motion; the comparison."""
    import opensim

    opensim.Logger.setLevelString("Error")
    model = DATA / "subject01_simbody.osim"
    motion = make_motion(read_table(DATA / "subject01_walk1_ik.mot"))
    write_table(folder / "motion.mot", motion, "yes")
    write_table(folder / "grf.mot", make_forces(motion["time"]), "no")
    (folder / "loads.xml").write_text(LOADS.format("".join(FORCE.format(foot) for foot in "rl")))
    (folder / "setup.xml").write_text(SETUP.format(model=model, end=motion["time"][-1]))
    write_markers(opensim, model, motion, folder / "markers.trc")
    if not opensim.InverseDynamicsTool(str(folder / "setup.xml")).run():
        sys.exit("OpenSim's InverseDynamicsTool failed")
    done = subprocess.run([PROGRAM, "ik", "--model", model, "--markers", folder / "markers.trc", "--torques", "--forces",
                           folder / "loads.xml", "--output", folder / "ours.mot", "--no-limits"],
                          capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        sys.exit(done.stderr)
    return differences(read_table(folder / "judge.sto"), read_table(folder / "ours_tau.sto"))


def main():
    if not DATA.is_dir():
        print(f"SKIP | {CHECK} | at most {MOST:.0e} | no recordings")
        return 0
    with tempfile.TemporaryDirectory() as scratch:
        found = run(Path(scratch))
    largest = {"moment": 0.0, "force": 0.0}
    for name, (_, size) in found.items():
        kind = name.rsplit("_", 1)[1]
        largest[kind] = max(largest[kind], size)
    shares = {name: rms / largest[name.rsplit("_", 1)[1]] for name, (rms, _) in found.items()}
    if len(shares) < 20 or any(math.isnan(v) for v in shares.values()):
        print(f"FAIL | {CHECK} | 20 columns and more | {len(shares)} columns, some without a number")
        return 1
    worst = max(shares, key=shares.get)
    good = shares[worst] <= MOST
    print(f"{'PASS' if good else 'FAIL'} | {CHECK} | RMS difference at most {MOST:.0e} of the largest moment or force | "
          f"{shares[worst]:.1e} ({worst}: {found[worst][0]:.3g} of {largest[worst.rsplit('_', 1)[1]]:.4g}), "
          f"{len(shares)} coordinates")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
