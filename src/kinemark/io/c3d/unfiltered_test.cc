// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/unfiltered.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/data/filtering.h"
#include "kinemark/io/c3d/reader.h"
#include "kinemark/io/c3d/writer.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using data::SampleState;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Forty frames of three markers of which two were smoothed, with numbers that single precision keeps in mm,
/// and an output of a model. The first marker's frame 5 was filled, frame 6 is missing.
data::Trial smoothed_trial() {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"LASI", "RASI", "BOX"}, {.rate_hz = 100.0, .frames = 40});
  auto& t = trial.markers;
  t.unfiltered_in_world.assign(t.x_in_world.size(), kNaN);
  Random random(3, 0);
  for (std::int64_t f = 0; f < 40; ++f)
    for (std::int64_t m = 0; m < 3; ++m)
      for (int axis = 0; axis < 3; ++axis) {
        const auto mm = std::round(random.uniform(-900.0, 900.0));
        t.x(f, m)[axis] = 1e-3 * mm;
        t.state[t.index(f, m)] = SampleState::measured;
        if (m < 2)
          t.unfiltered_in_world[3 * t.index(f, m) + static_cast<std::size_t>(axis)] = 1e-3 * (mm + 2.0);
      }
  t.state[t.index(5, 0)] = SampleState::interpolated;
  t.set_method(5, 0, "cubic");
  t.set_missing(6, 0);
  for (const std::int64_t f : {5, 6})
    for (std::size_t k = 0; k < 3; ++k) t.unfiltered_in_world[3 * t.index(f, 0) + k] = kNaN;
  for (std::size_t k = 0; k < 3; ++k) t.unfiltered_in_world[3 * t.index(7, 0) + k] = 0.0;  // the origin
  t.filters = {{"kalman", 5, 6.4321, 2.1e-4}, {"butterworth, gcv", 3, 12.0, kNaN}, {"none", 0, kNaN, kNaN}};
  for (const std::int64_t m : {0, 1})
    data::mark_smoothed(t, m, t.filters[static_cast<std::size_t>(m)].method);
  trial.channels = {.names = {"LKneeAngles"},
                    .kinds = {data::ChannelKind::angle},
                    .units = {"deg"},
                    .rate_hz = 100.0,
                    .frames = 40};
  for (int i = 0; i < 120; ++i) trial.channels.values.push_back(0.5 * i);
  return trial;
}

TEST(C3dUnfiltered, FiltersAndSamplesFromBeforeComeBack) {
  const testing_support::ScratchFolder scratch;
  const auto trial = smoothed_trial();
  ASSERT_TRUE(write_c3d(scratch / "a.c3d", trial));
  const auto back = read_c3d(scratch / "a.c3d");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_THAT(back->warnings, IsEmpty());
  const auto& t = back->markers;
  ASSERT_EQ(t.names, trial.markers.names);
  EXPECT_EQ(t.state, trial.markers.state);
  ASSERT_EQ(t.filters.size(), 3U);
  for (std::size_t m = 0; m < 3; ++m) {
    EXPECT_EQ(t.filters[m].method, trial.markers.filters[m].method);
    EXPECT_EQ(t.filters[m].order, trial.markers.filters[m].order);
    EXPECT_TRUE(std::isnan(t.filters[m].noise_sd_m)
                    ? std::isnan(trial.markers.filters[m].noise_sd_m)
                    : t.filters[m].noise_sd_m == trial.markers.filters[m].noise_sd_m);
  }
  EXPECT_EQ(t.filters[0].cutoff_hz, 6.4321) << "to the last digit";
  ASSERT_EQ(t.unfiltered_in_world.size(), trial.markers.unfiltered_in_world.size());
  for (std::size_t i = 0; i < t.unfiltered_in_world.size(); ++i) {
    const double was = trial.markers.unfiltered_in_world[i];
    if (std::isnan(was))
      EXPECT_TRUE(std::isnan(t.unfiltered_in_world[i])) << i;
    else
      EXPECT_DOUBLE_EQ(t.unfiltered_in_world[i], was) << i;
  }
  EXPECT_EQ(t.made_by(0, 0), "smoothed by kalman");
  EXPECT_EQ(t.made_by(5, 0), "cubic");
  EXPECT_EQ(t.made_by(0, 2), "");
  EXPECT_THAT(back->channels.names, ElementsAre("LKneeAngles"));
  EXPECT_EQ(back->channels.values, trial.channels.values);
}

TEST(C3dUnfiltered, OfIntegersTooToTheStep) {
  const testing_support::ScratchFolder scratch;
  const auto trial = smoothed_trial();
  ASSERT_TRUE(write_c3d(scratch / "a.c3d", trial, {.integers = true}));
  const auto t = read_c3d(scratch / "a.c3d").value().markers;
  ASSERT_FALSE(t.unfiltered_in_world.empty());
  for (std::size_t i = 0; i < t.unfiltered_in_world.size(); ++i)
    if (const double was = trial.markers.unfiltered_in_world[i]; std::isfinite(was)) {
      EXPECT_NEAR(t.unfiltered_in_world[i], was, 0.6 * 0.902 / 32000.0);
    }
}

