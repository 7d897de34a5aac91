#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Groups of parameters of real C3D files that kinemark does not read, before and after `kinemark convert`, by a parser of
its own: names, locks, descriptions, types, sizes and values as bytes; and the parameters that it does not read of groups that it
writes anew. Which groups are not carried: docs/formats/c3d.md.

    c3d_whole.py

Needs KINEMARK_PROGRAM and KINEMARK_TEST_DATA. Prints rows "PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when
one fails.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

from rows import exit_status, row

NOT_CARRIED = {"EVENTS", "ROTATION", "KINEMARK"}
WRITTEN_ANEW = {  # and what of them is read into the trial or tells how this file stores its numbers
    "POINT": "USED FRAMES LONG_FRAMES FRAME SCALE RATE DATA_START UNITS LABELS DESCRIPTIONS TYPE_GROUPS ANGLES FORCES MOMENTS "
    "POWERS SCALARS MODELED_MARKERS RESIDUALS_GIVEN",
    "ANALOG": "USED RATE GEN_SCALE SCALE OFFSET OFFSETS LABELS UNITS DESCRIPTIONS FORMAT BITS GAIN RATIO",
    "FORCE_PLATFORM": "USED TYPE ZERO CORNERS ORIGIN CHANNEL CAL_MATRIX FPCOPPOLY",
    "EVENT": "USED TIMES LABELS CONTEXTS DESCRIPTIONS SUBJECTS ICON_IDS GENERIC_FLAGS",
    "TRIAL": "ACTUAL_START_FIELD ACTUAL_END_FIELD",
}
UNITS_OF_CHANNELS = {f"{kind}_UNITS" for kind in ("ANGLE", "FORCE", "MOMENT", "POWER", "SCALAR", "MODELED_MARKER")}
INTEL, DEC, MIPS = 84, 85, 86
LARGEST = 32_000  # bytes of the groups that a copy carries


def ieee(value, processor):
    """Four bytes of a number in Intel order; a DEC number is a quarter of what its bits say."""
    if processor == MIPS:
        return value[::-1]
    bits = int.from_bytes(value[2:] + value[:2], "little")
    exponent = bits >> 23 & 0xFF
    if exponent > 2:
        return (bits - (2 << 23)).to_bytes(4, "little")
    return b"\0\0\0\0" if exponent == 0 and not bits >> 31 else None


def intel(kind, values, processor):
    if processor == INTEL or abs(kind) == 1 or (kind == 2 and processor == DEC):
        return values
    if kind == 2:
        return b"".join(values[i : i + 2][::-1] for i in range(0, len(values), 2))
    return [ieee(values[i : i + 4], processor) for i in range(0, len(values), 4)] if processor == DEC else b"".join(
        ieee(values[i : i + 4], processor) for i in range(0, len(values), 4))


def parameter(body, processor):
    """Type, sizes, values and description; None when it is cut short or of an unknown type."""
    kind = int.from_bytes(body[:1], "little", signed=True)
    if len(body) < 2 or kind not in (-1, 1, 2, 4) or len(body) < 2 + body[1]:
        return None
    dims = tuple(body[2 : 2 + body[1]])
    size = abs(kind)
    for d in dims:
        size *= d
    values, rest = body[2 + len(dims) :][:size], body[2 + len(dims) + size :]
    if len(values) < size:
        return None
    values = intel(kind, values, processor)
    return kind, dims, b"".join(v or b"\0\0\0\0" for v in values) if isinstance(values, list) else values, rest[1 : 1 + rest[0]] if rest else b""


def groups(path):
    """Name of each group to (name as stored, lock, description, parameters), in the order of the file."""
    raw = path.read_bytes()
    at = 512 * (max(1, *raw[:1]) - 1) if raw else 0
    if at == 0 or len(raw) < at + 4 or raw[at + 3] not in (INTEL, DEC, MIPS):
        return []
    processor = raw[at + 3]
    begin = 512 * (max(1, int.from_bytes(raw[16:18], "big" if processor == MIPS else "little")) - 1)
    raw = raw[: begin if begin > at else at + 512 * raw[at + 2]]
    at += 4
    heads, parameters = {}, {}
    while at + 2 <= len(raw):
        length, number = (int.from_bytes(raw[i : i + 1], "little", signed=True) for i in (at, at + 1))
        pointer_at = at + 2 + abs(length)
        if length == 0 or pointer_at + 2 > len(raw):
            break
        name = raw[at + 2 : pointer_at]
        pointer = int.from_bytes(raw[pointer_at : pointer_at + 2], "big" if processor == MIPS else "little")
        end = pointer_at + pointer if pointer else len(raw)
        body = raw[pointer_at + 2 : end]
        if number < 0:
            heads.setdefault(-number, (name, length < 0, body[1 : 1 + body[0]] if body else b""))
        elif (read := parameter(body, processor)) is not None:
            parameters.setdefault(number, []).append((name, length < 0, *read))
        if pointer == 0:
            break
        at = end
    return [(*head, parameters.get(number, [])) for number, head in heads.items()]


def plain(name):
    return name.decode("latin-1").strip().upper()


def parameters_carried(name, parameters):
    """Of a group that is written anew: what neither the trial holds nor the way of storing decides, with its bytes."""
    own = set(WRITTEN_ANEW[name].split())
    if name == "POINT":
        # A copy writes the units of the kinds of points that it has; these are compared by tests/acceptance/channels.py.
        own |= UNITS_OF_CHANNELS
    return [p for p in parameters if plain(p[0]).rstrip("0123456789") not in own]


def carried(path):
    found = []
    for group in groups(path):
        name = plain(group[0])
        if name in NOT_CARRIED:
            continue
        if name == "MANUFACTURER" and [plain(p[0]) for p in group[3]] == ["SOFTWARE"] and b"kinemark" in group[3][0][4]:
            continue  # who wrote the copy of a file that does not say who recorded it
        if name not in WRITTEN_ANEW:
            found.append(group)
        elif rest := parameters_carried(name, group[3]):
            found.append((name.encode(), False, b"", sorted(rest)))
    return sorted(found)


def bytes_of(found):
    return sum(8 + len(g[0]) + len(g[2]) + sum(8 + len(p[0]) + len(p[3]) + len(p[4]) + len(p[5]) for p in g[3]) for g in found)


def main():
    program = os.environ.get("KINEMARK_PROGRAM", "build/release/bin/kinemark")
    data = Path(os.environ.get("KINEMARK_TEST_DATA", "../shared/data"))
    files = sorted(path for path in data.rglob("*") if path.suffix.lower() == ".c3d")
    if not files:
        print("SKIP | C3D to C3D | files | none in KINEMARK_TEST_DATA")
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        for path in files:
            name, copy = path.relative_to(data), Path(scratch) / "copy.c3d"
            run = subprocess.run([program, "convert", path, copy, "--force"], capture_output=True, text=True, timeout=300)
            if path.stat().st_size == 0:
                row(run.returncode == 3, f"{name}: an empty file", "refused, status 3", f"status {run.returncode}")
                continue
            if run.returncode != 0:
                row(False, f"{name}: converted", "status 0", f"status {run.returncode}")
                continue
            before, after = carried(path), carried(copy)
            if bytes_of(before) > LARGEST:
                row("too large to be carried" in run.stdout + run.stderr, f"{name}: too large", "said", f"{bytes_of(before)} bytes")
                continue
            row(after == before, f"{name}: groups carried", f"{len(before)} groups, {sum(len(g[3]) for g in before)} parameters",
                f"{sum(g in after for g in before)} the same of {len(after)}")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
