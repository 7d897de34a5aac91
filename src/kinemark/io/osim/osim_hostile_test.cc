// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Invalid and malicious documents: each is refused quickly with one sentence that names the position.
#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "kinemark/io/file.h"
#include "kinemark/io/osim/osim_model.h"
#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

std::string refusal(const std::string& xml) {
  const auto model = parse_osim(xml, "m.osim");
  return model ? "" : model.error().message;
}

std::string document(const std::string& inside) {
  return "<OpenSimDocument Version=\"40000\"><Model name=\"m\">" + inside + "</Model></OpenSimDocument>";
}

std::string bodies(const std::string& inside) {
  return "<BodySet><objects>" + inside + "</objects></BodySet>";
}

/// One body on the ground by a CustomJoint with these insides.
std::string custom(const std::string& inside, const std::string& more = "") {
  return document(bodies("<Body name=\"b\"/>") + R"(<JointSet><objects><CustomJoint name="knee_r">
    <socket_parent_frame>/ground</socket_parent_frame><socket_child_frame>/bodyset/b</socket_child_frame>)" +
                  inside + "</CustomJoint></objects></JointSet>" + more);
}

std::string axis(const std::string& inside) {
  return custom("<SpatialTransform><TransformAxis name=\"rotation1\"><coordinates>q</coordinates>" + inside +
                "</TransformAxis></SpatialTransform>");
}

TEST(OsimHostile, NotXmlOrNotAModel) {
  EXPECT_THAT(refusal(""), StartsWith("m.osim: line 1: not an XML document"));
  EXPECT_THAT(refusal("  \n "), HasSubstr("not an XML document"));
  EXPECT_THAT(refusal("binary \x01\x02\xff"), HasSubstr("not an XML document"));
  EXPECT_THAT(refusal("<OpenSimDocument Version=\"40000\"><Model name=\"m\">\n<BodySet>"),
              StartsWith("m.osim: line 2:"));
  EXPECT_THAT(refusal("<html><body/></html>"), HasSubstr("its first element is <html>"));
  EXPECT_THAT(refusal("<OpenSimDocument><ScaleTool/></OpenSimDocument>"), HasSubstr("not an OpenSim model"));
}

TEST(OsimHostile, AnAxisMovesByACoordinateThatItsJointLists) {
  const std::string moves =
      "<SpatialTransform><TransformAxis name=\"rotation1\"><coordinates>knee_angel</coordinates><axis>0 0 "
      "1</axis>"
      "</TransformAxis></SpatialTransform>";
  EXPECT_THAT(
      refusal(custom("<coordinates><Coordinate name=\"knee_angle\"/></coordinates>" + moves)),
      HasSubstr("CustomJoint 'knee_r': moves by the coordinate 'knee_angel', which it does not list"));
  EXPECT_EQ(refusal(custom(moves)), "") << "a joint without a list has the coordinates that its axes name";
}

TEST(OsimHostile, ACutFileIsRefusedWhereverItIsCut) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const std::string whole = read_text(data / "opensim-arm26/arm26.osim").value();
  ASSERT_EQ(refusal(whole), "");
  const std::size_t end = whole.rfind("</OpenSimDocument>");
  for (std::size_t n = 0; n <= end; n += whole.size() / 97) EXPECT_NE(refusal(whole.substr(0, n)), "") << n;
  EXPECT_NE(refusal(whole.substr(0, end)), "");
}

TEST(OsimHostile, AStrayClosingTagAtTheEndIsPassedOverButNotInside) {
  EXPECT_EQ(refusal("<Model name=\"m\"></Model></OpenSimDocument>\n"), "");
  EXPECT_NE(refusal("<Model name=\"m\"></Model></OpenSimDocument><more/>"), "");
  EXPECT_NE(refusal("<Model name=\"m\"><BodySet></Model></OpenSimDocument>"), "");
}

TEST(OsimHostile, ElementNamesWithColonsAreRead) {
  EXPECT_EQ(refusal(document("<HuntCrossleyForce::ContactParametersSet name=\"c\"><objects/>"
                             "</HuntCrossleyForce::ContactParametersSet>")),
            "");
}

