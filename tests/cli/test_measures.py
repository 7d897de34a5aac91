# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""kinemark analyze of a recording of markers, from outside."""

import csv
import json
import math
import unittest

from support import CommandTest, real_file


def write_trc(path, rows, rate=100.0, names=("P",)):
    """A TRC file of positions in millimetres, one list of (x, y, z) for each frame."""
    lines = [
        f"PathFileType\t4\t(X/Y/Z)\t{path.name}",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames",
        f"{rate:g}\t{rate:g}\t{len(rows)}\t{len(names)}\tmm\t{rate:g}\t1\t{len(rows)}",
        "Frame#\tTime\t" + "\t\t\t".join(names),
        "\t\t" + "\t".join(f"X{i + 1}\tY{i + 1}\tZ{i + 1}" for i in range(len(names))),
        "",
    ]
    for i, row in enumerate(rows):
        lines.append("\t".join([str(i + 1), f"{i / rate:.6f}", *(f"{x:.6f}" for point in row for x in point)]))
    path.write_text("\n".join(lines) + "\n")


def wobble(i, axis):
    """Deterministic noise of about 0.5 mm."""
    x = math.sin(12.9898 * i + 78.233 * axis) * 43758.5453
    return 1.7 * (x - math.floor(x) - 0.5)


def wheel(i):
    angle = 2 * math.pi * i / 100
    return tuple(v + wobble(i, a) for a, v in enumerate((170 * math.cos(angle), 170 * math.sin(angle), 900.0)))


