# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Several recordings in one run: info, validate, convert, clean, ik, track, joints."""

import json
import os
import shutil

from support import CommandTest


class ManyTest(CommandTest):
    def recordings(self, count=3):
        """A folder of short recordings, and a file that is none."""
        folder = self.folder / "in"
        folder.mkdir()
        for n in range(count):
            self.good("convert", self.trc, folder / f"walk{n}.trc", "--frames", f"{1 + 20 * n}-{20 + 20 * n}")
        (folder / "notes.txt").write_text("not a recording\n")
        return folder

    def statuses(self, out):
        return [trial["status"] for trial in json.loads(out)["trials"]]

    def test_info_of_a_folder_is_a_line_each(self):
        folder = self.recordings()
        ran = self.good("info", folder)
        lines = ran.out.splitlines()
        self.assertEqual(len(lines), 5)
        self.assertIn("walk0.trc", lines[1])
        self.assertRegex(lines[4], r"^3 files: \d good, \d with findings, 0 not readable; 60 frames")
        self.assertIn("1 file with another ending passed over", ran.err)
        listed = json.loads(self.good("info", folder, "--json").out)
        self.assertEqual([item["frames"] for item in listed], [20, 20, 20])
        one = json.loads(self.good("info", folder / "walk0.trc", "--json").out)
        self.assertEqual(listed[0], one)

    def test_one_bad_file_does_not_hide_the_others(self):
        folder = self.recordings()
        (folder / "walk1.trc").write_text("PathFileType\t4\n")
        ran = self.run_in("info", folder)
        self.assertEqual(ran.status, 3)
        self.assertRegex(ran.out, r"3 files: \d good, \d with findings, 1 not readable; 40 frames")
        self.assertEqual(self.run_in("validate", folder).status, 3)

    def test_convert_into_a_folder_goes_on_where_it_stopped(self):
        folder = self.recordings()
        first = self.good("convert", folder, "out/", "--to", "csv", "--json")
        self.assertEqual(self.statuses(first.out), ["good"] * 3)
        (self.folder / "out" / "walk1.csv").unlink()
        stamps = {name: os.stat(self.folder / "out" / name).st_mtime_ns for name in ("walk0.csv", "walk2.csv")}
        again = self.good("convert", folder, "out", "--to", ".csv", "--json", "--jobs", "2")
        self.assertEqual(self.statuses(again.out), ["there already", "good", "there already"])
        for name, stamp in stamps.items():
            self.assertEqual(os.stat(self.folder / "out" / name).st_mtime_ns, stamp)
        one = self.good("convert", folder / "walk1.trc", "walk1.csv")
        self.assertEqual(one.status, 0)
        self.assertEqual((self.folder / "walk1.csv").read_bytes(), (self.folder / "out" / "walk1.csv").read_bytes())

    def test_a_failure_stops_unless_asked_to_go_on(self):
        folder = self.recordings()
        (folder / "walk1.trc").write_text("PathFileType\t4\n")
        stopped = self.run_in("convert", folder, "a/", "--to", "csv", "--json")
        self.assertEqual((stopped.status, self.statuses(stopped.out)), (3, ["good", "failed", "not begun"]))
        self.assertIn("walk1.trc", stopped.err)
        going = self.run_in("convert", folder, "b/", "--to", "csv", "--keep-going")
        self.assertEqual(going.status, 3)
        self.assertIn("3 recordings: 2 good, 1 failed", going.out)

    def test_clean_keeps_the_format_and_writes_what_it_writes_alone(self):
        folder = self.recordings(2)
        self.good("clean", folder, "out/", "--gaps", "auto", "--jobs", "2", "--report", "pages/")
        self.good("clean", folder / "walk1.trc", "alone.trc", "--gaps", "auto")
        rows = [path.read_text().splitlines()[3:] for path in (self.folder / "out" / "walk1.trc", self.folder / "alone.trc")]
        self.assertEqual(rows[0], rows[1])
        self.assertTrue((self.folder / "out" / "walk0_report.json").exists())
        self.assertTrue((self.folder / "pages" / "walk0.html").exists())
        again = self.good("clean", folder, "out/", "--gaps", "auto", "--report", "pages/", "--json")
        self.assertEqual(self.statuses(again.out), ["there already"] * 2)

    def test_ik_of_many_recordings_is_the_ik_of_each(self):
        folder = self.recordings(2)
        ran = self.run_in("ik", "-m", self.model, "-t", folder, "-o", "out/", "--jobs", "2", "--json")
        self.assertIn(ran.status, (0, 1))
        self.assertEqual(len(self.statuses(ran.out)), 2)
        self.run_in("ik", "-m", self.model, "-t", folder / "walk1.trc", "-o", "alone.mot")
        rows = [path.read_text().split("endheader")[1] for path in (self.folder / "out" / "walk1.mot", self.folder / "alone.mot")]
        self.assertEqual(rows[0], rows[1])
        again = self.run_in("ik", "-m", self.model, "-t", folder, "-o", "out/", "--json")
        self.assertEqual(self.statuses(again.out), ["there already"] * 2)
        (self.folder / "out" / "walk0.mot").unlink()  # as a run that was killed between its files
        again = self.run_in("ik", "-m", self.model, "-t", folder, "-o", "out/", "--json")
        self.assertNotIn("failed", self.statuses(again.out))
        self.assertTrue((self.folder / "out" / "walk0.mot").exists())

    def test_track_of_many_recordings_is_the_track_of_each(self):
        folder = self.recordings(2)
        words = ["track", "-m", self.model, "--no-error-bars", "-t"]
        ran = self.run_in(*words, folder, "-o", "out/", "--jobs", "2", "--json")
        self.assertIn(ran.status, (0, 1), ran.err)
        self.assertEqual(len(self.statuses(ran.out)), 2)
        self.run_in(*words, folder / "walk1.trc", "-o", "alone.mot")
        rows = [path.read_text().split("endheader")[1] for path in (self.folder / "out" / "walk1.mot", self.folder / "alone.mot")]
        self.assertEqual(rows[0], rows[1])
        again = self.run_in(*words, folder, "-o", "out/", "--json")
        self.assertEqual(self.statuses(again.out), ["there already"] * 2)

    def test_joints_of_many_recordings_are_the_joints_of_each(self):
        folder = self.folder / "in"
        folder.mkdir()
        for seed in (1, 2):
            self.good("simulate", "macaque", "-o", f"made{seed}", "--duration", 5, "--all-seen", "--seed", seed)
            shutil.copy(self.folder / f"made{seed}" / "markers.c3d", folder / f"arm{seed}.c3d")
        words = ["--segments", "made1/segments.toml", "--to", "c3d"]
        ran = self.run_in("joints", folder, *words, "-o", "out/", "--jobs", "2", "--json")
        self.assertIn(ran.status, (0, 1), ran.err)
        self.assertEqual(len(self.statuses(ran.out)), 2)
        self.run_in("joints", folder / "arm1.c3d", "--segments", "made1/segments.toml", "-o", "alone.c3d")
        alone, many = (
            json.loads((self.folder / name).read_text())["joints"] for name in ("alone_skeleton.json", "out/arm1_skeleton.json")
        )
        self.assertEqual(alone, many)
        again = self.run_in("joints", folder, *words, "-o", "out/", "--json")
        self.assertEqual(self.statuses(again.out), ["there already"] * 2)
        (self.folder / "out" / "arm1_skeleton.json").unlink()
        again = self.run_in("joints", folder, *words, "-o", "out/", "--json")
        self.assertTrue((self.folder / "out" / "arm1_skeleton.json").exists(), again.err)

    def test_what_cannot_be_meant_is_refused(self):
        folder = self.recordings(2)
        self.refused(2, "need --to", "convert", folder, "out/")
        self.refused(2, "need a folder", "clean", folder, "a.trc")
        self.refused(2, "need a folder", "ik", "-m", self.model, "-t", folder, "-o", "q.mot")
        self.refused(2, "need a folder", "track", "-m", self.model, "-t", folder, "-o", "q.mot")
        self.refused(2, "give --output", "joints", folder)
        self.refused(2, "--to: 'xyz' is none of", "joints", folder, "-o", "out/", "--to", "xyz")
        self.refused(2, "--to is for several", "joints", folder / "walk0.trc", "--to", "csv")
        self.refused(2, "--to is for a folder", "clean", folder / "walk0.trc", "a.csv", "--to", "csv")
        self.refused(2, "--to: 'xyz' is none of c3d, trc, nwb, ", "clean", folder, "out/", "--to", "xyz")
        self.refused(2, "--to is for a folder", "convert", folder / "walk0.trc", "a.csv", "--to", "csv")
        shutil.copytree(folder, self.folder / "other")
        self.refused(2, "would both become", "convert", folder, "other", "out/", "--to", "csv")
        self.refused(2, "is the file that is read", "convert", folder, folder, "--to", "trc")
        (self.folder / "empty").mkdir()
        self.refused(3, "holds no file that can be read here", "info", self.folder / "empty")
