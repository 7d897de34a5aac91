// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/path_noise.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/index.h"
#include "kinemark/math/noise_fit.h"
#include "kinemark/math/smoothing_choice.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

using math::SeriesMatrix;

constexpr double kOutlier = 5.5;         // robust deviations of the residual over the axes
constexpr double kFarOutlier = 8.0;      // the same, of spikes that the search for the noise leaves out
constexpr double kMostOutliers = 0.06;   // of the samples
constexpr std::int64_t kBeside = 6;      // samples on each side of a spike, judged once more without it
constexpr std::int64_t kMostBeside = 6;  // of them that go with it
constexpr std::int64_t kWithin = 6;      // samples of one that is judged, where its neighbours must be
constexpr double kOtherSide = 0.25;  // of an outlier's residual, that its neighbours have on the other side
constexpr double kSlowLow_hz = 0.2, kSlowHigh_hz = 2.0;
constexpr double kSlowUnknown = 2.5;    // 90 % over 10 % of the power
constexpr double kDisagrees = 1.3;      // stated over found, or the other way round
constexpr double kRoundingHigh = 1.25;  // of the deviation of rounding

double share_of(std::vector<double> values, double share) {
  std::ranges::sort(values);
  const double rank = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const auto above = std::min(below + 1, values.size() - 1);
  return values[below] + (rank - static_cast<double>(below)) * (values[above] - values[below]);
}

NoiseRange range_of(const std::vector<double>& values, double low, double high) {
  if (values.empty()) return {};
  return {.low = share_of(values, low), .middle = share_of(values, 0.5), .high = share_of(values, high)};
}

// Deviation of the noise in a band of frequencies, by steps.
double band_sd(const math::NoiseModel& model, double low, double high) {
  constexpr int kSteps = 24;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += model.power(low + (high - low) * (i + 0.5) / kSteps) / kSteps;
  return std::sqrt(sum * 2.0 * (high - low));
}

void find_ranges(PathNoise& noise) {
  std::vector<double> slow, cutoff;
  const double high = std::min(kSlowHigh_hz / noise.rate_hz, 0.45),
               low = std::min(kSlowLow_hz / noise.rate_hz, 0.5 * high);
  for (const auto& draw : noise.draws) {
    slow.push_back(band_sd(draw, low, high));
    if (draw.order > 0)
      cutoff.push_back(noise.rate_hz * math::three_db_of_half(draw.form, draw.order, draw.half));
  }
  noise.slow_sd_m = range_of(slow, 0.1, 0.9);
  if (noise.filtered()) noise.cutoff_hz = range_of(cutoff, 0.025, 0.975);
}

// Somebody knows how large the noise is: the form stays, the size is theirs, unless the samples are noisier.
void take_stated(double stated, PathNoise& noise) {
  noise.stated_sd_m = stated;
  std::vector<double> sizes;
  for (const auto& draw : noise.draws) sizes.push_back(draw.sd(true));
  // Slow noise may be as large as was stated: only what cannot be is against it.
  const auto may_be = range_of(sizes, 0.025, 0.975);
  const double size =
      noise.found_sd_m > kDisagrees * stated && may_be.low > stated ? noise.found_sd_m : stated;
  noise.source = NoiseSource::stated;
  const auto scale = [size](math::NoiseModel& model) {
    const double factor = size * size / (model.variance + (model.order > 0 ? 0.0 : model.floor));
    model.variance *= factor;
    if (model.order == 0) model.floor *= factor;
  };
  scale(noise.model);
  std::ranges::for_each(noise.draws, scale);
}

// White noise of a size, with what a fit of so many samples would leave open.
void assume_white(double sd, std::int64_t draws, PathNoise& noise) {
  noise.model = {.variance = sd * sd};
  noise.draws.assign(at(draws), noise.model);
}

}  // namespace

