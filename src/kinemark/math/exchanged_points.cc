// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/math/exchanged_points.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "kinemark/math/statistics.h"

namespace kinemark::math {
namespace {

using Eigen::Vector3d;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

constexpr double kMuchBetter = 0.25;  // of what the names as they are leave of the paths
constexpr double kBetterEach = 0.5;   // the same for each of the two points
constexpr double kLeastScale = 0.01;  // of the shortest distance: paths are never smoother than that
constexpr double kTurnCost = 2.0;     // nats, for each change of the sign
constexpr double kLeastGain = 10.0;   // nats, for each stretch
constexpr double kFewer = 0.4;        // share of the frames below which the fewer are the exchanged ones
constexpr double kApart = 3.0;        // spreads by which two distances must differ to tell the points apart
constexpr double kLeastApart = 0.1;   // of the shortest distance of the two points: likewise
constexpr int kReferences = 3;        // points whose distances are asked
constexpr double kMostOfOne = 4.0;    // nats, of one distance in one frame
constexpr std::size_t kMostPairs = 200;

double middle(const std::vector<double>& values) {
  return values.empty() ? kNone : nth_smallest(values, values.size() / 2);
}

/// Both points of a pair in the frames that see both.
struct Line {
  std::vector<std::int64_t> frame;
  std::vector<Vector3d> r;           // one minus other
  std::vector<std::uint8_t> begins;  // 1: no path leads here from the sample before
  std::vector<std::int8_t> sign;     // -1: exchanged
  std::vector<double> vote;          // nats by distances, for the names as they are
};

class Search {
 public:
  Search(const PointPaths& paths, const ExchangeSearch& search)
      : F_(paths.frames),
        P_(paths.points),
        gap_(std::max<std::int64_t>(1, std::llround(std::min(search.longest_gap_s * paths.rate_hz,
                                                             static_cast<double>(paths.frames))))),
        search_(search),
        recorded_(paths.x),
        x_(paths.x) {}

  std::vector<ExchangedPair> run() {
    std::vector<ExchangedPair> found;
    if (F_ < 3 || P_ < 2) return found;
    for (const auto& [one, other] : candidates()) {
      auto pair = examine(one, other);
      if (pair.frames.empty()) continue;
      undo(pair);
      found.push_back(std::move(pair));
    }
    return found;
  }

 private:
  [[nodiscard]] Eigen::Map<const Vector3d> x(std::int64_t f, std::int64_t p) const {
    return Eigen::Map<const Vector3d>(x_ + 3 * (f * P_ + p));
  }
  [[nodiscard]] bool seen(std::int64_t f, std::int64_t p) const { return !std::isnan(x(f, p)[0]); }

  /// Undo an exchange, so that others are looked for among the true paths.
  void undo(const ExchangedPair& pair) {
    if (own_.empty()) {
      own_.assign(recorded_, recorded_ + 3 * F_ * P_);
      x_ = own_.data();
    }
    for (const auto f : pair.frames)
      for (int axis = 0; axis < 3; ++axis)
        std::swap(own_[static_cast<std::size_t>(3 * (f * P_ + pair.one) + axis)],
                  own_[static_cast<std::size_t>(3 * (f * P_ + pair.other) + axis)]);
  }

  /// Pairs that leave their paths in one frame, for each other's, those with the most evidence first.
  std::vector<std::pair<std::int64_t, std::int64_t>> candidates() {
    std::vector<std::array<std::int64_t, 2>> last(static_cast<std::size_t>(P_), {-1, -1});
    std::map<std::pair<std::int64_t, std::int64_t>, double> evidence;
    std::vector<std::int64_t> jumps;
    const double least = 0.5 * search_.least_m;
    for (std::int64_t f = 0; f < F_; ++f) {
      jumps.clear();
      for (std::int64_t p = 0; p < P_; ++p) {
        if (!seen(f, p)) continue;
        auto& [before, b] = last[static_cast<std::size_t>(p)];
        if (before >= 0 && f - before <= 2 * gap_) {
          const double u = static_cast<double>(f - b) / static_cast<double>(b - before);
          if ((x(f, p) - x(b, p) - u * (x(b, p) - x(before, p))).squaredNorm() > least * least)
            jumps.push_back(p);
        }
      }
      for (std::size_t a = 0; a < jumps.size(); ++a)
        for (std::size_t b = a + 1; b < jumps.size(); ++b) {
          const auto &i = last[static_cast<std::size_t>(jumps[a])],
                     &j = last[static_cast<std::size_t>(jumps[b])];
          if (i != j) continue;
          const double gain = gain_of(jumps[a], jumps[b], i[0], i[1], f);
          if (gain > 0.0) evidence[{jumps[a], jumps[b]}] += gain;
        }
      for (std::int64_t p = 0; p < P_; ++p)
        if (seen(f, p)) {
          auto& l = last[static_cast<std::size_t>(p)];
          l = {l[1], f};
        }
    }
    std::vector<std::pair<double, std::pair<std::int64_t, std::int64_t>>> sorted;
    for (const auto& [pair, gain] : evidence) sorted.emplace_back(-gain, pair);
    std::ranges::sort(sorted);
    if (sorted.size() > kMostPairs) sorted.resize(kMostPairs);
    std::vector<std::pair<std::int64_t, std::int64_t>> pairs;
    for (const auto& entry : sorted) pairs.push_back(entry.second);
    return pairs;
  }

