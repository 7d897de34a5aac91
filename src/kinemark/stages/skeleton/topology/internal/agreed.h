// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "kinemark/stages/skeleton/topology/internal/rivals.h"
#include "kinemark/stages/skeleton/topology/segmentation.h"

namespace kinemark::skeleton::internal {

/// A joint on which rivals agree, named by its first markers, with its figures; not known where a rule of the
/// options says so, which is the reason then.
[[nodiscard]] JudgedJoint judge_agreement(const Agreement& agreement, const std::vector<Rival>& rivals,
                                          const SegmentationOptions& options,
                                          const std::vector<std::string>& names);

/// The layout of the known joints: clusters for each, so that no marker lies on two segments, those of the
/// rival that has most of the joints where it has this one, others where they fit. A joint that finds none,
/// and one that closes a circle, is known no more.
/// @param out  its joints are those of the agreements, in their order
void lay_out_agreed(const std::vector<Agreement>& agreements, const std::vector<Rival>& rivals,
                    Segmentation& out);

}  // namespace kinemark::skeleton::internal
