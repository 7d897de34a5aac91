// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/smoothing/smooth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/math/symmetric3.h"

namespace kinemark::trajectory {
namespace {

using data::SampleState;
using data::Trajectories;
using ::testing::HasSubstr;

constexpr double kNoiseSd_m = 0.0005;

Eigen::Vector3d position(double t, int derivative) {
  Eigen::Vector3d p;
  for (int axis = 0; axis < 3; ++axis) {
    const double w = 2.0 * M_PI * (0.8 + 0.4 * axis);
    p[axis] = 0.2 * std::pow(w, derivative) * std::sin(w * t + axis + derivative * M_PI / 2.0);
  }
  return p;
}

/// A hand that goes round, seen with noise.
Trajectories hand(int frames = 400, double rate_hz = 100.0, std::uint64_t seed = 1, int markers = 1) {
  std::vector<std::string> names;
  for (int m = 0; m < markers; ++m) names.push_back("M" + std::to_string(m));
  Trajectories t = Trajectories::all_missing(names, {rate_hz, 2.0, frames});
  for (int m = 0; m < markers; ++m) {
    Random random(seed, static_cast<std::uint64_t>(m));
    for (int f = 0; f < frames; ++f) {
      Eigen::Vector3d x = position(f / rate_hz, 0);
      for (int axis = 0; axis < 3; ++axis) x[axis] += kNoiseSd_m * random.gaussian();
      t.x(f, m) = x;
      t.state[t.index(f, m)] = SampleState::measured;
    }
  }
  return t;
}

void hide(Trajectories& t, int begin, int end, int marker = 0) {
  for (int f = begin; f < end; ++f) t.set_missing(f, marker);
}

double rms_error(const Array<double>& values, int derivative, double rate_hz) {
  double sum = 0.0, count = 0.0;
  for (std::size_t i = 0; i < values.size() / 3; ++i) {
    if (std::isnan(values[3 * i])) continue;
    sum += (Eigen::Map<const Eigen::Vector3d>(values.data() + 3 * i) -
            position(static_cast<double>(i) / rate_hz, derivative))
               .squaredNorm();
    count += 3.0;
  }
  return std::sqrt(sum / count);
}

TEST(Smooth, FindsTheMovementItsDerivativesAndTheNoise) {
  const Trajectories in = hand();
  const auto result = smooth(in);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(result->trajectories.validate());
  EXPECT_TRUE(result->derivatives.validate(result->trajectories));
  EXPECT_LT(rms_error(result->trajectories.x_in_world, 0, 100.0), 0.4 * kNoiseSd_m);
  EXPECT_LT(rms_error(result->derivatives.velocity, 1, 100.0), 0.008);
  EXPECT_LT(rms_error(result->derivatives.acceleration, 2, 100.0), 0.35);
  const data::MarkerAccount& account = result->markers.front();
  EXPECT_NEAR(account.used.noise_sd_m, kNoiseSd_m, 0.1 * kNoiseSd_m);
  EXPECT_EQ(account.used.method, "kalman");
  EXPECT_EQ(account.candidates.size(), 4u);
  EXPECT_TRUE(account.judged());
  EXPECT_FALSE(account.coloured());
  EXPECT_THAT(account.description, HasSubstr("is consistent with white noise"));
  EXPECT_EQ(account.measured, 400);
  EXPECT_THAT(account.description, HasSubstr("SURE"));
}

SmoothOptions with(FilterMethod method) {
  SmoothOptions options;
  options.method = method;
  return options;
}

constexpr FilterMethod kAll[] = {FilterMethod::none, FilterMethod::kalman, FilterMethod::butterworth,
                                 FilterMethod::gcv,  FilterMethod::savgol, FilterMethod::classic};

TEST(Smooth, EveryMethodFollowsTheMovement) {
  const Trajectories in = hand();
  for (const FilterMethod method : kAll) {
    const auto result = smooth(in, with(method));
    ASSERT_TRUE(result) << to_string(method);
    EXPECT_TRUE(result->trajectories.validate());
    EXPECT_LT(rms_error(result->derivatives.velocity, 1, 100.0), method == FilterMethod::none ? 0.08 : 0.03)
        << to_string(method);
    EXPECT_EQ(result->derivatives.filters.front().method, to_string(method));
    EXPECT_FALSE(result->markers.front().description.empty());
  }
}

TEST(Smooth, WhatIsLeftAloneStaysAsItIs) {
  const Trajectories in = hand(400, 100.0, 1, 2);
  auto options = with(FilterMethod::kalman);
  options.leave = {1};
  const auto result = smooth(in, options).value();
  for (int f = 0; f < 400; ++f) ASSERT_EQ(result.trajectories.x(f, 1), in.x(f, 1));
  EXPECT_NE(result.trajectories.x(50, 0), in.x(50, 0));
  EXPECT_EQ(result.markers[0].used.method, "kalman");
  EXPECT_EQ(result.markers[1].used.method, "none");
}

TEST(Smooth, WhatIsMissingStaysMissingAndSpoilsNoNeighbour) {
  Trajectories in = hand();
  hide(in, 0, 5);
  hide(in, 100, 120);
  hide(in, 200, 201);
  hide(in, 390, 400);
  for (const FilterMethod method : kAll) {
    const auto result = smooth(in, with(method));
    ASSERT_TRUE(result);
    for (int f = 0; f < 400; ++f) {
      EXPECT_EQ(result->trajectories.state[static_cast<std::size_t>(f)],
                in.state[static_cast<std::size_t>(f)]);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t i = static_cast<std::size_t>(f) * 3 + axis;
        const bool there = in.present(f, 0);
        EXPECT_EQ(std::isfinite(result->trajectories.x_in_world[i]), there) << to_string(method) << " " << f;
        EXPECT_EQ(std::isfinite(result->derivatives.velocity[i]), there) << to_string(method) << " " << f;
        EXPECT_EQ(std::isfinite(result->derivatives.acceleration[i]), there) << to_string(method) << " " << f;
      }
    }
    EXPECT_EQ(result->markers.front().left_missing, 36);
    for (int f = 0; f < 400; ++f)
      EXPECT_EQ(result->trajectories.made_by(f, 0), in.present(f, 0) && method != FilterMethod::none
                                                        ? "smoothed by " + std::string(to_string(method))
                                                        : "");
  }
}

TEST(Smooth, BridgesWhatIsAskedAndCertainEnough) {
  Trajectories in = hand();
  hide(in, 0, 5);
  hide(in, 100, 106);
  hide(in, 200, 260);
  SmoothOptions options;
  options.max_bridge_s = 0.1;
  const auto result = smooth(in, options);
  ASSERT_TRUE(result);
  for (int f = 100; f < 106; ++f) {
    EXPECT_EQ(result->trajectories.state[static_cast<std::size_t>(f)], SampleState::interpolated);
    EXPECT_EQ(result->trajectories.made_by(f, 0), "kalman");
    EXPECT_LT((result->trajectories.x(f, 0) - position(f / 100.0, 0)).norm(), 0.003);
  }
  EXPECT_FALSE(result->trajectories.present(2, 0));
  EXPECT_FALSE(result->trajectories.present(230, 0));
  EXPECT_EQ(result->markers.front().bridged, 6);
  EXPECT_EQ(result->markers.front().left_missing, 65);
  EXPECT_GT(result->trajectories.covariance[6 * 103], result->trajectories.covariance[6 * 50]);
  options.max_bridge_sd_m = 1e-6;
  EXPECT_FALSE(smooth(in, options)->trajectories.present(103, 0));
}

TEST(Smooth, ErrorBarsKeepTheirWord) {
  double one[3] = {}, two[3] = {}, total[3] = {};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    const auto result = smooth(hand(400, 100.0, seed)).value();
    const Array<double>* values[3] = {&result.trajectories.x_in_world, &result.derivatives.velocity,
                                      &result.derivatives.acceleration};
    const Array<double>* sds[3] = {nullptr, &result.derivatives.velocity_sd,
                                   &result.derivatives.acceleration_sd};
    for (std::size_t i = 0; i < 1200; ++i) {
      const std::size_t frame = i / 3;
      for (int d = 0; d < 3; ++d) {
        const double truth = position(static_cast<double>(frame) / 100.0, d)[static_cast<int>(i % 3)];
        const double sd =
            d == 0 ? std::sqrt(result.trajectories.covariance[6 * (i / 3) + math::kSymmetric3Diagonal[i % 3]])
                   : (*sds[d])[i];
        const double z = std::abs((*values[d])[i] - truth) / sd;
        one[d] += z <= 1.0;
        two[d] += z <= 2.0;
        total[d] += 1.0;
      }
    }
  }
  for (int d = 0; d < 3; ++d) {
    EXPECT_GT(one[d] / total[d], 0.60) << d;
    EXPECT_LT(one[d] / total[d], 0.82) << d;
    EXPECT_GT(two[d] / total[d], 0.92) << d;
  }
}

