#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Edits of a recording: nothing acknowledged is lost, undo and redo are exact, every way of applying them gives the same.

    edits.py kills       a journal that is appended to, and `kinemark edit`, killed by kill -9
    edits.py history     100 edits from a fixed seed: undo all, redo all; `clean --edits` and `kinemark run`
    edits.py real        a real recording edited, cleaned and read back by ezc3d (needs Python with ezc3d)

Prints rows "PASS|FAIL | check | asked | measured".
"""

import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "cli"))

from support import PROGRAM, REAL_DATA, run
from rows import exit_status, row

KILLS = 50
COMMAND_KILLS = 50
EDITS = 100


def good(*arguments, cwd):
    ran = run(*arguments, cwd=cwd)
    if ran.status != 0:
        raise RuntimeError(f"kinemark {' '.join(map(str, arguments))}: {ran.err}")
    return ran


# Kills


def append_and_kill(tool, path, lines):
    """Kill the writer once it has acknowledged `lines` edits or more; the numbers of those that it had by then."""
    with subprocess.Popen([tool, "append", path], stdout=subprocess.PIPE) as writer:
        said = b""
        while said.count(b"\n") < lines:
            more = os.read(writer.stdout.fileno(), 256)
            if not more:
                raise RuntimeError(f"the writer ended by itself, exit status {writer.wait()}")
            said += more
        writer.kill()
        said += writer.stdout.read()
    return [int(line) for line in said[: said.rfind(b"\n") + 1].split()]


def check_journal(tool, path):
    """(edits in the journal, notes on its end, the first edit that is wrong or "none")."""
    ran = subprocess.run([tool, "check", path], capture_output=True, text=True, check=True)
    edits, notes, wrong = ran.stdout.split()
    return int(edits), int(notes), wrong


def kill_writers(tool, scratch):
    moments = random.Random(5)
    path = scratch / "walk_edits.jsonl"
    acknowledged = lost = wrong = beyond = 0
    for _ in range(KILLS):  # each goes on where the one before was killed
        numbers = append_and_kill(tool, path, moments.randint(1, 40))
        edits, _, first_wrong = check_journal(tool, path)
        acknowledged += len(numbers)
        lost += max(0, numbers[-1] + 1 - edits)
        beyond += edits > numbers[-1] + 2
        wrong += first_wrong != "none"
    row(lost == 0 and acknowledged > 10 * KILLS, f"kill -9 while appending, {KILLS} moments: acknowledged edits lost", "0",
        f"{lost} of {acknowledged}")
    row(wrong == 0, "journals with an edit that is not as it was made", "0", f"{wrong} of {KILLS}")
    row(beyond == 0, "journals with more than one edit beyond the acknowledged ones", "0", f"{beyond} of {KILLS}")
    whole = path.read_bytes()
    torn = behind = 0
    for _ in range(KILLS):  # what a power cut leaves: any length of the last line
        end = whole.rindex(b"\n", 0, len(whole) - 1) + 1
        size = moments.randint(end + 1, len(whole) - 1)
        path.write_bytes(whole[:size])
        edits, notes, first_wrong = check_journal(tool, path)
        torn += notes == 1 and first_wrong == "none" and edits == whole.count(b"\n") - 2
        append_and_kill(tool, path, 1)
        behind += check_journal(tool, path)[2] == "none"
    row(torn == KILLS, "journals cut in their last line: it is left out and said", f"{KILLS}", f"{torn}")
    row(behind == KILLS, "and the next edits stand behind the whole ones", f"{KILLS}", f"{behind}")


def kill_commands(scratch):
    good("simulate", "subject", "-o", "in", "--duration", 0.2, cwd=scratch)
    recording = scratch / "in" / "markers.c3d"
    original = recording.read_bytes()
    moments = random.Random(6)
    start = time.monotonic()
    good("edit", recording, "--region", "r", "--from", 1, "--to", 2, cwd=scratch)
    seconds = time.monotonic() - start
    acknowledged, lost, odd = {"r"}, 0, 0
    for i in range(COMMAND_KILLS):
        words = [PROGRAM, "edit", recording, "--region", f"r{i}", "--from", "1", "--to", "2", "--quiet"]
        with subprocess.Popen(words, cwd=scratch, stderr=subprocess.PIPE) as command:
            try:
                if command.wait(timeout=moments.uniform(0.0, 1.3 * seconds)) == 0:
                    acknowledged.add(f"r{i}")
            except subprocess.TimeoutExpired:
                command.kill()
        there = {edit["name"] for edit in json.loads(good("edit", recording, "--list", "--json", cwd=scratch).out)["edits"]}
        lost += len(acknowledged - there)
        odd += not there <= {"r", *(f"r{k}" for k in range(i + 1))}
        acknowledged |= there
    row(lost == 0 and odd == 0, f"`kinemark edit` killed at {COMMAND_KILLS} moments: edits lost, and made up", "0 and 0", f"{lost} and {odd}")
    row(recording.read_bytes() == original, "the recording's bytes", "unchanged", "unchanged" if recording.read_bytes() == original else "changed")


# History


def random_words(moments, labels, first, last):
    """An operation that may or may not apply."""
    a, b = moments.sample(labels, 2)
    start = moments.randint(first, last)
    where = ["--from", start, "--to", min(last, start + moments.randint(0, 20))]
    label = ["--context", "Left", "--at", moments.choice([first + 3, first + 5, first + 8])]
    return moments.choice([
        ["--swap", a, b, *where], ["--swap", a, b, *where[:2]], ["--cut", a, *where], ["--cut", a, *where],
        ["--fill", a, "--method", moments.choice(["linear", "cubic", "pchip", "rigid"])], ["--unfill", a, *where],
        ["--relabel", a, f"new{moments.randint(0, 9)}", *where], ["--relabel", a, f"whole{moments.randint(0, 99)}"],
        ["--mark", "Foot Strike", *label], ["--delete", "Foot Strike", *label],
        ["--move", "Foot Strike", *label, "--to", moments.randint(first, last)],
        ["--region", moments.choice(["gait", "turn"]), *where], ["--crop", "--from", first + moments.randint(0, 2)],
    ])  # fmt: skip


def history(scratch):
    good("simulate", "subject", "-o", "in", "--duration", 1, "--dropout-random", 0.05, cwd=scratch)
    recording = scratch / "walk.c3d"
    shutil.copy(scratch / "in" / "markers.c3d", recording)
    original = recording.read_bytes()
    facts = json.loads(good("info", recording, "--json", cwd=scratch).out)
    labels, first = facts["labels"], facts["first_frame"]
    last = first + facts["frames"] - 1
    moments = random.Random(7)
    kinds, made, tried = set(), 0, 0
    while made < EDITS and tried < 20 * EDITS:
        tried += 1
        words = random_words(moments, labels, first, last)
        ran = run("edit", recording, *words, cwd=scratch)
        if ran.status == 0:
            made += 1
            kinds.add(words[0])
        elif ran.status != 3:
            raise RuntimeError(ran.err)
        if ran.status == 0 and words[0] == "--relabel":
            labels = sorted({*labels, words[2]})
    row(made == EDITS and len(kinds) == 10, f"edits from a seed, and operations among them, of {tried} tried", f"{EDITS} and 10", f"{made} and {len(kinds)}")

    def state(name):
        good("convert", recording, name, "--edits", "beside", cwd=scratch)
        shown = json.loads(good("edit", recording, "--list", "--json", cwd=scratch).out)
        return shown["digest"], (scratch / name).read_bytes(), shown["regions"]

    after = state("a.c3d")
    good("edit", recording, "--undo", EDITS, cwd=scratch)
    undone = state("b.c3d")
    good("convert", recording, "c.c3d", cwd=scratch)
    row(undone[1] == (scratch / "c.c3d").read_bytes() and undone[2] == [], "all undone: the recording as without edits", "same bytes",
        "same bytes" if undone[1] == (scratch / "c.c3d").read_bytes() else "other bytes")
    good("edit", recording, "--redo", EDITS, cwd=scratch)
    again = state("d.c3d")
    row(again == after, "all redone, read anew: state and bytes", "the same", "the same" if again == after else "others")
    row(after[1] != undone[1], "edits changed something", "yes", "yes" if after[1] != undone[1] else "no")
    row(recording.read_bytes() == original, "the recording's own bytes", "unchanged", "unchanged" if recording.read_bytes() == original else "changed")

    good("clean", recording, "clean.c3d", "--edits", "walk_edits.jsonl", "--gaps", "cubic", cwd=scratch)
    (scratch / "study.toml").write_text(
        'steps = ["clean"]\n[clean]\nedits = "beside"\ngaps = "cubic"\n[[subject]]\nname = "S"\ntrials = ["walk.c3d"]\n', encoding="utf-8"
    )

    def steps():
        return [step["status"] for step in json.loads(good("run", "study.toml", "--json", cwd=scratch).out)["steps"]]

    said = [steps(), steps()]
    same = (scratch / "results/S/walk/clean.c3d").read_bytes() == (scratch / "clean.c3d").read_bytes()
    row(same, "`kinemark run` and `clean --edits`", "same bytes", "same bytes" if same else "other bytes")
    good("edit", recording, "--undo", 1, cwd=scratch)
    said.append(steps())
    row(said == [["good"], ["there already"], ["good"]], "run twice, then after an edit", "good, there already, good", ", ".join(s[0] for s in said))


# A real recording


def real(scratch):
    import ezc3d  # only here: it is an oracle
    import numpy as np

    path = REAL_DATA / "btk-others" / "FunctionalWalk.c3d"
    if not path.is_file():
        print(f"SKIP | a real recording, edited | read back by ezc3d | {path} is not there")
        return
    recording = scratch / "walk.c3d"
    shutil.copy(path, recording)
    before = ezc3d.c3d(str(recording))
    labels = before["parameters"]["POINT"]["LABELS"]["value"]
    points, first = before["data"]["points"][:3], before["header"]["points"]["first_frame"] + 1
    residuals = before["data"]["meta_points"]["residuals"][0]
    frames = points.shape[2]
    lasi, rasi, knee, other = (labels.index(name) for name in ("LASI", "RASI", "LKNE", "RKNE"))
    swap_at, cut_at, cut_to = first + 120, first + 200, first + 219
    for words in (
        ["--swap", "LASI", "RASI", "--from", swap_at],
        ["--cut", "LKNE", "--from", cut_at, "--to", cut_to],
        ["--cut", "RKNE", "--from", cut_at, "--to", cut_to],
        ["--fill", "RKNE", "--method", "auto"],
        ["--relabel", "RTOE", "RTOES"],
        ["--mark", "Foot Strike", "--context", "Left", "--at", first + 50],
    ):
        good("edit", recording, *words, cwd=scratch)
    good("clean", recording, "out.c3d", "--edits", "beside", "--filter", "none", cwd=scratch)
    after = ezc3d.c3d(str(scratch / "out.c3d"))
    moved = after["data"]["points"][:3]
    made = after["data"]["meta_points"]["residuals"][0]
    out = after["parameters"]["POINT"]["LABELS"]["value"]

    def path_of(name):
        return moved[:, out.index(name), :]

    swapped = np.nanmax(np.abs(path_of("LASI") - np.concatenate([points[:, lasi, :120], points[:, rasi, 120:]], axis=1)))
    row(swapped < 1e-3, "FunctionalWalk.c3d, read by ezc3d: LASI is RASI from the swap on, mm", "< 0.001", f"{swapped:.2g}")
    gone = np.isnan(path_of("LKNE"))[0] | (made[out.index("LKNE")] < 0)
    was = np.isnan(points[:, knee, :])[0] | (residuals[knee] < 0)
    row(gone[200:220].all() and (gone == was)[list(range(200)) + list(range(220, frames))].all(), "LKNE is missing where it was cut",
        "20 frames more", f"{int(gone.sum() - was.sum())} frames more")
    filled = np.linalg.norm(path_of("RKNE")[:, 200:220] - points[:, other, 200:220], axis=0)
    row(float(filled.max()) < 10.0 and (made[out.index("RKNE")][200:220] == 0).all(), "RKNE filled where it was cut: farthest from what was there, mm, and residual",
        "< 10 and 0", f"{filled.max():.2f} and {made[out.index('RKNE')][200:220].max():g}")
    row("RTOES" in out and "RTOE" not in out, "RTOE is RTOES", "renamed", "renamed" if "RTOES" in out else "not")
    count = [len(c["parameters"]["EVENT"]["LABELS"]["value"]) for c in (before, after)]
    row(count[1] == count[0] + 1, "events", f"{count[0] + 1}", f"{count[1]}")
    others = [i for i, name in enumerate(labels) if name not in ("LASI", "RASI", "LKNE", "RKNE", "RTOE") and name in out]
    worst = max(float(np.nanmax(np.abs(path_of(labels[i]) - points[:, i, :]), initial=0.0)) for i in others)
    row(worst < 1e-3, f"the {len(others)} markers that were not edited, mm", "< 0.001", f"{worst:.2g}")
    row(recording.read_bytes() == path.read_bytes(), "the recording's own bytes", "unchanged",
        "unchanged" if recording.read_bytes() == path.read_bytes() else "changed")


def main():
    what = sys.argv[1] if len(sys.argv) > 1 else ""
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as folder:
        scratch = Path(folder)
        if what == "kills":
            kill_writers(Path(PROGRAM).parent / "edits_acceptance_tool", scratch)
            kill_commands(scratch)
        elif what == "history":
            history(scratch)
        elif what == "real":
            real(scratch)
        else:
            sys.exit(__doc__)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
