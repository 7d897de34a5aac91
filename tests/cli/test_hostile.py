# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Files that lie, stand in the way, or are too much: one line that names the file, never a wait, never a crash."""

import json
import os
import resource
import signal
import socket
import struct
import subprocess
import unittest

from support import PROGRAM, REAL_DATA, SECONDS, CommandTest, changed_cell, read_csv

FIRST_ROW = 7  # line of a TRC file with its first frame


def with_times(text, change):
    """Text of a TRC file with the time of every row replaced: change(row, time), rows from 0."""
    lines = text.split("\n")
    for i in range(FIRST_ROW - 1, len(lines)):
        cells = lines[i].split("\t")
        if len(cells) > 2:
            cells[1] = f"{change(i - FIRST_ROW + 1, float(cells[1])):.9g}"
            lines[i] = "\t".join(cells)
    return "\n".join(lines)


def little_memory(megabytes):
    """The child may not have more of it: what is read whole, or grows with its input, fails."""
    return lambda: resource.setrlimit(resource.RLIMIT_AS, (megabytes << 20, megabytes << 20))


class SpecialFiles(CommandTest):
    def test_what_is_no_regular_file_is_refused_before_it_is_opened(self):
        os.mkfifo(self.folder / "fifo.trc")
        os.symlink("fifo.trc", self.folder / "link.trc")
        os.symlink("/dev/zero", self.folder / "device.c3d")
        (self.folder / "folder.mot").mkdir()
        for name, kind in (("fifo.trc", "pipe"), ("link.trc", "pipe"), ("device.c3d", "device")):
            said = [name, kind, "not a regular file"]
            to = "x.sto" if name.endswith(".mot") else "x.csv"
            for command in (["info", name], ["validate", name], ["convert", name, to], self.ik(markers=name), self.ik(model=name)):
                ran = self.run_in(*command)
                self.assertEqual(ran.status, 3, (command, ran.err))
                for word in said:
                    self.assertIn(word, ran.err.splitlines()[-1])
        self.refused(3, ["folder.mot", "a folder, not a regular file"], *self.ik(model="folder.mot"))
        for command in ("info", "validate"):
            self.refused(3, "folder.mot: the folder holds no file that can be read", command, "folder.mot")
        self.refused(3, ["fifo.trc", "pipe"], "joints", self.c3d, "--segments", "fifo.trc", "-o", "j.csv")
        self.refused(3, ["fifo.trc", "pipe"], "ik", "--setup", "fifo.trc")

    def test_a_socket_is_refused(self):
        with socket.socket(socket.AF_UNIX) as server:
            here = os.getcwd()
            os.chdir(self.folder)  # names of sockets are short
            try:
                server.bind("s.mcap")
            finally:
                os.chdir(here)
            self.refused(3, ["s.mcap", "socket"], "info", "s.mcap")

    def test_a_signal_ends_what_reads(self):
        os.mkfifo(self.folder / "fifo.trc")
        for number in (signal.SIGTERM, signal.SIGINT):
            child = subprocess.Popen(
                [PROGRAM, "validate", "fifo.trc"], cwd=self.folder, stdin=subprocess.DEVNULL, stderr=subprocess.PIPE
            )
            child.send_signal(number)
            child.communicate(timeout=SECONDS)
            self.assertIn(child.returncode, (3, -number, 128 + number))


