// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/finding.h"

#include <gmock/gmock.h>

#include <set>

namespace kinemark::data {
namespace {

using testing::AnyOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

constexpr TimeBase kTime{.rate_hz = 100.0, .t0_s = 1.0, .frames = 500};
constexpr auto kLast = FindingKind::outlier;

std::string text(const Finding& finding) { return describe(finding, kTime); }

TEST(Finding, CountsFramesAsTheFileDoes) {
  TimeBase time = kTime;
  time.first_number = 363;
  EXPECT_EQ(describe({.kind = FindingKind::zero, .subject = "A", .first_frame = 5, .last_frame = 5}, time),
            "marker 'A' is exactly at the origin in frame 368 (1.05 s)");
  EXPECT_THAT(describe({.kind = FindingKind::zero, .subject = "A", .first_frame = 5, .last_frame = 9}, time),
              HasSubstr("in frames 368 to 372 (1.05 to 1.09 s)"));
}

TEST(Finding, SaysWhoWhatHowLargeAndWhen) {
  EXPECT_EQ(
      text({.kind = FindingKind::spike, .subject = "A", .first_frame = 20, .last_frame = 22, .size = 0.012}),
      "marker 'A' leaves its path by 12.0 mm in frames 20 to 22 (1.2 to 1.22 s)");
  EXPECT_EQ(text({.kind = FindingKind::zero, .subject = "A", .first_frame = 5, .last_frame = 5}),
            "marker 'A' is exactly at the origin in frame 5 (1.05 s)");
  EXPECT_EQ(text({.kind = FindingKind::swap_within, .subject = "A", .partner = "B", .size = 0.25}),
            "marker 'A' jumps 250.0 mm to the path of 'B' and back to its own");
  EXPECT_EQ(
      text({.kind = FindingKind::label_swap,
            .subject = "A",
            .partner = "B",
            .first_frame = 0,
            .last_frame = 1,
            .size = 0.04}),
      "markers 'A' and 'B' carry each other's label in frames 0 to 1 (1 to 1.01 s) while 40.0 mm apart");
  EXPECT_EQ(text({.kind = FindingKind::label_swap, .subject = "A", .partner = "B"}),
            "markers 'A' and 'B' carry each other's label");
  EXPECT_EQ(text({.kind = FindingKind::marker_slip,
                  .subject = "A",
                  .partner = "thigh",
                  .first_frame = 131,
                  .last_frame = 499,
                  .size = 0.005,
                  .size_sd = 0.0004}),
            "marker 'A' moved 5.0 mm (SD 0.4) on 'thigh' at about 2.31 s");
  EXPECT_EQ(text({.kind = FindingKind::joint_slip, .subject = "knee", .size = 0.005}),
            "joint 'knee' lies 5.0 mm elsewhere in its segment in the second half than in the first: did its "
            "markers slip together?");
  EXPECT_EQ(
      text({.kind = FindingKind::loose_marker, .subject = "A", .size = 0.0032, .detail = "noise 1.0 mm"}),
      "marker 'A' moves on its segment by 3.2 mm: noise 1.0 mm");
  EXPECT_EQ(text({.kind = FindingKind::at_limit, .subject = "elbow", .size = 0.123}),
            "coordinate 'elbow' rests at a limit of its range in 12 % of the frames");
  EXPECT_EQ(text({.kind = FindingKind::not_settled, .subject = "the smoother", .size = 40}),
            "the smoother did not settle in 40 iterations over the recording");
  EXPECT_EQ(text({.kind = FindingKind::flagged, .size = 7}), "7 of 500 frames are flagged");
  EXPECT_EQ(text({.kind = FindingKind::clock_jump, .size = 3}), "the clock jumps by 3 frames");
}

TEST(Finding, AKindSaysNothingOfTheOthers) {
  const auto spike =
      text({.kind = FindingKind::spike, .subject = "A", .first_frame = 20, .last_frame = 20, .size = 0.012});
  EXPECT_EQ(spike, "marker 'A' leaves its path by 12.0 mm in frame 20 (1.2 s)");
  EXPECT_THAT(spike,
              Not(AnyOf(HasSubstr("from where the model and the frames beside have it"),
                        HasSubstr("was left out in"), HasSubstr("in frames"),
                        HasSubstr("exactly at the origin"), HasSubstr("one value digit by digit"),
                        HasSubstr("the frame before digit by digit"), HasSubstr("and back to its own"),
                        HasSubstr("in the second half than in the first: did its markers slip together?"),
                        HasSubstr("are not explained by rigid segments and noise"),
                        HasSubstr("' rests at a limit of its range in"),
                        HasSubstr("iterations over the recording"), HasSubstr("carry each other's label"))));
  EXPECT_EQ(text({.kind = FindingKind::unexplained, .size = 12}),
            "12 of 500 frames are not explained by rigid segments and noise");
  EXPECT_EQ(text({.kind = FindingKind::unexplained}),
            "some frames are not explained by rigid segments and noise");
}

TEST(Finding, AnExchangeInListedFramesSaysTheirPattern) {
  Finding swap{.kind = FindingKind::label_swap, .subject = "A", .partner = "B", .size = 0.04};
  for (std::int64_t f = 1; f < 128; f += 3) swap.frames.push_back(f);
  swap.first_frame = 1;
  swap.last_frame = 127;
  EXPECT_TRUE(swap.validate());
  EXPECT_EQ(swap.frame_count(), 43);
  const auto words = text(swap);
  EXPECT_EQ(
      words,
      "markers 'A' and 'B' are exchanged in 43 frames: every third frame from 1 to 127 (1.01 to 2.27 s) "
      "while 40.0 mm apart");
  EXPECT_THAT(words, Not(HasSubstr("carry each other's label"))) << "not in all frames from 1 to 127";
  swap.frames.clear();
  EXPECT_EQ(swap.frame_count(), 127);
  EXPECT_EQ((Finding{.kind = FindingKind::label_swap, .subject = "A", .partner = "B"}.frame_count()), 0);
}

TEST(Finding, WithoutASubjectItIsAboutAllMarkers) {
  EXPECT_EQ(text({.kind = FindingKind::duplicated_frame, .first_frame = 7, .last_frame = 7}),
            "all markers repeat the frame before digit by digit in frame 7 (1.07 s)");
  EXPECT_EQ(text({.kind = FindingKind::stuck}), "all markers hold one value digit by digit");
}

TEST(Finding, AUnitSlipIsTooLargeOrTooSmall) {
  EXPECT_THAT(text({.kind = FindingKind::unit_slip, .subject = "A", .size = 1000.0}),
              EndsWith("is 1000 times too large"));
  EXPECT_THAT(text({.kind = FindingKind::unit_slip, .size = 0.001}), EndsWith("are 1000 times too small"));
  EXPECT_THAT(text({.kind = FindingKind::unit_slip}), EndsWith("are in another unit"));
}

TEST(Finding, DoubtIsSaidAndUnknownConfidenceIsNone) {
  Finding finding{.kind = FindingKind::zero, .subject = "A"};
  EXPECT_TRUE(finding.sure());
  finding.confidence = 0.8;
  EXPECT_TRUE(finding.sure());
  finding.confidence = 0.62;
  EXPECT_FALSE(finding.sure());
  EXPECT_THAT(text(finding), EndsWith("(not certain: confidence 62 %)"));
}

TEST(Finding, TheFindersOwnWordsGoBeforeThoseOfTheKind) {
  Finding finding{.kind = FindingKind::spike, .subject = "A", .confidence = 0.5, .description = "A jumps"};
  EXPECT_EQ(text(finding), "A jumps (not certain: confidence 50 %)");
  finding.detail = "twice";
  EXPECT_EQ(text(finding), "A jumps: twice (not certain: confidence 50 %)");
}

TEST(Finding, ASentenceHasACapitalAndOneStopAndNoDoubt) {
  const auto sentence = [](std::string own) {
    return sentence_of({.confidence = 0.1, .description = std::move(own)}, kTime);
  };
  EXPECT_EQ(sentence("marker 'a' jumps"), "Marker 'a' jumps.");
  EXPECT_EQ(sentence("Marker 'a' jumps."), "Marker 'a' jumps.");
  EXPECT_EQ(sentence("does it slip?"), "Does it slip?");
  EXPECT_EQ(sentence("12 of them"), "12 of them.");
  EXPECT_EQ(sentence("\u00e4 is no ASCII letter"), "\u00e4 is no ASCII letter.");
  EXPECT_EQ(sentence_of({.kind = FindingKind::zero, .subject = "A"}, kTime),
            "Marker 'A' is exactly at the origin.");
}

TEST(Finding, EveryKindHasANameAndWordsOfItsOwn) {
  std::set<std::string> names, sentences;
  for (int k = 0; k <= static_cast<int>(kLast); ++k) {
    const auto kind = static_cast<FindingKind>(k);
    names.insert(std::string(to_string(kind)));
    sentences.insert(text({.kind = kind, .subject = "A", .partner = "B", .size = 2.0}));
  }
  EXPECT_EQ(names.size(), 16U);
  EXPECT_EQ(sentences.size(), 16U);
  EXPECT_EQ(to_string(FindingKind::label_swap), "label swap");
  EXPECT_EQ(to_string(kLast), "outlier");
}

TEST(Finding, ValidateRefusesWhatCannotBe) {
  const auto message = [](const Finding& finding) {
    const auto status = finding.validate();
    return status ? std::string() : status.error().message;
  };
  EXPECT_EQ(message({.kind = FindingKind::spike, .subject = "A", .first_frame = 3, .last_frame = 3}), "");
  EXPECT_THAT(message({.first_frame = 3, .last_frame = 2}), HasSubstr("from frame 3 to 2"));
  EXPECT_THAT(message({.first_frame = 3}), HasSubstr("need both in order, or none"));
  EXPECT_THAT(message({.kind = FindingKind::label_swap, .subject = "A"}),
              HasSubstr("names '' as the other marker; need two markers"));
  EXPECT_THAT(message({.kind = FindingKind::label_swap, .subject = "A", .partner = "A"}),
              HasSubstr("two markers"));
  EXPECT_THAT(message({.size_sd = -1.0}), HasSubstr("negative standard deviation"));
  EXPECT_THAT(message({.confidence = 1.1}), HasSubstr("has a confidence of 1.1; need 0 to 1"));
  Finding listed{.kind = FindingKind::spike, .subject = "A", .first_frame = 3, .last_frame = 9};
  for (const std::vector<std::int64_t>& frames :
       {std::vector<std::int64_t>{3, 5, 5, 9}, {3, 7, 5, 9}, {4, 9}, {3, 8}}) {
    listed.frames = frames;
    EXPECT_THAT(message(listed), HasSubstr("lists frames that are not in order from its first to its last"));
  }
  listed.frames = {3, 4, 9};
  EXPECT_EQ(message(listed), "");
}

TEST(Finding, EachFaultIsNamedAndNoOther) {
  const auto negative = Finding{.size_sd = -1.0}.validate().error().message;
  EXPECT_THAT(
      negative,
      Not(AnyOf(HasSubstr("; need both in order, or none"),
                HasSubstr("' as the other marker; need two markers"), HasSubstr("has a confidence of"),
                HasSubstr("lists frames that are not in order from its first to its last"))));
  EXPECT_THAT(Finding{.confidence = 1.1}.validate().error().message,
              Not(HasSubstr("has a negative standard deviation")));
}

TEST(Finding, OutliersOfOneMarkerAreOneSentence) {
  const TimeBase time{.rate_hz = 100.0, .t0_s = 0.0, .frames = 500};
  std::vector<Finding> findings;
  for (const std::int64_t f : {3, 9, 20, 31, 40, 55, 70, 80})
    findings.push_back({.kind = FindingKind::outlier,
                        .subject = "A",
                        .first_frame = f,
                        .last_frame = f + 1,
                        .size = 0.001 * static_cast<double>(f)});
  findings.push_back({.kind = FindingKind::at_limit, .subject = "elbow", .size = 0.5});
  findings.push_back(
      {.kind = FindingKind::outlier, .subject = "B", .first_frame = 7, .last_frame = 7, .size = 0.04});
  const auto sentences = describe_all(findings, time);
  ASSERT_EQ(sentences.size(), 3U);
  EXPECT_EQ(
      sentences[0],
      "marker 'A' was left out in 16 frames (3 to 4, 9 to 10, 20 to 21, 31 to 32, 40 to 41, 55 to 56 and 2 "
      "more spans): up to 80.0 mm from where the model and the frames beside have it");
  EXPECT_EQ(sentences[2],
            "marker 'B' was left out in frame 7 (0.07 s): 40.0 mm from where the model and the frames beside "
            "have it");
}

}  // namespace
}  // namespace kinemark::data
