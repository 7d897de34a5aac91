// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/control/internal/level_guard.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace kinemark::motion::internal {
namespace {

constexpr double kPatience_s = 0.05;
constexpr double kHold_s = 1.0;
constexpr double kRecovery_s = 0.2;
constexpr std::int64_t kMostTrips = 3;

}  // namespace

LevelGuard::LevelGuard(std::vector<double> bounds_m, double rate_hz, bool given_up)
    : bounds_m_(std::move(bounds_m)), rate_hz_(rate_hz), joined_(given_up), given_up_(given_up) {}

bool LevelGuard::settled() const { return joined_ && static_cast<double>(frames_) >= kRecovery_s * rate_hz_; }

void LevelGuard::look(const Eigen::VectorXd& errors_m) {
  bool any = false;
  for (std::size_t i = 0; i < bounds_m_.size(); ++i)
    any = any || is_beyond(i, errors_m[static_cast<Eigen::Index>(i)]);
  beyond_ = any ? beyond_ + 1 : 0;
  ++frames_;
  if (given_up_) return;
  if (!joined_) {
    if (beyond_ == 0 || static_cast<double>(beyond_) < kPatience_s * rate_hz_) return;
    joined_ = true;
    given_up_ = ++trips_ >= kMostTrips;
    frames_ = 0;
  } else if (!any && static_cast<double>(frames_) >=
                         kHold_s * rate_hz_ * std::exp2(static_cast<double>(trips_ - 1))) {
    joined_ = false;
  }
}

}  // namespace kinemark::motion::internal
