// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/gait_names.h"

#include <algorithm>
#include <array>
#include <span>

namespace kinemark::analysis {
namespace {

using data::Side;

// Whole words, never parts of words: LLM is the left lateral malleolus, RLM the right one, LTHLP no heel.
constexpr std::array<std::string_view, 10> kHeel{"hee", "heel", "fcc", "cal",       "calc",
                                                 "fhe", "sph",  "ca",  "calcaneus", "calcstudy"};
constexpr std::array<std::string_view, 47> kForefoot{
    "toe",   "toetip", "toe1", "toe2",       "p1mt",   "mt1",      "mt2",       "met2",        "mth2", "fm1",
    "fm2",   "met",    "met1", "metatarsal", "mt5",    "met5",     "fm5",       "p5mt",        "mth5", "mth1",
    "5meta", "meta5",  "mth",  "tt2",        "bigtoe", "hal",      "hallux",    "fmt",         "mfh1", "mfh5",
    "fmh",   "fmh1",   "fmh5", "toelat",     "toemed", "smalltoe", "latfoot",   "lateralfoot", "lat",  "cun",
    "ft2",   "ft1",    "ft3",  "mfs",        "mfl",    "toestudy", "5metastudy"};
constexpr std::array<std::string_view, 23> kAnkle{
    "ank",        "ankle",    "mall",   "mal",   "lm",     "lmal",  "llmal",     "fal",
    "llm",        "anklelat", "latmal", "lmall", "mallat", "malll", "lak",       "ajc",
    "ankleouter", "am",       "al",     "rlm",   "tam",    "rmall", "anklestudy"};
constexpr std::array<std::string_view, 6> kFront{"asis", "asi", "ias", "fwt", "asislat", "asisstudy"};
constexpr std::array<std::string_view, 5> kBack{"psis", "psi", "ips", "bwt", "psisstudy"};
constexpr std::array<std::string_view, 12> kSacrum{"sacr", "sacrum", "vsac",   "sac", "vsacral", "sacral",
                                                   "psis", "s2",     "sacrol", "mwt", "pelr",    "midhip"};
constexpr std::array<std::string_view, 12> kKnee{"kne",         "knee", "lk",      "kneelat",
                                                 "lkne",        "lfe",  "latknee", "kneeouter",
                                                 "lateralknee", "fle",  "kjc",     "kneestudy"};
constexpr std::array<std::string_view, 14> kOuterAnkle{"ank",    "ankle", "lm",         "lmal",      "llmal",
                                                       "llm",    "fal",   "lmall",      "anklelat",  "latmal",
                                                       "mallat", "rlm",   "ankleouter", "anklestudy"};
// Single letters are the names of one marker set only: believed where both feet have them (gait_markers.cc).
constexpr std::array<std::string_view, 1> kForefootLetter{"d"}, kAnkleLetter{"a"};

std::span<const std::string_view> words_of(BodyPlace place) {
  switch (place) {
    case BodyPlace::heel:
      return kHeel;
    case BodyPlace::forefoot:
      return kForefoot;
    case BodyPlace::ankle:
      return kAnkle;
    case BodyPlace::front_of_pelvis:
      return kFront;
    case BodyPlace::back_of_pelvis:
      return kBack;
    case BodyPlace::knee:
      return kKnee;
    case BodyPlace::outer_ankle:
      return kOuterAnkle;
    case BodyPlace::sacrum:
      break;
  }
  return kSacrum;
}

}  // namespace

std::string plain_name(std::string_view name) {
  if (const auto colon = name.rfind(':'); colon != std::string_view::npos) name.remove_prefix(colon + 1);
  std::string out;
  for (const char c : name)
    if (c >= 'A' && c <= 'Z')
      out += static_cast<char>(c - 'A' + 'a');
    else if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
      out += c;
  return out;
}

std::string_view person_of(std::string_view name) {
  const auto colon = name.rfind(':');
  return colon == std::string_view::npos ? std::string_view() : name.substr(0, colon);
}

std::vector<SidedWord> sided_words(std::string_view plain) {
  std::vector<SidedWord> out;
  const auto add = [&](Side side, std::string_view word) {
    if (!word.empty()) out.push_back({.side = side, .word = std::string(word)});
  };
  for (const Side side : data::kBothSides) {
    const bool left = side == Side::left;
    for (const std::string_view prefix : {left ? "left" : "right", left ? "lx" : "rx", left ? "l" : "r"})
      if (plain.starts_with(prefix)) add(side, plain.substr(prefix.size()));
    for (const std::string_view suffix : {left ? "left" : "right", left ? "l" : "r"})
      if (plain.size() > 2 && plain.ends_with(suffix))
        add(side, plain.substr(0, plain.size() - suffix.size()));
  }
  return out;
}

int rank_of(BodyPlace place, std::string_view word) {
  const auto words = words_of(place);
  if (const auto found = std::ranges::find(words, word); found != words.end())
    return static_cast<int>(found - words.begin());
  const bool letter = (place == BodyPlace::forefoot && word == kForefootLetter[0]) ||
                      (place == BodyPlace::ankle && word == kAnkleLetter[0]);
  return letter ? static_cast<int>(words.size()) : -1;
}

}  // namespace kinemark::analysis
