// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/comedi/comedi_device.h"

#include <comedilib.h>
#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <mutex>
#include <optional>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/stream/comedi/comedi_plan.h"
#include "kinemark/stream/internal/device_file.h"
#include "kinemark/stream/internal/frame_anchor.h"

namespace kinemark::stream {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(steady_clock::now().time_since_epoch()).count();
}

struct Close {
  void operator()(comedi_t* board) const { comedi_close(board); }
};
using Board = std::unique_ptr<comedi_t, Close>;

/// A board that is open, and where its parts are; -1: it has none.
struct OpenBoard {
  Board board;
  int inputs = -1, outputs = -1, lines = -1;
  std::size_t sample_bytes = 2;
  BoardFacts facts;
};

/// What command_test() makes of a command; nothing when it cannot be had. It adjusts one thing a call.
std::optional<comedi_cmd> possible(comedi_t* board, comedi_cmd command) {
  for (int call = 0; call < 5; ++call) {
    const int changed = comedi_command_test(board, &command);
    if (changed == 0) return command;
    if (changed < 3) return std::nullopt;
  }
  return std::nullopt;
}

comedi_cmd scan_command(const OpenBoard& open, ScanClock clock, std::vector<unsigned>& channels) {
  comedi_cmd out{};
  out.subdev = static_cast<unsigned>(open.inputs);
  out.start_src = TRIG_NOW;
  out.scan_begin_src = TRIG_TIMER;
  out.scan_begin_arg = static_cast<unsigned>(clock.scan_ns);
  out.convert_src = TRIG_TIMER;
  out.convert_arg = static_cast<unsigned>(clock.conversion_ns);
  out.scan_end_src = TRIG_COUNT;
  out.scan_end_arg = static_cast<unsigned>(channels.size());
  out.stop_src = TRIG_NONE;
  out.chanlist = channels.data();
  out.chanlist_len = static_cast<unsigned>(channels.size());
  return out;
}

/// The first n inputs, by their first range.
std::vector<unsigned> first_channels(int n) {
  std::vector<unsigned> out;
  for (int i = 0; i < n; ++i) out.push_back(CR_PACK(static_cast<unsigned>(i), 0, AREF_GROUND));
  return out;
}

std::vector<VoltageRange> ranges_of(comedi_t* board, unsigned inputs) {
  std::vector<VoltageRange> out;
  const int count = comedi_get_n_ranges(board, inputs, 0);
  for (int i = 0; i < count; ++i)
    if (const auto* range = comedi_get_range(board, inputs, 0, static_cast<unsigned>(i)); range != nullptr)
      out.push_back({.lowest_v = range->min, .highest_v = range->max});
  return out;
}

int channels_of(comedi_t* board, int part) {
  return part < 0 ? 0 : std::max(0, comedi_get_n_channels(board, static_cast<unsigned>(part)));
}

