// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/run/run_job.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "kinemark/core/counted.h"
#include "kinemark/core/nearest_name.h"
#include "kinemark/core/parallel.h"
#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"
#include "kinemark/data/likely_pairs.h"
#include "kinemark/pipeline/files/file_table.h"
#include "kinemark/pipeline/files/output_check.h"
#include "kinemark/pipeline/run/step_record.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

/// The output folder, for this run alone as long as it lives; a run that is killed lets go of it.
class Hold {
 public:
  Hold(const Hold&) = delete;
  Hold& operator=(const Hold&) = delete;
  Hold(Hold&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Hold& operator=(Hold&&) = delete;
  ~Hold() {
    if (fd_ >= 0) ::close(fd_);
  }

  static Result<Hold> take(const fs::path& folder) {
    const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (fd < 0)
      return fail(Code::io, fmt::format("{}: cannot be opened ({})", folder.string(),
                                        std::generic_category().message(errno)));
    Hold hold(fd);
    if (::flock(fd, LOCK_EX | LOCK_NB) != 0)
      return fail(Code::io, fmt::format("{}: another run is at work in it", folder.string()));
    return hold;
  }

 private:
  explicit Hold(int fd) : fd_(fd) {}
  int fd_;
};

/// The sentence of a command that failed or missed a gate, else its first note.
std::string sentence_of(const CommandEnd& end) {
  constexpr std::string_view kFailure = "kinemark: ", kMissed = "attention: ", kNote = "note: ";
  const std::string_view wanted = end.exit_status == 0 ? kNote : end.exit_status == 1 ? kMissed : kFailure;
  for (const auto& line : end.said)
    if (line.starts_with(wanted)) return line.substr(wanted.size());
  return end.exit_status == 0 || end.said.empty() ? "" : end.said.back();
}

/// Runs the steps.
class Runner {
 public:
  /// @param read  files that no command may replace
  Runner(const RunJob& job, fs::path base, std::vector<fs::path> read, std::vector<StepOutcome>& steps)
      : job_(job),
        base_(std::move(base)),
        read_(std::move(read)),
        steps_(steps),
        state_(steps.size(), State::waiting) {}

  void run() {
    std::vector<std::jthread> workers;
    for (int n = 1; n < thread_count(job_.jobs); ++n) workers.emplace_back([this] { work(); });
    work();
  }

 private:
  enum class State : std::uint8_t { waiting, running, done, failed };

  void work() {
    std::unique_lock lock(mutex_);
    while (true) {
      const std::size_t i = next();
      if (i == steps_.size()) return;
      if (i > steps_.size()) {
        changed_.wait(lock);
        continue;
      }
      state_[i] = State::running;
      lock.unlock();
      StepOutcome& step = steps_[i];
      run_step(step);
      lock.lock();
      state_[i] = step.status == TrialStatus::failed ? State::failed : State::done;
      stopped_ = stopped_ || (state_[i] == State::failed && !job_.keep_going);
      ++ended_;
      if (job_.progress && !job_.progress(ended_, std::ssize(steps_))) stopped_ = true;
      changed_.notify_all();
    }
  }

  /// A step that can begin; the number of steps: none ever; more: none yet.
  std::size_t next() const {
    bool may_come = false;
    for (std::size_t i = 0; !stopped_ && i < steps_.size(); ++i) {
      if (state_[i] != State::waiting) continue;
      bool ready = true, lost = false;
      for (const std::size_t before : steps_[i].step.after) {
        ready = ready && state_[before] == State::done;
        lost = lost || state_[before] == State::failed || never_[before];
      }
      if (ready) return i;
      never_[i] = lost;
      may_come = may_come || !lost;
    }
    return may_come ? steps_.size() + 1 : steps_.size();
  }

