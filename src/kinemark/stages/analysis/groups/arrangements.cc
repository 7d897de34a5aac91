// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/groups/arrangements.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinemark::analysis {

Arrangements::Arrangements(Labels observed, bool signs, double possible, std::int64_t most,
                           std::uint64_t seed)
    : observed_(std::move(observed)),
      labels_(observed_),
      signs_(signs),
      exact_(possible <= static_cast<double>(most)),
      possible_(possible),
      count_(exact_ ? static_cast<std::int64_t>(possible) : most),
      seed_(seed),
      random_(seed, 0) {}

Arrangements Arrangements::of_groups(const std::vector<std::int64_t>& sizes, std::int64_t most,
                                     std::uint64_t seed) {
  Labels labels;
  double possible = 1.0;
  for (std::size_t g = 0; g < sizes.size(); ++g)
    for (std::int64_t i = 1; i <= sizes[g]; ++i) {
      labels.push_back(static_cast<std::uint8_t>(g));
      // A multinomial coefficient as a product of binomials: whole after each factor.
      possible = std::round(possible * static_cast<double>(labels.size()) / static_cast<double>(i));
    }
  return {std::move(labels), false, possible, most, seed};
}

Arrangements Arrangements::of_signs(std::int64_t curves, std::int64_t most, std::uint64_t seed) {
  return {Labels(static_cast<std::size_t>(curves), 0), true, std::ldexp(1.0, static_cast<int>(curves)), most,
          seed};
}

const Arrangements::Labels& Arrangements::next() {
  if (at_ == count_) at_ = 0;
  if (at_ == 0) {
    labels_ = observed_;
    random_ = Random(seed_, 0);
  } else if (exact_) {
    step_exact();
  } else {
    draw();
  }
  ++at_;
  return labels_;
}

void Arrangements::step_exact() {
  if (!signs_) {
    std::ranges::next_permutation(labels_);
    return;
  }
  for (auto& label : labels_) {  // a binary number counts up
    label ^= 1U;
    if (label == 1U) return;
  }
}

void Arrangements::draw() {
  if (signs_) {
    for (auto& label : labels_) label = random_.uniform() < 0.5 ? 0 : 1;
    return;
  }
  for (std::size_t i = labels_.size(); i > 1; --i)
    std::swap(labels_[i - 1], labels_[static_cast<std::size_t>(random_.uniform() * static_cast<double>(i))]);
}

}  // namespace kinemark::analysis
