// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/study_figures.h"

#include <fmt/core.h>

#include <array>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/math/statistics.h"
#include "studies/common/svg_plot.h"
#include "studies/poizner/wheel_measures.h"

namespace kinemark::studies {
namespace {

using Eigen::Matrix3Xd;
using Eigen::VectorXd;

constexpr double kRate_hz = 100.0;  // of every scenario
constexpr const char* kClassic = "#b8860b";
constexpr const char* kOurs = "#1f5fa8";
constexpr const char* kTruth = "#888888";

VectorXd times(Eigen::Index frames) {
  return VectorXd::LinSpaced(frames, 0.0, static_cast<double>(frames - 1) / kRate_hz);
}

VectorXd row_mm(const Matrix3Xd& path, int axis) { return 1e3 * path.row(axis).transpose(); }

/// Two-point central differences; the ends are left out.
Matrix3Xd rates(const Matrix3Xd& path) {
  Matrix3Xd out = Matrix3Xd::Constant(3, path.cols(), std::nan(""));
  for (Eigen::Index f = 1; f + 1 < path.cols(); ++f)
    out.col(f) = 0.5 * kRate_hz * (path.col(f + 1) - path.col(f - 1));
  return out;
}

std::string wheel_plane(const WheelOutcome& wheel) {
  SvgPlot plot("Wheel in its best-fit plane", "first axis of the plane, mm", "second axis of the plane, mm",
               true);
  const PlaneView ours = best_fit_plane(wheel.our_path);
  // Both on our plane, each about its own centre.
  const Matrix3Xd classic = wheel.classic_path.colwise() - wheel.classic_path.rowwise().mean();
  const Eigen::Matrix2Xd old = ours.axes.leftCols<2>().transpose() * classic;
  plot.line("1986", kClassic, 1e3 * old.row(0).transpose(), 1e3 * old.row(1).transpose());
  plot.line("ours", kOurs, 1e3 * ours.in_plane.row(0).transpose(), 1e3 * ours.in_plane.row(1).transpose());
  plot.box(1e3 * ours.in_plane.rowwise().minCoeff(), 1e3 * ours.in_plane.rowwise().maxCoeff());
  const Eigen::Vector2d extent =
      1e3 * (ours.in_plane.rowwise().maxCoeff() - ours.in_plane.rowwise().minCoeff());
  return plot.svg() +
         fmt::format("<p>Box {:.1f} x {:.1f} mm; the wheel has 392 mm.</p>", extent.x(), extent.y());
}

std::string wheel_displacement(const WheelOutcome& wheel) {
  SvgPlot plot("Displacement of the wheel's LED", "time, s", "displacement, mm");
  constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  constexpr std::array<const char*, 3> kColours{"#1f5fa8", "#2e8b57", "#a83232"};
  const VectorXd t = times(wheel.our_path.cols());
  for (int a = 0; a < 3; ++a) {
    const auto i = static_cast<std::size_t>(a);
    plot.line(kNames[i], kColours[i], t, row_mm(wheel.our_path, a));
  }
  return plot.svg();
}

std::string arm_paths(const ArmOutcome& arm) {
  SvgPlot plot("Paths of the arm, seen from the cameras", "x, mm", "y, mm", true);
  constexpr std::array<const char*, 4> kColours{"#666666", "#2e8b57", "#a83232", "#1f5fa8"};
  for (std::size_t led = 0; led < arm.our_paths.size(); ++led)
    plot.line(arm.leds[led].name, kColours[led % kColours.size()], row_mm(arm.our_paths[led].position, 0),
              row_mm(arm.our_paths[led].position, 1));
  return plot.svg();
}

std::string hand_curve(const char* title, const char* y_label, const Matrix3Xd& truth, const Matrix3Xd& ours,
                       const Matrix3Xd& classic) {
  SvgPlot plot(title, "time, s", y_label);
  const VectorXd t = times(ours.cols());
  const auto size = [](const Matrix3Xd& v) { return VectorXd(v.colwise().norm().transpose()); };
  plot.line("1986", kClassic, t, size(classic));
  plot.line("truth", kTruth, t, size(truth), 2.5);
  plot.line("ours", kOurs, t, size(ours));
  return plot.svg();
}

// Largest error of a distance by how far the tree stood from the middle, over all rigs.
std::string errors_by_distance(const std::vector<AsBuiltOutcome>& rigs) {
  constexpr double kStep_m = 0.1;
  SvgPlot plot("Errors of the tree's distances over the room", "tree from the middle, mm",
               "largest of three errors, mm");
  const auto curve = [&](AsBuiltMeasures AsBuiltOutcome::* method, double share, const char* name,
                         const char* colour) {
    std::vector<double> at, value;
    for (double from = 0.0; from < 0.7; from += kStep_m) {
      std::vector<double> errors;
      for (const auto& rig : rigs)
        for (std::size_t k = 0; k < rig.from_middle_m.size(); ++k)
          if (rig.from_middle_m[k] >= from && rig.from_middle_m[k] < from + kStep_m)
            errors.push_back(1e3 * (rig.*method).worst_distance_m[k]);
      std::erase_if(errors, [](double e) { return std::isnan(e); });
      if (errors.empty()) continue;
      at.push_back(1e3 * (from + 0.5 * kStep_m)), value.push_back(math::quantile(errors, share));
    }
    const auto n = static_cast<Eigen::Index>(at.size());
    plot.line(name, colour, Eigen::Map<const VectorXd>(at.data(), n),
              Eigen::Map<const VectorXd>(value.data(), n));
  };
  curve(&AsBuiltOutcome::classic, 0.5, "1986, median", kClassic);
  curve(&AsBuiltOutcome::classic, 0.9, "1986, 90 %", "#a83232");
  curve(&AsBuiltOutcome::ours, 0.5, "ours, median", kOurs);
  return plot.svg();
}

StudyPage as_built_page(const PoiznerStudy& study) {
  return {
      .title = "Study: Poizner, Wooten and Salot 1986, as built",
      .heading = "The rig of 1986 as it may have been built",
      .description = fmt::format("{} {} with the faults that make the method of 1986 err as was reported.",
                                 study.as_built.size(), study.as_built.size() == 1 ? "rig" : "rigs"),
      .classic = "1986 method",
      .figures = {{"Errors of the tree's distances over the room", errors_by_distance(study.as_built)}},
      .table = study.table};
}

}  // namespace

StudyPage study_page(const PoiznerStudy& study) {
  if (!study.as_built.empty()) return as_built_page(study);
  check(!study.seeds.empty(), "the page shows the first seed");
  const PoiznerSeed& seed = study.seeds.front();
  const ArmOutcome& arm = seed.arm;
  const std::size_t hand = arm.our_paths.size() - 1;
  const Matrix3Xd classic_velocity = rates(arm.classic_paths[hand]);
  StudyPage out{.title = "Study: Poizner, Wooten and Salot 1986",
                .heading = "The rig of 1986",
                .description = fmt::format("Figures: rig {}. Table: {} {}.", seed.seed, study.seeds.size(),
                                           study.seeds.size() == 1 ? "rig" : "rigs"),
                .classic = "1986 method",
                .figures = {},
                .table = study.table};
  for (int wheel = 0; wheel < 2; ++wheel)
    out.figures.push_back({fmt::format("{}, best-fit plane", wheel_name(wheel)),
                           wheel_plane(seed.wheels[static_cast<std::size_t>(wheel)])});
  out.figures.push_back({"Wheel at 8 deg, displacement", wheel_displacement(seed.wheels.front())});
  out.figures.push_back({"Arm signing LOOK-AT[Continuative]", arm_paths(arm)});
  out.figures.push_back(
      {"Speed of the hand", hand_curve("Speed of the hand", "speed, m/s", arm.true_velocity[hand],
                                       arm.our_paths[hand].velocity, classic_velocity)});
  out.figures.push_back(
      {"Acceleration of the hand",
       hand_curve("Acceleration of the hand", "acceleration, m/s²", arm.true_acceleration[hand],
                  arm.our_paths[hand].acceleration, rates(classic_velocity))});
  return out;
}

}  // namespace kinemark::studies
