#pragma once

#include <string>
#include <string_view>

#include "engine/schema/keys.h"

namespace poesy {

/// What a person changes first of a study's template: its keys without those in comments, those that are rarely
/// changed, and those that state their default and are not often changed. Each key has the first clause of its
/// explanation behind it. Lists of tables ([[analysis.parts]]) are written as lists of tables on one line, and no line
/// is empty, so that a template has some 25 lines. full: template_text(). tables: of the study's keys. kind: its kind.
std::string brief_template(std::string_view full, const StudyTables& tables, std::string_view kind);

}  // namespace poesy
