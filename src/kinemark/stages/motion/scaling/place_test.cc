// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/place.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/stages/motion/scaling/testing/small_leg.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing_leg::leg;

data::Trajectories standing(const data::ModelDescription& model) {
  testing_leg::Recording how;
  how.frames = 10;
  how.amplitude = 0.0;
  return testing_leg::record(model, how);
}

/// The subject wears THA and TIB elsewhere.
data::ModelDescription subject() {
  auto model = leg();
  model.markers[4].x_in_body += Vector3d(0.0, 0.02, 0.01);
  model.markers[7].x_in_body += Vector3d(-0.01, 0.0, 0.0);
  return model;
}

/// Markers that hold the pose; the others are carried along.
PlaceOptions options() {
  PlaceOptions o;
  o.ik.marker_weights = {{"THA", 0.0}, {"TIB", 0.0}};
  return o;
}

TEST(PlaceMarkers, puts_markers_where_they_were_worn) {
  const auto result = place_markers(leg(), standing(subject()), options());
  ASSERT_TRUE(result) << result.error().message;
  for (std::size_t m = 0; m < result->model.markers.size(); ++m)
    EXPECT_LT((result->model.markers[m].x_in_body - subject().markers[m].x_in_body).norm(), 1e-6)
        << result->model.markers[m].name;
  EXPECT_LT(result->rms_m, 1e-6);
  EXPECT_NEAR(result->markers[4].error_m, std::hypot(0.02, 0.01), 1e-6);
  EXPECT_EQ(result->markers[4].body, "femur_r");
  EXPECT_NEAR(result->pose[6 + 3], -0.6, 1e-6);  // the knee as it stood
  EXPECT_TRUE(result->unseen.empty());
}

TEST(PlaceMarkers, fixed_markers_stay) {
  auto o = options();
  o.fixed = {"THA"};
  const auto result = place_markers(leg(), standing(subject()), o).value();
  EXPECT_EQ(result.model.markers[4].x_in_body, leg().markers[4].x_in_body);
  EXPECT_TRUE(result.markers[4].fixed);
  EXPECT_GT((result.model.markers[7].x_in_body - leg().markers[7].x_in_body).norm(), 0.009);
}

TEST(PlaceMarkers, markers_that_the_trial_lacks_stay_and_are_named) {
  auto trial = standing(subject());
  for (std::int64_t f = 0; f < trial.frames(); ++f) trial.set_missing(f, 4);
  trial.names[7] = "somebody else's";
  const auto result = place_markers(leg(), trial, PlaceOptions{}).value();
  EXPECT_THAT(result.unseen, ElementsAre("THA", "TIB"));
  EXPECT_EQ(result.model.markers[4].x_in_body, leg().markers[4].x_in_body);
}

TEST(PlaceMarkers, averages_the_time_range) {
  auto trial = standing(leg());
  for (std::int64_t f = 0; f < trial.frames(); ++f)
    for (std::int64_t m = 0; m < trial.markers(); ++m)
      trial.x(f, m) += Vector3d(0.001 * (static_cast<double>(f) - 4.5), 0.0, 0.0);
  const auto result = place_markers(leg(), trial, PlaceOptions{}).value();
  const auto middle = place_markers(leg(), standing(leg()), PlaceOptions{}).value();
  EXPECT_LT((result.pose - middle.pose).norm(), 1e-6);
  PlaceOptions late;
  late.ik.first_time_s = trial.time.time_s(9);
  EXPECT_GT((place_markers(leg(), trial, late)->pose - middle.pose).norm(), 0.004);
}

TEST(PlaceMarkers, refuses_a_subject_who_moves) {
  testing_leg::Recording how;
  how.frames = 30;
  auto o = options();
  o.max_marker_movement_m = 0.01;
  const auto result = place_markers(leg(), testing_leg::record(leg(), how), o);
  ASSERT_FALSE(result);
  EXPECT_THAT(result.error().message, HasSubstr("at most 10.0 mm"));
  EXPECT_TRUE(place_markers(leg(), standing(leg()), o));
}

TEST(PlaceMarkers, says_what_is_wrong) {
  auto o = options();
  o.fixed = {"GONE"};
  EXPECT_THAT(place_markers(leg(), standing(leg()), o).error().message,
              HasSubstr("'GONE' is not in the model"));
  o = options();
  o.ik.first_time_s = 100.0;
  EXPECT_THAT(place_markers(leg(), standing(leg()), o).error().message, HasSubstr("no frame between 100"));
}

}  // namespace
}  // namespace kinemark::motion