TEST(Smooth, TurnsWithTheLab) {
  // The same gains for all axes: a rotated recording gives the rotated result.
  Trajectories in = hand(), rotated = in;
  Eigen::Matrix3d r;
  r << 0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6;
  for (int f = 0; f < 400; ++f) rotated.x(f, 0) = r * in.x(f, 0);
  const auto a = smooth(in).value(), b = smooth(rotated).value();
  for (std::size_t f = 0; f < 400; ++f) {
    const Eigen::Vector3d v = Eigen::Map<const Eigen::Vector3d>(a.derivatives.acceleration.data() + 3 * f);
    EXPECT_LT((Eigen::Map<const Eigen::Vector3d>(b.derivatives.acceleration.data() + 3 * f) - r * v).norm(),
              1e-5);
  }
}

TEST(Smooth, CovariancesWeighTheSamples) {
  // Every third sample is ten times as uncertain, and wrong by as much: knowing so must help, axis by axis.
  Trajectories in = hand();
  in.covariance.assign(6 * 400, 0.0);
  Random random(9, 9);
  for (int f = 0; f < 400; ++f) {
    for (int axis = 0; axis < 3; ++axis) {
      const double sd = f % 3 == axis ? 10.0 * kNoiseSd_m : kNoiseSd_m;
      if (f % 3 == axis) in.x_in_world[static_cast<std::size_t>(3 * f + axis)] += sd * random.gaussian();
      in.covariance[at(6 * f) + math::kSymmetric3Diagonal[at(axis)]] = sd * sd;
    }
  }
  Trajectories ignorant = in;
  ignorant.covariance.clear();
  const auto with_weights = smooth(in).value(), without = smooth(ignorant).value();
  EXPECT_LT(rms_error(with_weights.derivatives.velocity, 1, 100.0),
            0.6 * rms_error(without.derivatives.velocity, 1, 100.0));
  EXPECT_NEAR(with_weights.markers.front().used.noise_sd_m, kNoiseSd_m, 0.15 * kNoiseSd_m);
}

