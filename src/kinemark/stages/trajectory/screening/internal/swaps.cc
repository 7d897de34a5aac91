// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Labels that jump: two markers exchange theirs, or one jumps to the path of another and back.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "kinemark/core/missing.h"
#include "kinemark/data/frame_list.h"
#include "kinemark/math/exchanged_points.h"
#include "kinemark/stages/trajectory/screening/internal/defects.h"

namespace kinemark::trajectory::internal {
namespace {

using data::Trajectories;
using Eigen::Vector3d;

constexpr double kLongestGap = 0.1;    // s, over which a path is continued as a straight line
constexpr double kLongestVisit = 0.5;  // s
constexpr double kMuchBetter = 0.25;   // of the distances left by the labels as they are
constexpr double kSideUnknown = 0.6;   // confidence where either side may be the wrong one
constexpr double kTimesUsual = 8.0;    // a jump stands that much above what a marker's continuation misses by

/// Frames in a time, 1 at least and no more than there are.
std::int64_t frames_in(const Trajectories& t, double time_s) {
  return std::max<std::int64_t>(
      1, std::llround(std::min(time_s * t.time.rate_hz, static_cast<double>(t.frames()))));
}

/// Paths continued by a straight line from their last two samples, updated frame by frame.
class Continuation {
 public:
  explicit Continuation(const Trajectories& t) : t_(t), gap_(frames_in(t, kLongestGap)) {
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      std::vector<double> missed;
      for (std::int64_t f = 2; f < t.frames(); ++f)
        if (t.present(f, m) && t.present(f - 1, m) && t.present(f - 2, m))
          missed.push_back((t.x(f, m) - 2.0 * t.x(f - 1, m) + t.x(f - 2, m)).norm());
      usual_.push_back(median_of(missed));
    }
    paths_.resize(usual_.size());
  }

  /// Predicted position of the marker from its recent samples before the frame.
  [[nodiscard]] std::optional<Vector3d> at(std::int64_t frame, std::int64_t marker) const {
    const Path& p = paths_[static_cast<std::size_t>(marker)];
    if (p.last < 0 || frame - p.last > gap_) return std::nullopt;
    return Vector3d(p.x + static_cast<double>(frame - p.last) * p.velocity);
  }
  [[nodiscard]] std::int64_t last_seen(std::int64_t marker) const {
    return paths_[static_cast<std::size_t>(marker)].last;
  }
  /// Median prediction error of this marker, m.
  [[nodiscard]] double usual(std::int64_t marker) const { return usual_[static_cast<std::size_t>(marker)]; }

  void see(std::int64_t frame) {
    for (std::int64_t m = 0; m < t_.markers(); ++m) {
      if (!t_.present(frame, m)) continue;
      Path& p = paths_[static_cast<std::size_t>(m)];
      p.velocity = p.last == frame - 1 && frame > 0 ? Vector3d(t_.x(frame, m) - p.x) : Vector3d::Zero();
      p.x = t_.x(frame, m);
      p.last = frame;
    }
  }

