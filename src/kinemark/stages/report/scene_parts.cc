// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/internal/scene_parts.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"
#include "kinemark/stages/report/internal/json_parts.h"
#include "kinemark/stages/report/internal/track_block.h"

namespace kinemark::report::internal {
namespace {

using Json = nlohmann::ordered_json;
constexpr double kFinest_m = 2e-5, kCoarsest_m = 5e-4;
constexpr double kFinestBody_m = 2e-4;  // shapes are rough anyway
constexpr double kFinestTurn = 5e-4;    // of a quaternion: 0.2 mm at 0.4 m
constexpr double kFinestMesh_m = 1e-4;
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

/// Quaternions of the bodies that have a mesh, each on the side of the one before it, so that they move
/// little.
std::vector<double> turns_of(const SceneBodies& bodies, std::span<const std::size_t> drawn,
                             std::int64_t step) {
  const std::size_t count = bodies.names.size();
  const std::size_t frames = bodies.world_from_body.size() / (4 * count);
  std::vector<double> out(drawn.size() * 4 *
                          ((frames + static_cast<std::size_t>(step) - 1) / static_cast<std::size_t>(step)));
  const std::size_t points = out.size() / (4 * drawn.size());
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    Eigen::Vector4d before = Eigen::Vector4d::UnitX();
    for (std::size_t p = 0; p < points; ++p) {
      const std::size_t frame = p * static_cast<std::size_t>(step);
      Eigen::Vector4d turn =
          Eigen::Map<const Eigen::Vector4d>(bodies.world_from_body.data() + 4 * (frame * count + drawn[i]));
      if (turn.dot(before) < 0.0) turn = -turn;
      before = turn;
      for (Eigen::Index k = 0; k < 4; ++k) out[(4 * i + static_cast<std::size_t>(k)) * points + p] = turn[k];
    }
  }
  return out;
}

/// Corners of all triangles, body after body: each less the one before it, lower bytes of all, then upper
/// ones.
std::string corners_of(const SceneBodies& bodies, std::span<const std::size_t> drawn) {
  std::vector<std::uint16_t> words;
  for (const std::size_t body : drawn)
    for (const auto& triangle : bodies.meshes[body].triangles)
      for (const auto corner : triangle) words.push_back(static_cast<std::uint16_t>(corner));
  std::vector<std::uint8_t> bytes(2 * words.size());
  std::uint16_t before = 0;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const auto change = static_cast<std::uint16_t>(words[i] - before);
    before = words[i];
    bytes[i] = static_cast<std::uint8_t>(change);
    bytes[words.size() + i] = static_cast<std::uint8_t>(change >> 8U);
  }
  return deflated(bytes);
}

Json meshes_json(const SceneBodies& bodies, std::int64_t step) {
  std::vector<std::size_t> drawn;
  Json points = Json::array(), triangles = Json::array();
  std::int64_t total = 0;
  for (std::size_t b = 0; b < bodies.meshes.size(); ++b) {
    const auto& mesh = bodies.meshes[b];
    if (mesh.empty()) continue;
    check(mesh.points.size() <= 65'535, "a mesh of a page has at most 65,535 points");
    drawn.push_back(b);
    points.push_back(mesh.points.size());
    triangles.push_back(mesh.triangles.size());
    total += std::ssize(mesh.points);
  }
  std::vector<double> positions;
  for (Eigen::Index k = 0; k < 3; ++k)
    for (const std::size_t body : drawn)
      for (const auto& x : bodies.meshes[body].points) positions.push_back(x[k]);
  const auto turns = turns_of(bodies, drawn, step);
  return {
      {"body", drawn},
      {"points", std::move(points)},
      {"triangles", std::move(triangles)},
      {"positions_m", pack_series(positions, total, kFinestMesh_m, kCoarsest_m)},
      {"corners", corners_of(bodies, drawn)},
      {"turn", pack_series(turns, std::ssize(turns) / (4 * std::ssize(drawn)), kFinestTurn, kFinestTurn)}};
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
  // Who has a mesh needs no end.
  auto ends = bodies.end_in_world;
  for (std::size_t i = 0; i < ends.size() && !bodies.meshes.empty(); ++i)
    if (!bodies.meshes[i / 3 % bodies.names.size()].empty()) ends[i] = kNaN;
  Json out = {{"names", bodies.names},
              {"mass_kg", std::move(masses)},
              {"origin_m", pack(bodies.origin_in_world)},
              {"end_m", pack(ends)}};
  if (!bodies.meshes_note.empty()) out["meshes_note"] = bodies.meshes_note;
  if (std::ranges::any_of(bodies.meshes, [](const auto& mesh) { return !mesh.empty(); }))
    out["meshes"] = meshes_json(bodies, step);
  return out;
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
