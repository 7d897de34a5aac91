// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/internal/exchanges.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/math/exchanged_points.h"

namespace kinemark::motion::internal {
namespace {

constexpr double kLeastRatio = 1.6;  // exchanged, both paths must go on so many times better

/// The samples of the model's markers in the frames of the problem, F x M x 3.
std::vector<double> samples_of(const Problem& problem, const data::Trajectories& markers) {
  const auto M = problem.data_marker.size();
  std::vector<double> x(3 * M * at(problem.frames), kNaN);
  for (std::int64_t f = 0; f < problem.frames; ++f)
    for (std::size_t m = 0; m < M; ++m) {
      const int d = problem.data_marker[m];
      if (!markers.present(problem.first_frame + f, d)) continue;
      const auto sample = markers.x(problem.first_frame + f, d);
      std::copy_n(sample.data(), 3, x.data() + 3 * (at(f) * M + m));
    }
  return x;
}

template <class T>
void swap_in(T& array, std::size_t i, std::size_t j, std::size_t n) {
  if (array.empty()) return;
  for (std::size_t k = 0; k < n; ++k) std::swap(array[n * i + k], array[n * j + k]);
}

}  // namespace

std::vector<Exchange> find_path_exchanges(const Problem& problem, const data::Trajectories& markers) {
  const auto& on_model = problem.model.markers();
  const auto distance = [&](std::int64_t one, std::int64_t other, std::int64_t) {
    const auto &a = on_model[at(one)], &b = on_model[at(other)];
    return a.body == b.body && a.body >= 0 ? (a.x_in_body - b.x_in_body).norm() : kNaN;
  };
  const auto x = samples_of(problem, markers);
  std::vector<Exchange> found;
  for (auto& pair : math::find_exchanges({.x = x.data(),
                                          .frames = problem.frames,
                                          .points = problem.model.marker_count(),
                                          .rate_hz = markers.time.rate_hz},
                                         {.distance = distance}))
    if (pair.side_known && pair.ratio > kLeastRatio)
      found.push_back({.one = static_cast<int>(pair.one),
                       .other = static_cast<int>(pair.other),
                       .frames = std::move(pair.frames)});
  return found;
}

std::vector<Exchange> take_mutual(std::vector<Outlier>& outliers) {
  std::vector<Exchange> found;
  std::vector<Outlier> rest;
  std::vector<std::pair<Outlier, std::vector<std::uint8_t>>> left;  // 1: taken out
  for (const Outlier& o : outliers)
    left.emplace_back(o, std::vector<std::uint8_t>(at(o.last_frame - o.first_frame + 1)));
  for (auto& [a, of_a] : left)
    for (auto& [b, of_b] : left) {
      if (a.marker >= b.marker || a.partner != b.marker || b.partner != a.marker) continue;
      Exchange exchange{.one = a.marker, .other = b.marker};
      for (auto f = std::max(a.first_frame, b.first_frame); f <= std::min(a.last_frame, b.last_frame); ++f) {
        exchange.frames.push_back(f);
        of_a[at(f - a.first_frame)] = of_b[at(f - b.first_frame)] = 1;
      }
      if (!exchange.frames.empty()) add_exchanges({exchange}, found);
    }
  for (const auto& [o, taken] : left)
    for (std::size_t i = 0; i < taken.size(); ++i) {
      if (taken[i] != 0) continue;
      std::size_t end = i + 1;
      while (end < taken.size() && taken[end] == 0) ++end;
      rest.push_back(o);
      rest.back().first_frame = o.first_frame + static_cast<std::int64_t>(i);
      rest.back().last_frame = o.first_frame + static_cast<std::int64_t>(end) - 1;
      if (rest.back().last_frame - rest.back().first_frame != o.last_frame - o.first_frame)
        rest.back().partner = -1;  // beside the frames in which both were in each other's positions
      i = end;
    }
  outliers = std::move(rest);
  return found;
}

void exchange_back(const Problem& problem, const std::vector<Exchange>& exchanges,
                   data::Trajectories& markers) {
  for (const Exchange& exchange : exchanges)
    for (const auto f : exchange.frames) {
      const auto frame = problem.first_frame + f;
      const auto i = markers.index(frame, problem.data_marker[at(exchange.one)]),
                 j = markers.index(frame, problem.data_marker[at(exchange.other)]);
      swap_in(markers.x_in_world, i, j, 3);
      swap_in(markers.state, i, j, 1);
      swap_in(markers.covariance, i, j, 6);
      swap_in(markers.method, i, j, 1);
      swap_in(markers.unfiltered_in_world, i, j, 3);
      if (markers.sample_offset_s.size() == markers.state.size()) swap_in(markers.sample_offset_s, i, j, 1);
    }
}

void add_exchanges(const std::vector<Exchange>& more, std::vector<Exchange>& all) {
  for (const Exchange& exchange : more) {
    const auto same = std::ranges::find_if(
        all, [&](const Exchange& e) { return e.one == exchange.one && e.other == exchange.other; });
    if (same == all.end()) {
      all.push_back(exchange);
      continue;
    }
    std::vector<std::int64_t> frames;
    std::ranges::set_symmetric_difference(same->frames, exchange.frames, std::back_inserter(frames));
    same->frames = std::move(frames);
  }
  std::erase_if(all, [](const Exchange& e) { return e.frames.empty(); });
}

}  // namespace kinemark::motion::internal
