// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/grid_lut.h"

#include <fmt/core.h>

#include <limits>

namespace kinemark::calibration {
namespace {

/// Ratios u, v of the four channels; NaN where a node was not seen.
Eigen::Vector2d ratios(const StillObservation& seen) {
  const double x = seen.counts[0] + seen.counts[1], y = seen.counts[2] + seen.counts[3];
  if (!seen.seen() || !(x > 0.0) || !(y > 0.0))
    return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  return {(seen.counts[0] - seen.counts[1]) / x, (seen.counts[2] - seen.counts[3]) / y};
}

/// Mean growth of the ratios from each seen node to the next, along (u by i) and down (v by j), and
/// crosswise.
struct Growth {
  double along = 0.0, down = 0.0, along_down = 0.0, down_along = 0.0;
};

Growth growth(const GridObservations& grid) {
  Growth out;
  const auto at = [&](int i, int j) {
    return ratios(grid.observations[static_cast<std::size_t>(i * grid.nodes + j)]);
  };
  for (int i = 0; i + 1 < grid.nodes; ++i)
    for (int j = 0; j + 1 < grid.nodes; ++j) {
      const Eigen::Vector2d right = at(i + 1, j) - at(i, j), below = at(i, j + 1) - at(i, j);
      if (!right.allFinite() || !below.allFinite()) continue;
      out.along += right.x();
      out.along_down += right.y();
      out.down += below.y();
      out.down_along += below.x();
    }
  return out;
}

Status check_orientation(const GridObservations& grid, const std::string& camera) {
  const Growth g = growth(grid);
  const double rotated = std::abs(g.along_down) + std::abs(g.down_along),
               straight = std::abs(g.along) + std::abs(g.down);
  if (rotated > straight)
    return fail(
        Code::bad_input,
        fmt::format(
            "the grid hung on its side before camera '{}': its columns run down; turn it by 90 degrees",
            camera));
  if (g.along < 0.0 && g.down < 0.0)
    return fail(Code::bad_input,
                fmt::format("the grid hung upside down before camera '{}'; turn it by 180 degrees", camera));
  if (g.along <= 0.0 || g.down <= 0.0)
    return fail(Code::bad_input,
                fmt::format("camera '{}' saw the grid from behind: it is mirrored; turn it round", camera));
  return {};
}

}  // namespace

Result<GridObservations> grid_observations(const data::Counts& counts, const data::Rig& rig, int camera,
                                           const GridGeometry& geometry, const StillOptions& options) {
  if (auto s = counts.validate(); !s) return std::unexpected(s.error());
  if (camera < 0 || camera >= rig.camera_count() || counts.camera_count() != 1)
    return fail(Code::bad_input,
                fmt::format("a recording of the grid has one camera of the rig; this one has {}",
                            counts.camera_count()));
  if (!counts.rig_id.empty() && !rig.id.empty() && counts.rig_id != rig.id)
    return fail(Code::bad_input,
                fmt::format("the grid was recorded with rig '{}', this rig is '{}'", counts.rig_id, rig.id));
  const std::string& name = rig.cameras[static_cast<std::size_t>(camera)].name;
  if (geometry.nodes < 3 || !(geometry.spacing_m > 0.0) || !(geometry.distance_m > 0.0))
    return fail(Code::usage, fmt::format("a grid of {} nodes a side, {} m apart, at {} m; three or more and "
                                         "positive lengths were expected",
                                         geometry.nodes, geometry.spacing_m, geometry.distance_m));
  if (counts.led_count() != static_cast<std::int64_t>(geometry.nodes) * geometry.nodes)
    return fail(Code::bad_input, fmt::format("the grid before camera '{}' has {} LEDs; {} x {} were expected",
                                             name, counts.led_count(), geometry.nodes, geometry.nodes));
  GridObservations out{.nodes = geometry.nodes,
                       .spacing_m = geometry.spacing_m,
                       .distance_m = geometry.distance_m,
                       .observations = {}};
  int dark = 0;
  for (std::int64_t led = 0; led < counts.led_count(); ++led) {
    out.observations.push_back(
        still_observation(counts, rig.electronics, {0, counts.frames()}, led, 0, options));
    dark += !out.observations.back().seen();
  }
  if (10 * dark > counts.led_count())
    return fail(Code::bad_input,
                fmt::format("{} of {} LEDs of the grid before camera '{}' are dark, saturated or moved", dark,
                            counts.led_count(), name));
  if (auto s = check_orientation(out, name); !s) return std::unexpected(s.error());
  return out;
}

Result<data::Rig> calibrate_grid_lut(const data::Rig& nominal, const std::vector<GridObservations>& grids) {
  if (grids.size() != nominal.cameras.size())
    return fail(Code::bad_input, fmt::format("{} grids for {} cameras; one each was expected", grids.size(),
                                             nominal.cameras.size()));
  data::Rig out = nominal;
  out.method = "grid-lut";
  out.covariance.resize(0, 0);
  out.chi2_per_dof = 0.0;
  for (std::size_t c = 0; c < grids.size(); ++c) {
    auto& table = out.cameras[c].table;
    table = {.nodes = grids[c].nodes,
             .spacing_m = grids[c].spacing_m,
             .distance_m = grids[c].distance_m,
             .uv = {}};
    for (std::size_t node = 0; node < grids[c].observations.size(); ++node) {
      const Eigen::Vector2d uv = ratios(grids[c].observations[node]);
      if (!uv.allFinite())
        return fail(
            Code::bad_input,
            fmt::format(
                "node ({}, {}) of the grid before camera '{}' was not seen; a table needs all of them",
                node / static_cast<std::size_t>(table.nodes), node % static_cast<std::size_t>(table.nodes),
                out.cameras[c].name));
      table.uv.insert(table.uv.end(), {uv.x(), uv.y()});
    }
  }
  return out;
}

}  // namespace kinemark::calibration
