#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Joint angles from markers and inertial sensors together, on simulated truth.

Bodies are moved by OpenSim itself, by angles that its own inverse kinematics found in real walking and running. Markers have white noise; a
whole shank and foot carry none, and there is no marker at all in every third second (in recordings shorter than that: in their last third). All
bodies carry sensors, in random places, in a world of random heading. Beside kinemark stand: weighted least squares of scipy on OpenSim's kinematics, which knows the heading, the places
of the sensors and both noises; kinemark with the same markers alone, where they determine an angle; kinemark with the sensors alone.

Needs Python with opensim, numpy and scipy. Finds the program in KINEMARK_PROGRAM and the models in KINEMARK_TEST_DATA; prints rows
"PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

from orientations import DATA, SUBJECTS, Subject, off, read_table
from rows import PROGRAM, exit_status, row

NOISES = ((1.0, 1.0), (2.0, 2.0), (3.0, 3.0))  # mm, deg
FRAMES = 400
COMPARED = 24  # frames that scipy solves
HIDDEN = ("tibia_r", "talus_r", "calcn_r", "toes_r")
MOST_RATIO = 1.1
METHODS = ("least squares of scipy, which knows heading, places and noise", "the same markers alone", "the sensors alone")


def write_markers(path, times, names, positions):
    """positions: frames x markers x 3, m, NaN where missing."""
    rate = round(1 / (times[1] - times[0]), 6)
    lines = [
        f"PathFileType\t4\t(X/Y/Z)\t{path.name}",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
        f"{rate}\t{rate}\t{len(times)}\t{len(names)}\tm\t{rate}\t1\t{len(times)}",
        "Frame#\tTime\t" + "\t\t\t".join(names),
        "\t\t" + "\t".join(f"{axis}{i}" for i in range(1, len(names) + 1) for axis in "XYZ"),
        "",
    ]
    for k, (time, row_of) in enumerate(zip(times, positions), 1):
        cells = ["" if x != x else f"{x:.7f}" for marker in row_of for x in marker]
        lines.append("\t".join((str(k), f"{time:.6f}", *cells)))
    path.write_text("\n".join(lines) + "\n")


class Mixed(Subject):
    """A subject with markers of which some are hidden."""

    def hide(self, noise_mm, seed):
        import numpy

        draw = numpy.random.default_rng(seed)
        self.marker_noise = noise_mm / 1e3
        self.measured = numpy.array(self.markers) + draw.normal(size=(len(self.times), len(self.marker_names), 3)) * self.marker_noise
        spots = self.model.getMarkerSet()
        hidden = [spots.get(i).getParentFrame().findBaseFrame().getName() in HIDDEN for i in range(spots.getSize())]
        self.measured[:, hidden] = numpy.nan
        third = 3.0 if self.times[-1] > 3 else self.times[-1]
        self.measured[self.times % third >= 2 / 3 * third] = numpy.nan
        self.some = numpy.unique(numpy.linspace(0, len(self.times) - 1, COMPARED).astype(int))

    def by_scipy(self, bodies, noise_deg):
        """Angles (degrees, m) of the frames `some`, by names."""
        import numpy
        import opensim
        from scipy.optimize import least_squares
        from scipy.spatial.transform import Rotation

        state = self.model.initSystem()
        coordinates = self.model.getCoordinateSet()
        spots = self.model.getMarkerSet()
        # As in the model: clamped ones stay in their range, coupled and locked ones are not free.
        coupled = {}
        constraints = self.model.getConstraintSet()
        for i in range(constraints.getSize()):
            coupler = opensim.CoordinateCouplerConstraint.safeDownCast(constraints.get(i))
            if coupler:
                coupled[coupler.getDependentCoordinateName()] = coupler.getIndependentCoordinateNames().get(0), coupler.getFunction()
        free = [name for name in self.names if name not in coupled and not coordinates.get(name).get_locked()]
        base = [self.model.getBodySet().get(body) for body in bodies]
        low = numpy.array([coordinates.get(n).getRangeMin() if coordinates.get(n).get_clamped() else -numpy.inf for n in free])
        high = numpy.array([coordinates.get(n).getRangeMax() if coordinates.get(n).get_clamped() else numpy.inf for n in free])
        undo = self.world.inv()
        noise = numpy.radians(noise_deg)

        def pose(x):
            for name, value in zip(free, x):
                coordinates.get(name).setValue(state, value, False)
            for name, (source, function) in coupled.items():
                value = opensim.Vector(1, coordinates.get(source).getValue(state))
                coordinates.get(name).setValue(state, function.calcValue(value), False)
            self.model.realizePosition(state)

        out = {name: [] for name in self.names}
        for k in self.some:
            turned = [undo * r * m.inv() for r, m in zip(self.recording[k], self.mounts)]
            seen = [i for i in range(len(self.marker_names)) if numpy.isfinite(self.measured[k, i, 0])]

            def misses(x):
                pose(x)
                points = [(spots.get(i).getLocationInGround(state).to_numpy() - self.measured[k, i]) / self.marker_noise for i in seen]
                turns = []
                for body, target in zip(base, turned):
                    matrix = body.getTransformInGround(state).R()
                    found = Rotation.from_matrix([[matrix.get(i, j) for j in range(3)] for i in range(3)])
                    turns.append((target.inv() * found).as_rotvec() / noise)
                return numpy.concatenate([numpy.ravel(points), numpy.ravel(turns)])

            truth = numpy.array([numpy.radians(self.truth[n][k]) for n in free])
            start = numpy.clip(truth, low + 1e-9, high - 1e-9)
            x = least_squares(misses, start, bounds=(low, high), x_scale=0.1, xtol=1e-8, ftol=1e-10).x
            pose(x)
            for name in self.names:
                out[name].append(numpy.degrees(coordinates.get(name).getValue(state)))
        return out


