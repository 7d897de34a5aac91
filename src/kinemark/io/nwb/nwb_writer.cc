// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/core/missing.h"
#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/carry.h"
#include "kinemark/io/nwb/internal/content_digest.h"
#include "kinemark/io/nwb/internal/marker_table.h"
#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/nwb/internal/neural_writer.h"
#include "kinemark/io/nwb/internal/output.h"
#include "kinemark/io/nwb/internal/pose_writer.h"
#include "kinemark/io/nwb/internal/root.h"
#include "kinemark/io/nwb/internal/signals_writer.h"
#include "kinemark/io/nwb/nwb.h"
#include "kinemark/io/temporary.h"

namespace kinemark::io {
namespace {

using internal::Handle;
using internal::Output;

constexpr std::int64_t kBlockFrames = 16 * 4096;

bool holds(const NwbOutline& outline, const internal::Rate& rate) {
  const std::pair<Array<double> data::Derivatives::*, bool> promised[] = {
      {&data::Derivatives::velocity, outline.velocity},
      {&data::Derivatives::velocity_sd, outline.velocity_sd},
      {&data::Derivatives::acceleration, outline.acceleration},
      {&data::Derivatives::acceleration_sd, outline.acceleration_sd},
      {&data::Derivatives::jerk, outline.jerk},
      {&data::Derivatives::jerk_sd, outline.jerk_sd}};
  return std::ranges::any_of(promised, [&](const auto& p) { return p.first == rate.values && p.second; });
}

}  // namespace

/// A file being written.
struct NwbWriter::Open {
  /// One series of every marker, and how its samples lie in memory.
  struct Series {
    std::vector<Handle> of_marker;  ///< M
    int width = 1;
  };

  Open(OutputFile target, std::optional<Temporary> apart, std::string name, NwbOutline promised,
       NwbMetadata given, const NwbWriteOptions& options)
      : file(std::move(target)),
        fresh(std::move(apart)),
        source(fresh ? options.beside->file : std::string()),
        room(fresh && !options.beside->room.empty() ? options.beside->room : internal::kModule),
        path(std::move(name)),
        outline(std::move(promised)),
        metadata(std::move(given)),
        compression(options.compression),
        ndx_pose(options.ndx_pose),
        out((fresh ? fresh->path() : file.temporary()).string(), internal::identity_of(metadata, outline)) {}

  void build();
  void build_pose();
  Series make_series(hid_t module, const char* container, const char* type, const char* unit,
                     const char* description, hid_t file_type, int width, double fill, bool spatial);
  void add_clock(Handle series, std::size_t marker, bool first);
  void write_starts();
  std::vector<std::uint8_t> merge_methods(const std::vector<std::string>& methods);
  /// Write one array of a piece: `width` numbers for each sample, frame first.
  template <class T>
  void put(const Series& series, hid_t memory_type, const T* values, const std::vector<std::size_t>& columns,
           std::int64_t first_frame, std::int64_t frames);
  void put_times(const data::Trajectories& piece, const std::vector<std::size_t>& columns,
                 std::int64_t first_frame);
  void write_tables();

