#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated scans by a motor stage are calibrated, and of recordings that were cut off everything that was kept is used.

    scans.py FIRST-LAST [CUTS]

Seeds of the rigs, and how many places the recording of a tree is cut at. Prints rows "PASS|FAIL | check | asked | measured".
"""

import json
import os
import random
import statistics
import sys
import tempfile
from pathlib import Path

from rows import exit_status, row, run

FRAMES_PER_POSE = 10


def scan(seed, folder):
    """The report of a simulated scan, or the sentence with which it was refused."""
    lab = f"lab{seed}"
    run("simulate", "rig", "tree", "--scan", "-o", lab, "--seed", seed, "--quiet", folder=folder).check_returncode()
    ran = run("calibrate", f"{lab}/scan.mcap", "--nominal", f"{lab}/rig_nominal.toml", "--method", "scan", "-o", f"{lab}.toml", "--json", "--quiet", folder=folder)
    return json.loads(ran.stdout) if ran.returncode == 0 else ran.stderr.strip()


def cut(share, folder):
    """(poses used, whole poses kept) of a tree's recording of which so large a share was kept; None when there are too few."""
    whole = (folder / "tree" / "tree_poses.mcap").read_bytes()
    (folder / "cut.mcap").write_bytes(whole[: int(share * len(whole))])
    frames = json.loads(run("info", "cut.mcap", "--json", folder=folder).stdout)["frames"]
    grids = ("tree/grid_A.mcap", "tree/grid_B.mcap")
    ran = run("calibrate", "cut.mcap", *grids, "--nominal", "tree/rig_nominal.toml", "-o", "cut.toml", "--force", "--json",
              "--warp-degree", 6, "--no-crosstalk", folder=folder)  # fmt: skip
    used = json.loads(ran.stdout)["poses"] if ran.returncode == 0 else ran.stderr.strip()
    said = "not recorded to its end" in ran.stderr
    return used, frames // FRAMES_PER_POSE, said == (frames % FRAMES_PER_POSE != 0)


def main(arguments):
    first, last = map(int, arguments[0].split("-"))
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        folder = Path(scratch)
        reports = [scan(seed, folder) for seed in range(first, last + 1)]
        good = [report for report in reports if isinstance(report, dict)]
        for seed, report in enumerate(reports, first):
            if isinstance(report, str):
                print(f"seed {seed}: {report}")
        row(len(good) == len(reports), f"simulated scans, seeds {first}-{last}: calibrated", f"{len(reports)}", f"{len(good)}")
        if good:
            chi2 = [report["chi2_per_dof"] for report in good]
            row(max(chi2) <= 1.5, "their chi2 per degree of freedom", "<= 1.5", f"median {statistics.median(chi2):.2f}, largest {max(chi2):.2f}")
        cuts = int(arguments[1]) if len(arguments) > 1 else 0
        if cuts:
            run("simulate", "rig", "tree", "--grid", "--tree-poses", "-o", "tree", "--seed", first, folder=folder).check_returncode()
            dice = random.Random(first)
            found = [cut(dice.uniform(0.2, 0.99), folder) for _ in range(cuts)]
            used = sum(poses == whole for poses, whole, _ in found)
            for poses, whole, _ in found:
                if poses != whole:
                    print(f"of {whole} whole poses: {poses}")
            row(used == cuts, f"recordings of a tree cut at {cuts} places: all whole poses used", f"{cuts}", f"{used}")
            reported = sum(said for _, _, said in found)
            row(reported == cuts, "the frames of a pose that was cut are told, and only then", f"{cuts}", f"{reported}")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
