// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/macaque/elbow_figures.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/stages/report/figures/space_drawing.h"
#include "kinemark/stages/skeleton/articulated/articulated.h"
#include "kinemark/stages/skeleton/functional/functional.h"
#include "studies/macaque/macaque_names.h"

namespace kinemark::studies {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using report::FigurePanel;
using report::SymbolShape;
using simulation::LimbRecording;

constexpr double kPerM = 1e3;    // mm
constexpr double kLeast = 0.01;  // shown: without noise SCoRE is right to rounding, which dwarfs all the rest
constexpr const char* kPaperInk = "#c0392b";

/// A curve over cells: what to show of each, NaN where there is nothing.
struct Curve {
  const char* name;
  const char* colour;
  std::function<double(const ElbowErrors&)> get;
  double width = 1.6;
  double least = 0.0;  // smaller values are left out
};

std::vector<Curve> curves() {
  return {{"bound", kBoundInk, [](const ElbowErrors& e) { return kPerM * e.ours.bound_m(); }, 5.0, kLeast},
          {"report's method", kReportInk,
           [](const ElbowErrors& e) { return kPerM * e.report.rms_answered_m(); }, 1.6, kLeast},
          {"SCoRE", kScoreInk, [](const ElbowErrors& e) { return kPerM * e.score.rms_answered_m(); }, 1.6,
           kLeast},
          {"ours", kOursInk, [](const ElbowErrors& e) { return kPerM * e.ours.rms_determined_m(); }, 1.6,
           kLeast}};
}

using Which = std::function<bool(const ElbowCell&)>;
using Along = std::function<double(const ElbowCell&)>;

/// One line of a panel over the cells that `which` chooses, x by `along`; named where it is the first of its
/// kind.
void draw(StudyFigure& out, FigurePanel& panel, const MacaqueStudy& study, const Curve& curve, const char* of,
          bool dashed, const Which& which, const Along& along) {
  std::vector<std::pair<double, double>> points;
  for (const auto& r : study.elbow)
    if (which(r.cell)) points.emplace_back(along(r.cell), curve.get(r.errors));
  std::erase_if(points, [&](const auto& p) { return !(p.second >= curve.least && std::isfinite(p.second)); });
  if (points.empty()) return;
  std::ranges::sort(points);
  const auto n = static_cast<Eigen::Index>(points.size());
  VectorXd x(n), y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    x[i] = points[static_cast<std::size_t>(i)].first;
    y[i] = points[static_cast<std::size_t>(i)].second;
    if (curve.width < 3.0 && !dashed)
      panel.symbols.push_back(
          {.shape = SymbolShape::disc, .name = "", .colour = curve.colour, .at = {x[i], y[i]}});
  }
  panel.lines.push_back({.name = dashed ? "" : curve.name,
                         .colour = curve.colour,
                         .x = x,
                         .y = y,
                         .width = curve.width,
                         .dashed = dashed});
  out.curves.push_back(curve_of(fmt::format("{}{}", curve.name, of), {x, y}));
}

void mark_paper(FigurePanel& panel, std::initializer_list<Eigen::Vector2d> at) {
  for (const auto& place : at)
    panel.symbols.push_back({.shape = SymbolShape::ring,
                             .name = &place == at.begin() ? "as published" : "",
                             .colour = kPaperInk,
                             .at = place});
  for (const auto& place : at) panel.room.push_back(place);
}

Vector3d at(const Array<double>& values, std::size_t index) {
  return Eigen::Map<const Vector3d>(values.data() + 3 * index);
}

/// Shoulder, elbow, wrist in black with a shadow, and the markers in the colours of their segments.
void draw_arm(report::SpaceDrawing& scene, const LimbRecording& limb, std::int64_t frame) {
  const auto f = static_cast<std::size_t>(frame);
  Matrix3Xd bones(3, 3);
  bones << Vector3d::Zero(), at(limb.centre_in_world, f), at(limb.end_in_world, f);
  scene.line(bones, {.colour = "#000000", .width = 5.0, .shadow = true});
  for (std::size_t s = 0; s < limb.layout.segments.size(); ++s)
    for (const int m : limb.layout.segments[s].markers)
      scene.dot(kSegmentInks[s % 2], limb.markers.x(frame, m), 5.0);
  scene.label("shoulder", Vector3d::Zero());
  scene.label("wrist", bones.col(2));
}