  OutputFile file;
  std::optional<Temporary> fresh;  ///< what is written, where it goes into a copy of `source`
  std::string source, room;        ///< room: the processing module
  std::string path;
  NwbOutline outline;
  NwbMetadata metadata;
  int compression;
  bool ndx_pose;
  Output out;
  Handle module;
  std::vector<std::string> series_names;
  std::map<std::string, std::size_t, std::less<>> index;  ///< of a marker
  Series position, state, method, covariance, unfiltered, offset, stamps, confidence;
  std::vector<Series> rates;  ///< as kRates; empty where the outline has none
  std::vector<std::string> methods;
  std::vector<double> offset_s;                           ///< M
  std::vector<std::pair<std::size_t, Handle>> unclocked;  ///< marker and series without times
  std::vector<data::FilterUsed> filters;                  ///< M
  std::optional<std::int64_t> first_frame;                ///< its number, where signals tell it
};

void NwbWriter::Open::add_clock(Handle series, std::size_t marker, bool first) {
  if (outline.offsets == NwbOutline::Offsets::per_sample) {
    // All series of a marker share one list of times.
    if (first) {
      stamps.of_marker.push_back(
          out.samples(series.id(), "timestamps", H5T_IEEE_F64LE, outline.time.frames, 1, kNaN, compression));
      out.attribute(stamps.of_marker.back().id(), "interval", 1.0, H5T_STD_I32LE);
      out.attribute(stamps.of_marker.back().id(), "unit", "seconds");
    } else {
      out.soft_link(series.id(), "timestamps",
                    fmt::format("{}/{}/{}/timestamps", room, internal::kPosition, series_names[marker]));
    }
    return;
  }
  // Offsets of markers become known with their samples.
  unclocked.emplace_back(marker, std::move(series));
}

void NwbWriter::Open::write_starts() {
  for (const auto& [marker, series] : unclocked) {
    const Handle start = out.number(series.id(), "starting_time", outline.time.t0_s + offset_s[marker]);
    out.attribute(start.id(), "rate", outline.time.rate_hz, H5T_IEEE_F64LE);
    out.attribute(start.id(), "unit", "seconds");
  }
  unclocked.clear();
}

NwbWriter::Open::Series NwbWriter::Open::make_series(hid_t parent, const char* container, const char* type,
                                                     const char* unit, const char* description,
                                                     hid_t file_type, int width, double fill, bool spatial) {
  const Handle group = out.group(parent, container, type);
  Series made{.width = width};
  for (std::size_t m = 0; m < series_names.size(); ++m) {
    Handle series = out.group(group.id(), series_names[m].c_str(), spatial ? "SpatialSeries" : "TimeSeries");
    out.attribute(series.id(), "description", fmt::format("{} of marker {}", description, outline.names[m]));
    out.attribute(series.id(), "comments", "no comments");
    Handle samples =
        out.samples(series.id(), "data", file_type, outline.time.frames, width, fill, compression);
    out.attribute(samples.id(), "unit", unit);
    out.attribute(samples.id(), "conversion", 1.0, H5T_IEEE_F32LE);
    out.attribute(samples.id(), "offset", 0.0, H5T_IEEE_F32LE);
    out.attribute(samples.id(), "resolution", -1.0, H5T_IEEE_F32LE);
    made.of_marker.push_back(std::move(samples));
    if (spatial) {
      out.text(series.id(), "reference_frame", metadata.reference_frame);
      state.of_marker.push_back(
          out.samples(series.id(), "control", H5T_STD_U8LE, outline.time.frames, 1, 0.0, compression));
      std::vector<std::string> states;
      for (const data::SampleState s : internal::kStates) states.emplace_back(data::to_string(s));
      out.texts(series.id(), "control_description", states);
    }
    add_clock(std::move(series), m, spatial);
  }
  return made;
}

void NwbWriter::Open::build() {
  module = internal::write_root(out, metadata, outline, room);
  series_names = internal::series_names(outline.names);
  for (std::size_t m = 0; m < outline.names.size(); ++m) index[outline.names[m]] = m;
  offset_s.assign(outline.names.size(), 0.0);
  filters.assign(outline.names.size(), {.cutoff_hz = kNaN, .noise_sd_m = kNaN});
  const char* many = "BehavioralTimeSeries";
  position = make_series(module.id(), internal::kPosition, "Position", "meters", "position (x, y, z)",
                         H5T_IEEE_F64LE, 3, kNaN, true);
  if (outline.covariance)
    covariance =
        make_series(module.id(), internal::kCovariance, many, "meters^2",
                    "covariance of position (xx, xy, xz, yy, yz, zz)", H5T_IEEE_F64LE, 6, kNaN, false);
  if (outline.unfiltered)
    unfiltered =
        make_series(module.id(), internal::kUnfiltered, many, "meters",
                    "position (x, y, z) as it was before its filter", H5T_IEEE_F64LE, 3, kNaN, false);
  if (outline.method)
    method = make_series(module.id(), internal::kMethod, many, "n.a.",
                         "method that made a sample (0: as recorded, k: id k - 1 of the table 'methods')",
                         H5T_STD_U8LE, 1, 0.0, false);
  if (outline.offsets == NwbOutline::Offsets::per_sample)
    offset = make_series(module.id(), internal::kOffset, many, "seconds", "time of a sample after its frame",
                         H5T_IEEE_F64LE, 1, 0.0, false);
  for (const internal::Rate& rate : internal::kRates)
    rates.push_back(holds(outline, rate) ? make_series(module.id(), rate.container, many, rate.unit,
                                                       rate.description, H5T_IEEE_F64LE, 3, kNaN, false)
                                         : Series{});
  if (ndx_pose) build_pose();
}

void NwbWriter::Open::build_pose() {
  auto series =
      internal::write_pose(out, module.id(), room, metadata, series_names, outline.time.frames, compression);
  for (std::size_t m = 0; m < series.size(); ++m) {
    confidence.of_marker.push_back(std::move(series[m].confidence));
    add_clock(std::move(series[m].series), m, false);
  }
}

std::vector<std::uint8_t> NwbWriter::Open::merge_methods(const std::vector<std::string>& names) {
  std::vector<std::uint8_t> out_of{0};
  for (const std::string& name : names) {
    auto at = std::ranges::find(methods, name);
    if (at == methods.end()) {
      check(methods.size() < 255, "a file holds 255 methods at most");
      at = methods.insert(methods.end(), name);
    }
    out_of.push_back(static_cast<std::uint8_t>(at - methods.begin() + 1));
  }
  return out_of;
}

template <class T>
void NwbWriter::Open::put(const Series& series, hid_t memory_type, const T* values,
                          const std::vector<std::size_t>& columns, std::int64_t first_frame,
                          std::int64_t frames) {
  const auto width = static_cast<std::size_t>(series.width);
  std::vector<T> block;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    for (std::int64_t f = 0; f < frames; f += kBlockFrames) {
      const std::int64_t n = std::min(kBlockFrames, frames - f);
      block.resize(static_cast<std::size_t>(n) * width);
      for (std::size_t i = 0; i < static_cast<std::size_t>(n); ++i) {
        const std::size_t sample = (static_cast<std::size_t>(f) + i) * columns.size() + k;
        std::copy_n(values + sample * width, width, block.data() + i * width);
      }
      out.write(series.of_marker[columns[k]], memory_type, first_frame + f, n, series.width, block.data());
    }
  }
}

