#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""A session of `kinemark acquire`: made, continued, after a `kill -9` in a trial too; its checksums by Debian's xxhsum; all its trials by
`kinemark run`, beside each of them by itself.

Finds the program in KINEMARK_PROGRAM. Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import json
import os
import shutil
import signal
import subprocess
import sys
import tomllib
from pathlib import Path

from rows import PROGRAM, exit_status, row

RIG = ("sim:rig?scene=sign&seed=3&seconds=1&fast", "--rate", "200")
STUDY = """steps = ["reconstruct"]
[[subject]]
name = "S01"
session = "day1"
"""


def kinemark(*words):
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, check=False)


def acquire(*words):
    ran = kinemark("acquire", *words, "--session", "day1", "--json")
    return ran, json.loads(ran.stdout.splitlines()[-1]) if ran.stdout else {}


def session():
    return tomllib.loads(Path("day1/session.toml").read_text(encoding="utf-8"))


def killed_trial():
    """Frames that were acknowledged before the program was killed."""
    words = [PROGRAM, "acquire", "sim:rig?scene=sign&seed=3", "--session", "day1", "--trial", "killed", "--json", "--quiet"]
    with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as ran:
        acknowledged = json.loads(ran.stdout.readline())["acknowledged"]
        os.kill(ran.pid, signal.SIGKILL)
    return acknowledged


def make_and_continue():
    simulated = kinemark("simulate", "rig", "sign", "-o", "lab", "--seed", 3, "--rate", 200, "--duration", 1)
    row(simulated.returncode == 0, "session: a rig to record with", "exit status 0", simulated.returncode)
    ends = [acquire(*RIG, "--subject", "S01", "--rig", "lab/rig_true.toml", "--trial", "sign")[0].returncode]
    ends += [acquire(*RIG, "--trial", "sign")[0].returncode]
    names = [trial["file"] for trial in session()["trial"]]
    row(names == ["raw/sign.mcap", "raw/sign_02.mcap"] and ends == [0, 0], "session: made and continued", "two trials, names counted on", names)
    acknowledged = killed_trial()
    before = len(session()["trial"])
    ran, _ = acquire(*RIG, "--trial", "sign")
    named = "killed.mcap: was not closed" in ran.stderr
    row(named and len(session()["trial"]) == before + 1, "session: continued after a kill -9", "the open trial is named, the next is in", f"{'named' if named else 'not named'}, {len(session()['trial'])} trials")
    recovered = kinemark("recover", "day1/raw/killed.mcap", "day1/raw/whole.mcap")
    ran, _ = acquire(*RIG, "--trial", "sign")
    info = json.loads(kinemark("info", "day1/raw/whole.mcap", "--json").stdout)
    kept = info["frames"]
    taken = any(trial["file"] == "raw/whole.mcap" for trial in session()["trial"])
    row(recovered.returncode == 0 and kept >= acknowledged > 0 and taken, "session: what was acknowledged before the kill", f">= {acknowledged} frames, taken in", f"{kept} frames")
    writable = [path.name for path in Path("day1/raw").glob("*.mcap") if path.stat().st_mode & 0o222]
    row(writable == ["killed.mcap"], "session: its recordings", "read-only", f"writable: {writable}")


def checksums():
    if shutil.which("xxhsum") is None:
        row(False, "session: checksums by xxhsum", "OK", "xxhsum is not there; tools/setup installs it")
        return
    ran = subprocess.run(["xxhsum", "-c", "MANIFEST"], cwd="day1", capture_output=True, text=True, check=False)
    good = ran.stdout.count(": OK")
    row(ran.returncode == 0 and good == len(session()["trial"]), "session: checksums by xxhsum", f"{len(session()['trial'])} OK", f"{good} OK")


def run_of_all():
    Path("study.toml").write_text(STUDY, encoding="utf-8")
    ran = kinemark("run", "study.toml")
    names = [Path(trial["file"]).stem for trial in session()["trial"]]
    same = 0
    for name in names:
        kinemark("reconstruct", f"day1/raw/{name}.mcap", "--rig", "lab/rig_true.toml", "-o", f"{name}.c3d")
        kinemark("convert", f"{name}.c3d", f"{name}.csv")
        kinemark("convert", f"results/S01/{name}/markers.c3d", f"{name}_run.csv")
        pair = [Path(f"{name}.csv"), Path(f"{name}_run.csv")]
        same += all(path.is_file() for path in pair) and pair[0].read_bytes() == pair[1].read_bytes()
    row(ran.returncode == 0 and same == len(names) == 5, "session: run over it, and each trial by itself", "the same markers, 5 trials", f"{same} same, exit status {ran.returncode} {ran.stderr.strip()[-200:]}")


def changed():
    path = Path("day1/raw/sign.mcap")
    path.chmod(0o644)
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(content)
    ran = kinemark("run", "study.toml")
    row(ran.returncode == 3 and "sign.mcap: was changed since it was recorded" in ran.stderr, "session: a recording that was changed", "named, exit status 3", f"{ran.returncode} {ran.stderr.strip()[-120:]}")
    path.unlink()
    ran = kinemark("run", "study.toml")
    row(ran.returncode == 4 and "sign.mcap: is in MANIFEST and not there" in ran.stderr, "session: a recording that is gone", "named, exit status 4", f"{ran.returncode} {ran.stderr.strip()[-120:]}")


def main():
    os.chdir(os.environ["KINEMARK_SCRATCH"])
    make_and_continue()
    checksums()
    run_of_all()
    changed()


main()
sys.exit(exit_status())
