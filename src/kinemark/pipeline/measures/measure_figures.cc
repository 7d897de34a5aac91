// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measure_figures.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/version.h"
#include "kinemark/pipeline/measures/measures_table.h"
#include "kinemark/stages/report/figures/canvas.h"
#include "kinemark/stages/report/result_report.h"

namespace kinemark::pipeline {
namespace {

using analysis::PathCurves;
using report::Figure;
using report::FigurePanel;

constexpr double kMm = 1e3;
constexpr int kCyclePoints = 101;
constexpr std::size_t kMostCycles = 60;  // drawn
const std::string kBlue{report::kFigureColours[0]}, kRed{report::kFigureColours[1]},
    kGreen{report::kFigureColours[2]};
const std::string kGrey = "#8a8a8a";

std::string file_part(const std::string& name) {
  std::string out;
  for (const char c : name)
    out += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.' || c == '_' || c == '-' ? c : '_';
  return out.starts_with('.') ? "_" + out : out;
}

std::string title_of(const PathCurves& curves) {
  const double end = curves.start_s + static_cast<double>(curves.speed.size() - 1) / curves.rate_hz;
  return fmt::format("{}{}, {:.3f} to {:.3f} s", curves.subject,
                     curves.region.empty() ? "" : fmt::format(", {}", curves.region), curves.start_s, end);
}

std::string caption_of(const PathCurves& curves) {
  const auto missing = std::ranges::count(curves.measured, false);
  return fmt::format("smoothed to {:.3g} Hz{}", curves.cut_off_hz,
                     missing > 0 ? fmt::format("; {} of {} samples were not measured (grey)", missing,
                                               curves.measured.size())
                                 : "");
}

// Where samples were measured, or where they were not with one sample beside; NaN elsewhere.
Eigen::VectorXd part_of(const Eigen::VectorXd& values, const std::vector<bool>& measured, bool want) {
  Eigen::VectorXd out = Eigen::VectorXd::Constant(values.size(), kNaN);
  const auto n = static_cast<std::size_t>(values.size());
  for (std::size_t i = 0; i < n; ++i) {
    const bool beside = !want && ((i > 0 && !measured[i - 1]) || (i + 1 < n && !measured[i + 1]));
    if (measured[i] == want || beside)
      out[static_cast<Eigen::Index>(i)] = values[static_cast<Eigen::Index>(i)];
  }
  return out;
}

// A curve, grey where nothing was measured.
void add_curve(FigurePanel& panel, const std::string& name, const std::string& colour,
               const Eigen::VectorXd& x, const Eigen::VectorXd& y, const std::vector<bool>& measured) {
  panel.lines.push_back({.name = name, .colour = colour, .x = x, .y = part_of(y, measured, true)});
  if (std::ranges::count(measured, false) > 0)
    panel.lines.push_back({.colour = kGrey, .x = x, .y = part_of(y, measured, false)});
}

void add_extent(FigurePanel& panel, const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const double left = x.minCoeff(), right = x.maxCoeff(), low = y.minCoeff(), high = y.maxCoeff();
  Eigen::VectorXd around(5), beside(5);
  around << left, right, right, left, left;
  beside << low, low, high, high, low;
  panel.lines.push_back({.name = fmt::format("extent {:.4g} x {:.4g} mm", right - left, high - low),
                         .colour = kGrey,
                         .x = around,
                         .y = beside,
                         .width = 1.0,
                         .dashed = true});
}

// The axes from the mean, two standard deviations to each side.
void add_axes(FigurePanel& panel, const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const auto half = [](const Eigen::VectorXd& v) {
    return 2.0 * std::sqrt(v.squaredNorm() / static_cast<double>(v.size()));
  };
  const Eigen::Vector2d none = Eigen::Vector2d::Zero();
  panel.lines.push_back({.name = "first axis",
                         .colour = kRed,
                         .x = Eigen::Vector2d(-half(x), half(x)),
                         .y = none,
                         .width = 1.2});
  panel.lines.push_back({.name = "second axis",
                         .colour = kGreen,
                         .x = none,
                         .y = Eigen::Vector2d(-half(y), half(y)),
                         .width = 1.2});
}

NamedFigure path_figure(const PathCurves& curves, const std::string& stem) {
  const Eigen::VectorXd x = kMm * curves.along.col(0), y = kMm * curves.along.col(1),
                        z = kMm * curves.along.col(2);
  FigurePanel plane{
      .x_label = "along the first axis (mm)", .y_label = "along the second axis (mm)", .equal = true};
  add_extent(plane, x, y);
  add_axes(plane, x, y);
  add_curve(plane, "path", kBlue, x, y, curves.measured);
  FigurePanel height{.x_label = "along the first axis (mm)", .y_label = "from the plane (mm)"};
  add_curve(height, "", kBlue, x, z, curves.measured);
  return {stem + "_path",
          {.title = title_of(curves) + ": path in its best-fit plane",
           .caption = caption_of(curves),
           .panels = {plane, height}}};
}

void add_spread(FigurePanel& panel, const Eigen::VectorXd& x, const Eigen::VectorXd& y,
                const Eigen::VectorXd& sd) {
  if (sd.size() != y.size()) return;
  const Eigen::VectorXd low = y - sd, high = y + sd;
  panel.bands.push_back({.name = "1 SD", .colour = kBlue, .x = x, .low = low, .high = high});
}

NamedFigure speed_figure(const PathCurves& curves, const std::string& stem) {
  const auto n = curves.speed.size();
  const Eigen::VectorXd t = Eigen::VectorXd::LinSpaced(
      n, curves.start_s, curves.start_s + static_cast<double>(n - 1) / curves.rate_hz);
  FigurePanel speed{.x_label = "time (s)", .y_label = "speed (mm/s)"};
  FigurePanel acceleration{.x_label = "time (s)", .y_label = "acceleration (mm/s\u00b2)"};
  const Eigen::VectorXd v = kMm * curves.speed, a = kMm * curves.acceleration;
  add_spread(speed, t, v, kMm * curves.speed_sd);
  add_spread(acceleration, t, a, kMm * curves.acceleration_sd);
  add_curve(speed, "tangential velocity", kBlue, t, v, curves.measured);
  add_curve(acceleration, "tangential acceleration", kBlue, t, a, curves.measured);
  std::vector<report::FigureMark> marks;
  if (std::isfinite(curves.window.onset_s))
    marks.push_back({.name = "onset", .x = curves.start_s + curves.window.onset_s});
  if (std::isfinite(curves.window.end_s))
    marks.push_back({.name = "end", .x = curves.start_s + curves.window.end_s});
  if (curves.cycles.size() <= kMostCycles)
    for (const double start : curves.cycles) marks.push_back({.x = curves.start_s + start});
  speed.marks = acceleration.marks = marks;
  return {stem + "_speed",
          {.title = title_of(curves) + ": speed and acceleration",
           .caption = caption_of(curves),
           .panels = {speed, acceleration}}};
}

// A curve from one instant to another at equal shares of the way, by straight lines between samples.
Eigen::VectorXd normalised(const Eigen::VectorXd& values, double first, double last) {
  Eigen::VectorXd out(kCyclePoints);
  for (int p = 0; p < kCyclePoints; ++p) {
    const double at = std::clamp(first + (last - first) * p / (kCyclePoints - 1.0), 0.0,
                                 static_cast<double>(values.size() - 1));
    const auto below = std::min(static_cast<Eigen::Index>(at), values.size() - 2);
    out[p] = std::lerp(values[below], values[below + 1], at - static_cast<double>(below));
  }
  return out;
}

FigurePanel cycles_panel(const PathCurves& curves, const Eigen::VectorXd& values, const std::string& label) {
  const Eigen::VectorXd percent = Eigen::VectorXd::LinSpaced(kCyclePoints, 0.0, 100.0);
  FigurePanel out{.x_label = "cycle (%)", .y_label = label};
  const std::size_t cycles = curves.cycles.size() - 1;
  Eigen::MatrixXd all(kCyclePoints, static_cast<Eigen::Index>(cycles));
  for (std::size_t c = 0; c < cycles; ++c)
    all.col(static_cast<Eigen::Index>(c)) =
        normalised(values, curves.cycles[c] * curves.rate_hz, curves.cycles[c + 1] * curves.rate_hz);
  const Eigen::VectorXd mean = all.rowwise().mean();
  const Eigen::VectorXd sd =
      ((all.colwise() - mean).rowwise().squaredNorm() / static_cast<double>(cycles - 1)).cwiseSqrt();
  const Eigen::VectorXd low = mean - sd, high = mean + sd;
  out.bands.push_back(
      {.name = "1 SD between cycles", .colour = kBlue, .x = percent, .low = low, .high = high});
  for (std::size_t c = 0; c < std::min(cycles, kMostCycles); ++c)
    out.lines.push_back(
        {.colour = "#b5b5b5", .x = percent, .y = all.col(static_cast<Eigen::Index>(c)), .width = 0.7});
  out.lines.push_back({.name = fmt::format("mean of {} cycles", cycles),
                       .colour = kBlue,
                       .x = percent,
                       .y = mean,
                       .width = 2.0});
  return out;
}

NamedFigure cycles_figure(const PathCurves& curves, const std::string& stem) {
  return {stem + "_cycles",
          {.title = title_of(curves) + ": cycles",
           .caption = caption_of(curves),
           .panels = {cycles_panel(curves, kMm * curves.along.col(0), "along the first axis (mm)"),
                      cycles_panel(curves, kMm * curves.speed, "speed (mm/s)")}}};
}

// Values that a reader must not take at their face.
std::vector<report::Notice> remarks(const std::vector<data::Measure>& measures, bool determined) {
  std::vector<report::Notice> out;
  for (const auto& measure : measures)
    if (!measure.remark.empty() && std::isfinite(measure.value) == determined)
      out.push_back(
          {.about = "measure",
           .subject = measure.subject,
           .text = fmt::format("{}{}: {}: {}.", measure.subject.empty() ? "Walking" : measure.subject,
                               measure.region.empty() ? "" : ", " + measure.region, title_of_measure(measure),
                               measure.remark)});
  return out;
}

// What the page is of, and what its rows are of.
struct Headings {
  const char* page;
  const char* rows;
};

Headings headings(workflow::MeasuresOf of) {
  switch (of) {
    case workflow::MeasuresOf::walking:
      return {.page = "Walking and force plates", .rows = "Walking or plate"};
    case workflow::MeasuresOf::muscles:
      return {.page = "Electromyograms", .rows = "Channel"};
    case workflow::MeasuresOf::paths:
      return {.page = "Paths of markers", .rows = "Marker"};
    case workflow::MeasuresOf::everything:
      break;
  }
  return {.page = "All measures of a recording", .rows = "Marker, plate or channel"};
}

}  // namespace

std::vector<NamedFigure> measure_figures(const PathCurves& curves) {
  const std::string stem =
      file_part(curves.subject) + (curves.region.empty() ? "" : "_" + file_part(curves.region));
  std::vector<NamedFigure> out{path_figure(curves, stem), speed_figure(curves, stem)};
  if (curves.cycles.size() > 2) out.push_back(cycles_figure(curves, stem));
  return out;
}

Result<std::vector<std::string>> parse_figure_formats(const std::string& text) {
  std::vector<std::string> out;
  if (text.empty()) {
    out.emplace_back("svg");
    if (report::make_png_canvas(1.0, 1.0, 1.0)) out.emplace_back("png");
    return out;
  }
  for (std::size_t begin = 0; begin <= text.size();) {
    const auto end = std::min(text.find(',', begin), text.size());
    const auto word = text.substr(begin, end - begin);
    if (word != "svg" && word != "png")
      return fail(Code::usage, fmt::format("--figure-formats: '{}' is none of {}", word, kFigureFormats));
    if (std::ranges::find(out, word) == out.end()) out.push_back(word);
    begin = end + 1;
  }
  if (std::ranges::find(out, "png") != out.end())
    if (const auto canvas = report::make_png_canvas(1.0, 1.0, 1.0); !canvas)
      return std::unexpected(canvas.error());
  return out;
}

Result<std::string> figure_file(const report::Figure& figure, const std::string& format) {
  if (format == "png") return report::figure_png(figure);
  return report::figure_svg(figure);
}

std::string measures_page(const MeasuresJob& job, const MeasuresOutcome& outcome,
                          const std::vector<NamedFigure>& figures, const nlohmann::ordered_json& neural) {
  report::ResultReport out{.kind = "measures",
                           .trial = job.input.filename().string(),
                           .version = std::string(kVersion),
                           .command_line = job.command_line,
                           .inputs = inputs_of(outcome)};
  report::add_remarks(out.groups, outcome.warnings);
  report::add_group(out.groups, report::Verdict::attention, "measure", "measure not determined",
                    "measures not determined", remarks(outcome.measures, false));
  report::add_group(out.groups, report::Verdict::good, "measure", "remark on a measure",
                    "remarks on measures", remarks(outcome.measures, true));
  std::set<std::string> markers, regions;
  double not_measured = 0.0;
  for (const auto& measure : outcome.measures) {
    if (!measure.subject.empty()) markers.insert(measure.subject);
    regions.insert(measure.region);
    not_measured = std::max(not_measured, measure.share_not_measured);
  }
  out.result["heading"] = headings(job.of).page;
  out.result["rows"] = headings(job.of).rows;
  out.result["markers"] = markers.size();
  out.result["regions"] = regions.size();
  out.result["level"] = job.level;
  out.result["refits"] = job.refits;
  out.result["most_not_measured"] = not_measured;
  out.result["measures"] = measures_json(outcome.measures);
  for (std::size_t i = 0; i < outcome.measures.size(); ++i) {
    auto& row = out.result["measures"][i];
    row["title"] = title_of_measure(outcome.measures[i]);
    if (outcome.measures[i].subject.empty()) row["subject"] = "Walking";
    row["shown"] = shown_value(outcome.measures[i]);
  }
  out.result["figures"] = nlohmann::ordered_json::array();
  for (const auto& figure : figures) {
    auto drawn = figure.figure;
    const std::string caption = std::exchange(drawn.title, {});  // the page writes it above the drawing
    out.result["figures"].push_back(
        {{"name", figure.name}, {"caption", caption}, {"body", report::figure_svg(drawn)}});
  }
  if (!neural.is_null()) out.result["neural"] = neural;
  return report::result_report_html(out);
}

}  // namespace kinemark::pipeline
