// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/bids/motion_name.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <system_error>
#include <vector>

#include "kinemark/core/utf8.h"

namespace kinemark::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kEnding = "_motion.tsv";
constexpr std::string_view kPattern =
    "sub-LABEL[/ses-LABEL]/motion/"
    "sub-LABEL[_ses-LABEL]_task-LABEL_tracksys-LABEL[_acq-LABEL][_run-INDEX]_motion.tsv";
constexpr int kMostFolders = 8;           // above a recording
constexpr int kMostFilesLooked = 10'000;  // of a folder

bool is_label(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  });
}

std::vector<std::string> split(std::string_view text) {
  std::vector<std::string> out;
  for (;;) {
    const auto at = text.find('_');
    out.emplace_back(text.substr(0, at));
    if (at == std::string_view::npos) return out;
    text.remove_prefix(at + 1);
  }
}

/// Labels of a name by their keys, which come in one order.
struct Entities {
  std::string sub, ses, task, tracksys, acq, run;
};

std::optional<Entities> parse_entities(std::string_view stem) {
  Entities out;
  const struct {
    std::string_view key;
    std::string* label;
    bool needed;
  } known[] = {{"sub-", &out.sub, true},           {"ses-", &out.ses, false}, {"task-", &out.task, true},
               {"tracksys-", &out.tracksys, true}, {"acq-", &out.acq, false}, {"run-", &out.run, false}};
  const auto parts = split(stem);
  auto part = parts.begin();
  for (const auto& entity : known) {
    if (part != parts.end() && part->starts_with(entity.key)) {
      *entity.label = part->substr(entity.key.size());
      if (!is_label(*entity.label)) return std::nullopt;
      ++part;
    } else if (entity.needed) {
      return std::nullopt;
    }
  }
  const bool index = std::ranges::all_of(out.run, [](char c) { return c >= '0' && c <= '9'; });
  return part == parts.end() && index ? std::optional(out) : std::nullopt;
}

/// Folders from that of the recording to the top of its data set, which is above sub-LABEL.
std::vector<fs::path> folders_above(fs::path folder) {
  std::vector<fs::path> out;
  std::error_code ignored;
  folder = fs::absolute(folder, ignored).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();
  for (int i = 0; i < kMostFolders; ++i) {
    out.push_back(folder);
    const bool below =
        std::ranges::any_of(out, [](const fs::path& f) { return f.filename().string().starts_with("sub-"); });
    if ((below && !folder.filename().string().starts_with("sub-")) || folder == folder.root_path()) break;
    folder = folder.parent_path();
  }
  // Without a folder sub-LABEL there is no data set to go up in.
  const bool in_dataset =
      std::ranges::any_of(out, [](const fs::path& f) { return f.filename().string().starts_with("sub-"); });
  if (!in_dataset) out.resize(1);
  return out;
}

/// The file in a folder with most of the entities and no other.
std::optional<fs::path> best_in(const fs::path& folder, const std::set<std::string>& entities,
                                std::string_view ending) {
  std::optional<fs::path> best;
  std::size_t most = 0;
  int looked = 0;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end && looked < kMostFilesLooked;
       it.increment(error), ++looked) {
    const std::string name = it->path().filename().string();
    if (!name.ends_with(ending)) continue;
    auto parts = split(std::string_view(name).substr(0, name.size() - ending.size()));
    if (parts.back().empty()) parts.pop_back();  // before "_motion.json"
    const bool fits =
        std::ranges::all_of(parts, [&](const std::string& part) { return entities.contains(part); });
    if (!fits || (best && parts.size() < most)) continue;
    if (best && parts.size() == most && *best < it->path()) continue;
    best = it->path();
    most = parts.size();
  }
  return best;
}

}  // namespace

fs::path MotionName::file(std::string_view ending) const {
  return folder / fmt::format("{}_{}", stem, ending);
}

bool is_motion_tsv(const fs::path& path) { return path.filename().string().ends_with(kEnding); }

Result<MotionName> parse_motion_name(const fs::path& path) {
  const auto wrong = [&](std::string_view what) {
    return fail(Code::usage,
                fmt::format("{}: {}; a Motion-BIDS recording is called {}, with labels of letters and digits",
                            printable(path.string()), what, kPattern));
  };
  const std::string name = path.filename().string();
  if (!is_motion_tsv(path)) return wrong("does not end in _motion.tsv");
  MotionName out{.top = {},
                 .folder = path.parent_path(),
                 .stem = name.substr(0, name.size() - kEnding.size()),
                 .task = {},
                 .tracksys = {}};
  const auto entities = parse_entities(out.stem);
  if (!entities) return wrong("the file's name is not as BIDS has it");
  out.task = entities->task;
  out.tracksys = entities->tracksys;
  // A path of few words ("sub-01/motion/...") has the current folder above.
  fs::path folder = out.folder;
  if (folder.filename() != "motion") return wrong("lies in no folder motion");
  folder = folder.parent_path();
  if (!entities->ses.empty()) {
    if (folder.filename() != "ses-" + entities->ses)
      return wrong(fmt::format("lies in no folder ses-{}", entities->ses));
    folder = folder.parent_path();
  }
  if (folder.filename() != "sub-" + entities->sub)
    return wrong(fmt::format("lies in no folder sub-{}", entities->sub));
  out.top = folder.parent_path();
  return out;
}

std::optional<fs::path> find_sidecar(const fs::path& path, std::string_view ending) {
  if (!is_motion_tsv(path)) return std::nullopt;
  const std::string name = path.filename().string();
  const std::string stem = name.substr(0, name.size() - kEnding.size());
  std::error_code ignored;
  fs::path same = path.parent_path() / fmt::format("{}_{}", stem, ending);
  if (fs::exists(same, ignored)) return same;
  const auto parts = split(stem);
  const std::set<std::string> entities(parts.begin(), parts.end());
  for (const fs::path& folder : folders_above(path.parent_path()))
    if (auto found = best_in(folder, entities, ending)) return found;
  return std::nullopt;
}

}  // namespace kinemark::io
