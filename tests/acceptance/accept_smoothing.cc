// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Filters and derivatives: the five movements of the reference, Butterworth, cross-validation.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "acceptance/movements.h"
#include "kinemark/math/digital_filter.h"
#include "kinemark/stages/trajectory/smoothing/smooth.h"
#include "support/acceptance.h"
#include "support/dense_spline.h"
#include "support/scipy_filtfilt.h"

namespace {

using namespace kinemark;
using testing_support::Axes;
using testing_support::kMovementFrames;
using testing_support::Movement;
using testing_support::print_row;
using trajectory::FilterMethod;
using trajectory::SmoothOptions;
using trajectory::SmoothResult;

/// Root mean square errors, 8 frames left out at both ends: velocity in mm/s, acceleration in m/s^2.
using Errors = std::array<double, 2>;

/// Mean square errors of one marker.
Errors squares(const SmoothResult& result, const Movement& movement, std::int64_t marker) {
  Errors sum{};
  double count = 0.0;
  for (int f = 8; f < kMovementFrames - 8; ++f) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::size_t i = 3 * result.trajectories.index(f, marker) + static_cast<std::size_t>(axis);
      const auto k = static_cast<std::size_t>(f);
      sum[0] += std::pow(1e3 * (result.derivatives.velocity[i] - movement.velocity[k]), 2);
      sum[1] += std::pow(result.derivatives.acceleration[i] - movement.acceleration[k], 2);
      count += 1.0;
    }
  }
  return {sum[0] / count, sum[1] / count};
}

Errors errors(const SmoothResult& result, const Movement& movement) {
  Errors sum{};
  const auto markers = static_cast<double>(result.markers.size());
  for (std::int64_t m = 0; m < std::ssize(result.markers); ++m)
    for (std::size_t d = 0; d < 2; ++d) sum[d] += squares(result, movement, m)[d] / markers;
  return {std::sqrt(sum[0]), std::sqrt(sum[1])};
}

SmoothOptions bridging() {
  SmoothOptions options;
  options.max_bridge_s = 1.0;
  options.max_bridge_sd_m = 1.0;
  return options;
}

/// Calls `visit(order, cut-off, result)` for every member of the family.
template <class Visit>
void each_member(const data::Trajectories& in, double sigma_m, double step, const Visit& visit) {
  for (int order = 3; order <= 5; ++order) {
    for (double cutoff_hz = 3.0; cutoff_hz < 20.0; cutoff_hz *= step) {
      SmoothOptions options = bridging();
      options.order = order;
      options.cutoff_hz = cutoff_hz;
      options.noise_sd_m = sigma_m;
      visit(options, trajectory::smooth(in, options).value());
    }
  }
}

/// Best order and bandwidth for each marker and derivative, knowing the truth and the noise.
Errors oracle(const data::Trajectories& in, const Movement& movement, double sigma_m) {
  constexpr double kBig = 1e300;
  std::vector<Errors> least(in.names.size(), Errors{kBig, kBig});
  each_member(in, sigma_m, 1.1, [&](const SmoothOptions&, const SmoothResult& result) {
    for (std::size_t m = 0; m < least.size(); ++m) {
      const Errors e = squares(result, movement, static_cast<std::int64_t>(m));
      for (std::size_t d = 0; d < 2; ++d) least[m][d] = std::min(least[m][d], e[d]);
    }
  });
  Errors sum{};
  for (const Errors& e : least)
    for (std::size_t d = 0; d < 2; ++d) sum[d] += e[d] / static_cast<double>(least.size());
  return {std::sqrt(sum[0]), std::sqrt(sum[1])};
}

