// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/wrapped_path.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "kinemark/core/index.h"

namespace kinemark::motion::internal {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kStep = 0.002;  // m of the helix, over which its direction is looked at
constexpr double kKink = 0.1 * std::numbers::pi / 180.0;
constexpr int kMostSlides = 100;
constexpr double kOvershoot = 1.5;  // of each slide
constexpr double kFlat = 5e-7;      // of a plane's normal along the axis, below which it is parallel to it
constexpr double kFarAlong = 10.0;  // m, beyond which a plane does not meet a line of tangency

/// A point seen along the axis: its distance, and the points of tangency to both sides of it.
struct Tangents {
  double distance;
  std::array<Vector2d, 2> touch;  // counterclockwise, clockwise
};

Tangents tangents(const Vector3d& x, double radius) {
  const Vector2d p = x.head<2>();
  const double distance = p.norm();
  const Vector2d out = p / distance, across(-out.y(), out.x());
  const double along = radius * radius / distance;
  const double side = std::sqrt(radius * radius - along * along);
  return {distance, {along * out + side * across, along * out - side * across}};
}

/// Which points of tangency a piece uses, and how.
struct Choice {
  int from;       // of the tangents of its first end
  int to;         // of those of its last end
  bool far_side;  // it goes round the side away from the straight way
  bool long_way;  // more than half around
};

double sign(double x) { return x >= 0.0 ? 1.0 : -1.0; }

double angle(const Vector2d& a, const Vector2d& b) {
  return std::acos(std::clamp(a.dot(b) / (a.norm() * b.norm()), -1.0, 1.0));
}

/// Around a whole cylinder: the two points that lie nearest to each other.
Choice nearest_pair(const Tangents& from, const Tangents& to) {
  Choice best{0, 0, false, false};
  double largest = -2.0;
  for (const int i : {1, 0})  // of equal ones the last, as there
    for (const int k : {1, 0}) {
      const double cosine = from.touch[i].dot(to.touch[k]);
      if (cosine <= largest) continue;
      largest = cosine;
      best = {i, k, false, false};
    }
  return best;
}

/// Around one side of it: in the sense of rotation that touches this side.
Choice pair_on_side(const Vector3d& x, const Vector3d& y, const Tangents& from, const Tangents& to,
                    const data::WrapSurface& cylinder) {
  const auto on_side = [&](const Vector3d& end, const Vector2d& touch) {
    const double value = cylinder.side_axis == 2 ? end.z() : touch[cylinder.side_axis];
    return sign(value) == cylinder.side_sign;
  };
  const bool from0 = on_side(x, from.touch[0]), from1 = on_side(x, from.touch[1]);
  const bool to0 = on_side(y, to.touch[0]), to1 = on_side(y, to.touch[1]);
  const bool first_opens = angle(from.touch[0], to.touch[1]) > angle(from.touch[1], to.touch[0]);
  bool first = first_opens;  // from 0 to 1, rather than from 1 to 0
  if (from0 != from1)
    first = from0;
  else if (from0 || to0 || to1)
    first = !to0;
  Choice choice{first ? 0 : 1, first ? 1 : 0, first == first_opens, false};
  const Vector2d a = from.touch[choice.from], b = to.touch[choice.to];
  choice.long_way = (a + b).dot(a - x.head<2>() + b - y.head<2>()) < 0.0;
  return choice;
}

/// Whether and why a piece bends; `near` is its point nearest to the axis.
Contact judge(const Vector3d& from, const Vector3d& to, const data::WrapSurface& cylinder) {
  const Vector2d way = (to - from).head<2>();
  const double squared = way.squaredNorm();
  const double share = squared > 0.0 ? -from.head<2>().dot(way) / squared : -1.0;
  const Vector3d near = from + share * (to - from);
  const bool through = share > 0.0 && share < 1.0 && near.head<2>().norm() < cylinder.radius;
  if (cylinder.side_axis < 0) return through ? Contact::needed : Contact::none;
  const int axis = cylinder.side_axis;
  const double side = cylinder.side_sign;
  if (sign(from[axis]) != side && sign(to[axis]) != side) return Contact::possible;
  if (through) return Contact::needed;
  const bool crosses = sign(from[axis]) != sign(to[axis]) && sign(near[axis]) != side;
  return crosses ? Contact::possible : Contact::none;
}

/// Slides the points of tangency along the cylinder into the plane of both ends and the edge between them.
void into_plane(const Vector3d& from, const Vector3d& to, double share, double radius, bool far_side,
                CylinderWrap& wrap) {
  const Vector3d middle = from + share * (to - from);
  const Vector3d centre(0.0, 0.0, middle.z());
  const Vector3d normal = (from - centre).cross(to - centre).normalized();
  const Vector3d out = Vector3d::UnitZ().cross(normal).normalized();
  const Vector3d one = centre + radius * out, other = centre - radius * out;
  const bool one_is_near = (middle - one).squaredNorm() < (middle - other).squaredNorm();
  const Vector3d edge = one_is_near != far_side ? one : other;
  const Vector3d plane = (from - edge).cross(to - edge).normalized();
  if (!(std::abs(plane.z()) >= kFlat)) return;
  const auto slide = [&](Vector3d& touch, double other_end) {
    const double z =
        from.z() + (plane.x() * (from.x() - touch.x()) + plane.y() * (from.y() - touch.y())) / plane.z();
    const bool between = std::abs(z - other_end) < std::abs(to.z() - from.z());
    if (between && std::abs(z - touch.z()) <= kFarAlong) touch.z() = z;
  };
  slide(wrap.onto, to.z());
  slide(wrap.off, from.z());
}

/// The helix from one point of tangency to the other.
struct Helix {
  double angle;  // rad, with its sense
  double rise;   // m, along the axis
  double length;
};

Helix helix(const CylinderWrap& wrap, double radius, bool long_way) {
  const Vector2d a = wrap.onto.head<2>(), b = wrap.off.head<2>();
  const double turn = angle(a, b), sense = a.x() * b.y() - a.y() * b.x() < 0.0 ? -1.0 : 1.0;
  const double whole = long_way ? 2.0 * std::numbers::pi - turn : turn;
  const double rise = wrap.off.z() - wrap.onto.z();
  return {(long_way ? -sense : sense) * whole, rise, std::hypot(radius * whole, rise)};
}

/// How far a point of tangency must slide so that the way from `end` runs on into the helix, whose next point
/// is `next`. None where it does so already.
std::optional<double> slide_of(const Vector3d& end, const Vector3d& touch, const Vector3d& next) {
  const Vector3d straight = (touch - end).normalized(), onward = (next - touch).normalized();
  if (std::abs(std::acos(straight.z()) - std::acos(onward.z())) <= kKink) return std::nullopt;
  const Vector2d way = (next - end).head<2>();
  if (way.squaredNorm() == 0.0) return std::nullopt;
  const double share = (touch - end).head<2>().dot(way) / way.squaredNorm();
  return kOvershoot * (end.z() + share * (next.z() - end.z()) - touch.z());
}

Vector3d turned(const Vector3d& x, double by, double up) {
  return {std::cos(by) * x.x() - std::sin(by) * x.y(), std::sin(by) * x.x() + std::cos(by) * x.y(),
          x.z() + up};
}

void settle_on_helix(const Vector3d& from, const Vector3d& to, double radius, bool long_way,
                     CylinderWrap& wrap) {
  for (int slides = 0; slides < kMostSlides; ++slides) {
    const Helix way = helix(wrap, radius, long_way);
    const int steps = static_cast<int>(way.length / kStep);
    if (steps < 2) return;
    const double turn = way.angle / steps, rise = way.rise / steps;
    const auto onto = slide_of(from, wrap.onto, turned(wrap.onto, turn, rise));
    const auto off = slide_of(to, wrap.off, turned(wrap.off, -turn, -rise));
    if (onto) wrap.onto.z() += *onto;
    if (off) wrap.off.z() += *off;
    if (!onto && !off) return;
  }
}

using Eigen::Vector3d;

constexpr int kMostRounds = 8;
constexpr double kSettled = 5e-4;  // m, change of the length that ends the rounds

/// A point of the path or an end of its way along a surface.
struct Node {
  Vector3d x_in_world;
  int point_idx = -1;  // of the path's points; -1: an end on a surface
  int wrap_idx = -1;   // the surface; -1: a point of the path
  double arc_m = 0.0;  // along the surface from the node before; of the second end
};

class WrappedPath {
 public:
  WrappedPath(std::span<const PassedPoint> points, std::span<const data::PathWrap> wraps,
              std::span<const math::SE3> world_from_surface)
      : wraps_(wraps),
        world_from_surface_(world_from_surface),
        order_(wraps.size()),
        contacts_(wraps.size()) {
    for (const auto& point : points)
      nodes_.push_back({.x_in_world = point.x_in_world, .point_idx = point.point_idx});
    std::iota(order_.begin(), order_.end(), 0);
  }

