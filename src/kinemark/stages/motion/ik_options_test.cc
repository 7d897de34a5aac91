// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/ik_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::motion {
namespace {

TEST(IkOptions, DefaultsAreGood) { EXPECT_TRUE(IkOptions{}.check()); }

TEST(IkOptions, EachNonsenseIsNamed) {
  const auto sentence = [](auto change) {
    IkOptions options;
    change(options);
    const auto status = options.check();
    return status ? std::string() : status.error().message;
  };
  using testing::HasSubstr;
  EXPECT_THAT(sentence([](auto& o) { o.marker_weights = {{"A", -1.0}}; }), HasSubstr("marker 'A' is -1"));
  EXPECT_THAT(sentence([](auto& o) { o.coordinate_tasks = {{.coordinate = "q", .weight = INFINITY}}; }),
              HasSubstr("'q' is inf"));
  EXPECT_THAT(sentence([](auto& o) { o.coordinate_tasks = {{.coordinate = "q", .value = NAN}}; }),
              HasSubstr("task value"));
  EXPECT_THAT(sentence([](auto& o) { o.default_marker_weight = NAN; }), HasSubstr("default marker weight"));
  EXPECT_THAT(sentence([](auto& o) { o.loss_scale_m = 0.0; }), HasSubstr("loss scale"));
  EXPECT_THAT(sentence([](auto& o) { o.marker_noise_sd_m = -0.1; }), HasSubstr("marker noise"));
  EXPECT_THAT(sentence([](auto& o) { o.max_iterations = 0; }), HasSubstr("iteration limit"));
  EXPECT_THAT(sentence([](auto& o) { o.starts = 0; }), HasSubstr("starts"));
  EXPECT_THAT(sentence([](auto& o) { o.threads = -1; }), HasSubstr("threads"));
  EXPECT_THAT(sentence([](auto& o) { o.first_time_s = 1.0, o.last_time_s = 0.0; }), HasSubstr("empty"));
}

}  // namespace
}  // namespace kinemark::motion
