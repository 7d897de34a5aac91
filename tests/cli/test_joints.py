# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark joints` from outside: methods, segments, files, bad input."""

import json
import math
import random
import unittest

from support import CommandTest, read_csv, real_file, report_data

SEGMENTS = """
[[segment]]
name = "upper"
markers = ["u0", "u1", "u2", "u3"]
[[segment]]
name = "fore"
markers = ["f0", "f1", "f2", "f3"]
[[joint]]
name = "elbow"
parent = "upper"
child = "fore"
"""
UPPER = [(0.03, 0.0, -0.12), (-0.02, 0.025, -0.09), (-0.015, -0.026, -0.06), (0.03, 0.01, -0.03)]
FORE = [(0.03, 0.0, 0.03), (-0.015, 0.026, 0.06), (-0.015, -0.026, 0.09), (0.02, 0.02, 0.12)]


def rotation(rng):
    """A rotation drawn evenly from all, as three rows."""
    q = [rng.gauss(0, 1) for _ in range(4)]
    n = math.sqrt(sum(c * c for c in q))
    w, x, y, z = (c / n for c in q)
    return [
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    ]


def arm(frames=120, noise=0.0005, moving=True, lose=None, slip=0.0, seed=1):
    """Lines of a CSV recording of two segments about an elbow, and the elbow in every frame."""
    rng = random.Random(seed)
    rows, elbows = [], []
    fixed = rotation(rng)
    for f in range(frames):
        elbow = [rng.uniform(-0.2, 0.2) for _ in range(3)]
        elbows.append(elbow)
        for letter, positions in (("u", UPPER), ("f", FORE)):
            pose = rotation(rng) if moving else fixed
            for k, position in enumerate(positions):
                name = f"{letter}{k}"
                local = (position[0], position[1], position[2] + (slip if name == "f0" and 2 * f >= frames else 0.0))
                x = [e + sum(r * p for r, p in zip(row, local)) + rng.gauss(0, noise) for e, row in zip(elbow, pose)]
                if lose and lose(f, name):
                    rows.append([f, f / 60, name, "", "", "", "missing"])
                else:
                    rows.append([f, f / 60, name, *x, "measured"])
    lines = ["frame,time_s,marker,x_m,y_m,z_m,state"] + [",".join(map(str, row)) for row in rows]
    return "\n".join(lines) + "\n", elbows


