// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/scene_parts.h"

#include <cmath>
#include <string>
#include <vector>

#include "kinemark/stages/report/internal/json_parts.h"
#include "kinemark/stages/report/internal/track_block.h"

namespace kinemark::report::internal {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kFinest_m = 2e-5, kCoarsest_m = 5e-4;
constexpr double kFinestBody_m = 2e-4;  // shapes are rough anyway
/// Of the roots of covariances: what an ellipsoid's half axis may be off.
constexpr double kFinestSd_mm = 1e-2, kCoarsestSd_mm = 2e-1;

Json vector_json(const Eigen::Vector3d& v) {
  return Json::array({number(v.x(), 6), number(v.y(), 6), number(v.z(), 6)});
}

/// Rows of F x J x `width` numbers as series, joint by joint.
std::vector<double> series_of(std::span<const double> rows, std::int64_t frames, std::int64_t width,
                              std::int64_t step) {
  std::vector<double> out;
  for (std::int64_t k = 0; k < width; ++k)
    for (std::int64_t f = 0; f < frames; f += step)
      out.push_back(rows[static_cast<std::size_t>(f * width + k)]);
  return out;
}

/// Lower triangular roots of the covariances, mm: l00 l10 l11 l20 l21 l22; NaN where there is none.
std::vector<double> roots_of(const data::Skeleton& skeleton) {
  std::vector<double> out;
  const auto joints = static_cast<std::int64_t>(skeleton.joints.size());
  for (std::int64_t f = 0; f < skeleton.frames(); ++f)
    for (std::int64_t j = 0; j < joints; ++j) {
      const Eigen::Matrix3d covariance = 1e6 * skeleton.centre_covariance(f, j);
      const Eigen::LLT<Eigen::Matrix3d> root(covariance);
      const bool known = covariance.allFinite() && root.info() == Eigen::Success;
      const Eigen::Matrix3d L = known ? Eigen::Matrix3d(root.matrixL()) : Eigen::Matrix3d::Constant(kNaN);
      out.insert(out.end(), {L(0, 0), L(1, 0), L(1, 1), L(2, 0), L(2, 1), L(2, 2)});
    }
  return out;
}

}  // namespace

Json skeleton_json(const data::Skeleton& skeleton, std::int64_t step) {
  const auto joints = static_cast<std::int64_t>(skeleton.joints.size());
  const std::int64_t frames = skeleton.frames(), points = (frames + step - 1) / step;
  Json names = Json::array(), links = Json::array();
  for (const auto& joint : skeleton.joints) names.push_back(joint.name);
  for (const auto& length : skeleton.lengths) links.push_back(Json::array({length.joint_a, length.joint_b}));
  std::vector<std::uint8_t> states;
  for (std::int64_t j = 0; j < joints; ++j)
    for (std::int64_t f = 0; f < frames; f += step)
      states.push_back(static_cast<std::uint8_t>(skeleton.state[skeleton.index(f, j)]));
  const auto roots = roots_of(skeleton);
  return {{"names", std::move(names)},
          {"links", std::move(links)},
          {"centres_m", pack_series(series_of(skeleton.centre_in_world, frames, 3 * joints, step), points,
                                    kFinest_m, kCoarsest_m)},
          {"roots_mm",
           pack_series(series_of(roots, frames, 6 * joints, step), points, kFinestSd_mm, kCoarsestSd_mm)},
          {"states", deflated(states)}};
}

Json bodies_json(const SceneBodies& bodies, std::int64_t step) {
  const auto count = std::ssize(bodies.names);
  const auto frames = std::ssize(bodies.origin_in_world) / (3 * count);
  const auto pack = [&](std::span<const double> rows) {
    return pack_series(series_of(rows, frames, 3 * count, step), (frames + step - 1) / step, kFinestBody_m,
                       kCoarsest_m);
  };
  Json masses = Json::array();
  for (const double mass : bodies.mass_kg) masses.push_back(number(mass, 4));
  return {{"names", bodies.names},
          {"mass_kg", std::move(masses)},
          {"origin_m", pack(bodies.origin_in_world)},
          {"end_m", pack(bodies.end_in_world)}};
}

Json cameras_json(std::span<const SceneCamera> cameras) {
  Json out = Json::array();
  for (const auto& camera : cameras)
    out.push_back(
        {{"name", camera.name},
         {"centre_m", vector_json(camera.centre_in_world)},
         {"right", vector_json(camera.axes_in_world.col(0))},
         {"down", vector_json(camera.axes_in_world.col(1))},
         {"forward", vector_json(camera.axes_in_world.col(2))},
         {"half_view", Json::array({number(camera.half_view.x(), 4), number(camera.half_view.y(), 4)})},
         {"nominal", camera.nominal}});
  return out;
}

}  // namespace kinemark::report::internal
