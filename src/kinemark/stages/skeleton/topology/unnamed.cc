// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>

#include "kinemark/stages/skeleton/topology/internal/agreed.h"
#include "kinemark/stages/skeleton/topology/internal/pairs.h"
#include "kinemark/stages/skeleton/topology/internal/rivals.h"
#include "kinemark/stages/skeleton/topology/segmentation.h"

namespace kinemark::skeleton {
namespace {

constexpr std::int64_t kFramesOfRivals = 600;
constexpr double kLeastListed = 0.15;  ///< what has less weight is a rival of other joints, none to be told

}  // namespace

Result<Segmentation> segment_by_data(const data::Trajectories& markers, const Topology& topology,
                                     const SegmentationOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  const auto drawn = internal::cut(markers, internal::draw_evenly(markers.frames(), kFramesOfRivals));
  const Samples samples{drawn, {}};
  const auto rivals = internal::find_rivals(samples, topology, options);
  auto agreements = internal::find_agreements(rivals);
  std::erase_if(agreements, [](const auto& agreement) { return agreement.weight < kLeastListed; });
  Segmentation out;
  out.rivals = static_cast<int>(rivals.size());
  for (const auto& agreement : agreements)
    out.joints.push_back(internal::judge_agreement(agreement, rivals, options, markers.names));
  internal::lay_out_agreed(agreements, rivals, out);
  std::ranges::stable_partition(out.joints, &JudgedJoint::known);
  std::set<int> used;
  for (const auto& joint : out.joints)
    for (const auto* side : {&joint.parent, &joint.child}) used.insert(side->begin(), side->end());
  for (int m = 0; m < static_cast<int>(markers.markers()); ++m)
    if (!used.contains(m)) out.unplaced.push_back(m);
  return out;
}

}  // namespace kinemark::skeleton
