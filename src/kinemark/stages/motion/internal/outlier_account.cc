// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/outlier_account.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/core/index.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kClearlyFarther =
    1.5;  // times as far from the model's marker as expected: it is wrong there
constexpr double kLeastFarther_m = 0.01;  // and by so much

}  // namespace

bool Outlier::clearly_wrong() const {
  return from_model_m > kClearlyFarther * expected_from_model_m &&
         from_model_m > expected_from_model_m + kLeastFarther_m;
}

OutlierAccount::OutlierAccount(Eigen::Index markers) : open_(index(markers), -1) {}

const Outlier& OutlierAccount::lasting(Eigen::Index marker) const { return begun_[at(open_[index(marker)])]; }

Outlier& OutlierAccount::extend(Eigen::Index marker, std::int64_t frame) {
  auto& open = open_[index(marker)];
  if (open < 0) {
    begun_.push_back({.marker = static_cast<int>(marker), .first_frame = frame, .last_frame = frame});
    open = std::ssize(begun_) - 1;
  }
  Outlier& outlier = begun_[at(open)];
  outlier.first_frame = std::min(outlier.first_frame, frame);
  outlier.last_frame = std::max(outlier.last_frame, frame);
  return outlier;
}

void OutlierAccount::end(Eigen::Index marker, bool returned) {
  Outlier outlier = lasting(marker);
  outlier.returned = returned;
  ended_.push_back(outlier);
  open_[index(marker)] = -1;
}

std::vector<Outlier> OutlierAccount::finish() {
  for (Eigen::Index m = 0; m < std::ssize(open_); ++m)
    if (lasts(m)) end(m, false);
  begun_.clear();
  return std::exchange(ended_, {});
}

void OutlierAccount::forget() {
  ended_.clear();
  if (std::ranges::all_of(open_, [](auto open) { return open < 0; })) begun_.clear();
}

}  // namespace kinemark::motion::internal
