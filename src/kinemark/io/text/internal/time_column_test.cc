// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/time_column.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::io::internal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Times of an even clock written with this resolution (0: in full).
std::vector<double> clock(int rows, double rate_hz, double resolution_s, double t0_s = 0.0) {
  std::vector<double> out;
  for (int i = 0; i < rows; ++i) {
    const double t = t0_s + i / rate_hz;
    out.push_back(resolution_s > 0.0 ? std::round(t / resolution_s) * resolution_s : t);
  }
  return out;
}

struct Outcome {
  TimeBase time;
  std::vector<std::string> warnings;
};

Outcome fit(const std::vector<double>& time_s, double resolution_s, std::vector<double> stated) {
  Outcome out;
  const auto time = even_time(time_s, resolution_s, stated, out.warnings);
  EXPECT_TRUE(time) << time.error().message;
  out.time = time.value_or(TimeBase{});
  return out;
}

TEST(Resolution, CountsWrittenDigits) {
  EXPECT_DOUBLE_EQ(resolution_of("1.250"), 0.01);
  EXPECT_DOUBLE_EQ(resolution_of("0.017000"), 0.001);
  EXPECT_DOUBLE_EQ(resolution_of("-300"), 1.0);
  EXPECT_DOUBLE_EQ(resolution_of("3."), 1.0);
  EXPECT_DOUBLE_EQ(resolution_of("3.00"), 1.0);
  EXPECT_DOUBLE_EQ(resolution_of("1.2e2"), 10.0);
  EXPECT_DOUBLE_EQ(resolution_of("1.25E-01"), 0.001);
  EXPECT_EQ(resolution_of("nan"), 0.0);
}

TEST(EvenTime, TakesTheHeadersRateWhenRoundingExplainsTheColumn) {
  for (const double rate_hz : {60.0, 119.88012, 150.0, 250.0, 29.97}) {
    for (const double resolution_s : {0.0, 1e-6, 1e-3}) {
      for (const int rows : {2, 5, 100, 3000}) {
        const auto out = fit(clock(rows, rate_hz, resolution_s, 0.4), resolution_s, {rate_hz});
        EXPECT_EQ(out.time.rate_hz, rate_hz) << resolution_s << " " << rows;
        EXPECT_THAT(out.warnings, IsEmpty()) << rate_hz << " " << resolution_s << " " << rows;
        EXPECT_NEAR(out.time.t0_s, 0.4, 0.5 * resolution_s + 1e-15);
        EXPECT_EQ(out.time.frames, rows);
      }
    }
  }
}

TEST(EvenTime, BelievesAnEvenColumnAgainstTheHeader) {
  const auto out = fit(clock(200, 25.0, 0.001), 0.001, {250.0});
  EXPECT_EQ(out.time.rate_hz, 25.0);
  EXPECT_THAT(out.warnings, ElementsAre(HasSubstr("250 Hz, but the time column runs at 25 Hz")));
  // A rounded header is no contradiction, but over an hour the column is more accurate.
  const auto ntsc = fit(clock(200'000, 60.0 / 1.001, 0.0), 0.0, {59.94});
  EXPECT_NEAR(ntsc.time.rate_hz, 60.0 / 1.001, 1e-9);
  EXPECT_THAT(ntsc.warnings, IsEmpty());
}

TEST(EvenTime, PrefersAnotherStatedRateThatFits) {
  const auto out = fit(clock(50, 120.0, 0.001), 0.001, {60.0, 120.0});
  EXPECT_EQ(out.time.rate_hz, 120.0);
  EXPECT_THAT(out.warnings, ElementsAre(HasSubstr("60 Hz")));
  EXPECT_THAT(fit(clock(50, 120.0, 0.001), 0.001, {0.0, 120.0}).warnings, IsEmpty());
}

TEST(EvenTime, FindsTheRateWithoutAHeader) {
  for (const std::vector<double>& nothing : {std::vector<double>{}, {0.0}, {-5.0}, {std::nan("")}}) {
    const auto out = fit(clock(100, 60.0, 0.001), 0.001, nothing);
    EXPECT_EQ(out.time.rate_hz, 60.0) << "the roundest number that fits";
    EXPECT_THAT(out.warnings, ElementsAre(HasSubstr("gives no rate")));
  }
  EXPECT_NEAR(fit(clock(100, 12.345, 0.0), 0.0, {}).time.rate_hz, 12.345, 1e-12);
}

TEST(EvenTime, TellsTheLargestDeviationOfAnUnevenColumn) {
  auto time_s = clock(126, 25.0, 0.0);
  time_s.back() = 4.992;
  const auto odd_end = fit(time_s, 0.001, {250.0});
  EXPECT_EQ(odd_end.time.rate_hz, 25.0);
  EXPECT_THAT(odd_end.warnings, ElementsAre(testing::AllOf(HasSubstr("row 126 is at 4.992 s, 0.008 s off"),
                                                           HasSubstr("250 Hz"))));

  // Ten frames lost in the middle: the header still has the right rate.
  auto gap = clock(100, 100.0, 0.0);
  for (std::size_t i = 50; i < gap.size(); ++i) gap[i] += 0.1;
  const auto lost = fit(gap, 0.01, {100.0});
  EXPECT_EQ(lost.time.rate_hz, 100.0);
  EXPECT_THAT(lost.warnings, ElementsAre(HasSubstr("0.1 s off an even 100 Hz")));
}

TEST(EvenTime, OneLostFrameIsSeenAtAnyRounding) {
  for (const double resolution_s : {0.0, 0.001, 0.01}) {
    auto time_s = clock(100, 100.0, 0.0);
    for (std::size_t i = 50; i < time_s.size(); ++i) time_s[i] += 0.01;
    EXPECT_THAT(fit(time_s, resolution_s, {100.0}).warnings, ElementsAre(HasSubstr("uneven")))
        << resolution_s;
  }
}

TEST(EvenTime, SurvivesTimesThatStandStillOrRunBackwards) {
  for (const std::vector<double>& times :
       {std::vector<double>{0.0, 0.0, 0.0}, {3.0, 2.0, 1.0}, {0.0, 1e300}}) {
    std::vector<std::string> warnings;
    const auto with_rate = even_time(times, 0.0, std::vector<double>{50.0}, warnings);
    ASSERT_TRUE(with_rate);
    EXPECT_GT(with_rate->rate_hz, 0.0);
    EXPECT_TRUE(std::isfinite(with_rate->rate_hz));
    EXPECT_FALSE(warnings.empty());
  }
  std::vector<std::string> warnings;
  EXPECT_THAT(even_time(std::vector<double>{0.0, 0.0}, 0.0, {}, warnings).error().message,
              HasSubstr("does not increase"));
}

TEST(EvenTime, ASingleRowNeedsTheHeader) {
  EXPECT_EQ(fit({2.5}, 0.1, {60.0}).time, (TimeBase{60.0, 2.5, 1}));
  std::vector<std::string> warnings;
  EXPECT_EQ(even_time(std::vector<double>{2.5}, 0.1, {}, warnings).error().code, Code::bad_input);
}

}  // namespace
}  // namespace kinemark::io::internal
