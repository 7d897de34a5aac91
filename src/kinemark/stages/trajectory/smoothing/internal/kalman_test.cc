// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One marker through the smoother: what a spline must do whatever the data.
#include "kinemark/stages/trajectory/smoothing/internal/kalman.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/math/symmetric3.h"

namespace kinemark::trajectory::smoothing {
namespace {

using data::SampleState;
using data::Trajectories;
using Eigen::Vector3d;

/// One marker whose sample of frame f is at(f).
template <class At>
Trajectories marker_of(std::int64_t frames, At at, double rate_hz = 100.0) {
  auto t = Trajectories::all_missing({"M"}, {.rate_hz = rate_hz, .frames = frames});
  for (std::int64_t f = 0; f < frames; ++f) {
    t.x(f, 0) = at(f);
    t.state[t.index(f, 0)] = SampleState::measured;
  }
  return t;
}

Vector3d noise(Random& random) { return {random.gaussian(), random.gaussian(), random.gaussian()}; }

Trajectories noisy_path(std::int64_t frames, std::uint64_t seed, double noise_m = 0.001) {
  Random random(seed, 4);
  return marker_of(frames, [&](std::int64_t f) -> Vector3d {
    const double t = 0.01 * static_cast<double>(f);
    return Vector3d(std::sin(5.0 * t), 0.3 * std::cos(7.0 * t), 0.1 * t * t) + noise_m * noise(random);
  });
}

MarkerResult smoothed(const Trajectories& t, const SmoothOptions& options) {
  const MarkerSamples samples = marker_samples(t, 0).value();
  MarkerResult result;
  result.state = t.state;
  result.account.measured = samples.measured;
  smooth_kalman(samples, t, options, result);
  return result;
}

Vector3d row(const Array<double>& values, std::int64_t f) {
  return Eigen::Map<const Vector3d>(values.data() + 3 * f);
}

/// A fixed filter, so that the result is linear in the samples.
SmoothOptions fixed(int order = 4, double cutoff_hz = 6.0) {
  return {.method = FilterMethod::kalman, .order = order, .cutoff_hz = cutoff_hz, .noise_sd_m = 0.001};
}

TEST(SmoothKalman, PolynomialsBelowItsOrderPassWithAllTheirDerivatives) {
  for (const int order : {2, 3, 4, 5}) {
    const auto derivative = [&](std::int64_t f, int d) {
      const double t = 0.01 * static_cast<double>(f);
      Vector3d sum = Vector3d::Zero();
      for (int power = d; power < order; ++power) {
        double factor = std::pow(t, power - d);
        for (int k = 0; k < d; ++k) factor *= power - k;
        sum += factor * Vector3d(1.0, -0.5 * power, 0.2 + power);
      }
      return sum;
    };
    const auto r = smoothed(marker_of(150, [&](std::int64_t f) { return derivative(f, 0); }), fixed(order));
    for (std::int64_t f = 0; f < 150; ++f) {
      EXPECT_LT((row(r.x, f) - derivative(f, 0)).norm(), 1e-6) << order << " " << f;
      EXPECT_LT((row(r.velocity, f) - derivative(f, 1)).norm(), 1e-4) << order << " " << f;
      if (order > 2) {
        EXPECT_LT((row(r.acceleration, f) - derivative(f, 2)).norm(), 1e-2) << order << " " << f;
      }
    }
  }
}

TEST(SmoothKalman, IsLinearWhenTheFilterIsGiven) {
  const Trajectories a = noisy_path(120, 1, 0.01), b = noisy_path(120, 2, 0.02);
  const Trajectories both =
      marker_of(120, [&](std::int64_t f) { return Vector3d(2.0 * a.x(f, 0) - 3.0 * b.x(f, 0)); });
  const auto ra = smoothed(a, fixed()), rb = smoothed(b, fixed()), r = smoothed(both, fixed());
  for (std::int64_t f = 0; f < 120; ++f) {
    EXPECT_LT((row(r.x, f) - 2.0 * row(ra.x, f) + 3.0 * row(rb.x, f)).norm(), 1e-9) << f;
    EXPECT_LT((row(r.acceleration, f) - 2.0 * row(ra.acceleration, f) + 3.0 * row(rb.acceleration, f)).norm(),
              1e-5);
  }
}

TEST(SmoothKalman, EachDerivativeIsThatOfTheOneBefore) {
  const auto r = smoothed(noisy_path(400, 3), fixed(5, 4.0));
  const Array<double>* const chain[] = {&r.x, &r.velocity, &r.acceleration};
  const Array<double>* const next[] = {&r.velocity, &r.acceleration, &r.jerk};
  for (int d = 0; d < 3; ++d) {
    double largest = 0.0, off = 0.0;
    for (std::int64_t f = 1; f + 1 < 400; ++f) {
      largest = std::max(largest, row(*next[d], f).norm());
      off = std::max(off, ((row(*chain[d], f + 1) - row(*chain[d], f - 1)) / 0.02 - row(*next[d], f)).norm());
    }
    EXPECT_LT(off, 0.02 * largest) << d;
  }
}

TEST(SmoothKalman, PlayedBackwardsItIsTheSamePath) {
  const Trajectories t = noisy_path(150, 5);
  const auto forth = smoothed(t, fixed());
  const auto back =
      smoothed(marker_of(150, [&](std::int64_t f) { return Vector3d(t.x(149 - f, 0)); }), fixed());
  for (std::int64_t f = 0; f < 150; ++f) {
    EXPECT_LT((row(forth.x, f) - row(back.x, 149 - f)).norm(), 1e-9) << f;
    EXPECT_LT((row(forth.velocity, f) + row(back.velocity, 149 - f)).norm(), 1e-7) << f;
    EXPECT_LT((row(forth.acceleration, f) - row(back.acceleration, 149 - f)).norm(), 1e-5) << f;
    // Beside the ends the bars are scaled by stretches hidden from the start on: those differ.
    if (f >= 40 && f < 110) {
      EXPECT_NEAR(forth.covariance[static_cast<std::size_t>(6 * f)] /
                      back.covariance[static_cast<std::size_t>(6 * (149 - f))],
                  1.0, 1e-6);
    }
  }
}

TEST(SmoothKalman, BarsAreWhatTheSmoothedNoiseDoes) {
  // White noise about nothing, many times over: its spread behind the filter against the bars.
  SmoothOptions options = fixed(3, 8.0);
  options.noise_sd_m = 0.002;
  Eigen::Vector3d position = Vector3d::Zero(), velocity = Vector3d::Zero();
  double position_bar = 0.0, velocity_bar = 0.0;
  constexpr int kTrials = 60;
  for (std::uint64_t seed = 1; seed <= kTrials; ++seed) {
    Random random(seed, 6);
    const auto r =
        smoothed(marker_of(200, [&](std::int64_t) { return Vector3d(0.002 * noise(random)); }), options);
    for (const std::int64_t f : {60, 100, 140}) {
      position += row(r.x, f).cwiseAbs2() / (3.0 * kTrials);
      velocity += row(r.velocity, f).cwiseAbs2() / (3.0 * kTrials);
      position_bar += r.covariance[static_cast<std::size_t>(6 * f)] / (3.0 * kTrials);
      velocity_bar += std::pow(r.velocity_sd[static_cast<std::size_t>(3 * f)], 2) / (3.0 * kTrials);
    }
  }
  // The bars hold what the filter may have taken from a movement, too: never less than the noise alone.
  EXPECT_GT(std::sqrt(position_bar / position.mean()), 0.8);
  EXPECT_LT(std::sqrt(position_bar / position.mean()), 1.5);
  EXPECT_GT(std::sqrt(velocity_bar / velocity.mean()), 0.8);
  EXPECT_LT(std::sqrt(velocity_bar / velocity.mean()), 1.8);
}

TEST(SmoothKalman, KeepsTheCorrelationOfTheSamples) {
  Trajectories t = noisy_path(100, 7);
  t.covariance.assign(600, 0.0);
  for (std::size_t f = 0; f < 100; ++f) {
    double* c = t.covariance.data() + 6 * f;
    c[0] = 1e-6, c[3] = 4e-6, c[5] = 9e-6;
    c[1] = 0.5 * 2e-6, c[2] = -0.25 * 3e-6, c[4] = 0.75 * 6e-6;
  }
  const auto r = smoothed(t, {.method = FilterMethod::kalman});
  for (std::size_t f = 0; f < 100; ++f) {
    const double* c = r.covariance.data() + 6 * f;
    EXPECT_NEAR(c[1] / std::sqrt(c[0] * c[3]), 0.5, 1e-9) << f;
    EXPECT_NEAR(c[2] / std::sqrt(c[0] * c[5]), -0.25, 1e-9) << f;
    EXPECT_NEAR(c[4] / std::sqrt(c[3] * c[5]), 0.75, 1e-9) << f;
    EXPECT_LT(c[0], c[3]);
    EXPECT_LT(c[3], c[5]) << "the axes keep their order";
  }
}

TEST(SmoothKalman, BridgesOnlyWhatLiesBetweenSamplesAndIsShortAndSureEnough) {
  Trajectories t = noisy_path(200, 8);
  for (const auto& [first, end] :
       {std::pair<std::int64_t, std::int64_t>{0, 4}, {50, 55}, {100, 130}, {198, 200}})
    for (std::int64_t f = first; f < end; ++f) t.set_missing(f, 0);
  SmoothOptions options = fixed();
  options.max_bridge_s = 0.1;
  options.max_bridge_sd_m = 1.0;
  const auto check = [&](const MarkerResult& r, std::int64_t bridged) {
    EXPECT_EQ(r.account.bridged, bridged);
    EXPECT_EQ(r.account.bridged + r.account.left_missing, 4 + 5 + 30 + 2);
    for (std::int64_t f = 0; f < 200; ++f) {
      const bool there = t.present(f, 0) || (bridged > 0 && f >= 50 && f < 55);
      EXPECT_EQ(row(r.x, f).array().isFinite().all(), there) << f;
      EXPECT_EQ(row(r.jerk, f).array().isFinite().all(), there) << f;
      EXPECT_EQ(std::isfinite(r.covariance[static_cast<std::size_t>(6 * f + 1)]), there) << f;
      if (!t.present(f, 0) && there) {
        EXPECT_EQ(r.state[static_cast<std::size_t>(f)], SampleState::interpolated);
      }
    }
  };
  check(smoothed(t, options), 5);
  options.max_bridge_sd_m = 1e-9;
  check(smoothed(t, options), 0);
  options.max_bridge_sd_m = 1.0;
  options.max_bridge_s = 0.04;
  check(smoothed(t, options), 0);
}

/// A tremor of 4 mm and 6 Hz in noise of 0.1 mm; with `gap` > 0 so many samples are missing in every 150.
Trajectories gappy_tremor(std::int64_t gap, std::uint64_t seed) {
  Random random(seed, 11);
  Trajectories t = marker_of(600, [&](std::int64_t f) {
    const double phase = 2.0 * M_PI * 6.0 * 0.01 * static_cast<double>(f);
    return Vector3d(Vector3d(std::sin(phase), std::sin(phase + 1.0), std::sin(phase + 2.0)) * 4e-3 +
                    1e-4 * noise(random));
  });
  for (std::int64_t at = 70; at + gap < 600; at += 150)
    for (std::int64_t f = at; f < at + gap; ++f) t.set_missing(f, 0);
  return t;
}

TEST(SmoothKalman, SaysWhichGapsHiddenStretchesCorrected) {
  SmoothOptions options{.method = FilterMethod::kalman};
  options.max_bridge_s = 1.0;
  options.max_bridge_sd_m = 1.0;
  const std::string sentence = "4 gaps are corrected by what ";
  const auto said = smoothed(gappy_tremor(16, 1), options);
  EXPECT_NE(said.account.description.find(sentence), std::string::npos) << said.account.description;
  EXPECT_TRUE(said.account.description.contains("% of the error in velocity or less is left"));
  const auto whole = smoothed(gappy_tremor(0, 1), options);
  EXPECT_EQ(whole.account.description.find("corrected"), std::string::npos) << "no gaps";
  EXPECT_FALSE(whole.account.description.contains("% of the error in velocity or less is left"));
  const auto open = smoothed(gappy_tremor(16, 1), {.method = FilterMethod::kalman});
  EXPECT_EQ(open.account.description.find("corrected"), std::string::npos) << "none is bridged";
  options.cutoff_hz = 9.0;
  const auto asked = smoothed(gappy_tremor(16, 1), options);
  EXPECT_EQ(asked.account.description.find("corrected"), std::string::npos) << "the filter as asked";
}

TEST(SmoothKalman, BarsInCorrectedGapsAreWhatIsLeftOfTheError) {
  SmoothOptions options{.method = FilterMethod::kalman};
  options.max_bridge_s = 1.0;
  options.max_bridge_sd_m = 1.0;
  double inside_1 = 0.0, inside_2 = 0.0, count = 0.0, bar = 0.0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const Trajectories in = gappy_tremor(16, seed);
    const auto r = smoothed(in, options);
    for (std::int64_t f = 0; f < 600; ++f) {
      if (in.present(f, 0)) continue;
      const double phase = 2.0 * M_PI * 6.0 * 0.01 * static_cast<double>(f);
      const double speed = 4e-3 * 2.0 * M_PI * 6.0 * std::cos(phase);
      const double sd = r.velocity_sd[static_cast<std::size_t>(3 * f)];
      const double z = std::abs(row(r.velocity, f).x() - speed) / sd;
      inside_1 += z < 1.0 ? 1.0 : 0.0;
      inside_2 += z < 2.0 ? 1.0 : 0.0;
      bar += sd;
      count += 1.0;
    }
  }
  EXPECT_GT(inside_1 / count, 0.55);
  EXPECT_LT(inside_1 / count, 0.90);
  EXPECT_GT(inside_2 / count, 0.85);
  EXPECT_LT(bar / count, 0.02) << "an eighth of the tremor's speed";
}

TEST(SmoothKalman, SaysWhatItChoseAndWhatItWasGiven) {
  const auto asked = smoothed(noisy_path(200, 9), fixed(4, 6.0));
  EXPECT_EQ(asked.account.description, "order 4, cut-off 6 Hz: as asked.");
  EXPECT_EQ(asked.account.used.order, 4);
  EXPECT_EQ(asked.account.used.cutoff_hz, 6.0);
  EXPECT_EQ(asked.account.noise_from, "given");
  const auto chosen = smoothed(noisy_path(200, 9), {.method = FilterMethod::kalman});
  EXPECT_EQ(chosen.account.noise_from, "data");
  EXPECT_NEAR(chosen.account.used.noise_sd_m / 0.001, 1.0, 0.2);
  EXPECT_EQ(chosen.account.criterion_name, "SURE, m^2");
  EXPECT_FALSE(chosen.account.description.contains(": as asked."));
  EXPECT_TRUE(chosen.account.description.contains(" Hz, moved towards the best for velocities"))
      << chosen.account.description;
  EXPECT_FALSE(chosen.account.description.contains("samples are too few to choose by."));
  EXPECT_FALSE(asked.account.description.contains("all orders and cut-offs tried"));
  EXPECT_FALSE(asked.account.description.contains("Hz, moved towards the best for velocities"));
  // What was left to choose is what is said to have been tried.
  const auto order = smoothed(noisy_path(200, 9), {.method = FilterMethod::kalman, .order = 4})
                         .account.description,
             cut_off = smoothed(noisy_path(200, 9), {.method = FilterMethod::kalman, .cutoff_hz = 6.0})
                           .account.description;
  EXPECT_TRUE(order.contains("of all cut-offs tried at this order")) << order;
  EXPECT_FALSE(order.contains("all orders tried at this cut-off"));
  EXPECT_TRUE(cut_off.contains("all orders tried at this cut-off") ||
              cut_off.contains("too little to give up jerk"))
      << cut_off;
  EXPECT_FALSE(cut_off.contains("all cut-offs tried at this order"));
  const auto few = smoothed(noisy_path(3, 9), {.method = FilterMethod::kalman});
  EXPECT_NE(few.account.description.find("3 samples are too few to choose by"), std::string::npos);
  EXPECT_TRUE(few.account.criterion_name.empty());
  for (std::int64_t f = 0; f < 3; ++f) EXPECT_TRUE(row(few.x, f).allFinite());
}

}  // namespace
}  // namespace kinemark::trajectory::smoothing