  double length() {
    double last = std::numeric_limits<double>::infinity();
    const int rounds = wraps_.size() < 2 ? 1 : kMostRounds;
    for (int round = 0; round < rounds; ++round) {
      for (std::size_t i = 0; i < order_.size(); ++i) contacts_[i] = wrap_around(order_[i]);
      const double now = sum();
      if (std::abs(now - last) < kSettled) break;
      last = now;
      if (round == 0 && order_.size() > 1 && contacts_[0] == Contact::none &&
          contacts_[1] == Contact::inside) {
        std::swap(order_[0], order_[1]);
        leave(0);
      }
    }
    return sum();
  }

 private:
  /// Takes the ends on a surface out of the path.
  void leave(int wrap_idx) {
    std::erase_if(nodes_, [&](const Node& node) { return node.wrap_idx == wrap_idx; });
  }

  /// Bends the path anew around one surface; what it did to the last piece that was tried.
  Contact wrap_around(int wrap_idx) {
    leave(wrap_idx);
    const auto& wrap = wraps_[at(wrap_idx)];
    if (!wrap.surface.active || !wrap.surface.is_cylinder) return Contact::none;
    const auto range = pieces(wrap);
    if (!range) return Contact::none;
    Contact contact = Contact::none;
    std::optional<std::pair<int, CylinderWrap>> best;
    double least = std::numeric_limits<double>::infinity();
    for (int i = range->first; i < range->second; ++i) {
      if (on_one_surface(nodes_[at(i)], nodes_[at(i + 1)])) continue;
      const auto tried = try_piece(wrap_idx, i);
      contact = tried.contact;
      if (contact == Contact::needed) {
        best = {i, tried};
        break;
      }
      if (contact != Contact::possible) continue;
      const double longer = detour(i, tried);
      if (longer >= least) continue;
      least = longer;
      best = {i, tried};
    }
    if (best) insert(wrap_idx, best->first, best->second);
    return contact;
  }

