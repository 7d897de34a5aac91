#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Files of the kinds that people report as trouble, each through the command that they would type: the right answer, or a refusal
that says what to do. The 22 reported cases of ../shared/reference/cases, and 20 more of the same kinds that are written here.

    tests/acceptance/cases.py [NAME...]

Nothing of kinemark is used but the program. Needs KINEMARK_PROGRAM; finds the cases beside KINEMARK_TEST_DATA. Prints rows
"PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import csv
import json
import math
import os
import re
import struct
import sys
import tempfile
from pathlib import Path

import rows

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("KINEMARK_PROGRAM", str(ROOT / "build" / "release" / "bin" / "kinemark"))
DATA = Path(os.environ.get("KINEMARK_TEST_DATA") or ROOT.parent / "shared" / "data")
CASES = DATA.parent / "reference" / "cases"
HERE = Path(tempfile.mkdtemp(prefix="cases_"))
CHECKS = []


def case(asked, kind="reported"):
    """A check: a function that returns (whether it is right, what was seen)."""

    def register(function):
        CHECKS.append((function.__name__.replace("_", "-"), kind, asked, function))
        return function

    return register


def run(*words):
    return rows.run(*words, folder=HERE)


def said(done):
    return f"exit {done.returncode}: {' '.join((done.stdout + done.stderr).split())[:150]}"


def positions(path, *options):
    """{marker: [(x, y, z) in metres or None, ...]} as `convert` writes them; or the answer of the program where it fails."""
    out = HERE / "read.csv"
    done = run("convert", path, out, "--force", "--edits", "none", *options)
    if done.returncode != 0:
        return said(done)
    rows = {}
    with out.open(newline="") as file:
        for row in csv.DictReader(file):
            there = row["state"] != "missing"
            rows.setdefault(row["marker"], []).append(tuple(float(row[a]) for a in ("x_m", "y_m", "z_m")) if there else None)
    return rows


def apart(a, b):
    """Largest distance of two readings in mm; infinite where they do not hold the same samples."""
    if isinstance(a, str) or isinstance(b, str) or list(a) != list(b) or any(len(a[name]) != len(b[name]) for name in a):
        return math.inf
    pairs = [(p, q) for name in a for p, q in zip(a[name], b[name])]
    if any((p is None) != (q is None) for p, q in pairs):
        return math.inf
    return 1e3 * max((math.dist(p, q) for p, q in pairs if p is not None), default=math.inf)


def same(path, plain, most_mm, *options):
    """Whether a file is read as the plain one of its samples."""
    read = positions(path, *options)
    distance = apart(read, positions(plain))
    if isinstance(read, str):
        return False, read
    return distance <= most_mm, f"{len(read)} markers, {distance:.2g} mm apart"


def plain():
    """The samples of the text cases, as a TRC that nobody doubts."""
    text = (CASES / "decimal-comma" / "comma.trc").read_text().replace(",", ".")
    (HERE / "plain.trc").write_text(text)
    return HERE / "plain.trc"


def written(name, text, encoding="utf-8"):
    (HERE / name).write_bytes(text.encode(encoding))
    return HERE / name


def table(path):
    """(names, rows of numbers) of a MOT or STO."""
    lines = Path(path).read_text().splitlines()
    head = next(i for i, line in enumerate(lines) if line.strip() == "endheader")
    names = lines[head + 1].split("\t")
    return names, [[float(v) for v in line.split("\t")] for line in lines[head + 2 :] if line.strip()]


def column(path, name):
    names, rows = table(path)
    return [row[names.index(name)] for row in rows]


# --- texts ---


@case("read as the file with tabs")
def trc_first_line():
    good = [same(CASES / "trc-first-line" / f"{n}.trc", plain(), 1e-4) for n in ("one_space", "two_spaces")]
    return all(g for g, _ in good), good[-1][1]


@case("three files read, decimal commas and all")
def decimal_comma():
    comma = same(CASES / "decimal-comma" / "comma.trc", plain(), 1e-4)
    vicon = [positions(CASES / "decimal-comma" / f"{n}.csv") for n in ("vicon", "vicon_excel_de")]
    distance = apart(*vicon)
    return comma[0] and distance <= 1e-4, f"{comma[1]}; Excel's copy {distance:.2g} mm apart"


