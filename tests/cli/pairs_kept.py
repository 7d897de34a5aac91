# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Every command that writes against every file that it reads, for test_inputs_kept.py and tests/acceptance/inputs_kept.py.

A command is a list of words; words below `in/` are files that it reads, words below `out/` are what it writes. Which files it opens is
watched (inotify), so that files beside others and files that others name count too; which files it writes is what it leaves in `out/`.
Then every written name is made a link to every file that was read, and the command runs with --force."""

import contextlib
import ctypes
import os
import re
import shutil
import struct
import subprocess
from pathlib import Path

from support import PROGRAM, run
from test_animation import AMC, ASF
from test_gait import NAMES, walk
from test_gait_page import write_motion
from test_images import Camera
from test_joints import arm
from test_measures import wheel, write_trc
from test_segments import DEFINITION, flexed
from test_segments import NAMES as ARM_NAMES
from test_skeletons import ON, skeleton

REFUSED = re.compile(r"is the file that is read as .*; name another output|is a link to a file that holds no options of a command; name another file")
# Names that a command refuses before it compares files: no format of its results.
OTHER_NAME = re.compile(r"another ending|is none of|are written as|need \.|ending of a file|cannot become|is written|cannot be written as|not written as|needs none|a folder")
EVERYWHERE = ["--config", "in/options.toml", "--save-config", "out/saved.toml", "--quiet"]
OPENED = 0x20  # IN_OPEN of inotify
SERVE_SECONDS = 20


class Watch:
    """Names of the files below a folder that are opened while it is watched."""

    def __init__(self, folder):
        self.libc = ctypes.CDLL(None, use_errno=True)
        self.fd = self.libc.inotify_init1(os.O_NONBLOCK)
        self.folders = {}
        for place in [folder, *(path for path in folder.rglob("*") if path.is_dir())]:
            self.folders[self.libc.inotify_add_watch(self.fd, os.fsencode(place), OPENED)] = place

    def opened(self):
        found = set()
        with contextlib.suppress(BlockingIOError):
            while True:
                events, at = os.read(self.fd, 1 << 16), 0
                while at < len(events):
                    watched, _, _, size = struct.unpack_from("iIII", events, at)
                    name = events[at + 16 : at + 16 + size].rstrip(b"\0").decode()
                    path = self.folders[watched] / name
                    if name and path.is_file():
                        found.add(path)
                    at += 16 + size
        return sorted(found)

    def close(self):
        os.close(self.fd)


class Bench:
    """A folder with `in/`, made once, and `out/`, empty before each run; `commands` holds the words of each command."""

    def __init__(self, folder, muscles=None):
        """`muscles`: a recording with electromyograms, which cannot be simulated; None leaves `emg` out."""
        self.folder = Path(folder)
        self.inputs, self.outputs = self.folder / "in", self.folder / "out"
        self.inputs.mkdir()
        self.commands = {}
        self._fill()
        if muscles:
            shutil.copyfile(muscles, self.inputs / "emg.c3d")
            self.commands["emg"] = ["emg", "in/emg.c3d", "-o", "out/x.csv", "--refits", "0", "--report", "out/x.html", "--write-envelopes", "out/e.sto",
                                    "--write-cycles", "out/cycles.csv", "--gait-marker", "in/roles.toml", "--max", "in/emg.c3d", "--participants", "in/people.tsv"]
        self.contents = {path: path.read_bytes() for path in self.inputs.rglob("*") if path.is_file()}

    def _make(self, *words):
        made = run(*words, cwd=self.inputs)
        assert made.status in (0, 1), (words, made.err)

    def _fill(self):
        place = self.inputs
        (place / "options.toml").write_text("threads = 1\n")
        self._make("simulate", "subject", "-o", "body", "--duration", 0.4)
        self._make("simulate", "arm", "-o", "arm", "--frames", 40, "--markers", 4, "--stagger", 15)
        self._make("simulate", "macaque", "-o", "monkey", "--duration", 5, "--units", 2, "--trials", 2, "--all-seen")
        self._make("simulate", "rig", "sign", "-o", "lab", "--duration", 0.1, "--grid")
        self._make("edit", "body/markers.c3d", "--region", "all", "--from", 1, "--to", 2)
        self._make("edit", "arm/markers.c3d", "--edits", "other.jsonl", "--region", "all", "--from", 1, "--to", 2)
        self._make("ik", "-m", "body/model.osim", "-t", "body/markers.c3d", "-o", "q.mot")
        for name in ("imu.sto", "imu_pose.sto"):
            rows = "".join(f"{i / 100}\t1,0,0,0\n" for i in range(40))
            (place / name).write_text(f"DataType=Quaternion\nversion=3\nendheader\ntime\tpelvis_imu\n{rows}")
        write_trc(place / "walk.trc", walk(3.0), names=NAMES)
        write_trc(place / "reach.trc", [[wheel(i)] for i in range(400)])
        write_trc(place / "again.trc", walk(3.0), names=NAMES)
        write_trc(place / "bent.trc", [flexed(i + 20) for i in range(40)], names=ARM_NAMES)
        write_trc(place / "elbow.trc", [flexed(i) for i in range(40)], names=ARM_NAMES)
        (place / "elbow.toml").write_text(DEFINITION)
        write_motion(place / "angles.mot", seconds=3.0)
        write_motion(place / "angles_sd.sto", seconds=3.0, sd=0.5)
        (place / "roles.toml").write_text('left_heel = "LHEE"\n')
        (place / "people.tsv").write_text("participant_id\tage\nwalk\t30\n")
        (place / "norm.csv").write_text("curve,percent,low,high\n" + "".join(f"Left knee_angle,{p},0,60\n" for p in range(101)))
        (place / "curves.csv").write_text("\n".join(",".join(str(0.01 * ((7 * i + 3 * p) % 11) + i) for p in range(21)) for i in range(6)) + "\n")
        (place / "band.csv").write_text("point,low,high\n" + "".join(f"{p},0,9\n" for p in range(21)))
        rows = "".join(f"S{s},{d},path,,all,{s + 0.1 * d * s % 3}\n" for s in range(6) for d in (1, 2))
        (place / "visits.csv").write_text("participant,session,measure,context,region,value\n" + rows)
        forces = "".join(f"{0.01 * i:.2f}\t0\t{max(0, 700 - abs(i % 110 - 40) * 20)}\t0\t0\t0\t0\n" for i in range(300))
        head = "grf\nversion=1\nnRows=300\nnColumns=7\ninDegrees=no\nendheader\n"
        columns = "\t".join(["time", *(f"ground_force_{part}{axis}" for part in "vp" for axis in "xyz")])
        (place / "grf.mot").write_text(f"{head}{columns}\n{forces}")
        self._others()
        self._setups()
        self._list()

    def _others(self):
        """Skeletons, a subject, a data set of BIDS, and what a camera sees."""
        place = self.inputs
        (place / "amc").mkdir()
        for name, text in (("01.asf", ASF), ("01_02.amc", AMC), ("s.asf", ASF)):
            (place / "amc" / name).write_text(text)
        (place / "arm.csv").write_text(arm()[0])
        (place / "ann.vsk").write_text(skeleton(ON))
        thigh = '[[segment]]\nname = "thigh {0}"\nmarkers = ["{0}THI", "{0}THAP", "{0}KNE"]\n'
        hip = '[[joint]]\nname = "hip {0}"\nparent = "pelvis"\nchild = "thigh {0}"\n'
        pelvis = '[[segment]]\nname = "pelvis"\nmarkers = ["LASI", "RASI", "LPSI", "RPSI"]\n'
        (place / "legs.toml").write_text(pelvis + "".join(text.format(side) for text in (thigh, hip) for side in "LR"))
        self._make("joints", "body/markers.c3d", "--segments", "legs.toml", "--method", "score", "-o", "found")
        self._make("convert", "body/markers.c3d", "bids/sub-01/motion/sub-01_task-walk_tracksys-omc_motion.tsv")
        (place / "rig.toml").write_text('format = "kinemark-rig"\nversion = 1\n' + Camera("left", [3.0, 1.8, 2.2], [0.0, 1.0, 0.0]).toml())
        frames = "".join(f"{frame},960,540,0.95\n" for frame in range(40))
        (place / "left.csv").write_text(f"scorer,net,net,net\nbodyparts,RWRA,RWRA,RWRA\ncoords,x,y,likelihood\n{frames}")

    def _setups(self):
        place = self.inputs
        names = [name for name in (place / "body" / "markers.trc").read_text().splitlines()[3].split("\t")[2:] if name]
        tasks = "".join(f"<IKMarkerTask name='{name}'><apply>true</apply><weight>1</weight></IKMarkerTask>" for name in names)
        document = "<OpenSimDocument Version='40000'>{}</OpenSimDocument>".format
        (place / "tasks.xml").write_text(document(f"<IKTaskSet><objects>{tasks}</objects></IKTaskSet>"))
        (place / "ik.xml").write_text(
            document(
                "<InverseKinematicsTool name='t'><model_file>body/model.osim</model_file><marker_file>body/markers.trc</marker_file>"
                "<IKTaskSet file='tasks.xml'/></InverseKinematicsTool>"
            )
        )
        (place / "more.xml").write_text(
            document(
                "<MarkerSet><objects><Marker name='extra'><socket_parent_frame>/bodyset/pelvis</socket_parent_frame>"
                "<location>0 0 0</location></Marker></objects></MarkerSet>"
            )
        )
        (place / "scale.xml").write_text(
            document(
                "<ScaleTool name='s'><GenericModelMaker><model_file>body/model.osim</model_file><marker_set_file>more.xml</marker_set_file>"
                "</GenericModelMaker><ModelScaler><apply>false</apply></ModelScaler><MarkerPlacer><apply>true</apply>"
                "<IKTaskSet file='tasks.xml'/><marker_file>body/markers.trc</marker_file><coordinate_file>body/truth.mot</coordinate_file>"
                "</MarkerPlacer></ScaleTool>"
            )
        )
        (place / "loads.xml").write_text(
            document(
                "<ExternalLoads name='l'><objects><ExternalForce name='f'><applied_to_body>pelvis</applied_to_body><force_expressed_in_body>"
                "ground</force_expressed_in_body><point_expressed_in_body>ground</point_expressed_in_body><force_identifier>f"
                "</force_identifier><point_identifier>p</point_identifier></ExternalForce></objects><datafile>push.sto</datafile></ExternalLoads>"
            )
        )
        rows = "".join(f"{0.01 * i:.2f}\t0\t9\t0\t0\t0\t0\n" for i in range(100))
        head = "push\nversion=1\nnRows=100\nnColumns=7\ninDegrees=no\nendheader\ntime\tfx\tfy\tfz\tpx\tpy\tpz\n"
        (place / "push.sto").write_text(head + rows)
        (place / "analyze.xml").write_text(
            document(
                "<AnalyzeTool name='t'><model_file>body/model.osim</model_file><coordinates_file>q.mot</coordinates_file>"
                "<results_directory>.</results_directory><external_loads_file>loads.xml</external_loads_file><AnalysisSet><objects>"
                "<Kinematics name='k'><on>true</on></Kinematics></objects></AnalysisSet></AnalyzeTool>"
            )
        )

    def _list(self):
        body, q = ["-m", "in/body/model.osim", "-t", "in/body/markers.c3d"], ["in/q.mot", "-m", "in/body/model.osim"]
        feet, norm, quick = ["--gait-marker", "in/roles.toml"], ["--norm", "in/norm.csv"], ["--refits", 0]
        drawn = ["--figures", "out/figures", "--figure-formats", "svg", "--report", "out/page.html"]
        tables = ["--write-events", "out/events.csv", "--write-cycles", "out/cycles.csv"]
        people = ["--participants", "in/people.tsv"]
        self.commands = {
            "convert markers": ["convert", "in/body/markers.c3d", "out/x.trc", "--edits", "in/body/markers_edits.jsonl"],
            "convert to C3D": ["convert", "in/body/markers.c3d", "out/x.c3d"],
            "convert to NWB": ["convert", "in/body/markers.c3d", "out/x.nwb"],
            "convert to BIDS": ["convert", "in/body/markers.c3d", "out/sub-01/motion/sub-01_task-walk_tracksys-omc_motion.tsv"],
            "convert a table": ["convert", "in/q.mot", "out/x.sto"],
            "convert a model": ["convert", "in/body/model.osim", "out/x.urdf"],
            "convert a motion": ["convert", "in/q.mot", "out/x.bvh", "--model", "in/body/model.osim"],
            "convert, merged": ["convert", "--merge", "in/walk.trc", "in/elbow.trc", "out/x.trc", "--resample", 50],
            "convert several": ["convert", "in/walk.trc", "in/elbow.trc", "out", "--to", "csv"],
            "convert an AMC": ["convert", "in/amc/01_02.amc", "out/x.csv", "--rate", 120],
            "convert an AMC by a skeleton": ["convert", "in/amc/01_02.amc", "out/x.csv", "--rate", 120, "--skeleton", "in/amc/s.asf"],
            "convert from BIDS": ["convert", "in/bids/sub-01/motion/sub-01_task-walk_tracksys-omc_motion.tsv", "out/x.csv"],
            "clean": ["clean", "in/body/markers.c3d", "out/x.c3d", "--derivatives", "--report", "out/x.html"],
            "clean several": ["clean", "in/walk.trc", "in/elbow.trc", "out", "--to", "csv", "--report", "out/pages"],
            "edit": ["edit", "in/arm/markers.c3d", "--edits", "out/x.jsonl", "--region", "x", "--from", 1, "--to", 2],
            "joints": ["joints", "in/arm/markers.c3d", "--segments", "in/arm/segments.toml", "--method", "score", "--figures", "out/x.svg", "--edits", "in/other.jsonl",
                       "-o", "out", "--report", "out/x.html"],
            "joints to a file": ["joints", "in/arm/markers.c3d", "--segments", "in/arm/segments.toml", "--method", "score", "-o", "out/x.c3d"],
            "joints of a subject": ["joints", "in/arm.csv", "--segments", "in/ann.vsk", "-o", "out/x.csv"],
            "scale": ["scale", "-m", "in/body/model.osim", "--static", "in/body/markers.c3d", "-o", "out/x.osim", "--report", "out/x.html"],
            "scale to joints": ["scale", "-m", "in/body/model.osim", "-t", "in/body/markers.c3d", "--joints", "in/found", "-o", "out/x.osim"],
            "scale by a setup": ["scale", "--setup", "in/scale.xml", "-o", "out/x.osim"],
            "ik": ["ik", *body, "-o", "out/x.mot", "--report", "out/x.html", "--tasks", "in/tasks.xml", "--forces", "in/loads.xml", "--locations"],
            "ik by a setup": ["ik", "--setup", "in/ik.xml", "-o", "out/x.mot", "--force"],
            "ik of sensors": ["ik", "-m", "in/body/model.osim", "--orientations", "in/imu.sto", "--calibration", "in/imu_pose.sto", "--heading", "pelvis_imu:x",
                              "-o", "out/x.mot"],
            "ik of sensors and markers": ["ik", *body, "-o", "out/x.mot", "--orientations", "in/imu.sto", "--calibration", "in/imu_pose.sto", "--heading", "pelvis_imu:x",
                                          "--report", "out/x.html"],
            "ik of several": ["ik", "-m", "in/body/model.osim", "-t", "in/body/markers.c3d", "-t", "in/body/truth.trc", "-o", "out", "--report", "out/pages"],
            "track": ["track", *body, "-o", "out/x.mot", "--report", "out/x.html", "--forces", "in/loads.xml"],
            "track images": ["track", *body, "-o", "out/x.mot", "--rig", "in/rig.toml", "--images", "left=in/left.csv"],
            "analyze": ["analyze", "in/elbow.trc", "-o", "out/x.csv", "--report", "out/page.html"],
            "analyze a motion": ["analyze", *q, "-o", "out", "--forces", "in/loads.xml"],
            "measure": ["measure", "in/reach.trc", "-o", "out/x.csv", *drawn, *tables, *people, *quick],
            "measure to JSON": ["measure", "in/elbow.trc", "-o", "out/x.json", *quick],
            "measure to NWB": ["measure", "in/elbow.trc", "-o", "out/x.nwb", *quick],
            "measure several": ["measure", "in/reach.trc", "in/again.trc", "-o", "out/x.csv", *tables, *people, *quick],
            "measure around spikes": ["measure", "in/q.mot", "--spikes", "in/monkey/session.nwb", "--around", "units", "--window", "0,0.1", "-o", "out/x.csv"],
            "measure around movements": ["measure", "in/monkey/session.nwb", "--around", "movement", "-o", "out/x.nwb", *quick],
            "measure trials": ["measure", "in/monkey/session.nwb", "-o", "out/x.csv", *quick],
            "gait": ["gait", "in/walk.trc", "-o", "out/x.csv", *feet, *norm, *drawn, *tables, *quick, "--angles", "in/angles.mot"],
            "gait with forces": ["gait", "in/walk.trc", "--forces", "in/grf.mot", "-o", "out/x.json", *feet, *quick, *people],
            "gait into a C3D": ["gait", "in/walk.trc", "--write-events", "out/x.c3d", *feet, *quick],
            "gait of several": ["gait", "in/walk.trc", "in/again.trc", "-o", "out/x.csv", *feet, *tables[:2], *people, *quick],
            "segments": ["segments", "in/elbow.trc", "--definition", "in/elbow.toml", "--static", "in/elbow.trc", "--trial", "bent=in/bent.trc", "-o", "out"],
            "segments of walking": ["segments", "in/walk.trc", "--definition", "in/feet.toml", "--forces", "in/grf.mot", "-o", "out", *feet, *norm, *drawn, *tables, *quick],
            "dynamics": ["dynamics", *q, "-o", "out/x.csv", "--forces", "in/loads.xml", *quick],
            "dynamics, tables": ["dynamics", *q, "-o", "out", "--bodies", "pelvis", "--forces", "in/loads.xml"],
            "dynamics by a setup": ["dynamics", "--setup", "in/analyze.xml", "-o", "out"],
            "groups spm": ["groups", "spm", "in/curves.csv", "-o", "out/x.csv"],
            "groups band": ["groups", "band", "in/curves.csv", "-o", "out/x.json"],
            "groups norm": ["groups", "norm", "in/band.csv", "in/curves.csv", "-o", "out/x.csv"],
            "groups retest": ["groups", "retest", "in/visits.csv", "-o", "out/x.csv"],
            "report of markers": ["report", "in/body/markers.c3d", "-o", "out/x.html"],
            "report of an AMC": ["report", "in/amc/01_02.amc", "-o", "out/x.html", "--rate", 120, "--skeleton", "in/amc/s.asf"],
            "report of a motion": ["report", "in/q.mot", "-o", "out/x.html"],
            "serve": ["serve", "replay:in/body/markers.c3d", "--model", "in/body/model.osim", "--record", "out/x.mcap", "--no-open"],
            "acquire": ["acquire", "replay:in/lab/recording.mcap?fast", "-o", "out/x.mcap"],
            "calibrate": ["calibrate", "in/lab/grid_A.mcap", "in/lab/grid_B.mcap", "--nominal", "in/lab/rig_nominal.toml", "--method", "grid-lut",
                          "-o", "out/x.toml", "--report", "out/x.html"],
            "reconstruct": ["reconstruct", "in/lab/recording.mcap", "--rig", "in/lab/rig_true.toml", "--method", "frames", "-o", "out/x.csv",
                            "--report", "out/x.html"],
            "recover": ["recover", "in/lab/recording.mcap", "out/x.mcap"],
            "simulate subject": ["simulate", "subject", "-m", "in/body/model.osim", "-o", "out", "--duration", 0.1],
            "simulate arm": ["simulate", "arm", "-o", "out", "--frames", 20],
            "simulate macaque": ["simulate", "macaque", "-o", "out", "--duration", 2, "--units", 2, "--lfp"],
            "simulate rig": ["simulate", "rig", "markers", "-t", "in/elbow.trc", "--marker", "A1", "-o", "out", "--duration", 0.1],
            "manual pages": ["help", "--man-pages", "out"],
        }
        feet = DEFINITION.replace("A1", "LHEE").replace("A2", "LTOE").replace("A3", "SACR").replace("F1", "RHEE").replace("F2", "RTOE").replace("F3", "SACR")
        (self.inputs / "feet.toml").write_text(feet)

    def words(self, name):
        return [*map(str, self.commands[name]), *EVERYWHERE]

    def run(self, words):
        """(exit status, what it said) of a command; a server that was not refused is ended and has status None."""
        program = subprocess.Popen([PROGRAM, *words], cwd=self.folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        if words[0] == "serve" and program.stdout.readline():
            program.terminate()
            program.communicate(timeout=SERVE_SECONDS)
            return None, "serves"
        _, said = program.communicate(timeout=120)
        return program.returncode, said

    @contextlib.contextmanager
    def empty(self, folders=()):
        self.outputs.mkdir()
        for folder in folders:
            (self.outputs / folder).mkdir(parents=True, exist_ok=True)
        try:
            yield
        finally:
            shutil.rmtree(self.outputs)

    def learn(self, name):
        """(files of `in/` that a command opens, files of `out/` that it leaves, what is wrong)."""
        with self.empty():
            watch = Watch(self.inputs)
            status, said = self.run(self.words(name))
            read = watch.opened()
            watch.close()
            written = sorted(path.relative_to(self.outputs) for path in self.outputs.rglob("*") if path.is_file())
            if name == "serve":
                written = [Path("saved.toml"), Path("x.mcap")]
        wrong = [] if status in (0, 1, None) else [f"{name}: exit status {status}: {said.strip()[-300:]}"]
        return read, written, wrong + self._spoilt(f"{name}, by itself")

    def _spoilt(self, what):
        wrong = []
        for path, content in self.contents.items():
            if not path.is_file() or path.is_symlink() or path.read_bytes() != content:
                wrong.append(f"{what}: {path.relative_to(self.folder)} was changed")
                path.unlink(missing_ok=True)
                path.write_bytes(content)
        return wrong

    def _judge(self, what, status, said):
        """What is wrong where a file that is read was given as what is written."""
        lines = said.splitlines()
        wrong = self._spoilt(what)
        if status == 3 and what.startswith("edit: ") and "is no JSON object" in said:
            return wrong  # a journal is read before it is added to
        if status != 2:
            wrong.append(f"{what}: exit status {status}: {said.strip()[-200:]}")
        elif len(lines) != 1 or not (REFUSED.search(said) or OTHER_NAME.search(said)):
            wrong.append(f"{what}: said {said.strip()[-300:]!r}")
        return wrong

    def try_link(self, name, written, read, kind):
        """A written name is a link to a file that is read."""
        with self.empty([written.parent]):
            link = self.outputs / written
            if kind == "symlink":
                link.symlink_to(read)
            else:
                os.link(read, link)
            what = f"{name}: out/{written} is a {kind} to {read.relative_to(self.folder)}"
            status, said = self.run([*self.words(name), "--force"])
            if status in (0, 1) and link.exists() and link.samefile(read):
                return self._spoilt(what)  # what a data set has already is not written
            return self._judge(what, status, said)

    def try_name(self, name, word, read):
        """What is written has the name of a file that is read."""
        words = [str(read.relative_to(self.folder)) if one == word else one for one in self.words(name)]
        with self.empty():
            return self._judge(f"{name}: {word} is {read.relative_to(self.folder)}", *self.run([*words, "--force"]))

    def named_outputs(self, name):
        """Words of a command that name a file to write."""
        return [word for word in self.words(name) if word.startswith("out/") and Path(word).suffix]


def options_with_files():
    """{command: its options and arguments that take a file or a folder}, from the program's own help."""
    found, waiting = {}, [()]
    while waiting:
        words = waiting.pop()
        text = run(*words, "--help", cwd=".").out
        below = re.search(r"\nSubcommands:\n(.*)", text, re.DOTALL)
        names = re.findall(r"^  ([a-z][a-z-]*)\b", below[1], re.MULTILINE) if below else []
        waiting += [(*words, name) for name in names]
        if not names:
            found[words] = set(re.findall(r"^  (?:-\w,\s*)?(--[a-z-]+) (?:[A-Z]+[=|])*(?:FILE|FOLDER|PATH|trial\|FILE)", text, re.MULTILINE))
    return found
