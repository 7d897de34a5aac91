// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/table_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Pair;

const std::string kVersion1 =
    "Coordinates\nversion=1\nnRows=2\nnColumns=3\ninDegrees=yes\n\nAngles are in degrees.\n\nendheader\n";
const std::string kVersion3 = "DataRate=100.0\nDataType=double\nversion=3\nOpenSimVersion=4.4\nendheader\n";
const std::string kSimm =
    "knee trial\n# header:\nname knee\ndatacolumns 3\ndatarows 2\notherdata 1\nrange 0 1\nendheader\n";
const std::string kBody = "time\ta\tb\n0\t1\t2\n0.5\t3\t4\n";

data::Table good(const std::string& text) {
  const auto table = parse_table(text, "t.sto");
  EXPECT_TRUE(table) << table.error().message;
  if (!table) return {};
  EXPECT_TRUE(table->validate());
  return *table;
}

std::string bad(const std::string& text, Code code = Code::bad_input) {
  const auto table = parse_table(text, "t.sto");
  EXPECT_FALSE(table) << text;
  if (table) return "";
  EXPECT_EQ(table.error().code, code);
  EXPECT_EQ(table.error().message.find('\n'), std::string::npos) << "one sentence";
  return table.error().message;
}

TEST(ParseTable, ReadsAllThreeHeaders) {
  for (const std::string& header : {kVersion1, kVersion3, kSimm}) {
    const auto table = good(header + kBody);
    EXPECT_THAT(table.columns, ElementsAre("a", "b"));
    EXPECT_THAT(table.time_s, ElementsAre(0.0, 0.5));
    EXPECT_THAT(table.values, ElementsAre(1.0, 2.0, 3.0, 4.0));
    EXPECT_THAT(table.warnings, IsEmpty());
  }
  EXPECT_EQ(good(kVersion1 + kBody).name, "Coordinates");
  EXPECT_EQ(good(kVersion3 + kBody).name, "");
  EXPECT_EQ(good(kSimm + kBody).name, "knee");
  EXPECT_THAT(good(kSimm + kBody).header,
              ElementsAre(Pair("", "# header:"), Pair("name", "knee"), Pair("datacolumns", "3"),
                          Pair("datarows", "2"), Pair("otherdata", "1"), Pair("range", "0 1")));
  EXPECT_THAT(good(kVersion3 + kBody).header, Contains(Pair("OpenSimVersion", "4.4")));
}

TEST(ParseTable, KnowsDegreesFromRadiansAndWhoSaidSo) {
  const auto check_degrees = [](const std::string& header, bool stated, bool in_degrees, bool angles) {
    const auto table = good(header + kBody);
    EXPECT_EQ(table.degrees_stated, stated) << header;
    EXPECT_EQ(table.in_degrees, in_degrees) << header;
    EXPECT_EQ(angles_are_degrees(table), angles) << header;
  };
  check_degrees(kVersion1, true, true, true);
  check_degrees("x\nversion=1\ninDegrees=no\nAngles are in degrees.\nendheader\n", true, false, false);
  check_degrees("x\nInDegrees = YES\nendheader\n", true, true, true);
  check_degrees("x\nAngles are in degrees.\nendheader\n", true, true, true);
  check_degrees("x\nAngles are in radians.\nendheader\n", true, false, false);
  check_degrees(kVersion3, false, false, false);
  check_degrees(kSimm, false, false, true);
  EXPECT_THAT(bad("x\ninDegrees=maybe\nendheader\n" + kBody), HasSubstr("line 2: inDegrees is 'maybe'"));
}

TEST(ParseTable, SeparatorsAndLineEndsDoNotMatter) {
  const auto plain = good(kVersion1 + kBody);
  std::string crlf;
  for (const char c : kVersion1 + kBody) crlf += c == '\n' ? "\r\n" : std::string(1, c);
  const std::string blanks = kVersion1 + " time  a   b\n  0.0   1   2\n 0.5 3 4   \n";
  const std::string mixed = kVersion1 + "time\ta\tb\n 0.0  1 2\n0.5\t 3\t  4\n";
  const std::string trailing = kVersion1 + "time\ta\tb\t\t\n0\t1\t2\t\t\n0.5\t3\t4\t\n";
  const std::string no_end = kVersion1 + kBody.substr(0, kBody.size() - 1);
  const std::string loud = kVersion1 + "TIME\ta\tb\n\n0\t1\t2\n0.5\t3\t4\n\n\n";
  const std::string tabs_in_header = "Coordinates\t\t\nversion=1\t\t\nendheader\t\t\n" + kBody;
  for (const std::string& text : {crlf, blanks, mixed, trailing, no_end, loud, tabs_in_header}) {
    const auto table = good(text);
    EXPECT_EQ(table.columns, plain.columns) << text;
    EXPECT_EQ(table.time_s, plain.time_s) << text;
    EXPECT_EQ(table.values, plain.values) << text;
    EXPECT_THAT(table.warnings, IsEmpty()) << text;
  }
}

