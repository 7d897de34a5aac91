// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "kinemark/core/check.h"
#include "kinemark/io/c3d/parameters.h"

namespace kinemark::io {
namespace {

constexpr std::size_t kBlock = 512;

class Encoder {
 public:
  explicit Encoder(Processor processor) : processor_(processor) {}

  void head(int length, int id, std::string_view name) {
    put(length);
    put(id);
    put(name);
  }
  void put(int byte) { bytes.push_back(static_cast<std::byte>(byte & 0xFF)); }
  void put(std::string_view text) {
    for (const char c : text) put(static_cast<unsigned char>(c));
  }
  void description(std::string_view text) {
    text = text.substr(0, 255);
    put(static_cast<int>(text.size()));
    put(text);
  }
  /// Room for the pointer to the next entry; returns where it is.
  std::size_t open_entry() {
    bytes.resize(bytes.size() + 2);
    return bytes.size() - 2;
  }
  void close_entry(std::size_t pointer_at) {
    const std::size_t distance = bytes.size() - pointer_at;
    check(distance <= 32767, "a C3D parameter may not be longer than 32767 bytes");
    store_u16(bytes.data() + pointer_at, static_cast<std::uint16_t>(distance), processor_);
  }

  void values(const C3dParameter& p) {
    const std::size_t count =
        std::accumulate(p.dims.begin(), p.dims.end(), std::size_t{1},
                        [](std::size_t product, int d) { return product * static_cast<std::size_t>(d); });
    put(static_cast<int>(p.type));
    put(static_cast<int>(p.dims.size()));
    for (const int d : p.dims) {
      check(d >= 0 && d <= 255, "a C3D dimension lies in 0 to 255");
      put(d);
    }
    if (p.type == C3dType::text) {
      const std::size_t width = p.dims.empty() ? 1 : static_cast<std::size_t>(p.dims[0]);
      check(p.texts.size() * width == count, "a C3D text parameter's dims must fit its texts");
      for (std::string text : p.texts) {
        text.resize(width, ' ');
        put(text);
      }
      return;
    }
    check(p.numbers.size() == count, "a C3D parameter's dims must fit its numbers");
    for (const double v : p.numbers) number(p.type, v);
  }

  void stored(const data::ForeignParameter& p) {
    put(p.type);
    put(static_cast<int>(p.dims.size()));
    for (const std::uint8_t d : p.dims) put(d);
    const std::size_t at = bytes.size();
    bytes.insert(bytes.end(), p.values.begin(), p.values.end());
    if (processor_ == Processor::intel) return;
    for (std::size_t i = 0; p.type == 2 && i < p.values.size(); i += 2)
      store_u16(&bytes[at + i], load_u16(&p.values[i], Processor::intel), processor_);
    for (std::size_t i = 0; p.type == 4 && i < p.values.size(); i += 4)
      store_f32(&bytes[at + i], load_f32(&p.values[i], Processor::intel), processor_);
  }

  std::vector<std::byte> bytes;

 private:
  void number(C3dType type, double v) {
    if (type == C3dType::byte) {
      put(static_cast<int>(v));
    } else if (type == C3dType::int16) {
      check(v >= -32768.0 && v <= 65535.0, "a C3D integer lies in -32768 to 65535");
      bytes.resize(bytes.size() + 2);
      store_u16(bytes.data() + bytes.size() - 2, static_cast<std::uint16_t>(std::lround(v)), processor_);
    } else {
      bytes.resize(bytes.size() + 4);
      store_f32(bytes.data() + bytes.size() - 4, static_cast<float>(v), processor_);
    }
  }

  Processor processor_;
};

std::size_t open_stored(Encoder& e, const std::string& name, bool locked, int signed_id) {
  const int length = static_cast<int>(name.size());
  e.head(locked ? -length : length, signed_id, name);
  return e.open_entry();
}

void put_foreign(Encoder& e, int id, const data::ForeignParameter& p) {
  const std::size_t pointer = open_stored(e, p.name, p.locked, id);
  e.stored(p);
  e.description(p.description);
  e.close_entry(pointer);
}

void put_foreign(Encoder& e, int id, const data::ForeignGroup& group) {
  const std::size_t pointer = open_stored(e, group.name, group.locked, -id);
  e.description(group.description);
  e.close_entry(pointer);
  for (const data::ForeignParameter& p : group.parameters) put_foreign(e, id, p);
}

/// What is carried of a group that is written anew, where it is not written too.
void put_rest(Encoder& e, int id, const C3dGroup& group, std::span<const data::ForeignGroup> foreign) {
  for (const data::ForeignGroup& carried : foreign) {
    if (data::foreign_name(carried.name) != group.name) continue;
    for (const data::ForeignParameter& p : carried.parameters)
      if (std::ranges::find(group.parameters, data::foreign_name(p.name), &C3dParameter::name) ==
          group.parameters.end())
        put_foreign(e, id, p);
  }
}

}  // namespace

Result<std::vector<std::byte>> encode_parameters(const C3dParameters& parameters, Processor processor,
                                                 std::span<const data::ForeignGroup> foreign) {
  check(parameters.groups.size() + foreign.size() <= 127, "a C3D file has at most 127 groups");
  Encoder e(processor);
  for (const int byte : {1, 80, 0, static_cast<int>(processor)}) e.put(byte);
  int id = 0;
  for (const C3dGroup& group : parameters.groups) {
    ++id;
    e.head(static_cast<int>(group.name.size()), -id, group.name);
    const std::size_t pointer = e.open_entry();
    e.description(group.description);
    e.close_entry(pointer);
    for (const C3dParameter& p : group.parameters) {
      const int length = static_cast<int>(p.name.size());
      e.head(p.locked ? -length : length, id, p.name);
      const std::size_t parameter_pointer = e.open_entry();
      e.values(p);
      e.description(p.description);
      e.close_entry(parameter_pointer);
    }
    put_rest(e, id, group, foreign);
  }
  for (const data::ForeignGroup& group : foreign)
    if (std::ranges::find(parameters.groups, data::foreign_name(group.name), &C3dGroup::name) ==
        parameters.groups.end())
      put_foreign(e, ++id, group);
  e.put(0);
  e.put(0);
  const std::size_t blocks = (e.bytes.size() + kBlock - 1) / kBlock;
  if (blocks > 255)
    return fail(Code::not_supported,
                fmt::format("labels and parameters need {} blocks; a C3D file has room for 255", blocks));
  e.bytes.resize(blocks * kBlock);
  e.bytes[2] = static_cast<std::byte>(blocks);
  return std::move(e.bytes);
}

}  // namespace kinemark::io
