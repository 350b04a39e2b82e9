#pragma once

#include <string>
#include <vector>

#include "engine/kinds/study_file.h"
#include "tests/support/fake_model.h"
#include "tests/support/input_error.h"
#include "tests/support/kinds.h"

/// Monte Carlo studies of the fake mechanism that differ in their section [errors].
namespace poesy::test {

inline const Catalog& catalog_of_errors() {
  static const Catalog catalog = fake_catalog();
  return catalog;
}

inline std::string text_of_errors(const std::string& errors) {
  return "format = \"poesy-study\"\nversion = 1\nmechanism = { model = \"fake\" }\nposes = { count = 3 }\n[analysis]\n"
         "kind = \"monte-carlo\"\ndraws = \"per pose\"\n[errors]\n" +
         errors;
}

inline Study study_of_errors(const std::string& errors, const Catalog& catalog = catalog_of_errors()) {
  return study_of_text(text_of_errors(errors), "study.toml", catalog, StudyUse::run);
}

/// Expects that this [errors] section is refused with these words at the place of '^'.
inline void expect_errors_refused(const std::string& marked, const std::vector<std::string>& words,
                                  const Catalog& catalog = catalog_of_errors()) {
  const Marked text(text_of_errors(marked));
  expect_input_error([&] { study_of_text(text.text, "study.toml", catalog, StudyUse::run); },
                     {"study.toml", text.line, text.column}, words);
}

}  // namespace poesy::test
