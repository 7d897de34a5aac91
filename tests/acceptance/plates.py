#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Force plates of known truth: 60 C3D files, written here byte by byte, and the forces that `convert FILE.c3d FILE.mot` finds.

    tests/acceptance/plates.py [--seed N] [--files N] [--keep FOLDER]

Plates of types 1 to 7, 11, 12 and 21, turned and anywhere, with ZERO from 0, from 1, of nothing or absent, baselines where it
names frames, polynomials of the centre of pressure for types 3 and 7, origins above and below the surface and beside its
middle, forces of the plate on the body and of the body on the plate, words for units of force, moment and length or none,
lengths in mm, cm and m, samples that are scaled and offset, channels in any order, Intel and MIPS numbers. Types that are not
read must be refused in a sentence that names them, alone or beside a plate that is read. Truth is the sum and moment of forces
of sensors, or of one force at a point: the formulas of the manual (c3d.org) and of Visual3D's pages (type 6), none of kinemark's.
Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import argparse
import math
import os
import random
import struct
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = Path(os.environ.get("KINEMARK_PROGRAM", ROOT / "build/release/bin/kinemark"))
READ, NOT_READ = (1, 2, 3, 4, 6, 7), (5, 11, 12, 21)
CHANNELS = {1: 6, 2: 6, 3: 8, 4: 6, 5: 8, 6: 12, 7: 8, 11: 8, 12: 8, 21: 14}
LENGTHS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
FORCES = {"N": 1.0, "kN": 1e3, "lbf": 4.4482216152605, "kgf": 9.80665, "Newton": 1.0, "dN": 0.1, "": 1.0}
MOMENTS = {"Nmm": 1e-3, "N.mm": 1e-3, "Nm": 1.0, "N.m": 1.0, "Nxm": 1.0, "kN.m": 1e3, "lbf.in": 4.4482216152605 * 0.0254,
           "Newton-meters": 1.0, "kgf.m": 9.80665, "N.cm": 1e-2, "": None}
BLOCKS, FRAMES_EACH, EMPTY = 4, 8, 12  # loads held for so many frames, after frames without any
FORCE_MOST, POINT_MOST_MM, MOMENT_MOST = 1e-6, 0.01, 1e-3


def single(x):
    """The nearest number of single precision: what a file can hold."""
    return struct.unpack("<f", struct.pack("<f", x))[0]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def plus(*vectors):
    return [sum(parts) for parts in zip(*vectors)]


def times(matrix, vector):
    return [sum(m * v for m, v in zip(row, vector)) for row in matrix]


