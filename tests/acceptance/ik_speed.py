#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Inverse kinematics of gait2354 beside OpenSim: speed at equal or lower cost, and the same answer when both converge.

Needs Python with numpy and opensim. Finds the program in KINEMARK_PROGRAM and the recordings in KINEMARK_TEST_DATA;
prints rows "PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import os
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
sys.path.append(str(ROOT / "benchmarks"))

import ik_opensim  # noqa: E402


def main():
    data = Path(os.environ.get("KINEMARK_TEST_DATA") or ROOT.parent / "shared" / "data")
    program = os.environ.get("KINEMARK_PROGRAM", str(ROOT / "build" / "release" / "bin" / "kinemark"))
    if not data.is_dir():
        print("SKIP | IK speed beside OpenSim | - | NOT TESTED: set KINEMARK_TEST_DATA")
        return 0
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        folder = Path(scratch)
        whole = ik_opensim.compare(program, ik_opensim.cases(data)["gait2354"], folder)
        part = ik_opensim.compare(program, ik_opensim.cases(data)["gait2354_setup"], folder)
    rows = [ik_opensim.speed_row(whole), ik_opensim.converged_row(part), ik_opensim.converged_row(whole)]
    for passed, *texts in rows:
        print(" | ".join(["PASS" if passed else "FAIL", *texts]))
    return 0 if all(row[0] for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
