#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Numbers of a file that contradict each other, planted in real and simulated recordings: what `validate`, and the verb that would
use them, say of each; and that nothing of the kind is said of the recordings as they are.

    tests/acceptance/second_facts.py [--quick] [--only NAME]... [--keep FOLDER]

Each fault is planted 60 times (3 times with --quick), in different recordings, at different positions, of different size. The clean side is
every recording of the test data that the program reads. Files are changed here, by the rules of their formats; nothing of kinemark is
used but the program. Needs KINEMARK_PROGRAM and KINEMARK_TEST_DATA. Prints rows "PASS|FAIL|SKIP | check | asked | measured"; exit
status 1 when one fails.
"""

import argparse
import collections
import json
import math
import os
import random
import re
import struct
import sys
import tempfile
from pathlib import Path

from rows import run

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA") or ROOT.parent / "shared" / "data")
ENDINGS = {".c3d", ".trc", ".mot", ".sto", ".osim", ".csv", ".tsv"}
PLANTED, QUICK = 60, 3
LEAST_FOUND, MOST_FALSE = 0.95, 0.01
LABELLED = """btk-others/FunctionalWalk.c3d btk-others/PiG_Motion3_FF.c3d c3d-parser-clinics/MH0222_BP15.c3d c3d-parser-clinics/QCMAS.dynamic.c3d
c3d-parser-clinics/RBWH_bfnd_w1.c3d c3d-parser-clinics/S4-AMGait03.c3d""".split()  # they state the mass of the body, too
STEPPED = [*LABELLED, "ezc3d-testFiles/Qualisys.c3d", "btk-others/ADemo1_rewrite_c3d_pc_float.c3d", "opensim-core-formats/walking2.c3d"]
WALKS = [*STEPPED, "opensim-gait2354/subject01_walk1.trc", "opensim-hamner-fullbody/subject02_running.trc", "bmc-rajagopal-run/ExpData/motion_capture_run.trc",
         "nimble-arnold-synthetic/subject01/trials/walk2/markers.trc"]  # fmt: skip
MOTIONS = """opensim-gait2354/subject01_walk1_ik.mot opensim-hamner-fullbody/subject02_running_ik.mot bmc-rajagopal-run/IK/results/ik_output_run.mot
opensim-core-ik/std_subject1_abdbonepin_IK.mot""".split()
MODELS = sorted(p.relative_to(DATA).as_posix() for p in DATA.rglob("*.osim")) if DATA.is_dir() else []
FAULTS = []
Fault = collections.namedtuple("Fault", "name says commands known function clean status")


VALIDATE = ("validate", "FILE")
CONVERT = ("convert", "FILE", "OUT.trc", "--force")
MEASURE = ("measure", "FILE", "--measures", "path_length", "--refits", "0")
HANDED_ON = (VALIDATE, ("info", "FILE"), CONVERT, MEASURE)  # what a body contradicts touches all that is made of its markers
FORCES = ("convert", "FILE", "OUT.mot", "--force")
DOES_NOT_END_GOOD = ("validate", "convert", "measure", "emg", "dynamics")  # `info` describes, and ends with 0


def fault(says, *commands, known=None, clean=None, status=True):
    """A fault: a function (folder, draw) that writes a file and returns it; `says` is what must be said of it, by `validate FILE` or
    the commands, in which FILE stands for it and OUT.* for a file to write; they must not end with 0, unless `status` is false (a
    note). `known(path)`: whether a recording as it is has this fault, by a look of our own. `clean`: commands whose words on good
    files count as those of `validate` do on recordings."""

    def register(function):
        FAULTS.append(
            Fault(function.__name__.replace("_", " "), re.compile(says), commands or (VALIDATE,), known or (lambda _: False), function, clean or [], status)
        )
        return function

    return register


def header_events(path):
    """(time in s, label) of the events in the header of a C3D file; none of another file."""
    data = path.read_bytes()[:1024]
    if path.suffix.lower() != ".c3d" or len(data) < 1024:
        return []
    processor = path.read_bytes()[512 * (data[0] - 1) + 3]
    order = ">" if processor == 86 else "<"
    (count,) = struct.unpack_from(order + "h", data, 300)
    out = []
    for i in range(max(0, min(18, count))):
        raw = data[304 + 4 * i : 308 + 4 * i]
        if processor == 85:  # of DEC: words exchanged, four times as large
            time = struct.unpack("<f", raw[2:] + raw[:2])[0] / 4.0
        else:
            (time,) = struct.unpack(order + "f", raw)
        out.append((time, data[396 + 4 * i : 400 + 4 * i].decode("latin-1").strip().upper()))
    return sorted(out)


def strikes_without_an_off(path):
    """Whether a foot strikes twice in a row among the events of the header, though offs are labelled."""
    events = [(label[0], label[1:] in ("HS", "FS", "IC")) for _, label in header_events(path) if label[:1] in ("L", "R")]
    if all(strike for _, strike in events):
        return False
    return any(a == b for side in "LR" for of_side in [[s for n, s in events if n == side]] for a, b in zip(of_side, of_side[1:]))


def eigenvalues(xx, yy, zz, xy, xz, yz):
    """Of a symmetric matrix, rising (Smith 1961, Comm. ACM 4:168)."""
    mean, off = (xx + yy + zz) / 3.0, xy * xy + xz * xz + yz * yz
    p = math.sqrt(((xx - mean) ** 2 + (yy - mean) ** 2 + (zz - mean) ** 2 + 2.0 * off) / 6.0)
    if p == 0.0:
        return mean, mean, mean
    a, b, c, d, e, f = (xx - mean) / p, (yy - mean) / p, (zz - mean) / p, xy / p, xz / p, yz / p
    half = (a * (b * c - f * f) - d * (d * c - f * e) + e * (d * f - b * e)) / 2.0
    angle = math.acos(max(-1.0, min(1.0, half))) / 3.0
    large, small = mean + 2.0 * p * math.cos(angle), mean + 2.0 * p * math.cos(angle + 2.0 * math.pi / 3.0)
    return small, 3.0 * mean - large - small, large


def inertia_of_no_body(path):
    """Whether a body of an .osim has a moment of inertia below zero, or one above the sum of the others."""
    if path.suffix.lower() != ".osim":
        return False
    for body in re.findall(r"<Body name=.*?</Body>", path.read_text(errors="replace"), re.S):
        if found := re.search(r"<inertia>(.*?)</inertia>", body, re.S):
            xx, yy, zz, xy, xz, yz = (float(v) for v in found[1].split())
        else:
            parts = [re.search(rf"<inertia_{n}>(.*?)</inertia_{n}>", body) for n in ("xx", "yy", "zz", "xy", "xz", "yz")]
            if not all(parts):
                continue
            xx, yy, zz, xy, xz, yz = (float(p[1]) for p in parts)
        small, middle, large = eigenvalues(xx, yy, zz, xy, xz, yz)
        if small < 0.0 or large > (small + middle) * 1.001:
            return True
    return False


# --- recordings as tables of text ---


class Trc:
    """A recording as `convert` writes it: names, and rows of numbers in the file's unit."""

    def __init__(self, source):
        self.lines = source.read_text().splitlines()
        self.head = self.lines[:5]
        self.rows = [line.split("\t") for line in self.lines[5:] if line.strip()]
        self.names = [n for n in self.head[3].split("\t")[2:] if n]

    def change(self, function):
        """function(frame, name, [x, y, z]) gives the new place of each sample that is there."""
        for f, row in enumerate(self.rows):
            for m, name in enumerate(self.names):
                part = row[2 + 3 * m : 5 + 3 * m]
                if len(part) == 3 and all(v.strip() for v in part):
                    row[2 + 3 * m : 5 + 3 * m] = [f"{v:.9g}" for v in function(f, name, [float(v) for v in part])]
        return self

    def rename(self, new):
        """new: {name: other name}."""
        cells = self.head[3].split("\t")
        self.head[3] = "\t".join(new.get(c, c) for c in cells)
        return self

    def write(self, path):
        path.write_text("\n".join([*self.head, *("\t".join(row) for row in self.rows)]) + "\n")
        return path


