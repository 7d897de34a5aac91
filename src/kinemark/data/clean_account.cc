// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/clean_account.h"

#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/core/index.h"

namespace kinemark::data {

std::string CleanAccount::name_of(std::int64_t marker) const {
  return marker < 0 ? std::string() : names.at(at(marker));
}

Status CleanAccount::validate() const {
  const auto bad = [](std::string text) {
    return fail(Code::bad_input, "account of cleaning: " + std::move(text));
  };
  const auto markers_there = std::ssize(names);
  const auto none_or_all = [&](std::size_t size) { return size == 0 || size == names.size(); };
  if (!none_or_all(upsampling.markers.size()) || !none_or_all(upsampling.marker_bands.size()))
    return bad(
        fmt::format("upsampling tells of {} markers; there are {}", upsampling.markers.size(), names.size()));
  if (markers.size() > names.size())
    return bad(fmt::format("{} markers were smoothed; there are {}", markers.size(), names.size()));
  const auto there = [&](const std::string& name) {
    return name.empty() || std::ranges::find(names, name) != names.end();
  };
  for (const auto& [f, done, handled] : defects) {
    if (auto status = f.validate(); !status) return bad(status.error().message);
    if (f.first_frame < 0) return bad(fmt::format("a defect of '{}' has no frames", f.subject));
    if (!there(f.subject) || !there(f.partner))
      return bad(fmt::format("a defect of '{}' and '{}' is of no marker here", f.subject, f.partner));
  }
  for (const GapAccount& g : gaps)
    if (g.marker < 0 || g.marker >= markers_there || g.first_frame < 0 || g.last_frame < g.first_frame)
      return bad(fmt::format("a gap of marker {} in frames {} to {} does not fit {} markers", g.marker,
                             g.first_frame, g.last_frame, names.size()));
  return {};
}

}  // namespace kinemark::data
