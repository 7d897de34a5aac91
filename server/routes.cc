// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/routes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <system_error>
#include <utility>

namespace kinemark::server {
namespace {

constexpr std::array<std::pair<std::string_view, Target>, 5> kTargets = {{{"/", Target::list_page},
                                                                          {"/api/trials", Target::list_json},
                                                                          {"/style.css", Target::style},
                                                                          {"/list.css", Target::list_style},
                                                                          {"/list.js", Target::list_script}}};
constexpr std::string_view kTrial = "/trial/";

}  // namespace

Route find_route(std::string_view target) {
  if (target.starts_with(kTrial)) {
    const auto digits = target.substr(kTrial.size());
    const char* const first = digits.data();
    const char* const last = first + digits.size();
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(first, last, number);
    const bool whole = !digits.empty() && digits.front() != '0' && error == std::errc() && end == last;
    return whole ? Route{Target::trial_page, number} : Route{};
  }
  const auto* const found = std::ranges::find(kTargets, target, &std::pair<std::string_view, Target>::first);
  return found == kTargets.end() ? Route{} : Route{found->second};
}

}  // namespace kinemark::server
