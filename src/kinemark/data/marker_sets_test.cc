// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/marker_sets.h"

#include <gmock/gmock.h>

#include <sstream>

namespace kinemark::data {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Names = std::vector<std::string>;

Names words(const std::string& text) {
  std::istringstream stream(text);
  Names out;
  for (std::string word; stream >> word;) out.push_back(word);
  return out;
}

/// Both sides of stems between blanks, and names of the middle.
Names both(const std::string& left, const std::string& right, const std::string& stems,
           const std::string& middle = "") {
  Names out = words(middle);
  for (const auto& stem : words(stems)) {
    out.push_back(left + stem);
    out.push_back(right + stem);
  }
  return out;
}

std::string title_of(const Names& names) {
  const auto found = find_marker_set(names);
  return found ? found->title() : "none";
}

const std::string kLegs = "ASI PSI THI KNE TIB ANK HEE TOE";
const std::string kArms = "FHD BHD SHO UPA ELB FRM WRA WRB FIN";
const std::string kTrunk = "C7 T10 CLAV STRN RBAK";
const std::string kJoints = "Shoulder Elbow Wrist Hip Knee Ankle Eye Ear BigToe SmallToe Heel";

TEST(MarkerSets, PartsOfPlugInGait) {
  EXPECT_EQ(title_of(both("L", "R", kLegs)), "Plug-in Gait, lower body");
  EXPECT_EQ(title_of(both("L", "R", kArms, kTrunk)), "Plug-in Gait, upper body");
  EXPECT_EQ(title_of(both("L", "R", kArms + " " + kLegs, kTrunk)), "Plug-in Gait, full body");
  EXPECT_EQ(title_of(both("L", "R", kLegs + " THAP THAD TIAP TIAD")), "CGM2, lower body");
}

TEST(MarkerSets, SpellingsOfSidesPrefixesAndCase) {
  EXPECT_EQ(title_of(both("Ann:left_", "Ann:right_", "asi psi thi kne tib ank hee toe")),
            "Plug-in Gait, lower body");
  EXPECT_EQ(title_of(both("L.", "R.", kLegs)), "Plug-in Gait, lower body");
  EXPECT_EQ(title_of(both("Left ", "Right ", kJoints, "Nose Neck MidHip")), "OpenPose BODY_25");
  EXPECT_EQ(title_of(both("Left_", "Right_", kJoints, "Nose Neck MidHip")), "OpenPose BODY_25");
}

TEST(MarkerSets, KeypointsThatShareNames) {
  EXPECT_EQ(title_of(both("L", "R", kJoints, "Nose Neck MidHip")), "OpenPose BODY_25");
  EXPECT_EQ(title_of(both("L", "R", kJoints, "Nose Neck Head Hip")), "HALPE 26");
  EXPECT_EQ(title_of(both("left_", "right_", "eye ear shoulder elbow wrist hip knee ankle", "nose")),
            "COCO 17");
}

TEST(MarkerSets, JointsWithoutAFaceAreNoKeypoints) {
  EXPECT_EQ(title_of(both("left_", "right_", "shoulder elbow wrist hip knee ankle", "head neck")), "none");
  EXPECT_EQ(title_of(both("left_", "right_", "eye shoulder elbow wrist hip knee ankle")), "COCO 17");
}

TEST(MarkerSets, HelenHayesInFourLetters) {
  const std::string stems = "SHO ELB WRI ASI THI KNE SHA ANK HEE TOE";
  EXPECT_EQ(title_of(both("L", "R", stems, "VSAC ROFF")), "Helen Hayes, full body");
  EXPECT_EQ(title_of(both("L", "R", "ASI THI KNE SHA ANK HEE TOE", "VSAC")), "Helen Hayes, lower body");
  EXPECT_EQ(title_of(both("L", "R", "ASI THI KNE TIB ANK HEE TOE", "SACR")), "Plug-in Gait, lower body");
}

TEST(MarkerSets, WhatIsMissingIsNamedAsTheSetSpellsIt) {
  Names names = both("R.", "L.", kLegs);
  std::erase(names, "R.TOE");
  std::erase(names, "L.PSI");
  const auto found = find_marker_set(names);
  ASSERT_TRUE(found);
  EXPECT_THAT(found->missing, ElementsAre("LPSI", "RTOE"));
  EXPECT_EQ(found->markers, 16);
  EXPECT_EQ(found->describe(), "Plug-in Gait, lower body: 14 of 16 markers, without LPSI, RTOE");
  const auto whole = find_marker_set(both("L", "R", kLegs));
  ASSERT_TRUE(whole);
  EXPECT_THAT(whole->missing, IsEmpty());
  EXPECT_EQ(whole->describe(), "Plug-in Gait, lower body: all of its 16 markers");
  // One sacral marker stands for both of the back.
  EXPECT_THAT(find_marker_set(both("L", "R", "ASI THI KNE TIB ANK HEE TOE", "SACR"))->missing, IsEmpty());
}

TEST(MarkerSets, OneArmIsEnoughWhereASetIsUsedSo) {
  const Names arm = words("C7 T10 CLAV STRN RSHO RUPA RUPB RUPC RELB RWRA RWRB RFIN");
  EXPECT_EQ(title_of(arm), "Vicon upper limb");
  EXPECT_EQ(find_marker_set(arm)->markers, 12);
}

TEST(MarkerSets, OtherNamesAreOfNoSet) {
  EXPECT_EQ(title_of({}), "none");
  EXPECT_EQ(title_of(words("M1 M2 M3 M4 M5 M6 M7 M8 M9 M10 M11 M12")), "none");
  EXPECT_EQ(title_of(words("RASI RPSI RTHI RKNE RTIB RANK RHEE RTOE")), "none") << "one leg";
  EXPECT_EQ(title_of(both("L", "R", "ASI PSI", "C7 T10 CLAV STRN")), "none");
}

TEST(MarkerSets, MostOfTheMarkersMustBeOfIt) {
  Names names = both("L", "R", kLegs);
  for (int i = 0; i < 20; ++i) names.push_back("extra" + std::to_string(i));
  EXPECT_EQ(title_of(names), "Plug-in Gait, lower body") << "a whole set among others";
  Names part = names;
  std::erase(part, "LTHI");
  std::erase(part, "RTHI");
  EXPECT_EQ(title_of(part), "none");
  part.resize(14 + 9);
  EXPECT_EQ(title_of(part), "Plug-in Gait, lower body");
  for (int i = 20; i < 60; ++i) names.push_back("extra" + std::to_string(i));
  EXPECT_EQ(title_of(names), "none");
  // Points that a model computed explain nothing and need no explanation.
  std::vector<std::uint8_t> apart(names.size(), 0);
  for (std::size_t m = 16; m < names.size(); ++m) apart[m] = 1;
  ASSERT_TRUE(find_marker_set(names, apart));
  EXPECT_EQ(find_marker_set(names, apart)->title(), "Plug-in Gait, lower body");
}

TEST(MarkerSets, EverySetIsFoundByItsOwnNames) {
  for (const auto& set : known_marker_sets()) {
    Names names;
    for (const auto* const text : {&set.paired, &set.middle})
      for (const auto& entry : words(std::string(*text))) {
        const std::string name = entry.substr(0, entry.find('|'));
        if (text == &set.middle) {
          names.push_back(name);
          continue;
        }
        names.push_back(std::string(set.left) + name);
        names.push_back(std::string(set.right) + name);
      }
    const auto found = find_marker_set(names);
    ASSERT_TRUE(found) << set.name;
    EXPECT_EQ(found->set, &set) << set.name << ", " << set.part;
    EXPECT_THAT(found->missing, IsEmpty()) << set.name;
  }
}

}  // namespace
}  // namespace kinemark::data
