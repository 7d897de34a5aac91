// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Pages of the server's own, as data for the page that viewer/ makes: types of viewer/schema/served.json.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/pipeline/files/info_job.h"
#include "server/message.h"
#include "server/trial_row.h"

namespace kinemark::server {

/// Content-Security-Policy of these pages: files of this server, no script in the page.
inline constexpr std::string_view kOwnPolicy =
    "default-src 'none'; script-src 'self'; style-src 'self'; img-src data:; connect-src 'self'; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

/// A file that these pages ask for: style sheets and their script.
[[nodiscard]] std::optional<Response> served_file(std::string_view target);

/// Trials: a row for each, and sentences above them.
[[nodiscard]] nlohmann::ordered_json trials_json(const std::vector<TrialRow>& rows,
                                                 const std::vector<std::string>& notes);
/// The page "trials", TrialsPage.
/// @param root  where pages begin, Keys::root()
[[nodiscard]] std::string trials_page(const std::vector<TrialRow>& rows,
                                      const std::vector<std::string>& notes, std::string_view root);

/// What 'kinemark info' knows of a file, FactsPage.
[[nodiscard]] std::string facts_page(const pipeline::InfoOutcome& info, std::string_view root);

/// A page with one sentence on what is wrong, NoticePage.
[[nodiscard]] std::string notice_page(std::string_view title, std::string_view sentence,
                                      std::string_view root);

}  // namespace kinemark::server
