// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Tasks that levels name, on simulated subjects: an orientation in place of its markers, values that are
// held, distances, centres of mass; and levels that the program proposes.
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "acceptance/track_subject.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "support/acceptance.h"

namespace {

using namespace kinemark;
using namespace kinemark::track_subject;
using testing_support::print_row;

/// Levels with all markers of the model in the lowest, but for those named in `without`.
std::vector<motion::TrackLevel> levels(const std::vector<std::string>& texts) {
  std::vector<motion::TrackLevel> out;
  for (const auto& text : texts) out.push_back(motion::TrackLevel::parse(text).value());
  return out;
}

/// All markers but those of a body after its first.
std::string markers_without(const model::Model& model, const std::string& body) {
  const int idx = model.body_of(model.description().find_body(body));
  std::string names;
  bool kept = false;
  for (int m = 0; m < model.marker_count(); ++m) {
    const bool own = model.markers()[static_cast<std::size_t>(m)].body == idx;
    if (own && kept) continue;
    kept = kept || own;
    names += "," + model.description().markers[static_cast<std::size_t>(m)].name;
  }
  return names;
}

/// Bodies with three markers that are not in one line.
std::vector<std::string> bodies_with_markers(const model::Model& model) {
  std::vector<std::string> names;
  for (const auto& body : model.description().bodies) {
    const int idx = model.body_of(model.description().find_body(body.name));
    const auto own = std::ranges::count_if(model.markers(), [&](const auto& m) { return m.body == idx; });
    if (own >= 3) names.push_back(body.name);
  }
  return names;
}

/// RMS angle of a body to its true orientation, deg, from the second second on: of a motion, and of its own
/// markers' goals laid on their places in the model (Umeyama's solution in Eigen).
struct Turn {
  double of_motion = 0.0, of_markers = 0.0;

