#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Plug-in Gait with a subject's offsets: walks and static trials of several laboratories beside Vicon's own numbers.

    segments_offsets.py

Needs KINEMARK_PROGRAM and KINEMARK_TEST_DATA. Prints rows "PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import csv
import json
import math
import os
import statistics
import sys
import tempfile
from pathlib import Path

import segments_vicon as vicon
from rows import exit_status
from segments_vicon import kinemark, read_c3d, read_results, row, turned

BONES = ("FEO", "FEA", "FEL", "FEP", "TIO", "TIA", "TIL", "TIP", "FOO", "FOA", "FOL", "FOP")
OUTPUTS = ",".join(["PELO", "PELA", "PELL", "PELP", *(side + bone for side in "LR" for bone in BONES)])
OFFSETS = ("ThighRotation", "ShankRotation", "TibialTorsion", "AnkleAbAdd")


def analyze(recording, out, *arguments):
    result = kinemark("analyze", recording, "--segments", "pig", "--refits", "0", "--force", "-o", out, *arguments)
    return result.stderr, json.loads((out / "segments.json").read_text(encoding="utf-8"))


def quantile(values, q):
    values = sorted(values)
    return values[round(q * (len(values) - 1))] if values else math.nan


def differences(out, theirs, suffix=""):
    """Absolute differences of each component of an angle, deg, and of each centre, mm, where both have a frame."""
    angles, centres = read_results(out)
    found = {}
    for name, components in angles.items():
        reference = theirs.get(name + suffix)
        if reference is None or len(components) != 3:
            continue
        for k, (component, cells) in enumerate(components.items()):
            found[f"{name} {component}"] = [abs(turned(value - point[k])) for (value, _), point in zip(cells, reference, strict=True)
                                            if point is not None and any(point) and math.isfinite(value)]
    far = {}
    for centre, positions in centres.items():
        reference = theirs.get(centre[0] + vicon.CENTRES.get(centre[1:], "-"))
        if reference is not None:
            far[centre] = [math.dist(position, point) for position, point in zip(positions, reference, strict=True)
                           if point is not None and any(point) and math.isfinite(position[0])]
    return found, far


def worst(found):
    return max(((max(values), name) for name, values in found.items() if values), default=(math.inf, "nothing"))


def agreement(folder, data):
    """Recordings whose markers are those that the model ran on."""
    clinics, btk = data / "c3d-parser-clinics", data / "btk-others"
    trials = [(clinics / "MH0222_BP15.c3d", (), ""), (clinics / "S4-AMGait03.c3d", (), ""),
              (btk / "PiG_Motion3_FF.c3d", ("--static", btk / "PiG_Calibration3_FF.c3d"), "V")]
    for name in ("MH0222_BP08", "MH_Cal_01", "S4_AM_Cal_01", "RBWH_Max_Cal_01"):
        trials.append((clinics / f"{name}.c3d", ("--static", clinics / f"{name}.c3d"), ""))
    for path, arguments, suffix in trials:
        said, results = analyze(path, folder / "out", *arguments)
        found, far = differences(folder / "out", read_c3d(path), suffix)
        angle, centre = worst(found), worst(far)
        numbers = sum(map(len, found.values()))
        row(angle[0] <= 0.01 and centre[0] <= 0.01 and numbers > 1000 and len(far) == 6, f"Plug-in Gait with its offsets, {path.stem}",
            "angles within 0.01 deg, centres within 0.01 mm of Vicon's",
            f"{angle[0]:.5f} deg ({angle[1]}), {centre[0]:.5f} mm ({centre[1]}), {numbers} numbers")
        row("It agrees with the file's own" in said and results["comparison"]["agrees"], f"agreement is said, {path.stem}",
            "in the summary line, and in JSON", results["comparison"]["sentence"])
        row("Assumed, and carried in the deviations: " in said and "MarkerDiameter 14 mm (SD 2" in said, f"the assumed diameter is said, {path.stem}",
            "14 mm (SD 2)", next((line for line in said.splitlines() if line.startswith("Assumed")), "not said")[:80])


