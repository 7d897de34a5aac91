// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The macaque report's table: every row of `kinemark study macaque` on some seeds.
#include <fmt/core.h>

#include <string>
#include <vector>

#include "studies/macaque/study_macaque_job.h"
#include "support/acceptance.h"

namespace {

/// accept_studies macaque_study quick | all [SEEDS]   quick: few cells, one seed
int run_check(int argc, char** argv) {
  using namespace kinemark;
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  studies::MacaqueJob job;
  if (arguments.empty() || arguments.front() == "quick") {
    job.noise_mm = {1.0, 2.0};
    job.missing = {0.0, 0.2, 0.4};
    job.frames = 300;
    job.sleeve_noise_mm = {1.0};
    job.sleeve_s = 8.0;
  } else if (arguments.size() > 1) {
    job.seeds = studies::parse_seeds(arguments[1]).value();
  }
  const auto study = studies::study_macaque(job).value();
  for (const auto& row : study.table.rows) {
    std::string asked;
    if (row.at_least) asked += fmt::format(">= {:.4g} ", *row.at_least);
    if (row.at_most) asked += fmt::format("<= {:.4g} ", *row.at_most);
    std::string measured = fmt::format("{:.4g}", row.ours);
    if (row.expected) measured += fmt::format(", {} {:.4g}", to_string(row.expected_is), *row.expected);
    if (row.classic) measured += fmt::format(", classic {:.4g}", *row.classic);
    if (row.paper) measured += fmt::format(", paper {:.4g}", *row.paper);
    if (asked.empty())  // shares of a single seed have no bound, so none passes
      testing_support::print_note(row.quantity, measured + " " + row.unit);
    else
      testing_support::print_row(row.pass(), row.quantity, asked + row.unit, measured);
  }
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("macaque_study", run_check);

}  // namespace
