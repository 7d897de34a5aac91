# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Every option of the commands that measure: it changes what is printed or written, or is refused. None is passed over."""

import json
import re
import shutil

from support import CommandTest, listing, real_file, run
from test_gait import NAMES, walk
from test_measures import write_trc

EVERYWHERE = {"--help", "--threads", "--seed", "--force", "--quiet", "--json", "--config", "--save-config"}
RECORDING = {
    "--rate": 50, "--unit": "mm", "--edits": "absent.jsonl", "--select": "?HEE,?TOE", "--drop": "SACR", "--rename": "SACR=SACRUM",
    "--frames": "20-380", "--start": 0.4, "--end": 3.9, "--up": "y", "--rotate": "x 90",
}
SPANS = {"--list": None, "--region": "part=1s-3s", "--between": "Foot Strike"}
INTERVALS = {"--refits": 39, "--level": 0.8}
DRAWN = {"--figures": "figures", "--figure-formats": "svg", "--report": "page.html"}
CYCLES = {"--write-events": "events.csv", "--write-cycles": "cycles.csv"}
FEET = {"--events": "plates", "--gait-marker": "left_heel=LTOE"}
SHEET = {"--norm": "absent.csv", "--angle-angle": "hip_flexion:knee_flexion"}
SEVERAL = {"--participants": "absent.tsv", "--jobs": 2}

WALK = ["walk.c3d", "--refits", 0]  # a real one, with plates, EMG and the markers of Plug-in Gait
OF_WALK = {"--select": "?ASI,?PSI,?HEE", "--drop": "RTOE", "--rename": "RTOE=OTHER", "--frames": "800-1000", "--start": 8.4, "--end": 9.9,
           "--gait-marker": "left_heel=LTOE", "--up": "x", "--doubtful": "perhaps"}
COMMANDS = {
    "measure": (["walk.trc", "--refits", 0], {**RECORDING, **SPANS, **INTERVALS, **DRAWN, **CYCLES, **SEVERAL, "--doubtful": "perhaps",
                                              "--measures": "path_length", "--noise": 3, "--output": "m.csv", "--events": "movement", "--trials": "absent",
                                              "--around": "units", "--window": "-0.2,0.2", "--bin": 0.05, "--spikes": "absent.nwb", "--clock-offset": 0.1,
                                              "--clock-sd": 0.05}),
    "gait": (WALK, {**RECORDING, **SPANS, **INTERVALS, **DRAWN, **CYCLES, **SEVERAL, **FEET, **SHEET, **OF_WALK, "--region": "part=8.4s-9.9s",
                    "--measures": "cadence", "--noise": 3, "--output": "m.csv", "--forces": "absent.mot", "--angles": "absent.mot"}),
    "emg": (WALK, {**RECORDING, **SPANS, **INTERVALS, **SEVERAL, **FEET, **OF_WALK, "--region": "part=8.4s-9.9s", "--measures": "emg_rms", "--select": "NOSE", "--drop": "NOSE",
                   "--rename": "NOSE=A", "--output": "m.csv", "--report": "page.html", "--channels": "NOSE", "--high-pass": 30, "--low-pass": 300,
                   "--envelope": 3, "--rms": 0.1, "--max": "trial", "--write-envelopes": "e.sto", "--write-cycles": "c.csv"}),
    "segments": ([*WALK, "--definition", "pig", "--noise", 1],
                 {**RECORDING, **INTERVALS, **DRAWN, **CYCLES, **FEET, **SHEET, **OF_WALK, "--noise": 3, "--output": "out", "--forces": "absent.mot",
                  "--definition": "absent.toml", "--static": "absent.c3d", "--vsk": "absent.vsk", "--subject": "LKneeWidth=nothing", "--trial": "a=absent.c3d"}),
    "dynamics": (["q.mot", "--model", "model.osim", "--refits", 0],
                 {**SPANS, **INTERVALS, **DRAWN, **CYCLES, **FEET, **SHEET, "--model": "absent.osim", "--setup": "absent.xml",
                  "--no-error-bars": None, "--bodies": "pelvis", "--point": "heel=pelvis:0,0", "--torques": None, "--cutoff": 6, "--couple": "a,b",
                  "--normalize": None, "--forces": "absent.mot", "--select": "knee*", "--start": 0.3, "--end": 0.7, "--measures": "joint_range",
                  "--region": "part=0.2s-0.5s", "--output": "m.csv"}),
}
# What changes nothing by itself, as it should, and with what it does.
AROUND = ["--around", "units", "--spikes", "session.nwb"]
WITH = {
    **{("measure", option): AROUND for option in ("--window", "--bin", "--clock-offset", "--clock-sd")},
    ("measure", "--level"): ["--refits=39"], ("gait", "--level"): ["--refits=39"], ("emg", "--level"): ["--refits=39"],
    ("gait", "--noise"): ["--refits=39"], ("dynamics", "--level"): ["--refits=39"], ("dynamics", "--no-error-bars"): ["--refits=39"],
    ("dynamics", "--normalize"): ["--torques"], ("dynamics", "--cutoff"): ["--torques"],
}
TABLES = ["q.mot", "--model", "model.osim", "--output", "tables"]
INSTEAD = {**{("dynamics", option): TABLES for option in ("--setup", "--bodies", "--point")},  # of tables, not of measures
           ("measure", "--spikes"): ["session.nwb", "--around", "units"]}