TEST(ParseTable, LabelsMayHoldBlanksBetweenTabs) {
  EXPECT_THAT(good(kVersion3 + "time\tleft knee\t/jointset/hip/value\n0\t1\t2\n").columns,
              ElementsAre("left knee", "/jointset/hip/value"));
}

TEST(ParseTable, BlankAndNaNCellsAreNaN) {
  const auto table = good(kVersion3 + "time\ta\tb\n0\t\tNaN\n1\t -nan(ind)\t1.#QNAN\n2\tinf\t+5\n");
  for (const std::size_t i : {0, 1, 2, 3}) EXPECT_TRUE(std::isnan(table.values[i])) << i;
  EXPECT_EQ(table.values[4], std::numeric_limits<double>::infinity());
  EXPECT_EQ(table.values[5], 5.0);
}

TEST(ParseTable, CountsThatLieAreReported) {
  const auto table = good("x\nnRows=7\nnColumns=9\nendheader\n" + kBody);
  EXPECT_EQ(table.rows(), 2);
  EXPECT_THAT(table.warnings, ElementsAre(HasSubstr("header says 9 columns, 3 are labelled"),
                                          HasSubstr("header says 7 rows, 2 are there")));
}

TEST(ParseTable, VectorCellsBecomeColumns) {
  const auto table =
      good("DataType=Vec3\nversion=3\nendheader\ntime\tm1\tm2\n0\t1,2,3\t4, 5,nan\n0.1\t7,8,9\t1e1,+2,-3\n");
  EXPECT_THAT(table.columns, ElementsAre("m1_1", "m1_2", "m1_3", "m2_1", "m2_2", "m2_3"));
  EXPECT_EQ(table(0, 4), 5.0);
  EXPECT_TRUE(std::isnan(table(0, 5)));
  EXPECT_EQ(table(1, 3), 10.0);
  EXPECT_EQ(good("DataType=Vec6\nendheader\ntime\tf\n0\t1,2,3,4,5,6\n").columns.size(), 6U);
  EXPECT_THAT(bad("DataType=Vec3\nendheader\ntime\tm\n0\t1,2\n"),
              HasSubstr("line 4, column 2 (m_1): found '1,2'"));
  EXPECT_THAT(bad("DataType=Vec3\nendheader\ntime\tm\n0\t1,2,3,4\n"),
              HasSubstr("3 numbers with commas between"));
  EXPECT_THAT(bad("DataType=Vec3\nendheader\ntime\tm\n0\t\n"), HasSubstr("the cell is blank"));
  EXPECT_THAT(bad("DataType=Quaternion\nversion=3\nendheader\n" + kBody, Code::not_supported),
              HasSubstr("holds orientations, as of inertial sensors (DataType=Quaternion)"));
  bad("DataType=Vec13\nendheader\n" + kBody, Code::not_supported);
  bad("DataType=SpatialVec\nendheader\n" + kBody, Code::not_supported);
}

TEST(ParseTable, ATableWithoutHeaderIsReadAndReported) {
  const auto table = good(kBody);
  EXPECT_EQ(table.rows(), 2);
  EXPECT_THAT(table.warnings, ElementsAre(HasSubstr("there is no header")));
}

TEST(ParseTable, RepeatedTimesAreLeftOutAndReported) {
  const auto table = good(kVersion3 + "time\ta\n0\t1\n0\t2\n0.5\t3\n0.5\t4\n1\t5\n");
  EXPECT_THAT(table.time_s, ElementsAre(0.0, 0.5, 1.0));
  EXPECT_THAT(table.values, ElementsAre(1.0, 3.0, 5.0));
  EXPECT_THAT(table.warnings, ElementsAre(HasSubstr("2 rows repeat the time")));
  EXPECT_THAT(bad(kVersion3 + "time\ta\n0\t1\n-1\t2\n"),
              HasSubstr("line 8 (row 2): time runs backwards from 0 to -1 s"));
}

