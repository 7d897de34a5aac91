# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""report: one page of any marker file, or of a solved trial."""

import base64
import json
import math
import os
import re
import struct
import unittest
import zlib

from support import CommandTest, real_file, report_data

HOSTILE = "</script><img src=x onerror=alert(1)>"


def data_of(page):
    """What a page carries for its script."""
    return json.loads(report_data(page.read_text()))


def unpack(packed):
    """Packed series as lists of numbers, written from docs/formats/pages.md."""
    points, count = packed["points"], packed["series"] * packed["points"]
    planes = zlib.decompress(base64.b64decode(packed["data"]))
    width = {"int16": 2, "float32": 4}[packed["kind"]]
    assert len(planes) == width * count
    series = []
    for s in range(packed["series"]):
        word, values = 0, []
        for i in range(s * points, (s + 1) * points):
            word += sum(planes[b * count + i] << (8 * b) for b in range(width))
            if width == 2:
                values.append(packed["offset"][s] + packed["step"][s] * (word & 0xFFFF))
            else:
                values.append(struct.unpack("<f", struct.pack("<I", word & 0xFFFFFFFF))[0])
        series.append(values)
    return series


class ReportTest(CommandTest):
    def page(self, source, *options):
        self.good("report", source, "-o", "page.html", "--force", *options)
        return data_of(self.folder / "page.html")

    def test_a_page_holds_the_positions_of_the_file(self):
        data = self.page(self.trc)
        summary, scene = data["summary"], data["scene"]
        self.assertEqual(summary["schema"], "kinemark.markers_report")
        self.assertEqual(summary["trial"], self.trc.name)
        rows = [line.split("\t") for line in self.trc.read_text().splitlines()[6:] if line.strip()]
        self.assertEqual(summary["frames"], len(rows))
        series = unpack(scene["markers"]["positions_m"])
        states = zlib.decompress(base64.b64decode(scene["markers"]["states"]))
        compared = 0
        for m in range(len(scene["names"])):
            for f, row in enumerate(rows):
                cells = row[2 + 3 * m : 5 + 3 * m]
                there = len(cells) == 3 and all(c.strip() and math.isfinite(float(c)) for c in cells)
                self.assertEqual(states[m * len(rows) + f] < 4, there, (m, f))
                for k in range(3 if there else 0):
                    self.assertAlmostEqual(series[3 * m + k][f], float(cells[k]) / 1000, delta=5e-5)
                    compared += 1
        self.assertGreater(compared, 1000)
        missing = sum(m["states"]["missing"] for m in summary["markers"])
        self.assertEqual(missing, sum(s == 4 for s in states))

    def test_every_marker_file_that_info_reads_has_a_page(self):
        for ending in ("c3d", "trc", "csv", "nwb"):
            name = f"recording.{ending}"
            if ending == "nwb" and self.run_in("convert", self.c3d, name).status != 0:
                continue  # built without NWB
            if ending != "nwb":
                self.good("convert", self.c3d, name, "--force")
            data = self.page(name)
            info = json.loads(self.good("info", name, "--json").out)
            self.assertEqual([m["name"] for m in data["summary"]["markers"]], info["labels"], ending)
            self.assertEqual(data["summary"]["frames"], info["frames"], ending)

    def test_the_content_decides(self):
        (self.folder / "noending").write_bytes(self.c3d.read_bytes())
        self.assertEqual(self.page("noending")["summary"]["format"], "C3D")

    def test_up_is_found_or_given(self):
        self.assertEqual(self.page(self.trc, "--up", "x")["scene"]["up"], [1.0, 0.0, 0.0])
        self.refused(2, "--up", "report", self.trc, "-o", "other.html", "--up", "w")
        self.assertFalse((self.folder / "other.html").exists())

    def test_a_page_is_one_file_that_asks_for_nothing(self):
        self.page(self.c3d)
        text = (self.folder / "page.html").read_text()
        self.assertIn("default-src 'none'", text)
        shell = text[: text.index("<script")] + text[text.rindex("</script>") :]
        self.assertIsNone(re.search(r"""(src|href)=["']?https?:""", shell))

    def test_hostile_names_stay_text(self):
        label = json.loads(self.good("info", self.trc, "--json").out)["labels"][0]
        named = self.trc.read_text().replace(f"\t{label}\t", f"\t{HOSTILE}\t", 1)
        (self.folder / "hostile.trc").write_text(named)
        data = self.page("hostile.trc")
        self.assertEqual(data["scene"]["names"][0], HOSTILE)
        text = (self.folder / "page.html").read_text()
        self.assertNotIn("<img src=x", text)

    def test_bad_input_is_one_sentence_and_nothing_is_written(self):
        (self.folder / "torn.c3d").write_bytes(self.c3d.read_bytes()[:700])
        (self.folder / "text.trc").write_text("PathFileType\t4\nnothing\n")
        (self.folder / "picture.png").write_bytes(b"\x89PNG\r\n")
        (self.folder / "empty.c3d").write_bytes(b"")
        for name, status in (("torn.c3d", 3), ("text.trc", 3), ("picture.png", 3), ("empty.c3d", 3), ("nothing.c3d", 4)):
            ran = self.run_in("report", name, "-o", "page.html")
            self.assertEqual(ran.status, status, (name, ran.err))
            self.assertEqual(len(ran.err.strip().splitlines()), 1, ran.err)
            self.assertFalse((self.folder / "page.html").exists(), name)

    def test_a_page_that_exists_stays_and_the_input_is_safe(self):
        (self.folder / "page.html").write_text("mine")
        self.refused(4, "page.html", "report", self.trc, "-o", "page.html")
        self.assertEqual((self.folder / "page.html").read_text(), "mine")
        (self.folder / "copy.trc").write_bytes(self.trc.read_bytes())
        self.assertNotEqual(self.run_in("report", "copy.trc", "-o", "copy.trc", "--force").status, 0)
        self.assertEqual((self.folder / "copy.trc").read_bytes(), self.trc.read_bytes())

    def test_options_of_recordings_are_not_for_joint_angles(self):
        self.refused(2, "for marker files", "report", self.truth, "-o", "page.html", "--up", "y")

    def with_mesh(self, *files):
        """The model as model.osim with these meshes on its right thigh."""
        meshes = "".join(f"<Mesh><socket_frame>..</socket_frame><mesh_file>{name}</mesh_file></Mesh>" for name in files)
        body = re.search(r'<Body name="femur_r">.*?</Body>', self.model.read_text(), re.DOTALL)[0]
        shown = body.replace("</Body>", f"<attached_geometry>{meshes}</attached_geometry></Body>")
        (self.folder / "model.osim").write_text(self.model.read_text().replace(body, shown))

    def test_meshes_of_a_model_are_found_and_named(self):
        self.with_mesh("bone.obj")
        (self.folder / "bones").mkdir()
        (self.folder / "bones" / "Bone.OBJ").write_text("v 0 0 0\nv 0 -0.4 0\nv 0.05 0 0\nf 1 2 3\n")
        ik = ("ik", "-m", "model.osim", "-t", self.c3d, "-o", "q.mot", "--force")
        self.good(*ik, "--report", "page.html")
        bodies = data_of(self.folder / "page.html")["scene"]["bodies"]
        self.assertNotIn("meshes", bodies)
        self.assertRegex(bodies["meshes_note"], r"^the mesh file that the model names was not found .* --geometry FOLDER: bone\.obj$")
        self.good(*ik, "--report", "page.html", "--geometry", "bones")
        at_once = data_of(self.folder / "page.html")["scene"]["bodies"]
        self.assertEqual([at_once["names"][b] for b in at_once["meshes"]["body"]], ["femur_r"])
        self.assertEqual(at_once["meshes_note"], "1 body drawn from the model's meshes")
        self.assertNotIn("drawn from the model's meshes", bodies["meshes_note"])
        self.assertNotIn("was not found beside it, in Geometry/ there", at_once["meshes_note"])
        self.assertNotIn(" triangles", at_once["meshes_note"])
        self.assertEqual(at_once["meshes"]["triangles"], [1])
        turn = unpack(at_once["meshes"]["turn"])
        for f in range(len(turn[0])):
            self.assertAlmostEqual(math.hypot(*(turn[k][f] for k in range(4))), 1, delta=2e-3)
        later = self.page("q.mot", "--geometry", "bones")["scene"]["bodies"]
        self.assertEqual(later["meshes"]["body"], at_once["meshes"]["body"])
        self.good("track", "-m", "model.osim", "-t", self.c3d, "-o", "t.mot", "--report", "t.html", "--geometry", "bones")
        self.assertEqual(data_of(self.folder / "t.html")["scene"]["bodies"]["meshes"]["body"], at_once["meshes"]["body"])
        self.refused(4, "there is no folder none", *ik, "--report", "page.html", "--geometry", "none")
        self.refused(2, "--geometry is for joint angles", "report", self.c3d, "-o", "page2.html", "--geometry", "bones")

    def test_a_model_may_name_anything_as_a_mesh(self):
        (self.folder / "bad.vtp").write_bytes(b"\x00" * 100)
        (self.folder / "folder.obj").mkdir()
        os.mkfifo(self.folder / "pipe.stl")
        (self.folder / "endless.obj").symlink_to("/dev/zero")
        self.with_mesh("bad.vtp", "folder.obj", "pipe.stl", "endless.obj", "/etc/passwd", "../../../etc/passwd", "a" * 5000, "x.asc", "&lt;script&gt;")
        self.good("ik", "-m", "model.osim", "-t", self.c3d, "-o", "q.mot", "--report", "page.html")
        bodies = data_of(self.folder / "page.html")["scene"]["bodies"]
        self.assertNotIn("meshes", bodies)
        self.assertIn("bad.vtp: is not XML", bodies["meshes_note"])
        self.assertIn("folder.obj", bodies["meshes_note"])
        self.assertLess(len(bodies["meshes_note"]), 1000)
        self.assertNotIn("root:", (self.folder / "page.html").read_text())

    def test_cycles_are_those_of_the_events_also_after_an_edit(self):
        strikes = [0.1 + 0.55 * i for i in range(4)]
        self.good("simulate", "subject", "-o", "in", "--duration", 2)
        (self.folder / "walk.c3d").write_bytes((self.folder / "in" / "markers.c3d").read_bytes())
        self.assertIsNone(self.page("walk.c3d")["summary"]["cycles"])
        for time in strikes:
            self.good("edit", "walk.c3d", "--mark", "Foot Strike", "--context", "Left", "--at", f"{time}s")
        self.good("convert", "walk.c3d", "events.c3d", "--edits", "beside")
        cycles = self.page("events.c3d")["summary"]["cycles"]
        self.assertEqual(cycles["Right"], [])
        self.assertEqual(len(cycles["Left"]), 3)
        for found, start in zip(cycles["Left"], strikes):
            self.assertAlmostEqual(found[0], start, delta=0.006)
            self.assertAlmostEqual(found[1], start + 0.55, delta=0.011)

    def test_real_recordings_have_small_pages(self):
        for name, up in (
            ("pycgm-rom/Sample_Static.c3d", [0, 0, 1]),
            ("btk-others/PiG_Motion3_FF.c3d", [0, 0, 1]),
            ("btk-others/FunctionalWalk.c3d", [0, 0, 1]),
            ("opensim-core-formats/walking2.c3d", [0, 0, 1]),
            ("opensim-gait2354/subject01_walk1.trc", [0, 1, 0]),
            ("cmu-mocap/02_05.amc", [0, 1, 0]),
        ):
            data = self.page(real_file(name))
            self.assertEqual(data["scene"]["up"], up, name)
            self.assertEqual(data["scene"]["frame_step"], 1, name)
            self.assertLess((self.folder / "page.html").stat().st_size, 1_500_000, name)


if __name__ == "__main__":
    unittest.main()
