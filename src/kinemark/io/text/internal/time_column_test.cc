// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/time_column.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fmt/core.h>

#include <algorithm>
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
  std::vector<std::int64_t> frame;
};

Result<EvenClock> clock_of(const std::vector<double>& time_s, double resolution_s,
                           const std::vector<double>& stated, std::vector<std::string>& warnings,
                           std::int64_t most_frames = 1'000'000) {
  return even_clock(
      {.time_s = time_s,
       .resolution_s = resolution_s,
       .stated = stated,
       .most_frames = most_frames,
       .place = [](std::size_t row) { return fmt::format("line {} (frame {})", row + 7, row + 1); }},
      warnings);
}

std::string refusal(const std::vector<double>& time_s, const std::vector<double>& stated,
                    double resolution_s = 0.0, std::int64_t most_frames = 1'000'000) {
  std::vector<std::string> warnings;
  const auto clock = clock_of(time_s, resolution_s, stated, warnings, most_frames);
  if (clock) return "taken";
  EXPECT_EQ(clock.error().code, Code::bad_input);
  return clock.error().message;
}

Outcome fit(const std::vector<double>& time_s, double resolution_s, const std::vector<double>& stated) {
  Outcome out;
  const auto clock = clock_of(time_s, resolution_s, stated, out.warnings);
  EXPECT_TRUE(clock) << clock.error().message;
  if (!clock) return out;
  out.time = clock->time;
  out.frame = clock->frame;
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

TEST(EvenTime, AColumnAThousandTimesTheHeadersIsInMilliseconds) {
  const auto found = fit({0.0, 10.0, 20.0, 30.0}, 10.0, {100.0});
  EXPECT_EQ(found.time, (TimeBase{100.0, 0.0, 4}));
  EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("a thousand times those of the header's rate")));
  EXPECT_EQ(fit({500.0, 508.0, 517.0, 525.0}, 1.0, {120.0}).time.t0_s, 0.5) << "rounded to whole ones";
  // Of another factor the column is taken at its word.
  EXPECT_EQ(fit({0.0, 5.0, 10.0, 15.0}, 5.0, {100.0}).time.rate_hz, 0.2);
}

TEST(EvenTime, AColumnThatCountsFramesGetsTheHeadersRate) {
  const auto found = fit({1.0, 2.0, 3.0, 4.0}, 1.0, {100.0});
  EXPECT_EQ(found.time, (TimeBase{100.0, 0.0, 4}));
  EXPECT_THAT(found.warnings, ElementsAre(HasSubstr("times count frames, 1 by 1; the header's 100 Hz")));
  EXPECT_EQ(fit({0.0, 1.0, 2.0}, 1.0, {50.0}).time.t0_s, 0.0);
  EXPECT_EQ(fit({11.0, 12.0, 13.0}, 1.0, {50.0}).time.t0_s, 0.2);
  // Of a slow header, of none, and of steps that are not 1, the column is taken at its word.
  EXPECT_EQ(fit({1.0, 2.0, 3.0}, 1.0, {1.0}).time.t0_s, 1.0);
  EXPECT_EQ(fit({1.0, 2.0, 3.0}, 1.0, {}).time.rate_hz, 1.0);
  EXPECT_EQ(fit({0.5, 1.5, 2.5}, 0.1, {100.0}).time.rate_hz, 1.0);
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
}

TEST(EvenTime, FramesMissingFromTheColumnAreCounted) {
  // Ten frames lost in the middle: the header's rate is right, and without one the steps tell it.
  auto gap = clock(100, 100.0, 0.0);
  for (std::size_t i = 50; i < gap.size(); ++i) gap[i] += 0.1;
  for (const std::vector<double>& stated : {std::vector<double>{100.0}, std::vector<double>{}}) {
    const auto lost = fit(gap, 0.01, stated);
    EXPECT_EQ(lost.time, (TimeBase{100.0, 0.0, 110}));
    EXPECT_THAT(lost.warnings,
                ElementsAre(HasSubstr("1 hole, the first at line 57 (frame 51) (0.49 to 0.6 s): 10 "
                                      "frames are missing there")));
    ASSERT_EQ(lost.frame.size(), 100U);
    EXPECT_EQ(lost.frame[49], 49);
    EXPECT_EQ(lost.frame[50], 60);
    EXPECT_EQ(lost.frame.back(), 109);
  }
}

TEST(EvenTime, AStepThatIsOnTheEdgeOfAHoleIsOneFrameOrAHoleButNeverBoth) {
  // 0.029 s is a hole beside the median step of 0.011 s, and one frame and a half of the rate: uneven, no
  // lost frame.
  for (const double stated_hz : {0.0, 1.5 / 0.029, 50.0, 52.0}) {
    for (const double longest_s : {0.029, 0.0165, 0.0150, 0.0152}) {
      const std::vector<double> time_s = {0.011,
                                          0.011 + longest_s,
                                          0.022 + longest_s,
                                          0.031 + longest_s,
                                          0.042 + longest_s,
                                          0.051 + longest_s};
      std::vector<std::string> warnings;
      const auto fitted = clock_of(time_s, 0.0, {stated_hz}, warnings);
      if (!fitted) {
        EXPECT_THAT(fitted.error().message, HasSubstr("time jumps")) << stated_hz << ' ' << longest_s;
      } else {
        const bool says_hole = std::ranges::any_of(
            warnings, [](const std::string& w) { return w.find("hole") != std::string::npos; });
        EXPECT_EQ(says_hole, fitted->time.frames > 6) << stated_hz << ' ' << longest_s;
      }
    }
  }
}

