#pragma once

#include "engine/io/result_file.h"
#include "engine/report/html/page.h"

/// What the names in a report mean. Files of older versions do not say it; then nothing is added.
namespace poesy {

/// The section that comes first: what the responses are, in words.
void add_responses(const StoredResult& result, Page& page);

/// The section that has every error and every pose coordinate with its unit and what it is; figures say it as well,
/// where a reader points at a name.
void add_glossary(const StoredResult& result, Page& page);

}  // namespace poesy
