// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_kind.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>

#include "kinemark/core/enum_names.h"
#include "kinemark/core/index.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/analysis/gait/kinematic_events.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;
using Eigen::RowVector2d;

constexpr EnumNames<GaitManner::sprint> kManners{"walk", "run", "sprint"};
constexpr EnumNames<GaitDirection::sideways> kDirections{"unknown", "forward", "backward", "sideways"};

constexpr double kSprint_m_per_s = 6.0;
constexpr double kBelt_m_per_s = 0.12, kBeltOfBody = 0.5;
constexpr double kLeastStride_m = 0.3, kShort_s = 2.0, kShortSpeed_m_per_s = 0.4;
constexpr std::size_t kLeastEvents = 3;
constexpr double kTogether = 0.12;  // of a stride: strikes of both feet in a jump
constexpr double kFlat = 0.2;       // of the usual speed: a foot that points somewhere
constexpr double kFlat_s = 0.03, kLeastFoot_m = 0.03, kPelvisStep_s = 0.3;
constexpr double kMovesOfMedian = 0.3, kAlong = 0.5, kStands_m_per_s = 0.05;
constexpr double kUnevenBelt_m = 0.03;     // 1 mm on real belts, 40 and more where none is
constexpr double kArcHalf = 0.075;         // of a stride
constexpr double kErrorOfFew = 1.0 / 3.0;  // one or two stances do not tell their scatter
constexpr double kErrors = 2.0;            // by which the mean of stances may be off
// Turns a stride. Toes on ground and belts: 0.08 in walks, 0.15 in runs; heels and ankles of runners 0.5.
// Runners spring by 46 mm and more; who flies without is on pedals, at 4 m/s at most.
constexpr double kMostArc = 0.2, kMostArcUnsprung = 0.1, kMostArcOfRear = 0.6, kSprings_m = -0.03,
                 kPedals_m_per_s = 4.5;
constexpr double kUnfound_s = 0.1;  // from an end of what is seen
constexpr double kTurn_rad = std::numbers::pi / 4.0;

// Where foot or pelvis points at a time, and where the body goes then.
struct Heading {
  double frame = 0.0;
  RowVector2d points{0.0, 0.0}, goes{0.0, 0.0};
};

class Kinds {
 public:
  Kinds(const GaitPaths& paths, const Steps& steps, const Progress& progress)
      : paths_(paths), steps_(steps), progress_(progress) {}

  [[nodiscard]] std::vector<Heading> headings() const {
    std::vector<Heading> out;
    for (const Side side : data::kBothSides)
      if (paths_.foot(side).present() && paths_.foot(side).points) add_stances(side, out);
    if (out.empty() && paths_.pelvis_front.rows() > 0) add_pelvis(out);
    std::ranges::stable_sort(out, {}, &Heading::frame);
    return out;
  }

  [[nodiscard]] bool flat(Side side, std::int64_t f) const {
    return paths_.foot(side).known[at(f)] && steps_.foot(side).speed[f] < kFlat * steps_.usual[f];
  }

