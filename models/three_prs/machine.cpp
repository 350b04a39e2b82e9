#include "models/three_prs/model.h"

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "engine/base/contract.h"
#include "models/three_prs/evaluators.h"
#include "models/three_prs/kinematics.h"
#include "models/three_prs/slides.h"

namespace poesy::three_prs {
namespace {

constexpr std::size_t kHeadCoordinates = 3;

FactorSet set_of_places(const char* name, const char* description, std::size_t first, std::size_t last) {
  FactorSet set{name, description, {}};
  for (std::size_t f = first; f < last; ++f) set.factors.emplace_back(f);
  return set;
}

/// The sets of errors of the machine: "all", "head", "slides", then the head's own sets except its "all".
std::vector<FactorSet> machine_sets(const ModelDescription& head) {
  FactorSet slides = set_of_places("slides", "all errors of the slides", kFactors, kFactors + kSlideFactors);
  FactorSet head_set = *head.find_set("all");
  FactorSet all = head_set;
  all.description += ", head and slides";
  all.factors.insert(all.factors.end(), slides.factors.begin(), slides.factors.end());
  head_set.name = "head";
  head_set.description += ", head only";
  std::vector<FactorSet> sets{std::move(all), std::move(head_set), std::move(slides)};
  for (const FactorSet& set : head.factor_sets) {
    if (set.name != "all") sets.push_back(set);
  }
  return sets;
}

PoseChart tip_chart(const ModelDescription& head) {
  return {"tip",
          {head.pose_coordinates[0],
           head.pose_coordinates[1],
           {"tip_x", Dimension::length, "x of the tool tip in the base frame"},
           {"tip_y", Dimension::length, "y of the tool tip in the base frame"},
           {"tip_z", Dimension::length, "z of the tool tip in the base frame, downwards"}},
          "keep alpha and beta between -90 and 90 deg"};
}

void add_slide(ModelDescription& description, const std::string& letter, double travel) {
  const std::string name = "slide_" + letter;
  description.geometry.push_back({"travel_" + letter, Dimension::length, travel,
                                  "travel of the slide along " + letter +
                                      ", half of it to either side; the paper prints none, this value is chosen"});
  description.pose_coordinates.push_back(
      {name, Dimension::length, "position of the slide that moves along " + letter + " of the base frame, the rack's"});
  description.joints.push_back({name, Dimension::length, true});
  description.pose_lower.push_back(-0.5 * travel);
  description.pose_upper.push_back(0.5 * travel);
}

/// The description of the head with the additions of the slides. The base frame of the machine is the rack's frame {O}.
/// The head's frame is parallel to it, with its error-free origin at (slide_x, slide_y, 0).
ModelDescription describe() {
  const ModelDescription head = catalog_entry().description;
  const Travel chosen;
  ModelDescription description = head;
  description.name = "xy-3-prs";
  description.title =
      "Hybrid machine: rack - X slide - Y slide - 3-PRS head (San, Ding, Zhang, Wu 2023, Actuators 12, 324)";
  add_slide(description, "x", chosen.x);
  add_slide(description, "y", chosen.y);
  for (Factor& factor : slide_factors()) description.factors.push_back(std::move(factor));
  description.factor_sets = machine_sets(head);
  description.workspace_note += " The travel of the slides and their order, X below Y, are chosen as well.";
  description.charts = {tip_chart(head)};
  description.sources.push_back({"S", "slides"});
  description.curves.clear();
  description.separation.reset();
  return description;
}

class Machine final : public Model {
 public:
  Machine(const Geometry& geometry, const Travel& travel, std::unique_ptr<Model> head, Fidelity fidelity)
      : geometry_(geometry), travel_(travel), head_(std::move(head)), fidelity_(fidelity) {}

  const ModelDescription& description() const override { return description_; }

