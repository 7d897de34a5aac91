#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Files as strangers bring them, of the kinds of cases.py, with what is right known beforehand: tables under labels of every hand, texts
of other programs, arrays of MATLAB, C3D files whose plates lie oddly or that hold no markers. Each is read right, or refused with what to do.

    tests/acceptance/strangers.py [NAME...]

Nothing of kinemark is used but the program. Needs KINEMARK_PROGRAM; finds the cases beside KINEMARK_TEST_DATA. Prints rows
"PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import json
import math
import random
import struct
import sys

from cases import CASES, HERE, apart, cells, plain, positions, run, said, same, table, written
from made_files import c3d, doubles, element, mat, matrix, words

CHECKS = []


def stranger(asked):
    """A check: a function that returns (whether it is right, what was seen)."""

    def register(function):
        CHECKS.append((function.__name__.replace("_", "-"), asked, function))
        return function

    return register


def all_same(files, *options):
    """Whether each (name, text) is read as the plain file; the names of those that are not."""
    wrong = [(name, seen) for name, text in files for good, seen in [same(written(name, text), plain(), 1e-3, *options)] if not good]
    return not wrong, f"{len(files) - len(wrong)} of {len(files)} the same{': not ' + str(wrong[0]) if wrong else ''}"


def csv(label, axes="XYZ", first="time", before="", rows=None, scale=1.0):
    """A table of the plain samples; `label` is formatted with n, the marker, a and l, its axis in capital and small letters."""
    names, times, values = cells()
    order = ["XYZ".index(a) for a in axes]
    labels = [label.format(n=n, a=a, l=a.lower()) for n in names for a in axes]
    lines = [",".join([repr(float(t) * scale), *((rows or values)[f][3 * m + k] for m in range(len(names)) for k in order)]) for f, t in enumerate(times)]
    return before + ",".join([first, *labels]) + "\n" + "\n".join(lines) + "\n"


def trc(labels=None, times=None, rows=None, rate="100"):
    lines = plain().read_text().splitlines()
    head = lines[:5]
    head[2] = head[2].replace("100", rate)
    if labels:
        head[4] = "\t\t" + "\t".join(labels)
    body = [line.split("\t") for line in lines[5:] if line.strip()]
    for f, row in enumerate(body):
        if times:
            row[1] = times[f]
        if rows:
            row[2:] = rows[f]
    return "\n".join([*head, "", *("\t".join(row) for row in body)]) + "\n"


# --- texts ---


@stranger("each read as the plain file")
def labels_of_every_hand():
    styles = ("{n}_{a}", "{n}.{l}", "{n} {a}", "{n}({a})", "{n}[{a}]", "{l}_{n}", "{a} {n}", "{n}/{a}", "{n}|{l}", "{n}{a}", "{n}_pos_{l}",
              "{n}.position.{l}", "{n}_Pos{a}", "{n} - {a}", "{n}__{l}", "{n}_{a}_mm", "{n}_{l} (mm)")  # fmt: skip
    return all_same([(f"labels{i}.csv", csv(style)) for i, style in enumerate(styles)], "--unit", "mm")


@stranger("each axis where its label says")
def axes_in_any_order():
    names, times, values = cells()
    by_axis = ",".join(["time", *(f"{n}_{a}" for a in "XYZ" for n in names)]) + "\n"
    by_axis += "".join(",".join([t, *(row[3 * m + k] for k in range(3) for m in range(len(names)))]) + "\n" for t, row in zip(times, values))
    swapped = [[row[3 * m + k] for m in range(len(names)) for k in (0, 2, 1)] for row in values]
    good, seen = all_same([("xzy.csv", csv("{n}_{a}", "XZY")), ("by_axis.csv", by_axis)], "--unit", "mm")
    fine, found = all_same([("xzy.trc", trc([f"{a}{m + 1}" for m in range(len(names)) for a in "XZY"], rows=swapped))])
    return good and fine, f"{seen}; TRC {found}"


