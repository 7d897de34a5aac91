// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/internal/agreed.h"

#include <fmt/core.h>

#include <algorithm>
#include <functional>
#include <set>
#include <utility>

#include "kinemark/core/index.h"

namespace kinemark::skeleton::internal {
namespace {

constexpr std::size_t kRivalsKept = 8;

std::string reason_of(const Agreement& agreement, const SegmentationOptions& options) {
  const double gap = agreement.members.front().place->gap_m;
  if (agreement.weight < options.least_weight)
    return fmt::format(
        "{:.0f} % of the segmentations that the data allow have it, {:.0f} at least are needed",
        100.0 * agreement.weight, 100.0 * options.least_weight);
  if (!(agreement.spread_m < options.most_spread_m))
    return fmt::format("segmentations that the data allow place it {:.1f} mm apart (RMS; {:.0f} at most)",
                       1e3 * agreement.spread_m, 1e3 * options.most_spread_m);
  if (!(gap < options.most_gap_m))
    return fmt::format("its two segments place it {:.1f} mm apart (RMS; {:.0f} at most)", 1e3 * gap,
                       1e3 * options.most_gap_m);
  if (!(agreement.rival_weight < options.most_rival_weight))
    return fmt::format("{:.0f} % of the segmentations that the data allow have another joint near it instead",
                       100.0 * agreement.rival_weight);
  return {};
}

bool apart(const std::vector<int>& a, const std::vector<int>& b) {
  return std::ranges::none_of(a, [&](int m) { return std::ranges::binary_search(b, m); });
}

/// Segments of the known joints, none of which shares a marker with another.
class Assembly {
 public:
  /// Whether the clusters of a joint fit to those that are there.
  [[nodiscard]] bool takes(const Place& place) const {
    return std::ranges::all_of(segments_, [&](const auto& s) {
      return (s == place.a || apart(s, place.a)) && (s == place.b || apart(s, place.b));
    });
  }
  void add(const Place& place) {
    for (const auto& c : {place.a, place.b})
      if (std::ranges::find(segments_, c) == segments_.end()) segments_.push_back(c);
  }
  [[nodiscard]] const std::vector<std::vector<int>>& segments() const { return segments_; }

