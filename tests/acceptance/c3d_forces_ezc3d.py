#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Force plates of real C3D files, types 2, 3 and 4, against ezc3d, an unrelated reader.

Needs Python with numpy and ezc3d, and the program c3d_acceptance_tool beside KINEMARK_PROGRAM; recordings in
KINEMARK_TEST_DATA. Prints rows "PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

import ezc3d
import numpy as np

ROOT = Path(__file__).resolve().parent.parent.parent
TOOL = Path(os.environ.get("KINEMARK_PROGRAM", ROOT / "build/release/bin/kinemark")).parent / "c3d_acceptance_tool"
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared/data"))
MOST = 1e-6  # beyond what the corners themselves leave open
CHECK = "force plates of real C3D files: force and moment about the middle of the plate, beside ezc3d"
FILES = ("c3d-org/sample01/Eb015pr.c3d", "c3d-org/sample10/TYPE-2.C3D", "c3d-org/sample10/TYPE-4.C3D",
         "pycgm-rom/Sample_Static.c3d", "opensim-core-formats/walking2.c3d", "btk-others/PiG_Motion3_FF.c3d",
         "btk-others/ADemo1_rewrite_c3d_pc_float.c3d", "btk-others/FunctionalWalk.c3d", "btk-others/Gait.c3d",
         "biobuddy/right_knee.c3d", "ezc3d-testFiles/Qualisys.c3d")


def frame_means(values, per_frame):
    """3 x samples -> 3 x frames: the mean from half a frame before to half a frame after each frame."""
    samples = values.shape[1]
    means = np.empty((3, samples // per_frame))
    for frame in range(means.shape[1]):
        at = frame * per_frame
        half = min(per_frame // 2, at, samples - 1 - at)
        weights = np.ones(2 * half + 1)
        if per_frame % 2 == 0 and half > 0:
            weights[[0, -1]] = 0.5
        means[:, frame] = values[:, at - half:at + half + 1] @ weights / weights.sum()
    return means


def compare(name):
    """(largest difference of force, of moment, each over the largest; plates) of one file.

    Corners of real plates are no exact rectangle. Ours follows the mean of opposite edges, ezc3d one corner: that far
    the axes are the reader's choice, and the angle is taken off.
    """
    path = DATA / name
    ours = json.loads(subprocess.run([TOOL, "forces", path], capture_output=True, check=True).stdout)
    c3d = ezc3d.c3d(str(path), extract_forceplat_data=True)
    per_frame = round(c3d["header"]["analogs"]["frame_rate"] / c3d["header"]["points"]["frame_rate"])
    worst = [0.0, 0.0]
    for number, plate in enumerate(c3d["data"]["platform"], 1):
        mine = {k: np.array([np.nan if v is None else v for v in values]).reshape(-1, 3).T
                for k, values in ours[f"plate {number}"].items()}
        unit = 1e-3 if plate["unit_moment"] == "Nmm" else 1.0
        length = 1e-3 if plate["unit_position"] == "mm" else 1.0
        corners = length * np.asarray(plate["corners"])
        centre = corners.mean(axis=1)
        open_angle = (np.linalg.norm(corners @ (1.0, -1.0, 1.0, -1.0))
                      / np.linalg.norm(corners[:, 0] - corners[:, 1]))
        force = frame_means(plate["force"], per_frame)
        moment = unit * frame_means(plate["moment"], per_frame)
        my_moment = mine["moment"] + np.cross((mine["point"].T - centre), mine["force"].T).T
        for i, (a, b) in enumerate(((mine["force"], force), (my_moment, moment))):
            worst[i] = max(worst[i], np.abs(a - b).max() / np.abs(b).max() - open_angle)
    return worst[0], worst[1], len(c3d["data"]["platform"])


def main():
    if not DATA.is_dir():
        print(f"SKIP | {CHECK} | at most {MOST:.0e} | no recordings")
        return 0
    found = {name: compare(name) for name in FILES}
    worst = max(found, key=lambda name: max(found[name][:2]))
    force, moment, _ = found[worst]
    plates = sum(n for _, _, n in found.values())
    good = max(force, moment) <= MOST
    print(f"{'PASS' if good else 'FAIL'} | {CHECK} | difference at most {MOST:.0e} of the largest | {force:.1e} of force, "
          f"{moment:.1e} of moment ({worst}), {plates} plates of {len(FILES)} files")
    if not good:
        for name, (f, m, n) in found.items():
            print(f"  {name}: {n} plates, force {f:.2e}, moment {m:.2e}", file=sys.stderr)
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
