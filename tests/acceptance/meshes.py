#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Meshes of an .osim from the command line to the page: 2,000 frames of the simulated person, every body a bone of 20,000 triangles.

Bones are made here, as long as the bodies, in the three formats that OpenSim reads. The page is compared with what
the model's file and `convert` say of each body. Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import base64
import json
import math
import os
import re
import struct
import sys
import tempfile
import zlib
from pathlib import Path

from rows import exit_status, row, run

PROGRAM = Path(os.environ.get("KINEMARK_PROGRAM", "build/release/bin/kinemark")).resolve()
AROUND, ACROSS = 100, 100


def bone(way):
    """A shaft from the origin along `way`, thicker at both ends: points and triangles."""
    length = math.hypot(*way)
    along = [v / length for v in way]
    aside = [0.0, 0.0, 1.0] if abs(along[2]) < 0.8 else [1.0, 0.0, 0.0]
    cross = lambda a, b: [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    u = cross(along, aside)
    size = math.hypot(*u)
    u = [v / size for v in u]
    v = cross(along, u)
    points, faces = [], []
    for i in range(ACROSS):
        s = i / (ACROSS - 1)
        r = length * (0.05 + 0.07 * (2 * s - 1) ** 6) * math.sqrt(max(0.0, 1 - (2 * s - 1) ** 30))
        for k in range(AROUND):
            t = 2 * math.pi * k / AROUND
            points.append([s * way[n] + r * (math.cos(t) * u[n] + math.sin(t) * v[n]) for n in range(3)])
    for i in range(ACROSS - 1):
        for k in range(AROUND):
            a, b = i * AROUND + k, i * AROUND + (k + 1) % AROUND
            faces += [(a, b, b + AROUND), (a, b + AROUND, a + AROUND)]
    return points, faces


def vtp(points, faces):
    def array(kind, name, values):
        return f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="3" format="ascii">{" ".join(values)}</DataArray>'

    corners = array("Int32", "connectivity", [str(c) for f in faces for c in f]) + array("Int32", "offsets", [str(3 * i + 3) for i in range(len(faces))])
    positions = array("Float32", "Points", [f"{v:.6g}" for p in points for v in p])
    return (
        f'<VTKFile type="PolyData"><PolyData><Piece NumberOfPoints="{len(points)}" NumberOfPolys="{len(faces)}">'
        f"<Points>{positions}</Points><Polys>{corners}</Polys></Piece></PolyData></VTKFile>"
    ).encode()


def stl(points, faces):
    body = b"".join(struct.pack("<12fH", 0, 0, 0, *points[a], *points[b], *points[c], 0) for a, b, c in faces)
    return b" " * 80 + struct.pack("<I", len(faces)) + body


def obj(points, faces):
    return ("".join("v {:.6g} {:.6g} {:.6g}\n".format(*p) for p in points) + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in faces)).encode()


def with_bones(model, folder):
    """The model with a mesh on each body that has a mass; how many."""
    folder.mkdir()
    text = model.read_text(encoding="utf-8")
    count = 0

    def add(match):
        nonlocal count
        centre = [float(v) for v in re.search(r"<mass_center>([^<]*)</mass_center>", match[0])[1].split()]
        if float(re.search(r"<mass>([^<]*)</mass>", match[0])[1]) <= 0 or math.hypot(*centre) < 0.01:
            return match[0]
        ending, write = ((".vtp", vtp), (".stl", stl), (".obj", obj))[count % 3]
        (folder / f"{match[1]}{ending}").write_bytes(write(*bone([2 * v for v in centre])))
        count += 1
        mesh = f'<attached_geometry><Mesh name="m"><socket_frame>..</socket_frame><scale_factors>1 1 1</scale_factors><mesh_file>{match[1]}{ending}</mesh_file></Mesh></attached_geometry>'
        return match[0].replace("</Body>", mesh + "</Body>")

    text = re.sub(r'<Body name="([^"]*)">.*?</Body>', add, text, flags=re.DOTALL)
    model.write_text(text, encoding="utf-8")
    return count


def scene_of(page):
    text = re.search(r'id="kinemark-data">(.*?)</script>', page.read_text(encoding="utf-8"), re.DOTALL)[1]
    return json.loads(text.replace("\\u003c", "<"))["scene"]


