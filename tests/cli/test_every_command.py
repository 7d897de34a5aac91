# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Every option of every command that does not measure: it changes what is printed or written, or is refused by name. Those that
belong to one choice are refused with another. test_every_option.py does this for the commands that measure."""

import json
import math
import re
import shutil

from options_tried import EVERYWHERE, INSTEAD, REFUSED, SAME, TRIED, WITH, options_in
from support import CommandTest, run

MEASURE = {"measure", "gait", "emg", "segments", "dynamics", "analyze"}  # test_every_option.py
ELSEWHERE = {"serve", "study poizner", "study macaque", "study taichi"}  # what they refuse is tried here, what they do in files of their own
VOLATILE = {"command", "command_line", "kinemark_set", "kinemark_sum", "set", "options", "seed", "threads"}  # say what was asked, not what was found


def found(value):
    """What JSON holds of results: without times of work and words of the command."""
    if isinstance(value, dict):
        return {key: found(one) for key, one in value.items() if key not in VOLATILE and key not in ("solve_s", "clean_s", "scale_s")}
    return [found(one) for one in value] if isinstance(value, list) else value


def content(path):
    """What a file holds of results."""
    data = path.read_bytes()
    if path.suffix == ".json":
        return found(json.loads(data))
    if path.suffix == ".html":
        return re.sub(rb'"command_line":"[^"]*"|"(solve|clean|scale)_s":[0-9.e-]*', b"", data)
    return re.sub(rb'kinemark_s(et|um) ?= ?"?\w*|set = "\w*"', b"", data)


def curves():
    rows = ["who,when,percent,at,value,other"]
    for k, who in enumerate("abc"):
        for when in "xy":
            rows += [f"{who},{when},{p},{100 - p},{math.sin(p / 20 + k) + (when == 'x') * p / 50:.5f},{math.cos(p / 9 + k):.5f}"
                     for p in range(0, 101, 10)]
    return "\n".join(rows) + "\n"


def measures():
    return "participant,session,measure,value,sd\n" + "".join(
        f"P{p},{s},speed,{p + 0.1 * math.sin(7 * p + s):.4f},0.01\n" for p in range(5) for s in (1, 2))


def exchanged(text, one, other, first):
    """A TRC whose markers, by their places, carry each other's label from a frame on."""
    lines = text.split("\n")
    for i, line in enumerate(lines[6:], 6):
        cells = line.split("\t")
        if len(cells) < 8 or int(cells[0]) < first:
            continue
        a, b = 2 + 3 * one, 2 + 3 * other
        cells[a : a + 3], cells[b : b + 3] = cells[b : b + 3], cells[a : a + 3]
        lines[i] = "\t".join(cells)
    return "\n".join(lines)


