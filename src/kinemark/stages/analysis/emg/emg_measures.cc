// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/emg/emg_measures.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <iterator>
#include <optional>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/random.h"
#include "kinemark/data/interval_refits.h"
#include "kinemark/stages/analysis/emg/channel_facts.h"
#include "kinemark/stages/analysis/emg/internal/activity.h"
#include "kinemark/stages/analysis/emg/internal/rails.h"
#include "kinemark/stages/analysis/emg/internal/spectral_noise.h"
#include "kinemark/stages/analysis/path/pivot.h"

namespace kinemark::analysis {
namespace {

using data::Quantity;
using Eigen::Index;
using Eigen::VectorXd;

constexpr double kInstant = 0.25;    // of the stretch, the widest interval of an instant
constexpr std::int64_t kDraws = 99;  // of the edges of bursts, where no refits are asked for
constexpr std::string_view kEmg = "emg", kDefinition = "definition";

enum Which : std::uint8_t { kMean, kPeak, kPeakTime, kRms, kMedian, kOnset, kEnd, kActive, kRest, kCount };

constexpr std::array<data::MeasureDefinition, kCount> kDefinitions{{
    {"emg_mean", kEmg, Quantity::voltage, "Mean of the envelope",
     "rectified, low-passed; with what it is at rest", kDefinition},
    {"emg_peak", kEmg, Quantity::voltage, "Peak of the envelope", "sqrt(max^2 - rest^2)", kDefinition},
    {"emg_peak_time", kEmg, Quantity::time, "Time of the peak", "from the beginning of the span",
     kDefinition},
    {"emg_rms", kEmg, Quantity::voltage, "Root mean square", "of the band: sqrt(mean square - that at rest)",
     "Merletti 1999"},
    {"emg_median_frequency", kEmg, Quantity::frequency, "Median frequency", "halves the power of the band",
     "De Luca 1984"},
    {"emg_onset", kEmg, Quantity::time, "Onset of the first burst",
     "at least as strong as rest for 50 ms, from the beginning of the span", kDefinition},
    {"emg_end", kEmg, Quantity::time, "End of the last burst", "likewise", kDefinition},
    {"emg_active", kEmg, Quantity::share, "Share of the time active", "of the samples within bursts",
     kDefinition},
    {"emg_rest", kEmg, Quantity::voltage, "Envelope at rest", "mean outside bursts", kDefinition},
}};

/// A channel, prepared.
struct Prepared {
  VectorXd band, envelope;
  RestLevel rest;
};

/// What is known of when the muscle is active.
struct Known {
  Quiet::Found found;
  bool silent;  // no burst reaches into the stretch
};

/// What chance makes of a measure.
struct Chance {
  std::vector<double> deviations;  // of refits, where it is simulated
  double sd = kNaN;                // where its law is known
};

// That of a mean of rectified noise, whose strength may change: `variance` is that of its noise. A mean has
// no bias; its standard deviation grows with the strength, so that its logarithm is what has even ends.
double sd_of_mean(double squares, double count, double variance) {
  return std::sqrt(variance * squares) / count;
}
Pivoted around_mean(double value, double sd, double level) {
  const double z = boost::math::quantile(boost::math::normal(), 0.5 + 0.5 * level);
  const double factor = value > 0.0 ? std::exp(z * sd / value) : 1.0;
  return {.value = value, .sd = sd, .low = value / factor, .high = value * factor};
}

// All of it where rest is not known.
double root_of_difference(double value, double rest) {
  if (std::isnan(rest)) return value;
  return std::sqrt(std::max(0.0, value * value - rest * rest));
}

void take_out_mean(std::vector<double>& deviations) {
  double mean = 0.0;
  for (const double d : deviations) mean += d / static_cast<double>(deviations.size());
  for (double& d : deviations) d -= mean;
}

std::string why_clipped(const std::string& name, const Rails& rails) {
  const auto at = std::isnan(rails.low)    ? fmt::format("{:.4g} V", rails.high)
                  : std::isnan(rails.high) ? fmt::format("{:.4g} V", rails.low)
                                           : fmt::format("{:.4g} or {:.4g} V", rails.low, rails.high);
  return fmt::format("{} is clipped: {:.2g} % of its samples stand at {}, and its amplitudes are too small",
                     name, 100.0 * rails.share, at);
}

class EmgMeasurement {
 public:
  EmgMeasurement(double rate_hz, double t0_s, const EmgOptions& options, std::vector<EmgStretch> stretches)
      : rate_hz_(rate_hz), t0_s_(t0_s), options_(options), stretches_(std::move(stretches)) {}

