// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/judge.h"

#include <fmt/core.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "kinemark/core/index.h"
#include "kinemark/core/missing.h"
#include "kinemark/core/text.h"
#include "kinemark/data/name_index.h"
#include "kinemark/stages/motion/foundations/internal/body_parts.h"
#include "kinemark/stages/motion/foundations/internal/hypotheses.h"
#include "kinemark/stages/motion/foundations/standing_body.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kHalf = 3;        // frames on both sides that are averaged
constexpr std::size_t kFewest = 6;       // markers that a body can be judged by
constexpr double kRival = 6.0;           // explanations this much less likely are named
constexpr double kLeastShift_m = 0.025;  // smaller ones are how markers are placed
constexpr double kStated_m = 0.050;      // FoundationJudgement::seen_at_50_mm
constexpr double kMirrored = 30.0;       // least gain of a mirror image; bodies' images gain 118 and more
constexpr int kMirrorFrames = 3;         // of a movement

/// Where the body's markers are in a recording.
std::vector<std::int64_t> columns_of(const StandingBody& body, const data::Trajectories& recording) {
  const data::NameIndex index(recording.names);
  std::vector<std::int64_t> out;
  for (const auto& marker : body.markers) out.push_back(index.find(marker.name));
  return out;
}

/// Means about a frame.
internal::SeenFrame frame_at(const data::Trajectories& recording, const std::vector<std::int64_t>& columns,
                             std::int64_t frame, std::int64_t half, double sd) {
  internal::SeenFrame out;
  const auto count = static_cast<Eigen::Index>(columns.size());
  out.x = Eigen::Matrix3Xd::Constant(3, count, kNaN);
  out.sd = Eigen::VectorXd::Constant(count, sd);
  for (std::size_t m = 0; m < columns.size(); ++m) {
    if (columns[m] < 0) continue;
    Vector3d sum = Vector3d::Zero();
    double seen = 0.0;
    for (std::int64_t f = std::max<std::int64_t>(0, frame - half);
         f <= std::min(recording.frames() - 1, frame + half); ++f)
      if (recording.present(f, columns[m])) {
        sum += recording.x(f, columns[m]);
        seen += 1.0;
      }
    if (seen > 0.0) out.x.col(static_cast<Eigen::Index>(m)) = sum / seen;
  }
  return out;
}

std::int64_t seen_at(const data::Trajectories& recording, const std::vector<std::int64_t>& columns,
                     std::int64_t f) {
  return std::ranges::count_if(columns, [&](std::int64_t c) { return c >= 0 && recording.present(f, c); });
}

/// The frame whose markers move least, among those that show most.
std::int64_t stillest(const data::Trajectories& recording, const std::vector<std::int64_t>& columns) {
  std::int64_t most = 0;
  for (std::int64_t f = 0; f < recording.frames(); ++f) most = std::max(most, seen_at(recording, columns, f));
  std::int64_t best = -1;
  double least = 0.0;
  for (std::int64_t f = 0; f < recording.frames(); ++f) {
    if (seen_at(recording, columns, f) < most) continue;
    const std::int64_t a = std::max<std::int64_t>(0, f - kHalf),
                       b = std::min(recording.frames() - 1, f + kHalf);
    double moved = 0.0, both = 0.0;
    for (const std::int64_t c : columns)
      if (c >= 0 && recording.present(a, c) && recording.present(b, c)) {
        moved += (recording.x(b, c) - recording.x(a, c)).norm();
        both += 1.0;
      }
    // At an end the window is shorter; what has no neighbours is taken only where nothing else is.
    moved = both > 0.0 && b > a ? moved / both * static_cast<double>(2 * kHalf) / static_cast<double>(b - a)
                                : 1e6;
    if (best < 0 || moved < least) {
      best = f;
      least = moved;
    }
  }
  return most > 0 ? best : -1;
}

