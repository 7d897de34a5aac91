// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/measured_path.h"

#include <fmt/core.h>

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <span>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/data/calibration_error.h"
#include "kinemark/stages/analysis/path/definitions.h"
#include "kinemark/stages/analysis/path/internal/movement_ends.h"
#include "kinemark/stages/analysis/path/internal/refit_values.h"
#include "kinemark/stages/analysis/path/noise_sentences.h"
#include "kinemark/stages/analysis/path/stated_measure.h"

namespace kinemark::analysis {

using internal::RefitValues;

namespace {

constexpr std::int64_t kLeastStretch = 5;  // samples of a stretch
constexpr double kLowestCutOff_hz = 0.4;   // of those tried
constexpr double kMemoryCycles = 6.0;      // of the cut-off, beyond which a smoothed sample feels nothing
constexpr double kEdge_s = 0.08;           // at both ends, where a smoother knows one side only
constexpr std::int64_t kLeastDraws = 99;   // of the noise's models
constexpr double kSlow_s = 1.0, kQuick_s = 0.25;  // whose means are trends, slow and quick
constexpr double kSlow_hz = 2.0;                  // of the noise that moves ends of movements
constexpr double kNearJump_s = 0.1;               // within which a smoother rounds off a jump
constexpr std::int64_t kManySamples = 1 << 15;    // of a stretch, from which one copy thins an extreme

std::int64_t edge_samples(double rate_hz) {
  return std::max<std::int64_t>(kDerivativeMargin + 1, static_cast<std::int64_t>(kEdge_s * rate_hz));
}

bool is_asked(const PathDefinition& definition, const PathMeasureOptions& options, const PathFrame& frame) {
  if (!options.measures.empty())
    return std::ranges::find(options.measures, definition.what.id) != options.measures.end();
  switch (definition.applies) {
    case Applies::always:
      return true;
    case Applies::periodic:
      return frame.periodic;
    case Applies::closed:
      return frame.closed;
    case Applies::round:
      return frame.closed || frame.round;
    case Applies::whole:
      return frame.whole;
    case Applies::discrete:
      return frame.discrete;
  }
  return false;
}

// What the cameras saw is kept beside what a filter made of it.
bool has_raw_samples(const data::Trajectories& markers, std::int64_t marker) {
  if (markers.unfiltered_in_world.empty()) return false;
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    if (std::isfinite(markers.unfiltered_in_world[3 * markers.index(f, marker)])) return true;
  return false;
}

// Measured samples with their own positions, whatever was made between them by smoothed ones.
SeriesMatrix raw_path(const Recording& recording, const SeriesMatrix& smooth) {
  SeriesMatrix out = recording.x;
  for (std::int64_t i = 0; i < out.rows(); ++i)
    if (!recording.seen[at(i)]) out.row(i) = smooth.row(i);
  return out;
}

}  // namespace

std::expected<MeasuredPath, NotMeasured> MeasuredPath::create(const data::Trajectories& markers,
                                                              std::int64_t marker,
                                                              const PathMeasureOptions& options) {
  MeasuredPath out;
  out.name_ = markers.names[at(marker)];
  out.marker_ = marker;
  out.options_ = options;
  const bool raw = has_raw_samples(markers, marker);
  const auto sample = [&](std::int64_t f) -> Eigen::Vector3d {
    if (!raw) return markers.x(f, marker);
    return Eigen::Map<const Eigen::Vector3d>(markers.unfiltered_in_world.data() +
                                             3 * markers.index(f, marker));
  };
  const auto measured = [&](std::int64_t f) {
    if (raw)
      return sample(f).allFinite() && markers.state[markers.index(f, marker)] != data::SampleState::rejected;
    return markers.state[markers.index(f, marker)] == data::SampleState::measured;
  };
  std::int64_t first = markers.frames(), last = -1, count = 0, made = 0;
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    made += markers.state[markers.index(f, marker)] == data::SampleState::upsampled;
    if (!measured(f)) continue;
    first = std::min(first, f);
    last = f;
    ++count;
  }
  const auto not_measured = [&](NotMeasuredWhy why) {
    return std::unexpected(
        NotMeasured{.subject = out.name_, .why = why, .samples = count, .rate_hz = markers.time.rate_hz});
  };
  // Of a rate that was doubled the last frame is measured, so that it has one less that was made.
  if (made > 0 && 10 * made >= 9 * count) return not_measured(NotMeasuredWhy::made_samples);
  if (count < kLeastSamples) return not_measured(NotMeasuredWhy::too_few_samples);
  auto& recording = out.recording_;
  recording.rate_hz = markers.time.rate_hz;
  recording.x = SeriesMatrix::Zero(last - first + 1, 3);
  recording.seen.assign(at(last - first + 1), false);
  for (std::int64_t f = first; f <= last; ++f)
    if (measured(f)) {
      recording.x.row(f - first) = sample(f).transpose();
      recording.seen[at(f - first)] = true;
    }
  out.first_s_ = markers.time.time_s(first);
  out.first_number_ = markers.time.number(first);
  const auto whole = recording.seen;
  out.jumps_ = internal::find_velocity_jumps(recording.x, whole, recording.rate_hz);
  const SeriesMatrix level = internal::without_jumps(recording.x, out.jumps_);
  const auto outliers = single_frame_outliers(level, whole);
  auto regular = whole;
  for (std::size_t i = 0; i < outliers.size(); ++i)
    if (outliers[i]) regular[i] = false;
  if (!options.keep_outliers) recording.seen = regular;

