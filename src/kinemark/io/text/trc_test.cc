// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/trc.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A TRC of two markers, 100 Hz, mm; `rows` may be anything.
std::string text_with(const std::string& rows, const std::string& names = "A\t\t\tB\t\t",
                      const std::string& values = "100\t100\t2\t2\tmm\t100\t1\t2") {
  return "PathFileType\t4\t(X/Y/Z)\tt.trc\n"
         "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames"
         "\n" +
         values + "\nFrame#\tTime\t" + names + "\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n" + rows;
}

const std::string kRows = "1\t0.00\t1\t2\t3\t4\t5\t6\n2\t0.01\t7\t8\t9\t10\t11\t12\n";

data::Trial good(const std::string& text) {
  const auto trial = parse_trc(text, "t.trc");
  EXPECT_TRUE(trial) << trial.error().message;
  if (!trial) return {};
  EXPECT_TRUE(trial->validate()) << trial->validate().error().message;
  return *trial;
}

std::string bad(const std::string& text) {
  const auto trial = parse_trc(text, "t.trc");
  EXPECT_FALSE(trial) << text;
  if (trial) return "";
  EXPECT_EQ(trial.error().code, Code::bad_input);
  EXPECT_EQ(trial.error().message.find('\n'), std::string::npos) << "one sentence";
  return trial.error().message;
}

std::string replace(std::string text, const std::string& what, const std::string& with) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), with);
}

TEST(ParseTrc, LabelsTellTheOrderOfTheAxes) {
  const std::string labels = "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n";
  const auto turned = good(replace(text_with(kRows), labels, "\t\tX1\tZ1\tY1\tZ2\tX2\tY2\n"));
  EXPECT_LT((turned.markers.x(0, 0) - Eigen::Vector3d(0.001, 0.003, 0.002)).norm(), 1e-15);
  EXPECT_LT((turned.markers.x(1, 1) - Eigen::Vector3d(0.011, 0.012, 0.010)).norm(), 1e-15);
  for (const char* usual : {"\t\tX0\tY0\tZ1\tX1\tY1\tZ2\n", "\t\tX5\tY5\tZ5\tX6\tY6\tZ6\n", "\t\tx\ty\tz\n",
                            "\t\tlat\tap\tup\tlat\tap\tup\n"})
    EXPECT_LT((good(replace(text_with(kRows), labels, usual)).markers.x(0, 0) -
               Eigen::Vector3d(0.001, 0.002, 0.003))
                  .norm(),
              1e-15)
        << usual;
  for (const char* odd : {"\t\tX1\tX1\tY1\tX2\tY2\tZ2\n", "\t\tX1\tZ1\tY1\n"})
    EXPECT_THAT(
        bad(replace(text_with(kRows), labels, odd)),
        HasSubstr("line 5: does not name x, y and z of each of the 2 markers; expected X1, Y1, Z1, X2"))
        << odd;
}

TEST(ParseTrc, NinesMarkWhatWasNotSeenAndAHeaderMayHaveCommas) {
  const auto marked = good(text_with("1\t0.00\t9999\t9999\t9999\t4\t5\t6\n2\t0.01\t7\t8\t9\t10\t11\t12\n"));
  EXPECT_FALSE(marked.markers.present(0, 0));
  EXPECT_TRUE(marked.markers.present(0, 1));
  EXPECT_THAT(marked.warnings,
              Contains("1 samples are 999, 9999, ... in all coordinates, taken as not seen"));
  EXPECT_THAT(good(text_with(kRows)).warnings, IsEmpty());
  EXPECT_EQ(
      good(text_with(kRows, "A\t\t\tB\t\t", "100,00\t100,00\t2\t2\tmm\t100,00\t1\t2")).markers.time.rate_hz,
      100.0);
}

