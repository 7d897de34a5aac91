// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/trial_row.h"

namespace kinemark::server {

/// Content-Security-Policy of pages that are made here: files of this server, no script in the page.
inline constexpr std::string_view kOwnPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src data:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// What every page of ours begins with, up to the content of <div id="page">, and what it ends with.
[[nodiscard]] std::string page_head(std::string_view title, bool is_list, std::string_view root);
/// The end of such a page.
[[nodiscard]] std::string page_foot();

/// A page with one sentence on what is wrong, and the way back to the list.
[[nodiscard]] std::string error_page(std::string_view title, std::string_view sentence,
                                     std::string_view root);

/// The page "trials": a line for each. All names are text.
/// @param notes  sentences above the table
[[nodiscard]] std::string list_page(const std::vector<TrialRow>& rows, const std::vector<std::string>& notes,
                                    std::string_view root);

}  // namespace kinemark::server
