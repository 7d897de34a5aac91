# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Images of calibrated cameras as goals: `track --rig --images`, `ik --estimator smoother --rig --images`."""

import csv
import json
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
        markers = self.recorded_without(ARM)
        ran = self.good(*self.track("known.mot", markers, "--rig", self.filmed / "rig.toml", "--images", "left=left.csv"))
        self.assertNotIn("the model has no marker for these points of the images", ran.err)

        left.write_text(left.read_text().replace("RELB", "elbow").replace("RWRA", "wrist"))
        ran = self.good(*self.track("q.mot", markers, "--rig", self.filmed / "rig.toml", "--images", "left=left.csv"))
        self.assertIn("the model has no marker for these points of the images: elbow, wrist", ran.err)


if __name__ == "__main__":
    unittest.main()


class Keypoints(Filmed):
    """The same points as CSV and as JSON of others give the same angles, to the last bit."""

    NAMES = {"RUPA": "RShoulder", "RELB": "RElbow", "RWRA": "RWrist"}
    BODY25 = {"RShoulder": 2, "RElbow": 3, "RWrist": 4}

    def setUp(self):
        super().setUp()
        model = self.model.read_text()
        for marker, name in self.NAMES.items():
            self.assertIn(f'"{marker}"', model)
            model = model.replace(f'"{marker}"', f'"{name}"')
        self.write("model.osim", model)
        self.recorded_without(ARM)
        lines = self.film(self.cameras[0], dark=range(50, 60), names=tuple(self.NAMES)).read_text().splitlines()
        for marker, name in self.NAMES.items():
            lines[1] = lines[1].replace(marker, name)
        self.write("left.csv", "\n".join(lines) + "\n")
        names = lines[1].split(",")[1::3]
        self.frames = []
        for line in lines[3:]:
            cells = [float(cell) for cell in line.split(",")[1:]]
            self.frames.append({name: cells[3 * i: 3 * i + 3] for i, name in enumerate(names)})

    def solve(self, images, *more, status=0):
        ran = self.good("track", "-m", "model.osim", "-t", "markers.csv", "-o", "q.mot", "--rig", self.filmed / "rig.toml",
                        "--images", f"left={images}", "--force", "--quiet", *more, status=status)
        self.assertEqual(ran.err, "")
        names, rows = table(self.folder / "q.mot")
        return names, rows

    def persons(self, frame):
        """The person of a frame behind another one, whose points are elsewhere."""
        return [{name: (1.0, 2.0, 0.9) for name in frame}, frame]

    def coco(self, people):
        annotations = []
        for i, frame in enumerate(self.frames):
            for k, person in enumerate(people(frame)):
                flat = [value for x, y, score in person.values() for value in (x, y, 2 if score >= 0.6 else 0)]
                annotations.append({"id": 10 * i + k, "image_id": i + 1, "category_id": 1, "keypoints": flat})
        return {"images": [{"id": i + 1, "file_name": f"{i:06}.png"} for i in range(len(self.frames))],
                "annotations": annotations, "categories": [{"id": 1, "name": "person", "keypoints": list(self.frames[0])}]}

    def mmpose(self, people):
        frames = [{"frame_id": i, "instances": [{"keypoints": [[x, y] for x, y, _ in person.values()],
                                                 "keypoint_scores": [score for _, _, score in person.values()]}
                                                for person in people(frame)]} for i, frame in enumerate(self.frames)]
        return {"meta_info": {"keypoint_id2name": {str(i): name for i, name in enumerate(self.frames[0])}}, "instance_info": frames}

    def openpose(self, people, folder):
        (self.folder / folder).mkdir()
        for i, frame in enumerate(self.frames):
            persons = []
            for person in people(frame):
                flat = [0.0] * 75
                for name, place in self.BODY25.items():
                    flat[3 * place: 3 * place + 3] = person[name]
                persons.append({"person_id": [-1], "pose_keypoints_2d": flat})
            self.write(f"{folder}/walk_{i:012}_keypoints.json", json.dumps({"version": 1.3, "people": persons}))

    def test_json_gives_what_csv_gives(self):
        expected = self.solve("left.csv")
        one = lambda frame: [frame]
        self.write("coco.json", json.dumps(self.coco(one)))
        self.write("mmpose.json", json.dumps(self.mmpose(one)))
        self.openpose(one, "openpose")
        for images in ("coco.json", "mmpose.json", "openpose", "openpose/walk_000000000007_keypoints.json"):
            self.assertEqual(self.solve(images), expected, images)

    def test_one_of_several_people_is_chosen(self):
        expected = self.solve("left.csv")
        self.write("coco.json", json.dumps(self.coco(self.persons)))
        self.write("mmpose.json", json.dumps(self.mmpose(self.persons)))
        self.openpose(self.persons, "openpose")
        for images in ("coco.json", "mmpose.json", "openpose"):
            self.refused(3, "--person", "track", "-m", "model.osim", "-t", "markers.csv", "-o", "new.mot", "--rig",
                         self.filmed / "rig.toml", "--images", f"left={images}")
            self.assertEqual(self.solve(images, "--person", "2"), expected, images)
            self.assertNotEqual(self.solve(images, "--person", "1", status=1), expected, images)

    def test_points_in_pixels_are_no_markers(self):
        self.write("coco.json", json.dumps(self.coco(lambda frame: [frame])))
        for command in (["info", "coco.json"], ["convert", "coco.json", "out.c3d"]):
            self.refused(3, "--images", *command)
