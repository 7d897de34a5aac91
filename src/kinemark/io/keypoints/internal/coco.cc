// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/keypoints/internal/coco.h"

#include <fmt/core.h>

#include <algorithm>
#include <set>
#include <utility>

#include "kinemark/io/keypoints/internal/json_numbers.h"

namespace kinemark::io::internal {
namespace {

using Json = nlohmann::json;

std::optional<std::int64_t> number_of_track(const Json& annotation) {
  if (const auto number = whole_number(annotation, {"track_id"})) return number;
  const auto more = annotation.find("attributes");
  return more == annotation.end() ? std::nullopt : whole_number(*more, {"track_id"});
}

}  // namespace

Status CocoVideo::take(std::string_view key, const Json& piece) {
  return key == "images"        ? take_image(piece)
         : key == "annotations" ? take_annotation(piece)
         : key == "categories"  ? take_category(piece)
                                : Status();
}

Status CocoVideo::take_image(const Json& image) {
  const auto id = whole_number(image, {"id"});
  if (!id) return fail(Code::bad_input, fmt::format("image {} has no id", images_.size() + 1));
  images_.push_back(*id);
  return {};
}

Status CocoVideo::take_annotation(const Json& annotation) {
  const auto image = whole_number(annotation, {"image_id"}),
             category = whole_number(annotation, {"category_id"});
  if (!image || !category) return fail(Code::bad_input, "an annotation has no image_id or no category_id");
  const auto found = annotation.find("keypoints");
  if (found == annotation.end()) return {};  // a box or an outline
  if (!is_row(*found) || found->size() % 3 != 0)
    return fail(Code::bad_input,
                fmt::format("image {}: keypoints are no list of x, y and visibility", *image));
  Person person{.number = number_of_track(annotation), .values = {}};
  person.values.reserve(found->size());
  for (const Json& value : *found) person.values.push_back(number_or_nan(value));
  people_[*image].push_back(std::move(person));
  if (std::ranges::find(categories_, *category) == categories_.end()) categories_.push_back(*category);
  if (categories_.size() > 1)
    return fail(Code::not_supported, fmt::format("image {}: shows points of categories {} and {}; need one",
                                                 *image, categories_[0], categories_[1]));
  return {};
}

Status CocoVideo::take_category(const Json& category) {
  const auto id = whole_number(category, {"id"});
  if (!id) return fail(Code::bad_input, "a category has no id");
  const auto found = category.find("keypoints");
  if (found == category.end()) return {};
  auto& names = names_[*id];
  if (!names.empty()) return fail(Code::bad_input, fmt::format("category {} occurs twice", *id));
  for (const Json& name : *found) {
    if (!name.is_string())
      return fail(Code::bad_input, fmt::format("category {}: keypoints are no list of names", *id));
    names.push_back(name.get<std::string>());
  }
  return {};
}

Result<const std::vector<std::string>*> CocoVideo::names() const {
  if (categories_.empty()) return fail(Code::bad_input, "has no annotations with keypoints");
  const auto found = names_.find(categories_.front());
  if (found == names_.end())
    return fail(Code::bad_input, fmt::format("category {} has no names of keypoints", categories_.front()));
  return &found->second;
}

Result<Keypoints> CocoVideo::finish() {
  const auto names = this->names();
  if (!names) return std::unexpected(names.error());
  std::set<std::int64_t> known;
  for (const auto image : images_)
    if (!known.insert(image).second)
      return fail(Code::bad_input, fmt::format("image {} occurs twice", image));
  for (const auto& [image, people] : people_)
    if (!known.contains(image))
      return fail(Code::bad_input, fmt::format("an annotation is of image {}, which is not there", image));
  for (std::size_t f = 0; f < images_.size(); ++f) {
    const auto found = people_.find(images_[f]);
    const auto people =
        found == people_.end() ? std::span<const Person>() : std::span<const Person>(found->second);
    if (auto s = frames_.add(static_cast<std::int64_t>(f), people, f == 0 ? bytes_ : 0); !s)
      return fail_at(fmt::format("image {}", images_[f]), s.error());
  }
  return frames_.finish(**names);
}

}  // namespace kinemark::io::internal
