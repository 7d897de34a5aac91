// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/foreign_groups.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "kinemark/io/c3d/provenance.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kMaxGroups = 120;
constexpr std::size_t kMaxBytes = 32'000;

// Read into the trial and written from it. ROTATION tells where samples are that are not carried.
constexpr std::array<std::string_view, 8> kOurs = {"POINT",  "ANALOG", "FORCE_PLATFORM", "EVENT",
                                                   "EVENTS", "TRIAL",  "MANUFACTURER",   "ROTATION"};

bool is_foreign(const C3dGroup& group) {
  return !group.stored.name.empty() && group.name != kProvenanceGroup &&
         std::ranges::find(kOurs, group.name) == kOurs.end();
}

/// Bytes of a group or parameter at most, with lengths, pointer, type and sizes.
std::size_t bytes_of(const data::ForeignParameter& p) {
  return 8 + p.name.size() + p.dims.size() + p.values.size() + p.description.size();
}

}  // namespace

std::vector<data::ForeignGroup> find_foreign_groups(const C3dParameters& parameters,
                                                    std::vector<std::string>& warnings) {
  std::vector<data::ForeignGroup> found;
  std::size_t total = 0;
  std::size_t left_out = 0;
  for (const C3dGroup& group : parameters.groups) {
    if (!is_foreign(group)) continue;
    data::ForeignGroup foreign = group.stored;
    std::size_t bytes = 8 + foreign.name.size() + foreign.description.size();
    for (const C3dParameter& p : group.parameters) {
      if (p.stored.name.empty()) continue;  // it is cut short, which has been said
      bytes += bytes_of(p.stored);
      foreign.parameters.push_back(p.stored);
    }
    if (found.size() == kMaxGroups || total + bytes > kMaxBytes) {
      ++left_out;
      continue;
    }
    total += bytes;
    found.push_back(std::move(foreign));
  }
  if (left_out > 0)
    warnings.push_back(fmt::format(
        "{} groups of parameters that kinemark does not read are too large to be carried into a copy",
        left_out));
  return found;
}

}  // namespace kinemark::io