  /// By how many nats an exchange in one of three frames explains both paths better; 0: it does not.
  [[nodiscard]] double gain_of(std::int64_t one, std::int64_t other, std::int64_t a, std::int64_t b,
                               std::int64_t c) const {
    const Vector3d ra = x(a, one) - x(a, other), rb = x(b, one) - x(b, other), rc = x(c, one) - x(c, other);
    const double shortest = std::sqrt(std::min({ra.squaredNorm(), rb.squaredNorm(), rc.squaredNorm()}));
    if (shortest < search_.least_m) return 0.0;
    const double u = static_cast<double>(c - b) / static_cast<double>(b - a);
    const double as_is = (rc - rb - u * (rb - ra)).norm();
    double best = HUGE_VAL;
    for (const double sa : {-1.0, 1.0})
      for (const double sc : {-1.0, 1.0})
        if (sa < 0.0 || sc < 0.0) best = std::min(best, (sc * rc - rb - u * (rb - sa * ra)).norm());
    if (!(best < kMuchBetter * as_is)) return 0.0;
    return std::log(as_is / std::max(best, kLeastScale * search_.least_m));
  }

  [[nodiscard]] Line line_of(std::int64_t one, std::int64_t other) const {
    Line line;
    for (std::int64_t f = 0; f < F_; ++f) {
      if (!seen(f, one) || !seen(f, other)) continue;
      line.begins.push_back(line.frame.empty() || f - line.frame.back() > gap_ ? 1 : 0);
      line.frame.push_back(f);
      line.r.emplace_back(x(f, one) - x(f, other));
    }
    line.sign.assign(line.frame.size(), 1);
    line.vote.assign(line.frame.size(), 0.0);
    return line;
  }

  /// What three samples in a row miss a straight path by, at even speed, as if they were a frame apart.
  static double deflection(const Line& l, std::size_t n, double before, double here, double there) {
    const auto h1 = static_cast<double>(l.frame[n - 1] - l.frame[n - 2]),
               h2 = static_cast<double>(l.frame[n] - l.frame[n - 1]);
    return (there * l.r[n] - here * l.r[n - 1] - h2 / h1 * (here * l.r[n - 1] - before * l.r[n - 2])).norm() /
           (0.5 * h2 * (h1 + h2));
  }
  static bool deflections(const Line& l, std::size_t n) {
    return n >= 2 && l.begins[n] == 0 && l.begins[n - 1] == 0;
  }

  /// What the line's path usually misses a straight one by, whatever its signs.
  [[nodiscard]] double usual_deflection(const Line& l) const {
    std::vector<double> values;
    for (std::size_t n = 2; n < l.r.size(); ++n) {
      if (!deflections(l, n)) continue;
      double best = HUGE_VAL;
      for (const double a : {-1.0, 1.0})
        for (const double c : {-1.0, 1.0}) best = std::min(best, deflection(l, n, a, 1.0, c));
      values.push_back(best);
    }
    const double usual = values.empty() ? 0.0 : middle(values);
    return std::max(1.5 * usual, kLeastScale * search_.least_m);
  }

