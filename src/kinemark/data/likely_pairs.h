// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which marker of a recording is probably meant by a name that it does not have.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinemark::data {

/// A marker of a recording, and the name under which it is wanted.
struct LikelyPair {
  std::string recorded;  ///< in the recording
  std::string wanted;    ///< in the model

  auto operator<=>(const LikelyPair&) const = default;
};

/// Pairs of one name in two spellings ("R_Heel" and "RHeel"), then of two names for one landmark ("RHEE" and
/// "R.Heel"), in the order of `wanted`. Both names of a pair say the same side, or none; each name is in one
/// pair at most, and none that the recording has as it is wanted, or that several names would fit. Keypoints
/// of joints are paired with joint centres and keypoints alone.
[[nodiscard]] std::vector<LikelyPair> find_likely_pairs(std::span<const std::string> wanted,
                                                        std::span<const std::string> recorded);

/// "--rename RHEE=R.Heel,LHEE=L.Heel", as a shell takes it, in several options where it is long; empty of no
/// pairs. Pairs that the option cannot
/// say (a comma in a name, "=" in a new one, * or ? in an old one) are left out.
[[nodiscard]] std::string rename_option(std::span<const LikelyPair> pairs);

/// The same of the likely pairs, for the end of a sentence: "; likely: --rename RHEE=R.Heel"; empty of none.
[[nodiscard]] std::string rename_proposal(std::span<const std::string> wanted,
                                          std::span<const std::string> recorded);

/// A text in quotes where a shell would not take it as it is.
[[nodiscard]] std::string for_shell(std::string_view text);

}  // namespace kinemark::data
