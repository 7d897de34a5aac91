// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/calibrate_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/pipeline/rig/rig_page.h"
#include "kinemark/stages/calibration/grid_lut.h"
#include "kinemark/stages/calibration/scan.h"
#include "kinemark/stages/calibration/still_poses.h"

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

Result<calibration::GridObservations> grid_of(const Known& known, const data::Rig& rig, int camera) {
  const auto nodes = known.numbers("nodes"), spacing = known.numbers("spacing_m"),
             distance = known.numbers("distance_m");
  for (const auto* numbers : {&nodes, &spacing, &distance})
    if (!*numbers) return std::unexpected(numbers->error());
  const auto grid =
      calibration::grid_observations(known.recording.counts, rig, camera,
                                     {.nodes = static_cast<int>(std::clamp(nodes->front(), 0.0, 1e3)),
                                      .spacing_m = spacing->front(),
                                      .distance_m = distance->front()});
  if (!grid) return fail_at(known.path.string(), grid.error());
  return grid;
}

Result<calibration::StillPoses> tree_of(const Known& known, const data::Rig& rig, const CalibrateJob& job) {
  auto sides = job.sides_m;
  if (sides.empty()) {
    const auto said = known.numbers("sides_m");
    if (!said) return std::unexpected(said.error());
    sides = *said;
  }
  int frames = job.frames_per_pose;
  if (frames == 0) {
    const auto said = known.numbers("frames_per_pose");
    if (!said) return std::unexpected(said.error());
    frames = static_cast<int>(std::clamp(said->front(), 0.0, 1e6));
  }
  auto shape = calibration::tree_from_sides(sides);
  if (!shape) return std::unexpected(shape.error());
  const auto poses = calibration::still_poses(known.recording.counts, rig, std::move(*shape), frames);
  if (!poses) return fail_at(known.path.string(), poses.error());
  return poses;
}

Result<calibration::StillPoses> scan_of(const Known& known, const data::Rig& rig) {
  const auto frames = known.numbers("frames_per_place"), positions = known.numbers("places_m");
  for (const auto* numbers : {&frames, &positions})
    if (!*numbers) return std::unexpected(numbers->error());
  if (positions->size() % 3 != 0)
    return fail(Code::bad_input,
                fmt::format("{}: 'places_m' has {} numbers; three for each position were expected",
                            known.path.string(), positions->size()));
  calibration::ScanPositions scan;
  scan.frames_per_position = static_cast<int>(std::clamp(frames->front(), 0.0, 1e6));
  scan.x_in_stage = Eigen::Map<const Eigen::Matrix3Xd>(positions->data(), 3,
                                                       static_cast<Eigen::Index>(positions->size() / 3));
  const auto seen = calibration::scan_observations(known.recording.counts, rig, scan);
  if (!seen) return fail_at(known.path.string(), seen.error());
  return seen;
}

int camera_of(const Known& known, const data::Rig& rig) {
  if (known.recording.counts.cameras.size() != 1) return -1;
  const auto at = std::ranges::find(rig.cameras, known.recording.counts.cameras.front(), &data::Camera::name);
  return at == rig.cameras.end() ? -1 : static_cast<int>(at - rig.cameras.begin());
}

/// What the recordings show, sorted.
struct Evidence {
  std::optional<calibration::StillPoses> tree, scan;
  std::vector<calibration::GridObservations> grids;  ///< of every camera, or none
};

Result<calibration::GridObservations> grid_of(
    const Known& known, const data::Rig& rig,
    std::vector<std::optional<calibration::GridObservations>>& seen) {
  const int camera = camera_of(known, rig);
  if (camera < 0)
    return fail(Code::bad_input,
                fmt::format("{}: a grid is recorded by one camera of the rig; this recording has {}",
                            known.path.string(), known.recording.counts.cameras.size()));
  auto grid = grid_of(known, rig, camera);
  if (grid) seen[static_cast<std::size_t>(camera)] = *grid;
  return grid;
}

/// A recording that was cut off within a pose says how much of it is not used.
void tell_left_over(const Known& known, const calibration::StillPoses& poses,
                    std::vector<std::string>& warnings) {
  if (poses.frames_left_over > 0)
    warnings.push_back(
        fmt::format("{}: the last {} of {} frames are of a pose that was not recorded to its end; not used",
                    known.path.string(), poses.frames_left_over, known.recording.counts.frames()));
}

