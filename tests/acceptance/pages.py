#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Pages in Debian's Chromium: how large, how fast, how readable, and whether every real recording opens.

    pages.py            sizes, looks and speed, with simulated data and pages that the program writes
    pages.py --real     a page of every real C3D and TRC file of KINEMARK_TEST_DATA, and of every MOT with a model, opened and judged

Needs `npm ci` in viewer/ once. Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import gzip
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from rows import exit_status, row

PROJECT = Path(__file__).resolve().parents[2]
VIEWER = PROJECT / "viewer"
PROGRAM = Path(os.environ.get("KINEMARK_PROGRAM", "build/release/bin/kinemark")).resolve()
DATA = Path(os.environ.get("KINEMARK_TEST_DATA") or PROJECT.parent / "shared" / "data")
BATCH = 8
# Coordinates of OpenSim and the model that they are of.
MOTIONS = (
    ("opensim-gait2354/subject01_walk1_ik.mot", "opensim-gait2354/subject01_simbody.osim"),
    ("opensim-hamner-fullbody/subject02_running_ik.mot", "opensim-hamner-fullbody/subject02_registered.osim"),
    ("opensim-arm26/arm26_InverseKinematics.mot", "opensim-arm26/arm26.osim"),
    ("opensim-core-ik/std_subject01_walk1_ik.mot", "opensim-core-ik/subject01_simbody.osim"),
    ("opensim-core-ik/std_subject1_abdbonepin_IK.mot", "opensim-core-ik/subject1_abdbonepin.osim"),
    ("bmc-rajagopal-run/IK/results/ik_output_run.mot", "bmc-rajagopal-run/Scale/Rajagopal2015_scaled.osim"),
)


def node(script, *files):
    """What a script of the viewer's tests prints, and its exit status."""
    ran = subprocess.run(
        ["npx", "vite-node", f"tests/browser/{script}", "--", *map(str, files)], cwd=VIEWER, capture_output=True, text=True, check=False
    )
    return ran.stdout, ran.returncode


def sizes(folder):
    bundle = (VIEWER / "dist" / "report.html").read_bytes()
    row(len(bundle) <= 900e3, "the bundle", "<= 900 kB", f"{len(bundle) / 1e3:.0f} kB")
    packed = len(gzip.compress(bundle, 9))
    row(packed <= 260e3, "the bundle, gzip", "<= 260 kB", f"{packed / 1e3:.0f} kB")
    example = PROGRAM.parent / "report_example"
    for kind in ("ik", "clean"):
        for frames, most_mb in ((2000, 1.5), (100_000, 3.0)):
            page = folder / f"{kind}_{frames}.html"
            subprocess.run([example, page, str(frames), kind], check=True, capture_output=True)
            mb = page.stat().st_size / 1e6
            row(mb <= most_mb, f"page of {kind}, {frames} frames", f"<= {most_mb} MB", f"{mb:.2f} MB")


def appearance():
    said, _ = node("looks_run.ts")
    lines = said.splitlines()
    for line in lines:
        if line.startswith(("ok ", "FAILED ")):
            row(line.startswith("ok "), f"{line.split()[-1]}: axe in light and dark, nothing clipped on paper and at 390 px", "nothing", line.split()[0])
    row(len([line for line in lines if line.startswith("ok ")]) >= 8, "pages of every kind were judged", ">= 8", str(len(lines)))


def live():
    said, _ = node("live_run.ts")
    lines = [line for line in said.splitlines() if line.startswith(("ok ", "FAILED "))]
    for line in lines:
        verdict, _, rest = line.partition(" ")
        row(verdict == "ok", f"live source: {rest.strip().split(':')[0]}", "as a person sees it", verdict if verdict == "ok" else rest[-300:])
    row(len(lines) == 8, "a live source was looked at", "8 checks", str(len(lines)))


def speed():
    said, _ = node("speed_run.ts")
    rows = [line for line in said.splitlines() if " | " in line]
    for line in rows:
        verdict, *rest = line.split(" | ")
        row(verdict == "PASS", *rest)
    row(len(rows) == 5, "speed was measured", "5 rows", str(len(rows)))


def joints_of_motions(folder):
    """Joints of the models where the coordinates put them, as recordings."""
    made = []
    for motion, model in MOTIONS:
        path = folder / f"{len(made)}_{Path(motion).stem}.bvh"
        ran = subprocess.run([PROGRAM, "convert", DATA / motion, path, "--model", DATA / model], capture_output=True, text=True, check=False)
        row(ran.returncode == 0, f"{motion} with its model", "joints", ran.stderr[-200:] or "joints")
        made += [path] if ran.returncode == 0 else []
    return made


def real(folder):
    """Every real recording: the program makes a page or refuses in a sentence; the page opens with markers to a pixel."""
    pages = []
    recordings = [path for path in sorted(DATA.rglob("*")) if path.suffix.lower() in (".c3d", ".trc")]
    for path in recordings + joints_of_motions(folder):
        page = folder / f"{len(pages)}_{path.stem}.html"
        ran = subprocess.run([PROGRAM, "report", path, "-o", page], capture_output=True, text=True, check=False)
        if ran.returncode == 0:
            pages.append(page)
        elif ran.returncode != 3 or len(ran.stderr.strip().splitlines()) != 1:
            row(False, f"{path.parent.name}/{path.name}", "a page, or one sentence with status 3", f"status {ran.returncode}: {ran.stderr[-200:]}")
    broken = []
    for first in range(0, len(pages), BATCH):
        batch = pages[first : first + BATCH]
        said, status = node("run.ts", *batch)
        lines = said.splitlines()
        among = f"(among {batch[0].stem} to {batch[-1].stem})"
        broken += [f"{line}: {why} {among}" for line, why in zip(lines, [*lines[1:], ""]) if line.startswith("FAILED")]
        if status != 0 and not said:
            broken.append(f"batch from {batch[0].name} did not run")
    row(pages != [] and not broken, f"{len(pages)} real recordings open, screen positions agree with projection", "< 1 px, no complaint", "; ".join(broken[:5]) or "all")


def main():
    with tempfile.TemporaryDirectory() as name:
        if "--real" in sys.argv:
            real(Path(name))
        else:
            sizes(Path(name))
            appearance()
            live()
            speed()
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
