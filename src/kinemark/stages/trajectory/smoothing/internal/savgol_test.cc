// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "kinemark/core/random.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"

namespace kinemark::trajectory {
namespace {

data::Trajectories of(int frames, const std::function<double(double)>& x, double sigma = 0.0) {
  auto t = data::Trajectories::all_missing({"A"}, {50.0, 0.0, frames});
  Random random(3, 3);
  for (int f = 0; f < frames; ++f) {
    for (int axis = 0; axis < 3; ++axis) {
      const double noise = sigma > 0.0 ? sigma * random.gaussian() : 0.0;
      t.x(f, 0)[axis] = (axis + 1) * x(f / 50.0) + noise;
    }
    t.state[static_cast<std::size_t>(f)] = data::SampleState::measured;
  }
  return t;
}

SmoothOptions savgol(int degree, double cutoff_hz = 0.0) {
  SmoothOptions options;
  options.method = FilterMethod::savgol;
  options.order = degree;
  options.cutoff_hz = cutoff_hz;
  return options;
}

TEST(Savgol, KeepsPolynomialsOfItsDegreeToTheEnds) {
  const auto in = of(80, [](double t) { return 1.0 - t + 2.0 * t * t - 0.7 * t * t * t; });
  const auto out = smooth(in, savgol(3, 4.0)).value();
  for (std::size_t f = 0; f < 80; ++f) {
    const double t = static_cast<double>(f) / 50.0;
    EXPECT_NEAR(out.trajectories.x_in_world[3 * f], in.x_in_world[3 * f], 1e-9);
    EXPECT_NEAR(out.derivatives.velocity[3 * f], -1.0 + 4.0 * t - 2.1 * t * t, 1e-7);
    EXPECT_NEAR(out.derivatives.acceleration[3 * f + 1], 2.0 * (4.0 - 4.2 * t), 1e-5);
    EXPECT_NEAR(out.derivatives.jerk[3 * f + 2], 3.0 * -4.2, 1e-3);
  }
}

TEST(Savgol, HasTheTextbookWeights) {
  // Degree 2, five points: (-3 12 17 12 -3) / 35, and -2 -1 0 1 2 over 10 for the slope (Savitzky & Golay
  // 1964).
  auto in = of(5, [](double) { return 0.0; });
  in.x(2, 0).x() = 1.0;
  in.x(3, 0).y() = 1.0;
  const auto out = smooth(in, savgol(2, 8.0)).value();
  EXPECT_NEAR(out.trajectories.x(2, 0).x(), 17.0 / 35.0, 1e-12);
  EXPECT_NEAR(out.trajectories.x(2, 0).y(), 12.0 / 35.0, 1e-12);
  EXPECT_NEAR(out.derivatives.velocity[7], 50.0 * 0.1, 1e-9);
}

TEST(Savgol, CutoffAskedIsKept) {
  for (const double cutoff_hz : {2.0, 4.0, 8.0}) {
    const auto out =
        smooth(of(400, [](double t) { return std::sin(t); }, 0.001), savgol(4, cutoff_hz)).value();
    EXPECT_LE(out.derivatives.filters[0].cutoff_hz, cutoff_hz);
    EXPECT_GT(out.derivatives.filters[0].cutoff_hz, 0.6 * cutoff_hz);
  }
}

TEST(Savgol, WindowIsCrossValidatedAndTheNoiseFound) {
  const auto in = of(600, [](double t) { return 0.2 * std::sin(5.0 * t); }, 0.001);
  const auto out = smooth(in, savgol(0)).value();
  const auto& account = out.markers[0];
  EXPECT_EQ(account.used.order, 4);
  EXPECT_NEAR(account.used.noise_sd_m, 0.001, 0.0001);
  EXPECT_EQ(account.criterion_name, "GCV, m^2");
  // Positions: the window balances noise against lost movement, and the bars hold the noise.
  double error = 0.0, bar = 0.0;
  for (std::size_t f = 50; f < 550; ++f) {
    error += std::pow(out.trajectories.x(static_cast<std::int64_t>(f), 0).x() -
                          0.2 * std::sin(5.0 * static_cast<double>(f) / 50.0),
                      2) /
             500.0;
    bar += out.trajectories.covariance[6 * f] / 500.0;
  }
  EXPECT_GT(std::sqrt(error / bar), 0.7);
  EXPECT_LT(std::sqrt(error / bar), 1.7);
}

TEST(Savgol, SaysWhyTheWindowIsWhatItIs) {
  const auto in = of(400, [](double t) { return 0.2 * std::sin(5.0 * t); }, 0.001);
  const auto asked = smooth(in, savgol(4, 4.0)).value().markers[0].description;
  const auto found = smooth(in, savgol(4)).value().markers[0].description;
  EXPECT_TRUE(asked.contains("frames for the cut-off asked.")) << asked;
  EXPECT_FALSE(asked.contains("frames: the least cross-validated error."));
  EXPECT_TRUE(found.contains("frames: the least cross-validated error.")) << found;
  EXPECT_FALSE(found.contains("frames for the cut-off asked."));
}

TEST(Savgol, ShortStretchesAreOnePolynomial) {
  auto in = of(60, [](double t) { return t; });
  for (int f = 20; f < 57; ++f) in.set_missing(f, 0);
  const auto out = smooth(in, savgol(4, 3.0)).value();
  for (const std::size_t f : {0u, 10u, 19u, 57u, 58u, 59u}) {
    EXPECT_NEAR(out.trajectories.x_in_world[3 * f], in.x_in_world[3 * f], 1e-9);
    EXPECT_NEAR(out.derivatives.velocity[3 * f], 1.0, 1e-7);
  }
  EXPECT_TRUE(std::isnan(out.derivatives.jerk[3 * 58]));  // three samples have no third derivative
}

}  // namespace
}  // namespace kinemark::trajectory
