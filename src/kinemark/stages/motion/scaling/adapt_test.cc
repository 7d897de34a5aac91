// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/adapt.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <cmath>

#include "kinemark/core/random.h"
#include "kinemark/stages/motion/scaling/testing/small_leg.h"

namespace kinemark::motion {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using testing_leg::leg;

/// Sizes of the leg's segments, and all marker positions.
std::vector<GeometryParameter> parameters(const data::ModelDescription& model) {
  auto out = scale_parameters(model, default_scale_groups(model), 0.3).value();
  const auto positions = marker_parameters(model, {}, 0.005).value();
  out.insert(out.end(), positions.begin(), positions.end());
  return out;
}

/// A subject whose sizes and markers differ from the model's; changes are in the units of the parameters.
struct Subject {
  data::ModelDescription model;
  Eigen::VectorXd change;
};

Subject subject(const std::vector<GeometryParameter>& list, std::uint64_t seed) {
  Random random(seed, 3);
  Subject out{.model = leg(), .change = Eigen::VectorXd(static_cast<Eigen::Index>(list.size()))};
  for (Eigen::Index k = 0; k < out.change.size(); ++k) {
    const bool size = list[static_cast<std::size_t>(k)].kind == ParameterKind::body_scale;
    out.change[k] = (size ? 0.04 : 0.005) * random.gaussian();
  }
  out.model = apply_geometry(out.model, list, out.change);
  return out;
}

int index_of(const AdaptResult& result, const std::string& name) {
  for (std::size_t k = 0; k < result.parameters.size(); ++k)
    if (result.parameters[k].name == name) return static_cast<int>(k);
  return -1;
}

// Sizes and positions are drawn from the priors, so that the covariance must be exact.
// Errors of one subject hang together; each subject's chi-square and share count as one number, and chance is
// judged from how these numbers scatter.
TEST(AdaptModel, finds_sizes_and_positions_of_a_noisy_recording_within_their_deviations) {
  auto list = parameters(leg());
  for (auto& parameter : list)
    if (parameter.kind == ParameterKind::body_scale) parameter.prior_sd = 0.04;
  constexpr int kSubjects = 10;
  const auto freedom = static_cast<double>(list.size());
  double chi_squares = 0.0;
  Eigen::ArrayXd share(kSubjects);
  for (int s = 0; s < kSubjects; ++s) {
    const auto seed = static_cast<std::uint64_t>(s + 1);
    const auto who = subject(list, seed);
    const auto recording = testing_leg::record(who.model, {.frames = 150, .noise_sd_m = 0.001, .seed = seed});
    const auto result = adapt_model(leg(), recording, list);
    ASSERT_TRUE(result) << result.error().message;
    EXPECT_TRUE(result->converged);
    EXPECT_NEAR(result->noise_sd_m, 0.001, 1e-4);
    EXPECT_EQ(result->tissue_sd_m, 0.0);
    EXPECT_LT(result->rms_after_m, 0.3 * result->rms_before_m);
    Eigen::VectorXd error(who.change.size());
    share[s] = 0.0;
    for (std::size_t k = 0; k < list.size(); ++k) {
      const auto& p = result->parameters[k];
      const auto i = static_cast<Eigen::Index>(k);
      error[i] = p.value - list[k].initial - who.change[i];
      if (std::abs(error[i]) < p.sd) share[s] += 1.0 / freedom;
    }
    chi_squares += error.dot(result->covariance.ldlt().solve(error)) / freedom / kSubjects;
    const auto thigh = static_cast<std::size_t>(index_of(*result, "thigh_r"));
    EXPECT_LT(result->parameters[thigh].sd, 0.02);
    EXPECT_TRUE(result->parameters[thigh].determined);
  }
  EXPECT_NEAR(chi_squares, 1.0, 3.0 * std::sqrt(2.0 / (freedom * kSubjects)));
  const double scatter = std::sqrt((share - share.mean()).square().sum() / (kSubjects - 1.0));
  EXPECT_NEAR(share.mean(), 0.683, 3.0 * scatter / std::sqrt(kSubjects));
  EXPECT_LT(scatter, 0.15);
}

TEST(AdaptModel, an_end_segment_is_not_determined) {
  const auto list = parameters(leg());
  const auto recording = testing_leg::record(leg(), {.noise_sd_m = 0.001});
  const auto result = adapt_model(leg(), recording, list).value();
  EXPECT_THAT(result.not_determined, Contains("foot_r"));
  const auto& foot = result.parameters[static_cast<std::size_t>(index_of(result, "foot_r"))];
  EXPECT_FALSE(foot.determined);
  EXPECT_GT(foot.interval(), 0.2);
  EXPECT_LT(foot.sd, 0.1);
}

// The angles of a shank that never moved in the thigh are noise: they may not pass for motion.
TEST(AdaptModel, a_limb_that_keeps_still_is_not_determined_and_its_interval_covers) {
  const auto list = parameters(leg());
  double squares = 0.0;
  constexpr int kSubjects = 6;
  for (int s = 0; s < kSubjects; ++s) {
    const auto seed = static_cast<std::uint64_t>(s + 1);
    const auto who = subject(list, seed);
    const auto recording = testing_leg::record(
        who.model, {.frames = 150, .noise_sd_m = 0.001, .knee_still = true, .seed = seed});
    const auto result = adapt_model(leg(), recording, list).value();
    EXPECT_TRUE(result.converged) << s;
    for (const char* name : {"shank_r", "foot_r"}) {
      const auto k = static_cast<std::size_t>(index_of(result, name));
      const auto& p = result.parameters[k];
      EXPECT_THAT(result.not_determined, Contains(name)) << s;
      EXPECT_NEAR(p.interval(), p.prior_sd, 0.1 * p.prior_sd);
      squares += std::pow((p.value - 1.0 - who.change[static_cast<Eigen::Index>(k)]) / p.sd, 2);
    }
    EXPECT_THAT(result.not_determined, Contains("tibia_r: knee_r to ankle_r"));
    EXPECT_THAT(result.not_determined, Contains("thigh_r"));  // nor where its still knee lies
  }
  EXPECT_LT(std::sqrt(squares / (2.0 * kSubjects)), 1.6);
}

/// The same recording with every sample's position changed.
template <class Change>
data::Trajectories changed(data::Trajectories recording, const Change& change) {
  for (std::int64_t f = 0; f < recording.frames(); ++f)
    for (std::int64_t m = 0; m < recording.markers(); ++m) recording.x(f, m) = change(recording.x(f, m));
  return recording;
}

void expect_same_sizes(const AdaptResult& a, const AdaptResult& b, double share_of_sd) {
  ASSERT_EQ(a.parameters.size(), b.parameters.size());
  for (std::size_t k = 0; k < a.parameters.size(); ++k) {
    EXPECT_NEAR(a.parameters[k].value, b.parameters[k].value, share_of_sd * a.parameters[k].sd)
        << a.parameters[k].name;
    EXPECT_NEAR(a.parameters[k].sd, b.parameters[k].sd, share_of_sd * a.parameters[k].sd)
        << a.parameters[k].name;
  }
}

// Twice the frames with twice the variance are the same evidence.
TEST(AdaptModel, every_frame_doubled_with_its_noise_changes_nothing) {
  const auto list = parameters(leg());
  const auto recording =
      testing_leg::record(subject(list, 3).model, {.frames = 60, .noise_sd_m = 0.001, .seed = 3});
  auto twice =
      data::Trajectories::all_missing(recording.names, {.rate_hz = 120.0, .t0_s = 0.0, .frames = 120});
  for (std::int64_t f = 0; f < 120; ++f)
    for (std::int64_t m = 0; m < twice.markers(); ++m) {
      twice.x(f, m) = recording.x(f / 2, m);
      twice.state[twice.index(f, m)] = data::SampleState::measured;
    }
  AdaptOptions options;
  options.soft_tissue = false;
  options.marker_noise_sd_m = 0.001;
  const auto once = adapt_model(leg(), recording, list, options).value();
  options.marker_noise_sd_m *= std::sqrt(2.0);
  expect_same_sizes(once, adapt_model(leg(), twice, list, options).value(), 0.02);
}

// A prior on the postures of every frame would bias the sizes by the zero of an angle.
TEST(AdaptModel, where_an_angle_has_its_zero_does_not_matter) {
  const auto list = parameters(leg());
  const auto recording =
      testing_leg::record(subject(list, 4).model, {.frames = 60, .noise_sd_m = 0.001, .amplitude = 0.2});
  auto rotated = leg();
  rotated.joints[3].parent_from_joint.rotation =
      Eigen::AngleAxisd(0.8, rotated.joints[3].axes[0].axis).toRotationMatrix() *
      rotated.joints[3].parent_from_joint.rotation;
  expect_same_sizes(adapt_model(leg(), recording, list).value(),
                    adapt_model(rotated, recording, list).value(), 0.01);
}

TEST(AdaptModel, where_the_laboratory_stands_does_not_matter) {
  const auto list = parameters(leg());
  const auto recording = testing_leg::record(subject(list, 5).model, {.frames = 60, .noise_sd_m = 0.001});
  const Eigen::Matrix3d R = Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const auto moved = changed(recording, [&](const Eigen::Vector3d& x) {
    return Eigen::Vector3d(R * x + Eigen::Vector3d(40.0, -30.0, 5.0));
  });
  expect_same_sizes(adapt_model(leg(), recording, list).value(), adapt_model(leg(), moved, list).value(),
                    0.01);
}

TEST(AdaptModel, a_factor_of_all_weights_does_not_matter) {
  const auto list = parameters(leg());
  const auto recording = testing_leg::record(subject(list, 6).model, {.frames = 60, .noise_sd_m = 0.001});
  AdaptOptions heavy;
  heavy.ik.default_marker_weight = 25.0;
  expect_same_sizes(adapt_model(leg(), recording, list).value(),
                    adapt_model(leg(), recording, list, heavy).value(), 1e-4);
}

TEST(AdaptModel, one_frame_determines_no_size) {
  const auto list = parameters(leg());
  const auto recording = testing_leg::record(leg(), {.frames = 1, .noise_sd_m = 0.001});
  const auto result = adapt_model(leg(), recording, list);
  ASSERT_TRUE(result) << result.error().message;
  for (const char* name : {"thigh_r", "shank_r", "foot_r"})
    EXPECT_THAT(result->not_determined, Contains(name));
}

TEST(AdaptModel, frames_that_nobody_saw_change_nothing) {
  const auto list = parameters(leg());
  auto recording = testing_leg::record(subject(list, 7).model, {.frames = 62, .noise_sd_m = 0.001});
  for (std::int64_t m = 0; m < recording.markers(); ++m)
    for (const std::int64_t f : {60, 61}) recording.set_missing(f, m);
  AdaptOptions shorter;
  shorter.ik.last_time_s = 59.5 / 60.0;
  const auto with = adapt_model(leg(), recording, list).value();
  const auto without = adapt_model(leg(), recording, list, shorter).value();
  EXPECT_EQ(without.frames, 60);
  expect_same_sizes(with, without, 1e-3);
}

TEST(AdaptModel, less_motion_means_wider_intervals) {
  const auto list = parameters(leg());
  const auto rich = adapt_model(leg(), testing_leg::record(leg(), {.noise_sd_m = 0.001}), list).value();
  const auto poor =
      adapt_model(leg(), testing_leg::record(leg(), {.noise_sd_m = 0.001, .amplitude = 0.2}), list).value();
  for (const char* name : {"thigh_r", "shank_r"}) {
    const auto k = static_cast<std::size_t>(index_of(rich, name));
    EXPECT_GT(poor.parameters[k].sd, 2.0 * rich.parameters[k].sd) << name;
  }
}

TEST(AdaptModel, markers_that_follow_the_posture_widen_the_intervals) {
  const auto list = parameters(leg());
  const auto recording = testing_leg::record(leg(), {.frames = 200, .noise_sd_m = 0.001, .slide_m = 0.006});
  const auto honest = adapt_model(leg(), recording, list).value();
  EXPECT_GT(honest.tissue_sd_m, 0.0005);
  AdaptOptions blind;
  blind.soft_tissue = false;
  const auto naive = adapt_model(leg(), recording, list, blind).value();
  EXPECT_EQ(naive.tissue_sd_m, 0.0);
  const auto k = static_cast<std::size_t>(index_of(honest, "thigh_r"));
  EXPECT_GT(honest.parameters[k].sd, 2.0 * naive.parameters[k].sd);
}

TEST(AdaptModel, joint_positions_alone_are_found_exactly_without_noise) {
  const std::vector<std::string> joints{"knee_r"};
  const auto list = joint_parameters(leg(), joints, 0.05).value();
  auto truth = leg();
  truth.joints[2].parent_from_joint.translation += Eigen::Vector3d(0.01, -0.02, 0.0);
  const auto result = adapt_model(leg(), testing_leg::record(truth), list).value();
  EXPECT_NEAR(result.parameters[0].value, 0.01, 1e-5);
  EXPECT_NEAR(result.parameters[1].value, -0.42, 1e-5);
  EXPECT_TRUE(result.parameters[1].determined);
  // Along its own axis a hinge may slide: the foot is free there too, but the hip is not.
  EXPECT_LT(result.rms_after_m, 1e-5);
}

TEST(AdaptModel, lengths_come_with_their_deviation) {
  const auto list = parameters(leg());
  const auto who = subject(list, 5);
  const auto recording = testing_leg::record(who.model, {.frames = 150, .noise_sd_m = 0.001});
  const auto result = adapt_model(leg(), recording, list).value();
  const auto truth = segment_lengths(who.model);
  ASSERT_EQ(result.lengths.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_EQ(result.lengths[i].name, truth[i].name);
    EXPECT_LT(std::abs(result.lengths[i].length_m - truth[i].length_m), 4.0 * result.lengths[i].sd_m)
        << truth[i].name;
    EXPECT_GT(result.lengths[i].sd_m, 0.0);
  }
}

TEST(AdaptModel, the_prior_of_a_marker_that_nobody_saw_stays) {
  const auto list = parameters(leg());
  auto recording = testing_leg::record(leg(), {.frames = 60, .noise_sd_m = 0.001});
  for (std::int64_t f = 0; f < recording.frames(); ++f) recording.set_missing(f, 4);
  const auto result = adapt_model(leg(), recording, list).value();
  const auto& marker = result.parameters[static_cast<std::size_t>(index_of(result, "THA.x"))];
  EXPECT_NEAR(marker.sd, 0.005, 1e-9);
  EXPECT_EQ(marker.value, marker.initial);
  EXPECT_FALSE(marker.determined);
}

TEST(AdaptModel, any_number_of_threads_gives_the_same_bits) {
  const auto list = parameters(leg());
  const auto recording = testing_leg::record(leg(), {.frames = 80, .noise_sd_m = 0.001});
  AdaptOptions one, four;
  one.threads = 1;
  four.threads = 4;
  EXPECT_EQ(adapt_model(leg(), recording, list, one)->covariance,
            adapt_model(leg(), recording, list, four)->covariance);
}

TEST(AdaptModel, takes_no_more_frames_than_asked) {
  const auto list = parameters(leg());
  const auto recording = testing_leg::record(leg(), {.frames = 100, .noise_sd_m = 0.001});
  AdaptOptions options;
  options.max_frames = 40;
  options.ik.last_time_s = 1.0;
  EXPECT_EQ(adapt_model(leg(), recording, list, options)->frames, 31);
}

TEST(AdaptModel, can_be_stopped) {
  const auto list = parameters(leg());
  const auto recording = testing_leg::record(leg(), {.frames = 40});
  const auto result =
      adapt_model(leg(), recording, list, {}, [](std::int64_t, std::int64_t) { return false; });
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, Code::cancelled);
}

