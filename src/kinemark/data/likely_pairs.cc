// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/likely_pairs.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <set>

#include "kinemark/core/name_pattern.h"
#include "kinemark/data/marker_name.h"
#include "kinemark/data/name_index.h"

namespace kinemark::data {
namespace {

constexpr std::size_t kLongestValue = 200;  // letters of an option; sentences shorten longer words

/// Names of one landmark, without side, between blanks.
struct Landmark {
  std::string_view name;
  bool paired;
  std::string_view stems;
};

// Clusters are not here: which of three markers on a thigh is which, no name says in another laboratory.
constexpr std::array kOnSkin = {
    Landmark{"front of pelvis", true, " asi asis ias asisstudy "},
    Landmark{"back of pelvis", true, " psi psis ips psisstudy "},
    Landmark{"trochanter", true, " gt gtr ftc troc gtroc trochanter "},
    Landmark{"thigh", true, " thi thigh "},
    Landmark{"outer knee", true,
             " kne knee kneelat latknee kneelateral lateralknee kneeouter lfc lfe fle lkne kneestudy "},
    Landmark{"inner knee", true,
             " knem knm kneemed medknee kneemedial medialknee kneeinner mfc mfe fme mkne mkneestudy mknee "
             "mkneestudy "},
    Landmark{"fibula", true, " fax hf fh "},
    Landmark{"tibial tuberosity", true, " ttc tt att ttub "},
    Landmark{"shank", true, " tib shank "},
    Landmark{
        "ankle", true,
        " ank ankle anklelat latankle anklelateral lateralankle ankleouter lmal lm fal latmal anklestudy "},
    Landmark{"inner ankle", true,
             " med ankm anklemed medankle anklemedial medialankle ankleinner ankmed mank mankle mmal mm tam "
             "medmal manklestudy "},
    Landmark{"heel", true, " hee heel cal calc calcaneus fcc ca calcstudy "},
    Landmark{"toe", true, " toe mt2 mth2 met2 fm2 smh mfh2 toestudy "},
    Landmark{"toe tip", true, " toetip hallux hlx "},
    Landmark{"fifth metatarsal", true, " mt5 mth5 met5 fm5 vmh mfh5 toelat 5meta 5metastudy "},
    Landmark{"first metatarsal", true, " mt1 mth1 met1 fm1 fmh mfh1 toemed "},
    Landmark{"shoulder", true, " sho acr acromium acromion shoulder saj sae shoulderstudy "},
    Landmark{"outer elbow", true,
             " elb elbow elblat elbowlat elbowlateral lateralelbow lel lhe hle lelbow lelbowstudy "},
    Landmark{"inner elbow", true,
             " elbm elbowmed elbowmedial medialelbow mel mep mhe hme melbow melbowstudy "},
    Landmark{"thumb side of wrist", true,
             " wra wristlat rs rsp rrs faradius radius radialstyloid lwriststudy "},
    Landmark{"finger side of wrist", true, " wrb wristmed us usp faulna ulna ulnarstyloid mwriststudy "},
    Landmark{"hand", true, " fin finger "},
    Landmark{"front of head", true, " fhd hdf "},
    Landmark{"back of head", true, " bhd hdb "},
    Landmark{"sacrum", false, " sacr sacrum vsac vsacral sac sacral "},
    Landmark{"c7", false, " c7 cv7 c7study "},
    Landmark{"t8", false, " t8 tv8 "},
    Landmark{"t10", false, " t10 tv10 "},
    Landmark{"jugular notch", false, " clav ij sjn sup jn "},
    Landmark{"sternum", false, " strn sternum stern "},
    Landmark{"xiphoid process", false, " px sxs xiph xip xiphoid "},
    Landmark{"top of head", false, " tophead headtop hv vertex "},
    Landmark{"hip centre", true, " hjc hjcstudy "},
    Landmark{"knee centre", true, " kjc "},
    Landmark{"ankle centre", true, " ajc "},
    Landmark{"shoulder centre", true, " sjc "},
    Landmark{"elbow centre", true, " ejc "},
    Landmark{"wrist centre", true, " wjc "},
};

/// Names that keypoints have for what is not on skin.
constexpr std::array kInImages = {
    Landmark{"hip centre", true, " hip "},
    Landmark{"knee centre", true, " knee "},
    Landmark{"ankle centre", true, " ankle "},
    Landmark{"shoulder centre", true, " shoulder "},
    Landmark{"elbow centre", true, " elbow "},
    Landmark{"wrist centre", true, " wrist "},
    Landmark{"keypoint of heel", true, " heel "},
    Landmark{"keypoint of big toe", true, " bigtoe footindex "},
    Landmark{"keypoint of small toe", true, " smalltoe "},
    Landmark{"eye", true, " eye "},
    Landmark{"ear", true, " ear "},
    Landmark{"nose", false, " nose "},
    Landmark{"neck", false, " neck "},
    Landmark{"middle of hips", false, " midhip chip hip "},
};

/// A landmark, its side, and the place of the name among those for it, the best first.
struct Meaning {
  std::string_view landmark;
  char side = ' ';
  std::size_t rank = 0;
};

std::optional<Meaning> find_in(std::span<const Landmark> landmarks, const MarkerStem& reading) {
  const std::string wanted = " " + reading.stem + " ";
  for (const auto& landmark : landmarks)
    if (const auto at = landmark.stems.find(wanted);
        landmark.paired == (reading.side != ' ') && at != std::string_view::npos)
      return Meaning{.landmark = landmark.name, .side = reading.side, .rank = at};
  return std::nullopt;
}

/// A list of names, and what each of them says.
class Names {
 public:
  explicit Names(std::span<const std::string> names) : names_(names) {
    for (const auto& name : names_) plain_.insert(plain_marker_name(name));
    keypoints_ = is_list_of_keypoints();
  }

