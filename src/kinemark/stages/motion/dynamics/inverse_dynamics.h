// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Inverse dynamics of a tracked motion: the generalised force of every coordinate, with its standard
// deviation. Theory: docs/theory/inverse-dynamics.md
#pragma once

#include <string>
#include <vector>

#include "kinemark/core/result.h"
#include "kinemark/data/joint_motion.h"
#include "kinemark/data/wrenches.h"
#include "kinemark/model/model.h"
#include "kinemark/stages/motion/smoother/rates.h"

namespace kinemark::motion {

/// Options of inverse dynamics.
struct DynamicsOptions {
  bool error_bars = true;         ///< compute tau_sd
  double contact_force_n = 20.0;  ///< a plate with less force on it is empty, and its data are left out
  std::vector<std::string> feet;  ///< bodies that plates may touch; empty: those whose names contain "calcn"
                                  ///< or "foot", or else all
  int threads = 1;                ///< for the error bars; 0: all cores. Any number gives the same bits.

  [[nodiscard]] Status check() const;  ///< Ranges hold and no number is NaN.
};

/// Residual force and moment at a free root: the ground reaction where there are no force plates, else the
/// disagreement of model, motion and plates.
struct RootResidual {
  std::string body;                                 ///< the body at the root
  double force_rms_n = 0.0, force_max_n = 0.0;      ///< what no plate explains, over the frames
  double moment_rms_nm = 0.0, moment_max_nm = 0.0;  ///< about the origin of the root joint
};

/// One contact of a plate with a body.
struct Contact {
  std::string wrench, body;                      ///< name of the plate, and of the body it acts on
  std::int64_t first_frame = 0, last_frame = 0;  ///< both ends included
};

/// A stretch of frames in which a foot bears load that no wrench explains: one that stands beside the plates
/// or on their edge. The torques of its limb are not determined there.
struct UnmeasuredContact {
  std::string body;                              ///< the foot, as the model names it
  std::int64_t first_frame = 0, last_frame = 0;  ///< both ends included
  double force_max_n = 0.0;                      ///< largest unexplained force upwards
};

/// What inverse dynamics says besides the torques.
struct DynamicsSummary {
  std::vector<RootResidual> roots;            ///< one a free root
  std::vector<Contact> contacts;              ///< by wrench and time
  std::vector<UnmeasuredContact> unmeasured;  ///< by foot and time; empty without wrenches
  Eigen::Vector3d feet_to_centre =
      Eigen::Vector3d::Zero();   ///< m, mean over frames, from the feet to the mass centre; 0 where no body's
                                 ///< name says foot
  double body_weight_n = 0.0;    ///< mass of the model times gravity
  bool rates_estimated = false;  ///< qd and qdd were absent and were filled by estimate_rates()
  std::vector<std::string> warnings;  ///< one sentence each
};

/// Fill tau (and tau_sd) of a motion: tau = M q'' + b + g - sum J'f in the speeds of the tree, converted to
/// the file's coordinates so that tau . dq/dt is power (coordinates of a free root: the residual force along
/// the
/// axis of each). Locked coordinates get the force that holds them; coupled coordinates and those that drive
/// nothing NaN; frames in which a wrench is unknown NaN. With wrenches, a foot that bears load without one is
/// found from the residual of its root, and the torques between it and the root are NaN in those frames; the
/// residual itself stays.
///
/// qd and qdd come from the motion; where they are empty estimate_rates() fills them. tau_sd is first order:
/// the covariance of q, qd and qdd (`errors`, or estimate_rates() again) through the derivatives of tau;
/// errors of different coordinates are taken as independent, those of masses, model and wrenches are not in
/// it. Where q_sd is present it is used for q. Fails for closed loops (their inner forces do not follow from
/// the motion), for a massless model and for wrenches whose frames are not the motion's. About 10 us per
/// frame, 0.6 ms with error bars (whole body).
[[nodiscard]] Result<DynamicsSummary> inverse_dynamics(const model::Model& model, data::JointMotion& motion,
                                                       const DynamicsOptions& options = {},
                                                       const data::Wrenches* wrenches = nullptr,
                                                       const RateErrors* errors = nullptr);

}  // namespace kinemark::motion
