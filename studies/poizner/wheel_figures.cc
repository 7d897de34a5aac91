// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/wheel_figures.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "kinemark/stages/report/figures/space_drawing.h"
#include "studies/poizner/poizner_names.h"
#include "studies/poizner/rig_components.h"
#include "studies/poizner/wheel_measures.h"

namespace kinemark::studies {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using report::Anchor;
using report::Canvas;
using report::CanvasRoom;

constexpr double kMm = 1e3;
const std::string kInk = "#1a1a1a", kPlane = "#cc6677";

StudyFigure displacement(const WheelOutcome& wheel) {
  StudyFigure out{.paper = kPoizner, .number = 4, .name = "displacement of the LED on the turning wheel"};
  constexpr std::array<const char*, 3> kNames{"X, mm", "Y, mm", "Z, mm"};
  const auto n = wheel.our_path.cols();
  const VectorXd time = VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1) / kRate_hz);
  constexpr double kHeight = 104.0;
  for (int axis = 0; axis < 3; ++axis) {
    const VectorXd mm = kMm * wheel.our_path.row(axis).transpose();
    report::FigurePanel panel{.x_label = axis == 2 ? "time, s" : "",
                              .y_label = kNames[static_cast<std::size_t>(axis)],
                              .tight = true,
                              .height = kHeight};
    panel.lines.push_back({.colour = kInk, .x = time, .y = mm, .width = 1.6});
    out.figure.panels.push_back(std::move(panel));
    out.curves.push_back(curve_of(kNames[static_cast<std::size_t>(axis)], {time, mm}));
  }
  constexpr double kDiameter_mm = 392.0;
  out.numbers = {{"diameter of the wheel", "mm", kDiameter_mm,
                  kDiameter_mm + kMm * wheel.classic.circle_error_m,
                  kDiameter_mm + kMm * wheel.ours.circle_error_m}};
  return out;
}

/// Corners of the rectangle about the path in its plane, two sides level, back to the first.
Matrix3Xd plane_of(const Matrix3Xd& path, const PlaneView& view) {
  const Vector3d across = view.axes.col(2), level = Vector3d::UnitY().cross(across).normalized();
  const Matrix3Xd centred = path.colwise() - view.centre;
  Eigen::Matrix<double, 3, 2> axes;
  axes << level, across.cross(level);
  const Eigen::Matrix2Xd flat = axes.transpose() * centred;
  const Eigen::Vector2d low = flat.rowwise().minCoeff(), high = flat.rowwise().maxCoeff();
  Matrix3Xd out(3, 5);
  int corner = 0;
  for (const auto& [a, b] :
       {std::pair{low.x(), low.y()}, std::pair{high.x(), low.y()}, std::pair{high.x(), high.y()},
        std::pair{low.x(), high.y()}, std::pair{low.x(), low.y()}})
    out.col(corner++) = view.centre + axes * Eigen::Vector2d(a, b);
  return out;
}

/// A line of the summary: the paper's number and ours.
void write_summary(Canvas& canvas, const CanvasRoom& room, const std::vector<FigureNumber>& numbers,
                   const Eigen::Vector3d& box_mm) {
  const double names = room.left, paper = room.right - 58.0, ours = room.right - 4.0;
  double y = room.top + 40.0;
  const auto word = [&](double x, const std::string& text, Anchor anchor, bool bold = false) {
    canvas.text({x, y}, text, {.size = 11.0, .anchor = anchor, .colour = kInk, .bold = bold});
  };
  word(names, "Best-fit plane", Anchor::start, true);
  word(paper, "paper", Anchor::end, true);
  word(ours, "here", Anchor::end, true);
  y += 8.0;
  canvas.line(std::vector<Eigen::Vector2d>{{names, y}, {room.right, y}}, {.colour = kInk, .width = 1.0});
  constexpr double kLine = 22.0;
  for (const auto& number : numbers) {
    y += kLine;
    auto name = number.quantity.substr(number.quantity.find(": ") + 2);
    if (const auto comma = name.find(", by"); comma != std::string::npos) name.resize(comma);
    word(names, name + (number.unit == "1" ? "" : ", " + number.unit), Anchor::start);
    if (number.paper) word(paper, fmt::format("{:g}", *number.paper), Anchor::end);
    word(ours, fmt::format("{:.3f}", number.ours), Anchor::end);
  }
  y += 1.6 * kLine;
  word(names, fmt::format("Box {:.0f} x {:.0f} x {:.0f} mm", box_mm.x(), box_mm.y(), box_mm.z()),
       Anchor::start);
  y += 16.0;
  word(names, "Axes 100 mm", Anchor::start);
}

StudyFigure in_space(const PoiznerStudy& study) {
  const auto& wheel = study.seeds.front().wheels.front();
  StudyFigure out{.paper = kPoizner,
                  .number = 5,
                  .name = "path of the turning wheel's LED in space, with the plane that fits best"};
  const auto quantity = [](const char* what) { return fmt::format("{}: {}", wheel_name(0), what); };
  const std::array<std::string, 5> names{
      quantity("median error of the diameter"), quantity("scatter of the diameter"),
      quantity("largest error of the diameter"), quantity("scatter across the plane"),
      quantity("ratio of the axes, by spread over all samples")};
  out.numbers = numbers_of(study.table, {names.begin(), names.end()});
  const Matrix3Xd& path = wheel.our_path;
  const Matrix3Xd shown = upright(path), plane = upright(plane_of(path, best_fit_plane(path)));
  const Vector3d low = shown.rowwise().minCoeff(), high = shown.rowwise().maxCoeff();
  report::SpaceDrawing scene(-32.0, 20.0);
  scene.box(low, high);
  scene.line(plane, {.colour = kPlane, .width = 1.4, .dashed = true});
  scene.line(shown, {.colour = kInk, .width = 1.4});
  scene.axes(low - Vector3d::Constant(0.03), 0.1, {"Z", "X", "Y"});
  report::FigurePanel panel;
  panel.height = 340.0;
  panel.picture = [scene, numbers = out.numbers,
                   box = Vector3d(kMm * (path.rowwise().maxCoeff() - path.rowwise().minCoeff()))](
                      Canvas& canvas, const CanvasRoom& room) {
    constexpr double kTable = 292.0;
    scene.draw(canvas,
               {.left = room.left, .right = room.right - kTable, .top = room.top, .bottom = room.bottom});
    write_summary(
        canvas,
        {.left = room.right - kTable + 6.0, .right = room.right, .top = room.top, .bottom = room.bottom},
        numbers, box);
  };
  out.figure.panels.push_back(std::move(panel));
  out.curves.push_back(curve_of("path, m", path));
  out.curves.push_back(curve_of(
      "box, m",
      Matrix3Xd((Matrix3Xd(3, 2) << path.rowwise().minCoeff(), path.rowwise().maxCoeff()).finished())));
  return out;
}

}  // namespace

std::vector<StudyFigure> wheel_figures(const PoiznerStudy& study) {
  std::vector<StudyFigure> out;
  out.push_back(displacement(study.seeds.front().wheels.front()));
  out.push_back(in_space(study));
  return out;
}

}  // namespace kinemark::studies
