// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/text.h"
#include "kinemark/core/units.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/skeleton/topology/internal/pairs.h"
#include "kinemark/stages/skeleton/topology/internal/place.h"
#include "kinemark/stages/skeleton/topology/marker_sets.h"
#include "kinemark/stages/skeleton/topology/segmentation.h"

namespace kinemark::skeleton {
namespace {

using internal::Place;
using Where = std::pair<BodyPart, BodySide>;

constexpr std::int64_t kFramesOfNames = 600, kLeastSeen = 20;
constexpr double kMostReach_m = 0.6;  ///< from a joint to the mean of either cluster, at most
constexpr double kShapeNoise =
    3.0;  ///< times the noise of a cluster's shape, as three markers hide some of it

/// Two parts of a body that meet, and what the joint is called.
struct Neighbours {
  std::string_view joint;
  BodyPart parent, child;
};
constexpr std::array kNeighbours = {Neighbours{"hip", BodyPart::pelvis, BodyPart::thigh},
                                    Neighbours{"knee", BodyPart::thigh, BodyPart::shank},
                                    Neighbours{"ankle", BodyPart::shank, BodyPart::foot},
                                    Neighbours{"shoulder", BodyPart::scapula, BodyPart::upper_arm},
                                    Neighbours{"elbow", BodyPart::upper_arm, BodyPart::forearm},
                                    Neighbours{"wrist", BodyPart::forearm, BodyPart::hand}};

/// What names say of a recording, and its frames that are looked at.
struct Body {
  data::Trajectories drawn;
  std::map<Where, std::vector<int>> members, landmarks;
  Eigen::MatrixXd variance;  ///< of distances, M x M, m^2; NaN where hardly seen together
};

bool of_middle(BodyPart part) {
  return part == BodyPart::head || part == BodyPart::thorax || part == BodyPart::pelvis;
}

Where where_of(BodyPart part, BodySide side) { return {part, of_middle(part) ? BodySide::none : side}; }

/// Median SD of a marker's distances to others; NaN without any.
double median_sd(const Body& body, int marker, const std::vector<int>& others) {
  std::vector<double> sd;
  for (const int o : others) {
    const double v = body.variance(marker, o);
    if (o != marker && !std::isnan(v)) sd.push_back(std::sqrt(v));
  }
  return sd.empty() ? kNaN : math::quantile(sd, 0.5);
}

/// The marker whose distances contradict its segment most goes first, as it spoils those of the others.
void put_aside(Body& body, const SegmentationOptions& options, Segmentation& out) {
  for (auto& [where, markers] : body.members) {
    while (markers.size() > 2) {
      double worst = 0.0;
      std::size_t who = 0;
      for (std::size_t i = 0; i < markers.size(); ++i)
        if (const double sd = median_sd(body, markers[i], markers); sd > worst) {
          worst = sd;
          who = i;
        }
      if (worst <= options.most_distance_sd_m) break;
      out.aside.push_back(
          {.marker = markers[who], .segment = name_of(where.first, where.second), .distance_sd_m = worst});
      markers.erase(markers.begin() + static_cast<std::ptrdiff_t>(who));
    }
  }
}

/// Noise with which a cluster's width is judged: what skin hides, less where the markers keep their shape
/// well.
double noise_of_width(const SegmentPoses& poses, const SegmentationOptions& options) {
  const double seen = kShapeNoise * poses.noise_sd_m;
  return std::max(poses.noise_sd_m,
                  std::min(options.skin_sd_m, std::isfinite(seen) ? seen : options.skin_sd_m));
}

bool has_pose(const SegmentPoses& poses, const SegmentationOptions& options) {
  return internal::is_wide(poses.x_in_segment, noise_of_width(poses, options));
}

std::string list_of(const Body& body, const std::vector<int>& markers) {
  std::vector<std::string> names;
  for (const int m : markers) names.push_back(body.drawn.names[at(m)]);
  return join(names);
}

/// Why a segment has no pose; empty when it has.
std::string lack_of_pose(const Body& body, const std::string& name, const std::vector<int>& markers,
                         bool wide) {
  if (markers.size() < 3)
    return fmt::format("{} has {} ({}), and a pose needs three that are not in a line", name,
                       markers.empty()
                           ? "no marker"
                           : fmt::format("{} marker{}", markers.size(), markers.size() == 1 ? "" : "s"),
                       markers.empty() ? "off the joints" : list_of(body, markers));
  if (!wide)
    return fmt::format("the markers of {} ({}) lie nearly in a line, so that its turn is not known", name,
                       list_of(body, markers));
  return {};
}

double mean_square(const std::vector<double>& d) {
  double sum = 0.0;
  for (const double v : d) sum += v * v;
  return d.empty() ? 0.0 : sum / static_cast<double>(d.size());
}

/// RMS distance of the place from those that rivals give: each half of the recording, each marker left out.
double spread_of(internal::PoseStore& store, const Place& place, const SegmentationOptions& options) {
  const SegmentPoses &a = store.of(place.a), &b = store.of(place.b);
  const std::size_t n = a.known.size();
  std::vector<double> halves, markers;
  for (const std::size_t half : {0U, 1U}) {
    const std::size_t first = half * n / 2, end = half == 0 ? n / 2 : n;
    const auto part = internal::find_place(internal::within(a, first, end), internal::within(b, first, end));
    if (part && part->turn_rad[0] > 0.5 * options.least_turn_rad)
      halves.push_back(internal::distance(place, *part));
  }
  for (const bool parent : {true, false}) {
    const auto& all = parent ? place.a : place.b;
    for (const int left_out : all) {
      if (all.size() < 4) break;
      auto fewer = all;
      std::erase(fewer, left_out);
      const SegmentPoses& poses = store.of(fewer);
      if (!has_pose(poses, options)) continue;
      if (const auto other = parent ? internal::find_place(poses, b) : internal::find_place(a, poses))
        markers.push_back(internal::distance(place, *other));
    }
  }
  const double kinds = static_cast<double>(!halves.empty()) + static_cast<double>(!markers.empty());
  return kinds > 0.0 ? std::sqrt((mean_square(halves) + mean_square(markers)) / kinds) : kNaN;
}

std::int64_t frames_together(const SegmentPoses& a, const SegmentPoses& b) {
  std::int64_t n = 0;
  for (std::size_t f = 0; f < a.known.size(); ++f) n += a.known[f] != 0 && b.known[f] != 0 ? 1 : 0;
  return n;
}

/// Figures of a joint between two segments with a pose, and why it is not known, if so.
void judge(internal::PoseStore& store, const SegmentationOptions& options, JudgedJoint& joint) {
  const SegmentPoses &above = store.of(joint.parent), &below = store.of(joint.child);
  if (frames_together(above, below) < kLeastSeen) {
    joint.reason = "the two were hardly seen together";
    return;
  }
  const auto place = internal::find_place(above, below);
  joint.turn_rad = place ? place->turn_rad[0] : 0.0;
  if (!place || joint.turn_rad < options.least_turn_rad) {
    joint.reason = fmt::format("the two hardly turn against each other (SD {:.1f} deg, {:.0f} are needed)",
                               joint.turn_rad * kDegPerRad, options.least_turn_rad * kDegPerRad);
    return;
  }
  joint.hinge = place->hinge;
  joint.gap_m = place->gap_m;
  if (joint.gap_m > options.most_gap_m) {
    joint.reason = fmt::format("the two place it {:.1f} mm apart (RMS; {:.0f} at most)", 1e3 * joint.gap_m,
                               1e3 * options.most_gap_m);
    return;
  }
  if (std::max(place->reach_a_m, place->reach_b_m) > kMostReach_m) {
    joint.reason = fmt::format("it would lie {:.0f} mm from the markers",
                               1e3 * std::max(place->reach_a_m, place->reach_b_m));
    return;
  }
  joint.spread_m = spread_of(store, *place, options);
  if (!(joint.spread_m < options.most_spread_m))
    joint.reason = fmt::format(
        "halves of the recording, and the same without one marker, place it {:.1f} mm away (RMS; {:.0f} at "
        "most)",
        1e3 * joint.spread_m, 1e3 * options.most_spread_m);
  joint.known = joint.reason.empty();
}

/// Markers by what their names say; false where these are not the names of a known set.
bool read_names(const data::Trajectories& markers, Body& body, Segmentation& out) {
  const auto is_output = find_model_outputs(markers.names);
  std::map<std::string, int> sets;
  int seen = 0, placed = 0;
  for (int m = 0; m < static_cast<int>(markers.markers()); ++m) {
    if (is_output[at(m)]) {
      out.model_outputs.push_back(m);
      continue;
    }
    std::int64_t frames = 0;
    for (std::int64_t f = 0; f < body.drawn.frames(); ++f) frames += body.drawn.present(f, m) ? 1 : 0;
    if (frames < kLeastSeen) continue;
    const auto place = find_marker_place(markers.names[at(m)]);
    ++seen;
    if (!place) {
      out.unplaced.push_back(m);
      continue;
    }
    ++placed;
    ++sets[std::string(place->set)];
    if (place->site == MarkerSite::joint)
      out.over_joints.push_back(m);
    else
      (place->site == MarkerSite::landmark ? body.landmarks
                                           : body.members)[where_of(place->part, place->side)]
          .push_back(m);
  }
  for (const auto& [set, n] : sets) out.sets.push_back(set);
  std::ranges::stable_sort(out.sets, std::greater{}, [&](const std::string& set) { return sets[set]; });
  return placed > 0 && 2 * placed >= seen;
}

/// Landmarks beside a joint join where the segment has no pose without them and their distances agree.
void add_landmarks(Body& body, internal::PoseStore& store, const SegmentationOptions& options,
                   Segmentation& out) {
  for (const auto& [where, landmarks] : body.landmarks) {
    auto& markers = body.members[where];
    const bool enough = markers.size() >= 3 && has_pose(store.of(markers), options);
    for (const int m : landmarks) {
      const double sd = markers.empty() ? 0.0 : median_sd(body, m, markers);
      if (!enough && sd <= options.most_distance_sd_m)
        markers.push_back(m);
      else
        out.over_joints.push_back(m);
    }
    std::ranges::sort(markers);
  }
}

/// The layout of the joints that are known.
void lay_out(Segmentation& out) {
  std::ranges::stable_partition(out.joints, &JudgedJoint::known);
  const auto segment = [&](const std::string& name, const std::vector<int>& markers) {
    for (std::size_t s = 0; s < out.layout.segments.size(); ++s)
      if (out.layout.segments[s].name == name) return static_cast<int>(s);
    out.layout.segments.push_back({name, markers});
    return static_cast<int>(out.layout.segments.size()) - 1;
  };
  for (const auto& joint : out.joints) {
    if (!joint.known) continue;
    const int parent = segment(joint.parent_name, joint.parent),
              child = segment(joint.child_name, joint.child);
    out.layout.joints.push_back({joint.name, parent, child});
    out.spread_m.push_back(joint.spread_m);
  }
}

}  // namespace

Result<std::optional<Segmentation>> segment_by_names(const data::Trajectories& markers,
                                                     const SegmentationOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  Body body{.drawn = internal::cut(markers, internal::draw_evenly(markers.frames(), kFramesOfNames)),
            .members = {},
            .landmarks = {},
            .variance = {}};
  Segmentation out;
  out.from_names = true;
  if (!read_names(markers, body, out)) return std::optional<Segmentation>();
  const Samples samples{body.drawn, {}};
  std::vector<int> all(at(static_cast<int>(markers.markers())));
  for (std::size_t m = 0; m < all.size(); ++m) all[m] = static_cast<int>(m);
  std::vector<std::int64_t> frames;
  for (std::int64_t f = 0; f < body.drawn.frames(); ++f) frames.push_back(f);
  body.variance = internal::measure_pairs(samples, all, frames, kLeastSeen).variance;
  put_aside(body, options, out);
  internal::PoseStore store(samples);
  add_landmarks(body, store, options, out);
  for (const BodySide side : {BodySide::left, BodySide::right})
    for (const auto& pair : kNeighbours) {
      Where parent = where_of(pair.parent, side);
      const Where child = where_of(pair.child, side);
      // The upper arm meets the thorax where the scapula has no pose of its own.
      if (pair.parent == BodyPart::scapula &&
          !(body.members[parent].size() >= 3 && has_pose(store.of(body.members[parent]), options)))
        parent = {BodyPart::thorax, BodySide::none};
      const auto &above = body.members[parent], &below = body.members[child];
      if (above.empty() || below.empty()) continue;
      JudgedJoint joint{.name = fmt::format("{}_{}", pair.joint, side == BodySide::left ? "l" : "r"),
                        .parent_name = name_of(parent.first, parent.second),
                        .child_name = name_of(child.first, child.second),
                        .parent = above,
                        .child = below,
                        .gap_m = kNaN,
                        .turn_rad = kNaN,
                        .spread_m = kNaN,
                        .weight = 1.0,
                        .rivals = {},
                        .reason = {}};
      const auto lack = [&](const std::string& name, const std::vector<int>& who) {
        return lack_of_pose(body, name, who, who.size() >= 3 && has_pose(store.of(who), options));
      };
      joint.reason = lack(joint.parent_name, above);
      if (joint.reason.empty()) joint.reason = lack(joint.child_name, below);
      if (joint.reason.empty()) judge(store, options, joint);
      out.joints.push_back(std::move(joint));
    }
  if (out.joints.empty()) return std::optional<Segmentation>();
  lay_out(out);
  return std::optional<Segmentation>(std::move(out));
}

}  // namespace kinemark::skeleton
