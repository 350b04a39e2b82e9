#pragma once

#include <atomic>

namespace poesy::app {

/// From now on Ctrl-C, SIGTERM and SIGHUP set the returned flag instead of ending the program at once. Ctrl-C after
/// either ends it as usual; SIGTERM, which batch systems send to a process by several ways, may come any number of
/// times.
const std::atomic<bool>& catch_interrupts();

/// Sets the flag.
void interrupt();

}  // namespace poesy::app