TEST(ParseTrc, ReadsAPlainFile) {
  const auto trial = good(text_with(kRows));
  EXPECT_THAT(trial.markers.names, ElementsAre("A", "B"));
  EXPECT_EQ(trial.markers.time, (TimeBase{100.0, 0.0, 2}));
  EXPECT_EQ(trial.markers.x(1, 0), Eigen::Vector3d(0.007, 0.008, 0.009));
  EXPECT_EQ(trial.markers.x(0, 1), Eigen::Vector3d(0.004, 0.005, 0.006));
  EXPECT_THAT(trial.warnings, IsEmpty());
  EXPECT_EQ(trial.source, "t.trc");
}

TEST(ParseTrc, LineEndsAndBlankLinesDoNotMatter) {
  const auto plain = good(text_with(kRows));
  std::string crlf;
  for (const char c : text_with(kRows)) crlf += c == '\n' ? "\r\n" : std::string(1, c);
  std::string cr = text_with(kRows);
  std::replace(cr.begin(), cr.end(), '\n', '\r');
  const std::string no_blank = replace(text_with(kRows), "\n\n", "\n");
  const std::string many_blank = replace(text_with(kRows), "\n\n", "\n\n \t\n\n");
  const std::string no_end = text_with(kRows.substr(0, kRows.size() - 1));
  const std::string trailing_tabs =
      replace(replace(text_with(kRows), "\t6\n", "\t6\t\n"), "\t12\n", "\t12\t\n");
  const std::string no_axis_labels = replace(text_with(kRows), "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n", "");
  const std::string bom = "\xEF\xBB\xBF" + text_with(kRows);
  for (const std::string& text :
       {crlf, cr, no_blank, many_blank, no_end, trailing_tabs, no_axis_labels, bom}) {
    const auto trial = good(text);
    EXPECT_EQ(trial.markers.x_in_world, plain.markers.x_in_world) << text;
    EXPECT_THAT(trial.warnings, IsEmpty()) << text;
  }
}

TEST(ParseTrc, FindsNamesWhereverTheyStand) {
  for (const char* names : {"A\t\t\tB", "A\tB", "\tA\t\t\tB\t\t", "A\t\tB\t", " A \t\t\t B \t\t\t"})
    EXPECT_THAT(good(text_with(kRows, names)).markers.names, ElementsAre("A", "B")) << names;
  const auto odd = good(text_with(kRows, "left knee.1\t\t\tR:x y"));
  EXPECT_THAT(odd.markers.names, ElementsAre("left knee.1", "R:x y"));
}

TEST(ParseTrc, ColumnsWithoutANameAreNotReadAndReported) {
  const auto trial = good(text_with(kRows, "\t\t\tB"));
  EXPECT_THAT(trial.markers.names, ElementsAre("B"));
  EXPECT_EQ(trial.markers.x(0, 0), Eigen::Vector3d(0.004, 0.005, 0.006));
  EXPECT_THAT(trial.warnings, Contains(HasSubstr("1 markers between the named ones have no name")));
  const auto tail = good(text_with(kRows, "A"));
  EXPECT_EQ(tail.markers.x(1, 0), Eigen::Vector3d(0.007, 0.008, 0.009));
  EXPECT_THAT(tail.warnings, AllOf(Contains(HasSubstr("2 of 2 rows hold cells beyond the 1 named markers")),
                                   Contains(HasSubstr("header says 2 markers, 1 are named"))));
}

TEST(ParseTrc, BlanksSeparateWhereThereIsNoTab) {
  std::string text = text_with(kRows);
  std::replace(text.begin(), text.end(), '\t', ' ');
  EXPECT_EQ(good(text).markers.x_in_world, good(text_with(kRows)).markers.x_in_world);
}

