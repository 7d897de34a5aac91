# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Points in images as JSON: OpenPose, MMPose and COCO give what the same points as CSV give."""

import csv
import json
import re
import unittest

import test_images

NAMES = test_images.ARM
MPI = "Head Neck RShoulder RElbow RWrist LShoulder LElbow LWrist RHip RKnee RAnkle LHip LKnee LAnkle Chest".split()


class JsonOfImages(test_images.Filmed):
    """The camera "left" of the filmed arm, as each writer has it."""

    def setUp(self):
        super().setUp()
        rows = list(csv.reader(self.film(self.cameras[0], dark=range(50, 60)).read_text().splitlines()))[3:]
        self.values = [[[float(v) for v in row[1 + 3 * m : 4 + 3 * m]] for m in range(len(NAMES))] for row in rows]
        self.markers = self.recorded_without(test_images.ARM)

    def tracked(self, points, *more, output="q.mot"):
        words = ["--rig", self.filmed / "rig.toml", "--images", f"left={points}", "--force", *more]
        return self.track(output, self.markers, *words)

    def motion(self, points, *more):
        self.good(*self.tracked(points, *more))
        return [line for line in (self.folder / "q.mot").read_text().splitlines() if line[:1].isdigit()]

    def mmpose(self, frames):
        """Instances of each frame, each a list of (x, y, score)."""
        names = {str(m): name for m, name in enumerate(NAMES)}
        info = [
            {
                "frame_id": f + 1,
                "instances": [
                    {"keypoints": [v[:2] for v in person], "keypoint_scores": [v[2] for v in person], "bbox": [[0, 0, 9, 9]]}
                    for person in people
                ],
            }
            for f, people in enumerate(frames)
        ]
        return json.dumps({"meta_info": {"dataset_name": "arm", "keypoint_id2name": names}, "instance_info": info})

    def coco(self):
        annotations = [
            {"id": f, "image_id": 7 * f, "category_id": 1, "keypoints": [n for v in person for n in v]}
            for f, person in enumerate(self.values)
        ]
        images = [{"id": 7 * f, "file_name": f"{f:05}.png", "width": 1920, "height": 1080} for f in range(len(self.values))]
        categories = [{"id": 1, "name": "person", "keypoints": list(NAMES), "skeleton": []}]
        return json.dumps({"info": {}, "images": images, "annotations": annotations, "categories": categories})

    def openpose(self, folder, left_out=()):
        """A frame a file, with the arm's points under names of MPI."""
        (self.folder / folder).mkdir()
        for f, person in enumerate(self.values):
            if f in left_out:
                continue
            points = person + [[0, 0, 0]] * (len(MPI) - len(person))
            people = [{"person_id": [-1], "pose_keypoints_2d": [n for v in points for n in v], "pose_keypoints_3d": []}]
            self.write(f"{folder}/arm_{f:012}_keypoints.json", json.dumps({"version": 1.3, "people": people}))

    def renamed(self, name, into):
        """A copy of a text with the arm's names as the first of MPI."""
        text = name.read_text()
        for ours, theirs in zip(NAMES, MPI):
            text = re.sub(rf'(?<=[",]){ours}(?=[",\n])', theirs, text)
        return self.write(into, text)

    def test_documents_give_what_the_table_gives(self):
        by_table = self.motion("left.csv")
        self.write("mmpose.json", self.mmpose([[person] for person in self.values]))
        self.write("coco.json", self.coco())
        self.assertEqual(self.motion("mmpose.json"), by_table)
        self.assertEqual(self.motion("coco.json"), by_table)
        report = json.loads((self.folder / "q_report.json").read_text())
        self.assertIn("coco.json", json.dumps(report))

    def test_frames_that_are_left_out_are_not_seen(self):
        by_table = self.motion("left.csv")
        self.write("dark.json", self.mmpose([[] if f in range(50, 60) else [person] for f, person in enumerate(self.values)]))
        self.assertEqual(self.motion("dark.json"), by_table)

    def test_a_folder_of_openpose_or_one_of_its_files(self):
        self.model = self.renamed(self.model, "model.osim")
        self.renamed(self.folder / "left.csv", "left.csv")
        by_table = self.motion("left.csv")
        self.openpose("frames", left_out=range(50, 60))
        self.assertEqual(self.motion("frames"), by_table)
        inputs = json.dumps(json.loads((self.folder / "q_report.json").read_text()))
        self.assertIn('"frames"', inputs)
        self.assertEqual(self.motion("frames/arm_000000000007_keypoints.json"), by_table)

    def test_several_people_need_a_choice(self):
        by_table = self.motion("left.csv")
        other = [[[x + 300.0, y, s] for x, y, s in person] for person in self.values]
        self.write("two.json", self.mmpose([[b, a] for a, b in zip(self.values, other)]))
        self.refused(3, ["two.json", "frame 1", "shows 2 people; choose one with --person"], *self.tracked("two.json"))
        self.assertEqual(self.motion("two.json", "--person", 2), by_table)
        self.refused(3, "none shows person 3", *self.tracked("two.json", "--person", 3))
        self.refused(2, "person -1 cannot be", *self.tracked("two.json", "--person", -1))

    def test_what_is_wrong_is_said_in_a_sentence(self):
        good = self.mmpose([[person] for person in self.values])
        refused = {
            "is no JSON": good[:-2],
            "has 299 frames; the markers have 300": self.mmpose([[person] for person in self.values[:-1]]),
            "frame 1: person 1: has no keypoints": good.replace("keypoints", "points"),
            "points in three dimensions": good.replace('"keypoints": [[', '"keypoints": [[1.0, ', 1),
            "holds no points": '{"bodies": []}',
            "need pixels": self.mmpose([[[[x / 1920, y / 1920, s] for x, y, s in person]] for person in self.values]),
        }
        for sentence, text in refused.items():
            with self.subTest(sentence):
                self.write("bad.json", text)
                self.refused(3, ["bad.json", sentence], *self.tracked("bad.json", output="never.mot"))
                self.assertFalse((self.folder / "never.mot").exists())
        (self.folder / "empty").mkdir()
        self.refused(3, "holds no frames of OpenPose", *self.tracked("empty"))

    def test_pixels_are_no_markers(self):
        self.write("coco.json", self.coco())
        for name in ("left.csv", "coco.json"):
            for words in (["info", name], ["convert", name, "out.trc"], ["ik", "-m", self.model, "-t", name, "-o", "q.mot"]):
                with self.subTest(words=words):
                    self.refused(3, [name, "in pixels", "--images CAMERA=FILE"], *words)
        self.assertFalse((self.folder / "out.trc").exists())


if __name__ == "__main__":
    unittest.main()
