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

/// What tells a report from other pages; it stands in the first kilobyte of its file.
inline constexpr std::string_view kReportMark = "<meta name=\"generator\" content=\"poesy report\">";

/// What a report's page is made of, with its own text: "d3.js", "plot.js", "report.js" (to be run in this order) and
/// "report.css". Each may stand inside a script or style element as it is; scripts of others begin with their licences.
/// Another name is a broken contract, and empty where contracts are not checked.
std::string_view asset(std::string_view name);

/// Text as it may stand in HTML, between tags and inside double quotes. What is not UTF-8, and control characters but
/// line feeds and tabs, become U+FFFD.
std::string escaped(std::string_view text);

/// `<TAG ATTRIBUTES>text</TAG>`, the text escaped. attributes: HTML as it stands.
std::string element(std::string_view tag, std::string_view text, std::string_view attributes = {});

/// A table as HTML, in a box that scrolls: caption, headings with units, the cells as they are shown, notes below. Its
/// box has the attribute data-table with the table's name.
std::string html_table(const Table& table);

/// A section of the report under a heading. All texts are plain ones, escaped here.
class Section {
 public:
  /// Id: as an anchor; heading: for people.
  Section(std::string id, std::string heading) : id_(std::move(id)), heading_(std::move(heading)) {}

  Section& paragraph(std::string_view text);                                           ///< Adds one.
  Section& definitions(const std::vector<std::pair<std::string, std::string>>& list);  ///< Names, each with what it is.
  /// The place of a figure of the page, which is drawn by its script. drawn: what stands there without it, as HTML.
  Section& figure(std::string_view key, std::string_view caption, std::string_view drawn = {});
  Section& table(const Table& table);  ///< Adds it, open.
  /// Adds the one of this name, where there is one.
  Section& table(std::span<const Table> tables, std::string_view name);
  /// Tables that are open only when the reader asks for them.
  Section& folded(std::string_view summary, std::span<const Table> tables);
  /// Adds one that the reader may unfold.
  Section& folded(std::string_view summary, const Table& table) { return folded(summary, std::span(&table, 1)); }
  /// A long text as it stands, open only when the reader asks for it.
  Section& folded_text(std::string_view summary, std::string_view text);

  const std::string& id() const { return id_; }            ///< As an anchor.
  const std::string& heading() const { return heading_; }  ///< For people.
  const std::string& body() const { return body_; }        ///< HTML

 private:
  std::string id_;
  std::string heading_;
  std::string body_;
};

/// A line of what a report says first: "Answer", "How sure", "What to do", each with a sentence or two.
using AnswerLine = std::pair<std::string, std::string>;

/// The summary at the top of a report, made of the result's numbers: five lines at the most.
using Answer = std::vector<AnswerLine>;

/// What a report consists of.
struct Page {
  std::string title;                  ///< of the study, or of the result
  std::string subtitle;               ///< below the title
  Answer answer = {};                 ///< stands before everything else; empty: nothing does
  std::vector<std::string> warnings;  ///< what a reader must know first
  std::deque<Section> sections;       ///< in order
  FigureSet figures;                  ///< of all sections

  /// Adds an empty one behind the others. The reference holds as long as the page.
  Section& add_section(std::string id, std::string heading);
};

std::string html_document(const Page& page);  ///< The page as one HTML document that needs no other file.

}  // namespace poesy