def solve(matrix, right):
    """x of matrix x = right, by elimination."""
    n = len(matrix)
    rows = [list(row) + [r] for row, r in zip(matrix, right)]
    for i in range(n):
        pivot = max(range(i, n), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        for r in range(n):
            if r != i:
                factor = rows[r][i] / rows[i][i]
                rows[r] = [a - factor * b for a, b in zip(rows[r], rows[i])]
    return [row[n] / row[i] for i, row in enumerate(rows)]


class Plate:
    """One plate: where it lies, what loads it, and what its channels hold."""

    def __init__(self, dice, kind, metres, up):
        self.kind, self.metres, self.dice = kind, metres, dice
        self.reversed = dice.random() < 0.25  # stores the force of the body on the plate
        across, along = single(dice.uniform(0.3, 0.6)), single(dice.uniform(0.4, 0.9))
        turn = dice.uniform(-math.pi, math.pi)
        # x and y of the plate lie level, z points down: `up` is 2 (z) or 1 (y).
        level, other = ([1, 0, 0], [0, 1, 0]) if up == 2 else ([1, 0, 0], [0, 0, -1])
        self.x = [math.cos(turn) * a + math.sin(turn) * b for a, b in zip(level, other)]
        self.z = [-1.0 if i == up else 0.0 for i in range(3)]
        self.y = cross(self.z, self.x)
        self.centre = [dice.uniform(-1.5, 1.5) for _ in range(3)]
        self.centre[up] = dice.uniform(-0.05, 0.05)
        self.corners = [self.world([sx * across / 2, sy * along / 2, 0.0]) for sx, sy in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
        self.depth = -single(dice.uniform(0.01, 0.06))
        self.a, self.b = single(0.4 * across), single(0.4 * along)  # of four sensors
        self.beside = [single(dice.uniform(-0.02, 0.02)) for _ in range(2)] if kind in (1, 2, 4) else [0.0, 0.0]
        self.flipped = dice.random() < 0.2
        self.loads = [self.load(across, along) for _ in range(BLOCKS)]
        self.force_unit = dice.choice(list(FORCES))
        self.moment_unit = dice.choice(list(MOMENTS))
        self.polynomial = None
        if kind in (3, 7) and dice.random() < 0.7:
            sizes = (1e-14, 1e-9, 3e-6, 4e-10, 1e-5, 5e-2)
            self.polynomial = [single(dice.uniform(-s, s)) for s in sizes * 2]
        n = CHANNELS[kind]
        self.matrix = None
        if kind in (4, 6, 7):
            # Of a row of moments in their unit: channels are all of one size.
            rows = [0.3 / (MOMENTS[self.moment_unit] or metres) if kind == 4 and i > 2 else 1.0 for i in range(n)]
            self.matrix = [[single(rows[i] * ((dice.uniform(5, 9) if i == j else 0.0) + dice.uniform(-0.1, 0.1)))
                            for j in range(n)] for i in range(n)]
        self.zeros = [0.0] * n  # of the channels when nobody is on the plate, in their own units

    def world(self, p, free=False):
        turned = [p[0] * a + p[1] * b + p[2] * c for a, b, c in zip(self.x, self.y, self.z)]
        return turned if free else plus(self.centre, turned)

    def load(self, across, along):
        """Force on the body (plate axes), the point where it acts on the surface, and the moment about the normal."""
        dice = self.dice
        return ([dice.uniform(-80, 80), dice.uniform(-150, 150), -dice.uniform(150, 1500)],
                [dice.uniform(-0.4, 0.4) * across, dice.uniform(-0.4, 0.4) * along, 0.0], dice.uniform(-15, 15))

    def origin(self):
        """As the file has it, m: the vector from the plate's origin to the middle of its surface, or with its sign reversed."""
        if self.kind in (1, 2, 4):
            vector = [*self.beside, self.depth]
            return [-v for v in vector] if self.flipped else vector
        return [self.a, self.b, -self.depth if self.flipped else self.depth]

    def truth(self, load):
        """Force on the body, point and free moment, world: what is to be found."""
        force, point, twist = load
        if self.polynomial:
            x, y, p = 1e3 * point[0], 1e3 * point[1], self.polynomial
            dx = (p[0] * y**4 + p[1] * y**2 + p[2]) * x**3 + (p[3] * y**4 + p[4] * y**2 + p[5]) * x
            dy = (p[6] * x**4 + p[7] * x**2 + p[8]) * y**3 + (p[9] * x**4 + p[10] * x**2 + p[11]) * y
            # The same moment about the normal through another point.
            twist += 1e-3 * (dx * force[1] - dy * force[0])
            point = [point[0] - 1e-3 * dx, point[1] - 1e-3 * dy, 0.0]
        return self.world(force, free=True), self.world(point), self.world([0.0, 0.0, twist], free=True)

    def channels(self, load):
        """The channels in the units that they state, without their zeros."""
        sign = -1.0 if self.reversed else 1.0
        force, point, twist = [sign * f for f in load[0]], load[1], sign * load[2]
        per_moment = MOMENTS[self.moment_unit] or self.metres
        per_force = FORCES[self.force_unit]
        if self.kind == 1:
            at = [(p + o) / self.metres for p, o in zip(point, self.beside)]
            return [f / per_force for f in force] + at + [twist / per_moment]
        # About the origin of the plate's axes, beneath the surface.
        moment = plus(cross([point[0] + self.beside[0], point[1] + self.beside[1], self.depth], force), [0.0, 0.0, twist])
        if self.kind == 2:
            return [f / per_force for f in force] + [m / per_moment for m in moment]
        if self.kind == 4:
            return solve(self.matrix, force + [m / per_moment for m in moment])
        sensors = self.sensors(force, moment)
        if self.kind == 6:
            return solve(self.matrix, [v for sensor in sensors for v in sensor])
        (x1, y1, z1), (x2, y2, z2), (x3, y3, z3), (x4, y4, z4) = sensors
        eight = [x1 + x2, x3 + x4, y1 + y4, y2 + y3, z1, z2, z3, z4]
        return solve(self.matrix, eight) if self.kind == 7 else [v / per_force for v in eight]

    def sensors(self, force, moment):
        """Forces of sensors at (+a, +b), (-a, +b), (-a, -b), (+a, -b) with that sum and moment, of the many that have it."""
        positions = [[sx * self.a, sy * self.b, 0.0] for sx, sy in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
        forces = [[self.dice.uniform(-20, 20) for _ in range(3)] for _ in positions]
        sums = plus(*forces)
        forces = [plus(f, [(want - have) / 4 for want, have in zip(force, sums)]) for f in forces]
        mx, my, mz = plus(moment, [-v for v in plus(*(cross(p, f) for p, f in zip(positions, forces)))])
        share = mz / (4 * (self.a**2 + self.b**2))
        return [plus(f, [-share * y, share * x, mx / (4 * self.b) * math.copysign(1, y) - my / (4 * self.a) * math.copysign(1, x)])
                for f, (x, y, _) in zip(forces, positions)]

    def units(self):
        if self.kind == 1:
            return [self.force_unit] * 3 + ["", "", self.moment_unit]
        if self.kind == 2:
            return [self.force_unit] * 3 + [self.moment_unit] * 3
        if self.kind == 4:
            return ["V"] * 3 + [self.moment_unit or "V"] * 3
        return [self.force_unit if self.kind == 3 else "V"] * CHANNELS[self.kind]


def parameter(order, group, name, kind, dims, values):
    """A parameter of C3D; `kind` is -1 text, 2 integer, 4 float."""
    if kind == -1:
        width = max([len(v) for v in values] + [1])
        data = "".join(v.ljust(width) for v in values).encode("ascii")
        dims = [width, *dims]
    else:
        data = struct.pack(f"{order}{len(values)}{'h' if kind == 2 else 'f'}", *values)
    body = struct.pack("bB", kind, len(dims)) + bytes(dims) + data + b"\0"
    return struct.pack("bb", len(name), group) + name.encode("ascii") + struct.pack(f"{order}h", len(body) + 2) + body


def written(path, dice, plates, length, mips):
    """One recording of these plates; returns the zeros that ZERO names, in words."""
    order = ">" if mips else "<"
    frames, per_frame = EMPTY + BLOCKS * FRAMES_EACH, dice.choice((1, 2, 5, 10))
    zero = dice.choice((None, (0, 0), (0, EMPTY - 2), (1, EMPTY - 2)))
    metres = LENGTHS[length]
    total = sum(CHANNELS[p.kind] for p in plates) + 3
    positions = list(range(total))
    dice.shuffle(positions)
    taken = iter(positions)
    wiring = [[next(taken) for _ in range(CHANNELS[p.kind])] for p in plates]
    units, scales = ["V"] * total, [1.0] * total
    offsets, general = [dice.choice((0, 100, -7)) for _ in range(total)], single(dice.choice((1.0, 0.5, 1e-3)))
    for plate, channels in zip(plates, wiring):
        for channel, unit in zip(channels, plate.units()):
            units[channel] = unit
        if plate.kind not in READ:
            continue
        for channel, held in zip(channels, zip(*map(plate.channels, plate.loads))):  # some thousand steps
            scales[channel] = single(max(map(abs, held)) / general / dice.uniform(2e3, 2e4))
        if zero and zero[1] > 0:
            plate.zeros = [0.0 if plate.kind == 1 and c in (3, 4) else 0.01 * v
                           for c, v in enumerate(plate.channels(plate.loads[0]))]
    markers = plus(*(p.centre for p in plates))
    markers = [m / len(plates) for m in markers]
    above = [[m / metres - (1.0 / metres) * z for m, z in zip(markers, plates[0].z)]] * 2
    samples = bytearray()
    for frame in range(frames):
        for point in above:
            samples += struct.pack(f"{order}4f", *point, 0.0)
        values = [0.1] * total
        block = (frame - EMPTY) // FRAMES_EACH
        for plate, channels in zip(plates, wiring):
            loads = plate.channels(plate.loads[block]) if block >= 0 and plate.kind in READ else [0.0] * CHANNELS[plate.kind]
            for channel, value, rest in zip(channels, loads, plate.zeros):
                values[channel] = value + rest
        row = struct.pack(f"{order}{total}f", *(v / (s * general) + o for v, s, o in zip(values, scales, offsets)))
        samples += row * per_frame
    rows = max(len(w) for w in wiring)
    size = max([len(p.matrix) for p in plates if p.matrix] + [0])
    listed = lambda each: [v for p in plates for v in each(p)]  # noqa: E731
    matrices = listed(lambda p: [p.matrix[i][j] if p.matrix and i < len(p.matrix) and j < len(p.matrix) else 0.0
                                 for j in range(size) for i in range(size)])
    n = len(plates)
    groups = {
        "POINT": [("USED", 2, [], [2]), ("FRAMES", 2, [], [frames]), ("SCALE", 4, [], [-0.1]), ("RATE", 4, [], [100.0]),
                  ("DATA_START", 2, [], [0]), ("UNITS", -1, [], [length]), ("LABELS", -1, [2], ["HEAD", "NECK"])],
        "ANALOG": [("USED", 2, [], [total]), ("RATE", 4, [], [100.0 * per_frame]), ("GEN_SCALE", 4, [], [general]),
                   ("SCALE", 4, [total], scales), ("OFFSET", 2, [total], offsets), ("UNITS", -1, [total], units),
                   ("LABELS", -1, [total], [f"C{i + 1}" for i in range(total)])],
        "FORCE_PLATFORM": [
            ("USED", 2, [], [n]), ("TYPE", 2, [n], [p.kind for p in plates]),
            ("CHANNEL", 2, [rows, n], [w[r] + 1 if r < len(w) else 0 for w in wiring for r in range(rows)]),
            ("CORNERS", 4, [3, 4, n], listed(lambda p: [v / metres for c in p.corners for v in c])),
            ("ORIGIN", 4, [3, n], listed(lambda p: [v / metres for v in p.origin()]))],
    }
    if zero is not None:
        groups["FORCE_PLATFORM"].append(("ZERO", 2, [2], list(zero)))
    if size:
        groups["FORCE_PLATFORM"].append(("CAL_MATRIX", 4, [size, size, n], matrices))
    if any(p.polynomial for p in plates):
        groups["FORCE_PLATFORM"].append(("FPCOPPOLY", 4, [6, 2, n], listed(lambda p: p.polynomial or [0.0] * 12)))
    body = b""
    for identity, (name, parameters) in enumerate(groups.items(), 1):
        body += struct.pack("bb", len(name), -identity) + name.encode("ascii") + struct.pack(f"{order}h", 3) + b"\0"
        for title, kind, dims, values in parameters:
            body += parameter(order, identity, title, kind, dims, values)
    blocks = -(-(len(body) + 6) // 512)
    marker = body.index(b"DATA_START") + 10
    body = body[:marker + 4] + struct.pack(f"{order}h", blocks + 2) + body[marker + 6:]
    section = (bytes([1, 80, blocks, 86 if mips else 84]) + body).ljust(512 * blocks, b"\0")
    head = struct.pack(f"{order}BB5hf2hf", 2, 80, 2, total * per_frame, 1, frames, 10, -0.1, blocks + 2, per_frame, 100.0)
    path.write_bytes(head.ljust(512, b"\0") + section + bytes(samples))
    return zero


def forces_found(path):
    """({plate: rows of force, point and moment}, exit status, what was said)."""
    table = path.with_suffix(".mot")
    done = subprocess.run([PROGRAM, "convert", path, table, "--force"], capture_output=True, text=True, check=False)
    said = done.stdout + done.stderr
    if done.returncode != 0:
        return {}, done.returncode, said
    lines = table.read_text(encoding="utf-8").splitlines()
    lines = lines[lines.index("endheader") + 1:]
    numbers = [[float(v) for v in line.split("\t")] for line in lines[1:] if line]
    count = (len(lines[0].split("\t")) - 1) // 9
    return {p: [row[1 + 9 * p:10 + 9 * p] for row in numbers] for p in range(count)}, 0, said


def distance(a, b):
    return math.dist(a, b)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seed", type=int, default=31)
    parser.add_argument("--files", type=int, default=60)
    parser.add_argument("--keep", help="a folder for the files")
    options = parser.parse_args()
    dice = random.Random(options.seed)
    worst = {"force": 0.0, "point": 0.0, "moment": 0.0}
    plates_compared, refused, wrong = 0, 0, []
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        folder = Path(options.keep or scratch)
        folder.mkdir(exist_ok=True)
        for number in range(options.files):
            length, up = dice.choice(list(LENGTHS)), dice.choice((1, 2))
            unread = NOT_READ[number // 5 % len(NOT_READ)] if number % 5 == 4 else None
            kinds = [unread] if unread else []
            if not unread or number % 10 == 9:
                kinds += [READ[number % len(READ)]] + ([dice.choice(READ)] if dice.random() < 0.3 else [])
            plates = [Plate(dice, kind, LENGTHS[length], up) for kind in kinds]
            path = folder / f"plates{number:02}.c3d"
            written(path, dice, plates, length, dice.random() < 0.25)
            found, status, said = forces_found(path)
            name = f"{path.name} (types {kinds})"
            if unread:
                refused += 1
                sentence = f"force plate 1 is left out: it is of type {unread}; forces are read from types"
                if sentence not in said or (status == 0) != (len(kinds) > 1):
                    wrong.append(f"{name}: exit status {status}, {said.strip()[:200]!r}")
            expected = [p for p in plates if p.kind in READ]
            if len(found) != len(expected) or "no unit" in said:
                wrong.append(f"{name}: {len(found)} plates of {len(expected)}, {said.strip()[:300]!r}")
                continue
            for at, plate in enumerate(expected):
                plates_compared += 1
                before = dict(worst)
                for block, load in enumerate(plate.loads):
                    force, point, moment = plate.truth(load)
                    for frame in range(EMPTY + block * FRAMES_EACH + 1, EMPTY + (block + 1) * FRAMES_EACH - 1):
                        row = found[at][frame]
                        worst["force"] = max(worst["force"], distance(row[:3], force) / distance(force, [0, 0, 0]))
                        worst["point"] = max(worst["point"], 1e3 * distance(row[3:6], point))
                        worst["moment"] = max(worst["moment"], distance(row[6:], moment))
                if worst["force"] > FORCE_MOST or worst["point"] > POINT_MOST_MM or worst["moment"] > MOMENT_MOST:
                    wrong.append(f"{name}, plate {at + 1} of type {plate.kind}: {worst}; {said.strip()[:400]!r}")
                    worst = before
    for line in wrong:
        print("  " + line)
    good = not wrong
    print(f"{'PASS' if good else 'FAIL'} | force plates of known truth, {options.files} generated C3D: types 1-4, 6, 7; units, ZERO, origins, polynomials "
          f"| force within {FORCE_MOST:g} of it, centre of pressure {POINT_MOST_MM:g} mm, moment {MOMENT_MOST:g} N m; types {', '.join(map(str, NOT_READ))} "
          f"refused by name | {plates_compared} plates: {worst['force']:.1e}, {worst['point']:.4f} mm, {worst['moment']:.1e} N m; {refused} with types not read; "
          f"{len(wrong)} wrong")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
