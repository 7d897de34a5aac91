// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Measures of a pendulum beside their closed forms, and what a person's model lacks.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"
#include "kinemark/workflow/motion/dynamics.h"
#include "kinemark/workflow/motion/testing/pendulum.h"

namespace kinemark::workflow {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::Pendulum;

const data::Measure* find(const MotionMeasured& found, const std::string& id) {
  const auto at = std::ranges::find(found.measures, id, &data::Measure::id);
  return at == found.measures.end() ? nullptr : &*at;
}

Error failure(const model::Model& model, const GivenMotion& given, const MotionMeasureOptions& options) {
  const auto found = measure_motion(model, given, options);
  return found ? Error{} : found.error();
}

TEST(MeasureMotion, ThePendulumsExtremesAreKnown) {
  const Pendulum p;
  const auto found =
      measure_motion(p.model, {.motion = p.motion(2e-3)}, {.torques = true, .refits = 39}).value();
  // The largest torque, to a thousandth of a second.
  double most_nm = 0.0;
  for (int i = 0; i < 1250; ++i) most_nm = std::max(most_nm, p.torque(0.001 * i));
  const double peak = p.amplitude * p.frequency;
  for (const auto& [id, truth] :
       {std::pair("joint_range", 2.0 * p.amplitude), std::pair("joint_maximum", p.amplitude),
        std::pair("joint_peak_velocity", peak), std::pair("joint_moment_maximum", most_nm),
        std::pair("com_peak_speed", p.length_m * peak),
        std::pair("com_vertical_range", p.length_m * (1.0 - std::cos(p.amplitude)))}) {
    const auto* measure = find(found, id);
    ASSERT_NE(measure, nullptr) << id;
    EXPECT_EQ(measure->interval.kind, data::IntervalKind::two_sided) << id << ": " << measure->remark;
    EXPECT_LT(std::abs(measure->value - truth), 4.0 * measure->sd + 1e-3 * truth) << id;
    EXPECT_LT(measure->sd, 0.05 * truth) << id;
    EXPECT_TRUE(measure->validate()) << id;
  }
  EXPECT_EQ(found.motion.tau.size(), found.motion.q.size());
  EXPECT_TRUE(found.record.driven[0] && found.record.measured[0]);
  EXPECT_TRUE(found.record.torque_known.all());
  EXPECT_THAT(found.remarks.warnings, Not(Contains(HasSubstr("no standard deviations"))));
}

TEST(MeasureMotion, WithoutTorquesThereIsNoWork) {
  const Pendulum p;
  const auto found = measure_motion(p.model, {.motion = p.motion()}, {.refits = 0}).value();
  EXPECT_EQ(find(found, "joint_work_net"), nullptr);
  EXPECT_NE(find(found, "joint_range"), nullptr);
  EXPECT_THAT(found.motion.tau, IsEmpty());
  EXPECT_EQ(found.record.torque_known.size(), 0);
}

TEST(MeasureMotion, StretchesAreRows) {
  const Pendulum p;
  const auto found =
      measure_motion(
          p.model, {.motion = p.motion()},
          {.measures = {"joint_maximum"},
           .stretches =
               {{.name = "first", .first = 10, .count = 100},
                {.name = "Foot Strike Left 2", .context = "Left", .cycle = 1, .first = 150, .count = 60}},
           .refits = 0})
          .value();
  ASSERT_EQ(found.measures.size(), 2U);
  EXPECT_EQ(found.measures[0].region, "first");
  EXPECT_DOUBLE_EQ(found.measures[0].start_s, 0.1);
  EXPECT_EQ(found.measures[1].cycle, 1);
}

TEST(MeasureMotion, WhatIntervalsDoNotHoldIsSaid) {
  const Pendulum p;
  MotionMeasureOptions options{.measures = {"joint_range"}, .refits = 39};
  GivenMotion given{.motion = p.motion()};
  EXPECT_THAT(
      measure_motion(p.model, given, options)->remarks.warnings,
      Contains("the motion has no standard deviations: intervals hold the errors that its samples show, "
               "not those of skin and markers"));
  given.names.no_deviations = "no standard deviations lie beside swing.mot";
  EXPECT_THAT(measure_motion(p.model, given, options)->remarks.warnings,
              Contains(HasSubstr("no standard deviations lie beside swing.mot: intervals hold")));
  given.motion = p.motion(2e-3);
  EXPECT_THAT(measure_motion(p.model, given, options)->remarks.warnings,
              Not(Contains(HasSubstr("intervals hold the errors that its samples show"))));
  EXPECT_THAT(measure_motion(p.model, given, options)->remarks.warnings,
              Not(Contains(HasSubstr("coordinates were low-passed at"))));
  options.cutoff_hz = 6.0;
  const auto passed = measure_motion(p.model, given, options).value();
  EXPECT_THAT(
      passed.remarks.warnings,
      Contains("coordinates were low-passed at 6 Hz: what that leaves of their noise is not known, and "
               "there are no intervals"));
  EXPECT_EQ(passed.measures[0].interval.kind, data::IntervalKind::none);
}

/// A person's model after `change`, with the motion that was simulated of it.
template <class Change>
std::vector<std::string> warnings_of(const Change& change) {
  auto description = pipeline::human_model().value();
  const auto whole = model::Model::compile(description).value();
  const auto subject = simulation::simulate_subject(whole, {.duration_s = 1.0, .rate_hz = 60.0}).value();
  change(description);
  const auto model = model::Model::compile(description).value();
  return measure_motion(model, {.motion = subject.truth}, {.measures = {"joint_range"}, .refits = 0})
      .value()
      .remarks.warnings;
}

TEST(MeasureMotion, WhatAModelLacksForMassCentreAndMarginsIsSaid) {
  const auto whole = warnings_of([](auto&) {});
  EXPECT_THAT(whole, Not(Contains(HasSubstr("has no masses: neither the mass centre nor"))));
  EXPECT_THAT(whole, Not(Contains(HasSubstr("no marker of the model is on a foot of a side"))));
  const auto light = warnings_of([](auto& m) {
    for (auto& body : m.bodies) body.mass = 0.0, body.inertia_about_com.setZero();
  });
  EXPECT_THAT(light,
              Contains(HasSubstr("has no masses: neither the mass centre nor angular momentum is measured")));
  EXPECT_THAT(light, Not(Contains(HasSubstr("no marker of the model is on a foot of a side"))));
  const auto bare = warnings_of([](auto& m) { m.markers.clear(); });
  EXPECT_THAT(bare, Contains(HasSubstr(
                        "no marker of the model is on a foot of a side (calcn_r, foot_l, toes_r): there "
                        "are no margins of stability")));
}

TEST(MeasureMotion, CoordinatesByNamePatternAndPair) {
  const auto model = model::Model::compile(pipeline::human_model().value()).value();
  const auto subject = simulation::simulate_subject(model, {.duration_s = 1.0, .rate_hz = 60.0}).value();
  const auto found = measure_motion(model, {.motion = subject.truth},
                                    {.measures = {"joint_range", "phase_locking"},
                                     .select = {"knee_angle_?"},
                                     .couple = {"hip_flexion_r,knee_angle_r"},
                                     .refits = 0})
                         .value();
  std::vector<std::string> subjects;
  for (const auto& measure : found.measures) subjects.push_back(measure.subject);
  EXPECT_THAT(subjects, ::testing::UnorderedElementsAre("knee_angle_r", "knee_angle_l",
                                                        "hip_flexion_r and knee_angle_r"));
  const auto message = [&](MotionMeasureOptions options) {
    options.refits = 0;
    return failure(model, {.motion = subject.truth}, options).message;
  };
  EXPECT_THAT(message({.select = {"knee_angel_r"}}),
              HasSubstr("no coordinate 'knee_angel_r' that moves by itself (nearest: knee_angle_r"));
  EXPECT_THAT(message({.couple = {"knee_angle_r"}}), HasSubstr("'knee_angle_r' is not two coordinates: hip"));
  EXPECT_THAT(message({.couple = {"knee_angle_r,knee_angle_r"}}), HasSubstr("one and another"));
}

TEST(MeasureMotion, RefusesInOneSentence) {
  const Pendulum p;
  const GivenMotion given{.motion = p.motion(), .names = {.motion = "swing.mot"}};
  const auto none = failure(p.model, given, {.measures = {"joint_work_net"}, .refits = 0});
  EXPECT_EQ(none.code, Code::bad_input);
  EXPECT_THAT(none.message, HasSubstr("swing.mot: nothing of what is asked for can be measured"));
  EXPECT_EQ(failure(p.model, given, {.measures = {"joint_rang"}}).code, Code::usage);
  EXPECT_EQ(failure(p.model, given, {.refits = 5}).code, Code::usage);
  EXPECT_THAT(
      failure(p.model, given, {.stretches = {{.name = "a", .first = 0, .count = 3}}, .refits = 0}).message,
      HasSubstr("swing.mot: span 'a' has fewer than"));
  EXPECT_THAT(failure(p.model, given, {.cutoff_hz = 60.0}).message, HasSubstr("a cut-off of 60 Hz"));
}

}  // namespace
}  // namespace kinemark::workflow
