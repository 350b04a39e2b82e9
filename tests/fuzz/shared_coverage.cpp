#include "tests/fuzz/shared_coverage.h"

#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "tests/fuzz/target.h"

// The bounds of the coverage counters of -fsanitize=fuzzer, defined by the linker, and the sanitizers' callback at a
// crash. A build without a fuzzer has none of them.
extern "C" {
[[gnu::weak]] extern std::uint8_t __start___sancov_cntrs[];
[[gnu::weak]] extern std::uint8_t __stop___sancov_cntrs[];
[[gnu::weak]] void __sanitizer_set_death_callback(void (*callback)());
}

namespace poesy::fuzz {
namespace {

/// Replaces the whole pages between the bounds by pages that are shared with child processes, with the same content.
void share_pages(std::uint8_t* begin, std::uint8_t* end) {
  const auto page = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  const std::uintptr_t first = (reinterpret_cast<std::uintptr_t>(begin) + page - 1) / page * page;
  const std::uintptr_t last = reinterpret_cast<std::uintptr_t>(end) / page * page;
  if (first >= last) return;
  auto* const pages = reinterpret_cast<std::uint8_t*>(first);
  const std::vector<std::uint8_t> content(pages, pages + (last - first));
  void* const shared =
      ::mmap(pages, content.size(), PROT_READ | PROT_WRITE, MAP_FIXED | MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  expect(shared == pages, "counters can be shared");
  std::memcpy(pages, content.data(), content.size());
}

}  // namespace

void share_coverage() {
  if (__start___sancov_cntrs == nullptr) return;
  share_pages(__start___sancov_cntrs, __stop___sancov_cntrs);
  pthread_atfork(nullptr, nullptr, [] {
    if (__sanitizer_set_death_callback != nullptr) __sanitizer_set_death_callback(nullptr);
  });
}

}  // namespace poesy::fuzz
