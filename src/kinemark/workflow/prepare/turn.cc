// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/turn.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string>
#include <string_view>

#include "kinemark/core/number.h"
#include "kinemark/core/units.h"
#include "kinemark/data/calibration_error.h"
#include "kinemark/data/foreign_group.h"
#include "kinemark/workflow/prepare/screen_axes.h"

namespace kinemark::workflow {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Whole numbers where the entries are meant to be: quarter turns change no digit.
Matrix3d tidy(Matrix3d R) {
  for (double& entry : R.reshaped())
    if (std::abs(entry - std::round(entry)) < 1e-12) entry = std::round(entry) + 0.0;
  return R;
}

/// Sums with zeros would turn -0 into 0 and NaN of one axis into NaN of all: a quarter turn copies instead.
Vector3d turned(const Matrix3d& R, const Vector3d& x) {
  Vector3d out = R * x;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (std::abs(R(i, k)) == 1.0) out[i] = R(i, k) * x[k];
  return out;
}

void turn_triples(Array<double>& values, const Matrix3d& R) {
  for (std::size_t i = 0; i + 3 <= values.size(); i += 3) {
    Eigen::Map<Vector3d> x(values.data() + i);
    x = turned(R, x);
  }
}

/// xx xy xz yy yz zz
void turn_covariances(Array<double>& values, const Matrix3d& R) {
  for (std::size_t i = 0; i + 6 <= values.size(); i += 6) {
    double* c = values.data() + i;
    Matrix3d C;
    C << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
    if (!C.allFinite()) continue;
    C = R * C * R.transpose();
    c[0] = C(0, 0), c[1] = C(0, 1), c[2] = C(0, 2), c[3] = C(1, 1), c[4] = C(1, 2), c[5] = C(2, 2);
  }
}

/// Outputs that are points of the laboratory; angles, forces and moments are in the axes of their segments.
void turn_modeled_markers(data::Channels& channels, const Matrix3d& to_from) {
  const auto count = static_cast<std::size_t>(channels.count());
  for (std::size_t c = 0; c < count; ++c) {
    if (channels.kinds[c] != data::ChannelKind::modeled_marker) continue;
    for (std::size_t i = 3 * c; i + 3 <= channels.values.size(); i += 3 * count) {
      Eigen::Map<Vector3d> x(channels.values.data() + i);
      x = turned(to_from, x);
    }
  }
}

/// "+Z" turned, in the letters of a C3D file; empty: it is no axis any more.
std::string turned_axis(const std::string& text, const Matrix3d& to_from) {
  const auto axis = parse_axis(trim(text));
  return axis ? letters_of_axis(to_from * *axis) : "";
}

/// Of what is carried for other programs: axes of the screen are turned, what tells where the laboratory or a
/// plate lies is left out.
void turn_foreign(data::Trial& trial, const Matrix3d& to_from) {
  constexpr std::array<std::string_view, 2> kScreen = {"X_SCREEN", "Y_SCREEN"};
  constexpr std::array<std::string_view, 6> kPoseParameters = {"LAB_ROT",     "TRANSLATION", "ROTATION",
                                                               "X_DIRECTION", "Y_DIRECTION", "Z_DIRECTION"};
  for (auto& group : trial.foreign) {
    const std::string group_name = data::foreign_name(group.name);  // files differ in the case of letters
    if (group_name != "POINT" && group_name != "FORCE_PLATFORM" && group_name != "TRIAL") continue;
    std::erase_if(group.parameters, [&](data::ForeignParameter& p) {
      const std::string name = data::foreign_name(p.name);
      if (std::ranges::find(kPoseParameters, name) != kPoseParameters.end()) {
        trial.warnings.push_back(
            fmt::format("{}:{} is not true of a turned recording and is left out", group_name, name));
        return true;
      }
      if (std::ranges::find(kScreen, name) == kScreen.end() || p.type != -1) return false;
      std::string text;
      for (const std::byte b : p.values) text += static_cast<char>(b);
      text = turned_axis(text, to_from);
      p.dims = {static_cast<std::uint8_t>(text.size())};
      p.values.clear();
      for (const char c : text) p.values.push_back(static_cast<std::byte>(c));
      return text.empty();
    });
  }
}

}  // namespace

