#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Pages and report files of every kind, from real files, against viewer/schema; and spoilt ones, which must be refused.

Needs `npm ci` in viewer/ once. Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import json
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from rows import exit_status, row

PROJECT = Path(__file__).resolve().parents[2]
VIEWER = PROJECT / "viewer"
PROGRAM = Path(os.environ.get("KINEMARK_PROGRAM", "build/release/bin/kinemark")).resolve()
DATA = Path(os.environ.get("KINEMARK_TEST_DATA") or PROJECT.parent / "shared" / "data")
GAIT, WALK, TAICHI = DATA / "opensim-gait2354", DATA / "btk-others" / "Gait.c3d", DATA / "motionmachine-taichi" / "taichi.v3d"
MODEL, MARKERS = GAIT / "subject01_simbody.osim", GAIT / "subject01_walk1.trc"
RIG = ("rig/grid_A.mcap", "rig/grid_B.mcap", "rig/tree_poses.mcap", "--nominal", "rig/rig_nominal.toml")
EXCHANGED = (3, 4, 8)  # which markers
LONG = 30_000  # frames of made-up trials whose points are not frames
# What several commands need.
FIRST = (
    ("simulate", "rig", "sign", "-o", "rig", "--duration", 0.5, "--grid", "--tree-poses", "--occlude", "hand:B:10-14"),
    ("simulate", "arm", "-o", "arm", "--segments", 150, "--segments", 160, "--segments", 140, "--stagger", 20, "--noise", 0.5, "--frames", 200),
    ("simulate", "subject", "-o", "long", "--duration", 120),
    ("simulate", "subject", "-o", "person", "--duration", 4, "--dropout-random", 0.1, "--dropout-sight", 0.1),
    ("gait", MARKERS, "--refits", 0, "--write-events", "marked.c3d", "-o", "marked.csv"),
)
# Commands by the type that their pages follow; each begins with an output of its own.
COMMANDS = {
    "IkPage": [
        ("ik", "-m", MODEL, "-t", "marked.c3d"),
        ("ik", "-m", MODEL, "-t", "spoilt.trc"),
        ("ik", "-m", "person/model.osim", "-t", "person/markers.c3d"),
        ("track", "-m", MODEL, "-t", MARKERS),
    ],
    "CleanPage": [("clean", MARKERS), ("clean", WALK), ("clean", "person/markers.c3d"), ("clean", "spoilt.trc"), ("clean", TAICHI, "--rate", 60)],
    "MarkersPage": [("report", MARKERS), ("report", WALK), ("report", "marked.c3d"), ("report", "long/markers.c3d"), ("report", TAICHI, "--rate", 60)],
    "JointsPage": [
        ("joints", WALK),
        ("joints", "arm/markers.c3d", "--segments", "arm/segments.toml"),
        ("joints", "arm/markers.c3d", "--segments", "arm/segments.toml", "--kind", "hinge"),
        ("joints", "arm/markers.c3d"),
        ("joints", "arm/markers.c3d", "--segments", "arm/segments.toml", "--soft-tissue"),
        ("joints", "person/markers.c3d"),
    ],
    "ScalePage": [
        ("scale", "-m", GAIT / "gait2354_simbody.osim", "--setup", GAIT / "subject01_Setup_Scale.xml"),
        ("scale", "-m", MODEL, "--static", GAIT / "subject01_static.trc", "-t", MARKERS, "--max-frames", 30),
    ],
    "MeasuresPage": [("measure", MARKERS, "--refits", 0, "--region", "start=1-40"), ("measure", WALK, "--refits", 39, "--measures", "path_length"), ("emg", WALK, "--refits", 0), ("gait", WALK, "--refits", 0)],
    "CalibratePage": [("calibrate", *RIG, "--warp-degree", 4, "--no-crosstalk"), ("calibrate", *RIG, "--method", "grid-lut")],
    "ReconstructPage": [("reconstruct", "rig/recording.mcap", "--rig", "rig/rig_true.toml", "--method", how) for how in ("smoother", "frames")],
    "StudyPage": [("study", "poizner", "--seeds", 1)],
}
OUTPUTS = {"ik": ".mot", "track": ".mot", "clean": ".csv", "joints": "", "scale": ".osim", "measure": ".json", "emg": ".json", "gait": ".json", "calibrate": ".toml", "reconstruct": ".csv"}
REPORTS = {"IkSummary": 4, "CleanSummary": 5, "JointsResult": 6, "ScaleResult": 2}
# What is done to a page, and what must be said of it.
SPOILT = (
    ("a member too many", lambda data: data["summary"].update(more=1), "must NOT have additional properties (more)"),
    ("a member missing", lambda data: data["summary"].pop("version"), "must have required property 'version'"),
    ("a number as text", lambda data: data["summary"].update(rate_hz="60 Hz"), "/summary/rate_hz: must be number"),
    ("a unit that pages do not have", lambda data: data["summary"]["coordinates"][0].update(unit="rad"), "/coordinates/0/unit: must be equal to one of the allowed values"),
    ("a packing of earlier versions", lambda data: data["series"].update(rms_error_mm="AACAPw=="), "/series/rms_error_mm: must be object"),
)


