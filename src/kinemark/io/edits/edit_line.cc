// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/edits/edit_line.h"

#include <fmt/core.h>
#include <xxhash.h>

#include <algorithm>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "kinemark/core/text.h"
#include "kinemark/core/utf8.h"

namespace kinemark::io {
namespace {

using data::Edit;
using data::EditKind;
using Json = nlohmann::ordered_json;

constexpr std::string_view kSumKey = R"(,"sum":")";
constexpr std::size_t kSumDigits = 16;
constexpr int kVersion = 1;
constexpr std::int64_t kLargestInteger = 1'000'000'000'000'000;

std::string hex_of(std::string_view bytes) {
  return fmt::format("{:016x}", XXH3_64bits(bytes.data(), bytes.size()));
}

/// Keys of an operation beside "do".
std::vector<std::string> keys_of(EditKind kind) {
  switch (kind) {
    case EditKind::relabel:
      return {"marker", "to", "first", "last"};
    case EditKind::swap:
      return {"marker", "with", "first", "last", "frames"};
    case EditKind::fill:
      return {"marker", "method", "first", "last"};
    case EditKind::cut:
    case EditKind::unfill:
      return {"marker", "first", "last"};
    case EditKind::crop:
      return {"first", "last"};
    case EditKind::mark_event:
    case EditKind::delete_event:
      return {"label", "context", "time_s"};
    case EditKind::move_event:
      return {"label", "context", "time_s", "to_s"};
    case EditKind::region:
      return {"name", "first", "last"};
    case EditKind::undo:
    case EditKind::redo:
      break;
  }
  return {"count"};
}

Json value_of(const Edit& edit, std::string_view key) {
  const auto frame = [](const std::optional<std::int64_t>& f) { return f ? Json(*f) : Json(); };
  const auto text = [](const std::string& t) { return t.empty() ? Json() : Json(t); };
  if (key == "marker") return text(edit.marker);
  if (key == "to" || key == "with") return text(edit.other);
  if (key == "first") return frame(edit.first_frame);
  if (key == "last") return frame(edit.last_frame);
  if (key == "frames") return text(edit.frames);
  if (key == "method") return text(edit.method);
  if (key == "label") return text(edit.label);
  if (key == "context") return text(edit.context);
  if (key == "time_s") return edit.time_s;
  if (key == "to_s") return edit.to_s;
  if (key == "name") return text(edit.name);
  return edit.count;
}

/// The object, and what is wrong with it. Objects end with their checksum if they have one.
Result<Json> parse_object(std::string_view line) {
  constexpr std::size_t kSumBytes = kSumKey.size() + kSumDigits + 2;
  const bool summed = line.size() > kSumBytes && line.substr(line.size() - kSumBytes).starts_with(kSumKey) &&
                      line.ends_with("\"}");
  std::string object(summed ? line.substr(0, line.size() - kSumBytes) : line);
  if (summed) object += '}';
  auto json = Json::parse(object, nullptr, false);
  if (json.is_discarded() || !json.is_object())
    return fail(Code::bad_input, "is no JSON object; need {\"do\": ..., ...}");
  if (json.contains("sum"))
    return fail(Code::bad_input, "its checksum \"sum\" is not the last value, of 16 digits");
  if (!summed) return json;
  if (const auto sum = line.substr(line.size() - kSumDigits - 2, kSumDigits); hex_of(object) != sum)
    return fail(Code::bad_input, fmt::format("its checksum is {} and not {}: the line was changed",
                                             hex_of(object), printable(sum)));
  return json;
}

/// Takes values out of an object; the first that is wrong stays in `error`.
class Taker {
 public:
  explicit Taker(Json json) : json_(std::move(json)) {}

  void text(const char* key, std::string& out) {
    if (const Json* value = take(key)) {
      if (!value->is_string()) return wrong(key, "text");
      out = value->get<std::string>();
    }
  }
  void integer(const char* key, std::optional<std::int64_t>& out) {
    if (const Json* value = take(key)) {
      const bool whole = value->is_number_integer() &&
                         !(value->is_number_unsigned() && value->get<std::uint64_t>() > kLargestInteger);
      if (!whole) return wrong(key, "a whole number");
      out = value->get<std::int64_t>();
    }
  }
  void number(const char* key, double& out) {
    const Json* value = take(key);
    if (value == nullptr) return missing(key);
    if (!value->is_number()) return wrong(key, "a number");
    out = value->get<double>();
  }
  [[nodiscard]] bool has(const char* key) const { return json_.contains(key); }
  void missing(std::string_view key) { say(fmt::format("needs \"{}\"", key)); }
  void wrong(std::string_view key, std::string_view needed) {
    const Json& value = json_[std::string(key)];
    const auto shown = value.is_structured()
                           ? std::string(value.type_name())  // as deep as the line is long
                           : printable(value.dump(-1, ' ', false, Json::error_handler_t::replace), 60);
    say(fmt::format("\"{}\" is {}; need {}", key, shown, needed));
  }
  void say(std::string sentence) {
    if (!error_) error_ = std::move(sentence);
  }
  /// Nothing may be left.
  [[nodiscard]] Status finish(const std::vector<std::string>& known) {
    if (error_) return fail(Code::bad_input, *error_);
    for (const auto& [key, value] : json_.items())
      if (std::ranges::find(taken_, key) == taken_.end())
        return fail(Code::bad_input, fmt::format("\"{}\" is none of its values, which are {}",
                                                 printable(key, 60), join(known)));
    return {};
  }

