// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/nwb/internal/signals_reader.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "kinemark/io/nwb/internal/content_list.h"
#include "kinemark/io/nwb/internal/names.h"
#include "kinemark/io/rate.h"

namespace kinemark::io::internal {
namespace {

constexpr std::size_t kMostPlates = 255;  ///< which a C3D file can name
constexpr auto kLastChannelKind = data::ChannelKind::other;

/// A table of ours: its columns must have the rows of the first.
class TableIn {
 public:
  TableIn(Input& in, std::string path)
      : in_(in), path_(std::move(path)), group_(in.object(in.file(), path_)) {}

  explicit operator bool() const { return static_cast<bool>(group_); }
  [[nodiscard]] const std::string& path() const { return path_; }
  [[nodiscard]] bool has(const char* name) const { return static_cast<bool>(in_.object(group_.id(), name)); }

  [[nodiscard]] std::unexpected<Error> bad(const char* name, const std::string& what) const {
    return fail(Code::bad_input, fmt::format("{}/{}: {}", path_, name, what));
  }
  /// Texts of a column; of `rows` rows, or of any.
  Result<std::vector<std::string>> texts(const char* name, std::optional<std::size_t> rows = {}) const {
    const Handle column = in_.object(group_.id(), name);
    auto out = in_.texts(column.id());
    if (!out || (rows && out->size() != *rows)) return bad(name, "does not hold a text for each row");
    return std::move(*out);
  }
  /// Numbers of a column: `across` for each of `rows` rows.
  Result<Array<double>> numbers(const char* name, std::size_t rows, std::size_t across = 1) const {
    const Handle column = in_.object(group_.id(), name);
    auto out = in_.numbers<double>(column.id());
    if (!out || out->size() != rows * across)
      return bad(name, fmt::format("does not hold {} for each of {} rows",
                                   across == 1 ? "a number" : fmt::format("{} numbers", across), rows));
    return std::move(*out);
  }
  /// Numbers of a column, any number of them for each row; none where there is no such column.
  Result<Array<double>> lists(const char* name, std::size_t rows) const {
    if (!has(name)) return Array<double>{};
    const Handle column = in_.object(group_.id(), name);
    const auto shape = in_.number_shape(column.id());
    if (!shape || shape->size() != 2 || std::cmp_not_equal(shape->front(), rows))
      return bad(name, fmt::format("does not hold as many numbers for each of {} rows", rows));
    return numbers(name, rows, static_cast<std::size_t>(shape->back()));
  }
  /// A number as a whole one of a range.
  Result<int> whole(const char* name, double value, int low, int high) const {
    if (!(value >= low && value <= high) || value != std::floor(value))
      return bad(name, fmt::format("holds {}; expected whole numbers from {} to {}", value, low, high));
    return static_cast<int>(value);
  }
  /// The one rate of all rows, Hz.
  Result<double> rate(std::size_t rows) const {
    const auto rates = numbers("rate_hz", rows);
    if (!rates) return std::unexpected(rates.error());
    for (const double rate : *rates)
      if (rate != rates->front() || !std::isfinite(rate))
        return bad("rate_hz", "does not hold the same rate in each row");
    return rates->front();
  }

