// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/trial_service.h"

#include <gmock/gmock.h>

#include <atomic>
#include <future>
#include <stdexcept>

#include "kinemark/io/file.h"
#include "server/served_page.h"
#include "support/scratch.h"

namespace kinemark::server {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A service whose pages are made by the test.
class TrialServiceThread : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directory(folder_);
    write("a.trc", "one");
    write("b.trc", "two");
    start();
  }
  void TearDown() override { service_.reset(); }

  void start() {
    service_ = std::make_unique<TrialService>(
        ServiceOptions{.given = {folder_},
                       .keys = {.hosts = {"127.0.0.1:1"}, .token = "t", .session = "s"},
                       .make_page = [this](const std::filesystem::path& path) { return make(path); },
                       .describe = [this](const std::filesystem::path& path) { return describe_(path); }});
  }
  Result<Page> make(const std::filesystem::path& path) {
    ++made_;
    if (before_page_) before_page_();
    auto text = io::read_text(path);
    if (!text) return std::unexpected(text.error());
    if (*text == "throw") throw std::runtime_error("a contract");
    if (*text == "bad") return fail(Code::bad_input, "a.trc: line 1: is <bad>");
    return Page{std::make_shared<const std::string>(*text), "policy of " + *text};
  }
  void write(const std::string& name, const std::string& text) {
    ASSERT_TRUE(io::write_text(folder_ / name, text, true));
  }
  std::future<Response> ask(const std::string& target, const std::string& method = "GET") {
    auto promise = std::make_shared<std::promise<Response>>();
    auto future = promise->get_future();
    service_->handle({.method = method, .target = "/s" + target, .host = "127.0.0.1:1"},
                     [promise](Response response) { promise->set_value(std::move(response)); });
    return future;
  }
  Response get(const std::string& target) { return ask(target).get(); }
  nlohmann::json trials() { return nlohmann::json::parse(*get("/api/trials").body)["trials"]; }
  /// The list once everything in it is read.
  nlohmann::json read_trials() {
    for (;;) {
      auto list = trials();
      if (std::ranges::none_of(list, [](const auto& row) { return row["state"] == "reading"; })) return list;
      std::this_thread::yield();
    }
  }
  static std::string header(const Response& response, const std::string& name) {
    for (const auto& [key, value] : response.headers)
      if (key == name) return value;
    return "";
  }

  testing_support::ScratchFolder scratch_;
  std::filesystem::path folder_ = scratch_ / "study";
  std::atomic<int> made_ = 0;
  std::function<void()> before_page_;
  std::function<TrialRow(const std::filesystem::path&)> describe_ = [](const std::filesystem::path& path) {
    auto row = unread_row(path);
    row.state = RowState::read;
    row.frames = static_cast<std::int64_t>(io::read_text(path).value_or("").size());
    return row;
  };
  std::unique_ptr<TrialService> service_;
};

TEST_F(TrialServiceThread, AStrangerLearnsNothing) {
  std::promise<Response> promise;
  service_->handle({.method = "GET", .target = "/", .host = "127.0.0.1:1"},
                   [&](Response response) { promise.set_value(std::move(response)); });
  const auto response = promise.get_future().get();
  EXPECT_EQ(response.status, 401);
  EXPECT_FALSE(response.admitted);
  EXPECT_EQ(header(response, "X-Content-Type-Options"), "nosniff");
}

TEST_F(TrialServiceThread, APageOnAnotherPortReadsNothingAndWritesNothing) {
  write("a_edits.jsonl", "");
  (void)read_trials();
  const int made = made_;
  // What a browser adds to its requests, whichever page they are of: host and origin. Addresses it does not
  // know.
  for (const char* target :
       {"/", "/trial/1", "/api/trials", "/api/trial/1/edits", "/api/trial/1/data", "/style.css",
        "/trial/1/angles/now", "//trial/1", "/s", "/S/trial/1", "/t/trial/1"})
    for (const char* method : {"GET", "POST"})
      for (const auto& origin :
           {std::optional<std::string>(), std::optional<std::string>("http://127.0.0.1:2"),
            std::optional<std::string>("http://127.0.0.1:1")}) {
        std::promise<Response> promise;
        service_->handle({.method = method,
                          .target = target,
                          .host = "127.0.0.1:1",
                          .origin = origin,
                          .type = "application/json",
                          .body = "{\"expected\": 0, \"edit\": {\"do\": \"crop\", \"first\": 1}}"},
                         [&](Response response) { promise.set_value(std::move(response)); });
        const auto response = promise.get_future().get();
        EXPECT_TRUE(response.status == 401 || response.status == 403) << method << " " << target;
        EXPECT_FALSE(response.admitted);
        EXPECT_THAT(*response.body, Not(HasSubstr("a.trc")));
        for (const auto& [name, value] : response.headers) EXPECT_NE(name, "Access-Control-Allow-Origin");
      }
  EXPECT_EQ(io::read_text(folder_ / "a_edits.jsonl").value(), "");
  EXPECT_EQ(made_, made);
}

