// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/rig/alignment_guide.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/stages/reconstruction/grid_lookup.h"

namespace kinemark::workflow {
namespace {

constexpr double kElsewhere = 0.02;  // of a detector's half-side, that a spot has moved by in another pose
constexpr int kFewestFrames = 10;    // of a pose, whatever the rate

}  // namespace

Result<AlignmentGuide> AlignmentGuide::create(const data::Counts& layout, data::Rig wanted,
                                              const std::vector<double>& sides_m) {
  auto tree = calibration::tree_from_sides(sides_m);
  if (!tree) return std::unexpected(tree.error());
  if (layout.led_count() != static_cast<std::int64_t>(tree->size()))
    return fail(Code::usage, fmt::format("the tree that cameras are aligned by has {} LEDs; there are {}",
                                         tree->size(), layout.led_count()));
  if (layout.camera_count() != wanted.camera_count())
    return fail(Code::usage, fmt::format("the rig has {} cameras; there are {}", wanted.camera_count(),
                                         layout.camera_count()));
  data::Counts second = layout;
  second.time.frames = std::max<std::int64_t>(kFewestFrames, std::llround(layout.time.rate_hz));
  const auto observations = static_cast<std::size_t>(second.frames()) * tree->size() * layout.cameras.size();
  second.counts.resize(4 * observations);
  second.flags.resize(observations);
  second.dark.clear();
  second.dark_time_s.clear();
  return AlignmentGuide(std::move(second), std::move(wanted), std::move(*tree));
}

AlignmentGuide::AlignmentGuide(data::Counts second, data::Rig wanted, std::vector<Eigen::Vector3d> tree)
    : second_(std::move(second)), wanted_(std::move(wanted)) {
  poses_.tree = std::move(tree);
  poses_.cameras = wanted_.camera_count();
}

void AlignmentGuide::restart() {
  poses_.observations.clear();
  alignment_.reset();
  trouble_.clear();
  filled_ = 0;
}

void AlignmentGuide::push(std::span<const std::int16_t> counts, std::span<const std::uint8_t> flags) {
  check(4 * flags.size() == counts.size() &&
            second_.flags.size() == flags.size() * static_cast<std::size_t>(second_.frames()),
        "a frame of the layout");
  const auto at = static_cast<std::ptrdiff_t>(flags.size()) * filled_;
  std::copy(counts.begin(), counts.end(), second_.counts.begin() + 4 * at);
  std::copy(flags.begin(), flags.end(), second_.flags.begin() + at);
  if (++filled_ == second_.frames()) take_second();
}

// A spot is elsewhere where its detector ratios are.
bool AlignmentGuide::is_new(const std::vector<calibration::StillObservation>& pose) const {
  if (poses() == 0) return true;
  const auto last = poses_.observations.end() - static_cast<std::ptrdiff_t>(pose.size());
  for (std::size_t o = 0; o < pose.size(); ++o) {
    const auto& before = last[static_cast<std::ptrdiff_t>(o)];
    if ((reconstruction::detector_ratios(pose[o].counts) - reconstruction::detector_ratios(before.counts))
            .norm() > kElsewhere)
      return true;
  }
  return false;
}

void AlignmentGuide::take_second() {
  const calibration::FrameRange whole{0, filled_};
  filled_ = 0;
  std::vector<calibration::StillObservation> pose;
  for (int led = 0; led < poses_.leds(); ++led)
    for (int c = 0; c < poses_.cameras; ++c)
      pose.push_back(calibration::still_observation(second_, wanted_.electronics, whole, led, c));
  if (!std::ranges::all_of(pose, &calibration::StillObservation::seen) || !is_new(pose)) return;
  poses_.observations.insert(poses_.observations.end(), pose.begin(), pose.end());
  if (poses() < kFewestPoses) return;
  auto found = calibration::align_by_tree(wanted_, poses_);
  trouble_ = found ? "" : found.error().message;
  alignment_ = found ? std::optional(std::move(*found)) : std::nullopt;
}

std::string AlignmentGuide::sentence() const {
  if (!trouble_.empty()) return trouble_;
  if (!alignment_)
    return fmt::format("hold the tree still for a second, in one place after the other: {} of {}", poses(),
                       kFewestPoses);
  return fmt::format("{} (from {} poses)", alignment_->next, poses());
}

}  // namespace kinemark::workflow