/// Frames of a movement that show most markers, evenly picked.
std::vector<internal::SeenFrame> frames_of(const StandingBody& body, const data::Trajectories& movement,
                                           const FoundationOptions& options) {
  const auto columns = columns_of(body, movement);
  std::vector<std::int64_t> counts;
  for (std::int64_t f = 0; f < movement.frames(); ++f) counts.push_back(seen_at(movement, columns, f));
  std::vector<internal::SeenFrame> out;
  if (counts.empty()) return out;
  auto sorted = counts;
  std::ranges::sort(sorted);
  const std::int64_t enough = sorted[sorted.size() * 7 / 10];
  if (enough < static_cast<std::int64_t>(kFewest)) return out;
  std::vector<std::int64_t> full;
  for (std::int64_t f = 0; f < movement.frames(); ++f)
    if (counts[static_cast<std::size_t>(f)] >= enough) full.push_back(f);
  const auto n = static_cast<std::size_t>(options.moving_frames);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = (2 * k + 1) * full.size() / (2 * n);
    out.push_back(frame_at(movement, columns, full[std::min(i, full.size() - 1)], 0, options.moving_sd_m));
    for (std::size_t m = 0; m < body.markers.size(); ++m)
      out.back().sd[static_cast<Eigen::Index>(m)] =
          std::hypot(options.moving_sd_m, body.markers[m].spread.by_posture.norm() / std::sqrt(3.0));
  }
  return out;
}

/// Most of these frames show the mirror image of a body.
bool are_mirrored(const StandingBody& body, const internal::SharedPrior& prior,
                  const std::vector<internal::SeenFrame>& frames) {
  const auto mirrored = std::ranges::count_if(frames, [&](const internal::SeenFrame& frame) {
    return internal::explain_mirrored(body, prior, frame) >= kMirrored;
  });
  return 2 * mirrored > std::ssize(frames);
}

/// What pelvis, legs, trunk and head tell of a recording's handedness; the whole body where these are too
/// few.
StandingBody without_arms(const StandingBody& body) {
  StandingBody out = body;
  std::erase_if(out.markers, [](const StandingBody::Marker& marker) {
    const auto landmark = landmark_of(marker.name);
    return landmark && (landmark->part == BodyPart::upper_arm || landmark->part == BodyPart::forearm ||
                        landmark->part == BodyPart::hand);
  });
  if (out.markers.size() < kFewest) return body;
  for (auto& marker : out.markers) marker.mirror = -1;
  internal::pair_markers(out);
  return out;
}

/// Shoulders, arms and heads move on the trunk by more than a rigid body tells: beside a movement, a single
/// marker is accused on pelvis and legs alone.
bool keeps_its_place(const StandingBody::Marker& marker) {
  const auto landmark = landmark_of(marker.name);
  if (!landmark) return false;
  return landmark->part == BodyPart::pelvis || landmark->part == BodyPart::thigh ||
         landmark->part == BodyPart::shank || landmark->part == BodyPart::foot;
}

/// Two of one cluster, whose names say no more than the segment: without a second recording nobody knows
/// which of them is which, and the other leg's cluster may be counted otherwise.
bool are_of_one_cluster(const StandingBody::Marker& a, const StandingBody::Marker& b) {
  const auto one = landmark_of(a.name), other = landmark_of(b.name);
  return one && other && one->part == other->part && one->side == other->side &&
         one->x_in_part == other->x_in_part;
}

/// What movements tell of the body, less sure by how far markers lie from one recording to the next.
internal::SharedPrior prior_with(const StandingBody& body, const internal::SharedPrior& prior,
                                 const std::vector<internal::SeenFrame>& frames, double between_sd_m) {
  internal::SharedPrior known = internal::learn_shared(body, prior, frames);
  Eigen::MatrixXd covariance = known.information.inverse();
  const Eigen::Index sites = covariance.rows() - static_cast<Eigen::Index>(3 * body.markers.size());
  const Eigen::Index joints = sites - static_cast<Eigen::Index>(3 * body.segments.size());
  for (std::size_t s = 0; s < body.segments.size(); ++s) {
    const double sd = body.segments[s].joint_by_posture;
    covariance.diagonal().segment<3>(joints + static_cast<Eigen::Index>(3 * s)).array() += sd * sd;
  }
  for (std::size_t m = 0; m < body.markers.size(); ++m) {
    const Vector3d sd = body.markers[m].spread.by_posture;
    covariance.diagonal().segment<3>(sites + static_cast<Eigen::Index>(3 * m)).array() +=
        sd.array().square() + between_sd_m * between_sd_m;
  }
  known.information = covariance.inverse();
  known.information = (0.5 * (known.information + known.information.transpose())).eval();
  return known;
}

