# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""What every command writes, prints and returns when all is well, and usage errors."""

import json
import re
import unittest

from support import CommandTest, real_file, report_data, table

MARKER_KEYS = (
    "points frames rate_hz first_frame last_frame units missing analog_channels analog_rate_hz force_plates labels warnings"
).split()
IK_FILES = ["q.mot", "q_marker_errors.sto", "q_report.json", "q_sd.sto"]


class HelpAndUsage(CommandTest):
    def test_help_of_every_command(self):
        for command in ([], ["simulate"], ["simulate", "subject"], ["simulate", "rig"], ["ik"], ["report"], ["serve"], ["info"], ["convert"], ["validate"]):
            ran = self.good(*command, "--help")
            self.assertIn("Usage: " + " ".join(["kinemark", *command]), ran.out)
            self.assertEqual(ran.err, "")
        everything = self.good("--help").out
        for word in ("--threads", "--seed", "--force", "--quiet", "--json", "Exit status: 0 good, 1", "validate"):
            self.assertIn(word, everything)
        self.assertRegex(self.good("--version").out, r"^kinemark \d+\.\d+\.\d+\n$")

    def test_help_is_text_that_a_terminal_shows(self):
        listed = re.findall(r"^  (\w+)  ", self.good("--help").out.split("Subcommands:")[1], re.MULTILINE)
        self.assertEqual(len(listed), 27, "a new command is to be looked at here too")
        inner = [["simulate", kind] for kind in ("subject", "arm", "macaque", "rig")]
        inner += [["study", paper] for paper in ("poizner", "macaque", "taichi")]
        inner += [["groups", what] for what in ("spm", "band", "norm", "retest")]
        for command in [[name] for name in listed] + inner:
            with self.subTest(command=command):
                self.assertTrue(self.good(*command, "--help").out.replace("\n", "").isprintable())

    def test_a_seed_is_a_whole_number_of_64_bits(self):
        for seed in ("-1", "1.5", "18446744073709551616", "0x10", "1e3"):
            self.refused(2, [f"'{seed}'", "0 to 18446744073709551615"], "simulate", "subject", "-o", "s", f"--seed={seed}")
        self.good("simulate", "arm", "-o", "s", "--frames", 2, "--seed", 18446744073709551615)

    def test_what_was_typed_wrong_is_one_sentence_that_names_the_help(self):
        self.refused(2, "'kinemark --help'")
        self.refused(2, "'kinemark --help'", "nope")
        self.refused(2, "'kinemark simulate --help'", "simulate")
        self.refused(2, ["--out", "'kinemark simulate subject --help'"], "simulate", "subject")
        self.refused(2, ["--what", "'kinemark ik --help'"], "ik", "--what")
        self.refused(2, ["--threads", "-1"], *self.ik(threads=-1))
        self.refused(2, ["'foo' is not square, huber or cauchy"], *self.ik(loss="foo"))
        self.refused(2, "noise", *self.ik(noise=-1))
        self.refused(2, "give --output", "ik", "-m", self.model, "-t", self.c3d, self.trc)
        self.refused(2, "no marker file", "ik", "-m", self.model, "-o", "q.mot")
        self.refused(2, "no model", "ik", "-t", self.c3d, "-o", "q.mot")
        self.refused(2, "different kinds", "convert", self.c3d, "x.osim")
        self.refused(2, ".xyz", "convert", self.c3d, "x.xyz")
        for options in (["--duration", -1], ["--rate", "nan"], ["--dropout-random", 2]):
            self.refused(2, "expected" if options[1] == 2 else "positive", "simulate", "subject", "-o", "s", *options)


