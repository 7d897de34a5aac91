#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""The figures of the three founding papers, made by the three studies: all 17 there, numbered, beside the papers' numbers, and
drawn from the data that they say.

What a figure draws stands in its .csv; that the picture shows these numbers is read from its .svg, whose path must be the curve
under one change of scale. Schedules are held against the recording that `simulate rig` writes, the arm of figure 7 against
`joints` on the same recording. Tai chi: the first seconds of the real recording; without it that study is left out.

Arguments: seed (default 1), seconds of tai chi (default 2). Prints rows "PASS|FAIL|SKIP | check | asked | measured".
"""

import csv
import html
import json
import math
import os
import re
import sys
import tempfile
import tomllib
from pathlib import Path

import rows
from rows import exit_status, output

PAPERS = {"poizner": ("poizner-1986", "Poizner 1986", 6), "macaque": ("macaque-report", "Macaque report", 7),
          "taichi": ("demircan-2008", "Demircan 2008", 4)}
PUBLISHED = {("poizner", 2): 1, ("poizner", 3): 3, ("poizner", 5): 5, ("poizner", 6): 2, ("macaque", 6): 2}  # numbers of the paper, at least
RECORDING = Path(os.environ.get("KINEMARK_TEST_DATA", Path(__file__).resolve().parents[3] / "shared/data")) / "motionmachine-taichi/taichi.v3d"
HEADER_ROWS, RATE_HZ = 5, 179
SMALLEST_PNG = 10_000  # bytes; a blank one of 1920 dots a row has less


def row(passed, check, asked, measured):
    rows.row(passed, f"figures as published, {check}", asked, measured)


def curves(path):
    """{name: [points]} of a figure's CSV."""
    out = {}
    with path.open(newline="") as file:
        for line in csv.reader(file):
            if line[-3:] != ["x", "y", "z"]:
                name = ",".join(line[:-3])
                out.setdefault(name, []).append([float(v) for v in line[-3:] if v])
    return out


def paths(svg):
    """Points of every line of a picture, pixels."""
    return [[(float(x), float(y)) for x, y in re.findall(r"[ML]([-\d.]+) ([-\d.]+)", d)] for d in re.findall(r'<path fill="none"[^>]* d="([^"]*)"', svg)]


def fits(path, curve):
    """Largest distance, pixels, of a drawn path from a curve under one scale and shift of each axis; infinite for another number of points."""
    if len(path) != len(curve):
        return math.inf
    worst = 0.0
    for axis in (0, 1):
        have, want = [p[axis] for p in path], [c[axis] for c in curve]
        low, high = min(range(len(want)), key=want.__getitem__), max(range(len(want)), key=want.__getitem__)
        if want[high] == want[low]:
            continue
        scale = (have[high] - have[low]) / (want[high] - want[low])
        worst = max(worst, max(abs(have[low] + scale * (w - want[low]) - h) for h, w in zip(have, want, strict=True)))
    return worst


def drawn(svg, curve):
    return min((fits(path, curve) for path in paths(svg)), default=math.inf)


def beginning(scratch, seconds):
    """The first seconds of the tai chi recording as a file."""
    lines = RECORDING.read_bytes().splitlines(keepends=True)
    short = scratch / "short.v3d"
    short.write_bytes(b"".join(lines[: HEADER_ROWS + int(seconds * RATE_HZ)]))
    return short


def study(name, folder, *of):
    text = output("study", name, *of, "--figures", folder, "--json", "--quiet")
    return {r["quantity"]: r for r in json.loads(text)["rows"]}


def page_of(folder):
    text = (folder / "study.html").read_text()
    return json.loads(re.search(r'id="kinemark-data">(.*?)</script>', text, re.S)[1])["result"]


def check_present(folders):
    """Every figure as svg, png, csv and on the page, by its number."""
    there, beside, asked, wrong = 0, 0, 0, []
    for name, (stem, title, count) in PAPERS.items():
        if name not in folders:
            continue
        asked += count
        figures = page_of(folders[name])["figures"]
        for number in range(1, count + 1):
            at = folders[name] / f"{stem}-figure-{number}"
            svg = at.with_suffix(".svg").read_text()
            body = next((f["body"] for f in figures if f["caption"].startswith(f"{title}, figure {number}: ")), "")
            whole = (f"<title>{title}, figure {number}</title>" in svg and f">{title}, figure {number}</text>" in svg and "nan" not in svg
                     and len(paths(svg)) > 1 and "<svg" in body and at.with_suffix(".png").stat().st_size > SMALLEST_PNG and len(curves(at.with_suffix(".csv"))) > 0)
            there += whole
            said = [html.unescape(p) for p in re.findall(r"<p>(.*?)</p>", body) if "in the paper" in p]
            printed = html.unescape(" ".join(re.findall(r"<text[^>]*>(.*?)</text>", svg)))
            enough = len(said) >= PUBLISHED.get((name, number), 0) and printed.count("in the paper") >= min(1, len(said))
            beside += enough
            if not (whole and enough):
                wrong.append(f"{name} {number}")
    row(there == asked, "there and numbered, as .svg, .png, .csv and on the page", f"{asked} of {asked}", f"{there}{' ' + ', '.join(wrong) if wrong else ''}")
    row(beside == asked, "with the paper's numbers and ours under each", f"{asked} of {asked}", beside)


