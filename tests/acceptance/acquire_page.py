#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Trials of a simulated rig recorded from the page of `kinemark serve sim:rig` in Debian's Chromium: kept by keys alone, ended by its time,
discarded, a rate refused, the connection lost; every step readable.

Needs `npm ci` in viewer/ once. Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import os
import subprocess
import sys
from pathlib import Path

from rows import PROGRAM, exit_status, row

VIEWER = Path(__file__).resolve().parents[2] / "viewer"


def main():
    ran = subprocess.run(
        ["npx", "vite-node", "tests/browser/desk_run.ts"],
        cwd=VIEWER,
        env={**os.environ, "KINEMARK_PROGRAM": str(Path(PROGRAM).resolve())},
        capture_output=True,
        text=True,
        check=False,
    )
    lines = [line for line in ran.stdout.splitlines() if line.startswith(("ok ", "FAILED "))]
    for line in lines:
        verdict, _, rest = line.partition(" ")
        row(verdict == "ok", f"acquisition page: {rest.strip().split(':')[0]}", "as a person does it", verdict if verdict == "ok" else rest[-300:])
    row(len(lines) == 7, "the page was gone through", "7 checks", f"{len(lines)} {ran.stderr[-200:]}".strip())


main()
sys.exit(exit_status())
