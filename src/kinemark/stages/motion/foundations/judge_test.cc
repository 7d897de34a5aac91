// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/judge.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/scaling/scale.h"
#include "support/test_data.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using ::testing::Not;

const data::ModelDescription& human() {
  static const auto kHuman =
      io::read_osim(testing_support::project_folder() / "models" / "human.osim").value();
  return kHuman;
}

/// Three normal numbers, drawn in order.
Vector3d some_vector(Random& random) {
  Vector3d out;
  for (int a = 0; a < 3; ++a) out[a] = random.gaussian();
  return out;
}

/// A subject of another size whose markers were placed by hand.
data::ModelDescription subject(std::uint64_t seed) {
  Random random(seed, 0);
  data::ModelDescription out = human();
  std::vector<Vector3d> factors;
  const double size = 1.0 + 0.06 * random.gaussian();
  for (std::size_t b = 0; b < out.bodies.size(); ++b) factors.push_back(Vector3d::Constant(size));
  apply_factors(out, factors, false);
  for (auto& marker : out.markers)
    for (int a = 0; a < 3; ++a) marker.x_in_body[a] += 0.005 * random.gaussian();
  return out;
}

/// Frames of a model: coordinates that turn are `spread` about their default.
data::Trajectories frames(const data::ModelDescription& description, std::int64_t count, double spread,
                          std::uint64_t seed) {
  const auto model = model::Model::compile(description).value();
  model::Workspace w(model);
  Random random(seed, 0);
  std::vector<std::string> names;
  for (const auto& marker : description.markers) names.push_back(marker.name);
  auto out = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .frames = count});
  Eigen::VectorXd q(model.coordinate_count());
  for (std::int64_t f = 0; f < count; ++f) {
    if (f == 0 || spread > 0.1)
      for (int c = 0; c < model.coordinate_count(); ++c) {
        const auto& coordinate = description.coordinates[at(c)];
        q[c] =
            coordinate.default_value + (coordinate.is_rotation && c > 5 ? spread * random.gaussian() : 0.0);
      }
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    for (std::int64_t m = 0; m < out.markers(); ++m) {
      out.x(f, m) = w.marker.col(m) + 0.0005 * some_vector(random);
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  }
  return out;
}

void exchange(data::Trajectories& trial, const std::string& a, const std::string& b) {
  const auto i = trial.find(a), j = trial.find(b);
  for (std::int64_t f = 0; f < trial.frames(); ++f) {
    const Vector3d kept = trial.x(f, i);
    trial.x(f, i) = trial.x(f, j);
    trial.x(f, j) = kept;
  }
}

void move(data::Trajectories& trial, const std::string& a, const Vector3d& by) {
  for (std::int64_t f = 0; f < trial.frames(); ++f) trial.x(f, trial.find(a)) += by;
}

FoundationJudgement by_model(const data::Trajectories& still) {
  static const StandingBody kBody = body_of_model(human()).value();
  return judge_foundation(kBody, still, {}).value();
}

FoundationJudgement by_names(const data::Trajectories& still, const data::Trajectories* movement = nullptr) {
  std::vector<const data::Trajectories*> movements;
  if (movement != nullptr) movements.push_back(movement);
  return judge_foundation(body_of_names(still.names), still, movements).value();
}

TEST(Judge, ACleanStaticTrialIsNotAccused) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto still = frames(subject(seed), 9, 0.08, seed);
    const auto a = by_model(still), b = by_names(still);
    EXPECT_TRUE(a.findings.empty()) << describe(a.findings.front(), "s");
    EXPECT_TRUE(b.findings.empty()) << describe(b.findings.front(), "s");
    EXPECT_EQ(a.judged.size(), 40);
  }
}

TEST(Judge, AFlexedPostureIsNotAMistake) {
  auto description = subject(5);
  for (auto& coordinate : description.coordinates)
    if (coordinate.name == "knee_angle_r" || coordinate.name == "hip_flexion_r")
      coordinate.default_value = 0.6;
  const auto judgement = by_model(frames(description, 9, 0.02, 5));
  EXPECT_TRUE(judgement.findings.empty()) << describe(judgement.findings.front(), "s");
}

