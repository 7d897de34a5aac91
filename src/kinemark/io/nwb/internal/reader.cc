// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "kinemark/core/missing.h"
#include "kinemark/data/calibration_error.h"
#include "kinemark/io/nwb/internal/beside.h"
#include "kinemark/io/nwb/internal/content_digest.h"
#include "kinemark/io/nwb/internal/content_list.h"
#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/nwb/internal/pose_reader.h"
#include "kinemark/io/nwb/internal/series.h"
#include "kinemark/io/nwb/internal/signals_reader.h"

namespace kinemark::io::internal {
namespace {

using data::SampleState;
using data::Trajectories;

std::unexpected<Error> too_large(const std::string& what) {
  return fail(Code::bad_input, what + ": holds more samples than the size of the file allows");
}

/// What each value of `control` means, where all of them are names of states.
std::vector<SampleState> control_states(Input& in, hid_t series) {
  const Handle labels = in.object(series, "control_description");
  const auto names = in.texts(labels.id());
  std::vector<SampleState> out;
  if (!names) return out;
  for (const std::string& name : *names) {
    const auto state =
        std::ranges::find_if(kStates, [&](SampleState s) { return data::to_string(s) == name; });
    if (state == kStates.end()) return {};
    out.push_back(*state);
  }
  return out;
}

/// States stored in the file, or `measured` for all.
std::vector<SampleState> read_states(Input& in, hid_t series, std::size_t frames) {
  std::vector<SampleState> out(frames, SampleState::measured);
  if (const std::vector<SampleState> meaning = control_states(in, series); !meaning.empty()) {
    const Handle control = in.object(series, "control");
    const auto numbers = in.numbers<std::uint8_t>(control.id());
    if (numbers && numbers->size() == frames)
      for (std::size_t i = 0; i < frames; ++i)
        if ((*numbers)[i] < meaning.size()) out[i] = meaning[(*numbers)[i]];
  }
  if (const Handle confidence = in.object(series, "confidence")) {
    const auto values = in.numbers<double>(confidence.id());
    if (values && values->size() == frames)
      for (std::size_t i = 0; i < frames; ++i)
        if (!((*values)[i] > 0.0)) out[i] = SampleState::missing;
  }
  return out;
}

Status read_marker(Input& in, const PositionSeries& from, std::int64_t marker, Trajectories& out) {
  const Handle series = in.object(in.file(), from.path);
  const Handle data = in.object(series.id(), "data");
  const auto numbers = in.numbers<double>(data.id());
  const auto width = static_cast<std::size_t>(from.width);
  const auto frames = static_cast<std::size_t>(out.frames());
  if (!numbers)
    return fail(Code::bad_input, from.path + ": its samples cannot be read; the file may be broken");
  if (numbers->size() != frames * width)
    return fail(Code::bad_input, from.path + ": changed while it was read");
  const std::vector<SampleState> states = read_states(in, series.id(), frames);
  // Numbers in metres are kept as they are, to the last bit.
  const bool as_they_are = from.metres_per_number == 1.0 && from.metres_offset == 0.0;
  for (std::int64_t f = 0; f < out.frames(); ++f) {
    const auto i = static_cast<std::size_t>(f);
    auto x = out.x(f, marker);
    x.z() = 0.0;
    for (std::size_t k = 0; k < width; ++k) {
      const double v = (*numbers)[i * width + k];
      x[static_cast<Eigen::Index>(k)] = as_they_are ? v : v * from.metres_per_number + from.metres_offset;
    }
    out.state[out.index(f, marker)] = states[i];
    if (!out.present(f, marker))
      out.set_missing(f, marker, states[i]);
    else if (!x.allFinite())
      out.set_missing(f, marker);
  }
  return {};
}

/// One container of ours, `width` numbers a sample, into a frame-first array; nothing when there is none.
template <class T>
Status read_container(Input& in, const PositionGroup& group, const char* container, std::size_t width,
                      std::size_t frames, Array<T>& out) {
  const std::string path = fmt::format("{}/{}", module_of(in), container);
  if (!in.object(in.file(), path)) return {};
  const std::size_t markers = group.series.size();
  if (!in.afford(frames * markers * width, sizeof(T))) return too_large(path);
  out.resize(frames * markers * width);
  for (std::size_t m = 0; m < markers; ++m) {
    const std::string series = fmt::format("{}/{}", path, group.series_names[m]);
    const Handle data = in.object(in.file(), series + "/data");
    const auto numbers = in.numbers<T>(data.id());
    if (!numbers || numbers->size() != frames * width)
      return fail(Code::bad_input,
                  fmt::format("{}: does not hold {} samples of {} numbers", series, frames, width));
    for (std::size_t f = 0; f < frames; ++f)
      std::copy_n(numbers->data() + f * width, width, out.data() + (f * markers + m) * width);
  }
  return {};
}

Result<std::vector<data::FilterUsed>> read_filters(Input& in, std::size_t markers) {
  const Handle table = in.object(in.file(), fmt::format("{}/{}", module_of(in), kMarkersTable));
  const auto numbers = [&](const char* name) {
    const Handle column = in.object(table.id(), name);
    return in.numbers<double>(column.id());
  };
  const Handle names = in.object(table.id(), "filter");
  if (!names) return std::vector<data::FilterUsed>{};
  const auto methods = in.texts(names.id());
  const auto order = numbers("filter_order");
  const auto cutoff_hz = numbers("filter_cutoff_hz");
  const auto noise_sd_m = numbers("filter_noise_sd_m");
  if (!methods || !order || !cutoff_hz || !noise_sd_m || methods->size() != markers ||
      order->size() != markers || cutoff_hz->size() != markers || noise_sd_m->size() != markers)
    return fail(Code::bad_input, "its table of markers does not give a filter for each");
  std::vector<data::FilterUsed> out;
  for (std::size_t m = 0; m < markers; ++m)
    out.push_back({.method = (*methods)[m],
                   .order = static_cast<int>(std::clamp((*order)[m], -1e9, 1e9)),
                   .cutoff_hz = (*cutoff_hz)[m],
                   .noise_sd_m = (*noise_sd_m)[m]});
  return out;
}

/// Number of the first frame: as the table of markers says, else from its time.
Status read_first_frame(Input& in, data::Trial& trial) {
  const double from_time = trial.markers.time.t0_s * trial.markers.time.rate_hz;
  if (from_time > 0.0 && from_time < 1e15) trial.first_frame = std::llround(from_time) + 1;
  const std::string path = fmt::format("{}/{}/first_frame", module_of(in), kMarkersTable);
  const Handle column = in.object(in.file(), path);
  if (!column) return {};
  const auto numbers = in.numbers<double>(column.id());
  if (!numbers || numbers->empty() || !(std::abs(numbers->front()) <= 1e15))
    return fail(Code::bad_input, path + ": holds no number of a frame");
  trial.first_frame = std::llround(numbers->front());
  return {};
}

/// Residuals and cameras of markers.
Status read_reconstruction(Input& in, const PositionGroup& group, data::Trial& trial) {
  const auto frames = static_cast<std::size_t>(trial.markers.frames());
  Array<double> residual;
  if (auto s = read_container(in, group, kResidual, 1, frames, residual); !s) return s;
  trial.residual_m.resize(residual.size());
  std::ranges::transform(residual, trial.residual_m.begin(), [](double r) { return static_cast<float>(r); });
  return read_container(in, group, kCameras, 1, frames, trial.camera_mask);
}

/// What only our files hold.
Status read_extras(Input& in, const PositionGroup& group, NwbFile& out) {
  if (auto status = read_reconstruction(in, group, out.trial); !status) return status;
  if (auto status = read_signals(in, out.trial); !status) return status;
  Trajectories& t = out.trial.markers;
  const auto frames = static_cast<std::size_t>(t.frames());
  t.sample_offset_s = group.offset_s;
  if (auto status = read_container(in, group, kOffset, 1, frames, t.sample_offset_s); !status) return status;
  if (auto status = read_container(in, group, kCovariance, 6, frames, t.covariance); !status) return status;
  if (auto status = read_container(in, group, kUnfiltered, 3, frames, t.unfiltered_in_world); !status)
    return status;
  if (auto status = read_container(in, group, kMethod, 1, frames, t.method); !status) return status;
  const Handle methods = in.object(in.file(), fmt::format("{}/{}/method", module_of(in), kMethodsTable));
  if (auto names = in.texts(methods.id()); names && names->size() <= 255) t.methods = std::move(*names);

  const Handle calibration =
      in.object(in.file(), fmt::format("{}/{}/error", module_of(in), kCalibrationTable));
  if (const auto texts = in.texts(calibration.id()); texts && !texts->empty()) {
    auto error = data::calibration_error_of(texts->front());
    if (!error)
      return fail(Code::bad_input, "its table of the calibration's error holds no fields of displacement");
    out.trial.calibration_error = std::move(*error);
  }

  data::Derivatives rates;
  bool any = false;
  for (const Rate& rate : kRates) {
    if (auto status = read_container(in, group, rate.container, 3, frames, rates.*rate.values); !status)
      return status;
    any = any || !(rates.*rate.values).empty();
  }
  auto filters = read_filters(in, group.series.size());
  if (!filters) return std::unexpected(filters.error());
  t.filters = *filters;
  if (!any && filters->empty()) return {};
  rates.filters = std::move(*filters);
  if (rates.filters.empty())
    rates.filters.resize(group.series.size(), {.cutoff_hz = kNaN, .noise_sd_m = kNaN});
  if (auto status = rates.validate(t); !status) return status;
  out.derivatives = std::move(rates);
  return {};
}

Result<NwbFile> read(Input& in) {
  const bool is_nwb = in.text_attribute(in.file(), "neurodata_type") == "NWBFile";
  if (!is_nwb && holds_poses(in))
    return fail(
        Code::not_supported,
        "holds points in the images of a camera, in pixels, and no positions of markers; give it to ik or "
        "track with --rig and --images CAMERA=FILE");
  if (!is_nwb)
    return fail(Code::bad_input,
                "is HDF5 but not an NWB file: it has no neurodata_type NWBFile. Nothing was read.");
  auto group = find_positions(in);
  if (!group) return std::unexpected(group.error());
  const PositionSeries& first = group->series.front();
  const std::size_t samples = static_cast<std::size_t>(first.time.frames) * group->series.size();
  if (!in.afford(samples, 3 * sizeof(double) + 1)) return too_large(first.path);

  NwbFile out{.metadata = read_metadata(in), .warnings = std::move(group->warnings)};
  out.metadata.reference_frame = first.reference_frame;
  std::vector<std::string> names;
  for (const PositionSeries& s : group->series) names.push_back(s.marker);
  Trajectories& t = out.trial.markers = Trajectories::all_missing(std::move(names), first.time);
  for (std::size_t m = 0; m < group->series.size(); ++m)
    if (auto status = read_marker(in, group->series[m], static_cast<std::int64_t>(m), t); !status)
      return std::unexpected(status.error());
  if (std::ranges::any_of(group->series, [](const auto& s) { return s.width == 2; }))
    out.warnings.emplace_back("positions have two coordinates; the third is set to 0");
  std::set<std::string> movement;
  if (!group->ours())
    for (const PositionSeries& s : group->series) movement.insert(s.path);
  out.trial.beside = find_beside(in, movement);
  if (group->ours()) {
    if (auto status = read_extras(in, *group, out); !status) return std::unexpected(status.error());
  } else if (!first.stamps_s.empty()) {
    if (!in.afford(samples, sizeof(double))) return too_large(first.path);
    t.sample_offset_s.resize(samples);
    for (std::int64_t f = 0; f < t.frames(); ++f)
      for (std::int64_t m = 0; m < t.markers(); ++m)
        t.sample_offset_s[t.index(f, m)] = first.stamps_s[static_cast<std::size_t>(f)] - t.time.time_s(f);
    out.warnings.push_back(fmt::format(
        "timestamps are uneven; frames are taken as even at {:.6g} Hz and samples keep their true times",
        t.time.rate_hz));
  }
  if (auto status = read_first_frame(in, out.trial); !status) return std::unexpected(status.error());
  if (auto status = out.trial.validate(); !status) return std::unexpected(status.error());
  return out;
}

/// Our own files say what is in them.
Status check_content(Input& in, NwbFile& file) {
  const auto written = in.text_attribute(in.file(), kDigestAttribute);
  if (!written) {
    if (file.metadata.software == NwbMetadata{}.software)
      file.warnings.emplace_back(
          "holds no digest of its content, as files of older versions do and damaged ones may: whether it is "
          "as it was "
          "written is not known");
    return {};
  }
  if (content_digest(in) == *written) return {};
  return fail(
      Code::bad_input,
      "its content is not what was written: the digest does not fit; the file is damaged. Nothing was read.");
}

}  // namespace

Result<NwbFile> read_nwb(Input& in) {
  auto out = read(in);
  if (!out) return fail_at(in.name(), out.error());
  if (auto status = check_content(in, *out); !status) return fail_at(in.name(), status.error());
  return out;
}

Result<NwbFile> read_nwb_here(const std::filesystem::path& path) {
  const Quiet quiet;
  auto in = Input::open(path);
  if (!in) return std::unexpected(in.error());
  return read_nwb(*in);
}

}  // namespace kinemark::io::internal
