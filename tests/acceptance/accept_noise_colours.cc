// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Measures of simulated movements under noise of many colours that nobody states: which colour is found, what
// the intervals hold, what has none.
// Arguments: movements of each family and colour (default 50), first seed (default 1), threads (default 0:
// all), share of recordings with a gap (default 0), colours separated by commas (default all).
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "acceptance/noise_kinds.h"
#include "acceptance/path_families.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/analysis/path/definitions.h"
#include "kinemark/stages/analysis/path/path_measures.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using math::SeriesMatrix;
using testing_support::print_note;
using testing_support::print_row;

enum class Expect { white, correlated, filtered, any };
struct Colour {
  std::string name;
  Expect expect;
  double withdrawn;  // per cent of extents, largest distance, boxes and plane that may have no interval
};
const std::vector<Colour> kColours{{"white", Expect::white, 3},           {"t3", Expect::white, 3},
                                   {"flicker", Expect::any, 10},          {"ar0.7", Expect::correlated, 70},
                                   {"ar0.9", Expect::correlated, 100},    {"ar0.99", Expect::correlated, 100},
                                   {"butterworth", Expect::filtered, 35}, {"spline", Expect::filtered, 35},
                                   {"smoother", Expect::filtered, 35}};

// Noise of a series, and what its filter does, in mm.
struct Spoiled {
  SeriesMatrix x;
  double three_db_hz = kNaN;
};

Spoiled spoiled(const Colour& colour, const SeriesMatrix& path, double sd, double rate, Random& random) {
  Spoiled out{.x = acceptance::with_noise_of_colour(colour.name, path, sd, random)};
  if (!acceptance::is_filtered(colour.name)) return out;
  const double hz = acceptance::draw_cutoff(rate, random);
  acceptance::low_pass(colour.name, hz, rate, out.x);
  out.three_db_hz = acceptance::three_db_of(colour.name, hz, rate, path.rows());
  return out;
}

struct Judged {
  std::string id;
  bool slow = false, tremor_family = false;
  data::IntervalKind kind = data::IntervalKind::none;
  bool covered = false;
  bool below_noise = false;
};
struct Trial {
  std::size_t colour = 0;
  std::string family;
  bool found = false, cut_off_right = true;
  std::vector<Judged> judged;
};

data::Trajectories recording_of(const SeriesMatrix& x_mm, double rate, bool gap, Random& random) {
  const std::int64_t n = x_mm.rows();
  auto out = data::Trajectories::all_missing({"P"}, {.rate_hz = rate, .frames = n});
  const auto length = gap ? static_cast<std::int64_t>(random.uniform(0.03, 0.1) * rate) + 1 : 0;
  const auto first = static_cast<std::int64_t>(random.uniform(0.2, 0.8) * static_cast<double>(n));
  for (std::int64_t i = 0; i < n; ++i) {
    if (i >= first && i < first + length) continue;
    out.x(i, 0) = 1e-3 * x_mm.row(i).transpose();
    out.state[out.index(i, 0)] = data::SampleState::measured;
  }
  return out;
}

bool is_found(const analysis::PathNoise& noise, Expect expect) {
  using math::NoiseKind;
  const auto kind = noise.model.kind;
  switch (expect) {
    case Expect::white:
      return kind == NoiseKind::white;
    case Expect::correlated:
      return kind == NoiseKind::correlated || kind == NoiseKind::correlated_and_white;
    case Expect::filtered:
      return kind == NoiseKind::filtered;
    case Expect::any:
      return true;
  }
  return false;
}

