// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// `kinemark serve` of a device on the desk: trials are recorded from the browser.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "cli/command.h"
#include "server/desk_service.h"
#include "server/http_server.h"

namespace kinemark::cli {

/// Whether an argument is the address of a device that gives counts: "sim:rig", "serial:...", "comedi:...";
/// with settings behind a '?' or without.
[[nodiscard]] bool names_desk(std::string_view argument);

/// A desk before anybody asks for it.
struct DeskParts {
  std::string page, nonce;
  server::ServedDesk served;
};

/// A desk with that device open. @param folder  of the trials; empty: the current one
/// @param rig  that the cameras are aligned with; empty: there is no guide
/// Code::usage where the folder is a file; else as io::read_rig() and pipeline::open_device().
[[nodiscard]] Result<std::unique_ptr<DeskParts>> open_desk(const CommonOptions& common,
                                                           const std::string& uri,
                                                           const std::filesystem::path& folder,
                                                           const std::filesystem::path& rig);

/// Until a signal comes: a trial that is recorded then is ended and kept. The exit status.
int serve_desk(const CommonOptions& common, server::HttpServer& http, server::Keys keys, DeskParts& parts);

}  // namespace kinemark::cli
