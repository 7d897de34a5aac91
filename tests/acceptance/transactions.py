#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""All that a command writes is there, or nothing of it, whatever comes between: tests/cli/transactions.py over every command that writes.

    transactions.py full_disk LEVELS      the disk full at so many sizes of files
    transactions.py kills                 killed before each name that a file gets, and after the last

Prints rows "PASS|FAIL | check | asked | measured".
"""

import os
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "cli"))

from transactions import Transactions, can_trace


def row(wrong, check, runs):
    for sentence in wrong[:10]:
        print(sentence)
    print(f"{'FAIL' if wrong else 'PASS'} | {check}: all or nothing, inputs kept, nothing hidden left | {runs} of {runs} | {len(wrong)} findings in {runs}", flush=True)
    return not wrong


def main():
    kind = sys.argv[1]
    if kind == "kills" and not can_trace():
        print("FAIL | kills | a program that strace may watch | none")
        return 1
    passed = True
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        bench = Transactions(scratch)
        for name in bench.names():
            if kind == "kills":
                wrong, runs = bench.killed(name)
                passed = row(wrong, f"{name}, killed {runs} times between two names", runs) and passed
            else:
                wrong, runs = bench.on_full_disks(name, int(sys.argv[2]))
                passed = row(wrong, f"{name}, {runs} times on a full disk", runs) and passed
    return 0 if passed else 1


if __name__ == "__main__":
    sys.exit(main())
