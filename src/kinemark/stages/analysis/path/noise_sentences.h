// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What is said of the noise of a recording's markers: once for all that share it.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/stages/analysis/path/path_noise.h"

namespace kinemark::analysis {

/// The one low-pass that most markers of a recording show. A single marker's spectrum that falls like behind
/// a low-pass may have other reasons; a filter is claimed where markers of other movements and other noise
/// have the same cut-off.
struct SharedFilter {
  std::vector<std::size_t> members;  ///< markers whose cut-off may be the shared one; empty: none is shared
  std::size_t of = 0;                ///< markers whose spectrum could have shown it, or another one
  double cutoff_hz = kNaN;           ///< -3 dB, mean over members
  double low_hz = kNaN;              ///< end of its 95 % interval
  double high_hz = kNaN;             ///< end of its 95 % interval
  [[nodiscard]] bool agreed() const { return !members.empty(); }  ///< a filter may be claimed
};

/// Find the cut-off on which markers agree: three at least, two thirds of all whose spectrum tells (one that
/// leaves its cut-off open by more than a factor of 2.5 tells nothing; one without a low-pass, or that no
/// model fits, is against it), each within its own 95 % interval. Filters that the recording names are not
/// looked at.
[[nodiscard]] SharedFilter find_shared_filter(std::span<const PathNoise> markers);

/// "LANK", or "12 markers (LASI, RASI, LPSI, ...)".
/// @param names  one at least
[[nodiscard]] std::string listed(std::span<const std::string> names);

/// What readers must know of the noise of markers, markers that say the same together; of white noise that
/// was found and nothing contradicts there is nothing to say. That a recording was filtered is said where it
/// names the filter or find_shared_filter() finds one; else that the spectrum falls, and no more.
[[nodiscard]] std::vector<std::string> noise_sentences(std::span<const PathNoise> markers);

}  // namespace kinemark::analysis
