# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""kinemark analyze: what bodies and points do along a motion, by options and by OpenSim's setups."""

import json
import math

from support import CommandTest


def read_table(path):
    """{column: [value of each row]} of a .mot or .sto file."""
    lines = path.read_text().split("endheader\n")[1].splitlines()
    names = lines[0].split("\t")
    rows = [[float(v) for v in line.split("\t")] for line in lines[1:]]
    return {name: [row[i] for row in rows] for i, name in enumerate(names)}


class AnalyzeTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.good("simulate", "subject", "--out", "in", "--duration", "1", "--quiet")

    def analyze(self, *more):
        return ["analyze", "in/truth.mot", "--model", "in/model.osim", *more]

    def test_the_way_of_the_readme(self):
        done = self.good(*self.analyze("-o", "out", "--torques", "--point", "toe=calcn_r:0.15,0,0", "--point", "still=ground:0,0,0"))
        self.assertIn("rows at 100 Hz from 0 s.", done.err)
        names = {path.name for path in (self.folder / "out").iterdir()}
        for name in ("Kinematics_q", "Kinematics_u", "Kinematics_dudt", "BodyKinematics_pos_global", "BodyKinematics_vel_global",
                     "BodyKinematics_acc_global", "PointKinematics_toe_pos", "PointKinematics_toe_vel", "PointKinematics_toe_acc",
                     "inverse_dynamics"):
            self.assertTrue({f"truth_{name}.sto", f"truth_{name}_sd.sto"} <= names, name)
        toe, speed = (read_table(self.folder / f"out/truth_PointKinematics_toe_{k}.sto") for k in ("pos", "vel"))
        for axis in ("state_0", "state_1", "state_2"):
            for i in range(10, len(toe["time"]) - 10):
                self.assertAlmostEqual(speed[axis][i], 50.0 * (toe[axis][i + 1] - toe[axis][i - 1]), delta=0.05)

    def test_what_was_done_as_json(self):
        done = self.good(*self.analyze("-o", "out", "--json", "--quiet"))
        done_json = json.loads(done.out)
        self.assertEqual(len(done_json["written"]), 13)
        self.assertEqual(done_json["rate_hz"], 100)
        self.assertEqual(done_json["facts"]["deviations"], "from the noise found in each coordinate")
        record = json.loads((self.folder / "out/truth_analysis.json").read_text())
        self.assertEqual([i["role"] for i in record["inputs"]], ["model", "motion"])
        self.assertIn("analyze in/truth.mot", record["command"])

    def test_a_body_in_free_fall_accelerates_as_gravity(self):
        # A motion whose root falls: 9.81 m/s^2 down, all else at rest.
        motion = read_table(self.folder / "in/truth.mot")
        names = list(motion)
        lines = ["fall", "version=1", "nRows=60", f"nColumns={len(names)}", "inDegrees=yes", "endheader", "\t".join(names)]
        for i in range(60):
            t = i / 60
            fall = {"time": t, "pelvis_ty": 5 - 0.5 * 9.81 * t * t}
            lines.append("\t".join(repr(fall.get(name, 0.0)) for name in names))
        self.write("fall.mot", "\n".join(lines) + "\n")
        self.good("analyze", "fall.mot", "-m", "in/model.osim", "-o", "out", "--bodies", "center_of_mass,pelvis")
        table = read_table(self.folder / "out/fall_BodyKinematics_acc_global.sto")
        self.assertEqual(set(table), {"time", "pelvis_X", "pelvis_Y", "pelvis_Z", "pelvis_Ox", "pelvis_Oy", "pelvis_Oz",
                                      "center_of_mass_X", "center_of_mass_Y", "center_of_mass_Z"})
        for i in range(10, 50):
            self.assertAlmostEqual(table["center_of_mass_Y"][i], -9.81, delta=1e-3)
            self.assertAlmostEqual(table["pelvis_Ox"][i], 0.0, delta=1e-3)

    def test_a_setup_and_options_over_it(self):
        self.write("in/setup.xml", """<OpenSimDocument Version="40000"><AnalyzeTool name="walk"><model_file>C:\\lab\\model.osim</model_file>
<coordinates_file>truth.mot</coordinates_file><results_directory>results</results_directory>
<initial_time>0.2</initial_time><final_time>0.5</final_time><AnalysisSet><objects>
<PointKinematics name="P"><body_name>tibia_r</body_name><point_name>k</point_name><point>0 0.1 0</point></PointKinematics>
<MuscleAnalysis name="muscles"/></objects></AnalysisSet></AnalyzeTool></OpenSimDocument>""")
        done = self.good("analyze", "--setup", "in/setup.xml")
        self.assertIn("'model.osim' beside the setup is read instead", done.err)
        self.assertIn("'muscles' is passed over", done.err)
        self.assertEqual({p.name for p in (self.folder / "in/results").iterdir()},
                         {f"walk_P_k_{k}{sd}.sto" for k in ("pos", "vel", "acc") for sd in ("", "_sd")} | {"walk_analysis.json"})
        times = read_table(self.folder / "in/results/walk_P_k_pos.sto")["time"]
        self.assertTrue(math.isclose(times[0], 0.2) and math.isclose(times[-1], 0.5))
        self.good("analyze", "--setup", "in/setup.xml", "--end", "0.3", "-o", "mine", "--no-error-bars")
        self.assertTrue(math.isclose(read_table(self.folder / "mine/walk_P_k_pos.sto")["time"][-1], 0.3))
        self.assertFalse((self.folder / "mine/walk_P_k_pos_sd.sto").exists())

    def test_its_tables_are_read_by_the_others(self):
        self.good(*self.analyze("-o", "out"))
        done_json = json.loads(self.good("info", "--json", "out/truth_BodyKinematics_pos_global.sto").out)
        self.assertIn("rows", json.dumps(done_json))
        self.good("convert", "out/truth_Kinematics_q.sto", "again.bvh", "--model", "in/model.osim")

    def test_what_is_wrong_is_one_sentence_and_leaves_nothing(self):
        self.refused(2, "no motion: give a .mot or .sto", "analyze", "-m", "in/model.osim", "-o", "out")
        self.refused(2, "no model: give --model", "analyze", "in/truth.mot", "-o", "out")
        self.refused(2, "no folder for the results: give --output", *self.analyze("--bodies", "pelvis"))
        for point in ("toe", "=calcn_r:0,0,0", "toe=:0,0,0", "toe=calcn_r:0,0", "toe=calcn_r:0,0,x", "toe=calcn_r:0,0,0,0"):
            self.refused(2, "is not NAME=BODY:X,Y,Z", *self.analyze("-o", "out", "--point", point))
        self.refused(2, "point 'toe' names body 'hoof'", *self.analyze("-o", "out", "--point", "toe=hoof:0,0,0"))
        self.refused(2, "names body 'tail'", *self.analyze("-o", "out", "--bodies", "tail"))
        self.refused(2, "is no range of time", *self.analyze("-o", "out", "--start", "2", "--end", "1"))
        self.refused(2, "no row lies between", *self.analyze("-o", "out", "--start", "70"))
        self.refused(3, "m.osim", "analyze", "in/truth.mot", "-m", self.write("m.osim", "<x/>"), "-o", "out")
        self.refused(4, "none.mot", "analyze", "none.mot", "-m", "in/model.osim", "-o", "out")
        self.refused(3, "has no <AnalyzeTool>", *self.analyze("--setup", self.write("s.xml", "<OpenSimDocument/>"), "-o", "out"))
        self.write("short.mot", "short\nversion=1\nendheader\ntime\tpelvis_ty\n0\t1\n0.1\t1\n")
        self.refused(3, "the motion has 2 frames", "analyze", "short.mot", "-m", "in/model.osim", "-o", "out")
        self.assertFalse((self.folder / "out").exists())
        self.good(*self.analyze("-o", "out", "--quiet"))
        before = {p.name: p.read_bytes() for p in (self.folder / "out").iterdir()}
        self.refused(4, "--force", *self.analyze("-o", "out"))
        self.assertEqual(before, {p.name: p.read_bytes() for p in (self.folder / "out").iterdir()})
        self.good(*self.analyze("-o", "out", "--force", "--quiet"))
