#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""The 1986 rig on rigs that nobody tuned to: `study poizner` for each seed, beside the bounds that rigs 1 to 10 keep.

    rigs.py FIRST-LAST

Prints rows "PASS|FAIL | check | asked | measured".
"""

import json
import statistics
import subprocess
import sys

from rows import PROGRAM, exit_status, row

POOLED = "still tree: error of distances, root mean square of all seeds"


def times_bound(measured, bound):
    """How far a row is off its bound: 1 at the bound, above it beyond; a bound is the most, or [least, most]."""
    least, most = bound if isinstance(bound, list) else (None, bound)
    return max(measured / most if most else 0.0, least / measured if least else 0.0)


def study(seeds):
    """{quantity: (measured, bound)} of the rows with a bound, or the sentence of a calibration that was refused."""
    ran = subprocess.run([PROGRAM, "study", "poizner", "--seeds", seeds, "--json"], capture_output=True, text=True, check=False)
    if ran.returncode not in (0, 1):
        return ran.stderr.strip()
    return {r["quantity"]: (r["ours"], r["bound"]) for r in json.loads(ran.stdout)["rows"] if r["bound"] is not None}


def main(arguments):
    first, last = map(int, arguments[0].split("-"))
    seeds = range(first, last + 1)
    rigs = {seed: study(str(seed)) for seed in seeds}
    measured = {seed: rows for seed, rows in rigs.items() if not isinstance(rows, str)}
    worst = {}
    for seed, rows in measured.items():
        singles = {quantity: times_bound(*found) for quantity, found in rows.items() if quantity != POOLED}
        worst[seed] = max((times, quantity) for quantity, times in singles.items())
    for seed, (times, quantity) in sorted(worst.items(), key=lambda item: -item[1][0])[:5]:
        print(f"rig {seed}: {times:.2f} times the bound of '{quantity}'")
    row(len(measured) == len(rigs), f"rigs {first}-{last}: calibrated, or refused", f"{len(rigs)}", f"{len(measured)}, {len(rigs) - len(measured)} refused")
    within = sum(times <= 2 for times, _ in worst.values())
    row(within >= 0.98 * len(worst), "rigs within twice the bounds", ">= 98 %", f"{within} of {len(worst)}")
    most = max(times for times, _ in worst.values())
    row(most <= 3, "no rig beyond three times a bound", "<= 3", f"{most:.2f}")
    for quantity in next(iter(measured.values())):
        found = [rows[quantity] for rows in measured.values()]
        if quantity == POOLED:
            value, bound = study(arguments[0])[quantity]
        else:
            value, bound = statistics.median(value for value, _ in found), found[0][1]
        passed = times_bound(value, bound) <= 1
        if not passed or quantity == POOLED:
            row(passed, f"{quantity}{'' if quantity == POOLED else ', median of the rigs'}", f"{bound}", f"{value:.4g}")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
