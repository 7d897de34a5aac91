# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""matlab/+kinemark in Octave: each function beside the command of its name, quoting, and the sentences of failures."""

import json
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from support import PROGRAM, PROJECT, SECONDS, real_file, run

OCTAVE = shutil.which("octave-cli") or shutil.which("octave")
ODD = "O'Neil [1] $HOME größe.c3d"
MODEL = "opensim-gait2354/subject01_simbody.osim"
WALK = "opensim-gait2354/subject01_walk1.trc"


@unittest.skipIf(OCTAVE is None, "NOT INSTALLED: octave")
class Octave(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory()
        cls.addClassCleanup(folder.cleanup)
        cls.folder = Path(folder.name)
        made = run("simulate", "subject", "-o", "made", "--duration", "1", "--dropout-random", "0.03", "--quiet", cwd=cls.folder)
        assert made.status == 0, made.err
        shutil.copy(cls.folder / "made" / "markers.c3d", cls.folder / ODD)

    def octave(self, script, program=PROGRAM):
        """Runs a script, whose last lines print JSON by say(); what it said, in order."""
        text = f"addpath('{PROJECT / 'matlab'}'); say = @(x) printf('%s\\n', jsonencode(x));\n{script}\n"
        scratch = self.folder / "scratch"
        scratch.mkdir(exist_ok=True)
        environment = {**os.environ, "KINEMARK_PROGRAM": str(program), "DISPLAY": "", "TMPDIR": str(scratch)}
        done = subprocess.run(
            [OCTAVE, "--no-gui", "--norc", "--quiet", "--eval", text],
            cwd=self.folder, env=environment, capture_output=True, text=True, timeout=SECONDS, check=False,
        )  # fmt: skip
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual([p.name for p in scratch.iterdir()], [], "a folder of a call is left")
        return [json.loads(line) for line in done.stdout.splitlines()]

    def refusals(self, *calls, program=PROGRAM):
        """[identifier, sentence] of calls that fail."""
        tries = [f"try, {call}; say('no error'); catch e, say({{e.identifier, e.message}}); end" for call in calls]
        return self.octave("\n".join(tries), program)

    def program(self, *words):
        done = run(*words, "--quiet", "--json", cwd=self.folder)
        self.assertIn(done.status, (0, 1), done.err)
        return json.loads(done.out)

    def test_reads_and_writes_files_of_any_name(self):
        name = ODD.replace("'", "''")
        said = self.octave(
            f"t = kinemark.read('{name}'); say(size(t.data)); say(t.labels(1:2)); say(sum(isnan(t.data(:))));\n"
            f"kinemark.write(t, 'back ''x''.csv'); t.labels{{1}} = 'New*'; kinemark.write(t, 'back.c3d');\n"
            "b = kinemark.read('back.c3d', 'select', {t.labels{2:3}}); say(b.labels); say(isequaln(b.data, t.data(:, 2:3, :)));\n"
            "m = kinemark.read('made/truth.mot', 'start', []); say(size(m.data)); say(m.labels{1});"
        )
        self.assertEqual(said[0], [100, 40, 3])
        self.assertGreater(said[2], 0)
        self.assertEqual((said[3], said[4]), ([*said[3]], True))
        self.assertEqual(said[5][0], 100)
        self.assertTrue((self.folder / "back 'x'.csv").is_file())
        self.assertEqual(run("convert", ODD, "direct.csv", cwd=self.folder).status, 0)
        self.assertEqual((self.folder / "back 'x'.csv").read_text(), (self.folder / "direct.csv").read_text())

    def test_a_trial_that_was_made(self):
        said = self.octave(
            "x = reshape(1:30, 5, 2, 3) / 10; x(3, 1, :) = NaN; mine = struct('rate', 100, 'data', x, 'labels', {{'LASI', 'RASI'}});\n"
            "kinemark.write(mine, 'mine.mat'); b = kinemark.read('mine.mat');\n"
            "say(isequaln(b.data, x)); say(b.time'); say(b.status(:, 1)'); say(b.labels);"
        )
        self.assertEqual(said, [True, [0, 0.01, 0.02, 0.03, 0.04], [1, 1, 0, 1, 1], ["LASI", "RASI"]])

    def test_clean_keeps_states_and_deviations(self):
        said = self.octave(
            "c = kinemark.clean('made/markers.c3d', 'gaps', 'cubic', 'noise', 1, 'select', 'R*'); say(c.passed); say(c.report.gap_method);\n"
            "say(max(c.trial.status(:))); say(max(c.trial.sd(:)));\n"
            "d = kinemark.clean(kinemark.read('made/markers.c3d'), 'gaps', 'cubic', 'noise', 1, 'select', 'R*', 'output', 'clean.c3d');\n"
            "say(max(abs(d.trial.data(:) - c.trial.data(:))) < 1e-6);"
        )
        self.assertEqual(said[:2], [True, "cubic"])
        self.assertEqual(said[2], 2)
        self.assertGreater(said[3], 0)
        self.assertTrue(said[4])
        self.assertTrue((self.folder / "clean.c3d").is_file())

    def test_ik_is_that_of_the_command(self):
        model, walk = real_file(MODEL), real_file(WALK)
        want = self.program("ik", "-m", model, "-t", walk, "-o", "direct.mot", "--end", "0.5", "--weight", "R.ASIS=2")
        said = self.octave(
            f"k = kinemark.ik('{model}', '{walk}', 'end', 0.5, 'weight', {{'R.ASIS=2'}}); d = kinemark.read('direct.mot');\n"
            "say(isequaln(k.motion.data, d.data)); say(size(k.sd.data)); say(size(k.marker_errors.data)); say(k.report.rms_error_mm);\n"
            f"n = kinemark.ik('{model}', '{walk}', 'end', 0.1, 'no_error_bars', true, 'output', 'kept.mot'); say(isempty(n.sd));"
        )
        self.assertTrue(said[0])
        self.assertEqual(said[1][0], want["frames"])
        self.assertEqual(said[2][0], want["frames"])
        self.assertAlmostEqual(said[3], want["rms_error_mm"], places=9)
        self.assertTrue(said[4])
        self.assertTrue((self.folder / "kept.mot").is_file())

    def test_scale_writes_a_model(self):
        said = self.octave(
            "s = kinemark.scale('made/model.osim', 'made/markers.c3d', 'fit.osim', 'max_frames', 20);\n"
            "say(s.model); say(fieldnames(s.report)); k = kinemark.ik(s.model, 'made/markers.c3d', 'end', 0.1); say(k.report.frames);"
        )
        self.assertEqual((said[0], said[2]), ("fit.osim", 11))
        self.assertTrue((self.folder / "fit.osim").is_file())

    def test_measures_gait_segments_and_joints(self):
        want = self.program("measure", "made/markers.c3d", "--refits", "0", "--measures", "path_length", "--select", "RWRA,LWRA")
        definition, gait = real_file("pycgm-rom/Sample_Static.c3d"), real_file("btk-others/Gait.c3d")
        said = self.octave(
            "m = kinemark.measure('made/markers.c3d', 'refits', 0, 'measures', 'path_length', 'select', {'RWRA', 'LWRA'});\n"
            "say(numel(m.measures)); say(m.measures(1).value);\n"
            f"g = kinemark.gait('{gait}', 'refits', 0); say(iscell(g.measures) || isstruct(g.measures)); say(isstruct(g.report));\n"
            f"s = kinemark.segments('{definition}', 'pig', 'frames', '1-20'); say(size(s.angles.data)); say(size(s.sd.data));\n"
            "j = kinemark.joints('made/markers.c3d', 'end', 0.3); say(j.passed); say(isfield(j.report, 'joints')); say(isempty(j.centres));"
        )
        self.assertEqual(said[0], len(want["measures"]))
        self.assertAlmostEqual(said[1], want["measures"][0]["value"], places=9)
        self.assertEqual(said[2:4], [True, True])
        self.assertEqual(said[4], said[5])
        self.assertEqual(said[6:], [False, True, True])

    def test_options_of_pairs(self):
        said = self.octave(
            "say(kinemark.internal.words('max_gap', 0.1, 'quiet', true, 'force', false, 'start', [], 'select', {'A', 'B c'}));\n"
            "say(kinemark.internal.words('weight', struct('RTOE', 2, 'LTOE', 0.5), 'gaps', '')); say(kinemark.internal.words());"
        )
        self.assertEqual(said[0], ["--max-gap=0.10000000000000001", "--quiet", "--select=A", "--select=B c"])
        self.assertEqual(said[1:], [["--weight=RTOE=2", "--weight=LTOE=0.5", "--gaps="], []])

    def test_failures_are_the_programs_sentence_and_status(self):
        said = self.refusals(
            "kinemark.read('no''such [file].c3d')", "kinemark.read(3)", "kinemark.clean('made/markers.c3d', 'gaps', 'bad')",
            "kinemark.clean('made/markers.c3d', 'gaps')", "kinemark.clean('made/markers.c3d', 3, 4)",
            "kinemark.clean('made/markers.c3d', 'noise', {@sin})", "kinemark.read('made/model.osim')",
            "kinemark.write(kinemark.read('made/markers.c3d'), 'made/markers.trc')",
        )  # fmt: skip
        kinds = [identifier.removeprefix("kinemark:") for identifier, _ in said]
        self.assertEqual(kinds[:6], ["file", "usage", "usage", "usage", "usage", "usage"])
        self.assertEqual(said[0][1], "no'such [file].c3d: cannot be opened (No such file or directory) (exit status 4)")
        self.assertIn("there is no gap method 'bad'", said[2][1])
        self.assertIn("the last has no value", said[3][1])
        self.assertIn("need a text or a number", said[5][1])
        for identifier, sentence in said[6:]:
            self.assertRegex(sentence, r"exit status [234]\)$", identifier)
        self.assertGreater((self.folder / "made" / "markers.trc").stat().st_size, 1000)

    def test_a_program_that_is_not_there(self):
        ((identifier, sentence),) = self.refusals("kinemark.read('x.c3d')", program="/nowhere/kinemark")
        self.assertEqual(identifier, "kinemark:absent")
        self.assertIn("setenv KINEMARK_PROGRAM to the path", sentence)


if __name__ == "__main__":
    unittest.main()
