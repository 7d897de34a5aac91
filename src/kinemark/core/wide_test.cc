// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/wide.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "kinemark/core/random.h"

namespace kinemark {
namespace {

// out = a x + b, then what of it is above 1 is halved: adds, multiplies, compares.
[[gnu::always_inline]] inline void scale_loop(const double* x, double* out, std::int64_t count, double a,
                                              double b) {
  Lanes factor, offset, one, half;
  spread(factor, a);
  spread(offset, b);
  spread(one, 1.0);
  spread(half, 0.5);
  for (std::int64_t i = 0; i < count; i += kLanes) {
    Lanes value;
    load(value, x + i);
    value = value * factor + offset;
    value = value > one ? value * half : value;
    store(out + i, value);
  }
}

[[gnu::always_inline]] inline void sum_loop(const double* x, double* out, std::int64_t count) {
  Lanes sum, next;
  spread(sum, 0.0);
  for (std::int64_t i = 0; i < count; i += kLanes) {
    load(next, x + i);
    sum = sum + next;
  }
  *out = sum_of(sum);
}

std::vector<double> some_numbers(std::int64_t count) {
  Random random(7, 1);
  std::vector<double> out;
  for (std::int64_t i = 0; i < count; ++i) out.push_back(3.0 * random.gaussian());
  return out;
}

TEST(Wide, LoopsDoWhatTheyDoOneByOne) {
  const auto x = some_numbers(400);
  std::vector<double> wide(x.size()), expected;
  run_wide<scale_loop>(x.data(), wide.data(), std::int64_t{400}, 1.7, -0.3);
  for (const double value : x) {
    const double product = value * 1.7;  // kept apart, as nothing is fused
    const double moved = product + -0.3;
    expected.push_back(moved > 1.0 ? moved * 0.5 : moved);
  }
  EXPECT_EQ(wide, expected);
}

TEST(Wide, BothVersionsGiveTheSameBits) {
  const auto x = some_numbers(1000);
  std::vector<double> narrow(x.size()), wide(x.size());
  scale_loop(x.data(), narrow.data(), 1000, 0.1, 0.7);
  run_wide<scale_loop>(x.data(), wide.data(), std::int64_t{1000}, 0.1, 0.7);
  EXPECT_EQ(narrow, wide);
  double narrow_sum = 0.0, wide_sum = 0.0;
  sum_loop(x.data(), &narrow_sum, 1000);
  run_wide<sum_loop>(x.data(), &wide_sum, std::int64_t{1000});
  EXPECT_EQ(narrow_sum, wide_sum);
}

TEST(Wide, SumsInOneOrderOnEveryProcessor) {
  // 1 + 1e16 loses the 1: which one it meets tells the order.
  const Lanes of{1.0, 2.0, 1e16, -1e16};
  EXPECT_EQ(sum_of(of), (1.0 + 1e16) + (2.0 + -1e16));
}

TEST(Wide, ReadsAndWritesWhereNothingIsAligned) {
  const auto x = some_numbers(41);
  std::vector<double> out(41, 9.0);
  run_wide<scale_loop>(x.data() + 1, out.data() + 1, std::int64_t{40}, 1.0, 0.0);
  EXPECT_EQ(out[0], 9.0);
  for (std::size_t i = 1; i < out.size(); ++i) EXPECT_EQ(out[i], x[i] > 1.0 ? 0.5 * x[i] : x[i]);
}

TEST(Wide, CarriesWhatIsNoNumber) {
  const std::vector<double> x{std::numeric_limits<double>::quiet_NaN(), -0.0,
                              std::numeric_limits<double>::infinity(), 4.0};
  std::vector<double> out(4);
  run_wide<scale_loop>(x.data(), out.data(), std::int64_t{4}, 1.0, 0.0);
  EXPECT_TRUE(std::isnan(out[0]));
  EXPECT_EQ(out[2], std::numeric_limits<double>::infinity());
  EXPECT_EQ(out[3], 2.0);
}

}  // namespace
}  // namespace kinemark
