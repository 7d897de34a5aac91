// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/sample_judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"

namespace kinemark::motion::internal {
namespace {

// Distances in standard deviations of a sample from what all others expect of it.
constexpr double kBound = 14.0;         // beyond it a sample is not taken: clean recordings stay below 13.1
constexpr double kBack = 6.0;           // a sample that was not taken comes back when it is nearer than that
constexpr double kLeap = 0.1;           // or by so much of its last distance: it leapt back
constexpr double kQuick = 7.0;          // a frame in which nothing moves by more needs no fit
constexpr double kRare = 1.6;           // and by so many times what the body does in one frame of sixteen
constexpr double kMostOpen = 0.25;      // rad^2 or m^2: nothing is vaguer
constexpr double kLostPose = 0.3;       // rad or m: a pose so far from the expected one followed a bad sample
constexpr double kExchanged = 0.3;      // of their distance: so near to its partner's position is in it
constexpr double kFarSkin = 2.0;        // times as far as in one frame
constexpr double kClearlyNearer = 0.8;  // of the squared distances from the model's markers
constexpr double kLongestHold_s = 1.0;  // a marker away for longer may have a new position now

}  // namespace

class FrameJudge::Impl {
 public:
  Impl(const Problem& problem, const IkOptions& options, double rate_hz, StepScale& scale)
      : problem_(problem), scale_(scale), options_(options), M_(problem.model.marker_count()), account_(M_) {
    const int n = problem.model.speed_count();
    y_.setZero(3, M_);
    for (auto* v : {&seen_, &used_, &last_}) v->setZero(M_);
    for (auto* v : {&move_, &difference_}) v->setZero(n);
    expected_.position.setZero(3, M_);
    expected_.position_sd.setZero(M_);
    expected_.bound.setZero(M_);
    open_now_.setZero(n);
    open_before_.setZero(n);
    expected_.speed_sd.setZero(n);
    world_.setZero(3, M_);
    x_ = expected_.x = problem.model.default_state();
    age_.assign(at(M_), 1);
    known_.assign(at(M_), 0);
    elsewhere_.assign(at(M_), 0);
    astray_.assign(at(M_), 0);
    hold_ = std::max<std::int64_t>(8, std::llround(kLongestHold_s * rate_hz));
  }

  /// Believe the first frame, and the step that led to it where there is one.
  void begin(const JudgedFrame& frame, const Eigen::VectorXd* before, std::int64_t direction) {
    direction_ = direction;
    since_.assign(at(M_), frame.index);
    out_.assign(at(M_), 0);
    look(frame);
    expected_.position = scale_.centre;
    expected_.position_sd = scale_.spread;
    x_ = state();
    take_over();
    whole_position_ = expected_.position;
    if (before == nullptr) return;
    model::difference(problem_.model, *before, x_, move_);
    steady_ = 2;
  }

  void judge(const JudgedFrame& frame) {
    std::ranges::fill(out_, std::uint8_t{0});
    look(frame);
    judge_frame(frame.index);
  }

  std::vector<Outlier> finish() { return account_.finish(); }
  void forget() { account_.forget(); }

  [[nodiscard]] const std::vector<std::uint8_t>& out() const { return out_; }
  [[nodiscard]] const Eigen::Matrix3Xd& expected() const { return world_; }
  [[nodiscard]] const Eigen::VectorXd& x() const { return x_; }
  [[nodiscard]] std::int64_t solves() const { return solver_ ? solver_->solves() : 0; }

 private:
  void look(const JudgedFrame& frame) {
    frame_ = &frame;
    y_ = *frame.y;
    seen_ = *frame.seen;
  }
  [[nodiscard]] Eigen::Map<const Eigen::VectorXd> state() const {
    return {frame_->state, problem_.model.state_count()};
  }
  [[nodiscard]] Eigen::Vector3d position(Eigen::Index m) const {
    return Eigen::Map<const Eigen::Vector3f>(frame_->position + 3 * m).cast<double>();
  }

