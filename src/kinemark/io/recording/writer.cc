// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/recording/writer.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/io/recording/encoder.h"

namespace kinemark::io {

Status RecordingOptions::check() const {
  if (!(sync_interval_s >= 0.01 && sync_interval_s <= 3600.0))
    return fail(Code::usage, fmt::format("a recording is forced to the disk every {} s; need 0.01 to 3600 s",
                                         sync_interval_s));
  return {};
}

struct RecordingWriter::State {
  std::string name;
  int fd = -1;
  SyncPolicy policy = SyncPolicy::background;
  RecordingEncoder encoder;
  Bytes group;
  std::uint64_t size = 0;  ///< bytes of whole groups in the file
  bool closed = false;
  std::optional<Error> failure;  ///< ends the recording
  std::atomic<std::int64_t> acknowledged = 0;
  std::atomic<std::int64_t> on_disk = 0;
  std::atomic<int> sync_error = 0;  ///< errno of the background thread
  std::mutex mutex;
  std::condition_variable_any wake;
  std::jthread thread;

  ~State() {
    if (thread.joinable()) {
      thread.request_stop();
      thread.join();
    }
    if (fd >= 0) ::close(fd);
  }

  Status failed(int error, const char* what) {
    failure = Error{Code::io, fmt::format("{}: {} ({}); {} messages are kept", name, what,
                                          std::generic_category().message(error), acknowledged.load())};
    return std::unexpected(*failure);
  }

  /// errno, or 0.
  int force_to_disk() {
    const std::int64_t messages = acknowledged.load();
    while (::fdatasync(fd) != 0)
      if (errno != EINTR) return errno;
    // on_disk only grows: another thread may already have synchronised more.
    std::int64_t before = on_disk.load();
    while (before < messages && !on_disk.compare_exchange_weak(before, messages)) {
    }
    return 0;
  }

  void keep_syncing(const std::stop_token& stop, double interval_s) {
    std::unique_lock lock(mutex);
    while (!stop.stop_requested()) {
      wake.wait_for(lock, stop, std::chrono::duration<double>(interval_s), [] { return false; });
      if (on_disk.load() == acknowledged.load()) continue;
      if (const int error = force_to_disk(); error != 0) {
        sync_error = error;
        return;
      }
    }
  }

  Status usable() {
    if (failure) return std::unexpected(*failure);
    if (closed) return fail(Code::usage, fmt::format("{}: is closed; nothing can be added", name));
    if (const int error = sync_error.load(); error != 0) return failed(error, "cannot be forced to the disk");
    return {};
  }

  /// All of `group`, or none of it.
  Status write_group() {
    std::size_t done = 0;
    while (done < group.size()) {
      const ssize_t n = ::write(fd, group.data() + done, group.size() - done);
      if (n < 0 && errno == EINTR) continue;
      if (n < 0) {
        const int error = errno;
        const bool torn = done > 0 && ::ftruncate(fd, static_cast<off_t>(size)) != 0;
        return failed(error, torn ? "cannot be written and ends in a torn record" : "cannot be written");
      }
      done += static_cast<std::size_t>(n);
    }
    size += group.size();
    return {};
  }

  Status acknowledge() {
    acknowledged = encoder.messages();
    if (policy != SyncPolicy::always) return {};
    if (const int error = force_to_disk(); error != 0) return failed(error, "cannot be forced to the disk");
    return {};
  }
};

RecordingWriter::RecordingWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
RecordingWriter::RecordingWriter(RecordingWriter&&) noexcept = default;
RecordingWriter::~RecordingWriter() = default;

Result<RecordingWriter> RecordingWriter::create(const std::filesystem::path& path,
                                                const RecordingOptions& options) {
  if (auto s = options.check(); !s) return std::unexpected(s.error());
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored))
    return fail(Code::io, fmt::format("{}: is a folder; need a file name", path.string()));
  // A new file under the old name: processes that read the old recording keep it.
  if (options.force) std::filesystem::remove(path, ignored);
  auto state = std::make_unique<State>();
  state->name = path.string();
  state->policy = options.sync;
  state->fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0666);
  if (state->fd < 0) {
    const int error = errno;
    if (error == EEXIST)
      return fail(Code::io, fmt::format("{}: exists already; use --force to replace it", path.string()));
    return fail(Code::io, fmt::format("{}: cannot be written ({})", path.string(),
                                      std::generic_category().message(error)));
  }
  state->encoder.begin(state->group);
  if (auto s = state->write_group(); !s) return std::unexpected(s.error());
  if (options.sync != SyncPolicy::never) {
    if (const int error = state->force_to_disk(); error != 0)
      return std::unexpected(state->failed(error, "cannot be forced to the disk").error());
    // The directory entry, too, must survive a power cut.
    const auto folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
    if (const int fd = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC); fd >= 0) {
      ::fsync(fd);
      ::close(fd);
    }
  }
  if (options.sync == SyncPolicy::background)
    state->thread = std::jthread([s = state.get(), interval_s = options.sync_interval_s](
                                     const std::stop_token& stop) { s->keep_syncing(stop, interval_s); });
  return RecordingWriter(std::move(state));
}

Result<std::uint16_t> RecordingWriter::add_channel(const RecordingChannel& channel) {
  if (auto s = state_->usable(); !s) return std::unexpected(s.error());
  state_->group.clear();
  const auto index = state_->encoder.add_channel(channel, state_->group);
  if (!index) return index;
  if (auto s = state_->write_group(); !s) return std::unexpected(s.error());
  return index;
}

Status RecordingWriter::add_metadata(const RecordingMetadata& metadata) {
  if (auto s = state_->usable(); !s) return s;
  state_->group.clear();
  if (auto s = state_->encoder.add_metadata(metadata, state_->group); !s) return s;
  return state_->write_group();
}

Status RecordingWriter::append(std::span<const RecordingMessage> messages) {
  if (auto s = state_->usable(); !s) return s;
  state_->group.clear();
  if (auto s = state_->encoder.add_messages(messages, state_->group); !s) return s;
  if (auto s = state_->write_group(); !s) return s;
  return state_->acknowledge();
}

Status RecordingWriter::sync() {
  if (state_->failure) return std::unexpected(*state_->failure);
  if (const int error = state_->force_to_disk(); error != 0)
    return state_->failed(error, "cannot be forced to the disk");
  return {};
}

Status RecordingWriter::close() {
  if (auto s = state_->usable(); !s) return s;
  state_->group.clear();
  state_->encoder.finish(state_->group);
  if (auto s = state_->write_group(); !s) return s;
  state_->closed = true;
  return sync();
}

std::int64_t RecordingWriter::acknowledged() const { return state_->acknowledged.load(); }
std::int64_t RecordingWriter::on_disk() const { return state_->on_disk.load(); }

}  // namespace kinemark::io
