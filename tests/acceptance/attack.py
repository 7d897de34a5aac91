#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Nothing is found by tests/attack: one row for each kind of attack, "PASS|FAIL | check | asked | measured".

    attack.py [--sanitized PROGRAM] [options of tools/attack]

Without --sanitized, KINEMARK_PROGRAM is attacked. Findings are shown as they are found.
"""

import os
import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent


def main(arguments):
    program = Path(os.environ.get("KINEMARK_PROGRAM", ROOT / "build" / "release" / "bin" / "kinemark"))
    if arguments[:1] == ["--sanitized"]:
        program, arguments = ROOT / arguments[1], ["--sanitized", *arguments[2:]]
    if not program.is_file():
        print(f"FAIL | attack | a program | {program} is not built")
        return 1
    ran = subprocess.run(
        [ROOT / "tools" / "attack", "--program", program, *arguments], stdout=subprocess.PIPE, text=True, check=False
    )
    failed = ran.returncode not in (0, 1)
    for line in ran.stdout.splitlines():
        kind = re.fullmatch(r"attack: (\w+): (\d+) trials, (\d+) findings(.*)", line)
        if kind is None:
            print(line, flush=True)
            continue
        name, trials, findings = kind.group(1), int(kind.group(2)), int(kind.group(3))
        passed = trials > 0 and findings == 0
        failed = failed or not passed
        print(f"{'PASS' if passed else 'FAIL'} | {name.replace('_', ' ')}: findings | 0 | {findings} of {trials}{kind.group(4)}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
