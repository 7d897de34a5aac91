// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/serial/rig_answer.h"

#include <gmock/gmock.h>

#include "kinemark/stream/serial/testing/rig_bytes.h"

namespace kinemark::stream {
namespace {

TEST(RigAnswer, HasItsKindAndValues) {
  const std::string line = checked_line("plan leds=2 period=20000 level=255,128");
  const auto answer = find_answer(line);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->kind, "plan");
  EXPECT_EQ(answer->number("leds"), 2);
  EXPECT_EQ(answer->number("period"), 20000);
  EXPECT_EQ(answer->text("level"), "255,128");
  EXPECT_EQ(answer->number("level"), std::nullopt);
  EXPECT_EQ(answer->number("absent"), std::nullopt);
  EXPECT_EQ(answer->text("absent"), "");
  EXPECT_EQ(answer->end, line.size());
}

TEST(RigAnswer, IsFoundBehindFramesAndBeforeThem) {
  std::string bytes = "#\n#*\nplan*0000\n";
  for (std::uint32_t i = 0; i < 50; ++i)
    for (const auto byte : testing::telling_frame(3, 2, i)) bytes.push_back(static_cast<char>(byte));
  const std::string line = checked_line("stop frames=50 dropped=0");
  const auto answer = find_answer(bytes + line + bytes);
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->number("frames"), 50);
  EXPECT_EQ(answer->end, bytes.size() + line.size());
}

TEST(RigAnswer, IsNoneWhenOneByteIsAnother) {
  const std::string line = checked_line("stop frames=50 dropped=0");
  for (std::size_t i = 0; i < line.size(); ++i) {
    std::string damaged = line;
    damaged[i] = static_cast<char>(damaged[i] ^ 1);
    EXPECT_FALSE(find_answer(damaged)) << i;
    EXPECT_FALSE(find_answer(line.substr(0, i))) << i;
  }
}

TEST(RigAnswer, OfNothingIsNothing) {
  EXPECT_FALSE(find_answer(""));
  EXPECT_FALSE(find_answer("\n\n#\n"));
  EXPECT_EQ(checked_line("start"), "#start*96AF\n");
}

}  // namespace
}  // namespace kinemark::stream
