// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/scale/internal/sizes.h"

#include <gmock/gmock.h>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"
#include "kinemark/pipeline/simulate/human_model.h"

namespace kinemark::workflow {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// Two frames of the model in its default pose, and a factor of 1 for each body.
struct Standing {
  data::ModelDescription model = pipeline::human_model().value();
  data::Trajectories markers;
  std::vector<data::BodyFactors> factors;
  Remarks remarks;

  Standing() {
    const auto compiled = model::Model::compile(model).value();
    model::Workspace w(compiled);
    model::kinematics(compiled, w, compiled.default_state());
    std::vector<std::string> names;
    for (const auto& marker : model.markers) names.push_back(marker.name);
    markers = data::Trajectories::all_missing(names, {.rate_hz = 50.0, .frames = 2});
    for (std::int64_t f = 0; f < 2; ++f)
      for (std::int64_t m = 0; m < markers.markers(); ++m) {
        markers.x(f, m) = w.marker.col(m);
        markers.state[markers.index(f, m)] = data::SampleState::measured;
      }
    for (const auto& body : model.bodies) factors.push_back({.body = body.name});
  }
  Eigen::Vector3d& factor(const std::string& body) { return factors[at(model.find_body(body))].factors; }
  const data::Gate& judge(const std::optional<RecipeSizes>& recipe = {}) {
    const SizeSource source{"cal.c3d", &markers};
    EXPECT_TRUE(judge_sizes(model, factors, std::span(&source, 1), recipe, remarks));
    return remarks.gates.back();
  }
};

TEST(Sizes, OfPeoplePass) {
  Standing one;
  for (auto& body : one.factors) body.factors *= 0.55;  // a child
  one.factor("femur_r") *= 1.45;
  const auto& gate = one.judge();
  EXPECT_EQ(gate.name, "sizes");
  EXPECT_TRUE(gate.passed);
  EXPECT_NEAR(gate.value, 1.45, 1e-9);
  EXPECT_THAT(gate.sentence, HasSubstr("No body is scaled by more than 1.5 times the factor of the others"));
  EXPECT_THAT(one.remarks.warnings, IsEmpty());
}

TEST(Sizes, OfNobodyAreSaidWithTheDistancesThatTheyComeFrom) {
  Standing one;
  one.factor("femur_r").y() = 0.2;
  for (std::int64_t f = 0; f < 2; ++f) one.markers.x(f, one.markers.find("RKNE")).y() += 0.3;
  const auto& gate = one.judge();
  EXPECT_FALSE(gate.passed);
  EXPECT_NEAR(gate.value, 5.0, 1e-9);
  ASSERT_EQ(one.remarks.warnings.size(), 1U);
  EXPECT_EQ(gate.sentence, one.remarks.warnings[0]);
  EXPECT_THAT(gate.sentence, HasSubstr("People do not differ as much as these sizes: "));
  EXPECT_THAT(gate.sentence,
              HasSubstr("femur_r is scaled by 0.20 along its y axis, beside 1.00 of the bodies' median: "));
  EXPECT_THAT(gate.sentence, HasSubstr("RKNE"));
  EXPECT_THAT(gate.sentence, HasSubstr("the distance from "));
  EXPECT_THAT(gate.sentence, Not(HasSubstr("LKNE")));
  EXPECT_THAT(gate.sentence, Not(HasSubstr("times as large as those of the model")));
  EXPECT_THAT(gate.sentence, Not(HasSubstr("no two of its markers were seen")));
  EXPECT_THAT(gate.sentence, Not(HasSubstr("No body is scaled by more than")));
}

TEST(Sizes, OfABodyWithoutMarkersNameNone) {
  Standing one;
  one.markers = data::Trajectories::all_missing({"a"}, {.rate_hz = 50.0, .frames = 2});
  one.factor("pelvis") *= 2.0;
  const auto& gate = one.judge();
  EXPECT_THAT(gate.sentence, HasSubstr("no two of its markers were seen"));
  EXPECT_THAT(gate.sentence, Not(HasSubstr("the distance from ")));
}

TEST(Sizes, ThatARecipeMeasuredNameItsDistances) {
  Standing one;
  one.factor("femur_r") *= 1.7;
  const data::ScaleRecipe recipe{
      .measurements = {{.name = "thigh", .pairs = {{"RTHI", "RKNE"}}, .bodies = {{.body = "femur_r"}}}}};
  motion::ScaleResult scaled;
  scaled.measurements = {{.name = "thigh", .factor = 1.7, .pairs = {{"RTHI", "RKNE", 0.34, 0.0, 0.2}}}};
  const auto& gate = one.judge(RecipeSizes{&recipe, &scaled, "walk.c3d"});
  EXPECT_THAT(gate.sentence,
              HasSubstr("the distance from RTHI to RKNE is 340 mm in walk.c3d, 200 mm in the model"));
}

TEST(Sizes, OfAWholeBodyThatNobodyHasAreSaid) {
  for (const double size : {0.2, 1.7}) {
    Standing one;
    for (auto& body : one.factors) body.factors *= size;
    const auto& gate = one.judge();
    EXPECT_FALSE(gate.passed);
    EXPECT_THAT(gate.sentence, HasSubstr("times as large as those of the model"));
    EXPECT_THAT(gate.sentence, Not(HasSubstr("of the bodies' median")));
  }
}

}  // namespace
}  // namespace kinemark::workflow
