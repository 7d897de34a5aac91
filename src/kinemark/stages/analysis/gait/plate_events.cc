// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/plate_events.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kContact_n = 20.0, kInNoise = 5.0;
constexpr double kBears_n = 100.0;  // a contact that never bears more is no step
constexpr double kSurely_n = 50.0;  // the centre of pressure means something
constexpr double kLeast_s = 0.15, kMost_s = 3.0;
constexpr double kBeside_m = 0.12;    // from the line between heel and toe to the centre of pressure
constexpr double kShareBeside = 0.1;  // of a contact's frames
constexpr double kOutside_m = 0.02;   // of a marker, beyond the edge of the plate
constexpr double kRestOfFoot_m =
    0.2;  // of one marker alone from the edge: the rest of its foot lies on the plate too
constexpr double kLeastSd_s = 0.002, kSdInFrames = 0.2;

// Frames with a load: first to last.
struct Contact {
  std::int64_t first = 0, last = 0;
};

struct Plate {
  const data::Wrench* wrench = nullptr;
  std::vector<double> load;  // N, upwards, less the unloaded plate's; NaN where not measured
  double noise_n = 0.0;

  // N; a contact begins above it.
  [[nodiscard]] double begins() const { return std::max(kContact_n, kInNoise * noise_n); }
  [[nodiscard]] Vector3d centre(std::int64_t f, const Eigen::Matrix3d& upright) const {
    return upright * Eigen::Map<const Vector3d>(wrench->point.data() + 3 * f);
  }
};

Plate plate_of(const data::Wrench& wrench, std::int64_t frames, const Eigen::Matrix3d& upright) {
  Plate out{.wrench = &wrench, .load = {}};
  std::vector<double> unloaded;
  for (std::int64_t f = 0; f < frames; ++f) {
    out.load.push_back((upright * Eigen::Map<const Vector3d>(wrench.force.data() + 3 * f)).z());
    if (std::abs(out.load.back()) < kContact_n) unloaded.push_back(out.load.back());
  }
  if (unloaded.size() < 10) return out;
  const double baseline = math::median(unloaded);
  for (auto& x : unloaded) x = std::abs(x - baseline);
  out.noise_n = 1.4826 * math::median(unloaded);
  for (auto& x : out.load) x -= baseline;
  return out;
}

// Contacts that begin and end within the recording.
std::vector<Contact> contacts_of(const Plate& plate, double rate_hz) {
  const double begins = plate.begins(), ends = 0.5 * begins;
  std::vector<Contact> out;
  const auto n = static_cast<std::int64_t>(plate.load.size());
  for (std::int64_t f = 1; f < n; ++f) {
    if (!(plate.load[at(f)] > begins && plate.load[at(f - 1)] <= begins)) continue;
    std::int64_t last = f;
    double most = 0.0;
    while (last < n && plate.load[at(last)] > ends) most = std::max(most, plate.load[at(last++)]);
    const auto seconds = static_cast<double>(last - f) / rate_hz;
    if (last < n && std::isfinite(plate.load[at(last)]) && most > kBears_n && seconds > kLeast_s &&
        seconds < kMost_s)
      out.push_back({f, last - 1});
    f = std::max(f, last - 1);
  }
  return out;
}

