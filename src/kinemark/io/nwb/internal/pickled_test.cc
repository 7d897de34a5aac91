// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/pickled.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace kinemark::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// What Python says: pickle.dumps([("net", "wrist", "x"), ("net", "wrist", "y")], 0)
const std::string kTwo = "(lp0\n(Vnet\np1\nVwrist\np2\nVx\np3\ntp4\na(g1\ng2\nVy\np5\ntp6\na.";

TEST(PickledLabels, TuplesOfTextsWithWhatIsRemembered) {
  EXPECT_THAT(parse_pickled_labels(kTwo).value(),
              ElementsAre(ElementsAre("net", "wrist", "x"), ElementsAre("net", "wrist", "y")));
  EXPECT_THAT(parse_pickled_labels("(lp0\n.").value(), IsEmpty());
  // pickle.dumps([("a",)] * 2, 0): a whole tuple is remembered
  EXPECT_THAT(parse_pickled_labels("(lp0\n(Va\np1\ntp2\nag2\na.").value(),
              ElementsAre(ElementsAre("a"), ElementsAre("a")));
}

TEST(PickledLabels, LettersOfAllAlphabets) {
  // pickle.dumps([("\u00fc\u03b1\U0001f400\\", "\n")], 0)
  EXPECT_THAT(
      parse_pickled_labels("(lp0\n(V\xfc\\u03b1\\U0001f400\\u005c\np1\nV\\u000a\np2\ntp3\na.").value(),
      ElementsAre(ElementsAre("\u00fc\u03b1\U0001f400\\", "\n")));
  EXPECT_THAT(parse_pickled_labels("(lp0\n(V\\ud800\\Uffffffff\ntp1\na.").value(),
              ElementsAre(ElementsAre("\uFFFD\uFFFD")))
      << "what is no code point";
}

TEST(PickledLabels, NothingElseIsUnderstoodAndNothingIsCalled) {
  for (const char* pickle : {"", ".", "(", "(l", "cos\nsystem\n(Vrm\ntR.", "I1\n.", "(lp0\nI1\na.",
                             "(lp0\nVa\na.", "(lp0\n(dp1\na.", "(lp0\n(lp1\na.", "(lp0\ng7\na.",
                             "(lp0\n(Vx\\u12\ntp1\na.", "(lp0\n(Vx\\uwxyz\ntp1\na.", "(lp0\n(Va\nt",
                             "(lp0\nt.", "t.", "(lp0\n(Va", "(lp0\np99999999999999999999\n."}) {
    const auto read = parse_pickled_labels(pickle);
    ASSERT_FALSE(read) << pickle;
    EXPECT_EQ(read.error().code, Code::bad_input);
    EXPECT_THAT(read.error().message, HasSubstr("not a pickled list of names"));
  }
}

TEST(PickledLabels, EveryShorterOneIsRefusedAndAChangedOneGivesNoMore) {
  for (std::size_t n = 0; n < kTwo.size(); ++n) EXPECT_FALSE(parse_pickled_labels(kTwo.substr(0, n))) << n;
  for (std::size_t i = 0; i < kTwo.size(); ++i)
    for (int c = 0; c < 256; ++c) {
      auto text = kTwo;
      text[i] = static_cast<char>(c);
      if (const auto read = parse_pickled_labels(text); read) {
        EXPECT_LE(read->size(), 2U);
      }
    }
}

TEST(PickledLabels, WhatIsRememberedCannotGrowWithoutEnd) {
  std::string text = "(lp0\n(";
  for (int i = 0; i < 1000; ++i) text += "Va\n";
  text += "tp1\na";
  for (int i = 0; i < 1000; ++i) text += "g1\na";
  EXPECT_FALSE(parse_pickled_labels(text + "."));
}

}  // namespace
}  // namespace kinemark::io::internal
