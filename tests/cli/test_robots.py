# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Models as URDF and MJCF: from a model and from one that scale wrote, what is lost, and what is refused."""

import json
import unittest
from xml.etree import ElementTree

from support import CommandTest, real_file


class Robots(CommandTest):
    def masses(self, name, tag, key):
        return sum(float(node.get(key)) for node in ElementTree.parse(self.folder / name).getroot().iter(tag) if node.get(key))

    def changed_model(self, changes):
        """The model with other settings of coordinates, {coordinate: {tag: text}}."""
        tree = ElementTree.parse(self.model)
        for node in tree.iter("Coordinate"):
            for tag, text in changes.pop(node.get("name"), {}).items():
                found = node.find(tag)
                (ElementTree.SubElement(node, tag) if found is None else found).text = text
        self.assertEqual(changes, {})
        tree.write(self.folder / "changed.osim")
        return "changed.osim"

    def test_a_scaled_model_keeps_its_mass_in_both(self):
        self.good("scale", "-m", self.model, "-t", self.c3d, "-o", "scaled.osim", "--mass", 60)
        self.good("convert", "scaled.osim", "scaled.xml")
        self.good("convert", "scaled.osim", "scaled.urdf")
        self.assertAlmostEqual(self.masses("scaled.xml", "inertial", "mass"), 60, delta=1e-9)
        self.assertAlmostEqual(self.masses("scaled.urdf", "mass", "value"), 60, delta=1e-9)

    def test_xml_and_mjcf_are_the_same_and_losses_are_in_the_json(self):
        self.good("convert", self.model, "a.xml")
        self.good("convert", self.model, "a.mjcf")
        self.assertEqual((self.folder / "a.xml").read_text(), (self.folder / "a.mjcf").read_text())
        said = json.loads(self.good("convert", self.model, "a.urdf", "--json").out)
        self.assertTrue(any("markers cannot be stored in a .urdf file" in text for text in said["warnings"]), said)

    def test_names_of_markers_that_no_xml_has(self):
        text = self.model.read_text().replace('name="LFHD"', 'name="L F&lt;HD&gt;"')
        self.write("odd.osim", text)
        out = self.good("convert", "odd.osim", "odd.xml")
        self.assertIn("'L F<HD>' is 'L_F_HD_'", out.err)
        names = [site.get("name") for site in ElementTree.parse(self.folder / "odd.xml").getroot().iter("site")]
        self.assertIn("L_F_HD_", names)

    def test_limits_are_kept_and_locked_coordinates_fixed(self):
        changes = {"knee_angle_r": {"clamped": "true", "range": "-0.25 1.5"}, "hip_flexion_r": {"locked": "true"}}
        self.good("convert", self.changed_model(changes), "a.urdf")
        joints = {joint.get("name"): joint for joint in ElementTree.parse(self.folder / "a.urdf").getroot().iter("joint")}
        self.assertNotIn("hip_flexion_r", joints)
        self.assertEqual(joints["knee_angle_r"].get("type"), "revolute")
        limit = joints["knee_angle_r"].find("limit")
        self.assertEqual((limit.get("lower"), limit.get("upper")), ("-0.25", "1.5"))

    def test_a_fit_says_how_far_it_is_off(self):
        model = real_file("opensim-gait2354/gait2354_simbody.osim")
        self.assertRegex(self.good("convert", model, "a.urdf").err, r"'knee_r': its translation 2 follows 'knee_angle_r' .* 4\.89 mm off")
        self.assertRegex(self.good("convert", model, "a.xml").err, r"'knee_r': its translation 2 follows 'knee_angle_r' .* 0\.279 mm off")

    def test_a_file_that_is_there_is_kept(self):
        self.write("a.urdf", "mine")
        self.refused(4, "a.urdf", "convert", self.model, "a.urdf")
        self.assertEqual((self.folder / "a.urdf").read_text(), "mine")

    def test_markers_cannot_become_a_robot_nor_a_robot_a_model(self):
        self.refused(2, "different kinds of file", "convert", self.c3d, "a.urdf")
        self.good("convert", self.model, "a.urdf")
        self.refused(2, "different kinds of file", "convert", "a.urdf", "b.osim")


if __name__ == "__main__":
    unittest.main()