def check_schedule(folder, recording):
    """Figures 2 and 3: edges of the LEDs and beginnings of the conversions are those of the recorded schedule."""
    timing = tomllib.loads((recording / "rig_true.toml").read_text())["timing"]
    settle, conversion, off = (timing[key] for key in ("settle_s", "conversion_s", "off_s"))
    two, three = (curves(folder / f"poizner-1986-figure-{n}.csv") for n in (2, 3))
    worst, slot = 0.0, settle + 8 * conversion + off
    for led, name in enumerate(("shoulder", "elbow", "wrist", "hand")):
        edges = [x for (x, y), (u, v) in zip(two[f"LED {led + 1}, {name}"], two[f"LED {led + 1}, {name}"][1:]) if x == u and y != v]
        worst = max(worst, abs(1e-3 * edges[0] - led * slot), abs(1e-3 * edges[1] - (led + 1) * slot + off))
    starts = [x for (x, y), (u, v) in zip(two["A/D conversions"], two["A/D conversions"][1:]) if x == u and v > y]
    wanted = [led * slot + settle + k * conversion for led in range(4) for k in range(8)]
    worst = max([worst, *(abs(1e-3 * a - b) for a, b in zip(starts, wanted))])
    close = [x for camera in "AB" for (x, y), (u, v) in zip(three[f"A/D, camera {camera}"], three[f"A/D, camera {camera}"][1:]) if x == u and v > y]
    worst = max([worst, *(abs(1e-6 * a - settle - k * conversion) for k, a in enumerate(close))])
    row(len(starts) >= 32 and len(close) == 8 and worst < 1e-9, "control signals and timing, edges to the schedule of the rig's file", "<= 1e-9 s, 32 conversions", f"{worst:.1e} s, {len(starts)} and {len(close)}")
    svg = (folder / "poizner-1986-figure-2.svg").read_text()
    off_by = max(drawn(svg, curve) for curve in two.values())
    row(off_by < 0.02, "control signals, picture to its numbers", "<= 0.02 pixels", f"{off_by:.3f}")


def check_sign(folder):
    """6C: the tangential acceleration is the rate of the speed, and is what is drawn."""
    of = curves(folder / "poizner-1986-figure-6.csv")
    speed = [math.hypot(*v) for v in of["velocity of the hand, m/s"]]
    acceleration, step = [p[1] for p in of["tangential acceleration"]], 0.01
    inner = range(12, len(speed) - 12)
    # Five points, error of order h^4.
    rate = {f: (8 * (speed[f + 1] - speed[f - 1]) - speed[f + 2] + speed[f - 2]) / (12 * step) for f in inner}
    size = math.sqrt(sum(acceleration[f] ** 2 for f in inner) / len(inner))
    apart = math.sqrt(sum((rate[f] - acceleration[f]) ** 2 for f in inner) / len(inner)) / size
    row(apart < 0.02, "6C, tangential acceleration against the rate of the speed", "<= 2 % RMS", f"{100 * apart:.2f} %")
    svg = (folder / "poizner-1986-figure-6.svg").read_text()
    off_by = max(drawn(svg, of[name]) for name in ("tangential velocity", "tangential acceleration"))
    row(off_by < 0.02, "6C, picture to its numbers", "<= 0.02 pixels", f"{off_by:.3f}")


def check_wheel(folder, table):
    """5: its summary shows the table's numbers, its box holds the path."""
    svg = html.unescape((folder / "poizner-1986-figure-5.svg").read_text())
    shown = {f"{table[f'wheel at 8 deg: {what}']['ours']:.3f}" for what in ("median error of the diameter", "scatter of the diameter", "scatter across the plane")}
    there = sum(f">{text}<" in svg for text in shown)
    of = curves(folder / "poizner-1986-figure-5.csv")
    low, high = of["box, m"]
    apart = max(abs(f(p[a] for p in of["path, m"]) - edge[a]) for a in range(3) for f, edge in ((min, low), (max, high)))
    row(there == len(shown) and apart < 1e-8, "5, summary to the table and box to the path", f"{len(shown)} numbers; <= 1e-8 m", f"{there}; {apart:.0e} m")


def check_elbow(folder, table):
    """6: curves pass through the rows of the table."""
    of = curves(folder / "macaque-report-figure-6.csv")
    noise = {p[0]: p[1] for p in of["report's method against noise"]}
    ours = {p[0]: p[1] for p in of["ours against missing"]}
    two, one = table["collinear, 2 mm noise, 0 % missing: elbow"], table["collinear, 1 mm noise, 20 % missing: elbow"]
    apart = max(abs(noise[2.0] - two["classic"]) / two["classic"], abs(ours[20.0] - one["ours"]) / one["ours"])
    row(apart < 1e-6, "macaque 6, curves to the rows of the table", "equal", f"{apart:.0e}")


