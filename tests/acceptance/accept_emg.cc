// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Simulated electromyograms, of bursts of known strength: amplitudes, frequency and instants beside the
// truth: one long burst, and many short ones. Arguments: channels of each kind (default 60), first seed
// (default 1).
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/analysis/emg/emg_measures.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using Eigen::VectorXd;
using testing_support::print_row;

struct Judged {
  std::string id;
  double error;
  int inside;
};

// Instants at which bursts begin and end: one, or short ones one after the other.
struct Part {
  double begin, end;
};
std::vector<Part> bursts_of(Random& random, bool repeated) {
  if (!repeated) {
    const double begin = random.uniform(1.2, 1.8);
    return {{begin, begin + random.uniform(0.8, 1.6)}};
  }
  std::vector<Part> out;
  for (double t = 0.6; t < 4.4; t += random.uniform(0.4, 0.8))
    out.push_back({t, t + random.uniform(0.09, 0.16)});
  return out;
}

std::vector<Judged> judge(std::uint64_t seed, bool repeated) {
  Random random(seed, 41);
  const double rate_hz = random.uniform() < 0.5 ? 1000.0 : 2000.0;
  const auto n = static_cast<Eigen::Index>(5.0 * rate_hz);
  const auto bursts = bursts_of(random, repeated);
  const double begin = bursts.front().begin, end = bursts.back().end,
               rise = repeated ? 0.02 : random.uniform(0.05, 0.15);
  const double strong = 1e-4 * std::exp(random.uniform(0.0, 2.0)),
               quiet = strong * random.uniform(0.02, 0.08);
  VectorXd white(n);
  for (double& x : white) x = random.gaussian();
  const analysis::EnvelopeOptions band{.high_pass_hz = 25.0, .low_pass_hz = random.uniform(150.0, 350.0)};
  VectorXd noise = analysis::band_passed(white, rate_hz, band);
  VectorXd longer(16 * n);  // tells the power, and the frequency that halves it
  for (double& x : longer) x = random.gaussian();
  longer = analysis::band_passed(longer, rate_hz, band);
  noise /= std::sqrt(longer.squaredNorm() / static_cast<double>(longer.size()));
  VectorXd strength(n), signal(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double t = static_cast<double>(i) / rate_hz;
    const auto ramp = [rise](double x) {
      return 0.5 - 0.5 * std::cos(std::numbers::pi * std::clamp(x / rise, 0.0, 1.0));
    };
    strength[i] = 0.0;
    for (const auto& burst : bursts) strength[i] += strong * ramp(t - burst.begin) * ramp(burst.end - t);
    signal[i] = std::hypot(strength[i], quiet) * noise[i];
  }
  const auto first = static_cast<std::int64_t>((begin - 0.3) * rate_hz),
             count = static_cast<std::int64_t>((end - begin + 0.6) * rate_hz);
  const auto found =
      analysis::measure_emg({{.name = "EMG1", .volts = signal}}, rate_hz, 0.0,
                            {.stretches = {{.name = "burst", .first = first, .count = count}}, .seed = seed});
  std::vector<Judged> out;
  if (!found) return out;
  // What the strength itself gives: rectified noise of unit power is sqrt(2 / pi) on average.
  const auto part = strength.segment(first, count);
  const double rectified = std::sqrt(2.0 / std::numbers::pi);
  double mean = 0.0;
  for (const double s : part) mean += rectified * std::hypot(s, quiet) / static_cast<double>(count);
  std::map<std::string, double> truth{{"emg_mean", mean},
                                      {"emg_rest", rectified * quiet},
                                      {"emg_rms", std::sqrt(part.squaredNorm() / static_cast<double>(count))},
                                      {"emg_peak", rectified * part.maxCoeff()},
                                      {"emg_median_frequency", analysis::median_frequency(longer, rate_hz)}};
  if (repeated) truth.erase("emg_peak");  // the envelope's low-pass flattens bursts as short as these
  for (const auto& m : found->measures)
    if (const auto is = truth.find(m.id); is != truth.end() && m.interval.kind != data::IntervalKind::none)
      out.push_back({m.id, (m.value - is->second) / is->second,
                     !(is->second < m.interval.low) && is->second <= m.interval.high});
    else if (m.id == "emg_onset" && std::isfinite(m.value))
      out.push_back({m.id, m.value - 0.3, std::abs(m.value - 0.3) < 0.05});
    else if (m.id == "emg_end" && std::isfinite(m.value))
      out.push_back({m.id, m.value - 0.3 - (end - begin), std::abs(m.value - 0.3 - (end - begin)) < 0.05});
  return out;
}

void print_coverage(const char* kind, std::int64_t count, const std::vector<std::vector<Judged>>& all,
                    const std::vector<const char*>& ids, std::vector<Judged>& pooled) {
  std::map<std::string, std::vector<Judged>> by_id;
  for (const auto& one : all)
    for (const auto& judged : one) by_id[judged.id].push_back(judged);
  for (const char* id : ids) {
    const auto& some = by_id[id];
    double inside = 0.0, bias = 0.0, squares = 0.0;
    const double n = static_cast<double>(some.size());
    for (const auto& j : some)
      inside += 100.0 * j.inside / n, bias += j.error / n, squares += j.error * j.error / n;
    const bool instant = std::string(id) == "emg_onset" || std::string(id) == "emg_end";
    if (!instant && std::string(id) != "emg_peak") pooled.insert(pooled.end(), some.begin(), some.end());
    print_row(static_cast<std::int64_t>(some.size()) * 10 >= count * 9 && inside >= 85.0,
              fmt::format("EMG, simulated, {}: {}", kind, id),
              instant ? "within 50 ms of the muscle's in 85 %" : "about: covers 85 % or more",
              instant ? fmt::format("{:.1f} % of {:.0f}, mean error {:.0f} ms", inside, n, 1e3 * bias)
                      : fmt::format("{:.1f} % of {:.0f}, bias {:.1f} %, RMS error {:.1f} %", inside, n,
                                    100.0 * bias, 100.0 * std::sqrt(squares)));
  }
}

int run(int argc, char** argv) {
  const auto count = argc > 1 ? std::atoll(argv[1]) : 60;
  const auto first = argc > 2 ? static_cast<std::uint64_t>(std::atoll(argv[2])) : 1;
  std::vector<Judged> pooled;
  for (const bool repeated : {false, true}) {
    std::vector<std::vector<Judged>> all(at(count));
    parallel_for(count, 1, 0, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t k = begin; k < end; ++k)
        all[at(k)] = judge(first + static_cast<std::uint64_t>(k), repeated);
    });
    if (repeated)
      print_coverage("short bursts", count, all, {"emg_mean", "emg_rms", "emg_rest", "emg_median_frequency"},
                     pooled);
    else
      print_coverage(
          "a long burst", count, all,
          {"emg_mean", "emg_rms", "emg_rest", "emg_peak", "emg_median_frequency", "emg_onset", "emg_end"},
          pooled);
  }
  double inside = 0.0;
  for (const auto& j : pooled) inside += 100.0 * j.inside / static_cast<double>(pooled.size());
  print_row(inside >= 91.0 && inside <= 98.0, "EMG, simulated: intervals of 95 %",
            "hold 91 to 98 % of truths", fmt::format("{:.1f} % of {}", inside, pooled.size()));
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("emg", run);

}  // namespace
