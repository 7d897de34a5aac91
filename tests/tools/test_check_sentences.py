# SPDX-FileCopyrightText: 2026 The kinemark authors
# SPDX-License-Identifier: Apache-2.0
import contextlib
import io
import unittest

from support import Tree, load_tool

sentences = load_tool("check_sentences")

SOURCE = '''// "a comment with many words in it"
#include "kinemark/core/result.h"
std::string words(int n, bool off) {
  if (n < 0) return fail(Code::bad_input, "a number below zero was given here");
  if (off) return "marker \\"A\\" left its path by "
                  "more than its noise";
  return "too short";
}
'''
TESTS = '''TEST(Words, AreSaid) {
  EXPECT_THAT(words(1, true), HasSubstr("left its path by more"));
}

TEST(Words, AreNotSaid) {
  EXPECT_THAT(words(1, false), Not(HasSubstr("left its path by more")));
}

TEST(Words, AreSilent) {
  EXPECT_THAT(all_words(1), IsEmpty());
}
'''
ROW = '''[[sentence]]
file = "src/kinemark/data/words.cc"
says = "left its path by more than its noise"
planted = "words_test.cc:Words.AreSaid"
opposite = "words_test.cc:Words.AreNotSaid"
'''
RIGHT = {
    "src/kinemark/data/words.cc": SOURCE,
    "src/kinemark/data/words_test.cc": TESTS,
    "tests/sentences.toml": ROW,
}


class CheckSentences(unittest.TestCase):
    def wrong(self, **changes):
        with Tree({**RIGHT, **{name.replace("__", "/").replace("TOML", "sentences.toml"): text for name, text in changes.items()}}) as root:
            return sentences.check(root)

    def of_table(self, table):
        return self.wrong(**{"tests__TOML": table})

    def test_passes_a_sentence_with_both_tests(self):
        self.assertEqual(self.wrong(), [])

    def test_errors_comments_includes_and_short_words_are_no_sentences(self):
        self.assertEqual(sentences.sentences_of(SOURCE), ['marker \\"A\\" left its path by more than its noise'])

    def test_a_sentence_without_a_row_fails(self):
        (line,) = self.of_table("")
        self.assertIn("words.cc: no row for", line)
        self.assertIn("left its path", line)

    def test_a_row_without_a_sentence_fails(self):
        stale = ROW + ROW.replace("left its path by more than its noise", "said long ago and no more")
        self.assertEqual(self.of_table(stale), ['src/kinemark/data/words.cc: no sentence holds "said long ago and no more"'])

    def test_a_test_that_does_not_exist_fails(self):
        (line,) = self.of_table(ROW.replace("Words.AreNotSaid", "Words.Gone"))
        self.assertIn("opposite names no test: 'words_test.cc:Words.Gone'", line)

    def test_the_two_tests_cannot_be_exchanged(self):
        (line,) = self.of_table(ROW.replace("AreNotSaid", "AreSaid"))
        self.assertIn("Words.AreSaid does not deny it", line)
        (line,) = self.of_table(ROW.replace("Words.AreSaid", "Words.AreNotSaid"))
        self.assertIn("Words.AreNotSaid does not expect it", line)

    def test_silence_is_an_opposite_where_the_row_says_so(self):
        silent = ROW.replace("AreNotSaid", "AreSilent")
        self.assertEqual(len(self.of_table(silent)), 1)
        self.assertEqual(self.of_table(silent + "silent = true\n"), [])
        (line,) = self.of_table(ROW.replace("AreNotSaid", "AreSaid") + "silent = true\n")
        self.assertIn("does not expect silence", line)

    def test_the_message_of_an_expectation_expects_nothing(self):
        messages = '''TEST(Words, AreSaid) {
  for (int i : {1, 2}) EXPECT_EQ(words(i, true), kWords) << "left its path by more than its noise";
}

TEST(Words, AreNotSaid) {
  EXPECT_FALSE(words(1, false).empty()) << "left its path by more than its noise";
}
'''
        lines = self.wrong(**{"src/kinemark/data/words_test.cc": messages})
        self.assertEqual(len(lines), 2)
        python = '''class Words:
    def test_said(self):
        self.assertIn("left its path by more", words(1))
        self.assertNotIn("something else of more than a few words", words(1), "left its path by more")
'''
        row = ROW.replace("words_test.cc:Words.AreSaid", "test_words.py:test_said")
        self.assertEqual(self.wrong(**{"tests__TOML": row, "tests/cli/test_words.py": python}), [])
        row = ROW.replace("words_test.cc:Words.AreNotSaid", "test_words.py:test_said")
        (line,) = self.wrong(**{"tests__TOML": row, "tests/cli/test_words.py": python})
        self.assertIn("test_said does not deny it", line)

    def test_what_other_sentences_say_too_shows_of_no_test_elsewhere_which_one_it_is_about(self):
        other = SOURCE.replace('marker \\"A\\" left', 'segment B left').replace("more than its noise", "more than a metre or two")
        elsewhere = TESTS.replace("TEST(Words", "TEST(Others")
        row = ROW + ROW.replace("words.cc", "others.cc").replace("than its noise", "than a metre").replace("words_test.cc:Words", "others_test.cc:Others")
        files = {"src/kinemark/data/others.cc": other, "src/kinemark/data/others_test.cc": elsewhere, "tests__TOML": row}
        self.assertEqual(self.wrong(**files), [])
        files["tests__TOML"] = row.replace("words_test.cc:Words.AreNotSaid", "others_test.cc:Others.AreNotSaid")
        (line,) = self.wrong(**files)
        self.assertIn("Others.AreNotSaid does not deny it", line)

    def test_owed_tests_are_counted_and_bounded(self):
        owing = ROW.replace('opposite = "words_test.cc:Words.AreNotSaid"', "owed = true")
        (line,) = self.of_table(owing)
        self.assertIn("1 sentences owe a test; 0 at most may", line)
        self.assertEqual(self.of_table("owed_at_most = 1\n" + owing), [])

    def test_an_exemption_needs_a_reason(self):
        head = "\n".join(ROW.splitlines()[:3]) + "\n"
        self.assertEqual(self.of_table(head + 'exempt = "a name, no claim"\n'), [])
        (line,) = self.of_table(head + 'exempt = "no"\n')
        self.assertIn("exempt needs a reason", line)

    def test_a_file_of_texts_is_passed_over_while_it_is_there(self):
        texts = '[[texts]]\nfile = "src/kinemark/data/{}"\nwhy = "names of columns"\n'
        self.assertEqual(self.of_table(texts.format("words.cc")), [])
        self.assertIn("src/kinemark/data/gone.cc: listed as text, and not there", self.of_table(texts.format("gone.cc")))

    def test_program_exits_with_1_on_a_problem(self):
        for table, status in [(ROW, 0), ("", 1)]:
            with Tree({**RIGHT, "tests/sentences.toml": table}) as root, contextlib.redirect_stdout(io.StringIO()):
                self.assertEqual(sentences.main([str(root)]), status)


if __name__ == "__main__":
    unittest.main()
