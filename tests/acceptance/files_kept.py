#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Files that are written stay whole, whatever the disk, a kill or a flipped bit does. (Second writers: attack.py.)

    files_kept.py full_disk LEVELS        each command that writes, its disk full at so many levels
    files_kept.py kills KILLS             each command that writes a set, killed at so many moments in all
    files_kept.py flips COUNT             so many single-bit flips in NWB files of ours

Prints rows "PASS|FAIL | check | asked | measured".
"""

import json
import os
import random
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "cli"))

from support import PROGRAM, listing, run
from writing import Workshop, empty_folder, flips, hidden, kill_at, on_full_disks, seconds_of, visible

from rows import exit_status, row


def tell(wrong):
    for sentence in wrong[:10]:
        print(sentence)


def full_disk(workshop, scratch, levels):
    for name, command in workshop.commands.items():
        wrong, runs = on_full_disks(command, scratch, levels)
        tell(wrong)
        row(not wrong, f"{name}, {runs} times on a full disk: exit status 4, old files whole, nothing left", "all", f"{runs - len(wrong)} of {runs}")


def without_times(name, content):
    """The content of a file, but for how long the work took."""
    if not name.endswith(".json"):
        return content
    facts = json.loads(content)
    for key in ("solve_s", "frames_per_s", "command_line", "clean_s"):
        facts.pop(key, None)
    facts.get("run", {}).pop("clean_s", None)
    return facts


def set_of(folder, first):
    """What `validate` says of a set: "whole", "mixed" or "?"."""
    ran = run("validate", first, cwd=folder)
    if "was not written together with" in ran.err + ran.out:
        return "mixed"
    return "whole" if ran.status in (0, 1) else "?"


def kills(workshop, scratch, count):
    draw = random.Random(17)
    names = list(workshop.others)
    for name in names:
        old, new = workshop.commands[name], workshop.others[name]
        first = next(str(part) for part in old if str(part).startswith("x."))
        killed = half = mixed = unnoticed = left = 0
        with empty_folder(scratch) as folder:
            seconds = min(seconds_of([*old, "--force"], folder) for _ in range(3))
            wanted = {}
            for command in (old, new):
                run(*command, "--force", cwd=folder)
                for path, content in visible(folder).items():
                    wanted.setdefault(path, []).append(without_times(path, content))
            wished = -(-count // len(names))
            for i in range(10 * wished):
                if killed == wished:
                    break
                # The last moments are those in which files get their names.
                moment = draw.uniform(0.8, 1.05) if i % 2 else draw.uniform(0.0, 1.0)
                run(*old, "--force", cwd=folder)
                killed += kill_at([*new, "--force"], folder, moment * seconds)
                now = visible(folder)
                which = {path: [k for k in (0, 1) if without_times(path, now.get(path, b"null")) == wanted[path][k]] for path in wanted if not path.endswith(".html")}
                half += sum(not found for path, found in which.items() if not path.endswith(".json"))
                tables = [found for path, found in which.items() if len(found) == 1 and not path.endswith(".json")]
                is_mixed = len({found[0] for found in tables}) > 1
                mixed += is_mixed
                unnoticed += is_mixed != (set_of(folder, first) == "mixed") and is_mixed
                run(*old, "--force", cwd=folder)
                left += len(hidden(folder))
        row(half == 0 and killed == wished, f"{name}, killed {wished} times: files half-written", "0", f"{half} in {killed}")
        row(unnoticed == 0, f"{name}: mixtures of old and new that were not noticed", "0", f"{unnoticed} of {mixed}")
        row(left == 0, f"{name}: hidden files after the next run", "0", str(left))


def read_flipped(arguments):
    """How a reader takes a file with one flipped bit: (exit status, whether it said one clean line, its JSON)."""
    folder, number, changed = arguments
    path = folder / f"{number}.nwb"
    path.write_bytes(changed)
    try:
        ran = subprocess.run([PROGRAM, "validate", path, "--quiet"], capture_output=True, check=False, timeout=60)
        lines = ran.stderr.decode(errors="replace").splitlines()
        clean = len(lines) <= 1 and all("HDF5-DIAG" not in line and "infinite loop" not in line for line in lines)
        status = ran.returncode
        same = None
        if status == 0:
            out = folder / f"{number}.csv"
            subprocess.run([PROGRAM, "convert", path, out, "--quiet"], check=False, timeout=60)
            same = out.read_bytes() if out.is_file() else b""
            out.unlink(missing_ok=True)
        return status, clean, same
    except subprocess.TimeoutExpired:
        return None, True, None
    finally:
        path.unlink()


def flipped(workshop, scratch, count):
    scratch = Path(scratch)
    for name in ("convert to NWB", "clean to NWB"):
        with empty_folder(scratch, "written") as written:
            run(*workshop.commands[name], cwd=written)
            whole = (written / "x.nwb").read_bytes()
            run("convert", "x.nwb", "whole.csv", cwd=written)
            content = (written / "whole.csv").read_bytes()
        with ThreadPoolExecutor(max_workers=2) as pool:
            work = ((scratch, k, changed) for k, (_, changed) in enumerate(flips(whole, count // 2, 23)))
            ended = list(pool.map(read_flipped, work))
        hangs = sum(status is None for status, _, _ in ended)
        crashes = sum(status is not None and status not in (0, 1, 3) for status, _, _ in ended)
        noisy = sum(not clean for _, clean, _ in ended)
        noticed = sum(status in (1, 3) for status, _, _ in ended)
        unnoticed = sum(status == 0 and same != content for status, _, same in ended)
        harmless = sum(status == 0 and same == content for status, _, same in ended)
        row(crashes == 0, f"{name}, {len(ended)} files with one flipped bit: crashes", "0", str(crashes))
        row(hangs == 0, f"{name}: hangs", "0", str(hangs))
        row(noisy == 0, f"{name}: files of which more than one line was said", "0", str(noisy))
        share = 100.0 * noticed / max(1, noticed + unnoticed)
        row(share >= 99.9, f"{name}: changed content that was noticed", ">= 99.9 %", f"{share:.2f} % ({noticed} noticed, {unnoticed} not, {harmless} that change nothing)")


def main():
    kind, count = sys.argv[1], int(sys.argv[2])
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        workshop = Workshop(scratch)
        inputs = listing(workshop.inputs)
        if kind == "full_disk":
            full_disk(workshop, scratch, count)
        elif kind == "kills":
            kills(workshop, scratch, count)
        else:
            flipped(workshop, scratch, count)
        row(listing(workshop.inputs) == inputs, "inputs as they were", "all", "all" if listing(workshop.inputs) == inputs else "changed")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
