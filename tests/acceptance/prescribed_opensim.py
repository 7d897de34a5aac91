#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Coordinates that a model prescribes by a function of time: kinemark ik beside OpenSim's InverseKinematicsTool.

OpenSim puts a function of each kind on coordinates of three models, moves the model by it and by waves of its other
coordinates, and places the markers; 2 mm of noise are added. Both programs solve the same files. A coordinate whose flag
is false must not follow its function. (OpenSim 4.6 does not assemble a model that locks such a coordinate besides.)

Needs Python with opensim. Finds the program in KINEMARK_PROGRAM and the recordings in KINEMARK_TEST_DATA; prints rows
"PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import math
import os
import random
import subprocess
import sys
import tempfile
from pathlib import Path

from rows import PROGRAM, row

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared/data"))
RATE_HZ, FRAMES, T0_S = 100.0, 61, 0.4
MOST_DEG, OF_SD = 0.01, 0.05  # OpenSim stops where a weakly seen angle changes the cost no more
GAIT = ("opensim-gait2354/subject01_simbody.osim", ("hip_rotation_r", "knee_angle_l", "lumbar_bending"))
CASES = (*((*GAIT, kind) for kind in ("sine", "spline", "polynomial", "pieces", "multiplied")),
         ("bmc-rajagopal-run/Scale/Rajagopal2015_scaled.osim", ("hip_rotation_l", "arm_flex_r", "pelvis_tilt"), "sine"),
         ("opensim-arm26/arm26.osim", ("r_elbow_flex",), "spline"),
         (*GAIT, "off"))  # fmt: skip

TOOL = """<?xml version="1.0" encoding="UTF-8"?>
<OpenSimDocument Version="40000"><InverseKinematicsTool name="judge"><model_file>{model}</model_file>
<constraint_weight>Inf</constraint_weight><accuracy>1e-10</accuracy><marker_file>{markers}</marker_file>
<IKTaskSet><objects>{tasks}</objects></IKTaskSet>
<output_motion_file>{motion}</output_motion_file></InverseKinematicsTool></OpenSimDocument>
"""


def function(opensim, kind, centre, amplitude):
    """A function of time in s, about `centre` rad."""
    times = [T0_S - 0.2 + 0.1 * i for i in range(12)]
    values = [centre + amplitude * math.sin(7.0 * t) for t in times]
    if kind in ("sine", "off"):
        return opensim.Sine(amplitude, 6.0, 0.5, centre)
    if kind == "polynomial":  # the highest power first
        return opensim.PolynomialFunction(opensim.Vector([-amplitude, 0.5 * amplitude, amplitude, centre]))
    if kind == "multiplied":
        inner = opensim.Sine(2.0 * amplitude, 6.0, 0.5, 2.0 * centre)
        inner.thisown = False  # the multiplier takes it
        return opensim.MultiplierFunction(inner, 0.5)
    out = opensim.SimmSpline() if kind == "spline" else opensim.PiecewiseLinearFunction()
    for t, v in zip(times, values):
        out.addPoint(t, v)
    return out


def read_angles(path):
    """{column: [value of each row]} of a MOT file in degrees."""
    lines = path.read_text().split("endheader\n")[1].splitlines()
    names = lines[0].split()
    rows = [[float(v) for v in line.split()] for line in lines[1:] if line.strip()]
    return {name: [line[i] for line in rows] for i, name in enumerate(names)}


def write_trc(path, names, frames):
    head = [f"PathFileType\t4\t(X/Y/Z)\t{path.name}",
            "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
            f"{RATE_HZ}\t{RATE_HZ}\t{len(frames)}\t{len(names)}\tm\t{RATE_HZ}\t1\t{len(frames)}",
            "Frame#\tTime\t" + "\t\t\t".join(names), "\t\t" + "\t".join(f"X{i + 1}\tY{i + 1}\tZ{i + 1}" for i in range(len(names))), ""]  # fmt: skip
    for f, positions in enumerate(frames):
        cells = [f"{x:.9f}" for point in positions for x in point]
        head.append("\t".join([str(f + 1), f"{T0_S + f / RATE_HZ:.6f}", *cells]))
    path.write_text("\n".join(head) + "\n")


