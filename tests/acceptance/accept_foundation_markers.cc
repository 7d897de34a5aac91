// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Each marker of each static trial in reach, 30, 50 and 80 mm elsewhere, in the static trial and in the walk
// beside it, judged as `scale` (against a model) and `segments --definition pig --static` (by names, and
// beside the walk) judge them.
// Arguments: every how-manieth shift (default 1), seed (default 2911).
#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

#include "acceptance/static_trials.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/motion/foundations/judge.h"
#include "kinemark/stages/motion/foundations/landmarks.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using Eigen::Vector3d;
using testing_support::StaticCase;

constexpr std::array kSizes{0.030, 0.050, 0.080};

struct Tally {
  int planted = 0, named = 0, other = 0;
  [[nodiscard]] double share() const { return planted > 0 ? static_cast<double>(named) / planted : 0.0; }
  [[nodiscard]] std::string words() const {
    return fmt::format("{:.1f} % ({} of {}; another one named in {})", 100.0 * share(), named, planted,
                       other);
  }
};

struct Group {
  std::string name;
  Tally all = {}, at_50_mm = {};
  std::map<std::string, Tally> parts = {};
  int clean = 0, accused = 0;
  std::string accusations = {};
  double said_at_50_mm = 0.0;  // sum of what judgements of the clean trials say
  int walks_spoilt = 0, contradictions = 0, stills_blamed = 0;
  std::string blamed = {};
};

std::string part_of(const std::string& marker) {
  constexpr std::array kParts{"pelvis", "thigh",     "shank",   "foot", "trunk",
                              "head",   "upper arm", "forearm", "hand", "shoulder"};
  const auto landmark = motion::landmark_of(marker);
  return landmark ? kParts[static_cast<std::size_t>(landmark->part)] : "no landmark";
}

/// The static trial as it is, beside a walk in which the marker lies elsewhere: is the static trial blamed?
void spoil_walk(const StaticCase& c, const std::string& marker, const Vector3d& shift, Group& group) {
  const auto column = c.movement->find(marker);
  if (column < 0) return;
  StaticCase spoilt = c;
  spoilt.movement = testing_support::with_shift(*c.movement, column, shift);
  const auto judgement = testing_support::judge(spoilt, spoilt.still);
  ++group.walks_spoilt;
  group.contradictions += judgement.findings.empty() ? 0 : 1;
  for (const auto& finding : judgement.findings)
    if (finding.marker == marker && finding.where == motion::MistakeIn::still) {
      ++group.stills_blamed;
      group.blamed += fmt::format("; {} {:.0f} mm", marker, 1e3 * shift.norm());
    }
}

void look_at(StaticCase& c, std::uint64_t seed, int step, Group& group) {
  c.clean = testing_support::judge(c, c.still);
  if (c.clean.judged.empty()) return;
  Random random(seed, static_cast<std::uint64_t>(group.clean));
  ++group.clean;
  if (!c.clean.findings.empty()) {
    ++group.accused;
    group.accusations += "; " + motion::describe(c.clean.findings[0], c.name);
  }
  int count = 0;
  for (const auto& name : c.clean.judged)
    for (const double size : kSizes) {
      const Vector3d shift = size * testing_support::some_vector(random).normalized();
      if (count++ % step != 0) continue;
      const auto judgement =
          testing_support::judge(c, testing_support::with_shift(c.still, c.still.find(name), shift));
      const auto& found = judgement.findings;
      const bool named = !found.empty() && found[0].marker == name && found[0].partner.empty();
      auto& part = group.parts[fmt::format("{}, {:.0f} mm", part_of(name), 1e3 * size)];
      for (auto* tally : {&group.all, &part, size == 0.050 ? &group.at_50_mm : nullptr})
        if (tally != nullptr) {
          ++tally->planted;
          tally->named += named ? 1 : 0;
          tally->other += !named && !found.empty() ? 1 : 0;
        }
      if (size == 0.050) group.said_at_50_mm += c.clean.seen_at_50_mm;
      if (c.movement && count % 5 == 1) spoil_walk(c, name, shift, group);
    }
}

void print(const Group& g) {
  using testing_support::print_row;
  print_row(g.all.share() >= 0.98, g.name + ": one marker 30, 50, 80 mm off named", "at least 98 %",
            g.all.words());
  for (const auto& [part, tally] : g.parts) testing_support::print_note(g.name + ": " + part, tally.words());
  const double said = g.said_at_50_mm / std::max(1, g.at_50_mm.planted);
  print_row(std::abs(said - g.at_50_mm.share()) <= 0.12,
            g.name + ": share of shifts by 50 mm that is said to be seen, beside the share named",
            "within 12 points",
            fmt::format("{:.0f} % said, {:.0f} % of {}", 100.0 * said, 100.0 * g.at_50_mm.share(),
                        g.at_50_mm.planted));
  print_row(g.accused <= 0.01 * g.clean, g.name + ": without a mistake, accused", "at most 1 %",
            fmt::format("{} of {}{}", g.accused, g.clean, g.accusations));
  if (g.walks_spoilt > 0)
    print_row(g.stills_blamed <= 0.02 * g.walks_spoilt,
              g.name + ": a marker off in the walk, called the static trial's", "at most 2 %",
              fmt::format("{} of {} ({} contradict each other){}", g.stills_blamed, g.walks_spoilt,
                          g.contradictions, g.blamed.substr(0, 300)));
}

int run_check(int argc, char** argv) {
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("each marker of static trials of many laboratories");
  const int step = argc > 1 ? std::max(1, std::atoi(argv[1])) : 1;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 2911;
  Group walks{.name = "beside a walk of the session"}, alone{.name = "by names alone"},
      models{.name = "subjects against the model"};
  for (auto& c : testing_support::cases_beside_a_walk(*data)) {
    look_at(c, seed, step, walks);
    StaticCase lone = c;
    lone.movement.reset();
    look_at(lone, seed, step, alone);
  }
  for (const auto& file : testing_support::lone_recordings()) {
    auto c = testing_support::recorded_case(*data / file, {});
    look_at(c, seed, step, alone);
  }
  for (std::uint64_t s = 0; s < 5; ++s) {
    auto c = testing_support::simulated_case(seed + s, false);
    look_at(c, seed, step, models);
  }
  for (const auto* group : {&walks, &alone, &models}) print(*group);
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("foundation_markers", run_check);

}  // namespace
