#include "engine/model/own_responses.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "engine/base/text.h"
#include "engine/base/units.h"
#include "engine/model/forwarding_model.h"

namespace poesy {
namespace {

/// The terms of a response as text, such as "x and -20 mm times theta_x".
std::string terms_text(const OwnResponse& own, const ModelDescription& model) {
  std::string text;
  for (std::size_t k = 0; k < own.terms.size(); ++k) {
    const ResponseTerm& term = own.terms[k];
    text += k == 0 ? "" : k + 1 == own.terms.size() ? " and " : ", ";
    if (!term.is_inverse && (term.weighed_in != Dimension::number || term.weight != 1.0)) {
      text += readable_text({term.weight, term.weighed_in}) + " times ";
    }
    text += model.responses[term.response].name;
    if (term.is_inverse) text += " over " + readable_text({1.0 / term.weight, term.weighed_in});
  }
  return text;
}

/// The reference pose as text, such as "at x = 0 mm, y = 0 mm, z = 200 mm".
std::string pose_text(const ReferencePose& reference, const ModelDescription& model) {
  if (reference.is_previous()) return "at the pose before";
  std::string text = "at ";
  for (std::size_t c = 0; c < reference.pose.size(); ++c) {
    const PoseCoordinate& coordinate = model.pose_coordinates[c];
    text += (c > 0 ? ", " : "") + coordinate.name + " = " + readable_text({reference.pose[c], coordinate.dimension});
  }
  return text;
}

/// The user's response as an entry of ModelDescription::responses.
Response response_of(const OwnResponse& own, const ModelDescription& model) {
  Response response{own.name, own.dimension, own.description};
  if (response.description.empty()) {
    const bool is_one = own.relative_to && own.terms.size() == 1;
    response.description = (own.is_norm ? "root of the sum of squares of "
                            : is_one    ? ""
                                        : "sum of ") +
                           terms_text(own, model) + ", a response of one's own";
  }
  if (own.relative_to) response.description += ", less its value " + pose_text(*own.relative_to, model);
  response.has_no_sign = own.is_norm;
  response.is_relative = own.relative_to.has_value();
  bool has_signs = own.is_norm;
  for (const ResponseTerm& term : own.terms) {
    const Response& part = model.responses[term.response];
    response.mean_square_bound = std::max(response.mean_square_bound, part.mean_square_bound);
    response.is_relative = response.is_relative || part.is_relative;
    has_signs = has_signs && !part.is_magnitude();
    response.components.push_back(term.response);
  }
  if (!has_signs) response.components.clear();
  return response;
}

/// Computes one of the user's responses for each sample. rows: the values of all responses [responses x samples],
/// row-major, of which the terms are read. to: receives the values of this response [samples].
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

/// Returns the worse status of two solves of the same sample at different poses, and `one` if both are equally bad.
SolveStatus worse(SolveStatus one, SolveStatus other) {
  const auto badness = [](SolveStatus status) { return solved(status) ? 0 : usable(status) ? 1 : 2; };
  return badness(other) > badness(one) ? other : one;
}

/// Computes the user's own responses. In an array of responses, the user's rows follow those of the model.
class OwnRows {
 public:
  /// responses: the number of the model's responses.
  OwnRows(const std::vector<OwnResponse>& own, std::size_t responses) : own_(&own), responses_(responses) {
    for (const OwnResponse& one : own) {
      if (!one.relative_to) continue;
      const bool is_known = std::ranges::find(references_, one.relative_to->pose) != references_.end();
      if (!is_known) references_.push_back(one.relative_to->pose);
    }
  }

  /// The number of the model's responses, without the user's.
  std::size_t of_model() const { return responses_; }
  /// The number of all responses.
  std::size_t all() const { return responses_ + own_->size(); }
  /// The reference poses of the relative responses, each once. An empty pose means the previous pose.
  const std::vector<std::vector<double>>& references() const { return references_; }
  /// The index in references() of the empty pose (the previous pose); none if no response is relative to the previous
  /// pose.
  std::optional<std::size_t> previous() const {
    const auto found = std::ranges::find_if(references_, &std::vector<double>::empty);
    if (found == references_.end()) return std::nullopt;
    return static_cast<std::size_t>(found - references_.begin());
  }

