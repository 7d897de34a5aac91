// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kinemark/core/result.h"

namespace kinemark::io {

/// Labelled points in the images of one camera: F frames, M points.
struct Keypoints {
  std::vector<std::string> names;  ///< M, each unique
  std::vector<double> image;       ///< F x M x 2, px, x right and y down; NaN where not seen

  /// F
  [[nodiscard]] std::int64_t frames() const {
    return names.empty() ? 0 : static_cast<std::int64_t>(image.size() / (2 * names.size()));
  }
  /// A point in a frame, px; NaN where not seen.
  [[nodiscard]] Eigen::Vector2d at(std::int64_t frame, std::size_t point) const {
    return Eigen::Map<const Eigen::Vector2d>(image.data() +
                                             2 * (static_cast<std::size_t>(frame) * names.size() + point));
  }
};

/// Options of read_keypoints_csv().
struct KeypointsOptions {
  double min_likelihood = 0.6;  ///< 0 to 1: points less likely are not seen
  /// Which person, in files of several: by the number that the file gives her, else by her place in each
  /// frame, from 1. Without: the only one.
  std::optional<std::int64_t> person;

  /// min_likelihood lies in [0, 1], the number is not negative.
  [[nodiscard]] Status check() const;
};

/// Read what DeepLabCut and its kin write as CSV: a line `scorer`, a line `bodyparts` with the name of a
/// point over each of its columns, a line `coords` with x, y and, if known, likelihood; then a line for each
/// frame, which begins with its number: 0, 1, 2, ... without a gap. A point is not seen where x and y are
/// blank or NaN, or the likelihood is blank or too low. Anything else that makes no sense is Code::bad_input
/// with the line; files of several individuals of which none is chosen are Code::not_supported. What SLEAP
/// writes as analysis CSV, a line for each animal in each frame, is read too. docs/formats/keypoints.md
[[nodiscard]] Result<Keypoints> read_keypoints_csv(const std::filesystem::path& path,
                                                   const KeypointsOptions& options = {});
/// The same from memory; `name` stands in messages. Memory is bounded by a multiple of the text.
[[nodiscard]] Result<Keypoints> parse_keypoints_csv(std::string_view text, const std::string& name,
                                                    const KeypointsOptions& options = {});

}  // namespace kinemark::io
