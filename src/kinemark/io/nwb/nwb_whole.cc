// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A whole recording at once.
#include "kinemark/io/nwb/nwb.h"

namespace kinemark::io {

NwbOutline NwbOutline::of(const data::Trajectories& t, const data::Derivatives* d) {
  NwbOutline out{.names = t.names,
                 .time = t.time,
                 .method = !t.method.empty(),
                 .covariance = !t.covariance.empty(),
                 .unfiltered = !t.unfiltered_in_world.empty(),
                 .filters = !t.filters.empty() || (d != nullptr && !d->filters.empty())};
  if (!t.sample_offset_s.empty())
    out.offsets = t.sample_offset_s.size() == t.names.size() ? Offsets::per_marker : Offsets::per_sample;
  if (d == nullptr) return out;
  out.velocity = !d->velocity.empty();
  out.velocity_sd = !d->velocity_sd.empty();
  out.acceleration = !d->acceleration.empty();
  out.acceleration_sd = !d->acceleration_sd.empty();
  out.jerk = !d->jerk.empty();
  out.jerk_sd = !d->jerk_sd.empty();
  return out;
}

namespace {

/// Positions, and what else a trial holds where there is one.
Status write_whole(const std::filesystem::path& path, const data::Trajectories& trajectories,
                   const data::Trial* trial, const data::Derivatives* derivatives,
                   const NwbMetadata& metadata, const NwbWriteOptions& options) {
  if (derivatives != nullptr)
    if (auto status = derivatives->validate(trajectories); !status)
      return fail_at(path.string(), status.error());
  auto writer = NwbWriter::create(path, NwbOutline::of(trajectories, derivatives), metadata, options);
  if (!writer) return std::unexpected(writer.error());
  if (auto status = writer->write(trajectories, derivatives); !status) return status;
  if (auto status = trial != nullptr ? writer->write_signals(*trial) : Status{}; !status) return status;
  return writer->commit();
}

}  // namespace

Status write_nwb(const std::filesystem::path& path, const data::Trajectories& trajectories,
                 const data::Derivatives* derivatives, const NwbMetadata& metadata,
                 const NwbWriteOptions& options) {
  if (auto status = trajectories.validate(); !status) return fail_at(path.string(), status.error());
  return write_whole(path, trajectories, nullptr, derivatives, metadata, options);
}

Status write_nwb(const std::filesystem::path& path, const data::Trial& trial,
                 const data::Derivatives* derivatives, const NwbMetadata& metadata,
                 const NwbWriteOptions& options) {
  if (auto status = trial.validate(); !status) return fail_at(path.string(), status.error());
  return write_whole(path, trial.markers, &trial, derivatives, metadata, options);
}

}  // namespace kinemark::io