def check_arm(folder, scratch, seed):
    """7: joints and picture of the study are those of `joints`."""
    output("simulate", "macaque", "-o", scratch / "m", "--duration", 8, "--tip", "--seed", seed, "--quiet")
    output("joints", scratch / "m/markers.c3d", "--segments", scratch / "m/segments.toml", "-o", scratch / "out", "--figures", scratch / "arm.svg", "--quiet")
    with (scratch / "out/centres.csv").open(newline="") as file:
        centres = {(r["marker"], int(r["frame"])): [float(r[f"{a}_m"]) for a in "xyz"] for r in csv.DictReader(file)}
    worst, count = 0.0, 0
    for name, points in curves(folder / "macaque-report-figure-7.csv").items():
        joint, frame = re.match(r"(\w+) of frame (\d+), m", name).groups()
        worst = max(worst, math.dist(points[0], centres[joint, int(frame)]))
        count += 1
    row(count == 12 and worst < 1e-5, "macaque 7, joints of four postures to `joints` on the same recording", "12, <= 0.01 mm", f"{count}, {1e3 * worst:.4f} mm")
    mine, theirs = (paths((at).read_text()) for at in (folder / "macaque-report-figure-7.svg", scratch / "arm.svg"))
    bones = [p for p in theirs if 2 <= len(p) <= 3]
    apart = max(min((abs(p[0][0] - q[0][0]) + abs(p[-1][1] - q[-1][1]) for q in mine if len(q) == len(p)), default=math.inf) for p in bones)
    row(apart < 0.1, "macaque 7, picture to that of `joints --figures`", "<= 0.1 pixels", f"{apart:.3f}, {len(bones)} lines")


def check_tai_chi(folder):
    """3 and 4: errors are goals less tracked; largest is never below smallest."""
    three, four = (curves(folder / f"demircan-2008-figure-{n}.csv") for n in (3, 4))
    worst = 0.0
    for landmark in ("RShoulder", "LWrist", "LElbow", "RWrist"):
        error = dict(map(tuple, four[f"{landmark}, the four landmarks, mm"]))
        goal = [dict(map(tuple, three[f"{landmark} {axis}, goal"])) for axis in ("forward", "up", "right")]
        tracked = [dict(map(tuple, three[f"{landmark} {axis}, tracked"])) for axis in ("forward", "up", "right")]
        for time, mm in error.items():
            if all(time in g for g in goal) and time in tracked[0]:
                worst = max(worst, abs(mm - 1e3 * math.hypot(*(g[time] - t[time] for g, t in zip(goal, tracked, strict=True)))))
    row(worst < 1e-3, "tai chi 4, landmark errors to figure 3's goals less tracked", "<= 0.001 mm", f"{worst:.1e} mm")
    largest, smallest = ([p[1] for p in four[f"{which} joint error, all 21 landmarks, deg"]] for which in ("largest", "smallest"))
    row(all(a >= b > 0 for a, b in zip(largest, smallest, strict=True)) and max(largest) > 0, "tai chi 4, largest joint error (equation 17) above the smallest", "in every frame", f"{len(largest)} frames, {max(largest):.2f} deg at most")
    sides = {name[-len("_r, all landmarks"):][1] for name in curves(folder / "demircan-2008-figure-2.csv") if name.endswith(", all landmarks")}
    angles = {name.split(",")[0] for name in curves(folder / "demircan-2008-figure-2.csv")}
    wanted = {f"{a}_{s}" for a in ("arm_flex", "arm_add", "arm_rot", "elbow_flex", "wrist_flex", "wrist_dev") for s in "rl"}
    row(angles == wanted and sides == {"r", "l"}, "tai chi 2, angles of shoulder, elbow and wrist of both arms", "12", len(angles & wanted))


def main():
    seed = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch)
        of = {"poizner": ("--seeds", seed), "macaque": ("--seeds", seed)}
        if RECORDING.exists():
            of["taichi"] = ("--data", beginning(scratch, float(sys.argv[2]) if len(sys.argv) > 2 else 2.0))
        else:
            print("SKIP | figures as published, tai chi | 4 figures | no recordings")
        folders = {name: scratch / name for name in of}
        tables = {name: study(name, folders[name], *words) for name, words in of.items()}
        check_present(folders)
        output("simulate", "rig", "sign", "-o", scratch / "sign", "--seed", seed, "--quiet")
        check_schedule(folders["poizner"], scratch / "sign")
        check_wheel(folders["poizner"], tables["poizner"])
        check_sign(folders["poizner"])
        check_elbow(folders["macaque"], tables["macaque"])
        check_arm(folders["macaque"], scratch, seed)
        if "taichi" in folders:
            check_tai_chi(folders["taichi"])
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
