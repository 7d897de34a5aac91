// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Artificial gaps of known truth in real trials: errors of each method, and whether the error bars of
// `automatic` are right. Usage: accept_gaps GAPS_PER_CELL [SEED] [table]
#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>
#include <string>
#include <tuple>
#include <vector>

#include "acceptance/gap_trials.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/trajectory/gaps/candidates.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using namespace kinemark::testing_support;

constexpr std::array kLengthsS = {0.1, 0.25, 0.5, 1.0, 2.0};
constexpr std::array<const char*, 3> kCases = {"one marker", "half of a segment", "a whole segment"};
constexpr std::array<std::array<double, 5>, 3> kAsked = {
    {{0.40, 0.25, 0.13, 0.05, 0.04}, {0.50, 0.30, 0.19, 0.08, 0.06}, {0.60, 0.40, 0.30, 0.16, 0.11}}};
constexpr std::int64_t kMaxFrames = 2400;

/// One gap: where, and what came out.
struct Target {
  std::size_t trial = 0;
  int what = 0;    // index into kCases
  int length = 0;  // index into kLengthsS
  std::int64_t marker = 0, first = 0, frames = 0;
  std::vector<std::int64_t> blocked;
  std::map<std::string, double> rms_m;  // "auto" and candidates
  double inside_1 = 0.0, inside_2 = 0.0, coordinates = 0.0;
  std::int64_t window_frames = 0;
};

double rms(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return std::sqrt((a - b).squaredNorm() / static_cast<double>(a.rows()));
}

void draw_targets(const GapTrial& trial, std::size_t index, int gaps, std::uint64_t seed,
                  std::vector<Target>& out) {
  const data::Trajectories& t = trial.markers;
  const double rate = t.time.rate_hz;
  const auto support = static_cast<std::int64_t>(std::clamp(std::round(0.3 * rate), 6.0, 60.0));
  std::map<std::int64_t, std::vector<std::int64_t>> segments;
  Random random(seed, 100 + index);
  const auto draw = [&](std::int64_t n) {
    return std::min(n - 1, static_cast<std::int64_t>(random.uniform() * static_cast<double>(n)));
  };
  for (int l = 0; l < static_cast<int>(kLengthsS.size()); ++l) {
    const std::int64_t frames =
        std::max<std::int64_t>(2, std::lround(kLengthsS[static_cast<std::size_t>(l)] * rate));
    if (static_cast<double>(t.frames()) <
        2.9 * static_cast<double>(frames) + 2.0 * static_cast<double>(support))
      continue;
    for (int what = 0; what < 3; ++what) {
      int done = 0;
      for (int tries = 0; tries < 8 * gaps + 4 && done < gaps; ++tries) {
        Target g{.trial = index, .what = what, .length = l};
        g.marker = draw(t.markers());
        g.first = support + draw(t.frames() - frames - 2 * support + 1);
        g.frames = frames;
        if (!complete(t, g.marker, g.first - support, g.first + frames + support)) continue;
        g.blocked = {g.marker};
        if (what > 0) {
          auto& segment = segments[g.marker];
          if (segment.empty()) segment = find_segment(t, g.marker);
          if (segment.size() < (what == 1 ? 3U : 2U)) continue;
          g.blocked = segment;
          if (what == 1) {  // half of it, at least two, the target among them
            for (std::size_t k = segment.size() - 1; k > 1; --k)
              std::swap(g.blocked[k],
                        g.blocked[1 + static_cast<std::size_t>(draw(static_cast<std::int64_t>(k)))]);
            g.blocked.resize(std::max<std::size_t>(2, (segment.size() + 1) / 2));
          }
        }
        out.push_back(std::move(g));
        ++done;
      }
    }
  }
}

void run(const GapTrial& trial, Target& g) {
  data::Trajectories t = trial.markers;
  Eigen::MatrixXd truth(g.frames, 3);
  for (std::int64_t i = 0; i < g.frames; ++i) truth.row(i) = t.x(g.first + i, g.marker).transpose();
  for (const std::int64_t m : g.blocked)
    for (std::int64_t i = 0; i < g.frames; ++i) t.set_missing(g.first + i, m);
  const auto result = trajectory::compare_candidates(t, g.marker, g.first, g.first + g.frames - 1);
  if (!result) throw std::runtime_error(trial.file + ": " + result.error().message);
  const trajectory::GapCandidates& found = *result;
  g.rms_m["auto"] = rms(found.x_in_world, truth);
  for (const auto& c : found.candidates) g.rms_m[c.name] = rms(c.x_in_world, truth);
  g.window_frames = found.window_frames;
  if (found.windows == 0) return;
  const std::int64_t rows = std::min<std::int64_t>(24, g.frames);  // each gap counts about the same
  for (std::int64_t r = 0; r < rows; ++r) {
    const std::int64_t i = rows == 1 ? 0 : r * (g.frames - 1) / (rows - 1);
    for (int axis = 0; axis < 3; ++axis) {
      const double z = std::abs(found.x_in_world(i, axis) - truth(i, axis)) / found.sd_m(i);
      g.inside_1 += z < 1.0 ? 1.0 : 0.0;
      g.inside_2 += z < 2.0 ? 1.0 : 0.0;
      g.coordinates += 1.0;
    }
  }
}

