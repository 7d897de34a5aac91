// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/scale.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "kinemark/stages/motion/scaling/testing/small_leg.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;
using ::testing::HasSubstr;
using testing_leg::leg;

std::vector<Vector3d> same_factors(const data::ModelDescription& model, const Vector3d& factors) {
  return std::vector<Vector3d>(model.bodies.size(), factors);
}

/// A static recording of a leg that is bigger by known factors.
data::Trajectories static_trial(const data::ModelDescription& model) {
  testing_leg::Recording how;
  how.frames = 20;
  how.amplitude = 0.0;
  return testing_leg::record(model, how);
}

data::ScaleMeasurement thigh_measurement() {
  return {.name = "thigh", .pairs = {{"THI", "KNM"}, {"THA", "KNE"}}, .bodies = {{.body = "femur_r"}}};
}

TEST(FindOverallSize, comes_from_distances_within_a_body) {
  auto subject = leg();
  apply_factors(subject, same_factors(subject, Vector3d::Constant(1.2)), true);
  auto recording = static_trial(subject);
  EXPECT_NEAR(find_overall_size(leg(), recording).value(), 1.2, 0.01);
  recording.set_missing(3, 2);
  EXPECT_NEAR(find_overall_size(leg(), recording).value(), 1.2, 0.01);
}

TEST(FindOverallSize, is_that_of_the_model_without_a_distance_and_refuses_a_wrong_unit) {
  auto recording = static_trial(leg());
  auto none = recording;
  for (std::size_t m = 0; m < none.names.size(); ++m) none.names[m] = "X" + std::to_string(m);
  EXPECT_EQ(find_overall_size(leg(), none).value(), 1.0);
  for (double& x : recording.x_in_world) x *= 1000.0;
  const auto refused = find_overall_size(leg(), recording);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Code::bad_input);
  EXPECT_THAT(refused.error().message, HasSubstr("wrong unit"));
}

TEST(ApplyFactors, a_uniform_factor_scales_every_length) {
  auto model = leg();
  const auto before = model;
  apply_factors(model, same_factors(model, Vector3d::Constant(1.2)), true);
  EXPECT_TRUE(model.joints[2].parent_from_joint.translation.isApprox(Vector3d(0, -0.48, 0)));
  EXPECT_TRUE(model.joints[0].child_from_joint.translation.isApprox(Vector3d(0.06, 0, 0)));
  EXPECT_TRUE(model.markers[4].x_in_body.isApprox(1.2 * before.markers[4].x_in_body));
  EXPECT_NEAR(model.joints[2].axes[1].function(0.3).f, 1.2 * before.joints[2].axes[1].function(0.3).f, 1e-15);
  EXPECT_NEAR(model.bodies[1].mass, before.bodies[1].mass * std::pow(1.2, 3), 1e-12);
  EXPECT_TRUE(model.bodies[1].inertia_about_com.isApprox(
      std::pow(1.2, 5) * before.bodies[1].inertia_about_com, 1e-12));
  // Translations of the root are coordinates in metres, not shape.
  EXPECT_TRUE(model.joints[0].axes[3].function.is_identity());
}

TEST(ApplyFactors, masses_can_stay) {
  auto model = leg();
  const auto before = model;
  apply_factors(model, same_factors(model, Vector3d::Constant(1.2)), false);
  EXPECT_EQ(model.bodies[1].mass, before.bodies[1].mass);
  EXPECT_TRUE(model.bodies[1].inertia_about_com.isApprox(
      std::pow(1.2, 2) * before.bodies[1].inertia_about_com, 1e-12));
}

TEST(ApplyFactors, translations_of_a_turned_joint_frame_take_the_factors_of_its_axes_as_in_opensim) {
  auto model = leg();
  auto& knee = model.joints[2];
  knee.parent_from_joint.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // x of the frame is y of the thigh
  knee.axes.push_back({.is_rotation = false,
                       .axis = Vector3d(2.0, 0.0, 0.0),
                       .coordinate_idx = knee.axes.front().coordinate_idx,
                       .function = math::ScalarFunction::linear(0.1, 0.2)});
  apply_factors(model, same_factors(model, Vector3d(1.5, 7.0, 1.0)), false);
  EXPECT_NEAR(model.joints[2].axes.back().function(0.0).f, 0.3, 1e-15);
}

TEST(ApplyFactors, a_body_stretched_along_one_axis_has_the_inertia_of_its_points) {
  // Six equal point masses on the axes.
  const double m = 0.5;
  const Vector3d half(0.1, 0.2, 0.3);
  const auto inertia = [&](const Vector3d& h) {
    return Eigen::Matrix3d(
        2.0 * m *
        Vector3d(h.y() * h.y() + h.z() * h.z(), h.x() * h.x() + h.z() * h.z(), h.x() * h.x() + h.y() * h.y())
            .asDiagonal());
  };
  auto model = leg();
  model.bodies[2].inertia_about_com = inertia(half);
  auto factors = same_factors(model, Vector3d::Ones());
  factors[2] = Vector3d(1.0, 1.5, 0.8);
  apply_factors(model, factors, false);
  EXPECT_TRUE(model.bodies[2].inertia_about_com.isApprox(inertia(half.cwiseProduct(factors[2])), 1e-12));
}

