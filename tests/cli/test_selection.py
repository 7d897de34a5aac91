# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""convert takes a part of a marker file: markers, frames, new names."""

import json

from support import CommandTest, real_file


class SelectionTest(CommandTest):
    def info(self, name):
        return json.loads(self.good("info", name, "--json").out)

    def test_the_parts_of_a_file_are_the_file(self):
        whole = self.info(self.trc)
        first, count, labels = whole["first_frame"], whole["frames"], whole["labels"]
        middle = first + count // 2
        self.good("convert", self.trc, "a.trc", "--frames", f"-{middle}")
        self.good("convert", self.trc, "b.trc", "--frames", f"{middle + 1}-")
        self.assertEqual(self.info("b.trc")["first_frame"], middle + 1)
        self.good("convert", self.trc, "whole.trc")
        rows = [[line.split("\t") for line in (self.folder / name).read_text().splitlines()[6:]]
                for name in ("whole.trc", "a.trc", "b.trc")]
        parts = rows[1] + rows[2]
        self.assertEqual([row[:1] + row[2:] for row in rows[0]], [row[:1] + row[2:] for row in parts])
        for row, part in zip(rows[0], parts):
            self.assertAlmostEqual(float(row[1]), float(part[1]), places=12)
        self.good("convert", self.trc, "few.csv", "--select", f"{labels[2]},{labels[0]}", "--rename", f"{labels[0]}=new")
        self.assertEqual(self.info("few.csv")["labels"], ["new", labels[2]])

    def test_a_time_range_is_the_frames_in_it(self):
        whole = self.info(self.trc)
        rate, first = whole["rate_hz"], whole["first_frame"]
        start = (first - 1) / rate
        self.good("convert", self.trc, "a.trc", "--start", f"{start + 5 / rate:.6f}", "--end", f"{start + 9 / rate:.6f}")
        self.good("convert", self.trc, "b.trc", "--frames", f"{first + 5}-{first + 9}")
        self.assertEqual((self.folder / "a.trc").read_text().splitlines()[3:],
                         (self.folder / "b.trc").read_text().splitlines()[3:])

    def test_what_is_not_there_is_said_and_nothing_written(self):
        label = self.info(self.trc)["labels"][0]
        slip = label[:-1] + "qq" if len(label) > 4 else label + "q"
        self.refused(3, ["no marker is named", label], "convert", self.trc, "a.trc", "--select", slip)
        self.refused(3, "no frame lies in the range", "convert", self.trc, "a.trc", "--frames", "900000-")
        self.refused(3, "no marker is left", "convert", self.trc, "a.trc", "--drop", "*")
        self.refused(2, "is no range of frames", "convert", self.trc, "a.trc", "--frames", "9-3")
        self.refused(2, "OLD=NEW", "convert", self.trc, "a.trc", "--rename", label)
        self.refused(2, "only of marker files", "convert", self.truth, "a.sto", "--drop", "knee*")
        self.assertFalse((self.folder / "a.trc").exists())

    def test_a_real_file_keeps_events_analog_and_frame_numbers(self):
        source = real_file("btk-others/PiG_Motion3_FF.c3d")
        ran = self.good("convert", source, "part.c3d", "--frames", "800-900", "--drop", "*1", "--drop", "LHip*")
        self.assertIn("outside the chosen frames", ran.err)
        whole, part = self.info(source), self.info("part.c3d")
        self.assertEqual((part["first_frame"], part["frames"]), (800, 101))
        self.assertEqual(part["labels"], [name for name in whole["labels"] if name != "*1"])
        self.assertEqual([c["name"] for c in part["channels"]],
                         [c["name"] for c in whole["channels"] if not c["name"].startswith("LHip")])
        self.assertEqual(part["analog_channels"], whole["analog_channels"])
        self.assertTrue(0 < part["events"] < whole["events"])
