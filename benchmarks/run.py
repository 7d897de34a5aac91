#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""kinemark beside OpenSim and ezc3d, on the same files in one run: speed, cost reached, angle differences.

    benchmarks/run.py [--build FOLDER] [--data FOLDER] [--json FILE] [CASE...]

Cases: gait2354, gait2354_setup, hamner, rajagopal, c3d; all unless told. Needs .venv of tools/setup --oracles, the
programs of FOLDER/bin, and for all but c3d the real recordings. Only ratios within a run mean anything: the machine
may be busy. Exit status 1 when a bound is missed or could not be tested.
"""

import argparse
import contextlib
import io
import json
import os
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "tests" / "acceptance"))

import c3d_ezc3d  # noqa: E402
import ik_opensim  # noqa: E402

IK_CASES = ("gait2354", "gait2354_setup", "hamner", "rajagopal")
HEADINGS = ("case", "program", "frames", "runs", "frames/s", "kinemark faster", "cost, m^2", "kinemark's / its cost",
            "largest angle difference to kinemark")


def cells(result):
    first = [result["case"], result["program"], str(result["frames"]), str(result["runs"]), f"{result['frames_per_s']:,.0f}"]
    if "kinemark_speed_ratio" not in result:
        return [*first, "", f"{result['cost_m2']:.8f}", "", ""]
    return [*first, f"{result['kinemark_speed_ratio']:,.0f} x", f"{result['cost_m2']:.8f}",
            f"{result['kinemark_cost_ratio']:.7f}", f"{result['largest_angle_deg']:.2g} deg, {result['largest_angle_at']}"]


def print_table(headings, rows):
    widths = [max(len(row[i]) for row in [headings, *rows]) for i in range(len(headings))]
    for row in [headings, *rows]:
        print(" | ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())


def run_ik(name, program, data, scratch):
    """(results, rows of bounds) of one case."""
    results = ik_opensim.compare(program, ik_opensim.cases(data)[name], scratch)
    rows = [ik_opensim.cost_row(results)]
    if name.startswith("gait2354"):
        rows += [ik_opensim.speed_row(results), ik_opensim.converged_row(results)]
    return results, rows


def run_c3d(binaries, scratch):
    """Rows of bounds, from the acceptance check of the same numbers."""
    said = io.StringIO()
    with contextlib.redirect_stdout(said):
        c3d_ezc3d.compare_speed(c3d_ezc3d.Tool(binaries), scratch)
    found = [[cell.strip() for cell in line.split("|")] for line in said.getvalue().splitlines()]
    return [(verdict == "PASS", f"C3D: {check}", asked, measured) for verdict, check, asked, measured in found]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=ROOT / "build" / "release")
    parser.add_argument("--data", type=Path,
                        default=Path(os.environ.get("KINEMARK_TEST_DATA") or ROOT.parent / "shared" / "data"))
    parser.add_argument("--json", type=Path, help="also write every number to this file")
    parser.add_argument("cases", nargs="*", metavar="CASE")
    options = parser.parse_args()
    unknown = set(options.cases) - {*IK_CASES, "c3d"}
    if unknown:
        parser.error(f"no case {', '.join(sorted(unknown))}; there are: {', '.join(IK_CASES)}, c3d")
    chosen = options.cases or [*IK_CASES, "c3d"]
    binaries = options.build.resolve() / "bin"
    needed = [binaries / "kinemark"] * any(name in chosen for name in IK_CASES) + [binaries / "c3d_acceptance_tool"] * ("c3d" in chosen)
    for path in needed:
        if not path.is_file():
            parser.error(f"{path} is not there; `make release` builds it")

    results, bounds = [], []
    with tempfile.TemporaryDirectory(prefix="kinemark-bench-") as folder:
        scratch = Path(folder)
        for name in IK_CASES:
            if name not in chosen:
                continue
            if not options.data.is_dir():
                bounds.append((False, name, "runs", f"NOT TESTED: no recordings in {options.data}"))
                continue
            print(f"{name} ...", file=sys.stderr, flush=True)
            found, rows = run_ik(name, binaries / "kinemark", options.data, scratch)
            results += found
            bounds += rows
        if "c3d" in chosen:
            print("c3d ...", file=sys.stderr, flush=True)
            bounds += run_c3d(binaries, scratch)

    load = os.getloadavg()[0]
    print(f"Solve only, one thread, medians over runs; {os.cpu_count()} processors, load {load:.1f} at the end.\n")
    if results:
        print_table(HEADINGS, [cells(result) for result in results])
        print()
    print_table(("", "bound", "asked", "measured"), [("PASS" if row[0] else "FAIL", *row[1:]) for row in bounds])
    if options.json:
        named = [dict(zip(("passed", "check", "asked", "measured"), row)) for row in bounds]
        document = {"processors": os.cpu_count(), "load": load, "ik": results, "bounds": named}
        options.json.write_text(json.dumps(document, indent=1) + "\n", encoding="utf-8")
    return 0 if all(row[0] for row in bounds) else 1


if __name__ == "__main__":
    sys.exit(main())
