// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/keypoints_hdf5.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "kinemark/core/utf8.h"
#include "kinemark/io/keypoints/internal/point_frames.h"

namespace kinemark::io {
namespace {

/// Who has a point anywhere, by places in the table.
std::vector<std::size_t> seen_people(const PoseTable& table) {
  std::vector<std::size_t> out;
  const std::size_t points = table.points.size(), people = table.people.size();
  const auto frames = static_cast<std::size_t>(table.frames);
  for (std::size_t p = 0; p < people; ++p) {
    const auto seen = [&](std::size_t f) {
      const double* value = table.values.data() + 3 * points * (f * people + p);
      for (std::size_t m = 0; m < points; ++m, value += 3)
        if (std::isfinite(value[0]) && std::isfinite(value[1])) return true;
      return false;
    };
    bool anywhere = false;
    for (std::size_t f = 0; f < frames && !anywhere; ++f) anywhere = seen(f);
    if (anywhere) out.push_back(p);
  }
  return out;
}

Result<std::size_t> chosen_person(const PoseTable& table, const KeypointsOptions& options) {
  if (options.person) {
    if (*options.person >= 1 && std::cmp_less_equal(*options.person, table.people.size()))
      return static_cast<std::size_t>(*options.person - 1);
    return fail(Code::bad_input,
                fmt::format("has no person {}; it has {}", *options.person, table.people.size()));
  }
  const auto seen = seen_people(table);
  if (seen.size() == 1) return seen.front();
  if (seen.empty())
    return fail(Code::bad_input, fmt::format("{} frames, but none shows anybody", table.frames));
  constexpr std::size_t kMostNames = 8;
  std::string names;
  for (std::size_t i = 0; i < std::min(seen.size(), kMostNames); ++i)
    names +=
        fmt::format("{}{} ('{}')", i == 0 ? "" : ", ", seen[i] + 1, printable(table.people[seen[i]], 40));
  if (seen.size() > kMostNames) names += ", ...";
  return fail(Code::not_supported,
              fmt::format("shows {} people; choose one with --person: {}", seen.size(), names));
}

}  // namespace

Result<Keypoints> points_of_person(const PoseTable& table, const KeypointsOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (auto s = table.validate(); !s) return std::unexpected(s.error());
  const auto chosen = chosen_person(table, options);
  if (!chosen) return std::unexpected(chosen.error());
  internal::PointFrames frames({.min_likelihood = options.min_likelihood});
  internal::Person person;
  const std::size_t width = 3 * table.points.size();
  for (std::int64_t f = 0; f < table.frames; ++f) {
    const auto row = static_cast<std::size_t>(f) * table.people.size() + *chosen;
    person.values.assign(table.values.data() + row * width, table.values.data() + (row + 1) * width);
    if (auto s = frames.add(f, {&person, 1}, width); !s)
      return fail_at(fmt::format("frame {}", f), s.error());
  }
  return frames.finish(table.points);
}

Result<Keypoints> read_keypoints_hdf5(const std::filesystem::path& path, const KeypointsOptions& options) {
  const auto table = read_pose_table(path);
  if (!table) return std::unexpected(table.error());
  auto points = points_of_person(*table, options);
  if (!points) return fail_at(path.string(), points.error());
  return points;
}

}  // namespace kinemark::io
