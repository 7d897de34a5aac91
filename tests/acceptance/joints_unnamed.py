#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark joints FILE` without segments beside the same file with segments written from the published marker sets.

What is called known must lie within 3 SD and 10 mm (15 in walks) of the named segments' answer, with the names as they are and
with the markers called M1 ... Mn; of the joints that a functional trial's named segments determine half must be known. Simulated
limbs, markers renamed: what is known is right, and of rigid limbs that move well everything is.
"""

import csv
import json
import math
import os
import statistics
import subprocess
import sys
import tomllib
from pathlib import Path

from rows import exit_status, row, run

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA") or ROOT.parent / "shared" / "data")
SCRATCH = Path(os.environ.get("KINEMARK_SCRATCH", "/tmp")) / "joints-unnamed"


def sides(segments, joints):
    """Segments and joints of both sides: S stands for L and R."""
    out, pairs = {}, []
    for side in "LR":
        for name, markers in segments.items():
            out[name.replace("S", side)] = [m.replace("$", side) for m in markers]
        pairs += [tuple(part.replace("S", side) for part in pair) for pair in joints]
    return out, list(dict.fromkeys(pairs))


LEGS = [("hip_S", "pelvis", "thigh_S"), ("knee_S", "thigh_S", "shank_S")]
PELVIS = ["LASI", "RASI", "LPSI", "RPSI"]
LAMB = sides({"pelvis": PELVIS, "thigh_S": [f"$F0{k}" for k in range(1, 6)], "shank_S": [f"$T0{k}" for k in range(1, 6)]}, LEGS)
RIZZOLI = sides({"pelvis": ["LASIS", "RASIS", "LPSIS", "RPSIS"], "thigh_S": ["$GT", "$THI1", "$THI2", "$THI3"],
                 "shank_S": ["$ATT", "$LM", "$SPH", "$LEG1", "$LEG2", "$LEG3"]}, LEGS)
QUALISYS = sides({"pelvis": ["L_IAS", "L_IPS", "R_IPS", "R_IAS"], "thigh_S": ["$_FTC", "$_FLE", "$_FME"],
                  "shank_S": ["$_FAX", "$_TTC", "$_FAL", "$_TAM"], "foot_S": ["$_FCC", "$_FM1", "$_FM5"]},
                 [*LEGS, ("ankle_S", "shank_S", "foot_S")])
TRIADS = sides({"pelvis": PELVIS, "thigh_S": ["$TH1", "$TH2", "$TH3"], "shank_S": ["$TB1", "$TB2", "$TB3"]}, LEGS)
EIGHT = sides({"thigh_S": [f"$TH{k}" for k in range(1, 5)], "shank_S": [f"$SK{k}" for k in range(1, 5)]}, LEGS[1:])
HAYES = sides({"pelvis": ["R.ASIS", "L.ASIS", "V.Sacral"], "thigh_S": ["$.Thigh.Upper", "$.Thigh.Front", "$.Thigh.Rear"],
               "shank_S": ["$.Shank.Upper", "$.Shank.Front", "$.Shank.Rear"]}, LEGS)
# File, named segments, and the joints that the movement is about: nothing for walks and runs.
TRIALS = [("btk-others/FunctionalLHip.c3d", LAMB, ["hip_L"]), ("biobuddy/right_knee.c3d", RIZZOLI, ["knee_R"]),
          ("btk-others/FunctionalWalk.c3d", LAMB, []), ("ezc3d-testFiles/Qualisys.c3d", QUALISYS, []),
          ("opensim-core-formats/walking2.c3d", TRIADS, []), ("c3d-org/sample01/Eb015pi.c3d", EIGHT, []),
          ("nimble-arnold-synthetic/subject01/trials/walk2/markers.trc", TRIADS, []),
          ("opensim-gait2354/subject01_walk1.trc", HAYES, []), ("opensim-hamner-fullbody/subject02_running.trc", HAYES, []),
          ("bmc-rajagopal-run/ExpData/motion_capture_run.trc", TRIADS, [])]
# Plug-in Gait has one marker on a thigh: nothing may be known of the legs.
WITHOUT_CLUSTERS = ["btk-others/PiG_Motion3_FF.c3d", "c3d-parser-clinics/MH0222_BP15.c3d", "c3d-parser-clinics/RBWH_bfnd_w1.c3d",
                    "c3d-parser-clinics/S4-AMGait03.c3d", "c3d-parser-clinics/QCMAS.dynamic.c3d", "cmu-mocap/85_02.c3d"]


def write_toml(path, segments, joints):
    text = "".join(f"[[segment]]\nname = {json.dumps(n)}\nmarkers = {json.dumps(m)}\n" for n, m in segments.items())
    text += "".join(f"[[joint]]\nname = {json.dumps(n)}\nparent = {json.dumps(p)}\nchild = {json.dumps(c)}\n" for n, p, c in joints)
    path.write_text(text, encoding="utf-8")


def read_centres(path):
    """Positions and SDs by joint and frame, m."""
    out = {}
    if not path.exists():
        return out
    with path.open(encoding="utf-8") as lines:
        for line in csv.DictReader(lines):
            if line["x_m"]:
                out.setdefault(line["marker"], {})[int(line["frame"])] = (
                    [float(line[f"{c}_m"]) for c in "xyz"], [float(line[f"sd_{c}_m"] or "nan") for c in "xyz"])
    return out


def axes_of(folder, joint):
    """Whether a joint of a result is a hinge."""
    skeleton = json.loads((folder / "skeleton.json").read_text(encoding="utf-8"))
    return any(j["name"] == joint and j["kind"] == "hinge" for j in skeleton["joints"])


def distance(a, b, hinge):
    """Median distance of two paths, m, and over the known one's SD. Along a hinge's axis, the worst known direction, nothing is compared."""
    common = sorted(set(a) & set(b))
    if not common:
        return math.inf, math.inf
    lengths, ratios = [], []
    for f in common:
        d = [p - q for p, q in zip(a[f][0], b[f][0])]
        lengths.append(math.sqrt(sum(c * c for c in d)))
        ratios.append(max(abs(c) / s for c, s in zip(d, a[f][1])))
    return statistics.median(lengths), statistics.median(ratios)


def renamed(path, folder):
    """The same recording with markers M1 ... Mn, as CSV; points of models, whose names cannot tell any more, are not taken along."""
    plain = folder / "plain.csv"
    if run("convert", path, plain, "--force", "--quiet").returncode not in (0, 1):
        return None
    kept = {m for segment in json.loads((folder / "kept.json").read_text()) for m in segment}
    numbers, out = {}, folder / "numbered.csv"
    with plain.open(encoding="utf-8") as lines, out.open("w", encoding="utf-8") as to:
        head = next(lines)
        to.write(head)
        column = head.strip().split(",").index("marker")
        for line in lines:
            cells = line.rstrip("\n").split(",")
            if cells[column].split(":")[-1] not in kept:
                continue
            cells[column] = numbers.setdefault(cells[column], f"M{len(numbers) + 1}")
            to.write(",".join(cells) + "\n")
    return out


def compare(path, folder, recording, named, about, limit, how):
    """Rows of one trial: what is known without segments against the named answer."""
    out = folder / how
    done = run("joints", recording, "-o", out, "--quiet")
    if done.returncode not in (0, 1):
        row(done.returncode == 3 and not about, f"{path}, {how}", "status 0 or 1", f"{done.returncode}: {done.stderr.strip()[-200:]}")
        return
    skeleton = json.loads((out / "skeleton.json").read_text(encoding="utf-8"))
    account = skeleton["segmentation"]
    status = bool(account["not_determined"]) or not skeleton["joints"] or bool(skeleton["left_out"])
    said, wrong, found = [], [], set()
    for name, centres in read_centres(out / "centres.csv").items():
        near = min(((*distance(centres, other, axes_of(out, name)), joint) for joint, other in named.items()), default=(math.inf, math.inf, "none"))
        if how == "by names" and name.upper() not in {n.upper() for n in named}:
            continue  # an arm: nothing to compare with
        said.append(f"{name} {1e3 * near[0]:.1f} mm, {near[1]:.1f} SD of {near[2]}")
        found.add(near[2].upper())
        if near[0] > limit or near[1] > 3.0:
            wrong.append(name)
    row(not wrong and (done.returncode == 1) == status, f"{path}, {how}: what is known",
        f"<= {1e3 * limit:.0f} mm and 3 SD of the named answer; status 1 where anything is open",
        f"{', '.join(said) or 'nothing'}; status {done.returncode}, {len(account['not_determined'])} not determined")
    if about:
        hit = sum(joint.upper() in found for joint in about)
        row(2 * hit >= len(about) or how != "by names", f"{path}, {how}: joints of the movement that are known", ">= half (by names)",
            f"{hit} of {len(about)}")


def trials():
    for number, (path, (segments, joints), about) in enumerate(TRIALS):
        folder = SCRATCH / f"trial{number}"
        folder.mkdir(parents=True)
        (folder / "kept.json").write_text(json.dumps(list(segments.values())), encoding="utf-8")
        named = {}
        for name, parent, child in joints:
            write_toml(folder / f"{name}.toml", {n: segments[n] for n in (parent, child)}, [(name, parent, child)])
            run("joints", DATA / path, "--segments", folder / f"{name}.toml", "-o", folder / name, "--quiet")
            named.update(read_centres(folder / name / "centres.csv"))
        limit = 0.010 if about else 0.015
        compare(path, folder, DATA / path, named, about, limit, "by names")
        if plain := renamed(DATA / path, folder):
            compare(path, folder, plain, named, about, limit, "by numbers")
    for number, path in enumerate(WITHOUT_CLUSTERS):
        out = SCRATCH / f"without{number}"
        done = run("joints", DATA / path, "-o", out, "--quiet")
        known = json.loads((out / "skeleton.json").read_text())["joints"] if done.returncode == 1 else None
        legs = [j["name"] for j in known or [] if j["name"][:3] in ("hip", "kne", "ank")]
        row(known is not None and not legs, f"{path}: one marker on a segment", "nothing of the legs known, status 1",
            f"status {done.returncode}, known: {', '.join(legs) or 'nothing'}")


def simulated():
    for what, options, limit in (("arm", ["--stagger", "30", "--markers", "4"], 0.003), ("arm", ["--stagger", "30", "--markers", "4", "--missing", "0.2"], 0.003),
                                 ("arm", ["--stagger", "40", "--segments", "120,150,160", "--markers", "5", "--noise", "2"], 0.006),
                                 ("macaque", ["--all-seen"], 0.003), ("arm", ["--markers", "2", "--stagger", "20"], None)):
        folder = SCRATCH / ("-".join([what, *options]).replace(",", "_"))
        made = run("simulate", what, "-o", folder / "made", "--seed", "17", *options)
        recording = next(iter(sorted((folder / "made").glob("markers*"))), None)
        if made.returncode != 0 or recording is None:
            row(False, f"simulate {what} {' '.join(options)}", "a recording", made.stderr[-200:])
            continue
        done = run("joints", recording, "-o", folder / "out", "--quiet")
        truth = read_truth(folder / "made")
        known = read_centres(folder / "out" / "centres.csv")
        best = [min(distance(path, other, False)[0] for other in truth.values()) for path in known.values()]
        asked = "nothing known, status 1" if limit is None else f"all known, <= {1e3 * limit:.0f} mm"
        good = (not known and done.returncode == 1) if limit is None else len(known) == len(truth) and max(best) <= limit and done.returncode == 0
        row(good, f"simulate {what} {' '.join(options)}", asked,
            f"{len(known)} of {len(truth)} known, {', '.join(f'{1e3 * d:.2f} mm' for d in best)}; status {done.returncode}")


def read_truth(folder):
    """Joints of two segments of a simulated limb by frame."""
    joints = {joint["name"] for joint in tomllib.loads((folder / "segments.toml").read_text(encoding="utf-8"))["joint"]
              if joint["parent"] != "ground"}
    out = {}
    with (folder / "truth.csv").open(encoding="utf-8") as lines:
        for line in csv.DictReader(lines):
            if line["marker"] in joints and line["x_m"]:
                out.setdefault(line["marker"], {})[int(line["frame"])] = ([float(line[f"{c}_m"]) for c in "xyz"], [1.0] * 3)
    return out


def main():
    subprocess.run(["rm", "-rf", str(SCRATCH)], check=True)
    SCRATCH.mkdir(parents=True)
    parts = sys.argv[1:] or ["simulated", "trials"]
    if "simulated" in parts:
        simulated()
    if "trials" in parts:
        if not DATA.is_dir():
            print(f"SKIP | joints without segments | - | no recordings in {DATA}", flush=True)
        else:
            trials()
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
