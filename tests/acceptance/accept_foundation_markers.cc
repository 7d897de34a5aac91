// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Each marker of each static trial in reach, 30, 50 and 80 mm elsewhere.
// Arguments: every how-manieth marker (default 1), seed (default 2911), "list" to print each planted shift.
#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

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

struct Sweep {
  std::uint64_t seed;
  int step;
  bool list;
};

struct Tally {
  int planted = 0, named = 0, other = 0;
};

struct Group {
  std::string name;
  Tally all;
  std::map<std::string, Tally> parts;
  int clean = 0, accused = 0, at_50 = 0, named_at_50 = 0;
  double said_at_50 = 0.0;  // sum of what the judgements of the clean trials say
  std::string accusations;
};

std::string part_of(const std::string& marker) {
  constexpr const char* kParts[] = {"pelvis", "thigh", "shank",     "foot",   "trunk",
                                    "head",   "upper arm", "forearm", "hand", "shoulder"};
  const auto landmark = motion::landmark_of(marker);
  return landmark ? kParts[static_cast<int>(landmark->part)] : "no landmark";
}

void print_weak(const std::string& what, const StaticCase& c, const data::Trajectories& still) {
  std::vector<const data::Trajectories*> movements;
  if (c.movement) movements.push_back(&*c.movement);
  const auto weak =
      motion::judge_foundation(c.body, still, movements,
                               {.least_score = 1.0, .least_score_beside = 1.0, .least_fall = 1.0, .most_findings = 2})
          .value();
  for (const auto& f : weak.findings) fmt::print("# {}, {}, {:.1f}\n", what, motion::describe(f, c.name), f.score);
}

void look_at(StaticCase& c, const Sweep& sweep, Group& group) {
  c.clean = testing_support::judge(c, c.still);
  if (c.clean.judged.empty()) return;
  ++group.clean;
  if (!c.clean.findings.empty()) {
    ++group.accused;
    group.accusations += "; " + motion::describe(c.clean.findings[0], c.name);
  }
  if (sweep.list) print_weak("clean," + group.name, c, c.still);
  Random random(sweep.seed, std::hash<std::string>()(c.name));
  int count = 0;
  for (const auto& name : c.clean.judged)
    for (const double size : kSizes) {
      const Vector3d way = testing_support::some_vector(random).normalized();
      if (count++ % sweep.step != 0) continue;
      const auto j =
          testing_support::judge(c, testing_support::with_shift(c.still, c.still.find(name), size * way));
      const bool named = !j.findings.empty() && j.findings[0].marker == name && j.findings[0].partner.empty();
      for (auto* tally : {&group.all, &group.parts[fmt::format("{} {:.0f} mm", part_of(name), 1e3 * size)]}) {
        ++tally->planted;
        tally->named += named ? 1 : 0;
        tally->other += !named && !j.findings.empty() ? 1 : 0;
      }
      if (size == 0.050) {
        ++group.at_50;
        group.named_at_50 += named ? 1 : 0;
        group.said_at_50 += c.clean.seen_at_50_mm;
      }
      if (sweep.list && !named)
        print_weak("weak", c, testing_support::with_shift(c.still, c.still.find(name), size * way));
      if (sweep.list)
        fmt::print("# {},{},{},{},{:.0f},{:.2f} {:.2f} {:.2f},{},{}\n", group.name, c.name, name, part_of(name),
                   1e3 * size, way[0], way[1], way[2], named ? "named" : j.findings.empty() ? "none" : "other",
                   j.findings.empty() ? "" : motion::describe(j.findings[0], "it"));
    }
}

void print(const Group& g) {
  const auto words = [](const Tally& t) {
    return fmt::format("{:.1f} % ({} of {}; another one named in {})", 100.0 * t.named / std::max(1, t.planted),
                       t.named, t.planted, t.other);
  };
  testing_support::print_row(g.all.named >= 0.98 * g.all.planted, g.name + ": one marker 30, 50, 80 mm off named",
                             "at least 98 %", words(g.all));
  for (const auto& [part, tally] : g.parts) testing_support::print_note(g.name + ": " + part, words(tally));
  const double said = g.said_at_50 / std::max(1, g.at_50), was = static_cast<double>(g.named_at_50) / std::max(1, g.at_50);
  testing_support::print_row(std::abs(said - was) <= 0.12, g.name + ": share of shifts by 50 mm that the judgement says it would see, beside the share named", "within 12 points",
                             fmt::format("{:.0f} % said, {:.0f} % of {} named", 100.0 * said, 100.0 * was, g.at_50));
  testing_support::print_row(g.accused <= 0.01 * g.clean, g.name + ": without a mistake, accused", "at most 1 %",
                             fmt::format("{} of {}{}", g.accused, g.clean, g.accusations));
}

