// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_markers.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <optional>

#include "kinemark/core/index.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"
#include "kinemark/data/likely_pairs.h"
#include "kinemark/stages/analysis/gait/feet_by_place.h"
#include "kinemark/stages/analysis/gait/gait_names.h"

namespace kinemark::analysis {
namespace {

using data::Side;

constexpr std::array<std::string_view, 7> kRoles{"left_heel", "left_toe",    "left_ankle", "right_heel",
                                                 "right_toe", "right_ankle", "sacrum"};

// Indices of the given roles, in the order of kRoles; -1 where none is given.
Result<std::array<std::int64_t, kRoles.size()>> given_markers(const std::vector<std::string>& names,
                                                              std::span<const MarkerRole> given) {
  std::array<std::int64_t, kRoles.size()> out{};
  out.fill(-1);
  for (const auto& [role, name] : given) {
    const auto* const found = std::ranges::find(kRoles, role);
    if (found == kRoles.end()) {
      const std::vector<std::string> roles(kRoles.begin(), kRoles.end());
      return fail(Code::usage, fmt::format("'{}' is no marker of walking; there are {}", role,
                                           join_names(roles, roles.size())));
    }
    const auto marker = std::ranges::find(names, name);
    if (marker == names.end()) {
      const auto nearest = nearest_names(name, names);
      return fail(Code::bad_input,
                  fmt::format("'{}', which is to be {}, is no marker of the recording{}", name, role,
                              nearest.empty() ? "" : fmt::format(" (nearest: {})", join(nearest))));
    }
    out[static_cast<std::size_t>(found - kRoles.begin())] = marker - names.begin();
  }
  return out;
}

std::string_view lower(Side side) { return side == Side::left ? "left" : "right"; }

/// " --gait-marker left_heel=NAME", as a shell takes it.
std::string gait_option(std::string_view role, const std::string& name) {
  return fmt::format(" --gait-marker {}", data::for_shell(fmt::format("{}={}", role, name)));
}

constexpr double kEnough = 0.8;     // of the frames of the set seen most: a better set is taken
constexpr double kFewFrames = 0.1;  // of all: such a marker tells nothing
constexpr std::int64_t kLeastFrames = 8;
constexpr double kHidden_s = 0.25;

using Indices = std::vector<std::int64_t>;

class Finder {
 public:
  Finder(const data::Trajectories& markers, const std::array<std::int64_t, kRoles.size()>& given)
      : markers_(markers), given_(given) {}

  Result<GaitMarkers> find() {
    choose_person();
    for (const Side side : data::kBothSides) find_foot(side);
    if (!foot(Side::left).complete() && !foot(Side::right).complete()) find_by_place();
    if (!foot(Side::left).complete() && !foot(Side::right).complete())
      return fail(
          Code::bad_input,
          fmt::format(
              "no marker of a foot is found: none has a usual name (LHEE, L.Heel; LANK; LTOE, L.MT2, "
              "...) and is seen{}, and the lowest markers are no two feet; there are {}: name those of the "
              "feet with --gait-marker left_heel=NAME --gait-marker right_heel=NAME",
              never_seen_.empty() ? ""
                                  : fmt::format(" ({} {} never seen)", join_names(never_seen_, 4),
                                                never_seen_.size() == 1 ? "is" : "are"),
              join_names(markers_.names, 12)));
    for (const Side side : data::kBothSides) note_foot(side);
    find_pelvis();
    if (out_.pelvis.empty())
      return fail(
          Code::bad_input,
          "no marker besides those of the feet is seen: nothing tells which way is up, nor whether the body "
          "travels");
    return std::move(out_);
  }

 private:
  FootMarkers& foot(Side side) { return out_.feet[data::index_of(side)]; }

