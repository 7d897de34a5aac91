#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Measures of many recordings: each line that of the recording's own run, byte for byte, for any number of threads and recordings
at a time; a broken file among them; and the table through groups as it is.

    analyze_many.py [SEED]

Six simulated participants in two sessions go around a circle, each in a folder of BIDS. Needs KINEMARK_PROGRAM. Prints rows
"PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import csv
import json
import math
import random
import sys
import tempfile
from pathlib import Path

from rows import exit_status, row, run

SEED = int(sys.argv[1]) if len(sys.argv) > 1 else 920001
FRAMES, RATE = 400, 100.0
OPTIONS = ("--measures", "peak_speed,cycle_time,cycle_duration", "--refits", "39")


def said(made):
    """The exit status, and what a failure says last."""
    return f"{made.returncode}" if made.returncode == 0 else f"{made.returncode}: {(made.stderr.strip().splitlines() or [''])[-1]}"


def write_circle(path, draw, radius_mm, turn_s):
    """A marker that goes around a circle, with noise of half a millimetre, as TRC."""
    lines = [f"PathFileType\t4\t(X/Y/Z)\t{path.name}", "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
             f"{RATE:g}\t{RATE:g}\t{FRAMES}\t1\tmm\t{RATE:g}\t1\t{FRAMES}", "Frame#\tTime\tRFIN\t\t", "\t\tX1\tY1\tZ1", ""]
    for i in range(FRAMES):
        angle = 2 * math.pi * i / RATE / turn_s
        point = (radius_mm * math.cos(angle), radius_mm * math.sin(angle), 900.0)
        lines.append(f"{i + 1}\t{i / RATE:.5f}\t" + "\t".join(f"{c + draw.gauss(0, 0.5):.5f}" for c in point))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def make_set(top):
    draw = random.Random(SEED)
    for who in range(1, 7):
        own_radius, own_turn = draw.uniform(150, 250), draw.uniform(0.7, 1.2)
        for when in (1, 2):
            folder = top / f"sub-{who:02}" / f"ses-{when}"
            folder.mkdir(parents=True)
            write_circle(folder / f"sub-{who:02}_ses-{when}_task-circle.trc", draw, own_radius * draw.uniform(0.97, 1.03), own_turn * draw.uniform(0.97, 1.03))
    groups = "".join(f"sub-{who:02}\t{20 + who}\t{'old' if who > 3 else 'young'}\n" for who in range(1, 7))
    (top / "participants.tsv").write_text("participant_id\tage\tgroup\n" + groups, encoding="utf-8")
    return sorted(top.rglob("*.trc"))


def lines(path):
    return path.read_text(encoding="utf-8").splitlines(keepends=True)


def compare(folder, top, files):
    """All at once and one by one."""
    outputs = {"-o": "measures", "--write-events": "events", "--write-cycles": "cycles"}
    tables = [part for option, name in outputs.items() for part in (option, folder / f"{name}.csv")]
    made = run("analyze", top, *OPTIONS, *tables, "--jobs", "2", "--threads", "2")
    row(made.returncode == 0, "a folder of 12 recordings", "exit status 0", said(made))
    ones = {option: [] for option in outputs}
    for path in files:
        for option in outputs:
            single = folder / "single.csv"
            run("analyze", path, *OPTIONS, "--participants", top / "participants.tsv", option, single, "--force", "--threads", "1")
            ones[option] += lines(single)[1:]
    for option, name in outputs.items():
        together = lines(folder / f"{name}.csv")[1:]
        same = sum(a == b for a, b in zip(together, ones[option]))
        row(len(together) > 0 and together == ones[option], f"{name}: lines as in single runs", f"all of {len(ones[option])}", f"{same} of {len(together)}")
    again = run("analyze", top, *OPTIONS, *tables, "--jobs", "1", "--threads", "1", "--force")
    row(again.returncode == 0 and lines(folder / "measures.csv")[1:] == ones["-o"], "one recording at a time", "the same bytes", "the same" if again.returncode == 0 else said(again))


def judge_bad_file(folder, top):
    broken = top / "sub-03" / "ses-1" / "broken.trc"
    broken.write_text("PathFileType\t4\nnothing\n", encoding="utf-8")
    made = run("analyze", top, *OPTIONS, "-o", folder / "rest.json")
    broken.unlink()
    sentences = [line for line in made.stderr.splitlines() if "broken.trc" in line]
    found = json.loads((folder / "rest.json").read_text(encoding="utf-8"))
    row(made.returncode == 3 and len(sentences) == 1 and len(found["recordings"]) == 12 and len(found["failed"]) == 1, "a broken file among them",
        "exit status 3, one sentence, the others measured", f"{made.returncode}, {len(sentences)}, {len(found['recordings'])} measured")


def judge_groups(folder):
    of = ("--where", "curve=speed", "--where", "context=cycle")
    for name, arguments, status in (
        ("retest", ("retest", folder / "measures.csv"), 0),
        ("band", ("band", folder / "cycles.csv", "--subject", "participant", "--group", "group", *of), 0),
        ("spm", ("spm", folder / "cycles.csv", "--subject", "participant", "--group", "group", *of), 0),
    ):
        made = run("groups", *arguments, "--json")
        row(made.returncode == status and bool(made.stdout), f"groups {name} of the tables as they are", "exit status 0", said(made))
        if name == "retest" and made.returncode == 0:
            tested = json.loads(made.stdout)["measures"]
            names = {one["measure"] for one in tested}
            row({"peak_speed RFIN", "cycle_time RFIN"} <= names, "groups retest: each measure of each marker", "peak_speed, cycle_time of RFIN", ", ".join(sorted(names)))


def main():
    with tempfile.TemporaryDirectory(prefix="kinemark-analyze-") as scratch:
        folder, top = Path(scratch), Path(scratch) / "set"
        top.mkdir()
        files = make_set(top)
        compare(folder, top, files)
        with (folder / "measures.csv").open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        who = {(r["participant"], r["session"], r["trial"], r["group"]) for r in rows}
        row(len(who) == 12 and ("sub-05", "ses-2", "task-circle", "old") in who, "participant, session, trial and group of each row", "12 combinations", f"{len(who)}")
        judge_bad_file(folder, top)
        judge_groups(folder)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
