#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Models as MJCF and URDF: where MuJoCo has the mass centres, in random postures, and where kinemark analyze has them.

MuJoCo loads the file that kinemark convert wrote. Joints get random values within the ranges of their coordinates; those that
follow get what the polynomials and lines in that file say. Exact models must agree, others to the errors that the conversion
said: along the way from the ground to a body, errors of translations as they are, of rotations times their distance.

Needs Python with mujoco. Finds the program in KINEMARK_PROGRAM and the models in KINEMARK_TEST_DATA; prints rows
"PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import json
import math
import os
import random
import re
import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

import mujoco
import numpy

from rows import output, row

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared/data"))
MODELS = {
    "human": ROOT / "models/human.osim",
    "macaque": ROOT / "models/macaque_arm.osim",
    "gait2354": DATA / "opensim-gait2354/gait2354_simbody.osim",
    "Rajagopal": DATA / "models-upper-and-full-body/Rajagopal2016.osim",
}
EXACT = ("human", "macaque")
FRAMES = 40
MOST_M, MOST_KG, MOST_RESIDUAL = 1e-6, 1e-6, 1e-12
ROUNDED = 1.01  # of an error said with three digits
FOLLOWS = re.compile(r"(?:joint '(?P<joint>[^']+)': its \w+ (?P<place>\d+)|coordinate '(?P<own>[^']+)') follows .* "
                     r"at most (?P<size>\S+) (?P<unit>mm|deg) off")


class Source:
    """What the model file says of coordinates and masses."""

    def __init__(self, path):
        tree = ElementTree.parse(path).getroot()
        self.mass = sum(float(body.findtext("mass", "0")) for body in tree.iter("Body"))
        self.ranges = {}
        for node in tree.iter("Coordinate"):
            if node.findtext("locked", "false").strip() != "true":
                self.ranges[node.get("name")] = tuple(map(float, node.findtext("range").split()))
        for node in tree.iter("CoordinateCouplerConstraint"):
            self.ranges.pop(node.findtext("dependent_coordinate_name").strip())


def followers(path):
    """{joint that follows: (joint that leads, coefficients from the constant upwards)} as the file has them."""
    tree = ElementTree.parse(path).getroot()
    found = {node.get("joint1"): (node.get("joint2"), [float(c) for c in node.get("polycoef").split()])
             for node in tree.findall("equality/joint")}
    for joint in tree.findall("joint"):
        mimic = joint.find("mimic")
        if mimic is not None:
            found[joint.get("name")] = (mimic.get("joint"), [float(mimic.get("offset")), float(mimic.get("multiplier"))])
    return found


def said_errors(warnings):
    """{joint: how far off the conversion says that it may be, m or rad}."""
    errors = {}
    for found in filter(None, map(FOLLOWS.search, warnings)):
        name = found["own"] or f"{found['joint']}_{found['place']}"
        errors[name] = float(found["size"]) * (1e-3 if found["unit"] == "mm" else math.pi / 180.0)
    return errors


def write_motion(path, postures):
    names = list(postures[0])
    lines = [path.stem, "version=1", f"nRows={len(postures)}", f"nColumns={len(names) + 1}", "inDegrees=no", "endheader",
             "\t".join(["time", *names])]
    lines += ["\t".join([f"{f / 100.0:.2f}", *(repr(posture[name]) for name in names)]) for f, posture in enumerate(postures)]
    path.write_text("\n".join(lines) + "\n")


def read_centres(path):
    """[{body: mass centre in the ground, m} of each row]."""
    header, table = path.read_text().split("endheader\n")
    assert "inDegrees=yes" in header
    lines = [line.split() for line in table.strip().splitlines()]
    bodies = [name[:-2] for name in lines[0] if name.endswith("_X")]
    columns = {name: i for i, name in enumerate(lines[0])}
    return [{body: numpy.array([float(line[columns[f"{body}_{axis}"]]) for axis in "XYZ"]) for body in bodies}
            for line in lines[1:]]


