// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/report/figures/figure.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <span>

#include "kinemark/core/check.h"
#include "kinemark/stages/report/figures/canvas.h"
#include "kinemark/stages/report/figures/internal/legend.h"
#include "kinemark/stages/report/figures/internal/panel_drawing.h"

namespace kinemark::report {
namespace {

using internal::Legend;
using internal::PanelDrawing;

constexpr double kTitle = 34.0, kCaption = 30.0, kNoteLine = 14.0, kNoteSize = 11.0, kPanelNoteSize = 10.0,
                 kBeforeNotes = 6.0;
constexpr double kPlain = 210.0, kSquare = 400.0;  // heights of panels one below the other
constexpr double kBeside = 8.0;                    // left free beside a picture
constexpr double kPngScale = 3.0;
const std::string kTitleInk = "#1a1a1a", kCaptionInk = "#6b6b6b";

/// Room around the axes of a panel, and its letters.
struct Layout {
  double left = 72.0, right = 20.0, above = 26.0, below = 44.0, below_bare = 44.0;
  double title = 0.0, note = 0.0;              // lines above the axes
  double legend = 0.0, legend_to_axes = 16.0;  // more room where there is one; from its last line down
  double label_left = 18.0, label_below = 36.0, tick_size = 11.0, label_size = 12.0;
};
constexpr Layout kSingle;
constexpr Layout kGridded{.left = 50.0,
                          .right = 14.0,
                          .above = 14.0,
                          .below = 38.0,
                          .below_bare = 24.0,
                          .title = 15.0,
                          .note = 13.0,
                          .legend = 8.0,
                          .legend_to_axes = 4.0,
                          .label_left = 14.0,
                          .label_below = 31.0,
                          .tick_size = 10.0,
                          .label_size = 11.0};

// Letters of a panel's title: smaller where it is longer than its panel is wide.
double title_size(const std::string& title, double width) {
  constexpr double kSize = 12.0, kBold = 1.15;
  return std::min(kSize, kSize * width / (kBold * internal::text_width(title, kSize)));
}

/// Where rows of panels come to lie.
class FigureDrawing {
 public:
  explicit FigureDrawing(const Figure& figure)
      : figure_(figure),
        layout_(figure.columns > 1 ? kGridded : kSingle),
        cell_(figure.width / static_cast<double>(std::max<std::int64_t>(1, figure.columns))),
        keys_(figure.keys, figure.width - kSingle.right - title_left()) {
    check(figure.columns >= 1 && figure.width > 0.0, "a figure has a width and a column");
    for (const auto& note : figure.notes)
      for (auto& line : internal::broken_text(note, kNoteSize, figure.width - kSingle.right - title_left()))
        notes_.push_back(std::move(line));
  }

  [[nodiscard]] double height() const {
    double height = title_height() + keys_height() + (figure_.caption.empty() ? 8.0 : kCaption) +
                    (notes_.empty() ? 0.0 : kBeforeNotes) + kNoteLine * static_cast<double>(notes_.size());
    for (std::size_t i = 0; i < figure_.panels.size(); i += columns()) {
      const auto row = row_of(i);
      height += above(row) + inner(row) + below(row);
    }
    return height;
  }

  void draw(Canvas& canvas) const {
    if (!figure_.title.empty())
      canvas.text({title_left(), 22.0}, figure_.title, {.size = 14.0, .colour = kTitleInk});
    double top = title_height();
    keys_.draw(canvas, {title_left(), top + 10.0});
    top += keys_height();
    for (std::size_t i = 0; i < figure_.panels.size(); i += columns()) top = draw_row(canvas, row_of(i), top);
    if (!figure_.caption.empty()) {
      canvas.text({title_left(), top + 14.0}, figure_.caption, {.size = kNoteSize, .colour = kCaptionInk});
      top += kCaption - 10.0;
    }
    if (!notes_.empty()) top += kBeforeNotes;
    for (const auto& line : notes_) {
      canvas.text({title_left(), top + 10.0}, line, {.size = kNoteSize, .colour = kCaptionInk});
      top += kNoteLine;
    }
  }

 private:
  using Row = std::span<const FigurePanel>;

