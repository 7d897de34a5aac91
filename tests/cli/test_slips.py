# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""One slip of the pen in a segments file, a setup, a marker file or a table: the sentence that names it. For models see
test_models.py."""

import re
import unittest

from support import CommandTest, changed_cell

SEGMENT_SLIPS = (
    ('"s0m1"', '"s0m0"', "marker 0 is on 's0' and on another"),
    ('"s0m1"', '"s1m0"', "marker 3 is on 's1' and on another"),
    ('"s0m1"', '"nose"', "segment 1: segment 's0': no marker in the recording is called 'nose'; it has s0m0, s0m1, s0m2, s1m0"),
    ('"s0m1"', "3", "segment 1: markers of 's0' must be names"),
    ("markers = [", 'markers = "s0m0" # [', 'segment 1: needs markers = ["NAME", ...]'),
    ('name = "s0"', 'name = "s1"', "joint 1: no segment is called 's0'"),
    ('name = "s0"', 'name = ""', "segment 1: needs a name"),
    ('name = "s0"', 'nam = "s0"', "segment 1: needs a name"),
    ('name = "s0"', "name = 7", "segment 1: needs a name"),
    ("[[segment]]", "[[segmnt]]", "'segmnt': only [[segment]], [[joint]] and [[end]] tables are read"),
    ("[[segment]]", "[segment]", "cannot redefine existing table"),
    ('parent = "s0"', 'parent = "s9"', "joint 1: no segment is called 's9'"),
    ('parent = "s0"', 'paren = "s0"', "joint 1: parent is missing; need text in quotes"),
    ('child = "s1"', 'child = "s0"', "joint 'j0' closes a circle; a tree was expected"),
    ('child = "s1"', "", "joint 1: child is missing; need text in quotes"),
)

TASK = '<IKMarkerTask name="{}"><apply>true</apply><weight>1</weight></IKMarkerTask>'
SETUP_SLIPS = (
    (3, "<weight>1", "<weight>-1", "IKMarkerTask 'LASI', <weight>: is -1; need a finite number, 0 or more"),
    (3, "<weight>1", "<weight>nan", "IKMarkerTask 'LASI', <weight>: is nan; need a finite number, 0 or more"),
    (3, "<weight>1", "<weight>abc", "IKMarkerTask 'LASI', <weight>: 'abc' is not a number"),
    (3, "<apply>true", "<apply>maybe", "IKMarkerTask 'LASI', <apply>: 'maybe' is neither true nor false"),
    (3, 'name="RASI"', 'name="LASI"', "IKMarkerTask 'LASI': occurs twice"),
    (3, 'name="LASI"', 'name=""', "a IKMarkerTask has no name"),
    (3, "<time_range>0 0.2", "<time_range>0.2 0", "<time_range>: '0.2 0' is not a range; need two times, the earlier first"),
    (3, "<time_range>0 0.2", "<time_range>0", "<time_range>: '0' is not a range"),
    (3, "<time_range>0 0.2", "<time_range>a b", "<time_range>: 'a b' is not a range"),
    (3, "<time_range>0 0.2", "<time_range>5 6", "no frame in the time range from 5 s to 6 s; the recording has 100 frames from 0 to 0.99 s"),
    (4, "model.osim<", "none.osim<", "none.osim: cannot be opened"),
    (4, "markers.trc<", "none.trc<", "none.trc: cannot be opened"),
    (2, "model_file>", "model_fill>", "no model; give --model or a --setup that names one"),
    (2, "marker_file>", "marker_fill>", "no marker file; give --markers or a --setup that names one"),
    (2, "output_motion_file>", "output_motion_fill>", "no output; give --output or a --setup that names one"),
    (3, TASK.format("LASI"), TASK.format("knee").replace("Marker", "Coordinate"), "a task names coordinate 'knee', which the model does not have"),
)

# (line, column, what is written there, what is said): lines and columns of the file count from 1.
TRC_ODDITIES = (
    (9, 3, "inf", "1 samples are infinite, taken as not seen"),
    (9, 3, "NaN", "1 samples have one or two blank coordinates, taken as not seen"),
    (9, 3, "", "1 samples have one or two blank coordinates, taken as not seen"),
    (11, 1, "77", "frame numbers jump 2 times"),
    (3, 1, "50", "header says 50 Hz, but the time column runs at 100 Hz and is used"),
    (3, 3, "200", "header says 200 frames, 100 rows are there; the rows are used"),
    (3, 4, "41", "header says 41 markers, 40 are named; the names are used"),
    (4, 3, "", "1 markers between the named ones have no name and are not read"),
)


class Segments(CommandTest):
    def setUp(self):
        super().setUp()
        self.good("simulate", "arm", "-o", "a", "--frames", 60, "--stagger", 20, "--quiet")
        self.text = (self.folder / "a/segments.toml").read_text()

    def find(self):
        return ["joints", "a/markers.c3d", "--segments", "x.toml", "-o", "o.csv", "--method", "score"]

    def test_each_slip_has_its_sentence(self):
        for old, new, words in SEGMENT_SLIPS:
            with self.subTest(new=new):
                self.assertIn(old, self.text)
                self.write("x.toml", self.text.replace(old, new, 1))
                self.refused(3, ["x.toml", words], *self.find())

    def test_a_file_without_segments(self):
        joint = "[[joint]]" + self.text.split("[[joint]]")[1]
        for text, words in (("", "holds no [[segment]]"), ("# none\n", "holds no [[segment]]"), (joint, "holds no [[segment]]"), ("[[segment]", "line 1"), ("\0\1", "line 1")):
            self.write("x.toml", text)
            self.refused(3, ["x.toml", words], *self.find())

    def test_the_file_that_joints_writes_is_one_that_it_reads(self):
        self.write("x.toml", self.text)
        self.good("joints", "a/markers.c3d", "--segments", "x.toml", "-o", "one", "--method", "score", "--quiet")
        self.good("joints", "a/markers.c3d", "--segments", "one/segments.toml", "-o", "two", "--method", "score", "--quiet")
        for name in ("centres.csv", "segments.toml"):
            self.assertEqual((self.folder / "one" / name).read_bytes(), (self.folder / "two" / name).read_bytes(), name)


class Setups(CommandTest):
    def test_each_slip_has_its_sentence(self):
        whole = (
            '<OpenSimDocument Version="40000"><InverseKinematicsTool name="s">'
            f"<model_file>{self.model}</model_file><marker_file>{self.trc}</marker_file>"
            f"<IKTaskSet><objects>{''.join(map(TASK.format, ('LASI', 'RASI', 'LPSI', 'RPSI')))}</objects></IKTaskSet>"
            "<time_range>0 0.2</time_range><output_motion_file>o.mot</output_motion_file>"
            "</InverseKinematicsTool></OpenSimDocument>"
        )
        for status, old, new, words in SETUP_SLIPS:
            with self.subTest(new=new):
                self.assertIn(old, whole)
                self.write("x.xml", whole.replace(old, new))
                self.refused(status, words, "ik", "--setup", "x.xml")
        self.write("x.xml", whole)
        self.good("ik", "--setup", "x.xml", "--quiet", "--max-rms", 1000, "--max-offset", 1000)


class MarkerFiles(CommandTest):
    def test_each_oddity_is_reported_and_the_file_is_read(self):
        for line, column, value, words in TRC_ODDITIES:
            with self.subTest(words):
                self.write("x.trc", changed_cell(self.trc.read_text(), line, column, value))
                self.assertIn(words, self.good("validate", "x.trc", status=1).err)
                self.assertIn(words, self.good("convert", "x.trc", "x.csv", "--force").err)

    def test_rows_that_are_too_short_or_too_long(self):
        lines = self.trc.read_text().split("\n")
        short = "\n".join([*lines[:9], "\t".join(lines[9].split("\t")[:20]), *lines[10:]])
        long = "\n".join([*lines[:9], lines[9] + "\t1\t2\t3", *lines[10:]])
        for text, words in (
            (short, "1 of 100 rows end before the last marker; the rest of them is taken as not seen"),
            (long, "1 of 100 rows hold cells beyond the 40 named markers; these are not read"),
        ):
            self.write("x.trc", text)
            self.assertIn(words, self.good("validate", "x.trc", status=1).err)

    def test_what_cannot_be_a_marker_file_is_refused(self):
        text = self.trc.read_text()
        for spoilt, words in (
            (changed_cell(text, 3, 5, "furlong"), "line 3: unit 'furlong' is unknown; expected mm, cm or m"),
            (changed_cell(text, 11, 1, "eleven"), "line 11, column 1: the frame number is 'eleven'; expected a number"),
            ("", "expected a TRC file"),
        ):
            self.write("x.trc", spoilt)
            self.refused(3, ["x.trc", words], "info", "x.trc")

    def test_what_is_unusual_and_right_is_good(self):
        text = re.sub(" kinemark_sum=[0-9a-f]{16}", "", self.trc.read_text())
        head, rows = text.split("\n")[:6], [line.split("\t") for line in text.split("\n")[6:]]
        tenths = ["\t".join(row[:2] + [cell and repr(float(cell) / 10) for cell in row[2:]]) for row in rows]
        centimetres = "\n".join(head + tenths).replace("\tmm\t", "\tcm\t", 1)
        self.good("validate", self.write("crlf.trc", text.replace("\n", "\r\n")), self.write("cm.trc", centimetres))
        for name, giant in (("giant.trc", text.replace("\tmm\t", "\tcm\t", 1)), ("dwarf.trc", centimetres.replace("\tcm\t", "\tmm\t", 1))):
            self.assertIn("the unit of length is another one, or this is no human body", self.good("validate", self.write(name, giant), status=1).err)
        self.good("validate", self.write("names.trc", text.replace("LFHD", "A name with spaces", 1)))
        prefixed = text.split("\n")
        prefixed[3] = re.sub(r"(?<=\t)(?=\w)(?!Time)", "Ann:", prefixed[3])
        self.write("ann.trc", "\n".join(prefixed))
        for markers, output in (("ann.trc", "a.mot"), (self.trc, "b.mot")):
            self.good(*self.ik(markers=markers, output=output), "--quiet", "--no-error-bars")
        self.assertEqual((self.folder / "a.mot").read_text().split("endheader")[1], (self.folder / "b.mot").read_text().split("endheader")[1])


if __name__ == "__main__":
    unittest.main()
