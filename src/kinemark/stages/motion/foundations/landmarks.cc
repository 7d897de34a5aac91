// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/motion/foundations/landmarks.h"

#include <algorithm>
#include <array>
#include <cctype>

#include "kinemark/data/name_index.h"

namespace kinemark::motion {
namespace {

using Eigen::Vector3d;

/// Kinds of places, by how well a finger finds them.
enum class Found : std::uint8_t {
  bone,     ///< a point of the skeleton under thin skin
  covered,  ///< a point of the skeleton under fat or muscle, or one that laboratories define differently
  spine,    ///< in the middle, at a height that laboratories count differently
  head,     ///< on a band or the skin, by habit
  toe,      ///< along the foot by habit, behind the joint of the toes or on them
  fore,     ///< along the foot by habit, on bones of the foot
  wand,     ///< on a line, its height by habit, and by Plug-in Gait's rule not the same on both sides
  side,     ///< one of a cluster whose name tells its side of the segment: upper, front, rear
  cluster,  ///< anywhere on the segment
};

// A marker of the toes 60 mm before their joint, which bends by 14 degrees (1 SD). In walks of seven
// laboratories the distance from heel to toe differs by 6 to 27 mm between 5 and 95 % of the frames.
const Vector3d kToesFlex_m(0.006, 0.015, 0.004);

PlaceSpread spread_of(Found found) {
  switch (found) {
    case Found::bone:
      return {Vector3d(0.012, 0.012, 0.012), Vector3d(0.007, 0.007, 0.006)};
    case Found::covered:
      return {Vector3d(0.022, 0.025, 0.020), Vector3d(0.010, 0.011, 0.010)};
    case Found::spine:
      return {Vector3d(0.040, 0.050, 0.010), Vector3d(0.010, 0.010, 0.010)};
    case Found::head:
      return {Vector3d(0.035, 0.035, 0.020), Vector3d(0.014, 0.012, 0.012)};
    case Found::toe:
      return {Vector3d(0.030, 0.012, 0.015), Vector3d(0.009, 0.007, 0.008), kToesFlex_m};
    case Found::fore:
      return {Vector3d(0.030, 0.012, 0.015), Vector3d(0.009, 0.007, 0.008)};
    case Found::wand:
      return {Vector3d(0.035, 0.060, 0.025), Vector3d(0.016, 0.060, 0.012)};
    case Found::side:
      return {Vector3d(0.040, 0.060, 0.040), Vector3d(0.020, 0.035, 0.020)};
    case Found::cluster:
      break;
  }
  return {Vector3d(0.070, 0.090, 0.070), Vector3d(0.035, 0.050, 0.035)};
}

/// Of markers above the pelvis: spines bend, and skin slides over shoulders and turned forearms.
Vector3d posture_of(BodyPart part) {
  switch (part) {
    case BodyPart::trunk:
      return Vector3d::Constant(0.008);
    case BodyPart::shoulder:
      return Vector3d::Constant(0.006);
    case BodyPart::head:
      return Vector3d::Constant(0.003);
    case BodyPart::upper_arm:
      return Vector3d::Constant(0.010);
    case BodyPart::forearm:
    case BodyPart::hand:
      return Vector3d::Constant(0.006);
    default:
      return Vector3d::Constant(0.0);
  }
}

struct Entry {
  std::string_view stems;  // between blanks
  BodyPart part;
  bool paired;
  double x, y, z;
  Found found;
};

using enum BodyPart;

// Heights and widths as in models/human.osim (tools/human_model.py).
constexpr std::array kEntries{
    Entry{" ASI ASIS IAS ", pelvis, true, 0.020, 0.010, 0.125, Found::covered},
    Entry{" FWT ", pelvis, true, 0.010, 0.030, 0.130, Found::covered},
    Entry{" PSI PSIS IPS ", pelvis, true, -0.155, 0.020, 0.045, Found::covered},
    Entry{" BWT ", pelvis, true, -0.145, 0.030, 0.060, Found::covered},
    Entry{" SACR SACRUM VSAC VSACRAL SAC ", pelvis, false, -0.165, 0.030, 0.0, Found::covered},
    Entry{" GT GTR FTC TROC TROCHANTER ", thigh, true, 0.000, -0.005, 0.090, Found::covered},
    Entry{" THI THIGH ", thigh, true, 0.010, -0.214, 0.090, Found::wand},
    Entry{" THAP ", thigh, true, 0.085, -0.266, 0.025, Found::wand},
    Entry{" THIGHUPPER ", thigh, true, 0.045, -0.190, 0.070, Found::side},
    Entry{" THIGHFRONT ANTFEM ", thigh, true, 0.100, -0.250, 0.005, Found::side},
    Entry{" THIGHREAR POSTFEM ", thigh, true, 0.025, -0.300, 0.070, Found::side},
    Entry{" TH1 TH2 TH3 TH4 THI1 THI2 THI3 THI4 F01 F02 F03 F04 F05 WAND1 ", thigh, true, 0.030, -0.220,
          0.070, Found::cluster},
    Entry{" KNE KNEE KNEELAT KNEELATERAL LFC LFE FLE LEK ", thigh, true, 0.000, -0.419, 0.055, Found::bone},
    Entry{" KNEMED KNEEMED KNEEMEDIAL MKN KNM MFC MFE FME MEK ", thigh, true, 0.000, -0.419, -0.055,
          Found::bone},
    Entry{" FAX ", shank, true, -0.020, -0.035, 0.050, Found::covered},
    Entry{" TTC TT ATT ", shank, true, 0.045, -0.055, 0.000, Found::covered},
    Entry{" TIB SHN SHA SHANK TIBIA ", shank, true, 0.020, -0.207, 0.050, Found::wand},
    Entry{" SHANKUPPER ", shank, true, -0.015, -0.080, 0.065, Found::side},
    Entry{" SHANKFRONT ANTTIB ", shank, true, 0.045, -0.140, 0.030, Found::side},
    Entry{" SHANKREAR POSTTIB ", shank, true, -0.030, -0.150, 0.075, Found::side},
    Entry{" TB1 TB2 TB3 TB4 SK1 SK2 SK3 SK4 T01 T02 T03 T04 T05 LEG1 LEG2 LEG3 LEG4 WAND2 ", shank, true,
          0.030, -0.210, 0.040, Found::cluster},
    Entry{" ANK ANKLE ANKLELAT ANKLELATERAL LMAL FAL LM MALL ", shank, true, -0.005, -0.426, 0.044,
          Found::bone},
    Entry{" MED ANKMED ANKLEMED ANKLEMEDIAL MMAL TAM MM SPH ", shank, true, 0.010, -0.416, -0.042,
          Found::bone},
    Entry{" HEE HEEL CAL FCC ", foot, true, -0.070, -0.022, 0.004, Found::covered},
    Entry{" TOE ", foot, true, 0.145, -0.024, 0.012, Found::toe},
    Entry{" MT2 MET ", foot, true, 0.145, -0.024, 0.012, Found::fore},
    Entry{" TOETIP TT2 ", foot, true, 0.185, -0.045, 0.005, Found::toe},
    Entry{" MT5 FM5 MFH5 TOELAT ", foot, true, 0.110, -0.045, 0.050, Found::fore},
    Entry{" MT1 FM1 MFH1 TOEMED ", foot, true, 0.130, -0.040, -0.035, Found::fore},
    Entry{" MIDFOOTSUP ", foot, true, 0.070, 0.005, 0.000, Found::fore},
    Entry{" MIDFOOTLAT ", foot, true, 0.045, -0.045, 0.040, Found::fore},
    Entry{" C7 CV7 ", trunk, false, -0.080, 0.425, 0.0, Found::spine},
    Entry{" T10 TV10 ", trunk, false, -0.100, 0.205, 0.0, Found::spine},
    Entry{" T8 TV8 ", trunk, false, -0.105, 0.270, 0.0, Found::spine},
    Entry{" CLAV SUP SNJ IJ ", trunk, false, 0.070, 0.340, 0.0, Found::spine},
    Entry{" STRN STERNUM STR ", trunk, false, 0.120, 0.225, 0.0, Found::spine},
    Entry{" SXS PX ", trunk, false, 0.110, 0.170, 0.0, Found::spine},
    Entry{" SHO ACR ACROMIUM ACROMION SHOULDER SAJ ", shoulder, true, -0.060, 0.060, 0.150, Found::covered},
    Entry{" FHD HDF TEMPLE TEMP ", head, true, 0.100, 0.150, 0.065, Found::head},
    Entry{" BHD HDB ", head, true, -0.080, 0.160, 0.060, Found::head},
    Entry{" UPA UA1 UA2 UA3 BICEP ARM1 ARM2 ARM3 ", upper_arm, true, 0.015, -0.150, 0.050, Found::cluster},
    Entry{" ELB ELBOW LEL LHE HLE ELBOWLAT ", upper_arm, true, 0.000, -0.324, 0.045, Found::covered},
    Entry{" MEL MHE HME ELBOWMED ", upper_arm, true, 0.000, -0.324, -0.045, Found::covered},
    Entry{" FRM FASUPERIOR FARM1 FARM2 FARM3 ", forearm, true, 0.020, -0.130, 0.030, Found::cluster},
    Entry{" WRA RS RSP FARADIUS WRISTLAT ", forearm, true, 0.005, -0.240, 0.035, Found::covered},
    Entry{" WRB US UHE FAULNA WRISTMED ", forearm, true, 0.000, -0.240, -0.035, Found::covered},
    Entry{" FIN HM2 HMH2 ", hand, true, -0.020, -0.080, 0.020, Found::covered},
    Entry{" HM5 HMH5 ", hand, true, -0.010, -0.070, -0.035, Found::covered},
};

const Entry* find_entry(std::string_view stem, bool paired) {
  if (stem.empty()) return nullptr;
  const std::string wanted = " " + std::string(stem) + " ";
  const auto found = std::ranges::find_if(kEntries, [&](const Entry& entry) {
    return entry.paired == paired && entry.stems.find(wanted) != std::string_view::npos;
  });
  return found == kEntries.end() ? nullptr : &*found;
}

Side side_of(char letter) { return letter == 'L' ? Side::left : letter == 'R' ? Side::right : Side::middle; }

std::string plain(std::string_view name) {
  std::string out;
  for (const char c : data::without_prefix(name))
    if (c != '.' && c != '_' && c != '-' && c != ' ')
      out.push_back(static_cast<char>(std::toupper(static_cast<unsigned char>(c))));
  return out;
}

}  // namespace

SidedName split_marker_name(std::string_view name) {
  const std::string whole = plain(name);
  if (whole.empty() || find_entry(whole, false) != nullptr) return {Side::middle, whole};
  const Side first = side_of(whole.front()), last = side_of(whole.back());
  const std::string behind = whole.substr(1), before = whole.substr(0, whole.size() - 1);
  if (first != Side::middle && find_entry(behind, true) != nullptr) return {first, behind};
  // "ASIS_R": without the stroke, "LFEL" would be a right knee's point on the left.
  const bool apart = name.size() > 2 && !std::isalnum(static_cast<unsigned char>(name[name.size() - 2]));
  if (apart && last != Side::middle && find_entry(before, true) != nullptr) return {last, before};
  if (first != Side::middle && whole.size() > 1) return {first, behind};
  return {Side::middle, whole};
}

std::optional<Landmark> landmark_of(std::string_view name) {
  const auto [side, stem] = split_marker_name(name);
  const Entry* entry = find_entry(stem, side != Side::middle);
  if (entry == nullptr) return std::nullopt;
  Landmark out{.part = entry->part,
               .side = side,
               .x_in_part = Vector3d(entry->x, entry->y, entry->z),
               .spread = spread_of(entry->found)};
  out.spread.by_posture = out.spread.by_posture.cwiseMax(posture_of(entry->part));
  return out;
}

}  // namespace kinemark::motion
