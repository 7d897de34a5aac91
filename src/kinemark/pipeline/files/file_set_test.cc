// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/pipeline/files/file_set.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "kinemark/io/c3d/reader.h"
#include "kinemark/io/file.h"
#include "kinemark/io/osim/osim_writer.h"
#include "kinemark/io/text/table_file.h"
#include "kinemark/io/text/trc.h"
#include "kinemark/pipeline/files/result_files.h"
#include "support/scratch.h"

namespace kinemark::pipeline {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kSet = "0123456789abcdef";
constexpr const char* kOther = "fedcba9876543210";

data::Table small_table() {
  data::Table table;
  table.name = "t";
  table.columns = {"knee"};
  table.time_s = {0.0, 0.01};
  table.values = {1.0, 2.0};
  return table;
}

data::Trial small_trial() {
  data::Trial trial;
  trial.markers = data::Trajectories::all_missing({"a"}, {.rate_hz = 100.0, .frames = 3});
  return trial;
}

/// Write a file of a result as a member of a set.
void put(const ResultFile& file, const std::string& set) { ASSERT_TRUE(file.write(file.target, set)); }

TEST(FileSet, EveryFormatButCsvNamesItsSet) {
  const testing_support::ScratchFolder scratch;
  const auto trial = small_trial();
  const std::string model = io::format_osim({.name = "m"}).value();
  put(table_file(scratch / "q.mot", small_table), kSet);
  put(json_file(scratch / "q.json", [] { return nlohmann::ordered_json{{"format", "x"}}; }), kSet);
  put(toml_file(scratch / "q.toml", [] { return std::string("a = 1\n"); }), kSet);
  for (const char* name : {"q.c3d", "q.trc", "q.nwb"}) put(marker_file(scratch / name, trial), kSet);
  put(model_file(scratch / "q.osim", model), kSet);
  for (const char* name : {"q.mot", "q.json", "q.toml", "q.c3d", "q.trc", "q.nwb", "q.osim"})
    EXPECT_EQ(set_in(scratch / name), kSet) << name;
  put(marker_file(scratch / "q.csv", trial), kSet);
  EXPECT_EQ(set_in(scratch / "q.csv"), "");
}

TEST(FileSet, ReadersPassTheMarkOver) {
  const testing_support::ScratchFolder scratch;
  const auto trial = small_trial();
  put(marker_file(scratch / "with.c3d", trial), kSet);
  put(marker_file(scratch / "with.trc", trial), kSet);
  EXPECT_THAT(io::read_c3d(scratch / "with.c3d").value().warnings, ElementsAre());
  put(marker_file(scratch / "without.trc", trial), "");
  EXPECT_EQ(io::read_trc(scratch / "with.trc").value().warnings,
            io::read_trc(scratch / "without.trc").value().warnings);
  put(table_file(scratch / "with.mot", small_table), kSet);
  EXPECT_THAT(io::read_table(scratch / "with.mot").value().warnings, ElementsAre());
}

/// Put other digits in the place of these, where they occur last.
void change(const fs::path& file, const std::string& digits, const std::string& others) {
  auto text = io::read_text(file).value();
  const auto at = text.rfind(digits);
  ASSERT_NE(at, std::string::npos);
  ASSERT_TRUE(io::write_text(file, text.replace(at, digits.size(), others), true));
}

constexpr const char* kChanged = "its content is not what was written: kinemark_sum does not fit";

TEST(FileSet, AChangedDigitIsFoundByReaders) {
  const testing_support::ScratchFolder scratch;
  auto trial = small_trial();
  trial.markers.x(0, 0) = Eigen::Vector3d(0.1, 0.2, 0.3);
  trial.markers.state[0] = data::SampleState::measured;
  put(marker_file(scratch / "a.trc", trial), kSet);
  put(table_file(scratch / "q.mot", small_table), kSet);
  EXPECT_THAT(io::read_table(scratch / "q.mot")->warnings, Not(Contains(HasSubstr(kChanged))));
  EXPECT_THAT(io::read_trc(scratch / "a.trc")->warnings, Not(Contains(HasSubstr(kChanged))));
  change(scratch / "q.mot", "2", "3");
  change(scratch / "a.trc", "200", "201");
  EXPECT_THAT(io::read_table(scratch / "q.mot")->warnings, Contains(HasSubstr(kChanged)));
  EXPECT_THAT(io::read_trc(scratch / "a.trc")->warnings, Contains(HasSubstr(kChanged)));
}

TEST(FileSet, AMemberThatWasChangedIsNotUsedWithOthers) {
  const testing_support::ScratchFolder scratch;
  put(table_file(scratch / "q.mot", small_table), kSet);
  put(table_file(scratch / "q_sd.sto", small_table), kSet);
  const auto report =
      json_file(scratch / "q_report.json", [] { return nlohmann::ordered_json{{"frames", 1}}; });
  put(report, kSet);
  const std::vector<SetMember> members{{scratch / "q.mot", kSet}, {scratch / "q_report.json", kSet}};
  EXPECT_TRUE(check_same_set(members));
  EXPECT_THAT(find_changed(scratch / "q_sd.sto"), ElementsAre());
  change(scratch / "q_report.json", "1", "2");
  const auto refused = check_same_set(members);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, AllOf(HasSubstr("q_report.json: "), HasSubstr(kChanged)));
  for (const char* name : {"q_sd.sto", "q_report.json"})
    EXPECT_THAT(find_changed(scratch / name), ElementsAre(HasSubstr(kChanged))) << name;
  EXPECT_THAT(find_strangers(scratch / "q_sd.sto"), ElementsAre());
}

