// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of one point's path over stretches of a recording, freed of the bias of noise, with intervals.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/edit.h"
#include "kinemark/data/measure.h"
#include "kinemark/data/trajectories.h"
#include "kinemark/data/trial.h"
#include "kinemark/stages/analysis/path/path_curves.h"
#include "kinemark/stages/analysis/path/path_noise.h"
#include "kinemark/stages/analysis/path/path_rhythm.h"

namespace kinemark::analysis {

/// What is measured, and how.
struct PathMeasureOptions {
  std::vector<std::string> measures;  ///< ids of path_definitions() and rhythm_definitions(); empty: those
                                      ///< that apply to the movement
  std::vector<data::Region> regions;  ///< stretches of frames; empty: the whole recording
  std::int64_t refits = 99;           ///< behind each interval: 0 (none) or what `level` needs, 39 at 0.95
  double noise_sd_m = 0.0;            ///< per axis, as known of the cameras; 0: found from the samples
  double level = 0.95;                ///< of the intervals, above 0.5 to 0.9999
  std::uint64_t seed = 1;             ///< of the refits
  int threads = 1;                    ///< 0: all cores; any number gives the same bits
  bool curves = false;                ///< keep what the measures are taken of, for figures
  bool keep_outliers = false;  ///< measure single frames far from their neighbours, too; the noise is found
                               ///< without them
  data::CalibrationError calibration_error;  ///< of the markers' positions: part of all intervals of shape
  bool rhythms = false;  ///< find events and repetitions, too; measures of them that are asked for imply it

  /// Ranges as above, ids that exist (the nearest ones are told); Code::usage.
  [[nodiscard]] Status check() const;
};

/// What was measured of one recording.
struct PathMeasures {
  std::vector<data::Measure>
      measures;                     ///< markers in the recording's order, their regions, their definitions
  std::vector<PathCurves> curves;   ///< of each marker and region, where asked for
  std::vector<PathRhythm> rhythms;  ///< of each marker and region, where asked for; their measures are among
                                    ///< those above, behind the others of their stretch
  std::vector<PathNoise> noises;    ///< of the markers that are measured
  std::vector<std::string>
      warnings;  ///< noise_sentences(), not_measured_sentences(), then stretches that could not be measured
};

/// Measure the paths of all markers (docs/theory/measures.md).
///
/// Order and cut-off of the smoother come from the data (choose_smoothing()), the noise, whatever its colour,
/// from their spectrum above the movement (find_path_noise()). A value is that of the path smoothed with
/// kLessSmooth times this cut-off, less the mean deviation that refits of simulated noise around a pilot path
/// have; its interval is the pivot of these deviations. Edges of 80 ms at both ends of the recording are not
/// measured. Samples that are missing or made are no samples here: they are gaps of the smoother, and their
/// share is told. Values are NaN, with a remark, where a measure is not determined.
///
/// @return  Code::usage as options.check(); Code::bad_input where the recording has no rate or no marker, or
/// a
///          region lies outside it, in the wrong order or is shorter than five samples.
/// Cost: about 0.1 s for a marker of 500 samples with 99 refits.
[[nodiscard]] Result<PathMeasures> measure_paths(const data::Trajectories& markers,
                                                 const PathMeasureOptions& options);

/// Code::bad_input for a region that ends before it begins or lies outside the recording.
[[nodiscard]] Status check_regions(const TimeBase& time, const std::vector<data::Region>& regions);

}  // namespace kinemark::analysis