  std::optional<std::string> unreachable(std::span<const double> pose) const override {
    if (auto reason = head_->unreachable(head_pose(pose))) return reason;
    if (!(std::abs(pose[3]) <= 0.5 * travel_.x)) return "slide_x lies outside its travel, -travel_x/2 to travel_x/2";
    if (!(std::abs(pose[4]) <= 0.5 * travel_.y)) return "slide_y lies outside its travel, -travel_y/2 to travel_y/2";
    return std::nullopt;
  }

  std::vector<double> joint_displacements(std::span<const double> pose) const override {
    std::vector<double> list = head_->joint_displacements(head_pose(pose));
    list.insert(list.end(), {pose[3], pose[4]});
    return list;
  }

  double condition(std::span<const double> pose) const override { return head_->condition(head_pose(pose)); }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override {
    return machine_evaluator(geometry_, fidelity_, head_->evaluator(options));
  }

  std::optional<SolveTrace> trace(std::span<const double> pose, std::span<const double> errors,
                                  const SolverOptions& options) const override {
    std::optional<SolveTrace> trace = head_->trace(head_pose(pose), errors.first(kFactors), options);
    const SolveTrace head = *trace;
    solve_once(*machine_evaluator(geometry_, fidelity_, evaluator_of(head)), pose, errors, *trace);
    trace->solver += "; the slides carry its outcome";
    return trace;
  }

  std::optional<std::vector<double>> pose_from_chart(std::size_t /*chart*/,
                                                     std::span<const double> coordinates) const override {
    POESY_EXPECTS(coordinates.size() == 5);
    const double alpha = coordinates[0], beta = coordinates[1];
    constexpr double kQuarter = std::numbers::pi / 2.0;
    if (!(std::abs(alpha) < kQuarter && std::abs(beta) < kQuarter)) return std::nullopt;
    // Neither the platform's rotation nor its x and y depend on z.
    const lie::Transform<double> platform = base_T_platform(geometry_, {alpha, beta, 0.0});
    const lie::Vector3<double> tip = platform.p + tool(geometry_, platform.R);
    return std::vector{alpha, beta, coordinates[4] - tip.z(), coordinates[2] - tip.x(), coordinates[3] - tip.y()};
  }

  double rounding(std::size_t response) const override { return head_->rounding(response); }

  ErrorBound error_bound(FactorIndex factor) const override {
    if (factor.value < kFactors) return head_->error_bound(factor);
    const Factor& error = description_.factors[factor.value];
    if (error.dimension != Dimension::length) return Model::error_bound(factor);
    return error.limb == kLimbs + 1 ? ErrorBound{travel_.x, "the travel of the X slide"}
                                    : ErrorBound{travel_.y, "the travel of the Y slide"};
  }

  std::vector<std::string> unusual_geometry() const override { return head_->unusual_geometry(); }

 private:
  static std::span<const double> head_pose(std::span<const double> pose) {
    POESY_EXPECTS(pose.size() == kHeadCoordinates + 2);
    return pose.first(kHeadCoordinates);
  }

  Geometry geometry_;
  Travel travel_;
  std::unique_ptr<Model> head_;
  Fidelity fidelity_;
  ModelDescription description_ = describe();
};

std::unique_ptr<Model> build(std::span<const double> values, std::size_t fidelity) {
  POESY_EXPECTS(values.size() == 7 && fidelity < 2);
  std::unique_ptr<Model> head = catalog_entry().build(values.first(5), fidelity);
  if (!(values[5] > 0.0)) throw std::invalid_argument("travel_x must be positive");
  if (!(values[6] > 0.0)) throw std::invalid_argument("travel_y must be positive");
  return std::make_unique<Machine>(Geometry{values[0], values[1], values[2], values[3], values[4]},
                                   Travel{values[5], values[6]}, std::move(head), static_cast<Fidelity>(fidelity));
}

}  // namespace

CatalogEntry machine_catalog_entry() { return {describe(), build}; }

}  // namespace poesy::three_prs
