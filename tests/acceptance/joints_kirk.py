#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""The macaque report's method (`--method constant-distance`) beside an independent implementation on the same data.

The other is `reference/joints/kirk.py` of the shared folder (KINEMARK_REFERENCE, default ../shared/reference): it makes the arm, noise
and gaps are added here, both find the elbow, and errors are compared over the frames that both answer. Needs numpy and scipy.
"""

import csv
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("KINEMARK_PROGRAM", str(ROOT / "build" / "release" / "bin" / "kinemark"))
REFERENCE = Path(os.environ.get("KINEMARK_REFERENCE", ROOT.parent / "shared" / "reference")) / "joints"
FRAMES, SEEDS, BOUND = 200, 3, 0.20
SEGMENTS = '[[segment]]\nname = "upper"\nmarkers = ["m0", "m1", "m2"]\n[[segment]]\nname = "fore"\nmarkers = ["m3", "m4", "m5"]\n'


def write_markers(path, positions_mm, visible):
    with open(path, "w", encoding="utf-8", newline="") as file:
        rows = csv.writer(file)
        rows.writerow(["frame", "time_s", "marker", "x_m", "y_m", "z_m", "state"])
        for f, (frame, seen) in enumerate(zip(positions_mm, visible)):
            for m in range(len(seen)):
                x = [repr(float(v)) for v in frame[m] / 1e3] if seen[m] else ["", "", ""]
                rows.writerow([f, repr(f / 60), f"m{m}", *x, "measured" if seen[m] else "missing"])


def ours(folder, positions_mm, visible):
    """Our elbow in every frame, mm; NaN where there is none."""
    write_markers(folder / "arm.csv", positions_mm, visible)
    (folder / "segments.toml").write_text(SEGMENTS, encoding="utf-8")
    subprocess.run(
        [PROGRAM, "joints", "arm.csv", "--segments", "segments.toml", "--method", "constant-distance", "--keep-upsampled",
         "--doubtful", "keep", "-o", "elbow.csv", "--force", "--quiet"],
        cwd=folder, check=True,
    )
    elbow = np.full((len(positions_mm), 3), np.nan)
    with open(folder / "elbow.csv", encoding="utf-8", newline="") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            if row["x_m"]:
                elbow[int(row["frame"])] = [1e3 * float(row[k]) for k in ("x_m", "y_m", "z_m")]
    return elbow


def main():
    if not (REFERENCE / "kirk.py").is_file():
        print(f"SKIP | the report's method beside an independent implementation | within 20 % | NOT TESTED: {REFERENCE}/kirk.py is "
              "not there; set KINEMARK_REFERENCE")
        return 0
    sys.argv = [sys.argv[0], "0"]
    sys.path.insert(0, str(REFERENCE))
    import kirk  # pylint: disable=import-error,import-outside-toplevel

    failed = False
    with tempfile.TemporaryDirectory(prefix="kinemark-kirk-") as scratch:
        for stagger in (0, 20):
            for noise, missing in ((0.5, 0.0), (1.0, 0.2), (2.0, 0.0), (2.0, 0.2)):
                squares = np.zeros((2,))
                medians = []
                frames = 0
                for seed in range(SEEDS):
                    kirk.rng = np.random.default_rng(100 + seed)
                    elbow, _, markers = kirk.sim(FRAMES, stagger)
                    noisy = markers + kirk.rng.normal(scale=noise, size=markers.shape)
                    visible = kirk.rng.random(markers.shape[:2]) >= missing
                    theirs, _, _, _ = kirk.baseline(noisy, visible)
                    mine = ours(Path(scratch), noisy, visible)
                    both = ~np.isnan(theirs).any(1) & ~np.isnan(mine).any(1)
                    errors = np.stack([np.linalg.norm(e[both] - elbow[both], axis=1) for e in (mine, theirs)])
                    squares += (errors**2).sum(1)
                    medians.append(np.median(errors, axis=1))
                    frames += both.sum()
                rms = np.sqrt(squares / frames)
                median = np.mean(medians, axis=0)
                good = abs(rms[0] / rms[1] - 1) <= BOUND
                failed |= not good
                print(f"{'PASS' if good else 'FAIL'} | the report's method beside kirk.py, stagger {stagger} mm, noise {noise} mm, "
                      f"{missing:.0%} missing | RMS within 20 % | ours {rms[0]:.2f}, theirs {rms[1]:.2f} mm over {frames} frames "
                      f"(medians {median[0]:.2f}, {median[1]:.2f})")
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
