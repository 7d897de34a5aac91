// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/likely_pairs.h"

#include <gmock/gmock.h>

namespace kinemark::data {
namespace {

using ::testing::IsEmpty;

using Names = std::vector<std::string>;
using Pairs = std::vector<LikelyPair>;

TEST(LikelyPairs, OneNameInTwoSpellings) {
  const Names wanted{"R_Foo3", "LFOO3", "C7"}, recorded{"left foo3", "C7", "RFoo3", "Bar"};
  EXPECT_EQ(find_likely_pairs(wanted, recorded), (Pairs{{"RFoo3", "R_Foo3"}, {"left foo3", "LFOO3"}}));
}

TEST(LikelyPairs, TwoNamesForOneLandmark) {
  const Names model{"R.Heel", "L.Heel", "R.Knee.Lat", "R.Knee.Med", "Sternum", "R.Thigh.Upper"};
  const Names recorded{"LHEE", "RHEE", "RKNE", "RKNM", "STRN", "RTHI"};
  EXPECT_EQ(find_likely_pairs(model, recorded), (Pairs{{"RHEE", "R.Heel"},
                                                       {"LHEE", "L.Heel"},
                                                       {"RKNE", "R.Knee.Lat"},
                                                       {"RKNM", "R.Knee.Med"},
                                                       {"STRN", "Sternum"}}));
}

TEST(LikelyPairs, NeverTheOtherSide) {
  EXPECT_THAT(find_likely_pairs(Names{"R.Heel"}, Names{"LHEE", "HEEL", "heel"}), IsEmpty());
  // LLM is the lateral malleolus of the left, RLM of the right; LM is of neither.
  EXPECT_EQ(find_likely_pairs(Names{"RANK", "LANK"}, Names{"LLM", "RLM"}),
            (Pairs{{"RLM", "RANK"}, {"LLM", "LANK"}}));
  EXPECT_THAT(find_likely_pairs(Names{"LANK", "RANK"}, Names{"LM"}), IsEmpty());
  // A letter behind a name is a side where the other one is there.
  EXPECT_EQ(find_likely_pairs(Names{"LHEE"}, Names{"CALCR", "CALCL"}), (Pairs{{"CALCL", "LHEE"}}));
  EXPECT_THAT(find_likely_pairs(Names{"LHEE"}, Names{"CALCL"}), IsEmpty());
}

TEST(LikelyPairs, AMarkerThatIsThereIsNoBetterUnderAnotherName) {
  // The knee of the model is there: its second marker of the knee is not the recording's second one.
  EXPECT_THAT(find_likely_pairs(Names{"RKNE", "RLFC"}, Names{"RKNE", "RKNEE"}), IsEmpty());
  EXPECT_THAT(find_likely_pairs(Names{"RKNE"}, Names{"Ann:RKNE", "RLFC"}), IsEmpty());
}

TEST(LikelyPairs, SeveralPeopleAreNotMixed) {
  EXPECT_THAT(find_likely_pairs(Names{"R.Heel"}, Names{"Ann:RHEE", "Bob:RHEE"}), IsEmpty());
  EXPECT_EQ(find_likely_pairs(Names{"R.Heel"}, Names{"Ann:RHEE"}), (Pairs{{"Ann:RHEE", "R.Heel"}}));
}

TEST(LikelyPairs, KeypointsAreJointsNotSkin) {
  const Names keypoints{"Nose", "REye", "LEye", "RKnee", "LKnee", "RHip"};
  EXPECT_EQ(find_likely_pairs(Names{"RKNE", "RKJC", "RHJC"}, keypoints),
            (Pairs{{"RKnee", "RKJC"}, {"RHip", "RHJC"}}));
  EXPECT_EQ(find_likely_pairs(Names{"RKNE", "RKJC"}, Names{"R.Knee", "L.Knee"}), (Pairs{{"R.Knee", "RKNE"}}));
}

TEST(LikelyPairs, MarkersBesideKeypointsAreStillOnSkin) {
  const Names open_cap{"Neck",  "midHip", "RBigToe",      "LBigToe",
                       "RKnee", "LKnee",  "r_knee_study", "L_knee_study"};
  EXPECT_EQ(find_likely_pairs(Names{"RLFC", "LLFC"}, open_cap),
            (Pairs{{"r_knee_study", "RLFC"}, {"L_knee_study", "LLFC"}}));
}

TEST(LikelyPairs, AVertebraIsNoSide) { EXPECT_THAT(find_likely_pairs(Names{"L.5"}, Names{"L5"}), IsEmpty()); }

TEST(RenameOption, IsReadyForAShell) {
  EXPECT_EQ(rename_option(Pairs{{"RHEE", "R.Heel"}, {"LHEE", "L.Heel"}}), "--rename RHEE=R.Heel,LHEE=L.Heel");
  EXPECT_EQ(rename_option(Pairs{{"Right Heel", "RHEE"}}), "--rename 'Right Heel=RHEE'");
  EXPECT_EQ(rename_option(Pairs{{"Ann's:RHEE", "R.Heel"}}), "--rename 'Ann'\\''s:RHEE=R.Heel'");
  EXPECT_EQ(rename_option(Pairs{}), "");
  const std::string longer(120, 'x');
  EXPECT_EQ(rename_option(Pairs{{longer, "A"}, {longer, "B"}}),
            "--rename " + longer + "=A --rename " + longer + "=B");
  // What the option cannot say.
  EXPECT_EQ(rename_option(Pairs{{"a,b", "c"}, {"*1", "c"}, {"a", "b=c"}}), "");
  EXPECT_EQ(rename_proposal(Names{"R.Heel"}, Names{"RHEE"}), "; likely: --rename RHEE=R.Heel");
  EXPECT_EQ(rename_proposal(Names{"R.Heel"}, Names{"LHEE"}), "");
}

}  // namespace
}  // namespace kinemark::data
