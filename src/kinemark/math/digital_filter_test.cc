// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/digital_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"

namespace kinemark::math {
namespace {

constexpr int kSamples = 120;

std::vector<double> signal() {
  std::vector<double> x;
  for (int i = 0; i < kSamples; ++i)
    x.push_back(std::sin(0.07 * i) + 0.3 * std::cos(0.61 * i + 0.2) + 0.1 * std::sin(2.3 * i) + 0.002 * i);
  return x;
}

// scipy 1.x: b, a = butter(order, 2 * cutoff); filtfilt(b, a, x), with its defaults, at these samples.
struct Reference {
  int order;
  double cutoff;
  double y[7];
};
constexpr int kAt[7] = {0, 1, 17, 60, 101, 118, 119};
constexpr Reference kScipy[] = {
    {2,
     0.06,
     {0.29920467596381783, 0.27221682140058917, 0.94740475732209839, -0.72841241357596609,
      0.92699963392738383, 0.94264596269433842, 0.84071827868535443}},
    {4,
     0.06,
     {0.30542945257119342, 0.28784555116766303, 0.97751315751281809, -0.74825552968259568,
      0.89966758819672332, 0.9463211996552805, 0.8430732984636522}},
    {6,
     0.11,
     {0.29645227366780225, 0.17378512015221337, 0.8660164018384926, -0.59598392839825454, 1.0379519551526113,
      0.94394793295147761, 0.82338514461891432}},
    {2,
     0.4,
     {0.29370152644954561, 0.33637300120614277, 0.91565673424619298, -0.58275100911574018, 1.0527783295134299,
      0.93958102915073805, 0.83062058202160405}},
    {8,
     0.2,
     {0.29391688717321413, 0.26025003645167277, 0.83876328098549713, -0.56488469189508717, 1.0664516473040593,
      0.86523587661604751, 0.83125871371002857}},
};

TEST(DigitalFilter, BothWaysEqualsScipysFiltfilt) {
  for (const Reference& reference : kScipy) {
    std::vector<double> x = signal();
    filter_both_ways(butterworth_lowpass(reference.order, reference.cutoff), usual_padding(reference.order),
                     x);
    for (int i = 0; i < 7; ++i)
      EXPECT_NEAR(x[static_cast<std::size_t>(kAt[i])], reference.y[i], 1e-9)
          << "order " << reference.order << " cut-off " << reference.cutoff << " sample " << kAt[i];
  }
}

TEST(DigitalFilter, AmplitudeIsButterworths) {
  for (const int order : {2, 4, 6, 10}) {
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
  std::vector<double> x = signal(), turned = signal();
  std::ranges::reverse(turned);
  const auto sections = butterworth_lowpass(4, 0.1);
  filter_both_ways(sections, 119, x);
  filter_both_ways(sections, 119, turned);
  std::ranges::reverse(turned);
  for (std::size_t i = 20; i < 100; ++i) EXPECT_NEAR(x[i], turned[i], 1e-6);
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
  EXPECT_THROW((void)butterworth_lowpass(3, 0.1), ContractError);
  EXPECT_THROW((void)butterworth_lowpass(2, 0.5), ContractError);
  EXPECT_THROW((void)butterworth_lowpass(2, std::nan("")), ContractError);
  EXPECT_THROW((void)two_pass_cutoff(2, 0.0), ContractError);
}

}  // namespace
}  // namespace kinemark::math
