// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/svg_scene.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/html_text.h"

namespace kinemark::studies {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kSceneWidth = 640.0, kSceneHeight = 480.0, kMargin = 24.0;
constexpr int kSquares = 8;  // of the floor, each way, at most but for the rim

/// The next of 1, 2, 5, 10, 20, ...
double round_up(double v) {
  const double power = std::pow(10.0, std::floor(std::log10(v)));
  for (const double m : {1.0, 2.0, 5.0})
    if (m * power >= v * (1.0 - 1e-9)) return m * power;
  return 10.0 * power;
}

}  // namespace

SvgScene::SvgScene(std::string title, double azimuth_deg, double elevation_deg) : title_(std::move(title)) {
  check(std::abs(elevation_deg) <= 90.0, "the viewer stands between straight below and straight above");
  const double a = azimuth_deg * std::numbers::pi / 180.0, e = elevation_deg * std::numbers::pi / 180.0;
  right_ << -std::sin(a), std::cos(a), 0.0;
  up_ << -std::cos(a) * std::sin(e), -std::sin(a) * std::sin(e), std::cos(e);
}

void SvgScene::floor(double z) {
  has_floor_ = true;
  floor_z_ = z;
}

void SvgScene::line(std::string colour, const Matrix3Xd& x, double width, bool shadow) {
  check(x.cols() > 1, "a line needs two points or more");
  if (shadow) {
    Matrix3Xd below = x;
    below.row(2).setConstant(floor_z_);
    shadows_.push_back({"#b8b8b8", "", std::move(below), width, false});
  }
  things_.push_back({std::move(colour), "", x, width, false});
}

void SvgScene::dot(std::string colour, const Vector3d& x, double radius, bool hollow) {
  things_.push_back({std::move(colour), "", x, radius, hollow});
}

void SvgScene::label(std::string text, const Vector3d& x) {
  things_.push_back({"#222", std::move(text), x, 0.0, false});
}

Vector2d SvgScene::project(const Vector3d& x) const { return {right_.dot(x), -up_.dot(x)}; }

SvgScene::Ground SvgScene::ground() const {
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& thing : things_)
    for (const auto x : thing.x.colwise())
      if (x.allFinite()) {
        low = low.cwiseMin(x.head<2>());
        high = high.cwiseMax(x.head<2>());
      }
  if (!has_floor_ || !(low.x() <= high.x())) return {};
  const double half = std::max(0.55 * (high - low).maxCoeff(), 1e-6),
               square = round_up(2.0 * half / kSquares);
  return {.middle = 0.5 * (low + high),
          .square = square,
          .squares = 2 * static_cast<int>(std::ceil(half / square))};
}

double SvgScene::square() const { return ground().square; }

std::vector<SvgScene::Thing> SvgScene::grid() const {
  std::vector<Thing> out;
  const Ground g = ground();
  if (g.squares == 0) return out;
  const double half = 0.5 * g.square * g.squares;
  for (int i = 0; i <= g.squares; ++i) {
    const double at = g.square * i - half;
    Matrix3Xd along(3, 2), across(3, 2);
    along << g.middle.x() - half, g.middle.x() + half, g.middle.y() + at, g.middle.y() + at, floor_z_,
        floor_z_;
    across << g.middle.x() + at, g.middle.x() + at, g.middle.y() - half, g.middle.y() + half, floor_z_,
        floor_z_;
    out.push_back({"#e2e2e2", "", along, 1.0, false});
    out.push_back({"#e2e2e2", "", across, 1.0, false});
  }
  return out;
}

std::string SvgScene::svg() const {
  std::vector<Thing> all = grid();
  all.insert(all.end(), shadows_.begin(), shadows_.end());
  all.insert(all.end(), things_.begin(), things_.end());
  Vector2d low = Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const auto& thing : all)
    for (const auto x : thing.x.colwise())
      if (x.allFinite()) {
        low = low.cwiseMin(project(x));
        high = high.cwiseMax(project(x));
      }
  if (!(low.x() <= high.x())) low.setZero(), high.setOnes();
  const Vector2d extent = (high - low).cwiseMax(1e-9);
  const double scale =
      std::min((kSceneWidth - 2.0 * kMargin) / extent.x(), (kSceneHeight - 2.0 * kMargin) / extent.y());
  const Vector2d shift = 0.5 * Vector2d(kSceneWidth, kSceneHeight) - 0.5 * scale * (low + high);
  std::string out =
      fmt::format("<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\"><title>{2}</title>",
                  kSceneWidth, kSceneHeight, html_text(title_));
  for (const auto& thing : all) {
    if (!thing.x.allFinite()) continue;
    const Vector2d first = scale * project(thing.x.col(0)) + shift;
    if (!thing.text.empty()) {
      out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"halo\">{}</text>", first.x() + 8.0,
                         first.y() - 6.0, html_text(thing.text));
    } else if (thing.x.cols() == 1) {
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\" stroke=\"{}\"/>",
                         first.x(), first.y(), thing.size, thing.hollow ? "#fff" : thing.colour,
                         thing.hollow ? thing.colour : "#fff");
    } else {
      out += fmt::format(
          "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\" "
          "stroke-linecap=\"round\" d=\"",
          thing.colour, thing.size);
      for (Eigen::Index i = 0; i < thing.x.cols(); ++i) {
        const Vector2d p = scale * project(thing.x.col(i)) + shift;
        out += fmt::format("{}{:.1f} {:.1f}", i > 0 ? 'L' : 'M', p.x(), p.y());
      }
      out += "\"/>";
    }
  }
  return out + "</svg>";
}

}  // namespace kinemark::studies