SAME = {("measure", "--jobs"), ("gait", "--jobs"), ("emg", "--jobs"),  # the bits are the same, whatever it is
        ("measure", "--up"), ("emg", "--up")}  # nothing that they measure has an up; a .c3d that is written has it


class EveryOptionTest(CommandTest):
    def setUp(self):
        super().setUp()
        inputs = self.folder / "inputs"
        inputs.mkdir()
        write_trc(inputs / "walk.trc", walk(), names=NAMES)
        shutil.copy(self.truth, inputs / "q.mot")
        shutil.copy(self.model, inputs / "model.osim")
        self.inputs, self.count, self.seen = inputs, 0, {}

    def observed(self, *words):
        """Exit status, what was printed, names and sizes of what was written; without the words of the command itself."""
        if words in self.seen:
            return self.seen[words]
        self.count += 1
        place = self.folder / f"run{self.count}"
        shutil.copytree(self.inputs, place)
        ran = run(*words, "--json", cwd=place)
        printed = re.sub(r'"command(_line)?": "[^"]*"', "", ran.out)
        tables = (".sto", ".csv", ".c3d")  # the size of other files varies with the words of the command
        files = sorted((name, len(data or "") * name.endswith(tables)) for name, data in listing(place).items())
        seen = (ran.status, printed, ran.err, files)
        shutil.rmtree(place)
        self.seen[words] = seen
        return seen

    def options(self, command):
        shown = self.good(command, "--help").out
        return set(re.findall(r"^  (?:-\w,\s*)?(--[a-z-]+)", shown, re.MULTILINE)) - EVERYWHERE

    def try_all(self, command):
        given = COMMANDS[command][1]
        self.assertEqual(self.options(command), set(given), "every option of the command is tried")
        for option, value in given.items():
            beside = WITH.get((command, option), [])
            words = INSTEAD.get((command, option), COMMANDS[command][0])
            names = {option, *(word.partition("=")[0] for word in beside)}
            others = [word for k, word in enumerate(words) if word not in names and (k == 0 or words[k - 1] not in names)]
            plain = words if not beside else [*others, *beside]
            whole = self.observed(command, *plain)
            self.assertIn(whole[0], (0, 1), whole[2])
            if (command, option) in SAME:
                continue
            with self.subTest(command=command, option=option):
                part = self.observed(command, *others, *beside, option, *([] if value is None else [value]))
                self.assertTrue(part != whole, "is passed over")
                if part[0] not in (0, 1):
                    said = part[2]
                    self.assertNotIn("is an option for", said, "it is heeded where it is shown")
                    self.assertNotIn("is required", said)
                    self.assertTrue(any(word in said for word in (option, *re.split("[=,]", str(value)))), said)

    def with_walk(self):
        shutil.copy(real_file("btk-others/PiG_Motion3_FF.c3d"), self.inputs / "walk.c3d")

    def test_measure(self):
        self.good("simulate", "macaque", "-o", "monkey", "--duration", 4, "--units", 2)
        shutil.copy(self.folder / "monkey" / "session.nwb", self.inputs / "session.nwb")
        self.try_all("measure")

    def test_gait(self):
        self.with_walk()
        self.try_all("gait")

    def test_emg(self):
        self.with_walk()
        self.try_all("emg")

    def test_segments(self):
        self.with_walk()
        self.try_all("segments")

    def test_dynamics(self):
        self.try_all("dynamics")


