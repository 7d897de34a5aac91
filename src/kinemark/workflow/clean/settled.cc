// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <utility>

#include "kinemark/workflow/clean/internal/settled.h"

namespace kinemark::workflow::internal {

void settle_upsampling(RecorderMade made, data::UpsamplingAccount& upsampling) {
  if (upsampling.factor() == 1) return;
  const char* outcomes[] = {"left as they are", "marked as upsampled", "removed",
                            "removed, and the rate brought down"};
  upsampling.done = outcomes[static_cast<int>(made)];
  upsampling.handled = made != RecorderMade::keep;
}

std::vector<data::Defect> settle_defects(std::vector<data::Finding> found,
                                         std::span<const data::Finding> exchanged,
                                         std::span<const data::Finding> rejected) {
  const auto is_among = [](const data::Finding& one, std::span<const data::Finding> others) {
    return std::ranges::any_of(others, [&](const auto& other) {
      return one.kind == other.kind && one.subject == other.subject && one.partner == other.partner &&
             one.first_frame == other.first_frame;
    });
  };
  std::vector<data::Defect> out;
  for (data::Finding& finding : found) {
    const bool is_exchanged = is_among(finding, exchanged), is_rejected = is_among(finding, rejected);
    const char* done = is_exchanged ? "exchanged back" : is_rejected ? "rejected" : "left as it is";
    out.push_back({std::move(finding), done, is_exchanged || is_rejected});
  }
  return out;
}

}  // namespace kinemark::workflow::internal
