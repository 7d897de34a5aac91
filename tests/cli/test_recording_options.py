# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""The options of a recording: in every command that reads one, with the same words, heeded or refused by name."""

import json
import re
import shutil

from support import CommandTest, read_csv, report_data, table

OPTIONS = ("--rate", "--unit", "--edits", "--select", "--drop", "--rename", "--frames", "--start", "--end", "--up", "--rotate", "--doubtful")
COMMANDS = ("info", "convert", "clean", "ik", "track", "joints", "scale", "measure", "analyze", "report")
NOT_SENSIBLE = {  # a value of each option, and what is said of it, whatever the command
    "--rate": ("-1", 2, "--rate is -1 Hz; need a number above 0"),
    "--unit": ("furlong", 2, "--unit: 'furlong' is no unit of length; need mm, cm or m"),
    "--edits": ("absent.jsonl", 4, "absent.jsonl"),
    "--select": ("NOSE", 3, "no marker is named 'NOSE'"),
    "--drop": ("NOSE", 3, "no marker is named 'NOSE'"),
    "--rename": ("NOSE=HEAD", 3, "no marker is named 'NOSE'"),
    "--frames": ("9-2", 2, "'9-2' is no range of frames"),
    "--start": ("nan", 2, "no time lies between"),
    "--end": ("nan", 2, "no time lies between"),
    "--up": ("w", 2, "'w' is not x, y, z"),
    "--rotate": ("x ninety", 2, "--rotate: 'x ninety' is not a rotation"),
    "--doubtful": ("perhaps", 2, "'perhaps' is not drop or keep"),
}