class OneCommandForOneThing(CommandTest):
    """`gait`, `measure`, `emg`, `segments` and `dynamics` find what `analyze` finds, and say where else to look."""

    def setUp(self):
        super().setUp()
        write_trc(self.folder / "walk.trc", walk(), names=NAMES)

    def values(self, *words):
        return json.loads(self.good(*words, "--refits", 0, "--json").out)

    def test_what_analyze_finds_and_which_command_shows_it(self):
        ran = self.good("analyze", "walk.trc", "--refits", 0, "--json")
        self.assertIn("This is 'kinemark gait' (feet and force plates), 'kinemark measure' (paths of markers).", ran.err)
        whole = json.loads(ran.out)["measures"]
        gait, paths = self.values("gait", "walk.trc")["measures"], self.values("measure", "walk.trc")["measures"]
        self.assertEqual(whole, gait + paths)
        self.assertTrue(gait and paths)
        self.assertNotIn("This is", self.good("gait", "walk.trc", "--refits", 0).err)
        self.assertIn("This is 'kinemark dynamics'.", self.good("analyze", self.truth, "-m", self.model, "--refits", 0).err)
        self.assertNotIn("'kinemark gait'", self.good("analyze", self.c3d, "--refits", 0).err)

    def test_dynamics_is_analyze_of_a_motion(self):
        for words in (["-m", self.model, "--refits", 0], ["-m", self.model, "-o", "tables"]):
            one = self.good("dynamics", self.truth, *words).out
            shutil.rmtree(self.folder / "tables", ignore_errors=True)
            self.assertEqual(one, self.good("analyze", self.truth, *words).out)

    def test_the_measure_of_another_command_is_named(self):
        self.refused(2, "cadence is no measure of 'kinemark measure'; 'kinemark gait' measures it", "measure", "walk.trc", "--measures", "cadence")
        self.refused(2, "'kinemark measure' measures it", "gait", "walk.trc", "--measures", "path_length")
        self.refused(2, "'kinemark measure' takes the markers' own", "gait", "walk.trc", "--events", "movement")
        self.refused(2, "'kinemark emg' measures it", "gait", "walk.trc", "--measures", "emg")
        self.refused(2, "'kinemark dynamics' measures it", "measure", "walk.trc", "--measures", "joint_range")

    def test_emg_is_of_muscles_alone(self):
        walk_c3d = self.folder / "walk.c3d"
        shutil.copy(real_file("btk-others/PiG_Motion3_FF.c3d"), walk_c3d)
        whole = self.values("analyze", walk_c3d)["measures"]
        parts = [self.values(command, walk_c3d)["measures"] for command in ("gait", "emg", "measure")]
        self.assertEqual(whole, [measure for part in parts for measure in part])
        with_cycles = self.values("emg", walk_c3d, "--write-cycles", "c.csv")
        self.assertEqual(with_cycles["measures"], parts[1])
        self.assertNotIn("gait", with_cycles, "walking only gave the cycles")
        self.assertTrue((self.folder / "c.csv").is_file())
        self.refused(2, "need --write-cycles", "emg", walk_c3d, "--events", "plates")
        for command in ("emg", "gait", "measure"):
            self.refused(3, "lies outside the recording", command, walk_c3d, "--region", "r=1-10", "--refits", 0)
        self.refused(3, "-z is stated to point up", "gait", "walk.trc", "--up", "-z", "--refits", 0)
        self.assertIn("Walking is not measured: -z is stated", self.good("gait", walk_c3d, "--up", "-z", "--refits", 0).err)
        self.assertIn("Walking is not measured: y is stated", self.good("analyze", walk_c3d, "--up", "y", "--refits", 0).err)
        self.refused(2, "--level", "segments", walk_c3d, "--definition", "pig", "--level", 0.6, "--write-events", "e.csv")

    def test_without_walking_no_report_is_drawn(self):
        shutil.copy(real_file("btk-others/PiG_Motion3_FF.c3d"), self.folder / "walk.c3d")
        words = ("gait", "walk.c3d", "--refits", 0, "--figures", "figures", "--select", "LASI")
        self.assertIn("no gait report is drawn, as there is no walking", self.good(*words).err)

    def test_walking_is_drawn(self):
        shutil.copy(real_file("btk-others/PiG_Motion3_FF.c3d"), self.folder / "walk.c3d")
        words = ("gait", "walk.c3d", "--refits", 0, "--figures", "figures")
        self.assertNotIn("no gait report is drawn, as there is no walking", self.good(*words).err)
        self.assertTrue((self.folder / "figures").is_dir())

    def test_the_list_is_that_of_the_command(self):
        lists = {command: {m["measure"] for m in json.loads(self.good(command, "--list", "--json").out)} for command in ("measure", "gait", "emg", "dynamics")}
        self.assertTrue("path_length" in lists["measure"] and "cadence" not in lists["measure"])
        self.assertTrue({"cadence", "peak_force"} & lists["gait"] and "emg_rms" not in lists["gait"])
        self.assertTrue(all(name.startswith("emg") for name in lists["emg"]))
        self.assertIn("joint_range", lists["dynamics"])
        self.refused(2, "--list takes nothing else", "gait", "--list", "--measures", "cadence")

    def test_a_file_of_another_kind_is_named(self):
        for command in ("measure", "gait", "emg"):
            self.refused(2, "is a motion, no recording of markers; 'kinemark dynamics' measures it", command, self.truth)
            self.refused(2, "IN is required", command)
        self.refused(2, "is a motion, no recording of markers", "segments", self.truth, "--definition", "pig")
        self.refused(2, "is no motion", "dynamics", "walk.trc", "-m", self.model)
        self.refused(2, "MOTION is required", "dynamics")

    def test_what_is_not_there_is_said(self):
        shutil.copy(self.c3d, self.folder / "still.c3d")
        self.refused(3, "still.c3d", "gait", "still.c3d", "--select", "LASI")
        self.refused(3, "EMG", "emg", "walk.trc")
        self.refused(2, "--definition", "segments", "walk.trc")
