// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/finding.h"

#include <gmock/gmock.h>

#include <set>

namespace kinemark::data {
namespace {

using testing::EndsWith;
using testing::HasSubstr;

constexpr TimeBase kTime{.rate_hz = 100.0, .t0_s = 1.0, .frames = 500};
constexpr auto kLast = FindingKind::flagged;

std::string words(const Finding& finding) { return describe(finding, kTime); }

TEST(Finding, SaysWhoWhatHowLargeAndWhen) {
  EXPECT_EQ(
      words({.kind = FindingKind::spike, .subject = "A", .first_frame = 20, .last_frame = 22, .size = 0.012}),
      "marker 'A' leaves its path by 12.0 mm in frames 20 to 22 (1.2 to 1.22 s)");
  EXPECT_EQ(words({.kind = FindingKind::zero, .subject = "A", .first_frame = 5, .last_frame = 5}),
            "marker 'A' is exactly at the origin in frame 5 (1.05 s)");
  EXPECT_EQ(words({.kind = FindingKind::swap_within, .subject = "A", .partner = "B", .size = 0.25}),
            "marker 'A' jumps 250.0 mm to the path of 'B' and back to its own");
  EXPECT_EQ(
      words({.kind = FindingKind::label_swap,
             .subject = "A",
             .partner = "B",
             .first_frame = 0,
             .last_frame = 1,
             .size = 0.04}),
      "markers 'A' and 'B' carry each other's label in frames 0 to 1 (1 to 1.01 s) while 40.0 mm apart");
  EXPECT_EQ(words({.kind = FindingKind::label_swap, .subject = "A", .partner = "B"}),
            "markers 'A' and 'B' carry each other's label");
  EXPECT_EQ(words({.kind = FindingKind::marker_slip,
                   .subject = "A",
                   .partner = "thigh",
                   .first_frame = 131,
                   .last_frame = 499,
                   .size = 0.005,
                   .size_sd = 0.0004}),
            "marker 'A' lies 5.0 mm (SD 0.4) elsewhere on segment 'thigh' from 2.31 s on");
  EXPECT_EQ(words({.kind = FindingKind::joint_slip, .subject = "knee", .size = 0.005}),
            "joint 'knee' lies 5.0 mm elsewhere in its segment");
  EXPECT_EQ(
      words({.kind = FindingKind::loose_marker, .subject = "A", .size = 0.0032, .detail = "noise 1.0 mm"}),
      "marker 'A' moves on its segment by 3.2 mm: noise 1.0 mm");
  EXPECT_EQ(words({.kind = FindingKind::at_limit, .subject = "elbow", .size = 0.123}),
            "coordinate 'elbow' rests at a limit of its range in 12 % of the frames");
  EXPECT_EQ(words({.kind = FindingKind::not_settled, .subject = "the smoother", .size = 40}),
            "the smoother did not settle in 40 iterations over the recording");
  EXPECT_EQ(words({.kind = FindingKind::flagged, .size = 7}), "7 of 500 frames are flagged");
  EXPECT_EQ(words({.kind = FindingKind::clock_jump, .size = 3}), "the clock jumps by 3 frames");
}

TEST(Finding, WithoutASubjectItIsAboutAllMarkers) {
  EXPECT_EQ(words({.kind = FindingKind::duplicated_frame, .first_frame = 7, .last_frame = 7}),
            "all markers repeat the frame before digit by digit in frame 7 (1.07 s)");
  EXPECT_EQ(words({.kind = FindingKind::stuck}), "all markers hold one value digit by digit");
}

TEST(Finding, AUnitSlipIsTooLargeOrTooSmall) {
  EXPECT_THAT(words({.kind = FindingKind::unit_slip, .subject = "A", .size = 1000.0}),
              EndsWith("is 1000 times too large"));
  EXPECT_THAT(words({.kind = FindingKind::unit_slip, .size = 0.001}), EndsWith("are 1000 times too small"));
  EXPECT_THAT(words({.kind = FindingKind::unit_slip}), EndsWith("are in another unit"));
}

TEST(Finding, DoubtIsSaidAndUnknownConfidenceIsNone) {
  Finding finding{.kind = FindingKind::zero, .subject = "A"};
  EXPECT_TRUE(finding.sure());
  finding.confidence = 0.8;
  EXPECT_TRUE(finding.sure());
  finding.confidence = 0.62;
  EXPECT_FALSE(finding.sure());
  EXPECT_THAT(words(finding), EndsWith("(not certain: confidence 62 %)"));
}

TEST(Finding, EveryKindHasANameAndWordsOfItsOwn) {
  std::set<std::string> names, sentences;
  for (int k = 0; k <= static_cast<int>(kLast); ++k) {
    const auto kind = static_cast<FindingKind>(k);
    names.insert(std::string(to_string(kind)));
    sentences.insert(words({.kind = kind, .subject = "A", .partner = "B", .size = 2.0}));
  }
  EXPECT_EQ(names.size(), 15U);
  EXPECT_EQ(sentences.size(), 15U);
  EXPECT_EQ(to_string(FindingKind::label_swap), "label swap");
  EXPECT_EQ(to_string(kLast), "flagged");
}

TEST(Finding, ValidateRefusesWhatCannotBe) {
  const auto told = [](const Finding& finding) {
    const auto status = finding.validate();
    return status ? std::string() : status.error().message;
  };
  EXPECT_EQ(told({.kind = FindingKind::spike, .subject = "A", .first_frame = 3, .last_frame = 3}), "");
  EXPECT_THAT(told({.first_frame = 3, .last_frame = 2}), HasSubstr("from frame 3 to 2"));
  EXPECT_THAT(told({.first_frame = 3}), HasSubstr("need both in order, or none"));
  EXPECT_THAT(told({.kind = FindingKind::label_swap, .subject = "A"}), HasSubstr("need two markers"));
  EXPECT_THAT(told({.kind = FindingKind::label_swap, .subject = "A", .partner = "A"}),
              HasSubstr("two markers"));
  EXPECT_THAT(told({.size_sd = -1.0}), HasSubstr("negative standard deviation"));
  EXPECT_THAT(told({.confidence = 1.1}), HasSubstr("confidence of 1.1; need 0 to 1"));
}

}  // namespace
}  // namespace kinemark::data