  /// The signs of least cost: bends of the path, votes of distances, and a little for each turn.
  void find_signs(Line& l, double scale) const {
    const std::size_t N = l.r.size();
    // State: 2 * (sign before is -) + (sign here is -).
    std::vector<std::array<std::uint8_t, 4>> came(N);
    std::array<double, 4> cost{}, next{};
    const auto sign = [](int bit) { return bit != 0 ? -1.0 : 1.0; };
    for (std::size_t n = 0; n < N; ++n) {
      next.fill(HUGE_VAL);
      for (int from = 0; from < 4; ++from)
        for (int here = 0; here < 2; ++here) {
          if (n == 0 && from != 0) continue;
          const int before = from & 1, to = 2 * before + here;
          double c = cost[static_cast<std::size_t>(from)] + (here != 0 ? 1.0 : -1.0) * 0.5 * l.vote[n];
          if (n > 0 && l.begins[n] == 0 && here != before) c += kTurnCost;
          if (deflections(l, n)) {
            const double b = deflection(l, n, sign(from >> 1), sign(before), sign(here)) / scale;
            c += std::log1p(b * b);
          } else if (n > 0 && l.begins[n] == 0) {
            // Second sample of a path: no speed is known yet.
            const auto h = static_cast<double>(l.frame[n] - l.frame[n - 1]);
            const double step = (sign(here) * l.r[n] - sign(before) * l.r[n - 1]).norm() / (h * 4.0 * scale);
            c += 0.5 * std::log1p(step * step);
          }
          if (c < next[static_cast<std::size_t>(to)]) {
            next[static_cast<std::size_t>(to)] = c;
            came[n][static_cast<std::size_t>(to)] = static_cast<std::uint8_t>(from);
          }
        }
      cost = next;
    }
    auto state = static_cast<std::size_t>(std::ranges::min_element(cost) - cost.begin());
    for (std::size_t n = N; n-- > 0;) {
      l.sign[n] = (state & 1U) != 0 ? -1 : 1;
      state = came[n][state];
    }
  }

  /// In each path by itself the signs of the more frames are right, unless distances have voted.
  static void orient_by_number(Line& l) {
    for (std::size_t begin = 0; begin < l.sign.size();) {
      std::size_t end = begin + 1;
      while (end < l.sign.size() && l.begins[end] == 0) ++end;
      std::int64_t sum = 0;
      for (std::size_t n = begin; n < end; ++n) sum += l.sign[n];
      if (sum < 0)
        for (std::size_t n = begin; n < end; ++n) l.sign[n] = static_cast<std::int8_t>(-l.sign[n]);
      begin = end;
    }
  }

  struct Reference {
    double score = 0.0;  // how well it tells the two apart
    std::int64_t point = -1;
    double of_one = 0.0, of_other = 0.0;  // usual distances, m
    double spread_one = 0.0, spread_other = 0.0;
  };

  /// Distances of a point from the two, under their names by the signs, in the frames that see it.
  void distances(const Line& l, std::int64_t one, std::int64_t other, std::int64_t k, std::vector<double>& d1,
                 std::vector<double>& d2) const {
    d1.clear();
    d2.clear();
    for (std::size_t n = 0; n < l.frame.size(); ++n) {
      if (!seen(l.frame[n], k)) continue;
      const double a = (x(l.frame[n], one) - x(l.frame[n], k)).norm(),
                   b = (x(l.frame[n], other) - x(l.frame[n], k)).norm();
      d1.push_back(l.sign[n] > 0 ? a : b);
      d2.push_back(l.sign[n] > 0 ? b : a);
    }
  }

  static std::pair<double, double> centre_and_spread(std::vector<double>& d) {
    const double centre = middle(d);
    for (double& v : d) v = std::abs(v - centre);
    return {centre, 1.4826 * middle(d)};
  }

  /// Points whose distances from the two differ by far more than they change.
  [[nodiscard]] std::vector<Reference> references(const Line& l, std::int64_t one, std::int64_t other) const {
    std::vector<Reference> found;
    std::vector<double> d1, d2;
    for (std::int64_t k = 0; k < P_; ++k) {
      if (k == one || k == other) continue;
      distances(l, one, other, k, d1, d2);
      if (d1.size() < 3 || 2 * d1.size() < l.frame.size()) continue;
      Reference r{.point = k};
      std::tie(r.of_one, r.spread_one) = centre_and_spread(d1);
      std::tie(r.of_other, r.spread_other) = centre_and_spread(d2);
      const double floor = kLeastScale * search_.least_m;
      r.spread_one = std::max(r.spread_one, floor);
      r.spread_other = std::max(r.spread_other, floor);
      const double apart = std::abs(r.of_one - r.of_other);
      r.score = apart / (r.spread_one + r.spread_other);
      if (r.score > kApart && apart > kLeastApart * search_.least_m) found.push_back(r);
    }
    std::ranges::sort(found, [](const Reference& a, const Reference& b) {
      return a.score != b.score ? a.score > b.score : a.point < b.point;
    });
    if (found.size() > kReferences) found.resize(kReferences);
    return found;
  }

