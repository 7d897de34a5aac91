# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""kinemark analyze of walking, from outside."""

import csv
import json
import math

from support import CommandTest, real_file, report_data
from test_measures import wobble, write_trc

STRIDE_S, STRIDE_MM = 1.1, 1400.0


def foot(t, later, y):
    """Heel and toe, mm, of a foot that stands for 0.6 of a stride and swings for the rest."""
    phase = (t / STRIDE_S - later) % 1.0
    start = (t / STRIDE_S - later - phase + later) * STRIDE_MM
    u = max(0.0, (phase - 0.6) / 0.4)
    x = start + STRIDE_MM * u * u * (3 - 2 * u)
    lift = 120.0 * math.sin(math.pi * u) ** 2
    return (x, y, 40.0 + lift), (x + 200.0, y, 30.0 + lift)


def walk(seconds=5.0, rate=100.0):
    rows = []
    for i in range(int(seconds * rate)):
        t = i / rate
        points = [*foot(t, 0.0, 50.0), *foot(t, 0.5, -50.0), (t * STRIDE_MM / STRIDE_S - 300.0, 0.0, 950.0)]
        rows.append([tuple(v + 0.3 * wobble(i, 3 * m + a) for a, v in enumerate(p)) for m, p in enumerate(points)])
    return rows


def with_front():
    """The same with the front of the pelvis, left and right."""
    return [[*row, *((row[4][0] + 150.0, side * 120.0, 950.0) for side in (1, -1))] for row in walk()]


NAMES = ("LHEE", "LTOE", "RHEE", "RTOE", "SACR")


