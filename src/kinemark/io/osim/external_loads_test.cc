// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/external_loads.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinemark/core/missing.h"
#include "kinemark/core/random.h"
#include "kinemark/io/file.h"
#include "kinemark/io/text/table_file.h"
#include "support/scratch.h"

namespace kinemark::io {
namespace {

using testing::HasSubstr;

std::string force_xml(const std::string& name, const std::string& inside) {
  return fmt::format("<ExternalForce name=\"{}\">{}</ExternalForce>", name, inside);
}

std::string loads_xml(const std::string& forces, const std::string& tail = "<datafile>walk.mot</datafile>") {
  return fmt::format(
      "<?xml version=\"1.0\"?><OpenSimDocument Version=\"40000\"><ExternalLoads "
      "name=\"walk\"><objects>{}</objects>"
      "<groups/>{}</ExternalLoads></OpenSimDocument>",
      forces, tail);
}

const std::string kRight = force_xml("right",
                                     "<applied_to_body>calcn_r</applied_to_body>"
                                     "<force_expressed_in_body>ground</force_expressed_in_body>"
                                     "<point_expressed_in_body>ground</point_expressed_in_body>"
                                     "<force_identifier>ground_force_v</force_identifier>"
                                     "<point_identifier>ground_force_p</point_identifier>"
                                     "<torque_identifier>ground_torque_</torque_identifier>");

/// Force 10 N + row, point 1 m + row, torque -row, at 0, 0.1, 0.2 s; then columns that look alike.
data::Table table() {
  data::Table t;
  t.columns = {"ground_force_vx", "ground_force_vy",  "ground_force_vz", "ground_force_px",
               "ground_force_py", "ground_force_pz",  "ground_torque_x", "ground_torque_y",
               "ground_torque_z", "1_ground_force_vx"};
  for (int row = 0; row < 3; ++row) {
    t.time_s.push_back(0.1 * row);
    for (int c = 0; c < 10; ++c)
      t.values.push_back(c < 3 ? 10.0 + c + row : c < 6 ? 1.0 + c + row : c < 9 ? -1.0 * row : 1e6);
  }
  return t;
}

TEST(ExternalLoads, AFileOfOpenSimWithItsTable) {
  const testing_support::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "loads.xml", loads_xml(kRight), false));
  const auto loads = read_external_loads(scratch / "loads.xml").value();
  ASSERT_EQ(loads.forces.size(), 1u);
  EXPECT_EQ(loads.forces[0].name, "right");
  EXPECT_EQ(loads.forces[0].body, "calcn_r");
  EXPECT_EQ(loads.data_file, scratch / "walk.mot");
  ASSERT_TRUE(write_table(loads.data_file, table()));
  const auto read = read_table(loads.data_file).value();
  const auto wrenches =
      sample_external_loads(loads, read, {.rate_hz = 20.0, .t0_s = 0.0, .frames = 5}).value();
  ASSERT_TRUE(wrenches.validate()) << wrenches.validate().error().message;
  const auto& wrench = wrenches.items.at(0);
  EXPECT_EQ(wrench.name, "right");
  EXPECT_EQ(wrench.body, "calcn_r");
  for (std::int64_t f = 0; f < 5; ++f)
    for (int axis = 0; axis < 3; ++axis) {
      const auto i = static_cast<std::size_t>(3 * f + axis);
      const double row = 0.5 * static_cast<double>(f);
      EXPECT_NEAR(wrench.force[i], 10.0 + axis + row, 1e-9);
      EXPECT_NEAR(wrench.point[i], 4.0 + axis + row, 1e-9);
      EXPECT_NEAR(wrench.moment[i], -row, 1e-9);
    }
}