  /// The same markers as in the frame before are seen, none is held back, and neither positions nor pose do
  /// anything unusual.
  bool is_quiet() {
    if (held_ > 0 || steady_ < 1) return false;
    for (Eigen::Index m = 0; m < M_; ++m) {
      if ((seen_[m] > 0.0) != (used_[m] > 0.0)) return false;
      if (seen_[m] == 0.0) continue;
      const double bound = kQuick * scale_.position[m];
      if ((position(m) - expected_.position.col(m)).squaredNorm() > bound * bound) return false;
    }
    model::difference(problem_.model, x_, state(), difference_);
    for (Eigen::Index i = 0; i < difference_.size(); ++i) {
      const double bound = steady_ < 2 ? kQuick * scale_.stride[i]
                                       : std::max(kQuick * scale_.speed[i], kRare * scale_.rare[i]);
      if (std::abs(difference_[i] - (steady_ < 2 ? 0.0 : move_[i])) > bound) return false;
    }
    return true;
  }

  void judge_frame(std::int64_t f) {
    if (!(seen_.array() > 0.0).any()) {
      remember();
      ++away_;
      for (auto& age : age_) ++age;
      steady_ = 0;
      ++blind_;
      return;
    }
    if (is_quiet()) {
      ++steady_;
      if (seen_.minCoeff() > 0.0) {
        open_now_.setZero();
        open_before_.setZero();
        away_ = 0;
      } else {
        ++away_;
        ++unfitted_;
      }
      move_ = difference_;
      x_ = state();
      for (Eigen::Index m = 0; m < M_; ++m)
        if (seen_[m] > 0.0)
          expected_.position.col(m) = position(m);
        else
          ++age_[at(m)];
      return;
    }
    if (!fit_) {
      fit_.emplace(problem_);
      solver_.emplace(problem_, options_);
    }
    remember();
    reopen();
    expect();
    if (returns()) {
      take_over();
      return;
    }
    for (Eigen::Index m = 0; m < M_; ++m)
      expected_.bound[m] = account_.lasts(m) ? std::clamp(kLeap * last_[m], kBack, kBound) : kBound;
    fit_->solve(expected_, y_, seen_);
    settle(f);
  }

  /// Keep what was known before the first frame of a disturbance.
  void remember() {
    if (away_ == 0) whole_position_ = expected_.position;
    if (held_ == 0 && blind_ == 0) {
      sound_position_ = expected_.position;
      sound_x_ = x_;
      disturbed_ = 0;
    }
    ++disturbed_;
  }

  /// All samples lie in their positions of before the disturbance by the pose that believes them all, and the
  /// body can have come to that pose meanwhile: whatever was held back is itself again.
  bool returns() {
    if ((held_ == 0 && blind_ == 0) || still_exchanged()) return false;
    for (Eigen::Index m = 0; m < M_; ++m) {
      if (seen_[m] == 0.0) continue;
      if (!known_[at(m)] || elsewhere_[at(m)]) return false;
      const double bound = kBound * scale_.position_sd_after(m, disturbed_);
      if ((position(m) - sound_position_.col(m)).squaredNorm() > bound * bound) return false;
    }
    model::difference(problem_.model, sound_x_, state(), difference_);
    for (Eigen::Index i = 0; i < difference_.size(); ++i)
      if (std::abs(difference_[i]) > kQuick * scale_.stride[i] * static_cast<double>(disturbed_))
        return false;
    return true;
  }

  /// Two markers that were exchanged still lie nearer to each other's positions than to their own. After some
  /// frames in which skin may have moved far, each would pass for the other.
  bool still_exchanged() {
    auto& w = solver_->workspace();
    bool posed = false;
    for (Eigen::Index m = 0; m < M_; ++m) {
      const int k = account_.lasts(m) ? account_.lasting(m).partner : -1;
      if (k < 0 || seen_[m] == 0.0 || seen_[k] == 0.0) continue;
      if (scale_.position_sd_after(m, disturbed_) < kFarSkin * scale_.position[m]) continue;
      if (!posed) model::kinematics(problem_.model, w, state());
      posed = true;
      const auto squares = [&](Eigen::Index at_m, Eigen::Index at_k) {
        const auto place = [&](Eigen::Index i) {
          return model::point_in_world(w, problem_.model.markers()[at(i)].body, sound_position_.col(i));
        };
        return (y_.col(m) - place(at_m)).squaredNorm() + (y_.col(k) - place(at_k)).squaredNorm();
      };
      if (squares(k, m) < squares(m, k)) return true;
    }
    return false;
  }

