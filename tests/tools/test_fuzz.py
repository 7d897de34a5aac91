# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import unittest
from pathlib import Path

from support import Tree, load_tool

fuzz = load_tool("fuzz")


class FindTargets(unittest.TestCase):
    def test_pairs_programs_with_their_kept_inputs(self):
        files = {
            "bin/fuzz_c3d": "",
            "bin/fuzz_new": "",
            "corpus/c3d/one.c3d": "",
            "corpus/gone/one": "",
            "corpus/empty/sub/.keep": "",
        }
        with Tree(files) as root:
            for program in (root / "bin").iterdir():
                program.chmod(0o755)
            (root / "corpus/empty/sub/.keep").unlink()
            (root / "corpus/empty/sub").rmdir()
            names, problems = fuzz.find_targets(root / "bin", root / "corpus")
        self.assertEqual(names, ["c3d"])
        self.assertEqual(len(problems), 2, problems)
        self.assertIn("fuzz_new has no corpus", problems[0])
        self.assertIn("tests/fuzz/corpus/gone has no program fuzz_gone", problems[1])


class HowLong(unittest.TestCase):
    def test_a_fixed_number_of_runs_begins_with_the_kept_inputs_in_the_order_of_their_names(self):
        with Tree({"corpus/c.c3d": "", "corpus/a.c3d": "", "corpus/b.c3d": "", "work/log": ""}) as root:
            options = fuzz.how_long("c3d", None, root / "corpus", root / "work")
            kept = (root / "work" / "kept").read_text().split(",")
            self.assertFalse((root / "work" / "found").exists())
        self.assertEqual([Path(name).name for name in kept], ["a.c3d", "b.c3d", "c.c3d"])
        self.assertEqual(options, [f"-runs={fuzz.RUNS['c3d']}", "-shuffle=0", f"-seed_inputs=@{root / 'work' / 'kept'}"])

    def test_a_hunt_begins_with_all_that_was_ever_found(self):
        with Tree({"corpus/a": "", "work/log": ""}) as root:
            options = fuzz.how_long("c3d", 30, root / "corpus", root / "work")
            self.assertTrue((root / "work" / "found").is_dir())
        self.assertEqual(options, ["-max_total_time=30", str(root / "work" / "found"), str(root / "corpus")])

    def test_each_target_has_a_number_of_runs(self):
        kept = sorted(path.name for path in fuzz.CORPORA.iterdir())
        self.assertEqual(sorted(fuzz.RUNS), kept)
        self.assertEqual(fuzz.without_runs(kept), [])
        self.assertEqual(fuzz.without_runs(["c3d", "new"]), ["fuzz_new has no number of runs; give it one in RUNS of tools/fuzz"])


class Corpora(unittest.TestCase):
    def test_are_small_and_many(self):
        for corpus in fuzz.CORPORA.iterdir():
            sizes = [path.stat().st_size for path in corpus.iterdir()]
            with self.subTest(corpus=corpus.name):
                self.assertGreaterEqual(len(sizes), 50)
                self.assertLessEqual(max(sizes), 20_000)
        self.assertLess(sum(path.stat().st_size for path in fuzz.CORPORA.rglob("*") if path.is_file()), 3_000_000)


class Summary(unittest.TestCase):
    def test_tells_inputs_and_coverage(self):
        log = "#10 NEW cov: 50 ft: 60 corp: 2/3b\n#99 DONE cov: 1234 ft: 9 corp: 4/5b\nstat::number_of_executed_units: 56789\n"
        self.assertEqual(fuzz.summary(log), "56,789 inputs, 1,234 edges of code reached")

    def test_a_log_without_a_proper_end_is_no_success(self):
        self.assertIsNone(fuzz.summary("#10 NEW cov: 50 ft: 60\n"))
        self.assertIsNone(fuzz.summary("stat::number_of_executed_units: 5\n"))


if __name__ == "__main__":
    unittest.main()
