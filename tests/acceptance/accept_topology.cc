// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Which markers share a segment and which segments a joint: random chains, the sleeve, people.
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/stages/simulation/limb.h"
#include "kinemark/stages/skeleton/topology/topology.h"
#include "support/acceptance.h"
#include "support/test_data.h"

namespace {

using namespace kinemark;
using testing_support::print_row;
namespace fs = std::filesystem;

/// Segments of a layout as sets of markers; those in `without` left out.
std::set<std::set<int>> marker_sets(const data::SegmentLayout& layout, const std::set<int>& without = {}) {
  std::set<std::set<int>> sets;
  for (const auto& segment : layout.segments) {
    std::set<int> set;
    for (const int m : segment.markers)
      if (!without.contains(m)) set.insert(m);
    if (!set.empty()) sets.insert(set);
  }
  return sets;
}

/// Joints as pairs of first markers, whatever the direction.
std::set<std::pair<int, int>> joint_pairs(const data::SegmentLayout& layout) {
  std::set<std::pair<int, int>> pairs;
  for (const auto& joint : layout.joints) {
    const auto first = [&](int s) {
      return std::ranges::min(layout.segments[static_cast<std::size_t>(s)].markers);
    };
    pairs.insert(std::minmax(first(joint.parent), first(joint.child)));
  }
  return pairs;
}

void chains() {
  int right = 0, count = 0, trees = 0;
  double least_nats = 1e9, least_margin = 1e9;
  std::string wrong;
  for (const bool four : {false, true})
    for (const double noise_mm : {0.5, 2.0, 5.0})
      for (const double missing : {0.0, 0.2, 0.4})
        for (std::uint64_t seed = 701; seed <= 705; ++seed) {
          simulation::ChainOptions options{.frames = 400,
                                           .stagger_m = 0.02,
                                           .noise_sd_m = 1e-3 * noise_mm,
                                           .missing = missing,
                                           .seed = seed};
          if (four) {
            options.lengths_m = {0.120, 0.150, 0.160, 0.080};
            options.markers_per_segment = 4;
          }
          const auto recording = simulation::simulate_chain(options).value();
          const auto found = skeleton::find_topology(recording.markers).value();
          const bool segments = marker_sets(found.layout) == marker_sets(recording.layout);
          const bool tree = segments && joint_pairs(found.layout) == joint_pairs(recording.layout);
          ++count;
          right += segments;
          trees += tree;
          if (!tree)
            wrong += fmt::format(" ({} segments, {} mm, {} missing, seed {})", four ? 4 : 2, noise_mm,
                                 missing, seed);
          for (const auto& marker : found.markers) least_nats = std::min(least_nats, marker.nats);
          for (const auto& joint : found.joints) least_margin = std::min(least_margin, joint.margin);
        }
  print_row(right == count, "random chains, 2 x 3 and 4 x 4 markers, 0.5-5 mm, 0-40 % missing: segments",
            "90 of 90 right",
            fmt::format("{} of {}; least evidence {:.0f} nats{}", right, count, least_nats, wrong));
  print_row(trees == count, "the same: joints", "90 of 90 right",
            fmt::format("{} of {}; least margin {:.1f}", trees, count, least_margin));
}

void sleeve() {
  for (const bool hard : {false, true})
    for (const double noise_mm : {0.5, 2.0, 5.0}) {
      int right = 0, reported = 0, tree = 0, fragments = 0, silent = 0;
      double least = 1e9;
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        simulation::SleeveOptions options{.duration_s = 30.0, .noise_sd_m = 1e-3 * noise_mm, .seed = seed};
        if (hard) {
          options.sight_cosine = 0.5;
          options.missing = 0.2;
        }
        const auto recording = simulation::simulate_sleeve(options).value();
        const auto found = skeleton::find_topology(recording.markers).value();
        // Each marker belongs where most of its segment's markers are from; the others must be doubtful.
        bool all = found.layout.segments.size() == 2, honest = true;
        std::vector<int> limb;  // of each found segment
        std::vector<int> of(static_cast<std::size_t>(recording.markers.markers()), -1);
        for (std::size_t s = 0; s < recording.layout.segments.size(); ++s)
          for (const int m : recording.layout.segments[s].markers)
            of[static_cast<std::size_t>(m)] = static_cast<int>(s);
        for (const auto& segment : found.layout.segments) {
          int upper = 0;
          for (const int m : segment.markers) upper += of[static_cast<std::size_t>(m)] == 0;
          const int most = 2 * upper > static_cast<int>(segment.markers.size()) ? 0 : 1;
          limb.push_back(most);
          for (const int m : segment.markers) {
            least = std::min(least, found.markers[static_cast<std::size_t>(m)].nats);
            if (of[static_cast<std::size_t>(m)] == most) continue;
            all = false;
            honest = honest && found.markers[static_cast<std::size_t>(m)].doubtful;
          }
        }
        // Of the pieces of one limb part the largest is the part; doubt is due at each of the others.
        for (std::size_t s = 0; s < limb.size(); ++s) {
          const auto& segments = found.layout.segments;
          bool piece = false;
          for (std::size_t o = 0; o < limb.size(); ++o) {
            const auto size = segments[s].markers.size(), other = segments[o].markers.size();
            piece = piece || (o != s && limb[o] == limb[s] && (other > size || (other == size && o < s)));
          }
          if (!piece) continue;
          bool doubt = std::ranges::any_of(segments[s].markers, [&](int m) {
            return found.markers[static_cast<std::size_t>(m)].doubtful;
          });
          for (std::size_t j = 0; j < found.layout.joints.size(); ++j) {
            const auto& joint = found.layout.joints[j];
            const bool here = joint.parent == static_cast<int>(s) || joint.child == static_cast<int>(s);
            doubt = doubt || (here && found.joints[j].doubtful);
          }
          ++fragments;
          silent += !doubt;
        }
        right += all;
        reported += honest;
        tree += found.layout.joints.size() == found.layout.segments.size() - 1;
      }
      print_row(
          reported == 3 && silent == 0 && tree == 3 && (hard || noise_mm > 0.5 || right == 3),
          fmt::format("sleeve of 16 LEDs, {}{} mm", hard ? "harder sight, " : "", noise_mm),
          hard || noise_mm > 0.5 ? "one tree; wrong markers and pieces of a segment called doubtful"
                                 : "one tree; segments right in 3 of 3",
          fmt::format("two segments, all right in {} of 3, every wrong marker doubtful in {} of 3, {} of "
                      "{} pieces without doubt, one tree in {} of 3, least evidence {:.1f} nats",
                      right, reported, silent, fragments, tree, least));
    }
}

