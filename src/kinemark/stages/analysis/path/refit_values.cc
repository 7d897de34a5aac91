// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/internal/refit_values.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/math/normals.h"

namespace kinemark::analysis::internal {

RefitValues::RefitValues(std::vector<const PathDefinition*> asked) : definitions(std::move(asked)) {
  const std::size_t count = definitions.size();
  by_less.resize(count), by_least.resize(count), by_raw.resize(count), by_thinned.resize(count);
  least.assign(count, kNaN), raw.assign(count, kNaN);
  thinned.assign(count, 0.0), wander_of_noise.assign(count, 0.0);
}

bool RefitValues::any(bool (*taken)(Pivot)) const {
  return std::ranges::any_of(definitions, [taken](const auto* d) { return taken(d->pivot); });
}

bool RefitValues::any_extreme() const {
  return std::ranges::any_of(definitions, [](const auto* d) { return d->thinned != nullptr; });
}

std::vector<double> RefitValues::values(const PathSamples& path, const PathFrame& frame, bool (*taken)(Pivot),
                                        const NearPath* near, std::vector<double>* wanders) const {
  const PathFacts facts(path, frame, near);
  std::vector<double> out;
  if (wanders != nullptr) wanders->assign(definitions.size(), 0.0);
  for (std::size_t i = 0; i < definitions.size(); ++i) {
    const auto& definition = *definitions[i];
    out.push_back(taken(definition.pivot) ? definition.value(facts) : kNaN);
    if (wanders != nullptr && definition.wander != nullptr) (*wanders)[i] = definition.wander(facts);
  }
  return out;
}

std::vector<double> RefitValues::thinned_values(const PathMatrix& x,
                                                std::span<const PathMatrix> copies) const {
  std::vector<double> out(definitions.size(), 0.0);
  const auto axes = principal_axes(x);
  for (const auto& copy : copies) {
    const auto extremes = thinned_extremes(x, axes, copy);
    for (std::size_t i = 0; i < out.size(); ++i)
      if (definitions[i]->thinned != nullptr)
        out[i] += definitions[i]->thinned(extremes) / static_cast<double>(copies.size());
  }
  return out;
}

double RefitValues::doubt(const std::vector<double>& deviations) const {
  if (deviations.size() != let_through.size() || deviations.size() < 30) return 1.0;
  std::vector<std::size_t> order(deviations.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [this](std::size_t k) { return let_through[k]; });
  const std::size_t third = order.size() / 3;
  const auto spread = [&](std::size_t from) {
    double sum = 0.0, squares = 0.0, size = 0.0;
    for (std::size_t k = from; k < from + third; ++k)
      if (const double d = deviations[order[k]]; std::isfinite(d)) sum += d, squares += d * d, size += 1.0;
    return size < 2.0 ? kNaN : std::sqrt(std::max(0.0, squares / size - sum * sum / size / size));
  };
  const double calm = spread(0), loud = spread(order.size() - third);
  return calm > 0.0 ? loud / calm : 1.0;
}

void RefitValues::add_wander(std::uint64_t seed, std::uint64_t stream) {
  for (std::size_t i = 0; i < definitions.size(); ++i) {
    if (!(wander[i] > wander_of_noise[i]) || by_less[i].empty()) continue;
    const double sd = std::sqrt(wander[i] - wander_of_noise[i]);
    std::vector<double> normals(by_less[i].size());
    math::fill_normals(seed, stream, 0, normals);
    const double mean =
        std::accumulate(normals.begin(), normals.end(), 0.0) / static_cast<double>(normals.size());
    for (std::size_t k = 0; k < normals.size(); ++k) by_less[i][k] += sd * (normals[k] - mean);
  }
}

}  // namespace kinemark::analysis::internal
