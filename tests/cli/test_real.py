# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings, tables and models of other programs: all of them are read or refused in a sentence, and what one format cannot
hold of another is reported."""

import json
import unittest

from support import REAL_DATA, CommandTest, real_file

# Written empty or cut on purpose by those who published them.
BROKEN = ("Empty.trc", "Empty.c3d", "Truncated.trc")


class RealFiles(CommandTest):
    def facts(self, name):
        return json.loads(self.good("info", name, "--json").out)

    def all_files(self, *endings):
        real_file("cmu-mocap/85_02.c3d")  # skips, loudly, where there is no real data
        return sorted(path for ending in endings for path in REAL_DATA.rglob(f"*{ending}") if path.is_file())

    def test_every_file_is_good_odd_or_refused_in_a_sentence(self):
        files = self.all_files(".c3d", ".trc", ".mot", ".sto", ".osim")
        self.assertGreater(len(files), 60)
        ran = self.good("validate", *files, "--json", status=3)
        answers = {each["file"]: each for each in json.loads(ran.out)}
        self.assertEqual(set(answers), {str(path) for path in files})
        for name, each in answers.items():
            self.assertIn(each["exit_status"], (0, 1, 3), name)
            self.assertEqual("error" in each, each["exit_status"] == 3, name)
            self.assertEqual(each["exit_status"] == 1, bool(each.get("warnings")), name)
        refused = {name.rsplit("/", 1)[-1] for name, each in answers.items() if each["exit_status"] == 3}
        self.assertEqual(refused, set(BROKEN))

    def test_what_is_read_is_what_info_tells_after_another_format(self):
        for name in ("cmu-mocap/85_02.c3d", "btk-others/FunctionalWalk.c3d", "c3d-org/sample01/Eb015pr.c3d", "c3d-org/sample21/sample21.c3d"):
            path = real_file(name)
            before = self.facts(path)
            for ending in ("trc", "csv", "nwb", "c3d"):
                with self.subTest(file=path.name, ending=ending):
                    said = self.good("convert", path, f"x.{ending}", "--force").err
                    after = self.facts(f"x.{ending}")
                    for key in ("points", "frames", "missing", "labels"):
                        self.assertEqual(after[key], before[key], key)
                    lost = f"{len(before['channels'])} channels that are no markers" in said
                    self.assertEqual(lost, bool(before["channels"]) and ending not in ("c3d", "nwb"))
                    self.assertEqual(after["channels"], before["channels"] if ending in ("c3d", "nwb") else [])
                    self.assertAlmostEqual(after["rate_hz"], before["rate_hz"], delta=1e-3 * before["rate_hz"])
                    for key, words in (("analog_channels", "analog channels"), ("force_plates", "force plates"), ("events", "events")):
                        if ending in ("c3d", "nwb"):
                            self.assertEqual(after[key], before[key], key)
                        else:
                            lost = f"{before[key]} {words if before[key] > 1 else words[:-1]} cannot be stored in a .{ending} file"
                            self.assertEqual(lost in said, before[key] > 0, key)

    def test_models_of_others_are_written_as_they_are_read(self):
        models = [path for path in self.all_files(".osim") if path.name not in BROKEN]
        self.assertGreater(len(models), 10)
        read = 0
        for path in models:
            with self.subTest(model=path.name):
                before = self.facts(path)
                if self.run_in("convert", path, "m.osim", "--force", "--quiet").status != 0:
                    continue  # what cannot be written is refused; test_models tells how
                read += 1
                after = self.facts("m.osim")
                for key in ("bodies", "joints", "coordinates", "markers", "couplings", "labels"):
                    self.assertEqual(after[key], before[key], key)
                self.assertAlmostEqual(after["mass_kg"], before["mass_kg"], delta=1e-9 * max(1.0, before["mass_kg"]))
        self.assertGreater(read, len(models) // 2)

    def test_tables_of_others_keep_every_number(self):
        tables = [path for path in self.all_files(".mot", ".sto") if path.name not in BROKEN]
        self.assertGreater(len(tables), 5)
        for path in tables:
            with self.subTest(table=path.name):
                before = self.facts(path)
                self.good("convert", path, "t.sto", "--force", "--quiet")
                after = self.facts("t.sto")
                for key in ("rows", "columns", "first_time_s", "last_time_s", "in_degrees", "labels"):
                    self.assertEqual(after[key], before[key], key)


if __name__ == "__main__":
    unittest.main()
