// SPDX-FileCopyrightText: 2026 The kinemark authors
// SPDX-License-Identifier: Apache-2.0
// What Output writes, Input reads; what is no data of the file, it does not.
#include "kinemark/io/nwb/internal/output.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "kinemark/core/random.h"
#include "kinemark/io/file.h"
#include "kinemark/io/nwb/internal/input.h"
#include "support/scratch.h"

namespace kinemark::io::internal {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Optional;

/// A file with what `fill` writes into it, open for reading.
class Stored {
 public:
  explicit Stored(const std::function<void(Output&)>& fill, std::string_view identity = "one") {
    {
      Output out(path().string(), identity);
      fill(out);
      EXPECT_FALSE(out.failed());
      EXPECT_TRUE(out.close());
    }
    input = std::make_unique<Input>(Input::open(path()).value());
  }
  [[nodiscard]] std::filesystem::path path() const { return scratch_ / "a.h5"; }
  [[nodiscard]] Handle at(const std::string& object) const { return input->object(input->file(), object); }
  [[nodiscard]] std::string bytes() const { return read_text(path()).value(); }

 private:
  Quiet quiet_;
  testing_support::ScratchFolder scratch_;

 public:
  std::unique_ptr<Input> input;
};

TEST(NwbParts, AttributesComeBack) {
  const std::vector<std::string> many{"", "b\xC3\xA9", "a long one with blanks"};
  const Stored s([&](Output& out) {
    const Handle g = out.group(out.file(), "g");
    out.attribute(g.id(), "text", "caf\xC3\xA9");
    out.attribute(g.id(), "empty", "");
    out.attribute(g.id(), "texts", many);
    out.attribute(g.id(), "double", 0.1, H5T_IEEE_F64LE);
    out.attribute(g.id(), "float", 0.1, H5T_IEEE_F32LE);
    out.attribute(g.id(), "whole", 7.0, H5T_STD_I32LE);
  });
  const Handle g = s.at("g");
  ASSERT_TRUE(g);
  EXPECT_THAT(s.input->text_attribute(g.id(), "text"), Optional(std::string("caf\xC3\xA9")));
  EXPECT_THAT(s.input->text_attribute(g.id(), "empty"), Optional(std::string()));
  EXPECT_THAT(s.input->text_attributes(g.id(), "texts"), Optional(many));
  EXPECT_THAT(s.input->number_attribute(g.id(), "double"), Optional(0.1));
  EXPECT_THAT(s.input->number_attribute(g.id(), "float"), Optional(0.1))
      << "the shortest decimal of its bits";
  EXPECT_THAT(s.input->number_attribute(g.id(), "whole"), Optional(7.0));
  for (const char* absent : {"none", "texts"})
    EXPECT_FALSE(s.input->number_attribute(g.id(), absent)) << absent;
  EXPECT_FALSE(s.input->text_attribute(g.id(), "double"));
  EXPECT_FALSE(s.input->text_attribute(g.id(), "none"));
}

TEST(NwbParts, SamplesComeBackInWhateverOrderTheyWereWritten) {
  Random random(3, 1);
  constexpr std::int64_t kRows = 5000;
  std::vector<double> x(3 * kRows);
  for (double& v : x) v = random.gaussian();
  const Stored s([&](Output& out) {
    const Handle samples = out.samples(out.file(), "x", H5T_IEEE_F64LE, kRows + 10, 3, -7.0, 4);
    for (const auto& [first, end] : {std::pair<std::int64_t, std::int64_t>{4000, 5000}, {0, 1}, {1, 4000}})
      out.write(samples, H5T_NATIVE_DOUBLE, first, end - first, 3, x.data() + 3 * first);
  });
  const Handle d = s.at("x");
  EXPECT_THAT(s.input->number_shape(d.id()), Optional(std::vector<std::int64_t>{kRows + 10, 3}));
  EXPECT_FALSE(s.input->text_shape(d.id()));
  EXPECT_FALSE(s.input->holds_bytes(d.id()));
  EXPECT_FALSE(s.input->digest_of(d.id())) << "nothing was read yet";
  const auto all = s.input->numbers<double>(d.id());
  ASSERT_TRUE(all);
  ASSERT_EQ(all->size(), 3U * (kRows + 10));
  for (std::size_t i = 0; i < x.size(); ++i) ASSERT_EQ((*all)[i], x[i]) << i;
  for (std::size_t i = x.size(); i < all->size(); ++i) EXPECT_EQ((*all)[i], -7.0) << "nobody wrote it";
  EXPECT_TRUE(s.input->digest_of(d.id()));
  std::vector<double> rows(6);
  ASSERT_TRUE(s.input->read_rows(d.id(), {kRows + 10, 3}, 3999, 2, rows.data()));
  EXPECT_TRUE(std::equal(rows.begin(), rows.end(), x.begin() + 3 * 3999));
}

TEST(NwbParts, BytesStayBytes) {
  const std::vector<std::uint8_t> states{0, 1, 2, 255};
  const Stored s([&](Output& out) {
    const Handle d = out.samples(out.file(), "s", H5T_STD_U8LE, 4, 1, 0.0, 0);
    out.write(d, H5T_NATIVE_UINT8, 0, 4, 1, states.data());
  });
  const Handle d = s.at("s");
  EXPECT_TRUE(s.input->holds_bytes(d.id()));
  EXPECT_THAT(s.input->number_shape(d.id()), Optional(ElementsAre(4))) << "one column is a plain list";
  const auto back = s.input->numbers<std::uint8_t>(d.id());
  ASSERT_TRUE(back);
  EXPECT_TRUE(std::ranges::equal(*back, states));
}

TEST(NwbParts, TextsInRowsAndTables) {
  const std::vector<std::string> cells{"a", "b", "", "d \xC3\xA4", "e", "f"};
  std::vector<std::string> long_list;
  for (int i = 0; i < 9000; ++i) long_list.push_back("name " + std::to_string(i));
  const Stored s([&](Output& out) {
    out.texts(out.file(), "grid", cells, 2);
    out.texts(out.file(), "list", long_list);
    out.table(out.file(), "markers", "of many", {{.name = "name", .description = "who", .texts = long_list}});
    out.table(out.file(), "table", "of two",
              {{.name = "name", .description = "who", .texts = {"x", "y"}},
               {.name = "size", .description = "how long", .numbers = {1.5, NAN}}});
  });
  const Handle grid = s.at("grid"), list = s.at("list");
  EXPECT_THAT(s.input->text_shape(grid.id()), Optional(std::vector<std::int64_t>{3, 2}));
  EXPECT_FALSE(s.input->number_shape(grid.id()));
  EXPECT_THAT(s.input->texts(grid.id()), Optional(cells));
  EXPECT_THAT(s.input->texts(list.id()), Optional(long_list)) << "too long for a header";
  EXPECT_THAT(s.input->texts(s.at("markers/name").id()), Optional(long_list));
  const Handle table = s.at("table");
  EXPECT_THAT(s.input->text_attribute(table.id(), "neurodata_type"), Optional(std::string("DynamicTable")));
  EXPECT_THAT(s.input->text_attributes(table.id(), "colnames"), Optional(ElementsAre("name", "size")));
  EXPECT_THAT(s.input->texts(s.at("table/name").id()), Optional(ElementsAre("x", "y")));
  const auto sizes = s.input->numbers<double>(s.at("table/size").id());
  ASSERT_TRUE(sizes && sizes->size() == 2);
  EXPECT_EQ((*sizes)[0], 1.5);
  EXPECT_TRUE(std::isnan((*sizes)[1]));
}

TEST(NwbParts, ChildrenInOrderAndLinksWithinTheFileOnly) {
  const Stored s([](Output& out) {
    for (const char* name : {"zebra", "ant", "Mole"}) out.group(out.file(), name);
    out.number(out.file(), "n", 4.0);
    out.soft_link(out.file(), "to_n", "/n");
    out.soft_link(out.file(), "to_nowhere", "/none");
    H5Lcreate_external("b.h5", "/n", out.file(), "outside", H5P_DEFAULT, H5P_DEFAULT);
  });
  EXPECT_THAT(s.input->children(s.at("/").id()),
              Optional(ElementsAre("Mole", "ant", "n", "to_n", "to_nowhere", "zebra")));
  EXPECT_THAT(s.input->children(s.at("ant").id()), Optional(IsEmpty()));
  EXPECT_THAT(s.input->soft_link(s.input->file(), "to_n"), Optional(std::string("/n")));
  EXPECT_FALSE(s.input->soft_link(s.input->file(), "n"));
  EXPECT_TRUE(s.at("to_n"));
  EXPECT_FALSE(s.at("to_nowhere"));
  EXPECT_FALSE(s.at("outside"));
  EXPECT_FALSE(s.at("none/below"));
  EXPECT_FALSE(s.input->broken(s.input->file(), "to_nowhere")) << "a dangling link is no damage";
}

TEST(NwbParts, TheSameIdentityGivesTheSameBytesAndAnotherOthers) {
  const auto fill = [](Output& out) {
    const Handle g = out.group(out.file(), "g", "TimeSeries");
    out.group(g.id(), "h", "TimeSeries");
  };
  const Stored a(fill, "one"), b(fill, "one"), c(fill, "two");
  EXPECT_EQ(a.bytes(), b.bytes());
  const auto id = [](const Stored& s, const char* object) {
    return s.input->text_attribute(s.at(object).id(), "object_id").value_or("");
  };
  EXPECT_NE(id(a, "g"), id(c, "g"));
  EXPECT_NE(id(a, "g"), id(a, "g/h")) << "every object has its own";
  const std::string uuid = id(a, "g");
  ASSERT_EQ(uuid.size(), 36U);
  EXPECT_EQ(uuid[14], '8') << "a UUID of version 8";
  EXPECT_NE(std::string("89ab").find(uuid[19]), std::string::npos);
}

TEST(NwbParts, MemoryIsLentUpToWhatTheFileExplains) {
  const Stored s([](Output& out) { out.number(out.file(), "n", 1.0); });
  const std::size_t most = s.input->bytes_explained();
  EXPECT_FALSE(s.input->afford(most, 2));
  EXPECT_FALSE(s.input->afford(static_cast<std::size_t>(-1), 8)) << "no product runs over";
  EXPECT_TRUE(s.input->afford(most / 2, 1));
  EXPECT_FALSE(s.input->afford(most - most / 2 + 1, 1)) << "what is lent is gone";
  EXPECT_TRUE(s.input->afford(most - most / 2, 1));
  EXPECT_FALSE(s.input->afford(1, 1));
  EXPECT_EQ(s.input->bytes_explained(), most);
}

TEST(NwbParts, AFailureIsRememberedToTheEnd) {
  const Quiet quiet;
  const testing_support::ScratchFolder scratch;
  Output out((scratch / "a.h5").string(), "x");
  out.group(out.file(), "twice");
  EXPECT_FALSE(out.failed());
  out.group(out.file(), "twice");
  EXPECT_TRUE(out.failed()) << "that name is taken";
  out.group(out.file(), "other");
  EXPECT_TRUE(out.failed());
  EXPECT_FALSE(out.close());
  const Output nowhere((scratch / "none" / "a.h5").string(), "x");
  EXPECT_TRUE(nowhere.failed());
}

}  // namespace
}  // namespace kinemark::io::internal
