# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Models as URDF and MJCF: from a model and from one that scale wrote, what is lost, and what is refused."""

import json
import unittest
from xml.etree import ElementTree

from support import CommandTest


class Robots(CommandTest):
    def masses(self, name, tag, key):
        return sum(float(node.get(key)) for node in ElementTree.parse(self.folder / name).getroot().iter(tag) if node.get(key))

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

    def test_markers_cannot_become_a_robot_nor_a_robot_a_model(self):
        self.refused(2, "different kinds of file", "convert", self.c3d, "a.urdf")
        self.good("convert", self.model, "a.urdf")
        self.refused(2, "different kinds of file", "convert", "a.urdf", "b.osim")


if __name__ == "__main__":
    unittest.main()
