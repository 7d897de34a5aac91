// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"
#include "server/page_shelf.h"

namespace kinemark::server {

/// The page of a trial: the report of a solved one, of markers their recording, which can be edited there,
/// else what the file holds. O(file). Fails as the readers of its files.
/// @param root      where pages begin, Keys::root()
/// @param geometry  further folders of models' meshes
[[nodiscard]] Result<Page> make_trial_page(const std::filesystem::path& path, std::string_view root,
                                           const std::vector<std::filesystem::path>& geometry = {});

/// A self-contained report page with a policy under which its own style sheet and script run and nothing
/// else. The first style sheet and the last script are its own: data stand before the script.
/// @param nonce  unpredictable, of new_secret()
/// @param asks   it may ask this server for more
[[nodiscard]] Page shielded(std::string html, std::string_view nonce, bool asks = false);

}  // namespace kinemark::server
