// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/field_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/counted.h"
#include "kinemark/core/missing.h"
#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/rate.h"

namespace kinemark::io::internal {
namespace {

constexpr std::int64_t kFieldBlock = 1 << 19;

std::unexpected<Error> bad_field(const std::string& path, const std::string& what) {
  return fail(Code::bad_input, fmt::format("{}: {}", path, what));
}

/// Paths of the groups of a type in a group, or in the groups of it.
std::vector<std::string> groups_of(Input& in, const std::string& parent, std::string_view type) {
  std::vector<std::string> out;
  const Handle group = in.object(in.file(), parent);
  if (const auto names = in.children(group.id()))
    for (const auto& name : *names)
      if (const Handle child = in.object(group.id(), name);
          in.text_attribute(child.id(), "neurodata_type") == type)
        out.push_back(parent + "/" + name);
  return out;
}

/// Paths of the series that are drawn.
std::vector<std::string> series_of(Input& in) {
  std::vector<std::string> out, containers = groups_of(in, kAcquisition, "LFP");
  for (const auto& module : groups_of(in, "/processing", "ProcessingModule"))
    for (auto& container : groups_of(in, module, "LFP")) containers.push_back(std::move(container));
  for (const auto& container : containers)
    for (auto& series : groups_of(in, container, "ElectricalSeries")) out.push_back(std::move(series));
  return out.empty() ? groups_of(in, kAcquisition, "ElectricalSeries") : out;
}

/// What a series is, but for its samples.
struct FieldSeries {
  std::string path;
  Handle group, data;
  std::vector<std::int64_t> shape;  ///< S, or S x K
  std::size_t width = 1;
  double t0_s = 0.0, rate_hz = 0.0;
  Array<double> stamps_s;  ///< S; empty: even
  double scale = 1.0, offset = 0.0;
  Array<double> channel_scale;  ///< K; empty: 1 for each

