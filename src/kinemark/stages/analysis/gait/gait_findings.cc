// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "kinemark/core/text.h"
#include "kinemark/math/statistics.h"
#include "kinemark/stages/analysis/gait/marker_events.h"

namespace kinemark::analysis {
namespace {

using data::FootEvent;
using data::Side;

constexpr std::size_t kMostNamed = 4;
constexpr double kSeenMostly = 0.95;
constexpr double kApart_m = 0.05,
                 kOuter_m = 0.01;  // left of right, or right of left; an outer ankle beside its foot
constexpr double kUneven = 0.35;
constexpr double kMostMore = 1.0, kMostMoreOfAll = 0.1;

std::string_view word_of(Side side) { return side == Side::left ? "left" : "right"; }

class Findings {
 public:
  Findings(const GaitSmoother& smoother, const MarkerEvents& found) : smoother_(smoother), found_(found) {}

  std::vector<std::string> tell() {
    for (const Side side : data::kBothSides)
      if (smoother_.paths().foot(side).present()) {
        tell_seen(side);
        tell_strikes(side);
      }
    tell_both();
    tell_ends();
    tell_doubt();
    tell_sides();
    if (sd_factor(found_.kind.direction) > 1.0)
      out_.push_back(
          fmt::format("no plates have judged events of going {}: their SDs are {:.1f} times those of going "
                      "forward",
                      to_string(found_.kind.direction), sd_factor(found_.kind.direction)));
    return std::move(out_);
  }

  std::vector<std::string> tell_of(NamesOf names) {
    if (names == NamesOf::ends_and_sides) tell_ends();
    tell_sides();
    return std::move(out_);
  }

 private:
  [[nodiscard]] std::string spans(const std::vector<FrameSpan>& of) const {
    std::vector<std::string> out;
    const auto& paths = smoother_.paths();
    for (const auto& span : of)
      out.push_back(fmt::format("from {:.2f} to {:.2f} s", paths.time_s(static_cast<double>(span.first)),
                                paths.time_s(static_cast<double>(span.last))));
    return join_names(out, kMostNamed);
  }

  void tell_seen(Side side) {
    const auto& seen = smoother_.seen(side);
    if (!seen.held.empty())
      out_.push_back(fmt::format("{} foot: a marker is held still, {}; it is taken as hidden there",
                                 word_of(side), spans(seen.held)));
    if (seen.leaps > 0)
      out_.push_back(fmt::format("{} foot: {} sample{} there and back and {} left out", word_of(side),
                                 seen.leaps, seen.leaps == 1 ? " leaps" : "s leap",
                                 seen.leaps == 1 ? "is" : "are"));
    if (!seen.hidden.empty())
      out_.push_back(
          fmt::format("{} foot: hidden {}, events there cannot be found", word_of(side), spans(seen.hidden)));
    else if (seen.share < kSeenMostly)
      out_.push_back(fmt::format("{} foot: seen in {:.0f} % of the frames, gaps of up to 0.25 s are bridged",
                                 word_of(side), 100.0 * seen.share));
  }

  [[nodiscard]] std::vector<double> times(Side side, FootEvent what) const {
    std::vector<double> out;
    for (const auto& event : found_.events)
      if (event.side == side && event.what == what) out.push_back(event.time_s);
    std::ranges::sort(out);
    return out;
  }

  void tell_strikes(Side side) {
    const auto strikes = times(side, FootEvent::strike);
    if (strikes.empty()) out_.push_back(fmt::format("{} foot: no strike is found", word_of(side)));
    std::vector<double> strides;
    for (std::size_t i = 0; i + 1 < strikes.size(); ++i) strides.push_back(strikes[i + 1] - strikes[i]);
    if (strides.size() < 4) return;
    const double mean =
        std::accumulate(strides.begin(), strides.end(), 0.0) / static_cast<double>(strides.size());
    double squares = 0.0;
    for (const double t : strides) squares += (t - mean) * (t - mean) / static_cast<double>(strides.size());
    if (std::sqrt(squares) > kUneven * mean)
      out_.push_back(fmt::format("{} foot: strides of very different duration, {:.2f} +- {:.2f} s",
                                 word_of(side), mean, std::sqrt(squares)));
  }

