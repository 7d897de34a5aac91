// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Effect of soft tissue on a geometry that was fitted as if errors were independent from frame to frame.
//
// A marker slides on its segment with the posture: per axis of the body u = sum_c b_c phi_c, phi_c the joint
// angles next to the segment, orthonormal over the recording, b_c random with variance s/K. Part of b is its
// own, part is shared by the markers of the segment. The geometry then has the covariance
//     S^-1 (sum_f G V G' + sum_ic (s_i/K) g g' + sum_bc (s_b/K) g g' + priors) S^-1,   g = sum_f phi_c G_i R,
// with G = Jp'W - Jp'W Jq H^-1 Jq'W, R world_from_body and V the remaining, independent part.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "kinemark/stages/motion/internal/error_bars.h"
#include "kinemark/stages/motion/internal/problem.h"
#include "kinemark/stages/motion/scaling/internal/schur.h"

namespace kinemark::motion::internal {

/// Fields that follow the posture, per body of the model: F x K, columns orthogonal, mean square 1; angles
/// that keep still are left out.
[[nodiscard]] std::vector<Eigen::MatrixXd> posture_fields(const Problem& problem,
                                                          const Eigen::MatrixXd& states);

/// The part of the residuals that follows the posture, and the middle matrix of the sandwich estimate.
struct TissueModel {
  bool found = false;                  ///< false: nothing follows the posture beyond chance
  double sd_m = 0.0;                   ///< per axis, of what follows the posture, over all markers
  double inflation = 1.0;              ///< how many dependent samples weigh as much as one independent one
  Eigen::VectorXd own_slow, own_fast;  ///< per marker, m^2 per axis
  Eigen::VectorXd common_slow, common_fast;  ///< per body, m^2 per axis
};

/// One pass over the recording: frames x states, markers as in the problem.
class TissuePass {
 public:
  TissuePass(const Problem& problem, const GeometryLayout& layout, const data::Trajectories& markers,
             const Eigen::MatrixXd& states, int threads);

  /// Test whether residuals follow the posture. `variances` are those of error_bars.h at these states.
  [[nodiscard]] TissueModel detect(const MarkerVariances& variances) const;

  /// Middle matrix of the sandwich estimate without priors. `inverse_S` corrects for the part absorbed by the
  /// geometry itself.
  [[nodiscard]] Eigen::MatrixXd middle(const TissueModel& model, const Eigen::MatrixXd& inverse_S) const;

 private:
  struct Sums {
    std::vector<Eigen::MatrixXd> slide, residual;
    std::vector<Eigen::VectorXd> field_visible;
    Eigen::VectorXd squares, seen;
  };
  void add_frame(const FrameEquations& frame, std::int64_t f, Sums& sums) const;
  [[nodiscard]] Sums empty_sums() const;
  [[nodiscard]] const Eigen::MatrixXd& field(Eigen::Index marker) const;
  /// sum_f G diag(v) G' with v per marker and c per body, full matrix.
  [[nodiscard]] Eigen::MatrixXd independent_part(const Eigen::VectorXd& own,
                                                 const Eigen::VectorXd& common) const;

  const Problem& problem_;
  const GeometryLayout& layout_;
  const data::Trajectories& markers_;
  const Eigen::MatrixXd& states_;
  int threads_;
  std::vector<Eigen::MatrixXd> fields_;
  Eigen::MatrixXd no_field_;
  Sums sums_;
};

}  // namespace kinemark::motion::internal
