// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/angle_service.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <condition_variable>
#include <filesystem>
#include <stdexcept>
#include <thread>

#include "kinemark/io/file.h"
#include "support/scratch.h"

namespace kinemark::server {
namespace {

using ::testing::HasSubstr;

class TrialModel : public ::testing::Test {
 protected:
  void put(const std::string& name) const { ASSERT_TRUE(io::write_text(scratch_ / name, "x", false)); }
  [[nodiscard]] Result<std::filesystem::path> find(const std::filesystem::path& given = {}) const {
    return find_model(scratch_ / "walk.c3d", given);
  }
  testing_support::ScratchFolder scratch_;
};

TEST_F(TrialModel, IsTheOneThatWasGivenWhateverLiesThere) {
  put("walk.osim");
  EXPECT_EQ(find("/elsewhere/a.osim").value(), "/elsewhere/a.osim");
}

TEST_F(TrialModel, IsTheOnlyOneBesideTheRecording) {
  put("walk.c3d");
  put("Subject.OSIM");
  EXPECT_EQ(find().value(), scratch_ / "Subject.OSIM");
}

TEST_F(TrialModel, IsTheOneOfItsNameAmongSeveral) {
  put("run.osim");
  put("walk.osim");
  EXPECT_EQ(find().value(), scratch_ / "walk.osim");
}

TEST_F(TrialModel, NoneAndSeveralAreSaidWithTheWayOut) {
  EXPECT_EQ(find().error().code, Code::not_supported);
  EXPECT_THAT(find().error().message, HasSubstr("No body model is known for walk.c3d: start 'kinemark serve' "
                                                "with --model FILE.osim"));
  put("a.osim");
  put("b.osim");
  EXPECT_THAT(find().error().message, HasSubstr("2 body models lie beside walk.c3d"));
  std::filesystem::create_directory(scratch_ / "empty");
  EXPECT_FALSE(find_model(scratch_ / "empty/walk.c3d", {}));
  EXPECT_FALSE(find_model(scratch_ / "absent/walk.c3d", {}));
}

TEST_F(TrialModel, AFolderOfThatNameIsNoModel) {
  std::filesystem::create_directory(scratch_ / "walk.osim");
  EXPECT_FALSE(find());
}

using nlohmann::json;
using ::testing::HasSubstr;

/// Recordings that the test solves: a gate holds solutions back until it is opened.
class AngleServiceThread : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* name : {"walk.c3d", "run.c3d", "hop.c3d", "subject.osim"}) put(name, "x");
    start({});
  }
  void TearDown() override {
    open_gate();
    service_.reset();
  }
  void start(AngleServiceOptions options) {
    open_gate();
    options.solve = [this](const pipeline::IkJob& job) { return solve(job); };
    service_ = std::make_unique<AngleService>(std::move(options));
  }
  void put(const std::string& name, const std::string& text) const {
    ASSERT_TRUE(io::write_text(scratch_ / name, text, true));
  }
  Result<pipeline::IkPage> solve(const pipeline::IkJob& job) {
    {
      std::unique_lock lock(mutex_);
      jobs_.push_back(job);
      changed_.notify_all();
      changed_.wait(lock, [this] { return is_open_; });
    }
    if (!job.progress(3, 10)) return fail(Code::cancelled, "stopped");
    const std::string edits =
        job.edits == io::kEditsNone ? "0" : io::read_text(scratch_ / "edits").value_or("0");
    if (edits == "throw") throw std::runtime_error("a contract");
    if (edits == "bad" || (job.edits == io::kEditsNone && unsolvable_))
      return fail(Code::bad_input, "no marker <fits>");
    pipeline::IkPage page{.html = "<p>" + edits + page_padding_,
                          .set = "set of " + edits,
                          .edits = static_cast<std::size_t>(std::stoi(edits)),
                          .digest = "digest of " + edits};
    page.summary.rms_error_m = 0.004;
    page.summary.notices = {{.level = report::Verdict::attention}, {.level = report::Verdict::good}};
    return page;
  }
  void close_gate() {
    const std::scoped_lock lock(mutex_);
    is_open_ = false;
  }
  void open_gate() {
    const std::scoped_lock lock(mutex_);
    is_open_ = true;
    changed_.notify_all();
  }
  void wait_for_jobs(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return jobs_.size() >= count; });
  }
  [[nodiscard]] TrialFile trial(std::uint32_t number = 1) const {
    constexpr std::array<const char*, 3> kFiles = {"walk.c3d", "run.c3d", "hop.c3d"};
    return {.number = number, .path = scratch_ / kFiles[number - 1]};
  }
  Response post(const std::string& body, std::uint32_t number = 1) {
    return service_->answer({.method = "POST", .type = "application/json", .body = body}, trial(number));
  }
  Response begin(std::uint32_t number = 1) { return post(R"({"do":"solve"})", number); }
  json state(std::uint32_t number = 1) {
    const auto response = service_->answer({.method = "GET"}, trial(number));
    EXPECT_EQ(response.status, 200);
    return json::parse(*response.body);
  }
  /// The state once nothing is under way.
  json settled(std::uint32_t number = 1) {
    while (true) {
      auto now = state(number);
      if (now["state"] != "waiting" && now["state"] != "solving") return now;
      std::this_thread::yield();
    }
  }
  json solve_with(const std::string& edits, std::uint32_t number = 1) {
    put("edits", edits);
    EXPECT_EQ(begin(number).status, 202);
    return settled(number);
  }
  std::string html(AnglesOf which, std::uint32_t number = 1) {
    const auto page = service_->page(trial(number), which);
    return page ? *page->html : "none";
  }

  testing_support::ScratchFolder scratch_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool is_open_ = true, unsolvable_ = false;
  std::string page_padding_;
  std::vector<pipeline::IkJob> jobs_;
  std::unique_ptr<AngleService> service_;
};

