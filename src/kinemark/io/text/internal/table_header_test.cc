// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/internal/table_header.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/text/internal/csv_line.h"

namespace kinemark::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

TableHeader header_of(const std::string& text) {
  Lines lines(text);
  const auto header = parse_table_header(lines);
  EXPECT_TRUE(header) << header.error().message;
  return header ? *header : TableHeader{};
}

std::string header_refusal(const std::string& text, Code code = Code::bad_input) {
  Lines lines(text);
  const auto header = parse_table_header(lines);
  EXPECT_FALSE(header) << text;
  if (header) return "";
  EXPECT_EQ(header.error().code, code);
  return header.error().message;
}

TEST(TableHeader, KeysValuesAndFreeTextAreKept) {
  const auto h = header_of(
      "a name\nversion=1\nnRows = 12\nnColumns=3\ninDegrees=yes\n\nAnything at all\nendheader\n"
      "time\tq1\tq2\n");
  EXPECT_EQ(h.name, "a name");
  EXPECT_THAT(h.pairs, ElementsAre(Pair("version", "1"), Pair("nRows", "12"), Pair("nColumns", "3"),
                                   Pair("inDegrees", "yes"), Pair("", "Anything at all")));
  EXPECT_EQ(h.rows, 12.0);
  EXPECT_EQ(h.columns, 3.0);
  EXPECT_EQ(h.in_degrees, true);
  EXPECT_EQ(h.separator, Separator::tab);
  EXPECT_THAT(h.columns_named, ElementsAre("q1", "q2"));
  EXPECT_THAT(h.warnings, IsEmpty());
}

TEST(TableHeader, LabelsInQuotesAreTheSame) {
  EXPECT_THAT(header_of("endheader\n\"time\"\t\"hip_flexion\"\tknee\n").columns_named,
              ElementsAre("hip_flexion", "knee"));
}

TEST(TableHeader, PathsOfStatesGetTheNamesOfTheirCoordinates) {
  const auto h = header_of(
      "endheader\ntime\t/jointset/hip/hip_flexion/value\t/jointset/hip/hip_flexion/speed\t/forceset/"
      "soleus\n");
  EXPECT_THAT(h.columns_named,
              ElementsAre("hip_flexion", "/jointset/hip/hip_flexion/speed", "/forceset/soleus"));
  EXPECT_THAT(h.warnings, ElementsAre("1 label is a path of an OpenSim state file; read is "
                                      "'/jointset/hip/hip_flexion/value' as 'hip_flexion'"));
  const auto both =
      header_of("endheader\ntime\tknee\t/jointset/k/knee/value\t/jointset/value\t/jointset/a/b/c/value\n");
  EXPECT_THAT(both.columns_named,
              ElementsAre("knee", "/jointset/k/knee/value", "/jointset/value", "/jointset/a/b/c/value"));
  EXPECT_THAT(both.warnings, IsEmpty());
}

TEST(TableHeader, SimmsKeysStandBeforeABlank) {
  const auto h = header_of("name walk 1\ndatacolumns 2\ndatarows 73\nrange 0 1.5\nendheader\ntime q\n");
  EXPECT_EQ(h.name, "walk 1");
  EXPECT_EQ(h.columns, 2.0);
  EXPECT_EQ(h.rows, 73.0);
  EXPECT_EQ(h.separator, Separator::blanks);
  EXPECT_FALSE(h.in_degrees.has_value());
}

TEST(TableHeader, WhatSaysDegreesIsBelievedInItsOrder) {
  const auto degrees = [](const std::string& lines) {
    return header_of("x\n" + lines + "endheader\ntime\tq\n").in_degrees;
  };
  for (const char* yes : {"yes", "y", "TRUE", "1", "Yes"})
    EXPECT_EQ(degrees(std::string("inDegrees=") + yes + "\n"), true);
  for (const char* no : {"no", "N", "false", "0"})
    EXPECT_EQ(degrees(std::string("indegrees=") + no + "\n"), false);
  EXPECT_EQ(degrees("Angles are in degrees.\n"), true);
  EXPECT_EQ(degrees("Angles are in radians.\n"), false);
  EXPECT_EQ(degrees("inDegrees=no\nAngles are in degrees.\n"), false) << "the key is surer than the sentence";
  EXPECT_EQ(degrees(""), std::nullopt);
  EXPECT_EQ(header_refusal("x\ninDegrees=maybe\nendheader\ntime\tq\n"),
            "line 2: inDegrees is 'maybe'; expected yes or no");
}

