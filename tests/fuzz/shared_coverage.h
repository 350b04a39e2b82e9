#pragma once

namespace poesy::fuzz {

/// Lets the fuzzer see what a child of this process covers, and keeps a child that dies from reporting a finding.
/// Does nothing where there is no fuzzer. To be called once, before the first child.
void share_coverage();

}  // namespace poesy::fuzz
