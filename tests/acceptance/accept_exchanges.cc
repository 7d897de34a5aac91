// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Labels exchanged in real recordings, once, for a while, or to and fro: exchanged back to the bit, by the
// markers alone and by inverse kinematics, and nothing else touched.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "acceptance/ik_recordings.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/workflow/prepare/exchanged_labels.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using testing_support::print_note;
using testing_support::print_row;

constexpr const char* kKinds[] = {"single",    "held",      "every 2nd", "every 3rd",
                                  "every 4th", "every 5th", "irregular"};
constexpr int kKindCount = 7;
constexpr double kLeastApart_m = 0.03;  // nearer markers are not told apart, which is documented

struct Planted {
  std::int64_t one = -1, other = -1;
  std::vector<std::int64_t> frames;
};

std::vector<std::int64_t> frames_of(int kind, std::int64_t F, double rate_hz, Random& random) {
  const auto below = [&](double n) { return static_cast<std::int64_t>(random.uniform(0.0, 1.0) * n); };
  const auto first = below(static_cast<double>(F));
  if (kind == 0) return {first};
  const auto length = 3 + below((kind == 1 ? 0.5 : 1.5) * rate_hz);
  const std::int64_t step = kind == 6 ? 1 : kind;
  std::vector<std::int64_t> frames;
  for (auto f = first; f < std::min(F, first + length); f += step)
    if (kind != 6 || random.uniform(0.0, 1.0) < 0.35) frames.push_back(f);
  return frames;
}

/// Exchange two markers that are apart, seven times of ten of the same neighbourhood.
Planted plant(const data::Trajectories& clean, int kind, Random& random, data::Trajectories& t) {
  const auto M = clean.markers();
  const auto below = [&](std::int64_t n) {
    return std::min(n - 1, static_cast<std::int64_t>(random.uniform(0.0, 1.0) * static_cast<double>(n)));
  };
  for (int attempt = 0; attempt < 5000; ++attempt) {
    Planted p{.one = below(M),
              .other = below(M),
              .frames = frames_of(kind, clean.frames(), clean.time.rate_hz, random)};
    if (p.one == p.other || p.frames.empty()) continue;
    const bool near_wanted = attempt % 10 < 7;
    const bool good = std::ranges::all_of(p.frames, [&](std::int64_t f) {
      if (!clean.present(f, p.one) || !clean.present(f, p.other)) return false;
      const double apart = (clean.x(f, p.one) - clean.x(f, p.other)).norm();
      return apart > kLeastApart_m && (!near_wanted || apart < 0.5);
    });
    if (!good) continue;
    t = clean;
    for (const auto f : p.frames) {
      const Eigen::Vector3d x = t.x(f, p.one);
      t.x(f, p.one) = t.x(f, p.other);
      t.x(f, p.other) = x;
    }
    return p;
  }
  return {};
}

bool same_samples(const data::Trajectories& a, const data::Trajectories& b) {
  for (std::int64_t f = 0; f < a.frames(); ++f)
    for (std::int64_t m = 0; m < a.markers(); ++m)
      if (a.present(f, m) != b.present(f, m) || (a.present(f, m) && a.x(f, m) != b.x(f, m))) return false;
  return true;
}

/// The used markers of a recording, in the frames that are solved.
data::Trajectories used_part(const data::Trajectories& all, const data::MarkerFit& fit, std::int64_t frames) {
  std::vector<std::string> names;
  for (const auto& marker : fit.markers) names.push_back(marker.name_in_data);
  auto time = all.time;
  time.frames = frames;
  auto part = data::Trajectories::all_missing(names, time);
  for (std::int64_t m = 0; m < part.markers(); ++m) {
    const auto from = all.find(names[static_cast<std::size_t>(m)]);
    for (std::int64_t f = 0; f < frames; ++f) {
      if (!all.present(fit.first_frame + f, from)) continue;
      part.x(f, m) = all.x(fit.first_frame + f, from);
      part.state[part.index(f, m)] = data::SampleState::measured;
    }
  }
  return part;
}

struct Tally {
  int draws = 0, exact = 0, solved_as_clean = 0;
  std::int64_t left_out = 0, samples = 0;
};

/// bmc-rajagopal-run: the distance to the heel tells which frames are exchanged.
void check_toes(const testing_support::IkCase& c) {
  const auto& t = c.markers;
  const auto toe = t.find("RTOE"), side = t.find("RMT5"), heel = t.find("RCAL");
  std::vector<std::int64_t> nearer;
  for (std::int64_t f = 0; f < t.frames(); ++f)
    if ((t.x(f, toe) - t.x(f, heel)).norm() < (t.x(f, side) - t.x(f, heel)).norm()) nearer.push_back(f);
  data::Trial trial{.markers = t};
  trial.first_frame = 1;
  const auto swaps = workflow::sure_swaps(workflow::find_label_swaps(trial).value());
  const bool found = swaps.size() == 1 && swaps[0].frames == nearer;
  print_row(found, "running: toes by the markers alone",
            fmt::format("the {} frames in which the toe is nearer to the heel", nearer.size()),
            swaps.empty() ? "nothing" : sentence_of(swaps[0], t.time));
  const auto result = motion::solve_ik(c.model, t, c.options).value();
  std::string said;
  std::int64_t exchanged = 0, toes_left_out = 0;
  for (const auto& finding : result.fit.findings) {
    const bool of_toes = finding.subject == "RTOE" || finding.subject == "RMT5";
    if (of_toes && finding.kind == data::FindingKind::label_swap) {
      exchanged += finding.frame_count();
      said = sentence_of(finding, result.motion.time);
    }
    if (of_toes && finding.kind == data::FindingKind::outlier) toes_left_out += finding.frame_count();
  }
  print_row(std::abs(exchanged - std::ssize(nearer)) <= 2 && toes_left_out == 0,
            "running: toes by inverse kinematics", "exchanged in about 43 frames, left out in none",
            fmt::format("{}; left out in {}", said, toes_left_out));
}