void NwbWriter::Open::put_times(const data::Trajectories& piece, const std::vector<std::size_t>& columns,
                                std::int64_t first_frame) {
  const auto& from = piece.sample_offset_s;
  switch (outline.offsets) {
    case NwbOutline::Offsets::none:
      return;
    case NwbOutline::Offsets::per_marker:
      for (std::size_t k = 0; k < columns.size(); ++k) offset_s[columns[k]] = from[k];
      return;
    case NwbOutline::Offsets::per_sample:
      put(offset, H5T_NATIVE_DOUBLE, from.data(), columns, first_frame, piece.frames());
      Array<double> times(from.size());
      for (std::size_t i = 0; i < times.size(); ++i)
        times[i] = outline.time.time_s(first_frame + static_cast<std::int64_t>(i / columns.size())) + from[i];
      put(stamps, H5T_NATIVE_DOUBLE, times.data(), columns, first_frame, piece.frames());
  }
}

void NwbWriter::Open::write_tables() {
  const internal::MarkerTable markers{
      .names = outline.names,
      .series_names = series_names,
      .time = outline.time,
      .first_frame = first_frame,
      .offset_s = outline.offsets == NwbOutline::Offsets::per_marker ? offset_s : std::vector<double>{},
      .filters = outline.filters ? filters : std::vector<data::FilterUsed>{}};
  internal::write_marker_table(out, module.id(), markers);
  if (!methods.empty())
    out.table(module.id(), internal::kMethodsTable, "methods that made samples",
              {{.name = "method", .description = "name of the method", .texts = methods}});
}