std::string_view to_string(NoiseSource source) {
  switch (source) {
    case NoiseSource::spectrum:
      return "spectrum";
    case NoiseSource::stated:
      return "stated";
    case NoiseSource::filter:
      return "filter";
    case NoiseSource::too_short:
      return "too short";
    case NoiseSource::no_model:
      return "no model";
    case NoiseSource::rounding:
      return "rounding";
  }
  return "";
}

bool PathNoise::slow_is_unknown() const {
  return slow_sd_m.high * slow_sd_m.high > kSlowUnknown * slow_sd_m.low * slow_sd_m.low;
}

bool PathNoise::filtered_within_movement() const {
  constexpr double kFactor = 1.3;
  if (!filtered() || source == NoiseSource::filter) return false;
  return above_hz > kFactor * model.half * rate_hz || cutoff_hz.high > kFactor * cutoff_hz.middle ||
         cutoff_hz.middle > kFactor * cutoff_hz.low;
}

double PathNoise::variance_about_mean(double seconds, bool before) const {
  const double length = 2.0 * std::round(0.5 * seconds * rate_hz) + 1.0;
  constexpr int kSteps = 600;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double u = (i + 0.5) / kSteps, f = 0.5 * u * u;
    const double mean = std::sin(std::numbers::pi * f * length) / (length * std::sin(std::numbers::pi * f));
    sum +=
        (before ? model.before_filter(f) : model.power(f)) * (1.0 - mean) * (1.0 - mean) * 2.0 * u / kSteps;
  }
  return sum;
}