double of(const Target& g, const std::string& method) {
  const auto at = g.rms_m.find(method);
  return at != g.rms_m.end() ? at->second : g.rms_m.at("pchip");  // what is filled in where it cannot work
}

using Cell = std::tuple<std::size_t, int, int>;  // trial, case, length

/// RMS of each cell.
std::map<Cell, double> cell_rms(const std::vector<Target>& targets, const std::string& method) {
  std::map<Cell, std::pair<double, double>> sums;
  for (const Target& g : targets) {
    auto& [square, n] = sums[{g.trial, g.what, g.length}];
    square += of(g, method) * of(g, method);
    n += 1.0;
  }
  std::map<Cell, double> out;
  for (const auto& [cell, s] : sums) out[cell] = std::sqrt(s.first / s.second);
  return out;
}

/// Geometric mean over cells of a / b.
double mean_ratio(const std::map<Cell, double>& a, const std::map<Cell, double>& b, int what = -1,
                  int length = -1) {
  double sum = 0.0;
  double n = 0.0;
  for (const auto& [cell, value] : a) {
    if ((what >= 0 && std::get<1>(cell) != what) || (length >= 0 && std::get<2>(cell) != length)) continue;
    sum += std::log(value / b.at(cell));
    n += 1.0;
  }
  return std::exp(sum / n);
}

double pooled(const std::vector<Target>& targets, const std::string& method) {
  double sum = 0.0;
  for (const Target& g : targets) sum += of(g, method) * of(g, method);
  return 1e3 * std::sqrt(sum / static_cast<double>(targets.size()));
}

void print_table(const std::vector<Target>& targets, const std::vector<GapTrial>& trials,
                 const std::vector<std::string>& methods) {
  std::map<std::string, std::map<Cell, double>> cells;
  for (const auto& m : methods) cells[m] = cell_rms(targets, m);
  fmt::print("{:22}", "method / cubic");
  for (const char c : {'a', 'b', 'c'})
    for (const double l : kLengthsS) fmt::print(" {}{:<5}", c, l);
  fmt::print("  all  pooled mm\n");
  for (const auto& m : methods) {
    fmt::print("{:22}", m);
    for (int c = 0; c < 3; ++c)
      for (int l = 0; l < 5; ++l) fmt::print(" {:.3f} ", mean_ratio(cells[m], cells["cubic"], c, l));
    fmt::print(" {:.4f} {:.2f}\n", mean_ratio(cells[m], cells["cubic"]), pooled(targets, m));
  }
  fmt::print("{:22}", "coverage");
  for (int c = 0; c < 3; ++c)
    for (int l = 0; l < 5; ++l) {
      double one = 0.0, two = 0.0, n = 0.0;
      for (const Target& g : targets)
        if (g.what == c && g.length == l) {
          one += g.inside_1;
          two += g.inside_2;
          n += g.coordinates;
        }
      fmt::print(" {:2.0f}/{:2.0f} ", 100 * one / n, 100 * two / n);
    }
  fmt::print("\n");
  for (std::size_t k = 0; k < trials.size(); ++k) {
    double one = 0.0, two = 0.0, n = 0.0, a = 0.0, c = 0.0;
    int count = 0, shortened = 0;
    for (const Target& g : targets)
      if (g.trial == k) {
        one += g.inside_1;
        two += g.inside_2;
        n += g.coordinates;
        a += of(g, "auto") * of(g, "auto");
        c += of(g, "cubic") * of(g, "cubic");
        ++count;
        shortened += g.window_frames < g.frames ? 1 : 0;
      }
    fmt::print(
        "{:50} {:4} targets {:3} shortened, {} frames {} markers, auto {:.2f} mm cubic {:.1f} mm, "
        "{:.0f}/{:.0f}\n",
        trials[k].file, count, shortened, trials[k].markers.frames(), trials[k].markers.markers(),
        1e3 * std::sqrt(a / count), 1e3 * std::sqrt(c / count), 100 * one / n, 100 * two / n);
  }
  std::vector<const Target*> worst;
  for (const Target& g : targets) worst.push_back(&g);
  std::ranges::sort(worst, std::ranges::greater{}, [](const Target* g) { return of(*g, "auto"); });
  for (std::size_t k = 0; k < std::min<std::size_t>(12, worst.size()); ++k) {
    const Target& g = *worst[k];
    std::string best;
    double least = std::numeric_limits<double>::infinity();
    for (const auto& [m, v] : g.rms_m)
      if (v < least) {
        least = v;
        best = m;
      }
    fmt::print("worst: {} case {} {} s marker {} frame {}: auto {:.1f} mm, best {} {:.1f}\n",
               trials[g.trial].file, g.what, kLengthsS[static_cast<std::size_t>(g.length)], g.marker, g.first,
               1e3 * of(g, "auto"), best, 1e3 * least);
  }
}

