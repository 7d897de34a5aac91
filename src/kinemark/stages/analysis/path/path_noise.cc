// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/path_noise.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/math/noise_fit.h"
#include "kinemark/math/smoothing_choice.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

using math::SeriesMatrix;

constexpr double kOutlier = 5.5;        // robust deviations of the residual over the axes
constexpr double kMostOutliers = 0.06;  // of the samples
constexpr double kOtherSide = 0.25;  // of an outlier's residual, that its neighbours have on the other side
constexpr double kSlowLow_hz = 0.2, kSlowHigh_hz = 2.0;
constexpr double kSlowUnknown = 2.5;                        // 90 % over 10 % of the power
constexpr double kDisagrees = 1.3;                          // stated over found, or the other way round
constexpr double kRoundingLow = 0.8, kRoundingHigh = 1.25;  // of the deviation of rounding
constexpr double kCorrelated = 0.2;                         // from which a correlation is worth a word

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

std::string listed(const std::vector<std::string>& names) {
  if (names.size() == 1) return names.front();
  std::string out = fmt::format("{} markers ({}", names.size(), names.front());
  for (std::size_t i = 1; i < std::min<std::size_t>(3, names.size()); ++i) out += ", " + names[i];
  return out + (names.size() > 3 ? ", ...)" : ")");
}

// Markers that share a sentence, and the middle of a number over them.
struct Group {
  std::vector<const PathNoise*> members;
  [[nodiscard]] std::string names() const {
    std::vector<std::string> out;
    for (const auto* member : members) out.push_back(member->subject);
    return listed(out);
  }
  [[nodiscard]] bool one() const { return members.size() == 1; }
  [[nodiscard]] double middle(const std::function<double(const PathNoise&)>& number) const {
    std::vector<double> values;
    for (const auto* member : members)
      if (const double value = number(*member); std::isfinite(value)) values.push_back(value);
    return values.empty() ? kNaN : share_of(values, 0.5);
  }
};

Group group_of(std::span<const PathNoise> markers, const std::function<bool(const PathNoise&)>& belongs) {
  Group out;
  for (const auto& marker : markers)
    if (belongs(marker)) out.members.push_back(&marker);
  return out;
}

std::string range_sentence(const Group& group) {
  return fmt::format(
      "{}: the noise below 2 Hz cannot be told from movement (between {:.2g} and {:.2g} mm): no interval of "
      "extents, "
      "largest distance, boxes and plane. State it (--noise, from a static trial of the same session)",
      group.names(), 1e3 * group.middle([](const PathNoise& n) { return n.slow_sd_m.low; }),
      1e3 * group.middle([](const PathNoise& n) { return n.slow_sd_m.high; }));
}

