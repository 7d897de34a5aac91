// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/trajectory/from_counts/classic_chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "kinemark/core/check.h"

namespace kinemark::trajectory {
namespace {

std::vector<double> sine(double hz, int n) {
  std::vector<double> out;
  for (int i = 0; i < n; ++i) out.push_back(std::sin(2.0 * std::numbers::pi * hz * i / 100.0));
  return out;
}

TEST(ClassicChain, BridgesACubicExactly) {
  std::vector<double> values;
  std::vector<char> valid(30, 1);
  for (int i = 0; i < 30; ++i) values.push_back(0.001 * i * i * i - 0.02 * i * i + 3.0);
  const auto truth = values;
  for (const std::size_t i : {0U, 9U, 10U, 11U, 12U, 29U}) values[i] = 1e9, valid[i] = 0;
  const auto bridged = bridge_by_spline(values, valid);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_NEAR(bridged[i], truth[i], 1e-9) << i;
}

TEST(ClassicChain, LeavesTooLittleAlone) {
  const std::vector<double> values{1, 2, 3, 4, 5};
  const std::vector<char> valid{1, 0, 1, 0, 1};
  EXPECT_EQ(bridge_by_spline(values, valid), values);
  EXPECT_THROW(static_cast<void>(bridge_by_spline(values, std::vector<char>{1})), ContractError);
}

TEST(ClassicChain, CutoffIsThatOfBothPasses) {
  const auto in = sine(12.0, 1000);
  const auto out = butterworth_both_ways(in, 100.0);
  double gain = 0.0, norm = 0.0;
  for (std::size_t i = 200; i < 800; ++i) gain += in[i] * out[i], norm += in[i] * in[i];
  EXPECT_NEAR(gain / norm, std::numbers::sqrt2 / 2.0, 1e-3);
  const auto each = butterworth_both_ways(in, 100.0, {.cutoff_hz = 12.0, .cutoff_of_both_passes = false});
  gain = 0.0;
  for (std::size_t i = 200; i < 800; ++i) gain += in[i] * each[i];
  EXPECT_NEAR(gain / norm, 0.5, 1e-3);
}

TEST(ClassicChain, KeepsALineToItsEnds) {
  std::vector<double> line;
  for (int i = 0; i < 50; ++i) line.push_back(0.3 * i - 2.0);
  const auto out = butterworth_both_ways(line, 100.0);
  for (std::size_t i = 0; i < line.size(); ++i) EXPECT_NEAR(out[i], line[i], 1e-3);
}

TEST(ClassicChain, ShortRecordsPass) {
  const std::vector<double> three{1, 5, 2};
  EXPECT_EQ(butterworth_both_ways(three, 100.0), three);
  EXPECT_EQ(butterworth_both_ways(sine(1.0, 40), 20.0), sine(1.0, 40));  // 12 Hz is beyond Nyquist's 10
}

TEST(ClassicChain, DifferencesOfAParabola) {
  std::vector<double> x;
  for (int i = 0; i < 10; ++i) x.push_back(0.5 * i * i);
  const auto v = two_point_difference(x, 10.0);
  for (std::size_t i = 1; i + 1 < x.size(); ++i) EXPECT_NEAR(v[i], 10.0 * static_cast<double>(i), 1e-12);
  EXPECT_NEAR(v[0], 5.0, 1e-12);
  EXPECT_EQ(two_point_difference(std::vector<double>{4.0}, 10.0), std::vector<double>{0.0});
}

}  // namespace
}  // namespace kinemark::trajectory
