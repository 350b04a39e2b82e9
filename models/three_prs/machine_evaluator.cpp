#include "models/three_prs/evaluators.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/base/contract.h"
#include "models/three_prs/slides.h"

namespace poesy::three_prs {
namespace {

using Vector3 = lie::Vector3<double>;

/// A varied error of the slides: its index among the slides' errors, and its row in SampleBlock::values.
struct VariedSlide {
  std::size_t factor;
  std::size_t row;
};

class MachineEvaluator final : public Evaluator {
 public:
  MachineEvaluator(const Geometry& geometry, Fidelity fidelity, std::unique_ptr<Evaluator> head)
      : geometry_(geometry), fidelity_(fidelity), head_(std::move(head)) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    POESY_EXPECTS(samples.pose.size() == 5 && samples.errors.size() == kFactors + kSlideFactors);
    POESY_EXPECTS(outcomes.responses.size() == kResponses * samples.count);
    part(samples);
    if (head_varied_.empty()) {
      evaluate_head_once(samples, outcomes);
    } else {
      evaluate_head(samples, outcomes);
    }
    if (fidelity_ == Fidelity::exact) {
      carry_by_slides(samples, outcomes.responses);
    } else {
      add_slides(samples, outcomes.responses);
    }
    fill_norms(outcomes);
  }

 private:
  void part(const SampleBlock& samples) {
    head_varied_.clear();
    slides_varied_.clear();
    for (std::size_t v = 0; v < samples.varied.size(); ++v) {
      const std::size_t factor = samples.varied[v].value;
      if (factor < kFactors) {
        head_varied_.push_back(samples.varied[v]);
      } else {
        slides_varied_.push_back({factor - kFactors, v});
      }
    }
  }

  /// The rows of samples.values that belong to errors of the head. Usually they are the first rows and need no copy.
  std::span<const double> head_values(const SampleBlock& samples) {
    const std::size_t size = head_varied_.size() * samples.count;
    if (std::ranges::equal(head_varied_, samples.varied.first(head_varied_.size()))) return samples.values.first(size);
    head_values_.clear();
    for (std::size_t v = 0; v < samples.varied.size(); ++v) {
      if (samples.varied[v].value >= kFactors) continue;
      const auto row = samples.values.subspan(v * samples.count, samples.count);
      head_values_.insert(head_values_.end(), row.begin(), row.end());
    }
    return head_values_;
  }

  void evaluate_head(const SampleBlock& samples, const OutcomeBlock& outcomes) {
    head_->evaluate({samples.pose.first(3), samples.errors.first(kFactors), head_varied_, head_values(samples),
                     samples.count, samples.range},
                    outcomes);
  }

  /// Evaluates the head once for all samples, because none of its errors vary.
  void evaluate_head_once(const SampleBlock& samples, const OutcomeBlock& outcomes) {
    std::array<double, kResponses> responses;
    std::array<double, kLimbs> details;
    SolveStatus status{};
    std::uint32_t iterations = 0;
    const std::size_t wanted = outcomes.details.empty() ? 0 : kLimbs;
    head_->evaluate({samples.pose.first(3), samples.errors.first(kFactors), {}, {}, 1},
                    {responses, {&status, 1}, {&iterations, 1}, std::span(details).first(wanted)});
    const auto repeat = [&](std::span<const double> rows, std::span<double> out) {
      for (std::size_t r = 0; r < rows.size(); ++r)
        std::ranges::fill(out.subspan(r * samples.count, samples.count), rows[r]);
    };
    repeat(responses, outcomes.responses);
    repeat(std::span(details).first(wanted), outcomes.details);
    std::ranges::fill(outcomes.status, status);
    std::ranges::fill(outcomes.iterations, iterations);
  }

  /// P and the tool tip in the head's frame at the nominal pose, m.
  struct Points {
    Vector3 P;
    Vector3 tip;
  };

