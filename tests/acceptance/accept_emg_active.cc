// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The share of the time that a muscle is active, beside the truth: muscles that are always or never active,
// one burst, many, steps and rises, hum of the mains, and motor units that fire at gamma-distributed
// intervals. Arguments: channels of each family (default 30), first seed (default 1).
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
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
using Eigen::Index;
using Eigen::VectorXd;
using testing_support::print_note;
using testing_support::print_row;

struct Family {
  const char* name;
  bool is_determined = true;
  bool many = false, rises = false, hum = false, units = false;
  bool is_figure = false;  ///< nothing is asked of it
};

constexpr std::array kFamilies{
    Family{.name = "never active", .is_determined = false},
    Family{.name = "always active", .is_determined = false},
    Family{.name = "always active, modulated", .is_determined = false, .is_figure = true},
    Family{.name = "one burst"},
    Family{.name = "one burst that rises", .rises = true, .is_figure = true},
    Family{.name = "one burst, hum of 50 Hz", .hum = true},
    Family{.name = "one burst of motor units", .units = true},
    Family{.name = "many bursts", .many = true},
    Family{.name = "many bursts that rise", .many = true, .rises = true},
    Family{.name = "many bursts, hum of 50 Hz", .many = true, .hum = true},
    Family{.name = "many bursts of motor units", .many = true, .rises = true, .units = true},
};

VectorXd unit_noise(Index n, double rate_hz, double low_hz, double high_hz, Random& random) {
  VectorXd white(n);
  for (double& x : white) x = random.gaussian();
  VectorXd out = analysis::band_passed(white, rate_hz, {.high_pass_hz = low_hz, .low_pass_hz = high_hz});
  return out / std::sqrt(out.squaredNorm() / static_cast<double>(n));
}

// A sum of gamma variates of shape 8 at the rate of each unit, a biphasic pulse at each.
VectorXd motor_units(Index n, double rate_hz, Random& random) {
  VectorXd out = VectorXd::Zero(n);
  constexpr int kUnits = 40, kShape = 8;
  for (int unit = 0; unit < kUnits; ++unit) {
    const double fires_hz = random.uniform(8.0, 25.0), width = random.uniform(0.8e-3, 2e-3),
                 size = std::exp(0.5 * random.gaussian());
    const auto reach = static_cast<Index>(6e-3 * rate_hz);
    for (double t = random.uniform(0.0, 0.1); t * rate_hz < static_cast<double>(n);) {
      const Index at_s = std::llround(t * rate_hz);
      for (Index i = std::max<Index>(0, at_s - reach); i < std::min(n, at_s + reach); ++i) {
        const double x = (static_cast<double>(i) / rate_hz - t) / width;
        out[i] += size * x * std::exp(-0.5 * x * x);
      }
      double gamma = 0.0;
      for (int k = 0; k < kShape; ++k) gamma -= std::log(1.0 - random.uniform());
      t += gamma / (fires_hz * kShape);
    }
  }
  return out / std::sqrt(out.squaredNorm() / static_cast<double>(n));
}

struct Planted {
  VectorXd volts;
  double rate_hz = 0.0, share = 0.0;
};