Trial measure_one(std::size_t colour, const std::string& family, std::uint64_t seed, double gaps) {
  Random random(seed, 11 + colour);
  const auto movement = acceptance::draw_movement(family, random);
  constexpr std::array kRates{60.0, 100.0, 120.0, 200.0};
  const double pick = random.uniform(), rate = kRates[pick < 0.3 ? 0 : pick < 0.6 ? 1 : pick < 0.9 ? 2 : 3];
  const double noise_mm = std::exp(random.uniform(std::log(0.1), std::log(3.0)));
  const auto path = acceptance::sample_movement(movement, rate);
  const auto recorded = spoiled(kColours[colour], 1e3 * path.x, noise_mm, rate, random);
  const auto markers = recording_of(recorded.x, rate, random.uniform() < gaps, random);
  const auto measured = analysis::measure_paths(markers, {.seed = seed});
  Trial out{.colour = colour, .family = family};
  if (!measured || measured->measures.empty()) return out;
  const auto& noise = measured->noises.front();
  out.found = is_found(noise, kColours[colour].expect);
  if (out.found && std::isfinite(recorded.three_db_hz))
    out.cut_off_right = std::abs(std::log(noise.cutoff_hz.middle / recorded.three_db_hz)) < std::log(1.5);
  const auto& one = measured->measures.front();
  const auto first = std::llround(one.start_s * rate), last = std::llround(one.end_s * rate);
  const analysis::PathSamples whole{.rate_hz = path.rate_hz,
                                    .x = path.x.middleRows(first, last - first + 1),
                                    .v = path.v.middleRows(first, last - first + 1),
                                    .a = path.a.middleRows(first, last - first + 1),
                                    .j = path.j.middleRows(first, last - first + 1)};
  auto frame = analysis::recognise(whole);
  frame.start_s = one.start_s;
  const analysis::PathFacts facts(whole, frame);
  for (const auto& measure : measured->measures)
    for (const auto& definition : analysis::path_definitions()) {
      if (definition.what.id != measure.id) continue;
      const double truth = definition.value(facts);
      if (!std::isfinite(truth) || !std::isfinite(measure.value)) continue;
      const auto& interval = measure.interval;
      out.judged.push_back({.id = measure.id,
                            .slow = definition.needs_slow_noise,
                            .tremor_family = family == "tremor",
                            .kind = interval.kind,
                            .covered = !(truth < interval.low) && !(truth > interval.high),
                            .below_noise = measure.remark.contains("about its slow trend")});
    }
  if (std::getenv("KINEMARK_SHOW") != nullptr)
    fmt::print(
        "SHOW | {} {} rate {} sd {:.3f} n {} | {} {} rho {:.2f} order {} | source {} from {:.1f} Hz range "
        "{:.2f}\n",
        kColours[colour].name, family, rate, noise_mm, path.x.rows(), to_string(noise.model.kind),
        1e3 * noise.sd_m() / noise_mm, noise.model.correlation, noise.model.order, to_string(noise.source),
        noise.above_hz, std::pow(noise.slow_sd_m.high / noise.slow_sd_m.low, 2));
  return out;
}

struct Count {
  int all = 0, held = 0;
  void add(bool holds) { ++all, held += holds; }
  [[nodiscard]] double share() const { return 100.0 * held / std::max(1, all); }
  [[nodiscard]] std::string text() const { return fmt::format("{:.1f} % of {}", share(), all); }
  /// Two deviations of a count that small, per cent: what chance alone may take away.
  [[nodiscard]] double chance(double per_cent) const {
    return 200.0 * std::sqrt(per_cent / 100.0 * (1.0 - per_cent / 100.0) / std::max(1, all));
  }
};

constexpr int kSlowMeasures = 8;  // of a trial, which have intervals or not together

// Of few movements chance alone takes some intervals away; of the many that bounds were asked for, nothing is
// allowed for it.
constexpr int kFewMovements = 10;  // of a family and colour

