// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/finding.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "kinemark/data/frame_list.h"

namespace kinemark::data {
namespace {

constexpr std::array<std::string_view, 16> kKinds{
    "zero",        "stuck",       "duplicated frame", "clock jump", "unit slip",    "spike",
    "swap within", "label swap",  "marker slip",      "joint slip", "loose marker", "unexplained",
    "at limit",    "not settled", "flagged",          "outlier"};

constexpr std::string_view kFromWhere = "from where the model and the frames beside have it";

/// "marker 'A'", or "all markers".
std::string who(const Finding& f) {
  return f.subject.empty() ? std::string("all markers") : fmt::format("marker '{}'", f.subject);
}

/// A verb after who(): "holds" for one, "hold" for all.
std::string_view verb(const Finding& f, std::string_view of_one, std::string_view of_all) {
  return f.subject.empty() ? of_all : of_one;
}

/// " by 3.2 mm", " by 3.2 mm (SD 0.4)", or nothing where the size is not known.
std::string millimetres(const Finding& f, std::string_view before, std::string_view after = "") {
  if (!std::isfinite(f.size)) return "";
  const auto sd = std::isfinite(f.size_sd) ? fmt::format(" (SD {:.1f})", 1e3 * f.size_sd) : std::string();
  return fmt::format(" {}{:.1f} mm{}{}", before, 1e3 * f.size, sd, after);
}

/// " in frame 3 (0.03 s)", " in frames 3 to 9 (0.03 to 0.09 s)", or nothing.
std::string when(const Finding& f, const TimeBase& time) {
  if (f.first_frame < 0) return "";
  if (!f.frames.empty())
    return fmt::format(" in {} frames: {} ({:.6g} to {:.6g} s)", f.frames.size(),
                       words_of_frames(f.frames, time), time.time_s(f.first_frame),
                       time.time_s(f.last_frame));
  if (f.first_frame == f.last_frame)
    return fmt::format(" in frame {} ({:.6g} s)", time.number(f.first_frame), time.time_s(f.first_frame));
  return fmt::format(" in frames {} to {} ({:.6g} to {:.6g} s)", time.number(f.first_frame),
                     time.number(f.last_frame), time.time_s(f.first_frame), time.time_s(f.last_frame));
}

/// " at about 2.31 s", or nothing.
std::string about_when(const Finding& f, const TimeBase& time) {
  return f.first_frame < 0 ? std::string() : fmt::format(" at about {:.2f} s", time.time_s(f.first_frame));
}

std::string which_segment(const Finding& f) {
  return f.partner.empty() ? std::string("its segment") : fmt::format("'{}'", f.partner);
}

/// " by 3 frames", or nothing.
std::string by_frames(const Finding& f) {
  return std::isfinite(f.size) ? fmt::format(" by {:.3g} frames", f.size) : std::string();
}

std::string unit_slip(const Finding& f) {
  const auto is = fmt::format("{} {}", who(f), verb(f, "is", "are"));
  if (!std::isfinite(f.size) || f.size <= 0.0) return is + " in another unit";
  return f.size > 1.0 ? fmt::format("{} {:.4g} times too large", is, f.size)
                      : fmt::format("{} {:.4g} times too small", is, 1.0 / f.size);
}

/// "12 of 500 frames", "some frames".
std::string count_of_frames(const Finding& f, const TimeBase& time) {
  return std::isfinite(f.size) ? fmt::format("{:.0f} of {} frames", f.size, time.frames)
                               : std::string("some frames");
}

std::string core_of(const Finding& f, const TimeBase& time) {
  switch (f.kind) {
    case FindingKind::zero:
      return fmt::format("{} {} exactly at the origin{}", who(f), verb(f, "is", "are"), when(f, time));
    case FindingKind::stuck:
      return fmt::format("{} {} one value digit by digit{}", who(f), verb(f, "holds", "hold"), when(f, time));
    case FindingKind::duplicated_frame:
      return fmt::format("{} {} the frame before digit by digit{}", who(f), verb(f, "repeats", "repeat"),
                         when(f, time));
    case FindingKind::clock_jump:
      return fmt::format("the clock jumps{}{}", by_frames(f), when(f, time));
    case FindingKind::unit_slip:
      return unit_slip(f) + when(f, time);
    case FindingKind::spike:
      return fmt::format("{} {} its path{}{}", who(f), verb(f, "leaves", "leave"), millimetres(f, "by "),
                         when(f, time));
    case FindingKind::swap_within:
      return fmt::format("{} jumps{} to the path of '{}'{} and back to its own", who(f), millimetres(f, ""),
                         f.partner, when(f, time));
    case FindingKind::label_swap:
      return fmt::format("markers '{}' and '{}' {}{}{}", f.subject, f.partner,
                         f.frames.empty() ? "carry each other's label" : "are exchanged", when(f, time),
                         millimetres(f, "while ", " apart"));
    case FindingKind::marker_slip:
      return fmt::format("{} moved{} on {}{}", who(f), millimetres(f, ""), which_segment(f),
                         about_when(f, time));
    case FindingKind::joint_slip:
      return fmt::format(
          "joint '{}' lies{} elsewhere in {} in the second half than in the first: did its markers slip "
          "together?",
          f.subject, millimetres(f, ""), which_segment(f));
    case FindingKind::loose_marker:
      return fmt::format("{} moves on {}{}", who(f), which_segment(f), millimetres(f, "by "));
    case FindingKind::unexplained:
      return count_of_frames(f, time) + " are not explained by rigid segments and noise";
    case FindingKind::at_limit:
      return fmt::format("coordinate '{}' rests at a limit of its range in {:.0f} % of the frames", f.subject,
                         100.0 * f.size);
    case FindingKind::not_settled:
      return fmt::format("{} did not settle in {:.0f} iterations over the recording", f.subject, f.size);
    case FindingKind::flagged:
      return count_of_frames(f, time) + " are flagged";
    case FindingKind::outlier:
      return fmt::format("{} was left out{}:{} {}", who(f), when(f, time), millimetres(f, ""), kFromWhere);
  }
  return "";
}

/// All but how certain it is.
std::string without_doubt(const Finding& f, const TimeBase& time) {
  std::string text = f.description.empty() ? core_of(f, time) : f.description;
  return f.detail.empty() ? text : text + ": " + f.detail;
}

std::string outliers_in_words(std::span<const Finding* const> stretches, const TimeBase& time) {
  Finding all = *stretches.front();
  std::vector<std::int64_t> frames;
  for (const Finding* f : stretches) {
    for (auto frame = f->first_frame; frame <= f->last_frame; ++frame) frames.push_back(frame);
    all.size = std::fmax(all.size, f->size);
  }
  std::string which = words_of_frames(frames, time);
  if (which.starts_with("frames ")) which.erase(0, std::string_view("frames ").size());
  auto text = fmt::format("{} was left out in {} frames ({}):{} {}", who(all), frames.size(), which,
                          millimetres(all, "up to "), kFromWhere);
  if (!all.detail.empty()) text += ": " + all.detail;
  return text;
}

}  // namespace

std::string_view to_string(FindingKind kind) { return kKinds.at(static_cast<std::size_t>(kind)); }

Status Finding::validate() const {
  const auto wrong = [&](std::string_view what) {
    return fail(Code::bad_input,
                fmt::format("a finding of the kind \"{}\" of '{}' {}", to_string(kind), subject, what));
  };
  if ((first_frame < 0) != (last_frame < 0) || last_frame < first_frame)
    return wrong(
        fmt::format("lasts from frame {} to {}; need both in order, or none", first_frame, last_frame));
  if (!frames.empty() && (frames.front() != first_frame || frames.back() != last_frame ||
                          std::ranges::adjacent_find(frames, std::greater_equal<>()) != frames.end()))
    return wrong("lists frames that are not in order from its first to its last");
  if ((kind == FindingKind::swap_within || kind == FindingKind::label_swap) &&
      (subject.empty() || partner.empty() || subject == partner))
    return wrong(fmt::format("names '{}' as the other marker; need two markers", partner));
  if (size_sd < 0.0) return wrong("has a negative standard deviation");
  if (confidence < 0.0 || confidence > 1.0)
    return wrong(fmt::format("has a confidence of {}; need 0 to 1", confidence));
  return {};
}

std::int64_t Finding::frame_count() const {
  if (!frames.empty()) return std::ssize(frames);
  return first_frame < 0 ? 0 : last_frame - first_frame + 1;
}

std::string describe(const Finding& finding, const TimeBase& time) {
  std::string text = without_doubt(finding, time);
  if (!finding.sure()) text += fmt::format(" (not certain: confidence {:.0f} %)", 100.0 * finding.confidence);
  return text;
}

std::string sentence_of(const Finding& finding, const TimeBase& time) {
  std::string text = without_doubt(finding, time);
  if (text.empty()) return text;
  if (text.front() >= 'a' && text.front() <= 'z') text.front() = static_cast<char>(text.front() - 'a' + 'A');
  if (std::string_view(".?!").find(text.back()) == std::string_view::npos) text += '.';
  return text;
}

std::vector<std::string> describe_all(std::span<const Finding> findings, const TimeBase& time) {
  std::vector<std::string> sentences;
  std::vector<bool> done(findings.size(), false);
  for (std::size_t i = 0; i < findings.size(); ++i) {
    if (done[i]) continue;
    std::vector<const Finding*> alike{&findings[i]};
    const auto belongs = [&](const Finding& f) {
      return f.kind == FindingKind::outlier && f.first_frame >= 0 && f.subject == findings[i].subject &&
             f.partner == findings[i].partner && f.detail == findings[i].detail;
    };
    for (std::size_t k = i + 1; k < findings.size() && belongs(findings[i]); ++k)
      if (belongs(findings[k])) {
        alike.push_back(&findings[k]);
        done[k] = true;
      }
    sentences.push_back(alike.size() == 1 ? describe(findings[i], time) : outliers_in_words(alike, time));
  }
  return sentences;
}

}  // namespace kinemark::data
