// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Static trials in which one pair is exchanged, judged as `scale` (against a model) and
// `segments --definition pig --static` (by names and the walk) judge them.
// Arguments: exchanges in each trial (default 4), first seed (default 2608).
#include <fmt/core.h>

#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "acceptance/static_trials.h"
#include "kinemark/core/random.h"
#include "kinemark/stages/motion/foundations/judge.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using testing_support::print_row;
using Case = testing_support::StaticCase;

struct Count {
  int planted = 0, named = 0, clean = 0, accused = 0;
  std::string missed;
  void print(const std::string& row, double share) const {
    print_row(planted > 0 && named >= share * planted, row, fmt::format("at least {:.0f} %", 100.0 * share),
              fmt::format("{:.1f} % ({} of {}){}", planted > 0 ? 100.0 * named / planted : 0.0, named,
                          planted, missed.empty() ? "" : "; not: " + missed.substr(0, 300)));
  }
};

/// Two markers that somebody may mistake for each other: partners, or neighbours on a segment or across a
/// joint.
std::pair<std::int64_t, std::int64_t> some_pair(const Case& c, const std::vector<std::int64_t>& seen,
                                                std::int64_t frame, Random& random) {
  for (;;) {
    const auto i = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(seen.size()))),
               j = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(seen.size())));
    if (i == j) continue;
    const auto a = motion::split_marker_name(c.still.names[static_cast<std::size_t>(seen[i])]);
    const auto b = motion::split_marker_name(c.still.names[static_cast<std::size_t>(seen[j])]);
    const double apart = (c.still.x(frame, seen[i]) - c.still.x(frame, seen[j])).norm();
    if (apart < 0.03) continue;
    if ((a.stem == b.stem && a.side != b.side) || apart < 0.35) return {seen[i], seen[j]};
  }
}

void plant(const Case& c, int index, std::uint64_t seed, Count& exchanges) {
  std::vector<std::int64_t> seen;
  for (const auto& name : c.clean.judged) seen.push_back(c.still.find(name));
  Random random(seed, static_cast<std::uint64_t>(index));
  const auto [i, j] = some_pair(c, seen, c.clean.frame, random);
  const auto& a = c.still.names[static_cast<std::size_t>(i)];
  const auto& b = c.still.names[static_cast<std::size_t>(j)];
  const auto judgement = testing_support::judge(c, testing_support::with_exchange(c.still, i, j));
  ++exchanges.planted;
  const auto& f = judgement.findings;
  if (!f.empty() && ((f[0].marker == a && f[0].partner == b) || (f[0].marker == b && f[0].partner == a)))
    ++exchanges.named;
  else
    exchanges.missed += (exchanges.missed.empty() ? "" : ", ") + fmt::format("{} {}/{}", c.name, a, b);
}

void look_at_clean(Case& c, Count& count) {
  c.clean = testing_support::judge(c, c.still);
  if (c.clean.judged.empty()) return;
  ++count.clean;
  if (c.clean.findings.empty()) return;
  ++count.accused;
  count.missed += (count.missed.empty() ? "" : ", ") + motion::describe(c.clean.findings[0], c.name);
}

/// Subjects without a mistake against the model, by names alone, and by names beside a movement.
void look_at_many_clean(std::uint64_t seed, int subjects) {
  Count counts[3];
  for (int s = 0; s < subjects; ++s) {
    Case model = testing_support::simulated_case(seed + static_cast<std::uint64_t>(s), false);
    Case names = testing_support::simulated_case(seed + static_cast<std::uint64_t>(s), true);
    look_at_clean(model, counts[0]);
    look_at_clean(names, counts[2]);
    names.movement.reset();
    look_at_clean(names, counts[1]);
  }
  constexpr const char* kJudged[3] = {"against the model", "by names alone", "beside a movement"};
  for (int k = 0; k < 3; ++k)
    print_row(counts[k].accused <= 0.01 * counts[k].clean,
              fmt::format("simulated subjects without a mistake, {}: accused", kJudged[k]), "at most 1 %",
              fmt::format("{} of {}{}", counts[k].accused, counts[k].clean,
                          counts[k].missed.empty() ? "" : "; " + counts[k].missed.substr(0, 300)));
}

int run_check(int argc, char** argv) {
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("static trials of many laboratories");
  const int plants = argc > 1 ? std::atoi(argv[1]) : 4;
  const std::uint64_t seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 2608;

  Count exchanges, clean;
  const int subjects = std::max(2, plants / 4);
  for (int s = 0; s < subjects; ++s) {
    Case c = testing_support::simulated_case(seed + static_cast<std::uint64_t>(s), false);
    look_at_clean(c, clean);
    for (int k = 0; k < 4; ++k) plant(c, 4 * s + k, seed, exchanges);
  }
  exchanges.print("simulated subjects against the model: exchanged pairs named", 0.98);

  Count exchanges_walk;
  auto pairs = testing_support::cases_beside_a_walk(*data);
  for (auto& c : pairs) {
    look_at_clean(c, clean);
    for (int k = 0; k < plants; ++k) plant(c, k, seed + 1, exchanges_walk);
  }
  exchanges_walk.print("static trials beside a walk of the session: exchanged pairs named", 0.98);

  if (plants > 4) {
    for (const auto& name : testing_support::lone_recordings()) {
      Case other = testing_support::recorded_case(*data / name, {});
      look_at_clean(other, clean);
    }
    for (const auto& c : pairs) {
      Case alone = c;
      alone.movement.reset();
      look_at_clean(alone, clean);
    }
  }
  print_row(
      clean.clean > 0 && clean.accused <= 0.01 * clean.clean, "static trials without a mistake: accused",
      "at most 1 %",
      fmt::format("{} of {}{}", clean.accused, clean.clean, clean.missed.empty() ? "" : "; " + clean.missed));
  if (plants > 4) look_at_many_clean(seed + 1000, 5 * plants);
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("foundations", run_check);

}  // namespace