  Points points(const SampleBlock& samples) const {
    const auto platform = base_T_platform(geometry_, {samples.pose[0], samples.pose[1], samples.pose[2]});
    return {platform.p, platform.p + tool(geometry_, platform.R)};
  }

  /// The constant errors of the slides; the caller sets the varied ones.
  static std::array<double, kSlideFactors> slide_errors(const SampleBlock& samples) {
    std::array<double, kSlideFactors> errors;
    std::ranges::copy(samples.errors.last(kSlideFactors), errors.begin());
    return errors;
  }

  /// Adds the first-order effects of the slides' errors to the nine components of the head's responses, [9 x samples].
  void add_slides(const SampleBlock& samples, std::span<double> responses) const {
    const Points at = points(samples);
    const SlideEffects effects = slide_effects(samples.pose[4], at.P, at.tip);
    std::array<double, kSlideFactors> constant = slide_errors(samples);
    for (const VariedSlide& slide : slides_varied_) constant[slide.factor] = 0.0;
    const Eigen::Matrix<double, kSwing, 1> shift =
        effects * Eigen::Map<const Eigen::Matrix<double, kSlideFactors, 1>>(constant.data());
    for (int r = 0; r < kSwing; ++r) {
      double* out = responses.data() + static_cast<std::size_t>(r) * samples.count;
      for (std::size_t b = 0; b < samples.count; ++b) out[b] += shift[r];
      for (const VariedSlide& slide : slides_varied_) {
        const double effect = effects(r, static_cast<Eigen::Index>(slide.factor));
        const double* values = samples.values.data() + slide.row * samples.count;
        for (std::size_t b = 0; b < samples.count; ++b) out[b] += effect * values[b];
      }
    }
  }

  /// Transforms the nine components of the head's responses, [9 x samples], by the displaced slides.
  void carry_by_slides(const SampleBlock& samples, std::span<double> responses) const {
    const Points at = points(samples);
    std::array<double, kSlideFactors> errors = slide_errors(samples);
    lie::Transform<double> slides = nominal_T_head(samples.pose[4], errors);
    for (std::size_t b = 0; b < samples.count; ++b) {
      if (!slides_varied_.empty()) {
        for (const VariedSlide& slide : slides_varied_) {
          errors[slide.factor] = samples.values[slide.row * samples.count + b];
        }
        slides = nominal_T_head(samples.pose[4], errors);
      }
      carry(slides, at, responses, b, samples.count);
    }
  }

  static void carry(const lie::Transform<double>& slides, const Points& at, std::span<double> responses,
                    std::size_t sample, std::size_t count) {
    const auto rows = [&](std::size_t first) {
      return Eigen::Map<Vector3, 0, Eigen::InnerStride<>>(responses.data() + first * count + sample,
                                                          Eigen::InnerStride<>(static_cast<Eigen::Index>(count)));
    };
    const auto displacement = [&](const Vector3& point, const Vector3& in_head) -> Vector3 {
      const Vector3 displaced = point + in_head;
      return in_head + (slides.R * displaced - displaced + slides.p);
    };
    rows(kTheta) = lie::log<double>(slides.R * lie::exp(Vector3(rows(kTheta))));
    rows(kDr) = displacement(at.P, rows(kDr));
    rows(kTip) = displacement(at.tip, rows(kTip));
  }

  Geometry geometry_;
  Fidelity fidelity_;
  std::unique_ptr<Evaluator> head_;
  std::vector<FactorIndex> head_varied_;
  std::vector<VariedSlide> slides_varied_;
  std::vector<double> head_values_;
};

}  // namespace

std::unique_ptr<Evaluator> machine_evaluator(const Geometry& geometry, Fidelity fidelity,
                                             std::unique_ptr<Evaluator> head) {
  return std::make_unique<MachineEvaluator>(geometry, fidelity, std::move(head));
}

}  // namespace poesy::three_prs
