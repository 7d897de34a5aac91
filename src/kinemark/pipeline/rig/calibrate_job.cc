// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/calibrate_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "kinemark/core/number.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/rig/rig_page.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

/// A recording with its description of the known object.
struct Known {
  fs::path path;
  io::CountsRecording recording;
  std::map<std::string, std::string> values;

  [[nodiscard]] std::string kind() const {
    const auto at = values.find("kind");
    return at == values.end() ? std::string() : at->second;
  }
  /// Numbers of one entry, separated by blanks.
  [[nodiscard]] Result<std::vector<double>> numbers(const std::string& key) const {
    const auto at = values.find(key);
    std::vector<double> out;
    if (at == values.end())
      return fail(Code::bad_input, fmt::format("{}: its description lacks '{}'", path.string(), key));
    for (std::size_t from = 0; from < at->second.size();) {
      const auto to = std::min(at->second.find_first_of(" \n", from), at->second.size());
      if (to > from) {
        const auto value = parse_number(std::string_view(at->second).substr(from, to - from));
        if (!value)
          return fail(Code::bad_input,
                      fmt::format("{}: '{}' of '{}' is no number", path.string(), at->second, key));
        out.push_back(*value);
      }
      from = to + 1;
    }
    if (out.empty())
      return fail(Code::bad_input,
                  fmt::format("{}: '{}' is empty; numbers were expected", path.string(), key));
    return out;
  }
};

Result<Known> read(const fs::path& path) {
  auto recording = io::read_counts(path);
  if (!recording) return std::unexpected(recording.error());
  Known out{.path = path, .recording = std::move(*recording), .values = {}};
  for (const auto& metadata : out.recording.metadata)
    if (metadata.name == "calibration") out.values = metadata.values;
  return out;
}

Result<workflow::ShownGrid> grid_of(const Known& known) {
  const auto nodes = known.numbers("nodes"), spacing = known.numbers("spacing_m"),
             distance = known.numbers("distance_m");
  for (const auto* numbers : {&nodes, &spacing, &distance})
    if (!*numbers) return std::unexpected(numbers->error());
  return workflow::ShownGrid{.nodes = static_cast<int>(std::clamp(nodes->front(), 0.0, 1e3)),
                             .spacing_m = spacing->front(),
                             .distance_m = distance->front()};
}

Result<workflow::ShownTree> tree_of(const Known& known, const CalibrateJob& job) {
  workflow::ShownTree out{.sides_m = job.sides_m, .frames_per_pose = job.frames_per_pose};
  if (out.sides_m.empty()) {
    auto said = known.numbers("sides_m");
    if (!said) return std::unexpected(said.error());
    out.sides_m = std::move(*said);
  }
  if (out.frames_per_pose == 0) {
    const auto said = known.numbers("frames_per_pose");
    if (!said) return std::unexpected(said.error());
    out.frames_per_pose = static_cast<int>(std::clamp(said->front(), 0.0, 1e6));
  }
  return out;
}

Result<workflow::ShownScan> scan_of(const Known& known) {
  const auto frames = known.numbers("frames_per_place"), positions = known.numbers("places_m");
  for (const auto* numbers : {&frames, &positions})
    if (!*numbers) return std::unexpected(numbers->error());
  if (positions->size() % 3 != 0)
    return fail(Code::bad_input,
                fmt::format("{}: 'places_m' has {} numbers; three for each position were expected",
                            known.path.string(), positions->size()));
  return workflow::ShownScan{.frames_per_place = static_cast<int>(std::clamp(frames->front(), 0.0, 1e6)),
                             .x_in_stage = Eigen::Map<const Eigen::Matrix3Xd>(
                                 positions->data(), 3, static_cast<Eigen::Index>(positions->size() / 3))};
}

/// The recording as what it shows.
template <class Thing>
Result<workflow::ShownCounts> showing(Known& known, Result<Thing> thing) {
  if (!thing) return std::unexpected(thing.error());
  return workflow::ShownCounts{
      .name = known.path.string(), .counts = std::move(known.recording.counts), .shows = std::move(*thing)};
}

