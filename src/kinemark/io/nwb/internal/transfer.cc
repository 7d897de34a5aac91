// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/transfer.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <type_traits>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/io/nwb/internal/names.h"

namespace kinemark::io::internal {
namespace {

constexpr std::uint64_t kBegin = 0x335042574E4D4BULL, kEnd = 0x444E4542574E4D4BULL;
constexpr std::size_t kBuffer = 1 << 16;

/// Bytes out, gathered into large pieces.
class Sink {
 public:
  explicit Sink(int fd) : fd_(fd) {}

  void bytes(const void* from, std::size_t size) {
    if (size < kBuffer) {
      buffer_.append(static_cast<const char*>(from), size);
      if (buffer_.size() >= kBuffer) flush();
    } else {
      flush();
      put(static_cast<const char*>(from), size);
    }
  }
  bool flush() {
    put(buffer_.data(), buffer_.size());
    buffer_.clear();
    return good_;
  }

 private:
  void put(const char* from, std::size_t size) {
    while (good_ && size > 0) {
      const ssize_t n = ::write(fd_, from, size);
      if (n < 0 && errno == EINTR) continue;
      good_ = n > 0;
      from += n;
      size -= static_cast<std::size_t>(n);
    }
  }

  int fd_;
  bool good_ = true;
  std::string buffer_;
};

/// Bytes in, at most so many. After a failure everything reads as zero.
class Source {
 public:
  Source(int fd, std::size_t most_bytes) : fd_(fd), left_(most_bytes), buffer_(kBuffer) {}

  void bytes(void* out, std::size_t size) {
    auto* to = static_cast<char*>(out);
    while (good_ && size > 0) {
      if (at_ < filled_) {
        const std::size_t n = std::min(size, filled_ - at_);
        std::copy_n(buffer_.data() + at_, n, to);
        at_ += n;
        to += n;
        size -= n;
      } else if (size >= kBuffer) {
        const std::size_t n = get(to, size);
        to += n;
        size -= n;
      } else {
        filled_ = get(buffer_.data(), kBuffer);
        at_ = 0;
      }
    }
    std::fill_n(to, size, '\0');
  }
  /// A number of elements of that size, no more than may still come.
  std::size_t count(std::size_t element_bytes) {
    std::uint64_t n = 0;
    bytes(&n, sizeof n);
    if (n > left_ / element_bytes) good_ = false;
    if (!good_) return 0;
    left_ -= n * element_bytes;
    return n;
  }
  [[nodiscard]] bool good() const { return good_; }

 private:
  std::size_t get(char* to, std::size_t size) {
    while (true) {
      const ssize_t n = ::read(fd_, to, size);
      if (n < 0 && errno == EINTR) continue;
      good_ = n > 0;
      return n > 0 ? static_cast<std::size_t>(n) : 0;
    }
  }

  int fd_;
  std::size_t left_;
  bool good_ = true;
  std::vector<char> buffer_;
  std::size_t at_ = 0, filled_ = 0;
};

/// The order of everything is written once: `pass` is the same code for both directions.
void pass(Sink& out, const std::string& text) {
  const std::uint64_t size = text.size();
  out.bytes(&size, sizeof size);
  out.bytes(text.data(), text.size());
}
void pass(Source& in, std::string& text) {
  text.resize(in.count(1));
  in.bytes(text.data(), text.size());
}

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

template <Plain T>
void pass(Sink& out, const T& value) {
  out.bytes(&value, sizeof value);
}
template <Plain T>
void pass(Source& in, T& value) {
  in.bytes(&value, sizeof value);
}

template <Plain T>
void pass(Sink& out, const Array<T>& values) {
  const std::uint64_t size = values.size();
  out.bytes(&size, sizeof size);
  out.bytes(values.data(), size * sizeof(T));
}
template <Plain T>
void pass(Source& in, Array<T>& values) {
  values.resize(in.count(sizeof(T)));
  in.bytes(values.data(), values.size() * sizeof(T));
}

template <class Pipe, class List, class Each>
void pass_each(Pipe& pipe, List& list, const Each& each) {
  if constexpr (std::is_same_v<Pipe, Sink>) {
    const std::uint64_t size = list.size();
    pipe.bytes(&size, sizeof size);
    for (auto& element : list) each(element);
  } else {
    for (std::size_t left = pipe.count(1); left > 0 && pipe.good(); --left) each(list.emplace_back());
  }
}

template <class Pipe, class Texts>
void pass_texts(Pipe& pipe, Texts& texts) {
  pass_each(pipe, texts, [&](auto& text) { pass(pipe, text); });
}

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
bool send(int fd, const Result<Carried>& carried) { return send_any(fd, carried); }

std::optional<Result<NwbFile>> receive(int fd, std::size_t most_bytes) {
  return receive_any<NwbFile>(fd, most_bytes);
}
std::optional<Result<PoseTable>> receive_poses(int fd, std::size_t most_bytes) {
  return receive_any<PoseTable>(fd, most_bytes);
}
std::optional<Result<Carried>> receive_carried(int fd, std::size_t most_bytes) {
  return receive_any<Carried>(fd, most_bytes);
}

}  // namespace kinemark::io::internal