Result<Evidence> read_evidence(const CalibrateJob& job, const data::Rig& nominal,
                               std::vector<std::string>& warnings) {
  Evidence out;
  std::vector<std::optional<calibration::GridObservations>> seen(nominal.cameras.size());
  for (const auto& path : job.inputs) {
    const auto known = read(path);
    if (!known) return std::unexpected(known.error());
    for (const auto& warning : known->recording.warnings)
      warnings.push_back(fmt::format("{}: {}", path.string(), warning));
    if (known->kind() == "grid") {
      if (const auto grid = grid_of(*known, nominal, seen); !grid) return std::unexpected(grid.error());
    } else if (known->kind() == "tree" ||
               (known->kind().empty() && !job.sides_m.empty() && job.frames_per_pose > 0)) {
      auto poses = tree_of(*known, nominal, job);
      if (!poses) return std::unexpected(poses.error());
      tell_left_over(*known, *poses, warnings);
      out.tree = std::move(*poses);
    } else if (known->kind() == "scan") {
      auto positions = scan_of(*known, nominal);
      if (!positions) return std::unexpected(positions.error());
      tell_left_over(*known, *positions, warnings);
      out.scan = std::move(*positions);
    } else {
      return fail(Code::bad_input,
                  fmt::format("{}: shows '{}'; a recording of a tree, a grid or a scan was expected",
                              path.string(), known->kind().empty() ? "nothing known" : known->kind()));
    }
  }
  for (auto& grid : seen)
    if (grid) out.grids.push_back(std::move(*grid));
  if (!out.grids.empty() && out.grids.size() != seen.size())
    return fail(Code::usage, fmt::format("a grid for {} of {} cameras; one each was expected, or none",
                                         out.grids.size(), seen.size()));
  return out;
}

/// Tables of the 1986 method, where the grid was recorded.
Result<data::Rig> with_tables(const CalibrateJob& job, const data::Rig& nominal, const Evidence& evidence) {
  if (!evidence.grids.empty()) return calibration::calibrate_grid_lut(nominal, evidence.grids);
  if (job.method == CalibrateJob::Method::grid_lut)
    return fail(Code::usage, "the method grid-lut needs a recording of the grid before each camera");
  return nominal;
}

/// Bundle adjustment of the tree or the scan; `rig` becomes the calibrated one.
Status adjust(const CalibrateJob& job, const data::Rig& nominal, const Evidence& evidence, data::Rig& rig,
              CalibrateOutcome& out) {
  const bool by_scan = job.method == CalibrateJob::Method::scan;
  const auto& shown = by_scan ? evidence.scan : evidence.tree;
  if (!shown)
    return fail(Code::usage, fmt::format("the method {} needs a recording of the {}", method_name(job.method),
                                         by_scan ? "scan" : "tree"));
  if (job.align_only) {
    auto alignment = calibration::align_by_tree(nominal, *shown);
    if (!alignment) return std::unexpected(alignment.error());
    out.alignment = std::move(*alignment);
    return {};
  }
  auto found = calibration::calibrate_bundle(rig, *shown, evidence.grids, job.bundle, job.progress);
  if (!found) return std::unexpected(found.error());
  out.bundle = std::move(found->report);
  rig = std::move(found->rig);
  rig.method = method_name(job.method);
  auto alignment = calibration::compare_alignment(nominal, rig);
  if (!alignment) return std::unexpected(alignment.error());
  out.alignment = std::move(*alignment);
  return {};
}

/// A model that the counts contradict is a quality gate that was missed, not a bad file.
bool refused(const Error& error) { return error.message.starts_with("calibration refused"); }

void add_gate(const CalibrateJob& job, std::string sentence, CalibrateOutcome& out) {
  const bool passed = out.bundle.has_value();
  out.gates.push_back({.name = "chi2_per_dof",
                       .passed = passed,
                       .value = passed ? out.bundle->chi2_per_dof : kNaN,
                       .bound = job.bundle.refuse_above,
                       .unit = "",
                       .sentence = std::move(sentence)});
}

/// The calibrated rig and the page, as far as they are wanted.
/// @param found  no value: nothing was found
Result<CalibrateOutcome> write(const CalibrateJob& job, Staging& staging, const data::Rig& nominal,
                               const std::optional<data::Rig>& found, CalibrateOutcome out) {
  std::vector<ResultFile> files;
  if (found) {
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

}  // namespace

std::string_view method_name(CalibrateJob::Method method) {
  constexpr std::array<std::string_view, 3> kNames{"bundle", "grid-lut", "scan"};
  return kNames[static_cast<std::size_t>(method)];
}

Result<CalibrateOutcome> run_calibrate(const CalibrateJob& job) {
  auto read = job.inputs;
  read.push_back(job.nominal);
  auto staging =
      Staging::create(job.align_only ? std::vector<fs::path>() : std::vector{job.output}, job, read);
  if (!staging) return std::unexpected(staging.error());
  if (auto s = staging->add_page(job.report); !s) return std::unexpected(s.error());
  const auto nominal = io::read_rig(job.nominal);
  if (!nominal) return std::unexpected(nominal.error());
  CalibrateOutcome out;
  out.method = job.method;
  const auto evidence = read_evidence(job, *nominal, out.warnings);
  if (!evidence) return std::unexpected(evidence.error());
  auto rig = with_tables(job, *nominal, *evidence);
  if (!rig) return std::unexpected(rig.error());
  if (job.method != CalibrateJob::Method::grid_lut) {
    const auto adjusted = adjust(job, *nominal, *evidence, *rig, out);
    if (!adjusted && !refused(adjusted.error())) return std::unexpected(adjusted.error());
    if (!adjusted) add_gate(job, adjusted.error().message, out);
    if (!adjusted || job.align_only) return write(job, *staging, *nominal, std::nullopt, std::move(out));
    add_gate(job, fmt::format("chi2 per degree of freedom is {:.2f}.", out.bundle->chi2_per_dof), out);
  }
  return write(job, *staging, *nominal, std::move(*rig), std::move(out));
}

}  // namespace kinemark::pipeline
