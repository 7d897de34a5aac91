// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The page of a result whose numbers stand in the JSON document that its command writes.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/stages/report/report_parts.h"
#include "kinemark/stages/report/scene.h"

namespace kinemark::report {

/// A result and what a page says besides its numbers.
struct ResultReport {
  std::string kind;                 ///< "joints", "scale", "calibrate", "reconstruct" or "study"
  std::string trial;                ///< name for the heading, usually the file's
  std::string version;              ///< of the program
  std::string command_line;         ///< as typed; may be empty
  std::vector<NoticeGroup> groups;  ///< what stands out, the serious first
  std::vector<InputFile> inputs;    ///< files that were read
  nlohmann::ordered_json result;    ///< the document of the command
  std::optional<Scene> scene;       ///< what stands in space; may be absent
  std::int64_t first_frame = 0;     ///< number of the scene's first frame, as its file counts
};

/// A group for each kind of gate that was missed.
void add_gates(std::vector<NoticeGroup>& groups, std::span<const Gate> gates);
/// A group for each kind of remark, one sentence each.
void add_remarks(std::vector<NoticeGroup>& groups, std::span<const std::string> remarks);

/// A page of results of docs/formats/pages.md, by its kind.
[[nodiscard]] nlohmann::ordered_json result_report_json(const ResultReport& report,
                                                        const SceneOptions& options = {});

/// One HTML page that needs nothing else. The same report gives the same bytes.
[[nodiscard]] std::string result_report_html(const ResultReport& report, const SceneOptions& options = {});

}  // namespace kinemark::report
