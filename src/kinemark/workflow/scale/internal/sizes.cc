// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/workflow/scale/internal/sizes.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/text.h"
#include "kinemark/data/name_index.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/model.h"
#include "kinemark/model/workspace.h"

namespace kinemark::workflow {
namespace {

constexpr double kBeside = 1.5;                     // times the median of all bodies
constexpr double kSmallest = 0.25, kLargest = 1.6;  // a newborn and the tallest, of an adult's model
constexpr std::size_t kSentences = 3;
constexpr std::size_t kDistances = 2;
constexpr std::int64_t kFrames = 200;

/// How far a factor is from 1, in either direction.
double times(double ratio) { return std::max(ratio, 1.0 / ratio); }

struct Distance {
  std::string first, second, trial;
  double measured_m = 0.0, model_m = 0.0;
};

/// Mean over frames that show both; 0: none does.
double mean_distance(const data::Trajectories& markers, std::int64_t a, std::int64_t b) {
  double sum = 0.0, count = 0.0;
  for (std::int64_t f = 0; f < markers.frames(); f += 1 + markers.frames() / kFrames)
    if (markers.present(f, a) && markers.present(f, b)) {
      sum += (markers.x(f, a) - markers.x(f, b)).norm();
      count += 1.0;
    }
  return count > 0.0 ? sum / count : 0.0;
}

bool neighbours(const data::ModelDescription& model, int a, int b) {
  return std::ranges::any_of(model.joints, [&](const auto& joint) {
    return (joint.parent_body_idx == a && joint.child_body_idx == b) ||
           (joint.parent_body_idx == b && joint.child_body_idx == a);
  });
}

/// Of a marker of the body to one of it or of a neighbour, those first that differ most from the model's.
std::vector<Distance> distances_of(const data::ModelDescription& model, const Eigen::Matrix3Xd& place,
                                   int body, double overall, std::span<const SizeSource> sources) {
  std::vector<Distance> all;
  for (const auto& source : sources) {
    const data::NameIndex index(source.markers->names);
    for (std::size_t i = 0; i < model.markers.size(); ++i)
      for (std::size_t j = 0; j < model.markers.size(); ++j) {
        const auto &one = model.markers[i], &other = model.markers[j];
        const bool same = other.body_idx == body;
        if (one.body_idx != body || (same && j <= i)) continue;
        if (!same && !neighbours(model, body, other.body_idx)) continue;
        const auto a = index.find(one.name), b = index.find(other.name);
        const double there =
            (place.col(static_cast<Eigen::Index>(i)) - place.col(static_cast<Eigen::Index>(j))).norm();
        if (a < 0 || b < 0 || there < 1e-3) continue;
        const double here = mean_distance(*source.markers, a, b);
        if (here > 0.0) all.push_back({one.name, other.name, source.name, here, there});
      }
  }
  std::ranges::stable_sort(all, std::greater{},
                           [&](const Distance& d) { return times(d.measured_m / (overall * d.model_m)); });
  return all;
}

std::string words_of(const std::vector<Distance>& distances) {
  std::vector<std::string> parts;
  for (std::size_t k = 0; k < std::min(distances.size(), kDistances); ++k)
    parts.push_back(fmt::format("the distance from {} to {} is {:.0f} mm in {}, {:.0f} mm in the model",
                                distances[k].first, distances[k].second, 1e3 * distances[k].measured_m,
                                distances[k].trial, 1e3 * distances[k].model_m));
  return parts.empty() ? std::string("no two of its markers were seen") : join(parts, "; ");
}

/// A recipe's own distances of a body.
std::vector<Distance> measured_of(const RecipeSizes& recipe, const std::string& body) {
  std::vector<Distance> out;
  for (std::size_t k = 0; k < recipe.scaled->measurements.size(); ++k)
    if (std::ranges::any_of(recipe.recipe->measurements[k].bodies,
                            [&](const data::ScaledBody& part) { return part.body == body; }))
      for (const auto& pair : recipe.scaled->measurements[k].pairs)
        out.push_back({pair.first, pair.second, recipe.trial, pair.measured_m, pair.model_m});
  return out;
}

/// The middle one of the bodies' sizes.
double median_size(const std::vector<data::BodyFactors>& factors) {
  std::vector<double> sizes;
  for (const auto& body : factors) sizes.push_back(std::cbrt(body.factors.prod()));
  const auto middle = sizes.begin() + std::ssize(sizes) / 2;
  std::ranges::nth_element(sizes, middle);
  return *middle;
}

}  // namespace

Status judge_sizes(const data::ModelDescription& given, const std::vector<data::BodyFactors>& factors,
                   std::span<const SizeSource> sources, const std::optional<RecipeSizes>& recipe,
                   Remarks& remarks) {
  if (factors.empty() || sources.empty()) return {};  // given by hand
  const auto compiled = model::Model::compile(given);
  if (!compiled) return std::unexpected(compiled.error());
  model::Workspace w(*compiled);
  model::kinematics(*compiled, w, compiled->default_state());

  const double overall = median_size(factors);
  data::Gate gate{
      .name = "sizes", .passed = true, .value = 1.0, .bound = kBeside, .unit = "times", .sentence = ""};
  std::vector<std::string> sentences;
  std::vector<double> said;  // bodies of one size share a sentence
  if (overall < kSmallest || overall > kLargest) {
    gate.passed = false;
    sentences.push_back(fmt::format("the bodies are {:.2f} times as large as those of the model", overall));
  }
  for (const auto& body : factors) {
    Eigen::Index axis = 0;
    const double worst = (body.factors / overall).unaryExpr(&times).maxCoeff(&axis);
    const double factor = body.factors[axis];
    gate.value = std::max(gate.value, worst);
    if (worst <= kBeside) continue;
    gate.passed = false;
    if (sentences.size() >= kSentences || std::ranges::count(said, factor) > 0) continue;
    said.push_back(factor);
    auto distances = recipe ? measured_of(*recipe, body.body) : std::vector<Distance>{};
    if (distances.empty())
      distances = distances_of(given, w.marker, given.find_body(body.body), overall, sources);
    sentences.push_back(
        fmt::format("{} is scaled by {:.2f} along its {} axis, beside {:.2f} of the bodies' "
                    "median: {}",
                    body.body, factor, "xyz"[axis], overall, words_of(distances)));
  }
  if (gate.passed) {
    gate.sentence = fmt::format(
        "No body is scaled by more than {:.1f} times the factor of the others, or by "
        "less than 1 / {:.1f} of it.",
        kBeside, kBeside);
  } else {
    gate.sentence = fmt::format("People do not differ as much as these sizes: {}.", join(sentences, "; "));
    remarks.warnings.push_back(gate.sentence);
  }
  remarks.gates.push_back(std::move(gate));
  return {};
}

}  // namespace kinemark::workflow
