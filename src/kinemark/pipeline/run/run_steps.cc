// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/run/run_steps.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <initializer_list>
#include <map>
#include <set>
#include <system_error>
#include <utility>

#include "kinemark/core/name_pattern.h"
#include "kinemark/core/number.h"
#include "kinemark/io/input/journal_input.h"
#include "kinemark/io/keypoints/keypoints_file.h"
#include "kinemark/pipeline/session/session.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

using Lists = std::initializer_list<const std::vector<StepOptions>*>;

/// The options of a step, those of the later lists in the place of those of the earlier ones.
std::vector<Setting> options_of(const std::string& step, Lists lists) {
  std::vector<Setting> out;
  for (const auto* list : lists)
    for (const auto& options : *list) {
      if (options.step != step) continue;
      for (const auto& setting : options.list) {
        std::erase_if(out, [&](const Setting& before) { return before.name == setting.name; });
        out.push_back(setting);
      }
    }
  return out;
}

std::string replaced(std::string text, std::string_view what, const std::string& by) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

/// A file as a word of a command, which is no option even where its name begins like one.
std::string word_of(const fs::path& file) {
  const std::string name = file.string();
  return name.starts_with('-') ? "./" + name : name;
}

/// A recording and the name of its folder.
struct Found {
  fs::path file;
  std::string name;
  std::vector<StepOptions> options;  ///< for it alone
  fs::path rig;                      ///< of its session; empty: none
};

/// Plans one subject after the other.
class Planner {
 public:
  explicit Planner(const RunFile& file)
      : file_(file), base_("." / file.path.parent_path()), name_(file.path.string()) {}