class SimulateInfoValidate(CommandTest):
    def test_simulate_writes_the_recording_and_its_truth(self):
        names = sorted(path.name for path in self.recorded.iterdir())
        self.assertEqual(names, ["markers.c3d", "markers.trc", "model.osim", "truth.mot", "truth.trc"])
        ran = self.good("simulate", "subject", "-o", "a/b", "--duration", 0.2, "--seed", 7, "--json")
        self.assertEqual([p.rsplit("/", 1)[-1] for p in json.loads(ran.out)["written"]], names)
        other = self.good("simulate", "subject", "-o", "c", "--duration", 0.2, "--seed", 8, "--quiet")
        self.assertEqual((other.out, other.err), ("", ""))
        first, second = (self.folder / folder / "markers.trc" for folder in ("a/b", "c"))
        self.assertNotEqual(first.read_bytes(), second.read_bytes(), "another seed")
        self.refused(4, "use --force", "simulate", "subject", "-o", "c")

    def test_simulate_rig_writes_counts_and_truth_or_one_sentence(self):
        ran = self.good("simulate", "rig", "wheel", "-o", "w", "--leds", 8, "--highest-rate", "--duration", 0.2, "--json")
        report = json.loads(ran.out)
        names = ["recording.mcap", "truth.trc", "truth_derivatives.sto", "rig_true.toml", "rig_nominal.toml"]
        self.assertEqual([path.rsplit("/", 1)[-1] for path in report["written"]], names)
        self.assertIn("8 LEDs, 138.274 frames per second, 28 frames", report["warnings"])
        self.refused(4, "use --force", "simulate", "rig", "-o", "w")
        self.refused(2, "276.5 frames per second at most", "simulate", "rig", "sign", "-o", "s", "--rate", 300)
        self.refused(2, "there is no scene 'dance'", "simulate", "rig", "dance", "-o", "s")
        self.refused(2, "no physics", "simulate", "rig", "-o", "s", "--detector", "generic")
        self.refused(2, "neither a number nor", "simulate", "rig", "-o", "s", "--intensity", "bright")
        self.refused(4, "none.trc", "simulate", "rig", "markers", "-o", "s", "-t", "none.trc")
        self.assertFalse((self.folder / "s").exists())

    def test_info_of_markers_has_the_agreed_keys(self):
        facts = json.loads(self.good("info", self.c3d, "--json").out)
        self.assertLessEqual(set(MARKER_KEYS), set(facts))
        self.assertEqual((facts["points"], facts["frames"], facts["rate_hz"]), (40, 100, 100.0))
        self.assertEqual((facts["first_frame"], facts["last_frame"], facts["units"]), (1, 100, "mm"))
        self.assertEqual(len(facts["labels"]), 40)
        self.assertTrue(0.03 < facts["missing"] / 4000 < 0.07, facts["missing"])
        same = json.loads(self.good("info", self.trc, "--json").out)
        for key in ("points", "frames", "rate_hz", "missing", "labels"):
            self.assertEqual(same[key], facts[key], key)

    def test_info_of_models_and_tables(self):
        model = json.loads(self.good("info", self.model, "--json").out)
        self.assertEqual((model["kind"], model["coordinates"], model["markers"]), ("model", 40, 40))
        motion = json.loads(self.good("info", self.truth, "--json").out)
        self.assertEqual((motion["kind"], motion["rows"], motion["columns"], motion["in_degrees"]), ("table", 100, 40, True))
        self.assertRegex(self.good("info", self.truth).out, r"(?m)^rows +100$")

    def test_info_of_every_kind_has_its_keys_and_no_others(self):
        table_keys = "file kind rows columns first_time_s last_time_s in_degrees labels warnings contradicted".split()
        model_keys = "file kind name bodies joints coordinates markers couplings point_constraints mass_kg labels body_names warnings contradicted".split()
        self.assertEqual(list(json.loads(self.good("info", self.truth, "--json").out)), table_keys)
        model = json.loads(self.good("info", self.model, "--json").out)
        self.assertEqual(list(model), model_keys)
        self.assertEqual((len(model["body_names"]), len(model["labels"])), (model["bodies"], model["coordinates"]))
        for ending in ("trc", "csv", "nwb"):
            self.good("convert", self.c3d, f"k.{ending}")
            self.assertEqual(list(json.loads(self.good("info", f"k.{ending}", "--json").out)), list(json.loads(self.good("info", self.c3d, "--json").out)))

    def test_validate_takes_many_files_and_the_worst_counts(self):
        self.assertEqual(self.good("validate", self.c3d, self.trc, self.model, self.truth, "--quiet").err, "")
        self.write("short.trc", "\n".join(self.trc.read_text().split("\n")[:60]) + "\n")
        self.write("broken.c3d", b"nothing")
        ran = self.good("validate", self.c3d, "short.trc", "broken.c3d", "--json", status=3)
        self.assertEqual([entry["exit_status"] for entry in json.loads(ran.out)], [0, 1, 3])
        self.assertIn("broken.c3d", ran.err)


