#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "engine/base/archive.h"
#include "engine/run/checkpoints.h"
#include "engine/run/result.h"
#include "engine/run/run_in_slots.h"
#include "engine/run/run_options.h"

namespace poesy {

/// Calls work(worker, n) for n = 0 .. count - 1 on a pool of threads, where each thread has its own worker. Calls
/// finish(n, output) in the order of n. At any time, only a few outputs for each thread wait for finish(). Returns
/// false if the run was stopped. With a team, work is done on all ranks, and finish is called only on rank 0
/// (run_over_ranks); state(archive, n, output) writes an output on another rank, and reads it into an empty output on
/// rank 0.
template <class MakeWorker, class Work, class Finish, class State>
bool run_in_order(std::size_t count, const RunOptions& options, MakeWorker make_worker, Work work, Finish finish,
                  State state) {
  using Worker = std::invoke_result_t<MakeWorker>;
  using Output = std::invoke_result_t<Work, Worker&, std::size_t>;
  const bool alone = options.team == nullptr;
  std::vector<Output> outputs(alone ? pool_slots(options) : rank_slots(options));
  const SlotWork in_slots{[&]() -> SlotJob {
                            return [&, worker = std::make_shared<Worker>(make_worker())](
                                       std::size_t n, std::size_t slot) { outputs[slot] = work(*worker, n); };
                          },
                          [&](std::size_t n, std::size_t slot) { finish(n, std::exchange(outputs[slot], Output{})); },
                          [&](std::size_t n, std::size_t slot, Archive& archive) { state(archive, n, outputs[slot]); }};
  return alone ? run_alone(count, options, in_slots) : run_over_ranks(count, options, in_slots);
}

/// Reads or writes the beginning of a state: the name of the job to which the state belongs, and sizes such as the
/// numbers of poses and responses. When reading, throws BytesError if the state has another name or another size.
inline void head_state(Archive& archive, std::string_view name, std::span<const std::uint64_t> sizes) {
  constexpr const char* kOther = "is the state of another kind or size of study";
  std::string read(name);
  archive.text(read);
  archive.expect(read == name, kOther);
  for (const std::uint64_t size : sizes) archive.known(size, kOther);
}

/// Does the work of one stage of a study, on all threads and ranks. The stage is divided into pieces, which are merged
/// in order into `work`, the accumulator of the stage. The stage begins with the state of the checkpoint, if there is
/// one, and has as many rounds as `work` asks for. The accumulator has the same bits on all ranks, for any number of
/// threads and ranks, and whether or not the stage was continued from a checkpoint. Returns false if the run was
/// stopped. The type Work has these functions:
///
///     std::size_t begin_round()              begins a round; returns the number of its pieces of work
///     Worker worker() const                  solves pieces, and owns the scratch of one thread
///     Piece solve(Worker&, std::size_t n)    solves the n-th piece, on any thread
///     void piece_state(Archive&, std::size_t n, Piece&)   writes a piece, or reads it into an empty one on rank 0
///     SolveCounts merge(std::size_t n, Piece&&)   adds the pieces in the order of n; returns how the solves ended
///     SolveCounts solved() const             solves of all merged pieces, including those of earlier runs
///     std::uint64_t left() const             solves that are still expected in the stage
///     void state(Archive&)                   writes all merged sums, or replaces them by those that it reads
///     bool next_round()                      ends the round; returns whether another one follows
///
/// UnitFold and PoseFold are such types. A kind of study gives them a job, which states what a piece solves and how its
/// output is summed.
template <class Work>
bool fold(Work& work, const RunOptions& options) {
  const auto restore = [&](std::span<const std::byte> bytes) {
    ByteReader from(bytes);
    Archive archive(from);
    work.state(archive);
    from.expect_end();
  };
  const ByteSource state = [&](ByteWriter& to) {
    Archive archive(to);
    work.state(archive);
  };
  Stage stage(options.checkpoints, options.team);
  stage.begin(restore);
  const SolveCounts before = work.solved();
  Progress progress{before.total(), before.total(), before.not_converged(), before.total()};
  for (;;) {
    const std::size_t count = work.begin_round();
    progress.total = progress.solves + work.left();
    const bool complete = run_in_order(
        count, options, [&] { return work.worker(); },
        [&](auto& worker, std::size_t n) { return work.solve(worker, n); },
        [&](std::size_t n, auto&& piece) {
          const SolveCounts solves = work.merge(n, std::forward<decltype(piece)>(piece));
          progress.solves += solves.total();
          progress.not_converged += solves.not_converged();
          if (options.progress) options.progress(progress);
          stage.merged(state);
        },
        [&](Archive& archive, std::size_t n, auto& piece) { work.piece_state(archive, n, piece); });
    stage.end(
        complete, [&] { return work.solved(); }, state, restore);
    if (!complete) return false;
    if (!work.next_round()) return true;
    stage.next_round();
  }
}

}  // namespace poesy
