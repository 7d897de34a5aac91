// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/session/session.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <set>
#include <system_error>
#include <utility>

#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/file.h"
#include "kinemark/io/input/file_hash.h"
#include "kinemark/io/recording/survey.h"
#include "kinemark/io/rig/rig_file.h"
#include "kinemark/pipeline/session/session_text.h"
#include "kinemark/pipeline/session/trial_name.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostSessionBytes = 16UL << 20;

fs::path about_of(const fs::path& folder) { return folder / "session.toml"; }
fs::path manifest_of(const fs::path& folder) { return folder / "MANIFEST"; }
fs::path rig_of(const fs::path& folder) { return folder / "rig.toml"; }

/// Held while the two texts of a session are read, changed and written.
class FolderLock {
 public:
  explicit FolderLock(const fs::path& folder)
      : fd_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    while (fd_ >= 0 && ::flock(fd_, LOCK_EX) != 0 && errno == EINTR) {
    }
  }
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock() {
    if (fd_ >= 0) (void)::close(fd_);
  }

 private:
  int fd_;
};

bool is_recording(const fs::directory_entry& entry) {
  std::error_code none;
  return entry.path().extension() == ".mcap" && check_trial_name(entry.path().stem().string()) &&
         fs::is_regular_file(entry.symlink_status(none));
}

const std::string* value_of(const std::vector<io::RecordingMetadata>& metadata, std::string_view record,
                            const std::string& key) {
  for (const auto& each : metadata)
    if (each.name == record)
      if (const auto found = each.values.find(key); found != each.values.end()) return &found->second;
  return nullptr;
}

std::string text_of(const io::RecordingSurvey& survey, const std::string& key) {
  const auto* value = value_of(survey.metadata, "acquisition", key);
  return value == nullptr ? "" : *value;
}

std::optional<double> end_number(const io::RecordingSurvey& survey, const std::string& key) {
  const auto* value = value_of(survey.metadata, "acquisition_end", key);
  return value == nullptr ? std::nullopt : parse_number(*value);
}

std::int64_t end_count(const io::RecordingSurvey& survey, const std::string& key) {
  return static_cast<std::int64_t>(end_number(survey, key).value_or(0.0));
}

/// What a closed recording says of itself.
Result<SessionTrial> trial_of(const fs::path& recording) {
  const auto survey = io::survey_recording(recording);
  if (!survey) return std::unexpected(survey.error());
  if (survey->end != io::RecordingEnd::closed)
    return fail(
        Code::bad_input,
        fmt::format("{}: was not closed; once nothing records into it, 'kinemark recover' makes a whole "
                    "one of it",
                    recording.string()));
  return SessionTrial{.file = "raw/" + recording.filename().string(),
                      .source = text_of(*survey, "source"),
                      .started = text_of(*survey, "started"),
                      .rate_hz = parse_number(text_of(*survey, "rate_hz")).value_or(0.0),
                      .frames = end_count(*survey, "frames"),
                      .dropped_by_device = end_count(*survey, "dropped_by_device"),
                      .dropped_here = end_count(*survey, "dropped_here"),
                      .clock_fast_ppm = end_number(*survey, "clock_fast_ppm"),
                      .clock_fast_sd_ppm = end_number(*survey, "clock_fast_sd_ppm")};
}

Status make_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed) return fail(Code::io, fmt::format("{}: cannot be made: {}", folder.string(), failed.message()));
  return {};
}

/// Whether nothing is in a folder but what is hidden, as a program that was killed leaves.
bool shows_nothing(const fs::path& folder) {
  std::error_code failed;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed))
    if (!at->path().filename().native().starts_with('.')) return false;
  return !failed;
}

/// Absent or empty.
Status check_new(const fs::path& folder) {
  std::error_code failed;
  const auto status = fs::status(folder, failed);
  if (!fs::exists(status)) return {};
  if (!fs::is_directory(status) || !shows_nothing(folder))
    return fail(Code::usage,
                fmt::format("{}: is no session; need one, an empty folder, or a new name", folder.string()));
  return {};
}

/// By file, so that a trial that is taken in again replaces what was known.
template <class T>
void put(std::vector<T>& list, T entry) {
  const auto same = std::ranges::find(list, entry.file, &T::file);
  if (same == list.end())
    list.push_back(std::move(entry));
  else
    *same = std::move(entry);
}

}  // namespace

bool is_session(const fs::path& folder) {
  std::error_code none;
  return fs::is_regular_file(about_of(folder), none);
}

fs::path Session::rig() const { return has_rig_ ? rig_of(folder_) : fs::path(); }

Result<Session> Session::open(const fs::path& folder, const SessionAbout& about) {
  if (!is_session(folder))
    if (auto s = check_new(folder); !s) return std::unexpected(s.error());
  if (auto s = make_folder(folder); !s) return std::unexpected(s.error());
  Session out(folder);
  const FolderLock lock(folder);
  // A new one is a session before anything else is in its folder, and another program may have made it
  // meanwhile.
  if (auto s = is_session(folder) ? out.load(true) : out.save(); !s) return std::unexpected(s.error());
  if (auto s = make_folder(out.raw()); !s) return std::unexpected(s.error());
  if (auto s = out.take_about(about); !s) return std::unexpected(s.error());
  if (auto s = out.take_strays(); !s) return std::unexpected(s.error());
  if (auto s = out.save(); !s) return std::unexpected(s.error());
  return out;
}