  [[nodiscard]] std::int64_t frames_seen(std::initializer_list<std::int64_t> of) const {
    std::int64_t count = 0;
    for (std::int64_t f = 0; f < markers_.frames(); ++f)
      count += std::ranges::all_of(
          of, [&](auto m) { return markers_.state[markers_.index(f, m)] == data::SampleState::measured; });
    return count;
  }
  [[nodiscard]] bool usable(std::int64_t seen) const {
    return seen >= kLeastFrames &&
           static_cast<double>(seen) >= kFewFrames * static_cast<double>(markers_.frames());
  }
  [[nodiscard]] const std::string& name(std::int64_t m) const { return markers_.names[at(m)]; }

  // Markers of one place of the person, the best name first; of a side or, for the sacrum, of none.
  [[nodiscard]] Indices named(BodyPlace place, std::optional<Side> side) const {
    std::vector<std::pair<int, std::int64_t>> found;
    for (const auto m : mine_) {
      const auto plain = plain_name(name(m));
      if (!side) {
        if (const int rank = rank_of(place, plain); rank >= 0) found.emplace_back(rank, m);
        continue;
      }
      for (const auto& [of, word] : sided_words(plain)) {
        const int rank = of == *side ? rank_of(place, word) : -1;
        if (rank >= 0 && (word.size() > 1 || has_pair(plain, *side, word))) found.emplace_back(rank, m);
      }
    }
    std::ranges::stable_sort(found);
    Indices out;
    for (const auto& [rank, m] : found)
      if (std::ranges::find(out, m) == out.end()) out.push_back(m);
    return out;
  }

  // Whether the other foot has a marker of the same word: single letters mean nothing alone.
  [[nodiscard]] bool has_pair(const std::string& plain, Side side, const std::string& word) const {
    return std::ranges::any_of(mine_, [&](auto m) {
      const auto other = plain_name(name(m));
      return other != plain && std::ranges::any_of(sided_words(other), [&](const SidedWord& read) {
               return read.side != side && read.word == word;
             });
    });
  }

  void take_person(std::string_view person) {
    mine_.clear();
    for (std::int64_t m = 0; m < markers_.markers(); ++m)
      if (person_of(name(m)) == person) mine_.push_back(m);
  }

  // How often the heels, ankles and toes of the person are seen, in samples.
  [[nodiscard]] std::int64_t samples_of_feet() const {
    std::int64_t out = 0;
    for (const Side side : data::kBothSides)
      for (const auto place : {BodyPlace::heel, BodyPlace::ankle, BodyPlace::forefoot})
        for (const auto m : named(place, side)) out += frames_seen({m});
    return out;
  }

  void choose_person() {
    std::map<std::string_view, std::int64_t> people;
    for (std::int64_t m = 0; m < markers_.markers(); ++m) people.try_emplace(person_of(name(m)), 0);
    for (auto& [person, samples] : people) {
      take_person(person);
      samples = samples_of_feet();
    }
    std::erase_if(people, [](const auto& one) { return one.second == 0; });
    if (people.size() < 2) {  // one person, or nobody by name: all markers
      mine_.clear();
      for (std::int64_t m = 0; m < markers_.markers(); ++m) mine_.push_back(m);
      return;
    }
    auto taken = people.begin();
    for (auto one = people.begin(); one != people.end(); ++one)
      if (one->second > taken->second) taken = one;
    for (const auto m : given_)
      if (const auto asked = m >= 0 ? people.find(person_of(name(m))) : people.end(); asked != people.end())
        taken = asked;
    std::vector<std::string> others;
    for (const auto& [person, samples] : people)
      if (person != taken->first) others.emplace_back(person.empty() ? "one without a name" : person);
    out_.person = std::string(taken->first);
    out_.notes.push_back(fmt::format(
        "the recording holds {} people: walking is that of {}, not of {} (--gait-marker with a marker of "
        "another "
        "one takes that one)",
        people.size(), out_.person.empty() ? "the one without a name" : out_.person, join_names(others, 4)));
    take_person(taken->first);
  }

  // Of markers of one place, that which is seen most; the first name where another is seen a little more.
  [[nodiscard]] std::int64_t most_seen(const Indices& of) const {
    std::int64_t best = -1, most = 0;
    for (const auto m : of) most = std::max(most, frames_seen({m}));
    for (const auto m : of)
      if (best < 0 && static_cast<double>(frames_seen({m})) >= kEnough * static_cast<double>(most)) best = m;
    return best;
  }

