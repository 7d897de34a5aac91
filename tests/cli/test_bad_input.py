# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Bad input ends with one sentence that names the file, exit status 3 or 4, and nothing half-written."""

import os
import re
import resource
import unittest

from support import CommandTest, changed_cell, listing


class MissingAndUnreadable(CommandTest):
    def test_a_file_that_is_not_there(self):
        for name in ("no.c3d", "no.trc", "no.mot", "no.osim"):
            self.refused(4, [name, "No such file"], "info", name)
        self.refused(4, "no.trc", *self.ik(markers="no.trc"))
        self.refused(4, "no.osim", *self.ik(model="no.osim"))
        self.refused(4, "no.xml", "ik", "--setup", "no.xml")
        self.refused(4, "no.xml", *self.ik(tasks="no.xml"))
        self.refused(4, "no.c3d", "convert", "no.c3d", "x.trc")
        self.refused(4, "no_report.json", "report", "no.mot", "-o", "r.html")

    def test_a_folder_is_no_file(self):
        (self.folder / "sub.c3d").mkdir()
        self.refused(3, ["sub.c3d", "a folder, not a regular file"], "ik", "-m", "sub.c3d", "-t", self.trc, "-o", "q.mot")
        self.refused(3, "sub.c3d: the folder holds no file that can be read here", "info", "sub.c3d")

    @unittest.skipIf(os.geteuid() == 0, "root may read every file")
    def test_a_file_without_permission(self):
        self.write("secret.c3d", self.c3d.read_bytes()).chmod(0)
        self.refused(4, ["secret.c3d", "Permission denied"], "info", "secret.c3d", )

    def test_files_of_the_wrong_type(self):
        for name, source in {"x.osim": self.c3d, "x.c3d": self.model, "x.trc": self.model, "x.mot": self.trc}.items():
            self.write(name, source.read_bytes())
            self.refused(3, name, "info", name)
        self.write("notes.txt", "hello\n")
        self.refused(3, ["notes.txt", ".c3d", ".trc"], "info", "notes.txt")
        self.refused(3, "model.osim", *self.ik(markers=self.model))
        self.refused(3, "markers.c3d", *self.ik(model=self.c3d))

    def test_empty_files(self):
        for name in ("e.c3d", "e.trc", "e.mot", "e.sto", "e.osim"):
            self.write(name, "")
            self.refused(3, name, "info", name)

    def test_truncated_files(self):
        for source, size, status in ((self.c3d, 300, 3), (self.c3d, 900, 3), (self.truth, 5000, 3), (self.model, 9000, 3)):
            name = f"cut{size}{source.suffix}"
            self.write(name, source.read_bytes()[:size])
            self.refused(status, name, "info", name)

    def test_a_recording_cut_short_is_read_as_far_as_it_goes_with_a_warning(self):
        for source, size in ((self.c3d, 20000), (self.trc, 60000)):
            name = f"cut{source.suffix}"
            self.write(name, source.read_bytes()[:size])
            ran = self.good("validate", name, status=1)
            self.assertIn("states 100 frames" if source is self.c3d else "header says 100 frames", ran.err)


class WrongContent(CommandTest):
    def test_text_where_numbers_belong(self):
        self.write("text.trc", changed_cell(self.trc.read_text(), 10, 4, "abc"))
        self.refused(3, ["text.trc", "line 10", "abc"], *self.ik(markers="text.trc"))
        self.write("text.mot", changed_cell(self.truth.read_text(), 20, 3, "abc"))
        self.refused(3, ["text.mot", "line 20", "abc"], "convert", "text.mot", "x.sto")
        self.write("text.osim", self.model.read_text().replace("<mass>", "<mass>x", 1))
        self.refused(3, ["text.osim", "<mass>", "not a number"], *self.ik(model="text.osim"))

    def test_a_marker_name_twice(self):
        self.write("twice.trc", changed_cell(self.trc.read_text(), 4, 6, "LFHD"))
        said = self.good(*self.ik(markers="twice.trc")).err
        self.assertIn("line 4 repeats 1 marker names ('LFHD' is the first)", said)
        self.write("twice.osim", self.model.read_text().replace('<Marker name="RFHD"', '<Marker name="LFHD"'))
        self.refused(3, ["twice.osim", "'LFHD' occurs twice"], *self.ik(model="twice.osim", output="other.mot"))

    def test_unknown_names(self):
        self.refused(3, ["'NOPE'", "neither"], *self.ik(weight="NOPE=1"))
        self.refused(3, ["'nope'", "does not have"], *self.ik(coordinate_weight="nope=1"))

    def test_a_model_without_markers_is_named(self):
        self.write("bare.osim", re.sub(r"<Marker name=.*?</Marker>", "", self.model.read_text(), flags=re.DOTALL))
        self.refused(3, ["bare.osim", "has no markers"], *self.ik(model="bare.osim"))

    def test_no_marker_in_common_lists_both_sides(self):
        lines = self.trc.read_text().split("\n")
        lines[3] = re.sub(r"(?<=\t)(\w+)", r"X\1", lines[3].replace("\tTime", "")).replace("Frame#", "Frame#\tTime", 1)
        self.write("other.trc", "\n".join(lines))
        said = self.refused(3, ["other.trc", "no marker in common"], *self.ik(markers="other.trc"))
        model, recording = said.split("the recording has")
        self.assertIn(" LFHD, RFHD", model)
        self.assertIn(" XLFHD, XRFHD", recording)

    def test_units_that_disagree_by_1000(self):
        text = self.trc.read_text()
        self.write("metres.trc", text.replace("\tmm\t", "\tm\t", 1))
        self.refused(3, ["metres.trc", "wrong unit"], *self.ik(markers="metres.trc"))

    def test_weights_that_are_no_weights(self):
        for value in ("nan", "-1", "inf"):
            self.refused(3, ["'RFIN'", "need a number"], *self.ik(weight=f"RFIN={value}"))
        for text in ("RFIN", "=1", "RFIN=", "RFIN=x"):
            self.refused(2, [f"'{text}'", "NAME=WEIGHT"], *self.ik(weight=text))

    def test_an_ending_that_a_result_cannot_have(self):
        for name in ("q.nwb", "q.csv", "q.c3d"):
            self.refused(2, [name, "joint angles are written as .mot or .sto"], *self.ik(output=name))
        self.refused(2, "joint angles are written as", "track", "-m", self.model, "-t", self.c3d, "-o", "q.csv")
        self.refused(2, "a page is written as .html", *self.ik(report="q.pdf"))
        self.refused(2, "a page is written as .html", "report", self.c3d, "-o", "page.pdf")
        self.refused(2, "a model is written as .osim", "scale", "-m", self.model, "-t", self.c3d, "-o", "m.xml")
        self.refused(2, "written into a folder; '.c3d' is", "analyze", self.c3d, "--segments", "pig", "-o", "x.c3d")
        self.refused(2, "written into a folder; '.trc' is", "analyze", self.truth, "-m", self.model, "--bodies", "pelvis", "-o", "x.trc")
        (self.folder / "day.c3d").mkdir()
        self.good("analyze", self.truth, "-m", self.model, "--bodies", "pelvis", "-o", "day.c3d")
        self.good(*self.ik(output="q.sto"))

    def test_time_ranges_outside_the_data(self):
        self.refused(3, ["markers.c3d", "no frame in the time range", "0 to 0.99 s"], *self.ik(start=50))
        self.refused(3, "no frame in the time range", *self.ik(end=-5))
        self.refused(2, "no time lies between", *self.ik(start=0.8, end=0.2))
        self.refused(2, "no time lies between", *self.ik(start="nan"))

    def test_a_report_that_is_not_one(self):
        self.write("q_report.json", "{not json")
        self.refused(3, ["q_report.json", "not JSON"], "report", "q.mot", "-o", "r.html")