@stranger("titles, comments and lines of units or scorers passed over")
def lines_above_the_labels():
    names, times, values = cells()
    rows = "".join(f"{t},{','.join(row)}\n" for t, row in zip(times, values))
    three = ",".join(["", *(n for n in names for _ in "xyz")])
    frames = "".join(f"{f},{','.join(row)}\n" for f, row in enumerate(values))
    deeplabcut = f"scorer{',net' * 9}\nbodyparts{three}\ncoords{',x,y,z' * 3}\n{frames}"
    good, seen = all_same([("titles.csv", csv("{n}_{a}", before="Subject: A\nDate: today\n\n")), ("notes.csv", csv("{n}_{a}", before="# 100 Hz\n# mm\n"))], "--unit", "mm")
    fine, found = all_same([("units.csv", f"Name{three}\nunits{',mm' * 9}\ntime{',x,y,z' * 3}\n{rows}")])
    pose, there = all_same([("pose_DLC_3D.csv", deeplabcut)], "--unit", "mm", "--rate", "100")
    return good and fine and pose, f"{seen}; units {found}; DeepLabCut {there}"


@stranger("ms, us and other languages read; what may be either asked about")
def times_of_every_clock():
    good, seen = all_same([("ms.csv", csv("{n}_{a}", first="Time (ms)", scale=1e3)), ("us.csv", csv("{n}_{a}", first="Timestamp (us)", scale=1e6)),
                           ("fr.csv", csv("{n}_{a}", first="Temps (s)")), ("de.csv", csv("{n}_{a}", first="Zeit [s]"))], "--unit", "mm")  # fmt: skip
    asked = run("info", written("open.csv", csv("{n}_{a}", scale=1e3)), "--unit", "mm")
    fine, found = all_same([("ms.trc", trc(times=[f"{10 * f}" for f in range(60)]))])
    return good and fine and asked.returncode == 3 and "time_ms" in asked.stderr, f"{seen}; TRC {found}; unsaid: {said(asked)[-90:]}"


@stranger("not there, never a place")
def words_and_nines_for_nothing():
    names, times, values = cells()
    wrong, tried = [], 0
    for word in ("NaN", "NA", "N/A", "#N/A", "None", "null", "-", "", "1.#QNAN", "-9999", "999999"):
        rows = [[word] * 3 + row[3:] if f % 7 == 3 else row for f, row in enumerate(values)]
        for name, text, options in (("gaps.csv", csv("{n}_{a}", rows=rows), ("--unit", "mm")), ("gaps.trc", trc(rows=rows), ())):
            tried += 1
            read = positions(written(name, text), *options)
            if isinstance(read, str) or [p is None for p in read[names[0]]] != [f % 7 == 3 for f in range(len(times))]:
                wrong.append((word, name, read if isinstance(read, str) else "read as a place"))
    return not wrong, f"{tried - len(wrong)} of {tried} right{': not ' + str(wrong[0]) if wrong else ''}"


@stranger("x, y and z where a unit says so, else asked about; three channels never")
def numbers_for_axes():
    number = dict(zip("XYZ", range(3)))
    styles = [csv("{n}_{a}").replace("_X", "_1").replace("_Y", "_2").replace("_Z", "_3"), csv("{n}.{a}").replace(".X", ".1").replace(".Y", ".2").replace(".Z", ".3")]
    labels = csv("{n}[{a}]")
    for axis, k in number.items():
        labels = labels.replace(f"[{axis}]", f"[{k}]")
    files = [(f"numbers{i}.csv", text) for i, text in enumerate([*styles, labels])]
    good, seen = all_same(files, "--unit", "mm")
    asked = [run("info", written(name, text)) for name, text in files]
    rows = "".join(f"{t},1,2,3\n" for t in cells()[1])
    channels = [run("info", written("channels.csv", f"time,{line}\n{rows}"), "--unit", "mm") for line in ("Marker_1,Marker_2,Marker_3", "sensor.0,sensor.1,sensor.2", "acc_1,acc_2,acc_3")]
    fine = all(done.returncode == 3 and "--unit" in done.stderr for done in asked) and all(done.returncode == 3 for done in channels)
    return good and fine, f"{seen}; without a unit: {said(asked[0])[-90:]}"


