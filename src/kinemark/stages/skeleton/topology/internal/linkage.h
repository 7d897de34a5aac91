// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <vector>

namespace kinemark::skeleton::internal {

/// Average linkage (UPGMA) of items by their distances.
class Linkage {
 public:
  /// @param distances  symmetric, no NaN. O(n^3).
  explicit Linkage(Eigen::MatrixXd distances);
  /// Clusters whose mean distances are `most` or less: sorted lists of items, by their first item.
  [[nodiscard]] std::vector<std::vector<int>> cut(double most) const;

 private:
  struct Merge {
    int keep, drop;
    double height;
  };
  int items_ = 0;
  std::vector<Merge> merges_;
};

}  // namespace kinemark::skeleton::internal