TEST(ParseTrc, SeparatorsAreJudgedLineByLine) {
  const auto whole = good(text_with(kRows));
  std::string text = text_with(kRows);
  const auto with = [&](const std::string& what, const std::string& instead) {
    std::string out = text;
    return out.replace(out.find(what), what.size(), instead);
  };
  for (const auto& other : {
           with("PathFileType\t4\t", "PathFileType  4\t"),
           with("PathFileType\t4\t(X/Y/Z)\t", "PathFileType 4 (X/Y/Z) "),
           with("DataRate\tCameraRate\t", "DataRate CameraRate "),
           with("100\t100\t2\t2\tmm\t100\t1\t2", "100 100 2 2 mm 100 1 2"),
           with("Frame#\tTime\tA", "Frame#  Time\tA"),
           with("1\t0.00\t1", "1 0.00\t1"),
           with("1\t0.00\t1\t2\t3\t4\t5\t6", "1 0.00  1 2 3  4 5 6"),
           with("5\t6\n", "5\t6\t \n"),
       }) {
    const auto read = good(other);
    EXPECT_EQ(read.markers.names, whole.markers.names) << other;
    EXPECT_EQ(read.markers.x_in_world, whole.markers.x_in_world) << other;
    EXPECT_EQ(read.markers.time, whole.markers.time) << other;
    EXPECT_EQ(read.warnings, whole.warnings) << other;
  }
}

TEST(ParseTrc, AGapBetweenBlanksCannotBePlaced) {
  const auto read = parse_trc(text_with("1 0.00 1 2 3 4 5 6\n2 0.01 7 8 9\n"), "t.trc");
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message,
              AllOf(HasSubstr("line 8: holds 5 cells between blanks"), HasSubstr("6 coordinates")));
}

TEST(ParseTrc, ConvertsEveryUnitToMetres) {
  const auto first = [](const std::string& unit) {
    return good(text_with(kRows, "A\t\t\tB", "100\t100\t2\t2\t" + unit + "\t100\t1\t2")).markers.x(0, 0)[0];
  };
  EXPECT_EQ(first("mm"), 0.001);
  EXPECT_EQ(first("MM"), 0.001);
  EXPECT_EQ(first("cm"), 0.01);
  EXPECT_EQ(first("m"), 1.0);
  EXPECT_EQ(first("meters"), 1.0);
  EXPECT_NEAR(first("in"), 0.0254, 1e-16);
  const auto unsaid = good(text_with(kRows, "A\t\t\tB", "100\t100\t2\t2\t\t100\t1\t2"));
  EXPECT_EQ(unsaid.markers.x(0, 0)[0], 0.001);
  EXPECT_EQ(unsaid.units_in_file, "");
  EXPECT_THAT(unsaid.warnings, ElementsAre(HasSubstr("millimetres are assumed")));
  EXPECT_THAT(bad(text_with(kRows, "A\t\t\tB", "100\t100\t2\t2\tfurlong\t100\t1\t2")),
              HasSubstr("line 3: unit 'furlong' is unknown"));
}

TEST(ParseTrc, AMisspeltUnitIsTakenForTheOneThatMakesABody) {
  const auto with_unit = [](const std::string& unit) {
    return text_with(kRows, "A\t\t\tB", "100\t100\t2\t2\t" + unit + "\t100\t1\t2");
  };
  const auto metres = good(with_unit("mete"));
  EXPECT_EQ(metres.markers.x(0, 0)[0], 1.0);
  EXPECT_EQ(metres.units_in_file, "mete");
  EXPECT_THAT(metres.warnings,
              ElementsAre(testing::AllOf(HasSubstr("line 3: unit 'mete' is unknown; taken for meter"),
                                         HasSubstr("reach over"))));
  EXPECT_THAT(
      bad(with_unit("milimeter")),
      HasSubstr("unit 'milimeter' is unknown, and the markers, which reach over 9 of it, do not tell"))
      << "a body of millimetres is none";
}

