// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/rig/calibrate_job.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "kinemark/io/number.h"
#include "kinemark/io/recording/counts_recording.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/stages/calibration/alignment.h"
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
        const auto value = io::parse_number(std::string_view(at->second).substr(from, to - from));
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

Result<calibration::GridSightings> grid_of(const Known& known, const data::Rig& rig, int camera) {
  const auto nodes = known.numbers("nodes"), spacing = known.numbers("spacing_m"),
             distance = known.numbers("distance_m");
  for (const auto* numbers : {&nodes, &spacing, &distance})
    if (!*numbers) return std::unexpected(numbers->error());
  const auto grid =
      calibration::grid_sightings(known.recording.counts, rig, camera,
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
  const auto frames = known.numbers("frames_per_place"), places = known.numbers("places_m");
  for (const auto* numbers : {&frames, &places})
    if (!*numbers) return std::unexpected(numbers->error());
  if (places->size() % 3 != 0)
    return fail(Code::bad_input,
                fmt::format("{}: 'places_m' has {} numbers; three for each position were expected",
                            known.path.string(), places->size()));
  calibration::ScanPlaces scan;
  scan.frames_per_place = static_cast<int>(std::clamp(frames->front(), 0.0, 1e6));
  scan.x_in_stage =
      Eigen::Map<const Eigen::Matrix3Xd>(places->data(), 3, static_cast<Eigen::Index>(places->size() / 3));
  const auto seen = calibration::scan_sightings(known.recording.counts, rig, scan);
  if (!seen) return fail_at(known.path.string(), seen.error());
  return seen;
}

nlohmann::ordered_json told_of(const calibration::Alignment& alignment) {
  nlohmann::ordered_json cameras = nlohmann::ordered_json::array();
  const auto list = [](const Eigen::Vector3d& v, double unit) {
    return nlohmann::ordered_json::array({unit * v.x(), unit * v.y(), unit * v.z()});
  };
  for (const auto& c : alignment.cameras)
    cameras.push_back({{"camera", c.camera},
                       {"right_down_forward_mm", list(c.shift_m, 1e3)},
                       {"right_down_forward_sd_mm", list(c.shift_sd_m, 1e3)},
                       {"tilt_pan_roll_deg", list(c.turn_deg, 1.0)},
                       {"tilt_pan_roll_sd_deg", list(c.turn_sd_deg, 1.0)}});
  return {{"cameras", std::move(cameras)}, {"aligned", alignment.aligned}, {"next", alignment.next}};
}

int camera_of(const Known& known, const data::Rig& rig) {
  if (known.recording.counts.cameras.size() != 1) return -1;
  const auto at = std::ranges::find(rig.cameras, known.recording.counts.cameras.front(), &data::Camera::name);
  return at == rig.cameras.end() ? -1 : static_cast<int>(at - rig.cameras.begin());
}

}  // namespace

Result<nlohmann::ordered_json> calibrate_rig_file(const CalibrateJob& job, const Progress& progress) {
  const auto nominal = io::read_rig(job.nominal);
  if (!nominal) return std::unexpected(nominal.error());
  std::optional<calibration::StillPoses> tree, scan;
  std::vector<std::optional<calibration::GridSightings>> seen(nominal->cameras.size());
  nlohmann::ordered_json warnings = nlohmann::ordered_json::array();
  for (const auto& path : job.inputs) {
    const auto known = read(path);
    if (!known) return std::unexpected(known.error());
    for (const auto& warning : known->recording.warnings)
      warnings.push_back(fmt::format("{}: {}", path.string(), warning));
    if (known->kind() == "grid") {
      const int camera = camera_of(*known, *nominal);
      if (camera < 0)
        return fail(Code::bad_input,
                    fmt::format("{}: a grid is recorded by one camera of the rig; this recording has {}",
                                path.string(), known->recording.counts.cameras.size()));
      auto grid = grid_of(*known, *nominal, camera);
      if (!grid) return std::unexpected(grid.error());
      seen[static_cast<std::size_t>(camera)] = std::move(*grid);
    } else if (known->kind() == "tree" ||
               (known->kind().empty() && !job.sides_m.empty() && job.frames_per_pose > 0)) {
      auto poses = tree_of(*known, *nominal, job);
      if (!poses) return std::unexpected(poses.error());
      tree = std::move(*poses);
    } else if (known->kind() == "scan") {
      auto places = scan_of(*known, *nominal);
      if (!places) return std::unexpected(places.error());
      scan = std::move(*places);
    } else {
      return fail(Code::bad_input,
                  fmt::format("{}: shows '{}'; a recording of a tree, a grid or a scan was expected",
                              path.string(), known->kind().empty() ? "nothing known" : known->kind()));
    }
  }
  std::vector<calibration::GridSightings> grids;
  for (const auto& grid : seen)
    if (grid) grids.push_back(*grid);
  if (!grids.empty() && grids.size() != seen.size())
    return fail(Code::usage, fmt::format("a grid for {} of {} cameras; one each was expected, or none",
                                         grids.size(), seen.size()));

  nlohmann::ordered_json told;
  data::Rig rig = *nominal;
  if (!grids.empty()) {
    auto with_tables = calibration::calibrate_grid_lut(*nominal, grids);
    if (!with_tables) return std::unexpected(with_tables.error());
    rig = std::move(*with_tables);
  } else if (job.method == CalibrateJob::Method::grid_lut) {
    return fail(Code::usage, "the method grid-lut needs a recording of the grid before each camera");
  }
  constexpr std::array<const char*, 3> kNames{"bundle", "grid-lut", "scan"};
  told["method"] = kNames[static_cast<std::size_t>(job.method)];
  if (job.method != CalibrateJob::Method::grid_lut) {
    const auto& shown = job.method == CalibrateJob::Method::scan ? scan : tree;
    if (!shown)
      return fail(Code::usage,
                  fmt::format("the method {} needs a recording of the {}", told["method"].get<std::string>(),
                              job.method == CalibrateJob::Method::scan ? "scan" : "tree"));
    if (job.align_only) {
      const auto alignment = calibration::align_by_tree(*nominal, *shown);
      if (!alignment) return std::unexpected(alignment.error());
      told["alignment"] = told_of(*alignment);
      told["warnings"] = std::move(warnings);
      return told;
    }
    auto found = calibration::calibrate_bundle(rig, *shown, grids, job.bundle, progress);
    if (!found) return std::unexpected(found.error());
    const auto& r = found->report;
    told["chi2_per_dof"] = r.chi2_per_dof;
    told["warp_degree"] = r.warp_degree;
    told["crosstalk"] = r.crosstalk;
    told["iterations"] = r.iterations;
    told["poses"] = r.poses;
    told["sightings"] = r.sightings;
    told["outliers"] = r.outliers;
    told["side_rms_mm"] = 1e3 * r.side_rms_m;
    rig = std::move(found->rig);
    rig.method = told["method"].get<std::string>();
    const auto alignment = calibration::compare_alignment(*nominal, rig);
    if (!alignment) return std::unexpected(alignment.error());
    told["alignment"] = told_of(*alignment);
  }
  if (auto s = io::write_rig(job.output, rig, job.force); !s) return std::unexpected(s.error());
  told["written"] = job.output.string();
  told["warnings"] = std::move(warnings);
  return told;
}

}  // namespace kinemark::pipeline
