// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Electromyograms of a recording: which of its channels they are, and their measures.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/trial.h"
#include "kinemark/stages/analysis/emg/emg_measures.h"

namespace kinemark::workflow {

/// Which electromyograms are measured, and against what.
struct EmgChoice {
  std::vector<std::string> channels =
      {};  ///< names or patterns of analog channels; empty: found by their names
  analysis::EnvelopeOptions envelope = {};          ///< how they are prepared
  bool to_maximum = false;                          ///< the largest envelope of the recording itself is 100 %
  std::shared_ptr<const data::Trial> maximum = {};  ///< the largest envelopes of this one are 100 % instead
  std::string maximum_name = "the recording of maxima";  ///< in front of what is wrong with it
};

/// Indices of the analog channels that hold electromyograms: those that are named, else those in volts that
/// belong to no force plate and whose names hold "EMG", else the name of a muscle (quad, ham, tib, gas, sol,
/// vas, rec, bic, tri, del, glut, sem, calf ...). Code::usage for a name that no channel has, with the
/// nearest ones.
/// @param named  names or patterns; empty: found by their names
[[nodiscard]] Result<std::vector<std::size_t>> emg_channels(const data::Trial& trial,
                                                            const std::vector<std::string>& named = {});

/// Sentences on the electromyograms of a recording, found by their names, that were rectified before.
[[nodiscard]] std::vector<std::string> contradicted_channels(const data::Trial& trial);

/// Electromyograms of a recording, prepared and measured: over `regions` in the numbers of its frames
/// ("Foot Strike Left 2" is a cycle of the left), or over the whole of it. Code::bad_input as
/// analysis::measure_emg(), and where the recording of maxima lacks a channel.
[[nodiscard]] Result<analysis::EmgMeasures> measure_channels(const data::Trial& trial,
                                                             const EmgChoice& choice,
                                                             const std::vector<data::Region>& regions,
                                                             analysis::EmgOptions options);

}  // namespace kinemark::workflow