TEST(ParseTrc, BlankNaNAndMissingCellsAreMissing) {
  const auto trial = good(
      text_with("1\t0.00\t\t\t\t NaN\tnan\t-nan(ind)\n2\t0.01\t7\t8\t9\n3\t0.02\t1\t\t3\t4\tNAN\tinf\n"));
  EXPECT_FALSE(trial.markers.present(0, 0));
  EXPECT_FALSE(trial.markers.present(0, 1));
  EXPECT_TRUE(trial.markers.present(1, 0));
  EXPECT_FALSE(trial.markers.present(1, 1));
  EXPECT_EQ(trial.markers.count_missing(), 5);
  EXPECT_THAT(trial.warnings, AllOf(Contains(HasSubstr("1 of 3 rows end before the last marker")),
                                    Contains(HasSubstr("2 samples have one or two blank coordinates")),
                                    Contains(HasSubstr("1 of 2 markers have no sample in any frame: 'B'")),
                                    Contains(HasSubstr("header says 2 frames, 3 rows"))));
  EXPECT_THAT(good(text_with("1\t0\t1\t2\tinf\t1\t1\t1\n")).warnings,
              Contains(HasSubstr("1 samples are infinite")));
}

std::string rows_of(const std::vector<std::string>& samples) {
  std::string out;
  for (std::size_t i = 0; i < samples.size(); ++i)
    out += std::to_string(i + 1) + "\t" + std::to_string(0.01 * static_cast<double>(i)) + "\t" + samples[i] +
           "\t1\t1\t1\n";
  return out;
}

TEST(ParseTrc, ZerosAreNotSeenUnlessTheMarkerPassesTheOrigin) {
  const std::string far = "100\t0\t0", near = "0.5\t0\t0", zero = "0\t0.000\t-0";
  const auto missing_of = [&](const std::vector<std::string>& samples) {
    return good(text_with(rows_of(samples))).markers.count_missing();
  };
  EXPECT_EQ(missing_of({zero, zero, zero}), 3) << "always zero";
  EXPECT_EQ(missing_of({far, zero, far}), 1);
  EXPECT_EQ(missing_of({far, zero, zero, near}), 2) << "one side far away";
  EXPECT_EQ(missing_of({near, zero, near}), 0) << "passes through the origin";
  EXPECT_EQ(missing_of({near, zero, zero}), 0) << "ends at the origin";
  EXPECT_EQ(missing_of({zero, near}), 0);
  EXPECT_EQ(missing_of({near, zero, "\t\t"}), 2) << "the frame after it is not known";
  EXPECT_EQ(missing_of({near, zero, near, far, zero, zero, far}), 2) << "each run by itself";
  EXPECT_EQ(missing_of({"0\t0\t1"}), 0) << "one coordinate suffices";
}

TEST(ParseTrc, ZerosAreDistinguished) {
  const auto warnings = [](const std::vector<std::string>& samples) {
    return good(text_with(rows_of(samples), "A\t\t\tB", "100\t100\t\t\tmm\t100\t1\t2")).warnings;
  };
  EXPECT_THAT(warnings({"0\t0\t0", "0\t0\t0"}),
              ElementsAre(HasSubstr("1 of 2 markers are (0, 0, 0) in every frame, taken as not seen: 'A'")));
  EXPECT_THAT(warnings({"9\t9\t9", "0\t0\t0", "9\t9\t9"}),
              ElementsAre(HasSubstr("1 samples of 1 markers are exactly (0, 0, 0), taken as not seen: 'A'")));
  EXPECT_THAT(warnings({"1\t1\t1", "0\t0\t0", "1\t1\t1"}), IsEmpty());
}

TEST(ParseTrc, ABlankLineEndsTheData) {
  const auto trial = good(text_with(kRows + "\n3\t0.02\tx\n"));
  EXPECT_EQ(trial.markers.frames(), 2);
  EXPECT_THAT(trial.warnings, ElementsAre(HasSubstr("line 10 and what follows is not read")));
  EXPECT_THAT(good(text_with(kRows + "\n\t\t\n\n")).warnings, IsEmpty());
}

