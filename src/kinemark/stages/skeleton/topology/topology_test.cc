// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/topology.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

using testing::make_chain;
using testing::Turns;

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
  // The last segment keeps a single marker: its sphere about the second joint tells where it belongs.
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
      make_chain({.per_segment = 4, .turns = Turns::hinge, .range_rad = 0.0, .noise_sd_m = 0.001});
  const auto found = find_topology(chain.markers);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->layout.segments.size(), 1U);
  ASSERT_EQ(found->warnings.size(), 1U);
  EXPECT_NE(found->warnings[0].find("no joint can be seen"), std::string::npos);
}

TEST(Topology, PairsNeverSeenTogetherAreReported) {
  auto chain = make_chain({.per_segment = 5, .noise_sd_m = 0.0005});
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f) chain.markers.set_missing(f, f % 2 == 0 ? 0 : 1);
  const auto found = find_topology(chain.markers);
  ASSERT_TRUE(found);
  EXPECT_TRUE(right(*found, chain.layout));
  ASSERT_EQ(found->never_together.size(), 1U);
  EXPECT_EQ(found->never_together[0], (std::pair{0, 1}));
  EXPECT_NE(found->warnings[0].find("s0m0-s0m1"), std::string::npos) << found->warnings[0];
}

TEST(Topology, GroupsNeverSeenTogetherStayApart) {
  auto chain = make_chain({.per_segment = 4});
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f)
    for (const int m : chain.layout.segments[f % 2 == 0 ? 0 : 1].markers) chain.markers.set_missing(f, m);
  const auto found = find_topology(chain.markers);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->layout.segments.size(), 2U);
  EXPECT_TRUE(found->layout.joints.empty());
  EXPECT_NE(found->warnings.back().find("2 groups"), std::string::npos);
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
  EXPECT_NE(found->warnings[0].find("'s0m3'"), std::string::npos) << found->warnings[0];
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

}  // namespace
}  // namespace kinemark::skeleton