  /// Computes the user's responses in `rows` [all() x samples], as if no response were relative to a pose.
  void form_all(std::span<double> rows, std::size_t samples) const {
    for (std::size_t k = 0; k < own_->size(); ++k) form((*own_)[k], rows, row(rows, k, samples));
  }

  /// Subtracts the responses `there` at a reference pose from those rows of responses that are relative to this pose.
  /// reference: index of the pose in references(). If `there` is empty, sets these rows to 0.
  void subtract(std::span<double> rows, std::size_t reference, std::span<const double> there,
                std::size_t samples) const {
    for (std::size_t k = 0; k < own_->size(); ++k) {
      const OwnResponse& own = (*own_)[k];
      if (!own.relative_to || own.relative_to->pose != references_[reference]) continue;
      const std::span<double> to = row(rows, k, samples);
      if (there.empty()) std::ranges::fill(to, 0.0);
      for (std::size_t b = 0; b < samples && !there.empty(); ++b) {
        to[b] -= there[(responses_ + k) * samples + b];
      }
    }
  }

  /// Computes the user's responses without a reference pose once more: their terms may be responses with a reference
  /// pose, which subtract() has changed.
  void form_the_rest(std::span<double> rows, std::size_t samples) const {
    for (std::size_t k = 0; k < own_->size(); ++k) {
      if (!(*own_)[k].relative_to) form((*own_)[k], rows, row(rows, k, samples));
    }
  }

 private:
  std::span<double> row(std::span<double> rows, std::size_t own, std::size_t samples) const {
    return rows.subspan((responses_ + own) * samples, samples);
  }

  const std::vector<OwnResponse>* own_;
  std::size_t responses_;
  std::vector<std::vector<double>> references_;
};

/// The samples of a block and their responses at one pose. The same samples are usually solved at one pose after the
/// other, so their responses at a reference pose, once stored here, need not be computed again.
struct SolvedBlock {
  std::vector<double> pose;
  std::vector<double> errors;
  std::vector<FactorIndex> varied;
  std::vector<double> values;
  std::size_t count = 0;
  double range = 0.0;
  std::vector<double> responses;  ///< [OwnRows::all() x count], before reference values are subtracted
  std::vector<SolveStatus> status;
  std::vector<std::uint32_t> iterations;

  bool is_of(std::span<const double> wanted, const SampleBlock& samples) const {
    return count == samples.count && range == samples.range && std::ranges::equal(pose, wanted) &&
           std::ranges::equal(errors, samples.errors) && std::ranges::equal(varied, samples.varied) &&
           std::ranges::equal(values, samples.values);
  }
  void begin(std::span<const double> wanted, const SampleBlock& samples) {
    pose.assign(wanted.begin(), wanted.end());
    errors.assign(samples.errors.begin(), samples.errors.end());
    varied.assign(samples.varied.begin(), samples.varied.end());
    values.assign(samples.values.begin(), samples.values.end());
    count = samples.count;
    range = samples.range;
  }
};

class EvaluatorOfOwn final : public Evaluator {
 public:
  EvaluatorOfOwn(std::unique_ptr<Evaluator> inner, const OwnRows& rows)
      : inner_(std::move(inner)), rows_(&rows), there_(rows.references().size()) {}

  void evaluate(const SampleBlock& samples, const OutcomeBlock& outcomes) override {
    OutcomeBlock inner = outcomes;
    inner.responses = outcomes.responses.first(rows_->of_model() * samples.count);
    inner_->evaluate(samples, inner);
    rows_->form_all(outcomes.responses, samples.count);
    if (there_.empty()) return;
    if (rows_->previous()) keep(samples, outcomes);
    for (std::size_t n = 0; n < there_.size(); ++n) subtract(n, samples, outcomes);
    rows_->form_the_rest(outcomes.responses, samples.count);
    if (rows_->previous()) std::swap(there_[*rows_->previous()], here_);
  }

