#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark joints FILE` without segments on every C3D and TRC of the real recordings.

No result may hold a marker noise above 20 mm, a length outside 5 mm to 1.5 m, a segment of two markers or a number of a joint that
is not known; what was left out is said with a figure and its bound, what is not determined with its reason, and the exit status tells:
1 when anything was left out or not determined, 3 and no file when nothing can be looked at.
"""

import json
import os
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
PROGRAM = os.environ.get("KINEMARK_PROGRAM", str(ROOT / "build" / "release" / "bin" / "kinemark"))
DATA = Path(os.environ.get("KINEMARK_TEST_DATA") or ROOT.parent / "shared" / "data")
SCRATCH = Path(os.environ.get("KINEMARK_SCRATCH", "/tmp")) / "joints-files"
MOST_NOISE_M, LEAST_LENGTH_M, MOST_LENGTH_M = 0.020, 0.005, 1.5
LONGEST_S = 600
WHOLE_FRAMES, WHOLE_MARKERS = (1000, 2000), 30  # a recording of a whole body, as long as the one that is asked for
MOST_S, ASKED_FRAMES = 10.0, 1500


def lengths_of(skeleton):
    """Every number of a skeleton that is a length of the body, m."""
    return [length["length_m"] for length in skeleton["lengths"]]


def reaches_of(skeleton):
    """Distance of each joint from the nearest marker of each of its segments, m."""
    positions = {s["name"]: [m["x_in_segment_m"] for m in s["markers"]] for s in skeleton["segments"]}
    for joint in skeleton["joints"]:
        for side in ("parent", "child"):
            centre = joint[f"centre_in_{side}_m"]
            known = [x for x in positions[joint[side]] if None not in x]
            if centre is not None and known:
                yield min(sum((a - b) ** 2 for a, b in zip(centre, x)) ** 0.5 for x in known)


def frames_of_body(path):
    """Frames of a recording of a whole body about as long as the one that is asked for; 0 for others."""
    done = subprocess.run([PROGRAM, "info", str(path), "--json"], capture_output=True, text=True, check=False)
    about = json.loads(done.stdout) if done.returncode == 0 else {}
    whole = about.get("points", 0) >= WHOLE_MARKERS and WHOLE_FRAMES[0] <= about["frames"] <= WHOLE_FRAMES[1]
    return about["frames"] if whole else 0


def wrong(done, out):
    """What is wrong with a run, in words; nothing when all is well."""
    if done.returncode not in (0, 1, 3):
        return f"exit status {done.returncode}: {done.stderr.strip()[-200:]}"
    if done.returncode == 3:
        if out.exists():
            return "exit status 3 and files"
        return "" if done.stderr.strip() else "exit status 3 without a word"
    progress = [line for line in done.stderr.splitlines() if line.startswith("frames: ")]
    if any(" 0 of " in f" {line}" or line == before for before, line in zip([""] + progress, progress)):
        return "progress that says nothing new"
    skeleton = json.loads((out / "skeleton.json").read_text(encoding="utf-8"))
    noise = skeleton["noise_sd_m"]
    if noise is not None and noise > MOST_NOISE_M:
        return f"marker noise {1e3 * noise:.1f} mm"
    absurd = [x for x in lengths_of(skeleton) if x is None or not LEAST_LENGTH_M <= x <= MOST_LENGTH_M]
    if absurd:
        return f"lengths {absurd}"
    far = [x for x in reaches_of(skeleton) if x > MOST_LENGTH_M]
    if far:
        return f"joints {far} m from their markers"
    for left in skeleton["left_out"]:
        if left["name"] not in done.stderr or left["words"] not in done.stderr or "expected" not in left["words"]:
            return f"left out without a word: {left}"
    placed = all(j["frames"]["undetermined"] < skeleton["frames"] for j in skeleton["joints"])
    account = skeleton["segmentation"]
    few = [s["name"] for s in skeleton["segments"] if len(s["markers"]) < 3]
    if few:
        return f"segments of two markers: {few}"
    if sorted(j["name"] for j in account["known"]) != sorted(j["name"] for j in skeleton["joints"]):
        return "the joints that are known are not those that have numbers"
    unsaid = [j["name"] for j in account["not_determined"] if j["words"] not in done.stderr]
    if unsaid:
        return f"not determined without a word: {unsaid}"
    open_joints = bool(account["not_determined"]) or not skeleton["joints"]
    if (done.returncode == 1) != (bool(skeleton["left_out"]) or not placed or open_joints):
        return f"exit status {done.returncode} with {len(skeleton['left_out'])} left out, {len(account['not_determined'])} not determined"
    if skeleton["left_out"] and skeleton["next_step"] not in done.stderr:
        return "no next step"
    return ""


def main():
    subprocess.run(["rm", "-rf", str(SCRATCH)], check=True)
    SCRATCH.mkdir(parents=True)
    chosen = sys.argv[1:]
    files = sorted(p for p in DATA.rglob("*") if p.suffix.lower() in (".c3d", ".trc"))
    files = [p for p in files if not chosen or any(c in str(p) for c in chosen)]
    counts, slowest, bad, paces = {}, (0.0, ""), [], []
    for number, path in enumerate(files):
        out = SCRATCH / f"{number}"
        start = time.monotonic()
        try:
            done = subprocess.run([PROGRAM, "joints", str(path), "-o", str(out)], capture_output=True, text=True, check=False,
                                  timeout=LONGEST_S)
            why = wrong(done, out)
            counts[done.returncode] = counts.get(done.returncode, 0) + 1
        except subprocess.TimeoutExpired:
            why = f"not done after {LONGEST_S} s"
        took = time.monotonic() - start
        slowest = max(slowest, (took, path.name))
        if frames := frames_of_body(path):
            paces.append((took * ASKED_FRAMES / frames, path.name))
        if why:
            bad.append(f"{path.relative_to(DATA)}: {why}")
    for why in bad:
        print(f"NOTE | joints without segments | - | {why}", flush=True)
    ended = ", ".join(f"{n} with {status}" for status, n in sorted(counts.items()))
    print(f"{'FAIL' if bad or not files else 'PASS'} | joints of every C3D and TRC without segments | "
          "noise <= 20 mm, lengths 5 mm to 1.5 m, or left out with its figure | "
          f"{len(bad)} of {len(files)} wrong; exit status {ended}; slowest {slowest[1]}, {slowest[0]:.1f} s", flush=True)
    in_time = all(pace <= MOST_S for pace, _ in paces)
    print(f"{'PASS' if in_time else 'FAIL'} | joints of whole bodies without segments: time of {ASKED_FRAMES} frames | <= {MOST_S:.0f} s | "
          + (", ".join(f"{pace:.1f} s ({name})" for pace, name in sorted(paces, reverse=True)) or "none among the files"), flush=True)
    return 1 if bad or not files or not in_time else 0


if __name__ == "__main__":
    sys.exit(main())
