// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The page on which trials are recorded from a device: what is known before anything is asked.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace kinemark::report {

/// Where trials go, and from what.
struct DeskReport {
  std::string source;   ///< as given
  std::string version;  ///< of the program
  std::string folder;   ///< of the trials
};

/// DeskPage of docs/formats/pages.md.
[[nodiscard]] nlohmann::ordered_json desk_report_json(const DeskReport& report);

/// One HTML page, which asks its own server how the device is. The same report gives the same bytes.
[[nodiscard]] std::string desk_report_html(const DeskReport& report);

}  // namespace kinemark::report
