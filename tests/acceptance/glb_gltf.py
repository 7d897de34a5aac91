#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""GLB files: gltf-validator finds no error, and three's GLTFLoader puts their nodes where they belong.

Markers must be where the recording has them, turned to y up, and shown where they were seen; bodies must be where OpenSim has
their origins.

Needs Node and npm, which fetches three and gltf-validator into a scratch folder, and Python with opensim. Finds the program in
KINEMARK_PROGRAM and the recordings in KINEMARK_TEST_DATA; prints rows "PASS|FAIL|SKIP | check | asked | measured"; exit status 1
when one fails.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import bvh_three
from rows import exit_status

HERE = Path(__file__).resolve().parent
PACKAGES = ("three@0.187.0", "gltf-validator@2.0.0-dev.3.10")
MOST_M = 1e-6  # single precision, and a sum over the bodies of a leg
RECORDINGS = {  # and whether their z is up
    "CMU 02_05, z up": ("cmu-mocap/cmu_02_05.c3d", True),
    "gait2354 walk, y up": ("opensim-gait2354/subject01_walk1.trc", False),
    "running, 20 markers never seen": ("bmc-rajagopal-run/ExpData/motion_capture_run.trc", False),
}


class Judge:
    """gltf-validator and three in a folder of their own."""

    def __init__(self, folder):
        own = bvh_three.ROOT / ".venv" / "bin"
        path = f"{own}{os.pathsep}{os.environ['PATH']}" if (own / "node").exists() else os.environ["PATH"]
        self.environment = {**os.environ, "PATH": path}
        self.script = Path(shutil.copy(HERE / "read_glb.js", folder / "read_glb.mjs"))
        subprocess.run(
            ["npm", "install", "--no-audit", "--no-fund", "--silent", "--prefix", folder, *PACKAGES],
            env=self.environment, check=True, stdout=subprocess.DEVNULL, timeout=300,
        )  # fmt: skip

    def read(self, path, rate_hz, frames):
        ran = subprocess.run(["node", self.script, path, str(rate_hz), str(frames)], env=self.environment, capture_output=True,
                             text=True, check=True)
        return json.loads(ran.stdout)


def convert(*arguments):
    """What was said on the way."""
    done = subprocess.run([bvh_three.PROGRAM, "convert", *arguments], capture_output=True, text=True, check=False)
    if done.returncode:
        bvh_three.row(False, f"{arguments[1].name}: is written", "exit status 0", done.stderr.strip())
    return done.stderr


def info(path):
    return json.loads(subprocess.run([bvh_three.PROGRAM, "info", path, "--json"], capture_output=True, text=True, check=True).stdout)


def check_valid(name, found):
    bvh_three.row(found["errors"] == 0, f"{name}: gltf-validator", "0 errors",
                  f"{found['errors']} errors, {found['warnings']} warnings {' '.join(found['messages'])}".strip())


def check_recording(name, judge, folder):
    file, z_up = RECORDINGS[name]
    source, path, facts = bvh_three.DATA / file, folder / "markers.glb", info(bvh_three.DATA / file)
    convert(source, path, "--force")
    found = judge.read(path, facts["rate_hz"], facts["frames"])
    check_valid(name, found)
    turned = folder / "turned.csv"
    convert(source, turned, "--force", *(["--rotate", "x -90"] if z_up else []))
    truth = bvh_three.read_ours(turned, folder)
    worst, hidden, wrong = 0.0, 0, 0
    for label in facts["labels"]:
        for f, (x, y, z, scale) in enumerate(found["nodes"][label]):
            position = truth.get((f + facts["first_frame"] - 1, label))
            wrong += (position is None) != (scale == 0.0)
            hidden += position is None
            if position is not None:
                worst = max(worst, bvh_three.distance((x, y, z), position))
    bvh_three.row(worst <= MOST_M and len(truth) > 1000, f"{name}: markers by three's GLTFLoader against the recording",
                  f"at most {MOST_M:.0e} m", f"{worst:.1e} m ({len(truth)} positions)")
    bvh_three.row(wrong == 0, f"{name}: hidden where they were not seen, and nowhere else", "0 wrong", f"{wrong} wrong, {hidden} hidden")


def check_motion(name, judge, folder):
    import opensim

    opensim.Logger.setLevelString("Off")
    model, motion = (bvh_three.DATA / path for path in bvh_three.MOTIONS[name])
    path = folder / f"{name}.glb"
    convert(motion, path, "--model", model)
    truth, facts = bvh_three.origins_by_opensim(opensim, model, motion), info(motion)
    rate_hz = (facts["rows"] - 1) / (facts["last_time_s"] - facts["first_time_s"])
    found = judge.read(path, rate_hz, facts["rows"])
    check_valid(name, found)
    pairs = [(found["nodes"][body][f][:3], position) for f, frame in enumerate(truth) for body, position in frame.items()]
    worst = max(bvh_three.distance(a, b) for a, b in pairs)
    most = 3e-6  # OpenSim's assembler solves couplings to a few micrometres
    bvh_three.row(worst <= most, f"{name}: origins of bodies by three's GLTFLoader against OpenSim's", f"at most {most:.0e} m",
                  f"{worst:.1e} m ({len(pairs)} positions)")


def main():
    if not bvh_three.DATA.is_dir():
        print("SKIP | GLB files | valid, as recorded | no recordings")
        return 0
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        folder = Path(scratch)
        judge = Judge(folder)
        for name in RECORDINGS:
            check_recording(name, judge, folder)
        for name in bvh_three.MOTIONS:
            check_motion(name, judge, folder)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