TEST(ExternalLoads, NothingIsKnownOutsideTheTableOrBesideBlankCells) {
  const auto loads = parse_external_loads(loads_xml(kRight), "loads.xml").value();
  auto t = table();
  const auto early =
      sample_external_loads(loads, t, {.rate_hz = 10.0, .t0_s = -0.1, .frames = 5}).value().items.at(0);
  for (const int f : {0, 4}) EXPECT_TRUE(std::isnan(early.force[static_cast<std::size_t>(3 * f)]));
  for (const int f : {1, 2, 3}) EXPECT_FALSE(std::isnan(early.force[static_cast<std::size_t>(3 * f)])) << f;
  t.values[1] = kNaN;  // first row
  const auto blank = sample_external_loads(loads, t, {.rate_hz = 20.0, .frames = 5}).value().items.at(0);
  EXPECT_TRUE(std::isnan(blank.force[0]));
  EXPECT_TRUE(std::isnan(blank.force[3]));
  EXPECT_FALSE(std::isnan(blank.force[6]));  // a frame on a row does not use its neighbours
  t = table();
  t.values[13] = kNaN;  // the point of the second row
  const auto nowhere = sample_external_loads(loads, t, {.rate_hz = 10.0, .frames = 3}).value();
  EXPECT_TRUE(nowhere.validate());
  EXPECT_TRUE(std::isnan(nowhere.items.at(0).force[3]));
  t.time_s.clear();
  t.values.clear();
  EXPECT_TRUE(std::isnan(
      sample_external_loads(loads, t, {.rate_hz = 10.0, .frames = 1}).value().items.at(0).force[0]));
}

TEST(ExternalLoads, APointOfNothingDoesNotMoveTheNextOne) {
  // OpenSim's files hold a point of 0 0 0 while a foot is in the air.
  const auto loads = parse_external_loads(loads_xml(kRight), "loads.xml").value();
  auto t = table();
  for (std::size_t c = 0; c < 9; ++c) t.values[c] = 0.0;
  const auto wrench = sample_external_loads(loads, t, {.rate_hz = 20.0, .frames = 3}).value().items.at(0);
  EXPECT_EQ(wrench.force[0], 0.0);
  EXPECT_TRUE(std::isnan(wrench.point[0]));
  EXPECT_NEAR(wrench.force[3], 0.5 * 11.0, 1e-9);
  EXPECT_NEAR(wrench.point[3], 5.0, 1e-9);  // where the second row has it
}

TEST(ExternalLoads, ForcesAreFoundByTheNamesOfColumns) {
  const auto table_with = [](const std::vector<std::string>& names) {
    data::Table t;
    for (const auto& name : names)
      for (const char axis : {'x', 'y', 'z'}) t.columns.push_back(name + axis);
    t.time_s = {0.0, 0.1};
    for (std::size_t i = 0; i < 2 * t.columns.size(); ++i) t.values.push_back(static_cast<double>(i));
    return t;
  };
  for (const std::string torque : {"ground_torque_", "ground_moment_", "ground_force_m"}) {
    const auto t = table_with({"ground_force_v", "ground_force_p", torque, "1_ground_force_v",
                               "1_ground_force_p", "1_ground_torque_"});
    const auto loads = loads_of_columns(t, "grf.mot").value();
    ASSERT_EQ(loads.forces.size(), 2u);
    EXPECT_EQ(loads.forces[0].name, "ground_force");
    EXPECT_EQ(loads.forces[0].body, "");
    EXPECT_EQ(loads.forces[0].torque, torque);
    const auto wrenches = sample_external_loads(loads, t, {.rate_hz = 10.0, .frames = 2}).value();
    EXPECT_EQ(wrenches.items[0].force[1], 1.0);
    EXPECT_EQ(wrenches.items[0].point[1], 4.0);
    EXPECT_EQ(wrenches.items[0].moment[1], 7.0);
    EXPECT_EQ(wrenches.items[1].name, "1_ground_force");
    EXPECT_EQ(wrenches.items[1].force[0], 9.0);
  }
  // Without moments there are none; without points there are no forces.
  EXPECT_EQ(loads_of_columns(table_with({"a_v", "a_p"}), "grf.mot").value().forces[0].torque, "");
  const auto none = loads_of_columns(table_with({"ground_force_v", "knee_"}), "grf.mot");
  EXPECT_EQ(none.error().code, Code::bad_input);
  EXPECT_THAT(none.error().message, testing::HasSubstr("grf.mot: has no columns of forces; need NAMEvx"));
}

