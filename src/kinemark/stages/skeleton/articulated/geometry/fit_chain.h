// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The articulated maximum-likelihood estimate: the geometry from many frames, then every frame on its own,
// with its covariance and a verdict on whether the frame alone determines it.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "kinemark/core/progress.h"
#include "kinemark/core/result.h"
#include "kinemark/stages/skeleton/articulated/chain/chain.h"
#include "kinemark/stages/skeleton/articulated/frame/frame_fit.h"

namespace kinemark::skeleton {

/// Options of fit_chain().
struct ChainFitOptions {
  std::vector<data::SegmentKind> kind;  ///< S; empty: chosen from the data
  double noise_sd_m = 0.0;              ///< per axis; 0: estimated from the residuals
  bool marker_noise = false;            ///< each marker has a noise of its own, shrunk towards the common one
  double robust_dof = 0.0;              ///< Student's t for the markers' errors; 0: Gaussian
  int rounds = 3;                       ///< of geometry, verdicts, geometry
  int frames_max = 1500;                ///< frames that inform the geometry, drawn evenly; 50 or more
  double alternative_max = 1e-3;        ///< weight of other minima that a determined frame may have
  std::vector<std::string> marker_names;  ///< K, for warnings; empty: numbers
};

/// Geometry with its uncertainty.
struct ChainFit {
  Chain chain;
  double noise_sd_m = 0.0;            ///< given or found
  std::vector<double> marker_weight;  ///< K: (common SD / own SD)^2; 0: left out, its place is not known
  Eigen::MatrixXd global_covariance;  ///< n_g x n_g, m^2; zero along the gauge
  std::vector<std::int64_t> frames;   ///< that informed the geometry
  double residual_dof = 0.0;
  double chi2 = 0.0;              ///< of these frames' residuals, in units of noise_sd_m^2
  double covariance_scale = 1.0;  ///< of a frame's own covariance, where turns are weak
  double global_covariance_scale =
      1.0;  ///< in it already: where the geometry's bias was estimated, 1 or more
  double robust_dof = 0.0;
  double alternative_max = 1e-3;
  /// chi-square by which the best mirrored geometry is worse: below about 10 the data do not tell them apart.
  double twin_margin = std::numeric_limits<double>::infinity();
  std::vector<std::string> warnings;

  /// Joint j in the axes of its parent or child: covariance, m^2, defined up to the gauge (segment axes held
  /// by the markers' mean position and turn).
  [[nodiscard]] Matrix3d joint_covariance(int j, bool in_parent) const;
  /// Distance between two joints of one segment and its SD, m.
  struct Length {
    int joint_a = 0, joint_b = 0, segment = 0;
    double length_m = 0.0, sd_m = 0.0;
    Vector3d way = Vector3d::Zero();  ///< unit vector from a to b in the segment's axes
  };
  [[nodiscard]] std::vector<Length> lengths() const;
};

/// Fit the geometry. `progress` is asked before every step of the fit whether to go on, with none of the
/// frames done. Errors: a segment without a marker, no frame that shows enough, in one sentence.
[[nodiscard]] Result<ChainFit> fit_chain(const ChainSamples& samples, const ChainLayout& layout,
                                         const ChainFitOptions& options = {}, const Progress& progress = {});

/// One of the poses that fit a frame.
struct ChainMode {
  ChainPose pose;
  double cost = 0.0;             ///< m^2, weighted
  double weight = 0.0;           ///< share of the probability, 0 to 1
  std::vector<Vector3d> centre;  ///< joints, m
};

/// All that is known of a frame.
struct ChainFrame {
  std::vector<data::CentreState> state;  ///< per joint: undetermined, ambiguous or determined
  std::vector<Vector3d> centre;          ///< per joint, of the best mode (or see gathered), m
  std::vector<Matrix3d> covariance;      ///< per joint, m^2, with the geometry's own part
  std::vector<Matrix3d> own_covariance;  ///< per joint, m^2, geometry held
  std::vector<Matrix3d> information;     ///< per joint, 1/m^2, geometry held; any rank
  std::vector<ChainMode> modes;          ///< best first; one when no other was looked for
  int mode_count = 0;                    ///< entries of `modes` in use
  bool gathered = false;                 ///< some centre is the mean of several modes that lie close together
  int seen = 0;
};

/// Solves frames for a fitted geometry, one after the other; owns its memory, so that a recording of any
/// length streams through.
class ChainSolver {
 public:
  explicit ChainSolver(const ChainFit& fit);
  ~ChainSolver();
  ChainSolver(ChainSolver&&) noexcept;
  ChainSolver& operator=(ChainSolver&&) noexcept;
  ChainSolver(const ChainSolver&) = delete;
  ChainSolver& operator=(const ChainSolver&) = delete;

  /// One frame, K x 3. `warm`: the pose of the frame before, or null. Every start is tried unless the frame
  /// follows `warm` with a cost below its chi-square and some segment next to every joint shows three
  /// markers.
  void solve(const double* x, const ChainPose* warm, ChainFrame& out);
  /// The frame's minimum next to `start` with joints known beforehand; pose, centre, covariance and
  /// information (both without the priors) in `out`, state left as `bridged`. Returns the cost without the
  /// priors' part, m^2.
  double solve_near(const double* x, const ChainPose& start, std::span<const JointPrior> priors,
                    ChainFrame& out);
  /// Rotations of all segments that fit best for joints at these places: a start for solve_near().
  void pose_from_centres(const double* x, std::span<const Vector3d> centres, ChainPose& out);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace kinemark::skeleton
