// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Walking over two force plates of which one is not there: where its foot stands, the torques of that leg
// must not be called known, and elsewhere they must.
#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "kinemark/core/random.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/model/coordinate_rates.h"
#include "kinemark/model/dynamics.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/model.h"
#include "kinemark/model/state.h"
#include "kinemark/stages/motion/dynamics/inverse_dynamics.h"
#include "kinemark/stages/motion/ik.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using Eigen::Vector3d;
using testing_support::print_row;

constexpr double kSwings = 0.8;  // m/s, of one foot against the other, on the floor or on a treadmill
constexpr double kBears = 20.0;  // N
constexpr const char* kSides[] = {"r", "l"};

struct Walk {
  model::Model model;
  data::JointMotion motion;  // without noise, rates filled
  data::Wrenches plates;     // one a foot, right then left; together they carry the body
};

Vector3d of(const Array<double>& values, std::int64_t f) {
  return Eigen::Map<const Vector3d>(values.data() + 3 * f);
}
void put(Array<double>& values, std::int64_t f, const Vector3d& v) {
  Eigen::Map<Vector3d>(values.data() + 3 * f) = v;
}

int body_named(const model::Model& model, const std::string& name) {
  const auto& bodies = model.description().bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b)
    if (bodies[b].name == name) return model.body_of(static_cast<int>(b));
  return -1;
}

/// Shares of the ground's force between two feet by where its centre of pressure lies; a foot that swings has
/// none.
std::array<double, 2> shares(const Vector3d& centre, const std::array<Vector3d, 2>& sole, bool one_swings) {
  Vector3d across = sole[0] - sole[1], from = centre - sole[1];
  across.y() = from.y() = 0.0;
  const double right = std::clamp(from.dot(across) / across.squaredNorm(), 0.0, 1.0);
  if (one_swings) return {right > 0.5 ? 1.0 : 0.0, right > 0.5 ? 0.0 : 1.0};
  return {right, 1.0 - right};
}

/// What carries the body: the force and moment that its motion asks of the ground, shared between the feet.
void make_plates(Walk& walk) {
  const auto& model = walk.model;
  const auto& root = model.free_joints()[0];
  const std::array<int, 2> feet{body_named(model, "calcn_r"), body_named(model, "calcn_l")};
  const auto F = walk.motion.frames();
  model::Workspace w(model);
  Eigen::VectorXd v(model.speed_count()), vdot(model.speed_count()), tau(model.speed_count());
  std::vector<std::array<Vector3d, 2>> soles;
  std::vector<std::array<Vector3d, 3>>
      ground;  // force, moment about the laboratory's origin, centre of pressure
  double floor = 1e9;
  const auto coordinates = [&](const Array<double>& of_motion, std::int64_t f) {
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(of_motion.data() + walk.motion.index(f, 0), walk.motion.size()));
  };
  for (std::int64_t f = 0; f < F; ++f) {
    const auto q = coordinates(walk.motion.q, f);
    model::speeds_from_rates(model, q, coordinates(walk.motion.qd, f), coordinates(walk.motion.qdd, f), v,
                             vdot);
    model::kinematics(model, w, model::state_from_coordinates(model, q));
    model::velocities(model, w, v);
    model::inverse_dynamics(model, w, vdot, tau);
    const auto& body = model.bodies()[static_cast<std::size_t>(root.body)];
    const Vector3d force =
                       w.joint_rotation[static_cast<std::size_t>(root.body)] * tau.segment<3>(root.speed_idx),
                   moment = w.joint_out_rotation[static_cast<std::size_t>(root.body)] *
                            tau.segment<3>(root.speed_idx + 3),
                   origin = model::point_in_world(w, root.body, body.body_from_joint.translation);
    ground.push_back({force, moment + origin.cross(force), Vector3d::Zero()});
    auto& sole = soles.emplace_back();
    for (std::size_t i = 0; i < 2; ++i) {
      sole[i] =
          model::point_in_world(w, feet[i], model.bodies()[static_cast<std::size_t>(feet[i])].com_in_body);
      floor = std::min(floor, sole[i].y() - 0.03);
    }
  }
  walk.plates.time = walk.motion.time;
  walk.plates.items.resize(2);
  for (std::size_t i = 0; i < 2; ++i) {
    auto& plate = walk.plates.items[i];
    plate.name = fmt::format("plate {}", kSides[i]);
    for (auto* values : {&plate.force, &plate.moment, &plate.point})
      values->assign(static_cast<std::size_t>(3 * F), 0.0);
  }
  for (std::int64_t f = 0; f < F; ++f) {
    auto& [force, moment, centre] = ground[static_cast<std::size_t>(f)];
    centre = force.cross(moment) / force.squaredNorm();
    centre += (floor - centre.y()) / force.y() * force;
    auto sole = soles[static_cast<std::size_t>(f)];
    const auto before = static_cast<std::size_t>(std::max<std::int64_t>(0, f - 1)),
               after = static_cast<std::size_t>(std::min(F - 1, f + 1));
    const Vector3d moved = (soles[after][0] - soles[before][0]) - (soles[after][1] - soles[before][1]);
    const bool one_swings =
        moved.norm() * walk.motion.time.rate_hz > kSwings * static_cast<double>(after - before);
    for (auto& point : sole) point.y() = floor;
    const auto share = shares(centre, sole, one_swings);
    Vector3d rest = moment;
    for (std::size_t i = 0; i < 2; ++i) rest -= sole[i].cross(share[i] * force);
    for (std::size_t i = 0; i < 2; ++i) {
      put(walk.plates.items[i].force, f, share[i] * force);
      put(walk.plates.items[i].moment, f, share[i] * rest);
      put(walk.plates.items[i].point, f, sole[i]);
    }
  }
}

