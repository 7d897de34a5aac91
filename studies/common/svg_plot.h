// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace kinemark::studies {

/// A line plot as an SVG element: axes with round ticks, lines with a legend, dots, boxes. Words are plain
/// text:
/// `<` and `&` mean themselves.
class SvgPlot {
 public:
  /// @param equal  one unit is as long on both axes
  SvgPlot(std::string title, std::string x_label, std::string y_label, bool equal = false);

  /// A line through the finite ones of these points; it is broken where one is not. Sizes agree.
  void line(std::string name, std::string colour, const Eigen::VectorXd& x, const Eigen::VectorXd& y,
            double width = 1.2, bool dashed = false);
  /// The finite ones of these points as dots, without a name. Sizes agree.
  void dots(std::string colour, const Eigen::VectorXd& x, const Eigen::VectorXd& y, double radius = 3.0);
  /// From here on y is shown by its logarithm; what is not positive is left out.
  void logarithmic_y() { log_y_ = true; }
  /// A dashed rectangle.
  void box(const Eigen::Vector2d& low, const Eigen::Vector2d& high);

  /// The element, 640 x 400 pixels. Without a finite point: an empty frame.
  [[nodiscard]] std::string svg() const;

 private:
  struct Line {
    std::string name, colour;
    Eigen::VectorXd x, y;
    double width;
    bool dashed;
  };
  struct Dots {
    std::string colour;
    Eigen::VectorXd x, y;
    double radius;
  };
  std::string title_, x_label_, y_label_;
  bool equal_, log_y_ = false;
  std::vector<Line> lines_;
  std::vector<Dots> dots_;
  std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> boxes_;
};

}  // namespace kinemark::studies
