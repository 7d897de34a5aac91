// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "studies/common/study_figure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "kinemark/core/check.h"
#include "studies/common/study_page.h"
#include "support/scratch.h"

namespace kinemark::studies {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

StudyFigure figure() {
  StudyFigure out{.paper = "Poizner 1986", .number = 5, .name = "a wheel"};
  report::FigurePanel panel;
  panel.lines.push_back({.colour = "#000000", .x = Eigen::Vector2d(0, 1), .y = Eigen::Vector2d(2, 3)});
  out.figure.panels.push_back(panel);
  out.numbers = {{"scatter of the diameter", "mm", 0.5, 0.583, 0.1711}};
  out.curves = {curve_of("edge", {Eigen::Vector2d(0, 1), Eigen::Vector2d(2, 3)}),
                curve_of("path, m", Eigen::Matrix3Xd(Eigen::Vector3d(1, 2, 3)))};
  return out;
}

TEST(StudyFigure, IsNamedByPaperAndNumber) {
  auto f = figure();
  EXPECT_EQ(f.title(), "Poizner 1986, figure 5");
  EXPECT_EQ(f.caption(), "Poizner 1986, figure 5: a wheel");
  EXPECT_EQ(f.file_name(), "poizner-1986-figure-5");
  f.number = 0;
  EXPECT_EQ(f.title(), "a wheel");
  EXPECT_EQ(f.file_name(), "poizner-1986-a-wheel");
  f.name = "errors, 1 mm (dashed: hidden)";
  EXPECT_EQ(f.file_name(), "poizner-1986-errors-1-mm-dashed-hidden");
}

TEST(StudyFigure, NumbersStandBesideThoseOfThePaper) {
  const FigureNumber all{"scatter of the diameter", "mm", 0.5, 0.583, 0.1711},
      ours{"turns", "1", {}, {}, 3.3};
  EXPECT_EQ(number_text(all, "1986 method"),
            "Scatter of the diameter: 0.5 mm in the paper, 0.583 mm (1986 method), 0.171 mm here.");
  EXPECT_EQ(number_text(ours, "1986 method"), "Turns: 3.3 here.");
}

TEST(StudyFigure, NumbersAreRowsOfTheTable) {
  StudyTable table;
  table.rows = {{.quantity = "a", .unit = "mm", .paper = 2.0, .ours = 1.0},
                {.quantity = "b", .unit = "1", .ours = 3.0}};
  const auto numbers = numbers_of(table, {"b", "a"});
  ASSERT_EQ(numbers.size(), 2U);
  EXPECT_EQ(numbers[0].ours, 3.0);
  EXPECT_FALSE(numbers[0].paper);
  EXPECT_EQ(numbers[1].paper, 2.0);
  EXPECT_THROW((void)numbers_of(table, {"c"}), ContractError);
}

TEST(StudyFigure, ForPrintItBearsTitleNameAndNumbers) {
  const auto print = figure_for_print(figure(), "1986 method");
  EXPECT_EQ(print.title, "Poizner 1986, figure 5");
  EXPECT_EQ(print.caption, "A wheel.");
  ASSERT_EQ(print.notes.size(), 1U);
  EXPECT_THAT(print.notes.front(), HasSubstr("0.5 mm in the paper"));
}

TEST(StudyFigure, ItsNumbersAreATable) {
  EXPECT_EQ(figure_csv(figure()), "curve,x,y,z\nedge,0,2,\nedge,1,3,\n\"path, m\",1,2,3\n");
  EXPECT_THROW((void)curve_of("uneven", {Eigen::VectorXd::Zero(2), Eigen::VectorXd::Zero(3)}), ContractError);
}

class Written : public ::testing::Test {
 protected:
  testing_support::ScratchFolder folder;
  StudyPage page{.title = "t", .heading = "h", .description = "d", .figures = {figure()}, .table = {}};
  std::vector<std::string> names(const std::filesystem::path& in) {
    std::vector<std::string> out;
    for (const auto& file : std::filesystem::directory_iterator(in)) out.push_back(file.path().filename());
    std::ranges::sort(out);
    // A build may have no PNG; the hidden folder goes with the staging.
    std::erase_if(out, [](const auto& name) { return name.ends_with(".png") || name.starts_with("."); });
    return out;
  }
};

TEST_F(Written, AFolderGetsThePageAndEveryFigure) {
  auto files = StudyFiles::create(folder / "out", {});
  ASSERT_TRUE(files) << files.error().message;
  ASSERT_TRUE(files->write(page));
  EXPECT_THAT(names(folder / "out"),
              ElementsAre("poizner-1986-figure-5.csv", "poizner-1986-figure-5.svg", "study.html"));
  EXPECT_FALSE(StudyFiles::create(folder / "out", {})) << "nothing is replaced unasked";
}

TEST_F(Written, APageIsAPageAlone) {
  auto files = StudyFiles::create(folder / "p.html", {});
  ASSERT_TRUE(files) << files.error().message;
  ASSERT_TRUE(files->write(page));
  EXPECT_THAT(names(folder.path()), ElementsAre("p.html"));
}

}  // namespace
}  // namespace kinemark::studies
