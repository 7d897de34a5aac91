// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
#include "kinemark/io/osim/scale_setup.h"

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "support/scratch.h"
#include "support/test_data.h"

namespace kinemark::io {
namespace {

using testing::HasSubstr;

class ScaleSetupFile : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& text, const std::string& name = "setup.xml") const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  [[nodiscard]] Result<ScaleSetup> read(const std::string& tool) const {
    return read_scale_setup(write("<OpenSimDocument Version=\"30000\"><ScaleTool name=\"s\">" + tool +
                                  "</ScaleTool></OpenSimDocument>"));
  }
  testing_support::ScratchFolder folder_;
};

std::string measurement(const std::string& markers, const std::string& axes) {
  return fmt::format(
      "<ModelScaler><scaling_order>measurements</scaling_order><MeasurementSet><objects><Measurement "
      "name=\"m\">"
      "<MarkerPairSet><objects><MarkerPair><markers>{}</markers></MarkerPair></objects></MarkerPairSet>"
      "<BodyScaleSet><objects><BodyScale name=\"femur\"><axes>{}</axes></BodyScale></objects></BodyScaleSet>"
      "</Measurement></objects></MeasurementSet></ModelScaler>",
      markers, axes);
}

TEST_F(ScaleSetupFile, reads_the_gait2354_setup) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto setup = read_scale_setup(data / "opensim-gait2354/subject01_Setup_Scale.xml");
  ASSERT_TRUE(setup) << setup.error().message;
  EXPECT_EQ(setup->name, "subject01");
  EXPECT_DOUBLE_EQ(setup->recipe.mass_kg, 72.6);
  EXPECT_DOUBLE_EQ(setup->height_mm, 1803.4);
  EXPECT_EQ(setup->model_file, data / "opensim-gait2354/gait2354_simbody.osim");
  EXPECT_EQ(setup->marker_set_file, data / "opensim-gait2354/gait2354_Scale_MarkerSet.xml");
  ASSERT_EQ(setup->recipe.order.size(), 2U);
  EXPECT_EQ(setup->recipe.order[0], data::ScaleStep::measurements);
  EXPECT_EQ(setup->recipe.order[1], data::ScaleStep::manual);
  ASSERT_EQ(setup->recipe.measurements.size(), 5U);
  EXPECT_EQ(setup->recipe.measurements[2].name, "thigh");
  ASSERT_EQ(setup->recipe.measurements[2].pairs.size(), 2U);
  EXPECT_EQ(setup->recipe.measurements[2].pairs[1].first, "L.ASIS");
  EXPECT_EQ(setup->recipe.measurements[2].pairs[1].second, "L.Knee.Lat");
  ASSERT_EQ(setup->recipe.measurements[2].bodies.size(), 4U);
  EXPECT_EQ(setup->recipe.measurements[2].bodies[0].body, "femur_r");
  EXPECT_EQ(setup->recipe.measurements[2].bodies[0].axes, Eigen::Vector3d::Ones());
  ASSERT_EQ(setup->recipe.manual.size(), 4U);
  EXPECT_EQ(setup->recipe.manual[3].body, "tibia_l");
  EXPECT_DOUBLE_EQ(setup->recipe.manual[3].factors.y(), 0.988523);
  EXPECT_DOUBLE_EQ(setup->recipe.first_time_s, 1.0);
  EXPECT_DOUBLE_EQ(setup->recipe.last_time_s, 2.0);
  EXPECT_TRUE(setup->recipe.preserve_mass_distribution);
  EXPECT_TRUE(setup->place);
  EXPECT_EQ(setup->tasks.markers.size(), 39U);
  EXPECT_EQ(setup->tasks.coordinates.size(), 5U);
  EXPECT_DOUBLE_EQ(setup->place_end_s, 1.01);
  EXPECT_LT(setup->max_marker_movement_mm, 0.0);
  EXPECT_TRUE(setup->coordinate_file.empty());
}

TEST_F(ScaleSetupFile, reads_a_setup_whose_files_are_unassigned) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto setup = read_scale_setup(data / "monkey-arm/setup_scale_han_20171122.xml");
  ASSERT_TRUE(setup) << setup.error().message;
  EXPECT_DOUBLE_EQ(setup->recipe.mass_kg, 0.53);
  EXPECT_DOUBLE_EQ(setup->height_mm, 0.0);
  EXPECT_TRUE(setup->model_file.empty());
  EXPECT_TRUE(setup->marker_set_file.empty());
  ASSERT_EQ(setup->recipe.measurements.size(), 2U) << "the third is switched off";
  EXPECT_EQ(setup->recipe.measurements[1].name, "radius");
  ASSERT_EQ(setup->recipe.manual.size(), 5U) << "the fifth of six is switched off";
  EXPECT_EQ(setup->recipe.manual[0].body, "sternum");
  EXPECT_FALSE(setup->tasks.markers[0].apply);
}

TEST_F(ScaleSetupFile, reads_axes_in_any_order_and_case) {
  EXPECT_EQ(read(measurement("A B", "Z x"))->recipe.measurements[0].bodies[0].axes, Eigen::Vector3d(1, 0, 1));
  EXPECT_EQ(read(measurement("A B", "Y"))->recipe.measurements[0].bodies[0].axes, Eigen::Vector3d(0, 1, 0));
}