@stranger("seconds from the first, and said so; what is no instant refused")
def times_of_a_clock():
    times = [float(t) for t in cells()[1]]
    styles = {"iso": "2024-05-01T10:00:{:06.3f}", "blank": "2024-05-01 23:59:{:06.3f}", "zone": "2024-05-01T10:00:{:06.3f}+02:00", "bare": "10:00:{:06.3f}", "quoted": '"10:00:{:06.3f}"'}
    header, *rows = csv("{n}_{a}").splitlines()
    texts = {name: "\n".join([header.replace("time", "timestamp"), *(f"{style.format(t)},{row.split(',', 1)[1]}" for t, row in zip(times, rows))]) + "\n" for name, style in styles.items()}
    semicolons = "\n".join(line.replace(",", ";").replace(".", ",") for line in texts["bare"].splitlines()) + "\n"
    good, seen = all_same([(f"{name}.csv", text) for name, text in [*texts.items(), ("comma", semicolons)]], "--unit", "mm")
    noted = run("info", written("iso.csv", texts["iso"]), "--unit", "mm")
    half = run("info", written("half.csv", texts["bare"].replace("10:00:", "at 10:00:")), "--unit", "mm")
    return good and "times are those of a clock" in noted.stderr + noted.stdout and half.returncode == 3, f"{seen}; else {said(half)[-80:]}"


@stranger("1,234.5 and 1.234,5 the same numbers, or refused; never another number")
def thousands():
    names, times, values = cells()
    grouped = [[f"{float(v):,.3f}" for v in row] for row in values]
    whole = [[f"{round(float(v)):,}" for v in row] for row in values]
    label = ",".join(["time", *(f"{n}_{a}" for n in names for a in "XYZ")])
    turn = str.maketrans(",.", ".,")
    english = label + "\n" + "".join(f"{t}," + ",".join(f'"{v}"' for v in row) + "\n" for t, row in zip(times, grouped))
    tabs = label.replace(",", "\t") + "\n" + "".join(f"{t}\t" + "\t".join(row) + "\n" for t, row in zip(times, grouped))
    german = label.replace(",", ";") + "\n" + "".join(f"{t.translate(turn)};" + ";".join(v.translate(turn) for v in row) + "\n" for t, row in zip(times, grouped))
    good, seen = all_same([("english.csv", english), ("tabs.csv", tabs), ("german.csv", german)], "--unit", "mm")
    bare = label.replace(",", ";") + "\n" + "".join(f"{f};" + ";".join(v.translate(turn) for v in row) + "\n" for f, row in enumerate(whole))
    rounded = same(written("bare.csv", bare.replace("time", "frame")), plain(), 1.0, "--unit", "mm", "--rate", "100")
    both = run("info", written("both.csv", tabs.replace(grouped[3][0], "1.234,5")), "--unit", "mm")
    return good and rounded[0] and both.returncode == 3, f"{seen}; whole numbers {rounded[1]}; both signs: exit {both.returncode}"


@stranger("the same numbers")
def signs_of_other_countries():
    names, times, values = cells()
    label = ["time", *(f"{n}_{a}" for n in names for a in "XYZ")]
    lower = [[f"{float(v) - 500:.3f}" for v in row] for row in values]
    minus = csv("{n}_{a}", rows=[[v.replace("-", "\u2212") for v in row] for row in lower])
    hyphen = positions(written("hyphen.csv", csv("{n}_{a}", rows=lower)), "--unit", "mm")
    good = "\u2212" in minus and apart(positions(written("minus.csv", minus), "--unit", "mm"), hyphen) < 1e-3
    grouped = [[f"{float(v):,.3f}" for v in row] for row in values]
    swiss = csv("{n}_{a}", rows=[[v.replace(",", "'") for v in row] for row in grouped])
    french = [";".join(label) + "\n" + "".join(f"{t.replace('.', ',')};" + ";".join(v.replace(",", blank).replace(".", ",") for v in row) + "\n" for t, row in zip(times, grouped)) for blank in ("\u00a0", "\u202f", " ")]
    fortran = trc(rows=[[f"{float(v) / 100:.7f}D+02" for v in row] for row in values])
    fine, found = all_same([("swiss.csv", swiss), *((f"french{i}.csv", text) for i, text in enumerate(french))], "--unit", "mm")
    last, there = all_same([("fortran.trc", fortran)])
    return good and fine and last, f"minus {good}; {found}; Fortran {there}"


