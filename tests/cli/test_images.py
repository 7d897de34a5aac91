# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Images of calibrated cameras as goals: `track --rig --images`, `ik --estimator smoother --rig --images`."""

import csv
import math
import random
import tempfile
import unittest
from pathlib import Path

from support import CommandTest, run, table

FOCAL = 1500.0
NOISE_PX = 0.5
ARM = ("RUPA", "RELB", "RFRM", "RWRA", "RWRB", "RFIN")
ANGLES = ("arm_flex_r", "arm_add_r", "arm_rot_r", "elbow_flex_r", "pro_sup_r")
LOST = range(100, 200)  # frames in which cameras are off, at 100 Hz


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    return [x / math.hypot(*a) for x in a]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


class Camera:
    """A pinhole camera at a position, looking at a target, Y up."""

    def __init__(self, name, position, target):
        z = unit([t - p for t, p in zip(target, position)])
        x = unit(cross([0.0, 1.0, 0.0], z))
        self.name, self.rotation = name, [x, cross(z, x), z]
        self.translation = [-dot(row, position) for row in self.rotation]

    def image(self, point):
        x, y, z = (dot(row, point) + t for row, t in zip(self.rotation, self.translation))
        return 960.0 + FOCAL * x / z, 540.0 + FOCAL * y / z

    def toml(self):
        return (
            f'[[camera]]\nname = "{self.name}"\nkind = "pinhole"\nfocal = {FOCAL}\nprincipal_point = [960.0, 540.0]\n'
            f"rotation = {self.rotation}\ntranslation_m = {self.translation}\n"
        )