def solve(folder, model, output, *more):
    return subprocess.run([PROGRAM, "ik", "-m", model, "-o", output, *more], cwd=folder, capture_output=True, text=True, check=False)


def columns(path):
    labels, table, _ = read_table(path)
    return {label: table[:, i] for i, label in enumerate(labels)}


class Counts:
    def __init__(self):
        self.within = self.within_two = self.total = 0
        self.headings = []


def compare(body, folder, name, theirs, counts):
    import numpy

    ours, sd = columns(folder / "q.mot"), columns(folder / "q_sd.sto")
    others = [columns(folder / f"{one}.mot") for one in ("markers", "sensors")]
    others_sd = [columns(folder / f"{one}_sd.sto") for one in ("markers", "sensors")]
    report = json.loads((folder / "q_report.json").read_text())["orientations"]
    squares = numpy.zeros((3, 2))
    turning = [label for label in body.names if body.turns[label]]
    shank = [0, 0]
    for label in turning:
        error = off(ours[label], body.truth[label])
        bars = sd[label]
        known = numpy.isfinite(bars) & (bars > 0)
        counts.within += (abs(error) < bars)[known].sum()
        counts.within_two += (abs(error) < 1.96 * bars)[known].sum()
        counts.total += known.sum()
        if label in ("knee_angle_r", "ankle_angle_r"):
            shank[0] += known.sum()
            shank[1] += len(known)
        some = numpy.zeros(len(known), bool)
        some[body.some] = True
        scipy_error = numpy.full(len(known), numpy.nan)
        scipy_error[body.some] = off(theirs[label], numpy.asarray(body.truth[label])[body.some])
        for m, (other, use) in enumerate((
                (scipy_error, some & known),
                *((off(q[label], body.truth[label]), known & numpy.isfinite(s[label]) & (s[label] > 0)) for q, s in zip(others, others_sd)))):
            squares[m] += (error[use] ** 2).sum(), (other[use] ** 2).sum()
    for method, (mine, other) in zip(METHODS, squares):
        ratio = (mine / other) ** 0.5
        row(ratio <= MOST_RATIO, f"{name}: RMS error of angles / {method}", f"at most {MOST_RATIO}", f"{ratio:.3f}")
    row(shank[0] == shank[1], f"{name}: knee and ankle of the leg whose shank has no marker", "determined in all frames", f"in {shank[0] / shank[1]:.1%}")
    heading = report["heading"]
    counts.headings.append(abs(off(heading["deg"], body.heading_deg)) / heading["sd_deg"])


def main():
    try:
        import numpy
        import opensim
        import scipy  # noqa: F401
    except ImportError as error:
        print(f"SKIP | markers and sensors together | - | {error.name} is not installed (tools/setup --oracles)")
        return 0
    if not DATA.is_dir():
        print(f"SKIP | markers and sensors together | - | NO REAL DATA: {DATA} is not there; set KINEMARK_TEST_DATA")
        return 0
    opensim.Logger.setLevelString("Error")
    wanted = sys.argv[2].split(",") if len(sys.argv) > 2 else [name for name, *_ in SUBJECTS]
    seed = int(sys.argv[1]) if len(sys.argv) > 1 else 4310001
    counts = Counts()
    for subject, model, motion, bodies in SUBJECTS:
        if subject not in wanted:
            continue
        model, motion = DATA / model, next(DATA.glob(motion))
        for noise_mm, noise_deg in NOISES:
            with tempfile.TemporaryDirectory(prefix="kinemark-accept-") as scratch:
                folder = Path(scratch)
                body = Mixed(opensim, model, motion, bodies, noise_deg, seed, FRAMES)
                body.hide(noise_mm, seed)
                seed += 1
                body.write(folder)
                write_markers(folder / "walk.trc", body.times, body.marker_names, body.measured)
                name = f"{subject}, {noise_mm:g} mm and {noise_deg:g} deg"
                pose = ["--calibration", "pose.sto"]
                runs = [solve(folder, model, "q.mot", "-t", "walk.trc", "--orientations", "walk.sto", "--sensors-up", "z", *pose),
                        solve(folder, model, "markers.mot", "-t", "walk.trc"),
                        solve(folder, model, "sensors.mot", "--orientations", "walk.sto", "--up", "z", *pose)]
                bad = [run.stderr.strip()[-300:] for run in runs if run.returncode not in (0, 1)]
                if bad:
                    row(False, name, "solved", bad[0])
                    continue
                compare(body, folder, name, body.by_scipy(bodies, noise_deg), counts)
    shares = 100 * counts.within / max(counts.total, 1), 100 * counts.within_two / max(counts.total, 1)
    row(60 <= shares[0] <= 75, "truth within 1 SD", "60 to 75 %", f"{shares[0]:.1f} %")
    row(90 <= shares[1] <= 98, "truth within the interval of 95 %", "90 to 98 %", f"{shares[1]:.1f} %")
    row(bool(counts.headings) and max(counts.headings) < 4, "headings estimated, error / SD", "none beyond 4",
        f"{max(counts.headings, default=0):.1f} at most, of {len(counts.headings)}")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
