// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/taichi/geometry_fit.h"

#include <algorithm>
#include <string>
#include <utility>

#include "kinemark/model/model.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/motion/scaling/adapt.h"
#include "studies/taichi/landmarks.h"
#include "studies/taichi/least_squares.h"

namespace kinemark::studies {
namespace {

constexpr double kPrior_m = 0.02;

/// Joints whose positions the landmarks determine. The parts of a foot and bodies welded together are not
/// independent.
bool is_determined(const data::JointDescription& joint) {
  if (joint.parent_body_idx == data::kGround) return false;
  if (joint.name.starts_with("subtalar") || joint.name.starts_with("mtp")) return false;
  return std::ranges::any_of(joint.axes, [](const auto& axis) { return axis.coordinate_idx >= 0; });
}

}  // namespace

Result<std::vector<motion::GeometryParameter>> landmark_geometry(const data::ModelDescription& model,
                                                                 Freedom freedom) {
  std::vector<motion::GeometryParameter> out;
  if (freedom == Freedom::none) return out;
  std::vector<std::string> joints, landmarks;
  for (const auto& joint : model.joints)
    if (is_determined(joint)) joints.push_back(joint.name);
  std::vector<motion::MarkerOnJoint> tied;
  for (const auto& attachment : landmark_attachments())
    if (freedom == Freedom::centres && !attachment.joint.empty())
      tied.push_back({.marker = attachment.landmark, .joint = attachment.joint});
    else
      landmarks.push_back(attachment.landmark);
  auto of_joints = motion::joint_parameters(model, joints, kPrior_m, tied);
  if (!of_joints) return std::unexpected(of_joints.error());
  auto of_landmarks = motion::marker_parameters(model, landmarks, kPrior_m);
  if (!of_landmarks) return std::unexpected(of_landmarks.error());
  out = std::move(*of_joints);
  out.insert(out.end(), of_landmarks->begin(), of_landmarks->end());
  return out;
}

Result<GeometryFit> fit_geometry(const data::ModelDescription& model, const data::Trajectories& landmarks,
                                 Freedom freedom, std::int64_t first, std::int64_t last, int threads) {
  GeometryFit out{.model = model};
  const auto options = landmark_ik_options(model);
  motion::AdaptOptions adapting{.ik = options,
                                .marker_noise_sd_m = 0.005,
                                .soft_tissue = false,
                                .max_frames = 334,
                                .max_iterations = 25,
                                .threads = threads};
  adapting.ik.first_time_s = landmarks.time.time_s(first);
  adapting.ik.last_time_s = landmarks.time.time_s(last - 1);
  const auto adapt = [&](const data::ModelDescription& start, Freedom step) -> Result<motion::AdaptResult> {
    const auto parameters = landmark_geometry(start, step);
    if (!parameters) return std::unexpected(parameters.error());
    out.parameters = static_cast<std::int64_t>(parameters->size());
    return motion::adapt_model(start, landmarks, *parameters, adapting);
  };
  if (freedom != Freedom::none) {
    auto best = adapt(model, freedom);
    if (!best) return std::unexpected(best.error());
    if (freedom == Freedom::positions) {
      // With so many parameters there is more than one minimum: start a second time from adapted joints.
      const auto centres = adapt(model, Freedom::centres);
      if (!centres) return std::unexpected(centres.error());
      auto second = adapt(centres->model, Freedom::positions);
      if (!second) return std::unexpected(second.error());
      if (second->rms_after_m < best->rms_after_m) best = std::move(second);
    }
    out.model = std::move(best->model);
  }
  const auto compiled = model::Model::compile(out.model);
  if (!compiled) return std::unexpected(compiled.error());
  const auto ik = motion::solve_ik(*compiled, landmarks, options);
  if (!ik) return std::unexpected(ik.error());
  const auto frames = ik->motion.frames();
  out.rms_m = landmark_rms(ik->motion, 0, frames);
  out.max_m = landmark_max(ik->motion);
  out.rms_first_m = landmark_rms(ik->motion, 0, frames / 2);
  out.rms_second_m = landmark_rms(ik->motion, frames / 2, frames);
  return out;
}

}  // namespace kinemark::studies