  void find_foot(Side side) {
    const std::size_t first = 3 * data::index_of(side);
    const auto candidates = [&](std::size_t role, BodyPlace place) {
      return given_[first + role] >= 0 ? Indices{given_[first + role]} : named(place, side);
    };
    const auto heels = candidates(0, BodyPlace::heel), toes = candidates(1, BodyPlace::forefoot),
               ankles = candidates(2, BodyPlace::ankle);
    const auto heel = most_seen(heels), toe = most_seen(toes), ankle = most_seen(ankles);
    struct Choice {
      FootSet set;
      std::int64_t rear, front;
    };
    std::vector<Choice> choices;
    if (heel >= 0 && toe >= 0) choices.push_back({FootSet::heel_and_toe, heel, toe});
    if (ankle >= 0 && toe >= 0) choices.push_back({FootSet::ankle_and_toe, ankle, toe});
    if (heel >= 0) choices.push_back({FootSet::rear_alone, heel, heel});
    if (ankle >= 0) choices.push_back({FootSet::rear_alone, ankle, ankle});
    if (toe >= 0) choices.push_back({FootSet::toe_alone, toe, toe});
    std::int64_t most = 0;
    for (const auto& choice : choices) most = std::max(most, frames_seen({choice.rear, choice.front}));
    for (const auto& choice : choices) {
      const auto seen = frames_seen({choice.rear, choice.front});
      if (!usable(seen) || static_cast<double>(seen) < kEnough * static_cast<double>(most)) continue;
      foot(side) = {.heel = choice.rear, .toe = choice.front, .set = choice.set, .passed_over = {}};
      break;
    }
    foot(side).knee = most_seen(named(BodyPlace::knee, side));
    const auto outer =
        given_[first + 2] >= 0 ? given_[first + 2] : most_seen(named(BodyPlace::outer_ankle, side));
    if (outer != foot(side).heel && outer != foot(side).toe) foot(side).ankle = outer;
    // Better names that are seen less.
    for (const auto* const all : {&heels, &toes})
      for (const auto m : *all) {
        if (m == foot(side).heel || m == foot(side).toe) break;
        foot(side).passed_over.push_back(m);
      }
    for (const auto* const all : {&heels, &toes, &ankles})
      for (const auto m : *all)
        if (frames_seen({m}) == 0) never_seen_.push_back(name(m));
  }

  void find_by_place() {
    const auto found = find_feet_by_place(markers_, mine_);
    if (!found) return;
    out_.sides_known = found->sides_known;
    for (const Side side : data::kBothSides) {
      const auto& [rear, front] = found->feet[data::index_of(side)];
      if (!usable(frames_seen({rear, front}))) continue;
      foot(side) = {.heel = rear, .toe = front, .set = FootSet::by_place, .passed_over = {}};
    }
    if (!foot(Side::left).complete() || !foot(Side::right).complete()) return;
    const auto pair = [&](Side side) {
      return foot(side).points() ? fmt::format("{} and {}", name(foot(side).heel), name(foot(side).toe))
                                 : name(foot(side).heel);
    };
    out_.notes.push_back(fmt::format(
        "no names of feet are known here: by their place, {} are taken as one foot and {} as the other{}",
        pair(Side::left), pair(Side::right),
        out_.sides_known ? "; to change that:" + options_taken() : "; no name tells which is left"));
  }

  // The markers that were taken, as options.
  [[nodiscard]] std::string options_taken() {
    std::string said;
    for (const Side side : data::kBothSides) {
      said += gait_option(fmt::format("{}_heel", lower(side)), name(foot(side).heel));
      if (foot(side).points()) said += gait_option(fmt::format("{}_toe", lower(side)), name(foot(side).toe));
    }
    return said;
  }

