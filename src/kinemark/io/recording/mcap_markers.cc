// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/mcap_markers.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "kinemark/core/counted.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/recording/internal/foxglove_json.h"
#include "kinemark/io/recording/internal/mcap.h"
#include "kinemark/io/recording/internal/mcap_walk.h"
#include "kinemark/io/recording/markers_recording.h"
#include "kinemark/io/sample_clock.h"

namespace kinemark::io {
namespace {

using internal::TimedPosition;

constexpr std::size_t kHeaderBytes = 512;  // in which a header's profile stands
constexpr std::size_t kNamesInMessage = 5;
constexpr std::size_t kMostPerSample = 64;  // samples of all points and frames, to one that is there
constexpr std::size_t kSamplesAlways = 1'000'000;
constexpr double kOffFrame = 0.1;  // of a frame: what is further from the nearest one is said

/// Positions of one point, by time.
using Path = std::vector<std::pair<std::int64_t, Eigen::Vector3d>>;

std::string words(const RecordingChannel& channel) {
  return fmt::format("{} ({}, {})", printable(channel.topic, 80), printable(channel.message_encoding, 20),
                     channel.schema_name.empty() ? "no schema" : printable(channel.schema_name, 60));
}

/// Everything that the messages tell.
struct Found {
  internal::McapSummary file;
  std::vector<TimedPosition> positions;
  std::set<std::string> unread;  ///< channels, in words
};

Result<Found> find_positions(const ByteSource& source) {
  Found out;
  auto summary = internal::walk_mcap(
      source, [&](const RecordingChannel& channel, const RecordingMessage& message) -> Status {
        if (internal::holds_positions(channel))
          return internal::take_positions(channel, message, out.positions);
        out.unread.insert(words(channel));
        return {};
      });
  if (!summary) return std::unexpected(summary.error());
  out.file = std::move(*summary);
  return out;
}

/// Paths of the points in the axes that most points are in, each by time, the first of two samples at one.
std::map<std::string, Path> paths_of(const Found& found, data::Trial& trial) {
  std::map<std::string, std::set<std::string>> points;  // in each axes
  for (const TimedPosition& p : found.positions) points[p.frame].insert(p.point);
  const auto most = std::ranges::max_element(points, {}, [](const auto& p) { return p.second.size(); });
  const std::string axes = most->first;
  points.erase(most);
  std::map<std::string, Path> paths;
  for (const TimedPosition& p : found.positions)
    if (p.frame == axes) paths[p.point].emplace_back(p.time_ns, p.x);
  std::int64_t repeated = 0;
  for (auto& [name, path] : paths) {
    std::ranges::stable_sort(path, {}, [](const auto& sample) { return sample.first; });
    const auto same = std::ranges::unique(path, {}, [](const auto& sample) { return sample.first; });
    repeated += std::ssize(same);
    path.erase(same.begin(), same.end());
  }
  if (repeated > 0)
    trial.warnings.push_back(fmt::format("{} left out that another of the same point and time comes before",
                                         counted(repeated, "sample")));
  std::vector<std::string> others;
  for (const auto& [frame, names] : points)
    others.push_back(fmt::format("{} in '{}'", counted(std::ssize(names), "point"), printable(frame, 60)));
  if (!others.empty())
    trial.warnings.push_back(fmt::format("points in other axes than '{}' are left out: {}",
                                         printable(axes, 60), join_some(others, kNamesInMessage)));
  return paths;
}

/// Seconds after `zero_ns`.
double seconds(std::int64_t time_ns, std::int64_t zero_ns) {
  return 1e-9 * static_cast<double>(time_ns - zero_ns);
}

Status place(const std::map<std::string, Path>& paths, data::Trial& trial) {
  const auto lead = std::ranges::max_element(paths, {}, [](const auto& p) { return p.second.size(); });
  const std::int64_t zero_ns = lead->second.front().first;
  std::vector<double> times;
  for (const auto& [time_ns, x] : lead->second) times.push_back(seconds(time_ns, zero_ns));
  const auto clock = find_clock(std::move(times), 0.0);
  if (!clock) return fail_at(fmt::format("point '{}'", printable(lead->first, 80)), clock.error());
  const std::int64_t frames = clock->frame.back() + 1;
  std::size_t samples = 0;
  for (const auto& [name, path] : paths) samples += path.size();
  if (static_cast<std::size_t>(frames) > (kMostPerSample * samples + kSamplesAlways) / paths.size())
    return fail(Code::bad_input, fmt::format("{} samples of {} points in {} frames are more points than are "
                                             "believed",
                                             samples, paths.size(), frames));
  if (clock->dropped > 0)
    trial.warnings.push_back(fmt::format("no sample of '{}' in {} (longest gap {:.3g} s); they are missing",
                                         printable(lead->first, 80), counted(clock->dropped, "frame"),
                                         clock->widest_gap_s));
  std::vector<std::string> names;
  for (const auto& [name, path] : paths) names.push_back(name);
  trial.markers = data::Trajectories::all_missing(std::move(names),
                                                  {.rate_hz = clock->rate_hz, .t0_s = 0.0, .frames = frames});
  std::int64_t m = 0, outside = 0, off_frame = 0;
  for (auto p = paths.begin(); p != paths.end(); ++p, ++m)
    for (std::size_t i = 0; i < p->second.size(); ++i) {
      const auto& [time_ns, x] = p->second[i];
      // The lead's own samples are where the clock says, jitter and all.
      const double at = (seconds(time_ns, zero_ns) - clock->start_s) * clock->rate_hz;
      const double nearest = p == lead ? static_cast<double>(clock->frame[i]) : std::round(at);
      if (!(nearest >= 0.0 && nearest < static_cast<double>(frames))) {
        ++outside;
        continue;
      }
      const auto frame = static_cast<std::int64_t>(nearest);
      off_frame += p != lead && std::abs(at - nearest) > kOffFrame;
      if (!x.allFinite() || trial.markers.present(frame, m)) continue;
      trial.markers.x(frame, m) = x;
      trial.markers.state[trial.markers.index(frame, m)] = data::SampleState::measured;
    }
  if (outside > 0)
    trial.warnings.push_back(fmt::format("{} left out that no frame of '{}' is near",
                                         counted(outside, "sample"), printable(lead->first, 80)));
  if (off_frame > 0)
    trial.warnings.push_back(
        fmt::format("{} taken to the nearest frame of '{}', more than {:.0f} % of a frame away",
                    off_frame == 1 ? "a sample is" : counted(off_frame, "sample") + " are",
                    printable(lead->first, 80), 100.0 * kOffFrame));
  return {};
}

Result<data::Trial> assemble(const ByteSource& source) {
  auto found = find_positions(source);
  if (!found) return std::unexpected(found.error());
  if (found->file.profile == internal::kProfile)
    return fail(Code::not_supported,
                "is a recording of kinemark; its markers are read from a file alone, and of counts kinemark "
                "reconstruct makes them");
  const std::vector<std::string> unread(found->unread.begin(), found->unread.end());
  if (found->positions.empty())
    return fail(Code::not_supported,
                fmt::format("holds no messages of positions that are read (JSON of {}); its channels: {}",
                            internal::names_of_position_schemas(),
                            unread.empty() ? "none with messages" : join_some(unread, kNamesInMessage)));
  data::Trial trial{.format = "MCAP",
                    .units_in_file = "m",
                    .software = name_of_bytes(found->file.library),
                    .warnings = std::move(found->file.warnings)};
  const auto paths = paths_of(*found, trial);
  found->positions.clear();
  if (auto s = place(paths, trial); !s) return std::unexpected(s.error());
  if (!unread.empty())
    trial.warnings.push_back(
        fmt::format("{} left out: {}",
                    unread.size() == 1 ? "a channel is" : counted(std::ssize(unread), "channel") + " are",
                    join_some(unread, kNamesInMessage)));
  return trial;
}

}  // namespace

bool is_mcap(std::string_view begin) { return begin.starts_with(internal::kMagic); }

bool is_mcap_of_others(std::string_view begin) {
  if (!is_mcap(begin)) return false;
  internal::Cursor cursor(std::as_bytes(std::span(begin.substr(internal::kMagic.size()))));
  const bool header = cursor.u8() == internal::kHeader;
  cursor.u64();
  const std::string profile = cursor.string();
  return header && cursor.good() && profile != internal::kProfile;
}

Result<data::Trial> read_mcap_markers(const ByteSource& source) {
  auto trial = assemble(source);
  if (!trial) return fail_at(source.name(), trial.error());
  trial->source = source.name();
  return trial;
}

Result<data::Trial> read_mcap_markers(const std::filesystem::path& path) {
  auto file = InputFile::open(path);
  if (!file) return std::unexpected(file.error());
  auto source = std::make_unique<FileSource>(std::move(*file));
  std::array<std::byte, kHeaderBytes> begin{};
  const auto there = source->read_at(0, begin);
  if (!there) return std::unexpected(there.error());
  const std::string_view text(reinterpret_cast<const char*>(begin.data()), *there);
  if (!is_mcap(text) || is_mcap_of_others(text)) return read_mcap_markers(*source);
  auto reader = RecordingReader::open(std::move(source), {.skip_damage = true});
  if (!reader) return std::unexpected(reader.error());
  return read_markers_recording(std::move(*reader));
}

}  // namespace kinemark::io
