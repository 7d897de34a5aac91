// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What several measures of one path need, computed once.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "kinemark/stages/analysis/path/harmonics.h"
#include "kinemark/stages/analysis/path/path_samples.h"
#include "kinemark/stages/analysis/path/shape.h"
#include "kinemark/stages/analysis/path/smoothness.h"
#include "kinemark/stages/analysis/path/timing.h"
#include "kinemark/stages/analysis/path/turning.h"

namespace kinemark::analysis {

/// What is settled once for a stretch and holds for all smoothed and simulated versions of it.
struct PathFrame {
  double start_s = 0.0;   ///< of the stretch, on the recording's clock
  bool periodic = false;  ///< it repeats: see recognise()
  bool discrete = false;  ///< it begins and ends at rest
  bool closed = false;    ///< periodic, and comes back to where it was: not a walk
  bool round = false;     ///< it goes around one way by 0.6 turns or more: along an ellipse, or closed
  bool whole = false;     ///< closed, or round by a whole turn or more
  bool steady = false;    ///< hardly_changes() of its speed
  Turning turning;        ///< about the centre of an ellipse
  Eigen::Vector3d cycle_axis = Eigen::Vector3d::UnitX();  ///< along which cycles are counted
  HarmonicForm harmonics;      ///< by which its dominant frequency above 0.3 Hz is found
  double share_at_rest = 0.0;  ///< of the samples slower than kMovingShare of the peak speed
};

/// Frequencies that measures of bands need.
inline constexpr double kLowHz = 12.0;

/// The middle nine tenths of the values lie within a tenth of their median.
[[nodiscard]] bool hardly_changes(const Eigen::VectorXd& values);

/// Find out what kind of movement a smooth path is. Discrete: it rests for kMovingHold_s at least at both
/// ends. Periodic: not discrete, at least two cycles along its main axis, whose standard deviation is below a
/// quarter of their mean, and a velocity that is like itself after one of them (kPeriodicLikeness). Closed:
/// its straight trend moves it in a cycle by less than a quarter of its extent. Round: it turns about the
/// centre of the ellipse fitted to it by 0.6 turns or more, 95 % of all turning one way, and lies within 2 %
/// of it or is closed.
[[nodiscard]] PathFrame recognise(const PathSamples& path);

/// A path of which others are variants: what is known of it spares work on them, and changes no value.
class NearPath {
 public:
  /// @param x  n x 3, must outlive it
  explicit NearPath(const PathMatrix& x) : x_(x) {}
  [[nodiscard]] const PathMatrix& x() const { return x_; }  ///< n x 3, m
  [[nodiscard]] const OuterSamples& outer() const;          ///< found when it is first asked for

 private:
  const PathMatrix& x_;
  mutable std::optional<OuterSamples> outer_;
};

/// Values that measures share, each computed when it is first asked for. Not for several threads at once.
class PathFacts {
 public:
  /// All must outlive it. Cost: n.
  /// @param near_path  of as many samples, which these are a variant of; null: none
  PathFacts(const PathSamples& samples, const PathFrame& settled, const NearPath* near_path = nullptr);

  const PathSamples& path;  ///< the stretch
  const PathFrame& frame;   ///< what was settled
  const NearPath* near;     ///< a path that these are a variant of, or null
  Eigen::VectorXd speed;    ///< of the stretch, m/s
  MovementWindow window;    ///< onset and end, s from the first sample of the stretch

  /// Of a discrete movement the part from 50 ms before onset to 50 ms behind the end; else the stretch.
  [[nodiscard]] const PathSamples& movement() const { return part_ ? *part_ : path; }
  [[nodiscard]] const Eigen::VectorXd& moving_speed() const;  ///< of the movement, m/s
  [[nodiscard]] const PrincipalAxes& principal() const;       ///< of the stretch
  [[nodiscard]] const PathMatrix& along() const;              ///< the stretch along its principal axes, m
  [[nodiscard]] const Cycles& cycles() const;                 ///< along the settled axis
  [[nodiscard]] const EllipseAxes& ellipse()
      const;  ///< in the best-fit plane; NaN of paths not round or closed
  /// Sample, between two, where its last whole turn ends, or its last whole cycle; the last of open paths;
  /// NaN of less than a turn.
  [[nodiscard]] double whole_end() const;
  [[nodiscard]] const Diameters& distances() const;             ///< between samples
  [[nodiscard]] const CurvatureTerms& curvature_terms() const;  ///< for curvature and torsion
  [[nodiscard]] const Eigen::Vector3d& box() const;             ///< the smallest, descending, m
  [[nodiscard]] const Periodogram& periodogram() const;         ///< of the stretch, up to kLowHz
  [[nodiscard]] const HarmonicFit& harmonics() const;           ///< of the stretch, of the settled form

 private:
  std::optional<PathSamples> part_;
  mutable std::optional<Eigen::VectorXd> moving_speed_;
  mutable std::optional<PrincipalAxes> principal_;
  mutable std::optional<PathMatrix> along_;
  mutable std::optional<Cycles> cycles_;
  mutable std::optional<EllipseAxes> ellipse_;
  mutable std::optional<Diameters> distances_;
  mutable std::optional<CurvatureTerms> curvature_terms_;
  mutable std::optional<Eigen::Vector3d> box_;
  mutable std::optional<Periodogram> periodogram_;
  mutable std::optional<HarmonicFit> harmonics_;
};

}  // namespace kinemark::analysis
