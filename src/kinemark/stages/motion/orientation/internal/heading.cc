// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/orientation/internal/heading.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "kinemark/core/index.h"
#include "kinemark/math/golden_section.h"
#include "kinemark/stages/motion/orientation/internal/turning_model.h"

namespace kinemark::motion::internal {
namespace {

constexpr std::size_t kFrames = 24;  // that are tried
constexpr int kHeadings = 24;        // one in 15 deg
constexpr int kStarts = 6;           // poses of the first frame
constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kWidth = 0.01 * kDegree;  // to which a heading is refined
constexpr double kStep = 2.0 * kDegree;    // for the curvature
constexpr double kMostSd = 10.0 * kDegree;
constexpr double kRivals = 9.0;  // 3 standard deviations, squared
constexpr double kExact = 1e-6;  // rad, residuals of a simulation without noise

/// At most kFrames of them, evenly spread.
std::vector<std::int64_t> spread(const std::vector<std::int64_t>& frames) {
  if (frames.size() <= kFrames) return frames;
  std::vector<std::int64_t> out;
  for (std::size_t i = 0; i < kFrames; ++i) out.push_back(frames[i * (frames.size() - 1) / (kFrames - 1)]);
  return out;
}

/// How badly a heading explains the motion: the sum of squared angles, rad^2.
class HeadingCost {
 public:
  HeadingCost(const model::Model& model, const data::Orientations& recording, const PosedSensors& posed,
              const std::vector<std::int64_t>& frames, const OrientationOptions& options)
      : description_(model.description()), recording_(recording), posed_(posed), frames_(frames) {
    // A knee that bends backwards tells a heading that is half a turn off, whether or not its limits are
    // kept.
    if (options.limits)
      for (auto& coordinate : description_.coordinates)
        coordinate.clamped = coordinate.range_min < coordinate.range_max;
    options_.judge_samples = false;
    options_.error_bars = false;
    options_.limits = options.limits;
    options_.seed = options.seed;
    options_.starts = kStarts;
  }

  /// Infinite where nothing can be solved.
  double operator()(double heading_rad) const {
    const auto solved = solve_turned(description_, recording_, posed_, frames_, heading_rad, options_);
    if (!solved) return std::numeric_limits<double>::infinity();
    double squares = 0.0;
    for (const double e : solved->motion.marker_error)
      if (std::isfinite(e)) squares += e * e;
    return 0.5 * squares / (kAxis_m * kAxis_m);
  }

  /// Numbers that the frames tell less the numbers that are fitted, at most: a coordinate may be free.
  [[nodiscard]] double freedom() const {
    const auto turns = turning_coordinates(description_);
    const auto fitted = std::ranges::count(turns, true);
    double numbers = 0.0;
    for (const auto f : frames_) {
      std::int64_t seen = 0;
      for (const auto& sensor : posed_.sensors) seen += recording_.present(f, sensor.column) ? 3 : 0;
      numbers += static_cast<double>(std::max<std::int64_t>(1, seen - fitted));
    }
    return std::max(1.0, numbers);
  }

 private:
  data::ModelDescription description_;
  const data::Orientations& recording_;
  const PosedSensors& posed_;
  const std::vector<std::int64_t>& frames_;
  IkOptions options_;
};

struct Candidate {
  double rad = 0.0, cost = 0.0;
};

/// The valleys of the cost over a full turn, refined, the best one first.
std::vector<Candidate> valleys(const std::function<double(double)>& cost) {
  constexpr double kSpacing = 2.0 * std::numbers::pi / kHeadings;
  std::vector<double> tried;
  for (int i = 0; i < kHeadings; ++i) tried.push_back(cost(i * kSpacing));
  std::vector<Candidate> out;
  for (int i = 0; i < kHeadings; ++i) {
    const double here = tried[at(i)];
    if (here > tried[at((i + 1) % kHeadings)] || here > tried[at((i + kHeadings - 1) % kHeadings)]) continue;
    const auto found = math::golden_section(cost, (i - 1) * kSpacing, (i + 1) * kSpacing, {.width = kWidth});
    out.push_back({std::remainder(found.at, 2.0 * std::numbers::pi), found.value});
  }
  std::ranges::sort(out, {}, &Candidate::cost);
  return out;
}

}  // namespace

Result<IkResult> solve_turned(const data::ModelDescription& model, const data::Orientations& recording,
                              const PosedSensors& posed, const std::vector<std::int64_t>& frames,
                              double heading_rad, const IkOptions& options, const Progress& progress) {
  std::vector<SensorTips> tips;
  for (const auto& sensor : posed.sensors)
    tips.push_back({.column = sensor.column,
                    .body_idx = sensor.body_idx,
                    .body_from_sensor = body_from_sensor(posed, sensor, heading_rad)});
  // Without translations no joint is free: the file's Euler angles are the states.
  const auto turning = model::Model::compile(turning_model(model, tips), {.free_roots = false});
  if (!turning) return std::unexpected(turning.error());
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(heading_rad, posed.up) * posed.model_from_world;
  return solve_ik(*turning, record_tips(recording, tips, turn, frames), options, progress);
}

Result<Heading> choose_heading(const std::function<double(double)>& cost, double freedom,
                               double least_variance) {
  const auto found = valleys(cost);
  const auto open = [](const std::string& why) {
    return fail(Code::bad_input,
                "the heading of the sensors is not determined by the motion: " + why +
                    "; name an axis of a sensor that faces forward in the pose, --heading SENSOR:AXIS");
  };
  if (found.empty() || !std::isfinite(found.front().cost)) return open("no heading explains it");
  const auto& best = found.front();
  const double variance = std::max(best.cost / freedom, least_variance);
  const double curvature =
      (cost(best.rad + kStep) + cost(best.rad - kStep) - 2.0 * best.cost) / (kStep * kStep);
  const double sd = curvature > 0.0 ? std::sqrt(2.0 * variance / curvature) : std::numbers::pi;
  if (sd > kMostSd) return open("its joints' axes leave it open");
  for (const auto& rival : found) {
    if (std::abs(std::remainder(rival.rad - best.rad, 2.0 * std::numbers::pi)) < 3.0 * sd + kWidth) continue;
    if (rival.cost - best.cost < kRivals * variance)
      return open(
          fmt::format("{:.0f} and {:.0f} deg explain it alike", best.rad / kDegree, rival.rad / kDegree));
  }
  return Heading{best.rad, sd};
}

Result<Heading> estimate_heading(const model::Model& model, const data::Orientations& recording,
                                 const PosedSensors& posed, const std::vector<std::int64_t>& frames,
                                 const OrientationOptions& options) {
  const auto tried = spread(frames);
  const HeadingCost cost(model, recording, posed, tried, options);
  return choose_heading([&cost](double rad) { return cost(rad); }, cost.freedom(),
                        std::max(options.noise_sd_rad * options.noise_sd_rad, kExact * kExact));
}

}  // namespace kinemark::motion::internal
