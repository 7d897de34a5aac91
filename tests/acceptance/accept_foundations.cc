// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Static trials in which one pair is exchanged or one marker lies 30 to 80 mm elsewhere, judged as `scale`
// (against a model) and `analyze --segments pig --static` (by names and the walk) judge them.
// Arguments: mistakes in each trial (default 4), first seed (default 2608).
#include <fmt/core.h>

#include <Eigen/Core>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/random.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/scale_setup.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "kinemark/pipeline/files/marker_input.h"
#include "kinemark/stages/motion/foundations/judge.h"
#include "kinemark/stages/motion/foundations/standing_body.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using data::Trajectories;
using Eigen::Vector3d;
using testing_support::print_row;

/// Three normal numbers, drawn in order.
Vector3d some_vector(Random& random) {
  Vector3d out;
  for (int a = 0; a < 3; ++a) out[a] = random.gaussian();
  return out;
}

/// A static trial, the body that it is judged against, and its movement where there is one.
struct Case {
  std::string name;
  motion::StandingBody body;
  Trajectories still;
  std::optional<Trajectories> movement;
  motion::FoundationJudgement clean = {};  // of the trial as it is
};

struct Count {
  int planted = 0, named = 0, clean = 0, accused = 0;
  std::string missed;
  void print(const std::string& row, double share) const {
    print_row(planted > 0 && named >= share * planted, row, fmt::format("at least {:.0f} %", 100.0 * share),
              fmt::format("{:.1f} % ({} of {}){}", planted > 0 ? 100.0 * named / planted : 0.0, named,
                          planted, missed.empty() ? "" : "; not: " + missed.substr(0, 300)));
  }
};

Trajectories read(const std::filesystem::path& path) {
  return pipeline::read_marker_input({.path = path}).value().trial.markers;
}

motion::FoundationJudgement judge(const Case& c, const Trajectories& still) {
  std::vector<const Trajectories*> movements;
  if (c.movement) movements.push_back(&*c.movement);
  return motion::judge_foundation(c.body, still, movements).value();
}

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

void plant(const Case& c, int index, std::uint64_t seed, Count& exchanges, Count& shifts) {
  std::vector<std::int64_t> seen;
  for (const auto& name : c.clean.judged) seen.push_back(c.still.find(name));
  Random random(seed, static_cast<std::uint64_t>(index));
  Trajectories spoilt = c.still;
  const bool exchange = index % 2 == 0;
  std::string what, a, b;
  if (exchange) {
    const auto [i, j] = some_pair(c, seen, c.clean.frame, random);
    for (std::int64_t f = 0; f < spoilt.frames(); ++f) {
      const auto s = spoilt.index(f, i), t = spoilt.index(f, j);
      const Vector3d kept = spoilt.x(f, i);
      spoilt.x(f, i) = spoilt.x(f, j);
      spoilt.x(f, j) = kept;
      std::swap(spoilt.state[s], spoilt.state[t]);
    }
    a = spoilt.names[static_cast<std::size_t>(i)];
    b = spoilt.names[static_cast<std::size_t>(j)];
    what = fmt::format("{} {}/{}", c.name, a, b);
  } else {
    const auto m = seen[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(seen.size())))];
    const Vector3d way = some_vector(random).normalized();
    const double size = 0.03 + 0.05 * random.uniform();
    for (std::int64_t f = 0; f < spoilt.frames(); ++f)
      if (spoilt.present(f, m)) spoilt.x(f, m) += size * way;
    a = spoilt.names[static_cast<std::size_t>(m)];
    what = fmt::format("{} {} {:.0f} mm", c.name, a, 1e3 * size);
  }
  auto& count = exchange ? exchanges : shifts;
  const auto judgement = judge(c, spoilt);
  ++count.planted;
  const auto& f = judgement.findings;
  const bool named = !f.empty() && (exchange ? (f[0].marker == a && f[0].partner == b) ||
                                                   (f[0].marker == b && f[0].partner == a)
                                             : f[0].marker == a && f[0].partner.empty());
  if (named) {
    ++count.named;
  } else {
    count.missed += (count.missed.empty() ? "" : ", ") + what;
  }
}

void look_at_clean(Case& c, Count& count) {
  c.clean = judge(c, c.still);
  if (c.clean.judged.empty()) return;
  ++count.clean;
  if (c.clean.findings.empty()) return;
  ++count.accused;
  count.missed += (count.missed.empty() ? "" : ", ") + motion::describe(c.clean.findings[0], c.name);
}

