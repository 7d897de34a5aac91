#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Every marker format that is read into every one that is written, and back: what the new file holds, and what
`convert --json` says that it has lost, which must be all of that and nothing else.

The formats are those of `kinemark help --formats`. Each file is looked at as the MAT file that kinemark makes of it, read
by scipy.io: MAT keeps all parts but groups of parameters. The source of the formats that are written is a trial with
every part, written here by scipy.io; those that are only read have a small file of the fuzzers, AMC a real one.

Needs Python with scipy. Finds the program in KINEMARK_PROGRAM and the recordings in KINEMARK_TEST_DATA; prints rows
"PASS|FAIL|NOTE | check | asked | measured"; exit status 1 when one fails.
"""

import json
import os
import re
import sys
import tempfile
from pathlib import Path

import numpy
import scipy.io

from rows import run

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared/data"))
CORPUS = ROOT / "tests" / "fuzz" / "corpus"
# Of formats that are only read: folder of the corpus (else that of its ending) and how such a file begins.
SAMPLES = {"Qualisys TSV": ("vendor_exports", b"NO_OF_FRAMES"), "Motive CSV": ("vendor_exports", b"Format Version"),
           "Vicon CSV": ("vendor_exports", b"Devices"), "PhaseSpace CSV": ("vendor_exports", b"0.000000,4,")}
LABORATORY = "FunctionalWalk.c3d"  # a recording with groups of parameters, if it is there; else the first C3D file that has some
PARTS = ("provenance", "covariances", "sample times", "residuals, cameras", "channels", "analog", "events", "force plates")
WORDS = {"provenance": "the provenance of", "covariances": "covariances of samples", "sample times": "times of samples within",
         "residuals, cameras": "reconstruction residuals", "channels": r"that (is|are) no marker", "analog": r"analog channel",
         "events": r"\d events?\b", "force plates": "force plate", "other groups": r"groups? of parameters"}
LOST = re.compile(r"cannot be stored|kept as")


def row(verdict, what, asked, measured):
    print(f"{verdict} | {what} | {asked} | {measured}", flush=True)
    return verdict != "FAIL"


def formats():
    """Rows of the table: name, ending, read, precision of what is written (empty: not), parts kept."""
    lines = [[cell.strip() for cell in line.strip("| \n").replace("||", "| |").split("|")]
             for line in run("help", "--formats").stdout.splitlines() if line.startswith("|")]
    heads, out = lines[0], []
    for cells in lines[2:]:
        cells += [""] * (len(heads) - len(cells))
        out.append({"name": cells[0], "ending": cells[1].strip("`"), "read": cells[2] == "yes", "precision": cells[3],
                    "kept": {head: cell for head, cell in zip(heads[4:], cells[4:])}})
    return out


def full_trial(path):
    """Everything that a trial can hold, but groups of parameters."""
    random = numpy.random.default_rng(8)
    frames, markers = 6, 5
    data = random.uniform(-1.5, 1.5, (frames, markers, 3))
    status = numpy.ones((frames, markers), numpy.uint8)
    status[1, 0], status[2, 1], status[3, 2], status[4, 3], status[5, 4] = 2, 3, 5, 0, 2
    method = numpy.zeros_like(status)
    method[1, 0] = method[5, 4] = 1
    method[2, 1] = 2
    gone = (status == 0) | (status == 5)
    data[gone] = numpy.nan
    residual = numpy.where(status == 1, random.uniform(2e-4, 2e-3, status.shape), numpy.nan).astype(numpy.float32)
    cameras = numpy.where(status == 1, random.integers(1, 128, status.shape), 0).astype(numpy.uint8)
    covariance = numpy.zeros((frames, markers, 6))
    covariance[..., [0, 3, 5]] = random.uniform(1e-7, 1e-6, (frames, markers, 3))
    corners = numpy.array([[0.4, 0.6, 0.0], [0.0, 0.6, 0.0], [0.0, 0.0, 0.0], [0.4, 0.0, 0.0]])
    cell = lambda texts: numpy.array([texts], dtype=object)
    events = numpy.array([("Foot Strike", "Left", 0.02), ("Foot Off", "Right", 0.04)], dtype=[(n, object) for n in ("label", "context", "time")])
    plates = numpy.array([(2.0, corners, [[0.0, 0.0, -0.04]], [[1.0, 2.0, 3.0, 4.0, 5.0, 6.0]], numpy.zeros((0, 0)))],
                         dtype=[(n, object) for n in ("type", "corners", "origin", "channels", "calibration")])
    trial = {"kinemark": 1.0, "source": "full", "software": "maker", "units": "m", "rate": 100.0, "start": 0.0, "first_frame": 1.0,
             "frames": float(frames), "time": numpy.arange(frames)[:, None] / 100.0, "labels": cell([f"M{i}" for i in range(markers)]),
             "data": data, "status": status, "method": method, "method_names": cell(["cubic", "rigid body"]), "covariance": covariance,
             "sample_offset": numpy.array([[0.0, 0.001, 0.002, 0.003, 0.004]]), "residual": residual, "cameras": cameras,
             "channels": {"labels": cell(["LKneeAngles", "LKneeMoment"]), "kinds": cell(["angle", "moment"]), "units": cell(["deg", "Nmm"]),
                          "rate": 100.0, "data": random.uniform(-90, 90, (frames, 2, 3))},
             "analog": {"labels": cell(["Fx1", "Fy1", "Fz1", "Mx1", "My1", "Mz1", "EMG"]), "units": cell(["N"] * 3 + ["Nmm"] * 3 + ["V"]),
                        "rate": 200.0, "data": random.uniform(-800, 800, (2 * frames, 7))},
             "events": events, "force_plates": plates}
    scipy.io.savemat(path, {"trial": trial})


def listed(value):
    return [] if value is None or (hasattr(value, "size") and value.size == 0) else list(value) if isinstance(value, (list, numpy.ndarray)) else [value]


def texts(value):
    return [str(v) if not hasattr(v, "size") or v.size else "" for v in listed(value)]


def look(path, rate, scratch):
    """What kinemark reads of a file, by scipy's reading of the MAT file that it makes; a sentence when it does not."""
    out = scratch / "look.mat"
    done = run("convert", "--quiet", "--force", *rate, path, out)
    if done.returncode:
        return done.stderr.strip()
    held = scipy.io.loadmat(out, simplify_cells=True)
    if "trial" not in held:
        return f"holds {', '.join(name for name in held if not name.startswith('__'))} and no recording of points"
    t = held["trial"]
    labels = texts(t["labels"])
    shape = (int(t["frames"]), len(labels))
    array = lambda name, *more: None if name not in t else numpy.reshape(t[name], (*shape, *more))
    names = texts(t.get("method_names"))
    method = array("method")
    found = {"labels": labels, "rate": float(t["rate"]), "first frame": int(t["first_frame"]), "positions": array("data", 3)}
    status = array("status")
    found["missing"] = (status == 0) | (status == 5)
    found["start"] = float(t["start"])
    offset = t.get("sample_offset")
    if offset is not None:  # one number for each marker, or for each sample that is there
        offset = numpy.where(found["missing"], 0.0, numpy.broadcast_to(numpy.reshape(offset, (-1, len(labels))), shape))
    found["provenance"] = (status, [] if method is None else [names[k - 1] if k else "" for k in method.ravel()])
    found["covariances"] = array("covariance", 6)
    found["sample times"] = offset
    found["residuals, cameras"] = (array("residual"), array("cameras"))
    c = t["channels"]
    found["channels"] = (texts(c["labels"]), texts(c["kinds"]), texts(c["units"]), numpy.asarray(c["data"]).ravel())
    a = t["analog"]
    found["analog"] = (texts(a["labels"]), texts(a["units"]), float(a["rate"]), numpy.asarray(a["data"]).ravel())
    found["events"] = [(str(e["label"]), str(e["context"]) if len(e["context"]) else "", float(e["time"])) for e in listed(t["events"])]
    found["force plates"] = [(float(p["type"]), numpy.asarray(p["corners"]), numpy.asarray(p["origin"]), numpy.asarray(p["channels"]).ravel())
                             for p in listed(t["force_plates"])]
    return found