TEST_F(AngleServiceThread, AsksEverySolutionForTheSameTasksAndWeights) {
  AngleServiceOptions options;
  options.asked.tasks = "tasks.xml";
  options.asked.geometry = {"Geometry"};
  options.asked.options.marker_weights = {{"RASI", 5.0}};
  start(std::move(options));
  solve_with("2");
  const std::scoped_lock lock(mutex_);
  ASSERT_EQ(jobs_.size(), 2U) << "with edits and without";
  for (const auto& job : jobs_) {
    EXPECT_EQ(job.tasks, "tasks.xml");
    EXPECT_EQ(job.geometry.size(), 1U);
    ASSERT_EQ(job.options.marker_weights.size(), 1U);
    EXPECT_EQ(job.options.marker_weights.front().marker, "RASI");
    EXPECT_EQ(job.model, scratch_ / "subject.osim");
  }
}

TEST_F(AngleServiceThread, SolvesWithTheEditsAndOnceWithout) {
  EXPECT_EQ(state()["state"], "none");
  EXPECT_EQ(state()["model"], "subject.osim");
  EXPECT_TRUE(jobs_.empty()) << "nobody asked for it";
  const auto solved = solve_with("2");
  EXPECT_EQ(solved["state"], "solved");
  EXPECT_TRUE(solved["said"].is_null());
  const auto& now = solved["solutions"]["now"];
  EXPECT_EQ(now["digest"], "digest of 2");
  EXPECT_EQ(now["set"], "set of 2");
  EXPECT_EQ(now["edits"], 2);
  EXPECT_EQ(now["attentions"], 1);
  EXPECT_DOUBLE_EQ(now["rms_mm"], 4.0);
  EXPECT_EQ(solved["solutions"]["recorded"]["edits"], 0);
  EXPECT_TRUE(solved["solutions"]["before"].is_null());
  ASSERT_EQ(jobs_.size(), 2U);
  EXPECT_EQ(jobs_[0].edits, "beside");
  EXPECT_EQ(jobs_[0].model, scratch_ / "subject.osim");
  EXPECT_EQ(jobs_[0].markers, scratch_ / "walk.c3d");
  EXPECT_TRUE(jobs_[0].output.empty());
  EXPECT_EQ(jobs_[1].edits, io::kEditsNone);
  EXPECT_EQ(html(AnglesOf::now), "<p>2");
  EXPECT_EQ(html(AnglesOf::recorded), "<p>0");
  (void)solve_with("3");
  EXPECT_EQ(jobs_.size(), 3U) << "as recorded it is solved once";
}

