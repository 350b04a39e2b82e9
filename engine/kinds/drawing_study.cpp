#include "engine/kinds/drawing_study.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/nan.h"
#include "engine/drawing/worst_case.h"
#include "engine/drawing/zone_moments.h"
#include "engine/drawing/zone_scatter.h"
#include "engine/study/study_kind.h"

namespace poesy {
namespace {

using drawing::OfErrors;

namespace axis {
using namespace poesy::axis;
using Side = Axis<"side">;  ///< The direction of a step of an error: Slopes::kUp or Slopes::kDown.
}  // namespace axis

constexpr std::string_view kNone = "-";

/// The step of the central differences, in standard deviations of the error: so small that curvature hardly changes a
/// slope, but far above the rounding of the solves.
constexpr double kDifferenceStep = 1.0 / 16.0;

/// The features with a tolerance zone or a clearance whose errors all vary in the study.
std::vector<Feature> varied_features(const Study& study) {
  const auto varies = [&](FactorIndex error) {
    return std::ranges::find(study.analysis.factors, error) != study.analysis.factors.end();
  };
  std::vector<Feature> list;
  for (const Feature& feature : study.model().features) {
    const bool has_zone = feature.clearance || ((feature.location || feature.orientation) && study.errors.zones);
    if (has_zone && std::ranges::all_of(feature.errors(), varies)) {
      list.push_back(feature);
    }
  }
  return list;
}

/// Computes the slopes of all responses with respect to the errors of features, at one pose.
class Slopes {
 public:
  /// Positions on the axis Side: a step of the error in the positive and in the negative direction.
  /// @{
  static constexpr std::size_t kUp = 0;
  static constexpr std::size_t kDown = 1;
  /// @}

  Slopes(const StudyRun& run, const std::vector<Feature>& features)
      : evaluator_(run.model.evaluator(run.study.solver)), constant_(run.study.model().factors.size(), 0.0) {
    for (const Feature& feature : features) {
      first_.push_back(errors_.size());
      for (const FactorIndex error : feature.errors()) {
        errors_.push_back(error);
        steps_.push_back(kDifferenceStep * run.study.errors.by_factor[error.value].standard_deviation());
      }
    }
    first_.push_back(errors_.size());
    const std::size_t count = errors_.size();
    values_ = Array<double, axis::Factor, axis::Side, axis::Sample>({count, 2, count}, 0.0);
    for (std::size_t e = 0; e < count; ++e) {
      values_(e, kUp, e) = steps_[e];
      values_(e, kDown, e) = -steps_[e];
    }
    found_ = Array<double, axis::Response, axis::Side, axis::Sample>({run.study.model().responses.size(), 2, count});
    status_ = Array<SolveStatus, axis::Side, axis::Sample>({2, count});
    iterations_.resize(2 * count);
  }

  void set_pose(const PoseSet& poses, std::size_t pose) {
    SampleBlock samples{poses[PoseIndex(pose)], constant_, errors_, values_.all(), iterations_.size()};
    if (pose > 0) samples.previous = poses[PoseIndex(pose - 1)];
    evaluator_->evaluate(samples, {found_.all(), status_.all(), iterations_, {}});
  }

  /// The slopes of a response, which must have a sign, with respect to the errors of a feature. NaN for an error if a
  /// solve with its steps failed at the pose.
  OfErrors of(std::size_t response, std::size_t feature) const {
    OfErrors list;
    for (std::size_t e = first_[feature]; e < first_[feature + 1]; ++e) {
      const bool is_solved = solved(status_(kUp, e)) && solved(status_(kDown, e));
      const double change = found_(response, kUp, e) - found_(response, kDown, e);
      list.push_back(is_solved ? change / (2.0 * steps_[e]) : kNaN);
    }
    return list;
  }

