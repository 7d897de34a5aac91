// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/segmentation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "kinemark/core/random.h"
#include "kinemark/stages/skeleton/functional/testing/random_chain.h"

namespace kinemark::skeleton {
namespace {

using testing::Rotations;
using testing::TestChain;

/// A pelvis, a left thigh and a left shank about balls, four markers each.
TestChain leg(int per_segment = 4, std::uint64_t seed = 3) {
  auto chain = testing::make_chain({.lengths_m = {0.15, 0.2, 0.2},
                                    .per_segment = per_segment,
                                    .stagger_m = 0.04,
                                    .rotations = Rotations::cone,
                                    .range_rad = 1.2,
                                    .noise_sd_m = 0.0005,
                                    .seed = seed});
  const std::vector<std::vector<std::string>> names{
      {"LASI", "RASI", "LPSI", "RPSI"}, {"LTH1", "LTH2", "LTH3", "LTH4"}, {"LSK1", "LSK2", "LSK3", "LSK4"}};
  for (std::size_t s = 0; s < 3; ++s)
    for (std::size_t k = 0; k < chain.layout.segments[s].markers.size(); ++k)
      chain.markers.names[static_cast<std::size_t>(chain.layout.segments[s].markers[k])] = names[s][k];
  return chain;
}

Segmentation by_names(const TestChain& chain) {
  auto found = segment_by_names(chain.markers);
  EXPECT_TRUE(found && *found);
  return found && *found ? **found : Segmentation();
}

void number_names(data::Trajectories& markers) {
  for (std::size_t m = 0; m < markers.names.size(); ++m) markers.names[m] = "M" + std::to_string(m + 1);
}

TEST(SegmentationByNames, JointsLieBetweenNeighbours) {
  const auto found = by_names(leg());
  EXPECT_TRUE(found.from_names);
  ASSERT_EQ(found.layout.joints.size(), 2U);
  EXPECT_EQ(found.layout.joints[0].name, "hip_l");
  EXPECT_EQ(found.layout.joints[1].name, "knee_l");
  EXPECT_EQ(found.layout.segments[0].name, "pelvis");
  EXPECT_EQ(found.layout.segments[0].markers, (std::vector<int>{0, 1, 2, 3}));
  ASSERT_EQ(found.spread_m.size(), 2U);
  for (const double spread : found.spread_m) EXPECT_LT(spread, 0.005);
  EXPECT_TRUE(found.aside.empty());
  EXPECT_TRUE(found.layout.validate(12));
}

TEST(SegmentationByNames, NamesOfNoSetAreNoneOfItsBusiness) {
  auto chain = leg();
  number_names(chain.markers);
  const auto found = segment_by_names(chain.markers);
  ASSERT_TRUE(found);
  EXPECT_FALSE(*found);
}

TEST(SegmentationByNames, TwoMarkersAreNoBody) {
  auto chain = leg();
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f)
    for (const int m : {6, 7}) chain.markers.set_missing(f, m);
  const auto found = by_names(chain);
  EXPECT_TRUE(found.layout.joints.empty());
  ASSERT_EQ(found.joints.size(), 2U);
  for (const auto& joint : found.joints) {
    EXPECT_FALSE(joint.known);
    EXPECT_NE(joint.reason.find("thigh_l has 2 markers (LTH1, LTH2)"), std::string::npos) << joint.reason;
    EXPECT_NE(joint.sentence(chain.markers.names).find("Not determined: joint '" + joint.name),
              std::string::npos);
  }
}

TEST(SegmentationByNames, AForeignMarkerIsPutAsideAndAModelsPointsLeftOut) {
  auto chain = leg();
  // The thigh's last marker lies on the floor.
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f)
    chain.markers.x(f, 7) = Eigen::Vector3d(0.1, -0.2, 0.0);
  const auto found = by_names(chain);
  ASSERT_EQ(found.aside.size(), 1U);
  EXPECT_EQ(found.aside[0].marker, 7);
  EXPECT_EQ(found.aside[0].segment, "thigh_l");
  EXPECT_GT(found.aside[0].distance_sd_m, 0.015);
  ASSERT_EQ(found.layout.joints.size(), 2U);
  chain = leg();
  chain.markers.names[3] = "LHJC";
  const auto without = by_names(chain);
  EXPECT_EQ(without.model_outputs, (std::vector<int>{3}));
  EXPECT_EQ(without.layout.segments[0].markers, (std::vector<int>{0, 1, 2}));
}

