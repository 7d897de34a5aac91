#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""A recording at the rate of its cameras, and as a recorder hands it on at four times that rate, through the commands that read
one: the same results within their standard deviations in the frames that were measured, or a refusal that names the way out.

The macaque's arm is simulated (60 Hz, a sleeve of 16 markers, a third of the samples lost); the walk is a real one of 100 Hz.
"""

import csv
import json
import math
import os
import shutil
import sys
import tempfile
from pathlib import Path

from rows import row, run

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA") or ROOT.parent / "shared" / "data")
WALK = DATA / "c3d-parser-clinics" / "MH0222_BP15.c3d"
ARM = ROOT / "models" / "macaque_arm.osim"
LEGS = "LASI,RASI,LPSI,RPSI,LTHI,RTHI,LKNE,RKNE,LTIB,RTIB,LANK,RANK,LHEE,RHEE,LTOE,RTOE"
FACTOR = 4
INTERPOLATIONS = ("linear", "cubic")
SUBJECT = [word for side in "LR" for word in ("--subject", f"{side}LegLength=880", "--subject", f"{side}KneeWidth=100", "--subject", f"{side}AnkleWidth=70")]


def table(path):
    """{time in microseconds: numbers} of a table of OpenSim."""
    lines = path.read_text().splitlines()
    rows = [[float(x) for x in line.split()] for line in lines[lines.index("endheader") + 2 :] if line.strip()]
    return {round(1e6 * numbers[0]): numbers[1:] for numbers in rows}


def centres(path):
    """{(time in microseconds, joint): coordinates} of joint centres, and the same of their standard deviations."""
    with path.open(newline="") as file:
        found = {(round(1e6 * float(line["time_s"])), line["marker"]): line for line in csv.DictReader(file) if line["x_m"] and line["sd_x_m"]}
    return tuple({key: [float(line[name.format(axis)]) for axis in "xyz"] for key, line in found.items()} for name in ("{}_m", "sd_{}_m"))


def sizes(path):
    """{parameter: its value} of a model that was adapted, and the same of their standard deviations."""
    found = json.loads(path.read_text())["motion"]["parameters"]
    return tuple({one["name"]: [one[key]] for one in found} for key in ("value", "sd"))


def in_deviations(low, high, deviations):
    """The largest difference, in standard deviations, of what both have; how many numbers that are."""
    worst, count = 0.0, 0
    for key, numbers in low.items():
        for a, b, sd in zip(numbers, high.get(key, ()), deviations[key]):
            if math.isfinite(a) and math.isfinite(b) and sd > 0.0:
                worst, count = max(worst, abs(a - b) / sd), count + 1
    return worst, count


def show(what, worst, count):
    row(count > 0 and worst <= 1.0, what, "those of the low rate within 1 SD", f"{worst:.2g} SD at most, {count} numbers")


def show_followed(folder, low, high, how):
    """What follows its goals in time meets lines between measurements, too: near to the low rate, and the way out is named."""
    done = run("track", "-m", ARM, "-t", high / "markers.c3d", "-o", high / "followed.mot", folder=folder)
    run("track", "-m", ARM, "-t", low / "markers.c3d", "-o", low / "followed.mot", folder=folder)
    worst, count = in_deviations(table(low / "followed.mot"), table(high / "followed.mot"), table(low / "followed_sd.sto"))
    row("clean --upsampled decimate" in done.stderr and count > 0, f"track, {how}", "a note names the way out", f"{worst:.2g} SD at most, {count} numbers")


def check_arm(folder, how):
    for name, more in (("low", ()), ("high", ("--upsample", FACTOR, "--interpolation", how))):
        run("simulate", "macaque", "-o", name, "--duration", 10, "--seed", 1, *more, folder=folder)
        run("ik", "-m", ARM, "-t", "markers.c3d", "-o", "q.mot", folder=folder / name)
        run("joints", "markers.c3d", "--segments", "segments.toml", "-o", "joints", folder=folder / name)
        run("scale", "-m", ARM, "-t", "markers.c3d", "-o", "sized.osim", folder=folder / name)
    low, high = folder / "low", folder / "high"
    show_followed(folder, low, high, how)
    show(f"ik, {how}", *in_deviations(table(low / "q.mot"), table(high / "q.mot"), table(low / "q_sd.sto")))
    one, deviations = centres(low / "joints" / "centres.csv")
    other, _ = centres(high / "joints" / "centres.csv")
    show(f"joints, {how}", *in_deviations(one, other, deviations))
    one, deviations = sizes(low / "sized_report.json")
    other, _ = sizes(high / "sized_report.json")
    show(f"scale, {how}", *in_deviations(one, other, deviations))


WAY_OUT = "kinemark clean IN OUT --upsampled decimate"
RATES = ("q_Kinematics_u", "q_Kinematics_dudt", "q_BodyKinematics_acc_global", "q_inverse_dynamics")


def check_rates(folder, how):
    """Speeds, accelerations and torques of the motion; `real.csv` is what the way out leaves of the recording."""
    low, high = folder / "low", folder / "high"
    words = ("dynamics", "q.mot", "-m", ARM, "--torques", "-o", "rates")
    refused = run(*words, folder=high)
    row(refused.returncode == 3 and WAY_OUT.replace("IN OUT ", "") in refused.stderr and not (high / "rates").exists(), f"dynamics, {how}", "refused, the way out is named", refused.stderr.strip()[:60])
    run(*words, folder=low)
    run("ik", "-m", ARM, "-t", "real.csv", "-o", "q.mot", "--force", folder=high)
    run(*words, folder=high)
    worst, count = 0.0, 0
    for name in RATES:
        found = in_deviations(*(table(place / "rates" / f"{name}{end}.sto") for place, end in ((low, ""), (high, ""), (low, "_sd"))))
        worst, count = max(worst, found[0]), count + found[1]
    show(f"dynamics after that way, {how}", worst, count)


def values(folder, recording):
    """{(measure, marker): value} of paths, or the sentence of a refusal."""
    out = folder / "paths.json"
    done = run("analyze", recording, "--measures", "path_length,mean_speed,peak_speed", "--refits", "0", "-o", out, "--force", folder=folder)
    return {(m["measure"], m["subject"]): m["value"] for m in json.loads(out.read_text())["measures"]} if done.returncode in (0, 1) else done.stderr


def check_measures(folder, how):
    refused = values(folder / "high", "markers.c3d")
    row(isinstance(refused, str) and f"'{WAY_OUT}'" in refused, f"measures of paths, {how}", "refused, the way out is named", str(refused).strip()[:60])
    run("clean", "markers.c3d", "real.csv", "--upsampled", "decimate", "--filter", "none", folder=folder / "high")
    one, other = values(folder / "low", "markers.c3d"), values(folder / "high", "real.csv")
    row(one == other and len(one) > 10, f"measures of paths after that way, {how}", "those of the low rate", f"{len(one)} and {len(other)} numbers")


def upsample(path, out):
    """A TRC at FACTOR times its rate, on lines between its samples."""
    lines = path.read_text().splitlines()
    rows = [[float(x) if x.strip() else None for x in line.split("\t")[1:]] for line in lines[5:] if line.strip()]
    made = []
    for here, there in zip(rows, rows[1:]):
        for k in range(FACTOR):
            w = k / FACTOR
            made.append([a if w == 0 else None if a is None or b is None else a + w * (b - a) for a, b in zip(here, there)])
    cells = lines[2].split("\t")
    first = (int(cells[6]) - 1) * FACTOR + 1
    cells = [str(float(cells[0]) * FACTOR), str(float(cells[1]) * FACTOR), str(len(made)), *cells[3:5], str(float(cells[5]) * FACTOR), str(first), str(len(made))]
    body = ["\t".join([str(first + i), f"{numbers[0]:.6f}", *("" if x is None else f"{x:.6f}" for x in numbers[1:])]) for i, numbers in enumerate(made)]
    out.write_text("\n".join([*lines[:2], "\t".join(cells), *lines[3:5], *body]) + "\n")


def check_walk(folder):
    run("convert", WALK, "low.trc", "--select", LEGS, folder=folder)
    upsample(folder / "low.trc", folder / "high.trc")
    for name in ("low", "high"):
        run("analyze", f"{name}.trc", "--segments", "pig", *SUBJECT, "--up", "z", "-o", f"angles_{name}", folder=folder)
        run("analyze", f"{name}.trc", "--measures", "gait", "--refits", "0", "--up", "z", "-o", f"{name}.json", folder=folder)
    low, high = (folder / f"angles_{name}" for name in ("low", "high"))
    show("angles of segments", *in_deviations(table(low / "angles.mot"), table(high / "angles.mot"), table(low / "angles_sd.sto")))
    one, other = (json.loads((folder / f"{name}.json").read_text())["gait"]["events"] for name in ("low", "high"))
    same = [e["label"] + e["context"] for e in one] == [e["label"] + e["context"] for e in other]
    worst = max((abs(a["time_s"] - b["time_s"]) / a["sd_s"] for a, b in zip(one, other)), default=math.inf)
    show("events of walking", worst if same else math.inf, len(one))


def main():
    with tempfile.TemporaryDirectory() as folder:
        for how in INTERPOLATIONS:
            place = Path(folder) / how
            place.mkdir()
            check_arm(place, how)
            check_measures(place, how)
            check_rates(place, how)
            shutil.rmtree(place)
        if WALK.is_file():
            check_walk(Path(folder))
        else:
            print(f"SKIP | a walk at four times its rate | | NO REAL DATA: {WALK} is not there; set KINEMARK_TEST_DATA")
    return 0


sys.exit(main())
