// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The two texts of a session: docs/formats/session.md.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/session/session.h"

namespace kinemark::pipeline {

/// What session.toml holds.
struct SessionFile {
  std::string subject;
  bool has_rig = false;
  std::vector<SessionTrial> trials;
};

[[nodiscard]] std::string session_text(const SessionFile& session);
/// Code::bad_input, naming file and place. Trials lie in raw/. @param name  of the file, for messages
[[nodiscard]] Result<SessionFile> parse_session(std::string_view text, const std::string& name);

/// Lines as `xxhsum -c` reads them.
[[nodiscard]] std::string manifest_text(const std::vector<ManifestEntry>& entries);
/// As parse_session().
[[nodiscard]] Result<std::vector<ManifestEntry>> parse_manifest(std::string_view text,
                                                                const std::string& name);

}  // namespace kinemark::pipeline
