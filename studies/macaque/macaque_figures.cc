// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/macaque/macaque_figures.h"

#include <fmt/core.h>

#include <iterator>
#include <utility>

#include "kinemark/core/check.h"
#include "studies/macaque/elbow_figures.h"
#include "studies/macaque/macaque_names.h"
#include "studies/macaque/recording_figures.h"

namespace kinemark::studies {

Result<StudyPage> macaque_page(const MacaqueStudy& study) {
  check(!study.table.seeds.empty(), "the page shows the first seed");
  const auto seed = study.table.seeds.front();
  if (!study.published.empty())
    return StudyPage{.title = "Study: the macaque report's elbow, as published",
                     .heading = "The macaque report's elbow as published",
                     .description = fmt::format(
                         "{} recordings of each cell, by the reading that the report's numbers need.",
                         study.table.seeds.size()),
                     .classic = "report's method",
                     .figures = {published_errors(study)},
                     .table = study.table};
  auto figures = recording_figures(seed);
  if (!figures) return std::unexpected(figures.error());
  auto arm = simulated_arm(study, seed);
  if (!arm) return std::unexpected(arm.error());
  auto recorded = recorded_arm(seed);
  if (!recorded) return std::unexpected(recorded.error());
  figures->push_back(std::move(*arm));
  figures->push_back(elbow_errors(study, false));
  figures->push_back(std::move(*recorded));
  figures->push_back(elbow_errors(study, true));
  figures->push_back(frames_answered(study));
  return StudyPage{
      .title = "Study: joint centres of a macaque's arm",
      .heading = "The elbow of a macaque",
      .description = fmt::format(
          "Where is the elbow, when only markers on the skin are seen? Curves and table: {} recording{} a "
          "cell. Single recordings: seed {}. Bound: Cramer-Rao, in the frames called determined.",
          study.table.seeds.size(), study.table.seeds.size() == 1 ? "" : "s", seed),
      .classic = "report's method",
      .figures = std::move(*figures),
      .table = study.table};
}

}  // namespace kinemark::studies
