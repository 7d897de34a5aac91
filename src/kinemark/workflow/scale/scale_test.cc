// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/scale/scale.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/simulation/subject.h"

namespace kinemark::workflow {
namespace {

using Eigen::Vector3d;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A person, a motion of it, and a general model that is 7 % too small for it.
struct Person {
  data::ModelDescription body = pipeline::human_model().value();
  data::ModelDescription small = body;
  data::Trajectories moving = simulate(3.0);

  Person() {
    const std::vector<Vector3d> factors(small.bodies.size(), Vector3d::Constant(0.93));
    motion::apply_factors(small, factors, true);
  }
  [[nodiscard]] data::Trajectories simulate(double duration_s) const {
    const auto model = model::Model::compile(body).value();
    return simulation::simulate_subject(model, {.duration_s = duration_s, .rate_hz = 60.0}).value().markers;
  }
};

const Person& person() {
  static const Person one;
  return one;
}

ScaleTrial trial_of(data::Trajectories markers, std::string name) {
  return {.recording = {.trial = {.markers = std::move(markers)}}, .name = std::move(name)};
}

/// Three frames in one posture.
ScaleTrial standing() { return trial_of(person().simulate(0.05), "cal"); }
ScaleTrial moving() { return trial_of(person().moving, "walk"); }

ScaleInputs by_motion() {
  ScaleInputs inputs;
  inputs.motion = moving();
  return inputs;
}

ScaleInputs by_static_trial() {
  ScaleInputs inputs;
  inputs.still = standing();
  return inputs;
}

ScaleOptions quick() {
  ScaleOptions options;
  options.adapt.max_frames = 20;
  return options;
}

data::ScaleRecipe right_thigh() {
  data::ScaleRecipe recipe;
  recipe.measurements = {
      {.name = "right thigh", .pairs = {{"RTHI", "RKNE"}}, .bodies = {{.body = "femur_r"}}}};
  return recipe;
}

double factor_of(const ScaleFound& found, const std::string& body) {
  const auto one = std::ranges::find(found.factors, body, &data::BodyFactors::body);
  return one == found.factors.end() ? 0.0 : one->factors.y();
}

double mass_of(const data::ModelDescription& model) {
  double mass = 0.0;
  for (const auto& body : model.bodies) mass += body.mass;
  return mass;
}

double between_hips(const data::ModelDescription& model) {
  std::vector<Vector3d> hips;
  for (const auto& joint : model.joints)
    if (joint.name.starts_with("hip_")) hips.push_back(joint.parent_from_joint.translation);
  return hips.size() == 2 ? (hips[0] - hips[1]).norm() : 0.0;
}

std::string refusal(ScaleInputs inputs, const ScaleOptions& options = quick()) {
  const auto found = scale(person().small, std::move(inputs), options);
  return found ? "it was scaled" : found.error().message;
}

void exchange(data::Trajectories& markers, const std::string& one, const std::string& other) {
  const auto i = markers.find(one), j = markers.find(other);
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    const Vector3d x = markers.x(f, i);
    markers.x(f, i) = markers.x(f, j);
    markers.x(f, j) = x;
  }
}

TEST(Scale, FindsSizesFromAMotionAndSaysHowWellTheyFit) {
  auto options = quick();
  options.mass_kg = 60.0;
  const auto found = scale(person().small, by_motion(), options).value();
  ASSERT_TRUE(found.from_motion);
  EXPECT_LT(found.from_motion->rms_after_m, 0.003);
  EXPECT_NEAR(factor_of(found, "femur_r"), 1.0 / 0.93, 0.03);
  EXPECT_NEAR(factor_of(found, "tibia_l"), 1.0 / 0.93, 0.03);
  EXPECT_NEAR(mass_of(found.model), 60.0, 1e-9);
  EXPECT_TRUE(found.static_trials.empty());
  ASSERT_EQ(found.remarks.gates.size(), 2U);
  EXPECT_EQ(found.remarks.gates[0].name, "sizes");
  EXPECT_EQ(found.remarks.gates[1].name, "marker_rms");
  EXPECT_TRUE(found.remarks.passed());
  options.max_rms_m = 1e-5;
  const auto strict = scale(person().small, by_motion(), options).value();
  EXPECT_FALSE(strict.remarks.passed());
  EXPECT_THAT(strict.remarks.warnings, Contains(HasSubstr("at most 0.0 mm is accepted")));
}

TEST(Scale, AStaticTrialGivesSizesAndMarkersWhereTheyAre) {
  const auto found = scale(person().small, by_static_trial(), quick()).value();
  ASSERT_TRUE(found.from_static && found.placed);
  EXPECT_EQ(found.from_static->tissue_sd_m, 0.0) << "one posture: not asked";
  EXPECT_NEAR(factor_of(found, "femur_r"), 1.0 / 0.93, 0.05);
  ASSERT_EQ(found.static_trials.size(), 1U);
  EXPECT_EQ(found.static_trials[0].file, "cal");
  EXPECT_TRUE(found.static_trials[0].judgement.findings.empty());
  EXPECT_TRUE(found.remarks.passed());
}

TEST(Scale, AnExchangeInTheStaticTrialIsNamedBeforeItIsBuiltOn) {
  auto inputs = by_static_trial();
  exchange(inputs.still->recording.trial.markers, "LTOE", "LHEE");
  inputs.motion = moving();
  const auto found = scale(person().small, std::move(inputs), quick()).value();
  EXPECT_FALSE(found.remarks.passed());
  EXPECT_THAT(found.remarks.warnings, Contains(HasSubstr("LHEE and LTOE are exchanged in cal")));
  EXPECT_EQ(found.static_trials.at(0).judgement.movements, 1) << "the motion is asked too";
}

TEST(Scale, ABodyIsNeverTurnedInsideOutAndTheExchangeIsNamed) {
  auto options = quick();
  options.adapt.marker_noise_sd_m = 1e-4;  // sizes follow the markers at any price
  auto inputs = by_static_trial();
  exchange(inputs.still->recording.trial.markers, "LASI", "RASI");
  const auto found = scale(person().small, std::move(inputs), options).value();
  EXPECT_THAT(found.remarks.warnings, Contains(HasSubstr("LASI and RASI are exchanged in cal")));
  EXPECT_THAT(found.remarks.warnings,
              Contains(HasSubstr("People do not differ as much as these sizes: pelvis")));
  for (const auto& factor : found.factors) EXPECT_GT(factor.factors.minCoeff(), 0.1) << factor.body;
  for (const auto& body : found.model.bodies) EXPECT_GE(body.mass, 0.0) << body.name;
}

TEST(Scale, AFailureBehindAStaticTrialSaysWhatIsWrongInThat) {
  auto model = person().small;
  for (auto& body : model.bodies) body.mass = 0.0;
  auto options = quick();
  options.mass_kg = 70.0;
  auto inputs = by_static_trial();
  const auto clean = scale(model, inputs, options);
  ASSERT_FALSE(clean);
  EXPECT_THAT(clean.error().message, Not(HasSubstr("are exchanged")));
  exchange(inputs.still->recording.trial.markers, "LASI", "RASI");
  const auto failed = scale(model, std::move(inputs), options);
  ASSERT_FALSE(failed);
  EXPECT_THAT(failed.error().message, HasSubstr("has no mass that could be scaled to 70 kg"));
  EXPECT_THAT(failed.error().message, HasSubstr("LASI and RASI are exchanged in cal"));
}

TEST(Scale, ARecipeIsMeasuredAndItsMarkersArePlacedWhereThatIsAsked) {
  auto options = quick();
  options.recipe = right_thigh();
  options.recipe->mass_kg = 80.0;
  const auto found = scale(person().small, by_static_trial(), options).value();
  ASSERT_TRUE(found.scaled);
  EXPECT_NEAR(found.scaled->measurements.at(0).factor, 1.0 / 0.93, 0.03);
  EXPECT_EQ(factor_of(found, "femur_r"), found.scaled->measurements[0].factor);
  EXPECT_EQ(factor_of(found, "femur_l"), 1.0);
  EXPECT_NEAR(mass_of(found.model), 80.0, 1e-9) << "the recipe's";
  EXPECT_FALSE(found.placed || found.from_static);
  EXPECT_TRUE(
      std::ranges::none_of(found.remarks.gates, [](const auto& g) { return g.name == "marker_rms"; }));
  options.place.emplace();
  options.mass_kg = 70.0;
  const auto placed = scale(person().small, by_static_trial(), options).value();
  EXPECT_TRUE(placed.placed);
  EXPECT_NEAR(mass_of(placed.model), 70.0, 1e-9) << "what is asked, not the recipe's";
}

TEST(Scale, ARecipeMayBeMeasuredInARecordingOfItsOwn) {
  auto options = quick();
  options.recipe = right_thigh();
  options.place.emplace();
  auto inputs = by_static_trial();
  auto larger = person().simulate(0.05);
  for (auto& x : larger.x_in_world) x *= 1.1;
  inputs.measured = trial_of(std::move(larger), "measured");
  const auto apart = scale(person().small, std::move(inputs), options).value();
  EXPECT_NEAR(apart.scaled->measurements.at(0).factor, 1.1 / 0.93, 0.03);
  ASSERT_EQ(apart.static_trials.size(), 2U);
  EXPECT_EQ(apart.static_trials[0].file, "measured");
  EXPECT_EQ(apart.static_trials[1].file, "cal");
}

TEST(Scale, ByHandNothingNeedsToBeRecorded) {
  ScaleOptions options;
  options.recipe.emplace().manual = {{.body = "femur_r", .factors = Vector3d(1.0, 1.1, 1.0)}};
  const auto found = scale(person().small, {}, options).value();
  EXPECT_EQ(factor_of(found, "femur_r"), 1.1);
  EXPECT_THAT(found.remarks.gates, IsEmpty());
  EXPECT_THAT(found.remarks.warnings, IsEmpty());
}

ScaleOptions options_without_axes(ScaleOptions options) {
  options.axes = {};
  return options;
}

TEST(Scale, ARecordingIsTurnedOnceAndThatIsSaid) {
  const auto upright = scale(person().small, by_static_trial(), quick()).value();
  auto inputs = by_static_trial();
  auto& x = inputs.still->recording.trial.markers.x_in_world;
  for (std::size_t i = 0; i + 2 < x.size(); i += 3)  // z up
    x[i + 1] = -std::exchange(x[i + 2], x[i + 1]);
  inputs.still->where = "day 1/cal";
  auto options = quick();
  EXPECT_THAT(refusal(inputs, options), HasSubstr("day 1/cal: z is up in the recording by the body"));
  options.axes.up = "z";
  const auto turned = scale(person().small, inputs, options).value();
  EXPECT_NEAR(factor_of(turned, "femur_r"), factor_of(upright, "femur_r"), 1e-6);
  EXPECT_THAT(turned.remarks.warnings,
              ::testing::ElementsAre("day 1/cal: the recording was turned: z is up in it, y in the model"));
  options.recipe = right_thigh();
  options.place.emplace();
  const auto as_it_was = scale(person().small, by_static_trial(), options_without_axes(options)).value();
  const auto twice = scale(person().small, std::move(inputs), options).value();
  EXPECT_LT((twice.placed->pose - as_it_was.placed->pose).norm(), 1e-6) << "measured in and placed by";
}

TEST(Scale, ShouldersAreSetFreeAndAMassIsSharedOutWhenAsked) {
  auto options = quick();
  options.clavicles = options.dempster = true;
  options.mass_kg = 80.0;
  const auto found = scale(person().small, by_static_trial(), options).value();
  EXPECT_GE(found.model.find_coordinate("clav_elevation_l"), 0);
  EXPECT_FALSE(found.clavicles.empty());
  EXPECT_NEAR(found.model.bodies[at(found.model.find_body("femur_r"))].mass, 8.0, 1e-9);
}

/// The markers of a body of the model, as a segment.
data::SkeletonSegment segment_of(const data::ModelDescription& model, const std::string& body) {
  data::SkeletonSegment segment{.name = body};
  for (std::size_t m = 0; m < model.markers.size(); ++m)
    if (model.markers[m].body_idx == model.find_body(body)) segment.markers.push_back(static_cast<int>(m));
  segment.x_in_segment.resize(3, std::ssize(segment.markers));
  for (std::size_t i = 0; i < segment.markers.size(); ++i)
    segment.x_in_segment.col(static_cast<Eigen::Index>(i)) = model.markers[at(segment.markers[i])].x_in_body;
  return segment;
}

/// The hips of a model among the markers of its pelvis, as joints() finds them.
data::Skeleton hips_of(const data::ModelDescription& model, double sd_m) {
  data::Skeleton skeleton;
  for (const auto& marker : model.markers) skeleton.markers.push_back(marker.name);
  for (const char* body : {"pelvis", "femur_r", "femur_l"})
    skeleton.segments.push_back(segment_of(model, body));
  for (const auto& joint : model.joints) {
    if (!joint.name.starts_with("hip_")) continue;
    data::SkeletonJoint hip{.name = joint.name};
    hip.child_segment = joint.name == "hip_r" ? 1 : 2;
    hip.centre_in_parent = joint.parent_from_joint.translation;
    hip.covariance_in_parent = sd_m * sd_m * Eigen::Matrix3d::Identity();
    hip.covariance_in_child = Eigen::Matrix3d::Constant(kNaN);
    skeleton.joints.push_back(std::move(hip));
  }
  return skeleton;
}

TEST(Scale, MeasuredJointsCountButNotInTheRecordingThatTheyAreOf) {
  auto wide = person().body;
  for (auto& joint : wide.joints)
    if (joint.name.starts_with("hip_")) joint.parent_from_joint.translation.z() *= 1.25;
  auto inputs = by_static_trial();
  const double without = between_hips(scale(person().small, inputs, quick())->model);
  inputs.joints = hips_of(wide, 0.001);
  const auto with = scale(person().small, inputs, quick()).value();
  EXPECT_THAT(with.joints, ::testing::UnorderedElementsAre("hip_r", "hip_l"));
  EXPECT_NEAR(between_hips(with.model), between_hips(wide), 0.004);
  EXPECT_GT(std::abs(without - between_hips(wide)), 0.02);
  inputs.still->holds_joints = true;
  const auto same = scale(person().small, inputs, quick()).value();
  EXPECT_LT(std::abs(between_hips(same.model) - without), 0.02);
}

TEST(Scale, DoubtfulSamplesAreLeftOutWhereThatIsAsked) {
  auto inputs = by_motion();
  auto& markers = inputs.motion->recording.trial.markers;
  const auto knee = markers.find("LKNE");
  for (std::int64_t f = 60; f < 63; ++f) markers.x(f, knee) += Vector3d(0.0, 0.4, 0.0);
  auto options = quick();
  const auto kept = scale(person().small, inputs, options).value();
  EXPECT_THAT(kept.remarks.warnings, Not(Contains(HasSubstr("eft out"))));
  options.drop_doubtful = true;
  const auto dropped = scale(person().small, std::move(inputs), options).value();
  EXPECT_THAT(dropped.remarks.warnings, Contains(HasSubstr("eft out")));
}

/// The recording at four times its rate, on lines between its samples.
data::Trajectories upsampled(const data::Trajectories& low) {
  auto time = low.time;
  time.rate_hz *= 4.0;
  time.frames = 4 * (low.frames() - 1) + 1;
  auto high = data::Trajectories::all_missing(low.names, time);
  for (std::int64_t f = 0; f < high.frames(); ++f)
    for (std::int64_t m = 0; m < high.markers(); ++m) {
      const auto before = f / 4, after = std::min(before + 1, low.frames() - 1);
      const double share = static_cast<double>(f % 4) / 4.0;
      high.x(f, m) = (1.0 - share) * low.x(before, m) + share * low.x(after, m);
      high.state[high.index(f, m)] = data::SampleState::measured;
    }
  return high;
}

TEST(Scale, FramesThatTheRecorderMadeAreNoMeasurements) {
  auto inputs = by_motion();
  const auto low = scale(person().small, inputs, quick()).value();
  EXPECT_THAT(low.remarks.warnings, Not(Contains(HasSubstr("sizes are found from measured frames alone"))));
  inputs.motion->recording.trial.markers = upsampled(person().moving);
  const auto high = scale(person().small, std::move(inputs), quick()).value();
  EXPECT_THAT(high.remarks.warnings, Contains(HasSubstr("the recorder measured at 60 Hz")));
  EXPECT_THAT(high.remarks.warnings, Contains(HasSubstr("sizes are found from measured frames alone")));
  EXPECT_EQ(high.from_motion->frames, low.from_motion->frames);
  EXPECT_NEAR(factor_of(high, "femur_r"), factor_of(low, "femur_r"), 1e-6);
}

TEST(Scale, MusclesFollowTheirBodiesAndPathsThatCannotBeReadAreSaid) {
  ScaleOptions options;
  options.recipe.emplace().manual = {{.body = "femur_r", .factors = Vector3d::Constant(1.1)}};
  ScaleInputs inputs;
  const int thigh = person().small.find_body("femur_r");
  data::MusclePath path{.name = "along the thigh", .kind = "Ligament", .points = {}, .wraps = {}};
  path.points.resize(2);
  path.points[0].body_idx = path.points[1].body_idx = thigh;
  path.points[1].x_in_frame = Vector3d(0.0, -0.2, 0.0);
  inputs.paths = {path};
  const auto found = scale(person().small, inputs, options).value();
  ASSERT_EQ(found.muscles.size(), 1U);
  EXPECT_NEAR(found.muscles[0].ratio, 1.1, 1e-12);
  EXPECT_THAT(found.remarks.warnings, Not(Contains(HasSubstr("because their paths cannot be read"))));
  inputs.paths_fault = "path of 'odd'";
  const auto unread = scale(person().small, inputs, options).value();
  EXPECT_THAT(unread.muscles, IsEmpty());
  EXPECT_THAT(unread.remarks.warnings,
              Contains(HasSubstr("because their paths cannot be read: path of 'odd'")));
}

TEST(Scale, SaysWhatIsMissingOrWithoutUse) {
  EXPECT_THAT(refusal({}), HasSubstr("nothing to scale by"));
  auto inputs = by_motion();
  inputs.measured = standing();
  EXPECT_THAT(refusal(inputs), HasSubstr("no recipe that measures"));
  auto options = quick();
  options.recipe = right_thigh();
  EXPECT_THAT(refusal(by_motion(), options), HasSubstr("no recording to measure in"));
  options = quick();
  options.place.emplace();
  EXPECT_THAT(refusal(by_static_trial(), options), HasSubstr("beside a recipe only"));
  options.recipe.emplace();
  EXPECT_THAT(refusal(by_motion(), options), HasSubstr("there is no static trial"));
  options = quick();
  options.recipe.emplace();
  EXPECT_THAT(refusal(by_static_trial(), options),
              HasSubstr("neither measures in it nor places markers by it"));
  inputs = by_static_trial();
  inputs.joints.emplace();
  options.place.emplace();
  EXPECT_THAT(refusal(inputs, options), HasSubstr("a model that is adapted"));
}

TEST(Scale, SaysWhichOptionIsOutOfRange) {
  auto options = quick();
  options.mass_kg = -1.0;
  EXPECT_THAT(refusal(by_motion(), options), HasSubstr("a mass of -1 kg"));
  options = quick();
  options.dempster = true;
  EXPECT_THAT(refusal(by_motion(), options), HasSubstr("need the body mass"));
  options.recipe = right_thigh();
  options.recipe->mass_kg = 70.0;
  options.place.emplace();
  EXPECT_EQ(refusal(by_static_trial(), options), "it was scaled") << "the recipe has the mass";
  options = quick();
  options.size_prior_sd = 0.0;
  EXPECT_THAT(refusal(by_motion(), options), HasSubstr("a prior of 0"));
}

TEST(Scale, ErrorsNameWhatTheyAreOf) {
  auto inputs = by_motion();
  inputs.motion->recording.trial.markers.names.assign(inputs.motion->recording.trial.markers.names.size(),
                                                      "");
  for (std::size_t m = 0; m < inputs.motion->recording.trial.markers.names.size(); ++m)
    inputs.motion->recording.trial.markers.names[m] = "box" + std::to_string(m);
  EXPECT_THAT(refusal(std::move(inputs)), ::testing::StartsWith("walk: "));
  auto options = quick();
  options.recipe = right_thigh();
  options.recipe->measurements[0].pairs[0].first = "NOBODY";
  EXPECT_THAT(refusal(by_static_trial(), options), ::testing::StartsWith("the recipe: "));
}

}  // namespace
}  // namespace kinemark::workflow
