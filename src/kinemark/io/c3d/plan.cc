// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/plan.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "kinemark/core/length_unit.h"
#include "kinemark/io/c3d/foreign_groups.h"
#include "kinemark/io/c3d/layout.h"
#include "kinemark/io/c3d/point_types.h"
#include "kinemark/io/c3d/provenance.h"
#include "kinemark/io/c3d/unfiltered.h"
#include "kinemark/io/set_mark.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kMaxCount = 255;     // what one dimension can hold
constexpr std::size_t kMaxBytes = 32000;   // what a pointer to the next entry can span
constexpr double kIntegerSteps = 32000.0;  // c3d.org's full scale, a little below 32767
constexpr std::int64_t kMaxWord = 65535;

std::string numbered(std::string_view name, int part) {
  return part == 1 ? std::string(name) : fmt::format("{}{}", name, part);
}

void add_number(C3dGroup& group, std::string name, C3dType type, double value) {
  group.parameters.push_back({.name = std::move(name), .type = type, .numbers = {value}});
}

void add_text(C3dGroup& group, std::string name, std::string value) {
  const int width = static_cast<int>(std::clamp<std::size_t>(value.size(), 1, kMaxCount));
  group.parameters.push_back(
      {.name = std::move(name), .type = C3dType::text, .dims = {width}, .texts = {std::move(value)}});
}

/// Texts in NAME, NAME2, ... of at most 255 each.
void add_texts(C3dGroup& group, std::string_view name, const std::vector<std::string>& texts) {
  std::size_t width = 1;
  for (const std::string& text : texts) width = std::max(width, std::min(text.size(), kMaxCount));
  const std::size_t part_size = std::min(kMaxCount, kMaxBytes / width);
  int part = 1;
  for (std::size_t at = 0; at < texts.size() || part == 1; at += part_size) {
    const std::size_t n = std::min(part_size, texts.size() - at);
    const auto begin = texts.begin() + static_cast<std::ptrdiff_t>(at);
    group.parameters.push_back({.name = numbered(name, part++),
                                .type = C3dType::text,
                                .dims = {static_cast<int>(width), static_cast<int>(n)},
                                .texts = {begin, begin + static_cast<std::ptrdiff_t>(n)}});
  }
}

/// Numbers in NAME, NAME2, ...: items of shape `item`, at most 255 items each.
void add_numbers(C3dGroup& group, std::string_view name, C3dType type, const std::vector<int>& item,
                 const std::vector<double>& values) {
  std::size_t size = 1;
  for (const int d : item) size *= static_cast<std::size_t>(d);
  const std::size_t bytes = std::max<std::size_t>(1, size * static_cast<std::size_t>(type));
  const std::size_t part_size = std::clamp<std::size_t>(kMaxBytes / bytes, 1, kMaxCount) * size;
  int part = 1;
  for (std::size_t at = 0; at < values.size() || part == 1; at += part_size) {
    const std::size_t n = std::min(part_size, values.size() - at);
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(at);
    std::vector<int> dims = item;
    dims.push_back(static_cast<int>(n / size));
    group.parameters.push_back({.name = numbered(name, part++),
                                .type = type,
                                .dims = std::move(dims),
                                .numbers = {begin, begin + static_cast<std::ptrdiff_t>(n)}});
  }
}

double largest(const auto& values) {
  double out = 0.0;
  for (const auto v : values)
    if (std::isfinite(v)) out = std::max(out, static_cast<double>(std::abs(v)));
  return out;
}

/// Frame number of the first frame so that frame n is at (n - 1) / rate.
std::int64_t first_frame(const data::Trial& trial) {
  const TimeBase& time = trial.markers.time;
  const auto said = static_cast<double>(std::max<std::int64_t>(0, trial.first_frame - 1));
  const double meant = time.t0_s * time.rate_hz;
  if (trial.first_frame >= 0 && std::abs(meant - said) < 0.01) return trial.first_frame;
  return std::max<std::int64_t>(1, std::llround(meant) + 1);
}

