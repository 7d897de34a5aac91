// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/segments/internal/modelled_points.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/core/missing.h"
#include "kinemark/pipeline/segments/definition_file.h"

namespace kinemark::workflow {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::Not;

// Two frames: a marker LKNE that is seen, a label LTIB without a sample, and modelled points in mm.
data::Trial trial() {
  data::Trial out;
  out.markers = data::Trajectories::all_missing({"LKNE", "LTIB"}, {.rate_hz = 100.0, .frames = 2});
  out.markers.x(0, 0) = Eigen::Vector3d(0.1, 0.2, 0.5);
  out.markers.state[out.markers.index(0, 0)] = data::SampleState::measured;
  out.channels.names = {"LTHI", "LKNE", "LTIB", "Ann:LHJC", "LKneeAngles"};
  out.channels.kinds.assign(4, data::ChannelKind::modeled_marker);
  out.channels.kinds.push_back(data::ChannelKind::angle);
  out.channels.units = {"mm", "mm", "m", "mm", "deg"};
  out.channels.rate_hz = 100.0;
  out.channels.frames = 2;
  out.channels.values.assign(30, 0.0);
  for (std::size_t k = 0; k < 15; ++k) out.channels.values[k] = 100.0 + static_cast<double>(k);
  return out;
}

TEST(ModelledPoints, StandInForMarkersWithoutSamples) {
  const auto found = with_modelled_points(trial(), {"LTHI", "LKNE", "LTIB"});
  ASSERT_TRUE(found);
  EXPECT_THAT(found->points, ElementsAre("LTHI", "LTIB"));
  EXPECT_THAT(found->markers.names, ElementsAre("LKNE", "LTHI", "LTIB"));
  EXPECT_NEAR((found->markers.x(0, 1) - Eigen::Vector3d(0.1, 0.101, 0.102)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(found->markers.x(0, 2).x(), 106.0, 1e-12) << "its unit is m";
  EXPECT_EQ(found->markers.state[found->markers.index(0, 1)], data::SampleState::model_filled);
  EXPECT_FALSE(found->markers.present(1, 1)) << "a point at zero is missing";
  EXPECT_EQ(found->markers.state[0], data::SampleState::measured);
}

TEST(ModelledPoints, AreNotTakenWhereMeasuredOnesAreThereOrNobodyAsks) {
  EXPECT_FALSE(with_modelled_points(trial(), {"LKNE"}));
  EXPECT_FALSE(with_modelled_points(trial(), {"LKneeAngles"})) << "an angle is no point";
  auto other = trial();
  other.channels.frames = 3;
  EXPECT_FALSE(with_modelled_points(other, {"LTHI"}));
}

TEST(ModelledPoints, NamesWithASuffixAreFound) {
  const auto found =
      suffixed_names({"Ann:LFE_MO", "LTIO_M", "RFEO", "RFE_MO", "LKNEE"}, {"LFEO", "LTIO", "RFEO", "LKNE"});
  EXPECT_EQ(found.size(), 2U);
  EXPECT_EQ(found.at("LFEO"), "Ann:LFE_MO");
  EXPECT_EQ(found.at("LTIO"), "LTIO_M");
}

TEST(ModelledPoints, NamesOfADefinitionAreThoseThatItDoesNotExplain) {
  const auto definition = pipeline::find_definition("pig");
  ASSERT_TRUE(definition) << definition.error().message;
  const auto names = names_of_points(*definition);
  for (const char* name : {"LTHI", "RKNE", "LKAX", "RMED", "LFEO", "RFEP", "SACR"})
    EXPECT_THAT(names, Contains(name));
  for (const char* name : {"LKJC", "pelvis", "LKneeWidth", "up", "LFemur"})
    EXPECT_THAT(names, Not(Contains(name)));
}

}  // namespace
}  // namespace kinemark::workflow
