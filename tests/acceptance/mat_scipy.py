#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""MAT files against scipy.io: what kinemark convert writes of real recordings, read by loadmat beside ezc3d's reading of the
recording; and files as Qualisys Track Manager exports them, written by savemat, read by kinemark.

Needs Python with scipy and ezc3d. Finds the program in KINEMARK_PROGRAM and the recordings in KINEMARK_TEST_DATA; prints
rows "PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import ezc3d
import numpy
import scipy.io

from rows import PROGRAM, row

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared/data"))
MOST = 5  # recordings


def convert(source, target):
    return subprocess.run([PROGRAM, "convert", "--force", "--quiet", source, target], capture_output=True, text=True, check=False)


def recordings():
    """The largest C3D files with analog channels, events or outputs that are no markers, and some more."""
    found = sorted(DATA.rglob("*.c3d"), key=lambda path: (-path.stat().st_size, path.name))
    return [path for path in found if path.stat().st_size < 20_000_000]


def load(path):
    return scipy.io.loadmat(path, simplify_cells=True)["trial"]


def texts(value):
    return [str(v) for v in numpy.atleast_1d(value)]


def compare(path, trial):
    """What differs from ezc3d's reading of the recording, in words; empty when nothing does."""
    theirs = ezc3d.c3d(str(path))
    points, labels = theirs["data"]["points"], theirs["parameters"]["POINT"]["LABELS"]["value"]
    unit = {"m": 1.0, "mm": 1e-3, "cm": 1e-2}[theirs["parameters"]["POINT"]["UNITS"]["value"][0].strip() or "mm"]
    wrong = []
    data = trial["data"].reshape(int(trial["frames"]), -1, 3)
    if data.shape[0] != points.shape[2]:
        return [f"{data.shape[0]} frames, ezc3d {points.shape[2]}"]
    compared = 0
    for m, label in enumerate(texts(trial["labels"])):
        if labels.count(label) != 1:
            continue
        compared += 1
        want = points[:3, labels.index(label), :].T * unit
        status = trial["status"].reshape(data.shape[:2])[:, m]
        seen = status > 0
        if numpy.isnan(want[seen]).any() or numpy.abs(data[seen, m] - want[seen]).max(initial=0.0) > 1e-9:
            wrong.append(f"positions of {label}")
        if not numpy.isnan(data[~seen & (status != 5), m]).all():
            wrong.append(f"missing samples of {label}")
    if compared == 0:
        wrong.append("no label in common")
    analog = theirs["data"]["analogs"][0]
    if analog.size and trial["analog"]["data"].size:
        ours = trial["analog"]["data"].reshape(-1, len(texts(trial["analog"]["labels"])))
        if ours.shape != analog.T.shape or numpy.abs(ours - analog.T).max() > 1e-6 * max(1.0, numpy.abs(analog).max()):
            wrong.append("analog data")
    if abs(trial["rate"] - theirs["parameters"]["POINT"]["RATE"]["value"][0]) > 1e-6 or len(numpy.atleast_1d(trial["time"])) != data.shape[0]:
        wrong.append("rate or time")
    return wrong


def check_written(scratch):
    done, wrong, samples = 0, [], 0
    for path in recordings():
        if done == MOST:
            break
        out = scratch / "out.mat"
        if convert(path, out).returncode != 0:
            continue
        done += 1
        trial = load(out)
        samples += trial["data"].size // 3
        wrong += [f"{path.name}: {what}" for what in compare(path, trial)]
        # And back: the C3D file that the MAT file gives is that of the recording.
        direct, back = scratch / "direct.trc", scratch / "back.trc"
        if convert(path, direct).returncode or convert(out, back).returncode:
            wrong.append(f"{path.name}: does not come back")
            continue
        lines = [file.read_text().splitlines()[1:] for file in (direct, back)]
        if lines[0] != lines[1]:
            wrong.append(f"{path.name}: other text in its TRC")
    return row(done == MOST and not wrong, "recordings as MAT, read by scipy, beside ezc3d's reading; and back",
               f"{MOST} files alike", "; ".join(wrong[:4]) or f"{done} files, {samples:,} samples")