 private:
  const Json* take(const char* key) {
    taken_.emplace_back(key);
    const auto found = json_.find(key);
    return found == json_.end() ? nullptr : &*found;
  }
  Json json_;
  std::vector<std::string> taken_;
  std::optional<std::string> error_;
};

void take_value(Taker& taker, std::string_view key, Edit& edit) {
  if (key == "marker") return taker.text("marker", edit.marker);
  if (key == "to") return taker.text("to", edit.other);
  if (key == "with") return taker.text("with", edit.other);
  if (key == "first") return taker.integer("first", edit.first_frame);
  if (key == "last") return taker.integer("last", edit.last_frame);
  if (key == "frames") return taker.text("frames", edit.frames);
  if (key == "method") return taker.text("method", edit.method);
  if (key == "label") return taker.text("label", edit.label);
  if (key == "context") return taker.text("context", edit.context);
  if (key == "time_s") return taker.number("time_s", edit.time_s);
  if (key == "to_s") return taker.number("to_s", edit.to_s);
  if (key == "name") return taker.text("name", edit.name);
  std::optional<std::int64_t> count = 1;
  taker.integer("count", count);
  // Beyond an int it is out of range anyway, which check() says.
  edit.count = *count < 0 || *count > kLargestInteger / 1'000'000 ? 0 : static_cast<int>(*count);
}

Json facts_of(const Edit& edit) {
  Json json;
  json["do"] = to_string(edit.kind);
  for (const auto& key : keys_of(edit.kind))
    if (auto value = value_of(edit, key); !value.is_null()) json[key] = std::move(value);
  return json;
}

}  // namespace

std::string format_edit(const Edit& edit) {
  Json json;
  if (!edit.id.empty()) json["id"] = edit.id;
  json.update(facts_of(edit));
  if (!edit.made.empty()) json["made"] = edit.made;
  if (!edit.author.empty()) json["author"] = edit.author;
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<Edit> parse_edit(std::string_view line) {
  auto json = parse_object(line);
  if (!json) return std::unexpected(json.error());
  Taker taker(std::move(*json));
  Edit edit;
  std::string kind;
  taker.text("id", edit.id);
  taker.text("made", edit.made);
  taker.text("author", edit.author);
  if (!taker.has("do")) return fail(Code::bad_input, "needs \"do\", the name of an operation");
  taker.text("do", kind);
  const auto found = data::parse_edit_kind(kind);
  if (!found) return std::unexpected(found.error());
  edit.kind = *found;
  auto known = keys_of(edit.kind);
  for (const auto& key : known) take_value(taker, key, edit);
  known.insert(known.begin(), {"do", "id", "made", "author"});
  if (auto s = taker.finish(known); !s) return std::unexpected(s.error());
  if (auto s = edit.check(); !s) return std::unexpected(s.error());
  return edit;
}

std::string format_recording(const data::EditedRecording& recording) {
  Json json;
  json["kinemark_edits"] = kVersion;
  json["recording"] = {{"name", to_utf8(recording.name)},
                       {"bytes", recording.bytes},
                       {"hash", recording.hash},
                       {"hash_kind", "XXH3-64"}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

Result<data::EditedRecording> parse_recording(std::string_view line) {
  auto json = parse_object(line);
  if (!json) return std::unexpected(json.error());
  const auto version = json->find("kinemark_edits");
  if (version == json->end() || !version->is_number_integer())
    return fail(Code::bad_input, "needs {\"kinemark_edits\": 1, \"recording\": {...}} as the first line");
  if (*version != kVersion)
    return fail(Code::not_supported, fmt::format("edits of version {}; this program reads version {}",
                                                 printable(version->dump(), 30), kVersion));
  const auto recording = json->find("recording");
  if (recording == json->end() || !recording->is_object())
    return fail(Code::bad_input, "needs the \"recording\" that the edits are of");
  Taker taker(*recording);
  data::EditedRecording out;
  std::string hash_kind;
  std::optional<std::int64_t> bytes;
  taker.text("name", out.name);
  taker.integer("bytes", bytes);
  taker.text("hash", out.hash);
  taker.text("hash_kind", hash_kind);
  if (auto s = taker.finish({"name", "bytes", "hash", "hash_kind"}); !s) return std::unexpected(s.error());
  const bool digits =
      out.hash.size() == kSumDigits && out.hash.find_first_not_of("0123456789abcdef") == std::string::npos;
  if (hash_kind != "XXH3-64" || !digits || bytes.value_or(-1) < 0)
    return fail(Code::bad_input, "the recording needs its bytes and its XXH3-64 hash of 16 digits");
  out.bytes = *bytes;
  return out;
}

std::string with_sum(std::string_view object) {
  return fmt::format("{}{}{}\"}}", object.substr(0, object.size() - 1), kSumKey, hex_of(object));
}

std::string digest_of(std::span<const Edit> edits) {
  std::string text;
  for (const Edit& edit : edits)
    text += facts_of(edit).dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
  return hex_of(text);
}

}  // namespace kinemark::io
