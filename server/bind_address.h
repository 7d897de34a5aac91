// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// The address that is listened on, and how a browser may call it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::server {

/// Code::usage, in one sentence, unless the text is an address of this machine alone (127.0.0.0/8, ::1).
/// Others would need TLS, which is not built in.
[[nodiscard]] Status check_bind_address(std::string_view address);

/// The values of `Host` that mean this server: the address, in brackets where it is IPv6, and "localhost"
/// where that is it, each with the port (port 80 also without). The first one is for the URL.
/// @param address  one that check_bind_address() let pass
[[nodiscard]] std::vector<std::string> own_hosts(std::string_view address, std::uint16_t port);

}  // namespace kinemark::server