TEST(SegmentationByNames, MarkersOverAJointAreOnNeitherSide) {
  auto chain = leg();
  chain.markers.names[7] = "LKNE";
  const auto found = by_names(chain);
  EXPECT_EQ(found.over_joints, (std::vector<int>{7}));
  for (const auto& segment : found.layout.segments) EXPECT_EQ(std::ranges::count(segment.markers, 7), 0);
  // An epicondyle is one where the segment has a pose without it, and joins it where not.
  chain.markers.names[7] = "LLFE";
  EXPECT_EQ(by_names(chain).over_joints, (std::vector<int>{7}));
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f) chain.markers.set_missing(f, 6);
  const auto few = by_names(chain);
  EXPECT_TRUE(few.over_joints.empty());
  EXPECT_EQ(few.layout.segments[1].markers, (std::vector<int>{4, 5, 7}));
}

TEST(SegmentationByNames, AJointThatHardlyTurnsOrTearsIsNotKnown) {
  auto still = leg();
  const auto moving = still.markers;
  for (std::int64_t f = 0; f < still.markers.frames(); ++f)
    for (int m = 0; m < 12; ++m) still.markers.x(f, m) = moving.x(0, m);
  for (const auto& joint : by_names(still).joints)
    EXPECT_NE(joint.reason.find("hardly turn"), std::string::npos) << joint.reason;
  auto torn = leg();
  Random random(5, 1);
  for (std::int64_t f = 0; f < torn.markers.frames(); ++f) {
    const Eigen::Vector3d by(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05),
                             random.uniform(-0.05, 0.05));
    for (int m = 8; m < 12; ++m) torn.markers.x(f, m) += by;
  }
  const auto found = by_names(torn);
  ASSERT_EQ(found.layout.joints.size(), 1U);
  EXPECT_EQ(found.layout.joints[0].name, "hip_l");
  EXPECT_NE(found.joints[1].reason.find("mm apart"), std::string::npos) << found.joints[1].reason;
}

/// Whether a joint that was looked for is not known for a reason with these words.
bool says(const Segmentation& found, const std::string& words) {
  return std::ranges::any_of(
      found.joints, [&](const auto& joint) { return joint.reason.find(words) != std::string::npos; });
}

TEST(SegmentationByNames, NothingIsHeldAgainstALegThatIsWhole) {
  const auto found = by_names(leg());
  for (const auto& joint : found.joints) EXPECT_TRUE(joint.known) << joint.reason;
  EXPECT_FALSE(says(found, "and a pose needs three that are not in a line"));
  EXPECT_FALSE(says(found, "lie nearly in a line, so that its turn is not known"));
  EXPECT_FALSE(says(found, "the two were hardly seen together"));
  EXPECT_FALSE(says(found, "the two hardly turn against each other (SD"));
  EXPECT_FALSE(says(found, "the two place it"));
  EXPECT_FALSE(says(found, "mm from the markers"));
  EXPECT_FALSE(says(found, "halves of the recording, and the same without one marker, place it"));
}

TEST(SegmentationByNames, FewMarkersAndLinesHaveNoPose) {
  auto chain = leg();
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f)
    for (const int m : {6, 7}) chain.markers.set_missing(f, m);
  const auto two = by_names(chain);
  EXPECT_TRUE(says(two, "thigh_l has 2 markers (LTH1, LTH2), and a pose needs three that are not in a line"));
  chain = leg();
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f)
    for (const int m : {6, 7}) {
      const Eigen::Vector3d along = chain.markers.x(f, 5) - chain.markers.x(f, 4);
      chain.markers.x(f, m) = chain.markers.x(f, 4) + (m == 6 ? 1.5 : 2.0) * along;
    }
  const auto line = by_names(chain);
  EXPECT_TRUE(line.layout.joints.empty());
  EXPECT_TRUE(says(line,
                   "the markers of thigh_l (LTH1, LTH2, LTH3, LTH4) lie nearly in a line, so that its "
                   "turn is not known"));
}

