#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""BVH files: where kinemark and three's BVHLoader, an unrelated reader, put the joints.

Files of all orders of rotation are read by both. Motions of models become BVH files, whose joints in three must be where
OpenSim has the origins of the bodies.

Needs Node and npm, which fetches three into a scratch folder, and Python with opensim. Finds the program in KINEMARK_PROGRAM
and the recordings in KINEMARK_TEST_DATA; prints rows "PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import csv
import itertools
import json
import math
import os
import random
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from rows import exit_status, row

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PROGRAM = Path(os.environ.get("KINEMARK_PROGRAM", str(ROOT / "build/release/bin/kinemark")))
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared/data"))
MOTIONS = {
    "gait2354": ("opensim-gait2354/subject01_simbody.osim", "opensim-gait2354/subject01_walk1_ik.mot"),
    "Rajagopal": ("bmc-rajagopal-run/Scale/Rajagopal2015_scaled.osim", "bmc-rajagopal-run/IK/results/ik_output_run.mot"),
    "Hamner": ("opensim-hamner-fullbody/subject02_registered.osim", "opensim-hamner-fullbody/subject02_running_ik.mot"),
}
PACKAGE = "three@0.187.0"
MOST = 1e-4  # of the size of the skeleton; three computes in single precision
METRES = 0.01


class Three:
    """three in a folder of its own."""

    def __init__(self, folder):
        own = ROOT / ".venv" / "bin"
        path = f"{own}{os.pathsep}{os.environ['PATH']}" if (own / "node").exists() else os.environ["PATH"]
        self.environment = {**os.environ, "PATH": path}
        self.script = Path(shutil.copy(HERE / "read_animation.js", folder / "read_animation.mjs"))
        subprocess.run(
            ["npm", "install", "--no-audit", "--no-fund", "--silent", "--prefix", folder, PACKAGE],
            env=self.environment, check=True, stdout=subprocess.DEVNULL, timeout=300,
        )  # fmt: skip

    def read(self, path):
        """([name of each joint], [[position of each joint, in units of the file] of each frame])."""
        ran = subprocess.run(["node", self.script, path], env=self.environment, capture_output=True, text=True, check=True)
        found = json.loads(ran.stdout)
        return found["names"], found["frames"]


def read_ours(path, folder):
    """{(frame from 0, marker): position, m} of a file that kinemark converts to CSV."""
    out = folder / "ours.csv"
    subprocess.run([PROGRAM, "convert", path, out, "--force", "--quiet"], check=True, stderr=subprocess.DEVNULL)
    with out.open(newline="") as file:
        return {(int(line["frame"]) - 1, line["marker"]): [float(line[axis]) for axis in ("x_m", "y_m", "z_m")]
                for line in csv.DictReader(file) if line["x_m"]}


def distance(a, b):
    return sum((p - q) ** 2 for p, q in zip(a, b)) ** 0.5


def compare(name, path, three, folder):
    names, frames = three.read(path)
    ours = read_ours(path, folder)
    worst, compared = 0.0, 0
    for f, positions in enumerate(frames):
        for joint, position in zip(names, positions):
            if joint == "ENDSITE":
                continue
            compared += 1
            worst = max(worst, distance(ours[f, joint], [METRES * v for v in position]))
    size = max(distance(a, b) for a, b in itertools.combinations([p for (f, _), p in ours.items() if f == 0], 2))
    row(compared > 0 and worst <= MOST * size, f"{name}: joints against three's BVHLoader, of the skeleton's size",
        f"at most {MOST:.0e}", f"{worst / size:.1e} ({compared} positions)")


def channels(order, positions):
    names = [f"{axis}position" for axis in "XYZ"] if positions else []
    return names + [f"{axis}rotation" for axis in order]


