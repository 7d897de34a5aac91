// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/rig/reconstruct.h"

#include <utility>

#include "kinemark/core/enum_names.h"

namespace kinemark::workflow {

std::string_view to_string(ReconstructMethod method) {
  constexpr EnumNames<ReconstructMethod::classic> kNames{"smoother", "frames", "classic"};
  return kNames[method];
}

Result<Reconstructed> reconstruct(const data::Counts& counts, const data::Rig& rig,
                                  const ReconstructOptions& options) {
  auto frames = options.frames;
  frames.threads = options.threads;
  auto found = options.method == ReconstructMethod::classic
                   ? reconstruction::reconstruct_classic(counts, rig, frames)
                   : reconstruction::reconstruct(counts, rig, frames);
  if (!found) return std::unexpected(found.error());
  if (options.method != ReconstructMethod::smoother)
    return Reconstructed{.markers = std::move(found->points), .leds = std::move(found->leds), .fits = {}};
  auto smoother = options.smoother;
  smoother.threads = options.threads;
  auto smooth = trajectory::smooth_counts(counts, rig, found->points, smoother);
  if (!smooth) return std::unexpected(smooth.error());
  return Reconstructed{
      .markers = std::move(smooth->points), .leds = std::move(found->leds), .fits = std::move(smooth->leds)};
}

}  // namespace kinemark::workflow
