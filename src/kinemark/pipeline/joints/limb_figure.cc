// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/joints/limb_figure.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <limits>

#include "kinemark/core/index.h"
#include "kinemark/stages/report/figures/space_drawing.h"

namespace kinemark::pipeline {
namespace {

using data::CentreState;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

constexpr std::array<const char*, 6> kColours{"#d2691e", "#7b3fa0", "#1f5fa8",
                                              "#2e8b57", "#b8860b", "#c0392b"};
constexpr int kEnough = 3;       ///< markers of a segment
constexpr double kBelow = 0.08;  ///< the floor, below the lowest point, of the figure's height

Vector3d end_at(const data::SkeletonEnd& end, std::int64_t f) {
  return Eigen::Map<const Vector3d>(end.centre_in_world.data() + 3 * f);
}

bool all_placed(const data::Skeleton& skeleton, std::int64_t f) {
  for (std::int64_t j = 0; j < std::ssize(skeleton.joints); ++j)
    if (skeleton.state[skeleton.index(f, j)] == CentreState::undetermined) return false;
  return std::ranges::all_of(skeleton.ends,
                             [&](const auto& end) { return end.state[at(f)] != CentreState::undetermined; });
}

/// Markers that the segment with the fewest shows.
int least_shown(const data::Trajectories& markers, const data::Skeleton& skeleton, std::int64_t f) {
  auto least = std::numeric_limits<std::ptrdiff_t>::max();
  for (const auto& segment : skeleton.segments)
    least =
        std::min(least, std::ranges::count_if(segment.markers, [&](int m) { return markers.present(f, m); }));
  return static_cast<int>(least);
}

/// All joints and ends of a frame behind each other.
Eigen::VectorXd posture(const data::Skeleton& skeleton, std::int64_t f) {
  const auto J = std::ssize(skeleton.joints), E = std::ssize(skeleton.ends);
  Eigen::VectorXd out(3 * (J + E));
  for (std::ptrdiff_t j = 0; j < J; ++j) out.segment<3>(3 * j) = skeleton.centre(f, j);
  for (std::ptrdiff_t e = 0; e < E; ++e) out.segment<3>(3 * (J + e)) = end_at(skeleton.ends[at(e)], f);
  return out;
}

/// How far the markers reach along the line from a joint through their mean.
Vector3d reach_of(const data::Trajectories& markers, const data::SkeletonSegment& segment,
                  const Vector3d& from, std::int64_t f) {
  Vector3d mean = Vector3d::Zero();
  double n = 0.0, far = 0.0;
  for (const int m : segment.markers)
    if (markers.present(f, m)) mean += markers.x(f, m), n += 1.0;
  if (n == 0.0) return from;
  const Vector3d along = (mean / n - from).stableNormalized();
  for (const int m : segment.markers)
    if (markers.present(f, m)) far = std::max(far, along.dot(markers.x(f, m) - from));
  return from + far * along;
}

/// The line of one segment: where it stays, its joints from the upper one on, its end.
Matrix3Xd bone_of(const data::Trajectories& markers, const data::Skeleton& skeleton, int segment,
                  std::int64_t f) {
  std::vector<Vector3d> points;
  bool ends = false;
  for (const auto& end : skeleton.ends)
    if (end.stays() && end.segment == segment) points.push_back(end_at(end, f));
  for (const bool upper : {true, false})
    for (std::int64_t j = 0; j < std::ssize(skeleton.joints); ++j) {
      const auto& joint = skeleton.joints[at(j)];
      if ((upper ? joint.child_segment : joint.parent_segment) == segment)
        points.emplace_back(skeleton.centre(f, j));
    }
  for (const auto& end : skeleton.ends)
    if (!end.stays() && end.segment == segment) {
      points.push_back(end_at(end, f));
      ends = true;
    }
  if (points.size() == 1 && !ends)
    points.push_back(reach_of(markers, skeleton.segments[at(segment)], points.front(), f));
  Matrix3Xd out(3, std::ssize(points));
  for (std::size_t i = 0; i < points.size(); ++i) out.col(static_cast<Eigen::Index>(i)) = points[i];
  return out;
}

}  // namespace

std::vector<std::int64_t> choose_poses(const data::Trajectories& markers, const data::Skeleton& skeleton,
                                       int poses) {
  std::vector<std::int64_t> frames;
  int most = 0;
  for (std::int64_t f = 0; f < skeleton.frames(); ++f) {
    if (!all_placed(skeleton, f)) continue;
    const int shown = std::min(least_shown(markers, skeleton, f), kEnough);
    if (shown > most) frames.clear();
    most = std::max(most, shown);
    if (shown == most) frames.push_back(f);
  }
  if (frames.empty()) return frames;
  // The posture farthest from the first frame's, then always the one farthest from all that are chosen.
  std::vector<double> distance(frames.size(), std::numeric_limits<double>::infinity());
  std::vector<std::int64_t> chosen;
  std::int64_t last = frames.front();
  for (int i = 0; i <= poses; ++i) {
    const Eigen::VectorXd of_last = posture(skeleton, last);
    std::size_t far = 0;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      const double d = (posture(skeleton, frames[k]) - of_last).norm();
      distance[k] = i == 1 ? d : std::min(distance[k], d);
      if (distance[k] > distance[far]) far = k;
    }
    if (i == poses || !(distance[far] > 0.0)) break;
    last = frames[far];
    chosen.push_back(last);
  }
  if (chosen.empty()) chosen.push_back(last);
  std::ranges::sort(chosen);
  return chosen;
}

