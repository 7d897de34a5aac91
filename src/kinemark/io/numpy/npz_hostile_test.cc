// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "kinemark/core/random.h"
#include "kinemark/io/numpy/internal/zip_members.h"
#include "kinemark/io/numpy/npz.h"
#include "kinemark/io/numpy/testing/archive.h"

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;
using namespace testing_npz;

std::string archive(bool compressed) {
  std::vector<double> x;
  for (int i = 0; i < 60; ++i) x.push_back(0.01 * i);
  return zip({{"markers.npy", npy("<f8", "(10, 2, 3)", doubles(x))},
              {"names.npy", texts({"A", "B"}, "(2,)")},
              {"fs.npy", npy("<f8", "()", doubles({100.0}))},
              {"unit.npy", texts({"m"}, "()")}},
             compressed);
}

TEST(NpzHostile, CutShortAtAnyByteIsRefused) {
  for (const bool compressed : {false, true}) {
    const std::string good = archive(compressed);
    ASSERT_TRUE(parse_npz(bytes_of(good), "a.npz"));
    for (std::size_t size = 0; size < good.size(); ++size)
      EXPECT_FALSE(parse_npz(bytes_of(good.substr(0, size)), "a.npz")) << size;
  }
}

TEST(NpzHostile, ChangedBytesNeverGiveAnInvalidTrial) {
  Random random(3, 0);
  for (const bool compressed : {false, true}) {
    const std::string good = archive(compressed);
    for (int trial = 0; trial < 3000; ++trial) {
      std::string bad = good;
      for (int change = 0; change < 3; ++change)
        bad[static_cast<std::size_t>(random.uniform() * static_cast<double>(bad.size() - 1))] =
            static_cast<char>(static_cast<unsigned char>(random.uniform() * 255.0));
      const auto read = parse_npz(bytes_of(bad), "a.npz");
      if (read)
        EXPECT_TRUE(read->validate());
      else
        EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
    }
  }
}

TEST(NpzHostile, MembersThatLieAboutTheirSizeAreRefused) {
  const std::string plain(1000, 'x');
  const std::string packed = deflated(plain);
  internal::ZipMember member{.name = "a", .deflated = true, .bytes = 1000, .packed = bytes_of(packed)};
  ASSERT_TRUE(internal::unpack(member));
  for (const std::size_t bytes : {std::size_t{999}, std::size_t{1001}, std::size_t{1} << 40U}) {
    member.bytes = bytes;
    EXPECT_THAT(internal::unpack(member).error().message, HasSubstr("damaged or cut short")) << bytes;
  }
}

TEST(NpzHostile, EncryptedAndOtherPackingIsNamed) {
  std::string encrypted = archive(false);
  const auto entry = encrypted.find("PK\x01\x02");
  encrypted[entry + 8] = 1;
  EXPECT_THAT(parse_npz(bytes_of(encrypted), "a.npz").error().message,
              HasSubstr("member 'markers.npy' is encrypted"));
  std::string other = archive(false);
  other[entry + 10] = 12;
  EXPECT_THAT(parse_npz(bytes_of(other), "a.npz").error().message, HasSubstr("another way than deflate"));
}

}  // namespace
}  // namespace kinemark::io
