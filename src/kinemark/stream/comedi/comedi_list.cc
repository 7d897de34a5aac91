// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <unistd.h>

#include <algorithm>
#include <cerrno>

#include "kinemark/stream/comedi/comedi_device.h"
#include "kinemark/stream/internal/device_file.h"

namespace kinemark::stream {
namespace {

/// "comedi0"; "comedi0_subd1" is a part of one.
bool is_board(const std::string& name) {
  const std::string_view begin = "comedi";
  return name.starts_with(begin) && name.size() > begin.size() &&
         name.find_first_not_of("0123456789", begin.size()) == std::string::npos;
}

}  // namespace

std::vector<DeviceInfo> list_comedi(const std::filesystem::path& devices) {
  std::vector<DeviceInfo> out;
  std::error_code ignored;
  for (std::filesystem::directory_iterator at(devices, ignored), end; !ignored && at != end;
       at.increment(ignored)) {
    const auto name = at->path().filename().string();
    if (!is_board(name)) continue;
    const auto path = at->path().string();
    const bool can = access(path.c_str(), R_OK | W_OK) == 0;
    out.push_back({.uri = "comedi:" + path, .name = name, .state = can ? "" : cannot_open(path, errno)});
  }
  std::ranges::sort(out, {}, &DeviceInfo::uri);
  return out;
}

}  // namespace kinemark::stream
