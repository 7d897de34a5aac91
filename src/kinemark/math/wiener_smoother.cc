// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/wiener_smoother.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <tuple>

#include "kinemark/core/check.h"
#include "kinemark/math/internal/wiener_steps.h"

namespace kinemark::math {
namespace {

using internal::WienerSteps;

template <int kOrder, int kAxes>
void smooth(WienerSteps<kOrder, kAxes> process, std::span<const PositionObservation<kAxes>> all,
            const WienerOptions<kAxes>& options, const WienerVisit<kAxes>& visit) {
  using Steps = WienerSteps<kOrder, kAxes>;
  const std::size_t n = all.size(), block = options.block;
  process.set_shift(options.shift_s);

  // Forwards once, marking the prediction of each block's first observation; each block again on the way
  // back.
  std::vector<typename Steps::Belief> marks{options.prior ? process.begin(*options.prior)
                                                          : process.begin(all)};
  std::vector<typename Steps::Step> steps(std::min(n, block));
  const auto forward = [&](std::size_t first, std::size_t last, bool mark) {
    auto predicted = marks.back();
    for (std::size_t k = first; k < last; ++k) {
      auto& step = steps[k - first];
      std::ignore = Steps::update(predicted, all[k], step);
      if (k + 1 == n || (k + 1 == last && !mark)) return;
      process.set_interval(all[k + 1].time_s - all[k].time_s);
      predicted = step.filtered;
      process.advance(predicted);
    }
    marks.push_back(predicted);
  };
  for (std::size_t first = 0; first + block < n; first += block) forward(first, first + block, true);

  const bool with_covariance = options.covariance != WienerCovariance::none;
  const int covariances = with_covariance ? options.covariance == WienerCovariance::position ? 1 : 3 : 0;
  typename Steps::Adjoint later;
  WienerEstimate<kAxes> estimated;
  estimated.covariance.setZero();
  for (; !marks.empty(); marks.pop_back()) {
    const std::size_t first = (marks.size() - 1) * block, last = std::min(n, first + block);
    forward(first, last, false);
    for (std::size_t k = last; k-- > first;) {
      const auto& step = steps[k - first];
      if (k + 1 < n) {
        process.set_interval(all[k + 1].time_s - all[k].time_s);
        process.back(with_covariance, later);
      }
      process.estimate(step.filtered, later, covariances, estimated);
      visit(k, estimated);
      Steps::look_back(step, with_covariance, later);
    }
  }
}

template <int kOrder, int kAxes>
double log_likelihood(WienerSteps<kOrder, kAxes> process, std::span<const PositionObservation<kAxes>> all,
                      const WienerPrior<kAxes>& prior) {
  using Steps = WienerSteps<kOrder, kAxes>;
  typename Steps::Step step;
  typename Steps::Belief predicted = process.begin(prior);
  double sum = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const typename Steps::AxesMatrix m = Steps::update(predicted, all[k], step);
    if (step.seen) sum -= 0.5 * (step.y.dot(step.w * step.y) + std::log(m.determinant()));
    if (k + 1 == all.size()) break;
    process.set_interval(all[k + 1].time_s - all[k].time_s);
    predicted = step.filtered;
    process.advance(predicted);
  }
  return sum;
}

/// Calls `use` with the steps of the process's order.
template <int kAxes, class Use>
auto with_order(const WienerProcess& process, const Use& use) {
  check(process.spectral_density >= 0.0 && process.time_scale_s > 0.0,
        "a Wiener process has a density of 0 or more and a positive scale of time");
  if (process.order == 3) return use(WienerSteps<3, kAxes>(process));
  if (process.order == 4) return use(WienerSteps<4, kAxes>(process));
  check(process.order == 5, "the order of a smoother is 3, 4 or 5");
  return use(WienerSteps<5, kAxes>(process));
}

}  // namespace

template <int kAxes>
std::vector<std::pair<std::size_t, std::size_t>> runs_between_gaps(
    std::span<const PositionObservation<kAxes>> observations, double longest_s) {
  std::vector<std::pair<std::size_t, std::size_t>> out;
  for (std::size_t k = 0; k < observations.size(); ++k) {
    if (!(observations[k].information.trace() > 0.0)) continue;
    const bool goes_on =
        !out.empty() &&
        observations[k].time_s - observations[out.back().first + out.back().second - 1].time_s <= longest_s;
    if (!goes_on) out.emplace_back(k, 0);
    out.back().second = k + 1 - out.back().first;
  }
  return out;
}

template <int kAxes>
void smooth_wiener(const WienerProcess& process, std::span<const PositionObservation<kAxes>> observations,
                   const WienerOptions<kAxes>& options, const WienerVisit<kAxes>& visit) {
  check(options.block > 0, "a block has at least one observation");
  if (observations.empty()) return;
  check(options.prior || observations[0].information.trace() > 0.0,
        "without a prior, the first observation must carry information");
  with_order<kAxes>(process, [&](auto steps) { smooth(steps, observations, options, visit); });
}

template <int kAxes>
double wiener_log_likelihood(const WienerProcess& process,
                             std::span<const PositionObservation<kAxes>> observations,
                             const WienerPrior<kAxes>& prior) {
  return with_order<kAxes>(process, [&](auto steps) { return log_likelihood(steps, observations, prior); });
}

template std::vector<std::pair<std::size_t, std::size_t>> runs_between_gaps<1>(
    std::span<const PositionObservation<1>>, double);
template std::vector<std::pair<std::size_t, std::size_t>> runs_between_gaps<3>(
    std::span<const PositionObservation<3>>, double);
template void smooth_wiener<1>(const WienerProcess&, std::span<const PositionObservation<1>>,
                               const WienerOptions<1>&, const WienerVisit<1>&);
template void smooth_wiener<3>(const WienerProcess&, std::span<const PositionObservation<3>>,
                               const WienerOptions<3>&, const WienerVisit<3>&);
template double wiener_log_likelihood<1>(const WienerProcess&, std::span<const PositionObservation<1>>,
                                         const WienerPrior<1>&);
template double wiener_log_likelihood<3>(const WienerProcess&, std::span<const PositionObservation<3>>,
                                         const WienerPrior<3>&);

}  // namespace kinemark::math
