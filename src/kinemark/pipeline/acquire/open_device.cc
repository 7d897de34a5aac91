// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/acquire/open_device.h"

#include <fmt/core.h>

#include <array>
#include <ranges>
#include <string>
#include <utility>

#include "kinemark/core/utf8.h"
#include "kinemark/pipeline/acquire/replay_device.h"
#include "kinemark/pipeline/acquire/sim_rig.h"
#include "kinemark/pipeline/files/address_settings.h"
#include "kinemark/stream/comedi/comedi_device.h"
#include "kinemark/stream/serial/serial_device.h"

namespace kinemark::pipeline {
namespace {

using Clock = std::shared_ptr<stream::HostClock>;
using Opened = Result<std::unique_ptr<stream::Device>>;

/// A kind of device: its addresses, how one is opened, and those that are there.
struct Kind {
  std::string_view scheme, address;
  Opened (*open)(AddressSettings& settings, std::uint64_t seed, const Clock& clock);
  std::vector<stream::DeviceInfo> (*enumerate)();
};

Opened open_sim(AddressSettings& settings, std::uint64_t seed, const Clock& clock) {
  if (settings.what() == "rig") return open_sim_rig(std::move(settings), seed, clock);
  return fail(Code::usage, fmt::format("{}: is no simulated device that gives counts; there is sim:rig",
                                       printable(settings.uri(), 200)));
}

std::vector<stream::DeviceInfo> find_sim() {
  return {{.uri = "sim:rig", .name = "simulated rig of 1986", .state = ""}};
}

Opened open_replay(AddressSettings& settings, std::uint64_t /*seed*/, const Clock& clock) {
  return ReplayDevice::open(std::move(settings), clock);
}

std::vector<stream::DeviceInfo> find_none() { return {}; }

/// The device behind a path, "/dev/ttyACM0", which takes no settings.
template <Opened (*open)(const std::string&)>
Opened open_path(AddressSettings& settings, std::uint64_t /*seed*/, const Clock& /*clock*/) {
  if (auto s = settings.check(); !s) return std::unexpected(s.error());
  return open(settings.what());
}

std::vector<stream::DeviceInfo> find_serial() { return stream::list_serial(); }
std::vector<stream::DeviceInfo> find_comedi() { return stream::list_comedi(); }

constexpr std::array<Kind, 4> kKinds{
    {{"sim", "sim:rig", open_sim, find_sim},
     {"replay", "replay:FILE.mcap", open_replay, find_none},
     {"comedi", "comedi:/dev/comedi0", open_path<stream::open_comedi>, find_comedi},
     {"serial", "serial:/dev/ttyACM0", open_path<stream::open_serial>, find_serial}}};

}  // namespace

Opened open_device(std::string_view uri, std::uint64_t seed, Clock clock) {
  AddressSettings settings(uri);
  if (clock == nullptr) clock = std::make_shared<stream::SteadyHostClock>();
  std::string addresses;
  for (const auto& kind : kKinds) {
    if (kind.scheme == settings.scheme()) return kind.open(settings, seed, clock);
    addresses += fmt::format("{}{}", addresses.empty() ? "" : ", ", kind.address);
  }
  return fail(Code::usage,
              fmt::format("{}: is the address of no device; those are {}", printable(uri, 200), addresses));
}

std::vector<stream::DeviceInfo> enumerate_devices() {
  std::vector<stream::DeviceInfo> out;
  for (const auto& kind : std::views::reverse(kKinds))
    for (auto& device : kind.enumerate()) out.push_back(std::move(device));
  return out;
}

}  // namespace kinemark::pipeline