def program(folder, *words):
    return subprocess.run([PROGRAM, *map(str, words)], cwd=folder, capture_output=True, text=True, check=False)


def held_against_schema(files):
    """Lines of the check, each with what is wrong below it."""
    ran = subprocess.run(["npm", "run", "--silent", "check:pages", "--", *map(str, files)], cwd=VIEWER, capture_output=True, text=True, check=False)
    return re.findall(r"^(ok|FAILED) +(\w+|\?) (.*)((?:\n {8}.*)*)", ran.stdout, re.MULTILINE), ran.stderr


def spoilt_markers(path):
    """The walk with the labels of two markers exchanged for 20 frames, and a third 0.3 m off in one."""
    lines = MARKERS.read_text(encoding="utf-8").splitlines()
    first = next(n for n, line in enumerate(lines) if line.startswith("1\t"))
    for n in range(first + 60, first + 81):
        cells = lines[n].split("\t")
        a, b, c = (slice(2 + 3 * m, 5 + 3 * m) for m in EXCHANGED)
        cells[a], cells[b] = cells[b], cells[a]
        if n == first + 70:
            cells[c] = [str(float(cell) + 300) for cell in cells[c]]
        lines[n] = "\t".join(cells)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def write(folder):
    """Pages of every kind by type; a row for a command that writes none."""
    pages = {}
    spoilt_markers(folder / "spoilt.trc")
    for words in FIRST:
        ran = program(folder, *words)
        if ran.returncode:
            row(False, " ".join(map(str, words[:2])), "status 0", ran.stderr[-200:])
    for kind, commands in COMMANDS.items():
        for number, (command, *rest) in enumerate(commands):
            page = folder / f"{kind}_{number}.html"
            output = ["-o", f"{kind}_{number}{OUTPUTS[command]}"] if command in OUTPUTS and command != "clean" else []
            rest = [rest[0], f"{kind}_{number}.csv", *rest[1:]] if command == "clean" else rest
            option = {"report": "-o", "study": "--figures"}.get(command, "--report")
            ran = program(folder, command, *rest, *output, option, page)
            if page.is_file():
                pages[page] = kind
            else:
                row(False, f"{command} {' '.join(map(str, rest[:1]))}", "a page", f"status {ran.returncode}: {ran.stderr[-200:]}")
    for kind in ("ik", "clean"):
        page = folder / f"{kind}_of_{LONG}_frames.html"
        subprocess.run([PROGRAM.parent / "report_example", page, str(LONG), kind], check=True, capture_output=True)
        pages[page] = f"{kind.capitalize()}Page"
    return pages


def judge(pages, folder):
    reports = sorted(path for path in folder.rglob("*.json") if path.name == "skeleton.json" or path.name.endswith("_report.json"))
    lines, complaint = held_against_schema([*pages, *reports])
    for kind, commands in COMMANDS.items():
        mine = [line for line in lines if line[1] == kind]
        bad = [path + problems for verdict, _, path, problems in mine if verdict != "ok"]
        wanted = [path for path, of in pages.items() if of == kind]
        good = not bad and {Path(path) for _, _, path, _ in mine} == set(wanted) and len(wanted) >= len(commands)
        row(good, f"{kind}: {len(wanted)} pages against the schema", "nothing wrong", "; ".join(bad)[:400] or f"{len(mine)} follow it{complaint[-200:]}")
    for kind, count in REPORTS.items():
        mine = [line for line in lines if line[1] == kind]
        bad = [path + problems for verdict, _, path, problems in mine if verdict != "ok"]
        row(not bad and len(mine) == count, f"{kind}: {count} report files against the schema", "nothing wrong", "; ".join(bad)[:400] or f"{len(mine)} follow it")


def spoil(page, folder):
    text = page.read_text(encoding="utf-8")
    found = re.search(r'id="kinemark-data">(.*?)</script>', text, re.DOTALL)
    for number, (name, change, sentence) in enumerate(SPOILT):
        data = json.loads(found[1])
        change(data)
        spoilt = folder / f"spoilt_{number}.html"
        spoilt.write_text(text[: found.start(1)] + json.dumps(data).replace("<", "\\u003c") + text[found.end(1) :], encoding="utf-8")
        lines, _ = held_against_schema([spoilt])
        row(len(lines) == 1 and lines[0][0] == "FAILED" and sentence in lines[0][3], f"a page with {name}", sentence, lines[0][3].strip()[:200] if lines else "nothing")


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        pages = write(folder)
        judge(pages, folder)
        spoil(folder / "IkPage_0.html", folder)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