Result<workflow::ShownCounts> read_shown(const CalibrateJob& job, const fs::path& path,
                                         std::vector<std::string>& warnings) {
  auto known = read(path);
  if (!known) return std::unexpected(known.error());
  for (const auto& warning : known->recording.warnings)
    warnings.push_back(fmt::format("{}: {}", path.string(), warning));
  const auto kind = known->kind();
  if (kind == "grid") return showing(*known, grid_of(*known));
  if (kind == "tree" || (kind.empty() && !job.sides_m.empty() && job.frames_per_pose > 0))
    return showing(*known, tree_of(*known, job));
  if (kind == "scan") return showing(*known, scan_of(*known));
  return fail(Code::bad_input,
              fmt::format("{}: shows '{}'; a recording of a tree, a grid or a scan was expected",
                          path.string(), kind.empty() ? "nothing known" : kind));
}

/// The calibrated rig and the page, as far as they are wanted.
/// @param found  no value: nothing was found
Result<CalibrateOutcome> write(const CalibrateJob& job, Staging& staging, const data::Rig& nominal,
                               const std::optional<data::Rig>& found, CalibrateOutcome out) {
  std::vector<ResultFile> files;
  if (found) {
    out.has_rig = true;
    out.written = {job.output};  // as the page says
    files.push_back({job.output, [&found](const fs::path& staged, const std::string&) {
                       return io::write_rig(staged, *found, false);
                     }});
  }
  if (!job.report.empty())
    files.push_back(
        text_file(job.report, [&] { return calibrate_page(job, out, nominal, found ? *found : nominal); }));
  auto written = write_results(staging, files, {}, "the calibration");
  if (!written) return std::unexpected(written.error());
  out.written = std::move(*written);
  return out;
}

using Json = nlohmann::ordered_json;

Json alignment_json(const calibration::Alignment& alignment) {
  Json cameras = Json::array();
  const auto list = [](const Eigen::Vector3d& v, double unit) {
    return Json::array({unit * v.x(), unit * v.y(), unit * v.z()});
  };
  for (const auto& c : alignment.cameras)
    cameras.push_back({{"camera", c.camera},
                       {"right_down_forward_mm", list(c.shift_m, 1e3)},
                       {"right_down_forward_sd_mm", list(c.shift_sd_m, 1e3)},
                       {"tilt_pan_roll_deg", list(c.rotation_deg, 1.0)},
                       {"tilt_pan_roll_sd_deg", list(c.rotation_sd_deg, 1.0)}});
  return {{"cameras", std::move(cameras)}, {"aligned", alignment.aligned}, {"next", alignment.next}};
}

}  // namespace

Result<CalibrateOutcome> run_calibrate(const CalibrateJob& job) {
  auto read = job.inputs;
  read.push_back(job.nominal);
  auto staging =
      Staging::create(job.options.align_only ? std::vector<fs::path>() : std::vector{job.output}, job, read);
  if (!staging) return std::unexpected(staging.error());
  if (auto s = staging->add_page(job.report); !s) return std::unexpected(s.error());
  const auto nominal = io::read_rig(job.nominal);
  if (!nominal) return std::unexpected(nominal.error());
  CalibrateOutcome out;
  out.method = job.options.method;
  std::vector<workflow::ShownCounts> shown;
  for (const auto& path : job.inputs) {
    auto one = read_shown(job, path, out.warnings);
    if (!one) return std::unexpected(one.error());
    shown.push_back(std::move(*one));
  }
  auto options = job.options;
  options.progress = job.progress;
  auto found = workflow::calibrate(shown, *nominal, options);
  if (!found) return std::unexpected(found.error());
  out.bundle = std::move(found->bundle);
  out.alignment = std::move(found->alignment);
  std::ranges::move(found->remarks.warnings, std::back_inserter(out.warnings));
  out.gates = std::move(found->remarks.gates);
  return write(job, *staging, *nominal, found->rig, std::move(out));
}

Json calibrate_json(const CalibrateOutcome& outcome) {
  Json json;
  json["method"] = to_string(outcome.method);
  if (outcome.bundle) {
    json["chi2_per_dof"] = outcome.bundle->chi2_per_dof;
    json["warp_degree"] = outcome.bundle->warp_degree;
    json["crosstalk"] = outcome.bundle->crosstalk;
    json["iterations"] = outcome.bundle->iterations;
    json["poses"] = outcome.bundle->poses;
    json["sightings"] = outcome.bundle->observations;
    json["outliers"] = outcome.bundle->outliers;
    json["side_rms_mm"] = 1e3 * outcome.bundle->side_rms_m;
  }
  if (outcome.alignment) json["alignment"] = alignment_json(*outcome.alignment);
  if (outcome.has_rig) json["written"] = outcome.written.front().string();
  json["warnings"] = outcome.warnings;
  return json;
}

}  // namespace kinemark::pipeline
