#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Points in images as OpenPose, MMPose and COCO write them, read by kinemark and, apart from it, by Python's own json:
what Python finds goes to kinemark as CSV, which pandas writes as DeepLabCut does. The same points give the same motion.

Needs Python with pandas. Finds the program in KINEMARK_PROGRAM; prints rows "PASS|FAIL | check | asked | measured"; exit
status 1 when one fails.
"""

import json
import math
import re
import sys
import tempfile
from pathlib import Path

import numpy
import pandas

from rows import row, run

ARM = ["RUPA", "RELB", "RFRM", "RWRA", "RWRB", "RFIN"]
COCO18 = "Nose Neck RShoulder RElbow RWrist LShoulder LElbow LWrist RHip RKnee RAnkle LHip LKnee LAnkle REye LEye REar LEar".split()
FRAMES, FOCAL = 300, 1500.0
DARK, DOUBTED = range(100, 130), range(200, 215)  # frames of nobody, and of scores that are too low


def unit(v):
    return v / numpy.linalg.norm(v)


class Subject:
    """A simulated subject whose right arm one camera sees: F x M x 3 values x, y, score."""

    def __init__(self, folder):
        run("simulate", "subject", "-o", "made", "--duration", 3, folder=folder, good=(0,))
        run("convert", "made/truth.trc", "truth.csv", folder=folder, good=(0,))
        table = pandas.read_csv(folder / "truth.csv")
        arm = table[table.marker.isin(ARM)].pivot(index="frame", columns="marker", values=["x_m", "y_m", "z_m"])
        points = numpy.stack([arm[axis][ARM].to_numpy() for axis in ("x_m", "y_m", "z_m")], axis=-1)
        middle = points[0].mean(axis=0)
        position = middle + numpy.array([3.0, 0.8, 2.2])
        z = unit(middle - position)
        x = unit(numpy.cross([0.0, 1.0, 0.0], z))
        turn = numpy.array([x, numpy.cross(z, x), z])
        seen = (points - position) @ turn.T
        pixels = numpy.array([960.0, 540.0]) + FOCAL * seen[..., :2] / seen[..., 2:]
        chance = numpy.random.default_rng(14)
        pixels = numpy.round(pixels + 0.5 * chance.standard_normal(pixels.shape), 3)
        scores = numpy.round(chance.uniform(0.7, 1.0, pixels.shape[:2]), 4)
        scores[DOUBTED] = 0.3
        self.values = numpy.dstack([pixels, scores])
        (folder / "rig.toml").write_text(
            f'format = "kinemark-rig"\nversion = 1\n[[camera]]\nname = "c"\nkind = "pinhole"\nfocal = {FOCAL}\n'
            f"principal_point = [960.0, 540.0]\nrotation = {turn.tolist()}\ntranslation_m = {(-turn @ position).tolist()}\n"
        )
        table[~table.marker.isin(ARM)].to_csv(folder / "markers.csv", index=False)

    def other(self, f):
        """Somebody else in the same frame."""
        return self.values[f] + numpy.array([250.0, 30.0, 0.0])


def write_openpose(subject, folder, numbered):
    folder.mkdir()
    for f in range(FRAMES):
        people = []
        for number, values in ((8, subject.other(f)), (3, subject.values[f])):
            points = numpy.zeros((len(COCO18), 3))
            points[: len(ARM)] = values
            person = {"person_id": [number if numbered else -1], "pose_keypoints_2d": points.ravel().tolist()}
            person |= {"face_keypoints_2d": [], "hand_left_keypoints_2d": [], "pose_keypoints_3d": []}
            people.append(person)
        if numbered and f % 2:
            people.reverse()
        text = json.dumps({"version": 1.3, "people": [] if f in DARK else people})
        (folder / f"walk_{f:012}_keypoints.json").write_text(text)


def write_mmpose(subject, file):
    def instance(values):
        return {"keypoints": values[:, :2].tolist(), "keypoint_scores": values[:, 2].tolist(), "bbox": [[0.0, 0.0, 9.0, 9.0]]}

    names = {str(m): name for m, name in enumerate(ARM)}
    info = [{"frame_id": f + 1, "instances": [instance(subject.values[f])]} for f in range(FRAMES) if f not in DARK]
    file.write_text(json.dumps({"meta_info": {"keypoint_id2name": names}, "instance_info": info}, indent="\t"))


def write_coco(subject, file):
    images = [{"id": 1000 - f, "file_name": f"{f}.png", "width": 1920, "height": 1080} for f in range(FRAMES)]
    notes = []
    for f in reversed([f for f in range(FRAMES) if f not in DARK]):
        values = subject.values[f].copy()
        values[:, 2] = numpy.where(values[:, 2] < 0.6, 0, 2)
        values[values[:, 2] == 0] = 0
        keypoints = values.ravel().tolist()
        notes.append({"id": f, "image_id": 1000 - f, "category_id": 1, "keypoints": keypoints, "num_keypoints": len(ARM)})
        notes.append({"id": FRAMES + f, "image_id": 1000 - f, "category_id": 2, "bbox": [1, 2, 3, 4]})
    categories = [{"id": 2, "name": "ball"}, {"id": 1, "name": "person", "keypoints": ARM, "skeleton": [[1, 2]]}]
    file.write_text(json.dumps({"images": images, "annotations": notes, "categories": categories}))


def read_openpose(folder, number):
    """Frames of the person with this number, or else in this place."""
    frames = []
    for file in sorted(folder.glob("*.json"), key=lambda p: int(re.findall(r"(\d+)_keypoints", p.name)[0])):
        people = json.loads(file.read_text())["people"]
        tracked = [p for p in people if p["person_id"] != [-1]]
        found = [p for p in tracked if p["person_id"] == [number]] if tracked else people[number - 1 : number]
        frames.append(numpy.reshape(found[0]["pose_keypoints_2d"], (-1, 3)) if found else None)
    return COCO18, frames


def read_mmpose(file):
    document = json.loads(file.read_text())
    by_frame = {f["frame_id"]: f["instances"] for f in document["instance_info"]}
    names = [name for _, name in sorted(document["meta_info"]["keypoint_id2name"].items(), key=lambda item: int(item[0]))]
    frames = []
    for f in range(min(by_frame), max(by_frame) + 1):
        people = by_frame.get(f, [])
        frames.append(numpy.column_stack([people[0]["keypoints"], people[0]["keypoint_scores"]]) if people else None)
    return names, frames


def read_coco(file):
    document = json.loads(file.read_text())
    by_image = {n["image_id"]: n["keypoints"] for n in document["annotations"] if "keypoints" in n}
    frames = [by_image.get(image["id"]) for image in document["images"]]
    names = next(c["keypoints"] for c in document["categories"] if "keypoints" in c)
    return names, [None if f is None else numpy.minimum(numpy.reshape(f, (-1, 3)), [math.inf, math.inf, 1]) for f in frames]


def write_table(names, frames, file):
    """As DeepLabCut does with pandas; what nobody found is missing."""
    columns = pandas.MultiIndex.from_product([["net"], names, ["x", "y", "likelihood"]], names=["scorer", "bodyparts", "coords"])
    values = numpy.array([numpy.full((len(names), 3), numpy.nan) if f is None else f for f in frames], dtype=float)
    values[values[..., 2] == 0] = numpy.nan
    pandas.DataFrame(values.reshape(len(frames), -1), columns=columns).to_csv(file)


class Motions:
    """Motions that track finds with points."""

    def __init__(self, folder):
        self.folder = folder

    def angles(self, points, *more, names=None):
        """The table of the motion; the model's arm has other names where they are given."""
        text = (self.folder / "made/model.osim").read_text()
        for ours, theirs in zip(ARM, names or ARM):
            text = text.replace(f'"{ours}"', f'"{theirs}"')
        (self.folder / "model.osim").write_text(text)
        words = ["-m", "model.osim", "-t", "markers.csv", "--rig", "rig.toml", "--images", f"c={points}", *more]
        run("track", *words, "-o", "q.mot", "--force", folder=self.folder, good=(0,))
        return [line for line in (self.folder / "q.mot").read_text().splitlines() if re.match(r"\s*[0-9]", line)]

    def refusal(self, points, *more):
        words = ["-m", "made/model.osim", "-t", "markers.csv", "--rig", "rig.toml", "--images", f"c={points}", *more]
        return run("track", *words, "-o", "never.mot", folder=self.folder)