/// The member that is best for each marker's gaps and each derivative on the average of 12 other draws of the
/// noise: all that can be chosen by knowing the movement itself, its spectrum included, and the noise's SD.
Errors informed(const data::Trajectories& in, const Movement& movement, double sigma_m, Axes axes) {
  constexpr int kDraws = 12;
  const auto markers = in.markers();
  std::vector<std::string> names;
  for (std::int64_t i = 0; i < kDraws * markers; ++i) names.push_back(std::to_string(i));
  auto others = data::Trajectories::all_missing(names, in.time);
  for (std::int64_t i = 0; i < kDraws * markers; ++i) {
    Random random(static_cast<std::uint64_t>(i), 0x696e666f726d);
    for (int f = 0; f < kMovementFrames; ++f) {
      Eigen::Vector3d noise(random.gaussian(), random.gaussian(), random.gaussian());
      if (axes == Axes::copies) noise.setConstant(noise[0]);
      if (!in.present(f, i % markers)) continue;
      others.x(f, i) = (sigma_m * noise).array() + movement.x[static_cast<std::size_t>(f)];
      others.state[others.index(f, i)] = data::SampleState::measured;
    }
  }
  std::vector<std::array<double, 2>> least(static_cast<std::size_t>(markers), {1e300, 1e300});
  std::vector<std::array<SmoothOptions, 2>> best(static_cast<std::size_t>(markers));
  each_member(others, sigma_m, 1.2, [&](const SmoothOptions& options, const SmoothResult& result) {
    for (std::int64_t m = 0; m < markers; ++m) {
      Errors sum{};
      for (int draw = 0; draw < kDraws; ++draw)
        for (std::size_t d = 0; d < 2; ++d) sum[d] += squares(result, movement, draw * markers + m)[d];
      for (std::size_t d = 0; d < 2; ++d)
        if (sum[d] < least[static_cast<std::size_t>(m)][d]) {
          least[static_cast<std::size_t>(m)][d] = sum[d];
          best[static_cast<std::size_t>(m)][d] = options;
        }
    }
  });
  Errors sum{};
  for (std::int64_t m = 0; m < markers; ++m)
    for (std::size_t d = 0; d < 2; ++d) {
      const auto result = trajectory::smooth(in, best[static_cast<std::size_t>(m)][d]).value();
      sum[d] += squares(result, movement, m)[d] / static_cast<double>(markers);
    }
  return {std::sqrt(sum[0]), std::sqrt(sum[1])};
}

constexpr const char* kMovementNames[] = {"wheel", "hand", "elbow", "reach", "tremor"};

/// The smoother against the best of its family: it is given nothing, not even the noise. Where the noise of
/// this very recording decides more than is asked, nobody can choose better than who knows the movement.
void against_the_oracle(const std::vector<Movement>& movements, int markers, std::uint64_t seed, Axes axes,
                        const std::string& which) {
  constexpr Errors kAsked = {1.05, 1.12};
  for (const double sigma_mm : {0.5, 0.1}) {
    for (const bool gaps : {false, true}) {
      std::string measured;
      bool passed = true;
      for (std::size_t k = 0; k < movements.size(); ++k) {
        const auto in = testing_support::seen_movement(movements[k], 1e-3 * sigma_mm, gaps, markers, seed,
                                                       7000 + 100 * k, axes);
        const Errors found = errors(trajectory::smooth(in, bridging()).value(), movements[k]);
        const Errors best = oracle(in, movements[k], 1e-3 * sigma_mm);
        measured +=
            fmt::format("{}{} {:.2f}/{:.3f} ({:+.1f}/{:+.1f} %", k > 0 ? ", " : "", kMovementNames[k],
                        found[0], found[1], 100 * (found[0] / best[0] - 1), 100 * (found[1] / best[1] - 1));
        if (found[0] > kAsked[0] * best[0] || found[1] > kAsked[1] * best[1]) {
          const Errors known = informed(in, movements[k], 1e-3 * sigma_mm, axes);
          measured += fmt::format("; knowing the movement {:+.1f}/{:+.1f} %", 100 * (known[0] / best[0] - 1),
                                  100 * (known[1] / best[1] - 1));
          for (std::size_t d = 0; d < 2; ++d)
            passed = passed && found[d] <= std::max(kAsked[d] * best[d], known[d]);
        }
        measured += ")";
      }
      print_row(
          passed,
          fmt::format("smoother beside its best member, {} mm{}, {}", sigma_mm, gaps ? ", gaps" : "", which),
          "velocity +5 %, acceleration +12 %, or what knowing the movement reaches", measured);
    }
  }
}

