// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/provenance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/data/calibration_error.h"
#include "kinemark/io/c3d/reader.h"
#include "kinemark/io/c3d/writer.h"
#include "kinemark/math/symmetric3.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using data::SampleState;
using testing::ElementsAre;
using testing::HasSubstr;

/// All present, state changes every `every` frames.
data::Trial trial_of(std::int64_t frames, std::int64_t markers, std::int64_t every) {
  data::Trial trial;
  std::vector<std::string> names;
  for (std::int64_t m = 0; m < markers; ++m) names.push_back("M" + std::to_string(m));
  trial.markers = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .t0_s = 0.0, .frames = frames});
  auto& t = trial.markers;
  for (std::int64_t f = 0; f < frames; ++f) {
    for (std::int64_t m = 0; m < markers; ++m) {
      const auto state = static_cast<SampleState>((f / every + m) % 6);
      t.state[t.index(f, m)] = state;
      if (!t.present(f, m)) continue;
      t.x(f, m) = Eigen::Vector3d(1.0, 2.0, 0.001 * static_cast<double>(f + 1));
      if (state == SampleState::model_filled) t.set_method(f, m, m == 0 ? "rigid body" : "PCA");
    }
  }
  return trial;
}

TEST(C3dProvenance, StatesAndMethodsComeBack) {
  const testing_support::ScratchFolder scratch;
  for (const bool integers : {false, true}) {
    const data::Trial trial = trial_of(70'000, 3, 100);  // more than one word of frames
    ASSERT_TRUE(write_c3d(scratch / "a.c3d", trial, {.force = true, .integers = integers}));
    const auto back = read_c3d(scratch / "a.c3d");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->markers.state, trial.markers.state);
    EXPECT_EQ(back->markers.method, trial.markers.method);
    EXPECT_EQ(back->markers.methods, trial.markers.methods);
    EXPECT_THAT(back->warnings, ElementsAre());
  }
}

TEST(C3dProvenance, DeviationsComeBackWithinTwoAndAHalfPercent) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial = trial_of(60, 2, 10);
  auto& t = trial.markers;
  t.covariance.assign(6 * t.state.size(), 0.0);
  for (std::size_t i = 0; i < t.state.size(); ++i) {
    const double sd_m = 2e-6 * std::pow(1.09, static_cast<double>(i));
    for (const std::size_t k : math::kSymmetric3Diagonal) t.covariance[6 * i + k] = sd_m * sd_m;
  }
  ASSERT_TRUE(write_c3d(scratch / "a.c3d", trial));
  const auto back = read_c3d(scratch / "a.c3d").value().markers;
  ASSERT_EQ(back.covariance.size(), t.covariance.size());
  int compared = 0;
  for (std::int64_t f = 0; f < t.frames(); ++f) {
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      const std::size_t i = t.index(f, m);
      if (!t.present(f, m)) {
        EXPECT_TRUE(std::isnan(back.covariance[6 * i]));
      } else {
        EXPECT_NEAR(std::sqrt(back.covariance[6 * i] / t.covariance[6 * i]), 1.0, 0.026) << i;
        EXPECT_EQ(back.covariance[6 * i], back.covariance[6 * i + 5]);
        EXPECT_EQ(back.covariance[6 * i + 1], 0.0);
        ++compared;
      }
    }
  }
  EXPECT_EQ(compared, 80);
}

TEST(C3dProvenance, TheErrorOfTheCalibrationComesBack) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial = trial_of(20, 2, 30);
  trial.calibration_error.middle_in_world = {0.5, -0.25, 2.0};
  for (const double size : {1.0 / 3.0, 0.25e-5})
    trial.calibration_error.fields.emplace_back(data::CalibrationError::Field::Constant(size));
  ASSERT_TRUE(write_c3d(scratch / "a.c3d", trial));
  const auto back = read_c3d(scratch / "a.c3d");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_THAT(back->warnings, ElementsAre());
  EXPECT_EQ(data::to_text(back->calibration_error), data::to_text(trial.calibration_error));

  C3dParameters damaged;
  damaged.group("KINEMARK")
      .parameters.push_back(
          {.name = "CALIBRATION_ERROR", .type = C3dType::text, .dims = {5, 1}, .texts = {"1 2 3"}});
  take_calibration_error(damaged, trial);
  EXPECT_THAT(
      trial.warnings,
      ElementsAre(HasSubstr("KINEMARK:CALIBRATION_ERROR holds no fields of displacement and is not read")));
  C3dParameters none;
  add_calibration_error({}, none);
  EXPECT_TRUE(none.groups.empty());
}

