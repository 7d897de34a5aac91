// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/rival_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/internal/profile_errors.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLessKnown = 2.0;     // times the variance with all markers: the limb lost what held it
constexpr double kOpen = 0.25;         // rad^2 or m^2: beyond it a coordinate is not determined anyway
constexpr double kParallel = 0.95;     // correlation of two directions that lead to the same rivals
constexpr int kDirections = 8;         // of one frame
constexpr std::array kWays{0.6, 1.4};  // rad or m along each, both ways
constexpr double kFarthest = 2.6;      // rad or m, of any coordinate
constexpr double kDiffers = 0.06;      // rad or m, and ...
constexpr double kDiffersInSd = 3.0;   // ... so many deviations: another pose
constexpr double kWorse = 36.0;        // chi-square by which a rival may fit worse
constexpr double kTemper = 0.25;       // of a chi-square in nats: markers' errors last for many frames
constexpr std::size_t kMostRivals = 8;
constexpr int kRoundsOfRivals = 2;
constexpr double kSearchEvery_s = 0.05;  // between searches rivals are followed
constexpr double kSearchAlike_s = 0.2;   // while the same markers are seen
constexpr double kNearInSteps = 4.0;     // so near a start leads to the same pose
constexpr double kStepShare = 0.9;       // quantile of the steps of a speed
constexpr double kLeastStep = 2e-3;      // rad or m
constexpr double kDoubt = 2e-3;          // probability of rivals from which on a coordinate is not determined
constexpr double kLeastProbability = 1e-9;
constexpr double kAlongOpen =
    0.3;  // rad or m of something open between two poses: both lie on one valley, and ...
constexpr double kAnywhere =
    0.05;                        // ... nothing says where on it the body is: the least share of such a rival
constexpr double kAsGood = 9.0;  // chi-square by which it may fit worse

/// A pose of one frame with what its markers say of it.
struct Candidate {
  VectorXd state, variance;  // variance: nv, rad^2 or m^2
  double chi_square = 0.0;
  double log_forward = 0.0, log_backward = 0.0;
  double probability = 1.0;
};

class Rivals {
 public:
  Rivals(const Problem& problem, const IkOptions& options, const data::Trajectories& markers,
         const LooseFrames& loose, const MarkerVariances& variances, const SolvedFrames& solved)
      : problem_(problem),
        markers_(markers),
        loose_(loose),
        pattern_(loose.pattern),
        solved_(solved),
        solver_(problem, options),
        covariance_(problem),
        w_(problem.model),
        y_(3, problem.model.marker_count()),
        weight_(problem.model.marker_count()),
        information_(problem.model.marker_count()),
        all_(information_of(problem.model, variances)),
        of_frame_(at(problem.frames)) {
    const auto frames_in = [&](double time_s) {
      return std::max<std::int64_t>(1, std::llround(std::min(time_s * markers.time.rate_hz, 1e6)));
    };
    every_ = frames_in(kSearchEvery_s);
    alike_ = frames_in(kSearchAlike_s);
    find_steps();
  }

  /// Look again only at stretches of loose frames that hold one of these (F).
  void keep_stretches(const std::vector<std::uint8_t>& with) {
    for (std::int64_t f = 0; f < problem_.frames; ++f) {
      std::int64_t end = f;
      bool holds = false;
      for (; is_loose(end); ++end) holds = holds || with[at(end)] != 0;
      if (!holds) std::fill(pattern_.begin() + f, pattern_.begin() + end, -1);
      f = end;
    }
  }

  void find() {
    const std::int64_t F = problem_.frames;
    std::int64_t searched = -1, pattern = -1;
    for (std::int64_t f = 0; f < F; ++f) {
      const bool begins = !is_loose(f - 1);
      if (!is_loose(f) && begins && !is_loose(f + 1)) continue;
      visit(f);
      auto& here = of_frame_[at(f)];
      here.push_back(candidate(solved_.states.col(f)));
      if (!is_loose(f)) continue;
      if (begins) {
        searched = f - every_;
        pattern = -1;
      }
      const bool search_now = f - searched >= (pattern_[at(f)] == pattern ? alike_ : every_);
      if (search_now) find_directions(here.front());
      if (f > 0) follow(f - 1, here);
      if (!search_now) continue;
      search(here);
      searched = f;
      pattern = pattern_[at(f)];
    }
    for (std::int64_t f = F - 2; f >= 0; --f) {
      if (!is_loose(f)) continue;
      visit(f);
      follow(f + 1, of_frame_[at(f)]);
    }
    for (auto& here : of_frame_) drop_worse(here);
  }

