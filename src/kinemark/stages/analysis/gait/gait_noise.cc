// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_noise.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/data/trajectories.h"

namespace kinemark::analysis {
namespace {

constexpr std::uint64_t kGaitNoiseSeed = 0x67616974;
constexpr std::int64_t kGaitNoiseModels = 99;  // drawn for each point

// Points as the markers of a recording, so that what one leaves open the others tell.
data::Trajectories trajectories_of(std::span<const GaitPointSamples> points, const TimeBase& time) {
  std::vector<std::string> names;
  for (const auto& point : points) names.push_back(point.name);
  auto out = data::Trajectories::all_missing(std::move(names), time);
  const bool filters = std::ranges::any_of(points, [](const auto& one) { return one.filter != nullptr; });
  for (std::size_t m = 0; m < points.size(); ++m) {
    const auto column = static_cast<std::int64_t>(m);
    for (std::int64_t f = 0; f < time.frames; ++f)
      if ((*points[m].seen)[at(f)]) {
        out.x(f, column) = points[m].x->row(f).transpose();
        out.state[out.index(f, column)] = data::SampleState::measured;
      }
    if (filters)
      out.filters.push_back(points[m].filter != nullptr ? *points[m].filter
                                                        : data::FilterUsed{.method = "none"});
  }
  return out;
}

// Every draw as large as samples are known to be, where they do not tell their size themselves.
std::shared_ptr<const ColouredNoise> coloured(const PathNoise& noise) {
  auto draws = noise.draws;
  if (noise.sample_sd_m > 0.0 && leaves_size_open(noise))
    for (auto& draw : draws)
      if (const double sd = draw.sd(); sd > 0.0) {
        const double times = std::pow(noise.sample_sd_m / sd, 2);
        draw.variance *= times, draw.floor *= times;
      }
  return std::make_shared<const ColouredNoise>(
      ColouredNoise{.model = noise.model, .draws = std::move(draws)});
}

Recording white(const GaitPointSamples& point, double rate_hz, double sd_m) {
  return {.x = {},
          .seen = *point.seen,
          .rate_hz = rate_hz,
          .noise_sd_m = std::isfinite(sd_m) ? sd_m : 0.0,
          .choice = {},
          .noise = nullptr};
}

}  // namespace

GaitNoise find_gait_noise(std::span<const GaitPointSamples> points, const TimeBase& time, double stated_sd_m,
                          int threads) {
  GaitNoise out{.found = {}, .of_points = {}, .stated = stated_sd_m > 0.0, .shared = {}};
  if (out.stated) {
    for (const auto& point : points) {
      out.of_points.push_back(white(point, time.rate_hz, stated_sd_m));
      auto noise = find_path_noise(*point.x, *point.seen, time.rate_hz,
                                   {.stated_sd_m = stated_sd_m,
                                    .filter = point.filter,
                                    .draws = kGaitNoiseModels,
                                    .seed = kGaitNoiseSeed,
                                    .stream = mix64(out.of_points.size())});
      if (!noise) continue;
      noise->subject = point.name;
      noise->sample_sd_m = noise->model.sd();
      out.of_points.back().noise = coloured(*noise);
      out.found.push_back(std::move(*noise));
    }
    return out;
  }
  const auto recording = trajectories_of(points, time);
  std::set<std::int64_t> all;
  for (std::int64_t m = 0; m < std::ssize(points); ++m) all.insert(m);
  const auto markers = MarkerNoise::find(recording, all, kGaitNoiseSeed, threads);
  for (std::int64_t m = 0; m < std::ssize(points); ++m) {
    out.of_points.push_back(white(points[at(m)], time.rate_hz, markers.sample_sd_m(m)));
    if (const auto* noise = markers.of(m); noise != nullptr) out.of_points.back().noise = coloured(*noise);
  }
  out.found = markers.all();
  out.shared = markers.sentences();
  return out;
}

std::vector<std::string> GaitNoise::sentences() const {
  if (found.empty()) return {};
  double low = INFINITY, high = 0.0;
  for (const auto& noise : found)
    low = std::min(low, noise.sample_sd_m), high = std::max(high, noise.sample_sd_m);
  std::string kinds;
  for (const auto kind : {math::NoiseKind::white, math::NoiseKind::correlated,
                          math::NoiseKind::correlated_and_white, math::NoiseKind::filtered}) {
    const auto count =
        std::ranges::count_if(found, [kind](const auto& noise) { return noise.model.kind == kind; });
    if (count > 0)
      kinds +=
          fmt::format("{}{} of {} {}", kinds.empty() ? "" : ", ", count, found.size(), math::to_string(kind));
  }
  std::vector<std::string> out{
      fmt::format("intervals of walking rest on noise of {} mm a sample of feet and pelvis{}: {}",
                  fmt::format("{:.2g}", 1e3 * low) == fmt::format("{:.2g}", 1e3 * high)
                      ? fmt::format("{:.2g}", 1e3 * low)
                      : fmt::format("{:.2g} to {:.2g}", 1e3 * low, 1e3 * high),
                  stated ? ", its size as stated" : "", kinds)};
  out.insert(out.end(), shared.begin(), shared.end());
  return out;
}

}  // namespace kinemark::analysis
