// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/simulation/neurons.h"

#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "kinemark/core/check.h"
#include "kinemark/core/random.h"

namespace kinemark::simulation {
namespace {

constexpr double kFieldRate_hz = 500.0;
constexpr int kFieldChannels = 4;
constexpr double kBeta_hz = 20.0;
constexpr std::uint64_t kTuningStream = 7001, kFieldStream = 7002, kUnitStream = 8000;

/// Velocity in each frame, by central differences, m/s.
std::vector<Eigen::Vector3d> velocity_of(const Array<double>& x, const TimeBase& time) {
  const auto place = [&](std::int64_t f) {
    return Eigen::Map<const Eigen::Vector3d>(x.data() + 3 * static_cast<std::size_t>(f));
  };
  std::vector<Eigen::Vector3d> out;
  for (std::int64_t f = 0; f < time.frames; ++f) {
    const std::int64_t before = std::max<std::int64_t>(0, f - 1), after = std::min(time.frames - 1, f + 1);
    out.emplace_back((place(after) - place(before)) * (time.rate_hz / static_cast<double>(after - before)));
  }
  return out;
}

double rms_speed(const std::vector<Eigen::Vector3d>& velocity) {
  double sum = 0.0;
  for (const auto& v : velocity) sum += v.squaredNorm();
  return std::sqrt(sum / static_cast<double>(velocity.size()));
}

/// A direction, uniform over the sphere.
Eigen::Vector3d draw_direction(Random& random) {
  const double z = random.uniform(-1.0, 1.0), turn = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double across = std::sqrt(1.0 - z * z);
  return {across * std::cos(turn), across * std::sin(turn), z};
}

/// Spikes of a rate that is `rate_hz[f]` from frame f to the next: arrivals of a unit process on the integral
/// of the rate.
std::vector<double> draw_spikes(const std::vector<double>& rate_hz, const TimeBase& time, Random random) {
  std::vector<double> out;
  const auto gap = [&random] { return -std::log1p(-random.uniform()); };
  double left = gap();  // of the integral, until the next spike
  for (std::int64_t f = 0; f < time.frames; ++f) {
    const double rate = rate_hz[static_cast<std::size_t>(f)];
    double at_s = 0.0;
    while (rate > 0.0) {
      const double wait_s = left / rate;
      if (at_s + wait_s >= 1.0 / time.rate_hz) break;
      at_s += wait_s;
      out.push_back(time.time_s(f) + at_s);
      left = gap();
    }
    left -= rate * (1.0 / time.rate_hz - at_s);
  }
  return out;
}

data::SpikeTrain draw_unit(int number, const std::vector<Eigen::Vector3d>& velocity, const TimeBase& time,
                           const NeuronOptions& options, Random& tuning) {
  const Eigen::Vector3d preferred = draw_direction(tuning);
  const double baseline_hz = tuning.uniform(5.0, 20.0), depth_hz = baseline_hz * tuning.uniform(0.5, 1.5);
  const double scale = std::max(1e-12, rms_speed(velocity));
  const auto lead = static_cast<std::int64_t>(std::llround(options.lead_s * time.rate_hz));
  std::vector<double> rate_hz;
  for (std::int64_t f = 0; f < time.frames; ++f) {
    const auto then = static_cast<std::size_t>(std::clamp<std::int64_t>(f + lead, 0, time.frames - 1));
    rate_hz.push_back(std::max(0.0, baseline_hz + depth_hz * preferred.dot(velocity[then]) / scale));
  }
  const auto text = [](double value) { return fmt::format("{:.6g}", value); };
  return {.id = fmt::format("{}", number),
          .labels = {{"baseline_hz", text(baseline_hz)},
                     {"depth_hz", text(depth_hz)},
                     {"preferred_x", text(preferred.x())},
                     {"preferred_y", text(preferred.y())},
                     {"preferred_z", text(preferred.z())}},
          .times_s = draw_spikes(rate_hz, time,
                                 Random(options.seed, kUnitStream + static_cast<std::uint64_t>(number)))};
}

/// Equal parts of the session, a tenth of each left out behind it.
data::IntervalTable make_trials(const Array<double>& x, const TimeBase& time, int count) {
  data::IntervalTable out{.name = "trials"};
  const double part_s = static_cast<double>(time.frames) / time.rate_hz / count;
  const auto mean_y = [&](double from_s, double to_s) {
    double sum = 0.0, frames = 0.0;
    for (std::int64_t f = 0; f < time.frames; ++f) {
      if (time.time_s(f) < from_s || time.time_s(f) > to_s) continue;
      sum += x[3 * static_cast<std::size_t>(f) + 1];
      frames += 1.0;
    }
    return frames > 0.0 ? sum / frames : 0.0;
  };
  std::vector<double> sides;
  for (int i = 0; i < count; ++i) {
    const double start_s = time.t0_s + part_s * i, stop_s = start_s + 0.9 * part_s;
    sides.push_back(mean_y(start_s, stop_s));
    out.rows.push_back({.start_s = start_s, .stop_s = stop_s, .labels = {}});
  }
  auto sorted = sides;
  std::ranges::sort(sorted);
  const double middle = sorted[sorted.size() / 2];
  for (std::size_t i = 0; i < sides.size(); ++i)
    out.rows[i].labels = {{"side", sides[i] >= middle ? "left" : "right"}};
  return out;
}

/// Noise of an AR(1) process, 50 uV, and a rhythm of 80 uV at rest.
data::FieldSamples draw_fields(const std::vector<Eigen::Vector3d>& velocity, const TimeBase& time,
                               std::uint64_t seed) {
  data::FieldSamples out{.name = "ElectricalSeries", .rate_hz = kFieldRate_hz, .t0_s = time.t0_s};
  for (int k = 0; k < kFieldChannels; ++k) out.channels.push_back(fmt::format("electrode {}", k));
  const auto samples =
      static_cast<std::int64_t>(static_cast<double>(time.frames) / time.rate_hz * kFieldRate_hz);
  const double scale = std::max(1e-12, rms_speed(velocity));
  std::vector<Random> random;
  for (int k = 0; k < kFieldChannels; ++k) random.emplace_back(seed, kFieldStream + static_cast<unsigned>(k));
  std::vector<double> slow(kFieldChannels, 0.0);
  out.values.resize(static_cast<std::size_t>(samples) * kFieldChannels);
  for (std::int64_t s = 0; s < samples; ++s) {
    const double at_s = static_cast<double>(s) / kFieldRate_hz;
    const auto frame = std::clamp<std::int64_t>(std::llround(at_s * time.rate_hz), 0, time.frames - 1);
    const double moving = velocity[static_cast<std::size_t>(frame)].norm() / scale;
    for (std::size_t k = 0; k < kFieldChannels; ++k) {
      slow[k] = 0.98 * slow[k] + 10e-6 * random[k].gaussian();
      const double phase = 2.0 * std::numbers::pi * kBeta_hz * at_s + 0.3 * static_cast<double>(k);
      out.values[static_cast<std::size_t>(s) * kFieldChannels + k] =
          slow[k] + 80e-6 * std::exp(-moving) * std::sin(phase);
    }
  }
  return out;
}

}  // namespace

Status NeuronOptions::check() const {
  if (units < 0 || units > 1000)
    return fail(Code::usage, fmt::format("units must be 0 to 1000, not {}", units));
  if (trials < 0 || trials > 1000)
    return fail(Code::usage, fmt::format("trials must be 0 to 1000, not {}", trials));
  if (!(std::abs(lead_s) <= 1.0))
    return fail(Code::usage, fmt::format("the lead of spikes must be -1 to 1 s, not {}", lead_s));
  return {};
}

Result<NeuralSession> simulate_neurons(const Array<double>& hand_in_world, const TimeBase& time,
                                       const NeuronOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  if (time.frames < 3) return fail(Code::usage, "neurons need a movement of 3 frames or more");
  kinemark::check(hand_in_world.size() == 3 * static_cast<std::size_t>(time.frames),
                  "a place of the hand for each frame");
  const auto velocity = velocity_of(hand_in_world, time);
  NeuralSession out;
  Random tuning(options.seed, kTuningStream);
  for (int u = 0; u < options.units; ++u)
    out.neural.units.push_back(draw_unit(u, velocity, time, options, tuning));
  if (options.trials > 0) out.neural.intervals.push_back(make_trials(hand_in_world, time, options.trials));
  if (options.field_potentials) out.fields.push_back(draw_fields(velocity, time, options.seed));
  return out;
}

}  // namespace kinemark::simulation