  /// Probabilities of all candidates: markers of each frame, and how far the body would have gone.
  void weigh() {
    const std::int64_t F = problem_.frames;
    for (std::int64_t f = 0; f < F; ++f) {
      auto& here = of_frame_[at(f)];
      double best = HUGE_VAL;
      for (const Candidate& c : here) best = std::min(best, c.chi_square);
      for (Candidate& c : here) {
        c.log_forward = -kTemper * (c.chi_square - best);
        if (f > 0 && !of_frame_[at(f - 1)].empty()) c.log_forward += reach(of_frame_[at(f - 1)], c, true);
      }
      level(here, true);
    }
    for (std::int64_t f = F - 2; f >= 0; --f) {
      auto& behind = of_frame_[at(f + 1)];
      if (behind.empty()) continue;
      double best = HUGE_VAL;
      for (const Candidate& c : behind) best = std::min(best, c.chi_square);
      for (Candidate& c : of_frame_[at(f)]) c.log_backward = reach(behind, c, false, best);
      level(of_frame_[at(f)], false);
    }
    for (auto& here : of_frame_) {
      if (here.empty()) continue;
      double most = -HUGE_VAL, sum = 0.0;
      for (const Candidate& c : here) most = std::max(most, c.log_forward + c.log_backward);
      for (Candidate& c : here) sum += c.probability = std::exp(c.log_forward + c.log_backward - most);
      for (Candidate& c : here) c.probability /= sum;
    }
  }

  /// Between the two poses lies something that no marker fixes: continuity does not choose between them.
  bool on_one_valley(const Candidate& taken, const Candidate& rival) {
    if (rival.chi_square > taken.chi_square + kAsGood) return false;
    model::difference(problem_.model, taken.state, rival.state, move_);
    for (Eigen::Index i = 0; i < move_.size(); ++i)
      if (!problem_.fixed_speed[at(i)] && taken.variance[i] > kOpen && std::abs(move_[i]) > kAlongOpen)
        return true;
    return false;
  }

  [[nodiscard]] std::vector<Candidate>& of(std::int64_t f) { return of_frame_[at(f)]; }

 private:
  [[nodiscard]] bool is_loose(std::int64_t f) const {
    return f >= 0 && f < problem_.frames && pattern_[at(f)] >= 0;
  }

  /// How far each speed goes in a frame.
  void find_steps() {
    const auto& model = problem_.model;
    const std::int64_t F = problem_.frames, stride = std::max<std::int64_t>(1, F / 400);
    VectorXd move(model.speed_count());
    std::vector<std::vector<double>> steps(at(model.speed_count()));
    for (std::int64_t f = 0; f + 1 < F; f += stride) {
      model::difference(model, solved_.states.col(f), solved_.states.col(f + 1), move);
      for (Eigen::Index i = 0; i < move.size(); ++i) steps[at(i)].push_back(std::abs(move[i]));
    }
    step_.setConstant(model.speed_count(), kLeastStep);
    for (Eigen::Index i = 0; i < step_.size(); ++i)
      if (!steps[at(i)].empty()) step_[i] = std::max(kLeastStep, math::quantile(steps[at(i)], kStepShare));
  }

  void visit(std::int64_t f) {
    frame_ = f;
    problem_.observe(markers_, f, y_, weight_);
    for (Eigen::Index m = 0; m < weight_.size(); ++m) information_[m] = weight_[m] > 0.0 ? all_[m] : 0.0;
  }

  Candidate candidate(const VectorXd& state) {
    Candidate c{.state = state, .variance = {}};
    model::kinematics(problem_.model, w_, state);
    covariance_.factor(w_, information_);
    covariance_.invert(K_);
    c.variance = K_.diagonal();
    for (Eigen::Index m = 0; m < weight_.size(); ++m)
      if (information_[m] > 0.0)
        c.chi_square += information_[m] * (y_.col(m) - w_.marker.col(m)).squaredNorm();
    return c;
  }

  /// Ways along which the body may go where the markers of this frame fix a speed less well than all would;
  /// K_ is that of `now`.
  void find_directions(const Candidate& now) {
    model::kinematics(problem_.model, w_, now.state);
    covariance_.factor(w_, all_);
    covariance_.invert(whole_);
    const auto& at_loose = loose_.speeds[at(pattern_[at(frame_)])];
    std::vector<std::pair<double, Eigen::Index>> found;
    for (Eigen::Index i = 0; i < now.variance.size(); ++i) {
      const double ratio = now.variance[i] / whole_(i, i);
      if (at_loose[at(i)] != 0 && ratio > kLessKnown) found.emplace_back(-ratio, i);
    }
    std::ranges::sort(found);
    std::vector<Eigen::Index> out;
    for (const auto& [ratio, i] : found) {
      const bool parallel = std::ranges::any_of(out, [&](Eigen::Index k) {
        return std::abs(K_(i, k)) > kParallel * std::sqrt(K_(i, i) * K_(k, k));
      });
      if (!parallel) out.push_back(i);
      if (std::ssize(out) == kDirections) break;
    }
    directions_.clear();
    for (const auto i : out) {
      VectorXd v = K_.col(i) / K_(i, i);
      const double longest = v.cwiseAbs().maxCoeff();
      if (longest > 2.0) v *= 2.0 / longest;
      directions_.push_back(std::move(v));
    }
  }