  /// Believe the whole frame; no speed is known behind it.
  void take_over() {
    x_ = state();
    used_ = seen_;
    move_.setZero();
    open_now_.setZero();
    open_before_.setZero();
    steady_ = 1;
    held_ = 0;
    blind_ = 0;
    unfitted_ = 0;
    away_ = 0;
    for (Eigen::Index m = 0; m < M_; ++m) {
      if (seen_[m] == 0.0) {
        ++age_[at(m)];
        continue;
      }
      expected_.position.col(m) = position(m);
      age_[at(m)] = 1;
      known_[at(m)] = 1;
      if (account_.lasts(m)) account_.end(m, true);
    }
  }

  /// Nothing was fitted in the frames before: what their markers did not observe may have moved all the
  /// while.
  void reopen() {
    if (unfitted_ == 0) return;
    expected_.x = x_;
    expected_.speed_sd.setConstant(std::sqrt(kMostOpen));
    expected_.position_sd = scale_.position;
    const double frames = static_cast<double>(unfitted_);
    open_now_.array() += ((frames * scale_.stride).array().square().cwiseMin(kMostOpen).inverse() +
                          fit_->information(expected_, used_).array())
                             .inverse();
    open_now_ = open_now_.cwiseMin(kMostOpen);
    unfitted_ = 0;
  }

  void expect() {
    expected_.x = x_;
    const double steps = 1.0 + static_cast<double>(blind_);
    if (steady_ >= 2) {
      difference_ = steps * move_;
      model::integrate(problem_.model, expected_.x, difference_);
      expected_.speed_sd = (scale_.speed.array().square() * std::pow(steps, 4) + 4.0 * open_now_.array() +
                            open_before_.array())
                               .sqrt();
    } else {
      // No speed is known yet.
      expected_.speed_sd = 3.0 * steps * scale_.stride;
    }
    for (Eigen::Index m = 0; m < M_; ++m)
      expected_.position_sd[m] = elsewhere_[at(m)] ? std::numeric_limits<double>::infinity()
                                 : known_[at(m)]   ? scale_.position_sd_after(m, age_[at(m)])
                                                   : scale_.spread[m];
  }

  void settle(std::int64_t f) {
    const auto& model = problem_.model;
    open_before_ = open_now_;
    open_now_ = fit_->variance().cwiseMin(kMostOpen);
    // Where every marker is now, by the pose that joins both frames.
    for (Eigen::Index m = 0; m < M_; ++m)
      world_.col(m) =
          model::point_in_world(fit_->workspace(), model.markers()[at(m)].body, expected_.position.col(m));
    out_ = fit_->rejected();
    const bool readmitted = readmit(f);
    turn_round_exchanges(f);
    // The pose of what was taken, as the solver finds it.
    used_ = seen_;
    int rejected = 0;
    for (Eigen::Index m = 0; m < M_; ++m) {
      rejected += out_[at(m)];
      if (out_[at(m)]) used_[m] = 0.0;
    }
    model::difference(model, x_, fit_->x(), move_);
    if (blind_ > 0) move_ /= 1.0 + static_cast<double>(blind_);
    // A way from a place that was not known says little of the speed.
    const auto usual = scale_.stride.array().square();
    move_.array() *= usual / (usual + open_before_.array());
    ++steady_;
    blind_ = 0;
    model::difference(model, fit_->x(), state(), difference_);
    // What nothing observes lies anywhere in the solved pose.
    const bool near = (difference_.array().abs() < (kQuick * open_now_.array().sqrt()).max(kLostPose)).all();
    const bool all = used_.minCoeff() > 0.0;
    if (all && near) {
      x_ = state();
      model::kinematics(model, solver_->workspace(), x_);
    } else {
      x_ = fit_->x();
      solver_->solve(y_, used_, f, x_);
    }
    auto& w = solver_->workspace();
    for (Eigen::Index m = 0; m < M_; ++m) {
      const int body = model.markers()[at(m)].body;
      const Eigen::Vector3d x = used_[m] > 0.0 ? Eigen::Vector3d(y_.col(m)) : Eigen::Vector3d(world_.col(m));
      if (body >= 0)
        expected_.position.col(m) = w.rotation[at(body)].transpose() * (x - w.position[at(body)]);
      else
        expected_.position.col(m) = x;
    }
    if (rejected == 0 && near) x_ = state();
    if (readmitted) {
      // Where they came from is not known, nor then the speed.
      open_now_.setZero();
      open_before_.setZero();
      move_.setZero();
      steady_ = 1;
    }
    held_ = rejected;
    away_ = all ? 0 : away_ + 1;
    for (Eigen::Index m = 0; m < M_; ++m) account(f, m, out_[at(m)] != 0);
  }