class Measures(CommandTest):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "wheel.trc"
        write_trc(self.file, [[wheel(i)] for i in range(400)])

    def test_prints_a_table_with_intervals(self):
        result = self.run_in("analyze", self.file, "--refits", "39")
        self.assertEqual(result.status, 0, result.err)
        self.assertIn("Diameter of the circle", result.out)
        self.assertRegex(result.out, r"Diameter of the circle +3(39|40)\.\d+ \[33\d\.\d+ to 34\d\.\d+\] mm")
        self.assertIn("not distinguishable from 0", result.out)
        self.assertNotIn("Onset", result.out)

    def test_figures_and_a_page_are_written(self):
        figures, page = self.folder / "figures", self.folder / "wheel.html"
        result = self.run_in("analyze", self.file, "--refits", "39", "--figures", figures, "--report", page)
        self.assertEqual(result.status, 0, result.err)
        self.assertEqual({p.stem for p in figures.iterdir()}, {"P_path", "P_speed", "P_cycles"})
        self.assertIn("best-fit plane", (figures / "P_path.svg").read_text(encoding="utf-8"))
        self.assertTrue((figures / "P_speed.png").read_bytes().startswith(b"\x89PNG"))
        self.assertIn('"kind":"measures"', page.read_text(encoding="utf-8"))
        again = self.run_in("analyze", self.file, "--refits", "39", "--figures", figures)
        self.assertEqual(again.status, 4, again.err)
        wrong = self.run_in("analyze", self.file, "--figures", self.folder / "more", "--figure-formats", "pdf")
        self.assertEqual(wrong.status, 2)
        self.assertIn("'pdf' is none of svg and png", wrong.err)
        self.assertFalse((self.folder / "more").exists())

    def test_figures_have_the_same_bytes_whatever_the_threads(self):
        for threads in ("1", "2"):
            result = self.run_in("analyze", self.file, "--refits", "39", "--figures", self.folder / threads, "--figure-formats", "svg",
                                 "--threads", threads)
            self.assertEqual(result.status, 0, result.err)
        for path in (self.folder / "1").iterdir():
            self.assertEqual(path.read_bytes(), (self.folder / "2" / path.name).read_bytes())

    def test_json_and_table_hold_the_same(self):
        table = self.folder / "wheel.csv"
        result = self.run_in("analyze", self.file, "--refits", "39", "-o", table, "--json")
        self.assertEqual(result.status, 0, result.err)
        reported = json.loads(result.out)
        with table.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([m["measure"] for m in reported["measures"]], [row["measure"] for row in rows])
        for measure, row in zip(reported["measures"], rows):
            if measure["value"] is not None:
                self.assertAlmostEqual(measure["value"], float(row["value"]), delta=1e-7 * abs(measure["value"]) + 1e-12)
            self.assertEqual(measure["interval"]["kind"], row["interval"])
        self.assertEqual(reported["written"], [str(table)])

    def test_same_bits_for_any_number_of_threads(self):
        a, b = (
            self.run_in("analyze", self.file, "--refits", "39", "--json", "--threads", n).out for n in ("1", "2")
        )
        self.assertEqual(a, b)

    def test_regions_and_measures_are_chosen_by_name(self):
        result = self.run_in(
            *("analyze", self.file, "--measures", "mean_speed", "--refits", "0"),
            *("--region", "first=1-150", "--region", "late=2s-3s", "--json"),
        )
        self.assertEqual(result.status, 0, result.err)
        measures = json.loads(result.out)["measures"]
        self.assertEqual([(m["region"], m["measure"]) for m in measures], [("first", "mean_speed"), ("late", "mean_speed")])
        for m in measures:
            self.assertAlmostEqual(m["value"], 2 * math.pi * 170, delta=15)

    def test_list_explains_every_measure(self):
        result = self.run_in("analyze", "--list")
        self.assertEqual(result.status, 0)
        self.assertIn("path_length", result.out)
        self.assertGreater(len(result.out.splitlines()), 30)
        reported = json.loads(self.run_in("analyze", "--list", "--json").out)
        self.assertTrue(all(m["formula"] and m["source"] for m in reported))

    def test_what_is_wrong_is_one_sentence(self):
        for arguments, status, words in (
            (("--measures", "peek_speed"), 2, "nearest: peak_speed"),
            (("--region", "all"), 2, "need NAME=FIRST-LAST"),
            (("--region", "late=900-950"), 3, "lies outside the recording"),
            (("--between", "Strike"), 3, "the recording has no events"),
            (("--refits", "5"), 2, "need 0 (no intervals) or at least 39"),
            (("--refits", "99", "--level", "0.99"), 2, "99 refits; need 0 (no intervals) or at least 199 for intervals of level 0.99"),
            (("--level", "1"), 2, "intervals of level 1; need one above 0.5 and at most 0.9999"),
            (("-o", self.folder / "a.xlsx"), 2, "measures are written as .csv, .json or .nwb"),
            (("--select", "NOSE"), 3, "NOSE"),
        ):
            with self.subTest(words=words):
                result = self.run_in("analyze", self.file, *arguments)
                self.assertEqual(result.status, status, result.err)
                self.assertIn(words, result.err)
                self.assertEqual(len(result.err.strip().splitlines()), 1, result.err)

    def test_a_level_has_as_many_refits_as_it_needs(self):
        found = []
        for words in ((), ("--level", "0.98"), ("--level", "0.99"), ("--level", "0.99", "--refits", "250")):
            result = self.run_in("analyze", self.file, "--measures", "cycle_time", *words, "--json")
            self.assertEqual(result.status, 0, result.err)
            found.append(json.loads(result.out)["measures"][0])
        for measure, refits in zip(found, (99, 99, 199, 250)):
            self.assertIn(f", {refits} refits", measure["method"])
        width = [m["interval"]["high"] - m["interval"]["low"] for m in found]
        self.assertLess(width[0], width[1])
        self.assertNotEqual(width[1], width[2])

    def test_nothing_is_written_over(self):
        table = self.folder / "wheel.csv"
        table.write_text("mine")
        result = self.run_in("analyze", self.file, "--refits", "0", "-o", table)
        self.assertEqual(result.status, 4)
        self.assertEqual(table.read_text(), "mine")

    def test_strides_of_a_real_walk(self):
        file = real_file("btk-others/FunctionalWalk.c3d")
        result = self.run_in("analyze", file, "--select", "RHEE", "--refits", "0", "--json")
        self.assertEqual(result.status, 0, result.err)
        measures = {m["measure"]: m for m in json.loads(result.out)["measures"]}
        self.assertTrue(0.8 < measures["cycle_time"]["value"] < 1.3)
        self.assertNotIn("circle_diameter", measures)


if __name__ == "__main__":
    unittest.main()