TEST(ApplyFactors, parent_and_child_scale_their_own_side_of_a_joint) {
  auto model = leg();
  const auto before = model;
  auto factors = same_factors(model, Vector3d::Ones());
  factors[1] = Vector3d(1.0, 2.0, 1.0);
  apply_factors(model, factors, false);
  EXPECT_EQ(model.joints[1].parent_from_joint.translation, before.joints[1].parent_from_joint.translation);
  EXPECT_TRUE(model.joints[1].child_from_joint.translation.isApprox(Vector3d(0, 0.02, 0)));
  EXPECT_TRUE(model.joints[2].parent_from_joint.translation.isApprox(Vector3d(0, -0.8, 0)));
  // The knee slides along x: a thigh that grows in y leaves it alone.
  EXPECT_NEAR(model.joints[2].axes[1].function(0.3).f, before.joints[2].axes[1].function(0.3).f, 1e-15);
}

TEST(ScaleModel, measured_over_model_distance_averaged_over_pairs) {
  const auto model = leg();
  auto subject = model;
  auto factors = same_factors(model, Vector3d::Ones());
  factors[1] = Vector3d::Constant(1.1);
  apply_factors(subject, factors, false);
  const auto recording = static_trial(subject);
  data::ScaleRecipe recipe;
  recipe.measurements = {thigh_measurement()};
  const auto result = scale_model(model, &recording, recipe);
  ASSERT_TRUE(result) << result.error().message;
  EXPECT_TRUE(result->factors[1].factors.isApprox(Vector3d::Constant(1.1), 1e-9));
  EXPECT_EQ(result->factors[2].factors, Vector3d::Ones());
  ASSERT_EQ(result->measurements.size(), 1U);
  EXPECT_EQ(result->measurements[0].pairs.size(), 2U);
  EXPECT_NEAR(result->measurements[0].pairs[0].measured_m, 1.1 * result->measurements[0].pairs[0].model_m,
              1e-9);
  EXPECT_NEAR(result->measurements[0].pairs[0].measured_sd_m, 0.0, 1e-7);
  EXPECT_TRUE(result->model.joints[2].parent_from_joint.translation.isApprox(Vector3d(0, -0.44, 0), 1e-9));
}

// A pair counts in the frames that show both; its deviation is that of these frames.
TEST(ScaleModel, a_pair_is_measured_in_the_frames_that_show_both) {
  const auto model = leg();
  auto recording = static_trial(model);
  const auto thi = recording.find("THI"), knm = recording.find("KNM");
  const Vector3d along = (recording.x(0, thi) - recording.x(0, knm)).normalized();
  for (std::int64_t f = 0; f < recording.frames(); ++f) {
    if (f % 2 == 0)
      recording.x(f, thi) = Vector3d::Constant(5.0);
    else
      recording.x(f, thi) += (f % 4 == 1 ? 0.003 : -0.003) * along;
    if (f % 2 == 0) recording.set_missing(f, f % 4 == 0 ? thi : knm);
  }
  data::ScaleRecipe recipe;
  recipe.measurements = {thigh_measurement()};
  recipe.measurements[0].pairs = {{"THI", "KNM"}};
  const auto result = scale_model(model, &recording, recipe);
  ASSERT_TRUE(result) << result.error().message;
  const auto& pair = result->measurements[0].pairs[0];
  EXPECT_NEAR(pair.measured_m, pair.model_m, 1e-9);
  EXPECT_NEAR(pair.measured_sd_m, 0.003, 1e-9);
  EXPECT_NEAR(result->factors[1].factors.y(), 1.0, 1e-8);
}

TEST(ScaleModel, a_factor_is_the_mean_of_its_pairs) {
  const auto model = leg();
  auto recording = static_trial(model);
  data::ScaleRecipe recipe;
  recipe.measurements = {thigh_measurement()};
  // One pair 10 % longer, the other as it is.
  const auto thi = recording.find("THI"), knm = recording.find("KNM");
  for (std::int64_t f = 0; f < recording.frames(); ++f)
    recording.x(f, thi) += 0.1 * (recording.x(f, thi) - recording.x(f, knm));
  EXPECT_NEAR(scale_model(model, &recording, recipe)->measurements[0].factor, 1.05, 1e-9);
}

