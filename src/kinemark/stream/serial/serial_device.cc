// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/serial/serial_device.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <mutex>
#include <optional>
#include <utility>

#include "kinemark/core/check.h"
#include "kinemark/stream/internal/frame_anchor.h"
#include "kinemark/stream/serial/rig_plan.h"
#include "kinemark/stream/serial/serial_port.h"

namespace kinemark::stream {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kAnswer(2000);    // longest that a rig takes
constexpr milliseconds kStarting(4000);  // and one whose board starts first
constexpr milliseconds kAskAgain(250);
constexpr std::size_t kMostBytes = 1U << 16;  // of answers; a rig that babbles on is none

std::int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(steady_clock::now().time_since_epoch()).count();
}

milliseconds until(steady_clock::time_point deadline) {
  return std::max(milliseconds(0), std::chrono::ceil<milliseconds>(deadline - steady_clock::now()));
}

/// A port and what it has said outside of frames.
class Conversation {
 public:
  explicit Conversation(SerialPort port) : port_(std::move(port)) {}
  [[nodiscard]] SerialPort& port() { return port_; }

  /// The answer of that kind, or "no"; others are passed over. What came behind it stays in rest().
  Result<RigAnswer> ask(const std::string& line, std::string_view kind, milliseconds patience) {
    port_.discard();
    heard_.clear();
    if (auto s = port_.write(line + "\n"); !s) return std::unexpected(s.error());
    const auto deadline = steady_clock::now() + patience;
    do {
      if (auto found = heard(kind)) return std::move(*found);
      if (auto s = listen(until(deadline)); !s) return std::unexpected(s.error());
    } while (steady_clock::now() < deadline && heard_.size() < kMostBytes);
    if (auto found = heard(kind)) return std::move(*found);
    return fail(Code::device,
                fmt::format("{}: no rig answers; is its firmware on the board, and is it the right line?",
                            port_.path()));
  }

  /// ask(), up to three times: the line may damage what is sent and what is answered. @param undo  said in
  /// between, so that what was done unheard is not done twice; empty: nothing
  Result<RigAnswer> insist(const std::string& line, std::string_view kind, std::string_view undo = {}) {
    auto answer = ask(line, kind, kAnswer);
    for (int again = 0; again < 2 && !answer; ++again) {
      if (!undo.empty() && !ask(std::string(undo), undo, kAnswer)) break;
      answer = ask(line, kind, kAnswer);
    }
    return answer;
  }

  /// Bytes behind the last answer.
  [[nodiscard]] std::string rest() { return std::exchange(heard_, {}); }

 private:
  std::optional<RigAnswer> heard(std::string_view kind) {
    while (auto found = find_answer(heard_)) {
      heard_.erase(0, found->end);
      if (found->kind == kind || found->kind == "no") return found;
    }
    return std::nullopt;
  }

  Status listen(milliseconds timeout) {
    std::array<std::uint8_t, 4096> bytes{};
    const auto got = port_.read(bytes, timeout);
    if (!got) return std::unexpected(got.error());
    heard_.append(reinterpret_cast<const char*>(bytes.data()), *got);
    return {};
  }

  SerialPort port_;
  std::string heard_;
};

/// Open a line and ask what is there, again and again while a board starts.
Result<std::pair<Conversation, SerialRigFacts>> meet(const std::string& path) {
  auto port = SerialPort::open(path);
  if (!port) return std::unexpected(port.error());
  Conversation talk(std::move(*port));
  const auto deadline = steady_clock::now() + kStarting;
  for (;;) {
    // A program that was killed may have left it running; the first line ends what a stranger had begun to
    // write.
    if (auto s = talk.port().write("\nstop\n"); !s) return std::unexpected(s.error());
    const auto answer = talk.ask("?", "rig", kAskAgain);
    if (answer && answer->kind == "rig") {
      const auto facts = serial_facts(*answer);
      if (!facts) return fail_at(path, facts.error());
      talk.port().keep_setting();
      return std::pair(std::move(talk), *facts);
    }
    if (steady_clock::now() >= deadline && !answer) return std::unexpected(answer.error());
    if (steady_clock::now() >= deadline)
      return fail(
          Code::device,
          fmt::format("{}: the rig does not say what it is; pull the plug and put it in again", path));
  }
}

