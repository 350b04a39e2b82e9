#include "engine/kinds/study_file.h"

#include "engine/kinds/registry.h"

namespace poesy {

Study read_study(const std::string& path, const Catalog& catalog, StudyUse use) {
  return read_study(path, catalog, use, study_kinds());
}

Study study_of_text(const std::string& text, const std::string& path, const Catalog& catalog, StudyUse use,
                    const std::string* mechanism_text) {
  return study_of_text(text, path, catalog, use, study_kinds(), mechanism_text);
}

std::string template_text(const CatalogEntry& entry, const StudyKind& kind) {
  return template_text(entry, kind, study_kinds());
}

std::string study_reference() { return study_reference(study_kinds()); }

}  // namespace poesy
