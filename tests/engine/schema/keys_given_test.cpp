#include "engine/schema/keys_given.h"

#include <gtest/gtest.h>

#include "engine/base/error.h"
#include "engine/schema/toml_text.h"

namespace poesy {
namespace {

toml::table file() { return parse_toml("a = 1\n[t]\nb = \"1 mm\"\nlist = [1, 2]\n", "file.toml", ""); }

TEST(GivenKeys, ReplaceAndAddValues) {
  toml::table table = file();
  set_key(table, {"t.b", "2 mm"});
  set_key(table, {"a", "0.5"});
  set_key(table, {"new.inner.c", "true"});
  set_key(table, {"t.list", "[\"-1 mm\", \"2 mm\"]"});
  EXPECT_EQ(table["t"]["b"].value<std::string>(), "2 mm");
  EXPECT_EQ(table["a"].value<double>(), 0.5);
  EXPECT_EQ(table["new"]["inner"]["c"].value<bool>(), true);
  EXPECT_EQ(table["t"]["list"][1].value<std::string>(), "2 mm");
  EXPECT_EQ(table.size(), 3U);
}

TEST(GivenKeys, AreTextsWhereTheyAreNotToml) {
  for (const char* text : {"newton", "260 mm", "1 = 2", "1\nb = 2", "1 # x", "\"open", ""}) {
    toml::table table = file();
    set_key(table, {"t.b", text});
    EXPECT_EQ(table["t"]["b"].value<std::string>(), text);
    EXPECT_EQ(table["t"].as_table()->size(), 2U) << text;
  }
}

TEST(GivenKeys, WholeNumbersStayWhole) {
  toml::table table = file();
  set_key(table, {"a", "5000"});
  EXPECT_TRUE(table["a"].is_integer());
}

TEST(GivenKeys, NamesThatAreNoneAreRefused) {
  for (const char* key : {"", ".", "t.", ".b", "t..b", "a.b", "t.list.0", "1.2.3.4.5.6.7.8.9"}) {
    toml::table table = file();
    EXPECT_THROW(set_key(table, {key, "1"}), InputError) << key;
  }
}

}  // namespace
}  // namespace poesy
