// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/clean_account.h"

#include <gmock/gmock.h>
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

TEST(CleanAccount, SaysWhatDoesNotFitAndNothingElse) {
  using testing::AnyOf;
  using testing::HasSubstr;
  using testing::Not;
  const auto message = [](auto change) {
    CleanAccount account = account_of_two();
    change(account);
    const auto status = account.validate();
    return status ? std::string() : status.error().message;
  };
  const auto upsampling = message([](CleanAccount& a) { a.upsampling.markers.resize(1); }),
             smoothed = message([](CleanAccount& a) { a.markers.resize(3); }),
             stranger = message([](CleanAccount& a) { a.defects[0].finding.partner = "C"; }),
             far = message([](CleanAccount& a) { a.gaps[0].marker = 2; }),
             whole = message([](CleanAccount&) {});
  EXPECT_EQ(upsampling, "account of cleaning: upsampling tells of 1 markers; there are 2");
  EXPECT_THAT(upsampling,
              Not(AnyOf(HasSubstr("markers were smoothed; there are"), HasSubstr("' has no frames"),
                        HasSubstr("' is of no marker here"), HasSubstr("a gap of marker"))));
  EXPECT_EQ(smoothed, "account of cleaning: 3 markers were smoothed; there are 2");
  EXPECT_THAT(smoothed, Not(HasSubstr("upsampling tells of")));
  EXPECT_EQ(stranger, "account of cleaning: a defect of 'A' and 'C' is of no marker here");
  EXPECT_EQ(far, "account of cleaning: a gap of marker 2 in frames 5 to 9 does not fit 2 markers");
  EXPECT_EQ(message([](CleanAccount& a) {
              a.defects[1].finding.first_frame = a.defects[1].finding.last_frame = -1;
            }),
            "account of cleaning: a defect of '' has no frames");
  EXPECT_EQ(whole, "");
}

TEST(CleanAccount, NamesMarkersAndNobodyForAll) {
  EXPECT_EQ(account_of_two().name_of(1), "B");
  EXPECT_EQ(account_of_two().name_of(-1), "");
  EXPECT_ANY_THROW((void)account_of_two().name_of(2));
}

TEST(GapAccount, BothEndsBelongToIt) { EXPECT_EQ(account_of_two().gaps[0].frames(), 5); }

}  // namespace
}  // namespace kinemark::data