class RecordingOptionsTest(CommandTest):
    def setUp(self):
        super().setUp()
        shutil.copy(self.c3d, self.folder / "walk.c3d")
        facts = json.loads(self.good("info", "walk.c3d", "--json").out)
        self.labels, self.first, self.last = facts["labels"], facts["first_frame"], facts["last_frame"]

    def words(self, command):
        """Arguments by which a command does its work on walk.c3d."""
        return {
            "info": ["info", "walk.c3d", "--json"],
            "convert": ["convert", "walk.c3d", "out.csv", "--force"],
            "clean": ["clean", "walk.c3d", "out.csv", "--force"],
            "ik": ["ik", "-m", self.model, "-t", "walk.c3d", "-o", "q.mot", "--force", "--no-error-bars"],
            "track": ["track", "-m", self.model, "-t", "walk.c3d", "-o", "q.mot", "--force", "--no-error-bars"],
            "joints": ["joints", "walk.c3d", "-o", "centres", "--force"],
            "scale": ["scale", "-m", self.model, "-t", "walk.c3d", "-o", "scaled.osim", "--force", "--max-frames", 10],
            "analyze": ["analyze", "walk.c3d", "--measures", "path_length", "--refits", 0, "-o", "out.csv", "--force"],
            "measure": ["measure", "walk.c3d", "--measures", "path_length", "--refits", 0, "-o", "out.csv", "--force"],
            "report": ["report", "walk.c3d", "-o", "page.html", "--force"],
        }[command]

    def numbers(self, command, *more):
        """What the command finds, without how it was asked; with its sentences."""
        ran = self.run_in(*self.words(command), *more)
        self.assertIn(ran.status, (0, 1), ran.err)
        if command == "info":
            found = json.loads(ran.out)
            found.pop("warnings", None)
        elif command in ("convert", "clean", "measure", "analyze"):
            found = read_csv(self.folder / "out.csv")
        elif command in ("ik", "track"):
            found = table(self.folder / "q.mot")
        elif command == "joints":
            found = json.loads((self.folder / "centres/skeleton.json").read_text())
            found = {key: found[key] for key in found if key not in ("kinemark_set", "kinemark_sum", "input") and "kinemark joints" not in str(found[key])}
        elif command == "scale":
            found = (self.folder / "scaled.osim").read_text()
        else:
            found = json.loads(report_data((self.folder / "page.html").read_text()))["scene"]
        return found, ran.err + ran.out

    def test_what_makes_no_sense_is_said_alike(self):
        for command in COMMANDS:
            for option in OPTIONS:
                value, status, words = NOT_SENSIBLE[option]
                with self.subTest(command=command, option=option):
                    self.refused(status, words, *self.words(command), f"{option}={value}")

    def test_a_journal_beside_is_applied_and_said(self):
        before = {command: self.numbers(command)[0] for command in COMMANDS}
        self.good("edit", "walk.c3d", "--crop", "--from", self.first + 12)
        for command in COMMANDS:
            with self.subTest(command=command):
                after, said = self.numbers(command)
                self.assertNotEqual(after, before[command])
                if command != "report":  # its page says so
                    self.assertIn("1 edit of walk_edits.jsonl was applied", said)
                none, said = self.numbers(command, "--edits", "none")
                self.assertEqual(none, before[command])
                self.assertNotIn("walk_edits.jsonl", said)
        self.assertIn("1 edit of walk_edits.jsonl was applied", (self.folder / "page.html").read_text() + self.page())

    def page(self):
        self.good(*self.words("report"))
        return (self.folder / "page.html").read_text()

    def test_what_is_given_is_heeded(self):
        given = {
            "--select": ",".join(self.labels[:-2]),
            "--drop": "LASI",
            "--frames": f"{self.first + 15}-",
            "--start": "0.3",
            "--end": "0.7",
            "--rotate": "y 40",
        }
        same = {("clean", "--select")}
        for command in COMMANDS:
            whole = self.numbers(command)[0]
            for option, value in given.items():
                if option == "--rotate" and command in ("info", "measure", "analyze", "scale", "joints"):
                    continue  # lengths and sizes do not change: the note alone says it
                with self.subTest(command=command, option=option):
                    part, _ = self.numbers(command, option, value)
                    if (command, option) not in same:
                        self.assertNotEqual(part, whole)

    def test_times_and_frames_are_one_part(self):
        first, last = self.first + 12, self.first + 42
        rate = json.loads(self.good("info", "walk.c3d", "--json").out)["rate_hz"]
        times = ("--start", (first - self.first) / rate, "--end", (last - self.first) / rate)
        begin = json.loads(self.good("info", "walk.c3d", "--json").out)
        for command in ("convert", "measure", "analyze", "joints", "ik"):
            with self.subTest(command=command):
                t0 = (begin["first_frame"] - 1) / rate
                by_time = self.numbers(command, times[0], f"{times[1] + t0:.9f}", times[2], f"{times[3] + t0:.9f}")[0]
                by_frame = self.numbers(command, "--frames", f"{first}-{last}")[0]
                if command == "ik":
                    self.assertEqual(by_time[0], by_frame[0])
                    self.assertEqual(len(by_time[1]), len(by_frame[1]))
                    for one, other in zip(by_time[1], by_frame[1]):
                        for a, b in zip(one, other):
                            self.assertAlmostEqual(a, b, places=6)
                else:
                    self.assertEqual(by_time, by_frame)

    def test_a_part_by_options_is_a_part_by_file(self):
        frames = f"{self.first + 12}-{self.first + 42}"
        self.good("convert", "walk.c3d", "part.c3d", "--frames", frames, "--drop", self.labels[0], "--quiet")
        for command in ("clean", "joints", "measure", "analyze"):
            with self.subTest(command=command):
                by_option = self.numbers(command, "--frames", frames, "--drop", self.labels[0])[0]
                shutil.copy(self.folder / "walk.c3d", self.folder / "kept.c3d")
                shutil.copy(self.folder / "part.c3d", self.folder / "walk.c3d")
                by_file = self.numbers(command)[0]
                shutil.copy(self.folder / "kept.c3d", self.folder / "walk.c3d")
                self.assertEqual(str(by_option).replace("part.c3d", "walk.c3d"), str(by_file).replace("part.c3d", "walk.c3d"))

    def test_files_that_are_no_recordings_refuse_them(self):
        self.refused(2, "is no recording", "info", self.model, "--drop", "A")
        self.refused(2, "is no recording", "convert", self.truth, "a.sto", "--frames", "1-2")
        self.good(*self.ik())
        self.refused(2, "are for marker files", "report", "q.mot", "-o", "p.html", "--drop", "A")

    def test_a_stated_vertical_goes_into_what_is_written(self):
        self.good("convert", "walk.c3d", "up.c3d", "--up", "y")
        self.good("clean", "walk.c3d", "clean.c3d", "--up", "y")
        self.good("analyze", "walk.c3d", "--select", "LASI", "--events", "movement", "--write-events", "events.c3d", "--up", "y")
        for name in ("up.c3d", "clean.c3d", "events.c3d"):
            self.assertEqual(json.loads(self.good("info", name, "--json").out)["up"], "y, by POINT:Y_SCREEN of the file", name)
        self.assertEqual(json.loads(self.good("info", "walk.c3d", "--up", "x", "--json").out)["up"], "x, by --up")

    def test_a_rate_is_for_those_of_several_that_store_none(self):
        rows = [[word] * 3 for word in ("reach.c3d", "A", "TARGET", "PROCESSED")]
        head = "".join("\t" + "\t".join(row) + "\n" for row in rows) + "ITEM\tX\tY\tZ\n"
        self.write("reach.v3d", head + "".join(f"{i}\t{0.01 * i}\t0.1\t0.2\n" for i in range(1, 40)))
        self.refused(2, "rate", "convert", "walk.c3d", "walk.csv", "--rate", 50)
        self.good("convert", "reach.v3d", "walk.c3d", "out", "--to", "csv", "--rate", 50)
        self.assertEqual(sorted(path.name for path in (self.folder / "out").iterdir()), ["reach.csv", "walk.csv"])


    def test_a_unit_is_for_tables_that_state_none(self):
        self.refused(2, "states the unit of its coordinates", "convert", "walk.c3d", "walk.csv", "--unit", "mm")
        self.write("reach.csv", "time,A_X,A_Y,A_Z\n" + "".join(f"{0.01 * i:.2f},{100 + i},20,{30 + 10 * i}\n" for i in range(40)))
        self.refused(3, ["reach.csv", "--unit mm, cm or m"], "convert", "reach.csv", "a.csv")
        self.good("convert", "reach.csv", "walk.c3d", "out", "--to", "csv", "--unit", "mm")
        self.assertEqual(read_csv(self.folder / "out/reach.csv")[0]["x_m"], "0.1")


