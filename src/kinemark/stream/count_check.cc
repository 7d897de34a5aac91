// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/count_check.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "kinemark/core/missing.h"

namespace kinemark::stream {
namespace {

using Eigen::Vector4d;

constexpr double kStillFactor = 1.5, kStillCounts = 0.3;
constexpr double kThirdDifference = 20.0;  // variance of one, in that of a frame

}  // namespace

void DifferenceNoise::add(std::int64_t frame, const Vector4d& counts) {
  if (in_a_row_ > 0 && frame != last_frame_ + 1) in_a_row_ = 0;
  if (in_a_row_ >= 3) {
    squares_ += (counts - 3.0 * last_[0] + 3.0 * last_[1] - last_[2]).cwiseAbs2();
    ++differences_;
  }
  last_ = {counts, last_[0], last_[1]};
  last_frame_ = frame;
  ++in_a_row_;
}

Vector4d DifferenceNoise::sd() const {
  if (differences_ == 0) return Vector4d::Constant(kNaN);
  return (squares_ / (kThirdDifference * static_cast<double>(differences_))).cwiseSqrt();
}

CountCheck::CountCheck(const data::Counts& like)
    : lit_(like.leds.size() * like.cameras.size()), dark_(like.dark_time_s.size() / 4) {}

void CountCheck::Running::add(std::int64_t frame, const std::int16_t* counts) {
  const Vector4d now = Eigen::Map<const Eigen::Matrix<std::int16_t, 4, 1>>(counts).cast<double>();
  const Vector4d off = now - mean;
  mean += off / static_cast<double>(++frames);
  squares += off.cwiseProduct(now - mean);
  noise.add(frame, now);
}

CountLevels CountCheck::Running::levels() const {
  CountLevels out{.frames = frames, .saturated = saturated, .mean = mean};
  if (frames == 0) out.mean.setConstant(kNaN);
  out.sd = frames > 1 ? Vector4d((squares / static_cast<double>(frames - 1)).cwiseSqrt())
                      : Vector4d::Constant(kNaN);
  out.noise = noise.sd();
  out.still = ((out.sd - kStillFactor * out.noise).array() <= kStillCounts).all();
  return out;
}

void CountCheck::add(const Block& block) {
  for (std::int64_t f = 0; f < block.frames; ++f) {
    const auto i = static_cast<std::size_t>(f);
    for (std::size_t at = 0; at < lit_.size(); ++at) {
      const auto flags = block.flags[i * lit_.size() + at];
      if ((flags & data::kCountLost) != 0) continue;
      lit_[at].saturated += (flags & data::kCountSaturated) != 0;
      lit_[at].add(block.first_frame + f, block.counts.data() + 4 * (i * lit_.size() + at));
    }
    for (std::size_t at = 0; at < dark_.size(); ++at)
      dark_[at].add(block.first_frame + f, block.dark.data() + 4 * (i * dark_.size() + at));
  }
}

std::vector<CountLevels> CountCheck::lit() const {
  std::vector<CountLevels> out;
  std::ranges::transform(lit_, std::back_inserter(out), &Running::levels);
  return out;
}

std::vector<CountLevels> CountCheck::dark() const {
  std::vector<CountLevels> out;
  std::ranges::transform(dark_, std::back_inserter(out), &Running::levels);
  return out;
}

}  // namespace kinemark::stream
