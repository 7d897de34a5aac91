// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/marker_noise.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/random.h"
#include "kinemark/math/smoothing_choice.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/analysis/path/noise_sentences.h"

namespace kinemark::analysis {
namespace {

constexpr std::int64_t kModels = 99;       // drawn for each marker
constexpr double kSurest = 0.02;           // deviation of a size's logarithm: a few thousand samples
constexpr double kHardlySeen = 1.1;        // of a size that the samples hardly show: a factor of 3
constexpr double kOfSlow = 0.65;           // quantile that is taken where slow noise may be there
constexpr double kLeastSpread = 0.4;       // of markers of one recording: a factor of 1.5
constexpr double kMostWidened = 0.7;       // logarithm: a factor of 2
constexpr std::size_t kFewestMarkers = 3;  // that say something of each other

struct MarkerFound {
  std::optional<PathNoise> noise;
  double by_differences_m = kNaN;  // where there is no other
};

MarkerFound noise_of_marker(const data::Trajectories& markers, std::int64_t m, std::uint64_t seed) {
  math::SeriesMatrix x(markers.frames(), 3);
  std::vector<bool> seen(at(markers.frames()));
  Eigen::RowVector3d last = Eigen::RowVector3d::Zero();
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    seen[at(f)] = markers.present(f, m);
    if (seen[at(f)]) last = markers.x(f, m).transpose();
    x.row(f) = last;
  }
  const auto outliers = single_frame_outliers(x, seen);
  for (std::size_t i = 0; i < outliers.size(); ++i)
    if (outliers[i]) seen[i] = false;
  MarkerFound out{
      .noise = find_path_noise(x, seen, markers.time.rate_hz,
                               {.filter = markers.filters.empty() ? nullptr : &markers.filters[at(m)],
                                .draws = kModels,
                                .seed = seed,
                                .stream = mix64(static_cast<std::uint64_t>(m) + 1)}),
      .by_differences_m = math::noise_from_differences(x, seen)};
  if (!out.noise) return out;
  out.noise->subject = markers.names[at(m)];
  out.noise->outliers = std::ranges::count(outliers, true);
  return out;
}

// Markers that share a sentence, and what their samples err by.
struct OpenMarkers {
  std::vector<std::string> names;
  double low_m = INFINITY, high_m = 0.0;

  void add(const std::string& name, double sd_m) {
    names.push_back(name);
    low_m = std::min(low_m, sd_m);
    high_m = std::max(high_m, sd_m);
  }
  [[nodiscard]] std::string range() const {
    const auto low = fmt::format("{:.2g}", 1e3 * low_m), high = fmt::format("{:.2g}", 1e3 * high_m);
    return low == high ? low : low + " to " + high;
  }
};

// Logarithm of a sample's deviation, and how sure it is.
struct NoiseSize {
  double log = 0.0, sd = 0.0;
};

NoiseSize size_of(const PathNoise& noise) {
  constexpr double kLeast_m = 1e-9;
  std::vector<double> logs;
  for (const auto& draw : noise.draws) logs.push_back(std::log(std::max(kLeast_m, draw.sd())));
  std::ranges::sort(logs);
  const auto share = [&](double of) {
    return logs[static_cast<std::size_t>(of * static_cast<double>(std::ssize(logs) - 1))];
  };
  const double sd = std::max(kSurest, 0.5 * (share(0.841) - share(0.159)));
  const bool hardly_seen = noise.unusable() || noise.source == NoiseSource::too_short;
  const double rounding = std::log(std::max(kLeast_m, noise.rounding_step_m / std::sqrt(12.0)));
  const double middle = share(noise.slow_is_unknown() ? kOfSlow : 0.5);
  return {.log = std::max(rounding, middle), .sd = hardly_seen ? std::max(kHardlySeen, sd) : sd};
}

// Sizes of one recording's markers lie about a common one, by as much as they themselves show or by
// kLeastSpread (random effects, DerSimonian & Laird 1986): what a marker's samples leave open, others say.
void join_sizes(std::vector<NoiseSize>& sizes) {
  if (sizes.size() < kFewestMarkers) return;
  double weights = 0.0, squared = 0.0, sum = 0.0, misfit = 0.0;
  for (const auto& [log, sd] : sizes) {
    const double w = 1.0 / (sd * sd);
    weights += w, squared += w * w, sum += w * log;
  }
  for (const auto& [log, sd] : sizes) misfit += std::pow((log - sum / weights) / sd, 2);
  const double excess = (misfit - static_cast<double>(sizes.size() - 1)) / (weights - squared / weights);
  const double spread = std::max(kLeastSpread * kLeastSpread, excess);
  double all = 0.0, common = 0.0;
  for (const auto& [log, sd] : sizes) {
    const double w = 1.0 / (sd * sd + spread);
    all += w, common += w * log;
  }
  common /= all;
  for (auto& [log, sd] : sizes) {
    const double own = 1.0 / (sd * sd), others = 1.0 / (spread + 1.0 / all);
    log = (own * log + others * common) / (own + others);
    sd = std::sqrt(1.0 / (own + others));
  }
}

// Root mean square where only the logarithm is known, normally distributed.
double expected_of(const NoiseSize& size) {
  return std::exp(size.log + std::min(kMostWidened, size.sd * size.sd));
}

}  // namespace

