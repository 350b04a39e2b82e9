#pragma once

#include <string>
#include <string_view>

#include "engine/schema/keys.h"

namespace poesy {

/// A shorter version of a template, with the keys that a person changes first. It leaves out keys that the full
/// template shows in comments, keys that are rarely changed, and keys with their default unless they are often changed.
/// A comment after the key has the first clause of its explanation. A list of tables ([[analysis.parts]]) becomes an
/// array with one table on each line, and no line is empty. The template has some 25 lines. full: text of the full
/// template. tables: the tables of the study's keys. kind: the kind of the study.
std::string brief_template(std::string_view full, const StudyTables& tables, std::string_view kind);

}  // namespace poesy