class TimeThatLies(CommandTest):
    def refused_trc(self, words, change):
        self.write("t.trc", with_times(self.trc.read_text(), change))
        for command in (["validate", "t.trc"], ["info", "t.trc"], self.ik(markers="t.trc")):
            ran = self.run_in(*command)
            self.assertEqual(ran.status, 3, ran.err)
            for word in ["t.trc", *words]:
                self.assertIn(word, ran.err.splitlines()[-1])

    def test_backward_and_constant(self):
        self.refused_trc(["line 8 (frame 2)", "time goes back"], lambda row, t: 1.0 - t)
        self.refused_trc(["line 8 (frame 2)", "time stands still"], lambda row, t: 1.5)
        self.refused_trc(["line 57 (frame 51)", "time goes back"], lambda row, t: t - 0.3 if row == 50 else t)

    def test_a_hole_that_is_no_whole_number_of_frames(self):
        self.refused_trc(["line 57 (frame 51)", "frame intervals"], lambda row, t: t + 0.055 if row >= 50 else t)

    def test_a_hole_is_made_of_missing_frames_and_said(self):
        self.write("gap.trc", with_times(self.trc.read_text(), lambda row, t: t + 2.0 if row >= 50 else t))
        ran = self.good("validate", "gap.trc", status=1)
        self.assertIn("1 hole, the first at line 57 (frame 51)", ran.err)
        facts = json.loads(self.good("info", "--json", "gap.trc").out)
        whole = json.loads(self.good("info", "--json", self.trc).out)
        self.assertEqual(facts["frames"], 300)
        self.assertEqual(facts["missing"], whole["missing"] + 200 * facts["points"])

    def test_rates_that_are_none(self):
        for rate in ("-100", "nan", "1e30", "1e-9"):
            self.write("r.trc", changed_cell(self.trc.read_text(), 3, 1, rate))
            self.refused(3, ["r.trc", "line 3", "DataRate", "expected a frame rate"], "info", "r.trc")
        head = bytearray(self.c3d.read_bytes())
        at = head.index(b"RATE") + 4 + 4  # behind the name: offset to the next, type, no dimensions
        self.assertEqual(struct.unpack_from("<f", head, at)[0], 100.0)
        for rate in (-100.0, 1e30, float("nan")):
            struct.pack_into("<f", head, at, rate)
            self.write("r.c3d", bytes(head))
            self.refused(3, ["r.c3d", "POINT:RATE", "expected a frame rate"], "info", "r.c3d")

    def test_csv_and_tables(self):
        self.good("convert", self.c3d, "m.csv")
        text = (self.folder / "m.csv").read_text()
        self.write("back.csv", text.replace("\n60,0.59,", "\n60,0.29,"))
        self.refused(3, ["back.csv", "frame 60", "time goes back"], "validate", "back.csv")
        head, rows = self.truth.read_text().split("endheader\n")
        labels, *rows = rows.splitlines()
        still = ["0.5" + row[row.index("\t") :] for row in rows]
        self.write("still.mot", head + "endheader\n" + "\n".join([labels, *still]) + "\n")
        ran = self.good("validate", "still.mot", status=3)
        self.assertIn("time stands still", ran.err)

    def test_an_even_clock_is_good(self):
        for change in (lambda row, t: t + 100.0, lambda row, t: t * 2.0, lambda row, t: t + 1e-5 * (row % 3)):
            self.write("t.trc", with_times(self.trc.read_text(), change))
            ran = self.run_in("validate", "t.trc")
            self.assertIn(ran.status, (0, 1))
            self.assertNotIn("hole", ran.err)


class Plausibility(CommandTest):
    def test_one_value_that_cannot_be(self):
        for value in ("1e30", "-2.5e7", "40000", "1e300"):
            self.write("far.trc", changed_cell(self.trc.read_text(), 20, 4, value))
            ran = self.good("validate", "far.trc", status=1)
            self.assertIn("far.trc: 1 sample is where no marker can be and is rejected: '", ran.err)
            self.assertIn("in frame 14", ran.err)
            self.good("convert", "far.trc", "far.csv", "--force")
            rows = [row for row in read_csv(self.folder / "far.csv") if row["state"] == "rejected"]
            self.assertEqual([row["frame"] for row in rows], ["14"])

    def test_a_flipped_bit_of_a_c3d(self):
        facts = json.loads(self.good("info", "--json", self.c3d).out)
        whole = self.c3d.read_bytes()
        frame_bytes = 16 * facts["points"]
        begin = 512 * (struct.unpack_from("<H", whole, 16)[0] - 1)
        flipped = 0
        for frame in range(0, facts["frames"], 17):
            at = begin + frame * frame_bytes + 16 * 3 + 3  # sign and exponent of the fourth marker's x
            data = bytearray(whole)
            data[at] ^= 0x20  # 2^64 times as large
            self.write("bit.c3d", bytes(data))
            ran = self.run_in("validate", "bit.c3d")
            value = struct.unpack_from("<f", data, at - 3)[0]
            if abs(value) > 1e6:  # mm
                flipped += 1
                self.assertEqual(ran.status, 1, (frame, value, ran.err))
                self.assertIn(f"in frame {frame + facts['first_frame']}", ran.err)
        self.assertGreater(flipped, 2)

    def test_a_body_of_another_size_is_a_wrong_unit(self):
        self.write("metres.trc", self.trc.read_text().replace("\tmm\t", "\tm\t", 1))
        ran = self.good("validate", "metres.trc", status=1)
        self.assertIn("the unit (m) is probably wrong", ran.err)

    def test_a_table_value_that_cannot_be(self):
        self.write("far.mot", changed_cell(self.truth.read_text(), 20, 3, "1e30"))
        ran = self.good("validate", "far.mot", status=1)
        self.assertIn("line 20", ran.err)

    def test_what_is_good_stays_good(self):
        for name in (self.c3d, self.trc, self.truth):
            self.assertIn("good", self.good("validate", name).err)


