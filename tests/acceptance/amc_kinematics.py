#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""ASF and AMC files: kinemark's points against forward kinematics written here from Acclaim's description, and against the
markers that the Carnegie Mellon laboratory recorded of the same frames.

Finds the program in KINEMARK_PROGRAM and the recordings in KINEMARK_TEST_DATA; prints rows
"PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import csv
import math
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from rows import PROGRAM, exit_status, row

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared/data"))
UNIT_M = 0.0254 / 0.45  # Carnegie Mellon's own words: inches, divided by the length in the file
MOST_M = 1e-9
NEAR_M = {  # marker of the recording, the point nearest to it, and how far skin and model may be apart
    "LKNE": ("lfemur_end", 0.12), "RKNE": ("rfemur_end", 0.12), "LANK": ("ltibia_end", 0.12), "RANK": ("rtibia_end", 0.12),
    "LELB": ("lhumerus_end", 0.12), "RELB": ("rhumerus_end", 0.12), "CLAV": ("upperback_end", 0.25),
}  # fmt: skip


def product(a, b):
    return [[sum(a[i][k] * b[k][j] for k in range(3)) for j in range(3)] for i in range(3)]


def transposed(a):
    return [list(line) for line in zip(*a)]


def applied(a, v):
    return [sum(a[i][k] * v[k] for k in range(3)) for i in range(3)]


def turn(axis, degrees):
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]], "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}[axis]


def turned(axes, degrees):
    """One rotation after another, about axes that stay."""
    out = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
    for axis, angle in zip(axes, degrees):
        out = product(turn(axis, angle), out)
    return out


def read_skeleton(path):
    """{bone: its facts}, {bone: [bones that hang from it]}."""
    text = path.read_text()
    bones, children = {}, {}
    for block in text.split(":bonedata")[1].split(":hierarchy")[0].split("begin")[1:]:
        facts = {"dof": []}
        for line in block.splitlines():
            words = line.split()
            if words and words[0] in ("name", "direction", "length", "axis", "dof"):
                facts[words[0]] = words[1:]
        axes = turned(facts["axis"][3].lower(), map(float, facts["axis"][:3]))
        bones[facts["name"][0]] = {"axes": axes, "dof": facts["dof"],
                                   "vector": [float(facts["length"][0]) * float(v) for v in facts["direction"]]}
    for line in text.split(":hierarchy")[1].splitlines():
        words = line.split()
        if len(words) > 1:
            children[words[0]] = words[1:]
    return bones, children


def read_motion(path):
    frames = []
    for line in path.read_text().splitlines():
        if line.strip().isdigit():
            frames.append({})
        elif line[0] not in "#:":
            name, *values = line.split()
            frames[-1][name] = list(map(float, values))
    return frames


def placed(bones, children, frame):
    """{"root" or "<bone>_end": position, m}."""
    root = frame["root"]
    out = {"root": [UNIT_M * v for v in root[:3]]}
    waiting = [(child, root[:3], turned("xyz", root[3:])) for child in children["root"]]
    while waiting:
        name, start, rotation = waiting.pop()
        bone = bones[name]
        own = turned([d[1] for d in bone["dof"]], frame.get(name, []))
        rotation = product(rotation, product(product(bone["axes"], own), transposed(bone["axes"])))
        end = [a + b for a, b in zip(start, applied(rotation, bone["vector"]))]
        out[f"{name}_end"] = [UNIT_M * v for v in end]
        waiting += [(child, end, rotation) for child in children.get(name, [])]
    return out


def read_points(path, folder, *options):
    """[{marker: position, m} of each frame] of a file that kinemark converts to CSV."""
    out = folder / "points.csv"
    subprocess.run([PROGRAM, "convert", path, out, "--force", "--quiet", *options], check=True, stderr=subprocess.DEVNULL)
    frames = []
    with out.open(newline="") as file:
        for line in csv.DictReader(file):
            if int(line["frame"]) > len(frames):
                frames.append({})
            if line["x_m"]:
                frames[-1][line["marker"]] = [float(line[axis]) for axis in ("x_m", "y_m", "z_m")]
    return frames


def main():
    folder_of_data = DATA / "cmu-mocap"
    if not folder_of_data.is_dir():
        print("SKIP | ASF and AMC | as Acclaim describes them | no recordings")
        return 0
    amc = folder_of_data / "02_05.amc"
    skeleton, motion = read_skeleton(folder_of_data / "02.asf"), read_motion(amc)
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        folder = Path(scratch)
        ours = read_points(amc, folder, "--rate", "120")
        # This laboratory writes the axes y, z, x of its C3D files as x, y, z of its AMC files.
        markers = read_points(folder_of_data / "cmu_02_05.c3d", folder, "--rotate", "x -90 y -90")
    worst, compared = 0.0, 0
    for frame, points in zip(motion, ours):
        for name, position in placed(*skeleton, frame).items():
            worst = max(worst, math.dist(position, points[name]))
            compared += 1
    row(len(motion) == len(ours) == 1854 and compared == 1854 * len(ours[0]) and worst <= MOST_M,
        "CMU 02_05: points against forward kinematics in Python", f"at most {MOST_M:.0e} m", f"{worst:.1e} m ({compared} positions)")
    for marker, (point, most_m) in NEAR_M.items():
        distances = [math.dist(seen[name], points[point]) for seen, points in zip(markers, ours)
                     for name in seen if name.endswith(f":{marker}")]
        row(len(distances) > 1800 and max(distances) <= most_m, f"CMU 02_05: {point} near the marker {marker} in every frame",
            f"at most {most_m} m", f"{max(distances, default=math.nan):.3f} m ({len(distances)} frames)")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
