#include "engine/run/outlook.h"

#include <algorithm>

#include "engine/run/rounds.h"

namespace poesy {

MemoryOutlook times(std::size_t count, const MemoryOutlook& each) {
  return {count * each.accumulators, count * each.state, count * each.result, count * each.file};
}

double WorkSeconds::on(std::size_t threads, double share) const {
  const double together = (shared + merging) / static_cast<double>(threads);
  return share * std::max(together, merging) + by_one;
}

std::size_t outcome_bytes(const ModelDescription& model, Outcomes outcomes) {
  std::size_t numbers = model.responses.size();
  if (outcomes == Outcomes::with_details) {
    for (const Detail& detail : model.details) numbers += detail.components.size();
  }
  return numbers * sizeof(double) + sizeof(SolveStatus) + sizeof(std::uint32_t);
}

std::string counted_things(std::size_t count, std::string_view things) {
  return std::to_string(count).append(" ").append(things);
}

std::string samples_text(const Plan& plan) {
  const std::size_t least = least_samples(plan);
  return least == plan.samples() ? std::to_string(least)
                                 : std::to_string(least) + " to " + std::to_string(plan.samples());
}

std::string solves_text(const Plan& plan, std::size_t fidelities) {
  const std::uint64_t most = fidelities * plan.solves();
  const std::size_t least = least_samples(plan);
  if (least == plan.samples()) return std::to_string(most) + " solves";
  return "at least " + std::to_string(most / plan.samples() * least) + " and at most " + std::to_string(most) +
         " solves";
}

double least_share(const Plan& plan) {
  return static_cast<double>(least_samples(plan)) / static_cast<double>(plan.samples());
}

WorkOutlook table_work(const Study& study, const Model& model, const PoseSet& poses, ErrorTable table,
                       Outcomes outcomes) {
  return table_work(poses, [&study, &model, table = std::move(table), outcomes](const PoseSet& some) {
    static_cast<void>(
        run_evaluation(model, study.solver, some, table, Pairing::every_pose_with_every_row, {.threads = 1}, outcomes));
  });
}

}  // namespace poesy