/// Where a marker of a Plug-in Gait or CMU set may lie: markers over a joint lie on both sides of it.
const std::map<std::string, std::vector<std::string>>& anatomy() {
  static const std::map<std::string, std::vector<std::string>> parts = {{"FHD", {"head"}},
                                                                        {"BHD", {"head"}},
                                                                        {"C7", {"thorax"}},
                                                                        {"T10", {"thorax"}},
                                                                        {"CLAV", {"thorax"}},
                                                                        {"STRN", {"thorax"}},
                                                                        {"RBAC", {"thorax"}},
                                                                        {"RBAK", {"thorax"}},
                                                                        {"SHO", {"thorax", "upper arm"}},
                                                                        {"UPA", {"upper arm"}},
                                                                        {"ELB", {"upper arm", "forearm"}},
                                                                        {"FRM", {"forearm"}},
                                                                        {"WRA", {"forearm", "hand"}},
                                                                        {"WRB", {"forearm", "hand"}},
                                                                        {"FIN", {"hand"}},
                                                                        {"BWT", {"pelvis"}},
                                                                        {"FWT", {"pelvis"}},
                                                                        {"ASI", {"pelvis"}},
                                                                        {"PSI", {"pelvis"}},
                                                                        {"THI", {"thigh"}},
                                                                        {"KNE", {"thigh", "shank"}},
                                                                        {"SHN", {"shank"}},
                                                                        {"TIB", {"shank"}},
                                                                        {"ANK", {"shank", "foot"}},
                                                                        {"HEE", {"foot"}},
                                                                        {"MT5", {"foot"}},
                                                                        {"TOE", {"foot"}}};
  return parts;
}