 private:
  struct Path {
    std::int64_t last = -1;
    Vector3d x = Vector3d::Zero();
    Vector3d velocity = Vector3d::Zero();  // m per frame
  };
  const Trajectories& t_;
  std::int64_t gap_;
  std::vector<double> usual_;
  std::vector<Path> paths_;
};

struct Jump {
  std::int64_t frame = 0;
  std::int64_t marker = 0;
  std::int64_t left = 0;  ///< frame of the sample before
  double length = 0.0;    ///< m
};

/// Go through the recording; where two markers jump onto each other's continuation, exchange them from there
/// on, so that the next frame is judged by the right path. `t` ends with labels that follow the paths.
void follow(Trajectories& t, double least, std::vector<Jump>& jumps) {
  Continuation path(t);
  std::vector<std::int64_t> label(t.names.size());  // whose samples a path takes
  std::iota(label.begin(), label.end(), std::int64_t{0});
  std::vector<Vector3d> x(t.names.size());
  std::vector<data::SampleState> state(t.names.size());
  for (std::int64_t f = 0; f < t.frames(); ++f) {
    if (!std::ranges::is_sorted(label)) {
      for (std::size_t m = 0; m < label.size(); ++m) {
        x[m] = t.x(f, label[m]);
        state[m] = t.state[t.index(f, label[m])];
      }
      for (std::size_t m = 0; m < label.size(); ++m) {
        t.x(f, static_cast<std::int64_t>(m)) = x[m];
        t.state[t.index(f, static_cast<std::int64_t>(m))] = state[m];
      }
    }
    std::vector<Jump> now;
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      if (!t.present(f, m)) continue;
      const auto expected = path.at(f, m);
      if (!expected) continue;
      const double length = (t.x(f, m) - *expected).norm();
      if (length > std::max(least, kTimesUsual * path.usual(m)))
        now.push_back({f, m, path.last_seen(m), length});
    }
    std::vector<char> taken(now.size(), 0);
    for (std::size_t a = 0; a < now.size(); ++a)
      for (std::size_t b = a + 1; b < now.size() && taken[a] == 0; ++b) {
        if (taken[b] != 0) continue;
        const std::int64_t i = now[a].marker;
        const std::int64_t j = now[b].marker;
        const double exchanged = (t.x(f, i) - *path.at(f, j)).norm() + (t.x(f, j) - *path.at(f, i)).norm();
        const double as_is = now[a].length + now[b].length;
        if (!(exchanged < kMuchBetter * as_is)) continue;
        taken[a] = taken[b] = 1;
        std::swap(label[static_cast<std::size_t>(i)], label[static_cast<std::size_t>(j)]);
        const Vector3d one = t.x(f, i);
        t.x(f, i) = t.x(f, j);
        t.x(f, j) = one;
      }
    for (std::size_t a = 0; a < now.size(); ++a)
      if (taken[a] == 0) jumps.push_back(now[a]);
    path.see(f);
  }
}

/// The marker of the other side, "RTOE" for "LTOE" and "sub:RTOE" for "sub:LTOE", or -1.
std::int64_t other_side(const Trajectories& t, std::int64_t marker) {
  std::string name = t.names[static_cast<std::size_t>(marker)];
  const auto begin = name.rfind(':') == std::string::npos ? 0 : name.rfind(':') + 1;
  for (const auto& [from, to] :
       {std::pair{'L', 'R'}, std::pair{'R', 'L'}, std::pair{'l', 'r'}, std::pair{'r', 'l'}}) {
    for (const std::size_t at : {begin, name.size() - 1}) {
      if (name.size() <= begin + 1 || name[at] != from) continue;
      std::string other = name;
      other[at] = to;
      if (const auto found = t.find(other); found >= 0) return found;
    }
  }
  return -1;
}

/// The usual distance of the same two markers on the other side of the body, m; NaN where there are none, or
/// where that distance is one of `partner` or of the marker itself, which are exchanged with each other.
double usual_distance_beside(const Trajectories& t, std::int64_t one, std::int64_t other,
                             std::int64_t partner) {
  const std::int64_t a = other_side(t, one), b = other_side(t, other);
  for (const std::int64_t exchanged : {one, partner})
    if (a == exchanged || b == exchanged) return kNaN;
  std::vector<double> distances;
  for (std::int64_t f = 0; f < t.frames() && a >= 0 && b >= 0; ++f)
    if (t.present(f, a) && t.present(f, b)) distances.push_back((t.x(f, a) - t.x(f, b)).norm());
  return distances.empty() ? kNaN : median_of(std::move(distances));
}

/// An exchange, and whether it is the body that has said which of its sides is right: where the paths show
/// both ends of the fewer frames, it has only confirmed that.
struct Exchange {
  math::ExchangedPair pair;
  bool stated_by_body = false;
};

/// The other frames that see both; none where these are all.
std::vector<std::int64_t> rest_of(const Trajectories& t, const math::ExchangedPair& pair) {
  std::vector<std::int64_t> rest;
  for (std::int64_t f = 0; f < t.frames(); ++f)
    if (t.present(f, pair.one) && t.present(f, pair.other) && !std::ranges::binary_search(pair.frames, f))
      rest.push_back(f);
  return rest;
}

/// Where the distances of the other side of the body speak against the greater part of the frames, that side
/// may as well have its markers elsewhere: the fewer frames are named, and that nobody can decide.
math::ExchangedPair fewer_of(const Trajectories& t, math::ExchangedPair pair) {
  if (!pair.stated_by_distances) return pair;
  auto rest = rest_of(t, pair);
  if (rest.empty() || rest.size() >= pair.frames.size()) return pair;
  pair.frames = std::move(rest);
  pair.side_known = pair.stated_by_distances = false;
  return pair;
}