class SerialDevice final : public Device {
 public:
  SerialDevice(Conversation talk, SerialRigFacts facts)
      : path_(talk.port().path()),
        talk_(std::move(talk)),
        facts_(std::move(facts)),
        capabilities_(serial_capabilities(facts_)) {}
  ~SerialDevice() override {
    if (runs_ && talk_) (void)talk_->port().write("stop\n");
  }
  SerialDevice(const SerialDevice&) = delete;
  SerialDevice& operator=(const SerialDevice&) = delete;

  [[nodiscard]] const DeviceCapabilities& capabilities() const override { return capabilities_; }
  Result<GrantedPlan> configure(const ScanPlan& plan) override;
  Status start() override;
  Result<ReadResult> read(Block& block, milliseconds timeout) override;
  Status stop() override;
  Status reopen() override;
  Status write_analog(int channel, double volts) override;
  Status write_digital(int line, bool high) override;

 private:
  Status begin();
  Status go_on();
  bool take_frames(Block& block);
  void put(const SerialFrame& frame, Block& block) const;

  [[nodiscard]] std::unexpected<Error> gone() const {
    return fail(Code::device, fmt::format("{}: the rig is gone; plug it in again", path_));
  }

  std::string path_;
  std::optional<Conversation> talk_;  // nothing while the rig is gone
  std::mutex replacing_;              // held while talk_ is another's; outputs are set by other threads
  SerialRigFacts facts_;
  DeviceCapabilities capabilities_;
  std::optional<GrantedPlan> granted_;
  ScanPlan wanted_;
  std::optional<FrameDecoder> decoder_;
  SerialFrame frame_;
  bool holds_frame_ = false;  // frame_ belongs to the next block
  bool runs_ = false;
  std::int64_t first_number_ = 0;  // of the rig's frame 0 since it last started
  std::int64_t next_number_ = 0;   // of the frame that is expected
  std::int64_t dropped_said_ = 0;  // frames that blocks have told of
  std::int64_t before_ns_ = 0, after_ns_ = 0;
  FrameAnchor anchor_{1.0};
};

Result<GrantedPlan> SerialDevice::configure(const ScanPlan& wanted) {
  const ScanPlan plan = with_names(wanted, capabilities());
  check(!runs_, "a plan is set while the rig stands still");
  if (!talk_) return gone();
  const auto command = plan_command(plan, facts_);
  if (!command) return std::unexpected(command.error());
  const auto answer = talk_->insist(*command, "plan");
  if (!answer) return std::unexpected(answer.error());
  auto granted = granted_plan(plan, *answer, facts_);
  if (!granted) return granted;
  wanted_ = plan;
  granted_ = *granted;
  return granted;
}

Status SerialDevice::begin() {
  if (!talk_) return gone();
  const auto answer = talk_->insist("start", "start", "stop");
  if (!answer) return std::unexpected(answer.error());
  if (answer->kind != "start")
    return fail(Code::device, fmt::format("{}: does not start: {}", path_, answer->text("why")));
  decoder_.emplace(frame_shape(granted_->plan));
  const auto rest = talk_->rest();
  decoder_->push({reinterpret_cast<const std::uint8_t*>(rest.data()), rest.size()});
  before_ns_ = after_ns_ = now_ns();
  dropped_said_ = 0;
  holds_frame_ = false;
  runs_ = true;
  return {};
}

Status SerialDevice::start() {
  check(granted_.has_value() && !runs_, "a rig starts with a plan, and once");
  // It may have come back into the middle of a recording, without the trigger that had begun it.
  if (granted_->plan.trigger != wanted_.trigger)
    if (auto granted = configure(wanted_); !granted) return std::unexpected(granted.error());
  if (auto s = begin(); !s) return s;
  anchor_ = FrameAnchor(granted_->plan.rate_hz);
  if (wanted_.trigger == Trigger::at_once) anchor_.begin(0, after_ns_);
  first_number_ = next_number_ = 0;
  return {};
}

void SerialDevice::put(const SerialFrame& frame, Block& block) const {
  const auto leds = granted_->plan.leds.size(), cameras = granted_->plan.cameras.size();
  const auto lit = static_cast<std::ptrdiff_t>(leds * cameras * 4);
  block.counts.insert(block.counts.end(), frame.counts.begin(), frame.counts.begin() + lit);
  block.dark.insert(block.dark.end(), frame.counts.begin() + lit, frame.counts.end());
  for (std::size_t i = 0; i < leds * cameras; ++i) {
    const auto* four = frame.counts.data() + 4 * i;
    const bool high = *std::max_element(four, four + 4) >= granted_->layout.highest_code;
    block.flags.push_back(high ? data::kCountSaturated : 0);
    block.saturated |= high;
  }
  ++block.frames;
}

