// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/joints_page.h"

#include <gmock/gmock.h>

namespace kinemark::pipeline {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A joint that one of four frames does not place.
JointsOutcome outcome_of_a_knee() {
  JointsOutcome out;
  out.used = data::Trajectories::all_missing({"A"}, {.rate_hz = 50.0, .t0_s = 0.0, .frames = 4});
  auto& s = out.skeleton;
  s.time = {.rate_hz = 50.0, .t0_s = 0.0, .frames = 4};
  s.markers = {"A"};
  s.segments.resize(2);
  s.segments[0].name = "thigh";
  s.segments[1].name = "shank";
  s.joints.resize(1);
  s.joints[0].name = "knee";
  s.joints[0].child_segment = 1;
  s.allocate_centres();
  for (std::size_t f = 0; f < 3; ++f) {
    s.state[f] = data::CentreState::determined;
    for (std::size_t k = 0; k < 3; ++k) s.centre_in_world[3 * f + k] = 0.5;
  }
  return out;
}

TEST(JointsPage, FoldsWhatStandsOut) {
  JointsJob job;
  job.input = "folder/walk.c3d";
  auto outcome = outcome_of_a_knee();
  const auto page = joints_page(job, outcome, 1);
  EXPECT_THAT(page, HasSubstr(R"("trial":"walk.c3d")"));
  EXPECT_THAT(page, HasSubstr(R"("verdict":"good")"));
  EXPECT_THAT(page, HasSubstr("1 joint not placed in some frames"));
  EXPECT_THAT(page, HasSubstr("knee: not placed in 1 of 4 frames."));
  EXPECT_THAT(page, Not(HasSubstr("left out as no body's")));
  outcome.skeleton.warnings = {"The fit is doubtful."};
  const auto doubtful = joints_page(job, outcome, 1);
  EXPECT_THAT(doubtful, HasSubstr(R"("verdict":"attention")"));
  EXPECT_THAT(doubtful, HasSubstr("1 doubt about the fit"));
}

TEST(JointsPage, SaysNothingOfJointsThatAreAlwaysPlaced) {
  auto outcome = outcome_of_a_knee();
  outcome.skeleton.state[3] = data::CentreState::bridged;
  EXPECT_THAT(joints_page({}, outcome, 1), Not(HasSubstr("not placed in some frames")));
}

TEST(JointsPage, CountsJointsAndNotWhatIsSaidOfAllOfThem) {
  auto outcome = outcome_of_a_knee();
  EXPECT_THAT(joints_page({}, outcome, 1), Not(HasSubstr("not determined")));
  for (const char* name : {"determined", "determined", "any_joint"})
    outcome.gates.push_back({.name = name, .passed = false, .unit = "joints", .sentence = "Not determined."});
  const auto page = joints_page({}, outcome, 1);
  EXPECT_THAT(page, HasSubstr("2 joints not determined"));
  EXPECT_THAT(page, HasSubstr("1 quality check missed"));
}

}  // namespace
}  // namespace kinemark::pipeline
