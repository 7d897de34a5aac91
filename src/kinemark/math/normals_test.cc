// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/normals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/core/wide.h"

namespace kinemark::math {
namespace {

std::vector<double> normals(std::size_t count, std::uint64_t stream = 7, std::int64_t first = 0) {
  std::vector<double> out(count);
  fill_normals(5, stream, first, out);
  return out;
}

TEST(Normals, AreThoseOfBoxAndMullerOfTheirStream) {
  Random random(5, 7);
  const auto found = normals(20001);
  for (std::size_t i = 0; i < found.size(); i += 2) {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - random.uniform()));
    const double angle = 2.0 * std::numbers::pi * random.uniform();
    // A uniform number differs in its last bit, which tells where 1 - u is nearly 0.
    ASSERT_NEAR(found[i], radius * std::cos(angle), 1e-10) << i;
    if (i + 1 < found.size()) {
      ASSERT_NEAR(found[i + 1], radius * std::sin(angle), 1e-10) << i;
    }
  }
}

TEST(Normals, HaveTheMomentsOfNormalNumbers) {
  const auto found = normals(1'000'000);
  double moments[5] = {};
  for (const double x : found)
    for (int k = 1; k < 5; ++k) moments[k] += std::pow(x, k) / 1e6;
  EXPECT_NEAR(moments[1], 0.0, 0.004);
  EXPECT_NEAR(moments[2], 1.0, 0.006);
  EXPECT_NEAR(moments[3], 0.0, 0.016);
  EXPECT_NEAR(moments[4], 3.0, 0.04);
  // One in 15,787 lies beyond four.
  EXPECT_NEAR(static_cast<double>(std::ranges::count_if(found, [](double x) { return std::abs(x) > 4.0; })),
              63.0, 32.0);
}

TEST(Normals, AnyPartOfAStreamCanBeMadeAlone) {
  const auto all = normals(2000), part = normals(501, 7, 600);
  for (std::size_t i = 0; i < part.size(); ++i) ASSERT_EQ(part[i], all[600 + i]) << i;
  EXPECT_NE(normals(4), normals(4, 8));
}

TEST(Logarithms, AreThoseOfTheLibrary) {
  std::vector<double> values;
  for (double x = 1e-307; x < 1e307; x *= 1.37) values.push_back(x);
  for (double x = 0.7; x < 1.5; x += 1.1e-4) values.push_back(x);
  for (const double x : {1.0, std::numbers::sqrt2, std::numeric_limits<double>::min()}) values.push_back(x);
  auto found = values;
  logarithms(found);
  for (std::size_t i = 0; i < values.size(); ++i)
    ASSERT_NEAR(found[i], std::log(values[i]), 1e-15 * std::max(1.0, std::abs(found[i]))) << values[i];
  EXPECT_EQ(found[found.size() - 3], 0.0);
}

[[gnu::always_inline]] inline void thirds(const double* from, double* to) {
  for (int i = 0; i < 40; i += kLanes) {
    Lanes x;
    load(x, from + i);
    store(to + i, x / 3.0 + x * x);
  }
}

TEST(Wide, VersionsOfALoopGiveTheSameBits) {
  std::vector<double> from(40), narrow(40), wide(40);
  for (std::size_t i = 0; i < from.size(); ++i) from[i] = 0.1 + 1.7 * static_cast<double>(i);
  thirds(from.data(), narrow.data());
  run_wide<thirds>(static_cast<const double*>(from.data()), wide.data());
  EXPECT_EQ(narrow, wide);
  for (std::size_t i = 0; i < from.size(); ++i) EXPECT_EQ(narrow[i], from[i] / 3.0 + from[i] * from[i]);
}

}  // namespace
}  // namespace kinemark::math
