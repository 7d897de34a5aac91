# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Options in a file: --config and --save-config."""

import json

from support import CommandTest


class SettingsTest(CommandTest):
    def angles(self, name):
        return (self.folder / name).read_text().split("endheader")[1]

    def test_what_is_saved_does_the_same_again(self):
        self.good(*self.ik(output="a.mot"), "--no-limits", "--max-rms", "12.5", "--weight", "LASI=2", "--weight", "RASI=0.5",
                  "--save-config", "walk.toml")
        text = (self.folder / "walk.toml").read_text()
        self.assertIn('command = "ik"\n', text)
        self.assertIn("max-rms = 12.5\n", text)
        self.assertIn("no-limits = true\n", text)
        self.assertIn('weight = ["LASI=2", "RASI=0.5"]\n', text)
        self.good("ik", "--config", "walk.toml", "--output", "b.mot")
        self.assertEqual(self.angles("a.mot"), self.angles("b.mot"))
        line = json.loads((self.folder / "b_report.json").read_text())["command_line"]
        self.assertIn("--max-rms=12.5", line)
        self.assertNotIn("--config", line)

    def test_what_is_typed_comes_first(self):
        self.write("s.toml", "max-rms = 0.001\nno-error-bars = true\n")
        self.assertEqual(self.run_in(*self.ik(), "--config=s.toml").status, 1)
        self.assertFalse((self.folder / "q_sd.sto").exists())
        self.good(*self.ik(output="r.mot"), "--config", "s.toml", "--max-rms", "50")

    def test_options_of_a_command_below_another(self):
        self.write("s.toml", 'command = "simulate subject"\nduration = 0.2\nrate = 50\n')
        self.good("simulate", "subject", "--config", "s.toml", "--out", "made")
        self.assertEqual(json.loads(self.good("info", "made/markers.trc", "--json").out)["rate_hz"], 50.0)

    def test_what_is_wrong_in_it_is_said_with_its_line(self):
        ik = [str(part) for part in self.ik()]
        for text, words in (("max-rsm = 5\n", ["s.toml: line 1: 'max-rsm' is no option of it", "did you mean max-rms?"]),
                            ("\nno-limits = 5\n", "line 2: 'no-limits' needs true or false"),
                            ("max-rms = true\n", "'max-rms' needs a value"),
                            ("force = true\n", "'force' is no option of it"),
                            ('command = "clean"\n', "holds options of 'clean', not of 'ik'"),
                            ("[ik]\nmax-rms = 5\n", "'ik' is a table"),
                            ("max-rms = = 5\n", "line 1")):
            self.write("s.toml", text)
            self.refused(3, words, *ik, "--config", "s.toml")
        self.refused(4, "none.toml", *ik, "--config", "none.toml")
        self.refused(2, "--config needs a file", *ik, "--config")
        self.refused(2, "no command", "--config", "s.toml")
        self.write("s.toml", 'max-rms = "five"\n')
        self.refused(2, "max-rms", *ik, "--config", "s.toml")

    def test_a_file_that_is_there_is_not_replaced(self):
        self.write("s.toml", "mine\n")
        self.refused(4, "s.toml", *self.ik(), "--save-config", "s.toml")
        self.good(*self.ik(), "--save-config", "s.toml", "--force")

    def test_no_input_is_replaced_by_options(self):
        recording = self.folder / "walk.c3d"
        recording.write_bytes(self.c3d.read_bytes())
        self.refused(2, "walk.c3d", "info", "walk.c3d", "--save-config", "walk.c3d", "--force")
        self.write("pig.toml", "title = 'mine'\n")
        for words in (("info", "walk.c3d", "--save-config", "copy.c3d"), ("analyze", "walk.c3d", "--segments", "pig.toml", "--save-config", "pig.toml", "--force"),
                      ("analyze", "walk.c3d", "--segments", "pig", "--trial", "a=pig.toml", "--save-config", "./pig.toml", "--force")):
            self.refused(2, words[-2] if words[-1] == "--force" else words[-1], *words)
        self.assertEqual(recording.read_bytes(), self.c3d.read_bytes())


class HelpTest(CommandTest):
    def test_every_value_is_named_by_what_it_is(self):
        page = self.good("help", "--man-pages", ".")
        self.assertEqual(page.status, 0)
        for path in sorted(self.folder.glob("*.1")):
            for word in ("TEXT", "FLOAT", "UINT", "INT"):
                self.assertNotRegex(path.read_text(), rf"\\fI{word}\b", path.name)
        text = self.good("ik", "--help").out
        for line in ("--model FILE", "--noise MM=0", "--rate HZ", "--weight NAME=VALUE ..."):
            self.assertIn(line, text)
        self.assertIn("--markers N=3", self.good("simulate", "arm", "--help").out)
