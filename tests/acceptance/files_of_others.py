#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Files of other programs that kinemark only reads, against what unrelated programs make of the same: PhaseSpace's CSV read by pandas,
Vicon's VSK by xml.etree, MCAP written by the mcap package. The samples are those of real recordings, PhaseSpace's own among them.

Needs Python with ezc3d, mcap, numpy and pandas. Finds the program in KINEMARK_PROGRAM and the recordings in KINEMARK_TEST_DATA; prints
rows "PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import json
import os
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import ezc3d
import numpy
import pandas
from mcap.writer import CompressionType, Writer

from rows import exit_status, row, run

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared" / "data"))
PHASESPACE = DATA / "c3d-org" / "sample20" / "phasespace_sample.c3d"
WALK = DATA / "pycgm-rom" / "Sample_Static.c3d"
SUBJECT = DATA / "pycgm-rom" / "Sample_SM.vsk"
MARKERS = 40


def read_by_us(path, scratch):
    """(names, frames x markers x 3 in metres, rate in Hz) of the CSV that kinemark makes of a file."""
    out = scratch / "ours.csv"
    done = run("convert", "--quiet", "--force", path, out)
    if done.returncode:
        return [], numpy.zeros((0, 0, 3)), done.stderr.strip()
    table = pandas.read_csv(out)
    names = list(dict.fromkeys(table["marker"]))
    frames = table["frame"].nunique()
    x = table[["x_m", "y_m", "z_m"]].to_numpy().reshape(frames, len(names), 3)
    times = table["time_s"].to_numpy()[:: len(names)]
    return names, x, (frames - 1) / (times[-1] - times[0])


def same(a, b):
    """(largest difference, whether the same samples are missing)."""
    if a.shape != b.shape or not a.size:
        return numpy.inf, False
    gone = numpy.isnan(a).any(axis=2)
    return float(numpy.nan_to_num(a - b).__abs__().max()), bool((gone == numpy.isnan(b).any(axis=2)).all())


def judge_phasespace(scratch):
    data = PHASESPACE.read_bytes()  # no parameters, which ezc3d needs: floats from the block that the header names
    head = numpy.frombuffer(data, "<u2", 10)
    samples = numpy.frombuffer(data, "<f4", int(head[1]) * int(head[4]) * 4, 512 * (int(head[8]) - 1))
    samples = samples.reshape(int(head[4]), int(head[1]), 4).astype(float)
    x, gone = samples[:, :, :3], samples[:, :, 3] < 0  # mm
    cells = [numpy.arange(len(x)) / 30.0]
    for m in range(x.shape[1]):
        condition = numpy.where(gone[:, m], -1, 4)
        cells += [condition, *numpy.nan_to_num(x[:, m]).T]
    path = scratch / "phasespace.csv"
    frame = pandas.DataFrame(numpy.array(cells).T)
    whole = {c: "int64" for c in frame.columns if c % 4 == 1}
    frame.astype(whole).to_csv(path, header=False, index=False)
    judged = pandas.read_csv(path, header=None).to_numpy()[:, 1:].reshape(len(x), -1, 4)
    wanted = numpy.where(judged[:, :, :1] > 0, judged[:, :, 1:] / 1000.0, numpy.nan)
    names, ours, rate = read_by_us(path, scratch)
    worst, missing = same(wanted, ours)
    row(worst <= 1e-12 and missing, f"PhaseSpace CSV of a PhaseSpace recording, {x.shape[1]} markers, {len(x)} frames: as pandas reads it",
        "<= 1e-12 m, the same samples missing", f"{worst:.1e} m, {int(gone.sum())} missing{'' if missing else ': not the same'}")
    row(not isinstance(rate, str) and abs(rate - 30.0) < 1e-6, "PhaseSpace CSV: rate", "30 Hz", f"{rate}")


def judge_vsk():
    """Every segment, marker and measure of the file."""
    root = ElementTree.parse(SUBJECT).getroot()
    parents = {child: node for node in root.iter("Segment") for child in node.findall("Segment")}
    wanted = [(s.get("NAME"), parents[s].get("NAME") if s in parents else None,
               [m.get("NAME") for m in root.iter("Marker") if m.get("SEGMENT") == s.get("NAME")]) for s in root.iter("Segment")]
    found = json.loads(run("info", "--json", SUBJECT).stdout)
    ours = [(s["name"], s["parent"], s["markers"]) for s in found["segments"]]
    row(ours == wanted, "VSK: segments, parents and markers, as xml.etree finds them", f"{len(wanted)} the same",
        f"{sum(a == b for a, b in zip(ours, wanted))} of {len(ours)}")
    scale = {"length": 1e-3}
    measures = {p.get("NAME"): float(p.get("VALUE")) * scale.get(p.get("QUANTITY"), 1.0) if p.get("VALUE") else None
                for p in root.find("Parameters")}
    off = [p["name"] for p in found["parameters"] if (p["value"] is None) != (measures[p["name"]] is None)
           or (p["value"] is not None and abs(p["value"] - measures[p["name"]]) > 1e-12)]
    row(not off and len(found["parameters"]) == len(measures), "VSK: measures", f"{len(measures)} the same",
        f"{len(found['parameters']) - len(off)}{': not ' + off[0] if off else ''}")
    row(found["sticks"] == len(root.findall(".//Stick")), "VSK: sticks", f"{len(root.findall('.//Stick'))}", f"{found['sticks']}")


