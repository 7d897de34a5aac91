// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/sign_figures.h"

#include <array>
#include <cmath>

#include "kinemark/stages/report/figures/space_drawing.h"
#include "studies/poizner/poizner_names.h"
#include "studies/poizner/rig_components.h"

namespace kinemark::studies {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using report::Anchor;
using report::Canvas;
using report::CanvasRoom;

constexpr Eigen::Index kFirst = 20,
                       kRound = 72;  // frames of one round of the sign before its first occlusion
constexpr std::array<const char*, 4> kLedInks{"#7a7a7a", "#009e73", "#d55e00", "#0072b2"};
const std::string kInk = "#1a1a1a", kPast = "#b0b0b0";

/// The arm of one frame, shoulder to hand.
Matrix3Xd arm_at(const ArmOutcome& arm, Eigen::Index frame) {
  Matrix3Xd out(3, static_cast<Eigen::Index>(arm.our_paths.size()));
  for (std::size_t led = 0; led < arm.our_paths.size(); ++led)
    out.col(static_cast<Eigen::Index>(led)) = arm.our_paths[led].position.col(frame);
  return out;
}

/// An arrow head along a path at a frame, in the plane that is seen.
void draw_heads(report::SpaceDrawing& scene, const Matrix3Xd& path,
                std::initializer_list<Eigen::Index> frames) {
  constexpr double kHead = 0.022;
  for (const auto f : frames) {
    const Vector3d d = (path.col(f + 1) - path.col(f - 1)).normalized(),
                   n = d.cross(Vector3d::UnitX()).normalized();
    Matrix3Xd head(3, 3);
    head << path.col(f) - kHead * d + 0.5 * kHead * n, path.col(f), path.col(f) - kHead * d - 0.5 * kHead * n;
    scene.line(head, {.colour = kInk, .width = 2.2});
  }
}

report::SpaceDrawing line_drawing(const ArmOutcome& arm) {
  report::SpaceDrawing scene(-22.0, 10.0);
  draw_signer(scene, arm.our_paths.front().position.col(kFirst));
  constexpr int kPoses = 5;
  for (int i = kPoses - 1; i >= 0; --i) {
    const Matrix3Xd pose = upright(arm_at(arm, kFirst + kRound * i / kPoses));
    scene.line(pose, {.colour = i == 0 ? kInk : kPast, .width = i == 0 ? 4.0 : 1.6});
    if (i == 0)
      for (const auto led : pose.colwise()) scene.dot("#c0392b", led, 4.5);
  }
  const Matrix3Xd round = upright(arm.our_paths.back().position.middleCols(kFirst, kRound + 1));
  scene.line(round, {.colour = kInk, .width = 1.6});
  draw_heads(scene, round, {kRound / 4, 3 * kRound / 4});
  return scene;
}

report::SpaceDrawing paths_in_space(const ArmOutcome& arm) {
  report::SpaceDrawing scene(-35.0, 22.0);
  Vector3d low = Vector3d::Constant(1e9), high = -low;
  for (const auto& led : arm.our_paths) {
    const Matrix3Xd path = upright(led.position);
    low = low.cwiseMin(path.rowwise().minCoeff());
    high = high.cwiseMax(path.rowwise().maxCoeff());
  }
  scene.box(low, high);
  for (std::size_t led = 0; led < arm.our_paths.size(); ++led) {
    const Matrix3Xd path = upright(arm.our_paths[led].position);
    scene.line(path, {.colour = kLedInks[led % kLedInks.size()], .width = 1.3});
    scene.label(arm.leds[led].name, path.rowwise().mean(), Anchor::start,
                {16.0, led + 1 == arm.our_paths.size() ? -30.0 : 4.0});
  }
  scene.axes(low - Vector3d::Constant(0.03), 0.1, {"Z", "X", "Y"});
  return scene;
}

report::FigurePanel curve_panel(const char* y_label, const char* x_label, const VectorXd& time,
                                const VectorXd& ours, const VectorXd& classic) {
  report::FigurePanel out{
      .x_label = x_label, .y_label = y_label, .tight = true, .zero = true, .height = 140.0};
  const bool named = x_label[0] == '\0';
  out.lines.push_back(
      {.name = named ? "1986 method" : "", .colour = kClassicInk, .x = time, .y = classic, .width = 1.0});
  out.lines.push_back({.name = named ? "ours" : "", .colour = kInk, .x = time, .y = ours, .width = 1.6});
  return out;
}

/// Two-point central differences; the ends are left out.
Matrix3Xd rates(const Matrix3Xd& path) {
  Matrix3Xd out = Matrix3Xd::Constant(3, path.cols(), std::nan(""));
  for (Eigen::Index f = 1; f + 1 < path.cols(); ++f)
    out.col(f) = 0.5 * kRate_hz * (path.col(f + 1) - path.col(f - 1));
  return out;
}

}  // namespace