/// Interpolating natural cubic spline over the gaps of each axis: what the old chain did first.
data::Trajectories cubic_fill(data::Trajectories t) {
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    std::vector<std::int64_t> at;
    for (std::int64_t f = 0; f < t.frames(); ++f)
      if (t.present(f, m)) at.push_back(f);
    const auto n = static_cast<Eigen::Index>(at.size());
    Eigen::MatrixXd a = Eigen::MatrixXd::Identity(n, n), b = Eigen::MatrixXd::Zero(n, 3);
    const auto gap = [&](Eigen::Index i) {
      return static_cast<double>(at[static_cast<std::size_t>(i + 1)] - at[static_cast<std::size_t>(i)]);
    };
    const auto x = [&](Eigen::Index i) { return Eigen::Vector3d(t.x(at[static_cast<std::size_t>(i)], m)); };
    for (Eigen::Index i = 1; i + 1 < n; ++i) {
      a(i, i - 1) = gap(i - 1);
      a(i, i) = 2.0 * (gap(i - 1) + gap(i));
      a(i, i + 1) = gap(i);
      b.row(i) = 6.0 * ((x(i + 1) - x(i)) / gap(i) - (x(i) - x(i - 1)) / gap(i - 1)).transpose();
    }
    const Eigen::MatrixXd curvature = a.partialPivLu().solve(b);
    for (Eigen::Index i = 0; i + 1 < n; ++i) {
      const double h = gap(i);
      const Eigen::Vector3d from = x(i), to = x(i + 1);
      for (std::int64_t f = at[static_cast<std::size_t>(i)] + 1; f < at[static_cast<std::size_t>(i + 1)];
           ++f) {
        const double u = static_cast<double>(f - at[static_cast<std::size_t>(i)]), w = h - u;
        t.x(f, m) = (w * from + u * to) / h + ((w * w * w / h - h * w) * curvature.row(i).transpose() +
                                               (u * u * u / h - h * u) * curvature.row(i + 1).transpose()) /
                                                  6.0;
        t.state[t.index(f, m)] = data::SampleState::interpolated;
      }
    }
  }
  return t;
}

/// A column of the reference's table, velocity mm/s and acceleration m/s^2; 0 where it has no number.
struct Column {
  const char* name;
  SmoothOptions options;
  Errors table[3][5];   ///< 0.5 mm; 0.5 mm with gaps; 0.1 mm
  bool better_allowed;  ///< the table's smoothness was bounded from below, ours is not
};

std::vector<Column> columns() {
  const auto of = [](FilterMethod method, int order,
                     trajectory::CutoffRule rule = trajectory::CutoffRule::winter) {
    SmoothOptions options = bridging();
    options.method = method;
    options.order = order;
    options.cutoff_rule = rule;
    return options;
  };
  return {
      {"classic chain",
       of(FilterMethod::classic, 0),
       {{{8.70, 0.486}, {12.84, 0.628}, {10.37, 0.602}, {9.34, 0.537}, {11.83, 0.633}},
        {{12.34, 0.617}, {19.44, 0.891}, {15.81, 0.805}, {12.48, 0.636}, {15.86, 0.784}},
        {{2.82, 0.110}, {8.95, 0.357}, {}, {2.52, 0.179}, {}}},
       false},
      {"Butterworth, Winter's residual",
       of(FilterMethod::butterworth, 2),
       {{{5.95, 0.215}, {13.01, 0.616}, {11.57, 0.573}, {7.28, 0.325}, {13.55, 0.648}},
        {{8.96, 0.334}, {19.43, 0.880}, {15.51, 0.717}, {9.46, 0.384}, {16.64, 0.767}},
        {{2.80, 0.103}, {6.59, 0.307}, {}, {2.73, 0.185}, {}}},
       false},
      {"Butterworth, Challis",
       of(FilterMethod::butterworth, 2, trajectory::CutoffRule::challis),
       {{{6.04, 0.233}, {12.81, 0.633}, {11.06, 0.561}, {7.42, 0.326}, {11.93, 0.630}},
        {{9.02, 0.339}, {19.49, 0.909}, {15.31, 0.715}, {9.46, 0.375}, {15.87, 0.784}},
        {{2.83, 0.113}, {6.09, 0.319}, {}, {2.73, 0.185}, {}}},
       false},
      {"GCV quintic",
       of(FilterMethod::gcv, 3),
       {{{4.98, 0.208}, {9.96, 0.620}, {8.98, 0.522}, {6.41, 0.317}, {8.92, 0.499}},
        {{5.15, 0.206}, {11.58, 0.677}, {10.32, 0.560}, {6.91, 0.332}, {10.94, 0.573}},
        {{2.01, 0.126}, {3.46, 0.320}, {}, {2.23, 0.171}, {}}},
       false},
      {"GCV heptic",
       of(FilterMethod::gcv, 4),
       {{{2.90, 0.073}, {7.43, 0.344}, {8.29, 0.449}, {6.27, 0.304}, {7.57, 0.360}},
        {{3.07, 0.075}, {8.68, 0.388}, {9.37, 0.482}, {6.69, 0.318}, {8.67, 0.398}},
        {{0.86, 0.030}, {2.14, 0.132}, {}, {2.21, 0.168}, {}}},
       false},
      {"GCV nonic",
       of(FilterMethod::gcv, 5),
       {{{3.57, 0.105}, {6.87, 0.292}, {7.95, 0.416}, {6.29, 0.304}, {6.90, 0.305}},
        {{3.78, 0.105}, {8.05, 0.334}, {9.06, 0.452}, {6.75, 0.319}, {7.63, 0.329}},
        {{0.95, 0.035}, {1.76, 0.093}, {}, {2.22, 0.169}, {}}},
       true},
  };
}