  // Median distance of the left one of two to the left of the right one, over frames that have both, m.
  template <class Place>
  [[nodiscard]] double leftward(const std::vector<Heading>& headings, const Place& place) const {
    if (headings.empty()) return kNaN;
    std::vector<double> out;
    auto nearest = headings.begin();
    for (std::int64_t f = 0; f < paths_.frames(); ++f) {
      const auto far = [f](const Heading& one) { return std::abs(one.frame - static_cast<double>(f)); };
      while (std::next(nearest) != headings.end() && far(*std::next(nearest)) <= far(*nearest)) ++nearest;
      const RowVector2d apart = place(Side::left, f) - place(Side::right, f);
      if (apart.allFinite()) out.push_back(nearest->points[0] * apart[1] - nearest->points[1] * apart[0]);
    }
    return out.empty() ? kNaN : math::median(out);
  }
  [[nodiscard]] double feet_leftward(const std::vector<Heading>& headings) const {
    if (!paths_.foot(Side::left).present() || !paths_.foot(Side::right).present()) return kNaN;
    return leftward(headings, [&](Side side, std::int64_t f) -> RowVector2d {
      const auto& foot = paths_.foot(side);
      if (!foot.known[at(f)]) return RowVector2d::Constant(kNaN);
      return 0.5 * (foot.heel.row(f) + foot.toe.row(f)).leftCols<2>();
    });
  }
  [[nodiscard]] double knees_leftward(const std::vector<Heading>& headings) const {
    if (paths_.foot(Side::left).knee.rows() == 0 || paths_.foot(Side::right).knee.rows() == 0) return kNaN;
    return leftward(headings, [&](Side side, std::int64_t f) -> RowVector2d {
      return paths_.foot(side).knee.row(f).leftCols<2>();
    });
  }

  // Where the outer ankles are seen from the lines of their feet: outward is above 0.
  [[nodiscard]] double ankles_outward() const {
    std::array<double, 2> medians{kNaN, kNaN};
    for (const Side side : data::kBothSides) {
      const auto& foot = paths_.foot(side);
      std::vector<double> out;
      for (std::int64_t f = 0; f < paths_.frames() && foot.points && foot.ankle.rows() > 0; ++f) {
        if (!foot.known[at(f)] || !foot.ankle.row(f).allFinite()) continue;
        const RowVector2d points = (foot.toe.row(f) - foot.heel.row(f)).leftCols<2>().normalized(),
                          from = (foot.ankle.row(f) - foot.heel.row(f)).leftCols<2>();
        const double left = points[0] * from[1] - points[1] * from[0];
        out.push_back(side == Side::left ? left : -left);
      }
      if (!out.empty()) medians[data::index_of(side)] = math::median(out);
    }
    if (!(medians[0] * medians[1] > 0.0)) return kNaN;
    return std::abs(medians[0]) < std::abs(medians[1]) ? medians[0] : medians[1];
  }

  // Median of the left front of the pelvis to the left of its right front, m.
  [[nodiscard]] double pelvis_leftward(const std::vector<Heading>& headings) const {
    std::vector<double> out;
    for (const auto& one : headings) {
      const auto f = static_cast<std::int64_t>(one.frame);
      if (paths_.pelvis_across.rows() == 0 || !paths_.pelvis_across.row(f).allFinite()) continue;
      out.push_back(one.points[0] * paths_.pelvis_across(f, 1) - one.points[1] * paths_.pelvis_across(f, 0));
    }
    return out.empty() ? kNaN : math::median(out);
  }

  // How far the heights of two stances of a foot in a row scatter, one standard deviation by their median
  // difference, m; NaN of too few. A belt that is raised or lowered differs little from one to the next.
  [[nodiscard]] double uneven_m() const {
    constexpr double kOfMedian = 1.05;  // a deviation over the median difference of two normal numbers
    std::vector<double> steps;
    for (const Side side : data::kBothSides) {
      const auto& foot = paths_.foot(side);
      double before = kNaN;
      if (foot.present())
        each_flat_span(side, [&](std::int64_t first, std::int64_t n) {
          const double height =
              foot.heel.col(2).segment(first, n).cwiseMin(foot.toe.col(2).segment(first, n)).mean();
          if (std::isfinite(before)) steps.push_back(std::abs(height - before));
          before = height;
        });
    }
    return steps.empty() ? kNaN : kOfMedian * math::median(steps);
  }

  // Turns a stride that the velocity of a foot makes in the middle of a stance, at this speed: by a parabola
  // through 0.15 of a stride, mean over all stances less twice its error. Of the toe, which stands longest;
  // where none is named, of the marker that makes fewer.
  [[nodiscard]] double arc(double speed) const {
    const double toe = arc_of(&FootPaths::toe, speed);
    return toe_named() ? toe : std::min(arc_of(&FootPaths::heel, speed), toe);
  }
  [[nodiscard]] bool toe_named() const {
    return std::ranges::all_of(paths_.feet, [](const FootPaths& foot) {
      return !foot.present() || foot.set == FootSet::heel_and_toe || foot.set == FootSet::ankle_and_toe ||
             foot.set == FootSet::toe_alone;
    });
  }