NwbWriter::NwbWriter(std::unique_ptr<Open> open) : open_(std::move(open)) {}
NwbWriter::NwbWriter(NwbWriter&& other) noexcept = default;
NwbWriter& NwbWriter::operator=(NwbWriter&& other) noexcept = default;
NwbWriter::~NwbWriter() {
  const internal::Quiet quiet;
  open_.reset();
}

Result<NwbWriter> NwbWriter::create(const std::filesystem::path& path, const NwbOutline& outline,
                                    const NwbMetadata& metadata, const NwbWriteOptions& options) {
  check(options.compression >= 0 && options.compression <= 9, "compression lies in 0 to 9");
  data::Trajectories shape{.names = outline.names, .time = outline.time};
  shape.time.frames = 0;
  if (auto status = shape.validate(); !status) return fail_at(path.string(), status.error());
  if (outline.names.empty() || outline.time.frames <= 0)
    return fail(Code::bad_input,
                fmt::format("{}: has {} markers and {} frames; NWB needs one or more of each", path.string(),
                            outline.names.size(), outline.time.frames));
  if (auto status = internal::check_metadata(metadata); !status)
    return fail_at(path.string(), status.error());
  auto file = OutputFile::create(path, options.force);
  if (!file) return std::unexpected(file.error());
  std::optional<Temporary> fresh;
  if (options.beside != nullptr && !options.beside->file.empty()) {
    auto made = Temporary::file_for(path);
    if (!made) return std::unexpected(made.error());
    fresh.emplace(std::move(*made));
  }
  const internal::Quiet quiet;
  NwbWriter writer(
      std::make_unique<Open>(std::move(*file), std::move(fresh), path.string(), outline, metadata, options));
  writer.open_->build();
  if (writer.open_->out.failed())
    return fail(Code::io, fmt::format("{}: cannot be written (HDF5 failed)", path.string()));
  return writer;
}

