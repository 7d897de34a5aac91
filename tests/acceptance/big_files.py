#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Speed and memory of reading 1 GB of C3D and of CSV, by `kinemark info`, beside a plain copy of the same bytes to nowhere.

The files lie in the page cache: what is measured is the program. Rates are the best of three runs, memory the most of them.
    big_files.py [BYTES]      1 GB when absent
Finds the program in KINEMARK_PROGRAM and room in KINEMARK_SCRATCH; prints rows "PASS|FAIL | check | asked | measured"; exit
status 1 when one fails.
"""

import os
import struct
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("KINEMARK_PROGRAM", str(ROOT / "build" / "release" / "bin" / "kinemark"))
SCRATCH = Path(os.environ.get("KINEMARK_SCRATCH", tempfile.gettempdir()))
MARKERS = 60
RATE = 200.0


def parameter(name, number, kind, dims, data):
    """One parameter of a C3D file; `kind` bytes an element, -1 for characters."""
    body = struct.pack("<bB", kind, len(dims)) + bytes(dims) + data
    return struct.pack("<bb", len(name), number) + name.encode() + struct.pack("<h", 2 + len(body) + 1) + body + b"\0"


def group(name, number):
    return struct.pack("<bb", len(name), -number) + name.encode() + struct.pack("<hB", 3, 0)


def write_c3d(path, size):
    """Floating point, all samples measured; markers that move slowly."""
    frames = size // (16 * MARKERS)
    labels = b"".join(f"M{m}".ljust(4).encode() for m in range(MARKERS))
    section = group("POINT", 1)
    for name, kind, dims, data in (
        ("USED", 2, [], struct.pack("<h", MARKERS)),
        ("SCALE", 4, [], struct.pack("<f", -1.0)),
        ("RATE", 4, [], struct.pack("<f", RATE)),
        ("DATA_START", 2, [], struct.pack("<h", 10)),
        ("FRAMES", 4, [], struct.pack("<f", float(frames))),
        ("UNITS", -1, [2], b"mm"),
        ("LABELS", -1, [4, MARKERS], labels),
    ):
        section += parameter(name, 1, kind, dims, data)
    section = struct.pack("<BBBB", 1, 0x50, 8, 84) + section
    assert len(section) < 8 * 512
    header = struct.pack("<BBHHHHHfHHf", 2, 0x50, MARKERS, 0, 1, min(frames, 65535), 0, -1.0, 10, 0, RATE)
    with path.open("wb") as file:
        file.write(header.ljust(512, b"\0") + section.ljust(8 * 512, b"\0"))
        block = bytearray()
        for f in range(1000):
            for m in range(MARKERS):
                block += struct.pack("<ffff", 100.25 + f % 97 + 9 * m, 200.5 + f % 89, 900.125 + m, 0.5)
        for first in range(0, frames, 1000):
            file.write(block[: 16 * MARKERS * min(1000, frames - first)])
    return frames


def write_csv(path, size):
    """Rows of frame, time, marker and three coordinates in metres."""
    frames = 0
    with path.open("w", encoding="ascii") as file:
        file.write("frame,time_s,marker,x_m,y_m,z_m\n")
        while file.tell() < size:
            rows = []
            for f in range(frames, frames + 1000):
                when = f"{f + 1},{f / RATE:.3f}"
                rows += [f"{when},M{m},0.{(f * 7 + m) % 99991:06},1.{m:03}{f % 997:03},0.9{f % 89:02}125\n" for m in range(MARKERS)]
            file.write("".join(rows))
            frames += 1000
    return frames


def run(path):
    """(seconds, MB of memory, exit status, processor seconds) of one run."""
    begin = time.monotonic()
    with subprocess.Popen([PROGRAM, "info", "--json", path], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as child:
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    return time.monotonic() - begin, usage.ru_maxrss / 1024.0, child.returncode, usage.ru_utime + usage.ru_stime


def copied(path):
    """MB/s of reading the bytes alone."""
    begin = time.monotonic()
    with path.open("rb", buffering=0) as file:
        while file.read(1 << 22):
            pass
    return path.stat().st_size / 1e6 / (time.monotonic() - begin)


def check(path, frames, least_mb_s):
    """Rows of one file. Memory is bound to 1.5 times the decoded arrays (33 bytes a sample: position, state, residual) and, of
    text, the text itself."""
    size_mb = path.stat().st_size / 1e6
    plain = copied(path)
    runs = [run(path) for _ in range(3)]
    rate, memory = size_mb / min(r[0] for r in runs), max(r[1] for r in runs)
    bound = 1.5 * frames * MARKERS * 33 / 1048576 + (size_mb if path.suffix == ".csv" else 0) + 100
    good = rate >= least_mb_s and all(r[2] == 0 for r in runs)
    processor = size_mb / min(r[3] for r in runs)
    print(f"{'PASS' if good else 'FAIL'} | {size_mb:.0f} MB {path.suffix} | >= {least_mb_s} MB/s | {rate:.0f} MB/s, {processor:.0f} MB a "
          f"processor second (reading the bytes alone {plain:.0f} MB/s), load {os.getloadavg()[0]:.1f}", flush=True)
    small = memory <= bound
    print(f"{'PASS' if small else 'FAIL'} | {size_mb:.0f} MB {path.suffix}, memory | <= {bound:.0f} MB | {memory:.0f} MB", flush=True)
    return good and small


def main(arguments):
    size = int(arguments[0]) if arguments else 1_000_000_000
    good = True
    with tempfile.TemporaryDirectory(dir=SCRATCH) as name:
        for ending, write, least in ((".c3d", write_c3d, 500), (".csv", write_csv, 100)):
            path = Path(name) / f"big{ending}"
            frames = write(path, size)
            good &= check(path, frames, least)
            path.unlink()
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
