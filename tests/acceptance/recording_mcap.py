#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings read by @mcap/core, an unrelated reader: closed, killed, cut, damaged, and as recovered from those.

    recording_mcap.py [FOLDER_OF_PROGRAMS]

Needs Node and npm, which fetches @mcap/core into a scratch folder. Prints rows "PASS|FAIL | check | asked | measured".
"""

import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from rows import exit_status, row

HERE = Path(__file__).resolve().parent
PACKAGE = "@mcap/core@2.2.2"
FRAMES = 2000
VALUES = 64  # counts a frame: 8 LEDs, 2 cameras, 4 electrodes


def counts_of(frame):
    return [(31 * frame + 7 * i) % 4096 for i in range(VALUES)]


class Reader:
    """@mcap/core in a folder of its own."""

    def __init__(self, folder):
        own = HERE.parent.parent / ".venv" / "bin"
        path = f"{own}{os.pathsep}{os.environ['PATH']}" if (own / "node").exists() else os.environ["PATH"]
        self.environment = {**os.environ, "PATH": path}
        self.script = Path(shutil.copy(HERE / "read_mcap.js", Path(folder) / "read_mcap.mjs"))
        subprocess.run(
            ["npm", "install", "--no-audit", "--no-fund", "--silent", "--prefix", folder, PACKAGE],
            env=self.environment, check=True, stdout=subprocess.DEVNULL, timeout=300,
        )  # fmt: skip

    def read(self, path):
        ran = subprocess.run(["node", self.script, path], env=self.environment, capture_output=True, text=True, check=True)
        return json.loads(ran.stdout)


def check_messages(name, found, frames):
    row(found["error"] is None, f"{name}: @mcap/core streams it", "no error", found["error"] or "no error")
    row(len(found["sequences"]) == len(frames), f"{name}: messages", f"{len(frames)}", f"{len(found['sequences'])}")
    good = found["sequences"] == frames and found["values"] == [counts_of(frame) for frame in frames]
    row(good, f"{name}: numbers, times and counts", "as recorded", "as recorded" if good else "differ")
    times = [10_000_000 * frame for frame in frames]
    row(found["log_times_ns"] == times, f"{name}: log times", "as recorded",
        "as recorded" if found["log_times_ns"] == times else "differ")


def check_closed(name, found, messages, metadata):
    row(found["done"], f"{name}: complete for @mcap/core", "yes", "yes" if found["done"] else "no")
    indexed = found["indexed"]
    row(indexed.get("messages") == messages, f"{name}: its summary counts", f"{messages}", f"{indexed}")
    row(indexed.get("topics") == ["/counts"] and indexed.get("metadata") == metadata, f"{name}: its index",
        f"/counts, {metadata}", f"{indexed.get('topics')}, {indexed.get('metadata')}")


def whole_messages(data):
    """(messages whose record is whole in these bytes, those of them whose check record is whole too)."""
    at, messages, verified = 8, 0, 0
    while at + 9 <= len(data):
        length = int.from_bytes(data[at + 1 : at + 9], "little")
        if at + 9 + length > len(data):
            break
        messages += data[at] == 0x05
        verified = messages if data[at] == 0x90 else verified
        at += 9 + length
    return messages, verified


def main():
    program = Path(os.environ.get("KINEMARK_PROGRAM", "build/release/bin/kinemark"))
    tool = (Path(sys.argv[1]) if len(sys.argv) > 1 else program.parent) / "recording_acceptance_tool"
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        folder = Path(scratch)
        reader = Reader(folder)
        closed = folder / "closed.mcap"
        subprocess.run([tool, "make", closed, str(FRAMES)], check=True)
        data = closed.read_bytes()
        everything = list(range(FRAMES))
        found = reader.read(closed)
        check_messages("closed", found, everything)
        check_closed("closed", found, FRAMES, [])

        def recover(path):
            out = path.with_suffix(".recovered.mcap")
            subprocess.run([program, "recover", "--quiet", path, out], check=False)
            return out

        cut = folder / "cut.mcap"
        for length in (len(data) // 2, len(data) // 3 + 11, data.rindex(b"\x90\x08" + bytes(7)) + 3, len(data) - 5):
            cut.write_bytes(data[:length])
            # A message whose check is cut off is readable for others, but not verified: ours leaves it out.
            messages, verified = whole_messages(data[:length])
            check_messages(f"cut at byte {length}", reader.read(cut), everything[:messages])
            out = recover(cut)
            found = reader.read(out)
            check_messages(f"recovered from {length} bytes", found, everything[:verified])
            check_closed(f"recovered from {length} bytes", found, verified, ["kinemark.recovered"])
            out.unlink()

        damaged = folder / "damaged.mcap"
        middle = bytearray(data)
        middle[len(data) // 2] ^= 1
        damaged.write_bytes(middle)
        found = reader.read(recover(damaged))
        lost = sorted(set(everything) - set(found["sequences"]))
        row(1 <= len(lost) <= 2, "one bit flipped: frames lost", "1 to 2", f"{len(lost)}")
        check_messages("recovered past the damage", found, [frame for frame in everything if frame not in lost])
        check_closed("recovered past the damage", found, FRAMES - len(lost), ["kinemark.recovered"])
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
