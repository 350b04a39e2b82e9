#pragma once

#include <string>

#include "engine/report/table.h"

namespace poesy {

/// A table as HTML, in a box that scrolls: caption, headings with units, the cells as they are shown, notes below. Its
/// box has the attribute data-table with the table's name.
std::string html_table(const Table& table);

}  // namespace poesy