def qtm(random, frames, markers, unidentified=0, types=True, force=True):
    """A struct with the fields of Qualisys' manual; and what of it a reader must find."""
    data = random.normal(0.0, 500.0, (markers, 4, frames))
    data[:, 3, :] = random.uniform(0.1, 1.0, (markers, frames))
    kind = random.choice([1, 1, 1, 2, 3], (markers, frames)).astype(numpy.uint8)
    gone = random.uniform(size=(markers, frames)) < 0.1
    data[gone[:, None, :].repeat(4, axis=1)] = numpy.nan
    kind[gone] = 0
    if not types:
        data[:, 3, :][kind > 1] = 0.0
    labelled = {"Count": float(markers), "Labels": numpy.array([[f"mark {i}" for i in range(markers)]], dtype=object), "Data": data}
    if types:
        labelled["Type"] = kind
    struct = {"FileVersion": [2.0, 0.0, 0.0], "File": "C:\\Data\\walk.qtm", "Timestamp": "2015-03-05, 14:48:31.000\t1476", "StartFrame": 41.0,
              "Frames": float(frames), "FrameRate": 120.0, "Trajectories": {"Labeled": labelled},
              "Events": numpy.array([("RHS", 50.0, 49 / 120.0), ("RTO", 60.0, 59 / 120.0)],
                                    dtype=[("Label", object), ("Frame", object), ("Time", object)])}
    if unidentified:
        other = random.normal(0.0, 500.0, (unidentified, 4, frames))
        struct["Trajectories"]["Unidentified"] = {"Count": float(unidentified), "Data": other}
    if force:
        struct["Force"] = {"ForcePlateName": "plate", "Frequency": 240.0, "NrOfSamples": 2.0 * frames,
                           "Force": random.normal(size=(3, 2 * frames)), "ForcePlateLocation": random.normal(size=(4, 3))}
        struct["Analog"] = {"BoardName": "board", "Labels": numpy.array([["emg 1", "emg 2"]], dtype=object), "Frequency": 240.0,
                            "Data": random.normal(size=(2, 2 * frames))}
    return struct, data, kind


def check_qtm(scratch):
    random, wrong, cases = numpy.random.default_rng(3), [], 0
    for frames, markers in ((50, 7), (1, 3), (20, 1)):
        for packed in (False, True):
            for types in (False, True):
                cases += 1
                name = f"{frames} x {markers}{' packed' if packed else ''}{' types' if types else ''}"
                struct, data, kind = qtm(random, frames, markers, unidentified=2 * types, types=types, force=frames > 1)
                scipy.io.savemat(scratch / "qtm.mat", {"walk": struct}, do_compression=packed)
                done = convert(scratch / "qtm.mat", scratch / "ours.mat")
                if done.returncode:
                    wrong.append(f"{name}: {done.stderr.strip()}")
                    continue
                ours = load(scratch / "ours.mat")
                x = ours["data"].reshape(frames, -1, 3)[:, :markers]
                seen = kind.T > 0
                status = ours["status"].reshape(frames, -1)[:, :markers]
                want = numpy.choose(kind.T, [0, 1, 2, 3 if types else 2])
                if numpy.abs(x[seen] - 1e-3 * data[:, :3].transpose(2, 0, 1)[seen]).max() > 1e-12 or (status != want).any():
                    wrong.append(f"{name}: samples")
                residual = ours["residual"].reshape(frames, -1)[:, :markers]
                measured = status == 1
                if numpy.abs(residual[measured] - 1e-3 * data[:, 3].T[measured]).max() > 1e-9:
                    wrong.append(f"{name}: residuals")
                if types and texts(ours["labels"])[-2:] != ["uname*1", "uname*2"]:
                    wrong.append(f"{name}: unidentified {texts(ours['labels'])[-2:]}")
                if ours["first_frame"] != 41 or abs(ours["start"] - 40 / 120.0) > 1e-12 or [
                        (e["label"], round(e["time"] * 120)) for e in ours["events"]] != [("RHS", 49), ("RTO", 59)]:
                    wrong.append(f"{name}: frames, time or events")
                if frames > 1 and not (ours["analog"]["data"][:, :2] == struct["Analog"]["Data"].T).all() or frames > 1 and not (
                        ours["analog"]["data"][:, 2:] == struct["Force"]["Force"].T).all():
                    wrong.append(f"{name}: analog")
    return row(not wrong, "files as QTM exports them, written by scipy, read by kinemark", f"{cases} files alike", "; ".join(wrong[:4]) or f"{cases} files")


def check_refused(scratch):
    """A file of other variables, and one of version 7.3."""
    scipy.io.savemat(scratch / "other.mat", {"emg": numpy.zeros(3), "notes": "x"})
    (scratch / "new.mat").write_bytes(b"MATLAB 7.3 MAT-file".ljust(512) + b"\x89HDF\r\n\x1a\n")
    said = [(convert(scratch / name, scratch / "no.mat"), words) for name, words in (("other.mat", "emg, notes"), ("new.mat", "-v7"))]
    good = all(done.returncode == 3 and words in done.stderr and done.stderr.count("\n") == 1 for done, words in said)
    return row(good and not (scratch / "no.mat").exists(), "MAT files without a trial, and of version 7.3", "exit 3, one sentence that helps",
               " / ".join(done.stderr.strip().split(": ", 2)[-1] for done, _ in said))


def main():
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        good = [check_qtm(scratch), check_refused(scratch)]
        if DATA.is_dir():
            good.append(check_written(scratch))
        else:
            print("SKIP | recordings as MAT, read by scipy | alike | no recordings")
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
