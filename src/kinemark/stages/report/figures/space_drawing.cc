// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/space_drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "kinemark/core/check.h"

namespace kinemark::report {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kMargin = 24.0, kLabelSize = 12.0;
constexpr int kSquares = 8;  // of the floor, each way, at most but for the rim
const std::string kFloorInk = "#e2e2e2", kShadowInk = "#b8b8b8", kBoxInk = "#8a8a8a", kWordInk = "#1a1a1a",
                  kPaper = "#ffffff";

/// The next of 1, 2, 5, 10, 20, ...
double round_up(double v) {
  const double power = std::pow(10.0, std::floor(std::log10(v)));
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= v * (1.0 - 1e-9)) return m * power;
  return 10.0 * power;
}

Matrix3Xd between(const Vector3d& a, const Vector3d& b) {
  Matrix3Xd out(3, 2);
  out << a, b;
  return out;
}

/// Corners of what is shown, of any number of columns.
template <class Things, class Flat>
std::pair<Vector2d, Vector2d> extent_of(const Things& things, const Flat& flat) {
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& thing : things)
    for (const auto x : thing.x.colwise())
      if (x.allFinite()) {
        low = low.cwiseMin(flat(x));
        high = high.cwiseMax(flat(x));
      }
  return {low, high};
}

}  // namespace

SpaceDrawing::SpaceDrawing(double azimuth_deg, double elevation_deg) {
  check(std::abs(elevation_deg) <= 90.0, "the viewer stands between straight below and straight above");
  const double a = azimuth_deg * std::numbers::pi / 180.0, e = elevation_deg * std::numbers::pi / 180.0;
  right_ << -std::sin(a), std::cos(a), 0.0;
  up_ << -std::cos(a) * std::sin(e), -std::sin(a) * std::sin(e), std::cos(e);
}

void SpaceDrawing::floor(double z) {
  has_floor_ = true;
  floor_z_ = z;
}

void SpaceDrawing::line(const Matrix3Xd& x, const SpaceLine& how) {
  check(x.cols() > 1, "a line needs two points or more");
  if (how.shadow) {
    Matrix3Xd below = x;
    below.row(2).setConstant(floor_z_);
    shadows_.push_back(
        {.text = {}, .x = std::move(below), .how = {.colour = kShadowInk, .width = how.width}});
  }
  things_.push_back({.text = {}, .x = x, .how = how});
}

void SpaceDrawing::dot(std::string colour, const Vector3d& x, double radius, bool hollow) {
  things_.push_back(
      {.text = {}, .x = x, .how = {.colour = std::move(colour), .width = radius}, .hollow = hollow});
}

void SpaceDrawing::label(std::string text, const Vector3d& x, Anchor anchor, const Vector2d& shift) {
  things_.push_back({.text = std::move(text), .x = x, .how = {}, .anchor = anchor, .shift = shift});
}

void SpaceDrawing::box(const Vector3d& low, const Vector3d& high) {
  for (int axis = 0; axis < 3; ++axis)
    for (int corner = 0; corner < 4; ++corner) {
      Vector3d a = low;
      if ((corner & 1) != 0) a[(axis + 1) % 3] = high[(axis + 1) % 3];
      if ((corner & 2) != 0) a[(axis + 2) % 3] = high[(axis + 2) % 3];
      Vector3d b = a;
      b[axis] = high[axis];
      line(between(a, b), {.colour = kBoxInk, .width = 1.0});
    }
}

void SpaceDrawing::axes(const Vector3d& from, double length, const std::array<std::string, 3>& names) {
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d to = from + length * Vector3d::Unit(axis);
    line(between(from, to), {.colour = kWordInk, .width = 2.2});
    const Vector2d along = project(to) - project(from);
    const double away = std::max(along.norm(), 1e-12);
    const Vector2d shift = Vector2d(0.0, 4.0) + 11.0 * along / away;
    label(names[static_cast<std::size_t>(axis)], to,
          along.x() < -0.3 * away  ? Anchor::end
          : along.x() > 0.3 * away ? Anchor::start
                                   : Anchor::middle,
          shift);
  }
}