/// Rows of the table with these quantities that are there.
std::vector<FigureNumber> numbers_there(const StudyTable& table,
                                        std::initializer_list<std::string_view> wanted) {
  std::vector<std::string_view> there;
  for (const auto quantity : wanted)
    if (std::ranges::find(table.rows, quantity, &StudyRow::quantity) != table.rows.end())
      there.push_back(quantity);
  return numbers_of(table, there);
}

}  // namespace

StudyFigure elbow_errors(const MacaqueStudy& study, bool staggered) {
  StudyFigure out{.paper = kMacaque,
                  .number = staggered ? 0 : 6,
                  .name = staggered ? "error of the elbow, markers staggered by 20 mm"
                                    : "error of the elbow against noise and against missing data"};
  const auto of_kind = [&](const ElbowCell& c) { return (c.stagger_m > 0.0) == staggered; };
  FigurePanel noise{.title = "Noise (dashed: 40 % missing)",
                    .x_label = "noise per axis, mm",
                    .y_label = "error, RMS, mm",
                    .logarithmic = true};
  FigurePanel missing{.title = "Missing data (dashed: with the pose)",
                      .x_label = "missing samples, %",
                      .y_label = "error, RMS, mm",
                      .logarithmic = true};
  for (const auto& curve : curves()) {
    for (const double share : {0.0, 0.4})
      draw(
          out, noise, study, curve, share > 0.0 ? " against noise, 40 %" : " against noise", share > 0.0,
          [&](const ElbowCell& c) {
            return of_kind(c) && !c.pose_correlated && std::abs(c.missing - share) < 1e-9;
          },
          [](const ElbowCell& c) { return kPerM * c.noise_m; });
    for (const bool pose : {false, true})
      draw(
          out, missing, study, curve, pose ? " against missing, with the pose" : " against missing", pose,
          [&](const ElbowCell& c) {
            return of_kind(c) && (c.pose_correlated == pose || c.missing == 0.0) &&
                   std::abs(kPerM * c.noise_m - 1.0) < 1e-9;
          },
          [](const ElbowCell& c) { return 100.0 * c.missing; });
  }
  if (!staggered) {
    mark_paper(noise, {{2.0, 30.0}});
    mark_paper(missing, {{20.0, 10.16}, {40.0, 30.0}});
    out.figure.notes = {"Against missing data: 1 mm of noise."};
    out.numbers = numbers_there(study.table, {"collinear, 2 mm noise, 0 % missing: elbow",
                                              "collinear, 1 mm noise, 20 % missing: elbow"});
  }
  out.figure.columns = 2;
  out.figure.panel_height = 230.0;
  out.figure.panels = {noise, missing};
  return out;
}

StudyFigure published_errors(const MacaqueStudy& study) {
  StudyFigure out{.paper = kMacaque,
                  .number = 6,
                  .name = "mean error of the elbow against missing data, by the report's own reading"};
  FigurePanel panel{.x_label = "missing samples, %", .y_label = "mean error, mm"};
  const auto curve = [&](std::vector<double> PublishedResult::* method, const char* name,
                         const char* colour) {
    std::vector<double> share, value;
    for (const auto& cell : study.published) {
      const auto& errors = cell.*method;
      if (cell.cell.missing == 0.0 || errors.empty()) continue;
      share.push_back(100.0 * cell.cell.missing);
      value.push_back(kPerM * std::accumulate(errors.begin(), errors.end(), 0.0) /
                      static_cast<double>(errors.size()));
    }
    const auto n = static_cast<Eigen::Index>(share.size());
    const VectorXd x = Eigen::Map<const VectorXd>(share.data(), n),
                   y = Eigen::Map<const VectorXd>(value.data(), n);
    panel.lines.push_back({.name = name, .colour = colour, .x = x, .y = y, .width = 1.6});
    out.curves.push_back(curve_of(name, {x, y}));
  };
  curve(&PublishedResult::classic_m, "report's method", kReportInk);
  curve(&PublishedResult::ours_m, "ours", kOursInk);
  mark_paper(panel, {{20.0, 10.16}, {40.0, 30.0}});
  out.figure.panels.push_back(std::move(panel));
  for (const auto& row : study.table.rows)
    if (row.paper) out.numbers.push_back({row.quantity, row.unit, row.paper, row.classic, row.ours});
  return out;
}

