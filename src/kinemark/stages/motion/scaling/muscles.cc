// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/muscles.h"

#include <algorithm>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/stages/motion/scaling/internal/wrapped_path.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;

constexpr double kAtTheEnd = 1e-5;  // rad or m; so much beyond its range a conditional point still counts

Vector3d factors_of(std::span<const Vector3d> factors, int body_idx) {
  const bool known = body_idx >= 0 && at(body_idx) < factors.size();
  return known ? factors[at(body_idx)] : Vector3d(Vector3d::Ones());
}

bool counts(const data::PathPoint& point, const Eigen::VectorXd& q) {
  if (point.condition_idx < 0) return true;
  const double value = q[point.condition_idx];
  return value >= point.range_min - kAtTheEnd && value <= point.range_max + kAtTheEnd;
}

Vector3d place_in_frame(const data::PathPoint& point, const Eigen::VectorXd& q) {
  if (!point.moves) return point.x_in_frame;
  Vector3d x;
  for (int i = 0; i < 3; ++i) {
    const auto& place = point.place[at(i)];
    x[i] = place.function(place.coordinate_idx < 0 ? 0.0 : q[place.coordinate_idx]).f;
  }
  return x;
}

math::SE3 world_from_body(const model::Model& model, const model::Workspace& w, int body_idx) {
  if (body_idx < 0) return {};
  const auto body = at(model.body_of(body_idx));
  return {w.rotation[body], w.position[body]};
}

/// Each axis of a cylinder grows by the length that its unit vector gets, and its radius by the mean across.
void scale_surface(data::WrapSurface& surface, const Vector3d& f) {
  const Vector3d growth = (f.asDiagonal() * surface.frame_from_surface.rotation).colwise().norm();
  surface.body_from_frame.translation = surface.body_from_frame.translation.cwiseProduct(f);
  surface.frame_from_surface.translation = surface.frame_from_surface.translation.cwiseProduct(f);
  surface.radius *= 0.5 * (growth.x() + growth.y());
  surface.length *= growth.z();
}

bool is_left_out(const data::PathWrap& wrap) { return !wrap.surface.is_cylinder && wrap.surface.active; }

/// Lengths of all paths in the model's default pose.
Result<std::vector<double>> default_lengths(const data::ModelDescription& description,
                                            std::span<const data::MusclePath> paths) {
  const auto model = model::Model::compile(description);
  if (!model) return std::unexpected(model.error());
  model::Workspace w(*model);
  model::kinematics(*model, w, model->default_state());
  std::vector<double> lengths;
  for (const auto& path : paths) lengths.push_back(path_length(*model, w, path));
  return lengths;
}

}  // namespace

double path_length(const model::Model& model, const model::Workspace& w, const data::MusclePath& path) {
  std::vector<internal::PassedPoint> points;
  for (std::size_t i = 0; i < path.points.size(); ++i) {
    const auto& point = path.points[i];
    if (!counts(point, w.q)) continue;
    const int body = point.body_idx < 0 ? data::kGround : model.body_of(point.body_idx);
    const Vector3d x = model::point_in_world(w, body, point.body_from_frame * place_in_frame(point, w.q));
    points.push_back({static_cast<int>(i), x});
  }
  std::vector<math::SE3> surfaces;
  for (const auto& [surface, first, last] : path.wraps)
    surfaces.push_back(world_from_body(model, w, surface.body_idx) * surface.body_from_frame *
                       surface.frame_from_surface);
  return internal::wrapped_length(points, path.wraps, surfaces);
}

data::MusclePath scale_path(const data::MusclePath& path, std::span<const Vector3d> factors) {
  data::MusclePath scaled = path;
  for (auto& point : scaled.points) {
    const Vector3d f = factors_of(factors, point.body_idx);
    point.body_from_frame.translation = point.body_from_frame.translation.cwiseProduct(f);
    point.x_in_frame = point.x_in_frame.cwiseProduct(f);
    for (int i = 0; i < 3; ++i) point.place[at(i)].function = point.place[at(i)].function.scaled(f[i]);
  }
  for (auto& wrap : scaled.wraps) scale_surface(wrap.surface, factors_of(factors, wrap.surface.body_idx));
  return scaled;
}

Result<std::vector<data::PathScale>> scale_paths(const data::ModelDescription& before,
                                                 const data::ModelDescription& after,
                                                 std::span<const data::MusclePath> paths,
                                                 std::span<const Vector3d> factors) {
  std::vector<data::MusclePath> scaled;
  for (const auto& path : paths) scaled.push_back(scale_path(path, factors));
  const auto lengths = default_lengths(before, paths);
  if (!lengths) return std::unexpected(lengths.error());
  const auto new_lengths = default_lengths(after, scaled);
  if (!new_lengths) return std::unexpected(new_lengths.error());
  std::vector<data::PathScale> scales;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    const double was = (*lengths)[i], is = (*new_lengths)[i];
    scales.push_back({.name = paths[i].name,
                      .ratio = was > 0.0 ? is / was : 1.0,
                      .before_m = was,
                      .after_m = is,
                      .wraps = std::ranges::any_of(paths[i].wraps, is_left_out)});
  }
  return scales;
}

}  // namespace kinemark::motion
