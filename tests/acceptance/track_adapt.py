#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Limb lengths that direct control finds (`track --adapt`): simulated subjects, followed by a body of wrong sizes whose markers sit elsewhere.

The body is the subject's own, each limb scaled by a factor of its own (5 %) and each marker moved (10 mm per axis, the deviation that the
adaptation takes for granted). Asked: lengths and angles, how often their deviations hold the truth, and what adapting is worth.

    track_adapt.py [SEED [SUBJECTS]]

Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import json
import math
import random
import re
import statistics
import sys
import tempfile
from pathlib import Path

from rows import exit_status, output, row

LIMBS = [[f"{name}_{side}" for name in names] for names in (["femur"], ["tibia"], ["humerus"], ["radius", "ulna"]) for side in "lr"]
PLACE = re.compile(r"(<Marker name=.*?<location>)([^<]*)(</location>)", re.DOTALL)
SETUP = """<OpenSimDocument Version="40000"><ScaleTool name="wrong"><mass>-1</mass><GenericModelMaker><model_file>{model}</model_file>
</GenericModelMaker><ModelScaler><apply>true</apply><scaling_order>manualScale</scaling_order><ScaleSet><objects>{scales}</objects></ScaleSet>
<preserve_mass_distribution>false</preserve_mass_distribution></ModelScaler></ScaleTool></OpenSimDocument>"""
SCALE = "<Scale name='{0}'><scales>{1} {1} {1}</scales><segment>{0}</segment><apply>true</apply></Scale>"


def make_wrong(folder, draw):
    """Write wrong.osim, the subject's model with other sizes and markers elsewhere."""
    factors = [draw.gauss(1.0, 0.05) for _ in LIMBS]
    scales = "".join(SCALE.format(bone, f"{factor:.6f}") for limb, factor in zip(LIMBS, factors, strict=True) for bone in limb)
    (folder / "wrong.xml").write_text(SETUP.format(model=folder / "model.osim", scales=scales))
    output("scale", "--setup", folder / "wrong.xml", "-m", folder / "model.osim", "-o", folder / "sized.osim", "--quiet")

    def moved(match):
        place = (float(x) + draw.gauss(0.0, 0.01) for x in match[2].split())
        return match[1] + " ".join(f"{x:.6f}" for x in place) + match[3]

    (folder / "wrong.osim").write_text(PLACE.sub(moved, (folder / "sized.osim").read_text()))


def table(path):
    head, body = path.read_text().split("endheader")[0], path.read_text().split("endheader")[1].split("\n")
    rows = [line.split() for line in body if line.strip()]
    assert "inDegrees=yes" in head, path
    return {name: [float(r[k]) for r in rows[1:]] for k, name in enumerate(rows[0])}


def angles(folder, name):
    """Errors and deviations of the angles of joints, deg, where they are determined."""
    truth, found, sd = table(folder / "truth.mot"), table(folder / f"{name}.mot"), table(folder / f"{name}_sd.sto")
    for joint in found:
        if joint == "time" or joint.startswith("pelvis_"):
            continue
        for value, true, deviation in zip(found[joint], truth[joint], sd[joint], strict=True):
            if not math.isnan(deviation):
                yield value - true, deviation


def held(pairs, times):
    return 100.0 * statistics.fmean(abs(error) <= times * sd for error, sd in pairs)


def rms(values):
    return math.sqrt(statistics.fmean(x * x for x in values))


def lengths(path):
    return {one["name"]: one for one in json.loads(path.read_text())["adapted"]["lengths"]}


def main():
    seed, count = (int(a) for a in (sys.argv[1:] + ["1", "3"][len(sys.argv) - 1 :]))
    found, followed, without, gained, missing = [], [], [], [], 0
    with tempfile.TemporaryDirectory() as name:
        for number in range(seed, seed + count):
            folder = Path(name) / str(number)
            output("simulate", "subject", "-o", folder, "--duration", "8", "--noise", "1", "--seed", number, "--quiet")
            make_wrong(folder, random.Random(number))
            track = ("track", "-t", folder / "markers.c3d", "--quiet")
            output(*track, "-m", folder / "model.osim", "-o", folder / "true.mot", "--adapt")
            output(*track, "-m", folder / "wrong.osim", "-o", folder / "plain.mot")
            output(*track, "-m", folder / "wrong.osim", "-o", folder / "adapted.mot", "--adapt")
            true = {key: one["initial_m"] for key, one in lengths(folder / "true_report.json").items()}
            for key, one in lengths(folder / "adapted_report.json").items():
                limb = any(key.split(":")[0] in bones for bones in LIMBS)
                missing += limb and not one["determined"]
                if limb and one["determined"]:
                    found.append((1e3 * (one["length_m"] - true[key]), 1e3 * one["sd_m"]))
                    gained.append(1e3 * (one["initial_m"] - true[key]))
            followed += angles(folder, "adapted")
            without += angles(folder, "plain")
    what = f"{count} subjects, limbs of wrong lengths, markers 10 mm elsewhere"
    row(missing == 0 and held(found, 1) >= 60 and held(found, 1.96) >= 90, f"track --adapt, lengths of limbs, {what}",
        "every one determined; within 1 SD in 60 % or more, within 1.96 in 90 % or more",
        f"{missing} of {missing + len(found)} not; {held(found, 1):.0f} and {held(found, 1.96):.0f} %; RMS error "
        f"{rms(e for e, _ in found):.1f} mm, stated {rms(s for _, s in found):.1f}; {rms(gained):.1f} mm in the model that was given")
    row(held(followed, 1) >= 60 and held(followed, 1.96) >= 90, f"track --adapt, angles, {what}",
        "within 1 SD in 60 % or more, within 1.96 in 90 % or more",
        f"{held(followed, 1):.0f} and {held(followed, 1.96):.0f} %; RMS error {rms(e for e, _ in followed):.2f} deg, stated "
        f"{rms(s for _, s in followed):.2f}")
    row(rms(e for e, _ in followed) < rms(e for e, _ in without), f"track --adapt, angles beside the body as it was given, {what}",
        "nearer to the truth", f"{rms(e for e, _ in followed):.2f} deg, {rms(e for e, _ in without):.2f} deg as given")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