Vector2d SpaceDrawing::project(const Vector3d& x) const { return {right_.dot(x), -up_.dot(x)}; }

SpaceDrawing::Ground SpaceDrawing::ground() const {
  const auto [low, high] = extent_of(things_, [](const auto& x) { return Vector2d(x.template head<2>()); });
  if (!has_floor_ || !(low.x() <= high.x())) return {};
  const double half = std::max(0.55 * (high - low).maxCoeff(), 1e-6),
               square = round_up(2.0 * half / kSquares);
  return {.middle = 0.5 * (low + high),
          .square = square,
          .squares = 2 * static_cast<int>(std::ceil(half / square))};
}

double SpaceDrawing::square() const { return ground().square; }

std::vector<SpaceDrawing::Thing> SpaceDrawing::grid() const {
  std::vector<Thing> out;
  const Ground g = ground();
  if (g.squares == 0) return out;
  const double half = 0.5 * g.square * g.squares;
  const auto add = [&](double x0, double x1, double y0, double y1) {
    out.push_back({.text = {},
                   .x = between({x0, y0, floor_z_}, {x1, y1, floor_z_}),
                   .how = {.colour = kFloorInk, .width = 1.0}});
  };
  for (int i = 0; i <= g.squares; ++i) {
    const double at = g.square * i - half;
    add(g.middle.x() - half, g.middle.x() + half, g.middle.y() + at, g.middle.y() + at);
    add(g.middle.x() + at, g.middle.x() + at, g.middle.y() - half, g.middle.y() + half);
  }
  return out;
}

std::vector<SpaceDrawing::Thing> SpaceDrawing::all() const {
  std::vector<Thing> out = grid();
  out.insert(out.end(), shadows_.begin(), shadows_.end());
  out.insert(out.end(), things_.begin(), things_.end());
  return out;
}

SpaceDrawing::Fit SpaceDrawing::fit(const std::vector<Thing>& all, const CanvasRoom& room) const {
  auto [low, high] = extent_of(all, [&](const auto& x) { return project(x); });
  if (!(low.x() <= high.x())) low.setZero(), high.setOnes();
  const Vector2d extent = (high - low).cwiseMax(1e-9), size(room.right - room.left, room.bottom - room.top);
  const double scale = ((size.array() - 2.0 * kMargin) / extent.array()).minCoeff();
  const Vector2d middle(0.5 * (room.left + room.right), 0.5 * (room.top + room.bottom));
  return {.scale = scale, .shift = middle - 0.5 * scale * (low + high)};
}

Vector2d SpaceDrawing::place(const Vector3d& x, const CanvasRoom& room) const {
  const Fit fitted = fit(all(), room);
  return fitted.scale * project(x) + fitted.shift;
}

void SpaceDrawing::draw(Canvas& canvas, const CanvasRoom& room) const {
  const auto things = all();
  const Fit fitted = fit(things, room);
  for (const auto& thing : things) {
    if (!thing.x.allFinite()) continue;
    const auto at = [&](Eigen::Index i) -> Vector2d {
      return fitted.scale * project(thing.x.col(i)) + fitted.shift;
    };
    if (!thing.text.empty()) {
      canvas.text(at(0) + thing.shift, thing.text,
                  {.size = kLabelSize, .anchor = thing.anchor, .colour = kWordInk, .halo = true});
    } else if (thing.x.cols() == 1) {
      canvas.dot(at(0), thing.how.width, thing.how.colour);
      if (thing.hollow) canvas.dot(at(0), 0.6 * thing.how.width, kPaper);
    } else {
      std::vector<Vector2d> points;
      for (Eigen::Index i = 0; i < thing.x.cols(); ++i) points.push_back(at(i));
      canvas.line(
          points,
          {.colour = thing.how.colour, .width = thing.how.width, .dashed = thing.how.dashed, .round = true});
    }
  }
}

}  // namespace kinemark::report
