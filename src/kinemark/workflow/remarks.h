// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What a verb has to say beside its result.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "kinemark/data/run_record.h"

namespace kinemark::workflow {

/// Sentences for people, and the bounds that the result had to meet.
struct Remarks {
  std::vector<std::string> warnings;  ///< what was odd or left out, one sentence each
  std::vector<data::Gate> gates;      ///< bounds that the result had to meet

  /// Whether the result met all of them.
  [[nodiscard]] bool passed() const { return std::ranges::all_of(gates, &data::Gate::passed); }
};

}  // namespace kinemark::workflow