  Turn(const model::Model& model, const std::string& body, const data::JointMotion& motion,
       const simulation::SimulatedSubject& s) {
    model::Workspace w(model);
    const int idx = model.body_of(model.description().find_body(body));
    const auto turn = [&](const data::JointMotion& of, std::int64_t f) {
      const Eigen::Map<const Eigen::VectorXd> q(of.q.data() + of.index(f, 0), of.size());
      model::kinematics(model, w, model::state_from_coordinates(model, q));
      return Eigen::Matrix3d(w.rotation[static_cast<std::size_t>(idx)]);
    };
    const auto square = [](const Eigen::Matrix3d& one, const Eigen::Matrix3d& other) {
      return std::pow(Eigen::AngleAxisd(Eigen::Matrix3d(one * other.transpose())).angle(), 2);
    };
    const auto goals = motion::control_goals(s.markers).value();
    std::vector<int> own;
    for (int m = 0; m < model.marker_count(); ++m)
      if (model.markers()[static_cast<std::size_t>(m)].body == idx) own.push_back(m);
    const auto count = static_cast<Eigen::Index>(own.size());
    Eigen::Matrix3Xd from(3, count), to(3, count);
    double frames = 0.0;
    for (auto f = static_cast<std::int64_t>(motion.time.rate_hz); f < motion.frames(); f += 5) {
      for (Eigen::Index k = 0; k < count; ++k) {
        const auto m = static_cast<std::size_t>(own[static_cast<std::size_t>(k)]);
        from.col(k) = model.markers()[m].x_in_body;
        to.col(k) = goals.x(f, goals.find(model.description().markers[m].name));
      }
      const Eigen::Matrix3d truth = turn(s.truth, f),
                            laid = Eigen::umeyama(from, to, false).topLeftCorner<3, 3>();
      of_motion += square(turn(motion, f), truth);
      of_markers += square(laid, truth);
      frames += 1.0;
    }
    of_motion = kDegPerRad * std::sqrt(of_motion / frames);
    of_markers = kDegPerRad * std::sqrt(of_markers / frames);
  }
};

/// Height of the centre of mass of all bodies in a frame.
double height_m(const model::Model& model, const data::JointMotion& motion, std::int64_t f) {
  model::Workspace w(model);
  const Eigen::Map<const Eigen::VectorXd> q(motion.q.data() + motion.index(f, 0), motion.size());
  model::kinematics(model, w, model::state_from_coordinates(model, q));
  double sum = 0.0, mass = 0.0;
  for (std::size_t b = 0; b < model.bodies().size(); ++b) {
    const auto& body = model.bodies()[b];
    sum += body.mass * model::point_in_world(w, static_cast<int>(b), body.com_in_body).y();
    mass += body.mass;
  }
  return sum / mass;
}

double mean_height_m(const model::Model& model, const data::JointMotion& motion) {
  double sum = 0.0;
  for (std::int64_t f = 0; f < motion.frames(); ++f) sum += height_m(model, motion, f);
  return sum / static_cast<double>(motion.frames());
}

struct Sums {
  double ratio = 0.0, body_ratio = 0.0, squares = 0.0, variances = 0.0;
  double held_deg = 0.0, weighed_deg = 0.0, distance_mm = 0.0, noise_mm = 0.0, centre_mm = 0.0;
  double proposed = 0.0, smallest = 1e9;
  int beyond = 0;
};

/// An orientation and one marker in place of all markers of a body.
void try_orientation(const model::Model& model, const simulation::SimulatedSubject& s,
                     const std::string& body, Sums& sums) {
  const auto text = fmt::format("orientation:{}{}", body, markers_without(model, body));
  const auto by_task = motion::track_markers(model, s.markers, {.levels = levels({text})}).value();
  const auto by_markers = motion::track_markers(model, s.markers, {.error_bars = false}).value();
  sums.ratio = larger(sums.ratio, joint_rms_deg(model, by_task.motion, s.truth) /
                                      joint_rms_deg(model, by_markers.motion, s.truth));
  const Turn turn(model, body, by_task.motion, s);
  const Turn all(model, body, by_markers.motion, s);
  sums.body_ratio = larger(sums.body_ratio, turn.of_motion / larger(turn.of_markers, all.of_motion));
  for (std::int64_t f = 60; f < by_task.motion.frames(); ++f)
    for (const auto c : joints(model)) {
      const auto i = by_task.motion.index(f, c);
      if (!(by_task.motion.q_sd[i] > 0.0)) continue;
      sums.squares += std::pow(by_task.motion.q[i] - s.truth.q[s.truth.index(f, c)], 2);
      sums.variances += std::pow(by_task.motion.q_sd[i], 2);
    }
}

/// A knee near its mean, strictly and by weights; a distance; the height of the centre of mass.
void try_held(const model::Model& model, const simulation::SimulatedSubject& s, Sums& sums) {
  const auto knee = s.truth.find("knee_angle_r");
  double mean = 0.0;
  for (std::int64_t f = 0; f < s.truth.frames(); ++f) mean += s.truth.q[s.truth.index(f, knee)];
  mean /= static_cast<double>(s.truth.frames());
  const auto hold = fmt::format("coordinate:knee_angle_r={:.6f}rad", mean);
  for (const bool strict : {true, false}) {
    const auto track = motion::track_markers(model, s.markers,
                                             {.levels = levels({hold, "*"}),
                                              .strict = strict,
                                              .level_bound_m = strict ? 1.0 : 0.0,
                                              .error_bars = false});
    auto& worst = strict ? sums.held_deg : sums.weighed_deg;
    worst = larger(
        worst, kDegPerRad * (strict ? track.value().tasks[0].max_error : track.value().tasks[0].rms_error));
  }
  const auto& markers = model.description().markers;
  const auto pair = fmt::format("distance:{}-{}", markers.front().name, markers.back().name);
  const auto kept =
      motion::track_markers(
          model, s.markers,
          {.levels = levels({pair, "*"}), .strict = true, .level_bound_m = 1.0, .error_bars = false})
          .value();
  sums.distance_mm = larger(sums.distance_mm, 1e3 * kept.tasks[0].rms_error);
  const double asked = mean_height_m(model, s.truth);
  const auto centre = motion::track_markers(model, s.markers,
                                            {.levels = levels({fmt::format("com:y={:.4f}m", asked), "*"}),
                                             .strict = true,
                                             .level_bound_m = 1.0,
                                             .error_bars = false})
                          .value();
  for (std::int64_t f = 60; f < centre.motion.frames(); ++f)
    sums.centre_mm = larger(sums.centre_mm, 1e3 * std::abs(height_m(model, centre.motion, f) - asked));
}

/// Proposed levels are followed as well as one level of all.
void try_proposed(const model::Model& model, const simulation::SimulatedSubject& s, Sums& sums) {
  const auto track =
      motion::track_markers(model, s.markers, {.propose_levels = true, .error_bars = false}).value();
  const auto one = motion::track_markers(model, s.markers, {.error_bars = false}).value();
  const double ratio =
      joint_rms_deg(model, track.motion, s.truth) / joint_rms_deg(model, one.motion, s.truth);
  sums.proposed = larger(sums.proposed, ratio);
  sums.beyond += ratio <= 1.05 ? 0 : 1;
  for (const auto& level : track.proposed->smallest)
    for (const double value : level) sums.smallest = std::min(sums.smallest, value);
}

/// accept_motion track_tasks [SUBJECTS] [seed=N]
int run_check(int argc, char** argv) {
  const auto [subjects, seed] = Asked(argc, argv, 2);
  const auto model = human();
  const auto bodies = bodies_with_markers(model);
  Sums sums;
  for (int i = 0; i < subjects; ++i) {
    const auto s = draw(model, seed + static_cast<std::uint64_t>(i), 0.0).recording;
    try_orientation(model, s, bodies[static_cast<std::size_t>(i) % bodies.size()], sums);
    try_held(model, s, sums);
    try_proposed(model, s, sums);
  }
  const auto who = fmt::format(", {} subjects, {} bodies with three markers", subjects, bodies.size());
  print_row(sums.ratio <= 1.05 && sums.body_ratio <= 1.05,
            "an orientation and one marker in place of all markers of a body" + who,
            "angles within 1.05 of all markers; orientation within 1.05 of all markers, or of its own laid "
            "on the model",
            fmt::format("worst {:.3f} and {:.3f}", sums.ratio, sums.body_ratio));
  const double spread = std::sqrt(sums.squares / sums.variances);
  print_row(spread > 0.8 && spread < 1.25, "its deviations of joint angles", "error / stated 0.8 to 1.25",
            fmt::format("{:.3f}", spread));
  print_row(sums.held_deg <= 0.1, "a knee held at its mean, strictly", "0.1 deg in every frame",
            fmt::format("worst {:.2g} deg; by weights {:.2g} deg RMS", sums.held_deg, sums.weighed_deg));
  print_row(sums.distance_mm <= 1.0, "a distance of two markers, strictly", "1 mm RMS",
            fmt::format("worst {:.2g} mm", sums.distance_mm));
  print_row(sums.centre_mm <= 1.0, "height of the centre of mass at its mean, strictly",
            "1 mm in every frame after the first second", fmt::format("worst {:.2g} mm", sums.centre_mm));
  print_row(10 * sums.beyond <= subjects && sums.smallest >= 0.1, "levels proposed, by weights" + who,
            "angles within 1.05 of one level in 9 of 10; each marker 0.1 kg^-1/2",
            fmt::format("{} beyond, worst {:.3f}; {:.3f}", sums.beyond, sums.proposed, sums.smallest));
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("track_tasks", run_check);

}  // namespace