void calibrate(const std::filesystem::path& data) {
  const std::vector<std::string> files{
      "opensim-hamner-fullbody/subject02_running.trc", "bmc-rajagopal-run/ExpData/motion_capture_run.trc",
      "btk-others/T.trc", "btk-others/ballet_reduced.trc", "btk-others/Gait.c3d", "btk-others/FunctionalWalk.c3d",
      "btk-others/FunctionalLHip.c3d", "cmu-mocap/cmu_02_05.c3d", "opensim-core-formats/walking2.c3d",
      "ezc3d-testFiles/FP_Type1.c3d", "ezc3d-testFiles/Qualisys.c3d", "c3d-parser-clinics/MH0222_BP15.c3d",
      "c3d-parser-clinics/RBWH_bfnd_w1.c3d", "c3d-parser-clinics/S4-AMGait03.c3d", "btk-others/PiG_Motion3_FF.c3d",
      "opensim-gait2354/subject01_walk1.trc", "c3d-parser-clinics/QCMAS.dynamic.c3d", "biobuddy/right_knee.c3d"};
  for (const auto& file : files) {
    auto c = testing_support::recorded_case(data / file, {});
    const auto all = c.still;
    const auto part = [&](std::int64_t a, std::int64_t b) {
      data::Trajectories out = data::Trajectories::all_missing(all.names, {.rate_hz = all.time.rate_hz, .frames = b - a});
      for (std::int64_t f = a; f < b; ++f)
        for (std::int64_t m = 0; m < all.markers(); ++m) {
          out.x(f - a, m) = all.x(f, m);
          out.state[out.index(f - a, m)] = all.state[all.index(f, m)];
        }
      return out;
    };
    const std::int64_t n = all.frames();
    for (int k = 0; k < 3; ++k) {
      c.name = fmt::format("{}#{}", std::filesystem::path(file).stem().string(), k);
      const auto still = part(k * n / 3, (k + 1) * n / 3);
      c.movement = k == 0 ? part(n / 3, n) : part(0, k * n / 3);
      print_weak("calibrate", c, still);
    }
  }
}

int run_check(int argc, char** argv) {
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("each marker of static trials of many laboratories");
  const Sweep sweep{.seed = argc > 2 ? std::strtoull(argv[2], nullptr, 10) : 2911,
                    .step = argc > 1 ? std::max(1, std::atoi(argv[1])) : 1,
                    .list = argc > 3 && std::string_view(argv[3]) == "list"};
  Group walks{.name = "beside a walk of the session"}, alone{.name = "by names alone"},
      models{.name = "subjects against the model"};
  const std::string only = argc > 4 ? argv[4] : "";
  if (only != "calibrate") for (auto& c : testing_support::cases_beside_a_walk(*data)) {
    look_at(c, sweep, walks);
    if (only == "walks") continue;
    StaticCase lone = c;
    lone.movement.reset();
    look_at(lone, sweep, alone);
  }
  if (only == "calibrate") { calibrate(*data); return 0; }
  if (only == "walks") {
    print(walks);
    return 0;
  }
  for (const auto& file : testing_support::lone_recordings()) {
    auto c = testing_support::recorded_case(*data / file, {});
    look_at(c, sweep, alone);
  }
  for (std::uint64_t s = 0; s < 5; ++s) {
    auto c = testing_support::simulated_case(sweep.seed + s, false);
    look_at(c, sweep, models);
  }
  for (const auto* group : {&walks, &alone, &models}) print(*group);
  return testing_support::exit_status();
}

const testing_support::AcceptanceCheck kCheck("foundation_markers", run_check);

}  // namespace
