// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/ik_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/report/internal/example_trial.h"
#include "kinemark/stages/report/internal/unpack_testing.h"

namespace kinemark::report::internal {
namespace {

/// Positions for the example, which has states only where it has none.
ExampleTrial trial_in_space() {
  auto trial = example_trial(120);
  auto& t = trial.markers;
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m)
      if (t.present(f, m))
        t.x(f, m) = Eigen::Vector3d(0.01 * static_cast<double>(f), 0.05 * static_cast<double>(m), 1.0);
  return trial;
}

IkReport report_of(const ExampleTrial& trial) {
  return {.summary = summarize(trial.run, trial.motion, &trial.markers).value(),
          .motion = &trial.motion,
          .markers = &trial.markers};
}

TEST(IkScene, TheModelIsWhereTheErrorSays) {
  const auto trial = trial_in_space();
  auto report = report_of(trial);
  report.up = Eigen::Vector3d::UnitY();
  const auto json = ik_scene_json(report);
  ASSERT_FALSE(json.is_null());
  EXPECT_EQ(json["names"], trial.motion.markers);
  EXPECT_EQ(json["up_from"], "the model's gravity");
  const auto measured = unpack_series(json["markers"]["positions_m"]), model = unpack_series(json["model_m"]);
  const auto frames = static_cast<std::size_t>(trial.motion.frames());
  const auto M = trial.motion.markers.size();
  int compared = 0;
  for (std::size_t m = 0; m < M; ++m)
    for (std::size_t f = 0; f < frames; ++f) {
      const double error = trial.motion.marker_error[3 * (f * M + m)];
      const auto recorded = trial.markers.find(trial.motion.markers[m]);
      if (std::isnan(error) || !trial.markers.present(static_cast<std::int64_t>(f), recorded)) continue;
      EXPECT_NEAR(measured[3 * m * frames + f] - model[3 * m * frames + f], error, 5e-5);
      ++compared;
    }
  EXPECT_GT(compared, 1000);
}

TEST(IkScene, IsLeftOutWherePositionsAreNotKnown) {
  const auto trial = trial_in_space();
  auto report = report_of(trial);
  report.in_model_axes = false;
  EXPECT_TRUE(ik_scene_json(report).is_null());
  report = report_of(trial);
  report.markers = nullptr;
  EXPECT_TRUE(ik_scene_json(report).is_null());
  auto renamed = trial.markers;
  renamed.names[static_cast<std::size_t>(renamed.find(trial.motion.markers[0]))] = "somebody else";
  report = report_of(trial);
  report.markers = &renamed;
  EXPECT_TRUE(ik_scene_json(report).is_null());
}

TEST(IkScene, NobodySaysWhatIsUpWithoutAModel) {
  const auto trial = trial_in_space();
  EXPECT_TRUE(ik_scene_json(report_of(trial))["up"].is_null());
}

}  // namespace
}  // namespace kinemark::report::internal
