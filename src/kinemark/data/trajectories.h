// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/filter_used.h"

namespace kinemark::data {

/// Provenance of a sample. Only `measured` samples come from the cameras; the others were computed or are
/// absent.
enum class SampleState : std::uint8_t { missing, measured, interpolated, model_filled, upsampled, rejected };

/// Name of a state as written in files and tables: "missing", "measured", ...
[[nodiscard]] std::string_view to_string(SampleState state);

/// Labelled points through time: F frames, M markers, metres in the laboratory frame of the file.
///
/// Element (frame, marker, axis) is x_in_world[(frame * M + marker) * 3 + axis]. Where state is missing or
/// rejected all three coordinates are NaN.
struct Trajectories {
  std::vector<std::string> names;  ///< M, unique
  TimeBase time;                   ///< F = time.frames
  Array<double> x_in_world;        ///< F x M x 3, m
  Array<SampleState> state;        ///< F x M
  Array<double> covariance;        ///< F x M x 6 (xx xy xz yy yz zz), m^2; empty when unknown
  /// How samples were made ("cubic", "rigid body", ...) and, F x M, by which: 0 as recorded, k by methods[k -
  /// 1]. `method` is empty where nothing was made.
  std::vector<std::string> methods;
  /// F x M; 0 as recorded, k by methods[k - 1]; empty where nothing was made.
  Array<std::uint8_t> method;
  /// Time at which a marker was actually measured, s after its frame's time: M (the same in every frame), F x
  /// M, or empty (0).
  Array<double> sample_offset_s;
  /// Filter that each marker went through before it came here: M, or empty where nothing says that one did.
  std::vector<FilterUsed> filters;
  /// Samples as they were before that filter: F x M x 3, m, NaN where not measured; empty when not kept.
  Array<double> unfiltered_in_world;

  [[nodiscard]] std::int64_t frames() const { return time.frames; }                               ///< F
  [[nodiscard]] std::int64_t markers() const { return static_cast<std::int64_t>(names.size()); }  ///< M
  /// Index of a marker in a frame, in every F x M array.
  [[nodiscard]] std::size_t index(std::int64_t frame, std::int64_t marker) const {
    return static_cast<std::size_t>(frame * markers() + marker);
  }
  /// A sample, m; NaN where it is not present.
  [[nodiscard]] Eigen::Map<const Eigen::Vector3d> x(std::int64_t frame, std::int64_t marker) const {
    return Eigen::Map<const Eigen::Vector3d>(x_in_world.data() + 3 * index(frame, marker));
  }
  /// The same, to be written; the state is left as it is.
  [[nodiscard]] Eigen::Map<Eigen::Vector3d> x(std::int64_t frame, std::int64_t marker) {
    return Eigen::Map<Eigen::Vector3d>(x_in_world.data() + 3 * index(frame, marker));
  }
  /// True where there are coordinates: measured or made, but neither missing nor rejected.
  [[nodiscard]] bool present(std::int64_t frame, std::int64_t marker) const {
    const SampleState s = state[index(frame, marker)];
    return s != SampleState::missing && s != SampleState::rejected;
  }
  /// Where the sample comes from in words: "" as recorded, else the name of the method.
  [[nodiscard]] std::string_view made_by(std::int64_t frame, std::int64_t marker) const;
  /// Note that a sample was made by `name` (at most 255 names). The first call allocates F x M.
  void set_method(std::int64_t frame, std::int64_t marker, std::string_view name);
  /// Time of a sample, s.
  [[nodiscard]] double time_s(std::int64_t frame, std::int64_t marker) const;
  /// Take a sample's coordinates away and say why: missing or rejected.
  void set_missing(std::int64_t frame, std::int64_t marker, SampleState why = SampleState::missing);
  /// Index of a marker, or -1.
  [[nodiscard]] std::int64_t find(std::string_view name) const;
  /// Number of (frame, marker) pairs that are not present.
  [[nodiscard]] std::int64_t count_missing() const;

  /// F x M samples, all missing.
  static Trajectories all_missing(std::vector<std::string> names, const TimeBase& time);

  /// Shapes agree, names are unique and not empty, the rate is positive and finite, present samples are
  /// finite and the others NaN. O(F M).
  [[nodiscard]] Status validate() const;
};

}  // namespace kinemark::data
