// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "kinemark/stages/trajectory/gaps/gap_options.h"
#include "kinemark/stages/trajectory/gaps/internal/gap_problem.h"

namespace kinemark::trajectory::internal {

/// A temporal fill at the rows of the windows (R x H) and in the whole gap (L x H).
struct Walk {
  std::shared_ptr<const Eigen::MatrixXd> rows;
  std::shared_ptr<const Eigen::MatrixXd> gap;
};

/// Chooses order and bandwidth of the integrated random walk by their error on the windows. (What is best
/// for smoothing, as SURE finds it, is far too stiff for gaps.)
class WalkChooser {
 public:
  WalkChooser(const GapProblem& problem, double rate_hz, WalkCache& cache)
      : problem_(&problem), rate_hz_(rate_hz), cache_(&cache) {}
  /// The best one of these orders for a target of width 3; nothing when no order is possible.
  [[nodiscard]] std::optional<Walk> best(const Signal& target, int lowest_order, int highest_order) const;

 private:
  const GapProblem* problem_;
  double rate_hz_;
  WalkCache* cache_;
};

/// The candidate methods that `automatic` combines.
enum class FillKind : std::uint8_t {
  chord,
  spline,
  pchip,
  walk,               ///< order 1 or 2
  walk_stiff,         ///< order 3 or 4
  rigid_untied,       ///< mean position in the local frame
  rigid_chord,        ///< local frame, chord between both ends
  rigid_walk,         ///< local frame, walk
  regression_untied,  ///< local frame, neighbours' positions
  regression_chord,   ///< ... what the chord leaves unexplained, of target and neighbours
  regression_walk,    ///< ... what the walk leaves unexplained
  regression_stiff,   ///< ... what the walk of order 3 leaves unexplained
  pca_untied,
  pca_chord,
};
inline constexpr int kFillKinds = 14;

/// "linear", "cubic", "pchip", "walk", "walk, order 3", "rigid, untied", ...
[[nodiscard]] std::string_view to_string(FillKind kind);
/// True for methods that use only the marker's own path.
[[nodiscard]] bool is_temporal(FillKind kind);
/// True for methods that do not pass through the samples beside the gap.
[[nodiscard]] bool is_untied(FillKind kind);
/// How errors grow with the length of a gap: as length^growth.
[[nodiscard]] double error_growth(FillKind kind);

/// One candidate and its errors on the windows.
struct Fill {
  FillKind kind = FillKind::chord;
  Eigen::MatrixXd gap;      ///< L x 3, m in world
  Eigen::MatrixXd errors;   ///< R x 3 W, truth - fill, m in world; as many columns as there are windows
  double near_rms_m = 0.0;  ///< untied: 3D distance to the samples beside the gap
  /// What the neighbours do in the gap, as a multiple of what they do on the windows, where that matters to
  /// this method: RMS of what is left of them when they are filled in the same way.
  double stretch = 1.0;
  /// 3D, RMS over the windows; infinity without any.
  [[nodiscard]] double rms_m() const;
};

/// RMS of quantities in the gap over their RMS on the windows; 1 where there are none.
[[nodiscard]] double stretch_of(const Eigen::MatrixXd& rows, const Eigen::MatrixXd& gap);

/// The candidates of a method that the problem allows. Without windows those that need no
/// training.
[[nodiscard]] std::vector<Fill> make_fills(const Recording& recording, const GapProblem& problem,
                                           GapMethod method, WalkCache& cache);

}  // namespace kinemark::trajectory::internal
