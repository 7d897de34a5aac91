// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/pickled.h"

#include <fmt/core.h>

#include <charconv>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace kinemark::io::internal {
namespace {

constexpr std::size_t kMostTexts = 100'000;

/// What stands on the stack: a mark, a text, a tuple of texts, or the list of them.
struct Item {
  enum class Kind : std::uint8_t { mark, text, tuple, list } kind = Kind::mark;
  std::string text;
  std::vector<std::string> tuple;
};

/// One code point in UTF-8; surrogates and what is no code point as the mark of replacement.
void append_utf8(std::uint32_t code, std::string& out) {
  if (code > 0x10FFFF || (code >= 0xD800 && code < 0xE000)) code = 0xFFFD;
  const auto byte = [&](std::uint32_t bits) { out.push_back(static_cast<char>(bits)); };
  const auto tail = [&](unsigned shift) { byte(0x80U | ((code >> shift) & 0x3FU)); };
  if (code < 0x80) return byte(code);
  if (code < 0x800) {
    byte(0xC0U | (code >> 6U));
  } else if (code < 0x10000) {
    byte(0xE0U | (code >> 12U));
    tail(6);
  } else {
    byte(0xF0U | (code >> 18U));
    tail(12);
    tail(6);
  }
  tail(0);
}

/// Text of `V`: Latin-1 with \uXXXX and \UXXXXXXXX for the rest.
std::optional<std::string> unescape(std::string_view line) {
  std::string out;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const bool escape = line[i] == '\\' && i + 1 < line.size() && (line[i + 1] == 'u' || line[i + 1] == 'U');
    if (!escape) {
      append_utf8(static_cast<unsigned char>(line[i]), out);
      continue;
    }
    const std::size_t digits = line[i + 1] == 'u' ? 4 : 8;
    const std::string_view hex = line.substr(i + 2, digits);
    std::uint32_t code = 0;
    const auto [end, error] = std::from_chars(hex.data(), hex.data() + hex.size(), code, 16);
    if (hex.size() != digits || error != std::errc() || end != hex.data() + hex.size()) return std::nullopt;
    append_utf8(code, out);
    i += 1 + digits;
  }
  return out;
}

class Unpickler {
 public:
  explicit Unpickler(std::string_view pickle) : left_(pickle) {}

  /// The labels, or nothing where something else is pickled.
  std::optional<std::vector<std::vector<std::string>>> run() {
    bool ended = false;
    while (!ended && !left_.empty()) {
      const char code = left_.front();
      left_.remove_prefix(1);
      ended = code == '.';
      if (!ended && !step(code)) return std::nullopt;
    }
    if (!ended || stack_.size() != 1 || stack_.front().kind != Item::Kind::list) return std::nullopt;
    return std::move(labels_);
  }

 private:
  bool step(char code) {
    switch (code) {
      case '(':
        return push({});
      case 'V':
        return push_text();
      case 'l':
        return make_list();
      case 't':
        return make_tuple();
      case 'p':
        return remember();
      case 'g':
        return recall();
      case 'a':
        return append();
      default:
        return false;
    }
  }

  std::optional<std::string_view> line() {
    const auto end = left_.find('\n');
    if (end == std::string_view::npos) return std::nullopt;
    const auto out = left_.substr(0, end);
    left_.remove_prefix(end + 1);
    return out;
  }
  std::optional<int> number() {
    const auto digits = line();
    if (!digits) return std::nullopt;
    int out = 0;
    const char* const begin = std::to_address(digits->begin());
    const char* const end = std::to_address(digits->end());
    const auto read = std::from_chars(begin, end, out);
    return read.ec == std::errc() && read.ptr == end ? std::optional(out) : std::nullopt;
  }
  bool push(Item item) {
    texts_ += item.kind == Item::Kind::tuple ? item.tuple.size() : 1;
    if (texts_ > kMostTexts) return false;
    stack_.push_back(std::move(item));
    return true;
  }
  bool push_text() {
    const auto escaped = line();
    auto text = escaped ? unescape(*escaped) : std::nullopt;
    return text && push({.kind = Item::Kind::text, .text = std::move(*text)});
  }
  /// The only list, empty: its members are appended.
  bool make_list() {
    if (stack_.size() != 1 || stack_.back().kind != Item::Kind::mark) return false;
    stack_.back().kind = Item::Kind::list;
    return true;
  }
  bool make_tuple() {
    std::size_t mark = stack_.size();
    while (mark > 0 && stack_[mark - 1].kind == Item::Kind::text) --mark;
    if (mark == 0 || stack_[mark - 1].kind != Item::Kind::mark) return false;
    Item tuple{.kind = Item::Kind::tuple};
    for (std::size_t i = mark; i < stack_.size(); ++i) tuple.tuple.push_back(std::move(stack_[i].text));
    stack_.resize(mark - 1);
    return push(std::move(tuple));
  }
  bool remember() {
    const auto at = number();
    if (!at || stack_.empty()) return false;
    if (stack_.back().kind == Item::Kind::text || stack_.back().kind == Item::Kind::tuple)
      memory_.insert_or_assign(*at, stack_.back());
    return true;
  }
  bool recall() {
    const auto at = number();
    const auto found = at ? memory_.find(*at) : memory_.end();
    return found != memory_.end() && push(found->second);
  }
  bool append() {
    if (stack_.size() != 2 || stack_.front().kind != Item::Kind::list ||
        stack_.back().kind != Item::Kind::tuple)
      return false;
    labels_.push_back(std::move(stack_.back().tuple));
    stack_.pop_back();
    return true;
  }

  std::string_view left_;
  std::vector<Item> stack_;
  std::map<int, Item> memory_;
  std::vector<std::vector<std::string>> labels_;
  std::size_t texts_ = 0;
};

}  // namespace

Result<std::vector<std::vector<std::string>>> parse_pickled_labels(std::string_view pickle) {
  auto labels = Unpickler(pickle).run();
  if (!labels)
    return fail(Code::bad_input,
                "the labels of its columns are not a pickled list of names, as pandas writes them");
  return std::move(*labels);
}

}  // namespace kinemark::io::internal