Status NwbWriter::write(const data::Trajectories& piece, const data::Derivatives* derivatives,
                        std::int64_t first_frame) {
  check(open_ != nullptr, "the file is written already");
  Open& open = *open_;
  const NwbOutline& outline = open.outline;
  const auto samples = static_cast<std::size_t>(piece.frames() * piece.markers());
  check(first_frame >= 0 && first_frame + piece.frames() <= outline.time.frames,
        "a piece lies outside the outline's frames");
  check(piece.x_in_world.size() == 3 * samples && piece.state.size() == samples, "a piece has a wrong shape");
  check(!outline.covariance || piece.covariance.size() == 6 * samples, "a piece lacks its covariance");
  check(!outline.unfiltered || piece.unfiltered_in_world.size() == 3 * samples,
        "a piece lacks its samples from before the filter");
  check(piece.method.empty() || (outline.method && piece.method.size() == samples),
        "a piece has methods that the outline does not declare");
  const std::size_t times = outline.offsets == NwbOutline::Offsets::none         ? 0
                            : outline.offsets == NwbOutline::Offsets::per_marker ? piece.names.size()
                                                                                 : samples;
  check(piece.sample_offset_s.size() == times, "a piece's sample times are not as the outline declares");
  std::vector<std::size_t> columns;
  for (const std::string& name : piece.names) {
    const auto found = open.index.find(name);
    check(found != open.index.end(), "a piece has a marker that the outline does not name");
    columns.push_back(found->second);
  }

  const internal::Quiet quiet;
  const std::int64_t frames = piece.frames();
  open.put(open.position, H5T_NATIVE_DOUBLE, piece.x_in_world.data(), columns, first_frame, frames);
  open.put(open.state, H5T_NATIVE_UINT8, reinterpret_cast<const std::uint8_t*>(piece.state.data()), columns,
           first_frame, frames);
  if (open.ndx_pose) {
    Array<float> confidence(samples);
    std::ranges::transform(piece.state, confidence.begin(), internal::confidence_of);
    open.put(open.confidence, H5T_NATIVE_FLOAT, confidence.data(), columns, first_frame, frames);
  }
  if (outline.covariance)
    open.put(open.covariance, H5T_NATIVE_DOUBLE, piece.covariance.data(), columns, first_frame, frames);
  if (outline.unfiltered)
    open.put(open.unfiltered, H5T_NATIVE_DOUBLE, piece.unfiltered_in_world.data(), columns, first_frame,
             frames);
  if (!piece.method.empty()) {
    const auto file_number = open.merge_methods(piece.methods);
    Array<std::uint8_t> numbers = piece.method;
    for (std::uint8_t& n : numbers) {
      check(n < file_number.size(), "a sample was made by a method without a name");
      n = file_number[n];
    }
    open.put(open.method, H5T_NATIVE_UINT8, numbers.data(), columns, first_frame, frames);
  }
  open.put_times(piece, columns, first_frame);
  for (std::size_t r = 0; r < internal::kRates.size(); ++r) {
    if (open.rates[r].of_marker.empty()) continue;
    check(derivatives != nullptr && (derivatives->*internal::kRates[r].values).size() == 3 * samples,
          "a piece lacks derivatives that the outline declares");
    open.put(open.rates[r], H5T_NATIVE_DOUBLE, (derivatives->*internal::kRates[r].values).data(), columns,
             first_frame, frames);
  }
  if (outline.filters) {
    const auto& filters =
        piece.filters.empty() && derivatives != nullptr ? derivatives->filters : piece.filters;
    check(filters.size() == columns.size(), "a piece lacks the filters that the outline declares");
    for (std::size_t k = 0; k < columns.size(); ++k) open.filters[columns[k]] = filters[k];
  }
  if (open.out.failed()) return fail(Code::io, fmt::format("{}: cannot be written (HDF5 failed)", open.path));
  return {};
}

Status NwbWriter::write_signals(const data::Trial& trial) {
  check(open_ != nullptr, "the file is written already");
  Open& open = *open_;
  check(trial.markers.names == open.outline.names && trial.markers.frames() == open.outline.time.frames,
        "signals are of other markers than the outline");
  check(!open.first_frame, "signals are written once");
  const internal::Quiet quiet;
  open.first_frame = trial.first_frame;
  internal::write_signals(open.out, open.module.id(), trial, open.series_names, open.compression);
  if (open.out.failed()) return fail(Code::io, fmt::format("{}: cannot be written (HDF5 failed)", open.path));
  return {};
}

Status NwbWriter::write_neural(const data::Neural& neural, const std::vector<data::FieldSamples>& fields) {
  check(open_ != nullptr, "the file is written already");
  if (auto s = neural.validate(); !s) return fail_at(open_->path, s.error());
  const internal::Quiet quiet;
  internal::write_neural(open_->out, neural, fields, open_->compression);
  if (open_->out.failed())
    return fail(Code::io, fmt::format("{}: cannot be written (HDF5 failed)", open_->path));
  return {};
}

Status NwbWriter::commit(const std::string& set) {
  check(open_ != nullptr, "the file is written already");
  const internal::Quiet quiet;
  const std::unique_ptr<Open> open = std::move(open_);
  open->write_tables();
  open->write_starts();
  open->module.close();
  for (Open::Series* series : {&open->position, &open->state, &open->method, &open->covariance,
                               &open->unfiltered, &open->offset, &open->stamps, &open->confidence})
    series->of_marker.clear();
  open->rates.clear();
  internal::seal_whole(open->out, set.empty() ? open->metadata.set : set);
  if (!open->out.close())
    return fail(Code::io, fmt::format("{}: cannot be written (HDF5 failed)", open->path));
  if (open->fresh)
    if (auto s = internal::carry(open->source, open->fresh->path(), open->file, open->path); !s) return s;
  return open->file.commit();
}

}  // namespace kinemark::io