TangentialMotion tangential_motion(const Matrix3Xd& velocity, const Matrix3Xd& acceleration) {
  TangentialMotion out{velocity.colwise().norm().transpose(), VectorXd::Zero(velocity.cols())};
  for (Eigen::Index f = 0; f < velocity.cols(); ++f)
    if (!(out.speed[f] <= 0.0)) out.acceleration[f] = velocity.col(f).dot(acceleration.col(f)) / out.speed[f];
  return out;
}

StudyFigure sign_figure(const ArmOutcome& arm) {
  StudyFigure out{
      .paper = kPoizner,
      .number = 6,
      .name =
          "the sign LOOK-AT[Continuative]: (A) line drawing, (B) paths of the LEDs, axes 100 mm, (C) hand"};
  report::FigurePanel drawings;
  drawings.height = 300.0;
  drawings.picture = [a = line_drawing(arm), b = paths_in_space(arm)](Canvas& canvas,
                                                                      const CanvasRoom& room) {
    const double middle = 0.46 * room.left + 0.54 * room.right - 40.0;
    a.draw(canvas, {.left = room.left, .right = middle, .top = room.top, .bottom = room.bottom});
    b.draw(canvas, {.left = middle, .right = room.right, .top = room.top, .bottom = room.bottom});
    for (const auto& [x, name] : {std::pair{room.left + 6.0, "A"}, std::pair{middle + 6.0, "B"}})
      canvas.text({x, room.top + 6.0}, name, {.size = 16.0, .colour = kInk, .bold = true});
    canvas.text({room.left + 6.0, room.bottom + 24.0}, "C", {.size = 16.0, .colour = kInk, .bold = true});
  };
  out.figure.panels.push_back(std::move(drawings));
  const std::size_t hand = arm.our_paths.size() - 1;
  const auto& path = arm.our_paths[hand];
  const auto n = path.position.cols();
  const VectorXd time = VectorXd::LinSpaced(n, 0.0, static_cast<double>(n - 1) / kRate_hz);
  const Matrix3Xd old_velocity = rates(arm.classic_paths[hand]);
  const auto ours = tangential_motion(path.velocity, path.acceleration),
             classic = tangential_motion(old_velocity, rates(old_velocity));
  out.figure.panels.push_back(curve_panel("tangential velocity, m/s", "", time, ours.speed, classic.speed));
  out.figure.panels.push_back(
      curve_panel("tangential acc., m/s²", "time, s", time, ours.acceleration, classic.acceleration));
  const Eigen::Index ends = 10;  // as the table leaves them out
  const VectorXd inner = ours.speed.segment(ends, n - 2 * ends),
                 old = classic.speed.segment(ends, n - 2 * ends);
  constexpr double kPaperFastest = 2.7, kPaperSlowest = 0.5;
  out.numbers = {
      {"largest tangential velocity of the hand", "m/s", kPaperFastest, old.maxCoeff(), inner.maxCoeff()},
      {"smallest tangential velocity of the hand", "m/s", kPaperSlowest, old.minCoeff(), inner.minCoeff()}};
  for (std::size_t led = 0; led < arm.our_paths.size(); ++led)
    out.curves.push_back(curve_of(arm.leds[led].name + ", m", arm.our_paths[led].position));
  out.curves.push_back(curve_of("velocity of the hand, m/s", path.velocity));
  out.curves.push_back(curve_of("tangential velocity", {time, ours.speed}));
  out.curves.push_back(curve_of("tangential acceleration", {time, ours.acceleration}));
  return out;
}

}  // namespace kinemark::studies
