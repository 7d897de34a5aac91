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

/// Code::usage, in one sentence, unless the text is an address of this machine alone (127.0.0.0/8, ::1), or
/// any other one where there is TLS.
[[nodiscard]] Status check_bind_address(std::string_view address, bool has_tls = false);

/// The values of `Host` that mean this server: the address, in brackets where it is IPv6, and "localhost"
/// where that is it, each with the port (port 80, or 443 with TLS, also without). With TLS the names of the
/// certificate come first, and an address that stands for all of the machine (0.0.0.0, ::) is no name. The
/// first one is for the URL; none: nobody could call this server.
/// @param address      one that check_bind_address() let pass
/// @param certificate  Tls::names(); nullptr: no TLS
[[nodiscard]] std::vector<std::string> own_hosts(std::string_view address, std::uint16_t port,
                                                 const std::vector<std::string>* certificate = nullptr);

}  // namespace kinemark::server