  void measure(const EmgChannel& channel, std::uint64_t stream, EmgMeasures& out) const {
    auto found = prepare(channel.volts);
    const double most = options_.to_maximum ? found.envelope.maxCoeff() : channel.most_volts;
    out.names.push_back(channel.name);
    out.envelopes.push_back(std::isnan(most) ? found.envelope : VectorXd(found.envelope / most));
    if (!(found.envelope.maxCoeff() > 0.0)) {
      out.notes.push_back(fmt::format("{} holds no signal", channel.name));
      return;
    }
    if (const auto rails = find_rails(channel.volts, rate_hz_); rails.share > 0.0)
      out.notes.push_back(why_clipped(channel.name, rails));
    for (const auto& why :
         {why_rectified(channel), std::isnan(channel.most_volts)
                                      ? std::string()
                                      : why_above_maximum(channel.name, out.envelopes.back())})
      if (!why.empty()) out.notes.push_back(why), out.contradicted.push_back(why);
    const auto activity = find_activity(found.band, rate_hz_,
                                        {.band = options_.envelope,
                                         .rest_s = options_.rest_s,
                                         .burst_s = options_.burst_s,
                                         .draws = options_.refits > 0 ? options_.refits : kDraws,
                                         .seed = mix64(options_.seed) ^ stream});
    put_rest(activity, found);
    const auto values = values_of(found, activity.bursts);
    std::vector<Chance> chance(values.size(), {.deviations = std::vector<double>(at(options_.refits), kNaN)});
    if (options_.refits > 0) {
      put_laws_of_means(activity, found, chance);
      // The signal over its own envelope is noise without muscle; beside a burst the filter's envelope
      // undershoots rest.
      const double least = 1e-6 * found.envelope.maxCoeff();
      const VectorXd strength = found.envelope.cwiseMax(found.rest.mean > least ? found.rest.mean : least);
      SpectralNoise noise(found.band.cwiseQuotient(strength), rate_hz_);
      const double gain =
          found.band.norm() / strength.norm();  // drawn channels have the power of the channel
      // What the drawn channels are made of. The frequency is the spectrum's, which all of the channel tells:
      // that of the stretch holds the stretch's own chance, which would count twice.
      auto truth = values;
      for (std::size_t s = 0; s < stretches_.size(); ++s)
        truth[s * kCount + kMedian] = noise.median_hz(rate_hz_);
      for (std::int64_t k = 0; k < options_.refits; ++k) {
        const VectorXd drawn = gain * strength.cwiseProduct(noise.draw(options_.seed, stream, k));
        auto version = prepare_band(drawn);
        put_rest(activity, version);
        const auto again =
            values_of(version, activity.draws.empty() ? activity.bursts : activity.draws[at(k)]);
        // Draws of instants are where the truth may lie, and not estimates of it.
        for (std::size_t i = 0; i < again.size(); ++i)
          chance[i].deviations[at(k)] = is_of_bursts(i % kCount) ? truth[i] - again[i] : again[i] - truth[i];
      }
      // The envelope spreads bursts into rest, and so the drawn channels' RMS is not that of the channel; the
      // bias of a root of a mean is small.
      for (std::size_t s = 0; s < stretches_.size(); ++s) take_out_mean(chance[s * kCount + kRms].deviations);
    }
    for (std::size_t s = 0; s < stretches_.size(); ++s)
      for (int which = 0; which < kCount; ++which) {
        const std::size_t i = s * kCount + static_cast<std::size_t>(which);
        const bool silent = values[s * kCount + kActive] == 0.0;
        if (is_asked(which))
          state(which, channel.name, stretches_[s], {activity.found, silent}, values[i], chance[i], most,
                out);
      }
  }

