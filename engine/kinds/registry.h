#pragma once

#include <span>
#include <string>
#include <string_view>

#include "engine/kinds/kind.h"

namespace poesy {

/// Every kind of study, in the order in which users see them. This is the only list.
std::span<const Kind* const> kinds();

/// The part of the kinds that study files use.
const StudyKinds& study_kinds();

/// The kind of this name; null if there is none.
const Kind* find_kind(std::string_view name);

/// The kind of a study.
const Kind& kind_of(const Study& study);

/// The kind of a result. Precondition: its kind exists.
const Kind& kind_of(const StoredResult& result);

/// The kinds whose solves can be replayed, for messages.
std::string_view replayable_kinds();

}  // namespace poesy