  // Median way of the pelvis over the ground in a stride, where somebody goes, m: of whole strides, as who
  // walks slowly goes in pulses and is slow most of the time. NaN where none is seen whole.
  [[nodiscard]] double way_m(const RowVector2d& ground, double stride_s) const {
    const auto half = std::max<std::int64_t>(1, std::llround(0.5 * stride_s * paths_.rate_hz));
    const RowVector2d belt = 2.0 * static_cast<double>(half) / paths_.rate_hz * ground;
    std::vector<double> ways;
    for (auto f = half; f + half < paths_.frames(); ++f)
      if (steps_.going[at(f)] && paths_.pelvis_known[at(f - half)] && paths_.pelvis_known[at(f + half)])
        ways.push_back(
            ((paths_.pelvis.row(f + half) - paths_.pelvis.row(f - half)).leftCols<2>() - belt).norm());
    return ways.empty() ? kNaN : math::median(ways);
  }

  // Speed over the ground and the middle velocity, where the pelvis is known and somebody goes.
  [[nodiscard]] std::pair<double, RowVector2d> speeds() const {
    std::vector<double> speed, x, y;
    for (std::int64_t f = 0; f < paths_.frames(); ++f) {
      if (!paths_.pelvis_known[at(f)] || !steps_.going[at(f)]) continue;
      const RowVector2d v = progress_.velocity.row(f);
      speed.push_back(v.norm()), x.push_back(v[0]), y.push_back(v[1]);
    }
    if (speed.empty()) return {0.0, RowVector2d(0.0, 0.0)};
    return {math::median(speed), RowVector2d(math::median(x), math::median(y))};
  }

 private:
  [[nodiscard]] double arc_of(math::SeriesMatrix FootPaths::* marker, double speed) const {
    const auto half = std::max<std::int64_t>(2, std::llround(kArcHalf * steps_.stride_s * paths_.rate_hz));
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    double squares = 0.0, count = 0.0;
    for (const Side side : data::kBothSides) {
      const auto& swings = steps_.foot(side).swings;
      const auto& known = paths_.foot(side).known;
      for (std::size_t i = 0; i + 1 < swings.size(); ++i) {
        if (!swings[i].lands || !swings[i + 1].leaves) continue;
        const auto lands = *swings[i].lands, leaves = *swings[i + 1].leaves, middle = (lands + leaves) / 2;
        if (middle < half || middle + half >= paths_.frames() ||
            static_cast<double>(leaves - lands) > steps_.stride_s * paths_.rate_hz)
          continue;
        if (!std::all_of(known.begin() + (middle - half), known.begin() + (middle + half + 1),
                         std::identity{}))
          continue;
        const auto change = second_derivative(paths_.foot(side).*marker, middle, half);
        sum += change, squares += change.squaredNorm(), count += 1.0;
      }
    }
    const Eigen::RowVector3d mean = sum / count;
    const double error = count > 2.0
                             ? std::sqrt(std::max(0.0, squares / count - mean.squaredNorm()) / (count - 1.0))
                             : kErrorOfFew * mean.norm();
    return std::max(0.0, mean.norm() - kErrors * error) * paths_.rate_hz * paths_.rate_hz * steps_.stride_s /
           (2.0 * std::numbers::pi * speed);
  }

