#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Joint angles from inertial sensors beside those of OpenSim's solver of orientations.

Bodies are turned by OpenSim itself, by angles that its own inverse kinematics found in real walking and running. Each body carries a
sensor in a random place, all in a world whose z is upright and whose heading is random; each orientation gets noise. OpenSim is given the
heading, kinemark finds it.

Needs Python with opensim, numpy and scipy. Finds the program in KINEMARK_PROGRAM and the models in KINEMARK_TEST_DATA; prints rows
"PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from rows import PROGRAM, exit_status, row

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared" / "data"))
LEGS = ("pelvis", "torso", "femur_r", "femur_l", "tibia_r", "tibia_l", "calcn_r", "calcn_l")
ARMS = ("humerus_r", "humerus_l", "radius_r", "radius_l")
# Name, model, angles, bodies that carry a sensor.
SUBJECTS = (
    ("gait2354", "opensim-gait2354/subject01_simbody.osim", "opensim-gait2354/**/subject01_walk1_ik.mot", LEGS),
    ("Hamner", "opensim-hamner-fullbody/subject02_registered.osim", "opensim-hamner-fullbody/**/subject02_running_ik.mot", LEGS + ARMS),
    ("Rajagopal", "bmc-rajagopal-run/Scale/Rajagopal2015_scaled.osim", "bmc-rajagopal-run/**/ik_output_run.mot", LEGS + ARMS),
)
NOISE_DEG = (1.0, 2.0, 3.0)
FRAMES = 120
POSE_FRAMES = 60
MOST_RATIO = 1.1
MOST_APART_DEG = 0.05  # OpenSim stops at an accuracy of 1e-9


def read_table(path):
    import numpy

    head, _, body = Path(path).read_text().partition("endheader\n")
    lines = body.splitlines()
    return lines[0].split(), numpy.array([[float(cell) for cell in line.split()] for line in lines[1:] if line.strip()]), "inDegrees=yes" in head


def write_quaternions(path, times, names, rotations):
    """rotations: frames x sensors, of scipy."""
    lines = ["DataType=Quaternion", "version=3", "OpenSimVersion=4.1", "endheader", "\t".join(("time", *names))]
    for time, row_of in zip(times, rotations):
        cells = []
        for rotation in row_of:
            x, y, z, w = rotation.as_quat()
            cells.append(f"{w:.9f},{x:.9f},{y:.9f},{z:.9f}")
        lines.append("\t".join((f"{time:.4f}", *cells)))
    path.write_text("\n".join(lines) + "\n")


class Subject:
    """A model that moves, with sensors on it."""

    def __init__(self, opensim, model, motion, bodies, noise_deg, seed, frames=FRAMES):
        import numpy
        from scipy.spatial.transform import Rotation

        draw = numpy.random.default_rng(seed)
        self.model = opensim.Model(str(model))
        state = self.model.initSystem()
        coordinates = self.model.getCoordinateSet()
        self.names = [coordinates.get(i).getName() for i in range(coordinates.getSize())]
        self.turns = {name: coordinates.get(name).getMotionType() == 1 for name in self.names}
        self.heading_deg = draw.uniform(-180, 180)
        upright = Rotation.from_euler("x", 90, degrees=True)
        self.world = upright * Rotation.from_euler("y", -self.heading_deg, degrees=True)
        mounts = self.mounts = Rotation.random(len(bodies), random_state=seed)
        self.sensors = [f"{body}_imu" for body in bodies]

        def seen():
            self.model.realizePosition(state)
            out = []
            for body, mount in zip(bodies, mounts):
                matrix = self.model.getBodySet().get(body).getTransformInGround(state).R()
                turned = Rotation.from_matrix([[matrix.get(i, j) for j in range(3)] for i in range(3)])
                out.append(Rotation.from_rotvec(numpy.radians(noise_deg) * draw.normal(size=3)) * self.world * turned * mount)
            return out

        self.pose = [seen() for _ in range(POSE_FRAMES)]
        labels, table, in_degrees = read_table(motion)
        table = table[:frames]
        self.times = numpy.round(table[:, 0] - table[0, 0], 4)
        self.truth, self.recording, self.markers = {name: [] for name in self.names}, [], []
        spots = self.model.getMarkerSet()
        self.marker_names = [spots.get(i).getName() for i in range(spots.getSize())]
        for values in table:
            for label, value in zip(labels[1:], values[1:]):
                if label in self.names and not coordinates.get(label).get_locked():
                    coordinates.get(label).setValue(state, numpy.radians(value) if in_degrees and self.turns[label] else value, False)
            self.model.assemble(state)
            self.model.realizePosition(state)
            for name in self.names:
                self.truth[name].append(numpy.degrees(coordinates.get(name).getValue(state)))
            self.recording.append(seen())
            self.markers.append([spots.get(i).getLocationInGround(state).to_numpy() for i in range(spots.getSize())])

    def write(self, folder):
        write_quaternions(folder / "walk.sto", self.times, self.sensors, self.recording)
        write_quaternions(folder / "pose.sto", [i / 100 for i in range(POSE_FRAMES)], self.sensors, self.pose)

    def theirs(self, opensim, folder, model):
        """Angles by OpenSim, in degrees, where the true heading is undone beforehand."""
        import numpy
        from scipy.spatial.transform import Rotation

        undo = self.world.inv()
        mean = [undo * Rotation.concatenate([frame[s] for frame in self.pose]).mean() for s in range(len(self.sensors))]
        write_quaternions(folder / "o_pose.sto", (0, 0.01), self.sensors, [mean, mean])
        write_quaternions(folder / "o.sto", self.times, self.sensors, [[undo * r for r in frame] for frame in self.recording])
        placer = opensim.IMUPlacer()
        placed = opensim.Model(str(model))
        placer.setModel(placed)
        placer.set_orientation_file_for_calibration(str(folder / "o_pose.sto"))
        placer.set_sensor_to_opensim_rotations(opensim.Vec3(0))
        placer.run(False)
        placer.getCalibratedModel().printToXML(str(folder / "o.osim"))
        solved = opensim.Model(str(folder / "o.osim"))
        state = solved.initSystem()
        rotations = opensim.OpenSenseUtilities.convertQuaternionsToRotations(opensim.TimeSeriesTableQuaternion(str(folder / "o.sto")))
        solver = opensim.InverseKinematicsSolver(
            solved, opensim.MarkersReference(), opensim.OrientationsReference(rotations), opensim.SimTKArrayCoordinateReference())
        solver.setAccuracy(1e-9)
        angles = {name: [] for name in self.names}
        state.setTime(self.times[0])
        solver.assemble(state)
        for k, time in enumerate(self.times):
            state.setTime(time)
            if k:
                solver.track(state)
            for name in self.names:
                angles[name].append(numpy.degrees(solved.getCoordinateSet().get(name).getValue(state)))
        return angles


