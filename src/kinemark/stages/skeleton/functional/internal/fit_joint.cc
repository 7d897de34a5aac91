// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "kinemark/stages/skeleton/functional/internal/assemble.h"
#include "kinemark/stages/skeleton/functional/score.h"
#include "kinemark/stages/skeleton/functional/skin_slide.h"
#include "kinemark/stages/skeleton/functional/sphere.h"

namespace kinemark::skeleton::internal {
namespace {

/// Rotation error of the poses by noise alone, rad per axis, in the middle frame.
double rotation_noise(const Samples& samples, const JointTask& task) {
  if (task.motion.frames.empty()) return 0.0;
  const std::int64_t f = task.motion.frames[task.motion.frames.size() / 2];
  const double variance = pose_noise(samples, task.parent, f).rotation_covariance.trace() +
                          pose_noise(samples, task.child, f).rotation_covariance.trace();
  return std::sqrt(variance / 3.0);
}

data::JointKind choose_kind(const Samples& samples, const JointTask& task, const FunctionalOptions& options) {
  if (options.method == FunctionalMethod::sara || options.method == FunctionalMethod::cylinder)
    return data::JointKind::hinge;
  if (options.kind != data::JointChoice::automatic)
    return options.kind == data::JointChoice::hinge ? data::JointKind::hinge : data::JointKind::ball;
  return task.motion.kind(rotation_noise(samples, task));
}

/// Sphere or cylinder fits, from one side or from both.
std::optional<JointFit> fit_sides(const Samples& samples, const JointTask& task,
                                  const FunctionalOptions& options, data::JointKind kind, std::string& why) {
  const SphereOptions sphere{.correct_bias = options.method != FunctionalMethod::gamage_plain,
                             .about_axis = kind == data::JointKind::hinge};
  JointFit fit;
  fit.kind = kind;
  fit.method = sphere.about_axis     ? "cylinder"
               : sphere.correct_bias ? "Gamage-Lasenby"
                                     : "Gamage-Lasenby, plain";
  const bool want_parent = options.sides != Sides::child, want_child = options.sides != Sides::parent;
  double squares = 0.0;
  const auto take = [&](const SegmentPoses& still, const SegmentPoses& moving, int side) {
    const SphereFit s = fit_spheres(samples, still, moving.markers, sphere);
    if (!s.found) return false;
    fit.centre.segment<3>(3 * side) = s.centre;
    fit.covariance.block<3, 3>(3 * side, 3 * side) = s.covariance;
    fit.repeatability.block<3, 3>(3 * side, 3 * side) = s.covariance;  // spheres see no slide
    (side == 0 ? fit.axis_in_parent : fit.axis_in_child) = s.axis;
    fit.axis_sd_rad = std::max(fit.axis_sd_rad, s.axis_sd_rad);
    fit.frames = std::max(fit.frames, s.frames);
    squares = std::max(squares, s.residual_rms_m);
    return true;
  };
  const bool parent_possible = task.parent.known_frames > 0, child_possible = task.child.known_frames > 0;
  if (want_parent && parent_possible) fit.in_parent = take(task.parent, task.child, 0);
  if (want_child && child_possible) fit.in_child = take(task.child, task.parent, 1);
  fit.residual_rms_m = squares;
  if (fit.in_parent || fit.in_child) {
    const auto placed_from = [](const SegmentPoses& used, const SegmentPoses& other) {
      return fmt::format("'{}' {}, so the joint was placed from '{}' alone", other.name,
                         other.known_frames > 0 ? "shows no centre" : "has no pose", used.name);
    };
    if (want_parent && !fit.in_parent)
      why = placed_from(task.child, task.parent);
    else if (want_child && !fit.in_child)
      why = placed_from(task.parent, task.child);
    return fit;
  }
  if ((want_parent && parent_possible) || (want_child && child_possible)) {
    why = "the markers' paths in the segments show no centre";
    return std::nullopt;
  }
  const SegmentPoses& none = want_parent ? task.parent : task.child;
  why = fmt::format(
      "no frame shows three markers of '{}' that are not on a line; without a pose of a segment "
      "these methods find no centre",
      none.name);
  return std::nullopt;
}

}  // namespace

std::optional<JointFit> fit_joint(const Samples& samples, const JointTask& task,
                                  const FunctionalOptions& options, std::string& why) {
  const data::JointKind kind = choose_kind(samples, task, options);
  const bool paired = options.method == FunctionalMethod::score || options.method == FunctionalMethod::sara;
  if (!paired) return fit_sides(samples, task, options, kind, why);
  if (task.motion.frames.size() >= 4) {
    JointFit fit = fit_score(samples, task.parent, task.child, task.motion, kind);
    widen_by_skin(samples, task.parent, task.child, task.motion, fit);
    if (options.sides == Sides::parent) fit.in_child = false;
    if (options.sides == Sides::child) fit.in_parent = false;
    return fit;
  }
  const bool solid = task.parent.known_frames > 0 && task.child.known_frames > 0;
  auto fit = fit_sides(samples, task, options, kind, why);
  if (fit && solid && why.empty())
    why = fmt::format("too few frames show both segments' poses at once; {} side was fitted alone",
                      fit->in_parent && fit->in_child ? "each" : "one");
  if (fit) why += fmt::format(" ({})", fit->method);
  return fit;
}

}  // namespace kinemark::skeleton::internal
