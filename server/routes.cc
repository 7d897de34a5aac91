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

/// Targets of a trial: what stands before its number and behind it.
struct OfTrial {
  std::string_view before, behind;
  Target target;
};
constexpr std::array<OfTrial, 7> kOfTrial = {{{"/trial/", "", Target::trial_page},
                                              {"/trial/", "/angles/now", Target::angles_now},
                                              {"/trial/", "/angles/before", Target::angles_before},
                                              {"/trial/", "/angles/recorded", Target::angles_recorded},
                                              {"/api/trial/", "/angles", Target::trial_angles},
                                              {"/api/trial/", "/edits", Target::trial_edits},
                                              {"/api/trial/", "/data", Target::trial_data}}};

/// A number without a sign and without a zero in front; 0 for anything else.
std::uint32_t number_of(std::string_view digits) {
  if (digits.empty() || digits.front() == '0') return 0;
  const char *const first = &digits.front(), *const last = first + digits.size();
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(first, last, number);
  return error == std::errc() && end == last ? number : 0;
}

}  // namespace

Route find_route(std::string_view target) {
  for (const auto& [before, behind, of_trial] : kOfTrial) {
    if (target.size() < before.size() + behind.size() || !target.starts_with(before) ||
        !target.ends_with(behind))
      continue;
    const auto digits = target.substr(before.size(), target.size() - before.size() - behind.size());
    if (const auto number = number_of(digits); number > 0) return {of_trial, number};
  }
  const auto* const found = std::ranges::find(kTargets, target, &std::pair<std::string_view, Target>::first);
  return found == kTargets.end() ? Route{} : Route{found->second};
}

}  // namespace kinemark::server