/// Subjects of our own: another size for every segment, sides a little unlike, markers placed by hand.
Case simulated(std::uint64_t seed, bool by_names) {
  const auto human = io::read_osim(testing_support::project_folder() / "models" / "human.osim").value();
  Random random(seed, 77);
  auto person = human;
  const double size = 1.0 + 0.06 * random.gaussian();
  for (auto& joint : person.joints)
    joint.parent_from_joint.translation *= size * (1.0 + 0.015 * random.gaussian());
  for (auto& marker : person.markers) {
    marker.x_in_body *= size;
    for (int a = 0; a < 3; ++a) marker.x_in_body[a] += 0.005 * random.gaussian();
  }
  const auto model = model::Model::compile(person).value();
  model::Workspace w(model);
  std::vector<std::string> names;
  for (const auto& marker : person.markers) names.push_back(marker.name);
  const auto frames = [&](std::int64_t count, double spread) {
    auto out = Trajectories::all_missing(names, {.rate_hz = 100.0, .frames = count});
    Eigen::VectorXd q(model.coordinate_count());
    for (std::int64_t f = 0; f < count; ++f) {
      for (int k = 0; k < model.coordinate_count(); ++k) {
        const auto& coordinate = person.coordinates[at(k)];
        if (f == 0 || spread > 0.2)
          q[k] =
              coordinate.default_value + (coordinate.is_rotation && k > 5 ? spread * random.gaussian() : 0.0);
      }
      model::kinematics(model, w, model::state_from_coordinates(model, q));
      for (std::int64_t m = 0; m < out.markers(); ++m) {
        out.x(f, m) = w.marker.col(m) + 0.001 * some_vector(random);
        out.state[out.index(f, m)] = data::SampleState::measured;
      }
    }
    return out;
  };
  Case out{.name = fmt::format("subject {}", seed),
           .body = by_names ? motion::body_of_names(names) : motion::body_of_model(human).value(),
           .still = frames(9, 0.10),
           .movement = {}};
  if (by_names) out.movement = frames(60, 0.25);
  return out;
}

Case recorded(const std::filesystem::path& still, const std::filesystem::path& movement) {
  Case out{.name = still.stem().string(), .body = {}, .still = read(still), .movement = {}};
  out.body = motion::body_of_names(out.still.names);
  if (!movement.empty()) out.movement = read(movement);
  return out;
}

/// Subjects without a mistake against the model, by names alone, and by names beside a movement.
void look_at_many_clean(std::uint64_t seed, int subjects) {
  Count counts[3];
  for (int s = 0; s < subjects; ++s) {
    Case model = simulated(seed + static_cast<std::uint64_t>(s), false);
    Case names = simulated(seed + static_cast<std::uint64_t>(s), true);
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
  const auto clinics = *data / "c3d-parser-clinics";

  Count exchanges, shifts, clean;
  const int subjects = std::max(2, plants / 4);
  for (int s = 0; s < subjects; ++s) {
    Case c = simulated(seed + static_cast<std::uint64_t>(s), false);
    look_at_clean(c, clean);
    for (int k = 0; k < 4; ++k) plant(c, 4 * s + k, seed, exchanges, shifts);
  }
  exchanges.print("simulated subjects against the model: exchanged pairs named", 0.98);
  shifts.print("simulated subjects against the model: markers 30 to 80 mm off named", 0.98);

  Count exchanges_walk, shifts_walk;
  std::vector<Case> pairs;
  pairs.push_back(recorded(clinics / "MH0222_BP08.c3d", clinics / "MH0222_BP15.c3d"));
  pairs.push_back(recorded(*data / "btk-others" / "PiG_Calibration3_FF.c3d",
                           *data / "btk-others" / "PiG_Motion3_FF.c3d"));
  pairs.push_back(recorded(clinics / "S4_AM_Cal_01.c3d", clinics / "S4-AMGait03.c3d"));
  pairs.push_back(recorded(clinics / "RBWH_Max_Cal_01.c3d", clinics / "RBWH_bfnd_w1.c3d"));
  pairs.push_back(recorded(*data / "opensim-gait2354" / "subject01_static.trc",
                           *data / "opensim-gait2354" / "subject01_walk1.trc"));
  for (auto& c : pairs) {
    look_at_clean(c, clean);
    for (int k = 0; k < plants; ++k) plant(c, k, seed + 1, exchanges_walk, shifts_walk);
  }
  exchanges_walk.print("static trials beside a walk of the session: exchanged pairs named", 0.98);
  shifts_walk.print("static trials beside a walk of the session: markers 30 to 80 mm off named", 0.98);

  if (plants > 4) {
    for (const char* name :
         {"pycgm-rom/Sample_Static.c3d", "biobuddy/static.c3d", "btk-others/T.trc",
          "ezc3d-testFiles/FP_Type1.c3d", "c3d-parser-clinics/MH_Cal_01.c3d", "ezc3d-testFiles/Qualisys.c3d",
          "opensim-core-formats/walking2.c3d", "cmu-mocap/cmu_02_05.c3d", "btk-others/Gait.c3d",
          "btk-others/FunctionalLHip.c3d"}) {
      Case other = recorded(*data / name, {});
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