@stranger("read with the names and the clock that these programs write")
def tables_of_pandas_and_kineticstoolkit():
    names, times, values = cells()
    rows = "".join(f"{t},{','.join(row)}\n" for t, row in zip(times, values))
    twice = ",".join(n for n in names for _ in "xyz")
    axes = ",".join("xyz" * len(names))
    pandas = [f"{a},{twice}\n{b},{axes}\ntime{',' * 3 * len(names)}\n{rows}" for a, b in (("", ""), ("channel", "axis"))]
    good, seen = all_same([(f"pandas{i}.csv", text) for i, text in enumerate(pandas)], "--unit", "mm")
    four = "Time," + ",".join(f"{n}[{k}]" for n in names for k in range(4)) + "\n"
    four += "".join(f"{t}," + ",".join(",".join([*(f"{float(v) / 1e3:.8f}" for v in row[3 * m : 3 * m + 3]), "1.0"]) for m in range(len(names))) + "\n" for t, row in zip(times, values))
    fine, found = all_same([("kineticstoolkit.csv", four)], "--unit", "m")
    return good and fine, f"{seen}; kineticstoolkit {found}"


@stranger("not there, and said")
def zeros_for_nothing_in_tables():
    names, times, values = cells()
    rows = [["0", "0.0", "0.000"] + row[3:] if f % 7 == 3 else row for f, row in enumerate(values)]
    wrong = []
    for options, label in ((("--unit", "mm"), "{n}_{a}"), ((), "{n}_{a} (mm)")):
        path = written("zeros.csv", csv(label, rows=rows))
        read = positions(path, *options)
        if isinstance(read, str) or [p is None for p in read[names[0]]] != [f % 7 == 3 for f in range(len(times))] or "exactly (0, 0, 0)" not in run("info", path, *options).stdout:
            wrong.append(read if isinstance(read, str) else label)
    return not wrong, f"2 tables{': not ' + wrong[0] if wrong else ''}"


@stranger("the rate of the header, said")
def times_that_count_frames():
    path = written("frames.trc", trc(times=[str(f + 1) for f in range(60)]))
    good, seen = same(path, plain(), 1e-3)
    facts = run("info", path).stdout
    return good and "times count frames" in facts and " 100" in facts, seen


@stranger("read as the plain file: labels from X5, keys that are missing, counts that differ, units in every hand, blank lines, fillings at the end")
def trc_of_every_program():
    text = plain().read_text()
    lines = text.splitlines()
    head = lambda k, line: "\n".join([*lines[:k], line, *lines[k + 1 :]]) + "\n"  # noqa: E731
    count = len(cells()[0])
    files = [("x5", trc([f"{a}{m + 5}" for m in range(count) for a in "XYZ"])), ("more", head(2, lines[2].replace(f"\t{count}\t", f"\t{count + 1}\t"))),
             ("fewer", head(2, lines[2].replace(f"\t{count}\t", f"\t{count - 1}\t"))), ("long", head(2, lines[2].replace("mm", "Millimeters"))), ("capital", head(2, lines[2].replace("mm", "MM"))),
             ("close", "\n".join(line for line in lines if line.strip()) + "\n"), ("zeros", text + "\0" * 64), ("dos", text + "\x1a"), ("blank", "\n".join([*lines[:20], "", *lines[20:30], "\t" * 5, "", *lines[30:]]) + "\n"),
             ("keys", "\n".join([lines[0], *("\t".join(line.split("\t")[:7]) for line in lines[1:3]), *lines[3:]]) + "\n")]  # fmt: skip
    return all_same([(f"{name}.trc", content) for name, content in files])


