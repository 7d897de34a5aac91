// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/edit_service.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <future>
#include <string>

#include "kinemark/io/edits/edit_journal.h"
#include "kinemark/io/file.h"
#include "kinemark/io/markers/marker_file.h"
#include "support/scratch.h"

namespace kinemark::server {
namespace {

using data::EditKind;
using ::testing::HasSubstr;

TEST(EditRequest, IsANumberAndAnOperation) {
  const auto asked =
      parse_edit_request(R"({"expected":12,"edit":{"do":"swap","marker":"A","with":"B","first":120}})")
          .value();
  EXPECT_EQ(asked.expected, 12U);
  EXPECT_EQ(asked.edit.kind, EditKind::swap);
  EXPECT_EQ(asked.edit.marker, "A");
  EXPECT_EQ(asked.edit.other, "B");
  EXPECT_EQ(asked.edit.first_frame, 120);
  EXPECT_EQ(parse_edit_request(R"({"edit":{"do":"undo"},"expected":0})").value().edit.count, 1);
}

TEST(EditRequest, NamesAreTakenAsTheyAre) {
  const auto asked =
      parse_edit_request(R"({"expected":0,"edit":{"do":"cut","marker":"</script><img onerror=\"x\">"}})")
          .value();
  EXPECT_EQ(asked.edit.marker, "</script><img onerror=\"x\">");
}

TEST(EditRequest, AnythingElseIsOneSentence) {
  const std::string deep =
      R"({"expected":0,"edit":{"do":)" + std::string(1800, '[') + std::string(1800, ']') + "}}";
  for (const std::string& body :
       {std::string(), std::string("null"), std::string("[]"), std::string("{}"), std::string("{"),
        std::string(R"({"expected":0})"), std::string(R"({"edit":{"do":"undo"}})"),
        std::string(R"({"expected":-1,"edit":{"do":"undo"}})"),
        std::string(R"({"expected":1.5,"edit":{"do":"undo"}})"),
        std::string(R"({"expected":"1","edit":{"do":"undo"}})"),
        std::string(R"({"expected":99999999999999999999,"edit":{"do":"undo"}})"),
        std::string(R"({"expected":0,"edit":[]})"),
        std::string(R"({"expected":0,"edit":{"do":"undo"},"more":1})"),
        std::string(R"({"expected":0,"edit":{"do":"explode"}})"),
        std::string(R"({"expected":0,"edit":{"do":"cut"}})"),
        std::string(R"({"expected":0,"edit":{"do":"cut","marker":7}})"),
        std::string(R"({"expected":0,"edit":{"do":"undo","marker":"A"}})"), std::string("\xff\xfe"), deep}) {
    const auto asked = parse_edit_request(body);
    ASSERT_FALSE(asked) << body.substr(0, 80);
    EXPECT_EQ(asked.error().code, Code::bad_input);
    EXPECT_LT(asked.error().message.size(), 300U);
    EXPECT_THAT(asked.error().message, ::testing::Not(HasSubstr("\n")));
  }
}

using nlohmann::json;
using ::testing::HasSubstr;

/// Two seconds of two knees and a point that nobody named, `shift` m along x.
data::Trial recording(double shift = 0.0) {
  data::Trial trial;
  trial.first_frame = 501;
  auto& t = trial.markers = data::Trajectories::all_missing({"LKNE", "RKNE", "*12"},
                                                            {.rate_hz = 100.0, .t0_s = 5.0, .frames = 200});
  for (std::int64_t f = 0; f < t.frames(); ++f)
    for (std::int64_t m = 0; m < t.markers(); ++m) {
      t.x(f, m) = Eigen::Vector3d(shift + 0.001 * static_cast<double>(f), 0.1 * static_cast<double>(m), 1.0);
      t.state[t.index(f, m)] = data::SampleState::measured;
    }
  return trial;
}