 private:
  void subtract(std::size_t n, const SampleBlock& samples, const OutcomeBlock& outcomes) {
    const std::span<const double> pose = rows_->previous() == n ? samples.previous : std::span(rows_->references()[n]);
    if (pose.empty()) return rows_->subtract(outcomes.responses, n, {}, samples.count);
    SolvedBlock& there = there_[n];
    if (!there.is_of(pose, samples)) solve(pose, samples, there);
    rows_->subtract(outcomes.responses, n, there.responses, samples.count);
    for (std::size_t b = 0; b < samples.count; ++b) {
      outcomes.status[b] = worse(outcomes.status[b], there.status[b]);
    }
  }

  void solve(std::span<const double> pose, const SampleBlock& samples, SolvedBlock& block) {
    block.begin(pose, samples);
    block.responses.resize(rows_->all() * samples.count);
    block.status.resize(samples.count);
    block.iterations.resize(samples.count);
    SampleBlock other = samples;
    other.pose = pose;
    other.previous = {};
    inner_->evaluate(
        other,
        {std::span(block.responses).first(rows_->of_model() * samples.count), block.status, block.iterations, {}});
    rows_->form_all(block.responses, samples.count);
  }

  /// Stores the samples and their responses at the present pose, because responses at the next pose may be relative to
  /// them.
  void keep(const SampleBlock& samples, const OutcomeBlock& outcomes) {
    here_.begin(samples.pose, samples);
    here_.responses.assign(outcomes.responses.begin(), outcomes.responses.end());
    here_.status.assign(outcomes.status.begin(), outcomes.status.end());
  }

  std::unique_ptr<Evaluator> inner_;
  const OwnRows* rows_;
  std::vector<SolvedBlock> there_;  ///< [reference poses] the block that was last solved at each reference pose
  SolvedBlock here_;  ///< the block at the present pose; responses of the next block may be relative to it
};

/// Throws InputError, with the place of the pose in the study, if a response is relative to a pose that the model does
/// not reach.
void check_references(const std::vector<OwnResponse>& own, const Model& model) {
  for (const OwnResponse& one : own) {
    if (!one.relative_to || one.relative_to->is_previous()) continue;
    const auto reason = model.unreachable(one.relative_to->pose);
    if (!reason) continue;
    throw InputError(one.relative_to->place,
                     "'" + one.name + "' is relative to a pose that the mechanism does not reach: " + *reason,
                     "take a pose of the workspace");
  }
}

class ModelOfOwn final : public ForwardingModel {
 public:
  ModelOfOwn(std::unique_ptr<Model> model, std::vector<OwnResponse> own)
      : ForwardingModel(std::move(model)),
        own_(std::move(own)),
        rows_(own_, inner().responses.size()),
        description_(described(inner(), own_)) {
    check_references(own_, *this);
  }

  const ModelDescription& description() const override { return description_; }

  std::unique_ptr<Evaluator> formed(std::unique_ptr<Evaluator> evaluator) const override {
    if (evaluator == nullptr) return nullptr;
    return std::make_unique<EvaluatorOfOwn>(std::move(evaluator), rows_);
  }

  std::vector<std::string> remarks() const override {
    std::vector<std::string> list = ForwardingModel::remarks();
    for (const OwnResponse& own : own_) {
      if (!own.relative_to) continue;
      list.push_back(own.name + " is less its value " + pose_text(*own.relative_to, description_) +
                     (own.relative_to->is_previous() ? "; at the first pose it is 0"
                                                     : ": each machine is solved once more there, and has a solution "
                                                       "nowhere if it has none there"));
    }
    return list;
  }

