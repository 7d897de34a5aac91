#!/usr/bin/env python3
# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""NWB files with a pose of ndx-pose, written by `convert --ndx-pose`, judged by pynwb, ndx-pose and nwbinspector; and files that
pynwb and ndx-pose write, read by kinemark. The recording is a real one as ezc3d reads it, with samples of every state.

Needs Python with ezc3d, pandas, pynwb, ndx-pose and nwbinspector. Finds the program in KINEMARK_PROGRAM and the recordings in
KINEMARK_TEST_DATA; prints rows "PASS|FAIL|SKIP | check | asked | measured"; exit status 1 when one fails.
"""

import datetime
import os
import subprocess
import sys
import tempfile
import warnings
from pathlib import Path

import ndx_pose
import numpy
import pandas
import pynwb
from nwbinspector import inspect_nwbfile

from rows import PROGRAM, exit_status, row

ROOT = Path(__file__).resolve().parent.parent.parent
DATA = Path(os.environ.get("KINEMARK_TEST_DATA", ROOT.parent / "shared" / "data"))
RECORDING = DATA / "pycgm-rom" / "Sample_Static.c3d"
STATES = ("interpolated", "model_filled", "upsampled")


def convert(*arguments):
    subprocess.run([PROGRAM, "convert", "--quiet", "--force", *map(str, arguments)], check=True)


def table_of(path):
    """(names, frames x markers x 3, frames x markers states, times) of a CSV of ours."""
    table = pandas.read_csv(path, keep_default_na=True)
    names = list(dict.fromkeys(table["marker"]))
    x = table[["x_m", "y_m", "z_m"]].to_numpy().reshape(-1, len(names), 3)
    return names, x, table["state"].to_numpy().reshape(-1, len(names)), table["time_s"].to_numpy()[:: len(names)]


def source(folder):
    """A real recording, some of its samples said to be made or missing."""
    convert(RECORDING, folder / "real.csv")
    table = pandas.read_csv(folder / "real.csv")
    for i, state in enumerate((*STATES, "missing", "rejected")):
        part = (table.index % 61) == 7 * i
        table.loc[part & (table["state"] == "measured"), "state"] = state
    table.loc[table["state"].isin(("missing", "rejected")), ["x_m", "y_m", "z_m"]] = numpy.nan
    table.to_csv(folder / "source.csv", index=False)
    return folder / "source.csv"


def judge_written(path, wanted):
    names, x, states, times = wanted
    with pynwb.NWBHDF5IO(str(path), "r") as io:
        module = io.read().processing["behavior"]
        pose, position = module["PoseEstimation"], module["Position"]
        table = module["markers"].to_dataframe()
        nodes = list(pose.skeleton.nodes[:])
        row(isinstance(pose, ndx_pose.PoseEstimation) and nodes == list(table["series"]) and list(table["marker"]) == names,
            "ndx-pose: a PoseEstimation whose skeleton has a node for each marker", f"{len(names)}", f"{len(nodes)}")
        same = sure = 0
        for m, node in enumerate(nodes):
            series = pose.pose_estimation_series[node]
            data = series.data
            got = numpy.asarray(data.data if isinstance(data, pynwb.TimeSeries) else data)[:]
            same += numpy.array_equal(got, x[:, m], equal_nan=True) and abs(series.rate - 1 / numpy.diff(times).mean()) < 1e-3
            confidence = {"measured": 1.0, **dict.fromkeys(STATES, 0.5)}
            sure += numpy.array_equal(series.confidence[:], [confidence.get(s, 0.0) for s in states[:, m]])
        row(same == len(nodes), "pynwb: positions of the pose and their rate", f"{len(nodes)} series to the bit", f"{same}")
        row(sure == len(nodes), "pynwb: confidence of each sample (1, 0.5, 0)", f"{len(nodes)} series", f"{sure}")
        row(len(position.spatial_series) == len(nodes), "pynwb: Position is there as without it", f"{len(nodes)} series", f"{len(position.spatial_series)}")
    problems = pynwb.validate(path=str(path))
    row(not problems, "pynwb.validate, with ndx-pose", "0 problems", f"{len(problems)} {problems[:1] if problems else ''}")
    found = list(inspect_nwbfile(nwbfile_path=str(path)))
    severe = [m for m in found if m.importance.name in ("CRITICAL", "ERROR", "PYNWB_VALIDATION")]
    row(not severe, "nwbinspector, with ndx-pose: critical findings and errors", "0",
        f"{len(severe)} of {len(found)} remarks{': ' + severe[0].message if severe else ''}")


def write_by_others(path, names, x, confidence, rate):
    """The pose of a recording by pynwb and ndx-pose alone."""
    nwb = pynwb.NWBFile(session_description="judge", identifier="judge", session_start_time=datetime.datetime(2026, 1, 1, tzinfo=datetime.timezone.utc))
    skeleton = ndx_pose.Skeleton(name="subject", nodes=names, edges=numpy.array([[0, 1], [1, 2]], dtype="uint8"))
    series = [ndx_pose.PoseEstimationSeries(name=name, data=x[:, m], unit="meters", reference_frame="lab", rate=rate, starting_time=0.0,
                                            confidence=confidence[:, m], confidence_definition="judge") for m, name in enumerate(names)]
    pose = ndx_pose.PoseEstimation(name="PoseEstimation", pose_estimation_series=series, description="judge", source_software="judge", skeleton=skeleton)
    behavior = nwb.create_processing_module(name="behavior", description="judge")
    behavior.add(ndx_pose.Skeletons(skeletons=[skeleton]))
    behavior.add(pose)
    with pynwb.NWBHDF5IO(str(path), "w") as io:
        io.write(nwb)


def main():
    warnings.simplefilter("ignore")
    if not RECORDING.is_file():
        print(f"SKIP | NWB with ndx-pose | a recording | {RECORDING} is not there")
        return 0
    with tempfile.TemporaryDirectory(dir=os.environ.get("KINEMARK_SCRATCH")) as scratch:
        folder = Path(scratch)
        start = source(folder)
        wanted = table_of(start)
        convert(start, folder / "pose.nwb", "--ndx-pose")
        judge_written(folder / "pose.nwb", wanted)
        convert(folder / "pose.nwb", folder / "back.csv")
        names, x, states, _ = table_of(folder / "back.csv")
        row(names == wanted[0] and numpy.array_equal(x, wanted[1], equal_nan=True) and bool((states == wanted[2]).all()),
            "kinemark: the file read back", f"{x.size} numbers and {states.size} states the same", f"{int((states == wanted[2]).sum())} states")
        safe = [f"p{i}" for i in range(len(names))]
        sure = numpy.where(numpy.isnan(wanted[1]).any(axis=2), 0.0, 0.9)
        filled = numpy.where(numpy.isnan(wanted[1]), 7.0, wanted[1])
        write_by_others(folder / "judge.nwb", safe, filled, sure, 100.0)
        convert(folder / "judge.nwb", folder / "judge.csv")
        names, x, _, _ = table_of(folder / "judge.csv")
        order = [names.index(name) for name in safe]
        row(numpy.array_equal(x[:, order], wanted[1], equal_nan=True), "kinemark: a pose that pynwb and ndx-pose wrote",
            f"{x.size} numbers the same, of confidence 0 missing", f"{int(numpy.isnan(x[:, order, 0]).sum())} missing of {x.size // 3}")
    return exit_status()


if __name__ == "__main__":
    sys.exit(main())