 private:
  std::unique_ptr<Evaluator> evaluator_;
  std::vector<double> constant_;
  std::vector<FactorIndex> errors_;
  std::vector<std::size_t> first_;  ///< [features + 1] position of each feature's first error
  std::vector<double> steps_;
  Array<double, axis::Factor, axis::Side, axis::Sample> values_;
  Array<double, axis::Response, axis::Side, axis::Sample> found_;
  Array<SolveStatus, axis::Side, axis::Sample> status_;
  std::vector<std::uint32_t> iterations_;
};

/// The responses with a sign from which a response is computed: the response itself, or its components if it is a norm.
/// Empty if the response has no sign and is not a norm (Response::has_no_sign), or if it has more than three
/// components.
std::vector<std::size_t> components(const ModelDescription& model, std::size_t response) {
  const Response& one = model.responses[response];
  if (one.has_no_sign || one.components.size() > 3) return {};
  return one.components.empty() ? std::vector{response} : one.components;
}

std::string kind_name(FeatureKind kind) {
  switch (kind) {
    case FeatureKind::axis:
      return "axis";
    case FeatureKind::rectangle:
      return "rectangle";
    case FeatureKind::round:
      return "round";
    case FeatureKind::point:
      return "point";
    case FeatureKind::distance:
      break;
  }
  return "distance";
}

std::string key_of(const std::optional<Zone>& zone) { return std::string(zone ? zone->key : kNone); }
std::string datums_of(const std::optional<Zone>& zone) {
  return zone && !zone->datums.empty() ? zone->datums : std::string(kNone);
}

/// A result that describes the features, and whose effects are still NaN.
DrawingResult described(const StudyRun& run, const std::vector<Feature>& features) {
  DrawingResult made;
  const std::size_t count = features.size();
  for (auto* texts :
       {&made.label, &made.kind, &made.location, &made.location_datums, &made.orientation, &made.orientation_datums}) {
    *texts = DrawingResult::Texts({count});
  }
  for (auto* sizes : {&made.length, &made.location_zone, &made.orientation_zone, &made.sigmas}) {
    *sizes = DrawingResult::Sizes({count}, 0.0);
  }
  made.limb = Array<std::uint64_t, axis::Feature>({count}, 0);
  for (std::size_t q = 0; q < count; ++q) {
    const Feature& one = features[q];
    made.names.push_back(one.name);
    made.label(q) = one.label;
    made.limb(q) = one.limb;
    made.kind(q) = kind_name(one.kind);
    made.length(q) = one.size[0];
    made.location(q) = one.clearance ? "clearance" : key_of(one.location);
    made.location_zone(q) = one.clearance ? one.clearance->most : one.location ? one.location->size : 0.0;
    made.location_datums(q) = datums_of(one.location);
    made.orientation(q) = key_of(one.orientation);
    made.orientation_zone(q) = one.orientation ? one.orientation->size : 0.0;
    made.orientation_datums(q) = datums_of(one.orientation);
    const bool has_sigmas = !one.clearance && run.study.errors.zones->has_sigmas();
    made.sigmas(q) = has_sigmas ? drawing::sigmas_of(one, *run.study.errors.zones) : 0.0;
  }
  const std::size_t responses = run.study.model().responses.size();
  for (auto* list : {&made.effect, &made.share, &made.worst_share}) {
    *list = DrawingResult::OfFeatures({responses, count}, kNaN);
  }
  for (auto* list : {&made.rms, &made.rms_worst_division, &made.worst_case}) {
    *list = DrawingResult::AtPoses({responses, run.poses.size()}, kNaN);
  }
  return made;
}

/// [features] The variances (SI) of each feature's errors, if one of them has another distribution than its zone
/// states, such as a measured distribution. Empty for a feature whose errors all scatter as the zones state.
std::vector<OfErrors> own_variances(const Study& study, const std::vector<Feature>& features) {
  const auto by_zones = distributions_by_zones(study);
  std::vector<OfErrors> variances(features.size());
  for (std::size_t q = 0; q < features.size(); ++q) {
    const std::vector<FactorIndex> errors = features[q].errors();
    const auto is_own = [&](FactorIndex error) {
      return by_zones[error.value] && study.errors.by_factor[error.value] != *by_zones[error.value];
    };
    if (std::ranges::none_of(errors, is_own)) continue;
    for (const FactorIndex error : errors) {
      const double sigma = study.errors.by_factor[error.value].standard_deviation();
      variances[q].push_back(sigma * sigma);
    }
  }
  return variances;
}

/// The mean square of a response to errors with these variances (SI). squares: squared slope of the response for each
/// error.
drawing::ZoneSquares own_squares(const OfErrors& variances, const OfErrors& squares) {
  double sum = 0.0;
  for (std::size_t e = 0; e < squares.size(); ++e) sum += squares[e] * variances[e];
  return {.even = sum, .worst = sum};
}

/// The effects of features on one response, SI, over the poses so far.
struct OverPoses {
  std::vector<double> squares;     ///< [features] sum over the poses of the mean square that each feature causes
  double worst = -1.0;             ///< largest worst case over the poses; -1 before the first pose
  std::vector<double> at_worst{};  ///< [features] contribution of each feature to that worst case
};

/// How features scatter: as their zones state, or with the variances of other distributions.
struct FeatureScatter {
  drawing::ZoneScatter in_zones;
  std::vector<OfErrors> own;  ///< [features] see own_variances()
  /// [features] Standard deviations of the errors as the zones state them; unset for a feature with variances in `own`.
  std::vector<drawing::FeatureSigmas> sigmas;
};

FeatureScatter scatter_of(const Study& study, const std::vector<Feature>& features) {
  FeatureScatter scatter{study.errors.zones.value_or(drawing::ZoneScatter()), own_variances(study, features), {}};
  for (std::size_t q = 0; q < features.size(); ++q) {
    scatter.sigmas.push_back(scatter.own[q].empty() ? drawing::scatter_sigmas(features[q], scatter.in_zones)
                                                    : drawing::FeatureSigmas());
  }
  return scatter;
}

/// Adds the effects at pose m to the sums of response r, and sets the result at this pose. slopes:
/// [features][components of the response] slopes with respect to the feature's errors.
void add_pose(const std::vector<Feature>& features, const FeatureScatter& scatter,
              const std::vector<std::vector<OfErrors>>& slopes, std::size_t r, std::size_t m, OverPoses& sums,
              DrawingResult& result) {
  double even = 0.0;
  double worst = 0.0;
  for (std::size_t q = 0; q < features.size(); ++q) {
    OfErrors squares(slopes[q].front().size(), 0.0);
    for (const OfErrors& component : slopes[q]) {
      for (std::size_t e = 0; e < squares.size(); ++e) squares[e] += component[e] * component[e];
    }
    const drawing::ZoneSquares found =
        scatter.own[q].empty() ? drawing::zone_squares(features[q], scatter.in_zones, scatter.sigmas[q], squares)
                               : own_squares(scatter.own[q], squares);
    sums.squares[q] += found.even;
    even += found.even;
    worst += found.worst;
  }
  result.rms(r, m) = std::sqrt(even);
  result.rms_worst_division(r, m) = std::sqrt(worst);
  if (!std::isfinite(even)) return;
  drawing::LargestLength largest = drawing::largest_length(features, slopes);
  result.worst_case(r, m) = largest.length;
  if (largest.length <= sums.worst) return;
  sums.worst = largest.length;
  sums.at_worst = std::move(largest.by_feature);
}

/// Whether the study correlates an error of a feature with others.
bool correlates(const Study& study, const std::vector<Feature>& features) {
  return std::ranges::any_of(study.errors.correlated, [&](const CorrelatedErrors& block) {
    return std::ranges::any_of(features, [&](const Feature& feature) {
      return std::ranges::any_of(feature.errors(), [&](FactorIndex error) {
        return std::ranges::find(block.factors, error) != block.factors.end();
      });
    });
  });
}

/// Sets to NaN the numbers that are correct only for independent errors: the shares of features, and the root mean
/// squares of all features together.
void remove_sums(DrawingResult& result) {
  std::ranges::fill(result.share.all(), kNaN);
  std::ranges::fill(result.rms.all(), kNaN);
  std::ranges::fill(result.rms_worst_division.all(), kNaN);
}

void finish(const OverPoses& sums, std::size_t r, DrawingResult& result) {
  double all = 0.0;
  for (const double square : sums.squares) all += square;
  const auto poses = static_cast<double>(result.rms.length<axis::Pose>());
  for (std::size_t q = 0; q < sums.squares.size(); ++q) {
    result.effect(r, q) = std::sqrt(sums.squares[q] / poses);
    result.share(r, q) = sums.squares[q] / all;
    if (sums.worst > 0.0) result.worst_share(r, q) = sums.at_worst[q] / sums.worst;
  }
}

}  // namespace

std::optional<DrawingResult> drawing_result(const StudyRun& run) {
  const Study& study = run.study;
  if (study.analysis.kind->varies == Varies::none) return std::nullopt;
  const std::vector<Feature> features = varied_features(study);
  if (features.empty()) return std::nullopt;
  const ModelDescription& model = study.model();
  DrawingResult result = described(run, features);
  const FeatureScatter scatter = scatter_of(study, features);
  Slopes slopes(run, features);
  std::vector<OverPoses> sums(model.responses.size(), {std::vector<double>(features.size(), 0.0)});
  std::vector<std::vector<std::size_t>> signed_ones;
  for (std::size_t r = 0; r < model.responses.size(); ++r) signed_ones.push_back(components(model, r));
  for (std::size_t m = 0; m < run.poses.size(); ++m) {
    slopes.set_pose(run.poses, m);
    for (std::size_t r = 0; r < model.responses.size(); ++r) {
      if (signed_ones[r].empty()) continue;
      std::vector<std::vector<OfErrors>> of_features(features.size());
      for (std::size_t q = 0; q < features.size(); ++q) {
        for (const std::size_t component : signed_ones[r]) of_features[q].push_back(slopes.of(component, q));
      }
      add_pose(features, scatter, of_features, r, m, sums[r], result);
    }
  }
  for (std::size_t r = 0; r < model.responses.size(); ++r) {
    if (!signed_ones[r].empty()) finish(sums[r], r, result);
  }
  if (correlates(study, features)) remove_sums(result);
  return result;
}

}  // namespace poesy
