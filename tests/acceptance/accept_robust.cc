// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One corrupted sample, or stretch of samples, in real recordings: no angle may go wrong without a word.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <numbers>
#include <set>

#include "acceptance/ik_recordings.h"
#include "kinemark/core/random.h"
#include "kinemark/core/units.h"
#include "kinemark/stages/motion/control/track.h"
#include "kinemark/stages/motion/ik.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using testing_support::print_note;
using testing_support::print_row;

enum class Kind { spike, zero, swap, held, exchange };
constexpr const char* kKinds[] = {"spike", "zero", "swap", "held", "exchange"};

/// What was done to a recording: markers by their index among the used ones.
struct Corruption {
  std::vector<int> markers;
  std::int64_t first = 0, last = 0;  // frames of the motion
  double size_m = 0.0;
};

enum class Method { ik, track };

/// What both estimators say.
struct Estimate {
  data::JointMotion motion;
  data::MarkerFit fit;
};

struct Case : testing_support::IkCase {
  Method method = Method::ik;
  Estimate clean;
  std::vector<std::int64_t> column;  // of each used marker in the recording
};

Result<Estimate> estimate(const Case& c, const data::Trajectories& markers, bool judged, bool error_bars) {
  if (c.method == Method::ik) {
    auto options = c.options;
    options.judge_samples = judged;
    options.error_bars = error_bars;
    auto result = motion::solve_ik(c.model, markers, options);
    if (!result) return std::unexpected(result.error());
    return Estimate{.motion = std::move(result->motion), .fit = std::move(result->fit)};
  }
  auto result = motion::track_markers(c.model, markers,
                                      {.marker_weights = c.options.marker_weights,
                                       .limits = c.options.limits,
                                       .judge_samples = judged,
                                       .first_time_s = c.options.first_time_s,
                                       .last_time_s = c.options.last_time_s,
                                       .error_bars = error_bars});
  if (!result) return std::unexpected(result.error());
  return Estimate{.motion = std::move(result->motion), .fit = std::move(result->fit)};
}

/// The marker of the other side, or -1.
int other_side(const std::vector<data::FittedMarker>& markers, int m) {
  std::string name = markers[static_cast<std::size_t>(m)].name;
  const auto flip = [](char c) {
    return c == 'L' ? 'R' : c == 'R' ? 'L' : c == 'l' ? 'r' : c == 'r' ? 'l' : c;
  };
  name[0] = flip(name[0]);
  for (int k = 0; k < static_cast<int>(markers.size()); ++k)
    if (k != m && markers[static_cast<std::size_t>(k)].name == name) return k;
  return -1;
}

Corruption corrupt(const Case& c, Kind kind, std::uint64_t seed, data::Trajectories& t) {
  Random random(seed, 0x726f62 + static_cast<std::uint64_t>(kind));
  const auto below = [&](std::int64_t n) {
    return std::min<std::int64_t>(
        n - 1, static_cast<std::int64_t>(random.uniform(0.0, 1.0) * static_cast<double>(n)));
  };
  const auto F = c.clean.motion.frames();
  const auto M = static_cast<std::int64_t>(c.column.size());
  const auto f0 = c.clean.fit.first_frame;
  const auto x = [&](std::int64_t f, int m) { return t.x(f0 + f, c.column[static_cast<std::size_t>(m)]); };
  const auto there = [&](std::int64_t f, int m) {
    return t.present(f0 + f, c.column[static_cast<std::size_t>(m)]);
  };
  for (int attempt = 0; attempt < 1000; ++attempt) {
    Corruption done;
    const int m = static_cast<int>(below(M));
    done.first = done.last = below(F);
    if (!there(done.first, m)) continue;
    done.markers = {m};
    if (kind == Kind::spike) {
      Eigen::Vector3d d(random.gaussian(), random.gaussian(), random.gaussian());
      done.size_m = 0.03 * std::pow(500.0 / 30.0, random.uniform(0.0, 1.0));
      x(done.first, m) += done.size_m * d.normalized();
    } else if (kind == Kind::zero) {
      const auto axis = below(3);
      done.size_m = std::abs(x(done.first, m)[axis]);
      x(done.first, m)[axis] = 0.0;
      if (x(done.first, m).isZero()) continue;
    } else if (kind == Kind::held) {
      const auto n = std::max<std::int64_t>(2, std::llround(0.2 * t.time.rate_hz));
      const Eigen::Vector3d value = x(done.first, m);
      for (std::int64_t f = done.first; f < std::min(F, done.first + n); ++f) {
        if (!there(f, m)) break;
        done.size_m = std::max(done.size_m, (x(f, m) - value).norm());
        x(f, m) = value;
        done.last = f;
      }
    } else {
      int k = kind == Kind::swap ? other_side(c.clean.fit.markers, m) : -1;
      while (k < 0 || k == m) k = static_cast<int>(below(M));
      const auto n = kind == Kind::swap ? 1 : std::max<std::int64_t>(2, std::llround(0.5 * t.time.rate_hz));
      if (!there(done.first, k)) continue;
      for (std::int64_t f = done.first; f < std::min(F, done.first + n); ++f) {
        if (!there(f, m) || !there(f, k)) break;
        const Eigen::Vector3d a = x(f, m), b = x(f, k);
        done.size_m = std::max(done.size_m, (a - b).norm());
        x(f, m) = b;
        x(f, k) = a;
        done.last = f;
      }
      done.markers.push_back(k);
    }
    return done;
  }
  return {};
}

