# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""MAT and C3D files made byte by byte, for checks that know what is in them."""

import struct

from cases import HERE
from plates import parameter


def element(kind, data):
    return struct.pack("<II", kind, len(data)) + data + b"\0" * (-len(data) % 8)


def matrix(name, kind, dims, content):
    body = element(6, struct.pack("<II", kind, 0)) + element(5, struct.pack(f"<{len(dims)}i", *dims)) + element(1, name.encode()) + content
    return struct.pack("<II", 14, len(body)) + body


def doubles(name, dims, values):
    return matrix(name, 6, dims, element(9, struct.pack(f"<{len(values)}d", *values)))


def words(name, text):
    return matrix(name, 4, (1, len(text)), element(16, text.encode()))


def mat(name, *variables):
    (HERE / name).write_bytes(b"MATLAB 5.0 MAT-file".ljust(124) + b"\0\1IM" + b"".join(variables))
    return HERE / name


def c3d(name, points, analog, labels, units, per_frame, platform=(), length="mm"):
    """A file of points (frames of lists of x, y, z) and analog samples (rows), both in the units that it states."""
    frames, count, channels = len(analog) // per_frame, len(points[0]) if points else 0, len(labels)
    groups = {
        "POINT": [("USED", 2, [], [count]), ("FRAMES", 2, [], [frames]), ("SCALE", 4, [], [-0.1]), ("RATE", 4, [], [100.0]), ("DATA_START", 2, [], [0]),
                  ("UNITS", -1, [], [length]), ("LABELS", -1, [count], [f"M{m + 1}" for m in range(count)])],
        "ANALOG": [("USED", 2, [], [channels]), ("RATE", 4, [], [100.0 * per_frame]), ("GEN_SCALE", 4, [], [1.0]), ("SCALE", 4, [channels], [1.0] * channels),
                   ("OFFSET", 2, [channels], [0] * channels), ("UNITS", -1, [channels], units), ("LABELS", -1, [channels], labels)],
    }  # fmt: skip
    if platform:
        groups["FORCE_PLATFORM"] = list(platform)
    body = b""
    for identity, (group, parameters) in enumerate(groups.items(), 1):
        body += struct.pack("bb", len(group), -identity) + group.encode() + struct.pack("<h", 3) + b"\0"
        for title, kind, dims, values in parameters:
            if kind != -1 or values and any(values):
                body += parameter("<", identity, title, kind, dims, values)
    blocks = -(-(len(body) + 6) // 512)
    at = body.index(b"DATA_START") + 10
    body = body[: at + 4] + struct.pack("<h", blocks + 2) + body[at + 6 :]
    section = (bytes([1, 80, blocks, 84]) + body).ljust(512 * blocks, b"\0")
    head = struct.pack("<BB5hf2hf", 2, 80, count, channels * per_frame, 1, frames, 10, -0.1, blocks + 2, per_frame, 100.0).ljust(512, b"\0")
    samples = b"".join(b"".join(struct.pack("<4f", *p, 0.0) for p in (points[f] if points else ())) +
                       b"".join(struct.pack(f"<{channels}f", *row) for row in analog[f * per_frame : (f + 1) * per_frame]) for f in range(frames))  # fmt: skip
    (HERE / name).write_bytes(head + section + samples)
    return HERE / name
