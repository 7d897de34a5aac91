// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/series.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "kinemark/core/length_unit.h"
#include "kinemark/io/nwb/internal/content_list.h"
#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/nwb/metadata.h"
#include "kinemark/io/rate.h"

namespace kinemark::io::internal {
namespace {

constexpr int kMaxDepth = 12;
constexpr int kMaxGroups = 20'000;
constexpr double kEvenFrames = 1e-3;  ///< timestamps are even when none is further off, in frames

/// The clock of a series, or why it has none.
Status read_clock(Input& in, hid_t series, std::int64_t frames, PositionSeries& out) {
  out.time.frames = frames;
  if (const Handle start = in.object(series, "starting_time")) {
    const auto shape = in.number_shape(start.id());
    const auto t0 = shape && shape->empty() ? in.numbers<double>(start.id()) : std::nullopt;
    const auto rate = in.number_attribute(start.id(), "rate");
    if (!t0 || !rate) return fail(Code::bad_input, "has a starting_time without a number or a rate");
    out.time.t0_s = t0->front();
    out.time.rate_hz = *rate;
  } else {
    const Handle stamps = in.object(series, "timestamps");
    const auto shape = in.number_shape(stamps.id());
    if (!shape || shape->size() != 1 || shape->front() != frames)
      return fail(Code::bad_input,
                  fmt::format("has neither a starting_time nor {} timestamps, one for each sample", frames));
    auto times = in.numbers<double>(stamps.id());
    if (!times) return fail(Code::bad_input, "has timestamps that cannot be read");
    for (std::size_t i = 0; i < times->size(); ++i)
      if (!std::isfinite((*times)[i]) || (i > 0 && (*times)[i] <= (*times)[i - 1]))
        return fail(Code::bad_input,
                    fmt::format("has a timestamp {} after sample {}; they must increase", (*times)[i], i));
    out.time.t0_s = times->front();
    // A single sample has no rate; any value will do.
    out.time.rate_hz = frames > 1 ? static_cast<double>(frames - 1) / (times->back() - times->front()) : 1.0;
    for (std::int64_t f = 0; f < frames; ++f)
      if (std::abs((*times)[static_cast<std::size_t>(f)] - out.time.time_s(f)) * out.time.rate_hz >
          kEvenFrames) {
        out.stamps_s = std::move(*times);
        break;
      }
  }
  if (!is_rate(out.time.rate_hz) || !std::isfinite(out.time.t0_s))
    return fail(Code::bad_input, fmt::format("runs at {} Hz from {} s; need a rate of {} to {:.0f} Hz",
                                             out.time.rate_hz, out.time.t0_s, kSlowest_hz, kFastest_hz));
  return {};
}

/// Everything of a series but its samples, or why it is no marker. Its clock is read where `with_clock`.
Result<PositionSeries> describe(Input& in, const std::string& path, std::string marker, bool pose,
                                bool with_clock) {
  PositionSeries out{.marker = std::move(marker), .path = path};
  const Handle group = in.object(in.file(), path);
  const Handle data = in.object(group.id(), "data");
  const auto shape = in.number_shape(data.id());
  if (!shape || shape->size() != 2 || ((*shape)[1] != 2 && (*shape)[1] != 3))
    return fail(Code::bad_input, fmt::format("{}: data are not numbers of shape frames x 3 (or 2)", path));
  if (shape->front() == 0) return fail(Code::bad_input, fmt::format("{}: holds no samples", path));
  out.width = static_cast<int>((*shape)[1]);
  const std::string unit = in.text_attribute(data.id(), "unit").value_or(pose ? "pixels" : "meters");
  const auto metres = metres_per_unit(unit);
  if (!metres)
    return fail(
        Code::not_supported,
        fmt::format("{}: is in '{}', which is not a unit of length; need meters or the like", path, unit));
  out.metres_per_number = *metres * in.number_attribute(data.id(), "conversion").value_or(1.0);
  out.metres_offset = *metres * in.number_attribute(data.id(), "offset").value_or(0.0);
  if (const Handle frame = in.object(group.id(), "reference_frame"))
    if (const auto text = in.texts(frame.id()); text && text->size() == 1)
      out.reference_frame = text->front();
  out.time.frames = shape->front();
  if (!with_clock) return out;
  if (auto status = read_clock(in, group.id(), shape->front(), out); !status)
    return fail_at(path, status.error());
  return out;
}

struct Found {
  std::string path;
  std::string name;
  bool pose;
};

/// What a walk over the groups of a file came by.
struct Walked {
  std::map<std::string, std::vector<Found>> found;  ///< of a positional type, by the group that holds them
  int groups_left = kMaxGroups;
};

/// A series of anything, as TimeSeries and ElectricalSeries; the containers of behaviour are none.
bool is_series(const std::string& type) { return type.ends_with("Series") && type != "BehavioralTimeSeries"; }

/// A DynamicTable, or what is derived from it (Units, TimeIntervals): it holds columns, which may be of types
/// that only a newer HDF5 knows.
bool is_table(hid_t group) { return H5Aexists(group, "colnames") > 0; }

/// Every group of a positional type under `path`. Fails where something is there that cannot be opened:
/// leaving it out would lose markers silently.
Status walk(Input& in, const std::string& path, int depth, Walked& walked) {
  const auto damaged = [](const std::string& what) {
    return fail(Code::bad_input, what + ": cannot be opened; the file is broken. Nothing was read.");
  };
  const Handle group = in.object(in.file(), path.empty() ? "/" : path);
  const auto names = in.children(group.id());
  if (!names) return damaged(path.empty() ? "/" : path);
  for (const std::string& name : *names) {
    if (path.empty() && name == "specifications") continue;
    const std::string child_path = path + "/" + name;
    if (in.broken(group.id(), name)) return damaged(child_path);
    const Handle child = in.object(group.id(), name);
    if (H5Iget_type(child.id()) != H5I_GROUP) continue;
    if (--walked.groups_left < 0) return {};
    const std::string type = in.text_attribute(child.id(), "neurodata_type").value_or("");
    if (type == "SpatialSeries" || type == "PoseEstimationSeries") {
      walked.found[path].push_back({child_path, name, type == "PoseEstimationSeries"});
    } else if (!is_series(type) && depth < kMaxDepth && !is_table(child.id())) {
      if (auto status = walk(in, child_path, depth + 1, walked); !status) return status;
    }
  }
  return {};
}

bool same_clock(const PositionSeries& a, const PositionSeries& b) {
  return a.time == b.time && a.stamps_s == b.stamps_s;
}

/// Keep the series of the clock that most of them share.
void keep_one_clock(std::vector<PositionSeries>& all, std::vector<std::string>& warnings) {
  std::size_t best = 0;
  std::ptrdiff_t most = 0;
  std::vector<std::size_t> different;  // one of each clock
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (std::ranges::any_of(different, [&](std::size_t d) { return same_clock(all[d], all[i]); })) continue;
    different.push_back(i);
    const auto n = std::ranges::count_if(all, [&](const auto& s) { return same_clock(s, all[i]); });
    if (n > most) {
      most = n;
      best = i;
    }
    if (different.size() > 16) break;  // hardly a recording of markers
  }
  const PositionSeries clock = all[best];
  const std::size_t before = all.size();
  std::erase_if(all, [&](const auto& s) { return !same_clock(s, clock); });
  if (all.size() < before)
    warnings.push_back(fmt::format("{} series do not share the clock of {} and are left out",
                                   before - all.size(), all.front().path));
}

Result<PositionGroup> find_foreign(Input& in) {
  Walked walked;
  if (auto status = walk(in, "", 0, walked); !status) return std::unexpected(status.error());
  PositionGroup best;
  std::optional<Error> why_not;
  std::size_t others = 0;
  for (const auto& [parent, members] : walked.found) {
    PositionGroup group;
    for (const Found& f : members) {
      auto series = describe(in, f.path, f.name, f.pose, true);
      if (series)
        group.series.push_back(std::move(*series));
      else if (group.warnings.push_back(series.error().message + "; it is left out"); !why_not)
        why_not = series.error();
    }
    if (group.series.empty()) continue;
    keep_one_clock(group.series, group.warnings);
    // Processed data before raw ones of the same size: p comes late in the alphabet.
    const bool better = group.series.size() > best.series.size() ||
                        (group.series.size() == best.series.size() && parent.starts_with("/processing") &&
                         !best.series.front().path.starts_with("/processing"));
    if (better) std::swap(best, group);
    others += group.series.size();
  }
  if (best.series.empty()) {
    if (why_not) return std::unexpected(*why_not);
    return fail(Code::bad_input, "holds no positions (SpatialSeries or PoseEstimationSeries)");
  }
  if (others > 0) best.warnings.push_back(fmt::format("{} other series of positions are left out", others));
  return best;
}

/// The column of a table of ours, or nothing.
std::optional<std::vector<std::string>> text_column(Input& in, hid_t table, const char* name) {
  const Handle column = in.object(table, name);
  return in.texts(column.id());
}
std::optional<Array<double>> number_column(Input& in, hid_t table, const char* name) {
  const Handle column = in.object(table, name);
  return in.numbers<double>(column.id());
}

Result<PositionGroup> find_ours(Input& in, hid_t table, std::vector<std::string> markers,
                                std::vector<std::string> names) {
  const auto t0_s = number_column(in, table, "t0_s");
  const auto rate_hz = number_column(in, table, "rate_hz");
  if (!t0_s || !rate_hz || markers.empty() || names.size() != markers.size() ||
      t0_s->size() != markers.size() || rate_hz->size() != markers.size())
    return fail(Code::bad_input, "its table of markers has columns of different lengths");
  PositionGroup out;
  for (std::size_t m = 0; m < markers.size(); ++m) {
    auto series =
        describe(in, fmt::format("{}/{}/{}", module_of(in), kPosition, names[m]), markers[m], false, false);
    if (!series) return std::unexpected(series.error());
    const std::int64_t frames = m == 0 ? series->time.frames : out.series.front().time.frames;
    if (series->time.frames != frames)
      return fail(Code::bad_input, fmt::format("marker '{}' has {} samples, the first one {}", markers[m],
                                               series->time.frames, frames));
    series->time = {.rate_hz = rate_hz->front(), .t0_s = t0_s->front(), .frames = frames};
    out.series.push_back(std::move(*series));
  }
  if (auto offset_s = number_column(in, table, "offset_s")) out.offset_s = std::move(*offset_s);
  out.series_names = std::move(names);
  return out;
}

}  // namespace

Result<PositionGroup> find_positions(Input& in) {
  const Handle table = in.object(in.file(), fmt::format("{}/{}", module_of(in), kMarkersTable));
  auto markers = text_column(in, table.id(), "marker");
  auto names = text_column(in, table.id(), "series");
  if (markers && names) return find_ours(in, table.id(), std::move(*markers), std::move(*names));
  // Files of kinemark whose table was lost to damage must not be read as foreign ones. HDF5 1.10 can lose
  // links without an error, so the writer's name is also read from another place.
  const Handle generated = in.object(in.file(), "/general/was_generated_by");
  const auto software = in.texts(generated.id());
  const auto content = listed_content(in);
  const bool no_markers_said = content && !covers(*content, module_of(in) + "/" + kMarkersTable);
  const bool says_ours =
      !no_markers_said && software && !software->empty() && software->front() == NwbMetadata{}.software;
  // H5Lexists() is negative where the links themselves are damaged.
  if (says_ours || (table && H5Lexists(table.id(), "series", H5P_DEFAULT) != 0))
    return fail(Code::bad_input,
                "its table of markers is missing or cannot be read; the file is damaged. Nothing was read.");
  return find_foreign(in);
}

}  // namespace kinemark::io::internal
