// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace kinemark::server {

/// Whether a person sits at this session: DISPLAY or WAYLAND_DISPLAY is set.
[[nodiscard]] bool has_desktop();

/// Have xdg-open open an address, and do not wait for it. False without xdg-open. Other users of the machine
/// can see the address among the running programs: its token must be good for one use.
[[nodiscard]] bool open_browser(const std::string& address);

}  // namespace kinemark::server