TEST_F(ScaleSetupFile, parts_that_are_absent_are_not_applied) {
  const auto setup = read("<mass>-1</mass>");
  ASSERT_TRUE(setup) << setup.error().message;
  EXPECT_FALSE(setup->scale);
  EXPECT_FALSE(setup->place);
  EXPECT_EQ(setup->recipe.mass_kg, 0.0);
  EXPECT_EQ(setup->recipe.first_time_s, -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(setup->recipe.order.empty());
}

TEST_F(ScaleSetupFile, a_scaler_that_is_switched_off_leaves_the_mass_alone_to_the_recipe) {
  std::string scaler = measurement("A B", "X");
  scaler.insert(std::string("<ModelScaler>").size(),
                "<apply>false</apply><preserve_mass_distribution>true</preserve_mass_distribution>");
  const auto setup = read("<mass>70</mass>" + scaler);
  ASSERT_TRUE(setup) << setup.error().message;
  EXPECT_FALSE(setup->scale);
  EXPECT_TRUE(setup->recipe.order.empty());
  EXPECT_TRUE(setup->recipe.measurements.empty());
  EXPECT_FALSE(setup->recipe.preserve_mass_distribution);
  EXPECT_DOUBLE_EQ(setup->recipe.mass_kg, 70.0);
}

TEST_F(ScaleSetupFile, a_measurement_without_bodies_is_left_out) {
  std::string scaler = measurement("A B", "X");
  const auto from = scaler.find("<BodyScale "), to = scaler.find("</objects></BodyScaleSet>");
  scaler.erase(from, to - from);
  const auto setup = read(scaler);
  ASSERT_TRUE(setup) << setup.error().message;
  EXPECT_TRUE(setup->recipe.measurements.empty());
  EXPECT_FALSE(setup->recipe.measures());
}

TEST_F(ScaleSetupFile, a_time_range_of_minus_one_means_everything) {
  const auto setup = read("<ModelScaler><time_range>-1 -1</time_range></ModelScaler>");
  ASSERT_TRUE(setup) << setup.error().message;
  EXPECT_EQ(setup->recipe.last_time_s, std::numeric_limits<double>::infinity());
}

TEST_F(ScaleSetupFile, says_what_is_wrong_and_where) {
  const auto message = [&](const std::string& tool) {
    const auto setup = read(tool);
    return setup ? std::string("was read") : setup.error().message;
  };
  EXPECT_THAT(message(measurement("A", "X")), HasSubstr("need two names"));
  EXPECT_THAT(message(measurement("A B", "X Q")), HasSubstr("need some of X Y Z"));
  EXPECT_THAT(message("<ModelScaler><scaling_order>guess</scaling_order></ModelScaler>"),
              HasSubstr("'guess'; need measurements"));
  EXPECT_THAT(message("<ModelScaler><time_range>2 1</time_range></ModelScaler>"),
              HasSubstr("the earlier first"));
  EXPECT_THAT(message("<ModelScaler><ScaleSet><objects><Scale><segment>tibia</segment><scales>1 0 1</scales>"
                      "</Scale></objects></ScaleSet></ModelScaler>"),
              HasSubstr("must be above 0"));
  EXPECT_THAT(message("<mass>heavy</mass>"), HasSubstr("heavy"));
  EXPECT_THAT(read_scale_setup(write("<OpenSimDocument Version=\"30000\"><Model/></OpenSimDocument>"))
                  .error()
                  .message,
              HasSubstr("has no <ScaleTool>"));
}

TEST_F(ScaleSetupFile, reads_scale_sets_of_opensim) {
  KINEMARK_REQUIRE_TEST_DATA(data);
  const auto scales = read_scale_set(data / "opensim-gait2354/subject01_scaleSet_applied.xml");
  ASSERT_TRUE(scales) << scales.error().message;
  ASSERT_EQ(scales->size(), 13U);
  EXPECT_EQ(scales->front().body, "ground");
  EXPECT_EQ(scales->back().body, "torso");
  EXPECT_DOUBLE_EQ(scales->back().factors.x(), 1.07972);
}

TEST_F(ScaleSetupFile, reads_markers_with_either_word_for_the_body) {
  const auto path = write(
      "<OpenSimDocument Version=\"30000\"><MarkerSet><objects>"
      "<Marker name=\"A\"><body> torso </body><location>1 2 3</location><fixed>true</fixed></Marker>"
      "<Marker name=\"B\"><socket_parent_frame>/bodyset/pelvis</socket_parent_frame><location>4 5 "
      "6</location></Marker>"
      "</objects></MarkerSet></OpenSimDocument>",
      "markers.xml");
  const auto markers = read_marker_set(path);
  ASSERT_TRUE(markers) << markers.error().message;
  ASSERT_EQ(markers->size(), 2U);
  EXPECT_EQ((*markers)[0].body, "torso");
  EXPECT_TRUE((*markers)[0].fixed);
  EXPECT_EQ((*markers)[1].body, "pelvis");
  EXPECT_FALSE((*markers)[1].fixed);
  EXPECT_EQ((*markers)[1].x_in_body, Eigen::Vector3d(4, 5, 6));
}

TEST_F(ScaleSetupFile, merging_replaces_and_adds) {
  data::ModelDescription model;
  model.bodies = {{.name = "torso"}, {.name = "pelvis"}};
  model.markers = {{.name = "A", .body_idx = 1}};
  ASSERT_TRUE(merge_markers(model, {{.name = "A", .body = "torso", .x_in_body = Eigen::Vector3d(1, 2, 3)},
                                    {.name = "B", .body = "pelvis"}}));
  ASSERT_EQ(model.markers.size(), 2U);
  EXPECT_EQ(model.markers[0].body_idx, 0);
  EXPECT_EQ(model.markers[0].x_in_body, Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(model.markers[1].name, "B");
  EXPECT_THAT(merge_markers(model, {{.name = "C", .body = "tail"}}).error().message,
              HasSubstr("body 'tail'"));
}

}  // namespace
}  // namespace kinemark::io
