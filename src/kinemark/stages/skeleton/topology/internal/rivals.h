// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <vector>

#include "kinemark/stages/skeleton/topology/internal/place.h"
#include "kinemark/stages/skeleton/topology/segmentation.h"

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

/// One segmentation of the data, and the joints that it makes.
struct Rival {
  std::vector<std::vector<int>> clusters;  ///< sorted, by their first marker
  double weight = 0.0;                     ///< share of all segmentations that are this one
  std::vector<Place> joints;               ///< spanning trees, cheapest first
};

/// Segmentations of the drawn frames that differ, by linkage of distances and as `topology` has them, with
/// their joints.
[[nodiscard]] std::vector<Rival> find_rivals(const Samples& samples, const Topology& topology,
                                             const SegmentationOptions& options);

/// A joint of one rival, and which.
struct RivalPlace {
  std::size_t rival = 0;
  const Place* place = nullptr;
};

/// A place in space on which rivals agree.
struct Agreement {
  std::vector<RivalPlace> members;  ///< the one that is believed first
  double weight = 0.0;              ///< of the rivals that have it
  double spread_m = 0.0;            ///< RMS distance from the first
  double rival_weight = 0.0;        ///< of the rivals that lack it and have another joint near it
  std::vector<RivalPlace> others;   ///< those joints
};

/// Joints of all rivals, matched by where they are. Pointers into `rivals`.
[[nodiscard]] std::vector<Agreement> find_agreements(const std::vector<Rival>& rivals);

}  // namespace kinemark::skeleton::internal
