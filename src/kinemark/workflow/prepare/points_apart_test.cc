// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/workflow/prepare/marker_screening.h"

namespace kinemark::workflow {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Markers that each go a way of their own, 60 frames of them, in metres.
data::Trajectories ways_of(std::vector<std::string> names) {
  auto markers = data::Trajectories::all_missing(std::move(names), {.rate_hz = 100.0, .frames = 60});
  Random random(11, 0);
  for (std::int64_t m = 0; m < markers.markers(); ++m) {
    const Eigen::Vector3d at(random.gaussian(), random.gaussian(), random.gaussian());
    const double turn = 0.5 + static_cast<double>(m);
    for (std::int64_t f = 0; f < markers.frames(); ++f) {
      const double t = 0.01 * static_cast<double>(f) * turn;
      markers.x(f, m) = at + Eigen::Vector3d(0.1 * std::sin(t), 0.1 * std::cos(3.0 * t), 0.05 * t);
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
  }
  return markers;
}

TEST(FindPointsApart, KnowsWhatModelsWriteByItsName) {
  const auto markers =
      ways_of({"LTHI", "LFEA", "RHJC", "LKNE", "PELO", "*12", "CentreOfMass", "LMidFootSup"});
  const auto apart = find_points_apart(markers);
  EXPECT_THAT(apart.computed, ElementsAre(1, 2, 4, 6));
  EXPECT_THAT(apart.unnamed, ElementsAre(5));
  EXPECT_THAT(apart.all(), ElementsAre(1, 2, 4, 5, 6));
  EXPECT_EQ(apart.describe(markers.names),
            "4 computed points (LFEA, RHJC, PELO, CentreOfMass) and 1 without a name");
}

TEST(FindPointsApart, OfMarkersAloneAreNone) {
  const auto markers = ways_of({"LTHI", "LKNE", "LTIB", "LANK"});
  EXPECT_THAT(find_points_apart(markers).all(), IsEmpty());
  EXPECT_EQ(find_points_apart(markers).describe(markers.names), "");
}

TEST(FindPointsApart, NobodyIsLeftAlone) {
  EXPECT_THAT(find_points_apart(ways_of({"LFEA", "LFEO"})).all(), IsEmpty()) << "selected alone";
  EXPECT_THAT(find_points_apart(ways_of({"*1", "*2", "*3"})).all(), IsEmpty()) << "nobody named any";
}

TEST(FindPointsApart, WhatNobodyNamedIsCounted) {
  const auto markers = ways_of({"LTHI", "*1", "*2"});
  EXPECT_EQ(find_points_apart(markers).describe(markers.names), "2 points without a name");
}

/// "c" at `share` of the way from "a" to "b", `beside_m` off in one frame.
data::Trajectories with_middle(double share, double beside_m) {
  auto markers = ways_of({"a", "b", "c"});
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    markers.x(f, 2) = (1.0 - share) * markers.x(f, 0) + share * markers.x(f, 1);
  markers.x(33, 2).z() += beside_m;
  return markers;
}

TEST(FindPointsApart, MiddlesOfTwoMarkersAreComputed) {
  EXPECT_THAT(find_points_apart(with_middle(0.5, 0.0)).computed, ElementsAre(2));
  EXPECT_THAT(find_points_apart(with_middle(0.5, 1e-4)).computed, IsEmpty())
      << "a tenth of a millimetre beside";
  for (const double share : {0.2, 1.5})
    EXPECT_THAT(find_points_apart(with_middle(share, 0.0)).computed, IsEmpty())
        << "who of three on one line is computed of the others is not known: " << share;
}

TEST(FindPointsApart, ThreeMarkersOnOneRodAreMarkers) {
  auto markers = ways_of({"a", "b", "c"});
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    markers.x(f, 1) = markers.x(f, 0) + Eigen::Vector3d(0.2, 0.0, 0.0);
    markers.x(f, 2) = markers.x(f, 0) + Eigen::Vector3d(0.1, 0.0, 0.0);
  }
  EXPECT_THAT(find_points_apart(markers).computed, IsEmpty()) << "their distances do not change";
}

TEST(FindPointsApart, AFewFramesShowNothing) {
  auto markers = with_middle(0.5, 0.0);
  for (std::int64_t f = 19; f < markers.frames(); ++f) markers.set_missing(f, 2);
  EXPECT_THAT(find_points_apart(markers).computed, IsEmpty());
}

}  // namespace
}  // namespace kinemark::workflow
