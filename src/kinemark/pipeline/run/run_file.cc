// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/run/run_file.h"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include "kinemark/core/nearest_name.h"
#include "kinemark/core/text.h"
#include "kinemark/io/file.h"
#include "kinemark/io/rig/toml_fields.h"
#include "kinemark/io/rig/toml_text.h"
#include "kinemark/pipeline/files/settings_file.h"

namespace kinemark::pipeline {
namespace {

constexpr std::size_t kLargestRunFile = 16UL << 20;  // bytes

/// An option of the whole run: what a step says is how the run knows what it wrote.
constexpr std::string_view kQuiet = "quiet";

/// Options that the run gives itself, step by step.
constexpr std::array<std::pair<std::string_view, std::string_view>, 14> kOwn = {{{"joints", "output"},
                                                                                 {"scale", "output"},
                                                                                 {"scale", "static"},
                                                                                 {"scale", "markers"},
                                                                                 {"scale", "mass"},
                                                                                 {"reconstruct", "output"},
                                                                                 {"reconstruct", "report"},
                                                                                 {"ik", "output"},
                                                                                 {"ik", "markers"},
                                                                                 {"ik", "report"},
                                                                                 {"track", "output"},
                                                                                 {"track", "markers"},
                                                                                 {"analyze", "output"},
                                                                                 {"report", "output"}}};

std::string line_of(const toml::node& node) { return fmt::format("line {}", node.source().begin.line); }

bool is_folder_name(const std::string& name) {
  return !name.empty() && name.size() <= 100 && name.front() != '.' &&
         name.find_first_of("/\\") == std::string::npos &&
         std::ranges::none_of(name, [](unsigned char c) { return c < 0x20 || c == 0x7F; });
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// Reads one run file; the first failure ends it.
class Reader {
 public:
  explicit Reader(RunFile& out) : out_(out), name_(out.path.string()) {}

  Status read(const toml::table& table) {
    io::TomlFields fields(table, name_);
    fields.text("output", out_.output);
    std::vector<std::string> named;
    fields.texts("steps", named, io::TomlFields::Need::required);
    if (fields.failed()) return fields.finish();
    if (auto s = steps(named); !s) return s;
    const toml::array* subjects = fields.tables("subject");
    if (auto s = options(fields, out_.options); !s) return s;
    if (auto s = fields.finish(); !s) return s;
    if (subjects == nullptr || subjects->empty())
      return fail(Code::bad_input, fmt::format("{}: no [[subject]]; need one with a name and trials", name_));
    for (const auto& node : *subjects)
      if (auto s = subject(*node.as_table()); !s) return s;
    return {};
  }

 private:
  Status steps(const std::vector<std::string>& named) {
    for (const auto& step : named) {
      if (std::ranges::find(kSteps, step) == kSteps.end())
        return fail(Code::bad_input, fmt::format("{}: steps: '{}' is none; need some of {}{}", name_, step,
                                                 fmt::join(kSteps, ", "), meant(step)));
      if (!out_.does(step)) out_.steps.push_back(step);
    }
    std::ranges::sort(out_.steps, {}, [](const std::string& s) { return std::ranges::find(kSteps, s); });
    if (out_.steps.empty())
      return fail(Code::bad_input,
                  fmt::format("{}: steps is empty; need some of {}", name_, fmt::join(kSteps, ", ")));
    return {};
  }

  static std::string meant(const std::string& step) {
    const std::vector<std::string> known(kSteps.begin(), kSteps.end());
    const auto near = nearest_names(step, known);
    return near.empty() ? "" : fmt::format("; did you mean {}?", join(near));
  }

  /// The tables of steps within a table.
  Status options(io::TomlFields& fields, std::vector<StepOptions>& into) {
    for (const auto step : kSteps) {
      const toml::table* table = fields.table(step);
      if (table == nullptr) continue;
      if (!out_.does(step))
        return fail(Code::bad_input, fmt::format("{}: {}: options of '{}', which is not among the steps",
                                                 name_, line_of(*table), step));
      auto settings = settings_of(*table, name_);
      if (!settings) return std::unexpected(settings.error());
      for (const auto& setting : settings->list) {
        if (setting.name == kQuiet)
          return fail(Code::bad_input, fmt::format("{}: line {}: '{}' is an option of the run, not of a step",
                                                   name_, setting.line, setting.name));
        if (std::ranges::find(kOwn, std::pair<std::string_view, std::string_view>(step, setting.name)) !=
            kOwn.end())
          return fail(Code::bad_input, fmt::format("{}: line {}: '{}' of {} is given by the run itself",
                                                   name_, setting.line, setting.name, step));
      }
      into.push_back({.step = std::string(step), .list = std::move(settings->list)});
    }
    return {};
  }

  Status subject(const toml::table& table) {
    RunSubject s{.name = "", .line = static_cast<int>(table.source().begin.line)};
    io::TomlFields fields(table, fmt::format("{}: {}: subject", name_, line_of(table)));
    fields.text("name", s.name, io::TomlFields::Need::required)
        .text("static", s.static_trial)
        .text("functional", s.functional)
        .text("session", s.session)
        .number("mass", s.mass_kg);
    if (fields.failed()) return fields.finish();
    if (!is_folder_name(s.name) || !names_.insert(lower(s.name)).second) {
      fields.refuse("name", "a name that can be a folder's and that no other subject has");
      return fields.finish();
    }
    if (table.contains("mass") && !(s.mass_kg > 0.0)) fields.refuse("mass", "kilograms, more than 0");
    std::vector<std::string> files;
    fields.texts("trials", files);
    for (auto& file : files) s.trials.push_back({.file = std::move(file), .options = {}, .line = s.line});
    if (const toml::array* more = fields.tables("trial"))
      for (const auto& node : *more)
        if (auto done = trial(*node.as_table(), s); !done) return done;
    if (auto done = options(fields, s.options); !done) return done;
    if (auto done = fields.finish(); !done) return done;
    if (auto done = check(s); !done) return done;
    out_.subjects.push_back(std::move(s));
    return {};
  }

  Status trial(const toml::table& table, RunSubject& s) {
    RunTrial t{.file = "", .options = {}, .line = static_cast<int>(table.source().begin.line)};
    io::TomlFields fields(table, fmt::format("{}: {}: trial", name_, line_of(table)));
    fields.text("file", t.file, io::TomlFields::Need::required);
    if (auto done = options(fields, t.options); !done) return done;
    if (auto done = fields.finish(); !done) return done;
    s.trials.push_back(std::move(t));
    return {};
  }

  /// Whether the steps have what they need.
  Status check(const RunSubject& s) const {
    const auto needs = [&](const std::string& what) {
      return fail(Code::bad_input, fmt::format("{}: line {}: subject '{}' {}", name_, s.line, s.name, what));
    };
    const bool works_on_trials =
        out_.does("reconstruct") || out_.does("clean") || out_.does("ik") || out_.does("track");
    if (works_on_trials && s.trials.empty() && s.session.empty())
      return needs("has no trials; need trials = [\"walk*.c3d\"], or session = \"FOLDER\"");
    if (out_.does("joints") && s.functional.empty())
      return needs("has no functional motion for 'joints'; need functional = \"FILE\"");
    if (out_.does("scale") && s.static_trial.empty() && s.functional.empty())
      return needs("has nothing to scale by; need static = \"FILE\", functional = \"FILE\", or both");
    if (out_.does("analyze") && !out_.does("ik") && !out_.does("track"))
      return needs("has no 'ik' and no 'track' whose motion 'analyze' could take");
    if (out_.does("report") && !out_.does("ik")) return needs("has no 'ik' that 'report' could show");
    return {};
  }

  RunFile& out_;
  std::string name_;
  std::set<std::string> names_;
};

}  // namespace

bool RunFile::does(std::string_view step) const { return std::ranges::find(steps, step) != steps.end(); }

Result<RunFile> parse_run_file(std::string_view text, const std::filesystem::path& path) {
  const auto table = io::parse_toml(text, path.string());
  if (!table) return std::unexpected(table.error());
  RunFile out{.path = path};
  if (auto s = Reader(out).read(*table); !s) return std::unexpected(s.error());
  return out;
}

Result<RunFile> read_run_file(const std::filesystem::path& path) {
  const auto text = io::read_text(path, kLargestRunFile);
  if (!text) return std::unexpected(text.error());
  return parse_run_file(*text, path);
}

}  // namespace kinemark::pipeline
