// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/taichi/body_figure.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "kinemark/core/check.h"
#include "kinemark/stages/report/figures/space_drawing.h"

namespace kinemark::studies {
namespace {

using data::Trajectories;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr std::array kShares{0.12, 0.5, 0.82};          // of the recording: the postures
constexpr double kAzimuth_deg = 32.0, kApart_m = 1.15;  // where the viewer stands; postures beside each other
const std::string kBone = "#8c8c8c", kInk = "#1a1a1a", kLight = "#9ec3e6", kTrail = "#bdbdbd";

constexpr std::array<std::array<const char*, 5>, 4> kLimbs{
    {{"Neck", "RShoulder", "RElbow", "RWrist", "RHand"},
     {"Neck", "LShoulder", "LElbow", "LWrist", "LHand"},
     {"Pelvis", "RHip", "RKnee", "RAnkle", "RFoot"},
     {"Pelvis", "LHip", "LKnee", "LAnkle", "LFoot"}}};

/// Forward, left, up of x forward, y up, z right.
Vector3d upright(const Vector3d& x) { return {x.x(), -x.z(), x.y()}; }

Vector3d place(const Trajectories& body, std::int64_t frame, std::string_view landmark) {
  const auto m = body.find(landmark);
  check(m >= 0, "the body has the landmarks of the study");
  return upright(body.x(frame, m));
}

void draw_body(report::SpaceDrawing& scene, const Trajectories& body, std::int64_t frame,
               const Vector3d& shift) {
  const auto at = [&](const char* landmark) -> Vector3d { return place(body, frame, landmark) + shift; };
  const report::SpaceLine bone{.colour = kBone, .width = 4.0, .shadow = true};
  for (const auto& limb : kLimbs) {
    Matrix3Xd line(3, 5);
    for (std::size_t i = 0; i < limb.size(); ++i) line.col(static_cast<Eigen::Index>(i)) = at(limb[i]);
    scene.line(line, bone);
  }
  const Vector3d front = at("FHead"), back = at("BHead"), middle = 0.5 * (front + back),
                 along = 0.5 * (front - back), up = 1.25 * along.norm() * Vector3d::UnitZ();
  const Vector3d across = along.cross(Vector3d::UnitZ()).normalized() * 0.8 * along.norm();
  Matrix3Xd trunk(3, 4);
  trunk << at("Pelvis"), at("Thorax"), at("Neck"), middle - up;
  scene.line(trunk, bone);
  constexpr int kCorners = 32;
  for (const auto& half : {along, across}) {
    Matrix3Xd head(3, kCorners + 1);
    for (int i = 0; i <= kCorners; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kCorners;
      head.col(i) = middle + std::cos(angle) * half + std::sin(angle) * up;
    }
    scene.line(head, {.colour = kBone, .width = 1.8});
  }
}

}  // namespace

Trajectories tracked_landmarks(const Trajectories& goals, const data::JointMotion& motion,
                               std::int64_t first_frame) {
  auto out = Trajectories::all_missing(goals.names, motion.time);
  const auto count = static_cast<std::int64_t>(motion.markers.size());
  for (std::int64_t m = 0; m < goals.markers(); ++m) {
    const auto found = std::ranges::find(motion.markers, goals.names[static_cast<std::size_t>(m)]);
    if (found == motion.markers.end()) continue;
    const auto marker = found - motion.markers.begin();
    for (std::int64_t f = 0; f < motion.frames(); ++f) {
      const Eigen::Map<const Vector3d> error(motion.marker_error.data() + 3 * (f * count + marker));
      out.x(f, m) = goals.x(f + first_frame, m) - error;
      if (error.allFinite()) out.state[out.index(f, m)] = data::SampleState::model_filled;
    }
  }
  return out;
}

StudyFigure controlled_body(const TaiChiDrawing& drawing) {
  const auto body = tracked_landmarks(drawing.goals, drawing.whole.motion, drawing.whole.fit.first_frame);
  const double azimuth = kAzimuth_deg * std::numbers::pi / 180.0;
  const Vector3d right(-std::sin(azimuth), std::cos(azimuth), 0.0);
  report::SpaceDrawing scene(kAzimuth_deg, 12.0);
  std::array<std::int64_t, 3> frames{};
  double lowest = std::numeric_limits<double>::infinity();  // the feet stand on the floor
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i] = static_cast<std::int64_t>(kShares[i] * static_cast<double>(body.frames() - 1));
    for (std::int64_t m = 0; m < body.markers(); ++m)
      if (body.present(frames[i], m)) lowest = std::min(lowest, upright(body.x(frames[i], m)).z());
  }
  scene.floor(lowest);
  const auto half = static_cast<std::int64_t>(std::llround(0.5 * body.time.rate_hz));
  StudyFigure out{.paper = kDemircan,
                  .number = 1,
                  .name =
                      "the controlled body: first subset dark (right shoulder, left wrist), second light "
                      "(left elbow, right wrist)"};
  const auto subsets = paper_set().levels;
  int posture = 0;
  for (const std::int64_t frame : frames) {
    const Vector3d pelvis = place(body, frame, "Pelvis");
    const Vector3d shift = kApart_m * (posture - 1) * right - Vector3d(pelvis.x(), pelvis.y(), 0.0);
    draw_body(scene, body, frame, shift);
    for (std::size_t level = 0; level < subsets.size(); ++level)
      for (const auto& landmark : subsets[level]) {
        const auto from = std::max<std::int64_t>(0, frame - half),
                   to = std::min(body.frames() - 1, frame + half);
        Matrix3Xd trail(3, to - from + 1);
        for (std::int64_t f = from; f <= to; ++f) trail.col(f - from) = place(body, f, landmark) + shift;
        scene.line(trail, {.colour = kTrail, .width = 1.0});
        const Vector3d x = place(body, frame, landmark) + shift;
        scene.dot(kInk, x, 7.5);
        if (level == 1) scene.dot(kLight, x, 6.0);
      }
    Matrix3Xd shown(3, body.markers());
    for (std::int64_t m = 0; m < body.markers(); ++m) shown.col(m) = body.x(frame, m);
    out.curves.push_back(curve_of(fmt::format("landmarks at {:.2f} s, m", body.time.time_s(frame)), shown));
    ++posture;
  }
  report::FigurePanel panel;
  panel.height = 360.0;
  panel.picture = [scene](report::Canvas& canvas, const report::CanvasRoom& room) {
    scene.draw(canvas, room);
  };
  out.figure.panels.push_back(std::move(panel));
  out.numbers = {
      {"controlled landmarks, first subset", "1", 2.0, {}, static_cast<double>(subsets[0].size())},
      {"controlled landmarks, second subset", "1", 2.0, {}, static_cast<double>(subsets[1].size())}};
  return out;
}

}  // namespace kinemark::studies