def edited(folder, data):
    path = data / "c3d-parser-clinics" / "RBWH_bfnd_w1.c3d"
    said, results = analyze(path, folder / "out")
    found, _ = differences(folder / "out", read_c3d(path))
    legs = {name: values for name, values in found.items() if any(part in name for part in ("Pelvis", "Hip", "Knee", "Ankle", "Foot"))}
    medians = max(statistics.median(values) for values in legs.values())
    high = max(quantile(values, 0.95) for values in legs.values())
    row(medians <= 0.1 and high <= 0.5 and len(legs) == 30, "markers edited after the model ran, RBWH_bfnd_w1", "medians within 0.1 deg, 95 % within 0.5",
        f"largest median {medians:.4f} deg, largest 95 % {high:.3f}, {len(legs)} components")
    row("Markers were changed after the file's model ran" in said, "edited markers are said, RBWH_bfnd_w1", "a finding", results["comparison"]["findings"])
    diameter = next(p for p in results["parameters"] if p["name"] == "MarkerDiameter")
    row(abs(diameter["value"] - 9) < 0.1 and "model outputs" in diameter["from"] and diameter["sd"] == 2, "the diameter that the model ran with, RBWH_bfnd_w1",
        "9 mm by the file's own outputs, SD 2", f"{diameter['value']:.3f} mm, SD {diameter['sd']}, {diameter['from']}")


def named(folder, data):
    """What cannot agree: the parameter is named, and nothing else."""
    clinics, btk = data / "c3d-parser-clinics", data / "btk-others"
    foot = {f"{side}Static{part}" for side in "LR" for part in ("PlantFlex", "RotOff")}
    for path, arguments, expected in (
            (clinics / "QCMAS.dynamic.c3d", (), {"LHJC", "RHJC"}), (btk / "PiG_Motion3_FF.c3d", (), foot),
            (clinics / "MH0222_BP15.c3d", ("--subject", "LThighRotation=4.4"), {"LThighRotation"}),
            (clinics / "MH0222_BP15.c3d", ("--subject", "MarkerDiameter=16"), {"MarkerDiameter"}),
            (clinics / "S4-AMGait03.c3d", ("--subject", "RTibialTorsion=0"), {"RTibialTorsion"}),
            (clinics / "S4-AMGait03.c3d", ("--subject", "LAnkleAbAdd=0"), {"LAnkleAbAdd"}),
            (clinics / "S4-AMGait03.c3d", ("--subject", "RKneeWidth=120"), {"RKneeWidth"}),
            (clinics / "S4-AMGait03.c3d", ("--subject", "InterAsisDistance=230"), {"InterAsisDistance"})):
        _, results = analyze(path, folder / "out", *arguments)
        comparison = results["comparison"]
        causes = {cause["name"] for cause in comparison["explained_by"]}
        row(causes == expected and not comparison["agrees"], f"why it differs, {path.stem} {' '.join(map(str, arguments))}".strip(),
            ", ".join(sorted(expected)), ", ".join(sorted(causes)) or f"nothing: {comparison['findings']}")
    _, results = analyze(clinics / "MH_Cal_01.c3d", folder / "out")
    row(any("those of a static trial" in finding for finding in results["comparison"]["findings"]), "a static trial that was not named as one, MH_Cal_01",
        "said", results["comparison"]["findings"])


def without(source, target, *names):
    """A copy in which parameters of those names have others: what nobody stated."""
    data = source.read_bytes()
    for name in names:
        data = data.replace(name.encode(), name[:-1].encode() + b"Q")
    target.write_bytes(data)
    return target


def from_static(folder, data):
    """A walk whose offsets all come from its static trial."""
    clinics = data / "c3d-parser-clinics"
    walk = without(clinics / "MH0222_BP15.c3d", folder / "walk.c3d", *OFFSETS, "StaticPlantFlex", "StaticRotOff")
    analyze(walk, folder / "out", "--static", clinics / "MH0222_BP08.c3d", "--drop", OUTPUTS)
    found, far = differences(folder / "out", read_c3d(clinics / "MH0222_BP15.c3d"))
    angle, centre = worst(found), worst(far)
    row(angle[0] <= 0.01 and centre[0] <= 0.02, "static trial alone to walk, MH0222", "angles within 0.01 deg, centres within 0.02 mm of Vicon's",
        f"{angle[0]:.5f} deg ({angle[1]}), {centre[0]:.5f} mm ({centre[1]})")