@case("read; that no unit is stated is said")
def csv_wide_markers():
    good = [same(CASES / "csv-wide-markers" / f"{n}.csv", plain(), 1e-3, "--unit", "m") for n in ("wide", "wide_semicolon_comma")]
    without = run("info", CASES / "csv-wide-markers" / "wide.csv")
    names = "no unit of length is stated" in without.stderr + without.stdout
    return all(g for g, _ in good) and names, f"{good[0][1]}; without it that none is stated: {names}"


@case("markers of both forms, as the TRC")
def markers_in_sto():
    good = [same(CASES / "markers-in-sto" / f"{n}.sto", plain(), 1e-3) for n in ("markers", "markers_vec3")]
    return all(g for g, _ in good), good[-1][1]


def ranges(path, model):
    """{coordinate: range of motion} by `dynamics`."""
    done = run("dynamics", path, "-m", model, "--refits", 0, "--json")
    try:
        found = json.loads(done.stdout)
    except json.JSONDecodeError:
        return said(done)
    return {m["subject"]: m["value"] for m in found["measures"] if m["measure"] == "joint_range"}


@case("coordinates of a state file as those of the MOT")
def states_file_paths():
    folder = CASES / "states-file-paths"
    a, b = ranges(folder / "moco.sto", folder / "base.osim"), ranges(folder / "ok.mot", folder / "base.osim")
    if isinstance(a, str) or isinstance(b, str) or not a:
        return False, str(a)
    off = max(abs(a[name] - b[name]) for name in b)
    return set(a) == set(b) and off < 1e-5, f"{len(a)} coordinates, {off:.2g} apart"


@case("origin of the body as a point, its rotation kept")
def qtm_6d():
    path = CASES / "qtm-6d" / "qtm_6d.tsv"
    done = run("info", path, "--json")
    if done.returncode != 0:
        return False, said(done)
    facts = json.loads(done.stdout)
    read = positions(path)
    first = read["stick"][0] if isinstance(read, dict) and "stick" in read else None
    angles = [c["name"] for c in facts["channels"]]
    return first is not None and math.dist(first, (0.0, 0.25, 0.9)) < 1e-6 and bool(angles), f"{first} m, channels {angles[:3]}"


@case("person 1 of the CSV used, as for .h5")
def dlc_multi_animal_csv():
    folder = CASES / "dlc-multi-animal-csv"
    words = ["ik", "--estimator", "smoother", "-m", folder / "base.osim", "-t", folder / "base.trc", "-o", HERE / "dlc.mot", "--force",
             "--rig", folder / "rig.toml", "--images", f"A={folder / 'ma_A.csv'}", "--images", f"B={folder / 'ma_B.csv'}"]  # fmt: skip
    done, unsaid = run(*words, "--person", 1), run(*words)
    return done.returncode in (0, 1) and unsaid.returncode in (2, 3) and "--person" in unsaid.stderr, f"{said(done)[:60]}; without: {said(unsaid)[:80]}"


@case("angles from sensors, or what a quaternion table is")
def imu_orientations():
    done = run("info", CASES / "imu-orientations" / "quat.sto")
    return "--orientations" in done.stdout + done.stderr or done.returncode == 0, said(done)


# --- files that we write ---


def numbers_of(data, group, parameter):
    """The numbers of a parameter of a C3D file of Intel numbers; none where it is not there."""
    at = 512 * (data[0] - 1) + 4
    groups, found = {}, []
    while True:
        length, of = struct.unpack_from("<bb", data, at)
        length = abs(length)
        name = data[at + 2 : at + 2 + length].decode()
        (after,) = struct.unpack_from("<h", data, at + 2 + length)
        if of < 0:
            groups[-of] = name
        else:
            found.append((of, name, at + 4 + length))
        if not length or not after:
            break
        at += 2 + length + after
    for of, name, place in found:
        if (groups.get(of), name) == (group, parameter):
            kind, sizes = struct.unpack_from("<bB", data, place)
            count = math.prod(data[place + 2 : place + 2 + sizes])
            return list(struct.unpack_from(f"<{count}{'f' if kind == 4 else 'h'}", data, place + 2 + sizes))
    return []


