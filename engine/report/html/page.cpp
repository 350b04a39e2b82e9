#include "engine/report/html/page.h"

#include <fmt/format.h>

#include <algorithm>

#include "engine/files/version.h"
#include "engine/report/html/markup.h"

namespace poesy {
namespace {

/// Scripts and styles of this document alone, and nothing from elsewhere.
constexpr std::string_view kPolicy =
    "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data: blob:";

std::string head(const Page& page) {
  return fmt::format(
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n{}\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"{}\">\n{}\n<style>\n{}\n</style>\n</head>\n",
      kReportMark, kPolicy, element("title", page.title), asset("report.css"));
}

/// The warnings as a section of their own.
Section warnings_section(const Page& page) {
  return {"warnings", page.warnings.size() == 1 ? "One warning" : fmt::format("{} warnings", page.warnings.size())};
}

std::string warnings_html(const Page& page) {
  std::string html = "<ul>\n";
  for (const std::string& warning : page.warnings) html += element("li", warning) + "\n";
  return html + "</ul>\n";
}

std::string nav_entry(const Section& section) {
  return fmt::format("<li><a href=\"#{}\">{}</a></li>\n", section.id(), escaped(section.heading()));
}

std::string header(const Page& page) {
  std::string html = "<header>\n" + element("h1", page.title) + "\n" +
                     element("p", page.subtitle, "class=\"subtitle\"") + "\n<nav aria-label=\"Sections\"><ul>\n";
  if (!page.warnings.empty()) html += nav_entry(warnings_section(page));
  for (const Section& section : page.sections) html += nav_entry(section);
  return html + "</ul></nav>\n</header>\n";
}

std::string section_html(const Section& section, std::string_view body, std::string_view attributes = {}) {
  return fmt::format("<section id=\"{0}\"{1} aria-labelledby=\"{0}-h\">\n<h2 id=\"{0}-h\">{2}</h2>\n{3}</section>\n",
                     section.id(), attributes, escaped(section.heading()), body);
}

std::string main_part(const Page& page) {
  std::string html = "<main id=\"main\">\n";
  if (!page.warnings.empty()) {
    html += section_html(warnings_section(page), warnings_html(page), " class=\"warnings\"");
  }
  for (const Section& section : page.sections) html += section_html(section, section.body());
  return html + "</main>\n";
}

std::string scripts(const Page& page) {
  std::string html =
      "<script type=\"application/json\" id=\"report-data\">" + figures_json(page.figures) + "</script>\n";
  for (const std::string_view name : {"d3.js", "plot.js", "report.js"}) {
    html += fmt::format("<script>{}</script>\n", asset(name));
  }
  return html;
}

}  // namespace

Section& Section::paragraph(std::string_view text) {
  body_ += element("p", text) + "\n";
  return *this;
}

Section& Section::definitions(const std::vector<std::pair<std::string, std::string>>& list) {
  body_ += "<dl>\n";
  for (const auto& [name, meaning] : list) body_ += element("dt", name) + element("dd", meaning) + "\n";
  body_ += "</dl>\n";
  return *this;
}

Section& Section::figure(std::string_view key, std::string_view caption) {
  body_ += fmt::format("<figure data-figure=\"{}\"><div class=\"plot\"></div>{}</figure>\n", escaped(key),
                       element("figcaption", caption));
  return *this;
}

Section& Section::table(const Table& table) {
  body_ += html_table(table);
  return *this;
}

Section& Section::table(std::span<const Table> tables, std::string_view name) {
  const auto at = std::ranges::find(tables, name, &Table::name);
  return at == tables.end() ? *this : table(*at);
}

Section& Section::folded(std::string_view summary, std::span<const Table> tables) {
  if (tables.empty()) return *this;
  body_ += "<details>" + element("summary", summary) + "\n";
  for (const Table& one : tables) body_ += html_table(one);
  body_ += "</details>\n";
  return *this;
}

Section& Section::folded_text(std::string_view summary, std::string_view text) {
  body_ += fmt::format("<details>{}\n{}</details>\n", element("summary", summary), element("pre", text));
  return *this;
}

Section& Page::add_section(std::string id, std::string heading) {
  return sections.emplace_back(std::move(id), std::move(heading));
}

std::string html_document(const Page& page) {
  return head(page) + "<body>\n<a class=\"skip\" href=\"#main\">Skip to the results</a>\n" + header(page) +
         main_part(page) + element("footer", fmt::format("Report by poesy {} ({})", poesy_version(), git_commit())) +
         "\n" + scripts(page) + "</body>\n</html>\n";
}

}  // namespace poesy
