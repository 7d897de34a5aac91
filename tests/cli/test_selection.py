# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""convert takes a part of a marker file: markers, frames, new names."""

import json

from support import CommandTest, read_csv, real_file, report_data


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

    def test_findings_count_frames_as_the_file_does(self):
        self.good("convert", self.trc, "part.trc", "--frames", "41-100")
        lines = (self.folder / "part.trc").read_text().splitlines()
        row = next(i for i, line in enumerate(lines) if line.startswith("72\t"))
        number, time = lines[row].split("\t")[:2]
        lines[row] = "\t".join([number, time, *lines[row - 1].split("\t")[2:]])
        self.write("frozen.trc", "\n".join(lines) + "\n")
        out = self.run_in("clean", "frozen.trc", "clean.trc")
        self.assertRegex(out.err, r"repeat frame 71 in frame 72\b")
        self.assertNotRegex(out.err, r"\bframe 3[01]\b")

    def test_reports_count_frames_as_the_file_does(self):
        self.good("convert", self.c3d, "part.c3d", "--frames", "41-100")
        self.good("ik", "-m", self.model, "-t", "part.c3d", "-o", "q.mot", "--report", "q.html")
        self.good("report", "q.mot", "-o", "again.html")
        self.good("clean", "part.c3d", "clean.c3d", "--report", "clean.html")
        self.assertEqual(json.loads((self.folder / "q_report.json").read_text())["first_frame"], 41)
        for page in ("q.html", "again.html", "clean.html"):
            data = json.loads(report_data((self.folder / page).read_text()))
            self.assertEqual(data["summary"]["first_frame"], 41, page)

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
        self.refused(2, "is no recording", "convert", self.truth, "a.sto", "--drop", "knee*")
        self.assertFalse((self.folder / "a.trc").exists())

    def test_a_file_is_not_merged_with_itself(self):
        self.good("convert", self.c3d, "a.c3d")
        self.refused(2, ["a.c3d", "is given twice"], "convert", "a.c3d", "./a.c3d", "b.c3d", "--merge")
        self.assertFalse((self.folder / "b.c3d").exists())

    def test_parts_are_merged_into_the_file_that_they_are_of(self):
        whole = self.info(self.c3d)
        middle = whole["first_frame"] + whole["frames"] // 2
        left = ",".join(label for label in whole["labels"] if label.startswith("L"))
        self.good("convert", self.c3d, "a.c3d", "--frames", f"-{middle}")
        self.good("convert", self.c3d, "b.c3d", "--frames", f"{middle - 5}-")
        self.good("convert", "b.c3d", "left.c3d", "--select", left)
        self.good("convert", "b.c3d", "right.c3d", "--drop", left)
        self.good("convert", "a.c3d", "left.c3d", "right.c3d", "again.csv", "--merge")
        self.good("convert", self.c3d, "whole.csv")
        samples = [{(row["frame"], row["marker"]): (row["x_m"], row["z_m"], row["state"]) for row in read_csv(self.folder / name)}
                   for name in ("whole.csv", "again.csv")]
        self.assertEqual(samples[0], samples[1])

    def test_another_rate_keeps_the_path_and_says_what_was_made(self):
        before = self.info(self.c3d)
        ran = self.good("convert", self.c3d, "fast.csv", "--resample", f"{4 * before['rate_hz']}")
        self.assertNotIn("folded", ran.err)
        states = {row["state"] for row in read_csv(self.folder / "fast.csv")}
        self.assertLessEqual({"measured", "interpolated"}, states)
        self.good("convert", "fast.csv", "back.csv", "--resample", f"{before['rate_hz']}")
        self.good("convert", self.c3d, "whole.csv")
        rows = [read_csv(self.folder / name) for name in ("whole.csv", "back.csv")]
        self.assertEqual([[row[key] for key in ("marker", "x_m", "y_m", "z_m", "state")] for row in rows[0]],
                         [[row[key] for key in ("marker", "x_m", "y_m", "z_m", "state")] for row in rows[1]])

    def test_what_cannot_be_merged_or_resampled_is_said(self):
        other = self.c3d.with_name("other.c3d")
        self.good("convert", self.c3d, other, "--resample", "50", "--force")
        self.refused(3, "need one rate", "convert", self.c3d, other, "x.c3d", "--merge")
        self.refused(2, "only marker files", "convert", self.truth, "x.sto", "--resample", "50")
        self.refused(2, "--resample", "convert", self.c3d, "x.c3d", "--resample", "nan")
        self.refused(2, "--resample", "convert", self.c3d, "x.c3d", "--resample", "-3")
        self.refused(4, "absent.c3d", "convert", self.c3d, "absent.c3d", "x.c3d", "--merge")

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
