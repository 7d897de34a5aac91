#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""A real recording as C3D, MAT, NWB and CSV, with a journal of edits beside each, through every command that reads one:
the same numbers and the same sentences. And every option of a recording in every command: the same words, refused alike."""

import json
import os
import re
import shutil
import sys
import tempfile
from pathlib import Path

from rows import row, run

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA") or ROOT.parent / "shared" / "data")
WALK = DATA / "c3d-parser-clinics" / "MH0222_BP15.c3d"
STEPS = DATA / "btk-others" / "PiG_Motion3_FF.c3d"
TAI_CHI = DATA / "motionmachine-taichi" / "taichi.v3d"
HAND = DATA / "dfki-hand" / "recording.tsv"
MODEL = DATA / "opensim-gait2354" / "subject01_simbody.osim"
OPTIONS = ("--rate", "--edits", "--select", "--drop", "--rename", "--frames", "--start", "--end", "--up", "--rotate", "--doubtful")
COMMANDS = ("info", "convert", "clean", "ik", "track", "joints", "scale", "analyze", "report")
MEASURES = {"LegLength": 880, "KneeWidth": 100, "AnkleWidth": 70, "ThighRotation": 2, "ShankRotation": 3, "TibialTorsion": -10, "StaticPlantFlex": 4,
            "StaticRotOff": -2, "AnkleAbAdd": 5, "AsisTrocanterDistance": 70, "SoleDelta": 0}  # all that the walk's own parameters would say: the other formats do not keep them
SUBJECT = [word for side in "LR" for name, value in MEASURES.items() for word in ("--subject", f"{side}{name}={value}")]
SUBJECT += ["--subject", "MarkerDiameter=14", "--subject", "InterAsisDistance=240"]
LEGS = "LASI,RASI,LPSI,RPSI,LTHI,RTHI,LKNE,RKNE,LTIB,RTIB,LANK,RANK,LHEE,RHEE,LTOE,RTOE"


def group_of(text):
    """{option: its words} of the group "Recording" of a command's help."""
    lines = text.split("\nRecording:\n")[1].split("\n\n")[0]
    words = [" ".join(entry.split()) for entry in re.split(r"\n(?=  -)", "\n" + lines)[1:]]
    return {re.search(r"--[a-z-]+", entry)[0]: re.sub("=(drop|keep) ", " ", entry) for entry in words}


def check_words():
    groups = {command: group_of(run(command, "--help").stdout) for command in COMMANDS}
    blank = [f"{c} {o}" for c in COMMANDS for o in OPTIONS if o not in groups[c]]
    other = [f"{c} {o}" for c in COMMANDS for o in groups[c] if groups[c][o] != groups["info"].get(o)]
    row(not blank, "options of a recording in 9 commands x 11", "no blank", f"{len(blank)} blank {' '.join(blank[:3])}")
    row(not other, "words of these options", "the same in all", f"{len(other)} other {' '.join(other[:3])}")


def numbers_of(path):
    """Lines of a result, without names of its input and of its set of files."""
    text = re.sub(r"walk\.(c3d|mat|nwb|csv)", "walk", path.read_text())
    return [line for line in text.splitlines() if line and not line.startswith(("#", "kinemark_s"))]


def results(folder, name):
    """{command: what it finds in the recording `name`}; the sentences on edits."""
    found, said = {}, {}
    kept = ("--select", LEGS)
    jobs = {
        "clean": (("clean", name, "o.csv", *kept, "--force"), "o.csv"),
        "convert": (("convert", name, "o.csv", *kept, "--force"), "o.csv"),
        "joints": (("joints", name, "-o", "o.csv", *kept, "--force"), None),
        "analyze": (("analyze", name, "--measures", "path_length,mean_speed,peak_speed", *kept, "--refits", "0", "-o", "o.csv", "--force"), "o.csv"),
        "segments": (("analyze", name, "--segments", "pig", *SUBJECT, "--up", "z", *kept, "-o", "angles", "--force"), "angles/angles.mot"),
        "scale": (("scale", "-m", MODEL, "-t", name, "--up", "z", "--rename", "LASI=L.ASIS,RASI=R.ASIS,LANK=L.Ankle.Lat,RANK=R.Ankle.Lat,LHEE=L.Heel,RHEE=R.Heel,"
                   "LTOE=L.Toe.Tip,RTOE=R.Toe.Tip,LKNE=L.Knee.Lat,RKNE=R.Knee.Lat", "--max-frames", "10", "-o", "o.osim", "--force"), "o.osim"),
        "ik": (("ik", "-m", MODEL, "-t", name, "--up", "z", "--rename", "LASI=L.ASIS,RASI=R.ASIS,LANK=L.Ankle.Lat,RANK=R.Ankle.Lat,LHEE=L.Heel,RHEE=R.Heel,"
                "LTOE=L.Toe.Tip,RTOE=R.Toe.Tip,LKNE=L.Knee.Lat,RKNE=R.Knee.Lat", "--no-error-bars", "-o", "o.mot", "--force"), "o.mot"),
    }
    for command, (words, output) in jobs.items():
        done = run(*words, folder=folder)
        if done.returncode not in (0, 1):
            found[command] = f"status {done.returncode}: {done.stderr.strip()[:120]}"
            continue
        if output is None:
            found[command] = re.sub(r"[^\s]*walk\.\w+", "walk", done.stdout + "\n".join(done.stderr.splitlines()[:3]))
        else:
            found[command] = numbers_of(folder / output)
        said[command] = "edits of" in done.stderr or "edit of" in done.stderr
    return found, said