/// The table's own noise, seed 1 and its streams: six repeats of one coordinate.
void against_the_table(const std::vector<Movement>& movements) {
  constexpr const char* kConditions[] = {"0.5 mm", "0.5 mm, gaps", "0.1 mm"};
  for (const Column& column : columns()) {
    for (std::size_t condition = 0; condition < 3; ++condition) {
      double low = 0.0, high = 0.0;
      std::string measured;
      for (std::size_t k = 0; k < movements.size(); ++k) {
        const Errors& table = column.table[condition][k];
        if (table[0] == 0.0) continue;
        auto in = testing_support::seen_movement(movements[k], condition == 2 ? 1e-4 : 5e-4, condition == 1,
                                                 6, 1, 7000 + 100 * k, Axes::copies);
        if (column.options.method != FilterMethod::gcv) in = cubic_fill(in);
        const Errors found = errors(trajectory::smooth(in, column.options).value(), movements[k]);
        for (std::size_t d = 0; d < 2; ++d) {
          low = std::min(low, found[d] / table[d] - 1.0);
          high = std::max(high, found[d] / table[d] - 1.0);
        }
        measured += fmt::format("{}{} {:.2f}/{:.3f}", measured.empty() ? "" : ", ", kMovementNames[k],
                                found[0], found[1]);
      }
      print_row(high <= 0.10 && (column.better_allowed || low >= -0.10),
                fmt::format("{}, {}: the reference's column", column.name, kConditions[condition]),
                column.better_allowed ? "+10 %, or better" : "within 10 %",
                fmt::format("{:+.1f} to {:+.1f} %: {}", 100 * low, 100 * high, measured));
    }
  }
}