class Convert(CommandTest):
    def test_markers_there_and_back(self):
        self.good("convert", self.c3d, "a.trc")
        self.good("convert", "a.trc", "b.c3d")
        self.good("convert", "b.c3d", "c.trc")
        first, last = ((self.folder / name).read_text().split("\n")[1:] for name in ("a.trc", "c.trc"))
        self.assertEqual(first, last)
        facts = [json.loads(self.good("info", path, "--json").out) for path in (self.c3d, "b.c3d")]
        for key in ("points", "frames", "rate_hz", "missing", "units", "labels"):
            self.assertEqual(facts[0][key], facts[1][key], key)
        self.good("convert", self.c3d, "a.csv")

    def test_tables_and_models_there_and_back(self):
        self.good("convert", self.truth, "a.sto")
        self.good("convert", "a.sto", "b.mot")
        self.assertEqual(table(self.folder / "b.mot"), table(self.truth))
        self.good("convert", self.model, "a.osim")
        self.good("convert", "a.osim", "b.osim")
        facts = [json.loads(self.good("info", path, "--json").out) for path in (self.model, "b.osim")]
        for fact in facts:
            del fact["file"]
        self.assertEqual(*facts)
        # The same angles to the last digits: the models differ in rounding at most.
        self.good(*self.ik(output="q.mot"))
        self.good(*self.ik(output="r.mot", model="b.osim"))
        for one, other in zip(table(self.folder / "q.mot")[1], table(self.folder / "r.mot")[1], strict=True):
            for a, b in zip(one, other, strict=True):
                self.assertAlmostEqual(a, b, delta=1e-6)

    def test_nothing_is_replaced_without_force(self):
        self.write("x.trc", "mine")
        self.refused(4, ["x.trc", "exists already", "--force"], "convert", self.c3d, "x.trc")
        ran = self.good("convert", self.c3d, "x.trc", "--force", "--json")
        self.assertEqual(json.loads(ran.out)["written"], ["x.trc"])
        self.assertNotEqual((self.folder / "x.trc").read_text(), "mine")