TEST(Smooth, SamplesAreSmoothedAtTheirOwnTimes) {
  Trajectories in = hand();
  in.sample_offset_s.resize(400);
  Random random(3, 1);
  for (int f = 0; f < 400; ++f) {
    const double offset = random.uniform(-0.004, 0.004);
    in.sample_offset_s[static_cast<std::size_t>(f)] = offset;
    in.x(f, 0) = position(f / 100.0 + offset, 0);
  }
  SmoothOptions options;
  options.noise_sd_m = 1e-5;
  const auto result = smooth(in, options).value();
  for (int f = 20; f < 380; ++f) {
    const double t = f / 100.0 + in.sample_offset_s[static_cast<std::size_t>(f)];
    EXPECT_LT((Eigen::Map<const Eigen::Vector3d>(result.derivatives.velocity.data() + 3 * f) - position(t, 1))
                  .norm(),
              0.01);
  }
  EXPECT_EQ(result.trajectories.sample_offset_s, in.sample_offset_s);
  const auto refused = smooth(in, with(FilterMethod::butterworth));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::not_supported);
  EXPECT_THAT(refused.error().message, HasSubstr("use kalman"));
}

TEST(Smooth, TimesThatDoNotRiseAreAnError) {
  for (const double shift : {-0.02, -0.01}) {  // backwards, and the same instant again
    Trajectories in = hand();
    in.sample_offset_s.assign(400, 0.0);
    in.sample_offset_s[200] = shift;
    for (const FilterMethod method : kAll) {
      const auto result = smooth(in, with(method));
      ASSERT_FALSE(result);
      EXPECT_EQ(result.error().code, Code::bad_input);
      EXPECT_THAT(result.error().message, HasSubstr("'M0'"));
      EXPECT_THAT(result.error().message, HasSubstr("must rise"));
    }
  }
}

