# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""One slip of the pen in a model file: what is said of it, and by whom; and files that differ and mean the same."""

import json
import re
import unittest

from support import CommandTest, table

# (what is written, what is written instead, what is said)
SLIPS = (
    ("<mass>10.65</mass>", "<mass>-1</mass>", "body 'pelvis' has a mass of -1 kg; need 0 or more"),
    ("<mass>10.65</mass>", "<mass>nan</mass>", "body 'pelvis' has a mass of nan kg"),
    ("<mass>10.65</mass>", "<mass>1e400</mass>", "body 'pelvis' has a mass of inf kg"),
    ("<mass>10.65</mass>", "<mass>10,65</mass>", "Body 'pelvis', <mass>: '10,65' is not a number"),
    ("<mass_center>-0.05 0.0823625 0<", "<mass_center>0 0<", "Body 'pelvis', <mass_center>: has 2 numbers; need three"),
    ("<mass_center>-0.05 0.0823625 0<", "<mass_center>a b c<", "Body 'pelvis', <mass_center>: 'a' is not a finite number"),
    ("<inertia>0.1045253125 0.0991115625 0.05866375 0 0 0<", "<inertia>1 1<", "<inertia>: has 2 numbers; need six"),
    ("<inertia>0.1045253125 ", "<inertia>nan ", "<inertia>: 'nan' is not a finite number"),
    ("/bodyset/head</socket_parent_frame>", "/bodyset/haed</socket_parent_frame>", "Marker 'LFHD': refers to the body or frame '/bodyset/haed', which the model does not have"),
    ("<location>0.11 0.155 -0.06<", "<location>0.11 0.155<", "Marker 'LFHD', <location>: has 2 numbers; need three"),
    ('<Marker name="RFHD">', '<Marker name="LFHD">', "marker name 'LFHD' occurs twice"),
    ('<Marker name="RFHD">', '<Marker name="">', "a marker has no name"),
    ('<Body name="abdomen">', '<Body name="pelvis">', "'/bodyset/abdomen', which the model does not have"),
    ("<range>-0.8 2.2</range>", "<range>2.2 -0.8</range>", "Coordinate 'hip_flexion_r', <range>: '2.2 -0.8' is not a range; need two numbers, the lower first"),
    ("<range>-0.8 2.2</range>", "<range>nan 2.2</range>", "coordinate 'hip_flexion_r' has default 0 and range nan to 2.2"),
    ("<default_value>0<", "<default_value>x<", "Coordinate 'pelvis_tilt', <default_value>: 'x' is not a number"),
    ('<Coordinate name="hip_adduction_r">', '<Coordinate name="hip_flexion_r">', "moves by the coordinate 'hip_adduction_r', which it does not list"),
    ("<coordinates>hip_flexion_r<", "<coordinates>hip_flexoin_r<", "CustomJoint 'hip_r': moves by the coordinate 'hip_flexoin_r', which it does not list"),
    ("<axis>0 0 1</axis>", "<axis>0 0 0</axis>", "joint 'ground_pelvis' has an axis of length zero"),
    ("<axis>0 0 1</axis>", "<axis>0 0</axis>", "TransformAxis 'rotation1', <axis>: has 2 numbers; need three"),
    ("<socket_parent>/bodyset/pelvis<", "<socket_parent>/bodyset/none<", "refers to the body or frame '/bodyset/none'"),
    ("<coefficients>1 0<", "<coefficients>1<", "<LinearFunction>: has 1 coefficients; need slope and offset"),
    ("<coefficients>1 0<", "<coefficients>nan 0<", "<coefficients>: 'nan' is not a finite number"),
    ("<gravity>0 -9.80665 0<", "<gravity>0 -9.8<", "<gravity>: has 2 numbers; need three"),
    ("<clamped>true<", "<clamped>maybe<", "<clamped>: 'maybe' is neither true nor false"),
    ("<LinearFunction>", "<LinearFuction>", "not an XML document that can be read"),
    ("</OpenSimDocument>", "", "not an XML document that can be read"),
    ("<OpenSimDocument", "<OpenSinDocument", "not an XML document that can be read"),
)


class Models(CommandTest):
    def setUp(self):
        super().setUp()
        self.text = self.model.read_text()

    def spoilt(self, old, new, name="slip.osim"):
        self.assertIn(old, self.text)
        return self.write(name, self.text.replace(old, new, 1)).name

    def test_every_command_says_the_same_of_a_slip(self):
        for old, new, words in SLIPS:
            with self.subTest(new=new):
                name = self.spoilt(old, new)
                said = self.refused(3, [name, words], "info", name)
                self.assertEqual(self.refused(3, words, *self.ik(model=name)), said)

    def test_validate_says_it_too_and_goes_on(self):
        name = self.spoilt("<mass>10.65</mass>", "<mass>-1</mass>")
        ran = self.good("validate", name, self.model, status=3)
        self.assertIn("a mass of -1 kg", ran.err)
        self.assertIn("model.osim: good", ran.err)

    def test_a_locked_coordinate_stays_where_it_is(self):
        name = self.spoilt(
            '<Coordinate name="hip_rotation_r">',
            '<Coordinate name="hip_rotation_r"><locked>true</locked><default_value>0.1</default_value>',
        )
        text = (self.folder / name).read_text()
        # The element that follows says otherwise; the first one counts nowhere, so take it out.
        head, tail = text.split("<default_value>0.1</default_value>", 1)
        tail = re.sub(r"<default_value>0</default_value>", "", tail, count=1)
        tail = re.sub(r"<locked>false</locked>", "", tail, count=1)
        self.write(name, head + "<default_value>0.1</default_value>" + tail)
        self.good(*self.ik(model=name, output="q.mot"), "--quiet")
        names, rows = table(self.folder / "q.mot")
        column = names.index("hip_rotation_r")
        for row in rows:
            self.assertAlmostEqual(row[column], 5.729577951, places=6)

    def test_names_and_order_of_markers_are_free(self):
        markers = re.findall(r"\t*<Marker name=.*?</Marker>\n", self.text, re.DOTALL)
        self.assertEqual(len(markers), 40)
        start, end = self.text.index(markers[0]), self.text.index(markers[-1]) + len(markers[-1])
        self.write("turned.osim", self.text[:start] + "".join(reversed(markers)) + self.text[end:])
        self.good(*self.ik(output="q.mot"), "--quiet")
        self.good(*self.ik(model="turned.osim", output="t.mot"), "--quiet")
        for row, other in zip(table(self.folder / "q.mot")[1], table(self.folder / "t.mot")[1], strict=True):
            for a, b in zip(row, other, strict=True):
                self.assertAlmostEqual(a, b, delta=0.01)

    def test_line_ends_and_a_byte_order_mark_are_no_matter(self):
        wanted = json.loads(self.good("info", self.model, "--json").out)
        for name, data in (
            ("crlf.osim", self.text.replace("\n", "\r\n").encode()),
            ("bom.osim", b"\xef\xbb\xbf" + self.text.encode()),
            ("flat.osim", re.sub(r">\s+<", "><", self.text).encode()),
        ):
            self.write(name, data)
            self.assertEqual({**json.loads(self.good("info", name, "--json").out), "file": wanted["file"]}, wanted, name)


if __name__ == "__main__":
    unittest.main()