Result<Session> Session::read(const fs::path& folder) {
  Session out(folder);
  if (auto s = out.load(false); !s) return std::unexpected(s.error());
  return out;
}

Status Session::take_about(const SessionAbout& about) {
  if (!about.subject.empty() && !subject_.empty() && about.subject != subject_)
    return fail(
        Code::usage,
        fmt::format("{}: is a session of subject '{}', not '{}'; another subject needs another session",
                    folder_.string(), printable(subject_, 100), printable(about.subject, 100)));
  if (!about.subject.empty()) subject_ = about.subject;
  if (about.rig.empty()) return {};
  if (auto rig = io::read_rig(about.rig); !rig) return std::unexpected(rig.error());
  const auto text = io::read_text(about.rig);
  if (!text) return std::unexpected(text.error());
  if (has_rig_) {
    const auto known = io::read_text(rig_of(folder_));
    if (!known) return std::unexpected(known.error());
    if (*known == *text) return {};
    return fail(Code::usage, fmt::format("{}: has another rig, rig.toml, than {}; another rig needs another "
                                         "session",
                                         folder_.string(), about.rig.string()));
  }
  has_rig_ = true;
  return io::write_text(rig_of(folder_), *text, true);
}

Status Session::take_strays() {
  std::set<std::string> known;
  for (const auto& entry : manifest_) known.insert(entry.file);
  std::error_code failed;
  std::vector<fs::path> strays;
  for (fs::directory_iterator at(raw(), failed), end; !failed && at != end; at.increment(failed))
    if (is_recording(*at) && !known.contains("raw/" + at->path().filename().string()))
      strays.push_back(at->path());
  if (failed) return fail(Code::io, fmt::format("{}: cannot be read: {}", raw().string(), failed.message()));
  std::ranges::sort(strays);
  for (const auto& stray : strays) {
    const auto added = add_locked(stray);
    if (!added && added.error().code == Code::io) return added;
    notes_.push_back(added ? fmt::format("{}: was not in the session yet; it is taken in", stray.string())
                           : added.error().message);
  }
  return {};
}

// A program that is killed while it makes a session leaves session.toml alone.
Status Session::load(bool may_lack_manifest) {
  const auto about = io::read_text(about_of(folder_), kMostSessionBytes);
  if (!about) return std::unexpected(about.error());
  auto file = parse_session(*about, about_of(folder_).string());
  if (!file) return std::unexpected(file.error());
  std::vector<ManifestEntry> entries;
  std::error_code none;
  if (!may_lack_manifest || fs::exists(fs::symlink_status(manifest_of(folder_), none))) {
    const auto manifest = io::read_text(manifest_of(folder_), kMostSessionBytes);
    if (!manifest) return std::unexpected(manifest.error());
    auto parsed = parse_manifest(*manifest, manifest_of(folder_).string());
    if (!parsed) return std::unexpected(parsed.error());
    entries = std::move(*parsed);
  }
  subject_ = std::move(file->subject);
  has_rig_ = file->has_rig;
  trials_ = std::move(file->trials);
  manifest_ = std::move(entries);
  return {};
}

// MANIFEST last: what stands in it stands in session.toml too.
Status Session::save() const {
  if (auto s = io::write_text(about_of(folder_), session_text({subject_, has_rig_, trials_}), true); !s)
    return s;
  return io::write_text(manifest_of(folder_), manifest_text(manifest_), true);
}

Status Session::add_locked(const fs::path& recording) {
  auto trial = trial_of(recording);
  if (!trial) return std::unexpected(trial.error());
  const auto hash = io::hash_file(recording);
  if (!hash) return std::unexpected(hash.error());
  std::error_code failed;
  constexpr auto kWrite = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  fs::permissions(recording, kWrite, fs::perm_options::remove, failed);
  if (failed)
    return fail(Code::io,
                fmt::format("{}: cannot be made read-only: {}", recording.string(), failed.message()));
  put(manifest_, ManifestEntry{trial->file, hash->hex});
  put(trials_, std::move(*trial));
  return {};
}

Status Session::set_subject(const std::string& subject) {
  if (subject == subject_) return {};
  const FolderLock lock(folder_);
  if (auto s = load(true); !s) return s;
  if (auto s = take_about({.subject = subject, .rig = {}}); !s) return s;
  return save();
}

Status Session::add(const fs::path& recording) {
  const FolderLock lock(folder_);
  if (auto s = load(true); !s) return s;  // another program may have added
  if (auto s = add_locked(recording); !s) return s;
  return save();
}

Status Session::check() const {
  std::error_code none;
  for (const auto& entry : manifest_) {
    const fs::path file = folder_ / entry.file;
    if (!fs::is_regular_file(fs::symlink_status(file, none)))
      return fail(Code::io, fmt::format("{}: is in MANIFEST and not there, or no file", file.string()));
    const auto hash = io::hash_file(file);
    if (!hash) return std::unexpected(hash.error());
    if (hash->hex != entry.hex)
      return fail(Code::bad_input,
                  fmt::format("{}: was changed since it was recorded: its checksum is {}, in MANIFEST {}",
                              file.string(), hash->hex, entry.hex));
  }
  return {};
}

}  // namespace kinemark::pipeline