def off(found, true):
    import numpy

    return (numpy.asarray(found) - numpy.asarray(true) + 180) % 360 - 180


def main():
    try:
        import numpy
        import opensim
    except ImportError as error:
        print(f"SKIP | sensors beside OpenSim | - | {error.name} is not installed (tools/setup --oracles)")
        return 0
    if not DATA.is_dir():
        print(f"SKIP | sensors beside OpenSim | - | NO REAL DATA: {DATA} is not there; set KINEMARK_TEST_DATA")
        return 0
    opensim.Logger.setLevelString("Error")
    first_seed = int(sys.argv[1]) if len(sys.argv) > 1 else 4210001
    within, within_two, headings, total, seed = 0, 0, [], 0, first_seed
    for subject, model, motion, bodies in SUBJECTS:
        model, motion = DATA / model, next(DATA.glob(motion))
        for noise in NOISE_DEG:
            with tempfile.TemporaryDirectory(prefix="kinemark-accept-") as scratch:
                folder = Path(scratch)
                body = Subject(opensim, model, motion, bodies, noise, seed)
                seed += 1
                body.write(folder)
                done = subprocess.run(
                    [PROGRAM, "ik", "-m", model, "--orientations", "walk.sto", "--calibration", "pose.sto", "--up", "z", "-o", "q.mot"],
                    cwd=folder, capture_output=True, text=True, check=False)
                name = f"{subject}, {noise:g} deg"
                if done.returncode != 0:
                    row(False, name, "solved", done.stderr.strip()[-300:])
                    continue
                theirs = body.theirs(opensim, folder, model)
                placed = subprocess.run(
                    [PROGRAM, "ik", "-m", "o.osim", "--orientations", "o.sto", "-o", "placed.mot"],
                    cwd=folder, capture_output=True, text=True, check=False)
                row(placed.returncode == 0, f"{name}: model with the frames of IMUPlacer", "solved without a pose", placed.stderr.strip().splitlines()[-1][:200])
                placed_labels, placed_q, _ = read_table(folder / "placed.mot")
                labels, q, _ = read_table(folder / "q.mot")
                sd_labels, sd, _ = read_table(folder / "q_sd.sto")
                report = json.loads((folder / "q_report.json").read_text())
            ours_squares = theirs_squares = 0.0
            for label, values in zip(labels[1:], q.T[1:]):
                bars = sd[:, sd_labels.index(label)]
                known = numpy.isfinite(bars) & (bars > 0)
                if not body.turns[label] or not known.any():
                    continue
                error = off(values, body.truth[label])[known]
                ours_squares += (error**2).sum()
                theirs_squares += (off(theirs[label], body.truth[label])[known] ** 2).sum()
                within += (abs(error) < bars[known]).sum()
                within_two += (abs(error) < 1.96 * bars[known]).sum()
                total += known.sum()
            ratio = (ours_squares / theirs_squares) ** 0.5
            row(ratio <= MOST_RATIO, f"{name}: RMS error of angles / OpenSim's, which knows the heading", f"at most {MOST_RATIO}", f"{ratio:.3f}")
            heading = report["heading"]
            headings.append(abs(off(heading["deg"], body.heading_deg)) / heading["sd_deg"])
            apart = max(abs(off(placed_q[:, placed_labels.index(label)], theirs[label])).max()
                        for label in labels[1:] if body.turns[label] and numpy.isfinite(sd[:, sd_labels.index(label)]).all())
            row(apart <= MOST_APART_DEG, f"{name}: angles by IMUPlacer's frames, apart from OpenSim's", f"at most {MOST_APART_DEG} deg", f"{apart:.4f} deg")
            noise_found = report["noise_sd_deg"]
            row(0.85 <= noise_found / noise <= 1.2, f"{name}: noise found", "0.85 to 1.2 of what it is", f"{noise_found / noise:.2f}")
    shares = 100 * within / max(total, 1), 100 * within_two / max(total, 1)
    row(60 <= shares[0] <= 75, "truth within 1 SD", "60 to 75 %", f"{shares[0]:.1f} %")
    row(90 <= shares[1] <= 98, "truth within the interval of 95 %", "90 to 98 %", f"{shares[1]:.1f} %")
    row(bool(headings) and max(headings) < 4, "headings estimated, error / SD", "none beyond 4", f"{max(headings, default=0):.1f} at most, of {len(headings)}")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