TEST(EvenTime, OneLostFrameIsSeenAtAnyRounding) {
  for (const double resolution_s : {0.0, 0.001, 0.01}) {
    auto time_s = clock(100, 100.0, 0.0);
    for (std::size_t i = 50; i < time_s.size(); ++i) time_s[i] += 0.01;
    const auto out = fit(time_s, resolution_s, {100.0});
    EXPECT_THAT(out.warnings, ElementsAre(HasSubstr("1 frame is missing"))) << resolution_s;
    EXPECT_EQ(out.time.frames, 101);
  }
}

TEST(EvenTime, HolesAreFoundInAColumnRoundedToMilliseconds) {
  auto time_s = clock(400, 120.0, 0.001);
  for (std::size_t i = 150; i < time_s.size(); ++i)
    time_s[i] = std::round((static_cast<double>(i) + 37.0) / 120.0 * 1000.0) / 1000.0;
  for (const std::vector<double>& stated : {std::vector<double>{120.0}, std::vector<double>{}}) {
    const auto out = fit(time_s, 0.001, stated);
    EXPECT_EQ(out.time.frames, 437);
    EXPECT_NEAR(out.time.rate_hz, 120.0, 0.05);
    EXPECT_EQ(out.frame[150], 187);
  }
}

TEST(EvenTime, TimeThatGoesBackOrStandsStillIsRefused) {
  const std::vector<double> rate{50.0};
  EXPECT_THAT(refusal({0.0, 0.02, 0.01}, rate),
              HasSubstr("line 9 (frame 3): time goes back from 0.02 to 0.01 s; times must increase"));
  EXPECT_THAT(refusal({1.5, 1.5, 1.5}, rate), HasSubstr("line 8 (frame 2): time stands still at 1.5 s"));
  EXPECT_THAT(refusal({3.0, 2.0, 1.0}, {}), HasSubstr("goes back"));
  EXPECT_THAT(refusal(std::vector<double>(100, 1.5), {100.0}, 0.1), HasSubstr("stands still"));
  // One bad time in the middle of a good column.
  auto time_s = clock(100, 100.0, 0.0);
  time_s[40] = 0.2;
  EXPECT_THAT(refusal(time_s, {100.0}), HasSubstr("line 47 (frame 41): time goes back"));
}

TEST(EvenTime, RoundingMayRepeatATime) {
  // Written to hundredths: at 150 Hz every third time occurs twice, at 90 Hz each tenth is left out.
  for (const double rate_hz : {150.0, 240.0, 90.0}) {
    const auto out = fit(clock(300, rate_hz, 0.01), 0.01, {rate_hz});
    EXPECT_EQ(out.time, (TimeBase{rate_hz, 0.0, 300}));
    EXPECT_THAT(out.frame, IsEmpty()) << rate_hz << " Hz: nothing is missing";
  }
}

TEST(EvenTime, ImpossibleSteps) {
  EXPECT_THAT(refusal({0.0, 1e300}, {50.0}), HasSubstr("no camera takes frames at such a rate"));
  EXPECT_THAT(refusal({0.0, 1e-9, 2e-9}, {}), HasSubstr("no camera takes frames"));
  auto half = clock(100, 100.0, 0.0);
  for (std::size_t i = 50; i < half.size(); ++i) half[i] += 0.045;
  EXPECT_THAT(refusal(half, {100.0}),
              HasSubstr("line 57 (frame 51): time jumps from 0.49 to 0.545 s, 5.5 frame"));
  auto far = clock(100, 100.0, 0.0);
  far.back() = 900.0;
  EXPECT_THAT(refusal(far, {100.0}, 0.0, 50'000), HasSubstr("too long for the 100 rows"));
  EXPECT_EQ(refusal(far, {100.0}, 0.0, 100'000), "taken");
}

TEST(NoteJump, OnlyWhereTheRestIsEven) {
  const auto notes = [](const std::vector<double>& time_s) {
    std::vector<std::string> warnings;
    note_jump({.time_s = time_s,
               .resolution_s = 0.0,
               .stated = {},
               .most_frames = 0,
               .place = [](std::size_t row) { return fmt::format("row {}", row + 1); }},
              warnings);
    return warnings;
  };
  auto time_s = clock(100, 100.0, 0.0);
  EXPECT_THAT(notes(time_s), IsEmpty());
  for (std::size_t i = 60; i < time_s.size(); ++i) time_s[i] += 2.0;
  EXPECT_THAT(notes(time_s), ElementsAre(HasSubstr("row 61: time jumps from 0.59 to 2.6 s")));
  // An integrator's own steps are no clock.
  std::vector<double> growing{0.0};
  for (int i = 1; i < 60; ++i) growing.push_back(growing.back() + 0.001 * std::pow(1.1, i));
  EXPECT_THAT(notes(growing), IsEmpty());
}

TEST(EvenTime, ASingleRowNeedsTheHeader) {
  EXPECT_EQ(fit({2.5}, 0.1, {60.0}).time, (TimeBase{60.0, 2.5, 1}));
  std::vector<std::string> warnings;
  EXPECT_EQ(clock_of({2.5}, 0.1, {}, warnings).error().code, Code::bad_input);
}

}  // namespace
}  // namespace kinemark::io::internal