  Result<std::vector<RunStep>> plan() {
    for (const auto& subject : file_.subjects)
      if (auto s = plan_subject(subject); !s) return std::unexpected(s.error());
    return std::move(steps_);
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  Status plan_subject(const RunSubject& subject) {
    const fs::path folder = fs::path(file_.output) / subject.name;
    const Lists lists = {&file_.options, &subject.options};
    std::size_t functional = kNone;
    if (file_.does("joints")) {
      RunStep step = begin(subject, "", "joints", folder);
      const fs::path out = folder / "joints";
      step.words.push_back(word_of(subject.functional));
      step.words.push_back("--output=" + out.string());
      step.inputs.emplace_back(subject.functional);
      for (const char* made : {"centres.csv", "centres.c3d", "skeleton.json", "segments.toml"})
        step.outputs.push_back(out / made);
      functional = add(std::move(step), options_of("joints", lists), subject.name, subject.functional);
    }
    std::size_t scaled = kNone;
    if (file_.does("scale")) scaled = plan_scale(subject, folder, functional, options_of("scale", lists));
    auto found = find_trials(subject);
    if (!found) return std::unexpected(found.error());
    for (const auto& each : *found)
      if (auto s = plan_trial(subject, each, folder / each.name, scaled); !s) return s;
    return {};
  }

  /// @param functional  step that finds the subject's joints; kNone: none
  std::size_t plan_scale(const RunSubject& subject, const fs::path& folder, std::size_t functional,
                         const std::vector<Setting>& options) {
    RunStep step = begin(subject, "", "scale", folder);
    if (!subject.static_trial.empty()) {
      step.words.push_back("--static=" + subject.static_trial);
      step.inputs.emplace_back(subject.static_trial);
    }
    if (!subject.functional.empty()) {
      step.words.push_back("--markers=" + subject.functional);
      step.inputs.emplace_back(subject.functional);
    }
    if (functional != kNone) {
      step.words.push_back("--joints=" + (folder / "joints").string());
      step.inputs.push_back(folder / "joints" / "skeleton.json");
      step.after.push_back(functional);
    }
    if (subject.mass_kg > 0.0) step.words.push_back("--mass=" + format_number(subject.mass_kg));
    const fs::path out = folder / "model.osim";
    step.words.push_back("--output=" + out.string());
    step.outputs = {out, folder / "model_report.json"};
    return add(std::move(step), options, subject.name, subject.static_trial);
  }

  Status plan_trial(const RunSubject& subject, const Found& found, const fs::path& folder,
                    std::size_t scaled) {
    const Lists lists = {&file_.options, &subject.options, &found.options};
    const auto options = [&](const std::string& step) { return options_of(step, lists); };
    fs::path markers = found.file;
    std::size_t before = kNone;  // the step that makes the markers
    if (file_.does("reconstruct")) {
      auto reconstructed = plan_reconstruct(subject, found, folder, options("reconstruct"));
      if (!reconstructed) return std::unexpected(reconstructed.error());
      before = *reconstructed;
      markers = steps_[before].outputs.front();
    }
    if (file_.does("clean")) {
      RunStep step = begin(subject, found.name, "clean", folder);
      const fs::path cleaned = folder / "clean.c3d";
      step.words.insert(step.words.end(), {word_of(markers), word_of(cleaned)});
      step.inputs.push_back(markers);
      step.outputs = {cleaned};
      if (before != kNone) step.after.push_back(before);
      before = add(std::move(step), options("clean"), subject.name, found.file.string());
      markers = cleaned;
    }
    for (const std::string solver : {"ik", "track"}) {
      if (!file_.does(solver)) continue;
      RunStep step = begin(subject, found.name, solver, folder);
      auto settings = options(solver);
      if (scaled != kNone) {
        std::erase_if(settings, [](const Setting& s) { return s.name == "model"; });
        step.words.push_back("--model=" + steps_[scaled].outputs.front().string());
        step.inputs.push_back(steps_[scaled].outputs.front());
        step.after.push_back(scaled);
      } else if (std::ranges::none_of(
                     settings, [](const Setting& s) { return s.name == "model" || s.name == "setup"; })) {
        return fail(Code::bad_input,
                    fmt::format("{}: no model for {} of subject '{}'; need the step 'scale', or model = "
                                "\"FILE.osim\" under [{}]",
                                name_, solver, subject.name, solver));
      }
      const fs::path out = folder / (solver + ".mot");
      step.words.push_back("--markers=" + markers.string());
      step.words.push_back("--output=" + out.string());
      step.inputs.push_back(markers);
      if (before != kNone) step.after.push_back(before);
      step.outputs = {out, folder / (solver + "_report.json")};
      const std::size_t solved = add(std::move(step), settings, subject.name, found.file.string());
      if (file_.does("analyze") && (solver == "ik" || !file_.does("ik")))
        if (auto s = plan_analyze(subject, found, folder, solved, options("analyze")); !s) return s;
      if (solver == "ik" && file_.does("report"))
        plan_report(subject, found, folder, solved, options("report"));
    }
    return {};
  }

  /// Markers of a recording of counts, by the rig that the options name, or else that of the session.
  Result<std::size_t> plan_reconstruct(const RunSubject& subject, const Found& found, const fs::path& folder,
                                       const std::vector<Setting>& options) {
    RunStep step = begin(subject, found.name, "reconstruct", folder);
    step.words.push_back(word_of(found.file));
    step.inputs.push_back(found.file);
    if (std::ranges::find(options, "rig", &Setting::name) == options.end()) {
      if (found.rig.empty())
        return fail(Code::bad_input, fmt::format("{}: no rig for reconstruct of subject '{}'; need rig = "
                                                 "\"rig.toml\" under [reconstruct]",
                                                 name_, subject.name));
      step.words.push_back("--rig=" + found.rig.string());
      step.inputs.push_back(found.rig);
    }
    step.outputs = {folder / "markers.c3d"};
    step.words.push_back("--output=" + step.outputs.front().string());
    return add(std::move(step), options, subject.name, found.file.string());
  }

  /// What follows from the motion of `solved`, with its model unless the options name one.
  Status plan_analyze(const RunSubject& subject, const Found& found, const fs::path& folder,
                      std::size_t solved, const std::vector<Setting>& options) {
    RunStep step = begin(subject, found.name, "analyze", folder);
    const RunStep& solver = steps_[solved];
    const fs::path motion = solver.outputs.front(), out = folder / "analysis";
    step.words.push_back(word_of(motion));
    const auto has = [&](std::string_view name) {
      return std::ranges::find(options, name, &Setting::name) != options.end();
    };
    if (!has("model")) {
      const auto model =
          std::ranges::find_if(solver.words, [](const auto& w) { return w.starts_with("--model="); });
      if (model == solver.words.end())
        return fail(Code::bad_input, fmt::format("{}: no model for analyze of subject '{}'; need model = "
                                                 "\"FILE.osim\" under [analyze]",
                                                 name_, subject.name));
      step.words.push_back(*model);
      step.inputs.emplace_back(model->substr(model->find('=') + 1));
    }
    step.words.push_back("--output=" + out.string());
    step.inputs.insert(step.inputs.end(), solver.outputs.begin(), solver.outputs.end());
    // A setup gives its files a name of its own.
    if (!has("setup")) step.outputs = {out / (motion.stem().string() + "_analysis.json")};
    step.after = {solved};
    (void)add(std::move(step), options, subject.name, found.file.string());
    return {};
  }

  void plan_report(const RunSubject& subject, const Found& found, const fs::path& folder, std::size_t solved,
                   const std::vector<Setting>& options) {
    RunStep step = begin(subject, found.name, "report", folder);
    step.inputs = steps_[solved].outputs;
    step.outputs = {folder / "ik.html"};
    step.words.push_back(word_of(step.inputs.front()));
    step.words.push_back("--output=" + step.outputs.front().string());
    step.after = {solved};
    (void)add(std::move(step), options, subject.name, found.file.string());
  }

  static RunStep begin(const RunSubject& subject, const std::string& trial, const std::string& name,
                       const fs::path& folder) {
    return {.subject = subject.name,
            .trial = trial,
            .name = name,
            .words = {name},
            .record = folder / (name + ".step.json")};
  }

  /// The frames of OpenPose that a folder of them, or one of them, stands for. What cannot be read is left to
  /// the step.
  void add_frames(const fs::path& points, std::vector<fs::path>& inputs) const {
    const auto frames = io::keypoints_files(base_ / points);
    if (!frames) return;
    std::error_code absent;
    const auto folder = fs::is_directory(base_ / points, absent) ? points : points.parent_path();
    std::set<fs::path> known(inputs.begin(), inputs.end());
    for (const auto& frame : *frames)
      if (known.insert(folder / frame.filename()).second) inputs.push_back(folder / frame.filename());
  }

  /// Journals beside what a step reads, if there are any: a step is due again when one comes or goes.
  void add_edits(std::vector<fs::path>& inputs) const {
    const auto read = inputs;
    for (const auto& input : read) {
      std::error_code absent;
      const auto journal = io::edits_of(input);
      if (fs::is_regular_file(base_ / journal, absent)) inputs.push_back(journal);
    }
  }

  /// With its options behind its own words; every value that names a file is an input.
  std::size_t add(RunStep step, const std::vector<Setting>& options, const std::string& subject,
                  const std::string& trial) {
    std::string edits = io::kEditsBeside;  // as the commands take them by themselves
    for (const auto& setting : options) {
      if (setting.is_switch) {
        if (setting.on) step.words.push_back("--" + setting.name), step.lines.push_back(setting.line);
        continue;
      }
      for (const auto& given : setting.values) {
        const std::string value = replaced(replaced(given, "{trial}", trial), "{subject}", subject);
        step.words.push_back(fmt::format("--{}={}", setting.name, value));
        step.lines.push_back(setting.line);
        const auto behind = value.find('=');  // --images CAMERA=FILE
        for (const auto& file : {value, behind == std::string::npos ? value : value.substr(behind + 1)}) {
          std::error_code absent;
          if (fs::is_regular_file(base_ / file, absent) &&
              std::ranges::find(step.inputs, fs::path(file)) == step.inputs.end())
            step.inputs.emplace_back(file);
        }
        if (setting.name == "edits") edits = value;
        if (setting.name == "images" && behind != std::string::npos)
          add_frames(value.substr(behind + 1), step.inputs);
      }
    }
    if (edits == io::kEditsBeside) add_edits(step.inputs);
    steps_.push_back(std::move(step));
    return steps_.size() - 1;
  }

  /// The recordings of a subject; one that is named stands for itself, also where a pattern fits it.
  Result<std::vector<Found>> find_trials(const RunSubject& subject) const {
    std::vector<Found> out;
    std::set<fs::path> named;
    for (const auto& trial : subject.trials)
      if (!is_name_pattern(trial.file)) named.insert(fs::path(trial.file).lexically_normal());
    std::map<std::string, fs::path> taken;
    for (const auto& trial : subject.trials) {
      auto files = files_of(trial);
      if (!files) return std::unexpected(files.error());
      for (auto& file : *files) {
        if (is_name_pattern(trial.file) && named.contains(file)) continue;
        const std::string name = file.stem().string();
        const auto [other, is_new] = taken.emplace(name, file);
        if (!is_new && other->second == file) continue;
        if (!is_new)
          return fail(
              Code::bad_input,
              fmt::format("{}: line {}: {} and {} of subject '{}' would both be called '{}'; need "
                          "recordings of different names",
                          name_, trial.line, other->second.string(), file.string(), subject.name, name));
        out.push_back({.file = std::move(file), .name = name, .options = trial.options, .rig = {}});
      }
    }
    if (auto s = add_session(subject, named, taken, out); !s) return std::unexpected(s.error());
    return out;
  }

  /// The trials of its session that are not named by themselves, once all are as they were recorded.
  Status add_session(const RunSubject& subject, const std::set<fs::path>& named,
                     const std::map<std::string, fs::path>& taken, std::vector<Found>& out) const {
    if (subject.session.empty()) return {};
    const fs::path folder = fs::path(subject.session).lexically_normal();
    const auto session = Session::read(base_ / folder);
    if (!session) return std::unexpected(session.error());
    if (auto s = session->check(); !s) return s;
    const fs::path rig = session->rig().empty() ? fs::path() : folder / session->rig().filename();
    for (auto& each : out)
      if (each.file.lexically_normal().parent_path() == folder / "raw") each.rig = rig;
    for (const auto& trial : session->trials()) {
      const fs::path file = folder / trial.file;
      if (named.contains(file)) continue;
      if (taken.contains(file.stem().string()))
        return fail(Code::bad_input,
                    fmt::format("{}: line {}: {} and {} of subject '{}' would both be called '{}'; need "
                                "recordings of different names",
                                name_, subject.line, taken.at(file.stem().string()).string(), file.string(),
                                subject.name, file.stem().string()));
      out.push_back({.file = file, .name = file.stem().string(), .options = {}, .rig = rig});
    }
    return {};
  }

  /// The files that a name or a pattern stands for, in order.
  Result<std::vector<fs::path>> files_of(const RunTrial& trial) const {
    const fs::path given = fs::path(trial.file).lexically_normal();
    if (!is_name_pattern(trial.file)) return std::vector<fs::path>{given};
    if (is_name_pattern(given.parent_path().string()))
      return fail(Code::bad_input,
                  fmt::format("{}: line {}: '{}': * and ? are for the name of a file, not of "
                              "its folder",
                              name_, trial.line, trial.file));
    std::vector<fs::path> out;
    std::error_code error;
    for (fs::directory_iterator entry(base_ / given.parent_path(), error);
         !error && entry != fs::directory_iterator(); entry.increment(error)) {
      std::error_code ignored;
      const std::string name = entry->path().filename().string();
      if (!name.starts_with('.') && entry->is_regular_file(ignored) &&
          matches_name_pattern(given.filename().string(), name))
        out.push_back(given.parent_path() / name);
    }
    if (error)
      return fail(Code::io, fmt::format("{}: line {}: '{}': the folder cannot be read ({})", name_,
                                        trial.line, trial.file, error.message()));
    if (out.empty())
      return fail(Code::bad_input,
                  fmt::format("{}: line {}: no file fits '{}'", name_, trial.line, trial.file));
    std::ranges::sort(out);
    return out;
  }

  const RunFile& file_;
  fs::path base_;
  std::string name_;
  std::vector<RunStep> steps_;
};

}  // namespace

Result<std::vector<RunStep>> plan_steps(const RunFile& file) { return Planner(file).plan(); }

}  // namespace kinemark::pipeline
