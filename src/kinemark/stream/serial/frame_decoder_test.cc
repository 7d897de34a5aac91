// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/serial/frame_decoder.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <string_view>

#include "kinemark/core/random.h"
#include "kinemark/stream/serial/check_sum.h"
#include "kinemark/stream/serial/testing/rig_bytes.h"

namespace kinemark::stream {
namespace {

using testing::Bytes;
using testing::telling_counts;
using testing::telling_frame;

constexpr FrameShape kShape{.slots = 3, .cameras = 2};

void append(Bytes& to, const Bytes& more) { to.insert(to.end(), more.begin(), more.end()); }

Bytes frames(std::uint32_t first, std::uint32_t count) {
  Bytes out;
  for (std::uint32_t i = first; i < first + count; ++i) append(out, telling_frame(3, 2, i));
  return out;
}

/// Numbers of all frames found; each is what was sent.
std::vector<std::int64_t> numbers(FrameDecoder& decoder) {
  std::vector<std::int64_t> out;
  SerialFrame frame;
  while (decoder.next(frame)) {
    EXPECT_EQ(frame.counts, telling_counts(3, 2, static_cast<std::uint32_t>(frame.number)));
    out.push_back(frame.number);
  }
  return out;
}

TEST(Crc16, IsThatOfTheCatalogue) {
  const std::string_view digits = "123456789";
  EXPECT_EQ(crc16({reinterpret_cast<const std::uint8_t*>(digits.data()), digits.size()}), 0x29B1);
  EXPECT_EQ(crc16({}), 0xFFFF);
}

TEST(FrameDecoder, FindsEveryFrameHoweverTheBytesCome) {
  const Bytes sent = frames(0, 20);
  EXPECT_EQ(telling_frame(3, 2, 0).size(), kShape.bytes());
  for (const std::size_t step : {1UL, 2UL, 7UL, 44UL, 45UL, 1000UL}) {
    FrameDecoder decoder(kShape);
    std::size_t found = 0;
    for (std::size_t at = 0; at < sent.size(); at += step) {
      decoder.push(std::span(sent).subspan(at, std::min(step, sent.size() - at)));
      found += numbers(decoder).size();
    }
    EXPECT_EQ(found, 20U) << step;
    EXPECT_EQ(decoder.losses().lost + decoder.losses().stray + decoder.losses().refused, 0) << step;
  }
}

TEST(FrameDecoder, CountsFramesThatTheFirstOnesNumberSaysAreMissing) {
  FrameDecoder decoder(kShape);
  decoder.push(frames(4, 2));
  EXPECT_THAT(numbers(decoder), ::testing::ElementsAre(4, 5));
  EXPECT_EQ(decoder.losses().lost, 4);
  EXPECT_EQ(decoder.losses().by_device, 0);
}

TEST(FrameDecoder, TellsWhatTheDeviceDroppedFromWhatTheLineLost) {
  FrameDecoder decoder(kShape);
  decoder.push(telling_frame(3, 2, 0, 0));
  decoder.push(telling_frame(3, 2, 3, 2));
  decoder.push(telling_frame(3, 2, 5, 2));
  EXPECT_THAT(numbers(decoder), ::testing::ElementsAre(0, 3, 5));
  EXPECT_EQ(decoder.losses().lost, 3);
  EXPECT_EQ(decoder.losses().by_device, 2);
}

TEST(FrameDecoder, GoesOnWhenTheNumberRunsOver) {
  FrameDecoder decoder(kShape);
  SerialFrame frame;
  std::int64_t last = -1;
  for (std::uint64_t number = 0; number < (1ULL << 33); number += (1U << 24) - 1) {
    decoder.push(telling_frame(3, 2, static_cast<std::uint32_t>(number)));
    ASSERT_TRUE(decoder.next(frame)) << number;
    last = frame.number;
  }
  EXPECT_GT(last, (1LL << 33) - (1LL << 24));
}

TEST(FrameDecoder, RefusesFramesThatCameTwiceOrFromNowhere) {
  FrameDecoder decoder(kShape);
  decoder.push(frames(0, 3));
  decoder.push(frames(1, 2));
  decoder.push(frames(0x7000'0000, 1));
  decoder.push(frames(3, 1));
  EXPECT_THAT(numbers(decoder), ::testing::ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(decoder.losses().refused, 3);
  EXPECT_EQ(decoder.losses().lost, 0);
}

TEST(FrameDecoder, TakesNoFrameOfAnotherShape) {
  FrameDecoder decoder(kShape);
  decoder.push(telling_frame(2, 2, 0));
  decoder.push(telling_frame(3, 1, 0));
  decoder.push(frames(0, 1));
  EXPECT_THAT(numbers(decoder), ::testing::ElementsAre(0));
}

TEST(FrameDecoder, FindsFramesBehindAnythingThatIsLikeOne) {
  FrameDecoder decoder(kShape);
  decoder.push(Bytes{0xA5, 0xA5, 0x5A, 3, 2, 0xA5, 0x5A, 3, 2});
  decoder.push(frames(0, 3));
  EXPECT_THAT(numbers(decoder), ::testing::ElementsAre(0, 1, 2));
  EXPECT_EQ(decoder.losses().stray, 9);
}

/// One fault at every byte of the middle frame: that one may be lost, the others never.
template <class Fault>
void try_faults(Fault fault) {
  const std::size_t size = kShape.bytes();
  for (std::size_t at = size; at < 2 * size; ++at) {
    Bytes sent = frames(0, 4);
    fault(sent, at);
    FrameDecoder decoder(kShape);
    decoder.push(sent);
    const auto found = numbers(decoder);
    EXPECT_GE(found.size(), 3U) << at;
    for (const std::int64_t whole : {0, 2, 3})
      EXPECT_TRUE(std::ranges::find(found, whole) != found.end()) << at << " lost frame " << whole;
    EXPECT_EQ(decoder.losses().lost, 4 - static_cast<std::int64_t>(found.size())) << at;
  }
}

TEST(FrameDecoder, LosesOneFrameByOneFault) {
  const auto at = [](Bytes& bytes, std::size_t i) { return bytes.begin() + static_cast<std::ptrdiff_t>(i); };
  try_faults([&](Bytes& b, std::size_t i) { b.erase(at(b, i)); });
  try_faults([&](Bytes& b, std::size_t i) { b.insert(at(b, i), b[i]); });
  try_faults([&](Bytes& b, std::size_t i) { b[i] ^= 0x10; });
  try_faults([&](Bytes& b, std::size_t i) {
    if (i + 1 < 2 * kShape.bytes()) std::swap(b[i], b[i + 1]);
  });
}

TEST(FrameDecoder, FindsItsWayWithinTwoFramesOfAnotherBaud) {
  Random random(3, 0);
  for (int trial = 0; trial < 200; ++trial) {
    FrameDecoder decoder(kShape);
    Bytes noise(100 + static_cast<std::size_t>(trial));
    for (auto& byte : noise) byte = static_cast<std::uint8_t>(random.uniform() * 256.0);
    decoder.push(noise);
    decoder.push(frames(0, 2));
    EXPECT_THAT(numbers(decoder), ::testing::ElementsAre(0, 1));
  }
}

TEST(FrameDecoder, CountsEveryLossOfALineThatSpoilsAHundredthOfItsBytes) {
  Random random(11, 0);
  const Bytes sent = frames(0, 3000);
  Bytes come;
  for (std::size_t i = 0; i < sent.size(); ++i) {
    const double dice = random.uniform();
    if (dice < 0.003) continue;
    come.push_back(sent[i]);
    if (dice < 0.006) come.push_back(sent[i]);
    if (dice > 0.997 && i > 0) std::swap(come.back(), come[come.size() - 2]);
  }
  append(come, frames(3000, 1));
  FrameDecoder decoder(kShape);
  decoder.push(come);
  const auto found = numbers(decoder);
  EXPECT_EQ(found.back(), 3000);
  EXPECT_GT(found.size(), 1500U);
  EXPECT_EQ(decoder.losses().lost, 3001 - static_cast<std::int64_t>(found.size()));
  EXPECT_EQ(decoder.losses().refused, 0);
}

TEST(FrameDecoder, RefusesAShapeThatNoFrameHas) {
  EXPECT_ANY_THROW(FrameDecoder({.slots = 0, .cameras = 2}));
}

}  // namespace
}  // namespace kinemark::stream
