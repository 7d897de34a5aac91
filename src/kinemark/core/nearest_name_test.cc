// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/nearest_name.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

const std::vector<std::string> kCommands = {"simulate", "calibrate", "clean", "joints", "scale",
                                            "ik",       "track",     "info",  "convert"};

TEST(EditDistance, CountsWhatWasTypedWrong) {
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("scale", "scale"), 0U);
  EXPECT_EQ(edit_distance("sacle", "scale"), 1U) << "neighbours exchanged";
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
  EXPECT_EQ(edit_distance("ca", "abc"), 3U) << "no place is touched twice";
}

TEST(EditDistance, IsTheSameBothWays) {
  for (const auto& a : kCommands)
    for (const auto& b : kCommands) EXPECT_EQ(edit_distance(a, b), edit_distance(b, a));
}

TEST(NearestNames, FindsWhatWasMeant) {
  EXPECT_THAT(nearest_names("joins", kCommands), ElementsAre("joints"));
  EXPECT_THAT(nearest_names("Sacle", kCommands), ElementsAre("scale"));
  EXPECT_THAT(nearest_names("IK", kCommands), ElementsAre("ik"));
  EXPECT_THAT(nearest_names("calib", kCommands), ElementsAre("calibrate"));
  EXPECT_THAT(nearest_names("tracking", kCommands), ElementsAre("track"));
}

TEST(NearestNames, DashesAreLikeUnderscores) {
  const std::vector<std::string> options = {"max-rms", "max-offset"};
  EXPECT_THAT(nearest_names("max_rms", options), ElementsAre("max-rms"));
}

TEST(NearestNames, SaysNothingOfWhatIsFarFromAll) {
  EXPECT_THAT(nearest_names("banana", kCommands), IsEmpty());
  EXPECT_THAT(nearest_names("x", kCommands), IsEmpty());
  EXPECT_THAT(nearest_names("", kCommands), IsEmpty());
  EXPECT_THAT(nearest_names(std::string(100'000, 'a'), kCommands), IsEmpty());
}

TEST(NearestNames, GivesTheNearestFirstAndNoMoreThanAsked) {
  const std::vector<std::string> names = {"rate", "gate", "date", "data"};
  EXPECT_THAT(nearest_names("date", names, 2), ElementsAre("date", "rate"));
}

}  // namespace
}  // namespace kinemark