class Joints(CommandTest):
    def setUp(self):
        super().setUp()
        text, self.elbows = arm()
        self.write("arm.csv", text)
        self.write("segments.toml", SEGMENTS)

    def rms_mm(self, name):
        rows = [row for row in read_csv(self.folder / name) if row["x_m"]]
        squares = [
            sum((float(row[key]) - truth) ** 2 for key, truth in zip(("x_m", "y_m", "z_m"), self.elbows[int(row["frame"])]))
            for row in rows
        ]
        return 1e3 * math.sqrt(sum(squares) / len(squares)), rows

    def test_every_method_finds_the_elbow(self):
        for method in ("articulated", "score", "gamage", "gamage-plain", "constant-distance"):
            with self.subTest(method=method):
                ran = self.good("joints", "arm.csv", "--segments", "segments.toml", "--method", method, "-o", f"{method}.csv")
                rms, rows = self.rms_mm(f"{method}.csv")
                self.assertLess(rms, 25.0 if method == "constant-distance" else 1.5)
                self.assertEqual({row["marker"] for row in rows}, {"elbow"})
                self.assertIn("deg of motion", ran.err)
                self.assertGreater(float(rows[0]["sd_x_m"]), 0.0)

    def test_hinge_methods_run(self):
        for method in ("sara", "cylinder"):
            self.assertIn("axis", self.good("joints", "arm.csv", "--segments", "segments.toml", "--method", method).err)

    def test_folder_of_results(self):
        self.good("joints", "arm.csv", "--segments", "segments.toml", "-o", "out")
        self.assertEqual(
            sorted(p.name for p in (self.folder / "out").iterdir()), ["centres.c3d", "centres.csv", "segments.toml", "skeleton.json"]
        )
        skeleton = json.loads((self.folder / "out" / "skeleton.json").read_text(encoding="utf-8"))
        self.assertEqual(skeleton["schema"], "kinemark.skeleton")
        self.assertEqual(skeleton["joints"][0]["name"], "elbow")
        self.assertEqual(sum(skeleton["joints"][0]["frames"].values()), 120)
        self.refused(4, "--force", "joints", "arm.csv", "--segments", "segments.toml", "-o", "out")
        self.refused(2, "out/segments.toml: is the file that is read", "joints", "arm.csv", "--segments", "out/segments.toml", "-o", "out", "--force")
        self.good("joints", "arm.csv", "--segments", "out/segments.toml", "-o", "again")
        self.good("joints", "arm.csv", "--segments", "segments.toml", "-o", "out", "--force")

    def test_the_page_holds_the_document_and_the_skeleton_in_space(self):
        self.good("joints", "arm.csv", "--segments", "segments.toml", "--report", "page.html", "-o", "out")
        data = json.loads(report_data((self.folder / "page.html").read_text()))
        self.assertEqual(data["summary"]["kind"], "joints")
        self.assertEqual(data["result"]["joints"], json.loads((self.folder / "out" / "skeleton.json").read_text())["joints"])
        self.assertEqual(data["scene"]["skeleton"]["names"], ["elbow"])
        self.refused(4, ["page.html", "--force"], "joints", "arm.csv", "--segments", "segments.toml", "--report", "page.html", "-o", "other")
        self.assertFalse((self.folder / "other").exists())
        self.refused(2, "ends in .html", "joints", "arm.csv", "--segments", "segments.toml", "--report", "page.pdf")

    def test_segments_from_the_data(self):
        printed = json.loads(self.good("joints", "arm.csv", "--method", "score", "--json", "-o", "centres.csv").out)
        self.assertEqual([len(s["markers"]) for s in printed["segments"]], [4, 4])
        self.assertEqual(len(printed["topology"]["markers"]), 8)
        self.assertLess(self.rms_mm("centres.csv")[0], 1.5)
        self.assertTrue((self.folder / "centres_skeleton.json").is_file())

    def test_names_of_a_known_set_are_the_segments(self):
        text = self.folder.joinpath("arm.csv").read_text()
        for old, new in (("u", "RUA"), ("f", "RFA")):
            for k in range(4):
                text = text.replace(f",{old}{k},", f",{new}{k + 1},")
        self.write("named.csv", text)
        ran = self.good("joints", "named.csv", "-o", "out", "--json")
        self.assertIn("Segments from the markers' names (ISB); 1 of 1 joints are known.", ran.err)
        self.assertNotIn("Not determined", ran.err)
        self.assertNotIn("their names are of no known set", ran.err)
        printed = json.loads(ran.out)
        self.assertEqual(printed["segmentation"]["from"], "names")
        self.assertEqual([joint["name"] for joint in printed["joints"]], ["elbow_r"])
        self.assertNotIn("topology", printed)
        self.assertIn('name = "upper_arm_r"', (self.folder / "out/segments.toml").read_text())
        self.assertLess(self.rms_mm("out/centres.csv")[0], 1.5)

    def test_markers_that_a_model_made_are_left_out(self):
        lines = self.folder.joinpath("arm.csv").read_text().splitlines()
        made = [f"{f},{f / 60},RKJC,{x},{y},{z},measured" for f, (x, y, z) in enumerate(self.elbows)]
        self.write("more.csv", "\n".join(lines + made) + "\n")
        ran = self.good("joints", "more.csv", "--method", "score", "--json")
        self.assertIn("Points that a model made of markers, by their names, were left out: RKJC.", ran.err)
        printed = json.loads(ran.out)
        self.assertEqual(printed["segmentation"]["model_outputs"], ["RKJC"])
        self.assertNotIn("RKJC", [marker["name"] for marker in printed["topology"]["markers"]])
        self.assertNotIn("Points that a model made", self.good("joints", "arm.csv", "--method", "score").err)

    def test_two_markers_are_no_body(self):
        self.write("few.csv", arm(lose=lambda f, name: name[1] in "23")[0])
        for method in ("articulated", "score"):
            ran = self.good("joints", "few.csv", "--method", method, "-o", method, status=1)
            self.assertIn("No joint is determined. Name the segments of the body in a file (--segments)", ran.err)
            self.assertNotIn("centre known to", ran.err)
            self.assertEqual([path.name for path in (self.folder / method).iterdir()], ["skeleton.json"])
            skeleton = json.loads((self.folder / method / "skeleton.json").read_text())
            self.assertEqual(skeleton["joints"], [])
            self.assertEqual(skeleton["segmentation"]["known"], [])

    def test_a_joint_that_is_not_determined_has_its_reason(self):
        text = arm(lose=lambda f, name: name in ("f2", "f3"))[0]
        for old, new in (("u", "RUA"), ("f", "RFA")):
            for k in range(4):
                text = text.replace(f",{old}{k},", f",{new}{k + 1},")
        self.write("few.csv", text)
        ran = self.good("joints", "few.csv", "-o", "out", "--report", "page.html", status=1)
        words = "Not determined: joint 'elbow_r' between upper_arm_r [RUA1, RUA2, RUA3, RUA4] and forearm_r [RFA1, RFA2]: "
        self.assertIn(words + "forearm_r has 2 markers (RFA1, RFA2), and a pose needs three that are not in a line.", ran.err)
        data = json.loads(report_data((self.folder / "page.html").read_text()))
        self.assertEqual(data["result"]["segmentation"]["not_determined"][0]["name"], "elbow_r")

    def test_a_marker_that_slips_is_named(self):
        self.write("slip.csv", arm(frames=300, slip=0.015)[0])
        ran = self.good("joints", "slip.csv", "--segments", "segments.toml", "--method", "score")
        self.assertIn("'f0' moved", ran.err)
        # The articulated fit has a sentence of its own: a marker is named once.
        ran = self.good("joints", "slip.csv", "--segments", "segments.toml")
        self.assertIn("marker 'f0' sits", ran.err)
        self.assertNotIn("'f0' moved", ran.err)
        self.assertNotIn("?.", ran.err)

    def test_the_rate_of_a_file_that_tells_none(self):
        rows = [line.split(",") for line in arm()[0].splitlines()[1:]]
        names = list(dict.fromkeys(row[2] for row in rows))
        columns = [(name, axis) for name in names for axis in range(3)]
        position = {(int(row[0]), row[2]): row[3:6] for row in rows}
        head = [
            ["", *("made.c3d" for _ in columns)],
            ["", *(name for name, _ in columns)],
            ["", *("LANDMARK" for _ in columns)],
            ["", *("PROCESSED" for _ in columns)],
            ["ITEM", *("XYZ"[axis] for _, axis in columns)],
        ]
        body = [[str(f + 1), *(position[f, name][axis] for name, axis in columns)] for f in range(120)]
        self.write("arm.v3d", "\n".join("\t".join(row) for row in head + body) + "\n")
        self.refused(2, ["arm.v3d", "--rate"], "joints", "arm.v3d", "--segments", "segments.toml")
        given = ("joints", "arm.v3d", "--segments", "segments.toml", "--rate", "60", "--json")
        self.assertEqual(json.loads(self.good(*given).out)["rate_hz"], 60)

    def test_soft_tissue(self):
        printed = json.loads(self.good("joints", "arm.csv", "--segments", "segments.toml", "--soft-tissue", "--json").out)
        noise = {marker["name"]: marker["sd_m"] for marker in printed["marker_noise"]}
        self.assertEqual(sorted(noise), ["f0", "f1", "f2", "f3", "u0", "u1", "u2", "u3"])
        for name, sd in noise.items():
            self.assertAlmostEqual(1e3 * sd, 0.5, delta=0.2, msg=name)
        self.refused(2, ["--soft-tissue", "score"], "joints", "arm.csv", "--method", "score", "--soft-tissue")

    def test_no_complete_frame(self):
        self.write("gaps.csv", arm(lose=lambda f, name: int(name[1]) == f % 4)[0])
        options = ("joints", "gaps.csv", "--segments", "segments.toml", "--method")
        ran = self.good(*options, "constant-distance")
        self.assertIn("no two frames show all 8 markers; the distances are those of 6 markers in 30 of the 30 frames", ran.err)
        self.assertNotIn("no two frames show all", self.good("joints", "arm.csv", *options[2:], "constant-distance").err)
        self.good(*options, "score", "-o", "centres.csv")
        self.assertLess(self.rms_mm("centres.csv")[0], 5.0)
        self.write("few.csv", arm(lose=lambda f, name: name in ("u0", "u1", "u2"))[0])
        self.refused(3, ["few.csv", "no frames show all 8 markers"], "joints", "few.csv", *options[2:], "constant-distance")

    def test_the_whole_arm_and_its_figure(self):
        self.good("simulate", "macaque", "-o", "m", "--duration", 8, "--tip", "--quiet")
        of_arm = ("joints", "m/markers.c3d", "--segments", "m/segments.toml")
        ran = self.good(*of_arm, "-o", "out", "--figures", "arm.svg")
        self.assertIn("shoulder (fixed): ", ran.err)
        self.assertIn("wrist (end): marker 'w0'", ran.err)
        ends = {end["name"]: end for end in json.loads((self.folder / "out/skeleton.json").read_text())["ends"]}
        self.assertEqual([ends["shoulder"]["kind"], ends["wrist"]["kind"]], ["fixed", "marker"])
        for name, length in (("shoulder", 0.150), ("wrist", 0.160)):
            self.assertAlmostEqual(ends[name]["length_m"], length, delta=4 * ends[name]["length_sd_m"], msg=name)
        shoulder = [[float(row[f"{axis}_m"]) for axis in "xyz"] for row in read_csv(self.folder / "out/centres.csv") if row["marker"] == "shoulder"]
        self.assertEqual(len(shoulder), 480)
        self.assertTrue(all(place == shoulder[0] for place in shoulder))
        self.assertLess(math.hypot(*shoulder[0]), 0.003)
        self.good("joints", "m/markers.c3d", "--segments", "out/segments.toml", "-o", "again")
        self.assertEqual((self.folder / "again/centres.csv").read_text().splitlines()[-1], (self.folder / "out/centres.csv").read_text().splitlines()[-1])
        picture = (self.folder / "arm.svg").read_text()
        self.assertTrue(picture.startswith("<svg xmlns="))
        self.assertEqual(picture.count('stroke="#000000"'), 8)
        self.assertGreater(picture.count("<circle"), 4 * 6)
        self.refused(4, ["arm.svg", "--force"], *of_arm, "--figures", "arm.svg")
        self.refused(2, "figures are .svg", *of_arm, "--figures", "arm.png")
        self.refused(2, "--figures draws one recording", "joints", "m/markers.c3d", "m/markers.trc", "-o", "all", "--figures", "b.svg")
        self.write("bad.toml", (self.folder / "m/segments.toml").read_text().replace('marker = "w0"', 'marker = "u0"'))
        self.refused(3, ["bad.toml: end 1", "'u0' is no marker of segment 'forearm'"], "joints", "m/markers.c3d", "--segments", "bad.toml")

    def test_what_cannot_be_known_is_one_sentence(self):
        self.write("still.csv", arm(moving=False)[0])
        self.refused(3, ["still.csv", "no joint can be found"], "joints", "still.csv")
        self.write("two.csv", arm(lose=lambda f, name: name not in ("u0", "f0"))[0])
        two = '[[segment]]\nname = "a"\nmarkers = ["u0"]\n[[segment]]\nname = "b"\nmarkers = ["f0"]\n'
        self.write("two.toml", two)
        self.refused(3, "two.csv", "joints", "two.csv", "--segments", "two.toml")
        self.refused(3, "two.csv", "joints", "two.csv", "--segments", "two.toml", "--method", "score")
        self.write("one.toml", '[[segment]]\nname = "all"\nmarkers = ["u0", "u1", "u2", "f0"]\n')
        self.refused(3, "arm.csv", "joints", "arm.csv", "--segments", "one.toml")
        self.refused(3, "one segment", "joints", "arm.csv", "--segments", "one.toml", "--method", "score")

    def test_a_joint_that_never_moves_is_wide(self):
        self.write("still.csv", arm(moving=False)[0])
        ran = self.good("joints", "still.csv", "--segments", "segments.toml", "--method", "score", "--json")
        joint = json.loads(ran.out)["joints"][0]
        self.assertGreater(joint["centre_sd_m"], 0.03)
        self.assertNotIn("centre known", joint["words"])

    def test_wrong_words_and_files(self):
        self.refused(2, ["best", "articulated"], "joints", "arm.csv", "--method", "best")
        self.refused(2, ["left", "parent"], "joints", "arm.csv", "--method", "score", "--sides", "left")
        self.refused(2, ["knee", "hinge"], "joints", "arm.csv", "--kind", "knee")
        self.refused(2, "-1 mm", "joints", "arm.csv", "--noise", -1)
        for name in ("x.mot", "x.v3d", "x.osim", "no/folder/x.xyz"):
            self.refused(2, [name, ".c3d, .trc, .nwb, .mat, .csv and .glb"], "joints", "arm.csv", "-o", name)
        self.refused(4, "none.c3d", "joints", "none.c3d")
        self.write("bad.c3d", "not a C3D file")
        self.refused(3, "bad.c3d", "joints", "bad.c3d")
        self.write("bad.toml", "[[segment]]\nname = 3\n")
        self.refused(3, "bad.toml", "joints", "arm.csv", "--segments", "bad.toml")
        self.write("other.toml", SEGMENTS.replace("u3", "XYZ"))
        self.refused(3, ["other.toml", "XYZ"], "joints", "arm.csv", "--segments", "other.toml")

    def test_a_real_knee(self):
        knee = real_file("biobuddy/right_knee.c3d")
        femur, tibia = ["RGT", "RTHI1", "RTHI2", "RTHI3"], ["RATT", "RLM", "RSPH", "RLEG1", "RLEG2", "RLEG3"]
        self.write("knee.toml", "".join(f"[[segment]]\nname = {n!r}\nmarkers = {json.dumps(m)}\n" for n, m in (("femur", femur), ("tibia", tibia))))
        printed = json.loads(self.good("joints", knee, "--segments", "knee.toml", "--method", "score", "--json").out)
        self.assertEqual(printed["joints"][0]["kind"], "hinge")
        self.assertGreater(printed["joints"][0]["range_of_motion_deg"], 30.0)


if __name__ == "__main__":
    unittest.main()