TEST_F(TrialServiceThread, TheListFillsInAndSeesWhatChanges) {
  auto list = read_trials();
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0]["name"], "a.trc");
  EXPECT_EQ(list[0]["frames"], 3);
  write("a.trc", "fourteen bytes");
  write("c.trc", "");
  list = read_trials();
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0]["frames"], 14);
  EXPECT_EQ(list[2]["number"], 3);
  const auto page = get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_THAT(*page.body, HasSubstr("\"page\": \"/trial/3\""));
  EXPECT_EQ(header(page, "Content-Security-Policy"), kOwnPolicy);
  EXPECT_EQ(header(page, "Cache-Control"), "no-store");
}

TEST_F(TrialServiceThread, TheListIsThereWhileTrialsAreBeingRead) {
  std::promise<void> go;
  auto waits = go.get_future().share();
  describe_ = [waits](const std::filesystem::path& path) {
    waits.wait();
    auto row = unread_row(path);
    row.state = RowState::read;
    return row;
  };
  for (int i = 0; i < 3; ++i)
    for (const auto& row : trials()) EXPECT_EQ(row["state"], "reading");
  EXPECT_THAT(*get("/").body, HasSubstr("\"state\": \"reading\""));
  go.set_value();
  EXPECT_EQ(read_trials().size(), 2U);
}

TEST_F(TrialServiceThread, APageIsMadeOnceUntilItsFileChanges) {
  EXPECT_EQ(*get("/trial/1").body, "one");
  EXPECT_EQ(*get("/trial/1").body, "one");
  EXPECT_EQ(made_, 1);
  write("a.trc", "other");
  const auto page = get("/trial/1");
  EXPECT_EQ(*page.body, "other");
  EXPECT_EQ(header(page, "Content-Security-Policy"), "policy of other");
  EXPECT_EQ(made_, 2);
}

TEST_F(TrialServiceThread, SeveralWhoAskAtOnceGetOnePage) {
  std::promise<void> go;
  auto waits = go.get_future().share();
  before_page_ = [waits] { waits.wait(); };
  std::vector<std::future<Response>> asked;
  for (int i = 0; i < 8; ++i) asked.push_back(ask("/trial/2"));
  EXPECT_EQ(get("/style.css").status, 200) << "others are answered meanwhile";
  EXPECT_EQ(get("/").status, 200);
  go.set_value();
  for (auto& one : asked) EXPECT_EQ(*one.get().body, "two");
  EXPECT_EQ(made_, 1);
}

TEST_F(TrialServiceThread, TooManyAtOnceAreAskedToComeAgain) {
  std::promise<void> go;
  auto waits = go.get_future().share();
  before_page_ = [waits] { waits.wait(); };
  std::vector<std::future<Response>> asked;
  for (int i = 0; i < 100; ++i) {
    asked.push_back(ask("/trial/1"));
    (void)get("/style.css");
  }
  while (get("/").status != 200) continue;  // what was asked before has been looked up by now
  go.set_value();
  int busy = 0;
  for (auto& one : asked) {
    const auto response = one.get();
    EXPECT_TRUE(response.status == 200 || response.status == 503);
    busy += response.status == 503;
  }
  EXPECT_GE(busy, 100 - 64 - 1);
}

TEST_F(TrialServiceThread, AFileThatIsGoneIsASentence) {
  EXPECT_EQ(get("/trial/1").status, 200);
  std::filesystem::remove(folder_ / "a.trc");
  const auto response = get("/trial/1");
  EXPECT_EQ(response.status, 404);
  EXPECT_THAT(*response.body, HasSubstr("a.trc: the file is no longer there"));
  EXPECT_EQ(read_trials().size(), 1U);
}

TEST_F(TrialServiceThread, AFileThatChangesWhileItIsReadIsReadAgainOrASentence) {
  int n = 0;
  before_page_ = [&] {
    if (n++ == 0) write("a.trc", "changed once");
  };
  EXPECT_EQ(*get("/trial/1").body, "changed once");
  EXPECT_EQ(made_, 2);
  before_page_ = [&] { write("b.trc", std::string(static_cast<std::size_t>(++n), 'x')); };
  const auto response = get("/trial/2");
  EXPECT_EQ(response.status, 503);
  EXPECT_THAT(*response.body, HasSubstr("b.trc: the file changes while it is read"));
  EXPECT_EQ(header(response, "Retry-After"), "1");
  before_page_ = nullptr;
  EXPECT_EQ(get("/trial/2").status, 200);
}

