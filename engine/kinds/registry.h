#pragma once

#include <span>
#include <string>
#include <string_view>

#include "engine/kinds/kind.h"

namespace poesy {

/// Every kind of study, in the order in which they are offered. The only list.
std::span<const Kind* const> kinds();

/// As study files know them.
const StudyKinds& study_kinds();

/// The kind of this name; null where there is none.
const Kind* find_kind(std::string_view name);

/// The kind of a study.
const Kind& kind_of(const Study& study);

/// The kind of a result. Precondition: there is such a kind.
const Kind& kind_of(const StoredResult& result);

/// "'NAME'" of the kinds that rank errors, for messages.
std::string kinds_that_rank();

/// The kinds whose solves can be replayed, for messages.
std::string_view replayable_kinds();

}  // namespace poesy
