# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""The gait report of kinemark analyze, from outside: figures, tables, page, norms."""

import csv
import json
import math
import re

from support import CommandTest, real_file, report_data
from test_gait import NAMES, STRIDE_S, walk
from test_measures import write_trc

COLUMNS = ("hip_flexion_l", "knee_angle_l", "ankle_angle_l", "hip_flexion_r", "knee_angle_r", "ankle_angle_r", "pelvis_tilt")


def angle(column, t):
    """deg; left and right half a stride apart."""
    phase = 2 * math.pi * (t / STRIDE_S - (0.5 if column.endswith("_r") else 0.0))
    kind = column.rsplit("_", 1)[0] if column[-2] == "_" else column
    return {
        "hip_flexion": 15 + 25 * math.cos(phase),
        "knee_angle": 30 - 25 * math.cos(phase + 0.8),
        "ankle_angle": 10 * math.sin(phase),
        "pelvis_tilt": 12 + 2 * math.sin(2 * phase),
    }[kind]


def write_motion(path, columns=COLUMNS, seconds=5.0, sd=None):
    lines = ["Q", "version=1", f"nRows={int(100 * seconds)}", f"nColumns={1 + len(columns)}", "inDegrees=yes", "endheader"]
    lines.append("\t".join(("time", *columns)))
    for i in range(int(100 * seconds)):
        values = (sd if sd is not None else angle(c, i / 100) for c in columns)
        lines.append("\t".join((f"{i / 100:.2f}", *(f"{v:.6f}" for v in values))))
    path.write_text("\n".join(lines) + "\n")


def rows_of(path):
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