def compare(what, motions, points, read, *more, names=None):
    """The program's reading against Python's, and against Python's with one coordinate changed by a pixel."""
    write_table(*read, motions.folder / "judge.csv")
    found, judged = motions.angles(points, *more, names=names), motions.angles("judge.csv", names=names)
    read[1][50] = read[1][50] + numpy.array([1.0, 0.0, 0.0])
    write_table(*read, motions.folder / "judge.csv")
    changed = motions.angles("judge.csv", names=names)
    same = sum(a == b for a, b in zip(found, judged, strict=True))
    differ = sum(a != b for a, b in zip(found, changed, strict=True))
    good = row(same == FRAMES, f"{what}: motion", f"{FRAMES} frames as from Python's reading", f"{same} the same, to the last digit")
    return row(differ > 0, f"{what}: a frame moved by 1 px", "is noticed", f"{differ} frames differ") and good


def main():
    good = True
    with tempfile.TemporaryDirectory(prefix="kinemark-images-") as scratch:
        folder = Path(scratch)
        subject, motions = Subject(folder), Motions(folder)
        write_openpose(subject, folder / "plain", numbered=False)
        write_openpose(subject, folder / "tracked", numbered=True)
        write_mmpose(subject, folder / "mmpose.json")
        write_coco(subject, folder / "coco.json")
        one = "tracked/walk_000000000042_keypoints.json"
        good &= compare("OpenPose, second in each frame", motions, "plain", read_openpose(folder / "plain", 2), "--person", 2, names=COCO18)
        good &= compare("OpenPose, number 3, one file given", motions, one, read_openpose(folder / "tracked", 3), "--person", 3, names=COCO18)
        good &= compare("MMPose", motions, "mmpose.json", read_mmpose(folder / "mmpose.json"))
        good &= compare("COCO", motions, "coco.json", read_coco(folder / "coco.json"))
        refused = motions.refusal("plain")
        said = refused.stderr.strip()
        good &= row(refused.returncode == 3 and "shows 2 people; choose one with --person" in said and said.count("\n") == 0,
                    "two people, none chosen", "exit 3, one sentence", f"exit {refused.returncode}: {said[-60:]}")
        for name in ("coco.json", "mmpose.json", "judge.csv"):
            refused = run("info", name, folder=folder)
            good &= row(refused.returncode == 3 and "in pixels" in refused.stderr, f"info {name}", "exit 3: pixels are no markers",
                        f"exit {refused.returncode}")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
