// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/taichi/taichi_figures.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/units.h"
#include "studies/taichi/body_figure.h"

namespace kinemark::studies {
namespace {

using Eigen::VectorXd;
using report::FigurePanel;

constexpr const char* kGoal = "#b8b8b8";
constexpr const char* kWhole = "#0072b2";
constexpr const char* kFour = "#d55e00";
constexpr std::array<const char*, 3> kInks{"#0072b2", "#d55e00", "#009e73"};

VectorXd times(const TimeBase& time) {
  return VectorXd::LinSpaced(time.frames, time.time_s(0), time.time_s(time.frames - 1));
}

/// One coordinate in degrees, on the branch nearest to zero at the first frame and continuous from there on.
VectorXd angle_deg(const data::JointMotion& motion, std::string_view coordinate) {
  const auto c = motion.find(coordinate);
  check(c >= 0, "the figures draw coordinates of the human model");
  VectorXd out(motion.frames());
  double last = 0.0;
  for (std::int64_t f = 0; f < motion.frames(); ++f) {
    last += std::remainder(motion.q[motion.index(f, c)] - last, 2.0 * std::numbers::pi);
    out[f] = last * kDegPerRad;
  }
  return out;
}

struct Angle {
  const char* coordinate;  // without its side
  const char* name;
};

/// One joint of one arm: its angles by control of the whole body, dashed by that of the paper's four
/// landmarks.
FigurePanel joint_of(StudyFigure& out, const TaiChiDrawing& drawing, const char* joint,
                     const std::vector<Angle>& angles, char side, bool last) {
  FigurePanel panel{.title = fmt::format("{} {}", side == 'r' ? "Right" : "Left", joint),
                    .x_label = last ? "time, s" : "",
                    .y_label = "angle, deg",
                    .tight = true,
                    .zero = true};
  std::size_t ink = 0;
  for (const auto& angle : angles) {
    const auto coordinate = fmt::format("{}_{}", angle.coordinate, side);
    const auto add = [&](const motion::TrackResult& track, bool dashed) {
      const VectorXd time = times(track.motion.time), deg = angle_deg(track.motion, coordinate);
      panel.lines.push_back({.name = dashed ? "" : angle.name,
                             .colour = kInks[ink],
                             .x = time,
                             .y = deg,
                             .width = dashed ? 0.9 : 1.7,
                             .dashed = dashed});
      out.curves.push_back(
          curve_of(coordinate + (dashed ? ", four landmarks" : ", all landmarks"), {time, deg}));
    };
    if (std::ranges::find(drawing.paper.locked_coordinates, coordinate) ==
        drawing.paper.locked_coordinates.end())
      add(drawing.paper, true);
    add(drawing.whole, false);
    ++ink;
  }
  return panel;
}

/// Share of frames in which a coordinate is determined, in per cent.
double determined_share(const data::JointMotion& motion, std::string_view coordinate) {
  if (motion.determined.empty()) return kNaN;
  double sum = 0.0;
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    sum += motion.determined[motion.index(f, motion.find(coordinate))];
  return 100.0 * sum / static_cast<double>(motion.frames());
}

/// Figure 2: angles of both arms.
StudyFigure joint_angles(const TaiChiDrawing& drawing) {
  StudyFigure out{.paper = kDemircan, .number = 2, .name = "joint angles of the right and the left arm"};
  for (const auto& [joint, angles] :
       {std::pair<const char*, std::vector<Angle>>{
            "shoulder", {{"arm_flex", "flexion"}, {"arm_add", "adduction"}, {"arm_rot", "rotation"}}},
        {"elbow", {{"elbow_flex", "flexion"}}},
        {"wrist", {{"wrist_flex", "flexion"}, {"wrist_dev", "deviation"}}}})
    for (const char side : {'r', 'l'})
      out.figure.panels.push_back(joint_of(out, drawing, joint, angles, side, joint[0] == 'w'));
  out.figure.columns = 2;
  out.figure.panel_height = 112.0;
  out.figure.keys = {
      {.name = "all 21 landmarks", .colour = "#444444"},
      {.name = "the paper's four landmarks", .colour = "#444444", .dashed = true, .width = 1.0}};
  out.figure.notes = {
      fmt::format("Flexion of the right elbow is determined in {:.0f} % of the frames by all landmarks, in "
                  "{:.0f} % by the four.",
                  determined_share(drawing.whole.motion, "elbow_flex_r"),
                  determined_share(drawing.paper.motion, "elbow_flex_r"))};
  return out;
}

/// Figure 3: the four landmarks along all three axes, goal and tracked.
StudyFigure goals_followed(const TaiChiDrawing& drawing, const StudyTable& table) {
  constexpr std::array<const char*, 3> kAxis{"forward", "up", "right"};
  StudyFigure out{.paper = kDemircan, .number = 3, .name = "the four landmarks, tracked beside their goals"};
  const auto four = tracked_landmarks(drawing.goals, drawing.paper.motion, drawing.paper.fit.first_frame);
  const VectorXd goal_time = times(drawing.goals.time), time = times(four.time);
  const auto along = [](const data::Trajectories& path, std::int64_t m, int axis) {
    VectorXd x(path.frames());
    for (std::int64_t f = 0; f < path.frames(); ++f) x[f] = path.present(f, m) ? path.x(f, m)[axis] : kNaN;
    return x;
  };
  for (const auto& level : paper_set().levels)
    for (const auto& landmark : level)
      for (int axis = 0; axis < 3; ++axis) {
        const auto* name = kAxis[static_cast<std::size_t>(axis)];
        FigurePanel panel{.title = fmt::format("{}, {}", landmark, name),
                          .x_label = landmark == paper_set().levels.back().back() ? "time, s" : "",
                          .y_label = "m",
                          .tight = true};
        const VectorXd goal = along(drawing.goals, drawing.goals.find(landmark), axis),
                       tracked = along(four, four.find(landmark), axis);
        panel.lines.push_back({.colour = kGoal, .x = goal_time, .y = goal, .width = 4.5});
        panel.lines.push_back({.colour = "#000000", .x = time, .y = tracked, .width = 1.2});
        out.figure.panels.push_back(std::move(panel));
        out.curves.push_back(curve_of(fmt::format("{} {}, goal", landmark, name), {goal_time, goal}));
        out.curves.push_back(curve_of(fmt::format("{} {}, tracked", landmark, name), {time, tracked}));
      }
  out.figure.columns = 3;
  out.figure.panel_height = 80.0;
  out.figure.keys = {{.name = "goal", .colour = kGoal, .width = 4.5},
                     {.name = "tracked", .colour = "#000000", .width = 1.4}};
  out.numbers = numbers_of(table, {"the paper's four landmarks, 1 ms: landmarks to goals, RMS",
                                   "the paper's four landmarks, 1 ms: landmarks to goals, largest"});
  return out;
}

/// Largest and smallest of a frame's joint errors, deg; NaN where no joint is determined.
struct JointErrors {
  VectorXd largest, smallest;
};

/// Equation 17: the largest and the smallest over the joints of each frame of what equation 16 allows their
/// angles. The root is no joint.
JointErrors joint_errors(const motion::TrackResult& track) {
  const auto& motion = track.motion;
  JointErrors out{VectorXd::Constant(motion.frames(), kNaN), VectorXd::Constant(motion.frames(), kNaN)};
  for (std::int64_t f = 0; f < motion.frames() && !track.goal_bound.empty(); ++f)
    for (std::int64_t c = 0; c < motion.size(); ++c) {
      const auto& name = motion.coordinates[static_cast<std::size_t>(c)];
      const double error = track.goal_bound[motion.index(f, c)] * kDegPerRad;
      // 0 where it is locked or held at a limit: no joint that errs; NaN where it is not determined.
      if (name.starts_with("pelvis_") || !(error > 0.0)) continue;
      if (!(out.largest[f] >= error)) out.largest[f] = error;
      if (!(out.smallest[f] <= error)) out.smallest[f] = error;
    }
  return out;
}

/// Figure 4: margins of the landmarks' errors, and the largest and smallest joint error.
StudyFigure margins(const TaiChiDrawing& drawing, const StudyTable& table) {
  StudyFigure out{
      .paper = kDemircan,
      .number = 4,
      .name = "margins of the landmarks' errors, and largest and smallest joint error (equation 17)"};
  constexpr std::array<const char*, 4> kFourInks{"#000000", "#0072b2", "#d55e00", "#009e73"};
  const std::array<std::pair<const motion::TrackResult*, const char*>, 2> runs{
      {{&drawing.paper, "the four landmarks"}, {&drawing.whole, "all 21 landmarks"}}};
  for (const auto& [track, set] : runs) {
    FigurePanel panel{
        .title = fmt::format("Landmark to goal, {}", set), .y_label = "error, mm", .tight = true};
    const VectorXd time = times(track->motion.time);
    const auto count = static_cast<std::int64_t>(track->motion.markers.size());
    std::size_t ink = 0;
    for (const auto& landmark : paper_set().all()) {
      const auto m = std::ranges::find(track->motion.markers, landmark) - track->motion.markers.begin();
      VectorXd mm(time.size());
      for (std::int64_t f = 0; f < track->motion.frames(); ++f)
        mm[f] =
            1e3 *
            Eigen::Map<const Eigen::Vector3d>(track->motion.marker_error.data() + 3 * (f * count + m)).norm();
      panel.lines.push_back(
          {.name = track == &drawing.paper ? landmark : "", .colour = kFourInks[ink++], .x = time, .y = mm});
      out.curves.push_back(curve_of(fmt::format("{}, {}, mm", landmark, set), {time, mm}));
    }
    out.figure.panels.push_back(std::move(panel));
  }
  for (const auto& [track, set] : runs) {
    const VectorXd time = times(track->motion.time);
    const auto errors = joint_errors(*track);
    FigurePanel panel{.title = fmt::format("Bound of joint error, {}", set),
                      .x_label = "time, s",
                      .y_label = "error, deg",
                      .tight = true,
                      .logarithmic = true};
    panel.lines.push_back({.name = "largest", .colour = kFour, .x = time, .y = errors.largest});
    panel.lines.push_back({.name = "smallest", .colour = kWhole, .x = time, .y = errors.smallest});
    out.figure.panels.push_back(std::move(panel));
    out.curves.push_back(curve_of(fmt::format("largest joint error, {}, deg", set), {time, errors.largest}));
    out.curves.push_back(
        curve_of(fmt::format("smallest joint error, {}, deg", set), {time, errors.smallest}));
  }
  out.figure.columns = 2;
  out.figure.panel_height = 150.0;
  out.numbers = numbers_of(table, {"the paper's four landmarks, 1 ms: landmarks to goals, RMS",
                                   "whole body, 1 ms: landmarks to goals, RMS"});
  return out;
}

}  // namespace

StudyPage taichi_page(const TaiChiStudy& study) {
  check(!study.subjects.empty() && study.subjects.front().drawing.has_value(),
        "the page shows the first subject");
  const auto& subject = study.subjects.front();
  const auto& drawing = *subject.drawing;
  const auto& paper = subject.paper.recorded_fine;
  return {
      .title = "Study: Demircan, Sentis, De Sapio and Khatib 2008",
      .heading = "Tai chi by direct marker control",
      .description = fmt::format(
          "{}. The paper's four landmarks fix {} of the {} directions that they can move and determine {} of "
          "{} joint "
          "angles: they are tracked well by any arm that reaches them, so good tracking proves nothing about "
          "the "
          "other angles. As recorded, left elbow and left wrist are {:.0f} to {:.0f} mm apart; a rigid "
          "forearm "
          "cannot follow both, and the lower level is left {:.1f} mm (RMS over the four). All 21 landmarks "
          "determine {} of {}.",
          study.recorded ? "The recording, 21 landmarks at 60 Hz"
                         : fmt::format("Simulated subjects; figures: seed {}", subject.seed),
          paper.rank_max, paper.free_speeds, paper.determined, paper.coordinates, 1e3 * subject.forearm_min_m,
          1e3 * subject.forearm_max_m, 1e3 * paper.control_rms_m, subject.whole.recorded_fine.determined,
          subject.whole.recorded_fine.coordinates),
      .classic = "least squares",
      .figures = {controlled_body(drawing), joint_angles(drawing), goals_followed(drawing, study.table),
                  margins(drawing, study.table)},
      .table = study.table};
}

}  // namespace kinemark::studies
