// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/internal/lacks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace kinemark::analysis::internal {
namespace {

using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::vector<std::string> sentences(std::vector<std::set<std::string>> lacks,
                                   const std::vector<std::string>& names,
                                   const std::vector<std::string>& markers = {"LASI", "LKNE"}) {
  SegmentDefinition definition;
  definition.parameters.push_back({.name = "Width"});
  SegmentGraph graph;
  graph.lacks = std::move(lacks);
  return lack_sentences(definition, names, graph, markers);
}

TEST(Lacks, OutputsThatLackTheSameAreNamedTogether) {
  const auto said = sentences({{"C7", "T10"}, {}, {"C7", "T10"}}, {"spine", "knee", "thorax"});
  EXPECT_THAT(said, ElementsAre("Not computed: spine, thorax; there is no marker 'C7', 'T10'."));
  EXPECT_THAT(said, Each(Not(HasSubstr("each needs one of them or more"))));
}

TEST(Lacks, WhatSharesAMissingMarkerIsOneSentence) {
  EXPECT_THAT(
      sentences({{"LBHD"}, {"C7"}, {"C7", "LBHD"}, {"LRAD", "Width"}}, {"head", "thorax", "neck", "wrist"}),
      ElementsAre("Not computed: head, neck, thorax; there is no marker 'C7', 'LBHD', and each needs one of "
                  "them or more.",
                  "Not computed: wrist; there is no marker 'LRAD', no value of 'Width'."));
}

TEST(Lacks, NamesThatDifferAreProposedAsAnOption) {
  const auto said = sentences({{"LHEE", "RHEE"}}, {"foot"}, {"Left Heel", "R.Heel", "LKNE"});
  ASSERT_EQ(said.size(), 2U);
  EXPECT_EQ(said[1], "Likely: --rename 'Left Heel=LHEE,R.Heel=RHEE'");
  EXPECT_THAT(sentences({{"LHEE"}}, {"foot"}, {"R.Heel"}), ::testing::SizeIs(1))
      << "of the other side, nothing";
}

TEST(Lacks, NothingIsSaidWhereNothingIsMissingOrNothingIsNamed) {
  EXPECT_THAT(sentences({{}, {"C7"}}, {"knee", ""}), IsEmpty());
}

}  // namespace
}  // namespace kinemark::analysis::internal
