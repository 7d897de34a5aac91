# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""What the scripts of this folder share: the program that is checked, and rows of the table.

    from rows import exit_status, row, run

    row(run("info", path).returncode == 0, "a recording is read", "exit status 0", "...")
    sys.exit(exit_status())
"""

import os
import subprocess
from pathlib import Path

PROGRAM = os.environ.get("KINEMARK_PROGRAM", str(Path(__file__).resolve().parent.parent.parent / "build/release/bin/kinemark"))
SECONDS = 3000  # no command of the table takes as long
FAILED = []  # what the rows that failed are about


def run(*words, folder=None, good=None):
    """A command of the program, ended, with what it printed as text; SystemExit with its error unless its status is
    one of `good`, where these are given."""
    done = subprocess.run([PROGRAM, *map(str, words)], cwd=folder, capture_output=True, text=True, timeout=SECONDS, check=False)
    if good is not None and done.returncode not in good:
        raise SystemExit(f"kinemark {' '.join(map(str, words))}: {done.stderr}")
    return done


def output(*words, folder=None, good=(0, 1)):
    """What a command prints."""
    return run(*words, folder=folder, good=good).stdout


def row(passed, check, asked, measured):
    """Print one row of the table; return whether it passed."""
    if not passed:
        FAILED.append(check)
    print(f"{'PASS' if passed else 'FAIL'} | {check} | {asked} | {measured}", flush=True)
    return bool(passed)


def exit_status():
    """The exit status of the script: 1 where a row failed."""
    return 1 if FAILED else 0
