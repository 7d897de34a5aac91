// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// OpenSim's Gait2354 example: its Scale setup against the models that OpenSim made of it.
#include <fmt/core.h>

#include <Eigen/Core>
#include <cmath>
#include <filesystem>
#include <string>

#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/osim/scale_setup.h"
#include "kinemark/pipeline/scale/scale_job.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using testing_support::print_row;
namespace fs = std::filesystem;

struct Worst {
  double value = 0.0;
  std::string where;
  int seen = 0;
  void see(double v, const std::string& name) {
    ++seen;
    if (!(v <= value) || where.empty()) {  // NaN is the worst
      value = v;
      where = name;
    }
  }
};

/// Largest distance of joint frames in both bodies, m.
Worst compare_joints(const data::ModelDescription& ours, const data::ModelDescription& theirs) {
  Worst worst;
  for (const auto& joint : theirs.joints)
    for (const auto& mine : ours.joints) {
      if (mine.name != joint.name) continue;
      worst.see((mine.parent_from_joint.translation - joint.parent_from_joint.translation).norm(),
                joint.name);
      worst.see((mine.child_from_joint.translation - joint.child_from_joint.translation).norm(), joint.name);
    }
  return worst;
}

/// Largest difference of the translations that the knees make of their angle, m.
Worst compare_knees(const data::ModelDescription& ours, const data::ModelDescription& theirs) {
  Worst worst;
  for (const auto& joint : theirs.joints)
    for (const auto& mine : ours.joints) {
      if (mine.name != joint.name || !joint.name.starts_with("knee")) continue;
      for (std::size_t a = 0; a < joint.axes.size(); ++a)
        for (double angle = -2.0; angle <= 0.2; angle += 0.1)
          if (!joint.axes[a].is_rotation && a < mine.axes.size())
            worst.see(std::abs(mine.axes[a].function(angle).f - joint.axes[a].function(angle).f), joint.name);
    }
  return worst;
}

int run_check(int /*argc*/, char** /*argv*/) {
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("opensim-gait2354 with its Scale setup");
  const fs::path folder = *data / "opensim-gait2354";
  const testing_support::ScratchSpace scratch("accept_scaling_gait");
  pipeline::ScaleJob job;
  job.setup = folder / "subject01_Setup_Scale.xml";
  job.output = scratch.path() / "subject01.osim";
  const auto outcome = pipeline::run_scale(job).value();
  const auto scaled = io::read_osim(folder / "subject01_scaledOnly.osim").value();
  const auto placed = io::read_osim(folder / "subject01_simbody.osim").value();
  const auto ours = io::read_osim(job.output).value();

  Worst factors;
  const auto scales = io::read_scale_set(folder / "subject01_scaleSet_applied.xml").value();
  for (const auto& scale : scales)
    for (const auto& mine : outcome.factors)
      if (mine.body == scale.body)
        factors.see((mine.factors.array() / scale.factors.array() - 1.0).abs().maxCoeff(), scale.body);
  print_row(factors.value <= 1e-3 && factors.seen == 12, "opensim-gait2354: scale factors of all 12 bodies",
            "within 0.1 %",
            fmt::format("{:.5f} % ({}), {} compared", 100.0 * factors.value, factors.where, factors.seen));

  const Worst joints = compare_joints(ours, scaled);
  const auto both_ends = 2 * static_cast<int>(scaled.joints.size());
  print_row(joints.value <= 1e-6 && both_ends > 0 && joints.seen == both_ends,
            "opensim-gait2354: joint places of the scaled model", "within 0.001 mm",
            fmt::format("{:.2g} mm ({}), {} of {} frames", 1e3 * joints.value, joints.where, joints.seen,
                        both_ends));
  const Worst knees = compare_knees(ours, scaled);
  print_row(knees.value <= 1e-6 && knees.seen >= 2 * 2 * 22,
            "opensim-gait2354: knee translations of the scaled model", "within 0.001 mm",
            fmt::format("{:.2g} mm, {} compared", 1e3 * knees.value, knees.seen));

  Worst masses, centres;
  for (const auto& body : scaled.bodies) {
    const int b = ours.find_body(body.name);
    if (b < 0) continue;
    const auto& mine = ours.bodies[static_cast<std::size_t>(b)];
    masses.see(std::abs(mine.mass / body.mass - 1.0), body.name);
    centres.see((mine.com_in_body - body.com_in_body).norm(), body.name);
  }
  const auto bodies = static_cast<int>(scaled.bodies.size());
  print_row(masses.value <= 1e-5 && centres.value <= 1e-6 && bodies > 0 && masses.seen == bodies,
            "opensim-gait2354: masses and mass centres", "within 1e-5 relative, 0.001 mm",
            fmt::format("{:.2g} ({}), {:.2g} mm, {} of {} bodies", masses.value, masses.where,
                        1e3 * centres.value, masses.seen, bodies));

  Worst positions;
  for (const auto& marker : placed.markers) {
    const int m = ours.find_marker(marker.name);
    if (m < 0) continue;
    positions.see((ours.markers[static_cast<std::size_t>(m)].x_in_body - marker.x_in_body).norm(),
                  marker.name);
  }
  print_row(
      positions.value <= 5e-4 && positions.seen > 0 &&
          positions.seen == static_cast<int>(placed.markers.size()),
      fmt::format("opensim-gait2354: positions of {} markers", placed.markers.size()),
      "within 0.5 mm of OpenSim's",
      fmt::format("{:.3f} mm ({}), {} compared", 1e3 * positions.value, positions.where, positions.seen));
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("scaling_gait", run_check);

}  // namespace
