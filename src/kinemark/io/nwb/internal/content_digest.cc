// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/content_digest.h"

#include <fmt/core.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <bit>
#include <memory>
#include <string_view>

#include "kinemark/io/nwb/internal/content_list.h"
#include "kinemark/io/set_mark.h"

namespace kinemark::io::internal {
namespace {

constexpr int kMostDepth = 12;
// Attributes of the root that are ours: others may add theirs.
constexpr std::array kOfRoot = {std::string_view("kinemark_content"), std::string_view("kinemark_module"),
                                kSetKey};
constexpr std::int64_t kBlockNumbers = 1 << 17;

struct FreeState {
  void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
};
using State = std::unique_ptr<XXH3_state_t, FreeState>;

State make_state() {
  State state(XXH3_createState());
  XXH3_64bits_reset(state.get());
  return state;
}

herr_t collect(hid_t, const char* name, const H5A_info_t*, void* out) {
  static_cast<std::vector<std::string>*>(out)->emplace_back(name);
  return 0;
}

/// One walk over a file. Every member is false where something cannot be read.
class Walk {
 public:
  explicit Walk(Input& in) : in_(in), left_(in.bytes_explained()), state_(make_state()) {}

  bool object(const std::string& path, int depth) {
    const Handle object = in_.object(in_.file(), path.empty() ? "/" : path);
    if (!object || depth > kMostDepth || !attributes(object.id(), path.empty())) return false;
    switch (H5Iget_type(object.id())) {
      case H5I_GROUP:
        return group(object.id(), path, depth);
      case H5I_DATASET:
        return dataset(object.id());
      default:
        return false;
    }
  }
  /// What a list names, and what our attributes of the root say.
  bool listed(const std::vector<std::string>& content) {
    for (const auto name : kOfRoot) {
      const auto texts = in_.text_attributes(in_.file(), std::string(name).c_str());
      add(texts ? texts->size() : 0);
      if (texts)
        for (const auto& text : *texts) add(text);
    }
    for (const auto& path : content) {
      add(path);
      const Handle alone = in_.object(in_.file(), path);
      if (path.ends_with('/') ? !attributes(alone.id(), false) : !object(path, 0)) return false;
    }
    return true;
  }
  [[nodiscard]] std::string digest() const {
    return fmt::format("xxh3:{:016x}", XXH3_64bits_digest(state_.get()));
  }

 private:
  void add(std::uint64_t number) { XXH3_64bits_update(state_.get(), &number, sizeof number); }
  void add(std::string_view text) {
    add(text.size());
    XXH3_64bits_update(state_.get(), text.data(), text.size());
  }

  bool attributes(hid_t object, bool root) {
    std::vector<std::string> names;
    if (H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names) < 0) return false;
    std::ranges::sort(names);
    for (const std::string& name : names) {
      if (root && name == kDigestAttribute) continue;
      add(name);
      if (const auto texts = in_.text_attributes(object, name.c_str())) {
        for (const std::string& text : *texts) add(text);
      } else if (const auto number = in_.number_attribute(object, name.c_str())) {
        add(std::bit_cast<std::uint64_t>(*number));
      } else if (const auto target = in_.reference_attribute(object, name.c_str())) {
        add(*target);
      } else {
        return false;
      }
    }
    return true;
  }

  bool group(hid_t group, const std::string& path, int depth) {
    const auto names = in_.children(group);
    if (!names) return false;
    for (const std::string& name : *names) {
      add(name);
      if (const auto target = in_.soft_link(group, name))
        add(*target);
      else if (!object(path + "/" + name, depth + 1))
        return false;
    }
    add(names->size());
    return true;
  }

  bool dataset(hid_t dataset) {
    if (const auto known = in_.digest_of(dataset)) {
      add(*known);
      return true;
    }
    if (const auto shape = in_.number_shape(dataset)) return numbers(dataset, *shape);
    auto texts = in_.texts(dataset);
    if (!texts) texts = in_.references(dataset);
    if (!texts) return false;
    for (const std::string& text : *texts) add(text);
    return true;
  }

  /// Numbers that are not in memory, in blocks of rows.
  bool numbers(hid_t dataset, const std::vector<std::int64_t>& shape) {
    const std::int64_t rows = shape.empty() ? 1 : shape.front();
    std::int64_t width = 1;
    for (std::size_t d = 1; d < shape.size(); ++d) width *= shape[d];
    const State own = make_state();
    const bool bytes = in_.holds_bytes(dataset);
    const auto size = static_cast<std::size_t>(rows * width) * (bytes ? 1 : sizeof(double));
    if (size > left_) return false;  // rows without end that are nowhere in the file
    left_ -= size;
    const std::int64_t most = std::max<std::int64_t>(1, kBlockNumbers / std::max<std::int64_t>(1, width));
    std::vector<double> block(static_cast<std::size_t>(std::min(rows, most) * width));
    for (std::int64_t first = 0; first < rows && width > 0; first += most) {
      const std::int64_t n = std::min(most, rows - first);
      if (!in_.read_rows(dataset, shape, first, n, block.data())) return false;
      XXH3_64bits_update(own.get(), block.data(),
                         static_cast<std::size_t>(n * width) * (bytes ? 1 : sizeof(double)));
    }
    add(XXH3_64bits_digest(own.get()));
    return true;
  }

  Input& in_;
  std::size_t left_;  ///< bytes that the file's size can still explain
  State state_;
};

}  // namespace

std::optional<std::string> content_digest(Input& in) {
  Walk walk(in);
  const auto content = listed_content(in);
  if (content ? !walk.listed(*content) : !walk.object("", 0)) return std::nullopt;
  return walk.digest();
}

void seal(Output& out, const std::string& set, const std::vector<std::string>& content) {
  if (!set.empty()) out.attribute(out.file(), std::string(kSetKey).c_str(), set_mark(set));
  out.attribute(out.file(), kContentAttribute, content);
  if (out.failed()) return;
  auto written = Input::of(out.file());
  const auto digest = content_digest(written);
  out.require(digest.has_value());
  if (digest) out.attribute(out.file(), kDigestAttribute, *digest);
}

void seal_whole(Output& out, const std::string& set) { seal(out, set, all_content(Input::of(out.file()))); }

}  // namespace kinemark::io::internal