class NamesOfTheWorld(CommandTest):
    def test_latin1_is_read_as_such(self):
        text = self.trc.read_text().replace("LFHD", "\u00e9paule", 1)
        self.write("latin1.trc", text.encode("latin-1"))
        self.assertIn("\u00e9paule", json.loads(self.good("info", "--json", "latin1.trc").out)["labels"])
        for target in ("x.csv", "x.c3d", "x.trc"):
            self.good("convert", "latin1.trc", target)
            self.assertIn("\u00e9paule", json.loads(self.good("info", "--json", target).out)["labels"])
        table = self.truth.read_text()
        label = table.split("endheader\n")[1].split("\t")[1]
        self.write("latin1.mot", table.replace(f"\t{label}\t", "\tfl\u00e9chi\t", 1).encode("latin-1"))
        self.assertEqual(json.loads(self.good("info", "--json", "latin1.mot").out)["labels"][0], "fl\u00e9chi")

    def test_escapes_never_reach_the_terminal(self):
        name = "A\x1b[2J\x1b]0;x\x07\x7f\u009b\u202eB"
        self.write("esc.trc", self.trc.read_text().replace("LFHD", name, 1))
        for command in (["info", "esc.trc"], ["info", "--json", "esc.trc"], ["validate", "esc.trc"], self.ik(markers="esc.trc")):
            ran = self.run_in(*command)
            for text in (ran.out, ran.err):
                self.assertNotRegex(text, "[\x00-\x08\x0b-\x1f\x7f\u0080-\u009f]")
        twice = self.trc.read_text().replace("LFHD", "A\x1b", 1).replace("RFHD", "A\x07", 1)
        self.write("esc.trc", twice)
        self.assertIn("'A' is the first", self.good("info", "esc.trc").out)

    def test_names_of_100000_letters(self):
        name = "M" * 100_000
        self.write("long.trc", self.trc.read_text().replace("LFHD", name, 1))
        self.assertIn(name, json.loads(self.good("info", "--json", "long.trc").out)["labels"])
        for command in (["validate", "long.trc"], self.ik(markers="long.trc")):
            self.assertLess(len(self.run_in(*command).err), 5000)
        self.write("twice.trc", self.trc.read_text().replace("LFHD", name, 1).replace("RFHD", name, 1))
        facts = json.loads(self.good("info", "--json", "twice.trc").out)
        self.assertIn(f"{name}_2", facts["labels"])
        self.assertLess(max(map(len, facts["warnings"])), 500)

    def test_file_names_that_are_no_utf8(self):
        name = b"Fu\xdf\x1b.trc"
        path = os.path.join(os.fsencode(self.folder), name)
        with open(path, "wb") as file:
            file.write(self.trc.read_bytes())

        def run_on(*arguments):
            done = subprocess.run([os.fsencode(PROGRAM), *arguments], cwd=self.folder, capture_output=True, timeout=SECONDS, check=False)
            return done.returncode, done.stdout.decode("utf-8"), done.stderr.decode("utf-8")

        status, out, err = run_on(b"info", b"--json", name)
        self.assertEqual((status, err), (0, ""))
        self.assertEqual(json.loads(out)["file"], "Fu\ufffd\x1b.trc")
        status, out, err = run_on(b"validate", b"--json", name)
        self.assertEqual(status, 0, err)
        self.assertEqual(json.loads(out)[0]["exit_status"], 0)
        self.assertNotIn("\x1b", err)
        self.assertEqual(run_on(b"convert", name, b"Gr\xfc\xdfe.csv")[0], 0)
        self.assertIn(b"Gr\xfc\xdfe.csv", os.listdir(os.fsencode(self.folder)))
        status, out, err = run_on(b"info", b"n\xff\x1b[2J.trc")
        self.assertEqual(status, 4)
        self.assertIn("n\ufffd\ufffd[2J.trc: cannot be opened", err)
        status, out, err = run_on(
            b"ik", b"--model", os.fsencode(self.model), b"--markers", name, b"--output", b"Q\xff.mot", b"--json"
        )
        self.assertEqual(status, 0, err)
        json.loads(out)
        with open(os.path.join(os.fsencode(self.folder), b"Q\xff_report.json"), encoding="utf-8") as file:
            json.load(file)