TEST_F(TrialServiceThread, AFileThatCannotBeReadIsASentence) {
  write("a.trc", "bad");
  auto response = get("/trial/1");
  EXPECT_EQ(response.status, 422);
  EXPECT_THAT(*response.body, HasSubstr("a.trc: line 1: is \\u003cbad>"));
  write("a.trc", "throw");
  response = get("/trial/1");
  EXPECT_EQ(response.status, 422);
  EXPECT_THAT(*response.body, HasSubstr("a contract"));
  write("a.trc", "good again");
  EXPECT_EQ(get("/trial/1").status, 200);
}

TEST_F(TrialServiceThread, AReaderThatThrowsSpoilsItsRowAlone) {
  describe_ = [](const std::filesystem::path& path) -> TrialRow {
    if (path.filename() == "a.trc") throw std::runtime_error("a contract");
    auto row = unread_row(path);
    row.state = RowState::read;
    return row;
  };
  const auto list = read_trials();
  EXPECT_EQ(list[0]["state"], "unreadable");
  EXPECT_EQ(list[0]["said"], "a contract");
  EXPECT_EQ(list[1]["state"], "read");
}

TEST_F(TrialServiceThread, WhatThereIsNotIs404) {
  for (const char* target : {"/trial/3", "/trial/0", "/trial/1/", "/../etc/passwd", "/trial/../a.trc",
                             "/a.trc", "/favicon.ico", "/?x"}) {
    const auto response = get(target);
    EXPECT_EQ(response.status, 404) << target;
    EXPECT_TRUE(response.admitted);
    EXPECT_THAT(*response.body, Not(HasSubstr(target)));
  }
}

TEST_F(TrialServiceThread, OnlyEditsAreChanged) {
  const auto post = [&](const std::string& target) {
    std::promise<Response> promise;
    service_->handle({.method = "POST",
                      .target = "/s" + target,
                      .host = "127.0.0.1:1",
                      .origin = "http://127.0.0.1:1",
                      .type = "application/json",
                      .body = "{}"},
                     [&](Response response) { promise.set_value(std::move(response)); });
    return promise.get_future().get();
  };
  for (const char* target : {"/", "/trial/1", "/api/trials", "/api/trial/1/data", "/style.css"}) {
    const auto response = post(target);
    EXPECT_EQ(response.status, 405) << target;
    EXPECT_EQ(header(response, "Allow"), "GET, HEAD");
  }
  (void)trials();
  EXPECT_EQ(post("/nothing").status, 404);
  EXPECT_EQ(post("/api/trial/9/edits").status, 404);
  const auto response = post("/api/trial/1/edits");
  EXPECT_EQ(response.status, 422) << "a.trc holds three letters";
  EXPECT_EQ(header(response, "X-Content-Type-Options"), "nosniff");
  EXPECT_EQ(get("/api/trial/1/edits").status, 422);
}

TEST_F(TrialServiceThread, APageIsMadeAnewWhenItsEditsChange) {
  EXPECT_EQ(get("/trial/1").status, 200);
  write("a_edits.jsonl", "");
  EXPECT_EQ(get("/trial/1").status, 200);
  EXPECT_EQ(made_, 2);
}

TEST_F(TrialServiceThread, StylesAndScriptAreOfTheProgram) {
  const auto style = get("/style.css"), list = get("/list.css"), script = get("/list.js");
  EXPECT_THAT(*style.body, HasSubstr("--accent"));
  EXPECT_EQ(style.type, "text/css; charset=utf-8");
  EXPECT_THAT(*list.body, HasSubstr(".tag"));
  EXPECT_EQ(script.type, "text/javascript; charset=utf-8");
  EXPECT_THAT(*script.body, Not(HasSubstr("innerHTML")));
  EXPECT_EQ(get("/api/trials").type, "application/json");
}

TEST_F(TrialServiceThread, ItsEndWaitsForNobody) {
  std::promise<void> begun, go;
  auto waits = go.get_future().share();
  std::atomic_flag first;
  before_page_ = [&, waits] {
    if (!first.test_and_set()) begun.set_value();
    waits.wait();
  };
  auto one = ask("/trial/1");
  (void)ask("/trial/2");
  begun.get_future().wait();
  std::thread ending([this] { service_.reset(); });
  go.set_value();
  ending.join();
  EXPECT_EQ(one.get().status, 200);
}

}  // namespace
}  // namespace kinemark::server
