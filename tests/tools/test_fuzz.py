# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import unittest

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


class Share(unittest.TestCase):
    def test_divides_a_time_for_all_and_leaves_none_without(self):
        self.assertEqual(fuzz.share(240, 12), 20)
        self.assertEqual(fuzz.share(240, 9), 26)
        self.assertEqual(fuzz.share(5, 9), 1)
        self.assertEqual(fuzz.share(240, 0), 240)


class Summary(unittest.TestCase):
    def test_tells_inputs_and_coverage(self):
        log = "#10 NEW cov: 50 ft: 60 corp: 2/3b\n#99 DONE cov: 1234 ft: 9 corp: 4/5b\nstat::number_of_executed_units: 56789\n"
        self.assertEqual(fuzz.summary(log), "56,789 inputs, 1,234 edges of code reached")

    def test_a_log_without_a_proper_end_is_no_success(self):
        self.assertIsNone(fuzz.summary("#10 NEW cov: 50 ft: 60\n"))
        self.assertIsNone(fuzz.summary("stat::number_of_executed_units: 5\n"))


if __name__ == "__main__":
    unittest.main()
