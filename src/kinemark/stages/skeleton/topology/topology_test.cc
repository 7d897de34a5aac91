// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/topology.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

using testing::make_chain;
using testing::Rotations;

/// Segments and joints exactly as the chain was made.
::testing::AssertionResult right(const Topology& found, const data::SegmentLayout& truth) {
  if (found.layout.segments.size() != truth.segments.size())
    return ::testing::AssertionFailure() << found.layout.segments.size() << " segments";
  for (std::size_t s = 0; s < truth.segments.size(); ++s)
    if (found.layout.segments[s].markers != truth.segments[s].markers)
      return ::testing::AssertionFailure() << "markers of segment " << s;
  if (found.layout.joints.size() != truth.joints.size()) return ::testing::AssertionFailure() << "joints";
  for (std::size_t j = 0; j < truth.joints.size(); ++j)
    if (found.layout.joints[j].parent != truth.joints[j].parent ||
        found.layout.joints[j].child != truth.joints[j].child)
      return ::testing::AssertionFailure() << "joint " << j;
  return ::testing::AssertionSuccess();
}

TEST(Topology, RandomChainsThroughNoiseAndGaps) {
  for (const std::vector<double>& lengths :
       {std::vector<double>{0.15, 0.16}, std::vector<double>{0.12, 0.15, 0.16, 0.08}})
    for (const double noise : {0.0005, 0.005})
      for (const double missing : {0.0, 0.4}) {
        const auto chain = make_chain({.frames = 400,
                                       .lengths_m = lengths,
                                       .per_segment = lengths.size() == 2 ? 3 : 4,
                                       .noise_sd_m = noise,
                                       .missing = missing,
                                       .seed = 7});
        const auto found = find_topology(chain.markers);
        ASSERT_TRUE(found) << found.error().message;
        EXPECT_TRUE(right(*found, chain.layout)) << noise << " " << missing;
        EXPECT_TRUE(found->warnings.empty()) << found->warnings.front();
        EXPECT_NEAR(found->noise_sd_m / noise, 1.0, 0.15);
        EXPECT_EQ(found->soft_sd_m, 0.0);
        for (const auto& marker : found->markers) EXPECT_GT(marker.nats, 20.0);
        for (const auto& joint : found->joints) EXPECT_GT(joint.margin, 2.0);
        EXPECT_TRUE(found->layout.validate(chain.markers.markers()));
      }
}

TEST(Topology, OneMarkerMovesAboutASolidSegment) {
  auto chain = make_chain(
      {.lengths_m = {0.12, 0.15, 0.16}, .per_segment = 4, .stagger_m = 0.03, .noise_sd_m = 0.0005});
  // The last segment keeps a single marker: its sphere about the second joint determines its segment.
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f)
    for (const int m : {9, 10, 11}) chain.markers.set_missing(f, m);
  const auto found = find_topology(chain.markers);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->layout.segments.size(), 3U);
  ASSERT_EQ(found->layout.joints.size(), 2U);
  EXPECT_EQ(found->layout.joints[1].parent, 1);
  EXPECT_EQ(found->layout.joints[1].child, 2);
  EXPECT_EQ(found->left_out, (std::vector<int>{9, 10, 11}));
  ASSERT_FALSE(found->warnings.empty());
}

TEST(Topology, NothingMovesIsOneSegmentAndSaidSo) {
  const auto chain =
      make_chain({.per_segment = 4, .rotations = Rotations::hinge, .range_rad = 0.0, .noise_sd_m = 0.001});
  const auto found = find_topology(chain.markers);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->layout.segments.size(), 1U);
  ASSERT_EQ(found->warnings.size(), 1U);
  EXPECT_NE(found->warnings[0].find("no joint can be found"), std::string::npos);
}

TEST(Topology, PairsNeverSeenTogetherAreReported) {
  auto chain = make_chain({.per_segment = 5, .noise_sd_m = 0.0005});
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f) chain.markers.set_missing(f, f % 2 == 0 ? 0 : 1);
  const auto found = find_topology(chain.markers);
  ASSERT_TRUE(found);
  EXPECT_TRUE(right(*found, chain.layout));
  ASSERT_EQ(found->never_together.size(), 1U);
  EXPECT_EQ(found->never_together[0], (std::pair{0, 1}));
  EXPECT_NE(found->warnings[0].find("1 pairs of markers were hardly ever seen together: s0m0-s0m1."),
            std::string::npos)
      << found->warnings[0];
}

