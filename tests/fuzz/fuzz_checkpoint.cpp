// Fuzzes checkpoints. The input has no digest; the target appends it, because otherwise nearly all inputs would fail at
// the digest. The seed in the checkpoint selects a small study, which restores the states, stores them again and
// continues from them.
#include <atomic>
#include <utility>
#include <vector>

#include "engine/base/error.h"
#include "engine/kinds/study_run.h"
#include "engine/run/checkpoints.h"
#include "engine/run/run_options.h"
#include "engine/storage/checkpoint.h"
#include "engine/storage/content_hash.h"
#include "tests/fuzz/target.h"
#include "tests/support/small_studies.h"
#include "tests/support/states.h"

namespace {

using namespace poesy;
using State = std::span<const std::byte>;

/// Continues the study from these states to its end, or with `stop` until it first checks whether to stop. Returns its
/// states.
std::vector<Bytes> continued(const test::SmallStudy& small, std::vector<Bytes> states, bool stop) {
  Checkpoints checkpoints([] { return false; }, [](std::span<const ByteSource>) {}, std::move(states));
  const std::atomic<bool> stopped{stop};
  const RunOptions options{.threads = 1, .stop = &stopped, .checkpoints = &checkpoints};
  static_cast<void>(run_study(small.study, *small.model, small.poses, options));
  return checkpoints.stages();
}

void take_up(const test::SmallStudy& small, const std::vector<Bytes>& states) {
  try {
    const std::vector<Bytes> given = continued(small, states, true);
    fuzz::expect(continued(small, given, true) == given, "a state that was taken up is given back");
    static_cast<void>(continued(small, given, false));
  } catch (const InputError&) {
    // With the changed numbers no tolerances keep the limits.
  }
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
  const std::span<const test::SmallStudy> studies = test::small_studies();
  take_up(studies[checkpoint.identity.seed % studies.size()], checkpoint.stages);
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
