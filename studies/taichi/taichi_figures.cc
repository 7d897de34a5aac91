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
#include "studies/common/svg_plot.h"

namespace kinemark::studies {
namespace {

using Eigen::VectorXd;

constexpr const char* kGoal = "#888888";
constexpr const char* kLeastSquares = "#b8860b";
constexpr const char* kWhole = "#1f5fa8";
constexpr const char* kUpper = "#2e8b57";
constexpr const char* kPaper = "#a83232";

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

/// Figure 2: one coordinate by every method.
std::string angles(const TaiChiDrawing& drawing, std::string_view coordinate) {
  SvgPlot plot(std::string(coordinate), "time, s", fmt::format("{}, deg", coordinate));
  const auto& fitted = drawing.least_squares.motion;
  plot.line("least squares", kLeastSquares, times(fitted.time), angle_deg(fitted, coordinate), 3.0);
  const auto add = [&](const char* name, const char* colour, const motion::TrackResult& tracked) {
    plot.line(name, colour, times(tracked.motion.time), angle_deg(tracked.motion, coordinate));
  };
  add("2 + 2 landmarks", kPaper, drawing.paper);
  add("upper body", kUpper, drawing.upper);
  add("whole body", kWhole, drawing.whole);
  return plot.svg();
}

/// Marker error (measured minus model) of one landmark, frames x 3; NaN where not seen.
Eigen::MatrixX3d errors(const data::JointMotion& motion, std::string_view landmark) {
  const auto at = std::ranges::find(motion.markers, landmark);
  Eigen::MatrixX3d out = Eigen::MatrixX3d::Constant(motion.frames(), 3, kNaN);
  if (at == motion.markers.end()) return out;
  const auto count = static_cast<std::int64_t>(motion.markers.size());
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    for (int axis = 0; axis < 3; ++axis)
      out(f, axis) =
          motion
              .marker_error[static_cast<std::size_t>(3 * (f * count + (at - motion.markers.begin())) + axis)];
  return out;
}

/// Figure 3: height and forward position of one landmark, goal and tracked.
std::string path(const TaiChiDrawing& drawing, std::string_view landmark, int axis) {
  constexpr std::array<const char*, 3> kAxis{"forward", "up", "right"};
  const auto m = drawing.goals.find(landmark);
  SvgPlot plot(std::string(landmark), "time, s",
               fmt::format("{}, {}, m", landmark, kAxis[static_cast<std::size_t>(axis)]));
  VectorXd goal(drawing.goals.frames());
  for (std::int64_t f = 0; f < drawing.goals.frames(); ++f) goal[f] = drawing.goals.x(f, m)[axis];
  plot.line("goal", kGoal, times(drawing.goals.time), goal, 4.0);
  const auto add = [&](const char* name, const char* colour, const data::JointMotion& motion,
                       std::int64_t first) {
    const auto error = errors(motion, landmark);
    plot.line(name, colour, times(motion.time), goal.segment(first, motion.frames()) - error.col(axis));
  };
  add("least squares, all 21", kLeastSquares, drawing.least_squares.motion,
      drawing.least_squares.fit.first_frame);
  add("whole body", kWhole, drawing.whole.motion, drawing.whole.fit.first_frame);
  add("2 + 2 landmarks", kPaper, drawing.paper.motion, drawing.paper.fit.first_frame);
  return plot.svg();
}

/// Figure 4, upper part: distance of each of the four landmarks from its goal.
std::string margins(const data::JointMotion& motion, const char* title) {
  constexpr std::array<std::pair<const char*, const char*>, 4> kFour{
      {{"RShoulder", "#1f5fa8"}, {"LWrist", "#2e8b57"}, {"LElbow", "#a83232"}, {"RWrist", "#b8860b"}}};
  SvgPlot plot(title, "time, s", "landmark to goal, mm");
  for (const auto& [landmark, colour] : kFour)
    plot.line(landmark, colour, times(motion.time), 1e3 * errors(motion, landmark).rowwise().norm());
  return plot.svg();
}

/// Figure 4, lower part: control against least squares for one coordinate, and its bound.
std::string joint_margin(const TaiChiDrawing& drawing, std::string_view coordinate) {
  const auto& ours = drawing.whole.motion;
  const auto c = ours.find(coordinate);
  SvgPlot plot(std::string(coordinate), "time, s", fmt::format("{}: error and its bound, deg", coordinate));
  const auto shift = drawing.whole.fit.first_frame - drawing.least_squares.fit.first_frame;
  VectorXd bound = VectorXd::Constant(ours.frames(), kNaN);
  const auto& goal_bound = drawing.whole.goal_bound;
  for (std::int64_t f = 0; f < ours.frames() && !goal_bound.empty(); ++f)
    bound[f] = goal_bound[ours.index(f, c)] * kDegPerRad;
  const VectorXd fitted = angle_deg(drawing.least_squares.motion, coordinate).segment(shift, ours.frames());
  VectorXd error = (angle_deg(ours, coordinate) - fitted).cwiseAbs();
  for (double& e : error) e = std::abs(std::remainder(e, 360.0));
  plot.line("bound of equation 16", kGoal, times(ours.time), bound, 2.0);
  plot.line("whole body to least squares", kWhole, times(ours.time), error);
  return plot.svg();
}

/// Share of frames in which a coordinate is determined, in per cent.
double determined_share(const data::JointMotion& motion, std::string_view coordinate) {
  if (motion.determined.empty()) return kNaN;
  double sum = 0.0;
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    sum += motion.determined[motion.index(f, motion.find(coordinate))];
  return 100.0 * sum / static_cast<double>(motion.frames());
}

std::string determined_text(const TaiChiDrawing& drawing, std::string_view coordinate) {
  return fmt::format(
      "<p>Determined in {:.0f} % of the frames by all 21 landmarks, {:.0f} % by the upper body, "
      "{:.0f} % by the four.</p>",
      determined_share(drawing.whole.motion, coordinate), determined_share(drawing.upper.motion, coordinate),
      determined_share(drawing.paper.motion, coordinate));
}

}  // namespace

StudyPage taichi_page(const TaiChiStudy& study) {
  check(!study.subjects.empty() && study.subjects.front().drawing.has_value(),
        "the page shows the first subject");
  const auto& subject = study.subjects.front();
  const auto& drawing = *subject.drawing;
  const auto& paper = subject.paper.recorded_fine;
  StudyPage out{
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
      .figures = {},
      .table = study.table};
  for (const char* coordinate : {"arm_flex_r", "arm_add_r", "elbow_flex_r", "elbow_flex_l"})
    out.figures.push_back({fmt::format("Figure 2: joint angles, {}", coordinate),
                           angles(drawing, coordinate) + determined_text(drawing, coordinate)});
  for (const char* landmark : {"RShoulder", "LWrist", "LElbow", "RWrist"})
    out.figures.push_back(
        {fmt::format("Figure 3: tracked against goal, {}", landmark), path(drawing, landmark, 1)});
  out.figures.push_back(
      {"Figure 4: margin of landmark error, the four alone", margins(drawing.paper.motion, "2 + 2")});
  out.figures.push_back(
      {"Figure 4: margin of landmark error, whole body", margins(drawing.whole.motion, "whole body")});
  for (const char* coordinate : {"arm_flex_r", "elbow_flex_l"})
    out.figures.push_back(
        {fmt::format("Figure 4: margin of joint error, {}", coordinate), joint_margin(drawing, coordinate)});
  return out;
}

}  // namespace kinemark::studies
