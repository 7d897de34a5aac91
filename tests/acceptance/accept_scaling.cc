// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Segment sizes and marker positions from motion, on simulated subjects of known size. The fit begins as
// `kinemark scale --markers` does: with the general model, its overall size from the recording, and the
// command's own priors, which are not those that the subjects are drawn from.
#include <fmt/core.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/io/osim/osim_model.h"
#include "kinemark/model/model.h"
#include "kinemark/pipeline/scale/scale_job.h"
#include "kinemark/stages/motion/scaling/adapt.h"
#include "kinemark/stages/motion/scaling/scale.h"
#include "kinemark/stages/simulation/subject.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using Eigen::VectorXd;
using testing_support::print_row;

constexpr double kScatter = 0.04, kPositionError_m = 0.005, kNoise_m = 0.001;
constexpr int kLengths = 17;

struct World {
  double width = 1.0;       ///< of every coordinate's range, about its default
  bool legs_still = false;  ///< as standing with bent knees
  double soft_tissue = 0.0;
  std::int64_t max_frames = pipeline::ScaleJob{}.adapt.max_frames;
};

/// A subject of known size: the general model grown to its height, every size off by 4 %, every marker by
/// 5 mm.
struct Subject {
  data::ModelDescription model;
  VectorXd size;  ///< of each group, over the general model's
};

Subject draw_subject(const data::ModelDescription& human, int number) {
  constexpr double kHumanHeight_m = 1.75;
  Random random(4000, static_cast<std::uint64_t>(number));
  const double growth = random.uniform(1.4, 2.1) / kHumanHeight_m;
  data::ModelDescription grown = human;
  motion::apply_factors(grown, std::vector(human.bodies.size(), Eigen::Vector3d::Constant(growth).eval()),
                        false);
  const auto parameters = motion::scale_parameters(grown, motion::default_scale_groups(grown)).value();
  VectorXd change(kLengths);
  for (int k = 0; k < kLengths; ++k) change[k] = kScatter * random.gaussian();
  Subject out{motion::apply_geometry(grown, parameters, change), growth * (1.0 + change.array())};
  for (auto& marker : out.model.markers)
    for (int axis = 0; axis < 3; ++axis) marker.x_in_body[axis] += kPositionError_m * random.gaussian();
  return out;
}

/// Relative errors and deviations of every size (rows) of every subject (columns), in per cent.
struct Outcome {
  std::vector<std::string> names;
  Eigen::MatrixXd error, sd, interval, data_sd;
  Eigen::MatrixXi determined;
  double position_rms_m = 0.0, residual_m = 0.0, noise_m = 0.0, tissue_m = 0.0;
};

bool of_leg(const std::string& coordinate) {
  for (const char* start : {"hip", "knee", "ankle", "subtalar", "mtp"})
    if (coordinate.starts_with(start)) return true;
  return false;
}

void restrict_motion(data::ModelDescription& model, const World& world) {
  for (auto& c : model.coordinates) {
    if (world.legs_still && of_leg(c.name)) {
      c.locked = true;
      c.default_value = c.name.starts_with("knee") ? -0.5 : c.name.starts_with("hip_flex") ? 0.3 : 0.0;
    } else if (world.width < 1.0 && c.clamped) {
      const double middle = c.name.starts_with("knee") || c.name.starts_with("elbow")
                                ? 0.5 * (c.range_min + c.range_max)
                                : 0.3 * (c.range_min + c.range_max);
      const double half = 0.5 * world.width * (c.range_max - c.range_min);
      c.range_min = middle - half;
      c.range_max = middle + half;
      c.default_value = middle;
    }
  }
}

