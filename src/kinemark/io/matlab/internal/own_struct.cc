// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/matlab/internal/own_struct.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/utf8.h"
#include "kinemark/data/calibration_error.h"
#include "kinemark/io/rate.h"

namespace kinemark::io::internal {
namespace {

constexpr std::int64_t kMostFrames = std::int64_t{1} << 52;
constexpr auto kLastState = data::SampleState::rejected;
constexpr auto kLastKind = data::ChannelKind::other;

/// The column of times, which others may have changed, is that of rate and start, to a hundredth of a frame.
Status check_times(const MatPlace& times, double rate_hz, double start_s) {
  if (!times || !times.array->is_numeric()) return {};
  const auto seconds = times.array->numbers();
  for (std::size_t f = 0; f < seconds.size(); ++f)
    if (!(std::abs((seconds[f] - start_s) * rate_hz - static_cast<double>(f)) < 0.01))
      return times.bad(fmt::format("is {} s in row {}; {} Hz from {} s need {}", seconds[f], f + 1, rate_hz,
                                   start_s, start_s + static_cast<double>(f) / rate_hz));
  return {};
}

/// Positions are in metres, whatever else the struct may say.
Status check_units(const MatPlace& units) {
  if (!units || units.text() == "m") return {};
  return units.bad(
      fmt::format("is '{}'; expected m, in which positions are read", printable(units.text(), 20)));
}

/// Rate, clock, frame numbers and labels.
Status read_clock(const MatPlace& in, data::Trial& trial) {
  const auto rate = in("rate").number();
  if (!rate) return std::unexpected(rate.error());
  if (auto s = check_rate(*rate, in("rate").where); !s) return s;
  const auto start = in("start").number();
  if (!start) return std::unexpected(start.error());
  if (!std::isfinite(*start)) return in("start").bad("is no finite time");
  const auto first = in("first_frame").whole(-kMostFrames, kMostFrames);
  if (!first) return std::unexpected(first.error());
  // The column of times, which has a number for each frame, bounds what a few bytes can ask for.
  const MatPlace times = in("time");
  const auto frames = in("frames").whole(0, times && times.array->is_numeric() ? times.array->count() : 0);
  if (!frames) return std::unexpected(frames.error());
  auto labels = in("labels").texts();
  if (!labels) return std::unexpected(labels.error());
  if (auto s = check_times(times, *rate, *start); !s) return s;
  trial.first_frame = *first;
  trial.markers.time = {.rate_hz = *rate, .t0_s = *start, .frames = *frames};
  trial.markers.names = std::move(*labels);
  return {};
}

Status read_states(const MatPlace& in, data::Trajectories& m) {
  const auto status = in("status").bytes(m.frames(), m.markers());
  if (!status) return std::unexpected(status.error());
  m.state.resize(status->size());
  for (std::size_t i = 0; i < m.state.size(); ++i) {
    if ((*status)[i] > std::to_underlying(kLastState))
      return in("status").bad(
          fmt::format("holds {}; expected 0 to {}", (*status)[i], std::to_underlying(kLastState)));
    m.state[i] = static_cast<data::SampleState>((*status)[i]);
  }
  return {};
}

Status read_methods(const MatPlace& in, data::Trajectories& m) {
  if (!in("method")) return {};
  auto names = in("method_names").texts();
  if (!names) return std::unexpected(names.error());
  auto method = in("method").bytes(m.frames(), m.markers());
  if (!method) return std::unexpected(method.error());
  if (!method->empty() && std::cmp_greater(std::ranges::max(*method), names->size()))
    return in("method").bad(fmt::format("names method {} of {}", std::ranges::max(*method), names->size()));
  m.methods = std::move(*names);
  m.method = std::move(*method);
  return {};
}

/// The filter of each marker, and the samples from before it.
Status read_filters(const MatPlace& in, data::Trajectories& m) {
  if (in("unfiltered")) {
    auto unfiltered = in("unfiltered").frame_first(m.frames(), m.markers(), 3);
    if (!unfiltered) return std::unexpected(unfiltered.error());
    m.unfiltered_in_world = std::move(*unfiltered);
  }
  const MatPlace filters = in("filters");
  if (!filters || filters.array->kind != MatClass::structure) return {};
  if (filters.array->count() != m.markers())
    return filters.bad(fmt::format("holds {} filters; expected one for each of {} markers",
                                   filters.array->count(), m.markers()));
  for (std::int64_t i = 0; i < m.markers(); ++i) {
    const auto order = filters("order", i).whole(0, 1000);
    if (!order) return std::unexpected(order.error());
    const auto cutoff = filters("cutoff_hz", i).number(), noise = filters("noise_sd", i).number();
    if (!cutoff) return std::unexpected(cutoff.error());
    if (!noise) return std::unexpected(noise.error());
    m.filters.push_back({.method = filters("method", i).text(),
                         .order = static_cast<int>(*order),
                         .cutoff_hz = *cutoff,
                         .noise_sd_m = *noise});
  }
  return {};
}

Status read_samples(const MatPlace& in, data::Trial& trial) {
  auto& m = trial.markers;
  const std::int64_t F = m.frames(), M = m.markers();
  auto x = in("data").frame_first(F, M, 3);
  if (!x) return std::unexpected(x.error());
  m.x_in_world = std::move(*x);
  if (auto s = read_states(in, m); !s) return s;
  if (auto s = read_methods(in, m); !s) return s;
  if (auto s = read_filters(in, m); !s) return s;
  if (const MatPlace error = in("calibration_error")) {
    auto read = data::calibration_error_of(error.text());
    if (!read) return error.bad("holds no fields of displacement");
    trial.calibration_error = std::move(*read);
  }
  if (in("covariance")) {
    auto covariance = in("covariance").frame_first(F, M, 6);
    if (!covariance) return std::unexpected(covariance.error());
    m.covariance = std::move(*covariance);
  }
  if (const auto offset = in("sample_offset")) {
    auto values = offset.frame_first(offset.array->dim(0) == 1 ? 1 : F, M, 1);
    if (!values) return std::unexpected(values.error());
    m.sample_offset_s = std::move(*values);
  }
  if (in("residual")) {
    const auto residual = in("residual").frame_first(F, M, 1);
    if (!residual) return std::unexpected(residual.error());
    trial.residual_m.resize(residual->size());
    std::ranges::transform(*residual, trial.residual_m.begin(),
                           [](double v) { return static_cast<float>(v); });
  }
  if (in("cameras")) {
    auto cameras = in("cameras").bytes(F, M);
    if (!cameras) return std::unexpected(cameras.error());
    trial.camera_mask = std::move(*cameras);
  }
  return {};
}

Result<data::ChannelKind> kind_of(const MatPlace& in, const std::string& word) {
  for (std::uint8_t k = 0; k <= std::to_underlying(kLastKind); ++k)
    if (data::to_string(static_cast<data::ChannelKind>(k)) == word) return static_cast<data::ChannelKind>(k);
  return in.bad(fmt::format("'{}' is no kind of channel", word));
}

Status read_channels(const MatPlace& in, std::int64_t frames, data::Channels& out) {
  auto names = in("labels").texts();
  if (!names) return std::unexpected(names.error());
  if (names->empty()) return {};
  const auto kinds = in("kinds").texts();
  if (!kinds) return std::unexpected(kinds.error());
  auto units = in("units").texts();
  if (!units) return std::unexpected(units.error());
  const auto rate = in("rate").number();
  if (!rate) return std::unexpected(rate.error());
  auto values = in("data").frame_first(frames, std::ssize(*names), 3);
  if (!values) return std::unexpected(values.error());
  for (const std::string& word : *kinds) {
    const auto kind = kind_of(in("kinds"), word);
    if (!kind) return std::unexpected(kind.error());
    out.kinds.push_back(*kind);
  }
  out.names = std::move(*names);
  out.units = std::move(*units);
  out.rate_hz = *rate;
  out.frames = frames;
  out.values = std::move(*values);
  return {};
}

Status read_analog(const MatPlace& in, data::AnalogChannels& out) {
  auto names = in("labels").texts();
  if (!names) return std::unexpected(names.error());
  if (names->empty()) return {};
  auto units = in("units").texts();
  if (!units) return std::unexpected(units.error());
  const auto rate = in("rate").number();
  if (!rate) return std::unexpected(rate.error());
  if (auto s = check_rate(*rate, in("rate").where); !s) return s;
  out.samples = in("data") ? in("data").array->dim(0) : 0;
  auto values = in("data").frame_first(out.samples, std::ssize(*names), 1);
  if (!values) return std::unexpected(values.error());
  out.names = std::move(*names);
  out.units = std::move(*units);
  out.rate_hz = *rate;
  out.values = std::move(*values);
  return {};
}

Status read_events(const MatPlace& in, std::vector<data::Event>& out) {
  for (std::int64_t i = 0; in && i < in.array->count() && in.array->kind == MatClass::structure; ++i) {
    const auto time = in("time", i).number();
    if (!time) return std::unexpected(time.error());
    out.push_back({.label = in("label", i).text(), .context = in("context", i).text(), .time_s = *time});
  }
  return {};
}

/// What files have that were written since forces are computed from them.
Status read_plate_context(const MatPlace& in, std::int64_t i, data::ForcePlate& out) {
  out.number = static_cast<int>(std::min<std::int64_t>(i + 1, 255));
  if (const auto number = in("number", i)) {
    const auto value = number.whole(1, 255);
    if (!value) return std::unexpected(value.error());
    out.number = static_cast<int>(*value);
  }
  if (const auto metres = in("metres_per_unit", i)) {
    const auto value = metres.number();
    if (!value) return std::unexpected(value.error());
    if (!(*value > 0.0 && *value < 1e3))
      return metres.bad(fmt::format("is {}; need a length in metres", *value));
    out.metres_per_unit = *value;
  }
  return {};
}

/// What corrects the centre of pressure; empty, or absent in files of older versions: nothing does.
Status read_pressure_correction(const MatPlace& in, data::ForcePlate& out) {
  if (!in || in.array->count() == 0) return {};
  const auto numbers = in.numbers({2, 6});
  if (!numbers) return std::unexpected(numbers.error());
  if (!std::ranges::all_of(*numbers, [](double v) { return std::isfinite(v); }))
    return in.bad("holds a value that is no finite number");
  out.pressure_correction.assign(numbers->begin(), numbers->end());
  return {};
}

/// First and last time in which nobody loads the plates.
Status read_unloaded(const MatPlace& in, std::array<double, 2>& out) {
  if (!in) return {};
  const auto times = in.numbers({1, 2});
  if (!times) return std::unexpected(times.error());
  if (!std::isfinite((*times)[0]) || !std::isfinite((*times)[1]))
    return in.bad(fmt::format("is from {} to {} s; need two times", (*times)[0], (*times)[1]));
  out = {(*times)[0], (*times)[1]};
  return {};
}

Status read_plate(const MatPlace& in, std::int64_t i, std::int64_t channels, data::ForcePlate& out) {
  const auto type = in("type", i).whole(0, 255);
  if (!type) return std::unexpected(type.error());
  const auto corners = in("corners", i).numbers({4, 3});
  if (!corners) return std::unexpected(corners.error());
  const auto origin = in("origin", i).numbers({1, 3});
  if (!origin) return std::unexpected(origin.error());
  const MatPlace used = in("channels", i), calibration = in("calibration", i);
  out.type = static_cast<int>(*type);
  for (int c = 0; c < 4; ++c)
    for (int axis = 0; axis < 3; ++axis) out.corners_in_world[c][axis] = (*corners)[4 * axis + c];
  out.origin_in_plate = Eigen::Vector3d((*origin)[0], (*origin)[1], (*origin)[2]);
  for (const double channel : used ? used.array->numbers() : Array<double>()) {
    if (!(channel >= 1.0 && channel <= static_cast<double>(channels)))
      return used.bad(fmt::format("names channel {} of {}", channel, channels));
    out.channel_idx.push_back(static_cast<int>(channel) - 1);
  }
  const auto numbers = calibration ? calibration.array->numbers() : Array<double>();
  out.calibration.assign(numbers.begin(), numbers.end());
  if (!numbers.empty() && !calibration.array->dims.empty())
    out.calibration_rows = static_cast<int>(std::min<std::int64_t>(calibration.array->dims[0], 255));
  if (auto s = read_pressure_correction(in("pressure_correction", i), out); !s) return s;
  return read_plate_context(in, i, out);
}

}  // namespace

std::vector<std::string> mat_state_names() {
  std::vector<std::string> out;
  for (std::uint8_t k = 0; k <= std::to_underlying(kLastState); ++k)
    out.emplace_back(data::to_string(static_cast<data::SampleState>(k)));
  return out;
}

bool is_own_struct(const MatArray& array) {
  return array.kind == MatClass::structure && array.field("kinemark") != nullptr;
}

Result<data::Trial> read_own_struct(const MatArray& array) {
  const MatPlace in{.array = &array, .where = array.name};
  const auto version = in("kinemark").number();
  if (!version) return std::unexpected(version.error());
  if (*version != kMatStruct)
    return fail(Code::not_supported, fmt::format("{}: is version {} of the struct; this program reads {}",
                                                 in("kinemark").where, *version, kMatStruct));
  data::Trial trial;
  trial.units_in_file = "m";
  trial.software = in("software").text();
  if (auto s = check_units(in("units")); !s) return std::unexpected(s.error());
  if (auto s = read_clock(in, trial); !s) return std::unexpected(s.error());
  if (auto s = read_samples(in, trial); !s) return std::unexpected(s.error());
  if (auto s = read_channels(in("channels"), trial.markers.frames(), trial.channels); !s)
    return std::unexpected(s.error());
  if (auto s = read_analog(in("analog"), trial.analog); !s) return std::unexpected(s.error());
  if (auto s = read_events(in("events"), trial.events); !s) return std::unexpected(s.error());
  const MatPlace plates = in("force_plates");
  for (std::int64_t i = 0; plates && plates.array->kind == MatClass::structure && i < plates.array->count();
       ++i)
    if (auto s = read_plate(plates, i, std::ssize(trial.analog.names), trial.force_plates.emplace_back()); !s)
      return std::unexpected(s.error());
  if (auto s = read_unloaded(in("unloaded"), trial.unloaded_s); !s) return std::unexpected(s.error());
  return trial;
}

}  // namespace kinemark::io::internal
