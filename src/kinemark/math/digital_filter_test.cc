// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/digital_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"
#include "support/scipy_filtfilt.h"

namespace kinemark::math {
namespace {

using testing_support::filtfilt_signal;

TEST(DigitalFilter, BothWaysEqualsScipysFiltfilt) {
  for (const auto& reference : testing_support::kFiltfilt) {
    std::vector<double> x = filtfilt_signal();
    filter_both_ways(butterworth_lowpass(reference.order, reference.cutoff), usual_padding(reference.order),
                     x);
    for (int i = 0; i < 7; ++i)
      EXPECT_NEAR(x[static_cast<std::size_t>(testing_support::kFiltfiltAt[i])], reference.y[i], 1e-9)
          << "order " << reference.order << " cut-off " << reference.cutoff << " sample "
          << testing_support::kFiltfiltAt[i];
  }
}

TEST(DigitalFilter, AmplitudeIsButterworths) {
  for (const int order : {1, 2, 3, 4, 6, 9, 10}) {
    const double cutoff = 0.07;
    const auto sections = butterworth_lowpass(order, cutoff);
    for (const double f : {0.0, 0.03, 0.07, 0.12, 0.3}) {
      const double ratio = std::tan(M_PI * f) / std::tan(M_PI * cutoff);
      EXPECT_NEAR(amplitude(sections, f), 1.0 / std::sqrt(1.0 + std::pow(ratio, 2 * order)), 1e-12);
    }
  }
}

TEST(DigitalFilter, TwoPassesTogetherHaveTheCutoffAsked) {
  for (const int order : {2, 4, 8}) {
    for (const double cutoff : {0.005, 0.06, 0.25, 0.45, 0.49}) {
      const double design = two_pass_cutoff(order, cutoff);
      const auto sections = butterworth_lowpass(order, design);
      EXPECT_NEAR(std::pow(amplitude(sections, cutoff), 2), std::sqrt(0.5), 1e-9);
      EXPECT_NEAR(two_pass_half_power(order, design), cutoff, 1e-12);
    }
  }
  EXPECT_NEAR(two_pass_half_power(2, 0.001) / 0.001, 0.8022, 1e-4);  // what filtfilt alone gives at order 2
}

TEST(DigitalFilter, AFilteredSineHasTheAmplitudeOfTheFormula) {
  std::vector<double> x;
  const double f = 0.05;
  for (int i = 0; i < 4000; ++i) x.push_back(std::sin(2.0 * M_PI * f * i));
  const auto sections = butterworth_lowpass(2, two_pass_cutoff(2, f));
  filter_both_ways(sections, 200, x);
  double power = 0.0;
  for (int i = 1000; i < 3000; ++i)
    power += x[static_cast<std::size_t>(i)] * x[static_cast<std::size_t>(i)] / 1000.0;
  EXPECT_NEAR(std::sqrt(power), std::sqrt(0.5), 1e-3 * std::sqrt(0.5));
}

TEST(DigitalFilter, KeepsConstantsAndStraightLinesToTheEnd) {
  std::vector<double> x;
  for (int i = 0; i < 300; ++i) x.push_back(3.0 - 0.25 * i);
  std::vector<double> y = x;
  filter_both_ways(butterworth_lowpass(4, 0.05), 200, y);
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(y[i], x[i], 1e-6) << i;
}

TEST(DigitalFilter, ForwardsAndBackwardsAreOne) {
  std::vector<double> x = filtfilt_signal(), reversed = filtfilt_signal();
  std::ranges::reverse(reversed);
  const auto sections = butterworth_lowpass(4, 0.1);
  filter_both_ways(sections, 119, x);
  filter_both_ways(sections, 119, reversed);
  std::ranges::reverse(reversed);
  for (std::size_t i = 20; i < 100; ++i) EXPECT_NEAR(x[i], reversed[i], 1e-6);
}

TEST(DigitalFilter, ShortInputs) {
  const auto sections = butterworth_lowpass(2, 0.1);
  std::vector<double> none, one{2.5}, two{1.0, 3.0};
  filter_both_ways(sections, 9, none);
  filter_both_ways(sections, 9, one);
  filter_both_ways(sections, 9, two);
  EXPECT_TRUE(none.empty());
  EXPECT_EQ(one[0], 2.5);
  EXPECT_TRUE(std::isfinite(two[0]) && std::isfinite(two[1]));
}

TEST(DigitalFilter, RefusesWhatIsNoFilter) {
  EXPECT_THROW((void)butterworth_lowpass(0, 0.1), ContractError);
  EXPECT_THROW((void)butterworth_lowpass(2, 0.5), ContractError);
  EXPECT_THROW((void)butterworth_lowpass(2, std::nan("")), ContractError);
  EXPECT_THROW((void)two_pass_cutoff(2, 0.0), ContractError);
}

}  // namespace
}  // namespace kinemark::math
