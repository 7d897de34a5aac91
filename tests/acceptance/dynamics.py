#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""The body tree against MuJoCo, finite differences and the power balance: the unit tests, with what they measured."""

import os
import re
import subprocess
import sys
from pathlib import Path

BINARIES = Path(os.environ.get("KINEMARK_PROGRAM", "build/release/bin/kinemark")).parent
SCRATCH = Path(os.environ.get("KINEMARK_SCRATCH", "/tmp"))
ROWS = (
    ("test_model_mujoco", "Judge.*", "dynamics against MuJoCo on human.osim's tree", 1e-5),
    ("test_motion_dynamics_mujoco", "InverseDynamicsJudge.*", "torques of a motion against MuJoCo's inverse dynamics", 1e-5),
    ("test_model", "*MarkerJacobianIsTheSlope*:*JdotVIsTheAcceleration*", "Jacobian and Jdot v against finite differences", 1e-7),
    ("test_model", "*ForcesGiveThePower*", "power balance of M, b and g", 1e-8),
)


def measure(program, tests):
    """Largest value that the tests recorded, and how many there were; None when one failed."""
    report = SCRATCH / "dynamics.xml"
    report.unlink(missing_ok=True)
    done = subprocess.run([BINARIES / program, f"--gtest_filter={tests}", f"--gtest_output=xml:{report}"],
                          stdout=subprocess.DEVNULL, check=False)
    found = re.findall(r'name="measured" value="([^"]+)"|measured="([^"]+)"', report.read_text()) if report.is_file() else []
    values = [float(a or b) for a, b in found]
    return (max(values), len(values)) if done.returncode == 0 and values else (None, len(values))


def main():
    failed = False
    for program, tests, check, bound in ROWS:
        worst, count = measure(program, tests)
        good = worst is not None and worst < bound
        failed = failed or not good
        measured = f"{worst:.1e}, {count} tests" if worst is not None else "a test failed or is missing"
        print(f"{'PASS' if good else 'FAIL'} | {check} | {bound:.0e} relative | {measured}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