/// Which labels belong to which kind of channel, with the kind's unit and the pairs of TYPE_GROUPS.
void add_channel_lists(C3dGroup& point, const data::Channels& channels, const std::string& length,
                       const std::vector<std::string>& unfiltered) {
  std::vector<std::string> pairs;
  const auto add = [&](std::string_view list, std::string_view singular, data::ChannelKind kind) {
    std::vector<std::string> names;
    std::string unit;
    for (std::size_t c = 0; c < channels.names.size(); ++c) {
      if (channels.kinds[c] != kind) continue;
      const bool is_length = kind == data::ChannelKind::modeled_marker && metres_per_unit(channels.units[c]);
      if (names.empty()) unit = is_length ? length : channels.units[c];
      names.push_back(channels.names[c]);
    }
    if (names.empty()) return;
    add_texts(point, list, names);
    add_text(point, fmt::format("{}_UNITS", singular), std::move(unit));
    pairs.emplace_back(list);
    pairs.emplace_back(singular);
  };
  for (const C3dPointType& type : kC3dPointTypes) add(type.list, type.singular, type.kind);
  add("OTHERS", "OTHER", data::ChannelKind::other);
  if (!unfiltered.empty()) {
    add_texts(point, kC3dUnfilteredList, unfiltered);
    pairs.insert(pairs.end(), 2, std::string(kC3dUnfilteredList));
  }
  if (pairs.empty()) return;
  const int width = static_cast<int>(std::ranges::max(pairs, {}, &std::string::size).size());
  const int count = static_cast<int>(pairs.size() / 2);
  point.parameters.push_back(
      {.name = "TYPE_GROUPS", .type = C3dType::text, .dims = {width, 2, count}, .texts = std::move(pairs)});
}

std::vector<std::string> unfiltered_names(const C3dPlan& plan, const data::Trial& trial) {
  std::vector<std::string> names;
  const std::string prefix = plan.unfiltered.empty() ? "" : unfiltered_prefix(trial);
  for (const auto m : plan.unfiltered)
    names.push_back(prefix + trial.markers.names[static_cast<std::size_t>(m)]);
  return names;
}

/// What points of samples before a filter are, said with each; nothing with all others.
std::vector<std::string> point_descriptions(const C3dPlan& plan, const data::Trial& trial) {
  std::vector<std::string> out(trial.markers.names.size() + trial.channels.names.size());
  for (const auto m : plan.unfiltered)
    out.push_back(
        fmt::format("{} before its filter", trial.markers.names[static_cast<std::size_t>(m)]).substr(0, 255));
  return out;
}

void add_point_group(C3dPlan& plan, const data::Trial& trial, const std::string& units) {
  C3dGroup& point = plan.parameters.group("POINT");
  const std::int64_t frames = trial.markers.frames();
  const bool is_long = frames > kMaxWord;
  const std::vector<std::string> unfiltered = unfiltered_names(plan, trial);
  std::vector<std::string> names = trial.markers.names;
  names.insert(names.end(), trial.channels.names.begin(), trial.channels.names.end());
  names.insert(names.end(), unfiltered.begin(), unfiltered.end());
  add_number(point, "USED", C3dType::int16, static_cast<double>(names.size()));
  // A float here would be legal, too, but several readers accept an integer only.
  add_number(point, "FRAMES", C3dType::int16, static_cast<double>(std::min(frames, kMaxWord)));
  if (is_long) add_number(point, "LONG_FRAMES", C3dType::float32, static_cast<double>(frames));
  add_number(point, "SCALE", C3dType::float32, plan.integers ? plan.scale : -plan.scale);
  add_number(point, "RATE", C3dType::float32, trial.markers.time.rate_hz);
  add_number(point, "DATA_START", C3dType::int16, 0.0);
  add_number(point, std::string(kC3dResidualsParameter), C3dType::int16, 1.0);
  add_text(point, "UNITS", units);
  add_texts(point, "LABELS", names);
  add_texts(point, "DESCRIPTIONS", point_descriptions(plan, trial));
  add_channel_lists(point, trial.channels, units, unfiltered);
}

