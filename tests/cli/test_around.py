# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark measure --around`, trials as spans, and what lies beside a movement on its page, from outside."""

import csv
import json
import math

from support import CommandTest, report_data

SELECT = ("--select", "f7", "--refits", 0)


class AroundTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.good("simulate", "macaque", "-o", "monkey", "--duration", 20, "--units", 6, "--trials", 4, "--lfp", "--all-seen", "--seed", 5)
        self.session = self.folder / "monkey" / "session.nwb"

    def rows(self, name):
        with open(self.folder / name, newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_the_movement_follows_the_spikes_of_a_tuned_unit(self):
        made = self.good("measure", self.session, "--around", "units", *SELECT, "--window", "-0.5,0.5", "--bin", 0.1, "-o", "sta.csv")
        self.assertRegex(made.err, r"\d+ of \d+ events are left out: their window leaves the recording")
        rows = self.rows("sta.csv")
        self.assertEqual(len(rows), 6 * 4 * 10)
        self.assertEqual({r["curve"] for r in rows}, {"x", "y", "z", "speed"})
        for row in rows:
            self.assertLess(float(row["low"]), float(row["mean"]))
            self.assertLess(float(row["mean"]), float(row["high"]))
            self.assertEqual(int(row["count"]) + int(row["missing"]), int(row["used"]))

    def test_rates_around_movements_trials_and_conditions(self):
        self.good("measure", self.session, "--around", "movement", *SELECT, "-o", "m.json")
        document = json.loads((self.folder / "m.json").read_text(encoding="utf-8"))
        self.assertEqual([c["subject"] for c in document["around"]], [str(u) for u in range(6)])
        self.assertEqual({c["events"] for c in document["around"]}, {"f7 Movement Start"})
        self.good("measure", self.session, "--around", "trials:side", "--window", "0,1", "-o", "t.csv")
        rows = self.rows("t.csv")
        self.assertEqual({r["events"] for r in rows}, {"trials side=left", "trials side=right"})
        self.assertTrue(all(math.isfinite(float(r["mean"])) and r["unit"] == "Hz" for r in rows))
        self.assertIn("Around trials: 4 used, 0 outside", self.good("measure", self.session, "--around", "trials", "--window", "0,1").out)

    def test_angles_beside_spikes_of_another_file(self):
        lines = "".join(f"{i / 100}\t{math.sin(i / 30)}\n" for i in range(2000))
        (self.folder / "q.mot").write_text(f"q\nversion=1\nnRows=2000\nnColumns=2\ninDegrees=yes\nendheader\ntime\telbow\n{lines}")
        shown = self.good("measure", "q.mot", "--spikes", self.session, "--around", "unit:1").out
        self.assertIn("Around unit 1", shown)
        self.assertIn("elbow angle", shown)
        self.refused(2, "movement: starts are those of markers; q.mot is a motion", "measure", "q.mot", "--spikes", self.session, "--around", "movement")
        self.refused(2, "--select is an option for", "measure", "q.mot", "--spikes", self.session, "--around", "units", "--select", "elbow")
        self.refused(2, "is a motion, no recording of markers", "measure", "q.mot")

    def test_refusals(self):
        for status, said, words in (
            (2, "there is no unit '9'; there are 0, 1, 2, 3, 4 and 5", ["--around", "unit:9"]),
            (2, "nearest: trials", ["--around", "trails"]),
            (2, "need FROM,TO in seconds", ["--around", "units", "--window", "1"]),
            (2, "need whole ones", ["--around", "units", "--window", "0,0.5", "--bin", "0.2"]),
            (2, "--measures is an option for", ["--around", "units", "--measures", "path_length"]),
            (2, "measures are written as .csv, .json or .nwb", ["--around", "units", "-o", "x.txt"]),
            (3, "lie outside the recording", ["--around", "units", "--clock-offset", "500"]),
        ):
            with self.subTest(words=words):
                self.refused(status, said, "measure", self.session, *words)
        self.refused(2, "holds no spikes; --spikes FILE.nwb", "measure", "monkey/markers.c3d", "--around", "units")
        self.refused(2, "--around takes one recording", "measure", self.session, "monkey/markers.c3d", "--around", "units")

    def test_trials_are_spans_with_their_conditions(self):
        made = self.good("measure", self.session, *SELECT, "--measures", "path_length", "-o", "t.csv")
        self.assertIn("each of 4 trials of the file is measured (--trials none: the whole recording)", made.err)
        rows = self.rows("t.csv")
        self.assertEqual([r["region"] for r in rows], [f"trial {i + 1}" for i in range(4)])
        self.assertEqual(sorted(r["side"] for r in rows), ["left", "left", "right", "right"])
        whole = self.good("measure", self.session, *SELECT, "--measures", "path_length", "--trials", "none", "-o", "w.csv")
        self.assertNotIn("trials of the file", whole.err)
        self.assertEqual([r["region"] for r in self.rows("w.csv")], [""])
        part = self.good("measure", self.session, *SELECT, "--measures", "path_length", "--region", "a=1s-3s", "-o", "r.csv")
        self.assertNotIn("trials of the file", part.err)
        self.refused(2, "there are no intervals 'epochs'", "measure", self.session, "--trials", "epochs")
        document = json.loads(self.good("measure", self.session, *SELECT, "--measures", "path_length", "--json").out)
        self.assertEqual(document["trials"][0]["region"], "trial 1")
        self.assertIn(document["trials"][0]["conditions"]["side"], ("left", "right"))

    def test_the_page_shows_what_lies_beside(self):
        self.good("report", self.session, "-o", "page.html")
        lanes = json.loads(report_data((self.folder / "page.html").read_text(encoding="utf-8")))["neural"]
        self.assertEqual([u["id"] for u in lanes["units"]], [str(u) for u in range(6)])
        self.assertEqual(len(lanes["trials"]), 4)
        self.assertEqual([c["name"] for c in lanes["fields"][0]["channels"]], [f"electrode {k}" for k in range(4)])
        self.good("report", "monkey/markers.c3d", "-o", "other.html")
        self.assertNotIn("neural", json.loads(report_data((self.folder / "other.html").read_text(encoding="utf-8"))))
        self.good("measure", self.session, *SELECT, "--measures", "path_length", "--report", "m.html")
        self.assertEqual(len(json.loads(report_data((self.folder / "m.html").read_text(encoding="utf-8")))["result"]["neural"]["units"]), 6)
