#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Muscles of scaled models beside those that OpenSim's ScaleTool scales.

Both scale gait2354 as its setup says (the factors come from distances of markers), and Rajagopal2016 by factors given
by hand, other ones along each axis. OpenSim loads both results and is asked for everything: what a model has, where
its path points are, how long fibres and tendons are at rest, and the moment arms over the range of every coordinate.

Needs Python with opensim. Finds the program in KINEMARK_PROGRAM and the models in KINEMARK_TEST_DATA; prints rows
"PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

from rows import PROGRAM, exit_status, row

ROOT = Path(__file__).resolve().parent.parent.parent
MOST = 1e-6  # m
STEPS = 7  # poses over the range of a coordinate
FACTORS = {"pelvis": (1.05, 0.95, 1.1), "femur": (0.97, 1.06, 1.02), "tibia": (1.03, 1.08, 0.96), "torso": (1.1, 1.04, 1.0)}
OTHERS = (1.02, 0.98, 1.05)


def manual_setup(model, markers):
    """A ScaleTool setup with factors by hand for every body of the model."""
    scales = ""
    for i in range(model.getBodySet().getSize()):
        name = model.getBodySet().get(i).getName()
        factors = FACTORS.get(name.rsplit("_", 1)[0], OTHERS)
        scales += (
            f"<Scale><scales>{' '.join(map(str, factors))}</scales><segment>{name}</segment><apply>true</apply></Scale>"
        )
    return f"""<?xml version="1.0" encoding="UTF-8"?>
<OpenSimDocument Version="40000"><ScaleTool name="subject"><mass>70</mass>
<GenericModelMaker><model_file>{model.getInputFileName()}</model_file></GenericModelMaker>
<ModelScaler><apply>true</apply><scaling_order>manualScale</scaling_order>
<ScaleSet><objects>{scales}</objects></ScaleSet><marker_file>{markers}</marker_file><time_range>0 1</time_range>
<preserve_mass_distribution>false</preserve_mass_distribution><output_model_file>theirs.osim</output_model_file>
</ModelScaler><MarkerPlacer><apply>false</apply></MarkerPlacer></ScaleTool></OpenSimDocument>"""


def scale_both(opensim, setup):
    """(our model, theirs), by OpenSim's own reader."""
    tool = opensim.ScaleTool(setup)
    tool.getModelScaler().setOutputModelFileName("theirs.osim")
    tool.getMarkerPlacer().setApply(False)
    Path("theirs.osim").unlink(missing_ok=True)
    tool.run()  # says False when no markers are placed, also where it went well
    if not Path("theirs.osim").is_file():
        sys.exit("OpenSim's ScaleTool failed")
    command = [PROGRAM, "scale", "--setup", setup, "--output", "ours.osim", "--force", "--max-rms", "1000"]
    subprocess.run(command, check=True, capture_output=True)
    return opensim.Model("ours.osim"), opensim.Model("theirs.osim")


def surfaces_of(model):
    """Number of surfaces that the path of each muscle may bend around."""
    muscles = (model.getMuscles().get(i) for i in range(model.getMuscles().getSize()))
    return {m.getName(): m.getGeometryPath().getWrapSet().getSize() for m in muscles}


def largest_point_distance(opensim, ours, theirs):
    """(largest difference of a coordinate of a path point, how many points), in the default pose, in the point's frame."""
    states = ours.initSystem(), theirs.initSystem()
    largest, count = 0.0, 0
    for i in range(theirs.getMuscles().getSize()):
        name = theirs.getMuscles().get(i).getName()
        paths = [m.getMuscles().get(name).getGeometryPath().getPathPointSet() for m in (ours, theirs)]
        if paths[0].getSize() != paths[1].getSize():
            return float("inf"), count
        for k in range(paths[1].getSize()):
            a, b = (paths[j].get(k).getLocation(states[j]) for j in range(2))
            frames = [paths[j].get(k).getParentFrame().getName() for j in range(2)]
            largest = max([largest, *(abs(a.get(x) - b.get(x)) for x in range(3)), *([1e9] * (frames[0] != frames[1]))])
            count += 1
    return largest, count


def largest_rest_length(ours, theirs, names):
    """(largest difference of fibre and tendon lengths at rest, its muscle)."""
    worst = (0.0, "-")
    for name in names:
        a, b = ours.getMuscles().get(name), theirs.getMuscles().get(name)
        for length in ("get_optimal_fiber_length", "get_tendon_slack_length"):
            worst = max(worst, (abs(getattr(a, length)() - getattr(b, length)()), name))
    return worst