void add_analog_group(C3dPlan& plan, const data::Trial& trial) {
  C3dGroup& analog = plan.parameters.group("ANALOG");
  const auto channels = trial.analog.names.size();
  add_number(analog, "USED", C3dType::int16, static_cast<double>(channels));
  add_number(analog, "RATE", C3dType::float32,
             trial.markers.time.rate_hz * static_cast<double>(plan.samples_per_frame));
  add_number(analog, "GEN_SCALE", C3dType::float32, 1.0);
  add_numbers(analog, "SCALE", C3dType::float32, {}, plan.analog_scale);
  add_numbers(analog, "OFFSET", C3dType::int16, {}, std::vector<double>(channels, 0.0));
  add_texts(analog, "LABELS", trial.analog.names);
  std::vector<std::string> units = trial.analog.units;
  units.resize(channels);
  add_texts(analog, "UNITS", units);
  add_texts(analog, "DESCRIPTIONS", std::vector<std::string>(channels));
  add_text(analog, "FORMAT", "SIGNED");
  add_number(analog, "BITS", C3dType::int16, 16.0);
}

/// Calibrations of all plates as one array, each padded with zeros to the most rows and columns.
void add_calibrations(C3dGroup& group, const std::vector<data::ForcePlate>& plates) {
  std::size_t rows = 0, columns = 0;
  for (const auto& plate : plates) {
    if (plate.calibration_rows < 1) continue;
    rows = std::max(rows, static_cast<std::size_t>(plate.calibration_rows));
    columns = std::max(columns, plate.calibration.size() / static_cast<std::size_t>(plate.calibration_rows));
  }
  if (rows * columns == 0 || rows > kMaxCount || columns > kMaxCount) return;
  std::vector<double> all(rows * columns * plates.size(), 0.0);
  for (std::size_t p = 0; p < plates.size(); ++p)
    for (std::size_t i = 0; plates[p].calibration_rows > 0 && i < plates[p].calibration.size(); ++i) {
      const auto of_plate = static_cast<std::size_t>(plates[p].calibration_rows);
      all[(p * columns + i / of_plate) * rows + i % of_plate] = plates[p].calibration[i];
    }
  add_numbers(group, "CAL_MATRIX", C3dType::float32, {static_cast<int>(rows), static_cast<int>(columns)},
              all);
}

/// The polynomials of all plates, of each x before y; zeros correct nothing.
void add_pressure_corrections(C3dGroup& group, const std::vector<data::ForcePlate>& plates) {
  if (std::ranges::all_of(plates, [](const auto& plate) { return plate.pressure_correction.empty(); }))
    return;
  std::vector<double> all;
  for (const auto& plate : plates)
    for (std::size_t axis = 0; axis < 2; ++axis)
      for (std::size_t k = 0; k < 6; ++k)
        all.push_back(plate.pressure_correction.empty() ? 0.0 : plate.pressure_correction[axis + 2 * k]);
  add_numbers(group, "FPCOPPOLY", C3dType::float32, {6, 2}, all);
}

/// Frames in which nobody loads the plates, counted from 1.
void add_zero(C3dGroup& group, const data::Trial& trial) {
  constexpr std::int64_t kMaxInteger = 32'767;
  std::vector<double> numbers{0.0, 0.0};
  if (const auto frames = data::unloaded_frames(trial); frames && (*frames)[1] < kMaxInteger)
    numbers = {static_cast<double>((*frames)[0] + 1), static_cast<double>((*frames)[1] + 1)};
  group.parameters.push_back({.name = "ZERO", .type = C3dType::int16, .dims = {2}, .numbers = numbers});
}

void add_force_plates(C3dPlan& plan, const data::Trial& trial) {
  C3dGroup& group = plan.parameters.group("FORCE_PLATFORM");
  std::vector<double> types, corners, origins, channels;
  std::size_t rows = 6;
  for (const data::ForcePlate& plate : trial.force_plates) rows = std::max(rows, plate.channel_idx.size());
  for (const data::ForcePlate& plate : trial.force_plates) {
    types.push_back(plate.type);
    for (const Eigen::Vector3d& corner : plate.corners_in_world)
      for (const double v : corner) corners.push_back(plan.units_per_metre * v);
    for (const double v : plate.origin_in_plate) origins.push_back(plan.units_per_metre * v);
    for (std::size_t r = 0; r < rows; ++r)
      channels.push_back(r < plate.channel_idx.size() ? plate.channel_idx[r] + 1 : 0);
  }
  add_number(group, "USED", C3dType::int16, static_cast<double>(types.size()));
  add_numbers(group, "TYPE", C3dType::int16, {}, types);
  add_zero(group, trial);
  add_numbers(group, "CORNERS", C3dType::float32, {3, 4}, corners);
  add_numbers(group, "ORIGIN", C3dType::float32, {3}, origins);
  add_numbers(group, "CHANNEL", C3dType::int16, {static_cast<int>(rows)}, channels);
  add_calibrations(group, trial.force_plates);
  add_pressure_corrections(group, trial.force_plates);
}

