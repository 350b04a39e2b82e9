#include "engine/model/own_responses.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/model/forwarding_model.h"

namespace poesy {
namespace {

/// "x and -20 mm times theta_x".
std::string terms_text(const OwnResponse& own, const ModelDescription& model) {
  std::string text;
  for (std::size_t k = 0; k < own.terms.size(); ++k) {
    const ResponseTerm& term = own.terms[k];
    text += k == 0 ? "" : k + 1 == own.terms.size() ? " and " : ", ";
    if (term.weighed_in != Dimension::number || term.weight != 1.0) {
      text += readable_text({term.weight, term.weighed_in}) + " times ";
    }
    text += model.responses[term.response].name;
  }
  return text;
}

/// As the model has it.
Response response_of(const OwnResponse& own, const ModelDescription& model) {
  Response response{own.name, own.dimension, own.description};
  if (response.description.empty()) {
    response.description = (own.is_norm ? "root of the sum of squares of " : "sum of ") + terms_text(own, model) +
                           ", a response of one's own";
  }
  response.has_no_sign = own.is_norm;
  bool has_signs = own.is_norm;
  for (const ResponseTerm& term : own.terms) {
    const Response& part = model.responses[term.response];
    response.mean_square_bound = std::max(response.mean_square_bound, part.mean_square_bound);
    has_signs = has_signs && !part.is_magnitude();
    response.components.push_back(term.response);
  }
  if (!has_signs) response.components.clear();
  return response;
}

ModelDescription described(ModelDescription model, const std::vector<OwnResponse>& own) {
  std::vector<std::size_t> first(own.size());
  std::iota(first.begin(), first.end(), model.responses.size());
  std::vector<Response> made;
  for (const OwnResponse& one : own) made.push_back(response_of(one, model));
  model.responses.insert(model.responses.end(), made.begin(), made.end());
  for (std::vector<std::size_t>* shown : {&model.headline, &model.signed_headline}) {
    if (!shown->empty()) shown->insert(shown->begin(), first.begin(), first.end());
  }
  return model;
}

/// Forms a response of each sample, `to`, from those of the model, rows [R x samples].
void form(const OwnResponse& own, std::span<const double> rows, std::span<double> to) {
  std::ranges::fill(to, 0.0);
  for (const ResponseTerm& term : own.terms) {
    const std::span<const double> row = rows.subspan(term.response * to.size(), to.size());
    for (std::size_t b = 0; b < to.size(); ++b) {
      const double value = term.weight * row[b];
      to[b] += own.is_norm ? value * value : value;
    }
  }
  if (!own.is_norm) return;
  for (double& value : to) value = std::sqrt(value);
}

class EvaluatorOfOwn final : public Evaluator {
 public:
  EvaluatorOfOwn(std::unique_ptr<Evaluator> inner, const std::vector<OwnResponse>& own, std::size_t responses)
      : inner_(std::move(inner)), own_(own), responses_(responses) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    OutcomeBlock inner = outcomes;
    inner.responses = outcomes.responses.first(responses_ * samples.count);
    inner_->evaluate(samples, inner);
    std::span<double> left = outcomes.responses.subspan(inner.responses.size());
    for (const OwnResponse& own : own_) {
      form(own, inner.responses, left.first(samples.count));
      left = left.subspan(samples.count);
    }
  }

 private:
  std::unique_ptr<Evaluator> inner_;
  const std::vector<OwnResponse>& own_;
  std::size_t responses_;  ///< of the model
};

class ModelOfOwn final : public ForwardingModel {
 public:
  ModelOfOwn(std::unique_ptr<Model> model, std::vector<OwnResponse> own)
      : ForwardingModel(std::move(model)), own_(std::move(own)), description_(described(inner(), own_)) {}

  const ModelDescription& description() const override { return description_; }

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override {
    return with_own(ForwardingModel::evaluator(options));
  }
  std::unique_ptr<Evaluator> calibrated_evaluator(const SolverOptions& options) const override {
    return with_own(ForwardingModel::calibrated_evaluator(options));
  }

  std::optional<SolveTrace> trace(std::span<const double> pose, std::span<const double> errors,
                                  const SolverOptions& options) const override {
    std::optional<SolveTrace> trace = ForwardingModel::trace(pose, errors, options);
    if (!trace) return trace;
    const std::size_t known = trace->responses.size();
    trace->responses.resize(known + own_.size());
    const std::span<double> all(trace->responses);
    for (std::size_t k = 0; k < own_.size(); ++k) form(own_[k], all.first(known), all.subspan(known + k, 1));
    return trace;
  }

  std::vector<double> norm_of_details(std::size_t response, std::span<const double> pose) const override {
    return is_own(response) ? std::vector<double>() : ForwardingModel::norm_of_details(response, pose);
  }

  /// The sum of what its terms round to.
  double rounding(std::size_t response) const override {
    if (!is_own(response)) return ForwardingModel::rounding(response);
    double sum = 0.0;
    for (const ResponseTerm& term : own_[response - inner().responses.size()].terms) {
      sum += std::abs(term.weight) * ForwardingModel::rounding(term.response);
    }
    return sum;
  }

 private:
  const ModelDescription& inner() const { return ForwardingModel::description(); }
  bool is_own(std::size_t response) const { return response >= inner().responses.size(); }

  std::unique_ptr<Evaluator> with_own(std::unique_ptr<Evaluator> evaluator) const {
    if (evaluator == nullptr) return nullptr;
    return std::make_unique<EvaluatorOfOwn>(std::move(evaluator), own_, inner().responses.size());
  }

  std::vector<OwnResponse> own_;
  ModelDescription description_;
};

}  // namespace

std::optional<Dimension> dimension_of(const ResponseTerm& term, const ModelDescription& model) {
  const Dimension own = model.responses[term.response].dimension;
  if (term.weighed_in == Dimension::number) return own;
  switch (own) {
    case Dimension::angle:
    case Dimension::number:
      return Dimension::length;
    case Dimension::force:
      return Dimension::moment;
    default:
      return std::nullopt;
  }
}

CatalogEntry with_responses(CatalogEntry entry, const std::vector<OwnResponse>& own) {
  if (own.empty()) return entry;
  entry.description = described(std::move(entry.description), own);
  entry.build = [build = std::move(entry.build), own](std::span<const double> geometry, std::size_t fidelity) {
    return std::make_unique<ModelOfOwn>(build(geometry, fidelity), own);
  };
  if (entry.build_with_points) {
    entry.build_with_points = [build = std::move(entry.build_with_points), own](std::span<const double> geometry,
                                                                                std::size_t fidelity,
                                                                                std::span<const PlatformPoint> points) {
      return std::make_unique<ModelOfOwn>(build(geometry, fidelity, points), own);
    };
  }
  return entry;
}

}  // namespace poesy