TEST(Topology, GroupsNeverSeenTogetherStayApart) {
  auto chain = make_chain({.per_segment = 4});
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f)
    for (const int m : chain.layout.segments[f % 2 == 0 ? 0 : 1].markers) chain.markers.set_missing(f, m);
  const auto found = find_topology(chain.markers);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->layout.segments.size(), 2U);
  EXPECT_TRUE(found->layout.joints.empty());
  EXPECT_NE(found->warnings.back().find("2 groups that were never seen together, beginning with: segment1"),
            std::string::npos)
      << found->warnings.back();
}

TEST(Topology, AMarkerThatMovesOnItsSegmentIsSaidToDoSo) {
  auto chain = make_chain({.per_segment = 6, .stagger_m = 0.03, .noise_sd_m = 0.001});
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f) {
    const Eigen::Vector3d along = (chain.markers.x(f, 3) - chain.markers.x(f, 0)).normalized();
    chain.markers.x(f, 3) += 0.005 * std::sin(0.1 * static_cast<double>(f)) * along;
  }
  const auto found = find_topology(chain.markers);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->markers[3].doubtful);
  EXPECT_GT(found->markers[3].nats, 6.0);
  ASSERT_FALSE(found->warnings.empty());
  EXPECT_NE(found->warnings[0].find("it moves against others there"), std::string::npos)
      << found->warnings[0];
  EXPECT_EQ(found->warnings[0].find("fits nearly as well"), std::string::npos) << found->warnings[0];
}

TEST(Topology, AMarkerOnTheJointIsDoubtful) {
  auto chain = make_chain({.per_segment = 4, .stagger_m = 0.03, .noise_sd_m = 0.001});
  // Marker 3 goes to the joint itself, where it belongs to both.
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f) chain.markers.x(f, 3) = chain.centres[0].col(f);
  const auto found = find_topology(chain.markers);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->markers[3].doubtful);
  EXPECT_EQ(found->layout.segments.size(), 2U);
  for (const int m : {0, 1, 2, 4, 5, 6, 7})
    EXPECT_FALSE(found->markers[static_cast<std::size_t>(m)].doubtful) << m;
  EXPECT_NE(found->warnings[0].find("Segment of 1 of 8 markers doubtful: 's0m3'"), std::string::npos)
      << found->warnings[0];
  EXPECT_NE(found->warnings[0].find("fits nearly as well"), std::string::npos) << found->warnings[0];
  EXPECT_EQ(found->warnings[0].find("moves against"), std::string::npos) << found->warnings[0];
}

TEST(Topology, BodiesAboutOnePointHaveAnotherTreeThatDoesAsWell) {
  // The middle segment is a ring about the point in which all three meet.
  const auto chain =
      make_chain({.lengths_m = {0.15, 1e-6, 0.16}, .per_segment = 4, .stagger_m = 0.05, .noise_sd_m = 0.001});
  const auto found = find_topology(chain.markers);
  ASSERT_TRUE(found);
  ASSERT_EQ(found->layout.segments.size(), 3U);
  ASSERT_EQ(found->joints.size(), 2U);
  EXPECT_TRUE(found->joints[0].doubtful || found->joints[1].doubtful);
  ASSERT_FALSE(found->warnings.empty());
  EXPECT_NE(
      found->warnings.back().find("Another joint would do nearly as well (times worse) in place of: segment"),
      std::string::npos)
      << found->warnings.back();
}

TEST(Topology, LongRecordingsAreDrawnFrom) {
  const auto chain = make_chain({.frames = 3000, .noise_sd_m = 0.001});
  const auto found = find_topology(chain.markers, {.most_frames = 300});
  ASSERT_TRUE(found);
  EXPECT_TRUE(right(*found, chain.layout));
}

TEST(Topology, OptionsAndInputAreChecked) {
  const auto chain = make_chain({.frames = 30});
  EXPECT_EQ(find_topology(chain.markers, {.noise_sd_m = -1.0}).error().code, Code::usage);
  EXPECT_EQ(find_topology(chain.markers, {.least_motion_m = 0.0}).error().code, Code::usage);
  EXPECT_EQ(find_topology(chain.markers, {.least_frames = 2}).error().code, Code::usage);
  EXPECT_EQ(find_topology(chain.markers, {.most_frames = 10}).error().code, Code::usage);
  EXPECT_EQ(find_topology(chain.markers, {.doubtful_margin = 0.5}).error().code, Code::usage);
  TopologyOptions options;
  options.mask.assign(5, 1);
  EXPECT_EQ(find_topology(chain.markers, options).error().code, Code::usage);
  options.mask.assign(chain.markers.state.size(), 0);
  const auto blind = find_topology(chain.markers, options);
  ASSERT_FALSE(blind);
  EXPECT_EQ(blind.error().code, Code::bad_input);
  EXPECT_NE(blind.error().message.find("0 of 6 markers"), std::string::npos) << blind.error().message;
}