int run_check(int argc, char** argv) {
  const auto data = test_data_folder();
  if (!data) return skip_all("artificial gaps in real trials");
  const int gaps = argc > 1 ? std::atoi(argv[1]) : 7;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 1;
  std::vector<GapTrial> trials;
  std::vector<Target> targets;
  for (const std::string& file : gap_trial_files()) {
    trials.push_back(load_gap_trial(*data, file, kMaxFrames, seed + trials.size(), false));
    draw_targets(trials.back(), trials.size() - 1, gaps, seed, targets);
  }
  parallel_for(static_cast<std::int64_t>(targets.size()), 1, 0, [&](std::int64_t a, std::int64_t b) {
    for (std::int64_t k = a; k < b; ++k) {
      Target& g = targets[static_cast<std::size_t>(k)];
      run(trials[g.trial], g);
    }
  });
  std::vector<std::string> methods;
  for (const Target& g : targets)
    for (const auto& [name, value] : g.rms_m)
      if (std::ranges::find(methods, name) == methods.end()) methods.push_back(name);
  if (argc > 3) print_table(targets, trials, methods);

  const auto ours = cell_rms(targets, "auto");
  const auto cubic = cell_rms(targets, "cubic");
  for (int c = 0; c < 3; ++c)
    for (int l = 0; l < 5; ++l) {
      const double asked = kAsked[static_cast<std::size_t>(c)][static_cast<std::size_t>(l)];
      const double ratio = mean_ratio(ours, cubic, c, l);
      print_row(ratio <= asked,
                fmt::format("gaps, {}, {} s: auto against cubic", kCases[static_cast<std::size_t>(c)],
                            kLengthsS[static_cast<std::size_t>(l)]),
                fmt::format("geometric mean of RMS <= {:.2f}", asked), fmt::format("{:.3f}", ratio));
    }
  std::string next, next_pooled;
  double best = std::numeric_limits<double>::infinity();
  double best_pooled = best;
  for (const std::string& m : methods) {
    if (m == "auto") continue;
    const double ratio = mean_ratio(cell_rms(targets, m), ours);
    if (ratio < best) {
      best = ratio;
      next = m;
    }
    if (pooled(targets, m) < best_pooled) {
      best_pooled = pooled(targets, m);
      next_pooled = m;
    }
  }
  print_row(best >= 1.0,
            "gaps, every single method against auto, geometric mean over trials, cases and lengths",
            "none better", fmt::format("best is {}, {:.3f} times as far off", next, best));
  print_row(best_pooled >= pooled(targets, "auto"), "gaps, every single method against auto, pooled RMS",
            "none better",
            fmt::format("auto {:.2f} mm, {} {:.2f} mm, {} targets", pooled(targets, "auto"), next_pooled,
                        best_pooled, targets.size()));
  double one = 0.0, two = 0.0, n = 0.0;
  for (const Target& g : targets) {
    one += g.inside_1;
    two += g.inside_2;
    n += g.coordinates;
  }
  print_row(one >= 0.65 * n && one <= 0.80 * n && two >= 0.90 * n && two <= 0.96 * n,
            "gaps, coverage of auto, pooled", "65 to 80 % at 1 SD, 90 to 96 % at 2 SD",
            fmt::format("{:.1f} %, {:.1f} %", 100 * one / n, 100 * two / n));
  return exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("gaps", run_check);

}  // namespace
