#pragma once

#include <atomic>

namespace poesy::app {

/// From now on Ctrl-C and SIGTERM set the returned flag instead of ending the program at once.
/// A second one ends it as usual.
const std::atomic<bool>& catch_interrupts();

}  // namespace poesy::app
