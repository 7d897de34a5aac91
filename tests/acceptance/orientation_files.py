#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Orientations of a C3D of Theia, of QTM's and Motive's rigid bodies and of OpenSense, converted and read by others.

The C3D is a real one, read by ezc3d; the rigid bodies are turned at random here, written as these programs write them, and read by scipy from the same
text. What `convert` makes of them is read by OpenSim (.sto) and by numpy (.csv): quaternions equal up to their sign, the same samples missing. `ik` takes
each format as it takes the converted one.

Needs Python with ezc3d, opensim, numpy and scipy. Finds the program in KINEMARK_PROGRAM and the models in KINEMARK_TEST_DATA; prints rows
"PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import json
import sys
import tempfile
from pathlib import Path

import rows
from orientations import DATA, SUBJECTS, Subject, read_table, write_quaternions
from rows import exit_status, row

MOST_APART = 1e-7
FRAMES = 200
RATE = 100.0
QTM_COLUMNS = ("X", "Y", "Z", "Roll", "Pitch", "Yaw", "Residual", *(f"Rot[{i}]" for i in range(9)))


def run(folder, *words):
    done = rows.run(*words, folder=folder)
    return done.returncode, done.stdout, done.stderr.strip()[-300:]


def write_qtm(path, names, frames):
    """frames: lists of scipy rotations, None where a body is missing. Six decimals, as QTM writes them."""
    lines = [f"NO_OF_FRAMES\t{len(frames)}", "NO_OF_CAMERAS\t8", f"NO_OF_BODIES\t{len(names)}", f"FREQUENCY\t{RATE:g}", "DATA_INCLUDED\t6D",
             "BODY_NAMES\t" + "\t".join(names), "\t".join(f"{name} {column}" if column == "X" else column for name in names for column in QTM_COLUMNS)]
    for f, one in enumerate(frames):
        cells = []
        for b, rotation in enumerate(one):
            if rotation is None:
                cells += ["0.000"] * 3 + ["0"] * 3 + ["-1.000"] + ["0.000000"] * 9
            else:
                axes = rotation.as_matrix().T.ravel()  # column after column
                cells += [f"{100 + f:.3f}", f"{200 + 10 * b:.3f}", "900.000", *(f"{a:.3f}" for a in rotation.as_euler("XYZ", degrees=True)), "0.412", *(f"{v:.6f}" for v in axes)]
        lines.append("\t".join(cells))
    path.write_text("\n".join(lines) + "\n")


def read_qtm(path, count):
    import numpy

    rows = [line.split("\t") for line in path.read_text().splitlines()[7:]]
    values = numpy.array([[float(cell) for cell in cells] for cells in rows]).reshape(len(rows), count, len(QTM_COLUMNS))
    return quaternions_of(values[:, :, 7:].reshape(len(rows), count, 3, 3).transpose(0, 1, 3, 2), (values[:, :, :3] == 0).all(axis=2))


def write_motive(path, names, frames):
    head = ["Type", "Name", "ID"]
    columns = [(name, part, axis) for name in names for part, axes in (("Rotation", "XYZW"), ("Position", "XYZ")) for axis in axes]
    lines = [f"Format Version,1.23,Take Name,swing,Capture Frame Rate,{RATE:.6f},Export Frame Rate,{RATE:.6f},Total Exported Frames,{len(frames)},Rotation Type,Quaternion,Length Units,Meters", ""]
    lines.append("," + ",".join([head[0], *("Rigid Body" for _ in columns)]))
    lines.append("," + ",".join([head[1], *(name for name, _, _ in columns)]))
    lines.append("," + ",".join([head[2], *(str(names.index(name) + 1) for name, _, _ in columns)]))
    lines.append(",," + ",".join(part for _, part, _ in columns))
    lines.append("Frame,Time (Seconds)," + ",".join(axis for _, _, axis in columns))
    for f, one in enumerate(frames):
        cells = [str(f), f"{f / RATE:.6f}"]
        for rotation in one:
            cells += [""] * 7 if rotation is None else [*(f"{v:.6f}" for v in rotation.as_quat()), "1.000000", "0.900000", "-0.200000"]
        lines.append(",".join(cells))
    path.write_text("\n".join(lines) + "\n")