Walk make_walk(const std::filesystem::path& data, const std::string& osim, const std::string& trc) {
  Walk walk{
      .model = model::Model::compile(io::read_osim(data / osim).value()).value(), .motion = {}, .plates = {}};
  auto solved =
      motion::solve_ik(walk.model, io::read_markers(data / trc).value().markers, {.error_bars = false});
  walk.motion = std::move(solved.value().motion);
  (void)motion::inverse_dynamics(walk.model, walk.motion, {.error_bars = false}).value();
  if (walk.motion.qd.empty()) (void)motion::estimate_rates(walk.model, walk.motion).value();
  make_plates(walk);
  return walk;
}

/// Coordinates with noise, plates with noise, rates to be found again.
Walk measured(const Walk& truth, std::uint64_t seed) {
  Walk out = truth;
  Random random(seed, 0x746f72);
  for (std::int64_t f = 0; f < out.motion.frames(); ++f)
    for (int c = 0; c < out.motion.size(); ++c) {
      const bool rotation = out.motion.is_rotation[static_cast<std::size_t>(c)] != 0;
      out.motion.q[out.motion.index(f, c)] +=
          (rotation ? 0.3 * std::numbers::pi / 180.0 : 1e-3) * random.gaussian();
    }
  out.motion.qd.clear();
  out.motion.qdd.clear();
  for (auto& plate : out.plates.items)
    for (std::int64_t f = 0; f < out.motion.frames(); ++f) {
      if (!(of(plate.force, f).norm() > 0.0)) continue;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        plate.force[static_cast<std::size_t>(3 * f) + axis] += 2.0 * random.gaussian();
        if (axis != 1) plate.point[static_cast<std::size_t>(3 * f) + axis] += 3e-3 * random.gaussian();
      }
    }
  return out;
}

struct Tally {
  std::int64_t right = 0, all = 0;
  [[nodiscard]] double percent() const {
    return all > 0 ? 100.0 * static_cast<double>(right) / static_cast<double>(all) : 100.0;
  }
};

/// Whether the knee and hip of a side have torques in a frame.
bool determined(const data::JointMotion& motion, std::int64_t f, const std::string& side) {
  for (int c = 0; c < motion.size(); ++c) {
    const auto& name = motion.coordinates[static_cast<std::size_t>(c)];
    if (name == "hip_flexion_" + side || name == "knee_angle_" + side || name == "ankle_angle_" + side)
      if (std::isnan(motion.tau[motion.index(f, c)])) return false;
  }
  return true;
}

int run_check(int argc, char** argv) {
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("torques beside the plates");
  std::uint64_t first_seed = 1;
  int draws = 3;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument.starts_with("seed=")) first_seed = std::stoull(argument.substr(5));
    if (argument.starts_with("draws=")) draws = std::stoi(argument.substr(6));
  }
  const std::array<std::array<std::string, 3>, 2> recordings{
      {{"gait2354", "opensim-gait2354/subject01_simbody.osim", "opensim-gait2354/subject01_walk1.trc"},
       {"nimble", "nimble-arnold-synthetic/subject01/subject01.osim",
        "nimble-arnold-synthetic/subject01/trials/walk2/markers.trc"}}};
  for (const auto& [name, osim, trc] : recordings) {
    const Walk truth = make_walk(*data, osim, trc);
    Tally withdrawn, kept, other, none;
    for (int draw = 0; draw < draws; ++draw) {
      const Walk walk = measured(truth, first_seed + static_cast<std::uint64_t>(draw));
      for (std::size_t missing = 0; missing < 3; ++missing) {  // 2: both plates are there
        auto motion = walk.motion;
        data::Wrenches plates = walk.plates;
        if (missing < 2) plates.items.erase(plates.items.begin() + static_cast<std::ptrdiff_t>(missing));
        (void)motion::inverse_dynamics(walk.model, motion, {.error_bars = false}, &plates).value();
        for (std::int64_t f = 0; f < motion.frames(); ++f)
          for (std::size_t side = 0; side < 2; ++side) {
            const bool known = determined(motion, f, kSides[side]);
            const bool bears = of(truth.plates.items[side].force, f).y() > kBears;
            Tally& tally = missing == 2 ? none : side != missing ? other : bears ? withdrawn : kept;
            ++tally.all;
            tally.right += &tally == &withdrawn ? !known : known;
          }
      }
    }
    const auto row = [&](const std::string& what, const Tally& tally) {
      print_row(tally.percent() >= 95.0, fmt::format("{}: {}", name, what), ">= 95 %",
                fmt::format("{:.1f} % of {}", tally.percent(), tally.all));
    };
    row("one plate of two removed, stance of that leg not determined", withdrawn);
    row("the same leg, other frames determined", kept);
    row("the leg on the plate determined", other);
    row("both plates there, both legs determined", none);
  }
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("torques", run_check);

}  // namespace