def holds(found, part):
    value = found[part]
    if part == "provenance":
        return bool((value[0] > 1).any())
    if part == "residuals, cameras":
        return any(v is not None and bool((numpy.nan_to_num(v) > 0).any()) for v in value)
    if part in ("channels", "analog"):
        return bool(value[0])
    return value is not None and len(value) > 0


def alike(a, b, relative):
    """Equal words, and numbers within a part of the largest."""
    if isinstance(a, (tuple, list)):
        return isinstance(b, (tuple, list)) and len(a) == len(b) and all(alike(x, y, relative) for x, y in zip(a, b))
    if isinstance(a, str) or a is None or b is None:
        return a is b or (isinstance(a, str) and a == b)
    x, y = numpy.asarray(a, dtype=float), numpy.asarray(b, dtype=float)
    if x.shape != y.shape or (numpy.isnan(x) != numpy.isnan(y)).any():
        return False
    size = numpy.abs(numpy.nan_to_num(x)).max(initial=0.0)
    return bool(numpy.abs(numpy.nan_to_num(x - y)).max(initial=0.0) <= relative * max(size, 1e-9))


def digits(target, part, before):
    """Of the largest number of a part, how much a format may change."""
    if "float" not in target["precision"]:
        return 1e-12
    residual = before["residuals, cameras"][0]
    if part != "residuals, cameras" or residual is None:
        return 1e-6
    # C3D counts residuals in steps of its largest coordinate / 32000, from one step on.
    step = numpy.nanmax(numpy.abs(before["positions"])) / 32000
    return 1.01 * step / max(numpy.nanmax(residual), step)


