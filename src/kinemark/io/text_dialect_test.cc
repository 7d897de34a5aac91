// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text_dialect.h"

#include <gmock/gmock.h>

#include <string_view>

namespace kinemark::io {
namespace {

std::string utf16(std::string_view ascii, bool low_first, bool mark) {
  std::string out = !mark ? "" : low_first ? "\xFF\xFE" : "\xFE\xFF";
  for (const char c : ascii) {
    out += low_first ? c : '\0';
    out += low_first ? '\0' : c;
  }
  return out;
}

TEST(TextDialect, WhatIsPlainComesBackAsItIs) {
  for (const std::string text : {
           "",
           "time\tA\n0.0\t1.5\n",
           "frame,time_s,marker,x_m\n1,0,RASI,0.1\n",
           "a,b\n1,2\n3,4\n",                                      // whole numbers between commas
           "frame,method\n1,\"a; b\"\n2,c; d\n",                   // semicolons inside of cells
           "DataType=Vec2\nendheader\ntime\tA\n0\t1,2\n1\t3,4\n",  // pairs
           "DataType=Vec3\nendheader\ntime\tA\n0\t1,2,3\n",        // vectors
           "name, note\n1.5, 1,5\n",                               // points and commas
           "one line without an end; and a semicolon",
       })
    EXPECT_EQ(in_plain_dialect(text), text);
}

TEST(TextDialect, SemicolonsBecomeCommasOrTabs) {
  EXPECT_EQ(in_plain_dialect("t;A_X;A_Y\r\n0;1.5;2\r\n"), "t,A_X,A_Y\r\n0,1.5,2\r\n");
  EXPECT_EQ(in_plain_dialect("PathFileType;4;(X/Y/Z);a.trc\nDataRate;Units\n100;mm\n"),
            "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tUnits\n100\tmm\n");
  EXPECT_EQ(in_plain_dialect("nRows=2\nendheader\ntime;a;b\n0;1;2\n1;3;4\n"),
            "nRows=2\nendheader\ntime\ta\tb\n0\t1\t2\n1\t3\t4\n");
}

TEST(TextDialect, SemicolonsAreKnownBelowTitlesWithCommas) {
  EXPECT_EQ(in_plain_dialect("On Monday, 3 May\nt;x;y\n0,00;1,5;2\n0,01;1;2\n"),
            "\"On Monday, 3 May\"\nt,x,y\n0.00,1.5,2\n0.01,1,2\n");
  // A list in a cell of each row makes no table of semicolons.
  const std::string lists = "frame,list,a,b\n1,1;2;3,0,0\n2,4;5;6,0,0\n";
  EXPECT_EQ(in_plain_dialect(lists), lists);
}

TEST(TextDialect, TablesOfBlanksGetTabs) {
  EXPECT_EQ(in_plain_dialect("# t A_x A_y A_z\n0.00 1 2 3\n0.01  4 5 6\n"),
            "#\tt\tA_x\tA_y\tA_z\n0.00\t1\t2\t3\n0.01\t4\t5\t6\n");
  EXPECT_EQ(in_plain_dialect("t A_x A_y A_z\n0 1 2 3\n1 4 5 6\n"),
            "t\tA_x\tA_y\tA_z\n0\t1\t2\t3\n1\t4\t5\t6\n");
  for (const std::string text : {"t a x y z w\n0 1 2 3\n1 4 5 6\n", "t x y z\n0 1 2 3\n1 4 5\n",
                                 "t x y z\n0 1 2 3\n", "Frame Time: 0.01\n0 1 2 3\n1 4 5 6\n"})
    EXPECT_EQ(in_plain_dialect(text), text) << "labels and rows differ";
}

TEST(TextDialect, TextWithACommaIsQuotedWhereCommasSeparate) {
  EXPECT_EQ(in_plain_dialect("t;name;x\n0;knee, left;1\n"), "t,name,x\n0,\"knee, left\",1\n");
  EXPECT_EQ(in_plain_dialect("t;name;x\n0;\"so \"\"big\"\"\";1\n"), "t,name,x\n0,\"so \"\"big\"\"\",1\n");
  EXPECT_EQ(in_plain_dialect("t;name;x\n0;\"knee; left\";1\n"), "t,name,x\n0,knee; left,1\n");
}

TEST(TextDialect, TabsBecomeCommasInExportsThatHaveCommas) {
  EXPECT_EQ(in_plain_dialect("Trajectories\n100\n\t\tLASI\nFrame\tSub Frame\tX\n1\t0\t2.5\n"),
            "Trajectories\n100\n,,LASI\nFrame,Sub Frame,X\n1,0,2.5\n");
}

TEST(TextDialect, DecimalCommasBecomePoints) {
  EXPECT_EQ(in_plain_dialect("t;x\n0,00;-1,25\n0,01;1e-3\n"), "t,x\n0.00,-1.25\n0.01,1e-3\n");
  EXPECT_EQ(in_plain_dialect("time\tx\n0,00\t,5\n0,01\t\n"), "time\tx\n0.00\t.5\n0.01\t\n");
  EXPECT_EQ(in_plain_dialect("nRows=1\nendheader\ntime x\n0,00 1,5\n"),
            "nRows=1\nendheader\ntime\tx\n0.00\t1.5\n");
}

TEST(TextDialect, NumbersInQuotesLoseThem) {
  EXPECT_EQ(in_plain_dialect("\"t\",\"x\"\n\"0,00\",\"1,5\"\n"), "t,x\n0.00,1.5\n");
  EXPECT_EQ(in_plain_dialect("t,x\n\"0.5\",\"1\"\n"), "t,x\n0.5,1\n");
}

TEST(TextDialect, ThousandsAreWrittenWithoutASign) {
  EXPECT_EQ(in_plain_dialect("t;x\n0,5;1.234,5\n"), "t,x\n0.5,1234.5\n");
  EXPECT_EQ(in_plain_dialect("t;x\n0,5;1.234\n1,0;-987,5\n"), "t,x\n0.5,1234\n1.0,-987.5\n");
  EXPECT_EQ(in_plain_dialect("t,x\n0.5,\"1,234.5\"\n0.6,\"-1,234,567.25\"\n"),
            "t,x\n0.5,1234.5\n0.6,-1234567.25\n");
  EXPECT_EQ(in_plain_dialect("t\tx\n0.5\t1,234\n0.6\t987.5\n"), "t\tx\n0.5\t1234\n0.6\t987.5\n");
  EXPECT_EQ(in_plain_dialect("t;x\n0;1.234.567\n1;12\n"), "t,x\n0,1234567\n1,12\n");
  // Nothing but the column says so: 987, and then neither 1.234 nor 1,012.
  EXPECT_EQ(in_plain_dialect("t;x\n0;987\n1;1.012\n2;1.234\n"), "t,x\n0,987\n1,1012\n2,1234\n");
  EXPECT_EQ(in_plain_dialect("t\tx\n0\t987\n1\t1,012\n"), "t\tx\n0\t987\n1\t1012\n");
}

TEST(TextDialect, ThreeDigitsBehindASignAreAPartOfOneWhereNothingSaysThousands) {
  EXPECT_EQ(in_plain_dialect("t;x\n0,000;1,234\n0,010;1,250\n"), "t,x\n0.000,1.234\n0.010,1.250\n");
  EXPECT_EQ(in_plain_dialect("t;x\n0;1,234\n1;2\n"), "t,x\n0,1.234\n1,2\n");
  for (const std::string text :
       {"t\tx\n0\t1.234\n1\t2\n", "t\tx\n100\t1.234\n101\t1.250\n", "t\tx\n0\t123.456\n1\t234\n",
        "t\tx\n0\t987\n1\t1.012\n2\t0.5\n", "t\tx\n0\t1987\n1\t1.012\n", "t\tx\n0\t0.123\n1\t987\n"})
    EXPECT_EQ(in_plain_dialect(text), text);
}

TEST(TextDialect, NumbersWithBothAreLeftForTheReaderToRefuse) {
  // Points elsewhere say that a comma is none.
  EXPECT_EQ(in_plain_dialect("t\tx\n0.5\t1,5\n"), "t\tx\n0.5\t1,5\n");
  for (const std::string text :
       {"t\tx\n1,234.5\t1.234,5\n", "t\tx\n1,23.5\t1,2345.6\n", "t\tx\n0,5\t1,234.5\n"})
    EXPECT_EQ(in_plain_dialect(text), text);
}

TEST(TextDialect, SignsOfTypesettersAndOtherCountriesBecomeThoseOfPrograms) {
  EXPECT_EQ(in_plain_dialect("t,x\n0.5,\xE2\x88\x92"
                             "12.5\n0.6,3\n"),
            "t,x\n0.5,-12.5\n0.6,3\n");
  EXPECT_EQ(in_plain_dialect("t,x\n0.5,1'234.5\n0.6,-12'345'678.25\n"),
            "t,x\n0.5,1234.5\n0.6,-12345678.25\n");
  for (const std::string blank : {"\xC2\xA0", "\xE2\x80\xAF", "\xA0", " "})
    EXPECT_EQ(in_plain_dialect("t;x\n0,5;1" + blank + "234,5\n0,6;-987,5\n"),
              "t,x\n0.5,1234.5\n0.6,-987.5\n");
  EXPECT_EQ(in_plain_dialect("t\tx\n0.5\t0.125D+02\n0.6\t1.d-3\n"), "t\tx\n0.5\t0.125e+02\n0.6\t1.e-3\n");
}

TEST(TextDialect, OtherSignsAreLeftForTheReaderToRefuse) {
  for (const std::string text : {"t,x\n0.5,1'23.5\n0.6,1'2345\n", "t\tx\n0.5\t1.5'234\n",
                                 "t,x\n0.5,\xE2\x88\x92\n", "t,x\n0.5,12D\n", "t,x\n0.5,a D+02\n"})
    EXPECT_EQ(in_plain_dialect(text), text);
  EXPECT_EQ(in_plain_dialect("t;name\n0,5;marker 123\n0,6;1\n"), "t,name\n0.5,marker 123\n0.6,1\n")
      << "a name is no number";
}

TEST(TextDialect, TimesOfAClockStandBesideDecimalCommas) {
  EXPECT_EQ(in_plain_dialect("t;x\n10:00:00,010;1,5\n10:00:00,020;1,6\n"),
            "t,x\n10:00:00.010,1.5\n10:00:00.020,1.6\n");
  EXPECT_EQ(in_plain_dialect("t,x\n\"2024-05-01T10:00:00.010\",\"1.5\"\n"),
            "t,x\n2024-05-01T10:00:00.010,1.5\n");
}

TEST(TextDialect, ThousandsBeyondTheLookAreThoseOfDecimalCommas) {
  std::string text = "t;x\n", plain = "t,x\n";
  while (text.size() < (65UL << 10)) {
    text += "0,25;1,5\n";
    plain += "0.25,1.5\n";
  }
  EXPECT_EQ(in_plain_dialect(text + "0,5;1.234\n0,6;1.234,5\n"), plain + "0.5,1234\n0.6,1234.5\n");
}

TEST(TextDialect, Utf16BecomesUtf8) {
  for (const bool low_first : {true, false})
    EXPECT_EQ(in_plain_dialect(utf16("time\tx\n0\t1.5\n", low_first, true)), "time\tx\n0\t1.5\n");
  EXPECT_EQ(in_plain_dialect(utf16("time;x\n0;1,5\n0;2\n", true, false)), "time,x\n0,1.5\n0,2\n");
  using namespace std::string_view_literals;
  // E acute, a letter beyond the first plane, half of one.
  EXPECT_EQ(in_plain_dialect(std::string("\xFF\xFE\xE9\x00\x3D\xD8\x00\xDE\x3D\xD8\x41\x00"sv)),
            "\xC3\xA9\xF0\x9F\x98\x80\xEF\xBF\xBD\x41");
  EXPECT_EQ(in_plain_dialect(std::string("\xFF\xFE\x41"sv)), "");
}

TEST(TextDialect, ARowThatTheLookCutsIsNotJudged) {
  std::string text = "time\tx\n";
  while (text.size() < (64UL << 10) - 3) text += "0.25\t1.5\n";
  text += "7,5\t1\n";
  EXPECT_EQ(in_plain_dialect(text), text);
}

}  // namespace
}  // namespace kinemark::io
