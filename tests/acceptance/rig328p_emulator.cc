// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// The ATmega328P of firmware/rig328p in simavr. Its serial line is a pseudo-terminal; its analog inputs carry
// the voltages of a recording of counts: those of the LED that its pins light, of the electrode that its
// multiplexer selects.
//
//   rig328p_emulator FIRMWARE.elf COUNTS.mcap LINK [--real-time] [--spoil SEED]
//
// LINK is made, a symbolic link to the line. --real-time: no faster than the clock, and what the host does
// not take is lost, as at a USB bridge; else nothing is lost and time waits. --spoil: 3 of 1,000 bytes to the
// host are left out, 3 doubled, 3 swapped. On stdin: "unplug" (the line vanishes, the chip loses its power),
// "plug", "trigger" (D11 rises), "end" (prints what the pins did as JSON, and ends); each is answered by
// "ok".
#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <simavr/avr_adc.h>
#include <simavr/avr_ioport.h>
#include <simavr/avr_timer.h>
#include <simavr/avr_uart.h>
#include <simavr/sim_avr.h>
#include <simavr/sim_elf.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "kinemark/core/random.h"
#include "kinemark/io/recording/counts_recording.h"

namespace {

using kinemark::data::Counts;
namespace fs = std::filesystem;

constexpr double kClockHz = 16e6;
constexpr std::uint32_t kSupplyMv = 5000;
constexpr avr_cycle_count_t kLookEvery = 1600;  // 0.1 ms
constexpr std::size_t kBridgeBytes = 4096;      // that a USB bridge keeps while nobody asks for them
// Pins of LED 1 to 8: port and bit.
constexpr std::array<std::pair<char, int>, 8> kLedPins{
    {{'D', 2}, {'D', 3}, {'D', 4}, {'D', 5}, {'D', 7}, {'B', 0}, {'B', 1}, {'B', 2}}};

/// Millivolts that convert to a code.
std::uint32_t millivolts(int code) { return (static_cast<std::uint32_t>(code) * kSupplyMv + 1022) / 1023; }

/// The pseudo-terminal, with its faults.
class Line {
 public:
  Line(fs::path link, bool real_time, std::uint64_t spoil)
      : link_(std::move(link)), real_time_(real_time), spoils_(spoil != 0), random_(spoil, 0) {
    plug();
  }
  ~Line() { unplug(); }
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  void plug() {
    master_ = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
    if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0) std::exit(1);
    termios line{};
    tcgetattr(master_, &line);
    cfmakeraw(&line);
    tcsetattr(master_, TCSANOW, &line);
    fs::remove(link_);
    fs::create_symlink(ptsname(master_), link_);
  }
  void unplug() {
    if (master_ < 0) return;
    close(master_);
    master_ = -1;
    fs::remove(link_);
  }
  void put(std::uint8_t byte) {
    if (room_ == 0) return;
    if (room_ != kAll) --room_;
    const double dice = spoils_ ? random_.uniform() : 0.5;
    if (dice < 0.003) return;
    waiting_.push_back(byte);
    if (dice < 0.006) waiting_.push_back(byte);
    if (dice > 0.997 && waiting_.size() > 1) std::swap(waiting_.back(), waiting_[waiting_.size() - 2]);
  }
  /// Bring bytes to the host; time waits while it takes none, unless it is real.
  /// Of the bytes to come only so many reach the host, until all() is called.
  void only(std::size_t room) { room_ = room; }
  void all() { room_ = kAll; }
  void flush() {
    std::size_t at = 0;
    while (at < waiting_.size() && master_ >= 0) {
      const auto sent = write(master_, waiting_.data() + at, waiting_.size() - at);
      if (sent > 0)
        at += static_cast<std::size_t>(sent);
      else if (real_time_)
        break;
      else if (!is_taken())
        return keep_from(at);
    }
    waiting_.clear();
  }
  std::string read_some() const {
    std::array<char, 256> bytes{};
    const auto got = master_ < 0 ? 0 : read(master_, bytes.data(), bytes.size());
    return got > 0 ? std::string(bytes.data(), static_cast<std::size_t>(got)) : std::string();
  }
  [[nodiscard]] bool full() const { return !waiting_.empty(); }

 private:
  [[nodiscard]] bool is_taken() const {
    pollfd one{master_, POLLOUT, 0};
    return poll(&one, 1, 2) > 0 && (one.revents & POLLOUT) != 0;
  }
  void keep_from(std::size_t at) {
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(at));
  }
  fs::path link_;
  bool real_time_, spoils_;
  kinemark::Random random_;
  static constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  std::size_t room_ = kAll;
  int master_ = -1;
  std::vector<std::uint8_t> waiting_;
};

