# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""kinemark analyze of movements that repeat and of many recordings, from outside."""

import csv
import json
import math
import unittest

from support import CommandTest
from test_measures import wheel, wobble, write_trc


def reach(i):
    """0.3 m out, a rest, and back, twice."""
    x = 0.0
    for k, sign in enumerate((1, -1, 1, -1)):
        u = min(1.0, max(0.0, (i / 100 - 0.6 - 1.3 * k) / 0.7))
        x += sign * 300 * u**3 * (10 - 15 * u + 6 * u * u)
    return tuple(v + wobble(i, a) for a, v in enumerate((x, 0.2 * x, 900.0)))


class Repeated(CommandTest):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "both.trc"
        write_trc(self.file, [[wheel(i), reach(i)] for i in range(600)], names=("HUB", "RFIN"))

    def rows(self, name):
        with (self.folder / name).open(newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def test_events_and_cycles_where_no_foot_steps(self):
        done = self.run_in("analyze", self.file, "--refits", "39", "--write-events", "e.csv", "--write-cycles", "c.csv", "-o", "m.csv")
        self.assertEqual(done.status, 0, done.err)
        starts = [r for r in self.rows("e.csv") if r["label"] == "Movement Start"]
        self.assertEqual({r["subject"] for r in starts}, {"RFIN"})
        self.assertEqual(len(starts), 4)
        self.assertTrue(all(0 < float(r["sd_s"]) < 0.05 for r in starts))
        cycles = self.rows("c.csv")
        kinds = {(r["subject"], r["context"]) for r in cycles}
        self.assertTrue({("HUB", "cycle"), ("RFIN", "movement 1"), ("RFIN", "movement 2")} <= kinds, kinds)
        mean = [r for r in cycles if r["cycle"] == "mean" and r["subject"] == "HUB" and r["curve"] == "x"]
        self.assertEqual(len(mean), 101)
        self.assertTrue(all(r["sd_between"] and r["sd"] for r in mean))
        self.assertTrue(all(not r["sd_between"] for r in cycles if r["cycle"] != "mean"))
        lengths = [float(r["value"]) for r in self.rows("m.csv") if r["measure"] == "cycle_duration" and r["subject"] == "HUB"]
        self.assertTrue(len(lengths) >= 3 and all(abs(s - 1.0) < 0.02 for s in lengths), lengths)

    def test_why_there_are_no_cycles_is_said(self):
        done = self.run_in("analyze", self.file, "--select", "RFIN", "--end", "2", "--refits", "0", "--write-cycles", "c.csv")
        self.assertEqual(done.status, 0, done.err)
        self.assertIn("RFIN: not periodic", done.err)

    def test_tables_of_a_motion_heed_what_is_measured_or_refuse_it(self):
        self.good("simulate", "subject", "--out", "in", "--duration", "1", "--quiet")
        for option in (("--select", "knee*"), ("--region", "a=1-20"), ("--refits", "0")):
            self.refused(2, f"{option[0]} is an option for", "analyze", "in/truth.mot", "--model", "in/model.osim", "-o", "out", *option)


class Several(CommandTest):
    def setUp(self):
        super().setUp()
        for who in ("sub-1", "sub-2"):
            folder = self.folder / "set" / who
            folder.mkdir(parents=True)
            write_trc(folder / f"{who}_task-turn.trc", [[wheel(i)] for i in range(300)])
        (self.folder / "set" / "participants.tsv").write_text("participant_id\tgroup\nsub-1\t=A\nsub-2\tB\n")

    def test_one_table_with_who_and_a_status_for_each(self):
        done = self.run_in("analyze", "set", "--measures", "peak_speed", "--refits", "0", "-o", "m.csv", "--jobs", "2")
        self.assertEqual(done.status, 0, done.err)
        self.assertIn("2 recordings: 2 good", done.out)
        self.assertIn("participants.tsv: is joined", done.err)
        with (self.folder / "m.csv").open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(r["participant"], r["trial"], r["group"]) for r in rows], [("sub-1", "task-turn", "'=A"), ("sub-2", "task-turn", "B")])
        self.assertTrue(math.isclose(float(rows[0]["value"]), float(rows[1]["value"])))

    def test_a_recording_that_fails_leaves_the_others(self):
        done = self.run_in("analyze", "set/sub-1/sub-1_task-turn.trc", "none.trc", "--measures", "peak_speed", "--refits", "0", "--json")
        self.assertEqual(done.status, 4, done.err)
        self.assertEqual(len([line for line in done.err.splitlines() if "none.trc" in line]), 1)
        found = json.loads(done.out)
        self.assertEqual((len(found["recordings"]), len(found["failed"])), (1, 1))
        self.assertEqual(found["failed"][0]["exit_status"], 4)

    def test_what_is_wrong_is_one_sentence(self):
        two = ("set/sub-1/sub-1_task-turn.trc", "set/sub-2/sub-2_task-turn.trc")
        for words, arguments in (
            ("several recordings need a table", ()),
            ("--figures f: is made of one recording", ("-o", "m.csv", "--figures", "f")),
            ("--model is an option for motions", ("-o", "m.csv", "--model", "m.osim")),
            ("measures are written as .csv, .json or .nwb", ("-o", "m.xlsx")),
            ("--cutoff is an option for motions", ("-o", "m.csv", "--cutoff", "6")),
        ):
            with self.subTest(words=words):
                self.refused(2, words, "analyze", *two, *arguments)
        self.refused(2, "is a motion", "analyze", two[0], "Q.mot", "-o", "m.csv")


if __name__ == "__main__":
    unittest.main()