class EditServiceThread : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"walk.c3d", "run.c3d", "jump.c3d"})
      ASSERT_TRUE(io::write_markers(scratch_ / name, recording(), false));
  }
  Response ask(const Request& request, const std::string& name = "walk.c3d", bool wants_data = false) {
    std::promise<Response> promise;
    EXPECT_TRUE(service_.handle(request, {.number = 1, .path = scratch_ / name}, wants_data,
                                [&](Response response) { promise.set_value(std::move(response)); }));
    return promise.get_future().get();
  }
  Response get(const std::string& name = "walk.c3d") { return ask({.method = "GET"}, name); }
  Response post(std::size_t expected, const json& edit, const std::string& name = "walk.c3d") {
    return ask({.method = "POST",
                .type = "application/json",
                .body = json{{"expected", expected}, {"edit", edit}}.dump()},
               name);
  }
  static json read(const Response& response) { return json::parse(*response.body); }
  [[nodiscard]] std::size_t lines(const std::string& journal = "walk_edits.jsonl") const {
    const auto text = io::read_text(scratch_ / journal).value_or("");
    return static_cast<std::size_t>(std::ranges::count(text, '\n'));
  }

  testing_support::ScratchFolder scratch_;
  EditService service_{{.most_sessions = 2, .time_now = [] { return std::string("2026-11-24T09:30:00Z"); }}};
  json relabel_{{"do", "relabel"}, {"marker", "*12"}, {"to", "RANK"}};
};

TEST_F(EditServiceThread, AnOperationIsOnTheDiskWhenItIsAnswered) {
  const auto original = io::read_text(scratch_ / "walk.c3d").value();
  EXPECT_EQ(read(get())["edits"].size(), 0U);
  const auto response = post(0, relabel_);
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(response.type, "application/json");
  EXPECT_TRUE(response.admitted);
  EXPECT_EQ(lines(), 2U);
  const auto state = read(response);
  EXPECT_EQ(state["edits"][0]["words"], "relabel of '*12' to 'RANK'");
  EXPECT_EQ(state["edits"][0]["made"], "2026-11-24T09:30:00Z");
  EXPECT_EQ(state["undo"], 1);
  EXPECT_EQ(state["changes"]["last"].size(), 2U);
  EXPECT_EQ(read(get()), state);
  EXPECT_EQ(io::read_text(scratch_ / "walk.c3d").value(), original);
}

TEST_F(EditServiceThread, UndoAndRedoAreOperationsToo) {
  EXPECT_EQ(post(0, relabel_).status, 200);
  const auto digest = read(get())["digest"];
  auto state = read(post(1, {{"do", "undo"}}));
  EXPECT_EQ(state["edits"][0]["in_force"], false);
  EXPECT_EQ(state["redo"], 1);
  EXPECT_NE(state["digest"], digest);
  state = read(post(2, {{"do", "redo"}}));
  EXPECT_EQ(state["edits"][0]["in_force"], true);
  EXPECT_EQ(state["digest"], digest);
  EXPECT_EQ(post(3, {{"do", "redo"}}).status, 422);
}

TEST_F(EditServiceThread, TheDataAreThoseOfTheEditedRecording) {
  EXPECT_EQ(post(0, relabel_).status, 200);
  const auto data = read(ask({.method = "GET"}, "walk.c3d", true));
  EXPECT_EQ(data["summary"]["schema"], "kinemark.markers_report");
  EXPECT_EQ(data["scene"]["names"][2], "RANK");
  EXPECT_EQ(data["editing"], read(get()));
}

TEST_F(EditServiceThread, WhoBelievesSomethingElseIsShownWhatThereIs) {
  EXPECT_EQ(post(0, relabel_).status, 200);
  const auto response = post(0, {{"do", "cut"}, {"marker", "LKNE"}});
  EXPECT_EQ(response.status, 409);
  EXPECT_THAT(read(response)["error"].get<std::string>(), HasSubstr("1 operation is there and not 0"));
  EXPECT_EQ(read(response)["editing"]["edits"].size(), 1U);
  EXPECT_EQ(lines(), 2U);
}

