// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "kinemark/data/trial.h"
#include "kinemark/io/markers/marker_format.h"

namespace kinemark::io {

/// What a trial holds of a part, in words ("2 events"); empty: nothing. O(F M).
[[nodiscard]] std::string held(const data::Trial& trial, Part part);

/// What a trial holds and a format does not keep, and what its file holds beside (Trial::unread), a sentence
/// each; empty when nothing is lost.
[[nodiscard]] std::vector<std::string> lost_in(const MarkerFormat& format, const data::Trial& trial);

/// What a file of that ending ("" or any) does not keep of what lies besides movement, in one sentence;
/// empty: nothing is lost.
[[nodiscard]] std::string lost_beside(std::string_view extension, const data::Beside& beside);

/// The table of formats as Markdown: a row for each, what it is read or written as, a column for each part.
[[nodiscard]] std::string marker_format_table();

}  // namespace kinemark::io