def withheld(folder, data):
    """Where nobody states offsets, the truth lies in the deviations."""
    clinics = data / "c3d-parser-clinics"
    for stem in ("MH0222_BP15", "S4-AMGait03"):
        theirs = read_c3d(clinics / f"{stem}.c3d")
        for names in (OFFSETS, OFFSETS[:2]):
            said, _ = analyze(without(clinics / f"{stem}.c3d", folder / "walk.c3d", *names), folder / "out", "--drop", OUTPUTS)
            angles, _ = read_results(folder / "out")
            inside, count = 0, 0
            for name, components in angles.items():
                if name not in theirs or len(components) != 3:
                    continue
                for k, cells in enumerate(components.values()):
                    for (value, sd), point in zip(cells, theirs[name], strict=True):
                        if point is not None and any(point) and math.isfinite(value):
                            inside += abs(turned(value - point[k])) <= 1.959964 * sd
                            count += 1
            share = 100 * inside / max(1, count)
            row(share >= 95 and count > 1000 and f"L{names[0]} 0 deg" in said, f"offsets withheld ({len(names)} of a side), {stem}",
                "95 % intervals hold Vicon's angles, said to be assumed", f"{share:.1f} % of {count}")


def diameter(folder, data):
    """A diameter that nobody states, between 10.5 and 17.5 mm."""
    path = data / "c3d-parser-clinics" / "S4-AMGait03.c3d"
    analyze(path, folder / "out", "--drop", OUTPUTS)
    assumed, _ = read_results(folder / "out")
    for size in (10.5, 17.5):
        analyze(path, folder / "true", "--drop", OUTPUTS, "--subject", f"MarkerDiameter={size}")
        truth, _ = read_results(folder / "true")
        z = [abs(turned(value - true)) / sd for name in assumed for component in assumed[name]
             for (value, sd), (true, _) in zip(assumed[name][component], truth[name][component], strict=True) if math.isfinite(value) and sd > 0]
        # Where the diameter's effect passes through 0, what is left is its square: no normal number, thousandths of a degree.
        share = 100 * sum(value <= 1.959964 for value in z) / len(z)
        row(share >= 99, f"diameter withheld, {size} mm", "95 % intervals hold 99 % or more, as it is one error of less than 2 SD",
            f"{share:.2f} % of {len(z)}, 99.9 % within {quantile(z, 0.999):.2f} SD")


def moments(folder, data):
    """Moments beside Vicon's, in frames in which its plates bear more than 30 N or nothing."""
    clinics, btk = data / "c3d-parser-clinics", data / "btk-others"
    for path, arguments in ((clinics / "MH0222_BP15.c3d", ()), (clinics / "S4-AMGait03.c3d", ()),
                            (btk / "PiG_Motion3_FF.c3d", ("--static", btk / "PiG_Calibration3_FF.c3d"))):
        _, results = analyze(path, folder / "out", *arguments)
        mass = next(p["value"] for p in results["parameters"] if p["name"] == "Bodymass")
        theirs, found = read_c3d(path), {}
        with (folder / "out" / "loads.csv").open(newline="", encoding="utf-8") as file:
            for line in csv.DictReader(file):
                found.setdefault(line["name"], {}).setdefault(line["component"], []).append(float(line["value"]) if line["value"] else math.nan)
        for joint, bound in (("Ankle", 5), ("Knee", 16), ("Hip", 16)):
            errors = []
            for side in "LR":
                name = f"{side}{joint}Moment"
                push = [mass * math.hypot(*cells) for cells in zip(*found.get(f"{side}GroundReactionForce", {}).values(), strict=True)]
                for k, values in enumerate(found.get(name, {}).values()):
                    for value, point, force in zip(values, theirs.get(name, []), push, strict=True):
                        if point is not None and any(point) and math.isfinite(value) and (force == 0 or force >= 30):
                            errors.append(abs(1000 * value - point[k]))
            high = quantile(errors, 0.95)
            row(high <= bound and len(errors) > 300, f"Plug-in Gait moments, {joint.lower()}, {path.stem}", f"95 % within {bound} N mm/kg of Vicon's",
                f"95 % {high:.2f}, 99 % {quantile(errors, 0.99):.1f}, largest {max(errors, default=math.nan):.0f}, {len(errors)} numbers")


def main():
    data = Path(os.environ.get("KINEMARK_TEST_DATA", "../shared/data"))
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        for check in (agreement, edited, named, from_static, withheld, diameter, moments):
            check(folder, data)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
