// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// One marker at each joint centre and no more, as pose estimation from video gives them: limbs turn about
// their own length unseen. What is called determined holds, with its deviation; the rest says that it is not.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/core/units.h"
#include "kinemark/pipeline/simulate/human_model.h"
#include "kinemark/stages/motion/ik.h"
#include "kinemark/stages/simulation/subject.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using testing_support::print_note;
using testing_support::print_row;

constexpr double kMost = 5.0;                  // standard deviations
constexpr double kMostBeyond[] = {0.2, 0.02};  // %, without and with limits

/// The own human with 16 markers: the centres of hips, knees, ankles, toes, shoulders, elbows and wrists,
/// each on the body nearer to the pelvis, the root of the neck, and the top of the head.
data::ModelDescription joint_centres() {
  auto out = pipeline::human_model().value();
  out.markers.clear();
  for (const auto& joint : out.joints)
    for (const char* name :
         {"hip_", "knee_", "ankle_", "mtp_", "acromial_", "elbow_", "radius_hand_", "neck"})
      if (joint.name.starts_with(name))
        out.markers.push_back({.name = "c_" + joint.name,
                               .body_idx = joint.parent_body_idx,
                               .x_in_body = joint.parent_from_joint.translation});
  for (std::size_t b = 0; b < out.bodies.size(); ++b)
    if (out.bodies[b].name == "head")
      out.markers.push_back({.name = "top", .body_idx = static_cast<int>(b), .x_in_body = {0.03, 0.20, 0.0}});
  return out;
}

struct Tally {
  std::int64_t all = 0, determined = 0, one = 0, two = 0, beyond = 0;
  double worst = 0.0, off = 0.0;
};

double share(std::int64_t n, std::int64_t whole) {
  return 100.0 * static_cast<double>(n) / static_cast<double>(std::max<std::int64_t>(1, whole));
}

/// Subjects that move within the limits, solved with or without them: elbows and knees then flex both ways.
void check(const std::string& name, bool limits, int subjects, std::uint64_t first) {
  const auto model = model::Model::compile(joint_centres()).value();
  auto free = joint_centres();
  for (auto& coordinate : free.coordinates) coordinate.clamped = coordinate.clamped && limits;
  const auto solved = model::Model::compile(free).value();
  const simulation::MotionKind kinds[] = {simulation::MotionKind::walk, simulation::MotionKind::mixed,
                                          simulation::MotionKind::reach};
  Tally all;
  std::vector<Tally> of(at(model.coordinate_count()));
  std::string where;
  for (int s = 0; s < subjects; ++s) {
    const auto seed = first + static_cast<std::uint64_t>(s);
    const auto subject = simulation::simulate_subject(model, {.motion = kinds[s % 3],
                                                              .duration_s = 3.0,
                                                              .rate_hz = 60.0,
                                                              .seed = seed,
                                                              .noise_sd_m = s % 2 == 0 ? 0.001 : 0.005})
                             .value();
    const auto result = motion::solve_ik(solved, subject.markers).value();
    const auto& m = result.motion;
    for (std::size_t i = 0; i < m.q.size(); ++i) {
      const auto c = i % m.coordinates.size();
      double off = m.q[i] - subject.truth.q[i];
      if (m.is_rotation[c]) off = std::remainder(off, 2.0 * std::numbers::pi);
      const bool known = m.determined[i] != 0 && m.q_sd[i] > 0.0;
      const double z = known ? std::abs(off) / m.q_sd[i] : 0.0;
      if (z > all.worst)
        where = fmt::format("seed {}: {} in frame {}, {:.1f} deg off, SD {:.2f}", seed, m.coordinates[c],
                            i / m.coordinates.size(), kDegPerRad * off, kDegPerRad * m.q_sd[i]);
      for (Tally* tally : {&all, &of[c]}) {
        ++tally->all;
        if (!known) continue;
        ++tally->determined;
        tally->one += z <= 1.0;
        tally->two += z <= 2.0;
        tally->beyond += z > kMost;
        tally->worst = std::max(tally->worst, z);
        tally->off = std::max(tally->off, std::abs(off));
      }
    }
  }
  print_row(share(all.beyond, all.determined) <= kMostBeyond[limits ? 1 : 0],
            fmt::format("{}, {} subjects", name, subjects),
            fmt::format("of determined coordinates beyond 5 SD at most {} %", kMostBeyond[limits ? 1 : 0]),
            fmt::format("{} of {}; worst {:.1f} SD ({})", all.beyond, all.determined, all.worst, where));
  print_row(
      share(all.one, all.determined) >= 60.0 && share(all.one, all.determined) <= 75.0 &&
          share(all.two, all.determined) >= 90.0 && share(all.two, all.determined) <= 98.0,
      name + ": coverage", "60 to 75 % within 1 SD, 90 to 98 % within 2",
      fmt::format("{:.1f} and {:.1f} %", share(all.one, all.determined), share(all.two, all.determined)));
  const double least = limits ? 60.0 : 40.0;
  print_row(share(all.determined, all.all) >= least, name + ": determined",
            fmt::format("{} % of all at least", least),
            fmt::format("{:.1f} % of {}", share(all.determined, all.all), all.all));
  for (std::size_t c = 0; c < of.size(); ++c)
    print_note(
        name + ": " + model.description().coordinates[c].name,
        fmt::format("determined {:.0f} %; within 1 SD {:.0f}, 2 SD {:.0f} %; beyond 5 SD {}; worst {:.1f} "
                    "SD, {:.0f} deg off",
                    share(of[c].determined, of[c].all), share(of[c].one, of[c].determined),
                    share(of[c].two, of[c].determined), of[c].beyond, of[c].worst, kDegPerRad * of[c].off));
}

/// accept_motion few_markers [subjects=N] [seed=N]
int run_check(int argc, char** argv) {
  int subjects = 12;
  std::uint64_t first = 1;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("subjects=")) subjects = std::stoi(word.substr(9));
    if (word.starts_with("seed=")) first = std::stoull(word.substr(5));
  }
  check("one marker at each joint", true, subjects, first);
  check("the same without limits", false, subjects, first);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("few_markers", run_check);

}  // namespace