/// Body segments that a marker may lie on: "L thigh", ...; empty for unknown names.
std::vector<std::string> parts_of(std::string name) {
  if (const auto colon = name.rfind(':'); colon != std::string::npos) name = name.substr(colon + 1);
  if (const auto whole = anatomy().find(name); whole != anatomy().end()) return whole->second;
  if (name.empty() || (name[0] != 'L' && name[0] != 'R')) return {};
  const auto found = anatomy().find(name.substr(1));
  if (found == anatomy().end()) return {};
  std::vector<std::string> parts;
  for (const auto& part : found->second)
    parts.push_back(part == "head" || part == "thorax" || part == "pelvis" ? part
                                                                           : name.substr(0, 1) + " " + part);
  return parts;
}

bool adjacent(const std::string& a, const std::string& b) {
  if (a == b) return true;
  static const std::set<std::pair<std::string, std::string>> joints = {
      {"head", "thorax"},  {"pelvis", "thorax"}, {"thorax", "upper arm"}, {"forearm", "upper arm"},
      {"forearm", "hand"}, {"pelvis", "thigh"},  {"shank", "thigh"},      {"foot", "shank"}};
  const auto bare = [](const std::string& s) { return s.size() > 2 && s[1] == ' ' ? s.substr(2) : s; };
  const auto side = [](const std::string& s) { return s.size() > 2 && s[1] == ' ' ? s[0] : ' '; };
  if (side(a) != ' ' && side(b) != ' ' && side(a) != side(b)) return false;
  const std::pair<std::string, std::string> pair = std::minmax(bare(a), bare(b));
  return joints.contains(pair);
}

/// SD of the distance of two markers, m.
double distance_sd(const data::Trajectories& markers, int a, int b) {
  double sum = 0.0, squares = 0.0, n = 0.0;
  for (std::int64_t f = 0; f < markers.frames(); ++f) {
    if (!markers.present(f, a) || !markers.present(f, b)) continue;
    const double d = (markers.x(f, a) - markers.x(f, b)).norm();
    sum += d;
    squares += d * d;
    n += 1.0;
  }
  return n > 0.0 ? std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n))) : 0.0;
}

/// Neighbouring body parts whose markers' distances vary less do not move against each other in a recording.
constexpr double kStill_m = 0.010;

