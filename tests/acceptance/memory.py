#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Most memory that `kinemark info` takes: of files that are no recordings, of long lines, of many frames, of many markers.

    memory.py [--quick]      --quick: a tenth of the frames and markers, in the same bounds
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("KINEMARK_PROGRAM", str(ROOT / "build" / "release" / "bin" / "kinemark"))
SCRATCH = Path(os.environ.get("KINEMARK_SCRATCH", tempfile.gettempdir()))
FEW_MARKERS, FEW_FRAMES = 4, 50


def peak_mb(*arguments):
    """(exit status, most resident memory in MB) of a run; at least that of this script, about 20 MB."""
    with subprocess.Popen([PROGRAM, *map(str, arguments)], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as child:
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    return child.returncode, usage.ru_maxrss / 1024.0


def zeros(path, size):
    with path.open("wb") as file:
        file.truncate(size)  # a hole: takes no room on the disk


def write_trc(path, frames, names):
    """Markers that move slowly, at 100 Hz."""
    with path.open("w", encoding="ascii") as file:
        file.write(f"PathFileType\t4\t(X/Y/Z)\t{path.name}\n")
        file.write("DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n")
        file.write(f"100\t100\t{frames}\t{len(names)}\tmm\t100\t1\t{frames}\n")
        file.write("Frame#\tTime\t" + "\t\t\t".join(names) + "\n\t\tX1\tY1\tZ1\n\n")
        for f in range(frames):
            cells = [f"{100 + f % 997 + m % 89}.25\t{200 + m % 800}.5\t{f % 7}.125" for m in range(len(names))]
            file.write(f"{f + 1}\t{f / 100:.2f}\t" + "\t".join(cells) + "\n")


def write_csv(path, frames, names):
    with path.open("w", encoding="ascii") as file:
        file.write("frame,time_s,marker,x_m,y_m,z_m\n")
        for f in range(frames):
            file.write("".join(f"{f + 1},{f / 100},{name},0.{f % 997:03},1.5,{m % 9}\n" for m, name in enumerate(names)))


def write_mot(path, frames, names):
    with path.open("w", encoding="ascii") as file:
        file.write(f"m\nversion=1\nnRows={frames}\nnColumns={len(names) + 1}\ninDegrees=yes\nendheader\n")
        file.write("time\t" + "\t".join(names) + "\n")
        for f in range(frames):
            file.write(f"{f / 100:.2f}\t" + "\t".join(f"{f % 97 + m % 13}.0625" for m in range(len(names))) + "\n")


WRITERS = {".trc": write_trc, ".csv": write_csv, ".mot": write_mot}


def check(bound_mb, what, paths, statuses):
    """One row: the most that any of the files takes. The files are removed."""
    worst_mb, worst, odd = 0.0, "", []
    for path in paths:
        status, taken_mb = peak_mb("info", "--json", path)
        if status not in statuses:
            odd.append(f"{path.name} ends with {status}")
        if taken_mb > worst_mb:
            worst_mb, worst = taken_mb, path.name
        path.unlink()
    good = worst_mb <= bound_mb and not odd
    print(f"{'PASS' if good else 'FAIL'} | {what} | <= {bound_mb} MB | {worst_mb:.0f} MB ({worst}) {'; '.join(odd)}", flush=True)
    return good


def recordings(folder, frames, names, endings):
    for ending in endings:
        path = folder / f"r{ending}"
        if ending == ".c3d":
            write_trc(folder / "from.trc", frames, names)
            made = subprocess.run([PROGRAM, "convert", folder / "from.trc", path, "--quiet"], check=False)
            (folder / "from.trc").unlink()
            assert made.returncode == 0
        else:
            WRITERS[ending](path, frames, names)
        yield path


def huge_zeros(folder):
    for ending in ("trc", "csv", "mot", "c3d", "osim", "mcap"):
        path = folder / f"zeros.{ending}"
        zeros(path, 4 << 30)
        yield path


def open_tags(folder):
    path = folder / "tags.osim"
    with path.open("wb") as file:  # in pieces: what this script takes counts for its children, too
        for _ in range(20_000):
            file.write(b"<a>" * 1000)
    yield path


def long_lines(folder):
    names = [f"M{i}" for i in range(1500)]
    assert sum(map(len, names)) + 3 * len(names) > 10_000
    line = folder / "names.trc"
    write_trc(line, 3, names)
    yield line
    cell = folder / "cell.csv"
    cell.write_text("frame,time_s,marker,x_m,y_m,z_m\n" + "\n".join(f"{f},{f / 100},{'M' * 100_000},1,2,3" for f in (1, 2, 3)) + "\n")
    yield cell
    wide = folder / "wide.mot"
    write_mot(wide, 3, [f"c{i}" for i in range(15_000)])
    yield wide


def main(arguments):
    tenth = 10 if "--quick" in arguments else 1
    frames, markers = 1_000_000 // tenth, 10_000 // tenth
    few, many = [f"M{m}" for m in range(FEW_MARKERS)], [f"M{m}" for m in range(markers)]
    with tempfile.TemporaryDirectory(dir=SCRATCH) as name:
        folder = Path(name)
        good = [
            check(100, "4 GB of zeros in any format", huge_zeros(folder), {3}),
            check(200, "60 MB of <a>", open_tags(folder), {3}),
            check(50, "lines of 100 kB", long_lines(folder), {0}),
            check(700, f"{frames} frames of {FEW_MARKERS} markers", recordings(folder, frames, few, (".trc", ".csv", ".mot", ".c3d")), {0}),
            check(1000, f"{markers} markers in {FEW_FRAMES} frames", recordings(folder, FEW_FRAMES, many, (".trc", ".csv", ".mot", ".c3d")), {0}),
        ]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