TEST(OsimHostile, DeepNestingIsRefusedAndWidthIsRead) {
  const int deep = 200'000;
  std::string xml = "<Model>";
  for (int i = 0; i < deep; ++i) xml += "<a>";
  for (int i = 0; i < deep; ++i) xml += "</a>";
  EXPECT_THAT(refusal(xml + "</Model>"), HasSubstr("nested deeper than"));
  std::string wide = "<Model>";
  for (int i = 0; i < deep; ++i) wide += "<a/>";
  EXPECT_EQ(refusal(wide + "</Model>"), "");
  for (int i = 0; i < 1'000'000; ++i) wide += "<a/>";
  EXPECT_THAT(refusal(wide + "</Model>"), HasSubstr("more than 1000000 tags"));
  EXPECT_EQ(refusal("<Model><!-- " + std::string(10'000, '<') + " --><a b='" + std::string(300, '<') +
                    "'/></Model>"),
            "")
      << "comments and quotes nest nothing";
}

TEST(OsimHostile, WhatBeginsAsNoXmlIsNotReadToItsEnd) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "zeros.osim", "", false));
  std::filesystem::resize_file(scratch / "zeros.osim", 1ULL << 40);  // a hole: takes no room
  EXPECT_THAT(read_osim(scratch / "zeros.osim").error().message, HasSubstr("is no XML"));
}

TEST(OsimHostile, NamesComeInTheEncodingThatIsDeclaredOrInLatin1) {
  const auto name_of = [](const std::string& declaration, const std::string& name) {
    const auto model = parse_osim(declaration + "<Model name=\"" + name + "\"/>", "m.osim");
    return model ? model->name : model.error().message;
  };
  EXPECT_EQ(name_of("", "\xE9paule"), "épaule");
  EXPECT_EQ(name_of("<?xml version=\"1.0\" encoding=\"ISO-8859-1\"?>", "\xE9paule"), "épaule");
  EXPECT_EQ(name_of("", "肩"), "肩");
  for (const char* encoding : {"Shift_JIS", "shift-jis", "CP932"})
    EXPECT_EQ(name_of("<?xml version=\"1.0\" encoding=\"" + std::string(encoding) + "\"?>", "\x8C\xA8"),
              "肩");
  EXPECT_EQ(name_of("<?xml version=\"1.0\" encoding=\"Shift_JIS\"?>", "肩"), "肩")
      << "it is UTF-8 all the same";
  EXPECT_EQ(name_of("<?xml version=\"1.0\" encoding=\"Shift_JIS\"?>", "\xE9 l"), "é l")
      << "it is no Shift-JIS";
}

