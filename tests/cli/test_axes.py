# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings in other axes than the model: refused with the option to give, or turned."""

import math
import unittest

from support import CommandTest, real_file, table

MOST = 1e-9  # deg, m


class AxesTest(CommandTest):
    def turned(self):
        """The recording, whose model has y up, in a laboratory with z up."""
        self.good("convert", self.trc, "turned.trc", "--rotate", "x 90")
        return self.folder / "turned.trc"

    def assert_same(self, name, other):
        names, rows = table(self.folder / name)
        self.assertEqual((names, len(rows)), (table(self.folder / other)[0], len(table(self.folder / other)[1])))
        for row, other_row in zip(rows, table(self.folder / other)[1]):
            for a, b in zip(row, other_row):
                if math.isnan(a) or math.isnan(b):
                    self.assertEqual((math.isnan(a), math.isnan(b)), (True, True))
                else:
                    self.assertLessEqual(abs(a - b), MOST)

    def test_without_option_the_error_names_it(self):
        turned = self.turned()
        for command in ("ik", "track"):
            words = [f"{turned}: z is up in the recording by the body", "give --up z"]
            self.refused(3, words, command, "-m", self.model, "-t", turned, "-o", "q.mot")
        self.refused(3, "give --up z", "scale", "-m", self.model, "--static", turned, "-o", "m.osim")

    def test_turned_it_is_the_same(self):
        turned = self.turned()
        self.good(*self.ik(markers=self.trc, output="a.mot"))
        for n, option in enumerate((["--up", "z"], ["--up", "auto"])):
            ran = self.good(*self.ik(markers=turned, output=f"b{n}.mot"), *option)
            self.assertIn("the recording was turned", ran.err)
            self.assert_same("a.mot", f"b{n}.mot")
            self.assert_same("a_sd.sto", f"b{n}_sd.sto")
        self.good(*self.ik(markers=turned, output="c.mot"), "--rotate", "x -90")
        self.assert_same("a.mot", "c.mot")

    def test_options_that_make_no_sense(self):
        self.refused(2, "--up: 'w' is not x, y, z, -x, -y or -z, or auto", *self.ik(up="w"))
        self.refused(2, "give one of them", *self.ik(up="z", rotate="x 90"))
        self.refused(2, 'is not a rotation such as "x -90"', "convert", self.trc, "b.trc", "--rotate", "x ninety")
        self.refused(2, "is no recording", "convert", self.truth, "b.sto", "--rotate", "x 90")

    def test_there_and_back_is_the_same_file(self):
        self.good("convert", self.trc, "a.trc")
        self.good("convert", "a.trc", "b.trc", "--rotate", "x 90 z -90")
        self.good("convert", "b.trc", "c.trc", "--rotate", "z 90 x -90")
        lines = [(self.folder / name).read_text().splitlines()[3:] for name in ("a.trc", "b.trc", "c.trc")]
        self.assertEqual(lines[0], lines[2])
        self.assertNotEqual(lines[0], lines[1])

    def test_real_walk_in_z_up(self):
        model = real_file("opensim-gait2354/subject01_simbody.osim")
        walk = real_file("opensim-gait2354/subject01_walk1.trc")
        self.good("convert", walk, "z.trc", "--rotate", "x 90")
        self.refused(3, ["z is up in the recording by the body", "give --up z"], "ik", "-m", model, "-t", "z.trc", "-o", "q.mot")


if __name__ == "__main__":
    unittest.main()
