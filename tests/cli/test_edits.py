# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Edits by hand: `kinemark edit`, and the journals that commands apply."""

import json
import shutil

from support import CommandTest, listing


class EditsTest(CommandTest):
    def setUp(self):
        super().setUp()
        self.walk = self.folder / "walk.c3d"
        shutil.copy(self.c3d, self.walk)
        facts = self.info("walk.c3d")
        self.labels, self.first = facts["labels"], facts["first_frame"]
        self.last = self.first + facts["frames"] - 1

    def info(self, name):
        return json.loads(self.good("info", name, "--json").out)

    def edit(self, *words, **options):
        return self.good("edit", "walk.c3d", *words, **options)

    def shown(self):
        return json.loads(self.edit("--list", "--json", "--quiet").out)

    def rows(self, name):
        """{(frame, marker): (x, y, z, state)} of a recording, by its CSV."""
        self.good("convert", name, "rows.csv", "--edits", "none", "--force", "--quiet")
        lines = (line for line in (self.folder / "rows.csv").read_text().splitlines() if not line.startswith("#"))
        names = next(lines).split(",")
        where = [names.index(n) for n in ("frame", "marker", "x_m", "y_m", "z_m", "state")]
        cells = ([line.split(",")[i] for i in where] for line in lines)
        return {(int(cell[0]), cell[1]): tuple(cell[2:]) for cell in cells}

    def test_an_edit_lies_beside_the_recording_and_is_applied_from_there(self):
        original = self.walk.read_bytes()
        a, b = self.labels[:2]
        at = self.first + 10
        said = self.edit("--swap", a, b, "--from", at, "--author", "me").err
        self.assertIn(f"walk_edits.jsonl: swap of '{a}' and '{b}', from frame {at} on", said)
        self.assertIn("1 edit in force", said)
        first, second = (self.folder / "walk_edits.jsonl").read_text().splitlines()
        self.assertEqual(json.loads(first)["recording"]["name"], "walk.c3d")
        written = json.loads(second)
        self.assertEqual((written["do"], written["marker"], written["with"], written["first"]), ("swap", a, b, at))
        self.assertRegex(written["made"], r"^20\d\d-\d\d-\d\dT\d\d:\d\d:\d\dZ$")
        self.assertEqual(written["author"], "me")
        ran = self.good("convert", "walk.c3d", "swapped.c3d", "--edits", "walk_edits.jsonl")
        self.assertIn("note: 1 edit of walk_edits.jsonl was applied", ran.err)
        before, after = self.rows("walk.c3d"), self.rows("swapped.c3d")
        for frame in (self.first, at - 1, at, self.last):
            mine = (a, b) if frame < at else (b, a)
            self.assertEqual(after.get((frame, a)), before.get((frame, mine[0])))
            self.assertEqual(after.get((frame, b)), before.get((frame, mine[1])))
        self.assertEqual(self.walk.read_bytes(), original)

    def test_undo_and_redo(self):
        self.edit("--cut", self.labels[0])
        self.edit("--relabel", self.labels[1], "new")
        both = self.shown()
        self.assertEqual((both["undo"], both["redo"]), (2, 0))
        self.edit("--undo", 2)
        self.good("convert", "walk.c3d", "a.c3d")
        self.good("convert", "walk.c3d", "b.c3d", "--edits", "beside")
        self.assertEqual((self.folder / "a.c3d").read_bytes(), (self.folder / "b.c3d").read_bytes())
        self.edit("--redo", 2)
        again = self.shown()
        self.assertEqual(again["digest"], both["digest"])
        self.assertEqual([e["in_force"] for e in again["edits"] if "in_force" in e], [True, True])
        self.edit("--undo", 1)
        self.assertIn("relabel", self.edit("--list").out)
        self.assertIn("(undone)", self.edit("--list").out)
        self.refused(3, ["undo of 5 operations", "there is 1"], "edit", "walk.c3d", "--undo", 5)

    def test_clean_works_on_what_was_edited(self):
        knee = self.labels[5]
        first, last = self.first + 20, self.first + 29
        self.edit("--cut", knee, "--from", first, "--to", last)
        self.edit("--region", "gait", "--from", first, "--to", last)
        self.good("clean", "walk.c3d", "out.c3d", "--edits", "beside", "--filter", "none")
        report = json.loads((self.folder / "out_report.json").read_text())
        self.assertEqual([i["role"] for i in report["inputs"]], ["markers", "edits"])
        self.assertRegex(report["options"]["edits in force"], r"^2, XXH3-64 [0-9a-f]{16}$")
        self.assertEqual(report["options"]["region 'gait'"], f"frames {first} to {last}")
        rows = self.rows("out.c3d")
        self.assertFalse([f for f in range(first, last + 1) if rows.get((f, knee), ("",))[0] not in ("", "nan")])
        self.edit("--fill", knee, "--method", "pchip", "--from", first, "--to", last)
        self.good("clean", "walk.c3d", "filled.csv", "--edits", "beside", "--filter", "none")
        text = (self.folder / "filled.csv").read_text()
        self.assertGreaterEqual(text.count("pchip"), 10)

    def test_ik_and_track_work_on_what_was_edited(self):
        a, b = self.labels[:2]
        self.edit("--swap", a, b, "--from", self.first + 10)
        self.edit("--crop", "--from", self.first + 3)
        self.good("convert", "walk.c3d", "edited.c3d", "--edits", "beside")
        for solver in ("ik", "track"):
            self.good(solver, "-m", self.model, "-t", "edited.c3d", "-o", "by_file.mot", "--force")
            ran = self.good(solver, "-m", self.model, "-t", "walk.c3d", "--edits", "beside", "-o", f"{solver}.mot")
            self.assertIn("2 edits of walk_edits.jsonl were applied", ran.err)
            numbers = [(self.folder / name).read_text().split("endheader")[1] for name in ("by_file.mot", f"{solver}.mot")]
            self.assertEqual(*numbers)
            self.assertIn("edits", {i["role"] for i in json.loads((self.folder / f"{solver}_report.json").read_text())["inputs"]})
        self.refused(4, "absent.jsonl", "ik", "-m", self.model, "-t", "walk.c3d", "--edits", "absent.jsonl", "-o", "x.mot")
        self.refused(2, "need 'beside' or 'none' with several", "ik", "-m", self.model, "-t", "walk.c3d", "edited.c3d", "--edits", "walk_edits.jsonl", "-o", "out")

    def test_what_cannot_be_done_is_one_sentence(self):
        a, b = self.labels[:2]
        outside = self.last + 1
        self.refused(3, ["walk_edits.jsonl: new edit: cut: no marker is named", "nearest", a], "edit", "walk.c3d", "--cut", a + "X")
        self.refused(3, f"frame {outside} is not there", "edit", "walk.c3d", "--cut", a, "--to", outside)
        self.refused(3, f"both '{a}' and '{b}' have samples", "edit", "walk.c3d", "--relabel", a, b)
        self.refused(3, "no filled sample", "edit", "walk.c3d", "--unfill", a)
        self.refused(3, "nothing left", "edit", "walk.c3d", "--redo", 1)
        self.refused(2, "no operation", "edit", "walk.c3d")
        self.refused(2, "one at a time", "edit", "walk.c3d", "--cut", a, "--unfill", a)
        self.refused(2, "is no moment", "edit", "walk.c3d", "--cut", a, "--from", "soon")
        self.refused(2, "a first or a last frame", "edit", "walk.c3d", "--crop")
        self.refused(2, "needs its time", "edit", "walk.c3d", "--mark", "Turn")
        self.refused(2, "--method is for --fill", "edit", "walk.c3d", "--cut", a, "--method", "cubic")
        self.refused(2, "", "edit", "walk.c3d", "--swap", a)
        self.refused(4, "no.c3d", "edit", "no.c3d", "--cut", a)
        self.refused(4, "no_edits.jsonl", "clean", "walk.c3d", "out.c3d", "--edits", "no_edits.jsonl")

    def test_edits_of_another_recording(self):
        self.edit("--cut", self.labels[0])
        other = self.write("other.c3d", self.walk.read_bytes() + b"\0" * 512)
        words = ["these edits are of 'walk.c3d'", "'other.c3d'"]
        self.refused(3, words, "convert", other.name, "out.c3d", "--edits", "walk_edits.jsonl")
        self.refused(3, words, "clean", other.name, "out.c3d", "--edits", "walk_edits.jsonl")
        self.refused(3, words, "edit", other.name, "--edits", "walk_edits.jsonl", "--cut", self.labels[1])
        ran = self.good("convert", other.name, "out.c3d", "--edits", "walk_edits.jsonl", "--force")
        self.assertIn("applied to another recording", ran.err)
        shutil.move(self.walk, self.folder / "renamed.c3d")
        self.good("convert", "renamed.c3d", "same.c3d", "--edits", "walk_edits.jsonl")

    def test_damaged_journals(self):
        self.edit("--cut", self.labels[0], "--to", self.first + 3)
        self.edit("--cut", self.labels[1], "--to", self.first + 3)
        journal = self.folder / "walk_edits.jsonl"
        whole = journal.read_bytes()
        lines = whole.splitlines(keepends=True)
        convert = ["convert", "walk.c3d", "out.c3d", "--edits", "walk_edits.jsonl"]
        for damaged, words in (
            (lines[0] + lines[1].replace(b"cut", b"Cut") + lines[2], "line 2: its checksum is"),
            (lines[1] + lines[2], "line 1: needs"),
            (b"", "line 1: needs"),
            (bytes(300), "line 1: needs"),
            (whole + b"[]\n", "line 4: is no JSON object"),
            (whole + b'{"do":"cut","marker":"\xff"}\n', "line 4: is no JSON object"),
            (whole + lines[2], "line 4: id '2' is an earlier operation's"),
            (whole + b'{"do":"cut","marker":"nobody"}\n', "line 4: cut: no marker is named 'nobody'"),
        ):
            journal.write_bytes(damaged)
            self.refused(3, words, *convert)
            self.refused(3, words, "edit", "walk.c3d", "--cut", self.labels[2])
        journal.write_bytes(whole[:-4])
        ran = self.good(*convert)
        self.assertIn("line 3 was not written to its end and is left out", ran.err)
        self.assertIn("1 edit of", ran.err)
        self.edit("--cut", self.labels[2])
        self.assertEqual(len(self.shown()["edits"]), 2)
        journal.unlink()
        journal.mkdir()
        self.refused(3, "walk_edits.jsonl", *convert)

    def test_typed_by_hand_it_is_a_journal_too(self):
        self.edit("--cut", self.labels[0])
        with (self.folder / "walk_edits.jsonl").open("a") as journal:
            journal.write(f'{{"do": "swap", "marker": "{self.labels[1]}", "with": "{self.labels[2]}"}}\n\n')
        self.assertEqual(self.shown()["undo"], 2)
        self.edit("--undo", 1)
        self.assertEqual(self.shown()["undo"], 1)

    def test_many_recordings_have_their_own(self):
        (self.folder / "in").mkdir()
        for name in ("a.c3d", "b.c3d"):
            shutil.copy(self.c3d, self.folder / "in" / name)
        self.good("edit", "in/a.c3d", "--relabel", self.labels[0], "mine")
        self.good("clean", "in", "out", "--edits", "beside", "--filter", "none", "--quiet")
        self.assertIn("mine", self.info("out/a.c3d")["labels"])
        self.assertNotIn("mine", self.info("out/b.c3d")["labels"])
        self.refused(2, "is of one recording", "clean", "in", "out2", "--edits", "in/a_edits.jsonl")
        self.refused(2, "is no recording", "convert", self.truth, "t.sto", "--edits", "in/a_edits.jsonl")

    def test_a_study_takes_them_along(self):
        self.edit("--relabel", self.labels[0], "mine")
        self.write("study.toml", 'steps = ["clean"]\n[clean]\nedits = "beside"\nfilter = "none"\n'
                   '[[subject]]\nname = "S"\ntrials = ["walk.c3d"]\n')
        self.good("run", "study.toml", "--quiet")
        self.good("clean", "walk.c3d", "clean.c3d", "--edits", "walk_edits.jsonl", "--filter", "none", "--quiet")
        made = self.folder / "results/S/walk/clean.c3d"
        self.assertEqual(made.read_bytes(), (self.folder / "clean.c3d").read_bytes())
        before = listing(self.folder)
        self.good("run", "study.toml", "--quiet")
        self.assertEqual(listing(self.folder), before, "nothing is due")
        self.edit("--undo", 1)
        self.good("run", "study.toml", "--quiet")
        self.assertNotIn("mine", self.info(made)["labels"])
        (self.folder / "walk_edits.jsonl").unlink()
        state = json.loads(self.good("run", "study.toml", "--json").out)["steps"][0]["status"]
        self.assertEqual(state, "good", "it is due again without its journal")
