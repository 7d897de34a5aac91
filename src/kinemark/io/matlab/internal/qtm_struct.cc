// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What Qualisys Track Manager exports to MATLAB: M trajectories x 4 (x, y, z, residual) x F frames, mm.
#include "kinemark/io/matlab/internal/qtm_struct.h"

#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/distinct_names.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/matlab/internal/struct_fields.h"
#include "kinemark/io/rate.h"

namespace kinemark::io::internal {
namespace {

using data::SampleState;

constexpr double kMetre_mm = 1e-3;
constexpr std::int64_t kMostFrames = std::int64_t{1} << 40;

/// Trajectories of one kind: labelled or unidentified.
struct Group {
  std::vector<std::string> names;
  Array<double> data;  ///< as in the file: trajectory fastest, then coordinate, then frame
  Array<double> type;  ///< trajectory fastest, then frame; empty when there is none
  std::int64_t rows = 4;
  std::int64_t frames = 0;

  [[nodiscard]] std::int64_t count() const { return std::ssize(names); }
  [[nodiscard]] double value(std::int64_t m, std::int64_t row, std::int64_t f) const {
    return data[static_cast<std::size_t>(m + count() * (row + rows * f))];
  }
};

Result<Group> read_group(const MatPlace& in, bool labelled) {
  Group out;
  const MatPlace data = in("Data");
  if (!data || data.array->count() == 0) return out;
  const std::int64_t count = data.array->dim(0);
  out.rows = data.array->dim(1);
  out.frames = data.array->dim(2);
  if (out.rows != 3 && out.rows != 4)
    return data.bad(
        fmt::format("has {} rows for each trajectory; expected x, y, z and a residual", out.rows));
  auto values = data.numbers({count, out.rows, out.frames});
  if (!values) return std::unexpected(values.error());
  out.data = std::move(*values);
  if (labelled) {
    auto labels = in("Labels").texts();
    if (!labels) return std::unexpected(labels.error());
    if (std::ssize(*labels) != count)
      return in("Labels").bad(fmt::format("names {} of {} trajectories", labels->size(), count));
    out.names = std::move(*labels);
  } else {
    for (std::int64_t m = 0; m < count; ++m) out.names.push_back(fmt::format("uname*{}", m + 1));
  }
  if (!in("Type")) return out;
  auto type = in("Type").numbers({count, out.frames});
  if (!type) return std::unexpected(type.error());
  out.type = std::move(*type);
  return out;
}

/// What a sample is. QTM numbers its types: 0 missing, 1 measured, 2 filled, 3 virtual, 4 edited. Without
/// them, as in older exports, a residual of 0 tells what no camera saw.
SampleState state_of(const Group& group, std::int64_t m, std::int64_t f) {
  for (int axis = 0; axis < 3; ++axis)
    if (!std::isfinite(group.value(m, axis, f))) return SampleState::missing;
  if (group.type.empty())
    return group.rows == 4 && group.value(m, 3, f) == 0.0 ? SampleState::interpolated : SampleState::measured;
  const double type = group.type[static_cast<std::size_t>(m + group.count() * f)];
  if (type == 0.0) return SampleState::missing;
  if (type == 1.0) return SampleState::measured;
  return type == 3.0 ? SampleState::model_filled : SampleState::interpolated;
}

void take_samples(const Group& group, std::int64_t first, data::Trial& trial) {
  auto& markers = trial.markers;
  for (std::int64_t f = 0; f < group.frames; ++f)
    for (std::int64_t m = 0; m < group.count(); ++m) {
      const std::size_t i = markers.index(f, first + m);
      markers.state[i] = state_of(group, m, f);
      if (markers.state[i] == SampleState::missing) continue;
      for (int axis = 0; axis < 3; ++axis)
        markers.x(f, first + m)[axis] = kMetre_mm * group.value(m, axis, f);
      if (group.rows == 4 && markers.state[i] == SampleState::measured)
        trial.residual_m[i] = static_cast<float>(kMetre_mm * group.value(m, 3, f));
    }
}

void name_markers(std::vector<std::string>& names, std::vector<std::string>& warnings) {
  for (std::size_t m = 0; m < names.size(); ++m) {
    names[m] = name_of_bytes(names[m]);
    if (names[m].empty()) names[m] = fmt::format("point {}", m + 1);
  }
  if (const auto repeated = make_distinct(names); repeated.changed > 0)
    warnings.push_back(fmt::format("{} markers have a name that stood before ('{}') and got a number",
                                   repeated.changed, repeated.example));
}

Status read_trajectories(const MatPlace& in, data::Trial& trial) {
  const MatPlace all = in("Trajectories");
  const auto labelled = read_group(all("Labeled"), true);
  if (!labelled) return std::unexpected(labelled.error());
  const auto others = read_group(all("Unidentified"), false);
  if (!others) return std::unexpected(others.error());
  if (labelled->count() > 0 && others->count() > 0 && labelled->frames != others->frames)
    return all.bad(fmt::format("labelled trajectories have {} frames, unidentified ones {}", labelled->frames,
                               others->frames));
  std::vector<std::string> names = labelled->names;
  names.insert(names.end(), others->names.begin(), others->names.end());
  if (names.empty()) return all.bad("holds no trajectory");
  name_markers(names, trial.warnings);
  const auto time = trial.markers.time;
  trial.markers = data::Trajectories::all_missing(
      std::move(names),
      {.rate_hz = time.rate_hz, .t0_s = time.t0_s, .frames = std::max(labelled->frames, others->frames)});
  trial.residual_m.assign(trial.markers.state.size(), std::numeric_limits<float>::quiet_NaN());
  take_samples(*labelled, 0, trial);
  take_samples(*others, labelled->count(), trial);
  if (const auto stated = in("Frames");
      stated && stated.number() && *stated.number() != static_cast<double>(trial.markers.frames()))
    trial.warnings.push_back(fmt::format("Frames says {}, and the trajectories have {}", *stated.number(),
                                         trial.markers.frames()));
  return {};
}

/// Channels x samples, as QTM stores them, after those that are there; those of another rate are left out.
Status add_channels(const MatPlace& data, double rate_hz, const std::vector<std::string>& names,
                    const std::string& unit, data::AnalogChannels& out, std::vector<std::string>& warnings) {
  const std::int64_t samples = data ? data.array->dim(1) : 0;
  const auto values = data.numbers({std::ssize(names), samples});
  if (!values) return std::unexpected(values.error());
  if (values->empty()) return {};
  if (!is_rate(rate_hz) || (!out.names.empty() && (rate_hz != out.rate_hz || samples != out.samples))) {
    warnings.push_back(fmt::format("{}: {} samples at {} Hz do not go with {} at {} Hz and are left out",
                                   data.where, samples, rate_hz, out.samples, out.rate_hz));
    return {};
  }
  const std::size_t before = out.names.size(), added = names.size();
  Array<double> joined(static_cast<std::size_t>(samples) * (before + added));
  for (std::size_t s = 0; s < static_cast<std::size_t>(samples); ++s) {
    for (std::size_t c = 0; c < before; ++c) joined[s * (before + added) + c] = out.values[s * before + c];
    for (std::size_t c = 0; c < added; ++c)
      joined[s * (before + added) + before + c] = (*values)[s * added + c];
  }
  out.names.insert(out.names.end(), names.begin(), names.end());
  out.units.insert(out.units.end(), added, unit);
  out.rate_hz = rate_hz;
  out.samples = samples;
  out.values = std::move(joined);
  return {};
}

double rate_of(const MatPlace& in, std::int64_t i) { return in("Frequency", i).number().value_or(0.0); }

/// Elements of an array of structs; 0 of anything else.
std::int64_t structs(const MatPlace& in) {
  return in && in.array->kind == MatClass::structure && !in.array->fields.empty() ? in.array->count() : 0;
}

Status read_analog(const MatPlace& in, data::Trial& trial) {
  for (std::int64_t i = 0; i < structs(in); ++i) {
    auto labels = in("Labels", i).texts();
    if (!labels) return std::unexpected(labels.error());
    if (labels->empty()) continue;
    for (std::string& label : *labels) label = name_of_bytes(label);
    if (auto s = add_channels(in("Data", i), rate_of(in, i), *labels, "", trial.analog, trial.warnings); !s)
      return s;
  }
  return {};
}

/// What the plates measured, as channels: in what frame, the export does not say.
Status read_forces(const MatPlace& in, data::Trial& trial) {
  const std::int64_t plates = structs(in);
  for (std::int64_t i = 0; i < plates; ++i) {
    std::string plate = name_of_bytes(in("ForcePlateName", i).text());
    if (plate.empty()) plate = fmt::format("plate {}", i + 1);
    const struct {
      const char *field, *letter, *unit;
    } kinds[] = {{"Force", "F", "N"}, {"Moment", "M", "Nm"}, {"COP", "P", "mm"}};
    for (const auto& kind : kinds) {
      if (!in(kind.field, i)) continue;
      std::vector<std::string> names;
      for (const char axis : {'x', 'y', 'z'})
        names.push_back(fmt::format("{} {}{}", plate, kind.letter, axis));
      if (auto s =
              add_channels(in(kind.field, i), rate_of(in, i), names, kind.unit, trial.analog, trial.warnings);
          !s)
        return s;
    }
  }
  if (plates > 0)
    trial.warnings.push_back(
        fmt::format("the {} read as channels; where the plates lie is left out",
                    plates == 1 ? "force plate is" : fmt::format("{} force plates are", plates)));
  return {};
}

Status read_events(const MatPlace& in, data::Trial& trial) {
  for (std::int64_t i = 0; i < structs(in); ++i) {
    const auto time = in("Time", i).number();
    if (time && std::isfinite(*time))
      trial.events.push_back({.label = name_of_bytes(in("Label", i).text()), .context = "", .time_s = *time});
    else
      trial.warnings.push_back(fmt::format("event {} has no time and is not read", i + 1));
  }
  return {};
}

void name_rest(const MatArray& array, std::vector<std::string>& warnings) {
  std::vector<std::string> rest;
  for (const char* field : {"RigidBodies", "Skeletons", "EyeTracker", "GazeVector", "SMPTE"})
    if (const auto* found = array.field(field); found != nullptr && found->count() > 0)
      rest.emplace_back(field);
  if (!rest.empty())
    warnings.push_back(fmt::format("{} not read", join_names(rest, 5) + (rest.size() == 1 ? " is" : " are")));
}

}  // namespace

bool is_qtm_struct(const MatArray& array) {
  return array.kind == MatClass::structure && array.field("Trajectories") != nullptr &&
         array.field("FrameRate") != nullptr;
}

Result<data::Trial> read_qtm_struct(const MatArray& array) {
  const MatPlace in{.array = &array, .where = array.name};
  data::Trial trial{.units_in_file = "mm", .software = "Qualisys Track Manager"};
  const auto rate = in("FrameRate").number();
  if (!rate) return std::unexpected(rate.error());
  if (auto s = check_rate(*rate, in("FrameRate").where); !s) return std::unexpected(s.error());
  if (const auto start = in("StartFrame")) {
    const auto first = start.whole(0, kMostFrames);
    if (!first) return std::unexpected(first.error());
    trial.first_frame = *first;
  }
  trial.markers.time = {.rate_hz = *rate, .t0_s = static_cast<double>(trial.first_frame - 1) / *rate};
  if (auto s = read_trajectories(in, trial); !s) return std::unexpected(s.error());
  if (auto s = read_analog(in("Analog"), trial); !s) return std::unexpected(s.error());
  if (auto s = read_forces(in("Force"), trial); !s) return std::unexpected(s.error());
  if (auto s = read_events(in("Events"), trial); !s) return std::unexpected(s.error());
  name_rest(array, trial.warnings);
  return trial;
}

}  // namespace kinemark::io::internal
