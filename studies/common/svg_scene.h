// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace kinemark::studies {

/// A small scene in three dimensions as an SVG element: lines and dots above a floor, seen from far away
/// (parallel projection). Things are drawn in the order in which they were added, the floor first. z is up.
class SvgScene {
 public:
  /// @param azimuth_deg    where the viewer stands, from the x axis to the y axis
  /// @param elevation_deg  how high, -90 to 90
  SvgScene(std::string title, double azimuth_deg, double elevation_deg);

  /// A square grid at this height under everything that is drawn; shadows fall on it.
  void floor(double z);
  /// Side of a square of the floor, 1, 2 or 5 times a power of ten; 0 without a floor or without anything on
  /// it.
  [[nodiscard]] double square() const;
  /// Points as columns; shadow: also a grey line on the floor below.
  void line(std::string colour, const Eigen::Matrix3Xd& x, double width, bool shadow = false);
  /// hollow: a ring instead of a disc.
  void dot(std::string colour, const Eigen::Vector3d& x, double radius, bool hollow = false);
  /// A label beside a point.
  void label(std::string text, const Eigen::Vector3d& x);

  /// The element, 640 x 480 pixels, scaled so that everything fits. Non-finite points are left out.
  [[nodiscard]] std::string svg() const;

 private:
  struct Thing {
    std::string colour, text;
    Eigen::Matrix3Xd x;  // one column: a dot or a label
    double size = 1.0;
    bool hollow = false;
  };
  [[nodiscard]] Eigen::Vector2d project(const Eigen::Vector3d& x) const;
  struct Ground {
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    double square = 0.0;
    int squares = 0;  // each way
  };
  [[nodiscard]] Ground ground() const;
  [[nodiscard]] std::vector<Thing> grid() const;

  std::string title_;
  Eigen::Vector3d right_, up_;
  bool has_floor_ = false;
  double floor_z_ = 0.0;
  std::vector<Thing> shadows_, things_;
};

}  // namespace kinemark::studies