void judge_colour(std::size_t colour, const std::vector<Trial>& trials, bool few) {
  const auto& what = kColours[colour];
  Count pooled, upper, withdrawn, found, cut_off;
  for (const auto& trial : trials) {
    if (trial.colour != colour) continue;
    found.add(trial.found);
    if (trial.found) cut_off.add(trial.cut_off_right);
    for (const auto& one : trial.judged) {
      if (one.tremor_family) continue;
      if (one.slow && !one.below_noise) withdrawn.add(one.kind == data::IntervalKind::none);
      if (one.kind == data::IntervalKind::two_sided)
        pooled.add(one.covered);
      else if (one.kind != data::IntervalKind::none)
        upper.add(one.covered);
    }
  }
  const auto name = fmt::format("noise_colours, {}: ", what.name);
  const auto slack = [few](const Count& count, double per_cent) {
    return few ? count.chance(per_cent) : 0.0;
  };
  print_row(pooled.share() >= 91 - slack(pooled, 95) && pooled.share() <= 98 + slack(pooled, 95),
            name + "intervals with two ends", "91 to 98 %", pooled.text());
  print_row(upper.share() >= 97 - slack(upper, 97), name + "intervals with one end", "97 %", upper.text());
  const double together = std::sqrt(static_cast<double>(kSlowMeasures)) * slack(withdrawn, what.withdrawn);
  if (what.withdrawn < 100)
    print_row(withdrawn.share() <= what.withdrawn + together, name + "extents and plane without interval",
              fmt::format("at most {:g} %", what.withdrawn), withdrawn.text());
  else
    print_note(name + "extents and plane without interval", withdrawn.text());
  if (what.expect == Expect::any) return;
  const double least = what.expect == Expect::white ? 97 : 95;
  print_row(found.share() >= least - slack(found, least), name + "colour found", fmt::format("{:g} %", least),
            found.text());
  if (what.expect == Expect::filtered)
    print_row(cut_off.share() >= 95, name + "cut-off within a factor of 1.5", "95 %", cut_off.text());
}

void judge_measures(const std::vector<Trial>& trials) {
  std::map<std::string, std::pair<Count, Count>> by_id;
  for (const auto& trial : trials)
    for (const auto& one : trial.judged) {
      if (one.tremor_family && one.id != "tremor") continue;
      if (one.kind == data::IntervalKind::two_sided)
        by_id[one.id].first.add(one.covered);
      else if (one.kind != data::IntervalKind::none)
        by_id[one.id].second.add(one.covered);
    }
  for (const auto& [id, counts] : by_id) {
    const auto& [two, one] = counts;
    if (two.all >= 50) print_row(two.share() >= 85, "noise_colours, all: " + id, "85 %", two.text());
    if (one.all >= 50)
      print_row(one.share() >= 97, "noise_colours, all: " + id + ", one end", "97 %", one.text());
  }
  Count tremor;
  for (const auto& trial : trials)
    for (const auto& one : trial.judged)
      if (one.tremor_family && one.kind == data::IntervalKind::two_sided) tremor.add(one.covered);
  if (tremor.all > 0) print_note("noise_colours, all: movement in 4 to 12 Hz, all measures", tremor.text());
}

int run(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 50;
  const std::uint64_t first_seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const int threads = argc > 3 ? std::atoi(argv[3]) : 0;
  const double gaps = argc > 4 ? std::atof(argv[4]) : 0.0;
  const std::string only = argc > 5 ? fmt::format(",{},", argv[5]) : "";
  std::vector<std::size_t> colours;
  for (std::size_t c = 0; c < kColours.size(); ++c)
    if (only.empty() || only.contains("," + kColours[c].name + ",")) colours.push_back(c);
  const std::size_t families = acceptance::kFamilies.size();
  std::vector<Trial> trials(colours.size() * families * static_cast<std::size_t>(count));
  parallel_for(
      static_cast<std::int64_t>(trials.size()), 1, threads, [&](std::int64_t begin, std::int64_t end) {
        for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
          trials[i] =
              measure_one(colours[i % colours.size()], acceptance::kFamilies[i / colours.size() % families],
                          first_seed + i / colours.size(), gaps);
      });
  for (const auto colour : colours) judge_colour(colour, trials, count < kFewMovements);
  judge_measures(trials);
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("noise_colours", run);

}  // namespace
