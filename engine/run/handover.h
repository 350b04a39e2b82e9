#pragma once

#include <utility>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
#endif

namespace poesy::handover {

/// Tells ThreadSanitizer what oneTBB guarantees inside its library, which the sanitizer cannot see: what stands before
/// a publish has happened before what stands after a later receive. Nothing at all in other builds.
#ifdef __SANITIZE_THREAD__
inline char place;
inline void publish() { __tsan_release(&place); }
inline void receive() { __tsan_acquire(&place); }
#else
inline void publish() {}
inline void receive() {}
#endif

/// A block that stands after every such block that ended before. Around objects of oneTBB: their memory goes from
/// thread to thread inside its allocator.
class Block {
 public:
  Block() { receive(); }
  ~Block() { publish(); }
  Block(const Block&) = delete;
  Block& operator=(const Block&) = delete;
};

/// A function that oneTBB copies and calls on any of its threads. Calls that overlap stay unordered to the sanitizer,
/// so real races between them are still found.
template <class Function>
class Task {
 public:
  /// The function is copied with the task.
  explicit Task(Function function) : function_(std::move(function)) {}
  /// Copies run on other threads: what this one wrote before is visible there.
  Task(const Task& other) : function_(other.function_) { publish(); }
  Task& operator=(const Task&) = delete;
  ~Task() = default;

  /// Calls the function inside a block.
  template <class... Arguments>
  decltype(auto) operator()(Arguments&&... arguments) const {
    const Block block;
    return function_(std::forward<Arguments>(arguments)...);
  }

 private:
  Function function_;
};

}  // namespace poesy::handover