def read_motive(path, count):
    import numpy

    rows = [line.split(",")[2:] for line in path.read_text().splitlines()[7:]]
    values = numpy.array([[float(cell) if cell else numpy.nan for cell in cells] for cells in rows]).reshape(len(rows), count, 7)[:, :, [3, 0, 1, 2]]
    return values / numpy.linalg.norm(values, axis=2, keepdims=True)


def quaternions_of(matrices, missing):
    """frames x bodies x w x y z of matrices; NaN where missing. The nearest rotation, by singular values."""
    import numpy
    from scipy.spatial.transform import Rotation

    out = numpy.full((*missing.shape, 4), numpy.nan)
    u, _, v = numpy.linalg.svd(matrices[~missing])
    out[~missing] = Rotation.from_matrix(u @ v).as_quat()[:, [3, 0, 1, 2]]
    return out


def read_theia(path):
    import ezc3d
    import numpy

    c3d = ezc3d.c3d(str(path))
    data = numpy.asarray(c3d["data"]["rotations"])  # 4 x 4 x segments x frames
    matrices = data[:3, :3].transpose(3, 2, 0, 1)
    return quaternions_of(matrices, ~numpy.isfinite(matrices).all(axis=(2, 3)))


def read_sto(opensim, path):
    import numpy

    table = opensim.TimeSeriesTableQuaternion(str(path))
    out = numpy.full((table.getNumRows(), table.getNumColumns(), 4), numpy.nan)
    for r in range(table.getNumRows()):
        one = table.getRowAtIndex(r)
        for s in range(table.getNumColumns()):
            q = one.getElt(0, s)
            out[r, s] = [q.get(k) for k in range(4)]
    return numpy.array(table.getIndependentColumn()), out


def read_csv(path):
    import numpy

    table = numpy.genfromtxt(path, delimiter=",", skip_header=1)
    return table[:, 0], table[:, 1:].reshape(len(table), -1, 4)


def apart(one, other):
    """Largest difference of two sets of quaternions up to their sign, and whether the same ones are missing."""
    import numpy

    if one.shape != other.shape:
        return numpy.inf, False
    gone = numpy.isnan(one).any(axis=2), numpy.isnan(other).any(axis=2)
    a, b = one[~gone[0] & ~gone[1]], other[~gone[0] & ~gone[1]]
    sign = numpy.sign((a * b).sum(axis=1, keepdims=True))
    return abs(a - sign * b).max(), bool((gone[0] == gone[1]).all())


def check_file(opensim, folder, name, file, expected, rate, first_s):
    import numpy

    status, shown, said = run(folder, "info", file, "--json")
    facts = json.loads(shown) if status == 0 else {}
    sensors = facts.get("orientations", facts.get("sensors", []))
    missing = int(numpy.isnan(expected).any(axis=2).sum())
    stated = facts.get("orientation_rate_hz", facts.get("rate_hz")), len(sensors), sum(s["missing"] for s in sensors)
    row(stated == (rate, expected.shape[1], missing), f"{name}: info", f"{rate:g} Hz, {expected.shape[1]} of them, {missing} missing", f"{stated} {said if status else ''}")
    for ending in ("sto", "csv"):
        status, _, said = run(folder, "convert", file, f"out.{ending}", "--orientations", "--force")
        if status != 0:
            row(False, f"{name}: convert to .{ending}", "written", said)
            continue
        time, found = read_sto(opensim, folder / "out.sto") if ending == "sto" else read_csv(folder / "out.csv")
        off, same = apart(expected, found)
        clock = abs(time - (first_s + numpy.arange(len(time)) / rate)).max()
        row(off <= MOST_APART and same and clock < 1e-8, f"{name}: .{ending} read by {'OpenSim' if ending == 'sto' else 'numpy'}",
            f"equal to {MOST_APART:g}, the same missing", f"{off:.1e}, {'the same' if same else 'others'} missing, times to {clock:.0e} s")


