// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
//
// Joint angles of recordings as they are edited: solved when a page asks for it, and kept in memory.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "kinemark/core/result.h"
#include "kinemark/pipeline/motion/ik_job.h"
#include "server/message.h"
#include "server/trial_files.h"
#include "server/trial_page.h"
#include "server/worker.h"

namespace kinemark::server {

//
// Which body model a recording is solved with.

/// The model that was given; else the .osim of the recording's own name beside it, else the only .osim there.
/// None, or several: Code::not_supported, one sentence with the way out. O(files of the folder).
/// @param given  empty: none was
[[nodiscard]] Result<std::filesystem::path> find_model(const std::filesystem::path& recording,
                                                       const std::filesystem::path& given);

/// How recordings are solved, and what that may take.
struct AngleServiceOptions {
  std::filesystem::path model;  ///< of all recordings; empty: find_model() finds one beside each
  pipeline::IkJob asked;        ///< what all solutions have alike: tasks, weights, folders of meshes
  int threads = 0;              ///< 0: all cores. Any number gives the same bits.
  std::uint64_t seed = 1;       ///< as `kinemark ik --seed`
  std::int64_t most_samples = 4'000'000;  ///< frames times markers of a recording that is solved here
  std::size_t most_waiting = 8;           ///< recordings that wait for the one that is being solved
  std::size_t most_bytes = 256UL << 20;   ///< of all pages that are kept, but for those solved last
  /// Solves one job; pipeline::ik_page() unless a test has another.
  std::function<Result<pipeline::IkPage>(const pipeline::IkJob&)> solve;
};

/// Which solution of a recording.
enum class AnglesOf : std::uint8_t {
  now,       ///< with the edits of when it was solved last
  before,    ///< with the edits of when it was solved last but one
  recorded,  ///< without edits
};

/// Solves one recording after the other on a thread of its own, as `kinemark ik --edits beside` does, and
/// without its edits where there are any, once. Nothing is written. A solution is kept until the recording's
/// or the model's file changes, and until others need the room. Threads may ask at once.
class AngleService {
 public:
  explicit AngleService(AngleServiceOptions options);
  AngleService(const AngleService&) = delete;
  AngleService& operator=(const AngleService&) = delete;
  /// Stops what is being solved.
  ~AngleService();

  /// Answer /api/trial/N/angles of somebody who was let in: GET tells the state, POST {"do": "solve"} or
  /// {"do": "stop"} changes it. 202 with the state when it is under way; 409 when it is already; 422 with the
  /// reason where it cannot be; 503 where too many wait; 400 and 415 for what asks nothing.
  [[nodiscard]] Response answer(const Request& request, const TrialFile& trial);
  /// A report page; nothing where there is none now.
  [[nodiscard]] std::optional<Page> page(const TrialFile& trial, AnglesOf which);

 private:
  static constexpr std::size_t kKinds = 3;
  struct Solution {
    Page page;
    std::string digest, set, verdict;
    std::size_t edits = 0, attentions = 0;
    double rms_m = 0.0;
  };
  enum class State : std::uint8_t { none, waiting, solving, solved, failed, stopped };
  struct OfTrial {
    std::filesystem::path model;
    std::array<std::optional<Stamp>, 2> stamps;  ///< of recording and model
    std::array<std::shared_ptr<const Solution>, kKinds> solutions;
    State state = State::none;
    std::string said;        ///< why it failed, or what went less than well; one sentence
    std::uint64_t used = 0;  ///< the larger, the later
    std::atomic<bool> stops = false;
    std::atomic<std::int64_t> done = 0, of = 0;  ///< frames
  };
  using OfTrialIs = std::shared_ptr<OfTrial>;

  [[nodiscard]] OfTrialIs refreshed(const TrialFile& trial, const Result<std::filesystem::path>& model);
  [[nodiscard]] Response begin(const TrialFile& trial, const Result<std::filesystem::path>& model);
  [[nodiscard]] Response state_response(int status, const OfTrial& of,
                                        const Result<std::filesystem::path>& model) const;
  void solve(const std::filesystem::path& recording, const OfTrialIs& of);
  [[nodiscard]] Result<std::shared_ptr<const Solution>> solve_one(const std::filesystem::path& recording,
                                                                  bool with_edits, const OfTrialIs& of) const;
  void make_room(const OfTrial& kept);

  AngleServiceOptions options_;
  mutable std::mutex mutex_;  ///< of what follows, but for atomics
  std::map<std::uint32_t, OfTrialIs> trials_;
  std::uint64_t uses_ = 0;
  Worker worker_;  ///< ends first
};

}  // namespace kinemark::server
