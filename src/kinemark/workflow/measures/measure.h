// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of a recording: paths of markers, walking, force plates, electromyograms.
#pragma once

#include <optional>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/measure.h"
#include "kinemark/data/recording.h"
#include "kinemark/stages/analysis/emg/emg_measures.h"
#include "kinemark/stages/analysis/gait/gait.h"
#include "kinemark/stages/analysis/path/path_curves.h"
#include "kinemark/stages/analysis/path/path_noise.h"
#include "kinemark/stages/analysis/path/path_rhythm.h"
#include "kinemark/workflow/measures/asked.h"
#include "kinemark/workflow/remarks.h"

namespace kinemark::workflow {

/// What was measured, by kind.
struct MeasuresFound {
  std::vector<data::Measure>
      measures;  ///< of walking, plates, EMG, then markers in the recording's order, their regions
  std::optional<analysis::Gait> gait;        ///< walking, where it was asked for or is there
  std::optional<analysis::EmgMeasures> emg;  ///< electromyograms, likewise
  std::vector<analysis::PathRhythm>
      rhythms;  ///< what repeats in the paths, where events or cycles of them are asked for
  std::vector<analysis::PathNoise> noises;  ///< of the markers whose paths are measured
};

/// A recording that was measured.
struct Measured : MeasuresFound {
  data::Recording recording;                 ///< as it was measured: doubtful samples are rejected
  std::vector<analysis::PathCurves> curves;  ///< where they are asked for
  Remarks remarks;                           ///< what was left out, and what could not be measured
};

/// Paths of markers: lengths, speeds, extents, smoothness, what repeats, each with its interval. Samples that
/// the recorder made, that were filled or that screening rejects are not measured.
///
/// Code::usage as asked_measures() and parse_region(); Code::bad_input as regions_between() and
/// analysis::measure_paths(), and where no marker can be measured.
[[nodiscard]] Result<Measured> measure(data::Recording recording, const MeasureOptions& options = {});

/// Walking and standing: events of the feet from markers, from the plates' forces, or from the recording,
/// strides, steps, loads. Code::bad_input as analysis::analyze_gait() where there is no walking and plates
/// show nothing either; else as measure().
[[nodiscard]] Result<Measured> gait(data::Recording recording, const MeasureOptions& options = {});

/// Electromyograms: amplitudes, bursts, spectra, of channels by name. Errors as measure_channels().
[[nodiscard]] Result<Measured> emg(data::Recording recording, const MeasureOptions& options = {});

/// What options.of says: everything that the recording holds, or one of the above. What was asked for by name
/// and fails is a remark where something else is measured. Errors as measure(), those of asked_measures()
/// left.
[[nodiscard]] Result<Measured> measure_recording(data::Recording recording, AskedMeasures asked);

/// Walking in a recording: its markers as they are, its plates, its events, its vertical where it is stated.
/// Code::bad_input as analysis::analyze_gait().
[[nodiscard]] Result<analysis::Gait> measure_gait(const data::Recording& recording,
                                                  const analysis::GaitOptions& options);

}  // namespace kinemark::workflow