@stranger("what each is, and what to do")
def files_that_are_something_else():
    model = "<?xml version='1.0'?>\n<OpenSimDocument Version='40000'>"
    files = (("lfs.c3d", b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n", "git lfs pull"), ("page.c3d", b"<!DOCTYPE html>\n<html></html>\n", "web page"),
             ("page.trc", b"<html><body>404</body></html>\n", "web page"), ("sheet.xlsx", b"PK\3\4" + bytes(200), "CSV"), ("walk.c3d.gz", b"\x1f\x8b\x08" + bytes(100), "unpack"),
             ("body.osim", f"{model}<Model/>".encode(), "--model"), ("setup.xml", f"{model}<InverseKinematicsTool/>".encode(), "--setup"),
             ("bare.tsv", b"1\t0.00\t1\t2\t3\n2\t0.01\t1\t2\t3\n", "header"))  # fmt: skip
    wrong = []
    for name, content, word in files:
        (HERE / name).write_bytes(content)
        done = run("measure", HERE / name)
        if done.returncode not in (2, 3) or word not in done.stderr:
            wrong.append((name, said(done)))
    return not wrong, f"{len(files) - len(wrong)} of {len(files)} said{': not ' + str(wrong[0]) if wrong else ''}"


@stranger("forces of the plates as they are, N and N m, at their points; corners not known, said")
def forces_of_d_flow():
    free = 5.0
    header = ["TimeStamp", "FrameNumber", *(f"LHEE.Pos{a}" for a in "XYZ"), *(f"FP{p}.{w}{a}" for p in (1, 2) for w in ("Cop", "For", "Mom") for a in "XYZ")]
    rows, truth = [], []
    for f in range(120):
        point, force = (0.1, 0.0, 0.2 + 0.001 * f), (20.0, 700.0 if 30 <= f < 90 else 3.0, -30.0)
        turn = (point[1] * force[2] - point[2] * force[1], free + point[2] * force[0] - point[0] * force[2], point[0] * force[1] - point[1] * force[0])
        rows.append([0.01 * f, f + 1, 0.1, 0.05, 0.2, *point, *force, *turn, *[0.0] * 9])
        truth.append((force, point))
    path = written("grail.txt", "\t".join(header) + "\n" + "".join("\t".join(f"{v:.6f}" for v in row) + "\n" for row in rows))
    done = run("convert", path, HERE / "grail.mot", "--force")
    if done.returncode != 0:
        return False, said(done)
    _, got = table(HERE / "grail.mot")
    off = max(max(math.dist(got[f][1:4], truth[f][0]), 1e3 * math.dist(got[f][4:7], truth[f][1]), abs(got[f][8] - free)) for f in range(30, 90))
    empty = max(abs(v) for v in got[10][1:])
    beside = run("convert", path, HERE / "grail.c3d", "--force").stderr
    counted = next((line.split()[1] for line in run("info", path).stdout.splitlines() if line.startswith("force_plates")), "")
    return counted == "2" and off < 0.01 and empty == 0 and "corners" in done.stderr and "not carried on: forces of plates" in beside, f"{off:.2g} N, mm, N m off; empty {empty}; to C3D: {'said' if 'not carried' in beside else 'unsaid'}"


@stranger("one line a sample under other labels, read")
def long_tables():
    names, times, values = cells()
    rows = [(f, t, n, values[f][3 * m : 3 * m + 3]) for f, t in enumerate(times) for m, n in enumerate(names)]
    one = "Frame,Time (ms),Name,X (mm),Y (mm),Z (mm)\n" + "".join(f"{f + 1},{1e3 * float(t):.3f},{n},{','.join(x)}\n" for f, t, n, x in rows)
    two = "t,bodypart,x,y,z,score\n" + "".join(f"{t},{n},{','.join(x)},0.9\n" for _, t, n, x in sorted(rows, key=lambda row: names.index(row[2])))
    good, seen = all_same([("long.csv", one)])
    fine, found = all_same([("longer.csv", two)], "--unit", "mm")
    return good and fine, f"{seen}; by marker {found}"


@stranger("no markers: refused")
def outputs_of_models_and_plates():
    times = cells()[1]
    labels = ("LHipAngles_X,LHipAngles_Y,LHipAngles_Z", "F_X,F_Y,F_Z", "FP1_Fx,FP1_Fy,FP1_Fz", "ground_force_vx,ground_force_vy,ground_force_vz", "LKneeMoment.x,LKneeMoment.y,LKneeMoment.z",
              "pelvis_w,pelvis_x,pelvis_y,pelvis_z", "acc_x,acc_y,acc_z", "A_vx,A_vy,A_vz")  # fmt: skip
    taken = []
    for line in labels:
        width = line.count(",") + 1
        path = written("other.csv", f"time,{line}\n" + "".join(f"{t}{',0.5' * (width - 1)},{f}\n" for f, t in enumerate(times)))
        if run("info", path, "--unit", "mm").returncode != 3:
            taken.append(line)
    return not taken, f"{len(labels) - len(taken)} of {len(labels)} refused{': not ' + taken[0] if taken else ''}"


@stranger("what is wrong with the file, not with --unit")
def a_unit_for_what_is_no_recording():
    done = run("info", written("odd.csv", "t,alpha,beta\n0,1,2\n0.01,1,2\n"), "--unit", "mm")
    return done.returncode == 3 and "none of its 3 columns is a position" in done.stderr, said(done)


@stranger("what each holds and what to do")
def texts_that_hold_something_else():
    texts = (("k.csv", "Time (ms);Trajectory 1/0/X;Trajectory 1/0/Y\n0;1;2\n", "one camera"), ("k.kva", "<?xml?>\n<KinoveaVideoAnalysis/>\n", "one camera"),
             ("m.mvnx", "<?xml?>\n<mvnx version='4'/>\n", "C3D"), ("b.txt", "BioWare Version 5.6.1.0 Export\nDevice:\tA\n", "C3D"),
             ("q.csv", "Time (s),W,X,Y,Z\n0,1,0,0,0\n0.02,1,0,0,0\n", "--orientations"), ("a.csv", "t,Acc_X,Acc_Y,Acc_Z,Gyr_X,Gyr_Y,Gyr_Z\n0,1,2,3,4,5,6\n", "inertial sensor"))  # fmt: skip
    wrong = [(name, said(done)) for name, text, word in texts for done in [run("info", written(name, text))] if done.returncode != 3 or word not in done.stderr]
    return not wrong, f"{len(texts) - len(wrong)} of {len(texts)} said{': not ' + str(wrong[0]) if wrong else ''}"


@stranger("read by its content, 0.01 mm")
def visual3d_text_called_txt():
    names, times, values = cells()
    rows = ["\t" + "\t".join("f.c3d" for _ in range(9)), "\t" + "\t".join(n for n in names for _ in "xyz"), "\t" + "\t".join(["TARGET"] * 9), "\t" + "\t".join(["ORIGINAL"] * 9),
            "ITEM" + "\tX\tY\tZ" * 3]  # fmt: skip
    rows += [f"{f + 1}\t" + "\t".join(f"{float(v) / 1e3:.7f}" for v in row) for f, row in enumerate(values)]
    return same(written("v3d.txt", "\n".join(rows) + "\n"), plain(), 0.01, "--rate", "100")


# --- arrays of MATLAB ---


@stranger("variables, 3 x frames, a struct of paths, and one table with labels: the plain samples")
def plain_arrays_of_matlab():
    names, times, values = cells()
    frames, count = len(times), len(names)
    path = lambda m, k: [float(values[f][3 * m + k]) for f in range(frames)]  # noqa: E731
    upright = [doubles(n, (frames, 3), [v for k in range(3) for v in path(m, k)]) for m, n in enumerate(names)]
    lying = [doubles(n, (3, frames), [float(values[f][3 * m + k]) for f in range(frames) for k in range(3)]) for m, n in enumerate(names)]
    rate, unit, clock = doubles("fs", (1, 1), [100.0]), words("unit", "mm"), doubles("t", (frames, 1), [float(t) for t in times])
    width = max(map(len, names)) + 1
    fields = element(5, struct.pack("<i", width)) + element(1, b"".join(n.encode().ljust(width, b"\0") for n in names))
    inside = b"".join(doubles("", (frames, 3), [v for k in range(3) for v in path(m, k)]) for m in range(count))
    struct_of_paths = matrix("markers", 2, (1, 1), fields + inside)
    labels = matrix("labels", 1, (1, count), b"".join(words("", n) for n in names))
    whole = doubles("data", (frames, 3 * count), [v for m in range(count) for k in range(3) for v in path(m, k)])
    files = [mat("paths.mat", *upright, rate, unit), mat("lying.mat", *lying, clock, unit), mat("struct.mat", struct_of_paths, rate, unit), mat("table.mat", whole, labels, rate, unit)]
    wrong = [(file.name, seen) for file in files for good, seen in [same(file, plain(), 1e-3)] if not good]
    other = run("info", mat("force.mat", doubles("force", (frames, 3), [1.0] * 3 * frames), rate, unit))
    return not wrong and other.returncode == 3, f"{len(files) - len(wrong)} of {len(files)} the same{': not ' + str(wrong[0]) if wrong else ''}; a force alone: exit {other.returncode}"


# --- C3D ---


CORNERS = [[464.0, 508.0, 0.0], [0.0, 508.0, 0.0], [0.0, 0.0, 0.0], [464.0, 0.0, 0.0]]  # mm; the plate's z points up
DOWN = [CORNERS[k] for k in (3, 2, 1, 0)]  # the same plate as the format has it: z into it
FORCE, POINT = (30.0, -20.0, 700.0), (332.0, 204.0, 0.0)


def plates(name, corners, markers=True, length="mm", dims=None, origin=(0.0, 0.0, -40.0), first=1, named=True, moments="Nmm", down=False):
    """As many plates as lists of corners: the force of FORCE at POINT on the first, which is CORNERS, or DOWN whose z is into the plate, in the middle half of the time."""
    x, y = POINT[0] - 232.0, POINT[1] - 254.0
    force = FORCE
    if down:
        y, force = -y, (FORCE[0], -FORCE[1], -FORCE[2])
    z = -40.0  # from the sensors to the surface, by ORIGIN
    moment = (y * force[2] - z * force[1], z * force[0] - x * force[2], x * force[1] - y * force[0])
    loaded, rest = [*force, *moment] + [0.0] * 6 * (len(corners) - 1), [0.0] * 6 * len(corners)
    analog = [loaded if 10 <= f // 2 < 30 else rest for f in range(80)]
    metres = 0.001 if length == "mm" else 1.0
    point = [[v * 0.001 / metres for v in (232.0, 254.0, 1000.0)]]
    n = len(corners)
    platform = [("USED", 2, [], [n]), ("TYPE", 2, [n], [2] * n), ("ZERO", 2, [2], [0, 0]), ("CORNERS", 4, dims or [3, 4, n], [v for plate in corners for v in plate]),
                ("ORIGIN", 4, [3, n], list(origin) * n), ("CHANNEL", 2, [6, n], list(range(first, 6 * n + first)))]  # fmt: skip
    labels = [f"{part}{i + 1}" if named else f"channel {6 * i + k}" for i in range(n) for k, part in enumerate(("Fx", "Fy", "Fz", "Mx", "My", "Mz"))]
    return c3d(name, [point] * 40 if markers else None, analog, labels, (["N"] * 3 + [moments] * 3) * n, 2, platform, length)


def loaded_right(path):
    done = run("convert", path, HERE / "forces.mot", "--force")
    if done.returncode != 0:
        return False, said(done)
    names, rows = table(HERE / "forces.mot")
    row = rows[len(rows) // 2]
    force, point = row[1:4], [1e3 * v for v in row[4:7]]
    return math.dist(force, FORCE) < 0.05 and math.dist(point, POINT) < 0.1, f"{', '.join(f'{v:.1f}' for v in force)} N at {', '.join(f'{v:.1f}' for v in point)} mm, {len(names) // 9} plates"


def flat(corners, scale=1.0):
    return [scale * v for corner in corners for v in corner]


@stranger("force and point of the plate in every file")
def corners_of_plates_as_they_come():
    beside = [[c[0], c[1] + 600.0, c[2]] for c in CORNERS]
    crossed = [beside[0], beside[1], beside[3], beside[2]]
    turned = [CORNERS[c][k] for k in range(3) for c in range(4)]
    files = [plates("good.c3d", [flat(CORNERS)]), plates("metres.c3d", [flat(CORNERS, 0.001)]), plates("millimetres.c3d", [flat(CORNERS)], length="m"),
             plates("four.c3d", [turned], dims=[4, 3, 1]), plates("crossed.c3d", [flat(CORNERS), flat(crossed)]), plates("alone.c3d", [flat(CORNERS)], markers=False)]  # fmt: skip
    found = [(file.stem, *loaded_right(file)) for file in files]
    wrong = [(name, seen) for name, good, seen in found if not good]
    both = "2 plates" in dict((name, seen) for name, _, seen in found)["crossed"]
    return not wrong and both, f"{len(files) - len(wrong)} of {len(files)} right{': not ' + str(wrong[0]) if wrong else ''}; the crossed one is there: {both}"


@stranger("force and point of the plate, and each said")
def plates_whose_numbers_contradict_each_other():
    one = [flat(CORNERS)]
    cases = {
        "counts from 0": [plates("labels0.c3d", one, first=0), plates("bare0.c3d", one, first=0, named=False)],
        "ORIGIN is taken for m": [plates("origin.c3d", one, origin=(0.0, 0.0, -0.04))],
        "divided by 1000": [plates("moments.c3d", one, moments="Nm")],
        "are exchanged, so that they go around it and its z points down": [
            plates(f"over{k}.c3d", [flat([DOWN[c] for c in order])], down=True) for k, order in enumerate(((0, 2, 1, 3), (0, 1, 3, 2)))],
    }  # fmt: skip
    cases["taken for cm"] = [plates("cm.c3d", [flat(CORNERS, 0.1)])]
    fine = [plates("fine.c3d", one), plates("down.c3d", [flat(DOWN)], down=True)]
    notes = lambda file: run("convert", file, HERE / "f.mot", "--force").stderr  # noqa: E731
    found = [(file.stem, *loaded_right(file), word in notes(file)) for word, files in cases.items() for file in files]
    found += [(file.stem, *loaded_right(file), not any(word in notes(file) for word in cases)) for file in fine]
    wrong = [(name, seen, f"said: {said_so}") for name, good, seen, said_so in found if not (good and said_so)]
    return not wrong, f"{len(found) - len(wrong)} of {len(found)} right{': not ' + str(wrong[0]) if wrong else ''}"


@stranger("exit 1, and what contradicts what")
def pressure_beside_the_plate():
    done = run("convert", plates("off.c3d", [flat(CORNERS)], moments="Ncm"), HERE / "f.mot", "--force")
    return done.returncode == 1 and "leaves plate 1" in done.stderr, said(done)


@stranger("EMG and plates measured by emg and analyze; paths need markers")
def c3d_without_markers():
    dice = random.Random(3)
    samples = [[1e-4 * dice.gauss(0, 5 if i % 1000 < 300 else 1)] for i in range(4000)]
    muscles = c3d("emg.c3d", None, samples, ["EMG1"], ["V"], 10)
    alone = plates("plates.c3d", [flat(CORNERS)], markers=False)
    found = {}
    for name, words_of in {"emg": ("emg", muscles), "analyze": ("analyze", muscles), "plates": ("analyze", alone)}.items():
        done = run(*words_of, "--refits", 0, "--json")
        found[name] = [m["subject"] for m in json.loads(done.stdout)["measures"]] if done.returncode == 0 else said(done)
    refused = run("measure", muscles)
    good = "EMG1" in found["emg"] and "EMG1" in found["analyze"] and "plate 1" in found["plates"]
    return good and refused.returncode == 3, f"{ {k: v if isinstance(v, str) else len(v) for k, v in found.items()} }; measure: exit {refused.returncode}"


@stranger("the same amplitude in volts")
def words_for_volts():
    dice = random.Random(4)
    volts = [1e-4 * dice.gauss(0, 5 if i % 1000 < 300 else 1) for i in range(4000)]
    seen = {}
    for unit, scale in (("V", 1.0), ("Volts", 1.0), ("mV", 1e3), ("millivolts", 1e3), ("uV", 1e6), ("Microvolt", 1e6)):
        done = run("emg", c3d("volts.c3d", None, [[v * scale] for v in volts], ["EMG1"], [unit], 10), "--refits", 0, "--json")
        measures = json.loads(done.stdout)["measures"] if done.returncode == 0 else []
        seen[unit] = next((m["value"] for m in measures if m["measure"] == "emg_rms"), math.nan)
    return all(abs(v - seen["V"]) < 1e-4 * seen["V"] for v in seen.values()), f"{seen['V']:.3g} V; {seen}"


def main():
    chosen, failed = sys.argv[1:], False
    for name, asked, check in CHECKS:
        if chosen and name not in chosen:
            continue
        if not CASES.is_dir():
            print(f"SKIP | stranger {name} | {asked} | no {CASES.name} beside the recordings", flush=True)
            continue
        try:
            good, seen = check()
        except (KeyError, ValueError, IndexError, OSError, StopIteration) as error:
            good, seen = False, f"{type(error).__name__}: {error}"
        failed = failed or not good
        print(f"{'PASS' if good else 'FAIL'} | stranger {name} | {asked} | {seen}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