namespace {

// How far samples lie from the cubic through their four neighbours, where all five are seen.
struct OffCubic {
  SeriesMatrix residual;     // n x K; 0 where not known
  std::vector<bool> known;   // n
  Eigen::RowVectorXd scale;  // K, robust deviations; empty: fewer than eight are known
};

OffCubic off_cubic(const SeriesMatrix& x, const std::vector<bool>& seen) {
  const std::int64_t n = x.rows();
  OffCubic out{
      .residual = SeriesMatrix::Zero(n, x.cols()), .known = std::vector<bool>(at(n), false), .scale = {}};
  std::vector<std::vector<double>> sizes(at(x.cols()));
  for (std::int64_t i = 2; i + 2 < n; ++i) {
    if (!(seen[at(i - 2)] && seen[at(i - 1)] && seen[at(i)] && seen[at(i + 1)] && seen[at(i + 2)])) continue;
    out.residual.row(i) =
        x.row(i) - (4.0 * (x.row(i - 1) + x.row(i + 1)) - x.row(i - 2) - x.row(i + 2)) / 6.0;
    out.known[at(i)] = true;
    for (Eigen::Index k = 0; k < x.cols(); ++k) sizes[at(k)].push_back(std::abs(out.residual(i, k)));
  }
  if (sizes.front().size() < 8) return out;
  out.scale.resize(x.cols());
  for (Eigen::Index k = 0; k < x.cols(); ++k) out.scale[k] = 1.4826 * math::median(sizes[at(k)]) + 1e-15;
  return out;
}

// The two nearest seen samples on both sides; fewer where there are none close by.
std::vector<std::int64_t> neighbours_of(std::int64_t i, const std::vector<bool>& seen) {
  std::vector<std::int64_t> out;
  for (const std::int64_t step : {-1, 1})
    for (std::int64_t k = i + step, taken = 0; taken < 2 && std::abs(k - i) <= kWithin; k += step) {
      if (k < 0 || k >= std::ssize(seen)) break;
      if (seen[at(k)]) out.push_back(k), ++taken;
    }
  return out;
}

// How far a sample lies from the cubic through its four neighbours, in deviations of that distance under
// white noise of these deviations; NaN without four.
double distance_from(const std::vector<std::int64_t>& neighbours, const SeriesMatrix& x, std::int64_t i,
                     const Eigen::RowVectorXd& scale) {
  if (neighbours.size() < 4) return NAN;
  Eigen::RowVectorXd off = x.row(i);
  double squares = 1.0;
  for (const auto a : neighbours) {
    double weight = 1.0;
    for (const auto b : neighbours)
      if (a != b) weight *= static_cast<double>(i - b) / static_cast<double>(a - b);
    off -= weight * x.row(a);
    squares += weight * weight;
  }
  return off.cwiseQuotient(scale).norm() / std::sqrt(squares);
}

std::vector<bool> outliers_beyond(const SeriesMatrix& x, const std::vector<bool>& seen, double limit) {
  const std::int64_t n = x.rows();
  std::vector<bool> out(at(n), false);
  const auto [residual, known, scale] = off_cubic(x, seen);
  if (scale.size() == 0) return out;
  const auto distance = [&, &residual = residual, &scale = scale](std::int64_t i) {
    return residual.row(i).cwiseQuotient(scale).norm();
  };
  std::int64_t count = 0;
  for (std::int64_t i = 3; i + 3 < n; ++i) {
    if (!known[at(i)] || !known[at(i - 1)] || !known[at(i + 1)] || distance(i) <= limit) continue;
    bool largest = true;
    for (std::int64_t k = i - 2; k <= i + 2; ++k) largest = largest && distance(k) <= distance(i);
    const double own = residual.row(i).squaredNorm();
    if (!largest || residual.row(i).dot(residual.row(i - 1)) > -kOtherSide * own ||
        residual.row(i).dot(residual.row(i + 1)) > -kOtherSide * own)
      continue;
    out[at(i)] = true;
    ++count;
  }
  if (static_cast<double>(count) > kMostOutliers * static_cast<double>(n)) out.assign(at(n), false);
  return out;
}

// Spikes beside each other hide one another, and make a good sample between them look like one: around each,
// the sample that lies farthest from those that are left goes first, until none lies off; those that lie well
// come back. @return which samples are left
std::vector<bool> left_beside(const SeriesMatrix& x, const std::vector<bool>& seen,
                              const std::vector<bool>& spikes) {
  constexpr double kCubicSquares = 70.0 / 36.0;  // of the weights of a sample and its four neighbours
  std::vector<bool> out = seen;
  for (std::int64_t i = 0; i < x.rows(); ++i) out[at(i)] = seen[at(i)] && !spikes[at(i)];
  const auto rest = off_cubic(x, out);
  if (rest.scale.size() == 0) return out;
  const Eigen::RowVectorXd scale = rest.scale / std::sqrt(kCubicSquares);
  const auto distance = [&](std::int64_t k) { return distance_from(neighbours_of(k, out), x, k, scale); };
  for (std::int64_t i = 0; i < x.rows(); ++i) {
    if (!spikes[at(i)]) continue;
    const auto first = std::max<std::int64_t>(0, i - kBeside), last = std::min(x.rows() - 1, i + kBeside);
    for (std::int64_t taken = 0; taken < kMostBeside; ++taken) {
      std::int64_t farthest = -1;
      double most = kOutlier;
      for (auto k = first; k <= last; ++k)
        if (const double d = out[at(k)] ? distance(k) : 0.0; d > most) most = d, farthest = k;
      if (farthest < 0) break;
      out[at(farthest)] = false;
    }
    for (auto k = first; k <= last; ++k)
      if (seen[at(k)] && !out[at(k)] && distance(k) <= kOutlier) out[at(k)] = true;
  }
  return out;
}

}  // namespace

std::vector<bool> single_frame_outliers(const SeriesMatrix& x, const std::vector<bool>& seen) {
  auto out = outliers_beyond(x, seen, kOutlier);
  const auto left = left_beside(x, seen, out);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = seen[i] && !left[i];
  return out;
}

std::vector<bool> without_spikes(const SeriesMatrix& x, const std::vector<bool>& seen) {
  return left_beside(x, seen, outliers_beyond(x, seen, kFarOutlier));
}

