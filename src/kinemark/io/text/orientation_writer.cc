// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <string>
#include <string_view>

#include "kinemark/core/index.h"
#include "kinemark/io/file.h"
#include "kinemark/io/text/internal/cells.h"
#include "kinemark/io/text/orientation_table.h"

namespace kinemark::io {
namespace {

/// Seconds to a billionth, without what rounding leaves behind: 0.1, not 0.10000000000000001.
double time_of(const data::Orientations& what, std::int64_t f) {
  return std::round(1e9 * what.time.time_s(f)) / 1e9;
}

/// How a table sets its cells.
struct Cells {
  char before_sensor;        ///< between the time, or a sensor, and the next
  std::string_view missing;  ///< the four numbers of a sample that is none
};

void put_rows(const data::Orientations& what, const Cells& cells, std::string& out) {
  const auto to = std::back_inserter(out);
  for (std::int64_t f = 0; f < what.frames(); ++f) {
    fmt::format_to(to, "\n{}", time_of(what, f));
    for (std::int64_t s = 0; s < what.size(); ++s) {
      const double* q = what.quaternion.data() + 4 * (f * what.size() + s);
      out += cells.before_sensor;
      if (what.present(f, s))
        fmt::format_to(to, "{},{},{},{}", q[0], q[1], q[2], q[3]);
      else
        out += cells.missing;
    }
  }
  out += '\n';
}

std::string opensense_text(const data::Orientations& what) {
  std::string out = fmt::format(
      "DataRate={}\nDataType=Quaternion\nversion=3\nOpenSimVersion=4.1\nendheader\ntime", what.time.rate_hz);
  for (const auto& name : what.names) out += "\t" + name;
  put_rows(what, {.before_sensor = '\t', .missing = "NaN,NaN,NaN,NaN"}, out);
  return out;
}

std::string csv_text(const data::Orientations& what) {
  std::string out = "time";
  for (const auto& name : what.names) out += fmt::format(",{0}_w,{0}_x,{0}_y,{0}_z", name);
  put_rows(what, {.before_sensor = ',', .missing = ",,,"}, out);
  return out;
}

}  // namespace

Status write_orientations(const std::filesystem::path& path, const data::Orientations& what, bool force) {
  if (auto s = what.validate(); !s) return s;
  for (const auto& name : what.names)
    if (name.find_first_of("\t,;\"\r\n") != std::string::npos)
      return fail(Code::bad_input,
                  fmt::format("the name '{}' holds a tab, comma, semicolon, quote or line end",
                              internal::excerpt(name)));
  const auto ending = internal::lower(path.extension().string());
  if (ending != ".sto" && ending != ".csv")
    return fail(Code::usage,
                fmt::format("{}: orientations are written as .sto (OpenSense) or .csv", path.string()));
  return write_text(path, ending == ".sto" ? opensense_text(what) : csv_text(what), force);
}

}  // namespace kinemark::io
