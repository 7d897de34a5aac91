// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_markers.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>

#include "kinemark/core/index.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"

namespace kinemark::analysis {
namespace {

using data::Side;

constexpr std::array<std::string_view, 7> kRoles{"left_heel", "left_toe",    "left_ankle", "right_heel",
                                                 "right_toe", "right_ankle", "sacrum"};

// Usual names without side, case and separators, best first.
constexpr std::array<std::string_view, 6> kHeel{"hee", "heel", "cal", "calc", "fcc", "calcaneus"};
constexpr std::array<std::string_view, 17> kToe{"toe",    "toetip",     "mt2",  "met2", "mth2",  "fm2",
                                                "met",    "metatarsal", "toe2", "mt1",  "toe1",  "fm1",
                                                "toemed", "bigtoe",     "mt5",  "fm5",  "toelat"};
constexpr std::array<std::string_view, 9> kAnkle{"ank",  "ankle",  "anklelat", "lmal", "lmall",
                                                 "mall", "latmal", "fal",      "ajc"};
constexpr std::array<std::string_view, 4> kBackOfPelvis{"psi", "psis", "ips", "bwt"};
constexpr std::array<std::string_view, 4> kFrontOfPelvis{"asi", "asis", "ias", "fwt"};
constexpr std::array<std::string_view, 6> kSacrum{"sacr", "sacrum", "vsac", "vsacral", "sacral", "midhip"};

// Lower case, without a subject's prefix and separators: "r.heel" of "Anna:R.Heel".
std::string plain(std::string_view name) {
  const auto colon = name.rfind(':');
  if (colon != std::string_view::npos) name.remove_prefix(colon + 1);
  std::string out;
  for (const char c : name)
    if (c >= 'A' && c <= 'Z')
      out += static_cast<char>(c - 'A' + 'a');
    else if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
      out += c;
  return out;
}

class Names {
 public:
  explicit Names(const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i)
      index_.try_emplace(plain(names[i]), static_cast<std::int64_t>(i));
  }
  [[nodiscard]] std::int64_t one_of(std::span<const std::string_view> bases) const {
    for (const auto base : bases)
      if (const auto found = find(std::string(base)); found >= 0) return found;
    return -1;
  }
  [[nodiscard]] std::int64_t one_of(Side side, std::span<const std::string_view> bases) const {
    const std::string letter = side == Side::left ? "l" : "r", word = side == Side::left ? "left" : "right";
    for (const auto base : bases)
      for (const auto& name : {letter + std::string(base), word + std::string(base),
                               std::string(base) + letter, std::string(base) + word})
        if (const auto found = find(name); found >= 0) return found;
    return -1;
  }

 private:
  [[nodiscard]] std::int64_t find(const std::string& name) const {
    const auto found = index_.find(name);
    return found == index_.end() ? -1 : found->second;
  }
  std::map<std::string, std::int64_t> index_;
};

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

}  // namespace

std::span<const std::string_view> gait_roles() { return kRoles; }

Result<GaitMarkers> find_gait_markers(const std::vector<std::string>& names,
                                      std::span<const MarkerRole> given) {
  const auto chosen = given_markers(names, given);
  if (!chosen) return std::unexpected(chosen.error());
  const Names known(names);
  GaitMarkers out;
  std::vector<std::string> missing;
  for (const Side side : data::kBothSides) {
    auto& foot = out.feet[data::index_of(side)];
    const std::size_t first = 3 * data::index_of(side);
    const auto pick = [&](std::size_t role, std::span<const std::string_view> bases) {
      const auto one = (*chosen)[first + role];
      return one >= 0 ? one : known.one_of(side, bases);
    };
    foot.heel = pick(0, kHeel);
    foot.toe = pick(1, kToe);
    if (foot.heel < 0) {
      foot.heel = pick(2, kAnkle);
      if (foot.heel >= 0)
        out.notes.push_back(
            fmt::format("there is no marker of the {} heel; that of the ankle, {}, stands for it",
                        lower(side), names[at(foot.heel)]));
    }
    if (foot.heel < 0) missing.push_back(fmt::format("the {} heel or ankle", lower(side)));
    if (foot.toe < 0) missing.push_back(fmt::format("the {} toes", lower(side)));
  }
  if (!missing.empty()) {
    const auto sentence =
        fmt::format("there is no marker of {} under a usual name (LHEE, L.Heel; LANK; LTOE, L.MT2, ...)",
                    join_names(missing, 4));
    if (!out.feet[0].complete() && !out.feet[1].complete()) return fail(Code::bad_input, sentence);
    out.notes.push_back(sentence + "; that foot is not measured");
  }
  if (const auto given_sacrum = chosen->back(); given_sacrum >= 0) {
    out.pelvis.push_back({given_sacrum});
    return out;
  }
  if (const auto sacrum = known.one_of(kSacrum); sacrum >= 0) out.pelvis.push_back({sacrum});
  for (const std::span<const std::string_view> pair : {std::span(kBackOfPelvis), std::span(kFrontOfPelvis)}) {
    const auto left = known.one_of(Side::left, pair), right = known.one_of(Side::right, pair);
    if (left >= 0 && right >= 0) out.pelvis.push_back({left, right});
  }
  return out;
}

}  // namespace kinemark::analysis
