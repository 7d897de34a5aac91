# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Sound files of every format, made by kinemark itself, and every command on them."""

import dataclasses
import subprocess

SEGMENTS = """[[segment]]
name = "upper_arm"
markers = ["s0m0", "s0m1", "s0m2", "s0m3"]
[[segment]]
name = "forearm"
markers = ["s1m0", "s1m1", "s1m2", "s1m3"]
[[joint]]
name = "elbow"
parent = "upper_arm"
child = "forearm"
"""

TASKS = """<OpenSimDocument Version="30000"><IKTaskSet><objects>
<IKMarkerTask name="LFHD"><apply>true</apply><weight>2</weight></IKMarkerTask>
<IKCoordinateTask name="pelvis_tilt"><apply>false</apply><value_type>default_value</value_type><weight>1</weight></IKCoordinateTask>
</objects></IKTaskSet></OpenSimDocument>
"""

SETUP = """<OpenSimDocument Version="30000"><InverseKinematicsTool name="trial">
<model_file>model.osim</model_file><marker_file>markers.trc</marker_file><output_motion_file>q.mot</output_motion_file>
<time_range>0 0.1</time_range>
<IKTaskSet><objects><IKMarkerTask name="LFHD"><apply>true</apply><weight>2</weight></IKMarkerTask></objects></IKTaskSet>
</InverseKinematicsTool></OpenSimDocument>
"""

SCALE_SETUP = """<OpenSimDocument Version="30000"><ScaleTool name="person"><mass>70</mass>
<GenericModelMaker><model_file>model.osim</model_file></GenericModelMaker>
<ModelScaler><apply>true</apply><scaling_order>measurements</scaling_order>
<MeasurementSet><objects><Measurement name="thigh"><apply>true</apply>
<MarkerPairSet><objects><MarkerPair><markers>RTHI RKNE</markers></MarkerPair></objects></MarkerPairSet>
<BodyScaleSet><objects><BodyScale name="femur_r"><axes>X Y Z</axes></BodyScale></objects></BodyScaleSet>
</Measurement></objects></MeasurementSet>
<marker_file>markers.trc</marker_file><time_range>0 0.1</time_range></ModelScaler>
</ScaleTool></OpenSimDocument>
"""


@dataclasses.dataclass(frozen=True)
class Command:
    """What is typed; words that are in `inputs` are the names of sound files. `writes` is the name of the output, if any;
    `other` are more words, with which a set of files of other content is written."""

    words: tuple[str, ...]
    inputs: tuple[str, ...]
    writes: str | None = None
    other: tuple[str, ...] = ()

    @property
    def name(self):
        return self.words[0]


def one(verb, name, *rest, writes=None):
    return Command((verb, name, *rest), (name,), writes)


KINDS = ("markers.c3d", "markers.trc", "markers.csv", "markers.nwb", "q.mot", "q.sto", "model.osim", "counts.mcap")

