// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/timing.h"

#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/analysis/path/path_facts.h"
#include "kinemark/stages/analysis/path/testing/known_path.h"

namespace kinemark::analysis {
namespace {

using testing::kTurn;

constexpr double kBegin_s = 0.5, kReach_s = 0.7;
// Where 30 u^2 (1-u)^2 = 0.05 x 1.875: u (1-u) = sqrt(0.003125).
const double kCrossing = 0.5 - std::sqrt(0.25 - std::sqrt(0.003125));

Eigen::VectorXd reach_speed(double rate_hz, double begin_s = kBegin_s) {
  const auto n = static_cast<std::int64_t>(1.7 * rate_hz);
  Eigen::VectorXd out(n);
  for (std::int64_t i = 0; i < n; ++i)
    out[i] = testing::minimum_jerk_speed((static_cast<double>(i) / rate_hz - begin_s) / kReach_s);
  return out;
}
PathSamples reach_path(double rate_hz, double begin_s = kBegin_s) {
  const Eigen::VectorXd speed = reach_speed(rate_hz, begin_s);
  Eigen::VectorXd acceleration(speed.size());
  for (Eigen::Index i = 0; i < speed.size(); ++i)
    acceleration[i] =
        testing::minimum_jerk_acceleration((static_cast<double>(i) / rate_hz - begin_s) / kReach_s) /
        kReach_s;
  return testing::straight_way(rate_hz, speed, acceleration);
}
MovementWindow window_of(const PathSamples& path) { return movement_window(path, speed_of(path)); }

TEST(MovementWindow, CrossesATwentiethOfThePeak) {
  const auto window = window_of(reach_path(1000.0));
  EXPECT_NEAR(window.onset_s, 0.5 + 0.7 * kCrossing, 1e-5);
  EXPECT_NEAR(window.end_s, 1.2 - 0.7 * kCrossing, 1e-5);
}

TEST(MovementWindow, FollowsTheCurveBetweenSlowSamples) {
  // Straight lines between samples at 25 Hz are up to 4 ms early at the onset and late at the end.
  for (const double rate_hz : {25.0, 50.0})
    for (int k = 0; k < 8; ++k) {
      const double begin_s = kBegin_s + 0.125 * k / rate_hz;
      const auto path = reach_path(rate_hz, begin_s);
      const auto window = window_of(path);
      EXPECT_NEAR(window.onset_s, begin_s + kReach_s * kCrossing, 1e-3) << rate_hz << " " << k;
      EXPECT_NEAR(window.end_s, begin_s + kReach_s * (1.0 - kCrossing), 1e-3) << rate_hz << " " << k;
    }
}

TEST(SpeedPeak, LiesBetweenSamples) {
  for (int k = 0; k < 8; ++k) {
    const double begin_s = kBegin_s + 0.005 * k;
    const auto path = reach_path(25.0, begin_s);
    const auto peak = speed_peak(path, speed_of(path));
    EXPECT_NEAR(peak.time_s, begin_s + 0.5 * kReach_s, 1e-4) << k;
    EXPECT_NEAR(peak.speed, 1.875, 1e-3) << k;
  }
  EXPECT_TRUE(std::isnan(speed_peak({}, {}).time_s));
}

TEST(SpeedPeak, AtAnEndIsTheEnd) {
  const Eigen::VectorXd speed = Eigen::VectorXd::LinSpaced(11, 1.0, 2.0);
  const auto path = testing::straight_way(10.0, speed, Eigen::VectorXd::Constant(11, 1.0));
  EXPECT_EQ(speed_peak(path, speed).time_s, 1.0);
  EXPECT_EQ(speed_peak(path, speed).speed, 2.0);
}

TEST(MovementWindow, PassesOverWhatIsShorterThanTheHold) {
  auto path = reach_path(100.0);
  const double without = window_of(path).onset_s;
  path.v.col(0).segment(10, 5).setConstant(1.0);  // a twitch of 50 ms
  EXPECT_NEAR(window_of(path).onset_s, without, 1e-12);
}

TEST(MovementWindow, HasNoOnsetOfWhatMovesFromTheBeginning) {
  const auto window =
      window_of(testing::straight_way(100.0, Eigen::VectorXd::Ones(50), Eigen::VectorXd::Zero(50)));
  EXPECT_TRUE(std::isnan(window.onset_s));
  EXPECT_TRUE(std::isnan(window.end_s));
}

TEST(Submovements, AreCountedByTheirPeaks) {
  Eigen::VectorXd speed = Eigen::VectorXd::Zero(300);
  for (int i = 0; i < 300; ++i)
    for (const double begin : {0.5, 1.0, 1.5})
      speed[i] += testing::minimum_jerk_speed((0.01 * static_cast<double>(i) - begin) / 0.6);
  EXPECT_EQ(count_submovements(speed), 3);
  EXPECT_EQ(count_submovements(reach_speed(100.0)), 1);
  Eigen::VectorXd ripple = reach_speed(100.0);
  for (Eigen::Index i = 0; i < ripple.size(); ++i)
    ripple[i] += i % 2 == 0 ? 0.0 : 0.02;  // a hundredth of the peak
  EXPECT_EQ(count_submovements(ripple), 1);
  Eigen::VectorXd flat(6);
  flat << 0, 1, 1, 1, 0, 0;  // a flat top is one peak
  EXPECT_EQ(count_submovements(flat), 1);
  EXPECT_EQ(count_submovements(Eigen::VectorXd()), 0);
}

TEST(Cycles, OfASineOnATrendAreItsPeriods) {
  const auto x = testing::sampled(1000, 100.0, [](double t) {
    return Eigen::Vector3d(0.1 * std::cos(kTurn * 0.8 * t) + 0.002 * t, 0.0, 0.3 * t);
  });
  const auto cycles = cycles_along(x, Eigen::Vector3d::UnitX(), 100.0);
  EXPECT_NEAR(cycles.mean_s, 1.25, 1e-5);
  EXPECT_LT(cycles.sd_s, 1e-5);
  EXPECT_GE(cycles.count, 6);
  EXPECT_EQ(cycles_along(testing::sampled(50, 100.0, testing::reach), Eigen::Vector3d::UnitX(), 100.0).count,
            0);
}

// Wherever they begin and end: the line of least squares through a cosine over 5.3 cycles moves its crossings
// apart, by 9 ms of 1.25 s in the mean.
TEST(Cycles, AreAsLongAsTheyAreWhereverTheRecordingEnds) {
  for (const double trend : {0.0, 0.01})
    for (int phase = 0; phase < 8; ++phase)
      for (const std::int64_t samples : {400, 460, 530, 660, 1000}) {
        const auto x = testing::sampled(samples, 100.0, [&](double t) {
          return Eigen::Vector3d(0.1 * std::cos(kTurn * (0.8 * t + phase / 8.0)) + trend * t, 0.0, 0.0);
        });
        const auto cycles = cycles_along(x, Eigen::Vector3d::UnitX(), 100.0);
        EXPECT_NEAR(cycles.mean_s, 1.25, 2e-4)
            << samples << " samples, phase " << phase << ", trend " << trend;
      }
}

TEST(DetrendedAxis, IsThatOfTheOscillationNotOfTheTrend) {
  const auto x = testing::sampled(
      600, 100.0, [](double t) { return Eigen::Vector3d(3.0 * t, 0.1 * std::sin(kTurn * t), 0.0); });
  EXPECT_GT(std::abs(detrended_axis(x).y()), 0.999);
}

TEST(BandRms, OfASineInTheBandIsItsRms) {
  const auto x = testing::sampled(1000, 100.0, [](double t) {
    return Eigen::Vector3d(0.002 * std::sin(kTurn * 8.0 * t), 0.001 * std::cos(kTurn * 8.0 * t), 0.05 * t);
  });
  EXPECT_NEAR(band_rms(periodogram_of(x, 100.0), 4.0, 12.0), std::sqrt(0.5 * (4e-6 + 1e-6)), 1e-6);
  EXPECT_LT(band_rms(periodogram_of(x, 100.0), 15.0, 30.0), 2e-5);
  EXPECT_TRUE(std::isnan(band_rms(periodogram_of(x.topRows(7), 100.0), 4.0, 12.0)));
}

TEST(Periodogram, HoldsTheMeanSquareWhateverTheNumberOfSamples) {
  // 997 is a prime: three zeros make it 1,000.
  for (const std::int64_t n : {1000, 997}) {
    const auto x =
        testing::sampled(n, 100.0, [](double t) { return Eigen::Vector3d(std::sin(kTurn * 7.0 * t), 0, 0); });
    const auto found = periodogram_of(x, 100.0);
    EXPECT_EQ(found.power.size(), 501);
    EXPECT_NEAR(found.step_hz, 0.1, 1e-12);
    EXPECT_NEAR(band_rms(found, 0.0, 50.0), std::sqrt(0.5), 2e-3) << n;
    EXPECT_NEAR(peak_frequency(found, 0.3), 7.0, 0.01) << n;
  }
  EXPECT_EQ(periodogram_of(SeriesMatrix::Zero(7, 3), 100.0).power.size(), 0);
}

TEST(Periodogram, OfLowFrequenciesIsAPartOfTheWhole) {
  // Thinned out from 2048 samples on; a line at 30 Hz lies above and is larger than all below.
  Random random(9, 0);
  for (const std::int64_t n : {1000, 2500, 9000}) {
    auto x = testing::sampled(n, 240.0, [](double t) {
      return Eigen::Vector3d(std::sin(kTurn * 1.3 * t), 0.01 * std::sin(kTurn * 7.0 * t), 0.3 * t);
    });
    for (double& value : x.reshaped()) value += 0.001 * random.gaussian();
    const auto all = periodogram_of(x, 240.0), low = periodogram_of(x, 240.0, 12.0);
    ASSERT_LT(low.power.size(), all.power.size() / 5);
    EXPECT_EQ(low.step_hz, all.step_hz);
    EXPECT_LT((low.power.cwiseSqrt() - all.power.head(low.power.size()).cwiseSqrt()).cwiseAbs().maxCoeff(),
              1e-9 * std::sqrt(all.power.maxCoeff()));
    EXPECT_NEAR(band_rms(low, 4.0, 12.0) / band_rms(all, 4.0, 12.0), 1.0, 1e-6);
    EXPECT_GE(low.most_above, all.power.tail(all.power.size() - low.power.size()).maxCoeff());
    EXPECT_NEAR(peak_frequency(low, 0.3), peak_frequency(all, 0.3), 1e-9);
    for (std::int64_t i = 0; i < n; ++i)
      x(i, 2) += 2.0 * std::sin(kTurn * 30.0 * static_cast<double>(i) / 240.0);
    EXPECT_TRUE(std::isnan(peak_frequency(periodogram_of(x, 240.0, 12.0), 0.3)));
    EXPECT_NEAR(peak_frequency(periodogram_of(x, 240.0), 0.3), 30.0, 0.05);
  }
}

TEST(PeakFrequency, IsFoundBetweenTheLinesOfThePeriodogram) {
  const auto x = testing::sampled(
      500, 100.0, [](double t) { return Eigen::Vector3d(std::sin(kTurn * 5.137 * t), 0.0, 2.0 * t); });
  EXPECT_NEAR(peak_frequency(periodogram_of(x, 100.0), 0.3), 5.137, 0.02);
  EXPECT_TRUE(std::isnan(peak_frequency(periodogram_of(x.topRows(5), 100.0), 0.3)));
}

TEST(Recognise, TellsReachesFromCycles) {
  const auto reach = recognise(testing::path_of(170, 100.0, testing::reach));
  EXPECT_TRUE(reach.discrete);
  EXPECT_FALSE(reach.periodic);
  EXPECT_GT(reach.share_at_rest, 0.5);
  const auto cycle = recognise(testing::path_of(400, 100.0, testing::ellipse));
  EXPECT_FALSE(cycle.discrete);
  EXPECT_TRUE(cycle.periodic);
  EXPECT_EQ(cycle.share_at_rest, 0.0);
  // A part of a turn is neither.
  const auto part = recognise(testing::path_of(60, 100.0, testing::ellipse));
  EXPECT_FALSE(part.discrete || part.periodic);
}

TEST(Recognise, AWalkRepeatsAndDoesNotComeBack) {
  const auto walk = recognise(testing::path_of(500, 100.0, [](double t) -> Eigen::Vector3d {
    return testing::ellipse(t) + Eigen::Vector3d(0.0, 1.2 * t, 0.0);
  }));
  EXPECT_TRUE(walk.periodic);
  EXPECT_FALSE(walk.closed);
  EXPECT_TRUE(recognise(testing::path_of(400, 100.0, testing::ellipse)).closed);
}

TEST(Recognise, ASteadyWheelHardlyChangesItsSpeed) {
  EXPECT_TRUE(recognise(testing::path_of(400, 100.0, [](double t) {
                return Eigen::Vector3d(std::cos(testing::kTurn * t), std::sin(testing::kTurn * t), 0.0);
              })).steady);
  EXPECT_FALSE(recognise(testing::path_of(400, 100.0, testing::ellipse)).steady);
}

TEST(HardlyChanges, IsSaidOfSteadyValuesAlone) {
  EXPECT_TRUE(hardly_changes(Eigen::VectorXd::LinSpaced(100, 0.96, 1.04)));
  EXPECT_FALSE(hardly_changes(Eigen::VectorXd::LinSpaced(100, 0.8, 1.2)));
}

TEST(PathFacts, MovementOfAReachIsBetweenItsRests) {
  const auto path = testing::path_of(170, 100.0, testing::reach);
  const auto frame = recognise(path);
  const PathFacts facts(path, frame);
  EXPECT_NEAR(static_cast<double>(facts.movement().count()) / 100.0, 0.7 + 0.1 - 0.08, 0.03);
  const auto cyclic = testing::path_of(400, 100.0, testing::ellipse);
  const auto cyclic_frame = recognise(cyclic);
  EXPECT_EQ(PathFacts(cyclic, cyclic_frame).movement().count(), cyclic.count());
}

}  // namespace
}  // namespace kinemark::analysis
