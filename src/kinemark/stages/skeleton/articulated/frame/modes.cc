// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/articulated/frame/modes.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "kinemark/stages/skeleton/articulated/chain/small_cholesky.h"

namespace kinemark::skeleton::articulated {
namespace {

constexpr double kSame = 2e-5;  // m: joints nearer than this (and a fifth of the noise) are one minimum
constexpr double kLeastRise = 0.35;
constexpr double kMostRise = 2.5;
constexpr int kReflected = 6;          // minima that are mirrored joint by joint
constexpr double kHopeless = 40.0;     // chi-square above the best
constexpr double kHold = 1e3;          // weight of the direction that is held, in markers
constexpr double kFarthestSd = 0.3;    // m
constexpr int kScan = 6;               // SD to either side
constexpr double kOpenEnds = 1e-3;     // weight of the scan's ends: the profile goes on beyond them
constexpr double kLeastScanned = 0.3;  // of the Gaussian's variance: below, steps of one SD are too coarse

double distance(const ChainMode& a, const ChainMode& b) {
  double most = 0.0;
  for (std::size_t j = 0; j < a.centre.size(); ++j) most = std::max(most, (a.centre[j] - b.centre[j]).norm());
  return most;
}

}  // namespace

void FrameInformation::set(const Chain& chain, const Eigen::MatrixXd& H, double tolerance) {
  const Eigen::Index n = H.rows();
  scale_.resize(n);
  scale_.head(3).setOnes();
  scale_.tail(n - 3).setConstant(1.0 / chain.scale());
  factor_ = scale_.asDiagonal() * H * scale_.asDiagonal();
  const double largest = factor_.diagonal().maxCoeff();
  scaled_ = factor_;
  open_.resize(n, 0);
  rank_ = static_cast<int>(n);
  // Pivots far above the tolerance: full rank without looking at eigenvalues.
  if (cholesky(factor_, 1e-4 * largest)) {
    inverse_.setIdentity(n, n);
    for (Eigen::Index c = 0; c < n; ++c) solve_cholesky(factor_, inverse_.col(c));
    inverse_ = (scale_.asDiagonal() * inverse_ * scale_.asDiagonal()).eval();
    return;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled_);
  const double floor = tolerance * std::max(eigen.eigenvalues()[n - 1], 1e-300);
  Eigen::Index open = 0;
  while (open < n && !(eigen.eigenvalues()[open] > floor)) ++open;
  rank_ = static_cast<int>(n - open);
  open_ = scale_.asDiagonal() * eigen.eigenvectors().leftCols(open);
  const Eigen::MatrixXd held = scale_.asDiagonal() * eigen.eigenvectors().rightCols(n - open);
  inverse_ = held * eigen.eigenvalues().tail(n - open).cwiseInverse().asDiagonal() * held.transpose();
}

bool FrameInformation::holds(const Eigen::Matrix3Xd& by_frame) const {
  for (Eigen::Index c = 0; c < open_.cols(); ++c) {
    if ((by_frame * open_.col(c)).cwiseAbs().maxCoeff() > 1e-4) return false;
  }
  return true;
}

Matrix3d FrameInformation::joint_information(const Eigen::Matrix3Xd& by_frame) const {
  Matrix3d covariance = by_frame * inverse_ * by_frame.transpose();
  if (open_.cols() > 0) {
    // Directions left open get a variance far above any that is determined; the information that remains of
    // them is set to zero below.
    const Eigen::Matrix3Xd loose = by_frame * open_;
    covariance += 1e9 * loose * loose.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(covariance);
  Vector3d information = eigen.eigenvalues().cwiseMax(1e-12).cwiseInverse();
  for (int i = 0; i < 3; ++i) {
    if (information[i] < 1e-6) information[i] = 0.0;
  }
  return eigen.eigenvectors() * information.asDiagonal() * eigen.eigenvectors().transpose();
}

double FrameInformation::log_det(const Chain& chain, const Eigen::MatrixXd& H, double sigma_m,
                                 Eigen::MatrixXd& scratch) {
  const double by_variance = 1.0 / (sigma_m * sigma_m);
  scratch = by_variance * H;
  for (int i = 3; i < chain.frame_parameters(); ++i) {
    scratch(i, i) += 1.0 / (std::numbers::pi * std::numbers::pi);
  }
  for (int i = 0; i < 3; ++i) scratch(i, i) *= 1.0 + 1e-12;
  if (!cholesky(scratch)) return std::numeric_limits<double>::infinity();
  return 2.0 * scratch.diagonal().array().log().sum();
}

ModeFinder::ModeFinder(const Chain& chain) : starts_(chain) {}

void ModeFinder::refine(PoseSolver& solver, const ChainPose& start, double same_m, int iterations,
                        std::vector<ChainMode>& modes) {
  const Chain& chain = solver.chain();
  if (count_ == static_cast<int>(modes.size())) modes.emplace_back();
  ChainMode& mode = modes[count_];
  mode.pose.joint0 = start.joint0;
  mode.pose.rotation = start.rotation;
  mode.cost = solver.refine(mode.pose, {}, iterations);
  mode.centre.resize(chain.joints());
  for (int j = 0; j < chain.joints(); ++j) mode.centre[j] = chain.joint_centre(mode.pose, j);
  for (int other = 0; other < count_; ++other) {
    if (distance(mode, modes[other]) >= same_m) continue;
    if (mode.cost < modes[other].cost) std::swap(modes[other], modes[count_]);
    return;
  }
  ++count_;
}

// In longer chains a joint may be mirrored at the plane of what is seen and known around it while the others
// stay: starts from every minimum found, the new ones included.
void ModeFinder::reflect(PoseSolver& solver, const double* x, double sigma_m, double same_m, int iterations,
                         std::vector<ChainMode>& modes) {
  const Chain& c = solver.chain();
  double best = modes[0].cost;
  for (int i = 1; i < count_; ++i) best = std::min(best, modes[i].cost);
  for (int i = 0; i < count_ && i < kReflected; ++i) {
    if (modes[i].cost > best + kHopeless * sigma_m * sigma_m) continue;
    for (int j = 0; j < c.joints(); ++j) {
      const int parent = c.layout.parent[j];
      const int child = j + 1;
      if (std::max(solver.sums().segment[parent].seen, solver.sums().segment[child].seen) >= 3) continue;
      about_.clear();
      for (int k = 0; k < c.markers(); ++k) {
        const int s = c.layout.segment_of_marker[k];
        if ((s == parent || s == child) && !std::isnan(x[3 * k])) {
          about_.emplace_back(Eigen::Map<const Vector3d>(x + 3 * k));
        }
      }
      for (int other = 0; other < c.joints(); ++other) {
        if (other == j) continue;
        const int p = c.layout.parent[other];
        if (p == parent || p == child || other + 1 == parent) about_.push_back(modes[i].centre[other]);
      }
      if (about_.size() < 3) continue;
      Vector3d mean = Vector3d::Zero();
      for (const Vector3d& y : about_) mean += y / static_cast<double>(about_.size());
      Matrix3d scatter = Matrix3d::Zero();
      for (const Vector3d& y : about_) scatter += (y - mean) * (y - mean).transpose();
      const Vector3d normal = Eigen::SelfAdjointEigenSolver<Matrix3d>(scatter).eigenvectors().col(0);
      centres_ = modes[i].centre;
      centres_[j] -= 2.0 * normal.dot(centres_[j] - mean) * normal;
      starts_.from_centres(solver, centres_, mirrored_);
      refine(solver, mirrored_, same_m, iterations, modes);
    }
  }
}

int ModeFinder::find(PoseSolver& solver, const double* x, double sigma_m, const ChainPose* extra,
                     int iterations, std::vector<ChainMode>& modes) {
  count_ = 0;
  const double same_m = 0.2 * sigma_m + kSame;
  starts_.find(solver, x, sigma_m);
  if (extra != nullptr) refine(solver, *extra, same_m, iterations, modes);
  for (const ChainPose& start : starts_.poses()) refine(solver, start, same_m, iterations, modes);
  if (count_ == 0) return 0;
  if (solver.chain().joints() > 1) reflect(solver, x, sigma_m, same_m, iterations, modes);
  std::sort(modes.begin(), modes.begin() + count_,
            [](const ChainMode& a, const ChainMode& b) { return a.cost < b.cost; });
  if (count_ == 1) {
    modes[0].weight = 1.0;
    return 1;
  }
  log_weight_.resize(count_);
  for (int i = 0; i < count_; ++i) {
    solver.normal(modes[i].pose, {}, false, H_, b_);
    log_weight_[i] = -0.5 * (modes[i].cost - modes[0].cost) / (sigma_m * sigma_m) -
                     0.5 * FrameInformation::log_det(solver.chain(), H_, sigma_m, scratch_);
  }
  const double top = *std::max_element(log_weight_.begin(), log_weight_.end());
  double sum = 0.0;
  for (int i = 0; i < count_; ++i) sum += modes[i].weight = std::exp(log_weight_[i] - top);
  for (int i = 0; i < count_; ++i) modes[i].weight /= sum;
  return count_;
}

bool ModeFinder::confirm(PoseSolver& solver, double sigma_m, int iterations, ChainPose& pose, double& cost) {
  again_ = starts_.find_rigid(solver);
  const double other = solver.refine(again_, {}, iterations);
  const double same_m = 0.2 * sigma_m + kSame;
  for (int j = 0; j < solver.chain().joints(); ++j)
    if (!((solver.chain().joint_centre(pose, j) - solver.chain().joint_centre(again_, j)).norm() < same_m))
      return false;
  if (other < cost) {
    pose = again_;
    cost = other;
  }
  return true;
}

namespace {

// A joint held at positions along the weakest direction of its covariance, all else refitted.
class Profile {
 public:
  Profile(PoseSolver& solver, const ChainPose& best, double cost, int joint, const Matrix3d& covariance,
          double sigma_m)
      : solver_(solver), best_(best), cost_(cost), joint_(joint), sigma_m_(sigma_m) {
    const Eigen::SelfAdjointEigenSolver<Matrix3d> eigen(covariance);
    weakest_ = eigen.eigenvectors().col(2);
    sd_m_ = std::min(std::sqrt(std::max(eigen.eigenvalues()[2], 0.0)), kFarthestSd);
    centre_ = solver.chain().joint_centre(best, joint);
  }
  [[nodiscard]] const Vector3d& weakest() const { return weakest_; }
  [[nodiscard]] double sd_m() const { return sd_m_; }

  // Chi-square above the best at z SD.
  [[nodiscard]] double rise(double z) {
    const Vector3d off = z * sd_m_ * weakest_;
    const JointPrior hold{joint_, centre_ + off, kHold * weakest_ * weakest_.transpose()};
    pose_.joint0 = best_.joint0 + off;
    pose_.rotation = best_.rotation;
    const double held = solver_.refine(pose_, {&hold, 1}, 25, 1e-7);
    return (held - cost_) / (sigma_m_ * sigma_m_);
  }

 private:
  PoseSolver& solver_;
  const ChainPose& best_;
  double cost_;
  int joint_;
  double sigma_m_, sd_m_ = 0.0;
  Vector3d weakest_, centre_;
  ChainPose pose_;
};

}  // namespace

bool profile_is_gaussian(PoseSolver& solver, const ChainPose& best, double cost, int joint,
                         const Matrix3d& covariance, double sigma_m) {
  Profile profile(solver, best, cost, joint, covariance, sigma_m);
  for (const double z : {4.0, 2.0}) {
    for (const double side : {1.0, -1.0}) {
      const double rise = profile.rise(side * z) / (z * z);
      if (!(rise > kLeastRise && rise < kMostRise)) return false;
    }
  }
  return true;
}

std::optional<ProfileMoments> profile_moments(PoseSolver& solver, const ChainPose& best, double cost,
                                              int joint, const Matrix3d& covariance, double sigma_m) {
  Profile profile(solver, best, cost, joint, covariance, sigma_m);
  double sum = 0.0, first = 0.0, second = 0.0, ends = 0.0;
  for (int z = -kScan; z <= kScan; ++z) {
    const double rise = z == 0 ? 0.0 : profile.rise(z);
    if (rise < -1.0) return std::nullopt;  // another minimum, and a better one
    const double weight = std::exp(-0.5 * rise);
    sum += weight;
    first += weight * z;
    second += weight * z * z;
    if (std::abs(z) == kScan) ends += weight;
  }
  const double mean = first / sum;
  const double variance = second / sum - mean * mean;
  if (ends > kOpenEnds * sum || variance < kLeastScanned) return std::nullopt;
  const Vector3d& u = profile.weakest();
  return ProfileMoments{.shift = mean * profile.sd_m() * u,
                        .more = (variance - 1.0) * profile.sd_m() * profile.sd_m() * u * u.transpose(),
                        .variance_ratio = variance};
}

}  // namespace kinemark::skeleton::articulated
