// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/rig/calibrate.h"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "kinemark/camera/light.h"
#include "kinemark/core/enum_names.h"
#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/utf8.h"
#include "kinemark/stages/calibration/grid_lut.h"
#include "kinemark/stages/calibration/scan.h"
#include "kinemark/stages/calibration/still_poses.h"

namespace kinemark::workflow {
namespace {

using calibration::GridObservations;
using calibration::StillPoses;

/// What the recordings show, sorted.
struct Evidence {
  std::optional<StillPoses> tree, scan;
  std::vector<GridObservations> grids;  ///< of every camera, or none
};

/// The only camera of a recording, as the rig counts its own.
Result<int> camera_of(const ShownCounts& one, const data::Rig& rig) {
  const auto& cameras = one.counts.cameras;
  if (cameras.size() != 1)
    return fail(Code::bad_input,
                fmt::format("{}: a grid is recorded by one camera of the rig; this recording has {}",
                            one.name, cameras.size()));
  const auto found = std::ranges::find(rig.cameras, cameras.front(), &data::Camera::name);
  if (found == rig.cameras.end())
    return fail(Code::bad_input, fmt::format("{}: its camera '{}' is none of the rig", one.name,
                                             printable(cameras.front(), 60)));
  return static_cast<int>(found - rig.cameras.begin());
}

/// A recording that was cut off within a pose says how much of it is not used.
void add_left_over(const ShownCounts& one, const StillPoses& poses, std::vector<std::string>& warnings) {
  if (poses.frames_left_over > 0)
    warnings.push_back(
        fmt::format("{}: the last {} of {} frames are of a pose that was not recorded to its end; not used",
                    one.name, poses.frames_left_over, one.counts.frames()));
}

/// Sorts recordings by what they show.
class Sorting {
 public:
  Sorting(const data::Rig& nominal, std::vector<std::string>& warnings)
      : nominal_(nominal), warnings_(warnings), seen_(nominal.cameras.size()) {}

  Status add(const ShownCounts& one) {
    return std::visit([&](const auto& thing) { return add(one, thing); }, one.shows);
  }

  Result<Evidence> take() && {
    for (auto& grid : seen_)
      if (grid) out_.grids.push_back(std::move(*grid));
    if (!out_.grids.empty() && out_.grids.size() != seen_.size())
      return fail(Code::usage, fmt::format("a grid for {} of {} cameras; one each was expected, or none",
                                           out_.grids.size(), seen_.size()));
    return std::move(out_);
  }

 private:
  Status add(const ShownCounts& one, const ShownTree& tree) {
    auto shape = calibration::tree_from_sides(tree.sides_m);
    if (!shape) return std::unexpected(shape.error());
    return keep(one, calibration::still_poses(one.counts, nominal_, std::move(*shape), tree.frames_per_pose),
                out_.tree);
  }
  Status add(const ShownCounts& one, const ShownScan& scan) {
    return keep(one,
                calibration::scan_observations(
                    one.counts, nominal_,
                    {.x_in_stage = scan.x_in_stage, .frames_per_position = scan.frames_per_place}),
                out_.scan);
  }
  Status add(const ShownCounts& one, const ShownGrid& grid) {
    const auto camera = camera_of(one, nominal_);
    if (!camera) return std::unexpected(camera.error());
    auto observed = calibration::grid_observations(
        one.counts, nominal_, *camera,
        {.nodes = grid.nodes, .spacing_m = grid.spacing_m, .distance_m = grid.distance_m});
    if (!observed) return fail_at(one.name, observed.error());
    seen_[at(*camera)] = std::move(*observed);
    return {};
  }
  Status keep(const ShownCounts& one, Result<StillPoses> poses, std::optional<StillPoses>& to) {
    if (!poses) return fail_at(one.name, poses.error());
    add_left_over(one, *poses, warnings_);
    to = std::move(*poses);
    return {};
  }

