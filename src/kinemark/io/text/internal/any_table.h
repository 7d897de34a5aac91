// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "kinemark/core/result.h"
#include "kinemark/data/table.h"

namespace kinemark::io::internal {

/// parse_table() of io/text/table_file.h, or with `orientations` a table of quaternions and no other: the
/// cells "w,x,y,z" become the columns name_1 to name_4.
[[nodiscard]] Result<data::Table> parse_table(std::string_view text, std::string_view name,
                                              bool orientations);

}  // namespace kinemark::io::internal