void butterworth() {
  double worst = 0.0;
  const auto signal = testing_support::filtfilt_signal();
  auto in = data::Trajectories::all_missing({"x"}, {100.0, 0.0, 120});
  for (int i = 0; i < 120; ++i) {
    in.x(i, 0).setConstant(signal[static_cast<std::size_t>(i)]);
    in.state[static_cast<std::size_t>(i)] = data::SampleState::measured;
  }
  SmoothOptions options;
  options.method = FilterMethod::butterworth;
  options.correct_cutoff = false;
  for (const auto& reference : testing_support::kFiltfilt) {
    options.order = reference.order;
    options.cutoff_hz = 100.0 * reference.cutoff;
    const auto out = trajectory::smooth(in, options).value();
    for (int i = 0; i < 7; ++i)
      worst = std::max(worst,
                       std::abs(out.trajectories.x(testing_support::kFiltfiltAt[i], 0).x() - reference.y[i]));
  }
  print_row(worst <= 1e-9, "Butterworth beside scipy's filtfilt, orders 2, 4, 6, 8", "1e-9",
            fmt::format("{:.1e}", worst));

  // A long sine at the cut-off itself: how much of it comes out?
  double off = 0.0;
  options.correct_cutoff = true;
  for (const int order : {2, 4, 6, 8, 10}) {
    for (const double cutoff_hz : {1.0, 6.0, 20.0, 45.0}) {
      // -3 dB is met at the frequency f where the amplitude falls through 1 / sqrt 2: bisection on measured
      // sines.
      const auto passes = [&](double f) {
        auto sine = data::Trajectories::all_missing({"x"}, {100.0, 0.0, 4000});
        for (int i = 0; i < 4000; ++i) {
          const double phase = 2.0 * M_PI * f * i / 100.0;
          sine.x(i, 0) = Eigen::Vector3d(std::sin(phase), std::cos(phase), 0.0);
          sine.state[static_cast<std::size_t>(i)] = data::SampleState::measured;
        }
        options.order = order;
        options.cutoff_hz = cutoff_hz;
        const auto out = trajectory::smooth(sine, options).value();
        double power = 0.0;
        for (int i = 1500; i < 2500; ++i) power += out.trajectories.x(i, 0).squaredNorm() / 1000.0;
        return std::sqrt(power);
      };
      double low = 0.97 * cutoff_hz, high = 1.03 * cutoff_hz;
      for (int i = 0; i < 14; ++i) {
        const double middle = 0.5 * (low + high);
        (passes(middle) > std::sqrt(0.5) ? low : high) = middle;
      }
      off = std::max(off, std::abs(0.5 * (low + high) / cutoff_hz - 1.0));
    }
  }
  print_row(off <= 1e-3, "Butterworth: -3 dB of both passes, orders 2 to 10, 1 to 45 Hz of 100", "0.1 %",
            fmt::format("{:.4f} %", 100 * off));
}

void cross_validation() {
  // Woltring's criterion of the spline itself, all samples at once in extended precision.
  double worst = 0.0;
  constexpr int kSamples = 50;
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Random random(seed, 5);
    std::vector<double> t, y;
    auto in = data::Trajectories::all_missing({"x"}, {100.0, 0.0, kSamples});
    for (int i = 0; i < kSamples; ++i) {
      t.push_back(i / 100.0);
      y.push_back(0.1 * std::sin(11.0 * t.back()) + 0.002 * random.gaussian());
      in.x(i, 0).setConstant(y.back());
      in.state[static_cast<std::size_t>(i)] = data::SampleState::measured;
    }
    for (int order = 3; order <= 5; ++order) {
      for (const double cutoff_hz : {3.0, 8.0, 20.0}) {
        SmoothOptions options;
        options.method = FilterMethod::gcv;
        options.order = order;
        options.cutoff_hz = cutoff_hz;
        const auto out = trajectory::smooth(in, options).value();
        // (f / cut-off)^(2 m) = sqrt 2 - 1 at the corner w; p = sigma^2 / q = 1 / (w^(2m) dt)
        const double corner = 2.0 * M_PI * cutoff_hz / std::pow(std::sqrt(2.0) - 1.0, 0.5 / order);
        const testing_support::DenseSpline exact(t, y, std::vector<double>(kSamples, 1.0), order,
                                                 0.01 * std::pow(corner, 2 * order));
        worst = std::max(worst, std::abs(out.markers[0].candidates.at(0).criterion / exact.gcv() - 1.0));
      }
    }
  }
  print_row(worst <= 1e-6, "GCV beside Woltring's criterion of the dense spline, quintic to nonic",
            "1e-6 relative", fmt::format("{:.1e}", worst));
}

int run_check(int argc, char** argv) {
  const std::string part = argc > 1 ? argv[1] : "quick";
  const auto movements = testing_support::movements();
  if (part == "fresh") {
    const std::uint64_t first = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 11;
    for (std::uint64_t seed = first; seed < first + 3; ++seed)
      against_the_oracle(movements, 8, seed, Axes::independent, fmt::format("seed {}", seed));
  } else if (part == "one_coordinate") {
    against_the_oracle(movements, 6, 1, Axes::copies, "one coordinate, the reference's noise");
  } else {
    butterworth();
    cross_validation();
    against_the_table(movements);
    against_the_oracle(movements, 2, 1, Axes::independent, "the reference's noise");
  }
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("smoothing", run_check);

}  // namespace