def largest_difference(one, other):
    """Of two lists of lines, over all of their numbers; infinite where they differ in words or length."""
    if one == other:
        return 0.0
    if isinstance(one, str) or isinstance(other, str) or len(one) != len(other):
        return float("inf")
    worst = 0.0
    for a, b in zip(one, other):
        for x, y in zip(re.split(r"[,\s]+", a), re.split(r"[,\s]+", b), strict=True):
            if x == y:
                continue
            try:
                worst = max(worst, abs(float(x) - float(y)))
            except ValueError:
                return float("inf")
    return worst


def check_formats(folder):
    shutil.copy(WALK, folder / "walk.c3d")
    first = json.loads(run("info", "walk.c3d", "--json", folder=folder).stdout)["first_frame"]
    base, _ = None, None
    for ending in ("c3d", "mat", "nwb", "csv"):
        place = folder / ending
        place.mkdir()
        name = f"walk.{ending}"
        made = run("convert", "walk.c3d", place / name, "--edits", "none", folder=folder)
        if made.returncode != 0:
            row(False, f"walk as .{ending}", "is written", made.stderr.strip()[:100])
            continue
        run("edit", name, "--crop", "--from", first + 20, folder=place)
        run("edit", name, "--swap", "LASI", "RASI", "--from", first + 100, folder=place)
        found, said = results(place, name)
        silent = [command for command, heard in said.items() if not heard]
        row(not silent, f".{ending}: edits beside it are applied and said by 7 commands", "all", f"silent: {' '.join(silent) or 'none'}")
        if base is None:
            base = found
            broken = [f"{c}: {text}" for c, text in found.items() if isinstance(text, str) and text.startswith("status")]
            row(not broken, "all commands run on the C3D", "7 of 7", f"{len(found) - len(broken)} {' '.join(broken)[:150]}")
            continue
        for command, one in found.items():
            worst = largest_difference(base[command], one)
            row(worst <= 1e-9, f".{ending}: {command}", "numbers of the C3D within 1e-9", f"{worst:.2g}" if worst < 1e300 else str(one)[:100])


def steps_of(folder, *words):
    """Measures of plates and instants of their steps: [(name, number)]; a sentence where that fails."""
    done = run("analyze", *words, "--measures", "gait,plates", "--refits", "0", "--json", folder=folder)
    if done.returncode not in (0, 1):
        return done.stderr.strip()[:120]
    found = json.loads(done.stdout)
    numbers = [(f"{m['measure']} {m.get('context', '')} {m.get('subject', '')} {m.get('region', '')}", m["value"]) for m in found["measures"]]
    return numbers + [(f"{e['label']} {e['context']}", e["time_s"]) for e in found["gait"]["events"] if e["source"] == "plate"]


def farthest(one, other, of):
    """The largest difference of numbers that `of` picks by name; infinite where names differ."""
    if isinstance(one, str) or isinstance(other, str):
        return float("inf")
    one, other = ([n for n in numbers if of(n[0])] for numbers in (one, other))
    if [n for n, _ in one] != [n for n, _ in other] or not one:
        return float("inf")
    return max(0.0 if a == b or a is None or b is None else abs(a - b) for (_, a), (_, b) in zip(one, other))


def check_forces(folder):
    """Plates of one recording as C3D, MAT, NWB, and TRC with a table of forces, a journal beside each."""
    shutil.copy(STEPS, folder / "steps.c3d")
    first = json.loads(run("info", "steps.c3d", "--json", folder=folder).stdout)["first_frame"]
    base = None
    for ending in ("c3d", "mat", "nwb", "trc"):
        place = folder / f"forces_{ending}"
        place.mkdir()
        run("convert", "steps.c3d", place / f"steps.{ending}", "--edits", "none", folder=folder)
        run("edit", f"steps.{ending}", "--crop", "--from", first + 20 if ending != "trc" else 21, folder=place)
        words = [f"steps.{ending}"]
        if ending == "trc":
            run("convert", "steps.c3d", place / "grf.mot", "--edits", "none", folder=folder)
            words += ["--forces", "grf.mot"]
        found = steps_of(place, *words)
        if base is None:
            base = found
            row(not isinstance(found, str), "steps on plates of the C3D", "found", f"{len(found)} numbers" if not isinstance(found, str) else found)
        elif ending in ("mat", "nwb"):
            worst = farthest(base, found, lambda _: True)
            row(worst <= 1e-9, f"steps on plates of the {ending.upper()}", "numbers of the C3D within 1e-9", f"{worst:.2g}" if worst < 1e300 else str(found)[:100])
        else:
            worst = farthest(base, found, lambda name: name.startswith("Foot "))
            row(worst <= 0.005, "steps of the TRC with a table of forces", "those of the C3D within 5 ms", f"{1e3 * worst:.2g} ms" if worst < 1e300 else str(found)[:100])