def differences(before, after):
    """What of names, rate, time and missing samples differs. A first frame whose number is not that of its time (it is
    counted from elsewhere) need not come back: formats keep the time."""
    wrong = [what for what in ("labels", "rate", "missing") if not alike(before[what], after[what], 1e-6)]
    by_time = round(before["start"] * before["rate"]) + 1
    if abs(before["start"] - after["start"]) * before["rate"] > 0.51:
        wrong.append(f"start {before['start']} s, {after['start']} s")
    if before["first frame"] == by_time and after["first frame"] != by_time:
        wrong.append(f"first frame {by_time}, {after['first frame']}")
    return wrong


def path_in(folder, target):
    if target["name"] == "Motion-BIDS":
        return folder / "study" / "sub-01" / "motion" / "sub-01_task-walk_tracksys-omc_motion.tsv"
    return folder / f"file{target['ending']}"


def check_pair(before, source, rate, target, groups, scratch):
    """(problems in words, path of the new file)."""
    out = path_in(scratch / f"to_{target['name'].replace(' ', '_')}", target)
    out.parent.mkdir(parents=True, exist_ok=True)
    done = run("convert", "--json", "--force", *rate, source, out)
    if done.returncode:
        return [done.stderr.strip()], None
    said = [w for w in json.loads(done.stdout)["warnings"] if LOST.search(w)]
    after = look(out, [], scratch)
    if isinstance(after, str):
        return [f"does not come back: {after}"], None
    wrong = differences(before, after)
    if not alike(before["positions"], after["positions"], digits(target, "positions", before)):
        wrong.append("positions")
    for part in PARTS:
        lost = holds(before, part) and not alike(before[part], after[part], digits(target, part, before))
        stated = any(re.search(WORDS[part], w) for w in said)
        if lost != stated:
            wrong.append(f"{part} {'lost and not said' if lost else 'said to be lost and not'}")
    stated = any(re.search(WORDS["other groups"], w) for w in said)
    if stated != (groups and target["name"] != "C3D"):
        wrong.append(f"groups of parameters {'' if stated else 'not '}said to be lost")
    if len(said) != sum(any(re.search(words, w) for w in said) for words in WORDS.values()):
        wrong.append(f"sentences of no part: {said}")
    return wrong, out


