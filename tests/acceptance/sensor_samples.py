#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Single samples of inertial sensors that are wrong: found, left out, and nothing else.

The recordings of `orientations`: real walking and running, each body turned by OpenSim, random mounts and heading, noise of 1 and 2 deg. In each
draw one sensor is wrong for one to ten frames: turned by 30 to 180 deg in its own axes or in the world, each sample turned in a way of its own,
or a quaternion of zeros. Another sensor has its quaternions negated for a while, which is no fault.

Needs Python with opensim, numpy and scipy. Finds the program in KINEMARK_PROGRAM and the models in KINEMARK_TEST_DATA; prints rows
"PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import json
import re
import subprocess
import sys
import tempfile
from pathlib import Path

from orientations import DATA, SUBJECTS, Subject, read_table, write_quaternions
from rows import PROGRAM, exit_status, row

NOISE_DEG = (1.0, 2.0)
FRAMES = 300
DRAWS = 100
KINDS = ("in its own axes", "in the world", "each sample in its own way", "zeros")
LEAST_FOUND = 95.0
MOST_LOST = 0.1
MOST_APART_SD = 0.2  # of angles in frames that have nothing wrong: the heading is estimated from fewer frames
MOST_APART_DEG = 1e-4  # where the heading is the same


class Recording:
    """One subject, its files, and what is solved of it when nothing is wrong."""

    def __init__(self, opensim, folder, name, model, motion, bodies, noise, seed):
        self.folder, self.name, self.model = folder, name, model
        self.subject = Subject(opensim, model, motion, bodies, noise, seed, frames=FRAMES)
        self.subject.write(folder)
        self.clean, self.report = self.solve("walk.sto")
        self.bars = read_table(folder / "q_sd.sto")[1]

    def solve(self, file, *more):
        done = subprocess.run(
            [PROGRAM, "ik", "-m", self.model, "--orientations", file, "--calibration", "pose.sto", "--up", "z", "-o", "q.mot", "--force", *more],
            cwd=self.folder, capture_output=True, text=True, check=False)
        if done.returncode not in (0, 1):
            raise RuntimeError(f"{self.name}: {done.stderr.strip()[-300:]}")
        return read_table(self.folder / "q.mot"), json.loads((self.folder / "q_report.json").read_text())


def spoil(recording, draw):
    """A fault: kind, sensor, frames. The file is walk_bad.sto."""
    import numpy
    from scipy.spatial.transform import Rotation

    subject = recording.subject
    kind = KINDS[int(draw.integers(len(KINDS)))]
    sensor, other = draw.choice(len(subject.sensors), 2, replace=False)
    count = int(draw.integers(1, 11))
    first = int(draw.integers(0, len(subject.times) - count + 1))

    def turn():
        axis = draw.normal(size=3)
        return Rotation.from_rotvec(numpy.radians(draw.uniform(30, 180)) * axis / numpy.linalg.norm(axis))

    frames, by = range(first, first + count), turn()
    rotations = [list(one) for one in subject.recording]
    for f in frames:
        was = rotations[f][sensor]
        rotations[f][sensor] = {"in its own axes": was * by, "in the world": by * was, "each sample in its own way": was * turn(), "zeros": was}[kind]
    path = recording.folder / "walk_bad.sto"
    write_quaternions(path, subject.times, subject.sensors, rotations)
    lines = path.read_text().splitlines()
    head = next(i for i, line in enumerate(lines) if line.startswith("time")) + 1
    for f in range(len(subject.times)):
        cells = lines[head + f].split("\t")
        if kind == "zeros" and f in frames:
            cells[1 + sensor] = "0,0,0,0"
        if first - 20 <= f < first + 20:
            cells[1 + other] = re.sub(r"-?[0-9.]+", lambda number: number[0][1:] if number[0].startswith("-") else f"-{number[0]}", cells[1 + other])
        lines[head + f] = "\t".join(cells)
    path.write_text("\n".join(lines) + "\n")
    return kind, subject.sensors[sensor], set(frames)