  [[nodiscard]] std::size_t columns() const { return static_cast<std::size_t>(figure_.columns); }
  [[nodiscard]] double title_left() const { return figure_.columns > 1 ? 14.0 : kSingle.left; }
  [[nodiscard]] double title_height() const { return figure_.title.empty() ? 6.0 : kTitle; }
  [[nodiscard]] double keys_height() const { return keys_.height() > 0.0 ? keys_.height() + 6.0 : 0.0; }
  [[nodiscard]] Row row_of(std::size_t first) const {
    return Row(figure_.panels).subspan(first, std::min(columns(), figure_.panels.size() - first));
  }
  [[nodiscard]] double panel_width() const { return cell_ - layout_.left - layout_.right; }
  [[nodiscard]] double legend_height(const FigurePanel& panel) const {
    return Legend(panel, panel_width()).height();
  }
  [[nodiscard]] std::vector<std::string> note_lines(const FigurePanel& panel) const {
    return internal::broken_text(panel.note, kPanelNoteSize, panel_width());
  }
  [[nodiscard]] static bool are_pictures(Row row) {
    return std::ranges::all_of(
        row, [](const FigurePanel& p) { return p.picture && p.title.empty() && p.note.empty(); });
  }
  [[nodiscard]] double above(Row row) const {
    if (are_pictures(row)) return kBeside;
    double legend = 0.0;
    bool title = false;
    std::size_t note = 0;  // lines
    for (const auto& panel : row) {
      legend = std::max(legend, legend_height(panel));
      title = title || !panel.title.empty();
      note = std::max(note, note_lines(panel).size());
    }
    return layout_.above + (legend > 0.0 ? legend + layout_.legend : 0.0) + (title ? layout_.title : 0.0) +
           layout_.note * static_cast<double>(note);
  }
  [[nodiscard]] double inner(Row row) const {
    const double own = std::ranges::max(row, {}, &FigurePanel::height).height;
    if (own > 0.0) return own;
    if (figure_.panel_height > 0.0) return figure_.panel_height;
    const bool equal = std::ranges::any_of(row, &FigurePanel::equal);
    if (figure_.columns > 1) return equal ? panel_width() : 0.6 * panel_width();
    return equal ? kSquare : kPlain;
  }
  [[nodiscard]] double below(Row row) const {
    if (are_pictures(row)) return kBeside;
    const bool labelled = std::ranges::any_of(row, [](const FigurePanel& p) { return !p.x_label.empty(); });
    return labelled ? layout_.below : layout_.below_bare;
  }

  double draw_row(Canvas& canvas, Row row, double top) const {
    const double axes = top + above(row);
    for (std::size_t c = 0; c < row.size(); ++c) {
      const auto& panel = row[c];
      if (panel.blank) continue;
      const double left = cell_ * static_cast<double>(c) + layout_.left;
      double line = top + layout_.above;
      if (!panel.title.empty() && layout_.title > 0.0) {
        canvas.text(
            {left, line + 5.0}, panel.title,
            {.size = title_size(panel.title, cell_ - layout_.left), .colour = kTitleInk, .bold = true});
        line += layout_.title;
      }
      if (layout_.note > 0.0)
        for (const auto& text : note_lines(panel)) {
          canvas.text({left, line + 3.0}, text, {.size = kPanelNoteSize, .colour = kCaptionInk});
          line += layout_.note;
        }
      Legend(panel, panel_width()).draw(canvas, {left, axes - legend_height(panel) - layout_.legend_to_axes});
      if (panel.picture) {
        panel.picture(canvas, {.left = cell_ * static_cast<double>(c) + kBeside,
                               .right = cell_ * static_cast<double>(c + 1) - kBeside,
                               .top = axes,
                               .bottom = axes + inner(row)});
        continue;
      }
      PanelDrawing(panel,
                   {.left = left,
                    .right = left + panel_width(),
                    .top = axes,
                    .bottom = axes + inner(row),
                    .label_left = cell_ * static_cast<double>(c) + layout_.label_left,
                    .label_below = layout_.label_below,
                    .tick_size = layout_.tick_size,
                    .label_size = layout_.label_size},
                   canvas)
          .draw();
    }
    return axes + inner(row) + below(row);
  }

  const Figure& figure_;
  Layout layout_;
  double cell_;
  Legend keys_;
  std::vector<std::string> notes_;
};

}  // namespace

std::string tint(std::string_view colour, double share) {
  std::string out = "#";
  for (std::size_t i = 1; i + 1 < colour.size() && i < 7; i += 2) {
    unsigned value = 0;
    (void)std::from_chars(colour.data() + i, colour.data() + i + 2, value, 16);
    out += fmt::format("{:02x}", std::lround(255.0 + std::clamp(share, 0.0, 1.0) * (value - 255.0)));
  }
  return out;
}

std::string figure_svg(const Figure& figure) {
  const FigureDrawing drawing(figure);
  const auto canvas = make_svg_canvas(figure.width, drawing.height(), figure.title);
  drawing.draw(*canvas);
  return *canvas->finish();
}

Result<std::string> figure_png(const Figure& figure) {
  const FigureDrawing drawing(figure);
  auto canvas = make_png_canvas(figure.width, drawing.height(), kPngScale);
  if (!canvas) return std::unexpected(canvas.error());
  drawing.draw(**canvas);
  return (*canvas)->finish();
}

}  // namespace kinemark::report
