// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/plates/plate_forces.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/core/number.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/plates/internal/moment_unit.h"
#include "kinemark/io/plates/internal/plate_wrench.h"

namespace kinemark::io {
namespace {

using Eigen::Vector3d;
using internal::is_on_plate;
using internal::kSurelyLoaded;
using internal::plate_pose;
using internal::PlateChannels;
using internal::PlatePose;
using internal::PlateWrench;
using internal::Vector6;

/// A plate with valid geometry, and its measurements.
struct Plate {
  std::string name;
  std::vector<int> channel_idx;
  PlateWrench wrench;
  PlatePose pose;
  std::vector<Vector3d> corners_in_world;
  std::vector<double> pressure_correction;  ///< as of data::ForcePlate
  PlateChannels baseline;
  std::vector<Vector6> measured;  ///< F; force and moment about the centre, plate axes
};

/// Values of a plate's channels in a row of analog samples.
PlateChannels sample(const Plate& plate, const data::AnalogChannels& analog, std::int64_t row) {
  const auto channels = std::ssize(analog.names);
  PlateChannels v(plate.baseline.size());
  for (Eigen::Index c = 0; c < v.size(); ++c)
    v[c] = analog.values[static_cast<std::size_t>(row * channels +
                                                  plate.channel_idx[static_cast<std::size_t>(c)])];
  return v;
}

std::vector<Plate> usable_plates(const data::Trial& trial, std::vector<std::string>& warnings) {
  std::vector<Plate> plates;
  std::vector<bool> taken(trial.analog.names.size(), false);
  for (const auto& found : trial.force_plates) {
    // No two plates share a channel; this also bounds the work that a hostile file can cause.
    bool shared = false;
    for (const int channel : found.channel_idx) {
      shared = shared || taken[static_cast<std::size_t>(channel)];
      taken[static_cast<std::size_t>(channel)] = true;
    }
    if (shared) {
      warnings.push_back(
          fmt::format("force plate {} is left out: an analog channel of it is used twice", found.number));
      continue;
    }
    auto wrench = PlateWrench::create(found, trial.analog.units);
    auto pose = plate_pose(found);
    if (!wrench || !pose) {
      warnings.push_back(fmt::format("force plate {} is left out: it {}", found.number,
                                     wrench ? pose.error().message : wrench.error().message));
      continue;
    }
    if (wrench->origin_flipped())
      warnings.push_back(fmt::format(
          "force plate {} has an ORIGIN above its surface; taken as measured from the surface instead",
          found.number));
    if (const auto& unknown = wrench->unknown_units(); !unknown.empty())
      warnings.push_back(
          fmt::format("force plate {} has {}, which is no unit of what these measure; forces are taken as N, "
                      "moments as N times the file's unit of length",
                      found.number, join_some(unknown, 3)));
    // Other types have moments, or the point itself, that the maker's program has computed.
    const bool sensors = found.type == 3 || found.type == 7;
    if (!found.pressure_correction.empty())
      warnings.push_back(fmt::format(
          "force plate {}: {}", found.number,
          sensors
              ? "its centre of pressure is corrected by the file's polynomial (FPCOPPOLY)"
              : fmt::format("its polynomial of the centre of pressure (FPCOPPOLY), which is for plates of "
                            "types 3 and 7, is not applied to one of type {}",
                            found.type)));
    Plate plate{.name = fmt::format("plate {}", found.number),
                .channel_idx = found.channel_idx,
                .wrench = std::move(*wrench),
                .pose = *pose,
                .corners_in_world = {found.corners_in_world.begin(), found.corners_in_world.end()},
                .pressure_correction = sensors ? found.pressure_correction : std::vector<double>(),
                .baseline = {},
                .measured = {}};
    plate.baseline.setZero(static_cast<Eigen::Index>(internal::channels_needed(found.type)));
    plates.push_back(std::move(plate));
  }
  return plates;
}

/// Analog samples of a frame; 0: not the same whole number in every frame.
std::int64_t samples_of_frame(const data::Trial& trial) {
  const auto frames = trial.markers.frames(), samples = trial.analog.samples;
  return frames > 0 && samples % frames == 0 ? samples / frames : 0;
}

/// The baseline of a plate: the mean of its channels in `count` samples from `first` on.
PlateChannels mean_of(const Plate& plate, const data::AnalogChannels& analog, std::int64_t first,
                      std::int64_t count) {
  PlateChannels mean = PlateChannels::Zero(plate.baseline.size());
  for (std::int64_t i = first; i < first + count; ++i) mean += sample(plate, analog, i);
  mean /= static_cast<double>(count);
  for (Eigen::Index c = 0; c < mean.size(); ++c)
    if (!plate.wrench.has_baseline(static_cast<std::size_t>(c)) || !std::isfinite(mean[c])) mean[c] = 0.0;
  return mean;
}

/// Fill the plates' baselines from the frames in which nobody loads them, where all of these are there.
void find_baselines(const data::Trial& trial, std::int64_t per_frame, std::vector<Plate>& plates,
                    std::vector<std::string>& warnings) {
  const auto frames = data::unloaded_frames(trial);
  if (!frames) return;
  const auto [first, last] = *frames;
  for (auto& plate : plates) {
    const auto mean = mean_of(plate, trial.analog, first * per_frame, (last + 1 - first) * per_frame);
    const double load = std::abs(plate.wrench(mean)[2]);
    if (load < kSurelyLoaded)
      plate.baseline = mean;
    else
      warnings.push_back(
          fmt::format("{} carries {:.0f} N in the frames {} to {} that FORCE_PLATFORM:ZERO calls "
                      "empty; no baseline is subtracted",
                      plate.name, load, first + 1, last + 1));
  }
}

/// Mean of all positions of markers.
Vector3d mean_of_markers(const data::Trajectories& markers) {
  Vector3d sum = Vector3d::Zero();
  std::int64_t count = 0;
  for (std::size_t i = 0; i + 2 < markers.x_in_world.size(); i += 3) {
    const Eigen::Map<const Vector3d> point(markers.x_in_world.data() + i);
    if (!(point.array().abs() < 1000.0).all()) continue;
    sum += point;
    ++count;
  }
  return count > 0 ? Vector3d(sum / static_cast<double>(count)) : Vector3d(Vector3d::Constant(kNaN));
}

/// Fill `measured` of a plate, S samples a frame.
void measure(const data::Trial& trial, std::int64_t S, Plate& plate) {
  const auto frames = trial.markers.frames(), samples = S * frames;
  plate.measured.reserve(static_cast<std::size_t>(frames));
  for (std::int64_t f = 0; f < frames; ++f) {
    const std::int64_t at = f * S, half = std::min({S / 2, at, samples - 1 - at});
    Vector6 sum = Vector6::Zero();
    double weights = 0.0;
    for (std::int64_t k = -half; k <= half; ++k) {
      // An even number of samples has none in its middle: both ends of the window count half.
      const double weight = S % 2 == 0 && half > 0 && std::abs(k) == half ? 0.5 : 1.0;
      sum += weight * plate.wrench(sample(plate, trial.analog, at + k) - plate.baseline);
      weights += weight;
    }
    plate.measured.emplace_back(sum / weights);
  }
}

/// Moments whose unit, stated or not, puts the centre of pressure metres away or nails it to the middle, and
/// that a thousandth or a thousand times as much puts on the plate, are taken so.
void settle_moment_unit(const data::Trial& trial, std::int64_t S, Plate& plate,
                        std::vector<std::string>& warnings) {
  if (!plate.wrench.has_moment_unit()) return;
  for (const double factor : {1e-3, 1e3}) {
    Plate other = plate;
    other.wrench.scale_moments(factor);
    other.measured.clear();
    measure(trial, S, other);
    const auto& larger = factor < 1.0 ? plate : other;
    const auto& smaller = factor < 1.0 ? other : plate;
    if (!internal::is_a_thousandth(larger.measured, smaller.measured, factor < 1.0, plate.pose.half_size))
      continue;
    plate = std::move(other);
    const auto at = static_cast<std::size_t>(plate.channel_idx[3]);
    const auto unit = at < trial.analog.units.size() ? trim(trial.analog.units[at]) : std::string_view();
    warnings.push_back(
        fmt::format("{} has {} that {} makes a thousand times too {}: the centre of pressure would {}; they "
                    "are {} by 1000",
                    plate.name, plate.wrench.has_baseline(3) ? "moments" : "points of the force",
                    unit.empty() ? std::string("the usual unit (none is stated)")
                                 : fmt::format("the unit '{}'", printable(unit, 20)),
                    factor < 1.0 ? "large" : "small",
                    factor < 1.0 ? "lie metres beside the plate" : "stay at the middle of the sensors",
                    factor < 1.0 ? "divided" : "multiplied"));
    return;
  }
}

/// Where no marker tells on which side the body is: laboratories have an axis that points up, and none that
/// points down.
double side_of_up(const Plate& plate, std::vector<std::string>& warnings) {
  const Vector3d z = plate.pose.world_from_plate.col(2);
  Eigen::Index up = 0;
  z.cwiseAbs().maxCoeff(&up);
  warnings.push_back(fmt::format("no marker tells on which side of {} the body is; {} is taken as up",
                                 plate.name, "xyz"[up]));
  return z[up] > 0.0 ? 1.0 : -1.0;
}

/// +1 when the body is on the side of the plate's z, else -1 (as it should be: z points into the plate).
double side_of_body(const Plate& plate, const Vector3d& markers, std::vector<std::string>& warnings) {
  const double height = (markers - plate.pose.centre).dot(plate.pose.world_from_plate.col(2));
  if (std::isnan(height)) return side_of_up(plate, warnings);
  if (!(height > 0.0)) return -1.0;
  warnings.push_back(
      fmt::format("{} has corners in the opposite order (its z axis points at the body); its axes are "
                  "taken as they are",
                  plate.name));
  return 1.0;
}

/// The force of the plate on the body: the sign is reversed where the file stores the force of the body on
/// the plate.
void settle_sign(Plate& plate, double side, std::vector<std::string>& warnings) {
  double push = 0.0;
  for (const Vector6& w : plate.measured)
    if (std::isfinite(w[2]) && std::abs(w[2]) < 1e9) push += side * w[2] * std::abs(w[2]);
  if (push >= 0.0) return;
  for (Vector6& w : plate.measured) w = -w;
  warnings.push_back(
      fmt::format("{} stores the force of the body on the plate; its sign was reversed", plate.name));
}

/// Kistler's correction of the centre of pressure, in the plate's axes: less what a polynomial with six
/// numbers an axis says of the bending of the top (as ezc3d 1.7 applies it; numbers are of millimetres).
Vector3d corrected(const Vector3d& point, const std::vector<double>& numbers) {
  if (numbers.size() != 12) return point;
  const auto error_mm = [&](std::size_t axis, double along, double across) {
    const double square = across * across, fourth = square * square;
    const auto p = [&](std::size_t k) { return numbers[axis + 2 * k]; };
    return (p(0) * fourth + p(1) * square + p(2)) * along * along * along +
           (p(3) * fourth + p(4) * square + p(5)) * along;
  };
  const double x = 1e3 * point.x(), y = 1e3 * point.y();
  return {1e-3 * (x - error_mm(0, x, y)), 1e-3 * (y - error_mm(1, y, x)), point.z()};
}

data::Wrench on_body(const Plate& plate, double side, const PlateOptions& options, PlateForces& out) {
  data::Wrench wrench{.name = plate.name,
                      .body = "",
                      .force = {},
                      .moment = {},
                      .point = {},
                      .corners_in_world = plate.corners_in_world};
  std::int64_t loaded = 0, off = 0;
  for (const Vector6& w : plate.measured) {
    Vector3d force = w.head<3>(), moment = w.tail<3>(), point = Vector3d::Constant(kNaN);
    const double along = side * force.z();
    if (!w.allFinite()) {
      force = moment = Vector3d::Constant(kNaN);
    } else if (options.contact_force_n > 0.0 && along < options.contact_force_n) {
      force = moment = Vector3d::Zero();
    } else {
      point.setZero();
      // A force that is not directed into the plate has no centre of pressure; the centre of the plate is
      // used.
      if (along >= 1.0) {
        point = corrected({-moment.y() / force.z(), moment.x() / force.z(), 0.0}, plate.pressure_correction);
        moment = {0.0, 0.0, moment.z() - point.x() * force.y() + point.y() * force.x()};
        const bool inside = is_on_plate(point.head<2>(), plate.pose.half_size);
        loaded += along >= kSurelyLoaded;
        off += along >= kSurelyLoaded && !inside;
      }
      point = plate.pose.centre + plate.pose.world_from_plate * point;
      force = plate.pose.world_from_plate * force;
      moment = plate.pose.world_from_plate * moment;
      if (!(force.allFinite() && moment.allFinite() && point.allFinite()))
        force = moment = point = Vector3d::Constant(kNaN);
    }
    wrench.force.insert(wrench.force.end(), force.data(), force.data() + 3);
    wrench.moment.insert(wrench.moment.end(), moment.data(), moment.data() + 3);
    wrench.point.insert(wrench.point.end(), point.data(), point.data() + 3);
  }
  if (20 * off > loaded)
    out.warnings.push_back(
        fmt::format("the centre of pressure leaves {} in {} of {} frames with {:.0f} N or more; its "
                    "ORIGIN, CORNERS or the unit of its moments may be wrong",
                    plate.name, off, loaded, kSurelyLoaded));
  if (4 * off > loaded) out.contradicted.push_back(out.warnings.back());
  return wrench;
}

}  // namespace

Status PlateOptions::check() const {
  if (!std::isfinite(contact_force_n) || contact_force_n < 0.0)
    return fail(Code::usage, fmt::format("contact force is {} N; need 0 or more", contact_force_n));
  return {};
}

Result<PlateForces> plate_forces(const data::Trial& trial, const PlateOptions& options) {
  if (auto status = options.check(); !status) return std::unexpected(status.error());
  PlateForces forces;
  auto plates = usable_plates(trial, forces.warnings);
  const auto per_frame = samples_of_frame(trial);
  if (plates.empty() || per_frame < 1)
    return fail(Code::bad_input, fmt::format("{}: has no force plate whose forces can be read{}{}",
                                             trial.source, forces.warnings.empty() ? "" : "; ",
                                             forces.warnings.empty() ? "" : forces.warnings.front()));
  if (options.baseline) find_baselines(trial, per_frame, plates, forces.warnings);
  const auto markers = mean_of_markers(trial.markers);
  forces.wrenches.time = trial.markers.time;
  for (auto& plate : plates) {
    measure(trial, per_frame, plate);
    settle_moment_unit(trial, per_frame, plate, forces.warnings);
    const double side = side_of_body(plate, markers, forces.warnings);
    settle_sign(plate, side, forces.warnings);
    forces.wrenches.items.push_back(on_body(plate, side, options, forces));
  }
  return forces;
}

}  // namespace kinemark::io
