// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/body/measure_errors.h"

#include <cmath>
#include <cstddef>

#include "kinemark/core/index.h"

namespace kinemark::analysis {
namespace {

// Deviations of a difference. Where cycles are alike, skin lets one stand out by twice in one motion of
// forty, and nearly all instants that are given then are of the wrong cycle.
constexpr double kAsExtreme = 3.0;

}  // namespace

MeasureErrors::MeasureErrors(const BodyDefinition& definition, const BodyView& estimate,
                             const BodyView& pilot, const BodyView& smoothed_pilot, std::int64_t refits)
    : definition_(definition),
      rate_hz_(estimate.record.time.rate_hz),
      estimate_(definition.value(estimate)),
      truth_(definition.value(pilot)),
      deviations_(at(refits), kNaN) {
  if (definition.curve == nullptr) return;
  curve_ = definition.curve(estimate);
  without_noise_ = definition.curve(smoothed_pilot);
  if (definition.is_instant()) instants_.emplace(definition.pick, curve_);
}

void MeasureErrors::add(std::span<const NumberedView> refits) {
  const auto deviation = [&](std::int64_t number) -> double& { return deviations_[at(number)]; };
  if (curve_.size() == 0 || instants_)
    for (const auto& [number, view] : refits) deviation(number) = definition_.value(view) - truth_;
  if (curve_.size() == 0) return;
  std::vector<Eigen::VectorXd> curves, noise;
  for (const auto& refit : refits) {
    curves.push_back(definition_.curve(refit.view));
    const bool comparable = curves.back().size() == without_noise_.size();
    noise.push_back(comparable ? Eigen::VectorXd(curves.back() - without_noise_) : Eigen::VectorXd());
    if (instants_) instants_->add(noise.back());
  }
  if (instants_) return;
  for (std::size_t i = 0; i < refits.size(); ++i) {
    if (const double own = thinned(definition_.pick, curve_, noise[i]); std::isfinite(own))
      thinned_ += own, thinned_count_ += 1.0;
    double sum = 0.0, count = 0.0;
    for (std::size_t other = 0; other < refits.size(); ++other)
      if (other != i) sum += thinned(definition_.pick, curves[i], noise[other]), count += 1.0;
    deviation(refits[i].number) = sum / count - truth_;
  }
}

double MeasureErrors::value() const { return thinned_count_ > 0.0 ? thinned_ / thinned_count_ : estimate_; }

MeasureErrors::Reach MeasureErrors::reach() const {
  if (!instants_) return {};
  const auto all = instants_->within(kAsExtreme), own = instants_->within(-1.0);
  return {static_cast<double>(all.first - own.first) / rate_hz_,
          static_cast<double>(all.last - own.last) / rate_hz_};
}

}  // namespace kinemark::analysis
