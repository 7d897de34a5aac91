// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "server/angle_service.h"

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "kinemark/core/utf8.h"
#include "kinemark/io/input/journal_input.h"
#include "kinemark/pipeline/files/job_settings.h"
#include "server/entrance.h"
#include "server/json_answer.h"
#include "server/trial_files.h"
#include "server/trial_page.h"

namespace kinemark::server {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> models_in(const fs::path& folder) {
  std::vector<fs::path> models;
  std::error_code error;
  for (fs::directory_iterator at(folder.empty() ? "." : folder, error), end; !error && at != end;
       at.increment(error))
    if (pipeline::ending_of(at->path()) == ".osim" && at->is_regular_file(error) &&
        !leads_out(folder.empty() ? "." : folder, at->path()))
      models.push_back(folder / at->path().filename());
  std::ranges::sort(models);
  return models;
}

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 3> kNames = {"now", "before", "recorded"};
constexpr std::array<const char*, 6> kStates = {"none", "waiting", "solving", "solved", "failed", "stopped"};

std::size_t index(AnglesOf which) { return static_cast<std::size_t>(which); }

/// "solve" or "stop"; empty: neither.
std::string asked_of(std::string_view body) {
  const auto json = nlohmann::json::parse(body, nullptr, false);
  if (!json.is_object() || json.size() != 1 || !json.contains("do") || !json["do"].is_string()) return {};
  auto what = json["do"].get<std::string>();
  return what == "solve" || what == "stop" ? what : "";
}

}  // namespace

Result<fs::path> find_model(const fs::path& recording, const fs::path& given) {
  if (!given.empty()) return given;
  const auto models = models_in(recording.parent_path());
  const auto own = std::ranges::find(models, recording.stem(), [](const auto& m) { return m.stem(); });
  if (own != models.end()) return *own;
  if (models.size() == 1) return models.front();
  const auto name = printable(recording.filename().string(), 200);
  if (models.empty())
    return fail(
        Code::not_supported,
        fmt::format("No body model is known for {}: start 'kinemark serve' with --model FILE.osim, or "
                    "put an .osim beside the recording",
                    name));
  return fail(Code::not_supported,
              fmt::format("{} body models lie beside {} and none has its name: start 'kinemark serve' with "
                          "--model FILE.osim, or call one {}.osim",
                          models.size(), name, printable(recording.stem().string(), 200)));
}

AngleService::AngleService(AngleServiceOptions options)
    : options_(std::move(options)), worker_(options_.most_waiting) {
  if (!options_.solve)
    options_.solve = [most = options_.most_samples](const pipeline::IkJob& job) {
      return pipeline::ik_page(job, most);
    };
}

AngleService::~AngleService() {
  const std::scoped_lock lock(mutex_);
  for (auto& [number, of] : trials_) of->stops = true;
}

AngleService::OfTrialIs AngleService::refreshed(const TrialFile& trial, const Result<fs::path>& model) {
  auto& of = trials_[trial.number];
  if (!of) of = std::make_shared<OfTrial>();
  if (of->state == State::waiting || of->state == State::solving) return of;
  const std::array<std::optional<Stamp>, 2> stamps = {
      stamps_of(trial.path).front(), model ? stamps_of(*model).front() : std::optional<Stamp>()};
  if (of->state != State::none && (of->stamps != stamps || (model && of->model != *model)))
    of = std::make_shared<OfTrial>();  // what it was solved from is no longer there
  of->stamps = stamps;
  if (model) of->model = *model;
  return of;
}

Response AngleService::state_response(int status, const OfTrial& of, const Result<fs::path>& model) const {
  Json solutions = Json::object();
  for (std::size_t i = 0; i < kKinds; ++i) {
    const auto& solution = of.solutions[i];
    solutions[kNames[i]] = !solution ? Json() : Json{{"digest", solution->digest},
                                                     {"edits", solution->edits},
                                                     {"set", solution->set},
                                                     {"verdict", solution->verdict},
                                                     {"attentions", solution->attentions},
                                                     {"rms_mm", 1e3 * solution->rms_m}};
  }
  const auto& said = model ? of.said : model.error().message;
  return json_response(status, {{"model", model ? Json(printable(model->filename().string(), 200)) : Json()},
                                {"state", kStates[static_cast<std::size_t>(of.state)]},
                                {"said", said.empty() ? Json() : Json(printable_sentence(said))},
                                {"done", of.done.load()},
                                {"of", of.of.load()},
                                {"solutions", std::move(solutions)}});
}

Response AngleService::begin(const TrialFile& trial, const Result<fs::path>& model) {
  if (!model) return refusal(422, model.error().message);
  const auto of = refreshed(trial, model);
  if (of->state == State::waiting || of->state == State::solving)
    return refusal(409, "This recording is being solved already; stop that first.");
  const auto was = std::exchange(of->state, State::waiting);
  of->stops = false;
  of->done = of->of = 0;
  if (!worker_.post([this, path = trial.path, of] { solve(path, of); })) {
    of->state = was;
    return refusal(503, "Too many recordings wait to be solved; try again in a moment.");
  }
  of->said.clear();
  of->used = ++uses_;
  return state_response(202, *of, model);
}