class Judge:
    """MuJoCo with a written file."""

    def __init__(self, path, warnings):
        self.model = mujoco.MjModel.from_xml_path(str(path))
        self.data = mujoco.MjData(self.model)
        self.followers = followers(path)
        self.errors = said_errors(warnings)

    def joint(self, name):
        found = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_JOINT, name)
        if found < 0:
            raise KeyError(f"no joint '{name}'")
        return found

    def leaders(self):
        names = [self.model.joint(i).name for i in range(self.model.njnt)]
        return {name for name in names if name not in self.followers}

    def value(self, name, posture):
        if name not in self.followers:
            return posture[name]
        leader, coefficients = self.followers[name]
        return numpy.polynomial.polynomial.polyval(self.value(leader, posture), coefficients)

    def place(self, posture):
        for i in range(self.model.njnt):
            self.data.qpos[self.model.jnt_qposadr[i]] = self.value(self.model.joint(i).name, posture)
        mujoco.mj_forward(self.model, self.data)

    def centre(self, body):
        found = mujoco.mj_name2id(self.model, mujoco.mjtObj.mjOBJ_BODY, body)
        if found < 0:
            raise KeyError(f"no body '{body}'")
        return self.data.xipos[found]

    def allowed(self, body):
        """How far the mass centre may be off by what the conversion said, m."""
        centre, most = self.centre(body), MOST_M
        at = self.model.body(body).id
        while at > 0:
            for j in range(self.model.njnt):
                if self.model.jnt_bodyid[j] != at:
                    continue
                error = ROUNDED * self.errors.get(self.model.joint(j).name, 0.0)
                turns = self.model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE
                most += error * (numpy.linalg.norm(centre - self.data.xanchor[j]) if turns else 1.0)
            at = self.model.body_parentid[at]
        return most

    def residual(self):
        """MuJoCo's own of its equalities, m or rad."""
        kind = self.data.efc_type == mujoco.mjtConstraint.mjCNSTR_EQUALITY
        return float(numpy.max(numpy.abs(self.data.efc_pos[kind]), initial=0.0))


def check(name, ending, source, postures, centres, folder):
    path = folder / f"{name}{ending}"
    warnings = json.loads(output("convert", MODELS[name], path, "--json"))["warnings"]
    judge = Judge(path, warnings)
    label = f"{name}, {ending[1:]}"
    good = row(judge.leaders() == set(source.ranges), f"{label}: joints that lead are the free coordinates",
               f"{len(source.ranges)} of them", f"{len(judge.leaders())}, and {len(judge.followers)} that follow")
    worst, share, residual = 0.0, 0.0, 0.0
    for posture, truth in zip(postures, centres):
        judge.place(posture)
        residual = max(residual, judge.residual())
        for body, centre in truth.items():
            if body == "center_of_mass":
                continue
            off = float(numpy.linalg.norm(centre - judge.centre(body)))
            worst, share = max(worst, off), max(share, off / judge.allowed(body))
    if name in EXACT:
        good &= row(not judge.errors and worst <= MOST_M, f"{label}: mass centres of bodies", f"at most {MOST_M:.0e} m",
                    f"{worst:.1e} m ({len(centres)} postures, {len(centres[0]) - 1} bodies)")
    else:
        good &= row(judge.errors and share <= 1.0, f"{label}: mass centres of bodies, of the error that was said", "at most 1",
                    f"{share:.2f}, {1e3 * worst:.3f} mm ({len(centres)} postures, {len(centres[0]) - 1} bodies)")
    if ending == ".xml" and judge.followers:
        good &= row(judge.model.neq == len(judge.followers) and residual <= MOST_RESIDUAL,
                    f"{label}: MuJoCo's own residual of what follows", f"at most {MOST_RESIDUAL:.0e}",
                    f"{residual:.1e} ({judge.model.neq} equalities)")
    mass = abs(float(judge.model.body_subtreemass[0]) - source.mass)
    return row(mass <= MOST_KG, f"{label}: mass", f"within {MOST_KG:.0e} kg of {source.mass:.3f}", f"{mass:.1e} kg") and good


def main():
    good = True
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        folder = Path(scratch)
        for seed, (name, path) in enumerate(MODELS.items()):
            if not path.exists():
                print(f"SKIP | {name} as MuJoCo has it | as analyze has it | no {path.name}")
                continue
            source, luck = Source(path), random.Random(seed)
            postures = [{coordinate: luck.uniform(*limits) for coordinate, limits in source.ranges.items()}
                        for _ in range(FRAMES)]
            motion, out = folder / f"{name}.mot", folder / name
            write_motion(motion, postures)
            output("analyze", motion, "-m", path, "-o", out, "--no-error-bars")
            centres = read_centres(out / f"{name}_BodyKinematics_pos_global.sto")
            if not row(len(centres) == FRAMES, f"{name}: postures that analyze has", FRAMES, len(centres)):
                good = False
                continue
            for ending in (".xml", ".urdf"):
                good &= check(name, ending, source, postures, centres, folder)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
