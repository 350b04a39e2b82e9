#pragma once

#include <deque>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "engine/report/html/figures.h"
#include "engine/report/table.h"

namespace poesy {

/// The element by which poesy recognises its reports among other HTML files. It is in the first kilobyte of the file.
inline constexpr std::string_view kReportMark = "<meta name=\"generator\" content=\"poesy report\">";

/// The text of a file that is part of a report's page: "d3.js", "plot.js", "report.js" (to be run in this order) or
/// "report.css". It may be inserted into a script or style element unchanged. Third-party scripts begin with their
/// licences. Precondition: `name` is one of these four.
std::string_view asset(std::string_view name);

/// Escapes text for HTML, between tags and inside double quotes. Invalid UTF-8, and control characters except line
/// feeds and tabs, become U+FFFD.
std::string escaped(std::string_view text);

/// An element `<TAG ATTRIBUTES>text</TAG>` with the text escaped. attributes: HTML, not escaped.
std::string element(std::string_view tag, std::string_view text, std::string_view attributes = {});

/// A table as HTML: a box that scrolls, with the caption, the headings with units and the cells, followed by the notes.
/// The box has the table's name in the attribute data-table. A cell with Cell::boxes is drawn as a tolerance frame.
std::string html_table(const Table& table);

/// A section of the report with a heading. Its functions escape all texts, except arguments that are HTML.
class Section {
 public:
  /// id: anchor of the section. heading: text for people.
  Section(std::string id, std::string heading) : id_(std::move(id)), heading_(std::move(heading)) {}

  Section& paragraph(std::string_view text);  ///< Adds a paragraph.
  /// Adds a list of names with their meanings.
  Section& definitions(const std::vector<std::pair<std::string, std::string>>& list);
  /// Adds the place where a script draws a figure. key: key of the figure in FigureSet. drawn: HTML that is shown if
  /// scripts are not run.
  Section& figure(std::string_view key, std::string_view caption, std::string_view drawn = {});
  /// Adds a picture that needs no script. drawn: the picture as HTML.
  Section& picture(std::string_view caption, std::string_view drawn);
  Section& table(const Table& table);  ///< Adds a table that is always visible.
  /// Adds the table of this name, always visible, if there is one.
  Section& table(std::span<const Table> tables, std::string_view name);
  /// Adds tables that a reader sees after unfolding them. summary: text that is always visible.
  Section& folded(std::string_view summary, std::span<const Table> tables);
  /// Adds a table that a reader sees after unfolding it. summary: text that is always visible.
  Section& folded(std::string_view summary, const Table& table) { return folded(summary, std::span(&table, 1)); }
  /// Adds a long text that a reader sees after unfolding it. summary: text that is always visible.
  Section& folded_text(std::string_view summary, std::string_view text);

  const std::string& id() const { return id_; }            ///< The anchor of the section.
  const std::string& heading() const { return heading_; }  ///< The heading for people.
  const std::string& body() const { return body_; }        ///< The content as HTML.

 private:
  std::string id_;
  std::string heading_;
  std::string body_;
};

/// A line of the summary at the top of a report: a label ("Answer", "How sure", "What to do"), and a sentence or two.
using AnswerLine = std::pair<std::string, std::string>;

/// The label of the line that advises what to do next.
inline constexpr std::string_view kWhatToDo = "What to do";

/// The summary at the top of a report: at most five lines.
using Answer = std::vector<AnswerLine>;

/// The content of a report.
struct Page {
  std::string title;                  ///< title of the study, or of the result
  std::string subtitle;               ///< line below the title
  Answer answer = {};                 ///< summary, before everything else; empty: there is none
  std::vector<std::string> warnings;  ///< warnings, before the sections
  std::deque<Section> sections;       ///< sections in their order on the page
  FigureSet figures;                  ///< figures of all sections

  /// Appends an empty section. The returned reference stays valid if further sections are appended.
  Section& add_section(std::string id, std::string heading);
  /// Inserts an empty section after the section with the id `after`, or at the end if no section has this id.
  /// References to other sections become invalid.
  Section& insert_section(std::string_view after, std::string id, std::string heading);
};

std::string html_document(const Page& page);  ///< The page as one HTML document that needs no other file.

}  // namespace poesy
