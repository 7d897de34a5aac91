#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Points that are not markers, in real C3D files, against ezc3d, an unrelated reader.

    channels.py

Needs Python with numpy and ezc3d, KINEMARK_PROGRAM and KINEMARK_TEST_DATA. Prints rows "PASS|FAIL | check | asked |
measured"; exit status 1 when one fails.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import ezc3d
import numpy as np

from rows import exit_status, row

KINDS = {"ANGLES": "angle", "FORCES": "force", "MOMENTS": "moment", "POWERS": "power", "SCALARS": "scalar",
         "MODELED_MARKERS": "modeled marker"}


def kinemark(*arguments):
    program = os.environ.get("KINEMARK_PROGRAM", "build/release/bin/kinemark")
    return subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, timeout=300)


def listed(c3d):
    """Kind and unit of each label that a group names, as ezc3d reads the groups."""
    point = c3d["parameters"]["POINT"]
    kinds = {}
    for group, kind in KINDS.items():
        units = point.get(group[:-1] + "_UNITS", {}).get("value", [""])
        for label in point.get(group, {}).get("value", []):
            kinds[label] = (kind, units[0] if units else "")
    return kinds


def values(c3d):
    """Point values of each label, the bits of a float each."""
    points = c3d["data"]["points"].astype(np.float32)
    labels = c3d["parameters"]["POINT"]["LABELS"]["value"]
    return {label: points[:3, i, :] for i, label in enumerate(labels[:points.shape[1]])}


def compare(name, path, folder):
    theirs = ezc3d.c3d(str(path))
    kinds = {label: kind for label, kind in listed(theirs).items() if label in values(theirs)}
    info = json.loads(kinemark("info", path, "--json").stdout)
    ours = {channel["name"]: (channel["kind"], channel["unit"]) for channel in info["channels"]}
    row(ours == kinds, f"{name}: kind and unit of each channel", f"{len(kinds)} as the groups say",
        f"{sum(ours.get(label) == kind for label, kind in kinds.items())} of {len(ours)}")
    row(not set(info["labels"]) & set(kinds), f"{name}: labels", "markers only", f"{len(set(info['labels']) & set(kinds))} others")

    copy = folder / f"{name}.c3d"
    kinemark("convert", path, copy)
    before, after = values(theirs), values(ezc3d.c3d(str(copy)))
    same = sum(label in after and before[label].tobytes() == after[label].tobytes() for label in kinds)
    row(same == len(kinds), f"{name}: bits of the channels in a copy", f"{len(kinds)} the same", f"{same}")

    lost = kinemark("convert", path, folder / f"{name}.trc", "--json").stdout
    said = f"{len(kinds)} channels that are no markers" in lost
    row(said == bool(kinds), f"{name}: channels that a TRC loses", "said" if kinds else "none", "said" if said else "none said")

    cleaned = kinemark("clean", path, folder / f"{name}_clean.c3d", "--json")
    words = cleaned.stdout + cleaned.stderr
    mentioned = [label for label in kinds if f'"{label}"' in words or f"'{label}'" in words]
    row(cleaned.returncode in (0, 1) and not mentioned, f"{name}: clean", "mentions no channel",
        f"status {cleaned.returncode}, {len(mentioned)} mentioned")
    cleaned_copy = values(ezc3d.c3d(str(folder / f"{name}_clean.c3d"))) if cleaned.returncode in (0, 1) else {}
    same = sum(label in cleaned_copy and before[label].tobytes() == cleaned_copy[label].tobytes() for label in kinds)
    row(same == len(kinds), f"{name}: bits of the channels after clean", f"{len(kinds)} the same", f"{same}")


def main():
    data = Path(os.environ.get("KINEMARK_TEST_DATA", "../shared/data"))
    files = {"PiG_Motion3_FF": "btk-others", "PiG_Calibration3_FF": "btk-others", "FunctionalWalk": "btk-others",
             "Sample_Static": "pycgm-rom", "Eb015pr": "c3d-org/sample01"}
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        for name, folder in files.items():
            compare(name, data / folder / f"{name}.c3d", Path(scratch))
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