class EveryCommandTest(CommandTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.inputs, cls.seen = cls.recorded.parent / "inputs", {}
        cls.inputs.mkdir()
        cls.make("body", "subject", "--duration", 0.3, "--dropout-random", 0.05, markers="body.trc", model="body.osim")
        cls.make("still", "subject", "--duration", 2, "--rate", 50, "--noise", 0.3, markers="whole.trc")
        cls.make("arm", "arm", "--frames", 60, "--markers", 4, "--stagger", 15, markers="arm.trc", segments="arm.toml")
        cls.make("leg", "arm", "--frames", 50, "--markers", 4, "--stagger", 15, markers="leg.trc")
        cls.make("fast", "arm", "--frames", 60, "--markers", 4, "--stagger", 15, "--upsample", 4, markers="fast.trc")
        cls.make("lab", "rig", "sign", "--duration", 0.3, "--grid", "--tree-poses", "--scan", "--dark-slot", "--occlude", "all:A:5-14",
                 recording="recording.mcap", grid_A="grid_A.mcap", grid_B="grid_B.mcap", tree_poses="tree_poses.mcap", scan="scan.mcap",
                 rig_true="rig.toml")
        made = run("convert", "body.trc", "legs.trc", "--select", "?KNE,?ANK,?TOE,?HEE", cwd=cls.inputs)
        assert made.status == 0, made.err
        made = run("convert", "whole.trc", "swapped.trc", "--select", "?KNE,?ANK,?TOE,?HEE", cwd=cls.inputs)
        assert made.status == 0, made.err
        swapped = cls.inputs / "swapped.trc"
        swapped.write_text(exchanged(swapped.read_text(), 0, 1, 40))
        (cls.inputs / "cut.mcap").write_bytes((cls.inputs / "recording.mcap").read_bytes()[:-100])
        (cls.inputs / "curves.csv").write_text(curves())
        (cls.inputs / "measures.csv").write_text(measures())
        (cls.inputs / "study.toml").write_text('steps = ["clean"]\n\n[[subject]]\nname = "A"\ntrials = ["body.trc"]\n')
        made = run("groups", "band", "curves.csv", "--curve", "who,when", "--output", "norm.csv", cwd=cls.inputs)
        assert made.status == 0, made.err

    @classmethod
    def make(cls, name, kind, *words, **files):
        """Simulate, and keep some of the files under other names."""
        made = run("simulate", kind, *words, "--out", name, cwd=cls.inputs)
        assert made.status == 0, made.err
        for file, kept in files.items():
            shutil.move(next((cls.inputs / name).glob(f"{file}.{kept.rpartition('.')[2]}")), cls.inputs / kept)
        shutil.rmtree(cls.inputs / name)

    def observed(self, *words):
        """Exit status, what was printed, what was noted, and what was written, but for the words of the command itself."""
        if words in self.seen:
            return self.seen[words]
        place = self.folder / "place"
        shutil.copytree(self.inputs, place)
        ran = run(*words, *([] if words[0] in ("help", "completion") else ["--json"]), cwd=place)
        printed = found(json.loads(ran.out)) if ran.out.startswith(("{", "[")) else ran.out
        files = {path.relative_to(place): content(path) for path in sorted(place.rglob("*"))
                 if path.is_file() and not (self.inputs / path.relative_to(place)).exists()}
        shutil.rmtree(place)
        self.seen[words] = (ran.status, printed, files, ran.err)
        return self.seen[words]

    def refused_by_name(self, said, option, value):
        """One sentence, which names the option or what it was given."""
        self.assertEqual(len(said.splitlines()), 1, said)
        self.assertNotIn("is required", said)
        values = [part for one in (value if isinstance(value, list) else [value]) for part in re.split("[=,]", str(one))]
        self.assertTrue(any(word in said.lower() for word in (option[2:], *values)), said)

    def try_option(self, command, option, value):
        words, beside = INSTEAD.get((command, option), TRIED[command][0]), WITH.get((command, option), [])
        names = {option, *(word for word in beside if str(word).startswith("--"))}
        others = [word for k, word in enumerate(words) if word not in names and (k == 0 or words[k - 1] not in names)]
        given = [option, *([] if value is None else value if isinstance(value, list) else [value])]
        path = command.split()
        whole = self.observed(*path, *(words if not beside else [*others, *beside]))
        part = self.observed(*path, *others, *beside, *given)
        if part[0] in (0, 1):
            self.assertIn(whole[0], (0, 1), whole[3])
            self.assertTrue(part[:3] != whole[:3], "is passed over")
        else:
            self.refused_by_name(part[3], option, value)
        if beside:
            alone = self.observed(*path, *words, *given)
            self.assertEqual(alone[0], 2, "it means nothing here")
            self.assertIn(option, alone[3])

    def try_all(self, *commands):
        for command in commands:
            given = TRIED[command][1]
            self.assertEqual(options_in(self.good(*command.split(), "--help").out), set(given), "every option of the command is tried")
            for option, value in given.items():
                if (command, option) not in SAME:
                    with self.subTest(command=command, option=option):
                        self.try_option(command, option, value)

    def test_every_command_is_tried(self):
        def below(*path):
            shown = self.good(*path, "--help").out.partition("Subcommands:")[2]
            names = re.findall(r"^  ([a-z]+) ", shown, re.MULTILINE)
            return [one for name in names for one in below(*path, name)] if names else [" ".join(path)]

        self.assertEqual(set(below()), set(TRIED) | MEASURE | ELSEWHERE)

    def test_files(self):
        self.try_all("info", "validate", "convert", "report", "recover", "edit")

    def test_clean_and_joints(self):
        self.try_all("clean", "joints")

    def test_scale(self):
        self.try_all("scale")

    def test_ik(self):
        self.try_all("ik")

    def test_track(self):
        self.try_all("track")

    def test_groups(self):
        self.try_all("groups spm", "groups band", "groups norm", "groups retest")

    def test_rigs(self):
        self.try_all("acquire", "calibrate", "reconstruct")

    def test_simulations(self):
        self.try_all("simulate subject", "simulate arm", "simulate macaque", "simulate rig")

    def test_help_completion_run(self):
        self.try_all("help", "completion", "run")

    def test_what_means_nothing_is_refused_by_name(self):
        for name in ("legs.trc", "body.trc", "body.osim", "arm.trc", "rig.toml", "recording.mcap", "cut.mcap", "curves.csv", "measures.csv"):
            shutil.copy(self.inputs / name, self.folder / name)
        for words, option, said in REFUSED:
            with self.subTest(words=words, option=option):
                more = [] if option in words.split() or option == "COMMAND" or any(w.startswith(option + "=") for w in words.split()) else [option]
                self.refused(2, [option.partition("=")[0], said], *words.split(), *more)

    def test_a_motion_goes_beside_its_recording(self):
        for name in ("body.trc", "body.osim"):
            shutil.copy(self.inputs / name, self.folder / name)
        for command in ("ik", "track"):
            self.good(command, "-m", "body.osim", "-t", "body.trc", "--quiet", *([] if command == "ik" else ["--force"]))
            self.assertTrue((self.folder / "body.mot").is_file() and (self.folder / "body_report.json").is_file())
            self.refused(4, "body.mot: exists already; use --force to replace it", command, "-m", "body.osim", "-t", "body.trc")
            self.refused(2, "body.mot", command, "-m", "body.osim", "-t", "body.trc", "--forces", "body.mot", "--force")
        self.refused(2, "need a folder for what is made of them; give --output", "ik", "-m", "body.osim", "-t", "body.trc", "legs.trc")

    def test_the_seed_draws_what_is_random(self):
        for words in (["simulate", "subject", "--duration", 0.1], ["simulate", "arm", "--frames", 9], ["simulate", "macaque", "--duration", 1],
                      ["simulate", "rig", "--duration", 0.05]):
            one, other = (self.observed(*words, "--out", "o", "--seed", seed) for seed in (1, 2))
            self.assertEqual(one[0], 0)
            self.assertNotEqual(one[2], other[2])
        self.assertIn("--seed", EVERYWHERE)