def series(packed):
    raw = zlib.decompress(base64.b64decode(packed["data"]))
    count = packed["series"] * packed["points"]
    out = []
    for s in range(packed["series"]):
        word, line = 0, []
        for i in range(s * packed["points"], (s + 1) * packed["points"]):
            word = (word + raw[i] + 256 * raw[count + i]) & 0xFFFF
            line.append(packed["offset"][s] + packed["step"][s] * word)
        out.append(line)
    return out


def turned(q, x):
    w, a = q[0], q[1:]
    cross = lambda p, r: [p[1] * r[2] - p[2] * r[1], p[2] * r[0] - p[0] * r[2], p[0] * r[1] - p[1] * r[0]]
    t = [2 * v for v in cross(a, x)]
    u = cross(a, t)
    return [x[k] + w * t[k] + u[k] for k in range(3)]


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run("simulate", "subject", "-o", folder / "in", "--duration", 20, "--rate", 100, "--quiet", good=(0, 1))
        model = folder / "in" / "model.osim"
        bodies = with_bones(model, folder / "bones")
        plain, page = folder / "plain.html", folder / "page.html"
        solve = ("ik", "-m", model, "-t", folder / "in" / "markers.c3d", "-o", folder / "q.mot", "--force", "--quiet")
        run(*solve, "--report", plain, good=(0, 1))
        ran = run(*solve, "--report", page, "--geometry", folder / "bones", good=(0, 1))
        row(ran.stderr.count("\n") < 20, "ik with meshes says nothing new", "no line more", "as before")
        text = page.read_text(encoding="utf-8")
        mb = len(text.encode()) / 1e6
        row(mb <= 1.5, f"page of ik, 2,000 frames, {bodies} bodies with meshes", "<= 1.5 MB", f"{mb:.2f} MB ({len(plain.read_bytes()) / 1e6:.2f} without)")
        scene, without = scene_of(page), scene_of(plain)
        row(scene["frame_step"] == without["frame_step"], "frames that the scene holds", "as many as without meshes", f"every {scene['frame_step']}. of 2,000, {without['frame_step']}. without")
        drawn = scene["bodies"]["meshes"]
        row(len(drawn["body"]) == bodies, "bodies that have a mesh", str(bodies), str(len(drawn["body"])))
        triangles = sum(drawn["triangles"])
        row(9000 <= triangles <= 12_000, "triangles of a page", "9,000 to 12,000", f"{triangles:,} of {bodies * 2 * AROUND * (ACROSS - 1):,}")
        note = without["bodies"]["meshes_note"]
        row("none of the" in note and "--geometry FOLDER" in note, "without the folder, one sentence says where they were looked for", "it does", note[:60])
        judge_positions(scene, drawn)
    return exit_status()


def judge_positions(scene, drawn):
    """The far end of a bone is where the next body begins: between the ends of upper arm and thigh in all frames."""
    names = scene["bodies"]["names"]
    origin, turn, positions = series(scene["bodies"]["origin_m"]), series(drawn["turn"]), series(drawn["positions_m"])
    worst, first = 0.0, {}
    at = 0
    for body, count in zip(drawn["body"], drawn["points"]):
        first[names[body]] = (at, count, drawn["body"].index(body), body)
        at += count
    pairs = [(a, b) for a, b in (("femur_r", "tibia_r"), ("femur_l", "tibia_l"), ("humerus_r", "ulna_r")) if a in first and b in names]
    for upper, lower in pairs:
        begin, count, mesh, body = first[upper]
        points = [[positions[k][i] for k in range(3)] for i in range(begin, begin + count)]
        far = max(points, key=lambda p: math.hypot(*p))
        reach = math.hypot(*far)
        for f in range(0, scene["points"], 97):
            q = [turn[4 * mesh + k][f] for k in range(4)]
            end = [origin[3 * body + k][f] + v for k, v in enumerate(turned(q, far))]
            joint = [origin[3 * names.index(lower) + k][f] for k in range(3)]
            start = [origin[3 * body + k][f] for k in range(3)]
            # Both lie on the line from the body's origin to the next joint, in any posture.
            along = [j - s for j, s in zip(joint, start)]
            cosine = sum(a * (e - s) for a, e, s in zip(along, end, start)) / math.hypot(*along) / reach
            worst = max(worst, math.degrees(math.acos(min(1.0, cosine))))
    row(bool(pairs) and worst <= 12, f"bones of {len(pairs)} limbs point to the next joint in every posture", "<= 12 deg (half their width)", f"{worst:.1f} deg at most")


if __name__ == "__main__":
    sys.exit(main())