  [[nodiscard]] std::span<const std::string> all() const { return names_; }

  [[nodiscard]] std::optional<Meaning> meaning(const std::string& name) const {
    std::optional<Meaning> found;
    for (const auto& reading : read_marker_name(name)) {
      if (reading.behind && !plain_.contains(mirrored(name))) continue;
      auto one = keypoints_ ? find_in(kInImages, reading) : std::nullopt;
      if (!one) one = find_in(kOnSkin, reading);
      if (!one) continue;
      if (found && found->side != one->side) return std::nullopt;  // two sides: nobody knows which
      found = one;
    }
    return found;
  }

 private:
  [[nodiscard]] bool is_list_of_keypoints() const {
    constexpr std::array<std::string_view, 8> kTelling{"nose", "leye",    "reye",    "lear",
                                                       "rear", "lbigtoe", "rbigtoe", "midhip"};
    return std::ranges::count_if(kTelling, [&](auto name) { return plain_.contains(std::string(name)); }) > 1;
  }

  /// The plain name with the side letter behind its stem exchanged; it has a letter there.
  static std::string mirrored(const std::string& name) {
    std::string plain = plain_marker_name(name);
    const auto side =
        std::ranges::find_if_not(plain.rbegin(), plain.rend(), [](char c) { return c >= '0' && c <= '9'; });
    *side = *side == 'l' ? 'r' : 'l';
    return plain;
  }

  std::span<const std::string> names_;
  std::set<std::string> plain_;
  bool keypoints_ = false;
};

/// Unused names of one spelling: exactly one on either side makes a pair.
using BySpelling = std::map<std::string, std::vector<std::string>>;

bool has_letter(std::string_view stem) {
  return std::ranges::any_of(stem, [](char c) { return c >= 'a' && c <= 'z'; });
}

/// The spelling of a name; empty where the side alone has letters ("L5" and "L.5").
std::string spelling_of(const std::string& name) {
  const auto readings = read_marker_name(name);
  const bool any = !readings.empty() && has_letter(readings.back().stem) && has_letter(readings.front().stem);
  return any ? plain_marker_name(name) : std::string();
}

class Search {
 public:
  Search(std::span<const std::string> wanted, std::span<const std::string> recorded)
      : wanted_names_(wanted), recorded_names_(recorded) {
    const std::vector<std::string> all(recorded.begin(), recorded.end());
    const NameIndex index(all);
    std::set<std::int64_t> taken;
    for (const auto& name : wanted) {
      const auto at = index.find(name);
      if (at >= 0)
        taken.insert(at);
      else if (!index.ambiguous(name))
        wanted_.push_back(name);
    }
    for (std::size_t m = 0; m < all.size(); ++m)
      if (!taken.contains(static_cast<std::int64_t>(m)) && !index.ambiguous(without_prefix(all[m])))
        recorded_.push_back(all[m]);
  }

