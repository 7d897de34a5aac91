// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Inverse kinematics on real recordings against the answers that other programs stored beside them.
#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "kinemark/core/units.h"
#include "kinemark/io/markers/marker_file.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/files/motion_tables.h"
#include "kinemark/pipeline/motion/ik_job.h"
#include "kinemark/pipeline/motion/marker_locations.h"
#include "kinemark/stages/motion/ik.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using testing_support::print_row;
namespace fs = std::filesystem;

/// A recording solved with the options of its OpenSim setup file, and the stored answer.
struct Case {
  model::Model model;
  data::Trajectories markers;
  motion::IkOptions options;
  motion::IkResult result;
  data::Table answer;  // degrees and metres, or radians
};

model::Model load_model(const fs::path& path) {
  return model::Model::compile(io::read_osim(path).value()).value();
}

Case solve(const fs::path& model, const fs::path& markers, const fs::path& setup, const fs::path& answer) {
  Case c{.model = load_model(model), .markers = io::read_markers(markers).value().markers};
  pipeline::IkJob job;
  job.setup = setup;
  job.model = model;
  job.markers = markers;
  pipeline::apply_setup(job).value();
  pipeline::apply_tasks(job, c.model, c.markers).value();
  c.options = job.options;
  c.options.judge_samples = false;  // the others believed all samples
  c.answer = io::read_table(answer).value();
  c.options.last_time_s = std::min(c.options.last_time_s, c.answer.time_s.back());
  c.result = motion::solve_ik(c.model, c.markers, c.options).value();
  return c;
}

/// Answer of one coordinate at one solved frame, in radians or metres.
double stored(const Case& c, std::int64_t frame, int coordinate) {
  const auto& motion = c.result.motion;
  // A coupled coordinate follows from the one it is coupled to; files of older OpenSims hold it in another
  // unit.
  const auto& kind = c.model.coordinates()[static_cast<std::size_t>(coordinate)];
  if (kind.source >= 0) return kind.coupling(stored(c, frame, kind.source)).f;
  const auto column = c.answer.find(motion.coordinates[static_cast<std::size_t>(coordinate)]);
  const auto row = std::lower_bound(c.answer.time_s.begin(), c.answer.time_s.end(),
                                    motion.time.time_s(frame) - 0.3 / motion.time.rate_hz) -
                   c.answer.time_s.begin();
  const double unit = pipeline::column_unit(c.answer, c.model.description(), coordinate);
  return unit * c.answer(row, column);
}

Eigen::MatrixXd stored_coordinates(const Case& c) {
  Eigen::MatrixXd q(c.result.motion.frames(), c.model.coordinate_count());
  for (Eigen::Index f = 0; f < q.rows(); ++f)
    for (int k = 0; k < q.cols(); ++k) q(f, k) = stored(c, f, k);
  return q;
}

/// Cost of the stored answer over ours (1.0 when equal; above 1 when ours is lower).
void print_cost(const std::string& what, const Case& c) {
  const double theirs = motion::calc_ik_cost(c.model, c.markers, c.options, stored_coordinates(c)).value();
  print_row(
      c.result.cost <= theirs, what, "weighted cost <= OpenSim's",
      fmt::format("{:.8g} against {:.8g} m^2, {:.4f} times", c.result.cost, theirs, c.result.cost / theirs));
}

struct Difference {
  double value = 0.0;
  std::string where;
};

/// Largest difference over frames and coordinates, degrees (or metres times 180 / pi for translations).
Difference largest_difference(const Case& c, const std::function<bool(std::int64_t, int)>& counts) {
  Difference worst;
  for (std::int64_t f = 0; f < c.result.motion.frames(); ++f)
    for (int k = 0; k < c.model.coordinate_count(); ++k) {
      if (!counts(f, k)) continue;
      const double d =
          std::abs(c.result.motion.q[c.result.motion.index(f, k)] - stored(c, f, k)) * kDegPerRad;
      if (d > worst.value)
        worst = {d, fmt::format("{} frame {}", c.result.motion.coordinates[static_cast<std::size_t>(k)], f)};
    }
  return worst;
}

