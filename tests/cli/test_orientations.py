# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Joint angles from inertial sensors: the sensors are turned here, from positions of bodies that `dynamics` writes."""

import json
import math
import random
import re

from support import CommandTest, run, table

BODIES = ("pelvis", "thorax", "femur_r", "femur_l", "tibia_r", "tibia_l", "humerus_r", "ulna_r")


def columns_of(path):
    names, rows = table(path)
    return dict(zip(names, zip(*rows)))


def product(a, b):
    """Of two quaternions, w x y z."""
    (p, q, r, s), (w, x, y, z) = a, b
    return (p * w - q * x - r * y - s * z, p * x + q * w + r * z - s * y, p * y - q * z + r * w + s * x, p * z + q * y - r * x + s * w)


def turn(axis, degrees):
    half = math.radians(degrees) / 2
    return (math.cos(half), *(math.sin(half) * x for x in axis))


def body_fixed(x, y, z):
    """Body-fixed rotations about x, y, z, in degrees, as BodyKinematics has them."""
    return product(product(turn((1, 0, 0), x), turn((0, 1, 0), y)), turn((0, 0, 1), z))


def quaternions(times, names, rows):
    lines = ["DataType=Quaternion", "version=3", "endheader", "\t".join(("time", *names))]
    lines += ["\t".join((f"{t:.2f}", *(",".join(f"{v:.9f}" for v in q) for q in row))) for t, row in zip(times, rows)]
    return "\n".join(lines) + "\n"