def sample_of(form, scratch):
    """A small file of a format that is only read, with what it needs to be read; or nothing."""
    if form["name"] == "AMC":  # a pair of files
        real = next(iter(sorted(DATA.rglob("*.amc"))), None)
        return (real, ["--rate", "120"]) if real else None
    folder, begins = SAMPLES.get(form["name"], (form["ending"].lstrip("."), b""))
    rate = ["--rate", "100"] if form["name"] == "Visual3D text" else []
    for path in sorted((CORPUS / folder).glob("*")):
        data = path.read_bytes()
        if not data.startswith(begins):
            continue
        copy = scratch / f"sample{form['ending']}"
        copy.write_bytes(data)
        found = look(copy, rate, scratch)
        if not isinstance(found, str) and found["labels"] and len(found["positions"]) > 1 and not found["missing"].all():
            return copy, rate
    return None


def laboratory(scratch):
    """A real C3D file with groups that are not read."""
    for path in sorted(DATA.rglob("*.c3d"), key=lambda p: (p.name != LABORATORY, p.stat().st_size)):
        done = run("convert", "--json", "--force", path, scratch / "look.mat")
        if done.returncode == 0 and "of parameters cannot be stored" in done.stdout:
            return path
    return None


def sources(table, scratch):
    """(name, file, options to read it, whether it holds groups) of every format that is read."""
    full = scratch / "full.mat"
    full_trial(full)
    yield "MAT of scipy", full, [], False
    for form in table:
        if not form["read"]:
            continue
        if form["precision"]:
            file = path_in(scratch / f"from_{form['name'].replace(' ', '_')}", form)
            file.parent.mkdir(parents=True, exist_ok=True)
            done = run("convert", "--quiet", "--force", full, file)
            yield form["name"], file if done.returncode == 0 else done.stderr.strip(), [], False
        else:
            found = sample_of(form, scratch)
            yield form["name"], *(found or (None, [])), False
    if DATA.is_dir():
        yield "C3D of a laboratory", laboratory(scratch), [], True


def check_source(name, source, rate, groups, table, scratch):
    if not isinstance(source, Path):
        return row("NOTE" if source is None else "FAIL", f"{name}: into every format", "a file to begin with", source or "no sample")
    before = look(source, rate, scratch)
    if isinstance(before, str):
        return row("FAIL", f"{name}: into every format", "read", before)
    own = next((form for form in table if form["name"] == name and form["precision"]), None)
    wrong, ways, done = [], 0, []
    for target in table:
        if not target["precision"]:
            continue
        if not target["read"]:
            done.append(f"{target['name']} is not read back")
            continue
        problems, out = check_pair(before, source, rate, target, groups, scratch)
        wrong += [f"to {target['name']}: {p}" for p in problems]
        ways += 1
        if own is None or out is None:
            continue
        # And back into the format that it came from.
        back = path_in(scratch / "back", own)
        back.parent.mkdir(parents=True, exist_ok=True)
        again = run("convert", "--quiet", "--force", out, back)
        after = look(back, [], scratch) if again.returncode == 0 else again.stderr.strip()
        if isinstance(after, str):
            wrong.append(f"to {target['name']} and back: {after}")
        else:
            least = max(digits(target, "positions", before), digits(own, "positions", before))
            problems = differences(before, after)
            if not alike(before["positions"], after["positions"], least):
                problems.append("positions")
            wrong += [f"to {target['name']} and back: {what}" for what in problems]
    return row("FAIL" if wrong else "PASS", f"{name}: into every format and back", "values as the format's digits, losses said and no others",
               "; ".join(wrong[:6]) or f"{ways} formats" + (f"; {', '.join(done)}" if done else ""))


def main():
    table = formats()
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        good = [check_source(*source, table, scratch) for source in sources(table, scratch)]
    return 0 if all(good) else 1


if __name__ == "__main__":
    sys.exit(main())