  const data::Rig& nominal_;
  std::vector<std::string>& warnings_;
  std::vector<std::optional<GridObservations>> seen_;
  Evidence out_;
};

/// Tables of the 1986 method, where the grid was recorded.
Result<data::Rig> with_tables(CalibrateMethod method, const data::Rig& nominal, const Evidence& evidence) {
  if (!evidence.grids.empty()) return calibration::calibrate_grid_lut(nominal, evidence.grids);
  if (method == CalibrateMethod::grid_lut)
    return fail(Code::usage, "the method grid-lut needs a recording of the grid before each camera");
  return nominal;
}

/// Bundle adjustment of the tree or the scan; `rig` becomes the calibrated one.
Status adjust(std::span<const ShownCounts> shown_counts, const CalibrateOptions& options,
              const data::Rig& nominal, const Evidence& evidence, data::Rig& rig, Calibrated& out) {
  const bool by_scan = options.method == CalibrateMethod::scan;
  const auto& shown = by_scan ? evidence.scan : evidence.tree;
  if (!shown)
    return fail(Code::usage, fmt::format("the method {} needs a recording of the {}",
                                         to_string(options.method), by_scan ? "scan" : "tree"));
  if (options.align_only) {
    auto alignment = calibration::align_by_tree(nominal, *shown);
    if (!alignment) return std::unexpected(alignment.error());
    out.alignment = std::move(*alignment);
    return {};
  }
  const auto shows_it = [&](const ShownCounts& one) {
    return by_scan ? std::holds_alternative<ShownScan>(one.shows)
                   : std::holds_alternative<ShownTree>(one.shows);
  };
  for (const auto& one : shown_counts)
    if (shows_it(one)) camera::begin_in_the_dark(one.counts, rig);
  auto found = calibration::calibrate_bundle(rig, *shown, evidence.grids, options.bundle, options.progress);
  if (!found) return std::unexpected(found.error());
  out.bundle = std::move(found->report);
  rig = std::move(found->rig);
  for (const auto& one : shown_counts)
    if (shows_it(one)) camera::find_dark_counts(one.counts, rig);
  rig.method = to_string(options.method);
  auto alignment = calibration::compare_alignment(nominal, rig);
  if (!alignment) return std::unexpected(alignment.error());
  out.alignment = std::move(*alignment);
  return {};
}

/// A model that the counts contradict is a quality gate that was missed, not a bad recording.
bool is_contradicted(const Error& error) { return error.message.starts_with("calibration refused"); }

void add_gate(const CalibrateOptions& options, std::string sentence, Calibrated& out) {
  const bool passed = out.bundle.has_value();
  out.remarks.gates.push_back({.name = "chi2_per_dof",
                               .passed = passed,
                               .value = passed ? out.bundle->chi2_per_dof : kNaN,
                               .bound = options.bundle.refuse_above,
                               .unit = "",
                               .sentence = std::move(sentence)});
}

}  // namespace

std::string_view to_string(CalibrateMethod method) {
  constexpr EnumNames<CalibrateMethod::scan> kNames{"bundle", "grid-lut", "scan"};
  return kNames[method];
}

Result<Calibrated> calibrate(std::span<const ShownCounts> shown, const data::Rig& nominal,
                             const CalibrateOptions& options) {
  Calibrated out;
  Sorting sorting(nominal, out.remarks.warnings);
  for (const auto& one : shown)
    if (auto s = sorting.add(one); !s) return std::unexpected(s.error());
  const auto evidence = std::move(sorting).take();
  if (!evidence) return std::unexpected(evidence.error());
  auto rig = with_tables(options.method, nominal, *evidence);
  if (!rig) return std::unexpected(rig.error());
  if (options.method != CalibrateMethod::grid_lut) {
    const auto adjusted = adjust(shown, options, nominal, *evidence, *rig, out);
    if (!adjusted && !is_contradicted(adjusted.error())) return std::unexpected(adjusted.error());
    if (!adjusted) add_gate(options, adjusted.error().message, out);
    if (!adjusted || options.align_only) return out;
    add_gate(options, fmt::format("chi2 per degree of freedom is {:.2f}.", out.bundle->chi2_per_dof), out);
  }
  out.rig = std::move(*rig);
  return out;
}

}  // namespace kinemark::workflow