void nimble(const fs::path& data) {
  const fs::path folder = data / "nimble-arnold-synthetic" / "subject01";
  Case c{.model = load_model(folder / "subject01.osim"),
         .markers = io::read_markers(folder / "trials/walk2/markers.trc").value().markers};
  c.answer = io::read_table(folder / "coordinates.sto").value();
  c.result = motion::solve_ik(c.model, c.markers).value();
  std::int64_t determined = 0;
  for (const auto d : c.result.motion.determined) determined += d;
  const auto worst = largest_difference(
      c, [&](std::int64_t f, int k) { return c.result.motion.determined[c.result.motion.index(f, k)] != 0; });
  print_row(
      worst.value * kRadPerDeg < 1e-5, "nimble subject01, every determined coordinate",
      "within 1e-5 rad / 1e-5 m",
      fmt::format("{:.2g} ({}); {} of {} determined; {} couplers read", worst.value * kRadPerDeg, worst.where,
                  determined, c.result.motion.determined.size(), c.model.description().couplings.size()));
}

bool everything(std::int64_t, int) { return true; }

void core_ik(const fs::path& data) {
  const fs::path folder = data / "opensim-core-ik";
  const auto c =
      solve(folder / "subject01_simbody.osim", folder / "subject01_synthetic_marker_data.trc",
            folder / "subject01_Setup_InverseKinematics.xml", folder / "std_subject01_walk1_ik.mot");
  const auto worst = largest_difference(c, everything);
  print_row(worst.value <= 0.1, "opensim-core-ik case 1, angles", "within 0.1 deg of the stored answer",
            fmt::format("{:.3f} deg ({})", worst.value, worst.where));
  print_cost("opensim-core-ik case 1, cost", c);
}

void gait2354(const fs::path& data) {
  const fs::path folder = data / "opensim-gait2354";
  const auto c = solve(folder / "subject01_simbody.osim", folder / "subject01_walk1.trc",
                       folder / "subject01_Setup_IK.xml", folder / "subject01_walk1_ik.mot");
  const auto worst = largest_difference(c, everything);
  print_row(worst.value <= 0.06, "opensim-gait2354, angles", "within 0.06 deg of the stored answer",
            fmt::format("{:.3f} deg ({})", worst.value, worst.where));
  print_cost("opensim-gait2354, cost", c);
}

void shoulder(const fs::path& data) {
  const fs::path folder = data / "opensim-core-ik";
  const auto c = solve(folder / "subject1_abdbonepin.osim", folder / "abdbonepin.trc",
                       folder / "setup_ik_abdbonepin.xml", folder / "std_subject1_abdbonepin_IK.mot");
  double worst = 0.0;
  std::string where;
  for (int k = 0; k < c.model.coordinate_count(); ++k) {
    double squares = 0.0;
    const bool rotation = c.result.motion.is_rotation[static_cast<std::size_t>(k)];
    for (std::int64_t f = 0; f < c.result.motion.frames(); ++f)
      squares += std::pow(
          (c.result.motion.q[c.result.motion.index(f, k)] - stored(c, f, k)) * (rotation ? kDegPerRad : 1.0),
          2);
    const double rms = std::sqrt(squares / static_cast<double>(c.result.motion.frames()));
    if (rms > worst) worst = rms, where = c.result.motion.coordinates[static_cast<std::size_t>(k)];
  }
  print_row(worst <= 0.2, "opensim-core-ik case 2, columns",
            "within 0.2 RMS per column, as OpenSim's test asks", fmt::format("{:.3f} ({})", worst, where));
  print_row(c.result.fit.max_loop_gap_m <= 1e-6, "opensim-core-ik case 2, loop", "closed to 1e-6 m",
            fmt::format("{:.2g} m", c.result.fit.max_loop_gap_m));
}