TEST(SegmentationByNames, SegmentsThatWereNeverSeenTogetherHaveNoJoint) {
  auto chain = leg();
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f)
    for (int k = 0; k < 4; ++k) chain.markers.set_missing(f, f < chain.markers.frames() / 2 ? k : 4 + k);
  const auto found = by_names(chain);
  ASSERT_EQ(found.joints.size(), 2U);
  EXPECT_TRUE(says(found, "the two were hardly seen together"));
  for (const auto& joint : found.joints) EXPECT_EQ(joint.known, joint.name == "knee_l") << joint.reason;
}

TEST(SegmentationByNames, AStillJointSaysHowMuchItTurns) {
  auto still = leg();
  const auto moving = still.markers;
  for (std::int64_t f = 0; f < still.markers.frames(); ++f)
    for (int m = 0; m < 8; ++m) still.markers.x(f, m) = moving.x(0, m);
  const auto found = by_names(still);
  EXPECT_TRUE(says(found, "the two hardly turn against each other (SD 0.0 deg, 8 are needed)"));
}

TEST(SegmentationByNames, AJointIsNotTornNorFarFromItsMarkers) {
  auto torn = leg();
  Random random(9, 1);
  for (std::int64_t f = 0; f < torn.markers.frames(); ++f) {
    const Eigen::Vector3d by(random.uniform(-0.05, 0.05), random.uniform(-0.05, 0.05), 0.0);
    for (int m = 8; m < 12; ++m) torn.markers.x(f, m) += by;
  }
  EXPECT_TRUE(says(by_names(torn), "the two place it"));
  auto far = testing::make_chain({.lengths_m = {1.5, 0.2},
                                  .per_segment = 4,
                                  .stagger_m = 0.04,
                                  .rotations = Rotations::cone,
                                  .range_rad = 1.2,
                                  .noise_sd_m = 0.0002});
  far.markers.names = {"LTH1", "LTH2", "LTH3", "LTH4", "LSK1", "LSK2", "LSK3", "LSK4"};
  const auto found = by_names(far);
  EXPECT_TRUE(says(found, "it would lie 750 mm from the markers"));
}

TEST(SegmentationByNames, RivalsOfAJointAreHalvesAndMarkersLeftOut) {
  const auto chain = leg();
  SegmentationOptions strict;
  strict.most_spread_m = 1e-5;
  const auto found = segment_by_names(chain.markers, strict);
  ASSERT_TRUE(found && *found);
  EXPECT_TRUE((*found)->layout.joints.empty());
  EXPECT_TRUE(says(**found, "halves of the recording, and the same without one marker, place it"));
  for (const auto& joint : (*found)->joints) EXPECT_GT(joint.spread_m, 1e-5);
}

TEST(SegmentationByNames, BothSidesAndTheArmByTheThorax) {
  // The upper arm meets the thorax where no scapula has a pose.
  auto chain = leg();
  const std::vector<std::string> names{"C7",   "T10",  "CLAV", "STRN", "RUA1", "RUA2",
                                       "RUA3", "RUA4", "RFA1", "RFA2", "RFA3", "RFA4"};
  chain.markers.names = names;
  const auto found = by_names(chain);
  ASSERT_EQ(found.layout.joints.size(), 2U);
  EXPECT_EQ(found.layout.joints[0].name, "shoulder_r");
  EXPECT_EQ(found.joints[0].parent_name, "thorax");
  EXPECT_EQ(found.layout.joints[1].name, "elbow_r");
  // Neighbours alone have joints: a thorax and a forearm have none.
  for (int m = 4; m < 8; ++m) chain.markers.names[static_cast<std::size_t>(m)] = "X" + std::to_string(m);
  const auto none = segment_by_names(chain.markers);
  ASSERT_TRUE(none);
  EXPECT_FALSE(*none);
}

