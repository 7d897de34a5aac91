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

    def test_a_turned_sample_is_left_out_or_kept(self):
        lines = (self.sensors / "walk.sto").read_text().splitlines()
        first = next(i for i, line in enumerate(lines) if line.startswith("time"))
        column = lines[first].split("\t").index("tibia_r_imu")
        for row in (20, 21):
            cells = lines[first + 1 + row].split("\t")
            turned = product(tuple(float(v) for v in cells[column].split(",")), turn((0.6, 0.8, 0), 45))
            lines[first + 1 + row] = "\t".join((*cells[:column], ",".join(f"{v:.9f}" for v in turned), *cells[column + 1 :]))
        turned = self.write("turned.sto", "\n".join(lines) + "\n")
        alone = ("ik", "--model", self.model, "--orientations", turned, "--calibration", self.sensors / "pose.sto", "--force", "-o", "q.mot")
        for words, member in (((*alone, "--up", "z"), ()), ((*alone, "-t", self.trc, "--sensors-up", "z"), ("orientations",))):
            said = "sensor 'tibia_r_imu' is turned by up to"
            ran = self.good(*words)
            self.assertRegex(ran.err, said + r" 4\d deg against the samples before and after: 2 samples left out, at 0\.20 to 0\.21 s")
            report = json.loads((self.folder / "q_report.json").read_text())
            for key in member:
                report = report[key]
            self.assertEqual([(r["sensor"], r["in"], r["first_frame"], r["last_frame"]) for r in report["rejected"]], [("tibia_r_imu", "recording", 20, 21)])
            errors = columns_of(self.folder / "q_orientation_errors.sto")["tibia_r_imu"]
            self.assertEqual([i for i, error in enumerate(errors) if math.isnan(error)], [20, 21])
            kept = self.good(*words, "--doubtful", "keep")
            self.assertNotIn(said, kept.err)

    def test_a_page_of_sensors_alone_and_beside_markers(self):
        def page(name):
            text = (self.folder / name).read_text()
            return json.loads(re.search(r'<script type="application/json" id="kinemark-data">(.*?)</script>', text, re.DOTALL)[1])

        self.solve("--report", "q.html")
        alone = page("q.html")
        self.assertEqual([row["name"] for row in alone["sensors"]["rows"]], [f"{body}_imu" for body in BODIES])
        self.assertEqual(alone["summary"]["markers"], [])
        self.assertFalse([f["subject"] for f in alone["summary"]["findings"] if f["subject"].startswith("pelvis_t")], "positions are not asked of sensors")
        self.assertIn("subtalar_angle_r is never determined: no sensor fixes it.", [f["text"] for f in alone["summary"]["findings"]])
        self.assertIn("tibia_r_imu", alone["scene"]["names"])
        self.assertIn("femur_r", alone["scene"]["bodies"]["names"])
        locked = {c["name"] for c in alone["summary"]["coordinates"] if c["locked"]}
        self.assertIn("pelvis_tx", locked)
        self.assertNotIn("knee_angle_r", locked)
        self.assertFalse([f["text"] for f in alone["summary"]["findings"] if "marker" in f["text"]])
        self.refused(2, ["page", ".html"], "ik", "-m", self.model, "--orientations", self.sensors / "walk.sto", "-o", "r.mot", "--report", "r.txt")
        self.good("ik", "-m", self.model, "-t", self.trc, "--orientations", self.sensors / "walk.sto", "--sensors-up", "z", "-o", "m.mot", "--report", "m.html")
        beside = page("m.html")
        self.assertEqual(len(beside["sensors"]["rows"]), len(BODIES))
        self.assertEqual(len(beside["series"]["sensor_error_deg"]), len(BODIES))
        self.assertTrue(beside["summary"]["markers"])
        self.good("ik", "-m", self.model, "-t", self.trc, "-o", "n.mot", "--report", "n.html")
        self.assertIsNone(page("n.html")["sensors"])

    def test_what_is_not_for_sensors_is_refused(self):
        words = ("ik", "-m", self.model, "--orientations", self.sensors / "walk.sto", "-o", "q.mot")
        for option in (["--noise", 2], ["--torques"], ["--locations"], ["--frames", "1-9"]):
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

    def test_orientations_are_converted_and_taken_in_each_form(self):
        self.good("convert", self.sensors / "walk.sto", "walk.csv")
        self.good("convert", self.sensors / "pose.sto", "pose.csv", "--orientations")
        self.good("convert", "walk.csv", "back.sto", "--orientations")
        header = (self.folder / "walk.csv").read_text().splitlines()[0].split(",")
        self.assertEqual(header[:5], ["time", "pelvis_imu_w", "pelvis_imu_x", "pelvis_imu_y", "pelvis_imu_z"])
        common = ("ik", "-m", self.model, "--up", "z", "-o")
        self.good(*common, "a.mot", "--orientations", self.sensors / "walk.sto", "--calibration", self.sensors / "pose.sto")
        self.good(*common, "b.mot", "--orientations", "walk.csv", "--calibration", "pose.csv")
        self.good(*common, "c.mot", "--orientations", "back.sto", "--calibration", "pose.csv")
        one = columns_of(self.folder / "a.mot")
        for name in ("b.mot", "c.mot"):
            other = columns_of(self.folder / name)
            self.assertLess(max(abs(x - y) for label in one for x, y in zip(one[label], other[label])), 1e-6)
        self.refused(3, ["holds no orientations; they come as .sto", "ROTATION", "Motive"], "convert", self.trc, "o.sto", "--orientations")
        self.refused(2, ["orientations are written as .sto"], "convert", "walk.csv", "o.trc", "--orientations")
        self.refused(2, ["orientations are written as they are"], "convert", "walk.csv", "o.sto", "--orientations", "--select", "p*")
        self.refused(3, ["holds no orientations; they come as .sto"], *common, "d.mot", "--orientations", self.trc)
