// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/poizner/study_figures.h"
#include "kinemark/pipeline/poizner/study_poizner_job.h"

namespace kinemark::cli {
namespace {

int run_poizner(const Globals& globals, const std::string& seeds, const std::string& figures) {
  pipeline::PoiznerJob job;
  job.threads = globals.threads;
  if (seeds.empty()) {
    job.seeds = {globals.seed};
  } else {
    auto parsed = pipeline::parse_seeds(seeds);
    if (!parsed) return report_error(parsed.error());
    job.seeds = std::move(*parsed);
  }
  const auto study = pipeline::study_poizner(job, show_progress(globals, "rigs"));
  if (!study) return report_error(study.error());
  if (!figures.empty()) {
    if (auto s = pipeline::write_study_page(pipeline::study_page(*study), figures, globals.force); !s)
      return report_error(s.error());
    say(globals, "wrote " + figures);
  }
  say(globals, pipeline::study_text(study->table));
  if (globals.json) fmt::print("{}\n", pipeline::study_json(study->table).dump(2));
  return study->table.pass() ? 0 : 1;
}

}  // namespace

void add_study(CLI::App& app, const Globals& globals, Run& run) {
  auto* command = app.add_subcommand("study", "The founding papers' tables beside ours");
  command->require_subcommand(1);
  auto* poizner =
      command->add_subcommand("poizner", "Poizner, Wooten & Salot 1986: still tree, wheel, signing arm");
  poizner->footer("The worst of all rigs is held against each bound. Exit status 1 when a row fails.");
  struct Arguments {
    std::string seeds, figures;
  };
  const auto arguments = std::make_shared<Arguments>();
  poizner->add_option("--figures", arguments->figures, "Page with figures and the table to write, .html");
  poizner->add_option("--seeds", arguments->seeds,
                      "Rigs to draw: 3, 1-10 or 1,4,7-9; that of --seed when absent");
  poizner->callback([&globals, arguments, &run] {
    run = [&globals, arguments] { return run_poizner(globals, arguments->seeds, arguments->figures); };
  });
}

}  // namespace kinemark::cli
