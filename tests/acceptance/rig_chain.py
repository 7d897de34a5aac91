#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""From counts to measures: wheels and signing arms of `simulate rig`, each on a rig of its own, through calibrate, reconstruct
(each frame, smoother, classic), clean, C3D, CSV and NWB to `measure`; how often its 95 % intervals hold the measures of the truth.

Arguments: first seed (default 1), number of rigs of each scene (default 4). Prints rows "PASS|FAIL | check | asked | measured".
"""

import collections
import csv
import json
import math
import random
import sys
import tempfile
from pathlib import Path

from rows import exit_status, output, row

# Method, filter of `clean` (none: not cleaned), format that is measured.
CHAINS = [
    ("frames", "", "csv"),
    ("smoother", "", "c3d"),
    ("smoother", "", "nwb"),
    ("frames", "kalman", "c3d"),
    ("frames", "butterworth", "nwb"),
    ("frames", "gcv", "csv"),
    ("classic", "", "csv"),
]
RATE_HZ = 100.0
MANY = 60  # intervals of one kind by which a share of 91 to 98 % can be known


def measured(path, *options):
    found = json.loads(output("measure", path, "--json", "--quiet", *options))
    return {(m["subject"], m["measure"]): m for m in found["measures"]}


def held(measure, truth):
    """Whether the interval holds the truth; nothing where none is given."""
    interval = measure.get("interval") or {}
    low, high = interval.get("low"), interval.get("high")
    if measure["value"] is None or (low is None and high is None):
        return None
    return (low is None or truth >= low) and (high is None or truth <= high)


def truth_at(folder, method):
    """The truth at the instants at which the LEDs shine, where a method leaves its points there; the smoother does not."""
    lines = (folder / "truth.trc").read_text().splitlines()
    if method == "smoother":
        return folder / "truth.trc"
    names = [name for name in lines[3].split("\t")[2:] if name.strip()]
    rows = [[float(cell) for cell in line.split("\t")[2:] if cell.strip()] for line in lines[5:] if line.split("\t")[0].strip()]
    offset_s = {}
    with (folder / f"{method}.csv").open(newline="") as file:
        for cells in csv.DictReader(file):
            offset_s.setdefault(cells["marker"], float(cells["offset_s"]))
    out = folder / f"truth_{method}.csv"
    with out.open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(["frame", "time_s", "marker", "x_m", "y_m", "z_m"])
        for f in range(len(rows)):
            for m, name in enumerate(names):
                # Lagrange's polynomial through the eight frames around.
                first = min(max(f - 3, 0), len(rows) - 8)
                u = f + offset_s[name] * RATE_HZ - first
                weights = [math.prod((u - j) / (i - j) for j in range(8) if j != i) for i in range(8)]
                x = [sum(w * rows[first + i][3 * m + a] for i, w in enumerate(weights)) / 1e3 for a in range(3)]
                table.writerow([f + 1, f / RATE_HZ, name, *x])
    return out


def points_of(folder, method, cleaned_by, ending):
    """The recording by one chain, each file made once."""
    first = folder / f"{method}.csv"
    if not first.exists():
        output("reconstruct", folder / "recording.mcap", "--rig", folder / "rig.toml", "--method", method, "-o", first, "--quiet")
    last = folder / f"{method}{cleaned_by}.{ending}"
    if cleaned_by:
        output("clean", first, last, "--filter", cleaned_by, "--quiet")
    elif not last.exists():
        output("convert", first, last, "--quiet")
    return last


def main():
    seed, count = (int(a) for a in (sys.argv[1:] + ["1", "4"])[:2])
    counts = {chain: collections.defaultdict(lambda: [0, 0]) for chain in CHAINS}
    asked = collections.Counter()
    with tempfile.TemporaryDirectory() as name:
        for scene in ("wheel", "sign"):
            for number in range(seed, seed + count):
                folder = Path(name) / f"{scene}{number}"
                seconds = random.Random(number).uniform(2.0, 6.0)
                output("simulate", "rig", scene, "-o", folder, "--tree-poses", "--grid", "--seed", number, "--duration", f"{seconds:.3f}", "--quiet")
                output("calibrate", folder / "tree_poses.mcap", folder / "grid_A.mcap", folder / "grid_B.mcap", "--nominal", folder / "rig_nominal.toml",
                    "-o", folder / "rig.toml", "--quiet")
                truths = {}
                for chain in CHAINS:
                    found = measured(points_of(folder, *chain))
                    if chain[0] not in truths:
                        truths[chain[0]] = measured(truth_at(folder, chain[0]), "--refits", "0")
                    truth = truths[chain[0]]
                    for key, measure in found.items():
                        if key not in truth or truth[key]["value"] is None:
                            continue
                        asked[chain] += 1
                        holds = held(measure, truth[key]["value"])
                        if holds is not None:
                            counts[chain][key[1]][0] += holds
                            counts[chain][key[1]][1] += 1
    shares = []
    for chain, kinds in counts.items():
        what = " ".join(filter(None, (chain[0], chain[1] and f"clean {chain[1]}", chain[2])))
        good, total = (sum(k[i] for k in kinds.values()) for i in (0, 1))
        row(0.91 <= good / total, f"{what}: 95 % intervals of all kinds", ">= 91 % hold the truth", f"{100 * good / total:.1f} % of {total}")
        row(total >= 0.8 * asked[chain], f"{what}: intervals are given", ">= 80 %", f"{total} of {asked[chain]}")
        shares += [(good / total, f"{kind}, {what}") for kind, (good, total) in kinds.items() if total >= MANY]
    if shares:
        below = sorted(share for share in shares if share[0] < 0.91)
        row(not below, "each kind by each chain", ">= 91 %", f"{100 * min(shares)[0]:.1f} % ({min(shares)[1]}); below 91: " + ", ".join(f"{k} {100 * v:.0f}" for v, k in below))
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
