// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/motion/given_motion.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/data/motion_coordinates.h"
#include "kinemark/data/table.h"
#include "kinemark/io/input/external_forces.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/pipeline/files/coordinate_rows.h"
#include "kinemark/pipeline/files/file_set.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/files/recording.h"
#include "kinemark/stages/analysis/consistency/table_facts.h"
#include "kinemark/stages/motion/dynamics/inverse_dynamics.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr workflow::HeldFacts kPlatesAlone{.size = false, .sides = false, .pairs = false};

Status record(const char* role, const fs::path& path, MotionOfFiles& out) {
  auto input = io::record_input(role, path);
  if (!input) return std::unexpected(input.error());
  out.inputs.push_back(std::move(*input));
  return {};
}

/// Deviations that lie beside the motion, when they are of it.
Result<std::optional<data::Table>> read_deviations(const fs::path& motion, const data::Table& table,
                                                   MotionOfFiles& out) {
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
  if (auto s = record("deviations", path, out); !s) return std::unexpected(s.error());
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

/// The motion of its rows: what has no column is an assumption.
void take_rows(CoordinateRows rows, const model::Model& model, workflow::GivenMotion& given) {
  auto& motion = given.motion;
  motion.time = rows.time;
  data::set_coordinates(model.description(), motion);
  for (const auto& q : rows.q) motion.q.insert(motion.q.end(), q.begin(), q.end());
  motion.determined.resize(motion.q.size());
  for (std::size_t i = 0; i < motion.q.size(); ++i)
    motion.determined[i] = !rows.is_assumed[i % at(motion.size())];
  given.is_filled = std::move(rows.is_filled);
}

/// Plates of a recording against the feet and the mass of who stands on them.
Status hold_plates(const fs::path& path, MotionOfFiles& out) {
  if (ending_of(path) != ".c3d" && ending_of(path) != ".mat") return {};
  const auto recording = open_recording(
      {.path = path, .rate = io::RateRule::or_unknown, .plates = true, .facts = kPlatesAlone}, {});
  if (!recording) return {};  // it holds forces alone, and these are there
  for (const auto& one : recording->contradicted)
    if (std::ranges::find(out.given.contradicted, one) == out.given.contradicted.end())
      out.given.contradicted.push_back(one);
  return {};
}

Status read_forces(const fs::path& path, MotionOfFiles& out) {
  const double contact_force_n = motion::DynamicsOptions{}.contact_force_n;
  auto read = io::read_external_forces(path, out.given.motion.time, contact_force_n);
  if (!read) return std::unexpected(read.error());
  for (const auto& file : read->files)
    if (auto s = record("forces", file, out); !s) return s;
  for (const auto& warning : read->warnings)
    out.notes.push_back(fmt::format("{}: {}", path.filename().string(), warning));
  out.given.forces = std::move(read->wrenches);
  std::ranges::move(read->contradicted, std::back_inserter(out.given.contradicted));
  return hold_plates(path, out);
}

}  // namespace

Result<MotionOfFiles> read_motion(const fs::path& path, const fs::path& forces, const model::Model& model,
                                  double cutoff_hz) {
  MotionOfFiles out;
  out.given.names = {.motion = path.string(),
                     .forces = forces.string(),
                     .no_deviations = fmt::format("no standard deviations lie beside {} ({}_sd.sto)",
                                                  path.filename().string(), path.stem().string())};
  const auto table = io::read_table(path);
  if (!table) return std::unexpected(table.error());
  if (auto s = record("motion", path, out); !s) return std::unexpected(s.error());
  out.notes = table->warnings;
  auto& contradicted = out.given.contradicted;
  contradicted = analysis::contradicted_values(*table, path.filename().string());
  auto rows = coordinate_rows(model, *table);
  if (!rows) return fail_at(path.string(), rows.error());
  out.notes.insert(out.notes.end(), rows->notes.begin(), rows->notes.end());
  take_rows(std::move(*rows), model, out.given);
  if (!(cutoff_hz > 0.0)) {
    const auto deviations = read_deviations(path, *table, out);
    if (!deviations) return std::unexpected(deviations.error());
    if (*deviations)
      std::ranges::move(
          analysis::contradicted_values(**deviations, beside(path, "_sd.sto").filename().string()),
          std::back_inserter(contradicted));
    if (*deviations) set_deviations(**deviations, model.description(), out.given.motion);
  }
  if (!forces.empty())
    if (auto s = read_forces(forces, out); !s) return std::unexpected(s.error());
  return out;
}

}  // namespace kinemark::pipeline
