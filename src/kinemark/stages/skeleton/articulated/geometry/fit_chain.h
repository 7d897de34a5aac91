// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The geometry of a chain by maximum likelihood, from many frames.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/stages/skeleton/articulated/chain/chain.h"
#include "kinemark/stages/skeleton/articulated/chain/fitted_chain.h"

namespace kinemark::skeleton::articulated {

/// Options of fit_chain().
struct ChainFitOptions {
  std::vector<data::SegmentKind> kind;  ///< S; empty: chosen from the data
  double noise_sd_m = 0.0;              ///< per axis; 0: estimated from the residuals
  bool marker_noise = false;            ///< each marker has a noise of its own, shrunk towards the common one
  double robust_dof = 0.0;              ///< Student's t for the markers' errors; 0: Gaussian
  int rounds = 3;                       ///< of geometry, verdicts, geometry
  int frames_max = 1500;                ///< frames that inform the geometry, drawn evenly; 50 or more
  double alternative_max = 1e-3;        ///< weight of other minima that a determined frame may have
  std::vector<std::string> marker_names;  ///< K, for warnings; empty: numbers
  /// A first geometry with more noise is returned as it is: further rounds would not make a body of it.
  double most_noise_m = std::numeric_limits<double>::infinity();
  /// The same for a joint farther from the nearest marker of one of its segments.
  double most_reach_m = std::numeric_limits<double>::infinity();
  /// The same for a joint whose distance from a marker of its segments changes by more (RMS).
  double most_change_m = std::numeric_limits<double>::infinity();
  int threads = 1;  ///< 0: all cores. Any number gives the same bits.
};

/// Fit the geometry. `progress` is asked before every step of the fit whether to go on, with none of the
/// frames done. Errors: a segment without a marker, no frame that shows enough, in one sentence.
[[nodiscard]] Result<FittedChain> fit_chain(const ChainSamples& samples, const ChainLayout& layout,
                                            const ChainFitOptions& options = {},
                                            const Progress& progress = {});

}  // namespace kinemark::skeleton::articulated
