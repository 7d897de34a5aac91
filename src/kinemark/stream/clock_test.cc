// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/clock.h"

#include <gmock/gmock.h>

namespace kinemark::stream {
namespace {

TEST(SteadyHostClock, SleepsUntilATimeAndNotForOneThatIsOver) {
  SteadyHostClock clock;
  const auto before = clock.now_ns();
  clock.sleep_until(before + 2'000'000);
  const auto after = clock.now_ns();
  EXPECT_GE(after, before + 2'000'000);
  clock.sleep_until(before);
  clock.sleep_until(-1);
  EXPECT_GE(clock.now_ns(), after);
}

}  // namespace
}  // namespace kinemark::stream
