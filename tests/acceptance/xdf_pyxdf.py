#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""XDF files against pyxdf: streams with jitter, drift between clocks, dropped frames, cues and other streams, written here
as the specification has them, read by pyxdf and by kinemark.

Needs Python with pyxdf. Finds the program in KINEMARK_PROGRAM; prints rows "PASS|FAIL | check | asked | measured"; exit
status 1 when one fails.
"""

import csv
import json
import struct
import sys
import tempfile
from pathlib import Path
from xml.sax.saxutils import escape

import numpy
import pyxdf

from rows import row, run

CODES = {"float32": "f", "double64": "d", "int16": "h", "int32": "i"}
MARKERS = ("LASI", "RASI", "SACR")


def sized(number):
    return struct.pack("<BB", 1, number) if number < 256 else struct.pack("<BI", 4, number)


def chunk(tag, content):
    return sized(len(content) + 2) + struct.pack("<H", tag) + content


def header(stream, name, kind, channels, rate, form, desc=""):
    xml = (f"<?xml version='1.0'?><info><name>{escape(name)}</name><type>{kind}</type><channel_count>{channels}</channel_count>"
           f"<nominal_srate>{rate}</nominal_srate><channel_format>{form}</channel_format><created_at>1</created_at>"
           f"<desc>{desc}</desc></info>")
    return chunk(2, struct.pack("<I", stream) + xml.encode())


def positions(unit):
    return "<channels>" + "".join(
        f"<channel><label>{m}_{a}</label><marker>{m}</marker><type>Position{a}</type><unit>{unit}</unit></channel>"
        for m in MARKERS for a in "XYZ") + "</channels>"


def samples(stream, times, values, form, every=1):
    """Chunks of up to 50 samples; of `every` samples one has its time."""
    out = []
    for begin in range(0, len(times), 50):
        part = range(begin, min(begin + 50, len(times)))
        body = struct.pack("<I", stream) + sized(len(part))
        for i in part:
            body += struct.pack("<Bd", 8, times[i]) if i % every == 0 else b"\0"
            if form == "string":
                text = values[i].encode()
                body += sized(len(text)) + text
            else:
                body += struct.pack(f"<{len(values[i])}{CODES[form]}", *values[i])
        out.append(chunk(3, body))
    return out


def offset(stream, when, add):
    return chunk(4, struct.pack("<Idd", stream, when, add))


def write(path, case, random):
    """A file; (frames that were kept, positions as they stand in it)."""
    frames = numpy.arange(case["frames"])
    kept = numpy.array([f for f in frames if not any(a <= f < b for a, b in case["gaps"])])
    seconds = kept / case["true_rate"]
    times = 5000.0 + seconds + case["jitter"] / case["rate"] * random.uniform(size=len(kept))
    if case["form"] in ("int16", "int32"):
        values = random.integers(-2000, 2000, (len(kept), 9))
    else:
        values = random.normal(0, 800 if case["unit"] == "mm" else 0.8, (len(kept), 9)).astype(numpy.float32)
    parts = [b"XDF:", chunk(1, b"<?xml version='1.0'?><info><version>1.0</version></info>"),
             header(7, "Motive", "MoCap", 9, case["rate"], case["form"], positions(case["unit"])),
             header(9, "cues", "Markers", 1, 0, "string"), header(3, "EEG", "EEG", 2, 500, "double64")]
    moving = samples(7, times, values.tolist(), case["form"], case["every"])
    cues = samples(9, [6001.0, 6002.5], ["start <&>", "end"], "string")
    eeg = samples(3, 6000.0 + numpy.arange(500) / 500, random.normal(size=(500, 2)).tolist(), "double64")
    span = int(seconds[-1]) + 5
    clocks = [offset(7, 5000.0 + s, 1000.0 + case["drift"] * s) for s in range(0, span, 5)] + [offset(9, 6000.0, 0.0), offset(3, 6000.0, 0.0)]
    parts += moving[: len(moving) // 2] + clocks[::2] + eeg + cues + moving[len(moving) // 2 :] + clocks[1::2]
    parts += [chunk(5, bytes(range(16))), chunk(6, struct.pack("<I", 7) + b"<info><sample_count>1</sample_count></info>")]
    path.write_bytes(b"".join(parts))
    return kept, numpy.asarray(values, dtype=float)


def ours(path, scratch):
    """(seconds of each frame, frames x 9 in metres, facts of info)."""
    out = scratch / "ours.csv"
    done = run("convert", "--quiet", "--force", path, out)
    if done.returncode:
        return done.stderr.strip()
    facts = json.loads(run("info", "--json", path).stdout)
    found = {}
    with out.open(newline="") as file:
        for line in csv.DictReader(file):
            place = found.setdefault(float(line["time_s"]), [numpy.nan] * 9)
            at = 3 * MARKERS.index(line["marker"])
            place[at : at + 3] = [float(line[f"{axis}_m"] or "nan") for axis in "xyz"]
    return numpy.array(sorted(found)), numpy.array([found[t] for t in sorted(found)]), facts


def compare(case, scratch, random):
    """What differs, in words, and the largest difference of a time in frames. Where frames were dropped, pyxdf's times are
    taken as they stand: its dejittering draws one line over gaps of less than a second."""
    path = scratch / "case.xdf"
    kept, values = write(path, case, random)
    streams, _ = pyxdf.load_xdf(str(path), synchronize_clocks=True, dejitter_timestamps=not case["gaps"])
    theirs = next(s for s in streams if s["info"]["type"][0] == "MoCap")
    result = ours(path, scratch)
    if isinstance(result, str):
        return [result], 0.0
    times, x, facts = result
    wrong = []
    scale = 1e-3 if case["unit"] == "mm" else 1.0
    if len(times) != case["frames"] or facts["frames"] != case["frames"]:
        return [f"{len(times)} frames of {case['frames']}"], 0.0
    if numpy.abs(x[kept] - scale * numpy.asarray(theirs["time_series"], dtype=float)).max() > 1e-12 or not (
            numpy.asarray(theirs["time_series"]) == values).all():
        wrong.append("positions")
    if not numpy.isnan(numpy.delete(x, kept, axis=0)).all():
        wrong.append("frames that were dropped hold something")
    # Both clocks begin somewhere else: their steps are compared, in frames.
    stamps = theirs["time_stamps"]
    off = (times[kept] - stamps) * case["rate"]
    worst = float(numpy.abs(off - numpy.median(off)).max())
    if worst > case["most"]:
        wrong.append(f"times {worst:.2f} frames off")
    return wrong, worst


BASE = {"frames": 1500, "rate": 120.0, "true_rate": 120.0, "jitter": 0.0, "drift": 0.0, "gaps": [], "form": "float32", "unit": "m", "every": 1,
        "most": 0.01}
CASES = {
    "even": {},
    "millimetres": {"unit": "mm", "form": "int16"},
    "doubles": {"form": "double64"},
    "jitter of half a frame": {"jitter": 0.5, "most": 0.1},
    "times of every fourth sample alone": {"every": 4},
    "clock that drifts": {"drift": 5e-6, "most": 0.1},
    "rate that is not as stated": {"true_rate": 119.88, "most": 0.1},
    "frames dropped": {"gaps": [(300, 301), (700, 760)]},
    "frames dropped in jitter": {"gaps": [(700, 760)], "jitter": 0.2, "most": 0.25},
}


def check_cases(scratch):
    random, good = numpy.random.default_rng(5), True
    for name, changes in CASES.items():
        case = {**BASE, **changes}
        wrong, worst = compare(case, scratch, random)
        good &= row(not wrong, f"XDF, {name}: beside pyxdf", f"same positions and frames, times within {case['most']:g} frames",
                    "; ".join(wrong) or f"same, {worst:.3f} frames")
    return good


def check_words(scratch):
    """What was dropped and left out is said, and strings of other streams are events."""
    write(scratch / "words.xdf", {**BASE, "gaps": [(700, 760)]}, numpy.random.default_rng(6))
    done = run("info", scratch / "words.xdf")
    made = run("convert", "--quiet", scratch / "words.xdf", scratch / "words.mat")
    said = "dropped 60 frames of 1500" in done.stderr + done.stdout and "EEG" in done.stderr + done.stdout
    import scipy.io

    events = [(str(e["label"]), float(e["time"])) for e in scipy.io.loadmat(scratch / "words.mat", simplify_cells=True)["trial"]["events"]]
    same = len(events) == 2 and [e[0] for e in events] == ["start <&>", "end"] and max(abs(events[0][1] - 1.0), abs(events[1][1] - 2.5)) < 0.01
    return row(said and same and made.returncode == 0, "XDF: dropped frames and streams left out are said, cues are events", "said; at 1 and 2.5 s",
               f"{'said' if said else 'not said'}; {events}")


def check_cut(scratch):
    """A recording that ends in the middle of a chunk, as after a crash."""
    write(scratch / "whole.xdf", BASE, numpy.random.default_rng(7))
    data = (scratch / "whole.xdf").read_bytes()
    (scratch / "cut.xdf").write_bytes(data[: len(data) * 3 // 4])
    done = run("info", "--json", scratch / "cut.xdf")
    frames = json.loads(done.stdout)["frames"] if done.returncode == 0 else 0
    streams, _ = pyxdf.load_xdf(str(scratch / "cut.xdf"))
    theirs = len(next(s for s in streams if s["info"]["type"][0] == "MoCap")["time_stamps"])
    return row(0 < frames <= theirs + 50 and frames >= theirs - 50 and "middle of a chunk" in done.stdout + done.stderr, "XDF cut at three quarters",
               "frames as pyxdf within a chunk of 50, and said", f"{frames}, pyxdf {theirs}")


def main():
    with tempfile.TemporaryDirectory() as name:
        good = [check(Path(name)) for check in (check_cases, check_words, check_cut)]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