  void tell_both() {
    const auto left = times(Side::left, FootEvent::strike).size(),
               right = times(Side::right, FootEvent::strike).size();
    const auto more = static_cast<double>(std::max(left, right) - std::min(left, right));
    if (more > kMostMore + kMostMoreOfAll * static_cast<double>(left + right))
      out_.push_back(fmt::format("{} strikes of the left foot beside {} of the right one", left, right));
  }

  void tell_ends() {
    const auto& ends = found_.ends;
    for (const Side side : data::kBothSides) {
      if (!points(side) || !ends.exchanged[data::index_of(side)]) continue;
      const auto [heel, toe] = names_of_ends(side);
      out_.push_back(fmt::format("{} and {} are exchanged: {}; walking is measured with them exchanged back",
                                 heel, toe, ends.why(side, heel, toe)));
    }
    if (ends.pelvis_exchanged)
      out_.emplace_back(
          "the front of the pelvis points against the feet: the names of its front and its back are "
          "exchanged");
  }

  void tell_doubt() {
    if (!found_.ends.doubtful) return;
    std::vector<std::string> pairs;
    for (const Side side : data::kBothSides)
      if (points(side)) {
        const auto [heel, toe] = names_of_ends(side);
        pairs.push_back(fmt::format("{} with {}", heel, toe));
      }
    out_.push_back(fmt::format(
        "whether the body goes forward or backward cannot be known: heel and toe may be exchanged "
        "({}), and nothing else tells for sure",
        join_names(pairs, pairs.size())));
  }

  [[nodiscard]] bool points(Side side) const {
    const auto& foot = smoother_.paths().foot(side);
    return foot.present() && foot.points;
  }

  // As the file names them.
  [[nodiscard]] std::array<std::string, 2> names_of_ends(Side side) const {
    auto names = smoother_.ends_of(side);
    if (found_.ends.exchanged[data::index_of(side)]) std::swap(names[0], names[1]);
    return names;
  }

  // Feet may cross over: they speak of sides by their outer ankles alone.
  void tell_sides() {
    const auto& kind = found_.kind;
    if (kind.direction_doubted) return;
    struct Part {
      std::string_view what;
      double apart_m;
    };
    std::vector<Part> wrong, right;
    const auto judge = [&](std::string_view what, double apart_m, bool crosses, bool holds) {
      if (crosses) wrong.push_back({what, apart_m});
      if (holds) right.push_back({what, apart_m});
    };
    judge(
        "foot", kind.left_of_right_m,
        kind.ankles_outward_m < -kOuter_m && kind.left_of_right_m<-kApart_m, kind.ankles_outward_m> kOuter_m);
    for (const auto& [what, apart_m] :
         {Part{"front of the pelvis", kind.pelvis_left_of_right_m}, Part{"knee", kind.knees_left_of_right_m}})
      judge(what, apart_m, apart_m<-kApart_m, apart_m> kApart_m);
    if (wrong.empty()) return;
    const auto& first = wrong.front();
    if (right.empty())
      out_.push_back(
          fmt::format("the left {} lies {:.0f} mm to the right of the right one: the names of the sides are "
                      "exchanged, or the recording is mirrored",
                      first.what, -1e3 * first.apart_m));
    else
      out_.push_back(fmt::format(
          "the left {} lies {:.0f} mm to the right of the right one, and the left {} {}: the names of the "
          "sides are exchanged at one of them",
          first.what, -1e3 * first.apart_m, right.front().what,
          right.front().what == "foot" ? "has its ankle on the left" : "lies on the left"));
  }

  const GaitSmoother& smoother_;
  const MarkerEvents& found_;
  std::vector<std::string> out_;
};

}  // namespace

std::vector<std::string> findings_of(const GaitSmoother& smoother, const MarkerEvents& found) {
  return Findings(smoother, found).tell();
}

std::vector<std::string> name_findings_of(const GaitSmoother& smoother, const MarkerEvents& found,
                                          NamesOf names) {
  return Findings(smoother, found).tell_of(names);
}

}  // namespace kinemark::analysis
