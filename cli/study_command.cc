// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/macaque/macaque_figures.h"
#include "kinemark/pipeline/macaque/study_macaque_job.h"
#include "kinemark/pipeline/poizner/study_figures.h"
#include "kinemark/pipeline/poizner/study_poizner_job.h"
#include "kinemark/pipeline/study/study_page.h"
#include "kinemark/pipeline/study_taichi_job.h"
#include "kinemark/pipeline/taichi/taichi_figures.h"

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

struct TaiChiArguments {
  pipeline::TaiChiFiles files;
  std::string seeds, figures;
};

int run_tai_chi(const Globals& globals, TaiChiArguments& arguments) {
  arguments.files.threads = globals.threads;
  arguments.files.seeds = {globals.seed};
  if (!arguments.seeds.empty()) {
    if (!arguments.files.data.empty())
      return report_error({Code::usage, "--seeds draws simulated subjects; it does not go with --data"});
    auto parsed = pipeline::parse_seeds(arguments.seeds);
    if (!parsed) return report_error(parsed.error());
    arguments.files.seeds = std::move(*parsed);
  }
  const auto study = pipeline::run_study_taichi(arguments.files, show_progress(globals, "parts"));
  if (!study) return report_error(study.error());
  if (!study->recorded)
    say(globals, "note: no recording was named (--data); simulated subjects stand in for it");
  if (!arguments.figures.empty()) {
    const auto page = pipeline::taichi_page(*study);
    if (auto s = pipeline::write_study_page(page, arguments.figures, globals.force); !s)
      return report_error(s.error());
    say(globals, "wrote " + arguments.figures);
  }
  say(globals, pipeline::study_text(study->table));
  if (globals.json) fmt::print("{}\n", pipeline::study_json(study->table).dump(2));
  return study->table.pass() ? 0 : 1;
}

void add_tai_chi(CLI::App& command, const Globals& globals, Run& run) {
  auto* taichi = command.add_subcommand(
      "taichi", "Demircan, Sentis, De Sapio & Khatib 2008: tai chi by direct marker control");
  taichi->footer("The column 'classic' is least squares. Exit status 1 when a row fails.");
  const auto arguments = std::make_shared<TaiChiArguments>();
  taichi->add_option("--data", arguments->files.data,
                     "Recording of the 21 landmarks (taichi.v3d); simulated subjects when absent");
  taichi->add_option("--rate", arguments->files.rate_hz,
                     "Frame rate of a recording that tells none (.v3d), Hz; 179 when absent");
  taichi->add_option("--figures", arguments->figures, "Page with figures and the table to write, .html");
  taichi->add_option("--seeds", arguments->seeds,
                     "Subjects to simulate: 3, 1-10 or 1,4,7-9; that of --seed when absent");
  taichi->callback([&globals, arguments, &run] {
    run = [&globals, arguments] { return run_tai_chi(globals, *arguments); };
  });
}

int run_macaque(const Globals& globals, const std::string& seeds, const std::string& figures) {
  pipeline::MacaqueJob job;
  job.threads = globals.threads;
  job.seeds = {globals.seed};
  if (!seeds.empty()) {
    auto parsed = pipeline::parse_seeds(seeds);
    if (!parsed) return report_error(parsed.error());
    job.seeds = std::move(*parsed);
  }
  const auto study = pipeline::study_macaque(job, show_progress(globals, "recordings"));
  if (!study) return report_error(study.error());
  if (!figures.empty()) {
    const auto page = pipeline::macaque_page(*study);
    if (!page) return report_error(page.error());
    if (auto s = pipeline::write_study_page(*page, figures, globals.force); !s)
      return report_error(s.error());
    say(globals, "wrote " + figures);
  }
  say(globals, pipeline::study_text(study->table));
  if (globals.json) fmt::print("{}\n", pipeline::study_json(study->table).dump(2));
  return study->table.pass() ? 0 : 1;
}

void add_macaque(CLI::App& command, const Globals& globals, Run& run) {
  auto* macaque = command.add_subcommand(
      "macaque", "The macaque report's elbow (after Kirk, O'Brien & Forsyth 2005): noise x missing data");
  macaque->footer(
      "The column 'classic' is the report's method, or SCoRE where the row says so. Errors of all seeds are "
      "pooled. Exit status 1 when a row fails.");
  struct Arguments {
    std::string seeds, figures;
  };
  const auto arguments = std::make_shared<Arguments>();
  macaque->add_option("--figures", arguments->figures, "Page with figures and the table to write, .html");
  macaque->add_option("--seeds", arguments->seeds,
                      "Recordings of each cell: 3, 1-10 or 1,4,7-9; that of --seed when absent");
  macaque->callback([&globals, arguments, &run] {
    run = [&globals, arguments] { return run_macaque(globals, arguments->seeds, arguments->figures); };
  });
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
  add_macaque(*command, globals, run);
  add_tai_chi(*command, globals, run);
}

}  // namespace kinemark::cli
