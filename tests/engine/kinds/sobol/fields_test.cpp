#include "engine/kinds/sobol/result.h"

#include <gtest/gtest.h>

#include <bit>
#include <string>
#include <vector>

#include "engine/kinds/result_file.h"
#include "tests/engine/kinds/example_result.h"
#include "tests/support/temp_folder.h"

namespace poesy::test {
namespace {

std::vector<std::uint64_t> bits(const std::vector<double>& values) {
  std::vector<std::uint64_t> list;
  for (const double value : values) list.push_back(std::bit_cast<std::uint64_t>(value));
  return list;
}

void expect_same(const SobolIndices& found, const SobolIndices& written) {
  EXPECT_EQ(found.conf_level, written.conf_level);
  EXPECT_EQ(bits(found.S1), bits(written.S1));
  EXPECT_EQ(bits(found.S1_ci_low), bits(written.S1_ci_low));
  EXPECT_EQ(bits(found.S1_ci_high), bits(written.S1_ci_high));
  EXPECT_EQ(bits(found.ST), bits(written.ST));
  EXPECT_EQ(bits(found.ST_ci_low), bits(written.ST_ci_low));
  EXPECT_EQ(bits(found.ST_ci_high), bits(written.ST_ci_high));
}

TEST(SobolFields, AreReadAsTheyWereWritten) {
  const TempFolder folder;
  const std::string path = folder.path() + "/sobol.h5";
  Example example;
  const SobolResult written = example.sobol();
  example.write_sobol(path);
  const StoredResult stored = read_result(path);
  const SobolResult& found = sobol_of(stored);
  EXPECT_EQ(found.responses, 2u);
  EXPECT_EQ(found.poses, Example::kPoses);
  EXPECT_FALSE(found.joined);
  EXPECT_EQ(found.group_names, written.group_names);
  EXPECT_EQ(found.vectors, written.vectors);
  expect_same(found.at_poses, written.at_poses);
  expect_same(found.aggregated, written.aggregated);
  expect_same(found.of_vectors, written.of_vectors);
  EXPECT_EQ(found.n, written.n);
  EXPECT_EQ(bits(found.mean), bits(written.mean));
  EXPECT_EQ(bits(found.variance), bits(written.variance));
  EXPECT_EQ(found.without_sign, written.without_sign);
  EXPECT_EQ(bits(found.S2), bits(written.S2));
  EXPECT_EQ(bits(found.S2_ci_low), bits(written.S2_ci_low));
  EXPECT_EQ(bits(found.S2_ci_high), bits(written.S2_ci_high));
  EXPECT_EQ(stored.failures, written.failures);
  EXPECT_EQ(found.total().not_converged(), 1u);
}

TEST(SobolFields, SayWhatDoesNotVaryWhereSomethingDoesNot) {
  const TempFolder folder;
  const std::string path = folder.path() + "/sobol.h5";
  Example example;
  example.write_sobol(path);
  EXPECT_TRUE(sobol_of(read_result(path)).varies.empty());
  EXPECT_TRUE(read_result(path).constant.empty());
  SobolResult result = example.sobol();
  result.varies = {0, 1};
  result.vector_varies = {1, 0};
  write_result(path, example.study, example.poses, result, example.facts);
  const StoredResult stored = read_result(path);
  EXPECT_EQ(sobol_of(stored).varies, result.varies);
  EXPECT_EQ(sobol_of(stored).vector_varies, result.vector_varies);
  EXPECT_EQ(stored.constant, std::vector<std::size_t>{0});
}

TEST(SobolFields, GroupsAreAnAxisOfTheirOwn) {
  const TempFolder folder;
  const std::string path = folder.path() + "/sobol.h5";
  Example example;
  SobolResult result = example.sobol();
  asked_of<SobolOptions>(example.study.analysis).groups_by = GroupsBy::limb;
  result.joined = true;
  result.group_names = {"limb 1", "limb 2"};
  write_result(path, example.study, example.poses, result, example.facts);
  const StoredResult stored = read_result(path);
  EXPECT_TRUE(sobol_of(stored).joined);
  EXPECT_EQ(sobol_of(stored).group_names, result.group_names);
  EXPECT_EQ(sobol_of(stored).group_members, result.group_members);
}

}  // namespace
}  // namespace poesy::test
