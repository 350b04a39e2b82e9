#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <utility>

#include "bench/published_study.h"
#include "engine/kinds/result_file.h"
#include "engine/kinds/sensitivity/indices.h"
#include "engine/kinds/sensitivity/tolerances.h"
#include "engine/run/evaluate_unit.h"
#include "engine/run/response_rounding.h"
#include "tests/support/temp_folder.h"

namespace poesy {
namespace {

/// The content hash of a study's result. One evaluator solves the units in this order; they are merged in the order of
/// the plan.
std::string hash_of(const Study& study, const Model& model, const std::vector<std::size_t>& order) {
  const SelectedPoses poses = select_poses(study.poses, model);
  const Plan plan(study, poses.poses);
  UnitEvaluator evaluate(plan, model);
  std::vector<UnitStats> stats(plan.units());
  for (const std::size_t u : order) stats[u] = evaluate(plan.unit(u));
  sensitivity::CellStats cells(model.description().responses.size(), plan.cells());
  for (std::size_t u = 0; u < plan.units(); ++u) {
    const WorkUnit unit = plan.unit(u);
    cells.merge(unit.slot * plan.poses().size() + unit.pose.value, stats[u]);
  }
  sensitivity::Result result = sensitivity::sensitivity_result(
      plan, std::move(cells), sensitivity::background_responses(plan, model), response_rounding(model), 0.95);
  result.index_change = sensitivity::Result::Indices(result.global.lengths());  // not computed here
  sensitivity::set_references(study, result);
  const test::TempFolder folder;
  write_result(folder / "r.h5", study, poses, std::move(result), {});
  return verify_result(folder / "r.h5").computed;
}

TEST(UnitOrder, DoesNotChangeTheContentHash) {
  const Study study = bench::published_study(5, 1300);  // two units for each error and pose
  const std::unique_ptr<Model> model = build_model(study.mechanism);
  std::vector<std::size_t> order(2 * 25 * 5);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::string in_order = hash_of(study, *model, order);
  std::mt19937_64 random(20240610);
  for (int k = 0; k < 5; ++k) {
    std::shuffle(order.begin(), order.end(), random);
    EXPECT_EQ(hash_of(study, *model, order), in_order);
  }
}

}  // namespace
}  // namespace poesy
