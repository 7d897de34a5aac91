// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/rig/counts_monitor.h"

#include <algorithm>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/stages/reconstruction/grid_lookup.h"
#include "kinemark/stream/count_check.h"

namespace kinemark::workflow {
namespace {

constexpr int kFewestInARow = 4;  // that noise is taken from

Eigen::Vector4d channels(const std::vector<std::int16_t>& counts, std::size_t first) {
  return Eigen::Map<const Eigen::Matrix<std::int16_t, 4, 1>>(counts.data() + first).cast<double>();
}

template <class T>
void take(std::span<const T> from, std::vector<T>& to) {
  to.assign(from.begin(), from.end());
}

}  // namespace

CountsMonitor::CountsMonitor(const data::Counts& layout, int frames)
    : cameras_(static_cast<int>(layout.camera_count())), highest_code_(layout.highest_code) {
  check(frames >= kFewestInARow, "a monitor looks at four frames or more");
  ring_.resize(static_cast<std::size_t>(frames));
}

void CountsMonitor::push(std::int64_t number, std::span<const std::int16_t> counts,
                         std::span<const std::uint8_t> flags, std::span<const std::int16_t> dark) {
  check(counts.size() == 4 * flags.size(), "four counts for each flag");
  Frame& frame = ring_[static_cast<std::size_t>(came_) % ring_.size()];
  frame.number = number;
  take(counts, frame.counts);
  take(flags, frame.flags);
  take(dark, frame.dark);
  ++came_;
}

const CountsMonitor::Frame& CountsMonitor::back(std::int64_t age) const {
  return ring_[static_cast<std::size_t>(came_ - 1 - age) % ring_.size()];
}

std::int64_t CountsMonitor::kept() const { return std::min(came_, static_cast<std::int64_t>(ring_.size())); }

std::size_t CountsMonitor::index(int led, int camera) const {
  return static_cast<std::size_t>(led * cameras_ + camera);
}

Eigen::Vector4d CountsMonitor::light(const Frame& frame, int led, int camera) const {
  const Eigen::Vector4d dark = frame.dark.empty()
                                   ? Eigen::Vector4d(Eigen::Vector4d::Zero())
                                   : channels(frame.dark, 4 * static_cast<std::size_t>(camera));
  return channels(frame.counts, 4 * index(led, camera)) - dark;
}

bool CountsMonitor::is_seen(const Frame& frame, int led, int camera) const {
  const std::uint8_t flags = frame.flags[index(led, camera)];
  if ((flags & (data::kCountOccluded | data::kCountLost)) != 0) return false;
  return light(frame, led, camera).sum() > stream::kLeastLightShare * highest_code_;
}

// Of all four channels together.
double CountsMonitor::noise(int led, int camera) const {
  stream::DifferenceNoise noise;
  for (std::int64_t age = kept() - 1; age >= 0; --age) {
    const Frame& frame = back(age);
    if (!is_seen(frame, led, camera) || (frame.flags[index(led, camera)] & data::kCountSaturated) != 0)
      continue;
    noise.add(frame.number, channels(frame.counts, 4 * index(led, camera)));
  }
  return std::sqrt(noise.sd().cwiseAbs2().mean());
}

LedInCamera CountsMonitor::seen(int led, int camera) const {
  LedInCamera out;
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  double highest = 0.0;
  std::int64_t seen = 0, occluded = 0, saturated = 0;
  for (std::int64_t age = 0; age < kept(); ++age) {
    const Frame& frame = back(age);
    if (!is_seen(frame, led, camera)) {
      ++occluded;
      continue;
    }
    if ((frame.flags[index(led, camera)] & data::kCountSaturated) != 0) ++saturated;
    const auto first = frame.counts.begin() + static_cast<std::ptrdiff_t>(4 * index(led, camera));
    highest = std::max(highest, static_cast<double>(*std::max_element(first, first + 4)));
    sum += light(frame, led, camera);
    ++seen;
  }
  if (kept() > 0) {
    out.occluded_share = static_cast<double>(occluded) / static_cast<double>(kept());
    out.saturated_share = static_cast<double>(saturated) / static_cast<double>(kept());
  }
  if (seen == 0) return out;
  const Eigen::Vector4d mean = sum / static_cast<double>(seen);
  out.spot = reconstruction::detector_ratios(mean);
  out.light_counts = mean.sum();
  out.highest_share = highest / highest_code_;
  out.noise_counts = noise(led, camera);
  return out;
}

std::vector<Eigen::Vector2d> CountsMonitor::spots(int led, int camera) const {
  std::vector<Eigen::Vector2d> out;
  for (std::int64_t age = kept() - 1; age >= 0; --age) {
    const Frame& frame = back(age);
    out.push_back(is_seen(frame, led, camera) ? reconstruction::detector_ratios(light(frame, led, camera))
                                              : Eigen::Vector2d::Constant(kNaN));
  }
  return out;
}

}  // namespace kinemark::workflow
