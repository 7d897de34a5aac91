# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Every command that writes, on small inputs, and what can come between it and its files: for test_files.py and for
tests/acceptance/files_kept.py."""

import contextlib
import os
import random
import resource
import shutil
import signal
import subprocess
import time
from pathlib import Path

from support import PROGRAM, SECONDS, listing, run


def file_size_limit(size):
    """Files of the child may not grow beyond `size` bytes: what a full disk does to it."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


class Workshop:
    """Inputs in `inputs`, made once; `commands` are the arguments of each command that writes, into the current folder."""

    def __init__(self, folder):
        self.inputs = Path(folder) / "inputs"
        self.inputs.mkdir()
        self._make("simulate", "subject", "-o", "body", "--duration", 0.3)
        self._make("simulate", "subject", "-o", "other", "--duration", 0.3, "--seed", 7)
        self._make("simulate", "arm", "-o", "arm", "--frames", 60, "--markers", 4, "--stagger", 15)
        self._make("simulate", "rig", "sign", "-o", "lab", "--duration", 0.1, "--grid")
        body, other, arm, lab = (self.inputs / name for name in ("body", "other", "arm", "lab"))
        self._make("ik", "-m", body / "model.osim", "-t", body / "markers.c3d", "-o", "solved.mot")
        self.solved = self.inputs / "solved.mot"
        self.commands = {
            "convert to C3D": ["convert", body / "markers.trc", "x.c3d"],
            "convert to TRC": ["convert", body / "markers.c3d", "x.trc"],
            "convert to CSV": ["convert", body / "markers.c3d", "x.csv"],
            "convert to NWB": ["convert", body / "markers.c3d", "x.nwb"],
            "convert to STO": ["convert", body / "truth.mot", "x.sto"],
            "convert to OSIM": ["convert", body / "model.osim", "x.osim"],
            "clean to C3D": ["clean", body / "markers.c3d", "x.c3d", "--derivatives", "--report", "x.html"],
            "clean to NWB": ["clean", body / "markers.c3d", "x.nwb", "--derivatives"],
            "edit": ["edit", body / "markers.c3d", "--edits", "x.jsonl", "--region", "x", "--from", 1, "--to", 2],
            "joints": ["joints", arm / "markers.c3d", "--segments", arm / "segments.toml", "--method", "score", "-o", "x"],
            "scale": ["scale", "-m", body / "model.osim", "--static", body / "markers.c3d", "-o", "x.osim"],
            "ik": ["ik", "-m", body / "model.osim", "-t", body / "markers.c3d", "-o", "x.mot", "--report", "x.html"],
            "track": ["track", "-m", body / "model.osim", "-t", body / "markers.c3d", "-o", "x.mot"],
            "report": ["report", self.solved, "-o", "x.html"],
            "simulate subject": ["simulate", "subject", "-o", "x", "--duration", 0.2],
            "simulate arm": ["simulate", "arm", "-o", "x", "--frames", 30],
            "simulate rig": ["simulate", "rig", "sign", "-o", "x", "--duration", 0.1],
            "calibrate": ["calibrate", lab / "grid_A.mcap", lab / "grid_B.mcap", "--nominal", lab / "rig_nominal.toml", "--method", "grid-lut", "-o", "x.toml"],
            "reconstruct": ["reconstruct", lab / "recording.mcap", "--rig", lab / "rig_true.toml", "--method", "frames", "-o", "x.csv"],
            "recover": ["recover", lab / "recording.mcap", "x.mcap"],
        }
        # The same command on another recording, whose results replace the first ones.
        self.others = {
            "ik": ["ik", "-m", body / "model.osim", "-t", other / "markers.c3d", "-o", "x.mot", "--report", "x.html"],
            "track": ["track", "-m", body / "model.osim", "-t", other / "markers.c3d", "-o", "x.mot"],
            "clean to C3D": ["clean", other / "markers.c3d", "x.c3d", "--derivatives", "--report", "x.html"],
            "scale": ["scale", "-m", body / "model.osim", "--static", other / "markers.c3d", "-o", "x.osim"],
        }

    def _make(self, *arguments):
        made = run(*arguments, cwd=self.inputs)
        assert made.status in (0, 1), (arguments, made.err)


def is_hidden(name):
    return any(part.startswith(".kinemark-") for part in Path(name).parts)


def visible(folder):
    return {name: content for name, content in listing(folder).items() if not is_hidden(name)}


def hidden(folder):
    """Names of what lies hidden in a folder, also while a program removes it."""
    found = (os.path.join(top, name) for top, folders, files in os.walk(folder) for name in folders + files)
    return sorted(path for path in map(lambda path: os.path.relpath(path, folder), found) if is_hidden(path))


@contextlib.contextmanager
def empty_folder(parent, name="work"):
    folder = Path(parent) / name
    folder.mkdir()
    try:
        yield folder
    finally:
        shutil.rmtree(folder)


def fill_levels(sizes, levels):
    """File sizes from nothing to just below the largest of these, at which a disk is full."""
    most = max(sizes)
    return sorted({int(most * level / levels) for level in range(levels)})


def on_full_disks(command, parent, levels):
    """What is wrong after a command met a full disk at so many levels, in an empty folder and where it replaces older
    files; and how many runs that were."""
    wrong, runs = [], 0
    with empty_folder(parent, "older") as older:
        first = run(*command, cwd=older)
        assert first.status in (0, 1), (command, first.err)
        before = listing(older)
        for level in fill_levels([len(content) for content in before.values() if content is not None], levels):
            with empty_folder(parent) as fresh:
                for folder, force in ((fresh, []), (older, ["--force"])):
                    ran = run(*command, *force, cwd=folder, preexec_fn=file_size_limit(level))
                    runs += 1
                    if ran.status != 4:
                        wrong.append(f"{command[0]} at {level} bytes: exit status {ran.status}: {ran.err.strip()[-200:]}")
                    if not ran.err.splitlines()[-1:] or "cannot be" not in ran.err.splitlines()[-1]:
                        wrong.append(f"{command[0]} at {level} bytes: said {ran.err.strip()[-200:]!r}")
                    if listing(folder) != (before if force else {}):
                        wrong.append(f"{command[0]} at {level} bytes: left other files than before")
    return wrong, runs


def of_two_writers(command, parent):
    """(exit statuses, files left hidden) of two programs that write the same output at once."""
    with empty_folder(parent) as folder:
        both = [
            subprocess.Popen([PROGRAM, *map(str, command)], cwd=folder, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
            for _ in range(2)
        ]
        return sorted(program.wait(timeout=SECONDS) for program in both), hidden(folder)


def kill_at(command, folder, moment):
    """Ends a command with SIGKILL after so many seconds, or when it is done; whether it was killed."""
    program = subprocess.Popen([PROGRAM, *map(str, command)], cwd=folder, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
    try:
        program.wait(timeout=moment)
        return False
    except subprocess.TimeoutExpired:
        program.send_signal(signal.SIGKILL)
        program.wait()
        return True


def seconds_of(command, folder):
    start = time.monotonic()
    done = run(*command, cwd=folder)
    assert done.status in (0, 1), (command, done.err)
    return time.monotonic() - start


def flips(content, count, seed):
    """(bit, content with that bit flipped), drawn with a seed."""
    draw = random.Random(seed)
    for _ in range(count):
        bit = draw.randrange(8 * len(content))
        changed = bytearray(content)
        changed[bit // 8] ^= 1 << (bit % 8)
        yield bit, bytes(changed)

