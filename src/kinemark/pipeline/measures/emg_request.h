// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Electromyograms as a part of the job of measures.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/trial.h"
#include "kinemark/pipeline/files/result_files.h"
#include "kinemark/stages/analysis/emg/emg_measures.h"
#include "kinemark/stages/analysis/gait/gait_facts.h"
#include "kinemark/workflow/measures/emg_channels.h"

namespace kinemark::pipeline {

/// What is asked about electromyograms. Paths that are empty are not used.
struct EmgRequest {
  std::vector<std::string> channels;   ///< names or patterns of analog channels; empty: found by their names
  analysis::EnvelopeOptions envelope;  ///< how they are prepared
  std::string maximum;                 ///< "", "trial", or a recording whose largest envelopes are 100 %
  std::filesystem::path write;         ///< .sto or .csv: envelopes at the frames of the recording
  std::filesystem::path write_cycles;  ///< .csv: envelopes over the cycles of walking

  /// Whether they are asked about by more than being there.
  [[nodiscard]] bool wanted() const {
    return !channels.empty() || !maximum.empty() || !write.empty() || !write_cycles.empty();
  }
  /// Endings: Code::usage.
  [[nodiscard]] Status check() const;
};

/// The choice of workflow::measure(): the recording of maxima is read. Fails as its reader.
[[nodiscard]] Result<workflow::EmgChoice> emg_choice(const EmgRequest& request);

/// The envelopes at the frames of the recording, in V or, to a maximum, in per cent.
[[nodiscard]] data::Table envelope_table(const data::Trial& trial, const analysis::EmgMeasures& measured,
                                         bool per_cent);
/// The same as CSV: time_s, then a column for each channel. RFC 4180.
[[nodiscard]] std::string envelope_csv(const data::Table& table);
/// The envelopes over the cycles of both feet; of a channel with a side ("L...", "Right ...") over those of
/// its foot.
[[nodiscard]] std::vector<data::CycleCurves> envelope_cycles(const data::Trial& trial,
                                                             const analysis::EmgMeasures& measured,
                                                             std::span<const analysis::GaitCycle> cycles,
                                                             bool per_cent);

}  // namespace kinemark::pipeline
