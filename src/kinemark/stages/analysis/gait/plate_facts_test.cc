// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/gait/plate_facts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/stages/analysis/gait/testing/known_walk.h"

namespace kinemark::analysis {
namespace {

using data::Side;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::KnownWalk;
using ::testing::Not;

/// Two steps on two plates, of a body of 71.4 kg.
class PlateFacts : public ::testing::Test {
 protected:
  PlateFacts()
      : markers_(walk_.markers(0.0003, 3)),
        smoother_(GaitSmoother::create(markers_, find_gait_markers(markers_).value(), 0.0).value()),
        plates_{.time = markers_.time,
                .items = {walk_.plate("plate 1", Side::left, 2), walk_.plate("plate 2", Side::right, 2)}} {}
  [[nodiscard]] std::vector<std::string> said(double mass_kg) const {
    return contradicted_plates(plates_, smoother_.paths(), smoother_.upright(), walk_.stride_s, mass_kg);
  }
  void scale(double factor) {
    for (auto& plate : plates_.items)
      for (auto& newtons : plate.force) newtons *= factor;
  }

  KnownWalk walk_;
  data::Trajectories markers_;
  GaitSmoother smoother_;
  data::Wrenches plates_;
};

TEST_F(PlateFacts, AStepBearsTheBodyForHalfAStride) {
  const auto masses = borne_masses(plates_, smoother_.paths(), smoother_.upright(), walk_.stride_s);
  ASSERT_EQ(masses.size(), 2U);
  for (const double kg : masses) EXPECT_NEAR(kg, walk_.weight_n / 9.81, 0.15 * walk_.weight_n / 9.81);
  EXPECT_THAT(borne_masses(plates_, smoother_.paths(), smoother_.upright(), kNaN), IsEmpty());
}

TEST_F(PlateFacts, NothingIsSaidOfForcesThatBearTheBody) {
  EXPECT_THAT(said(71.4), IsEmpty());
  EXPECT_THAT(said(62.0), IsEmpty());
  EXPECT_THAT(said(kNaN), IsEmpty());
}

TEST_F(PlateFacts, AnotherMassThanTheStatedOneIsSaid) {
  for (const double factor : {3.0, 0.1}) {
    scale(factor);
    EXPECT_THAT(said(71.4), ElementsAre(HasSubstr("times the mass of the body as it is stated, 71.4 kg")));
    scale(1.0 / factor);
  }
  EXPECT_THAT(said(71.4), Not(Contains(HasSubstr("times the mass of the body as it is stated"))));
}

TEST_F(PlateFacts, NobodysMassIsSaidWhereNoneIsStated) {
  scale(10.0);
  EXPECT_THAT(said(kNaN), ElementsAre(HasSubstr("kg, which is nobody's mass: the unit or the scale")));
  scale(0.1);
  EXPECT_THAT(said(kNaN), Not(Contains(HasSubstr("kg, which is nobody's mass: the unit or the scale"))));
}

TEST_F(PlateFacts, APlateBesideTheWalkIsNamed) {
  for (std::size_t f = 1; f < plates_.items[1].point.size(); f += 3) plates_.items[1].point[f] += 1.2;
  for (std::size_t f = 0; f < plates_.items[1].point.size(); f += 3) plates_.items[1].point[f] += 1.2;
  const auto moved = said(71.4);
  ASSERT_EQ(moved.size(), 1U);
  EXPECT_THAT(moved[0], HasSubstr("plate 2 is loaded where no foot stands: the nearer one is"));
  plates_.items.pop_back();
  EXPECT_THAT(said(71.4), Not(Contains(HasSubstr("is loaded where no foot stands: the nearer one is"))));
}

}  // namespace
}  // namespace kinemark::analysis