class Ik(CommandTest):
    def test_writes_angles_errors_residuals_and_a_summary(self):
        ran = self.good(*self.ik())
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), IK_FILES)
        self.assertEqual(ran.out, "", "words for people go to stderr")
        self.assertIn("100 frames at 100 Hz, 40 markers, 40 coordinates", ran.err)
        names, rows = table(self.folder / "q.mot")
        true_names, true_rows = table(self.truth)
        self.assertEqual(names, true_names)
        knee = names.index("knee_angle_r")
        self.assertLess(max(abs(a[knee] - b[knee]) for a, b in zip(rows, true_rows)), 3.0, "degrees, 1 mm noise")
        self.refused(4, ["q.mot", "use --force"], *self.ik())
        self.good(*self.ik(), "--force")

    def test_quiet_and_json(self):
        ran = self.good(*self.ik(), "--quiet", "--json")
        self.assertEqual(ran.err, "")
        written = json.loads((self.folder / "q_report.json").read_text())
        for key in ("kinemark_set", "kinemark_sum"):
            self.assertRegex(written.pop(key), r"^[0-9a-f]{16}$")
        self.assertEqual(json.loads(ran.out), written)

    def test_report_from_the_files_has_the_data_of_the_direct_one(self):
        self.good(*self.ik(report="direct.html"))
        self.good("report", "q.mot", "-o", "later.html")
        direct, later = (json.loads(report_data((self.folder / n).read_text())) for n in ("direct.html", "later.html"))
        self.assertEqual(direct.keys(), later.keys())
        self.assertEqual(direct["summary"], later["summary"])
        page = (self.folder / "direct.html").read_text()
        self.assertNotRegex(page, r'(?:src|href)="https?:', "no network")

    def test_a_setup_and_tasks_and_weights(self):
        objects = "".join(
            f'<IKMarkerTask name="{name}"><apply>true</apply><weight>{weight}</weight></IKMarkerTask>'
            for name, weight in {"LASI": 1, "RASI": 2, "LPSI": 1, "RPSI": 1, "LKNE": 1, "RKNE": 1}.items()
        )
        tasks = f"<IKTaskSet><objects>{objects}</objects></IKTaskSet>"
        head = '<?xml version="1.0" encoding="UTF-8"?>\n<OpenSimDocument Version="40000">'
        self.write("tasks.xml", f"{head}{tasks}</OpenSimDocument>")
        self.write(
            "setup.xml",
            f"{head}<InverseKinematicsTool><model_file>{self.model}</model_file>{tasks}<marker_file>{self.trc}</marker_file>"
            "<time_range>0.2 0.5</time_range><output_motion_file>s.mot</output_motion_file></InverseKinematicsTool></OpenSimDocument>",
        )
        ran = self.good("ik", "--setup", "setup.xml", "--max-rms", 1000, "--max-offset", 1000, status=0)
        self.assertIn("31 frames at 100 Hz, 6 markers", ran.err)
        self.assertTrue((self.folder / "s.mot").is_file(), "beside the setup that names it")
        facts = json.loads((self.folder / "s_report.json").read_text())
        weights = {marker["name"]: marker["weight"] for marker in facts["markers"] if marker["weight"]}
        self.assertEqual(weights["RASI"], 2)
        self.good(*self.ik(tasks="tasks.xml", output="t.mot", weight="LKNE=0"))
        ran = self.good(*self.ik(output="w.mot", weight="LFHD=0"))
        self.assertIn("note: Marker LFHD was left out: given the weight 0", ran.err)

    def test_a_gate_that_is_missed_is_exit_status_1_and_the_files_are_there(self):
        ran = self.good(*self.ik(max_rms=0.1), status=1)
        self.assertIn("attention: The RMS distance", ran.err)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), IK_FILES)

    def test_markers_left_out_take_one_line_for_each_reason(self):
        ran = self.good(*self.ik(tasks=real_file("opensim-core-ik/gait2354_IK_Tasks.xml")), status=3)
        self.assertEqual(len(ran.err.splitlines()), 1)


class RealRecordings(CommandTest):
    def test_arm26_and_a_copy_800_mm_low(self):
        model = real_file("opensim-arm26/arm26.osim")
        self.good("ik", "-m", model, "-t", real_file("opensim-arm26/arm26_elbow_flex.trc"), "-o", "q.mot")
        low = real_file("opensim-arm26/arm26_elbow_flex_old_800mm_low.trc")
        ran = self.good("ik", "-m", model, "-t", low, "-o", "low.mot", status=1)
        self.assertRegex(ran.err, r"(?m)^attention: .*0\.800 m away.*$")
        self.good("ik", "--setup", real_file("opensim-arm26/arm26_Setup_InverseKinematics.xml"), "-o", "s.mot")
        self.assertEqual(table(self.folder / "s.mot"), table(self.folder / "q.mot"))

    def test_blank_and_foreign_markers_are_reported_in_two_lines(self):
        model = real_file("bmc-rajagopal-run/Scale/Rajagopal2015_scaled.osim")
        trc = real_file("bmc-rajagopal-run/ExpData/motion_capture_run.trc")
        ran = self.good("ik", "-m", model, "-t", trc, "-o", "q.mot")
        self.assertIn("note: 20 markers were left out: never seen: RASH, RPSH, ", ran.err)
        self.assertIn("note: 14 markers were left out: in the recording, not in the model: Mid_ASIS, ", ran.err)
        self.assertEqual(len(re.findall(r"(?m)^note: .*were left out: (?:never seen|in the recording)", ran.err)), 2)
        self.assertLess(len(ran.err.splitlines()), 20)


if __name__ == "__main__":
    unittest.main()