class Filmed(CommandTest):
    """The right arm is seen by cameras alone; all other markers are recorded in 3D."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        scratch = tempfile.TemporaryDirectory(prefix="kinemark-cli-")
        cls.addClassCleanup(scratch.cleanup)
        cls.filmed = Path(scratch.name)
        for words in (
            ["simulate", "subject", "-o", "made", "--duration", 3],
            ["convert", "made/truth.trc", "truth.csv"],
        ):
            made = run(*words, cwd=cls.filmed)
            assert made.status == 0, made.err
        cls.model, cls.truth = cls.filmed / "made" / "model.osim", cls.filmed / "made" / "truth.mot"
        with open(cls.filmed / "truth.csv", newline="") as file:
            cls.rows = list(csv.DictReader(file))
        cls.names = list(dict.fromkeys(row["marker"] for row in cls.rows))
        cls.positions = {
            (int(row["frame"]), row["marker"]): [float(row[axis]) for axis in ("x_m", "y_m", "z_m")] for row in cls.rows
        }
        cls.first = min(frame for frame, _ in cls.positions)
        middle = cls.positions[(cls.first, "RELB")]
        cls.cameras = [
            Camera("left", [m + d for m, d in zip(middle, (3.0, 0.8, 2.2))], middle),
            Camera("right", [m + d for m, d in zip(middle, (3.0, 0.8, -2.2))], middle),
        ]
        head = 'format = "kinemark-rig"\nversion = 1\n'
        (cls.filmed / "rig.toml").write_text(head + "".join(camera.toml() for camera in cls.cameras))

    def film(self, camera, dark=(), names=ARM):
        """The file of points that a camera gives; in dark frames nothing is likely."""
        noise = random.Random(f"{camera.name}")
        cells = [name for name in names for _ in range(3)]
        lines = [["scorer"] + ["net"] * len(cells), ["bodyparts", *cells], ["coords"] + ["x", "y", "likelihood"] * len(names)]
        for frame in range(300):
            line = [frame]
            for name in names:
                u, v = camera.image(self.positions[(self.first + frame, name)])
                line += [u + noise.gauss(0, NOISE_PX), v + noise.gauss(0, NOISE_PX), 0.1 if frame in dark else 0.95]
            lines.append(line)
        return self.write(f"{camera.name}.csv", "".join(",".join(map(str, line)) + "\n" for line in lines))

    def recorded_without(self, hidden, dark=()):
        """The recording in 3D: markers left out, and frames in which none is seen."""
        kept = [row for row in self.rows if row["marker"] not in hidden and int(row["frame"]) - self.first not in dark]
        path = self.folder / "markers.csv"
        with open(path, "w", newline="") as file:
            writer = csv.DictWriter(file, fieldnames=self.rows[0].keys())
            writer.writeheader()
            writer.writerows(kept)
        return path

    def track(self, output, markers, *more):
        return ["track", "-m", self.model, "-t", markers, "-o", output, *more]


class Images(Filmed):
    def pair(self):
        return ["--rig", self.filmed / "rig.toml", "--images", "left=left.csv", "--images", "right=right.csv"]

    def arm_error(self, output, frames):
        """Root mean square over the arm's angles, degrees."""
        names, rows = table(self.folder / output)
        true_names, true_rows = table(self.truth)
        squares = [
            (rows[f][names.index(angle)] - true_rows[f][true_names.index(angle)]) ** 2 for f in frames for angle in ANGLES
        ]
        return math.sqrt(sum(squares) / len(squares))

    def test_one_camera_of_a_pair_carries_the_arm_through(self):
        markers = self.recorded_without(ARM)
        inside = range(LOST.start + 15, LOST.stop - 15)
        errors = {}
        for lost in ((), ("right",), ("left", "right")):
            for camera in self.cameras:
                self.film(camera, dark=LOST if camera.name in lost else ())
            self.good(*self.track("q.mot", markers, *self.pair(), "--image-noise", NOISE_PX, "--force"))
            errors[len(lost)] = self.arm_error("q.mot", inside)
        self.assertLess(errors[0], 1.0)
        self.assertLess(errors[1], 2.0)
        self.assertGreater(errors[2], 5.0 * errors[1])
        text = (self.folder / "q_report.json").read_text()
        for word in ('"images"', "rig.toml", "left.csv", "right.csv"):
            self.assertIn(word, text)

    def test_the_smoother_reads_the_same_files(self):
        for camera in self.cameras:
            self.film(camera, dark=LOST if camera.name == "right" else (), names=self.names)
        markers = self.recorded_without((), dark=LOST)
        smoother = ["ik", "-m", self.model, "-t", markers, "--estimator", "smoother"]
        self.good(*smoother, "-o", "q.mot", *self.pair(), "--image-noise", NOISE_PX)
        self.good(*smoother, "-o", "blind.mot")
        inside = range(LOST.start + 20, LOST.stop - 20)
        self.assertLess(self.arm_error("q.mot", inside), 0.7)
        self.assertGreater(self.arm_error("blind.mot", inside), 1.5 * self.arm_error("q.mot", inside))

    def test_what_cannot_be_is_refused_in_a_sentence(self):
        left = self.film(self.cameras[0])
        self.film(self.cameras[1])
        markers = self.recorded_without(ARM)
        rig = ["--rig", self.filmed / "rig.toml"]
        track = self.track("q.mot", markers)
        self.refused(2, "give --rig", *track, "--images", "left=left.csv")
        self.refused(2, "give --images", *track, *rig)
        self.refused(2, "'left.csv' is not CAMERA=FILE", *track, *rig, "--images", "left.csv")
        self.refused(2, "camera 'left' has two files", *track, *rig, "--images", "left=left.csv", "--images", "left=right.csv")
        self.refused(3, ["no camera 'top'", "it has left, right"], *track, *rig, "--images", "top=left.csv")
        self.refused(2, "image noise is 0 px", *track, *rig, "--images", "left=left.csv", "--image-noise", 0)
        self.refused(2, "likelihood is 2", *track, *rig, "--images", "left=left.csv", "--min-likelihood", 2)
        self.refused(4, "absent.csv", *track, *rig, "--images", "left=absent.csv")
        self.refused(
            2, "--estimator smoother", "ik", "-m", self.model, "-t", markers, "-o", "q.mot", *rig, "--images", "left=left.csv"
        )
        good = left.read_text()
        self.write("left.csv", good.replace("\n7,", "\n8,", 1))
        self.refused(3, ["left.csv", "line 11", "need frame 7"], *track, *rig, "--images", "left=left.csv")
        self.write("left.csv", good[: good.index("\n200,") + 1])
        self.refused(3, "has 200 frames; the markers have 300", *track, *rig, "--images", "left=left.csv")
        self.write("left.csv", good.replace("0.95", "likely", 1))
        self.refused(3, ["line 4: column 4 is 'likely'"], *track, *rig, "--images", "left=left.csv")
        self.write("left.csv", good.replace("bodyparts,R", "bodyparts,x").replace(",R", ",x"))
        self.refused(3, "no marker of the model", *track, *rig, "--images", "left=left.csv")

    def test_points_that_the_model_lacks_are_left_out_and_named(self):
        left = self.film(self.cameras[0])
        left.write_text(left.read_text().replace("RELB", "elbow").replace("RWRA", "wrist"))
        markers = self.recorded_without(ARM)
        ran = self.good(*self.track("q.mot", markers, "--rig", self.filmed / "rig.toml", "--images", "left=left.csv"))
        self.assertIn("the model has no marker for these points of the images: elbow, wrist", ran.err)


if __name__ == "__main__":
    unittest.main()