TEST(Smooth, MarkersSeenOnceOrNever) {
  for (const FilterMethod method : kAll) {
    Trajectories in = Trajectories::all_missing({"never", "once", "twice"}, {100.0, 0.0, 50});
    for (const auto& [frame, marker] : {std::pair{20, 1}, std::pair{3, 2}, std::pair{4, 2}}) {
      in.x(frame, marker) = Eigen::Vector3d(0.1, 0.2, 0.3);
      in.state[in.index(frame, marker)] = SampleState::measured;
    }
    const auto result = smooth(in, with(method));
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_TRUE(result->trajectories.validate());
    EXPECT_EQ(result->trajectories.count_missing(), in.count_missing());
    EXPECT_NEAR(result->trajectories.x(20, 1).y(), 0.2, 1e-9);
    EXPECT_TRUE(std::isnan(result->derivatives.velocity[3 * in.index(20, 1)])) << to_string(method);
    EXPECT_EQ(result->markers[0].measured, 0);
  }
  EXPECT_TRUE(smooth(Trajectories::all_missing({"A"}, {100.0, 0.0, 0})));
  EXPECT_TRUE(smooth(Trajectories::all_missing({}, {100.0, 0.0, 10})));
}

TEST(Smooth, AMarkerAtRestStaysAtRest) {
  Trajectories in = hand();
  for (int f = 0; f < 400; ++f) in.x(f, 0) = Eigen::Vector3d(1.0, -2.0, 0.5);
  for (const FilterMethod method : kAll) {
    const auto result = smooth(in, with(method));
    ASSERT_TRUE(result);
    for (std::size_t i = 0; i < 1200; ++i) {
      EXPECT_NEAR(result->trajectories.x_in_world[i], in.x_in_world[i], 1e-9) << to_string(method);
      EXPECT_NEAR(result->derivatives.velocity[i], 0.0, 1e-6) << to_string(method);
      EXPECT_NEAR(result->derivatives.acceleration[i], 0.0, 1e-4) << to_string(method);
    }
    if (method != FilterMethod::none) {
      EXPECT_LT(result->markers.front().used.noise_sd_m, 1e-9) << to_string(method);
    }
  }
}

TEST(Smooth, InfiniteCoordinatesAreAnError) {
  Trajectories in = hand();
  in.x(7, 0).x() = HUGE_VAL;
  const auto result = smooth(in);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Code::bad_input);
  EXPECT_THAT(result.error().message, HasSubstr("frame 7"));
}

TEST(Smooth, VariancesOfNothingAreCountedAndReplaced) {
  Trajectories in = hand();
  in.covariance.assign(6 * 400, 0.0);
  for (std::size_t f = 0; f < 400; ++f)
    for (const std::size_t d : math::kSymmetric3Diagonal) in.covariance[6 * f + d] = kNoiseSd_m * kNoiseSd_m;
  in.covariance[6 * 10] = 0.0;
  in.covariance[6 * 20 + 3] = -1.0;
  in.covariance[6 * 30 + 5] = HUGE_VAL;
  in.covariance[6 * 40] = std::nan("");
  const auto result = smooth(in);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->markers.front().bad_variances, 4);
  EXPECT_LT(rms_error(result->derivatives.velocity, 1, 100.0), 0.008);
  in.covariance.assign(6 * 400, 0.0);
  EXPECT_TRUE(smooth(in));  // all of them: as if there were none
}