TEST(ScaleModel, later_steps_win_and_axes_are_kept_apart) {
  const auto model = leg();
  const auto recording = static_trial(model);
  data::ScaleRecipe recipe;
  recipe.measurements = {thigh_measurement()};
  recipe.manual = {{.body = "femur_r", .factors = Vector3d(1.3, 1.4, 1.5)}};
  EXPECT_TRUE(scale_model(model, &recording, recipe)->factors[1].factors.isApprox(Vector3d(1.3, 1.4, 1.5)));
  recipe.order = {data::ScaleStep::manual, data::ScaleStep::measurements};
  recipe.measurements[0].bodies[0].axes = Vector3d(0, 1, 0);
  EXPECT_TRUE(
      scale_model(model, &recording, recipe)->factors[1].factors.isApprox(Vector3d(1.3, 1.0, 1.5), 1e-9));
}

TEST(ScaleModel, the_mass_is_that_of_the_subject) {
  const auto model = leg();
  data::ScaleRecipe recipe;
  recipe.manual = {{.body = "femur_r", .factors = Vector3d::Constant(1.2)}};
  recipe.mass_kg = 50.0;
  const auto mass = [](const data::ModelDescription& m) {
    double sum = 0.0;
    for (const auto& body : m.bodies) sum += body.mass;
    return sum;
  };
  const auto by_volume = scale_model(model, nullptr, recipe)->model;
  EXPECT_NEAR(mass(by_volume), 50.0, 1e-12);
  EXPECT_NEAR(by_volume.bodies[1].mass / by_volume.bodies[2].mass, 9.0 * std::pow(1.2, 3) / 3.7, 1e-12);
  recipe.preserve_mass_distribution = true;
  const auto preserved = scale_model(model, nullptr, recipe)->model;
  EXPECT_NEAR(mass(preserved), 50.0, 1e-12);
  EXPECT_NEAR(preserved.bodies[1].mass / preserved.bodies[2].mass, 9.0 / 3.7, 1e-12);
}

TEST(ScaleModel, finds_markers_behind_a_subject_prefix) {
  const auto model = leg();
  auto recording = static_trial(model);
  for (auto& name : recording.names) name = "Ann:" + name;
  data::ScaleRecipe recipe;
  recipe.measurements = {thigh_measurement()};
  EXPECT_TRUE(scale_model(model, &recording, recipe));
  recording.names[4] = "Bob:THI";
  EXPECT_THAT(scale_model(model, &recording, recipe).error().message,
              HasSubstr("Ann:THI, Bob:THI (several subjects: need the full name)"));
}

TEST(ScaleModel, says_what_is_wrong) {
  const auto model = leg();
  auto recording = static_trial(model);
  data::ScaleRecipe recipe;
  recipe.measurements = {thigh_measurement()};
  const auto message = [&](const data::Trajectories* r) {
    const auto result = scale_model(model, r, recipe);
    return result ? std::string("it ran") : result.error().message;
  };
  EXPECT_THAT(message(nullptr), HasSubstr("need a static trial"));
  recipe.first_time_s = 50.0;
  EXPECT_THAT(message(&recording), HasSubstr("no frame of the time range shows both 'THI' and 'KNM'"));
  recipe.first_time_s = -1e300;
  recipe.measurements[0].pairs[1].second = "GONE";
  EXPECT_THAT(message(&recording), HasSubstr("needs marker 'GONE', which the model does not have"));
  recipe.measurements[0] = thigh_measurement();
  auto together = model;
  for (auto& marker : together.markers)
    if (marker.name == "KNM") marker.x_in_body = together.markers[3].x_in_body;
  EXPECT_THAT(scale_model(together, &recording, recipe).error().message,
              HasSubstr("'THI' and 'KNM' are at one place in the model"));
  auto lacking = recording;
  lacking.names[3] = "renamed";
  EXPECT_THAT(scale_model(model, &lacking, recipe).error().message,
              HasSubstr("needs marker 'THI', which the recording does not have"));
  lacking.names[3] = "T.h.i";
  EXPECT_THAT(scale_model(model, &lacking, recipe).error().message,
              HasSubstr("; likely: --rename T.h.i=THI"));
  recipe.measurements[0].pairs.clear();
  EXPECT_THAT(message(&recording), HasSubstr("has no marker pair"));
  recipe.measurements[0] = thigh_measurement();
  recipe.measurements[0].bodies[0].body = "tail";
  EXPECT_THAT(message(&recording), HasSubstr("names body 'tail'"));
  recipe.measurements.clear();
  recipe.manual = {{.body = "femur_r", .factors = Vector3d::Constant(1000.0)}};
  EXPECT_THAT(message(&recording), HasSubstr("wrong unit"));
  recipe.manual.clear();
  recipe.mass_kg = -3.0;
  EXPECT_THAT(message(&recording), HasSubstr("mass of -3 kg"));
}

TEST(SetTotalMass, refuses_a_massless_model) {
  auto model = leg();
  for (auto& body : model.bodies) body.mass = 0.0;
  EXPECT_THAT(set_total_mass(model, 70.0).error().message, HasSubstr("no mass"));
}

}  // namespace
}  // namespace kinemark::motion
