# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
"""`kinemark study poizner` and `kinemark simulate subject` from outside: tables, pages, seeds and known truth."""

import json
import math
import re
import unittest

from support import CommandTest, report_data, run, table


class Poizner(CommandTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.one, cls.two, cls.both = (cls.study("--seeds", seeds) for seeds in ("1", "2", "2,1"))

    @classmethod
    def study(cls, *options):
        ran = run("study", "poizner", "--json", "--quiet", *options, cwd=cls.shared.name)
        assert ran.status == 0, ran.err
        return json.loads(ran.out)

    def test_every_row_says_what_it_is_and_whether_it_passes(self):
        self.assertEqual(self.one["seeds"], [1])
        self.assertTrue(self.one["pass"])
        for row in self.one["rows"]:
            self.assertEqual(list(row), ["quantity", "unit", "paper", "classic", "ours", "expected", "expected_is", "bound", "pass"])
            low, high = row["bound"] if isinstance(row["bound"], list) else (None, row["bound"])
            passes = (low is None or row["ours"] >= low) and (high is None or row["ours"] <= high)
            self.assertEqual(row["pass"], passes if row["bound"] is not None else None, row["quantity"])
            self.assertEqual(row["expected"] is None, row["expected_is"] is None, row["quantity"])
            if row["expected_is"] == "Cramer-Rao bound":
                # The median of 30 scatters: rigs 1 to 6 lie between 0.93 and 1.11 of their bounds.
                self.assertGreater(row["ours"], 0.9 * row["expected"], row["quantity"])

    def test_the_worst_of_all_rigs_counts_and_their_order_does_not(self):
        self.assertEqual(self.both["seeds"], [2, 1])
        for a, b, c in zip(self.one["rows"], self.two["rows"], self.both["rows"], strict=True):
            if "of all seeds" in c["quantity"]:
                self.assertTrue(min(a["ours"], b["ours"]) <= c["ours"] <= max(a["ours"], b["ours"]), c["quantity"])
            else:
                worst = min if c["quantity"].endswith(", smallest") else max
                self.assertEqual(c["ours"], worst(a["ours"], b["ours"]), c["quantity"])

    def test_seeds_threads_and_the_seed_of_every_command(self):
        one, both = self.study("--seeds", "1-2", "--threads", 1)["rows"], self.both["rows"]
        self.assertEqual(one, both)
        self.assertEqual(self.study("--seed", 2), self.two)

    def test_the_page_has_the_table_and_fetches_nothing(self):
        ran = self.good("study", "poizner", "--seeds", "1", "--figures", "p.html")
        page = (self.folder / "p.html").read_text()
        self.assertIn("still tree: scatter of a frame, x", page)
        lines = ran.out.splitlines()
        self.assertEqual(lines[0].split(), ["unit", "paper", "classic", "ours", "expected", "bound"])
        self.assertTrue(lines[1].startswith("still tree: scatter of a frame, x "), lines[1])
        self.assertEqual(len(lines), len(self.one["rows"]) + 3)
        self.assertNotIn("still tree", ran.err)
        figures = json.loads(report_data(page))["result"]["figures"]
        self.assertGreater(len(figures), 2)
        for figure in figures:
            self.assertIn("<svg", figure["body"])
            self.assertNotRegex(figure["body"], r"(?:src|href)=|\bnan\b")
        self.refused(4, ["p.html", "--force"], "study", "poizner", "--figures", "p.html")

    def test_a_folder_gets_the_page_and_the_papers_figures_by_number(self):
        self.good("study", "poizner", "--figures", "study")
        names = {path.name for path in (self.folder / "study").iterdir()}
        for number in range(1, 7):
            for ending in ("svg", "png", "csv"):
                self.assertIn(f"poizner-1986-figure-{number}.{ending}", names)
        self.assertIn("study.html", names)
        picture = (self.folder / "study/poizner-1986-figure-5.svg").read_text()
        self.assertIn("Poizner 1986, figure 5", picture)
        self.assertIn("Scatter of the diameter: 0.5 mm in the paper", picture.replace("Wheel at 8 deg: scatter", "Scatter"))
        self.refused(4, ["study.html", "--force"], "study", "poizner", "--figures", "study")

    def test_rigs_as_built_err_as_the_paper_reports(self):
        ran = self.good("study", "poizner", "--as-built", "--seeds", "1-3", "--json", "--figures", "b.html")
        rows = {row["quantity"]: row for row in json.loads(ran.out)["rows"]}
        worst = rows["tree, worst of ten places: largest error of a distance, median of rigs"]
        self.assertEqual(worst["paper"], 46)
        self.assertGreater(worst["classic"], 10)
        best = rows["tree, best of ten places: largest error of a distance, median of rigs"]
        self.assertLess(best["ours"], 0.3 * best["classic"])
        self.assertIn("errors of the tree's distances over the room", (self.folder / "b.html").read_text())

    def test_the_macaque_reports_numbers_come_out_as_published(self):
        ran = self.good("study", "macaque", "--as-published", "--seeds", "1-6", "--json", "--figures", "m.html")
        rows = {row["quantity"]: row for row in json.loads(ran.out)["rows"]}
        noisy = rows["2 mm noise, 0 % missing: mean error of the elbow, mean of recordings"]
        self.assertEqual(noisy["paper"], 30)
        self.assertLess(abs(noisy["classic"] - 30), 10)
        self.assertLess(noisy["ours"], 3)
        self.assertIn("Macaque report, figure 6: mean error of the elbow against missing data", (self.folder / "m.html").read_text())

    def test_a_rig_that_misses_bounds_is_shown_whole_and_says_which(self):
        ran = run("study", "poizner", "--seeds", "0", "--json", cwd=self.folder)
        table = json.loads(ran.out)
        self.assertEqual([row["quantity"] for row in table["rows"]], [row["quantity"] for row in self.one["rows"]])
        missed = [row["quantity"] for row in table["rows"] if row["pass"] is False]
        self.assertEqual(ran.status, 1 if missed else 0)
        self.assertEqual(table["pass"], not missed)
        words = f"{len(missed)} of {len(table['rows'])} bounds are missed: " if missed else "bounds is missed."
        self.assertIn(words + "; ".join(missed), ran.err)

    def test_what_is_no_list_of_seeds_is_refused(self):
        for seeds in ("a", "1-", "3-1", "-1", "1,,2", "1-1001", "1.5"):
            self.refused(2, [f"'{seeds}'", "1-10 or 1,4,7-9"], "study", "poizner", f"--seeds={seeds}")

    def test_a_page_that_cannot_be_written_is_refused_before_the_work(self):
        self.refused(4, "no/p.html", "study", "poizner", "--figures", "no/p.html", "--seeds", "1-1000")


class Subject(CommandTest):
    """`samples()` gives {(row, marker): metres} of a TRC file without its gaps."""

    def simulate(self, folder, *options):
        self.good("simulate", "subject", "-o", folder, "--quiet", *options)
        return self.folder / folder

    @staticmethod
    def samples(path):
        lines = path.read_text().split("\n")
        names = [cell for cell in lines[3].split("\t")[2:] if cell.strip()]
        scale = 1e-3 if lines[2].split("\t")[4] == "mm" else 1.0
        samples = {}
        for row, line in enumerate(line for line in lines[6:] if line.strip()):
            cells = line.split("\t")[2:]
            for marker, name in enumerate(names):
                three = cells[3 * marker : 3 * marker + 3]
                position = [scale * float(cell or "nan") for cell in three]
                if all(map(math.isfinite, position)):
                    samples[row, name] = position
        return samples

    def errors_mm(self, folder):
        seen, truth = self.samples(folder / "markers.trc"), self.samples(folder / "truth.trc")
        self.assertLessEqual(set(seen), set(truth))
        return [1e3 * (a - b) for key, x in seen.items() for a, b in zip(x, truth[key], strict=True)]

    def test_without_noise_the_markers_are_the_truth(self):
        folder = self.simulate("clean", "--duration", 0.3, "--noise", 0)
        self.assertLess(max(map(abs, self.errors_mm(folder))), 1e-3)

    def test_noise_is_as_large_as_asked_for(self):
        for noise in (0.5, 3.0):
            errors = self.errors_mm(self.simulate(f"n{noise}", "--duration", 1, "--noise", noise))
            self.assertAlmostEqual(math.sqrt(sum(e * e for e in errors) / len(errors)) / noise, 1.0, delta=0.03)
            self.assertAlmostEqual(sum(errors) / len(errors) / noise, 0.0, delta=0.05)

    def test_soft_tissue_moves_markers_beyond_their_noise(self):
        still = self.errors_mm(self.simulate("still", "--duration", 0.5))
        moving = self.errors_mm(self.simulate("moving", "--duration", 0.5, "--soft-tissue", 1))
        self.assertGreater(sum(e * e for e in moving), 4 * sum(e * e for e in still))

    def test_gaps_take_their_share_and_leave_the_truth_whole(self):
        folder = self.simulate("gaps", "--duration", 2, "--dropout-random", 0.3)
        seen, truth = self.samples(folder / "markers.trc"), self.samples(folder / "truth.trc")
        self.assertAlmostEqual(1.0 - len(seen) / len(truth), 0.3, delta=0.03)
        self.assertEqual(len(truth), 200 * 40)

    def test_rate_and_duration_make_the_frames(self):
        for rate, duration, frames in ((50, 1, 50), (120, 0.25, 30), (10, 0.1, 1)):
            folder = self.simulate(f"r{rate}", "--rate", rate, "--duration", duration)
            facts = json.loads(self.good("info", folder / "markers.c3d", "--json").out)
            self.assertEqual((facts["frames"], facts["rate_hz"]), (frames, rate))
            self.assertEqual(len(table(folder / "truth.mot")[1]), frames)

    def test_a_seed_is_all_that_is_random(self):
        one, again, other = (self.simulate(name, "--duration", 0.2, "--seed", seed) for name, seed in (("a", 4), ("b", 4), ("c", 5)))
        for name in ("markers.c3d", "markers.trc", "truth.mot", "truth.trc", "model.osim"):
            self.assertEqual((one / name).read_bytes(), (again / name).read_bytes(), name)
        self.assertNotEqual((one / "markers.trc").read_bytes(), (other / "markers.trc").read_bytes())

    def test_angles_come_back_from_perfect_markers(self):
        folder = self.simulate("clean", "--duration", 0.3, "--noise", 0)
        self.good("ik", "-m", folder / "model.osim", "-t", folder / "markers.c3d", "-o", "q.mot", "--quiet")
        names, rows = table(self.folder / "q.mot")
        truth_names, truth = table(folder / "truth.mot")
        self.assertEqual(names, truth_names)
        for ours, true in zip(rows, truth, strict=True):
            for name, a, b in zip(names, ours, true, strict=True):
                self.assertAlmostEqual(a, b, delta=0.02, msg=name)

    def test_the_users_model_is_simulated(self):
        folder = self.simulate("own", "-m", self.model, "--duration", 0.1)
        self.assertEqual(json.loads(self.good("info", folder / "model.osim", "--json").out)["markers"], 40)
        bare = re.sub(r"<Marker name=.*?</Marker>", "", self.model.read_text(), flags=re.DOTALL)
        self.write("bare.osim", bare)
        self.refused(3, "has no markers", "simulate", "subject", "-o", "s", "-m", "bare.osim")
        self.refused(4, "none.osim", "simulate", "subject", "-o", "s", "-m", "none.osim")

    def test_numbers_beyond_their_range_are_refused(self):
        for option, value, words in (
            ("--noise", -1, "noise"),
            ("--noise", "nan", "noise"),
            ("--soft-tissue", -0.1, "soft_tissue"),
            ("--dropout-random", 0.95, "0 to 0.9"),
            ("--dropout-sight", -0.1, "dropout_sight"),
            ("--duration", 1e12, "frames"),
            ("--rate", 0, "positive"),
        ):
            self.refused(2, words, "simulate", "subject", "-o", "s", option, value)
        self.refused(2, "soft_tissue_common", "simulate", "subject", "-o", "s", "--soft-tissue", 1, "--soft-tissue-common", 1.5)


if __name__ == "__main__":
    unittest.main()
