// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The page of a recording that can be edited where it is shown.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/files/edit_session.h"

namespace kinemark::pipeline {

/// State of the edits for a page: what edit_json() holds with the journal's file name alone, and "changes":
/// {"last", "all"}, for each marker that differs from before the last operation and from the recording
/// {"marker", "moved", "came", "went", "restated", "largest_mm", "first", "last"}.
[[nodiscard]] nlohmann::ordered_json editing_json(const EditSession& session);

/// The data of the page: `kinemark.markers_report` of the recording as edited, its scene with the recording
/// as it was read under "before" when edits are in force, and editing_json() as "editing".
[[nodiscard]] nlohmann::ordered_json edited_page_json(const EditSession& session);

/// The page of a recording with its edits. Where these cannot be applied or made (a damaged journal, a
/// recording without a rate) the recording is shown as it is, and "editing" is {"refused": why}. Fails as
/// markers_page().
[[nodiscard]] Result<std::string> edited_page(const std::filesystem::path& recording);

}  // namespace kinemark::pipeline