 private:
  [[nodiscard]] bool is_asked(int which) const {
    const auto& asked = options_.measures;
    return asked.empty() || std::ranges::find(asked, kDefinitions[at(which)].id) != asked.end();
  }

  [[nodiscard]] Prepared prepare(const VectorXd& volts) const {
    const VectorXd level = volts.array() - volts.mean();
    return prepare_band(band_passed(level, rate_hz_, options_.envelope));
  }
  [[nodiscard]] Prepared prepare_band(VectorXd band) const {
    Prepared out{.band = std::move(band)};
    out.envelope = envelope_of(out.band, rate_hz_, options_.envelope);
    return out;
  }
  // The envelope is not taken there, as that of a burst reaches beyond it.
  void put_rest(const Activity& activity, Prepared& channel) const {
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (Index i = 0; i < channel.band.size(); ++i)
      if (activity.rest[at(i)] != 0)
        sum += std::abs(channel.band[i]), squares += channel.band[i] * channel.band[i], count += 1.0;
    if (!(count > 0.0)) return;
    channel.rest.rms = std::sqrt(squares / count);
    channel.rest.mean = options_.envelope.rms_window_s > 0.0 ? channel.rest.rms : sum / count;
  }

  void put_laws_of_means(const Activity& activity, const Prepared& channel, std::vector<Chance>& out) const {
    VectorXd quiet = channel.band;
    double count = 0.0;
    for (Index i = 0; i < quiet.size(); ++i)
      if (activity.rest[at(i)] != 0)
        count += 1.0;
      else
        quiet[i] = 0.0;
    const double whole = SpectralNoise(channel.band, rate_hz_).variance_of_rectified(),
                 at_rest = SpectralNoise(quiet, rate_hz_).variance_of_rectified();
    for (std::size_t s = 0; s < stretches_.size(); ++s) {
      const auto& stretch = stretches_[s];
      out[s * kCount + kMean].sd =
          sd_of_mean(channel.band.segment(stretch.first, stretch.count).squaredNorm(),
                     static_cast<double>(stretch.count), whole);
      if (count > 0.0) out[s * kCount + kRest].sd = sd_of_mean(quiet.squaredNorm(), count, at_rest);
    }
  }

  [[nodiscard]] static bool is_of_bursts(std::size_t which) {
    return which == kOnset || which == kEnd || which == kActive;
  }

  // Of all stretches, one after the other.
  [[nodiscard]] std::vector<double> values_of(const Prepared& channel,
                                              const std::vector<Burst>& bursts) const {
    std::vector<double> out;
    const auto& rest = channel.rest;
    for (const auto& stretch : stretches_) {
      const auto envelope = channel.envelope.segment(stretch.first, stretch.count);
      const VectorXd band = channel.band.segment(stretch.first, stretch.count);
      Index peak = 0;
      const double most = envelope.maxCoeff(&peak);
      const double begin = static_cast<double>(stretch.first),
                   end = static_cast<double>(stretch.first + stretch.count - 1);
      double onset = kNaN, last = kNaN, active = bursts.empty() ? kNaN : 0.0;
      for (const auto& burst : bursts) {
        if (burst.end <= begin || burst.onset >= end) continue;
        if (std::isnan(onset) && burst.onset > begin) onset = (burst.onset - begin) / rate_hz_;
        if (burst.end < end) last = (burst.end - begin) / rate_hz_;
        active += std::min(burst.end, end) - std::max(burst.onset, begin);
      }
      std::array<double, kCount> values{};
      values[kMean] = envelope.mean();
      values[kPeak] = root_of_difference(most, rest.mean);
      values[kPeakTime] = static_cast<double>(peak) / rate_hz_;
      values[kRms] =
          root_of_difference(std::sqrt(band.squaredNorm() / static_cast<double>(band.size())), rest.rms);
      values[kMedian] = median_frequency(band, rate_hz_);
      values[kOnset] = onset;
      values[kEnd] = last;
      values[kActive] = active / (end - begin);
      values[kRest] = rest.mean;
      out.insert(out.end(), values.begin(), values.end());
    }
    return out;
  }

