// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "acceptance/static_trials.h"

#include <fmt/core.h>

#include <Eigen/Core>

#include "kinemark/core/index.h"
#include "kinemark/io/input/recording_input.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/scale_setup.h"
#include "kinemark/model/kinematics.h"
#include "kinemark/model/state.h"
#include "support/test_data.h"

namespace kinemark::testing_support {
namespace {

using data::Trajectories;
using Eigen::Vector3d;

Trajectories read(const std::filesystem::path& path) {
  return io::read_marker_input({.path = path}).value().trial.markers;
}

}  // namespace

Vector3d some_vector(Random& random) {
  Vector3d out;
  for (int a = 0; a < 3; ++a) out[a] = random.gaussian();
  return out;
}

motion::FoundationJudgement judge(const StaticCase& c, const Trajectories& still) {
  std::vector<const Trajectories*> movements;
  if (c.movement) movements.push_back(&*c.movement);
  return motion::judge_foundation(c.body, still, movements).value();
}

Trajectories with_shift(const Trajectories& still, std::int64_t marker, const Vector3d& shift) {
  Trajectories out = still;
  for (std::int64_t f = 0; f < out.frames(); ++f)
    if (out.present(f, marker)) out.x(f, marker) += shift;
  return out;
}

Trajectories with_exchange(const Trajectories& still, std::int64_t first, std::int64_t second) {
  Trajectories out = still;
  for (std::int64_t f = 0; f < out.frames(); ++f) {
    const auto s = out.index(f, first), t = out.index(f, second);
    const Vector3d kept = out.x(f, first);
    out.x(f, first) = out.x(f, second);
    out.x(f, second) = kept;
    std::swap(out.state[s], out.state[t]);
  }
  return out;
}

StaticCase simulated_case(std::uint64_t seed, bool by_names) {
  const auto human = io::read_osim(project_folder() / "models" / "human.osim").value();
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
  StaticCase out{.name = fmt::format("subject {}", seed),
                 .body = by_names ? motion::body_of_names(names) : motion::body_of_model(human).value(),
                 .still = frames(9, 0.10),
                 .movement = {}};
  if (by_names) out.movement = frames(60, 0.25);
  return out;
}

StaticCase recorded_case(const std::filesystem::path& still, const std::filesystem::path& movement) {
  StaticCase out{.name = still.stem().string(), .body = {}, .still = read(still), .movement = {}};
  out.body = motion::body_of_names(out.still.names);
  if (!movement.empty()) out.movement = read(movement);
  return out;
}

std::vector<StaticCase> cases_beside_a_walk(const std::filesystem::path& data) {
  const auto clinics = data / "c3d-parser-clinics", btk = data / "btk-others",
             gait = data / "opensim-gait2354";
  std::vector<StaticCase> out;
  out.push_back(recorded_case(clinics / "MH0222_BP08.c3d", clinics / "MH0222_BP15.c3d"));
  out.push_back(recorded_case(btk / "PiG_Calibration3_FF.c3d", btk / "PiG_Motion3_FF.c3d"));
  out.push_back(recorded_case(clinics / "S4_AM_Cal_01.c3d", clinics / "S4-AMGait03.c3d"));
  out.push_back(recorded_case(clinics / "RBWH_Max_Cal_01.c3d", clinics / "RBWH_bfnd_w1.c3d"));
  out.push_back(recorded_case(gait / "subject01_static.trc", gait / "subject01_walk1.trc"));
  return out;
}

const std::vector<std::string>& lone_recordings() {
  static const std::vector<std::string> kFiles{"pycgm-rom/Sample_Static.c3d",
                                               "biobuddy/static.c3d",
                                               "btk-others/T.trc",
                                               "ezc3d-testFiles/FP_Type1.c3d",
                                               "c3d-parser-clinics/MH_Cal_01.c3d",
                                               "ezc3d-testFiles/Qualisys.c3d",
                                               "opensim-core-formats/walking2.c3d",
                                               "cmu-mocap/cmu_02_05.c3d",
                                               "btk-others/Gait.c3d",
                                               "btk-others/FunctionalLHip.c3d"};
  return kFiles;
}

}  // namespace kinemark::testing_support