TEST_F(EditServiceThread, AnotherProgramIsSeen) {
  EXPECT_EQ(post(0, relabel_).status, 200);
  const auto recording = io::read_edits(scratch_ / "walk_edits.jsonl").value().list.recording;
  {
    auto journal = io::EditJournal::open(scratch_ / "walk_edits.jsonl", recording).value();
    ASSERT_TRUE(journal.append({.kind = data::EditKind::cut, .marker = "LKNE"}));
    EXPECT_EQ(read(get())["edits"].size(), 2U);
    const auto response = post(2, {{"do", "undo"}});
    EXPECT_EQ(response.status, 503) << "it still has the journal open";
    EXPECT_THAT(read(response)["error"].get<std::string>(), HasSubstr("is being edited by another program"));
  }
  EXPECT_EQ(post(2, {{"do", "undo"}}).status, 200);
}

TEST_F(EditServiceThread, ARefusalIsASentenceAndNothingIsWritten) {
  for (const auto& edit :
       {json{{"do", "cut"}, {"marker", "NOSE"}}, json{{"do", "unfill"}, {"marker", "LKNE"}},
        json{{"do", "cut"}, {"marker", "LKNE"}, {"first", 1}}, json{{"do", "undo"}}}) {
    const auto response = post(0, edit);
    EXPECT_EQ(response.status, 422) << edit;
    EXPECT_FALSE(read(response)["error"].get<std::string>().empty());
  }
  EXPECT_EQ(post(0, {{"do", "explode"}}).status, 400);
  EXPECT_EQ(ask({.method = "POST", .type = "application/json", .body = "{"}).status, 400);
  EXPECT_EQ(ask({.method = "POST", .type = "application/json"}).status, 400);
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "walk_edits.jsonl"));
}

TEST_F(EditServiceThread, OnlyJsonIsAnEdit) {
  const auto body = json{{"expected", 0}, {"edit", relabel_}}.dump();
  for (const char* type : {"", "text/plain", "application/x-www-form-urlencoded", "application/jsonp",
                           "text/plain, application/json", "multipart/form-data"})
    EXPECT_EQ(ask({.method = "POST", .type = type, .body = body}).status, 415) << type;
  EXPECT_EQ(ask({.method = "POST", .type = "application/json; charset=utf-8", .body = body}).status, 200);
}

TEST_F(EditServiceThread, NamesAreTextInTheAnswer) {
  const std::string name = "</script><img onerror=\"x\">";
  EXPECT_EQ(post(0, {{"do", "relabel"}, {"marker", "LKNE"}, {"to", name}}).status, 200);
  const auto response = get();
  EXPECT_EQ(response.type, "application/json");
  EXPECT_EQ(read(response)["edits"][0]["to"], name);
  const auto refused = post(1, {{"do", "cut"}, {"marker", std::string("\n<b>") + std::string(3000, 'x')}});
  EXPECT_EQ(refused.status, 400) << "no name is as long";
  EXPECT_LT(refused.body->size(), 5000U);
}

TEST_F(EditServiceThread, ARecordingThatChangesIsReadAgain) {
  EXPECT_EQ(post(0, relabel_).status, 200);
  ASSERT_TRUE(io::write_markers(scratch_ / "walk.c3d", recording(1.0), true));
  const auto response = get();
  EXPECT_EQ(response.status, 422);
  EXPECT_THAT(read(response)["error"].get<std::string>(), HasSubstr("these edits are of"));
  EXPECT_EQ(post(1, {{"do", "undo"}}).status, 422);
}

TEST_F(EditServiceThread, MoreRecordingsThanAreKeptAreEditedToo) {
  for (std::size_t i = 0; i < 3; ++i)
    for (const char* name : {"walk.c3d", "run.c3d", "jump.c3d"})
      EXPECT_EQ(post(i, {{"do", "swap"}, {"marker", "LKNE"}, {"with", "RKNE"}}, name).status, 200);
  for (const char* name : {"walk.c3d", "run.c3d", "jump.c3d"}) EXPECT_EQ(read(get(name))["undo"], 3);
}

TEST_F(EditServiceThread, WhatIsNoRecordingIsASentence) {
  ASSERT_TRUE(io::write_text(scratch_ / "a.trc", "nothing", false));
  EXPECT_EQ(get("a.trc").status, 422);
  EXPECT_EQ(get("absent.c3d").status, 503);
}

}  // namespace

}  // namespace kinemark::server