  [[nodiscard]] static std::string why_undetermined(int which, const Known& known) {
    if (which == kMedian) return "no signal there";
    if (known.found == Quiet::Found::steady)
      return "not determined: its strength hardly changes, of a muscle at rest or of an active one";
    if (known.found == Quiet::Found::no_rest)
      return "not determined: no part of the channel is surely at rest";
    return "no burst begins or ends in the span";
  }

  void state(int which, const std::string& name, const EmgStretch& stretch, const Known& known, double value,
             const Chance& chance, double most, EmgMeasures& out) const {
    const auto& definition = kDefinitions[at(which)];
    data::Measure measure{.id = std::string(definition.id),
                          .subject = name,
                          .context = stretch.context,
                          .region = stretch.name,
                          .cycle = stretch.cycle,
                          .start_s = t0_s_ + static_cast<double>(stretch.first) / rate_hz_,
                          .end_s = t0_s_ + static_cast<double>(stretch.first + stretch.count - 1) / rate_hz_,
                          .quantity = definition.quantity};
    measure.interval.level = options_.level;
    const auto& e = options_.envelope;
    measure.method = fmt::format("{:g} to {:g} Hz, {}", e.high_pass_hz, e.low_pass_hz,
                                 e.rms_window_s > 0.0 ? fmt::format("RMS of {:g} s", e.rms_window_s)
                                                      : fmt::format("envelope {:g} Hz", e.envelope_hz));
    const bool in_volts = which == kMean || which == kPeak || which == kRest;
    const double unit = in_volts && std::isfinite(most) ? 1.0 / most : 1.0;
    if (unit != 1.0) measure.quantity = Quantity::share;
    if (!std::isfinite(value)) {
      measure.remark = why_undetermined(which, known);
      out.measures.push_back(std::move(measure));
      return;
    }
    measure.value = measure.uncorrected = unit * value;
    if (options_.refits == 0) {
      measure.remark = "no interval was asked for";
    } else if (known.silent && which != kRest) {
      // What is simulated then is rest, with the strength of chance: its bias is not that of a muscle.
      measure.remark = "no interval: no burst rises above rest";
    } else if (const auto found = std::isnan(chance.sd) ? pivot(value, chance.deviations, options_.level)
                                                        : around_mean(value, chance.sd, options_.level);
               std::isfinite(found.value)) {
      put_interval(which, stretch, known, value, unit, found, measure);
    } else {
      measure.remark = "no interval: more than a tenth of the simulated channels do not determine it";
    }
    out.measures.push_back(std::move(measure));
  }

  void put_interval(int which, const EmgStretch& stretch, const Known& known, double value, double unit,
                    const Pivoted& found, data::Measure& measure) const {
    const bool instant = which == kPeakTime || which == kOnset || which == kEnd;
    const double last = static_cast<double>(stretch.count - 1) / rate_hz_;
    if (instant &&
        (found.high - found.low > kInstant * last || !(found.low <= value && value <= found.high))) {
      measure.remark = "no interval: other instants are nearly as good";
      return;
    }
    const auto bounded = [&](double x) {
      return instant ? std::clamp(x, 0.0, last) : unit * std::max(0.0, x);
    };
    if (!instant) measure.value = bounded(found.value);
    measure.sd = unit * found.sd;
    measure.interval = {.kind = data::IntervalKind::two_sided,
                        .low = bounded(found.low),
                        .high = bounded(found.high),
                        .level = options_.level,
                        .approximate = true};
    if (which != kMean && which != kRest) measure.method += fmt::format(", {} draws", options_.refits);
    const bool with_rest = which == kRms && known.found != Quiet::Found::bursts;
    if (which != kPeak && !with_rest) return;
    measure.interval.kind = data::IntervalKind::at_most;
    measure.interval.low = kNaN;
    measure.remark =
        with_rest ? "with what the channel has at rest, which is not known" : "chance can only raise it";
  }