def make(opensim, case, folder, draw):
    """Write model and markers of one case; returns the names of its markers."""
    source, names, kind = case
    given = opensim.Model(str(DATA / source))
    for name in names:
        coordinate = given.updCoordinateSet().get(name)
        middle, width = coordinate.getDefaultValue(), coordinate.getRangeMax() - coordinate.getRangeMin()
        coordinate.setPrescribedFunction(function(opensim, kind, middle + 0.02 * width, min(0.3, 0.1 * width)))
        coordinate.setDefaultIsPrescribed(kind != "off")
    given.finalizeConnections()
    given.printToXML(str(folder / "model.osim"))
    model = opensim.Model(str(folder / "model.osim"))
    state = model.initSystem()
    moving = [c for c in (model.getCoordinateSet().get(i) for i in range(model.getCoordinateSet().getSize()))
              if c.getMotionType() == opensim.Coordinate.Rotational and not c.isConstrained(state) and c.getName() not in names]  # fmt: skip
    waves = [(c, c.getDefaultValue(), draw.uniform(0.02, 0.15), draw.uniform(3.0, 7.0), draw.uniform(0.0, 6.0)) for c in moving]
    markers = [model.getMarkerSet().get(i) for i in range(model.getMarkerSet().getSize())]
    frames = []
    for f in range(FRAMES):
        t = T0_S + f / RATE_HZ
        state.setTime(t)
        for c, middle, size, omega, phase in waves:
            c.setValue(state, middle + size * math.sin(omega * t + phase), False)
        model.assemble(state)
        model.realizePosition(state)
        positions = [marker.getLocationInGround(state) for marker in markers]
        frames.append([[p.get(i) + draw.gauss(0.0, 0.002) for i in range(3)] for p in positions])
    found = [marker.getName() for marker in markers]
    write_trc(folder / "markers.trc", found, frames)
    return found


def solve(opensim, folder, markers):
    tasks = "".join(f'<IKMarkerTask name="{name}"><apply>true</apply><weight>1</weight></IKMarkerTask>' for name in markers)
    paths = {name: folder / f"{name}" for name in ("model.osim", "markers.trc", "theirs.mot", "ours.mot")}
    setup = folder / "setup.xml"
    setup.write_text(TOOL.format(model=paths["model.osim"], markers=paths["markers.trc"], motion=paths["theirs.mot"], tasks=tasks))
    if not opensim.InverseKinematicsTool(str(setup)).run():
        raise SystemExit("OpenSim's InverseKinematicsTool failed")
    done = subprocess.run([PROGRAM, "ik", "-m", paths["model.osim"], "-t", paths["markers.trc"], "-o", paths["ours.mot"],
                           "--force"], capture_output=True, text=True)  # fmt: skip
    if done.returncode not in (0, 1):
        raise SystemExit(done.stderr)
    return read_angles(paths["theirs.mot"]), read_angles(paths["ours.mot"]), read_angles(folder / "ours_sd.sto"), done.stderr


def main():
    try:
        import opensim
    except ImportError:
        print("SKIP | prescribed_opensim | needs Python with opensim | not installed")
        return 0
    opensim.Logger.setLevelString("error")
    good = True
    draw = random.Random(3)
    for case in CASES:
        source, names, kind = case
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            theirs, ours, sd, said = solve(opensim, folder, make(opensim, case, folder, draw))
        angles = [c for c in theirs if c != "time" and not c.endswith(("_tx", "_ty", "_tz", "_beta"))]
        worst, where = max((abs(a - b), c) for c in angles for a, b in zip(theirs[c], ours[c]))
        near = all(abs(a - b) <= max(MOST_DEG, OF_SD * s) for c in angles for a, b, s in zip(theirs[c], ours[c], sd[c]))
        moved = min(max(ours[c]) - min(ours[c]) for c in names)
        noted = all((f"'{c}' follows the function of time" in said) == (kind != "off") for c in names)
        what = f"{Path(source).stem}, {kind} on {', '.join(names)}"
        good &= row(near and len(ours["time"]) == FRAMES, what, f"all angles within {MOST_DEG} deg or {OF_SD} SD of OpenSim's",
                    f"{worst:.2g} deg ({where}), {FRAMES} frames")  # fmt: skip
        good &= row(noted and moved > 1.0, f"{what}: said and moved",
                    "a note where it follows alone; moves", f"moves by {moved:.1f} deg")  # fmt: skip
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
