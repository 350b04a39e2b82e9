#pragma once

#include <string>

#include "engine/io/result_file.h"

namespace poesy::app {

/// Reads a result, and warns on stderr where it was changed since it was written. Throws FileError.
StoredResult read_result_warily(const std::string& path);

}  // namespace poesy::app
