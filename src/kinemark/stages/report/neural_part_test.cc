// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/neural_part.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/core/missing.h"

namespace kinemark::report {
namespace {

data::Neural lanes_example() {
  data::Neural out;
  out.units = {{.id = "1", .labels = {}, .times_s = {-1.0, 0.0, 0.5, 9.999, 11.0}}, {.id = "2"}};
  out.intervals = {
      {.name = "trials",
       .rows = {{.start_s = 1.0, .stop_s = 2.0, .labels = {{"side", "left"}, {"load", "2"}}},
                {.start_s = 20.0, .stop_s = 21.0, .labels = {{"side", "left"}, {"load", "2"}}}}}};
  out.fields = {{.name = "lfp",
                 .unit = "volts",
                 .channels = {"a"},
                 .rate_hz = 10.0,
                 .start_s = 0.0,
                 .bin_s = 5.0,
                 .bins = 2,
                 .low = {-1e-4, kNaN},
                 .high = {1e-4, kNaN}}};
  return out;
}

TEST(NeuralPart, HoldsWhatLiesInTheRecording) {
  const auto json = neural_json(lanes_example(), 0.0, 10.0);
  EXPECT_EQ(json["unit_count"], 2);
  EXPECT_EQ(json["units"][0]["spikes"], 3) << "two lie outside";
  EXPECT_EQ(json["bins"], 3001);
  ASSERT_EQ(json["trials"].size(), 1U);
  EXPECT_EQ(json["trials"][0]["label"], "side left, load 2");
  const auto& channel = json["fields"][0]["channels"][0];
  EXPECT_EQ(channel["least"].get<double>(), -1e-4);
  EXPECT_NEAR(channel["step"].get<double>(), 2e-4 / 254.0, 1e-12);
  EXPECT_EQ(channel["low"]["kind"], "codes");
}

TEST(NeuralPart, IsNothingWhereNothingLies) {
  EXPECT_TRUE(neural_json({}, 0.0, 10.0).is_null());
  EXPECT_TRUE(neural_json(lanes_example(), 5.0, 5.0).is_null());
}

TEST(NeuralPart, DoesNotGrowWithTheLength) {
  data::Neural busy;
  busy.units.push_back({.id = "1"});
  for (int i = 0; i < 360'000; ++i) busy.units[0].times_s.push_back(0.01 * i);
  const auto json = neural_json(busy, 0.0, 3600.0);
  EXPECT_EQ(json["units"][0]["spikes"], 360'000);
  EXPECT_LT(json.dump().size(), 10'000U);
}

}  // namespace
}  // namespace kinemark::report