class TooMuch(CommandTest):
    def zeros(self, name, size):
        path = self.folder / name
        with path.open("wb") as file:
            file.truncate(size)  # a hole: takes no room on the disk
        return name

    def test_huge_files_are_judged_by_their_beginning(self):
        for ending in ("trc", "csv", "mot", "sto", "c3d", "osim", "mcap", "v3d"):
            # A recording whose beginning is damaged is searched for what follows: less of it here.
            name = self.zeros(f"zeros.{ending}", 1 << 28 if ending == "mcap" else 4 << 30)
            options = ["--rate", 100] if ending == "v3d" else []
            ran = self.run_in("info", name, *options, preexec_fn=little_memory(512))
            self.assertEqual(ran.status, 3, ran.err)
            self.assertIn(name, ran.err)
            self.assertNotIn("memory", ran.err)
            os.remove(self.folder / name)
        name = self.zeros("zeros.toml", 4 << 30)
        self.refused(3, [name], "joints", self.c3d, "--segments", name, "-o", "j.csv", preexec_fn=little_memory(512))

    def test_deep_and_long_xml(self):
        self.write("deep.osim", "<a>" * 10_000_000)
        self.refused(3, ["deep.osim", "nested deeper than 200"], "info", "deep.osim", preexec_fn=little_memory(512))
        self.refused(3, ["deep.osim", "nested deeper than 200"], "ik", "--setup", "deep.osim", preexec_fn=little_memory(512))
        self.write("wide.osim", "<a>" + "<b/>" * 5_000_000 + "</a>")
        self.refused(3, ["wide.osim", "tags"], "info", "wide.osim", preexec_fn=little_memory(512))

    def test_deep_toml(self):
        self.write("dots.toml", "a." * 50_000 + "a = 1\n")
        self.refused(3, ["dots.toml", "a key has more than 16 parts"], "joints", self.c3d, "--segments", "dots.toml", "-o", "j.csv")

    def test_an_impossible_rig_is_named_by_its_key(self):
        self.good("simulate", "rig", "wheel", "-o", "w", "--duration", 0.2)
        rig = next((self.folder / "w").glob("*.toml"))
        text = rig.read_text()
        before = next(line for line in text.splitlines() if line.startswith("time_constant_s"))
        self.write("odd.toml", text.replace(before, "time_constant_s = 1e30"))
        recording = next((self.folder / "w").glob("*.mcap"))
        self.write("dots.toml", "a." * 50_000 + "a = 1\n")
        self.refused(3, ["dots.toml", "16 parts"], "reconstruct", recording, "--rig", "dots.toml", "-o", "m.csv")
        said = self.refused(
            3, ["odd.toml", "time_constant_s is 1e+30", "at most 1"], "reconstruct", recording, "--rig", "odd.toml", "-o", "m.csv"
        )
        self.assertNotIn(".cc", said)


class KnownHostileFiles(CommandTest):
    """Files that once were too much; what each must give: (statuses, words of the message)."""

    EXPECTED = {
        "backtime.trc": ({3}, "time goes back"),
        "consttime.trc": ({3}, "time stands still"),
        "gapt.trc": ({1}, "hole"),
        "trc_1e30.trc": ({1}, "no marker can be"),
        "c3d_bitflip_absurd_good.c3d": ({1, 3}, "c3d_bitflip"),
        "latin1.c3d": ({0, 1}, ""),
        "latin1.csv": ({0, 1}, ""),
        "latin1.mot": ({0, 1}, ""),
        "latin1.trc": ({0, 1}, ""),
    }

    def test_each(self):
        folder = REAL_DATA.parent / "reference" / "hardening"
        if not folder.is_dir():
            raise unittest.SkipTest(f"NO HOSTILE FILES: {folder} is not there; set KINEMARK_TEST_DATA")
        for name, (statuses, words) in self.EXPECTED.items():
            with self.subTest(name):
                ran = self.run_in("validate", "--json", folder / name)
                self.assertIn(ran.status, statuses, ran.err)
                self.assertIn(words, ran.err)
                json.loads(ran.out)
                if name.startswith("latin1"):
                    labels = json.loads(self.good("info", "--json", folder / name).out)["labels"]
                    self.assertTrue(any(ord(c) > 127 for label in labels for c in label), labels)
        dots = folder / "dots50000.toml"
        self.refused(3, ["dots50000.toml", "parts"], "joints", self.c3d, "--segments", dots, "-o", "j.csv")


if __name__ == "__main__":
    unittest.main()