class Gait(CommandTest):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "walk.trc"
        write_trc(self.file, walk(), names=NAMES)

    def measures(self, *arguments):
        result = self.run_in("analyze", *arguments, "--refits", "39", "--json")
        self.assertEqual(result.status, 0, result.err)
        return json.loads(result.out)

    def test_measures_of_a_walk(self):
        reported = self.measures(self.file, "--measures", "gait")
        values = {(m["measure"], m.get("context", "")): m for m in reported["measures"]}
        self.assertAlmostEqual(values["gait_speed", ""]["value"], STRIDE_MM / STRIDE_S, delta=13)
        self.assertAlmostEqual(values["stride_length", "Left"]["value"], STRIDE_MM, delta=5)
        self.assertAlmostEqual(values["stride_time", "Right"]["value"], STRIDE_S, delta=0.011)
        self.assertAlmostEqual(values["step_width", ""]["value"], 100, delta=2)
        interval = values["stride_time", "Left"]["interval"]
        self.assertTrue(interval["low"] < STRIDE_S < interval["high"])
        self.assertFalse(reported["gait"]["treadmill"])
        deviations = [e["sd_s"] for e in reported["gait"]["events"]]
        known = [sd for sd in deviations if sd is not None]
        self.assertEqual(len(known), len(deviations))
        kind = {key: reported["gait"][key] for key in ("type", "direction", "turning", "person")}
        self.assertEqual(
            kind, {"type": "walk", "direction": "forward", "turning": False, "person": None}
        )
        self.assertAlmostEqual(reported["gait"]["speed"], values["gait_speed", ""]["value"], delta=3)
        self.assertAlmostEqual(reported["gait"]["stride_time_s"], STRIDE_S, delta=0.011)
        self.assertTrue(all(0 < sd < 0.1 for sd in known))

    def test_walking_is_measured_without_being_asked_for(self):
        result = self.run_in("analyze", self.file, "--refits", "0")
        self.assertEqual(result.status, 0, result.err)
        self.assertIn("Events of walking", result.out)
        self.assertIn("Walking speed", result.out)
        self.assertIn("Path length", result.out)

    def test_measures_of_paths_alone_leave_walking_out(self):
        reported = self.measures(self.file, "--measures", "path_length", "--select", "LHEE")
        self.assertNotIn("gait", reported)

    def test_events_are_written_and_read_back(self):
        table, copy = self.folder / "events.csv", self.folder / "events.c3d"
        for out in (table, copy):
            result = self.run_in("analyze", self.file, "--measures", "gait", "--refits", "0", "--write-events", out)
            self.assertEqual(result.status, 0, result.err)
        with table.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        again = self.measures(copy, "--measures", "gait", "--events", "file")["gait"]["events"]
        self.assertEqual([(r["context"], r["label"]) for r in rows], [(e["context"], e["label"]) for e in again])
        for row, event in zip(rows, again):
            self.assertAlmostEqual(float(row["time_s"]), event["time_s"], delta=1e-4)
            self.assertEqual(int(row["frame"]), round(100 * float(row["time_s"])) + 1)

    def test_coordinates_are_cut_into_cycles(self):
        motion, table = self.folder / "Q.mot", self.folder / "cycles.csv"
        lines = ["Q", "version=1", "nRows=500", "nColumns=2", "inDegrees=yes", "endheader", "time\tknee_angle_l"]
        lines += [f"{i / 100:.2f}\t{30 + 20 * math.sin(2 * math.pi * i / 110):.6f}" for i in range(500)]
        motion.write_text("\n".join(lines) + "\n")
        result = self.run_in(
            "analyze", self.file, "--measures", "gait", "--refits", "0", "--angles", motion, "--write-cycles", table
        )
        self.assertEqual(result.status, 0, result.err)
        with table.open(newline="", encoding="utf-8") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({r["curve"] for r in rows}, {"knee_angle_l"})
        self.assertEqual({r["context"] for r in rows}, {"Left"})
        mean = [float(r["value"]) for r in rows if r["cycle"] == "mean"]
        self.assertEqual(len(mean), 101)
        self.assertAlmostEqual(max(mean), 50, delta=0.5)
        self.assertAlmostEqual(min(mean), 10, delta=0.5)

    def test_markers_of_other_names(self):
        write_trc(self.folder / "other.trc", walk(), names=("A", "B", "C", "D", "E"))
        roles = self.folder / "feet.toml"
        roles.write_text('left_heel = "A"\nleft_toe = "B"\nright_heel = "C"\nright_toe = "D"\nsacrum = "E"\n')
        reported = self.measures(self.folder / "other.trc", "--measures", "cadence", "--gait-marker", roles)
        self.assertAlmostEqual(reported["measures"][0]["value"], 120 / STRIDE_S, delta=1)

    def test_page_of_angles_has_cycles_where_events_mark_them(self):
        walk_file, model = (real_file(f"opensim-gait2354/subject01_{name}") for name in ("walk1.trc", "simbody.osim"))
        marked = self.folder / "marked.c3d"
        result = self.run_in("analyze", walk_file, "--measures", "gait", "--refits", "0", "--write-events", marked)
        self.assertEqual(result.status, 0, result.err)

        def cycles(markers):
            page = self.folder / f"{markers.stem}.html"
            motion = self.folder / f"{markers.stem}.mot"
            solved = self.run_in("ik", "--model", model, "--markers", markers, "--output", motion, "--report", page)
            self.assertIn(solved.status, (0, 1), solved.err)
            again = self.folder / "again.html"
            self.assertEqual(self.run_in("report", motion, "-o", again, "--force").status, 0)
            first, second = (json.loads(report_data(p.read_text()))["cycles"] for p in (page, again))
            self.assertEqual(first is None, second is None)
            return first

        self.assertIsNone(cycles(walk_file))
        found = cycles(marked)
        self.assertEqual(found["points"], 101)
        of = {(c["coordinate"], c["side"]): c for c in found["curves"]}
        self.assertNotIn(("knee_angle_r", "Left"), of)
        for key in (("knee_angle_r", "Right"), ("knee_angle_l", "Left"), ("pelvis_tilt", "Left"), ("pelvis_tilt", "Right")):
            self.assertEqual((of[key]["count"], of[key]["whole"]), (1, 1), key)

    def test_what_is_wrong_is_one_sentence(self):
        write_trc(self.folder / "no_toe.trc", [row[:1] for row in walk()], names=("LHEE",))
        for arguments, status, words in (
            ((self.file, "--measures", "step_lenght"), 2, "nearest: step_length"),
            ((self.file, "--events", "plate"), 2, "there are best, plates, kinematics and file"),
            ((self.file, "--gait-marker", "left_knee=LHEE"), 2, "no marker of walking"),
            ((self.file, "--measures", "gait", "--gait-marker", "left_heel=LHEEL"), 3, "nearest: LHEE"),
            ((self.file, "--measures", "gait", "--events", "plates"), 3, "no events of feet by plates"),
            ((self.folder / "no_toe.trc", "--measures", "gait"), 3, "no marker besides those of the feet"),
            ((self.file, "--write-events", self.folder / "a.txt"), 2, "events are written as .csv, .c3d or .nwb"),
            ((self.file, "--measures", "gait", "--write-cycles", self.folder / "c.csv"), 3, "need --angles"),
        ):
            with self.subTest(words=words):
                result = self.run_in("analyze", *arguments, "--refits", "0")
                self.assertEqual(result.status, status, result.err)
                self.assertIn(words, result.err)
                self.assertEqual(len([l for l in result.err.strip().splitlines() if not l.startswith("note")]), 1)

    def test_what_fails_leaves_the_others(self):
        write_trc(self.folder / "no_toe.trc", [row[:1] for row in walk()], names=("LHEE",))
        result = self.run_in(
            "analyze", self.folder / "no_toe.trc", "--measures", "gait,path_length", "--refits", "0"
        )
        self.assertEqual(result.status, 0, result.err)
        self.assertIn("Walking is not measured: no marker besides", result.err)
        self.assertIn("Path length", result.out)

    def test_backward_walking_is_called_so(self):
        write_trc(self.folder / "back.trc", with_front()[::-1], names=(*NAMES, "LASI", "RASI"))
        reported = self.measures(self.folder / "back.trc", "--measures", "gait")
        self.assertEqual(reported["gait"]["direction"], "backward")
        self.assertFalse(reported["gait"]["treadmill"])
        values = {(m["measure"], m.get("context", "")): m["value"] for m in reported["measures"]}
        self.assertAlmostEqual(values["gait_speed", ""], STRIDE_MM / STRIDE_S, delta=13)
        self.assertAlmostEqual(values["step_width", ""], 100, delta=2)

    def test_who_stands_too_briefly_hears_of_both(self):
        still = real_file("c3d-parser-clinics/MH0222_BP08.c3d")
        both = ["no foot swings", "nor stands on plates for 5 s"]
        self.refused(3, both, "gait", still, "--refits", 0)
        self.refused(3, ["no foot swings", "nor stands on plates for 2 s"], "gait", still, "--refits", 0, "--region", "start=1-100")

    def test_who_stands_is_refused_with_the_reason(self):
        rows = walk()
        still = [[tuple(v + 0.3 * wobble(i, 3 * m) for v in p) for m, p in enumerate(rows[0])] for i in range(len(rows))]
        write_trc(self.folder / "still.trc", still, names=NAMES)
        result = self.run_in("analyze", self.folder / "still.trc", "--measures", "gait", "--refits", "0")
        self.assertEqual(result.status, 3)
        self.assertIn("not locomotion: no foot swings", result.err)

    def test_a_hidden_foot_and_exchanged_sides_are_said(self):
        rows = [[(math.nan,) * 3 if m == 0 and 150 < i < 300 else p for m, p in enumerate(row)] for i, row in enumerate(walk())]
        write_trc(self.folder / "hidden.trc", rows, names=NAMES)
        result = self.run_in("analyze", self.folder / "hidden.trc", "--measures", "gait", "--refits", "0")
        self.assertEqual(result.status, 0, result.err)
        self.assertIn("left foot: LHEE is hidden from 1.51 to 2.99 s", result.err)
        self.assertIn("LTOE stands for the whole foot", result.err)
        self.assertNotIn("right foot", result.err)
        rows = [[(math.nan,) * 3 if m < 2 and 150 < i < 300 else p for m, p in enumerate(row)] for i, row in enumerate(walk())]
        write_trc(self.folder / "foot_hidden.trc", rows, names=NAMES)
        result = self.run_in("analyze", self.folder / "foot_hidden.trc", "--measures", "gait", "--refits", "0")
        self.assertEqual(result.status, 0, result.err)
        self.assertIn("left foot: hidden from 1.5", result.err)
        for names, says in (
            (("LHEE", "LTOE", "RHEE", "RTOE", "SACR", "LASI", "RASI"), False),
            (("RHEE", "RTOE", "LHEE", "LTOE", "SACR", "RASI", "LASI"), True),
        ):
            write_trc(self.folder / "exchanged.trc", with_front(), names=names)
            result = self.run_in("analyze", self.folder / "exchanged.trc", "--measures", "gait", "--refits", "0")
            said = "the names of the sides are exchanged, or the recording is mirrored" in result.err
            self.assertEqual(said, says, result.err)

    def test_feet_alone_do_not_tell_backward_from_heels_and_toes_exchanged(self):
        write_trc(self.folder / "back.trc", walk()[::-1], names=NAMES)
        reported = self.measures(self.folder / "back.trc", "--measures", "gait")
        self.assertEqual(reported["gait"]["direction"], "unknown")
        self.assertNotIn("step_width", {m["measure"] for m in reported["measures"]})
        self.assertIn("stride_length", {m["measure"] for m in reported["measures"]})

    def test_heel_and_toe_exchanged_are_measured_exchanged_back(self):
        for file in ("btk-others/PiG_Motion3_FF.c3d", "c3d-parser-clinics/RBWH_bfnd_w1.c3d", "c3d-parser-clinics/S4-AMGait03.c3d"):
            recording = real_file(file)
            swap = [f"--rename={side}{a}={side}{b}" for side in "LR" for a, b in (("HEE", "TOE"), ("TOE", "HEE"))]
            right = json.loads(self.run_in("gait", recording, "--refits", 0, "--json").out)
            lengths = [m["value"] for m in right["measures"] if m["measure"] == "step_length"]
            for renames in (swap[:2], swap):
                result = self.run_in("gait", recording, "--refits", 0, "--json", *renames)
                self.assertIn("LHEE and LTOE are exchanged: ", result.err)
                self.assertEqual("RHEE and RTOE are exchanged: " in result.err, len(renames) == 4, result.err)
                found = json.loads(result.out)
                self.assertEqual(found["gait"]["direction"], "forward")
                for m, length in zip([m for m in found["measures"] if m["measure"] == "step_length"], lengths, strict=True):
                    self.assertAlmostEqual(m["value"], length, delta=1e-6)

    def test_limbs_that_are_moved_in_the_air_are_no_gait(self):
        for seed in (1, 3, 7):
            folder = self.folder / f"moved{seed}"
            self.assertEqual(self.run_in("simulate", "subject", "-o", folder, "--seed", seed).status, 0)
            result = self.run_in("gait", folder / "markers.c3d", "--refits", "0")
            self.assertEqual(result.status, 3, result.out)
            self.assertIn("not locomotion: ", result.err)

    def test_kinematics_never_sees_plates(self):
        recording = real_file("btk-others/PiG_Motion3_FF.c3d")
        reported = self.measures(recording, "--measures", "gait", "--events", "kinematics")
        self.assertTrue(all(e["source"] == "kinematics" for e in reported["gait"]["events"]))
        bare = self.folder / "bare.trc"
        self.assertEqual(self.run_in("convert", recording, bare).status, 0)
        alone = self.measures(bare, "--measures", "gait", "--events", "kinematics")["gait"]["events"]
        for one, other in zip(reported["gait"]["events"], alone, strict=True):
            self.assertAlmostEqual(one["time_s"], other["time_s"], delta=0.002)

    def test_steps_on_real_plates(self):
        reported = self.measures(real_file("btk-others/PiG_Motion3_FF.c3d"), "--measures", "gait")
        events = reported["gait"]["events"]
        self.assertEqual(sum(e["source"] == "plate" for e in events), 6)
        values = {(m["measure"], m.get("context", "")): m["value"] for m in reported["measures"]}
        self.assertTrue(1100 < values["gait_speed", ""] < 1350)


if __name__ == "__main__":
    import unittest

    unittest.main()
