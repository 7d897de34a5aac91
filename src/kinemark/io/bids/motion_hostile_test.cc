// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Tables and sidecars with random bytes changed, taken away and doubled: one sentence or a valid trial.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "kinemark/core/random.h"
#include "kinemark/io/bids/motion_bids.h"

namespace kinemark::io {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::array<std::string, 3> whole() {
  std::string channels = "name\tcomponent\ttype\ttracked_point\tunits\tdescription\n", motion;
  for (const char* point : {"A", "B"})
    for (const char* axis : {"x", "y", "z"})
      channels += std::string(point) + axis + "\t" + axis + "\tPOS\t" + point + "\tmm\tmarker\n";
  channels += "t\tn/a\tLATENCY\tn/a\ts\ttime\n";
  for (int row = 0; row < 8; ++row)
    motion += std::to_string(row) + "\t-1.5\t2e2\tn/a\tn/a\tn/a\t" + std::to_string(0.5 + row / 120.0) + "\n";
  return {motion, channels, R"({"SamplingFrequency": 120.0, "MissingValues": "n/a"})"};
}

bool survives(const std::array<std::string, 3>& texts) {
  const auto trial = parse_motion_bids({.motion = texts[0], .channels = texts[1], .json = texts[2]});
  if (!trial) {
    EXPECT_THAT(trial.error().message, Not(HasSubstr("\n")));
    return false;
  }
  EXPECT_TRUE(trial->validate()) << trial->validate().error().message;
  EXPECT_LE(trial->markers.x_in_world.size(), texts[0].size());
  for (const std::string& warning : trial->warnings) EXPECT_THAT(warning, Not(HasSubstr("\n")));
  return true;
}

TEST(HostileMotionBids, CutAtEveryLength) {
  const auto texts = whole();
  EXPECT_TRUE(survives(texts));
  for (std::size_t which = 0; which < texts.size(); ++which)
    for (std::size_t n = 0; n < texts[which].size(); ++n) {
      auto cut = texts;
      cut[which].resize(n);
      survives(cut);
    }
}

TEST(HostileMotionBids, ChangedBytes) {
  Random random(11, 0);
  int read = 0;
  for (int i = 0; i < 4000; ++i) {
    auto texts = whole();
    std::string& text = texts[static_cast<std::size_t>(random.uniform(0.0, 3.0))];
    for (int changes = 0; changes < 1 + i % 4; ++changes) {
      const auto at = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(text.size())));
      const auto what = static_cast<int>(random.uniform(0.0, 3.0));
      if (what == 0)
        text[at] = static_cast<char>(static_cast<int>(random.uniform(0.0, 256.0)));
      else if (what == 1)
        text.erase(at, 1 + at % 7);
      else
        text.insert(at, text.substr(at / 2, 20));
      if (text.empty()) break;
    }
    read += survives(texts) ? 1 : 0;
  }
  EXPECT_GT(read, 100);
}

TEST(HostileMotionBids, DeepJsonAndManyColumnsEndInASentence) {
  auto texts = whole();
  texts[2] = std::string(200'000, '[');
  EXPECT_FALSE(survives(texts));
  texts = whole();
  texts[0] = std::string(100'000, '\t');
  EXPECT_FALSE(survives(texts));
}

}  // namespace
}  // namespace kinemark::io