  /// The poses of the frame beside, solved in this one.
  void follow(std::int64_t beside, std::vector<Candidate>& here) {
    const auto& there = of_frame_[at(beside)];
    for (std::size_t k = 0; k < std::min(there.size(), kMostRivals); ++k)
      if (!near_one_of(there[k].state, here)) take(there[k].state, here);
  }

  /// A start from which one of these poses would be found again: it is near, and no other pose however
  /// far the recording's steps go: those of limbs that are badly held leap.
  bool near_one_of(const VectorXd& start, const std::vector<Candidate>& here) {
    return std::ranges::any_of(here, [&](const Candidate& c) {
      model::difference(problem_.model, start, c.state, move_);
      return (move_.array().abs() < (kNearInSteps * step_.array()).min(0.5 * kDiffers)).all();
    });
  }

  /// Poses on the ways along which the markers that are missing held the body.
  void search(std::vector<Candidate>& here) {
    const VectorXd begin = here.front().state;
    for (const VectorXd& direction : directions_)
      for (const double way : kWays)
        for (const double sign : {-1.0, 1.0}) {
          if (here.size() >= kMostRivals) return;
          move_ = sign * way * direction;
          const double longest = move_.cwiseAbs().maxCoeff();
          if (longest > kFarthest) continue;
          start_ = begin;
          model::integrate(problem_.model, start_, move_);
          for (const auto& c : problem_.model.coordinates())
            if (c.speed_idx >= 0)
              start_[c.state_idx] =
                  std::clamp(start_[c.state_idx], problem_.lower[c.speed_idx], problem_.upper[c.speed_idx]);
          take(start_, here);
        }
  }

  /// Solve from a pose and keep what is found where it is another pose and fits about as well.
  void take(const VectorXd& from, std::vector<Candidate>& here) {
    if (here.size() >= kMostRivals) return;
    x_ = from;
    const auto outcome = solver_.solve(y_, weight_, frame_, x_);
    if (!outcome.converged || !x_.allFinite()) return;
    double chi_square = 0.0;
    solver_.square_cost(y_, weight_, frame_, x_);
    for (Eigen::Index m = 0; m < weight_.size(); ++m)
      if (information_[m] > 0.0) chi_square += information_[m] * solver_.residual().col(m).squaredNorm();
    double best = HUGE_VAL;
    for (const Candidate& c : here) best = std::min(best, c.chi_square);
    if (chi_square > best + kWorse) return;
    Candidate c = candidate(x_);
    for (const Candidate& other : here)
      if (!differ(other, c)) return;
    here.push_back(std::move(c));
  }

  /// Another pose in something that one of them fixes.
  bool differ(const Candidate& a, const Candidate& b) {
    model::difference(problem_.model, a.state, b.state, move_);
    for (Eigen::Index i = 0; i < move_.size(); ++i) {
      if (problem_.fixed_speed[at(i)] || std::min(a.variance[i], b.variance[i]) > kOpen) continue;
      const double sd = std::sqrt(std::min(a.variance[i], b.variance[i]));
      if (std::abs(move_[i]) > std::max(kDiffers, kDiffersInSd * sd)) return true;
    }
    return false;
  }

  static void drop_worse(std::vector<Candidate>& here) {
    double best = HUGE_VAL;
    for (const Candidate& c : here) best = std::min(best, c.chi_square);
    // The pose that was taken stays first while it is any good.
    std::erase_if(here, [&](const Candidate& c) { return c.chi_square > best + kWorse; });
  }

  /// Log of the sum over the candidates beside of their weight and of the way from or to them.
  double reach(const std::vector<Candidate>& beside, const Candidate& c, bool forward, double best = 0.0) {
    double most = -HUGE_VAL;
    logs_.clear();
    for (const Candidate& b : beside) {
      const double weight = forward ? b.log_forward : b.log_backward - kTemper * (b.chi_square - best);
      logs_.push_back(weight + way(b, c));
      most = std::max(most, logs_.back());
    }
    double sum = 0.0;
    for (const double l : logs_) sum += std::exp(l - most);
    return most + std::log(sum);
  }