TEST(ParseTrc, FrameNumbersAreKept) {
  EXPECT_EQ(good(text_with("0\t0.00\t1\t2\t3\t4\t5\t6\n1\t0.01\t7\t8\t9\t10\t11\t12\n")).first_frame, 0);
  EXPECT_EQ(good(text_with("1163\t0.00\t1\t2\t3\t4\t5\t6\n1164\t0.01\t7\t8\t9\t10\t11\t12\n")).first_frame,
            1163);
  EXPECT_EQ(good(text_with("\t0.00\t1\t2\t3\t4\t5\t6\n\t0.01\t7\t8\t9\t10\t11\t12\n")).first_frame, 1);
  EXPECT_THAT(good(text_with("1\t0.00\t1\t2\t3\t4\t5\t6\n5\t0.01\t7\t8\t9\t10\t11\t12\n")).warnings,
              ElementsAre(HasSubstr("frame numbers jump 1 times")));
}

TEST(ParseTrc, RateAndTimeAreChecked) {
  const std::string three = kRows + "3\t0.02\t1\t1\t1\t1\t1\t1\n";
  EXPECT_THAT(good(text_with(three, "A\t\t\tB", "50\t50\t3\t2\tmm\t50\t1\t3")).warnings,
              ElementsAre(HasSubstr("header says 50 Hz, but the time column runs at 100 Hz")));
  const auto unknown = good(text_with(kRows, "A\t\t\tB", "0\t0\t2\t2\tmm\t0\t1\t2"));
  EXPECT_EQ(unknown.markers.time.rate_hz, 100.0);
  EXPECT_THAT(unknown.warnings,
              ElementsAre("line 3: DataRate is 0, which is taken as not known",
                          HasSubstr("header gives no rate; 100 Hz is taken from the time column")));
  const auto stand_in = good(text_with(kRows, "A\t\t\tB", "0\t100\t2\t2\tmm\t0\t1\t2"));
  EXPECT_THAT(stand_in.warnings, ElementsAre(HasSubstr("DataRate is 0")));
  EXPECT_THAT(good(text_with(kRows, "A\t\t\tB", "100\t0\t2\t2\tmm\t0\t1\t2")).warnings, ElementsAre());
  EXPECT_EQ(good(text_with(kRows, "A\t\t\tB", "\t\t2\t2\tmm")).markers.time.rate_hz, 100.0);
  EXPECT_EQ(good(text_with("7\t0.25\t1\t2\t3\t4\t5\t6\n")).markers.time, (TimeBase{100.0, 0.25, 1}));
}

TEST(ParseTrc, TimeThatLiesIsRefused) {
  EXPECT_THAT(bad(text_with("1\t0.02\t1\t2\t3\t4\t5\t6\n2\t0.01\t7\t8\t9\t1\t2\t3\n")),
              HasSubstr("t.trc: line 8 (frame 2): time goes back from 0.02 to 0.01 s"));
  EXPECT_THAT(bad(text_with("5\t1.5\t1\t2\t3\t4\t5\t6\n6\t1.5\t7\t8\t9\t1\t2\t3\n")),
              HasSubstr("line 8 (frame 6): time stands still at 1.5 s"));
  for (const char* rate : {"-100", "nan", "inf", "1e+30", "1e-09"})
    EXPECT_THAT(bad(text_with(kRows, "A\t\t\tB", std::string(rate) + "\t100\t2\t2\tmm")),
                HasSubstr("line 3: DataRate is " + std::string(rate)));
  EXPECT_THAT(bad(text_with(kRows, "A\t\t\tB", "100\t-100\t2\t2\tmm")), HasSubstr("CameraRate is -100"));
}

