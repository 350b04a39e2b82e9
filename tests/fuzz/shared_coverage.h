#pragma once

namespace poesy::fuzz {

/// Lets the fuzzer see the coverage of child processes, and prevents a child that crashes from being reported as a
/// finding. Does nothing in a build without a fuzzer. Must be called once, before the first child process.
void share_coverage();

}  // namespace poesy::fuzz
