// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/result.h"

namespace kinemark::data {

/// What a channel tells.
enum class ChannelKind : std::uint8_t { angle, force, moment, power, scalar, modeled_marker, other };

/// "angle", "force", "moment", "power", "scalar", "modeled marker" or "other".
[[nodiscard]] std::string_view to_string(ChannelKind kind);

/// Outputs of a model that a file keeps among its markers: C channels of three components in F frames. Their
/// numbers are the file's own in the file's own unit, because they are carried, not computed with: degrees
/// that became radians would not give back the same bits.
struct Channels {
  std::vector<std::string> names;  ///< C, each once
  std::vector<ChannelKind> kinds;  ///< C
  std::vector<std::string> units;  ///< C, as the file says ("deg", "Nmm"); empty: it does not say
  double rate_hz = 0.0;            ///< of each channel; 0 without channels
  std::int64_t frames = 0;         ///< F
  Array<double> values;            ///< F x C x 3; NaN where missing

  [[nodiscard]] std::int64_t count() const { return std::ssize(names); }  ///< C
  [[nodiscard]] Status validate() const;                                  ///< arrays have their shapes
};

/// True for a name that a recorder gives to a marker that nobody named: "*12", "uname*3", "point 7"
/// (which is what the C3D reader says for none), or none.
[[nodiscard]] bool is_unlabelled(std::string_view name);

}  // namespace kinemark::data