  // Second derivative of the parabola through 2 half + 1 frames, per frame squared.
  [[nodiscard]] static Eigen::RowVector3d second_derivative(const math::SeriesMatrix& x, std::int64_t middle,
                                                            std::int64_t half) {
    const auto n = static_cast<double>(2 * half + 1);
    const double mean = (n * n - 1.0) / 12.0;  // of squares of frames from the middle
    Eigen::RowVector3d sum = Eigen::RowVector3d::Zero();
    double squares = 0.0;
    for (auto k = -half; k <= half; ++k) {
      const double u = static_cast<double>(k * k) - mean;
      sum += u * x.row(middle + k), squares += u * u;
    }
    return 2.0 / squares * sum;
  }

  // Frames that a foot is flat in, one span a stance or part of one: visit(first, count).
  template <class Visit>
  void each_flat_span(Side side, const Visit& visit) const {
    if (steps_.foot(side).speed.size() == 0) return;
    const auto least = std::max<std::int64_t>(3, std::llround(kFlat_s * paths_.rate_hz));
    for (std::int64_t f = 0; f < paths_.frames(); ++f) {
      if (!flat(side, f)) continue;
      auto last = f;
      while (last + 1 < paths_.frames() && flat(side, last + 1)) ++last;
      if (last - f + 1 >= least) visit(f, last - f + 1);
      f = last;
    }
  }

  void add_stances(Side side, std::vector<Heading>& out) const {
    const auto& foot = paths_.foot(side);
    each_flat_span(side, [&](std::int64_t first, std::int64_t n) {
      const RowVector2d points = (foot.toe - foot.heel).block(first, 0, n, 2).colwise().mean();
      if (points.norm() >= kLeastFoot_m)
        out.push_back({.frame = static_cast<double>(first) + 0.5 * static_cast<double>(n - 1),
                       .points = points.normalized(),
                       .goes = progress_.velocity.middleRows(first, n).colwise().mean()});
    });
  }

  void add_pelvis(std::vector<Heading>& out) const {
    const auto step = std::max<std::int64_t>(1, static_cast<std::int64_t>(kPelvisStep_s * paths_.rate_hz));
    for (std::int64_t f = 0; f < paths_.frames(); f += step) {
      RowVector2d points(0.0, 0.0), goes(0.0, 0.0);
      double count = 0.0;
      for (auto k = f; k < std::min(paths_.frames(), f + step); ++k) {
        goes += progress_.velocity.row(k) / static_cast<double>(step);
        if (paths_.pelvis_front.row(k).allFinite()) points += paths_.pelvis_front.row(k), count += 1.0;
      }
      if (count > 0.0 && points.norm() > 0.0)
        out.push_back({.frame = static_cast<double>(f), .points = points.normalized(), .goes = goes});
    }
  }

  const GaitPaths& paths_;
  const Steps& steps_;
  const Progress& progress_;
};

void judge_direction(const std::vector<Heading>& headings, double speed, GaitKind& out) {
  std::vector<double> along;
  for (const auto& one : headings)
    if (one.goes.norm() > kMovesOfMedian * speed && one.goes.norm() > 0.0)
      along.push_back(one.points.dot(one.goes) / one.goes.norm());
  if (headings.empty() || !(speed > kStands_m_per_s)) return;
  const double cosine = along.empty() ? 0.0 : math::median(along);
  out.direction = cosine > kAlong    ? GaitDirection::forward
                  : cosine < -kAlong ? GaitDirection::backward
                                     : GaitDirection::sideways;
  // Headings of two stances in a row, so that toeing out is no turn.
  std::vector<double> angles;
  for (const auto& one : headings) {
    double angle = std::atan2(one.points[1], one.points[0]);
    if (!angles.empty())
      angle = angles.back() + std::remainder(angle - angles.back(), 2.0 * std::numbers::pi);
    angles.push_back(angle);
  }
  if (angles.size() >= 4) {
    for (std::size_t i = 0; i + 1 < angles.size(); ++i) angles[i] = 0.5 * (angles[i] + angles[i + 1]);
    angles.pop_back();
  }
  out.turn_rad = std::ranges::max(angles) - std::ranges::min(angles);
  out.turning = out.turn_rad > kTurn_rad;
}

