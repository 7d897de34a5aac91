// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/io/animation/glb.h"
#include "kinemark/io/animation/internal/glb_builder.h"
#include "kinemark/math/rotation_between.h"

namespace kinemark::io {
namespace {

using animation::GlbBuilder;
using animation::Json;
using animation::Triangle;

constexpr float kMarkerRadius_m = 0.01F;
constexpr double kBodyMoves_m = 1e-7;
constexpr double kShortestBone_m = 1e-3;
constexpr std::array<double, 3> kOfMarkers{0.85, 0.35, 0.1}, kOfBones{0.75, 0.75, 0.7};

/// Two points on the y axis and a square between them.
std::vector<Triangle> double_pyramid(float bottom, float waist, float top, float radius) {
  const Eigen::Vector3f low(0, bottom, 0), high(0, top, 0);
  const std::array<Eigen::Vector3f, 4> square{
      {{radius, waist, 0}, {0, waist, radius}, {-radius, waist, 0}, {0, waist, -radius}}};
  std::vector<Triangle> out;
  for (std::size_t i = 0; i < 4; ++i) {
    out.push_back({low, square[i], square[(i + 1) % 4]});
    out.push_back({high, square[(i + 1) % 4], square[i]});
  }
  return out;
}

std::array<float, 3> floats(const Eigen::Vector3d& x) {
  return {static_cast<float>(x.x()), static_cast<float>(x.y()), static_cast<float>(x.z())};
}

/// x y z w, as glTF has it.
std::array<float, 4> floats(const Eigen::Quaterniond& q) {
  return {static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()),
          static_cast<float>(q.w())};
}

std::vector<float> times_of(const TimeBase& time) {
  std::vector<float> out;
  for (std::int64_t f = 0; f < time.frames; ++f)
    out.push_back(static_cast<float>(static_cast<double>(f) / time.rate_hz));
  return out;
}

/// Frames in which a marker comes or goes, and the scale from there on.
struct Visibility {
  std::vector<float> times_s, scales;
};

Visibility visibility_of(const data::Trajectories& markers, std::int64_t m,
                         const std::vector<float>& times_s) {
  Visibility out;
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    if (f > 0 && markers.present(f, m) == markers.present(f - 1, m)) continue;
    out.times_s.push_back(times_s[at(f)]);
    out.scales.insert(out.scales.end(), 3, markers.present(f, m) ? 1.0F : 0.0F);
  }
  return out;
}

void add_marker(GlbBuilder& glb, const data::Trajectories& markers, std::int64_t m, int mesh,
                const std::vector<float>& times_s, int all_times) {
  std::vector<float> seen_s, positions;
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    if (!markers.present(f, m)) continue;
    seen_s.push_back(times_s[at(f)]);
    const auto x = floats(markers.x(f, m));
    positions.insert(positions.end(), x.begin(), x.end());
  }
  Json node = {{"name", markers.names[at(m)]}, {"mesh", mesh}};
  if (seen_s.empty()) {
    node["scale"] = {0.0, 0.0, 0.0};
    glb.add_node(std::move(node));
    return;
  }
  node["translation"] = std::vector<float>(positions.begin(), positions.begin() + 3);
  const int index = glb.add_node(std::move(node));
  const bool always = seen_s.size() == times_s.size();
  glb.animate(index, "translation", always ? all_times : glb.add_times(seen_s), positions);
  if (always) return;
  const Visibility visibility = visibility_of(markers, m, times_s);
  glb.animate(index, "scale", glb.add_times(visibility.times_s), visibility.scales, true);
}

/// A shape from a node's origin to a point.
void add_bone(GlbBuilder& glb, const std::string& name, const Eigen::Vector3d& to, int mesh, int node) {
  const double length = to.norm();
  if (length < kShortestBone_m) return;
  const auto turned = floats(math::rotation_between(Eigen::Vector3d::UnitY(), to).normalized());
  glb.add_node({{"name", name}, {"mesh", mesh}, {"rotation", turned}, {"scale", {length, length, length}}},
               node);
}

/// One body's node with its motion; its index.
int add_body(GlbBuilder& glb, const PoseTree& poses, std::size_t b, int parent, int times) {
  std::vector<float> rotations, translations;
  Eigen::Quaterniond before = Eigen::Quaterniond::Identity();
  for (std::int64_t f = 0; f < poses.time.frames; ++f) {
    const math::SE3 pose = poses.pose_in_parent(f, b);
    Eigen::Quaterniond q = Eigen::Quaterniond(pose.rotation).normalized();
    if (q.dot(before) < 0.0) q.coeffs() *= -1.0;  // the shorter way between two frames
    before = q;
    const auto turned = floats(q);
    const auto x = floats(pose.translation);
    rotations.insert(rotations.end(), turned.begin(), turned.end());
    translations.insert(translations.end(), x.begin(), x.end());
  }
  const int node =
      glb.add_node({{"name", poses.bodies[b].name},
                    {"translation", std::vector<float>(translations.begin(), translations.begin() + 3)},
                    {"rotation", std::vector<float>(rotations.begin(), rotations.begin() + 4)}},
                   parent);
  glb.animate(node, "rotation", times, rotations);
  if (poses.bodies[b].parent < 0 || poses.moves_in_parent(b, kBodyMoves_m))
    glb.animate(node, "translation", times, translations);
  return node;
}

}  // namespace

Status write_glb(const std::filesystem::path& path, const data::Trial& trial, bool force) {
  if (auto s = trial.validate(); !s) return fail_at(path.string(), s.error());
  const auto& markers = trial.markers;
  if (markers.markers() == 0 || markers.frames() == 0)
    return fail(Code::bad_input,
                path.string() + ": the recording holds no marker or no frame; a GLB needs one of each");
  GlbBuilder glb;
  const int mesh = glb.add_mesh(
      "marker", double_pyramid(-kMarkerRadius_m, 0.0F, kMarkerRadius_m, kMarkerRadius_m), kOfMarkers);
  const auto times_s = times_of(markers.time);
  const int times = glb.add_times(times_s);
  for (std::int64_t m = 0; m < markers.markers(); ++m) add_marker(glb, markers, m, mesh, times_s, times);
  glb.add_extra("first_frame", trial.first_frame);
  glb.add_extra("rate_hz", markers.time.rate_hz);
  glb.add_extra("t0_s", markers.time.t0_s);
  return glb.write(path, force);
}

Status write_glb(const std::filesystem::path& path, const PoseTree& poses, bool force) {
  if (auto s = poses.validate(); !s) return fail_at(path.string(), s.error());
  GlbBuilder glb;
  const int mesh = glb.add_mesh("bone", double_pyramid(0.0F, 0.15F, 1.0F, 0.07F), kOfBones);
  const int times = glb.add_times(times_of(poses.time));
  const auto children = poses.children();
  std::vector<int> nodes;
  for (std::size_t b = 0; b < poses.bodies.size(); ++b) {
    const auto& body = poses.bodies[b];
    nodes.push_back(add_body(glb, poses, b, body.parent < 0 ? -1 : nodes[at(body.parent)], times));
    for (const auto child : children[b])
      add_bone(glb, body.name + " to " + poses.bodies[child].name, poses.pose_in_parent(0, child).translation,
               mesh, nodes[b]);
    if (children[b].empty()) add_bone(glb, body.name + " end", body.end_in_body, mesh, nodes[b]);
  }
  glb.add_extra("rate_hz", poses.time.rate_hz);
  glb.add_extra("t0_s", poses.time.t0_s);
  return glb.write(path, force);
}

}  // namespace kinemark::io
