// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/macaque/macaque_figures.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/check.h"
#include "kinemark/core/html_text.h"
#include "kinemark/stages/skeleton/articulated/articulated.h"
#include "kinemark/stages/skeleton/functional/functional.h"
#include "studies/common/svg_plot.h"
#include "studies/common/svg_scene.h"

namespace kinemark::studies {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using simulation::LimbRecording;

constexpr const char* kReport = "#b8860b";
constexpr const char* kScore = "#2e8b57";
constexpr const char* kOurs = "#1f5fa8";
constexpr const char* kBound = "#888888";
constexpr double kPerM = 1e3;    // mm
constexpr double kLeast = 0.01;  // shown: without noise SCoRE is right to rounding, which dwarfs all the rest

/// A paragraph below a picture.
std::string paragraph(const std::string& text) { return fmt::format("<p>{}</p>", html_text(text)); }

/// A curve over cells: what to show of each, NaN where there is nothing.
struct Curve {
  const char* name;
  const char* colour;
  std::function<double(const ElbowErrors&)> get;
  bool dots;
  double least = 0.0;  // smaller values are left out
};

std::array<Curve, 4> curves() {
  return {
      {{"report", kReport, [](const ElbowErrors& e) { return kPerM * e.report.rms_answered_m(); }, true,
        kLeast},
       {"SCoRE", kScore, [](const ElbowErrors& e) { return kPerM * e.score.rms_answered_m(); }, true, kLeast},
       {"bound", kBound, [](const ElbowErrors& e) { return kPerM * e.ours.bound_m(); }, false, kLeast},
       {"ours", kOurs, [](const ElbowErrors& e) { return kPerM * e.ours.rms_determined_m(); }, true,
        kLeast}}};
}

/// One line of a plot over the cells that `which` chooses, x by `along`.
void draw(SvgPlot& plot, const MacaqueStudy& study, const Curve& curve, const std::string& of, bool dashed,
          const std::function<bool(const ElbowCell&)>& which,
          const std::function<double(const ElbowCell&)>& along) {
  std::vector<std::pair<double, double>> points;
  for (const auto& r : study.elbow)
    if (which(r.cell)) points.emplace_back(along(r.cell), curve.get(r.errors));
  std::erase_if(points, [&](const auto& p) { return !(p.second >= curve.least && std::isfinite(p.second)); });
  if (points.empty()) return;
  std::ranges::sort(points);
  const auto n = static_cast<Eigen::Index>(points.size());
  Eigen::VectorXd x(n), y(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    x[i] = points[static_cast<std::size_t>(i)].first;
    y[i] = points[static_cast<std::size_t>(i)].second;
  }
  plot.line(fmt::format("{}{}", curve.name, of), curve.colour, x, y, curve.dots ? 1.6 : 4.0, dashed);
  if (curve.dots) plot.dots(curve.colour, x, y);
}

StudyFigure against_noise(const MacaqueStudy& study, bool staggered) {
  SvgPlot plot("Error of the elbow against noise", "noise of a marker, per axis, mm",
               "error of the elbow, RMS, mm");
  plot.logarithmic_y();
  for (const auto& curve : curves())
    for (const double missing : {0.0, 0.4})
      draw(
          plot, study, curve, missing > 0.0 ? ", 40 %" : "", missing > 0.0,
          [&](const ElbowCell& c) {
            return (c.stagger_m > 0.0) == staggered && !c.pose_correlated &&
                   std::abs(c.missing - missing) < 1e-9;
          },
          [](const ElbowCell& c) { return kPerM * c.noise_m; });
  return {
      fmt::format("Figure 6, {}: error against noise", staggered ? "markers staggered" : "markers collinear"),
      plot.svg() + paragraph("Nothing missing, and 40 % (dashed).")};
}

StudyFigure against_missing(const MacaqueStudy& study, bool staggered, double noise_mm) {
  SvgPlot plot("Error of the elbow against missing data", "missing samples, %",
               "error of the elbow, RMS, mm");
  plot.logarithmic_y();
  for (const auto& curve : curves())
    for (const bool pose : {false, true})
      draw(
          plot, study, curve, pose ? ", with the pose" : "", pose,
          [&](const ElbowCell& c) {
            return (c.stagger_m > 0.0) == staggered && (c.pose_correlated == pose || c.missing == 0.0) &&
                   std::abs(kPerM * c.noise_m - noise_mm) < 1e-9;
          },
          [](const ElbowCell& c) { return 100.0 * c.missing; });
  return {fmt::format("Figure 7, {}: error against missing data",
                      staggered ? "markers staggered" : "markers collinear"),
          plot.svg() + paragraph(fmt::format(
                           "{} mm of noise; losses uniform, and going with the pose (dashed).", noise_mm))};
}

StudyFigure shares(const MacaqueStudy& study) {
  SvgPlot plot("Frames with an answer", "missing samples, %", "frames, %");
  const std::array<Curve, 3> shown{
      {{"report, answered", kReport, [](const ElbowErrors& e) { return 100.0 * e.report.share_answered(); },
        true},
       {"SCoRE, answered", kScore, [](const ElbowErrors& e) { return 100.0 * e.score.share_answered(); },
        true},
       {"ours, determined", kOurs, [](const ElbowErrors& e) { return 100.0 * e.ours.share_determined(); },
        true}}};
  for (const auto& curve : shown)
    for (const bool staggered : {false, true})
      draw(
          plot, study, curve, staggered ? ", staggered" : "", staggered,
          [&](const ElbowCell& c) {
            return (c.stagger_m > 0.0) == staggered && !c.pose_correlated &&
                   std::abs(c.noise_m - 0.001) < 1e-9;
          },
          [](const ElbowCell& c) { return 100.0 * c.missing; });
  return {"Frames with an answer",
          plot.svg() + paragraph("1 mm of noise; markers collinear, and staggered (dashed).")};
}

Vector3d at(const Array<double>& values, std::size_t index) {
  return Eigen::Map<const Vector3d>(values.data() + 3 * index);
}

/// Shoulder, elbow, wrist in black with a shadow, and the markers that were seen in colour; hollow: not seen.
void draw_arm(SvgScene& scene, const LimbRecording& limb, std::int64_t frame) {
  constexpr std::array<const char*, 2> kColours{"#d2691e", "#7b3fa0"};
  const auto f = static_cast<std::size_t>(frame);
  Matrix3Xd bones(3, 3);
  bones << Vector3d::Zero(), at(limb.centre_in_world, f), at(limb.end_in_world, f);
  scene.line("#000", bones, 5.0, true);
  for (std::size_t s = 0; s < limb.layout.segments.size(); ++s)
    for (const int m : limb.layout.segments[s].markers) {
      const bool seen = limb.markers.present(frame, m);
      const Vector3d x =
          seen ? Vector3d(limb.markers.x(frame, m)) : at(limb.x_true, limb.markers.index(frame, m));
      scene.dot(kColours[s % 2], x, seen ? 4.5 : 3.0, !seen);
    }
}

Result<StudyFigure> arm_picture(std::uint64_t seed) {
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
  SvgScene scene("The report's arm", 35.0, 22.0);
  scene.floor(-0.20);
  draw_arm(scene, *limb, frame);
  scene.dot(kReport, theirs->centre(frame, 0), 7.0);
  scene.label("elbow by the report's method", theirs->centre(frame, 0));
  scene.dot(kOurs, ours->skeleton.centre(frame, 0), 7.0);
  const Vector3d truth = at(limb->centre_in_world, static_cast<std::size_t>(frame));
  return StudyFigure{
      "The report's arm",
      scene.svg() +
          paragraph(fmt::format(
              "Collinear markers, 2 mm of noise, frame {} of {}, the one of median error: the elbow is "
              "{:.1f} mm off by "
              "the report's method (gold) and {:.1f} mm by ours (blue). Squares of the floor: {:.0f} mm.",
              frame + 1, limb->markers.frames(), kPerM * (theirs->centre(frame, 0) - truth).norm(),
              kPerM * (ours->skeleton.centre(frame, 0) - truth).norm(), kPerM * scene.square()))};
}

Result<StudyFigure> sleeve_picture(std::uint64_t seed) {
  const auto limb = simulation::simulate_sleeve(sleeve_options({.duration_s = 8.0}, seed));
  if (!limb) return std::unexpected(limb.error());
  // Lowest and highest wrist, and half-way between them.
  std::vector<std::pair<double, std::int64_t>> heights;
  for (std::int64_t f = 0; f < limb->markers.frames(); ++f)
    heights.emplace_back(at(limb->end_in_world, static_cast<std::size_t>(f)).z(), f);
  const auto [low, high] = std::ranges::minmax(heights);
  const double middle = 0.5 * (low.first + high.first);
  const auto halfway =
      std::ranges::min(heights, {}, [&](const auto& h) { return std::abs(h.first - middle); });
  SvgScene scene("The sleeve", 40.0, 18.0);
  scene.floor(-0.24);
  Matrix3Xd path(3, limb->markers.frames());
  for (std::int64_t f = 0; f < limb->markers.frames(); ++f)
    path.col(f) = at(limb->end_in_world, static_cast<std::size_t>(f));
  scene.line("#9ec3e6", path, 1.0);
  for (const auto frame : {low.second, halfway.second, high.second}) draw_arm(scene, *limb, frame);
  scene.label("shoulder", Vector3d::Zero());
  scene.label("at the food", path.col(low.second));
  scene.label("at the mouth", path.col(high.second));
  return StudyFigure{
      "The sleeve",
      scene.svg() +
          paragraph(fmt::format(
              "A monkey's arm reaching for food, on the way, and at the mouth. LEDs that the cameras see are "
              "full, the others hollow; blue: the wrist's path. Squares of the floor: {:.0f} mm.",
              kPerM * scene.square()))};
}

// Mean error against the share missing, of less than 1 mm of noise.
std::string published_curve(const std::vector<PublishedResult>& cells) {
  SvgPlot plot("Mean error against missing data, less than 1 mm of noise", "missing, %", "mean error, mm");
  const auto curve = [&](std::vector<double> PublishedResult::* method, const char* name,
                         const char* colour) {
    std::vector<double> at, value;
    for (const auto& cell : cells) {
      const auto& errors = cell.*method;
      if (cell.cell.missing == 0.0 || errors.empty()) continue;
      at.push_back(100.0 * cell.cell.missing);
      value.push_back(1e3 * std::accumulate(errors.begin(), errors.end(), 0.0) /
                      static_cast<double>(errors.size()));
    }
    const auto n = static_cast<Eigen::Index>(at.size());
    plot.line(name, colour, Eigen::Map<const Eigen::VectorXd>(at.data(), n),
              Eigen::Map<const Eigen::VectorXd>(value.data(), n));
  };
  curve(&PublishedResult::classic_m, "report's method", kReport);
  curve(&PublishedResult::ours_m, "ours", kOurs);
  return plot.svg();
}

}  // namespace

