// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/data/calibration_error.h"
#include "kinemark/io/matlab/internal/mat_build.h"
#include "kinemark/io/matlab/internal/mat_file.h"
#include "kinemark/io/matlab/internal/own_struct.h"
#include "kinemark/io/matlab/mat.h"

namespace kinemark::io {
namespace {

using internal::mat_number;
using internal::mat_numbers;
using internal::mat_struct;
using internal::mat_structs;
using internal::mat_text;
using internal::mat_texts;
using internal::MatDims;
using internal::MatFields;
using internal::to_columns;

std::string times(const TimeBase& time) {
  std::vector<double> out(static_cast<std::size_t>(time.frames));
  for (std::int64_t f = 0; f < time.frames; ++f) out[static_cast<std::size_t>(f)] = time.time_s(f);
  return mat_numbers(out, {time.frames, 1});
}

/// Square roots of the covariances' diagonals, frames x markers x 3.
std::vector<double> deviations(const data::Trajectories& markers) {
  const std::size_t samples = markers.state.size();
  std::vector<double> out(3 * samples);
  for (std::size_t i = 0; i < samples; ++i) {
    const double* c = markers.covariance.data() + 6 * i;
    out[3 * i] = std::sqrt(c[0]);
    out[3 * i + 1] = std::sqrt(c[3]);
    out[3 * i + 2] = std::sqrt(c[5]);
  }
  return out;
}

std::string filters(const std::vector<data::FilterUsed>& all) {
  std::vector<std::vector<std::string>> out;
  for (const data::FilterUsed& filter : all)
    out.push_back({mat_text(filter.method), mat_number(filter.order), mat_number(filter.cutoff_hz),
                   mat_number(filter.noise_sd_m)});
  return mat_structs({"method", "order", "cutoff_hz", "noise_sd"}, out);
}

void add_samples(const data::Trial& trial, MatFields& out) {
  const auto& m = trial.markers;
  const std::int64_t F = m.frames(), M = m.markers();
  const auto put = [&]<class T>(const char* name, std::span<const T> values, std::int64_t depth) {
    const MatDims dims = depth == 1 ? MatDims{F, M} : MatDims{F, M, depth};
    out.emplace_back(name, mat_numbers(std::span<const T>(to_columns(values, F, M, depth)), dims));
  };
  put("data", std::span<const double>(m.x_in_world), 3);
  const auto* states = reinterpret_cast<const std::uint8_t*>(m.state.data());
  put("status", std::span(states, m.state.size()), 1);
  out.emplace_back("status_names", mat_texts(internal::mat_state_names()));
  if (!m.method.empty()) {
    put("method", std::span<const std::uint8_t>(m.method), 1);
    out.emplace_back("method_names", mat_texts(m.methods));
  }
  if (!m.covariance.empty()) {
    put("sd", std::span<const double>(deviations(m)), 3);
    put("covariance", std::span<const double>(m.covariance), 6);
  }
  if (!m.unfiltered_in_world.empty()) put("unfiltered", std::span<const double>(m.unfiltered_in_world), 3);
  if (!m.filters.empty()) out.emplace_back("filters", filters(m.filters));
  if (trial.calibration_error.known())
    out.emplace_back("calibration_error", mat_text(data::to_text(trial.calibration_error)));
  if (!m.sample_offset_s.empty()) {
    const std::int64_t rows = m.sample_offset_s.size() == m.names.size() ? 1 : F;
    out.emplace_back(
        "sample_offset",
        mat_numbers(to_columns(std::span<const double>(m.sample_offset_s), rows, M, 1), {rows, M}));
  }
  if (!trial.residual_m.empty()) put("residual", std::span<const float>(trial.residual_m), 1);
  if (!trial.camera_mask.empty()) put("cameras", std::span<const std::uint8_t>(trial.camera_mask), 1);
}

std::string channels(const data::Channels& c) {
  std::vector<std::string> kinds;
  for (const data::ChannelKind kind : c.kinds) kinds.emplace_back(data::to_string(kind));
  return mat_struct(
      {{"labels", mat_texts(c.names)},
       {"kinds", mat_texts(kinds)},
       {"units", mat_texts(c.units)},
       {"rate", mat_number(c.rate_hz)},
       {"data", mat_numbers(to_columns(std::span<const double>(c.values), c.frames, c.count(), 3),
                            {c.frames, c.count(), 3})}});
}

std::string analog(const data::AnalogChannels& a) {
  const auto count = static_cast<std::int64_t>(a.names.size());
  return mat_struct({{"labels", mat_texts(a.names)},
                     {"units", mat_texts(a.units)},
                     {"rate", mat_number(a.rate_hz)},
                     {"data", mat_numbers(to_columns(std::span<const double>(a.values), a.samples, count, 1),
                                          {a.samples, count})}});
}

std::string events(const std::vector<data::Event>& all) {
  std::vector<std::vector<std::string>> out;
  for (const data::Event& event : all)
    out.push_back({mat_text(event.label), mat_text(event.context), mat_number(event.time_s)});
  return mat_structs({"label", "context", "time"}, out);
}

std::string plate_corners(const data::ForcePlate& plate) {
  std::vector<double> out;
  for (int axis = 0; axis < 3; ++axis)
    for (const auto& corner : plate.corners_in_world) out.push_back(corner[axis]);
  return mat_numbers(out, {4, 3});
}

std::string force_plates(const std::vector<data::ForcePlate>& all) {
  std::vector<std::vector<std::string>> out;
  for (const data::ForcePlate& plate : all) {
    std::vector<double> from_one;
    for (const int channel : plate.channel_idx) from_one.push_back(channel + 1.0);
    const auto size = static_cast<std::int64_t>(plate.calibration.size());
    const auto rows = std::clamp<std::int64_t>(plate.calibration_rows, 1, std::max<std::int64_t>(1, size));
    out.push_back(
        {mat_number(plate.number), mat_number(plate.type), plate_corners(plate),
         mat_numbers(std::span(plate.origin_in_plate.data(), 3), {1, 3}),
         mat_numbers(from_one, {1, static_cast<std::int64_t>(from_one.size())}),
         mat_numbers(plate.calibration, size % rows == 0 ? MatDims{rows, size / rows} : MatDims{size, 1}),
         mat_numbers(plate.pressure_correction,
                     plate.pressure_correction.empty() ? MatDims{0, 0} : MatDims{2, 6}),
         mat_number(plate.metres_per_unit)});
  }
  return mat_structs({"number", "type", "corners", "origin", "channels", "calibration", "pressure_correction",
                      "metres_per_unit"},
                     out);
}

std::string variable(const data::Trial& trial) {
  MatFields out = {{"kinemark", mat_number(internal::kMatStruct)},
                   {"source", mat_text(trial.source)},
                   {"software", mat_text(trial.software)},
                   {"units", mat_text("m")},
                   {"rate", mat_number(trial.markers.time.rate_hz)},
                   {"start", mat_number(trial.markers.time.t0_s)},
                   {"first_frame", mat_number(static_cast<double>(trial.first_frame))},
                   {"frames", mat_number(static_cast<double>(trial.markers.frames()))},
                   {"time", times(trial.markers.time)},
                   {"labels", mat_texts(trial.markers.names)}};
  add_samples(trial, out);
  out.emplace_back("channels", channels(trial.channels));
  out.emplace_back("analog", analog(trial.analog));
  out.emplace_back("events", events(trial.events));
  out.emplace_back("force_plates", force_plates(trial.force_plates));
  out.emplace_back("unloaded", mat_numbers(trial.unloaded_s, {1, 2}));
  return mat_struct(out, "trial");
}

/// Bytes of numbers that a trial becomes.
std::size_t bytes_needed(const data::Trial& trial) {
  const auto& m = trial.markers;
  const std::size_t sd = m.covariance.size() / 2;
  const std::size_t eights = m.x_in_world.size() + m.covariance.size() + sd + m.sample_offset_s.size() +
                             m.unfiltered_in_world.size() + static_cast<std::size_t>(m.frames()) +
                             trial.channels.values.size() + trial.analog.values.size();
  return 8 * eights + m.state.size() + m.method.size() + 4 * trial.residual_m.size() +
         trial.camera_mask.size();
}

}  // namespace

Status write_mat(const std::filesystem::path& path, const data::Trial& trial,
                 const MatWriteOptions& options) {
  if (auto s = trial.validate(); !s) return fail_at(path.string(), s.error());
  const auto too_large = [&] {
    return fail(Code::not_supported,
                fmt::format("{}: the trial needs more than the 2 GB that a variable of a MAT file can have; "
                            "write a part of it, or NWB (.nwb)",
                            path.string()));
  };
  if (bytes_needed(trial) > internal::kMostVariableBytes) return too_large();
  const std::string bytes = variable(trial);
  if (bytes.size() > internal::kMostVariableBytes) return too_large();
  return internal::write_mat_file(path, bytes, options);
}

}  // namespace kinemark::io
