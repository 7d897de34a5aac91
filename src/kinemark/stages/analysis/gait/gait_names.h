// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the name of a marker tells: whose it is, on which side, and where on the foot or pelvis.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/data/gait_event.h"

namespace kinemark::analysis {

/// Places that events of walking need.
enum class BodyPlace : std::uint8_t {
  heel,
  forefoot,
  ankle,
  front_of_pelvis,
  back_of_pelvis,
  sacrum,
  knee,
  outer_ankle,  ///< at the lateral malleolus: a name that means no other place of the ankle
};

/// Lower-case letters and digits after the last colon: "rheel" of "Anna:R.Heel".
[[nodiscard]] std::string plain_name(std::string_view name);
/// Before the last colon: "Anna" of "Anna:R.Heel"; empty where there is none.
[[nodiscard]] std::string_view person_of(std::string_view name);

/// A side, and what the name says besides: {left, "hee"} of "lhee".
struct SidedWord {
  data::Side side = data::Side::left;  ///< as the prefix or suffix says
  std::string word;                    ///< the rest, not empty
};
/// All readings of a plain name: side as prefix (l, left, lx) or as suffix (l, left). None: it names no side.
[[nodiscard]] std::vector<SidedWord> sided_words(std::string_view plain);

/// Position of a whole word in the list of names of a place, the best first; -1: it is none of them.
[[nodiscard]] int rank_of(BodyPlace place, std::string_view word);

}  // namespace kinemark::analysis
