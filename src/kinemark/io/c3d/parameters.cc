// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/c3d/parameters.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <map>

#include "kinemark/core/utf8.h"

namespace kinemark::io {
namespace {

std::string upper(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return out;
}

bool same_name(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, [](unsigned char x, unsigned char y) { return std::toupper(x) == std::toupper(y); });
}

std::string numbered(std::string_view name, int part) {
  return part == 1 ? std::string(name) : fmt::format("{}{}", name, part);
}

/// Walks the entries of a section.
class Parser {
 public:
  Parser(std::span<const std::byte> section, Processor processor, std::vector<std::string>& warnings)
      : section_(section), processor_(processor), warnings_(warnings) {}

  C3dParameters run() {
    std::size_t at = 4;
    while (at + 2 <= section_.size()) {
      const int name_length = static_cast<std::int8_t>(section_[at]);
      const int id = static_cast<std::int8_t>(section_[at + 1]);
      const auto n = static_cast<std::size_t>(std::abs(name_length));
      if (n == 0) break;
      const std::size_t pointer_at = at + 2 + n;
      if (pointer_at + 2 > section_.size()) {
        ends_inside(at);
        break;
      }
      const std::string name = data::foreign_name(text(at + 2, n));
      const std::size_t pointer = load_u16(section_.data() + pointer_at, processor_);
      const std::size_t next = pointer == 0 ? section_.size() : pointer_at + pointer;
      const std::size_t end = std::min(next, section_.size());
      if (next > section_.size()) ends_inside(at);
      const std::size_t body = std::min(pointer_at + 2, end);
      if (id < 0)
        read_group(-id, name, {.name = std::string(text(at + 2, n)), .locked = name_length < 0}, body, end);
      else
        read_parameter(id, name, {.name = std::string(text(at + 2, n)), .locked = name_length < 0}, body,
                       end);
      if (next <= pointer_at) break;
      at = next;
    }
    return collect();
  }

 private:
  struct Entry {
    int id;
    C3dParameter parameter;
  };

  std::string_view text(std::size_t at, std::size_t n) const {
    return {reinterpret_cast<const char*>(section_.data()) + at, n};
  }
  void ends_inside(std::size_t at) {
    warnings_.push_back(
        fmt::format("the parameter section is corrupt: the entry at its byte {} points past its end; what "
                    "follows is left out",
                    at));
  }

  void read_group(int id, const std::string& name, data::ForeignGroup stored, std::size_t at,
                  std::size_t end) {
    C3dGroup& group = groups_[id];
    if (!group.name.empty()) return;
    group.name = name;
    order_.push_back(id);
    stored.description = description(at, end);
    group.description = clean_text(stored.description);
    group.stored = std::move(stored);
  }

  std::string description(std::size_t at, std::size_t end) const {
    if (at >= end) return {};
    const auto n = std::min<std::size_t>(std::to_integer<unsigned>(section_[at]), end - at - 1);
    return std::string(text(at + 1, n));
  }

  /// Numbers in Intel order, texts as they are.
  std::vector<std::byte> in_intel_order(C3dType type, std::span<const std::byte> values) const {
    std::vector<std::byte> out(values.begin(), values.end());
    if (processor_ == Processor::intel) return out;
    for (std::size_t i = 0; type == C3dType::int16 && i + 2 <= out.size(); i += 2)
      store_u16(&out[i], load_u16(&values[i], processor_), Processor::intel);
    for (std::size_t i = 0; type == C3dType::float32 && i + 4 <= out.size(); i += 4)
      store_f32(&out[i], load_f32(&values[i], processor_), Processor::intel);
    return out;
  }

  /// "POINT:LABELS", as far as the group is known yet.
  std::string full_name(int id, const std::string& name) const {
    const auto group = groups_.find(id);
    return group == groups_.end() ? name : group->second.name + ":" + name;
  }

