// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Answers to programs and scripts: JSON, and refusals as {"error": one sentence}.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string_view>

#include "kinemark/core/result.h"
#include "server/message.h"

namespace kinemark::server {

/// To somebody who was let in.
[[nodiscard]] Response json_response(int status, const nlohmann::ordered_json& json);

/// One sentence on what is wrong, printable.
[[nodiscard]] Response refusal(int status, std::string_view sentence);

/// What is wrong with the data (422) is not what is wrong with the disk (503).
[[nodiscard]] Response refusal(const Error& error);

/// Whether a content type is JSON's, which the form of a foreign page cannot send.
[[nodiscard]] bool is_json(std::string_view type);

}  // namespace kinemark::server