bool leaves_size_open(const PathNoise& noise) {
  return noise.unusable() || noise.source == NoiseSource::too_short || noise.slow_is_unknown();
}

MarkerNoise MarkerNoise::find(const data::Trajectories& markers, const std::set<std::int64_t>& which,
                              std::uint64_t seed, int threads) {
  const std::vector<std::int64_t> list(which.begin(), which.end());
  std::vector<MarkerFound> found(list.size());
  parallel_for(std::ssize(list), 1, threads, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = begin; i < end; ++i) found[at(i)] = noise_of_marker(markers, list[at(i)], seed);
  });
  MarkerNoise out;
  std::vector<NoiseSize> sizes;
  for (std::size_t i = 0; i < list.size(); ++i) {
    Marker marker{.index = list[i], .sample_sd_m = found[i].by_differences_m};
    if (auto& noise = found[i].noise; noise) {
      marker.noise = std::ssize(out.noises_);
      sizes.push_back(size_of(*noise));
      out.noises_.push_back(std::move(*noise));
    }
    out.markers_.push_back(marker);
  }
  join_sizes(sizes);
  for (auto& marker : out.markers_)
    if (marker.noise >= 0)
      out.noises_[at(marker.noise)].sample_sd_m = marker.sample_sd_m = expected_of(sizes[at(marker.noise)]);
  return out;
}

const MarkerNoise::Marker* MarkerNoise::find_marker(std::int64_t index) const {
  const auto found = std::ranges::lower_bound(markers_, index, {}, &Marker::index);
  return found != markers_.end() && found->index == index ? &*found : nullptr;
}

double MarkerNoise::sample_sd_m(std::int64_t marker) const {
  const auto* found = find_marker(marker);
  return found != nullptr ? found->sample_sd_m : kNaN;
}

const PathNoise* MarkerNoise::of(std::int64_t marker) const {
  const auto* found = find_marker(marker);
  return found != nullptr && found->noise >= 0 ? &noises_[at(found->noise)] : nullptr;
}

std::vector<std::string> MarkerNoise::sentences() const {
  std::vector<std::string> out;
  if (const auto shared = find_shared_filter(noises_); shared.agreed())
    out.push_back(
        fmt::format("The recording was low-passed at about {:.1f} Hz (-3 dB; 95 %: {:.1f} to {:.1f}) before "
                    "it came here, "
                    "by {} of the {} markers whose spectrum tells: deviations hold the noise that it left, "
                    "not the movement "
                    "that it took away.",
                    shared.cutoff_hz, shared.low_hz, shared.high_hz, shared.members.size(), shared.of));
  OpenMarkers open;
  for (const auto& noise : noises_)
    if (leaves_size_open(noise)) open.add(noise.subject, noise.sample_sd_m);
  if (!open.names.empty())
    out.push_back(fmt::format(
        "{}: the samples leave open how large their noise is (slower than can be distinguished from "
        "movement, of no known "
        "form, or below the rounding of the file); deviations rest on {} mm a sample. State it: "
        "--noise, from a "
        "static trial of the same session.",
        listed(open.names), open.range()));
  return out;
}

}  // namespace kinemark::analysis
