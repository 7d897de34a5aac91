// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/internal/xml_file.h"

#include <fmt/core.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <span>
#include <sstream>

#include "kinemark/core/number.h"
#include "kinemark/core/utf8.h"
#include "kinemark/io/file.h"
#include "kinemark/io/osim/internal/shift_jis.h"

namespace kinemark::io::osim {
namespace {

constexpr std::size_t kMaxBytes = 64UL << 20;  // the largest public model has 6 MB
constexpr int kMaxDepth = 200;                 // real ones stay below 20
constexpr std::size_t kMaxTags = 1'000'000;    // real ones have below 100,000
constexpr std::size_t kJudged = 1UL << 20;     // bytes by which a file is judged
constexpr int kMaxFiles = 64;

/// Bytes that are not UTF-8 become the Latin-1 characters that they are.
std::string as_utf8(std::string_view s) {
  std::string out;
  out.reserve(s.size());
  for (std::size_t i = 0; i < s.size();) {
    if (const std::size_t n = utf8_length(s, i); n > 0) {
      out.append(s.substr(i, n));
      i += n;
    } else {
      const auto byte = static_cast<unsigned char>(s[i++]);
      out += static_cast<char>(0xC0 | (byte >> 6));
      out += static_cast<char>(0x80 | (byte & 0x3F));
    }
  }
  return out;
}

bool is_utf16(std::string_view s) { return s.starts_with("\xFF\xFE") || s.starts_with("\xFE\xFF"); }

/// One tag, from its '<' on, as far as size is concerned.
struct Tag {
  std::size_t end = 0;  ///< behind it
  int deeper = 0;       ///< 1 opens an element, -1 closes one, 0 neither
};

Tag next_tag(std::string_view xml, std::size_t begin) {
  const auto until = [&](std::string_view closing) {
    const std::size_t at = xml.find(closing, begin);
    return Tag{.end = at == std::string_view::npos ? xml.size() : at + closing.size(), .deeper = 0};
  };
  const std::string_view rest = xml.substr(begin, 9);
  if (rest.starts_with("<!--")) return until("-->");
  if (rest.starts_with("<![CDATA[")) return until("]]>");
  if (rest.starts_with("<?")) return until("?>");
  std::size_t end = xml.find_first_of(">\"'", begin);
  while (end != std::string_view::npos && xml[end] != '>') {
    end = xml.find(xml[end], end + 1);  // the quote that closes
    if (end != std::string_view::npos) end = xml.find_first_of(">\"'", end + 1);
  }
  if (end == std::string_view::npos) return {.end = xml.size(), .deeper = 0};
  const bool neither = rest.starts_with("<!") || xml[end - 1] == '/';
  return {.end = end + 1, .deeper = neither ? 0 : rest.starts_with("</") ? -1 : 1};
}

/// Refuses what would cost a multiple of its size as a tree, before there is one. Of UTF-16 tags are only
/// counted.
Status check_size(std::string_view xml, const std::string& name) {
  if (is_utf16(xml)) {
    if (static_cast<std::size_t>(std::ranges::count(xml, '<')) <= kMaxTags) return {};
    return fail(Code::bad_input,
                fmt::format("{}: more than {} tags; no OpenSim file has so many", name, kMaxTags));
  }
  std::size_t tags = 0;
  int depth = 0;
  for (std::size_t at = xml.find('<'); at != std::string_view::npos;) {
    const Tag tag = next_tag(xml, at);
    depth += tag.deeper;
    if (depth > kMaxDepth)
      return fail(Code::bad_input,
                  fmt::format("{}: byte {}: elements are nested deeper than {}; no OpenSim file is", name,
                              at + 1, kMaxDepth));
    if (++tags > kMaxTags)
      return fail(Code::bad_input, fmt::format("{}: byte {}: more than {} tags; no OpenSim file has so many",
                                               name, at + 1, kMaxTags));
    at = tag.end < xml.size() ? xml.find('<', tag.end) : std::string_view::npos;
  }
  return {};
}

/// A file that can be XML begins with a tag, behind blanks and a byte-order mark.
bool begins_as_xml(std::string_view begin) {
  if (is_utf16(begin)) return true;
  if (begin.starts_with("\xEF\xBB\xBF")) begin.remove_prefix(3);
  const auto first = begin.find_first_not_of(" \t\r\n");
  return first != std::string_view::npos && begin[first] == '<';
}

class DepthMeter : public pugi::xml_tree_walker {
 public:
  bool for_each(pugi::xml_node&) override { return depth() < kMaxDepth; }
};

/// Where the closing tag begins that ends at or behind `offset`, if nothing but blanks follows it.
std::optional<std::size_t> last_closing_tag(std::string_view xml, std::size_t offset) {
  const std::size_t begin = xml.rfind("</", std::min(offset + 1, xml.size()));
  if (begin == std::string_view::npos || begin == 0) return std::nullopt;
  const std::size_t end = xml.find('>', begin);
  if (end == std::string_view::npos || !trim(xml.substr(end + 1)).empty()) return std::nullopt;
  return begin;
}

bool is_set(std::string_view tag) { return tag.ends_with("Set") || tag == "Model"; }

}  // namespace

Result<XmlFile> XmlFile::parse(std::string_view xml, std::string name, Comments comments) {
  XmlFile file;
  file.name_ = std::move(name);
  if (xml.size() > kMaxBytes)
    return fail(Code::bad_input, fmt::format("{}: has {} bytes; at most {} are read as OpenSim XML",
                                             file.name_, xml.size(), kMaxBytes));
  const bool utf16 = is_utf16(xml);
  if (auto s = check_size(xml, file.name_); !s) return std::unexpected(s.error());
  const bool as_it_is = utf16 || is_utf8(xml);
  std::string converted;
  if (!as_it_is) {
    auto declared = from_shift_jis(xml);
    converted = declared ? std::move(*declared) : as_utf8(xml);
  }
  const std::string_view text = as_it_is ? xml : std::string_view(converted);
  const auto encoding = utf16 ? pugi::encoding_auto : pugi::encoding_utf8;
  const auto options = pugi::parse_default | pugi::parse_declaration | pugi::parse_doctype |
                       (comments == Comments::kept ? pugi::parse_comments : 0U);
  auto outcome = file.tree_.load_buffer(text.data(), text.size(), options, encoding);
  if (outcome.status == pugi::status_end_element_mismatch) {
    // An unmatched closing tag after an otherwise complete document.
    if (const auto begin = last_closing_tag(text, static_cast<std::size_t>(outcome.offset)))
      outcome = file.tree_.load_buffer(text.data(), *begin, options, encoding);
  }
  if (!outcome || !file.document()) {
    const auto offset = static_cast<std::size_t>(std::max<std::ptrdiff_t>(outcome.offset, 0));
    const auto line = 1 + std::count(text.begin(), text.begin() + std::min(offset, text.size()), '\n');
    return fail(Code::bad_input,
                fmt::format("{}: line {}: not an XML document that can be read ({})", file.name_, line,
                            outcome ? "no element in it" : outcome.description()));
  }
  DepthMeter meter;
  if (!file.tree_.traverse(meter))
    return fail(Code::bad_input, fmt::format("{}: elements are nested deeper than {}; no OpenSim file is",
                                             file.name_, kMaxDepth));
  return file;
}

Result<XmlFile> XmlFile::read(const std::filesystem::path& path, Comments comments) {
  const auto file = InputFile::open(path);
  if (!file) return std::unexpected(file.error());
  std::string begin(std::min(file->size(), kJudged), '\0');
  const auto n = file->read_at(0, std::as_writable_bytes(std::span(begin)));
  if (!n) return std::unexpected(n.error());
  if (file->size() > kJudged && !begins_as_xml(begin))
    return fail(
        Code::bad_input,
        fmt::format("{}: is no XML: it does not begin with a tag. Nothing more was read.", path.string()));
  const auto text = read_text(path, kMaxBytes);
  if (!text) return std::unexpected(text.error());
  return parse(*text, path.string(), comments);
}

XmlFile XmlFile::copy() const {
  XmlFile other;
  other.name_ = name_;
  other.tree_.reset(tree_);
  return other;
}

std::string XmlFile::text() const {
  pugi::xml_document document;
  document.reset(tree_);
  for (pugi::xml_node node = document.first_child(); node;) {
    const pugi::xml_node next = node.next_sibling();
    if (node.type() == pugi::node_declaration) document.remove_child(node);
    node = next;
  }
  pugi::xml_node declaration = document.prepend_child(pugi::node_declaration);
  declaration.append_attribute("version") = "1.0";
  declaration.append_attribute("encoding") = "UTF-8";
  std::ostringstream text;
  document.save(text, "\t", pugi::format_default, pugi::encoding_utf8);
  return std::move(text).str();
}

void XmlFile::inline_files(const std::filesystem::path* folder) {
  struct Finder : pugi::xml_tree_walker {
    std::vector<pugi::xml_node> found;
    bool for_each(pugi::xml_node& node) override {
      if (is_set(node.name()) && *node.attribute("file").value() != '\0' && found.size() <= kMaxFiles)
        found.push_back(node);
      return true;
    }
  } finder;
  tree_.traverse(finder);
  if (finder.found.size() > kMaxFiles)
    return note(document(), fmt::format("names more than {} other files", kMaxFiles));
  for (const pugi::xml_node node : finder.found) {
    const std::string wanted(trim(node.attribute("file").value()));
    if (folder == nullptr)
      return note(node, fmt::format("stands in another file, {}, which is not available", in_quotes(wanted)));
    const auto other = read(*folder / wanted);
    if (!other) return note(node, other.error().message, other.error().code);
    const pugi::xml_node source = other->find_object({node.name()});
    if (!source) return note(node, fmt::format("the file {} has no <{}>", in_quotes(wanted), node.name()));
    inlined_.push_back(*folder / wanted);
    pugi::xml_node target = node;
    target.remove_attribute("file");
    for (const pugi::xml_node child : source.children()) target.append_copy(child);
  }
}

pugi::xml_node XmlFile::find_object(std::initializer_list<const char*> tags) const {
  for (const char* tag : tags) {
    if (std::string_view(document().name()) == tag) return document();
    if (const auto child = document().child(tag)) return child;
  }
  return {};
}

int XmlFile::version() const { return document().attribute("Version").as_int(10500); }

void XmlFile::note(pugi::xml_node node, std::string_view what, Code code) {
  if (error_) return;
  // The element itself and the named ones around it, outermost first, without the document and the model.
  std::string location;
  const pugi::xml_node first = node;
  for (; node && node != document(); node = node.parent()) {
    const std::string name = name_of(node);
    if (std::string_view(node.name()) == "Model" || (name.empty() && node != first)) continue;
    if (std::string_view(node.name()).ends_with("Set") && node != first) continue;
    const std::string step =
        name.empty() ? fmt::format("<{}>", node.name()) : fmt::format("{} {}", node.name(), in_quotes(name));
    location = location.empty() ? step : step + ", " + location;
  }
  error_ = Error{code, fmt::format("{}: {}{}{}", name_, location, location.empty() ? "" : ": ", what)};
}

double XmlFile::number(pugi::xml_node node, const char* child, double fallback) {
  const pugi::xml_node element = node.child(child);
  const std::string text = text_of(element);
  if (text.empty()) return fallback;
  const auto value = parse_number(text);
  if (!value) note(element, fmt::format("{} is not a number", in_quotes(text)));
  return value.value_or(fallback);
}

bool XmlFile::flag(pugi::xml_node node, const char* child, bool fallback) {
  const pugi::xml_node element = node.child(child);
  std::string text = text_of(element);
  if (text.empty()) return fallback;
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (text == "true" || text == "1") return true;
  if (text != "false" && text != "0")
    note(element, fmt::format("{} is neither true nor false", in_quotes(text)));
  return false;
}

std::vector<double> XmlFile::numbers(pugi::xml_node node, const char* child) {
  const pugi::xml_node element = node.child(child);
  std::vector<double> values;
  for (const std::string& word : words_of(text_of(element))) {
    const auto value = parse_number(word);
    if (!value || !std::isfinite(*value)) {
      note(element, fmt::format("{} is not a finite number", in_quotes(word)));
      return {};
    }
    values.push_back(*value);
  }
  return values;
}

Eigen::Vector3d XmlFile::vector3(pugi::xml_node node, const char* child, const Eigen::Vector3d& fallback) {
  const auto values = numbers(node, child);
  if (values.empty()) return fallback;
  if (values.size() != 3) {
    note(node.child(child), fmt::format("has {} numbers; need three", values.size()));
    return fallback;
  }
  return {values[0], values[1], values[2]};
}

std::string text_of(pugi::xml_node node) {
  std::string text;
  for (const pugi::xml_node child : node.children())
    if (child.type() == pugi::node_pcdata || child.type() == pugi::node_cdata) text += child.value();
  return std::string(trim(text));
}

std::string text_of(pugi::xml_node node, const char* child) { return text_of(node.child(child)); }

std::vector<std::string> words_of(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n";
  std::vector<std::string> words;
  for (std::size_t begin = text.find_first_not_of(blanks); begin != std::string_view::npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, begin), text.size());
    words.emplace_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(blanks, end);
  }
  return words;
}

std::string name_of(pugi::xml_node node) { return std::string(trim(node.attribute("name").value())); }

pugi::xml_node first_element(pugi::xml_node node) {
  for (const pugi::xml_node child : node.children())
    if (child.type() == pugi::node_element) return child;
  return {};
}

std::vector<pugi::xml_node> objects_of(pugi::xml_node node, const char* set) {
  std::vector<pugi::xml_node> objects;
  for (const pugi::xml_node child : node.child(set).child("objects").children())
    if (child.type() == pugi::node_element) objects.push_back(child);
  return objects;
}

std::string in_quotes(std::string_view value) {
  if (value.size() <= 60) return fmt::format("'{}'", value);
  std::size_t n = 57;
  while (n > 0 && (static_cast<unsigned char>(value[n]) & 0xC0) == 0x80) --n;  // keep UTF-8 whole
  return fmt::format("'{}...'", value.substr(0, n));
}

}  // namespace kinemark::io::osim