void add_events(C3dPlan& plan, const data::Trial& trial) {
  C3dGroup& group = plan.parameters.group("EVENT");
  std::vector<double> times;
  std::vector<std::string> labels;
  std::vector<std::string> contexts;
  for (const data::Event& event : trial.events) {
    const double minutes = std::floor(event.time_s / 60.0);
    times.push_back(minutes);
    times.push_back(event.time_s - 60.0 * minutes);
    labels.push_back(event.label);
    contexts.push_back(event.context);
  }
  add_number(group, "USED", C3dType::int16, static_cast<double>(labels.size()));
  if (labels.empty()) return;
  add_numbers(group, "TIMES", C3dType::float32, {2}, times);
  add_texts(group, "LABELS", labels);
  add_texts(group, "CONTEXTS", contexts);
}

void add_trial_group(C3dPlan& plan, std::int64_t first, std::int64_t last) {
  C3dGroup& group = plan.parameters.group("TRIAL");
  const auto field = [&](std::string name, std::int64_t frame) {
    group.parameters.push_back(
        {.name = std::move(name),
         .type = C3dType::int16,
         .dims = {2},
         .numbers = {static_cast<double>(frame & 0xffff), static_cast<double>(frame >> 16)}});
  };
  field("ACTUAL_START_FIELD", first);
  field("ACTUAL_END_FIELD", last);
}

Status plan_analog(C3dPlan& plan, const data::Trial& trial) {
  const data::AnalogChannels& analog = trial.analog;
  const auto channels = static_cast<std::int64_t>(analog.names.size());
  const std::int64_t frames = trial.markers.frames();
  plan.analog_scale.assign(analog.names.size(), 1.0);
  if (channels == 0) return {};
  if (analog.samples % frames != 0)
    return fail(Code::bad_input,
                fmt::format("has {} analog samples for {} frames; C3D needs the same number for "
                            "every frame",
                            analog.samples, frames));
  plan.samples_per_frame = analog.samples / frames;
  const double rate_hz = trial.markers.time.rate_hz * static_cast<double>(plan.samples_per_frame);
  if (plan.samples_per_frame > 0 && std::abs(analog.rate_hz - rate_hz) > 1e-3 * rate_hz)
    return fail(Code::bad_input, fmt::format("samples its analog channels at {} Hz; its frames hold {} Hz",
                                             analog.rate_hz, rate_hz));
  if (channels * plan.samples_per_frame > kMaxWord)
    return fail(Code::not_supported, fmt::format("has {} analog values a frame; a C3D file can count {}",
                                                 channels * plan.samples_per_frame, kMaxWord));
  if (!plan.integers) return {};
  std::ranges::fill(plan.analog_scale, 0.0);
  for (std::size_t i = 0; i < analog.values.size(); ++i) {
    double& scale = plan.analog_scale[i % analog.names.size()];
    if (!std::isfinite(analog.values[i]))
      return fail(
          Code::bad_input,
          fmt::format("channel '{}' holds {}, which integer samples cannot represent; write float ones",
                      analog.names[i % analog.names.size()], analog.values[i]));
    scale = std::max(scale, std::abs(analog.values[i]));
  }
  for (double& scale : plan.analog_scale)
    scale = scale > 0.0 ? static_cast<float>(scale / kIntegerSteps) : 1.0F;
  return {};
}

}  // namespace