std::string filter_sentence(const Group& group) {
  const auto& first = *group.members.front();
  return fmt::format(
      "{} {} low-passed at about {:.1f} Hz (-3 dB; {}; 95 %: {:.1f} to {:.1f}) before {} came here; noise "
      "before that "
      "{:.2g} mm; what the movement had above is lost",
      group.names(), group.one() ? "was" : "were",
      group.middle([](const PathNoise& n) { return n.cutoff_hz.middle; }),
      math::name_of(first.model.form, first.model.order),
      group.middle([](const PathNoise& n) { return n.cutoff_hz.low; }),
      group.middle([](const PathNoise& n) { return n.cutoff_hz.high; }), group.one() ? "it" : "they",
      1e3 * group.middle([](const PathNoise& n) { return n.sd_m(); }));
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

std::vector<bool> single_frame_outliers(const SeriesMatrix& x, const std::vector<bool>& seen) {
  const std::int64_t n = x.rows();
  std::vector<bool> out(at(n), false);
  if (n < 8) return out;
  SeriesMatrix residual = SeriesMatrix::Zero(n, x.cols());
  std::vector<bool> known(at(n), false);
  std::vector<std::vector<double>> sizes(at(x.cols()));
  for (std::int64_t i = 2; i + 2 < n; ++i) {
    if (!(seen[at(i - 2)] && seen[at(i - 1)] && seen[at(i)] && seen[at(i + 1)] && seen[at(i + 2)])) continue;
    residual.row(i) = x.row(i) - (4.0 * (x.row(i - 1) + x.row(i + 1)) - x.row(i - 2) - x.row(i + 2)) / 6.0;
    known[at(i)] = true;
    for (Eigen::Index k = 0; k < x.cols(); ++k) sizes[at(k)].push_back(std::abs(residual(i, k)));
  }
  if (sizes.front().size() < 8) return out;
  Eigen::RowVectorXd scale(x.cols());
  for (Eigen::Index k = 0; k < x.cols(); ++k) scale[k] = 1.4826 * math::median(sizes[at(k)]) + 1e-15;
  const auto distance = [&](std::int64_t i) { return residual.row(i).cwiseQuotient(scale).norm(); };
  std::int64_t count = 0;
  for (std::int64_t i = 3; i + 3 < n; ++i) {
    if (!known[at(i)] || !known[at(i - 1)] || !known[at(i + 1)] || distance(i) <= kOutlier) continue;
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
  out.draws = math::draw_noise(*found, search, known.draws, known.seed, known.stream);
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

std::vector<std::string> noise_sentences(std::span<const PathNoise> markers) {
  std::vector<std::string> out;
  std::vector<std::pair<math::LowPass, int>> forms;
  for (const auto& marker : markers)
    if (marker.filtered()) forms.emplace_back(marker.model.form, marker.model.order);
  std::ranges::sort(forms);
  forms.erase(std::unique(forms.begin(), forms.end()), forms.end());
  for (const auto& [form, order] : forms)
    out.push_back(filter_sentence(group_of(markers, [&](const PathNoise& n) {
      return n.filtered() && n.model.form == form && n.model.order == order;
    })));
  const auto within = group_of(markers, [](const PathNoise& n) { return n.filtered_within_movement(); });
  if (!within.members.empty())
    out.push_back(
        fmt::format("{}: low-passed within the movement's band: how much it took away is not in the data, no "
                    "interval of peaks and jerk",
                    within.names()));
  const auto correlated =
      group_of(markers, [](const PathNoise& n) { return n.model.correlation > kCorrelated; });
  if (!correlated.members.empty())
    out.push_back(fmt::format("{}: noise of {:.2g} mm, correlated over {:.2g} s (AR {:.2g})",
                              correlated.names(),
                              1e3 * correlated.middle([](const PathNoise& n) { return n.sd_m(); }),
                              correlated.middle([](const PathNoise& n) {
                                return -1.0 / std::log(std::min(n.model.correlation, 0.9999)) / n.rate_hz;
                              }),
                              correlated.middle([](const PathNoise& n) { return n.model.correlation; })));
  const auto slow =
      group_of(markers, [](const PathNoise& n) { return !n.unusable() && n.slow_is_unknown(); });
  if (!slow.members.empty()) out.push_back(range_sentence(slow));
  const auto none = group_of(markers, [](const PathNoise& n) { return n.source == NoiseSource::no_model; });
  if (!none.members.empty())
    out.push_back(
        fmt::format("{}: the noise above the movement fits no model (spikes, changing noise, another "
                    "filter): no interval",
                    none.names()));
  const auto rounding =
      group_of(markers, [](const PathNoise& n) { return n.source == NoiseSource::rounding; });
  if (!rounding.members.empty()) {
    const double step = 1e3 * rounding.middle([](const PathNoise& n) { return n.rounding_step_m; });
    out.push_back(
        fmt::format("{}: the noise is below the rounding of the file ({:.2g} mm): no interval from the "
                    "noise; rounding gives "
                    "+-{:.2g} mm a sample",
                    rounding.names(), step, 0.5 * step));
  }
  for (const auto& marker : markers) {
    const double ratio = marker.found_sd_m / marker.stated_sd_m;
    if (marker.stated_sd_m > 0.0 && (ratio > kDisagrees || ratio < 1.0 / kDisagrees))
      out.push_back(
          fmt::format("the noise of {} is {:.3g} mm by its samples, not the {:.3g} mm that were stated",
                      marker.subject, 1e3 * marker.found_sd_m, 1e3 * marker.stated_sd_m));
  }
  return out;
}

}  // namespace kinemark::analysis
