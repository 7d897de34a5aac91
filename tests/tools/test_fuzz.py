# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import re
import unittest
from random import Random

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
    def test_a_fixed_set_is_the_kept_inputs_and_the_same_damaged_copies_each_time(self):
        tried, first, third = [], "first, 1.25\n" * 20, "third one, " * 20
        with Tree({"corpus/c.c3d": third, "corpus/a.c3d": first, "work/log": "", "work/tried/old": ""}) as root:
            fuzz.COPIES["few"] = 200
            self.addCleanup(fuzz.COPIES.pop, "few")
            for seed in (1, 1, 2):
                options = fuzz.how_long("few", None, seed, root / "corpus", root / "work")
                self.assertEqual(options, ["-runs=0", str(root / "work" / "tried")])
                tried.append({path.name: path.read_bytes() for path in (root / "work" / "tried").iterdir()})
            self.assertFalse((root / "work" / "found").exists())
        self.assertEqual(len(tried[0]), 202)
        self.assertEqual((tried[0]["kept_0"], tried[0]["kept_1"]), (first.encode(), third.encode()))
        self.assertEqual(tried[0], tried[1])
        self.assertNotEqual(tried[0], tried[2])
        self.assertGreater(len(set(tried[0].values())), 180, "copies differ")

    def test_a_hunt_begins_with_all_that_was_ever_found_the_kept_inputs_and_copies(self):
        with Tree({"corpus/a": "kept", "work/found/b": "", "work/log": ""}) as root:
            options = fuzz.how_long("nwb", 30, 1, root / "corpus", root / "work")
            self.assertTrue((root / "work" / "found" / "b").is_file())
            self.assertEqual((root / "work" / "tried" / "kept_0").read_bytes(), b"kept")
            self.assertEqual(len(list((root / "work" / "tried").iterdir())), 1 + fuzz.COPIES["nwb"])
        self.assertEqual(options, ["-max_total_time=30", str(root / "work" / "found"), str(root / "work" / "tried")])

    def test_each_target_has_a_number_of_copies(self):
        kept = sorted(path.name for path in fuzz.CORPORA.iterdir())
        self.assertEqual(sorted(fuzz.COPIES), kept)
        self.assertEqual(fuzz.without_copies(kept), [])
        self.assertEqual(fuzz.without_copies(["c3d", "new"]), ["fuzz_new has no number of copies; give it one in COPIES of tools/fuzz"])


class Damaged(unittest.TestCase):
    def test_uses_words_and_other_inputs_and_takes_an_empty_one(self):
        random = Random(1)
        copies = [fuzz.damaged(b"abc" * 20, [b"OTHER" * 40], [b"<word>"], random) for _ in range(300)]
        for part in (b"<word>", b"OTHEROTHER"):
            self.assertTrue(any(part in copy for copy in copies), part)
        self.assertTrue(any(len(copy) < 60 for copy in copies))
        self.assertTrue(any(len(copy) > 60 for copy in copies))
        self.assertEqual({type(fuzz.damaged(b"", [b""], [], random)) for _ in range(100)}, {bytes})

    def test_changes_whole_cells_and_lines(self):
        self.assertEqual(fuzz.cell_around(bytearray(b"a\tbcd,e"), 3), (2, 5))
        self.assertEqual(fuzz.cell_around(bytearray(b"abc"), 1), (0, 3))
        self.assertEqual(fuzz.line_around(bytearray(b"a\nbcd\ne"), 3), (2, 6))
        self.assertEqual(fuzz.line_around(bytearray(b"abc"), 3), (0, 3))
        random = Random(2)
        copies = {fuzz.damaged(b"x 1\ny 2\nz 3\n", [b""], [], random) for _ in range(3000)}
        self.assertTrue({b"x 1\nz 3\n", b"x 1\ny 2\ny 2\nz 3\n"} <= copies, "lines are left out and doubled")
        self.assertTrue(any(b"x 1\ny " + odd + b"\nz 3\n" in copies for odd in fuzz.ODD), "a cell becomes odd")

    def test_words_of_a_dictionary_lose_their_quotes_and_escapes(self):
        with Tree({"d": '# "no"\nname="a\\x00b"\n"tab\\"s"\n'}) as root:
            self.assertEqual(fuzz.dictionary_words(root / "d"), [b"a\0b", b'tab"s'])
            self.assertEqual(fuzz.dictionary_words(root / "none"), [])


class Corpora(unittest.TestCase):
    def test_are_small_and_named_by_what_they_are(self):
        for corpus in fuzz.CORPORA.iterdir():
            inputs = list(corpus.iterdir())
            with self.subTest(corpus=corpus.name):
                self.assertGreater(len(inputs), 5)
                self.assertLessEqual(max(path.stat().st_size for path in inputs), 20_000)
                self.assertEqual([path.name for path in inputs if re.search("[0-9a-f]{16}", path.name)], [])
        self.assertLess(sum(path.stat().st_size for path in fuzz.CORPORA.rglob("*") if path.is_file()), 3_000_000)

    def test_a_run_tries_hundreds_of_inputs_of_each_format(self):
        self.assertGreaterEqual(min(fuzz.COPIES.values()), 300)


class Summary(unittest.TestCase):
    def test_tells_inputs_and_coverage(self):
        log = "#10 NEW cov: 50 ft: 60 corp: 2/3b\n#99 DONE cov: 1234 ft: 9 corp: 4/5b\nstat::number_of_executed_units: 56789\n"
        self.assertEqual(fuzz.summary(log), "56,789 inputs, 1,234 edges of code reached")

    def test_a_log_without_a_proper_end_is_no_success(self):
        self.assertIsNone(fuzz.summary("#10 NEW cov: 50 ft: 60\n"))
        self.assertIsNone(fuzz.summary("stat::number_of_executed_units: 5\n"))


if __name__ == "__main__":
    unittest.main()