/// accept_motion exchanges [draws=N] [seed=N] [RECORDING...]
int run_check(int argc, char** argv) {
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("exchanged labels");
  int draws = 200;
  std::uint64_t seed = 1;
  std::vector<std::string> named;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("draws="))
      draws = std::stoi(word.substr(6));
    else if (word.starts_with("seed="))
      seed = std::stoull(word.substr(5));
    else
      named.push_back(word);
  }
  struct Recording {
    std::string name;
    testing_support::IkCase c;
    motion::IkResult clean;
    data::Trajectories used;
  };
  std::vector<Recording> recordings;
  for (const auto& r : testing_support::ik_recordings()) {
    if (!named.empty() && std::ranges::find(named, r.name) == named.end()) continue;
    auto c = testing_support::open_ik_recording(*data, r);
    if (r.name == "running") check_toes(c);
    if (!r.defects.empty() || r.name == "arm") continue;  // known exchanges; three markers
    c.options.error_bars = false;
    auto clean = motion::solve_ik(c.model, c.markers, c.options).value();
    const bool swaps = std::ranges::any_of(
        clean.fit.findings, [](const auto& f) { return f.kind == data::FindingKind::label_swap; });
    print_row(!swaps, r.name + ": as it was recorded", "no exchange is said", swaps ? "one is" : "none");
    auto used = used_part(c.markers, clean.fit, clean.motion.frames());
    recordings.push_back({r.name, std::move(c), std::move(clean), std::move(used)});
  }
  if (recordings.empty()) return testing_support::exit_status();
  Tally all, by_kind[kKindCount];
  std::string worst;
  for (int draw = 0; draw < draws; ++draw) {
    Random random(seed, 0x65786368 + static_cast<std::uint64_t>(draw));
    const Recording& r = recordings[static_cast<std::size_t>(draw) % recordings.size()];
    const int kind = draw / static_cast<int>(recordings.size()) % kKindCount;
    data::Trajectories bad;
    const Planted p = plant(r.used, kind, random, bad);
    if (p.one < 0) continue;
    data::Trial trial{.markers = bad};
    const auto swaps = workflow::sure_swaps(workflow::find_label_swaps(trial).value());
    const bool undone = workflow::exchange_back(trial, swaps).has_value();
    const bool exact = undone && same_samples(trial.markers, r.used);
    // The same frames by inverse kinematics, in a copy of the recording.
    data::Trajectories whole = r.c.markers;
    for (const auto f : p.frames)
      for (const auto m : {p.one, p.other})
        whole.x(r.clean.fit.first_frame + f, whole.find(bad.names[static_cast<std::size_t>(m)])) =
            bad.x(f, m);
    const auto result = motion::solve_ik(r.c.model, whole, r.c.options).value();
    const bool as_clean = result.motion.q == r.clean.motion.q;
    std::int64_t out = 0;
    for (std::size_t i = 0; i < result.motion.marker_state.size(); ++i)
      out += result.motion.marker_state[i] == data::SampleState::rejected &&
             r.clean.motion.marker_state[i] != data::SampleState::rejected;
    for (Tally* tally : {&all, &by_kind[kind]}) {
      ++tally->draws;
      tally->exact += exact;
      tally->solved_as_clean += as_clean;
      tally->left_out += out;
      tally->samples += std::ssize(result.motion.marker_state);
    }
    if ((!exact || !as_clean) && worst.empty())
      worst = fmt::format("; draw {}: {} {} {} and {}, {} frames from {}", draw, r.name, kKinds[kind],
                          bad.names[static_cast<std::size_t>(p.one)],
                          bad.names[static_cast<std::size_t>(p.other)], p.frames.size(), p.frames.front());
  }
  const auto share = [](std::int64_t n, std::int64_t of) {
    return 100.0 * static_cast<double>(n) / static_cast<double>(std::max<std::int64_t>(1, of));
  };
  for (int kind = 0; kind < kKindCount; ++kind)
    print_note(fmt::format("exchanges, {}", kKinds[kind]),
               fmt::format("{} of {} exact by the markers, {} as clean by inverse kinematics",
                           by_kind[kind].exact, by_kind[kind].draws, by_kind[kind].solved_as_clean));
  print_row(share(all.exact, all.draws) >= 95.0, "exchanges: by the markers alone",
            "exchanged back exactly in 95 % at least",
            fmt::format("{} of {}{}", all.exact, all.draws, worst));
  print_row(share(all.solved_as_clean, all.draws) >= 95.0, "exchanges: by inverse kinematics",
            "angles of the clean recording, to the bit, in 95 % at least",
            fmt::format("{} of {}", all.solved_as_clean, all.draws));
  print_row(share(all.left_out, all.samples) <= 0.1, "exchanges: right samples left out", "at most 0.1 %",
            fmt::format("{:.4f} % of {}", share(all.left_out, all.samples), all.samples));
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("exchanges", run_check);

}  // namespace