  double rate_hz_, t0_s_;
  const EmgOptions& options_;
  std::vector<EmgStretch> stretches_;
};

// Cut to the samples; those of fewer than eight are left out. The whole recording where none is asked for.
std::vector<EmgStretch> stretches_within(const std::vector<EmgStretch>& asked, std::int64_t samples) {
  if (asked.empty()) return {{.count = samples}};
  std::vector<EmgStretch> out;
  for (auto stretch : asked) {
    const auto end = std::min<std::int64_t>(samples, stretch.first + stretch.count);
    stretch.first = std::max<std::int64_t>(0, stretch.first);
    stretch.count = end - stretch.first;
    if (stretch.count >= 8) out.push_back(std::move(stretch));
  }
  return out;
}

Status check(const EmgOptions& options) {
  if (auto s = options.envelope.check(); !s) return s;
  if (!(options.rest_s > 0.0) || !(options.burst_s >= 0.0))
    return fail(Code::usage,
                fmt::format("rest of {:g} s and bursts of {:g} s; need the first above 0 and the second not "
                            "negative",
                            options.rest_s, options.burst_s));
  for (const auto& id : options.measures)
    if (find_emg_definition(id) == nullptr)
      return fail(Code::usage, fmt::format("there is no measure '{}' of an EMG", id));
  return data::check_interval_refits(options.refits, options.level);
}

}  // namespace

std::span<const data::MeasureDefinition> emg_definitions() { return kDefinitions; }

const data::MeasureDefinition* find_emg_definition(std::string_view id) {
  for (const auto& definition : kDefinitions)
    if (definition.id == id) return &definition;
  return nullptr;
}

Result<EmgMeasures> measure_emg(const std::vector<EmgChannel>& channels, double rate_hz, double t0_s,
                                const EmgOptions& options) {
  if (auto s = check(options); !s) return std::unexpected(s.error());
  const auto least = static_cast<Index>(std::ceil(0.5 * rate_hz));
  std::vector<EmgMeasures> parts(channels.size());
  const auto measure_some = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t c = begin; c < end; ++c) {
      const auto& channel = channels[at(c)];
      const auto samples = channel.volts.size();
      if (samples < least || !channel.volts.allFinite()) {
        parts[at(c)].notes.push_back(
            samples < least ? fmt::format("{} is shorter than half a second", channel.name)
                            : fmt::format("{} has missing samples, and is not measured", channel.name));
        continue;
      }
      EmgMeasurement(rate_hz, t0_s, options, stretches_within(options.stretches, samples))
          .measure(channel, static_cast<std::uint64_t>(c) + 1, parts[at(c)]);
    }
  };
  parallel_for(std::ssize(channels), 1, options.threads, measure_some);
  EmgMeasures out;
  for (auto& part : parts) {
    std::ranges::move(part.measures, std::back_inserter(out.measures));
    std::ranges::move(part.names, std::back_inserter(out.names));
    std::ranges::move(part.envelopes, std::back_inserter(out.envelopes));
    std::ranges::move(part.notes, std::back_inserter(out.notes));
    std::ranges::move(part.contradicted, std::back_inserter(out.contradicted));
  }
  if (out.names.empty())
    return fail(Code::bad_input,
                out.notes.empty() ? std::string("there is no channel of an EMG") : out.notes.front());
  return out;
}

}  // namespace kinemark::analysis
