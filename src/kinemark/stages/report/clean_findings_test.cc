// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "kinemark/stages/report/clean_report.h"
#include "kinemark/stages/report/internal/example_clean.h"

namespace kinemark::report {
namespace {

using internal::example_clean;
using testing::AnyOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

/// Ten seconds at 100 Hz with nothing to complain about.
CleanReport faultless() {
  CleanReport r;
  r.time = {.rate_hz = 100.0, .t0_s = 0.0, .frames = 1000};
  for (const char* name : {"A", "B", "C"}) {
    data::MarkerAccount m{.name = name};
    m.used = {"kalman", 4, 9.0, 0.0004};
    m.criterion_name = "SURE, m^2";
    r.account.names.emplace_back(name);
    r.account.markers.push_back(m);
    CleanCounts counts;
    counts.before[static_cast<std::size_t>(data::SampleState::measured)] = 1000;
    r.counts.push_back(counts);
  }
  return r;
}

constexpr std::int64_t kA = 0, kB = 1, kC = 2;

data::GapAccount gap(std::int64_t marker, std::int64_t first, std::int64_t last) {
  return {.marker = marker, .first_frame = first, .last_frame = last};
}

data::Defect rejected_spike(std::string marker, std::int64_t frame, double confidence,
                            std::string description) {
  return {.finding = {.kind = data::FindingKind::spike,
                      .subject = std::move(marker),
                      .first_frame = frame,
                      .last_frame = frame,
                      .confidence = confidence,
                      .description = std::move(description)},
          .done = "rejected",
          .handled = true};
}

TEST(CleanFindings, NothingToSayOfAFaultlessRecording) {
  EXPECT_THAT(clean_findings(faultless()), IsEmpty());
}

TEST(CleanFindings, TheExampleHasAllOfThemWithTheSeriousOnesFirst) {
  const auto findings = clean_findings(example_clean(1200).finished());
  ASSERT_THAT(findings, SizeIs(7));
  EXPECT_TRUE(std::ranges::is_sorted(findings, std::ranges::greater{}, &Notice::level));
  EXPECT_EQ(std::ranges::count(findings, Verdict::attention, &Notice::level), 2);
  EXPECT_THAT(findings[0].text, HasSubstr("sit in each other's place"));
  EXPECT_DOUBLE_EQ(findings[0].time_s, 8.0);
  EXPECT_THAT(findings[1].text, HasSubstr("14.2 mm, in a gap of 1.1 s"));
  EXPECT_EQ(findings[1].subject, "R.Wrist.Ulna");
}

TEST(CleanFindings, AFailedGateIsSaidInItsOwnWords) {
  CleanReport r = faultless();
  r.run.gates = {{"a", true, 0, 0, "", "Passed."}, {"b", false, 0, 0, "", "Failed."}};
  r.run.exit_status = 1;
  ASSERT_THAT(clean_findings(r), SizeIs(1));
  EXPECT_EQ(clean_findings(r)[0].text, "Failed.");
  EXPECT_THAT(clean_findings(r)[0].text, Not(HasSubstr("The run ended with exit status")));
  r.run.gates.clear();
  EXPECT_THAT(clean_findings(r)[0].text, HasSubstr("The run ended with exit status 1."));
}

TEST(CleanFindings, ADefectIsSeriousWhenItIsCertainAndWasLeft) {
  CleanReport r = faultless();
  r.account.defects = {rejected_spike("A", 10, 0.95, "a spike")};
  EXPECT_EQ(clean_findings(r)[0].level, Verdict::good);
  r.account.defects[0].handled = false;
  EXPECT_EQ(clean_findings(r)[0].level, Verdict::attention);
  EXPECT_THAT(clean_findings(r)[0].text, Not(HasSubstr("Not certain: somebody should look")));
  EXPECT_THAT(clean_findings(r)[0].text, Not(HasSubstr("Defects of the kind \""))) << "one in its own words";
  r.account.defects[0].finding.confidence = 0.6;
  EXPECT_EQ(clean_findings(r)[0].level, Verdict::good);
  EXPECT_THAT(clean_findings(r)[0].text, HasSubstr("Not certain: somebody should look."));
  EXPECT_DOUBLE_EQ(clean_findings(r)[0].time_s, 0.1);
  r.account.defects[0].finding.confidence = kNaN;
  EXPECT_EQ(clean_findings(r)[0].level, Verdict::attention);
}

TEST(CleanFindings, ThousandsOfSpikesAreOneLine) {
  CleanReport r = faultless();
  for (int i = 0; i < 3000; ++i)
    r.account.defects.push_back(rejected_spike(i % 2 == 0 ? "A" : "B", i, 0.9, "A leaves its path"));
  r.account.defects.push_back(
      {.finding = {.kind = data::FindingKind::zero, .first_frame = 5, .last_frame = 5, .confidence = 0.9},
       .done = "rejected",
       .handled = true});
  const auto findings = clean_findings(r);
  ASSERT_THAT(findings, SizeIs(2));
  EXPECT_THAT(
      findings[0].text,
      HasSubstr("Defects of the kind \"spike\" in 3000 places (A and B). The first: A leaves its path."));
  EXPECT_THAT(findings[0].text, HasSubstr("What was done: rejected."));
  EXPECT_THAT(findings[1].text, HasSubstr("All markers are exactly at the origin in frame 5 (0.05 s). What"));
}

TEST(CleanFindings, MadeSamplesAreSeriousUntilTheyAreTakenOut) {
  CleanReport r = faultless();
  data::UpsamplingAccount& recorder = r.account.upsampling;
  recorder.looked = true;
  recorder.recording.factor = 4;
  recorder.markers.resize(3);
  recorder.done = "nothing";
  ASSERT_THAT(clean_findings(r), SizeIs(1));
  EXPECT_EQ(clean_findings(r)[0].level, Verdict::attention);
  EXPECT_THAT(clean_findings(r)[0].text,
              HasSubstr("The recorder interpolated this recording: 1 of 4 samples was measured."));
  recorder.handled = true;
  EXPECT_EQ(clean_findings(r)[0].level, Verdict::good);
  recorder.recording.factor = 1;
  EXPECT_THAT(clean_findings(r), IsEmpty());
  recorder.markers[kB].factor = 2;
  ASSERT_THAT(clean_findings(r), SizeIs(1));
  EXPECT_THAT(clean_findings(r)[0].text, HasSubstr("1 marker (B)"));
  EXPECT_THAT(clean_findings(r)[0].text, Not(HasSubstr("The recorder interpolated this recording")));
}

TEST(CleanFindings, UncertainFillsAreReportedMarkerByMarkerWithTheWorst) {
  CleanReport r = faultless();
  for (const double sd_m : {0.011, 0.019, 0.004}) {
    data::GapAccount g = gap(kB, 100, 149);
    g.filled = true;
    g.max_sd_m = sd_m;
    if (sd_m == 0.019) g.first_frame = 120;
    r.account.gaps.push_back(g);
  }
  data::GapAccount unknown = gap(kC, 0, 9);
  unknown.filled = true;
  r.account.gaps.push_back(unknown);
  const auto findings = clean_findings(r);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_EQ(findings[0].level, Verdict::attention);
  EXPECT_EQ(
      findings[0].text,
      "2 gaps of B were filled with a standard deviation above 10 mm; the largest is 19.0 mm, in a gap of "
      "0.3 s.");
  EXPECT_THAT(findings[0].text, Not(HasSubstr("left open"))) << "they were filled";
  EXPECT_DOUBLE_EQ(findings[0].time_s, 1.2);
  for (auto& g : r.account.gaps) g.max_sd_m = std::min(g.max_sd_m, 0.009);
  for (const auto& finding : clean_findings(r))
    EXPECT_THAT(finding.text, Not(HasSubstr("filled with a standard deviation above")));
}

TEST(CleanFindings, OpenGapsAreSummedWithTheLongestAndItsReason) {
  CleanReport r = faultless();
  r.account.gaps = {gap(kA, 0, 9), gap(kC, 200, 499), gap(kA, 700, 709)};
  r.account.gaps[1].why_open = "3 s long; at most 2 s are filled";
  const auto findings = clean_findings(r);
  ASSERT_THAT(findings, SizeIs(1));
  EXPECT_EQ(findings[0].level, Verdict::good);
  EXPECT_EQ(findings[0].text,
            "3 gaps were left open (3.2 s in all, in A and C); the longest lasts 3 s in C: 3 s long; at most "
            "2 s are "
            "filled.");
  EXPECT_DOUBLE_EQ(findings[0].time_s, 2.0);
}

TEST(CleanFindings, FiltersThatTellLittleAreNamed) {
  CleanReport r = faultless();
  r.account.markers[0].white_p = 1e-4;
  r.account.markers[0].white_departure = 0.3;
  r.account.markers[1].used.cutoff_hz = 45.0;
  r.account.markers[2].used.cutoff_hz = 0.15;
  r.account.markers[2].bad_variances = 3;
  const auto findings = clean_findings(r);
  ASSERT_THAT(findings, SizeIs(4));
  EXPECT_THAT(findings[0].text, HasSubstr("A (1 of 3 markers): the residual is not white"));
  EXPECT_THAT(findings[1].text, HasSubstr("B (1 of 3 markers): the cut-off found is at the upper end"));
  EXPECT_THAT(findings[2].text, HasSubstr("C (1 of 3 markers): the cut-off found is at the lower end"));
  EXPECT_THAT(findings[3].text, HasSubstr("variances"));
}

TEST(CleanFindings, WhiteIsSaidOfNothingThatWasNotTested) {
  struct Case {
    double p, departure;
    const char* says;  // nothing: no finding
  };
  for (const Case& c :
       {Case{0.02, 0.3, ""}, Case{0.009, 0.05, ""}, Case{kNaN, kNaN, ""},
        Case{0.009, 0.11, "too low in frequency"}, Case{0.009, -0.11, "too high in frequency"}}) {
    CleanReport r = faultless();
    r.account.markers[0].white_p = c.p;
    r.account.markers[0].white_departure = c.departure;
    const auto findings = clean_findings(r);
    ASSERT_THAT(findings, SizeIs(*c.says == '\0' ? 0 : 1)) << c.p << ' ' << c.departure;
    for (const auto& found : findings) EXPECT_THAT(found.text, HasSubstr(c.says));
  }
}

TEST(CleanFindings, ACutOffThatWasGivenIsNotJudged) {
  CleanReport r = faultless();
  r.account.markers[1].used.cutoff_hz = 45.0;
  r.account.markers[1].criterion_name = "";
  EXPECT_THAT(clean_findings(r), IsEmpty());
}

TEST(CleanFindings, EachMarkerHasItsOwnTroubleAndNoOther) {
  const auto said = [](auto change) {
    CleanReport r = faultless();
    change(r.account.markers[1]);
    const auto findings = clean_findings(r);
    EXPECT_THAT(findings, SizeIs(1));
    return findings.empty() ? std::string() : findings[0].text;
  };
  const auto low = said([](data::MarkerAccount& m) { m.white_p = 1e-4, m.white_departure = 0.3; }),
             high = said([](data::MarkerAccount& m) { m.white_p = 1e-4, m.white_departure = -0.3; }),
             upper = said([](data::MarkerAccount& m) { m.used.cutoff_hz = 45.0; }),
             variances = said([](data::MarkerAccount& m) { m.bad_variances = 1; });
  EXPECT_THAT(low,
              HasSubstr("more than a tenth of the noise power lies too low in frequency. The filter took "
                        "away more than noise, or the noise is not white: the error bars are too small."));
  EXPECT_THAT(low, Not(AnyOf(HasSubstr("lies too high in frequency. The error bars are too large"),
                             HasSubstr("the cut-off found is at the upper end of its range"),
                             HasSubstr("some variances were not positive and finite"))));
  EXPECT_THAT(high,
              HasSubstr("more than a tenth of the noise power lies too high in frequency. The error bars "
                        "are too large."));
  EXPECT_THAT(high, Not(HasSubstr("The filter took away more than noise, or the noise is not white")));
  EXPECT_THAT(upper,
              HasSubstr("the cut-off found is at the upper end of its range. Next to no noise was there "
                        "to take away; data that were filtered before look like this."));
  EXPECT_THAT(upper, Not(HasSubstr("the cut-off found is at the lower end of its range")));
  EXPECT_THAT(variances,
              HasSubstr("some variances were not positive and finite; the marker's median was taken "
                        "instead."));
}

TEST(CleanFindings, AFilledGapIsNotCalledOpen) {
  CleanReport r = faultless();
  data::GapAccount filled = gap(kB, 100, 149), open = gap(kC, 0, 9);
  filled.filled = true;
  filled.max_sd_m = 0.020;
  r.account.gaps = {filled};
  ASSERT_THAT(clean_findings(r), SizeIs(1));
  EXPECT_THAT(clean_findings(r)[0].text, Not(HasSubstr("left open (0.5 s in all, in B); the longest lasts")));
  r.account.gaps = {open};
  ASSERT_THAT(clean_findings(r), SizeIs(1));
  EXPECT_EQ(clean_findings(r)[0].text,
            "1 gap was left open (0.1 s in all, in C); the longest lasts 0.1 s in C.");
}

TEST(CleanFindings, DefectsThatEndedOtherwiseAreNotOneLine) {
  CleanReport r = faultless();
  r.account.defects = {rejected_spike("A", 10, 0.95, "A leaves its path"),
                       rejected_spike("B", 20, 0.95, "B leaves its path"),
                       rejected_spike("C", 30, 0.95, "C leaves its path"),
                       rejected_spike("C", 40, 0.5, "C may leave its path")};
  r.account.defects[2].done = "";
  r.account.defects[2].handled = false;
  const auto findings = clean_findings(r);
  ASSERT_THAT(findings, SizeIs(3));
  EXPECT_EQ(findings[0].text, "C leaves its path.") << "serious: it is certain, and nothing was done";
  EXPECT_THAT(findings[1].text, HasSubstr("Defects of the kind \"spike\" in 2 places (A and B)."));
  EXPECT_EQ(findings[2].text,
            "C may leave its path. Not certain: somebody should look. What was done: rejected.");
}

TEST(CleanFindings, ManyNamesAreCut) {
  CleanReport r = faultless();
  r.account.markers.resize(20, r.account.markers[0]);
  r.counts.resize(20, r.counts[0]);
  for (std::size_t i = 0; i < r.account.markers.size(); ++i) {
    r.account.markers[i].name = "M" + std::to_string(i);
    r.account.markers[i].white_p = 1e-4;
    r.account.markers[i].white_departure = -0.3;
  }
  EXPECT_THAT(clean_findings(r)[0].text, HasSubstr("M0, M1, M2, M3, M4, M5 and 14 more (20 of 20 markers)"));
}

TEST(CleanFindings, AMarkerThatWasNeverSeenIsNamed) {
  CleanReport r = faultless();
  r.counts[kC].before = {1000, 0, 0, 0, 0, 0};
  ASSERT_THAT(clean_findings(r), SizeIs(1));
  EXPECT_EQ(clean_findings(r)[0].text, "C (1 of 3 markers): never seen.");
}

}  // namespace
}  // namespace kinemark::report
