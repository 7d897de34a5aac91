// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/measures/many_measures_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <iterator>
#include <memory>
#include <mutex>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <system_error>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/measures/measured_recording.h"
#include "kinemark/pipeline/measures/measures_nwb.h"
#include "kinemark/pipeline/measures/measures_table.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

// What is made of one recording alone.
Status check_many(const ManyMeasuresJob& job) {
  const auto alone = [](const char* option, const fs::path& path) {
    return fail(Code::usage,
                fmt::format("{} {}: is made of one recording; give one alone", option, path.string()));
  };
  if (!job.figures.empty()) return alone("--figures", job.figures);
  if (!job.report.empty()) return alone("--report", job.report);
  const bool own = job.of == workflow::MeasuresOf::muscles;
  if (!job.emg.write.empty()) return alone(own ? "--write-envelopes" : "--write-emg", job.emg.write);
  if (!job.emg.write_cycles.empty())
    return alone(own ? "--write-cycles" : "--write-emg-cycles", job.emg.write_cycles);
  if (!job.gait.angles.empty()) return alone("--angles", job.gait.angles);
  if (job.gait.into_recording()) return alone("--write-events", job.gait.write_events);
  if (auto s = check_for_several(job); !s) return s;
  return check_measures_output(job.output);
}

// The participants' table: the one named, or the one in the folder given.
Status join_participants(ManyMeasuresJob& job, std::vector<std::string>& notes) {
  if (job.participants_file.empty() && job.inputs.size() == 1) {
    const auto beside_them = job.inputs.front() / "participants.tsv";
    std::error_code ignored;
    if (fs::is_regular_file(beside_them, ignored)) {
      job.participants_file = beside_them;
      notes.push_back(fmt::format("{}: is joined to the rows", beside_them.string()));
    }
  }
  if (job.participants_file.empty()) return {};
  auto read = read_participants(job.participants_file);
  if (!read) return std::unexpected(read.error());
  job.participants = std::make_shared<const Participants>(std::move(*read));
  return {};
}

// A recording that is too large for the memory, or that trips a check, is one that failed.
Result<MeasuredRecording> measure_guarded(const MeasuresJob& job, const workflow::AskedMeasures& asked) {
  try {
    return measure_recording(job, asked);
  } catch (const std::bad_alloc&) {
    return fail(Code::io, fmt::format("{}: out of memory", job.input.string()));
  } catch (const std::exception& error) {
    return fail(Code::bad_input, fmt::format("{}: {}", job.input.string(), error.what()));
  }
}

std::optional<RecordingRows> run_trial(const MeasuresJob& job, const workflow::AskedMeasures& asked,
                                       TrialOutcome& trial) {
  const auto begin = std::chrono::steady_clock::now();
  auto measured = measure_guarded(job, asked);
  trial.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!measured) {
    trial.status = TrialStatus::failed;
    trial.said = measured.error().message;
    trial.exit_status = exit_status(measured.error().code);
    return std::nullopt;
  }
  auto& outcome = measured->outcome;
  trial.status = TrialStatus::good;
  trial.warnings = outcome.warnings.size();
  if (!outcome.warnings.empty()) trial.said = outcome.warnings.front();
  return RecordingRows{.name = std::move(measured->name),
                       .outcome = std::move(outcome),
                       .events = std::move(measured->events),
                       .cycles = std::move(measured->cycles)};
}

Status write_tables(const ManyMeasuresJob& job, Staging& staging, ManyMeasuresOutcome& out) {
  std::vector<RecordingName*> names;
  for (auto& one : out.recordings) names.push_back(&one.name);
  unite_span_columns(names);
  const auto& recordings = out.recordings;
  const auto& any = recordings.front().name;
  std::vector<ResultFile> files;
  const auto ending = ending_of(job.output);
  if (ending == ".csv") {
    files.push_back(text_file(job.output, [&] {
      auto text = measures_csv_columns(any);
      for (const auto& one : recordings) text += measures_csv_rows(one.outcome.measures, one.name);
      return text;
    }));
  } else if (ending == ".json") {
    files.push_back(json_file(job.output, [&] { return many_measures_json(out); }));
  } else if (!job.output.empty()) {
    std::vector<NamedMeasures> named;
    std::vector<data::InputFile> inputs;
    for (const auto& one : recordings) {
      named.push_back({one.name, one.outcome.measures, one.events});
      std::ranges::move(inputs_of(one.outcome), std::back_inserter(inputs));
    }
    files.push_back(nwb_file(job.output, std::move(named), inputs, job));
  }
  if (!job.gait.write_events.empty())
    files.push_back(text_file(job.gait.write_events, [&] {
      auto text = events_csv_columns(any);
      for (const auto& one : recordings) text += events_csv_rows(one.events, one.name);
      return text;
    }));
  if (!job.gait.write_cycles.empty())
    files.push_back(text_file(job.gait.write_cycles, [&] {
      auto text = curves_csv_columns(any);
      for (const auto& one : recordings) text += curves_csv_rows(one.cycles, one.name);
      return text;
    }));
  if (files.empty()) return {};
  auto written = write_results(staging, files, {}, "the measures");
  if (!written) return std::unexpected(written.error());
  out.written = std::move(*written);
  return {};
}

}  // namespace