std::string words_of(const StandingBody& body, const internal::Hypothesis& h) {
  const std::string& first = body.markers[at(h.first)].name;
  if (h.second < 0) return fmt::format("{} {:.0f} mm off", first, 1e3 * h.shift.norm());
  return fmt::format("{} and {} exchanged", first, body.markers[at(h.second)].name);
}

/// What a pair's exchange, or one marker elsewhere (second -1), scores in frames of one recording: mean over
/// those that have it.
double mean_score(const StandingBody& body, const internal::SharedPrior& prior,
                  const std::vector<internal::SeenFrame>& frames, int first, int second) {
  double sum = 0.0, count = 0.0;
  for (const auto& frame : frames) {
    if (!frame.x.col(first).allFinite() || (second >= 0 && !frame.x.col(second).allFinite())) continue;
    sum += second < 0 ? internal::explain_shift(body, prior, frame, first).score
                      : internal::explain_exchange(body, prior, frame, first, second).score;
    count += 1.0;
  }
  return count > 0.0 ? sum / count : -kRival;
}

/// Spread of the length of a shift.
double length_sd(const Vector3d& shift, const Vector3d& sd) {
  const double length = shift.norm();
  return length > 0.0 ? shift.cwiseProduct(sd).norm() / length : sd.norm();
}

}  // namespace

Status FoundationOptions::check() const {
  for (const double sd : {still_sd_m, moving_sd_m, between_sd_m})
    if (!(sd > 0.0 && sd < 1.0))
      return fail(Code::usage, fmt::format("a spread of {} m; need above 0, below 1", sd));
  for (const double score : {least_score, least_score_beside, least_fall, least_fall_beside})
    if (!(score > 0.0)) return fail(Code::usage, fmt::format("a score of {}; need a number above 0", score));
  if (moving_frames < 1 || most_findings < 1)
    return fail(Code::usage,
                fmt::format("{} frames and {} findings; need at least 1", moving_frames, most_findings));
  return {};
}

