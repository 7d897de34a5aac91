// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stages/analysis/segments/segment_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "kinemark/stages/analysis/segments/testing/formulas.h"

namespace kinemark::analysis {
namespace {

using analysis::testing::of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Markers A to D and the parameter p; a definition with points that need each other.
Result<SegmentGraph> graph_of(const std::string& text, StepType type, const SegmentDefinition& d = {}) {
  const Formula formula = of(text);
  const GraphNames names{
      .has_marker = [](const std::string& n) { return n.size() == 1 && n >= "A" && n <= "D"; },
      .has_parameter = [](const std::string& n) { return n == "p"; }};
  const GraphOutput output{.formula = &formula, .type = type, .what = "it"};
  return build_graph(d, names, std::span(&output, 1));
}

double value_of(const std::string& text) {
  const auto graph = graph_of(text, StepType::number);
  std::vector<StepValue> values(graph.value().steps.size());
  graph->evaluate(values);
  return values[static_cast<std::size_t>(graph->outputs[0])][0];
}

TEST(SegmentGraph, ComputesWithNumbersAndVectors) {
  EXPECT_DOUBLE_EQ(value_of("2 + 3 * 4 - 6 / -2"), 17.0);
  EXPECT_DOUBLE_EQ(value_of("mean(1, 2, 6) + sqrt(16) + abs(-2)"), 9.0);
  EXPECT_NEAR(value_of("sin(pi / 6) + cos(0) + atan2(1, 1)"), 1.5 + 0.78539816339744831, 1e-15);
  EXPECT_DOUBLE_EQ(value_of("dot(vector(1, 2, 3), 2 * vector(0, 1, 0) * 2)"), 8.0);
  EXPECT_DOUBLE_EQ(value_of("z(cross(vector(1, 0, 0), vector(0, 1, 0)))"), 1.0);
  EXPECT_DOUBLE_EQ(value_of("length(-vector(3, 4, 0)) + distance(vector(1, 1, 1), vector(1, 1, 3))"), 7.0);
  EXPECT_DOUBLE_EQ(value_of("x(unit(vector(3, 0, 4)) + vector(1, 2, 3) / 2 - vector(0.1, 0, 0))"), 1.0);
  EXPECT_NEAR(value_of("angle(vector(1, 0, 0), vector(0, 2, 0))"), 1.5707963267948966, 1e-15);
  EXPECT_DOUBLE_EQ(value_of("dot(mean(vector(1, 0, 0), vector(0, 0, 5)), up) + y(in(lab, vector(1, 2, 3)))"),
                   4.5);
  EXPECT_DOUBLE_EQ(value_of("z(at(lab, 1, 2, 3)) + x(lab.x) + length(lab.o)"), 4.0);
}

TEST(SegmentGraph, KnowsWhatDependsOnWhat) {
  SegmentDefinition d;
  d.parameters.push_back({.name = "p"});
  const auto graph = graph_of("mean(C, A) + p * (A - B)", StepType::vector, d);
  ASSERT_TRUE(graph) << graph.error().message;
  EXPECT_THAT(graph->markers, ElementsAre("A", "B", "C"));
  EXPECT_THAT(graph->parameters, ElementsAre("p"));
  EXPECT_THAT(graph->steps[static_cast<std::size_t>(graph->outputs[0])].inputs, ElementsAre(0, 1, 2, 3));
  std::vector<StepValue> values(graph->steps.size());
  for (std::size_t i = 0; i < 3; ++i) values[i] = {1.0 + static_cast<double>(i), 0.0, 0.0};
  values[3][0] = 10.0;
  graph->evaluate(values);
  EXPECT_DOUBLE_EQ(values[static_cast<std::size_t>(graph->outputs[0])][0], 2.0 - 10.0);
  values[1][0] = 5.0;
  graph->evaluate_followers(1, values);
  EXPECT_DOUBLE_EQ(values[static_cast<std::size_t>(graph->outputs[0])][0], 2.0 - 40.0);
}

TEST(SegmentGraph, NamesWhatIsNotThere) {
  const auto graph = graph_of("mean(A, LKNE) + progression.x", StepType::vector);
  ASSERT_TRUE(graph);
  EXPECT_EQ(graph->outputs[0], -1);
  EXPECT_EQ(graph->lacks[0], (std::set<std::string>{"LKNE", "progression"}));
  EXPECT_GE(graph_of("any(LKNE, A)", StepType::vector)->outputs[0], 0);
  EXPECT_EQ(graph_of("any(LKNE, RKNE)", StepType::vector)->lacks[0], (std::set<std::string>{"LKNE"}));
}

TEST(SegmentGraph, RefusesWhatMakesNoSense) {
  for (const auto& [text, words] : std::vector<std::pair<std::string, std::string>>{
           {"crosss(A, B)", "it: no function is called 'crosss'; did you mean cross?"},
           {"cross(A, 2)", "cross() does not take (a point or direction, a number)"},
           {"mean()", "mean() does not take ()"},
           {"A * B", "*() does not take"},
           {"length(A)", "the formula gives a number; expected a point or direction"},
           {"A.x", "no segment is called 'A'"},
           {"any()", "needs arguments"},
           {"any(LKNE, 2)", "of one kind"}}) {
    const auto graph = graph_of(text, StepType::vector);
    ASSERT_FALSE(graph) << text;
    EXPECT_EQ(graph.error().code, Code::bad_input);
    EXPECT_THAT(graph.error().message, HasSubstr(words)) << text;
  }
}

TEST(SegmentGraph, RefusesEntriesThatNeedThemselves) {
  SegmentDefinition d;
  d.points = {{.name = "P", .formula = of("Q + A")}, {.name = "Q", .formula = of("P + A")}};
  EXPECT_THAT(graph_of("P", StepType::vector, d).error().message, HasSubstr("needs itself"));
  for (int i = 0; i < 300; ++i)
    d.points.push_back({.name = "P" + std::to_string(i), .formula = of("A + P" + std::to_string(i + 1))});
  EXPECT_THAT(graph_of("P0", StepType::vector, d).error().message,
              HasSubstr("more than 200 entries in a row"));
  EXPECT_TRUE(graph_of("P200", StepType::vector, d));
  d.points[1].formula = of("2");
  EXPECT_THAT(graph_of("P", StepType::vector, d).error().message, HasSubstr("Q: the formula gives a number"));
}

TEST(SegmentGraph, RefusesLongFormulasWithinEachOtherBeforeTheStackEnds) {
  SegmentDefinition d;
  std::string terms;
  for (int i = 0; i < 600; ++i) terms += "+up";
  for (int i = 0; i < 190; ++i)
    d.points.push_back({.name = "P" + std::to_string(i), .formula = of("P" + std::to_string(i + 1) + terms)});
  const auto deep = graph_of("P0", StepType::vector, d);
  ASSERT_FALSE(deep);
  EXPECT_EQ(deep.error().code, Code::bad_input);
  EXPECT_THAT(deep.error().message, HasSubstr("formulas stand more than 1200 levels deep"));
  EXPECT_TRUE(graph_of("up" + terms, StepType::vector, d));
}

}  // namespace
}  // namespace kinemark::analysis