TEST(Smooth, OptionsOutOfRangeAreAnError) {
  SmoothOptions options;
  options.cutoff_hz = 60.0;
  const auto result = smooth(hand(), options);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Code::usage);
  EXPECT_THAT(result.error().message, HasSubstr("half of the rate"));
}

TEST(Smooth, AnyNumberOfThreadsGivesTheSameBits) {
  const Trajectories in = hand(200, 100.0, 4, 5);
  SmoothOptions one, three;
  three.threads = 3;
  const auto a = smooth(in, one).value(), b = smooth(in, three).value();
  EXPECT_EQ(a.trajectories.x_in_world, b.trajectories.x_in_world);
  EXPECT_EQ(a.derivatives.jerk_sd, b.derivatives.jerk_sd);
  EXPECT_EQ(b.markers[3].name, "M3");
}

TEST(Smooth, StopsWhenAsked) {
  SmoothOptions options;
  options.progress = [](std::int64_t done, std::int64_t total) {
    EXPECT_EQ(total, 3);
    return done < 2;
  };
  const auto result = smooth(hand(60, 100.0, 1, 3), options);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Code::cancelled);
}

TEST(Smooth, ASinkThatFailsEndsTheWork) {
  int calls = 0;
  const auto status = smooth_each(hand(60, 100.0, 1, 3), {}, [&](MarkerResult&& one) -> Status {
    EXPECT_EQ(one.marker, calls);
    return ++calls < 2 ? Status{} : fail(Code::io, "disk full");
  });
  ASSERT_FALSE(status);
  EXPECT_EQ(status.error().message, "disk full");
  EXPECT_EQ(calls, 2);
}

TEST(Smooth, FilledStretchesCountAsOneObservation) {
  // A guess of an earlier stage, 40 frames of it and wrong by 30 mm: what was measured next to it hardly
  // notices.
  Trajectories in = hand();
  for (int f = 100; f < 140; ++f) {
    in.x(f, 0).x() += 0.03;
    in.state[in.index(f, 0)] = SampleState::interpolated;
    in.set_method(f, 0, "cubic");
  }
  in.covariance.assign(6 * 400, 0.0);
  for (int f = 0; f < 400; ++f)
    for (const std::size_t d : math::kSymmetric3Diagonal)
      in.covariance[at(6 * f) + d] = f >= 100 && f < 140 ? 4e-4 : kNoiseSd_m * kNoiseSd_m;
  const auto result = smooth(in).value();
  EXPECT_EQ(result.trajectories.made_by(120, 0), "cubic");
  EXPECT_EQ(result.trajectories.state[120], SampleState::interpolated);
  EXPECT_LT((result.trajectories.x(97, 0) - position(0.97, 0)).norm(), 3.0 * kNoiseSd_m);
  EXPECT_EQ(result.markers.front().measured, 360);
}

TEST(Smooth, SamplesThatAreWorthNextToNothingStandAsTheyAre) {
  // A filled second of 1 m of uncertainty among samples of micrometres: nothing reaches its middle.
  Trajectories in = hand();
  in.covariance.assign(6 * 400, 0.0);
  for (int f = 0; f < 400; ++f) {
    const bool filled = f >= 100 && f < 200;
    if (filled) {
      in.state[in.index(f, 0)] = SampleState::model_filled;
      in.set_method(f, 0, "auto");
    }
    for (const std::size_t d : math::kSymmetric3Diagonal) in.covariance[at(6 * f) + d] = filled ? 1.0 : 1e-12;
  }
  const auto result = smooth(in, {.order = 5, .cutoff_hz = 40.0}).value();
  ASSERT_TRUE(result.trajectories.validate()) << "present samples have coordinates";
  EXPECT_EQ(result.trajectories.state[150], SampleState::model_filled);
  EXPECT_EQ(result.trajectories.x(150, 0), in.x(150, 0));
  EXPECT_GT(std::sqrt(result.trajectories.covariance[6 * 150]), 0.1);
  EXPECT_TRUE(std::isnan(result.derivatives.velocity[3 * 150])) << "what is not determined is not given";
}

