// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "kinemark/core/html_text.h"
#include "kinemark/stages/report/figures/canvas.h"

namespace kinemark::report {
namespace {

std::string path_of(std::span<const Eigen::Vector2d> points) {
  std::string out;
  for (std::size_t i = 0; i < points.size(); ++i)
    out += fmt::format("{}{:.2f} {:.2f}", i == 0 ? 'M' : 'L', points[i].x(), points[i].y());
  return out;
}

std::string dashes_of(const Stroke& stroke) {
  if (stroke.dotted) return fmt::format(" stroke-dasharray=\"{:g} {:g}\"", stroke.width, 2.0 * stroke.width);
  return stroke.dashed ? " stroke-dasharray=\"6 4\"" : "";
}

class SvgCanvas final : public Canvas {
 public:
  SvgCanvas(double width, double height, const std::string& title)
      : out_(fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:g} {1:g}\" width=\"{0:g}\" "
            "height=\"{1:g}\" role=\"img\" font-family=\"Arial, Helvetica, 'DejaVu Sans', sans-serif\">"
            "<title>{2}</title><rect width=\"{0:g}\" height=\"{1:g}\" fill=\"#ffffff\"/>\n",
            width, height, html_text(title))) {}

  void line(std::span<const Eigen::Vector2d> points, const Stroke& stroke) override {
    if (points.size() < 2) return;
    out_ += fmt::format("<path fill=\"none\" stroke=\"{}\" stroke-width=\"{:g}\"{}{} d=\"{}\"/>\n",
                        stroke.colour, stroke.width, dashes_of(stroke),
                        stroke.round ? " stroke-linecap=\"round\" stroke-linejoin=\"round\"" : "",
                        path_of(points));
  }
  void area(std::span<const Eigen::Vector2d> points, const std::string& colour, double opacity) override {
    if (points.size() < 3) return;
    out_ += fmt::format("<path fill=\"{}\" fill-opacity=\"{:g}\" d=\"{}Z\"/>\n", colour, opacity,
                        path_of(points));
  }
  void dot(const Eigen::Vector2d& centre, double radius, const std::string& colour) override {
    out_ += fmt::format("<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:g}\" fill=\"{}\"/>\n", centre.x(),
                        centre.y(), radius, colour);
  }
  void text(const Eigen::Vector2d& position, const std::string& text, const Lettering& lettering) override {
    const char* anchor = lettering.anchor == Anchor::start    ? "start"
                         : lettering.anchor == Anchor::middle ? "middle"
                                                              : "end";
    const auto place =
        lettering.upwards
            ? fmt::format("transform=\"translate({:.2f} {:.2f}) rotate(-90)\"", position.x(), position.y())
            : fmt::format("x=\"{:.2f}\" y=\"{:.2f}\"", position.x(), position.y());
    const char* halo =
        lettering.halo ? " class=\"halo\" paint-order=\"stroke\" stroke=\"#ffffff\" stroke-width=\"3\"" : "";
    out_ += fmt::format("<text {} font-size=\"{:g}\"{}{} text-anchor=\"{}\" fill=\"{}\">{}</text>\n", place,
                        lettering.size, lettering.bold ? " font-weight=\"bold\"" : "", halo, anchor,
                        lettering.colour, html_text(text));
  }
  Result<std::string> finish() override { return out_ + "</svg>\n"; }

 private:
  std::string out_;
};

}  // namespace

std::unique_ptr<Canvas> make_svg_canvas(double width, double height, const std::string& title) {
  return std::make_unique<SvgCanvas>(width, height, title);
}

}  // namespace kinemark::report
