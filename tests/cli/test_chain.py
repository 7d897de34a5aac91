# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""Commands one after the other, each on the files of the one before, and the mechanics of what comes out at the end."""

import json
import math
import re
import unittest

from support import CommandTest, report_data, run, table

GRAVITY = 9.80665


class InTheLab(CommandTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.lab = cls.recorded.parent / "lab"
        made = run("simulate", "subject", "-o", cls.lab, "--duration", 1.5, "--dropout-random", 0.03, cwd=cls.recorded)
        assert made.status == 0, made.err
        cls.names, cls.truth = table(cls.lab / "truth.mot")

    def solve(self, output, markers=None, model=None, *options):
        self.good("ik", "-m", model or self.lab / "model.osim", "-t", markers or self.lab / "markers.c3d", "-o", f"{output}.mot", "--quiet", *options)
        return table(self.folder / f"{output}.mot")[1]


class Chain(InTheLab):
    def error(self, rows):
        """RMS error of the angles, in degrees."""
        squares = [
            (a - b) ** 2
            for row, true in zip(rows, self.truth, strict=True)
            for name, a, b in zip(self.names, row, true, strict=True)
            if name != "time" and not name.startswith(("mtp", "pelvis_t"))
        ]
        return math.sqrt(sum(squares) / len(squares))

    def test_cleaned_markers_give_better_angles(self):
        self.good("clean", self.lab / "markers.c3d", "clean.nwb", "--quiet")
        raw, clean = self.error(self.solve("raw")), self.error(self.solve("better", "clean.nwb"))
        self.assertLess(clean, 0.5 * raw)

    def test_a_model_that_was_scaled_and_converted_solves_the_recording(self):
        self.good("scale", "-m", self.lab / "model.osim", "-t", self.lab / "markers.c3d", "-o", "scaled.osim", "--quiet")
        self.good("convert", "scaled.osim", "again.osim", "--quiet")
        scaled, again = self.solve("one", model="scaled.osim"), self.solve("two", model="again.osim")
        for row, other in zip(scaled, again, strict=True):
            for name, a, b in zip(self.names, row, other, strict=True):
                if not name.startswith("mtp"):
                    self.assertAlmostEqual(a, b, delta=1e-3, msg=name)
        self.solve("own")
        fit = {name: json.loads((self.folder / f"{name}_report.json").read_text())["rms_error_mm"] for name in ("own", "two")}
        self.assertLess(fit["two"], fit["own"], "it was fitted to these markers")

    def test_the_page_tells_the_numbers_of_the_files(self):
        self.solve("q", None, None, "--report", "direct.html")
        self.good("report", "q.mot", "-o", "later.html", "--quiet")
        summary = json.loads((self.folder / "q_report.json").read_text())
        for page in ("direct.html", "later.html"):
            written = json.loads(report_data((self.folder / page).read_text()))["summary"]
            self.assertEqual(written["rms_error_mm"], summary["rms_error_mm"])
            self.assertEqual([each["name"] for each in written["coordinates"]], self.names[1:])

    def test_every_file_of_a_run_has_the_same_rows(self):
        self.solve("q", None, None, "--torques")
        times = [row[0] for row in table(self.folder / "q.mot")[1]]
        self.assertEqual(times, [row[0] for row in self.truth])
        for name in ("sd", "marker_errors", "tau", "tau_sd"):
            self.assertEqual([row[0] for row in table(self.folder / f"q_{name}.sto")[1]], times, name)


class Mechanics(InTheLab):
    def torques(self, output, model=None):
        rows = self.solve(output, None, model, "--torques")
        names, torques = table(self.folder / f"{output}_tau.sto")
        return rows, names, torques

    def heavier(self, factor):
        """The model with all masses and inertias times a factor."""

        def scaled(match):
            numbers = " ".join(repr(factor * float(number)) for number in match[2].split())
            return f"<{match[1]}>{numbers}</{match[1]}>"

        text = (self.lab / "model.osim").read_text()
        self.write("heavy.osim", re.sub(r"<(mass|inertia)>([^<]*)</\1>", scaled, text))
        return "heavy.osim"

    def test_the_root_carries_the_weight(self):
        _, names, rows = self.torques("q")
        mass = json.loads(self.good("info", self.lab / "model.osim", "--json").out)["mass_kg"]
        up = names.index("pelvis_ty_force")
        mean = sum(row[up] for row in rows) / len(rows)
        self.assertAlmostEqual(mean / (mass * GRAVITY), 1.0, delta=0.1)
        for side in ("pelvis_tx_force", "pelvis_tz_force"):
            self.assertLess(abs(sum(row[names.index(side)] for row in rows) / len(rows)), 0.1 * mass * GRAVITY, side)

    def test_torques_grow_with_the_masses_and_angles_do_not(self):
        angles, names, torques = self.torques("q")
        heavy_angles, heavy_names, heavy_torques = self.torques("h", self.heavier(2.0))
        self.assertEqual(heavy_names, names)
        for a, b in zip(angles, heavy_angles, strict=True):
            for x, y in zip(a, b, strict=True):
                self.assertAlmostEqual(x, y, delta=1e-6)
        for a, b in zip(torques, heavy_torques, strict=True):
            for x, y in zip(a[1:], b[1:], strict=True):
                self.assertAlmostEqual(y, 2.0 * x, delta=1e-3 + 1e-6 * abs(x))

    def test_both_ways_to_angles_find_the_same_torques(self):
        _, names, by_squares = self.torques("q")
        self.good("track", "-m", self.lab / "model.osim", "-t", self.lab / "markers.c3d", "-o", "t.mot", "--quiet")
        other_names, by_control = table(self.folder / "t_tau.sto")
        self.assertEqual(other_names, names)
        up = names.index("pelvis_ty_force")
        means = [sum(row[up] for row in rows) / len(rows) for rows in (by_squares, by_control)]
        self.assertAlmostEqual(means[0] / means[1], 1.0, delta=0.05)

    def test_a_locked_coordinate_rests_and_nothing_is_said_of_its_error(self):
        options = ("--lock", "knee_angle_r", "--rest", "knee_angle_r=0.4", "--quiet")
        self.good("track", "-m", self.lab / "model.osim", "-t", self.lab / "markers.c3d", "-o", "t.mot", *options)
        column = self.names.index("knee_angle_r")
        for row in table(self.folder / "t.mot")[1]:
            self.assertAlmostEqual(row[column], math.degrees(0.4), places=6)
        for name in ("bound", "sd"):
            self.assertTrue(all(math.isnan(row[column]) for row in table(self.folder / f"t_{name}.sto")[1]), name)

    def test_a_model_without_masses_has_no_torques(self):
        text = re.sub(r"<mass>[^<]*</mass>", "<mass>0</mass>", (self.lab / "model.osim").read_text())
        self.write("light.osim", text)
        self.refused(3, "no body of the model has a mass", "ik", "-m", "light.osim", "-t", self.lab / "markers.c3d", "-o", "q.mot", "--torques")


if __name__ == "__main__":
    unittest.main()