TEST(SegmentationByNames, HalfOfTheMarkersDecideWhetherNamesCount) {
  auto chain = leg();
  const auto all = chain.markers.names;
  for (std::size_t m = 0; m < 4; ++m) chain.markers.names[2 * m + 1] = "U" + std::to_string(m);
  const auto most = segment_by_names(chain.markers);
  ASSERT_TRUE(most && *most) << "8 of 12";
  EXPECT_EQ((*most)->unplaced.size(), 4U);
  chain.markers.names = all;
  for (std::size_t m = 0; m < 7; ++m) chain.markers.names[m + 1] = "U" + std::to_string(m);
  const auto few = segment_by_names(chain.markers);
  ASSERT_TRUE(few);
  EXPECT_FALSE(*few) << "5 of 12";
}

Segmentation by_data(const data::Trajectories& markers) {
  auto found = segment_by_data(markers, find_topology(markers).value());
  EXPECT_TRUE(found);
  return found ? *found : Segmentation();
}

TEST(SegmentationByData, ARigidChainIsKnown) {
  for (const double noise : {0.0005, 0.002}) {
    auto chain = testing::make_chain({.lengths_m = {0.12, 0.15, 0.16},
                                      .per_segment = 4,
                                      .stagger_m = 0.03,
                                      .noise_sd_m = noise,
                                      .missing = 0.1,
                                      .seed = 11});
    const auto found = by_data(chain.markers);
    EXPECT_FALSE(found.from_names);
    ASSERT_EQ(found.layout.joints.size(), 2U) << noise;
    for (std::size_t s = 0; s < 3; ++s)
      EXPECT_EQ(found.layout.segments[s].markers, chain.layout.segments[s].markers);
    EXPECT_TRUE(found.layout.validate(chain.markers.markers()));
    for (const auto& joint : found.joints) {
      EXPECT_TRUE(joint.known) << joint.reason;
      EXPECT_GT(joint.weight, 0.5);
      EXPECT_LT(joint.spread_m, 0.005);
    }
  }
}

TEST(SegmentationByData, TwoMarkersAndLinesCarryNoJoint) {
  // Two markers a segment, and four in a line.
  for (const auto& [per_segment, stagger] : {std::pair{2, 0.03}, {4, 0.0}}) {
    const auto chain = testing::make_chain({.lengths_m = {0.12, 0.15, 0.16},
                                            .per_segment = per_segment,
                                            .stagger_m = stagger,
                                            .noise_sd_m = 0.0005,
                                            .seed = 4});
    const auto found = by_data(chain.markers);
    EXPECT_TRUE(found.layout.joints.empty()) << per_segment;
    EXPECT_EQ(found.unplaced.size(), static_cast<std::size_t>(chain.markers.markers()));
  }
}

TEST(SegmentationByData, TwoSegmentsTornApartHaveNoKnownJoint) {
  auto chain = testing::make_chain({.per_segment = 4, .stagger_m = 0.03, .noise_sd_m = 0.0005, .seed = 6});
  Random random(7, 1);
  for (std::int64_t f = 0; f < chain.markers.frames(); ++f) {
    const Eigen::Vector3d by(random.uniform(-0.014, 0.014), random.uniform(-0.014, 0.014),
                             random.uniform(-0.014, 0.014));
    for (int m = 4; m < 8; ++m) chain.markers.x(f, m) += by;
  }
  const auto found = by_data(chain.markers);
  EXPECT_TRUE(found.layout.joints.empty());
  ASSERT_FALSE(found.joints.empty());
  EXPECT_NE(found.joints[0].reason.find("mm apart"), std::string::npos) << found.joints[0].reason;
  EXPECT_NE(found.joints[0].sentence(chain.markers.names).find("Not determined"), std::string::npos);
}

TEST(Segmentation, OptionsCheckThemselves) {
  EXPECT_TRUE(SegmentationOptions().check());
  for (auto member : {&SegmentationOptions::most_gap_m, &SegmentationOptions::most_spread_m,
                      &SegmentationOptions::least_turn_rad, &SegmentationOptions::skin_sd_m}) {
    SegmentationOptions options;
    options.*member = 0.0;
    EXPECT_EQ(options.check().error().code, Code::usage);
    EXPECT_FALSE(segment_by_names(leg().markers, options));
  }
  SegmentationOptions options;
  options.least_weight = 1.5;
  EXPECT_FALSE(options.check());
}

}  // namespace
}  // namespace kinemark::skeleton
