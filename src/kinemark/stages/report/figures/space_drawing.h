// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Drawings in three dimensions: lines, dots and words above a floor or in a box.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "kinemark/stages/report/figures/canvas.h"

namespace kinemark::report {

/// How a line of a scene is drawn.
struct SpaceLine {
  std::string colour = "#000000";  ///< "#rrggbb"
  double width = 1.2;              ///< pixels
  bool dashed = false;             ///< instead of drawn through
  bool shadow = false;             ///< also a grey line on the floor below
};

/// Lines and dots seen from far away (parallel projection). Things are drawn in the order in which they were
/// added, the floor first. z is up.
class SpaceDrawing {
 public:
  /// @param azimuth_deg    where the viewer stands, from the x axis to the y axis
  /// @param elevation_deg  how high, -90 to 90
  SpaceDrawing(double azimuth_deg, double elevation_deg);

  /// A square grid at this height under everything that is drawn; shadows fall on it.
  void floor(double z);
  /// Side of a square of the floor, 1, 2 or 5 times a power of ten; 0 without a floor or without anything on
  /// it.
  [[nodiscard]] double square() const;
  /// Points as columns, two or more.
  void line(const Eigen::Matrix3Xd& x, const SpaceLine& how);
  /// hollow: a ring instead of a disc.
  void dot(std::string colour, const Eigen::Vector3d& x, double radius, bool hollow = false);
  /// A word beside a point. @param shift  of its baseline, pixels right and down
  void label(std::string text, const Eigen::Vector3d& x, Anchor anchor = Anchor::start,
             const Eigen::Vector2d& shift = {8.0, -6.0});
  /// The twelve edges of a box along the axes.
  void box(const Eigen::Vector3d& low, const Eigen::Vector3d& high);
  /// Three arrows of one length along the axes from a corner, with their names at their tips.
  void axes(const Eigen::Vector3d& from, double length, const std::array<std::string, 3>& names);

  /// Where a point lies when everything is drawn in a room, pixels.
  [[nodiscard]] Eigen::Vector2d place(const Eigen::Vector3d& x, const CanvasRoom& room) const;
  /// Draws everything as large as fits. Non-finite lines and dots are left out.
  void draw(Canvas& canvas, const CanvasRoom& room) const;

 private:
  struct Thing {
    std::string text;
    Eigen::Matrix3Xd x;  // one column: a dot or a label
    SpaceLine how;       // of a dot: its radius as width
    bool hollow = false;
    Anchor anchor = Anchor::start;
    Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  };
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& x) const;
  struct Ground {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    double square = 0.0;
    int squares = 0;  // each way
  };
  [[nodiscard]] Ground ground() const;
  [[nodiscard]] std::vector<Thing> grid() const;
  struct Fit {
    double scale = 1.0;
    Eigen::Vector2d shift = Eigen::Vector2d::Zero();
  };
  [[nodiscard]] std::vector<Thing> all() const;  // in the order of drawing
  [[nodiscard]] Fit fit(const std::vector<Thing>& all, const CanvasRoom& room) const;

  Eigen::Vector3d right_, up_;
  bool has_floor_ = false;
  double floor_z_ = 0.0;
  std::vector<Thing> shadows_, things_;
};

}  // namespace kinemark::report