class Emulator {
 public:
  Emulator(const char* elf, Counts counts, Line& line) : counts_(std::move(counts)), line_(line) {
    if (elf_read_firmware(elf, &firmware_) != 0) std::exit(1);
    avr_ = avr_make_mcu_by_name("atmega328p");
    avr_init(avr_);
    avr_->log = LOG_NONE;
    firmware_.frequency = static_cast<std::uint32_t>(kClockHz);
    avr_load_firmware(avr_, &firmware_);
    avr_->vcc = avr_->avcc = avr_->aref = kSupplyMv;
    avr_->sleep = [](avr_t*, avr_cycle_count_t) {};
    connect();
  }
  void connect() {
    std::uint32_t flags = 0;
    avr_ioctl(avr_, AVR_IOCTL_UART_SET_FLAGS('0'), &flags);
    listen(AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUTPUT,
           [](Emulator& e, std::uint32_t v) { e.line_.put(static_cast<std::uint8_t>(v)); });
    listen(AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUT_XON, [](Emulator& e, std::uint32_t) { e.open_ = true; });
    listen(AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_OUT_XOFF,
           [](Emulator& e, std::uint32_t) { e.open_ = false; });
    listen(AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_OUT_TRIGGER, [](Emulator& e, std::uint32_t v) { e.convert(v); });
    listen(AVR_IOCTL_TIMER_GETIRQ('0'), TIMER_IRQ_OUT_PWM0,
           [](Emulator& e, std::uint32_t v) { e.level_ = v; });
    for (int l = 0; l < 8; ++l) {
      auto* irq = avr_io_getirq(avr_, AVR_IOCTL_IOPORT_GETIRQ(kLedPins[static_cast<std::size_t>(l)].first),
                                kLedPins[static_cast<std::size_t>(l)].second);
      pins_[static_cast<std::size_t>(l)] = {this, l};
      avr_irq_register_notify(
          irq,
          [](avr_irq_t*, std::uint32_t v, void* p) {
            static_cast<Pin*>(p)->of->light(static_cast<Pin*>(p)->led, v != 0);
          },
          &pins_[static_cast<std::size_t>(l)]);
    }
  }
  void run_for(avr_cycle_count_t cycles) {
    const auto end = avr_->cycle + cycles;
    while (avr_->cycle < end) {
      const int state = avr_run(avr_);
      if (state == cpu_Done || state == cpu_Crashed) std::exit(2);
    }
  }
  void hear(const std::string& text) {
    heard_.insert(heard_.end(), text.begin(), text.end());
    auto* input = avr_io_getirq(avr_, AVR_IOCTL_UART_GETIRQ('0'), UART_IRQ_INPUT);
    while (open_ && !heard_.empty()) {
      avr_raise_irq(input, static_cast<std::uint8_t>(heard_.front()));
      heard_.pop_front();
    }
  }
  void reset() {
    avr_reset(avr_);
    heard_.clear();
    open_ = true;
    led_ = -1;
  }
  void trigger(bool high) {
    avr_raise_irq(avr_io_getirq(avr_, AVR_IOCTL_IOPORT_GETIRQ('B'), 3), high ? 1 : 0);
  }
  [[nodiscard]] double seconds() const { return static_cast<double>(avr_->cycle) / kClockHz; }
  void report() const {
    fmt::print("{{\"frames\": {}, \"seconds\": {:.6f}, \"levels\": {{", frame_ + 1, seconds());
    bool first = true;
    for (const auto& [led, level] : levels_)
      fmt::print("{}\"{}\": {}", std::exchange(first, false) ? "" : ", ", led, level);
    fmt::print("}}, \"conversions\": [");
    first = true;
    for (const auto& [where, at] : times_)
      fmt::print("{}[{}, {}, {:.9f}, {:.9f}]", std::exchange(first, false) ? "" : ", ", where.first,
                 where.second, static_cast<double>(at.first) / kClockHz,
                 static_cast<double>(at.second) / kClockHz);
    fmt::print("], \"two_lit\": {}}}\n", two_lit_);
  }