void swap_samples(Trajectories& t, const math::ExchangedPair& pair) {
  for (const std::int64_t f : pair.frames) {
    const Vector3d x = t.x(f, pair.one);
    t.x(f, pair.one) = t.x(f, pair.other);
    t.x(f, pair.other) = x;
  }
}

/// Let the body say which side of an exchange is right; `t` is without exchanges, and stays so. Where the
/// distances of the other side contradict the body nobody can decide.
Exchange ask_body(Trajectories& t, const ScreenOptions& options, math::ExchangedPair pair) {
  const int side = options.side ? options.side(t, pair.one, pair.other) : 0;
  if (side == 0) return {.pair = std::move(pair)};
  const bool confirms = side > 0 && pair.side_known && (pair.ends || pair.stated_by_distances);
  if (side < 0 && pair.stated_by_distances) {
    pair.side_known = pair.stated_by_distances = false;
    return {.pair = std::move(pair)};
  }
  if (side < 0) {
    auto rest = rest_of(t, pair);
    if (rest.empty()) return {.pair = std::move(pair)};
    swap_samples(t, pair);
    pair.frames = std::move(rest);
    swap_samples(t, pair);
  }
  pair.side_known = true;
  return {.pair = std::move(pair), .stated_by_body = !confirms};
}

/// What is known of the side that is right, as the end of a sentence; empty: nobody asks.
const char* side_of(const Exchange& exchange, bool whole) {
  const auto& pair = exchange.pair;
  if (!pair.side_known)
    return "; which of these and the other frames are right cannot be decided, the fewer are named";
  if (exchange.stated_by_body)
    return "; the other frames are right, as a body has markers of these names there";
  return whole && !pair.ends && !pair.stated_by_distances
             ? "; which side is right cannot be decided by the paths, the far fewer frames are named"
             : "";
}

void report_exchange(const Trajectories& t, const Exchange& exchange, Defects& out) {
  const auto& pair = exchange.pair;
  const std::int64_t first = pair.frames.front(), last = pair.frames.back();
  const bool whole = last - first + 1 == std::ssize(pair.frames);
  const auto frames =
      whole ? describe_frames(t.time, first, last)
            : fmt::format("{} frames: {}", pair.frames.size(), data::words_of_frames(pair.frames, t.time));
  const double sure = confidence_of(pair.ratio, 0.4);
  out.push_back(
      {.kind = FindingKind::label_swap,
       .marker = pair.one,
       .other_marker = pair.other,
       .first_frame = first,
       .last_frame = last,
       .frames = whole ? std::vector<std::int64_t>() : pair.frames,
       .size = pair.apart_m,
       .confidence = pair.side_known ? sure : std::min(sure, kSideUnknown),
       .description = fmt::format("markers '{}' and '{}' are exchanged in {}: exchanged back they continue "
                                  "their paths {:.0f} times "
                                  "better{}",
                                  t.names[static_cast<std::size_t>(pair.one)],
                                  t.names[static_cast<std::size_t>(pair.other)], frames, pair.ratio,
                                  side_of(exchange, whole))});
}

/// Exchanges by paths, distances and the body, each pair once; and the recording without them.
void report_exchanges(Trajectories& t, const ScreenOptions& options, Defects& out) {
  const auto found = math::find_exchanges(
      {.x = t.x_in_world.data(), .frames = t.frames(), .points = t.markers(), .rate_hz = t.time.rate_hz},
      {.least_m = options.min_jump_m,
       .longest_gap_s = kLongestGap,
       .distance = [&](std::int64_t one, std::int64_t other, std::int64_t partner) {
         return usual_distance_beside(t, one, other, partner);
       }});
  std::vector<math::ExchangedPair> pairs;
  for (const auto& pair : found) pairs.push_back(fewer_of(t, pair));
  for (const auto& pair : pairs) swap_samples(t, pair);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    // Exchanges of one marker with two others are undone in their order: none of them is turned by itself.
    const bool alone = std::ranges::none_of(pairs, [&](const math::ExchangedPair& p) {
      return &p != &pairs[i] && (p.one == pairs[i].one || p.other == pairs[i].one ||
                                 p.one == pairs[i].other || p.other == pairs[i].other);
    });
    report_exchange(t, alone ? ask_body(t, options, pairs[i]) : Exchange{.pair = pairs[i]}, out);
  }
}

