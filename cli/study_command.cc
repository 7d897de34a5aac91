// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/console.h"
#include "kinemark/pipeline/files/json_text.h"
#include "studies/common/study_page.h"
#include "studies/macaque/macaque_figures.h"
#include "studies/macaque/study_macaque_job.h"
#include "studies/poizner/study_figures.h"
#include "studies/poizner/study_poizner_job.h"
#include "studies/taichi/study_taichi_job.h"
#include "studies/taichi/taichi_figures.h"

namespace kinemark::cli {
namespace {

/// Options common to all studies.
struct StudyArguments {
  std::string seeds, figures;
};

void add_options(CLI::App& command, StudyArguments& arguments, const std::string& seeds_are) {
  command.add_option(
      "--figures", arguments.figures,
      "Page to write, .html, with the paper's figures and the table; or a folder: the page, and every "
      "figure by the paper's number as .svg, .png and .csv");
  command.add_option("--seeds", arguments.seeds,
                     seeds_are + ": 3, 1-10 or 1,4,7-9; that of --seed when absent");
}

/// Run a study for its seeds, write its figures, print its table. The place of the figures is asked for
/// first, as a study takes minutes.
/// @param run      seeds in, Result of a study out
/// @param page_of  its page, a Result
template <class RunStudy, class PageOf>
int run_study(const CommonOptions& common, const StudyArguments& arguments, const RunStudy& run,
              const PageOf& page_of) {
  std::vector<std::uint64_t> seeds{common.seed};
  if (!arguments.seeds.empty()) {
    auto parsed = studies::parse_seeds(arguments.seeds);
    if (!parsed) return report_error(parsed.error());
    seeds = std::move(*parsed);
  }
  std::optional<studies::StudyFiles> files;
  if (!arguments.figures.empty()) {
    pipeline::JobSettings settings;
    settle(common, "", settings);
    auto created = studies::StudyFiles::create(arguments.figures, settings);
    if (!created) return report_error(created.error());
    files.emplace(std::move(*created));
  }
  const auto study = run(seeds);
  if (!study) return report_error(study.error());
  std::vector<std::filesystem::path> written;
  if (files) {
    const Result<studies::StudyPage> page = page_of(*study);
    if (!page) return report_error(page.error());
    auto done = files->write(*page);
    if (!done) return report_error(done.error());
    written = std::move(*done);
  }
  print_result(common.json ? pipeline::json_text(studies::study_json(study->table)) + "\n"
                           : studies::study_text(study->table));
  if (const auto missed = studies::missed_text(study->table); common.json && !missed.empty())
    say(common, missed);
  for (const auto& path : written) say(common, "wrote " + path.string());
  return study->table.pass() ? 0 : 1;
}

struct PoiznerArguments : StudyArguments {
  bool as_built = false;
};

int run_poizner(const CommonOptions& common, const PoiznerArguments& arguments) {
  return run_study(
      common, arguments,
      [&](const std::vector<std::uint64_t>& seeds) {
        return studies::study_poizner(
            {.seeds = seeds, .as_built = arguments.as_built, .threads = common.threads},
            show_progress(common, "rigs"));
      },
      studies::study_page);
}

void add_poizner(CLI::App& command, const CommonOptions& common, Run& run) {
  auto* poizner =
      command.add_subcommand("poizner", "Poizner, Wooten & Salot 1986: still tree, wheel, signing arm");
  poizner->footer("The worst of all rigs is held against each bound. Exit status 1 when a row fails.");
  const auto arguments = std::make_shared<PoiznerArguments>();
  add_options(*poizner, *arguments, "Rigs to draw");
  poizner->add_flag(
      "--as-built", arguments->as_built,
      "Rigs with faults that make the method of 1986 err as was reported; a dozen seeds show it");
  poizner->callback(
      [&common, arguments, &run] { run = [&common, arguments] { return run_poizner(common, *arguments); }; });
}

struct MacaqueArguments : StudyArguments {
  bool as_published = false;
};

int run_macaque(const CommonOptions& common, const MacaqueArguments& arguments) {
  return run_study(
      common, arguments,
      [&](const std::vector<std::uint64_t>& seeds) {
        studies::MacaqueJob job;
        job.seeds = seeds;
        job.threads = common.threads;
        job.as_published = arguments.as_published;
        return studies::study_macaque(job, show_progress(common, "recordings"));
      },
      studies::macaque_page);
}

void add_macaque(CLI::App& command, const CommonOptions& common, Run& run) {
  auto* macaque = command.add_subcommand(
      "macaque", "The macaque report's elbow (after Kirk, O'Brien & Forsyth 2005): noise x missing data");
  macaque->footer(
      "The column 'classic' is the report's method, or SCoRE where the row says so. Errors of all seeds are\n"
      "pooled. About a minute a seed on one core. Exit status 1 when a row fails.");
  const auto arguments = std::make_shared<MacaqueArguments>();
  add_options(*macaque, *arguments, "Recordings of each cell");
  macaque->add_flag("--as-published", arguments->as_published,
                    "The report's method alone, by the reading that its numbers need; forty seeds show it");
  macaque->callback(
      [&common, arguments, &run] { run = [&common, arguments] { return run_macaque(common, *arguments); }; });
}

struct TaiChiArguments : StudyArguments {
  studies::TaiChiFiles files;
};

int run_tai_chi(const CommonOptions& common, const TaiChiArguments& arguments) {
  if (!arguments.seeds.empty() && !arguments.files.data.empty())
    return report_error({Code::usage, "--seeds draws simulated subjects; it does not go with --data"});
  return run_study(
      common, arguments,
      [&](const std::vector<std::uint64_t>& seeds) {
        auto files = arguments.files;
        files.threads = common.threads;
        files.seeds = seeds;
        if (files.data.empty())
          say(common, "note: no recording was named (--data); simulated subjects stand in for it");
        return studies::run_study_taichi(files, show_progress(common, "parts"));
      },
      [](const studies::TaiChiStudy& study) -> Result<studies::StudyPage> {
        return studies::taichi_page(study);
      });
}

void add_tai_chi(CLI::App& command, const CommonOptions& common, Run& run) {
  auto* taichi = command.add_subcommand(
      "taichi", "Demircan, Sentis, De Sapio & Khatib 2008: tai chi by direct marker control");
  taichi->footer(
      "The column 'classic' is least squares. One to two minutes a subject on one core. Exit status 1 when "
      "a\n"
      "row fails.");
  const auto arguments = std::make_shared<TaiChiArguments>();
  taichi->add_option("--data", arguments->files.data,
                     "Recording of the 21 landmarks (taichi.v3d); simulated subjects when absent");
  taichi
      ->add_option("--rate", arguments->files.rate_hz,
                   "Frame rate of a recording that stores none (.v3d), Hz; 179 when absent")
      ->check(CLI::PositiveNumber);
  add_options(*taichi, *arguments, "Subjects to simulate");
  taichi->callback(
      [&common, arguments, &run] { run = [&common, arguments] { return run_tai_chi(common, *arguments); }; });
}

}  // namespace

void add_study(CLI::App& app, const CommonOptions& common, Run& run) {
  auto* command = app.add_subcommand("study", "The founding papers' tables beside ours");
  command->require_subcommand(1);
  add_poizner(*command, common, run);
  add_macaque(*command, common, run);
  add_tai_chi(*command, common, run);
}

}  // namespace kinemark::cli
