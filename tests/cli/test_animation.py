# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Files of animators, as a user meets them."""

import json
import unittest

from support import CommandTest

BVH = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT Chest
  {
    OFFSET 0 90 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 0 80 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.01
0 100 0 0 0 0 0 0 0
0 100 0 90 0 0 0 0 0
"""


class Bvh(CommandTest):
    def test_info_shows_points_channels_and_the_unit_that_was_taken(self):
        self.write("walk.bvh", BVH)
        facts = json.loads(self.good("info", "walk.bvh", "--json").out)
        self.assertEqual((facts["format"], facts["frames"], facts["rate_hz"], facts["units"]), ("BVH", 2, 100.0, ""))
        self.assertEqual(facts["labels"], ["Hips", "Chest", "Chest_end"])
        self.assertEqual([c["name"] for c in facts["channels"]], ["Hips_angles_ZXY", "Chest_angles_ZXY"])
        self.assertIn("cm is taken", facts["warnings"][0])

    def test_points_become_any_format_of_markers_and_channels_stay_in_c3d(self):
        self.write("walk.bvh", BVH)
        self.good("convert", "walk.bvh", "walk.c3d")
        facts = json.loads(self.good("info", "walk.c3d", "--json").out)
        self.assertEqual(facts["labels"], ["Hips", "Chest", "Chest_end"])
        self.assertEqual([(c["name"], c["kind"], c["unit"]) for c in facts["channels"]],
                         [("Hips_angles_ZXY", "angle", "deg"), ("Chest_angles_ZXY", "angle", "deg")])
        said = self.good("convert", "walk.bvh", "walk.csv").err
        self.assertIn("2 channels that are no markers (Hips_angles_ZXY to Chest_angles_ZXY) cannot be stored", said)
        last = (self.folder / "walk.csv").read_text().splitlines()[-1].split(",")
        for value, expected in zip(last[3:6], (-1.7, 1.0, 0.0)):
            self.assertAlmostEqual(float(value), expected, places=12)

    def test_a_wrong_file_is_one_sentence_with_its_line(self):
        self.write("cut.bvh", BVH[:120])
        self.refused(3, ["cut.bvh", "line 6"], "info", "cut.bvh")
        self.write("letters.bvh", BVH.replace("0 100 0 90", "0 100 0 left"))
        self.refused(3, ["letters.bvh", "line 20", "'left'"], "convert", "letters.bvh", "a.trc")
        self.refused(3, ["cut.bvh", "line 6"], "info", "cut.bvh", "--rate", "100")
        self.write("whole.bvh", BVH)
        self.refused(2, "stores its own rate", "info", "whole.bvh", "--rate", "100")

    def test_the_content_decides(self):
        self.write("walk.trc", BVH)
        self.assertEqual(json.loads(self.good("info", "walk.trc", "--json").out)["format"], "BVH")


ASF = """:units
  length 0.45
  angle deg
:root
  order TX TY TZ RX RY RZ
  axis XYZ
  position 0 0 0
  orientation 0 0 0
:bonedata
  begin
    id 1
    name leg
    direction 0 -1 0
    length 30
    axis 0 0 0 XYZ
    dof rx
  end
:hierarchy
  begin
    root leg
  end
"""
AMC = ":FULLY-SPECIFIED\n:DEGREES\n1\nroot 0 30 0 0 0 0\nleg 0\n2\nroot 0 30 0 0 0 0\nleg -90\n"


class Amc(CommandTest):
    def test_the_skeleton_beside_it_makes_points(self):
        self.write("01.asf", ASF)
        self.write("01_02.amc", AMC)
        said = self.good("convert", "01_02.amc", "a.csv", "--rate", "120").err
        self.assertIn("its skeleton is 01.asf", said)
        last = (self.folder / "a.csv").read_text().splitlines()[-1].split(",")
        self.assertEqual(last[2], "leg_end")
        for value, expected in zip(last[3:6], (0.0, 30 * 0.0254 / 0.45, 30 * 0.0254 / 0.45)):
            self.assertAlmostEqual(float(value), expected, places=12)

    def test_a_skeleton_can_be_given_or_be_missing(self):
        self.write("walk.amc", AMC)
        facts = json.loads(self.good("info", "walk.amc", "--json").out)
        self.assertEqual((facts["labels"], facts["rate_hz"]), ([], None))
        self.assertEqual([c["name"] for c in facts["channels"]], ["root_position_XYZ", "root_angles_XYZ", "leg_angles_X"])
        (self.folder / "other").mkdir()
        self.write("other/s.asf", ASF)
        self.good("convert", "walk.amc", "a.c3d", "--rate", "120", "--skeleton", "other/s.asf")
        self.assertEqual(json.loads(self.good("info", "a.c3d", "--json").out)["labels"], ["root", "leg_end"])

    def test_what_is_wrong_is_said(self):
        self.write("walk.amc", AMC)
        self.write("s.asf", ASF.replace("root leg", "root arm"))
        self.refused(2, ["walk.amc", "--rate"], "convert", "walk.amc", "a.csv")
        self.refused(3, ["s.asf", "line 20", "'arm'"], "convert", "walk.amc", "a.csv", "--rate", "120")
        self.refused(4, "no.asf", "convert", "walk.amc", "a.csv", "--rate", "120", "--skeleton", "no.asf")
        self.refused(2, "--skeleton", "convert", self.c3d, "a.csv", "--skeleton", "s.asf")


class Skeleton(CommandTest):
    """A motion and its model become a skeleton."""

    def test_a_motion_becomes_a_bvh_with_its_model(self):
        q, model = self.truth, self.model
        said = self.good("convert", q, "walk.bvh", "--model", model).err
        self.assertIn("lengths are in cm and y is up", said)
        facts = json.loads(self.good("info", "walk.bvh", "--json").out)
        self.assertIn("pelvis", facts["labels"])
        self.assertGreater(len(facts["channels"]), 5)

    def test_a_motion_becomes_a_glb_and_so_do_markers(self):
        self.good("convert", self.truth, "walk.glb", "--model", self.model)
        names = [node["name"] for node in self.scene("walk.glb")["nodes"]]
        self.assertIn("pelvis", names)
        said = self.good("convert", self.c3d, "markers.glb").err
        self.assertIn("which way is up", said)
        labels = json.loads(self.good("info", self.c3d, "--json").out)["labels"]
        self.assertEqual([node["name"] for node in self.scene("markers.glb")["nodes"]], labels)
        self.good("convert", self.c3d, "turned.glb", "--rotate", "x -90", "--select", f"{labels[0]},{labels[1]}")
        self.assertEqual(len(self.scene("turned.glb")["nodes"]), 2)
        self.refused(3, "markers.glb", "info", "markers.glb")

    def scene(self, name):
        raw = (self.folder / name).read_bytes()
        self.assertEqual((raw[:4], int.from_bytes(raw[8:12], "little")), (b"glTF", len(raw)))
        return json.loads(raw[20 : 20 + int.from_bytes(raw[12:16], "little")])

    def test_what_does_not_go_together_is_said(self):
        q, model = self.truth, self.model
        self.refused(2, "made with the model that they are of", "convert", q, "walk.bvh")
        self.refused(2, "made with the model that they are of", "convert", self.c3d, "walk.bvh")
        self.refused(2, "--model", "convert", q, "walk.sto", "--model", model)
        self.refused(4, "no.osim", "convert", q, "walk.bvh", "--model", "no.osim")
        self.write("walk.bvh", model.read_bytes())
        self.refused(2, "walk.bvh", "convert", q, "walk.bvh", "--model", "walk.bvh", "--force")


if __name__ == "__main__":
    unittest.main()
