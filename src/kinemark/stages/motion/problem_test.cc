// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/problem.h"

#include <gmock/gmock.h>

#include <cmath>

#include "kinemark/stages/motion/testing/body.h"

namespace kinemark::motion::internal {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing_body::description;
using testing_body::record;

model::Model body() { return model::Model::compile(description()).value(); }

std::string sentence(const data::Trajectories& markers, const IkOptions& options) {
  const auto problem = make_problem(body(), markers, options);
  return problem ? "" : problem.error().message;
}

TEST(Problem, KeepsTheMarkersThatBothSidesHaveInTheModelsOrder) {
  auto markers = record(body(), 4);
  std::swap(markers.names[0], markers.names[5]);
  markers.names[7] = "stranger";
  const auto problem = make_problem(body(), markers, {}).value();
  EXPECT_EQ(problem.model.marker_count(), 13);
  EXPECT_EQ(problem.data_marker[0], 5) << "T1 lies where U2 was";
  EXPECT_EQ(problem.data_marker[5], 0);
  EXPECT_THAT(problem.fit.excluded_as(data::kNotInRecording), ElementsAre("F2"));
  EXPECT_THAT(problem.fit.excluded_as(data::kNotInModel), ElementsAre("stranger"));
  EXPECT_EQ(problem.fit.excluded.size(), 2U);
  EXPECT_EQ(problem.fit.markers.size(), 13U);
  EXPECT_EQ(problem.fit.markers[0].body, "trunk");
}

TEST(Problem, AMarkerOfSeveralSubjectsIsNotGuessed) {
  auto markers = record(body(), 4);
  markers.names[0] = "Ann:T1";
  markers.names[7] = "Bob:T1";  // was F2
  const auto problem = make_problem(body(), markers, {}).value();
  EXPECT_THAT(problem.fit.excluded_as(data::kAmbiguous), ElementsAre("T1"));
  EXPECT_THAT(problem.fit.excluded_as(data::kNotInRecording), ElementsAre("F2"));
  EXPECT_THAT(problem.fit.excluded_as(data::kNotInModel), ElementsAre("Ann:T1", "Bob:T1"));
  IkOptions options;
  options.marker_weights = {{"Bob:T1", 1.0}};
  EXPECT_TRUE(make_problem(body(), markers, options)) << "the recording has it";
}

TEST(Problem, WeightsAreTheGivenOnesOrTheDefault) {
  IkOptions options;
  options.default_marker_weight = 2.0;
  options.marker_weights = {{"T2", 7.0}, {"T4", 0.0}};
  const auto problem = make_problem(body(), record(body(), 4), options).value();
  EXPECT_EQ(problem.weight[0], 2.0);
  EXPECT_EQ(problem.weight[1], 7.0);
  EXPECT_EQ(problem.weight.size(), 13) << "T4 takes no part";
  EXPECT_EQ(problem.fit.markers[1].weight, 7.0);
  EXPECT_EQ(problem.fit.excluded.size(), 1U);
  EXPECT_THAT(problem.fit.excluded_as(data::kNoWeight), ElementsAre("T4"));
}

TEST(Problem, AWeightForAMarkerOfNeitherSideIsAMistake) {
  IkOptions options;
  options.marker_weights = {{"T9", 1.0}};
  EXPECT_THAT(sentence(record(body(), 4), options), HasSubstr("marker 'T9', which neither"));
}

TEST(Problem, EverythingExcludedIsAnErrorThatListsWhat) {
  IkOptions options;
  options.default_marker_weight = 0.0;
  EXPECT_THAT(sentence(record(body(), 4), options), HasSubstr("weight 0 or is never seen: T1, T2"));
}

TEST(Problem, LimitsAndLocksComeFromTheModel) {
  auto locked = description();
  locked.coordinates[9].locked = true;  // the elbow
  locked.coordinates[6].clamped = false;
  const auto model = model::Model::compile(locked).value();
  const auto problem = make_problem(model, record(body(), 4), {}).value();
  const auto speed = [&](int c) {
    return problem.model.coordinates()[static_cast<std::size_t>(c)].speed_idx;
  };
  EXPECT_EQ(problem.fixed_speed[static_cast<std::size_t>(speed(9))], 1);
  EXPECT_TRUE(std::isinf(problem.upper[speed(9)])) << "a locked coordinate needs no limit";
  EXPECT_TRUE(std::isinf(problem.lower[speed(6)]));
  EXPECT_EQ(problem.lower[speed(7)], -2.5);
  EXPECT_EQ(problem.upper[speed(11)], 2.5);
  IkOptions free;
  free.limits = false;
  EXPECT_TRUE(std::isinf(make_problem(model, record(body(), 4), free).value().upper[speed(11)]));
}

TEST(Problem, ACoupledCoordinateAnswersToTheSpeedOfItsSource) {
  const auto problem = make_problem(body(), record(body(), 4), {}).value();
  EXPECT_EQ(problem.speed_of(12), problem.speed_of(11));
  EXPECT_EQ(problem.speed_of(0), -1) << "the root turns as a whole";
}

TEST(Problem, TheTimeRangeKeepsFramesAtItsEnds) {
  IkOptions options;
  options.first_time_s = 0.02;
  options.last_time_s = 0.05;
  const auto problem = make_problem(body(), record(body(), 10), options).value();
  EXPECT_EQ(problem.first_frame, 2);
  EXPECT_EQ(problem.frames, 4);
  options.first_time_s = 0.0204;  // files write few digits
  EXPECT_EQ(make_problem(body(), record(body(), 10), options).value().first_frame, 2);
  options.first_time_s = 5.0;
  options.last_time_s = 1e300;
  EXPECT_THAT(sentence(record(body(), 10), options), HasSubstr("no frame in the time range from 5 s"));
}

TEST(Problem, ObservesWhatIsThereAndNothingElse) {
  auto markers = record(body(), 4);
  markers.set_missing(2, 3);
  IkOptions options;
  options.first_time_s = 0.01;
  options.marker_weights = {{"T2", 3.0}};
  const auto problem = make_problem(body(), markers, options).value();
  Eigen::Matrix3Xd y(3, 14);
  Eigen::VectorXd w(14);
  problem.observe(markers, 1, y, w);  // frame 2 of the recording
  EXPECT_EQ(w[3], 0.0);
  EXPECT_EQ(y.col(3).norm(), 0.0);
  EXPECT_EQ(w[1], 3.0);
  EXPECT_EQ(y.col(1), markers.x(2, 1));
}

TEST(Problem, UnitsThatDisagreeAreFound) {
  for (const double factor : {1000.0, 0.001}) {
    auto markers = record(body(), 4);
    for (double& x : markers.x_in_world) x *= factor;
    EXPECT_THAT(sentence(markers, {}), HasSubstr("looks like a wrong unit")) << factor;
  }
  auto child = record(body(), 4);
  for (double& x : child.x_in_world) x *= 0.4;
  EXPECT_EQ(sentence(child, {}), "");
}

TEST(Problem, TasksMustFitTheModelAndTheFrames) {
  const auto markers = record(body(), 4);
  IkOptions options;
  options.coordinate_tasks = {{.coordinate = "wing"}};
  EXPECT_THAT(sentence(markers, options), HasSubstr("coordinate 'wing', which the model does not have"));
  options.coordinate_tasks = {{.coordinate = "knee", .values = {0.1, 0.2}}};
  EXPECT_THAT(sentence(markers, options), HasSubstr("has 2 values for 4 frames"));
  options.coordinate_tasks = {{.coordinate = "knee", .values = {0.1, 0.2, NAN, 0.0}}};
  EXPECT_THAT(sentence(markers, options), HasSubstr("not a number"));
  options.coordinate_tasks = {{.coordinate = "knee", .value = 0.5}, {.coordinate = "hip", .weight = 0.0}};
  const auto problem = make_problem(body(), markers, options).value();
  ASSERT_EQ(problem.coordinate_tasks.size(), 1U) << "no weight, no task";
  EXPECT_EQ(problem.coordinate_tasks[0].target(3), 0.5);
}

}  // namespace
}  // namespace kinemark::motion::internal