def main():
    try:
        import numpy
        import opensim
    except ImportError as error:
        print(f"SKIP | wrong samples of sensors | - | {error.name} is not installed (tools/setup --oracles)")
        return 0
    if not DATA.is_dir():
        print(f"SKIP | wrong samples of sensors | - | NO REAL DATA: {DATA} is not there; set KINEMARK_TEST_DATA")
        return 0
    opensim.Logger.setLevelString("Error")
    seed = int(sys.argv[1]) if len(sys.argv) > 1 else 5310001
    draw = numpy.random.default_rng(seed)
    found, planted, lost, right, accused, apart, same, whole = {k: 0 for k in KINDS}, {k: 0 for k in KINDS}, 0, 0, 0, [], [], 0
    with tempfile.TemporaryDirectory(prefix="kinemark-accept-") as scratch:
        recordings = []
        for subject, model, motion, bodies in SUBJECTS:
            for noise in NOISE_DEG:
                folder = Path(scratch) / f"{subject}{noise:g}"
                folder.mkdir()
                seed += 1
                recordings.append(Recording(opensim, folder, f"{subject}, {noise:g} deg", DATA / model, next(DATA.glob(motion)), bodies, noise, seed))
                accused += recordings[-1].report["rejected_samples"]
                whole += len(recordings[-1].subject.times) * len(bodies)
        for k in range(DRAWS):
            recording = recordings[k % len(recordings)]
            kind, sensor, frames = spoil(recording, draw)
            (labels, q, _), report = recording.solve("walk_bad.sto")
            first = report["first_frame"]
            out = {(r["sensor"], f - first) for r in report["rejected"] for f in range(r["first_frame"], r["last_frame"] + 1)}
            named = {f for s, f in out if s == sensor}
            if kind == "zeros":  # missing, and said so
                named |= frames if any(f"sensor '{sensor}': quaternions of zeros in {len(frames)} rows" in w for w in report["warnings"]) else set()
            planted[kind] += len(frames)
            found[kind] += len(frames & named)
            lost += len(out - {(sensor, f) for f in frames})
            right += len(recording.subject.times) * len(recording.subject.sensors) - len(frames)
            clean_labels, clean, _ = recording.clean
            elsewhere = [f for f in range(len(q)) if f not in frames and f not in {g for _, g in out}]
            assert labels == clean_labels
            turning = [i for i, label in enumerate(labels) if recording.subject.turns.get(label)]
            cells = numpy.ix_(elsewhere, turning)
            off, bars = abs((q - clean + 180) % 360 - 180)[cells], recording.bars[cells]
            known = bars > 0
            apart.append((off[known] / bars[known]).max())
            if report["heading"]["deg"] == recording.report["heading"]["deg"]:
                same.append(off[known].max())
        kept, report = recordings[0].solve("walk_bad.sto", "--doubtful", "keep")
        row(report["rejected_samples"] == 0, "--doubtful keep", "none left out", f"{report['rejected_samples']}")
    for kind in KINDS:
        share = 100 * found[kind] / max(planted[kind], 1)
        row(share >= LEAST_FOUND, f"wrong samples, {kind}", f"at least {LEAST_FOUND:g} % found", f"{share:.1f} % of {planted[kind]}")
    share = 100 * lost / max(right, 1)
    row(share <= MOST_LOST, "right samples left out", f"at most {MOST_LOST} %", f"{share:.4f} % of {right}")
    row(accused == 0, f"{len(recordings)} good recordings", "no sample left out", f"{accused} of {whole}")
    row(max(apart) <= MOST_APART_SD, "angles in frames with nothing wrong", f"at most {MOST_APART_SD} SD apart from those of the good recording",
        f"{max(apart):.3f} SD at most, median of the largest {numpy.median(apart):.4f}")
    row(bool(same) and max(same) <= MOST_APART_DEG, "the same, where the heading is the same", f"at most {MOST_APART_DEG} deg apart",
        f"{max(same, default=0):.1e} deg at most, {len(same)} draws")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