LimbPicture limb_picture(const data::Trajectories& markers, const data::Skeleton& skeleton,
                         const Vector3d& up, int poses) {
  const Eigen::Matrix3d upright =
      Eigen::Quaterniond::FromTwoVectors(up, Vector3d::UnitZ()).toRotationMatrix();
  const auto frames = choose_poses(markers, skeleton, poses);
  report::SpaceDrawing scene(40.0, 18.0);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  const auto note = [&](const Matrix3Xd& x) {
    low = std::min(low, x.row(2).minCoeff());
    high = std::max(high, x.row(2).maxCoeff());
  };
  for (const auto f : frames)
    for (int s = 0; s < static_cast<int>(skeleton.segments.size()); ++s)
      if (const Matrix3Xd bone = upright * bone_of(markers, skeleton, s, f); bone.cols() > 0) note(bone);
  if (!frames.empty()) scene.floor(low - kBelow * std::max(high - low, 0.05));
  for (const auto f : frames) {
    for (int s = 0; s < static_cast<int>(skeleton.segments.size()); ++s)
      if (const Matrix3Xd bone = upright * bone_of(markers, skeleton, s, f); bone.cols() > 1)
        scene.line(bone, {.colour = "#000000", .width = 5.0, .shadow = true});
    for (std::size_t s = 0; s < skeleton.segments.size(); ++s)
      for (const int m : skeleton.segments[s].markers)
        if (markers.present(f, m)) scene.dot(kColours[s % kColours.size()], upright * markers.x(f, m), 4.0);
  }
  if (!frames.empty()) {
    const auto f = frames.front();
    for (std::int64_t j = 0; j < std::ssize(skeleton.joints); ++j)
      scene.label(skeleton.joints[at(j)].name, upright * skeleton.centre(f, j));
    for (const auto& end : skeleton.ends) scene.label(end.name, upright * end_at(end, f));
  }
  std::string numbers;
  for (const auto f : frames)
    numbers += fmt::format("{}{}", numbers.empty() ? "" : ", ", skeleton.time.number(f));
  report::FigurePanel panel;
  panel.height = 440.0;
  panel.picture = [scene](report::Canvas& canvas, const report::CanvasRoom& room) {
    scene.draw(canvas, room);
  };
  LimbPicture out{.figure = {.title = "The limb from its markers",
                             .caption = fmt::format("Frames {}. Squares of the floor: {:.0f} mm.", numbers,
                                                    1e3 * scene.square()),
                             .panels = {},
                             .keys = {},
                             .notes = {}},
                  .frames = frames};
  out.figure.panels.push_back(std::move(panel));
  return out;
}

std::string limb_figure(const data::Trajectories& markers, const data::Skeleton& skeleton, const Vector3d& up,
                        int poses) {
  return report::figure_svg(limb_picture(markers, skeleton, up, poses).figure);
}

}  // namespace kinemark::pipeline