Result<Vector3d> parse_axis(std::string_view text) {
  std::string_view name = text;
  const bool negative = name.starts_with('-');
  if (negative || name.starts_with('+')) name.remove_prefix(1);
  const int axis = name == "x" || name == "X"   ? 0
                   : name == "y" || name == "Y" ? 1
                   : name == "z" || name == "Z" ? 2
                                                : -1;
  if (axis < 0) return fail(Code::usage, fmt::format("'{}' is not x, y, z, -x, -y or -z", text));
  return Vector3d((negative ? -1.0 : 1.0) * Vector3d::Unit(axis));
}

std::string name_of_direction(const Vector3d& direction) {
  Eigen::Index axis = 0;
  const double along = direction.cwiseAbs().maxCoeff(&axis);
  if (along >= std::cos(10.0 * kRadPerDeg) * direction.norm() && along > 0.0)
    return (direction[axis] < 0.0 ? "-" : "") + std::string(1, "xyz"[axis]);
  return fmt::format("({:.2f}, {:.2f}, {:.2f})", direction.x(), direction.y(), direction.z());
}

Result<Matrix3d> parse_rotation(std::string_view text) {
  std::istringstream words{std::string(text)};
  Matrix3d R = Matrix3d::Identity();
  std::string axis_word, angle_word;
  bool any = false;
  while (words >> axis_word) {
    const auto axis = parse_axis(axis_word);
    const auto degrees = words >> angle_word ? parse_number(angle_word) : std::nullopt;
    if (!axis || !degrees || !std::isfinite(*degrees) || std::abs(*degrees) > 360.0)
      return fail(
          Code::usage,
          fmt::format("'{}' is not a rotation such as \"x -90\": axis and degrees, -360 to 360", text));
    R = tidy(Eigen::AngleAxisd(kRadPerDeg * *degrees, *axis).toRotationMatrix()) * R;
    any = true;
  }
  if (!any) return fail(Code::usage, "an empty rotation; need axis and degrees, such as \"x -90\"");
  return R;
}

Matrix3d rotation_between(const Vector3d& from, const Vector3d& to) {
  const Vector3d axis = from.cross(to);
  if (axis.norm() > 1e-12)
    return tidy(
        Eigen::AngleAxisd(std::atan2(axis.norm(), from.dot(to)), axis.normalized()).toRotationMatrix());
  if (from.dot(to) > 0.0) return Matrix3d::Identity();
  const Vector3d across = std::abs(from.x()) < 0.9 ? Vector3d::UnitX() : Vector3d::UnitY();
  const Vector3d half = (across - from * from.dot(across)).normalized();
  return tidy(2.0 * half * half.transpose() - Matrix3d::Identity());
}

void turn(data::Trial& trial, const Matrix3d& to_from) {
  if (to_from.isIdentity(0.0)) return;
  turn_triples(trial.markers.x_in_world, to_from);
  turn_triples(trial.markers.unfiltered_in_world, to_from);
  turn_covariances(trial.markers.covariance, to_from);
  trial.calibration_error = data::turned(trial.calibration_error, to_from);
  turn_modeled_markers(trial.channels, to_from);
  turn_foreign(trial, to_from);
  if (std::ranges::any_of(trial.channels.kinds, [](data::ChannelKind kind) {
        return kind == data::ChannelKind::force || kind == data::ChannelKind::moment;
      }))
    trial.warnings.emplace_back("forces and moments among the outputs of a model keep their axes");
  for (auto& plate : trial.force_plates)
    for (auto& corner : plate.corners_in_world) corner = turned(to_from, corner);
}

void turn(data::Wrenches& wrenches, const Matrix3d& to_from) {
  if (to_from.isIdentity(0.0)) return;
  for (auto& wrench : wrenches.items) {
    for (auto* values : {&wrench.force, &wrench.moment, &wrench.point}) turn_triples(*values, to_from);
    for (auto& corner : wrench.corners_in_world) corner = turned(to_from, corner);
  }
}

}  // namespace kinemark::workflow
