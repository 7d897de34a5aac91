// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Angles in a copy of an NWB file, beside what else that holds.
#include <fmt/core.h>

#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/io/nwb/nwb_tables.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/motion/internal/motion_run.h"

namespace kinemark::pipeline::internal {
namespace {

io::NwbColumn column_of(const data::Table& table, std::int64_t k, std::string name, std::string description) {
  io::NwbColumn out{
      .name = std::move(name), .description = std::move(description), .texts = {}, .numbers = {}};
  for (std::int64_t row = 0; row < table.rows(); ++row) out.numbers.push_back(table(row, k));
  return out;
}

/// A row for each frame: its time, the coordinates, and of each one standard deviation and the bound of its
/// error where they are known.
io::NwbTable angles_table(const data::JointMotion& motion, const report::IkSummary& summary) {
  const auto values = coordinates_table(motion);
  io::NwbTable out{.name = "coordinates",
                   .description = fmt::format("coordinates of the model '{}' by {}, a row for each frame",
                                              summary.run.model, summary.run.method),
                   .columns = {}};
  out.columns.push_back({.name = "time_s",
                         .description = "time of the frame on the clock of the file, s",
                         .texts = {},
                         .numbers = {values.time_s.begin(), values.time_s.end()}});
  const auto deviations = motion.q_sd.empty() ? data::Table() : deviations_table(motion);
  const auto bounds = motion.q_bound.empty() ? data::Table() : bounds_table(motion);
  for (std::int64_t k = 0; k < std::ssize(values.columns); ++k) {
    const auto& name = values.columns[at(k)];
    const auto& coordinate = summary.coordinates[at(k)];
    const std::string unit = !coordinate.is_rotation ? "m" : coordinate.keeps_radians ? "rad" : "deg";
    out.columns.push_back(column_of(values, k, name, fmt::format("{}, {}", name, unit)));
    if (!motion.q_sd.empty())
      out.columns.push_back(column_of(
          deviations, k, name + "_sd",
          fmt::format("one standard deviation of {}, {}; NaN where the markers do not fix it", name, unit)));
    if (!motion.q_bound.empty())
      out.columns.push_back(column_of(bounds, k, name + "_bound",
                                      fmt::format("what the error of {} cannot exceed, {}", name, unit)));
  }
  return out;
}

}  // namespace

void add_nwb_file(const MotionJob& job, const data::JointMotion& motion, const report::IkSummary& summary,
                  const data::Beside& beside, std::vector<ResultFile>& files) {
  if (!job.into_nwb) return;
  const auto write = [&](const std::filesystem::path& staged, const std::string& set) {
    const auto& run = summary.run;
    io::NwbMetadata metadata{.session_description = "joint angles of " + run.trial,
                             .version = run.version,
                             .command = run.command_line,
                             .options = run.options,
                             .set = set,
                             .seed = run.seed};
    for (const auto& input : run.inputs) metadata.sources.push_back({input.path, input.bytes, input.hash});
    const std::vector tables{angles_table(motion, summary)};
    return io::write_nwb_tables(staged, tables, metadata, false, &beside, "kinematics");
  };
  files.push_back({.target = pipeline::beside(job.output, kAnglesFile), .write = write});
}

}  // namespace kinemark::pipeline::internal
