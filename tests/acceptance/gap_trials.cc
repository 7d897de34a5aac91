// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "acceptance/gap_trials.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>

#include "kinemark/core/random.h"
#include "kinemark/io/markers/marker_file.h"

namespace kinemark::testing_support {
namespace {

/// Tab-separated text of Qualisys Track Manager, mm; 0 0 0, "null" or nothing where not seen.
data::Trajectories read_qtm(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<std::string> names;
  double rate_hz = 0.0;
  std::vector<std::vector<double>> rows;
  for (std::string line; std::getline(file, line);) {
    while (!line.empty() && (line.back() == '\r' || line.back() == '\t')) line.pop_back();
    std::istringstream cells(line);
    std::vector<std::string> cell;
    for (std::string c; std::getline(cells, c, '\t');) cell.push_back(c);
    if (cell.empty()) continue;
    if (cell[0] == "FREQUENCY") rate_hz = std::stod(cell[1]);
    if (cell[0] == "MARKER_NAMES") names.assign(cell.begin() + 1, cell.end());
    if (names.empty() || cell.size() < 3 * names.size() ||
        std::isalpha(static_cast<unsigned char>(cell[0][0])) != 0)
      continue;
    std::vector<double> row;
    for (std::size_t k = cell.size() - 3 * names.size(); k < cell.size(); ++k)
      row.push_back(std::strtod(cell[k].c_str(), nullptr));
    rows.push_back(std::move(row));
  }
  auto out = data::Trajectories::all_missing(
      names, {.rate_hz = rate_hz, .frames = static_cast<std::int64_t>(rows.size())});
  for (std::int64_t f = 0; f < out.frames(); ++f)
    for (std::int64_t m = 0; m < out.markers(); ++m) {
      const double* x = rows[static_cast<std::size_t>(f)].data() + 3 * m;
      if ((x[0] == 0.0 && x[1] == 0.0 && x[2] == 0.0) || !std::isfinite(x[0] + x[1] + x[2])) continue;
      out.x(f, m) = 1e-3 * Eigen::Vector3d(x[0], x[1], x[2]);
      out.state[out.index(f, m)] = data::SampleState::measured;
    }
  return out;
}

bool made_by_a_model(const std::string& name) {
  static const std::regex pattern(
      "(Angles|Force|Moment|Power|Score|Gamage|NM$|HipCenter|Center|CentreOf|^COM|CentroOfMass|_Ang|^\\*|GRF|"
      "Reaction|[LR][HKAE]JC$|^Mid_|v$|Virtual|^[LR](CL|FE|FO|HN|HU|RA|TI|TO)[OALP]$|^(PEL|TRX|HED)[OALP]$)",
      std::regex::icase);
  return std::regex_search(name, pattern);
}

double trimmed_sd(const data::Trajectories& t, std::int64_t a, std::int64_t b) {
  std::vector<double> d;
  const std::int64_t n = std::min<std::int64_t>(300, t.frames());
  for (std::int64_t i = 0; i < n; ++i) {
    const std::int64_t f = n == 1 ? 0 : i * (t.frames() - 1) / (n - 1);
    if (t.present(f, a) && t.present(f, b)) d.push_back((t.x(f, a) - t.x(f, b)).norm());
  }
  if (d.size() < 8 || 2 * static_cast<std::int64_t>(d.size()) < n) return HUGE_VAL;
  std::ranges::sort(d);
  const std::size_t trim = d.size() / 50;
  const double low = d[trim];
  const double high = d[d.size() - 1 - trim];
  double sum = 0.0;
  double square = 0.0;
  for (double& v : d) {
    v = std::clamp(v, low, high);
    sum += v;
  }
  for (const double v : d)
    square += (v - sum / static_cast<double>(d.size())) * (v - sum / static_cast<double>(d.size()));
  return std::sqrt(square / static_cast<double>(d.size()));
}

}  // namespace

const std::vector<std::string>& gap_trial_files() {
  static const std::vector<std::string> files = {"cmu-mocap/cmu_02_05.c3d",
                                                 "cmu-mocap/85_02.c3d",
                                                 "biobuddy/right_knee.c3d",
                                                 "kineticstoolkit/sample_propulsion.c3d",
                                                 "kineticstoolkit/walkingOptiTrack.c3d",
                                                 "pycgm-rom/Sample_Static.c3d",
                                                 "btk-others/FunctionalLHip.c3d",
                                                 "btk-others/FunctionalWalk.c3d",
                                                 "btk-others/PiG_Motion3_FF.c3d",
                                                 "btk-others/mocap36.c3d",
                                                 "btk-others/ADemo1_rewrite_c3d_pc_float.c3d",
                                                 "c3d-org/sample01/Eb015pr.c3d",
                                                 "c3d-org/sample13/Dance.c3d",
                                                 "c3d-org/sample18/bad_parameter_section.c3d",
                                                 "c3d-org/sample20/phasespace_sample.c3d",
                                                 "c3d-org/sample21/sample21.c3d",
                                                 "ezc3d-testFiles/FP_Type1.c3d",
                                                 "ezc3d-testFiles/Qualisys.c3d",
                                                 "opensim-core-formats/dataWithNaNsWithSpaces.trc",
                                                 "opensim-core-ik/abdbonepin.trc",
                                                 "opensim-gait2354/subject01_walk1.trc",
                                                 "opensim-hamner-fullbody/subject02_running.trc",
                                                 "dfki-hand/recording.tsv"};
  return files;
}

GapTrial load_gap_trial(const std::filesystem::path& data, const std::string& file, std::int64_t max_frames,
                        std::uint64_t seed, bool from_start) {
  data::Trajectories all;
  if (file.ends_with(".tsv")) {
    all = read_qtm(data / file);
  } else {
    auto read = io::read_markers(data / file);
    if (!read) throw std::runtime_error(read.error().message);
    all = std::move(read->markers);
  }
  std::vector<std::int64_t> kept;
  std::vector<std::string> names;
  for (std::int64_t m = 0; m < all.markers(); ++m) {
    std::int64_t seen = 0;
    for (std::int64_t f = 0; f < all.frames(); ++f) seen += all.present(f, m) ? 1 : 0;
    if (10 * seen < 3 * all.frames() || made_by_a_model(all.names[static_cast<std::size_t>(m)])) continue;
    kept.push_back(m);
    names.push_back(all.names[static_cast<std::size_t>(m)]);
  }
  const std::int64_t frames = std::min(max_frames, all.frames());
  std::int64_t first = 0;
  if (!from_start) {
    Random random(seed, 1);
    first = static_cast<std::int64_t>(random.uniform() * static_cast<double>(all.frames() - frames));
  }
  GapTrial trial{
      .file = file,
      .markers = data::Trajectories::all_missing(names, {.rate_hz = all.time.rate_hz, .frames = frames})};
  for (std::int64_t f = 0; f < frames; ++f)
    for (std::size_t k = 0; k < kept.size(); ++k) {
      if (!all.present(first + f, kept[k])) continue;
      const auto m = static_cast<std::int64_t>(k);
      trial.markers.x(f, m) = all.x(first + f, kept[k]);
      trial.markers.state[trial.markers.index(f, m)] = data::SampleState::measured;
    }
  return trial;
}

std::vector<std::int64_t> find_segment(const data::Trajectories& markers, std::int64_t marker) {
  std::vector<std::pair<double, std::int64_t>> order;
  for (std::int64_t k = 0; k < markers.markers(); ++k)
    if (k != marker) order.emplace_back(trimmed_sd(markers, marker, k), k);
  std::ranges::sort(order);
  std::vector<std::int64_t> segment = {marker};
  for (const auto& [sd, k] : order) {
    if (sd > 0.010 || segment.size() >= 6) break;
    if (std::all_of(segment.begin() + 1, segment.end(),
                    [&, k = k](std::int64_t m) { return trimmed_sd(markers, m, k) < 0.010; }))
      segment.push_back(k);
  }
  return segment;
}

bool complete(const data::Trajectories& markers, std::int64_t marker, std::int64_t first, std::int64_t end) {
  if (first < 0 || end > markers.frames()) return false;
  for (std::int64_t f = first; f < end; ++f)
    if (!markers.present(f, marker)) return false;
  return true;
}

}  // namespace kinemark::testing_support
