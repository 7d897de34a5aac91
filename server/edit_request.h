// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"

namespace kinemark::server {

/// An operation that somebody asks for, and on what.
struct EditRequest {
  std::size_t expected = 0;  ///< operations that the journal holds, as who asks believes
  data::Edit edit;           ///< one operation, its id as given
};

/// Parse {"expected": 12, "edit": {"do": "swap", ...}}, the operation in the words of a journal.
/// Code::bad_input, one sentence: no such object, a value of another type, or what io::parse_edit() says.
[[nodiscard]] Result<EditRequest> parse_edit_request(std::string_view body);

}  // namespace kinemark::server
