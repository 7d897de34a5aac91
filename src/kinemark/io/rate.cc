// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/rate.h"

#include <fmt/core.h>

namespace kinemark::io {

Status check_rate(double rate_hz, std::string_view where) {
  if (is_rate(rate_hz)) return {};
  return fail(Code::bad_input, fmt::format("{} is {}; expected a frame rate of {} to {:.0f} Hz", where,
                                           rate_hz, kSlowest_hz, kFastest_hz));
}

Result<bool> states_rate(double rate_hz, std::string_view where, std::vector<std::string>& warnings) {
  if (rate_hz == 0.0) {
    warnings.push_back(fmt::format("{} is 0, which is taken as not known", where));
    return false;
  }
  if (auto s = check_rate(rate_hz, where); !s) return std::unexpected(s.error());
  return true;
}

}  // namespace kinemark::io
