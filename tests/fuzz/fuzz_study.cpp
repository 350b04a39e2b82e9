// Fuzzes study files. An accepted study must be the same after its resolved text is read again. Its mechanism is built
// or refused.
#include <memory>

#include "engine/base/error.h"
#include "engine/kinds/study_file.h"
#include "models/registry.h"
#include "tests/fuzz/target.h"

namespace {

using namespace poesy;

// Its folder has poses.csv and curve.csv.
constexpr const char* kPath = POESY_FUZZ_FILES "/study.toml";

void check_resolved(const Study& study) {
  const std::string resolved = resolved_text(study);
  const Study again = study_of_text(resolved, kPath, registry(), StudyUse::run);
  fuzz::expect(resolved_text(again) == resolved, "a resolved study resolves to itself");
}

void read(const std::string& text, StudyUse use) {
  const Study study = study_of_text(text, kPath, registry(), use);
  fuzz::accepted<InputError>([&] { static_cast<void>(build_model(study.mechanism)); });
  if (use == StudyUse::run) check_resolved(study);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const StudyUse use : {StudyUse::run, StudyUse::evaluate}) {
    try {
      fuzz::accepted<InputError>([&] { read(text, use); });
    } catch (const FileError&) {
      // The study names a file that cannot be read.
    }
  }
  return 0;
}