  const bool says_filter = !raw && !markers.filters.empty();
  auto noise = find_path_noise(level, without_spikes(level, whole), recording.rate_hz,
                               {.stated_sd_m = options.noise_sd_m,
                                .filter = says_filter ? &markers.filters[at(marker)] : nullptr,
                                .draws = std::max<std::int64_t>(kLeastDraws, options.refits),
                                .seed = options.seed,
                                .stream = mix64(static_cast<std::uint64_t>(marker) + 1)});
  if (!noise) return not_measured(NotMeasuredWhy::unknown_noise);
  out.noise_ = std::move(*noise);
  out.noise_.subject = out.name_;
  out.noise_.outliers = std::ranges::count(outliers, true);
  recording.noise_sd_m = out.noise_.sd_m();
  recording.noise = std::make_shared<const ColouredNoise>(
      ColouredNoise{.model = out.noise_.model, .draws = out.noise_.draws});
  const double lowest = kLowestCutOff_hz / recording.rate_hz;
  constexpr double kHighest = 0.45;
  if (!(lowest < kHighest)) return not_measured(NotMeasuredWhy::too_slow);
  const SeriesMatrix in_noise = (recording.x.rowwise() - recording.x.row(0)) / recording.noise_sd_m;
  auto unit = out.noise_.model;
  unit.variance /= recording.noise_sd_m * recording.noise_sd_m;
  unit.floor /= recording.noise_sd_m * recording.noise_sd_m;
  const bool white = unit.kind == math::NoiseKind::white;
  const auto choice = math::choose_smoothing(
      in_noise, recording.seen, {.lowest = lowest, .highest = kHighest, .noise = white ? nullptr : &unit});
  if (!choice) return not_measured(NotMeasuredWhy::no_smoother);
  recording.choice = *choice;
  out.less_ = smoothed(recording, kLessSmooth);
  recording.noise_shape = noise_shape(recording, out.less_);
  if (options.refits > 0) out.least_ = smoothed(recording, kLeastSmooth);
  return out;
}

MeasuredPath::Stretch MeasuredPath::stretch_of(const data::Region& region) const {
  const double rate = recording_.rate_hz;
  const std::int64_t n = recording_.x.rows(), edge = edge_samples(rate);
  const std::int64_t first = std::max(edge, region.first_frame - first_number_);
  const std::int64_t last = std::min(n - 1 - edge, region.last_frame - first_number_);
  Stretch out{.first = first, .count = std::max<std::int64_t>(0, last - first + 1)};
  std::int64_t missing = 0, run = 0, longest = 0;
  for (std::int64_t i = first; i <= last; ++i) {
    run = recording_.seen[at(i)] ? 0 : run + 1;
    missing += !recording_.seen[at(i)];
    longest = std::max(longest, run);
  }
  if (out.count > 0) out.share_not_measured = static_cast<double>(missing) / static_cast<double>(out.count);
  out.longest_gap_s = static_cast<double>(longest) / rate;
  return out;
}