def main():
    try:
        import ezc3d  # noqa: F401
        import numpy
        import opensim
        from scipy.spatial.transform import Rotation
    except ImportError as error:
        print(f"SKIP | files of orientations | - | {error.name} is not installed (tools/setup --oracles)")
        return 0
    if not DATA.is_dir():
        print(f"SKIP | files of orientations | - | NO REAL DATA: {DATA} is not there; set KINEMARK_TEST_DATA")
        return 0
    opensim.Logger.setLevelString("Error")
    draw = numpy.random.default_rng(6420001)
    theia = DATA / "ezc3d-testFiles" / "C3DRotationExample.c3d"
    names = ["stick", "hand", "chair"]
    start = Rotation.random(len(names), random_state=7)
    frames = [[start[b] * Rotation.from_rotvec(0.02 * f * numpy.array([1.0, b, 0.3])) for b in range(len(names))] for f in range(FRAMES)]
    for f, b in zip(draw.integers(1, FRAMES - 1, 25), draw.integers(0, len(names), 25)):
        frames[f][b] = None
    with tempfile.TemporaryDirectory(prefix="kinemark-accept-") as scratch:
        folder = Path(scratch)
        check_file(opensim, folder, "C3D of Theia", theia, read_theia(theia), 85.0, 0.0)
        write_qtm(folder / "bodies.tsv", names, frames)
        check_file(opensim, folder, "QTM 6D", "bodies.tsv", read_qtm(folder / "bodies.tsv", len(names)), RATE, 0.0)
        write_motive(folder / "bodies.csv", names, frames)
        check_file(opensim, folder, "Motive", "bodies.csv", read_motive(folder / "bodies.csv", len(names)), RATE, 0.0)
        whole = [[r if r is not None else start[b] for b, r in enumerate(one)] for one in frames]
        write_quaternions(folder / "sense.sto", [f / RATE for f in range(FRAMES)], names, whole)
        check_file(opensim, folder, "OpenSense", "sense.sto", read_sto(opensim, folder / "sense.sto")[1], RATE, 0.0)
        status, _, said = run(folder, "convert", "bodies.tsv", "bodies.trc", "--orientations")
        row(status == 2 and ".sto (OpenSense" in said and ".csv" in said, "orientations as .trc", "refused with the formats that have them", said.splitlines()[-1])

        subject, model, motion, bodies = SUBJECTS[0]
        walk = Subject(opensim, DATA / model, next(DATA.glob(motion)), bodies, 1.0, 11, frames=60)
        for name, poses in (("pose", walk.pose), ("walk", walk.recording)):
            write_qtm(folder / f"{name}.tsv", walk.sensors, poses)
            write_motive(folder / f"{name}.csv", walk.sensors, poses)
        angles = {}
        for ending in ("tsv", "csv"):
            run(folder, "convert", f"walk.{ending}", f"{ending}_walk.sto", "--orientations")
            run(folder, "convert", f"pose.{ending}", f"{ending}_pose.sto", "--orientations")
            for kind, files in (("", (f"walk.{ending}", f"pose.{ending}")), (" converted", (f"{ending}_walk.sto", f"{ending}_pose.sto"))):
                status, _, said = run(folder, "ik", "-m", DATA / model, "--orientations", files[0], "--calibration", files[1], "--up", "z", "-o", "q.mot", "--force")
                angles[ending + kind] = read_table(folder / "q.mot")[1] if status in (0, 1) else said
            one, other = angles[ending], angles[f"{ending} converted"]
            off = numpy.inf if isinstance(one, str) or isinstance(other, str) else abs(one - other).max()
            row(off <= 1e-6, f"ik from .{ending} and from the .sto made of it", "the same angles to 1e-6 deg", f"{off:.1e} {one if isinstance(one, str) else ''}")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