@case("the header and ANALOG:RATE agree: 0 samples a frame")
def c3d_written_unreadable_by_py_c3d():
    done = run("convert", CASES / "c3d-written-unreadable-by-py-c3d" / "base.trc", HERE / "out.c3d", "--force")
    if done.returncode != 0:
        return False, said(done)
    data = (HERE / "out.c3d").read_bytes()
    a_frame = struct.unpack_from("<H", data, 4)[0]
    rate = numbers_of(data, "ANALOG", "RATE") or [0.0]
    return a_frame == 0 and rate == [0.0], f"header {a_frame}, ANALOG:RATE {rate[0]:g}"


# --- what files state ---


@case("the continuous reading, and that it was chosen: 6.9e-5 V")
def analog_16bit_unsigned():
    folder = CASES / "analog-16bit-unsigned"
    done = run("emg", folder / "emg_u16.c3d", "--json", "--refits", 0)
    try:
        values = {m["measure"]: m["value"] for m in json.loads(done.stdout)["measures"]}
    except (json.JSONDecodeError, KeyError):
        return False, said(done)
    mean = values["emg_mean"]
    files = [run("convert", folder / f"u16_{n}.c3d", HERE / "out.mat", "--force", "--json") for n in ("format", "noformat")]
    named = "ANALOG:FORMAT is missing" in files[1].stdout + files[1].stderr
    return abs(mean - 6.9e-5) < 2e-6 and named, f"mean {mean:.3g} V, said: {named}"


@case("a scale of 0 is named")
def analog_scale_zero():
    done = run("validate", CASES / "analog-scale-zero" / "scale_zero.c3d")
    return "scale" in (done.stdout + done.stderr).lower(), said(done)


