// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string_view>

#include "kinemark/core/result.h"

namespace kinemark::io::internal {

/// Gets one piece of a document; `key` is the key of the outermost object that it stands under, empty in a
/// document that is an array. A failure ends the reading.
using TakePiece = std::function<Status(std::string_view key, const nlohmann::json& piece)>;

/// Reads a document of JSON piece by piece: each element of an outermost array or of an array under a key of
/// the outermost object, and each other value under such a key. Memory: the text and its largest piece. NaN,
/// as Python writes it, is null. No JSON, a number that is none, and more than 32 levels are Code::bad_input
/// with the line.
[[nodiscard]] Status read_pieces(std::string_view text, const TakePiece& take);

}  // namespace kinemark::io::internal