  [[nodiscard]] std::int64_t samples() const { return shape.front(); }
  [[nodiscard]] double time_s(std::int64_t sample) const {
    return stamps_s.empty() ? t0_s + static_cast<double>(sample) / rate_hz
                            : stamps_s[static_cast<std::size_t>(sample)];
  }
};

/// Times, one a sample, as the file lists them.
Status read_stamps(Input& in, FieldSeries& out) {
  const Handle stamps = in.object(out.group.id(), "timestamps");
  auto times = in.numbers<double>(stamps.id());
  if (!times || std::cmp_not_equal(times->size(), out.samples()))
    return bad_field(
        out.path,
        fmt::format("has neither a starting_time nor {} timestamps, one for each sample", out.samples()));
  for (std::size_t i = 0; i < times->size(); ++i)
    if (!std::isfinite((*times)[i]) || (i > 0 && (*times)[i] <= (*times)[i - 1]))
      return bad_field(out.path,
                       fmt::format("has a timestamp {} after sample {}; they must increase", (*times)[i], i));
  out.t0_s = times->front();
  const double length_s = times->back() - times->front();
  out.rate_hz = times->size() > 1 ? static_cast<double>(times->size() - 1) / length_s : 1.0;
  out.stamps_s = std::move(*times);
  return {};
}

Status read_field_clock(Input& in, FieldSeries& out) {
  if (const Handle start = in.object(out.group.id(), "starting_time")) {
    const auto shape = in.number_shape(start.id());
    const auto t0 = shape && shape->empty() ? in.numbers<double>(start.id()) : std::nullopt;
    const auto rate = in.number_attribute(start.id(), "rate");
    if (!t0 || !rate) return bad_field(out.path, "has a starting_time without a number or a rate");
    out.t0_s = t0->front();
    out.rate_hz = *rate;
  } else if (auto s = read_stamps(in, out); !s) {
    return s;
  }
  if (is_rate(out.rate_hz) && std::isfinite(out.t0_s)) return {};
  return bad_field(out.path, fmt::format("runs at {} Hz from {} s; need a rate of {} to {:.0f} Hz",
                                         out.rate_hz, out.t0_s, kSlowest_hz, kFastest_hz));
}

Result<FieldSeries> describe_field(Input& in, const std::string& path) {
  FieldSeries out{.path = path, .group = in.object(in.file(), path)};
  out.data = in.object(out.group.id(), "data");
  const auto shape = in.number_shape(out.data.id());
  if (!shape || shape->empty() || shape->size() > 2 || shape->front() == 0 || shape->back() == 0)
    return bad_field(path, "its data are not numbers of shape samples x channels");
  if (static_cast<std::size_t>(shape->front()) * static_cast<std::size_t>(shape->back()) >
      in.bytes_explained())
    return bad_field(path, "holds more samples than the size of the file allows");
  if (in.holds_bytes(out.data.id()))
    return bad_field(path, "its samples are bytes; expected numbers of a potential");
  out.shape = *shape;
  out.width = shape->size() == 2 ? static_cast<std::size_t>(shape->back()) : 1;
  out.scale = in.number_attribute(out.data.id(), "conversion").value_or(1.0);
  out.offset = in.number_attribute(out.data.id(), "offset").value_or(0.0);
  if (const Handle each = in.object(out.group.id(), "channel_conversion")) {
    auto factors = in.numbers<double>(each.id());
    if (!factors || factors->size() != out.width)
      return bad_field(path, fmt::format("its channel_conversion is not of {} channels", out.width));
    out.channel_scale = std::move(*factors);
  }
  if (auto s = read_field_clock(in, out); !s) return std::unexpected(s.error());
  return out;
}

/// Ids of the electrodes behind the channels, else their numbers from 1.
std::vector<std::string> channel_names(Input& in, const FieldSeries& series, std::size_t count) {
  const Handle rows = in.object(series.group.id(), "electrodes");
  const auto row = in.numbers<double>(rows.id());
  const Handle column = in.object(in.file(), std::string(kElectrodes) + "/id");
  const auto ids = in.numbers<double>(column.id());
  const auto is_row = [&](double r) { return r >= 0.0 && r < static_cast<double>(ids->size()); };
  const bool known = row && ids && row->size() == series.width && std::ranges::all_of(*row, is_row);
  std::vector<std::string> out;
  for (std::size_t k = 0; k < count; ++k)
    out.push_back(known ? fmt::format("electrode {}", (*ids)[static_cast<std::size_t>((*row)[k])])
                        : fmt::format("channel {}", k + 1));
  return out;
}

/// Least and largest values of samples [first, first + count), which are in `block`, into their bins.
void add_block(const FieldSeries& series, std::int64_t first, std::int64_t count,
               const std::vector<double>& block, data::FieldEnvelope& out) {
  const std::size_t channels = out.channels.size();
  for (std::int64_t s = 0; s < count; ++s) {
    const auto at = static_cast<std::int64_t>((series.time_s(first + s) - out.start_s) / out.bin_s);
    const auto bin = static_cast<std::size_t>(std::clamp<std::int64_t>(at, 0, out.bins - 1));
    for (std::size_t k = 0; k < channels; ++k) {
      const double own = series.channel_scale.empty() ? 1.0 : series.channel_scale[k];
      const double value =
          block[static_cast<std::size_t>(s) * series.width + k] * series.scale * own + series.offset;
      if (!std::isfinite(value)) continue;
      double& low = out.low[bin * channels + k];
      double& high = out.high[bin * channels + k];
      low = std::isnan(low) ? value : std::min(low, value);
      high = std::isnan(high) ? value : std::max(high, value);
    }
  }
}

Status read_field(Input& in, const std::string& path, data::Neural& to) {
  const auto series = describe_field(in, path);
  if (!series) return std::unexpected(series.error());
  if (series->samples() > kMostFieldNumbers / static_cast<std::int64_t>(series->width)) {
    to.warnings.push_back(
        fmt::format("{}: {} samples of {} are too many to be drawn; an LFP of a lower rate is", path,
                    series->samples(), counted(static_cast<std::int64_t>(series->width), "channel")));
    return {};
  }
  const std::size_t channels = std::min(series->width, kMostFieldChannels);
  if (series->width > channels)
    to.warnings.push_back(
        fmt::format("{}: the first {} of {} channels are shown", path, channels, series->width));
  data::FieldEnvelope out{.name = path.substr(path.rfind('/') + 1),
                          .unit = in.text_attribute(series->data.id(), "unit").value_or("volts"),
                          .channels = channel_names(in, *series, channels),
                          .rate_hz = series->rate_hz,
                          .start_s = series->time_s(0),
                          .bins = std::min(series->samples(), kFieldBins)};
  const double end_s = series->time_s(series->samples() - 1) + 1.0 / series->rate_hz;
  out.bin_s = (end_s - out.start_s) / static_cast<double>(out.bins);
  if (!(out.bin_s > 0.0) || !std::isfinite(end_s))
    return bad_field(path,
                     fmt::format("goes from {} to {} s, which no clock tells apart", out.start_s, end_s));
  const std::int64_t most = std::max<std::int64_t>(1, kFieldBlock / static_cast<std::int64_t>(series->width));
  const std::int64_t rows = std::min(most, series->samples());
  const auto size = static_cast<std::size_t>(out.bins) * channels;
  if (!in.afford(static_cast<std::size_t>(rows) * series->width, sizeof(double)) ||
      !in.afford(size, 2 * sizeof(double)))
    return bad_field(path, "holds more samples than the size of the file allows");
  out.low.assign(size, kNaN);
  out.high.assign(size, kNaN);
  std::vector<double> block(static_cast<std::size_t>(rows) * series->width);
  for (std::int64_t first = 0; first < series->samples(); first += rows) {
    const std::int64_t count = std::min(rows, series->samples() - first);
    if (!in.read_rows(series->data.id(), series->shape, first, count, block.data()))
      return bad_field(path, "its samples cannot be read; the file may be broken");
    add_block(*series, first, count, block, out);
  }
  to.fields.push_back(std::move(out));
  return {};
}

}  // namespace

Status read_fields(Input& in, data::Neural& out) {
  for (const auto& path : series_of(in))
    if (auto s = read_field(in, path, out); !s) return s;
  return {};
}

}  // namespace kinemark::io::internal
