// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/calibration/internal/bundle_problem.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "kinemark/camera/parameters.h"
#include "kinemark/camera/response.h"
#include "kinemark/math/euler.h"
#include "kinemark/math/scale_free.h"

namespace kinemark::calibration::internal {
namespace {

using data::ParameterLayout;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Vector6d = Eigen::Matrix<double, 6, 1>;

/// Squared misfit of one observation over its variance; infinity behind the camera.
double chi2(const data::Camera& camera, const Vector3d& x_in_world, const StillObservation& seen) {
  const auto response = camera::respond(camera, x_in_world);
  if (!response.in_front) return std::numeric_limits<double>::infinity();
  return math::eliminate_scale(seen.counts - camera.detector.offset_counts, response.phi)
             .residual.squaredNorm() /
         seen.variance;
}

}  // namespace

Vector3d on_grid(const GridObservations& grid, int node, const Eigen::Vector2d& shift) {
  const Eigen::Vector2d position = grid.position_m(node / grid.nodes, node % grid.nodes) + shift;
  return {position.x(), position.y(), 0.0};
}

BundleProblem::BundleProblem(data::Rig nominal, const StillPoses& tree,
                             const std::vector<GridObservations>& grids, const BundleOptions& options)
    : nominal_(std::move(nominal)), tree_(tree), grids_(grids), options_(options) {
  poses_.resize(static_cast<std::size_t>(tree.poses()));
  std::iota(poses_.begin(), poses_.end(), 0);
  tree_weight_.assign(tree.observations.size(), 1.0);
  std::size_t nodes = 0;
  for (const auto& grid : grids) nodes += grid.observations.size();
  grid_weight_.assign(nodes, 1.0);
  set_free(nominal_);
}

void BundleProblem::set_free(const data::Rig& rig) {
  const BundlePriors& p = options_.priors;
  free_.clear();
  first_column_.clear();
  for (int c = 0; c < rig.camera_count(); ++c) {
    const auto& camera = rig.cameras[static_cast<std::size_t>(c)];
    const ParameterLayout layout(camera);
    first_column_.push_back(static_cast<int>(free_.size()));
    const auto add = [&](int first, int count, double sigma) {
      for (int i = 0; i < count; ++i) free_.push_back({c, first + i, sigma});
    };
    if (c > 0) {  // the first camera fixes the world frame
      add(ParameterLayout::rotation, 3, p.rotation_rad);
      add(ParameterLayout::centre, 3, p.centre_m);
    }
    add(ParameterLayout::focal, 1, p.focal_share * camera.focal);
    add(ParameterLayout::principal, 2, p.principal_point);
    add(ParameterLayout::warp_x, layout.warp_terms, p.warp);
    add(layout.warp_y, layout.warp_terms, p.warp);
    if (options_.crosstalk) add(layout.crosstalk, 12, p.crosstalk);
    add(layout.gain, 4, p.gain);
    add(layout.offset, 4, p.offset_counts);
  }
  first_column_.push_back(static_cast<int>(free_.size()));
  sigma_.resize(static_cast<Eigen::Index>(free_.size() + 6 * grids_.size()));
  for (std::size_t k = 0; k < free_.size(); ++k) sigma_[static_cast<Eigen::Index>(k)] = free_[k].sigma;
  for (std::size_t g = 0; g < grids_.size(); ++g) {
    auto s = sigma_.segment<6>(static_cast<Eigen::Index>(free_.size() + 6 * g));
    s.head<3>().setConstant(p.grid_rotation_rad);
    s.tail<3>() << p.grid_centre_m, p.grid_centre_m, p.grid_distance_m;
  }
}

int BundleProblem::camera_columns(int camera) const {
  return first_column_[static_cast<std::size_t>(camera) + 1] -
         first_column_[static_cast<std::size_t>(camera)];
}

BundleState BundleProblem::enrich(const BundleState& state, int warp_degree) {
  BundleState out = state;
  for (auto& camera : out.rig.cameras) camera = camera::with_warp_degree(camera, warp_degree);
  for (auto& camera : nominal_.cameras) camera = camera::with_warp_degree(camera, warp_degree);
  set_free(nominal_);
  return out;
}

VectorXd BundleProblem::deviation(const BundleState& state) const {
  VectorXd out = VectorXd::Zero(sigma_.size());
  std::size_t k = 0;
  for (int c = 0; c < nominal_.camera_count(); ++c) {
    const auto at = static_cast<std::size_t>(c);
    const VectorXd step = camera::step_between(nominal_.cameras[at], state.rig.cameras[at]);
    for (; k < free_.size() && free_[k].camera == c; ++k)
      out[static_cast<Eigen::Index>(k)] = step[free_[k].index];
  }
  for (std::size_t g = 0; g < grids_.size(); ++g) {
    auto d = out.segment<6>(static_cast<Eigen::Index>(free_.size() + 6 * g));
    d.head<3>() = math::log_so3(state.cam_from_grid[g].rotation);
    d.tail<3>() = state.cam_from_grid[g].translation - Vector3d(0.0, 0.0, grids_[g].distance_m);
  }
  return out;
}

/// Calls visit(camera, observation, x_in_world, weight) for every observation that takes part; the weight by
/// reference of its index: tree observations first.
template <class Visit>
void BundleProblem::visit_observations(const BundleState& state, const Visit& visit) const {
  for (const int pose : poses_)
    for (int led = 0; led < tree_.leds(); ++led)
      for (int c = 0; c < tree_.cameras; ++c) {
        const auto index = static_cast<std::size_t>((pose * tree_.leds() + led) * tree_.cameras + c);
        if (tree_.observations[index].seen())
          visit(c, tree_.observations[index],
                state.world_from_tree[static_cast<std::size_t>(pose)] *
                    tree_.tree[static_cast<std::size_t>(led)],
                index);
      }
  std::size_t index = tree_.observations.size();
  for (std::size_t g = 0; g < grids_.size(); ++g) {
    const math::SE3 world_from_grid = state.rig.cameras[g].cam_from_world.inverse() * state.cam_from_grid[g];
    for (std::size_t node = 0; node < grids_[g].observations.size(); ++node, ++index)
      if (grids_[g].observations[node].seen())
        visit(static_cast<int>(g), grids_[g].observations[node],
              world_from_grid * on_grid(grids_[g], static_cast<int>(node), state.grid_shift[node]), index);
  }
}

double BundleProblem::cost(const BundleState& state) const {
  double sum = deviation(state).cwiseQuotient(sigma_).squaredNorm();
  for (const auto& shift : state.grid_shift) sum += (shift / options_.priors.grid_led_m).squaredNorm();
  visit_observations(state, [&](int c, const StillObservation& seen, const Vector3d& x, std::size_t index) {
    const double weight =
        index < tree_weight_.size() ? tree_weight_[index] : grid_weight_[index - tree_weight_.size()];
    sum += weight * chi2(state.rig.cameras[static_cast<std::size_t>(c)], x, seen);
  });
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

void BundleProblem::reweigh(const BundleState& state) {
  constexpr double kBound = 16.0;  // three residuals exceed it together once in 900
  visit_observations(state, [&](int c, const StillObservation& seen, const Vector3d& x, std::size_t index) {
    const double misfit = chi2(state.rig.cameras[static_cast<std::size_t>(c)], x, seen);
    double& weight =
        index < tree_weight_.size() ? tree_weight_[index] : grid_weight_[index - tree_weight_.size()];
    weight = misfit <= kBound ? 1.0 : std::sqrt(kBound / misfit);
  });
}

BundleState BundleProblem::moved(const BundleState& state, const Step& step, double share) const {
  BundleState out = state;
  std::size_t k = 0;
  for (int c = 0; c < out.rig.camera_count(); ++c) {
    auto& camera = out.rig.cameras[static_cast<std::size_t>(c)];
    VectorXd full = VectorXd::Zero(ParameterLayout(camera).count);
    for (; k < free_.size() && free_[k].camera == c; ++k)
      full[free_[k].index] = share * step.shared[static_cast<Eigen::Index>(k)];
    camera = camera::moved(camera, full);
  }
  const auto move_pose = [&](math::SE3& pose, const Vector6d& by) {
    pose.rotation = math::exp_so3(share * by.head<3>()) * pose.rotation;
    pose.translation += share * by.tail<3>();
  };
  for (std::size_t g = 0; g < grids_.size(); ++g)
    move_pose(out.cam_from_grid[g], step.shared.segment<6>(static_cast<Eigen::Index>(free_.size() + 6 * g)));
  for (std::size_t p = 0; p < poses_.size(); ++p)
    move_pose(out.world_from_tree[static_cast<std::size_t>(poses_[p])], step.poses[p]);
  for (std::size_t n = 0; n < out.grid_shift.size(); ++n) out.grid_shift[n] += share * step.nodes[n];
  return out;
}

BundleProblem::Misfit BundleProblem::misfit(const BundleState& state) const {
  std::vector<double> all;
  Misfit out;
  visit_observations(state, [&](int c, const StillObservation& seen, const Vector3d& x, std::size_t index) {
    all.push_back(chi2(state.rig.cameras[static_cast<std::size_t>(c)], x, seen));
    out.outliers += (index < tree_weight_.size() ? tree_weight_[index]
                                                 : grid_weight_[index - tree_weight_.size()]) < 1.0 / 3.0;
  });
  out.observations = static_cast<int>(all.size());
  const auto leave = std::min<std::ptrdiff_t>(
      out.outliers,
      static_cast<std::ptrdiff_t>(options_.largest_outlier_share * static_cast<double>(all.size())));
  std::ranges::nth_element(all, all.end() - std::max<std::ptrdiff_t>(leave, 1));
  const double sum = std::accumulate(all.begin(), all.end() - leave, 0.0);
  // Degrees of freedom of the priors: each takes 1 - (posterior / prior variance).
  const VectorXd variance = [&] {
    MatrixXd inverse = MatrixXd::Identity(factor_.rows(), factor_.cols());
    factor_.triangularView<Eigen::Lower>().solveInPlace(inverse);
    return VectorXd(inverse.colwise().squaredNorm());
  }();
  const double taken = static_cast<double>(sigma_.size()) - variance.cwiseQuotient(sigma_.cwiseAbs2()).sum() +
                       6.0 * static_cast<double>(poses_.size()) + node_freedom_;
  out.chi2_per_dof = sum / std::max(1.0, 3.0 * static_cast<double>(out.observations - leave) - taken);
  return out;
}

}  // namespace kinemark::calibration::internal
