// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Recordings that are cut, have flipped bits or false contents. Every byte of a small one is tested.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "kinemark/core/random.h"
#include "kinemark/io/recording/internal/mcap.h"
#include "kinemark/io/recording/testing/small_recording.h"

namespace kinemark::io {
namespace {

using namespace internal;

const SmallRecording& small() {
  static const SmallRecording recording = make_small_recording(9);
  return recording;
}

/// Messages in groups that end at or before a byte.
std::size_t messages_before(std::size_t byte) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < small().group_ends.size(); ++i)
    if (small().group_ends[i] <= byte) n = small().messages_until[i];
  return n;
}

std::vector<std::string> all_texts() { return read_everything(small().bytes).texts; }

TEST(CutRecording, EveryPrefixKeepsExactlyTheWholeGroups) {
  const auto texts = all_texts();
  const std::size_t header = 58;  // magic, header, check
  for (std::size_t length = 0; length < small().bytes.size(); ++length) {
    const Found found = read_everything(std::span(small().bytes).first(length));
    if (length < header) {
      EXPECT_NE(found.error, "") << length;
      continue;
    }
    ASSERT_EQ(found.error, "") << length;
    const std::size_t kept = messages_before(length);
    ASSERT_EQ(found.messages.size(), kept) << length;
    EXPECT_TRUE(std::equal(found.texts.begin(), found.texts.end(), texts.begin())) << length;
    ASSERT_TRUE(found.end == RecordingEnd::open || found.end == RecordingEnd::cut) << length;
    // Bytes kept and bytes left out are the whole file.
    std::uint64_t left_out = 0;
    for (const auto& damage : found.damage) left_out += damage.bytes;
    EXPECT_EQ(found.kept_until + left_out, length);
    EXPECT_EQ(found.end == RecordingEnd::open, left_out == 0) << length;
    if (found.end == RecordingEnd::cut) {
      EXPECT_EQ(found.damage.at(0).offset, found.kept_until);
    }
  }
}

TEST(CutRecording, SkippingDamageKeepsTheSame) {
  for (std::size_t length = 58; length < small().bytes.size(); ++length) {
    const Found found = read_everything(std::span(small().bytes).first(length), true);
    EXPECT_EQ(found.messages.size(), messages_before(length)) << length;
  }
}

TEST(FlippedRecording, EveryBitIsNoticedAndNothingWrongIsHandedOut) {
  const auto texts = all_texts();
  Bytes bytes = small().bytes;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      bytes[at] ^= static_cast<std::byte>(1 << bit);
      const Found strict = read_everything(bytes);
      const Found skipping = read_everything(bytes, true);
      bytes[at] ^= static_cast<std::byte>(1 << bit);
      if (strict.error.empty()) {
        ASSERT_FALSE(strict.damage.empty()) << at << " bit " << bit;
        EXPECT_EQ(strict.messages.size(), messages_before(at)) << at << " bit " << bit;
        EXPECT_TRUE(std::equal(strict.texts.begin(), strict.texts.end(), texts.begin())) << at;
        EXPECT_LE(strict.damage[0].offset, at);
      } else {
        EXPECT_LT(at, 58U);
      }
      ASSERT_EQ(skipping.error, "") << at << " bit " << bit;
      ASSERT_FALSE(skipping.damage.empty()) << at << " bit " << bit;
      for (const std::string& text : skipping.texts) EXPECT_NE(std::ranges::find(texts, text), texts.end());
    }
  }
}

TEST(FlippedRecording, SkippingLosesTheGroupAndAtMostTheOneAfterIt) {
  const auto texts = all_texts();
  Bytes bytes = small().bytes;
  const std::size_t first_message = small().group_ends.front();
  for (std::size_t at = first_message; at < small().data_end; ++at) {
    bytes[at] ^= std::byte{0x10};
    const Found found = read_everything(bytes, true);
    bytes[at] ^= std::byte{0x10};
    EXPECT_GE(found.messages.size() + 3, texts.size()) << at;  // two groups hold at most three messages
    EXPECT_LT(found.messages.size(), texts.size()) << at;
    if (at >= small().group_ends[7]) continue;  // the last group may take the summary with it
    std::uint64_t left_out = 0;
    for (const auto& damage : found.damage) left_out += damage.bytes;
    EXPECT_LE(left_out, 2U * (small().group_ends[3] - small().group_ends[2])) << at;
  }
}