def made(seed, order, positions_everywhere, frames=20):
    """A tree of 16 joints and more, 170 cm or so, that turns and walks at random."""
    luck = random.Random(seed)
    lines, count, number = ["HIERARCHY"], [0], itertools.count()

    def joint(depth, indent):
        pad = "  " * indent
        own = channels(order, depth == 0 or positions_everywhere)
        count[0] += len(own)
        lines.extend([f"{pad}{'ROOT' if depth == 0 else 'JOINT'} joint{next(number)}", pad + "{"])
        lines.append(f"{pad}  OFFSET {luck.uniform(-10, 10):.4f} {luck.uniform(20, 50):.4f} {luck.uniform(-10, 10):.4f}")
        lines.append(f"{pad}  CHANNELS {len(own)} {' '.join(own)}")
        for _ in range((0, 1, 2, 3)[3 - depth]):
            joint(depth + 1, indent + 1)
        if depth == 3:
            lines.extend([pad + "  End Site", pad + "  {", pad + "    OFFSET 0.0 10.0 0.0", pad + "  }"])
        lines.append(pad + "}")

    joint(0, 0)
    lines += ["MOTION", f"Frames: {frames}", "Frame Time: 0.008333"]
    small = 3.0 if positions_everywhere else 170.0
    lines += [" ".join(f"{luck.uniform(-small, small):.6f}" for _ in range(count[0])) for _ in range(frames)]
    return "\n".join(lines) + "\n"


def origins_by_opensim(opensim, model_file, motion):
    """[{body: origin in the ground, m} of each row] as OpenSim places the model along a motion."""
    model = opensim.Model(str(model_file))
    state = model.initSystem()
    coordinates = [model.getCoordinateSet().get(i) for i in range(model.getCoordinateSet().getSize())]
    bodies = [model.getBodySet().get(i) for i in range(model.getBodySet().getSize())]
    lines = motion.read_text().split("endheader")[1].strip().splitlines()
    columns = lines[0].split()
    frames = []
    for line in lines[1:]:
        values = dict(zip(columns, map(float, line.split())))
        for coordinate in coordinates:
            if coordinate.isDependent(state) or coordinate.getName() not in values:
                continue
            turns = coordinate.getMotionType() == opensim.Coordinate.Rotational
            coordinate.setValue(state, values[coordinate.getName()] * (math.pi / 180.0 if turns else 1.0), False)
        model.assemble(state)
        model.realizePosition(state)
        frames.append({b.getName(): [b.getPositionInGround(state).get(i) for i in range(3)] for b in bodies})
    return frames


def check_motion(name, three, folder):
    import opensim

    opensim.Logger.setLevelString("Off")
    model, motion = (DATA / path for path in MOTIONS[name])
    path = folder / f"{name}.bvh"
    done = subprocess.run([PROGRAM, "convert", motion, path, "--model", model], capture_output=True, text=True, check=False)
    if done.returncode:
        return row(False, f"{name}: becomes a BVH", "exit status 0", done.stderr.strip())
    truth = origins_by_opensim(opensim, model, motion)
    names, frames = three.read(path)
    ours = read_ours(path, folder)
    size = max(distance(a, b) for a, b in itertools.combinations(truth[0].values(), 2))
    worst, own, compared = 0.0, 0.0, 0
    for f, (positions, bodies) in enumerate(zip(frames, truth)):
        for joint, position in zip(names, positions):
            if joint in bodies:
                worst = max(worst, distance(bodies[joint], [METRES * v for v in position]))
                own = max(own, distance(bodies[joint], ours[f, joint]))
                compared += 1
    row(compared == len(truth) * len(truth[0]) and len(frames) == len(truth) and worst <= MOST * size,
        f"{name}: origins of bodies in its BVH, by three, against OpenSim's, of the skeleton's size",
        f"at most {MOST:.0e}", f"{worst / size:.1e} ({compared} positions)")
    row(own <= MOST * size, f"{name}: the same, read back by kinemark", f"at most {MOST:.0e}", f"{own / size:.1e}")


def main():
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        folder = Path(scratch)
        three = Three(folder)
        for seed, order in enumerate(("ZXY", "ZYX", "XYZ", "YXZ", "YZX", "XZY")):
            path = folder / f"{order}.bvh"
            path.write_text(made(seed, order, False))
            compare(f"angles in the order {order}", path, three, folder)
        path = folder / "moving.bvh"
        path.write_text(made(7, "ZXY", True))
        compare("joints that move and turn", path, three, folder)
        if not DATA.is_dir():
            print("SKIP | motions of models as BVH | as OpenSim has them | no recordings")
            return exit_status()
        for name in MOTIONS:
            check_motion(name, three, folder)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
