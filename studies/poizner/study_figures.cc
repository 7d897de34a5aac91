// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/poizner/study_figures.h"

#include <fmt/core.h>

#include <cmath>
#include <iterator>

#include "kinemark/core/check.h"
#include "kinemark/math/statistics.h"
#include "studies/poizner/poizner_names.h"
#include "studies/poizner/rig_figures.h"
#include "studies/poizner/sign_figures.h"
#include "studies/poizner/wheel_figures.h"

namespace kinemark::studies {
namespace {

using Eigen::VectorXd;

// Largest error of a distance by how far the tree stood from the middle, over all rigs.
StudyFigure errors_by_distance(const std::vector<AsBuiltOutcome>& rigs) {
  constexpr double kStep_m = 0.1;
  StudyFigure out{.paper = kPoizner, .name = "errors of the tree's distances over the room"};
  report::FigurePanel panel{.x_label = "tree from the middle, mm", .y_label = "largest of three errors, mm"};
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
    const VectorXd x = Eigen::Map<const VectorXd>(at.data(), n),
                   y = Eigen::Map<const VectorXd>(value.data(), n);
    panel.lines.push_back({.name = name, .colour = colour, .x = x, .y = y});
    out.curves.push_back(curve_of(name, {x, y}));
  };
  curve(&AsBuiltOutcome::classic, 0.5, "1986 method, median", kClassicInk);
  curve(&AsBuiltOutcome::classic, 0.9, "1986 method, 90 %", "#a83232");
  curve(&AsBuiltOutcome::ours, 0.5, "ours, median", kOursInk);
  out.figure.panels.push_back(std::move(panel));
  return out;
}

StudyPage as_built_page(const PoiznerStudy& study) {
  return {
      .title = "Study: Poizner, Wooten and Salot 1986, as built",
      .heading = "The rig of 1986 as it may have been built",
      .description = fmt::format("{} {} with the faults that make the method of 1986 err as was reported.",
                                 study.as_built.size(), study.as_built.size() == 1 ? "rig" : "rigs"),
      .classic = "1986 method",
      .figures = {errors_by_distance(study.as_built)},
      .table = study.table};
}

}  // namespace

Result<StudyPage> study_page(const PoiznerStudy& study) {
  if (!study.as_built.empty()) return as_built_page(study);
  check(!study.seeds.empty(), "the page shows the first seed");
  const PoiznerSeed& seed = study.seeds.front();
  auto figures = rig_figures(seed.seed);
  if (!figures) return std::unexpected(figures.error());
  auto wheel = wheel_figures(study);
  std::ranges::move(wheel, std::back_inserter(*figures));
  figures->push_back(sign_figure(seed.arm));
  return StudyPage{.title = "Study: Poizner, Wooten and Salot 1986",
                   .heading = "The rig of 1986",
                   .description = fmt::format("Figures: rig {}. Table: {} {}.", seed.seed, study.seeds.size(),
                                              study.seeds.size() == 1 ? "rig" : "rigs"),
                   .classic = "1986 method",
                   .figures = std::move(*figures),
                   .table = study.table};
}

}  // namespace kinemark::studies