TEST(ParseTrc, AHoleInTimeIsMissingFrames) {
  std::string rows;
  for (int i = 0; i < 20; ++i)
    rows += std::to_string(i + 1) + "\t" + std::to_string(0.01 * (i < 12 ? i : i + 500)) + "\t" +
            std::to_string(i) + "\t2\t3\t4\t5\t6\n";
  const auto trial = good(text_with(rows, "A\t\t\tB", "100\t100\t20\t2\tmm"));
  EXPECT_EQ(trial.markers.time, (TimeBase{100.0, 0.0, 520}));
  EXPECT_THAT(trial.warnings, ElementsAre(HasSubstr("1 hole, the first at line 19 (frame 13)")));
  EXPECT_EQ(trial.markers.count_missing(), 2 * 500);
  EXPECT_EQ(trial.markers.x(11, 0).x(), 0.011);
  EXPECT_FALSE(trial.markers.present(12, 0));
  EXPECT_FALSE(trial.markers.present(511, 1));
  EXPECT_EQ(trial.markers.x(512, 0).x(), 0.012);
  EXPECT_EQ(trial.markers.x(519, 1).z(), 0.006);
}

TEST(ParseTrc, NamesMayBeInLatin1AndHoldAnything) {
  EXPECT_THAT(good(text_with(kRows, "\xE9paule\t\t\tB\x1B[2J\t\t")).markers.names,
              ElementsAre("épaule", "B [2J"));
  EXPECT_THAT(good(text_with(kRows, "épaule\t\t\t肩\t\t")).markers.names, ElementsAre("épaule", "肩"));
  EXPECT_THAT(good(text_with(kRows, "A\x01\t\t\tA\x02\t\t")).markers.names, ElementsAre("A", "A_2"));
  const std::string longest(100'000, 'M');
  EXPECT_THAT(good(text_with(kRows, longest + "\t\t\tB\t\t")).markers.names, ElementsAre(longest, "B"));
}

TEST(ParseTrc, NamesThatStandTwiceGetANumber) {
  const auto trial = good(text_with(kRows, "A\t\t\tA\t\t"));
  EXPECT_THAT(trial.markers.names, ElementsAre("A", "A_2"));
  EXPECT_THAT(trial.warnings,
              Contains("line 4 repeats 1 marker names ('A' is the first); a number is added to each"));
  EXPECT_EQ(trial.markers.x(0, 1), good(text_with(kRows)).markers.x(0, 1));
}

TEST(ParseTrc, SaysLineAndColumnOfWhatIsWrong) {
  EXPECT_EQ(bad(text_with("1\t0.00\t1\t2\tx7\t4\t5\t6\n")),
            "t.trc: line 7, column 5: z of marker 'A' is 'x7'; expected a number");
  EXPECT_EQ(bad(text_with(kRows + "3\t\t1\t2\t3\t4\t5\t6\n")),
            "t.trc: line 9, column 2: the time is blank; expected a number");
  EXPECT_EQ(bad(text_with("one\t0.00\t1\t2\t3\t4\t5\t6\n")),
            "t.trc: line 7, column 1: the frame number is 'one'; expected a number");
  EXPECT_THAT(bad(text_with("1.5\t0.00\t1\t2\t3\t4\t5\t6\n")), HasSubstr("line 7, column 1"));
  EXPECT_THAT(bad(text_with("1\tnan\t1\t2\t3\t4\t5\t6\n")), HasSubstr("line 7, column 2"));
  EXPECT_THAT(bad(text_with("1\t0,01\t1,5\t2\t3\t4\t5\t6\n")), HasSubstr("column 2: the time is '0,01'"));
  EXPECT_THAT(bad(text_with(kRows, "\t\t")), HasSubstr("line 4: names no marker"));
  EXPECT_THAT(bad(text_with(kRows, "A\t\t\tB", "fast\t100\t2\t2\tmm")),
              HasSubstr("line 3, column 1 (DataRate): 'fast' is not a number"));
  EXPECT_THAT(bad(replace(text_with(kRows), "DataRate", "Rate")),
              HasSubstr("line 2: found 'Rate?CameraRate"));
  EXPECT_THAT(bad(replace(text_with(kRows), "Frame#", "Label")), HasSubstr("line 4: found 'Label"));
  EXPECT_THAT(bad(text_with("1\t0\t1\t2\t3\t4\t5\t6\n", "A\t\t\tB", "0\t0\t1\t2\tmm")),
              HasSubstr("a single row does not determine"));
}

TEST(ParseTrc, EveryCutOffHeaderIsOneSentence) {
  const std::string whole = text_with(kRows);
  const std::size_t header_end = whole.find("\n1\t");
  for (std::size_t length = 0; length <= header_end; ++length) bad(whole.substr(0, length));
  EXPECT_THAT(bad(text_with("")), HasSubstr("ends before the first row"));
}

TEST(ParseTrc, EveryByteMayBeWrong) {
  const std::string whole = text_with(kRows);
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const char c : {'\0', '\t', '\n', ' ', '-', '9', 'e', '\xFF'}) {
      std::string text = whole;
      text[i] = c;
      const auto trial = parse_trc(text, "t");
      if (!trial) continue;
      EXPECT_TRUE(trial->validate()) << trial->validate().error().message << "\n" << text;
    }
}

