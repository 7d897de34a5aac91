#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""MOT files of kinemark ik read by OpenSim's own tools: the same results as from the MOT file that OpenSim writes.

OpenSim writes a motion (sine waves about the mean of a stored one) with its own conversion to degrees, which leaves a
coordinate in radians that moves its joint by functions alone (Rajagopal's patella). It places the model's markers along the
motion, kinemark ik finds the coordinates again, and InverseDynamicsTool and AnalyzeTool (body and point kinematics) run on
both files. Which coordinates stay in radians is compared on every model.

Needs Python with opensim. Finds the program in KINEMARK_PROGRAM and the recordings in KINEMARK_TEST_DATA; prints rows
"PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import json
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from rows import PROGRAM, row

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared/data"))
CASES = {
    "Rajagopal": ("bmc-rajagopal-run/Scale/Rajagopal2015_scaled.osim", "bmc-rajagopal-run/IK/results/ik_output_run.mot"),
    "gait2354": ("opensim-gait2354/subject01_simbody.osim", "opensim-gait2354/subject01_walk1_ik.mot"),
}
MODELS = (
    "models-upper-and-full-body/MOBL_ARMS_41.osim",
    "models-upper-and-full-body/Rajagopal2016.osim",
    "nimble-arnold-synthetic/subject01/subject01.osim",
)
RATE_HZ, FRAMES, RIM = 100.0, 101, 5  # the rim is not compared: splines begin there
MOST = 1e-6

TOOL = """<?xml version="1.0" encoding="UTF-8"?>
<OpenSimDocument Version="40000">{}</OpenSimDocument>
"""
DYNAMICS = """<InverseDynamicsTool name="judge"><results_directory>{folder}</results_directory>
<model_file>{model}</model_file><time_range>0 {end}</time_range><forces_to_exclude>Muscles</forces_to_exclude>
<coordinates_file>{motion}</coordinates_file>
<lowpass_cutoff_frequency_for_coordinates>-1</lowpass_cutoff_frequency_for_coordinates>
<output_gen_force_file>moments.sto</output_gen_force_file></InverseDynamicsTool>"""
ANALYZE = """<AnalyzeTool name="judge"><model_file>{model}</model_file><replace_force_set>false</replace_force_set>
<results_directory>{folder}</results_directory><output_precision>16</output_precision>
<initial_time>0</initial_time><final_time>{end}</final_time><coordinates_file>{motion}</coordinates_file>
<lowpass_cutoff_frequency_for_coordinates>-1</lowpass_cutoff_frequency_for_coordinates>
<AnalysisSet><objects><BodyKinematics name="bodies"><on>true</on><start_time>0</start_time><end_time>{end}</end_time>
<bodies>all</bodies><in_degrees>false</in_degrees></BodyKinematics>
<PointKinematics name="point"><on>true</on><start_time>0</start_time><end_time>{end}</end_time>
<body_name>{body}</body_name><relative_to_body_name>ground</relative_to_body_name><point_name>point</point_name>
<point>0.01 0.02 0.03</point></PointKinematics></objects></AnalysisSet></AnalyzeTool>"""


def read_table(path):
    """{column: [value of each row]} of a MOT or STO file."""
    lines = path.read_text().split("endheader\n")[1].splitlines()
    names = lines[0].split()
    rows = [[float(v) for v in line.split()] for line in lines[1:] if line.strip()]
    return {name: [line[i] for line in rows] for i, name in enumerate(names)}


def coordinates_of(model):
    return [model.getCoordinateSet().get(i) for i in range(model.getCoordinateSet().getSize())]


def kept_in_radians(opensim, model):
    """Rotations that OpenSim's conversion to degrees leaves alone."""
    known = (opensim.Coordinate.Rotational, opensim.Coordinate.Translational)
    return {c.getName() for c in coordinates_of(model) if c.getMotionType() not in known}


def make_motion(stored, coordinates, opensim):
    """[{coordinate: rad or m} of each frame]: waves of 0.7 to 1.1 Hz about the stored mean, couplings aside."""
    frames = [{} for _ in range(FRAMES)]
    for k, coordinate in enumerate(coordinates):
        values = stored.get(coordinate.getName())
        if values is None:
            continue
        unit = math.pi / 180.0 if coordinate.getMotionType() == opensim.Coordinate.Rotational else 1.0
        mean, size = 0.5 * (min(values) + max(values)) * unit, 0.25 * (max(values) - min(values)) * unit
        omega = 2.0 * math.pi * (0.7 + 0.1 * (k % 5))
        for f, frame in enumerate(frames):
            frame[coordinate.getName()] = mean + size * math.sin(omega * f / RATE_HZ + 0.8 * k)
    return frames


def place(model, state, coordinates, frame):
    """Sets one frame; a coordinate that is coupled follows, as OpenSim's assembler has it."""
    for coordinate in coordinates:
        if not coordinate.isDependent(state) and coordinate.getName() in frame:
            coordinate.setValue(state, frame[coordinate.getName()], False)
    model.assemble(state)
    model.realizePosition(state)


def write_inputs(opensim, model_file, stored, folder):
    """theirs.mot and markers.trc of the same motion, both by OpenSim."""
    model = opensim.Model(str(model_file))
    state = model.initSystem()
    coordinates = coordinates_of(model)
    markers = [model.getMarkerSet().get(i) for i in range(model.getMarkerSet().getSize())]
    storage = opensim.Storage(FRAMES, "Coordinates")
    labels = opensim.ArrayStr()
    for name in ["time", *(c.getName() for c in coordinates)]:
        labels.append(name)
    storage.setColumnLabels(labels)
    lines = ["PathFileType\t4\t(X/Y/Z)\tmarkers.trc",
             "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
             f"{RATE_HZ}\t{RATE_HZ}\t{FRAMES}\t{len(markers)}\tm\t{RATE_HZ}\t1\t{FRAMES}",
             "Frame#\tTime\t" + "\t\t\t".join(m.getName() for m in markers),
             "\t\t" + "\t".join(f"X{i}\tY{i}\tZ{i}" for i in range(1, len(markers) + 1)), ""]
    for f, frame in enumerate(make_motion(stored, coordinates, opensim)):
        place(model, state, coordinates, frame)
        values = [c.getValue(state) for c in coordinates]
        line = opensim.Vector(len(values), 0.0)
        for i, value in enumerate(values):
            line.set(i, value)
        storage.append(f / RATE_HZ, line)
        cells = []
        for marker in markers:
            position = marker.getLocationInGround(state)
            cells += [repr(position.get(axis)) for axis in range(3)]
        lines.append("\t".join([str(f + 1), repr(f / RATE_HZ), *cells]))
    model.getSimbodyEngine().convertRadiansToDegrees(storage)
    opensim.IO.SetPrecision(16)
    storage.printToFile(str(folder / "theirs.mot"), "w", "")
    (folder / "markers.trc").write_text("\n".join(lines) + "\n")
    return model


def run_tools(opensim, model_file, body, motion, folder):
    """Tables that InverseDynamicsTool and AnalyzeTool make of a motion."""
    folder.mkdir()
    values = {"model": model_file, "motion": motion, "folder": folder, "body": body, "end": (FRAMES - 1) / RATE_HZ}
    for name, text, tool in (("id", DYNAMICS, opensim.InverseDynamicsTool), ("analyze", ANALYZE, opensim.AnalyzeTool)):
        setup = folder / f"{name}.xml"
        setup.write_text(TOOL.format(text.format(**values)))
        if not tool(str(setup)).run():
            sys.exit(f"OpenSim's {name} failed on {motion}")
    return {path.name: read_table(path) for path in sorted(folder.glob("*.sto"))}


def largest_difference(theirs, ours):
    """(largest |difference| over the largest value of its table, its column) away from the rim."""
    worst = (0.0, "")
    for name, columns in theirs.items():
        size = max(abs(v) for column, values in columns.items() if column != "time" for v in values) or 1.0
        for column, values in columns.items():
            pairs = list(zip(values, ours[name][column]))[RIM:-RIM]
            worst = max(worst, (max(abs(a - b) for a, b in pairs) / size, f"{name} {column}"))
    return worst


def check_case(opensim, name, scratch):
    original, stored = (DATA / path for path in CASES[name])
    folder = scratch / name
    folder.mkdir()
    # OpenSim brings an older file to its own version with six digits; both programs read what it then writes.
    model_file = folder / "model.osim"
    opensim.Model(str(original)).printToXML(str(model_file))
    model = write_inputs(opensim, model_file, read_table(stored), folder)
    done = subprocess.run([PROGRAM, "ik", "--model", model_file, "--markers", folder / "markers.trc", "--output",
                           folder / "ours.mot", "--no-limits"], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1):
        return row(False, f"{name}: kinemark ik", "a result", done.stderr.strip())
    theirs, ours = read_table(folder / "theirs.mot"), read_table(folder / "ours.mot")
    furthest = max((max(abs(a - b) for a, b in zip(theirs[c], ours[c])), c) for c in theirs if c != "time")
    kept = sorted(kept_in_radians(opensim, model))
    good = row(furthest[0] <= MOST, f"{name}: our MOT against OpenSim's, column by column, in the file's units",
               f"at most {MOST:.0e}", f"{furthest[0]:.1e} ({furthest[1]}); in rad in both: {', '.join(kept) or 'none'}")
    body = model.getBodySet().get(model.getBodySet().getSize() - 1).getName()
    tables = [run_tools(opensim, model_file, body, folder / f"{who}.mot", folder / who) for who in ("theirs", "ours")]
    difference, where = largest_difference(*tables)
    return row(len(tables[0]) >= 7 and difference <= MOST,
               f"{name}: InverseDynamicsTool and AnalyzeTool on our MOT and on OpenSim's",
               f"7 tables and more, at most {MOST:.0e} of the largest value", f"{len(tables[0])} tables, {difference:.1e} ({where})") and good


def check_units(opensim, path, scratch):
    """The coordinates that stay in radians, by a subject that kinemark simulates with the model."""
    folder = scratch / Path(path).stem
    kept = kept_in_radians(opensim, opensim.Model(str(DATA / path)))
    done = subprocess.run([PROGRAM, "simulate", "subject", "--model", DATA / path, "--duration", "0.2", "--out", folder],
                          capture_output=True, text=True, check=False)
    solved = subprocess.run([PROGRAM, "ik", "--model", folder / "model.osim", "--markers", folder / "markers.c3d",
                             "--output", folder / "q.mot"], capture_output=True, text=True, check=False)
    report = folder / "q_report.json"
    if done.returncode or solved.returncode not in (0, 1) or not report.exists():
        return row(False, f"{path}: coordinates in rad", "a result", (done.stderr + solved.stderr).strip())
    ours = {c["name"] for c in json.loads(report.read_text())["coordinates"] if c["unit_in_tables"] == "rad"}
    return row(ours == kept, f"{path}: coordinates in rad", ", ".join(sorted(kept)) or "none", ", ".join(sorted(ours)) or "none")


def main():
    if not DATA.is_dir():
        print("SKIP | MOT files read by OpenSim's tools | as theirs | no recordings")
        return 0
    import opensim

    opensim.Logger.setLevelString("Off")
    with tempfile.TemporaryDirectory() as scratch:
        good = [check_case(opensim, name, Path(scratch)) for name in CASES]
        good += [check_units(opensim, path, Path(scratch)) for path in MODELS]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