TEST(TableHeader, VectorsBecomeOneColumnANumber) {
  const auto names = [](const std::string& type) {
    return header_of("x\nDataType=" + type + "\nendheader\ntime\tr\n").columns_named;
  };
  EXPECT_THAT(names("double"), ElementsAre("r"));
  EXPECT_THAT(names("Vec3"), ElementsAre("r_1", "r_2", "r_3"));
  EXPECT_THAT(names("UnitVec3"), ElementsAre("r_1", "r_2", "r_3"));
  EXPECT_EQ(names("vec12").size(), 12U);
  for (const char* bad : {"Vec1", "Vec13", "Vec2.5", "Vec", "SpatialVec", "Vecnan"})
    EXPECT_THAT(
        header_refusal(std::string("x\nDataType=") + bad + "\nendheader\ntime\tr\n", Code::not_supported),
        HasSubstr("expected double or Vec3"))
        << bad;
}

TEST(TableHeader, ATableMayBeginWithItsLabels) {
  const auto h = header_of("Time\ta\tb\n0\t1\t2\n");
  EXPECT_THAT(h.columns_named, ElementsAre("a", "b"));
  EXPECT_THAT(h.warnings, ElementsAre(HasSubstr("there is no header")));
}

TEST(TableHeader, BlankLinesAroundTheLabelsArePassedOver) {
  const std::string text = "x\nendheader\n\n  \ntime\ta\t\t\n\n\n0\t1\n";
  Lines lines(text);
  const auto h = parse_table_header(lines);
  ASSERT_TRUE(h);
  EXPECT_THAT(h->columns_named, ElementsAre("a")) << "tabs behind the last label are no columns";
  std::string_view line;
  ASSERT_TRUE(lines.next(line));
  EXPECT_EQ(line, "0\t1") << "the next line is the first row";
}

TEST(TableHeader, LabelsAreThereAndDistinct) {
  const auto labels = [](const std::string& line) { return header_refusal("x\nendheader\n" + line + "\n"); };
  EXPECT_EQ(labels("frame\ta"), "line 3: the first column is 'frame'; expected 'time'");
  EXPECT_EQ(labels("time\ta\t\tb"), "line 3, column 3: the column has no label");
  EXPECT_EQ(labels("time\ta\tb\ta"), "line 3: label 'a' occurs twice (columns 2 and 4)");
  EXPECT_THAT(header_of("x\nnColumns=5\nendheader\ntime\ta\n").warnings,
              ElementsAre("header says 5 columns, 2 are labelled; the labels are used"));
}

TEST(TableHeader, OneSentenceForWhatIsNoTable) {
  EXPECT_EQ(header_refusal(""), "the file is empty; expected a MOT or STO table");
  EXPECT_THAT(header_refusal("x\nversion=1\n"), HasSubstr("there is no line 'endheader' in 2 lines"));
  EXPECT_THAT(header_refusal("x\n1 2 3\nendheader\ntime\ta\n"), HasSubstr("line 2: numbers stand before"));
  EXPECT_THAT(header_refusal("x\nendheader\n\n"),
              HasSubstr("the file ends where the line of labels was expected"));
  std::string endless;
  for (int i = 0; i < 10'001; ++i) endless += "key=value\n";
  EXPECT_THAT(header_refusal(endless), HasSubstr("in 10000 lines"));
}

TEST(TableHeader, KeysThatDescribeTheOldFileAreNotHandedOn) {
  for (const char* key : {"nRows", "NROWS", "range", "DataType", "inDegrees", "datacolumns"})
    EXPECT_TRUE(is_written_by_us(key)) << key;
  for (const char* key : {"Subject", "", "row", "nRows "}) EXPECT_FALSE(is_written_by_us(key)) << key;
}

/// A line that holds those cells, written as RFC 4180 says.
std::string csv(const std::vector<std::string>& cells) {
  std::string line;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) line += ',';
    line += '"';
    for (const char c : cells[i]) line += c == '"' ? std::string("\"\"") : std::string(1, c);
    line += '"';
  }
  return line;
}

TEST(SplitCsv, EveryQuotedLineComesBack) {
  // All words of up to four of these characters, two in a line.
  const std::string letters = "a\", ";
  std::vector<std::string> words{""}, cells;
  for (std::size_t i = 0; i < words.size() && words[i].size() < 4; ++i)
    for (const char c : letters) words.push_back(words[i] + c);
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::vector<std::string> line{words[i], words[words.size() - 1 - i]};
    ASSERT_TRUE(split_csv(csv(line), cells)) << csv(line);
    EXPECT_EQ(cells, line) << csv(line);
  }
}

TEST(SplitCsv, PlainCellsLoseTheirBlanksAndTheLastMayBeEmpty) {
  std::vector<std::string> cells;
  ASSERT_TRUE(split_csv(" a , b c ,,\"  d \" ,", cells));
  EXPECT_THAT(cells, ElementsAre("a", "b c", "", "  d ", ""));
  ASSERT_TRUE(split_csv("", cells));
  EXPECT_THAT(cells, ElementsAre(""));
  for (const char* open : {"\"", "a,\"b", "\"a\"\"", "a,\"b,c"}) EXPECT_FALSE(split_csv(open, cells)) << open;
}

}  // namespace
}  // namespace kinemark::io::internal
