#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "engine/report/display.h"
#include "engine/report/html/parts.h"
#include "engine/report/html/sections.h"
#include "engine/report/tables.h"

namespace poesy {
namespace {

/// The curves of a coupling result: one panel for each response and size.
class Curves {
 public:
  Curves(const StoredResult& result, const ShownCells& shown, ArrayPool& pool)
      : result_(result), found_(result.coupling.found), shown_(shown), pool_(pool) {}

  Lines effects() const {
    return lines([&](std::size_t r, std::size_t z) { return effect_series(r, z); });
  }
  /// In panels of their own, for they may be far smaller than effects.
  Lines interactions() const {
    Lines all = lines([&](std::size_t r, std::size_t z) { return interaction_series(r, z); });
    for (Panel& panel : all.panels) panel.label = "interaction in " + panel.label;
    return all;
  }
  Lines cancellations() const {
    Lines all = lines([&](std::size_t r, std::size_t z) { return cancellation_series(r, z); });
    for (Panel& panel : all.panels) panel.unit = "%";
    return all;
  }
  /// What all sources do together at each pose, and how much they cancel.
  std::vector<Field> fields() const {
    std::vector<Field> list;
    for (const std::size_t r : shown_.responses) {
      for (const std::size_t z : sizes()) {
        const std::string label = panel_label(r, z);
        list.push_back(
            {label + ", all sources", unit_text(result_.responses[r]), curve("effect", found_.effect, r, z, last())});
        if (last() >= sources()) {
          list.push_back({label + ", cancellation", "%", curve("cancellation", found_.cancellation, r, z, last())});
        }
      }
    }
    return list;
  }
  bool has_subsets() const { return found_.subsets > sources(); }

 private:
  /// The first subsets are the sources one by one.
  std::size_t sources() const { return std::min(result_.coupling.sources.size(), found_.subsets); }
  /// The last first, which is what tables show.
  std::vector<std::size_t> sizes() const {
    std::vector<std::size_t> list;
    for (std::size_t z = found_.sizes; z-- > 0;) list.push_back(z);
    return list;
  }
  std::size_t last() const { return found_.subsets - 1; }
  const std::string& subset(std::size_t k) const { return result_.coupling.subsets[k]; }
  std::string panel_label(std::size_t r, std::size_t z) const {
    return fmt::format("{} at {}", result_.responses[r].name, result_.coupling.size_names[z]);
  }

  template <class SeriesOf>
  Lines lines(const SeriesOf& series_of) const {
    Lines all{.x = pose_axis(result_, shown_, pool_), .panels = {}, .most = sources() + 4};
    for (const std::size_t r : shown_.responses) {
      for (const std::size_t z : sizes()) {
        all.panels.push_back({panel_label(r, z), unit_text(result_.responses[r]), series_of(r, z)});
      }
    }
    return all;
  }

  /// Of values [R x Z x K x M], one curve; shares in percent.
  ArrayName curve(std::string_view what, const std::vector<double>& values, std::size_t r, std::size_t z,
                  std::size_t k) const {
    const std::size_t at = (r * found_.sizes + z) * found_.subsets + k;
    const double unit = what == "cancellation" ? 0.01 : display(result_.responses[r]).si;
    return pool_.add(fmt::format("{}/{}/{}/{}", what, r, z, k),
                     shown_.at_poses(std::span(values).subspan(at * found_.poses, found_.poses)), unit);
  }

  /// Each source alone, all together with what they add up to and their interaction, then the other subsets.
  std::vector<Series> effect_series(std::size_t r, std::size_t z) const {
    std::vector<Series> list;
    for (std::size_t k = 0; k < sources(); ++k)
      list.push_back({subset(k) + " alone", curve("effect", found_.effect, r, z, k)});
    if (has_subsets()) add_together(r, z, list);
    for (std::size_t k = sources(); k + 1 < found_.subsets; ++k) {
      list.push_back({subset(k), curve("effect", found_.effect, r, z, k)});
    }
    return list;
  }

  void add_together(std::size_t r, std::size_t z, std::vector<Series>& list) const {
    const auto add = [&](std::string label, std::string_view what, const std::vector<double>& values,
                         std::string style) {
      list.push_back(
          {.label = std::move(label), .value = curve(what, values, r, z, last()), .style = std::move(style)});
    };
    add(subset(last()) + " together", "effect", found_.effect, "solid");
    add("interaction of all", "interaction", found_.interaction, "dotted");
    add("worst case of all", "worst_case", found_.worst_case, "dashed");
    add("root sum square of all", "root_sum_square", found_.root_sum_square, "dashed");
  }

  std::vector<Series> interaction_series(std::size_t r, std::size_t z) const {
    std::vector<Series> list{{subset(last()), curve("interaction", found_.interaction, r, z, last())}};
    for (std::size_t k = sources(); k + 1 < found_.subsets; ++k) {
      list.push_back({subset(k), curve("interaction", found_.interaction, r, z, k)});
    }
    return list;
  }

  std::vector<Series> cancellation_series(std::size_t r, std::size_t z) const {
    std::vector<Series> list{{subset(last()), curve("cancellation", found_.cancellation, r, z, last())}};
    for (std::size_t k = sources(); k + 1 < found_.subsets; ++k) {
      list.push_back({subset(k), curve("cancellation", found_.cancellation, r, z, k)});
    }
    return list;
  }

  const StoredResult& result_;
  const CouplingResult& found_;
  const ShownCells& shown_;
  ArrayPool& pool_;
};

/// The tables of the last size, and those of the others to be unfolded.
void add_tables(const StoredResult& result, Section& section) {
  std::vector<Table> others = result_tables(result, default_ranking(result));
  const std::size_t last = std::min(others.size(), result.signed_headline.size());
  const std::vector<Table> shown(others.end() - static_cast<std::ptrdiff_t>(last), others.end());
  others.resize(others.size() - last);
  section.folded("The tables of the other sizes", others);
  for (const Table& table : shown) section.table(table);
}

}  // namespace

void add_coupling(const StoredResult& result, Page& page) {
  if (result.coupling.found.subsets == 0) return;
  ArrayPool& pool = page.figures.pool;
  const ShownCells shown = shown_cells(result);
  const Curves curves(result, shown, pool);
  Section section("together", "What the sources do, alone and together");
  section.paragraph(
      "Each source of errors has its size alone, and with others. The interaction is what all do together less the sum "
      "of what each does alone. Worst case: the sum of their magnitudes, where signs are not known. Root sum square: "
      "what is to be expected where either sign is as likely.");
  if (!shown.note().empty()) section.paragraph(shown.note());
  add_figure(page, section, "sources", curves.effects(),
             result.time.empty() ? "The effect at each pose." : "The effect along the trajectory.");
  if (curves.has_subsets()) {
    add_figure(page, section, "interactions", curves.interactions(), "The interaction of each subset of the sources.");
  }
  add_tables(result, section);
  page.sections.push_back(std::move(section));
  Section cancels("where", "Where they cancel, and where they add up");
  cancels.paragraph(
      "Cancellation is the part of the sources' effects that opposes each other: 0 where none opposes another, 100 % "
      "where nothing is left of them together.");
  if (curves.has_subsets()) {
    add_figure(page, cancels, "cancellation", curves.cancellations(), "How much the sources cancel each other.");
  }
  add_figure(page, cancels, "workspace",
             WorkspaceMap{pose_coordinates(result, shown, pool), curves.fields(), pose_numbers(shown, pool)},
             "Each dot is a pose of the study, coloured by what is chosen.");
  page.sections.push_back(std::move(cancels));
}

}  // namespace poesy
