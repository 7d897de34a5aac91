// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/trial.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace kinemark::data {
namespace {

using testing::HasSubstr;

Trial small() {
  Trial t;
  t.markers = Trajectories::all_missing({"A", "B"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 3});
  t.analog.names = {"Fx"};
  t.analog.units = {"N"};
  t.analog.samples = 6;
  t.analog.rate_hz = 200.0;
  t.analog.values.assign(6, 0.0);
  t.force_plates.push_back({.type = 2, .channel_idx = {0}});
  return t;
}

TEST(Trial, ASmallOneIsValidAndCountsItsFrames) {
  Trial t = small();
  t.first_frame = 100;
  EXPECT_TRUE(t.validate());
  EXPECT_EQ(t.last_frame(), 102);
}

TEST(Trial, ValidateNamesTheArrayThatDoesNotFit) {
  Trial t = small();
  t.residual_m.resize(2);
  EXPECT_THAT(t.validate().error().message, HasSubstr("2 residuals; need 6"));
  t = small();
  t.camera_mask.resize(1);
  EXPECT_THAT(t.validate().error().message, HasSubstr("camera masks"));
  t = small();
  t.analog.samples = 5;
  EXPECT_THAT(t.validate().error().message, HasSubstr("analog values"));
  t = small();
  t.analog.units = {"N", "V"};
  EXPECT_THAT(t.validate().error().message, HasSubstr("2 analog units"));
  t = small();
  t.force_plates[0].channel_idx = {1};
  EXPECT_THAT(t.validate().error().message, HasSubstr("analog channel 2"));
  t = small();
  t.force_plates[0].pressure_correction.assign(12, 0.5);
  EXPECT_TRUE(t.validate());
  t.force_plates[0].pressure_correction[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(t.validate().error().message, HasSubstr("force plate 1 corrects its centre of pressure by 12"));
  t.force_plates[0].pressure_correction.assign(11, 0.5);
  EXPECT_THAT(t.validate().error().message, HasSubstr("by 11 numbers; need 12 that are finite, or none"));
  t = small();
  t.unloaded_s[1] = std::numeric_limits<double>::infinity();
  EXPECT_THAT(t.validate().error().message, HasSubstr("plates unloaded from 0 to inf s"));
  t = small();
  t.markers.names[1] = "A";
  EXPECT_THAT(t.validate().error().message, HasSubstr("occurs twice"));
}

}  // namespace
}  // namespace kinemark::data