  std::vector<LikelyPair> find() {
    pair_spellings();
    pair_landmarks();
    std::vector<LikelyPair> out;
    for (const auto& name : wanted_)
      if (const auto at = recorded_of_.find(name); at != recorded_of_.end())
        out.push_back({.recorded = at->second, .wanted = name});
    return out;
  }

 private:
  void take(const std::string& wanted, const std::string& recorded) {
    recorded_of_[wanted] = recorded;
    used_.insert(recorded);
  }

  void pair_spellings() {
    BySpelling wanted, recorded;
    for (const auto& name : wanted_) wanted[spelling_of(name)].push_back(name);
    for (const auto& name : recorded_) recorded[spelling_of(name)].push_back(name);
    for (const auto& [spelling, names] : wanted) {
      const auto same = recorded.find(spelling);
      if (!spelling.empty() && names.size() == 1 && same != recorded.end() && same->second.size() == 1)
        take(names.front(), same->second.front());
    }
  }

  using Place = std::pair<std::string_view, char>;
  using Best = std::map<Place, std::pair<std::size_t, std::string>>;

  // Of several names for one landmark of a side, the best; none where one of them has its partner already.
  template <class Open>
  static Best best_names(const Names& list, const Open& is_open) {
    Best best;
    std::set<Place> closed;
    for (const auto& name : list.all()) {
      const auto meaning = list.meaning(name);
      if (!meaning) continue;
      const Place place{meaning->landmark, meaning->side};
      if (!is_open(name)) {
        closed.insert(place);
        continue;
      }
      const auto [at, fresh] = best.try_emplace(place, meaning->rank, name);
      if (!fresh && meaning->rank < at->second.first) at->second = {meaning->rank, name};
    }
    for (const auto& place : closed) best.erase(place);
    return best;
  }

  void pair_landmarks() {
    const auto among = [](const std::vector<std::string>& list, const std::string& name) {
      return std::ranges::find(list, name) != list.end();
    };
    const auto wanted = best_names(wanted_names_, [&](const std::string& name) {
      return among(wanted_, name) && !recorded_of_.contains(name);
    });
    const auto recorded = best_names(recorded_names_, [&](const std::string& name) {
      return among(recorded_, name) && !used_.contains(name);
    });
    for (const auto& [place, name] : wanted)
      if (const auto same = recorded.find(place); same != recorded.end())
        take(name.second, same->second.second);
  }

  Names wanted_names_, recorded_names_;
  std::vector<std::string> wanted_, recorded_;  // that have no partner of the same name
  std::map<std::string, std::string> recorded_of_;
  std::set<std::string> used_;
};

}  // namespace

std::vector<LikelyPair> find_likely_pairs(std::span<const std::string> wanted,
                                          std::span<const std::string> recorded) {
  return Search(wanted, recorded).find();
}

std::string for_shell(std::string_view text) {
  constexpr std::string_view kSafe = "_-.,:=/+@%";
  const bool safe = !text.empty() && std::ranges::all_of(text, [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           kSafe.find(c) != std::string_view::npos;
  });
  if (safe) return std::string(text);
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

std::string rename_option(std::span<const LikelyPair> pairs) {
  std::string out, value;
  const auto add = [&] {
    if (!value.empty()) out += (out.empty() ? "--rename " : " --rename ") + for_shell(value);
    value.clear();
  };
  for (const auto& pair : pairs) {
    const bool sayable = !is_name_pattern(pair.recorded) && pair.recorded.find(',') == std::string::npos &&
                         pair.wanted.find_first_of(",=") == std::string::npos;
    if (!sayable) continue;
    const std::string said = pair.recorded + "=" + pair.wanted;
    if (value.size() + said.size() > kLongestValue) add();
    value += (value.empty() ? "" : ",") + said;
  }
  add();
  return out;
}

std::string rename_proposal(std::span<const std::string> wanted, std::span<const std::string> recorded) {
  const auto option = rename_option(find_likely_pairs(wanted, recorded));
  return option.empty() ? option : "; likely: " + option;
}

}  // namespace kinemark::data