COMMANDS = (
    *(one("info", name) for name in KINDS),
    *(one("validate", name) for name in KINDS),
    *(
        one("convert", source, target, writes=target)
        for source, target in (
            *(("markers.c3d", "out.trc"), ("markers.trc", "out.c3d"), ("markers.csv", "out.nwb"), ("markers.nwb", "out.csv")),
            *(("q.mot", "out.sto"), ("q.sto", "out.mot"), ("model.osim", "out.osim"), ("markers.trc", "out.csv")),
        )
    ),
    one("clean", "markers.c3d", "out.csv", "--gaps", "auto", writes="out.csv"),
    one("clean", "markers.trc", "out.nwb", "--derivatives", writes="out.nwb"),
    Command(("clean", "markers.c3d", "out.c3d", "--derivatives"), ("markers.c3d",), "out.c3d", ("--cutoff", "6")),
    Command(("joints", "arm.c3d", "--segments", "segments.toml", "-o", "out"), ("arm.c3d", "segments.toml"), "out"),
    Command(("scale", "-m", "model.osim", "-t", "markers.trc", "-o", "out.osim", "--max-frames", "5"), ("model.osim", "markers.trc"), "out.osim", ("--end", "0.05")),
    Command(("scale", "--setup", "scale.xml", "-o", "out.osim"), ("scale.xml",), "out.osim"),
    Command(("ik", "-m", "model.osim", "-t", "markers.trc", "-o", "out.mot"), ("model.osim", "markers.trc"), "out.mot", ("--end", "0.05")),
    Command(("ik", "-m", "model.osim", "-t", "markers.c3d", "-o", "out.mot", "--tasks", "tasks.xml"), ("tasks.xml",), "out.mot"),
    Command(("ik", "--setup", "ik.xml", "-o", "out.mot"), ("ik.xml",), "out.mot"),
    Command(("track", "-m", "model.osim", "-t", "markers.c3d", "-o", "out.mot"), ("model.osim", "markers.c3d"), "out.mot", ("--end", "0.05")),
    Command(("report", "q.mot", "-o", "out.html"), ("q.mot", "q_report.json", "q_sd.sto", "q_marker_errors.sto"), "out.html"),
    Command(("simulate", "subject", "-m", "model.osim", "-o", "out", "--duration", "0.1"), ("model.osim",), "out"),
    Command(("simulate", "rig", "markers", "-t", "markers.trc", "-o", "out", "--marker", "LFHD", "--marker", "RFHD"), ("markers.trc",), "out"),
    Command(
        ("calibrate", "tree.mcap", "grid_A.mcap", "grid_B.mcap", "--nominal", "nominal.toml", "--align"),
        ("tree.mcap", "grid_A.mcap", "nominal.toml"),
    ),
    Command(
        ("reconstruct", "counts.mcap", "--rig", "rig.toml", "-o", "out.csv", "--method", "frames"), ("counts.mcap", "rig.toml"), "out.csv"
    ),
    Command(("edit", "markers.c3d", "--cut", "RFHD", "--edits", "edits.jsonl"), ("markers.c3d", "edits.jsonl")),
    Command(("clean", "markers.c3d", "out.c3d", "--edits", "edits.jsonl"), ("markers.c3d", "edits.jsonl"), "out.c3d", ("--cutoff", "6")),
    one("recover", "counts.mcap", "out.mcap", writes="out.mcap"),
)


def make_sound_files(program, folder):
    """Fills a folder with sound files of every kind, named as COMMANDS name them."""

    def run(*words):
        done = subprocess.run([program, *words, "--quiet"], cwd=folder, capture_output=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"kinemark {' '.join(words)}: exit status {done.returncode}: {done.stderr.decode(errors='replace')}")

    run("simulate", "subject", "-o", "subject", "--duration", "0.1", "--dropout-random", "0.05")
    for name in ("markers.c3d", "markers.trc", "model.osim"):
        (folder / "subject" / name).rename(folder / name)
    run("convert", "markers.c3d", "markers.csv")
    for words in (("--swap", "LFHD", "RFHD"), ("--cut", "LFHD", "--to", "3"), ("--undo", "1")):
        run("edit", "markers.c3d", "--edits", "edits.jsonl", *words)
    run("convert", "markers.c3d", "markers.nwb")
    run("ik", "-m", "model.osim", "-t", "markers.trc", "-o", "q.mot")
    run("convert", "q.mot", "q.sto")
    run("simulate", "arm", "-o", "arm", "--frames", "40", "--segments", "100,120", "--markers", "4", "--stagger", "15", "--noise", "0.2")
    (folder / "arm" / "markers.c3d").rename(folder / "arm.c3d")
    run("simulate", "rig", "sign", "-o", "rig", "--duration", "0.1", "--grid", "--tree-poses")
    for source, name in (
        *(("recording.mcap", "counts.mcap"), ("tree_poses.mcap", "tree.mcap"), ("grid_A.mcap", "grid_A.mcap")),
        *(("grid_B.mcap", "grid_B.mcap"), ("rig_nominal.toml", "nominal.toml"), ("rig_true.toml", "rig.toml")),
    ):
        (folder / "rig" / source).rename(folder / name)
    for name, text in {"segments.toml": SEGMENTS, "tasks.xml": TASKS, "ik.xml": SETUP, "scale.xml": SCALE_SETUP}.items():
        (folder / name).write_text(text)