 private:
  Input& in_;
  std::string path_;
  Handle group_;
};

TableIn module_table(Input& in, const char* name) { return {in, fmt::format("{}/{}", module_of(in), name)}; }

std::unexpected<Error> beyond_file(const std::string& what) {
  return fail(Code::bad_input, what + ": holds more samples than the size of the file allows");
}

/// Samples of a series, rows x width.
struct SeriesIn {
  std::size_t rows = 0, width = 0;
  Array<double> values;
};

Result<SeriesIn> read_series(Input& in, const std::string& path) {
  const Handle data = in.object(in.file(), path + "/data");
  const auto shape = in.number_shape(data.id());
  if (!shape || shape->empty() || shape->size() > 2)
    return fail(Code::bad_input, path + ": its data are not numbers of shape samples x channels");
  auto values = in.numbers<double>(data.id());
  if (!values) return fail(Code::bad_input, path + ": its samples cannot be read; the file may be broken");
  return SeriesIn{.rows = static_cast<std::size_t>(shape->front()),
                  .width = shape->size() == 2 ? static_cast<std::size_t>(shape->back()) : 1,
                  .values = std::move(*values)};
}

Result<data::ChannelKind> kind_of(const TableIn& table, const std::string& word) {
  for (std::uint8_t k = 0; k <= std::to_underlying(kLastChannelKind); ++k)
    if (data::to_string(static_cast<data::ChannelKind>(k)) == word) return static_cast<data::ChannelKind>(k);
  return table.bad("kind", "holds a word that is no kind of channel");
}

Status read_channel_columns(const TableIn& table, data::Channels& out) {
  auto names = table.texts("channel");
  if (!names) return std::unexpected(names.error());
  const auto kinds = table.texts("kind", names->size());
  if (!kinds) return std::unexpected(kinds.error());
  auto units = table.texts("unit", names->size());
  if (!units) return std::unexpected(units.error());
  for (const std::string& word : *kinds) {
    const auto kind = kind_of(table, word);
    if (!kind) return std::unexpected(kind.error());
    out.kinds.push_back(*kind);
  }
  out.names = std::move(*names);
  out.units = std::move(*units);
  return {};
}

Status read_channels(Input& in, data::Trial& trial) {
  const TableIn table = module_table(in, kChannelsTable);
  if (!table) return {};
  data::Channels& c = trial.channels;
  if (auto s = read_channel_columns(table, c); !s) return s;
  const std::size_t count = c.names.size(), frames = static_cast<std::size_t>(trial.markers.frames());
  const auto series = table.texts("series", count);
  if (!series) return std::unexpected(series.error());
  if (count == 0) return {};
  const auto rate = table.rate(count);
  if (!rate) return std::unexpected(rate.error());
  if (!in.afford(frames * count, 3 * sizeof(double))) return beyond_file(table.path());
  c.rate_hz = *rate;
  c.frames = trial.markers.frames();
  c.values.resize(3 * frames * count);
  for (std::size_t k = 0; k < count; ++k) {
    const std::string path = fmt::format("{}/{}/{}", module_of(in), kChannels, (*series)[k]);
    const auto one = read_series(in, path);
    if (!one) return std::unexpected(one.error());
    if (one->rows != frames || one->width != 3)
      return fail(Code::bad_input, fmt::format("{}: does not hold {} samples of 3 numbers", path, frames));
    for (std::size_t f = 0; f < frames; ++f)
      std::copy_n(one->values.data() + 3 * f, 3, c.values.data() + 3 * (f * count + k));
  }
  return {};
}

/// Samples of one series go to the channels that name it.
Status take_analog(const TableIn& table, const SeriesIn& from, const std::vector<std::size_t>& channels,
                   const Array<double>& column, data::AnalogChannels& out) {
  for (const std::size_t k : channels) {
    const auto at = table.whole("column", column[k], 0, static_cast<int>(from.width) - 1);
    if (!at) return std::unexpected(at.error());
    for (std::size_t s = 0; s < from.rows; ++s)
      out.values[s * column.size() + k] = from.values[s * from.width + static_cast<std::size_t>(*at)];
  }
  return {};
}

Status read_analog_series(Input& in, const TableIn& table, const std::vector<std::string>& series,
                          const Array<double>& column, data::AnalogChannels& out) {
  std::map<std::string, std::vector<std::size_t>> channels;  // of each series
  for (std::size_t k = 0; k < series.size(); ++k) channels[series[k]].push_back(k);
  const std::string& first = channels.begin()->first;
  if (channels.size() == 1 && first.empty()) return {};  // channels without samples
  for (const auto& [name, its] : channels) {
    const std::string path = fmt::format("{}/{}", kAcquisition, name);
    const auto from = read_series(in, path);
    if (!from) return std::unexpected(from.error());
    if (name == first) {
      if (!in.afford(from->rows * series.size(), sizeof(double))) return beyond_file(path);
      out.samples = static_cast<std::int64_t>(from->rows);
      out.values.resize(from->rows * series.size());
    }
    if (std::cmp_not_equal(from->rows, out.samples))
      return fail(Code::bad_input, fmt::format("{}: has {} samples, {}/{} has {}", path, from->rows,
                                               kAcquisition, first, out.samples));
    if (auto s = take_analog(table, *from, its, column, out); !s) return s;
  }
  return {};
}

Status read_analog(Input& in, data::AnalogChannels& out) {
  const TableIn table = module_table(in, kAnalogTable);
  if (!table) return {};
  auto names = table.texts("channel");
  if (!names) return std::unexpected(names.error());
  if (names->empty()) return {};
  const std::size_t count = names->size();
  const auto series = table.texts("series", count);
  if (!series) return std::unexpected(series.error());
  const auto column = table.numbers("column", count);
  if (!column) return std::unexpected(column.error());
  const auto rate = table.rate(count);
  if (!rate) return std::unexpected(rate.error());
  if (table.has("unit")) {
    auto units = table.texts("unit", count);
    if (!units) return std::unexpected(units.error());
    out.units = std::move(*units);
  }
  out.names = std::move(*names);
  out.rate_hz = *rate;
  if (auto s = read_analog_series(in, table, *series, *column, out); !s) return s;
  return out.samples == 0 ? Status{} : check_rate(*rate, table.path() + "/rate_hz");
}

Status read_events(Input& in, std::vector<data::Event>& out) {
  const TableIn table = module_table(in, kEventsTable);
  if (!table) return {};
  auto labels = table.texts("label");
  if (!labels) return std::unexpected(labels.error());
  auto contexts = table.texts("context", labels->size());
  if (!contexts) return std::unexpected(contexts.error());
  const auto times = table.numbers("timestamp", labels->size());
  if (!times) return std::unexpected(times.error());
  if (!in.afford(labels->size(), sizeof(data::Event))) return beyond_file(table.path());
  for (std::size_t i = 0; i < labels->size(); ++i)
    out.push_back(
        {.label = std::move((*labels)[i]), .context = std::move((*contexts)[i]), .time_s = (*times)[i]});
  return {};
}

/// Where plates lie, which they are, and in what their channels are.
Status read_geometry(const TableIn& table, std::vector<data::ForcePlate>& plates) {
  const std::size_t count = plates.size();
  const auto number = table.numbers("number", count), type = table.numbers("type", count),
             metres = table.numbers("metres_per_unit", count), corners = table.numbers("corners", count, 12),
             origin = table.numbers("origin", count, 3);
  for (const auto* column : {&number, &type, &metres, &corners, &origin})
    if (!*column) return std::unexpected(column->error());
  for (std::size_t i = 0; i < count; ++i) {
    data::ForcePlate& plate = plates[i];
    const auto as_number = table.whole("number", (*number)[i], 1, 255);
    if (!as_number) return std::unexpected(as_number.error());
    const auto as_type = table.whole("type", (*type)[i], 0, 255);
    if (!as_type) return std::unexpected(as_type.error());
    if (!((*metres)[i] > 0.0 && (*metres)[i] < 1e3))
      return table.bad("metres_per_unit", fmt::format("holds {}; need a length in metres", (*metres)[i]));
    plate.number = *as_number;
    plate.type = *as_type;
    plate.metres_per_unit = (*metres)[i];
    for (std::size_t c = 0; c < 4; ++c)
      plate.corners_in_world[c] = Eigen::Map<const Eigen::Vector3d>(corners->data() + 12 * i + 3 * c);
    plate.origin_in_plate = Eigen::Map<const Eigen::Vector3d>(origin->data() + 3 * i);
  }
  return {};
}

/// The channels of plates: `channels` are there.
Status read_wiring(const TableIn& table, std::size_t channels, std::vector<data::ForcePlate>& plates) {
  const auto wired = table.lists("channels", plates.size());
  if (!wired) return std::unexpected(wired.error());
  const std::size_t width = wired->size() / plates.size();
  for (std::size_t i = 0; i < wired->size(); ++i) {
    if ((*wired)[i] == -1.0) continue;
    const auto at = table.whole("channels", (*wired)[i], -1, static_cast<int>(channels) - 1);
    if (!at) return std::unexpected(at.error());
    plates[i / width].channel_idx.push_back(*at);
  }
  return {};
}

Status read_calibration(const TableIn& table, std::vector<data::ForcePlate>& plates) {
  const std::size_t count = plates.size();
  const auto values = table.lists("calibration", count);
  const auto sizes = table.numbers("calibration_values", count),
             rows = table.numbers("calibration_rows", count);
  for (const auto* column : {&values, &sizes, &rows})
    if (!*column) return std::unexpected(column->error());
  const std::size_t width = values->size() / count;
  for (std::size_t i = 0; i < count; ++i) {
    const auto size = table.whole("calibration_values", (*sizes)[i], 0, static_cast<int>(width));
    if (!size) return std::unexpected(size.error());
    const auto of = table.whole("calibration_rows", (*rows)[i], 0, 255);
    if (!of) return std::unexpected(of.error());
    const double* from = values->data() + width * i;
    plates[i].calibration.assign(from, from + *size);
    plates[i].calibration_rows = *of;
  }
  return {};
}

/// What corrects the centre of pressure, 12 numbers; rows of NaN, or no such column: nothing does.
Status read_pressure_correction(const TableIn& table, std::vector<data::ForcePlate>& plates) {
  constexpr const char* kColumn = "pressure_correction";
  constexpr std::size_t kNumbers = 12;
  if (!table.has(kColumn)) return {};
  const auto values = table.numbers(kColumn, plates.size(), kNumbers);
  if (!values) return std::unexpected(values.error());
  for (std::size_t i = 0; i < plates.size(); ++i) {
    const std::span row(values->data() + kNumbers * i, kNumbers);
    const auto known = std::ranges::count_if(row, [](double v) { return std::isfinite(v); });
    if (known > 0 && std::cmp_less(known, kNumbers))
      return table.bad(kColumn, fmt::format("has {} of {} numbers in row {}", known, kNumbers, i + 1));
    if (known > 0) plates[i].pressure_correction.assign(row.begin(), row.end());
  }
  return {};
}

Status read_plates(Input& in, std::size_t channels, std::vector<data::ForcePlate>& out) {
  const TableIn table = module_table(in, kPlatesTable);
  if (!table) return {};
  const Handle numbers = in.object(in.file(), table.path() + "/number");
  const auto shape = in.number_shape(numbers.id());
  if (!shape || shape->size() != 1 || shape->front() < 1 || std::cmp_greater(shape->front(), kMostPlates))
    return table.bad("number", fmt::format("does not hold numbers of 1 to {} plates", kMostPlates));
  out.resize(static_cast<std::size_t>(shape->front()));
  if (auto s = read_geometry(table, out); !s) return s;
  if (auto s = read_wiring(table, channels, out); !s) return s;
  if (auto s = read_calibration(table, out); !s) return s;
  return read_pressure_correction(table, out);
}

Status read_unloaded(Input& in, std::array<double, 2>& out) {
  const TableIn table(in, fmt::format("{}/{}", kIntervals, kUnloaded));
  if (!table) return {};
  const auto first = table.numbers("start_time", 1), last = table.numbers("stop_time", 1);
  if (!first) return std::unexpected(first.error());
  if (!last) return std::unexpected(last.error());
  out = {first->front(), last->front()};
  return {};
}

}  // namespace

Status read_signals(Input& in, data::Trial& trial) {
  if (auto s = read_channels(in, trial); !s) return s;
  if (auto s = read_analog(in, trial.analog); !s) return s;
  if (auto s = read_events(in, trial.events); !s) return s;
  if (auto s = read_plates(in, trial.analog.names.size(), trial.force_plates); !s) return s;
  return read_unloaded(in, trial.unloaded_s);
}

}  // namespace kinemark::io::internal
