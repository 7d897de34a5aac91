// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Stretches of samples that are not believed: those that still last, and those that have ended.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace kinemark::motion::internal {

/// A stretch of samples of one marker that do not fit what came before. Both ends belong to it.
struct Outlier {
  int marker = 0;
  std::int64_t first_frame = 0, last_frame = 0;  ///< first <= last, whatever the direction
  double distance = 0.0;                         ///< largest, in standard deviations
  double length_m = 0.0;                         ///< largest distance from where the marker was expected
  bool returned = true;  ///< the marker came back to where it was expected; false: it never did
  /// From the model's marker, m: where it was, and where it was expected, the farthest.
  double from_model_m = 0.0, expected_from_model_m = 0.0;
  /// What gave it away: its path, a value held digit by digit, a coordinate that is exactly 0.
  enum class Why : std::uint8_t { path, held, zero } why = Why::path;
  /// So much farther from the model's marker than expected that it cannot merely have a new position.
  [[nodiscard]] bool clearly_wrong() const;
  int partner = -1;  ///< the marker in whose position it was while that one was in its own, or -1
};

/// One stretch that lasts per marker at most, in the order in which they began; the ended ones in the order
/// in which they ended.
class OutlierAccount {
 public:
  explicit OutlierAccount(Eigen::Index markers);

  [[nodiscard]] bool lasts(Eigen::Index marker) const { return open_[index(marker)] >= 0; }
  /// The stretch of a marker that lasts; there must be one.
  [[nodiscard]] const Outlier& lasting(Eigen::Index marker) const;
  /// The stretch of the marker, which `frame` is part of: begun now if none lasts.
  Outlier& extend(Eigen::Index marker, std::int64_t frame);
  /// End the stretch of a marker; there must be one.
  void end(Eigen::Index marker, bool returned);
  /// Add a stretch as a whole.
  void add(const Outlier& outlier) { ended_.push_back(outlier); }
  /// End all and hand them over.
  [[nodiscard]] std::vector<Outlier> finish();
  /// Drop what has ended.
  void forget();

 private:
  [[nodiscard]] static std::size_t index(Eigen::Index marker) { return static_cast<std::size_t>(marker); }

  std::vector<std::int64_t> open_;  ///< per marker: index into begun_, or -1
  std::vector<Outlier> begun_, ended_;
};

}  // namespace kinemark::motion::internal
