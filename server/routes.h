// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string_view>

namespace kinemark::server {

/// What can be asked for.
enum class Target : std::uint8_t {
  none,             ///< nothing that there is
  list_page,        ///< /
  list_json,        ///< /api/trials
  trial_page,       ///< /trial/N
  trial_edits,      ///< /api/trial/N/edits
  trial_data,       ///< /api/trial/N/data
  trial_angles,     ///< /api/trial/N/angles
  angles_now,       ///< /trial/N/angles/now
  angles_before,    ///< /trial/N/angles/before
  angles_recorded,  ///< /trial/N/angles/recorded
  style,            ///< /style.css
  list_style,       ///< /list.css
  list_script,      ///< /list.js
};

/// A target, and for a trial its number.
struct Route {
  Target target = Target::none;  ///< what is asked for
  std::uint32_t number = 0;      ///< of the trial, from 1; 0 without
};

/// The route of a request's target, to the letter: nothing is decoded, no path is put together, no query is
/// taken (the token's is seen before). Numbers have no sign and no zero in front.
[[nodiscard]] Route find_route(std::string_view target);

}  // namespace kinemark::server