StudyFigure frames_answered(const MacaqueStudy& study) {
  StudyFigure out{.paper = kMacaque,
                  .name = "frames with an answer, 1 mm of noise (dashed: markers staggered)"};
  FigurePanel panel{.x_label = "missing samples, %", .y_label = "frames, %"};
  const std::vector<Curve> shown{
      {"report's method, answered", kReportInk,
       [](const ElbowErrors& e) { return 100.0 * e.report.share_answered(); }},
      {"SCoRE, answered", kScoreInk, [](const ElbowErrors& e) { return 100.0 * e.score.share_answered(); }},
      {"ours, determined", kOursInk, [](const ElbowErrors& e) { return 100.0 * e.ours.share_determined(); }}};
  for (const auto& curve : shown)
    for (const bool staggered : {false, true})
      draw(
          out, panel, study, curve, staggered ? ", staggered" : "", staggered,
          [&](const ElbowCell& c) {
            return (c.stagger_m > 0.0) == staggered && !c.pose_correlated &&
                   std::abs(c.noise_m - 0.001) < 1e-9;
          },
          [](const ElbowCell& c) { return 100.0 * c.missing; });
  out.figure.panels.push_back(std::move(panel));
  return out;
}

Result<StudyFigure> simulated_arm(const MacaqueStudy& study, std::uint64_t seed) {
  const auto limb = simulation::simulate_chain(chain_options({.noise_m = 0.002, .frames = 400}, seed));
  if (!limb) return std::unexpected(limb.error());
  skeleton::FunctionalOptions classic;
  classic.method = skeleton::FunctionalMethod::constant_distance;
  const auto theirs = skeleton::find_joints(limb->markers, limb->layout, classic);
  if (!theirs) return std::unexpected(theirs.error());
  skeleton::ArticulatedOptions options;
  options.continuity = false;
  const auto ours = skeleton::fit_articulated(limb->markers, limb->layout, options);
  if (!ours) return std::unexpected(ours.error());
  // The frame whose error by the report's method is the median of all, so that it favours no method.
  std::vector<std::pair<double, std::int64_t>> errors;
  for (std::int64_t f = 0; f < limb->markers.frames(); ++f)
    if (theirs->centre(f, 0).allFinite())
      errors.emplace_back(
          (theirs->centre(f, 0) - at(limb->centre_in_world, static_cast<std::size_t>(f))).norm(), f);
  check(!errors.empty(), "the report's method answers frames of a complete recording");
  std::ranges::sort(errors);
  const auto frame = errors[errors.size() / 2].second;
  const Vector3d truth = at(limb->centre_in_world, static_cast<std::size_t>(frame)),
                 their_elbow = theirs->centre(frame, 0), our_elbow = ours->skeleton.centre(frame, 0);
  report::SpaceDrawing scene(35.0, 22.0);
  scene.floor(-0.20);
  draw_arm(scene, *limb, frame);
  Matrix3Xd apart(3, 2);
  apart << our_elbow, their_elbow;
  scene.line(apart, {.colour = kReportInk, .width = 1.3, .dashed = true});
  scene.dot(kReportInk, their_elbow, 7.0);
  scene.label("elbow by the report's method", their_elbow, report::Anchor::start, {12.0, 4.0});
  scene.dot(kOursInk, our_elbow, 7.0);
  scene.label("ours", our_elbow, report::Anchor::end, {-11.0, 4.0});
  StudyFigure out{.paper = kMacaque, .number = 5, .name = "the simulated arm, 2 mm of noise, and its elbow"};
  FigurePanel panel;
  panel.height = 330.0;
  panel.picture = [scene](report::Canvas& canvas, const report::CanvasRoom& room) {
    scene.draw(canvas, room);
  };
  out.figure.panels.push_back(std::move(panel));
  out.figure.notes = {
      fmt::format("Frame {} of {}, the one of median error: {:.1f} mm by the report's method (gold), {:.1f} "
                  "mm by ours (blue). "
                  "Squares of the floor: {:.0f} mm.",
                  frame + 1, limb->markers.frames(), kPerM * (their_elbow - truth).norm(),
                  kPerM * (our_elbow - truth).norm(), kPerM * scene.square())};
  out.numbers = numbers_there(study.table, {"collinear, 2 mm noise, 0 % missing: elbow"});
  out.curves = {curve_of("true elbow, m", Matrix3Xd(truth)),
                curve_of("elbow by the report's method, m", Matrix3Xd(their_elbow)),
                curve_of("elbow by ours, m", Matrix3Xd(our_elbow))};
  return out;
}

}  // namespace kinemark::studies
