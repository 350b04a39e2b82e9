#include "engine/study/study.h"

#include <gtest/gtest.h>

#include "engine/kinds/study_file.h"
#include "engine/study/table_file.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

/// The fake mechanism, with lengths bounded by the arm and angles by three radians.
class BoundedModel final : public test::FakeModel {
 public:
  using FakeModel::FakeModel;

  ErrorBound error_bound(FactorIndex factor) const override {
    if (factor.value == 1) return {3.0, "three radians"};
    return {kArm, "the arm"};
  }
};

Catalog bounded_catalog() {
  Catalog catalog = test::fake_catalog();
  catalog[0].build = [](std::span<const double> geometry, std::size_t /*fidelity*/) {
    return std::make_unique<BoundedModel>(geometry[0]);
  };
  return catalog;
}

const Catalog kBoundedCatalog = bounded_catalog();
const std::string kHead =
    "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"fake\" }\nposes = { count = 3 }\n";

void read(const std::string& rest) { study_of_text(kHead + rest, "study.toml", kBoundedCatalog, StudyUse::run); }

struct BadSize {
  const char* name;
  std::string rest;  ///< rest of the study's text; a ^ marks the place of the mistake
  std::vector<std::string> words;
};

class BeyondBound : public testing::TestWithParam<BadSize> {};

TEST_P(BeyondBound, IsRefused) {
  const test::Marked marked(kHead + GetParam().rest);
  test::expect_input_error([&] { read(marked.text.substr(kHead.size())); }, {"study.toml", marked.line, marked.column},
                           GetParam().words);
}

INSTANTIATE_TEST_SUITE_P(
    All, BeyondBound,
    testing::Values(
        BadSize{"Sigma",
                "[errors]\nlinear = { distribution = \"normal\", sigma = ^\"60 mm\" }\n",
                {"errors.linear.sigma gives delta_1 a standard deviation of 60 mm, no less than the arm (60 mm)"}},
        BadSize{"HalfWidth",
                "[errors]\noverride = { epsilon_1 = { distribution = \"uniform\", half_width = ^\"6 rad\" } }\n",
                {"errors.override.epsilon_1.half_width gives epsilon_1", "three radians (171.887338539 deg)"}},
        BadSize{
            "SizesForDeviations",
            "[errors]\noverride = { delta_1 = { distribution = \"measured\", values = ^[\"250 mm\", \"251 mm\", \"252 "
            "mm\", \"253 mm\", \"254 mm\", \"255 mm\", \"256 mm\", \"257 mm\"] } }\n",
            {"give deviations from the nominal size, not sizes"}},
        BadSize{"RadiansForMilliradians",
                "[errors]\nangular = { distribution = \"normal\", sigma = ^\"20 rad\" }\n",
                {"standard deviation of", "write a smaller one, such as \"20 mrad\""}},
        BadSize{"MonteCarlo",
                "[errors]\nlinear = { distribution = \"normal\", sigma = ^\"1 m\" }\n[analysis]\nkind = "
                "\"monte-carlo\"\ndraws = \"per pose\"\n",
                {"1000 mm"}},
        BadSize{"Background",
                "[analysis]\nbackground = { factors = \"benign\", linear = ^\"-70 mm\" }\n",
                {"analysis.background.linear gives delta_2 an error of -70 mm"}},
        BadSize{"Reference",
                "[analysis]\nreference = { factor = \"delta_1\", tolerance = ^\"1 m\" }\n",
                {"analysis.reference.tolerance gives delta_1 a tolerance of 1000 mm"}},
        BadSize{"Group",
                "[analysis]\nkind = \"identification\"\ngroups = [{ linear = \"1 mm\", angular = ^\"200 deg\" }]\n",
                {"gives epsilon_1 an error of 200 deg"}},
        BadSize{"Case",
                "[analysis]\nkind = \"evaluate\"\ncases = [{ errors = { delta_2 = ^\"-60 mm\" } }]\n",
                {"delta_2 gives delta_2 an error of -60 mm"}},
        BadSize{"CaseOfAllLengths",
                "[analysis]\nkind = \"evaluate\"\ncases = [{ errors = { linear = ^\"60 mm\" } }]\n",
                {"linear gives delta_1 an error of 60 mm"}},
        BadSize{"CaseOfASet",
                "[analysis]\nkind = \"evaluate\"\ncases = [{ errors = ^{ benign = { linear = \"60 mm\" } } }]\n",
                {"case 'case 1' gives delta_2"}}),
    [](const testing::TestParamInfo<BadSize>& tested) { return std::string(tested.param.name); });

TEST(ErrorBound, OfTheLargestPossibleError) {
  for (const char* shape : {"uniform", "triangular"}) {
    EXPECT_THROW(read("[errors]\nlinear = { distribution = \"" + std::string(shape) + "\", half_width = \"60 mm\" }\n"),
                 InputError);
  }
  EXPECT_THROW(read("[errors]\nlinear = { distribution = \"truncated-normal\", sigma = \"1 mm\", half_width = "
                    "\"60 mm\" }\n"),
               InputError);
}

TEST(ErrorBound, SmallerOnesPass) {
  EXPECT_NO_THROW(read("[errors]\nlinear = { distribution = \"normal\", sigma = \"59.9 mm\" }\n"));
  EXPECT_NO_THROW(read("[errors]\nlinear = { distribution = \"uniform\", half_width = \"59 mm\" }\n"));
  EXPECT_NO_THROW(read("[errors]\noverride = { delta_2 = { distribution = \"normal\", sigma = \"1 m\" } }\n"))
      << "delta_2 does not vary in this study";
}

TEST(ErrorBound, OfADefault) {
  const std::string path = "study.toml";
  const std::string tiny =
      "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"tiny\" }\nposes = { count = 3 }\n";
  Catalog catalog = kBoundedCatalog;
  catalog[0].description.name = "tiny";
  class Tiny final : public test::FakeModel {
    ErrorBound error_bound(FactorIndex /*factor*/) const override { return {1e-4, "everything"}; }
  };
  catalog[0].build = [](std::span<const double>, std::size_t) { return std::make_unique<Tiny>(); };
  test::expect_input_error([&] { study_of_text(tiny, path, catalog, StudyUse::run); }, {path, 1, 1},
                           {"the default of linear gives delta_1 a standard deviation of 1 mm", "everything (0.1 mm)"});
}

TEST(ErrorBound, OfATable) {
  const test::TempFolder folder;
  const BoundedModel model;
  const std::string path = folder.write("errors.csv", "delta_2,delta_1\n0.01,0\n0,-0.06\n");
  test::expect_input_error([&] { read_errors(path, model); }, {path, 3, 3},
                           {"gives delta_1 an error of -60 mm, no less than the arm (60 mm)", "'delta_1 [mm]'"});
  // 75 without a unit (meant as 75 um) is refused; with the unit um in the header it is read.
  const std::string bare = folder.write("bare.csv", "delta_1\n75\n");
  test::expect_input_error([&] { read_errors(bare, model); }, {bare, 2, 1}, {"75000 mm", "'delta_1 [mm]'"});
  EXPECT_EQ(read_errors(folder.write("um.csv", "delta_1 [um]\n75\n"), model).rows, 1u);
  const std::string large = folder.write("mm.csv", "delta_1 [mm]\n75\n");
  test::expect_input_error([&] { read_errors(large, model); }, {large, 2, 1}, {"75 mm", "no less than the arm"});
  EXPECT_EQ(read_errors(folder.write("fine.csv", "delta_1\n-0.0599\n"), model).rows, 1u);
}

}  // namespace
}  // namespace poesy
