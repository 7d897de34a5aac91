// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/report_job.h"

#include <fmt/core.h>

#include <nlohmann/json.hpp>

#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/motion/motion_job.h"
#include "kinemark/stages/report/ik_report.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Result<Json> read_json(const fs::path& path) {
  const auto text = io::read_text(path, 256UL << 20);
  if (!text) return std::unexpected(text.error());
  Json json = Json::parse(*text, nullptr, false);
  if (json.is_discarded()) return fail(Code::bad_input, fmt::format("{}: is not JSON", path.string()));
  return json;
}

/// Names of the rotational coordinates, as written by summary_json().
std::vector<std::string> rotations(const Json& json) {
  std::vector<std::string> names;
  if (!json.contains("coordinates") || !json["coordinates"].is_array()) return names;
  for (const auto& coordinate : json["coordinates"])
    if (coordinate.value("unit", "") == "deg") names.push_back(coordinate.value("name", ""));
  return names;
}

/// States of the recording on the solved frames, when the file is still there and fits; else nothing.
std::optional<data::Trajectories> recorded_states(const report::IkRun& run, const data::JointMotion& motion) {
  for (const auto& input : run.inputs) {
    if (input.role != "markers") continue;
    const auto trial = io::read_markers(input.path);
    if (!trial) return std::nullopt;
    const auto& recorded = trial->markers;
    const auto first = recorded.time.nearest_frame(motion.time.t0_s);
    if (first < 0 || first + motion.frames() > recorded.frames()) return std::nullopt;
    auto states = data::Trajectories::all_missing(motion.markers, motion.time);
    for (std::int64_t m = 0; m < states.markers(); ++m) {
      const auto from = recorded.find(motion.markers[static_cast<std::size_t>(m)]);
      if (from < 0) return std::nullopt;
      for (std::int64_t f = 0; f < states.frames(); ++f) {
        states.x(f, m) = recorded.x(first + f, from);
        states.state[states.index(f, m)] = recorded.state[recorded.index(first + f, from)];
      }
    }
    return states;
  }
  return std::nullopt;
}

}  // namespace

Status write_report(const fs::path& solved, const fs::path& page, bool force) {
  std::string stem = solved.stem().string();
  if (solved.extension() == ".json" && stem.ends_with("_report")) stem.resize(stem.size() - 7);
  const fs::path base = solved.parent_path() / (stem + ".mot");
  const auto json = read_json(beside(base, "_report.json"));
  if (!json) return std::unexpected(json.error());
  auto run = report::run_from_json(*json);
  if (!run) return fail_at(beside(base, "_report.json").string(), run.error());
  const auto coordinates = io::read_table(base);
  if (!coordinates) return std::unexpected(coordinates.error());
  const auto deviations = io::read_table(beside(base, "_sd.sto"));
  if (!deviations && fs::exists(beside(base, "_sd.sto"))) return std::unexpected(deviations.error());
  const auto errors = io::read_table(beside(base, "_marker_errors.sto"));
  if (!errors) return std::unexpected(errors.error());
  const auto motion =
      motion_from_tables(*coordinates, deviations ? &*deviations : nullptr, &*errors, rotations(*json));
  if (!motion) return fail_at(base.string(), motion.error());
  const auto states = recorded_states(*run, *motion);
  const auto summary = report::summarize(std::move(*run), *motion, states ? &*states : nullptr);
  if (!summary) return fail_at(base.string(), summary.error());
  const std::string html =
      report::report_html({.summary = *summary, .motion = &*motion, .markers = states ? &*states : nullptr});
  return io::write_text(page, html, force);
}

}  // namespace kinemark::pipeline
