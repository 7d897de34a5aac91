// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/clean_account.h"

#include <gtest/gtest.h>

namespace kinemark::data {
namespace {

CleanAccount account_of_two() {
  CleanAccount account;
  account.names = {"A", "B"};
  account.upsampling.markers.resize(2);
  account.upsampling.marker_bands.resize(2);
  account.defects = {{.finding = {.kind = FindingKind::label_swap,
                                  .subject = "A",
                                  .partner = "B",
                                  .first_frame = 0,
                                  .last_frame = 0}},
                     {.finding = {.kind = FindingKind::clock_jump, .first_frame = 3, .last_frame = 3}}};
  account.gaps = {{.marker = 1, .first_frame = 5, .last_frame = 9}};
  account.markers = {{.name = "A"}};
  return account;
}

TEST(CleanAccount, ValidatesWhatFits) {
  const auto status = account_of_two().validate();
  EXPECT_TRUE(status) << status.error().message;
  EXPECT_TRUE(CleanAccount{}.validate());
}

TEST(CleanAccount, RefusesMarkersThatAreNotThereAndFramesThatRunBack) {
  const auto refused = [](auto change) {
    CleanAccount account = account_of_two();
    change(account);
    return !account.validate();
  };
  EXPECT_TRUE(refused([](CleanAccount& a) { a.gaps[0].marker = 2; }));
  EXPECT_TRUE(refused([](CleanAccount& a) { a.gaps[0].marker = -1; })) << "a gap belongs to one marker";
  EXPECT_TRUE(refused([](CleanAccount& a) { a.gaps[0].last_frame = 4; }));
  EXPECT_TRUE(refused([](CleanAccount& a) { a.defects[0].finding.partner = "C"; }));
  EXPECT_TRUE(refused([](CleanAccount& a) { a.defects[0].finding.subject = "b"; }));
  EXPECT_TRUE(refused([](CleanAccount& a) { a.defects[1].finding.last_frame = 2; }));
  EXPECT_TRUE(refused([](CleanAccount& a) {
    a.defects[1].finding.first_frame = a.defects[1].finding.last_frame = -1;
  })) << "a defect is of samples";
  EXPECT_TRUE(refused([](CleanAccount& a) { a.markers.resize(3); }));
  EXPECT_TRUE(refused([](CleanAccount& a) { a.upsampling.markers.resize(1); }));
}

TEST(CleanAccount, NamesMarkersAndNobodyForAll) {
  EXPECT_EQ(account_of_two().name_of(1), "B");
  EXPECT_EQ(account_of_two().name_of(-1), "");
  EXPECT_ANY_THROW((void)account_of_two().name_of(2));
}

TEST(GapAccount, BothEndsBelongToIt) { EXPECT_EQ(account_of_two().gaps[0].frames(), 5); }

}  // namespace
}  // namespace kinemark::data
