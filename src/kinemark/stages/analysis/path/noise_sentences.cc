// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/path/noise_sentences.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include "kinemark/core/index.h"

namespace kinemark::analysis {
namespace {

constexpr double kTooOpen = 2.5;           // high end of a cut-off over its low one: it tells nothing
constexpr double kLeastDoubt = 1.05;       // of a cut-off, whatever the curvature of the likelihood says
constexpr std::size_t kFewestMembers = 3;  // of a shared filter
constexpr double kStatedOff = 1.3;         // stated noise over found, or the other way round

// Markers that share a sentence, and how a number ranges over them.
struct Group {
  std::vector<const PathNoise*> members;

  [[nodiscard]] bool empty() const { return members.empty(); }
  [[nodiscard]] bool one() const { return members.size() == 1; }
  [[nodiscard]] std::string names() const {
    std::vector<std::string> out;
    for (const auto* member : members) out.push_back(member->subject);
    return listed(out);
  }
  [[nodiscard]] double least(const std::function<double(const PathNoise&)>& number) const {
    double out = INFINITY;
    for (const auto* member : members) out = std::fmin(out, number(*member));
    return out;
  }
  [[nodiscard]] double most(const std::function<double(const PathNoise&)>& number) const {
    double out = -INFINITY;
    for (const auto* member : members) out = std::fmax(out, number(*member));
    return out;
  }
  // "0.21 to 0.4", or one number where both ends read alike.
  [[nodiscard]] std::string range(const std::function<double(const PathNoise&)>& number) const {
    const std::string low = fmt::format("{:.2g}", least(number)), high = fmt::format("{:.2g}", most(number));
    return low == high ? low : low + " to " + high;
  }
};

Group group_of(std::span<const PathNoise> markers, const std::function<bool(const PathNoise&)>& belongs) {
  Group out;
  for (const auto& marker : markers)
    if (belongs(marker)) out.members.push_back(&marker);
  return out;
}

double noise_mm(const PathNoise& noise) { return 1e3 * noise.sd_m(); }
double cutoff_hz(const PathNoise& noise) { return noise.cutoff_hz.middle; }
// The spectrum falls like behind a low-pass, and nobody says that it went through one.
bool falls(const PathNoise& noise) {
  return noise.filtered() && noise.source != NoiseSource::filter && !noise.unusable();
}

// The form of the filter, where two thirds of the members have the same.
std::string form_of(const Group& group) {
  std::vector<std::string> forms;
  for (const auto* member : group.members)
    forms.push_back(math::name_of(member->model.form, member->model.order));
  for (const auto& form : forms)
    if (3 * std::ranges::count(forms, form) >= 2 * std::ssize(forms)) return form;
  return "of which form is not known";
}

// What a cut-off may be, with no less doubt than models of filters have.
NoiseRange cut_off_of(const PathNoise& noise) {
  const auto& found = noise.cutoff_hz;
  return {.low = std::min(found.low, found.middle / kLeastDoubt),
          .middle = found.middle,
          .high = std::max(found.high, found.middle * kLeastDoubt)};
}

// Mean of the members' cut-offs, by their logarithms, and how sure it is of itself.
void average(std::span<const PathNoise> markers, SharedFilter& shared) {
  constexpr double kEnds = 1.96;
  double weights = 0.0, sum = 0.0, squares = 0.0;
  for (const auto m : shared.members) {
    const auto cut_off = cut_off_of(markers[m]);
    const double sd = std::log(cut_off.high / cut_off.low) / (2.0 * kEnds), weight = 1.0 / (sd * sd);
    weights += weight, sum += weight * std::log(cut_off.middle);
  }
  const double mean = sum / weights;
  for (const auto m : shared.members) {
    const auto cut_off = cut_off_of(markers[m]);
    const double sd = std::log(cut_off.high / cut_off.low) / (2.0 * kEnds);
    squares += std::pow((std::log(cut_off.middle) - mean) / sd, 2);
  }
  const double spread = squares / static_cast<double>(shared.members.size() - 1);
  const double sd = std::sqrt(std::max(1.0, spread) / weights);
  shared.cutoff_hz = std::exp(mean);
  shared.low_hz = std::exp(mean - kEnds * sd);
  shared.high_hz = std::exp(mean + kEnds * sd);
}

std::string range_sentence(const Group& group) {
  return fmt::format(
      "{}: the noise below 2 Hz cannot be distinguished from movement (between {:.2g} and {:.2g} mm): no "
      "interval of "
      "extents, largest distance, farthest sample, boxes and plane. State it (--noise, from a static trial "
      "of the same "
      "session)",
      group.names(), 1e3 * group.least([](const PathNoise& n) { return n.slow_sd_m.low; }),
      1e3 * group.most([](const PathNoise& n) { return n.slow_sd_m.high; }));
}

void say_filters(std::span<const PathNoise> markers, std::vector<std::string>& out) {
  const auto named = group_of(markers, [](const PathNoise& n) { return n.source == NoiseSource::filter; });
  if (!named.empty())
    out.push_back(fmt::format(
        "{}: low-passed at {} Hz (-3 dB) as the recording itself says; noise before that {} mm; what "
        "the movement had above is lost",
        named.names(), named.range(cutoff_hz), named.range(noise_mm)));
  const auto falling = group_of(markers, falls);
  if (falling.empty()) return;
  const auto shared = find_shared_filter(markers);
  if (shared.agreed()) {
    Group members;
    for (const auto m : shared.members) members.members.push_back(&markers[m]);
    out.push_back(
        fmt::format("the recording was low-passed at about {:.1f} Hz (-3 dB; {}; 95 %: {:.1f} to {:.1f}) "
                    "before it came here, by "
                    "{} of the {} markers whose spectrum tells; noise before that {} mm; what the movement "
                    "had above is lost",
                    shared.cutoff_hz, form_of(members), shared.low_hz, shared.high_hz, shared.members.size(),
                    shared.of, members.range(noise_mm)));
    return;
  }
  out.push_back(
      fmt::format("{}: the noise is not white, its spectrum falls as behind a low-pass at {} Hz (-3 dB); too "
                  "few of the recording's "
                  "markers share a cut-off to say that a filter made it; what movement there was above may "
                  "be lost, and intervals "
                  "allow for it",
                  falling.names(), falling.range(cutoff_hz)));
}

// What is correlated from sample to sample. Of noise that is slower than what can be seen the size is not
// known, and of its memory no more than the least.
void say_correlation(std::span<const PathNoise> markers, std::vector<std::string>& out) {
  const auto correlation = [](const PathNoise& n) { return n.model.correlation; };
  const auto memory_s = [](const PathNoise& n) { return -1.0 / std::log(n.model.correlation) / n.rate_hz; };
  const auto correlated = [](const PathNoise& n) { return !n.unusable() && n.correlated(); };
  const auto known =
      group_of(markers, [&](const PathNoise& n) { return correlated(n) && !n.slow_is_unknown(); });
  if (!known.empty())
    out.push_back(fmt::format("{}: noise of {} mm, correlated over {} s (AR {})", known.names(),
                              known.range(noise_mm), known.range(memory_s), known.range(correlation)));
  const auto slow =
      group_of(markers, [&](const PathNoise& n) { return correlated(n) && n.slow_is_unknown(); });
  if (!slow.empty())
    out.push_back(fmt::format("{}: the noise is correlated over {:.2g} s or more (AR {:.2g} or more)",
                              slow.names(), slow.least(memory_s), slow.least(correlation)));
}

// Markers whose noise is smaller, or larger, than what was stated.
void say_stated(std::span<const PathNoise> markers, bool smaller, std::vector<std::string>& out) {
  const auto group = group_of(markers, [smaller](const PathNoise& n) {
    const double ratio = n.found_sd_m / n.stated_sd_m;
    return n.stated_sd_m > 0.0 && (smaller ? ratio < 1.0 / kStatedOff : ratio > kStatedOff);
  });
  if (group.empty()) return;
  out.push_back(fmt::format("the noise of {} is {} mm by {} samples, not the {:.3g} mm that were stated",
                            group.names(), group.range([](const PathNoise& n) { return 1e3 * n.found_sd_m; }),
                            group.one() ? "its" : "their", 1e3 * group.members.front()->stated_sd_m));
}

}  // namespace

SharedFilter find_shared_filter(std::span<const PathNoise> markers) {
  SharedFilter out;
  std::vector<std::size_t> telling;
  for (std::size_t m = 0; m < markers.size(); ++m) {
    const auto& noise = markers[m];
    if (noise.source == NoiseSource::too_short || noise.source == NoiseSource::filter) continue;
    if (!falls(noise)) {
      ++out.of;
      continue;
    }
    const auto cut_off = cut_off_of(noise);
    if (!(cut_off.high <= kTooOpen * cut_off.low)) continue;
    ++out.of;
    telling.push_back(m);
  }
  // Where most intervals meet, one of them begins.
  for (const auto start : telling) {
    const double at_hz = cut_off_of(markers[start]).low;
    std::vector<std::size_t> members;
    for (const auto m : telling)
      if (const auto cut_off = cut_off_of(markers[m]); cut_off.low <= at_hz && at_hz <= cut_off.high)
        members.push_back(m);
    if (members.size() > out.members.size()) out.members = std::move(members);
  }
  if (out.members.size() < kFewestMembers || 3 * out.members.size() < 2 * out.of)
    out.members.clear();
  else
    average(markers, out);
  return out;
}

std::string listed(std::span<const std::string> names) {
  if (names.size() == 1) return names.front();
  std::string out = fmt::format("{} markers ({}", names.size(), names.front());
  for (std::size_t i = 1; i < std::min<std::size_t>(3, names.size()); ++i) out += ", " + names[i];
  return out + (names.size() > 3 ? ", ...)" : ")");
}

std::vector<std::string> noise_sentences(std::span<const PathNoise> markers) {
  std::vector<std::string> out;
  say_filters(markers, out);
  const auto within =
      group_of(markers, [](const PathNoise& n) { return !n.unusable() && n.filtered_within_movement(); });
  if (!within.empty())
    out.push_back(
        fmt::format("{}: the spectrum falls within the movement's band as behind a low-pass: how much that "
                    "took away is not in the data, no interval of peaks and jerk",
                    within.names()));
  say_correlation(markers, out);
  const auto slow =
      group_of(markers, [](const PathNoise& n) { return !n.unusable() && n.slow_is_unknown(); });
  if (!slow.empty()) out.push_back(range_sentence(slow));
  const auto none = group_of(markers, [](const PathNoise& n) { return n.source == NoiseSource::no_model; });
  if (!none.empty())
    out.push_back(
        fmt::format("{}: the noise above the movement fits no model (spikes, changing noise, another "
                    "filter): no interval",
                    none.names()));
  const auto rounding =
      group_of(markers, [](const PathNoise& n) { return n.source == NoiseSource::rounding; });
  if (!rounding.empty())
    out.push_back(fmt::format(
        "{}: the noise is below the rounding of the file ({} mm): no interval from the noise; "
        "rounding gives +-{} mm a sample",
        rounding.names(), rounding.range([](const PathNoise& n) { return 1e3 * n.rounding_step_m; }),
        rounding.range([](const PathNoise& n) { return 5e2 * n.rounding_step_m; })));
  say_stated(markers, true, out);
  say_stated(markers, false, out);
  return out;
}

}  // namespace kinemark::analysis
