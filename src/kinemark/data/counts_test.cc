// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/counts.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/data/rig.h"

namespace kinemark::data {
namespace {

using testing::HasSubstr;

Counts small(bool dark = true) {
  auto c = Counts::zeros({"hand", "wrist", "elbow"}, {"A", "B"}, {.rate_hz = 100.0, .t0_s = 0.0, .frames = 4},
                         dark);
  for (std::size_t i = 0; i < c.counts.size(); ++i) c.counts[i] = static_cast<std::int16_t>(i);
  return c;
}

TEST(Counts, LayoutIsFrameLedCameraChannel) {
  auto c = small();
  EXPECT_EQ(c.counts.size(), 4U * 3 * 2 * 4);
  EXPECT_EQ(c.at(0, 0, 0), Eigen::Vector4d(0, 1, 2, 3));
  EXPECT_EQ(c.at(0, 0, 1), Eigen::Vector4d(4, 5, 6, 7));
  EXPECT_EQ(c.at(0, 1, 0), Eigen::Vector4d(8, 9, 10, 11));
  EXPECT_EQ(c.at(1, 0, 0)[0], 24.0);
  c.conversion_time_s[4 * (2 * 2 + 1) + 3] = 0.5e-3;
  EXPECT_EQ(c.offset_s(2, 1)[3], 0.5e-3);
  c.dark[4 * (3 * 2 + 1)] = 9;
  c.dark_time_s[4] = 3e-3;
  EXPECT_EQ(c.dark_at(3, 1)[0], 9.0);
  EXPECT_EQ(c.dark_offset_s(1)[0], 3e-3);
  c.flags[c.index(2, 1, 0)] = kCountSaturated | kCountOccluded;
  EXPECT_TRUE(c.has_flag(2, 1, 0, kCountOccluded));
  EXPECT_FALSE(c.has_flag(2, 1, 0, kCountLost));
  EXPECT_FALSE(c.has_flag(2, 1, 1, kCountOccluded));
  EXPECT_TRUE(c.validate());
  EXPECT_TRUE(small(false).validate());
  EXPECT_FALSE(small(false).has_dark_slot());
}

TEST(Counts, EachBrokenRuleIsNamed) {
  const auto message = [](auto&& spoil) {
    auto c = small();
    spoil(c);
    const auto status = c.validate();
    return status ? std::string("valid") : status.error().message;
  };
  EXPECT_THAT(message([](Counts& c) { c.time.frames = -1; }), HasSubstr("-1 frames"));
  EXPECT_THAT(message([](Counts& c) { c.time.rate_hz = 0.0; }), HasSubstr("0 frames per second"));
  EXPECT_THAT(message([](Counts& c) { c.leds[1] = "hand"; }), HasSubstr("LED name 'hand' occurs twice"));
  EXPECT_THAT(message([](Counts& c) { c.cameras[0] = ""; }), HasSubstr("a camera has no name"));
  EXPECT_THAT(message([](Counts& c) { c.counts.pop_back(); }), HasSubstr("95 numbers of counts; need 96"));
  EXPECT_THAT(message([](Counts& c) { c.flags.pop_back(); }), HasSubstr("numbers of flags; need 24"));
  EXPECT_THAT(message([](Counts& c) { c.conversion_time_s.clear(); }),
              HasSubstr("conversion times; need 24"));
  EXPECT_THAT(message([](Counts& c) { c.dark_time_s.clear(); }), HasSubstr("dark counts; need 0"));
  EXPECT_THAT(message([](Counts& c) { c.dark.clear(); }), HasSubstr("dark counts; need 32"));
  EXPECT_THAT(message([](Counts& c) { c.counts[7] = 4096; }), HasSubstr("count number 7 is 4096"));
  EXPECT_THAT(message([](Counts& c) { c.dark[3] = -1; }), HasSubstr("dark count number 3 is -1"));
  EXPECT_THAT(message([](Counts& c) { c.conversion_time_s[0] = 0.5; }), HasSubstr("0.5 s after its frame"));
  EXPECT_THAT(message([](Counts& c) { c.dark_time_s[0] = std::nan(""); }),
              HasSubstr("nan s after its frame"));
}

TEST(Counts, AreOfTheRigWithAsManyCamerasAndTheSameId) {
  auto counts = small();
  Rig rig;
  rig.cameras.resize(2);
  EXPECT_TRUE(check_same_rig(counts, rig)) << "neither has an id";
  counts.rig_id = "lab 2";
  EXPECT_TRUE(check_same_rig(counts, rig)) << "an id that is not known is no other";
  rig.id = "lab 2";
  EXPECT_TRUE(check_same_rig(counts, rig));
  rig.id = "lab 3";
  EXPECT_EQ(check_same_rig(counts, rig).error().message,
            "the recording was made with rig 'lab 2', this rig is 'lab 3'");
  counts.rig_id.clear();
  rig.cameras.resize(3);
  const auto status = check_same_rig(counts, rig);
  EXPECT_EQ(status.error().message, "the recording has 2 cameras and the rig 3; they must be the same");
  EXPECT_EQ(status.error().code, Code::bad_input);
}

}  // namespace
}  // namespace kinemark::data