Result<FoundationJudgement> judge_foundation(const StandingBody& body, const data::Trajectories& still,
                                             std::span<const data::Trajectories* const> movements,
                                             const FoundationOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  FoundationJudgement out;
  const auto columns = columns_of(body, still);
  const std::int64_t frame_idx = stillest(still, columns);
  if (frame_idx < 0) return out;
  internal::SeenFrame frame = frame_at(still, columns, frame_idx, kHalf, options.still_sd_m);
  std::set<int> segments;
  std::vector<std::string> judged;
  for (std::size_t m = 0; m < body.markers.size(); ++m)
    if (frame.x.col(static_cast<Eigen::Index>(m)).allFinite()) {
      judged.push_back(still.names[static_cast<std::size_t>(columns[m])]);
      segments.insert(body.markers[m].segment);
    }
  if (judged.size() < kFewest || segments.size() < 2) return out;
  out.judged = std::move(judged);
  out.frame = frame_idx;

  internal::SharedPrior prior = internal::prior_of(body);
  out.mirrored = internal::explain_mirrored(body, prior, frame) >= kMirrored;
  if (out.mirrored) frame = internal::mirror_image(std::move(frame));
  const internal::SeenFrame seen = frame;
  std::vector<internal::SeenFrame> moving;
  for (const auto* movement : movements) {
    auto frames = frames_of(body, *movement, options);
    if (are_mirrored(body, prior, frames))
      for (auto& one : frames) one = internal::mirror_image(std::move(one));
    out.movements += frames.empty() ? 0 : 1;
    moving.insert(moving.end(), frames.begin(), frames.end());
  }
  if (!moving.empty()) prior = prior_with(body, prior, moving, options.between_sd_m);

  const auto of_singles = moving.empty()
                              ? internal::Least{options.least_score, options.least_fall}
                              : internal::Least{options.least_score_beside, options.least_fall_beside};
  const auto name_of = [&](int m) { return still.names[static_cast<std::size_t>(columns[at(m)])]; };
  struct Single {
    int marker;
    double score;
    internal::SeenFrame before;  // as it was while the marker took part
  };
  std::vector<Single> singles;
  for (int k = 0; k < options.most_findings; ++k) {
    const auto explanations = internal::explain(body, prior, frame);
    if (explanations.empty()) break;
    auto best = explanations.front();
    const bool single_marker = best.second < 0;
    if (best.score < (single_marker ? of_singles.score : options.least_score)) break;
    if (single_marker && best.gain * best.misfit < of_singles.fall) break;
    if (single_marker && best.shift.norm() < kLeastShift_m) {
      // How markers are placed: nobody is accused, and what lies farther off is still asked for.
      frame.x.col(best.first).setConstant(kNaN);
      continue;
    }
    std::vector<std::string> rivals;
    for (std::size_t i = 1; i < explanations.size(); ++i)
      if (explanations[i].score > best.score - kRival) rivals.push_back(words_of(body, explanations[i]));
    // Two markers that both lie elsewhere may be one exchange.
    const auto single = std::ranges::find_if(singles, [&](const Single& one) {
      if (best.second >= 0) return false;
      const auto h = internal::explain_exchange(body, prior, one.before, std::min(one.marker, best.first),
                                                std::max(one.marker, best.first));
      if (h.score <= std::max(one.score, best.score)) return false;
      best = h;
      return true;
    });
    if (single != singles.end()) {
      frame = single->before;
      std::erase_if(out.findings, [&](const FoundationFinding& f) {
        return f.marker == name_of(best.first) && f.partner.empty();
      });
      singles.erase(single);
      rivals.clear();
    }
    FoundationFinding finding{.marker = name_of(best.first),
                              .partner = best.second < 0 ? std::string() : name_of(best.second),
                              .shift_m = best.shift,
                              .shift_sd_m = best.shift_sd,
                              .score = best.score,
                              .rivals = std::move(rivals)};
    out.findings.push_back(std::move(finding));
    if (best.second < 0) {
      singles.push_back({best.first, best.score, frame});
      frame.x.col(best.first).setConstant(kNaN);
    } else {
      frame.x.col(best.first).swap(frame.x.col(best.second));
    }
  }
  if (!moving.empty() && !out.findings.empty()) {
    const auto alone = judge_foundation(body, still, {}, options);
    if (!alone) return std::unexpected(alone.error());
    for (auto& finding : out.findings) {
      finding.by_movement = std::ranges::none_of(alone->findings, [&](const FoundationFinding& other) {
        return other.marker == finding.marker && other.partner == finding.partner;
      });
      if (!finding.by_movement) continue;
      // Each of the two recordings by itself: which of them is better without the mistake?
      const auto marker_of = [&](const std::string& name) {
        const auto column = std::ranges::find(still.names, name) - still.names.begin();
        return name.empty() ? -1 : static_cast<int>(std::ranges::find(columns, column) - columns.begin());
      };
      const int a = marker_of(finding.marker), b = marker_of(finding.partner);
      if (std::ranges::none_of(moving, [&](const auto& one) {
            return one.x.col(a).allFinite() && (b < 0 || one.x.col(b).allFinite());
          }))
        continue;
      const auto by_names = internal::prior_of(body);
      const double more = mean_score(body, by_names, {seen}, a, b) - mean_score(body, by_names, moving, a, b);
      finding.where = more >= kRival    ? MistakeIn::still
                      : more <= -kRival ? MistakeIn::movement
                                        : MistakeIn::either;
    }
  }
  out.seen_at_50_mm = internal::share_seen(body, prior, frame, kStated_m, of_singles);
  return out;
}

Result<std::vector<FoundationFinding>> judge_movement(const StandingBody& body,
                                                      const data::Trajectories& movement,
                                                      const FoundationOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  std::vector<FoundationFinding> out;
  auto frames = frames_of(body, movement, options);
  const auto prior = internal::prior_of(body);
  if (are_mirrored(body, prior, frames))
    for (auto& frame : frames) frame = internal::mirror_image(std::move(frame));
  while (!frames.empty() && std::ssize(out) < options.most_findings) {
    std::set<std::pair<int, int>> pairs;
    for (const auto* frame : {&frames.front(), &frames[frames.size() / 2]})
      for (const auto& h : internal::explain(body, prior, *frame))
        if (h.second >= 0 && h.score > options.least_score && keeps_its_place(body.markers[at(h.first)]) &&
            keeps_its_place(body.markers[at(h.second)]) &&
            !are_of_one_cluster(body.markers[at(h.first)], body.markers[at(h.second)]))
          pairs.emplace(h.first, h.second);
    FoundationFinding best;
    best.score = options.least_score;
    std::pair<int, int> exchanged{-1, -1};
    for (const auto& [first, second] : pairs)
      if (const double score = mean_score(body, prior, frames, first, second); score >= best.score) {
        best.score = score;
        exchanged = {first, second};
      }
    if (exchanged.first < 0) break;
    best.marker = body.markers[at(exchanged.first)].name;
    best.partner = body.markers[at(exchanged.second)].name;
    out.push_back(std::move(best));
    for (auto& frame : frames) frame.x.col(exchanged.first).swap(frame.x.col(exchanged.second));
  }
  return out;
}

