// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/motion/used_markers.h"

#include <gtest/gtest.h>

#include <Eigen/Core>

namespace kinemark::workflow {
namespace {

/// Each coordinate says where a sample is from: frame, marker, 0.5.
data::Trajectories numbered(std::vector<std::string> names, std::int64_t frames) {
  auto recorded = data::Trajectories::all_missing(std::move(names), {.rate_hz = 100.0, .frames = frames});
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::int64_t m = 0; m < recorded.markers(); ++m) {
      recorded.x(f, m) = Eigen::Vector3d(static_cast<double>(f), static_cast<double>(m), 0.5);
      recorded.state[recorded.index(f, m)] = data::SampleState::measured;
    }
  return recorded;
}

TEST(SelectMarkers, KeepsPositionsAndStatesUnderTheNewNames) {
  auto recorded = numbered({"A", "B", "C"}, 5);
  recorded.set_missing(2, 1);
  const std::vector<std::int64_t> from{2, 1};
  const TimeBase time{.rate_hz = 50.0, .t0_s = 0.02, .frames = 3};
  const auto selected = select_markers(recorded, from, {"hand", "wrist"}, 1, time);
  EXPECT_EQ(selected.names, (std::vector<std::string>{"hand", "wrist"}));
  EXPECT_EQ(selected.time, time);
  for (std::int64_t f = 0; f < 3; ++f) {
    EXPECT_EQ(selected.x(f, 0).x(), static_cast<double>(1 + f));
    EXPECT_EQ(selected.x(f, 0).y(), 2.0);
    EXPECT_EQ(selected.present(f, 1), f != 1) << "the gap of B in frame 2";
  }
  EXPECT_TRUE(selected.validate());
  EXPECT_EQ(select_markers(recorded, {}, {}, 0, time).markers(), 0);
}

TEST(UsedMarkers, AreThoseThatWereSolved) {
  auto recorded = numbered({"S:A", "x", "S:B"}, 6);
  recorded.set_missing(3, 2);
  data::JointMotion motion;
  motion.markers = {"A", "B"};
  motion.time = {.rate_hz = 100.0, .t0_s = 0.01, .frames = 4};
  motion.marker_state.assign(8, data::SampleState::measured);
  motion.marker_state[6] = data::SampleState::rejected;
  const data::Finding swap{.kind = data::FindingKind::label_swap, .subject = "A", .partner = "B"};
  auto listed = swap, span = swap;
  listed.frames = {0, 2};
  listed.first_frame = 0, listed.last_frame = 2;
  span.first_frame = 0, span.last_frame = 1;
  data::MarkerFit fit{.markers = {{.name = "A", .name_in_data = "S:A"}, {.name = "B", .name_in_data = "S:B"}},
                      .findings = {listed}};
  fit.first_frame = 1;
  const auto markers = solved_markers(recorded, fit, motion);
  EXPECT_EQ(markers.names, (std::vector<std::string>{"A", "B"}));
  EXPECT_EQ(markers.frames(), 4);
  EXPECT_EQ(markers.x(0, 0).y(), 2.0) << "frame 1 of the recording, B's label";
  EXPECT_EQ(markers.x(0, 1).y(), 0.0);
  EXPECT_EQ(markers.x(1, 0).y(), 0.0) << "as recorded";
  EXPECT_FALSE(markers.present(2, 0)) << "B was not seen there, and A carried its label";
  EXPECT_EQ(markers.x(2, 1).y(), 0.0);
  EXPECT_EQ(markers.state[markers.index(3, 0)], data::SampleState::rejected);
  fit.findings = {span};
  const auto other = solved_markers(recorded, fit, motion);
  EXPECT_EQ(other.x(1, 0).y(), 2.0);
  EXPECT_EQ(other.x(3, 1).y(), 2.0) << "behind the span";
  fit.findings[0].partner = "nobody";
  EXPECT_EQ(solved_markers(recorded, fit, motion).x(0, 0).y(), 0.0) << "no such marker";
}

}  // namespace
}  // namespace kinemark::workflow