// Markers in another order: the same sets of markers, whatever their numbers.
TEST(Topology, TheOrderOfMarkersChangesNumbersAlone) {
  const auto chain = make_chain({.lengths_m = {0.12, 0.15, 0.16}, .per_segment = 4, .noise_sd_m = 0.001});
  const std::int64_t M = chain.markers.markers();
  auto mixed = chain.markers;
  std::vector<int> from(static_cast<std::size_t>(M));
  for (std::int64_t m = 0; m < M; ++m) from[static_cast<std::size_t>(m)] = static_cast<int>((5 * m + 3) % M);
  for (std::int64_t m = 0; m < M; ++m) {
    const int k = from[static_cast<std::size_t>(m)];
    mixed.names[static_cast<std::size_t>(m)] = chain.markers.names[static_cast<std::size_t>(k)];
    for (std::int64_t f = 0; f < mixed.frames(); ++f) mixed.x(f, m) = chain.markers.x(f, k);
  }
  const auto found = find_topology(mixed).value();
  ASSERT_EQ(found.layout.segments.size(), 3U);
  ASSERT_EQ(found.layout.joints.size(), 2U);
  for (const auto& segment : found.layout.segments) {
    ASSERT_EQ(segment.markers.size(), 4U);
    for (const int m : segment.markers)
      EXPECT_EQ(from[static_cast<std::size_t>(m)] / 4,
                from[static_cast<std::size_t>(segment.markers[0])] / 4);
  }
  // The middle segment has both joints.
  for (const auto& joint : found.layout.joints) {
    const auto bone = [&](int s) {
      const int first = found.layout.segments[static_cast<std::size_t>(s)].markers[0];
      return from[static_cast<std::size_t>(first)] / 4;
    };
    EXPECT_EQ(std::abs(bone(joint.parent) - bone(joint.child)), 1);
  }
}

TEST(Topology, TurningAndShiftingTheRoomChangesNothing) {
  const auto chain = make_chain({.lengths_m = {0.15, 0.16}, .per_segment = 4, .noise_sd_m = 0.001});
  auto moved = chain.markers;
  const Eigen::Matrix3d R{{0.0, -1.0, 0.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
  for (std::int64_t f = 0; f < moved.frames(); ++f)
    for (std::int64_t m = 0; m < moved.markers(); ++m)
      moved.x(f, m) = R * chain.markers.x(f, m) + Eigen::Vector3d(5.0, -3.0, 1.0);
  const auto a = find_topology(chain.markers).value(), b = find_topology(moved).value();
  EXPECT_TRUE(right(b, a.layout));
  EXPECT_NEAR(a.noise_sd_m, b.noise_sd_m, 1e-9);
  for (std::size_t m = 0; m < a.markers.size(); ++m) EXPECT_NEAR(a.markers[m].nats, b.markers[m].nats, 1e-5);
}

// A marker is lost, a marker is not a number in one frame, a marker stands alone: the others keep their
// places.
TEST(Topology, WhatIsNeverSeenIsOnNoSegment) {
  auto chain = make_chain({.per_segment = 4, .noise_sd_m = 0.001});
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f)
    if (f >= 5) chain.markers.set_missing(f, 6);
  const auto found = find_topology(chain.markers).value();
  EXPECT_EQ(found.left_out, std::vector<int>{6});
  ASSERT_FALSE(found.warnings.empty());
  EXPECT_NE(found.warnings.back().find("1 markers were hardly ever seen and are on no segment: s1m2."),
            std::string::npos)
      << found.warnings.back();
  ASSERT_EQ(found.layout.segments.size(), 2U);
  EXPECT_EQ(found.layout.segments[0].markers, (std::vector<int>{0, 1, 2, 3}));
  EXPECT_EQ(found.layout.segments[1].markers, (std::vector<int>{4, 5, 7}));
}

}  // namespace
}  // namespace kinemark::skeleton