def wrench(folder, name):
    """Force, point and free moment in a frame after the baseline, by `convert FILE.c3d FILE.mot`."""
    out = HERE / "forces.mot"
    done = run("convert", CASES / folder / f"{name}.c3d", out, "--force")
    if done.returncode != 0:
        return said(done)
    names, rows = table(out)
    row = rows[len(rows) // 2]
    of = lambda part: [row[i] for i, n in enumerate(names) if n.endswith(tuple(f"{part}{axis}" for axis in "xyz"))][:3]  # noqa: E731
    return of("_v") or of("_force_v"), of("_p") or of("_force_p"), names


def near(found, force, point_mm):
    if isinstance(found, str):
        return False, found
    f, p, _ = found
    size = math.sqrt(sum(v * v for v in f))
    place = sorted(abs(1e3 * v) for v in p)[1:]
    good = abs(size - force) < 1e-3 * force + 0.01 and all(abs(a - b) < 0.1 for a, b in zip(place, sorted(map(abs, point_mm))))
    return good, f"{size:.3f} N at {', '.join(f'{1e3 * v:.2f}' for v in p)} mm"


@case("700 N at (100, -50) mm with a baseline from frame 0")
def plate_zero_from_0():
    found = [near(wrench("plate-zero-from-0", n), math.sqrt(30**2 + 20**2 + 700**2), (100, 50)) for n in ("zero_0_10", "zero_1_10")]
    return all(g for g, _ in found), found[0][1]


@case("(61.5, -45.8) mm with the polynomial")
def plate_cop_polynomial():
    found = wrench("plate-cop-polynomial", "type3_poly")
    if isinstance(found, str):
        return False, found
    p = sorted(abs(1e3 * v) for v in found[1])[1:]
    return abs(p[0] - 45.8) < 0.1 and abs(p[1] - 61.5) < 0.1, f"{', '.join(f'{1e3 * v:.2f}' for v in found[1])} mm"


@case("(100, -50) mm in kN.m, Nxm and kgf.m; Joule named")
def plate_moment_unit_words():
    seen, good = [], True
    for unit in ("kN.m", "Nxm", "kgf.m"):
        found = wrench("plate-moment-unit-words", unit)
        p = [0.0] if isinstance(found, str) else sorted(abs(1e3 * v) for v in found[1])[1:]
        good = good and len(p) == 2 and abs(p[0] - 50) < 0.1 and abs(p[1] - 100) < 0.1
        seen.append(f"{unit} {', '.join(f'{v:.1f}' for v in p)}")
    joule = run("convert", CASES / "plate-moment-unit-words" / "Joule.c3d", HERE / "forces.mot", "--force")
    known = wrench("plate-moment-unit-words", "Joule")
    named = "Joule" in joule.stdout + joule.stderr or not isinstance(known, str)
    return good and named, f"{'; '.join(seen)}; Joule: {said(joule)[:60]}"


@case("(60, -50) mm at the sensors, 54 mm below the surface")
def plate_type_6():
    found = wrench("plate-type-6", "type6")
    if isinstance(found, str):
        return False, found
    force, point, _ = found
    p = [1e3 * point[i] + 54 * force[i] / force[2] for i in (0, 1)]  # the case's own sensors hold no moment of the horizontal force
    return abs(p[0] - 60) < 0.1 and abs(p[1] + 50) < 0.1, f"({p[0]:.2f}, {p[1]:.2f}) mm"


# --- walking ---


def gait(path, *options):
    done = run("gait", path, "--refits", 0, "--json", *options)
    try:
        found = json.loads(done.stdout)
    except json.JSONDecodeError:
        return done, {}
    values = {}
    for m in found.get("measures", []):
        values.setdefault(m["measure"], []).append(m["value"])
    return done, values


@case("1,105 mm/s backwards, strides of 1,380 mm, or refused")
def gait_backward_overground():
    done, values = gait(CASES / "gait-backward-overground" / "overground_backward.trc")
    text = done.stdout + done.stderr
    strides = [v for v in values.get("stride_length", []) if v]
    return "backward" in text and "treadmill" not in done.stderr and all(abs(v - 1380) < 30 for v in strides), f"{strides[:2]} mm, backwards said: {'backward' in text}"


@case("exchanged sides are said by validate and by gait")
def gait_left_right_swapped():
    path = CASES / "gait-left-right-swapped" / "walk_swapped.trc"
    words = ("exchanged", "mirror", "left and right", "sides")
    texts = [run(*c).stdout + run(*c).stderr for c in (("validate", path), ("gait", path, "--refits", 0))]
    clean = run("validate", CASES / "gait-left-right-swapped" / "walk_rot0.trc")
    quiet = not any(w in clean.stdout + clean.stderr for w in ("exchanged", "mirror"))
    return all(any(w in t for w in words) for t in texts) and quiet, f"said {[any(w in t for w in words) for t in texts]}, of the right one nothing: {quiet}"


@case("right strides of about 0.46 s, or none")
def gait_sprint_missed_strike():
    done, values = gait(CASES / "gait-sprint-missed-strike" / "sprint.trc")
    strides = [v for v in values.get("stride_time", []) if v]
    return all(0.42 < v < 0.51 for v in strides) and "treadmill" not in done.stderr, f"{strides} s; {said(done)[:60]}"


@case("both people, or which was taken")
def gait_two_people():
    done, _ = gait(CASES / "gait-two-people" / "two_people.trc")
    text = done.stdout + done.stderr
    return "Ann" in text and "Bob" in text, said(done)


# --- models ---


@case("said, and exit status 1 or 3")
def motion_degrees_called_radians():
    folder = CASES / "motion-degrees-called-radians"
    done, good = (run("dynamics", folder / f"{n}.mot", "-m", folder / "base.osim", "--refits", 0) for n in ("deg_called_rad", "ok"))
    return done.returncode != 0 and "degrees" in done.stdout + done.stderr and good.returncode == 0, said(done)


@case("hip_rotation follows its function: 0.0001 rad of it")
def osim_prescribed_coordinate():
    folder = CASES / "osim-prescribed-coordinate"
    done = run("ik", "-m", folder / "prescribed.osim", "-t", folder / "prescribed.trc", "-o", HERE / "p.mot", "--force")
    if done.returncode != 0:
        return False, said(done)
    text = (folder / "prescribed.osim").read_text()
    number = lambda tag: float(re.search(rf"<{tag}>\s*([-\d.eE+]+)", text)[1])  # noqa: E731
    times, q = column(HERE / "p.mot", "time"), column(HERE / "p.mot", "hip_rotation")
    truth = [number("amplitude") * math.sin(number("omega") * t + number("phase")) + (number("offset") if "<offset>" in text else 0.0) for t in times]
    off = max(abs(math.radians(a) - b) for a, b in zip(q, truth))
    return off < 1e-4, f"{off:.2g} rad"


@case("(1.734, 0.920, -5.183) m, as in root_zero.bvh")
def bvh_root_offset():
    return same(CASES / "bvh-root-offset" / "root_offset.bvh", CASES / "bvh-root-offset" / "root_zero.bvh", 1e-3)


# --- 20 more of the same kinds, written here ---


def cells():
    """(names, times, rows of coordinates in mm as text) of the plain TRC."""
    lines = [line.split("\t") for line in plain().read_text().splitlines()]
    rows = [line for line in lines[5:] if len(line) > 2]
    return [n for n in lines[3][2:] if n], [r[1] for r in rows], [r[2:] for r in rows]


@case("the same samples", "ours")
def trc_bom_crlf_and_tabs_at_the_ends():
    lines = plain().read_text().splitlines()
    return same(written("bom.trc", "".join(line + "\t\r\n" for line in lines), "utf-8-sig"), plain(), 1e-4)


@case("the same samples", "ours")
def trc_in_utf_16():
    return same(written("wide.trc", plain().read_text().replace("\n", "\r\n"), "utf-16"), plain(), 1e-4)


@case("the same samples", "ours")
def trc_blanks_for_tabs_throughout():
    lines = plain().read_text().splitlines()
    return same(written("blanks.trc", "\n".join([*lines[:5], *(line.replace("\t", "   ") for line in lines[5:])]) + "\n"), plain(), 1e-4)


@case("the same samples; an empty cell is a missing one", "ours")
def csv_unit_in_a_line_of_its_own():
    names, times, rows = cells()
    text = "time," + ",".join(f"{n}.{a}" for n in names for a in "xyz") + "\ns" + ",mm" * 9 + "\n"
    return same(written("unit_line.csv", text + "".join(f"{t},{','.join(r)}\n" for t, r in zip(times, rows))), plain(), 1e-3)


@case("the same samples", "ours")
def csv_names_above_axes():
    names, times, rows = cells()
    text = "," + ",".join(f"{n},," for n in names) + "\nTime" + ",X,Y,Z" * 3 + "\n"
    return same(written("two_lines.csv", text + "".join(f"{t},{','.join(r)}\n" for t, r in zip(times, rows))), plain(), 1e-3, "--unit", "mm")


@case("centimetres by --unit cm", "ours")
def csv_in_centimetres():
    names, times, rows = cells()
    text = "Time;" + ";".join(f"{n}_{a}" for n in names for a in "XYZ") + "\n"
    lines = [f"{t};{';'.join(f'{float(v) / 10:.6f}' for v in r)}\n".replace(".", ",") for t, r in zip(times, rows)]
    return same(written("cm.csv", text + "".join(lines)), plain(), 1e-3, "--unit", "cm")


@case("read, or a sentence that names a line of --columns", "ours")
def csv_of_columns_nobody_knows():
    _, times, rows = cells()
    path = written("odd.csv", "t,alpha,beta\n" + "".join(f"{t},{r[0]},{r[1]}\n" for t, r in zip(times, rows)))
    done = run("info", path)
    return done.returncode == 0 or "--columns" in done.stderr or "_X" in done.stderr, said(done)


@case("the samples that are there; NaN is missing", "ours")
def sto_markers_with_nan():
    text = (CASES / "markers-in-sto" / "markers_vec3.sto").read_text().splitlines()
    lines = text[:6] + [line if i % 7 else "\t".join([line.split("\t")[0], "nan,nan,nan", *line.split("\t")[2:]]) for i, line in enumerate(text[6:])]
    read, whole = positions(written("nan.sto", "\n".join(lines) + "\n")), positions(plain())
    if isinstance(read, str):
        return False, read
    missing = sum(p is None for p in read["LASI"])
    return missing == 9 and apart({"RASI": read["RASI"]}, {"RASI": whole["RASI"]}) < 1e-3, f"{missing} missing of LASI"


@case("speeds and activations are left out, values read", "ours")
def states_with_speeds():
    folder = CASES / "states-file-paths"
    lines = (folder / "moco.sto").read_text().splitlines()
    head = lines.index("endheader")
    text = [*lines[: head + 1], lines[head + 1] + "\t/jointset/elbow/elbow_flexion/speed\t/forceset/soleus/activation", *(line + "\t1.5\t0.02" for line in lines[head + 2 :])]
    a, b = ranges(written("states.sto", "\n".join(text) + "\n"), folder / "base.osim"), ranges(folder / "ok.mot", folder / "base.osim")
    if isinstance(a, str) or isinstance(b, str):
        return False, str(a)
    return set(a) == set(b) and max(abs(a[n] - b[n]) for n in b) < 1e-5, f"{len(a)} coordinates"


@case("as with points", "ours")
def mot_with_decimal_commas():
    folder = CASES / "states-file-paths"
    lines = (folder / "ok.mot").read_text().splitlines()
    head = lines.index("endheader")
    a = ranges(written("comma.mot", "\n".join([*lines[: head + 2], *(line.replace(".", ",") for line in lines[head + 2 :])]) + "\n"), folder / "base.osim")
    b = ranges(folder / "ok.mot", folder / "base.osim")
    if isinstance(a, str) or isinstance(b, str):
        return False, str(a)
    return a == b, f"{len(a)} coordinates"


@case("a lost frame of a rigid body is missing, not at the origin", "ours")
def qtm_6d_with_lost_frames():
    lines = (CASES / "qtm-6d" / "qtm_6d.tsv").read_text().splitlines()
    first = next(i for i, line in enumerate(lines) if line.startswith("stick X")) + 1
    cells_of = lines[first + 5].split("\t")
    lines[first + 5] = "\t".join(["0.000", "0.000", "0.000", *["0.000"] * (len(cells_of) - 3)])
    read = positions(written("lost.tsv", "\n".join(lines) + "\n"))
    if isinstance(read, str):
        return False, read
    return read["stick"][5] is None and read["stick"][4] is not None, f"frame 6: {read['stick'][5]}"


@case("the second person's own columns", "ours")
def dlc_person_2():
    folder = CASES / "dlc-multi-animal-csv"
    done = run("ik", "--estimator", "smoother", "-m", folder / "base.osim", "-t", folder / "base.trc", "-o", HERE / "two.mot", "--force",
               "--rig", folder / "rig.toml", "--images", f"A={folder / 'ma_A.csv'}", "--images", f"B={folder / 'ma_B.csv'}", "--person", 9)  # fmt: skip
    return done.returncode in (2, 3) and ("m1" in done.stderr or "2" in done.stderr), said(done)


@case("offset and first position alike: the positions are the root's own way", "ours")
def bvh_root_that_moves():
    lines = (CASES / "bvh-root-offset" / "root_offset.bvh").read_text().splitlines()
    motion = next(i for i, line in enumerate(lines) if line.startswith("Frame Time")) + 1
    frames = [line.split() for line in lines[motion:] if line.strip()]
    moved = [[str(float(frames[0][0]) + 5.0 * f), *row[1:]] for f, row in enumerate(frames)]
    read = positions(written("moves.bvh", "\n".join([*lines[:motion], *map(" ".join, moved)]) + "\n"))
    if isinstance(read, str):
        return False, read
    way = next(iter(read.values()))
    far = max(abs(x[0] - (1.734 + 0.05 * f)) for f, x in enumerate(way))
    return far < 1e-6, f"{len(way)} frames, {1e3 * far:.2g} mm off"


def changed_trc(source, name, change):
    """A TRC of the cases with each sample changed: change(name of the marker, (x, y, z) in the file's unit)."""
    lines = source.read_text().splitlines()
    names = [n for n in lines[3].split("\t")[2:] if n]
    out = lines[:5]
    for line in lines[5:]:
        row = line.split("\t")
        if len(row) < 3:
            out.append(line)
            continue
        for m, marker in enumerate(names):
            part = row[2 + 3 * m : 5 + 3 * m]
            if len(part) == 3 and all(v.strip() for v in part):
                row[2 + 3 * m : 5 + 3 * m] = [f"{v:.6f}" for v in change(marker, [float(v) for v in part])]
        out.append("\t".join(row))
    return written(name, "\n".join(out) + "\n")


WALK = CASES / "gait-left-right-swapped" / "walk_rot0.trc"


@case("the mirror image is said", "ours")
def gait_one_axis_mirrored():
    done = run("validate", changed_trc(WALK, "mirror.trc", lambda _, x: [x[0], -x[1], x[2]]))
    text = done.stdout + done.stderr
    return done.returncode != 0 and any(w in text for w in ("mirror", "exchanged", "sides")), said(done)


@case("turned by 37 degrees about the vertical: the same speed", "ours")
def gait_of_a_turned_laboratory():
    c, s = math.cos(0.65), math.sin(0.65)

    def turned(_, x):
        return [c * x[0] - s * x[2], x[1], s * x[0] + c * x[2]]  # its y points up

    (_, one), (_, other) = gait(WALK), gait(changed_trc(WALK, "turned.trc", turned))
    if not one.get("gait_speed") or not other.get("gait_speed"):
        return False, "no speed"
    return abs(one["gait_speed"][0] - other["gait_speed"][0]) < 1.0, f"{one['gait_speed'][0]:.1f} and {other['gait_speed'][0]:.1f} mm/s"


@case("feet called metres that are millimetres: nobody's size, said", "ours")
def unit_words_that_are_wrong():
    text = WALK.read_text().replace("\tmm\t", "\tm\t", 1)
    done = run("validate", written("metres.trc", text))
    return done.returncode != 0 and "unit of length" in done.stdout + done.stderr, said(done)


@case("whose feet are taken, by name", "ours")
def gait_of_two_people_without_colons():
    lines = (CASES / "gait-two-people" / "two_people.trc").read_text()
    done, _ = gait(written("underscores.trc", lines.replace("Ann:", "Ann_").replace("Bob:", "Bob_")))
    text = done.stdout + done.stderr
    return done.returncode != 0 or "Bob_R.Heel" in text or "Ann_R.Heel" in text, said(done)


@case("degrees said to be degrees, radians said to be radians: nothing is said", "ours")
def motions_that_are_right():
    folder = CASES / "motion-degrees-called-radians"
    lines = (folder / "ok.mot").read_text().splitlines()
    head = lines.index("endheader")
    names = lines[head + 1].split("\t")
    turned = lambda n, v: v if n == "time" or n.endswith(("_tx", "_ty", "_tz")) else repr(math.radians(float(v)))  # noqa: E731
    rows = ["\t".join(turned(n, v) for n, v in zip(names, line.split("\t"))) for line in lines[head + 2 :]]
    path = written("radians.mot", "\n".join([line.replace("inDegrees=yes", "inDegrees=no") for line in lines[: head + 2]] + rows) + "\n")
    a, b = ranges(path, folder / "base.osim"), ranges(folder / "ok.mot", folder / "base.osim")
    if isinstance(a, str) or isinstance(b, str):
        return False, str(a)
    return max(abs(a[n] - b[n]) for n in b) < 1e-6, f"{len(a)} coordinates the same"


@case("a constant function holds its coordinate", "ours")
def osim_prescribed_by_a_constant():
    folder = CASES / "osim-prescribed-coordinate"
    text = re.sub(r"<Sine.*?</Sine>", "<Constant><value>0.1</value></Constant>", (folder / "prescribed.osim").read_text(), flags=re.S)
    done = run("ik", "-m", written("constant.osim", text), "-t", folder / "prescribed.trc", "-o", HERE / "c.mot", "--force", "--max-rms", "1000")
    if not (HERE / "c.mot").exists():
        return False, said(done)
    q = column(HERE / "c.mot", "hip_rotation")
    return max(abs(math.radians(v) - 0.1) for v in q) < 1e-9, f"{q[0]:.4f} deg"


@case("two points that one model made are no markers", "ours")
def computed_points_beside_markers():
    lines = plain().read_text().splitlines()
    head, rest = lines[:5], lines[5:]
    head[3] = head[3].rstrip("\t") + "\t\t\tLHJC\t\t"
    head[4] = head[4] + "\tX4\tY4\tZ4"
    head[2] = head[2].replace("\t3\t", "\t4\t", 1)
    rows = [line + "\t1.0\t2.0\t3.0" if line.strip() else line for line in rest]
    path = written("computed.trc", "\n".join(head + rows) + "\n")
    facts = json.loads(run("info", path, "--json").stdout)
    done = run("measure", path, "--refits", 0, "--json")
    subjects = {m["subject"] for m in json.loads(done.stdout)["measures"]}
    return facts["computed"] == ["LHJC"] and "LHJC" not in subjects, f"computed {facts['computed']}, measured {sorted(subjects)}"


def main():
    chosen = sys.argv[1:]
    failed = False
    for name, kind, asked, check in CHECKS:
        if chosen and name not in chosen:
            continue
        if not CASES.is_dir():
            print(f"SKIP | case {name} ({kind}) | {asked} | no {CASES.name} beside the recordings", flush=True)
            continue
        try:
            good, seen = check()
        except (KeyError, ValueError, IndexError, OSError, StopIteration) as error:
            good, seen = False, f"{type(error).__name__}: {error}"
        failed = failed or not good
        print(f"{'PASS' if good else 'FAIL'} | case {name} ({kind}) | {asked} | {seen}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
