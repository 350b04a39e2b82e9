#include "engine/model/forwarding_model.h"

namespace poesy {

const Model& solving_model(const Model& model) {
  const auto* const outer = dynamic_cast<const ForwardingModel*>(&model);
  return outer == nullptr ? model : solving_model(outer->behind());
}

std::unique_ptr<Evaluator> all_formed(const Model& model, std::unique_ptr<Evaluator> solving) {
  const auto* const outer = dynamic_cast<const ForwardingModel*>(&model);
  if (outer == nullptr) return solving;
  return outer->formed(all_formed(outer->behind(), std::move(solving)));
}

}  // namespace poesy