/// The path of a marker between two frames that see it, `u` of the way from `before` to `after`: with the
/// velocities of the samples beyond them where those are seen, else with that of the line.
Vector3d between(const Trajectories& t, std::int64_t marker, std::int64_t before, std::int64_t after,
                 double u) {
  const Vector3d a = t.x(before, marker), b = t.x(after, marker);
  const auto frames = static_cast<double>(after - before);
  Vector3d leaves = b - a, arrives = b - a;
  if (before > 0 && t.present(before - 1, marker)) leaves = frames * (a - t.x(before - 1, marker));
  if (after + 1 < t.frames() && t.present(after + 1, marker)) arrives = frames * (t.x(after + 1, marker) - b);
  const double v = 1.0 - u;
  return v * v * (1.0 + 2.0 * u) * a + u * u * (1.0 + 2.0 * v) * b + u * v * (v * leaves - u * arrives);
}

/// The marker whose path lies at x_i throughout [first, last], or -1; `distance` is the median distance, m.
std::int64_t host_of(const Trajectories& t, std::int64_t guest, std::int64_t first, std::int64_t last,
                     double& distance) {
  std::int64_t host = -1;
  distance = HUGE_VAL;
  for (std::int64_t m = 0; m < t.markers(); ++m) {
    if (m == guest) continue;
    // Its path: where it is seen, else between the samples around.
    std::int64_t before = first;
    std::int64_t after = last;
    while (before > 0 && !t.present(before, m)) --before;
    while (after + 1 < t.frames() && !t.present(after, m)) ++after;
    if (!t.present(before, m) || !t.present(after, m)) continue;
    std::vector<double> distances;
    for (std::int64_t f = first; f <= last; ++f) {
      if (!t.present(f, guest)) continue;
      const double u =
          after > before ? static_cast<double>(f - before) / static_cast<double>(after - before) : 0.0;
      const Vector3d x = t.present(f, m) ? Vector3d(t.x(f, m)) : between(t, m, before, after, u);
      distances.push_back((t.x(f, guest) - x).norm());
    }
    const double d = median_of(distances);
    if (d < distance) {
      distance = d;
      host = m;
    }
  }
  return host;
}

void report_visits(const Trajectories& t, const std::vector<Jump>& jumps, double least, Defects& out) {
  const std::int64_t longest = frames_in(t, kLongestVisit);
  for (std::size_t a = 0; a < jumps.size(); ++a) {
    const Jump& there = jumps[a];
    const std::int64_t left = there.left;
    for (std::size_t b = a + 1; b < jumps.size() && jumps[b].frame - there.frame <= longest; ++b) {
      const Jump& back = jumps[b];
      if (back.marker != there.marker) continue;
      const std::int64_t m = there.marker;
      // Back on its own path: on the line through its samples before and after.
      if (back.frame + 1 >= t.frames() || !t.present(back.frame + 1, m) || left < 1 ||
          !t.present(left - 1, m))
        break;
      const auto away = static_cast<double>(back.frame - left);
      const Vector3d velocity =
          0.5 * (t.x(left, m) - t.x(left - 1, m) + t.x(back.frame + 1, m) - t.x(back.frame, m));
      const double off = (t.x(back.frame, m) - t.x(left, m) - away * velocity).norm();
      const double jump = std::min(there.length, back.length);
      if (off > kMuchBetter * jump) continue;
      double distance = HUGE_VAL;
      const std::int64_t host = host_of(t, m, there.frame, back.frame - 1, distance);
      if (host < 0 || distance > 0.5 * least) break;
      const double ratio = jump / std::max(std::max(distance, off), 1e-6);
      out.push_back(
          {.kind = FindingKind::swap_within,
           .marker = m,
           .other_marker = host,
           .first_frame = there.frame,
           .last_frame = back.frame - 1,
           .size = jump,
           .confidence = confidence_of(ratio, 0.8),
           .description = fmt::format(
               "marker '{}' jumps {:.0f} mm to the path of '{}' in {} ({:.1f} mm from it) and "
               "back to its own",
               t.names[static_cast<std::size_t>(m)], 1e3 * jump, t.names[static_cast<std::size_t>(host)],
               describe_frames(t.time, there.frame, back.frame - 1), 1e3 * distance)});
      break;
    }
  }
}

}  // namespace

void find_swaps(const Trajectories& recorded, const ScreenOptions& options, Defects& out) {
  Trajectories t = recorded;
  report_exchanges(t, options, out);
  std::vector<Jump> jumps;
  follow(t, options.min_jump_m, jumps);
  report_visits(t, jumps, options.min_jump_m, out);
}

}  // namespace kinemark::trajectory::internal