  void vote(Line& l, std::int64_t one, std::int64_t other, const std::vector<Reference>& references) const {
    const auto cost = [](double d, double centre, double spread) {
      return std::log1p((d - centre) * (d - centre) / (spread * spread));
    };
    std::ranges::fill(l.vote, 0.0);
    for (std::size_t n = 0; n < l.frame.size(); ++n)
      for (const Reference& r : references) {
        const std::int64_t f = l.frame[n];
        if (!seen(f, r.point)) continue;
        const double a = (x(f, one) - x(f, r.point)).norm(), b = (x(f, other) - x(f, r.point)).norm();
        l.vote[n] += std::clamp(cost(b, r.of_one, r.spread_one) + cost(a, r.of_other, r.spread_other) -
                                    cost(a, r.of_one, r.spread_one) - cost(b, r.of_other, r.spread_other),
                                -kMostOfOne, kMostOfOne);
      }
  }

  /// What the path of one point through three samples misses a straight one by, with its names by the signs
  /// (or as recorded).
  [[nodiscard]] double deflection_of(const Line& l, std::size_t n, std::int64_t one, std::int64_t other,
                                     bool by_signs) const {
    const auto place = [&](std::size_t k) {
      return Vector3d(x(l.frame[k], by_signs && l.sign[k] < 0 ? other : one));
    };
    const auto h1 = static_cast<double>(l.frame[n - 1] - l.frame[n - 2]),
               h2 = static_cast<double>(l.frame[n] - l.frame[n - 1]);
    return (place(n) - place(n - 1) - h2 / h1 * (place(n - 1) - place(n - 2))).norm();
  }

  /// How many times better both points continue their paths around a turn of the signs between n - 1 and n;
  /// 0: not much better, or not each of them.
  [[nodiscard]] double ratio_at(const Line& l, std::size_t n, std::int64_t one, std::int64_t other) const {
    double as_is = 0.0, signed_ = 0.0;
    std::array<double, 2> own_as_is{}, own_signed{};
    for (std::size_t k = n; k <= n + 1 && k < l.sign.size(); ++k) {
      if (!deflections(l, k) || (l.sign[k] == l.sign[k - 1] && l.sign[k - 1] == l.sign[k - 2])) continue;
      const std::array<std::pair<std::int64_t, std::int64_t>, 2> both{{{one, other}, {other, one}}};
      for (std::size_t i = 0; i < 2; ++i) {
        own_as_is[i] += deflection_of(l, k, both[i].first, both[i].second, false);
        own_signed[i] += deflection_of(l, k, both[i].first, both[i].second, true);
      }
    }
    for (std::size_t i = 0; i < 2; ++i) {
      if (!(own_signed[i] < kBetterEach * own_as_is[i])) return 0.0;
      as_is += own_as_is[i];
      signed_ += own_signed[i];
    }
    if (!(signed_ < kMuchBetter * as_is)) return 0.0;
    return as_is / std::max(signed_, 1e-3 * kLeastScale * search_.least_m);
  }

  /// Cost of the path through the samples around a stretch [begin, end), by given signs.
  double stretch_cost(const Line& l, std::size_t begin, std::size_t end, double scale, bool as_is) const {
    double cost = 0.0;
    for (std::size_t n = begin; n < std::min(end + 2, l.sign.size()); ++n) {
      const auto s = [&](std::size_t k) { return as_is && k >= begin && k < end ? -l.sign[k] : l.sign[k]; };
      if (!deflections(l, n)) continue;
      const double b = deflection(l, n, s(n - 2), s(n - 1), s(n)) / scale;
      cost += std::log1p(b * b);
    }
    return cost;
  }

