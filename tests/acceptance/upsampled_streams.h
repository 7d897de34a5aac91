// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Marker streams that a recorder interpolated, and others that are only unusual: generated here without the
// library, so that the detector is judged by somebody else's arithmetic.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/stages/trajectory/screening/upsampling.h"

namespace kinemark::acceptance {

using Stream = std::vector<Eigen::Vector3d>;  // mm
using Path = std::function<Eigen::Vector3d(double time_s)>;

/// Real trials to take motion from; empty where there are none.
struct MotionLibrary {
  std::vector<data::Trajectories> trials;
  static MotionLibrary load(const std::optional<std::filesystem::path>& folder);
};

/// Noise-free motion, mm: a real marker low-passed at 8 Hz, harmonics, slow drift, or rest.
[[nodiscard]] Path random_path(Random& random, const MotionLibrary& library, double duration_s);

/// Low-rate samples to `factor` times the rate.
[[nodiscard]] Stream interpolate(const Stream& low, int factor, data::InterpolationKernel kernel,
                                 bool flat_ends);
/// The same by a windowed sinc of 16 lobes each way: the band-limited resampler of signal processing.
[[nodiscard]] Stream resample(const Stream& low, int factor);
/// Butterworth of order 2, forth and back.
void low_pass(Stream& stream, double cutoff_hz, double rate_hz);

void add_noise(Stream& stream, double sd_mm, Random& random);
/// Correlated from frame to frame by 0.8.
void add_coloured_noise(Stream& stream, double sd_mm, Random& random);
/// To multiples of a step (0: none), then to single precision, as files hold them.
void round_to(Stream& stream, double step_mm);

[[nodiscard]] data::Trajectories recording(const std::vector<Stream>& streams, double rate_hz);

}  // namespace kinemark::acceptance
