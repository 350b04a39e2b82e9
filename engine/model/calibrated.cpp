#include "engine/model/calibrated.h"

#include <stdexcept>
#include <utility>

#include "engine/base/contract.h"
#include "engine/model/forwarding_model.h"

namespace poesy {
namespace {

class CalibratedModel final : public ForwardingModel {
 public:
  explicit CalibratedModel(std::unique_ptr<Model> model) : ForwardingModel(std::move(model)) {}

  std::unique_ptr<Evaluator> evaluator(const SolverOptions& options) const override {
    return calibrated_evaluator(options);
  }
  std::optional<SolveTrace> trace(std::span<const double>, std::span<const double>,
                                  const SolverOptions&) const override {
    return std::nullopt;
  }
};

}  // namespace

std::unique_ptr<Model> calibrated(std::unique_ptr<Model> model) {
  POESY_EXPECTS(model != nullptr);
  if (model->calibrated_evaluator({}) == nullptr) {
    throw std::invalid_argument("model \"" + model->description().name +
                                "\" does not separate actuated from constrained directions");
  }
  return std::make_unique<CalibratedModel>(std::move(model));
}

}  // namespace poesy
