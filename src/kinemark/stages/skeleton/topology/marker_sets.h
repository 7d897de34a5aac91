// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What the names of known marker sets say: the part of the body that a marker lies on, or that a point is no
// marker but what a model made of them. A name is a prior: the distances between markers have the last word.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kinemark::skeleton {

/// Parts of a body that move as one. Left and right are told apart by BodySide.
enum class BodyPart : std::uint8_t {
  head,
  thorax,
  pelvis,
  scapula,
  clavicle,
  upper_arm,
  forearm,
  hand,
  thigh,
  shank,
  foot
};
/// None: of the middle.
enum class BodySide : std::uint8_t { none, left, right };

/// Where on its part a marker sits.
enum class MarkerSite : std::uint8_t {
  segment,   ///< on the part, away from joints or on bone that moves with it
  landmark,  ///< on the part's bone beside a joint (epicondyle, malleolus): skin of both sides moves it
  joint      ///< over a joint: on neither side of it
};

/// What the name of a marker says.
struct MarkerPlace {
  BodyPart part = BodyPart::head;         ///< of a marker over a joint: the part above it
  BodySide side = BodySide::none;         ///< none for head, trunk and pelvis
  MarkerSite site = MarkerSite::segment;  ///< where it sits on the part
  std::string_view set;                   ///< the marker set that has the name, as a person calls it
};

/// A row of the table: names of one set that lie on one part.
struct MarkerSetRow {
  std::string_view set;    ///< as a person calls it
  BodyPart part;           ///< on which all of them lie
  MarkerSite site;         ///< of all of them
  bool sided;              ///< the names follow L or R
  std::string_view names;  ///< between blanks; # stands for one digit or two
};

/// All rows, in the order in which they are tried.
[[nodiscard]] std::span<const MarkerSetRow> marker_set_rows();

/// "pelvis", "thigh_l", "upper_arm_r".
[[nodiscard]] std::string name_of(BodyPart part, BodySide side);

/// Place of a marker by its whole name, without regard to a subject's prefix up to ':', case, blanks, and
/// ". _ -"; LEFT and RIGHT count as L and R, and so does a side behind the word ("ThighL2"). Nothing for
/// other names.
[[nodiscard]] std::optional<MarkerPlace> find_marker_place(std::string_view name);

/// Whether each name is one that a model gives to what it made of markers (joint centres, axes' ends, angles,
/// forces), or to a copy of another of the names ("RASHv" of "RASH").
[[nodiscard]] std::vector<std::uint8_t> find_model_outputs(std::span<const std::string> names);

}  // namespace kinemark::skeleton