  void run_step(StepOutcome& out) const {
    const auto begin = std::chrono::steady_clock::now();
    if (const auto s = try_step(out); !s) {
      out.status = TrialStatus::failed;
      out.said = s.error().message;
      out.exit_status = kinemark::exit_status(s.error().code);
    }
    out.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

  Status try_step(StepOutcome& out) const {
    std::error_code error;
    fs::create_directories((base_ / out.step.record).parent_path(), error);
    if (error)
      return fail(Code::io, fmt::format("{}: the folder cannot be made ({})",
                                        out.step.record.parent_path().string(), error.message()));
    auto found = find_state(out.step, base_);
    if (!found) return std::unexpected(found.error());
    if (found->state == StepState::occupied && !job_.force) return fail(Code::io, found->sentence);
    if (found->state == StepState::current && !job_.force) {
      out.exit_status = found->record.exit_status;
      out.status = TrialStatus::there;
      if (out.exit_status != 0)
        out.said = sentence_of({.exit_status = out.exit_status, .said = found->record.said});
      return {};
    }
    auto record = mark_begun(out.step, base_);
    if (!record) return std::unexpected(record.error());
    auto words = out.step.words;
    words.push_back("--force");
    words.push_back(
        fmt::format("--threads={}", std::max(1, thread_count(job_.threads) / thread_count(job_.jobs))));
    for (const auto& path : read_) words.push_back("--reads=" + path.string());
    auto end = job_.start(words, base_);
    if (!end) return std::unexpected(end.error());
    out.said = sentence_of(*end);
    // A value that the command does not take is a fault of the file, not of who typed `run`.
    out.exit_status = end->exit_status == kinemark::exit_status(Code::usage)
                          ? kinemark::exit_status(Code::bad_input)
                          : end->exit_status;
    if (end->exit_status > 1) {
      out.status = TrialStatus::failed;
      return {};
    }
    record->exit_status = end->exit_status;
    record->said = std::move(end->said);
    out.status = end->exit_status == 0 ? TrialStatus::good : TrialStatus::missed_gate;
    return mark_done(out.step, base_, std::move(*record));
  }

  const RunJob& job_;
  fs::path base_;
  std::vector<fs::path> read_;
  std::vector<StepOutcome>& steps_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<State> state_;
  mutable std::vector<char> never_ = std::vector<char>(state_.size(), 0);
  std::int64_t ended_ = 0;
  bool stopped_ = false;
};

Status check_subjects(const RunJob& job, const RunFile& file) {
  std::vector<std::string> known;
  for (const auto& subject : file.subjects) known.push_back(subject.name);
  for (const auto& name : job.only) {
    if (std::ranges::find(known, name) != known.end()) continue;
    const auto near = nearest_names(name, known);
    return fail(Code::usage, fmt::format("{}: no subject '{}'{}", job.file.string(), name,
                                         near.empty() ? "" : fmt::format("; did you mean {}?", join(near))));
  }
  return {};
}

/// "line 7: " of the option that a sentence names, or nothing; the options are the last words.
std::string line_in(const RunStep& step, const std::string& sentence) {
  const std::size_t first = step.words.size() - step.lines.size();
  for (std::size_t i = 0; i < step.lines.size(); ++i) {
    const std::string& word = step.words[first + i];
    if (sentence.find(word.substr(0, word.find('='))) != std::string::npos)
      return fmt::format("line {}: ", step.lines[i]);
  }
  return "";
}

Status check_words(const RunJob& job, const RunStep& step) {
  if (!job.check) return {};
  if (const auto s = job.check(step.words); !s)
    return fail(Code::bad_input,
                fmt::format("{}: {}{} of subject '{}': {}", job.file.string(),
                            line_in(step, s.error().message), step.name, step.subject, s.error().message));
  return {};
}

/// The run file and every file that steps read and none of them makes, wherever the program stands; where one
/// of the files that they write is among them, which.
Result<std::vector<fs::path>> find_inputs(const RunJob& job, const fs::path& base,
                                          const std::vector<RunStep>& steps) {
  std::vector<fs::path> written, read{job.file};
  for (const auto& step : steps) {
    written.push_back((base / step.record).lexically_normal());
    for (const auto& output : step.outputs) written.push_back((base / output).lexically_normal());
  }
  for (const auto& step : steps)
    for (const auto& input : step.inputs)
      if (auto path = (base / input).lexically_normal(); std::ranges::find(written, path) == written.end())
        read.push_back(std::move(path));
  if (auto s = check_apart(job, written, read); !s) return std::unexpected(s.error());
  std::error_code ignored;
  for (auto& path : read) path = fs::absolute(path, ignored);
  return read;
}

std::string command_of(const RunStep& step) {
  std::string out = "kinemark";
  for (const auto& word : step.words) out += " " + data::for_shell(word);
  return out;
}

}  // namespace

int RunOutcome::exit_status() const {
  int worst = 0;
  for (const auto& step : steps) worst = std::max(worst, step.exit_status);
  return worst;
}

Result<RunOutcome> run_study(const RunJob& job) {
  auto file = read_run_file(job.file);
  if (!file) return std::unexpected(file.error());
  if (auto s = check_subjects(job, *file); !s) return std::unexpected(s.error());
  if (!job.only.empty())
    std::erase_if(file->subjects, [&](const RunSubject& subject) {
      return std::ranges::find(job.only, subject.name) == job.only.end();
    });
  auto steps = plan_steps(*file);
  if (!steps) return std::unexpected(steps.error());
  if (job.seed != JobSettings().seed)
    for (auto& step : *steps) step.words.insert(step.words.begin() + 1, fmt::format("--seed={}", job.seed));
  for (const auto& step : *steps)
    if (auto s = check_words(job, step); !s) return std::unexpected(s.error());
  const fs::path base = "." / job.file.parent_path();
  auto read = find_inputs(job, base, *steps);
  if (!read) return std::unexpected(read.error());
  RunOutcome out;
  for (auto& step : *steps) out.steps.push_back({.step = std::move(step)});
  if (job.plan_only) return out;
  const fs::path folder = base / file->output;
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    return fail(Code::io,
                fmt::format("{}: the folder cannot be made ({})", folder.string(), error.message()));
  const auto hold = Hold::take(folder);
  if (!hold) return std::unexpected(hold.error());
  Runner(job, base, std::move(*read), out.steps).run();
  return out;
}

std::string run_table(const RunOutcome& outcome) {
  std::vector<std::vector<std::string>> rows{{"subject", "recording", "step", "status", "s", "findings"}};
  std::map<TrialStatus, std::int64_t> counts;
  for (const auto& each : outcome.steps) {
    rows.push_back({printable(each.step.subject), printable(each.step.trial), each.step.name,
                    std::string(to_string(each.status)),
                    each.seconds > 0.0 ? fmt::format("{:.1f}", each.seconds) : "",
                    printable_sentence(each.said)});
    ++counts[each.status];
  }
  std::vector<std::string> parts;
  for (const auto& [status, n] : counts) parts.push_back(fmt::format("{} {}", n, to_string(status)));
  return aligned(rows) + fmt::format("{}: {}\n", counted(std::ssize(outcome.steps), "step"), join(parts));
}

nlohmann::ordered_json run_json(const RunOutcome& outcome) {
  nlohmann::ordered_json json;
  json["exit_status"] = outcome.exit_status();
  json["steps"] = nlohmann::ordered_json::array();
  for (const auto& each : outcome.steps) {
    nlohmann::ordered_json step;
    step["subject"] = each.step.subject;
    step["trial"] =
        each.step.trial.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(each.step.trial);
    step["step"] = each.step.name;
    step["command"] = command_of(each.step);
    step["outputs"] = nlohmann::ordered_json::array();
    for (const auto& file : each.step.outputs) step["outputs"].push_back(file.string());
    step["status"] = to_string(each.status);
    step["exit_status"] = each.exit_status;
    step["seconds"] = each.seconds;
    step["said"] = each.said;
    json["steps"].push_back(std::move(step));
  }
  return json;
}

std::string commands_text(const RunOutcome& outcome) {
  std::string out;
  for (const auto& each : outcome.steps) out += command_of(each.step) + "\n";
  return out;
}

}  // namespace kinemark::pipeline