class EveryOptionOfAnalyze(CommandTest):
    """An option of `analyze` changes what is found, or is refused by name."""

    GIVEN = {
        "--model": "MODEL", "--forces": "walk.c3d", "--setup": "none.xml", "--no-error-bars": None, "--bodies": "pelvis", "--point": "heel=pelvis:0,0,0",
        "--torques": None, "--cutoff": "6", "--couple": "a,b", "--normalize": None, "--list": None, "--measures": "path_length", "--region": "a=5-20",
        "--between": "Foot Strike", "--noise": "1", "--refits": "0", "--level": "0.9", "--figures": "figures", "--figure-formats": "svg",
        "--report": "page.html", "--norm": "norm.csv", "--angle-angle": "a:b", "--write-events": "events.csv", "--write-cycles": "cycles.csv",
        "--gait-marker": "left_heel=A", "--events": "movement", "--angles": "a.mot", "--emg": "A", "--emg-high-pass": "30", "--emg-low-pass": "300",
        "--emg-envelope": "5", "--emg-rms": "0.1", "--emg-max": "max.c3d", "--write-emg": "e.sto", "--write-emg-cycles": "e.csv",
        "--participants": "nofile.tsv", "--jobs": "3", "--segments": "pig", "--static": "walk.c3d", "--vsk": "a.vsk", "--subject": "LLegLength=920",
        "--trial": "a=walk.c3d", "--rate": "50", "--edits": "none.jsonl", "--select": "NOSE", "--drop": "NOSE", "--rename": "NOSE=A", "--frames": "9-2",
        "--start": "0.2", "--end": "0.8", "--up": "y", "--rotate": "x 90", "--doubtful": "keep", "--output": "out",
    }
    # An option that a kind of analysis heeds is not tried with it here: other tests show what it does.
    HEEDED = {
        "segments": "forces noise refits level figures figure-formats report norm angle-angle write-events write-cycles gait-marker events segments static vsk "
        "subject trial rate edits select drop rename frames start end up rotate doubtful output",
        "tables": "model forces setup no-error-bars bodies point torques cutoff start end output",
        "motion": "model forces setup no-error-bars torques cutoff couple normalize measures region between refits level figures figure-formats report norm "
        "angle-angle write-events write-cycles gait-marker events select start end output",
        "markers": "forces measures region between noise refits level figures figure-formats report norm angle-angle write-events write-cycles gait-marker events "
        "angles emg emg-high-pass emg-low-pass emg-envelope emg-rms emg-max write-emg write-emg-cycles participants jobs rate edits select drop rename "
        "frames start end up rotate doubtful output list",
    }

    def test_what_is_not_heeded_is_refused_by_name(self):
        shutil.copy(self.c3d, self.folder / "walk.c3d")
        shutil.copy(self.truth, self.folder / "q.mot")
        kinds = {
            "segments": ["analyze", "walk.c3d", "--segments", "pig"],
            "tables": ["analyze", "q.mot", "-m", self.model, "-o", "folder", "--bodies", "pelvis"],
            "motion": ["analyze", "q.mot", "-m", self.model, "-o", "out.csv"],
            "markers": ["analyze", "walk.c3d"],
        }
        known = set(re.findall(r"^  (?:-\w,\s*)?(--[a-z-]+)", self.good("analyze", "--help").out, re.MULTILINE))
        common = {"--help", "--threads", "--seed", "--force", "--quiet", "--json", "--config", "--save-config", "--color"}
        self.assertLessEqual(known - common, set(self.GIVEN), "every option is tried")
        refused = 0
        for kind, words in kinds.items():
            for option, value in self.GIVEN.items():
                if option[2:] in self.HEEDED[kind].split():
                    continue
                if kind in ("markers", "tables", "motion") and option in ("--model", "--setup", "--segments", "--static", "--vsk", "--subject", "--trial", "--bodies", "--point", "--list"):
                    continue  # these say which kind of analysis it is
                with self.subTest(kind=kind, option=option):
                    given = [option] if value is None else [option, str(self.model) if value == "MODEL" else value]
                    self.refused(2, option, *words, *given)
                    refused += 1
        self.assertGreater(refused, 60)
