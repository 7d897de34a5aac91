// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/edits/edit_journal.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/types.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <set>
#include <system_error>
#include <utility>

#include "kinemark/core/counted.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/edits/edit_line.h"
#include "kinemark/io/file.h"
#include "kinemark/io/regular_file.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kMostBytes = 64UL << 20;
constexpr std::size_t kLongestLine = 64UL << 10;

std::string facts_of(const data::EditedRecording& recording) {
  return fmt::format("'{}' of {}, {}", printable(recording.name), counted(recording.bytes, "byte"),
                     recording.hash);
}

/// A system's own lock; a file system that has none does without.
bool locked_by_another(int fd) { return ::flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK; }

/// All of a text, or the error.
int write_all(int fd, std::string_view text) {
  while (!text.empty()) {
    const ssize_t n = ::write(fd, text.data(), text.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return errno;
    text.remove_prefix(static_cast<std::size_t>(n));
  }
  return ::fsync(fd) == 0 ? 0 : errno;
}

}  // namespace

Result<EditsRead> parse_edits(std::string_view text, const std::string& name) {
  EditsRead out;
  std::set<std::string, std::less<>> ids;
  bool named = false;
  while (!text.empty()) {
    const auto end = text.find('\n');
    if (end == std::string_view::npos) {
      if (named)
        out.notes.push_back(
            fmt::format("{}: line {} was not written to its end and is left out", name, out.lines + 1));
      break;
    }
    auto line = text.substr(0, end);
    text.remove_prefix(end + 1);
    out.whole_bytes += end + 1;
    ++out.lines;
    const auto where = fmt::format("{}: line {}", name, out.lines);
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.size() > kLongestLine)
      return fail(Code::bad_input,
                  fmt::format("{}: {} bytes; need {} at most", where, line.size(), kLongestLine));
    if (line.find_first_not_of(" \t") == std::string_view::npos) continue;
    if (!named) {
      auto recording = parse_recording(line);
      if (!recording) return fail_at(where, recording.error());
      out.list.recording = std::move(*recording);
      named = true;
      continue;
    }
    auto edit = parse_edit(line);
    if (!edit) return fail_at(where, edit.error());
    edit->line = out.lines;
    if (!edit->id.empty() && !ids.insert(edit->id).second)
      return fail(Code::bad_input, fmt::format("{}: id '{}' is an earlier operation's", where, edit->id));
    out.list.edits.push_back(std::move(*edit));
  }
  if (!named)
    return fail(Code::bad_input,
                fmt::format("{}: line 1: needs {{\"kinemark_edits\": 1, \"recording\": {{...}}}}", name));
  if (const auto in_force = out.list.in_force(); !in_force) return fail_at(name, in_force.error());
  return out;
}

Result<EditsRead> read_edits(const std::filesystem::path& path) {
  const auto text = read_text(path, kMostBytes);
  if (!text) return std::unexpected(text.error());
  return parse_edits(*text, path.string());
}

Status check_recording(const std::filesystem::path& journal, const data::EditedRecording& recording,
                       const data::EditedRecording& given) {
  if (recording.same_bytes(given)) return {};
  return fail(Code::bad_input,
              fmt::format("{}: these edits are of {}, and this is {}; need the recording that they are of",
                          journal.string(), facts_of(recording), facts_of(given)));
}

Result<EditJournal> EditJournal::open(const std::filesystem::path& path,
                                      const data::EditedRecording& recording, bool force) {
  EditJournal journal(path);
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) {
    journal.list_.recording = recording;
    return journal;
  }
  if (auto s = check_regular(path); !s) return std::unexpected(s.error());
  if (auto s = journal.lock(); !s) return std::unexpected(s.error());
  if (auto s = journal.read(recording, force); !s) return std::unexpected(s.error());
  return journal;
}

Status EditJournal::lock() {
  fd_ = ::open(path_.c_str(), O_RDWR | O_APPEND | O_CLOEXEC);
  if (fd_ < 0) return failed("cannot be written", errno);
  if (locked_by_another(fd_))
    return fail(Code::io, fmt::format("{}: is being edited by another program", path_.string()));
  return {};
}

