// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/frame_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

#include "kinemark/core/random.h"

namespace kinemark::data {
namespace {

using testing::HasSubstr;
using Frames = std::vector<std::int64_t>;

std::string words(const Frames& frames, std::int64_t first_number = 0) {
  return words_of_frames(frames,
                         {.rate_hz = 100.0, .t0_s = 0.0, .frames = 1000, .first_number = first_number});
}

Frames every(std::int64_t step, std::int64_t first, std::int64_t last) {
  Frames frames;
  for (auto f = first; f <= last; f += step) frames.push_back(f);
  return frames;
}

TEST(FrameList, APatternIsSaidOnlyWhereThereIsOne) {
  EXPECT_EQ(words({}), "");
  EXPECT_EQ(words({7}), "frame 7");
  EXPECT_EQ(words({7, 8, 9}), "frames 7 to 9");
  EXPECT_EQ(words(every(3, 1, 127)), "every third frame from 1 to 127");
  EXPECT_EQ(words(every(2, 0, 8), 1), "every second frame from 1 to 9") << "by the file's numbers";
  EXPECT_EQ(words(every(12, 0, 48)), "every 12th frame from 0 to 48");
  EXPECT_EQ(words(every(23, 0, 92)), "every 23rd frame from 0 to 92");
  EXPECT_EQ(words({3, 6}), "frames 3, 6") << "two are no pattern";
  EXPECT_EQ(words({3, 6, 10, 20, 24, 31}), "frames 3, 6, 10, 20, 24, 31");
}

TEST(FrameList, AFewOutOfStepAreNearlyAPatternAndManyAreNone) {
  Frames toes = every(3, 1, 19);
  for (const auto f : every(3, 20, 122)) toes.push_back(f);
  EXPECT_EQ(words(toes), "nearly every third frame from 1 to 122");
  Frames mixed;
  for (std::int64_t f = 0, step = 2; f < 60; f += step, step = step == 2 ? 3 : 2) mixed.push_back(f);
  EXPECT_THAT(words(mixed), HasSubstr("frames 0, 2, 5"));
  EXPECT_THAT(words(mixed), HasSubstr("more spans"));
}

TEST(FrameList, StretchesAreNamedUpToSix) {
  Frames frames;
  for (const std::int64_t f : {3, 9, 20, 31, 40, 55}) frames.insert(frames.end(), {f, f + 1});
  EXPECT_EQ(words(frames), "frames 3 to 4, 9 to 10, 20 to 21, 31 to 32, 40 to 41, 55 to 56");
  frames.push_back(70);
  EXPECT_THAT(words(frames), HasSubstr("55 to 56 and 1 more span"));
}

TEST(FrameList, TextAndFramesAreTheSame) {
  EXPECT_EQ(format_frame_list(Frames{1, 4, 19, 20}), "1,4,19-20");
  EXPECT_EQ(format_frame_list(every(3, 1, 127)), "1-127/3");
  EXPECT_EQ(format_frame_list(Frames{-3, -2, -1, 5}), "-3--1,5");
  Random random(3, 1);
  for (int draw = 0; draw < 200; ++draw) {
    Frames frames;
    for (std::int64_t f = -5; f < 200; ++f)
      if (random.uniform(0.0, 1.0) < 0.3) frames.push_back(f);
    if (frames.empty()) continue;
    EXPECT_EQ(parse_frame_list(format_frame_list(frames)).value(), frames);
  }
}

TEST(FrameList, WhatIsNoListIsRefused) {
  const auto message = [](std::string_view text) {
    const auto list = parse_frame_list(text, 1000);
    return list ? std::string() : list.error().message;
  };
  for (const char* text : {"", "a", "1,", ",1", "1-", "1-5/", "1-5/0", "5-1", "1 2", "99999999999", "1-2-3"})
    EXPECT_THAT(message(text), HasSubstr("is no list of frames")) << text;
  EXPECT_THAT(message("4,1"), HasSubstr("frame 1 comes after frame 4"));
  EXPECT_THAT(message("1-5,5"), HasSubstr("in order"));
  EXPECT_THAT(message("1-1001"), HasSubstr("more than 1000 frames"));
  EXPECT_EQ(message("1-1000"), "");
}

}  // namespace
}  // namespace kinemark::data