class OrientationsTest(CommandTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.sensors = cls.recorded.parent / "sensors"
        cls.sensors.mkdir()
        draw = random.Random(4)
        mounts = [body_fixed(*(draw.uniform(-180, 180) for _ in range(3))) for _ in BODIES]
        # Their world has its z upwards and is turned by 35 deg about it: what the heading must give back.
        world = product(turn((1, 0, 0), 90), turn((0, 1, 0), -35))

        def sensors(motion, name, noise):
            made = run("dynamics", motion, "--model", cls.model, "--bodies", ",".join(BODIES), "-o", cls.sensors / name, cwd=cls.shared.name)
            assert made.status == 0, made.err
            poses = columns_of(next((cls.sensors / name).glob("*_pos_global.sto")))
            rows = []
            for i in range(len(poses["time"])):
                scatter = [body_fixed(*(draw.gauss(0, noise) for _ in range(3))) for _ in BODIES]
                angles = [body_fixed(*(poses[f"{body}_O{axis}"][i] for axis in "xyz")) for body in BODIES]
                rows.append([product(s, product(world, product(a, m))) for s, a, m in zip(scatter, angles, mounts)])
            (cls.sensors / f"{name}.sto").write_text(quaternions(poses["time"], [f"{body}_imu" for body in BODIES], rows))

        truth = cls.truth.read_text().splitlines()
        labels = next(i for i, line in enumerate(truth) if line.startswith("time"))
        still = [re.sub(r"^nRows=.*", "nRows=20", line) for line in truth[: labels + 1]]
        still += ["\t".join([f"{i / 100:.2f}"] + ["0"] * truth[labels].count("\t")) for i in range(20)]
        (cls.sensors / "still.mot").write_text("\n".join(still) + "\n")
        sensors(cls.truth, "walk", 1.0)
        sensors(cls.sensors / "still.mot", "pose", 1.0)

    def solve(self, *more, status=0, pose=True):
        given = ["--calibration", self.sensors / "pose.sto"] if pose else []
        return self.good("ik", "--model", self.model, "--orientations", self.sensors / "walk.sto", "--up", "z", "-o", "q.mot", *given, *more, status=status)

    def test_angles_and_heading(self):
        ran = self.solve()
        self.assertRegex(ran.err, r"Heading 3[45]\.\d deg \(SD [01]\.\d\), estimated from the motion")
        found, sd, truth = (columns_of(path) for path in (self.folder / "q.mot", self.folder / "q_sd.sto", self.truth))
        within = total = 0
        for name in ("knee_angle_r", "knee_angle_l", "hip_flexion_r", "hip_adduction_l", "elbow_flex_r", "pelvis_tilt"):
            for f, s, t in zip(found[name], sd[name], truth[name]):
                within += abs(f - t) < 1.96 * s
                total += 1
        self.assertGreater(within, 0.9 * total)
        self.assertTrue(all(math.isnan(s) for s in sd["pelvis_tx"]), "orientations say nothing of positions")
        report = json.loads((self.folder / "q_report.json").read_text())
        self.assertEqual([s["body"] for s in report["sensors"]], list(BODIES))
        self.assertAlmostEqual(report["noise_sd_deg"], 1.0, delta=0.15)
        self.assertTrue((self.folder / "q_orientation_errors.sto").is_file())

    def test_markers_and_sensors_together(self):
        ran = self.good("ik", "--model", self.model, "-t", self.trc, "--orientations", self.sensors / "walk.sto", "--calibration", self.sensors / "pose.sto",
                        "--sensors-up", "z", "-o", "q.mot", "--report", "q.html", *(word for name in ("RTIB", "RANK", "RHEE", "RTOE") for word in ("--drop", name)))
        self.assertRegex(ran.err, r"Heading 3[45]\.\d deg \(SD [01]\.\d\), estimated from markers and sensors")
        self.assertRegex(ran.err, r"8 sensors, \d placed by markers, \d by the pose")
        found, sd, truth = (columns_of(path) for path in (self.folder / "q.mot", self.folder / "q_sd.sto", self.truth))
        within = total = 0
        for name in ("knee_angle_r", "knee_angle_l", "hip_flexion_r", "elbow_flex_r", "pelvis_tilt", "pelvis_tx"):
            for f, s, t in zip(found[name], sd[name], truth[name]):
                within += abs(f - t) < 1.96 * s
                total += 1
        self.assertGreater(within, 0.88 * total)
        report = json.loads((self.folder / "q_report.json").read_text())["orientations"]
        self.assertEqual({s["name"]: s["placed_by"] for s in report["sensors"]}["pelvis_imu"], "markers")
        self.assertEqual(report["heading"]["from"], "markers")
        errors = columns_of(self.folder / "q_orientation_errors.sto")
        self.assertEqual(len(errors["tibia_r_imu"]), len(columns_of(self.folder / "q_marker_errors.sto")["time"]))
        self.assertTrue((self.folder / "q.html").is_file())

    def test_threads_do_not_change_a_bit(self):
        self.solve("--threads", 1)
        one = (self.folder / "q.mot").read_bytes(), (self.folder / "q_sd.sto").read_bytes()
        self.solve("--threads", 2, "--force")
        self.assertEqual(((self.folder / "q.mot").read_bytes(), (self.folder / "q_sd.sto").read_bytes()), one)

    def test_a_first_frame_that_is_no_pose_is_said(self):
        ran = self.solve("--heading", "pelvis_imu:x", pose=False, status=1)
        self.assertIn("give a recording of that pose, --calibration", ran.err)

    def test_options(self):
        self.solve("--heading", "pelvis_imu:x", "--no-error-bars", "--no-limits", "--start", 0.2, "--end", 0.4)
        self.assertEqual(len(columns_of(self.folder / "q.mot")["time"]), 21)
        self.assertFalse((self.folder / "q_sd.sto").exists())
        self.solve("--orientation-noise", 3, "--force", "--sensor", "thorax_imu=thorax")
        self.assertAlmostEqual(json.loads((self.folder / "q_report.json").read_text())["noise_sd_deg"], 3 * math.sqrt(1.05), places=6)
        self.solve("--force", "--max-orientation-rms", 0.1, status=1)

    def test_what_is_not_for_sensors_is_refused(self):
        words = ("ik", "-m", self.model, "--orientations", self.sensors / "walk.sto", "-o", "q.mot")
        for option in (["--noise", 2], ["--torques"], ["--report", "r.html"], ["--frames", "1-9"]):
            self.refused(2, [option[0], "is for markers; --orientations is given too"], *words, *option)
        for option in (["--estimator", "smoother"], ["--loss", "huber"]):
            self.refused(2, [option[0], "is for markers alone; --orientations is given too"], *words, *option)
            self.refused(2, [option[0], "is for markers alone; --orientations is given too"], *words, "-t", self.trc, *option)
        self.refused(2, "--orientations are of one recording", *words[:-1], "out", "-t", self.trc, "-t", self.folder / "other.trc")
        self.refused(2, "--heading is for sensors that a pose places", *words, "-t", self.trc, "--heading", "pelvis_imu:x")
        self.refused(2, "--sensors-up", *words, "-t", self.trc, "--sensors-up", "north")
        self.refused(2, ["--heading is for orientations"], "ik", "-m", self.model, "-t", self.trc, "-o", "q.mot", "--heading", "a:x")
        self.refused(2, "'pelvis' is not SENSOR:AXIS", *words, "--heading", "pelvis")
        self.refused(2, "is not SENSOR=BODY", *words, "--sensor", "pelvis")
        self.refused(2, "--up", *words, "--up", "north")

    def test_bad_input(self):
        words = ("ik", "-m", self.model, "-o", "q.mot", "--orientations")
        self.refused(4, ["no.sto"], *words, "no.sto")
        self.refused(3, "holds no orientations", *words, self.truth)
        broken = self.write("broken.sto", (self.sensors / "walk.sto").read_text().replace("0.00\t", "0.00\t9", 1))
        self.refused(3, ["row 1", "quaternion of length"], *words, broken)

    def test_info_says_what_sensors_there_are(self):
        shown = self.good("info", self.sensors / "walk.sto").out
        self.assertRegex(shown, r"kind +orientations")
        self.assertIn("pelvis_imu (", shown)
        facts = json.loads(self.good("info", self.sensors / "walk.sto", "--json").out)
        self.assertEqual([sensor["name"] for sensor in facts["sensors"]], [f"{body}_imu" for body in BODIES])
        self.assertEqual(facts["missing"], 0)
        self.refused(3, ["DataType=Quaternion", "--orientations"], "convert", self.sensors / "walk.sto", "walk.mot")
