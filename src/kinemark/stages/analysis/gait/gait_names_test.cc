// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_names.h"

#include <gtest/gtest.h>

namespace kinemark::analysis {
namespace {

using data::Side;

// Whether a name is read as that place of that side.
bool is(std::string_view name, Side side, BodyPlace place) {
  for (const auto& [of, word] : sided_words(plain_name(name)))
    if (of == side && rank_of(place, word) >= 0) return true;
  return false;
}

TEST(GaitNames, PlainNamesHaveNoPersonCaseOrSeparators) {
  EXPECT_EQ(plain_name("Anna:R.Heel"), "rheel");
  EXPECT_EQ(plain_name("a:b:L_FM-5 "), "lfm5");
  EXPECT_EQ(person_of("a:b:L_FM5"), "a:b");
  EXPECT_EQ(person_of("LHEE"), "");
}

TEST(GaitNames, SideIsAPrefixOrASuffix) {
  for (const auto* const name : {"LHEE", "Left Heel", "LxHeel", "HeelL", "heel_left", "L_FCC", "LCAL"}) {
    EXPECT_TRUE(is(name, Side::left, BodyPlace::heel)) << name;
    EXPECT_FALSE(is(name, Side::right, BodyPlace::heel)) << name;
  }
  for (const auto* const name : {"RTOE", "RxToe1", "R.Toe.Tip", "RMT5", "ToeR", "Right Big Toe"})
    EXPECT_TRUE(is(name, Side::right, BodyPlace::forefoot)) << name;
}

TEST(GaitNames, WordsAreWholeAndNotPartsOfOthers) {
  EXPECT_TRUE(is("LLM", Side::left, BodyPlace::ankle));   // lateral malleolus
  EXPECT_TRUE(is("RLM", Side::right, BodyPlace::ankle));  // the right one
  EXPECT_FALSE(is("RLM", Side::left, BodyPlace::ankle));
  for (const auto* const name : {"LTHLP", "LHEELPAD", "LTOEBAR", "LSHANK", "LELB", "HEAD"})
    for (const auto place : {BodyPlace::heel, BodyPlace::forefoot, BodyPlace::ankle})
      for (const auto side : data::kBothSides) EXPECT_FALSE(is(name, side, place)) << name;
}

TEST(GaitNames, BetterNamesComeFirst) {
  EXPECT_LT(rank_of(BodyPlace::heel, "hee"), rank_of(BodyPlace::heel, "calc"));
  EXPECT_LT(rank_of(BodyPlace::forefoot, "toe"), rank_of(BodyPlace::forefoot, "mt5"));
  EXPECT_GT(rank_of(BodyPlace::forefoot, "d"), rank_of(BodyPlace::forefoot, "mfl"));
  EXPECT_EQ(rank_of(BodyPlace::heel, "toe"), -1);
  EXPECT_GE(rank_of(BodyPlace::sacrum, "vsacral"), 0);
  EXPECT_GE(rank_of(BodyPlace::front_of_pelvis, "asi"), 0);
  EXPECT_GE(rank_of(BodyPlace::back_of_pelvis, "bwt"), 0);
}

TEST(GaitNames, ASideAloneIsNoWord) {
  EXPECT_TRUE(sided_words("l").empty());
  EXPECT_TRUE(sided_words("head").empty());
}

}  // namespace
}  // namespace kinemark::analysis