Response AngleService::answer(const Request& request, const TrialFile& trial) {
  const bool posts = request.method == "POST";
  if (posts && !is_json(request.type)) return refusal(415, "What is asked is sent as application/json.");
  const auto what = posts ? asked_of(request.body) : "";
  if (posts && what.empty()) return refusal(400, R"(need {"do": "solve"} or {"do": "stop"} as JSON)");
  const auto model = find_model(trial.path, options_.model);
  const std::scoped_lock lock(mutex_);
  if (what == "solve") return begin(trial, model);
  const auto of = refreshed(trial, model);
  if (what == "stop") of->stops = true;
  return state_response(posts ? 202 : 200, *of, model);
}

std::optional<Page> AngleService::page(const TrialFile& trial, AnglesOf which) {
  const auto model = find_model(trial.path, options_.model);
  const std::scoped_lock lock(mutex_);
  const auto of = refreshed(trial, model);
  const auto& solution = of->solutions[index(which)];
  if (!solution) return std::nullopt;
  of->used = ++uses_;
  return solution->page;
}

Result<std::shared_ptr<const AngleService::Solution>> AngleService::solve_one(const fs::path& recording,
                                                                              bool with_edits,
                                                                              const OfTrialIs& of) const {
  pipeline::IkJob job = options_.asked;
  job.model = of->model;
  job.markers = recording;
  job.edits = with_edits ? io::kEditsBeside : io::kEditsNone;
  job.threads = options_.threads;
  job.seed = options_.seed;
  job.progress = [of](std::int64_t done, std::int64_t total) {
    of->done = done;
    of->of = total;
    return !of->stops;
  };
  const auto name = printable(recording.filename().string(), 200);
  try {
    auto solved = options_.solve(job);
    if (!solved) return std::unexpected(solved.error());
    const auto nonce = new_secret();
    if (!nonce) return std::unexpected(nonce.error());
    const auto& summary = solved->summary;
    return std::make_shared<const Solution>(
        Solution{.page = shielded(std::move(solved->html), *nonce),
                 .digest = solved->digest,
                 .set = solved->set,
                 .verdict = summary.verdict == report::Verdict::good ? "good" : "attention",
                 .edits = solved->edits,
                 .attentions = static_cast<std::size_t>(
                     std::ranges::count(summary.notices, report::Verdict::attention, &report::Notice::level)),
                 .rms_m = summary.rms_error_m});
  } catch (const std::bad_alloc&) {
    return fail(Code::io, fmt::format("{}: does not fit into memory", name));
  } catch (const std::exception& error) {
    return fail(Code::bad_input, fmt::format("{}: {}", name, error.what()));
  }
}

void AngleService::solve(const fs::path& recording, const OfTrialIs& of) {
  {
    const std::scoped_lock lock(mutex_);
    of->state = State::solving;
  }
  const auto finish = [&](const Error& error, std::string_view before) {
    const std::scoped_lock lock(mutex_);
    const bool stopped = error.code == Code::cancelled && of->stops;
    of->state = stopped ? State::stopped : State::failed;
    of->said = stopped ? "" : fmt::format("{}{}", before, error.message);
  };
  auto now = of->stops ? fail(Code::cancelled, "stopped") : solve_one(recording, true, of);
  if (!now) return finish(now.error(), "");
  std::shared_ptr<const Solution> recorded;
  {
    const std::scoped_lock lock(mutex_);
    auto& [newest, before, plain] = of->solutions;
    if (newest && newest->digest != (*now)->digest) before = newest;
    newest = *now;
    if ((*now)->edits == 0) plain = newest;
    recorded = plain;
  }
  if (!recorded) {
    auto solved = solve_one(recording, false, of);
    if (!solved) return finish(solved.error(), "As recorded it cannot be solved: ");
    recorded = std::move(*solved);
  }
  const std::scoped_lock lock(mutex_);
  of->solutions[index(AnglesOf::recorded)] = std::move(recorded);
  of->state = State::solved;
  make_room(*of);
}

void AngleService::make_room(const OfTrial& kept) {
  const auto bytes_of = [](const OfTrial& of) {
    std::size_t bytes = 0;
    for (const auto& solution : of.solutions)
      if (solution) bytes += solution->page.html->size();
    return bytes;
  };
  while (true) {
    std::size_t bytes = 0;
    OfTrial* oldest = nullptr;
    for (auto& [number, of] : trials_) {
      bytes += bytes_of(*of);
      if (of.get() != &kept && bytes_of(*of) > 0 && (oldest == nullptr || of->used < oldest->used))
        oldest = of.get();
    }
    if (bytes <= options_.most_bytes || oldest == nullptr) return;
    oldest->solutions = {};
    if (oldest->state == State::solved) oldest->state = State::none;
  }
}

}  // namespace kinemark::server
