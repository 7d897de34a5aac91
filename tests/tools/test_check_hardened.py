# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from support import PROJECT, load_script

checker = load_script(PROJECT / "tools" / "check_hardened")

HEADERS = "  GNU_STACK 0x0 0x0 0x0 0x0 0x0 RW  0x10\n  GNU_RELRO 0x1\n"
DYNAMIC = " 0x1e (FLAGS) BIND_NOW\n 0x6ffffffb (FLAGS_1) Flags: NOW PIE\n"
SYMBOLS = "__stack_chk_fail __memcpy_chk std::__glibcxx_assert_fail"


class MissingGuards(unittest.TestCase):
    def test_nothing_is_missing(self):
        self.assertEqual(checker.missing_guards(HEADERS, DYNAMIC, SYMBOLS, 1000), [])

    def test_each_guard_that_is_taken_away_is_named(self):
        for headers, dynamic, symbols, entries, words in (
            (HEADERS.replace("GNU_RELRO", ""), DYNAMIC, SYMBOLS, 1000, "RELRO"),
            (HEADERS.replace("RW ", "RWE"), DYNAMIC, SYMBOLS, 1000, "executed"),
            (HEADERS, DYNAMIC.replace("NOW", ""), SYMBOLS, 1000, "BIND_NOW"),
            (HEADERS, DYNAMIC.replace("PIE", ""), SYMBOLS, 1000, "position-independent"),
            (HEADERS, DYNAMIC, SYMBOLS.replace("__stack_chk_fail", ""), 1000, "stack protector"),
            (HEADERS, DYNAMIC, SYMBOLS.replace("_chk ", " "), 1000, "FORTIFY"),
            (HEADERS, DYNAMIC, SYMBOLS.replace("glibcxx", ""), 1000, "GLIBCXX"),
            (HEADERS, DYNAMIC, SYMBOLS, 5, "control-flow"),
        ):
            with self.subTest(words):
                found = checker.missing_guards(headers, dynamic, symbols, entries)
                self.assertEqual(len(found), 1, found)
                self.assertIn(words, found[0])

    @unittest.skipUnless(shutil.which("gcc"), "no compiler here")
    def test_a_program_without_guards_is_known_by_its_bytes(self):
        with tempfile.TemporaryDirectory() as folder:
            source, program = Path(folder) / "bare.c", Path(folder) / "bare"
            source.write_text("int main(void) { return 0; }\n")
            subprocess.run(["gcc", source, "-o", program, "-no-pie", "-fcf-protection=none", "-Wl,-z,norelro,-z,lazy"], check=True)
            ran = subprocess.run([PROJECT / "tools" / "check_hardened", program], capture_output=True, text=True, check=False)
        self.assertEqual(ran.returncode, 1)
        for words in ("position-independent", "RELRO", "BIND_NOW", "control-flow"):
            self.assertIn(words, ran.stdout)


if __name__ == "__main__":
    unittest.main()
