// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/internal/frame_anchor.h"

#include <gtest/gtest.h>

#include <cmath>

namespace kinemark::stream {
namespace {

constexpr double kRate_hz = 100.0;
constexpr std::int64_t kSecond_ns = 1'000'000'000;

/// When the frames before `number` have ended by a device's clock that is fast by `drift`.
std::int64_t ended_ns(std::int64_t number, double drift) {
  return std::llround(1e9 * static_cast<double>(number) / (kRate_hz * (1.0 + drift)));
}

/// Frames read one by one, from `from` to before `to`.
void read_frames(FrameAnchor& anchor, std::int64_t from, std::int64_t to, double drift) {
  for (auto n = from + 1; n <= to; ++n) anchor.came(n, ended_ns(n, drift));
}

TEST(FrameAnchor, ABreakIsAsLongAsTheHostSaysWhateverDriftWentBefore) {
  for (const double drift : {0.0, 1e-3, -1e-3, 5e-3, -5e-3}) {
    FrameAnchor anchor(kRate_hz);
    anchor.begin(0, 0);
    read_frames(anchor, 0, 360'000, drift);
    EXPECT_EQ(anchor.after_break(360'000, ended_ns(360'000, drift) + 3 * kSecond_ns), 360'300) << drift;
  }
}

TEST(FrameAnchor, FramesThatWaitedInABufferTellNoTime) {
  FrameAnchor anchor(kRate_hz);
  anchor.begin(0, 0);
  read_frames(anchor, 0, 1000, 0.0);
  // The reader stalls for a minute; a buffer of 20 s is full, and then read at once.
  for (std::int64_t n = 1500; n <= 3000; n += 500) anchor.came(n, 70 * kSecond_ns);
  EXPECT_EQ(anchor.after_break(3000, 70 * kSecond_ns), 7000);
}

TEST(FrameAnchor, KnowsTheTimeAgainOnceAReaderHasCaughtUp) {
  FrameAnchor anchor(kRate_hz);
  anchor.begin(0, 0);
  read_frames(anchor, 0, 1000, 5e-3);
  anchor.came(1500, 40 * kSecond_ns);
  read_frames(anchor, 4100, 100'000, 5e-3);
  EXPECT_EQ(anchor.after_break(100'000, ended_ns(100'000, 5e-3) + kSecond_ns), 100'100);
}

TEST(FrameAnchor, AtLeastOneFrameIsMissing) {
  FrameAnchor anchor(kRate_hz);
  anchor.begin(0, 0);
  EXPECT_EQ(anchor.after_break(0, 0), 1);
  anchor.came(5000, kSecond_ns);
  EXPECT_EQ(anchor.after_break(5000, kSecond_ns), 5001);
}

TEST(FrameAnchor, AWaitForATriggerDoesNotCount) {
  FrameAnchor anchor(kRate_hz);
  anchor.came(1, 500 * kSecond_ns);
  EXPECT_EQ(anchor.after_break(1, 501 * kSecond_ns), 101);
}

}  // namespace
}  // namespace kinemark::stream
