# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""What kinemark does not compute with stays in the .osim that it writes, and grows with the bodies."""

import json
import re
import xml.etree.ElementTree as ElementTree

from support import CommandTest

POINT = "<PathPoint name='{}'><socket_parent_frame>/bodyset/{}</socket_parent_frame><location>{}</location></PathPoint>"
MUSCLE = (
    "<Thelen2003Muscle name='{name}'><optimal_fiber_length>0.1</optimal_fiber_length><tendon_slack_length>0.2</tendon_slack_length>"
    "<GeometryPath name='path'><PathPointSet><objects>{points}</objects></PathPointSet>"
    "<PathWrapSet><objects>{wraps}</objects></PathWrapSet></GeometryPath></Thelen2003Muscle>"
)
POINTS = POINT.format("top", "femur_r", "0.05 0 0") + POINT.format("bottom", "tibia_r", "0.05 -0.1 0")
FORCES = "<ForceSet><objects>{}</objects></ForceSet><ControllerSet><objects><ControlSetController name='brain'/></objects></ControllerSet>".format(
    MUSCLE.format(name="straight", points=POINTS, wraps="")
    + MUSCLE.format(name="bent", points=POINTS, wraps="<PathWrap><wrap_object>knee</wrap_object></PathWrap>")
)
OLD = """<?xml version="1.0"?>
<Model name="old"><DynamicsEngine><SimbodyEngine><BodySet><objects>
<SimbodyBody name="thigh"><mass>1</mass></SimbodyBody></objects></BodySet>
<JointSet><objects><SimbodyJoint name="hip"><bodies>ground thigh</bodies></SimbodyJoint></objects></JointSet>
</SimbodyEngine></DynamicsEngine>
<ActuatorSet><objects><Thelen2003Muscle name="m"/><Thelen2003Muscle name="n"/></objects></ActuatorSet></Model>"""
FIBRE = "optimal_fiber_length"


class Muscles(CommandTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        text = cls.model.read_text()
        cls.muscles = cls.recorded.parent / "muscles.osim"
        cls.muscles.write_text(text.replace("</Model>", f"<!-- by hand -->{FORCES}</Model>"))

    def test_they_grow_with_the_bodies_and_what_is_not_exact_is_said(self):
        out = self.good("scale", "-m", self.muscles, "-t", self.c3d, "-o", "scaled.osim", "--mass", 60)
        self.assertRegex(out.err, "bend around cylinders only; these may also meet other surfaces: bent")
        report = json.loads((self.folder / "scaled_report.json").read_text())
        self.assertEqual([(m["name"], m["straight_for_wrapped"]) for m in report["muscles"]], [("straight", False), ("bent", True)])
        self.assertEqual(report["lost"], [])
        scaled = ElementTree.parse(self.folder / "scaled.osim").getroot()
        for muscle, said in zip(scaled.iter("Thelen2003Muscle"), report["muscles"], strict=True):
            self.assertAlmostEqual(said["ratio"], said["after_m"] / said["before_m"], delta=1e-12)
            self.assertAlmostEqual(float(muscle.findtext(FIBRE)), 0.1 * said["ratio"], delta=1e-12)
            place = [float(v) for v in muscle.find(".//PathPoint[@name='top']/location").text.split()]
            self.assertAlmostEqual(place[0], 0.05 * report["factors"]["femur_r"][0], delta=1e-12)
        self.assertIsNotNone(scaled.find(".//ControlSetController"))
        self.assertIn("<!-- by hand -->", (self.folder / "scaled.osim").read_text())

    def test_convert_keeps_everything_and_changes_nothing_more_the_second_time(self):
        self.good("convert", self.muscles, "a.osim")
        self.good("convert", "a.osim", "b.osim")
        text = (self.folder / "a.osim").read_text()
        self.assertEqual(text, (self.folder / "b.osim").read_text())
        self.assertIn("<!-- by hand -->", text)
        self.assertEqual(len(re.findall("<Thelen2003Muscle", text)), 2)
        self.assertNotIn("kinemark_set", text)

    def test_what_the_oldest_documents_lose_is_counted(self):
        (self.folder / "old.osim").write_text(OLD)
        out = self.good("convert", "old.osim", "new.osim")
        self.assertIn("2 Thelen2003Muscle", out.err)
        self.assertIn("its version, 10500", out.err)
