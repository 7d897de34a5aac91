# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Vicon's skeleton files: what `info` says of them, and the joints that they name."""

import json
import unittest

from support import CommandTest, real_file
from test_joints import SEGMENTS, arm

SKELETON = """<?xml version="1.0"?>
<KinematicModel MODEL="Arm"><Parameters><StaticParameter NAME="Bodymass" QUANTITY="mass" VALUE="75"/>
<StaticParameter NAME="Elbow" QUANTITY="length" EXPRESSION="Width / 2"/></Parameters>
<Skeleton><Segment NAME="upper"><JointFree NAME="world"/><Segment NAME="fore"><JointBall NAME="elbow"/>
<Segment NAME="turned"><JointDummy/></Segment></Segment></Segment></Skeleton>
<MarkerSet><Markers>{}</Markers><Sticks><Stick MARKER1="u0" MARKER2="f0"/></Sticks></MarkerSet></KinematicModel>"""
ON = {"u0": "upper", "u1": "upper", "u2": "upper", "u3": "upper", "f0": "fore", "f1": "fore", "f2": "turned", "f3": "turned"}


def skeleton(on):
    return SKELETON.format("".join(f'<Marker NAME="{name}" POSITION="1 2 3" SEGMENT="{segment}"/>' for name, segment in on.items()))


class Skeletons(CommandTest):
    def setUp(self):
        super().setUp()
        self.write("arm.csv", arm()[0])
        self.write("segments.toml", SEGMENTS)
        self.write("ann.vsk", skeleton(ON))

    def test_info_tells_the_subject(self):
        text = self.good("info", "ann.vsk").out
        for part in ("Arm", "upper (root: u0 u1 u2 u3)", "fore (upper, ball: f0 f1)", "Bodymass=75.0 kg", "Elbow=? m"):
            self.assertIn(part, text)
        found = json.loads(self.good("info", "--json", "ann.vsk").out)
        self.assertEqual(found["kind"], "skeleton")
        self.assertEqual([s["joint_kind"] for s in found["segments"]], ["free", "ball", "fixed"])
        self.assertEqual(found["labels"], list(ON))

    def test_joints_of_a_subject_are_those_of_the_same_segments(self):
        self.good("joints", "arm.csv", "--segments", "segments.toml", "-o", "toml.csv")
        self.good("joints", "arm.csv", "--segments", "ann.vsk", "-o", "vsk.csv")
        self.assertEqual((self.folder / "toml.csv").read_bytes(), (self.folder / "vsk.csv").read_bytes())

    def test_markers_that_the_recording_lacks_are_named(self):
        self.write("more.vsk", skeleton({**ON, "X9": "fore"}))
        self.assertIn("Not in the recording: 1 of the 9 markers of the subject: X9.",
                      self.good("joints", "arm.csv", "--segments", "more.vsk", "-o", "j.csv").err)

    def test_what_is_wrong_is_said(self):
        self.write("cut.vsk", skeleton(ON)[:200])
        for command in (["info", "cut.vsk"], ["joints", "arm.csv", "--segments", "cut.vsk", "-o", "j.csv"]):
            self.refused(3, ["cut.vsk", "is not XML that can be read"], *command)
        self.write("other.vsk", skeleton({"LASI": "upper"}))
        self.refused(3, ["other.vsk", "no joint lies between two segments"], "joints", "arm.csv", "--segments", "other.vsk", "-o", "j.csv")

    def test_a_real_subject(self):
        vsk = real_file("pycgm-rom/Sample_SM.vsk")
        self.assertIn("LeftTibia (LeftFemur, ball: LTIB)", self.good("info", vsk).out)


if __name__ == "__main__":
    unittest.main()
