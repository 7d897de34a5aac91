// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/plate_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/math/statistics.h"

namespace kinemark::analysis {
namespace {

using data::Side;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kUnloaded_n = 20.0, kInNoise = 5.0;
constexpr double kLeast_s = 0.15, kMost_s = 3.0;
constexpr double kBeside_m = 0.12;    // from the line between heel and toe to the centre of pressure
constexpr double kShareBeside = 0.1;  // of a contact's frames
constexpr double kOutside_m = 0.02;   // of a marker, beyond the edge of the plate
constexpr double kRestOfFoot_m =
    0.2;  // of one marker alone from the edge: the rest of its foot lies on the plate too
constexpr std::size_t kFewestFrames = 5;

double distance_to_foot(const FootPaths& foot, std::int64_t f, const Vector3d& point) {
  const Vector2d heel = foot.heel.row(f).leftCols<2>(), toe = foot.toe.row(f).leftCols<2>();
  const Vector2d along = toe - heel, from = point.head<2>() - heel;
  const double square = along.squaredNorm();
  const double share = square > 0.0 ? std::clamp(from.dot(along) / square, 0.0, 1.0) : 0.0;
  return (from - share * along).norm();
}

// How far a point lies beyond the edges of a quadrilateral; negative within.
double outside(const std::vector<Vector3d>& corners, const Eigen::Matrix3d& upright, const Vector2d& point) {
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

}  // namespace

LoadedPlate::LoadedPlate(const data::Wrench& wrench, std::int64_t frames, const Eigen::Matrix3d& upright)
    : wrench_(wrench), upright_(upright) {
  std::vector<double> unloaded;
  for (std::int64_t f = 0; f < frames; ++f) {
    load_.push_back((upright * Eigen::Map<const Vector3d>(wrench.force.data() + 3 * f)).z());
    if (std::abs(load_.back()) < kUnloaded_n) unloaded.push_back(load_.back());
  }
  if (unloaded.size() < 10) return;
  const double baseline = math::median(unloaded);
  for (auto& x : unloaded) x = std::abs(x - baseline);
  noise_n_ = 1.4826 * math::median(unloaded);
  for (auto& x : load_) x -= baseline;
}

double LoadedPlate::most_n() const {
  double most = 0.0;
  for (const double n : load_)
    if (n > most) most = n;
  return most;
}

Vector3d LoadedPlate::centre(std::int64_t frame) const {
  return upright_ * Eigen::Map<const Vector3d>(wrench_.point.data() + 3 * frame);
}

double LoadedPlate::begins(const ContactLoads& loads) const {
  return std::max(loads.begins_n, kInNoise * noise_n_);
}

std::vector<PlateSpan> LoadedPlate::contacts(double rate_hz, const ContactLoads& loads) const {
  const double begins_n = begins(loads), ends_n = 0.5 * begins_n;
  std::vector<PlateSpan> out;
  const auto n = std::ssize(load_);
  for (std::int64_t f = 1; f < n; ++f) {
    if (!(load_[at(f)] > begins_n && load_[at(f - 1)] <= begins_n)) continue;
    std::int64_t last = f;
    double most = 0.0;
    while (last < n && load_[at(last)] > ends_n) most = std::max(most, load_[at(last++)]);
    const auto seconds = static_cast<double>(last - f) / rate_hz;
    if (last < n && std::isfinite(load_[at(last)]) && most > loads.bears_n && seconds > kLeast_s &&
        seconds < kMost_s)
      out.push_back({f, last - 1});
    f = std::max(f, last - 1);
  }
  return out;
}

double LoadedPlate::share_beside(const PlateSpan& contact, const FootPaths& foot,
                                 const ContactLoads& loads) const {
  std::int64_t beside = 0, count = 0;
  for (std::int64_t f = contact.first; f <= contact.last; ++f) {
    if (!(load_[at(f)] > loads.surely_n)) continue;
    ++count;
    beside += !foot.known[at(f)] || !(distance_to_foot(foot, f, centre(f)) < kBeside_m);
  }
  return count > 0 ? static_cast<double>(beside) / static_cast<double>(count) : 1.0;
}

std::optional<Side> LoadedPlate::foot_of(const PlateSpan& contact, const GaitPaths& paths,
                                         const ContactLoads& loads) const {
  std::optional<Side> stands;
  for (const Side side : data::kBothSides)
    if (paths.foot(side).present() && share_beside(contact, paths.foot(side), loads) <= kShareBeside)
      stands = stands ? std::nullopt : std::optional(side);
  return stands;
}

bool LoadedPlate::bears_whole(const PlateSpan& contact, const FootPaths& foot) const {
  const auto& corners = wrench_.corners_in_world;
  if (corners.empty()) return true;
  const auto f = (2 * contact.first + contact.last) / 3;
  const Vector2d heel = foot.heel.row(f).leftCols<2>(), toe = foot.toe.row(f).leftCols<2>();
  const double most = foot.points ? kOutside_m : -kRestOfFoot_m;
  return outside(corners, upright_, heel) < most && outside(corners, upright_, toe) < most;
}

double LoadedPlate::distance_to_feet(const PlateSpan& contact, const GaitPaths& paths,
                                     const ContactLoads& loads) const {
  std::vector<double> distances;
  const auto &left = paths.foot(Side::left), &right = paths.foot(Side::right);
  if (!left.present() || !right.present()) return kNaN;
  for (std::int64_t f = contact.first; f <= contact.last; ++f) {
    if (!(load_[at(f)] > loads.surely_n) || !left.known[at(f)] || !right.known[at(f)]) continue;
    const auto point = centre(f);
    if (point.allFinite())
      distances.push_back(std::min(distance_to_foot(left, f, point), distance_to_foot(right, f, point)));
  }
  return distances.size() < kFewestFrames ? kNaN : math::median(distances);
}

}  // namespace kinemark::analysis