TEST(C3dProvenance, NothingIsAddedWhereResidualsSayAll) {
  C3dParameters parameters;
  data::Trial trial = trial_of(10, 1, 3);
  for (std::int64_t f = 0; f < 10; ++f)
    trial.markers.state[static_cast<std::size_t>(f)] =
        f % 2 == 0 ? SampleState::measured : SampleState::interpolated;
  trial.markers.method.clear();
  add_provenance(trial.markers, parameters);
  EXPECT_FALSE(parameters.has_group(kProvenanceGroup));
}

TEST(C3dProvenance, MoreRunsThanFitLoseDeviationsThenTheGroup) {
  const testing_support::ScratchFolder scratch;
  data::Trial trial = trial_of(30'000, 1, 10);
  trial.markers.covariance.assign(6 * trial.markers.state.size(), 0.0);
  Array<double>& c = trial.markers.covariance;
  for (std::size_t i = 0; i < trial.markers.state.size(); ++i) c[6 * i] = i % 2 == 0 ? 1e-6 : 1e-8;
  ASSERT_TRUE(write_c3d(scratch / "a.c3d", trial));
  const auto back = read_c3d(scratch / "a.c3d").value().markers;
  EXPECT_EQ(back.state, trial.markers.state);
  EXPECT_TRUE(back.covariance.empty());

  const data::Trial busy = trial_of(30'000, 1, 1);
  ASSERT_TRUE(write_c3d(scratch / "b.c3d", busy));
  const auto plain = read_c3d(scratch / "b.c3d").value().markers;
  for (std::size_t i = 0; i < plain.state.size(); ++i) {
    const SampleState was = busy.markers.state[i];
    const SampleState wanted = was == SampleState::rejected  ? SampleState::missing
                               : was > SampleState::measured ? SampleState::interpolated
                                                             : was;
    ASSERT_EQ(plain.state[i], wanted) << "filled is still filled";
  }
}

TEST(C3dProvenance, ResidualsAreBelievedBeforeTheGroup) {
  data::Trial trial = trial_of(12, 1, 2);
  C3dParameters parameters;
  add_provenance(trial.markers, parameters);
  // Another program has measured everything again.
  for (std::int64_t f = 0; f < 12; ++f) {
    trial.markers.x(f, 0).setOnes();
    trial.markers.state[static_cast<std::size_t>(f)] = SampleState::measured;
  }
  trial.markers.method.clear();
  apply_provenance(parameters, trial);
  for (const SampleState s : trial.markers.state) EXPECT_EQ(s, SampleState::measured);
  EXPECT_THAT(trial.warnings, ElementsAre(HasSubstr("disagree on 10 samples; the residuals are used")));
  EXPECT_TRUE(trial.markers.validate());
}

TEST(C3dProvenance, AGroupThatDoesNotFitIsLeftAlone) {
  const data::Trial written = trial_of(12, 2, 2);
  C3dParameters good;
  add_provenance(written.markers, good);
  const auto spoilt = [&](const std::string& name, const std::vector<double>& numbers) {
    C3dParameters p = good;
    for (C3dParameter& q : p.group(kProvenanceGroup).parameters)
      if (q.name == name) q.numbers = numbers;
    data::Trial trial = written;
    trial.markers.state.assign(24, SampleState::interpolated);
    trial.markers.x_in_world.assign(72, 1.0);
    trial.markers.method.clear();
    apply_provenance(p, trial);
    EXPECT_TRUE(trial.markers.validate());
    EXPECT_EQ(trial.markers.state, Array<SampleState>(24, SampleState::interpolated));
    return trial.warnings;
  };
  const auto complaint = ElementsAre(HasSubstr("KINEMARK:RUNS does not fit"));
  EXPECT_THAT(spoilt("FRAMES", {11.0, 0.0}), complaint);
  EXPECT_THAT(spoilt("FRAMES", {}), complaint);
  EXPECT_THAT(spoilt("RUNS", {}), complaint);
  EXPECT_THAT(spoilt("RUNS", {12.0, 0.0, 2.0, 0.0}), complaint);
  EXPECT_THAT(spoilt("RUNS", {24.0, 0.0, 2.0, 0.0, 0.0}), complaint) << "a run crosses markers";
  EXPECT_THAT(spoilt("RUNS", {12.0, 0.0, 6.0, 0.0, 0.0, 12.0, 0.0, 2.0, 0.0, 0.0}), complaint)
      << "no such state";
  EXPECT_THAT(spoilt("RUNS", {12.0, 0.0, 2.0, 9.0, 0.0, 12.0, 0.0, 2.0, 0.0, 0.0}), complaint)
      << "no such method";
  EXPECT_THAT(spoilt("RUNS", {0.0, 0.0, 2.0, 0.0, 0.0}), complaint);
}

}  // namespace
}  // namespace kinemark::io
