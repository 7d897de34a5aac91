// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/plate_forces.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "kinemark/core/missing.h"
#include "kinemark/io/c3d/force_plates.h"
#include "kinemark/io/c3d/internal/plate_wrench.h"

namespace kinemark::io {
namespace {

using Eigen::Vector3d;
using internal::Channels;
using internal::Vector6;

constexpr double kSurelyLoaded = 100.0;  // N; noise and drift of plates stay below it
constexpr std::int64_t kBlockNumbers = 1 << 18;

/// A plate with valid geometry, and its measurements.
struct Plate {
  std::string name;
  std::vector<int> channel_idx;
  internal::PlateWrench wrench;
  internal::PlatePose pose;
  Channels baseline;
  std::vector<Vector6> measured;  ///< F; force and moment about the centre, plate axes
};

/// Frames in pieces: body(first, count, analog, x) with the samples of frames first - 1 (if there is one) to
/// first + count and the markers of frames first to first + count.
template <class Body>
Status for_each_piece(const C3dReader& reader, std::int64_t first, std::int64_t last, bool markers,
                      Body&& body) {
  const C3dLayout& layout = reader.layout();
  const std::int64_t per_frame = std::max<std::int64_t>(1, layout.analog_per_frame() + 3 * layout.markers);
  const std::int64_t piece = std::max<std::int64_t>(8, kBlockNumbers / per_frame);
  Array<double> analog, x;
  for (std::int64_t f = first; f < last; f += piece) {
    const std::int64_t count = std::min(piece, last - f), begin = std::max<std::int64_t>(0, f - 1);
    const auto frames = static_cast<std::size_t>(f + count - begin);
    analog.resize(frames * static_cast<std::size_t>(layout.analog_per_frame()));
    x.resize(markers ? frames * static_cast<std::size_t>(3 * layout.markers) : 0);
    C3dFrames out;
    out.analog = analog;
    out.x_in_world = x;
    if (const auto seen = reader.read(begin, f + count - begin, out); !seen)
      return std::unexpected(seen.error());
    body(f, count, std::span<const double>(analog),
         std::span<const double>(x).subspan(
             x.empty() ? 0 : static_cast<std::size_t>((f - begin) * 3 * layout.markers)));
  }
  return {};
}

Channels sample(const Plate& plate, std::span<const double> analog, std::int64_t row, std::int64_t channels) {
  Channels v(static_cast<Eigen::Index>(plate.baseline.size()));
  for (Eigen::Index c = 0; c < v.size(); ++c)
    v[c] = analog[static_cast<std::size_t>(row * channels + plate.channel_idx[static_cast<std::size_t>(c)])];
  return v;
}

std::vector<Plate> usable_plates(const C3dReader& reader, std::vector<std::string>& warnings) {
  const auto& analog = reader.description().analog;
  std::vector<Plate> plates;
  std::vector<bool> taken(analog.names.size(), false);
  for (C3dForcePlate& found : find_force_plates(reader.parameters(), reader.layout(), warnings)) {
    // No two plates share a channel; this also bounds the work that a hostile file can cause.
    bool shared = false;
    for (const int channel : found.plate.channel_idx) {
      shared = shared || taken[static_cast<std::size_t>(channel)];
      taken[static_cast<std::size_t>(channel)] = true;
    }
    if (shared) {
      warnings.push_back(
          fmt::format("force plate {} is left out: an analog channel of it is used twice", found.number));
      continue;
    }
    auto wrench = internal::PlateWrench::create(found, analog.units, reader.layout().metres_per_unit);
    auto pose = internal::plate_pose(found);
    if (!wrench || !pose) {
      warnings.push_back(fmt::format("force plate {} is left out: it {}", found.number,
                                     wrench ? pose.error().message : wrench.error().message));
      continue;
    }
    if (wrench->origin_flipped())
      warnings.push_back(fmt::format(
          "force plate {} has an ORIGIN above its surface; taken as measured from the surface instead",
          found.number));
    Plate plate{.name = fmt::format("plate {}", found.number),
                .channel_idx = std::move(found.plate.channel_idx),
                .wrench = std::move(*wrench),
                .pose = *pose,
                .baseline = {},
                .measured = {}};
    plate.baseline.setZero(static_cast<Eigen::Index>(std::min<std::size_t>(8, plate.channel_idx.size())));
    plates.push_back(std::move(plate));
  }
  return plates;
}

/// Fill the plates' baselines from the frames that ZERO names (counted from 1).
Status find_baselines(const C3dReader& reader, std::vector<Plate>& plates,
                      std::vector<std::string>& warnings) {
  const auto zero = reader.parameters().numbers("FORCE_PLATFORM", "ZERO");
  const C3dLayout& layout = reader.layout();
  const auto frames = static_cast<double>(layout.frames);
  if (zero.size() < 2 || !(zero[0] >= 1.0 && zero[0] <= zero[1] && zero[1] <= frames)) return {};
  const auto first = static_cast<std::int64_t>(zero[0]) - 1, last = static_cast<std::int64_t>(zero[1]);
  std::vector<Channels> sums;
  for (const Plate& plate : plates) sums.push_back(Channels::Zero(plate.baseline.size()));
  auto status = for_each_piece(reader, first, last, false,
                               [&](std::int64_t f, std::int64_t count, std::span<const double> analog, auto) {
                                 const std::int64_t margin = f > 0 ? layout.samples_per_frame : 0;
                                 for (std::size_t p = 0; p < plates.size(); ++p)
                                   for (std::int64_t i = 0; i < count * layout.samples_per_frame; ++i)
                                     sums[p] += sample(plates[p], analog, margin + i, layout.analog_channels);
                               });
  if (!status) return status;
  for (std::size_t p = 0; p < plates.size(); ++p) {
    Plate& plate = plates[p];
    sums[p] /= static_cast<double>((last - first) * layout.samples_per_frame);
    for (Eigen::Index c = 0; c < sums[p].size(); ++c)
      if (!plate.wrench.has_baseline(static_cast<std::size_t>(c)) || !std::isfinite(sums[p][c]))
        sums[p][c] = 0.0;
    const double load = std::abs(plate.wrench(sums[p])[2]);
    if (load < kSurelyLoaded)
      plate.baseline = sums[p];
    else
      warnings.push_back(
          fmt::format("{} carries {:.0f} N in the frames {} to {} that FORCE_PLATFORM:ZERO calls "
                      "empty; no baseline is subtracted",
                      plate.name, load, first + 1, last));
  }
  return {};
}

/// Mean of all positions of markers.
class MarkerMean {
 public:
  void add(std::span<const double> x, std::int64_t samples) {
    for (std::int64_t i = 0; i < samples; ++i) {
      const Eigen::Map<const Vector3d> point(x.data() + 3 * i);
      if (!(point.array().abs() < 1000.0).all()) continue;
      sum_ += point;
      ++count_;
    }
  }
  [[nodiscard]] Vector3d mean() const {
    return count_ > 0 ? Vector3d(sum_ / static_cast<double>(count_)) : Vector3d(Vector3d::Constant(kNaN));
  }

