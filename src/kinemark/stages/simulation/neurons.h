// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Neurons that know how a hand moves: units tuned to its velocity, field potentials, trials.
#pragma once

#include <cstdint>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"
#include "kinemark/core/time_base.h"
#include "kinemark/data/neural.h"

namespace kinemark::simulation {

/// Options of simulate_neurons().
struct NeuronOptions {
  int units = 0;                  ///< 0 to 1000
  int trials = 0;                 ///< 0 to 1000: the session in so many equal parts
  bool field_potentials = false;  ///< four channels at 500 Hz
  double lead_s = 0.1;            ///< by which spikes precede the movement, -1 to 1
  std::uint64_t seed = 1;         ///< of tuning, spikes and potentials

  /// Anything is asked for.
  [[nodiscard]] bool any() const { return units > 0 || trials > 0 || field_potentials; }
  /// Ranges hold and no number is NaN.
  [[nodiscard]] Status check() const;
};

/// What is recorded beside a movement.
struct NeuralSession {
  data::Neural neural;                     ///< units and trials
  std::vector<data::FieldSamples> fields;  ///< their envelopes are not in `neural`
};

/// Spikes of units whose rate follows the velocity v of the hand,
///
///   rate(t) = max(0, baseline + depth cos(angle between v(t + lead) and the preferred direction) |v| / RMS
///   |v|),
///
/// by an inhomogeneous Poisson process: cosine tuning of Georgopoulos et al. (1982), J. Neurosci. 2:1527,
/// scaled by the speed (Moran & Schwartz 1999, J. Neurophysiol. 82:2676). Preferred directions are uniform
/// over the sphere; baseline is 5 to 20 Hz and depth 0.5 to 1.5 times that: labels of each unit. Trials are
/// the session in equal parts with a tenth between them, labelled by the side on which the hand is in the
/// mean. Field potentials: noise whose power falls with frequency, and 20 Hz that weakens as the hand moves.
///
/// @param hand_in_world  F x 3, m, without gaps, F = time.frames >= 3
/// @return               Code::usage as check()
[[nodiscard]] Result<NeuralSession> simulate_neurons(const Array<double>& hand_in_world, const TimeBase& time,
                                                     const NeuronOptions& options);

}  // namespace kinemark::simulation