Status EditJournal::begin(std::string_view line) {
  const auto first = with_sum(format_recording(list_.recording)) + "\n";
  if (auto s = write_text(path_, first + std::string(line), false); !s) return s;
  bytes_ = first.size() + line.size();
  lines_ = 2;
  auto locked = lock();
  // Whoever came between the two has written behind it.
  broken_ = !locked || !std::cmp_equal(::lseek(fd_, 0, SEEK_END), bytes_);
  return locked;
}

Status EditJournal::read(const data::EditedRecording& recording, bool force) {
  auto read = read_edits(path_);
  if (!read) return std::unexpected(read.error());
  if (!force)
    if (auto s = check_recording(path_, read->list.recording, recording); !s) return s;
  bytes_ = read->whole_bytes;
  lines_ = read->lines;
  list_ = std::move(read->list);
  notes_ = std::move(read->notes);
  const auto end = ::lseek(fd_, 0, SEEK_END);
  if (std::cmp_less_equal(end, bytes_)) return {};
  if (::ftruncate(fd_, static_cast<off_t>(bytes_)) != 0 || ::fsync(fd_) != 0)
    return failed("its unfinished last line cannot be taken away", errno);
  return {};
}

EditJournal::EditJournal(EditJournal&& other) noexcept
    : path_(std::move(other.path_)),
      fd_(std::exchange(other.fd_, -1)),
      broken_(other.broken_),
      bytes_(other.bytes_),
      lines_(other.lines_),
      list_(std::move(other.list_)),
      notes_(std::move(other.notes_)) {}

EditJournal& EditJournal::operator=(EditJournal&& other) noexcept {
  if (this == &other) return *this;
  if (fd_ >= 0) ::close(fd_);
  path_ = std::move(other.path_);
  fd_ = std::exchange(other.fd_, -1);
  broken_ = other.broken_;
  bytes_ = other.bytes_;
  lines_ = other.lines_;
  list_ = std::move(other.list_);
  notes_ = std::move(other.notes_);
  return *this;
}

EditJournal::~EditJournal() {
  if (fd_ >= 0) ::close(fd_);
}

Status EditJournal::failed(std::string_view what, int error) const {
  return fail(Code::io,
              fmt::format("{}: {} ({})", path_.string(), what, std::generic_category().message(error)));
}

Status EditJournal::write_line(std::string_view line) {
  if (broken_)
    return fail(Code::io, fmt::format("{}: an earlier failure left it unknown what is in it; open it again",
                                      path_.string()));
  if (fd_ < 0) return begin(line);
  if (bytes_ + line.size() > kMostBytes)
    return fail(Code::io, fmt::format("{}: is full; {} bytes are the most", path_.string(), kMostBytes));
  const int error = write_all(fd_, line);
  if (error == 0) {
    bytes_ += line.size();
    ++lines_;
    return {};
  }
  broken_ = ::ftruncate(fd_, static_cast<off_t>(bytes_)) != 0 || ::fsync(fd_) != 0;
  return failed("the edit cannot be written", error);
}

Status EditJournal::append(data::Edit edit) {
  if (auto s = edit.check(); !s) return s;
  const auto has = [&](const std::string& id) {
    return std::ranges::find(list_.edits, id, &data::Edit::id) != list_.edits.end();
  };
  if (edit.id.empty()) {
    auto number = list_.edits.size() + 1;
    while (has(std::to_string(number))) ++number;
    edit.id = std::to_string(number);
  } else if (has(edit.id)) {
    return fail(Code::bad_input,
                fmt::format("{}: id '{}' is an earlier operation's", path_.string(), edit.id));
  }
  edit.line = std::max(lines_, 1) + 1;
  list_.edits.push_back(std::move(edit));
  const auto in_force = list_.in_force();
  Status done;
  if (!in_force)
    done = fail_at(path_.string(), in_force.error());
  else
    done = write_line(with_sum(format_edit(list_.edits.back())) + "\n");
  if (!done) list_.edits.pop_back();
  return done;
}

Status EditJournal::undo(int count, std::string made) {
  return append({.kind = data::EditKind::undo, .count = count, .made = std::move(made)});
}

Status EditJournal::redo(int count, std::string made) {
  return append({.kind = data::EditKind::redo, .count = count, .made = std::move(made)});
}

}  // namespace kinemark::io