TEST(Judge, ExchangedPairsAreNamed) {
  for (const auto& [a, b] : {std::pair{"LTOE", "LHEE"}, std::pair{"LKNE", "LANK"}, std::pair{"LASI", "RASI"},
                             std::pair{"LKNE", "RKNE"}, std::pair{"LASI", "LPSI"}}) {
    auto still = frames(subject(7), 9, 0.05, 7);
    exchange(still, a, b);
    for (const auto& judgement : {by_model(still), by_names(still)}) {
      ASSERT_EQ(judgement.findings.size(), 1) << a;
      const auto& f = judgement.findings[0];
      EXPECT_TRUE((f.marker == a && f.partner == b) || (f.marker == b && f.partner == a)) << describe(f, "s");
      EXPECT_THAT(describe(f, "cal.c3d"), HasSubstr("are exchanged in cal.c3d"));
    }
  }
}

TEST(Judge, AMarkerElsewhereIsNamedWithSizeAndDirection) {
  auto still = frames(subject(8), 9, 0.05, 8);
  move(still, "LANK", Vector3d(0.060, 0.0, 0.0));  // forward in the model's axes
  const auto judgement = by_model(still);
  ASSERT_EQ(judgement.findings.size(), 1);
  const auto& f = judgement.findings[0];
  EXPECT_EQ(f.marker, "LANK");
  EXPECT_TRUE(f.partner.empty());
  EXPECT_LT(std::abs(f.shift_m.x() - 0.060), 4.0 * f.shift_sd_m.x());
  EXPECT_THAT(describe(f, "cal.c3d"), HasSubstr("mm forward"));
  EXPECT_THAT(describe(f, "cal.c3d"), Not(HasSubstr("exchanged in")));
}

TEST(Judge, AMovementShowsWhatTheStaticTrialAloneCannot) {
  const auto person = subject(9);
  auto still = frames(person, 9, 0.03, 9);
  const auto movement = frames(person, 40, 0.25, 10);
  EXPECT_TRUE(by_names(still, &movement).findings.empty());
  move(still, "RTHI", Vector3d(0.0, -0.045, 0.0));  // along the thigh: wands stand at any height
  EXPECT_TRUE(by_names(still).findings.empty());
  const auto judgement = by_names(still, &movement);
  EXPECT_EQ(judgement.movements, 1);
  ASSERT_EQ(judgement.findings.size(), 1);
  EXPECT_EQ(judgement.findings[0].marker, "RTHI");
  EXPECT_THAT(describe(judgement.findings[0], "cal.c3d"), HasSubstr("as the movement shows it"));
  exchange(still, "LTOE", "LHEE");
  for (const auto& finding : by_names(still, &movement).findings)
    EXPECT_EQ(finding.by_movement, finding.marker == "RTHI") << describe(finding, "cal.c3d");
}

TEST(Judge, ThighWandsAtDifferentHeightsAreAsPrescribed) {
  auto still = frames(subject(11), 9, 0.03, 11);
  move(still, "LTHI", Vector3d(0.0, -0.06, 0.0));
  EXPECT_TRUE(by_names(still).findings.empty());
}

TEST(Judge, TwoMistakesAreBothFound) {
  auto still = frames(subject(12), 9, 0.03, 12);
  exchange(still, "LTOE", "LHEE");
  exchange(still, "RASI", "RPSI");
  EXPECT_EQ(by_model(still).findings.size(), 2);
}

TEST(Judge, TooFewMarkersAreNotJudged) {
  const auto whole = frames(human(), 3, 0.0, 1);
  auto still = data::Trajectories::all_missing({"LASI", "RASI", "LKNE"}, whole.time);
  const auto judgement = by_names(still);
  EXPECT_TRUE(judgement.judged.empty());
  EXPECT_TRUE(judgement.findings.empty());
}

TEST(Judge, OptionsAreChecked) {
  EXPECT_FALSE(FoundationOptions{.least_score = 0.0}.check());
  EXPECT_FALSE(FoundationOptions{.still_sd_m = -1.0}.check());
  EXPECT_FALSE(FoundationOptions{.moving_frames = 0}.check());
  EXPECT_TRUE(FoundationOptions{}.check());
}

}  // namespace
}  // namespace kinemark::motion