TEST(FlippedRecording, DamageInTheMiddleIsReportedWithItsPlace) {
  Bytes bytes = small().bytes;
  const std::size_t begin = small().group_ends[1];
  bytes[begin + 20] ^= std::byte{1};
  const Found found = read_everything(bytes, true);
  EXPECT_EQ(found.end, RecordingEnd::closed);
  ASSERT_EQ(found.damage.size(), 1U);
  EXPECT_EQ(found.damage[0].offset, begin);
  EXPECT_EQ(found.damage[0].bytes, small().group_ends[2] - begin);
  EXPECT_EQ(found.damage[0].what, "does not match its checksum");
  EXPECT_EQ(found.messages.size(), 10U);
}

TEST(SplicedRecording, GroupsThatVanishRepeatOrChangeOrderAreNoticed) {
  const auto part = [](std::size_t from, std::size_t to) {
    return std::span<const std::byte>(small().bytes).subspan(from, to - from);
  };
  const auto& ends = small().group_ends;
  const std::size_t size = small().bytes.size();
  const auto joined = [](std::initializer_list<std::span<const std::byte>> parts) {
    Bytes out;
    for (const auto& one : parts) put_bytes(out, one);
    return out;
  };
  const std::vector<Bytes> spliced{
      joined({part(0, ends[1]), part(ends[2], size)}),                          // one vanished
      joined({part(0, ends[1]), part(ends[0], ends[1]), part(ends[1], size)}),  // one twice
      joined({part(0, ends[0]), part(ends[1], ends[2]), part(ends[0], ends[1]), part(ends[2], size)})};
  for (const Bytes& bytes : spliced) {
    const Found found = read_everything(bytes);
    EXPECT_EQ(found.end, RecordingEnd::damaged);
    EXPECT_LE(found.messages.size(), 2U);
  }
}

TEST(LyingRecording, ClaimedLengthsCostNothing) {
  for (const std::uint64_t claim : {~0ULL, 1ULL << 62, 1ULL << 40, 16'777'217ULL, 16'000'000ULL}) {
    for (const std::size_t group : {std::size_t{0}, std::size_t{4}}) {
      Bytes bytes = small().bytes;
      const std::size_t at = small().group_ends[group] + 1;
      for (std::size_t i = 0; i < 8; ++i) bytes[at + i] = static_cast<std::byte>(claim >> (8 * i));
      const Found found = read_everything(bytes);
      EXPECT_EQ(found.messages.size(), small().messages_until[group]);
      EXPECT_EQ(found.damage.size(), 1U);
      EXPECT_GE(read_everything(bytes, true).messages.size() + 3, small().messages_until.back());
    }
  }
}

// Beginnings of check records everywhere: a search must not scan the rest of the file for each of them.
TEST(LyingRecording, AFileOfFalseChecksIsGivenUp) {
  Bytes bytes = make_small_recording(1, false).bytes;
  const std::size_t begin = bytes.size();
  put_u8(bytes, 1);  // damage
  while (bytes.size() < (8U << 20)) {
    put_u8(bytes, kCheck);
    put_u64(bytes, 8);
    put_u64(bytes, bytes.size());
    put_u8(bytes, kMessage);
    put_u64(bytes, 6U << 20);
  }
  const Found found = read_everything(bytes, true);
  EXPECT_EQ(found.messages.size(), 1U);
  ASSERT_EQ(found.damage.size(), 1U);
  EXPECT_EQ(found.damage[0].offset, begin);
}

TEST(NoiseRecording, RandomBytesAfterAGoodBeginningAreLeftOut) {
  Random random(11, 0);
  for (int round = 0; round < 50; ++round) {
    Bytes bytes = make_small_recording(3, false).bytes;
    const std::size_t good = bytes.size();
    const auto extra = static_cast<std::size_t>(random.uniform(1.0, 3000.0));
    for (std::size_t i = 0; i < extra; ++i)
      put_u8(bytes, static_cast<std::uint8_t>(random.uniform(0.0, 256.0)));
    for (const bool skip : {false, true}) {
      const Found found = read_everything(bytes, skip);
      EXPECT_EQ(found.messages.size(), 3U);
      EXPECT_EQ(found.kept_until, good);
      EXPECT_NE(found.end, RecordingEnd::closed);
    }
  }
}

}  // namespace
}  // namespace kinemark::io
