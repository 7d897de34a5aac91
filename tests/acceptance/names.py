#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Marker sets by the names of a recording, and pairs of names that `ik` proposes where model and recording differ.

    tests/acceptance/names.py

Sets are spelled out here from their documentation, without the program's table. Of each, recordings with up to a fifth of the
names missing, under a subject's prefix, in other cases and with the side written in six ways, and recordings of names that are
no set; then models and recordings of different sets, whose pairs are known here, and what was proposed run as it stands.

Nothing of kinemark is used but the program. Needs KINEMARK_PROGRAM. Prints rows "PASS|FAIL | check | asked | measured"; exit
status 1 when one fails.
"""

import csv
import json
import random
import re
import shlex
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from pathlib import Path

import rows
from rows import exit_status, row

HERE = Path(tempfile.mkdtemp(prefix="names_"))


def run(*words):
    return rows.run(*words, folder=HERE)


ARMS = "FHD BHD SHO UPA ELB FRM WRA WRB FIN"
LEGS = "ASI PSI THI KNE TIB ANK HEE TOE"
CGM_LEGS = "ASI PSI THI THAP THAD KNE TIB TIAP TIAD ANK HEE TOE"
TRUNK = "C7 T10 CLAV STRN RBAK"
BODY = "Shoulder Elbow Wrist Hip Knee Ankle Eye Ear BigToe SmallToe Heel"
# Name of the set, stems of both sides, names of the middle, and what stands before a stem on the left and right.
SETS = [
    ("Plug-in Gait", f"{ARMS} {LEGS}", TRUNK, ("L", "R")),
    ("Plug-in Gait", LEGS, "", ("L", "R")),
    ("Plug-in Gait", ARMS, TRUNK, ("L", "R")),
    ("CGM2", f"{ARMS} {CGM_LEGS}", TRUNK, ("L", "R")),
    ("CGM2", CGM_LEGS, "", ("L", "R")),
    ("CMU", f"{ARMS} FWT BWT THI KNE SHN ANK HEE TOE MT5", "C7 T10 CLAV STRN RBAC", ("L", "R")),
    ("Vicon upper limb", "SHO UPA UPB UPC ELB MEP WRA WRB FIN", "C7 T10 CLAV STRN", ("L", "R")),
    ("Helen Hayes", "Shoulder Elbow Wrist ASIS Thigh Knee Shank Ankle Heel Toe", "Top.Head Front.Head Rear.Head V.Sacral", ("L.", "R.")),
    ("Helen Hayes", "ASIS Thigh Knee Shank Ankle Heel Toe", "V.Sacral", ("L.", "R.")),
    ("IOR", "IAS IPS FTC FLE FAX TTC FAL FCC FM1 FM5", "", ("L_", "R_")),
    (
        "OpenSim gait2354 and gait2392",
        "Acromium ASIS Thigh.Upper Thigh.Front Thigh.Rear Knee.Lat Knee.Med Shank.Upper Shank.Front Shank.Rear Ankle.Lat Ankle.Med "
        "Heel Midfoot.Sup Midfoot.Lat Toe.Lat Toe.Med Toe.Tip",
        "Sternum Top.Head V.Sacral",
        ("L.", "R."),
    ),
    (
        "OpenSim Rajagopal2016",
        "ACR ASH PSH UA1 UA2 UA3 LEL MEL FAsuperior FAradius FAulna ASI PSI TH1 TH2 TH3 LFC MFC TB1 TB2 TB3 LMAL MMAL CAL TOE MT5",
        "C7 CLAV",
        ("L", "R"),
    ),
    (
        "OpenCap",
        "shoulder_study .ASIS_study .PSIS_study knee_study mknee_study ankle_study mankle_study calc_study toe_study 5meta_study "
        "lelbow_study melbow_study lwrist_study mwrist_study thigh1_study thigh2_study thigh3_study sh1_study sh2_study sh3_study HJC_study",
        "C7_study",
        ("L_", "r_"),
    ),
    ("OpenPose BODY_25", BODY, "Nose Neck MidHip", ("L", "R")),
    ("HALPE 26", BODY, "Nose Neck Head Hip", ("L", "R")),
    ("COCO 17", "eye ear shoulder elbow wrist hip knee ankle", "nose", ("left_", "right_")),
    (
        "MediaPipe BlazePose",
        "eye_inner eye eye_outer ear mouth shoulder elbow wrist pinky index thumb hip knee ankle heel foot_index",
        "nose",
        ("left_", "right_"),
    ),
    ("Theia", "thigh_4X4 shank_4X4 foot_4X4 toes_4X4 clavicle_4X4 uarm_4X4 larm_4X4 hand_4X4", "worldbody_4X4 pelvis_4X4 torso_4X4 neck_4X4 head_4X4", ("l_", "r_")),
]
STYLES = [None, ("L_", "R_"), ("L.", "R."), ("Left", "Right"), ("left_", "right_"), ("L ", "R ")]


def sided(stem, side, style):
    """The name of a stem on the left (0) or right (1)."""
    return style[side] + stem.lstrip("._") if style != ("L_", "r_") or stem[0] not in "." else style[side][:1] + stem


def dressed(names, chance):
    """The names under a prefix, in another case, or as they are."""
    prefix = chance.choice(["", "", "Subject:", "Ann 01:"])
    case = chance.choice([str, str, str.lower, str.upper])
    return [prefix + case(name) for name in names]


def thinned(names, chance):
    """The names without up to a fifth of them, in another order."""
    kept = chance.sample(names, len(names) - int(chance.uniform(0.0, 0.2) * len(names)))
    return kept


def write_trc(path, names, positions=None):
    """Three frames of markers, in metres; scattered where no positions are given."""
    chance = random.Random(len(names))
    frames = 3
    lines = [f"PathFileType\t4\t(X/Y/Z)\t{path.name}", "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames"]
    lines.append(f"100\t100\t{frames}\t{len(names)}\tm\t100\t1\t{frames}")
    lines.append("Frame#\tTime\t" + "\t\t\t".join(names) + "\t\t")
    lines.append("\t\t" + "\t".join(f"X{i}\tY{i}\tZ{i}" for i in range(1, len(names) + 1)))
    lines.append("")
    fixed = positions or [[[chance.uniform(0.0, 1.8) for _ in "xyz"]] * frames for _ in names]
    for f in range(frames):
        lines.append(f"{f + 1}\t{f / 100:.2f}\t" + "\t".join(f"{x:.6f}" for place in fixed for x in place[f]))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def set_of(names):
    """What `info` calls the set of these names; None: no set."""
    path = HERE / "recording.trc"
    write_trc(path, names)
    done = run("info", path, "--json")
    if done.returncode != 0:
        raise RuntimeError(f"info: {done.stderr}")
    return json.loads(done.stdout).get("marker_set")


def check_sets():
    right, wrong, missing_wrong = 0, [], 0
    for k, (name, stems, middle, usual) in enumerate(SETS):
        for trial in range(10):
            chance = random.Random(1000 * k + trial)
            style = chance.choice(STYLES) or usual
            whole = [sided(stem, side, style) for stem in stems.split() for side in (0, 1)] + middle.split()
            names = thinned(whole, chance)
            found = set_of(dressed(names, chance))
            good = found is not None and found["name"] == name
            right += good
            if not good:
                wrong.append(f"{name} ({len(names)} of {len(whole)}): {found and found['name']}")
            elif found["markers"] - len(found["missing"]) > len(names):
                missing_wrong += 1
    total = 10 * len(SETS)
    row(right >= 0.98 * total, f"sets of {total} recordings", "the right one in 98 %", f"{100 * right / total:.1f} %{''.join('; ' + w for w in wrong[:3])}")
    row(missing_wrong == 0, "markers said to be there", "no more than there are", f"{missing_wrong} recordings with more")


WORDS = (
    "hand finger thumb cap belt plate rod stick ball racket bat tail paw snout wing beak hoof spine neck head arm leg trunk hip back wand tip base top "
    "front rear cluster rigid body marker point probe club shaft seat pedal crank bike handle foot shoe sock sole boot ski pole"
).split()


def other_names(chance):
    """Names that are no set: numbers, invented words, hands, animals, and sets of which too little is there."""
    kind = chance.randrange(5)
    count = chance.randint(4, 45)
    if kind == 0:
        return [chance.choice(["marker", "M", "P", "led", "Point_"]) + str(i) for i in range(count)]
    if kind == 1:
        return list({chance.choice(["L", "R", "L_", "R_", "left ", "right ", ""]) + chance.choice(WORDS) + chance.choice(["", "1", "2", "3", "_in", "_out"]) for _ in range(count)})
    if kind == 2:
        letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"
        return list({chance.choice("LR") + "".join(chance.choice(letters) for _ in range(3)) for _ in range(count)})
    if kind == 3:
        fingers = ["thumb", "index", "middle", "ring", "little"]
        return [f"{f}_{joint}" for f in fingers for joint in ("mcp", "pip", "dip", "tip")][:count]
    # Two thirds of one side of a set, beside a cluster or two: a leg, an arm.
    name, stems, _, usual = chance.choice([one for one in SETS if one[0] != "Vicon upper limb"])
    some = chance.sample(stems.split(), max(2, int(0.6 * len(stems.split()))))
    return [sided(stem, 1, usual) for stem in some] + [f"cluster{i}" for i in range(chance.randint(0, 8))]


def check_others():
    total, said = 250, []
    for trial in range(total):
        chance = random.Random(50000 + trial)
        names = other_names(chance)
        found = set_of(names)
        if found is not None:
            said.append(f"{found['name']} of {' '.join(names[:8])}")
    row(len(said) <= 0.01 * total, f"{total} recordings of other names", "no set in 99 %", f"{100 * (total - len(said)) / total:.1f} %{''.join('; ' + s for s in said[:3])}")


# What is one landmark: its name in each set, and a marker of our model that lies near to it.
LANDMARKS = {
    "asis": ("ASI", {"pig": "ASI", "gait2354": "ASIS", "rajagopal": "ASI", "ior": "IAS", "opencap": ".ASIS_study", "hayes": "ASIS"}),
    "psis": ("PSI", {"pig": "PSI", "rajagopal": "PSI", "ior": "IPS", "opencap": ".PSIS_study"}),
    "knee": ("KNE", {"pig": "KNE", "gait2354": "Knee.Lat", "rajagopal": "LFC", "ior": "FLE", "opencap": "knee_study", "hayes": "Knee"}),
    "knee_in": ("KNE", {"gait2354": "Knee.Med", "rajagopal": "MFC", "ior": "FME", "opencap": "mknee_study"}),
    "ankle": ("ANK", {"pig": "ANK", "gait2354": "Ankle.Lat", "rajagopal": "LMAL", "ior": "FAL", "opencap": "ankle_study", "hayes": "Ankle"}),
    "ankle_in": ("ANK", {"gait2354": "Ankle.Med", "rajagopal": "MMAL", "ior": "TAM", "opencap": "mankle_study"}),
    "heel": ("HEE", {"pig": "HEE", "gait2354": "Heel", "rajagopal": "CAL", "ior": "FCC", "opencap": "calc_study", "hayes": "Heel"}),
    "toe": ("TOE", {"pig": "TOE", "rajagopal": "TOE", "ior": "FM2", "opencap": "toe_study", "hayes": "Toe"}),
    "toe_tip": ("TOE", {"gait2354": "Toe.Tip"}),
    "mt5": ("TOE", {"gait2354": "Toe.Lat", "rajagopal": "MT5", "ior": "FM5", "opencap": "5meta_study"}),
    "mt1": ("TOE", {"gait2354": "Toe.Med", "ior": "FM1"}),
    "shoulder": ("SHO", {"pig": "SHO", "gait2354": "Acromium", "rajagopal": "ACR", "opencap": "shoulder_study", "hayes": "Shoulder"}),
    "elbow": ("ELB", {"pig": "ELB", "rajagopal": "LEL", "opencap": "lelbow_study", "hayes": "Elbow"}),
    "elbow_in": ("ELB", {"rajagopal": "MEL", "opencap": "melbow_study"}),
    "wrist_thumb": ("WRA", {"pig": "WRA", "rajagopal": "FAradius", "opencap": "lwrist_study"}),
    "wrist_finger": ("WRB", {"pig": "WRB", "rajagopal": "FAulna", "opencap": "mwrist_study"}),
    "wrist": ("WRA", {"hayes": "Wrist"}),
    "thigh": ("THI", {"pig": "THI", "hayes": "Thigh"}),
    "thigh_cluster": ("THI", {"gait2354": "Thigh.Upper", "rajagopal": "TH1", "opencap": "thigh1_study"}),
    "thigh_cluster_2": ("THI", {"gait2354": "Thigh.Front", "rajagopal": "TH2", "opencap": "thigh2_study"}),
    "shank": ("TIB", {"pig": "TIB", "hayes": "Shank"}),
    "shank_cluster": ("TIB", {"gait2354": "Shank.Upper", "rajagopal": "TB1", "opencap": "sh1_study"}),
    "fibula": ("TIB", {"ior": "FAX"}),
    "trochanter": ("THI", {"ior": "FTC"}),
    "c7": ("C7", {"pig": "C7", "rajagopal": "C7", "opencap": "C7_study"}),
    "notch": ("CLAV", {"pig": "CLAV", "rajagopal": "CLAV"}),
    "sternum": ("STRN", {"pig": "STRN", "gait2354": "Sternum"}),
    "top": ("RFHD", {"gait2354": "Top.Head", "hayes": "Top.Head"}),
    "sacrum": ("RPSI", {"gait2354": "V.Sacral", "hayes": "V.Sacral"}),
}
MIDDLE = {"c7", "notch", "sternum", "top", "sacrum"}
USUAL = {"pig": ("L", "R"), "gait2354": ("L.", "R."), "rajagopal": ("L", "R"), "ior": ("L_", "R_"), "opencap": ("L_", "r_"), "hayes": ("L.", "R.")}
# One person counts these as one landmark, another does not: neither right nor wrong.
ALSO = {frozenset(("wrist", "wrist_thumb"))}


def markers_of(name, style=None):
    """{name: (landmark, side, marker of our model)} of a set."""
    out = {}
    for landmark, (base, names) in LANDMARKS.items():
        if name not in names:
            continue
        if landmark in MIDDLE:
            out[names[name]] = (landmark, -1, base)
        else:
            for side in (0, 1):
                out[sided(names[name], side, style or USUAL[name])] = (landmark, side, "LR"[side] + base)
    return out


class Subject:
    """A simulated subject: its model and its markers in three frames."""

    def __init__(self):
        made = run("simulate", "subject", "-o", "subject", "--duration", 0.2, "--seed", 5)
        read = run("convert", "subject/markers.c3d", "base.csv", "--force")
        if made.returncode != 0 or read.returncode != 0:
            raise RuntimeError(made.stderr + read.stderr)
        self.positions = {}
        with (HERE / "base.csv").open(newline="") as file:
            for line in csv.DictReader(file):
                if line["x_m"]:
                    self.positions.setdefault(line["marker"], []).append([float(line[a]) for a in ("x_m", "y_m", "z_m")])
        self.tree = ElementTree.parse(HERE / "subject" / "model.osim")

    def write_model(self, path, markers):
        """The model with these markers in place of its own."""
        tree = ElementTree.ElementTree(ElementTree.fromstring(ElementTree.tostring(self.tree.getroot())))
        objects = tree.getroot().find(".//MarkerSet/objects")
        own = {marker.get("name"): ElementTree.tostring(marker) for marker in objects.findall("Marker")}
        for marker in list(objects):
            objects.remove(marker)
        for name, (_, _, base) in markers.items():
            marker = ElementTree.fromstring(own[base])
            marker.set("name", name)
            objects.append(marker)
        tree.write(path)

    def write_recording(self, path, markers):
        names = list(markers)
        write_trc(path, names, [self.positions[markers[name][2]][:3] for name in names])


def proposed(text):
    """Pairs (recorded, wanted) of a proposal, and its options as they stand."""
    found = re.search(r"(?:--rename (?:'(?:[^']|'\\'')*'|\S+) ?)+", text)
    if found is None:
        return [], None
    words = shlex.split(found.group(0))
    return [tuple(pair.rsplit("=", 1)) for value in words[1::2] for pair in value.split(",")], words


def check_pairs():
    subject = Subject()
    counts = {"right": 0, "wrong": 0, "side": 0, "there": 0}
    wrong, ran, pasted, refused = [], 0, 0, []
    for trial, (recorded_set, model_set) in enumerate((a, b) for a in USUAL for b in USUAL for _ in (0, 1)):
        chance = random.Random(70000 + trial)
        style = chance.choice(STYLES)
        if recorded_set == model_set and style in (None, USUAL[model_set]):
            style = ("Left ", "Right ")
        recorded = markers_of(recorded_set, style)
        kept = set(thinned(list(recorded), chance))
        prefix = chance.choice(["", "Subject:"])
        recorded = {prefix + name: what for name, what in recorded.items() if name in kept}
        wanted = markers_of(model_set)
        subject.write_model(HERE / "model.osim", wanted)
        subject.write_recording(HERE / "walk.trc", recorded)
        command = ("ik", "--model", "model.osim", "--markers", "walk.trc", "-o", "walk.mot", "--force")
        said = run(*command)
        pairs, option = proposed(said.stdout + said.stderr)
        bare = {name.rsplit(":", 1)[-1] for name in recorded}
        of_landmark = {what[:2]: name for name, what in recorded.items()}
        counts["there"] += sum(what[:2] in of_landmark for name, what in wanted.items() if name not in bare)
        for old, new in pairs:
            is_, should = recorded[old], wanted[new]
            if frozenset((is_[0], should[0])) in ALSO and is_[1] == should[1]:
                continue
            counts["right" if is_[:2] == should[:2] else "wrong"] += 1
            counts["side"] += is_[1] != should[1]
            if is_[:2] != should[:2]:
                wrong.append(f"{old}={new}")
        if option is not None:
            pasted += 1
            again = run(*command, *option)
            after, _ = proposed(again.stdout + again.stderr)
            ran += again.returncode in (0, 1) and not set(after) & set(pairs)
            if again.returncode not in (0, 1):
                refused.append(" ".join(again.stderr.split())[:150])
    asked = counts["right"] + counts["wrong"]
    row(asked > 0 and counts["right"] >= 0.95 * asked, f"{asked} pairs of names that ik proposes", "right in 95 %", f"{100 * counts['right'] / max(1, asked):.1f} %{''.join('; ' + w for w in wrong[:4])}")
    row(counts["side"] == 0, "pairs of the other side", "0", str(counts["side"]))
    row(counts["right"] >= 0.9 * counts["there"], f"{counts['there']} markers that the recording has under another name", "proposed in 90 %", f"{100 * counts['right'] / counts['there']:.1f} %")
    row(pasted > 0 and ran == pasted, f"{pasted} proposals pasted behind the command", "each runs, and is proposed no more", f"{ran}{''.join('; ' + r for r in refused[:2])}")


def main():
    check_sets()
    check_others()
    check_pairs()
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
