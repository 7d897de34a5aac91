// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What is planned for a file is what a reader settles from it.
#include "kinemark/io/c3d/plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/io/c3d/internal/simulated_trial.h"
#include "kinemark/io/c3d/layout.h"

namespace kinemark::io {
namespace {

using internal::simulate_trial;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

C3dPlan plan_of(const data::Trial& trial, const C3dWriteOptions& options = {}) {
  auto plan = plan_c3d(trial, options);
  EXPECT_TRUE(plan) << plan.error().message;
  return std::move(*plan);
}

std::string plan_refusal(const data::Trial& trial, Code code, const C3dWriteOptions& options = {}) {
  const auto plan = plan_c3d(trial, options);
  EXPECT_FALSE(plan);
  if (plan) return "";
  EXPECT_EQ(plan.error().code, code) << plan.error().message;
  return plan.error().message;
}

double number_in(const C3dPlan& plan, std::string_view group, std::string_view name) {
  return plan.parameters.number(group, name).value_or(NAN);
}

/// A recording that is nothing but missing samples: cheap, whatever its length.
data::Trial empty_frames(std::int64_t frames, std::int64_t first_frame = 1, double t0_s = 0.0) {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"A"}, {.rate_hz = 100.0, .t0_s = t0_s, .frames = frames});
  trial.first_frame = first_frame;
  return trial;
}

TEST(C3dPlan, AReaderSettlesExactlyWhatWasPlannedWithoutAWord) {
  for (const std::int64_t markers : {1, 7, 300})
    for (const std::int64_t frames : {1, 50})
      for (const std::int64_t channels : {0, 3})
        for (const bool integers : {false, true}) {
          const auto trial = simulate_trial({.markers = markers, .frames = frames, .channels = channels});
          auto plan = plan_of(trial, {.units = "cm", .integers = integers});
          plan.header.data_block = 20;
          for (auto& p : plan.parameters.group("POINT").parameters)
            if (p.name == "DATA_START") p.numbers = {20.0};
          const auto numbers = static_cast<std::size_t>(4 * markers + channels * plan.samples_per_frame);
          const std::size_t bytes =
              19 * kC3dBlock + static_cast<std::size_t>(frames) * numbers * (integers ? 2 : 4);
          std::vector<std::string> warnings;
          const auto layout = settle_layout(plan.header, plan.parameters, Processor::intel, bytes, warnings);
          ASSERT_TRUE(layout) << layout.error().message;
          EXPECT_THAT(warnings, IsEmpty());
          EXPECT_EQ(layout->points, markers);
          EXPECT_EQ(layout->frames, frames);
          EXPECT_EQ(layout->analog_channels, channels);
          EXPECT_EQ(layout->samples_per_frame, channels > 0 ? 4 : 0);
          EXPECT_EQ(layout->is_float, !integers);
          EXPECT_EQ(number_in(plan, "ANALOG", "RATE"), channels > 0 ? 960.0 : 0.0) << "as the header says";
          EXPECT_EQ(layout->rate_hz, 240.0);
          EXPECT_DOUBLE_EQ(layout->metres_per_unit * plan.units_per_metre, 1.0);
          EXPECT_FLOAT_EQ(static_cast<float>(layout->scale), static_cast<float>(plan.scale));
        }
}

TEST(C3dPlan, EveryIntegerFitsIntoSixteenBitsAndUsesThem) {
  for (const double size_m : {1e-4, 0.5, 3.0, 900.0}) {
    auto trial = simulate_trial({.channels = 2});
    for (double& x : trial.markers.x_in_world) x *= size_m;
    const auto plan = plan_of(trial, {.integers = true});
    double largest = 0.0;
    for (const double x : trial.markers.x_in_world)
      if (std::isfinite(x)) largest = std::max(largest, std::abs(x));
    const double stored = largest * plan.units_per_metre / plan.scale;
    EXPECT_LE(stored, 32767.0) << size_m;
    EXPECT_GT(stored, 31000.0) << "no precision is given away";
    for (std::size_t i = 0; i < trial.analog.values.size(); ++i)
      EXPECT_LE(std::abs(trial.analog.values[i]) / plan.analog_scale[i % 2], 32767.0);
  }
}

