// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/linkage.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "kinemark/core/index.h"

namespace kinemark::skeleton::internal {

Linkage::Linkage(Eigen::MatrixXd distances) : items_(static_cast<int>(distances.rows())) {
  std::vector<int> alive(at(items_));
  std::iota(alive.begin(), alive.end(), 0);
  std::vector<double> size(at(items_), 1.0);
  while (alive.size() > 1) {
    Merge merge{.keep = 0, .drop = 0, .height = std::numeric_limits<double>::infinity()};
    for (std::size_t i = 0; i < alive.size(); ++i)
      for (std::size_t j = i + 1; j < alive.size(); ++j)
        if (const double d = distances(alive[i], alive[j]); d < merge.height)
          merge = {.keep = alive[i], .drop = alive[j], .height = d};
    if (merge.keep == merge.drop) break;
    const double a = size[at(merge.keep)], b = size[at(merge.drop)];
    for (const int k : alive) {
      const double d = (a * distances(merge.keep, k) + b * distances(merge.drop, k)) / (a + b);
      distances(merge.keep, k) = distances(k, merge.keep) = d;
    }
    size[at(merge.keep)] += b;
    std::erase(alive, merge.drop);
    merges_.push_back(merge);
  }
}

std::vector<std::vector<int>> Linkage::cut(double most) const {
  std::vector<std::vector<int>> clusters(at(items_));
  for (int i = 0; i < items_; ++i) clusters[at(i)].push_back(i);
  // Mean distances never shrink from one merge to the next.
  for (const Merge& merge : merges_) {
    if (merge.height > most) break;
    auto &to = clusters[at(merge.keep)], &from = clusters[at(merge.drop)];
    to.insert(to.end(), from.begin(), from.end());
    from.clear();
  }
  std::erase_if(clusters, [](const auto& c) { return c.empty(); });
  for (auto& c : clusters) std::ranges::sort(c);
  std::ranges::sort(clusters);
  return clusters;
}

}  // namespace kinemark::skeleton::internal
