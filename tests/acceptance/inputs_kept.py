#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Every command that writes x every file that it writes x every file that it opens: by name, as a link, as a second name, with --force.

Prints rows "PASS|FAIL | check | asked | measured"."""

import os
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA") or ROOT.parent / "shared" / "data")
MUSCLES = DATA / "btk-others" / "PiG_Motion3_FF.c3d"
sys.path.insert(0, str(ROOT / "tests" / "cli"))

from pairs_kept import Bench


def pairs(bench, name):
    """(pairs that were tried, sentences on what was wrong) of a command."""
    read, written, wrong = bench.learn(name)
    tried = 0
    for path in written:
        for one in read:
            for kind in ("symlink", "hard link"):
                wrong += bench.try_link(name, path, one, kind)
                tried += 1
    for word in bench.named_outputs(name):
        for one in read:
            wrong += bench.try_name(name, word, one)
            tried += 1
    return tried, wrong


def main():
    failed = False
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        bench = Bench(scratch, MUSCLES if MUSCLES.is_file() else None)
        if not MUSCLES.is_file():
            print(f"SKIP | emg | | NO REAL DATA: {MUSCLES} is not there; set KINEMARK_TEST_DATA")
        total = changed = 0
        for name in bench.commands:
            tried, wrong = pairs(bench, name)
            total += tried
            changed += sum("was changed" in sentence for sentence in wrong)
            failed = failed or bool(wrong)
            for sentence in wrong[:5]:
                print(sentence)
            print(f"{'FAIL' if wrong else 'PASS'} | {name}: an output that is an input is refused, exit status 2, one sentence | "
                  f"all of {tried} pairs | {tried - len(wrong)}")  # fmt: skip
        print(f"{'FAIL' if changed else 'PASS'} | inputs whose bytes changed, over {len(bench.commands)} commands and {total} pairs | 0 | {changed}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