double MeasuredPath::excess_about_mean(const Stretch& stretch, double seconds) const {
  const std::int64_t half = std::llround(0.5 * seconds * recording_.rate_hz), n = recording_.x.rows();
  std::int64_t begin = std::max<std::int64_t>(0, stretch.first - half), end = begin;
  Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
  double squares = 0.0;
  std::int64_t count = 0;
  for (std::int64_t i = stretch.first; i < stretch.first + stretch.count; ++i) {
    for (; end < std::min(n, i + half + 1); ++end) sum += less_.row(end) - less_.row(0);
    for (; begin < i - half; ++begin) sum -= less_.row(begin) - less_.row(0);
    if (!recording_.seen[at(i)]) continue;
    const Eigen::RowVector3d mean = less_.row(0) + sum / static_cast<double>(end - begin);
    squares += (recording_.x.row(i) - mean).squaredNorm();
    count += 3;
  }
  if (count == 0) return INFINITY;
  return squares / static_cast<double>(count) - noise_.variance_about_mean(seconds, false);
}

double MeasuredPath::below_noise(const Stretch& stretch) const {
  const double noise = noise_.variance_about_mean(kSlow_s, true);
  const double moves = excess_about_mean(stretch, kSlow_s);
  if (moves <= 0.25 * noise) return 0.5;
  // Quick movement, such as tremor, is in the noise's own band.
  const bool quick = excess_about_mean(stretch, kQuick_s) > 0.5 * moves;
  return quick && moves <= 2.25 * noise ? 1.5 : 0.0;
}

// A stretch with as much before and behind it as its smoothed samples depend on, and samples enough.
MeasuredPath::Neighbourhood MeasuredPath::around(const Stretch& stretch) const {
  const std::int64_t n = recording_.x.rows();
  auto margin = static_cast<std::int64_t>(std::ceil(kMemoryCycles / recording_.choice.half_power));
  for (;; margin *= 2) {
    const std::int64_t first = std::max<std::int64_t>(0, stretch.first - margin);
    const std::int64_t end = std::min(n, stretch.first + stretch.count + margin);
    const auto begin = recording_.seen.begin();
    if (std::count(begin + first, begin + end, true) < kLeastSamples && end - first < n) continue;
    return {.first = first,
            .recording = {.x = recording_.x.middleRows(first, end - first),
                          .seen = {begin + first, begin + end},
                          .rate_hz = recording_.rate_hz,
                          .noise_sd_m = recording_.noise_sd_m,
                          .choice = recording_.choice,
                          .noise = recording_.noise,
                          .noise_shape = recording_.noise_shape}};
  }
}

PathCurves MeasuredPath::curves_of(const PathSamples& path, const PathFrame& frame, const Stretch& stretch,
                                   const CurveSpread& spread) const {
  const double rate = recording_.rate_hz;
  PathCurves out{.subject = name_,
                 .rate_hz = rate,
                 .start_s = frame.start_s,
                 .cut_off_hz = recording_.choice.half_power * rate * kLessSmooth,
                 .along = along_axes(path.x, principal_axes(path.x)),
                 .speed = speed_of(path),
                 .acceleration = tangential_acceleration(path),
                 .speed_sd = spread.speed_sd(),
                 .acceleration_sd = spread.acceleration_sd()};
  const auto first = recording_.seen.begin() + stretch.first;
  out.measured.assign(first, first + stretch.count);
  if (frame.discrete) out.window = movement_window(path, out.speed);
  if (frame.periodic) out.cycles = cycle_starts(path.x, frame.cycle_axis, rate, CycleTrend::of_whole_cycles);
  return out;
}

