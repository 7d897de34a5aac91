// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Least squares frame after frame, each from its neighbour's pose.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "kinemark/core/array.h"
#include "kinemark/core/progress.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/stages/motion/internal/frame_solver.h"

namespace kinemark::motion::internal {

/// Where each marker lay on its body, seen from the pose of its frame: F x M x 3, m in the body's axes (in
/// the world's for markers of the ground); NaN where it was not seen. Half the precision of the rest: only
/// steps of more than a tenth of a millimetre matter.
using PositionsOnBody = Array<float>;

/// Poses of all frames and how each came about.
struct SolvedFrames {
  Eigen::MatrixXd states;                ///< one column per frame
  PositionsOnBody positions;             ///< F x M x 3; empty where they were not asked for
  Array<double> marker_error;            ///< F x M x 3, measured minus model, m; NaN where not seen
  Array<data::FrameStatus> status;       ///< F
  std::vector<double> cost, loop_gap_m;  ///< F: weighted mean of squares, m^2; widest gap of a closed loop, m
  std::int64_t first = 0;                ///< the frame that was solved first, from many starts
  std::int64_t iterations = 0;           ///< of all frames together
};

/// Walks over the frames of a problem.
class FrameWalk {
 public:
  FrameWalk(const Problem& problem, const IkOptions& options, const Progress& progress);

  /// Solve all frames from the first one that sees nearly all markers, forwards and then backwards. False
  /// when the caller stopped it.
  [[nodiscard]] bool run(const data::Trajectories& markers, bool keep_positions, SolvedFrames& solved);

  /// Solve the frames of which `concerned` (F) is not 0 again, each stretch from the poses at its ends, and
  /// those beside it that had followed a wrong pose. All others stay as they are, to the bit.
  void solve_again(const data::Trajectories& markers, const std::vector<std::uint8_t>& concerned,
                   SolvedFrames& solved);

  /// Look for poses that lie far from their neighbour's without need, such as whole turns that a bad sample
  /// gave the frames behind it: the pose found from the neighbour takes their place unless it is much worse.
  void mend(const data::Trajectories& markers, SolvedFrames& solved);

  /// Solve the frames concerned once more, from their states, with samples that were put back into `filled`.
  /// Those that `kept` lacks have no error and no part in the cost.
  void solve_filled(const data::Trajectories& kept, const data::Trajectories& filled,
                    const std::vector<std::uint8_t>& concerned, SolvedFrames& solved);

  /// Take poses of all frames (one column each) as they are, and where they put the markers.
  void take(const data::Trajectories& markers, const Eigen::MatrixXd& states,
            const Array<data::FrameStatus>& status, SolvedFrames& solved);

  /// Take a pose for a frame, as it is.
  void put(const data::Trajectories& markers, std::int64_t f, const Eigen::VectorXd& state,
           SolvedFrames& solved);

  /// Of all frames that were solved so far.
  [[nodiscard]] std::int64_t iterations() const { return solver_.iterations(); }

 private:
  void make_room(bool keep_positions, SolvedFrames& solved) const;
  [[nodiscard]] std::int64_t find_first(const data::Trajectories& markers) const;
  /// A marker comes back in frame f: the pose from before it went counts as well as the one found without it.
  /// The cheaper is taken, of two that are as good the one nearer to before. What happened in the gap then
  /// does not outlast it.
  void compare_with_before_gap(std::int64_t f, int direction, const SolvedFrames& solved,
                               FrameSolver::Outcome& outcome);
  bool walk(const data::Trajectories& markers, std::int64_t first, std::int64_t end, int direction,
            SolvedFrames& solved);
  /// Begin anew, from no known pose, where bad samples had spoilt the frame that was solved first: what
  /// followed from it may lie whole turns away.
  void start_again(const data::Trajectories& markers, const std::vector<std::uint8_t>& concerned,
                   SolvedFrames& solved);
  /// Solve frames from one end of a stretch to the other.
  void solve_stretch(const data::Trajectories& markers, std::int64_t from, std::int64_t to,
                     const Eigen::VectorXd& start, SolvedFrames& solved);
  /// Solve the frames behind `from` again as long as that finds another pose that is not much worse.
  void follow(const data::Trajectories& markers, std::int64_t from, int direction, SolvedFrames& solved);
  /// Take from x_ the whole turns by which hinges lie away from `near`, where the pose stays the same.
  void unwind(const Eigen::VectorXd& near, std::int64_t f);
  /// Weighted mean of the squared residuals of the pose last visited, m^2.
  [[nodiscard]] double marker_cost() const;
  void store(std::int64_t f, bool converged, SolvedFrames& solved);

  const Problem& problem_;
  const IkOptions& options_;
  const Progress& progress_;
  FrameSolver solver_;
  Eigen::Matrix3Xd y_;
  Eigen::VectorXd weight_, x_, before_, retry_, move_;
  std::vector<std::int64_t> last_seen_;  ///< per marker: the frame of this walk that saw it last, or -1
  std::int64_t done_ = 0;
};

}  // namespace kinemark::motion::internal
