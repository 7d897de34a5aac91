// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/sleeve_source.h"

#include <gmock/gmock.h>

#include <cmath>

namespace kinemark::simulation {
namespace {

using ::testing::HasSubstr;

TEST(SleeveSource, GivesTheFramesOfTheWholeSimulationToTheBit) {
  for (const bool tip : {false, true}) {
    const SleeveOptions options{
        .duration_s = 20.0, .leds_per_segment = 5, .missing = 0.1, .tip = tip, .seed = 9};
    const auto whole = simulate_sleeve(options).value().markers;
    const auto source = SleeveSource::create(options, {.name = "sim:arm"}).value();
    EXPECT_EQ(source->facts().markers, whole.names);
    EXPECT_EQ(source->facts().frames, whole.frames());
    stream::Frame frame;
    std::int64_t missing = 0;
    for (std::int64_t f = 0; f < whole.frames(); ++f) {
      ASSERT_EQ(source->next(frame), true);
      ASSERT_EQ(frame.number, f);
      ASSERT_EQ(frame.time_s, whole.time.time_s(f));
      for (std::int64_t m = 0; m < whole.markers(); ++m) {
        const auto at = static_cast<std::size_t>(m);
        ASSERT_EQ(frame.state[at], whole.state[whole.index(f, m)]) << f << " " << m;
        if (frame.state[at] == data::SampleState::missing) {
          ++missing;
          ASSERT_TRUE(std::isnan(frame.x_in_world[3 * at]));
        } else {
          ASSERT_EQ(Eigen::Vector3d::Map(&frame.x_in_world[3 * at]), whole.x(f, m));
        }
      }
    }
    EXPECT_EQ(source->next(frame), false);
    EXPECT_GT(missing, whole.frames()) << "LEDs turned away are not seen";
  }
}

TEST(SleeveSource, LiesWithinItsExtent) {
  const auto source =
      SleeveSource::create({.duration_s = 30.0, .noise_sd_m = 0.0}, {.name = "sim:arm"}).value();
  const auto [low, high] = *source->facts().extent_m;
  stream::Frame frame;
  while (source->next(frame).value())
    for (std::size_t m = 0; m < frame.state.size(); ++m)
      if (frame.state[m] != data::SampleState::missing)
        for (std::size_t a = 0; a < 3; ++a) {
          ASSERT_GE(frame.x_in_world[3 * m + a], low[static_cast<Eigen::Index>(a)]);
          ASSERT_LE(frame.x_in_world[3 * m + a], high[static_cast<Eigen::Index>(a)]);
        }
  EXPECT_LT((high - low).maxCoeff(), 0.8);
}

TEST(SleeveSource, RefusesWhatNeedsAWholeRecording) {
  EXPECT_THAT(SleeveSource::create({.skin_m = 0.01}, {}).error().message,
              HasSubstr("skin needs a whole recording"));
  EXPECT_EQ(SleeveSource::create({.rate_hz = -1.0}, {}).error().code, Code::usage);
}

}  // namespace
}  // namespace kinemark::simulation
