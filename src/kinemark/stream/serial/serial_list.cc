// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <set>

#include "kinemark/stream/internal/device_file.h"
#include "kinemark/stream/serial/serial_device.h"

namespace kinemark::stream {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> sorted_files(const fs::path& folder) {
  std::vector<fs::path> out;
  std::error_code ignored;
  for (fs::directory_iterator at(folder, ignored), end; !ignored && at != end; at.increment(ignored))
    out.push_back(at->path());
  std::ranges::sort(out);
  return out;
}

DeviceInfo describe(const fs::path& path) {
  DeviceInfo out{.uri = "serial:" + path.string(), .name = path.filename().string(), .state = ""};
  if (access(path.c_str(), R_OK | W_OK) != 0)
    out.state = cannot_open(path.string(), errno);
  else if (const auto holder = who_has(path.string()); holder != "another program")
    out.state = path.string() + ": " + holder + " has it; end that first";
  return out;
}

bool is_usb_line(const fs::path& path) {
  const auto name = path.filename().string();
  return name.starts_with("ttyACM") || name.starts_with("ttyUSB");
}

}  // namespace

std::vector<DeviceInfo> list_serial(const fs::path& devices) {
  std::vector<DeviceInfo> out;
  std::set<fs::path> named;
  std::error_code ignored;
  for (const auto& path : sorted_files(devices / "serial" / "by-id")) {
    named.insert(fs::canonical(path, ignored));
    out.push_back(describe(path));
  }
  for (const auto& path : sorted_files(devices))
    if (is_usb_line(path) && !named.contains(fs::canonical(path, ignored))) out.push_back(describe(path));
  return out;
}

}  // namespace kinemark::stream
