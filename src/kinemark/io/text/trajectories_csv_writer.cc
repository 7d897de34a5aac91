// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <utility>

#include "kinemark/data/calibration_error.h"
#include "kinemark/data/filtering.h"
#include "kinemark/io/file.h"
#include "kinemark/io/text/trajectories_csv.h"
#include "kinemark/math/symmetric3.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kFlushBytes = 1 << 20;

/// A cell in quotes when it holds what would end it. A line break becomes a blank: a line is a sample.
std::string in_quotes(std::string_view cell) {
  std::string out;
  for (const char c : cell) {
    if (c == '"') out += '"';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  // A first or last blank would look like padding.
  const bool needed =
      cell.find_first_of(",\"") != std::string_view::npos || out.starts_with(' ') || out.ends_with(' ');
  return needed ? "\"" + out + "\"" : out;
}

void put_number(fmt::memory_buffer& out, double value) {
  out.push_back(',');
  if (std::isfinite(value)) fmt::format_to(std::back_inserter(out), "{}", value);
}

/// Blank where the marker went through none.
void put_filter(fmt::memory_buffer& out, const data::FilterUsed& filter) {
  if (!data::is_filter(filter)) {
    fmt::format_to(std::back_inserter(out), ",,,,");
    return;
  }
  fmt::format_to(std::back_inserter(out), ",{},{}", in_quotes(filter.method), filter.order);
  put_number(out, filter.cutoff_hz);
  put_number(out, filter.noise_sd_m);
}

}  // namespace

Status write_trajectories_csv(const std::filesystem::path& path, const data::Trial& trial, bool force) {
  if (auto status = trial.validate(); !status) return fail_at(path.string(), status.error());
  auto file = OutputFile::create(path, force);
  if (!file) return std::unexpected(file.error());
  const data::Trajectories& t = trial.markers;
  const bool offsets = !t.sample_offset_s.empty();
  const bool uncertain = !t.covariance.empty();
  const bool filtered = !t.filters.empty(), unfiltered = !t.unfiltered_in_world.empty();
  std::string calibration = data::to_text(trial.calibration_error);  // on the first line alone
  const bool calibrated = !calibration.empty();
  fmt::memory_buffer out;
  fmt::format_to(std::back_inserter(out), "frame,time_s,marker,x_m,y_m,z_m,state,method{}{}{}{}{}\n",
                 offsets ? ",offset_s" : "",
                 uncertain ? ",sd_x_m,sd_y_m,sd_z_m,cov_xy_m2,cov_xz_m2,cov_yz_m2" : "",
                 filtered ? ",filter,filter_order,filter_cutoff_hz,filter_noise_m" : "",
                 unfiltered ? ",unfiltered_x_m,unfiltered_y_m,unfiltered_z_m" : "",
                 calibrated ? ",calibration_error" : "");
  std::vector<std::string> names;
  for (const std::string& name : t.names) names.push_back(in_quotes(name));
  for (std::int64_t f = 0; f < t.frames(); ++f) {
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      const std::size_t i = t.index(f, m);
      fmt::format_to(std::back_inserter(out), "{},{},{}", trial.first_frame + f, t.time.time_s(f),
                     names[static_cast<std::size_t>(m)]);
      for (const double x : t.x(f, m)) put_number(out, x);
      fmt::format_to(std::back_inserter(out), ",{},{}", data::to_string(t.state[i]),
                     in_quotes(t.made_by(f, m)));
      if (offsets)
        put_number(
            out,
            t.sample_offset_s[t.sample_offset_s.size() == t.names.size() ? static_cast<std::size_t>(m) : i]);
      if (uncertain) {
        const double* c = t.covariance.data() + 6 * i;
        for (const std::size_t k : math::kSymmetric3Diagonal) put_number(out, std::sqrt(c[k]));
        for (const auto& pair : math::kSymmetric3Pairs) put_number(out, c[pair.index]);
      }
      if (filtered) put_filter(out, t.filters[static_cast<std::size_t>(m)]);
      if (unfiltered)
        for (std::size_t k = 0; k < 3; ++k) put_number(out, t.unfiltered_in_world[3 * i + k]);
      if (calibrated) fmt::format_to(std::back_inserter(out), ",{}", std::exchange(calibration, {}));
      out.push_back('\n');
    }
    if (out.size() < kFlushBytes) continue;
    if (auto status = file->write(std::string_view(out.data(), out.size())); !status) return status;
    out.clear();
  }
  if (auto status = file->write(std::string_view(out.data(), out.size())); !status) return status;
  return file->commit();
}

}  // namespace kinemark::io