Status find_parts(OpenBoard& open) {
  auto* board = open.board.get();
  open.inputs = comedi_get_read_subdevice(board);
  if (open.inputs < 0 ||
      comedi_get_subdevice_type(board, static_cast<unsigned>(open.inputs)) != COMEDI_SUBD_AI)
    return fail(Code::device, "has no analog inputs that can be scanned");
  open.outputs = comedi_find_subdevice_by_type(board, COMEDI_SUBD_AO, 0);
  open.lines = comedi_find_subdevice_by_type(board, COMEDI_SUBD_DO, 0);
  if (open.lines < 0) open.lines = comedi_find_subdevice_by_type(board, COMEDI_SUBD_DIO, 0);
  const auto inputs = static_cast<unsigned>(open.inputs);
  auto& facts = open.facts;
  facts.name = fmt::format("{} {}", comedi_get_driver_name(board), comedi_get_board_name(board));
  facts.channels = channels_of(board, open.inputs);
  facts.highest_code = comedi_get_maxdata(board, inputs, 0);
  facts.ranges = ranges_of(board, inputs);
  facts.analog_outputs = channels_of(board, open.outputs);
  facts.digital_outputs = channels_of(board, open.lines);
  open.sample_bytes = (comedi_get_subdevice_flags(board, inputs) & SDF_LSAMPL) != 0 ? 4 : 2;
  auto channels = first_channels(std::min(facts.channels, 4));
  const auto fastest =
      possible(board, scan_command(open, {.scan_ns = 1'000'000'000, .conversion_ns = 0}, channels));
  if (facts.channels < 4 || facts.highest_code < 1 || !fastest)
    return fail(Code::device,
                fmt::format("{} has no four inputs whose scans and conversions a timer begins", facts.name));
  facts.conversion_ns = std::max<std::int64_t>(1, fastest->convert_arg);
  // Whatever room the kernel gives: a reader may stall.
  const int most = comedi_get_max_buffer_size(board, inputs);
  if (most > 0) comedi_set_buffer_size(board, inputs, static_cast<unsigned>(most));
  return {};
}

Result<OpenBoard> open_board(const std::string& path) {
  comedi_loglevel(0);
  errno = 0;
  OpenBoard out;
  out.board.reset(comedi_open(path.c_str()));
  if (!out.board) return fail(Code::device, cannot_open(path, errno != 0 ? errno : ENODEV));
  const int fd = comedi_fileno(out.board.get());
  if (flock(fd, LOCK_EX | LOCK_NB) != 0) return fail(Code::device, cannot_open(path, errno));
  if (auto s = find_parts(out); !s) return fail_at(path, s.error());
  fcntl(fd, F_SETFL, O_NONBLOCK);
  fcntl(fd, F_SETFD, FD_CLOEXEC);
  return out;
}

class ComediDevice final : public Device {
 public:
  ComediDevice(std::string path, OpenBoard open)
      : path_(std::move(path)), open_(std::move(open)), capabilities_(board_capabilities(open_.facts)) {}

  [[nodiscard]] const DeviceCapabilities& capabilities() const override { return capabilities_; }
  Result<GrantedPlan> configure(const ScanPlan& plan) override;
  Status start() override;
  Result<ReadResult> read(Block& block, milliseconds timeout) override;
  Status stop() override;
  Status reopen() override;
  Status write_analog(int channel, double volts) override;
  Status write_digital(int line, bool high) override;

 private:
  [[nodiscard]] std::unexpected<Error> gone() const {
    return fail(Code::device, fmt::format("{}: the board is gone; plug it in again", path_));
  }
  [[nodiscard]] std::size_t frame_bytes() const {
    return granted_->plan.leds.size() * granted_->plan.cameras.size() * 4 * open_.sample_bytes;
  }
  Status begin();
  Status begin_again();
  bool take_frames(Block& block);
  Result<bool> take_samples(milliseconds timeout);

  std::string path_;
  OpenBoard open_;           // without a board while it is gone
  std::mutex board_in_use_;  // outputs are set by other threads
  DeviceCapabilities capabilities_;
  std::optional<GrantedPlan> granted_;
  ScanPlan wanted_;
  ScanClock clock_;
  bool runs_ = false, overflow_ = false, renumbered_ = false;
  std::vector<std::byte> bytes_;   // samples of frames that are not whole
  std::int64_t first_number_ = 0;  // of the next frame since scans last began
  std::int64_t next_number_ = 0;   // that is expected
  std::int64_t before_ns_ = 0, after_ns_ = 0;
  FrameAnchor anchor_{1.0};
};

Result<GrantedPlan> ComediDevice::configure(const ScanPlan& wanted) {
  const ScanPlan plan = with_names(wanted, capabilities());
  check(!runs_, "a plan is set while the board stands still");
  if (!open_.board) return gone();
  const auto clock = scan_clock(plan, open_.facts);
  if (!clock) return std::unexpected(clock.error());
  auto channels = first_channels(4 * static_cast<int>(plan.cameras.size()));
  const auto command = possible(open_.board.get(), scan_command(open_, *clock, channels));
  if (!command)
    return fail(Code::usage, fmt::format("{} refuses scans of {} inputs at {:.6g} Hz", open_.facts.name,
                                         channels.size(), 1e9 / static_cast<double>(clock->scan_ns)));
  clock_ = {.scan_ns = command->scan_begin_arg, .conversion_ns = command->convert_arg};
  wanted_ = plan;
  granted_ = granted_scans(plan, clock_, open_.facts);
  return *granted_;
}

Status ComediDevice::begin() {
  auto channels = first_channels(4 * static_cast<int>(granted_->plan.cameras.size()));
  auto command = scan_command(open_, clock_, channels);
  bytes_.clear();
  before_ns_ = now_ns();
  if (comedi_command(open_.board.get(), &command) < 0)
    return fail(Code::device, fmt::format("{}: does not start: {}", path_, comedi_strerror(comedi_errno())));
  after_ns_ = now_ns();
  runs_ = true;
  return {};
}

Status ComediDevice::start() {
  check(granted_.has_value() && !runs_, "a board starts with a plan, and once");
  if (!open_.board) return gone();
  if (auto s = begin(); !s) return s;
  anchor_ = FrameAnchor(granted_->plan.rate_hz);
  anchor_.begin(0, after_ns_);
  first_number_ = next_number_ = 0;
  overflow_ = renumbered_ = false;
  return {};
}

/// Scans begin again; frames are numbered on by the host's clock.
Status ComediDevice::begin_again() {
  comedi_cancel(open_.board.get(), static_cast<unsigned>(open_.inputs));
  if (auto s = begin(); !s) return s;
  first_number_ = anchor_.after_break(next_number_, after_ns_);
  anchor_.begin(first_number_, after_ns_);
  renumbered_ = true;
  return {};
}

/// All whole frames that came; false when there is none.
bool ComediDevice::take_frames(Block& block) {
  const auto frames = bytes_.size() / frame_bytes();
  if (frames == 0) return false;
  const auto used = frames * frame_bytes();
  append_counts(std::span(bytes_).first(used), open_.sample_bytes, open_.facts, block.counts);
  bytes_.erase(bytes_.begin(), bytes_.begin() + static_cast<std::ptrdiff_t>(used));
  block.frames = static_cast<std::int64_t>(frames);
  block.first_frame = first_number_;
  block.gap = first_number_ != next_number_;
  block.overflow = std::exchange(overflow_, false);
  block.renumbered = std::exchange(renumbered_, false);
  first_number_ += block.frames;
  next_number_ = first_number_;
  for (std::size_t i = 0; i < block.counts.size(); i += 4) {
    const auto* four = block.counts.data() + i;
    const bool high = *std::max_element(four, four + 4) >= granted_->layout.highest_code;
    block.flags.push_back(high ? data::kCountSaturated : 0);
    block.saturated |= high;
  }
  block.host_before_ns = before_ns_;
  block.host_after_ns = after_ns_;
  anchor_.came(next_number_, after_ns_);
  return true;
}

/// Read what the kernel has; false when nothing came in time.
Result<bool> ComediDevice::take_samples(milliseconds timeout) {
  const int fd = comedi_fileno(open_.board.get());
  const auto before = now_ns();
  pollfd one{.fd = fd, .events = POLLIN, .revents = 0};
  if (poll(&one, 1, static_cast<int>(std::clamp<std::int64_t>(timeout.count(), 0, 3'600'000))) == 0)
    return false;
  std::array<std::byte, 65'536> room{};
  const auto got = ::read(fd, room.data(), room.size());
  if (got < 0 && (errno == EAGAIN || errno == EINTR)) return false;
  if (got > 0) {
    before_ns_ = before;
    after_ns_ = now_ns();
    bytes_.insert(bytes_.end(), room.begin(), room.begin() + got);
    return true;
  }
  if (got < 0 && errno != EPIPE) return gone();
  // The buffer ran over, or the board stopped by itself; what it held has been read.
  overflow_ = true;
  if (auto s = begin_again(); !s) return std::unexpected(s.error());
  return true;
}

Result<ReadResult> ComediDevice::read(Block& block, milliseconds timeout) {
  check(runs_, "frames come from a board that was started");
  block.counts.clear();
  block.dark.clear();
  block.flags.clear();
  block.frames = 0;
  block.overflow = block.gap = block.renumbered = block.saturated = false;
  if (!open_.board) return gone();
  const auto deadline = steady_clock::now() + timeout;
  while (!take_frames(block)) {
    const auto left = std::chrono::ceil<milliseconds>(deadline - steady_clock::now());
    const auto came = take_samples(std::max(milliseconds(0), left));
    if (!came) return std::unexpected(came.error());
    // Whatever came: a board may stop at once each time that it begins.
    if (steady_clock::now() >= deadline) return take_frames(block) ? ReadResult::block : ReadResult::timeout;
  }
  return ReadResult::block;
}

Status ComediDevice::stop() {
  if (!std::exchange(runs_, false)) return {};
  if (!open_.board) return gone();
  comedi_cancel(open_.board.get(), static_cast<unsigned>(open_.inputs));
  return {};
}

Status ComediDevice::reopen() {
  const bool ran = std::exchange(runs_, false);
  const auto name = open_.facts.name;
  {
    const std::scoped_lock in_use(board_in_use_);
    open_.board.reset();
    auto again = open_board(path_);
    runs_ = ran;
    if (!again) return std::unexpected(again.error());
    if (again->facts.name != name)
      return fail(Code::device, fmt::format("{}: is {} now, and was {}", path_, again->facts.name, name));
    open_ = std::move(*again);
  }
  if (!granted_) return {};
  runs_ = false;
  auto granted = configure(wanted_);
  runs_ = ran;
  if (!granted) return std::unexpected(granted.error());
  return ran ? begin_again() : Status();
}

Status ComediDevice::write_analog(int channel, double volts) {
  if (channel < 0 || channel >= open_.facts.analog_outputs)
    return fail(Code::usage, fmt::format("{} has {} analog outputs, from 0; not {}", open_.facts.name,
                                         open_.facts.analog_outputs, channel));
  const std::scoped_lock in_use(board_in_use_);
  if (!open_.board) return gone();
  const auto part = static_cast<unsigned>(open_.outputs), at = static_cast<unsigned>(channel);
  auto* range = comedi_get_range(open_.board.get(), part, at, 0);
  if (range == nullptr) return gone();
  if (!(volts >= range->min && volts <= range->max))
    return fail(Code::usage, fmt::format("{:.6g} V on analog output {}; it has {:.6g} to {:.6g} V", volts,
                                         channel, range->min, range->max));
  const auto code = comedi_from_phys(volts, range, comedi_get_maxdata(open_.board.get(), part, at));
  if (comedi_data_write(open_.board.get(), part, at, 0, AREF_GROUND, code) < 0) return gone();
  return {};
}

Status ComediDevice::write_digital(int line, bool high) {
  if (line < 0 || line >= open_.facts.digital_outputs)
    return fail(Code::usage, fmt::format("{} has {} digital lines, from 0; not {}", open_.facts.name,
                                         open_.facts.digital_outputs, line));
  const std::scoped_lock in_use(board_in_use_);
  if (!open_.board) return gone();
  const auto part = static_cast<unsigned>(open_.lines), at = static_cast<unsigned>(line);
  comedi_dio_config(open_.board.get(), part, at, COMEDI_OUTPUT);
  if (comedi_dio_write(open_.board.get(), part, at, high ? 1 : 0) < 0) return gone();
  return {};
}

}  // namespace

Result<std::unique_ptr<Device>> open_comedi(const std::string& path) {
  auto open = open_board(path);
  if (!open) return std::unexpected(open.error());
  return std::make_unique<ComediDevice>(path, std::move(*open));
}

}  // namespace kinemark::stream
