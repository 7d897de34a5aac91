// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/kinetics/floor_loads.h"

#include <fmt/core.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/stages/analysis/forces/contacts.h"

namespace kinemark::analysis {
namespace {

using Eigen::Vector3d;
using Contact = FloorLoad::Contact;

constexpr double kStill_m_per_s = 0.4;
constexpr double kLandingTime_s = 0.1;
constexpr double kLeast_n = 5.0;  // of a contact's first and last frame
constexpr double kNear_m = 0.15;
constexpr double kBeside_m = 0.03;
constexpr double kShareBeside = 0.2;

Vector3d triple(const Array<double>& values, std::int64_t f) {
  return Eigen::Map<const Vector3d>(values.data() + 3 * f);
}

/// One foot and when it is on the floor.
class Foot {
 public:
  Foot(const FootTrack& track, Vector3d up, double rate_hz) : track_(track), up_(std::move(up)) {
    const std::int64_t frames = track.points.empty() ? 0 : track.points.front().rows();
    still_.assign(at(frames), false);
    for (const auto& x : track.points)
      for (std::int64_t f = 1; f + 1 < frames; ++f)
        if (rate_hz * 0.5 * (x.row(f + 1) - x.row(f - 1)).norm() < kStill_m_per_s) still_[at(f)] = true;
    if (frames > 2) still_[0] = still_[1], still_[at(frames - 1)] = still_[at(frames - 2)];
  }
  [[nodiscard]] bool still(std::int64_t f) const { return still_[at(f)]; }

  /// Least horizontal distance from its points, and lines between them, to p; NaN where not known.
  [[nodiscard]] double distance(const Vector3d& p, std::int64_t f) const {
    double least = std::numeric_limits<double>::infinity();
    bool some = false;
    for (std::size_t i = 0; i < track_.points.size(); ++i)
      for (std::size_t j = i; j < track_.points.size(); ++j) {
        const Vector3d a = level(track_.points[i].row(f)), b = level(track_.points[j].row(f)), q = level(p);
        if (!a.allFinite() || !b.allFinite() || !q.allFinite()) continue;
        const Vector3d along = b - a;
        const double size = along.squaredNorm();
        const double share = size > 0.0 ? std::clamp((q - a).dot(along) / size, 0.0, 1.0) : 0.0;
        least = std::min(least, (q - a - share * along).norm());
        some = true;
      }
    return some ? least : kNaN;
  }
  [[nodiscard]] const FootTrack& track() const { return track_; }

 private:
  [[nodiscard]] Vector3d level(const Vector3d& p) const { return p - p.dot(up_) * up_; }
  const FootTrack& track_;
  Vector3d up_;
  std::vector<bool> still_;
};

// How far a point lies outside of a plate, seen from above; negative inside.
double outside(const std::vector<Vector3d>& corners, const Vector3d& p, const Vector3d& up) {
  const Vector3d middle = 0.25 * (corners[0] + corners[1] + corners[2] + corners[3]);
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 4; ++k) {
    const Vector3d edge = corners[(k + 1) % 4] - corners[k];
    Vector3d out = edge.cross(up).normalized();
    if (out.dot(corners[k] - middle) < 0.0) out = -out;
    most = std::max(most, out.dot(p - corners[k]));
  }
  return most;
}

bool any_still(const Foot& foot, const Contact& contact) {
  for (std::int64_t f = contact.first; f < contact.first + contact.count; ++f)
    if (foot.still(f)) return true;
  return false;
}

class FloorFinder {
 public:
  FloorFinder(const data::Wrenches& plates, std::span<const FootTrack> feet, const Vector3d& up)
      : plates_(plates), up_(up) {
    for (const auto& foot : feet) feet_.emplace_back(foot, up, plates.time.rate_hz);
    for (std::size_t i = 0; i < feet.size(); ++i)
      out_.feet.push_back({.wrench = WrenchTrack::zero(plates.frames()),
                           .known = std::vector<bool>(at(plates.frames()), true),
                           .contacts = {}});
  }

  FloorLoads find() {
    for (std::size_t p = 0; p < plates_.items.size(); ++p) give_contacts(p);
    for (std::size_t i = 0; i < feet_.size(); ++i) {
      auto& contacts = out_.feet[i].contacts;
      std::ranges::sort(contacts, {}, &Contact::first);
      for (const auto& contact : contacts) bear(i, contact);
      step_beside(i);
      stand_elsewhere(i);
    }
    share();
    return std::move(out_);
  }

 private:
  [[nodiscard]] double time_of(std::int64_t f) const { return plates_.time.time_s(f); }
  [[nodiscard]] const std::vector<Vector3d>& corners_of(std::size_t plate) const {
    return plates_.items[plate].corners_in_world;
  }

  void give_contacts(std::size_t p) {
    const auto& plate = plates_.items[p];
    Eigen::VectorXd load(plates_.frames());
    for (std::int64_t f = 0; f < plates_.frames(); ++f) load[f] = triple(plate.force, f).dot(up_);
    for (const auto& found : find_contacts(load, plates_.time.rate_hz)) {
      Contact contact{.plate = p, .first = found.first, .count = found.count};
      while (contact.first > 0 && load[contact.first - 1] > kLeast_n) --contact.first, ++contact.count;
      while (contact.first + contact.count < plates_.frames() &&
             load[contact.first + contact.count] > kLeast_n)
        ++contact.count;
      std::size_t nearest = feet_.size();
      double least = kNear_m;
      for (std::size_t i = 0; i < feet_.size(); ++i) {
        double sum = 0.0, weight = 0.0;
        for (std::int64_t f = contact.first; f < contact.first + contact.count; ++f) {
          const double d = feet_[i].distance(triple(plate.point, f), f);
          if (!std::isfinite(d)) continue;
          sum += d * load[f];
          weight += load[f];
        }
        if (weight > 0.0 && sum / weight < least) least = sum / weight, nearest = i;
      }
      if (nearest < feet_.size())
        out_.feet[nearest].contacts.push_back(contact);
      else
        out_.notes.push_back(fmt::format(
            "{}: its load from {:.2f} to {:.2f} s is no foot's: none is within {:.0f} mm of it.", plate.name,
            time_of(contact.first), time_of(contact.first + contact.count - 1), 1e3 * kNear_m));
    }
  }

