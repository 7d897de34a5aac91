// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Frames of markers that come one after the other: who gives them, who takes them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/core/result.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::stream {

/// One frame of M markers, as it comes.
struct Frame {
  std::int64_t number = 0;               ///< from 0; a step of more than 1 says that some were lost
  double time_s = 0.0;                   ///< by the clock of its source
  std::uint64_t came_ns = 0;             ///< when it came, ns since 1970; 0: nobody has looked
  std::vector<double> x_in_world;        ///< M x 3, m; NaN where there is none
  std::vector<data::SampleState> state;  ///< M

  /// All markers missing.
  void clear(std::size_t markers) {
    x_in_world.assign(3 * markers, kNaN);
    state.assign(markers, data::SampleState::missing);
  }
};

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

/// Gives frames in the order in which they come: a device, a simulation, a recording that is played again. To
/// be used by one thread at a time.
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
  /// For those that give frames. @param facts  rate above 0, as many names as frames have markers
  explicit Source(SourceFacts facts) : facts_(std::move(facts)) {}

 private:
  SourceFacts facts_;
};

/// Takes frames in the order in which they come. To be used by one thread at a time.
class Sink {
 public:
  Sink() = default;
  virtual ~Sink() = default;
  Sink(const Sink&) = delete;
  Sink& operator=(const Sink&) = delete;
  /// One frame, of which nothing is kept that is not copied. After a failure it takes no more.
  [[nodiscard]] virtual Status push(const Frame& frame) = 0;
  /// No more frames come. To be called once, and not after a failure.
  [[nodiscard]] virtual Status finish() = 0;
};

}  // namespace kinemark::stream