class Tables:
    """TRC copies of recordings, each made once."""

    def __init__(self, folder):
        self.folder, self.made = folder, {}

    def of(self, name):
        if name not in self.made:
            out = self.folder / (re.sub(r"\W", "_", name) + ".trc")
            run("convert", DATA / name, out, "--force", "--edits", "none")
            self.made[name] = out
        return Trc(self.made[name])


TABLES = None
PAIRS = [("L", "R"), ("LEFT", "RIGHT"), ("LFT", "RGT")]


def other_side(name):
    """The name of the same marker on the other side; the name itself of one that has no side."""
    prefix, colon, bare = name.rpartition(":")
    for left, right in PAIRS:
        for a, b in ((left, right), (right, left)):
            for c, d in ((a, b), (a.lower(), b.lower()), (a.title(), b.title())):
                if bare.startswith(c) and len(bare) > len(c) and not (len(c) == 1 and bare[1:2].islower()):
                    return prefix + colon + d + bare[len(c) :]
    return name


def sides(names):
    """Pairs (left, right) of which both are there."""
    return [(n, other_side(n)) for n in names if other_side(n) != n and other_side(n) in names and n < other_side(n)]


def walk(draw):
    return TABLES.of(WALKS[draw.randrange(len(WALKS))])


# --- markers ---


@fault("mirror", *HANDED_ON)
def an_axis_is_mirrored(folder, draw):
    axis = draw.randrange(3)
    return walk(draw).change(lambda _, __, x: [-v if a == axis else v for a, v in enumerate(x)]).write(folder / "walk.trc")


@fault("mirror|sides", *HANDED_ON)
def all_sides_are_exchanged(folder, draw):
    trc = walk(draw)
    while not sides(trc.names):
        trc = walk(draw)
    new = {a: b for pair in sides(trc.names) for a, b in (pair, pair[::-1])}
    return trc.rename(new).write(folder / "walk.trc")


@fault("unit of length is another one|another unit|unit of the whole", *HANDED_ON)
def the_unit_is_another_one(folder, draw):
    factor = draw.choice([0.001, 0.1, 10.0, 1000.0, 25.4, 1 / 25.4])
    return walk(draw).change(lambda _, __, x: [factor * v for v in x]).write(folder / "walk.trc")


@fault("all at one point", *HANDED_ON[:1])
def all_markers_at_one_point(folder, draw):
    trc = walk(draw)
    off = [draw.uniform(-500, 500) for _ in range(3)]
    moving = draw.random() < 0.5
    return trc.change(lambda f, _, x: [v + (0.5 * f if moving else 0.0) for v in off]).write(folder / "walk.trc")


