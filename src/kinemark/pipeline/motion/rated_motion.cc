// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/rated_motion.h"

#include <fmt/core.h>

#include <cmath>
#include <optional>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/data/motion_coordinates.h"
#include "kinemark/data/table.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/math/digital_filter.h"
#include "kinemark/pipeline/files/coordinate_rows.h"
#include "kinemark/pipeline/files/file_hash.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/workflow/prepare/marker_screening.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

/// Deviations that lie beside the motion, when they are of it.
Result<std::optional<data::Table>> read_deviations(const fs::path& motion, const data::Table& table,
                                                   RatedMotion& out) {
  const fs::path path = beside(motion, "_sd.sto");
  std::error_code unreadable;
  if (!fs::exists(path, unreadable)) return std::nullopt;
  auto read = io::read_table(path);
  if (!read) return std::unexpected(read.error());
  if (auto s = check_same_set({{motion, set_in(motion)}, {path, set_in(path)}}); !s)
    return std::unexpected(s.error());
  if (read->columns != table.columns || read->time_s != table.time_s)
    return fail(Code::bad_input, fmt::format("{}: has other columns or rows than {}", path.string(),
                                             motion.filename().string()));
  auto record = record_input("deviations", path);
  if (!record) return std::unexpected(record.error());
  out.inputs.push_back(std::move(*record));
  return std::optional(std::move(*read));
}

void set_deviations(const data::Table& table, const data::ModelDescription& model,
                    data::JointMotion& motion) {
  motion.q_sd.assign(motion.q.size(), kNaN);
  for (std::int64_t c = 0; c < motion.size(); ++c) {
    const auto column = table.find(motion.coordinates[at(c)]);
    const double unit = column_unit(table, model, static_cast<int>(c));
    for (std::int64_t f = 0; f < motion.frames(); ++f)
      motion.q_sd[motion.index(f, c)] = column < 0 ? 0.0 : unit * table(f, column);
  }
}

void low_pass(double cutoff_hz, data::JointMotion& motion) {
  constexpr int kOrder = 3;
  const auto sections = math::butterworth_lowpass(kOrder, cutoff_hz / motion.time.rate_hz);
  std::vector<double> x(at(motion.frames()));
  for (std::int64_t c = 0; c < motion.size(); ++c) {
    for (std::int64_t f = 0; f < motion.frames(); ++f) x[at(f)] = motion.q[motion.index(f, c)];
    math::filter_both_ways(sections, static_cast<int>(motion.frames() / 2), x);
    for (std::int64_t f = 0; f < motion.frames(); ++f) motion.q[motion.index(f, c)] = x[at(f)];
  }
}

/// Coupled coordinates follow those that drive them.
void couple(const model::Model& model, RatedMotion& read) {
  auto& motion = read.motion;
  for (const int c : model.coordinate_order()) {
    const auto& coordinate = model.coordinates()[at(c)];
    if (coordinate.source < 0) continue;
    for (std::int64_t f = 0; f < motion.frames(); ++f) {
      const auto to = motion.index(f, c), from = motion.index(f, coordinate.source);
      motion.q[to] = coordinate.coupling(motion.q[from]).f;
      read.is_filled[to] = read.is_filled[from];
    }
  }
}

/// Coordinates that the file has, as if each were the path of a marker along x.
data::Trajectories as_paths(const RatedMotion& read, const CoordinateRows& rows) {
  const auto& motion = read.motion;
  auto paths = data::Trajectories::all_missing(motion.coordinates, motion.time);
  for (std::int64_t f = 0; f < motion.frames(); ++f)
    for (std::int64_t c = 0; c < motion.size(); ++c) {
      const auto i = motion.index(f, c);
      if (read.is_filled[i] != 0 || rows.is_assumed[at(c)]) continue;
      paths.x(f, c) = Eigen::Vector3d(motion.q[i], 0.0, 0.0);
      paths.state[paths.index(f, c)] = data::SampleState::measured;
    }
  return paths;
}

/// Rates of frames that were made between others are those of what made them, not of the movement.
Status refuse_made_frames(const fs::path& path, const RatedMotion& read, const CoordinateRows& rows) {
  const auto factor = workflow::made_factor(as_paths(read, rows));
  if (!factor) return fail_at(path.string(), factor.error());
  if (*factor == 1) return {};
  return fail(
      Code::bad_input,
      fmt::format("{}: {} of every {} frames were interpolated between the others, which come at {:g} "
                  "Hz; their rates are not those of the movement. Solve the motion from the measured "
                  "frames of its recording ('kinemark clean --upsampled decimate' leaves them), or give "
                  "--cutoff",
                  path.string(), *factor - 1, *factor, read.motion.time.rate_hz / *factor));
}

}  // namespace

Result<RatedMotion> read_rated_motion(const fs::path& path, const model::Model& model, double cutoff_hz) {
  RatedMotion read;
  auto table = io::read_table(path);
  if (!table) return std::unexpected(table.error());
  auto record = record_input("motion", path);
  if (!record) return std::unexpected(record.error());
  read.inputs.push_back(std::move(*record));
  read.notes = table->warnings;
  auto rows = coordinate_rows(model, *table);
  if (!rows) return fail_at(path.string(), rows.error());
  read.notes.insert(read.notes.end(), rows->notes.begin(), rows->notes.end());
  auto& motion = read.motion;
  motion.time = rows->time;
  data::set_coordinates(model.description(), motion);
  for (const auto& q : rows->q) motion.q.insert(motion.q.end(), q.begin(), q.end());
  read.is_filled = std::move(rows->is_filled);
  if (cutoff_hz > 0.0) {
    if (cutoff_hz >= 0.5 * motion.time.rate_hz)
      return fail(Code::usage,
                  fmt::format("a cut-off of {:g} Hz needs more than {:g} Hz; the motion has {:g}", cutoff_hz,
                              2.0 * cutoff_hz, motion.time.rate_hz));
    low_pass(cutoff_hz, motion);
  } else {
    if (auto s = refuse_made_frames(path, read, *rows); !s) return std::unexpected(s.error());
    const auto deviations = read_deviations(path, *table, read);
    if (!deviations) return std::unexpected(deviations.error());
    if (*deviations) set_deviations(**deviations, model.description(), motion);
  }
  couple(model, read);
  motion.determined.assign(motion.q.size(), 1);
  for (std::size_t i = 0; i < motion.q.size(); ++i)
    motion.determined[i] = read.is_filled[i] == 0 && !rows->is_assumed[i % at(motion.size())] &&
                           (motion.q_sd.empty() || !std::isnan(motion.q_sd[i]));
  auto errors = motion::estimate_rates(model, motion);
  if (!errors) return fail_at(path.string(), errors.error());
  read.errors = std::move(*errors);
  return read;
}

}  // namespace kinemark::pipeline