// Deviations of refits around the pilot path; `spread`, where there is one, gets their curves.
void MeasuredPath::refit(const Stretch& stretch, const Neighbourhood& near, const SeriesMatrix& pilot,
                         const PathFrame& frame, RefitValues& refits, CurveSpread* spread) const {
  const auto stream = mix64(static_cast<std::uint64_t>(marker_) + 1);
  const auto part = [&](const SeriesMatrix& x) {
    return differentiate(x, stretch.first - near.first, stretch.count, recording_.rate_hz);
  };
  const bool least_too = refits.any(RefitValues::of_least), raw_too = refits.any(RefitValues::of_raw);
  if (least_too)
    refits.least = refits.values(differentiate(least_, stretch.first, stretch.count, recording_.rate_hz),
                                 frame, RefitValues::of_least);
  const PathSamples pilot_part = part(pilot);
  const NearPath near_pilot(pilot_part.x);
  std::vector<double> wander_of_pilot, wander;
  refits.pilot = refits.values(pilot_part, frame, RefitValues::of_less, &near_pilot, &wander_of_pilot);
  // What noise is added to where measures are taken of samples that are not smoothed.
  const std::int64_t first = stretch.first - near.first;
  const PathMatrix raw = raw_path(near.recording, less_.middleRows(near.first, near.recording.x.rows()))
                             .middleRows(first, stretch.count);
  const auto visit = [&](const RefitBatch& batch, std::int64_t k) {
    const auto of_batch = [&](const SeriesMatrix& x) {
      return differentiate(x, first, stretch.count, recording_.rate_hz, 3 * k, 3);
    };
    const PathSamples less_part = of_batch(batch.less);
    if (spread != nullptr) spread->add(less_part);
    const auto a = refits.values(less_part, frame, RefitValues::of_less, &near_pilot, &wander);
    const auto b = least_too ? refits.values(of_batch(batch.least), frame, RefitValues::of_least) : a;
    const auto c =
        raw_too
            ? refits.values({.rate_hz = recording_.rate_hz,
                             .x = raw + PathMatrix(batch.simulated.block(first, 3 * k, stretch.count, 3)) -
                                  pilot_part.x},
                            frame, RefitValues::of_raw)
            : a;
    for (std::size_t i = 0; i < refits.definitions.size(); ++i) {
      const Pivot pivot = refits.definitions[i]->pivot;
      const double base = refits.pilot[i];
      refits.wander_of_noise[i] += (wander[i] - wander_of_pilot[i]) / static_cast<double>(options_.refits);
      if (RefitValues::of_less(pivot))
        refits.by_less[i].push_back(internal::on_scale(pivot, a[i]) - internal::on_scale(pivot, base));
      if (RefitValues::of_least(pivot)) refits.by_least[i].push_back(b[i] - base);
      if (RefitValues::of_raw(pivot)) refits.by_raw[i].push_back(c[i] * c[i] - refits.raw[i] * refits.raw[i]);
    }
  };
  const bool extremes = refits.any_extreme();
  const PathMatrix recorded = less_.middleRows(stretch.first, stretch.count);
  std::vector<PathMatrix> copies;  // the noise of a batch, and of the one before where it is alone
  const auto thin = [&](const RefitBatch& batch) {
    const PathMatrix last = copies.empty() ? PathMatrix() : copies.back();
    copies.clear();
    for (std::int64_t k = 0; k < batch.count; ++k)
      copies.emplace_back(batch.noise.block(first, 3 * k, stretch.count, 3));
    if (batch.count == 1 && last.size() > 0) copies.push_back(last);
    const auto most = stretch.count > kManySamples ? std::size_t{1} : copies.size() - 1;
    for (std::int64_t k = 0; k < batch.count; ++k) {
      const auto of_recorded = refits.thinned_values(recorded, {&copies[at(k)], 1});
      std::vector<PathMatrix> others;
      for (std::size_t j = 1; j < copies.size() && others.size() < most; ++j)
        others.push_back(copies[(at(k) + j) % copies.size()]);
      const auto of_refit = refits.thinned_values(batch.less.block(first, 3 * k, stretch.count, 3), others);
      for (std::size_t i = 0; i < refits.definitions.size(); ++i) {
        if (refits.definitions[i]->thinned == nullptr) continue;
        refits.thinned[i] += of_recorded[i] / static_cast<double>(options_.refits);
        refits.by_thinned[i].push_back(of_refit[i] - refits.pilot[i]);
      }
    }
  };
  const auto moved = data::displacements(options_.calibration_error, pilot);
  for_each_batch(near.recording, pilot,
                 {.count = options_.refits,
                  .seed = options_.seed,
                  .stream = stream,
                  .least_too = least_too,
                  .noise_too = extremes,
                  .displacements = {moved.begin(), moved.end()}},
                 [&](const RefitBatch& batch) {
                   for (std::int64_t k = 0; k < batch.count; ++k) {
                     visit(batch, k);
                     refits.let_through.push_back(noise_let_through(near.recording, batch.first + k));
                   }
                   if (extremes) thin(batch);
                 });
}

