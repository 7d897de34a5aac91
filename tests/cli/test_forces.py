# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Forces on the body, from plates in any format and from tables, from outside."""

import json

from support import CommandTest, real_file, report_data, table


class Forces(CommandTest):
    def setUp(self):
        super().setUp()
        self.walk = real_file("btk-others/PiG_Motion3_FF.c3d")

    def gait(self, *arguments):
        return json.loads(self.good("analyze", *arguments, "--measures", "gait,plates", "--refits", "0", "--json").out)

    def steps(self, gait):
        return [(e["label"], e["context"], e["time_s"]) for e in gait["gait"]["events"] if e["source"] == "plate"]

    def test_plates_of_a_mat_are_those_of_the_c3d(self):
        self.good("convert", self.walk, "walk.mat")
        self.good("convert", self.walk, "again.c3d")
        first = self.gait(self.walk)
        self.assertEqual(len(self.steps(first)), 6)
        for name in ("walk.mat", "again.c3d"):
            other = self.gait(name)
            self.assertEqual(other["measures"], first["measures"], name)
            self.assertEqual(self.steps(other), self.steps(first), name)

    def test_frames_that_are_chosen_keep_their_forces(self):
        part = ("--start", 8.0, "--end", 9.5)
        self.good("convert", self.walk, "walk.mat")
        self.assertEqual(self.gait(self.walk, *part)["measures"], self.gait("walk.mat", *part)["measures"])

    def test_a_table_of_forces_stands_for_plates(self):
        self.good("convert", self.walk, "walk.trc")
        self.good("convert", self.walk, "grf.mot")
        first = self.gait(self.walk)
        beside = self.gait("walk.trc", "--forces", "grf.mot")
        for one, other in zip(self.steps(first), self.steps(beside), strict=True):
            self.assertEqual(one[:2], other[:2])
            self.assertAlmostEqual(one[2], other[2], delta=0.005)
        self.assertTrue(any("forces are those of grf.mot" in w for w in beside["warnings"]))
        self.assertFalse(any("forces are those of" in w for w in first["warnings"]))
        self.good("analyze", "walk.trc", "--forces", "grf.mot", "--measures", "gait,plates", "--refits", "0", "--report", "page.html")
        run = json.loads(report_data((self.folder / "page.html").read_text()))
        self.assertIn("grf.mot", json.dumps(run["run"]["inputs"] if "run" in run and "inputs" in run["run"] else run))
        peaks = [max(m["value"] for m in one["measures"] if m["measure"] == "peak_force") for one in (first, beside)
                 if any(m["measure"] == "peak_force" for m in one["measures"])]
        if len(peaks) == 2:
            self.assertAlmostEqual(peaks[0], peaks[1], delta=1e-6 * peaks[0])

    def test_moments_of_joints_from_a_table(self):
        self.good("convert", self.walk, "grf.mot")
        loads = []
        for folder, words in (("plates", ()), ("table", ("--forces", "grf.mot"))):
            self.run_in("analyze", self.walk, "--segments", "pig", "--refits", "0", *words, "-o", folder)
            loads.append(table(self.folder / folder / "loads.sto"))
        self.assertEqual(loads[0][0], loads[1][0])
        knee = next(i for i, name in enumerate(loads[0][0]) if "knee" in name.lower() and "moment" in name.lower())
        seen = [(a[knee], b[knee]) for a, b in zip(loads[0][1], loads[1][1], strict=True) if a[knee] == a[knee] and b[knee] == b[knee]]
        self.assertGreater(len(seen), 50)
        largest = max(abs(a) for a, _ in seen)
        self.assertLess(sum(abs(a - b) > 0.02 * largest for a, b in seen), 0.05 * len(seen))

    def test_turned_forces_are_turned_in_the_table(self):
        self.good("convert", self.walk, "grf.mot")
        self.good("convert", self.walk, "turned.mot", "--rotate", "x -90")
        names, rows = table(self.folder / "grf.mot")
        turned = table(self.folder / "turned.mot")[1]
        z, y = names.index("1_ground_force_vz"), names.index("1_ground_force_vy")
        for one, other in zip(rows, turned, strict=True):
            self.assertAlmostEqual(one[z], other[y], delta=1e-3)

    def test_a_page_shows_forces_of_every_format(self):
        self.good("convert", self.walk, "walk.mat")
        pages = []
        for name in (self.walk, "walk.mat"):
            self.good("report", name, "-o", "page.html", "--force")
            pages.append(json.loads(report_data((self.folder / "page.html").read_text())))
        self.assertIn("forces", json.dumps(list(pages[0]["scene"])))
        self.assertEqual(pages[0]["scene"]["forces"], pages[1]["scene"]["forces"])

    def test_what_is_wrong_is_one_sentence(self):
        self.good("convert", self.walk, "walk.trc")
        self.refused(3, "has no force plates, whose forces a .mot could hold", "convert", "walk.trc", "grf.mot")
        self.assertFalse((self.folder / "grf.mot").exists())
        self.refused(2, "nothing that is asked for", "analyze", "walk.trc", "--measures", "path_length", "--forces", self.walk)
        self.refused(2, "forces are read from the plates of a .c3d or .mat file, from", "analyze", self.walk, "--measures", "plates", "--forces", "walk.trc")
        self.write("angles.mot", "q\nnRows=1\nnColumns=2\nendheader\ntime\tknee\n0\t1\n")
        self.refused(3, "angles.mot: has no columns of forces; need NAMEvx", "analyze", self.walk, "--measures", "plates", "--forces", "angles.mot")
        for words in (("--drop", "LASI"), ("--select", "LASI"), ("--rename", "LASI=A"), ("--doubtful", "drop")):
            self.refused(2, f"{words[0]}", "convert", self.walk, "grf.mot", *words)
        self.refused(2, "one recording, at the rate of its markers", "convert", self.walk, "grf.mot", "--resample", 50)

    def test_labels_that_a_person_swapped_stay(self):
        self.good("convert", self.walk, "walk.c3d")
        first = json.loads(self.good("info", "walk.c3d", "--json").out)["first_frame"]
        self.good("edit", "walk.c3d", "--swap", "LASI", "RASI", "--from", first + 100)
        # Labels that contradict the body are not good, whoever put them there.
        said = self.good("clean", "walk.c3d", "edited.c3d", "--filter", "none", status=1).err
        self.assertIn("left as it is", said)
        self.assertEqual(said.count("note: LASI and RASI are exchanged"), 1)
        self.assertNotIn("What was done: exchanged back", said)
        self.good("convert", "walk.c3d", "false.c3d", status=1)
        self.assertIn("What was done: exchanged back", self.good("clean", "false.c3d", "repaired.c3d", "--filter", "none", status=1).err)


if __name__ == "__main__":
    import unittest

    unittest.main()
