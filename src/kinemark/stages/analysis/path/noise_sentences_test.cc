// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/noise_sentences.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/analysis/path/testing/known_noise.h"

namespace kinemark::analysis {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::string all_said(std::span<const PathNoise> markers) {
  std::string out;
  for (const auto& sentence : noise_sentences(markers)) out += sentence + "\n";
  return out;
}
std::string said_of(const PathNoise& noise) { return all_said({&noise, 1}); }

PathNoise named(const char* subject, PathNoise noise) {
  noise.subject = subject;
  return noise;
}

/// A marker whose spectrum falls, with what its fit left open of the cut-off.
PathNoise falling(const char* subject, double low_hz, double hz, double high_hz) {
  PathNoise out{.subject = subject, .source = NoiseSource::spectrum, .rate_hz = 100.0};
  out.model = testing::quintic(4e-4, hz);
  out.cutoff_hz = {.low = low_hz, .middle = hz, .high = high_hz};
  out.slow_sd_m = {.low = 1e-4, .middle = 1e-4, .high = 1e-4};
  out.above_hz = 0.5 * hz;
  return out;
}
PathNoise flat(const char* subject) {
  PathNoise out{.subject = subject, .source = NoiseSource::spectrum, .rate_hz = 100.0};
  out.model = testing::white(4e-4);
  out.slow_sd_m = {.low = 1e-4, .middle = 1e-4, .high = 1e-4};
  return out;
}

TEST(SharedFilter, IsWhereTheIntervalsOfMostMarkersMeet) {
  const std::vector<PathNoise> markers{falling("A", 5.0, 6.0, 7.0), falling("B", 5.8, 6.5, 7.2),
                                       falling("C", 5.5, 5.9, 6.4), falling("D", 9.0, 10.0, 11.0)};
  const auto shared = find_shared_filter(markers);
  ASSERT_TRUE(shared.agreed());
  EXPECT_EQ(shared.members, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(shared.of, 4u);
  // Logarithms weighed by the squares of their precision.
  const double a = 1.0 / std::pow(std::log(7.0 / 5.0), 2), b = 1.0 / std::pow(std::log(7.2 / 5.8), 2),
               c = 1.0 / std::pow(std::log(6.4 / 5.5), 2);
  const double mean = (a * std::log(6.0) + b * std::log(6.5) + c * std::log(5.9)) / (a + b + c);
  EXPECT_NEAR(shared.cutoff_hz, std::exp(mean), 1e-9);
  EXPECT_LT(shared.low_hz, shared.cutoff_hz);
  EXPECT_GT(shared.high_hz, shared.cutoff_hz);
  EXPECT_LT(shared.high_hz / shared.low_hz, 7.0 / 5.0) << "surer than any marker by itself";
}

TEST(SharedFilter, MarkersThatDisagreeShareNone) {
  const std::vector<PathNoise> apart{falling("A", 5.0, 5.5, 6.0), falling("B", 8.0, 8.5, 9.0),
                                     falling("C", 12.0, 13.0, 14.0), falling("D", 20.0, 21.0, 22.0)};
  EXPECT_FALSE(find_shared_filter(apart).agreed());
  EXPECT_TRUE(std::isnan(find_shared_filter(apart).cutoff_hz));
  EXPECT_FALSE(find_shared_filter({}).agreed());
}

TEST(SharedFilter, MarkersWithoutALowPassAreAgainstIt) {
  std::vector<PathNoise> markers{falling("A", 5.0, 6.0, 7.0), falling("B", 5.0, 6.0, 7.0),
                                 falling("C", 5.0, 6.0, 7.0), flat("D")};
  EXPECT_TRUE(find_shared_filter(markers).agreed());
  markers.push_back(flat("E"));
  EXPECT_FALSE(find_shared_filter(markers).agreed()) << "three of five";
  markers.back().source = NoiseSource::too_short;
  EXPECT_TRUE(find_shared_filter(markers).agreed()) << "a short one has no spectrum";
  markers.back() = falling("E", 5.0, 6.0, 7.0);
  markers.back().source = NoiseSource::no_model;
  EXPECT_EQ(find_shared_filter(markers).of, 5u);
  EXPECT_FALSE(find_shared_filter(markers).agreed()) << "what fits no model shows no filter";
}

TEST(SharedFilter, OpenCutOffsTellNothing) {
  const std::vector<PathNoise> wide{falling("A", 1.0, 6.0, 12.0), falling("B", 0.6, 6.0, 13.0),
                                    falling("C", 2.0, 6.0, 9.0)};
  EXPECT_EQ(find_shared_filter(wide).of, 0u);
  EXPECT_FALSE(find_shared_filter(wide).agreed());
}

TEST(SharedFilter, TwoMarkersAreTooFew) {
  const std::vector<PathNoise> two{falling("A", 5.0, 6.0, 7.0), falling("B", 5.0, 6.0, 7.0)};
  EXPECT_FALSE(find_shared_filter(two).agreed());
}

/// Six markers on ways of their own, all through a quintic spline, at one cut-off or each at its own.
std::vector<PathNoise> recorded_through(const std::vector<double>& half_hz) {
  std::vector<PathNoise> out;
  for (std::size_t m = 0; m < half_hz.size(); ++m) {
    const double size = 0.4 + 0.3 * static_cast<double>(m), turn = 0.7 + 0.1 * static_cast<double>(m);
    const auto x = testing::sampled(testing::kSamples, 100.0, [&](double t) -> Eigen::Vector3d {
      return size * testing::ellipse(turn * t);
    });
    out.push_back(testing::noise_of(testing::with_noise_of(
        x, testing::quintic(2e-4 + 1e-4 * static_cast<double>(m), half_hz[m]), 40 + m)));
    out.back().subject = std::string(1, static_cast<char>('A' + m));
  }
  return out;
}

TEST(NoiseSentences, ARecordingThatWentThroughOneFilterIsSaidToHaveBeenFiltered) {
  const auto markers = recorded_through({8.0, 8.0, 8.0, 8.0, 8.0, 8.0});
  const auto shared = find_shared_filter(markers);
  ASSERT_TRUE(shared.agreed());
  const double truth = 100.0 * math::three_db_of_half(math::LowPass::spline, 3, 0.08);
  EXPECT_NEAR(std::log(shared.cutoff_hz / truth), 0.0, 0.08);
  const auto text = all_said(markers);
  EXPECT_THAT(text, HasSubstr("the recording was low-passed at about "));
  EXPECT_THAT(text, HasSubstr("markers whose spectrum tells; noise before that "));
  EXPECT_THAT(text, Not(HasSubstr("the noise is not white, its spectrum falls as behind a low-pass")));
  EXPECT_EQ(text.find("low-passed at"), text.rfind("low-passed at")) << "once for all: " << text;
}

TEST(NoiseSentences, OneWhoseMarkersHaveCutOffsOfTheirOwnIsNot) {
  const auto markers = recorded_through({5.0, 7.0, 10.0, 14.0, 19.0, 26.0});
  EXPECT_FALSE(find_shared_filter(markers).agreed());
  const auto text = all_said(markers);
  EXPECT_THAT(text, Not(HasSubstr("the recording was low-passed at about ")));
  EXPECT_THAT(text, HasSubstr("the noise is not white, its spectrum falls as behind a low-pass at "));
  EXPECT_THAT(text,
              HasSubstr("too few of the recording's markers share a cut-off to say that a filter made it"));
}

TEST(NoiseSentences, OneMarkerAloneSaysNoMoreThanItsSpectrum) {
  const auto text = said_of(testing::noise_of(testing::cycles_with(testing::quintic(5e-4, 7.0), 2)));
  EXPECT_THAT(text, HasSubstr("KNE: the noise is not white, its spectrum falls as behind a low-pass at "));
  EXPECT_THAT(text, HasSubstr("too few of the recording's markers share a cut-off"));
  EXPECT_THAT(text, Not(HasSubstr("the recording was low-passed at about ")));
  EXPECT_THAT(text, Not(HasSubstr("correlated over")));
}

TEST(NoiseSentences, OfWhiteNoiseNothingIsSaid) {
  const auto noise = testing::noise_of(testing::cycles_with(testing::white(5e-4), 1));
  EXPECT_THAT(noise_sentences({&noise, 1}), IsEmpty());
  EXPECT_THAT(noise_sentences({}), IsEmpty());
}

TEST(NoiseSentences, AFilterThatTheRecordingNamesIsItsOwnWord) {
  auto stated = falling("A", 6.0, 6.1, 6.2);
  stated.source = NoiseSource::filter;
  EXPECT_THAT(said_of(stated),
              HasSubstr("A: low-passed at 6.1 Hz (-3 dB) as the recording itself says; noise "
                        "before that 0.4 mm; what the movement had above is lost"));
  EXPECT_THAT(said_of(falling("A", 6.0, 6.1, 6.2)), Not(HasSubstr("as the recording itself says")));
}

TEST(NoiseSentences, TheFormIsNamedWhereMostMembersHaveIt) {
  std::vector<PathNoise> markers{falling("A", 5.0, 6.0, 7.0), falling("B", 5.0, 6.0, 7.0),
                                 falling("C", 5.0, 6.0, 7.0)};
  EXPECT_THAT(all_said(markers), HasSubstr("(-3 dB; quintic spline; 95 %: "));
  EXPECT_THAT(all_said(markers), Not(HasSubstr("of which form is not known")));
  markers[1].model.order = 4;
  EXPECT_THAT(all_said(markers), HasSubstr("quintic spline"));
  markers[2].model.form = math::LowPass::butterworth;
  EXPECT_THAT(all_said(markers), HasSubstr("of which form is not known"));
}

TEST(NoiseSentences, ALowPassWithinTheMovementTakesPeaks) {
  const auto above = falling("A", 5.0, 6.0, 7.0);
  auto within = above;
  within.above_hz = 9.0;
  EXPECT_THAT(said_of(within),
              HasSubstr("A: the spectrum falls within the movement's band as behind a low-pass"));
  EXPECT_THAT(said_of(above), Not(HasSubstr("the spectrum falls within the movement's band")));
  within.source = NoiseSource::no_model;
  EXPECT_THAT(said_of(within), Not(HasSubstr("the spectrum falls within the movement's band")))
      << "no interval of anything is said already";
}

TEST(NoiseSentences, SlowNoiseIsCalledSoAndItsSizeUnknown) {
  const auto noise = testing::noise_of(testing::cycles_with(testing::slow(1e-3, 0.99), 3));
  const auto text = said_of(noise);
  EXPECT_THAT(text, HasSubstr("KNE: the noise is correlated over "));
  EXPECT_THAT(text, HasSubstr(" s or more (AR "));
  EXPECT_THAT(text, Not(HasSubstr("mm, correlated over "))) << "its size is not known";
  EXPECT_THAT(text, HasSubstr("KNE: the noise below 2 Hz cannot be distinguished from movement (between "));
  EXPECT_THAT(text, HasSubstr("no interval of extents, largest distance, farthest sample, boxes and plane"));
  EXPECT_THAT(text, Not(HasSubstr("falls as behind a low-pass")));
  const auto steady = said_of(flat("A"));
  EXPECT_THAT(steady, Not(HasSubstr("mm, correlated over ")));
  EXPECT_THAT(steady, Not(HasSubstr(": the noise is correlated over ")));
  EXPECT_THAT(steady, Not(HasSubstr("the noise below 2 Hz cannot be distinguished from movement")));
}

TEST(NoiseSentences, NumbersOfManyMarkersAreRanges) {
  auto one = flat("A"), two = flat("B");
  one.model = testing::slow(2e-4, 0.9), two.model = testing::slow(8e-4, 0.5);
  const std::vector<PathNoise> both{one, two};
  EXPECT_EQ(all_said(both),
            "2 markers (A, B): noise of 0.2 to 0.8 mm, correlated over 0.014 to 0.095 s (AR 0.5 to 0.9)\n");
  EXPECT_EQ(said_of(one), "A: noise of 0.2 mm, correlated over 0.095 s (AR 0.9)\n");
  EXPECT_THAT(said_of(one), Not(HasSubstr("the noise is correlated over")));
  two.model.correlation = 0.1;
  EXPECT_THAT(said_of(two), IsEmpty()) << "hardly a correlation";
}

TEST(NoiseSentences, WhatFitsNoModelHasNoInterval) {
  auto none = flat("A");
  none.source = NoiseSource::no_model;
  EXPECT_EQ(said_of(none),
            "A: the noise above the movement fits no model (spikes, changing noise, another filter): no "
            "interval\n");
  EXPECT_THAT(said_of(flat("A")), Not(HasSubstr("the noise above the movement fits no model")));
}

TEST(NoiseSentences, RoundingIsNoNoise) {
  auto rounded = flat("A");
  rounded.source = NoiseSource::rounding;
  rounded.rounding_step_m = 7.4e-5;
  EXPECT_EQ(
      said_of(rounded),
      "A: the noise is below the rounding of the file (0.074 mm): no interval from the noise; rounding gives "
      "+-0.037 mm a sample\n");
  rounded.source = NoiseSource::spectrum;
  EXPECT_THAT(said_of(rounded), Not(HasSubstr("the noise is below the rounding of the file")));
}

TEST(NoiseSentences, StatedNoiseThatTheSamplesContradictIsReported) {
  auto less = flat("A"), more = flat("B"), same = flat("C");
  less.stated_sd_m = more.stated_sd_m = same.stated_sd_m = 1e-3;
  less.found_sd_m = 2e-4, more.found_sd_m = 3e-3, same.found_sd_m = 1.2e-3;
  EXPECT_EQ(said_of(less), "the noise of A is 0.2 mm by its samples, not the 1 mm that were stated\n");
  const std::vector<PathNoise> all{less, more, same, named("D", more)};
  EXPECT_EQ(all_said(all),
            "the noise of A is 0.2 mm by its samples, not the 1 mm that were stated\n"
            "the noise of 2 markers (B, D) is 3 mm by their samples, not the 1 mm that were stated\n");
  EXPECT_THAT(said_of(same), Not(HasSubstr("mm that were stated")));
}

TEST(Listed, NamesOneOrTheFirstThree) {
  const std::vector<std::string> names{"A", "B", "C", "D"};
  EXPECT_EQ(listed({names.data(), 1}), "A");
  EXPECT_EQ(listed({names.data(), 3}), "3 markers (A, B, C)");
  EXPECT_EQ(listed(names), "4 markers (A, B, C, ...)");
}

}  // namespace
}  // namespace kinemark::analysis
