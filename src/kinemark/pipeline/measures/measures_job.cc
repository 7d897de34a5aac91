// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/measures_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>
#include <utility>

#include "kinemark/io/file.h"
#include "kinemark/pipeline/files/edit_input.h"
#include "kinemark/pipeline/files/marker_input.h"
#include "kinemark/pipeline/files/marker_screening.h"
#include "kinemark/pipeline/files/page_file.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/measures/measure_figures.h"
#include "kinemark/pipeline/measures/measure_regions.h"
#include "kinemark/pipeline/measures/measures_page.h"
#include "kinemark/pipeline/measures/measures_table.h"
#include "kinemark/stages/analysis/path/path_measures.h"

namespace kinemark::pipeline {
namespace {

constexpr std::size_t kDefectsListed = 5;

Status check_output(const std::filesystem::path& output) {
  const auto ending = ending_of(output);
  if (output.empty() || ending == ".csv" || ending == ".json") return {};
  return fail(Code::usage, fmt::format("{}: measures are written as .csv or .json", output.string()));
}

// What the recorder made is no sample, what screening is sure of neither.
Status screen_trial(const MeasuresJob& job, data::Trial& trial, MeasuresOutcome& outcome) {
  const auto screening = screen_markers(
      trial,
      {.recorder_made = RecorderMade::mark, .find_defects = !job.keep_defects, .reject_defects = true});
  if (!screening) return std::unexpected(screening.error());
  const auto& sure = screening->sure;
  for (std::size_t i = 0; i < std::min(sure.size(), kDefectsListed); ++i)
    outcome.warnings.push_back("Left out: " + sentence_of(sure[i], trial.markers.time));
  if (sure.size() > kDefectsListed)
    outcome.warnings.push_back(
        fmt::format("Left out: {} more defects like these.", sure.size() - kDefectsListed));
  return {};
}

Result<std::vector<data::Region>> regions_of(const MeasuresJob& job, const data::Trial& trial,
                                             std::vector<data::Region> regions) {
  for (const auto& text : job.regions) {
    auto region = parse_region(text, trial.markers.time);
    if (!region) return std::unexpected(region.error());
    regions.push_back(std::move(*region));
  }
  for (const auto& label : job.between) {
    auto cycles = regions_between(label, trial);
    if (!cycles) return std::unexpected(cycles.error());
    std::ranges::move(*cycles, std::back_inserter(regions));
  }
  return regions;
}

// Edits, selection, screening; the regions to measure.
Result<std::vector<data::Region>> prepare(const MeasuresJob& job, data::Trial& trial,
                                          MeasuresOutcome& outcome) {
  auto taken = take_edits({.edits = job.edits,
                           .recording = job.input,
                           .force = job.force,
                           .seed = job.seed,
                           .threads = job.threads},
                          trial);
  if (!taken) return std::unexpected(taken.error());
  std::ranges::move(taken->notes, std::back_inserter(outcome.warnings));
  if (auto s = take_selection(job.selection, trial); !s) return std::unexpected(s.error());
  if (auto s = screen_trial(job, trial, outcome); !s) return std::unexpected(s.error());
  return regions_of(job, trial, std::move(taken->regions));
}

// Names of files that are told apart by more than the case of their letters.
void make_unique(std::vector<NamedFigure>& figures) {
  std::set<std::string> seen;
  for (auto& figure : figures) {
    std::string name = figure.name;
    const auto is_new = [&seen](std::string text) {
      std::ranges::transform(text, text.begin(),
                             [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
      return seen.insert(std::move(text)).second;
    };
    for (int number = 2; !is_new(name); ++number) name = fmt::format("{}_{}", figure.name, number);
    figure.name = std::move(name);
  }
}

Status write_figures(const MeasuresJob& job, const std::vector<std::string>& formats,
                     const std::vector<NamedFigure>& figures, MeasuresOutcome& outcome) {
  std::vector<std::string> names;
  std::vector<ResultFile> files;
  for (const auto& figure : figures)
    for (const auto& format : formats) {
      names.push_back(figure.name + "." + format);
      files.push_back(
          {.target = job.figures / names.back(),
           .write = [&figure, format](const std::filesystem::path& staged, const std::string&) -> Status {
             const auto content = figure_file(figure.figure, format);
             if (!content) return std::unexpected(content.error());
             return io::write_text(staged, *content, false);
           }});
    }
  auto staging = Staging::create_in(job.figures, names, job.force, {job.input, job.edits});
  if (!staging) return std::unexpected(staging.error());
  auto written = write_results(*staging, files, {}, "the figures");
  if (!written) return std::unexpected(written.error());
  std::ranges::move(*written, std::back_inserter(outcome.written));
  return {};
}

// The table, the figures, the page: what of them is asked for.
Status write_all(const MeasuresJob& job, const std::vector<std::string>& formats,
                 const std::vector<analysis::PathCurves>& curves, Staging& staging, PageFile& page,
                 MeasuresOutcome& outcome) {
  std::vector<NamedFigure> figures;
  for (const auto& one : curves) std::ranges::move(measure_figures(one), std::back_inserter(figures));
  make_unique(figures);
  if (!job.output.empty()) {
    const bool csv = ending_of(job.output) == ".csv";
    const auto file =
        csv ? text_file(job.output,
                        [&] { return measures_csv(outcome.measures, job.input.filename().string()); })
            : json_file(job.output, [&] { return measures_outcome_json(outcome); });
    auto written = write_results(staging, {file}, {}, "the measures");
    if (!written) return std::unexpected(written.error());
    outcome.written = std::move(*written);
  }
  if (!job.figures.empty())
    if (auto s = write_figures(job, formats, figures, outcome); !s) return s;
  if (page.wanted()) return page.write(measures_page(job, outcome, figures), outcome);
  return {};
}

}  // namespace

Result<MeasuresOutcome> run_measures(const MeasuresJob& job) {
  if (auto s = check_output(job.output); !s) return std::unexpected(s.error());
  if (auto s = job.selection.check(); !s) return std::unexpected(s.error());
  analysis::PathMeasureOptions options{.measures = job.measures,
                                       .refits = job.refits,
                                       .noise_sd_m = job.noise_sd_m,
                                       .level = job.level,
                                       .seed = job.seed,
                                       .threads = job.threads,
                                       .curves = !job.figures.empty() || !job.report.empty()};
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  const auto formats = parse_figure_formats(job.figure_formats);
  if (!formats) return std::unexpected(formats.error());
  auto staging =
      Staging::create(job.output.empty() ? std::vector<std::filesystem::path>{} : std::vector{job.output},
                      job.force, {job.input, job.edits});
  if (!staging) return std::unexpected(staging.error());
  auto page = PageFile::begin(job.report, {job.input, job.edits, job.output}, job.force);
  if (!page) return std::unexpected(page.error());
  auto input =
      read_marker_input({.path = job.input, .rate_hz = job.rate_hz, .needs_samples = true, .record = true});
  if (!input) return std::unexpected(input.error());
  MeasuresOutcome outcome;
  outcome.input = std::move(input->file);
  outcome.warnings = std::move(input->trial.warnings);
  const std::string name = job.input.string();
  auto regions = prepare(job, input->trial, outcome);
  if (!regions) return fail_at(name, regions.error());
  options.regions = std::move(*regions);
  auto measured = analysis::measure_paths(input->trial.markers, options);
  if (!measured) return fail_at(name, measured.error());
  if (measured->measures.empty())
    return fail(Code::bad_input,
                fmt::format("{}: nothing can be measured: {}", name,
                            measured->warnings.empty() ? "no measure applies" : measured->warnings.front()));
  outcome.measures = std::move(measured->measures);
  std::ranges::move(measured->warnings, std::back_inserter(outcome.warnings));
  if (auto s = write_all(job, *formats, measured->curves, *staging, *page, outcome); !s)
    return std::unexpected(s.error());
  return outcome;
}

nlohmann::ordered_json measures_outcome_json(const MeasuresOutcome& outcome) {
  nlohmann::ordered_json out;
  out["input"] = {{"path", outcome.input.path},
                  {"bytes", outcome.input.bytes},
                  {outcome.input.hash_kind, outcome.input.hash}};
  out["measures"] = measures_json(outcome.measures);
  out["written"] = nlohmann::ordered_json::array();
  for (const auto& path : outcome.written) out["written"].push_back(path.string());
  out["warnings"] = outcome.warnings;
  return out;
}

}  // namespace kinemark::pipeline