TEST(ExternalLoads, ATableOfForcesIsReadAsTheSame) {
  data::Wrenches wrenches{.time = {.rate_hz = 100.0, .t0_s = 1.0, .frames = 3}, .items = {}};
  for (const double scale : {1.0, 2.0}) {
    data::Wrench one{.name = "plate", .body = {}, .force = {}, .moment = {}, .point = {}};
    for (int i = 0; i < 9; ++i) {
      one.force.push_back(scale * (i + 1.0));
      one.moment.push_back(scale * (i - 4.0));
      one.point.push_back(0.1 * i);
    }
    std::fill_n(one.force.begin() + 3, 3, 0.0);  // the second frame: nothing acts
    std::fill_n(one.moment.begin() + 3, 3, 0.0);
    std::fill_n(one.point.begin() + 3, 3, kNaN);
    wrenches.items.push_back(one);
  }
  const auto t = table_of_forces(wrenches);
  ASSERT_TRUE(t.validate());
  EXPECT_EQ(t(1, t.find("1_ground_force_px")), 0.0);
  const auto again = sample_external_loads(loads_of_columns(t, "grf.mot").value(), t, wrenches.time).value();
  ASSERT_TRUE(again.validate());
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(again.items[i].force, wrenches.items[i].force);
    EXPECT_EQ(again.items[i].moment, wrenches.items[i].moment);
    EXPECT_EQ(again.items[i].point[6], wrenches.items[i].point[6]);
    EXPECT_TRUE(std::isnan(again.items[i].point[3]));
  }
}

TEST(ExternalLoads, ColumnsByNumberAndByOrder) {
  const std::string by =
      "<applied_to_body>/bodyset/hand</applied_to_body><force_identifier>{}</force_identifier>"
      "<point_identifier>{}</point_identifier>";
  data::Table t;
  t.columns = {"f1_1", "f1_2", "f1_3", "pull_b", "pull_a", "pull_c", "p.x", "p.y", "p.z", "f1_4"};
  t.time_s = {0.0};
  for (int c = 0; c < 10; ++c) t.values.push_back(c);
  for (const auto& [force, first] : {std::pair{"f1_", 0.0}, {"f1", 0.0}, {"pull", 3.0}}) {
    const auto loads =
        parse_external_loads(loads_xml(force_xml("one", fmt::format(fmt::runtime(by), force, "p"))), "l.xml");
    // "p" alone begins the names of six columns; those with an axis behind it are meant.
    const auto wrench =
        sample_external_loads(loads.value(), t, {.rate_hz = 10.0, .frames = 1}).value().items.at(0);
    EXPECT_EQ(wrench.body, "hand");
    EXPECT_EQ(wrench.force[0], first);
    EXPECT_EQ(wrench.force[2], first + 2.0);
    EXPECT_EQ(wrench.point[0], 6.0);
    EXPECT_EQ(wrench.moment[0], 0.0);
  }
}

TEST(ExternalLoads, ATorqueAloneNeedsNoPoint) {
  const auto loads =
      parse_external_loads(loads_xml(force_xml("",
                                               "<applied_to_body>hand</applied_to_body>"
                                               "<point_expressed_in_body>hand</point_expressed_in_body>"
                                               "<torque_identifier>ground_torque_</torque_identifier>")),
                           "l.xml")
          .value();
  EXPECT_EQ(loads.forces.at(0).name, "hand");
  const auto wrenches = sample_external_loads(loads, table(), {.rate_hz = 10.0, .frames = 3}).value();
  EXPECT_TRUE(wrenches.validate());
  EXPECT_EQ(wrenches.items.at(0).moment[6], -2.0);
  EXPECT_EQ(wrenches.items.at(0).force[6], 0.0);
}

