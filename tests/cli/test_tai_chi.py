# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Visual3D text through every command that reads markers, and `kinemark study taichi` from outside."""

import json
import unittest

from support import CommandTest, real_file

NAMES = ("A", "B")


def v3d(rows=3):
    """Two landmarks as Visual3D exports them."""
    columns = [(name, axis) for name in NAMES for axis in "XYZ"]
    header = [["", *["a.c3d"] * 6], ["", *[name for name, _ in columns]], ["", *["LANDMARK"] * 6], ["", *["PROCESSED"] * 6],
              ["ITEM", *[axis for _, axis in columns]]]
    body = [[str(i + 1), *[f"{0.1 * i + 0.01 * k:.6f}" for k in range(6)]] for i in range(rows)]
    return "".join("\t".join(row) + "\r\n" for row in header + body)


class Visual3D(CommandTest):
    def test_info_tells_what_it_can_and_takes_a_rate(self):
        self.write("a.v3d", v3d())
        facts = json.loads(self.good("info", "a.v3d", "--json").out)
        self.assertEqual((facts["points"], facts["frames"], facts["rate_hz"]), (2, 3, None))
        facts = json.loads(self.good("info", "a.v3d", "--rate", "179", "--json").out)
        self.assertEqual(facts["rate_hz"], 179.0)

    def test_convert_needs_a_rate_and_others_refuse_one(self):
        self.write("a.v3d", v3d())
        self.refused(2, ["a.v3d", "--rate"], "convert", "a.v3d", "a.trc")
        self.good("convert", "a.v3d", "a.trc", "--rate", "179")
        self.assertEqual(json.loads(self.good("info", "a.trc", "--json").out)["rate_hz"], 179.0)
        self.refused(2, "the file stores its own rate", "convert", "a.trc", "b.trc", "--rate", "179")

    def test_damage_is_one_sentence(self):
        self.write("cut.v3d", v3d()[:40])
        self.refused(3, ["cut.v3d", "line 3"], "info", "cut.v3d")
        self.write("letters.v3d", v3d().replace("0.110000", "zero"))
        self.refused(3, ["letters.v3d", "line 7", "'zero'"], "info", "letters.v3d")

    def test_the_real_recording(self):
        path = real_file("motionmachine-taichi/taichi.v3d")
        facts = json.loads(self.good("info", path, "--rate", "179", "--json").out)
        self.assertEqual((facts["points"], facts["frames"], facts["missing"]), (21, 2990, 0))


class StudyTaiChi(CommandTest):
    def test_what_was_asked_wrong(self):
        self.write("a.v3d", v3d())
        self.refused(4, "no.v3d", "study", "taichi", "--data", "no.v3d")
        self.refused(3, ["a.v3d", "lacks FHead"], "study", "taichi", "--data", "a.v3d")
        self.refused(2, "--seeds", "study", "taichi", "--data", "a.v3d", "--seeds", "1")
        self.refused(2, "--seeds", "study", "taichi", "--seeds", "3-1")
        self.assertIn("--figures", self.good("study", "taichi", "--help").out)


if __name__ == "__main__":
    unittest.main()