// Share of the left foot's strikes at which the right one lands too.
bool lands_together(const std::vector<data::GaitEvent>& events, double stride_s) {
  int strikes = 0, together = 0;
  for (const auto& left : events) {
    if (left.side != Side::left || left.what != FootEvent::strike) continue;
    ++strikes;
    together += std::ranges::any_of(events, [&](const data::GaitEvent& right) {
      return right.side == Side::right && right.what == FootEvent::strike &&
             std::abs(right.time_s - left.time_s) < kTogether * stride_s;
    });
  }
  return 2 * together > strikes;
}

// From what a foot does to when it does the same again, s: ascending.
std::vector<double> strides_of(const std::vector<data::GaitEvent>& events) {
  std::vector<double> out;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const auto next = std::find_if(
        events.begin() + static_cast<std::ptrdiff_t>(i) + 1, events.end(),
        [&](const auto& one) { return one.side == events[i].side && one.what == events[i].what; });
    if (next != events.end()) out.push_back(next->time_s - events[i].time_s);
  }
  std::ranges::sort(out);
  return out;
}

// What every stride lasts longer than, where none was seen whole: the longest span in which a foot is
// seen, nobody stands, and a kind of event is missing, less what is too near to an end to be found.
double longer_than(const GaitPaths& paths, const Steps& steps, const std::vector<data::GaitEvent>& events) {
  double out = 0.0;
  for (const Side side : data::kBothSides)
    for (const FootEvent what : data::kFootEvents) {
      const auto& foot = paths.foot(side);
      std::vector<std::int64_t> frames;
      for (const auto& event : events)
        if (event.side == side && event.what == what)
          frames.push_back(std::llround((event.time_s - paths.start_s) * paths.rate_hz));
      std::int64_t begun = 0;
      bool at_event = false;  // begun at
      for (std::int64_t f = 0; f <= paths.frames(); ++f) {
        const bool seen = f < paths.frames() && foot.present() && foot.known[at(f)] && !steps.quiet[at(f)];
        const bool event = std::ranges::find(frames, f) != frames.end();
        if (seen && !event) continue;
        const double ends = (at_event ? 0.0 : kUnfound_s) + (event ? 0.0 : kUnfound_s);
        out = std::max(out, static_cast<double>(f - begun) / paths.rate_hz - ends);
        begun = seen || event ? f : f + 1, at_event = event;
      }
    }
  return out;
}

}  // namespace

std::string_view to_string(GaitManner manner) { return kManners[manner]; }
std::string_view to_string(GaitDirection direction) { return kDirections[direction]; }