TEST_F(AngleServiceThread, WithoutEditsOneSolutionIsBoth) {
  const auto solved = solve_with("0");
  EXPECT_EQ(jobs_.size(), 1U);
  EXPECT_EQ(solved["solutions"]["now"], solved["solutions"]["recorded"]);
}

TEST_F(AngleServiceThread, KeepsTheSolutionOfOtherEditsFromBefore) {
  (void)solve_with("1");
  EXPECT_EQ(solve_with("1")["solutions"]["before"], nullptr) << "the same edits are no other solution";
  EXPECT_EQ(solve_with("2")["solutions"]["before"]["digest"], "digest of 1");
  EXPECT_EQ(html(AnglesOf::before), "<p>1");
  EXPECT_EQ(html(AnglesOf::now), "<p>2");
}

TEST_F(AngleServiceThread, OneIsSolvedAtATimeAndFewWait) {
  start({.most_waiting = 1});
  close_gate();
  EXPECT_EQ(begin(1).status, 202);
  wait_for_jobs(1);
  EXPECT_EQ(state(1)["state"], "solving");
  EXPECT_EQ(begin(1).status, 409);
  EXPECT_EQ(begin(2).status, 202);
  EXPECT_EQ(state(2)["state"], "waiting");
  const auto busy = begin(3);
  EXPECT_EQ(busy.status, 503);
  EXPECT_THAT(*busy.body, HasSubstr("try again in a moment"));
  EXPECT_EQ(state(3)["state"], "none");
  EXPECT_EQ(jobs_.size(), 1U);
  open_gate();
  EXPECT_EQ(settled(2)["state"], "solved");
  EXPECT_EQ(state(1)["of"], 10);
}

TEST_F(AngleServiceThread, StopsWhatIsUnderWayAndWhatWaits) {
  (void)solve_with("1");
  close_gate();
  put("edits", "2");
  const auto before = jobs_.size();
  (void)begin(1);
  wait_for_jobs(before + 1);
  (void)begin(2);
  EXPECT_EQ(post(R"({"do":"stop"})", 1).status, 202);
  EXPECT_EQ(post(R"({"do":"stop"})", 2).status, 202);
  open_gate();
  const auto stopped = settled(1);
  EXPECT_EQ(stopped["state"], "stopped");
  EXPECT_EQ(stopped["solutions"]["now"]["digest"], "digest of 1") << "what was there stays";
  EXPECT_EQ(settled(2)["state"], "stopped");
  EXPECT_EQ(jobs_.size(), before + 1) << "what waited never began";
  EXPECT_EQ(solve_with("2", 1)["state"], "solved") << "and it can begin again";
}

TEST_F(AngleServiceThread, WhatFailsIsASentenceAndLeavesWhatWasThere) {
  (void)solve_with("1");
  const auto failed = solve_with("bad");
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_EQ(failed["said"], "no marker <fits>");
  EXPECT_EQ(failed["solutions"]["now"]["digest"], "digest of 1");
  EXPECT_THAT(solve_with("throw")["said"].get<std::string>(), HasSubstr("walk.c3d: a contract"));
  EXPECT_EQ(solve_with("2")["state"], "solved");
}