Planted plant(const Family& family, std::uint64_t seed) {
  Random random(seed, 43);
  Planted out{.rate_hz = random.uniform() < 0.5 ? 1000.0 : 2000.0};
  const std::array lengths{5.0, 10.0, 20.0};
  const double length = lengths[static_cast<std::size_t>(3.0 * random.uniform())],
               snr = std::exp(random.uniform(std::log(3.0), std::log(30.0)));
  const auto n = static_cast<Index>(length * out.rate_hz);
  VectorXd strength = VectorXd::Zero(n);
  const std::string name = family.name;
  const auto add = [&](double begin, double end, double rise, bool is_cosine) {
    for (Index i = 0; i < n; ++i) {
      const double t = static_cast<double>(i) / out.rate_hz;
      if (t <= begin || t >= end) continue;
      const auto share = [&](double x) {
        const double u = rise > 0.0 ? std::clamp(x / rise, 0.0, 1.0) : 1.0;
        return is_cosine ? 0.5 - 0.5 * std::cos(std::numbers::pi * u) : u;
      };
      strength[i] += share(t - begin) * share(end - t);
    }
    out.share += (end - begin) / length;
  };
  if (name == "always active") {
    strength.setOnes();
  } else if (name == "always active, modulated") {
    const double depth = random.uniform(0.3, 0.8), hz = random.uniform(0.5, 2.0),
                 phase = random.uniform(0.0, 6.0);
    for (Index i = 0; i < n; ++i)
      strength[i] =
          1.0 + depth * std::sin(2.0 * std::numbers::pi * hz * static_cast<double>(i) / out.rate_hz + phase);
  } else if (family.is_determined) {
    const int bursts = family.many ? static_cast<int>(length * random.uniform(0.5, 1.2)) : 1;
    const double period = length / bursts;
    const double rise = family.rises ? random.uniform(0.03, family.many ? 0.1 : 0.3) : 0.0;
    const bool is_cosine = random.uniform() < 0.5;
    for (int b = 0; b < bursts; ++b) {
      const double own = period * (family.many ? random.uniform(0.2, 0.7) : random.uniform(0.05, 0.88)),
                   begin = period * b + random.uniform(0.02, std::max(0.03, period - own - 0.02));
      add(begin, begin + own, std::min(rise, own / 3.0), is_cosine);
    }
  }
  const VectorXd muscle = family.units
                              ? motor_units(n, out.rate_hz, random)
                              : unit_noise(n, out.rate_hz, 25.0, random.uniform(150.0, 350.0), random);
  VectorXd rest = unit_noise(n, out.rate_hz, 20.0, 400.0, random);
  if (family.hum) {
    const double phase = random.uniform(0.0, 6.0);
    for (Index i = 0; i < n; ++i)
      rest[i] = std::sqrt(0.5) * rest[i] +
                std::sin(2.0 * std::numbers::pi * 50.0 * static_cast<double>(i) / out.rate_hz + phase);
  }
  out.volts = 1e-5 * (rest + snr * strength.cwiseProduct(muscle));
  return out;
}

struct Seen {
  bool determined = false, inside = false;
  double error = 0.0, width = 0.0;
};

Seen judge(const Family& family, std::uint64_t seed) {
  const auto planted = plant(family, seed);
  const auto found = analysis::measure_emg({{.name = "EMG1", .volts = planted.volts}}, planted.rate_hz, 0.0,
                                           {.measures = {"emg_active"}, .seed = seed});
  Seen out;
  if (!found || found->measures.empty()) return out;
  const auto& m = found->measures.front();
  out.determined = std::isfinite(m.value);
  out.error = m.value - planted.share;
  out.width = m.interval.high - m.interval.low;
  out.inside = m.interval.low <= planted.share && planted.share <= m.interval.high;
  return out;
}

int run(int argc, char** argv) {
  const auto count = argc > 1 ? std::atoll(argv[1]) : 30;
  const auto first = argc > 2 ? static_cast<std::uint64_t>(std::atoll(argv[2])) : 1;
  for (const auto& family : kFamilies) {
    std::vector<Seen> all(at(count));
    parallel_for(count, 1, 0, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t k = begin; k < end; ++k)
        all[at(k)] = judge(family, first + static_cast<std::uint64_t>(k));
    });
    double determined = 0.0, inside = 0.0, bias = 0.0, squares = 0.0, width = 0.0;
    for (const auto& seen : all)
      if (seen.determined) {
        determined += 1.0, inside += seen.inside ? 1.0 : 0.0, bias += seen.error;
        squares += seen.error * seen.error, width += seen.width;
      }
    const double n = static_cast<double>(count), some = std::max(1.0, determined);
    const auto title = fmt::format("EMG, share active: {}", family.name);
    const auto measured = fmt::format(
        "{:.0f} of {:.0f} determined; intervals hold the truth in {:.1f} %, bias {:.2f}, RMS error "
        "{:.2f}, width {:.2f} %",
        determined, n, 100.0 * inside / some, 100.0 * bias / some, 100.0 * std::sqrt(squares / some),
        100.0 * width / some);
    if (family.is_figure)
      print_note(title, measured);
    else if (!family.is_determined)
      print_row(determined <= 0.02 * n, title, "not determined in 98 %", measured);
    else
      print_row(determined >= 0.9 * n && inside >= 0.85 * determined, title,
                "determined in 90 %; intervals hold the truth in 85 %", measured);
  }
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("emg_active", run);

}  // namespace