  void read_parameter(int id, const std::string& name, data::ForeignParameter stored, std::size_t at,
                      std::size_t end) {
    if (end < at + 2) return;
    Entry entry{.id = id, .parameter = {.name = name, .locked = stored.locked}};
    C3dParameter& p = entry.parameter;
    const int type = static_cast<std::int8_t>(section_[at]);
    if (type != -1 && type != 1 && type != 2 && type != 4) {
      warnings_.push_back(
          fmt::format("parameter {} has the unknown type {}; need -1, 1, 2 or 4; it is left out",
                      full_name(id, name), type));
      return;
    }
    p.type = static_cast<C3dType>(type);
    const std::size_t dim_count = std::to_integer<unsigned>(section_[at + 1]);
    at += 2;
    if (at + dim_count > end) return;
    std::size_t values = 1;
    const std::size_t limit = end - at;  // more values than bytes are impossible
    for (std::size_t d = 0; d < dim_count; ++d) {
      p.dims.push_back(std::to_integer<int>(section_[at + d]));
      values = std::min(values * static_cast<std::size_t>(p.dims.back()), limit + 1);
    }
    at += dim_count;
    const auto size = static_cast<std::size_t>(std::abs(type));
    const std::size_t there = std::min(values, (end - at) / size);
    if (there < values)
      warnings_.push_back(
          fmt::format("parameter {} is cut short: {} of its values are there", full_name(id, name), there));
    if (p.type == C3dType::text)
      read_texts(p, at, there);
    else
      read_numbers(p, at, there);
    stored.type = static_cast<std::int8_t>(type);
    for (const int d : p.dims) stored.dims.push_back(static_cast<std::uint8_t>(d));
    stored.values = in_intel_order(p.type, section_.subspan(at, there * size));
    stored.description = description(at + there * size, end);
    p.description = clean_text(stored.description);
    if (there == values) p.stored = std::move(stored);
    entries_.push_back(std::move(entry));
  }

  void read_texts(C3dParameter& p, std::size_t at, std::size_t bytes) {
    const std::size_t width = p.dims.empty() ? 1 : static_cast<std::size_t>(p.dims[0]);
    for (std::size_t i = 0; i < bytes; i += width)
      p.texts.push_back(clean_text(text(at + i, std::min(width, bytes - i))));
  }

  void read_numbers(C3dParameter& p, std::size_t at, std::size_t count) {
    p.numbers.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const std::byte* b = section_.data() + at + i * static_cast<std::size_t>(p.type);
      if (p.type == C3dType::byte)
        p.numbers.push_back(std::to_integer<int>(*b));
      else if (p.type == C3dType::int16)
        p.numbers.push_back(static_cast<std::int16_t>(load_u16(b, processor_)));
      else
        p.numbers.push_back(load_f32(b, processor_));
    }
  }

  // A parameter may stand before the group it belongs to, or belong to none.
  C3dParameters collect() {
    for (Entry& entry : entries_) {
      C3dGroup& group = groups_[entry.id];
      if (group.name.empty()) {
        group.name = fmt::format("GROUP {}", entry.id);
        order_.push_back(entry.id);
      }
      group.parameters.push_back(std::move(entry.parameter));
    }
    C3dParameters out;
    for (const int id : order_) out.groups.push_back(std::move(groups_[id]));
    return out;
  }

  std::span<const std::byte> section_;
  Processor processor_;
  std::vector<std::string>& warnings_;
  std::map<int, C3dGroup> groups_;
  std::vector<int> order_;
  std::vector<Entry> entries_;
};

}  // namespace

std::string clean_text(std::string_view raw) { return name_of_bytes(raw); }

C3dParameters parse_parameters(std::span<const std::byte> section, Processor processor,
                               std::vector<std::string>& warnings) {
  return Parser(section, processor, warnings).run();
}

const C3dParameter* C3dParameters::find(std::string_view group, std::string_view name) const {
  for (const C3dGroup& g : groups) {
    if (!same_name(g.name, group)) continue;
    for (const C3dParameter& p : g.parameters)
      if (same_name(p.name, name)) return &p;
  }
  return nullptr;
}

bool C3dParameters::has_group(std::string_view group) const {
  return std::ranges::any_of(groups, [&](const C3dGroup& g) { return same_name(g.name, group); });
}

std::optional<double> C3dParameters::number(std::string_view group, std::string_view name) const {
  const C3dParameter* p = find(group, name);
  if (p == nullptr || p->numbers.empty()) return std::nullopt;
  return p->numbers.front();
}

std::string C3dParameters::text(std::string_view group, std::string_view name) const {
  const C3dParameter* p = find(group, name);
  return p == nullptr || p->texts.empty() ? std::string() : p->texts.front();
}

std::vector<double> C3dParameters::numbers(std::string_view group, std::string_view name) const {
  std::vector<double> out;
  for (int part = 1;; ++part) {
    const C3dParameter* p = find(group, numbered(name, part));
    if (p == nullptr) return out;
    out.insert(out.end(), p->numbers.begin(), p->numbers.end());
  }
}

std::vector<std::string> C3dParameters::texts(std::string_view group, std::string_view name) const {
  std::vector<std::string> out;
  for (int part = 1;; ++part) {
    const C3dParameter* p = find(group, numbered(name, part));
    if (p == nullptr) return out;
    out.insert(out.end(), p->texts.begin(), p->texts.end());
  }
}

C3dGroup& C3dParameters::group(std::string_view name) {
  for (C3dGroup& g : groups)
    if (same_name(g.name, name)) return g;
  return groups.emplace_back(C3dGroup{.name = upper(name)});
}

}  // namespace kinemark::io
