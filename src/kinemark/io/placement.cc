// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/placement.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdint>
#include <optional>
#include <ranges>
#include <string>
#include <system_error>

#include "kinemark/io/file.h"
#include "kinemark/io/place.h"
#include "kinemark/io/temporary.h"

namespace kinemark::io {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kOfAll = "kinemark placement 1", kOfPart = "kinemark placement of", kEnd = "end";
constexpr std::size_t kMostBytes = 64UL << 20;

/// Tells a file from any other one, and from itself after a change. Renaming leaves it as it is.
struct Identity {
  std::uint64_t inode = 0, bytes = 0;
  std::int64_t changed_ns = 0;
  bool operator==(const Identity&) const = default;
};

std::optional<Identity> identity_of(const fs::path& path) {
  struct stat info{};
  if (::lstat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return std::nullopt;
  return Identity{.inode = info.st_ino,
                  .bytes = static_cast<std::uint64_t>(info.st_size),
                  .changed_ns = info.st_mtim.tv_sec * 1'000'000'000LL + info.st_mtim.tv_nsec};
}

/// A file of a set that is being placed.
struct PlacedFile {
  std::size_t folder = 0;  ///< of Record::folders
  std::string staged, target;
  bool replaces = false;  ///< something had the target's name before
  Identity identity = {};
};

/// What a set needs to be taken back. It lies in the first of its hidden folders; the others name that one.
struct Record {
  std::vector<fs::path> folders;  ///< hidden ones
  std::vector<PlacedFile> files;  ///< in the order in which they get their names
  std::vector<fs::path> made;     ///< outermost first

  [[nodiscard]] fs::path staged(const PlacedFile& file) const { return folders[file.folder] / file.staged; }
  [[nodiscard]] fs::path target(const PlacedFile& file) const {
    return folders[file.folder].parent_path() / file.target;
  }
  [[nodiscard]] bool is_placed(const PlacedFile& file) const {
    return identity_of(target(file)) == file.identity;
  }
};

fs::path normal_path(const fs::path& path) {
  std::error_code ignored;
  return fs::absolute(path, ignored).lexically_normal();
}

/// Fields with a zero byte behind each, which no path holds.
class Fields {
 public:
  Fields& add(std::string_view field) {
    text_ += field;
    text_ += '\0';
    return *this;
  }
  template <class Number>
  Fields& add_number(Number number) {
    return add(fmt::format("{}", number));
  }
  Fields& add_paths(const std::vector<fs::path>& paths) {
    add_number(paths.size());
    for (const auto& path : paths) add(path.native());
    return *this;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Reads them back; whatever is not there is empty or 0, and is_whole() false.
class FieldReader {
 public:
  explicit FieldReader(std::string text) : text_(std::move(text)) {}
  std::string next() {
    const auto end = text_.find('\0', at_);
    is_whole_ = is_whole_ && end != std::string::npos;
    if (!is_whole_) return {};
    auto field = text_.substr(at_, end - at_);
    at_ = end + 1;
    return field;
  }
  template <class Number>
  Number number() {
    const std::string field = next();
    Number value{};
    const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    is_whole_ = is_whole_ && error == std::errc() && end == field.data() + field.size();
    return is_whole_ ? value : Number{};
  }
  std::vector<fs::path> paths() {
    std::vector<fs::path> out;
    for (auto left = number<std::size_t>(); left > 0 && is_whole_; --left) out.emplace_back(next());
    return out;
  }
  [[nodiscard]] bool is_whole() const { return is_whole_; }

 private:
  std::string text_;
  std::size_t at_ = 0;
  bool is_whole_ = true;
};

std::string format_record(const Record& record) {
  Fields fields;
  fields.add(kOfAll).add_paths(record.folders).add_number(record.files.size());
  for (const auto& file : record.files) {
    fields.add_number(file.folder).add(file.staged).add(file.target).add_number(file.replaces ? 1 : 0);
    fields.add_number(file.identity.inode).add_number(file.identity.bytes);
    fields.add_number(file.identity.changed_ns);
  }
  return fields.add_paths(record.made).add(kEnd).text();
}

bool is_name(const std::string& name) {
  return !name.empty() && name != "." && name != ".." && name.find('/') == std::string::npos;
}

/// The text behind its first field. No value for one that is not whole.
std::optional<Record> parse_record(FieldReader& in) {
  Record record{.folders = in.paths(), .files = {}, .made = {}};
  for (auto left = in.number<std::size_t>(); left > 0 && in.is_whole(); --left) {
    PlacedFile file{.folder = in.number<std::size_t>(), .staged = in.next(), .target = in.next()};
    file.replaces = in.number<int>() != 0;
    file.identity.inode = in.number<std::uint64_t>();
    file.identity.bytes = in.number<std::uint64_t>();
    file.identity.changed_ns = in.number<std::int64_t>();
    if (file.folder >= record.folders.size() || !is_name(file.staged) || !is_name(file.target))
      return std::nullopt;
    record.files.push_back(std::move(file));
  }
  record.made = in.paths();
  if (in.next() != kEnd || !in.is_whole() || record.folders.empty()) return std::nullopt;
  return record;
}

/// The text of a hidden folder's record; empty where there is none.
std::string record_text(const fs::path& hidden) {
  struct stat info{};
  const auto path = hidden / kPlacementRecord;
  if (::lstat(path.c_str(), &info) != 0 || !S_ISREG(info.st_mode)) return {};
  return read_text(path, kMostBytes).value_or("");
}

std::string text_of_part(const fs::path& first) {
  return Fields().add(kOfPart).add(first.native()).add(kEnd).text();
}

Record describe(const std::vector<FileToPlace>& files, const std::vector<fs::path>& made) {
  Record record;
  for (const auto& file : files) {
    const auto hidden = normal_path(file.staged.parent_path());
    auto at = std::ranges::find(record.folders, hidden);
    if (at == record.folders.end()) at = record.folders.insert(at, hidden);
    std::error_code ignored;
    record.files.push_back({.folder = static_cast<std::size_t>(at - record.folders.begin()),
                            .staged = file.staged.filename().string(),
                            .target = file.target.filename().string(),
                            .replaces = fs::exists(fs::symlink_status(file.target, ignored)),
                            .identity = identity_of(file.staged).value_or(Identity{})});
  }
  for (const auto& folder : made) record.made.push_back(normal_path(folder));
  return record;
}

/// The record and what points to it, on the disk before any file gets its name.
Status write_record(const Record& record) {
  for (std::size_t i = record.folders.size(); i-- > 0;) {
    const auto& hidden = record.folders[i];
    const auto text = i == 0 ? format_record(record) : text_of_part(record.folders.front());
    if (auto s = write_text(hidden / kPlacementRecord, text, true); !s) return s;
    if (auto s = sync_folder(hidden); !s) return s;
  }
  return {};
}

/// Nothing is to be taken back any more.
void remove_record(const fs::path& first) {
  std::error_code ignored;
  fs::remove(first / kPlacementRecord, ignored);
}

using Done = std::vector<std::pair<const FileToPlace*, Replaced>>;

void unplace(const Done& done) {
  for (const auto& [file, how] : std::views::reverse(done)) unplace_file(file->staged, file->target, how);
}

Status place_each(const std::vector<FileToPlace>& files, bool force, Done& done) {
  for (const auto& file : files) {
    const auto placed = place_file(file.staged, file.target, force, true);
    if (!placed) return std::unexpected(placed.error());
    done.emplace_back(&file, *placed);
  }
  std::vector<fs::path> folders;
  for (const auto& file : files) {
    const auto folder = file.target.parent_path();
    if (std::ranges::find(folders, folder) != folders.end()) continue;
    folders.push_back(folder);
    if (auto s = sync_folder(folder); !s) return s;
  }
  return {};
}

/// A failure that names a hidden file says instead which file cannot be written.
std::unexpected<Error> failure_of(const FileToPlace& file, const Error& error) {
  const auto why = error.message.rfind(" (");
  return fail(Code::io, fmt::format("{}: cannot be written{}", file.target.string(),
                                    why == std::string::npos ? "" : error.message.substr(why)));
}

/// A hidden folder whose writer is no more, locked as long as this lives.
class Orphan {
 public:
  explicit Orphan(const fs::path& path)
      : fd_(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC)) {
    struct stat info{};
    is_ours_ = fd_ >= 0 && is_temporary(path) && ::fstat(fd_, &info) == 0 && info.st_uid == ::geteuid();
    is_locked_ = is_ours_ && ::flock(fd_, LOCK_EX | LOCK_NB) == 0;
  }
  ~Orphan() {
    if (fd_ >= 0) ::close(fd_);
  }
  Orphan(const Orphan&) = delete;
  Orphan& operator=(const Orphan&) = delete;
  [[nodiscard]] bool is_ours() const { return is_ours_; }      ///< it is there, and the user's
  [[nodiscard]] bool is_locked() const { return is_locked_; }  ///< and nobody else's

 private:
  int fd_;
  bool is_ours_ = false, is_locked_ = false;
};

void take_back(const Record& record, const PlacedFile& file) {
  if (!record.is_placed(file)) return;
  const auto staged = record.staged(file), target = record.target(file);
  const auto old = identity_of(staged);
  std::error_code ignored;
  if (old && *old != file.identity)
    fs::rename(staged, target, ignored);
  else if (!file.replaces)
    fs::remove(target, ignored);  // one that replaced what the system could not keep stays
}

/// Whether each folder is where it was, and says of itself that it belongs to the first one.
bool is_together(const Record& record, const fs::path& first) {
  for (const auto& hidden : record.folders | std::views::drop(1))
    if (!is_temporary(hidden) || record_text(hidden) != text_of_part(record.folders.front())) return false;
  std::error_code ignored;
  return fs::equivalent(record.folders.front(), first, ignored);
}

void remove_made(const Record& record, const fs::path& in_use) {
  std::error_code ignored;
  for (const auto& folder : std::views::reverse(record.made))
    if (!fs::equivalent(folder, in_use, ignored)) ::rmdir(folder.c_str());
}

/// @param first  the locked folder that holds the record
void take_back_all(const fs::path& first, FieldReader& in, const fs::path& in_use) {
  const auto record = parse_record(in);
  if (!record || !is_together(*record, first)) return;
  const auto placed =
      std::ranges::count_if(record->files, [&](const auto& f) { return record->is_placed(f); });
  if (placed == std::ssize(record->files)) return;
  for (const auto& file : std::views::reverse(record->files)) take_back(*record, file);
  for (const auto& hidden : record->folders) (void)sync_folder(hidden.parent_path());
  remove_record(first);
  std::error_code ignored;
  for (const auto& hidden : std::views::reverse(record->folders)) fs::remove_all(hidden, ignored);
  remove_made(*record, in_use);
}

}  // namespace

Status record_placement(const std::vector<FileToPlace>& files, const std::vector<fs::path>& made) {
  if (auto s = write_record(describe(files, made)); !s) return failure_of(files.front(), s.error());
  return {};
}

Status place_files(const std::vector<FileToPlace>& files, bool force, const std::vector<fs::path>& made) {
  const bool several = files.size() > 1;
  if (several)
    if (auto s = record_placement(files, made); !s) return s;
  const auto held = hold_end();
  Done done;
  auto placed = place_each(files, force, done);
  if (!placed) unplace(done);
  if (several) remove_record(files.front().staged.parent_path());
  return placed;
}

bool take_back_placement(const fs::path& hidden, const fs::path& in_use) {
  FieldReader in(record_text(hidden));
  const auto kind = in.next();
  if (kind == kOfAll) take_back_all(hidden, in, in_use);
  if (kind != kOfPart) return true;
  const fs::path first = in.next();
  if (in.next() != kEnd) return true;
  const Orphan orphan(first);
  if (!orphan.is_ours()) return true;
  if (!orphan.is_locked()) return false;
  FieldReader all(record_text(first));
  if (all.next() == kOfAll) take_back_all(first, all, in_use);
  return true;
}

}  // namespace kinemark::io