def at_most(size):
    """Files of the child may not grow beyond `size` bytes: what a full disk does to it."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


class FullDiskAndUnwritableFolder(CommandTest):
    def test_a_disk_that_fills_up(self):
        full = {"preexec_fn": at_most(4096)}
        self.refused(4, ["q.mot: cannot be written", "File too large"], *self.ik(), **full)
        self.refused(4, ["markers.c3d: cannot be written"], "simulate", "subject", "-o", "new/deep", **full)
        self.refused(4, "x.trc: cannot be written", "convert", self.c3d, "x.trc", **full)
        self.refused(4, "x.c3d: cannot be written", "convert", self.trc, "x.c3d", **full)
        self.refused(4, "x.sto: cannot be written", "convert", self.truth, "x.sto", **full)
        self.refused(4, "x.osim: cannot be written", "convert", self.model, "x.osim", **full)

    def test_a_disk_that_fills_up_at_the_last_file_leaves_no_first_one(self):
        self.good(*self.ik(report="r.html"))
        sizes = {path.name: path.stat().st_size for path in self.folder.iterdir()}
        self.assertEqual(max(sizes, key=sizes.get), "r.html", "the page is the last and largest")
        for path in self.folder.iterdir():
            path.unlink()
        room = at_most(max(size for name, size in sizes.items() if name != "r.html") + 4096)
        self.refused(4, "r.html: cannot be written", *self.ik(report="r.html"), preexec_fn=room)

    def test_a_disk_that_fills_up_keeps_the_older_results(self):
        self.good(*self.ik())
        self.refused(4, "q.mot", *self.ik(), "--force", preexec_fn=at_most(4096))
        self.good("convert", self.c3d, "x.trc")
        self.refused(4, "x.trc", "convert", self.c3d, "x.trc", "--force", preexec_fn=at_most(4096))

    def test_a_report_on_a_full_disk(self):
        self.good(*self.ik())
        self.refused(4, "r.html", "report", "q.mot", "-o", "r.html", preexec_fn=at_most(4096))

    def test_folders_that_are_not_there_or_not_folders(self):
        self.write("file", "")
        for path in ("no/q.mot", "file/q.mot", "/proc/q.mot"):
            self.refused(4, f"{path}: cannot be written", *self.ik(output=path))
            self.refused(4, f"{path}: cannot be written", "convert", self.truth, path)
        self.refused(4, "file", "simulate", "subject", "-o", "file/sub")
        (self.folder / "full/study.html").mkdir(parents=True)
        self.refused(4, "study.html", "study", "macaque", "--figures", "full")

    def test_a_page_that_cannot_be_written_stops_the_rest(self):
        for page in ("no/r.html", "/proc/r.html"):
            self.refused(4, f"{page}: cannot be written", *self.ik(report=page))
        self.refused(2, "a page is written as .html", *self.ik(report="q.mot"))

    @unittest.skipIf(os.geteuid() == 0, "root may write every folder")
    def test_a_folder_without_permission(self):
        locked = self.folder / "locked"
        locked.mkdir(0o555)
        self.refused(4, ["locked/q.mot", "Permission denied"], *self.ik(output="locked/q.mot"))

    def test_standard_output_that_is_full(self):
        before = listing(self.folder)
        with open("/dev/full", "wb") as full:
            ran = self.run_in("info", self.c3d, "--json", stdout=full)
        self.assertEqual((ran.status, listing(self.folder)), (4, before))
        self.assertIn("standard output", ran.err)


if __name__ == "__main__":
    unittest.main()
