// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/text/v3d.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "kinemark/core/units.h"
#include "kinemark/io/file.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr V3dReadOptions k179{.rate_hz = 179.0};

/// One landmark and the angles of its segment; every header row can be another.
struct Text {
  std::string source = "\ta.c3d\ta.c3d\ta.c3d\ta.c3d\ta.c3d\ta.c3d";
  std::string signal = "\tKnee\tKnee\tKnee\tKnee\tKnee\tKnee";
  std::string type = "\tLANDMARK\tLANDMARK\tLANDMARK\tLINK_MODEL_BASED\tLINK_MODEL_BASED\tLINK_MODEL_BASED";
  std::string folder = "\tP\tP\tP\tP\tP\tP";
  std::string component = "ITEM\tX\tY\tZ\tX\tY\tZ";
  std::string rows = "1\t0.1\t-0.2\t+3\t90\t0\t-45\n2\t1e-1\t5\t6\t7\t8\t9\n";

  [[nodiscard]] std::string join(const std::string& end = "\n") const {
    return source + end + signal + end + type + end + folder + end + component + end + rows;
  }
};

V3dFile good(const std::string& text) {
  const auto file = parse_v3d(text, "t.v3d", k179);
  EXPECT_TRUE(file) << file.error().message;
  if (!file) return {};
  EXPECT_TRUE(file->trial.validate()) << file->trial.validate().error().message;
  return *file;
}

std::string bad(const std::string& text) {
  const auto file = parse_v3d(text, "t.v3d", k179);
  EXPECT_FALSE(file) << text;
  if (file) return "";
  EXPECT_EQ(file.error().code, Code::bad_input);
  EXPECT_EQ(file.error().message.find('\n'), std::string::npos) << "one sentence";
  return file.error().message;
}

TEST(ParseV3d, ReadsLandmarksInMetresAndAnglesInRadians) {
  const auto file = good(Text{}.join());
  const auto& markers = file.trial.markers;
  EXPECT_THAT(markers.names, ElementsAre("Knee"));
  EXPECT_EQ(markers.time, (TimeBase{179.0, 0.0, 2}));
  EXPECT_EQ(markers.x(0, 0), Eigen::Vector3d(0.1, -0.2, 3.0));
  EXPECT_EQ(file.trial.first_frame, 1);
  EXPECT_EQ(file.trial.units_in_file, "m");
  EXPECT_EQ(file.recorded_as, "a.c3d");
  EXPECT_THAT(file.trial.warnings, IsEmpty());
  ASSERT_EQ(file.orientations.find("Knee"), 0);
  EXPECT_EQ(file.orientations.find("Hip"), -1);
  EXPECT_EQ(file.orientations.angles(0, 0), Eigen::Vector3d(90.0, 0.0, -45.0) * kRadPerDeg);
  EXPECT_EQ(file.orientations.angles_deg.at(2), -45.0);
}

