// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/io/nwb/internal/pose_reader.h"

namespace kinemark::io::internal {
namespace {

/// The axes of a dataset in the order that is wanted here.
struct Axes {
  std::vector<std::size_t> size, stride;

  /// `dims`, where the file has it, is a list of the names of the axes, as in `["track", "xy", "node",
  /// "frame"]`; `usual` is the order without it, `wanted` the one here. Nothing where they do not fit.
  static std::optional<Axes> of(const std::vector<std::int64_t>& shape,
                                const std::optional<std::string>& dims, const std::vector<std::string>& usual,
                                const std::vector<std::string>& wanted) {
    if (shape.size() != usual.size()) return std::nullopt;
    std::vector<std::string> order = usual;
    if (dims) {
      const auto place = [&](const std::string& name) { return dims->find('"' + name + '"'); };
      if (std::ranges::any_of(usual, [&](const auto& name) { return place(name) == std::string::npos; }))
        return std::nullopt;
      std::ranges::sort(order, {}, place);
    }
    Axes out;
    for (const auto& name : wanted) {
      const auto axis = static_cast<std::size_t>(std::ranges::find(order, name) - order.begin());
      std::size_t stride = 1;
      for (std::size_t a = axis + 1; a < shape.size(); ++a) stride *= static_cast<std::size_t>(shape[a]);
      out.size.push_back(static_cast<std::size_t>(shape[axis]));
      out.stride.push_back(stride);
    }
    return out;
  }
};

struct Numbers {
  Array<double> values;
  Axes axes;
};

std::optional<Numbers> read_axes(Input& in, const char* name, const std::vector<std::string>& usual,
                                 const std::vector<std::string>& wanted) {
  const Handle data = in.object(in.file(), name);
  const auto shape = in.number_shape(data.id());
  if (!shape) return std::nullopt;
  auto axes = Axes::of(*shape, in.text_attribute(data.id(), "dims"), usual, wanted);
  if (!axes) return std::nullopt;
  auto values = in.numbers<double>(data.id());
  if (!values) return std::nullopt;
  return Numbers{std::move(*values), std::move(*axes)};
}

std::vector<std::string> names_of(Input& in, const char* name) {
  const Handle data = in.object(in.file(), name);
  auto names = in.texts(data.id());
  return names ? std::move(*names) : std::vector<std::string>{};
}

}  // namespace

Result<PoseTable> read_sleap(Input& in) {
  const auto tracks =
      read_axes(in, "tracks", {"track", "xy", "node", "frame"}, {"frame", "track", "node", "xy"});
  if (!tracks || tracks->axes.size[3] != 2)
    return fail(
        Code::bad_input,
        "its tracks are no numbers of tracks x 2 x nodes x frames, as SLEAP exports them for analysis");
  const auto& size = tracks->axes.size;
  PoseTable out{.frames = static_cast<std::int64_t>(size[0]),
                .people = names_of(in, "track_names"),
                .points = names_of(in, "node_names")};
  if (out.points.size() != size[2])
    return fail(Code::bad_input,
                fmt::format("has {} names of nodes; its tracks have {} nodes", out.points.size(), size[2]));
  // A file of one animal without tracks names none.
  if (out.people.size() != size[1]) out.people.assign(size[1], "");
  // Instances that a person labelled have no score.
  const auto scores = read_axes(in, "point_scores", {"track", "node", "frame"}, {"frame", "track", "node"});
  if (scores && !std::equal(size.begin(), size.begin() + 3, scores->axes.size.begin()))
    return fail(Code::bad_input, "its point_scores are of other tracks, nodes or frames than its tracks");
  const std::size_t samples = size[0] * size[1] * size[2];
  if (!in.afford(samples, 3 * sizeof(double)))
    return fail(Code::bad_input, "holds more samples than the size of the file allows");
  out.values.resize(3 * samples);
  double* value = out.values.data();
  for (std::size_t f = 0; f < size[0]; ++f)
    for (std::size_t p = 0; p < size[1]; ++p)
      for (std::size_t m = 0; m < size[2]; ++m, value += 3) {
        const auto at = [&](const Numbers& from) {
          const auto& step = from.axes.stride;
          return from.values.data() + f * step[0] + p * step[1] + m * step[2];
        };
        value[0] = at(*tracks)[0];
        value[1] = at(*tracks)[tracks->axes.stride[3]];
        value[2] = scores && !std::isnan(*at(*scores)) ? *at(*scores) : 1.0;
      }
  return out;
}

}  // namespace kinemark::io::internal