TEST(C3dUnfiltered, OtherProgramsSeePointsThatSayWhatTheyAre) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_c3d(scratch / "a.c3d", smoothed_trial()));
  const auto reader = C3dReader::open(scratch / "a.c3d");
  ASSERT_TRUE(reader);
  const auto& parameters = reader->parameters();
  EXPECT_EQ(parameters.number("POINT", "USED"), 6.0);
  EXPECT_THAT(parameters.texts("POINT", "LABELS"),
              ElementsAre("LASI", "RASI", "BOX", "LKneeAngles", "unfiltered_LASI", "unfiltered_RASI"));
  EXPECT_THAT(parameters.texts("POINT", "UNFILTERED"), ElementsAre("unfiltered_LASI", "unfiltered_RASI"));
  EXPECT_EQ(parameters.texts("POINT", "DESCRIPTIONS")[5], "RASI before its filter");
  EXPECT_EQ(parameters.texts("KINEMARK", "FILTERS")[0], "kalman 5 6.4321 0.00021");
}

TEST(C3dUnfiltered, ARecordingThatWasNotFilteredHasNoneOfIt) {
  const testing_support::ScratchFolder scratch;
  auto trial = smoothed_trial();
  trial.markers.filters.clear();
  trial.markers.unfiltered_in_world.clear();
  trial.markers.method.clear();
  trial.markers.methods.clear();
  trial.markers.state[trial.markers.index(5, 0)] = SampleState::measured;
  ASSERT_TRUE(write_c3d(scratch / "a.c3d", trial));
  const auto reader = C3dReader::open(scratch / "a.c3d");
  EXPECT_FALSE(reader->parameters().has_group("KINEMARK"));
  EXPECT_EQ(reader->parameters().number("POINT", "USED"), 4.0);
  const auto back = read_c3d(scratch / "a.c3d").value().markers;
  EXPECT_TRUE(back.filters.empty());
  EXPECT_TRUE(back.unfiltered_in_world.empty());
}

TEST(C3dUnfiltered, ANameThatIsTakenGetsALongerPrefix) {
  const testing_support::ScratchFolder scratch;
  auto trial = smoothed_trial();
  trial.markers.names[2] = "unfiltered_LASI";
  EXPECT_EQ(unfiltered_prefix(trial), "unfiltered__");
  ASSERT_TRUE(write_c3d(scratch / "a.c3d", trial));
  const auto back = read_c3d(scratch / "a.c3d");
  ASSERT_TRUE(back);
  EXPECT_EQ(back->markers.names, trial.markers.names);
  EXPECT_TRUE(data::keeps_unfiltered(back->markers, 0));
  EXPECT_FALSE(data::keeps_unfiltered(back->markers, 2));
}

TEST(C3dUnfiltered, ACopyOfACopyIsTheSame) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_c3d(scratch / "a.c3d", smoothed_trial()));
  const auto once = read_c3d(scratch / "a.c3d").value();
  ASSERT_TRUE(write_c3d(scratch / "b.c3d", once));
  const auto twice = read_c3d(scratch / "b.c3d").value();
  EXPECT_THAT(twice.warnings, IsEmpty());
  EXPECT_EQ(twice.markers.filters.size(), 3U);
  EXPECT_TRUE(data::keeps_unfiltered(twice.markers, 1));
  EXPECT_EQ(unfiltered_markers(twice.markers), unfiltered_markers(once.markers));
  EXPECT_EQ(twice.channels.names, once.channels.names);
}

TEST(C3dUnfiltered, FiltersOfOtherMarkersAreLeftWithAWarning) {
  C3dParameters parameters;
  auto trial = smoothed_trial();
  add_filters(trial, false, parameters);
  trial.markers.filters.clear();
  trial.markers.names.pop_back();
  take_filters(parameters, {}, trial);
  EXPECT_TRUE(trial.markers.filters.empty());
  EXPECT_THAT(trial.warnings, ElementsAre(HasSubstr("KINEMARK:FILTERS does not fit the markers")));
}

TEST(C3dUnfiltered, APointOfAMarkerThatIsGoneStaysAChannel) {
  C3dParameters parameters;
  auto trial = smoothed_trial();
  add_filters(trial, true, parameters);
  parameters.group("POINT").parameters.push_back(
      {.name = "UNFILTERED", .type = C3dType::text, .dims = {17, 1}, .texts = {"unfiltered_LASIX"}});
  trial.markers.unfiltered_in_world.clear();
  trial.channels.names[0] = "unfiltered_LASIX";
  take_filters(parameters, {}, trial);
  EXPECT_THAT(trial.channels.names, ElementsAre("unfiltered_LASIX"));
  EXPECT_THAT(trial.warnings,
              ElementsAre(HasSubstr("1 point of samples before the filter belongs to no marker")));
}

}  // namespace
}  // namespace kinemark::io