Result<ManyMeasuresOutcome> run_many_measures(const ManyMeasuresJob& given) {
  ManyMeasuresJob job = given;
  if (auto s = check_many(job); !s) return std::unexpected(s.error());
  if (auto s = job.selection.check(); !s) return std::unexpected(s.error());
  const int at_a_time = thread_count(job.jobs);
  MeasuresJob alike = job;  // what is asked of every recording
  alike.threads = std::max(1, thread_count(job.threads) / at_a_time);
  const auto asked = asked_measures(alike);
  if (!asked) return std::unexpected(asked.error());
  ManyMeasuresOutcome out;
  if (auto s = join_participants(job, out.notes); !s) return std::unexpected(s.error());
  auto list = list_recordings(job.inputs);
  if (!list) return std::unexpected(list.error());
  std::ranges::move(list->notes, std::back_inserter(out.notes));
  // What lies beside the recordings and describes them is none.
  std::erase_if(list->files, [&](const fs::path& path) {
    return path.filename() == "participants.tsv" || path == job.participants_file;
  });
  std::vector<fs::path> targets;
  for (const auto& path : {job.output, job.gait.write_events, job.gait.write_cycles})
    if (!path.empty()) targets.push_back(path);
  auto inputs = list->files;
  for (const auto& path : list->files) {
    MeasuresJob one = job;
    one.input = path;
    std::ranges::move(files_of(one), std::back_inserter(inputs));
  }
  auto staging = Staging::create(targets, job, inputs);
  if (!staging) return std::unexpected(staging.error());

  for (const auto& path : list->files) out.trials.push_back({.input = path, .output = job.output});
  std::vector<std::optional<RecordingRows>> each(out.trials.size());
  std::mutex mutex;
  std::int64_t done = 0;
  std::atomic<bool> stopped = false;
  parallel_for(std::ssize(out.trials), 1, at_a_time, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = at(begin); i < at(end) && !stopped; ++i) {
      MeasuresJob one = job;
      one.input = out.trials[i].input;
      if (!io::needs_rate(one.input)) one.rate_hz = 0.0;
      one.threads = alike.threads;
      one.progress = {};
      each[i] = run_trial(one, *asked, out.trials[i]);
      const std::lock_guard lock(mutex);
      ++done;
      if (job.progress && !job.progress(done, std::ssize(out.trials))) stopped = true;
    }
  });
  if (stopped) return fail(Code::cancelled, "measuring was stopped; nothing is written");
  for (auto& one : each)
    if (one) out.recordings.push_back(std::move(*one));
  if (out.recordings.empty()) return out;
  if (auto s = write_tables(job, *staging, out); !s) return std::unexpected(s.error());
  return out;
}

nlohmann::ordered_json many_measures_json(const ManyMeasuresOutcome& outcome) {
  nlohmann::ordered_json out;
  out["recordings"] = nlohmann::ordered_json::array();
  for (const auto& one : outcome.recordings) {
    auto json = measures_outcome_json(one.outcome);
    json.erase("written");
    json["participant"] = one.name.participant;
    json["session"] = one.name.session;
    json["trial"] = one.name.trial;
    for (const auto& [column, value] : one.name.more) json["more"][column] = value;
    out["recordings"].push_back(std::move(json));
  }
  out["failed"] = nlohmann::ordered_json::array();
  for (const auto& trial : outcome.trials)
    if (trial.status == TrialStatus::failed)
      out["failed"].push_back(
          {{"path", trial.input.string()}, {"error", trial.said}, {"exit_status", trial.exit_status}});
  out["written"] = nlohmann::ordered_json::array();
  for (const auto& path : outcome.written) out["written"].push_back(path.string());
  out["notes"] = outcome.notes;
  return out;
}

}  // namespace kinemark::pipeline
