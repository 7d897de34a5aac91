// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What figures are drawn on. Pixels from the upper left corner; colours are "#rrggbb".
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "kinemark/core/result.h"

namespace kinemark::report {

/// How a line is drawn.
struct Stroke {
  std::string colour = "#000000";  ///< of the line
  double width = 1.2;              ///< pixels
  bool dashed = false;             ///< 6 pixels drawn, 4 left out
  bool dotted = false;             ///< as long as wide drawn, twice that left out
  bool round = false;              ///< ends and corners
};

/// Where a text's position lies in it.
enum class Anchor : std::uint8_t { start, middle, end };

/// How a text is written.
struct Lettering {
  double size = 12.0;              ///< pixels
  Anchor anchor = Anchor::start;   ///< of the position
  std::string colour = "#000000";  ///< of the letters
  bool upwards = false;            ///< reads from below to above
  bool bold = false;               ///< heavy letters
  bool halo = false;               ///< a white rim, to be read above lines
};

/// A rectangle of a picture, pixels.
struct CanvasRoom {
  double left = 0.0, right = 0.0;  ///< across
  double top = 0.0, bottom = 0.0;  ///< down
};

/// A picture that is being drawn.
class Canvas {
 public:
  virtual ~Canvas() = default;
  /// A line through points; less than two: nothing.
  virtual void line(std::span<const Eigen::Vector2d> points, const Stroke& stroke) = 0;
  /// A filled area. @param opacity  0 to 1
  virtual void area(std::span<const Eigen::Vector2d> points, const std::string& colour, double opacity) = 0;
  /// A filled dot.
  virtual void dot(const Eigen::Vector2d& centre, double radius, const std::string& colour) = 0;
  /// One line of text, its baseline at the position.
  virtual void text(const Eigen::Vector2d& position, const std::string& text, const Lettering& lettering) = 0;
  /// The whole picture as the content of a file. To be called once, last.
  [[nodiscard]] virtual Result<std::string> finish() = 0;
};

/// An SVG with letters as letters, on white.
[[nodiscard]] std::unique_ptr<Canvas> make_svg_canvas(double width, double height, const std::string& title);

/// A PNG on white. @param scale  dots a pixel, above 0
/// Code::not_supported where the program was built without Cairo; Code::bad_input beyond 20,000 dots a side.
[[nodiscard]] Result<std::unique_ptr<Canvas>> make_png_canvas(double width, double height, double scale);

}  // namespace kinemark::report
