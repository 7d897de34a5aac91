// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/counted.h"
#include "kinemark/core/distinct_names.h"
#include "kinemark/core/length_unit.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/file.h"
#include "kinemark/io/sample_clock.h"
#include "kinemark/io/xdf/internal/streams.h"
#include "kinemark/io/xdf/xdf.h"

namespace kinemark::io {
namespace {

using internal::XdfHeader;
using internal::XdfStream;
using internal::XdfStreams;

constexpr std::size_t kNamesInMessage = 5;

std::string words(const XdfHeader& h) {
  return fmt::format("{} ({})", printable(h.name, 80), printable(h.type, 40));
}

/// The stream with most positions, the first of equals.
Result<const XdfStream*> choose(const XdfStreams& all) {
  const XdfStream* out = nullptr;
  std::vector<std::string> names;
  for (const auto& [id, stream] : all.streams) {
    names.push_back(words(stream.header));
    if (stream.header.markers.empty() || stream.time_s.empty()) continue;
    if (out == nullptr || stream.header.markers.size() > out->header.markers.size()) out = &stream;
  }
  if (out == nullptr)
    return fail(
        Code::not_supported,
        fmt::format("holds no samples of channels PositionX, PositionY and PositionZ; its streams: {}",
                    names.empty() ? "none" : join_some(names, kNamesInMessage)));
  return out;
}

/// Metres per unit of each marker; channels without one are taken for metres, which is said.
Result<std::vector<double>> units(const XdfHeader& header, data::Trial& trial) {
  std::vector<double> out;
  trial.units_in_file = header.markers.front().unit;
  for (const auto& marker : header.markers) {
    const auto metres = metres_per_unit(marker.unit);
    if (!metres && !marker.unit.empty())
      return fail(Code::bad_input, fmt::format("{} is in '{}'; expected a unit of length",
                                               printable(marker.name, 80), printable(marker.unit, 40)));
    out.push_back(metres.value_or(1.0));
  }
  if (trial.units_in_file.empty())
    trial.warnings.emplace_back("the stream states no unit of length; metres are assumed");
  return out;
}

void take_positions(const XdfStream& stream, const std::vector<std::int64_t>& frame,
                    const std::vector<double>& metres, data::Trajectories& out) {
  const auto count = static_cast<std::size_t>(out.markers());
  for (std::size_t i = 0; i < frame.size(); ++i)
    for (std::size_t m = 0; m < count; ++m) {
      const double* at = stream.positions.data() + 3 * (i * count + m);
      const Eigen::Vector3d x = metres[m] * Eigen::Vector3d(at[0], at[1], at[2]);
      if (!x.allFinite()) continue;
      out.x(frame[i], static_cast<std::int64_t>(m)) = x;
      out.state[out.index(frame[i], static_cast<std::int64_t>(m))] = data::SampleState::measured;
    }
}

/// Strings of other streams, on the clock of the trial.
void take_events(const XdfStreams& all, const XdfStream& motion, double start_s, data::Trial& trial) {
  std::vector<std::string> left_out;
  for (const auto& [id, stream] : all.streams) {
    if (&stream == &motion || stream.time_s.empty()) continue;
    if (stream.header.format != internal::XdfFormat::string) {
      left_out.push_back(words(stream.header));
      continue;
    }
    auto times = stream.time_s;
    correct_clock(stream.offsets, times);
    for (std::size_t i = 0; i < times.size(); ++i)
      if (std::isfinite(times[i]))
        trial.events.push_back(
            {.label = name_of_bytes(stream.texts[i]), .context = "", .time_s = times[i] - start_s});
  }
  std::ranges::stable_sort(trial.events, {}, &data::Event::time_s);
  if (!left_out.empty())
    trial.warnings.push_back(
        fmt::format("{} left out: {}",
                    left_out.size() == 1 ? "a stream is" : counted(std::ssize(left_out), "stream") + " are",
                    join_some(left_out, kNamesInMessage)));
}

Result<data::Trial> assemble(const XdfStreams& all) {
  const auto chosen = choose(all);
  if (!chosen) return std::unexpected(chosen.error());
  const XdfStream& stream = **chosen;
  const XdfHeader& header = stream.header;
  const auto at = [&](const Error& error) { return fail_at(fmt::format("stream {}", words(header)), error); };
  data::Trial trial{.format = "XDF", .software = header.name, .warnings = all.warnings};
  const auto metres = units(header, trial);
  if (!metres) return at(metres.error());
  auto times = stream.time_s;
  correct_clock(stream.offsets, times);
  const auto clock = find_clock(std::move(times), header.rate_hz);
  if (!clock) return at(clock.error());
  if (clock->rate_hz != header.rate_hz)
    trial.warnings.push_back(
        fmt::format("the stream states {} Hz, and its times say {:.6g} Hz, which is used", header.rate_hz,
                    clock->rate_hz));
  if (clock->dropped > 0)
    trial.warnings.push_back(
        fmt::format("the stream dropped {} of {} (longest gap {:.3g} s); they are missing",
                    counted(clock->dropped, "frame"), clock->frame.back() + 1, clock->widest_gap_s));
  if (header.other_channels > 0)
    trial.warnings.push_back(fmt::format(
        "{} of no position left out", counted(static_cast<std::int64_t>(header.other_channels), "channel")));
  std::vector<std::string> names;
  for (const auto& marker : header.markers) names.push_back(marker.name);
  if (const auto repeated = make_distinct(names); repeated.changed > 0)
    trial.warnings.push_back(
        fmt::format("'{}' is the name of several markers; numbers are added", repeated.example));
  trial.markers = data::Trajectories::all_missing(
      std::move(names), {.rate_hz = clock->rate_hz, .t0_s = 0.0, .frames = clock->frame.back() + 1});
  take_positions(stream, clock->frame, *metres, trial.markers);
  take_events(all, stream, clock->start_s, trial);
  return trial;
}

}  // namespace

bool is_xdf(std::string_view begin) { return begin.starts_with("XDF:"); }

Result<data::Trial> parse_xdf(std::span<const std::byte> bytes, std::string_view name) {
  if (!is_xdf({reinterpret_cast<const char*>(bytes.data()), bytes.size()}))
    return fail(Code::bad_input, fmt::format("{}: does not begin with XDF:", name));
  const auto streams = internal::read_xdf_streams(bytes);
  if (!streams) return fail_at(name, streams.error());
  auto trial = assemble(*streams);
  if (!trial) return fail_at(name, trial.error());
  trial->source = name;
  return trial;
}

Result<data::Trial> read_xdf(const std::filesystem::path& path) {
  const auto bytes = read_text(path);
  if (!bytes) return std::unexpected(bytes.error());
  return parse_xdf(std::as_bytes(std::span(*bytes)), path.string());
}

}  // namespace kinemark::io
