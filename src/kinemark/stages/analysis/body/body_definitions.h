// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The measures of a body's motion: what each is, and of what it is taken.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "kinemark/data/measure.h"
#include "kinemark/stages/analysis/body/body_series.h"
#include "kinemark/stages/analysis/body/extremes.h"

namespace kinemark::analysis {

/// What a measure is of.
enum class BodyScope : std::uint8_t {
  coordinate,  ///< each coordinate
  torque,      ///< each coordinate whose joint has a torque
  pair,        ///< two coordinates that are named
  body,        ///< the whole body
  support,     ///< the whole body and what it stands on
  side,        ///< the whole body and the left or the right foot
};

/// A version of the motion, a stretch of it, and who is measured.
struct BodyView {
  const BodySeries& series;             ///< this version
  const BodyRecord& record;             ///< what all versions share
  const Eigen::MatrixX<bool>& contact;  ///< F x 2, of all versions
  std::int64_t first = 0, count = 0;    ///< frames
  Eigen::Index a = 0, b = 0;            ///< coordinates; b of a pair alone
  data::Side side = data::Side::left;   ///< of BodyScope::side
  bool normalized = false;              ///< kinetics per mass, momentum over mass, speed and height

  /// Values of a coordinate in the stretch.
  [[nodiscard]] auto of(const Eigen::MatrixXd& values, Eigen::Index c) const {
    return values.col(c).segment(first, count);
  }
};

/// One measure of a body's motion.
struct BodyDefinition {
  data::MeasureDefinition what;             ///< its line in `--list`; of a rotation
  BodyScope scope = BodyScope::coordinate;  ///< what it is of
  int sign = 0;  ///< 1: never below 0, -1: never above; at most or at least, where it cannot be told from 0
  bool turns = false;         ///< an angle that begins again after a turn
  bool approximate = false;   ///< its interval covers less than its level in some movements
  Pick pick = Pick::largest;  ///< of the curve
  /// What its extreme is taken of, SI; nothing where not known. Null: it is no extreme.
  Eigen::VectorXd (*curve)(const BodyView& view) = nullptr;
  /// SI; NaN where not determined. Null: the pick of the curve, instants in s from its beginning.
  double (*formula)(const BodyView& view) = nullptr;

  /// The measure of a version of the motion.
  [[nodiscard]] double value(const BodyView& view) const;
  /// A sample of the curve is the instant.
  [[nodiscard]] bool is_instant() const {
    return curve != nullptr && (pick == Pick::time_of_largest || pick == Pick::time_of_smallest);
  }
};

/// All of them, in the order in which they are shown.
[[nodiscard]] std::span<const BodyDefinition> body_definitions();
/// One by its id, or nothing.
[[nodiscard]] const BodyDefinition* find_body_definition(std::string_view id);

/// The quantity of a measure of a coordinate that turns or moves along, of whole numbers or per mass.
[[nodiscard]] data::Quantity quantity_of(const BodyDefinition& definition, bool is_rotation, bool normalized);

}  // namespace kinemark::analysis