/// Joints between each body and the nearest touched one.
std::vector<int> joints_away(const Case& c, const Corruption& done) {
  const auto& d = c.model.description();
  std::vector<int> away(d.bodies.size(), 1000);
  for (const int m : done.markers)
    for (std::size_t b = 0; b < d.bodies.size(); ++b)
      if (d.bodies[b].name == c.clean.fit.markers[static_cast<std::size_t>(m)].body) away[b] = 0;
  for (std::size_t round = 0; round < d.bodies.size(); ++round)
    for (const auto& joint : d.joints) {
      if (joint.parent_body_idx < 0) continue;
      auto& parent = away[static_cast<std::size_t>(joint.parent_body_idx)];
      auto& child = away[static_cast<std::size_t>(joint.child_body_idx)];
      parent = std::min(parent, child + 1);
      child = std::min(child, parent + 1);
    }
  std::vector<int> of_coordinate(d.coordinates.size(), 1000);
  for (const auto& joint : d.joints)
    for (const auto& axis : joint.axes)
      if (axis.coordinate_idx >= 0) {
        auto& a = of_coordinate[static_cast<std::size_t>(axis.coordinate_idx)];
        a = std::min(a, away[static_cast<std::size_t>(joint.child_body_idx)]);
        if (joint.parent_body_idx >= 0)
          a = std::min(a, away[static_cast<std::size_t>(joint.parent_body_idx)]);
      }
  return of_coordinate;
}

struct Tally {
  int draws = 0, missed = 0, found = 0, innocent = 0;
  double worst_deg = 0.0;
  double worst_far_deg = 0.0;  ///< of joints between bodies that were not touched
  std::string worst, worst_far;
};

void compare(const Case& c, const Corruption& done, const Estimate& r, std::uint64_t seed, Tally& tally) {
  const auto& a = c.clean.motion;
  const auto& b = r.motion;
  std::vector<std::uint8_t> found(static_cast<std::size_t>(a.frames()), 0);
  for (const auto& finding : r.fit.findings)
    if (finding.first_frame >= 0)
      for (auto f = finding.first_frame; f <= finding.last_frame; ++f) found[static_cast<std::size_t>(f)] = 1;
  for (std::size_t f = 0; f < found.size(); ++f)
    if (b.status[f] == data::FrameStatus::not_converged) found[f] = 1;  // the frame itself says so
  const auto away = joints_away(c, done);
  bool missed = false;
  double worst = 0.0;
  for (std::int64_t f = 0; f < a.frames(); ++f)
    for (std::int64_t k = 0; k < a.size(); ++k) {
      const auto i = a.index(f, k);
      if (!a.is_rotation[static_cast<std::size_t>(k)] || !b.determined[i] || !a.determined[i]) continue;
      const double off = kDegPerRad * std::abs(b.q[i] - a.q[i]);
      const auto where = [&] {
        return fmt::format("seed {}: {} frame {}, SD {:.1f}, {} in frames {} to {} by {:.0f} mm", seed,
                           a.coordinates[static_cast<std::size_t>(k)], f, kDegPerRad * b.q_sd[i],
                           c.clean.fit.markers[static_cast<std::size_t>(done.markers[0])].name, done.first,
                           done.last, 1e3 * done.size_m);
      };
      if (away[static_cast<std::size_t>(k)] > 0 && off > tally.worst_far_deg) {
        tally.worst_far_deg = off;
        tally.worst_far = where();
      }
      if (found[static_cast<std::size_t>(f)]) continue;
      const double sd = kDegPerRad * b.q_sd[i];
      if (off > 2.0 && !(off <= 3.5 * sd)) {
        missed = true;
        if (off > worst) {
          worst = off;
          if (off > tally.worst_deg) tally.worst = where();
          tally.worst_deg = std::max(tally.worst_deg, off);
        }
      }
    }
  ++tally.draws;
  tally.missed += missed;
  bool left_out = false;
  for (std::int64_t f = 0; f < a.frames(); ++f)
    for (std::size_t m = 0; m < c.column.size(); ++m) {
      const auto i = static_cast<std::size_t>(f) * c.column.size() + m;
      const bool out = b.marker_state[i] == data::SampleState::rejected &&
                       a.marker_state[i] != data::SampleState::rejected;
      const bool guilty = f >= done.first && f <= done.last &&
                          std::ranges::find(done.markers, static_cast<int>(m)) != done.markers.end();
      left_out = left_out || (out && guilty);
      tally.innocent += out && !guilty;
    }
  tally.found += left_out;
}

