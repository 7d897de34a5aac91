// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/channels.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace kinemark::data {

std::string_view to_string(ChannelKind kind) {
  constexpr std::array<std::string_view, 7> kNames = {"angle",  "force",          "moment", "power",
                                                      "scalar", "modeled marker", "other"};
  return kNames[static_cast<std::size_t>(kind)];
}

Status Channels::validate() const {
  if (kinds.size() != names.size() || units.size() != names.size())
    return fail(Code::bad_input, fmt::format("{} channels have {} kinds and {} units; need one of each",
                                             names.size(), kinds.size(), units.size()));
  const auto need = static_cast<std::size_t>(frames) * names.size() * 3;
  if (values.size() != need)
    return fail(Code::bad_input, fmt::format("{} channels of {} frames hold {} values; need {}", names.size(),
                                             frames, values.size(), need));
  return {};
}

bool is_unlabelled(std::string_view name) {
  constexpr std::string_view kUname = "uname";
  const auto digits = [](std::string_view text) {
    return std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c) != 0; });
  };
  name.remove_prefix(name.find(':') == std::string_view::npos ? 0 : name.find(':') + 1);
  if (name.empty()) return true;
  if (name.front() == '*') return digits(name.substr(1));
  if (name.starts_with("point ")) return digits(name.substr(6));
  const bool uname = name.size() >= kUname.size() &&
                     std::ranges::equal(name.substr(0, kUname.size()), kUname,
                                        [](unsigned char a, char b) { return std::tolower(a) == b; });
  if (!uname) return false;
  name.remove_prefix(kUname.size());
  if (name.starts_with('*')) name.remove_prefix(1);
  return digits(name);
}

}  // namespace kinemark::data