  /// The trace of one pose. A response that is relative to the previous pose is NaN, because a trace has no previous
  /// pose.
  std::optional<SolveTrace> trace(std::span<const double> pose, std::span<const double> errors,
                                  const SolverOptions& options) const override {
    std::optional<SolveTrace> trace = formed_trace(pose, errors, options);
    if (!trace || rows_.references().empty()) return trace;
    for (std::size_t n = 0; n < rows_.references().size(); ++n) {
      const std::vector<double>& reference = rows_.references()[n];
      const std::optional<SolveTrace> there =
          reference.empty() ? std::nullopt : formed_trace(reference, errors, options);
      const std::vector<double> unknown(rows_.all(), std::numeric_limits<double>::quiet_NaN());
      rows_.subtract(trace->responses, n, there ? there->responses : unknown, 1);
      if (there) trace->status = worse(trace->status, there->status);
    }
    rows_.form_the_rest(trace->responses, 1);
    return trace;
  }

  std::vector<double> norm_of_details(std::size_t response, std::span<const double> pose) const override {
    return is_own(response) ? std::vector<double>() : ForwardingModel::norm_of_details(response, pose);
  }

  /// For one of the user's responses: the sum of |weight| x rounding over its terms. It is doubled for a response that
  /// is relative to a reference pose, because it is the difference of values at two poses.
  double rounding(std::size_t response) const override {
    if (!is_own(response)) return ForwardingModel::rounding(response);
    const OwnResponse& own = own_[response - inner().responses.size()];
    double sum = 0.0;
    for (const ResponseTerm& term : own.terms) sum += std::abs(term.weight) * rounding(term.response);
    return own.relative_to ? 2.0 * sum : sum;
  }

 private:
  const ModelDescription& inner() const { return ForwardingModel::description(); }
  bool is_own(std::size_t response) const { return response >= inner().responses.size(); }

  std::optional<SolveTrace> formed_trace(std::span<const double> pose, std::span<const double> errors,
                                         const SolverOptions& options) const {
    std::optional<SolveTrace> trace = ForwardingModel::trace(pose, errors, options);
    if (!trace) return trace;
    trace->responses.resize(rows_.all());
    rows_.form_all(trace->responses, 1);
    return trace;
  }

  std::vector<OwnResponse> own_;
  OwnRows rows_;
  ModelDescription description_;
};

}  // namespace

std::optional<Dimension> dimension_of(const ResponseTerm& term, const ModelDescription& model) {
  const Dimension own = model.responses[term.response].dimension;
  if (term.weighed_in == Dimension::number) return own;
  if (term.is_inverse) {
    if (own == Dimension::length) return Dimension::angle;
    return own == Dimension::moment ? std::optional(Dimension::force) : std::nullopt;
  }
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

ModelDescription described(ModelDescription model, const std::vector<OwnResponse>& own) {
  std::vector<std::size_t> first(own.size());
  std::iota(first.begin(), first.end(), model.responses.size());
  for (const OwnResponse& one : own) model.responses.push_back(response_of(one, model));
  for (std::vector<std::size_t>* shown : {&model.headline, &model.signed_headline}) {
    if (!shown->empty()) shown->insert(shown->begin(), first.begin(), first.end());
  }
  return model;
}

std::unique_ptr<Model> with_responses(std::unique_ptr<Model> model, std::vector<OwnResponse> own) {
  if (own.empty()) return model;
  return std::make_unique<ModelOfOwn>(std::move(model), std::move(own));
}

CatalogEntry with_responses(CatalogEntry entry, const std::vector<OwnResponse>& own) {
  if (own.empty()) return entry;
  entry.description = described(std::move(entry.description), own);
  entry.build = [build = std::move(entry.build), own](std::span<const double> geometry, std::size_t fidelity) {
    return with_responses(build(geometry, fidelity), own);
  };
  if (entry.build_with_points) {
    entry.build_with_points = [build = std::move(entry.build_with_points), own](std::span<const double> geometry,
                                                                                std::size_t fidelity,
                                                                                std::span<const PlatformPoint> points) {
      return with_responses(build(geometry, fidelity, points), own);
    };
  }
  return entry;
}

}  // namespace poesy
