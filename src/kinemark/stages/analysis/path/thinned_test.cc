// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/thinned.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/path/testing/known_path.h"

namespace kinemark::analysis {
namespace {

PathMatrix noise(std::int64_t n, double sd, std::uint64_t seed) {
  Random random(seed, 1);
  PathMatrix out(n, 3);
  for (auto& value : out.reshaped()) value = sd * random.gaussian();
  return out;
}

TEST(ThinnedExtremes, WithoutNoiseAreTheExtremes) {
  const PathMatrix x = testing::sampled(300, 100.0, testing::ellipse);
  const auto axes = principal_axes(x);
  const auto found = thinned_extremes(x, axes, PathMatrix::Zero(300, 3));
  const PathMatrix along = along_axes(x, axes);
  for (int k = 0; k < 3; ++k)
    EXPECT_NEAR(found.extents[k], along.col(k).maxCoeff() - along.col(k).minCoeff(), 1e-12);
  EXPECT_NEAR(found.largest_distance, diameters(x).largest, 1e-12);
}

TEST(ThinnedExtremes, HaveNoBiasWhereTheLargestOfNoisyValuesHasOne) {
  // A point that rests at both ends of its way: any of 60 samples may be the farthest.
  const auto place = [](double t) { return Eigen::Vector3d(t < 0.6 ? 0.0 : 0.3, 0.0, 0.0); };
  const PathMatrix path = testing::sampled(120, 100.0, place);
  double plain = 0.0, thinned = 0.0, distance = 0.0;
  constexpr int kTrials = 200;
  for (int k = 0; k < kTrials; ++k) {
    const auto seed = static_cast<std::uint64_t>(2 * k);
    const PathMatrix x = path + noise(120, 1e-3, seed + 1);
    const auto axes = principal_axes(x);
    const PathMatrix along = along_axes(x, axes);
    plain += (along.col(0).maxCoeff() - along.col(0).minCoeff() - 0.3) / kTrials;
    const auto found = thinned_extremes(x, axes, noise(120, 1e-3, seed + 2));
    thinned += (found.extents[0] - 0.3) / kTrials;
    distance += (found.largest_distance - 0.3) / kTrials;
  }
  EXPECT_GT(plain, 4e-3);
  EXPECT_NEAR(thinned, 0.0, 3.5e-4);
  EXPECT_NEAR(distance, 0.0, 3.5e-4);
}

}  // namespace
}  // namespace kinemark::analysis