TEST_F(AngleServiceThread, WhatCannotBeSolvedAsRecordedIsSolvedWithEdits) {
  unsolvable_ = true;
  const auto solved = solve_with("2");
  EXPECT_THAT(solved["said"].get<std::string>(), HasSubstr("As recorded it cannot be solved: no marker"));
  EXPECT_EQ(solved["solutions"]["now"]["digest"], "digest of 2");
  EXPECT_TRUE(solved["solutions"]["recorded"].is_null());
}

TEST_F(AngleServiceThread, WithoutAModelThatIsSaid) {
  std::filesystem::remove(scratch_ / "subject.osim");
  EXPECT_TRUE(state()["model"].is_null());
  EXPECT_THAT(state()["said"].get<std::string>(), HasSubstr("No body model is known for walk.c3d"));
  const auto refused = begin();
  EXPECT_EQ(refused.status, 422);
  EXPECT_THAT(*refused.body, HasSubstr("--model FILE.osim"));
  put("given.osim", "x");
  put("other.osim", "x");
  start({.model = scratch_ / "given.osim"});
  EXPECT_EQ(solve_with("1")["model"], "given.osim");
}

TEST_F(AngleServiceThread, AnotherRecordingOrModelMakesThemUnknown) {
  (void)solve_with("1");
  put("subject.osim", "another");
  EXPECT_EQ(state()["state"], "none");
  EXPECT_EQ(html(AnglesOf::now), "none");
  (void)solve_with("1");
  EXPECT_EQ(jobs_.size(), 4U) << "as recorded, too, it is solved with the new model";
  put("walk.c3d", "another");
  EXPECT_TRUE(state()["solutions"]["now"].is_null());
}

TEST_F(AngleServiceThread, TheOldestGoesWhereThereIsNoRoom) {
  page_padding_ = std::string(1000, ' ');
  start({.most_bytes = 4500});
  (void)solve_with("1", 1);
  (void)solve_with("1", 2);
  EXPECT_NE(html(AnglesOf::now, 1), "none") << "asked for, it is no longer the oldest";
  (void)solve_with("1", 3);
  EXPECT_NE(html(AnglesOf::now, 1), "none");
  EXPECT_EQ(html(AnglesOf::now, 2), "none");
  EXPECT_EQ(state(2)["state"], "none");
  EXPECT_NE(html(AnglesOf::now, 3), "none");
}

TEST_F(AngleServiceThread, WhatAsksNothingIsRefused) {
  for (const char* body :
       {"", "{", "[]", "{}", R"({"do":"explode"})", R"({"do":1})", R"({"do":"solve","x":1})", "\xff\xfe"})
    EXPECT_EQ(post(body).status, 400) << body;
  EXPECT_EQ(
      service_->answer({.method = "POST", .type = "text/plain", .body = R"({"do":"solve"})"}, trial()).status,
      415);
  EXPECT_EQ(state()["state"], "none");
}

TEST_F(AngleServiceThread, EndsWhileSomethingIsUnderWay) {
  close_gate();
  (void)begin();
  wait_for_jobs(1);
  std::thread opener([this] { open_gate(); });
  service_.reset();
  opener.join();
  EXPECT_EQ(jobs_.size(), 1U);
}

TEST(AngleServiceAlone, WhatCannotBeReadIsTheReadersSentence) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(io::write_text(scratch / "walk.c3d", "no recording", false));
  ASSERT_TRUE(io::write_text(scratch / "walk.osim", "no model", false));
  AngleService service{{}};
  const TrialFile trial{.number = 1, .path = scratch / "walk.c3d"};
  EXPECT_EQ(service.answer({.method = "POST", .type = "application/json", .body = R"({"do":"solve"})"}, trial)
                .status,
            202);
  json now;
  do {
    now = json::parse(*service.answer({.method = "GET"}, trial).body);
  } while (now["state"] != "failed");
  EXPECT_THAT(now["said"].get<std::string>(), HasSubstr("walk.osim"));
}

}  // namespace

}  // namespace kinemark::server
