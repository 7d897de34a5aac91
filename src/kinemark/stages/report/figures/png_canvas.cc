// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <cairo.h>
#include <fmt/core.h>

#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "kinemark/stages/report/figures/canvas.h"

namespace kinemark::report {
namespace {

constexpr double kMostDots = 20'000.0;  // a side

struct SurfaceEnd {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
struct ContextEnd {
  void operator()(cairo_t* context) const { cairo_destroy(context); }
};

// Red, green, blue of "#rrggbb", 0 to 1.
std::array<double, 3> channels(const std::string& colour) {
  unsigned value = 0;
  if (colour.size() == 7) (void)std::from_chars(colour.data() + 1, colour.data() + 7, value, 16);
  return {(value >> 16U & 255U) / 255.0, (value >> 8U & 255U) / 255.0, (value & 255U) / 255.0};
}

cairo_status_t append(void* closure, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(closure)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

class PngCanvas final : public Canvas {
 public:
  PngCanvas(double width, double height, double scale)
      : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::ceil(width * scale)),
                                            static_cast<int>(std::ceil(height * scale)))),
        context_(cairo_create(surface_.get())) {
    cairo_scale(context_.get(), scale, scale);
    cairo_set_source_rgb(context_.get(), 1.0, 1.0, 1.0);
    cairo_paint(context_.get());
    cairo_set_line_join(context_.get(), CAIRO_LINE_JOIN_ROUND);
  }

  void line(std::span<const Eigen::Vector2d> points, const Stroke& stroke) override {
    if (points.size() < 2) return;
    trace(points);
    const std::array dashes =
        stroke.dotted ? std::array{stroke.width, 2.0 * stroke.width} : std::array{6.0, 4.0};
    cairo_set_dash(context_.get(), dashes.data(), stroke.dashed || stroke.dotted ? 2 : 0, 0.0);
    cairo_set_line_cap(context_.get(), stroke.round ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
    cairo_set_line_join(context_.get(), stroke.round ? CAIRO_LINE_JOIN_ROUND : CAIRO_LINE_JOIN_MITER);
    cairo_set_line_width(context_.get(), stroke.width);
    set_colour(stroke.colour, 1.0);
    cairo_stroke(context_.get());
  }
  void area(std::span<const Eigen::Vector2d> points, const std::string& colour, double opacity) override {
    if (points.size() < 3) return;
    trace(points);
    cairo_close_path(context_.get());
    set_colour(colour, opacity);
    cairo_fill(context_.get());
  }
  void dot(const Eigen::Vector2d& centre, double radius, const std::string& colour) override {
    cairo_new_path(context_.get());
    cairo_arc(context_.get(), centre.x(), centre.y(), radius, 0.0, 2.0 * std::numbers::pi);
    set_colour(colour, 1.0);
    cairo_fill(context_.get());
  }
  void text(const Eigen::Vector2d& position, const std::string& text, const Lettering& lettering) override {
    cairo_t* c = context_.get();
    cairo_save(c);
    cairo_select_font_face(c, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           lettering.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(c, lettering.size);
    cairo_translate(c, position.x(), position.y());
    if (lettering.upwards) cairo_rotate(c, -0.5 * std::numbers::pi);
    cairo_text_extents_t extents;
    cairo_text_extents(c, text.c_str(), &extents);
    const double part = lettering.anchor == Anchor::start    ? 0.0
                        : lettering.anchor == Anchor::middle ? 0.5
                                                             : 1.0;
    if (lettering.halo) {
      constexpr double kRim = 3.0;
      cairo_move_to(c, -part * extents.x_advance, 0.0);
      cairo_text_path(c, text.c_str());
      set_colour("#ffffff", 1.0);
      cairo_set_dash(c, nullptr, 0, 0.0);
      cairo_set_line_width(c, kRim);
      cairo_stroke(c);
    }
    set_colour(lettering.colour, 1.0);
    cairo_move_to(c, -part * extents.x_advance, 0.0);
    cairo_show_text(c, text.c_str());
    cairo_restore(c);
  }
  Result<std::string> finish() override {
    std::string out;
    const auto status = cairo_surface_write_to_png_stream(surface_.get(), append, &out);
    const auto drawn = cairo_status(context_.get());
    if (status == CAIRO_STATUS_SUCCESS && drawn == CAIRO_STATUS_SUCCESS) return out;
    return fail(Code::io,
                fmt::format("the figure cannot be drawn: {}",
                            cairo_status_to_string(status == CAIRO_STATUS_SUCCESS ? drawn : status)));
  }

 private:
  void trace(std::span<const Eigen::Vector2d> points) {
    cairo_new_path(context_.get());
    for (const auto& point : points) cairo_line_to(context_.get(), point.x(), point.y());
  }
  void set_colour(const std::string& colour, double opacity) {
    const auto [red, green, blue] = channels(colour);
    cairo_set_source_rgba(context_.get(), red, green, blue, opacity);
  }

  std::unique_ptr<cairo_surface_t, SurfaceEnd> surface_;
  std::unique_ptr<cairo_t, ContextEnd> context_;
};

}  // namespace

Result<std::unique_ptr<Canvas>> make_png_canvas(double width, double height, double scale) {
  if (!(width > 0.0 && height > 0.0 && scale > 0.0) || std::max(width, height) * scale > kMostDots)
    return fail(Code::bad_input, fmt::format("a picture of {:g} by {:g} dots; need 1 to {:g}", width * scale,
                                             height * scale, kMostDots));
  return std::make_unique<PngCanvas>(width, height, scale);
}

}  // namespace kinemark::report