  /// Stretches that do not make each of both paths much better are taken back; the least ratio of the others.
  double keep_what_explains(Line& l, std::int64_t one, std::int64_t other, double scale, bool& ends) const {
    double least = HUGE_VAL;
    ends = true;
    bool changed = true;
    while (changed) {
      changed = false;
      least = HUGE_VAL;
      ends = true;
      for (std::size_t begin = 0; begin < l.sign.size();) {
        if (l.sign[begin] > 0) {
          ++begin;
          continue;
        }
        std::size_t end = begin + 1;
        while (end < l.sign.size() && l.sign[end] < 0 && l.begins[end] == 0) ++end;
        const bool left = l.begins[begin] == 0, right = end < l.sign.size() && l.begins[end] == 0;
        double ratio = HUGE_VAL;
        if (left) ratio = std::min(ratio, ratio_at(l, begin, one, other));
        if (right) ratio = std::min(ratio, ratio_at(l, end, one, other));
        // A path of its own, exchanged as a whole: distances alone have said so.
        const bool apart = !left && !right;
        double votes = 0.0;
        for (std::size_t n = begin; n < end; ++n) votes -= l.vote[n];
        std::vector<double> lengths;
        for (std::size_t n = begin; n < end; ++n) lengths.push_back(l.r[n].norm());
        const bool stated = middle(lengths) > search_.least_m;
        const double gain = stretch_cost(l, begin, end, scale, true) -
                            stretch_cost(l, begin, end, scale, false) + std::min(votes, 0.5 * kLeastGain);
        const bool explains = apart ? votes > 2.0 * kLeastGain : ratio > 0.0 && gain > kLeastGain;
        if (!stated || !explains) {
          for (std::size_t n = begin; n < end; ++n) l.sign[n] = 1;
          changed = true;
        } else if (!apart) {
          least = std::min(least, ratio);
          ends = ends && left && right;
        }
        begin = end;
      }
    }
    return least;
  }

  /// Which side the distances that are known beforehand speak for: 1, -1, or 0 where they do not tell.
  [[nodiscard]] int side_by_known_distances(const Line& l, std::int64_t one, std::int64_t other) const {
    if (!search_.distance) return 0;
    double right = 0.0, wrong = 0.0;
    std::vector<double> d1, d2;
    for (std::int64_t k = 0; k < P_; ++k) {
      if (k == one || k == other) continue;
      const double should_one = search_.distance(one, k, other),
                   should_other = search_.distance(other, k, one);
      if (std::isnan(should_one) || std::isnan(should_other)) continue;
      distances(l, one, other, k, d1, d2);
      if (d1.size() < 3) continue;
      const double a = middle(d1), b = middle(d2);
      right += std::abs(a - should_one) + std::abs(b - should_other);
      wrong += std::abs(b - should_one) + std::abs(a - should_other);
    }
    const double least = kLeastApart * search_.least_m;
    if (right < 0.5 * wrong && wrong - right > least) return 1;
    if (wrong < 0.5 * right && right - wrong > least) return -1;
    return 0;
  }

  ExchangedPair examine(std::int64_t one, std::int64_t other) const {
    ExchangedPair pair{.one = one, .other = other};
    Line l = line_of(one, other);
    if (l.frame.size() < 3) return pair;
    const double scale = usual_deflection(l);
    find_signs(l, scale);
    orient_by_number(l);
    if (std::ranges::none_of(l.sign, [](auto s) { return s < 0; })) return pair;
    // Distances, learnt by these signs, decide where paths do not, and tie paths together over gaps.
    vote(l, one, other, references(l, one, other));
    find_signs(l, scale);
    if (std::ranges::all_of(l.vote, [](double v) { return v == 0.0; })) orient_by_number(l);
    auto exchanged = std::ranges::count(l.sign, std::int8_t{-1});
    if (2 * exchanged > std::ssize(l.sign)) {
      for (auto& s : l.sign) s = static_cast<std::int8_t>(-s);
      for (auto& v : l.vote) v = -v;
    }
    pair.ratio = keep_what_explains(l, one, other, scale, pair.ends);
    exchanged = std::ranges::count(l.sign, std::int8_t{-1});
    if (exchanged == 0) return pair;
    pair.side_known = static_cast<double>(exchanged) < kFewer * static_cast<double>(l.sign.size());
    if (const int side = side_by_known_distances(l, one, other); side != 0) {
      pair.side_known = pair.stated_by_distances = true;
      if (side < 0)
        for (auto& s : l.sign) s = static_cast<std::int8_t>(-s);
    }
    std::vector<double> apart;
    for (std::size_t n = 0; n < l.sign.size(); ++n) {
      if (l.sign[n] > 0) continue;
      pair.frames.push_back(l.frame[n]);
      apart.push_back(l.r[n].norm());
    }
    pair.apart_m = apart.empty() ? 0.0 : middle(apart);
    return pair;
  }

  std::int64_t F_, P_, gap_;
  const ExchangeSearch& search_;
  const double* recorded_;
  const double* x_;
  std::vector<double> own_;  // the points with exchanges undone; empty while there are none
};

}  // namespace

std::vector<ExchangedPair> find_exchanges(const PointPaths& paths, const ExchangeSearch& search) {
  return Search(paths, search).run();
}

}  // namespace kinemark::math
