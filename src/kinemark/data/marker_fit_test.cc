// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/data/marker_fit.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

namespace kinemark::data {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

MarkerFit fit() {
  MarkerFit fit;
  fit.markers = {{.name = "A", .body = "thigh"}, {.name = "B", .name_in_data = "Ann:B", .seen = 1.0}};
  fit.excluded = {
      {"C", std::string(kNeverSeen)}, {"D", std::string(kNotInModel)}, {"E", std::string(kNeverSeen)}};
  return fit;
}

TEST(MarkerFit, NothingIsKnownAtFirst) {
  const MarkerFit empty;
  EXPECT_TRUE(empty.validate());
  EXPECT_TRUE(std::isnan(empty.rms_error_m)) << "what is not known passes no gate";
  EXPECT_TRUE(std::isnan(empty.mean_error_m.norm()));
  EXPECT_TRUE(std::isnan(empty.max_loop_gap_m));
  EXPECT_TRUE(std::isnan(FittedMarker{}.total_sd_m()));
}

TEST(MarkerFit, BothPartsOfTheNoiseAddAsVariances) {
  EXPECT_DOUBLE_EQ((FittedMarker{.noise_sd_m = 0.003, .common_sd_m = 0.004}).total_sd_m(), 0.005);
  EXPECT_TRUE(std::isnan((FittedMarker{.noise_sd_m = 0.003}).total_sd_m()));
}

TEST(MarkerFit, ListsWhoWasLeftOutForAReason) {
  EXPECT_THAT(fit().excluded_as(kNeverSeen), ElementsAre("C", "E"));
  EXPECT_THAT(fit().excluded_as(kNotInModel), ElementsAre("D"));
  EXPECT_THAT(fit().excluded_as(kNoWeight), IsEmpty());
}

TEST(MarkerFit, ValidateNamesTheMarkerAndWhatIsWrong) {
  EXPECT_TRUE(fit().validate());
  const auto message = [](const std::function<void(MarkerFit&)>& spoil) {
    MarkerFit bad = fit();
    spoil(bad);
    const auto status = bad.validate();
    return status ? std::string("nothing") : status.error().message;
  };
  EXPECT_THAT(message([](auto& f) { f.markers[1].name.clear(); }), HasSubstr("used marker 2 has no name"));
  EXPECT_THAT(message([](auto& f) { f.markers[1].name = "A"; }), HasSubstr("'A' is listed twice"));
  EXPECT_THAT(message([](auto& f) { f.markers[0].weight = -1.0; }), HasSubstr("weight -1; need 0 or more"));
  EXPECT_THAT(message([](auto& f) { f.markers[0].weight = kNaN; }), HasSubstr("need 0 or more"));
  EXPECT_THAT(message([](auto& f) { f.markers[0].seen = 1.01; }), HasSubstr("need 0 to 1"));
  EXPECT_THAT(message([](auto& f) { f.markers[0].common_sd_m = -1e-3; }), HasSubstr("negative"));
  EXPECT_THAT(message([](auto& f) { f.excluded[0].why.clear(); }),
              HasSubstr("'C' needs a name and a reason"));
}

}  // namespace
}  // namespace kinemark::data
