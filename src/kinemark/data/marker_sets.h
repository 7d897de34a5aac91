// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Marker sets that laboratories and programs share, known by the names of their markers.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinemark::data {

/// A set, or a part of one that is used alone. Names stand between blanks, without their side.
struct KnownMarkerSet {
  std::string_view name;               ///< as people call it
  std::string_view part;               ///< of the body; empty: there is one alone
  std::string_view left, right;        ///< what stands before a stem: "L." and "R."
  std::string_view paired;             ///< stems that both sides have, each as "FIRST|OTHER|..." spellings
  std::string_view middle;             ///< whole names without a side, likewise
  std::string_view optional_paired{};  ///< of static trials, and of additions that are usual
  std::string_view optional_middle{};  ///< likewise
  std::string_view
      telling{};           ///< stems of which two names must be there: others of the set mean little alone
  bool one_side = false;   ///< used of one arm alone, too
  bool keypoints = false;  ///< joints found in images, not markers on skin
};

/// All of them.
[[nodiscard]] std::span<const KnownMarkerSet> known_marker_sets();

/// The set that the names of a recording are of.
struct FoundMarkerSet {
  const KnownMarkerSet* set = nullptr;  ///< never null
  std::int64_t markers = 0;             ///< of the set
  std::vector<std::string> missing;     ///< those that the recording does not have, as the set spells them

  /// "Plug-in Gait, lower body".
  [[nodiscard]] std::string title() const;
  /// "Plug-in Gait, lower body: 15 of 16 markers, without RTOE".
  [[nodiscard]] std::string describe() const;
};

/// The set of which a recording has most, whatever its prefixes, case, separators and ways to write a side.
/// Nothing where less than 70 % of the markers of a set are there, or less than 60 % of the recording's
/// markers are of it (30 % where 90 % of the set is there), or two sets are equally near. O(names x sets).
///
/// @param names  of all markers
/// @param apart  not zero: a point that a model computed, or without a name, which no set has to explain; as
///               many as names, or empty
[[nodiscard]] std::optional<FoundMarkerSet> find_marker_set(std::span<const std::string> names,
                                                            std::span<const std::uint8_t> apart = {});

}  // namespace kinemark::data
