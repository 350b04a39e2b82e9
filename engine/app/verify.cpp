#include <cstdio>

#include "engine/app/command.h"
#include "engine/app/description.h"
#include "engine/app/exit_code.h"
#include "engine/base/error.h"
#include "engine/io/result_file.h"

namespace poesy::app {
namespace {

int verify(const std::string& path) {
  const Verification hashes = verify_result(path);
  if (!hashes.matches()) {
    throw FileError(path, "content hash " + hashes.computed + " does not match the stored " + hashes.stored,
                    "the file was changed or damaged; run the study again");
  }
  std::printf("%s: content_sha256 %s matches\n", path.c_str(), hashes.computed.c_str());
  return kDone;
}

}  // namespace

void add_verify(CLI::App& program, Action& action) {
  auto result = std::make_shared<std::string>();
  CLI::App* command = program.add_subcommand("verify", "recompute a result's content hash; exit 3 if it differs");
  command->add_option("result", *result, "result file")->required()->type_name("RESULT.h5");
  command->footer(footer("", {{"unchanged since it was written?", "poesy verify result.h5"}}));
  command->callback([result, &action] { action = [result] { return verify(*result); }; });
}

}  // namespace poesy::app
