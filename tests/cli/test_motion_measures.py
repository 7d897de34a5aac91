# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""kinemark dynamics, by its door analyze MOTION --model M: measures of joints and of the body."""

import csv
import io
import json

from support import CommandTest


class MotionMeasuresTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.good("simulate", "subject", "--out", "in", "--duration", "1", "--quiet")

    def measure(self, *more):
        return ["analyze", "in/truth.mot", "--model", "in/model.osim", "--refits", "0", *more]

    def test_for_people(self):
        done = self.good(*self.measure())
        self.assertIn("knee_angle_r, 0.080 to ", done.out)
        self.assertRegex(done.out, r"Range of motion +[0-9.]+ deg")
        self.assertRegex(done.out, r"Peak angular momentum +[0-9.]+ kg m\^2/s")
        self.assertEqual(list(self.folder.iterdir()), [self.folder / "in"])

    def test_a_tidy_table_of_what_is_asked_for(self):
        self.good(*self.measure("--measures", "joint_range,joint_work_net", "--select", "knee*_r", "--torques", "--region",
                                "first=0.2s-0.5s", "-o", "m.csv", "--normalize"))
        rows = list(csv.DictReader(io.StringIO((self.folder / "m.csv").read_text())))
        self.assertEqual([(r["subject"], r["measure"], r["unit"]) for r in rows],
                         [("knee_angle_r", "joint_range", "deg"), ("knee_angle_r", "joint_work_net", "J/kg")])
        self.assertEqual({r["region"] for r in rows}, {"first"})
        self.refused(4, "--force", *self.measure("-o", "m.csv"))

    def test_intervals_and_coupling_as_json(self):
        done = self.good("ik", "-m", "in/model.osim", "-t", "in/markers.c3d", "-o", "Q.mot", "--quiet")
        done = self.good("analyze", "Q.mot", "-m", "in/model.osim", "--couple", "hip_flexion_r,knee_angle_r", "--measures",
                         "joint_range,relative_phase", "--select", "knee_angle_r", "--refits", "39", "--json")
        out = json.loads(done.out)
        self.assertEqual([m["measure"] for m in out["measures"]], ["joint_range", "relative_phase"])
        knee = out["measures"][0]
        self.assertEqual(knee["interval"]["kind"], "two-sided")
        self.assertLess(knee["interval"]["low"], knee["interval"]["high"])
        self.assertEqual([i["role"] for i in out["inputs"]], ["model", "motion", "deviations"])

    def test_the_list_holds_them(self):
        lines = self.good("analyze", "--list").out
        for name in ("joint_range", "margin_of_stability", "grf_peak", "cop_path", "emg_rms"):
            self.assertIn(name, lines)

    def test_what_is_wrong_is_one_sentence(self):
        self.refused(2, "nearest: joint_range", *self.measure("--measures", "joint_rang"))
        self.refused(2, "no coordinate 'knee_angel_r'", *self.measure("--select", "knee_angel_r"))
        self.refused(2, "need --forces FILE.c3d", *self.measure("--between", "Foot Strike"))
        self.refused(2, "is no range of time", *self.measure("--start", "2", "--end", "1"))
        self.refused(2, "is measured of a motion", "analyze", "in/markers.c3d", "--measures", "joint_range")
        self.refused(2, "--drop is an option for recordings; truth.mot is a motion", *self.measure("--drop", "knee_angle_r"))
        self.refused(2, "--emg is an option for measures of markers", *self.measure("--emg", "Biceps"))
        self.refused(2, "--couple is an option for measures of a motion; markers.c3d is a recording", "analyze", "in/markers.c3d",
                     "--couple", "hip_flexion_r,knee_angle_r")
        self.refused(3, "'cycle' is not within", *self.measure("--region", "cycle=50-500"))
        self.refused(3, "there are no force plates", "analyze", "in/markers.c3d", "--measures", "plates")
        self.refused(3, "there are no analog channels, and so no EMG", "analyze", "in/markers.c3d", "--measures", "emg")
        self.refused(2, "no analog channel 'EMG9'", "analyze", "in/markers.c3d", "--emg", "EMG9")