double distance_to_foot(const FootPaths& foot, std::int64_t f, const Vector3d& point) {
  const Vector2d heel = foot.heel.row(f).leftCols<2>(), toe = foot.toe.row(f).leftCols<2>();
  const Vector2d along = toe - heel, from = point.head<2>() - heel;
  const double share = std::clamp(from.dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (from - share * along).norm();
}

// The share of a contact's frames in which the force acts beside the foot.
double share_beside(const Plate& plate, const Contact& contact, const FootPaths& foot,
                    const Eigen::Matrix3d& upright) {
  std::int64_t beside = 0, count = 0;
  for (std::int64_t f = contact.first; f <= contact.last; ++f) {
    if (!(plate.load[at(f)] > kSurely_n)) continue;
    ++count;
    beside += !foot.known[at(f)] || !(distance_to_foot(foot, f, plate.centre(f, upright)) < kBeside_m);
  }
  return count > 0 ? static_cast<double>(beside) / static_cast<double>(count) : 1.0;
}

// How far a point lies beyond the edges of a quadrilateral; negative within.
double outside(const std::vector<Eigen::Vector3d>& corners, const Eigen::Matrix3d& upright,
               const Vector2d& point) {
  std::array<Vector2d, 4> c;
  Vector2d middle = Vector2d::Zero();
  for (std::size_t i = 0; i < 4; ++i) c[i] = (upright * corners[i]).head<2>(), middle += 0.25 * c[i];
  double most = -1e9;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vector2d edge = (c[(i + 1) % 4] - c[i]).normalized();
    Vector2d normal(edge.y(), -edge.x());
    if (normal.dot(middle - c[i]) > 0.0) normal = -normal;
    most = std::max(most, normal.dot(point - c[i]));
  }
  return most;
}

// Whether heel and toe lie within the plate in the middle of the contact.
bool wholly_on(const Plate& plate, const Contact& contact, const FootPaths& foot,
               const Eigen::Matrix3d& upright) {
  const auto& corners = plate.wrench->corners_in_world;
  if (corners.empty()) return true;
  const auto f = (2 * contact.first + contact.last) / 3;
  const Vector2d heel = foot.heel.row(f).leftCols<2>(), toe = foot.toe.row(f).leftCols<2>();
  const double most = foot.points ? kOutside_m : -kRestOfFoot_m;
  return outside(corners, upright, heel) < most && outside(corners, upright, toe) < most;
}

// Seconds, and their SD, at which the load rises above and falls below what is a contact.
std::array<data::GaitEvent, 2> events_of(const Plate& plate, const Contact& contact, Side side,
                                         const GaitPaths& paths) {
  const double limit = plate.begins();
  std::int64_t last = contact.last;
  while (last > contact.first && plate.load[at(last)] <= limit) --last;
  const auto one = [&](FootEvent what, std::int64_t f) {  // between frames f and f + 1
    const double a = plate.load[at(f)], b = plate.load[at(f + 1)];
    const double slope = std::abs(b - a) * paths.rate_hz;
    return data::GaitEvent{.side = side,
                           .what = what,
                           .time_s = paths.time_s(static_cast<double>(f) + (limit - a) / (b - a)),
                           .sd_s = std::hypot(kLeastSd_s, kSdInFrames / paths.rate_hz, plate.noise_n / slope),
                           .source = data::EventSource::plate,
                           .method = plate.wrench->name};
  };
  return {one(FootEvent::strike, contact.first - 1), one(FootEvent::off, last)};
}

}  // namespace

PlateEvents find_plate_events(const data::Wrenches& plates, const GaitPaths& paths,
                              const Eigen::Matrix3d& upright) {
  PlateEvents out;
  const auto frames = std::min(plates.frames(), paths.frames());
  for (const auto& wrench : plates.items) {
    const auto plate = plate_of(wrench, frames, upright);
    for (const auto& contact : contacts_of(plate, paths.rate_hz)) {
      const double from = paths.time_s(static_cast<double>(contact.first)),
                   to = paths.time_s(static_cast<double>(contact.last));
      const auto note = [&](std::string_view why) {
        out.notes.push_back(
            fmt::format("{}, {:.2f} to {:.2f} s, tells of no event: {}", wrench.name, from, to, why));
      };
      std::optional<Side> stands;
      for (const Side side : data::kBothSides)
        if (paths.foot(side).present() &&
            share_beside(plate, contact, paths.foot(side), upright) <= kShareBeside)
          stands = stands ? std::nullopt : std::optional(side);
      if (!stands)
        note("the force does not stay under one foot");
      else if (!wholly_on(plate, contact, paths.foot(*stands), upright))
        note("the foot was not wholly on the plate");
      else
        for (auto& event : events_of(plate, contact, *stands, paths)) out.events.push_back(std::move(event));
    }
  }
  return out;
}

}  // namespace kinemark::analysis