  // Stretches longer than 0.25 s in which a marker is not seen: "LHEE is hidden from 1.20 to 2.00 s".
  [[nodiscard]] std::string hidden(std::int64_t m) const {
    std::vector<std::string> spans;
    const auto& time = markers_.time;
    for (std::int64_t f = 0; f < markers_.frames(); ++f) {
      if (markers_.state[markers_.index(f, m)] == data::SampleState::measured) continue;
      auto last = f;
      while (last + 1 < markers_.frames() &&
             markers_.state[markers_.index(last + 1, m)] != data::SampleState::measured)
        ++last;
      if (static_cast<double>(last - f + 1) > kHidden_s * time.rate_hz)
        spans.push_back(fmt::format("from {:.2f} to {:.2f} s", time.time_s(f), time.time_s(last)));
      f = last;
    }
    return spans.empty() ? fmt::format("{} is seen in {:.0f} % of the frames", name(m),
                                       100.0 * static_cast<double>(frames_seen({m})) /
                                           static_cast<double>(markers_.frames()))
                         : fmt::format("{} is hidden {}", name(m), join_names(spans, 4));
  }

  void note_foot(Side side) {
    const auto& is = foot(side);
    if (!is.complete()) {
      out_.notes.push_back(fmt::format(
          "there is no marker of the {} foot that is seen; that foot is not measured", lower(side)));
      return;
    }
    if (is.set == FootSet::by_place || (is.set == FootSet::heel_and_toe && is.passed_over.empty())) return;
    std::string said = fmt::format("{} foot: ", lower(side));
    for (const auto m : is.passed_over) said += hidden(m) + "; ";
    if (is.set == FootSet::heel_and_toe)
      said += fmt::format("{} and {} are used", name(is.heel), name(is.toe));
    else if (is.set == FootSet::ankle_and_toe)
      said += fmt::format("no marker of the heel is used, {} of the ankle stands for it", name(is.heel));
    else
      said += fmt::format("no marker of the {} is used, {} stands for the whole foot",
                          is.set == FootSet::toe_alone ? "heel or ankle" : "toes", name(is.heel));
    out_.notes.push_back(said);
  }

  void find_pelvis() {
    const auto both = [&](BodyPlace place) {
      const auto left = most_seen(named(place, Side::left)), right = most_seen(named(place, Side::right));
      return left >= 0 && right >= 0 && left != right ? Indices{left, right} : Indices{};
    };
    out_.front = both(BodyPlace::front_of_pelvis);
    out_.back = both(BodyPlace::back_of_pelvis);
    const auto sacrum =
        given_.back() >= 0 ? given_.back() : most_seen(named(BodyPlace::sacrum, std::nullopt));
    Indices candidates = out_.front;
    candidates.insert(candidates.end(), out_.back.begin(), out_.back.end());
    if (given_.back() >= 0) candidates.clear();
    if (sacrum >= 0) candidates.push_back(sacrum);
    if (out_.back.empty() && sacrum >= 0) out_.back = {sacrum};
    for (const auto m : candidates)
      if (usable(frames_seen({m})) && std::ranges::find(out_.pelvis, m) == out_.pelvis.end())
        out_.pelvis.push_back(m);
    if (!out_.pelvis.empty()) return;
    for (const auto m : mine_)
      if (std::ranges::none_of(out_.feet, [m](const auto& one) { return one.heel == m || one.toe == m; }) &&
          usable(frames_seen({m})))
        out_.pelvis.push_back(m);
    if (!out_.pelvis.empty())
      out_.notes.push_back(fmt::format(
          "no marker of the pelvis is named; the mean of the {} others stands for it", out_.pelvis.size()));
  }

  const data::Trajectories& markers_;
  const std::array<std::int64_t, kRoles.size()>& given_;
  Indices mine_;  // markers of the person
  std::vector<std::string> never_seen_;
  GaitMarkers out_;
};

}  // namespace

std::span<const std::string_view> gait_roles() { return kRoles; }

Result<GaitMarkers> find_gait_markers(const data::Trajectories& markers, std::span<const MarkerRole> given) {
  const auto chosen = given_markers(markers.names, given);
  if (!chosen) return std::unexpected(chosen.error());
  return Finder(markers, *chosen).find();
}

}  // namespace kinemark::analysis
