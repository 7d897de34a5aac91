// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/transfer.h"

#include <string>
#include <vector>

#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/nwb/internal/pipe.h"

namespace kinemark::io::internal {
namespace {

constexpr std::uint64_t kBegin = 0x335042574E4D4BULL, kEnd = 0x444E4542574E4D4BULL;
template <class Pipe, class Filters>
void pass_filters(Pipe& pipe, Filters& filters) {
  pass_each(pipe, filters, [&](auto& filter) {
    pass(pipe, filter.method);
    pass(pipe, filter.order);
    pass(pipe, filter.cutoff_hz);
    pass(pipe, filter.noise_sd_m);
  });
}

template <class Pipe, class Trajectories>
void pass_trajectories(Pipe& pipe, Trajectories& t) {
  pass_texts(pipe, t.names);
  pass(pipe, t.time.rate_hz);
  pass(pipe, t.time.t0_s);
  pass(pipe, t.time.frames);
  pass(pipe, t.x_in_world);
  pass(pipe, t.state);
  pass(pipe, t.covariance);
  pass(pipe, t.sample_offset_s);
  pass_texts(pipe, t.methods);
  pass(pipe, t.method);
  pass(pipe, t.unfiltered_in_world);
  pass_filters(pipe, t.filters);
}

template <class Pipe, class Channels>
void pass_channels(Pipe& pipe, Channels& c) {
  pass_texts(pipe, c.names);
  pass_each(pipe, c.kinds, [&](auto& kind) { pass(pipe, kind); });
  pass_texts(pipe, c.units);
  pass(pipe, c.rate_hz);
  pass(pipe, c.frames);
  pass(pipe, c.values);
}

template <class Pipe, class Analog>
void pass_analog(Pipe& pipe, Analog& a) {
  pass_texts(pipe, a.names);
  pass_texts(pipe, a.units);
  pass(pipe, a.rate_hz);
  pass(pipe, a.samples);
  pass(pipe, a.values);
}

template <class Pipe, class Plate>
void pass_plate(Pipe& pipe, Plate& plate) {
  pass(pipe, plate.number);
  pass(pipe, plate.type);
  for (auto& corner : plate.corners_in_world)
    for (auto& x : corner) pass(pipe, x);
  for (auto& x : plate.origin_in_plate) pass(pipe, x);
  pass_each(pipe, plate.channel_idx, [&](auto& channel) { pass(pipe, channel); });
  pass_each(pipe, plate.calibration, [&](auto& number) { pass(pipe, number); });
  pass(pipe, plate.calibration_rows);
  pass_each(pipe, plate.pressure_correction, [&](auto& number) { pass(pipe, number); });
  pass(pipe, plate.metres_per_unit);
}

template <class Pipe, class Error>
void pass_calibration(Pipe& pipe, Error& error) {
  for (auto& x : error.middle_in_world) pass(pipe, x);
  for (auto& x : error.world_from_field.reshaped()) pass(pipe, x);
  pass(pipe, error.scale_m);
  pass_each(pipe, error.fields, [&](auto& field) {
    for (auto& x : field.reshaped()) pass(pipe, x);
  });
}

template <class Pipe, class Beside>
void pass_beside(Pipe& pipe, Beside& beside) {
  pass(pipe, beside.file);
  pass(pipe, beside.room);
  pass_each(pipe, beside.objects, [&](auto& object) {
    for (auto* text : {&object.path, &object.type, &object.unit, &object.lost}) pass(pipe, *text);
    pass_each(pipe, object.shape, [&](auto& size) { pass(pipe, size); });
    pass(pipe, object.rate_hz);
  });
}

/// All of a trial but what names its file.
template <class Pipe, class Trial>
void pass_trial(Pipe& pipe, Trial& trial) {
  pass_trajectories(pipe, trial.markers);
  pass(pipe, trial.first_frame);
  pass_calibration(pipe, trial.calibration_error);
  pass(pipe, trial.residual_m);
  pass(pipe, trial.camera_mask);
  pass_channels(pipe, trial.channels);
  pass_analog(pipe, trial.analog);
  pass_each(pipe, trial.events, [&](auto& event) {
    pass(pipe, event.label);
    pass(pipe, event.context);
    pass(pipe, event.time_s);
  });
  pass_each(pipe, trial.force_plates, [&](auto& plate) { pass_plate(pipe, plate); });
  for (auto& time : trial.unloaded_s) pass(pipe, time);
  pass_texts(pipe, trial.unread);
  pass_beside(pipe, trial.beside);
}

template <class Pipe, class Derivatives>
void pass_derivatives(Pipe& pipe, Derivatives& d) {
  for (const Rate& rate : kRates) pass(pipe, d.*rate.values);
  pass_filters(pipe, d.filters);
}

template <class Pipe, class Metadata>
void pass_metadata(Pipe& pipe, Metadata& m) {
  for (auto* text :
       {&m.identifier, &m.session_description, &m.session_start, &m.created, &m.reference_frame,
        &m.subject_id, &m.species, &m.sex, &m.age, &m.recorder, &m.software, &m.version, &m.command, &m.set})
    pass(pipe, *text);
  pass_each(pipe, m.sources, [&](auto& source) {
    pass(pipe, source.file);
    pass(pipe, source.bytes);
    pass(pipe, source.xxh3);
  });
  pass_each(pipe, m.options, [&](auto& option) {
    pass(pipe, option.first);
    pass(pipe, option.second);
  });
}

/// The whole of an NWB file. What may be absent is told before the rest.
void pass_all(Sink& out, const NwbFile& file) {
  pass(out, file.derivatives.has_value());
  pass(out, file.metadata.seed.has_value());
  pass_trial(out, file.trial);
  pass_metadata(out, file.metadata);
  pass_texts(out, file.warnings);
  if (file.derivatives) pass_derivatives(out, *file.derivatives);
  if (file.metadata.seed) pass(out, *file.metadata.seed);
}
/// False where it is none.
bool pass_all(Source& in, NwbFile& file) {
  std::uint8_t derivatives = 0, seed = 0;
  pass(in, derivatives);
  pass(in, seed);
  pass_trial(in, file.trial);
  pass_metadata(in, file.metadata);
  pass_texts(in, file.warnings);
  if (derivatives == 1) pass_derivatives(in, file.derivatives.emplace());
  if (seed == 1) pass(in, file.metadata.seed.emplace());
  return derivatives <= 1 && seed <= 1;
}

template <class Pipe, class Labels>
void pass_labels(Pipe& pipe, Labels& labels) {
  pass_each(pipe, labels, [&](auto& label) {
    pass(pipe, label.column);
    pass(pipe, label.value);
  });
}

template <class Pipe, class Field>
void pass_field(Pipe& pipe, Field& field) {
  pass(pipe, field.name);
  pass(pipe, field.unit);
  pass_texts(pipe, field.channels);
  pass(pipe, field.rate_hz);
  pass(pipe, field.start_s);
  pass(pipe, field.bin_s);
  pass(pipe, field.bins);
  pass(pipe, field.low);
  pass(pipe, field.high);
}

template <class Pipe, class Neural>
void pass_neural(Pipe& pipe, Neural& neural) {
  pass_each(pipe, neural.units, [&](auto& unit) {
    pass(pipe, unit.id);
    pass_labels(pipe, unit.labels);
    pass_each(pipe, unit.times_s, [&](auto& time) { pass(pipe, time); });
  });
  pass_each(pipe, neural.intervals, [&](auto& table) {
    pass(pipe, table.name);
    pass_each(pipe, table.rows, [&](auto& row) {
      pass(pipe, row.start_s);
      pass(pipe, row.stop_s);
      pass_labels(pipe, row.labels);
    });
  });
  pass_each(pipe, neural.fields, [&](auto& field) { pass_field(pipe, field); });
  pass_texts(pipe, neural.warnings);
}
void pass_all(Sink& out, const data::Neural& neural) { pass_neural(out, neural); }
bool pass_all(Source& in, data::Neural& neural) {
  pass_neural(in, neural);
  return true;
}

template <class Pipe, class Table>
void pass_table(Pipe& pipe, Table& table) {
  pass(pipe, table.frames);
  pass_texts(pipe, table.people);
  pass_texts(pipe, table.points);
  pass(pipe, table.values);
}
void pass_all(Sink& out, const PoseTable& table) { pass_table(out, table); }
bool pass_all(Source& in, PoseTable& table) {
  pass_table(in, table);
  return true;
}

void pass_all(Sink& out, const Carried& carried) { pass_texts(out, carried.content); }
bool pass_all(Source& in, Carried& carried) {
  pass_texts(in, carried.content);
  return true;
}

/// Arrays of the sizes that names and clock promise, as every file of read_nwb() has them.
bool is_sound(const NwbFile& file) {
  const auto& t = file.trial.markers;
  if (t.time.frames < 0 || static_cast<std::size_t>(t.time.frames) > t.x_in_world.size()) return false;
  return file.trial.validate() && (!file.derivatives || file.derivatives->validate(t));
}
bool is_sound(const data::Neural& neural) { return neural.validate().has_value(); }
bool is_sound(const PoseTable& table) { return table.validate().has_value(); }
bool is_sound(const Carried& /*carried*/) { return true; }

template <class T>
bool send_any(int fd, const Result<T>& content) {
  Sink out(fd);
  pass(out, kBegin);
  pass(out, content.has_value());
  if (content) {
    pass_all(out, *content);
  } else {
    pass(out, content.error().code);
    pass(out, content.error().message);
  }
  pass(out, kEnd);
  return out.flush();
}

template <class T>
std::optional<Result<T>> receive_any(int fd, std::size_t most_bytes) {
  Source in(fd, most_bytes);
  std::uint64_t begin = 0, end = 0;
  std::uint8_t there = 0;
  pass(in, begin);
  pass(in, there);
  if (begin != kBegin || there > 1) return std::nullopt;
  if (there == 0) {
    Error error;
    pass(in, error.code);
    pass(in, error.message);
    pass(in, end);
    if (!in.good() || end != kEnd || error.code > Code::cancelled) return std::nullopt;
    return std::unexpected(std::move(error));
  }
  T content;
  const bool fits = pass_all(in, content);
  pass(in, end);
  if (!in.good() || end != kEnd || !fits || !is_sound(content)) return std::nullopt;
  return content;
}

}  // namespace

bool send(int fd, const Result<NwbFile>& file) { return send_any(fd, file); }
bool send(int fd, const Result<PoseTable>& table) { return send_any(fd, table); }
bool send(int fd, const Result<data::Neural>& neural) { return send_any(fd, neural); }
bool send(int fd, const Result<Carried>& carried) { return send_any(fd, carried); }

std::optional<Result<NwbFile>> receive(int fd, std::size_t most_bytes) {
  return receive_any<NwbFile>(fd, most_bytes);
}
std::optional<Result<PoseTable>> receive_poses(int fd, std::size_t most_bytes) {
  return receive_any<PoseTable>(fd, most_bytes);
}
std::optional<Result<data::Neural>> receive_neural(int fd, std::size_t most_bytes) {
  return receive_any<data::Neural>(fd, most_bytes);
}
std::optional<Result<Carried>> receive_carried(int fd, std::size_t most_bytes) {
  return receive_any<Carried>(fd, most_bytes);
}

}  // namespace kinemark::io::internal
