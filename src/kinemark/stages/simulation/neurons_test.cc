// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/neurons.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "kinemark/stages/simulation/limb.h"

namespace kinemark::simulation {
namespace {

using ::testing::HasSubstr;

/// A hand on a circle in a plane askew: its velocity turns steadily at one speed.
Array<double> circling(const TimeBase& time) {
  Array<double> out;
  for (std::int64_t f = 0; f < time.frames; ++f) {
    const double turn = 2.0 * std::numbers::pi * 0.5 * time.time_s(f);
    out.insert(out.end(), {0.2 * std::cos(turn), 0.2 * std::sin(turn), 0.1 * std::sin(turn)});
  }
  return out;
}

double label(const data::SpikeTrain& unit, const char* column) {
  for (const auto& one : unit.labels)
    if (one.column == column) return std::atof(one.value.c_str());
  ADD_FAILURE() << column;
  return 0.0;
}

constexpr TimeBase kTime{.rate_hz = 60.0, .t0_s = 2.0, .frames = 60 * 600};

TEST(Neurons, FollowTheirTuningAheadOfTheMovement) {
  const auto hand = circling(kTime);
  const auto session = simulate_neurons(hand, kTime, {.units = 4, .lead_s = 0.25, .seed = 3});
  ASSERT_TRUE(session) << session.error().message;
  for (const auto& unit : session->neural.units) {
    // First harmonic of the spikes over the turn of the velocity, against that of the rate.
    double cosine = 0.0, sine = 0.0, expected_cosine = 0.0, expected_sine = 0.0, expected = 0.0;
    for (const double t : unit.times_s) {
      cosine += std::cos(std::numbers::pi * t);
      sine += std::sin(std::numbers::pi * t);
    }
    const Eigen::Vector3d preferred(label(unit, "preferred_x"), label(unit, "preferred_y"),
                                    label(unit, "preferred_z"));
    for (double t = 2.0; t < 602.0; t += 0.01) {
      const double a = std::numbers::pi * (t + 0.25);
      const Eigen::Vector3d v(-0.2 * std::sin(a), 0.2 * std::cos(a), 0.1 * std::cos(a));
      const double rms = std::sqrt(0.04 + 0.005);
      const double rate =
          std::max(0.0, label(unit, "baseline_hz") + label(unit, "depth_hz") * preferred.dot(v) / rms);
      expected += 0.01 * rate;
      expected_cosine += 0.01 * rate * std::cos(std::numbers::pi * t);
      expected_sine += 0.01 * rate * std::sin(std::numbers::pi * t);
    }
    const double sd = std::sqrt(expected);
    EXPECT_NEAR(static_cast<double>(unit.times_s.size()), expected, 4.0 * sd) << unit.id;
    EXPECT_NEAR(cosine, expected_cosine, 4.0 * sd) << unit.id;
    EXPECT_NEAR(sine, expected_sine, 4.0 * sd) << unit.id;
  }
}

TEST(Neurons, TheSameSeedGivesTheSameSpikes) {
  const auto hand = circling(kTime);
  const auto one = simulate_neurons(hand, kTime, {.units = 2, .seed = 5});
  const auto more = simulate_neurons(hand, kTime, {.units = 3, .trials = 4, .seed = 5});
  const auto other = simulate_neurons(hand, kTime, {.units = 2, .seed = 6});
  ASSERT_TRUE(one && more && other);
  EXPECT_EQ(one->neural.units[1].times_s, more->neural.units[1].times_s);
  EXPECT_NE(one->neural.units[1].times_s, other->neural.units[1].times_s);
  EXPECT_TRUE(one->neural.validate());
}

TEST(Neurons, TrialsLieInTheSession) {
  const auto limb = simulate_sleeve({.duration_s = 20.0, .seed = 2});
  ASSERT_TRUE(limb);
  const auto& time = limb->markers.time;
  const auto session = simulate_neurons(limb->end_in_world, time, {.trials = 4});
  ASSERT_TRUE(session);
  const auto* trials = session->neural.find_intervals("trials");
  ASSERT_NE(trials, nullptr);
  ASSERT_EQ(trials->rows.size(), 4U);
  EXPECT_EQ(trials->rows.front().start_s, time.t0_s);
  EXPECT_LT(trials->rows.back().stop_s, time.time_s(time.frames - 1));
  int left = 0;
  for (const auto& row : trials->rows) left += row.labels[0].value == "left" ? 1 : 0;
  EXPECT_EQ(left, 2);
}

TEST(Neurons, TheRhythmWeakensWithMovement) {
  TimeBase time{.rate_hz = 60.0, .t0_s = 0.0, .frames = 60 * 40};
  Array<double> hand(3 * 60 * 40, 0.0);  // rests for 20 s, then moves
  for (std::size_t f = 1200; f < 2400; ++f) hand[3 * f] = 0.1 * std::sin(0.2 * static_cast<double>(f));
  const auto session = simulate_neurons(hand, time, {.field_potentials = true});
  ASSERT_TRUE(session);
  ASSERT_EQ(session->fields.size(), 1U);
  const auto& field = session->fields[0];
  ASSERT_EQ(field.values.size(), 20'000U * 4);
  const auto power = [&](std::size_t from, std::size_t to) {
    double c = 0.0, s = 0.0;
    for (std::size_t i = from; i < to; ++i) {
      const double a = 2.0 * std::numbers::pi * 20.0 * static_cast<double>(i) / field.rate_hz;
      c += field.values[4 * i] * std::cos(a);
      s += field.values[4 * i] * std::sin(a);
    }
    return c * c + s * s;
  };
  EXPECT_GT(power(0, 9500), 4.0 * power(10'500, 20'000));
}

TEST(Neurons, AskForWhatIsPossible) {
  const auto hand = circling(kTime);
  const auto fault = [&](const NeuronOptions& options) {
    const auto out = simulate_neurons(hand, kTime, options);
    return out ? "" : out.error().message;
  };
  EXPECT_THAT(fault({.units = -1}), HasSubstr("units must be 0 to 1000, not -1"));
  EXPECT_THAT(fault({.trials = 1001}), HasSubstr("trials must be 0 to 1000"));
  EXPECT_THAT(fault({.units = 1, .lead_s = 2.0}), HasSubstr("-1 to 1 s, not 2"));
  EXPECT_FALSE(simulate_neurons({0.0, 0.0, 0.0}, {.rate_hz = 60.0, .frames = 1}, {.units = 1}));
  EXPECT_FALSE(NeuronOptions{}.any());
  EXPECT_TRUE(NeuronOptions{.trials = 1}.any());
}

}  // namespace
}  // namespace kinemark::simulation