/// accept_motion robust [track] [RECORDING...] [kind=KIND] [draws=N] [seed=N]
int run_check(int argc, char** argv) {
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("corrupted samples");
  int draws = 100;
  Method method = Method::ik;
  std::uint64_t first_seed = 1;
  std::set<std::string> named, kinds;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("draws="))
      draws = std::stoi(word.substr(6));
    else if (word.starts_with("seed="))
      first_seed = std::stoull(word.substr(5));
    else if (word.starts_with("kind="))
      kinds.insert(word.substr(5));
    else if (word == "track")
      method = Method::track;
    else
      named.insert(word);
  }
  for (const auto& r : testing_support::ik_recordings()) {
    if (!named.empty() && !named.contains(r.name)) continue;
    Case c{testing_support::open_ik_recording(*data, r), method, {}, {}};
    double judged_s = 1e9, plain_s = 1e9;
    Estimate without;
    // Deviations are part of what tracking costs, and inverse kinematics is judged without them.
    const bool bars = method == Method::track;
    const auto processor_s = [&](bool judged, Estimate& result) {
      const auto begin = std::clock();
      result = estimate(c, c.markers, judged, bars).value();
      return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    };
    for (int i = 0; i < (bars ? 5 : 15); ++i) {
      plain_s = std::min(plain_s, processor_s(false, without));
      judged_s = std::min(judged_s, processor_s(true, c.clean));
    }
    c.clean = estimate(c, c.markers, true, true).value();
    for (const auto& marker : c.clean.fit.markers) c.column.push_back(c.markers.find(marker.name_in_data));
    const std::string name = method == Method::track ? "track, " + r.name : r.name;
    const auto samples = std::ssize(c.clean.motion.marker_state);
    const auto bad = std::ranges::count(c.clean.motion.marker_state, data::SampleState::rejected);
    const double share = 100.0 * static_cast<double>(bad) / static_cast<double>(samples);
    const bool same = without.motion.q == c.clean.motion.q;
    const auto measured = fmt::format("{} of {} samples left out ({:.3f} %); angles {}", bad, samples, share,
                                      same ? "the same" : "differ");
    if (r.defects.empty())
      print_row(share <= 0.1 && (same || bad > 0), name + ": as it was recorded",
                "at most 0.1 % of the samples left out; same angles", measured);
    else
      print_note(name + ": as it was recorded", measured + "; known: " + r.defects);
    print_note(name + ": processor time", fmt::format("{:.2f} times that without judging ({:.1f} ms)",
                                                      judged_s / plain_s, 1e3 * plain_s));
    for (const Kind kind : {Kind::spike, Kind::zero, Kind::swap, Kind::held, Kind::exchange}) {
      const char* word = kKinds[static_cast<int>(kind)];
      if (!kinds.empty() && !kinds.contains(word)) continue;
      Tally tally;
      for (std::uint64_t seed = first_seed; seed < first_seed + static_cast<std::uint64_t>(draws); ++seed) {
        data::Trajectories corrupted = c.markers;
        const auto done = corrupt(c, kind, seed, corrupted);
        compare(c, done, estimate(c, corrupted, true, true).value(), seed, tally);
      }
      print_row(
          tally.missed == 0, fmt::format("{}: {}", name, word),
          "no angle more than 3.5 SD and 2 deg off without a finding on that frame",
          fmt::format("{} of {} missed, worst {:.1f} deg; left out in {}; {} other samples left out {}",
                      tally.missed, tally.draws, tally.worst_deg, tally.found, tally.innocent, tally.worst));
      const auto far = fmt::format("{:.2f} deg ({})", tally.worst_far_deg, tally.worst_far);
      const auto what = fmt::format("{}: {}, joints between untouched segments", name, word);
      if (kind == Kind::held || kind == Kind::exchange || !r.defects.empty())
        print_note(what, far);
      else
        print_row(tally.worst_far_deg <= 0.5, what, "within 0.5 deg", far);
    }
  }
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("robust", run_check);

}  // namespace
