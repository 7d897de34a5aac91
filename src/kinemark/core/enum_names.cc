// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/core/enum_names.h"

#include <fmt/core.h>

#include <string>
#include <vector>

#include "kinemark/core/text.h"

namespace kinemark {

std::unexpected<Error> unknown_name(Code code, std::string_view what, std::string_view name,
                                    std::span<const std::string_view> known) {
  const std::vector<std::string> names(known.begin(), known.end());
  return fail(code,
              fmt::format("there is no {} '{}'; there are {}", what, name, join_names(names, names.size())));
}

}  // namespace kinemark
