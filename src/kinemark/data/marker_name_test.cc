// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/marker_name.h"

#include <gmock/gmock.h>

namespace kinemark::data {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(MarkerName, ASideThatIsAWordIsTheOnlyReading) {
  const MarkerStem heel{.side = 'r', .stem = "heel"};
  for (const char* name :
       {"R.Heel", "right_heel", "R Heel", "RIGHTHEEL", "heel_r", "Ann:R-HEEL", "Heel Right"})
    EXPECT_THAT(read_marker_name(name), ElementsAre(heel)) << name;
  EXPECT_THAT(read_marker_name("l_lelbow_study"),
              ElementsAre(MarkerStem{.side = 'l', .stem = "lelbowstudy"}));
}

TEST(MarkerName, ALetterMayBeASide) {
  EXPECT_THAT(read_marker_name("LASI"),
              ElementsAre(MarkerStem{.stem = "lasi"}, MarkerStem{.side = 'l', .stem = "asi", .sure = false}));
  // An ending is tried too: "HEEL" may be the heel of either foot or a left "HEE".
  EXPECT_THAT(read_marker_name("HEEL"),
              ElementsAre(MarkerStem{.stem = "heel"},
                          MarkerStem{.side = 'l', .stem = "hee", .sure = false, .behind = true}));
  EXPECT_THAT(read_marker_name("ThighR2"),
              ElementsAre(MarkerStem{.stem = "thighr2"},
                          MarkerStem{.side = 'r', .stem = "thigh2", .sure = false, .behind = true}));
}

TEST(MarkerName, ShortAndEmptyNamesHaveNoEnding) {
  EXPECT_THAT(read_marker_name("C7"), ElementsAre(MarkerStem{.stem = "c7"}));
  EXPECT_THAT(read_marker_name("ear"), ElementsAre(MarkerStem{.stem = "ear"}));
  EXPECT_THAT(read_marker_name("L"), ElementsAre(MarkerStem{.stem = "l"}));
  EXPECT_THAT(read_marker_name("*_:"), IsEmpty());
  EXPECT_THAT(read_marker_name(""), IsEmpty());
}

TEST(MarkerName, OneSpelling) {
  EXPECT_EQ(plain_marker_name("Right Heel"), "rheel");
  EXPECT_EQ(plain_marker_name("RHeel"), "rheel");
  EXPECT_EQ(plain_marker_name("Bob:heel_R"), "rheel");
  EXPECT_EQ(plain_marker_name("V.Sacral"), "vsacral");
  EXPECT_EQ(plain_marker_name("#"), "");
  EXPECT_NE(plain_marker_name("Left Heel"), plain_marker_name("Right Heel"));
}

}  // namespace
}  // namespace kinemark::data
