// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/scaling/internal/wrapped_path.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "kinemark/core/index.h"
#include "kinemark/stages/motion/scaling/internal/cylinder_wrap.h"

namespace kinemark::motion::internal {
namespace {

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

double wrapped_length(std::span<const PassedPoint> points, std::span<const data::PathWrap> wraps,
                      std::span<const math::SE3> world_from_surface) {
  return WrappedPath(points, wraps, world_from_surface).length();
}

}  // namespace kinemark::motion::internal
