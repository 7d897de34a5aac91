// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/curve_block.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/report/internal/unpack_testing.h"

namespace kinemark::report::internal {
namespace {

using testing::ElementsAre;
using Json = nlohmann::ordered_json;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

std::vector<std::uint8_t> bytes_of(const Json& packed) {
  return inflate_base64(packed["data"].get<std::string>());
}

// The page's decoder is held to the same bytes, written down by hand: viewer/tests/unit/curves.test.ts.
TEST(PackCurve, BytesAreThoseThatThePageReads) {
  const Json first = pack_curve(std::vector{1.00F, 1.01F, 1.03F, kNone, 1.06F}, 0.01);
  EXPECT_EQ(first["order"], 1);
  EXPECT_EQ(first["absent"], true);
  EXPECT_THAT(bytes_of(first), ElementsAre(200, 2, 4, 0, 6, 0, 0, 0, 1, 0));
  const Json second = pack_curve(std::vector{-5.0F, -4.5F, -3.0F, -0.5F, 3.0F}, 0.5);
  EXPECT_EQ(second["order"], 2);
  EXPECT_EQ(second["absent"], false);
  EXPECT_THAT(bytes_of(second), ElementsAre(19, 2, 4, 4, 4));
  const Json none = pack_curve(std::vector{300.0F, -300.0F, 300.0F}, 1.0);
  EXPECT_EQ(none["order"], 0);
  EXPECT_EQ(none["bytes"], 2);
  EXPECT_THAT(bytes_of(none), ElementsAre(0x58, 0x57, 0x58, 2, 2, 2));
  EXPECT_THAT(bytes_of(pack_codes(std::vector<std::uint8_t>{0, 3, 1})), ElementsAre(0, 3, 1));
}

TEST(PackCurve, NoNumberIsOffByMoreThanHalfAStep) {
  Random random(5, 0);
  for (const double step : {1e-4, 0.05, 2.0})
    for (const double smooth : {0.0, 0.9, 0.999}) {
      std::vector<float> values;
      double v = 0.0, slope = 0.0;
      for (int i = 0; i < 500; ++i) {
        slope = smooth * slope + random.gaussian();
        v = smooth * v + slope;
        values.push_back(i % 71 == 3 ? kNone : static_cast<float>(v));
      }
      const auto back = unpack_curve(pack_curve(values, step));
      ASSERT_EQ(back.size(), values.size());
      for (std::size_t i = 0; i < values.size(); ++i)
        if (std::isnan(values[i]))
          EXPECT_TRUE(std::isnan(back[i])) << i;
        else
          EXPECT_LE(std::abs(back[i] - double{values[i]}), 0.5000001 * step) << i;
    }
}

TEST(PackCurve, ExtremesOfTheWordsComeBack) {
  const std::vector<float> values{2147483520.0F, -2147483520.0F, 0.0F, 2147483520.0F, 2147483520.0F, -1.0F};
  const auto back = unpack_curve(pack_curve(values, 1.0));
  // Differences wrap round; sums modulo 2^32 give the number again.
  for (std::size_t i = 0; i < values.size(); ++i)
    EXPECT_EQ(static_cast<std::int32_t>(static_cast<std::uint32_t>(static_cast<std::int64_t>(back[i]))),
              static_cast<std::int32_t>(values[i]));
  EXPECT_THROW((void)pack_curve(values, 0.5), ContractError);
  EXPECT_THROW((void)pack_curve(values, 0.0), ContractError);
}

TEST(PackCurve, NothingAndNowhere) {
  EXPECT_TRUE(unpack_curve(pack_curve(std::vector<float>{}, 1.0)).empty());
  const auto back = unpack_curve(pack_curve(std::vector{kNone, kNone}, 1.0));
  ASSERT_EQ(back.size(), 2U);
  EXPECT_TRUE(std::isnan(back[0]) && std::isnan(back[1]));
}

TEST(CurveStep, IsARoundNumberThatTheErrorBarDoesNotSee) {
  const std::vector<float> values{0.0F, 90.0F};
  EXPECT_DOUBLE_EQ(curve_step(values, {}, 0.01), 0.01);
  EXPECT_DOUBLE_EQ(curve_step(values, std::vector{0.1F, 0.1F, 0.1F}, 0.01), 0.005);
  EXPECT_DOUBLE_EQ(curve_step(values, std::vector{0.0F, 0.0F}, 0.01), 0.01) << "an SD of 0 says nothing";
  EXPECT_DOUBLE_EQ(curve_step(std::vector{1.0F, 1.5F}, {}, 0.01), 0.0002) << "a 2,000th of the reach";
  EXPECT_DOUBLE_EQ(curve_step(std::vector{7.0F, 7.0F}, {}, 0.01), 0.01);
  EXPECT_DOUBLE_EQ(curve_step(std::vector{kNone}, {}, 0.01), 0.01);
  EXPECT_DOUBLE_EQ(deviation_step(std::vector{0.16F, kNone, 14.0F}), 0.01)
      << "a 1,000th of the median is above a 20th of the smallest";
  EXPECT_DOUBLE_EQ(deviation_step(std::vector{0.3F, 0.3F, 14.0F}), 0.01);
  EXPECT_DOUBLE_EQ(deviation_step(std::vector{0.0F}), 1.0);
}

TEST(CurveStep, AnyCurveCanBePacked) {
  for (const float far : {1e-30F, 1.0F, 1e9F, 3e38F}) {
    const std::vector<float> values{far, 0.0F, -far};
    const std::vector<float> sd{1e-12F * far, 1e-12F * far, 1e-12F * far};
    const double step = curve_step(values, sd, 0.01);
    const auto back = unpack_curve(pack_curve(values, step));
    EXPECT_NEAR(back[0], far, step) << far;
  }
}

TEST(PackWithin, ThinsUntilItFitsAndNoFurther) {
  Random random(9, 0);
  std::vector<float> values(4000);
  for (float& v : values) v = static_cast<float>(random.gaussian());
  values[1234] = 40.0F;
  const auto pack = [&](const PlotPoints& thinned) {
    return Json{{"points", thinned.size()}, {"curve", pack_curve(thinned.extremes(values), 0.001)}};
  };
  EXPECT_EQ(pack_within(4000, 1'000'000, pack)["points"], 4000);
  const Json fits = pack_within(4000, 3000, pack);
  EXPECT_LE(room(fits), 3000);
  EXPECT_GT(room(fits), 1200);
  EXPECT_EQ(std::ranges::max(unpack_curve(fits["curve"])), 40.0) << "no peak is lost";
  EXPECT_EQ(pack_within(4000, 1, pack)["points"], 2) << "never fewer than two points";
}

}  // namespace
}  // namespace kinemark::report::internal
