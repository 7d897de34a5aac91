#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""C3D files that kinemark writes, opened by the readers that people use, ezc3d (OpenSim's own) and py-c3d, and read by the rules of
the manual (c3d.org).

    tests/acceptance/c3d_readers.py [FOLDER TO KEEP THE FILES IN]

Forty recordings: real ones of every format, and simulated ones with and without gaps, analog channels, events, plates, spare
parameter groups, one marker and three hundred, names of 200 letters. Each is converted to C3D, and its positions are held against
those that `convert` writes as text, rounded to the single precision of the format. Needs Python with ezc3d, c3d and numpy,
KINEMARK_PROGRAM and KINEMARK_TEST_DATA. Prints rows "PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import csv
import math
import os
import struct
import sys
import tempfile
import warnings
from pathlib import Path

import numpy

from rows import run

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA") or ROOT.parent / "shared" / "data")
SAME_MM = 6e-5
REAL = """btk-others/Gait.c3d btk-others/PiG_Motion3_FF.c3d btk-others/PiG_Calibration3_FF.c3d btk-others/MyCube.c3d btk-others/FunctionalLHip.c3d
c3d-parser-clinics/MH0222_BP15.c3d c3d-parser-clinics/RBWH_bfnd_w1.c3d c3d-parser-clinics/S4-AMGait03.c3d c3d-parser-clinics/MH_Cal_01.c3d
cmu-mocap/85_02.c3d cmu-mocap/cmu_02_05.c3d ezc3d-testFiles/Optotrak.c3d kineticstoolkit/sample_propulsion.c3d kineticstoolkit/sample_static.c3d
kineticstoolkit/sample_probing_olecrane_R.c3d opensim-core-formats/walking2.c3d pycgm-rom/Sample_Static.c3d c3d-org/sample20/phasespace_sample.c3d
opensim-gait2354/subject01_static.trc opensim-gait2354/subject01_walk1.trc opensim-core-formats/std_walking2_markers.trc dfki-hand/recording.tsv""".split()


def simulated(folder):
    """Recordings made here: name and path."""
    plain = ["simulate", "subject", "--duration", "1", "--force"]
    variants = [("still", ["--noise", "0"]), ("noisy", ["--noise", "2"]), ("gaps", ["--dropout-random", "0.2"]), ("fast", ["--rate", "250"]),
                ("slow", ["--rate", "30"]), ("odd_rate", ["--rate", "69.93"])]  # fmt: skip
    for name, options in variants:
        yield name, made(folder, name, [*plain, *options]) / "markers.trc"
    yield "macaque", made(folder, "macaque", ["simulate", "macaque", "--duration", "1", "--force"]) / "markers.c3d"
    for name, count, letters in (("one_marker", 1, 4), ("many_markers", 300, 6), ("long_names", 12, 200), ("two_hundred_frames", 5, 8)):
        yield name, table(folder / f"{name}.csv", count, letters, frames=200)
    yield "two_frames", table(folder / "two_frames.csv", 3, 4, frames=2)
    yield "wide", table(folder / "wide.csv", 255, 6, frames=20)
    yield "wider", table(folder / "wider.csv", 256, 6, frames=20)
    yield "never_seen", table(folder / "never_seen.csv", 4, 4, frames=30, hidden=True)
    for name, size in (("far", 1e5), ("tiny", 1e-2), ("negative", -3e3), ("metres", 1e3)):
        yield name, table(folder / f"{name}.csv", 6, 5, frames=50, size_mm=size)


def made(folder, name, words):
    out = folder / name
    run(*words, "-o", out)
    return out