// Whoever converts a table takes it out of its set.
TEST(FileSet, ATableThatIsWrittenAnewNamesNoSet) {
  const testing_support::ScratchFolder scratch;
  put(table_file(scratch / "q.mot", small_table), kSet);
  ASSERT_TRUE(io::write_table(scratch / "r.mot", io::read_table(scratch / "q.mot").value()));
  EXPECT_EQ(set_in(scratch / "r.mot"), "");
  EXPECT_THAT(io::read_table(scratch / "r.mot")->warnings, ElementsAre());
}

TEST(FileSet, FilesWithoutAMarkNameNone) {
  const testing_support::ScratchFolder scratch;
  EXPECT_EQ(set_in(scratch / "absent"), "");
  for (const char* text :
       {"", "kinemark_set", "kinemark_set=", "kinemark_set=0123", "kinemark_set=0123456789abcdeg"}) {
    ASSERT_TRUE(io::write_text(scratch / "text", text, true));
    EXPECT_EQ(set_in(scratch / "text"), "") << text;
  }
}

TEST(FileSet, TheMarkIsFoundWhereBlocksMeet) {
  const testing_support::ScratchFolder scratch;
  for (const std::size_t before : {(1UL << 20) - 80, (1UL << 20) - 40, (1UL << 20) - 5}) {
    ASSERT_TRUE(io::write_text(scratch / "x.nwb", std::string(before, ' ') + "kinemark_set=" + kSet, true));
    EXPECT_EQ(set_in(scratch / "x.nwb"), kSet);
  }
}

TEST(FileSet, MembersNameOneSetOrNone) {
  EXPECT_TRUE(check_same_set({{"a", kSet}, {"b", kSet}}));
  EXPECT_TRUE(check_same_set({{"a", ""}, {"b", ""}}));
  for (const auto& other : {kOther, ""}) {
    const auto mixed = check_same_set({{"q_report.json", kSet}, {"q.mot", kSet}, {"q_sd.sto", other}});
    ASSERT_FALSE(mixed);
    EXPECT_EQ(mixed.error().code, Code::bad_input);
    EXPECT_THAT(mixed.error().message, HasSubstr("q_sd.sto: was not written together with q_report.json"));
  }
}

TEST(FileSet, StrangersBesideAFileAreFound) {
  const testing_support::ScratchFolder scratch;
  put(table_file(scratch / "q.mot", small_table), kSet);
  put(table_file(scratch / "q_marker_errors.sto", small_table), kSet);
  put(table_file(scratch / "r_sd.sto", small_table), kOther);
  EXPECT_THAT(find_strangers(scratch / "q.mot"), Not(Contains(HasSubstr("was not written together with"))));
  put(table_file(scratch / "q_sd.sto", small_table), kOther);
  EXPECT_THAT(find_strangers(scratch / "q.mot"),
              ElementsAre(HasSubstr("q_sd.sto: was not written together with")));
  EXPECT_EQ(find_strangers(scratch / "q_sd.sto").size(), 2U);
}

TEST(FileSet, StrangersAreFoundByTheNamesOfAFolder) {
  const testing_support::ScratchFolder scratch;
  const auto trial = small_trial();
  put(marker_file(scratch / "markers.c3d", trial), kSet);
  put(marker_file(scratch / "markers.trc", trial), kSet);
  put(table_file(scratch / "truth.mot", small_table), kSet);
  const std::string scaled = io::format_osim({.name = "scaled"}).value();
  put(model_file(scratch / "model.osim", scaled), kOther);
  EXPECT_THAT(find_strangers(scratch / "markers.c3d"), ElementsAre())
      << "a model is replaced by its scaled one";
  put(marker_file(scratch / "truth.trc", trial), kOther);
  for (const char* name : {"markers.c3d", "markers.trc", "truth.mot"})
    EXPECT_THAT(find_strangers(scratch / name),
                ElementsAre(HasSubstr("truth.trc: was not written together with")))
        << name;
  EXPECT_EQ(find_strangers(scratch / "truth.trc").size(), 3U);
}

TEST(SetDigest, IsOfContentAndOfNothingElse) {
  const auto digest = [](double value, const char* text) {
    return SetDigest().add(text).add(std::array{value, 2.0}).hex();
  };
  EXPECT_EQ(digest(1.0, "a"), digest(1.0, "a"));
  EXPECT_NE(digest(1.0, "a"), digest(-1.0, "a"));
  EXPECT_NE(digest(0.0, "a"), digest(-0.0, "a"));
  EXPECT_NE(digest(1.0, "a"), digest(1.0, "b"));
  EXPECT_NE(SetDigest().add("ab").add("c").hex(), SetDigest().add("a").add("bc").hex());
  EXPECT_EQ(SetDigest().hex().size(), 16U);
  auto moved = small_trial().markers;
  moved.time.t0_s = 1.0;
  EXPECT_NE(SetDigest().add(small_trial().markers).hex(), SetDigest().add(moved).hex());
}

}  // namespace
}  // namespace kinemark::pipeline
