// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/stream/frame.h"

namespace kinemark::stream {

/// What a source knows before its first frame.
struct SourceFacts {
  std::string name;                               ///< as given: "sim:walk?seconds=30"
  std::vector<std::string> markers;               ///< M names
  double rate_hz = 0.0;                           ///< frames that come in a second
  double t0_s = 0.0;                              ///< time of frame 0
  std::optional<std::int64_t> frames;             ///< that it has; nothing: nobody knows
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();  ///< away from the floor, length 1
  std::string up_from;                            ///< who says so; empty: nobody
  /// Smallest and largest coordinates, m; nothing: not known. Samples may lie outside.
  std::optional<std::array<Eigen::Vector3d, 2>> extent_m;
};

/// Gives frames in the order in which they come. To be used by one thread at a time.
class Source {
 public:
  virtual ~Source() = default;
  Source(const Source&) = delete;
  Source& operator=(const Source&) = delete;
  /// The same from the beginning to the end.
  [[nodiscard]] const SourceFacts& facts() const { return facts_; }
  /// Put the next frame into `frame`, whose memory is used again; came_ns stays as it is. false: that was
  /// the last one. A failure ends the source.
  [[nodiscard]] virtual Result<bool> next(Frame& frame) = 0;

 protected:
  explicit Source(SourceFacts facts) : facts_(std::move(facts)) {}

 private:
  SourceFacts facts_;
};

}  // namespace kinemark::stream
