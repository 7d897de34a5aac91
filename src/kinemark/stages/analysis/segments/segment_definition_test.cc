// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/segment_definition.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/stages/analysis/segments/testing/formulas.h"

namespace kinemark::analysis {
namespace {

using analysis::testing::of;
using ::testing::HasSubstr;

SegmentDefinition small() {
  SegmentDefinition d;
  d.parameters.push_back({.name = "length"});
  d.segments.push_back({.name = "s", .origin = of("A"), .first_along = of("B"), .second_along = of("C")});
  d.angles.push_back({.name = "a", .parent = "lab", .child = "s"});
  return d;
}

std::string trouble(const SegmentDefinition& d) { return d.check() ? "" : d.check().error().message; }

TEST(SegmentDefinition, ChecksNames) {
  EXPECT_EQ(trouble(small()), "");
  auto d = small();
  d.points.push_back({.name = "s", .formula = of("A")});
  EXPECT_THAT(trouble(d), HasSubstr("segment 's': the name stands for something else already"));
  d = small();
  d.points.push_back({.name = "lab", .formula = of("A")});
  EXPECT_THAT(trouble(d), HasSubstr("point 'lab'"));
  d = small();
  d.parameters.push_back({});
  EXPECT_THAT(trouble(d), HasSubstr("a parameter has no name"));
  d = small();
  d.values.push_back({.name = "a", .formula = of("1")});
  EXPECT_THAT(trouble(d), HasSubstr("a name of its own"));
}

TEST(SegmentDefinition, AllowsOneEntryForEachKindOfTrial) {
  auto d = small();
  d.points.push_back({.name = "p", .formula = of("A"), .trial = InTrial::fixed});
  d.points.push_back({.name = "p", .formula = of("B"), .trial = InTrial::moving});
  EXPECT_EQ(trouble(d), "");
  d.points.push_back({.name = "p", .formula = of("B"), .trial = InTrial::any});
  EXPECT_THAT(trouble(d), HasSubstr("point 'p'"));
}

TEST(SegmentDefinition, ChecksSegments) {
  auto d = small();
  d.angles[0].parent = "pelvis";
  EXPECT_THAT(trouble(d), HasSubstr("angle 'a': no segment is called 'pelvis'"));
  d = small();
  d.landmarks.push_back({.name = "l", .segment = "pelvis", .formula = of("A"), .trial = "static"});
  EXPECT_THAT(trouble(d), HasSubstr("landmark 'l': no segment"));
  d = small();
  d.segments[0].second = 0;
  EXPECT_THAT(trouble(d), HasSubstr("both directions are for one axis"));
  EXPECT_THAT(trouble(SegmentDefinition{}), HasSubstr("nothing to compute"));
}

TEST(SegmentDefinition, NamesQuantities) {
  for (const char* word : {"number", "length", "angle", "mass"})
    EXPECT_EQ(to_string(subject_quantity_of(word).value()), word);
  EXPECT_FALSE(subject_quantity_of("speed"));
}

}  // namespace
}  // namespace kinemark::analysis
