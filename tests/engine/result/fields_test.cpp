#include "engine/result/fields.h"

#include <gtest/gtest.h>

namespace poesy {
namespace {

struct Numbers {
  std::size_t columns = 0;
  double level = 0.0;
  std::vector<double> values;
  std::vector<std::uint64_t> counts;
  std::vector<std::uint8_t> marks;
  std::string text;
};

const std::vector<Attribute<Numbers>> kNumbersLevel{{"level", &Numbers::level}};
const Group<Numbers> kNumbers{
    "/numbers",
    "Numbers of a test",
    kNumbersLevel,
    {{"column", &Numbers::columns}},
    {{"values", &Numbers::values, {"line", "column"}, "m", "Values", kNumbersLevel},
     {"counts", &Numbers::counts, {"column"}, "1", "Counts"},
     {"marks", &Numbers::marks, {"line"}, "1", "Not of every study", Presence::where_computed},
     {"text", &Numbers::text, {}, "1", "A text"}}};

struct Thing {
  std::string name;
  bool good = false;
  std::optional<std::size_t> place = std::nullopt;
};

const Fields<Thing> kThings{{"name", &Thing::name, {"line"}, "1", "Names"},
                            {"good", &Thing::good, {"line"}, "1", "Whether they are good"},
                            {"place", &Thing::place, {"line"}, "1", "Their places"}};

ResultBuilder with_axes() {
  ResultBuilder builder(h5::File::in_memory());
  builder.add_axis("line", std::vector<std::int64_t>{0, 1}, {"1", "Lines"});
  builder.add_axis("column", std::vector<std::int64_t>{0, 1, 2}, {"1", "Columns"});
  return builder;
}

Numbers some() { return {3, 0.5, {1.0, 2.0, 3.0, 4.0, 5.0, 6.0}, {7, 8, 9}, {1, 0}, "a"}; }

TEST(Fields, AGroupReadsBackAsItWasWritten) {
  ResultBuilder builder = with_axes();
  const Numbers numbers = some();
  write_group(builder, kNumbers, numbers);
  const h5::File& file = builder.file();
  EXPECT_EQ(file.shape("/numbers/values"), (h5::Shape{2, 3}));
  EXPECT_EQ(file.value("/numbers/counts").type, h5::Value::Type::unsigned_integer);
  EXPECT_EQ(file.attribute<double>("/numbers/values", "level").at(0), 0.5);
  EXPECT_EQ(file.attribute<std::string>("/numbers/values", "unit").at(0), "m");
  EXPECT_TRUE(file.exists("/numbers/line")) << "axes are shown in the group";
  Numbers read;
  read_group(file, kNumbers, read);
  EXPECT_EQ(read.columns, 3U);
  EXPECT_EQ(read.level, 0.5);
  EXPECT_EQ(read.values, numbers.values);
  EXPECT_EQ(read.counts, numbers.counts);
  EXPECT_EQ(read.marks, numbers.marks);
  EXPECT_EQ(read.text, "a");
  EXPECT_EQ(number_at(kNumbers.fields[0], read, 4), Number(5.0));
  EXPECT_EQ(number_at(kNumbers.fields[1], read, 2), Number(std::uint64_t{9}));
}

TEST(Fields, WhatAStudyDidNotComputeStaysEmpty) {
  ResultBuilder builder = with_axes();
  Numbers without = some();
  without.marks.clear();
  write_group(builder, kNumbers, without);
  EXPECT_FALSE(builder.file().exists("/numbers/marks"));
  Numbers read;
  read_group(builder.file(), kNumbers, read);
  EXPECT_TRUE(read.marks.empty());
}

TEST(Fields, WhatEveryStudyComputesMayNotBeMissing) {
  ResultBuilder builder = with_axes();
  builder.file().make_group("/numbers");
  builder.add("/numbers/values", {"line", "column"}, some().values, {"m", "Values"});
  Numbers read;
  EXPECT_THROW(read_fields(builder.file(), "/numbers", kNumbers.fields, read), h5::Error);
}

TEST(Fields, AnotherShapeIsRefused) {
  ResultBuilder builder = with_axes();
  builder.file().make_group("/numbers");
  builder.add("/numbers/values", {"column", "line"}, some().values, {"m", "Turned"});
  Numbers read;
  EXPECT_THROW(read_fields(builder.file(), "/numbers", kNumbers.fields, read), h5::Error);
}

TEST(Fields, ThingsAreColumns) {
  ResultBuilder builder = with_axes();
  builder.file().make_group("/things");
  write_columns(builder, "/things", kThings, std::vector<Thing>{{"a", true, 4}, {"b"}});
  EXPECT_EQ(builder.file().read<std::int64_t>("/things/place"), (std::vector<std::int64_t>{4, -1}));
  const std::vector<Thing> read = read_columns(builder.file(), "/things", kThings);
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(read[0].name, "a");
  EXPECT_TRUE(read[0].good);
  EXPECT_EQ(read[0].place, 4U);
  EXPECT_EQ(read[1].name, "b");
  EXPECT_FALSE(read[1].good);
  EXPECT_FALSE(read[1].place);
}

}  // namespace
}  // namespace poesy
