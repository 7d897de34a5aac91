// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "kinemark/data/trajectories.h"

namespace kinemark::trajectory::internal {

using Eigen::Index;

/// Working copy of a recording for the gap filler: one marker after the other, with questions about stretches
/// answered in constant time. "Usable" samples are those that were measured (or made by the recorder's own
/// upsampling); "doubtful" ones are usable but far from the position predicted by their neighbours.
class Recording {
 public:
  /// @param left  markers without a usable sample, whatever they have
  explicit Recording(const data::Trajectories& in, std::span<const std::int64_t> left = {});

  [[nodiscard]] Index frames() const { return frames_; }
  [[nodiscard]] Index markers() const { return static_cast<Index>(x_.size()); }
  [[nodiscard]] double rate_hz() const { return rate_hz_; }
  [[nodiscard]] auto x(Index marker, Index frame) const { return at(x_, marker).col(frame); }
  [[nodiscard]] bool usable(Index marker, Index frame) const { return complete(marker, frame, frame + 1); }
  /// Every sample of [first, end) is usable.
  [[nodiscard]] bool complete(Index marker, Index first, Index end) const {
    return count(unusable_before_, marker, first, end) == 0;
  }
  [[nodiscard]] Index doubtful(Index marker, Index first, Index end) const {
    return count(doubtful_before_, marker, first, end);
  }
  [[nodiscard]] Index usable_frames(Index marker) const {
    return frames_ - count(unusable_before_, marker, 0, frames_);
  }

  /// Give each of two markers the other's samples of one frame. Both are usable there.
  void exchange(Index first_marker, Index second_marker, Index frame);
  /// Set the doubtful samples, F flags per marker.
  void set_doubtful(const std::vector<std::vector<std::uint8_t>>& flags);
  /// SD of a usable sample of a marker, m per axis: fourth differences in its quieter half; 0 with fewer than
  /// 8 of them. Includes the roughest motion that the frame rate cannot resolve.
  [[nodiscard]] double estimate_noise(Index marker) const;

 private:
  using Counts = std::vector<std::vector<std::int32_t>>;
  template <class T>
  static const T& at(const std::vector<T>& v, Index i) {
    return v[static_cast<std::size_t>(i)];
  }
  static Index count(const Counts& before, Index marker, Index first, Index end) {
    const auto& b = at(before, marker);
    return at(b, end) - at(b, first);
  }

  double rate_hz_ = 0.0;
  Index frames_ = 0;
  std::vector<Eigen::Matrix3Xd> x_;
  Counts unusable_before_;  // M x (F + 1)
  Counts doubtful_before_;
};

}  // namespace kinemark::trajectory::internal