def check_back(folder):
    """A recording that went through NWB is a C3D again: channels, plates, events and forces."""
    for name, source in (("steps", STEPS), ("walk", WALK)):
        place = folder / f"back_{name}"
        place.mkdir()
        shutil.copy(source, place / "first.c3d")
        for way in ("mat", "nwb"):
            run("convert", "first.c3d", f"way.{way}", folder=place)
            run("convert", f"way.{way}", f"{way}.c3d", folder=place)
        facts = [json.loads(run("info", file, "--json", folder=place).stdout or "{}") for file in ("first.c3d", "way.nwb", "nwb.c3d")]
        keys = ("points", "frames", "rate_hz", "first_frame", "missing", "labels", "channels", "analog_channels", "analog_rate_hz", "force_plates", "events")
        other = [key for key in keys for after in facts[1:] if after.get(key, "none") != facts[0].get(key)]
        row(not other, f"{name}: C3D to NWB to C3D", f"{len(keys)} facts are the same", " ".join(other) or "the same")
        bytes_of = [(place / f"{way}.c3d").read_bytes() for way in ("mat", "nwb") if (place / f"{way}.c3d").is_file()]
        row(len(bytes_of) == 2 and bytes_of[0] == bytes_of[1], f"{name}: C3D by way of NWB", "bytes of that by way of MAT", f"{len(bytes_of)} files")
    place = folder / "back_steps"
    worst = farthest(steps_of(place, "first.c3d"), steps_of(place, "nwb.c3d"), lambda _: True)
    row(worst <= 1e-9, "steps: forces and steps after NWB", "numbers of the C3D within 1e-9", f"{worst:.2g}")


SAME = ("points", "frames", "rate_hz", "first_frame", "missing", "labels")  # which every format keeps
SAID = {"channels": "no marker", "analog_channels": "analog channel", "force_plates": "force plate", "events": "event", "filtered": "the filters of markers"}
ENDINGS = ("c3d", "mat", "nwb", "csv", "trc", "glb", "tsv")


def silent_losses(folder, source, ending, *rate):
    """What the recording `source` has, its conversion has not, and no note names."""
    out = folder / f"{source.stem}_{source.suffix[1:]}" / f"sub-01/motion/sub-01_task-a_tracksys-{ending}_motion.{ending}"
    out.parent.mkdir(parents=True, exist_ok=True)
    done = run("convert", source, out, *rate, folder=folder)
    if done.returncode not in (0, 1):
        return [done.stderr.strip()[:80]]
    before = json.loads(run("info", source, "--json", *rate, folder=folder).stdout)
    after = json.loads(run("info", out, "--json", folder=folder).stdout) if ending != "glb" else {key: before[key] for key in SAME}
    silent = [key for key in SAME if after[key] != before[key]]
    return silent + [key for key, word in SAID.items() if before.get(key) and after.get(key) != before.get(key) and word not in done.stderr]


def check_kept(folder):
    """Every format that is read, written as every other: what is not kept is said."""
    shutil.copy(STEPS, folder / "kept.c3d")
    run("clean", "kept.c3d", "smooth.nwb", "--derivatives", "--quiet", folder=folder)
    sources = [(folder / "kept.c3d", ()), (folder / "smooth.nwb", ()), (TAI_CHI, ("--rate", "179")), (HAND, ())]
    for ending in ENDINGS[1:5]:
        run("convert", "kept.c3d", f"kept.{ending}", "--quiet", folder=folder)
        sources.append((folder / f"kept.{ending}", ()))
    pairs = [(source, ending, rate) for source, rate in sources if source.is_file() for ending in ENDINGS]
    silent = [f"{source.name} to {ending}: {' '.join(lost)}" for source, ending, rate in pairs if (lost := silent_losses(folder, source, ending, *rate))]
    row(not silent, f"{len(pairs)} conversions: what the new format does not keep is said", "all", f"{len(silent)} silent {'; '.join(silent[:3])}")
    said = run("convert", "smooth.nwb", "again.nwb", folder=folder).stderr
    row("not carried on: derivatives of markers" in said, "derivatives that a conversion leaves behind are said", "said", said.splitlines()[0][:100] if said else "")


def main():
    check_words()
    if not WALK.is_file():
        print(f"SKIP | one recording in four formats | | NO REAL DATA: {WALK} is not there; set KINEMARK_TEST_DATA")
        return 0
    with tempfile.TemporaryDirectory() as folder:
        check_formats(Path(folder))
        if STEPS.is_file():
            check_forces(Path(folder))
            check_back(Path(folder))
            check_kept(Path(folder))
        else:
            print(f"SKIP | steps on plates in four formats | | NO REAL DATA: {STEPS} is not there; set KINEMARK_TEST_DATA")
    return 0


sys.exit(main())
