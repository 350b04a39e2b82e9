#include "engine/kinds/sobol/result.h"

#include <gtest/gtest.h>

#include <bit>
#include <span>
#include <string>
#include <vector>

#include "engine/kinds/result_file.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

std::vector<std::uint64_t> bits(std::span<const double> values) {
  std::vector<std::uint64_t> list;
  for (const double value : values) list.push_back(std::bit_cast<std::uint64_t>(value));
  return list;
}

template <NamedAxis... Axes>
void expect_same(const Array<double, Axes...>& found, const Array<double, Axes...>& written) {
  EXPECT_EQ(found.lengths(), written.lengths());
  EXPECT_EQ(bits(found), bits(written));
}

template <NamedAxis... Axes>
void expect_same(const sobol::Shares<Axes...>& found, const sobol::Shares<Axes...>& written) {
  expect_same(found.value, written.value);
  expect_same(found.ci_low, written.ci_low);
  expect_same(found.ci_high, written.ci_high);
}

template <NamedAxis... Axes>
void expect_same(const sobol::SobolIndices<Axes...>& found, const sobol::SobolIndices<Axes...>& written) {
  EXPECT_EQ(found.conf_level, written.conf_level);
  expect_same(found.S1, written.S1);
  expect_same(found.ST, written.ST);
}

TEST(SobolFields, AreReadAsTheyWereWritten) {
  const TempFolder folder;
  const std::string path = folder.path() + "/sobol.h5";
  Example example;
  const sobol::Result written = example.sobol();
  example.write_sobol(path);
  const StoredResult stored = read_result(path);
  const sobol::Result& found = sobol::sobol_of(stored);
  EXPECT_FALSE(found.joined);
  EXPECT_EQ(found.group_names, written.group_names);
  EXPECT_EQ(found.vectors, written.vectors);
  expect_same(found.at_poses, written.at_poses);
  expect_same(found.aggregated, written.aggregated);
  expect_same(found.of_vectors, written.of_vectors);
  EXPECT_EQ(found.n, written.n);
  expect_same(found.mean, written.mean);
  expect_same(found.variance, written.variance);
  EXPECT_EQ(found.without_sign, written.without_sign);
  expect_same(found.S2, written.S2);
  EXPECT_EQ(stored.failures, written.failures);
  EXPECT_EQ(found.total().not_converged(), 1u);
}

TEST(SobolFields, SayWhatDoesNotVaryWhereSomethingDoesNot) {
  const TempFolder folder;
  const std::string path = folder.path() + "/sobol.h5";
  Example example;
  example.write_sobol(path);
  EXPECT_TRUE(sobol::sobol_of(read_result(path)).varies.empty());
  EXPECT_TRUE(read_result(path).constant.empty());
  sobol::Result result = example.sobol();
  result.varies = decltype(result.varies)({2}, {0, 1});
  result.vector_varies = decltype(result.vector_varies)({2}, {1, 0});
  write_result(path, example.study, example.poses, result, example.facts);
  const StoredResult stored = read_result(path);
  EXPECT_EQ(sobol::sobol_of(stored).varies, result.varies);
  EXPECT_EQ(sobol::sobol_of(stored).vector_varies, result.vector_varies);
  EXPECT_EQ(stored.constant, std::vector<std::size_t>{0});
}

TEST(SobolFields, GroupsAreAnAxisOfTheirOwn) {
  const TempFolder folder;
  const std::string path = folder.path() + "/sobol.h5";
  Example example;
  sobol::Result result = example.sobol();
  asked_of<sobol::Options>(example.study.analysis).groups_by = sobol::GroupsBy::limb;
  result.joined = true;
  result.group_names = {"limb 1", "limb 2"};
  write_result(path, example.study, example.poses, result, example.facts);
  const StoredResult stored = read_result(path);
  EXPECT_TRUE(sobol::sobol_of(stored).joined);
  EXPECT_EQ(sobol::sobol_of(stored).group_names, result.group_names);
  EXPECT_EQ(sobol::sobol_of(stored).group_members, result.group_members);
}

}  // namespace
}  // namespace poesy::test
