# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Files that are written: whole or not at all, never over an input or another's file, as sets that belong together,
whatever the disk, a signal or a second program does. tests/acceptance/files_kept.py does the same many more times."""

import json
import os
import random
import shutil
import signal
import subprocess
import tempfile
import unittest
from pathlib import Path

from support import PROGRAM, SECONDS, CommandTest, listing
from writing import Workshop, empty_folder, file_size_limit, flips, hidden, kill_at, of_two_writers, on_full_disks, seconds_of, visible


class Files(CommandTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.workshop = Workshop(cls.shared.name)


class NoReplace(Files):
    def test_of_two_writers_exactly_one_wins(self):
        command = ["convert", self.trc, "x.c3d"]
        for _ in range(20):
            statuses, left = of_two_writers(command, self.folder)
            self.assertEqual(statuses, [0, 4])
            self.assertEqual(left, [])

    def test_of_two_writers_of_a_set_one_wins_all_of_it(self):
        for _ in range(3):
            with empty_folder(self.folder) as folder:
                both = [
                    subprocess.Popen([PROGRAM, *map(str, self.workshop.commands["ik"]), "--quiet"], cwd=folder, stderr=subprocess.DEVNULL)
                    for _ in range(2)
                ]
                self.assertEqual(sorted(program.wait(timeout=SECONDS) for program in both), [0, 4])
                self.good("validate", folder / "x.mot")

    def test_links_are_refused_without_force_and_followed_with_it(self):
        (self.folder / "elsewhere").mkdir()
        for name, target in (("dangling.trc", "elsewhere/x.trc"), ("there.trc", "elsewhere/y.trc")):
            (self.folder / name).symlink_to(target)
        self.write("elsewhere/y.trc", "old")
        for name in ("dangling.trc", "there.trc"):
            self.refused(4, [name, "exists already"], "convert", self.c3d, name)
            self.good("convert", self.c3d, name, "--force")
            self.assertTrue((self.folder / name).is_symlink())
        self.assertEqual((self.folder / "elsewhere/x.trc").read_bytes()[:12], b"PathFileType")
        self.assertEqual((self.folder / "elsewhere/y.trc").read_bytes()[:12], b"PathFileType")
        (self.folder / "set.mot").symlink_to("elsewhere/set.mot")
        self.refused(4, ["set.mot", "exists already"], *self.ik(output="set.mot"))
        self.good(*self.ik(output="set.mot"), "--force")
        self.assertTrue((self.folder / "elsewhere/set.mot").is_file())

    def test_devices_and_pipes_are_not_replaced(self):
        os.mkfifo(self.folder / "pipe.trc")
        self.refused(4, ["pipe.trc", "not a regular file"], "convert", self.c3d, "pipe.trc", "--force")
        self.refused(2, "/dev/null", "convert", self.c3d, "/dev/null", "--force")

    def test_standard_output_that_is_full(self):
        with Path("/dev/full").open("wb") as full:
            for command in (["info", self.c3d, "--json"], ["info", self.c3d], ["validate", self.c3d, "--json", "--quiet"], ["--help"], ["help", "ik"]):
                ran = self.run_in(*command, stdout=full)
                self.assertEqual((ran.status, ran.err), (4, "kinemark: standard output: cannot be written\n"), command)
            ran = self.run_in(*self.ik(), "--json", "--quiet", stdout=full)
            self.assertEqual(ran.status, 4, ran.err)

    def test_standard_output_that_nobody_reads(self):
        reader, writer = os.pipe()
        os.close(reader)
        ran = self.run_in("info", self.c3d, "--json", stdout=writer)
        os.close(writer)
        self.assertEqual((ran.status, ran.err), (4, "kinemark: standard output: cannot be written\n"))


class InputsStay(Files):
    """--force never lets an output destroy an input."""

    def setUp(self):
        super().setUp()
        for name in ("markers.c3d", "markers.trc", "model.osim", "truth.mot"):
            shutil.copy(self.recorded / name, self.folder)
        (self.folder / "link.c3d").symlink_to("markers.c3d")
        os.link(self.folder / "markers.c3d", self.folder / "second.c3d")

    def kept(self, output, *command):
        """An input is not replaced: as an input, or, before that, as no file that the result could be written to."""
        said = self.refused(2, output, *command, "--force")
        self.assertRegex(said, "is the file that is read as .*name another output|is another ending")

    def test_an_output_that_is_the_input(self):
        self.kept("markers.c3d", "convert", "markers.c3d", "markers.c3d")
        for name in ("link.c3d", "second.c3d", "./markers.c3d"):
            self.kept(name, "convert", "markers.c3d", name)
            self.kept(name, "clean", "markers.c3d", name)
        self.kept("model.osim", "convert", "model.osim", "model.osim")
        self.kept("truth.mot", "convert", "truth.mot", "truth.mot")
        self.kept("markers.c3d", "joints", "markers.c3d", "-o", "markers.c3d")
        self.kept("model.osim", "scale", "-m", "model.osim", "--static", "markers.c3d", "-o", "model.osim")
        self.kept("model.osim", "simulate", "subject", "--model", "model.osim", "-o", ".")
        self.refused(2, "markers.c3d", "convert", "markers.c3d", "markers.c3d")

    def test_ik_and_track(self):
        ik = ["ik", "-m", "model.osim", "-t", "markers.c3d"]
        for output in ("model.osim", "markers.c3d", "link.c3d"):
            self.kept(output, *ik, "-o", output)
            self.kept(output, "track", "-m", "model.osim", "-t", "markers.c3d", "-o", output)
        shutil.copy(self.folder / "markers.trc", self.folder / "q_sd.sto")
        self.kept("q_sd.sto", "ik", "-m", "model.osim", "-t", "q_sd.sto", "-o", "q.mot")
        self.kept("markers.c3d", *ik, "-o", "q.mot", "--report", "markers.c3d")

    def test_setups_and_what_they_name(self):
        self.setup_file("setup.xml", "q.mot")
        self.kept("setup.xml", "ik", "--setup", "setup.xml", "-o", "setup.xml")
        self.setup_file("setup.xml", "markers.trc")
        self.kept("markers.trc", "ik", "--setup", "setup.xml")
        self.kept("model.osim", "ik", "--setup", "setup.xml", "-o", "model.osim")

    def test_files_that_a_setup_is_put_together_from(self):
        self.setup_file("setup.xml", "q.mot", tasks_in="tasks.xml")
        self.kept("tasks.xml", "ik", "--setup", "setup.xml", "-o", "tasks.xml")
        self.good("ik", "--setup", "setup.xml", "--quiet")
        read = json.loads((self.folder / "q_report.json").read_text())["inputs"]
        self.assertIn("tasks.xml", [Path(one["path"]).name for one in read])

    def test_files_that_a_setup_of_scaling_names(self):
        self.write(
            "marker_set.xml",
            "<OpenSimDocument Version='40000'><MarkerSet><objects><Marker name='extra'><socket_parent_frame>/bodyset/pelvis"
            "</socket_parent_frame><location>0 0 0</location></Marker></objects></MarkerSet></OpenSimDocument>",
        )
        self.write("tasks.xml", f"<OpenSimDocument Version='40000'><IKTaskSet><objects>{self.tasks()}</objects></IKTaskSet></OpenSimDocument>")
        self.write(
            "scale.xml",
            "<OpenSimDocument Version='40000'><ScaleTool name='s'><GenericModelMaker><model_file>model.osim</model_file>"
            "<marker_set_file>marker_set.xml</marker_set_file></GenericModelMaker><ModelScaler><apply>false</apply></ModelScaler>"
            "<MarkerPlacer><apply>true</apply><IKTaskSet file='tasks.xml'/><marker_file>markers.trc</marker_file>"
            "<coordinate_file>truth.mot</coordinate_file></MarkerPlacer></ScaleTool></OpenSimDocument>",
        )
        for name in ("model.osim", "marker_set.xml", "tasks.xml", "markers.trc", "truth.mot", "scale.xml"):
            self.kept(name, "scale", "--setup", "scale.xml", "-o", name)

    def test_files_that_loads_name(self):
        self.write(
            "loads.xml",
            "<OpenSimDocument Version='40000'><ExternalLoads name='l'><objects><ExternalForce name='f'><applied_to_body>pelvis"
            "</applied_to_body><force_expressed_in_body>ground</force_expressed_in_body><point_expressed_in_body>ground"
            "</point_expressed_in_body><force_identifier>f</force_identifier><point_identifier>p</point_identifier>"
            "</ExternalForce></objects><datafile>push.sto</datafile></ExternalLoads></OpenSimDocument>",
        )
        rows = "".join(f"{0.01 * i:.2f}\t0\t9\t0\t0\t0\t0\n" for i in range(3000))
        names = "\t".join(["time", "fx", "fy", "fz", "px", "py", "pz"])
        self.write("push.sto", f"push\nversion=1\nnRows=3000\nnColumns=7\ninDegrees=no\nendheader\n{names}\n{rows}")
        for command in ("ik", "track"):
            run = [command, "-m", "model.osim", "-t", "markers.c3d", "--forces", "loads.xml"]
            self.kept("loads.xml", *run, "-o", "loads.xml")
            self.kept("push.sto", *run, "-o", "push.sto")

    def test_report(self):
        self.good(*self.ik(markers="markers.c3d", model="model.osim"))
        for name in ("q.mot", "q_sd.sto", "q_marker_errors.sto", "q_report.json", "markers.c3d", "model.osim"):
            self.kept(name, "report", "q.mot", "-o", name)

    def test_recordings_and_rigs(self):
        lab = self.workshop.inputs / "lab"
        for name in ("recording.mcap", "rig_true.toml", "rig_nominal.toml", "grid_A.mcap", "grid_B.mcap"):
            shutil.copy(lab / name, self.folder)
        grids = ["calibrate", "grid_A.mcap", "grid_B.mcap", "--nominal", "rig_nominal.toml", "--method", "grid-lut"]
        self.kept("rig_nominal.toml", *grids, "-o", "rig_nominal.toml")
        self.kept("grid_A.mcap", *grids, "-o", "grid_A.mcap")
        shutil.copy(lab / "recording.mcap", self.folder / "recording.csv")
        self.kept("recording.csv", "reconstruct", "recording.csv", "--rig", "rig_true.toml", "-o", "recording.csv")
        self.refused(2, "recording.mcap", "recover", "recording.mcap", "recording.mcap", "--force")

    def setup_file(self, name, output, tasks_in=None):
        tasks = f"<IKTaskSet><objects>{self.tasks()}</objects></IKTaskSet>"
        if tasks_in:
            self.write(tasks_in, f"<OpenSimDocument Version='40000'>{tasks}</OpenSimDocument>")
            tasks = f"<IKTaskSet file='{tasks_in}'/>"
        self.write(
            name,
            "<OpenSimDocument Version='40000'><InverseKinematicsTool name='t'><model_file>model.osim</model_file>"
            f"<marker_file>markers.trc</marker_file><output_motion_file>{output}</output_motion_file>"
            f"{tasks}</InverseKinematicsTool></OpenSimDocument>",
        )

    def tasks(self):
        names = (self.folder / "markers.trc").read_text().splitlines()[3].split("\t")[2:]
        return "".join(f"<IKMarkerTask name='{name}'><apply>true</apply><weight>1</weight></IKMarkerTask>" for name in names if name)

    def test_a_setup_writes_only_below_its_own_folder(self):
        (self.folder / "sub").mkdir()
        (self.folder / "out").symlink_to("/tmp")
        for output in (str(self.folder.parent / "x.mot"), "../x.mot", "sub/../../x.mot", "out/x.mot"):
            self.setup_file("setup.xml", output)
            self.refused(2, ["setup.xml", "output_motion_file", "outside the setup's own folder", "--output"], "ik", "--setup", "setup.xml")
        self.good("ik", "--setup", "setup.xml", "-o", "given.mot", "--quiet")
        self.setup_file("setup.xml", "sub/x.mot")
        self.good("ik", "--setup", "setup.xml", "--quiet")
        self.assertTrue((self.folder / "sub/x.mot").is_file())

    def test_a_setup_of_scaling_likewise(self):
        self.write(
            "scale.xml",
            "<OpenSimDocument Version='40000'><ScaleTool name='s'><GenericModelMaker><model_file>model.osim</model_file>"
            "</GenericModelMaker><ModelScaler><apply>false</apply></ModelScaler><MarkerPlacer><apply>true</apply>"
            "<marker_file>markers.trc</marker_file><output_model_file>../stolen.osim</output_model_file></MarkerPlacer>"
            "</ScaleTool></OpenSimDocument>",
        )
        self.refused(2, ["output_model_file", "outside the setup's own folder"], "scale", "--setup", "scale.xml")
        self.refused(2, ["markers.trc", "is another ending"], "scale", "--setup", "scale.xml", "-o", "markers.trc", "--force")


class FullDisk(Files):
    def test_every_command_that_writes(self):
        for name, command in self.workshop.commands.items():
            with self.subTest(command=name):
                wrong, runs = on_full_disks(command, self.folder, 2)
                self.assertEqual(wrong, [])
                self.assertGreater(runs, 1)


class Signals(Files):
    """Signals during long work leave nothing; a kill leaves what the next run removes."""

    def long_work(self):
        self.good("simulate", "subject", "-o", "long", "--duration", 60, "--quiet")
        return ["ik", "-m", self.folder / "long/model.osim", "-t", self.folder / "long/markers.c3d", "-o", "q.mot", "--threads", 1, "--quiet"]

    def stopped_by(self, number, folder, command):
        """The program, stopped by a signal while its hidden folder is there."""
        program = subprocess.Popen(
            [PROGRAM, *map(str, command)],
            cwd=folder,
            stderr=subprocess.PIPE,
            stdin=subprocess.DEVNULL,
            # Below nohup the signal is ignored, and the program leaves it so.
            preexec_fn=lambda: signal.signal(signal.SIGHUP, signal.SIG_DFL),
        )
        try:
            while program.poll() is None and not hidden(folder):
                pass
            program.send_signal(number)
            _, said = program.communicate(timeout=SECONDS)
        finally:
            program.kill()
            program.wait()
        return program.returncode, said.decode()

    def test_signals_leave_nothing(self):
        command = self.long_work()
        for number, status in ((signal.SIGHUP, 129), (signal.SIGINT, 130), (signal.SIGTERM, 143)):
            with empty_folder(self.folder) as folder:
                self.assertEqual(self.stopped_by(number, folder, command), (status, f"kinemark: the command was stopped ({number.name})\n"))
                self.assertEqual(listing(folder), {})

    def test_a_simulation_that_is_stopped_leaves_its_folder_empty(self):
        with empty_folder(self.folder) as folder:
            (folder / "new").mkdir()
            command = ["simulate", "subject", "-o", "new", "--duration", 100, "--quiet"]
            self.assertEqual(self.stopped_by(signal.SIGINT, folder, command)[0], 130)
            self.assertEqual(listing(folder), {"new": None})

    def test_a_kill_leaves_what_the_next_run_removes(self):
        command = self.long_work()
        with empty_folder(self.folder) as folder:
            returned, _ = self.stopped_by(signal.SIGKILL, folder, command)
            self.assertEqual(returned, -signal.SIGKILL)
            self.assertNotEqual(hidden(folder), [])
            self.good("convert", self.c3d, folder / "x.trc")
            self.assertEqual(list(listing(folder)), ["x.trc"])

    def test_what_a_living_writer_needs_stays(self):
        command = self.long_work()
        with empty_folder(self.folder) as folder:
            program = subprocess.Popen([PROGRAM, *map(str, command)], cwd=folder, stdin=subprocess.DEVNULL)
            try:
                while program.poll() is None and not hidden(folder):
                    pass
                before = hidden(folder)
                self.good("convert", self.c3d, folder / "x.trc")
                self.assertIsNone(program.poll(), "the work is long enough")
                self.assertEqual(hidden(folder), before)
            finally:
                program.kill()
                program.wait()

    def test_under_nohup_a_hangup_is_ignored(self):
        with empty_folder(self.folder) as folder:
            command = ["sh", "-c", 'trap "" HUP; exec "$0" "$@"', PROGRAM, *map(str, self.workshop.commands["ik"])]
            program = subprocess.Popen(command, cwd=folder, stderr=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
            while program.poll() is None and not hidden(folder):
                pass
            program.send_signal(signal.SIGHUP)
            self.assertEqual(program.wait(timeout=SECONDS), 0)


class Sets(Files):
    def mixed(self, first, second, name):
        """Files of two results, one of which was taken from the other."""
        shutil.copy(self.folder / second / name, self.folder / first / name)

    def results(self, command):
        for folder, arguments in (("a", self.workshop.commands[command]), ("b", self.workshop.others[command])):
            shutil.rmtree(self.folder / folder, ignore_errors=True)
            (self.folder / folder).mkdir()
            self.run_there(folder, arguments)

    def run_there(self, folder, arguments):
        done = subprocess.run([PROGRAM, *map(str, arguments), "--quiet"], cwd=self.folder / folder, check=False, timeout=SECONDS)
        self.assertEqual(done.returncode, 0)

    def test_a_report_is_of_one_set(self):
        self.results("ik")
        self.good("report", "a/x.mot", "-o", "whole.html")
        for name in ("x.mot", "x_sd.sto", "x_marker_errors.sto", "x_report.json"):
            with tempfile.TemporaryDirectory() as kept:
                shutil.copy(self.folder / "a" / name, kept)
                self.mixed("a", "b", name)
                self.refused(3, "was not written together with", "report", "a/x.mot", "-o", "mixed.html")
                ran = self.good("validate", "a/x.mot", status=1)
                self.assertIn("was not written together with", ran.err + ran.out)
                shutil.copy(Path(kept) / name, self.folder / "a")
        self.good("report", "a/x.mot", "-o", "again.html")

    def test_an_old_deviation_beside_a_new_motion(self):
        self.good(*self.ik())
        self.good(*self.ik(end=0.5), "--no-error-bars", "--force")
        self.refused(3, ["q_sd.sto", "was not written together with"], "report", "q.mot", "-o", "r.html")

    def test_validate_knows_the_sets_of_other_commands(self):
        for command, first, second in (("clean to C3D", "x.c3d", "x_report.json"), ("scale", "x.osim", "x_report.json"), ("track", "x.mot", "x_tau.sto")):
            with self.subTest(command=command):
                self.results(command)
                whole = self.run_in("validate", f"a/{first}")
                self.assertNotIn("together", whole.err + whole.out)
                self.mixed("a", "b", second)
                ran = self.good("validate", f"a/{first}", status=1)
                self.assertIn(f"{second}: was not written together with", ran.err + ran.out)

    def test_validate_knows_the_sets_of_simulations(self):
        for scene, first, second in (("subject --duration 0.2", "markers.c3d", "truth.mot"), ("rig tree --duration 0.1", "truth.trc", "rig_true.toml")):
            with self.subTest(scene=scene):
                shutil.rmtree(self.folder / "a", ignore_errors=True)
                shutil.rmtree(self.folder / "b", ignore_errors=True)
                for seed, folder in enumerate("ab", 1):
                    self.good("simulate", *scene.split(), "--seed", seed, "-o", folder, "--quiet")
                whole = self.run_in("validate", f"a/{first}")
                self.assertNotIn("together", whole.err + whole.out)
                self.mixed("a", "b", second)
                ran = self.good("validate", f"a/{first}", status=1)
                self.assertIn(f"{second}: was not written together with", ran.err + ran.out)

    def test_the_same_work_names_the_same_set(self):
        for threads in (1, 2):
            self.good(*self.ik(output=f"q{threads}.mot", threads=threads))
        self.assertEqual((self.folder / "q1.mot").read_bytes(), (self.folder / "q2.mot").read_bytes())

    def test_killed_at_any_moment(self):
        draw = random.Random(13)
        old, new = self.workshop.commands["ik"], self.workshop.others["ik"]
        (self.folder / "w").mkdir()
        self.run_there("w", old)
        first = visible(self.folder / "w")
        self.run_there("w", [*new, "--force"])
        second = visible(self.folder / "w")
        self.assertEqual(first.keys(), second.keys())
        seconds = seconds_of([*old, "--force"], self.folder / "w")
        for _ in range(12):
            kill_at([*new, "--force"], self.folder / "w", draw.uniform(0.2, 1.0) * seconds)
            now = visible(self.folder / "w")
            self.assertEqual(now.keys(), first.keys())
            same = {name for name in now if now[name] in (first[name], second[name]) or name.endswith(("report.json", "html"))}
            self.assertEqual(same, set(now), "nothing is half-written")
            self.run_there("w", [*old, "--force"])
            self.assertEqual(hidden(self.folder / "w"), [])


class Nwb(Files):
    def damaged(self, name):
        path = Path(os.environ.get("KINEMARK_HARDENING", Path(__file__).resolve().parents[3] / "shared/reference/hardening")) / name
        if not path.is_file():
            raise unittest.SkipTest(f"NO REAL DATA: {path} is not there")
        return path

    def test_files_that_crash_or_hang_the_library(self):
        for name in ("crash_1.nwb", "crash_2.nwb", "hang_1.nwb", "hang_2.nwb"):
            for command in (["info"], ["validate"]):
                path = self.damaged(name)
                ran = self.run_in(*command, path, "--quiet")
                self.assertEqual(ran.status, 3, ran.err)
                self.assertEqual(len(ran.err.splitlines()), 1, ran.err)
                self.assertIn(name, ran.err)
                self.assertNotIn("infinite loop", ran.err)

    def test_files_of_older_versions_cannot_be_called_good(self):
        for name in ("lost_deviations.nwb", "changed.nwb"):
            ran = self.good("validate", self.damaged(name), status=1)
            self.assertIn("holds no digest of its content", ran.err + ran.out)

    def test_bits_flipped_in_a_file_of_ours(self):
        self.good("clean", self.c3d, "x.nwb", "--derivatives")
        self.good("validate", "x.nwb")
        whole = (self.folder / "x.nwb").read_bytes()
        for bit, changed in flips(whole, 50, 7):
            (self.folder / "y.nwb").write_bytes(changed)
            ran = self.run_in("validate", "y.nwb")
            self.assertIn(ran.status, (0, 1, 3), f"bit {bit}: {ran.err}")
            if ran.status == 0:
                for name in ("x", "y"):
                    self.good("convert", f"{name}.nwb", f"{name}.csv", "--force")
                self.assertEqual((self.folder / "x.csv").read_bytes(), (self.folder / "y.csv").read_bytes(), f"bit {bit}")
            else:
                said = [line for line in ran.err.splitlines() if not line.startswith("files: ")]  # progress, where it takes a second
                self.assertEqual(len(said), 1, ran.err)

    def test_a_full_disk_is_no_crash(self):
        for size in (0, 4096, 32768, 65536):
            self.refused(4, "x.nwb: cannot be written", "convert", self.c3d, "x.nwb", preexec_fn=file_size_limit(size))


if __name__ == "__main__":
    unittest.main()