def stamp(frame, rate):
    nanoseconds = round(1e9 * frame / rate)
    return {"sec": 1700000000 + nanoseconds // 10**9, "nsec": nanoseconds % 10**9}


def xyz(v):
    return None if numpy.isnan(v).any() else dict(zip("xyz", map(float, v)))


def messages(kind, names, x, rate):
    """(topic, schema, JSON) of a recording in one of the ways that Foxglove's schemas allow."""
    turn = {"x": 0.0, "y": 0.0, "z": 0.0, "w": 1.0}
    for f, frame in enumerate(x):
        at = {"timestamp": stamp(f, rate), "frame_id": "lab"}
        if kind == "FrameTransform":
            for name, v in zip(names, frame):
                yield "/tf", kind, {"timestamp": at["timestamp"], "parent_frame_id": "lab", "child_frame_id": name, "translation": xyz(v), "rotation": turn}
        elif kind == "SceneUpdate":
            yield "/markers", kind, {"deletions": [], "entities": [
                {**at, "id": name, "spheres": [{"pose": {"position": xyz(v), "orientation": turn}, "size": {"x": 0.01, "y": 0.01, "z": 0.01}}]}
                for name, v in zip(names, frame)]}
        else:
            for name, v in zip(names, frame):
                yield f"/{name}", kind, {**at, "pose": {"position": xyz(v), "orientation": turn}}


def judge_mcap(scratch):
    points = ezc3d.c3d(str(WALK))
    rate = float(points["header"]["points"]["frame_rate"])
    x = points["data"]["points"][:3].transpose(2, 1, 0)[:, :MARKERS] / 1000.0
    x[points["data"]["meta_points"]["residuals"][0].T[:, :MARKERS] < 0] = numpy.nan
    x[10:20, 3] = numpy.nan
    names = [f"m{i:02}" for i in range(x.shape[1])]
    for kind, compression in (("FrameTransform", CompressionType.ZSTD), ("SceneUpdate", CompressionType.LZ4), ("PoseInFrame", CompressionType.NONE)):
        path = scratch / f"{kind}.mcap"
        with path.open("wb") as file:
            writer = Writer(file, compression=compression)
            writer.start(profile="", library="judge")
            channels = {}
            for topic, schema, message in messages(kind, names, x, rate):
                if topic not in channels:
                    number = writer.register_schema(name=f"foxglove.{schema}", encoding="jsonschema", data=b"{}")
                    channels[topic] = writer.register_channel(topic=topic, message_encoding="json", schema_id=number)
                time = 10**9 * 1700000000
                writer.add_message(channels[topic], log_time=time, data=json.dumps(message).encode(), publish_time=time)
            image = writer.register_channel(topic="/camera", message_encoding="protobuf", schema_id=0)
            writer.add_message(image, log_time=0, data=b"\x01", publish_time=0)
            writer.finish()
        got, ours, measured = read_by_us(path, scratch)
        worst, missing = same(x, ours)
        row(got == names and worst <= 1e-15 and missing,
            f"MCAP of the mcap package, JSON of foxglove.{kind}, {compression.name.lower()}, {len(names)} points, {len(x)} frames: positions",
            "<= 1e-15 m, the same samples missing", f"{worst:.1e} m{'' if missing else ', others missing'}")
        row(not isinstance(measured, str) and abs(measured / rate - 1) < 1e-6, f"MCAP, foxglove.{kind}: rate", f"{rate:g} Hz", f"{measured}")
        said = json.loads(run("info", "--json", path).stdout)["warnings"]
        row(any("/camera (protobuf, no schema)" in w for w in said), f"MCAP, foxglove.{kind}: a channel that is not read", "named", "; ".join(said) or "nothing said")


def main():
    if not DATA.is_dir():
        print(f"SKIP | files of other programs | recordings | {DATA} is not there")
        return 0
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as name:
        scratch = Path(name)
        judge_phasespace(scratch)
        judge_vsk()
        judge_mcap(scratch)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
