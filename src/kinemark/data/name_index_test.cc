// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/name_index.h"

#include <gmock/gmock.h>

namespace kinemark::data {
namespace {

using testing::EndsWith;

const std::vector<std::string> kNames = {"Ann:WRA", "SHO",     "UPA",   "Bob:UPA",
                                         "Ann:ELB", "Bob:ELB", "A:B:C", "Ann:"};

TEST(NameIndex, AnExactNameWinsOverOneBehindAPrefix) {
  const NameIndex index(kNames);
  EXPECT_EQ(index.find("SHO"), 1);
  EXPECT_EQ(index.find("UPA"), 2) << "Bob:UPA ends in it too";
  EXPECT_EQ(index.find("Bob:UPA"), 3);
  EXPECT_FALSE(index.ambiguous("UPA"));
}

TEST(NameIndex, AUniqueNameIsFoundBehindItsPrefix) {
  const NameIndex index(kNames);
  EXPECT_EQ(index.find("WRA"), 0);
  EXPECT_EQ(index.find("C"), 6) << "behind the last colon";
  EXPECT_EQ(index.find("B:C"), -1) << "a part of a prefix is no name";
  EXPECT_EQ(index.find("RA"), -1) << "a part of a name is none";
  EXPECT_EQ(index.find(""), -1);
}

TEST(NameIndex, TwoSubjectsWithTheNameAreNotGuessedBetween) {
  const NameIndex index(kNames);
  EXPECT_EQ(index.find("ELB"), -1);
  EXPECT_TRUE(index.ambiguous("ELB"));
  EXPECT_EQ(index.find("Bob:ELB"), 5);
}

TEST(NameIndex, NamesWhatIsThereInstead) {
  EXPECT_EQ(NameIndex(kNames).instead_of("ELB"), "Ann:ELB, Bob:ELB (several subjects: need the full name)");
  EXPECT_EQ(NameIndex({"A", "B"}).instead_of("KNE"), "A, B");
  EXPECT_EQ(NameIndex({}).instead_of("KNE"), "none");
  std::vector<std::string> many;
  for (char c = 'a'; c <= 'n'; ++c) many.emplace_back(1, c);
  EXPECT_THAT(NameIndex(many).instead_of("KNE"), EndsWith("k, l, and 2 more"));
}

TEST(NameIndex, WithoutPrefixIsWhatFollowsTheLastColon) {
  EXPECT_EQ(without_prefix("Ann:LASI"), "LASI");
  EXPECT_EQ(without_prefix("A:B:C"), "C");
  EXPECT_EQ(without_prefix("LASI"), "LASI");
  EXPECT_EQ(without_prefix("Ann:"), "");
}

}  // namespace
}  // namespace kinemark::data
