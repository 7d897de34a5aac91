// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/axes.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/units.h"
#include "kinemark/workflow/prepare/turn.h"
#include "kinemark/workflow/prepare/vertical.h"

namespace kinemark::workflow {
namespace {

using Eigen::Vector3d;

constexpr double kMostOff_deg = 45.0;
constexpr double kLeastForce_n = 10.0;  // mean over all frames

double degrees_between(const Vector3d& a, const Vector3d& b) {
  return kDegPerRad * std::acos(std::clamp(a.dot(b), -1.0, 1.0));
}

Axes with_up(const Vector3d& up_in_recording, const Vector3d& up) {
  return {.model_from_recording = rotation_between(up_in_recording, up),
          .chosen = true,
          .note = up_in_recording.isApprox(up)
                      ? ""
                      : fmt::format("the recording was turned: {} is up in it, {} in the model",
                                    name_of_direction(up_in_recording), name_of_direction(up))};
}

}  // namespace

Status AxesChoice::check() const {
  if (!up.empty() && !rotate.empty())
    return fail(Code::usage, "--up and --rotate both turn the recording; give one of them");
  if (!up.empty() && up != "auto")
    if (const auto axis = parse_axis(up); !axis)
      return fail(Code::usage, fmt::format("--up: {}, or auto", axis.error().message));
  if (!rotate.empty())
    if (const auto turning = parse_rotation(rotate); !turning)
      return fail(Code::usage, fmt::format("--rotate: {}", turning.error().message));
  return {};
}

Result<Axes> settle_axes(const AxesChoice& choice, const std::filesystem::path& path,
                         const data::Trial& trial, const model::Model& model) {
  if (auto s = choice.check(); !s) return std::unexpected(s.error());
  if (!choice.rotate.empty())
    return Axes{.model_from_recording = parse_rotation(choice.rotate).value(),
                .chosen = true,
                .note = fmt::format("the recording was turned: {}", choice.rotate)};
  const auto against_gravity = up_of(model);
  if (!against_gravity) {
    if (choice.up.empty()) return Axes{};
    return fail(Code::bad_input, "the model has no gravity, and so no vertical for --up; give --rotate");
  }
  const Vector3d& up = *against_gravity;
  if (!choice.up.empty() && choice.up != "auto") return with_up(parse_axis(choice.up).value(), up);
  const auto found = find_vertical(trial, model);
  if (choice.up == "auto") {
    if (!found)
      return fail(
          Code::bad_input,
          fmt::format("{}: neither force plates nor body nor file tell which way is up; give --up x, y, "
                      "z, -x, -y or -z",
                      path.string()));
    return with_up(found->up, up);
  }
  if (!found || degrees_between(found->up, up) < kMostOff_deg) return Axes{};
  return fail(
      Code::bad_input,
      fmt::format("{}: {} is up in the recording by {}, and {} in the model; give --up {} to turn the "
                  "recording, or --up {} to take it as it is",
                  path.string(), name_of_direction(found->up), found->from, name_of_direction(up),
                  name_of_direction(found->up), name_of_direction(up)));
}

Result<Axes> bring_into_axes(const AxesChoice& choice, const std::filesystem::path& path, data::Trial& trial,
                             const model::Model& model) {
  auto axes = settle_axes(choice, path, trial, model);
  if (!axes) return axes;
  turn(trial, axes->model_from_recording);
  if (!axes->note.empty()) trial.warnings.push_back(axes->note);
  return axes;
}

Result<std::string> check_forces(const data::Wrenches& wrenches, const Axes& axes,
                                 const model::Model& model) {
  Vector3d sum = Vector3d::Zero();
  for (const auto& wrench : wrenches.items)
    for (std::size_t i = 0; i + 3 <= wrench.force.size(); i += 3) {
      const Eigen::Map<const Vector3d> force(wrench.force.data() + i);
      if (force.allFinite() && Eigen::Map<const Vector3d>(wrench.moment.data() + i).allFinite()) sum += force;
    }
  const auto up = up_of(model);
  if (!(sum.norm() > kLeastForce_n * static_cast<double>(wrenches.frames())) || !up) return "";
  const Vector3d mean = sum.normalized();
  const double off_deg = degrees_between(mean, *up);
  if (off_deg <= kMostOff_deg) return "";
  std::string off =
      fmt::format("the forces push along {} on average, {:.0f} deg off {}, which is up in the model",
                  name_of_direction(mean), off_deg, name_of_direction(*up));
  if (axes.chosen) return off;
  return fail(Code::bad_input,
              fmt::format("{}; give --up {} when the markers have the axes of the forces, else turn the file "
                          "of the forces ('kinemark convert --rotate'), or --up {} to take all as it is",
                          off, name_of_direction(mean), name_of_direction(*up)));
}

}  // namespace kinemark::workflow