def table(path, markers, letters, frames, size_mm=1000.0, hidden=False):
    """A table of coordinates that swing, as people write them."""
    names = [f"{'N' * letters}"[: max(1, letters - len(str(m)))] + str(m) for m in range(markers)]
    lines = [",".join(["Time", *(f"{n}_{a} (mm)" for n in names for a in "XYZ")])]
    for f in range(frames):
        x = [size_mm * (0.5 + 0.4 * numpy.sin(0.1 * f + m + axis)) for m in range(markers) for axis in range(3)]
        cells = ["" if hidden and m // 3 == 2 else f"{v:.6f}" for m, v in enumerate(x)]
        lines.append(",".join([f"{f / 100:.3f}", *cells]))
    path.write_text("\n".join(lines) + "\n")
    return path


def truth_of(path, scratch):
    """(names, frames x markers x 3 in mm as single precision, NaN where missing) of the text that `convert` writes."""
    out = scratch / "truth.csv"
    done = run("convert", path, out, "--force", "--edits", "none")
    if done.returncode:
        raise ValueError(done.stderr.strip()[-160:])
    names, values = [], []
    with out.open(newline="") as file:
        for row in csv.DictReader(file):
            if not values or row["frame"] == values[0][0]:
                names.append(row["marker"])
            there = row["state"] not in ("missing", "rejected")
            values.append((row["frame"], [1e3 * float(row[a]) if there else numpy.nan for a in ("x_m", "y_m", "z_m")]))
    x = numpy.array([v for _, v in values]).reshape(-1, len(names), 3)
    return names, x.astype(numpy.float32)


def by_ezc3d(path, count):
    import ezc3d

    c = ezc3d.c3d(str(path))
    x = c["data"]["points"][:3, :count].transpose(2, 1, 0)
    point = c["parameters"]["POINT"]
    return [label for more in ("LABELS", "LABELS2") if more in point for label in point[more]["value"]][:count], x


def by_py_c3d(path, count):
    import c3d

    with warnings.catch_warnings(), path.open("rb") as file:
        warnings.simplefilter("error")  # what it warns of, people see as broken
        warnings.filterwarnings("ignore", "No (analog|point) data found")  # which is so
        reader = c3d.Reader(file)
        frames = [points[:count, :4] for _, points, _ in reader.read_frames()]
        labels = [label.strip() for label in reader.point_labels[:count]]
    x = numpy.array(frames)
    return labels, numpy.where(x[:, :, 3:4] < 0, numpy.nan, x[:, :, :3])


def by_the_manual(path, count):
    """The samples, read here by the rules of c3d.org; ValueError where two numbers that state one thing differ."""
    data = path.read_bytes()
    points, a_frame, first, last, _, _, start, per_frame = struct.unpack_from("<HHHHHfHH", data, 2)
    (rate,) = struct.unpack_from("<f", data, 20)
    stated = parameters_of(data)
    point, analog = stated["POINT"], stated.get("ANALOG", {})
    used, frames = point["USED"][0], int(point["LONG_FRAMES"][0] if "LONG_FRAMES" in point else point["FRAMES"][0] % 65536)
    channels = analog.get("USED", [0])[0]
    facts = [("points", points, used), ("first byte of samples", start, point["DATA_START"][0]), ("rate", numpy.float32(rate), numpy.float32(point["RATE"][0])),
             ("analog values a frame", a_frame, channels * per_frame), ("labels", min(used, 255), len(point["LABELS"])),
             ("analog rate", numpy.float32(analog.get("RATE", [0])[0]), numpy.float32(point["RATE"][0] * per_frame) if channels else numpy.float32(0)),
             ("analog labels", min(channels, 255), len(analog.get("LABELS", []))), ("plates", stated.get("FORCE_PLATFORM", {}).get("USED", [0])[0],
             len(stated.get("FORCE_PLATFORM", {}).get("TYPE", []))), ("scale", point["SCALE"][0] < 0, True)]  # fmt: skip
    if last - first + 1 != frames and frames <= 65535:
        facts.append(("frames", last - first + 1, frames))
    for what, one, other in facts:
        if one != other:
            raise ValueError(f"{what}: {one} and {other}")
    width = 4 * used + a_frame
    samples = numpy.frombuffer(data, "<f4", frames * width, 512 * (start - 1)).reshape(frames, width)
    if len(data) % 512:
        raise ValueError(f"{len(data)} bytes are no whole blocks")
    x = samples[:, : 4 * used].reshape(frames, used, 4)[:, :count]
    labels = [label.strip() for label in point["LABELS"] + point.get("LABELS2", [])]
    return labels[:count], numpy.where(x[:, :, 3:4] == -1, numpy.nan, x[:, :, :3])


def parameters_of(data):
    """{group: {parameter: numbers or texts}} of a file of Intel numbers."""
    at, names, found = 512 * (data[0] - 1) + 4, {}, []
    if data[at - 1] != 84:
        raise ValueError("no Intel numbers")
    while data[at]:
        (length,) = struct.unpack_from("<b", data, at)
        (group,) = struct.unpack_from("<b", data, at + 1)
        after = at + 2 + abs(length)
        (step,) = struct.unpack_from("<h", data, after)
        if group < 0:
            names[-group] = data[at + 2 : after].decode()
        else:
            found.append((group, data[at + 2 : after].decode(), after + 2))
        if step == 0:
            break
        at = after + step
    stated = {}
    for group, name, place in found:
        kind, sizes = struct.unpack_from("<bB", data, place)
        dims = list(data[place + 2 : place + 2 + sizes])
        place, count = place + 2 + sizes, math.prod(dims)
        if kind == -1:
            width = dims[0] if dims else 1
            values = [data[place + i : place + i + width].decode("utf-8", "replace") for i in range(0, count, width)] if width else []
        else:
            letter = {1: "B", 2: "H" if name in ("USED", "FRAMES", "DATA_START") else "h", 4: "f"}[kind]
            values = list(struct.unpack_from(f"<{count}{letter}", data, place))
        stated.setdefault(names[group], {})[name] = values
    return stated


READERS = {"ezc3d": by_ezc3d, "py-c3d": by_py_c3d, "the rules of the manual": by_the_manual}


def difference(names, x, read_names, read):
    """What keeps a reading from being the same; None where it is."""
    if read.shape != x.shape:
        return f"{read.shape[0]} frames x {read.shape[1]} markers for {x.shape[0]} x {x.shape[1]}"
    if len(read_names) == 255:
        names = names[:255]  # py-c3d knows no LABELS2
    if [n.strip() for n in read_names] != [n.strip() for n in names]:
        return f"other names: {next(f'{a} for {b}' for a, b in zip(read_names, names) if a.strip() != b.strip())[:80]}"
    seen = ~numpy.isnan(x[:, :, 0])
    most = float(numpy.max(numpy.abs(read[seen] - x[seen]), initial=0.0))
    return None if most <= SAME_MM else f"{most:.2g} mm apart"


def main():
    scratch = Path(sys.argv[1] if len(sys.argv) > 1 else tempfile.mkdtemp(prefix="c3d_readers_"))
    scratch.mkdir(parents=True, exist_ok=True)
    recordings = [(name, DATA / name) for name in REAL if (DATA / name).exists()]
    if len(recordings) < len(REAL):
        print(f"SKIP | real recordings for C3D readers | {len(REAL)} | {len(recordings)} are there", flush=True)
    recordings += simulated(scratch)
    wrong = {reader: [] for reader in READERS}
    for number, (name, path) in enumerate(recordings):
        written = scratch / f"written_{number}.c3d"
        done = run("convert", path, written, "--force", "--edits", "none")
        if done.returncode:
            for list_of in wrong.values():
                list_of.append(f"{name}: not written: {done.stderr.strip()[-100:]}")
            continue
        names, x = truth_of(path, scratch)
        for reader, read in READERS.items():
            try:
                why = difference(names, x, *read(written, len(names)))
            except Exception as error:  # any failure of a reader is what people see
                why = f"{type(error).__name__}: {error}"
            if why:
                wrong[reader].append(f"{name}: {why}")
    for reader, list_of in wrong.items():
        verdict = "FAIL" if list_of else "PASS"
        print(f"{verdict} | C3D of {len(recordings)} recordings opened by {reader} | all, positions within {SAME_MM:g} mm | "
              f"{len(recordings) - len(list_of)}{'; ' + '; '.join(list_of[:4])[:400] if list_of else ''}", flush=True)  # fmt: skip
    return 1 if any(wrong.values()) else 0


if __name__ == "__main__":
    sys.exit(main())
