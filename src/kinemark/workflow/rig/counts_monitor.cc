// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/rig/counts_monitor.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kinemark/core/check.h"
#include "kinemark/stages/reconstruction/grid_lookup.h"

namespace kinemark::workflow {
namespace {

constexpr double kLeastLight =
    0.03;                       // of the highest code, all channels together: an LED that shines gives more
constexpr int kDifference = 3;  // order of the differences that noise is taken from
constexpr double kDifferenceVariance = 20.0;  // 1 + 9 + 9 + 1

template <class T>
void take(std::span<const T> from, std::vector<T>& to) {
  to.assign(from.begin(), from.end());
}

}  // namespace

CountsMonitor::CountsMonitor(const data::Counts& layout, int frames)
    : cameras_(static_cast<int>(layout.camera_count())), highest_code_(layout.highest_code) {
  check(frames > kDifference, "a monitor looks at four frames or more");
  ring_.resize(static_cast<std::size_t>(frames));
}

void CountsMonitor::push(std::int64_t number, std::span<const std::int16_t> counts,
                         std::span<const std::uint8_t> flags, std::span<const std::int16_t> dark) {
  check(counts.size() == 4 * flags.size(), "four counts for each flag");
  if (came_ > 0) lost_ += std::max<std::int64_t>(number - back(0).number - 1, 0);
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
  using Channels = Eigen::Map<const Eigen::Matrix<std::int16_t, 4, 1>>;
  Eigen::Vector4d counts = Channels(frame.counts.data() + 4 * index(led, camera)).cast<double>();
  if (frame.dark.empty()) return counts;
  return counts - Channels(frame.dark.data() + 4 * static_cast<std::size_t>(camera)).cast<double>();
}

bool CountsMonitor::is_seen(const Frame& frame, int led, int camera) const {
  const std::uint8_t flags = frame.flags[index(led, camera)];
  if ((flags & (data::kCountOccluded | data::kCountLost)) != 0) return false;
  return light(frame, led, camera).sum() > kLeastLight * highest_code_;
}

double CountsMonitor::noise(int led, int camera) const {
  double sum = 0.0;
  int differences = 0;
  for (std::int64_t age = 0; age + kDifference < kept(); ++age) {
    std::array<Eigen::Vector4d, kDifference + 1> x;
    bool whole = true;
    for (int k = 0; k <= kDifference; ++k) {
      const Frame& frame = back(age + k);
      whole = whole && frame.number == back(age).number - k && is_seen(frame, led, camera) &&
              (frame.flags[index(led, camera)] & data::kCountSaturated) == 0;
      const auto* counts = frame.counts.data() + 4 * index(led, camera);
      x[static_cast<std::size_t>(k)] =
          Eigen::Map<const Eigen::Matrix<std::int16_t, 4, 1>>(counts).cast<double>();
    }
    if (!whole) continue;
    sum += (x[0] - 3.0 * x[1] + 3.0 * x[2] - x[3]).squaredNorm() / (4.0 * kDifferenceVariance);
    ++differences;
  }
  return differences > 0 ? std::sqrt(sum / differences) : kNaN;
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

double CountsMonitor::dark_counts(int camera, int channel) const {
  if (kept() == 0 || back(0).dark.empty()) return kNaN;
  double sum = 0.0;
  for (std::int64_t age = 0; age < kept(); ++age)
    sum += back(age).dark[static_cast<std::size_t>(4 * camera + channel)];
  return sum / static_cast<double>(kept());
}

}  // namespace kinemark::workflow