@fault("where no marker can be")
def values_that_overflow(folder, draw):
    trc = walk(draw)
    name, size, first = draw.choice(trc.names), draw.choice([1e12, 1e20, 1e30, 3e38]), draw.randrange(len(trc.rows) // 2)
    return trc.change(lambda f, n, x: [size] * 3 if n == name and first <= f < first + 20 else x).write(folder / "walk.trc")


LEGS = re.compile(r"(ASI|PSI|KNE|ANK|HEE|TOE|Knee|Ankle|Heel|Toe|ASIS|PSIS|ASIs|MT)", re.IGNORECASE)


@fault(r"are exchanged(?! in (\d+ frames|frame))", *HANDED_ON)
def two_markers_of_the_legs_exchanged_left_for_right(folder, draw):
    some = []
    while not some:
        trc = walk(draw)
        some = [p for p in sides(trc.names) if LEGS.search(p[0])]
    a, b = draw.choice(some)
    return trc.rename({a: b, b: a}).write(folder / "walk.trc")


@fault(r"are exchanged(?! in (\d+ frames|frame))")
def heel_and_toe_exchanged(folder, draw):
    for _ in range(100):
        trc = walk(draw)
        heels = [n for n in trc.names if re.search(r"HEE|Heel|CAL|HEEL", n)]
        toes = [n for n in trc.names if re.search(r"TOE|Toe|MT|TOE", n)]
        some = [(h, t) for h in heels for t in toes if h[:1] == t[:1]]
        if some:
            break
    a, b = draw.choice(some)
    return trc.rename({a: b, b: a}).write(folder / "walk.trc")


@fault("leaves its path", ("measure", "FILE", "--refits", "0"), status=False)
def one_frame_flickers(folder, draw):
    trc = walk(draw)
    unit = 1.0 if "\tmm\t" in trc.head[2] else 0.001
    name, size = draw.choice([n for n in trc.names if LEGS.search(n)] or trc.names), unit * draw.uniform(15, 60)
    at = draw.randrange(8, len(trc.rows) - 8)
    way = [draw.gauss(0, 1) for _ in range(3)]
    length = math.hypot(*way)
    return trc.change(lambda f, n, x: [v + size * w / length for v, w in zip(x, way)] if n == name and f == at else x).write(folder / "walk.trc")


# --- C3D: parameters changed in place ---


class C3d:
    """Bytes of a file of Intel numbers, and where its parameters stand."""

    def __init__(self, source):
        self.data = bytearray(source.read_bytes())
        at = 512 * (self.data[0] - 1) + 4
        groups, found = {}, []
        while True:
            length, of = struct.unpack_from("<bb", self.data, at)
            length = abs(length)
            if not length:
                break
            name = self.data[at + 2 : at + 2 + length].decode("latin-1").upper()
            (after,) = struct.unpack_from("<h", self.data, at + 2 + length)
            if of < 0:
                groups[-of] = name
            else:
                found.append((of, name, at + 4 + length))
            if not after:
                break
            at += 2 + length + after
        self.positions = {(groups.get(of, ""), name): place for of, name, place in found}

    def where(self, group, name):
        """(struct format, place of the first number)."""
        place = self.positions[group, name]
        kind, count = struct.unpack_from("<bB", self.data, place)
        sizes = self.data[place + 2 : place + 2 + count]
        letter = {-1: "c", 1: "b", 2: "h", 4: "f"}[kind]
        return f"<{math.prod(sizes)}{letter}" if kind > 0 else f"<{math.prod(sizes)}s", place + 2 + count, list(sizes)

    def get(self, group, name):
        form, at, _ = self.where(group, name)
        return list(struct.unpack_from(form, self.data, at))

    def put(self, group, name, values):
        form, at, _ = self.where(group, name)
        struct.pack_into(form, self.data, at, *values)

    def texts(self, group, name):
        form, at, sizes = self.where(group, name)
        raw = struct.unpack_from(form, self.data, at)[0]
        return [raw[i : i + sizes[0]] for i in range(0, len(raw), sizes[0])]

    def put_texts(self, group, name, texts):
        form, at, sizes = self.where(group, name)
        struct.pack_into(form, self.data, at, b"".join(t.ljust(sizes[0])[: sizes[0]] for t in texts))

    def write(self, path):
        path.write_bytes(self.data)
        return path


class Events:
    """The events of a C3D file; as many or fewer are put back."""

    def __init__(self, source):
        self.file = C3d(source)
        times = self.file.get("EVENT", "TIMES")
        count = self.file.get("EVENT", "USED")[0]
        self.items = [[60.0 * times[2 * i] + times[2 * i + 1], s, k] for i, (s, k) in enumerate(zip(self.file.texts("EVENT", "CONTEXTS"), self.file.texts("EVENT", "LABELS")))]
        self.items = self.items[:count]

    def of_feet(self):
        return [e for e in self.items if e[1].strip().lower() in (b"left", b"right") and (b"Strike" in e[2] or b"Off" in e[2])]

    def within(self):
        """Those of a foot between the first and the last of the same foot."""
        inner = []
        for side in (b"left", b"right"):
            of_side = sorted((e for e in self.of_feet() if e[1].strip().lower() == side), key=lambda e: e[0])
            inner += of_side[1:-1]
        return inner

    def write(self, path):
        room = len(self.file.texts("EVENT", "LABELS"))
        padded = self.items + [self.items[-1]] * (room - len(self.items))
        self.file.put("EVENT", "TIMES", [v for e in padded for v in (0.0, e[0])])
        self.file.put_texts("EVENT", "CONTEXTS", [e[1] for e in padded])
        self.file.put_texts("EVENT", "LABELS", [e[2] for e in padded])
        self.file.put("EVENT", "USED", [len(self.items)])
        return self.file.write(path)


def turned_side(event):
    event[1] = b"Right" if event[1].strip().lower() == b"left" else b"Left"


def labelled(draw):
    return Events(DATA / draw.choice(LABELLED))


EVENTS = "event|strikes|offs"


@fault("left and right of the file's events are exchanged")
def sides_of_all_events_exchanged(folder, draw):
    events = labelled(draw)
    for event in events.of_feet():
        turned_side(event)
    return events.write(folder / "walk.c3d")


@fault("strikes and offs of the file's events are exchanged")
def strikes_and_offs_exchanged(folder, draw):
    events = labelled(draw)
    for event in events.of_feet():
        event[2] = b"Foot Off" if b"Strike" in event[2] else b"Foot Strike"
    return events.write(folder / "walk.c3d")


@fault("run on another clock")
def events_of_another_clock(folder, draw):
    events = labelled(draw)
    shift = draw.choice([-1, 1]) * draw.uniform(0.2, 0.4)
    for event in events.items:
        event[0] += shift
    return events.write(folder / "walk.c3d")


@fault("is labelled between", known=strikes_without_an_off)
def an_event_is_missing(folder, draw):
    while not (inner := (events := labelled(draw)).within()):
        pass
    events.items.remove(draw.choice(inner))
    return events.write(folder / "walk.c3d")


@fault("follows another of its kind|is labelled between|that of the markers", known=strikes_without_an_off)
def an_event_stands_twice(folder, draw):
    """In place of one of the other foot at an end, so that the file keeps its size."""
    events = labelled(draw)
    event = draw.choice(events.of_feet())
    others = [e for e in events.of_feet() if e[1].strip().lower() != event[1].strip().lower()]
    events.items.remove(max(others, key=lambda e: e[0]))
    events.items.append([event[0] + draw.choice([-1, 1]) * draw.uniform(0.03, 0.25), event[1], event[2]])
    return events.write(folder / "walk.c3d")


@fault("follows another of its kind|is labelled between|of the other foot", known=strikes_without_an_off)
def an_event_of_the_other_side(folder, draw):
    events = labelled(draw)
    turned_side(draw.choice(events.of_feet()))
    return events.write(folder / "walk.c3d")


# --- force plates ---


def scaled_channels(file, factor, of):
    """Factor on the scales of the channels of all plates that `of` (0 to 5: forces, then moments) chooses."""
    _, _, sizes = file.where("FORCE_PLATFORM", "CHANNEL")
    channels, scales = file.get("FORCE_PLATFORM", "CHANNEL"), file.get("ANALOG", "SCALE")
    for i, channel in enumerate(channels):
        if i % sizes[0] in of and channel > 0:
            scales[channel - 1] *= factor
    file.put("ANALOG", "SCALE", scales)


@fault("the centre of pressure leaves", VALIDATE, FORCES)
def moments_too_large_for_their_plate(folder, draw):
    file = C3d(DATA / draw.choice(LABELLED))
    scaled_channels(file, draw.uniform(3, 30), (3, 4))
    return file.write(folder / "walk.c3d")


@fault("times the mass of the body", VALIDATE, FORCES)
def forces_against_the_mass_of_the_body(folder, draw):
    file = C3d(DATA / draw.choice(LABELLED))
    scaled_channels(file, draw.choice([draw.uniform(2.2, 10), draw.uniform(0.1, 0.45)]), range(6))
    return file.write(folder / "walk.c3d")


@fault("stores the force of the body on the plate")
def forces_of_the_other_sign(folder, draw):
    file = C3d(DATA / draw.choice(LABELLED))
    scaled_channels(file, -1.0, range(6))
    return file.write(folder / "walk.c3d")


@fault("no foot stands", VALIDATE, FORCES)
def plates_where_nobody_steps(folder, draw):
    file = C3d(DATA / draw.choice(LABELLED))
    corners = file.get("FORCE_PLATFORM", "CORNERS")
    axis, way = draw.randrange(2), draw.choice([-1, 1]) * draw.uniform(700, 3000)
    file.put("FORCE_PLATFORM", "CORNERS", [v + way if i % 3 == axis else v for i, v in enumerate(corners)])
    return file.write(folder / "walk.c3d")


# --- angles and deviations ---


def table(path):
    lines = path.read_text().splitlines()
    head = next(i for i, line in enumerate(lines) if line.strip().lower() == "endheader")
    return lines[: head + 1], lines[head + 1].split(), [[float(v) for v in line.split()] for line in lines[head + 2 :] if line.strip()]


def write_table(path, head, names, rows):
    path.write_text("\n".join([*head, "\t".join(names), *("\t".join(f"{v:.9g}" for v in row) for row in rows)]) + "\n")
    return path


def turning(names):
    return [i for i, n in enumerate(names) if n != "time" and not re.search(r"_t[xyz]$|_[xyz]$", n)]


@fault("inDegrees=no, but")
def degrees_called_radians(folder, draw):
    head, names, rows = table(DATA / draw.choice(MOTIONS))
    head = [line for line in head if "indegrees" not in line.lower()]
    head.insert(-1, "inDegrees=no")
    first = draw.randrange(len(rows) // 2)
    return write_table(folder / "motion.mot", head, names, rows[first:])


@fault("no joint does", VALIDATE, ("convert", "FILE", "OUT.sto", "--force"))
def a_coordinate_that_turns_and_turns(folder, draw):
    head, names, rows = table(DATA / draw.choice(MOTIONS))
    column, first, size = draw.choice(turning(names)), draw.randrange(len(rows) // 2), draw.choice([-1, 1]) * draw.uniform(800, 5000)
    for f, row in enumerate(rows):
        row[column] += size * max(0, f - first) / (len(rows) - first)
    return write_table(folder / "motion.mot", head, names, rows)


def solved(folder, draw):
    """A small result of our own: motion, deviations, errors."""
    run("simulate", "subject", "-o", folder, "--seed", draw.randrange(1, 6), "--force", "--duration", 0.3)
    run("ik", "-m", folder / "model.osim", "-t", folder / "markers.trc", "-o", folder / "q.mot", "--force")
    return folder / "q.mot"


@fault("negative standard deviation")
def negative_deviations(folder, draw):
    solved(folder, draw)
    path = folder / "q_sd.sto"
    head, names, rows = table(path)
    column, row = draw.randrange(1, len(names)), draw.randrange(len(rows))
    rows[row][column] = -abs(rows[row][column] or 0.1)
    return write_table(folder / "deviations_sd.sto", [line for line in head if "kinemark" not in line], names, rows)


@fault("content is not what was written")
def a_companion_that_was_changed(folder, draw):
    motion = solved(folder, draw)
    other = draw.choice([p for p in folder.glob("q*") if p != motion and p.suffix in (".sto", ".json")])
    text = other.read_text()
    digits = [m.start() for m in re.finditer(r"\d(?=\d*\.\d)", text)]
    at = draw.choice(digits[len(digits) // 2 :])
    other.write_text(text[:at] + str((int(text[at]) + 1 + draw.randrange(8)) % 10) + text[at + 1 :])
    return motion


# --- angles against a model ---

OF_MODELS = [
    ("opensim-gait2354/subject01_walk1_ik.mot", "opensim-gait2354/subject01_simbody.osim"),
    ("opensim-hamner-fullbody/subject02_running_ik.mot", "opensim-hamner-fullbody/subject02_registered.osim"),
    ("bmc-rajagopal-run/IK/results/ik_output_run.mot", "bmc-rajagopal-run/Scale/Rajagopal2015_scaled.osim"),
    ("bmc-rajagopal-run/IK/results/ik_output_run.mot", "models-upper-and-full-body/Rajagopal2016.osim"),
    ("opensim-core-ik/std_subject1_abdbonepin_IK.mot", "opensim-core-ik/subject1_abdbonepin.osim"),
    ("opensim-arm26/arm26_InverseKinematics.mot", "opensim-arm26/arm26.osim"),
    ("nimble-arnold-synthetic/subject01/coordinates.sto", "nimble-arnold-synthetic/subject01/subject01.osim"),
]
JOINT_ANGLES = re.compile(r"(knee_angle|hip_flexion|hip_adduction|elbow_flex|ankle_angle|lumbar_extension)(_[rl])?$")


def ranges_of(path):
    """{coordinate: (least, most) in degrees} of a model."""
    out = {}
    for name, inside in re.findall(r'<Coordinate name="([^"]+)">(.*?)</Coordinate>', path.read_text(errors="replace"), re.S):
        if found := re.search(r"<range>\s*(\S+)\s+(\S+)\s*</range>", inside):
            out[name] = tuple(math.degrees(float(v)) for v in found.groups())
    return out


@fault("its range in the model", clean=[("dynamics", DATA / m, "--model", DATA / o, "--refits", "0") for m, o in OF_MODELS], status=False)
def a_joint_beyond_its_range(folder, draw):
    """By 15 to 60 deg, in a fifth of the rows or more."""
    motion, model = draw.choice(OF_MODELS[:4])
    head, names, rows = table(DATA / motion)
    ranges = ranges_of(DATA / model)
    column = draw.choice([i for i, n in enumerate(names) if JOINT_ANGLES.match(n) and n in ranges])
    least, most = ranges[names[column]]
    first, excess, above = draw.randrange(len(rows) // 2), draw.uniform(15, 60), draw.random() < 0.5
    for row in rows[first : first + len(rows) // 4 + 1]:
        row[column] = most + excess if above else least - excess
    path = write_table(folder / "motion.mot", head, names, rows)
    beside = [str(path), "--model", str(DATA / model)]
    (folder / "commands").write_text("\n".join(json.dumps(words) for words in (["dynamics", *beside, "--refits", "0"], ["validate", *beside])))
    return path


# --- models ---


def model(draw):
    text = ""
    while not heavy_bodies(text):
        text = (DATA / draw.choice(MODELS)).read_text(errors="replace")
    return text


def heavy_bodies(text):
    """Spans of the bodies that weigh something."""
    spans = [m.span() for m in re.finditer(r"<Body name=.*?</Body>", text, re.S)]
    return [s for s in spans if (mass := re.search(r"<mass>\s*([-\d.eE+]+)", text[s[0] : s[1]])) and float(mass[1]) > 3.0]


def in_a_body(text, draw, pattern, new):
    spans = heavy_bodies(text)
    a, b = draw.choice(spans)
    body = re.sub(pattern, new, text[a:b], count=1, flags=re.S)
    return text[:a] + body + text[b:]


def written(path, text):
    path.write_text(text)
    return path


def joint_axes(text):
    """Spans of the first two axes of rotation of a joint that has two and more."""
    for joint in re.finditer(r"<CustomJoint name=.*?</CustomJoint>", text, re.S):
        found = list(re.finditer(r'<TransformAxis name="rotation[12]">(?:(?!</TransformAxis>).)*?<axis>\s*(.*?)\s*</axis>.*?</TransformAxis>', joint[0], re.S))
        moved_by = [c[1].strip() for m in found if (c := re.search(r"<coordinates>(.*?)</coordinates>", m[0]))]
        if len(found) == 2 and len(set(filter(None, moved_by))) == 2:  # one coordinate may turn about one axis twice
            yield [(joint.start() + m.start(1), joint.start() + m.end(1)) for m in found]


@fault("turns about one axis by two coordinates")
def two_axes_of_a_joint_parallel(folder, draw):
    spans = []
    while not spans:
        text = model(draw)
        spans = list(joint_axes(text))
    (a, b), (c, d) = draw.choice(spans)
    sign = draw.choice([1.0, -1.0])
    first = " ".join(f"{sign * float(v):g}" for v in text[a:b].split())
    return written(folder / "body.osim", text[:c] + first + text[d:])


@fault("a ball of water")
def masses_in_grams(folder, draw):
    text = re.sub(r"<mass>\s*([-\d.eE+]+)", lambda m: f"<mass>{1000 * float(m[1]):.9g}", model(draw))
    return written(folder / "body.osim", text)


@fault("has a mass of")
def a_mass_below_zero(folder, draw):
    text = in_a_body(model(draw), draw, r"<mass>\s*([\d.eE+-]+)", lambda m: f"<mass>-{m[1]}")
    return written(folder / "body.osim", text)


@fault("moment of inertia", known=inertia_of_no_body)
def an_inertia_that_no_body_has(folder, draw):
    path = folder / "body.osim"
    while not path.exists() or not inertia_of_no_body(path):  # of a slim body the largest moment may stay below the sum
        text, factor = model(draw), draw.uniform(3, 50)
        tag = "inertia" if "<inertia>" in text else "inertia_xx"
        written(path, in_a_body(text, draw, rf"<{tag}>\s*([\d.eE+-]+)", lambda m: f"<{tag}>{factor * float(m[1]):.9g}"))  # noqa: B023
    return path


@fault("mass centre")
def a_mass_centre_outside_of_the_body(folder, draw):
    away = draw.uniform(5, 300)
    text = in_a_body(model(draw), draw, r"<mass_center>.*?</mass_center>", f"<mass_center>{away:.3f} 0 0</mass_center>")
    return written(folder / "body.osim", text)


# --- electricity ---


@fault("no analog channel is known for an EMG", ("emg", "FILE", "--refits", "0"))
def voltages_of_a_plate_taken_for_muscles(folder, draw):
    """Muscles are known by parts of names: "Electric" holds the "tri" of a triceps."""
    file = C3d(DATA / draw.choice(["btk-others/FunctionalWalk.c3d", "btk-others/PiG_Motion3_FF.c3d", "ezc3d-testFiles/Qualisys.c3d"]))
    parts = ["Fx", "Fy", "Fz", "Mx", "My", "Mz"]
    draw.shuffle(parts)
    labels = iter(f"{draw.choice(['Electric Potential', 'Electric potential', 'Matrix', 'Voltage'])}.{parts[i % 6]}{i // 6 + 1}" for i in range(99))
    file.put_texts("ANALOG", "LABELS", [next(labels).encode() if t.startswith(b"EMG") else t for t in file.texts("ANALOG", "LABELS")])
    return file.write(folder / "walk.c3d")


class Channels:
    """The analog samples of a C3D file of Intel numbers, changed in place."""

    def __init__(self, source):
        self.file = C3d(source)
        data = self.file.data
        points, per_frame = struct.unpack_from("<hh", data, 2)
        first, last = struct.unpack_from("<HH", data, 6)
        (scale,) = struct.unpack_from("<f", data, 12)
        start, times = struct.unpack_from("<hh", data, 16)
        self.letter, self.width = ("f", 4) if scale < 0 else ("h", 2)
        count, begin, frame = per_frame // times, 512 * (start - 1), 4 * points * self.width + per_frame * self.width
        self.samples = [begin + f * frame + 4 * points * self.width + t * count * self.width for f in range(last - first + 1) for t in range(times)]
        self.labels = [t.decode("latin-1").strip() for t in self.file.texts("ANALOG", "LABELS")][:count]
        self.offsets = self.file.get("ANALOG", "OFFSET") if ("ANALOG", "OFFSET") in self.file.positions else [0] * count

    def change(self, channel, function):
        """function(sample number, what the sample is beside its offset)."""
        offset = self.offsets[channel]
        for k, place in enumerate(self.samples):
            at = place + channel * self.width
            (value,) = struct.unpack_from("<" + self.letter, self.file.data, at)
            new = offset + function(k, value - offset)
            struct.pack_into("<" + self.letter, self.file.data, at, new if self.letter == "f" else max(-32768, min(32767, round(new))))

    def muscles(self):
        return [c for c, label in enumerate(self.labels) if re.match(r"EMG\d+$|[LR] (Gast|Tib Ant|Med Ham|Rect|Gastroc)", label)]

    def write(self, path):
        return self.file.write(path)


OF_MUSCLES = ["btk-others/FunctionalWalk.c3d", "btk-others/PiG_Motion3_FF.c3d", "c3d-parser-clinics/QCMAS.dynamic.c3d", "c3d-parser-clinics/RBWH_bfnd_w1.c3d"]
EMG = ("emg", "FILE", "--refits", "0")


def a_muscle(draw):
    """(channels, index of one that holds a signal)."""
    while True:
        channels = Channels(DATA / draw.choice(OF_MUSCLES))
        channel = draw.choice(channels.muscles())
        seen = set()
        channels.change(channel, lambda _, v: seen.add(v) or v)  # noqa: B023
        if len(seen) > 50 and min(seen) < 0 < max(seen):
            return channels, channel


def holds_a_rectified_channel(path):
    """Whether a channel of many values goes to zero and never beyond."""
    channels = Channels(path)
    for channel in range(len(channels.labels)):
        values = []
        channels.change(channel, lambda _, v: values.append(v) or v)  # noqa: B023
        values.sort()
        if len(set(values)) > 20 and values[0] >= 0 and values[len(values) // 2] < values[-1] / 3:
            return True
    return False


@fault("holds no value (below|above) zero", VALIDATE, EMG, known=holds_a_rectified_channel)
def a_rectified_channel(folder, draw):
    channels, one = a_muscle(draw)
    sign, kept = draw.choice([1, -1]), draw.choice([0.0, 0.9, 0.98])  # as it is, or an envelope
    last = [0.0]

    def rectified(_, v):
        last[0] = kept * last[0] + (1 - kept) * abs(v)
        return sign * last[0]

    channels.change(one, rectified)
    return channels.write(folder / "walk.c3d")


@fault("% of the maximum", clean=[("emg", DATA / name, "--refits", "0", "--max", DATA / name) for name in OF_MUSCLES])
def a_maximum_that_is_none(folder, draw):
    channels, one = a_muscle(draw)
    name = channels.labels[one]
    whole = channels.write(folder / "walk.c3d")
    factor = draw.uniform(0.002, 0.05)
    weak = Channels(whole)
    weak.change(one, lambda _, v: factor * v)
    weak.write(folder / "weak.c3d")
    (folder / "commands").write_text(json.dumps(["emg", str(whole), "--channels", name, "--refits", "0", "--max", str(folder / "weak.c3d")]))
    return whole


@fault("holds no signal", EMG, known=lambda _: True, status=False)
def a_flat_channel(folder, draw):
    channels, one = a_muscle(draw)
    value = draw.choice([0.0, 17.0])
    channels.change(one, lambda *_: value)
    return channels.write(folder / "walk.c3d")


@fault("is clipped", EMG, known=lambda _: True, status=False)
def a_clipped_channel(folder, draw):
    channels, one = a_muscle(draw)
    values = []
    channels.change(one, lambda _, v: values.append(abs(v)) or v)
    limit = sorted(values)[round(len(values) * draw.uniform(0.95, 0.99))]
    channels.change(one, lambda _, v: max(-limit, min(limit, v)))
    return channels.write(folder / "walk.c3d")


# --- rates ---


def peaks(path, *more):
    """({measure: (value, low, high)}, whether a sample that leaves its path is said)."""
    done = run("measure", path, "--measures", "peak_speed,peak_acceleration", "--json", *more)
    measures = json.loads(done.stdout)["measures"] if done.stdout.startswith("{") else []
    values = {m["measure"]: (m["value"], m["interval"].get("low"), m["interval"].get("high")) for m in measures if m["value"] is not None}
    return values, "leaves its path" in done.stdout + done.stderr


def flickered(draw, positions, size):
    """One to five of a hundred frames lie off by `size`."""
    for f in draw.sample(range(5, len(positions) - 5), max(1, round(draw.uniform(0.01, 0.05) * len(positions)))):
        way = [draw.gauss(0, 1) for _ in range(3)]
        length = math.hypot(*way)
        positions[f] = [v + size * w / length for v, w in zip(positions[f], way)]
    return positions


def excludes(interval, truth):
    """Whether an interval excludes a number by more than a twentieth of that."""
    _, low, high = interval
    return (low is not None and low > 1.05 * truth) or (high is not None and high < 0.95 * truth)


def flicker_row(what, good, count):
    passed = good >= LEAST_FOUND * count
    print(f"{'PASS' if passed else 'FAIL'} | second_facts, flickers of 3 mm, peaks of {what} that are right or said | >= 95 % | {good} of {count}", flush=True)
    return passed


def flickers_in_simulated_paths(folder, count):
    """Reaches and ellipses under noise of 0.05 to 1 mm; the largest speed and acceleration are known."""
    good = 0
    for i in range(count):
        draw = random.Random(f"simulated flickers {i}")
        rate, noise, size = draw.choice([60, 100, 120, 200]), math.exp(draw.uniform(math.log(0.05), 0.0)), draw.uniform(80, 250)
        if draw.random() < 0.5:
            length, takes, begin = 2 * size, draw.uniform(0.5, 1.2), draw.uniform(0.4, 0.8)
            part = lambda t: min(1.0, max(0.0, (t - begin) / takes))  # noqa: B023, E731
            positions = [[length * (10 * u**3 - 15 * u**4 + 6 * u**5), 0.0, 900.0] for u in (part(f / rate) for f in range(3 * rate))]  # noqa: B023
            truth = {"peak_speed": 1.875 * length / takes, "peak_acceleration": 10 / math.sqrt(3) * length / takes**2}
        else:
            turns, other = 2 * math.pi * draw.uniform(0.4, 1.5), draw.uniform(0.3, 0.7) * size
            positions = [[size * math.sin(turns * f / rate), other * math.cos(turns * f / rate), 900.0] for f in range(4 * rate)]
            truth = {"peak_speed": size * turns, "peak_acceleration": size * turns**2}
        positions = flickered(draw, [[v + draw.gauss(0, noise) for v in place] for place in positions], 3.0)
        path = folder / f"flickers_{i}.trc"
        rows = ("\t".join([str(f + 1), f"{f / rate:.6f}", *(f"{v:.4f}" for v in place)]) for f, place in enumerate(positions))
        head = f"PathFileType\t4\t(X/Y/Z)\t{path.name}\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n{rate}\t{rate}\t{len(positions)}\t1\tmm\nFrame#\tTime\tHAND\t\t\n\t\tX1\tY1\tZ1\n\n"
        path.write_text(head + "\n".join(rows) + "\n")
        found, said = peaks(path)
        right = said or (len(found) == 2 and not any(excludes(found[id], truth[id]) for id in truth))
        good += right
        if not right:
            print(f"  flickers_{i}: {noise:.2f} mm at {rate} Hz: {found} for {truth}")
    return flicker_row("simulated paths", good, count)


def flickers_in_real_paths(folder, count):
    """Against the same path as it was recorded, of those whose peaks have an interval then: peaks may not become larger than that
    interval allows. Some paths hold flickers of their own, and are less once more are found."""
    good = 0
    for i in range(count):
        draw = random.Random(f"real flickers {i}")
        before = {}
        while len(before) < 2 or any(None in v for v in before.values()):
            trc = walk(draw)
            name = draw.choice(trc.names)
            path = trc.write(folder / f"real_{i}.trc")
            before, said = peaks(path, "--select", name)
        rows = [row for row in trc.rows if len(row) > 4 + 3 * trc.names.index(name) and row[2 + 3 * trc.names.index(name)].strip()]
        first = 2 + 3 * trc.names.index(name)
        unit = 1.0 if "\tmm\t" in trc.head[2] else 0.001
        for row, place in zip(rows, flickered(draw, [[float(v) for v in row[first : first + 3]] for row in rows], 3.0 * unit)):
            row[first : first + 3] = [f"{v:.9g}" for v in place]
        after, said = peaks(trc.write(path), "--select", name)
        right = said or (len(after) == 2 and not any(after[id][1] is not None and after[id][1] > 1.05 * before[id][2] for id in before))
        good += right
        if not right:
            print(f"  real_{i} {name}: {after} for {before}")
    return flicker_row("real paths", good, count)


def exchanged_from(trc, one, other, first):
    """The recording with two labels exchanged from a frame on."""
    a, b = (2 + 3 * trc.names.index(n) for n in (one, other))
    for row in trc.rows[first:]:
        row[a : a + 3], row[b : b + 3] = row[b : b + 3], row[a : a + 3]
    return trc


def samples_of(trc, name):
    first = 2 + 3 * trc.names.index(name)
    return [[float(v) for v in row[first : first + 3]] if len(row) > first + 2 and row[first].strip() else None for row in trc.rows]


def half_row(where, good, count):
    passed = good >= LEAST_FOUND * count
    print(f"{'PASS' if passed else 'FAIL'} | second_facts, labels exchanged from a frame on, {where} | >= 95 % | {good} of {count}", flush=True)
    return passed


def exchanges_from_a_frame_on(folder, count):
    """Two labels exchanged in the last 30 or 70 % of the frames, in real walks and simulated bodies: `clean` gives each marker its own
    samples back where the body tells, whichever half is the larger one; of names that no body has it says that it cannot tell."""
    good = blind = 0
    for i in range(count):
        draw = random.Random(f"exchanged from a frame on {i}")
        some = []
        while not some:
            if i % 3 == 2:
                run("simulate", "subject", "--duration", "4", "--seed", str(i), "--soft-tissue", "0.5", "--out", folder / f"subject_{i}")
                trc = Trc(folder / f"subject_{i}" / "markers.trc")
            else:
                trc = walk(draw)
            seen = {n for n in trc.names if None not in samples_of(trc, n)}
            before = run("validate", trc.write(folder / f"half_{i}.trc")).stderr  # some recordings hold exchanges of their own
            seen -= {n for pair in re.findall("arkers '([^']*)' and '([^']*)' are exchanged", before) for n in pair}
            some = [p for p in sides(trc.names) if LEGS.search(p[0]) and seen.issuperset(p) and "Center" not in p[0]]
        one, other = draw.choice(some)
        true = {n: samples_of(trc, n) for n in (one, other)}
        first = round((0.3 if i % 2 else 0.7) * len(trc.rows))
        path = exchanged_from(trc, one, other, first).write(folder / f"half_{i}.trc")
        done = run("clean", path, folder / f"half_{i}_clean.trc", "--filter", "none", "--force")
        after = Trc(folder / f"half_{i}_clean.trc")
        right = all(math.dist(a, b) < 0.01 * max(1.0, math.hypot(*a)) for n in true for a, b in zip(true[n], samples_of(after, n)) if b)
        good += right
        if not right:
            print(f"  half_{i}: {one}, {other} from {first} of {len(trc.rows)}: {' '.join(run('validate', path).stderr.split())[:300]} {done.stderr[:100]}")
        trc.rename({n: f"M{m}" for m, n in enumerate(trc.names)}).write(path)
        said = run("validate", path).stderr
        blind += "are exchanged in" in said and "as a body has markers of these names" not in said
    return all((half_row("real and simulated", good, count), half_row("of nobody's names, said to be open", blind, count)))


def planted(fault, count, folder):
    """(found, those that were not)."""
    found, missed = 0, []
    for i in range(count):
        here = folder / f"{fault.name.replace(' ', '_')}_{i}"
        here.mkdir()
        path = fault.function(here, random.Random(f"{fault.name} {i}"))
        own = here / "commands"  # a fault that needs another file beside its own says by which command
        commands = [json.loads(line) for line in own.read_text().splitlines()] if own.exists() else fault.commands
        for words in commands:
            done = run(*(str(path) if w == "FILE" else str(here / w.lower()) if w.startswith("OUT.") else w for w in words))
            text = done.stdout + done.stderr
            silent = fault.status and words[0] in DOES_NOT_END_GOOD and done.returncode == 0
            if fault.says.search(text.replace(str(here), "")) and not silent:
                continue
            missed.append(f"{here.name}: {words[0]}: exit {done.returncode}: {' '.join(text.replace(str(here), '').split())[:300]}")
            break
        else:
            found += 1
    return found, missed


def clean_texts():
    """{recording: what `validate` says of it} for all of the test data that can be read."""
    files = sorted(p for p in DATA.rglob("*") if p.suffix.lower() in ENDINGS)
    texts = {}
    for path in files:
        done = run("validate", path)
        if done.returncode in (0, 1):
            texts[path.relative_to(DATA).as_posix()] = done.stderr.replace(str(DATA), "")
    return texts


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--keep")
    parser.add_argument("--count", type=int)
    chosen = parser.parse_args()
    if not DATA.is_dir():
        print("SKIP | second_facts | - | no recordings", flush=True)
        return 0
    global TABLES
    folder = Path(chosen.keep or tempfile.mkdtemp(prefix="second_facts_"))
    (folder / "tables").mkdir(parents=True, exist_ok=True)
    TABLES = Tables(folder / "tables")
    texts = clean_texts()
    count = chosen.count or (QUICK if chosen.quick else PLANTED)
    failed = False
    for fault in FAULTS:
        if chosen.only and fault.name.replace(" ", "_") not in chosen.only:
            continue
        found, missed = planted(fault, count, folder)
        good = found >= LEAST_FOUND * count
        failed = failed or not good
        print(f"{'PASS' if good else 'FAIL'} | second_facts, {fault.name}, said | >= 95 % | {found} of {count}", flush=True)
        for line in missed:
            print(f"  {line}")
        more = {" ".join(map(str, words)): "".join((done := run(*words)).stdout + done.stderr) for words in fault.clean}
        all_of = {**texts, **more}
        of = [path for path, text in all_of.items() if fault.says.search(text) and not fault.known(DATA / path)]
        good = len(of) <= MOST_FALSE * len(all_of)
        failed = failed or not good
        print(f"{'PASS' if good else 'FAIL'} | second_facts, {fault.name}, said of recordings as they are | <= 1 % | {len(of)} of {len(all_of)}{': ' + ', '.join(of[:4]) if of else ''}", flush=True)
    for row in (flickers_in_simulated_paths, flickers_in_real_paths, exchanges_from_a_frame_on):
        if not chosen.only or row.__name__ in chosen.only:
            failed = not row(folder, count) or failed
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