TEST(ExternalLoads, ForcesThatAreSwitchedOffAreLeftOut) {
  for (const char* off : {"<appliesForce>false</appliesForce>", "<isDisabled>true</isDisabled>"}) {
    const auto loads = parse_external_loads(loads_xml(force_xml("off", off) + kRight), "l.xml").value();
    ASSERT_EQ(loads.forces.size(), 1u);
    EXPECT_EQ(loads.forces[0].name, "right");
    EXPECT_THAT(parse_external_loads(loads_xml(force_xml("off", off)), "l.xml").error().message,
                HasSubstr("l.xml: no <ExternalForce> is switched on"));
  }
}

TEST(ExternalLoads, WhatIsWrongIsReportedInASentence) {
  const auto message = [](const std::string& xml, Code code = Code::bad_input) {
    const auto loads = parse_external_loads(xml, "l.xml");
    EXPECT_FALSE(loads);
    EXPECT_EQ(loads.error().code, code);
    return loads.error().message;
  };
  const std::string body = "<applied_to_body>hand</applied_to_body>",
                    force = "<force_identifier>f</force_identifier>",
                    point = "<point_identifier>p</point_identifier>";
  EXPECT_THAT(message("<OpenSimDocument><Model/></OpenSimDocument>"),
              HasSubstr("l.xml: has no <ExternalLoads>"));
  EXPECT_THAT(message(loads_xml(kRight, "")), HasSubstr("names no <datafile>"));
  EXPECT_THAT(message(loads_xml(kRight, "<datafile>Unassigned</datafile>")),
              HasSubstr("names no <datafile>"));
  EXPECT_THAT(message(loads_xml(force_xml("a", force + point))),
              HasSubstr("'a': names no <applied_to_body>"));
  EXPECT_THAT(message(loads_xml(force_xml("a", body))), HasSubstr("neither <force_identifier>"));
  EXPECT_THAT(message(loads_xml(force_xml("a", body + force)), Code::not_supported),
              HasSubstr("no <point_identifier>"));
  for (const char* frame : {"force_expressed_in_body", "point_expressed_in_body"})
    EXPECT_THAT(
        message(loads_xml(force_xml("a", body + force + point + fmt::format("<{0}>hand</{0}>", frame))),
                Code::not_supported),
        HasSubstr(fmt::format("<{}>: is 'hand'; only forces and points in ground are read", frame)));
  EXPECT_EQ(read_external_loads("no such file.xml").error().code, Code::io);
  // Columns that are not there, or too many of them.
  auto t = table();
  t.columns[2] = "ground_force_w";
  auto loads = parse_external_loads(loads_xml(kRight), "l.xml").value();
  const auto missing = sample_external_loads(loads, t, {.rate_hz = 10.0, .frames = 1});
  EXPECT_EQ(missing.error().message,
            "l.xml: ExternalForce 'right' asks for columns that begin with 'ground_force_v'; walk.mot has 2 "
            "of them, "
            "need three");
  loads.forces[0].force = "ground";
  EXPECT_THAT(sample_external_loads(loads, table(), {.rate_hz = 10.0, .frames = 1}).error().message,
              HasSubstr("has 9 of them"));
}

TEST(ExternalLoads, BytesTurnedIntoAnything) {
  Random random(8, 0);
  const std::string good = loads_xml(kRight + kRight);
  int read = 0;
  for (int round = 0; round < 2000; ++round) {
    std::string xml = good;
    const auto at = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(xml.size())));
    // Any byte, or a letter, which more often leaves well-formed XML.
    const double byte = round % 2 == 0 ? random.uniform(0.0, 256.0) : random.uniform(97.0, 123.0);
    xml[at] = static_cast<char>(static_cast<int>(byte));
    const auto loads = parse_external_loads(xml, "l.xml");
    if (!loads) {
      EXPECT_FALSE(loads.error().message.empty());
      continue;
    }
    ++read;
    const auto wrenches = sample_external_loads(*loads, table(), {.rate_hz = 20.0, .frames = 4});
    EXPECT_TRUE(!wrenches || wrenches->validate());
  }
  EXPECT_GT(read, 100);
}

}  // namespace
}  // namespace kinemark::io
