// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/marker_sets.h"

#include <algorithm>
#include <array>
#include <cstddef>

namespace kinemark::skeleton {
namespace {

constexpr std::string_view kPlugInGait = "Plug-in Gait", kUpperLimb = "Vicon upper limb",
                           kHayes = "Helen Hayes", kCast = "CAST", kIsb = "ISB", kWords = "names of segments";
using enum BodyPart;
using enum MarkerSite;

// Sources. Plug-in Gait and upper limb: Vicon's Plug-in Gait Reference Guide, with the medial markers and the
// knee alignment device; BWT, FWT, SHN, RBAC: the same body in the recordings of CMU. Helen Hayes: Kadaba et
// al. 1990, J Orthop Res 8:383, as OpenSim's models spell it. CAST: Cappozzo et al. 1995, Clin Biomech
// 10:171; Rizzoli: Leardini et al. 2007, Gait Posture 26:560; Qualisys: the animation and CAST sets of its
// manual. ISB: landmarks of Wu et al. 2002 and 2005, J Biomech 35:543, 38:981.
constexpr std::array kRows = {
    MarkerSetRow{kPlugInGait, head, segment, true, "FHD BHD"},
    MarkerSetRow{kPlugInGait, thorax, segment, false, "C7 T10 CLAV STRN RBAK LBAK RBAC"},
    MarkerSetRow{kPlugInGait, thorax, joint, true, "SHO"},
    MarkerSetRow{kPlugInGait, pelvis, segment, true, "ASI PSI BWT FWT"},
    MarkerSetRow{kPlugInGait, pelvis, segment, false, "SACR"},
    MarkerSetRow{kPlugInGait, thigh, segment, true, "THI THIA THAP THAD"},
    MarkerSetRow{kPlugInGait, thigh, joint, true, "KNE KNEM KNEIN KNM KNEMED MKNE MKN KAX KD1 KD2"},
    MarkerSetRow{kPlugInGait, shank, segment, true, "TIB TIBA TIAP TIAD SHN"},
    MarkerSetRow{kPlugInGait, shank, joint, true, "ANK ANKM ANKIN MANK MED ANKMED"},
    MarkerSetRow{kPlugInGait, foot, segment, true, "HEE TOE"},
    MarkerSetRow{kUpperLimb, upper_arm, segment, true, "UPA UPA# UPB UPC PUA# LUA#"},
    MarkerSetRow{kUpperLimb, upper_arm, joint, true, "ELB ELBL ELBM MEP MELB LELB"},
    MarkerSetRow{kUpperLimb, forearm, segment, true, "FRA FRM FRM#"},
    MarkerSetRow{kUpperLimb, forearm, joint, true, "WRA WRB WR WRI MWRI LWRI"},
    MarkerSetRow{kUpperLimb, hand, segment, true, "FIN FIN#"},
    MarkerSetRow{kHayes, head, segment, false, "TOPHEAD"},
    MarkerSetRow{kHayes, head, segment, true, "TEMPLE"},
    MarkerSetRow{kHayes, thorax, segment, false, "STERNUM STERN"},
    MarkerSetRow{kHayes, thorax, joint, true, "ACROMIUM ACROMION SHOULDER SHA SHP ACR ASH PSH"},
    MarkerSetRow{kHayes, pelvis, segment, true, "ASIS PSIS"},
    MarkerSetRow{kHayes, pelvis, segment, false, "VSACRAL VSAC SACRUM SACRAL MPSI SAC"},
    MarkerSetRow{kHayes, thigh, segment, true, "THIGH THIGHUPPER THIGHFRONT THIGHREAR"},
    MarkerSetRow{kHayes, thigh, joint, true, "KNEE KNEELAT KNEEMED KNEEMEDIAL KNEELATERAL"},
    MarkerSetRow{kHayes, shank, segment, true, "SHANK SHANKUPPER SHANKFRONT SHANKREAR"},
    MarkerSetRow{kHayes, shank, joint, true, "ANKLE ANKLELAT ANKLEMED ANKLEMEDIAL ANKLELATERAL"},
    MarkerSetRow{kHayes, foot, segment, true,
                 "HEEL TOELAT TOEMED TOETIP MIDFOOTSUP MIDFOOTLAT FOOTMEDIAL FOOTLATERAL"},
    MarkerSetRow{kHayes, upper_arm, segment, true, "BICEP"},
    MarkerSetRow{kHayes, upper_arm, joint, true, "ELBOW ELBOWLAT ELBOWMED"},
    MarkerSetRow{kHayes, forearm, segment, true, "FOREARM FASUPERIOR"},
    MarkerSetRow{kHayes, forearm, landmark, true, "FARADIUS FAULNA"},
    MarkerSetRow{kHayes, forearm, joint, true, "WRIST WRISTMED WRISTLAT"},
    MarkerSetRow{kCast, thigh, segment, true, "TH# THI# F# FEM# GT GTR FTC TROC GTROC"},
    MarkerSetRow{kCast, thigh, landmark, true, "FLE FME LFE MFE LE ME LFC MFC LEPI MEPI"},
    MarkerSetRow{kCast, shank, segment, true,
                 "SK# SH# SHN# TB# TI# TIB# T# LEG# HF FAX TTC TT ATT SPH FH TTUB"},
    MarkerSetRow{kCast, shank, landmark, true, "LM MM LMAL MMAL FAL TAM"},
    MarkerSetRow{kCast, foot, segment, true,
                 "CA CAL CAL# FCC FM# MFH# MT# MTP# SM VM TT2 FT# D1M D5M P1M P5M STL CPG HLX HALLUX"},
    MarkerSetRow{kCast, pelvis, segment, true, "IAS IPS ILC ILCR ILIACCREST"},
    MarkerSetRow{kCast, head, segment, false, "HV OCC SEL GLAB"},
    MarkerSetRow{kCast, head, segment, true, "TEMP"},
    MarkerSetRow{kCast, thorax, joint, true, "SAE SAJ"},
    MarkerSetRow{kIsb, thorax, segment, false,
                 "IJ PX T8 T12 SUP STR MCLAV XI XIP XIPH SJN SXS CV7 TV2 TV8 TV10 MAI JN SN"},
    MarkerSetRow{kIsb, upper_arm, segment, true, "ARM# AMR# UA# UARM# HUM# SPUA SLUA"},
    MarkerSetRow{kIsb, upper_arm, joint, true, "EL EM LHE MHE HLE HME LEL MEL"},
    MarkerSetRow{kIsb, forearm, segment, true, "FARM# FA# ULN#"},
    MarkerSetRow{kIsb, forearm, joint, true, "RS US RSP USP RSTYL USTYL"},
    MarkerSetRow{kIsb, hand, segment, true, "HMH# HM# MC# MCP#"},
    MarkerSetRow{kIsb, scapula, segment, true, "AA TS AI PC ACC"},
    MarkerSetRow{kIsb, clavicle, segment, true, "SC AC"},
    MarkerSetRow{kWords, thigh, segment, true, "THIGH# FEMUR#"},
    MarkerSetRow{kWords, shank, segment, true, "SHANK# TIBIA# LOWERLEG#"},
    MarkerSetRow{kWords, foot, segment, true, "FOOT#"},
    MarkerSetRow{kWords, upper_arm, segment, true, "UPPERARM# HUMERUS#"},
    MarkerSetRow{kWords, upper_arm, joint, true, "LATERALEPICONDYLE MEDIALEPICONDYLE"},
    MarkerSetRow{kWords, forearm, segment, true, "FOREARM#"},
    MarkerSetRow{kWords, hand, segment, true, "HAND# GLOVE#"},
    MarkerSetRow{kWords, scapula, segment, true, "SCAPULA# SCAP#"},
    MarkerSetRow{kWords, pelvis, segment, false, "PELVIS#"},
    MarkerSetRow{kWords, thorax, segment, false, "THORAX# TRUNK#"},
    MarkerSetRow{kWords, head, segment, false, "HEAD#"},
};

constexpr std::array<std::string_view, 11> kParts{"head",     "thorax",    "pelvis",  "scapula",
                                                  "clavicle", "upper_arm", "forearm", "hand",
                                                  "thigh",    "shank",     "foot"};

/// Ends and middles of what models write, and whole names.
constexpr std::array<std::string_view, 9> kOutputWords{"ANGLE",  "POWER",  "MOMENT",     "FORCE",  "GRF",
                                                       "CENTER", "CENTRE", "PROJECTION", "VIRTUAL"};
constexpr std::array<std::string_view, 12> kBones{"PEL", "HED", "TRX", "FE", "TI", "FO",
                                                  "TO",  "CL",  "HU",  "RA", "HN", "UL"};
constexpr std::array<std::string_view, 7> kCentres{"HJC", "KJC", "AJC", "SJC", "EJC", "WJC", "FJC"};

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_side(char c) { return c == 'L' || c == 'R'; }

std::string plain(std::string_view name) {
  if (const auto colon = name.rfind(':'); colon != std::string_view::npos) name.remove_prefix(colon + 1);
  std::string out;
  for (const char c : name)
    if (c != ' ' && c != '.' && c != '_' && c != '-')
      out += c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  for (const std::string_view word : {"LEFT", "RIGHT"})
    if (out.starts_with(word)) out.replace(0, word.size(), 1, word.front());
  return out;
}

bool fits(std::string_view pattern, std::string_view name) {
  if (!pattern.ends_with('#')) return pattern == name;
  pattern.remove_suffix(1);
  if (!name.starts_with(pattern)) return false;
  name.remove_prefix(pattern.size());
  return (name.size() == 1 || name.size() == 2) && std::ranges::all_of(name, is_digit);
}

bool lists(std::string_view patterns, std::string_view name) {
  while (!patterns.empty()) {
    const auto blank = std::min(patterns.find(' '), patterns.size());
    if (fits(patterns.substr(0, blank), name)) return true;
    patterns.remove_prefix(std::min(blank + 1, patterns.size()));
  }
  return false;
}

/// The row of a name whose side has been taken off; of names without a side those of the middle.
const MarkerSetRow* find_row(std::string_view name, bool sided) {
  const auto found = std::ranges::find_if(
      kRows, [&](const auto& row) { return row.sided == sided && lists(row.names, name); });
  return found == kRows.end() ? nullptr : &*found;
}

/// "THIGHL2" as "LTHIGH2"; empty where no side stands behind a word of three letters or more.
std::string side_first(std::string_view name) {
  std::size_t digits = name.size();
  while (digits > 0 && is_digit(name[digits - 1])) --digits;
  if (digits < 4 || !is_side(name[digits - 1])) return {};
  std::string out{name[digits - 1]};
  out += name.substr(0, digits - 1);
  out += name.substr(digits);
  return out;
}

/// An origin or an axis' end of a bone: PELO, LFEA, RTI_MP.
bool is_bone_axis(std::string_view name) {
  if (name.size() < 4 || std::string_view("OALP").find(name.back()) == std::string_view::npos) return false;
  name.remove_suffix(1);
  const auto bone = [](std::string_view stem) {
    const bool sided = is_side(stem.front());
    return std::ranges::any_of(
        kBones, [&](std::string_view b) { return b.size() == 3 ? stem == b : sided && stem.substr(1) == b; });
  };
  return bone(name) || (name.back() == 'M' && bone(name.substr(0, name.size() - 1)));
}

}  // namespace

std::span<const MarkerSetRow> marker_set_rows() { return kRows; }

std::string name_of(BodyPart part, BodySide side) {
  std::string out(kParts[static_cast<std::size_t>(part)]);
  if (side != BodySide::none) out += side == BodySide::left ? "_l" : "_r";
  return out;
}

std::optional<MarkerPlace> find_marker_place(std::string_view name) {
  const std::string whole = plain(name);
  const auto place = [](const MarkerSetRow& row, char side) {
    return MarkerPlace{.part = row.part,
                       .side = side == 'L'   ? BodySide::left
                               : side == 'R' ? BodySide::right
                                             : BodySide::none,
                       .site = row.site,
                       .set = row.set};
  };
  // The side of head, trunk and pelvis tells markers apart, not bodies.
  const auto of_side = [&](const std::string& sided) -> std::optional<MarkerPlace> {
    if (sided.size() < 2 || !is_side(sided.front())) return {};
    const auto* row = find_row(std::string_view(sided).substr(1), true);
    if (row == nullptr) return {};
    const bool middle = row->part == head || row->part == thorax || row->part == pelvis;
    return place(*row, middle ? ' ' : sided.front());
  };
  if (const auto* row = find_row(whole, false)) return place(*row, ' ');
  if (auto found = of_side(whole)) return found;
  return of_side(side_first(whole));
}

std::vector<std::uint8_t> find_model_outputs(std::span<const std::string> names) {
  std::vector<std::string> plain_names;
  for (const auto& name : names) plain_names.push_back(plain(name));
  std::vector<std::uint8_t> out;
  for (const auto& name : plain_names) {
    const bool word = std::ranges::any_of(
        kOutputWords, [&](std::string_view w) { return name.find(w) != std::string::npos; });
    const bool centre = name.size() == 4 && is_side(name.front()) &&
                        std::ranges::find(kCentres, std::string_view(name).substr(1)) != kCentres.end();
    const bool middle = name.starts_with("MID") && name.size() > 3 && !name.starts_with("MIDFOOT");
    const bool copy = name.size() > 2 && name.back() == 'V' &&
                      std::ranges::find(plain_names, name.substr(0, name.size() - 1)) != plain_names.end();
    out.push_back(word || centre || middle || copy || is_bone_axis(name));
  }
  return out;
}

}  // namespace kinemark::skeleton
