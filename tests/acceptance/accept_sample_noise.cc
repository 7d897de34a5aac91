// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What single samples err by under noise of many colours that nobody states: twelve markers of one recording,
// each with a size of its own, beside the path that the recording would show without noise.
// Arguments: recordings of each family and colour (default 20), first seed (default 1).
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <set>
#include <string>
#include <vector>

#include "acceptance/noise_kinds.h"
#include "acceptance/path_families.h"
#include "kinemark/core/parallel.h"
#include "kinemark/stages/analysis/path/marker_noise.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using math::SeriesMatrix;
using testing_support::print_row;

constexpr std::int64_t kMarkers = 12;
constexpr std::array kRates{60.0, 100.0, 120.0, 200.0};

/// What is asked of a colour. Slow noise cannot be told from movement: deviations must not be far too small.
/// Noise as slow as movement (AR 0.99) must be said to be open.
/// Of flickers, which are left out as outliers, the deviation holds nothing.
enum class Ask { all, slow, coverage, open };
struct Colour {
  std::string name;
  Ask ask;
};
const std::vector<Colour> kAll{{"white", Ask::all},  {"t3", Ask::all},          {"flicker", Ask::coverage},
                               {"ar0.7", Ask::all},  {"ar0.9", Ask::slow},      {"ar0.99", Ask::open},
                               {"spline", Ask::all}, {"butterworth", Ask::all}, {"smoother", Ask::all}};

/// Sums over samples of one recording.
struct Sums {
  double samples = 0.0, within_one = 0.0, within_two = 0.0, squares = 0.0, stated = 0.0;
  double open = 0.0;           ///< markers whose noise is said to be open
  std::vector<double> ratios;  ///< stated over true, of each marker

  void add(const Sums& other) {
    samples += other.samples, within_one += other.within_one, within_two += other.within_two;
    squares += other.squares, stated += other.stated, open += other.open;
    ratios.insert(ratios.end(), other.ratios.begin(), other.ratios.end());
  }
};

Sums measure_one(const std::string& colour, const std::string& family, std::uint64_t seed) {
  Random random(seed, 31);
  const double rate = kRates[static_cast<std::size_t>(random.uniform(0.0, 3.999))];
  const double usual_mm = std::exp(random.uniform(std::log(0.1), std::log(2.0)));
  const double cutoff = acceptance::draw_cutoff(rate, random);
  // Markers of one body: the same movement from another side, with a share of its own.
  const auto movement = acceptance::draw_movement(family, random);
  const SeriesMatrix path = 1e3 * acceptance::sample_movement(movement, rate).x;
  const auto frames = path.rows();
  std::vector<std::string> names;
  for (std::int64_t m = 0; m < kMarkers; ++m) names.push_back(fmt::format("M{}", m));
  auto markers = data::Trajectories::all_missing(names, {.rate_hz = rate, .frames = frames});
  std::vector<SeriesMatrix> truth;
  std::set<std::int64_t> which;
  for (std::int64_t m = 0; m < kMarkers; ++m) {
    which.insert(m);
    SeriesMatrix clean = path * random.uniform(0.3, 1.0);
    const double sd = usual_mm * std::exp(0.3 * random.gaussian());
    auto noisy = acceptance::with_noise_of_colour(colour, clean, sd, random);
    if (acceptance::is_filtered(colour)) {
      acceptance::low_pass(colour, cutoff, rate, clean);
      acceptance::low_pass(colour, cutoff, rate, noisy);
    }
    for (std::int64_t f = 0; f < frames; ++f) {
      markers.x(f, m) = 1e-3 * noisy.row(f).transpose();
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
    truth.push_back(std::move(clean));
  }
  const auto noise = analysis::MarkerNoise::find(markers, which, seed, 1);
  Sums out;
  for (std::int64_t m = 0; m < kMarkers; ++m) {
    const double sd = 1e3 * noise.sample_sd_m(m);
    out.open += noise.of(m) == nullptr || analysis::leaves_size_open(*noise.of(m));
    double squares = 0.0;
    for (std::int64_t f = 0; f < frames; ++f)
      for (int k = 0; k < 3; ++k) {
        const double error = std::abs(1e3 * markers.x(f, m)[k] - truth[static_cast<std::size_t>(m)](f, k));
        out.within_one += error <= sd, out.within_two += error <= 1.96 * sd;
        squares += error * error;
      }
    const double n = 3.0 * static_cast<double>(frames);
    out.samples += n, out.squares += squares, out.stated += n * sd * sd;
    out.ratios.push_back(sd / std::sqrt(squares / n));
  }
  return out;
}

void judge(const Colour& colour, const std::string& families, Sums& sums) {
  const double one = 100.0 * sums.within_one / sums.samples, two = 100.0 * sums.within_two / sums.samples;
  std::ranges::sort(sums.ratios);
  const auto at_share = [&](double share) {
    return sums.ratios[static_cast<std::size_t>(share * static_cast<double>(sums.ratios.size() - 1))];
  };
  const double pooled = std::sqrt(sums.stated / sums.squares);
  const auto measured =
      fmt::format("{:.1f} / {:.1f} %, stated / true {:.2f} pooled, {:.2f} to {:.2f} in 90 % of {} markers",
                  one, two, pooled, at_share(0.05), at_share(0.95), sums.ratios.size());
  const auto name = fmt::format("samples under {} noise, {}", colour.name, families);
  const double open = 100.0 * sums.open / static_cast<double>(sums.ratios.size());
  const bool size = pooled >= 0.7 && pooled <= (colour.ask == Ask::slow ? 2.0 : 1.5);
  const bool covers = one >= 60 && one <= 90 && two >= 90;
  switch (colour.ask) {
    case Ask::all:
      return print_row(covers && size, name, "60-90 / 90-100 %, stated / true 0.7-1.5", measured);
    case Ask::coverage:
      return print_row(covers, name, "60-90 / 90-100 %", measured);
    case Ask::slow:
      return print_row(two >= 84 && size, name, "84-100 % within 2 SD, stated / true 0.7-2", measured);
    case Ask::open:
      return print_row(open >= 95, name, "said to be open in 95 % of markers",
                       fmt::format("{:.1f} %; {}", open, measured));
  }
}

int run(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 20;
  const std::uint64_t first = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  const std::size_t families = acceptance::kFamilies.size(), kinds = kAll.size();
  std::vector<Sums> all(kinds * families * static_cast<std::size_t>(count));
  parallel_for(std::ssize(all), 1, 0, [&](std::int64_t begin, std::int64_t end) {
    for (auto i = static_cast<std::size_t>(begin); i < static_cast<std::size_t>(end); ++i)
      all[i] =
          measure_one(kAll[i % kinds].name, acceptance::kFamilies[i / kinds % families], first + i / kinds);
  });
  for (std::size_t c = 0; c < kinds; ++c) {
    Sums pooled;
    for (std::size_t f = 0; f < families; ++f) {
      Sums sums;
      for (std::size_t i = c + kinds * f; i < all.size(); i += kinds * families) sums.add(all[i]);
      pooled.add(sums);
      if (std::getenv("KINEMARK_SHOW") != nullptr) judge(kAll[c], acceptance::kFamilies[f], sums);
    }
    judge(kAll[c], "all movements", pooled);
  }
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("sample_noise", run);

}  // namespace