 private:
  Vector3d sum_ = Vector3d::Zero();
  std::int64_t count_ = 0;
};

/// Fill `measured` of all plates.
Result<Vector3d> measure(const C3dReader& reader, std::vector<Plate>& plates) {
  const C3dLayout& layout = reader.layout();
  const std::int64_t S = layout.samples_per_frame, samples = S * layout.frames;
  MarkerMean markers;
  for (Plate& plate : plates) plate.measured.resize(static_cast<std::size_t>(layout.frames));
  auto status = for_each_piece(
      reader, 0, layout.frames, true,
      [&](std::int64_t first, std::int64_t count, std::span<const double> analog, std::span<const double> x) {
        markers.add(x, count * layout.markers);
        const std::int64_t origin = std::max<std::int64_t>(0, first - 1) * S;  // of the piece, in samples
        for (std::int64_t f = first; f < first + count; ++f) {
          const std::int64_t at = f * S, half = std::min({S / 2, at, samples - 1 - at});
          for (Plate& plate : plates) {
            Vector6 sum = Vector6::Zero();
            double weights = 0.0;
            for (std::int64_t k = -half; k <= half; ++k) {
              // An even number of samples has none in its middle: both ends of the window count half.
              const double weight = S % 2 == 0 && half > 0 && std::abs(k) == half ? 0.5 : 1.0;
              sum += weight * plate.wrench(sample(plate, analog, at + k - origin, layout.analog_channels) -
                                           plate.baseline);
              weights += weight;
            }
            plate.measured[static_cast<std::size_t>(f)] = sum / weights;
          }
        }
      });
  if (!status) return std::unexpected(status.error());
  return markers.mean();
}

/// +1 when the body is on the side of the plate's z, else -1 (as it should be: z points into the plate).
double side_of_body(const Plate& plate, const Vector3d& markers, std::vector<std::string>& warnings) {
  const double height = (markers - plate.pose.centre).dot(plate.pose.world_from_plate.col(2));
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

data::Wrench on_body(const Plate& plate, double side, const PlateOptions& options,
                     std::vector<std::string>& warnings) {
  data::Wrench wrench{.name = plate.name, .body = "", .force = {}, .moment = {}, .point = {}};
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
        point = {-moment.y() / force.z(), moment.x() / force.z(), 0.0};
        moment = {0.0, 0.0, moment.z() - point.x() * force.y() + point.y() * force.x()};
        const bool inside = (point.head<2>().array().abs() < 1.2 * plate.pose.half_size.array() + 0.02).all();
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
    warnings.push_back(
        fmt::format("the centre of pressure leaves {} in {} of {} frames with {:.0f} N or more; its "
                    "ORIGIN, CORNERS or the unit of its moments may be wrong",
                    plate.name, off, loaded, kSurelyLoaded));
  return wrench;
}

}  // namespace

Status PlateOptions::check() const {
  if (!std::isfinite(contact_force_n) || contact_force_n < 0.0)
    return fail(Code::usage, fmt::format("contact force is {} N; need 0 or more", contact_force_n));
  return {};
}

Result<PlateForces> read_plate_forces(const C3dReader& reader, const PlateOptions& options) {
  if (auto status = options.check(); !status) return std::unexpected(status.error());
  const data::Trial& trial = reader.description();
  PlateForces forces;
  auto plates = usable_plates(reader, forces.warnings);
  if (plates.empty() || reader.layout().samples_per_frame < 1 || trial.markers.frames() < 1)
    return fail(Code::bad_input, fmt::format("{}: has no force plate whose forces can be read{}{}",
                                             trial.source, forces.warnings.empty() ? "" : "; ",
                                             forces.warnings.empty() ? "" : forces.warnings.front()));
  if (options.baseline)
    if (auto status = find_baselines(reader, plates, forces.warnings); !status)
      return std::unexpected(status.error());
  const auto markers = measure(reader, plates);
  if (!markers) return std::unexpected(markers.error());
  forces.wrenches.time = trial.markers.time;
  for (Plate& plate : plates) {
    const double side = side_of_body(plate, *markers, forces.warnings);
    settle_sign(plate, side, forces.warnings);
    forces.wrenches.items.push_back(on_body(plate, side, options, forces.warnings));
  }
  return forces;
}

Result<PlateForces> read_plate_forces(const std::filesystem::path& path, const PlateOptions& options) {
  const auto reader = C3dReader::open(path);
  if (!reader) return std::unexpected(reader.error());
  return read_plate_forces(*reader, options);
}

}  // namespace kinemark::io
