#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""What an NWB file holds besides movement (20 units, 4 trials, field potentials, a session of 2024), through every command
that reads a recording. Files by pynwb alone, by plain h5py with layouts of its own in two formats of HDF5, and two of ours (a simulated person,
a monkey's arm, a walk) to which pynwb appends. A snapshot by h5py judges: each dataset's type, shape, values and stored chunks, each attribute, each link; references
by what they lead to. pynwb, its validator and nwbinspector judge what was written.

Needs Python with h5py, pynwb and nwbinspector. `--seed N` for other numbers (default 1), `--quick` for two of the files. Prints rows
"PASS|FAIL | check | asked | measured"; exit status 1 when one fails.
"""

import argparse
import datetime
import json
import os
import sys
import tempfile
import time
import warnings
import zlib
from pathlib import Path

import h5py
import numpy
import pynwb
from nwbinspector import inspect_nwbfile
from pynwb.behavior import Position, SpatialSeries
from pynwb.ecephys import LFP, ElectricalSeries

from rows import exit_status, row, run

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "cli"))
from test_gait import NAMES, walk  # noqa: E402
from test_measures import write_trc  # noqa: E402

SESSION = datetime.datetime(2024, 3, 5, 10, 20, 30, tzinfo=datetime.timezone.utc)
SEVERE = ("CRITICAL", "ERROR", "PYNWB_VALIDATION")
UNITS, TRIALS = 20, 4


# What others hold ------------------------------------------------------------------------------------------------------


def add_physiology(nwb, random, seconds):
    """Probe, electrodes, units, trials, a field potential (compressed) and raw voltages (timestamps)."""
    probe = nwb.create_device(name="probe", description="silicon", manufacturer="judge")
    shank = nwb.create_electrode_group(name="shank", description="one", location="M1", device=probe)
    for i in range(8):
        nwb.add_electrode(x=0.0, y=0.0, z=1e-5 * i, imp=1e5, location="M1", filtering="none", group=shank)
    sites = nwb.create_electrode_table_region(region=list(range(8)), description="all")
    samples = int(1000 * seconds)
    lfp = ElectricalSeries(name="lfp", electrodes=sites, rate=1000.0, starting_time=0.0,
                           data=pynwb.H5DataIO(random.normal(0, 1e-4, (samples, 8)).astype("f4"), compression="gzip", chunks=(500, 8)))
    nwb.create_processing_module("ecephys", "field potentials").add(LFP(electrical_series=lfp))
    raw = ElectricalSeries(name="raw", electrodes=sites, timestamps=numpy.arange(2000) / 30000, conversion=1e-6,
                           data=random.integers(-100, 100, (2000, 8)).astype("i2"))
    nwb.add_acquisition(raw)
    for unit in range(UNITS):
        nwb.add_unit(spike_times=numpy.sort(random.uniform(0, seconds, 30 + unit)), electrodes=[unit % 8])
    nwb.add_trial_column("target", "where it went")
    for trial in range(TRIALS):
        nwb.add_trial(start_time=0.2 * seconds * trial, stop_time=0.2 * seconds * (trial + 1), target=f"t{trial}", timeseries=[raw])


def monkey():
    return pynwb.file.Subject(subject_id="m7", species="Macaca mulatta", sex="M", age="P6Y", weight="8 kg", description="trained")


def reach(random, k, frames):
    t = numpy.arange(frames) / 100
    x = numpy.stack([0.1 * numpy.sin(2 * t + k), 0.1 * numpy.cos(2 * t + 0.3 * k), 0.05 * k + 0.01 * t], 1)
    return x + random.normal(0, 2e-4, x.shape)


def by_pynwb(path, random):
    nwb = pynwb.NWBFile(session_description="reaching", identifier="judge-2024", session_start_time=SESSION, lab="motor", institution="judge",
                        experimenter=["Judge, A"], keywords=["reach", "M1"], subject=monkey())
    add_physiology(nwb, random, 5.0)
    series = [SpatialSeries(name=f"hand{k}", data=reach(random, k, 500), unit="meters", reference_frame="lab", rate=100.0, starting_time=0.0) for k in range(4)]
    nwb.create_processing_module("behavior", "paths").add(Position(spatial_series=series))
    with pynwb.NWBHDF5IO(str(path), "w") as io:
        io.write(nwb)


def attributes(thing, **values):
    for name, value in values.items():
        thing.attrs[name] = value


def typed(parent, name, kind, namespace="core"):
    group = parent.create_group(name)
    attributes(group, neurodata_type=kind, namespace=namespace, object_id=f"00000000-0000-8000-8000-{zlib.crc32(group.name.encode()):012x}")
    return group


def by_h5py(path, random, **options):
    """By hand: fixed and variable texts, records, enumerations, references to objects and regions, big-endian numbers, arrays without end,
    filters, empty values, a user block, soft and hard links."""
    with h5py.File(path, "w", **options) as f:
        attributes(f, neurodata_type="NWBFile", namespace="core", nwb_version="2.7.0", note=numpy.bytes_("by hand"))
        for name, value in (("identifier", "by hand"), ("session_description", "reaching"), ("session_start_time", SESSION.isoformat())):
            f[name] = value
        f.create_dataset("file_create_date", data=[SESSION.isoformat()], dtype=h5py.string_dtype())
        module = typed(f, "processing/behavior", "ProcessingModule")
        position = typed(module, "Position", "Position")
        for k in range(3):
            series = typed(position, f"hand{k}", "SpatialSeries")
            data = series.create_dataset("data", data=reach(random, k, 400).astype(">f8"), chunks=(64, 3), maxshape=(None, 3), compression="gzip", shuffle=True)
            attributes(data, unit="meters", conversion=1.0)
            series["starting_time"] = 2.0
            series["starting_time"].attrs["rate"] = 100.0
        lfp = typed(f, "acquisition/lfp", "ElectricalSeries")
        lfp.create_dataset("data", data=random.integers(-3000, 3000, (4096, 16)), dtype="<i2", chunks=(256, 16), compression="gzip", fletcher32=True, scaleoffset=None)
        attributes(lfp["data"], unit="volts", conversion=2e-7)
        lfp["timestamps"] = 2.0 + numpy.arange(4096) / 1000
        units = typed(f, "units", "Units", "hdmf-common")
        counts = random.integers(5, 60, UNITS)
        units["spike_times"] = numpy.sort(random.uniform(2, 6, counts.sum()))
        units["spike_times_index"] = numpy.cumsum(counts).astype("u2")
        units["spike_times_index"].attrs["target"] = units["spike_times"].ref
        units["id"] = numpy.arange(UNITS)
        units.create_dataset("label", data=numpy.array([f"u{i}" for i in range(UNITS)], dtype="S8"))
        units.create_dataset("quality", data=random.integers(0, 2, UNITS), dtype=h5py.enum_dtype({"bad": 0, "good": 1}, basetype="i1"))
        units.attrs.create("colnames", ["spike_times", "label", "quality"], dtype=h5py.string_dtype())
        trials = typed(f, "intervals/trials", "TimeIntervals")
        stretch = numpy.dtype([("idx_start", "<i4"), ("count", "<i4"), ("timeseries", h5py.ref_dtype)])
        trials.create_dataset("timeseries", data=numpy.array([(i * 1000, 1000, lfp.ref) for i in range(TRIALS)], dtype=stretch), chunks=(3,))
        trials["start_time"] = 2.0 + numpy.arange(TRIALS)
        trials["id"] = numpy.arange(TRIALS)
        trials.create_dataset("words", data=["ä", "", "long " * 4000, "b"], dtype=h5py.string_dtype(), chunks=(2,), compression="gzip")
        trials.create_dataset("regions", data=[lfp["data"].regionref[i:i + 10, 2] for i in range(TRIALS)], dtype=h5py.regionref_dtype)
        trials.create_dataset("lists", data=numpy.array([numpy.arange(i, dtype="i4") for i in range(1, TRIALS + 1)], dtype=object), dtype=h5py.vlen_dtype("i4"))
        trials.attrs.create("colnames", ["start_time", "timeseries", "words"], dtype=h5py.string_dtype())
        other = f.create_group("my lab/odd things")
        other.create_dataset("opaque", data=numpy.frombuffer(random.bytes(64), dtype="V8"))
        other.create_dataset("nothing", data=h5py.Empty("f4"))
        other.create_dataset("filled", shape=(1000, 1000), chunks=(100, 100), dtype="f4", fillvalue=7.0)
        other["filled"][5, 5] = 1.0
        other.create_dataset("of a filter of its own", data=random.integers(0, 9, 5000), chunks=(512,), compression="lzf")
        other["complex"] = numpy.array([1 + 2j, 3 - 1j])
        other["cube"] = random.normal(size=(3, 4, 5)).astype("f2")
        other["named type"] = numpy.dtype("i8")
        other["soft"] = h5py.SoftLink("/acquisition/lfp/data")
        other["dangling"] = h5py.SoftLink("/nowhere")
        other["hard"] = units["id"]
        f["general/lab"] = "by hand"
        typed(f, "general/subject", "Subject")["subject_id"] = "m7"


def appended(source, path, random):
    """A recording, converted to NWB by the program, to which pynwb appends."""
    run("convert", source, path, "--quiet", good=(0,))
    with pynwb.NWBHDF5IO(str(path), "a") as io:
        nwb = io.read()
        add_physiology(nwb, random, 6.0)
        io.write(nwb)
    return path


def person(folder, random, seed):
    run("simulate", "subject", "-o", folder / "subject", "--duration", 6, "--seed", seed, "--quiet", good=(0,))
    return appended(folder / "subject" / "markers.c3d", folder / "person.nwb", random)


def arm(folder, random, seed):
    run("simulate", "macaque", "-o", folder / "arm", "--duration", 6, "--seed", seed, "--quiet", good=(0,))
    return appended(folder / "arm" / "markers.c3d", folder / "arm.nwb", random)


def steps(folder, random):
    write_trc(folder / "steps.trc", walk(6.0), names=NAMES)
    return appended(folder / "steps.trc", folder / "steps.nwb", random)


# How they are held beside each other ------------------------------------------------------------------------------------


def plain(value, f):
    """A value whose references are the paths that they lead to."""
    if isinstance(value, h5py.RegionReference):
        return ("region", f[value].name, h5py.h5r.get_region(value, f.id).get_select_bounds()) if value else None
    if isinstance(value, h5py.Reference):
        return f[value].name if value else None
    if isinstance(value, h5py.Empty):
        return "empty"
    if isinstance(value, numpy.ndarray):
        if value.dtype.hasobject or value.dtype.names:
            return [plain(v, f) for v in value.ravel()]
        return value.tobytes()
    if isinstance(value, numpy.void) and value.dtype.names:
        return [plain(value[n], f) for n in value.dtype.names]
    return value.tobytes() if isinstance(value, numpy.generic) else value


def stored(dataset):
    """Chunks as they lie in the file."""
    if dataset.chunks is None or not dataset.shape:
        return None
    one = dataset.id
    if h5py.check_vlen_dtype(dataset.dtype) or h5py.check_string_dtype(dataset.dtype) or dataset.dtype.hasobject:
        return None  # they hold addresses
    return [one.read_direct_chunk(one.get_chunk_info(i).chunk_offset) for i in range(one.get_num_chunks())]


def snapshot(path):
    """Path -> what is there, of every object and link."""
    out, seen = {}, set()
    with h5py.File(path, "r") as f:
        def visit(group):
            seen.add(h5py.h5o.get_info(group.id).addr)
            for name in group:
                link = group.get(name, getlink=True)
                where = f"{group.name.rstrip('/')}/{name}"
                if isinstance(link, h5py.SoftLink):
                    out[where] = ("soft", link.path)
                    continue
                if isinstance(link, h5py.ExternalLink):
                    out[where] = ("external", link.filename, link.path)
                    continue
                thing = group[name]
                if isinstance(thing, h5py.Datatype):
                    out[where] = ("type", str(thing.dtype))
                    continue
                attrs = tuple((a, str(plain(thing.attrs[a], f))) for a in sorted(thing.attrs))
                if isinstance(thing, h5py.Dataset):
                    out[where] = (str(thing.dtype), thing.shape, thing.maxshape, thing.chunks, str(plain(thing[()], f)), stored(thing), attrs)
                elif h5py.h5o.get_info(thing.id).addr in seen:
                    out[where] = ("again", attrs)
                else:
                    out[where] = ("group", attrs)
                    visit(thing)
        visit(f)
        out["/"] = ("root", tuple((a, str(plain(f.attrs[a], f))) for a in sorted(f.attrs) if not a.startswith("kinemark")))
    return out


def ours(path):
    """Paths that a file's own list calls ours."""
    with h5py.File(path, "r") as f:
        return {p.decode() if isinstance(p, bytes) else str(p) for p in f.attrs.get("kinemark_content", [])}


def of_others(path):
    """What in a source is not ours."""
    own = ours(path)
    return {p: v for p, v in snapshot(path).items() if not any(p == o or p + "/" == o or p.startswith(o.rstrip("/") + "/") and not o.endswith("/") for o in own)}


def judge(name, source, target, wanted):
    got = snapshot(target)
    lost = [p for p, v in wanted.items() if got.get(p) != v]
    row(not lost, f"{name}: what is no movement", f"{len(wanted)} objects the same, stored chunks too", f"{len(wanted) - len(lost)}{': ' + lost[0] if lost else ''}")
    with h5py.File(source) as a, h5py.File(target) as b:
        heads = [k for k in ("identifier", "session_start_time", "general/subject/subject_id") if k in a]
        same = [k for k in heads if a[k][()] == b[k][()]]
    row(same == heads, f"{name}: identifier, date and person", f"{len(heads)} the same", f"{len(same)}")
    twice = [p for p, n in counted(got).items() if n > 1]
    row(not twice, f"{name}: object ids", "each once", "each once" if not twice else f"{twice[0]} twice")


def counted(objects):
    out = {}
    for value in objects.values():
        for attribute, text in value[-1] if isinstance(value[-1], tuple) else ():
            if isinstance(attribute, str) and attribute == "object_id":
                out[text] = out.get(text, 0) + 1
    return out


def judge_by_others(name, path):
    with pynwb.NWBHDF5IO(str(path), "r") as io:
        nwb = io.read()
        units, trials = len(nwb.units), len(nwb.trials)
        depth = float(nwb.processing["ecephys"]["LFP"]["lfp"].electrodes[7]["z"].iloc[0])
        span = nwb.trials["timeseries"][0]
        leads = span[0].timeseries.name if span else ""
        date = nwb.session_start_time
    row((units, trials, leads) == (UNITS, TRIALS, "raw") and abs(depth - 7e-5) < 1e-12, f"{name}: pynwb reads units, trials, electrodes",
        f"{UNITS}, {TRIALS}, references lead to raw", f"{units}, {trials}, to {leads}")
    problems = pynwb.validate(path=str(path))
    row(not problems, f"{name}: pynwb.validate", "0 problems", f"{len(problems)} {problems[:1] if problems else ''}")
    severe = [m for m in inspect_nwbfile(nwbfile_path=str(path)) if m.importance.name in SEVERE]
    row(not severe, f"{name}: nwbinspector", "nothing severe", f"{len(severe)}{': ' + severe[0].message if severe else ''}")
    return date


# Rows --------------------------------------------------------------------------------------------------------------------


def judge_info(source, name):
    done = run("info", "--json", source, good=(0, 1))
    beside = {b["path"]: b for b in json.loads(done.stdout)["beside_movement"]}
    lfp = next(b for p, b in beside.items() if p.endswith("/lfp"))
    good = beside["/units"]["shape"] == [UNITS] and beside["/intervals/trials"]["shape"] == [TRIALS] and lfp["unit"] == "volts" and len(lfp["shape"]) == 2
    text = run("info", source, good=(0, 1)).stdout
    row(good and "/units (Units, 20" in text, f"{name}: info lists units, trials, potentials", "paths, types, shapes, units; as text too", f"{len(beside)} objects")
    return beside


def judge_lost(folder, name, commands):
    """Where another format is written, one note says what stays behind."""
    for command, words in commands.items():
        done = run(*words, good=(0, 1))
        notes = [line for line in done.stderr.splitlines() if "/units" in line]
        row(len(notes) == 1, f"{name}: {command} says what it does not carry", "one line that names /units", f"{len(notes)}")


def through(source, folder, name, commands):
    wanted = of_others(source)
    before = source.read_bytes()
    for command, words in commands.items():
        target = folder / f"{name}_{command}{'_angles' if '--nwb' in words else ''}.nwb"
        run(*[target if w == "OUT" else w for w in words], good=(0, 1))
        judge(f"{name}, {command}", source, target, wanted)
        if not name.startswith("h5py"):  # which are no complete NWB files
            judge_by_others(f"{name}, {command}", target)
    row(source.read_bytes() == before, f"{name}: the input", "not touched", "not touched" if source.read_bytes() == before else "changed")


def judge_twice(source, folder, name):
    """The same bytes from the same input, a second later; nothing doubled when written again."""
    one, again, two = (folder / f"{name}_{n}.nwb" for n in ("one", "again", "two"))
    run("convert", source, one, good=(0, 1))
    time.sleep(1.1)
    run("convert", source, again, good=(0, 1))
    row(one.read_bytes() == again.read_bytes(), f"{name}: the same input, a second later", "the same bytes", "the same" if one.read_bytes() == again.read_bytes() else "others")
    run("convert", one, two, good=(0, 1))
    row(set(snapshot(one)) == set(snapshot(two)), f"{name}: written again from what was written", f"{len(snapshot(one))} objects", f"{len(snapshot(two))}")
    judge(f"{name}, twice", source, two, of_others(source))
    a, b = (run("convert", p, folder / f"{p.stem}.csv", "--force", good=(0, 1)) and (folder / f"{p.stem}.csv").read_text() for p in (source, two))
    row(a.splitlines()[1:] == b.splitlines()[1:], f"{name}: positions after two conversions", "the same", "the same" if a.splitlines()[1:] == b.splitlines()[1:] else "others")


def judge_measures(path, name):
    with h5py.File(path) as f:
        tables = {t for t in f["processing/measures"]} if "processing/measures" in f else set()
        values = {c for c in f["processing/measures/measures"]} if "measures" in tables else set()
    deviations = [c for c in values if c.endswith("_error_sd")]
    row({"measures", "measures_tidy", "measure_definitions", "provenance"} <= tables and bool(deviations), f"{name}: measures with deviations stand in their module",
        "4 tables", f"{len(tables)} tables, {len(deviations)} deviations")


def judge_angles(folder):
    """Angles and deviations of `ik --nwb` and `track --nwb` are those of the tables."""
    for verb in ("ik", "track"):
        with pynwb.NWBHDF5IO(str(folder / f"person_{verb}_angles.nwb"), "r") as io:
            table = io.read().processing["kinematics"]["coordinates"].to_dataframe()
        off, wrong = 0.0, []
        for ending, suffix in ((".mot", ""), ("_sd.sto", "_sd")):
            text = (folder / f"person_{verb}{ending}").read_text().split("endheader\n")[1].splitlines()
            names, rows = text[0].split("\t")[1:], numpy.array([[float(v) for v in line.split("\t")[1:]] for line in text[1:]])
            for k, one in enumerate(names):
                found = table[one + suffix].to_numpy()
                wrong += [] if (numpy.isnan(found) == numpy.isnan(rows[:, k])).all() else [one]
                off = max(off, float(numpy.nanmax(numpy.abs(found - rows[:, k]), initial=0.0)))
        row(off <= 1e-6 and not wrong, f"{verb} --nwb: angles and deviations", "those of .mot and _sd.sto to 1e-6", f"{off:.1e}")


def judge_events(folder):
    """Events of feet: in the recording, and with their deviations beside the measures."""
    with h5py.File(folder / "steps_gait.nwb") as f, h5py.File(folder / "steps_events.nwb") as g:
        table = f["processing/measures/movement_events"]
        times, sd = table["time_s"][:], table["sd_s"][:]
        written = g["processing/behavior/events/timestamp"][:]
    row(len(times) >= 8 and numpy.isfinite(sd).all() and numpy.allclose(numpy.sort(times), numpy.sort(written), atol=1e-9), "gait: events",
        "with deviations beside the measures, and in the recording", f"{len(times)} with deviations, {len(written)} in the recording")


def judge_bad(folder, random):
    """One sentence, a documented status, nothing half-written."""
    good = folder / "good.nwb"
    by_h5py(good, random)

    def changed(name, change):
        path = folder / f"{name}.nwb"
        path.write_bytes(good.read_bytes())
        with h5py.File(path, "a") as f:
            change(f)
        return path

    def other_clock(f):
        f.copy("processing/behavior/Position/hand0", f["processing/behavior/Position"], "late")
        f["processing/behavior/Position/late/starting_time"][()] = 77.0

    def loop(f):
        f["my lab/odd things/again"] = f["my lab"]

    def elsewhere(f):
        f["acquisition/far"] = h5py.ExternalLink("far.h5", "/x")

    def taken(f):
        f.create_group("processing/kinemark/Position")

    for name, change, says in (("two_clocks", other_clock, "do not share the clock"), ("loop", loop, None), ("external", elsewhere, "far.h5"), ("taken", taken, None)):
        path = changed(name, change)
        target = folder / f"{name}_out.nwb"
        done = run("convert", path, target)
        lost = [p for p, v in of_others(path).items() if snapshot(target).get(p) != v] if target.exists() else ["all"]
        row(done.returncode == 0 and not lost and (says is None or sum(says in line for line in done.stderr.splitlines()) == 1), f"bad input, {name}",
            f"status 0, all kept{', one line: ' + says if says else ''}", f"status {done.returncode}, {len(lost)} lost")
    # Samples whose checksum does not fit go along as they are; a broken group is refused.
    path = changed("damaged", lambda f: None)
    with h5py.File(path, "r") as f:
        info = f["acquisition/lfp/data"].id.get_chunk_info(3)
    data = bytearray(path.read_bytes())
    data[info.byte_offset + 20:info.byte_offset + 28] = b"\0damage\0"
    path.write_bytes(bytes(data))
    done = run("convert", path, folder / "damaged_out.nwb")
    with h5py.File(folder / "damaged_out.nwb", "r") as f:
        one = f["acquisition/lfp/data"].id
        same = b"\0damage\0" in one.read_direct_chunk(one.get_chunk_info(3).chunk_offset)[1]
    row(done.returncode == 0 and same, "bad input, damaged samples", "status 0, carried as they are", f"status {done.returncode}")
    path = folder / "cut.nwb"
    path.write_bytes(good.read_bytes()[:len(good.read_bytes()) // 2])
    before = set(os.listdir(folder))
    done = run("convert", path, folder / "cut_out.nwb")
    row(done.returncode == 3 and set(os.listdir(folder)) == before and len(done.stderr.strip().splitlines()) == 1, "bad input, half of a file", "status 3, one line, nothing written",
        f"status {done.returncode}")


def main():
    warnings.simplefilter("ignore")
    parser = argparse.ArgumentParser()
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--quick", action="store_true", help="two of the files")
    asked = parser.parse_args()
    seed = asked.seed
    random = numpy.random.default_rng(seed)
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        folder = Path(scratch)
        reaching, by_hand, late = folder / "reach.nwb", folder / "hand.nwb", folder / "late.nwb"
        by_pynwb(reaching, random)
        by_h5py(by_hand, random)
        by_h5py(late, random, libver=("v110", "v110"), userblock_size=1024)
        with h5py.File(late, "a", libver="latest") as f:  # of a type that an older HDF5 does not know
            f.create_dataset("my lab/tomorrow", data=numpy.arange(3000), chunks=(300,), compression="gzip")
        sources = {"pynwb": reaching, "h5py_later": late}
        if not asked.quick:
            sources |= {"h5py": by_hand, "person": person(folder, random, seed), "arm": arm(folder, random, seed), "steps": steps(folder, random)}
        model = folder / "subject" / "model.osim"
        for name, source in sources.items():
            commands = {"convert": ["convert", source, "OUT"], "clean": ["clean", source, "OUT", "--gaps", "auto", "--filter", "auto", "--derivatives"],
                        "measure": ["measure", source, "--refits", 0, "-o", "OUT"]}
            lost = {"convert to CSV": ["convert", source, folder / "x.csv", "--force"], "clean to TRC": ["clean", source, folder / "x.trc", "--force"],
                    "measure to CSV": ["measure", source, "--refits", 0, "-o", folder / "x.csv", "--force"]}
            if name == "person":
                solve = ["--model", model, "--markers", source, "--force", "-o"]
                commands |= {verb: [verb, *solve, folder / f"person_{verb}.mot", "--nwb"] for verb in ("ik", "track")}
                lost |= {"ik": ["ik", *solve, folder / "q.mot"], "track": ["track", *solve, folder / "q.mot"]}
            if name == "arm":
                find = ["joints", source, "--segments", folder / "arm" / "segments.toml", "--force", "-o"]
                commands["joints"] = [*find, "OUT"]
                lost["joints to CSV"] = [*find, folder / "j.csv"]
            if name == "steps":
                commands |= {"gait": ["gait", source, "--refits", 0, "-o", "OUT"], "events": ["gait", source, "--refits", 0, "--write-events", "OUT"]}
            judge_info(source, name)
            through(source, folder, name, commands)
            judge_measures(folder / f"{name}_measure.nwb", name)
            judge_twice(source, folder, name)
            judge_lost(folder, name, lost)
        if not asked.quick:
            judge_angles(folder)
            judge_events(folder)
        judge_bad(folder, random)
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