TEST(ParseTable, TimeThatStandsStillIsRefused) {
  const std::string head = "t\nnRows=4\nnColumns=2\nendheader\ntime\ta\n";
  EXPECT_THAT(bad(head + "1\t1\n1\t2\n1\t3\n1\t4\n"),
              HasSubstr("line 7: time stands still here and in 3 of 4 rows"));
  const auto jump = parse_table(head + "0\t1\n0.01\t2\n0.02\t3\n0.03\t4\n9.0\t4\n", "t.sto");
  ASSERT_TRUE(jump);
  EXPECT_THAT(jump->warnings, testing::Contains(HasSubstr("line 10 (row 5): time jumps from 0.03 to 9 s")));
}

TEST(ParseTable, NamesMayBeInLatin1) {
  const auto table = parse_table(
      "t\xE9te\nauteur=L\xE9"
      "a\nendheader\ntime\tcoude_fl\xE9"
      "chi\n0\t1\n",
      "t.sto");
  ASSERT_TRUE(table) << table.error().message;
  EXPECT_EQ(table->name, "téte");
  EXPECT_THAT(table->columns, testing::ElementsAre("coude_fléchi"));
  EXPECT_EQ(table->header.front().second, "Léa");
}

TEST(ParseTable, ABlankLineEndsTheData) {
  const auto table = good(kVersion3 + kBody + "\n1\tx\ty\n");
  EXPECT_EQ(table.rows(), 2);
  EXPECT_THAT(table.warnings, ElementsAre(HasSubstr("line 10 and what follows is not read")));
}

TEST(ParseTable, TimeAloneAndNoRowsAreTables) {
  EXPECT_EQ(good(kVersion3 + "time\n0\n1\n").rows(), 2);
  EXPECT_EQ(good(kVersion3 + "time\ta\n").rows(), 0);
}

TEST(ParseTable, SaysLineAndColumnOfWhatIsWrong) {
  EXPECT_EQ(bad(kVersion3 + "time\ta\tb\n0\t1\tx2\n"),
            "t.sto: line 7, column 3 (b): found 'x2'; expected a number");
  EXPECT_EQ(bad(kVersion3 + "time\ta\tb\n\t1\t2\n"),
            "t.sto: line 7, column 1 (time): the cell is blank; expected a number");
  EXPECT_THAT(bad(kVersion3 + "time\ta\tb\n0\t1\n"),
              HasSubstr("line 7: holds 2 cells where 3 columns are labelled"));
  EXPECT_THAT(bad(kVersion3 + "time\ta\tb\n0\t1\t2\t3\n"), HasSubstr("holds 4 cells where 3"));
  EXPECT_THAT(bad(kVersion3 + "time\ta\tb\nnan\t1\t2\n"), HasSubstr("column 1 (time): found 'nan'"));
  EXPECT_THAT(bad(kVersion3 + "time\ta\ta\n"), HasSubstr("line 6: label 'a' occurs twice (columns 2 and 3)"));
  EXPECT_THAT(bad(kVersion3 + "time\t\ta\n"), HasSubstr("line 6, column 2: the column has no label"));
  EXPECT_THAT(bad(kVersion3 + "t\ta\n"), HasSubstr("the first column is 't'; expected 'time'"));
  EXPECT_THAT(bad("x\nversion=1\n0\t1\t2\n"), HasSubstr("line 3: numbers stand before the line 'endheader'"));
  EXPECT_THAT(bad("x\nversion=1\n"), HasSubstr("there is no line 'endheader' in 2 lines"));
  EXPECT_THAT(bad(kVersion3), HasSubstr("ends where the line of labels was expected"));
  EXPECT_THAT(bad(""), HasSubstr("the file is empty"));
}

TEST(ParseTable, EveryByteMayBeWrong) {
  for (const std::string& whole : {kVersion1 + kBody, kVersion3 + kBody, kSimm + kBody}) {
    for (std::size_t i = 0; i < whole.size(); ++i) {
      std::ignore = parse_table(whole.substr(0, i), "t");
      for (const char c : {'\0', '\t', '\n', ' ', '-', '9', '=', '\xFF'}) {
        std::string text = whole;
        text[i] = c;
        const auto table = parse_table(text, "t");
        if (!table) continue;
        EXPECT_TRUE(table->validate()) << text;
      }
    }
  }
}