Result<StudyPage> macaque_page(const MacaqueStudy& study) {
  if (!study.published.empty())
    return StudyPage{.title = "Study: the macaque report's elbow, as published",
                     .heading = "The macaque report's elbow as published",
                     .description = fmt::format(
                         "{} recordings of each cell, by the reading that the report's numbers need.",
                         study.table.seeds.size()),
                     .classic = "report's method",
                     .figures = {{"Mean error against missing data", published_curve(study.published)}},
                     .table = study.table};
  check(!study.table.seeds.empty(), "the page shows the first seed");
  const auto seed = study.table.seeds.front();
  StudyPage page{
      .title = "Study: joint centres of a macaque's arm",
      .heading = "The elbow of a macaque",
      .description = fmt::format(
          "Where is the elbow, when only markers on the skin are seen? Curves and table: {} recording{} a "
          "cell. Single frames: seed {}. Bound: Cramer-Rao, in the frames called determined.",
          study.table.seeds.size(), study.table.seeds.size() == 1 ? "" : "s", seed),
      .classic = "report's method",
      .figures = {},
      .table = study.table};
  for (const bool staggered : {false, true}) page.figures.push_back(against_noise(study, staggered));
  for (const bool staggered : {false, true}) page.figures.push_back(against_missing(study, staggered, 1.0));
  auto arm = arm_picture(seed);
  if (!arm) return std::unexpected(arm.error());
  page.figures.push_back(std::move(*arm));
  auto sleeve = sleeve_picture(seed);
  if (!sleeve) return std::unexpected(sleeve.error());
  page.figures.push_back(std::move(*sleeve));
  page.figures.push_back(shares(study));
  return page;
}

}  // namespace kinemark::studies
