// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/track_block.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/stages/report/internal/unpack_testing.h"

namespace kinemark::report::internal {
namespace {

TEST(TrackBlock, WhatWasDeflatedInflatesToTheSameBytes) {
  const std::vector<std::uint8_t> bytes{0, 0, 0, 1, 2, 255, 0, 0};
  EXPECT_EQ(inflate_base64(deflated(bytes)), bytes);
  EXPECT_TRUE(inflate_base64(deflated({})).empty());
}

TEST(TrackBlock, NumbersComeBackWithinHalfAStep) {
  std::vector<double> values;
  for (int s = 0; s < 3; ++s)
    for (int i = 0; i < 200; ++i) values.push_back(s + (s == 1 ? 16.0 : 0.1) * std::sin(0.05 * i + s));
  const auto packed = pack_series(values, 200, 2e-5, 5e-4);
  EXPECT_EQ(packed["kind"], "int16");
  EXPECT_EQ(packed["series"], 3);
  const auto back = unpack_series(packed);
  ASSERT_EQ(back.size(), values.size());
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double step = packed["step"][i / 200].get<double>();
    EXPECT_LE(step, 5e-4);
    EXPECT_NEAR(back[i], values[i], 0.5 * step + 1e-6) << i;
  }
  EXPECT_DOUBLE_EQ(packed["step"][0].get<double>(), 2e-5) << "small ranges are not finer than asked";
  EXPECT_GT(packed["step"][1].get<double>(), 5e-4 * 0.9) << "32 m take 65,535 steps";
}

TEST(TrackBlock, WhatReachesTooFarIsFloat32ToTheBit) {
  const std::vector<double> values{1.0, -1000.0, 5e6, 0.125, 2.0, 2.0, 2.5, 1e-30};
  const auto packed = pack_series(values, 4, 2e-5, 5e-4);
  EXPECT_EQ(packed["kind"], "float32");
  EXPECT_FALSE(packed.contains("step"));
  const auto back = unpack_series(packed);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(back[i], static_cast<float>(values[i])) << i;
}

TEST(TrackBlock, WhatIsAbsentHoldsTheNumberBeforeIt) {
  const std::vector<double> values{kNaN, 1.0, kNaN, kNaN, 3.0, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
  for (const double coarsest : {1.0, 1e-9}) {
    const auto back = unpack_series(pack_series(values, 6, 1e-9, coarsest));
    const std::vector<double> expected{1, 1, 1, 1, 3, 3, 0, 0, 0, 0, 0, 0};
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(back[i], expected[i], 1e-4) << i;
  }
}

TEST(TrackBlock, NothingPacksToNothing) {
  const auto packed = pack_series({}, 0, 1e-5, 1e-3);
  EXPECT_EQ(packed["series"], 0);
  EXPECT_TRUE(unpack_series(packed).empty());
}

TEST(TrackBlock, StillSeriesTakeNextToNoRoom) {
  const std::vector<double> still(100'000, 1.25);
  EXPECT_LT(pack_series(still, 100'000, 2e-5, 5e-4)["data"].get<std::string>().size(), 1000U);
}

TEST(TrackBlockDeathTest, SeriesOfOtherLengthsAreRefused) {
  EXPECT_THROW((void)pack_series(std::vector<double>(7), 2, 1e-5, 1e-3), std::exception);
  EXPECT_THROW((void)pack_series(std::vector<double>(4), 2, 0.0, 1e-3), std::exception);
}

}  // namespace
}  // namespace kinemark::report::internal
