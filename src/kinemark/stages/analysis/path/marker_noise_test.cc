// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/marker_noise.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "kinemark/stages/analysis/path/testing/known_noise.h"

namespace kinemark::analysis {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using State = data::SampleState;

/// A recording of 100 Hz, one marker for each series.
data::Trajectories recording_of(const std::vector<SeriesMatrix>& series) {
  std::vector<std::string> names;
  for (std::size_t m = 0; m < series.size(); ++m) names.push_back(std::string(1, static_cast<char>('A' + m)));
  auto out = data::Trajectories::all_missing(names, {.rate_hz = 100.0, .frames = testing::kSamples});
  for (std::int64_t m = 0; m < out.markers(); ++m)
    for (std::int64_t f = 0; f < out.frames(); ++f) {
      out.x(f, m) = series[static_cast<std::size_t>(m)].row(f).transpose();
      out.state[out.index(f, m)] = State::measured;
    }
  return out;
}

data::Trajectories four_with(const math::NoiseModel& model, std::uint64_t seed) {
  std::vector<SeriesMatrix> series;
  for (std::uint64_t m = 0; m < 4; ++m) series.push_back(testing::drifting_cycles_with(model, seed + m));
  return recording_of(series);
}

MarkerNoise found_of(const data::Trajectories& markers, int threads = 1) {
  std::set<std::int64_t> all;
  for (std::int64_t m = 0; m < markers.markers(); ++m) all.insert(m);
  return MarkerNoise::find(markers, all, 1, threads);
}

TEST(MarkerNoise, OfWhiteNoiseIsItsSizeAndNothingIsSaid) {
  const auto noise = found_of(four_with(testing::white(4e-4), 11));
  ASSERT_EQ(noise.all().size(), 4U);
  for (std::int64_t m = 0; m < 4; ++m) {
    EXPECT_NEAR(noise.sample_sd_m(m) / 4e-4, 1.0, 0.06);
    EXPECT_EQ(noise.of(m)->subject, std::string(1, static_cast<char>('A' + m)));
    EXPECT_EQ(noise.of(m)->sample_sd_m, noise.sample_sd_m(m));
    EXPECT_FALSE(leaves_size_open(*noise.of(m)));
  }
  EXPECT_THAT(noise.sentences(), Not(Contains(HasSubstr("The recording was low-passed at about"))));
  EXPECT_THAT(noise.sentences(), Not(Contains(HasSubstr("the samples leave open how large their noise is"))));
  EXPECT_THAT(noise.sentences(), IsEmpty());
}

TEST(MarkerNoise, OfAFilteredRecordingIsWhatTheFilterLeft) {
  const auto model = testing::quintic(5e-4, 8.0);
  const auto markers = four_with(model, 21);
  const auto noise = found_of(markers);
  ASSERT_EQ(noise.all().size(), 4U);
  for (std::int64_t m = 0; m < 4; ++m) EXPECT_NEAR(std::log(noise.sample_sd_m(m) / model.sd()), 0.0, 0.7);
  EXPECT_THAT(noise.sentences(), Contains(AllOf(HasSubstr("The recording was low-passed at about"),
                                                HasSubstr("deviations hold the noise that it left"))));
}

TEST(MarkerNoise, ThatMayBeSlowerThanMovementIsSaidToBeOpen) {
  const auto noise = found_of(four_with(testing::slow(1e-3, 0.99), 31));
  EXPECT_THAT(noise.sentences(),
              ElementsAre(AllOf(
                  HasSubstr("4 markers (A, B, C, ...): the samples leave open how large their noise is"),
                  HasSubstr("State it: --noise"))));
}

TEST(MarkerNoise, OfAMarkerOfFewSamplesComesFromTheOthers) {
  auto markers = four_with(testing::white(4e-4), 41);
  for (std::int64_t f = 12; f < markers.frames(); ++f) markers.set_missing(f, 3);
  // Ten times quieter by the few samples that there are.
  for (std::int64_t f = 0; f < 12; ++f)
    markers.x(f, 3) = Eigen::Vector3d(0.001 * static_cast<double>(f), 0.0, 4e-5 * (f % 2 == 0 ? 1.0 : -1.0));
  const auto noise = found_of(markers);
  ASSERT_NE(noise.of(3), nullptr);
  EXPECT_EQ(noise.of(3)->source, NoiseSource::too_short);
  EXPECT_TRUE(leaves_size_open(*noise.of(3)));
  EXPECT_GT(noise.sample_sd_m(3), 1.5 * noise.of(3)->model.sd()) << "others are noisier";
  EXPECT_LT(noise.sample_sd_m(3), 4e-4);
  EXPECT_NEAR(noise.sample_sd_m(0) / 4e-4, 1.0, 0.06) << "a sure size stays";
}

TEST(MarkerNoise, IsZeroWhereSamplesShowNoneAndUnknownWhereThereAreNone) {
  auto markers =
      recording_of({SeriesMatrix::Zero(testing::kSamples, 3), SeriesMatrix::Zero(testing::kSamples, 3)});
  for (std::int64_t f = 0; f < markers.frames(); ++f) markers.set_missing(f, 1);
  const auto noise = MarkerNoise::find(markers, {0, 1}, 1, 1);
  EXPECT_THAT(noise.all(), IsEmpty());
  EXPECT_EQ(noise.sample_sd_m(0), 0.0);
  EXPECT_TRUE(std::isnan(noise.sample_sd_m(1)));
  EXPECT_TRUE(std::isnan(noise.sample_sd_m(7))) << "not asked for";
  EXPECT_EQ(noise.of(0), nullptr);
  EXPECT_THAT(noise.sentences(), IsEmpty());
}

TEST(MarkerNoise, IsTheSameWithAnyNumberOfThreads) {
  const auto markers = four_with(testing::quintic(5e-4, 8.0), 51);
  const auto one = found_of(markers, 1), two = found_of(markers, 2);
  for (std::int64_t m = 0; m < 4; ++m) EXPECT_EQ(one.sample_sd_m(m), two.sample_sd_m(m));
}

TEST(MarkerNoise, SingleFramesFarFromTheirNeighboursAreNotInIt) {
  auto markers = four_with(testing::white(4e-4), 61);
  for (const std::int64_t f : {100, 200, 300}) markers.x(f, 0) += Eigen::Vector3d(0.03, 0.0, 0.0);
  const auto noise = found_of(markers);
  EXPECT_EQ(noise.of(0)->outliers, 3);
  EXPECT_NEAR(noise.sample_sd_m(0) / 4e-4, 1.0, 0.06);
}

}  // namespace
}  // namespace kinemark::analysis
