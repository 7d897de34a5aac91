#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""From counts to joint centres: the sleeve of `simulate macaque` without skin, seen by a rig of its own each time, through calibrate,
reconstruct (each frame, smoother) and `joints`: how often the deviations of elbow and shoulder hold the truth.

A calibration knows the room up to a motion of the whole: it is found from the calibration's own tree, seen with the calibrated rig and with
the true one.

    rig_joints.py [SEED [RIGS]]

Needs Python with numpy and scipy. Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import csv
import json
import sys
import tempfile
from pathlib import Path

import numpy
from rows import exit_status, output, row
from scipy.interpolate import CubicSpline

METHODS = ("frames", "smoother")
PLACE = ("x_m", "y_m", "z_m")


def table(path):
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def trc(path):
    """Names, times and positions (m) of a TRC."""
    lines = path.read_text().splitlines()
    names = [name for name in lines[3].split("\t")[2:] if name.strip()]
    rows = numpy.array([[float(cell) for cell in line.split("\t") if cell.strip()] for line in lines[5:] if line.strip()])
    return names, rows[:, 1], rows[:, 2:].reshape(len(rows), len(names), 3) / 1e3


def true_from_calibrated(folder):
    """Rotation and shift that bring points of the calibrated rig to those of the true one."""
    clouds = []
    for rig in ("rig", "rig_true"):
        output("reconstruct", folder / "tree_poses.mcap", "--rig", folder / f"{rig}.toml", "--method", "frames", "-o", folder / f"tree_{rig}.csv", "--quiet")
        clouds.append({(r["frame"], r["marker"]): [float(r[k]) for k in PLACE] for r in table(folder / f"tree_{rig}.csv") if r["x_m"]})
    shared = sorted(set(clouds[0]) & set(clouds[1]))
    a, b = (numpy.array([cloud[key] for key in shared]) for cloud in clouds)
    u, _, v = numpy.linalg.svd((a - a.mean(0)).T @ (b - b.mean(0)))
    turn = v.T @ numpy.diag([1.0, 1.0, numpy.sign(numpy.linalg.det(v.T @ u.T))]) @ u.T
    return turn, b.mean(0) - turn @ a.mean(0)


def truth(arm, rig):
    """Joint centres (functions of time) in the room of the calibrated rig."""
    names, _, positions = trc(arm / "markers.trc")
    rig_names, _, rig_positions = trc(rig / "truth.trc")
    shift = rig_positions[0, rig_names.index(names[0])] - positions[0, 0]
    turn, moved = true_from_calibrated(rig)
    out = {}
    for joint in ("elbow", "shoulder"):
        rows = numpy.array([[float(r["time_s"])] + [float(r[k]) for k in PLACE] for r in table(arm / "truth.csv") if r["marker"] == joint])
        out[joint] = (CubicSpline(rows[:, 0], (rows[:, 1:] + shift - moved) @ turn), rows[-1, 0])
    return out


def main():
    seed, count = (int(a) for a in (sys.argv[1:] + ["1", "3"][len(sys.argv) - 1 :]))
    scores = {(method, joint): [] for method in METHODS for joint in ("elbow", "shoulder")}
    skin = dict.fromkeys(METHODS, 0)
    with tempfile.TemporaryDirectory() as name:
        for number in range(seed, seed + count):
            arm, rig = Path(name) / f"arm{number}", Path(name) / f"rig{number}"
            output("simulate", "macaque", "-o", arm, "--leds", "4", "--all-seen", "--noise", "0", "--duration", "20", "--seed", number, "--quiet")
            output("simulate", "rig", "markers", "-t", arm / "markers.trc", "-o", rig, "--tree-poses", "--grid", "--seed", number, "--quiet")
            output("calibrate", rig / "tree_poses.mcap", rig / "grid_A.mcap", rig / "grid_B.mcap", "--nominal", rig / "rig_nominal.toml",
                "-o", rig / "rig.toml", "--quiet")
            true = truth(arm, rig)
            for method in METHODS:
                output("reconstruct", rig / "recording.mcap", "--rig", rig / "rig.toml", "--method", method, "-o", rig / f"{method}.csv", "--quiet")
                output("joints", rig / f"{method}.csv", "--segments", arm / "segments.toml", "-o", rig / method, "--quiet")
                found = json.loads((rig / method / "skeleton.json").read_text())
                skin[method] += any(joint.get("skin", {}).get("verdict") == "follows the posture" for joint in found["joints"])
                centres = table(rig / method / "centres.csv")
                for joint, (at, last) in true.items():
                    rows = numpy.array([[float(r[k]) for k in ("time_s", *PLACE, "sd_x_m", "sd_y_m", "sd_z_m")] for r in centres
                        if r["marker"] == joint and r["x_m"] and float(r["time_s"]) <= last])
                    off = rows[:, 1:4] - at(rows[:, 0])
                    sd = rows[:, 4:7]
                    scores[method, joint].append([(abs(off) < sd).mean(), (abs(off) < 1.96 * sd).mean(), (off**2).mean(), numpy.median(sd) ** 2])
    for (method, joint), values in scores.items():
        one, two, squares, stated = numpy.mean(values, axis=0)
        what = f"{joint}, {method}, {count} rigs"
        row(0.60 <= one <= 0.75 and 0.90 <= two <= 0.98, f"{what}: held by 1 and 1.96 SD", "60-75 / 90-98 %", f"{100 * one:.0f} / {100 * two:.0f} %")
        ratio = (stated / squares) ** 0.5
        row(0.7 <= ratio <= 1.5, f"{what}: stated SD / RMS error", "0.7-1.5", f"{ratio:.2f} ({1e3 * squares**0.5:.3f} mm)")
    for method, said in skin.items():
        row(said <= max(1, count // 10), f"{method}, {count} rigs: skin said where there is none", "<= 1 of 10", f"{said} of {count}")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