TEST(AdaptModel, refuses_what_it_cannot_do) {
  const auto list = parameters(leg());
  const auto recording = testing_leg::record(leg(), {.frames = 20});
  const auto message = [&](const data::ModelDescription& model, const std::vector<GeometryParameter>& p,
                           const AdaptOptions& options) {
    const auto result = adapt_model(model, recording, p, options);
    return result ? std::string("it ran") : result.error().message;
  };
  EXPECT_THAT(message(leg(), {}, {}), HasSubstr("nothing to adapt"));
  auto looped = leg();
  looped.point_constraints.push_back({.name = "loop", .body_a_idx = 0, .body_b_idx = 3});
  EXPECT_THAT(message(looped, list, {}), HasSubstr("closed loops (1 point constraints)"));
  auto wrong = list;
  wrong[0].terms[0].idx = 99;
  EXPECT_THAT(message(leg(), wrong, {}), HasSubstr("that the model does not have"));
  wrong = list;
  wrong[0].prior_sd = 0.0;
  EXPECT_THAT(message(leg(), wrong, {}), HasSubstr("has a prior of 0"));
  AdaptOptions options;
  options.ik.loss = Loss::huber;
  EXPECT_THAT(message(leg(), list, options), HasSubstr("square loss"));
  options = {};
  options.max_frames = 1;
  EXPECT_THAT(message(leg(), list, options), HasSubstr("need 2 or more"));
  options = {};
  options.marker_noise_sd_m = -1.0;
  EXPECT_THAT(message(leg(), list, options), HasSubstr("marker noise of -1"));
  options = {};
  options.start_noise_sd_m = 0.0;
  EXPECT_THAT(message(leg(), list, options), HasSubstr("start noise of 0 m"));
  options = {};
  options.max_iterations = 0;
  EXPECT_THAT(message(leg(), list, options), HasSubstr("at most 0 iterations"));
  options = {};
  options.ik.coordinate_tasks = {{.coordinate = "knee_angle", .weight = 1.0, .values = {0.1, 0.2}}};
  EXPECT_THAT(message(leg(), list, options), HasSubstr("task of coordinate 'knee_angle' changes with time"));
  wrong = list;
  wrong[0].terms[0].direction.x() = std::nan("");
  EXPECT_THAT(message(leg(), wrong, {}), HasSubstr("that the model does not have"));
  options = {};
  options.ik.first_time_s = 77.0;
  EXPECT_THAT(message(leg(), list, options), HasSubstr("no frame in the time range"));
  auto nobody = leg();
  for (auto& marker : nobody.markers) marker.name += "?";
  EXPECT_THAT(message(nobody, list, {}), HasSubstr("no marker in common"));
}

}  // namespace
}  // namespace kinemark::motion