Outcome simulate(const data::ModelDescription& human, int subjects, const World& world) {
  Outcome out;
  for (auto* m : {&out.error, &out.sd, &out.interval, &out.data_sd}) m->setZero(kLengths, subjects);
  out.determined.setZero(kLengths, subjects);
  double position_squares = 0.0, positions = 0.0;
  const pipeline::ScaleJob command;
  for (int s = 0; s < subjects; ++s) {
    const Subject subject = draw_subject(human, s);
    data::ModelDescription moving = subject.model;
    restrict_motion(moving, world);
    const auto recording = simulation::simulate_subject(model::Model::compile(std::move(moving)).value(),
                                                        {.motion = simulation::MotionKind::mixed,
                                                         .duration_s = 10.0,
                                                         .rate_hz = 60.0,
                                                         .seed = 500 + static_cast<std::uint64_t>(s),
                                                         .noise_sd_m = kNoise_m,
                                                         .soft_tissue = world.soft_tissue})
                               .value();
    data::ModelDescription start = human;
    const double overall = motion::find_overall_size(start, recording.markers).value();
    motion::apply_factors(start, std::vector(start.bodies.size(), Eigen::Vector3d::Constant(overall).eval()),
                          true);
    auto parameters =
        motion::scale_parameters(start, motion::default_scale_groups(start), command.size_prior_sd).value();
    const auto free_positions = motion::marker_parameters(start, {}, command.position_prior_sd_m).value();
    parameters.insert(parameters.end(), free_positions.begin(), free_positions.end());
    auto options = command.adapt;
    options.max_frames = world.max_frames;
    options.threads = 0;
    const auto result = motion::adapt_model(start, recording.markers, parameters, options).value();
    out.names.clear();
    for (int k = 0; k < kLengths; ++k) {
      const auto& p = result.parameters[static_cast<std::size_t>(k)];
      const double whole = subject.size[k] / overall;
      out.names.push_back(p.name);
      out.error(k, s) = 100.0 * (p.value - whole) / whole;
      out.sd(k, s) = 100.0 * p.sd / whole;
      out.interval(k, s) = 100.0 * p.interval() / whole;
      out.data_sd(k, s) = 100.0 * p.data_sd / whole;
      out.determined(k, s) = p.determined;
    }
    for (std::size_t m = 0; m < subject.model.markers.size(); ++m) {
      position_squares +=
          (result.model.markers[m].x_in_body - subject.model.markers[m].x_in_body).squaredNorm();
      positions += 3.0;
    }
    out.residual_m += result.rms_after_m / subjects;
    out.noise_m += result.noise_sd_m / subjects;
    out.tissue_m += result.tissue_sd_m / subjects;
    fmt::print(stderr, "subject {} {} iterations, noise {:.3f} mm, tissue {:.3f} mm\n", s, result.iterations,
               1e3 * result.noise_sd_m, 1e3 * result.tissue_sd_m);
  }
  out.position_rms_m = std::sqrt(position_squares / positions);
  return out;
}

double rms(const Eigen::MatrixXd& m, int row) {
  return std::sqrt(m.row(row).squaredNorm() / static_cast<double>(m.cols()));
}

void print_table(const Outcome& o) {
  for (int k = 0; k < kLengths; ++k)
    fmt::print(
        "  {:14} error RMS {:6.3f} max {:6.2f} %, SD {:6.3f} %, by motion alone {:6.2f} %, determined {} of "
        "{}\n",
        o.names[static_cast<std::size_t>(k)], rms(o.error, k), o.error.row(k).cwiseAbs().maxCoeff(),
        rms(o.sd, k), rms(o.data_sd, k), o.determined.row(k).sum(), o.determined.cols());
  fmt::print(
      "  marker positions {:.2f} mm RMS per axis, residual {:.2f} mm, noise {:.2f} mm, tissue {:.2f} mm\n",
      1e3 * o.position_rms_m, 1e3 * o.residual_m, 1e3 * o.noise_m, 1e3 * o.tissue_m);
}

struct Coverage {
  double one = 0.0, two = 0.0;
};

/// Share (%) of errors within one and two deviations.
Coverage coverage(const Eigen::MatrixXd& error, const Eigen::MatrixXd& sd) {
  Coverage c;
  c.one = 100.0 * (error.array().abs() <= sd.array()).cast<double>().mean();
  c.two = 100.0 * (error.array().abs() <= 2.0 * sd.array()).cast<double>().mean();
  return c;
}

std::string say(const Coverage& c) { return fmt::format("{:.1f} / {:.1f} %", c.one, c.two); }

bool is_end(const std::string& name) {
  return name == "head" || name.starts_with("hand") || name.starts_with("foot");
}

void rich(const data::ModelDescription& human, int subjects) {
  const Outcome o = simulate(human, subjects, {});
  print_table(o);
  double worst = 0.0, forearm = 0.0;
  for (int k = 0; k < kLengths; ++k) {
    const auto& name = o.names[static_cast<std::size_t>(k)];
    if (is_end(name)) continue;
    double& mine = name.starts_with("forearm") ? forearm : worst;
    mine = std::max(mine, rms(o.error, k));
  }
  const Coverage c = coverage(o.error, o.sd);
  print_row(worst <= 0.3, "rich motion: long bones, pelvis, trunk", "<= 0.3 % RMS, the worst of 10",
            fmt::format("{:.3f} %", worst));
  print_row(forearm <= 0.8, "rich motion: forearms", "<= 0.8 % RMS", fmt::format("{:.3f} %", forearm));
  print_row(c.one >= 62.0 && c.one <= 75.0 && c.two >= 91.0 && c.two <= 98.0,
            "rich motion: coverage of all 17 sizes", "62-75 / 91-98 %", say(c));
  int refused = 0, wrongly = 0;
  for (int k = 0; k < kLengths; ++k) {
    const auto& name = o.names[static_cast<std::size_t>(k)];
    const int called_determined = o.determined.row(k).sum();
    if (name == "head" || name.starts_with("hand")) refused += subjects - called_determined;
    if (!is_end(name)) wrongly += subjects - called_determined;
  }
  print_row(refused == 3 * subjects && wrongly == 0, "rich motion: what is not determined",
            "head and hands always, bones between joints never",
            fmt::format("{} of {} end segments refused, {} bones", refused, 3 * subjects, wrongly));
}