double rounding_step(const SeriesMatrix& x, const std::vector<bool>& seen) {
  double step = 0.0;
  for (Eigen::Index axis = 0; axis < x.cols(); ++axis) {
    std::vector<double> values, steps;
    for (std::int64_t i = 0; i < x.rows(); ++i)
      if (seen[at(i)]) values.push_back(x(i, axis));
    std::ranges::sort(values);
    for (std::size_t i = 1; i < values.size(); ++i)
      if (const double d = values[i] - values[i - 1]; d > 1e-12 * std::max(1.0, std::abs(values[i])))
        steps.push_back(d);
    if (steps.size() < 8) continue;
    const double least = share_of(steps, 0.02);
    std::size_t whole = 0;
    for (const double d : steps) {
      const double times = d / least, off = std::abs(times - std::round(times));
      whole += off < 0.02 + 1e-4 * times && times > 0.5;
    }
    if (least > 0.0 && static_cast<double>(whole) >= 0.95 * static_cast<double>(steps.size()))
      step = std::max(step, least);
    else
      return 0.0;
  }
  return step;
}

std::optional<math::NoiseModel> low_pass_of(const data::FilterUsed& filter, double rate_hz) {
  using math::LowPass;
  const bool spline = filter.method == "kalman" || filter.method == "gcv";
  const bool butterworth = filter.method == "butterworth" || filter.method == "classic";
  if (!(spline || butterworth) || !(filter.cutoff_hz > 0.0) || !(filter.cutoff_hz < 0.45 * rate_hz))
    return std::nullopt;
  if (filter.order < 1 || filter.order > (spline ? 5 : 10)) return std::nullopt;
  const auto form = spline ? LowPass::spline : LowPass::butterworth;
  math::NoiseModel out{.kind = math::NoiseKind::filtered, .form = form, .order = filter.order};
  out.half = math::half_of_three_db(form, filter.order, filter.cutoff_hz / rate_hz);
  if (filter.noise_sd_m > 0.0) out.variance = filter.noise_sd_m * filter.noise_sd_m;
  return out;
}

std::optional<PathNoise> find_path_noise(const SeriesMatrix& x, const std::vector<bool>& seen, double rate_hz,
                                         const NoiseKnown& known) {
  PathNoise out{.rate_hz = rate_hz, .stated_sd_m = known.stated_sd_m};
  const double differences = math::noise_from_differences(x, seen);
  math::NoiseSearch search;
  if (known.filter != nullptr) search.known = low_pass_of(*known.filter, rate_hz);
  const auto found = differences > 0.0 || search.known
                         ? math::find_noise(math::NoiseSpectrum(x, seen), rate_hz, search)
                         : std::nullopt;
  if (!found) {
    out.found_sd_m = differences;
    const double sd = std::isnan(differences) ? known.stated_sd_m : std::max(differences, known.stated_sd_m);
    if (!(sd > 0.0)) return std::nullopt;
    if (known.stated_sd_m > 0.0) out.source = NoiseSource::stated;
    assume_white(sd, known.draws, out);
    find_ranges(out);
    return out;
  }
  out.model = found->model();
  out.above_hz = found->chosen.lowest * rate_hz;
  out.source = search.known    ? NoiseSource::filter
               : found->fits() ? NoiseSource::spectrum
                               : NoiseSource::no_model;
  out.draws = math::draw_noise(*found, search, known.draws, Random(known.seed, known.stream));
  out.found_sd_m = out.sd_m();
  const double step = rounding_step(x, seen), of_rounding = step / std::sqrt(12.0);
  out.rounding_step_m = step;
  const bool rounded = out.source == NoiseSource::spectrum && !out.filtered() && step > 0.0 &&
                       out.found_sd_m < kRoundingHigh * of_rounding;
  if (known.stated_sd_m > 0.0)
    take_stated(known.stated_sd_m, out);
  else if (rounded)
    out.source = NoiseSource::rounding;
  find_ranges(out);
  return out;
}

}  // namespace kinemark::analysis