  double way(const Candidate& a, const Candidate& b) {
    model::difference(problem_.model, a.state, b.state, move_);
    double log = 0.0;
    for (Eigen::Index i = 0; i < move_.size(); ++i) {
      if (problem_.fixed_speed[at(i)]) continue;
      const double s2 = 4.0 * step_[i] * step_[i] + a.variance[i] + b.variance[i];
      log -= std::log1p(move_[i] * move_[i] / s2);
    }
    return log;
  }

  static void level(std::vector<Candidate>& here, bool forward) {
    double most = -HUGE_VAL;
    for (const Candidate& c : here) most = std::max(most, forward ? c.log_forward : c.log_backward);
    for (Candidate& c : here) (forward ? c.log_forward : c.log_backward) -= most;
  }

  const Problem& problem_;
  const data::Trajectories& markers_;
  const LooseFrames& loose_;
  std::vector<std::int64_t> pattern_;  // of `loose`, -1 in frames that are not looked at
  const SolvedFrames& solved_;
  FrameSolver solver_;
  SpeedCovariance covariance_;
  model::Workspace w_;
  Eigen::Matrix3Xd y_;
  VectorXd weight_, information_, all_, step_, x_, start_, move_;
  MatrixXd K_, whole_;
  std::int64_t frame_ = 0, every_ = 1, alike_ = 1;
  std::vector<VectorXd> directions_;
  std::vector<std::vector<Candidate>> of_frame_;
  std::vector<double> logs_;
};

}  // namespace

std::vector<RivalPose> choose_among_rivals(const Problem& problem, const IkOptions& options,
                                           const data::Trajectories& markers, const LooseFrames& loose,
                                           const MarkerVariances& variances, FrameWalk& walk,
                                           SolvedFrames& solved, std::vector<std::uint8_t>& changed) {
  changed.assign(at(problem.frames), 0);
  std::vector<RivalPose> left;
  std::vector<std::uint8_t> again(at(problem.frames), 1);
  // A frame may have the wrong pose in two limbs, and its rivals the right one in one of them.
  for (int round = 0; round < kRoundsOfRivals; ++round) {
    Rivals rivals(problem, options, markers, loose, variances, solved);
    rivals.keep_stretches(again);
    std::ranges::fill(again, std::uint8_t{0});
    rivals.find();
    rivals.weigh();
    std::erase_if(left, [&](const RivalPose& r) { return !rivals.of(r.frame).empty(); });
    for (std::int64_t f = 0; f < problem.frames; ++f) {
      auto& here = rivals.of(f);
      if (here.empty()) continue;
      const auto best = static_cast<std::size_t>(std::ranges::max_element(here, {}, &Candidate::probability) -
                                                 here.begin());
      if (here[best].state != solved.states.col(f)) {
        changed[at(f)] = again[at(f)] = 1;
        walk.put(markers, f, here[best].state, solved);
      }
      for (std::size_t k = 0; k < here.size(); ++k) {
        if (k == best) continue;
        if (rivals.on_one_valley(here[best], here[k]))
          here[k].probability = std::max(here[k].probability, kAnywhere);
        if (here[k].probability > kLeastProbability)
          left.push_back({.frame = f, .state = std::move(here[k].state), .probability = here[k].probability});
      }
    }
    if (std::ranges::count(again, std::uint8_t{1}) == 0) break;
  }
  std::ranges::stable_sort(left, {}, &RivalPose::frame);
  return left;
}

void doubt_rivals(const Problem& problem, const std::vector<RivalPose>& rivals, data::JointMotion& motion) {
  const int n = problem.model.coordinate_count();
  VectorXd taken(n), rival(n), doubt(n);
  for (std::size_t r = 0; r < rivals.size();) {
    const std::int64_t f = rivals[r].frame;
    taken = Eigen::Map<const VectorXd>(motion.q.data() + motion.index(f, 0), n);
    doubt.setZero();
    for (; r < rivals.size() && rivals[r].frame == f; ++r) {
      model::coordinates_from_state(problem.model, rivals[r].state, taken, rival);
      for (int c = 0; c < n; ++c) {
        const auto i = motion.index(f, c);
        if (motion.determined[i] == 0 || !(motion.q_sd[i] > 0.0)) continue;
        const double apart = std::abs(rival[c] - taken[c]);
        if (apart > std::max(0.5 * kDiffers, 2.0 * motion.q_sd[i])) doubt[c] += rivals[r].probability;
        motion.q_sd[i] = std::hypot(motion.q_sd[i], std::sqrt(rivals[r].probability) * apart);
      }
    }
    for (int c = 0; c < n; ++c) {
      if (!(doubt[c] > kDoubt)) continue;
      const auto i = motion.index(f, c);
      motion.determined[i] = 0;
      motion.q_sd[i] = std::numeric_limits<double>::quiet_NaN();
    }
  }
}

}  // namespace kinemark::motion::internal