StretchSummary MeasuredPath::summary_of(const Stretch& stretch, const PathFrame& frame,
                                        bool intervals) const {
  StretchSummary out{.subject = name_,
                     .region = {},
                     .start_s = frame.start_s,
                     .end_s = frame.start_s + static_cast<double>(stretch.count - 1) / recording_.rate_hz,
                     .share_not_measured = stretch.share_not_measured,
                     .longest_gap_s = stretch.longest_gap_s,
                     .below_noise = intervals ? below_noise(stretch) : 0.0,
                     .noise_sd_m = recording_.noise_sd_m};
  out.cut_off_hz = recording_.choice.half_power * recording_.rate_hz;
  out.order = recording_.choice.order;
  out.level = options_.level;
  out.refits = options_.refits;
  if (noise_.source == NoiseSource::no_model) out.no_noise = "the noise above the movement fits no model";
  if (noise_.source == NoiseSource::rounding)
    out.no_noise =
        fmt::format("the noise is below the rounding of the file ({:.2g} mm)", 1e3 * noise_.rounding_step_m);
  out.slow_noise_unknown = noise_.slow_is_unknown();
  out.slow_low_m = noise_.slow_sd_m.low;
  out.slow_high_m = noise_.slow_sd_m.high;
  out.correlated = noise_.correlated();
  out.filtered_within = noise_.filtered_within_movement();
  if (noise_.filtered()) out.filtered_hz = noise_.cutoff_hz.middle;
  return out;
}

internal::MovementEnds MeasuredPath::ends_of(const Stretch& stretch, const PathSamples& path) const {
  const double rate = recording_.rate_hz, first_s = static_cast<double>(stretch.first) / rate;
  const auto speed = speed_of(path);
  const auto window = movement_window(path, speed);
  internal::MovementEnds out;
  if (noise_.unusable() || !(window.end_s > window.onset_s)) return out;
  const auto fit = [&](bool begins) {
    return internal::fit_sharp_end(
        recording_.x, recording_.seen, rate,
        {.begins = begins,
         .near_s = first_s + (begins ? window.onset_s : window.end_s),
         .movement_s = window.end_s - window.onset_s,
         .level = kMovingShare * speed_peak(path, speed).speed,
         .noise_variance = noise_.model.power(kSlow_hz / rate),
         .deviations = boost::math::quantile(boost::math::normal(), 0.5 + 0.5 * options_.level)});
  };
  out.onset = fit(true), out.end = fit(false);
  out.first_s = first_s_;
  out.smooth_onset_s = first_s + window.onset_s, out.smooth_end_s = first_s + window.end_s;
  return out;
}

// When the velocity jumps in a stretch, in its samples or by the fits of its ends.
void MeasuredPath::put_jumps(const Stretch& stretch, const PathSamples& path,
                             const internal::MovementEnds& ends, StretchSummary& summary) const {
  const double first_s = static_cast<double>(stretch.first) / recording_.rate_hz;
  const double last_s = first_s + static_cast<double>(stretch.count) / recording_.rate_hz;
  std::vector<double> jumps;
  for (const auto& jump : jumps_)
    if (const double at_s = jump.at / recording_.rate_hz; at_s >= first_s && at_s < last_s)
      jumps.push_back(at_s);
  const auto near = [&](double at_s) {
    return std::ranges::any_of(jumps, [&](double jump) { return std::abs(jump - at_s) < kNearJump_s; });
  };
  for (const auto& end : {ends.onset, ends.end})
    if (end && end->velocity_jumps && !near(end->time_s)) jumps.push_back(end->time_s);
  if (jumps.empty()) return;
  summary.peak_at_jump = near(first_s + speed_peak(path, speed_of(path)).time_s);
  const double earliest = first_s_ + std::ranges::min(jumps);
  summary.velocity_jumps = jumps.size() == 1
                               ? fmt::format("at {:.3f} s", earliest)
                               : fmt::format("{} times, first at {:.3f} s", jumps.size(), earliest);
}