  /// Markers that return from a gap are compared with a pose in which nothing held their segment, and only to
  /// first order. They are right when one pose that the body can have come to meanwhile has them, and all
  /// that was taken, in their positions.
  bool readmit(std::int64_t f) {
    const auto returning = [&](Eigen::Index m) {
      return out_[at(m)] && used_[m] == 0.0 && (!account_.lasts(m) || astray_[at(m)]) && known_[at(m)] &&
             !elsewhere_[at(m)];
    };
    bool any = false, others = false;
    weight_ = seen_;
    for (Eigen::Index m = 0; m < M_; ++m) {
      if (!out_[at(m)]) continue;
      any = any || returning(m);
      others = others || !returning(m);
      if (!returning(m)) weight_[m] = 0.0;
    }
    if (!any) return false;
    joint_ = others ? x_ : Eigen::VectorXd(state());
    if (others) solver_->solve(y_, weight_, f, joint_);
    model::difference(problem_.model, x_, joint_, difference_);
    for (Eigen::Index i = 0; i < difference_.size(); ++i)
      if (std::abs(difference_[i]) > kQuick * scale_.stride[i] * static_cast<double>(1 + away_)) return false;
    auto& w = solver_->workspace();
    model::kinematics(problem_.model, w, joint_);
    for (Eigen::Index m = 0; m < M_; ++m) {
      if (weight_[m] == 0.0 || !std::isfinite(expected_.position_sd[m])) continue;
      const auto away_from = [&](const Eigen::Matrix3Xd& position) {
        return (y_.col(m) - model::point_in_world(w, problem_.model.markers()[at(m)].body, position.col(m)))
            .norm();
      };
      // As in the frame before, or as in the last one that had them all.
      if (away_from(expected_.position) > kBound * expected_.position_sd[m] &&
          away_from(whole_position_) > kBound * scale_.position_sd_after(m, 1 + away_))
        return false;
    }
    for (Eigen::Index m = 0; m < M_; ++m)
      if (weight_[m] > 0.0) out_[at(m)] = 0;
    return true;
  }

  /// Two markers that changed positions may have been exchanged before: nearer to the model's markers they
  /// are right now. Then what was taken since they last did so was wrong.
  void turn_round_exchanges(std::int64_t f) {
    const auto& model = problem_.model;
    for (Eigen::Index m = 0; m < M_; ++m) {
      const int k = out_[at(m)] ? exchanged_with(m) : -1;
      if (k < m) continue;
      const auto squares = [&](const Eigen::Matrix3Xd& x) {
        double sum = 0.0;
        for (const Eigen::Index i : {m, static_cast<Eigen::Index>(k)}) {
          const auto& marker = model.markers()[at(i)];
          sum += (x.col(i) - model::point_in_world(fit_->workspace(), marker.body, marker.x_in_body))
                     .squaredNorm();
        }
        return sum;
      };
      if (squares(y_) > kClearlyNearer * squares(world_)) continue;
      for (const Eigen::Index i : {m, static_cast<Eigen::Index>(k)}) {
        const int partner = static_cast<int>(i == m ? k : m);
        if (account_.lasts(i)) account_.end(i, false);
        account_.add({.marker = static_cast<int>(i),
                      .first_frame = std::min(since_[at(i)], f - direction_),
                      .last_frame = std::max(since_[at(i)], f - direction_),
                      .distance = fit_->distance()[i],
                      .length_m = fit_->length()[i],
                      .partner = partner});
        since_[at(i)] = f;
        out_[at(i)] = 0;
      }
    }
  }

