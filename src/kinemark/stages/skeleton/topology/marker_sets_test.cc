// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/skeleton/topology/marker_sets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

namespace kinemark::skeleton {
namespace {

std::string said(std::string_view name) {
  const auto place = find_marker_place(name);
  if (!place) return "nothing";
  const std::string part = name_of(place->part, place->side);
  return place->site == MarkerSite::segment
             ? part
             : (place->site == MarkerSite::joint ? "below " : "end of ") + part;
}

TEST(MarkerSets, EveryNameOfTheTableIsFoundAsItsOwnRow) {
  for (const auto& row : marker_set_rows()) {
    std::istringstream names{std::string(row.names)};
    for (std::string name; names >> name;) {
      std::ranges::replace(name, '#', '1');
      const auto place = find_marker_place(row.sided ? "R" + name : name);
      ASSERT_TRUE(place) << name;
      EXPECT_EQ(place->part, row.part) << name;
      EXPECT_EQ(place->site, row.site) << name;
      EXPECT_EQ(place->set, row.set) << name;
    }
  }
}

TEST(MarkerSets, NamesOfManyMakers) {
  EXPECT_EQ(said("LASI"), "pelvis");
  EXPECT_EQ(said("Ann:RTHI"), "thigh_r");
  EXPECT_EQ(said("R.Thigh.Upper"), "thigh_r");
  EXPECT_EQ(said("R.Knee.Medial"), "below thigh_r");
  EXPECT_EQ(said("L_IAS"), "pelvis");
  EXPECT_EQ(said("L_FTC"), "thigh_l");
  EXPECT_EQ(said("r asis"), "pelvis");
  EXPECT_EQ(said("RFAsuperior"), "forearm_r");
  EXPECT_EQ(said("ForearmL2"), "forearm_l");
  EXPECT_EQ(said("RightScapula3"), "scapula_r");
  EXPECT_EQ(said("TopHead"), "head");
}

TEST(MarkerSets, NamesThatLookAlike) {
  EXPECT_EQ(said("LF01"), "thigh_l");
  EXPECT_EQ(said("LFA1"), "forearm_l");
  EXPECT_EQ(said("RSH1"), "shank_r");
  EXPECT_EQ(said("RSHO"), "below thorax");
  EXPECT_EQ(said("LHF"), "shank_l");
  EXPECT_EQ(said("LLE"), "end of thigh_l");
  EXPECT_EQ(said("LLM"), "end of shank_l");
  EXPECT_EQ(said("SACR"), "pelvis");
  EXPECT_EQ(said("L.ACR"), "below thorax");
  EXPECT_EQ(said("LT01"), "shank_l");
  EXPECT_EQ(said("T10"), "thorax");
}

TEST(MarkerSets, OtherNamesSayNothing) {
  for (const char* name :
       {"", "M1", "marker12", "L", "R", "s0m0", "u0", "f3", "THI", "LTHIX", "XLTHI", "*12", "Foot_Marker1"})
    EXPECT_EQ(said(name), "nothing") << name;
}

TEST(MarkerSets, WhatModelsWriteIsRecognised) {
  const std::vector<std::string> outputs{"PELO",
                                         "RFOO",
                                         "LFEP",
                                         "RTIA",
                                         "LTI_MO",
                                         "HEDL",
                                         "RHJC",
                                         "Bob:LKJC",
                                         "LHipAngles",
                                         "RKneePower",
                                         "LeftHipCenterScore",
                                         "Mid_ASIS",
                                         "LGroundReactionForce"};
  for (const auto flag : find_model_outputs(outputs)) EXPECT_TRUE(flag);
  const std::vector<std::string> markers{"LASI",          "LTOE",  "LTIB",  "RFIN", "HEAD",
                                         "R.Midfoot.Sup", "LTIAP", "STERN", "CLAV", "RASHv",
                                         "RUPA",          "RFRA",  "M1",    "LELB", "SACR"};
  const auto found = find_model_outputs(markers);
  for (std::size_t i = 0; i < markers.size(); ++i) EXPECT_FALSE(found[i]) << markers[i];
  // A copy is one beside its original alone.
  const std::vector<std::string> both{"RASH", "RASHv"};
  EXPECT_EQ(find_model_outputs(both), (std::vector<std::uint8_t>{0, 1}));
}

}  // namespace
}  // namespace kinemark::skeleton