/// All frames that follow one another without a gap; false when there is none.
bool SerialDevice::take_frames(Block& block) {
  while (holds_frame_ || decoder_->next(frame_)) {
    holds_frame_ = true;
    const auto number = first_number_ + frame_.number;
    if (block.frames > 0 && number != next_number_) break;
    if (block.frames == 0) {
      block.first_frame = number;
      block.gap = number != next_number_;
    }
    put(frame_, block);
    block.overflow |= frame_.dropped > dropped_said_;
    dropped_said_ = frame_.dropped;
    next_number_ = number + 1;
    holds_frame_ = false;
  }
  if (block.frames == 0) return false;
  block.host_before_ns = before_ns_;
  block.host_after_ns = after_ns_;
  anchor_.came(next_number_, after_ns_);
  return true;
}

Result<ReadResult> SerialDevice::read(Block& block, milliseconds timeout) {
  check(runs_, "frames come from a rig that was started");
  block.counts.clear();
  block.dark.clear();
  block.flags.clear();
  block.frames = 0;
  block.overflow = block.gap = block.saturated = false;
  if (!talk_) return gone();
  const auto deadline = steady_clock::now() + timeout;
  std::array<std::uint8_t, 4096> bytes{};
  while (!take_frames(block)) {
    const auto before = now_ns();
    const auto got = talk_->port().read(bytes, until(deadline));
    if (!got) return std::unexpected(got.error());
    if (*got == 0) {
      if (steady_clock::now() >= deadline) return ReadResult::timeout;
      continue;
    }
    before_ns_ = before;
    after_ns_ = now_ns();
    decoder_->push(std::span(bytes).first(*got));
  }
  return ReadResult::block;
}

Status SerialDevice::stop() {
  if (!runs_) return {};
  runs_ = false;
  if (!talk_) return gone();
  const auto answer = talk_->insist("stop", "stop");
  return answer ? Status() : std::unexpected(answer.error());
}

Status SerialDevice::reopen() {
  {
    const std::scoped_lock replacing(replacing_);
    talk_.reset();  // the old handle is closed before the line is opened again
    auto met = meet(path_);
    if (!met) return std::unexpected(met.error());
    if (met->second.name != facts_.name || met->second.leds != facts_.leds)
      return fail(Code::device,
                  fmt::format("{}: is {} now, and was {}", path_, met->second.name, facts_.name));
    talk_ = std::move(met->first);
  }
  return granted_ ? go_on() : Status();
}

/// With the plan that it had, and, once frames have come, without waiting for the trigger.
Status SerialDevice::go_on() {
  const bool ran = std::exchange(runs_, false);
  const ScanPlan wanted = wanted_;
  ScanPlan plan = wanted;
  if (ran && next_number_ > 0) plan.trigger = Trigger::at_once;
  auto granted = configure(plan);
  wanted_ = wanted;
  runs_ = ran;
  if (!granted) return std::unexpected(granted.error());
  if (!ran) return {};
  if (auto s = begin(); !s) return s;
  if (plan.trigger != Trigger::at_once) return {};
  first_number_ = anchor_.after_break(next_number_, after_ns_);
  anchor_.begin(first_number_, after_ns_);
  return {};
}

Status SerialDevice::write_analog(int channel, double volts) {
  return fail(Code::usage,
              fmt::format("{} has no analog output {} for {:.6g} V", facts_.name, channel, volts));
}

Status SerialDevice::write_digital(int line, bool high) {
  if (line < 0 || line >= facts_.outputs)
    return fail(Code::usage, fmt::format("{} has the digital outputs 0 to {}; not {}", facts_.name,
                                         facts_.outputs - 1, line));
  const std::scoped_lock replacing(replacing_);
  if (!talk_) return gone();
  return talk_->port().write(fmt::format("out {} {}\n", line, high ? 1 : 0));
}

}  // namespace

Result<std::unique_ptr<Device>> open_serial(const std::string& path) {
  auto met = meet(path);
  if (!met) return std::unexpected(met.error());
  return std::make_unique<SerialDevice>(std::move(met->first), std::move(met->second));
}

}  // namespace kinemark::stream