void hamner(const fs::path& data) {
  const fs::path folder = data / "opensim-hamner-fullbody";
  const auto c = solve(folder / "subject02_registered.osim", folder / "subject02_running.trc",
                       folder / "Setup_IK.xml", folder / "subject02_running_ik.mot");
  const auto table = io::read_table(folder / "ik_model_marker_locations.sto").value();
  data::JointMotion motion;
  motion.time = {.rate_hz = 60.0, .t0_s = 0.0, .frames = table.rows()};
  for (std::int64_t row = 0; row < table.rows(); ++row)
    for (const auto& coordinate : c.model.description().coordinates)
      motion.q.push_back(c.answer(row, c.answer.find(coordinate.name)) *
                         (coordinate.is_rotation ? kRadPerDeg : 1.0));
  const auto moved = pipeline::marker_locations_table(c.model, motion);
  double worst = 0.0;
  for (std::int64_t row = 0; row < table.rows(); ++row)
    for (std::size_t k = 0; k < table.columns.size(); ++k)
      worst = std::max(worst, std::abs(moved(row, moved.find(table.columns[k])) -
                                       table(row, static_cast<std::int64_t>(k))));
  print_row(worst <= 1e-6, "opensim-hamner, forward kinematics of OpenSim's angles",
            "within 1e-6 m of OpenSim's markers", fmt::format("{:.2g} m", worst));
  print_cost("opensim-hamner, cost", c);
  testing_support::ScratchSpace scratch("accept_hamner");
  pipeline::IkJob job;
  job.setup = folder / "Setup_IK.xml";
  job.model = folder / "subject02_registered.osim";
  job.markers = folder / "subject02_running.trc";
  job.output = scratch.path() / "Q.mot";
  const auto summary = pipeline::run_ik(job).value().summary;
  const auto locations = io::read_table(scratch.path() / "Q_marker_locations.sto").value();
  const auto absent = std::ranges::count_if(
      table.columns, [&](const std::string& column) { return locations.find(column) < 0; });
  print_row(absent == 0 && locations.rows() >= table.rows(), "opensim-hamner, marker locations of the setup",
            "all columns and frames of OpenSim's table",
            fmt::format("{} columns of {} absent, {} rows for {}", absent, table.columns.size(),
                        locations.rows(), table.rows()));
  const auto bicep =
      std::ranges::find(summary.markers, "L.Bicep", [](const report::MarkerRow& m) { return m.name; });
  const bool found = bicep != summary.markers.end() && !bicep->used;
  print_row(found && bicep->why_excluded == "never seen", "opensim-hamner, all-zero L.Bicep",
            "found, excluded and said",
            found ? "excluded in the report: " + bicep->why_excluded : "not said");
}

void running(const fs::path& data) {
  const fs::path folder = data / "bmc-rajagopal-run";
  const auto c = solve(folder / "Scale/Rajagopal2015_scaled.osim", folder / "ExpData/motion_capture_run.trc",
                       folder / "IK/IK_setup.xml", folder / "IK/results/ik_output_run.mot");
  print_cost("bmc-rajagopal-run, cost", c);
  int blank = 0;
  for (std::int64_t m = 0; m < c.markers.markers(); ++m) {
    bool seen = false;
    for (std::int64_t f = 0; f < c.markers.frames(); ++f) seen = seen || c.markers.present(f, m);
    blank += !seen;
  }
  print_row(blank == 20, "bmc-rajagopal-run, blank markers", "20 found and left out",
            fmt::format("{} found", blank));
}

void arm(const fs::path& data) {
  const fs::path folder = data / "opensim-arm26";
  const auto model = load_model(folder / "arm26.osim");
  const auto good =
      motion::solve_ik(model, io::read_markers(folder / "arm26_elbow_flex.trc").value().markers).value();
  print_row(good.fit.rms_error_m <= 0.7e-3, "opensim-arm26", "0.7 mm RMS",
            fmt::format("{:.3f} mm", 1e3 * good.fit.rms_error_m));
  testing_support::ScratchSpace scratch("accept_ik");
  pipeline::IkJob job;
  job.model = folder / "arm26.osim";
  job.markers = folder / "arm26_elbow_flex_old_800mm_low.trc";
  job.output = scratch.path() / "Q.mot";
  const auto lowered = pipeline::run_ik(job).value();
  std::string sentence;
  for (const auto& gate : lowered.summary.run.gates)
    if (!gate.passed && gate.name == "mean_marker_offset") sentence = gate.sentence;
  print_row(lowered.exit_status() == 1 && sentence.find("0.800 m") != std::string::npos,
            "opensim-arm26, the copy 800 mm too low", "exit status 1 and a sentence naming 0.8 m",
            fmt::format("status {}: {}", lowered.exit_status(), sentence));
}

/// accept_motion ik [CASE...]: all cases, or those named.
int run_check(int argc, char** argv) {
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("inverse kinematics on real recordings");
  const std::vector<std::pair<std::string, void (*)(const fs::path&)>> cases = {{"nimble", nimble},
                                                                                {"core_ik", core_ik},
                                                                                {"gait2354", gait2354},
                                                                                {"shoulder", shoulder},
                                                                                {"hamner", hamner},
                                                                                {"running", running},
                                                                                {"arm", arm}};
  const std::vector<std::string> named(argv + 1, argv + argc);
  for (const auto& [name, run] : cases)
    if (named.empty() || std::find(named.begin(), named.end(), name) != named.end()) run(*data);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("ik", run_check);

}  // namespace