  void account(std::int64_t f, Eigen::Index m, bool out) {
    if (!out) {
      if (account_.lasts(m) && seen_[m] > 0.0) account_.end(m, true);
      if (seen_[m] > 0.0) {
        age_[at(m)] = 1;
        known_[at(m)] = 1;
        elsewhere_[at(m)] = 0;
      } else {
        ++age_[at(m)];
      }
      return;
    }
    ++age_[at(m)];
    if (!account_.lasts(m)) astray_[at(m)] = age_[at(m)] > 2;
    Outlier& outlier = account_.extend(m, f);
    last_[m] = fit_->distance()[m];
    outlier.distance = std::max(outlier.distance, last_[m]);
    outlier.length_m = std::max(outlier.length_m, fit_->length()[m]);
    if (const int partner = exchanged_with(m); partner >= 0) outlier.partner = partner;
    // The pose was found without this marker: how far is it from the model's, and where it was expected?
    const auto& w = solver_->workspace();
    const Eigen::Vector3d modelled = w.marker.col(m);
    outlier.from_model_m = std::max(outlier.from_model_m, (y_.col(m) - modelled).norm());
    outlier.expected_from_model_m =
        std::max(outlier.expected_from_model_m, (world_.col(m) - modelled).norm());
    // Away for so long, and not where the model would not have it: it may well have a new position now.
    if (outlier.last_frame - outlier.first_frame + 1 >= hold_ && !outlier.clearly_wrong()) {
      account_.end(m, false);
      elsewhere_[at(m)] = 1;
      --held_;
    }
  }

  /// The marker that lies where this one should be, while this one lies in its position; or -1.
  [[nodiscard]] int exchanged_with(Eigen::Index m) const {
    for (Eigen::Index k = 0; k < M_; ++k) {
      if (k == m || !out_[at(k)]) continue;
      const double apart = (world_.col(m) - world_.col(k)).norm();
      if ((y_.col(m) - world_.col(k)).norm() < kExchanged * apart &&
          (y_.col(k) - world_.col(m)).norm() < kExchanged * apart)
        return static_cast<int>(k);
    }
    return -1;
  }

  const Problem& problem_;
  StepScale& scale_;
  const IkOptions& options_;
  const JudgedFrame* frame_ = nullptr;  // the one being judged
  std::optional<ExpectedPoseFit> fit_;  // most recordings never need them
  std::optional<FrameSolver> solver_;
  Eigen::Index M_;
  OutlierAccount account_;
  Eigen::Matrix3Xd y_, world_, sound_position_, whole_position_;
  Eigen::VectorXd seen_, used_, x_, move_, difference_, sound_x_, weight_, joint_;
  Eigen::VectorXd last_;                    ///< M: distance when it was last not taken
  Eigen::VectorXd open_now_, open_before_;  ///< nv: variance that the last two frames left open
  Expectation expected_;
  std::vector<std::int64_t> age_;        ///< per marker: frames since it was taken
  std::vector<std::uint8_t> known_;      ///< per marker: 1: taken before
  std::vector<std::uint8_t> elsewhere_;  ///< per marker: 1: its position is not known any more
  std::vector<std::uint8_t> astray_;     ///< per marker: 1: it was away before it was not taken
  std::vector<std::int64_t> since_;      ///< per marker: its position is its own since that frame
  std::vector<std::uint8_t> out_;        ///< per marker: 1: not taken in this frame
  std::int64_t direction_ = 1, hold_ = 0, blind_ = 0, disturbed_ = 0;
  std::int64_t away_ = 0;      ///< frames in a row in which a marker was not seen or not taken
  std::int64_t unfitted_ = 0;  ///< quiet ones of them since the last fit
  int steady_ = 0, held_ = 0;
};

FrameJudge::FrameJudge(const Problem& problem, const IkOptions& options, double rate_hz, StepScale& scale)
    : impl_(std::make_unique<Impl>(problem, options, rate_hz, scale)) {}
FrameJudge::~FrameJudge() = default;

void FrameJudge::begin(const JudgedFrame& frame, const Eigen::VectorXd* before, std::int64_t direction) {
  impl_->begin(frame, before, direction);
}
void FrameJudge::judge(const JudgedFrame& frame) { impl_->judge(frame); }
std::vector<Outlier> FrameJudge::finish() { return impl_->finish(); }
void FrameJudge::forget() { impl_->forget(); }
const std::vector<std::uint8_t>& FrameJudge::out() const { return impl_->out(); }
const Eigen::Matrix3Xd& FrameJudge::expected() const { return impl_->expected(); }
std::int64_t FrameJudge::solves() const { return impl_->solves(); }
const Eigen::VectorXd& FrameJudge::x() const { return impl_->x(); }

}  // namespace kinemark::motion::internal