TEST(ParseTrc, ShortRowsCannotAskForMuchMemory) {
  std::string names;
  for (int i = 0; i < 20'000; ++i) names += "m" + std::to_string(i) + "\t";
  std::string rows;
  for (int i = 1; i < 20'000; ++i) rows += std::to_string(i) + "\t0\n";  // 9.6 GB of samples if believed
  EXPECT_THAT(bad(text_with(rows, names)), HasSubstr("19999 rows for 20000 markers do not fit"));
  EXPECT_THAT(bad(text_with(kRows, std::string(1 << 20, '\t') + "A")),
              HasSubstr("line 4: has 1048589 bytes"));
}

TEST(WriteTrc, WritesWhatOpenSimReads) {
  const testing_support::ScratchFolder scratch;
  auto trial = good(text_with(kRows));
  trial.markers.set_missing(1, 1, data::SampleState::rejected);
  trial.first_frame = 5;
  ASSERT_TRUE(write_trc(scratch / "o.trc", trial, {.decimals = 2}));
  EXPECT_EQ(
      read_text(scratch / "o.trc").value(),
      "PathFileType\t4\t(X/Y/Z)\to.trc\n"
      "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"
      "100\t100\t2\t2\tmm\t100\t5\t2\n"
      "Frame#\tTime\tA\t\t\tB\t\t\n"
      "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
      "\n"
      "5\t0\t1.00\t2.00\t3.00\t4.00\t5.00\t6.00\n"
      "6\t0.01\t7.00\t8.00\t9.00\tNaN\tNaN\tNaN\n");
}

TEST(WriteTrc, RefusesWhatATrcCannotHold) {
  const testing_support::ScratchFolder scratch;
  auto trial = good(text_with(kRows));
  trial.markers.names[0] = "A\tB";
  EXPECT_THAT(write_trc(scratch / "o.trc", trial).error().message, HasSubstr("holds a tab"));
  trial.markers.names[0] = "B";
  EXPECT_THAT(write_trc(scratch / "o.trc", trial).error().message, HasSubstr("'B' occurs twice"));
  EXPECT_THAT(write_trc(scratch / "o.trc",
                        data::Trial{.markers = data::Trajectories::all_missing({}, {100.0, 0.0, 0})})
                  .error()
                  .message,
              HasSubstr("needs a frame and a marker"));
  EXPECT_EQ(scratch.count_files(), 0);
}

TEST(WriteTrc, NeverOverwritesUnasked) {
  const testing_support::ScratchFolder scratch;
  const auto trial = good(text_with(kRows));
  ASSERT_TRUE(write_trc(scratch / "o.trc", trial));
  EXPECT_EQ(write_trc(scratch / "o.trc", trial).error().code, Code::io);
  EXPECT_TRUE(write_trc(scratch / "o.trc", trial, {.force = true}));
}

}  // namespace
}  // namespace kinemark::io
