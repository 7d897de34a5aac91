// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/clean/internal/clean_output.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <iterator>
#include <utility>

#include "kinemark/core/version.h"
#include "kinemark/io/markers/lost_parts.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/stages/trajectory/smoothing/hand_on.h"

namespace kinemark::pipeline::internal {
namespace {

std::string or_found(double value, const char* unit) {
  return value > 0.0 ? fmt::format("{:g} {}", value, unit) : "found from the data";
}

io::NwbMetadata metadata_of(const CleanJob& job, const data::Trial& trial, const report::CleanRun& run) {
  io::NwbMetadata metadata;
  metadata.session_description = "cleaned marker trajectories of " + trial.source;
  metadata.version = run.version;
  metadata.command = run.command_line;
  metadata.options = run.options;
  metadata.seed = job.seed;
  for (const auto& input : run.inputs) metadata.sources.push_back({input.path, input.bytes, input.hash});
  return metadata;
}

bool keeps_unfiltered(const CleanJob& job, const data::Trajectories& markers) {
  return job.keep_unfiltered &&
         (job.filter.method != trajectory::FilterMethod::none || !markers.unfiltered_in_world.empty());
}

io::NwbOutline outline_of(const data::Trajectories& markers, bool derivatives, bool unfiltered) {
  io::NwbOutline outline;
  outline.names = markers.names;
  outline.time = markers.time;
  outline.method = outline.covariance = outline.filters = true;
  outline.unfiltered = unfiltered;
  outline.velocity = outline.velocity_sd = outline.acceleration = outline.acceleration_sd = outline.jerk =
      outline.jerk_sd = derivatives;
  if (!markers.sample_offset_s.empty())
    outline.offsets = markers.sample_offset_s.size() == markers.names.size()
                          ? io::NwbOutline::Offsets::per_marker
                          : io::NwbOutline::Offsets::per_sample;
  return outline;
}

void fill_unknown(Array<double>& values, std::size_t size) {
  if (values.empty()) values.assign(size, kNaN);
}

/// What the outline promises must be there, be it unknown; what it does not must not.
void fit_outline(MarkerPiece& piece, bool derivatives, bool unfiltered) {
  const auto frames = static_cast<std::size_t>(piece.markers.frames());
  fill_unknown(piece.markers.covariance, 6 * frames);
  if (unfiltered) fill_unknown(piece.markers.unfiltered_in_world, 3 * frames);
  auto& d = piece.derivatives;
  for (auto* values : {&d.velocity, &d.velocity_sd, &d.acceleration, &d.acceleration_sd, &d.jerk, &d.jerk_sd})
    if (derivatives)
      fill_unknown(*values, 3 * frames);
    else
      values->clear();
}

/// Put one marker into the whole recording.
void merge(const data::Trajectories& one, std::int64_t m, bool with_covariance, data::Trajectories& all) {
  const bool covariance = with_covariance && !one.covariance.empty();
  const bool unfiltered = !one.unfiltered_in_world.empty();
  if (!one.filters.empty()) {
    if (all.filters.empty())
      all.filters.assign(all.names.size(),
                         {.method = "none", .order = 0, .cutoff_hz = kNaN, .noise_sd_m = kNaN});
    all.filters[static_cast<std::size_t>(m)] = one.filters.front();
  }
  if (unfiltered) fill_unknown(all.unfiltered_in_world, all.x_in_world.size());
  if (covariance) fill_unknown(all.covariance, 6 * static_cast<std::size_t>(all.frames() * all.markers()));
  for (std::int64_t f = 0; f < all.frames(); ++f) {
    all.x(f, m) = one.x(f, 0);
    all.state[all.index(f, m)] = one.state[static_cast<std::size_t>(f)];
    if (const auto by = one.made_by(f, 0); !by.empty()) all.set_method(f, m, by);
    if (covariance)
      std::copy_n(one.covariance.data() + 6 * f, 6, all.covariance.data() + 6 * all.index(f, m));
    if (unfiltered)
      std::copy_n(one.unfiltered_in_world.data() + 3 * f, 3,
                  all.unfiltered_in_world.data() + 3 * all.index(f, m));
  }
}

}  // namespace

report::CleanRun describe_run(const CleanJob& job, const data::Trial& trial) {
  report::CleanRun run;
  run.trial = job.input.filename().string();
  run.gap_method = trajectory::to_string(job.gaps.method);
  run.filter_method = trajectory::to_string(job.filter.method);
  run.version = kVersion;
  run.command_line = job.command_line;
  run.seed = job.seed;
  run.threads = job.threads;
  run.warnings = trial.warnings;
  const auto& filter = job.filter;
  run.options = {{"gaps", run.gap_method},
                 {"longest gap filled", fmt::format("{:g} s", job.gaps.max_gap_s)},
                 {"largest SD filled", fmt::format("{:g} mm", 1e3 * job.gaps.max_sd_m)},
                 {"filter", run.filter_method},
                 {"order", filter.order > 0 ? std::to_string(filter.order) : "found from the data"},
                 {"cut-off", or_found(filter.cutoff_hz, "Hz")},
                 {"marker noise", or_found(1e3 * filter.noise_sd_m, "mm")},
                 {"samples that the recorder made", std::string(to_string(job.recorder_made))},
                 {"exchanged labels", job.exchange_back ? "exchanged back" : "told"},
                 {"defects", job.drops_doubtful(false) ? "rejected" : "told"},
                 {"derivatives", job.derivatives ? "written" : "not written"}};
  if (filter.method == trajectory::FilterMethod::butterworth) {
    run.options.emplace_back("cut-off rule", trajectory::to_string(filter.cutoff_rule));
    run.options.emplace_back("cut-off of both passes together", filter.correct_cutoff ? "yes" : "no");
  }
  return run;
}

bool is_nwb(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::ranges::transform(ending, ending.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return ending == ".nwb";
}

MarkerPiece::MarkerPiece(trajectory::MarkerResult result, const data::Trajectories& from) {
  const auto m = result.marker;
  markers.names = {from.names[static_cast<std::size_t>(m)]};
  markers.time = from.time;
  markers.x_in_world = std::move(result.x);
  markers.state = std::move(result.state);
  markers.covariance = std::move(result.covariance);
  for (std::int64_t f = 0; f < from.frames(); ++f) {
    if (!markers.present(f, 0)) continue;
    if (!from.made_by(f, m).empty())
      markers.set_method(f, 0, from.made_by(f, m));
    else if (!from.present(f, m))
      markers.set_method(f, 0, result.account.used.method);
  }
  if (from.sample_offset_s.size() == from.names.size()) {
    markers.sample_offset_s.assign(1, from.sample_offset_s[static_cast<std::size_t>(m)]);
  } else if (!from.sample_offset_s.empty()) {
    for (std::int64_t f = 0; f < from.frames(); ++f)
      markers.sample_offset_s.push_back(from.sample_offset_s[from.index(f, m)]);
  }
  derivatives.velocity = std::move(result.velocity);
  derivatives.velocity_sd = std::move(result.velocity_sd);
  derivatives.acceleration = std::move(result.acceleration);
  derivatives.acceleration_sd = std::move(result.acceleration_sd);
  derivatives.jerk = std::move(result.jerk);
  derivatives.jerk_sd = std::move(result.jerk_sd);
  derivatives.filters = {result.account.used};
  trajectory::hand_on(from, m, result.account.used, markers, 0);
}

DerivativesTable::DerivativesTable(const data::Trajectories& markers) {
  table_.name = "derivatives";
  for (const std::string& name : markers.names)
    for (const char* order : {"_v", "_a", "_j"})
      for (const char* axis : {"x", "y", "z"})
        for (const char* sd : {"", "_sd"}) table_.columns.push_back(name + order + axis + sd);
  for (std::int64_t f = 0; f < markers.frames(); ++f) table_.time_s.push_back(markers.time.time_s(f));
  fill_unknown(table_.values, table_.columns.size() * table_.time_s.size());
}

void DerivativesTable::add(const data::Derivatives& derivatives, std::int64_t marker) {
  const std::array<const Array<double>*, 6> all = {&derivatives.velocity,     &derivatives.velocity_sd,
                                                   &derivatives.acceleration, &derivatives.acceleration_sd,
                                                   &derivatives.jerk,         &derivatives.jerk_sd};
  const std::size_t first = 18 * static_cast<std::size_t>(marker), width = table_.columns.size();
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (all[k]->empty()) continue;
    for (std::size_t f = 0; f < table_.time_s.size(); ++f)
      for (std::size_t axis = 0; axis < 3; ++axis)
        table_.values[f * width + first + 6 * (k / 2) + 2 * axis + k % 2] = (*all[k])[3 * f + axis];
  }
}

CleanOutput::CleanOutput(const CleanJob& job, std::filesystem::path file, const data::Trajectories& smoothed)
    : derivatives_(job.derivatives),
      unfiltered_(keeps_unfiltered(job, smoothed)),
      file_(std::move(file)),
      cleaned_(data::Trajectories::all_missing(smoothed.names, smoothed.time)) {
  cleaned_.sample_offset_s = smoothed.sample_offset_s;
  if (derivatives_ && !is_nwb(file_)) table_.emplace(smoothed);
}

Result<CleanOutput> CleanOutput::create(const CleanJob& job, const std::filesystem::path& file,
                                        const data::Trial& smoothed, const report::CleanRun& run) {
  CleanOutput output(job, file, smoothed.markers);
  if (!is_nwb(file)) return output;
  auto writer = io::NwbWriter::create(file, outline_of(smoothed.markers, job.derivatives, output.unfiltered_),
                                      metadata_of(job, smoothed, run), {.beside = &smoothed.beside});
  if (!writer) return std::unexpected(writer.error());
  output.nwb_.emplace(std::move(*writer));
  return output;
}

Status CleanOutput::take(MarkerPiece piece, std::int64_t marker) {
  if (!unfiltered_) piece.markers.unfiltered_in_world.clear();
  merge(piece.markers, marker, !nwb_, cleaned_);
  if (table_) table_->add(piece.derivatives, marker);
  if (!nwb_) return {};
  fit_outline(piece, derivatives_, unfiltered_);
  return nwb_->write(piece.markers, &piece.derivatives, 0);
}

Status CleanOutput::finish_nwb(const data::Trial& trial, const std::string& set,
                               std::vector<std::string>& lost) {
  if (auto s = nwb_->write_signals(trial); !s) return s;
  std::ranges::move(io::lost_in(*io::written_format(".nwb"), trial), std::back_inserter(lost));
  return nwb_->commit(set);
}

Status CleanOutput::finish(data::Trial& trial, const std::filesystem::path& derivatives,
                           const std::string& set, std::vector<std::string>& lost) {
  trial.markers = std::move(cleaned_);
  if (auto s = nwb_ ? finish_nwb(trial, set, lost) : io::write_markers(file_, trial, false, set, &lost); !s)
    return s;
  return table_ ? table_file(derivatives, [this] { return table_->table(); }).write(derivatives, set)
                : Status{};
}

}  // namespace kinemark::pipeline::internal
