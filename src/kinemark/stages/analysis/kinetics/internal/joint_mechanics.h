// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What acts at the joints of a definition in one version of a recording.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "kinemark/stages/analysis/kinetics/chain_dynamics.h"
#include "kinemark/stages/analysis/kinetics/floor_loads.h"
#include "kinemark/stages/analysis/kinetics/joint_loads.h"
#include "kinemark/stages/analysis/segments/formula_tracks.h"

namespace kinemark::analysis::internal {

/// Formulas of bodies and joints as outputs of one graph.
class LoadOutputs {
 public:
  explicit LoadOutputs(const SegmentDefinition& definition);
  LoadOutputs(const LoadOutputs&) = delete;
  LoadOutputs& operator=(const LoadOutputs&) = delete;

  /// First outputs of a body: gyration has three, floor as many as the body has points.
  struct OfBody {
    std::size_t mass, centre, axes, gyration, floor;
  };
  /// Outputs of a joint, one behind the other.
  struct OfJoint {
    std::size_t centre, child, parent, per;
  };
  std::vector<GraphOutput> list;  ///< all of them
  std::vector<OfBody> bodies;     ///< as the definition has them
  std::vector<OfJoint> joints;    ///< as the definition has them

 private:
  std::size_t add(const Formula& formula, StepType type, const std::string& what);
  void add_body(const SegmentDefinition::Body& b, const Formula& axes);
  void add_joint(const SegmentDefinition::Joint& j, const Formula& child, const Formula& parent);

  std::vector<Formula> frames_;  // names of segments; outputs point to them
};

/// Outputs of all frames.
using FrameValues = std::vector<std::vector<StepValue>>;

/// One version of the recording as its joints see it.
class JointMechanics {
 public:
  /// All must outlive this.
  JointMechanics(const SegmentDefinition& definition, const FormulaTracks& tracks, const LoadOutputs& outputs,
                 const JointLoadOptions& options);

  [[nodiscard]] bool has_foot(std::size_t body) const { return foot_[body]; }      ///< points of the floor
  [[nodiscard]] bool has_joint(std::size_t joint) const { return joint_[joint]; }  ///< can be computed
  [[nodiscard]] std::size_t index_of_body(const std::string& name) const;          ///< that exists

  [[nodiscard]] FrameValues values_of(const data::Trajectories& markers) const;  ///< all outputs
  /// Points of a body that touch the floor.
  [[nodiscard]] FootTrack foot_of(std::size_t body, const FrameValues& values) const;
  /// Force, moment and power of a joint on the segment beyond it, over the mass: F x 7.
  /// @param floor  loads of the bodies; null: none
  [[nodiscard]] Eigen::MatrixXd loads_of(std::size_t joint, const FrameValues& values,
                                         const std::vector<const WrenchTrack*>& floor, double rate_hz) const;
  /// The mass by which what a joint bears is divided, kg.
  [[nodiscard]] double per(std::size_t joint, const FrameValues& values) const;

 private:
  [[nodiscard]] BodyTrack track_of(std::size_t body, const FrameValues& values) const;

  const SegmentDefinition& d_;
  const FormulaTracks& tracks_;
  const LoadOutputs& outputs_;
  const JointLoadOptions& options_;
  std::vector<bool> body_, foot_, joint_;
};

}  // namespace kinemark::analysis::internal
