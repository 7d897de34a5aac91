// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/input/file_hash.h"

#include <gmock/gmock.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

TEST(HashFile, IsTheChecksumThatXxhsumPrints) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "empty", "", false));
  ASSERT_TRUE(write_text(scratch / "abc", "abc", false));
  // `xxhsum -H3` of nothing and of "abc", as the xxHash specification lists them.
  EXPECT_EQ(hash_file(scratch / "empty").value().hex, "2d06800538d394c2");
  EXPECT_EQ(hash_file(scratch / "abc").value().hex, "78af5f94892f3950");
  EXPECT_EQ(hash_file(scratch / "abc").value().bytes, 3);
}

TEST(HashFile, ReadsInBlocksWithTheSameResultAsAnyOtherSplit) {
  const testing_support::ScratchFolder scratch;
  std::string text(3'000'001, 'k');
  ASSERT_TRUE(write_text(scratch / "long", text, false));
  const auto whole = hash_file(scratch / "long").value();
  EXPECT_EQ(whole.bytes, 3'000'001);
  text.back() = 'l';
  ASSERT_TRUE(write_text(scratch / "other", text, false));
  EXPECT_NE(hash_file(scratch / "other").value().hex, whole.hex) << "the last byte counts";
}

TEST(HashFile, SeveralFilesCountAsOneWithAllTheirBytes) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "a", "a", false));
  ASSERT_TRUE(write_text(scratch / "bc", "bc", false));
  const std::vector<std::filesystem::path> both{scratch / "a", scratch / "bc"};
  const auto record = record_inputs("images", "folder", both).value();
  EXPECT_EQ(record.hash, "78af5f94892f3950") << "of \"abc\"";
  EXPECT_EQ(record.bytes, 3);
  EXPECT_EQ(record.path, "folder");
  const std::vector<std::filesystem::path> turned{scratch / "bc", scratch / "a"};
  EXPECT_NE(hash_files(turned).value().hex, record.hash);
  const std::vector<std::filesystem::path> lacking{scratch / "a", scratch / "absent"};
  EXPECT_EQ(hash_files(lacking).error().code, Code::io);
}

TEST(HashFile, SaysWhatCannotBeRead) {
  const testing_support::ScratchFolder scratch;
  const auto absent = hash_file(scratch / "absent");
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, Code::io);
  EXPECT_THAT(absent.error().message, testing::HasSubstr("absent"));
}

}  // namespace
}  // namespace kinemark::io