/// `moves`: the recording shows enough motion to require segments; otherwise none may be found.
void person(const fs::path& file, bool moves) {
  auto trial = io::read_markers(file).value();
  // Only the markers of the body: the file may hold computed points as well.
  std::vector<std::string> names;
  for (const auto& name : trial.markers.names)
    if (!parts_of(name).empty()) names.push_back(name);
  auto markers = data::Trajectories::all_missing(names, trial.markers.time);
  for (std::int64_t f = 0; f < markers.frames(); ++f)
    for (std::int64_t m = 0; m < markers.markers(); ++m) {
      const auto from = trial.markers.find(names[static_cast<std::size_t>(m)]);
      if (!trial.markers.present(f, from)) continue;
      markers.x(f, m) = trial.markers.x(f, from);
      markers.state[markers.index(f, m)] = data::SampleState::measured;
    }
  const auto found = skeleton::find_topology(markers).value();
  const std::string label = file.filename().string();
  if (!moves) {
    print_row(found.layout.segments.size() == 1 && !found.warnings.empty(),
              label + ", a person who stands still", "nothing claimed, and said so",
              found.warnings.empty() ? fmt::format("{} segments", found.layout.segments.size())
                                     : found.warnings.back());
    return;
  }
  if (found.layout.segments.size() < 2) {
    print_row(false, label + ", segments as anatomy has them", "more than one", "one");
    return;
  }
  std::vector<std::string> part;  // of each found segment: where most of its markers may lie
  int wrong = 0, hidden = 0, doubtful = 0, still = 0;
  std::string list;
  for (const auto& segment : found.layout.segments) {
    std::map<std::string, int> votes;
    for (const int m : segment.markers)
      for (const auto& p : parts_of(names[static_cast<std::size_t>(m)])) ++votes[p];
    const auto most = std::ranges::max_element(votes, {}, [](const auto& v) { return v.second; })->first;
    part.push_back(most);
    for (const int m : segment.markers) {
      const auto& evidence = found.markers[static_cast<std::size_t>(m)];
      doubtful += evidence.doubtful;
      if (std::ranges::count(parts_of(names[static_cast<std::size_t>(m)]), most)) continue;
      // A neighbour that does not move against the segment here: the recording shows one segment.
      bool near = true;
      for (const auto& p : parts_of(names[static_cast<std::size_t>(m)])) near = near && adjacent(p, most);
      double spread = 0.0;
      for (const int other : segment.markers) spread = std::max(spread, distance_sd(markers, m, other));
      if (near && spread < kStill_m) {
        ++still;
        continue;
      }
      ++wrong;
      hidden += !evidence.doubtful;
      list += fmt::format(" {} on {} ({:.1f} nats)", names[static_cast<std::size_t>(m)], most, evidence.nats);
    }
  }
  print_row(
      hidden == 0 && wrong <= static_cast<int>(names.size()) / 10, label + ", segments as anatomy has them",
      "at most 10 % of markers elsewhere, all of those called doubtful",
      fmt::format(
          "{} markers in {} segments; {} elsewhere, {} of them not called doubtful; {} with a neighbour "
          "that does not move; {} doubtful in all",
          names.size(), found.layout.segments.size(), wrong, hidden, still, doubtful) +
          list);
  int bad = 0, quiet = 0, unsure = 0;
  list.clear();
  for (std::size_t j = 0; j < found.layout.joints.size(); ++j) {
    const auto& joint = found.layout.joints[j];
    const auto& a = part[static_cast<std::size_t>(joint.parent)];
    const auto& b = part[static_cast<std::size_t>(joint.child)];
    unsure += found.joints[j].doubtful;
    if (adjacent(a, b)) continue;
    ++bad;
    quiet += !found.joints[j].doubtful;
    list += fmt::format(" {}-{} ({:.2f})", a, b, found.joints[j].margin);
  }
  print_row(quiet == 0, label + ", joints as anatomy has them", "wrong ones called doubtful",
            fmt::format("{} joints; {} between segments that are no neighbours, {} of them not called "
                        "doubtful; {} doubtful in all;{}",
                        found.layout.joints.size(), bad, quiet, unsure, list));
}

int run_check(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "all";
  if (what != "people") {
    chains();
    sleeve();
  }
  if (what == "simulated") return testing_support::exit_status();
  const auto data = testing_support::test_data_folder();
  if (!data) return testing_support::skip_all("topology of people");
  for (const auto* file : {"cmu-mocap/cmu_02_05.c3d", "cmu-mocap/85_02.c3d"}) person(*data / file, true);
  person(*data / "pycgm-rom/Sample_Static.c3d", false);
  // No row for pycgm-rom: the data hold no recording of this marker set in which the person moves through the
  // joints' ranges, only a static trial.
  return testing_support::exit_status();
}

const kinemark::testing_support::AcceptanceCheck kCheck("topology", run_check);

}  // namespace