GaitKind judge_kind(const GaitPaths& paths, const Ground& ground, const Steps& steps,
                    const Progress& progress, const std::vector<data::GaitEvent>& events) {
  GaitKind out{.stride_s = steps.stride_s};
  const Kinds kinds(paths, steps, progress);
  const auto [speed, velocity] = kinds.speeds();
  const auto evidence = run_evidence(paths, steps, ground.velocity);
  const double seconds = static_cast<double>(paths.frames() - 1) / paths.rate_hz,
               stands = static_cast<double>(std::ranges::count(steps.quiet, true)) / paths.rate_hz;
  out.speed_m_per_s = speed;
  out.flight_share = evidence.flight_share;
  out.bounce_m = evidence.bounce_m;
  out.belt = ground.velocity.norm() > std::max(kBelt_m_per_s, kBeltOfBody * velocity.norm());
  out.belt_m_per_s = out.belt ? ground.velocity.norm() : 0.0;
  out.manner = !evidence.runs()          ? GaitManner::walk
               : speed > kSprint_m_per_s ? GaitManner::sprint
                                         : GaitManner::run;
  out.brief = seconds - stands < steps.stride_s;
  out.arc = kinds.arc(speed);
  if (const auto strides = strides_of(events); !strides.empty())
    out.stride_s = strides[strides.size() / 4];  // a stand between is none
  else
    out.longer_than_s = longer_than(paths, steps, events);
  const auto headings = kinds.headings();
  judge_direction(headings, speed, out);
  out.left_of_right_m = kinds.feet_leftward(headings);
  out.knees_left_of_right_m = kinds.knees_leftward(headings);
  out.ankles_outward_m = kinds.ankles_outward();
  out.pelvis_left_of_right_m = kinds.pelvis_leftward(headings);
  if (steps.feet[0].swings.empty() && steps.feet[1].swings.empty())
    out.not_gait = "no foot swings: none moves by 80 mm over the ground";
  else if (const double whole_m = kinds.way_m(ground.velocity, out.stride_s),
           goes_m = std::isfinite(whole_m) ? whole_m : evidence.speed_m_per_s * out.stride_s;
           !(goes_m > kLeastStride_m))
    out.not_gait =
        fmt::format("the feet move, but the body goes {:.2f} m a stride over the ground; need {:.1f}", goes_m,
                    kLeastStride_m);
  else if (events.size() < kLeastEvents &&
           !(!events.empty() && speed > kShortSpeed_m_per_s && seconds < kShort_s))
    out.not_gait =
        fmt::format("the feet land and leave {} times in all; need {}", events.size(), kLeastEvents);
  else if (lands_together(events, steps.stride_s))
    out.not_gait = "both feet land together, as in a jump";
  else if (const double most = !kinds.toe_named() ? kMostArcOfRear
                               : evidence.runs() && !(out.bounce_m < kSprings_m) && speed < kPedals_m_per_s
                                   ? kMostArcUnsprung
                                   : kMostArc;
           out.belt && out.arc > most)
    out.not_gait = fmt::format(
        "the feet go round as on pedals: where they go back, their velocity turns at {:.2f} turns a stride; "
        "on a belt, where a foot goes straight and evenly, {:.2f} at most",
        out.arc, most);
  else if (const double uneven_m = kinds.uneven_m(); out.belt && uneven_m > kUnevenBelt_m)
    out.not_gait = fmt::format(
        "the feet slide back as on a treadmill, but stand in heights that differ by {:.0f} mm from one "
        "stance "
        "to the next (standard deviation); need {:.0f} at most",
        1e3 * uneven_m, 1e3 * kUnevenBelt_m);
  return out;
}

std::string GaitKind::sentence() const {
  const auto* const goes = manner == GaitManner::walk  ? "walking"
                           : manner == GaitManner::run ? "running"
                                                       : "sprinting";
  std::string out =
      fmt::format("{}{} {}", brief ? "about " : "", goes, belt ? "on a treadmill" : "over ground");
  if (direction != GaitDirection::unknown) out += fmt::format(", {}", to_string(direction));
  if (turning) out += fmt::format(", turning by {:.0f} deg", turn_rad * 180.0 / std::numbers::pi);
  out += fmt::format(": {:.2f} m/s, ", speed_m_per_s);
  if (std::isfinite(longer_than_s))
    out += "no stride seen whole" +
           (longer_than_s > 0.0 ? fmt::format(": each lasts more than {:.2f} s", longer_than_s) : "");
  else
    out += fmt::format("strides of {:.2f} s", stride_s);
  if (belt) {
    const bool even = !std::isfinite(belt_least_m_per_s);
    out += fmt::format("; the feet slide back at {} m/s while they stand",
                       even ? fmt::format("{:.3f}", belt_m_per_s)
                            : fmt::format("{:.2f} to {:.2f}", belt_least_m_per_s, belt_most_m_per_s));
  }
  if (direction == GaitDirection::unknown)
    out += direction_doubted
               ? "; forward or backward cannot be known"
               : "; forward or backward is not known, as no foot's heel and toe and no front of "
                 "the pelvis are named";
  return out;
}

}  // namespace kinemark::analysis