def largest_path_length(muscles, models):
    """(largest difference of a path's length between our report and OpenSim, of models in their default pose, its muscle)."""
    worst = (0.0, "-")
    for model, key in models:
        state = model.initSystem()
        for muscle in muscles:
            length = model.getMuscles().get(muscle["name"]).getGeometryPath().getLength(state)
            worst = max(worst, (abs(muscle[key] - length), muscle["name"]))
    return worst


def largest_moment_arm(ours, theirs):
    """(largest difference of moment arms over the range of every coordinate, where, how many)."""
    states = [ours.initSystem(), theirs.initSystem()]
    worst, count = (0.0, "-"), 0
    for c in range(theirs.getCoordinateSet().getSize()):
        name = theirs.getCoordinateSet().get(c).getName()
        coordinates = [model.getCoordinateSet().get(name) for model in (ours, theirs)]
        if coordinates[1].getDefaultLocked() or coordinates[1].isConstrained(states[1]) or name.startswith("pelvis"):
            continue
        low, high = coordinates[1].getRangeMin(), coordinates[1].getRangeMax()
        for step in range(STEPS):
            value = low + (high - low) * step / (STEPS - 1)
            for coordinate, state in zip(coordinates, states):
                coordinate.setValue(state, value)
            for i in range(theirs.getMuscles().getSize()):
                muscle = theirs.getMuscles().get(i)
                a = ours.getMuscles().get(muscle.getName()).getGeometryPath().computeMomentArm(states[0], coordinates[0])
                b = muscle.getGeometryPath().computeMomentArm(states[1], coordinates[1])
                worst = max(worst, (abs(a - b), f"{muscle.getName()} about {name}"))
                count += 1
        for coordinate, state in zip(coordinates, states):
            coordinate.setValue(state, coordinate.getDefaultValue())
    return (*worst, count)


def compare(opensim, name, setup):
    ours, theirs = scale_both(opensim, setup)
    counts = [[m.getMuscles().getSize(), m.getForceSet().getSize(), m.getNumBodies()] for m in (ours, theirs)]
    row(counts[0] == counts[1], f"{name}: OpenSim loads it; muscles, forces, bodies", f"{counts[1]}", f"{counts[0]}")
    if counts[0] != counts[1]:
        return
    distance, count = largest_point_distance(opensim, ours, theirs)
    row(distance <= MOST, f"{name}: path points", f"<= {MOST} m", f"{distance:.2g} m, {count} points")
    report = {m["name"]: m for m in json.loads(Path("ours_report.json").read_text())["muscles"]}
    generic = opensim.Model(ElementTree.parse(setup).findtext(".//GenericModelMaker/model_file").strip())
    surfaces = surfaces_of(theirs)
    for what, least, most in (("straight paths", 0, 0), ("around one surface", 1, 1), ("around several surfaces", 2, 99)):
        muscles = sorted(muscle for muscle, count in surfaces.items() if least <= count <= most)
        if not muscles:
            continue
        worst, muscle = largest_rest_length(ours, theirs, muscles)
        check = f"{name}: fibre and tendon lengths at rest, {what}"
        row(worst <= MOST, check, f"<= {MOST} m", f"{worst:.2g} m ({muscle}), {len(muscles)} muscles")
        worst, muscle = largest_path_length([report[m] for m in muscles], [(generic, "before_m"), (theirs, "after_m")])
        check = f"{name}: lengths of paths, before and after, {what}"
        row(worst <= MOST, check, f"<= {MOST} m", f"{worst:.2g} m ({muscle}), {len(muscles)} muscles")
    arm, where, count = largest_moment_arm(ours, theirs)
    row(arm <= MOST, f"{name}: moment arms over the range of motion", f"<= {MOST} m", f"{arm:.2g} m ({where}), {count}")


def main():
    data = Path(os.environ.get("KINEMARK_TEST_DATA") or ROOT.parent / "shared" / "data")
    if not data.is_dir():
        print("SKIP | muscles of scaled models | - | NOT TESTED: set KINEMARK_TEST_DATA")
        return 0
    import opensim

    opensim.Logger.setLevelString("Off")
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        folder = Path(scratch)
        for source in (data / "opensim-gait2354").iterdir():
            shutil.copyfile(source, folder / source.name)
        shutil.copyfile(data / "models-upper-and-full-body" / "Rajagopal2016.osim", folder / "rajagopal.osim")
        os.chdir(folder)
        compare(opensim, "gait2354 by its setup", "subject01_Setup_Scale.xml")
        setup = manual_setup(opensim.Model("rajagopal.osim"), "subject01_static.trc")
        Path("rajagopal.xml").write_text(setup)
        compare(opensim, "Rajagopal2016 by hand", "rajagopal.xml")
        os.chdir(ROOT)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