TEST(ParseTable, ShortRowsCannotAskForMuchMemory) {
  std::string labels = "time";
  for (int i = 0; i < 20'000; ++i) labels += "\tc" + std::to_string(i);
  std::string rows;
  for (int i = 0; i < 20'000; ++i) rows += "0\n";
  EXPECT_THAT(bad(kVersion3 + labels + "\n" + rows), HasSubstr("20000 rows of 20000 columns do not fit"));
  EXPECT_THAT(bad(kVersion3 + "time" + std::string(1 << 20, '\t') + "a\n0\n"),
              HasSubstr("line 6: has 1048581 bytes"));
  EXPECT_THAT(bad("x\n" + std::string(1 << 21, 'y') + "\nendheader\n"),
              HasSubstr("line 2: has 2097152 bytes"));
  EXPECT_THAT(bad("x\n" + std::string(100'000, '\n')), HasSubstr("no line 'endheader' in 10000 lines"));
}

data::Table small() {
  data::Table table;
  table.name = "Coordinates";
  table.in_degrees = true;
  table.header = {
      {"", "Units are S.I. units"}, {"", "Angles are in radians."}, {"nRows", "99"}, {"subject", "7"}};
  table.columns = {"knee", "hip tx"};
  table.time_s.assign({0.0, 0.1});
  table.values.assign({1.5, std::nan(""), 1.0 / 3.0, -2e-10});
  return table;
}

TEST(WriteTable, WritesVersion1ForEveryOpenSim) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_table(scratch / "q.mot", small(), {.decimals = 8}));
  EXPECT_EQ(read_text(scratch / "q.mot").value(),
            "Coordinates\nversion=1\nnRows=2\nnColumns=3\ninDegrees=yes\nUnits are S.I. "
            "units\nsubject=7\nendheader\n"
            "time\tknee\thip tx\n0.00000000\t1.50000000\tnan\n0.10000000\t0.33333333\t-0.00000000\n");
}

TEST(WriteTable, WritesVersion3) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_table(scratch / "q.sto", small(), {.version = 3}));
  EXPECT_EQ(
      read_text(scratch / "q.sto").value(),
      "Coordinates\ninDegrees=yes\nUnits are S.I. units\nsubject=7\nDataType=double\nversion=3\nendheader\n"
      "time\tknee\thip tx\n0\t1.5\tnan\n0.1\t0.3333333333333333\t-2e-10\n");
}

TEST(WriteTable, ReadsBackBitForBit) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_table(scratch / "q.sto", small()));
  const auto back = read_table(scratch / "q.sto").value();
  EXPECT_EQ(back.values[2], 1.0 / 3.0);
  EXPECT_TRUE(std::isnan(back.values[1]));
  EXPECT_TRUE(back.in_degrees);
  EXPECT_THAT(back.warnings, IsEmpty());
}

TEST(WriteTable, RefusesWhatNoReaderWouldUnderstand) {
  const testing_support::ScratchFolder scratch;
  const auto refused = [&](auto change) {
    data::Table table = small();
    change(table);
    const auto status = write_table(scratch / "q.sto", table);
    EXPECT_FALSE(status);
    return status ? std::string() : status.error().message;
  };
  EXPECT_THAT(refused([](auto& t) { t.columns[0] = "a\tb"; }), HasSubstr("column label 'a?b'"));
  EXPECT_THAT(refused([](auto& t) { t.columns[0] = ""; }), HasSubstr("is empty"));
  EXPECT_THAT(refused([](auto& t) { t.name = "a\nb"; }), HasSubstr("name holds a line end"));
  EXPECT_THAT(refused([](auto& t) { t.header[0].second = "endheader"; }), HasSubstr("word endheader"));
  EXPECT_THAT(refused([](auto& t) { t.time_s[1] = 0.0; }), HasSubstr("does not increase"));
  EXPECT_EQ(scratch.count_files(), 0);
  ASSERT_TRUE(write_table(scratch / "q.sto", small()));
  EXPECT_EQ(write_table(scratch / "q.sto", small()).error().code, Code::io) << "it exists";
  EXPECT_TRUE(write_table(scratch / "q.sto", small(), {.force = true}));
}

}  // namespace
}  // namespace kinemark::io