TEST(ParseV3d, AnglesTurnAboutXThenTheNewYThenTheNewZ) {
  const auto rotation = [](double a, double b, double c) {
    Text text;
    text.rows = "1\t0\t0\t0\t" + std::to_string(a) + "\t" + std::to_string(b) + "\t" + std::to_string(c);
    return good(text.join()).orientations.world_from_segment(0, 0);
  };
  using Eigen::Vector3d;
  // A quarter about x takes the segment's y up; the next rotation, about the new z, is about the world's -y.
  EXPECT_LT((rotation(90, 0, 0) * Vector3d::UnitY() - Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((rotation(90, 0, 90) * Vector3d::UnitX() - Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((rotation(90, 90, 0) * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-12);
  const auto r = rotation(-170.5, 33.25, 121.0);
  EXPECT_LT((r * r.transpose() - Eigen::Matrix3d::Identity()).norm(), 1e-12);
  EXPECT_NEAR(r(0, 2), std::sin(33.25 * kRadPerDeg), 1e-12);
}

TEST(ParseV3d, LineEndsAndTrailingTabsDoNotMatter) {
  const auto plain = good(Text{}.join());
  std::string crlf;
  for (const char c : Text{}.join()) crlf += c == '\n' ? "\r\n" : std::string(1, c);
  Text tabs;
  tabs.rows = "1\t0.1\t-0.2\t+3\t90\t0\t-45\t\t\n2\t1e-1\t5\t6\t7\t8\t9\t\n";
  for (const auto& text :
       {crlf, tabs.join("\t\n"), Text{}.join() + "\n \t\n", "\xEF\xBB\xBF" + Text{}.join()}) {
    const auto file = good(text);
    EXPECT_EQ(file.trial.markers.x_in_world, plain.trial.markers.x_in_world);
    EXPECT_EQ(file.orientations.angles_deg, plain.orientations.angles_deg);
    EXPECT_THAT(file.trial.warnings, IsEmpty());
  }
}

TEST(ParseV3d, NamesAndPathsOfEitherEncodingComeOutInUtf8) {
  Text text;
  text.source =
      "\tC:\\Micka\xEBl\tC:\\Micka\xEBl\tC:\\Micka\xEBl\tC:\\Micka\xEBl\tC:\\Micka\xEBl\tC:\\Micka\xEBl";
  EXPECT_EQ(good(text.join()).recorded_as, "C:\\Micka\xC3\xABl");
  text.source = "\t\xC3\xAB\t\xC3\xAB\t\xC3\xAB\t\xC3\xAB\t\xC3\xAB\t\xC3\xAB";
  EXPECT_EQ(good(text.join()).recorded_as, "\xC3\xAB");
}

TEST(ParseV3d, MissingCellsAreMissingSamplesAndZerosAreNot) {
  Text text;
  text.rows =
      "7\t0\t0\t0\t1\t2\t3\n"
      "8\t\t\t\t\t2\t3\n"
      "9\t1\tNaN\t3\t1\t2\t3\n"
      "10\t1\tinf\t3\t1\t2\t3\n"
      "11\t1\t2\t3\t4\n"
      "13\t1\t2\t3\t4\t5\t6\t7\n"
      "\nrest\n";
  const auto file = good(text.join());
  const auto& markers = file.trial.markers;
  EXPECT_EQ(file.trial.first_frame, 7);
  ASSERT_EQ(markers.frames(), 6);
  const std::vector<bool> seen{true, false, false, false, true, true};
  for (std::int64_t f = 0; f < 6; ++f)
    EXPECT_EQ(markers.present(f, 0), seen[static_cast<std::size_t>(f)]) << f;
  EXPECT_TRUE(std::isnan(file.orientations.angles(1, 0).x()));
  EXPECT_NEAR(file.orientations.angles(1, 0).y(), 2 * kRadPerDeg, 1e-15);
  EXPECT_TRUE(std::isnan(file.orientations.world_from_segment(1, 0)(0, 0)));
  EXPECT_TRUE(std::isnan(file.orientations.angles(4, 0).z()));
  EXPECT_THAT(file.trial.warnings,
              ElementsAre(HasSubstr("a blank line ends the data; line 13"), HasSubstr("ITEM jumps 1 times"),
                          HasSubstr("1 of 6 rows end before"), HasSubstr("1 of 6 rows hold cells beyond"),
                          HasSubstr("2 samples have one or two blank")));
}

TEST(ParseV3d, OtherTypesAndOtherRecordingsAreLeftOutAndSaid) {
  Text text;
  text.type = "\tLANDMARK\tLANDMARK\tLANDMARK\tANALOG\tANALOG\tFORCE";
  text.signal = "\tKnee\tKnee\tKnee\tEMG1\tEMG2\tFP";
  text.component = "ITEM\tX\tY\tZ\tX\tX\tmagnitude";
  const auto file = good(text.join());
  EXPECT_EQ(file.trial.markers.x(1, 0), Eigen::Vector3d(0.1, 5.0, 6.0));
  EXPECT_THAT(file.orientations.names, IsEmpty());
  EXPECT_THAT(file.trial.warnings, ElementsAre(HasSubstr("2 columns of type 'ANALOG' are not read"),
                                               HasSubstr("1 columns of type 'FORCE'")));
  Text two;
  two.source = "\ta.c3d\ta.c3d\ta.c3d\tb.c3d\tb.c3d\tb.c3d";
  two.type = "\tLANDMARK\tLANDMARK\tLANDMARK\tLANDMARK\tLANDMARK\tLANDMARK";
  EXPECT_THAT(good(two.join()).trial.warnings,
              ElementsAre(HasSubstr("3 columns come from other recordings than the first, 'a.c3d'")));
}

TEST(ParseV3d, ComponentsMayStandInAnyOrder) {
  Text text;
  text.component = "ITEM\tZ\tX\tY\tx\tz\ty";
  const auto file = good(text.join());
  EXPECT_EQ(file.trial.markers.x(0, 0), Eigen::Vector3d(-0.2, 3.0, 0.1));
  EXPECT_EQ(file.orientations.angles(0, 0), Eigen::Vector3d(90.0, -45.0, 0.0) * kRadPerDeg);
}

TEST(ParseV3d, BadFilesGetOneSentence) {
  const auto with = [](auto member, const std::string& value) {
    Text text;
    text.*member = value;
    return bad(text.join());
  };
  EXPECT_THAT(bad(""), HasSubstr("t.v3d: line 1: the file ends; expected the row of source files"));
  EXPECT_THAT(bad("\ta\n\tb\n"), HasSubstr("line 3: the file ends; expected the row of signal types"));
  EXPECT_THAT(with(&Text::component, "FRAME\tX\tY\tZ\tX\tY\tZ"),
              HasSubstr("line 5, column 1: 'FRAME'; expected ITEM"));
  EXPECT_THAT(with(&Text::signal, "\tKnee\tKnee"),
              HasSubstr("line 2: 2 signal names; row 5 has 6 components"));
  EXPECT_THAT(with(&Text::signal, "\tA\tKnee\tKnee\tKnee\tKnee\tKnee"),
              HasSubstr("line 5: signal 'A' has not all of X, Y and Z"));
  EXPECT_THAT(with(&Text::signal, "\t\t\t\tKnee\tKnee\tKnee"),
              HasSubstr("line 2, column 2: the signal has no name"));
  EXPECT_THAT(with(&Text::component, "ITEM\tX\tY\tY\tX\tY\tZ"),
              HasSubstr("line 5, column 4: Y of signal 'Knee' (LANDMARK) occurs twice"));
  EXPECT_THAT(with(&Text::component, "ITEM\tX\tY\tW\tX\tY\tZ"),
              HasSubstr("line 5, column 4: component 'w'; expected X, Y or Z"));
  EXPECT_THAT(with(&Text::type, "\tA\tA\tA\tA\tA\tA"), HasSubstr("line 3: no signal is of type LANDMARK"));
  EXPECT_THAT(with(&Text::rows, ""), HasSubstr("line 6: the file ends before the first row"));
  EXPECT_THAT(with(&Text::rows, "one\t1\t2\t3\t4\t5\t6\n"), HasSubstr("line 6, column 1: ITEM is 'one'"));
  EXPECT_THAT(with(&Text::rows, "1.5\t1\t2\t3\t4\t5\t6\n"), HasSubstr("expected a whole number"));
  EXPECT_THAT(with(&Text::rows, "1\t1\t2\t3\t4\tx\t6\n"),
              HasSubstr("line 6, column 6: Y of signal 'Knee' is 'x'; expected a number"));
}

TEST(ParseV3d, ShortRowsCannotAskForMuchMemory) {
  Text text;
  std::string wide[5] = {"", "", "", "", "ITEM"};
  for (int i = 0; i < 20'000; ++i)
    for (const char axis : {'X', 'Y', 'Z'}) {
      wide[0] += "\ta";
      wide[1] += "\t" + std::to_string(i);
      wide[2] += "\tTARGET";
      wide[3] += "\tP";
      wide[4] += std::string("\t") + axis;
    }
  text = {.source = wide[0], .signal = wide[1], .type = wide[2], .folder = wide[3], .component = wide[4]};
  text.rows.clear();
  for (int i = 0; i < 2000; ++i) text.rows += "1\n";
  EXPECT_THAT(bad(text.join()), HasSubstr("do not fit into the"));
}

TEST(ParseV3d, WithoutARateItAsksForOne) {
  for (const double rate : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    const auto file = parse_v3d(Text{}.join(), "t.v3d", {.rate_hz = rate});
    ASSERT_FALSE(file);
    EXPECT_EQ(file.error().code, Code::usage);
    EXPECT_THAT(file.error().message, HasSubstr("t.v3d: a Visual3D text export stores no rate"));
  }
}

TEST(ReadV3d, MissingFilesAreSaid) {
  const testing_support::ScratchFolder scratch;
  EXPECT_EQ(read_v3d(scratch / "absent.v3d", k179).error().code, Code::io);
  ASSERT_TRUE(write_text(scratch / "t.v3d", Text{}.join(), false));
  const auto file = read_v3d(scratch / "t.v3d", k179);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->trial.source, (scratch / "t.v3d").string());
}

TEST(ReadV3d, TheTaiChiRecording) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto file = read_v3d(data / "motionmachine-taichi/taichi.v3d", k179);
  ASSERT_TRUE(file) << file.error().message;
  const auto& markers = file->trial.markers;
  EXPECT_EQ(markers.frames(), 2990);
  EXPECT_EQ(markers.markers(), 21);
  EXPECT_EQ(file->orientations.names, markers.names);
  EXPECT_EQ(markers.x(0, markers.find("FHead")), Eigen::Vector3d(-0.216436, -0.185403, 1.739107));
  EXPECT_EQ(markers.count_missing(), 0);
  EXPECT_THAT(file->recorded_as, HasSubstr("Users\\Micka\xC3\xABl\\"));
  EXPECT_THAT(file->trial.warnings, IsEmpty());
}

}  // namespace
}  // namespace kinemark::io
