// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/formula_tracks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>

#include "kinemark/stages/analysis/segments/testing/formulas.h"

namespace kinemark::analysis {
namespace {

using analysis::testing::of;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using State = data::SampleState;

data::Trajectories two_markers() {
  auto out = data::Trajectories::all_missing({"A", "B"}, {.rate_hz = 100.0, .frames = 3});
  for (std::int64_t f = 0; f < 3; ++f) {
    out.x(f, 0) = Vector3d(0.0, 0.0, static_cast<double>(f));
    out.x(f, 1) = Vector3d(1.0, 0.0, 0.0);
    for (std::int64_t m = 0; m < 2; ++m) out.state[out.index(f, m)] = State::measured;
  }
  return out;
}

SegmentDefinition middle() {
  SegmentDefinition d;
  d.parameters.push_back({.name = "Width", .quantity = SubjectQuantity::length});
  d.points.push_back({.name = "middle", .formula = of("mean(A, B)"), .written = true});
  return d;
}

TEST(FormulaTracks, FormulasAreWorthWhatMarkersMakeThem) {
  const auto d = middle();
  const auto markers = two_markers();
  const Formula point = of("middle"), length = of("z(A) + 1");
  const std::array<GraphOutput, 2> outputs{
      GraphOutput{.formula = &point, .what = "point"},
      GraphOutput{.formula = &length, .type = StepType::number, .what = "z"}};
  const auto tracks = FormulaTracks::create(d, {.markers = &markers}, {}, outputs);
  ASSERT_TRUE(tracks) << tracks.error().message;
  EXPECT_THAT(tracks->markers_of(0), ElementsAre(0, 1));
  EXPECT_THAT(tracks->markers_of(1), ElementsAre(0));
  std::vector<StepValue> work, out(2);
  tracks->evaluate(markers, 2, work, out);
  EXPECT_EQ(out[0][0], 0.5);
  EXPECT_EQ(out[0][2], 1.0);
  EXPECT_EQ(out[1][0], 3.0);
  // Another version of the same recording.
  auto moved = markers;
  moved.x(2, 0) = Vector3d(0.0, 0.0, 5.0);
  tracks->evaluate(moved, 2, work, out);
  EXPECT_EQ(out[1][0], 6.0);
}

TEST(FormulaTracks, WhatLacksSomethingIsNotTouchedAndNamed) {
  const auto d = middle();
  const auto markers = two_markers();
  const Formula point = of("Width * A"), other = of("C");
  const std::array<GraphOutput, 2> outputs{GraphOutput{.formula = &point, .what = "point"},
                                           GraphOutput{.formula = &other, .what = "other"}};
  const auto tracks = FormulaTracks::create(d, {.markers = &markers}, {}, outputs);
  ASSERT_TRUE(tracks);
  EXPECT_THAT(tracks->lacks(0), ElementsAre("Width"));
  std::vector<StepValue> work, out(2, StepValue{7.0});
  tracks->evaluate(markers, 0, work, out);
  EXPECT_EQ(out[0][0], 7.0);
  const std::array<std::string, 2> names{"first", ""};
  EXPECT_THAT(tracks->lack_sentences(names),
              ElementsAre("Not computed: first; there is no value of 'Width'."));
}

TEST(FormulaTracks, RefusesFormulasThatMakeNoSense) {
  const auto d = middle();
  const auto markers = two_markers();
  const Formula wrong = of("A * B");
  const std::array<GraphOutput, 1> outputs{GraphOutput{.formula = &wrong, .what = "point P"}};
  const auto tracks = FormulaTracks::create(d, {.markers = &markers}, {}, outputs);
  ASSERT_FALSE(tracks);
  EXPECT_EQ(tracks.error().code, Code::bad_input);
}

}  // namespace
}  // namespace kinemark::analysis
