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
        self.refused(2, "stores its own rate", "info", "cut.bvh", "--rate", "100")

    def test_the_content_decides(self):
        self.write("walk.trc", BVH)
        self.assertEqual(json.loads(self.good("info", "walk.trc", "--json").out)["format"], "BVH")


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