Result<C3dPlan> plan_c3d(const data::Trial& trial, const C3dWriteOptions& options, bool unfiltered) {
  if (auto status = trial.validate(); !status) return std::unexpected(status.error());
  const std::int64_t frames = trial.markers.frames();
  if (frames == 0) return fail(Code::bad_input, "the trial has no frames; there is nothing to write");
  std::int64_t points = trial.markers.markers() + trial.channels.count();
  if (points > kMaxWord)
    return fail(Code::not_supported, fmt::format("has {} points; a C3D file can count {}", points, kMaxWord));
  const auto metres = metres_per_unit(options.units);
  if (!metres) return fail(Code::usage, fmt::format("'{}' is not a known length unit", options.units));

  C3dPlan plan{
      .processor = options.processor, .integers = options.integers, .units_per_metre = 1.0 / *metres};
  if (unfiltered) plan.unfiltered = unfiltered_markers(trial.markers);
  points += std::ssize(plan.unfiltered);
  if (points > kMaxWord)
    return fail(Code::not_supported,
                fmt::format("has {} points with those of samples before the filter; a C3D file can count {}",
                            points, kMaxWord));
  double scale = largest(trial.markers.x_in_world) / kIntegerSteps;
  if (!plan.unfiltered.empty())
    scale = std::max(scale, largest(trial.markers.unfiltered_in_world) / kIntegerSteps);
  // Float files keep residuals whole by making the step as large as the largest needs.
  if (!plan.integers) scale = std::max(scale, largest(trial.residual_m) / 255.0);
  if (plan.integers) scale = std::max(scale, largest(trial.channels.values) * *metres / kIntegerSteps);
  plan.scale = scale > 0.0 ? static_cast<float>(scale * plan.units_per_metre) : 1.0F;
  // Coordinates that are next to nothing are written as nothing.
  plan.scale = std::max(plan.scale, static_cast<decltype(plan.scale)>(std::numeric_limits<float>::min()));
  if (!std::isfinite(plan.scale))
    return fail(Code::bad_input,
                fmt::format("has coordinates up to {} m; C3D's single precision cannot hold them",
                            scale * kIntegerSteps));
  if (auto status = plan_analog(plan, trial); !status) return std::unexpected(status.error());
  for (std::size_t c = 0; c < trial.channels.names.size(); ++c) {
    const bool is_length = trial.channels.kinds[c] == data::ChannelKind::modeled_marker;
    const auto unit = is_length ? metres_per_unit(trial.channels.units[c]) : std::nullopt;
    plan.channel_factor.push_back(unit ? *unit / *metres : 1.0);
  }

  const std::int64_t first = first_frame(trial);
  const std::int64_t last = first + frames - 1;
  if (last > std::int64_t{65535} * 65536)
    return fail(Code::not_supported, fmt::format("ends at frame {}; a C3D file can count 32 bits", last));
  const bool fits = last <= kMaxWord;
  plan.header = {.points = static_cast<int>(points),
                 .analog_per_frame = static_cast<int>(static_cast<std::int64_t>(trial.analog.names.size()) *
                                                      plan.samples_per_frame),
                 .first_frame = static_cast<int>(fits ? first : 1),
                 .last_frame = static_cast<int>(fits ? last : std::min(frames, kMaxWord)),
                 .scale = static_cast<float>(plan.integers ? plan.scale : -plan.scale),
                 .samples_per_frame = static_cast<int>(plan.samples_per_frame),
                 .rate_hz = static_cast<float>(trial.markers.time.rate_hz)};
  add_point_group(plan, trial, options.units);
  add_analog_group(plan, trial);
  add_force_plates(plan, trial);
  add_events(plan, trial);
  if (first >= 1) add_trial_group(plan, first, last);
  // Who recorded a trial is told by the group that is carried; a trial of no C3D file names who writes.
  const auto tells_recorder = [](const auto& group) {
    return data::foreign_name(group.name) == kC3dRecorderGroup;
  };
  if (std::ranges::none_of(trial.foreign, tells_recorder))
    add_text(plan.parameters.group(kC3dRecorderGroup), "SOFTWARE", options.software);
  add_provenance(trial.markers, plan.parameters);
  add_calibration_error(trial.calibration_error, plan.parameters);
  add_filters(trial, !plan.unfiltered.empty(), plan.parameters);
  if (const std::string mark = set_mark(options.set); !mark.empty())
    plan.parameters.group(kProvenanceGroup)
        .parameters.push_back(
            {.name = "SET", .type = C3dType::text, .dims = {static_cast<int>(mark.size())}, .texts = {mark}});
  return plan;
}

}  // namespace kinemark::io
