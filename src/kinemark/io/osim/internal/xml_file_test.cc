// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/xml_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::io::osim {
namespace {

using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A document around one object.
XmlFile object(const std::string& inside) {
  auto file = XmlFile::parse(
      "<OpenSimDocument Version=\"40000\"><Thing name=\"t\">" + inside + "</Thing></OpenSimDocument>",
      "t.osim");
  EXPECT_TRUE(file) << file.error().message;
  return std::move(*file);
}

pugi::xml_node thing(const XmlFile& file) { return file.find_object({"Thing"}); }

/// The sentence that a getter notes.
template <class Getter>
std::string noted(const std::string& inside, Getter get) {
  XmlFile file = object(inside);
  get(file, thing(file));
  return file.error() ? file.error()->message : "";
}

TEST(XmlFile, NumbersAreReadWholeAndFinite) {
  XmlFile file = object("<a> 1.5 </a><b>-2e-3</b><c/><d>1 2 3</d><e>\n4\t5  6 7\n</e>");
  const auto t = thing(file);
  EXPECT_EQ(file.number(t, "a", 9.0), 1.5);
  EXPECT_EQ(file.number(t, "b", 9.0), -0.002);
  EXPECT_EQ(file.number(t, "c", 9.0), 9.0) << "empty";
  EXPECT_EQ(file.number(t, "none", 9.0), 9.0) << "absent";
  EXPECT_EQ(file.vector3(t, "d"), Vector3d(1, 2, 3));
  EXPECT_EQ(file.vector3(t, "none", Vector3d::Ones()), Vector3d::Ones());
  EXPECT_THAT(file.numbers(t, "e"), ElementsAre(4, 5, 6, 7));
  EXPECT_THAT(file.numbers(t, "none"), IsEmpty());
  EXPECT_FALSE(file.error().has_value());
}

TEST(XmlFile, WhatIsNoNumberIsNotedWithItsPlace) {
  const auto number = [](XmlFile& f, pugi::xml_node t) { static_cast<void>(f.number(t, "a", 0.0)); };
  const auto vector = [](XmlFile& f, pugi::xml_node t) { static_cast<void>(f.vector3(t, "a")); };
  const auto list = [](XmlFile& f, pugi::xml_node t) { static_cast<void>(f.numbers(t, "a")); };
  for (const char* bad : {"x", "1x", "1 2", "0x10"})
    EXPECT_THAT(noted(std::string("<a>") + bad + "</a>", number), HasSubstr("t.osim: Thing 't', <a>")) << bad;
  for (const char* bad : {"1 2", "1 2 3 4", "1 2 y", "1 nan 2"})
    EXPECT_THAT(noted(std::string("<a>") + bad + "</a>", vector), HasSubstr("<a>")) << bad;
  for (const char* bad : {"1 inf", "one", "1,2"})
    EXPECT_THAT(noted(std::string("<a>") + bad + "</a>", list), HasSubstr("<a>")) << bad;
}

TEST(XmlFile, TheFirstErrorIsTheOneThatIsReported) {
  XmlFile file = object("<a>x</a><b>y</b>");
  EXPECT_EQ(file.number(thing(file), "a", 1.0), 1.0) << "the reader goes on";
  EXPECT_EQ(file.number(thing(file), "b", 2.0), 2.0);
  ASSERT_TRUE(file.error().has_value());
  EXPECT_THAT(file.error()->message, HasSubstr("<a>"));
}

TEST(XmlFile, Flags) {
  XmlFile file = object("<a>true</a><b> FALSE</b><c></c>");
  EXPECT_TRUE(file.flag(thing(file), "a", false));
  EXPECT_FALSE(file.flag(thing(file), "b", true));
  EXPECT_TRUE(file.flag(thing(file), "c", true));
  EXPECT_FALSE(file.error().has_value());
  EXPECT_THAT(
      noted("<a>perhaps</a>", [](XmlFile& f, pugi::xml_node t) { static_cast<void>(f.flag(t, "a", true)); }),
      HasSubstr("'perhaps'"));
}

TEST(XmlFile, CommentsAreKeptOnlyWhereAsked) {
  const std::string xml =
      "<OpenSimDocument><Thing><!-- c --><a>1 <!-- d --> 2 3</a></Thing></OpenSimDocument>";
  auto without = XmlFile::parse(xml, "t").value();
  auto with = XmlFile::parse(xml, "t", XmlFile::Comments::kept).value();
  EXPECT_EQ(without.text().find("<!--"), std::string::npos);
  EXPECT_NE(with.text().find("<!-- c -->"), std::string::npos);
  for (XmlFile* file : {&without, &with}) {
    EXPECT_EQ(file->vector3(thing(*file), "a"), Vector3d(1, 2, 3)) << "a comment is no text";
    EXPECT_EQ(std::string(first_element(thing(*file)).name()), "a");
  }
}

TEST(XmlFile, ItsTextIsReadBackAsTheSame) {
  const auto file = XmlFile::parse(
                        "<OpenSimDocument Version=\"30000\"><Thing name=\"&lt;&amp;&quot;\"><a>1 &lt; "
                        "2</a></Thing></OpenSimDocument>",
                        "t")
                        .value();
  const auto again = XmlFile::parse(file.text(), "again").value();
  EXPECT_EQ(again.text(), file.text());
  EXPECT_EQ(again.version(), 30000);
  EXPECT_EQ(name_of(thing(again)), "<&\"");
  EXPECT_EQ(text_of(thing(again), "a"), "1 < 2");
}

TEST(XmlFile, ACopyIsATreeOfItsOwn) {
  XmlFile file = object("<a>1</a>");
  const XmlFile copy = file.copy();
  thing(file).child("a").text().set("2");
  EXPECT_EQ(text_of(thing(copy), "a"), "1");
  EXPECT_EQ(text_of(thing(file), "a"), "2");
  EXPECT_EQ(copy.name(), "t.osim");
}

TEST(XmlFile, VersionsAreThoseOfTheDocument) {
  const auto version = [](const std::string& xml) { return XmlFile::parse(xml, "t").value().version(); };
  EXPECT_EQ(version("<OpenSimDocument Version=\"40500\"><Model/></OpenSimDocument>"), 40500);
  EXPECT_EQ(version("<Model name=\"m\"/>"), 10500) << "the oldest state none";
}

TEST(XmlFile, FindsTheObjectOfTheFirstTagThereIs) {
  const auto file =
      XmlFile::parse("<OpenSimDocument><x/><B name=\"b\"/><A name=\"a\"/></OpenSimDocument>", "t").value();
  EXPECT_EQ(name_of(file.find_object({"A", "B"})), "a") << "the tag that is named first";
  EXPECT_EQ(name_of(file.find_object({"A"})), "a");
  EXPECT_FALSE(file.find_object({"C"}));
  const auto bare = XmlFile::parse("<A name=\"itself\"/>", "t").value();
  EXPECT_EQ(name_of(bare.find_object({"A"})), "itself");
}

TEST(XmlFile, SetsInOtherFilesComeIn) {
  const testing_support::ScratchFolder folder;
  ASSERT_TRUE(write_text(folder / "markers.xml",
                         "<OpenSimDocument Version=\"30000\"><MarkerSet name=\"in file\"><objects><Marker "
                         "name=\"M\"/></objects></MarkerSet></OpenSimDocument>",
                         false));
  const std::string xml =
      "<OpenSimDocument><Model><MarkerSet file=\"markers.xml\"/></Model></OpenSimDocument>";
  auto file = XmlFile::parse(xml, "t.osim").value();
  const auto path = folder.path();
  file.inline_files(&path);
  EXPECT_FALSE(file.error().has_value()) << file.error()->message;
  const auto markers = objects_of(file.find_object({"Model"}), "MarkerSet");
  ASSERT_EQ(markers.size(), 1U);
  EXPECT_EQ(name_of(markers[0]), "M");
  EXPECT_THAT(file.inlined(), ElementsAre(path / "markers.xml"));
  auto nowhere = XmlFile::parse(xml, "t.osim").value();
  nowhere.inline_files(nullptr);
  EXPECT_TRUE(nowhere.error().has_value()) << "nobody says where the file is";
}

TEST(XmlWords, AreSplitAtBlanksAndQuotedShort) {
  EXPECT_THAT(words_of("  a\tb\n c  "), ElementsAre("a", "b", "c"));
  EXPECT_THAT(words_of(" \n"), IsEmpty());
  EXPECT_EQ(in_quotes("abc"), "'abc'");
  EXPECT_LT(in_quotes(std::string(5000, 'x')).size(), 100U);
}

}  // namespace
}  // namespace kinemark::io::osim
