// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// Real recordings: the findings were checked by hand and are real; there are no others.
#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "kinemark/io/markers/marker_file.h"
#include "kinemark/stages/trajectory/screening/screen.h"
#include "support/test_data.h"

namespace kinemark::trajectory {
namespace {

using data::FindingKind;

/// "defect marker first-last", runs of repeated frames as one.
std::set<std::string> summary(const data::Trajectories& t) {
  std::set<std::string> lines;
  const auto findings = screen(t).value();
  for (const data::Finding& f : findings) {
    std::string line(to_string(f.kind));
    if (!f.subject.empty())
      line += " " + f.subject + " " + std::to_string(f.first_frame) + "-" + std::to_string(f.last_frame);
    lines.insert(line);
  }
  return lines;
}

TEST(ScreenRealRecordings, OnlyGenuineDefectsAreCalled) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const std::set<std::string> foot{"spike RSK1 153-153"};  // 42 mm for one frame; the same trial ten times
  const std::map<std::string, std::set<std::string>> genuine{
      {"FunctionalWalk.c3d", {"spike RT01 120-120"}},
      {"Gait.trc", {"spike R.Heel 328-329", "spike R.Heel 400-400"}},
      // Points of a slower stream, each held for one or two frames.
      {"badParameterOffset.c3d", {"duplicated frame"}},
      // 120 Hz written as 100 Hz: every sixth frame is left out.
      {"mocap36.c3d", {"clock jump"}},
      {"Eb015pi.c3d", foot},
      {"Eb015pr.c3d", foot},
      {"Eb015si.c3d", foot},
      {"Eb015sr.c3d", foot},
      {"Eb015vi.c3d", foot},
      {"Eb015vr.c3d", foot},
      {"TESTAPI.c3d", foot},
      {"TESTBPI.c3d", foot},
      {"TESTCPI.c3d", foot},
      {"TESTDPI.c3d", foot},
      {"cmu_02_05.c3d", {"spike TakeoMonday:STRN 1235-1236"}},
      {"walkingOptiTrack.c3d", {"label swap Foot_Marker3 1952-1952", "spike Knee_Marker3 2522-2523"}},
      // Toe and fifth metatarsal in every third frame: the distance to the heel tells.
      {"motion_capture_run.trc", {"label swap RTOE 0-121"}},
      // The last value repeated to the end of the file.
      {"dataWithNaNsWithSpaces.trc", {"stuck LMEL 408-426"}},
  };
  int files = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(data)) {
    std::string ending = entry.path().extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (ending != ".c3d" && ending != ".trc") continue;
    const auto trial = io::read_markers(entry.path());
    if (!trial) continue;
    ++files;
    const std::string name = entry.path().filename().string();
    const auto known = genuine.find(name);
    EXPECT_EQ(summary(trial->markers), known == genuine.end() ? std::set<std::string>{} : known->second)
        << name;
  }
  EXPECT_GT(files, 50);
}

TEST(ScreenRealRecordings, ZerosWrittenForAMarkerThatWasNeverSeen) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  auto trial = io::read_markers(data / "opensim-hamner-fullbody" / "subject02_running.trc").value();
  const std::int64_t bicep = trial.markers.find("L.Bicep");
  ASSERT_GE(bicep, 0);
  // The reader takes the zeros for what they are; put them back as the file has them.
  for (std::int64_t f = 0; f < trial.markers.frames(); ++f) {
    ASSERT_FALSE(trial.markers.present(f, bicep));
    trial.markers.x(f, bicep).setZero();
    trial.markers.state[trial.markers.index(f, bicep)] = data::SampleState::measured;
  }
  const auto findings = screen(trial.markers).value();
  ASSERT_EQ(findings.size(), 1U);
  EXPECT_EQ(findings[0].kind, FindingKind::zero);
  EXPECT_EQ(findings[0].subject, trial.markers.names[static_cast<std::size_t>(bicep)]);
}

}  // namespace
}  // namespace kinemark::trajectory
