#include "models/file/model.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

namespace poesy::file {
namespace {

std::string text_of(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

const nlohmann::json& oracle() {
  static const nlohmann::json all = nlohmann::json::parse(text_of(POESY_TEST_DATA "/mechanisms.json"));
  return all;
}

CatalogEntry entry_of(const std::string& name) {
  const std::string path = POESY_TEST_DATA "/" + oracle()["mechanisms"][name]["file"].get<std::string>();
  return catalog_entry(text_of(path), path);
}

std::unique_ptr<Model> build(const CatalogEntry& entry, std::size_t fidelity = 0) {
  std::vector<double> geometry;
  for (const GeometryParameter& parameter : entry.description.geometry) geometry.push_back(parameter.published);
  return entry.build(geometry, fidelity);
}

std::vector<double> values_of(const nlohmann::json& named, const auto& things) {
  std::vector<double> values;
  for (const auto& thing : things) values.push_back(named.value(thing.name, 0.0));
  return values;
}

/// The responses to these errors at a pose. options: the solver.
std::vector<double> evaluate(const Model& model, std::span<const double> pose, const std::vector<double>& errors,
                             const SolverOptions& options) {
  std::vector<double> responses(model.description().responses.size());
  std::array status{SolveStatus::singular};
  std::array iterations{std::uint32_t{0}};
  std::vector<FactorIndex> varied;
  for (std::size_t f = 0; f < errors.size(); ++f) varied.emplace_back(f);
  model.evaluator(options)->evaluate({pose, std::vector<double>(errors.size(), 0.0), varied, errors, 1},
                                     {responses, status, iterations, {}});
  EXPECT_TRUE(solved(status[0]));
  return responses;
}

/// Compares the responses that `expected` has. tolerance: in rad and m.
void expect_responses(const nlohmann::json& expected, const ModelDescription& description,
                      std::span<const double> found, double tolerance = 1e-10) {
  std::size_t compared = 0;
  for (std::size_t r = 0; r < found.size(); ++r) {
    const auto value = expected.find(description.responses[r].name);
    if (value == expected.end()) continue;
    ++compared;
    EXPECT_NEAR(found[r], value->get<double>(), tolerance) << description.responses[r].name;
  }
  EXPECT_EQ(compared, expected.size());
}

class OfOracle : public testing::TestWithParam<const char*> {
 protected:
  const nlohmann::json& cases() const { return oracle()["mechanisms"][GetParam()]["cases"]; }
};

TEST_P(OfOracle, HasTheDisplacementsOfEveryCase) {
  const CatalogEntry entry = entry_of(GetParam());
  const std::unique_ptr<Model> model = build(entry);
  const ModelDescription& description = model->description();
  for (const nlohmann::json& one : cases()) {
    if (!one.contains("response")) continue;
    const std::vector<double> pose = values_of(one["pose"], description.pose_coordinates);
    const std::vector<double> errors = values_of(one["errors"], description.factors);
    ASSERT_GE(description.factors.size(), one["errors"].size());
    for (const auto method : {SolverOptions::Method::newton, SolverOptions::Method::gauss_newton}) {
      SolverOptions options{.method = method, .tolerance = description.tolerance};
      expect_responses(one["response"], description, evaluate(*model, pose, errors, options));
      const auto trace = model->trace(pose, errors, options);
      ASSERT_TRUE(trace);
      expect_responses(one["response"], description, trace->responses);
    }
  }
}

TEST_P(OfOracle, HasTheDeformationsByBothMetrics) {
  const CatalogEntry entry = entry_of(GetParam());
  for (const nlohmann::json& one : cases()) {
    if (!one.contains("published")) continue;
    ASSERT_TRUE(entry.other_metric);
    for (const char* metric : {"published", "metric"}) {
      const CatalogEntry& by = metric == std::string("metric") ? entry : *entry.other_metric;
      std::unique_ptr<Model> model = build(by);
      if (&by == &entry) {
        std::vector<PlatformPoint> points;
        for (const nlohmann::json& point : oracle()["mechanisms"][GetParam()]["metric_points"]) {
          points.push_back(point.get<PlatformPoint>());
        }
        std::vector<double> geometry;
        for (const GeometryParameter& parameter : by.description.geometry) geometry.push_back(parameter.published);
        model = by.build_with_points(geometry, 0, points);
      }
      const ModelDescription& description = model->description();
      const std::vector<double> pose = values_of(one["pose"], description.pose_coordinates);
      const std::vector<double> errors = values_of(one["errors"], description.factors);
      // With the platform metric the oracle compares limbs in pairs, which is the same only to first order.
      const double rotation = one[metric]["response"]["rotation"];
      const double tolerance = &by == &entry ? 3e-8 + 1e-5 * rotation : 1e-10;
      for (const auto method : {SolverOptions::Method::newton, SolverOptions::Method::gauss_newton}) {
        expect_responses(one[metric]["response"], description,
                         evaluate(*model, pose, errors, {.method = method, .tolerance = description.tolerance}),
                         tolerance);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Mechanisms, OfOracle, testing::Values("rps3", "ups6", "upr2-rpu"));

}  // namespace
}  // namespace poesy::file
