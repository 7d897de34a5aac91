// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Files cut anywhere and with random bytes changed: one sentence or a valid trial, and no more memory than
// the bytes explain.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/core/random.h"
#include "kinemark/io/xdf/testing/xdf_bytes.h"
#include "kinemark/io/xdf/xdf.h"

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

bool survives(const std::string& file) {
  const auto trial = parse_xdf(std::as_bytes(std::span(file)), "hostile.xdf");
  if (!trial) {
    EXPECT_THAT(trial.error().message, StartsWith("hostile.xdf: "));
    EXPECT_THAT(trial.error().message, Not(HasSubstr("\n")));
    return false;
  }
  EXPECT_TRUE(trial->validate()) << trial->validate().error().message;
  EXPECT_LE(trial->markers.x_in_world.size(), 11 * file.size());  // ten dropped frames a sample
  for (const std::string& warning : trial->warnings) EXPECT_THAT(warning, Not(HasSubstr("\n")));
  return true;
}

std::string whole() {
  std::string file = testing::small_file(20);
  file += testing::offset(1000.0, 0.5) + testing::offset(1001.0, 0.5);
  return file + testing::chunk(5, std::string(16, '\x43'), 1);
}

TEST(HostileXdf, CutAtEveryLength) {
  const std::string file = whole();
  EXPECT_TRUE(survives(file));
  for (std::size_t n = 0; n < file.size(); ++n) survives(file.substr(0, n));
}

TEST(HostileXdf, ChangedBytes) {
  const std::string file = whole();
  Random random(9, 0);
  int read = 0;
  for (int i = 0; i < 6000; ++i) {
    std::string changed = file;
    for (int changes = 0; changes <= i % 4; ++changes)
      changed[static_cast<std::size_t>(random.uniform(4.0, static_cast<double>(file.size())))] =
          static_cast<char>(static_cast<int>(random.uniform(0.0, 256.0)));
    read += survives(changed) ? 1 : 0;
  }
  EXPECT_GT(read, 1000);
}

TEST(HostileXdf, CountsThatNothingExplainsCostNothing) {
  using testing::raw;
  const std::string begin = testing::xdf_start() + testing::motion_header({"A"}, 100.0);
  EXPECT_FALSE(survives(
      begin + testing::chunk(3, raw(std::uint32_t{1}) + raw(std::uint8_t{8}) + raw(~std::uint64_t{0}))));
  EXPECT_FALSE(survives(begin + raw(std::uint8_t{8}) + raw(~std::uint64_t{0}) + raw(std::uint16_t{3})));
  EXPECT_FALSE(survives(testing::xdf_start() +
                        testing::motion_header({"A"}, 100.0, "float32", "m", "", 999'990) +
                        testing::samples({testing::sample<float>(1.0, {1, 2, 3})})));
}

}  // namespace
}  // namespace kinemark::io