std::optional<double> score_exchange(const StandingBody& body, const data::Trajectories& movement,
                                     const std::string& one, const std::string& other,
                                     const FoundationOptions& options) {
  const auto index_of = [&](const std::string& name) {
    const auto found = std::ranges::find(body.markers, name, &StandingBody::Marker::name);
    return found == body.markers.end() ? -1 : static_cast<int>(found - body.markers.begin());
  };
  const int first = index_of(one), second = index_of(other);
  if (first < 0 || second < 0 || are_of_one_cluster(body.markers[at(first)], body.markers[at(second)]))
    return std::nullopt;
  auto frames = frames_of(body, movement, options);
  const auto prior = internal::prior_of(body);
  if (are_mirrored(body, prior, frames))
    for (auto& frame : frames) frame = internal::mirror_image(std::move(frame));
  if (std::ranges::none_of(frames, [&](const auto& frame) {
        return frame.x.col(first).allFinite() && frame.x.col(second).allFinite();
      }))
    return std::nullopt;
  return mean_score(body, prior, frames, first, second);
}

bool shows_mirrored_body(const StandingBody& whole, const data::Trajectories& recording) {
  const StandingBody body = without_arms(whole);
  const auto frames = body.markers.empty() ? std::vector<internal::SeenFrame>{}
                                           : frames_of(body, recording, {.moving_frames = kMirrorFrames});
  return !frames.empty() && are_mirrored(body, internal::prior_of(body), frames);
}

std::string describe_mirrored(const std::string& recording) {
  return fmt::format(
      "{} shows a mirrored body: an axis of the recording is negated or its frame is left-handed, "
      "or all names of left and right are exchanged",
      recording);
}

std::string describe(const FoundationFinding& finding, const std::string& recording) {
  std::string out;
  const bool either = finding.where == MistakeIn::either, moving = finding.where == MistakeIn::movement;
  const std::string holder = moving ? "the movement beside " + recording : recording;
  if (!finding.partner.empty()) {
    out = fmt::format("{} and {} are exchanged in {}", finding.marker, finding.partner, holder);
    if (either) out += " or in the movement beside it: in which of the two cannot be known";
  } else {
    // What lies elsewhere in the movement is seen from the still recording.
    const Vector3d shift = moving ? Vector3d(-finding.shift_m) : finding.shift_m;
    std::vector<std::string> parts;
    constexpr const char* kWords[3][2] = {
        {"back", "forward"}, {"down", "up"}, {"to the left", "to the right"}};
    for (int a = 0; a < 3; ++a)
      if (std::abs(shift[a]) >= 0.3 * shift.cwiseAbs().maxCoeff())
        parts.push_back(
            fmt::format("{:.0f} mm {}", 1e3 * std::abs(shift[a]), kWords[a][shift[a] > 0.0 ? 1 : 0]));
    out = fmt::format("{} lies {:.0f} mm (SD {:.0f}) {} {}: {}", finding.marker, 1e3 * shift.norm(),
                      1e3 * length_sd(shift, finding.shift_sd_m),
                      either ? "from where the movement has it in" : "from where it should in", holder,
                      join(parts));
    if (either) out += "; in which of the two it is off cannot be known";
  }
  if (finding.by_movement && finding.where == MistakeIn::still) out += ", as the movement shows it";
  if (!finding.rivals.empty()) out += fmt::format(" (or: {})", join(finding.rivals));
  return out;
}

}  // namespace kinemark::motion
