// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/marker_sets.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/text.h"
#include "kinemark/data/marker_name.h"

namespace kinemark::data {
namespace {

constexpr double kLeastOfSet = 0.7, kLeastOfRecording = 0.6;
constexpr double kNearlyWhole = 0.9,
                 kLeastBesideOthers = 0.3;  // a whole set among markers of another purpose
constexpr std::int64_t kFewest = 7, kFewestTelling = 2;
constexpr std::size_t kMissingShown = 12;

constexpr std::string_view kGaitArms = "FHD BHD SHO UPA ELB FRM WRA WRB FIN";
constexpr std::string_view kGaitTrunk = "C7 T10 CLAV STRN RBAK";
constexpr std::string_view kGaitStatic = "KNEM|KNM|KNEMED|MKNE ANKM|MED|ANKMED|MANK KAX KD1 KD2 MT5";
constexpr std::string_view kCgmStatic = "KNM|KNEM MED|ANKM FMH VMH SMH";
constexpr std::string_view kIorMore =
    "FME|ME TAM|MM FM2|SMH SAE|SAJ HDF HDB HLE HME USP RSP HM2 HM5 UHE SCAP WAND1 WAND2";
constexpr std::string_view kFace = "eye ear";
constexpr std::string_view kHayesStatic =
    "Knee.Medial|KneeMed Ankle.Medial|AnkleMed PSIS Foot.Medial Foot.Lateral";

// Sources. Plug-in Gait, upper limb: Vicon's Plug-in Gait Reference Guide and Upper Limb Model Product Guide.
// CGM2: tracking markers of pyCGM2, models 2.3 to 2.5. CMU: the 41 markers of its recordings. Helen Hayes:
// Kadaba et al. 1990, J Orthop Res 8:383, as Cortex spells it. IOR: Leardini et al. 2007, Gait Posture
// 26:560. OpenSim: marker sets of its models gait2354, gait2392 and Rajagopal2016. OpenCap: markers of its
// augmenter. Theia: rotations of its C3D. Keypoints: documentation of OpenPose, AlphaPose, COCO and
// MediaPipe.
constexpr std::array kSets = {
    KnownMarkerSet{.name = "Plug-in Gait",
                   .part = "full body",
                   .left = "L",
                   .right = "R",
                   .paired = "FHD BHD SHO UPA ELB FRM WRA WRB FIN ASI PSI|=SACR THI KNE TIB ANK HEE TOE",
                   .middle = kGaitTrunk,
                   .optional_paired = kGaitStatic,
                   .optional_middle = "SACR"},
    KnownMarkerSet{.name = "Plug-in Gait",
                   .part = "lower body",
                   .left = "L",
                   .right = "R",
                   .paired = "ASI PSI|=SACR THI KNE TIB ANK HEE TOE",
                   .middle = "",
                   .optional_paired = kGaitStatic,
                   .optional_middle = "SACR"},
    KnownMarkerSet{.name = "Plug-in Gait",
                   .part = "upper body",
                   .left = "L",
                   .right = "R",
                   .paired = kGaitArms,
                   .middle = kGaitTrunk},
    KnownMarkerSet{.name = "CGM2",
                   .part = "full body",
                   .left = "L",
                   .right = "R",
                   .paired = "FHD BHD SHO UPA ELB FRM WRA WRB FIN ASI PSI THI THAP|THIAP THAD|THIAD KNE TIB "
                             "TIAP|TIBAP TIAD|TIBAD ANK HEE TOE",
                   .middle = kGaitTrunk,
                   .optional_paired = kCgmStatic},
    KnownMarkerSet{.name = "CGM2",
                   .part = "lower body",
                   .left = "L",
                   .right = "R",
                   .paired = "ASI PSI THI THAP|THIAP THAD|THIAD KNE TIB TIAP|TIBAP TIAD|TIBAD ANK HEE TOE",
                   .middle = "",
                   .optional_paired = kCgmStatic},
    KnownMarkerSet{.name = "CMU",
                   .part = "",
                   .left = "L",
                   .right = "R",
                   .paired = "FHD BHD SHO UPA ELB FRM WRA WRB FIN FWT BWT THI KNE SHN ANK HEE TOE MT5",
                   .middle = "C7 T10 CLAV STRN RBAC"},
    KnownMarkerSet{.name = "Vicon upper limb",
                   .part = "",
                   .left = "L",
                   .right = "R",
                   .paired = "SHO UPA|UPA1 UPB|UPA2 UPC|UPA3 ELB WRA WRB FIN",
                   .middle = "C7 T10 CLAV STRN",
                   .optional_paired = "MEP FRA FRM BAK",
                   .one_side = true},
    KnownMarkerSet{
        .name = "Helen Hayes",
        .part = "full body",
        .left = "L.",
        .right = "R.",
        .paired =
            "Shoulder|SHO Elbow|ELB Wrist|WRI ASIS|ASI Thigh|THI Knee|KNE Shank|SHA Ankle|ANK Heel|HEE Toe",
        .middle = "Top.Head Front.Head Rear.Head V.Sacral|Sacrum|Sacral|VSAC",
        .optional_paired = kHayesStatic,
        .optional_middle = "R.Offset ROFF"},
    KnownMarkerSet{.name = "Helen Hayes",
                   .part = "lower body",
                   .left = "L.",
                   .right = "R.",
                   .paired = "ASIS|ASI Thigh|THI Knee|KNE Shank|SHA Ankle|ANK Heel|HEE Toe",
                   .middle = "V.Sacral|Sacrum|Sacral|VSAC",
                   .optional_paired = kHayesStatic},
    KnownMarkerSet{.name = "IOR",
                   .part = "lower body",
                   .left = "L_",
                   .right = "R_",
                   .paired = "IAS IPS FTC|GT FLE|LE FAX|HF TTC|TT FAL|LM FCC|CA FM1|FMH FM5|VMH",
                   .middle = "",
                   .optional_paired = kIorMore},
    KnownMarkerSet{.name = "IOR",
                   .part = "lower body and trunk",
                   .left = "L_",
                   .right = "R_",
                   .paired = "IAS IPS FTC|GT FLE|LE FAX|HF TTC|TT FAL|LM FCC|CA FM1|FMH FM5|VMH",
                   .middle = "CV7|C7 TV10|T10|TV8|MAI SXS|PX SJN|SNJ|SUP|IJ",
                   .optional_paired = kIorMore},
    KnownMarkerSet{.name = "OpenSim gait2354 and gait2392",
                   .part = "",
                   .left = "L.",
                   .right = "R.",
                   .paired = "Acromium|Acromion ASIS Thigh.Upper Thigh.Front Thigh.Rear Knee.Lat Shank.Upper "
                             "Shank.Front Shank.Rear Ankle.Lat Heel Midfoot.Sup Midfoot.Lat Toe.Tip",
                   .middle = "Sternum Top.Head V.Sacral",
                   .optional_paired =
                       "Knee.Med Ankle.Med Toe.Lat Toe.Med Bicep Elbow Wrist.Med Wrist.Lat PSIS "
                       "Elbow.Lat Elbow.Med Forearm"},
    KnownMarkerSet{
        .name = "OpenSim Rajagopal2016",
        .part = "",
        .left = "L",
        .right = "R",
        .paired =
            "ACR ASH PSH UA1 UA2 UA3 LEL MEL FAsuperior FAradius FAulna ASI PSI TH1 TH2 TH3 LFC MFC TB1 "
            "TB2 TB3 LMAL MMAL CAL TOE MT5",
        .middle = "C7 CLAV",
        .optional_paired = "SJC EJC HJC KJC AJC TH4 _tibial_plateau"},
    KnownMarkerSet{
        .name = "OpenCap",
        .part = "",
        .left = "L",
        .right = "r",
        .paired =
            "_shoulder_study .ASIS_study .PSIS_study _knee_study _mknee_study _ankle_study _mankle_study "
            "_calc_study _toe_study _5meta_study _lelbow_study _melbow_study _lwrist_study _mwrist_study "
            "_thigh1_study _thigh2_study _thigh3_study _sh1_study _sh2_study _sh3_study",
        .middle = "C7_study",
        .optional_paired = "HJC_study Shoulder Hip Knee Ankle Heel SmallToe BigToe Elbow Wrist Eye Ear",
        .optional_middle = "Neck midHip Nose Head"},
    KnownMarkerSet{.name = "OpenPose BODY_25",
                   .part = "",
                   .left = "L",
                   .right = "R",
                   .paired = "Shoulder Elbow Wrist Hip Knee Ankle Eye Ear BigToe SmallToe Heel",
                   .middle = "Nose Neck MidHip|CHip",
                   .telling = kFace,
                   .keypoints = true},
    KnownMarkerSet{.name = "HALPE 26",
                   .part = "",
                   .left = "L",
                   .right = "R",
                   .paired = "Shoulder Elbow Wrist Hip Knee Ankle Eye Ear BigToe SmallToe Heel",
                   .middle = "Nose Neck Head Hip",
                   .telling = kFace,
                   .keypoints = true},
    KnownMarkerSet{.name = "COCO 17",
                   .part = "",
                   .left = "left_",
                   .right = "right_",
                   .paired = "eye ear shoulder elbow wrist hip knee ankle",
                   .middle = "nose",
                   .telling = kFace,
                   .keypoints = true},
    KnownMarkerSet{.name = "MediaPipe BlazePose",
                   .part = "",
                   .left = "left_",
                   .right = "right_",
                   .paired =
                       "eye_inner eye eye_outer ear mouth shoulder elbow wrist pinky index thumb hip knee "
                       "ankle heel foot_index",
                   .middle = "nose",
                   .keypoints = true},
    KnownMarkerSet{.name = "Theia",
                   .part = "",
                   .left = "l_",
                   .right = "r_",
                   .paired = "thigh_4X4 shank_4X4 foot_4X4 toes_4X4 clavicle_4X4 uarm_4X4 larm_4X4 hand_4X4",
                   .middle = "pelvis_4X4 torso_4X4 neck_4X4 head_4X4",
                   .optional_middle = "worldbody_4X4 abdomen_4X4 pelvis_shifted_4X4",
                   .keypoints = true},
};

/// Side and stem.
using Key = std::pair<char, std::string>;

std::vector<std::string_view> split(std::string_view text, char at) {
  std::vector<std::string_view> out;
  while (!text.empty()) {
    const auto end = std::min(text.find(at), text.size());
    if (end > 0) out.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return out;
}

std::string plain_stem(std::string_view spelled) {
  const auto readings = read_marker_name(spelled);
  return readings.empty() ? std::string() : readings.front().stem;
}

/// A marker of a set: all that may be its name.
struct Wanted {
  std::string shown;
  char side = ' ';
  std::vector<Key> keys{};
};

/// The markers of a list of stems; '=' before a spelling: a name without a side stands for both.
std::vector<Wanted> paired_markers(const KnownMarkerSet& set, std::string_view stems) {
  std::vector<Wanted> out;
  for (const char side : {'l', 'r'})
    for (const auto entry : split(stems, ' ')) {
      const auto spellings = split(entry, '|');
      Wanted wanted{.shown = std::string(side == 'l' ? set.left : set.right), .side = side};
      wanted.shown += spellings.front();
      for (const auto spelling : spellings)
        wanted.keys.push_back(spelling.front() == '=' ? Key{' ', plain_stem(spelling)}
                                                      : Key{side, plain_stem(spelling)});
      out.push_back(std::move(wanted));
    }
  return out;
}

std::vector<Wanted> middle_markers(std::string_view names) {
  std::vector<Wanted> out;
  for (const auto entry : split(names, ' ')) {
    const auto spellings = split(entry, '|');
    Wanted wanted{.shown = std::string(spellings.front())};
    // "R.Offset" and "RBAK" are of one side alone.
    for (const auto spelling : spellings)
      for (const auto& reading : read_marker_name(spelling))
        wanted.keys.emplace_back(reading.side, reading.stem);
    out.push_back(std::move(wanted));
  }
  return out;
}

/// The readings of a recording's names, once for all sets.
class Recorded {
 public:
  Recorded(std::span<const std::string> names, std::span<const std::uint8_t> apart) {
    std::set<std::string> seen;
    for (std::size_t m = 0; m < names.size(); ++m) {
      std::vector<Key> keys;
      for (const auto& reading : read_marker_name(names[m])) keys.emplace_back(reading.side, reading.stem);
      if (keys.empty() || !seen.insert(plain_marker_name(names[m])).second) continue;
      all_.insert(keys.begin(), keys.end());
      keys_.push_back(std::move(keys));
      apart_.push_back(m < apart.size() && apart[m] != 0);
    }
  }

  [[nodiscard]] bool has(const Wanted& wanted) const {
    return std::ranges::any_of(wanted.keys, [&](const Key& key) { return all_.contains(key); });
  }

  /// Share of the names that are among the keys, without those apart that are not.
  [[nodiscard]] double share_explained(const std::set<Key>& keys) const {
    double explained = 0.0, others = 0.0;
    for (std::size_t m = 0; m < keys_.size(); ++m) {
      const bool known = std::ranges::any_of(keys_[m], [&](const Key& key) { return keys.contains(key); });
      explained += known ? 1.0 : 0.0;
      others += known || apart_[m] ? 0.0 : 1.0;
    }
    return explained > 0.0 ? explained / (explained + others) : 0.0;
  }

 private:
  std::set<Key> all_;
  std::vector<std::vector<Key>> keys_;
  std::vector<bool> apart_;
};

struct Judged {
  FoundMarkerSet found;
  double nearness = 0.0;  // harmonic mean of both shares; 0: it is not the set
};

Judged judge(const KnownMarkerSet& set, const Recorded& recorded) {
  auto wanted = paired_markers(set, set.paired);
  if (set.one_side) {
    const auto seen = [&](char side) {
      return std::ranges::any_of(wanted, [&](const Wanted& w) { return w.side == side && recorded.has(w); });
    };
    const char only = seen('l') == seen('r') ? ' ' : seen('l') ? 'l' : 'r';
    if (only != ' ') std::erase_if(wanted, [&](const Wanted& w) { return w.side != only; });
  }
  for (auto& middle : middle_markers(set.middle)) wanted.push_back(std::move(middle));
  Judged out{.found = {.set = &set, .markers = std::ssize(wanted), .missing = {}}};
  std::set<Key> keys;
  for (const auto& marker : wanted) {
    keys.insert(marker.keys.begin(), marker.keys.end());
    if (!recorded.has(marker)) out.found.missing.push_back(marker.shown);
  }
  const auto telling = paired_markers(set, set.telling);
  const auto found_telling = std::ranges::count_if(telling, [&](const Wanted& w) { return recorded.has(w); });
  if (!telling.empty() && found_telling < kFewestTelling) return out;
  for (const auto& marker : paired_markers(set, set.optional_paired))
    keys.insert(marker.keys.begin(), marker.keys.end());
  for (const auto& marker : middle_markers(set.optional_middle))
    keys.insert(marker.keys.begin(), marker.keys.end());
  const std::int64_t there = out.found.markers - std::ssize(out.found.missing);
  const double of_set = static_cast<double>(there) / static_cast<double>(out.found.markers);
  const double of_recording = recorded.share_explained(keys);
  const double least = of_set >= kNearlyWhole ? kLeastBesideOthers : kLeastOfRecording;
  if (there >= kFewest && of_set >= kLeastOfSet && of_recording >= least)
    out.nearness = 2.0 * of_set * of_recording / (of_set + of_recording);
  return out;
}

}  // namespace

std::span<const KnownMarkerSet> known_marker_sets() { return kSets; }

std::string FoundMarkerSet::title() const {
  return set->part.empty() ? std::string(set->name) : fmt::format("{}, {}", set->name, set->part);
}

std::string FoundMarkerSet::describe() const {
  if (missing.empty()) return fmt::format("{}: all of its {}", title(), counted(markers, "marker"));
  return fmt::format("{}: {} of {} markers, without {}", title(), markers - std::ssize(missing), markers,
                     join_some(missing, kMissingShown));
}

std::optional<FoundMarkerSet> find_marker_set(std::span<const std::string> names,
                                              std::span<const std::uint8_t> apart) {
  const Recorded recorded(names, apart);
  Judged best;
  bool equal = false;
  for (const auto& set : kSets) {
    auto judged = judge(set, recorded);
    if (judged.nearness <= 0.0 || judged.nearness < best.nearness) continue;
    equal = judged.nearness == best.nearness;
    if (!equal) best = std::move(judged);
  }
  if (best.nearness <= 0.0 || equal) return std::nullopt;
  return std::move(best.found);
}

}  // namespace kinemark::data