 private:
  struct Pin {
    Emulator* of = nullptr;
    int led = 0;
  };
  using Heard = void (*)(Emulator&, std::uint32_t);
  struct Listener {
    Emulator* of;
    Heard heard;
  };
  void listen(std::uint32_t of, int irq, Heard heard) {
    listeners_.push_back({this, heard});
    avr_irq_register_notify(
        avr_io_getirq(avr_, of, irq),
        [](avr_irq_t*, std::uint32_t v, void* p) {
          const auto& one = *static_cast<Listener*>(p);
          one.heard(*one.of, v);
        },
        &listeners_.back());
  }
  void light(int led, bool on) {
    if (!on) {
      if (led_ == led) led_ = -1;
      return;
    }
    two_lit_ += led_ >= 0 && led_ != led;
    led_ = last_led_ = led;
    levels_[led] = level_;
    if (led != 0) return;
    ++frame_;
    frame_began_ = avr_->cycle;
  }
  void convert(std::uint32_t packed) {
    const union {
      std::uint32_t whole;
      avr_adc_mux_t mux;
    } what{packed};
    if (what.mux.kind != ADC_MUX_SINGLE || what.mux.src > 7 || frame_ < 0) return;
    const auto channel = static_cast<int>(what.mux.src);
    const auto f = frame_ % counts_.frames();
    const auto leds = static_cast<int>(counts_.led_count());
    const bool dark = led_ < 0;
    int code = 0;
    if (!dark && led_ < leds) code = static_cast<int>(counts_.at(f, led_, channel / 4)[channel % 4]);
    if (dark && counts_.has_dark_slot())
      code = static_cast<int>(counts_.dark_at(f, channel / 4)[channel % 4]);
    avr_raise_irq(avr_io_getirq(avr_, AVR_IOCTL_ADC_GETIRQ, ADC_IRQ_ADC0 + channel), millivolts(code));
    const auto since = avr_->cycle - frame_began_;
    auto [at, fresh] = times_.try_emplace({dark ? last_led_ + 1 : led_, channel}, since, since);
    at->second.first = std::min(at->second.first, since);
    at->second.second = std::max(at->second.second, since);
  }

  Counts counts_;
  Line& line_;
  avr_t* avr_ = nullptr;
  elf_firmware_t firmware_{};
  std::deque<Listener> listeners_;
  std::array<Pin, 8> pins_;
  std::deque<char> heard_;
  bool open_ = true;
  int led_ = -1, last_led_ = -1, two_lit_ = 0;
  std::uint32_t level_ = 0;
  std::int64_t frame_ = -1;
  avr_cycle_count_t frame_began_ = 0;
  std::map<int, std::uint32_t> levels_;
  std::map<std::pair<int, int>, std::pair<avr_cycle_count_t, avr_cycle_count_t>> times_;
};

/// Lines of stdin that are there; "end" when it is closed.
std::vector<std::string> orders() {
  static std::string heard;
  pollfd one{0, POLLIN, 0};
  if (poll(&one, 1, 0) <= 0) return {};
  std::array<char, 256> bytes{};
  const auto got = read(0, bytes.data(), bytes.size());
  if (got <= 0) return {"end"};
  heard.append(bytes.data(), static_cast<std::size_t>(got));
  std::vector<std::string> out;
  for (auto end = heard.find('\n'); end != std::string::npos; end = heard.find('\n')) {
    out.push_back(heard.substr(0, end));
    heard.erase(0, end + 1);
  }
  return out;
}

/// Whether to go on.
bool obey(const std::string& order, Emulator& emulator, Line& line) {
  if (order == "end") {
    emulator.report();
    return false;
  }
  if (order == "unplug") {
    line.unplug();
    emulator.reset();
  } else if (order == "plug") {
    line.plug();
  } else if (order == "trigger") {
    emulator.trigger(true);
  } else if (order.starts_with("ahead ")) {
    line.only(kBridgeBytes);
    for (const double end = emulator.seconds() + std::stod(order.substr(6)); emulator.seconds() < end;) {
      emulator.run_for(kLookEvery);
      line.flush();
    }
    line.all();
  }
  fmt::print("ok\n");
  std::fflush(stdout);
  return true;
}

}  // namespace

int main(int count, char** words) {
  bool real_time = false;
  std::uint64_t spoil = 0;
  for (int i = 4; i < count; ++i) {
    const std::string word = words[i];
    if (word == "--real-time") real_time = true;
    if (word == "--spoil" && i + 1 < count) spoil = std::stoull(words[i + 1]);
  }
  const auto recording = kinemark::io::read_counts(words[2]);
  if (!recording) return fmt::print(stderr, "{}\n", recording.error().message), 1;
  Line line(words[3], real_time, spoil);
  Emulator emulator(words[1], recording->counts, line);
  emulator.trigger(false);
  fmt::print("ready\n");
  std::fflush(stdout);
  const auto began = std::chrono::steady_clock::now();
  for (;;) {
    for (const auto& order : orders())
      if (!obey(order, emulator, line)) return 0;
    emulator.hear(line.read_some());
    emulator.run_for(kLookEvery);
    line.flush();
    while (!real_time && line.full()) {
      for (const auto& order : orders())
        if (!obey(order, emulator, line)) return 0;
      emulator.hear(line.read_some());
      line.flush();
    }
    const auto ahead =
        began + std::chrono::duration<double>(emulator.seconds()) - std::chrono::steady_clock::now();
    if (real_time && ahead > std::chrono::milliseconds(1))
      poll(nullptr, 0,
           static_cast<int>(std::chrono::duration_cast<std::chrono::milliseconds>(ahead).count()));
  }
}
