// A checkpoint without the digest at its end, which is put there: else nothing but the digest would be tried. Each
// state in it is offered to every accumulator. What one accepts it must give back.
#include <algorithm>

#include "engine/base/error.h"
#include "engine/files/checkpoint.h"
#include "engine/files/content_hash.h"
#include "engine/kinds/monte_carlo/collector.h"
#include "engine/kinds/sensitivity/collector.h"
#include "engine/kinds/sensitivity/indices.h"
#include "engine/run/evaluation.h"
#include "tests/fuzz/small_plans.h"
#include "tests/fuzz/target.h"
#include "tests/support/kinds.h"
#include "tests/support/states.h"

namespace {

using namespace poesy;
using State = std::span<const std::byte>;

/// Takes a state up twice: by make(), and what that gives by another make(). Then uses what was taken up.
template <class Make, class Use>
void offer(State state, const Make& make, const Use& use) {
  auto first = make();
  if (!fuzz::accepted<BytesError>([&] { first.restore(state); })) return;
  const auto written = [](const auto& from) { return bytes_of([&](ByteWriter& to) { from.write_state(to); }); };
  const Bytes given = written(first);
  auto second = make();
  second.restore(given);
  fuzz::expect(written(second) == given, "a state that was taken up is given back");
  use(std::move(first));
}

void offer_to_sensitivity(State state) {
  static const fuzz::SmallPlan small(&kSensitivityStudy);
  const Plan& plan = small.plan;
  const auto make = [&] { return SensitivityCollector(plan, fuzz::kResponses, 0.95); };
  offer(state, make, [&](SensitivityCollector&& collector) {
    bool complete = true;
    for (std::size_t cell = 0; cell < plan.cells(); ++cell) {
      fuzz::expect(collector.units_done(cell) <= plan.units_per_cell(), "no cell has more units than it can have");
      complete = complete && collector.units_done(cell) == plan.units_per_cell();
    }
    static_cast<void>(collector.total());
    if (!complete) return;
    const std::vector<double> background(fuzz::kResponses * plan.poses().size());
    static_cast<void>(collector.history(sensitivity_result(plan, std::move(collector).cells(), background,
                                                           std::vector<double>(fuzz::kResponses), 0.95)));
  });
}

void offer_to_monte_carlo(State state) {
  static const fuzz::SmallPlan small(&kMonteCarloStudy);
  const Plan& plan = small.plan;
  const auto make = [&] { return MonteCarloCollector(plan, fuzz::kResponses, small.study.analysis); };
  offer(state, make, [&](MonteCarloCollector&& collector) {
    bool complete = true;
    for (std::size_t m = 0; m < plan.poses().size(); ++m) {
      fuzz::expect(collector.units_done(PoseIndex(m)) <= plan.units_per_cell(), "no pose has more units than it can");
      complete = complete && collector.units_done(PoseIndex(m)) == plan.units_per_cell();
    }
    static_cast<void>(collector.total());
    if (complete) static_cast<void>(std::move(collector).result());
  });
}

void offer_to_evaluation(State state) {
  EvaluationResult result = fuzz::empty_evaluation();
  const auto make = [&] { return EvaluationProgress(result, fuzz::kBlockRows, Shard()); };
  offer(state, make, [](const EvaluationProgress& progress) { static_cast<void>(progress.total()); });
}

Bytes encoded(const Checkpoint& checkpoint) {
  Bytes file;
  write_checkpoint(checkpoint.identity, checkpoint.time, test::sources_of(checkpoint.stages),
                   [&](State piece) { file.insert(file.end(), piece.begin(), piece.end()); });
  return file;
}

void read(State file) {
  const Checkpoint checkpoint = decode_checkpoint(file);
  const Checkpoint again = decode_checkpoint(encoded(checkpoint));
  fuzz::expect(again.identity == checkpoint.identity && again.stages == checkpoint.stages, "a checkpoint comes back");
  for (const Bytes& stage : checkpoint.stages) {
    offer_to_sensitivity(stage);
    offer_to_monte_carlo(stage);
    offer_to_evaluation(stage);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const State content = std::as_bytes(std::span(data, size));
  Sha256 sha;
  sha.bytes(content);
  const Sha256::Digest digest = sha.digest();
  Bytes file(content.begin(), content.end());
  file.insert(file.end(), digest.begin(), digest.end());
  fuzz::accepted<BytesError>([&] { read(file); });
  return 0;
}
