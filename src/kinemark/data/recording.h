// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// A recording in memory, as it is used: what its file held, and what was done to that since.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/data/edit.h"
#include "kinemark/data/trial.h"
#include "kinemark/data/wrenches.h"

namespace kinemark::data {

/// A person's edits that were applied to a recording.
struct EditsInForce {
  std::size_t in_force = 0;                                  ///< operations
  std::vector<Region> regions;                               ///< that they name
  std::vector<std::pair<std::string, std::string>> swapped;  ///< markers that they swap, as they name them
};

/// Markers, channels, plates and events of one trial with its forces, its edits and its vertical. A trial
/// that was made in memory is one without further words: Recording{.trial = ...}.
struct Recording {
  Trial trial;  ///< its warnings stay those of the reader
  std::optional<Wrenches> plates =
      {};                         ///< forces of its plates on its frames; none: not wanted, or not there
  std::string plates_fault = {};  ///< why plates that are there have no forces; empty: they do
  bool rate_known = true;         ///< false: frames are counted at 1 Hz
  EditsInForce edits = {};        ///< that were applied
  std::optional<Eigen::Vector3d> up = {};  ///< which way is up as it was stated, length 1; none: nobody did
  std::vector<std::string> notes = {};     ///< what was done to it, one sentence each
  std::vector<std::string> contradicted =
      {};  ///< its numbers that contradict what else is known, one sentence each: a verb that rests on them
           ///< misses the gate `contradictions`
};

}  // namespace kinemark::data