  void bear(std::size_t foot, const Contact& contact) {
    const auto& plate = plates_.items[contact.plate];
    auto& load = out_.feet[foot];
    for (std::int64_t f = contact.first; f < contact.first + contact.count; ++f) {
      const Vector3d force = triple(plate.force, f), moment = triple(plate.moment, f),
                     point = triple(plate.point, f);
      const Vector3d about_origin = moment + point.cross(force);
      if (!about_origin.allFinite() || !force.allFinite()) {
        load.known[at(f)] = false;
        continue;
      }
      load.wrench.force.row(f) += force;
      load.wrench.moment.row(f) += about_origin;
    }
  }

  // A part of the foot beside the plates that it loads: the floor bears it there.
  void step_beside(std::size_t i) {
    auto& load = out_.feet[i];
    for (const auto& contact : load.contacts) {
      std::int64_t beside = 0;
      for (std::int64_t f = contact.first; f < contact.first + contact.count; ++f)
        beside += feet_[i].still(f) && is_beside(i, f);
      if (static_cast<double>(beside) < kShareBeside * static_cast<double>(contact.count)) continue;
      for (std::int64_t f = contact.first; f < contact.first + contact.count; ++f) load.known[at(f)] = false;
      out_.notes.push_back(fmt::format(
          "{}: its step on {} from {:.2f} to {:.2f} s is partly beside the plate: no moments there.",
          feet_[i].track().name, plates_.items[contact.plate].name, time_of(contact.first),
          time_of(contact.first + contact.count - 1)));
    }
  }

  [[nodiscard]] bool is_beside(std::size_t i, std::int64_t f) const {
    return std::ranges::any_of(feet_[i].track().points, [&](const Eigen::MatrixX3d& x) {
      double least = std::numeric_limits<double>::infinity();
      for (const auto& contact : out_.feet[i].contacts)
        if (f >= contact.first && f < contact.first + contact.count && !corners_of(contact.plate).empty())
          least = std::min(least, outside(corners_of(contact.plate), x.row(f), up_));
      return std::isfinite(least) && least > kBeside_m;
    });
  }

  // On the floor far in time from a contact of its own.
  void stand_elsewhere(std::size_t i) {
    auto& load = out_.feet[i];
    const auto near = static_cast<std::int64_t>(std::lround(kLandingTime_s * plates_.time.rate_hz));
    std::vector<bool> borne(at(plates_.frames()), false);
    for (const auto& contact : load.contacts)
      for (std::int64_t f = std::max<std::int64_t>(0, contact.first - near);
           f < std::min(plates_.frames(), contact.first + contact.count + near); ++f)
        borne[at(f)] = true;
    std::int64_t elsewhere = 0;
    for (std::int64_t f = 0; f < plates_.frames(); ++f) {
      if (borne[at(f)] || !feet_[i].still(f)) continue;
      load.known[at(f)] = false;
      ++elsewhere;
    }
    if (elsewhere > 0)
      out_.notes.push_back(fmt::format(
          "{}: on the floor without a plate that measures it in {} of {} frames: no moments there.",
          feet_[i].track().name, elsewhere, plates_.frames()));
  }

  // Another foot on the same plate at the same time.
  void share() {
    for (std::size_t i = 0; i < feet_.size(); ++i)
      for (const auto& contact : out_.feet[i].contacts) {
        if (corners_of(contact.plate).empty()) continue;
        std::int64_t shared = 0;
        for (std::size_t j = 0; j < feet_.size(); ++j) {
          if (j == i || !any_still(feet_[j], contact)) continue;
          for (std::int64_t f = contact.first; f < contact.first + contact.count; ++f) {
            if (!feet_[j].still(f) || !is_on(j, contact.plate, f)) continue;
            out_.feet[i].known[at(f)] = out_.feet[j].known[at(f)] = false;
            ++shared;
          }
        }
        if (shared > 0)
          out_.notes.push_back(fmt::format(
              "{}: two feet are on it in {} frames between {:.2f} and {:.2f} s: no moments there.",
              plates_.items[contact.plate].name, shared, time_of(contact.first),
              time_of(contact.first + contact.count - 1)));
      }
  }

  [[nodiscard]] bool is_on(std::size_t foot, std::size_t plate, std::int64_t f) const {
    return std::ranges::any_of(feet_[foot].track().points, [&](const Eigen::MatrixX3d& x) {
      return x.row(f).allFinite() && outside(corners_of(plate), x.row(f), up_) < 0.0;
    });
  }

  const data::Wrenches& plates_;
  Vector3d up_;
  std::vector<Foot> feet_;
  FloorLoads out_;
};

}  // namespace

FloorLoads find_floor_loads(const data::Wrenches& plates, std::span<const FootTrack> feet,
                            const Vector3d& up) {
  return FloorFinder(plates, feet, up).find();
}

}  // namespace kinemark::analysis