TEST(Smooth, ColouredNoiseIsDistinguishedFromWhite) {
  Trajectories in = hand(2000);
  Random random(8, 8);
  double wander = 0.0;
  for (int f = 0; f < 2000; ++f) {
    wander = 0.9 * wander + kNoiseSd_m * random.gaussian();
    in.x(f, 0) = position(f / 100.0, 0) + Eigen::Vector3d::Constant(wander);
  }
  SmoothOptions options;
  options.order = 4;
  options.cutoff_hz = 4.0;
  const auto result = smooth(in, options).value();
  const data::MarkerAccount& account = result.markers.front();
  EXPECT_TRUE(account.coloured());
  EXPECT_LT(account.white_p, 1e-6);
  EXPECT_GT(account.white_departure, 0.1);
  EXPECT_THAT(account.description, HasSubstr("not white"));
  EXPECT_THAT(account.description, HasSubstr("too low in frequency"));
}

TEST(Smooth, TheSpectrumHasThePowerOfTheNoise) {
  const auto result = smooth(hand(2000)).value();
  const data::Spectrum& spectrum = result.markers.front().spectrum;
  ASSERT_GT(spectrum.frequency_hz.size(), 10u);
  // White noise of variance s^2 per axis: s^2 / (rate / 2) per Hz, three axes.
  const double expected = 3.0 * kNoiseSd_m * kNoiseSd_m / 50.0;
  double sum = 0.0;
  for (std::size_t i = spectrum.frequency_hz.size() - 4; i < spectrum.frequency_hz.size(); ++i)
    sum += spectrum.raw_m2_per_hz[i] / 4.0;
  EXPECT_NEAR(sum / expected, 1.0, 0.35);
}

// A gap that was filled with an error of 1.5 mm all along, and says so: no filter may know better.
TEST(Smooth, AFillKeepsItsStandardDeviation) {
  auto t = hand();
  t.covariance.assign(2 * t.x_in_world.size(), 0.0);
  for (int f = 0; f < 400; ++f) {
    const bool filled = f >= 200 && f < 220;
    math::pack_isotropic3(std::pow(filled ? 0.0015 : kNoiseSd_m, 2), t.covariance.data() + 6 * t.index(f, 0));
    if (!filled) continue;
    for (int axis = 0; axis < 3; ++axis) t.x(f, 0)[axis] += 0.0015;
    t.state[t.index(f, 0)] = SampleState::model_filled;
  }
  for (const auto method : {FilterMethod::none, FilterMethod::kalman, FilterMethod::gcv, FilterMethod::savgol,
                            FilterMethod::butterworth, FilterMethod::classic}) {
    SmoothOptions options;
    options.method = method;
    const auto found = smooth(t, options);
    ASSERT_TRUE(found) << found.error().message;
    const auto& smoothed = found->trajectories;
    ASSERT_FALSE(smoothed.covariance.empty()) << to_string(method);
    for (int f = 200; f < 220; ++f)
      for (const auto d : math::kSymmetric3Diagonal)
        EXPECT_GE(std::sqrt(smoothed.covariance[6 * smoothed.index(f, 0) + d]), 0.0015 * (1.0 - 1e-12))
            << to_string(method) << ", frame " << f;
    EXPECT_LT(std::sqrt(smoothed.covariance[6 * smoothed.index(100, 0)]), 1.01 * kNoiseSd_m)
        << "what was measured is as before";
    if (method != FilterMethod::kalman) continue;
    const auto& sd = found->derivatives.velocity_sd;
    EXPECT_GT(sd[at(3 * 210)], 2.0 * sd[at(3 * 100)]);
  }
}

}  // namespace
}  // namespace kinemark::trajectory
