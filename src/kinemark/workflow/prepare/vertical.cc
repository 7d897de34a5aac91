// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/prepare/vertical.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "kinemark/core/units.h"
#include "kinemark/data/name_index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/workspace.h"
#include "kinemark/workflow/prepare/screen_axes.h"

namespace kinemark::workflow {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kLeastHeight_m = 0.8;
constexpr std::int64_t kMostFrames = 50;
constexpr std::size_t kLeastMarkers = 6, kLeastBodies = 3;

/// The nearest axis, when the direction is no farther from it than so many degrees.
std::optional<Vector3d> nearest_axis(const Vector3d& direction, double most_deg) {
  Eigen::Index axis = 0;
  const double along = direction.cwiseAbs().maxCoeff(&axis);
  if (!(along >= std::cos(kRadPerDeg * most_deg) * direction.norm()) || !(along > 0.0)) return std::nullopt;
  return Vector3d((direction[axis] < 0.0 ? -1.0 : 1.0) * Vector3d::Unit(axis));
}

Vector3d middle_of(const data::Trajectories& markers) {
  Vector3d sum = Vector3d::Zero();
  double count = 0.0;
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m)
      if (markers.present(f, m)) sum += markers.x(f, m), count += 1.0;
  return sum / count;
}

/// A marker of the model that the recording has.
struct Pair {
  Vector3d x_in_model;
  std::int64_t recorded;
};

std::vector<Pair> pairs_of(const data::Trajectories& markers, const model::Model& model, const Vector3d& up) {
  model::Workspace w(model);
  model::kinematics(model, w, model.default_state());
  const data::NameIndex index(markers.names);
  std::vector<Pair> pairs;
  std::set<int> bodies;
  double lowest = 1e300, highest = -1e300;
  for (std::size_t i = 0; i < model.description().markers.size(); ++i) {
    const auto& marker = model.description().markers[i];
    const auto recorded = index.find(marker.name);
    if (recorded < 0) continue;
    const Vector3d x = w.marker.col(static_cast<Eigen::Index>(i));
    lowest = std::min(lowest, x.dot(up)), highest = std::max(highest, x.dot(up));
    bodies.insert(marker.body_idx);
    pairs.push_back({x, recorded});
  }
  if (pairs.size() < kLeastMarkers || bodies.size() < kLeastBodies || highest - lowest < kLeastHeight_m)
    return {};
  return pairs;
}

/// The model's up in one frame of the recording (Kabsch 1976); none with too few markers in it.
std::optional<Vector3d> up_in_frame(const data::Trajectories& markers, const std::vector<Pair>& pairs,
                                    std::int64_t f, const Vector3d& up) {
  std::vector<std::pair<Vector3d, Vector3d>> seen;
  Vector3d a = Vector3d::Zero(), b = Vector3d::Zero();
  for (const auto& [x, m] : pairs) {
    if (!markers.present(f, m)) continue;
    seen.emplace_back(x, markers.x(f, m));
    a += x, b += markers.x(f, m);
  }
  if (seen.size() < kLeastMarkers) return std::nullopt;
  const auto n = static_cast<double>(seen.size());
  Matrix3d cross = Matrix3d::Zero();
  for (const auto& [x, y] : seen) cross += (y - b / n) * (x - a / n).transpose();
  const Eigen::JacobiSVD<Matrix3d> svd(cross, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d signs(1.0, 1.0, (svd.matrixU() * svd.matrixV().transpose()).determinant());
  return Vector3d(svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose() * up);
}

}  // namespace

std::optional<Vector3d> up_of(const model::Model& model) {
  const double g = model.gravity().norm();
  if (!(g > 0.0)) return std::nullopt;
  return Vector3d(-model.gravity() / g);
}

std::optional<Vertical> vertical_of_plates(const data::Trial& trial) {
  const Vector3d middle = middle_of(trial.markers);
  std::optional<Vector3d> common;
  for (const auto& plate : trial.force_plates) {
    const auto& c = plate.corners_in_world;
    const Vector3d normal = (c[2] - c[0]).cross(c[3] - c[1]);
    if (!(normal.norm() > 1e-3)) continue;  // m^2
    auto axis = nearest_axis(normal, 10.0);
    if (!axis || !middle.allFinite()) return std::nullopt;
    if ((middle - 0.25 * (c[0] + c[1] + c[2] + c[3])).dot(*axis) < 0.0) *axis = -*axis;
    if (common && *common != *axis) return std::nullopt;
    common = axis;
  }
  if (!common) return std::nullopt;
  return Vertical{*common, "the force plates"};
}

std::optional<Vertical> vertical_of_body(const data::Trajectories& markers, const model::Model& model) {
  const auto up = up_of(model);
  if (!up) return std::nullopt;
  const auto pairs = pairs_of(markers, model, *up);
  if (pairs.empty()) return std::nullopt;
  std::vector<Vector3d> ups;
  Vector3d sum = Vector3d::Zero();
  const std::int64_t step = std::max<std::int64_t>(1, markers.frames() / kMostFrames);
  for (std::int64_t f = 0; f < markers.frames(); f += step)
    if (const auto in_frame = up_in_frame(markers, pairs, f, *up)) {
      ups.push_back(*in_frame);
      sum += *in_frame;
    }
  const auto axis = nearest_axis(sum, 40.0);
  if (!axis) return std::nullopt;
  const auto near = std::ranges::count_if(
      ups, [&](const Vector3d& u) { return u.dot(*axis) >= std::cos(40.0 * kRadPerDeg); });
  if (20 * near < 19 * static_cast<std::ptrdiff_t>(ups.size())) return std::nullopt;
  return Vertical{*axis, "the body"};
}

std::optional<Vertical> vertical_of_screen(const data::Trial& trial) {
  const auto axis = screen_up(trial);
  if (!axis || axis->minCoeff() < 0.0) return std::nullopt;
  return Vertical{*axis, "POINT:Y_SCREEN of the file"};
}

std::optional<Vertical> find_vertical(const data::Trial& trial, const model::Model& model) {
  if (auto plates = vertical_of_plates(trial)) return plates;
  if (auto body = vertical_of_body(trial.markers, model)) return body;
  return vertical_of_screen(trial);
}

}  // namespace kinemark::workflow