// The deviations of rich motion hardly differ between subjects: a few suffice to show the effect of poor
// motion.
void poor(const data::ModelDescription& human, int subjects) {
  const Outcome wide = simulate(human, std::min(subjects, 4), {});
  const Outcome o = simulate(human, subjects, {.width = 0.15});
  print_table(o);
  const Coverage c = coverage(o.error, o.sd);
  double narrowest = 1e9;
  for (int k = 0; k < kLengths; ++k)
    if (!is_end(o.names[static_cast<std::size_t>(k)]))
      narrowest = std::min(narrowest, rms(o.sd, k) / rms(wide.sd, k));
  print_row(c.one >= 62.0 && c.two >= 91.0 && narrowest > 1.0, "poor motion (amplitude x 0.15): intervals",
            "wider for every bone and covering >= 62 / 91 %",
            fmt::format("{:.1f} times and more, {}", narrowest, say(c)));
}

void still(const data::ModelDescription& human, int subjects) {
  const Outcome o = simulate(human, subjects, {.legs_still = true});
  print_table(o);
  const Coverage c = coverage(o.error, o.interval);
  int called_determined = 0;
  for (int k = 0; k < kLengths; ++k) {
    const auto& name = o.names[static_cast<std::size_t>(k)];
    if (name.starts_with("thigh") || name.starts_with("shank") || name.starts_with("foot"))
      called_determined += o.determined.row(k).sum();
  }
  print_row(called_determined == 0, "still legs: thigh, shank and foot", "never called determined",
            fmt::format("{} of {} called determined", called_determined, 6 * subjects));
  print_row(c.one >= 62.0 && c.two >= 91.0, "still legs: intervals cover", ">= 62 / 91 %", say(c));
  // The intervals of what is not determined are those of the sizes' prior, far wider than the errors. The
  // deviations, which assume the prior of the marker positions, are smaller and have the same bounds.
  const Coverage d = coverage(o.error, o.sd);
  print_row(d.one >= 62.0 && d.two >= 91.0, "still legs: deviations cover, given placed markers",
            ">= 62 / 91 %", say(d));
}

void tissue(const data::ModelDescription& human, int subjects) {
  const Outcome o = simulate(human, subjects, {.soft_tissue = 0.5});
  print_table(o);
  const Coverage c = coverage(o.error, o.sd);
  print_row(c.one >= 60.0 && c.two >= 88.0, "soft tissue x 0.5: coverage of all 17 sizes", ">= 60 / 88 %",
            say(c));
}

/// Few subjects and few frames, with bounds that chance hardly passes: what `make test` has time for.
void quick(const data::ModelDescription& human) {
  const auto worst_of = [](const Outcome& o) { return o.error.cwiseQuotient(o.sd).cwiseAbs().maxCoeff(); };
  const Outcome moving = simulate(human, 2, {.max_frames = 150});
  double squares = 0.0, count = 0.0;
  int right = 0;
  for (int k = 0; k < kLengths; ++k) {
    const auto& name = moving.names[static_cast<std::size_t>(k)];
    if (!is_end(name) && !name.starts_with("forearm")) {
      squares += moving.error.row(k).squaredNorm();
      count += 2.0;
    }
    if (!is_end(name)) right += moving.determined.row(k).sum();
    if (name == "head" || name.starts_with("hand")) right += 2 - moving.determined.row(k).sum();
  }
  print_row(std::sqrt(squares / count) <= 0.5, "2 subjects, 150 frames: long bones, pelvis, trunk",
            "<= 0.5 % RMS over all", fmt::format("{:.3f} %", std::sqrt(squares / count)));
  print_row(right == 2 * 15, "2 subjects: bones determined, head and hands not", "30 of 30",
            fmt::format("{} of 30", right));
  const Outcome still_legs = simulate(human, 1, {.legs_still = true, .max_frames = 150});
  int called_determined = 0;
  for (int k = 0; k < kLengths; ++k)
    for (const char* segment : {"thigh", "shank", "foot"})
      if (still_legs.names[static_cast<std::size_t>(k)].starts_with(segment))
        called_determined += still_legs.determined(k, 0);
  print_row(called_determined == 0, "a subject with still legs: thigh, shank and foot",
            "never called determined", fmt::format("{} of 6 called determined", called_determined));
  const double worst = std::max(worst_of(moving), worst_of(still_legs));
  print_row(worst <= 4.5, "3 subjects: error over deviation, worst of 51", "<= 4.5",
            fmt::format("{:.2f}", worst));
}

int run_check(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + 1, argv + argc);
  const int subjects = arguments.size() > 1 ? std::stoi(arguments[1]) : 40;
  const auto human = io::read_osim(testing_support::project_folder() / "models/human.osim").value();
  const std::string which = arguments.empty() ? "rich" : arguments[0];
  if (which == "quick") quick(human);
  if (which == "rich") rich(human, subjects);
  if (which == "poor") poor(human, subjects);
  if (which == "still") still(human, subjects);
  if (which == "tissue") tissue(human, subjects);
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("scaling", run_check);

}  // namespace
