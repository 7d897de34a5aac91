// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/stream/serial/testing/pty_rig.h"

#include <fcntl.h>
#include <fmt/core.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "kinemark/stream/serial/rig_answer.h"

namespace kinemark::stream::testing {

PtyRig::PtyRig(std::filesystem::path link) : link_(std::move(link)) { plug_in(); }

PtyRig::~PtyRig() { unplug(); }

void PtyRig::plug_in() {
  master_ = posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC);
  if (master_ < 0 || grantpt(master_) != 0 || unlockpt(master_) != 0 || pipe2(wake_, O_CLOEXEC) != 0)
    throw std::runtime_error("no pseudo-terminal");
  termios line{};
  tcgetattr(master_, &line);
  cfmakeraw(&line);
  tcsetattr(master_, TCSANOW, &line);
  std::array<char, 64> name{};
  ptsname_r(master_, name.data(), name.size());
  std::filesystem::remove(link_);
  std::filesystem::create_symlink(name.data(), link_);
  thread_ = std::thread([this] { listen(); });
}

void PtyRig::unplug() {
  if (master_ < 0) return;
  (void)!write(wake_[1], "x", 1);
  thread_.join();
  for (const int fd : {master_, wake_[0], wake_[1]}) close(fd);
  master_ = -1;
  std::filesystem::remove(link_);
}

void PtyRig::send(const Bytes& bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const auto sent = write(master_, bytes.data() + at, bytes.size() - at);
    if (sent < 0) throw std::runtime_error("the line is gone");
    at += static_cast<std::size_t>(sent);
  }
}

void PtyRig::send_frames(std::uint32_t first, std::uint32_t count, std::uint32_t dropped) {
  for (std::uint32_t i = first; i < first + count; ++i) send(telling_frame(slots_, 2, i, dropped));
}

void PtyRig::wait_for(const std::string& command, int times) {
  std::unique_lock lock(mutex_);
  obeyed_.wait(lock, [&] {
    return std::ranges::count_if(commands_, [&](const auto& c) { return c.starts_with(command); }) >= times;
  });
}

std::string PtyRig::obey(const std::string& line) {
  std::istringstream words(line);
  std::string verb;
  words >> verb;
  if (verb == "?") return facts;
  if (verb == "stop") return "stop frames=0 dropped=0";
  if (verb != "plan") return verb == "start" || verb == "out" ? verb : "no why=command";
  long leds = 0, dark = 0, period = 0, settle = 0, conversion = 0, off = 0, trigger = 0;
  words >> leds >> dark >> period >> settle >> conversion >> off >> trigger;
  conversion = std::max(conversion, 128L);
  const long least = (leds + dark) * (settle + 8 * conversion + off);
  if (period == 0) period = least;
  if (period < least || period > 2'000'000) return fmt::format("no why=period least={} most=2000000", least);
  std::string level;
  for (long l = 0, value = 0; l < leds; ++l)
    level += fmt::format("{}{}", l > 0 ? "," : "", words >> value ? value : 255);
  slots_ = static_cast<int>(leds + dark);
  return fmt::format("plan leds={} dark={} period={} settle={} conversion={} off={} trigger={} level={}",
                     leds, dark, period, settle, conversion, off, trigger, level);
}

void PtyRig::listen() {
  std::string heard;
  for (;;) {
    std::array<pollfd, 2> waits{pollfd{master_, POLLIN, 0}, pollfd{wake_[0], POLLIN, 0}};
    poll(waits.data(), waits.size(), -1);
    if (waits[1].revents != 0) return;
    std::array<char, 256> bytes{};
    const auto got = read(master_, bytes.data(), bytes.size());
    if (got <= 0) {
      // Nobody has it open: look again soon, or end.
      poll(&waits[1], 1, 2);
      continue;
    }
    heard.append(bytes.data(), static_cast<std::size_t>(got));
    for (auto end = heard.find('\n'); end != std::string::npos; end = heard.find('\n')) {
      const std::string line = heard.substr(0, end);
      heard.erase(0, end + 1);
      if (line.empty()) continue;
      const std::scoped_lock lock(mutex_);
      const std::string said = obey(line);
      if (!said.empty()) {
        const std::string answer = checked_line(said);
        send(Bytes(answer.begin(), answer.end()));
      }
      commands_.push_back(line);
      obeyed_.notify_all();
    }
  }
}

}  // namespace kinemark::stream::testing