class GaitPage(CommandTest):
    def setUp(self):
        super().setUp()
        self.file, self.motion = self.folder / "walk.trc", self.folder / "Q.mot"
        write_trc(self.file, walk(), names=NAMES)
        write_motion(self.motion)
        self.page, self.figures = self.folder / "gait.html", self.folder / "figures"

    def draw(self, *arguments, **options):
        result = self.good("analyze", self.file, "--measures", "gait", "--angles", self.motion, "--refits", 39, *arguments, **options)
        return result

    def shown(self):
        """What the page shows."""
        return json.loads(report_data(self.page.read_text(encoding="utf-8")))["result"]

    def figures_shown(self):
        return [figure["name"] for figure in self.shown()["figures"]]

    def test_page_and_figures(self):
        self.draw("--report", self.page, "--figures", self.figures)
        shown, drawn = self.shown(), self.figures_shown()
        self.assertEqual(
            drawn,
            ["gait_kinematics", "gait_hip_flexion_knee_flexion", "gait_knee_flexion_ankle_dorsiflexion"],
        )
        self.assertIn("Stride time", [row["title"] for row in shown["measures"]])
        self.assertTrue(shown["events"])
        self.assertIn("Pelvic tilt (deg)", shown["figures"][0]["body"])
        names = {p.name for p in self.figures.iterdir()}
        for stem in drawn:
            self.assertIn(f"{stem}.svg", names)
        self.assertLessEqual({"gait_curves.csv", "gait_pairs.csv"}, names)
        for picture in self.figures.glob("*.png"):
            self.assertEqual(picture.read_bytes()[:8], b"\x89PNG\r\n\x1a\n", picture)

    def test_formats_are_chosen(self):
        self.draw("--figures", self.figures, "--figure-formats", "svg")
        self.assertEqual({p.suffix for p in self.figures.iterdir()}, {".svg", ".csv"})

    def test_what_is_drawn_are_the_cycles_that_are_written(self):
        cycles = self.folder / "cycles.csv"
        self.draw("--figures", self.figures, "--figure-formats", "svg", "--write-cycles", cycles)
        key = lambda r: (r["curve"], r["context"], r["cycle"], r["percent"])
        written = {key(r): r for r in rows_of(cycles)}
        drawn = {key(r): r for r in rows_of(self.figures / "gait_curves.csv")}
        self.assertEqual(set(written), set(drawn))
        self.assertEqual({k[0] for k in drawn}, set(COLUMNS))
        for k, row in drawn.items():
            self.assertAlmostEqual(float(row["value"]), float(written[k]["value"]), delta=1e-6)
            if k[2] == "mean" and row["sd"]:
                self.assertAlmostEqual(float(row["sd"]), float(written[k]["sd_between"]), delta=1e-6)
        knee = [r for r in drawn.values() if r["quantity"] == "knee_flexion" and r["cycle"] == "mean" and r["context"] == "Left"]
        self.assertAlmostEqual(max(float(r["value"]) for r in knee), 55, delta=0.5)

    def test_own_error_comes_from_the_deviations_beside_the_motion(self):
        write_motion(self.folder / "Q_sd.sto", sd=3.0)
        self.draw("--figures", self.figures, "--figure-formats", "svg", "--report", self.page)
        own = {r["own_sd"] for r in rows_of(self.figures / "gait_curves.csv") if r["cycle"] == "mean"}
        self.assertEqual(own, {"3"})
        self.assertIn("own error", (self.figures / "gait_kinematics.svg").read_text())
        self.assertTrue(self.shown()["own_error"])

    def norm(self, columns=("hip_flexion", "knee_angle"), name="norm.csv", shift=0.0):
        lines = ["curve,percent,mean,sd,unit,source"]
        for column in columns:
            for p in range(0, 101, 2):
                lines.append(f"{column},{p},{angle(column + '_l', p / 100 * STRIDE_S) + shift:.4f},3,deg,Twenty adults")
        return self.write(name, "\n".join(lines) + "\n")

    def test_norm_is_drawn_with_its_source(self):
        measures = self.write("times.csv", "measure,low,high,unit\nstride_time,1.0,1.2,s\ncadence,90,95,1/min\n")
        self.draw("--figures", self.figures, "--figure-formats", "svg", "--report", self.page, "--norm", self.norm(), "--norm", measures)
        shown = self.shown()
        self.assertEqual("Twenty adults (mean ± 2 SD at each point)", shown["curve_norm"])
        cadence = next(row for row in shown["measures"] if row["title"] == "Cadence")
        self.assertEqual(cadence["norm"], "90 to 95")
        self.assertTrue(any(word.startswith("above") for word in cadence["judgement"]), cadence)
        rows = [r for r in rows_of(self.figures / "gait_curves.csv") if r["cycle"] == "mean"]
        self.assertEqual({r["quantity"] for r in rows if r["norm_low"]}, {"hip_flexion", "knee_flexion"})
        for row in rows:
            if row["norm_low"]:
                self.assertAlmostEqual(float(row["norm_high"]) - float(row["norm_low"]), 12, delta=1e-6)

    def test_a_norm_that_groups_band_makes(self):
        tables = []
        for i in range(4):
            write_motion(self.motion)
            lines = self.motion.read_text().splitlines()
            head, body = lines[:7], lines[7:]
            body = ["\t".join([r.split("\t")[0], *(f"{float(v) + i:.6f}" for v in r.split("\t")[1:])]) for r in body]
            self.motion.write_text("\n".join(head + body) + "\n")
            tables.append(self.folder / f"walker{i}.csv")
            self.draw("--write-cycles", tables[-1], "--force")
            # As it is with a recording each.
            tables[-1].write_text(tables[-1].read_text().replace("walk.trc,", f"walker{i}.trc,"))
        norm = self.folder / "norm.csv"
        self.good("groups", "band", *tables, "--group", "curve", "--subject", "file", "-o", norm)
        self.draw("--figures", self.figures, "--figure-formats", "svg", "--norm", norm)
        rows = rows_of(self.figures / "gait_curves.csv")
        self.assertTrue(all(r["norm_low"] for r in rows if r["cycle"] == "mean"))
        self.assertIn("one further curve", (self.figures / "gait_kinematics.svg").read_text())

    def test_norm_of_other_coordinates_is_one_sentence_and_the_rest_is_drawn(self):
        other = self.write("other.csv", "curve,percent,low,high\nelbow,0,1,2\nelbow,100,1,2\n")
        result = self.draw("--report", self.page, "--norm", other)
        self.assertIn("the norm's elbow fits no curve here; drawn are", result.err)
        self.assertIn("gait_kinematics", self.figures_shown())

    def test_norm_in_another_unit_is_not_drawn(self):
        other = self.write("other.csv", "curve,percent,low,high,unit\nknee_angle,0,1,2,rad\nknee_angle,100,1,2,rad\n")
        result = self.draw("--report", self.page, "--norm", other)
        self.assertIn("is in 'rad', the curve in 'deg': it is not drawn", result.err)

    def test_pairs_are_chosen(self):
        result = self.draw("--figures", self.figures, "--figure-formats", "svg", "--angle-angle", "pelvis_tilt:hip_flexion", "--angle-angle", "hip_flexion:elbow")
        self.assertTrue((self.figures / "gait_pelvis_tilt_hip_flexion.svg").is_file())
        self.assertIn("--angle-angle hip_flexion:elbow: there is no curve 'elbow'", result.err)
        rows = rows_of(self.figures / "gait_pairs.csv")
        self.assertEqual({(r["x"], r["y"]) for r in rows}, {("pelvis_tilt", "hip_flexion")})
        means = {(r["curve"], r["context"], r["percent"]): r["value"] for r in rows_of(self.figures / "gait_curves.csv") if r["cycle"] == "mean"}
        for row in rows:
            self.assertEqual(row["x_mean"], means["pelvis_tilt", row["context"], row["percent"]])

    def test_one_side_alone(self):
        write_trc(self.file, [row[:2] + row[4:] for row in walk()], names=("LHEE", "LTOE", "SACR"))
        result = self.draw("--report", self.page, "--figures", self.figures, "--figure-formats", "svg")
        self.assertIn("Right: there is no cycle from strike to strike", result.err)
        self.assertEqual({r["context"] for r in rows_of(self.figures / "gait_curves.csv")}, {"Left"})

    def test_one_cycle(self):
        write_trc(self.file, walk(2.2), names=NAMES)
        result = self.draw("--report", self.page, "--figures", self.figures, "--figure-formats", "svg")
        self.assertIn("one cycle alone has no deviation between cycles", result.err)
        self.assertTrue(all(not r["sd"] for r in rows_of(self.figures / "gait_curves.csv") if r["context"] == "Left"))

    def test_nothing_measured_in_one_curve(self):
        text = self.motion.read_text().splitlines()
        column = 1 + COLUMNS.index("knee_angle_l")
        for i in range(7, len(text)):
            cells = text[i].split("\t")
            cells[column] = "NaN"
            text[i] = "\t".join(cells)
        self.motion.write_text("\n".join(text) + "\n")
        result = self.draw("--report", self.page)
        self.assertRegex(result.err, r"Left: 1 curve without a value in \d cycles: knee_angle_l")
        self.assertIn("gait_kinematics", self.figures_shown())

    def test_a_recording_without_angles_still_has_its_measures(self):
        result = self.good("analyze", self.file, "--measures", "gait", "--refits", 0, "--report", self.page)
        self.assertIn("no angles are drawn", result.err)
        self.assertEqual(self.figures_shown(), [])
        self.assertIn("Stride time", [row["title"] for row in self.shown()["measures"]])

    def test_paths_and_walking_share_a_page(self):
        self.good("analyze", self.file, "--measures", "gait,path_length", "--angles", self.motion, "--refits", 0, "--report", self.page)
        text = self.page.read_text(encoding="utf-8")
        self.assertIn("kinemark-data", text)
        self.assertIn("gait_kinematics", text)

    def test_the_same_command_gives_the_same_bytes(self):
        self.draw("--figures", self.figures)
        first = {p.name: p.read_bytes() for p in self.figures.iterdir()}
        self.draw("--figures", self.figures, "--force")
        self.assertEqual(first, {p.name: p.read_bytes() for p in self.figures.iterdir()})

    def test_what_is_wrong_is_one_sentence(self):
        bad = self.write("bad.csv", "curve,percent,low,high\nknee,0,2,1\n")
        for status, words, arguments in (
            (2, "--norm is drawn; need --figures", ("--norm", bad)),
            (2, "--angle-angle is drawn; need --figures", ("--angle-angle", "a:b")),
            (2, "is not A:B", ("--angle-angle", "a", "--report", "p.html")),
            (3, "line 2: the band's lower end 2", ("--norm", bad, "--report", "p.html")),
            (4, "none.csv", ("--norm", "none.csv", "--report", "p.html")),
            (2, "a page ends in .html", ("--report", "p.pdf")),
        ):
            with self.subTest(words=words):
                self.refused(status, words, "analyze", self.file, "--measures", "gait", "--refits", 0, *arguments)

    def test_angles_of_segments(self):
        walking, still = (real_file(f"btk-others/PiG_{name}_FF.c3d") for name in ("Motion3", "Calibration3"))
        cycles = self.folder / "cycles.csv"
        result = self.good("analyze", walking, "--segments", "pig", "--static", still, "--refits", 0, "--report", self.page, "--figures", self.figures, "--figure-formats", "svg", "--write-cycles", cycles)
        self.assertTrue({"gait_kinematics", "gait_kinetics", "gait_hip_flexion_knee_flexion"} <= set(self.figures_shown()), result.err)
        self.assertNotIn("walking is not drawn", result.err)
        rows = [r for r in rows_of(self.figures / "gait_curves.csv") if r["cycle"] == "mean"]
        knee = [float(r["value"]) for r in rows if r["curve"] == "LKneeAngles_flexion"]
        self.assertEqual(len(knee), 101)
        self.assertTrue(45 < max(knee) < 75)
        self.assertTrue(all(float(r["own_sd"]) > 0 for r in rows if r["curve"] == "LKneeAngles_flexion"))
        force = [float(r["value"]) for r in rows if r["quantity"] == "vertical_ground_reaction" and r["context"] == "Left"]
        self.assertTrue(400 < max(force) < 1500)
        written = {(r["curve"], r["context"], r["cycle"], r["percent"]): r["value"] for r in rows_of(cycles)}
        for row in rows:
            key = (row["curve"], row["context"], "mean", row["percent"])
            if key in written and row["unit"] == "deg":
                self.assertAlmostEqual(float(row["value"]), float(written[key]), delta=1e-6)

    def test_segments_without_walking(self):
        still = real_file("btk-others/PiG_Calibration3_FF.c3d")
        out = self.folder / "segments"
        result = self.good("analyze", still, "--segments", "pig", "--static", still, "-o", out, "--report", self.page)
        self.assertIn("walking is not drawn", result.err)
        self.assertTrue((out / "angles.mot").is_file())
        self.assertFalse(self.page.exists())
        failed = self.run_in("analyze", still, "--segments", "pig", "--static", still, "--report", self.page)
        self.assertEqual(failed.status, 3, failed.err)

    def test_a_motion_needs_the_strikes_of_a_recording(self):
        for arguments, words in (
            ((self.truth, "-m", self.model, "--report", "p.html"), "need --forces FILE.c3d"),
            ((self.truth, "-m", self.model, "--figures", "f", "-o", "tables"), "--figures is an option for recordings and measures of a motion"),
        ):
            with self.subTest(words=words):
                self.refused(2, words, "analyze", *arguments)

    def test_a_motion_is_drawn_over_the_strikes_where_somebody_walks(self):
        walking = real_file("btk-others/PiG_Motion3_FF.c3d")
        motion = ("analyze", self.truth, "-m", self.model, "--refits", 0, "--force")
        drawn = self.good(*motion, "--forces", walking, "-o", "m.csv", "--report", self.page)
        self.assertNotIn("walking is not drawn", drawn.err)
        self.assertTrue(self.page.exists())
        self.good("convert", walking, "moment.c3d", "--frames", "800-810")
        moment = self.run_in(*motion, "--forces", "moment.c3d", "-o", "n.csv", "--report", "n.html")
        self.assertIn("walking is not drawn: ", moment.err)
        self.assertTrue((self.folder / "n.csv").is_file())
        self.assertFalse((self.folder / "n.html").exists())

    def test_no_letters_are_lost(self):
        self.draw("--figures", self.figures, "--figure-formats", "svg")
        for path in self.figures.glob("*.svg"):
            text = path.read_text(encoding="utf-8")
            self.assertNotRegex(text, r"\bnan\b|\binf\b")
            width = float(re.search(r'viewBox="0 0 ([0-9.]+)', text)[1])
            for x in re.findall(r'<text x="([0-9.-]+)"', text):
                self.assertTrue(0 <= float(x) <= width)


if __name__ == "__main__":
    import unittest

    unittest.main()