 private:
  std::vector<std::vector<int>> segments_;
};

/// The rival that has most of the known joints, by weight where several have.
std::size_t best_rival(const std::vector<Agreement>& agreements, const std::vector<JudgedJoint>& joints,
                       const std::vector<Rival>& rivals) {
  std::vector<int> has(rivals.size(), 0);
  for (std::size_t k = 0; k < agreements.size(); ++k) {
    if (!joints[k].known) continue;
    std::set<std::size_t> members;
    for (const auto& p : agreements[k].members) members.insert(p.rival);
    for (const std::size_t r : members) ++has[r];
  }
  std::size_t best = 0;
  for (std::size_t r = 1; r < rivals.size(); ++r)
    if (has[r] > has[best] || (has[r] == has[best] && rivals[r].weight > rivals[best].weight)) best = r;
  return best;
}

/// Clusters for each known joint, so that no marker lies on two segments: the best rival's where it has the
/// joint, others where they fit. A joint that finds none is not known.
void choose_clusters(const std::vector<Agreement>& agreements, const std::vector<Rival>& rivals,
                     std::vector<JudgedJoint>& joints, Assembly& assembly) {
  const std::size_t best = best_rival(agreements, joints, rivals);
  const auto take = [&](JudgedJoint& joint, const Place& place) {
    assembly.add(place);
    joint.parent = place.a;
    joint.child = place.b;
  };
  std::vector<std::size_t> left;
  for (std::size_t k = 0; k < joints.size(); ++k) {
    if (!joints[k].known) continue;
    const auto& members = agreements[k].members;
    const auto own = std::ranges::find(members, best, &RivalPlace::rival);
    if (own == members.end() || !assembly.takes(*own->place))
      left.push_back(k);
    else
      take(joints[k], *own->place);
  }
  for (const std::size_t k : left) {
    const auto& members = agreements[k].members;
    const auto fits = std::ranges::find_if(members, [&](const auto& p) { return assembly.takes(*p.place); });
    if (fits != members.end()) {
      take(joints[k], *fits->place);
      continue;
    }
    joints[k].known = false;
    joints[k].reason = "its segments share markers with those of other joints";
  }
}

/// Segments by their first marker, joints away from the first; a joint that closes a circle is not known.
void connect(const Assembly& assembly, Segmentation& out) {
  auto segments = assembly.segments();
  std::ranges::sort(segments);
  for (std::size_t s = 0; s < segments.size(); ++s)
    out.layout.segments.push_back({fmt::format("segment{}", s + 1), segments[s]});
  const auto number = [&](const std::vector<int>& markers) {
    return static_cast<int>(std::ranges::find(segments, markers) - segments.begin());
  };
  std::vector<int> tree(segments.size());
  for (std::size_t s = 0; s < tree.size(); ++s) tree[s] = static_cast<int>(s);
  for (auto& joint : out.joints) {
    if (!joint.known) continue;
    int a = number(joint.parent), b = number(joint.child);
    if (tree[at(a)] == tree[at(b)]) {
      joint.known = false;
      joint.reason = "other joints connect its two segments already";
      continue;
    }
    const int from = tree[at(b)], to = tree[at(a)];
    std::ranges::replace(tree, from, to);
    if (b < a) {
      std::swap(a, b);
      std::swap(joint.parent, joint.child);
    }
    joint.parent_name = out.layout.segments[at(a)].name;
    joint.child_name = out.layout.segments[at(b)].name;
    joint.name = joint.parent_name + "-" + joint.child_name;
    out.layout.joints.push_back({joint.name, a, b});
    out.spread_m.push_back(joint.spread_m);
  }
}

}  // namespace

JudgedJoint judge_agreement(const Agreement& agreement, const std::vector<Rival>& rivals,
                            const SegmentationOptions& options, const std::vector<std::string>& names) {
  const auto& place = *agreement.members.front().place;
  JudgedJoint joint{.name = fmt::format("{}-{}", names[at(place.a.front())], names[at(place.b.front())]),
                    .parent_name = {},
                    .child_name = {},
                    .parent = place.a,
                    .child = place.b,
                    .hinge = place.hinge,
                    .gap_m = place.gap_m,
                    .turn_rad = place.turn_rad[0],
                    .spread_m = agreement.spread_m,
                    .weight = agreement.weight,
                    .rival_weight = agreement.rival_weight,
                    .rivals = {},
                    .reason = reason_of(agreement, options)};
  joint.known = joint.reason.empty();
  // The same two clusters count once.
  const auto add = [&](const RivalPlace& p) {
    if (p.place->a == place.a && p.place->b == place.b) return;
    for (auto& rival : joint.rivals)
      if (rival.parent == p.place->a && rival.child == p.place->b) {
        rival.weight += rivals[p.rival].weight;
        return;
      }
    joint.rivals.push_back({.parent = p.place->a,
                            .child = p.place->b,
                            .weight = rivals[p.rival].weight,
                            .distance_m = distance(place, *p.place)});
  };
  for (const auto& p : agreement.members) add(p);
  for (const auto& p : agreement.others) add(p);
  std::ranges::stable_sort(joint.rivals, std::greater{}, &RivalJoint::weight);
  if (joint.rivals.size() > kRivalsKept) joint.rivals.resize(kRivalsKept);
  return joint;
}

void lay_out_agreed(const std::vector<Agreement>& agreements, const std::vector<Rival>& rivals,
                    Segmentation& out) {
  Assembly assembly;
  choose_clusters(agreements, rivals, out.joints, assembly);
  connect(assembly, out);
}

}  // namespace kinemark::skeleton::internal
