// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Direct marker control when markers vanish for half a second: what jumps.
#include <fmt/core.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "acceptance/track_subject.h"
#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/control/internal/goals.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using namespace kinemark::track_subject;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing_support::print_row;

constexpr double kMoved = 1e-3;  // m per rad: less, and a coordinate does not move a marker

/// Where the markers of the model are in one frame of a track, and how sure that is.
struct MarkerPositions {
  Eigen::Matrix3Xd x;
  VectorXd sd;  ///< m, length; NaN where an undetermined coordinate moves the marker
};

class Placing {
 public:
  explicit Placing(const model::Model& model) : model_(model), w_(model), filter_(60.0, 6.0, 0.0, 0.1) {}

  Eigen::Matrix3Xd positions(const data::JointMotion& motion, std::int64_t f) {
    const Eigen::Map<const VectorXd> q(motion.q.data() + motion.index(f, 0), motion.size());
    model::kinematics(model_, w_, model::state_from_coordinates(model_, q));
    return w_.marker;
  }

  /// Deviations from the goals that are there: 1 mm per axis that went through the filter, and what the body
  /// still lacks of the pose that fits them best. Least squares, apart from the tracker's own.
  MarkerPositions deviations(const data::JointMotion& motion, const data::Trajectories& goals,
                             std::int64_t f) {
    MarkerPositions out{.x = positions(motion, f), .sd = VectorXd::Zero(model_.marker_count())};
    MatrixXd J;
    model::marker_jacobian(model_, w_, J);
    MatrixXd seen = J;
    VectorXd miss = VectorXd::Zero(J.rows());
    for (int m = 0; m < model_.marker_count(); ++m) {
      if (goals.present(f, m))
        miss.segment<3>(3 * m) = goals.x(f, m) - out.x.col(m);
      else
        seen.middleRows(3 * m, 3).setZero();
    }
    // Singular where no marker that is seen moves a coordinate: the pseudo-inverse leaves that out.
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> normal;
    normal.setThreshold(1e-9);
    normal.compute(seen.transpose() * seen);
    const MatrixXd K = normal.pseudoInverse();
    const VectorXd lag = J * (K * (seen.transpose() * miss));
    for (int m = 0; m < model_.marker_count(); ++m) {
      const MatrixXd rows = J.middleRows(3 * m, 3);
      const double noise = 1e-6 * filter_.noise_in_goal() * (rows * K * rows.transpose()).trace();
      out.sd[m] = std::sqrt(noise + lag.segment<3>(3 * m).squaredNorm());
      for (std::int64_t c = 0; c < motion.size(); ++c) {
        const int speed = model_.coordinates()[at(c)].speed_idx;
        if (speed >= 0 && motion.determined[motion.index(f, c)] == 0 && rows.col(speed).norm() > kMoved)
          out.sd[m] = kNaN;
      }
    }
    return out;
  }

 private:
  const model::Model& model_;
  model::Workspace w_;
  motion::internal::GoalFilter filter_;
};

/// Of two independent values with these deviations.
double sd_of_difference(double a, double b) { return std::hypot(a, b); }

/// Largest jumps from frame to frame that a dropout of 0.5 s adds: beyond the deviation of a difference where
/// it is known, and in all where the coordinate is marked as not determined.
struct Jumps {
  double beyond = 0.0, all = 0.0, undetermined = 0.0;
  std::string where = "none", where_undetermined = "none";
  std::int64_t known = 0;

  void add(double jump, double sd, const std::string& position) {
    all = larger(all, jump);
    if (std::isnan(sd)) {
      if (jump > undetermined) where_undetermined = position;
      undetermined = larger(undetermined, jump);
      return;
    }
    ++known;
    if (jump - sd > beyond) where = position;
    beyond = larger(beyond, jump - sd);
  }
  [[nodiscard]] std::string text(double unit, const char* name) const {
    return fmt::format("{:.3f} {} beyond ({}), {:.2f} in all; {:.2f} where marked undetermined ({})",
                       unit * beyond, name, where, unit * all, unit * undetermined, where_undetermined);
  }
};

void dropouts(int stride) {
  constexpr std::int64_t kLost = 105, kBack = 135, kBefore = 90, kAfter = 150;  // frames
  const auto model = human();
  Placing placing(model);
  const auto s = subject(model, 1e-3, 60.0, 4.0, 1);
  const motion::TrackOptions options{.step_s = 2e-3, .threads = 0};
  const auto whole = motion::track_markers(model, s.markers, options).value();
  Jumps angle, position;
  int lost = 0;
  for (std::int64_t m = 0; m < s.markers.markers(); m += stride, ++lost) {
    auto markers = s.markers;
    for (std::int64_t f = kLost; f < kBack; ++f) markers.set_missing(f, m);
    const auto track = motion::track_markers(model, markers, options).value().motion;
    const auto goals = motion::control_goals(markers, options).value();
    MarkerPositions before = placing.deviations(track, goals, kBefore - 1);
    for (std::int64_t f = kBefore; f < kAfter; ++f) {
      for (const auto c : joints(model)) {
        const auto jump = [&](const data::JointMotion& motion) {
          return motion.q[motion.index(f, c)] - motion.q[motion.index(f - 1, c)];
        };
        const double sd = sd_of_difference(track.q_sd[track.index(f, c)], track.q_sd[track.index(f - 1, c)]);
        angle.add(std::abs(jump(track) - jump(whole.motion)), sd,
                  fmt::format("{} without {}, frame {}", track.coordinates[at(c)], markers.names[at(m)], f));
      }
      const MarkerPositions now = placing.deviations(track, goals, f);
      const Eigen::Matrix3Xd moved =
          (now.x - before.x) - (placing.positions(whole.motion, f) - placing.positions(whole.motion, f - 1));
      for (Eigen::Index k = 0; k < moved.cols(); ++k)
        position.add(moved.col(k).norm(), sd_of_difference(now.sd[k], before.sd[k]),
                     fmt::format("{} without {}, frame {}", track.markers[at(k)], markers.names[at(m)], f));
      before = now;
    }
  }
  const auto what = [&](const char* of) {
    return fmt::format("dropouts of 0.5 s, {} markers one at a time, {}", lost, of);
  };
  print_row(angle.known > 0 && kDegPerRad * angle.beyond <= 0.5, what("joints"),
            "no jump > 0.5 deg beyond its SD", angle.text(kDegPerRad, "deg"));
  print_row(position.known > 0 && 1e3 * position.beyond <= 1.0, what("markers of the model"),
            "no jump > 1 mm beyond its SD", position.text(1e3, "mm"));
}

/// accept_motion track_dropouts [STRIDE]: every STRIDE-th marker drops out.
int run_check(int argc, char** argv) {
  dropouts(argc > 1 ? std::max(1, std::atoi(argv[1])) : 1);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("track_dropouts", run_check);

}  // namespace
