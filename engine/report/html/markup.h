#pragma once

#include <string>
#include <string_view>

#include "engine/report/table.h"

namespace poesy {

/// Text as it may stand in HTML, between tags and inside double quotes. What is not UTF-8, and control characters but
/// line feeds and tabs, become U+FFFD.
std::string escaped(std::string_view text);

/// `<TAG ATTRIBUTES>text</TAG>`, the text escaped. attributes: HTML as it stands.
std::string element(std::string_view tag, std::string_view text, std::string_view attributes = {});

/// A table as HTML, in a box that scrolls: caption, headings with units, the cells as they are shown, notes below. Its
/// box has the attribute data-table with the table's name.
std::string html_table(const Table& table);

}  // namespace poesy
