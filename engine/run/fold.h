#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/base/bytes.h"
#include "engine/run/checkpoints.h"
#include "engine/run/run_in_order.h"
#include "engine/run/run_options.h"

namespace poesy {

/// Does the work of one stage of a study and merges what it gives, in its order: on all threads and ranks, from the
/// checkpoint's state on, in as many rounds as the stage wants. The accumulator has the same bits afterwards for any
/// number of threads and ranks, and whether the stage was continued from a checkpoint or not; on ranks after rank 0 as
/// well. Returns false when stopped. Work is the stage's accumulator, and has:
///
///     std::size_t begin_round()              numbers the round's pieces of work 0 .. count - 1, and gives count
///     Worker worker() const                  solves pieces, and owns the scratch of one thread
///     Piece solve(Worker&, std::size_t n)    solves the n-th piece, on any thread
///     SolveCounts merge(std::size_t n, const Piece&)   takes the n-th piece, in order; how its solves ended
///     void write(std::size_t n, const Piece&, ByteWriter&) const   a piece for rank 0, and its way back:
///     Piece read(std::size_t n, ByteReader&)
///     SolveCounts solved() const             of all that was merged, in earlier runs as well
///     std::uint64_t left() const             solves that are still to come, as far as is known in this round
///     Bytes state() const                    everything merged so far
///     void restore(std::span<const std::byte>)   takes up a state in place of its own; throws BytesError
///     bool next_round()                      ends the round; whether another one follows
template <class Work>
bool fold(Work& work, const RunOptions& options) {
  const auto restore = [&](std::span<const std::byte> state) { work.restore(state); };
  const auto state = [&] { return work.state(); };
  Stage stage(options.checkpoints, options.team);
  stage.begin(restore);
  ProgressCounter counter(work.solved(), options);
  for (;;) {
    const std::size_t count = work.begin_round();
    counter.expect_left(work.left());
    const bool complete = run_in_order(
        count, options, [&] { return work.worker(); },
        [&](auto& worker, std::size_t n) { return work.solve(worker, n); },
        [&](std::size_t n, const auto& piece) {
          counter.add(work.merge(n, piece));
          stage.merged(state);
        },
        [&](std::size_t n, const auto& piece, ByteWriter& to) { work.write(n, piece, to); },
        [&](std::size_t n, ByteReader& from) { return work.read(n, from); });
    stage.end(
        complete, [&] { return work.solved(); }, state, restore);
    if (!complete) return false;
    if (!work.next_round()) return true;
    stage.next_round();
  }
}

}  // namespace poesy