  /// First and last node of those between which the path may bend around the surface.
  [[nodiscard]] std::optional<std::pair<int, int>> pieces(const data::PathWrap& wrap) const {
    int first = -1, last = -1;
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const int point = nodes_[i].point_idx;
      if (point < 0 || point < wrap.first_point || (wrap.last_point >= 0 && point > wrap.last_point))
        continue;
      if (first < 0) first = static_cast<int>(i);
      last = static_cast<int>(i);
    }
    if (first < 0) return std::nullopt;
    return std::pair{first, last};
  }

  [[nodiscard]] bool on_one_surface(const Node& a, const Node& b) const {
    if (a.wrap_idx < 0 || b.wrap_idx < 0) return false;
    return wraps_[at(a.wrap_idx)].surface.name == wraps_[at(b.wrap_idx)].surface.name;
  }

  /// The wrap with its points in the world.
  [[nodiscard]] CylinderWrap try_piece(int wrap_idx, int i) const {
    const auto& world_from_surface = world_from_surface_[at(wrap_idx)];
    const auto surface_from_world = world_from_surface.inverse();
    auto wrap = wrap_cylinder(surface_from_world * nodes_[at(i)].x_in_world,
                              surface_from_world * nodes_[at(i + 1)].x_in_world, wraps_[at(wrap_idx)].surface,
                              wraps_.size() > 1);
    wrap.onto = world_from_surface * wrap.onto;
    wrap.off = world_from_surface * wrap.off;
    return wrap;
  }

  [[nodiscard]] double detour(int i, const CylinderWrap& wrap) const {
    const Vector3d &a = nodes_[at(i)].x_in_world, &b = nodes_[at(i + 1)].x_in_world;
    return (wrap.onto - a).norm() + wrap.arc_m + (b - wrap.off).norm() - (b - a).norm();
  }

  void insert(int wrap_idx, int i, const CylinderWrap& wrap) {
    const Node onto{.x_in_world = wrap.onto, .wrap_idx = wrap_idx};
    const Node off{.x_in_world = wrap.off, .wrap_idx = wrap_idx, .arc_m = wrap.arc_m};
    nodes_.insert(nodes_.begin() + i + 1, {onto, off});
  }

  [[nodiscard]] double sum() const {
    double length = 0.0;
    for (std::size_t i = 1; i < nodes_.size(); ++i)
      length += on_one_surface(nodes_[i - 1], nodes_[i])
                    ? nodes_[i].arc_m
                    : (nodes_[i].x_in_world - nodes_[i - 1].x_in_world).norm();
    return length;
  }

  std::span<const data::PathWrap> wraps_;
  std::span<const math::SE3> world_from_surface_;
  std::vector<int> order_;         // in which the surfaces are tried
  std::vector<Contact> contacts_;  // what came of it, in that order
  std::vector<Node> nodes_;
};

}  // namespace

CylinderWrap wrap_cylinder(const Vector3d& from, const Vector3d& to, const data::WrapSurface& cylinder,
                           bool settle) {
  const double radius = cylinder.radius;
  if (from.head<2>().norm() < radius || to.head<2>().norm() < radius) return {.contact = Contact::inside};
  CylinderWrap wrap{.contact = judge(from, to, cylinder)};
  if (wrap.contact == Contact::none || !(radius > 0.0)) return {};
  const Tangents a = tangents(from, radius), b = tangents(to, radius);
  const Choice choice = cylinder.side_axis < 0 ? nearest_pair(a, b) : pair_on_side(from, to, a, b, cylinder);
  wrap.onto << a.touch[choice.from], from.z();
  wrap.off << b.touch[choice.to], to.z();
  into_plane(from, to, a.distance / (a.distance + b.distance), radius, choice.far_side, wrap);
  const double half = 0.5 * cylinder.length;
  if (std::abs(wrap.onto.z()) > half && std::abs(wrap.off.z()) > half) return {};
  if (settle) settle_on_helix(from, to, radius, choice.long_way, wrap);
  wrap.arc_m = helix(wrap, radius, choice.long_way).length;
  return wrap;
}

double wrapped_length(std::span<const PassedPoint> points, std::span<const data::PathWrap> wraps,
                      std::span<const math::SE3> world_from_surface) {
  return WrappedPath(points, wraps, world_from_surface).length();
}

}  // namespace kinemark::motion::internal