TEST(C3dPlan, FramesAreNumberedSoThatTimeKeepsItsZero) {
  const auto first = [](std::int64_t said, double t0_s) {
    return plan_of(empty_frames(10, said, t0_s)).header.first_frame;
  };
  EXPECT_EQ(first(1, 0.0), 1);
  EXPECT_EQ(first(11, 0.1), 11);
  EXPECT_EQ(first(0, 0.0), 0) << "some makers count from 0";
  EXPECT_EQ(first(1, 0.1), 11) << "the time says so";
  EXPECT_EQ(first(500, 0.0), 1);
  EXPECT_EQ(first(1, -3.0), 1) << "there is no frame before the first";
}

TEST(C3dPlan, CountsBeyondSixteenBitsGoWhereThereAreThirtyTwo) {
  for (const std::int64_t frames : {65534, 65535, 65536, 200'000}) {
    const auto plan = plan_of(empty_frames(frames));
    const bool fits = frames <= 65535;
    EXPECT_EQ(plan.header.last_frame, fits ? frames : 65535);
    EXPECT_EQ(number_in(plan, "POINT", "FRAMES"), static_cast<double>(std::min<std::int64_t>(frames, 65535)));
    EXPECT_EQ(plan.parameters.number("POINT", "LONG_FRAMES").has_value(), !fits);
    EXPECT_EQ(plan.parameters.number("POINT", "LONG_FRAMES").value_or(static_cast<double>(frames)),
              static_cast<double>(frames));
    const auto end = plan.parameters.numbers("TRIAL", "ACTUAL_END_FIELD");
    ASSERT_EQ(end.size(), 2U);
    EXPECT_EQ(end[0] + 65536.0 * end[1], static_cast<double>(frames));
  }
}

TEST(C3dPlan, EventsAreMinutesAndSeconds) {
  auto trial = empty_frames(10);
  for (const double t : {0.0, 59.5, 60.0, 3723.25})
    trial.events.push_back({.label = "e" + std::to_string(t), .context = "Left", .time_s = t});
  const auto plan = plan_of(trial);
  EXPECT_THAT(plan.parameters.numbers("EVENT", "TIMES"), ElementsAre(0, 0, 0, 59.5, 1, 0, 62, 3.25));
  EXPECT_EQ(number_in(plan, "EVENT", "USED"), 4.0);
  EXPECT_EQ(plan.parameters.texts("EVENT", "LABELS").size(), 4U);
}

TEST(C3dPlan, ListsBeyond255GoOnInNumberedParameters) {
  for (const std::int64_t markers : {255, 256, 511}) {
    const auto trial = simulate_trial({.markers = markers, .frames = 1});
    const auto plan = plan_of(trial);
    EXPECT_EQ(plan.parameters.texts("POINT", "LABELS"), trial.markers.names) << markers;
    for (const auto& group : plan.parameters.groups)
      for (const auto& p : group.parameters)
        for (const int d : p.dims) EXPECT_LE(d, 255) << p.name;
  }
}

TEST(C3dPlan, WhatHasNoPlaceInAC3dFileIsOneSentence) {
  EXPECT_THAT(plan_refusal(empty_frames(0), Code::bad_input), HasSubstr("no frames"));
  EXPECT_THAT(plan_refusal(empty_frames(2), Code::usage, {.units = "ell"}),
              HasSubstr("'ell' is not a known length"));
  auto uneven = simulate_trial({.frames = 10, .channels = 1});
  uneven.analog.samples -= 1;
  uneven.analog.values.pop_back();
  EXPECT_THAT(plan_refusal(uneven, Code::bad_input), HasSubstr("39 analog samples for 10 frames"));
  auto off = simulate_trial({.frames = 10, .channels = 1});
  off.analog.rate_hz *= 1.01;
  EXPECT_THAT(plan_refusal(off, Code::bad_input), HasSubstr("its frames hold 960 Hz"));
  auto broken = simulate_trial({.frames = 10, .channels = 1});
  broken.analog.values[3] = NAN;
  EXPECT_THAT(plan_refusal(broken, Code::bad_input, {.integers = true}), HasSubstr("write float ones"));
  EXPECT_TRUE(plan_c3d(broken, {})) << "floats can say NaN";
}

}  // namespace
}  // namespace kinemark::io
