// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/text.h"

#include "kinemark/stages/report/internal/findings.h"

namespace kinemark::report::internal {

namespace {

using data::FrameStatus;

std::string describe_frames(std::int64_t count, std::int64_t all) {
  const double percent =
      100.0 * static_cast<double>(count) / static_cast<double>(std::max<std::int64_t>(1, all));
  // Two digits, and no exponent: "2.5 %", "12 %", "100 %".
  return fmt::format("{} of {} frames ({:.{}g} %)", count, all, percent, percent < 99.5 ? 2 : 3);
}

double first_time_s(const data::JointMotion& motion, FrameStatus status) {
  const auto at = std::ranges::find(motion.status, status);
  return at == motion.status.end() ? kNaN : motion.time.time_s(at - motion.status.begin());
}

double first_undetermined_s(const data::JointMotion& motion, std::int64_t coordinate) {
  for (std::int64_t f = 0; f < motion.frames() && !motion.determined.empty(); ++f)
    if (motion.determined[motion.index(f, coordinate)] == 0) return motion.time.time_s(f);
  return kNaN;
}

/// Where the pose of frames without markers comes from, as it is in the motion: the frame before them, the
/// one behind.
std::string held_from(const data::JointMotion& motion) {
  const std::int64_t F = motion.frames(), n = motion.size();
  const auto same = [&](std::int64_t f, std::int64_t g) {
    return f >= 0 && g < F &&
           std::equal(motion.q.begin() + f * n, motion.q.begin() + (f + 1) * n, motion.q.begin() + g * n);
  };
  bool before = false, behind = false;
  for (std::int64_t f = 0; f < F;) {
    if (motion.status[static_cast<std::size_t>(f)] != FrameStatus::no_markers) {
      ++f;
      continue;
    }
    std::int64_t end = f + 1;
    while (end < F && motion.status[static_cast<std::size_t>(end)] == FrameStatus::no_markers) ++end;
    if (f > 0 && same(f - 1, f))
      before = true;
    else if (end < F && same(end - 1, end))
      behind = true;
    f = end;
  }
  if (before && behind) return ": the pose is held from the frame before, or behind where none is before.";
  if (before) return ": the pose is held from the frame before.";
  return behind ? ": the pose is that of the first frame behind that has one." : ".";
}

/// Why a coordinate is not determined in so many frames, where that is known.
/// @param seen  what could have fixed it: "visible marker"
std::string why_not_determined(const data::JointMotion& motion, std::size_t c, std::int64_t frames,
                               bool always, std::string_view seen) {
  if (motion.open_frames.empty()) return ".";
  const std::int64_t open = motion.open_frames[c];
  const char* limit = motion.is_rotation[c] ? "0.5 rad" : "0.5 m";
  if (open >= frames)
    return always ? fmt::format(": no {} fixes it.", seen)
                  : fmt::format(": the {}s do not fix it there.", seen);
  const auto loosely = fmt::format("the {}s fix it no better than to {}, or two poses fit them", seen, limit);
  if (open == 0) return fmt::format(": {}{}.", loosely, always ? "" : " there");
  return fmt::format(": in {} of them no {} fixes it, in the others {}.", open, seen, loosely);
}

/// One line for each reason, with all markers that have it, in the order in which they come.
void add_left_out(const IkSummary& s, std::vector<Notice>& out) {
  std::vector<std::pair<std::string, std::vector<std::string>>> reasons;
  for (const MarkerRow& m : s.markers) {
    if (m.why_excluded.empty()) continue;
    auto at = std::ranges::find(reasons, m.why_excluded, [](const auto& reason) { return reason.first; });
    if (at == reasons.end()) at = reasons.insert(at, {m.why_excluded, {}});
    at->second.push_back(m.name);
  }
  for (const auto& [why, names] : reasons) {
    if (names.size() == 1)
      out.push_back({Verdict::good, "marker", names.front(),
                     fmt::format("Marker {} was left out: {}", names.front(), why), kNaN});
    else
      out.push_back({Verdict::good, "marker", "",
                     fmt::format("{} markers were left out: {}: {}", names.size(), why, join(names)), kNaN});
  }
}

}  // namespace

std::vector<Notice> find_notices(const IkSummary& s, const data::JointMotion& motion) {
  std::vector<Notice> out;
  for (const Gate& gate : s.run.gates)
    if (!gate.passed) out.push_back({Verdict::attention, "gate", gate.name, gate.sentence, kNaN});
  if (s.run.exit_status != 0 && out.empty())
    out.push_back({Verdict::attention, "gate", "",
                   fmt::format("The run ended with exit status {}.", s.run.exit_status), kNaN});

  const std::string_view seen = s.run.by_sensors ? "sensor" : "visible marker";
  const auto frames_with = [&](FrameStatus status) {
    return s.status_frames[static_cast<std::size_t>(status)];
  };
  if (const auto n = frames_with(FrameStatus::not_converged); n > 0)
    out.push_back({Verdict::attention, "frames", "",
                   fmt::format("{} did not converge: the best pose found is given.",
                               describe_frames(n, motion.frames())),
                   first_time_s(motion, FrameStatus::not_converged)});
  if (const auto n = frames_with(FrameStatus::no_markers); n > 0)
    out.push_back({Verdict::attention, "frames", "",
                   fmt::format("{} had no {}{}", describe_frames(n, motion.frames()),
                               s.run.by_sensors ? "sensor" : "marker", held_from(motion)),
                   first_time_s(motion, FrameStatus::no_markers)});

  for (std::size_t j = 0; j < s.coordinates.size(); ++j) {
    const CoordinateSummary& c = s.coordinates[j];
    if (c.locked || c.determined_frames == motion.frames()) continue;
    const double from_s = first_undetermined_s(motion, static_cast<std::int64_t>(j));
    if (c.determined_frames == 0)
      out.push_back({Verdict::attention, "coordinate", c.name,
                     fmt::format("{} is never determined{}", c.name,
                                 why_not_determined(motion, j, motion.frames(), true, seen)),
                     from_s});
    else
      out.push_back(
          {Verdict::good, "coordinate", c.name,
           fmt::format("{} is not determined in {}{}", c.name,
                       describe_frames(motion.frames() - c.determined_frames, motion.frames()),
                       why_not_determined(motion, j, motion.frames() - c.determined_frames, false, seen)),
           from_s});
  }
  for (const CoordinateSummary& c : s.coordinates)
    if (c.at_limit_frames > 0)
      out.push_back({Verdict::good, "coordinate", c.name,
                     fmt::format("{} lies at a limit of its range in {}.", c.name,
                                 describe_frames(c.at_limit_frames, motion.frames())),
                     motion.time.time_s(c.first_at_limit)});
  add_left_out(s, out);
  for (const MarkerRow& m : s.markers) {
    if (m.why_excluded.empty() && m.used && m.seen_frames == 0 && !motion.marker_error.empty())
      out.push_back({Verdict::good, "marker", m.name, fmt::format("Marker {} is never seen.", m.name), kNaN});
  }
  for (const std::string& warning : s.run.warnings)
    out.push_back({Verdict::good, "warning", "", warning, kNaN});

  // Stable order, serious findings first.
  std::vector<Notice> sorted;
  for (const Verdict level : {Verdict::attention, Verdict::good})
    std::ranges::copy_if(out, std::back_inserter(sorted), [&](const Notice& f) { return f.level == level; });
  return sorted;
}

}  // namespace kinemark::report::internal
