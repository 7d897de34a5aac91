// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/io/text/keypoints_csv.h"

namespace kinemark::io::internal {

/// One person of a frame.
struct Person {
  std::optional<std::int64_t> number;  ///< that the file gives her
  std::vector<double> values;          ///< x, y in px and a score of each point; not finite: not known
};

/// Collects the points of one person, frame by frame.
class PointFrames {
 public:
  explicit PointFrames(const KeypointsOptions& options) : options_(options) {}

  /// The people of a frame, which `bytes` of the file tell. Numbers of frames rise; frames between them show
  /// nobody. Several people where none is chosen are Code::not_supported; people of different numbers of
  /// points, frames out of order, and many more values than the file explains are Code::bad_input.
  [[nodiscard]] Status add(std::int64_t frame, std::span<const Person> people, std::size_t bytes);
  /// Points of a person in a file; 0 before there was somebody.
  [[nodiscard]] std::size_t points() const { return points_; }
  /// All frames from the first to the last. Nobody in any of them, and names that do not fit the points, are
  /// Code::bad_input.
  [[nodiscard]] Result<Keypoints> finish(std::vector<std::string> names);

 private:
  [[nodiscard]] Result<const Person*> choose(std::span<const Person> people) const;
  [[nodiscard]] Status make_room(std::size_t points);
  [[nodiscard]] Status check_scale() const;

  KeypointsOptions options_;
  std::vector<double> image_;
  std::optional<std::int64_t> first_;
  std::int64_t frames_ = 0;
  std::size_t points_ = 0, bytes_ = 0;
  bool chosen_ = false;
};

}  // namespace kinemark::io::internal
