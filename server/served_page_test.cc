// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/served_page.h"

#include <gmock/gmock.h>

namespace kinemark::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::ordered_json;

constexpr const char* kHostile = "</script><img src=x onerror=\"alert('x')\">&amp;";

TrialRow row(std::uint32_t number, const std::string& name) {
  return {.number = number,
          .name = name,
          .folder = "study",
          .state = RowState::read,
          .kind = "markers",
          .markers = 40,
          .frames = 1000,
          .rate_hz = 240.0,
          .duration_s = 1000.0 / 240.0,
          .measured = 0.9876};
}

/// What stands in the element that the page reads.
Json data_of(const std::string& page) {
  const std::string open = R"(id="kinemark-data">)";
  const auto first = page.find(open) + open.size();
  return Json::parse(page.substr(first, page.find("</script>", first) - first));
}

TEST(TrialsPage, HoldsARowForEachTrialAndWhereItIs) {
  const auto page = trials_page({row(1, "a.c3d"), row(7, "b.trc")}, {"study: a note"}, "/s/");
  const auto data = data_of(page);
  EXPECT_EQ(data["summary"]["schema"], "kinemark.trials");
  EXPECT_EQ(data["summary"]["root"], "/s/");
  ASSERT_EQ(data["list"]["trials"].size(), 2U);
  EXPECT_EQ(data["list"]["trials"][1]["number"], 7);
  EXPECT_EQ(data["list"]["trials"][1]["name"], "b.trc");
  EXPECT_EQ(data["list"]["notes"][0], "study: a note");
  EXPECT_EQ(data["list"], trials_json({row(1, "a.c3d"), row(7, "b.trc")}, {"study: a note"}));
}

TEST(TrialsPage, AsksForFilesBelowItsRootAlone) {
  const auto page = trials_page({row(1, "a")}, {}, "/s/");
  for (const char* file : {"href=\"/s/style.css\"", "href=\"/s/list.css\"", "src=\"/s/list.js\""})
    EXPECT_THAT(page, HasSubstr(file));
  EXPECT_THAT(page, Not(HasSubstr("@root@")));
  for (const char* target : {"/style.css", "/list.css", "/list.js"})
    EXPECT_TRUE(served_file(target)) << target;
  EXPECT_FALSE(served_file("/list.js.map"));
  EXPECT_FALSE(served_file("/"));
}

TEST(TrialsPage, NamesAreText) {
  auto hostile = row(1, kHostile);
  hostile.folder = hostile.kind = hostile.said = kHostile;
  const auto page = trials_page({hostile, row(2, "b")}, {kHostile, "\xff\x1b[31m"}, "/s/");
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  EXPECT_THAT(page, Not(HasSubstr("\x1b")));
  EXPECT_THAT(page, Not(HasSubstr("\xff")));
  EXPECT_EQ(data_of(page)["list"]["trials"][0]["name"], kHostile) << "and it is whole";
  EXPECT_EQ(data_of(page)["list"]["trials"][0]["said"], kHostile);
}

TEST(NoticePage, HasOneSentenceAndTheWayBack) {
  const auto page = notice_page(kHostile, std::string(kHostile) + " is gone", "/s/");
  EXPECT_THAT(page, Not(HasSubstr("<img")));
  const auto data = data_of(page);
  EXPECT_EQ(data["summary"]["schema"], "kinemark.notice");
  EXPECT_EQ(data["summary"]["trial"], kHostile);
  EXPECT_EQ(data["summary"]["root"], "/s/");
  EXPECT_EQ(data["sentence"], std::string(kHostile) + " is gone");
}

TEST(FactsPage, NamesAreText) {
  pipeline::MarkerFileFacts facts{.format = "C3D",
                                  .software = "<b>&\"",
                                  .labels = {"</script><img src=x onerror=alert(1)>", "\xff\x1b[31m", ""}};
  std::vector<std::string> legs;
  for (const char* stem : {"ASI", "PSI", "THI", "KNE", "TIB", "ANK", "HEE", "TOE"})
    for (const char* side : {"L", "R"}) legs.push_back(std::string(side) + stem);
  facts.set = data::find_marker_set(legs);
  facts.channels.push_back({.name = "<i>", .kind = "angle", .unit = "deg", .rate_hz = 100.0, .missing = 2});
  pipeline::InfoOutcome info;
  info.file = "/secret/place/<u>.c3d";
  info.facts = facts;
  info.warnings = {"the label <img> is odd"};
  info.contradicted = {"the body is mirrored"};
  const auto page = facts_page(info, "/s/");
  for (const char* never : {"<img", "<b>&", "<i>", "<u>", "/secret", "\x1b", "\xff"})
    EXPECT_THAT(page, Not(HasSubstr(never)));
  const auto data = data_of(page);
  EXPECT_EQ(data["summary"]["trial"], "<u>.c3d");
  EXPECT_EQ(data["warnings"][0], "the body is mirrored");
  EXPECT_EQ(data["warnings"][1], "the label <img> is odd");
  EXPECT_THAT(data["lists"].dump(), Not(HasSubstr("mirrored")));
  const auto holds = [&](const char* part, const Json& wanted) {
    for (const auto& one : data[part])
      if (one == wanted) return true;
    return false;
  };
  EXPECT_TRUE(holds("facts", {{"name", "rate, Hz"}, {"value", "not known"}})) << data["facts"];
  EXPECT_TRUE(holds("facts", {{"name", "software"}, {"value", "<b>&\""}})) << data["facts"];
  EXPECT_THAT(data["facts"].dump(), HasSubstr("\"Plug-in Gait, lower body: all of its 16 markers\""));
  EXPECT_THAT(data["lists"].dump(), HasSubstr("</script><img src=x onerror=alert(1)>"));
  EXPECT_THAT(data["lists"].dump(), HasSubstr("<i>, angle, deg, rate, Hz 100.0, missing 2"));
}

TEST(OwnPolicy, LetsNoScriptInThePageRun) {
  EXPECT_THAT(std::string(kOwnPolicy), HasSubstr("script-src 'self'"));
  EXPECT_THAT(std::string(kOwnPolicy), Not(HasSubstr("unsafe")));
  // And none stands there.
  const auto page = trials_page({row(1, "a")}, {}, "/s/");
  EXPECT_THAT(page, Not(HasSubstr("<style")));
  EXPECT_THAT(page, Not(HasSubstr(" style=")));
  EXPECT_THAT(page, Not(HasSubstr(" onclick=")));
  EXPECT_THAT(page, Not(HasSubstr("<script type=\"module\">")));
}

}  // namespace
}  // namespace kinemark::server
