#pragma once

#include <span>
#include <string>
#include <string_view>

#include "engine/kinds/kind.h"

namespace poesy {

/// Every kind of study, in the order in which messages and help list them. There is no other list of kinds.
std::span<const Kind* const> kinds();

/// The part of each kind that reads its study files (StudyKind), and the tables of all keys.
const StudyKinds& study_kinds();

/// The kind with this name, which may be a kind that only results have (calibration, sweep); null if there is none.
const Kind* find_kind(std::string_view name);

/// The kind of a study.
const Kind& kind_of(const Study& study);

/// The kind of a result. Precondition: this program knows the kind.
const Kind& kind_of(const StoredResult& result);

/// The kinds whose solves `poesy replay` can repeat, as text for messages.
std::string_view replayable_kinds();

}  // namespace poesy
