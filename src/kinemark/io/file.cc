// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/file.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/io/place.h"
#include "kinemark/io/regular_file.h"
#include "kinemark/io/seal.h"

namespace kinemark::io {
namespace {

std::string reason() { return std::generic_category().message(errno); }

}  // namespace

Result<InputFile> InputFile::open(const std::filesystem::path& path) {
  if (auto regular = check_regular(path); !regular) return std::unexpected(regular.error());
  // Not to wait for ever should a pipe take the file's name in between.
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (fd < 0) return fail(Code::io, fmt::format("{}: cannot be opened ({})", path.string(), reason()));
  struct stat info{};
  if (::fstat(fd, &info) != 0 || !S_ISREG(info.st_mode)) {
    ::close(fd);
    return fail(Code::io, fmt::format("{}: is not a regular file", path.string()));
  }
  return InputFile(fd, static_cast<std::size_t>(info.st_size), path.string());
}

InputFile::InputFile(InputFile&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)), size_(other.size_), name_(std::move(other.name_)) {}

InputFile& InputFile::operator=(InputFile&& other) noexcept {
  std::swap(fd_, other.fd_);
  std::swap(size_, other.size_);
  std::swap(name_, other.name_);
  return *this;
}

InputFile::~InputFile() {
  if (fd_ >= 0) ::close(fd_);
}

Result<std::size_t> InputFile::read_at(std::size_t offset, std::span<std::byte> out) const {
  std::size_t done = 0;
  while (done < out.size()) {
    const ssize_t n = ::pread(fd_, out.data() + done, out.size() - done, static_cast<off_t>(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return fail(Code::io, fmt::format("{}: cannot be read ({})", name_, reason()));
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  return done;
}

Result<std::string> read_begin(const std::filesystem::path& path) {
  const auto file = InputFile::open(path);
  if (!file) return std::unexpected(file.error());
  std::string begin(16UL << 10, '\0');
  const auto size = file->read_at(0, std::as_writable_bytes(std::span(begin)));
  if (!size) return std::unexpected(size.error());
  begin.resize(*size);
  return begin;
}

Result<std::string> read_text(const std::filesystem::path& path, std::size_t max_bytes) {
  auto file = InputFile::open(path);
  if (!file) return std::unexpected(file.error());
  if (file->size() > max_bytes)
    return fail(Code::bad_input, fmt::format("{}: has {} bytes; at most {} are read as text", path.string(),
                                             file->size(), max_bytes));
  std::string text(file->size(), '\0');
  const auto n = file->read_at(0, std::as_writable_bytes(std::span(text)));
  if (!n) return std::unexpected(n.error());
  text.resize(*n);
  return text;
}

OutputFile::OutputFile(std::filesystem::path name, std::filesystem::path target, bool force,
                       Temporary temporary)
    : name_(std::move(name)), target_(std::move(target)), force_(force), temporary_(std::move(temporary)) {}

Result<OutputFile> OutputFile::create(const std::filesystem::path& path, bool force) {
  const auto parent = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  if (!is_temporary(parent)) remove_leftovers(parent);  // they may be in the way
  auto target = find_target(path, force);
  if (!target) return std::unexpected(target.error());
  auto temporary = Temporary::file_for(*target);
  if (!temporary) return std::unexpected(temporary.error());
  return OutputFile(path, std::move(*target), force, std::move(*temporary));
}

void OutputFile::Free::operator()(XXH3_state_s* state) const { XXH3_freeState(state); }

Status OutputFile::write(std::span<const std::byte> bytes) {
  if (sum_) XXH3_64bits_update(sum_.get(), bytes.data(), bytes.size());
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::write(temporary_.fd(), bytes.data() + done, bytes.size() - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return fail(Code::io, fmt::format("{}: cannot be written ({})", name_.string(), reason()));
    done += static_cast<std::size_t>(n);
  }
  return {};
}

Status OutputFile::write(std::string_view text) { return write(std::as_bytes(std::span(text))); }

Status OutputFile::write_sealed(std::string_view text) {
  sum_at_ = find_mark(text, kSumKey);
  check(sum_at_ != std::string_view::npos && !sum_,
        "OutputFile::write_sealed: the text holds no place of a sum");
  sum_.reset(XXH3_createState());
  XXH3_64bits_reset(sum_.get());
  return write(text);
}

Status OutputFile::commit() {
  if (sum_) {
    const auto digits = fmt::format("{:016x}", XXH3_64bits_digest(sum_.get()));
    if (::pwrite(temporary_.fd(), digits.data(), digits.size(), static_cast<off_t>(sum_at_)) !=
        static_cast<ssize_t>(digits.size()))
      return fail(Code::io, fmt::format("{}: cannot be written ({})", name_.string(), reason()));
  }
  if (::fsync(temporary_.fd()) != 0)
    return fail(Code::io, fmt::format("{}: cannot be written ({})", name_.string(), reason()));
  {
    const auto held = hold_end();
    const auto placed = place_file(temporary_.path(), target_, force_);
    if (!placed) return std::unexpected(placed.error());
    temporary_.release();
  }
  return is_temporary(target_.parent_path()) ? Status() : sync_folder(target_.parent_path());
}

Status write_text(const std::filesystem::path& path, std::string_view text, bool force) {
  auto file = OutputFile::create(path, force);
  if (!file) return std::unexpected(file.error());
  if (auto status = file->write(text); !status) return status;
  return file->commit();
}

Status write_sealed_text(const std::filesystem::path& path, std::string_view text, bool force) {
  auto file = OutputFile::create(path, force);
  if (!file) return std::unexpected(file.error());
  if (auto status = file->write_sealed(text); !status) return status;
  return file->commit();
}

}  // namespace kinemark::io