std::expected<std::vector<data::Measure>, std::string> MeasuredPath::measure(const data::Region& region,
                                                                             PathCurves* curves) const {
  const Stretch stretch = stretch_of(region);
  if (stretch.count < kLeastStretch)
    return std::unexpected(fmt::format("{} frames without the edges of {:g} ms; need {} at least",
                                       stretch.count, 1e3 * kEdge_s, kLeastStretch));
  const double rate = recording_.rate_hz;
  const PathSamples less = differentiate(less_, stretch.first, stretch.count, rate);
  // The same noise for the same marker and region, whatever else is asked for.
  const auto stream = mix64(static_cast<std::uint64_t>(marker_) + 1);
  const bool intervals = options_.refits > 0;
  const auto near = intervals ? around(stretch) : Neighbourhood{};
  const auto part = [&](const SeriesMatrix& x) {
    return differentiate(x, stretch.first - near.first, stretch.count, rate);
  };
  const SeriesMatrix pilot =
      intervals ? pilot_path(near.recording, stretch.first - near.first, stretch.count, options_.seed, stream)
                : SeriesMatrix{};
  const PathSamples pilot_part = intervals ? part(pilot) : less;
  PathFrame frame = recognise(pilot_part);
  frame.start_s = first_s_ + static_cast<double>(stretch.first) / rate;

  std::vector<const PathDefinition*> asked;
  for (const auto& definition : path_definitions())
    if (is_asked(definition, options_, frame)) asked.push_back(&definition);
  RefitValues refits(std::move(asked));
  refits.less = refits.values(less, frame, RefitValues::of_less, nullptr, &refits.wander);
  const bool raw_too = refits.any(RefitValues::of_raw);
  if (raw_too)
    refits.raw = refits.values(
        {.rate_hz = rate, .x = raw_path(recording_, less_).middleRows(stretch.first, stretch.count)}, frame,
        RefitValues::of_raw);
  CurveSpread spread(pilot_part);
  if (intervals) refit(stretch, near, pilot, frame, refits, curves != nullptr ? &spread : nullptr);
  refits.add_wander(options_.seed, mix64(stream));

  if (curves != nullptr) {
    *curves = curves_of(less, frame, stretch, spread);
    curves->region = region.name;
  }

  const auto ends = intervals && frame.discrete ? ends_of(stretch, less) : internal::MovementEnds{};
  auto summary = summary_of(stretch, frame, intervals);
  put_jumps(stretch, less, ends, summary);
  summary.region = region.name;
  std::vector<data::Measure> out;
  for (std::size_t i = 0; i < refits.definitions.size(); ++i) {
    const auto& definition = *refits.definitions[i];
    const bool raw_one = definition.pivot == Pivot::raw_squared,
               thinned = intervals && definition.thinned != nullptr;
    const auto& deviations = raw_one ? refits.by_raw[i] : thinned ? refits.by_thinned[i] : refits.by_less[i];
    const bool least = definition.pivot == Pivot::of_derivative;
    auto measure = state_measure(definition, summary, frame,
                                 {.estimate = raw_one   ? refits.raw[i]
                                              : thinned ? refits.thinned[i]
                                                        : refits.less[i],
                                  .estimate_of_interval = least ? refits.least[i] : kNaN,
                                  .deviations = deviations,
                                  .deviations_of_interval = refits.by_least[i],
                                  .thinned = thinned,
                                  .doubt = refits.doubt(least ? refits.by_least[i] : deviations),
                                  .sharp = ends.value_of(definition.what.id, refits.less[i])});
    if (thinned && std::isfinite(measure.uncorrected)) measure.uncorrected = refits.less[i];
    out.push_back(std::move(measure));
  }
  return out;
}

}  // namespace kinemark::analysis