TEST(OsimHostile, NumbersAndFlags) {
  EXPECT_THAT(refusal(document(bodies("<Body name=\"b\"><mass>heavy</mass></Body>"))),
              AllOf(StartsWith("m.osim: "), HasSubstr("Body 'b', <mass>: 'heavy' is not a number")));
  EXPECT_THAT(refusal(document(bodies("<Body name=\"b\"><mass_center>1 2</mass_center></Body>"))),
              HasSubstr("<mass_center>: has 2 numbers; need three"));
  EXPECT_THAT(refusal(document(bodies("<Body name=\"b\"><mass_center>1 2 1e999</mass_center></Body>"))),
              HasSubstr("'1e999' is not a finite number"));
  EXPECT_THAT(refusal(document(bodies("<Body name=\"b\"><inertia>1 2 3 4</inertia></Body>"))),
              HasSubstr("need six"));
  EXPECT_THAT(refusal(document("<gravity>down</gravity>")), HasSubstr("<gravity>: 'down'"));
  EXPECT_THAT(
      refusal(
          custom("<coordinates><Coordinate name=\"q\"><locked>perhaps</locked></Coordinate></coordinates>")),
      HasSubstr("CustomJoint 'knee_r', Coordinate 'q', <locked>: 'perhaps' is neither true nor false"));
  EXPECT_THAT(
      refusal(custom("<coordinates><Coordinate name=\"q\"><range>2 1</range></Coordinate></coordinates>")),
      HasSubstr("'2 1' is not a range"));
  EXPECT_THAT(refusal(document("<credits>" + std::string(100'000, 'x') + "</credits><gravity>" +
                               std::string(100'000, 'y') + "</gravity>"))
                  .size(),
              testing::Lt(200U))
      << "long values are cut";
}

TEST(OsimHostile, JointsThatCannotBeRead) {
  EXPECT_THAT(
      refusal(document(bodies("<Body name=\"b\"/>") +
                       "<JointSet><objects><RubberJoint name=\"j\">"
                       "<socket_parent_frame>/ground</socket_parent_frame><socket_child_frame>/bodyset/b"
                       "</socket_child_frame></RubberJoint></objects></JointSet>")),
      HasSubstr("RubberJoint 'j': joints of the type 'RubberJoint' are not supported"));
  EXPECT_THAT(refusal(document(bodies("<Body name=\"b\"/>") +
                               "<JointSet><objects><PinJoint name=\"j\"/></objects></JointSet>")),
              HasSubstr("PinJoint 'j': does not name its parent body"));
  EXPECT_THAT(refusal(document(bodies("<Body name=\"b\"/>"))),
              HasSubstr("body 'b': no joints connect it to the ground"));
  EXPECT_THAT(refusal(custom("<coordinates>" +
                             [] {
                               std::string many;
                               for (int i = 0; i < 7; ++i)
                                 many += fmt::format("<Coordinate name=\"q{}\"/>", i);
                               return many;
                             }() +
                             "</coordinates>")),
              HasSubstr("has 7 coordinates; a joint has at most six"));
  const std::string two = document(bodies("<Body name=\"b\"/>") + R"(<JointSet><objects>
    <PinJoint name="j"><socket_parent_frame>/ground</socket_parent_frame><socket_child_frame>/bodyset/b</socket_child_frame></PinJoint>
    <PinJoint name="k"><socket_parent_frame>/ground</socket_parent_frame><socket_child_frame>/bodyset/b</socket_child_frame></PinJoint>
    </objects></JointSet>)");
  EXPECT_THAT(refusal(two), HasSubstr("PinJoint 'k': closes a loop of joints"));
  EXPECT_THAT(refusal(document(bodies("<Body name=\"b\"/>") + R"(<JointSet><objects><EllipsoidJoint name="e">
    <socket_parent_frame>/ground</socket_parent_frame><socket_child_frame>/bodyset/b</socket_child_frame>
    <radii_x_y_z>1 2 -3</radii_x_y_z></EllipsoidJoint></objects></JointSet>)")),
              HasSubstr("needs three positive numbers"));
}

TEST(OsimHostile, FunctionsThatCannotBeRead) {
  EXPECT_THAT(refusal(axis("<GCVSpline name=\"function\"/>")),
              HasSubstr("CustomJoint 'knee_r', TransformAxis 'rotation1', GCVSpline 'function': functions of "
                        "the kind GCVSpline"));
  EXPECT_THAT(refusal(axis("<SimmSpline name=\"function\"><x>0 1</x><y>0</y></SimmSpline>")),
              HasSubstr("2 x and 1 y values"));
  EXPECT_THAT(refusal(axis("<SimmSpline name=\"function\"><x>0 0</x><y>0 1</y></SimmSpline>")),
              HasSubstr("must increase"));
  EXPECT_THAT(refusal(axis("<function><MultiplierFunction/></function>")),
              HasSubstr("has no function inside"));
  EXPECT_THAT(refusal(axis("<function><Sine><omega>inf</omega></Sine></function>")),
              HasSubstr("must be finite"));
  EXPECT_THAT(refusal(axis("<axis>0 0 0</axis><function><LinearFunction/></function>")),
              HasSubstr("axis of length zero"));
  EXPECT_THAT(
      refusal(custom(
          "<SpatialTransform><TransformAxis name=\"rotation1\"><coordinates>p q</coordinates></TransformAxis>"
          "</SpatialTransform>")),
      HasSubstr("depends on 2 coordinates"));
  std::string knots;
  for (int i = 0; i <= 10'000; ++i) knots += std::to_string(i) + " ";
  EXPECT_THAT(
      refusal(axis("<SimmSpline name=\"function\"><x>" + knots + "</x><y>" + knots + "</y></SimmSpline>")),
      HasSubstr("at most 10000"));
}

TEST(OsimHostile, FramesThatDoNotExistOrChaseTheirTails) {
  const auto marker = [](const std::string& path, const std::string& more = "") {
    return refusal(document("<MarkerSet><objects><Marker name=\"M\"><socket_parent_frame>" + path +
                            "</socket_parent_frame></Marker></objects></MarkerSet>" + more));
  };
  EXPECT_THAT(
      marker("/bodyset/tail"),
      HasSubstr("Marker 'M': refers to the body or frame '/bodyset/tail', which the model does not have"));
  EXPECT_THAT(marker(""), HasSubstr("does not name its body"));
  const std::string circle =
      R"(<components><PhysicalOffsetFrame name="a"><socket_parent>/b</socket_parent></PhysicalOffsetFrame>
    <PhysicalOffsetFrame name="b"><socket_parent>/a</socket_parent></PhysicalOffsetFrame></components>)";
  EXPECT_THAT(marker("/a", circle), HasSubstr("a circle or too long"));
  EXPECT_THAT(marker("/../../..//./a/..", circle), HasSubstr("which the model does not have"));
}

TEST(OsimHostile, NamesThatOccurTwiceOrDoNotExist) {
  EXPECT_THAT(refusal(document(bodies("<Body/>"))), HasSubstr("<Body>: has no name"));
  const std::string twice = "<Marker name=\"M\"><body>ground</body></Marker>";
  EXPECT_THAT(refusal(document("<MarkerSet><objects>" + twice + twice + "</objects></MarkerSet>")),
              HasSubstr("m.osim: marker name 'M' occurs twice"));
  const auto coupler = [](const std::string& inside) {
    return refusal(custom(
        "<SpatialTransform><TransformAxis name=\"rotation1\"><coordinates>q</coordinates><axis>1 0 0</axis>"
        "<LinearFunction name=\"function\"/></TransformAxis></SpatialTransform>",
        "<ConstraintSet><objects><CoordinateCouplerConstraint name=\"c\"><coupled_coordinates_function>"
        "<LinearFunction/></coupled_coordinates_function>" +
            inside + "</CoordinateCouplerConstraint></objects></ConstraintSet>"));
  };
  EXPECT_THAT(
      coupler("<independent_coordinate_names>q</independent_coordinate_names><dependent_coordinate_name>r</"
              "dependent_coordinate_name>"),
      HasSubstr("CoordinateCouplerConstraint 'c': names the coordinate 'r', which the model does not have"));
  EXPECT_THAT(coupler("<independent_coordinate_names>q q2</independent_coordinate_names>"),
              HasSubstr("couples to 2 coordinates"));
  EXPECT_THAT(
      coupler("<independent_coordinate_names>q</independent_coordinate_names><dependent_coordinate_name>q</"
              "dependent_coordinate_name>"),
      HasSubstr("form a circle"));
}

TEST(OsimHostile, ManyObjectsAreRefusedBeforeTheyCostTime) {
  std::string many;
  for (int i = 0; i < 6000; ++i) many += fmt::format("<Body name=\"b{}\"/>", i);
  EXPECT_THAT(refusal(document(bodies(many))), HasSubstr("has 6000 objects; at most 5000"));
  // As slow as the limits allow: a chain in the wrong order.
  std::string chain, joints;
  for (int i = 0; i < 4000; ++i) {
    chain += fmt::format("<Body name=\"b{}\"/>", i);
    joints =
        fmt::format(
            "<PinJoint "
            "name=\"j{0}\"><socket_parent_frame>{1}</socket_parent_frame><socket_child_frame>/bodyset/b{0}"
            "</socket_child_frame></PinJoint>",
            i, i == 0 ? "/ground" : fmt::format("/bodyset/b{}", i - 1)) +
        joints;
  }
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(refusal(document(bodies(chain) + "<JointSet><objects>" + joints + "</objects></JointSet>")), "");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST(OsimHostile, MissingAndUnreadableFiles) {
  EXPECT_EQ(read_osim("/absent/m.osim").error().code, Code::io);
  const testing_support::ScratchFolder scratch;
  EXPECT_THAT(read_osim(scratch.path()).error().message, HasSubstr("not a regular file"));
  ASSERT_TRUE(write_text(scratch / "m.osim", document("<MarkerSet file=\"m.osim\"/>"), false));
  EXPECT_THAT(read_osim(scratch / "m.osim").error().message,
              HasSubstr("the file 'm.osim' has no <MarkerSet>"));
}

}  // namespace
}  // namespace kinemark::io
